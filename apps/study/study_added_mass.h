// A study of kind added-mass: how many evaluations it takes to close an interface on which a mass
// rides that is r times the one which carries it. Two forms:
//   - the map u ← −r u + b of the added mass alone, to 1e-10, per accelerator;
//   - a coupled run in which the mass hangs on a stiff damper and spring, so that it answers within the
//     macro step as if welded on, for every way to couple it.
#ifndef BOUGH_APPS_STUDY_STUDY_ADDED_MASS_H
#define BOUGH_APPS_STUDY_STUDY_ADDED_MASS_H

#include "apps/study/study_perform.h"

struct bough_added_mass_study;

// Reads the cases from the root of a study; adds what is wrong to `errors`.
struct bough_added_mass_study *bough_added_mass_read(bough_arena *arena, const bough_node *root,
                                                     bough_errors *errors);

// Prints and writes added-mass.csv and plot.svg. BOUGH_FAILED when a count is not the expected one.
bough_status bough_added_mass_perform(bough_arena *arena, const bough_study *study,
                                      const bough_study_options *options);

#endif
