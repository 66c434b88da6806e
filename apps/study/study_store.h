// cells.csv: one line for each run that has ended, appended as it ends, so that an interrupted
// study goes on where it was. A line counts only for the same fingerprint and settings.
#ifndef BOUGH_APPS_STUDY_STUDY_STORE_H
#define BOUGH_APPS_STUDY_STUDY_STORE_H

#include "apps/study/study_run.h"

#include <stdio.h>

typedef struct bough_study_store {
    const bough_study *study;
    FILE *file; // NULL when closed
    const char *path;
} bough_study_store;

// Writes a field of a CSV file, in quotes where it needs them; line ends become blanks.
void bough_csv_text(FILE *file, const char *text);

// Reads folder/cells*.csv into reference (n_reference) and result (n_cell), then opens folder/NAME for more:
// "cells.csv", or "cells-….csv" where several programs fill one folder.
bough_status bough_study_store_open(bough_arena *arena, const char *folder, const char *name,
                                    const bough_study *study, bough_study_result *reference,
                                    bough_study_result *result, bough_study_store *store);

// Appends a run that has ended, and sees it to the disk.
bough_status bough_study_store_add(const bough_study_store *store, const bough_study_cell *cell,
                                   const bough_study_result *result);

// NULL file: does nothing.
void bough_study_store_close(bough_study_store *store);

#endif
