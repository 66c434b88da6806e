// The results of a study as a table: for people in text, for programs in CSV.
#ifndef BOUGH_APPS_STUDY_STUDY_TABLE_H
#define BOUGH_APPS_STUDY_STUDY_TABLE_H

#include "apps/study/study_run.h"

#include <stdio.h>

// Cells of a study and what they came to. Cells that are not done show so.
typedef struct bough_study_results {
    const bough_study *study;
    bough_study_result reference;
    bough_study_result *result; // (n_cell)
} bough_study_results;

// "ok", "failed at t=12.3 s", "not run"
void bough_study_status(const bough_study_result *result, char text[40]);

// Aligned columns, and below them the beginning of each failed run's diagnosis.
void bough_study_print(const bough_study_results *results, FILE *stream);

// folder/table.txt and folder/table.csv.
bough_status bough_study_write_tables(const bough_study_results *results, const char *folder);

#endif
