// The run of one case: sampled channels or their statistics, times, and its own estimates of its errors;
// differences between runs at their common output times.
#pragma once

#include "apps/bough/cases/counts.h"
#include "apps/bough/cases/study.h"
#include "apps/bough/results/progress.h"
#include "apps/bough/scene/scene.h"
#include "cosim/watch/monitor.h"

// -- boxes of turbulence (boxes.c) ----------------------------------------------------------------

// Boxes of turbulence that the runs of a study share: to generate one of 600 s takes as long as a dozen
// seconds of a turbine's run, and it takes more memory than the rest of the run.

typedef struct bough_boxes bough_boxes;

// For a number of simultaneous runs; keeps as many boxes.
bough_boxes *bough_boxes_create(bough_arena *arena, int runs);

// Lends a run the box of its scene's turbulence, generated if it is not yet there. NULL: the scene has none,
// or it cannot be generated, which the run will report.
const bough_wind_box *bough_boxes_lend(bough_boxes *boxes, const bough_scene *scene);
void bough_boxes_give_back(bough_boxes *boxes, const bough_wind_box *box);

// Values of the study's channels at the common output times 0, interval, 2 interval, …
typedef struct bough_study_series {
    int n_row, n_channel;
    int filled;    // rows sampled so far
    double *value; // (n_row × n_channel)
} bough_study_series;

bough_study_series bough_study_series_take(bough_arena *arena, const bough_study *study);

// The largest difference of each measure between the two series: error (n_measure).
void bough_study_compare(const bough_study *study, const bough_study_series *series,
                         const bough_study_series *reference, double *error);

// Each measure's norm of the values (n_channel) of the study's channels: norm (n_measure).
void bough_study_norms(const bough_study *study, const double *value, double *norm);

// Estimated errors of the loads of a channel, from the case's companion: both are counted at their common
// times.
typedef struct bough_load_error {
    double least, most;               // error of the smallest and of the largest value [unit of the channel]
    double damage[BOUGH_MOST_SLOPES]; // Σ n Sᵐ of the run
    double larger[BOUGH_MOST_SLOPES]; // the same for the equivalent load plus its error
} bough_load_error;

enum { BOUGH_CASE_WARNINGS = 1200 };

typedef struct bough_case_result {
    bough_status outcome; // BOUGH_FAILED with a diagnosis: the run ended early
    bool done;            // the run has ended, complete or not
    double time;          // reached [s]
    double wall, cpu;     // of the steps, medians of the repeats; with statistics also of the building [s]

    // of compared runs
    bool warned; // before the first step
    bough_coupling_report coupling;
    double error[BOUGH_STUDY_MEASURES];    // differences to the reference; NaN when the run failed
    double estimate[BOUGH_STUDY_MEASURES]; // the run's own estimates of these; NaN where it has none

    // of runs with statistics
    char warnings[BOUGH_CASE_WARNINGS]; // about limits of the models and the error, or ""
    double counted;                     // time after the study's `from` [s]
    bough_counts counts;
    bool has_companion;           // the errors of loads below are known
    bough_load_error *load_error; // (n_channel)
} bough_case_result;

// Whether the run is complete.
static inline bool bough_held(const bough_case_result *r) { return r->done && bough_is_ok(&r->outcome); }

// An empty result with room for statistics, in the arena.
bough_case_result bough_case_take(bough_arena *arena, const bough_study *study);

// Median and quartiles of at most BOUGH_STUDY_REPEATS values.
enum { BOUGH_STUDY_REPEATS = 99 };
typedef struct bough_spread {
    double median, low, high;
} bough_spread;
bough_spread bough_spread_of(const double *values, int n);

// Whether a run with this outcome ends the whole study. A failed run is a result of its settings; lack of
// memory, file errors and interrupts are not.
bool bough_ends_study(bough_code code);

// How the runs are performed.
typedef struct bough_study_drive {
    bool (*stop)(void);      // asked before each step; NULL: never stops
    bough_progress progress; // line on the terminal, labelled with the run
    const char *folder;      // where each run writes all its channels; NULL: they are not written
    bough_boxes *boxes;      // NULL: each run generates its own turbulence
} bough_study_drive;

// Runs a case `repeat` times and samples the study's channels into `series`; NULL: into the result's counts.
// The outcome of the run is in the result; the status is that of the study, which must end after
// BOUGH_INTERRUPTED, BOUGH_OUT_OF_MEMORY or BOUGH_IO. result->error is left to the caller.
bough_status bough_case_run(const bough_study *study, const bough_case *c, int repeat,
                            bough_study_drive *drive, bough_study_series *series, bough_case_result *result);
