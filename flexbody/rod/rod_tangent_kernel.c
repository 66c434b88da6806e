// Linearisation of the rod: exact tangents of the forces of eight segments at a time, side by side in vector
// lanes, and of the vertices' balances.
#include "flexbody/rod/rod_lanes.h"
#include "flexbody/rod/rod_tangent.h"
#include "flexbody/rod/rod_tangent_layout.h"

// -- what all directions share --------------------------------------------------------------------

// Rows of 8: shape, motion and stress of eight segments.
enum {
    BASE_R = 0,
    BASE_V = 9,
    BASE_T = 12,
    BASE_CHORD = 15,
    BASE_RELATIVE = 18,
    BASE_MIDDLE = 21,
    BASE_DU = 24,
    BASE_STRESS = 27,
    BASE_W = 33,       // then c, g, 1/(1 + w), dg/dw
    BASE_ELASTIC = 38, // the elastic law's state
    BASE = 61,
};

BOUGH_INLINE void store_shape(double *restrict base, int l, segment_geometry s) {
    lane_store_matrix(base + LANES * BASE_R, LANES, l, s.r);
    lane_store(base + LANES * BASE_V, LANES, l, s.v);
    lane_store(base + LANES * BASE_T, LANES, l, s.t);
    lane_store(base + LANES * BASE_CHORD, LANES, l, s.chord);
    lane_store(base + LANES * BASE_W, LANES, l, (bough_vec3){s.w, s.c, s.g});
    base[LANES * (BASE_W + 3) + l] = s.e;
    base[LANES * (BASE_W + 4) + l] = s.slope;
}

BOUGH_INLINE segment_geometry load_shape(const double *restrict base, int l) {
    segment_geometry s;
    s.r = lane_load_matrix(base + LANES * BASE_R, LANES, l);
    s.v = lane_load(base + LANES * BASE_V, LANES, l);
    s.t = lane_load(base + LANES * BASE_T, LANES, l);
    s.chord = lane_load(base + LANES * BASE_CHORD, LANES, l);
    s.w = base[LANES * BASE_W + l];
    s.c = base[LANES * (BASE_W + 1) + l];
    s.g = base[LANES * (BASE_W + 2) + l];
    s.e = base[LANES * (BASE_W + 3) + l];
    s.slope = base[LANES * (BASE_W + 4) + l];
    s.phi = bough_scale(s.c, s.v);
    return s;
}

BOUGH_INLINE void store_elastic(double *restrict base, int l, elastic_state s) {
    double *restrict to = base + LANES * BASE_ELASTIC;
    lane_store(to, LANES, l, s.stress.u);
    lane_store(to + LANES * 3, LANES, l, s.bent.v);
    lane_store(to + LANES * 6, LANES, l, s.bent.u);
    lane_store(to + LANES * 9, LANES, l, s.kappa);
    lane_store(to + LANES * 12, LANES, l, s.b);
    lane_store(to + LANES * 15, LANES, l, (bough_vec3){s.value, s.limit, s.slope});
    lane_store(to + LANES * 18, LANES, l, (bough_vec3){s.pull.x, s.pull.y, s.pull.a});
    to[LANES * 21 + l] = s.pull.b;
    to[LANES * 22 + l] = s.tension;
}

BOUGH_INLINE elastic_state load_elastic(const double *restrict base, int l) {
    const double *restrict from = base + LANES * BASE_ELASTIC;
    return (elastic_state){
        .stress.u = lane_load(from, LANES, l),
        .bent = {lane_load(from + LANES * 3, LANES, l), lane_load(from + LANES * 6, LANES, l)},
        .kappa = lane_load(from + LANES * 9, LANES, l),
        .b = lane_load(from + LANES * 12, LANES, l),
        .value = from[LANES * 15 + l],
        .limit = from[LANES * 16 + l],
        .slope = from[LANES * 17 + l],
        .pull = {from[LANES * 18 + l], from[LANES * 19 + l], from[LANES * 20 + l], from[LANES * 21 + l]},
        .tension = from[LANES * 22 + l]};
}

