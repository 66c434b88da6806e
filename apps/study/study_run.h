// One run of a study's scene, in memory: sampled channels, times, and the coupling's own estimates.
#ifndef BOUGH_APPS_STUDY_STUDY_RUN_H
#define BOUGH_APPS_STUDY_STUDY_RUN_H

#include "apps/output/progress.h"
#include "apps/scene/scene.h"
#include "apps/study/study.h"
#include "cosim/monitor.h"

// Values of the study's channels at the common output times 0, interval, 2 interval, …
typedef struct bough_study_series {
    int n_row, n_channel;
    int filled;    // rows sampled so far
    double *value; // (n_row × n_channel)
} bough_study_series;

typedef struct bough_study_result {
    bough_status outcome; // BOUGH_FAILED with a diagnosis: the run ended there
    double time;          // reached [s]
    double wall, cpu;     // of the stepping, medians of the repeats [s]
    bough_coupling_report coupling;
    double error[BOUGH_STUDY_MEASURES]; // NaN when the run failed
    double estimate[BOUGH_STUDY_MEASURES]; // the run's own of the same; NaN where it has none
    bool warned;                        // before the run
    bool done;                          // ended, well or not
} bough_study_result;

// How the runs are driven.
typedef struct bough_study_drive {
    bool (*stop)(void);      // asked before each step; NULL: never stops
    bough_progress progress; // of the terminal's line, labelled by what runs
} bough_study_drive;

// What a cell tells of its error stands beside the true error, against the reference: the estimate by the
// linearised members will do where the scene does not ask for another, and none beside one system.
void bough_study_estimate_cheaply(bough_scene *scene);

bough_study_series bough_study_series_take(bough_arena *arena, const bough_study *study);

// Runs a cell `repeat` times. What the run itself comes to is in the result; the status tells what
// ends the study: BOUGH_INTERRUPTED, no memory. The errors are not computed.
bough_status bough_study_run(const bough_study *study, const bough_study_cell *cell, int repeat,
                             bough_study_drive *drive, bough_study_series *series,
                             bough_study_result *result);

// The largest difference of each measure between the two series: error (n_measure).
void bough_study_compare(const bough_study *study, const bough_study_series *series,
                         const bough_study_series *reference, double *error);

#endif
