// The induction at one blade element, which fills the lanes alone.
#pragma once

#include "aero/rotor/induction.h"

typedef struct bough_element { // as in bough_elements
    const bough_polar *polar;
    double solidity, tip_factor, hub_factor, cone, twist, inflow_x, inflow_y;
    double skew_normal, skew_chord, skew;
} bough_element;

typedef struct bough_induction {
    double axial, tangential, loss;
    int evaluations; // of the residual
} bough_induction;

static inline bough_induction induction_at(const bough_induction_options *options, const bough_element *e) {
    enum { N = BOUGH_LANES, ROWS = 9 };
    const double own[ROWS] = {e->solidity, e->tip_factor, e->hub_factor,  e->cone,      e->twist,
                              e->inflow_x, e->inflow_y,   e->skew_normal, e->skew_chord};
    double r[ROWS][N], axial[N], tangential[N], loss[N];
    const bough_polar *polar[N];
    for (int i = 0; i < N; i++) {
        polar[i] = e->polar;
        for (int k = 0; k < ROWS; k++) r[k][i] = own[k];
    }
    const bough_elements copies = {N, polar, r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8], e->skew};
    int evaluations = BOUGH_OF_LEVEL(bough_induction_solve, bough_level_chosen())(options, &copies, axial,
                                                                                  tangential, loss);
    return (bough_induction){axial[0], tangential[0], loss[0], evaluations};
}