// Shape, motion and stress of segments first..first + 7, from vertices and loads in `scratch`, into
// base (BASE rows of 8). Segments beyond the last exert nothing.
static void find_base(const bough_rod_model *m, const bough_rod_scratch *scratch, int first, double *base) {
    int s = m->stride;
    const double *restrict at = scratch->vertex + first, *restrict c = m->stiffness + 21 * first;
    const double *restrict d = m->damping + 21 * first, *restrict rest = scratch->rest + first;
    const double *restrict inverse = m->inverse_length + first, *restrict gradient = m->gradient + 35 * first;
    double *restrict out = base;
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        vertex_state left = load_vertex(at, s, l), right = load_vertex(at, s, l + 1);
        segment_geometry shape = segment_shape(left, right, inverse[l]);
        segment_rate motion = segment_motion(shape, left, right);
        strain e = elastic_strain(shape, inverse[l], rest, s, l);
        strain rate = strain_rate(shape, motion, inverse[l]);
        // stress, elastic and viscous
        elastic_state elastic = elastic_at(c, gradient, LANES, l, e);
        strain stress = add_strain(elastic_stress(elastic), symmetric_times(d, LANES, l, rate));
        store_elastic(out, l, elastic);
        store_shape(out, l, shape);
        lane_store(out + LANES * BASE_RELATIVE, LANES, l, motion.relative);
        lane_store(out + LANES * BASE_MIDDLE, LANES, l, motion.middle);
        lane_store(out + LANES * BASE_DU, LANES, l, motion.du);
        lane_store(out + LANES * BASE_STRESS, LANES, l, stress.v);
        lane_store(out + LANES * (BASE_STRESS + 3), LANES, l, stress.u);
    }
}

// -- directions -----------------------------------------------------------------------------------

// The unit variation of direction `k`: Δ of the right against the left vertex, then each rotation;
// of velocities if so asked.
static void unit_variation(int k, bool velocity, vertex_variation *l, vertex_variation *r) {
    *l = *r = (vertex_variation){{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    bough_vec3 *const part[6] = {&r->x, &l->phi, &r->phi, &r->u, &l->w, &r->w};
    *part[(velocity ? 3 : 0) + k / 3] = bough_unit3(k % 3);
}

BOUGH_INLINE void store_force(double *restrict column, int l, segment_force f) {
    lane_store(column, LANES * DIRECTIONS, l, f.f);
    lane_store(column + LANES * DIRECTIONS * LL, LANES * DIRECTIONS, l, f.ll);
    lane_store(column + LANES * DIRECTIONS * LR, LANES * DIRECTIONS, l, f.lr);
}

// `turning`: D q turns as well, and the moments of loads along the segment on its axis.
BOUGH_INLINE void position_direction(const bough_rod_model *m, const bough_rod_scratch *scratch, bool turning,
                                     int first, const double *restrict base, vertex_variation dl,
                                     vertex_variation dr, double *restrict column) {
    int s = m->stride;
    const double *restrict at = scratch->vertex + first, *restrict along = scratch->along + first;
    const double *restrict line = m->line + first, *restrict turn = m->strain0 + 3 * s + first;
    const double *restrict following = scratch->following + first, *restrict rest = scratch->rest + first;
    const double *restrict c = m->stiffness + 21 * first, *restrict gradient = m->gradient + 35 * first;
    const double *restrict damping = m->damping + 21 * first;
    const double *restrict inverse = m->inverse_length + first, *restrict h = m->length + first;
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        segment_geometry shape = load_shape(base, l);
        segment_rate motion = {.du = lane_load(base + LANES * BASE_DU, LANES, l),
                               .middle = lane_load(base + LANES * BASE_MIDDLE, LANES, l),
                               .relative = lane_load(base + LANES * BASE_RELATIVE, LANES, l),
                               .wl = lane_load(at + BOUGH_ROD_W * s, s, l),
                               .wr = lane_load(at + BOUGH_ROD_W * s, s, l + 1)};
        strain stress = {lane_load(base + LANES * BASE_STRESS, LANES, l),
                         lane_load(base + LANES * (BASE_STRESS + 3), LANES, l)};
        // change of the strains beyond those at rest; D q of dead loads rotates against the middle
        segment_variation d = shape_variation(shape, dl, dr, inverse[l]);
        strain de = {d.stretch, bough_scale(inverse[l], d.phi)};
        elastic_state elastic = load_elastic(base, l);
        dead_line dead = {0}, turned = {0};
        if (turning) {
            shape.stretch = along_axis(shape.v, shape.chord);
            strain e = elastic_strain(shape, inverse[l], rest, s, l);
            dead = dead_line_at(c, l, line, along, s, l, elastic_at(c, gradient, LANES, l, e));
            turned = dead_line_turned(c, l, line, s, l, &dead, d.middle);
            de = subtract_strain(de, turned.own);
        }
        // change of the stress, then of the forces
        strain drate = rate_variation(shape, motion, d, &dl, &dr, inverse[l]);
        strain delastic = elastic_variation(c, gradient, LANES, l, elastic, de);
        strain dstress = add_strain(delastic, symmetric_times(damping, LANES, l, drate));
        segment_force f = force_variation(shape, d, stress, dstress, h[l]);
        // change of the moments of loads along the segment
        if (turning) {
            bough_mat3 rl = bough_rotation_matrix(load_vertex(at, s, l).p);
            bough_mat3 rr = bough_rotation_matrix(load_vertex(at, s, l + 1).p);
            f = add_line_moments(f, shape, d, line, s, l, h[l], &dead, &turned, delastic, rl, rr, dl, dr,
                                 lane_load(turn, s, l), lane_load(following, s, l));
        }
        store_force(column, l, f);
    }
}

// Tangents of segments first..first + 7, a row of 8 for force f along direction d at 9 f + d
// (rod_tangent_layout.h): along configurations, and along velocities.
static void position_variation(const bough_rod_model *m, const bough_rod_scratch *scratch, int first,
                               const double *base, double *variation) {
    for (int k = 0; k < DIRECTIONS; k++) {
        vertex_variation dl, dr;
        double *column = variation + LANES * k;
        unit_variation(k, false, &dl, &dr);
        if (scratch->turning) {
            position_direction(m, scratch, true, first, base, dl, dr, column);
        } else {
            position_direction(m, scratch, false, first, base, dl, dr, column);
        }
    }
}

// The shape does not vary, the stress varies by D ė.
BOUGH_INLINE void velocity_direction(const bough_rod_model *m, int first, const double *restrict base,
                                     vertex_variation dl, vertex_variation dr, double *restrict column) {
    const double *restrict damping = m->damping + 21 * first, *restrict h = m->length + first;
    const double *restrict inverse = m->inverse_length + first;
    vertex_state left = {.u = dl.u, .w = dl.w}, right = {.u = dr.u, .w = dr.w};
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        segment_geometry shape = load_shape(base, l);
        strain rate = strain_rate(shape, segment_motion(shape, left, right), inverse[l]);
        strain stress = symmetric_times(damping, LANES, l, rate);
        store_force(column, l, stress_force(shape, stress, h[l]));
    }
}

