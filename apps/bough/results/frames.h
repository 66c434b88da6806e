// Shapes over time for ParaView: frames/NNNNNN.vtp, one file of polylines for each frame (VTK XML
// PolyData, ASCII), and frames.pvd, which gives them their times and appears when the run ends.
#pragma once

#include "apps/bough/results/folder.h"

typedef struct bough_frames bough_frames;

typedef struct bough_polyline {
    const char *name; // of the body
    int n_point;
} bough_polyline;

typedef struct bough_frames_def {
    const char *folder; // an existing folder
    int n_line;
    const bough_polyline *line; // (n_line), outlives the frames
    // Fills the points of all lines, in order (Σ n_point × 3), in ground axes [m].
    void (*points)(void *self, double *point);
    // Fills the section loads at these points at time t (Σ n_point × 3), in ground axes [N], [N m].
    void (*loads)(void *self, double t, double *force, double *moment);
    void *self;
    bough_kept kept; // of an earlier process: the frames to continue after; else 0
} bough_frames_def;

// Makes the folder for the frames and removes an older frames.pvd. All memory is taken here.
bough_status bough_frames_open(bough_arena *arena, const bough_frames_def *def, bough_frames **frames);

// Writes the frame of time t [s].
bough_status bough_frames_sample(bough_frames *frames, double t);

// Brings the list of the frames so far to the disk and counts them.
bough_status bough_frames_keep(bough_frames *frames, bough_kept *kept);

// Writes frames.pvd and removes the frames of an earlier run that this one has not replaced.
bough_status bough_frames_finish(bough_frames *frames);

// Removes all frames of an earlier run from its folder, and their list.
bough_status bough_frames_remove(const char *folder);
