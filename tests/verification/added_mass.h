// A study of kind added-mass: how many evaluations it takes to close an interface on which a mass
// rides that is r times the one which carries it. Two forms:
//   - the map u ← −r u + b of the added mass alone, to 1e-10, per accelerator;
//   - a coupled run in which the mass hangs on a stiff damper and spring, so that it answers within the
//     macro step as if welded on, for every way to couple it.
#ifndef BOUGH_TESTS_VERIFICATION_ADDED_MASS_H
#define BOUGH_TESTS_VERIFICATION_ADDED_MASS_H

#include "tests/verification/verification.h"

// Reads the cases from the root of a study; adds what is wrong to `errors`.
void *bough_added_mass_read(bough_arena *arena, const char *path, const bough_node *root,
                            bough_errors *errors);

// Prints and writes added-mass.csv and plot.svg. BOUGH_FAILED when a count is not the expected one.
bough_status bough_added_mass_perform(bough_arena *arena, const void *study,
                                      const bough_verification_options *options);

#endif
