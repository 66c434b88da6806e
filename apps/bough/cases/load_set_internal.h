// What the files that read a load set share among themselves.
#ifndef BOUGH_APPS_STUDY_LOAD_SET_INTERNAL_H
#define BOUGH_APPS_STUDY_LOAD_SET_INTERNAL_H

#include "apps/bough/cases/load_set.h"

// The set and its cases as the text says, without a look at the scenes; NULL after an error.
bough_load_set *bough_load_set_parse(bough_arena *arena, const char *path, const bough_node *root,
                                     bough_errors *errors);

// Makes the cases of all groups.
void bough_load_set_expand(bough_arena *arena, bough_load_set *set, bough_errors *errors);

// Reads every case's scene, looks up the channels and takes the fingerprints.
bough_status bough_load_set_check(bough_arena *arena, bough_load_set *set, bough_errors *errors);

#endif
