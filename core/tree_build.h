// Building the rigid tree from its def.
#ifndef BOUGH_CORE_TREE_BUILD_H
#define BOUGH_CORE_TREE_BUILD_H

#include "core/tree.h"

// Builds the tree in the arena. BOUGH_INVALID for an unknown parent, a cycle, a joint that moves
// no inertia and the like, naming the body.
bough_status bough_tree_create(bough_arena *arena, const bough_tree_def *def, bough_tree **tree);

// Data for evaluations of the tree; as many as there are threads or users.
bough_tree_data *bough_tree_data_create(bough_arena *arena, const bough_tree *tree);

#endif
