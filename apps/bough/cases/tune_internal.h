// What the files of bough_tune share.
#ifndef BOUGH_APPS_CASES_TUNE_INTERNAL_H
#define BOUGH_APPS_CASES_TUNE_INTERNAL_H

#include "apps/bough/cases/tune.h"

typedef struct bough_tune {
    const bough_tune_options *options;
    const bough_scene *scene; // as it is written
    double error;             // to be met
    int n;
    bough_tune_point point[BOUGH_TUNE_POINTS];
    int chosen; // the cheapest that meets the error, else the one that errs least; −1: none ended
} bough_tune_state;

// Runs the stretch with the point's settings: its errors, with `shares` their shares, and its CPU time.
// BOUGH_INTERRUPTED by the options' stop; a run that fails is an outcome of the point.
bough_status bough_tune_measure(const bough_tune_state *t, bool shares, bough_tune_point *point);

// Runs it again, without an estimate of the error, and takes the lesser CPU time.
bough_status bough_tune_time(const bough_tune_state *t, bough_tune_point *point);

// Segments of a body's rod; 0 without one.
int bough_tune_segments(const bough_scene *scene, int body, const bough_tune_settings *settings);

bool bough_tune_meets(const bough_tune_state *t, const bough_tune_point *point);

// Whether run, motion and forces of the point are known.
bool bough_tune_ended(const bough_tune_point *point);

// Notes the front and the chosen point.
void bough_tune_choose(bough_tune_state *t);

// One line of the table; k −1: its head.
void bough_tune_print(const bough_tune_state *t, int k, FILE *stream);

// The settings of the chosen point as a scene has them, and as words of a command line.
void bough_tune_print_settings(const bough_tune_state *t, FILE *stream);

bough_status bough_tune_write(bough_tune_state *t);

#endif
