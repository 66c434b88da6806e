// What the files on closed loops share among themselves.
#ifndef BOUGH_CORE_LOOP_INTERNAL_H
#define BOUGH_CORE_LOOP_INTERNAL_H

#include "core/tree/loop.h"

// The marker at an end of a closure, and the closure that an equation belongs to.
const bough_frame *bough_loops_end(const bough_tree *tree, int closure, int end);
int bough_loops_of_row(const bough_tree *tree, int row);

// The closures' equations at the data's poses and twists, into loops->row.
void bough_loops_rows(const bough_tree *tree, bough_tree_data *data);

// loops->response = M⁻¹Gᵀ and the factors of G M⁻¹Gᵀ, after bough_loops_rows and
// bough_tree_free_dynamics. False when not finite. Uses all of loops->work.
bool bough_loops_mobility(const bough_tree *tree, bough_tree_data *data);

// Factors the symmetric loops->matrix: scaled to a diagonal of one, by its eigenvectors. Rows that
// nothing moves drop out.
bool bough_loops_factor(const bough_tree *tree, bough_loops *loops);

// The least x of all that solve (matrix) x = b as far as it can be, b in place of x (n_rows), which
// is none of the first n_rows of loops->work.
void bough_loops_solve(const bough_tree *tree, const bough_loops *loops, double *x);

// speed (n_v) = responseᵀ x
void bough_loops_spread(const bough_tree *tree, const bough_loops *loops, const double *x, double *speed);

#endif
