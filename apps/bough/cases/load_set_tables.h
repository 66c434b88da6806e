// The tables of a sweep or a load set. All but costs.csv follow from the cases' results alone.
#ifndef BOUGH_APPS_STUDY_LOAD_SET_TABLES_H
#define BOUGH_APPS_STUDY_LOAD_SET_TABLES_H

#include "apps/bough/cases/lifetime.h"

// cases.csv, a row a case with its channels' statistics, and costs.csv beside it, row by row.
typedef struct bough_case_tables {
    const bough_study *set;
    FILE *cases, *costs;
    char cases_path[4096], costs_path[4096];
} bough_case_tables;

bough_status bough_case_tables_open(const char *folder, const bough_study *set, bough_case_tables *tables);
void bough_case_tables_add(bough_case_tables *t, int number, const bough_case_result *result);

// Gives the files their names, or with `keep` false removes them.
bough_status bough_case_tables_close(bough_case_tables *t, bool keep);

// equivalent.csv, extremes.csv, ranges.csv and levels.csv of a load set.
bough_status bough_lifetime_write(const bough_lifetime *l, const char *folder);

// Prints the most important of these figures.
void bough_lifetime_print(const bough_lifetime *l, FILE *f);

#endif
