#include "flexbody/rod_tangent.h"

#include "flexbody/rod_segment.h"

#include <string.h>

enum {
    FORCES = 9,     // f, left moment, right moment
    DIRECTIONS = 9, // Δx, φ left, φ right; then Δu, W left, W right
    TANGENTS = FORCES * DIRECTIONS,
    W8 = 8,
};

// Rows of `vertex`: what elimination and solution need of each vertex.
enum {
    KEPT_P = 0,      // quaternion as in the state, not normalised
    KEPT_W = 4,      // W
    KEPT_OMEGA = 7,  // Rᵀω
    KEPT_R = 10,     // R by columns
    KEPT_TURN = 19,  // elimination of rotations A_φ, by rows
    KEPT_SCALE = 28, // 1/(factor of the quaternion's scale)
    KEPT = 29,
};

// Rows of `work`.
enum {
    WORK_Q = 0,      // eliminated configuration residual A r_q
    WORK_SCALAR = 6, // of the quaternion residual
    WORK_FORCE = 7,  // γ K A r_q per segment
    WORK = WORK_FORCE + FORCES,
};

bool bough_rod_tangent_init(bough_rod_tangent *k, bough_arena *arena, const bough_rod_model *m) {
    size_t s = (size_t)m->stride;
    k->variation = bough_arena_doubles(arena, 2 * TANGENTS * s);
    k->combined = bough_arena_doubles(arena, TANGENTS * s);
    k->mass = bough_arena_doubles(arena, 36 * s);
    k->local_velocity = bough_arena_doubles(arena, 36 * s);
    k->local_position = bough_arena_doubles(arena, 18 * s);
    k->vertex = bough_arena_doubles(arena, KEPT * s);
    k->work = bough_arena_doubles(arena, WORK * s);
    k->rate = bough_arena_doubles(arena, BOUGH_ROD_STATES * s);
    k->packed = bough_arena_doubles(arena, (size_t)m->n * W8);
    bool ok = bough_block_tridiagonal_init(&k->matrix, arena, m->n);
    return ok && !bough_arena_exhausted(arena);
}

bool bough_rod_blocks_init(bough_rod_blocks *b, bough_arena *arena, const bough_rod_model *m) {
    b->mass = bough_arena_doubles(arena, (size_t)m->n * BOUGH_BLOCK);
    bool ok = bough_block_tridiagonal_init(&b->position, arena, m->n);
    return bough_block_tridiagonal_init(&b->velocity, arena, m->n) && ok && b->mass != NULL;
}

// -- tangents of segment forces -------------------------------------------------------------------

static inline vertex_state load_vertex(const double *restrict v, int s, int i) {
    return (vertex_state){{v[i], v[s + i], v[2 * s + i]},
                          {v[7 * s + i], v[8 * s + i], v[9 * s + i]},
                          {v[10 * s + i], v[11 * s + i], v[12 * s + i]},
                          {v[3 * s + i], v[4 * s + i], v[5 * s + i], v[6 * s + i]}};
}

static inline bough_vec3 load3(const double *restrict a, int s, int i) {
    return (bough_vec3){a[i], a[s + i], a[2 * s + i]};
}

static inline void store3(double *restrict a, int s, int i, bough_vec3 v) {
    a[i] = v.x;
    a[s + i] = v.y;
    a[2 * s + i] = v.z;
}

static inline strain add_strain(strain a, strain b) {
    return (strain){bough_add(a.v, b.v), bough_add(a.u, b.u)};
}

// Derivative of the forces of segment n along variations of its vertices.
static inline segment_force segment_tangent(const bough_rod_model *m, const double *vertex, int n,
                                            const vertex_variation *dl,
                                            const vertex_variation *dr) {
    int s = m->stride;
    double h = m->length[n], inverse = m->inverse_length[n];
    vertex_state l = load_vertex(vertex, s, n), r = load_vertex(vertex, s, n + 1);
    segment_geometry shape = segment_shape(l, r, inverse);
    segment_rate motion = segment_motion(shape, l, r);
    strain e = {bough_sub(shape.stretch, load3(m->strain0, s, n)),
                bough_axpy(inverse, shape.phi, bough_scale(-1, load3(m->strain0 + 3 * s, s, n)))};
    strain rate = strain_rate(shape, motion, inverse);
    strain stress = add_strain(symmetric_times(m->stiffness, s, n, e),
                               symmetric_times(m->damping, s, n, rate));
    segment_variation d = shape_variation(shape, *dl, *dr, inverse);
    strain de = {d.stretch, bough_scale(inverse, d.phi)};
    strain drate = rate_variation(shape, motion, d, dl, dr, inverse);
    strain dstress = add_strain(symmetric_times(m->stiffness, s, n, de),
                                symmetric_times(m->damping, s, n, drate));
    return force_variation(shape, d, stress, dstress, h);
}

// The unit variation of direction `k`: Δ of the right against the left vertex, then each rotation;
// of velocities if so asked.
static void unit_variation(int k, bool velocity, vertex_variation *l, vertex_variation *r) {
    const bough_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    memset(l, 0, sizeof *l);
    memset(r, 0, sizeof *r);
    bough_vec3 *const part[6] = {&r->x, &l->phi, &r->phi, &r->u, &l->w, &r->w};
    *part[(velocity ? 3 : 0) + k / 3] = unit[k % 3];
}

