// The verdict on the errors that a companion measures: ranges of channels, errors that count, the largest of
// them.
#pragma once

#include "apps/bough/model/companion.h"

enum { BOUGH_ERROR_SIZE = 96 };

typedef struct bough_error_verdict {
    int channel;     // with the largest error relative to its range; −1: none counts
    double relative; // that error
    double time;     // when it became noticeable [s]; −1: it is not
} bough_error_verdict;

// Whether the channel is a displacement, an angle or a velocity of a body. Forces and moments contain errors
// of the highest frequencies, which hardly affect the motion.
bool bough_error_is_motion(const bough_channel *channel);

// Range of the channel in its unit: of the run or of the companion, whichever is less, so that a divergent
// one has a finite range. Components of a vector have one range, the largest of theirs; a velocity that
// hardly changes has a hundredth of its value, an angular one, which adds up to turns, a thousandth, and
// where the whole scene is at rest a motion has the scene's size.
double bough_error_range(const bough_companion *c, int channel);

// An error of the channel, in its unit, relative to its range; NaN for one that keeps its value.
double bough_error_relative(const bough_companion *c, int channel, double error);

// Whether a channel counts: not if its motion and its error are below a thousandth of other channels of its
// kind, or rounding; of rotations also below a thousandth of displacements at the arm of the longest rod.
bool bough_error_counts(const bough_companion *c, int channel);

// The channel with the largest relative error: of motion, or of forces and moments. `error`
// (channels->count): the companion's, or a share of it.
bough_error_verdict bough_error_verdict_of(const bough_companion *c, bool motion, const double *error);

// Up to `most` channels that count, with the largest relative errors first: their number.
int bough_error_worst(const bough_companion *c, int most, int *channel);

// The error of a channel in words, as "0.2 m, 0.03 of its range"; above ten ranges, which are then mostly
// rounding, only that it is more.
void bough_error_size(const bough_companion *c, int channel, char text[BOUGH_ERROR_SIZE]);

// Records which errors are first noticeable at t [s].
void bough_error_notice(bough_companion *c, double t);

// -- shares of mesh, air and time (error_shares.c) ------------------------------------------------

// Separate errors of mesh, air and time in a run, and how to reduce the largest. Up to three further runs
// have one of the three as fine as the run and the others as coarse as the companion: the difference to the
// companion is caused by that part. A companion that is coarser in all parts can lose the solution although
// it keeps it with any one of them as fine as in the run. Then two of these runs, which together are coarser
// in every part, give the error: the sum of their differences to the run.

typedef enum bough_error_share_kind {
    BOUGH_SHARE_MESH,
    BOUGH_SHARE_AIR,
    BOUGH_SHARE_TIME, // and coupling
    BOUGH_SHARES,
} bough_error_share_kind;

typedef struct bough_error_share {
    char unknown[BOUGH_MESSAGE]; // why it is not known; "": it is known
    double *largest;             // (n_channel) largest error of each channel in the run, in its unit
    double *others;              // (n_channel) the same of all other parts
} bough_error_share;

typedef struct bough_error_shares {
    bool found; // the runs have been made
    int n_channel;
    bough_error_share share[BOUGH_SHARES];
    double cpu_s; // of the runs made for them [s]
} bough_error_shares;

const char *bough_error_share_name(bough_error_share_kind kind);

// After a complete run: makes the further runs. A share that they do not find has a reason. Lowers the errors
// of a companion that has lost the solution, or whose steps would end a run that finer ones confirm.
// BOUGH_INTERRUPTED by stop() (NULL: never).
bough_status bough_error_shares_find(bough_arena *arena, bough_companion *c, bool (*stop)(void),
                                     bough_error_shares *shares);

enum { BOUGH_ERROR_WARNING = BOUGH_MESSAGE + 100 };

// The error of a motion beside the bound [1]; 0: no bound. Above it BOUGH_FAILED, with channel, time, cause
// and the setting that meets it, unless the mesh alone is the cause: then that is the warning. Else the
// warning is about an error above simulation.accuracy, with the settings that meet it, or that errors are not
// known any more, or "". `shares`, zero or found before, are found where the error is above the bound.
bough_status bough_error_judge(bough_arena *arena, bough_companion *c, bool (*stop)(void), double bound,
                               bough_error_shares *shares, char warning[BOUGH_ERROR_WARNING]);
