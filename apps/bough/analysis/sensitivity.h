// Sensitivity of a mode of the whole scene to its parameters, theory (108), by its left and right
// eigenvectors: a parameter takes two equilibria and four products, and no search for eigenvalues. The
// equilibrium changes with the parameter.
#pragma once

#include "apps/bough/analysis/vibration.h"

typedef struct bough_sensitivity {
    const char *name;  // of the parameter
    const char *by;    // its change, with unit
    double frequency;  // change of |λ|/2π that follows, relative to it
    double damping;    // and of the damping ratio
    double eigenvalue; // size of the change of λ, relative to |λ|
} bough_sensitivity;

typedef struct bough_sensitivities {
    int n;                   // parameters that the mode depends on by more than rounding
    bough_sensitivity *list; // (n) the largest change first
} bough_sensitivities;

// Of a mode that bough_vibration_find has found of this simulation, which is in that state. BOUGH_INVALID
// where another mode has the same eigenvalue; BOUGH_FAILED where the eigenvector is not found or a
// parameter's equilibrium is not. The cost is that of two dense complex factorisations of all states.
bough_status bough_sensitivity_find(bough_arena *arena, bough_simulation *s, double time,
                                    const bough_scene_mode *mode, bough_sensitivities *found);

// -- parameters -----------------------------------------------------------------------------------

typedef struct bough_parameter {
    char name[96];     // with its bodies
    const char *by;    // its change, with unit
    int kind;          // of parameter.c
    int n_body, *body; // whose rods change
} bough_parameter;

// The parameters of the scene (*n), in the arena.
const bough_parameter *bough_parameters_of(bough_arena *arena, const bough_scene *scene, int *n);

// The scene with a parameter changed by `times` its change.
bough_scene *bough_parameter_change(bough_arena *arena, const bough_scene *scene, const bough_parameter *x,
                                    double times);
