// A study of kind two-mass: coupling schemes on two masses and three springs. Of each variant and
// polynomial degree the largest stable macro step, by the eigenvalues of one macro step over a scan
// (stability need not be monotone), the error against the exact solution at several macro steps with
// the order it shows, and the error that the run itself estimates.
#ifndef BOUGH_APPS_STUDY_STUDY_TWO_MASS_H
#define BOUGH_APPS_STUDY_STUDY_TWO_MASS_H

#include "apps/study/study_perform.h"

struct bough_two_mass_study;

// Reads the cases from the root of a study; adds what is wrong to `errors`.
struct bough_two_mass_study *bough_two_mass_read(bough_arena *arena, const bough_node *root,
                                                 bough_errors *errors);

// Prints and writes two-mass.csv and plot.svg. BOUGH_FAILED when a figure is not the expected one.
bough_status bough_two_mass_perform(bough_arena *arena, const bough_study *study,
                                    const bough_study_options *options);

#endif