// Configuration directions of segments first..last−1.
static void position_variations(const bough_rod_model *m, const double *vertex, int first, int last,
                                double *restrict out) {
    int s = m->stride;
    for (int k = 0; k < DIRECTIONS; k++) {
        vertex_variation dl, dr;
        unit_variation(k, false, &dl, &dr);
        double *restrict column = out + (size_t)k * FORCES * s;
#pragma omp simd
        for (int n = first; n < last; n++) {
            segment_force f = segment_tangent(m, vertex, n, &dl, &dr);
            store3(column, s, n, f.f);
            store3(column + 3 * s, s, n, f.ll);
            store3(column + 6 * s, s, n, f.lr);
        }
    }
}

// Velocity directions: the shape does not vary, the stress varies by D ė.
static void velocity_variations(const bough_rod_model *m, const double *vertex, int first, int last,
                                double *restrict out) {
    int s = m->stride;
    for (int k = 0; k < DIRECTIONS; k++) {
        vertex_variation dl, dr;
        unit_variation(k, true, &dl, &dr);
        double *restrict column = out + (size_t)k * FORCES * s;
#pragma omp simd
        for (int n = first; n < last; n++) {
            vertex_state l = load_vertex(vertex, s, n), r = load_vertex(vertex, s, n + 1);
            segment_geometry shape = segment_shape(l, r, m->inverse_length[n]);
            l.u = dl.u;
            l.w = dl.w;
            r.u = dr.u;
            r.w = dr.w;
            segment_rate motion = segment_motion(shape, l, r);
            strain rate = strain_rate(shape, motion, m->inverse_length[n]);
            segment_force f = stress_force(shape, symmetric_times(m->damping, s, n, rate),
                                           m->length[n]);
            store3(column, s, n, f.f);
            store3(column + 3 * s, s, n, f.ll);
            store3(column + 6 * s, s, n, f.lr);
        }
    }
}

// (E + ξ(a))⁻¹ y = (y + a (a·y) − a×y)/(1 + |a|²)
static inline bough_vec3 solve_cross(bough_vec3 a, bough_vec3 y) {
    bough_vec3 sum = bough_axpy(bough_dot(a, y), a, bough_sub(y, bough_cross(a, y)));
    return bough_scale(1 / (1 + bough_dot(a, a)), sum);
}

// -- a vertex' own terms --------------------------------------------------------------------------

static inline void store_column(double *restrict block, int s, int v, int row, int column,
                                bough_vec3 x) {
    block[(6 * row + column) * s + v] = x.x;
    block[(6 * (row + 1) + column) * s + v] = x.y;
    block[(6 * (row + 2) + column) * s + v] = x.z;
}

static inline bough_mat3 load_matrix(const double *restrict a, int s, int v) {
    return (bough_mat3){load3(a, s, v), load3(a + 3 * s, s, v), load3(a + 6 * s, s, v)};
}

static inline bough_vec3 unit_vector(int j) {
    return (bough_vec3){j == 0, j == 1, j == 2};
}

static inline bough_vec3 inertia_times(const double *restrict j, int s, int i, bough_vec3 w) {
    double xx = j[i], yy = j[s + i], zz = j[2 * s + i], xy = j[3 * s + i], xz = j[4 * s + i];
    double yz = j[5 * s + i];
    return (bough_vec3){xx * w.x + xy * w.y + xz * w.z, xy * w.x + yy * w.y + yz * w.z,
                        xz * w.x + yz * w.y + zz * w.z};
}

