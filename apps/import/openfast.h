// What the readers of OpenFAST's modules share. Each reads the decks of its module and writes its
// part of the scene and of the list.
#ifndef BOUGH_IMPORT_OPENFAST_H
#define BOUGH_IMPORT_OPENFAST_H

#include "apps/import/deck.h"
#include "apps/import/draft.h"

enum { BOUGH_IMPORT_BLADES = 3 };

typedef struct bough_openfast {
    bough_draft draft;
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

// A whole file on the list: which, from where.
bough_deck *bough_openfast_open(bough_openfast *o, const bough_deck *from, const char *names);

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
