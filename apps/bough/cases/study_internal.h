// What the files that read a study share among themselves.
#ifndef BOUGH_APPS_CASES_STUDY_INTERNAL_H
#define BOUGH_APPS_CASES_STUDY_INTERNAL_H

#include "apps/bough/cases/study.h"
#include "apps/bough/config/schema.h"

// The study and its cases as the text says, without a look at the scenes; NULL after an error.
bough_study *bough_study_parse(bough_arena *arena, const char *path, const bough_node *root,
                               bough_errors *errors);

// Readers of keys with their values, and of keys with lists of values.
void bough_study_read_settings(bough_schema_reader *r, const bough_node *node, void *field);
void bough_study_read_grid(bough_schema_reader *r, const bough_node *node, void *field);

// The number of a grid's combinations, at most `most` + 1; the places on the axes of the combination
// `number`, the last axis runs fastest; and these as text, "scheme=ramp, macro_step=5 ms".
int bough_grid_count(const bough_study_grid *grid, int most);
void bough_grid_place(const bough_study_grid *grid, int number, int *index);
const char *bough_grid_settings(bough_arena *arena, const bough_study_grid *grid, const int *index);

// Makes the cases of all groups, and the references.
void bough_study_expand(bough_arena *arena, bough_study *study, bough_errors *errors);

// Reads every case's scene, looks up the channels and takes the fingerprints.
bough_status bough_study_check(bough_arena *arena, bough_study *study, bough_errors *errors);

#endif