static void keep_vertices(const bough_rod_model *m, const double *restrict state,
                          const double *restrict vertex, bough_rod_tangent *k) {
    int n = m->n, s = m->stride;
    double *restrict kept = k->vertex;
    bough_vec3 omega = k->omega;
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        vertex_state a = load_vertex(vertex, s, v);
        double w = a.p.w, x = a.p.x, y = a.p.y, z = a.p.z;
        bough_mat3 r = {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
                        {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
                        {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
        kept[KEPT_P * s + v] = state[3 * n + v - 1];
        store3(kept + (KEPT_P + 1) * s, s, v, load3(state + 4 * n, n, v - 1));
        store3(kept + KEPT_W * s, s, v, a.w);
        store3(kept + KEPT_OMEGA * s, s, v, bough_mat3_tmul(r, omega));
        store3(kept + KEPT_R * s, s, v, r.c1);
        store3(kept + (KEPT_R + 3) * s, s, v, r.c2);
        store3(kept + (KEPT_R + 6) * s, s, v, r.c3);
    }
}

// The mass of (11), force in BRF axes: [mE, −Rξ(s); ξ(s)Rᵀ, Î], column j of each half.
static void mass_columns(const bough_rod_model *m, bough_rod_tangent *k, int j) {
    int n = m->n, s = m->stride;
    const double *restrict kept = k->vertex, *restrict first = m->moment;
    const double *restrict inertia = m->inertia, *restrict weight = m->mass;
    double *restrict mass = k->mass;
    bough_vec3 e = unit_vector(j);
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        bough_mat3 r = load_matrix(kept + KEPT_R * s, s, v);
        bough_vec3 offset = load3(first, s, v - 1);
        store_column(mass, s, v, 0, j, bough_scale(weight[v - 1], e));
        store_column(mass, s, v, 3, j, bough_cross(offset, bough_mat3_tmul(r, e)));
        store_column(mass, s, v, 0, 3 + j, bough_mat3_mul(r, bough_cross(e, offset)));
        store_column(mass, s, v, 3, 3 + j, inertia_times(inertia, s, v - 1, e));
    }
}

// What the velocities change in (11) beyond the segments' forces.
static void velocity_columns(const bough_rod_model *m, bough_rod_tangent *k, int j) {
    int n = m->n, s = m->stride;
    const double *restrict kept = k->vertex, *restrict first = m->moment;
    const double *restrict inertia = m->inertia, *restrict weight = m->mass;
    double *restrict out = k->local_velocity;
    bough_vec3 e = unit_vector(j), turn = bough_cross(k->omega, e);
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        bough_mat3 r = load_matrix(kept + KEPT_R * s, s, v);
        bough_vec3 offset = load3(first, s, v - 1), w = load3(kept + KEPT_W * s, s, v);
        bough_vec3 centrifugal = bough_add(bough_cross(e, bough_cross(w, offset)),
                                           bough_cross(w, bough_cross(e, offset)));
        bough_vec3 gyroscopic = bough_add(bough_cross(e, inertia_times(inertia, s, v - 1, w)),
                                          bough_cross(w, inertia_times(inertia, s, v - 1, e)));
        store_column(out, s, v, 0, j, bough_scale(-weight[v - 1], turn));
        store_column(out, s, v, 3, j, bough_cross(bough_mat3_tmul(r, turn), offset));
        store_column(out, s, v, 0, 3 + j, bough_scale(-1, bough_mat3_mul(r, centrifugal)));
        store_column(out, s, v, 3, 3 + j, bough_scale(-1, gyroscopic));
    }
}

// What the rotation of a vertex changes, from the accelerations `rate` (6 n: u̇, Ẇ): the moment of
// a load in BRF axes and the first moment's forces turn with it.
static void rotation_columns(const bough_rod_model *m, const double *restrict rate,
                             const double *input, const bough_rod_scratch *scratch,
                             bough_rod_tangent *k) {
    int n = m->n, s = m->stride;
    const double *restrict kept = k->vertex, *restrict first = m->moment;
    const double *restrict vertex = scratch->vertex, *restrict load = scratch->load;
    double *restrict out = k->local_position;
    bough_vec3 omega = k->omega, gravity = {input[6], input[7], input[8]};
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        bough_mat3 r = load_matrix(kept + KEPT_R * s, s, v);
        bough_vec3 offset = load3(first, s, v - 1), w = load3(kept + KEPT_W * s, s, v);
        bough_vec3 u = load3(vertex + BOUGH_ROD_U * s, s, v);
        bough_vec3 udot = load3(rate, n, v - 1), wdot = load3(rate + 3 * n, n, v - 1);
        bough_vec3 felt = bough_sub(bough_add(udot, bough_cross(omega, u)), gravity);
        bough_vec3 c = bough_mat3_tmul(r, felt);
        bough_vec3 moment = bough_mat3_tmul(r, load3(load + 3 * s, s, v));
        bough_vec3 shift = bough_add(bough_cross(wdot, offset),
                                     bough_cross(w, bough_cross(w, offset)));
        for (int j = 0; j < 3; j++) {
            bough_vec3 e = unit_vector(j);
            bough_vec3 force = bough_mat3_mul(r, bough_cross(shift, e));
            bough_vec3 turned = bough_sub(bough_cross(moment, e),
                                          bough_cross(offset, bough_cross(c, e)));
            store3(out + 6 * j * s, s, v, force);
            store3(out + (6 * j + 3) * s, s, v, turned);
        }
    }
}

// Followers turn with their vertex: δ(R f) = R (δφ×f), and the moment in section axes stays, where
// rotation_columns took it for a dead one.
static void add_followers(const bough_rod_model *m, const bough_rod_scratch *scratch,
                          bough_rod_tangent *k) {
    int s = m->stride;
    double *out = k->local_position;
    for (int v = 1; v <= m->n; v++) {
        bough_mat3 r = load_matrix(k->vertex + (size_t)KEPT_R * s, s, v);
        bough_vec3 force = load3(scratch->follower, s, v);
        bough_vec3 moment = load3(scratch->follower + 3 * s, s, v);
        for (int j = 0; j < 3; j++) {
            bough_vec3 pull = bough_mat3_mul(r, bough_cross(unit_vector(j), force));
            bough_vec3 turn = bough_cross(unit_vector(j), moment);
            bough_vec3 old_pull = load3(out + 6 * j * s, s, v);
            bough_vec3 old_turn = load3(out + (6 * j + 3) * s, s, v);
            store3(out + 6 * j * s, s, v, bough_add(old_pull, pull));
            store3(out + (6 * j + 3) * s, s, v, bough_add(old_turn, turn));
        }
    }
}

