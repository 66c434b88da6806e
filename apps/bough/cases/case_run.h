// The run of one case: sampled channels or their statistics, times, and the run's own estimates; differences
// of runs at their common output times.
#ifndef BOUGH_APPS_CASES_CASE_RUN_H
#define BOUGH_APPS_CASES_CASE_RUN_H

#include "apps/bough/cases/counts.h"
#include "apps/bough/cases/study.h"
#include "apps/bough/results/progress.h"
#include "apps/bough/scene/scene.h"
#include "core/base/arena.h"
#include "cosim/watch/monitor.h"

// -- boxes of turbulence (boxes.c) ----------------------------------------------------------------

// Boxes of turbulence that the runs of a study share: one of 600 s takes as long to make as a dozen seconds
// of a turbine's run, and more memory than all else of it.

typedef struct bough_boxes bough_boxes;

// For so many runs at the same time; keeps as many boxes.
bough_boxes *bough_boxes_create(bough_arena *arena, int runs);

// The box of the scene's turbulence, made unless it is there, for a run until it gives it back. NULL: the
// scene has none, or it cannot be made, as its own run will report.
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

// How far the loads of a channel may be from the truth, by the case's companion. Both are counted at their
// common times.
typedef struct bough_load_error {
    double least, most;               // error of the smallest and of the largest value [unit of the channel]
    double damage[BOUGH_MOST_SLOPES]; // Σ n Sᵐ of the run
    double larger[BOUGH_MOST_SLOPES]; // the same of an equivalent load that is larger by its error
} bough_load_error;

enum { BOUGH_CASE_WARNINGS = 1200 };

typedef struct bough_case_result {
    bough_status outcome; // BOUGH_FAILED with a diagnosis: the run ended there
    bool done;            // ended, well or not
    double time;          // reached [s]
    double wall, cpu;     // of the stepping, medians of the repeats; of statistics with the building [s]

    // compared
    bool warned; // before the run
    bough_coupling_report coupling;
    double error[BOUGH_STUDY_MEASURES];    // NaN when the run failed
    double estimate[BOUGH_STUDY_MEASURES]; // the run's own of the same; NaN where it has none

    // with statistics
    char warnings[BOUGH_CASE_WARNINGS]; // limits of the models that the run has passed, and its error; or ""
    double counted;                     // of the time after the study's `from` [s]
    bough_counts counts;
    bool has_companion;           // whose errors of loads follow
    bough_load_error *load_error; // (n_channel)
} bough_case_result;

// Whether the run has ended well.
static inline bool bough_held(const bough_case_result *r) { return r->done && bough_is_ok(&r->outcome); }

// An empty result with room for statistics, whose memory is the arena's.
bough_case_result bough_case_take(bough_arena *arena, const bough_study *study);

// Median and quartiles of at most BOUGH_STUDY_REPEATS values.
enum { BOUGH_STUDY_REPEATS = 99 };
typedef struct bough_spread {
    double median, low, high;
} bough_spread;
bough_spread bough_spread_of(const double *values, int n);

// Whether a run with this outcome ends the whole study: a run that fails says something about its settings,
// memory, files and interrupts do not.
bool bough_ends_study(bough_code code);

// How the runs are driven.
typedef struct bough_study_drive {
    bool (*stop)(void);      // asked before each step; NULL: never stops
    bough_progress progress; // of the terminal's line, labelled by what runs
    const char *folder;      // where every run writes all its channels; NULL: nowhere
    bough_boxes *boxes;      // NULL: a run makes its own turbulence
} bough_study_drive;

// Runs a case `repeat` times, and samples the study's channels into `series`, or NULL: into the result's
// counts. The outcome of the run is in the result; the status is not BOUGH_OK when the whole study must end:
// BOUGH_INTERRUPTED, BOUGH_OUT_OF_MEMORY, BOUGH_IO. The errors are not computed.
bough_status bough_case_run(const bough_study *study, const bough_case *c, int repeat,
                            bough_study_drive *drive, bough_study_series *series, bough_case_result *result);

#endif
