// The rigid tree behind the contract of system.h: kind "tree". State (q, v), input 6 and output 9
// per port, 6 and 13 per end, output 9 per port with axes, as in tree.h; q̇ = N(q) v and v̇ by the
// recursive forward dynamics, in O(n). Prescribed joints are where their motion says: f and h do not depend
// on their states, which hold q(t) and v(t) at the end of every step, so that nothing drifts under any
// integrator or scheme. Newton's systems are solved in O(n) by tree_newton.h; with closures by dense matrices
// from differences.
#ifndef BOUGH_CORE_TREE_SYSTEM_H
#define BOUGH_CORE_TREE_SYSTEM_H

#include "core/solve/system.h"
#include "core/tree/tree.h"

// A system in the arena; `name` is copied. Tolerance per state: rtol × (1 rad, 1 m, 1 of a quaternion,
// 1 rad/s, 1 m/s).
bough_system bough_tree_system_create(bough_arena *arena, bough_tree *tree, const char *name);

#endif
