#include "apps/bough/cases/counts.h"

#include <math.h>
#include <string.h>

void bough_counts_take(bough_arena *arena, int n_channel, int n_slope, const double *slope,
                       bough_counts *counts) {
    size_t n = (size_t)n_channel;
    *counts = (bough_counts){.n_channel = n_channel};
    counts->channel = bough_arena_take(arena, n * sizeof *counts->channel);
    double *rows = bough_arena_doubles(arena, 2 * n * n);
    for (size_t i = 0; i < n; i++) {
        bough_channel_counts *c = &counts->channel[i];
        c->rainflow.n_slope = n_slope;
        for (int k = 0; k < n_slope; k++) c->rainflow.slope[k] = slope[k];
        c->at_least = rows + 2 * i * n;
        c->at_most = c->at_least + n;
    }
}

static bool are_finite(const double *value, int n) {
    for (int i = 0; i < n; i++)
        if (!isfinite(value[i])) return false;
    return true;
}

static void add(bough_channel_counts *c, double t, double x, const double *row, size_t size) {
    bough_sample_statistics *s = &c->statistics;
    bool first = s->n == 0, least = first || x < s->least, most = first || x > s->most;
    bough_sample_statistics_add(s, t, x);
    if (least) memcpy(c->at_least, row, size);
    if (most) memcpy(c->at_most, row, size);
    bough_rainflow_add(&c->rainflow, x);
    bough_levels_follow(&c->levels, x);
}

void bough_counts_add(bough_counts *counts, double t, const double *value) {
    int n = counts->n_channel;
    if (!are_finite(value, n)) {
        counts->broken++;
        return;
    }
    for (int i = 0; i < n; i++) add(&counts->channel[i], t, value[i], value, (size_t)n * sizeof *value);
}

void bough_counts_finish(bough_counts *counts) {
    for (int i = 0; i < counts->n_channel; i++) bough_rainflow_finish(&counts->channel[i].rainflow);
}
