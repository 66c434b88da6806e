// What the readers of OpenFAST's modules share. Each reads the decks of its module and writes its
// part of the scene and of the list.
#ifndef BOUGH_APPS_IMPORT_OPENFAST_H
#define BOUGH_APPS_IMPORT_OPENFAST_H

#include "apps/bough/import/deck.h"
#include "apps/bough/import/draft.h"
#include "apps/bough/import/import.h"

// What acts on the generator.
typedef enum bough_generator {
    BOUGH_GENERATOR_FREE,    // nothing
    BOUGH_GENERATOR_DRIVEN,  // it turns at the speed of the start
    BOUGH_GENERATOR_LAW,     // a torque over the speed
    BOUGH_GENERATOR_LIBRARY, // a controller in the style of Bladed
} bough_generator;

typedef struct bough_openfast {
    bough_draft draft;
    const bough_import_options *options;
    bough_deck *main, *elasto, *tower, *servo, *inflow, *aero; // NULL: the model has none
    int n_blade;
    bool beamdyn; // blades by BeamDyn, else by ElastoDyn
    bool rigid_blade, rigid_tower;
    bough_generator generator;
    const char *library;          // of the controller
    const char *lacks_control;    // why a generator that should have a torque is driven; NULL: it is not
    double hub_radius;            // [m]
    double blade_length;          // [m]
    double blade_mass;            // [kg]
    double blade_inertia;         // about the rotor's axis, without cone [kg m2]
    double tower_base, tower_top; // above ground [m]
} bough_openfast;

// A whole file on the list: which, from where.
bough_deck *bough_openfast_open(bough_openfast *o, const bough_deck *from, const char *names);

// Fails at the line of a number that no turbine has; a deck of NULL has none.
typedef enum bough_openfast_limits {
    BOUGH_LIMITS_ELASTO,
    BOUGH_LIMITS_SERVO,
    BOUGH_LIMITS_INFLOW,
    BOUGH_LIMITS_BLADE,
    BOUGH_LIMITS_TOWER,
} bough_openfast_limits;
void bough_openfast_check(const bough_deck *deck, bough_openfast_limits which);

// Values of a deck for which the scene has no place, and what the list says of them.
typedef struct bough_openfast_rest {
    const char *name;
    const char *text; // NULL: the name says it
    double neutral;   // the value that needs no word; False is 0
} bough_openfast_rest;
void bough_openfast_leave(bough_openfast *o, const bough_deck *deck, const bough_openfast_rest *rest,
                          size_t n);

// Tables of blade and tower; with `top_mass` [kg] on the tower.
void bough_openfast_beamdyn(bough_openfast *o);
void bough_openfast_blade(bough_openfast *o);
void bough_openfast_tower(bough_openfast *o, double top_mass);

// Adds a slice of a blade to its mass and inertia: from and to [m], mass there [kg/m].
void bough_openfast_weigh(bough_openfast *o, const double span[2], const double mass[2]);

// Tables of airfoils and blade elements, and the part `aero` of the scene; its wind.
void bough_openfast_aero_tables(bough_openfast *o);
void bough_openfast_aero(bough_openfast *o);
void bough_openfast_wind(bough_openfast *o);

// The highest speed of the rotor that the decks tell [rad/s].
double bough_openfast_rotor_speed(const bough_openfast *o);

// Finds out what acts on the generator.
void bough_openfast_generator(bough_openfast *o);

// The parts `bodies` and `turbine` of the scene; `control`.
void bough_openfast_bodies(bough_openfast *o);
void bough_openfast_control(bough_openfast *o);

// The generator's inertia on the slow shaft [kg m2]; whether it turns against the hub.
double bough_openfast_generator_inertia(const bough_openfast *o);
bool bough_openfast_shaft_twists(const bough_openfast *o);

#endif
