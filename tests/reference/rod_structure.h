// The rod as a structure: its vertices are the structure's, vertex 0 is welded to the BRF.
#ifndef BOUGH_TESTS_REFERENCE_ROD_STRUCTURE_H
#define BOUGH_TESTS_REFERENCE_ROD_STRUCTURE_H

#include "flexbody/rod/rod.h"
#include "tests/reference/structure.h"

// The structure borrows the model, which must live as long.
bough_status bough_rod_structure_create(bough_arena *arena, const bough_rod_model *model,
                                        bough_structure **structure);

#endif
