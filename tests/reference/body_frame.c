#include "tests/reference/body_frame.h"

#include "core/base/linalg.h"

#include <string.h>

enum { BLOCK = 36 };

bool bough_body_frame_init(bough_body_frame *b, bough_arena *arena, const bough_structure *s) {
    size_t n = (size_t)s->n_vertex, n_e = 6 * (n - 1);
    memset(b, 0, sizeof *b);
    b->structure = s;
    b->vertex = bough_arena_take(arena, n * sizeof *b->vertex);
    b->term = bough_arena_take(arena, n * sizeof *b->term);
    b->f_r = bough_arena_doubles(arena, BLOCK * n);
    b->f_e = bough_arena_doubles(arena, BLOCK * n);
    b->g = bough_arena_doubles(arena, 6 * n);
    b->mass = bough_arena_doubles(arena, BLOCK * n);
    b->force = bough_arena_doubles(arena, 6 * n);
    b->s = bough_arena_doubles(arena, 6 * n_e);
    b->m_e = bough_arena_doubles(arena, 6 * n_e);
    b->factor = bough_arena_doubles(arena, 6 * n_e);
    b->h_e = bough_arena_doubles(arena, n_e);
    return true;
}

// The vertex' place in v_E, −1 for the reference vertex.
static int slot_of(const bough_structure *s, int vertex) {
    if (vertex == s->reference) return -1;
    return vertex < s->reference ? vertex : vertex - 1;
}

// -- 6×6 blocks -----------------------------------------------------------------------------------

// y += sign · A x and y += sign · Aᵀx
static void add_product(const double *a, const double *x, double sign, double *y) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) y[i] += sign * a[6 * i + j] * x[j];
    }
}

static void add_transposed(const double *a, const double *x, double sign, double *y) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) y[i] += sign * a[6 * j + i] * x[j];
    }
}

// C += sign · Aᵀ B
static void add_transposed_block(const double *a, const double *b, double sign, double *c) {
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 6; k++) {
            for (int j = 0; j < 6; j++) c[6 * i + j] += sign * a[6 * k + i] * b[6 * k + j];
        }
    }
}

// C = A B
static void block_product(const double *a, const double *b, double *c) {
    memset(c, 0, BLOCK * sizeof *c);
    for (int i = 0; i < 6; i++) {
        for (int k = 0; k < 6; k++) {
            for (int j = 0; j < 6; j++) c[6 * i + j] += a[6 * i + k] * b[6 * k + j];
        }
    }
}

static void set_corner(double *block, int row, int column, bough_mat3 m) {
    const double values[9] = {m.c1.x, m.c2.x, m.c3.x, m.c1.y, m.c2.y, m.c3.y, m.c1.z, m.c2.z, m.c3.z};
    for (int k = 0; k < 9; k++) block[6 * (row + k / 3) + column + k % 3] = values[k];
}

// ξ(u) v = u × v
static bough_mat3 skew(bough_vec3 u) { return (bough_mat3){{0, u.z, -u.y}, {-u.z, 0, u.x}, {u.y, -u.x, 0}}; }

// -- kinematics -----------------------------------------------------------------------------------

// xₙ = x₀ + R₀x̂ₙ, Rₙ = R₀R̂ₙ, ωₙ = ω₀ + R₀ω̂ₙ and the velocity that follows.
void bough_body_frame_vertices(int n, const bough_transform *pose, bough_twist v_r,
                               const bough_relative_vertex *relative, bough_vertex *vertex) {
    bough_quaternion p0 = bough_quaternion_of_matrix(pose->rotation);
    for (int i = 0; i < n; i++) { // (13)
        const bough_relative_vertex *v = &relative[i];
        bough_mat3 r = bough_rotation_matrix(v->rotation);
        bough_vec3 velocity =
            bough_add(bough_add(v_r.linear, v->velocity), bough_cross(v_r.angular, v->position));
        vertex[i].position = bough_add(pose->position, bough_mat3_mul(pose->rotation, v->position));
        vertex[i].rotation = bough_quaternion_product(p0, v->rotation);
        vertex[i].velocity = bough_mat3_mul(pose->rotation, velocity);
        vertex[i].spin = bough_mat3_tmul(r, bough_add(v_r.angular, v->spin));
    }
}

void bough_body_frame_relative(int n, bough_twist v_r, const bough_vertex *vertex,
                               bough_relative_vertex *relative) {
    for (int i = 0; i < n; i++) {
        bough_mat3 r = bough_rotation_matrix(vertex[i].rotation);
        bough_vec3 carried = bough_add(v_r.linear, bough_cross(v_r.angular, vertex[i].position));
        relative[i].position = vertex[i].position;
        relative[i].rotation = vertex[i].rotation;
        relative[i].velocity = bough_sub(vertex[i].velocity, carried);
        relative[i].spin = bough_sub(bough_mat3_mul(r, vertex[i].spin), v_r.angular);
    }
}

