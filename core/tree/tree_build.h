// Building the rigid tree from its def.
#ifndef BOUGH_CORE_TREE_BUILD_H
#define BOUGH_CORE_TREE_BUILD_H

#include "core/tree/tree.h"

// Builds the tree in the arena from a def whose indices are valid, parents without a cycle.
// BOUGH_INVALID, naming the body, for a place that is not finite, a joint that moves no inertia and a
// loop that does not close.
bough_status bough_tree_create(bough_arena *arena, const bough_tree_def *def, bough_tree **tree);

// Data for evaluations of the tree; as many as there are threads or users.
bough_tree_data *bough_tree_data_create(bough_arena *arena, const bough_tree *tree);

#endif
