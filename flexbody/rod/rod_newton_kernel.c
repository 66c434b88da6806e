// Newton's matrix of the rod: elimination of the kinematic rows, factors, solution.
#include "flexbody/rod/rod_lanes.h"
#include "flexbody/rod/rod_tangent.h"
#include "flexbody/rod/rod_tangent_layout.h"

// (E + ξ(a))⁻¹ y = (y + a (a·y) − a×y)/(1 + |a|²)
BOUGH_INLINE bough_vec3 solve_cross(bough_vec3 a, bough_vec3 y) {
    bough_vec3 sum = bough_axpy(bough_dot(a, y), a, bough_sub(y, bough_cross(a, y)));
    return bough_scale(1 / (1 + bough_dot(a, a)), sum);
}

// -- elimination and factorisation ----------------------------------------------------------------

// theory (25): A_φ = (eE + ξ(a) + qqᵀ/f)⁻¹ of every vertex, a = ½γ(W + Rᵀω), q = ½γ(W − Rᵀω), by
// Sherman–Morrison; e and f are 1 but for the norm's restoring κ(1 − |p|²)p, linearised.
static void eliminate_rotations(const bough_rod_model *m, bough_rod_tangent *k) {
    int n = m->n, s = m->stride;
    double gamma = k->gamma;
    double *restrict kept = k->vertex;
#pragma omp simd
    for (int v = 1; v <= n; v++) {
        bough_vec3 w = lane_load(kept + KEPT_W * s, s, v), o = lane_load(kept + KEPT_OMEGA * s, s, v);
        bough_vec3 vector = lane_load(kept + (KEPT_P + 1) * s, s, v);
        double scalar = kept[KEPT_P * s + v];
        double square = scalar * scalar + bough_dot(vector, vector);
        // e and f from the length of the quaternion
        double e = 1 - gamma * BOUGH_ROD_NORM_RATE * (1 - square);
        double f = e + 2 * gamma * BOUGH_ROD_NORM_RATE * square;
        // the update of rank one: bq = (eE + ξ(a))⁻¹q
        bough_vec3 a = bough_scale(0.5 * gamma / e, bough_add(w, o));
        bough_vec3 q = bough_scale(0.5 * gamma, bough_sub(w, o));
        bough_vec3 bq = bough_scale(1 / e, solve_cross(a, q));
        double weight = 1 / (f + bough_dot(q, bq));
        // columns of A_φ
        for (int j = 0; j < 3; j++) {
            bough_vec3 b = bough_scale(1 / e, solve_cross(a, bough_unit3(j)));
            b = bough_axpy(-weight * bough_dot(q, b), bq, b);
            lane_store(kept + (KEPT_TURN + 3 * j) * s, s, v, b);
        }
        kept[KEPT_SCALE * s + v] = 1 / f;
    }
}

// Column j of γ² A of a vertex has entries in three rows only: of shifts in 0..2, the same for all
// vertices, of rotations in 3..5.
typedef struct elimination {
    double shift[3][3]; // by columns
    const double *turn; // entry (i, k) of A_φ at [(3 k + i)·stride]
    int stride;
    double square; // γ²
} elimination;

// Column j of mass − γ Dᵥ − γ² K A for one block; the mass is NULL off the diagonal.
BOUGH_INLINE void form_column(const elimination *e, int v, int j, const double *position,
                              const double *velocity, const double *mass, double gamma,
                              double *restrict out) {
    const double *restrict k = position + (j < 3 ? 0 : BOUGH_COLUMN * 3);
    double a[3];
    for (int i = 0; i < 3; i++) {
        a[i] = j < 3 ? e->shift[j][i] : e->square * e->turn[(3 * (j - 3) + i) * e->stride + v];
    }
#pragma omp simd
    for (int i = 0; i < BOUGH_COLUMN; i++) {
        double sum = k[i] * a[0] + k[BOUGH_COLUMN + i] * a[1] + k[2 * BOUGH_COLUMN + i] * a[2];
        out[i] = (mass == NULL ? 0 : mass[i]) - gamma * velocity[i] - sum;
    }
}