bool bough_rod_linearise(const bough_rod_model *m, const bough_rod_loads *loads, double t,
                         const double *state, const double *input, bough_rod_scratch *scratch,
                         bough_rod_tangent *k) {
    double *rate = k->rate;
    if (!bough_rod_derivative(m, loads, t, state, input, scratch, rate)) return false;
    k->omega = bough_v3(input[3], input[4], input[5]);
    keep_vertices(m, state, scratch->vertex, k);
    for (int j = 0; j < 3; j++) {
        mass_columns(m, k, j);
        velocity_columns(m, k, j);
    }
    rotation_columns(m, rate + (size_t)BOUGH_ROD_U * m->n, input, scratch, k);
    if (bough_rod_loads_follow(loads)) add_followers(m, scratch, k);
    position_variations(m, scratch->vertex, 0, m->n, k->variation);
    velocity_variations(m, scratch->vertex, 0, m->n, k->variation + (size_t)TANGENTS * m->stride);
    return true;
}

// -- blocks ---------------------------------------------------------------------------------------

// Adds sign·G to the 3×3 part of a block at (row, column): G the tangents of three forces from
// `force` in the three directions from `direction`, of segment n.
static inline void add_part(double *restrict block, int row, int column, double sign,
                            const double *restrict g, int s) {
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < 3; i++) {
            block[W8 * (row + i) + column + k] += sign * g[(FORCES * k + i) * s];
        }
    }
}

enum { DELTA = 0, LEFT = 3, RIGHT = 6, F = 0, LL = 3, LR = 6 }; // directions; forces

static inline const double *tangent_at(const double *g, int s, int direction, int force, int n) {
    return g + (size_t)(FORCES * direction + force) * s + n;
}

// The blocks of row v − 1 of sign·∂(vertex force)/∂(…) from the tangents g of all segments. A
// segment pulls its left vertex by f and its right one by −f.
static inline void add_segments(bough_block_tridiagonal *b, const double *g, int s, int v,
                                double sign) {
    size_t at = (size_t)(v - 1) * BOUGH_BLOCK;
    double *diagonal = b->diagonal + at, *lower = b->lower + at, *upper = b->upper + at;
    int l = v - 1; // the segment on the left
    add_part(diagonal, 0, 0, -sign, tangent_at(g, s, DELTA, F, l), s);
    add_part(diagonal, 0, 3, -sign, tangent_at(g, s, RIGHT, F, l), s);
    add_part(diagonal, 3, 0, sign, tangent_at(g, s, DELTA, LR, l), s);
    add_part(diagonal, 3, 3, sign, tangent_at(g, s, RIGHT, LR, l), s);
    add_part(lower, 0, 0, sign, tangent_at(g, s, DELTA, F, l), s);
    add_part(lower, 0, 3, -sign, tangent_at(g, s, LEFT, F, l), s);
    add_part(lower, 3, 0, -sign, tangent_at(g, s, DELTA, LR, l), s);
    add_part(lower, 3, 3, sign, tangent_at(g, s, LEFT, LR, l), s);
    if (v == b->n) return;
    add_part(diagonal, 0, 0, -sign, tangent_at(g, s, DELTA, F, v), s);
    add_part(diagonal, 0, 3, sign, tangent_at(g, s, LEFT, F, v), s);
    add_part(diagonal, 3, 0, -sign, tangent_at(g, s, DELTA, LL, v), s);
    add_part(diagonal, 3, 3, sign, tangent_at(g, s, LEFT, LL, v), s);
    add_part(upper, 0, 0, sign, tangent_at(g, s, DELTA, F, v), s);
    add_part(upper, 0, 3, sign, tangent_at(g, s, RIGHT, F, v), s);
    add_part(upper, 3, 0, sign, tangent_at(g, s, DELTA, LL, v), s);
    add_part(upper, 3, 3, sign, tangent_at(g, s, RIGHT, LL, v), s);
}

static void clear_row(bough_block_tridiagonal *b, int v) {
    size_t at = (size_t)(v - 1) * BOUGH_BLOCK, bytes = BOUGH_BLOCK * sizeof(double);
    memset(b->lower + at, 0, bytes);
    memset(b->diagonal + at, 0, bytes);
    memset(b->upper + at, 0, bytes);
}

void bough_rod_assemble(const bough_rod_model *m, const bough_rod_tangent *k, bough_rod_blocks *b) {
    int s = m->stride;
    for (int v = 1; v <= m->n; v++) {
        size_t at = (size_t)(v - 1) * BOUGH_BLOCK;
        clear_row(&b->position, v);
        clear_row(&b->velocity, v);
        add_segments(&b->position, k->variation, s, v, 1);
        add_segments(&b->velocity, k->variation + (size_t)TANGENTS * s, s, v, 1);
        for (int i = 0; i < 6; i++) {
            for (int j = 0; j < 6; j++) {
                b->mass[at + W8 * i + j] = k->mass[(6 * i + j) * s + v];
                b->velocity.diagonal[at + W8 * i + j] += k->local_velocity[(6 * i + j) * s + v];
            }
            for (int j = 0; j < 3; j++) {
                b->position.diagonal[at + W8 * i + 3 + j] += k->local_position[(6 * j + i) * s + v];
            }
        }
    }
}

