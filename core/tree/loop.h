// Closed loops of the tree. The joints form a tree; closures are constraints between two of its
// markers with G v = 0 at the level of speeds, and with them the tree is the ordinary differential
// equation
//     q̇ = N(q)(v − M⁻¹Gᵀ μ),   G M⁻¹Gᵀ μ = g/T,
//     M v̇ + h − τ = Gᵀ λ,      G v̇ + Ġ v = −G v/T.
// On g = 0, G v = 0 it is the motion of the closed mechanism exactly; off it both decay with the
// time constant T, so that every integrator and coupling scheme keeps them at its own tolerance.
// Equations that depend on each other are the normal case (a plane four-bar in space): λ and μ are
// the smallest solutions, each component measured by the motion it causes, so that units do not matter.
// Reference: U. Ascher, H. Chin, L. Petzold, S. Reich, Stabilization of constrained mechanical
// systems with DAEs and invariant manifolds, Mech. Struct. Mach. 23 (1995).
#pragma once

#include "core/tree/tree.h"

// Checks the def's closures and places them in the tree, whose markers stand. BOUGH_INVALID names
// the closure.
bough_status bough_loops_place(bough_arena *arena, const bough_tree_def *def, bough_tree *tree);

// Scratch of the tree's closures; NULL without closures.
bough_loops *bough_loops_create(bough_arena *arena, const bough_tree *tree);

// acceleration v̇ (n_v) that makes the residual zero with all closures closed; without closures
// bough_tree_free_dynamics. False when a joint moves no inertia. Leaves the links' accelerations, the
// factors and `drive` in data.
bool bough_tree_forward_dynamics(const bough_tree *tree, bough_tree_data *data, double t, const double *input,
                                 double *acceleration);

// change (n_v) of v̇ by a wrench at a frame of the tree, in frame axes. Uses the factors of the
// last bough_tree_forward_dynamics.
void bough_tree_response(const bough_tree *tree, bough_tree_data *data, const bough_frame *frame,
                         bough_wrench wrench, double *change);

// Subtracts N(q) M⁻¹Gᵀ μ from q̇ (n_q), after bough_tree_forward_dynamics at this state.
void bough_loops_correct(const bough_tree *tree, const bough_tree_data *data, const double *state,
                         double *rate);

// The wrench of a closure on its second marker, in that marker's axes at its origin [N, N m], after
// bough_tree_forward_dynamics.
bough_wrench bough_loops_wrench(const bough_tree *tree, const bough_tree_data *data, int closure);

// How far the closures are from a singular position, in which the bodies can go on in more than one way: the
// smallest eigenvalue of G M⁻¹Gᵀ, without those that are 0 at the start, relative to the largest [1], and the
// closure with the largest component in its vector. Translations and rotations are scaled to the same
// size. After bough_tree_forward_dynamics, whose factors of the closures it overwrites.
double bough_loops_margin(const bough_tree *tree, bough_tree_data *data, int *closure);

// How far the loops are open: the largest violation of an equation, of positions relative to the extent of
// the bodies and closures [1], and its closure. After bough_tree_kinematics.
double bough_loops_opening(const bough_tree *tree, bough_tree_data *data, int *closure);

// Makes the tree's initial state satisfy its closures: coordinates that nearly do by Newton's method, and
// speeds, of which those that are zero follow the others. BOUGH_INVALID, naming the closure and what remains,
// where that is impossible. Sets closure_rank, closure_moved, closure_size and
// closure_dependent of the tree.
bough_status bough_loops_assemble(bough_tree *tree, bough_tree_data *data);

// The closures' equations at the data's poses and twists, into loops->row.
void bough_loops_rows(const bough_tree *tree, bough_tree_data *data);
