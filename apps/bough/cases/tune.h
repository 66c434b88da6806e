// Speed and error of one scene: an interval of its time is run with a dozen settings, and the fastest that
// meets a given error is proposed.
//
// The search is guided, without a grid. The first settings follow from the error. The separate errors of
// mesh, air and time of a run (apps/bough/model/error_verdict.h) then show by how much each can be coarser or
// must be finer; at last each setting alone, and the other scheme, are varied about the best.
#pragma once

#include "apps/bough/scene/scene.h"

enum { BOUGH_TUNE_POINTS = 16 };

// The settings of a run that replace those of the scene.
typedef struct bough_tune_settings {
    bool own;          // the scene's own settings, which the members below show
    int scheme;        // place in the table of schemes
    int solver;        // bough_integrator_kind: of all bodies as one system, else of each rod
    double rtol, step; // of that solver; step 0: the macro step [s]
    double macro_step; // [s]
    double rate;       // of the air [Hz]; 0: no air
    double mesh;       // segments of each rod relative to the scene's
} bough_tune_settings;

typedef struct bough_tune_point {
    bough_tune_settings settings;
    bough_status outcome; // of the run
    double cpu;           // of the interval [s]
    double motion;        // largest error of a channel of motion relative to its range
    double force;         // the same for forces and moments
    char channel[32];     // with the largest error of motion
    bool separate;        // `part` is known
    double part[3];       // of mesh, air and time in `error`
    double error;         // the larger of `motion` and a quarter of `force`
    bool best;            // on the Pareto front: no other is both faster and more accurate
} bough_tune_point;

typedef struct bough_tune_options {
    double error; // error bound relative to the range; 0: the scene's accuracy
    double span;  // of the interval from the start [s]
    int n_set;
    const char **set;   // (n_set) settings of the command line, "key=value"
    const char *folder; // for the results; made if missing
    bool (*stop)(void); // NULL: never stops
    FILE *stream;       // receives the table
} bough_tune_options;

// Makes the runs and writes tune.csv, tune.svg and tune.yaml. BOUGH_FAILED if no settings meet the error: the
// files then have those with the smallest error.
bough_status bough_tune(bough_arena *arena, const bough_scene *scene, const bough_tune_options *options);

// -- what tune.c and tune_report.c share ----------------------------------------------------------

typedef struct bough_tune {
    const bough_tune_options *options;
    const bough_scene *scene; // as it is written
    double error;             // bound
    int n;
    bough_tune_point point[BOUGH_TUNE_POINTS];
    int chosen; // the fastest that meets the error, or else the most accurate; −1: no run ended
} bough_tune_state;

// Segments of a body's rod; 0 without one.
int bough_tune_segments(const bough_scene *scene, int body, const bough_tune_settings *settings);

// The longest step of the solver [s].
static inline double bough_tune_step(const bough_tune_settings *s) {
    return s->step > 0 && s->step < s->macro_step ? s->step : s->macro_step;
}

// Whether the run of the point has ended and its errors are known.
bool bough_tune_ended(const bough_tune_point *point);

// Prints line k of the table; −1: its head.
void bough_tune_print(const bough_tune_state *t, int k, FILE *stream);

// Prints the settings of the chosen point as in a scene, and as words of a command line.
void bough_tune_print_settings(const void *state, FILE *stream); // bough_tune_state

bough_status bough_tune_write(bough_tune_state *t);
