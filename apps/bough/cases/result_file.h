// The result of one run as a file of the study's folder, cases/NAME.case: text, complete or absent. Its
// head says of which input it is and how the run ended; then rows of a word and numbers, which keep all
// their digits.
#ifndef BOUGH_APPS_STUDY_RESULT_FILE_H
#define BOUGH_APPS_STUDY_RESULT_FILE_H

#include "core/base/status.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

typedef struct bough_result_file {
    const char *folder; // of the study
    char name[24];
    uint64_t fingerprint; // of all that the result depends on
} bough_result_file;

// Makes the folder cases/ of a study.
bough_status bough_result_folder(const char *folder);

// Writes a file: its head, then what `put` writes of `self`.
bough_status bough_result_write(const bough_result_file *file, const bough_status *outcome,
                                void (*put)(const void *self, FILE *stream), const void *self);

// Opens the file behind its head; *stream is NULL when there is none or it is of other input. BOUGH_IO: it
// cannot be read.
bough_status bough_result_open(const bough_result_file *file, bough_status *outcome, FILE **stream);

// Closes the file. BOUGH_IO unless its rows were as expected, up to the end.
bough_status bough_result_close(const bough_result_file *file, FILE *stream, bool good);

// A row of a word and a text, in one line.
void bough_result_text(FILE *stream, const char *word, const char *text);

// A row of n numbers, written and read; false where it is another.
void bough_result_put(FILE *stream, const char *word, int n, const double *x);
bool bough_result_take(FILE *stream, const char *word, int n, double *x);

#endif
