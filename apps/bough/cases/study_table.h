// The results of a study as a table: for people in text, for programs in CSV.
#ifndef BOUGH_APPS_STUDY_STUDY_TABLE_H
#define BOUGH_APPS_STUDY_STUDY_TABLE_H

#include "apps/bough/cases/study_cells.h"

#include <stdio.h>

// Writes a field of a CSV file, in quotes where it needs them; line ends become blanks.
void bough_csv_text(FILE *file, const char *text);

// "ok", "failed at t=12.3 s", "not run"
void bough_study_status(const bough_case_result *result, char text[40]);

// Aligned columns, and below them the beginning of each failed run's diagnosis.
void bough_study_print(const bough_study_results *results, FILE *stream);

// folder/table.txt and folder/table.csv.
bough_status bough_study_write_tables(const bough_study_results *results, const char *folder);

#endif
