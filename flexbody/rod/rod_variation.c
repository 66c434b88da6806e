#include "flexbody/rod/rod_variation.h"

#include "flexbody/rod/rod_lanes.h"
#include "flexbody/rod/rod_tangent_layout.h"

// -- what all directions share --------------------------------------------------------------------

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
};

static inline void store_shape(double *restrict base, int l, segment_geometry s) {
    store3(base + LANES * BASE_R, LANES, l, s.r.c1);
    store3(base + LANES * (BASE_R + 3), LANES, l, s.r.c2);
    store3(base + LANES * (BASE_R + 6), LANES, l, s.r.c3);
    store3(base + LANES * BASE_V, LANES, l, s.v);
    store3(base + LANES * BASE_T, LANES, l, s.t);
    store3(base + LANES * BASE_CHORD, LANES, l, s.chord);
    store3(base + LANES * BASE_W, LANES, l, (bough_vec3){s.w, s.c, s.g});
    base[LANES * (BASE_W + 3) + l] = s.e;
    base[LANES * (BASE_W + 4) + l] = s.slope;
}

static inline segment_geometry load_shape(const double *restrict base, int l) {
    segment_geometry s;
    s.r = load_matrix(base + LANES * BASE_R, LANES, l);
    s.v = load3(base + LANES * BASE_V, LANES, l);
    s.t = load3(base + LANES * BASE_T, LANES, l);
    s.chord = load3(base + LANES * BASE_CHORD, LANES, l);
    s.w = base[LANES * BASE_W + l];
    s.c = base[LANES * (BASE_W + 1) + l];
    s.g = base[LANES * (BASE_W + 2) + l];
    s.e = base[LANES * (BASE_W + 3) + l];
    s.slope = base[LANES * (BASE_W + 4) + l];
    s.phi = bough_scale(s.c, s.v);
    return s;
}

static inline void store_elastic(double *restrict base, int l, elastic_state s) {
    double *restrict to = base + LANES * BASE_ELASTIC;
    store3(to, LANES, l, s.stress.u);
    store3(to + LANES * 3, LANES, l, s.bent.v);
    store3(to + LANES * 6, LANES, l, s.bent.u);
    store3(to + LANES * 9, LANES, l, s.kappa);
    store3(to + LANES * 12, LANES, l, s.b);
    store3(to + LANES * 15, LANES, l, (bough_vec3){s.value, s.limit, s.slope});
}

static inline elastic_state load_elastic(const double *restrict base, int l) {
    const double *restrict from = base + LANES * BASE_ELASTIC;
    return (elastic_state){.stress.u = load3(from, LANES, l),
                           .bent = {load3(from + LANES * 3, LANES, l), load3(from + LANES * 6, LANES, l)},
                           .kappa = load3(from + LANES * 9, LANES, l),
                           .b = load3(from + LANES * 12, LANES, l),
                           .value = from[LANES * 15 + l],
                           .limit = from[LANES * 16 + l],
                           .slope = from[LANES * 17 + l]};
}

