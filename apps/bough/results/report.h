// One page of a results folder: figures, curves, spectra, the moving shape, or a study's table and
// picture. It carries its data and its program, and needs no network.
#pragma once

#include "core/base/arena.h"

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

// Draws the stored frame that is nearest to this time [s], the last one for HUGE_VAL, to scale, coloured by
// the section moment: shape.svg in the folder. Nothing is drawn where there is no frame; BOUGH_INVALID where
// the time is given and no frame is stored, or none so early or so late.
bough_status bough_report_shape(bough_arena *arena, const char *folder, double time, bool *drawn);

// Opens folder/name; NULL when it does not exist.
bough_status bough_report_open(const char *folder, const char *name, FILE **file);
