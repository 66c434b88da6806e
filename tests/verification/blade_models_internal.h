// What the files of a study of blade models share among themselves.
#pragma once

#include "apps/bough/cases/case_run.h"
#include "tests/verification/blade_models.h"

enum { BOUGH_BLADE_MODELS_FREQUENCIES = 12, BOUGH_BLADE_MODELS_MEASURES = 3 };

// Replacements "KEY=VALUE".
typedef struct bough_model_sets {
    int n;
    const char **item; // (n)
} bough_model_sets;

typedef struct bough_blade_model {
    const bough_node *node;
    const char *name;
    bough_model_sets set; // with keys of a body
} bough_blade_model;

typedef struct bough_blade_models {
    const bough_node *node;
    const char *title;
    int kind;
    const char *blade, *turbine; // paths of the scenes
    bough_model_sets load;       // replacements that load the blade
    bough_model_sets run;        // replacements in the turbine's scene
    bough_blade_model reference;
    int repeat;
    int n;
    bough_blade_model *model; // (n)
} bough_blade_models;

// A clamped blade at rest.
typedef struct bough_model_blade {
    int n_state, n;              // states; segments
    double *span, *flap, *twist; // [m], displacement along x [m] and rotation about z [rad] (n + 1)
    double rest[BOUGH_BLADE_MODELS_FREQUENCIES], bent[BOUGH_BLADE_MODELS_FREQUENCIES]; // [Hz]
} bough_model_blade;

// The scene's replacements: those given, then the model's for every body that is a beam.
bough_status bough_model_scene_sets(bough_arena *arena, const char *scene, const bough_model_sets *given,
                                    const bough_blade_model *model, bough_model_sets *sets);

// Its equilibrium under the load, and its frequencies.
bough_status bough_model_blade_find(bough_arena *arena, const bough_blade_models *study,
                                    const bough_blade_model *model, bough_model_blade *blade);
