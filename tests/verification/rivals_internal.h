// What the files of a study of rivals share among themselves.
#ifndef BOUGH_TESTS_VERIFICATION_RIVALS_INTERNAL_H
#define BOUGH_TESTS_VERIFICATION_RIVALS_INTERNAL_H

#include "tests/verification/rivals.h"
#include "apps/study/study_run.h"

enum { BOUGH_RIVALS_FREQUENCIES = 12, BOUGH_RIVALS_MEASURES = 3 };

// Replacements "KEY=VALUE".
typedef struct bough_rival_sets {
    int n;
    const char **item; // (n)
} bough_rival_sets;

typedef struct bough_rival {
    const bough_node *node;
    const char *name;
    bough_rival_sets set; // with keys of a body
} bough_rival;

typedef struct bough_rivals {
    const bough_node *node;
    const char *title;
    int kind;
    const char *blade, *turbine; // paths of the scenes
    bough_rival_sets load;       // replacements that load the blade
    bough_rival_sets run;        // replacements in the turbine's scene
    bough_rival reference;
    int repeat;
    int n;
    bough_rival *rival; // (n)
} bough_rivals;

// A clamped blade at rest.
typedef struct bough_rival_blade {
    int n_state, n; // states; segments
    double *span, *flap, *twist; // [m], displacement along x [m] and rotation about z [rad] (n + 1)
    double rest[BOUGH_RIVALS_FREQUENCIES], bent[BOUGH_RIVALS_FREQUENCIES]; // [Hz]
} bough_rival_blade;

// The scene's replacements: those given, then the rival's for every body that is a beam.
bough_status bough_rival_scene_sets(bough_arena *arena, const char *scene,
                                    const bough_rival_sets *given, const bough_rival *rival,
                                    bough_rival_sets *sets);

// Its equilibrium under the load, and its frequencies.
bough_status bough_rival_blade_find(bough_arena *arena, const bough_rivals *rivals,
                                    const bough_rival *rival, bough_rival_blade *blade);

#endif
