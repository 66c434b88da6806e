// A case of kind inflow: the induction answers in any state, and the same from any start.
#include "tests/verification/verify.h"

#include "core/base/base.h"
#include "tests/verification/one_element.h"

#include <math.h>
#include <stdint.h>

enum { STATES = 1000000 };

// A small generator with a fixed sequence, so that failures repeat.
static double uniform(uint64_t *seed, double low, double high) {
    *seed = *seed * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(*seed >> 11) / 9007199254740992.;
}

// Speeds from nothing to a thousand m/s, now and then exactly none; any angle, loss and cone.
static bough_element random_element(const bough_polar *polar, int n_polar, uint64_t *seed) {
    double strong = exp(uniform(seed, -12, 3)), kind = uniform(seed, 0, 1);
    bough_element e = {.polar = polar + (int)uniform(seed, 0, n_polar - 1e-9),
                       .solidity = exp(uniform(seed, -9, 1)),
                       .tip_factor = exp(uniform(seed, -14, 5)),
                       .hub_factor = exp(uniform(seed, -14, 5)),
                       .cone = uniform(seed, 0, 1),
                       .twist = uniform(seed, -BOUGH_PI, BOUGH_PI),
                       .inflow_x = uniform(seed, -30, 30) * (kind < 0.1 ? strong : 1),
                       .inflow_y = uniform(seed, -90, 90) * (kind > 0.9 ? strong : 1)};
    if (kind > 0.40 && kind < 0.43) e.inflow_x = 0;
    if (kind > 0.42 && kind < 0.45) e.inflow_y = 0;
    if (kind > 0.50 && kind < 0.55) e.twist = BOUGH_PI / 2 * floor(uniform(seed, -2, 3));
    if (kind > 0.55 && kind < 0.60) e.tip_factor = 0;
    return e;
}

static bool in_range(bough_induction i) {
    return i.axial >= -1 && i.axial <= 1.5 && i.tangential >= -1 && i.tangential <= 1;
}

static double difference(bough_induction a, bough_induction b) {
    return fmax(fabs(a.axial - b.axial), fabs(a.tangential - b.tangential));
}

static bough_status build_polars(bough_arena *arena, const bough_scene_polars *from, bough_polar *polar) {
    for (int k = 0; k < from->n_polar; k++) {
        const bough_scene_polar *p = &from->polar[k];
        double *row = bough_arena_doubles(arena, 4 * (size_t)p->n_row);
        if (!row) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
        for (int i = 0; i < p->n_row; i++) {
            row[4 * i] = p->row[i].alpha * (180 / BOUGH_PI);
            row[4 * i + 1] = p->row[i].cl;
            row[4 * i + 2] = p->row[i].cd;
        }
        bough_polar_def def = {.n = p->n_row, .row = row};
        bough_polar_build(arena, &def, &polar[k]);
    }
    return bough_ok();
}

bough_status bough_verify_inflow(bough_arena *arena, const bough_verify_case *x, const bough_scene *scene,
                                 double *value) {
    int n_polar = scene->aero.polars.n_polar;
    if (n_polar == 0) return bough_fail(BOUGH_INVALID, "the scene has no polars");
    bough_polar *polar = bough_arena_take(arena, (size_t)n_polar * sizeof *polar);
    if (!polar) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    bough_status status = build_polars(arena, &scene->aero.polars, polar);
    if (!bough_is_ok(&status)) return status;
    uint64_t seed = 1;
    double result[3] = {STATES, 0, 0}; // states, failures, spread
    for (int n = 0; n < STATES; n++) {
        bough_induction_options options = bough_induction_options_default();
        if (n % 2) options.high_thrust = BOUGH_HIGH_THRUST_BUHL;
        if (n % 7 == 0) options.axial_drag = options.tangential_drag = false;
        bough_element e = random_element(polar, n_polar, &seed);
        bough_element other = random_element(polar, n_polar, &seed);
        bough_induction first = induction_at(&options, &e);
        induction_at(&options, &other);
        bough_induction again = induction_at(&options, &e);
        if (!in_range(first)) result[1]++;
        result[2] = fmax(result[2], difference(first, again));
    }
    for (int i = 0; i < x->n_expect; i++) {
        if (!x->expect[i].diagnosis) value[i] = result[x->expect[i].quantity.index];
    }
    return status;
}
