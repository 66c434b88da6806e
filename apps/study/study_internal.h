// What the files that read a study share among themselves.
#ifndef BOUGH_APPS_STUDY_STUDY_INTERNAL_H
#define BOUGH_APPS_STUDY_STUDY_INTERNAL_H

#include "apps/config/schema.h"
#include "apps/study/study.h"

// The tables of sweeps and of load sets, in load_set.c.
extern const bough_schema bough_sweep_schema, bough_load_set_schema;

// Readers of keys with their values, and of keys with lists of values.
void bough_study_read_settings(bough_schema_reader *r, const bough_node *node, void *field);
void bough_study_read_grid(bough_schema_reader *r, const bough_node *node, void *field);

// Of these settings the one that an error in a scene speaks of; NULL: none.
const bough_study_setting *bough_study_concerned(const bough_study_settings *settings, const bough_error *e);

// Makes the cells of the grid and the reference cell.
void bough_study_expand(bough_arena *arena, bough_study *study, bough_errors *errors);

// Reads the scene with every cell's replacements and looks up the measures' channels.
bough_status bough_study_check(bough_arena *arena, bough_study *study, bough_errors *errors);

#endif
