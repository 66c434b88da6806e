// One run of a study's scene, in memory: sampled channels, times, and the coupling's own estimates.
#ifndef BOUGH_APPS_STUDY_STUDY_RUN_H
#define BOUGH_APPS_STUDY_STUDY_RUN_H

#include "apps/bough/results/channels.h"
#include "apps/bough/results/progress.h"
#include "apps/bough/scene/scene.h"
#include "apps/bough/cases/study.h"
#include "cosim/watch/monitor.h"

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
    double error[BOUGH_STUDY_MEASURES];    // NaN when the run failed
    double estimate[BOUGH_STUDY_MEASURES]; // the run's own of the same; NaN where it has none
    bool warned;                           // before the run
    bool done;                             // ended, well or not
} bough_study_result;

// Median and quartiles of at most BOUGH_STUDY_REPEATS values.
enum { BOUGH_STUDY_REPEATS = 99 };
typedef struct bough_spread {
    double median, low, high;
} bough_spread;
bough_spread bough_spread_of(const double *values, int n);

// How the runs are driven.
typedef struct bough_study_drive {
    bool (*stop)(void);      // asked before each step; NULL: never stops
    bough_progress progress; // of the terminal's line, labelled by what runs
    const char *folder;      // where every run writes all its channels; NULL: nowhere
} bough_study_drive;

// Where a run's scene is from: its file with replacements, and the fingerprint of the files that they name
// when the study began; 0: they may change.
typedef struct bough_study_source {
    const char *scene;
    int n_set;
    const char *const *set; // (n_set)
    uint64_t files;
} bough_study_source;

// Every scene was read when the study began, so that an error now, BOUGH_IO, is of the study and not of the
// run.
bough_status bough_study_read_scene(bough_arena *arena, const bough_study_source *from, bough_scene **scene);

// BOUGH_IO when the files of a scene that has been built are others than when the study began: its run must
// not be compared with earlier ones, nor what cannot be built be kept as a result.
bough_status bough_study_same_files(bough_arena *arena, const bough_scene *scene, uint64_t files);

bough_study_series bough_study_series_take(bough_arena *arena, const bough_study *study);

// Whether a run that ends so ends the study: a run that fails says something about its settings, memory,
// files and interrupts do not.
bool bough_study_ends(bough_code code);

// The places of n channels among a run's: column (n). BOUGH_INVALID names one that the run does not have.
bough_status bough_study_columns(bough_arena *arena, const bough_channels *channels, int n,
                                 const char *const *name, int **column);

// Runs a cell `repeat` times. The outcome of the run is in the result; the status is not BOUGH_OK
// when the whole study must end: BOUGH_INTERRUPTED, BOUGH_OUT_OF_MEMORY. The errors are not computed.
bough_status bough_study_run(const bough_study *study, const bough_study_cell *cell, int repeat,
                             bough_study_drive *drive, bough_study_series *series,
                             bough_study_result *result);

// The largest difference of each measure between the two series: error (n_measure).
void bough_study_compare(const bough_study *study, const bough_study_series *series,
                         const bough_study_series *reference, double *error);

#endif
