#include "apps/bough/cli/modes_linear.h"

#include "apps/bough/analysis/state_space.h"
#include "apps/bough/results/folder.h"

// Either a matrix or a list of names.
typedef struct content {
    const char *name;
    int rows, columns;
    const double *matrix;
    const bough_signal_name *list; // (rows)
} content;

static void write_matrix(const void *self, FILE *file) {
    const content *x = self;
    long entries = 0, all = (long)x->rows * x->columns;
    for (long k = 0; k < all; k++) entries += x->matrix[k] != 0;
    fprintf(file, "%%%%MatrixMarket matrix coordinate real general\n%d %d %ld\n", x->rows, x->columns,
            entries);
    for (long k = 0; k < all; k++) {
        if (x->matrix[k] == 0) continue;
        fprintf(file, "%ld %ld %.12g\n", k % x->rows + 1, k / x->rows + 1, x->matrix[k]);
    }
}

static void write_list(const void *self, FILE *file) {
    const content *x = self;
    fputs("number,name,unit,value\n", file);
    for (int k = 0; k < x->rows; k++)
        fprintf(file, "%d,\"%s\",%s,%.12g\n", k + 1, x->list[k].name, x->list[k].unit, x->list[k].value);
}

bough_status bough_modes_linear(bough_arena *arena, bough_simulation *s, double time, const char *folder) {
    bough_state_space x;
    bough_status status = bough_state_space_find(arena, s, time, &x);
    const content contents[] = {
        {"A.mtx", x.n, x.n, x.a, NULL},
        {"B.mtx", x.n, x.n_input, x.b, NULL},
        {"C.mtx", x.n_output, x.n, x.c, NULL},
        {"D.mtx", x.n_output, x.n_input, x.d, NULL},
        {"states.csv", x.n, 1, NULL, x.state},
        {"inputs.csv", x.n_input, 1, NULL, x.input},
        {"outputs.csv", x.n_output, 1, NULL, x.output},
    };
    for (int k = 0; k < 7 && bough_is_ok(&status); k++) {
        const content *c = &contents[k];
        status = bough_folder_write(folder, c->name, c->matrix ? write_matrix : write_list, c);
    }
    if (bough_is_ok(&status))
        printf("linear system: %d states, %d inputs, %d outputs\n", x.n, x.n_input, x.n_output);
    return status;
}
