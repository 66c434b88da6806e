// Values of a YAML file by the path of their keys, "blade.outer_shape|outer_shape_bem.chord": words
// between points, each a key or several spellings of it.
//
// The first failure is kept in the draft's status, with file:line:col, path and what was expected;
// afterwards all reads return 0 or nothing, so that a reader may check once at its end.
#ifndef BOUGH_IMPORT_ENTRY_H
#define BOUGH_IMPORT_ENTRY_H

#include "apps/bough/config/text.h"
#include "apps/bough/import/draft.h"

#include <stdbool.h>

// The tree of a file; NULL after a failure.
const bough_node *bough_entry_read(bough_draft *d, const char *path);

// What stands at the path below `from` (NULL allowed); NULL: nothing.
const bough_node *bough_entry(const bough_node *from, const char *path);

// The same; a failure where there is nothing.
const bough_node *bough_entry_need(bough_draft *d, const bough_node *from, const char *path);

// A number, a text; with a fallback where there is none.
double bough_entry_number(bough_draft *d, const bough_node *from, const char *path);
double bough_entry_number_or(bough_draft *d, const bough_node *from, const char *path, double fallback);
const char *bough_entry_text(bough_draft *d, const bough_node *from, const char *path);

// The numbers of a list, *n of them, or just as many as wanted where *n > 0.
const double *bough_entry_numbers(bough_draft *d, const bough_node *from, const char *path, int *n);

// The item of a list of mappings that has this name; NULL: none.
const bough_node *bough_entry_named(const bough_node *list, const char *name);

// A quantity over a coordinate that never falls: {grid: [...], values: [...]}.
typedef struct bough_curve {
    const bough_node *node;
    int n;
    const double *x, *y; // (n)
} bough_curve;

bough_curve bough_entry_curve(bough_draft *d, const bough_node *from, const char *path);

// A curve of these numbers (n each), which must outlive it; `node` says where they stand.
bough_curve bough_curve_of(bough_draft *d, const bough_node *node, const double *x, const double *y, int n);

// Linear between the points, constant outside; 0 of a curve that could not be read.
double bough_curve_at(const bough_curve *c, double x);

// The places of all curves' points in rising order, those closer than `least` to the one before left out:
// their number.
int bough_curve_places(bough_draft *d, const bough_curve *const *curve, int n_curve, double least,
                       double **place);

// The same of curves over a share, from 0 to 1.
int bough_curve_shares(bough_draft *d, const bough_curve *const *curve, int n_curve, double least,
                       double **share);

// Keeps a failure at a node, unless there was one.
void bough_entry_fail(bough_draft *d, const bough_node *where, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

#endif
