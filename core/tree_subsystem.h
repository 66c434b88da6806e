// The rigid tree behind the contract of subsystem.h: kind "tree". State (q, v), input 6 and output 9
// per port, 6 and 13 per end as in tree.h. Its own steps solve, by IDA, the implicit form
//     q̇ − N(q) v = 0,   M(q) v̇ + h(q, v) − τ(t, q, u) = 0,
// the second row evaluated by the recursive inverse dynamics, or, by Radau IIA, ẏ = f with the
// recursive forward dynamics; both in O(n). For prescribed joints both rows are algebraic under IDA,
// q = q(t) and v = v(t), so that nothing drifts. Newton's systems are solved in O(n) by
// tree_newton.h; with closures, and under Radau, by dense matrices from differences.
#ifndef BOUGH_CORE_TREE_SUBSYSTEM_H
#define BOUGH_CORE_TREE_SUBSYSTEM_H

#include "core/subsystem.h"
#include "core/tree.h"

typedef enum bough_tree_solver { BOUGH_TREE_IDA, BOUGH_TREE_RADAU } bough_tree_solver;

// A subsystem in the arena at time `start` [s] with the tree's initial state; `name` is copied.
// Tolerance per state: rtol × (1 rad, 1 m, 1 of a quaternion, 1 rad/s, 1 m/s).
bough_status bough_tree_subsystem_create(bough_arena *arena, bough_tree *tree, const char *name,
                                         double start, bough_tree_solver solver, double rtol,
                                         bough_subsystem *subsystem);

#endif
