// What the files on Newton's systems of the tree share among themselves.
#ifndef BOUGH_CORE_TREE_NEWTON_INTERNAL_H
#define BOUGH_CORE_TREE_NEWTON_INTERNAL_H

#include "core/tree/tree_newton.h"

enum { BOUGH_TWIST = 6, BOUGH_CHANGE = 18 }; // components of a twist, of ζ

// ζ of a link
typedef struct bough_newton_change {
    bough_twist pose, speed, acceleration;
} bough_newton_change;

enum { BOUGH_NEWTON_ROWS = BOUGH_TWIST * BOUGH_CHANGE, BOUGH_NEWTON_BLOCK = 24 * 12 };

// A link's part of the factors, in its own axes
typedef struct bough_newton_node {
    bough_transform relative;
    bough_twist speed, joint, carried, pulled;    // V, S v, X V_λ, X (A_λ − g)
    bough_wrench force;                           // through the joint, F
    bough_wrench end_force;                       // of an end, which keeps its direction when the link turns
    double tau_q, tau_v;                          // −∂τ/∂q, −∂τ/∂v
    double matrix[BOUGH_NEWTON_ROWS];             // 𝒜 (6 × 18)
    double column[BOUGH_NEWTON_ROWS];             // Σ, a row per speed
    double back[BOUGH_NEWTON_ROWS];               // D⁻¹ Sᵀ𝒜, a row per speed
    double gain[BOUGH_TWIST * BOUGH_TWIST];       // what x gives the parent, a row per speed
    double coordinate[BOUGH_TWIST * BOUGH_TWIST]; // δη along each speed, a row per speed
    double factor[BOUGH_TWIST * BOUGH_TWIST];     // D
    int pivot[BOUGH_TWIST];
    // of the present solution
    bough_newton_change known, total; // ζ⁰, ζ
    bough_wrench load;                // p
    double speeds[BOUGH_TWIST];       // x
} bough_newton_node;

// One end of a spring or bushing on a link
typedef struct bough_newton_end {
    int element, side, link;
    const bough_frame *frame;
} bough_newton_end;

struct bough_tree_newton {
    const bough_tree *tree;
    bough_newton_node *node; // (n_links)
    double c;                // δv̇ = c δv
    double *state;           // (n_q + n_v) where it is linearised
    int n_ends, n_rows;      // n_rows = 6 n_ends
    bough_newton_end *ends;  // (n_ends)
    double *block;           // J of each element: ∂(both wrenches)/∂(poses, twists), 24 rows of 12
    double *matrix;          // E − J T⁻¹ Eᵀ (n_rows × n_rows, column-major)
    int *pivot;              // (n_rows)
    double *coupling;        // (n_rows) changes of the ends' wrenches
    double *zero;            // (n_q + n_v) zeros
    double *keep;            // (n_q + n_v) scratch
};

// Solves without the springs and bushings, into the nodes' speeds and total changes: r as in
// bough_tree_newton_solve, the ends' wrenches changed by `coupling` (n_rows) or NULL for none.
void bough_newton_sweep(const bough_tree_newton *newton, const double *coupling, const double *a,
                        const double *r);

// Lists the ends of springs and bushings, which sets n_ends and n_rows.
void bough_newton_list_ends(bough_tree_newton *newton);

// Their tangents at the data's poses and twists, then the factors of the system that couples them.
void bough_newton_blocks(const bough_tree_newton *newton, const bough_tree_data *data);
bool bough_newton_factor_coupling(const bough_tree_newton *newton);

// The changes of the ends' wrenches from those that the present solution has, in newton->coupling.
void bough_newton_solve_coupling(const bough_tree_newton *newton);

#endif