// (14) of one vertex in BRF axes, Ω̇ₙ = R̂ₙᵀω̇ₙ:
//     F_R = [E, −ξ(x̂); 0, R̂ᵀ],  F_E = [E, 0; 0, R̂ᵀ],
//     G = (Ω₀×(Ω₀×x̂) + 2 Ω₀×x̂˙, R̂ᵀ(Ω₀×ω̂))
static void transformation(bough_body_frame *b, int i, bough_vec3 omega, const bough_relative_vertex *v) {
    bough_mat3 r = bough_rotation_matrix(v->rotation);
    double *f_r = b->f_r + (size_t)BLOCK * i, *f_e = b->f_e + (size_t)BLOCK * i;
    set_corner(f_r, 0, 0, bough_mat3_identity());
    set_corner(f_r, 0, 3, skew(bough_scale(-1, v->position)));
    set_corner(f_r, 3, 3, bough_mat3_transpose(r));
    bough_twist g = {bough_add(bough_cross(omega, bough_cross(omega, v->position)),
                               bough_scale(2, bough_cross(omega, v->velocity))),
                     bough_mat3_tmul(r, bough_cross(omega, v->spin))};
    bough_twist_store(g, b->g + (size_t)6 * i);
    if (i == b->structure->reference) return; // it has no v_E of its own
    set_corner(f_e, 0, 0, bough_mat3_identity());
    set_corner(f_e, 3, 3, bough_mat3_transpose(r));
}

// -- equations of motion --------------------------------------------------------------------------

static bool add_term(bough_body_frame *b, const bough_structure_term *term) {
    const bough_structure *s = b->structure;
    bool ok = term->force(s->self, b->vertex, b->term);
    for (int i = 0; i < s->n_vertex; i++) {
        double values[6];
        bough_wrench_store(b->term[i], values);
        for (int c = 0; c < 6; c++) b->force[6 * i + c] += values[c];
    }
    return ok;
}

// M and h of (11)
static bool newton_euler(bough_body_frame *b) {
    const bough_structure *s = b->structure;
    memset(b->force, 0, (size_t)6 * s->n_vertex * sizeof *b->force);
    s->ops->mass(s->self, b->vertex, b->mass);
    bool ok = add_term(b, &s->ops->elastic);
    ok = add_term(b, &s->ops->viscous) && ok;
    return add_term(b, &s->ops->inertial) && ok;
}

// (15): M = FᵀM_NE F, h = Fᵀ(h_NE − M_NE (G − g)); the weight is that of an acceleration −g.
static void project(bough_body_frame *b, bough_vec3 gravity) {
    const bough_structure *s = b->structure;
    const double weight[6] = {gravity.x, gravity.y, gravity.z, 0, 0, 0};
    memset(b->m_r, 0, sizeof b->m_r);
    memset(b->h_r, 0, sizeof b->h_r);
    for (int i = 0; i < s->n_vertex; i++) {
        const double *mass = b->mass + (size_t)BLOCK * i;
        const double *f_r = b->f_r + (size_t)BLOCK * i, *f_e = b->f_e + (size_t)BLOCK * i;
        double mf_r[BLOCK], mf_e[BLOCK], h[6];
        memcpy(h, b->force + (size_t)6 * i, sizeof h);
        add_product(mass, b->g + (size_t)6 * i, -1, h);
        add_product(mass, weight, 1, h);
        block_product(mass, f_r, mf_r);
        add_transposed_block(f_r, mf_r, 1, b->m_r);
        add_transposed(f_r, h, 1, b->h_r);
        int k = slot_of(s, i);
        if (k < 0) continue;
        block_product(mass, f_e, mf_e);
        add_transposed_block(f_e, mf_r, 1, b->s + (size_t)BLOCK * k);
        add_transposed_block(f_e, mf_e, 1, b->m_e + (size_t)BLOCK * k);
        add_transposed(f_e, h, 1, b->h_e + (size_t)6 * k);
    }
}

static void clear_flexible(bough_body_frame *b) {
    size_t n_e = (size_t)6 * (b->structure->n_vertex - 1);
    memset(b->s, 0, 6 * n_e * sizeof *b->s);
    memset(b->m_e, 0, 6 * n_e * sizeof *b->m_e);
    memset(b->h_e, 0, n_e * sizeof *b->h_e);
}

