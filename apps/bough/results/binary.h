// The rows of channels.out as `channels.outb`, OpenFAST's binary output, which the field's viewers
// open many times faster than text.
//
// Of its four kinds this is FileFmtID 4, sixteen bits a value with a scale for each channel: the
// only one that keeps names longer than ten characters, and all readers know it (the kind with
// doubles cuts names, and pyDatView cannot read it). A value is off by half of 1/65535 of its
// channel's range, and by its own rounding to single precision; channels.out has nine digits.
#ifndef BOUGH_APPS_RESULTS_BINARY_H
#define BOUGH_APPS_RESULTS_BINARY_H

#include "apps/bough/results/channels.h"
#include "core/base/status.h"

typedef struct bough_binary_def {
    const char *folder; // holds the complete channels.out
    const char *title;  // what was run
    const bough_channels *channels;
    double interval; // between the rows [s]; a last row off this beat is left out
} bough_binary_def;

// Appears under its name when complete. BOUGH_IO when channels.out cannot be read or the file not
// be written, BOUGH_INVALID for values that are not finite or beyond 1e30.
bough_status bough_binary_write(const bough_binary_def *def);

#endif
