// The rigid tree behind the contract of subsystem.h: kind "tree". State (q, v), input 6 and output 9
// per port, 6 and 13 per end as in tree.h; q̇ = N(q) v and v̇ by the recursive forward dynamics, in
// O(n). Prescribed joints are where their motion says: f and h do not depend on their states, which
// hold q(t) and v(t) at the end of every step, so that nothing drifts under any integrator or scheme.
// Newton's systems are solved in O(n) by tree_newton.h; with closures by dense matrices from
// differences.
#ifndef BOUGH_CORE_TREE_SUBSYSTEM_H
#define BOUGH_CORE_TREE_SUBSYSTEM_H

#include "core/integrator.h"
#include "core/subsystem.h"
#include "core/tree.h"

// A subsystem in the arena at time `start` [s] with the tree's initial state; `name` is copied.
// Tolerance per state: rtol × (1 rad, 1 m, 1 of a quaternion, 1 rad/s, 1 m/s).
bough_status bough_tree_subsystem_create(bough_arena *arena, bough_tree *tree, const char *name,
                                         double start, const bough_integrator_options *options,
                                         bough_subsystem *subsystem);

#endif
