// What the files that build the tree share among themselves.
#ifndef BOUGH_CORE_TREE_INTERNAL_H
#define BOUGH_CORE_TREE_INTERNAL_H

#include "core/tree.h"

// BOUGH_INVALID, naming the part that is wrong.
bough_status bough_tree_check(const bough_tree_def *def);

// The bodies level by level from the ground, within a level in the order of the definition: order
// (n_bodies). scratch (2·n_bodies + 1) zeros. The parents must exist; BOUGH_INVALID for a cycle.
bough_status bough_tree_order(const bough_tree_def *def, int *scratch, int *order);

#endif