BOUGH_INLINE void form_block(const elimination *e, int v, const double *position, const double *velocity,
                             const double *mass, double gamma, double *out) {
    for (int j = 0; j < 6; j++) {
        form_column(e, v, j, position, velocity + BOUGH_COLUMN * j,
                    mass == NULL ? NULL : mass + BOUGH_COLUMN * j, gamma, out + BOUGH_COLUMN * j);
    }
}

// M − γ(Dᵥ + γ K A): the columns of a block belong to the vertex on whose variation it acts.
static void form_matrix(const bough_rod_model *m, bough_rod_tangent *k) {
    const bough_block_tridiagonal *p = &k->blocks.position, *d = &k->blocks.velocity;
    double g = k->gamma;
    elimination e = {.turn = k->vertex + (size_t)KEPT_TURN * m->stride, .stride = m->stride, .square = g * g};
    for (int j = 0; j < 3; j++) {
        bough_vec3 column = solve_cross(bough_scale(g, k->omega), bough_unit3(j));
        e.shift[j][0] = e.square * column.x;
        e.shift[j][1] = e.square * column.y;
        e.shift[j][2] = e.square * column.z;
    }
    for (int v = 1; v <= m->n; v++) {
        size_t at = (size_t)(v - 1) * BOUGH_BLOCK, next = at + BOUGH_BLOCK;
        form_block(&e, v, p->diagonal + at, d->diagonal + at, k->blocks.mass + at, g,
                   k->matrix.diagonal + at);
        if (v == m->n) break;
        form_block(&e, v + 1, p->upper + at, d->upper + at, NULL, g, k->matrix.upper + at);
        form_block(&e, v, p->lower + next, d->lower + next, NULL, g, k->matrix.lower + next);
    }
}

bool AT(factor)(const bough_rod_model *m, bough_rod_tangent *k, double gamma) {
    k->gamma = gamma;
    eliminate_rotations(m, k);
    form_matrix(m, k);
    return BOUGH_AT_LEVEL(bough_block_tridiagonal_factor)(&k->matrix);
}

// -- solution -------------------------------------------------------------------------------------

// A r_q of `count` vertices from the first on and the scalar part of the quaternion residual p⁻¹∘r.
BOUGH_INLINE void eliminate_residual(const bough_rod_model *m, const bough_rod_tangent *k,
                                     const double *restrict x, int from, int count, double *restrict q) {
    int n = m->n, s = m->stride;
    const double *restrict kept = k->vertex, *restrict turn = kept + KEPT_TURN * s;
    bough_vec3 g = bough_scale(k->gamma, k->omega);
    double gamma = k->gamma;
#pragma omp simd
    for (int v = from; v < from + count; v++) {
        bough_vec3 rx = lane_load(x, n, v - 1), rp = lane_load(x + 4 * n, n, v - 1);
        bough_vec3 p = lane_load(kept + (KEPT_P + 1) * s, s, v);
        double rw = x[3 * n + v - 1], pw = kept[KEPT_P * s + v];
        // p⁻¹∘r: scalar part, and twice the vector part, a rotation
        double inverse = 1 / (pw * pw + bough_dot(p, p));
        double scalar = inverse * (pw * rw + bough_dot(p, rp));
        bough_vec3 rho = bough_axpy(pw, rp, bough_axpy(-rw, p, bough_cross(rp, p)));
        rho = bough_scale(2 * inverse, rho);
        // the scalar part eliminated, then A_x r_x and A_φ ρ
        bough_vec3 slip =
            bough_sub(lane_load(kept + KEPT_W * s, s, v), lane_load(kept + KEPT_OMEGA * s, s, v));
        rho = bough_axpy(gamma * scalar * kept[KEPT_SCALE * s + v], slip, rho);
        lane_store(q, s, v, solve_cross(g, rx));
        lane_store(q + 3 * s, s, v, bough_mat3_mul(lane_load_matrix(turn, s, v), rho));
        q[WORK_SCALAR * s + v] = scalar;
    }
}