static void velocity_variation(const bough_rod_model *m, int first, const double *base, double *variation) {
    for (int k = 0; k < DIRECTIONS; k++) {
        vertex_variation dl, dr;
        unit_variation(k, true, &dl, &dr);
        velocity_direction(m, first, base, dl, dr, variation + LANES * k);
    }
}

// -- a vertex' own terms --------------------------------------------------------------------------

BOUGH_INLINE void store_column(double *restrict block, int l, int row, int column, bough_vec3 x) {
    lane_store(block + (6 * row + column) * LANES, 6 * LANES, l, x);
}

// What elimination and solution need of each vertex: rows KEPT_… of k->vertex.
static void keep_vertices(const bough_rod_model *m, const double *restrict state,
                          const double *restrict vertex, bough_rod_tangent *k) {
    int n = m->n, s = m->stride;
    double *restrict kept = k->vertex;
    bough_vec3 omega = k->omega;
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        vertex_state a = load_vertex(vertex, s, v);
        bough_mat3 r = bough_rotation_matrix(a.p);
        kept[KEPT_P * s + v] = state[3 * n + v - 1];
        lane_store(kept + (KEPT_P + 1) * s, s, v, lane_load(state + 4 * n, n, v - 1));
        lane_store(kept + KEPT_W * s, s, v, a.w);
        lane_store(kept + KEPT_OMEGA * s, s, v, bough_mat3_tmul(r, omega));
        lane_store_matrix(kept + KEPT_R * s, s, v, r);
    }
}

// The mass of theory (11), force in BRF axes: [mE, −Rξ(s); ξ(s)Rᵀ, Î], column j of each half, of eight
// vertices.
static void mass_columns(const bough_rod_model *m, const bough_rod_tangent *k, int first, int j,
                         double *restrict mass) {
    int s = m->stride;
    const double *restrict kept = k->vertex + first + 1, *restrict moment = m->moment + first;
    const double *restrict inertia = m->inertia + first, *restrict weight = m->mass + first;
    bough_vec3 e = bough_unit3(j);
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        bough_mat3 r = lane_load_matrix(kept + KEPT_R * s, s, l);
        bough_vec3 offset = lane_load(moment, s, l);
        store_column(mass, l, 0, j, bough_scale(weight[l], e));
        store_column(mass, l, 3, j, bough_cross(offset, bough_mat3_tmul(r, e)));
        store_column(mass, l, 0, 3 + j, bough_mat3_mul(r, bough_cross(e, offset)));
        store_column(mass, l, 3, 3 + j, inertia_times(inertia, s, l, e));
    }
}

