#include "flexbody/rod_load.h"

// What the two vertices of a segment take of a load on it.
typedef struct shares {
    double left, right; // of force and moment
    double couple;      // arm of the equal and opposite moments [m]
} shares;

// At ξ = (s − s_left)/h: 1 − ξ, ξ and ½ h ξ (1 − ξ), the shape of linked interpolation
// w = (1 − ξ) w_left + ξ w_right + ½ h ξ (1 − ξ)(θ_left − θ_right).
static shares point_shares(double h, double xi) {
    return (shares){1 - xi, xi, 0.5 * h * xi * (1 - xi)};
}

// Their integrals over s from ξ = 0.
static shares line_shares(double h, double xi) {
    double square = xi * xi;
    return (shares){h * (xi - 0.5 * square), 0.5 * h * square,
                    0.5 * h * h * (0.5 * square - square * xi / 3)};
}

static void add_to_vertex(const bough_rod_model *m, int i, double share, bough_vec3 couple,
                          const double *wrench, double *value) {
    const double moment[3] = {couple.x, couple.y, couple.z};
    for (int c = 0; c < 3; c++) {
        value[c * m->stride + i] += share * wrench[c];
        value[(3 + c) * m->stride + i] += share * wrench[3 + c] + moment[c];
    }
}

// The moment arm × force of a couple about vertex i's end of segment n.
static bough_vec3 couple_at(const bough_rod_model *m, int n, int i, double arm,
                            const double *wrench, bool follower) {
    bough_vec3 along = bough_sub(m->position0[n + 1], m->position0[n]);
    along = bough_scale(arm / bough_norm(along), along);
    if (follower) along = bough_mat3_tmul(bough_rotation_matrix(m->rotation0[i]), along);
    return bough_cross(along, bough_v3(wrench[0], wrench[1], wrench[2]));
}

static void add_to_segment(const bough_rod_model *m, int n, shares s, const double *wrench,
                           bool follower, double *value) {
    bough_vec3 left = couple_at(m, n, n, s.couple, wrench, follower);
    bough_vec3 right = couple_at(m, n, n + 1, -s.couple, wrench, follower);
    add_to_vertex(m, n, s.left, left, wrench, value);
    add_to_vertex(m, n + 1, s.right, right, wrench, value);
}

static void lump_point(const bough_rod_model *m, double at, const double *wrench, bool follower,
                       double *value) {
    int n = 0;
    while (n < m->n_segment - 1 && at >= m->span[n + 1]) n++;
    double h = m->span[n + 1] - m->span[n];
    double xi = bough_clamp((at - m->span[n]) / h, 0, 1);
    add_to_segment(m, n, point_shares(h, xi), wrench, follower, value);
}

void bough_rod_lump(const bough_rod_model *m, bough_rod_reach reach, const double *wrench,
                    bool follower, double *value) {
    if (reach.to == reach.from) {
        lump_point(m, reach.from, wrench, follower, value);
        return;
    }
    for (int n = 0; n < m->n_segment; n++) {
        double h = m->span[n + 1] - m->span[n];
        double from = bough_clamp((reach.from - m->span[n]) / h, 0, 1);
        double to = bough_clamp((reach.to - m->span[n]) / h, 0, 1);
        if (to <= from) continue;
        shares high = line_shares(h, to), low = line_shares(h, from);
        shares s = {high.left - low.left, high.right - low.right, high.couple - low.couple};
        add_to_segment(m, n, s, wrench, follower, value);
    }
}
