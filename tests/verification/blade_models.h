// A study of kind blade-models: one blade modelled in several ways against a converged reference. The
// clamped blade under a load: deflection, twist and frequencies, undeformed and about the bent
// shape. A run of the turbine: differences over the run and processor time, runs interleaved.
#pragma once

#include "tests/verification/verification.h"

// Reads the study at `path` from its root; adds what is wrong to `errors`.
void *bough_blade_models_read(bough_arena *arena, const char *path, const bough_node *root,
                              bough_errors *errors);

// Prints the table and writes blade-models.csv.
bough_status bough_blade_models_perform(bough_arena *arena, const void *study,
                                        const bough_verification_options *options);
