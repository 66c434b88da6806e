// The air's tangent of equal blades as the mean over azimuths and blades, column by column: theory (113).
#include "apps/bough/analysis/air_tangent.h"

struct bough_air_mean {
    int n_part, n_all;   // blades; states of each with those of its air
    const int *row;      // (n_part × n_all)
    int *place;          // (n + all air) 1 + blade n_all + state; 0: of no blade
    const double *blend; // C (n_part × n_part)
    double share;
};

int bough_air_tangent_blade(const bough_simulation *s, const bough_blade_group *group, int k) {
    return bough_scene_blade(s->scene, group->blade[k]->index);
}

const int *bough_air_tangent_rows(bough_arena *arena, const bough_simulation *s,
                                  const bough_blade_group *group, int n_per_blade) {
    int n = group->n_row, all = n + n_per_blade;
    int *row = bough_arena_take(arena, (size_t)(group->n * all + 1) * sizeof *row);
    for (int k = 0; k < group->n; k++) {
        int air = s->assembly->n_state + bough_air_tangent_blade(s, group, k) * n_per_blade;
        for (int j = 0; j < all; j++) row[k * all + j] = j < n ? group->row[k * n + j] : air + j - n;
    }
    return row;
}

bough_air_mean *bough_air_mean_create(bough_arena *arena, const bough_air_azimuth *x,
                                      const bough_air_tangent *t) {
    const bough_blade_group *group = x->parts;
    bough_air_mean *m = bough_arena_take(arena, sizeof *m);
    *m = (bough_air_mean){.n_part = group->n,
                          .n_all = group->n_row + t->n_per_blade,
                          .row = bough_air_tangent_rows(arena, x->first, group, t->n_per_blade),
                          .blend = x->blend,
                          .share = x->share};
    m->place = bough_arena_take(arena, (size_t)(t->all + 1) * sizeof *m->place);
    for (int k = 0; k < m->n_part * m->n_all; k++) m->place[m->row[k]] = 1 + k;
    return m;
}

void bough_air_mean_blend(const double *c, bool transposed, int n_part, int n, const int *row, double *x) {
    double before[BOUGH_MOST_BLADES];
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < n_part; k++) before[k] = x[row[k * n + j]];
        for (int k = 0; k < n_part; k++) {
            double sum = 0;
            for (int l = 0; l < n_part; l++)
                sum += c[transposed ? l * n_part + k : k * n_part + l] * before[l];
            x[row[k * n + j]] = sum;
        }
    }
}

// State j of a blade among all and the air's.
static size_t state_of(const bough_air_mean *m, int blade, int j) {
    return (size_t)m->row[blade * m->n_all + j];
}

// A column that belongs to no blade: Cᵀ transforms the rates of the blades to those that an observer at rest
// sees.
static void add_other(const bough_air_mean *m, size_t at, const double *slope, bough_air_tangent *t) {
    for (size_t i = 0; i < (size_t)t->all; i++)
        if (m->place[i] == 0) *bough_air_tangent_entry(t, i, at) += m->share * slope[i];
    for (int j = 0; j < m->n_all; j++) {
        for (int k = 0; k < m->n_part; k++) {
            double sum = 0;
            for (int l = 0; l < m->n_part; l++) sum += m->blend[l * m->n_part + k] * slope[state_of(m, l, j)];
            *bough_air_tangent_entry(t, state_of(m, k, j), at) += m->share * sum;
        }
    }
}

// Column j of a blade. Its effect on other rows is spread over all blades by C; its effect on blades enters
// the mean over the blades as one of the first blade's, which C does not change.
static void add_of_blade(const bough_air_mean *m, int blade, int j, const double *slope,
                         bough_air_tangent *t) {
    int all = m->n_all;
    for (size_t i = 0; i < (size_t)t->all; i++) {
        if (slope[i] == 0) continue;
        if (m->place[i] > 0) {
            int to = (m->place[i] - 1) / all - blade, row = (m->place[i] - 1) % all;
            *bough_air_tangent_entry(t, state_of(m, to < 0 ? to + m->n_part : to, row), state_of(m, 0, j)) +=
                m->share / m->n_part * slope[i];
            continue;
        }
        for (int k = 0; k < m->n_part; k++)
            *bough_air_tangent_entry(t, i, state_of(m, k, j)) +=
                m->share * m->blend[blade * m->n_part + k] * slope[i];
    }
}

void bough_air_mean_add(const bough_air_mean *m, int at, const double *slope, bough_air_tangent *t) {
    int all = m->n_all, place = m->place[at];
    if (place == 0)
        add_other(m, (size_t)at, slope, t);
    else
        add_of_blade(m, (place - 1) / all, (place - 1) % all, slope, t);
}

void bough_air_mean_add_own(const bough_air_mean *m, const int *column, const double *slope,
                            bough_air_tangent *t) {
    for (int i = 0; i < m->n_all; i++)
        *bough_air_tangent_entry(t, state_of(m, 0, i), state_of(m, 0, column[i])) +=
            m->share / m->n_part * slope[i];
}

void bough_air_mean_negate(bough_air_mean *m) { m->share = -m->share; }

// The blocks of the first blade, repeated for the others with the blades shifted.
static void repeat(const bough_air_mean *m, bough_air_tangent *t) {
    int all = m->n_all;
    for (int j = 0; j < all; j++) {
        for (int k = 0; k < m->n_part; k++) {
            for (int i = 0; i < all; i++) {
                double value = *bough_air_tangent_entry(t, state_of(m, k, i), state_of(m, 0, j));
                for (int l = 1; l < m->n_part && value != 0; l++)
                    *bough_air_tangent_entry(t, state_of(m, (k + l) % m->n_part, i), state_of(m, l, j)) =
                        value;
            }
        }
    }
}

void bough_air_tangent_close(bough_arena *arena, const bough_air_azimuth *x, bough_air_tangent *t) {
    if (x->group->n == 0) return;
    repeat(bough_air_mean_create(arena, x, t), t);
    if (fabs(x->group->speed) > 0) { // the mean over a revolution of a derivative by azimuth is 0
        int azimuth, speed;
        bough_tree_joint_rows(x->simulation->tree, x->simulation->scene->turbine.rotor, &azimuth, &speed);
        memset(bough_air_tangent_entry(t, 0, (size_t)azimuth), 0, (size_t)t->all * sizeof(double));
    }
}
