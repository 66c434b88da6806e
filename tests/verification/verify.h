// A study of kind verify: cases that are each a scene, what to do with it, and what should come out
// by another program, an exact solution or a conservation law.
#pragma once

#include "apps/bough/cases/study.h"
#include "apps/bough/scene/scene.h"
#include "tests/verification/verification.h"

enum { BOUGH_VERIFY_MESHES = 5 };

typedef enum bough_verify_action {
    BOUGH_VERIFY_STATIC, // equilibrium of the first rod
    BOUGH_VERIFY_MODES,  // modes of the first rod or of the scene, as its modes block says
    BOUGH_VERIFY_RUN,    // the scene through its duration
} bough_verify_action;

typedef enum bough_verify_what {
    BOUGH_VERIFY_TIP,       // "tip ux": component of the tip's motion
    BOUGH_VERIFY_FREQUENCY, // "frequency 2" [Hz]
    BOUGH_VERIFY_DAMPING,   // "damping 2", the ratio
    BOUGH_VERIFY_GROWTH,    // "growth", of the fastest growing of the lowest modes [1/s]
    BOUGH_VERIFY_AT,        // "CHANNEL at 0.5 s"
    BOUGH_VERIFY_LARGEST,   // "largest CHANNEL"
    BOUGH_VERIFY_SMALLEST,  // "smallest CHANNEL"
    BOUGH_VERIFY_DRIFT,     // "drift of energy from 2 s", the largest, as a share of the
                            // largest value, of the energy without gravity's
    BOUGH_VERIFY_WORK,      // "evaluations per step" of the tree's equations, all of them
    BOUGH_VERIFY_MEAN,      // "mean CHANNEL from 2 s"
    BOUGH_VERIFY_AMPLITUDE, // "amplitude CHANNEL from 2 s", once per turn of the rotor
} bough_verify_what;

// What the bodies have together; conserved in free flight.
typedef enum bough_verify_invariant {
    BOUGH_VERIFY_ENERGY, // kinetic, elastic and of gravity [J]
    BOUGH_VERIFY_MOMENTUM,
    BOUGH_VERIFY_ANGULAR_MOMENTUM, // about the ground's origin
    BOUGH_VERIFY_INVARIANTS,
} bough_verify_invariant;

typedef struct bough_verify_quantity {
    bough_verify_what what;
    int index;           // of the tip's component, of the mode, or bough_verify_invariant
    const char *channel; // NULL: no channel
    double time;         // [s]
} bough_verify_quantity;

// A value that is expected, or a diagnosis.
typedef struct bough_verify_expect {
    const bough_node *node;
    const char *name; // of the quantity, as written
    bough_verify_quantity quantity;
    double value, scale;       // value = scale × quantity
    double relative, absolute; // tolerance; of `relative` the value's share
    bool extrapolate;          // over the meshes, at second order
    const char *diagnosis;     // part of the message with which the case must fail; NULL: none
} bough_verify_expect;

typedef struct bough_verify_case {
    const bough_node *node;
    const char *name;
    const char *scene_name, *scene; // as written; path
    int action;                     // bough_verify_action
    const char *mesh_key;           // "bodies[0].rod.segments"
    int n_mesh;
    double *mesh;             // (n_mesh) numbers of segments, growing by a constant factor
    double mesh_of;           // what is divided by them; 0: the key takes the numbers themselves
    bough_study_settings set; // replacements in the scene
    int n_expect;
    bough_verify_expect *expect; // (n_expect)
} bough_verify_case;

typedef struct bough_verify {
    const bough_node *node;
    const char *title;
    int kind;
    int n_case;
    bough_verify_case *cases; // (n_case)
} bough_verify;

// What a case came to on one mesh.
typedef struct bough_verify_result {
    bough_status outcome;
    double *value; // (n_expect), NaN where there is none
} bough_verify_result;

// Reads the cases from the root of a study in the file `path`, and every scene with its
// replacements; adds what is wrong to `errors`.
void *bough_verify_read(bough_arena *arena, const char *path, const bough_node *root, bough_errors *errors);

// Reads the scene of a case with its replacements, on mesh k (0 without meshes).
bough_status bough_verify_scene(bough_arena *arena, const bough_verify_case *x, int k, bough_errors *errors,
                                bough_scene **scene);

// Does what a case says on mesh `k` (0 without meshes); `stop` as in the options. Failures are in
// the result.
void bough_verify_run(bough_arena *arena, const bough_verify_case *x, int k, bool (*stop)(void),
                      bough_verify_result *result);

// Performs all cases, prints a line for each expectation and writes verify.csv. BOUGH_FAILED when
// one does not hold.
bough_status bough_verify_perform(bough_arena *arena, const void *study,
                                  const bough_verification_options *options);
