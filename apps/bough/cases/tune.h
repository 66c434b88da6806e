// Speed against error of one scene: a stretch of it is run with a dozen settings, and the cheapest that meets
// a given error is proposed.
//
// The runs are guided, not a grid. From the settings that follow from the error, shares of mesh, air and time
// in the error of a run (apps/bough/model/error_verdict.h) say by how much each can be coarser, or must be
// finer; then each setting alone, and the other scheme, are tried beside the best.
#ifndef BOUGH_APPS_CASES_TUNE_H
#define BOUGH_APPS_CASES_TUNE_H

#include "apps/bough/scene/scene.h"

#include <stdio.h>

enum { BOUGH_TUNE_POINTS = 16 };

// What a run is given in place of the scene's own settings.
typedef struct bough_tune_settings {
    bool own;          // those of the scene as it is written; the others below show them
    int scheme;        // place in the table of schemes
    int solver;        // bough_integrator_kind: of all bodies as one system, else of each rod
    double rtol, step; // of that solver; step 0: the macro step [s]
    double macro_step; // [s]
    double rate;       // of the air [Hz]; 0: there is none
    double mesh;       // segments of each rod over the scene's
} bough_tune_settings;

typedef struct bough_tune_point {
    bough_tune_settings settings;
    bough_status outcome; // of the run
    double cpu;           // of the stretch [s]
    double motion, force; // largest error of a channel of motion, of forces and moments, over its range
    char channel[32];     // of the former
    bool shared;          // `share` is known
    double share[3];      // of mesh, air and time in `error`
    double error;         // `motion`, or a quarter of `force` where that is more
    bool best;            // on the front: none is cheaper and errs less
} bough_tune_point;

typedef struct bough_tune_options {
    const char *scene; // path
    int n_set;
    const char *const *set; // (n_set) replacements in the scene
    double error;           // to be met, over the range; 0: the scene's accuracy
    double span;            // of the stretch from the start [s]
    const char *folder;     // for the results; made if missing
    bool (*stop)(void);     // NULL: never stops
    FILE *stream;           // receives the table
} bough_tune_options;

// Runs the stretches and writes tune.csv, tune.svg and tune.yaml. BOUGH_FAILED when no settings meet the
// error: the files are then written for those that err least. The scene must be valid.
bough_status bough_tune(bough_arena *arena, const bough_tune_options *options);

// -- what tune.c and tune_report.c share ----------------------------------------------------------

typedef struct bough_tune {
    const bough_tune_options *options;
    const bough_scene *scene; // as it is written
    double error;             // to be met
    int n;
    bough_tune_point point[BOUGH_TUNE_POINTS];
    int chosen; // the cheapest that meets the error, else the one that errs least; −1: none ended
} bough_tune_state;

// Segments of a body's rod; 0 without one.
int bough_tune_segments(const bough_scene *scene, int body, const bough_tune_settings *settings);

// The longest step of the solver [s].
static inline double bough_tune_step(const bough_tune_settings *s) {
    return s->step > 0 && s->step < s->macro_step ? s->step : s->macro_step;
}

// Whether run, motion and forces of the point are known.
bool bough_tune_ended(const bough_tune_point *point);

// One line of the table; k −1: its head.
void bough_tune_print(const bough_tune_state *t, int k, FILE *stream);

// The settings of the chosen point as a scene has them, and as words of a command line.
void bough_tune_print_settings(const void *state, FILE *stream); // bough_tune_state

bough_status bough_tune_write(bough_tune_state *t);

#endif
