// Shares of mesh, air and time in the error of a run, and what to do about the largest. The scene is run once
// more as its companion is, and beside it three times with one of the three as fine as in the run: what lies
// between is that part's share of what the companion errs by, and part of it the run's. Coarser in all parts
// at once, a companion can lose the solution that it keeps with any one of them as in the run. Then two of
// these three runs, which together are coarser in every part, give the error: the sum of what the run differs
// by from either.
#ifndef BOUGH_APPS_MODEL_ERROR_SHARES_H
#define BOUGH_APPS_MODEL_ERROR_SHARES_H

#include "apps/bough/model/error_verdict.h"

typedef enum bough_error_share_kind {
    BOUGH_SHARE_MESH,
    BOUGH_SHARE_AIR,
    BOUGH_SHARE_TIME, // and coupling
    BOUGH_SHARES,
} bough_error_share_kind;

typedef struct bough_error_share {
    char unknown[160]; // why it is not known; "": it is
    double *largest;   // (n_channel) largest error of each channel in the run, in its unit
    double *others;    // (n_channel) the same of all other parts, where the error is above the bound
} bough_error_share;

typedef struct bough_error_shares {
    bool found; // the runs have been made
    int n_channel;
    bough_error_share share[BOUGH_SHARES];
    double cpu_s; // of the runs made for them [s]
} bough_error_shares;

const char *bough_error_share_name(bough_error_share_kind kind);

// After a complete run: makes the further runs. What is not known says why. Lowers the errors of a companion
// that has lost the solution. BOUGH_INTERRUPTED by stop() (NULL: never).
bough_status bough_error_shares_find(bough_arena *arena, bough_companion *c, bool (*stop)(void),
                                     bough_error_shares *shares);

enum { BOUGH_ERROR_WARNING = 600 };

// The error of a motion beside the bound [1]; 0: no bound. Above it BOUGH_FAILED, with channel, time, cause
// and the setting that meets it, unless the mesh alone is the cause: then that is the warning. Else the
// warning is about an error above simulation.accuracy, with the settings that meet it, or that errors are not
// known any more, or "". `shares` is needed above the bound; below it, it makes the settings surer.
bough_status bough_error_judge(const bough_companion *c, const bough_error_shares *shares, double bound,
                               char warning[BOUGH_ERROR_WARNING]);

// Whether the error of a motion is above the bound, so that the cause is to be found.
bool bough_error_exceeds(const bough_companion *c, double bound);

// A run that has parted from its companion: BOUGH_FAILED with channel, time and what to try.
bough_status bough_error_parted(const bough_companion *c);

#endif
