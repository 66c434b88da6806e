// A scene's static equilibrium: each rod by itself or all together, and what its mesh errs by.
#ifndef BOUGH_APPS_BOUGH_STATIC_FIND_H
#define BOUGH_APPS_BOUGH_STATIC_FIND_H

#include "apps/bough/analysis/steady.h"
#include "apps/bough/model/equilibrium.h"
#include "apps/bough/model/error_shares.h"
#include "apps/bough/results/channels.h"

typedef struct bough_static {
    bough_simulation *simulation;
    bool apart;                  // each rod by itself: no channels
    double time;                 // of the loads of the whole scene [s]
    bough_equilibrium_work work; // of the whole scene
    int n;
    bough_steady *rod;       // (n)
    bough_channels channels; // of the whole scene
    double *value;           // (channels.count)
} bough_static;

enum {
    BOUGH_STATIC_DISPLACEMENT, // of the tip [m]
    BOUGH_STATIC_ROTATION,     // of the tip [rad]
    BOUGH_STATIC_FORCE,        // at the root [N]
    BOUGH_STATIC_MOMENT,       // at the root [N m]
    BOUGH_STATIC_RESULTS,
};

// The equilibrium of the simulation, as built.
bough_status bough_static_find(bough_arena *arena, bough_simulation *s, bough_static *x);

// Displacement and rotation of the tip, force and moment at the root, for BOUGH_STATIC_RESULTS.
void bough_static_results(bough_steady *rod, bough_vec3 result[BOUGH_STATIC_RESULTS]);

typedef struct bough_mesh_error {
    char unknown[160]; // why it is not known; "": it is
    double *largest;   // (channels.count) of each channel, in its unit
} bough_mesh_error;

// What the mesh errs by: part of the difference to four times the segments. Of each rod (n ×
// BOUGH_STATIC_RESULTS, norms), in arrays from the arena; of the channels in mesh->largest. Where it is not
// known, mesh->unknown says why.
double *bough_static_mesh_error(bough_arena *arena, bough_static *x, bough_mesh_error *mesh);

#endif