// A r_q of the ends of eight segments, a row for each direction of their tangents.
BOUGH_INLINE void gather_directions(const double *restrict q, int s, double *restrict d) {
    for (int i = 0; i < 3; i++) {
#pragma omp simd
        for (int l = 0; l < LANES; l++) {
            d[(DELTA + i) * LANES + l] = q[i * s + l + 1] - q[i * s + l];
            d[(LEFT + i) * LANES + l] = q[(3 + i) * s + l];
            d[(RIGHT + i) * LANES + l] = q[(3 + i) * s + l + 1];
        }
    }
}

// γ K A r_q of every segment.
static void segment_residual(const bough_rod_model *m, const bough_rod_tangent *k, const double *restrict q,
                             double *restrict force) {
    int s = m->stride;
    double gamma = k->gamma;
    for (int first = 0; first < m->n_segment; first += LANES) {
        _Alignas(64) double d[DIRECTIONS * LANES];
        gather_directions(q + first, s, d);
        for (int f = 0; f < FORCES; f++) {
            const double *restrict t =
                k->variation + (size_t)TANGENTS * first + (size_t)LANES * DIRECTIONS * f;
            double *restrict out = force + f * s + first;
#define TERM(j) t[LANES * (j) + l] * d[LANES * (j) + l]
#pragma omp simd
            for (int l = 0; l < LANES; l++) {
                out[l] = gamma * ((TERM(0) + TERM(1) + TERM(2)) + (TERM(3) + TERM(4) + TERM(5)) +
                                  (TERM(6) + TERM(7) + TERM(8)));
            }
#undef TERM
        }
    }
}

// M r_v + γ K A r_q of `count` vertices; M as in the tangent, but from its few numbers.
BOUGH_INLINE void velocity_residual(const bough_rod_model *m, const bough_rod_tangent *k,
                                    const double *restrict x, int from, int count, double *restrict work) {
    int n = m->n, s = m->stride;
    const double *restrict kept = k->vertex, *restrict own = k->local_position;
    const double *restrict mass = m->mass, *restrict first = m->moment;
    const double *restrict inertia = m->inertia, *restrict force = k->force;
    double *restrict out = work + WORK_VELOCITY * s;
    double gamma = k->gamma;
#pragma omp simd
    for (int v = from; v < from + count; v++) {
        bough_mat3 r = lane_load_matrix(kept + KEPT_R * s, s, v);
        bough_vec3 ru = lane_load(x + 7 * n, n, v - 1), rw = lane_load(x + 10 * n, n, v - 1);
        bough_vec3 offset = lane_load(first, s, v - 1), phi = lane_load(work + (WORK_Q + 3) * s, s, v);
        phi = bough_scale(gamma, phi);
        // M r_v
        bough_vec3 f = bough_axpy(mass[v - 1], ru, bough_mat3_mul(r, bough_cross(rw, offset)));
        bough_vec3 l =
            bough_add(bough_cross(offset, bough_mat3_tmul(r, ru)), inertia_times(inertia, s, v - 1, rw));
        // γ K A r_q of the segments on both sides, then of the vertex' own terms
        bough_vec3 pull = bough_sub(lane_load(force, s, v), lane_load(force, s, v - 1));
        bough_vec3 turn = bough_add(lane_load(force + 3 * s, s, v), lane_load(force + 6 * s, s, v - 1));
        f = bough_add(f, bough_axpy(phi.x, lane_load(own, s, v), pull));
        f = bough_axpy(phi.y, lane_load(own + 6 * s, s, v), f);
        f = bough_axpy(phi.z, lane_load(own + 12 * s, s, v), f);
        l = bough_add(l, bough_axpy(phi.x, lane_load(own + 3 * s, s, v), turn));
        l = bough_axpy(phi.y, lane_load(own + 9 * s, s, v), l);
        l = bough_axpy(phi.z, lane_load(own + 15 * s, s, v), l);
        lane_store(out, s, v, f);
        lane_store(out + 3 * s, s, v, l);
    }
}

