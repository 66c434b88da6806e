// A study of kind two-mass: coupling schemes on two masses and three springs. Of each variant and
// polynomial degree the largest stable macro step, by the eigenvalues of one macro step over a scan
// (stability need not be monotone), the error against the exact solution at several macro steps with
// the order it shows, and the error that the run itself estimates.
#ifndef BOUGH_TESTS_VERIFICATION_TWO_MASS_STUDY_H
#define BOUGH_TESTS_VERIFICATION_TWO_MASS_STUDY_H

#include "tests/verification/verification.h"

// Reads the cases from the root of a study; adds what is wrong to `errors`.
void *bough_two_mass_read(bough_arena *arena, const char *path, const bough_node *root, bough_errors *errors);

// Prints and writes two-mass.csv and plot.svg. BOUGH_FAILED when a figure is not the expected one.
bough_status bough_two_mass_perform(bough_arena *arena, const void *study,
                                    const bough_verification_options *options);

#endif
