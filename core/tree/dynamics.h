// The recursions of the rigid tree, each O(n) in links, after bough_tree_kinematics at the same
// state. Everything is expressed in link axes at the link's origin, so that the equations are
//     V_i = X_i V_λ + S v ,   A_i = X_i A_λ + V_i × S v + S v̇ ,
//     f_i = I_i (A_i − g_i) + V_i ×* I_i V_i − f_ext + Σ X_jᵀ f_j ,   Sᵀ f_i = τ ,
// λ the parent, j the children, A the rate of V's components. Of a joint with prescribed motion v̇ is
// given; Sᵀ f_i − τ is then what drives it.
// Reference: R. Featherstone, Rigid Body Dynamics Algorithms, 2008, chapters 5 to 7.
#pragma once

#include "core/tree/tree.h"

// Poses, twists and gravity of all links at a state (n_q + n_v). The
// queries of tree.h read them.
void bough_tree_kinematics(const bough_tree *tree, const double *state, bough_tree_data *data);

// residual (n_v) = M(q) v̇ + h(q, v) − τ(t, q, u) with v̇ = acceleration (n_v), u the wrenches of
// ports and ends (6 each) or NULL for none: springs, joint loads, these and external wrenches are
// within τ and h. The row of a prescribed joint is v̇ − a(t), and in the other rows its v̇ is a(t). Sets
// data->drive.
void bough_tree_inverse_dynamics(const bough_tree *tree, bough_tree_data *data, double t, const double *input,
                                 const double *acceleration, double *residual);

// A rigid inertia as the matrix from a twist to a wrench.
void bough_tree_rigid_matrix(const bough_inertia *inertia, double a[36]);

// acceleration v̇ (n_v) that makes the residual zero, by articulated bodies, as if all closures were
// cut open and the tree moved under their wrenches, whose multipliers stand in data->loops. False
// when a joint moves no inertia. Leaves the links' accelerations, the factors and `drive` in data.
bool bough_tree_free_dynamics(const bough_tree *tree, bough_tree_data *data, double t, const double *input,
                              double *acceleration);

// The wrench on an end in its body's axes, from the six inputs of the end.
bough_wrench bough_tree_end_wrench(const bough_tree *tree, const bough_tree_data *data, int end,
                                   const double *input);

// change (n_v) of v̇ by a wrench at a frame of the tree, in frame axes, without closures. Uses the
// factors of the last bough_tree_free_dynamics. Leaves the change of the links' accelerations in data.
void bough_tree_free_response(const bough_tree *tree, bough_tree_data *data, const bough_frame *frame,
                              bough_wrench wrench, double *change);

// q̇ = N(q) v for the whole state: rate (n_q)
void bough_tree_coordinate_rate(const bough_tree *tree, const double *state, double *rate);

// The tangents of the links' twists and rotations along a change (n_q + n_v) of the state, into
// data->acceleration and data->rotation. Along the motion's own rate they are the exact rates.
void bough_tree_tangent(const bough_tree *tree, const double *state, const double *change,
                        bough_tree_data *data);