// The block solver's rows, one per vertex, from eight arrays over the vertices, and back.
static void pack(int n, int s, const double *velocity, double *packed) {
    for (int v = 1; v <= n; v += LANES)
        turn_tile(velocity + v, s, packed + BOUGH_COLUMN * (v - 1), BOUGH_COLUMN);
}

static void unpack(int n, int s, const double *packed, double *velocity) {
    for (int v = 1; v <= n; v += LANES)
        turn_tile(packed + BOUGH_COLUMN * (v - 1), BOUGH_COLUMN, velocity + v, s);
}

// Velocities and the configuration that belongs to them back into the state's layout.
BOUGH_INLINE void recover(const bough_rod_model *m, const bough_rod_tangent *k, const double *restrict q,
                          int from, int count, double *restrict x) {
    int n = m->n, s = m->stride;
    const double *restrict velocity = q + WORK_VELOCITY * s;
    const double *restrict kept = k->vertex, *restrict turn = kept + KEPT_TURN * s;
    bough_vec3 g = bough_scale(k->gamma, k->omega);
    double gamma = k->gamma;
#pragma omp simd
    for (int v = from; v < from + count; v++) {
        int i = v - 1;
        bough_vec3 du = lane_load(velocity, s, v), rate = lane_load(velocity + 3 * s, s, v);
        bough_vec3 dw = bough_scale(gamma, rate);
        // δx = A_x (r_x + γ δu)
        bough_vec3 shift = solve_cross(g, bough_scale(gamma, du));
        lane_store(x, n, i, bough_add(lane_load(q, s, v), shift));
        // δφ = A_φ (ρ + γ δW)
        bough_vec3 phi = bough_mat3_mul(lane_load_matrix(turn, s, v), dw);
        phi = bough_add(phi, lane_load(q + 3 * s, s, v));
        bough_vec3 slip =
            bough_sub(lane_load(kept + KEPT_W * s, s, v), lane_load(kept + KEPT_OMEGA * s, s, v));
        // δp from its scalar part and δφ/2
        double scalar = q[WORK_SCALAR * s + v] - 0.25 * gamma * bough_dot(slip, phi);
        scalar *= kept[KEPT_SCALE * s + v];
        bough_vec3 p = lane_load(kept + (KEPT_P + 1) * s, s, v), half = bough_scale(0.5, phi);
        double pw = kept[KEPT_P * s + v];
        x[3 * n + i] = pw * scalar - bough_dot(p, half);
        bough_vec3 vector = bough_axpy(pw, half, bough_axpy(scalar, p, bough_cross(p, half)));
        lane_store(x + 4 * n, n, i, vector);
        lane_store(x + 7 * n, n, i, du);
        lane_store(x + 10 * n, n, i, rate);
    }
}

void AT(solve)(const bough_rod_model *m, bough_rod_tangent *k, double *x) {
    double *velocity = k->work + (size_t)WORK_VELOCITY * m->stride;
    // M r_v + γ K A r_q
    FOR_VECTORS(1, m->n, eliminate_residual(m, k, x, v, count, k->work));
    segment_residual(m, k, k->work, k->force);
    FOR_VECTORS(1, m->n, velocity_residual(m, k, x, v, count, k->work));
    // the block-tridiagonal system in the velocities
    pack(m->n, m->stride, velocity, k->packed);
    BOUGH_AT_LEVEL(bough_block_tridiagonal_solve)(&k->matrix, k->packed);
    unpack(m->n, m->stride, k->packed, velocity);
    // the configuration
    FOR_VECTORS(1, m->n, recover(m, k, k->work, v, count, x));
}
