#include "tests/reference/lumped.h"

#include <stddef.h>

// A column of a 6×6 row-major matrix.
static void store_column(double *m, int j, bough_vec3 upper, bough_vec3 lower) {
    const double values[6] = {upper.x, upper.y, upper.z, lower.x, lower.y, lower.z};
    for (int i = 0; i < 6; i++) m[6 * i + j] = values[i];
}

void bough_lumped_mass(const bough_lumped *b, const bough_vertex *vertex, double *mass) {
    const bough_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (int i = 0; i < b->n; i++) {
        const bough_inertia *v = &b->inertia[i];
        bough_mat3 r = bough_rotation_matrix(vertex[i].rotation);
        double *m = mass + (size_t)36 * i;
        for (int j = 0; j < 3; j++) {
            bough_vec3 e = unit[j];
            store_column(m, j, bough_scale(v->mass, e), bough_cross(v->first, bough_mat3_tmul(r, e)));
            store_column(m, 3 + j, bough_mat3_mul(r, bough_cross(e, v->first)),
                         bough_mat3_mul(v->rotational, e));
        }
    }
}

// δ(−R ξ(s) Ω̇) = R δφ×(Ω̇×s) and δ(ξ(s) Rᵀẍ) = −s×(δφ×Rᵀẍ)
void bough_lumped_mass_tangent(const bough_lumped *b, const bough_vertex *vertex,
                               const bough_vertex_change *change, const bough_twist *acceleration,
                               bough_wrench *product) {
    for (int i = 0; i < b->n; i++) {
        bough_vec3 s = b->inertia[i].first, turn = change[i].turn;
        bough_mat3 r = bough_rotation_matrix(vertex[i].rotation);
        bough_vec3 tangential = bough_cross(acceleration[i].angular, s);
        bough_vec3 linear = bough_mat3_tmul(r, acceleration[i].linear);
        product[i].force = bough_mat3_mul(r, bough_cross(turn, tangential));
        product[i].moment = bough_cross(bough_cross(turn, linear), s);
    }
}

void bough_lumped_inertial(const bough_lumped *b, const bough_vertex *vertex, bough_wrench *force) {
    for (int i = 0; i < b->n; i++) {
        const bough_inertia *v = &b->inertia[i];
        bough_mat3 r = bough_rotation_matrix(vertex[i].rotation);
        bough_vec3 w = vertex[i].spin;
        bough_vec3 centripetal = bough_cross(w, bough_cross(w, v->first));
        force[i].force = bough_mat3_mul(r, bough_scale(-1, centripetal));
        force[i].moment = bough_cross(bough_mat3_mul(v->rotational, w), w);
    }
}

void bough_lumped_inertial_tangent(const bough_lumped *b, const bough_vertex *vertex,
                                   const bough_vertex_change *change, bough_wrench *force_change) {
    for (int i = 0; i < b->n; i++) {
        const bough_inertia *v = &b->inertia[i];
        bough_mat3 r = bough_rotation_matrix(vertex[i].rotation);
        bough_vec3 w = vertex[i].spin, dw = change[i].spin, s = v->first;
        bough_vec3 centripetal = bough_cross(w, bough_cross(w, s));
        bough_vec3 varied = bough_add(bough_cross(dw, bough_cross(w, s)), bough_cross(w, bough_cross(dw, s)));
        varied = bough_add(varied, bough_cross(change[i].turn, centripetal));
        force_change[i].force = bough_mat3_mul(r, bough_scale(-1, varied));
        force_change[i].moment = bough_add(bough_cross(bough_mat3_mul(v->rotational, dw), w),
                                           bough_cross(bough_mat3_mul(v->rotational, w), dw));
    }
}