// -- elimination and factorisation ----------------------------------------------------------------

// A_φ = (eE + ξ(a) + qqᵀ/f)⁻¹ of every vertex, a = ½γ(W + Rᵀω), q = ½γ(W − Rᵀω), by
// Sherman–Morrison; e and f are 1 but for the norm's restoring κ(1 − |p|²)p, linearised.
static void eliminate_rotations(const bough_rod_model *m, bough_rod_tangent *k) {
    int n = m->n, s = m->stride;
    double gamma = k->gamma;
    double *restrict kept = k->vertex;
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        bough_vec3 w = load3(kept + KEPT_W * s, s, v), o = load3(kept + KEPT_OMEGA * s, s, v);
        bough_vec3 vector = load3(kept + (KEPT_P + 1) * s, s, v);
        double scalar = kept[KEPT_P * s + v];
        double square = scalar * scalar + bough_dot(vector, vector);
        double e = 1 - gamma * BOUGH_ROD_NORM_RATE * (1 - square);
        double f = e + 2 * gamma * BOUGH_ROD_NORM_RATE * square;
        bough_vec3 a = bough_scale(0.5 * gamma / e, bough_add(w, o));
        bough_vec3 q = bough_scale(0.5 * gamma, bough_sub(w, o));
        bough_vec3 bq = bough_scale(1 / e, solve_cross(a, q));
        double weight = 1 / (f + bough_dot(q, bq));
        for (int j = 0; j < 3; j++) {
            bough_vec3 b = bough_scale(1 / e, solve_cross(a, unit_vector(j)));
            b = bough_axpy(-weight * bough_dot(q, b), bq, b);
            kept[(KEPT_TURN + j) * s + v] = b.x;
            kept[(KEPT_TURN + 3 + j) * s + v] = b.y;
            kept[(KEPT_TURN + 6 + j) * s + v] = b.z;
        }
        kept[KEPT_SCALE * s + v] = 1 / f;
    }
}

// Combines three directions of one force: out = γ(D + γ K A), A (3×3 by rows) for each segment at
// `a` with stride s, or one for all when s is 0.
static inline void combine(const double *restrict position, const double *restrict velocity,
                           const double *restrict a, int sa, double gamma, int n, int s,
                           double *restrict out) {
    size_t step = (size_t)FORCES * s;
    const double *restrict p1 = position + step, *restrict p2 = p1 + step;
    const double *restrict d1 = velocity + step, *restrict d2 = d1 + step;
    double *restrict o1 = out + step, *restrict o2 = o1 + step;
#define A(i, j) a[(3 * (i) + (j)) * (sa == 0 ? 1 : sa) + (sa == 0 ? 0 : k)]
#pragma omp simd
    for (int k = 0; k < n; k++) {
        double x = gamma * position[k], y = gamma * p1[k], z = gamma * p2[k];
        out[k] = gamma * (velocity[k] + x * A(0, 0) + y * A(1, 0) + z * A(2, 0));
        o1[k] = gamma * (d1[k] + x * A(0, 1) + y * A(1, 1) + z * A(2, 1));
        o2[k] = gamma * (d2[k] + x * A(0, 2) + y * A(1, 2) + z * A(2, 2));
    }
#undef A
}

// γ(Dᵥ + γ K A) of all segments.
static void combine_segments(const bough_rod_model *m, bough_rod_tangent *k) {
    int n = m->n, s = m->stride;
    const double *position = k->variation, *velocity = position + (size_t)TANGENTS * s;
    const double *turn = k->vertex + (size_t)KEPT_TURN * s;
    double shift[9];
    bough_vec3 g = bough_scale(k->gamma, k->omega);
    for (int j = 0; j < 3; j++) {
        bough_vec3 column = solve_cross(g, unit_vector(j));
        shift[j] = column.x;
        shift[3 + j] = column.y;
        shift[6 + j] = column.z;
    }
    for (int force = 0; force < FORCES; force++) {
        size_t x = (size_t)force * s, l = x + (size_t)LEFT * FORCES * s;
        size_t r = x + (size_t)RIGHT * FORCES * s;
        combine(position + x, velocity + x, shift, 0, k->gamma, n, s, k->combined + x);
        combine(position + l, velocity + l, turn, s, k->gamma, n, s, k->combined + l);
        combine(position + r, velocity + r, turn + 1, s, k->gamma, n, s, k->combined + r);
    }
}

// Where entry (i, j) of the blocks comes from among the segments' combined tangents.
typedef struct entry_source {
    const double *right; // of the segment whose right vertex it is
    const double *left;  // of the segment whose left vertex it is
    const double *lower, *upper;
    double right_sign, left_sign, lower_sign;
} entry_source;

static const double *combined_at(const bough_rod_tangent *k, int s, int direction, int force) {
    return k->combined + (size_t)(FORCES * direction + force) * s;
}

