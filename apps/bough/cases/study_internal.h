// What the files that read a study share among themselves.
#ifndef BOUGH_APPS_STUDY_STUDY_INTERNAL_H
#define BOUGH_APPS_STUDY_STUDY_INTERNAL_H

#include "apps/bough/config/schema.h"
#include "apps/bough/results/channels.h"
#include "apps/bough/cases/study.h"

// The tables of sweeps and of load sets, in load_set.c.
extern const bough_schema bough_sweep_schema, bough_load_set_schema;

// Readers of keys with their values, and of keys with lists of values.
void bough_study_read_settings(bough_schema_reader *r, const bough_node *node, void *field);
void bough_study_read_grid(bough_schema_reader *r, const bough_node *node, void *field);

// Of these settings the one that an error in a scene speaks of; NULL: none.
const bough_study_setting *bough_study_concerned(const bough_study_settings *settings, const bough_error *e);

// The same of a grid's values at these places on its axes.
const bough_study_setting *bough_study_concerned_value(const bough_study_grid *grid, const int *index,
                                                       const bough_error *e);

// Adds an error of a run's scene, once for all runs that have it: an error in a replacement at `origin`,
// where the study gives it.
void bough_study_tell(const bough_error *e, const char *scene, const bough_node *origin,
                      bough_errors *errors);

// Adds the error that the scene has no channel of that name.
void bough_study_unknown_channel(const bough_channels *channels, const char *name, const bough_node *node,
                                 const char *key, bough_errors *errors);

// The number of a grid's combinations, at most `most` + 1; the places on the axes of the combination
// `number`, the last axis runs fastest; and these as text, "scheme=ramp, macro_step=5 ms".
int bough_grid_count(const bough_study_grid *grid, int most);
void bough_grid_place(const bough_study_grid *grid, int number, int *index);
const char *bough_grid_settings(bough_arena *arena, const bough_study_grid *grid, const int *index);

// Makes the cells of the grid and the reference cell.
void bough_study_expand(bough_arena *arena, bough_study *study, bough_errors *errors);

// Reads the scene with every cell's replacements and looks up the measures' channels.
bough_status bough_study_check(bough_arena *arena, bough_study *study, bough_errors *errors);

#endif
