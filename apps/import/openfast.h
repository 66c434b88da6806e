// What the readers of OpenFAST's modules share. Each reads the decks of its module and writes its
// part of the scene and of the list.
#ifndef BOUGH_IMPORT_OPENFAST_H
#define BOUGH_IMPORT_OPENFAST_H

#include "apps/import/deck.h"

#include <stdio.h>

typedef enum bough_import_note {
    BOUGH_TAKEN,
    BOUGH_APPROXIMATED,
    BOUGH_LEFT_OUT,
    BOUGH_N_NOTE
} bough_import_note;

typedef enum bough_import_file {
    BOUGH_IMPORT_SCENE,
    BOUGH_IMPORT_BLADE,
    BOUGH_IMPORT_TOWER,
    BOUGH_IMPORT_AERO,
    BOUGH_IMPORT_POLARS,
    BOUGH_IMPORT_LIST,
    BOUGH_N_IMPORT_FILE,
} bough_import_file;

extern const char *const bough_import_name[BOUGH_N_IMPORT_FILE];

enum { BOUGH_IMPORT_BLADES = 3 };

typedef struct bough_openfast {
    bough_arena *arena;
    bough_status *status;
    FILE *note[BOUGH_N_NOTE];        // lines of the list
    FILE *file[BOUGH_N_IMPORT_FILE]; // texts of the files; one left empty is not written
    bough_deck *main, *elasto, *tower, *servo, *inflow, *aero; // NULL: the model has none
    int n_blade;
    bool beamdyn; // blades by BeamDyn, else by ElastoDyn
    bool rigid_blade, rigid_tower;
    const char *library;          // of a controller in the style of Bladed; NULL: none
    double hub_radius;            // [m]
    double blade_length;          // [m]
    double blade_mass;            // [kg]
    double tower_base, tower_top; // above ground [m]
} bough_openfast;

// A line of the list.
void bough_openfast_note(bough_openfast *o, bough_import_note kind, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// A whole file on the list: which, from where.
bough_deck *bough_openfast_open(bough_openfast *o, const bough_deck *from, const char *names);

// "[1, 2, 3]" in the scene's spelling.
void bough_import_list(FILE *file, const double *value, int n);

// A text in double quotes; a path as an absolute one, so, for what the scene leaves in its place.
void bough_import_quoted(FILE *file, const char *text);
void bough_import_path(FILE *file, const char *path);

// Tables of blade and tower; with `top_mass` [kg] on the tower.
void bough_openfast_beamdyn(bough_openfast *o);
void bough_openfast_blade(bough_openfast *o);
void bough_openfast_tower(bough_openfast *o, double top_mass);

// Tables of airfoils and blade elements, and the part `aero` of the scene.
void bough_openfast_aero_tables(bough_openfast *o);
void bough_openfast_aero(bough_openfast *o);

// Looks for the controller's library.
void bough_openfast_library(bough_openfast *o);

// The parts `bodies` and `turbine` of the scene; `control` and `loads`.
void bough_openfast_bodies(bough_openfast *o);
void bough_openfast_control(bough_openfast *o);

// Whether a controller steers the generator's torque: ServoDyn's simple law or a library.
bool bough_openfast_controlled(const bough_openfast *o);

#endif