void bough_rod_base(const bough_rod_model *m, const bough_rod_scratch *scratch, int first, double *base) {
    int s = m->stride;
    const double *restrict at = scratch->vertex + first, *restrict c = m->stiffness + first;
    const double *restrict d = m->damping + first, *restrict rest = scratch->rest + first;
    const double *restrict inverse = m->inverse_length + first, *restrict gradient = m->gradient + first;
    double *restrict out = base;
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        vertex_state left = load_vertex(at, s, l), right = load_vertex(at, s, l + 1);
        segment_geometry shape = segment_shape(left, right, inverse[l]);
        segment_rate motion = segment_motion(shape, left, right);
        strain e = elastic_strain(shape, inverse[l], rest, s, l);
        strain rate = strain_rate(shape, motion, inverse[l]);
        elastic_state elastic = elastic_at(c, gradient, s, l, e);
        strain stress = add_strain(elastic_stress(elastic), symmetric_times(d, s, l, rate));
        store_elastic(out, l, elastic);
        store_shape(out, l, shape);
        store3(out + LANES * BASE_RELATIVE, LANES, l, motion.relative);
        store3(out + LANES * BASE_MIDDLE, LANES, l, motion.middle);
        store3(out + LANES * BASE_DU, LANES, l, motion.du);
        store3(out + LANES * BASE_STRESS, LANES, l, stress.v);
        store3(out + LANES * (BASE_STRESS + 3), LANES, l, stress.u);
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

static inline void store_force(double *restrict column, int l, segment_force f) {
    store3(column, LANES * DIRECTIONS, l, f.f);
    store3(column + LANES * DIRECTIONS * LL, LANES * DIRECTIONS, l, f.ll);
    store3(column + LANES * DIRECTIONS * LR, LANES * DIRECTIONS, l, f.lr);
}

// `turning`: D q turns as well, and the moments of loads along the segment beside its chord.
static inline void position_direction(const bough_rod_model *m, const bough_rod_scratch *scratch,
                                      bool turning, int first, const double *restrict base,
                                      vertex_variation dl, vertex_variation dr, double *restrict column) {
    int s = m->stride;
    const double *restrict at = scratch->vertex + first, *restrict along = scratch->along + first;
    const double *restrict line = m->line + first, *restrict bend = m->bend0 + first;
    const double *restrict turn = m->strain0 + 3 * s + first, *restrict following =
                                                                  scratch->following + first;
    const double *restrict c = m->stiffness + first, *restrict gradient = m->gradient + first;
    const double *restrict damping = m->damping + first;
    const double *restrict inverse = m->inverse_length + first, *restrict h = m->length + first;
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        segment_geometry shape = load_shape(base, l);
        segment_rate motion = {.du = load3(base + LANES * BASE_DU, LANES, l),
                               .middle = load3(base + LANES * BASE_MIDDLE, LANES, l),
                               .relative = load3(base + LANES * BASE_RELATIVE, LANES, l),
                               .wl = load3(at + BOUGH_ROD_W * s, s, l),
                               .wr = load3(at + BOUGH_ROD_W * s, s, l + 1)};
        strain stress = {load3(base + LANES * BASE_STRESS, LANES, l),
                         load3(base + LANES * (BASE_STRESS + 3), LANES, l)};
        segment_variation d = shape_variation(shape, dl, dr, inverse[l]);
        strain de = {d.stretch, bough_scale(inverse[l], d.phi)};
        if (turning) de = add_turned(de, line, along, s, l, d.middle);
        strain drate = rate_variation(shape, motion, d, &dl, &dr, inverse[l]);
        elastic_state elastic = load_elastic(base, l);
        strain dstress = add_strain(elastic_variation(c, gradient, s, l, elastic, de),
                                    symmetric_times(damping, s, l, drate));
        segment_force f = force_variation(shape, d, stress, dstress, h[l]);
        if (turning) {
            bough_mat3 rl = bough_rotation_matrix(load_vertex(at, s, l).p);
            bough_mat3 rr = bough_rotation_matrix(load_vertex(at, s, l + 1).p);
            f = add_chord_moments(f, shape, d, rl, rr, dl.phi, dr.phi, load3(bend, s, l), load3(turn, s, l),
                                  load3(along, s, l), load3(following, s, l), h[l]);
        }
        store_force(column, l, f);
    }
}

void bough_rod_position_variation(const bough_rod_model *m, const bough_rod_scratch *scratch, int first,
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
static inline void velocity_direction(const bough_rod_model *m, int first, const double *restrict base,
                                      vertex_variation dl, vertex_variation dr, double *restrict column) {
    int s = m->stride;
    const double *restrict damping = m->damping + first, *restrict h = m->length + first;
    const double *restrict inverse = m->inverse_length + first;
    vertex_state left = {.u = dl.u, .w = dl.w}, right = {.u = dr.u, .w = dr.w};
#pragma omp simd
    for (int l = 0; l < LANES; l++) {
        segment_geometry shape = load_shape(base, l);
        strain rate = strain_rate(shape, segment_motion(shape, left, right), inverse[l]);
        strain stress = symmetric_times(damping, s, l, rate);
        store_force(column, l, stress_force(shape, stress, h[l]));
    }
}

void bough_rod_velocity_variation(const bough_rod_model *m, int first, const double *base,
                                  double *variation) {
    for (int k = 0; k < DIRECTIONS; k++) {
        vertex_variation dl, dr;
        unit_variation(k, true, &dl, &dr);
        velocity_direction(m, first, base, dl, dr, variation + LANES * k);
    }
}
