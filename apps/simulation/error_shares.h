// The errors of mesh and air in the channels of a run. The scene is run again with twice the segments in each
// rod, and with twice the sampling rate of the air. A part of the difference is the error; the part follows
// from the order of convergence. All these runs have short time steps, because the errors in time of two runs
// do not cancel.
#ifndef BOUGH_APPS_SIMULATION_ERROR_SHARES_H
#define BOUGH_APPS_SIMULATION_ERROR_SHARES_H

#include "apps/simulation/run.h"

typedef enum bough_error_share_kind {
    BOUGH_SHARE_MESH,
    BOUGH_SHARE_AIR,
    BOUGH_SHARES,
} bough_error_share_kind;

typedef struct bough_error_share {
    char unknown[160]; // why it is not estimated; "": it is
    double *largest;   // (n_channel) largest error of each channel in the run, in its unit
    double part;       // the error by the difference [1]
    double order;      // at which it falls with the length of segments, or the time between samples
    double cpu_s;      // of the runs made for it [s]
} bough_error_share;

typedef struct bough_error_shares {
    int n_channel;   // the run's channels that follow from the states
    int n_row, most; // rows noted, and how many there is room for
    double *row;     // (most × n_channel); NULL: nobody asks
    bough_error_share share[BOUGH_SHARES];
} bough_error_shares;

const char *bough_error_share_name(bough_error_share_kind kind);

// Gives each rod of the scene `times` as many segments, in arrays of their own, and sets the part of the
// difference that is the error. False, with the reason in the share, for modal bodies, scenes without rods
// and controllers that cannot be run twice.
bool bough_error_share_refine(bough_arena *arena, bough_scene *scene, int times, bough_error_share *share);

// Prepares for the rows that the run records every `interval` [s]. Takes memory only if the scene asks for
// the shares.
bough_status bough_error_shares_create(bough_arena *arena, const bough_run *run, double interval,
                                       bough_error_shares *shares);

// Notes a recorded row of the run.
void bough_error_shares_note(bough_error_shares *shares, bough_run *run);

// After a complete run: runs the scene again for each share. What cannot be estimated says why.
void bough_error_shares_find(bough_error_shares *shares, const bough_run *run, double interval);

// A warning about a share that is a noticeable error of a channel of motion, with the bound [1] at most, or "".
void bough_error_share_warn(const bough_error_shares *shares, bough_error_share_kind kind,
                            const bough_error_probe *probe, double bound, char text[BOUGH_ERROR_WARNING]);

// BOUGH_FAILED, with channel, cause and what to try, when a share exceeds the bound [1]; 0: no bound.
bough_status bough_error_shares_judge(const bough_error_shares *shares, const bough_error_probe *probe,
                                      double bound);

#endif
