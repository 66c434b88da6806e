// Springs and bushings in Newton's systems of the tree: the changes c of the wrenches at their ends
// are J ζ, and ζ those of the tree without them under c: (E − J T⁻¹ Eᵀ) c = J T⁻¹ r.
#include "core/tree/tree_newton_internal.h"

#include "core/tree/force.h"
#include "core/base/linalg.h"

#include <string.h>

enum { N = BOUGH_TWIST };

typedef bough_twist twist;

static const twist no_twist;

void bough_newton_list_ends(bough_tree_newton *w) {
    for (int e = 0; e < bough_tree_n_elements(w->tree); e++) {
        for (int side = 0; side < 2; side++) {
            const bough_frame *frame = bough_element_frame(w->tree, e, side);
            if (frame->link < 0) continue;
            w->ends[w->n_ends++] = (bough_newton_end){e, side, frame->link, frame};
        }
    }
    w->n_rows = N * w->n_ends;
}

void bough_newton_blocks(const bough_tree_newton *w, const bough_tree_data *d) {
    for (int e = 0; e < bough_tree_n_elements(w->tree); e++) {
        for (int k = 0; k < 24; k++) {
            twist shift[2] = {no_twist, no_twist}, rate[2] = {no_twist, no_twist};
            (k < 12 ? shift : rate)[(k / N) % 2] = bough_twist_unit(k % N);
            bough_force_pair by = bough_element_change(w->tree, d, e, shift, rate);
            double *row = w->block + (size_t)BOUGH_NEWTON_BLOCK * (size_t)e + 12 * k;
            bough_wrench_store(by.on[0], row);
            bough_wrench_store(by.on[1], row + N);
        }
    }
}

// How the present ζ change the ends' wrenches (n_rows)
static void find_coupling(const bough_tree_newton *w, double *change_of) {
    memset(change_of, 0, (size_t)w->n_rows * sizeof(double));
    for (int e = 0; e < w->n_ends; e++) {
        const bough_newton_end *from = &w->ends[e];
        double z[2 * N];
        const bough_newton_node *n = &w->node[from->link];
        bough_twist_store(bough_twist_to_child(&from->frame->placement, n->total.pose), z);
        bough_twist_store(bough_twist_to_child(&from->frame->placement, n->total.speed), z + N);
        const double *block = w->block + (size_t)BOUGH_NEWTON_BLOCK * (size_t)from->element;
        // the ends of one element are neighbours in the list
        for (int to = e - 1 < 0 ? 0 : e - 1; to <= e + 1 && to < w->n_ends; to++) {
            if (w->ends[to].element != from->element) continue;
            for (int k = 0; k < 2 * N; k++) {
                int column = (k < N ? 0 : 12) + N * from->side + k % N;
                for (int r = 0; r < N; r++)
                    change_of[N * to + r] += block[12 * column + N * w->ends[to].side + r] * z[k];
            }
        }
    }
}

bool bough_newton_factor_coupling(const bough_tree_newton *w) {
    int m = w->n_rows;
    for (int j = 0; j < m; j++) {
        double *column = w->matrix + (size_t)m * (size_t)j;
        memset(w->coupling, 0, (size_t)m * sizeof(double));
        w->coupling[j] = 1;
        bough_newton_sweep(w, w->coupling, NULL, w->zero);
        find_coupling(w, column);
        for (int i = 0; i < m; i++) column[i] = (i == j ? 1 : 0) - column[i];
    }
    return bough_dense_factor(m, w->matrix, w->pivot);
}

void bough_newton_solve_coupling(const bough_tree_newton *w) {
    find_coupling(w, w->coupling);
    bough_dense_solve(w->n_rows, 1, w->matrix, w->pivot, w->coupling);
}
