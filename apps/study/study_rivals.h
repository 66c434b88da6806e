// A study of kind rivals: one blade modelled in several ways against a converged reference. The
// clamped blade under a load: deflection, twist and frequencies, undeformed and about the bent
// shape. A run of the turbine: differences over the run and processor time, runs interleaved.
#ifndef BOUGH_APPS_STUDY_STUDY_RIVALS_H
#define BOUGH_APPS_STUDY_STUDY_RIVALS_H

#include "apps/study/study_perform.h"

struct bough_rivals;

// Reads the study at `path` from its root; adds what is wrong to `errors`.
struct bough_rivals *bough_rivals_read(bough_arena *arena, const char *path,
                                       const bough_node *root, bough_errors *errors);

// Prints the table and writes rivals.csv.
bough_status bough_rivals_perform(bough_arena *arena, const bough_study *study,
                                  const bough_study_options *options);

#endif
