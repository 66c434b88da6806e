#include "flexbody/rod_tangent.h"

#include "flexbody/rod_segment.h"

#include <string.h>

enum {
    FORCES = 9,      // f, left moment, right moment
    DIRECTIONS = 18, // Δx, φ left, φ right, Δu, W left, W right
    W8 = 8,
    VERTEX = 32,     // doubles kept per vertex: see the offsets
};

// What a vertex keeps from the linearisation for elimination and solution.
typedef struct vertex_kept {
    bough_quaternion p;    // as in the state, not normalised
    bough_mat3 r;
    bough_vec3 w, rtomega; // W and Rᵀω
} vertex_kept;

static vertex_kept *kept(const bough_rod_tangent *k, int i) {
    return (vertex_kept *)(void *)(k->vertex + (size_t)i * VERTEX);
}

static_assert(sizeof(vertex_kept) <= VERTEX * sizeof(double), "vertex record");

bool bough_rod_tangent_init(bough_rod_tangent *k, bough_arena *arena, const bough_rod_model *m) {
    size_t n = (size_t)m->n;
    k->variation = bough_arena_doubles(arena, FORCES * DIRECTIONS * (size_t)m->stride);
    bool ok = bough_block_tridiagonal_init(&k->position, arena, m->n);
    ok = bough_block_tridiagonal_init(&k->velocity, arena, m->n) && ok;
    ok = bough_block_tridiagonal_init(&k->matrix, arena, m->n) && ok;
    k->mass = bough_arena_doubles(arena, n * BOUGH_BLOCK);
    k->eliminate = bough_arena_doubles(arena, n * BOUGH_BLOCK);
    k->vertex = bough_arena_doubles(arena, n * VERTEX);
    k->work = bough_arena_doubles(arena, 4 * n * W8);
    return ok && !bough_arena_exhausted(arena);
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

// The unit variation of direction `k`: Δ of the right against the left vertex, then each rotation.
static void unit_variation(int k, vertex_variation *l, vertex_variation *r) {
    const bough_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    memset(l, 0, sizeof *l);
    memset(r, 0, sizeof *r);
    bough_vec3 *const part[6] = {&r->x, &l->phi, &r->phi, &r->u, &l->w, &r->w};
    *part[k / 3] = unit[k % 3];
}

// Configuration directions of segments first..last−1.
static void position_variations(const bough_rod_model *m, const double *vertex, int first, int last,
                                double *restrict out) {
    int s = m->stride;
    for (int k = 0; k < DIRECTIONS / 2; k++) {
        vertex_variation dl, dr;
        unit_variation(k, &dl, &dr);
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
    for (int k = DIRECTIONS / 2; k < DIRECTIONS; k++) {
        vertex_variation dl, dr;
        unit_variation(k, &dl, &dr);
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

// -- assembly -------------------------------------------------------------------------------------

// Adds to block ← sign · the 6×3 columns of directions k0.. for one side's forces.
// side 0: left vertex (f, ll); side 1: right vertex (−f, lr).
static inline void add_columns(double *restrict block, int column, const double *restrict t,
                               int stride, int side, double sign) {
    double linear = side == 0 ? sign : -sign;
    int moment = side == 0 ? 3 : 6;
    for (int k = 0; k < 3; k++) {
        const double *restrict d = t + (size_t)k * FORCES * stride;
        for (int i = 0; i < 3; i++) {
            block[W8 * i + column + k] += linear * d[i * stride];
            block[W8 * (3 + i) + column + k] += sign * d[(moment + i) * stride];
        }
    }
}

// One segment's tangents t (its three direction triples) into the blocks of its two vertices.
static void add_segment(bough_block_tridiagonal *b, int n, const double *t, int stride) {
    const double *delta = t, *left = t + (size_t)3 * FORCES * stride;
    const double *right = t + (size_t)6 * FORCES * stride;
    double *lower = b->lower + (size_t)n * BOUGH_BLOCK;
    double *diagonal = b->diagonal + (size_t)n * BOUGH_BLOCK;
    add_columns(lower, 0, delta, stride, 1, -1);
    add_columns(lower, 3, left, stride, 1, 1);
    add_columns(diagonal, 0, delta, stride, 1, 1);
    add_columns(diagonal, 3, right, stride, 1, 1);
    if (n == 0) return;
    double *upper = b->upper + (size_t)(n - 1) * BOUGH_BLOCK;
    add_columns(diagonal - BOUGH_BLOCK, 0, delta, stride, 0, -1);
    add_columns(diagonal - BOUGH_BLOCK, 3, left, stride, 0, 1);
    add_columns(upper, 0, delta, stride, 0, 1);
    add_columns(upper, 3, right, stride, 0, 1);
}

static void clear_blocks(bough_block_tridiagonal *b) {
    size_t bytes = (size_t)b->n * BOUGH_BLOCK * sizeof(double);
    memset(b->lower, 0, bytes);
    memset(b->diagonal, 0, bytes);
    memset(b->upper, 0, bytes);
}

static inline void add_column3(double *block, int row, int column, bough_vec3 v) {
    block[W8 * row + column] += v.x;
    block[W8 * (row + 1) + column] += v.y;
    block[W8 * (row + 2) + column] += v.z;
}

static bough_vec3 inertia_times(const double *j, bough_vec3 w) {
    return (bough_vec3){j[0] * w.x + j[3] * w.y + j[4] * w.z, j[3] * w.x + j[1] * w.y + j[5] * w.z,
                        j[4] * w.x + j[5] * w.y + j[2] * w.z};
}

// Terms of (11) at one vertex, linearised: mass block, and what its rotation, velocity and angular
// velocity change. `c` is the acceleration less gravity and `wdot` Ẇ, both in section axes.
static void add_vertex(const bough_rod_tangent *k, int i, const bough_vertex_inertia *v,
                       bough_vec3 c, bough_vec3 wdot, bough_vec3 load_moment) {
    const vertex_kept *a = kept(k, i);
    double *mass = k->mass + (size_t)i * BOUGH_BLOCK;
    double *position = k->position.diagonal + (size_t)i * BOUGH_BLOCK;
    double *velocity = k->velocity.diagonal + (size_t)i * BOUGH_BLOCK;
    bough_vec3 s = v->moment, w = a->w, iw = inertia_times(v->inertia, w);
    bough_vec3 shift = bough_add(bough_cross(wdot, s), bough_cross(w, bough_cross(w, s)));
    const bough_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    memset(mass, 0, BOUGH_BLOCK * sizeof *mass);
    for (int j = 0; j < 3; j++) {
        bough_vec3 e = unit[j];
        bough_vec3 turn = bough_cross(k->omega, e); // ω×δu
        add_column3(mass, 0, j, bough_scale(v->mass, e));
        add_column3(mass, 3, j, bough_cross(s, bough_mat3_tmul(a->r, e)));
        add_column3(mass, 0, 3 + j, bough_mat3_mul(a->r, bough_cross(e, s)));
        add_column3(mass, 3, 3 + j, inertia_times(v->inertia, e));
        add_column3(velocity, 0, j, bough_scale(-v->mass, turn));
        add_column3(velocity, 3, j, bough_cross(bough_mat3_tmul(a->r, turn), s));
        bough_vec3 centrifugal = bough_add(bough_cross(e, bough_cross(w, s)),
                                           bough_cross(w, bough_cross(e, s)));
        bough_vec3 gyroscopic = bough_add(bough_cross(e, iw),
                                          bough_cross(w, inertia_times(v->inertia, e)));
        add_column3(velocity, 0, 3 + j, bough_scale(-1, bough_mat3_mul(a->r, centrifugal)));
        add_column3(velocity, 3, 3 + j, bough_scale(-1, gyroscopic));
        add_column3(position, 0, 3 + j, bough_mat3_mul(a->r, bough_cross(shift, e)));
        add_column3(position, 3, 3 + j, bough_sub(bough_cross(load_moment, e),
                                                  bough_cross(s, bough_cross(c, e))));
    }
}

static void keep_vertices(const bough_rod_model *m, const double *state, bough_rod_tangent *k,
                          const double *vertex) {
    int n = m->n, s = m->stride;
    for (int i = 0; i < n; i++) {
        vertex_kept *a = kept(k, i);
        vertex_state v = load_vertex(vertex, s, i + 1);
        a->p = (bough_quaternion){state[3 * n + i], state[4 * n + i], state[5 * n + i],
                                  state[6 * n + i]};
        a->r = bough_rotation_matrix(v.p);
        a->w = v.w;
        a->rtomega = bough_mat3_tmul(a->r, k->omega);
    }
}

// Every vertex' own terms, from the accelerations `rate` (6 n: u̇, Ẇ).
static void add_vertices(const bough_rod_model *m, const double *input, const double *rate,
                         const bough_rod_scratch *scratch, bough_rod_tangent *k) {
    int n = m->n, s = m->stride;
    bough_vec3 gravity = {input[6], input[7], input[8]};
    for (int i = 0; i < n; i++) {
        const vertex_kept *a = kept(k, i);
        bough_vec3 u = load3(scratch->vertex + BOUGH_ROD_U * s, s, i + 1);
        bough_vec3 udot = load3(rate, n, i), wdot = load3(rate + 3 * n, n, i);
        bough_vec3 felt = bough_sub(bough_add(udot, bough_cross(k->omega, u)), gravity);
        bough_vec3 moment = load3(scratch->load + 3 * s, s, i + 1);
        add_vertex(k, i, &m->vertex[i + 1], bough_mat3_tmul(a->r, felt), wdot,
                   bough_mat3_tmul(a->r, moment));
    }
}

// Followers turn with their vertex: δ(R f) = R (δφ×f), and the moment in section axes stays, where
// add_vertices took it for a dead one.
static void add_followers(const bough_rod_model *m, const bough_rod_scratch *scratch,
                          bough_rod_tangent *k) {
    int s = m->stride;
    const bough_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < m->n; i++) {
        bough_mat3 r = kept(k, i)->r;
        double *position = k->position.diagonal + (size_t)i * BOUGH_BLOCK;
        bough_vec3 force = load3(scratch->follower, s, i + 1);
        bough_vec3 moment = load3(scratch->follower + 3 * s, s, i + 1);
        for (int j = 0; j < 3; j++) {
            add_column3(position, 0, 3 + j, bough_mat3_mul(r, bough_cross(unit[j], force)));
            add_column3(position, 3, 3 + j, bough_cross(unit[j], moment));
        }
    }
}

bool bough_rod_linearise(const bough_rod_model *m, const bough_rod_loads *loads, double t,
                         const double *state, const double *input, bough_rod_scratch *scratch,
                         bough_rod_tangent *k) {
    int n = m->n;
    double *rate = k->variation; // free until the variations are computed
    if (!bough_rod_derivative(m, loads, t, state, input, scratch, rate)) return false;
    k->omega = bough_v3(input[3], input[4], input[5]);
    clear_blocks(&k->position);
    clear_blocks(&k->velocity);
    keep_vertices(m, state, k, scratch->vertex);
    add_vertices(m, input, rate + (size_t)BOUGH_ROD_U * n, scratch, k);
    if (bough_rod_loads_follow(loads)) add_followers(m, scratch, k);
    position_variations(m, scratch->vertex, 0, n, k->variation);
    velocity_variations(m, scratch->vertex, 0, n, k->variation);
    for (int i = 0; i < n; i++) {
        const double *t0 = k->variation + i;
        add_segment(&k->position, i, t0, m->stride);
        add_segment(&k->velocity, i, t0 + (size_t)(DIRECTIONS / 2) * FORCES * m->stride, m->stride);
    }
    return true;
}

// -- factorisation --------------------------------------------------------------------------------

// (E + ξ(a))⁻¹ y = (y + a (a·y) − a×y)/(1 + |a|²)
static bough_vec3 solve_cross(bough_vec3 a, bough_vec3 y) {
    bough_vec3 sum = bough_axpy(bough_dot(a, y), a, bough_sub(y, bough_cross(a, y)));
    return bough_scale(1 / (1 + bough_dot(a, a)), sum);
}

// The norm's restoring term κ(1 − |p|²)p, linearised: δφ sees γκ(1 − |p|²), the scale of p also
// −2γκ|p|².
typedef struct norm_terms {
    double turn, scale; // factors of δφ and of σ on the left-hand side
} norm_terms;

static norm_terms restoring(bough_quaternion p, double gamma) {
    double square = p.w * p.w + p.x * p.x + p.y * p.y + p.z * p.z;
    double turn = 1 - gamma * BOUGH_ROD_NORM_RATE * (1 - square);
    return (norm_terms){turn, turn + 2 * gamma * BOUGH_ROD_NORM_RATE * square};
}

// A of one vertex: δx = (E + γξ(ω))⁻¹ …, δφ = (eE + ξ(a) + qqᵀ)⁻¹ … with a = ½γ(W + Rᵀω) and
// q = ½γ(W − Rᵀω), by Sherman–Morrison; e and the weight of qqᵀ from the norm's restoring.
static void elimination(const vertex_kept *v, bough_vec3 omega, double gamma, double *block) {
    bough_vec3 g = bough_scale(gamma, omega);
    norm_terms e = restoring(v->p, gamma);
    bough_vec3 a = bough_scale(0.5 * gamma / e.turn, bough_add(v->w, v->rtomega));
    bough_vec3 q = bough_scale(0.5 * gamma, bough_sub(v->w, v->rtomega));
    bough_vec3 bq = bough_scale(1 / e.turn, solve_cross(a, q));
    double denominator = e.scale + bough_dot(q, bq);
    const bough_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int j = 0; j < W8 * 6; j++) block[j] = 0;
    for (int j = 0; j < 3; j++) {
        bough_vec3 b = bough_scale(1 / e.turn, solve_cross(a, unit[j]));
        add_column3(block, 0, j, solve_cross(g, unit[j]));
        add_column3(block, 3, 3 + j, bough_axpy(-bough_dot(q, b) / denominator, bq, b));
    }
}

// to = base − γ(velocity + γ position·A)
static inline void newton_block(const double *restrict base, const double *restrict velocity,
                                const double *restrict position_a, double gamma,
                                double *restrict to) {
#pragma omp simd
    for (int j = 0; j < BOUGH_BLOCK; j++) {
        double tangent = velocity[j] + gamma * position_a[j];
        to[j] = (base == NULL ? 0 : base[j]) - gamma * tangent;
    }
}

bool bough_rod_factor(const bough_rod_model *m, bough_rod_tangent *k, double gamma) {
    int n = m->n;
    k->gamma = gamma;
    for (int i = 0; i < n; i++) {
        elimination(kept(k, i), k->omega, gamma, k->eliminate + (size_t)i * BOUGH_BLOCK);
    }
    for (int i = 0; i < n; i++) {
        double product[BOUGH_BLOCK];
        size_t at = (size_t)i * BOUGH_BLOCK;
        const double *a = k->eliminate + at;
        bough_block_product(k->position.diagonal + at, a, product);
        newton_block(k->mass + at, k->velocity.diagonal + at, product, gamma,
                     k->matrix.diagonal + at);
        if (i > 0) {
            bough_block_product(k->position.lower + at, a - BOUGH_BLOCK, product);
            newton_block(NULL, k->velocity.lower + at, product, gamma, k->matrix.lower + at);
        }
        if (i < n - 1) {
            bough_block_product(k->position.upper + at, a + BOUGH_BLOCK, product);
            newton_block(NULL, k->velocity.upper + at, product, gamma, k->matrix.upper + at);
        }
    }
    return bough_block_tridiagonal_factor(&k->matrix);
}

// -- solution -------------------------------------------------------------------------------------

// p⁻¹∘r: scalar ρ₀ and rotation ρ = 2·vector
static void to_tangent(bough_quaternion p, bough_quaternion r, double *scalar, bough_vec3 *vector) {
    bough_quaternion d = bough_quaternion_product(bough_quaternion_conjugate(p), r);
    double inverse = 1 / (p.w * p.w + p.x * p.x + p.y * p.y + p.z * p.z);
    *scalar = inverse * d.w;
    *vector = bough_scale(2 * inverse, bough_v3(d.x, d.y, d.z));
}

// Configuration residuals into tangent coordinates: q0 (n × 8) = −A r_q, ρ₀ kept in column 6.
static void eliminate_residual(const bough_rod_model *m, const bough_rod_tangent *k,
                               const double *x, double *q0) {
    int n = m->n;
    for (int i = 0; i < n; i++) {
        const vertex_kept *v = kept(k, i);
        double *q = q0 + (size_t)W8 * i;
        double scalar;
        bough_vec3 rho;
        bough_quaternion r = {x[3 * n + i], x[4 * n + i], x[5 * n + i], x[6 * n + i]};
        to_tangent(v->p, r, &scalar, &rho);
        double scale = restoring(v->p, k->gamma).scale;
        rho = bough_axpy(k->gamma * scalar / scale, bough_sub(v->w, v->rtomega), rho);
        const double residual[W8] = {x[i], x[n + i], x[2 * n + i], rho.x, rho.y, rho.z, 0, 0};
        for (int c = 0; c < 6; c++) q[c] = 0;
        bough_block_subtract(k->eliminate + (size_t)i * BOUGH_BLOCK, residual, q);
        q[6] = scalar;
    }
}

// rhs = M r_v + γ K A r_q
static void velocity_residual(const bough_rod_model *m, const bough_rod_tangent *k, const double *x,
                              const double *q0, double *rhs) {
    int n = m->n;
    const double *r = x + (size_t)BOUGH_ROD_U * n;
    for (int i = 0; i < n; i++) {
        double *row = rhs + (size_t)W8 * i;
        const double minus[W8] = {-r[i],         -r[n + i],     -r[2 * n + i], -r[3 * n + i],
                                  -r[4 * n + i], -r[5 * n + i], 0,             0};
        for (int c = 0; c < W8; c++) row[c] = 0;
        bough_block_subtract(k->mass + (size_t)i * BOUGH_BLOCK, minus, row);
    }
    double *scaled = k->work + (size_t)2 * W8 * n;
    for (int c = 0; c < W8 * n; c++) scaled[c] = k->gamma * q0[c];
    bough_block_tridiagonal_subtract(&k->position, scaled, rhs);
}

// Velocities and recovered configuration back into the state's layout.
static void recover(const bough_rod_model *m, const bough_rod_tangent *k, const double *q0,
                    const double *dv, double *x) {
    int n = m->n;
    for (int i = 0; i < n; i++) {
        const vertex_kept *v = kept(k, i);
        const double *velocity = dv + (size_t)W8 * i, *q = q0 + (size_t)W8 * i;
        double minus[W8] = {0}, d[W8];
        for (int c = 0; c < 6; c++) minus[c] = -k->gamma * velocity[c];
        for (int c = 0; c < 6; c++) d[c] = -q[c];
        bough_block_subtract(k->eliminate + (size_t)i * BOUGH_BLOCK, minus, d);
        bough_vec3 phi = {d[3], d[4], d[5]};
        double scalar = q[6] - 0.25 * k->gamma * bough_dot(bough_sub(v->w, v->rtomega), phi);
        scalar /= restoring(v->p, k->gamma).scale;
        bough_quaternion step = {scalar, 0.5 * phi.x, 0.5 * phi.y, 0.5 * phi.z};
        bough_quaternion dp = bough_quaternion_product(v->p, step);
        const double values[BOUGH_ROD_STATES] = {
            d[0], d[1], d[2], dp.w, dp.x, dp.y, dp.z, velocity[0], velocity[1], velocity[2],
            velocity[3], velocity[4], velocity[5]};
        for (int c = 0; c < BOUGH_ROD_STATES; c++) x[c * n + i] = values[c];
    }
}

void bough_rod_solve(const bough_rod_model *m, bough_rod_tangent *k, double *x) {
    double *q0 = k->work, *rhs = k->work + (size_t)W8 * m->n;
    eliminate_residual(m, k, x, q0);
    velocity_residual(m, k, x, q0, rhs);
    bough_block_tridiagonal_solve(&k->matrix, rhs);
    recover(m, k, q0, rhs, x);
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
