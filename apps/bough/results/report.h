// One page of a results folder: figures, curves, spectra, the moving shape, or a study's table and
// picture. It carries its data and its program, and needs no network.
#ifndef BOUGH_APPS_RESULTS_REPORT_H
#define BOUGH_APPS_RESULTS_REPORT_H

#include "core/base/arena.h"
#include "core/base/status.h"

#include <stdbool.h>
#include <stdio.h>

// The page with a line "@DATA@" where the data go; ends with a zero.
extern const unsigned char bough_report_page[];

// Writes report.html into the first of n folders, complete or not at all: of its results, with the
// channels of the other folders, which hold runs, beside its own. BOUGH_INVALID when a folder holds no
// results, or when they are damaged: the message names the file.
bough_status bough_report_write(bough_arena *arena, int n, const char *const *folder);

// -- parts of the data, each a JavaScript expression; none when *found is false ------------------

typedef bough_status bough_report_part(bough_arena *arena, const char *folder, FILE *out, bool *found);

// {names, units, rows} of channels.out; of very many rows every n-th.
bough_report_part bough_report_channels;

// {ends, frames: [[t, x, y, z, …], …]} of frames.pvd and what it lists.
bough_report_part bough_report_frames;

// -- the shape at one time ------------------------------------------------------------------------

// A frame as apps/bough/results/frames.c has written it.
typedef struct bough_stored_frame {
    double time; // [s]
    int n_point, n_line;
    double *point;  // (n_point × 3) in ground axes [m]
    double *moment; // (n_point × 3) section moments in ground axes, 0 for bodies other than rods [N m]
    int *end;       // (n_line) behind each line's last point
} bough_stored_frame;

// The stored frame that is nearest to this time [s], the last one for HUGE_VAL; n_line is 0 where a run has
// stored none.
bough_status bough_report_frame(bough_arena *arena, const char *folder, double time,
                                bough_stored_frame *frame);

// Draws it to scale, coloured by the section moment: shape.svg in the folder. Nothing is drawn where there is
// no frame.
bough_status bough_report_shape(bough_arena *arena, const char *folder, double time, bool *drawn);

// Opens folder/name; NULL when it does not exist.
bough_status bough_report_open(const char *folder, const char *name, FILE **file);

#endif
