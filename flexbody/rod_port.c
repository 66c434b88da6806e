// The rod's ports linearised: what the body frame's motion does to the rod, and the rod to its root.
#include "flexbody/rod_tangent.h"

#include "flexbody/rod_lanes.h"

#include <string.h>

// p⁻¹∘r: scalar ρ₀ and rotation ρ = 2·vector
static void to_tangent(bough_quaternion p, bough_quaternion r, double *scalar, bough_vec3 *vector) {
    bough_quaternion d = bough_quaternion_product(bough_quaternion_conjugate(p), r);
    double inverse = 1 / (p.w * p.w + p.x * p.x + p.y * p.y + p.z * p.z);
    *scalar = inverse * d.w;
    *vector = bough_scale(2 * inverse, bough_v3(d.x, d.y, d.z));
}

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
