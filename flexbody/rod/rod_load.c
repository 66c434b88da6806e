// Loads along a rod onto its vertices, by hat functions, and between them, as the linear loads that bend the
// segments equally: theory (105).
#include "flexbody/rod/rod_load.h"

#include "flexbody/rod/rod_lanes.h"

// Points of Gauss–Legendre quadrature over a part of a segment, exact to degree 5.
enum { POINTS = 3 };
static const double gauss_at[POINTS] = {-0.7745966692414834, 0, 0.7745966692414834};
static const double gauss_weight[POINTS] = {5. / 18, 4. / 9, 5. / 18};

// What of a load acts on one segment.
typedef struct segment_load {
    double left[6], right[6]; // on its vertices
    double line[12];          // the linear load that bends a uniform segment equally: mean, slope
} segment_load;

// theory (105): adds a wrench at ξ = (s − s_left)/h.
static void add_point(double h, double xi, double weight, const double *wrench, segment_load *to) {
    double bow = xi * (1 - xi), mean = 6 * bow / h, slope = 120 * bow * (xi - 0.5) / (h * h);
    for (int c = 0; c < 6; c++) {
        double value = weight * wrench[c];
        to->left[c] += (1 - xi) * value;
        to->right[c] += xi * value;
        to->line[c] += mean * value;
        to->line[6 + c] += slope * value;
    }
}

// Adds a part of a load on segment n: a point, or its quadrature over a length.
static void add_part(const bough_rod_model *m, int n, const bough_rod_part *part, segment_load *to) {
    double h = m->span[n + 1] - m->span[n], length = part->to - part->from;
    if (length == 0) add_point(h, (part->from - m->span[n]) / h, 1, part->start, to);
    for (int p = 0; p < POINTS && length > 0; p++) {
        double at = (0.5 + 0.5 * gauss_at[p]) * length, wrench[6];
        for (int c = 0; c < 6; c++) wrench[c] = part->start[c] + at * part->slope[c];
        add_point(h, (part->from + at - m->span[n]) / h, gauss_weight[p] * length, wrench, to);
    }
}

// The axes of the middle of segment n, undeformed.
static segment_geometry undeformed(const bough_rod_model *m, int n) {
    return shape_between(m->position0 + n, m->rotation0 + n, m->inverse_length[n]);
}

// The stress −C D q of segment n on its two vertices, in BRF or, of a follower, in section axes, added
// to value.
static void lump_stress(const bough_rod_model *m, int n, strain line, bool follower, double *value) {
    int s = m->stride;
    segment_geometry shape = undeformed(m, n);
    strain minus = {bough_scale(-1, line.v), bough_scale(-1, line.u)};
    strain stress = symmetric_times(bough_rod_tile(m->stiffness, 21, n), BOUGH_LANES, 0, minus);
    segment_force f = stress_force(shape, stress, m->length[n]);
    const bough_vec3 force[2] = {f.f, bough_scale(-1, f.f)}, moment[2] = {f.ll, f.lr};
    // forces are in BRF axes, moments in section axes
    for (int side = 0; side < 2; side++) {
        bough_mat3 axes = bough_rotation_matrix(m->rotation0[n + side]);
        double *to = value + n + side;
        lane_add(to, s, 0, follower ? bough_mat3_tmul(axes, force[side]) : force[side]);
        lane_add(to + 3 * s, s, 0, follower ? moment[side] : bough_mat3_mul(axes, moment[side]));
    }
}

// The strain by a part of a load on segment n beyond that by its line load: what varying sections add.
static void add_variation(const bough_rod_model *m, int n, bough_rod_part part, bough_rod_ramped_load *load) {
    bough_mat3 middle = undeformed(m, n).r;
    segment_load own = {{0}, {0}, {0}};
    bough_vec3 q[4];
    double strain_of[6];
    double *const vectors[4] = {part.start, part.start + 3, part.slope, part.slope + 3};
    for (int k = 0; k < 4 && !load->follower; k++) {
        bough_vec3 turned = bough_mat3_tmul(middle, lane_load(vectors[k], 1, 0));
        lane_store(vectors[k], 1, 0, turned);
    }
    // the strain of the sections as they are, less that of the equivalent load on uniform sections
    add_part(m, n, &part, &own);
    for (int k = 0; k < 4; k++) q[k] = lane_load(own.line + 3 * k, 1, 0);
    m->sections.strain(m->sections.axis, m, n, &part, strain_of);
    strain line = line_strain(m->line, m->stride, n, q);
    line.v = bough_sub(lane_load(strain_of, 1, 0), line.v);
    line.u = bough_sub(lane_load(strain_of + 3, 1, 0), line.u);
    lump_stress(m, n, line, load->follower, load->value);
}

// By how much the load between the vertices bends segment n, by linear statics [rad]; beyond the most that
// linear statics is good for, the load goes to the vertices alone, as along a cable.
static const double most_bend = 0.5;

static double bend_of(const bough_rod_model *m, int n, const double line[12]) {
    const double *c = bough_rod_tile(m->stiffness, 21, n);
    double h = m->length[n], softest = fmin(c[15 * BOUGH_LANES], c[18 * BOUGH_LANES]);
    double mean = bough_norm(bough_v3_load(line));
    double slope = bough_norm(bough_v3_load(line + 6));
    return (mean + 0.5 * h * slope) * h * h * h / (12 * softest);
}

// Adds a part of a load that lies on segment n.
static void add_to_segment(const bough_rod_model *m, int n, const bough_rod_part *part,
                           bough_rod_ramped_load *load) {
    int s = m->stride;
    segment_load own = {{0}, {0}, {0}};
    add_part(m, n, part, &own);
    for (int c = 0; c < 6; c++) {
        load->value[c * s + n] += own.left[c];
        load->value[c * s + n + 1] += own.right[c];
    }
    // between the vertices, unless it acts at one or bends the segment too far
    bool at_vertex = part->from == part->to && (part->from == m->span[n] || part->from == m->span[n + 1]);
    bool whole = part->from == m->span[n] && part->to == m->span[n + 1];
    if (at_vertex || bend_of(m, n, own.line) > most_bend) return;
    load->along = true;
    for (int c = 0; c < 12; c++) load->line[c * s + n] += own.line[c];
    if (!whole && m->sections.strain != NULL) add_variation(m, n, *part, load);
}

void bough_rod_lump(const bough_rod_model *m, bough_rod_reach reach, const double *wrench, const double *end,
                    bough_rod_ramped_load *load) {
    for (int n = 0; n < m->n_segment; n++) {
        bool last = n == m->n_segment - 1;
        bough_rod_part part = {.from = fmax(reach.from, m->span[n]), .to = fmin(reach.to, m->span[n + 1])};
        // a point between two segments belongs to the right one
        bool point = reach.from == reach.to && (last || reach.to < m->span[n + 1]);
        if (part.to < part.from || (part.to == part.from && !point)) continue;
        for (int c = 0; c < 6; c++) {
            if (end != NULL) part.slope[c] = (end[c] - wrench[c]) / (reach.to - reach.from);
            part.start[c] = wrench[c] + part.slope[c] * (part.from - reach.from);
        }
        add_to_segment(m, n, &part, load);
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
        bough_mat3 middle = undeformed(m, n).r;
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