static entry_source source_of(const bough_rod_tangent *k, int s, int i, int j) {
    bool force = i < 3, shift = j < 3;
    int right = force ? F + i : LR + i - 3, left = force ? F + i : LL + i - 3;
    int turn = j - 3;
    return (entry_source){.right = combined_at(k, s, shift ? DELTA + j : RIGHT + turn, right),
                          .left = combined_at(k, s, shift ? DELTA + j : LEFT + turn, left),
                          .lower = combined_at(k, s, shift ? DELTA + j : LEFT + turn, right),
                          .upper = combined_at(k, s, shift ? DELTA + j : RIGHT + turn, left),
                          .right_sign = force ? 1 : -1,
                          .left_sign = shift ? 1 : -1,
                          .lower_sign = force == shift ? -1 : 1};
}

// Entry (i, j) of every block, vertex after vertex: blocks are formed by strided stores, whole
// arrays at a time.
static void store_entry(bough_rod_tangent *k, int n, int s, int i, int j) {
    entry_source from = source_of(k, s, i, j);
    const double *restrict right = from.right, *restrict left = from.left;
    const double *restrict below = from.lower, *restrict above = from.upper;
    const double *restrict mass = k->mass + (6 * i + j) * s;
    const double *restrict own = k->local_velocity + (6 * i + j) * s;
    double *restrict diagonal = k->matrix.diagonal + W8 * i + j;
    double *restrict lower = k->matrix.lower + W8 * i + j;
    double *restrict upper = k->matrix.upper + W8 * i + j;
    double gamma = k->gamma;
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        double segments = from.right_sign * right[v - 1] + from.left_sign * left[v];
        diagonal[BOUGH_BLOCK * (v - 1)] = mass[v] - gamma * own[v] + segments;
    }
#pragma omp simd
    for (int v = 1; v < n; v++) {
        lower[BOUGH_BLOCK * v] = from.lower_sign * below[v];
        upper[BOUGH_BLOCK * (v - 1)] = -above[v];
    }
}

// Takes γ² times the vertices' own rotation tangents, eliminated, off entry (i, 3 + j).
static void subtract_rotation(bough_rod_tangent *k, int n, int s, int i, int j) {
    const double *restrict x = k->local_position + i * s;
    const double *restrict y = x + 6 * s, *restrict z = y + 6 * s;
    const double *restrict turn = k->vertex + (size_t)(KEPT_TURN + j) * s;
    double *restrict diagonal = k->matrix.diagonal + W8 * i + 3 + j;
    double square = k->gamma * k->gamma;
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        double sum = x[v] * turn[v] + y[v] * turn[3 * s + v] + z[v] * turn[6 * s + v];
        diagonal[BOUGH_BLOCK * (v - 1)] -= square * sum;
    }
}

bool bough_rod_factor(const bough_rod_model *m, bough_rod_tangent *k, double gamma) {
    k->gamma = gamma;
    eliminate_rotations(m, k);
    combine_segments(m, k);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) store_entry(k, m->n, m->stride, i, j);
        for (int j = 0; j < 3; j++) subtract_rotation(k, m->n, m->stride, i, j);
    }
    return bough_block_tridiagonal_factor(&k->matrix);
}

// -- solution -------------------------------------------------------------------------------------

// A r_q of every vertex and the scalar part of the quaternion residual p⁻¹∘r.
static void eliminate_residual(const bough_rod_model *m, const bough_rod_tangent *k,
                               const double *restrict x, double *restrict q) {
    int n = m->n, s = m->stride;
    const double *restrict kept = k->vertex, *restrict turn = kept + KEPT_TURN * s;
    bough_vec3 g = bough_scale(k->gamma, k->omega);
    double gamma = k->gamma, gg = 1 / (1 + bough_dot(g, g));
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        bough_vec3 rx = load3(x, n, v - 1), rp = load3(x + 4 * n, n, v - 1);
        bough_vec3 p = load3(kept + (KEPT_P + 1) * s, s, v);
        double rw = x[3 * n + v - 1], pw = kept[KEPT_P * s + v];
        double inverse = 1 / (pw * pw + bough_dot(p, p));
        double scalar = inverse * (pw * rw + bough_dot(p, rp));
        bough_vec3 rho = bough_axpy(pw, rp, bough_axpy(-rw, p, bough_cross(rp, p)));
        rho = bough_scale(2 * inverse, rho);
        bough_vec3 slip = bough_sub(load3(kept + KEPT_W * s, s, v),
                                    load3(kept + KEPT_OMEGA * s, s, v));
        rho = bough_axpy(gamma * scalar * kept[KEPT_SCALE * s + v], slip, rho);
        bough_vec3 shift = bough_axpy(bough_dot(g, rx), g, bough_sub(rx, bough_cross(g, rx)));
        store3(q, s, v, bough_scale(gg, shift));
        for (int i = 0; i < 3; i++) {
            q[(3 + i) * s + v] = turn[3 * i * s + v] * rho.x + turn[(3 * i + 1) * s + v] * rho.y +
                                 turn[(3 * i + 2) * s + v] * rho.z;
        }
        q[WORK_SCALAR * s + v] = scalar;
    }
}

