// Performs a study of any kind: its runs, tables and diagrams.
#pragma once

#include "apps/bough/cases/case_run.h"

// -- results of cases (store.c) -------------------------------------------------------------------

// The result of each case as a text file of the study's folder, cases/NAME.case, complete or absent. Its head
// has the fingerprint of the input and the outcome of the run; then follow rows of a word and numbers with
// all digits. An interrupted study continues, and a grid may grow.
//
// A process claims each case that it runs by a record lock of fcntl(2) on one file of the study's folder. The
// operating system releases the lock when the process ends, also on another machine of a cluster that shares
// the file system. On a file system without locks every claim succeeds, and a case may run twice with the
// same result.

// Makes the folder cases/ of a study's folder.
bough_status bough_store_open(const char *folder);

bough_status bough_store_write(const char *folder, const bough_study *study, const bough_case *c,
                               bough_case_result *result);

// Reads a result, with statistics into memory of bough_case_take. result->done is false if there is none or
// it belongs to other input; BOUGH_IO if the file is damaged.
bough_status bough_store_read(const char *folder, const bough_study *study, const bough_case *c,
                              bough_case_result *result);

// Whether there is a result of this input, without reading its rows.
bool bough_store_has(const char *folder, const bough_study *study, const bough_case *c);

// The file of the claims, which is closed with the arena. A process opens it once only: closing it releases
// all locks of the process.
bough_status bough_claims_open(bough_arena *arena, const char *folder, int *claims);

// Claims a case for this process; false if another process has it.
bool bough_claim(int claims, int number);
void bough_claim_drop(int claims, int number);

// -- loads of a lifetime (lifetime.c) -------------------------------------------------------------

// Loads of all cases of a load set over the turbine's lifetime. The cases are added in their order, so that
// the result has the same bits, whichever process has run which case.

// The extreme of a channel over all cases, by its design value, which is `factor` times the characteristic
// value. Only forces and moments have a factor; it is the load case's `favourable` for a minimum above zero
// and a maximum below zero.
typedef struct bough_extreme {
    bool found;
    double value;  // characteristic value, that of the run, in the channel's unit
    double factor; // [-]
    double range;  // of the channel in that case
    double at;     // [s]
    int number;    // of its case
    double *row;   // (n_channel) simultaneous characteristic values of all channels
} bough_extreme;

typedef struct bough_lifetime_channel {
    double damage[BOUGH_MOST_SLOPES]; // Σ n Sᵐ over the life
    double cycles;
    bough_levels ranges; // cycles by their range
    bough_levels levels; // hours at each level, upward crossings
    bough_extreme least, most;
    // Σ n Sᵐ over the life of the cases with a companion, and the same with their equivalent loads plus
    // errors
    double compared[BOUGH_MOST_SLOPES], larger[BOUGH_MOST_SLOPES];
} bough_lifetime_channel;

// Sums over cases with a companion, for one channel.
typedef struct bough_extreme_errors {
    double range, least, most; // of squares: range, error of the minimum, error of the maximum
} bough_extreme_errors;

typedef struct bough_lifetime {
    const bough_study *study;
    bough_lifetime_channel *channel; // (n_channel)
    int n_failed, n_missing;         // cases
    double hours;                    // of the lifetime in the sums
    double total;                    // sum of hours and events of all cases
    double missing;                  // fraction of the cases' weight that failed or is missing
    double simulated, cpu;           // of all runs [s]
    int *n_compared;                 // (n_group + 1) cases with a companion in each load case, and in all
    bough_extreme_errors *errors;    // (n_group + 1, n_channel) likewise
} bough_lifetime;

bough_lifetime bough_lifetime_take(bough_arena *arena, const bough_study *study);

// Adds the next case. A result that is not `done` counts as missing.
void bough_lifetime_add(bough_lifetime *l, int number, const bough_case_result *result);

// Damage-equivalent load of a channel over the life, for the k-th slope.
double bough_lifetime_equivalent(const bough_lifetime *l, int channel, int slope);

// Its error, extrapolated from the cases with a companion. NaN: not known.
double bough_lifetime_equivalent_error(const bough_lifetime *l, int channel, int slope);

// Error of a characteristic extreme of the channel, `least` or `most`: the root mean square of the errors of
// the cases with a companion in its load case, or in all if it has none, relative to their ranges. NaN: not
// known.
double bough_lifetime_extreme_error(const bough_lifetime *l, int channel, const bough_extreme *e);

// -- a study --------------------------------------------------------------------------------------

// How a study is performed.
typedef struct bough_study_options {
    const char *folder; // for the results; made if missing
    int part, parts;    // only this part of the cases, from 1; parts 0: all
    const char *only;   // name of the only load case to run; NULL: all
    bool quiet;         // no progress line
    bool (*stop)(void); // asked before each step; NULL: never stops
    FILE *stream;       // receives the table
} bough_study_options;

// Runs the cases that have no result in the folder and that no other process runs, and writes their results
// there; a failed run is a result, too. BOUGH_FAILED if the reference fails, if cases with statistics have
// failed, or if a cell of kind stability is silent; BOUGH_INTERRUPTED if the study is stopped: the next call
// continues it.
bough_status bough_study_perform(bough_arena *arena, const bough_study *study,
                                 const bough_study_options *options);

typedef struct bough_study_results {
    const bough_study *study;
    const bough_study_options *options;
    bough_case_result *reference, *result; // of compared runs (n_reference), (n_case)
    int ran, failed;                       // runs in this call
} bough_study_results;

// Number of cases without a result among those of one reference; −1: of all.
int bough_study_missing(const bough_study_results *results, int group);

// Each writes the tables of its kind into the folder and prints the main one when all results are there;
// otherwise it prints the number of missing ones.
typedef bough_status bough_study_conclude(bough_arena *arena, const bough_study_results *results);

// table.txt, table.csv and the work-precision diagram plot.svg: cost over error on logarithmic axes, a panel
// for each measure, a line for each combination of all settings but the last, which varies along the line.
// Failed runs have no point; the legend names them.
bough_study_conclude bough_precision_conclude;

// table.csv, and a table over the macro step and the model parameters. BOUGH_FAILED if a run is silent: it is
// complete and has a large error without a warning, and its own estimate is far below the error.
bough_study_conclude bough_stability_conclude;

// cases.csv, costs.csv, table.txt and plot.svg; of a load set also equivalent.csv, extremes.csv, ranges.csv
// and levels.csv. All but costs.csv follow from the cases' results alone. BOUGH_FAILED when cases have
// failed.
bough_study_conclude bough_statistics_conclude;

// Runs all cases of a study of kind timing alternately, in rounds, so that other load of the machine affects
// all alike; ratios of times are formed within a round. Writes timing.csv, table.txt and, if an axis of the
// grid has numbers, plot.svg: CPU time over these.
bough_study_conclude bough_timing_conclude;

// Writes a field of a CSV file, in quotes where it needs them; line ends become blanks.
void bough_csv_text(FILE *file, const char *text);

// The same behind a comma.
void bough_csv_next(FILE *file, const char *text);

// A case that failed, with the command that runs it alone.
void bough_case_failed(const bough_study *study, int number, const char *message, FILE *file);
