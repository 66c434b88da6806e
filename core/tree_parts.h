// What the files that build the tree share among themselves.
#ifndef BOUGH_CORE_TREE_PARTS_H
#define BOUGH_CORE_TREE_PARTS_H

#include "core/tree.h"

// BOUGH_INVALID, naming the part that is wrong.
bough_status bough_tree_check(const bough_tree_def *def);

// Number of bodies between the ground and a body; -1 in a cycle
int bough_tree_depth(const bough_tree_def *def, int body);

#endif