// γ K A r_q of every segment.
static void segment_residual(const bough_rod_model *m, const bough_rod_tangent *k,
                             const double *restrict q, double *restrict force) {
    int n = m->n, s = m->stride;
    double gamma = k->gamma;
    for (int f = 0; f < FORCES; f++) {
        const double *restrict t = k->variation + (size_t)f * s;
        double *restrict out = force + (size_t)f * s;
#define T(direction) t[FORCES * (direction)*s + k2]
#pragma omp simd
        for (int k2 = 0; k2 < n; k2++) {
            double sum = T(0) * (q[k2 + 1] - q[k2]) + T(1) * (q[s + k2 + 1] - q[s + k2]) +
                         T(2) * (q[2 * s + k2 + 1] - q[2 * s + k2]);
            sum += T(3) * q[3 * s + k2] + T(4) * q[4 * s + k2] + T(5) * q[5 * s + k2];
            sum += T(6) * q[3 * s + k2 + 1] + T(7) * q[4 * s + k2 + 1] + T(8) * q[5 * s + k2 + 1];
            out[k2] = gamma * sum;
        }
#undef T
    }
}

// M r_v + γ K A r_q of every vertex, packed for the block solver.
static void velocity_residual(const bough_rod_model *m, const bough_rod_tangent *k,
                              const double *restrict x, const double *restrict work,
                              double *restrict packed) {
    int n = m->n, s = m->stride;
    const double *restrict mass = k->mass, *restrict own = k->local_position;
    const double *restrict force = work + WORK_FORCE * s;
    const double *restrict r = x + (size_t)BOUGH_ROD_U * n;
    for (int i = 0; i < 6; i++) {
        const double *restrict row = mass + (size_t)6 * i * s;
        const double *restrict here = force + (size_t)i * s; // f, or the left moment
        const double *restrict there = i < 3 ? here : here + (size_t)3 * s;
        double sign = i < 3 ? -1 : 1, gamma = k->gamma;
#pragma omp simd
        for (int v = 1; v <= n; v++) {
            double sum = here[v] + sign * there[v - 1];
            sum += gamma * (own[i * s + v] * work[3 * s + v] + own[(6 + i) * s + v] * work[4 * s + v] +
                            own[(12 + i) * s + v] * work[5 * s + v]);
            for (int j = 0; j < 6; j++) sum += row[j * s + v] * r[j * n + v - 1];
            packed[W8 * (v - 1) + i] = sum;
        }
    }
}

// Velocities and the configuration that belongs to them back into the state's layout.
static void recover(const bough_rod_model *m, const bough_rod_tangent *k,
                    const double *restrict q, const double *restrict packed, double *restrict x) {
    int n = m->n, s = m->stride;
    const double *restrict kept = k->vertex, *restrict turn = kept + KEPT_TURN * s;
    bough_vec3 g = bough_scale(k->gamma, k->omega);
    double gamma = k->gamma, gg = 1 / (1 + bough_dot(g, g));
#pragma omp simd
    for (int i = 0; i < n; i++) {
        int v = i + 1;
        const double *restrict dv = packed + W8 * i;
        bough_vec3 du = {dv[0], dv[1], dv[2]}, dw = {gamma * dv[3], gamma * dv[4], gamma * dv[5]};
        bough_vec3 gu = bough_scale(gamma, du);
        bough_vec3 shift = bough_axpy(bough_dot(g, gu), g, bough_sub(gu, bough_cross(g, gu)));
        store3(x, n, i, bough_axpy(gg, shift, load3(q, s, v)));
        bough_vec3 phi = {turn[v] * dw.x + turn[s + v] * dw.y + turn[2 * s + v] * dw.z,
                          turn[3 * s + v] * dw.x + turn[4 * s + v] * dw.y + turn[5 * s + v] * dw.z,
                          turn[6 * s + v] * dw.x + turn[7 * s + v] * dw.y + turn[8 * s + v] * dw.z};
        phi = bough_add(phi, load3(q + 3 * s, s, v));
        bough_vec3 slip = bough_sub(load3(kept + KEPT_W * s, s, v),
                                    load3(kept + KEPT_OMEGA * s, s, v));
        double scalar = q[WORK_SCALAR * s + v] - 0.25 * gamma * bough_dot(slip, phi);
        scalar *= kept[KEPT_SCALE * s + v];
        bough_vec3 p = load3(kept + (KEPT_P + 1) * s, s, v), half = bough_scale(0.5, phi);
        double pw = kept[KEPT_P * s + v];
        x[3 * n + i] = pw * scalar - bough_dot(p, half);
        bough_vec3 vector = bough_axpy(pw, half, bough_axpy(scalar, p, bough_cross(p, half)));
        store3(x + 4 * n, n, i, vector);
        store3(x + 7 * n, n, i, du);
        store3(x + 10 * n, n, i, bough_v3(dv[3], dv[4], dv[5]));
    }
}

void bough_rod_solve(const bough_rod_model *m, bough_rod_tangent *k, double *x) {
    eliminate_residual(m, k, x, k->work);
    segment_residual(m, k, k->work, k->work + (size_t)WORK_FORCE * m->stride);
    velocity_residual(m, k, x, k->work, k->packed);
    bough_block_tridiagonal_solve(&k->matrix, k->packed);
    recover(m, k, k->work, k->packed, x);
}