bool bough_body_frame_evaluate(bough_body_frame *b, const bough_frame_motion *motion,
                               const bough_relative_vertex *relative) {
    int n = b->structure->n_vertex;
    bough_transform here = bough_transform_identity();
    bough_body_frame_vertices(n, &here, motion->twist, relative, b->vertex);
    for (int i = 0; i < n; i++) transformation(b, i, motion->twist.angular, &relative[i]);
    bool ok = newton_euler(b);
    clear_flexible(b);
    project(b, motion->gravity);
    memcpy(b->factor, b->m_e, (size_t)BLOCK * (n - 1) * sizeof *b->factor);
    for (int k = 0; k < n - 1; k++) {
        ok = bough_cholesky_factor(6, b->factor + (size_t)BLOCK * k) && ok;
    }
    return ok;
}

// J_Rᵀ = F_Rᵀ J_NEᵀ and J_Eᵀ = F_Eᵀ J_NEᵀ, column by column.
int bough_body_frame_jacobian(const bough_body_frame *b, const bough_attachment *at, double *j_r,
                              double *j_e) {
    memset(j_r, 0, BLOCK * sizeof *j_r);
    memset(j_e, 0, BLOCK * sizeof *j_e);
    for (int j = 0; j < 6; j++) {
        double unit[6] = {0}, h[6], r[6] = {0}, e[6] = {0};
        unit[j] = 1;
        bough_wrench w = bough_wrench_load(unit);
        bough_wrench_store(bough_attachment_force(at, b->vertex, w), h);
        add_transposed(b->f_r + (size_t)BLOCK * at->vertex, h, 1, r);
        add_transposed(b->f_e + (size_t)BLOCK * at->vertex, h, 1, e);
        for (int i = 0; i < 6; i++) {
            j_r[6 * i + j] = r[i];
            j_e[6 * i + j] = e[i];
        }
    }
    return slot_of(b->structure, at->vertex);
}

void bough_body_frame_add_wrench(bough_body_frame *b, const bough_attachment *at, bough_wrench w) {
    double j_r[BLOCK], j_e[BLOCK], values[6];
    int k = bough_body_frame_jacobian(b, at, j_r, j_e);
    bough_wrench_store(w, values);
    add_product(j_r, values, 1, b->h_r);
    if (k >= 0) add_product(j_e, values, 1, b->h_e + (size_t)6 * k);
}

// -- solution -------------------------------------------------------------------------------------

// X = M_E⁻¹S of one vertex
static void eliminated(const double *factor, const double *s, double *x) {
    for (int j = 0; j < 6; j++) {
        double column[6];
        for (int i = 0; i < 6; i++) column[i] = s[6 * i + j];
        bough_cholesky_solve(6, factor, column);
        for (int i = 0; i < 6; i++) x[6 * i + j] = column[i];
    }
}

void bough_body_frame_reduce(const bough_body_frame *b, double *inertia, double *force) {
    memcpy(inertia, b->m_r, sizeof b->m_r);
    memcpy(force, b->h_r, sizeof b->h_r);
    for (int k = 0; k < b->structure->n_vertex - 1; k++) {
        const double *s = b->s + (size_t)BLOCK * k;
        double x[BLOCK];
        eliminated(b->factor + (size_t)BLOCK * k, s, x);
        add_transposed_block(s, x, -1, inertia);
        add_transposed(x, b->h_e + (size_t)6 * k, -1, force);
    }
}

void bough_body_frame_flexible(const bough_body_frame *b, const double *v_r_rate, double *v_e_rate) {
    for (int k = 0; k < b->structure->n_vertex - 1; k++) {
        double *rate = v_e_rate + (size_t)6 * k;
        memcpy(rate, b->h_e + (size_t)6 * k, 6 * sizeof *rate);
        add_product(b->s + (size_t)BLOCK * k, v_r_rate, -1, rate);
        bough_cholesky_solve(6, b->factor + (size_t)BLOCK * k, rate);
    }
}

void bough_body_frame_accelerations(const bough_body_frame *b, const double *v_r_rate, const double *v_e_rate,
                                    bough_twist *acceleration) {
    for (int i = 0; i < b->structure->n_vertex; i++) {
        double a[6];
        int k = slot_of(b->structure, i);
        memcpy(a, b->g + (size_t)6 * i, sizeof a);
        add_product(b->f_r + (size_t)BLOCK * i, v_r_rate, 1, a);
        if (k >= 0) add_product(b->f_e + (size_t)BLOCK * i, v_e_rate + (size_t)6 * k, 1, a);
        acceleration[i] = bough_twist_load(a);
    }
}
