#include "flexbody/rod/rod_load.h"

#include "flexbody/rod/rod_kernels.h"
#include "flexbody/rod/rod_lanes.h"

#include <string.h>

// What the two vertices of a segment take of a load on it.
typedef struct shares {
    double left, right; // of force and moment
    double couple;      // arm of the equal and opposite moments [m]
} shares;

// At ξ = (s − s_left)/h: 1 − ξ, ξ and ½ h ξ (1 − ξ), the shape of linked interpolation
// w = (1 − ξ) w_left + ξ w_right + ½ h ξ (1 − ξ)(θ_left − θ_right).
static shares point_shares(double h, double xi) { return (shares){1 - xi, xi, 0.5 * h * xi * (1 - xi)}; }

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
static bough_vec3 couple_at(const bough_rod_model *m, int n, int i, double arm, const double *wrench,
                            bool follower) {
    bough_vec3 along = bough_sub(m->position0[n + 1], m->position0[n]);
    along = bough_scale(arm / bough_norm(along), along);
    if (follower) along = bough_mat3_tmul(bough_rotation_matrix(m->rotation0[i]), along);
    return bough_cross(along, bough_v3(wrench[0], wrench[1], wrench[2]));
}

static void add_to_segment(const bough_rod_model *m, int n, shares s, const double *wrench,
                           bough_rod_ramped_load *load) {
    bough_vec3 left = couple_at(m, n, n, s.couple, wrench, load->follower);
    bough_vec3 right = couple_at(m, n, n + 1, -s.couple, wrench, load->follower);
    add_to_vertex(m, n, s.left, left, wrench, load->value);
    add_to_vertex(m, n + 1, s.right, right, wrench, load->value);
}

static void lump_point(const bough_rod_model *m, double at, const double *wrench,
                       bough_rod_ramped_load *load) {
    int n = 0;
    while (n < m->n_segment - 1 && at >= m->span[n + 1]) n++;
    double h = m->span[n + 1] - m->span[n];
    double xi = bough_clamp((at - m->span[n]) / h, 0, 1);
    add_to_segment(m, n, point_shares(h, xi), wrench, load);
}

// The same weighted by ξ − ½.
static shares slope_shares(double h, double xi) {
    double square = xi * xi, cube = square * xi;
    double first = 0.5 * h * square, second = h * cube / 3;
    double couple = 0.5 * h * h * (cube / 3 - 0.25 * square * square);
    shares even = line_shares(h, xi);
    return (shares){first - second - 0.5 * even.left, second - 0.5 * even.right, couple - 0.5 * even.couple};
}

// What a line from `from` to `to` in the segment has; the whole of it has no couples.
static shares between(shares high, shares low, bool whole) {
    return (shares){high.left - low.left, high.right - low.right, whole ? 0 : high.couple - low.couple};
}

void bough_rod_lump(const bough_rod_model *m, bough_rod_reach reach, const double *wrench, const double *end,
                    bough_rod_ramped_load *load) {
    if (reach.to == reach.from) {
        lump_point(m, reach.from, wrench, load);
        return;
    }
    for (int n = 0; n < m->n_segment; n++) {
        double h = m->span[n + 1] - m->span[n];
        double from = bough_clamp((reach.from - m->span[n]) / h, 0, 1);
        double to = bough_clamp((reach.to - m->span[n]) / h, 0, 1);
        if (to <= from) continue;
        bool whole = from == 0 && to == 1;
        double middle[6], slope[6]; // at ξ = ½, and over the segment
        for (int c = 0; c < 6; c++) {
            double change = end ? (end[c] - wrench[c]) / (reach.to - reach.from) : 0;
            middle[c] = wrench[c] + change * (m->span[n] + 0.5 * h - reach.from);
            slope[c] = change * h;
        }
        add_to_segment(m, n, between(line_shares(h, to), line_shares(h, from), whole), middle, load);
        if (end) {
            shares s = between(slope_shares(h, to), slope_shares(h, from), whole);
            add_to_segment(m, n, s, slope, load);
        }
        if (!whole) continue;
        load->along = true;
        for (int c = 0; c < 6; c++) {
            load->line[c * m->stride + n] += middle[c];
            load->line[(6 + c) * m->stride + n] += slope[c] / h;
        }
    }
}

// The stress −C D q of segment n on its two vertices, in BRF or, of a follower, in section axes, added
// to value.
static void lump_stress(const bough_rod_model *m, int n, strain line, bool follower, double *value) {
    int s = m->stride;
    vertex_state l = {.x = m->position0[n], .p = m->rotation0[n]};
    vertex_state r = {.x = m->position0[n + 1], .p = m->rotation0[n + 1]};
    segment_geometry shape = segment_shape(l, r, m->inverse_length[n]);
    strain minus = {bough_scale(-1, line.v), bough_scale(-1, line.u)};
    strain stress = symmetric_times(bough_rod_tile(m->stiffness, 21, n), BOUGH_LANES, 0, minus);
    segment_force f = stress_force(shape, stress, m->length[n]);
    const bough_vec3 force[2] = {f.f, bough_scale(-1, f.f)}, moment[2] = {f.ll, f.lr};
    const bough_quaternion p[2] = {l.p, r.p};
    for (int side = 0; side < 2; side++) {
        bough_mat3 axes = bough_rotation_matrix(p[side]);
        double *to = value + n + side;
        bough_vec3 pull = follower ? bough_mat3_tmul(axes, force[side]) : force[side];
        bough_vec3 turn = follower ? moment[side] : bough_mat3_mul(axes, moment[side]);
        lane_store(to, s, 0, bough_add(lane_load(to, s, 0), pull));
        lane_store(to + 3 * s, s, 0, bough_add(lane_load(to + 3 * s, s, 0), turn));
    }
}

void bough_rod_lump_strain(const bough_rod_model *m, const double *line_strain, double *value) {
    int s = m->stride;
    for (int n = 0; n < m->n_segment; n++) {
        strain line = {lane_load(line_strain, s, n), lane_load(line_strain + 3 * s, s, n)};
        lump_stress(m, n, line, false, value);
    }
}

void bough_rod_lump_line(const bough_rod_model *m, bough_rod_ramped_load *load) {
    int s = m->stride;
    for (int n = 0; n < m->n_segment && load->along; n++) {
        vertex_state l = {.x = m->position0[n], .p = m->rotation0[n]};
        vertex_state r = {.x = m->position0[n + 1], .p = m->rotation0[n + 1]};
        bough_mat3 middle = segment_shape(l, r, m->inverse_length[n]).r;
        bough_vec3 q[4];
        for (int part = 0; part < 4; part++) {
            q[part] = lane_load(load->line + 3 * part * s, s, n);
            if (!load->follower) q[part] = bough_mat3_tmul(middle, q[part]);
        }
        lump_stress(m, n, line_strain(m->line, s, n, q), load->follower, load->value);
    }
    memset(load->line, 0, 12 * (size_t)s * sizeof *load->line);
    load->along = false;
}

void bough_rod_line_strain(const bough_rod_model *m, const double *line, double *along) {
    BOUGH_OF_LEVEL(bough_rod_line_strain, m->level)(m, line, along);
}

void bough_rod_take_line(const bough_rod_model *m, const double *rotation, const double *line, double *turned,
                         double *load) {
    BOUGH_OF_LEVEL(bough_rod_take_line, m->level)(m, rotation, line, turned, load);
}
