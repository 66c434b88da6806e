// The blade's stiffness and inertia from what it is made of: layers and webs on the outlines of its
// sections.
#ifndef BOUGH_IMPORT_WINDIO_LAYUP_H
#define BOUGH_IMPORT_WINDIO_LAYUP_H

#include "apps/bough/import/windio.h"

// At `n` shares of the blade: matrices (36 each, rows) about the reference line in section axes.
typedef struct bough_layup {
    int n;
    double *share;            // (n) from 0 to 1
    double *stiffness, *mass; // (n × 36)
} bough_layup;

// Whether the blade has layers.
bool bough_windio_has_layers(const bough_windio *w);

void bough_windio_layup(bough_windio *w, bough_layup *layup);

#endif