// Derivatives of theory (11) by the velocities, beyond those of the segments' forces.
static void velocity_columns(const bough_rod_model *m, const bough_rod_tangent *k, int first, int j,
                             double *restrict out) {
    int s = m->stride;
    const double *restrict kept = k->vertex + first + 1, *restrict moment = m->moment + first;
    const double *restrict inertia = m->inertia + first, *restrict weight = m->mass + first;
    bough_vec3 e = bough_unit3(j), turn = bough_cross(k->omega, e);
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        bough_mat3 r = lane_load_matrix(kept + KEPT_R * s, s, l);
        bough_vec3 offset = lane_load(moment, s, l), w = lane_load(kept + KEPT_W * s, s, l);
        // δ(W×(W×s)) and δ(W×I W)
        bough_vec3 centrifugal =
            bough_add(bough_cross(e, bough_cross(w, offset)), bough_cross(w, bough_cross(e, offset)));
        bough_vec3 gyroscopic = bough_add(bough_cross(e, inertia_times(inertia, s, l, w)),
                                          bough_cross(w, inertia_times(inertia, s, l, e)));
        store_column(out, l, 0, j, bough_scale(-weight[l], turn));
        store_column(out, l, 3, j, bough_cross(bough_mat3_tmul(r, turn), offset));
        store_column(out, l, 0, 3 + j, bough_scale(-1, bough_mat3_mul(r, centrifugal)));
        store_column(out, l, 3, 3 + j, bough_scale(-1, gyroscopic));
    }
}

typedef struct vertex_load {
    bough_vec3 f, l; // force in BRF axes, moment in section axes
} vertex_load;

// Row j of the loads' slopes.
BOUGH_INLINE vertex_load slope_at(const double *restrict slope, int s, int i, int j, bough_mat3 r) {
    const double *restrict row = slope + j * s + i;
    return (vertex_load){{row[0], row[4 * s], 0}, bough_mat3_tmul(r, bough_v3(0, 0, row[8 * s]))};
}

// Adds what the loads change with velocity along x and y and with W₃.
static void damping_columns(const bough_rod_model *m, const bough_rod_loads *loads,
                            const bough_rod_tangent *k, int first, double *restrict out) {
    static const int row[3] = {0, 1, 3}, column[3] = {0, 1, 5};
    int s = m->stride;
    const double *restrict kept = k->vertex + first + 1, *restrict slope = loads->slope + first + 1;
    for (int j = 0; j < 3; j++) {
        double *restrict to = out + column[j] * LANES;
        int from = row[j];
#pragma omp simd
        for (int l = 0; l < LANES; l++) {
            vertex_load f = slope_at(slope, s, l, from, lane_load_matrix(kept + KEPT_R * s, s, l));
            to[l] += f.f.x;
            to[6 * LANES + l] += f.f.y;
            to[18 * LANES + l] += f.l.x;
            to[24 * LANES + l] += f.l.y;
            to[30 * LANES + l] += f.l.z;
        }
    }
}

// What the rotation of a vertex changes, from the accelerations `rate` (6 n: u̇, Ẇ): the moment of
// a load in BRF axes and the first moment's forces rotate in section axes.
static void rotation_columns(const bough_rod_model *m, const double *restrict rate, const double *input,
                             const bough_rod_scratch *scratch, bough_rod_tangent *k) {
    int n = m->n, s = m->stride;
    const double *restrict kept = k->vertex, *restrict first = m->moment;
    const double *restrict vertex = scratch->vertex, *restrict load = scratch->load;
    double *restrict out = k->local_position;
    bough_vec3 omega = k->omega, gravity = {input[6], input[7], input[8]};
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        bough_mat3 r = lane_load_matrix(kept + KEPT_R * s, s, v);
        bough_vec3 offset = lane_load(first, s, v - 1), w = lane_load(kept + KEPT_W * s, s, v);
        bough_vec3 u = lane_load(vertex + BOUGH_ROD_U * s, s, v);
        bough_vec3 udot = lane_load(rate, n, v - 1), wdot = lane_load(rate + 3 * n, n, v - 1);
        // the acceleration less gravity, in section axes
        bough_vec3 felt = bough_sub(bough_add(udot, bough_cross(omega, u)), gravity);
        bough_vec3 c = bough_mat3_tmul(r, felt);
        bough_vec3 moment = bough_mat3_tmul(r, lane_load(load + 3 * s, s, v));
        bough_vec3 shift = bough_add(bough_cross(wdot, offset), bough_cross(w, bough_cross(w, offset)));
        for (int j = 0; j < 3; j++) {
            bough_vec3 e = bough_unit3(j);
            bough_vec3 force = bough_mat3_mul(r, bough_cross(shift, e));
            bough_vec3 turned = bough_sub(bough_cross(moment, e), bough_cross(offset, bough_cross(c, e)));
            lane_store(out + 6 * j * s, s, v, force);
            lane_store(out + (6 * j + 3) * s, s, v, turned);
        }
    }
}

