// Newton's linear systems of a tree without closed loops, exactly and in O(n): the linearised
// recursion, solved as articulated bodies are. With the changes
//     ζ = (ξ, δV, δA)   of a link's pose, twist and acceleration, in link axes,
//     ζ_i = 𝒳_i ζ_λ + Σ_i x + ζ⁰_i ,   x = δv of its joint,
//     δf_i = 𝒜_i ζ_i + p_i ,   Sᵀ δf_i − δτ = r ,
// elimination of x from the leaves to the root gives 𝒜 (6 × 18) and p of each parent. Gravity is
// an acceleration of the ground, so that it needs no terms of its own. Springs and bushings
// connect links that are not neighbours. They add a system of six unknowns for each of their ends
// (Woodbury).
#pragma once

#include "core/tree/tree.h"

typedef struct bough_tree_newton bough_tree_newton;

// For a tree without closures; all memory is taken here.
bough_tree_newton *bough_tree_newton_create(bough_arena *arena, const bough_tree *tree);

// Linearises at (t, state, v̇ = acceleration, input) and factors
//     c δq − δ(N(q) v) = r_q ,   δ(M v̇ + h − τ) with δv̇ = c δv + a = r_v ;
// of prescribed joints δq = r_q, δv = r_v. Overwrites the data. False when singular.
bool bough_tree_newton_setup(bough_tree_newton *newton, bough_tree_data *data, double t, const double *input,
                             const double *state, const double *acceleration, double c);

// Solves in place: x (n_q + n_v) holds r, then (δq, δv). The known change `a` of v̇ (n_v) may be
// NULL for none.
void bough_tree_newton_solve(bough_tree_newton *newton, const double *a, double *x);
