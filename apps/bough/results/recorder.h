// Streams the channels over time to `channels.out`, a text file in OpenFAST's layout: six free
// lines, names, units, rows. Some of the field's readers look for the word Time, others count
// these lines; both find their columns.
//
// The file is complete or says so: it grows as channels.out.partial with the word INCOMPLETE in its
// third line, and receives its name when the run ends. A process that is killed leaves the partial.
#pragma once

#include "apps/bough/results/channels.h"
#include "apps/bough/results/folder.h"

typedef struct bough_recorder bough_recorder;

typedef struct bough_recorder_def {
    const char *folder;             // an existing folder
    const char *title;              // one line: what was run
    const bough_channels *channels; // outlive the recorder
    bough_kept kept;                // of an earlier process: the rows to continue after; else 0
} bough_recorder_def;

// Opens the file, writes its head and removes an older result of this name. All memory is taken
// here; the arena closes what is not finished.
bough_status bough_recorder_open(bough_arena *arena, const bough_recorder_def *def,
                                 bough_recorder **recorder);

// Asks the channels for their values at t [s] and appends a row.
bough_status bough_recorder_sample(bough_recorder *recorder, double t);

// Brings the rows so far to the disk and counts them.
bough_status bough_recorder_keep(bough_recorder *recorder, bough_kept *kept);

// Ends the file with the run's outcome; the rows of a failed run are kept and marked INCOMPLETE.
// Returns BOUGH_IO when the file could not be written to its end, and then leaves the partial.
bough_status bough_recorder_finish(bough_recorder *recorder, const bough_status *outcome);

// The values of the last row (channels->count).
const double *bough_recorder_values(const bough_recorder *recorder);

// Rows written so far.
long bough_recorder_rows(const bough_recorder *recorder);

// -- numbers, as printf writes them but several times faster --------------------------------------

// Writes x as printf's "%*.8E" does, into exactly `width` characters (at least 16) and a terminator.
void bough_number_write(char *to, int width, double x);

// -- statistics, sample by sample -----------------------------------------------------------------

// Minimum, maximum, mean and standard deviation of a sampled quantity, sample by sample.
//
// B. P. Welford, "Note on a method for calculating corrected sums of squares and products",
// Technometrics 4 (1962).

// All zero: no sample yet.
typedef struct bough_sample_statistics {
    double n; // samples
    double mean;
    double squares;           // Σ (x − mean)²
    double least, most;       // of all samples
    double least_at, most_at; // when each was reached first [s]
} bough_sample_statistics;

void bough_sample_statistics_add(bough_sample_statistics *s, double t, double x);

// The standard deviation of the samples about their mean, √(Σ (x − mean)²/n); NaN without samples.
double bough_sample_statistics_deviation(const bough_sample_statistics *s);

// -- channels.out read back (rows.c) --------------------------------------------------------------

typedef struct bough_rows {
    const char *folder;
    FILE *file;
    char *line; // the present one
    size_t room;
    long at;                   // lines read
    long n_row;                // complete rows
    int n;                     // columns, the time first
    const char **name, **unit; // (n); units in brackets
    double *value;             // (n) of the row read last
} bough_rows;

// Opens a folder's channels.out before its first row. *rows is NULL when there is none; BOUGH_INVALID when
// its head is damaged. The arena closes it.
bough_status bough_rows_open(bough_arena *arena, const char *folder, bough_rows **rows);

// Goes to the next line; false behind the last.
bool bough_rows_line(bough_rows *rows);

// Reads the values of the present line. BOUGH_INVALID when it is no row.
bough_status bough_rows_read(bough_rows *rows);

// The failure of the present line.
bough_status bough_rows_damaged(const bough_rows *rows);

// -- channels.outb (rows.c) -----------------------------------------------------------------------

// The rows of channels.out as `channels.outb`, OpenFAST's binary output, which the field's viewers
// open many times faster than text.
//
// Of its four kinds this is FileFmtID 4, sixteen bits a value with a scale for each channel: the
// only one that keeps names longer than ten characters, and all readers know it (the kind with
// doubles cuts names, and pyDatView cannot read it). A value is off by half of 1/65535 of its
// channel's range, and by its own rounding to single precision; channels.out has nine digits.

typedef struct bough_binary_def {
    const char *folder; // holds the complete channels.out
    const char *title;  // what was run
    const bough_channels *channels;
    double interval; // between the rows [s]; a last row at another time is left out
} bough_binary_def;

// Appears under its name when complete. BOUGH_IO when channels.out cannot be read or the file not
// be written, BOUGH_INVALID for values that are not finite or beyond 1e30.
bough_status bough_binary_write(const bough_binary_def *def);