// Followers rotate with their vertex: δ(R f) = R (δφ×f), and the moment in section axes stays, where
// rotation_columns took it for a dead one.
static void add_followers(const bough_rod_model *m, const bough_rod_scratch *scratch, bough_rod_tangent *k) {
    int s = m->stride;
    double *out = k->local_position;
    for (int v = 1; v <= m->n; v++) {
        bough_mat3 r = lane_load_matrix(k->vertex + (size_t)KEPT_R * s, s, v);
        bough_vec3 force = lane_load(scratch->follower, s, v);
        bough_vec3 moment = lane_load(scratch->follower + 3 * s, s, v);
        for (int j = 0; j < 3; j++) {
            lane_add(out + 6 * j * s, s, v, bough_mat3_mul(r, bough_cross(bough_unit3(j), force)));
            lane_add(out + (6 * j + 3) * s, s, v, bough_cross(bough_unit3(j), moment));
        }
    }
}

// Adds how the loads follow the rotation about the section's normal.
static void add_turning(const bough_rod_model *m, const bough_rod_loads *loads, bough_rod_tangent *k) {
    int s = m->stride;
    const double *restrict kept = k->vertex, *restrict slope = loads->slope;
    double *restrict out = k->local_position + 12 * s;
#pragma omp simd
    for (int v = 1; v <= m->n; v++) {
        vertex_load f = slope_at(slope, s, v, 2, lane_load_matrix(kept + KEPT_R * s, s, v));
        lane_add(out, s, v, f.f);
        lane_add(out + 3 * s, s, v, f.l);
    }
}

// The tangents of a segment that is one of the eight, by columns: by configuration, then by velocities.
static void keep_segment(const bough_rod_eight *eight, const double *position, int segment, double *to) {
    int lane = segment - eight->first;
    if (lane < 0 || lane >= LANES) return;
    for (int d = 0; d < DIRECTIONS; d++) {
        for (int f = 0; f < FORCES; f++, to++) {
            int at = LANES * (DIRECTIONS * f + d) + lane;
            to[0] = position[at];
            to[TANGENTS] = eight->velocity[at];
        }
    }
}

// Segments first..first + 7 and the vertices at their right ends.
static void linearise_eight(const bough_rod_model *m, const bough_rod_loads *loads,
                            const bough_rod_scratch *scratch, int first, bough_rod_tangent *k) {
    _Alignas(64) double base[BASE * LANES];
    bough_rod_eight eight;
    eight.first = first;
    double *position = k->variation + (size_t)TANGENTS * first;
    // the segments' forces
    find_base(m, scratch, first, base);
    position_variation(m, scratch, first, base, position);
    velocity_variation(m, first, base, eight.velocity);
    // the vertices' mass and own velocity terms
    for (int j = 0; j < 3; j++) {
        mass_columns(m, k, first, j, eight.mass);
        velocity_columns(m, k, first, j, eight.own_velocity);
    }
    if (loads->damped) damping_columns(m, loads, k, first, eight.own_velocity);
    // tangents of root and end wrench, then the blocks
    keep_segment(&eight, position, 0, k->root);
    if (bough_rod_carries(m)) keep_segment(&eight, position, m->n, k->end);
    AT(form_blocks)(m, k, &eight);
}

bool AT(linearise)(const bough_rod_model *m, const bough_rod_loads *loads, double t, const double *state,
                   const double *input, bough_rod_scratch *scratch, bough_rod_tangent *k) {
    double *rate = k->rate;
    if (!AT(derivative)(m, loads, t, state, input, scratch, rate)) return false;
    k->omega = bough_v3(input[3], input[4], input[5]);
    // the vertices' own terms by their rotations
    keep_vertices(m, state, scratch->vertex, k);
    rotation_columns(m, rate + (size_t)BOUGH_ROD_U * m->n, input, scratch, k);
    if (bough_rod_loads_follow(loads)) add_followers(m, scratch, k);
    if (loads->damped) add_turning(m, loads, k);
    if (bough_rod_carries(m)) bough_rod_keep_end(m, loads, input + BOUGH_ROD_INPUTS, scratch, k);
    for (int first = 0; first < m->n_segment; first += LANES) {
        linearise_eight(m, loads, scratch, first, k);
    }
    return true;
}