// p⁻¹∘r: scalar ρ₀ and rotation ρ = 2·vector
static void to_tangent(bough_quaternion p, bough_quaternion r, double *scalar, bough_vec3 *vector) {
    bough_quaternion d = bough_quaternion_product(bough_quaternion_conjugate(p), r);
    double inverse = 1 / (p.w * p.w + p.x * p.x + p.y * p.y + p.z * p.z);
    *scalar = inverse * d.w;
    *vector = bough_scale(2 * inverse, bough_v3(d.x, d.y, d.z));
}

// -- ports ----------------------------------------------------------------------------------------

void bough_rod_wrench_tangent(const bough_rod_model *m, const double *state, const double *input,
                              const double *state_variation, const double *input_variation,
                              bough_rod_scratch *scratch, double *wrench) {
    int n = m->n;
    bough_rod_gather(m, state, input, scratch);
    bough_mat3 r0 = bough_rotation_matrix(m->rotation0[0]);
    vertex_variation l = {0}, r = {0};
    if (input_variation != NULL) {
        const double *d = input_variation;
        l.u = bough_v3(d[0], d[1], d[2]);
        l.w = bough_mat3_tmul(r0, bough_v3(d[3], d[4], d[5]));
    }
    if (state_variation != NULL) {
        const double *d = state_variation;
        bough_quaternion p = {state[3 * n], state[4 * n], state[5 * n], state[6 * n]};
        bough_quaternion dp = {d[3 * n], d[4 * n], d[5 * n], d[6 * n]};
        double scalar;
        to_tangent(p, dp, &scalar, &r.phi);
        r.x = bough_v3(d[0], d[n], d[2 * n]);
        r.u = bough_v3(d[7 * n], d[8 * n], d[9 * n]);
        r.w = bough_v3(d[10 * n], d[11 * n], d[12 * n]);
    }
    segment_force f = segment_tangent(m, scratch->vertex, 0, &l, &r);
    bough_vec3 moment = bough_mat3_mul(r0, f.ll);
    const double values[6] = {f.f.x, f.f.y, f.f.z, moment.x, moment.y, moment.z};
    memcpy(wrench, values, sizeof values);
}

// Acceleration of moving vertex 0 by a force in BRF axes and a moment in section axes.
static void vertex_response(const bough_rod_model *m, bough_mat3 r, segment_force f,
                            double *column) {
    int n = m->n;
    strain h = {bough_mat3_tmul(r, bough_scale(-1, f.f)), f.lr};
    strain q = symmetric_times(m->inverse_mass, m->stride, 0, h);
    bough_vec3 u = bough_mat3_mul(r, q.v);
    const double values[6] = {u.x, u.y, u.z, q.u.x, q.u.y, q.u.z};
    for (int c = 0; c < 6; c++) column[(BOUGH_ROD_U + c) * n] += values[c];
}

// Column of ∂f/∂u₀ⱼ, ∂f/∂ωⱼ or ∂f/∂gⱼ over the vertices' kinematics; e the unit vector.
static void frame_column(const bough_rod_model *m, const double *state, int kind, bough_vec3 e,
                         double *column) {
    int n = m->n;
    for (int i = 0; i < n; i++) {
        bough_vec3 x = load3(state, n, i), u = load3(state + (size_t)BOUGH_ROD_U * n, n, i);
        bough_quaternion p = {state[3 * n + i], state[4 * n + i], state[5 * n + i],
                              state[6 * n + i]};
        if (kind == 0) store3(column, n, i, bough_scale(-1, e));
        if (kind == 2) store3(column + (size_t)BOUGH_ROD_U * n, n, i, e);
        if (kind != 1) continue;
        bough_quaternion turn = bough_quaternion_product((bough_quaternion){0, e.x, e.y, e.z}, p);
        store3(column, n, i, bough_cross(x, e));
        column[3 * n + i] = -0.5 * turn.w;
        store3(column + (size_t)4 * n, n, i, bough_scale(-0.5, bough_v3(turn.x, turn.y, turn.z)));
        store3(column + (size_t)BOUGH_ROD_U * n, n, i, bough_cross(u, e));
    }
}

void bough_rod_input_columns(const bough_rod_model *m, const double *state, const double *input,
                             bough_rod_scratch *scratch, double *column) {
    size_t size = (size_t)BOUGH_ROD_STATES * m->n;
    const bough_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    bough_rod_gather(m, state, input, scratch);
    bough_mat3 r0 = bough_rotation_matrix(m->rotation0[0]);
    bough_mat3 r1 = bough_rotation_matrix(load_vertex(scratch->vertex, m->stride, 1).p);
    memset(column, 0, BOUGH_ROD_INPUTS * size * sizeof *column);
    for (int j = 0; j < BOUGH_ROD_INPUTS; j++) {
        frame_column(m, state, j / 3, unit[j % 3], column + j * size);
        if (j / 3 == 2) continue;
        vertex_variation l = {0}, r = {0}; // the root's motion strains the first segment
        if (j / 3 == 0) l.u = unit[j % 3];
        if (j / 3 == 1) l.w = bough_mat3_tmul(r0, unit[j % 3]);
        vertex_response(m, r1, segment_tangent(m, scratch->vertex, 0, &l, &r), column + j * size);
    }
}
