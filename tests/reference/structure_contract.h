// What every structure must fulfil by itself (structure.h), checked at a strongly
// deformed, moving state. body_frame_contract.h goes on with its equations in the body reference
// frame.
#ifndef BOUGH_TESTS_REFERENCE_STRUCTURE_CONTRACT_H
#define BOUGH_TESTS_REFERENCE_STRUCTURE_CONTRACT_H

#include "core/base/linalg.h"
#include "tests/reference/body_frame.h"
#include "tests/unit/check.h"

#include <string.h>

enum { STRUCTURE_MAX = 12 }; // vertices

typedef struct structure_case {
    const bough_structure *structure;
    const bough_inertia *inertia; // of each vertex in its axes: what M must amount to
    bough_transform pose;         // of the BRF in the ground
    bough_frame_motion motion;    // gravity in BRF axes
    bough_relative_vertex relative[STRUCTURE_MAX];
} structure_case;

// -- small tools ----------------------------------------------------------------------------------

// Reproducible numbers in [−1, 1] without a pattern.
static inline double structure_number(int *at) {
    *at += 1;
    return sin(12.9898 * *at + 0.7 * sin(78.233 * *at));
}

static inline bough_vec3 structure_vector(int *at, double size) {
    double x = structure_number(at), y = structure_number(at), z = structure_number(at);
    return bough_scale(size, bough_v3(x, y, z));
}

static inline void structure_near(const void *value, const void *expected, int n, double tolerance,
                                  const char *what) {
    const double *a = value, *b = expected;
    double largest = 1e-30;
    for (int i = 0; i < n; i++) largest = fmax(largest, fabs(b[i]));
    for (int i = 0; i < n; i++) {
        if (fabs(a[i] - b[i]) <= tolerance * largest) continue;
        fail_msg("%s[%d] = %.12g, expected %.12g (largest %.3g)", what, i, a[i], b[i], largest);
    }
}

static inline void structure_small(const void *value, int n, double allowed, const char *what) {
    const double *a = value;
    for (int i = 0; i < n; i++) {
        if (!(fabs(a[i]) <= allowed)) fail_msg("%s[%d] = %.3g, expected 0", what, i, a[i]);
    }
}

// y += A x for a 6×6 row-major block
static inline void structure_multiply(const double *a, const double *x, double *y) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) y[i] += a[6 * i + j] * x[j];
    }
}

// A case of the structure, deformed about its rest by up to `size` [m, rad].
static inline structure_case structure_case_at(const bough_structure *s, const bough_inertia *inertia,
                                               double size) {
    int at = 0;
    structure_case c = {.structure = s, .inertia = inertia};
    assert_true(s->n_vertex <= STRUCTURE_MAX);
    c.pose.position = bough_v3(3, -2, 5);
    c.pose.rotation = bough_rotation_matrix(bough_quaternion_exponential(bough_v3(0.7, -1.1, 0.4)));
    c.motion = (bough_frame_motion){{{0.4, -0.3, 0.7}, {0.5, -0.8, 0.6}}, {1, -2, -9}};
    for (int i = 0; i < s->n_vertex; i++) {
        const bough_vertex *v = &s->rest[i];
        bough_quaternion turn = bough_quaternion_exponential(structure_vector(&at, size));
        c.relative[i].position = bough_add(v->position, structure_vector(&at, size));
        c.relative[i].rotation = bough_quaternion_product(v->rotation, turn);
        c.relative[i].velocity = structure_vector(&at, 0.8);
        c.relative[i].spin = structure_vector(&at, 0.8);
    }
    const bough_vertex *r = &s->rest[s->reference];
    c.relative[s->reference] = (bough_relative_vertex){.position = r->position, .rotation = r->rotation};
    return c;
}

// The case's vertices in the ground.
static inline void structure_vertices(const structure_case *c, bough_vertex *vertex) {
    bough_body_frame_vertices(c->structure->n_vertex, &c->pose, c->motion.twist, c->relative, vertex);
}

static inline void structure_change(int n, int seed, bough_vertex_change *change) {
    int at = 100 * seed;
    for (int i = 0; i < n; i++) {
        change[i].position = structure_vector(&at, 1);
        change[i].turn = structure_vector(&at, 1);
        change[i].velocity = structure_vector(&at, 1);
        change[i].spin = structure_vector(&at, 1);
    }
}

static inline void structure_shift(int n, const bough_vertex *vertex, double step,
                                   const bough_vertex_change *change, bough_vertex *shifted) {
    for (int i = 0; i < n; i++) {
        bough_quaternion turn = bough_quaternion_exponential(bough_scale(step, change[i].turn));
        shifted[i].position = bough_axpy(step, change[i].position, vertex[i].position);
        shifted[i].rotation = bough_quaternion_product(vertex[i].rotation, turn);
        shifted[i].velocity = bough_axpy(step, change[i].velocity, vertex[i].velocity);
        shifted[i].spin = bough_axpy(step, change[i].spin, vertex[i].spin);
    }
}

// Power of generalised forces; with a change's (position, turn) their virtual work.
static inline double structure_power(int n, const bough_wrench *force, const bough_vertex *vertex) {
    double power = 0;
    for (int i = 0; i < n; i++) {
        power += bough_power((bough_twist){vertex[i].velocity, vertex[i].spin}, force[i]);
    }
    return power;
}

// Sum of generalised forces (or momenta) as one wrench about the frame's origin.
static inline bough_wrench structure_sum(int n, const bough_vertex *vertex, const bough_wrench *force) {
    bough_wrench sum = {{0, 0, 0}, {0, 0, 0}};
    for (int i = 0; i < n; i++) {
        bough_mat3 r = bough_rotation_matrix(vertex[i].rotation);
        bough_wrench one = {force[i].force, bough_add(bough_mat3_mul(r, force[i].moment),
                                                      bough_cross(vertex[i].position, force[i].force))};
        sum = bough_wrench_add(sum, one);
    }
    return sum;
}

// M a for accelerations a, or momenta for velocities
static inline void structure_mass_times(const bough_structure *s, const bough_vertex *vertex,
                                        const bough_twist *a, bough_wrench *product) {
    double mass[36 * STRUCTURE_MAX];
    s->ops->mass(s->self, vertex, mass);
    for (int i = 0; i < s->n_vertex; i++) {
        double x[6], y[6] = {0};
        bough_twist_store(a[i], x);
        structure_multiply(mass + 36 * i, x, y);
        product[i] = bough_wrench_load(y);
    }
}

// -- the structure's own terms --------------------------------------------------------------------

// Elastic forces are minus the gradient of the energy; a relaxed structure has none.
static inline void structure_check_gradient(const structure_case *c) {
    const bough_structure *s = c->structure;
    bough_vertex vertex[STRUCTURE_MAX], shifted[STRUCTURE_MAX];
    bough_wrench force[STRUCTURE_MAX];
    double gradient[6 * STRUCTURE_MAX], values[6 * STRUCTURE_MAX];
    const double step = 1e-6;
    structure_vertices(c, vertex);
    assert_true(s->ops->elastic.force(s->self, vertex, force));
    for (int k = 0; k < 6 * s->n_vertex; k++) {
        bough_vertex_change change[STRUCTURE_MAX] = {0};
        const bough_vec3 e = {k % 3 == 0, k % 3 == 1, k % 3 == 2};
        *(k % 6 < 3 ? &change[k / 6].position : &change[k / 6].turn) = e;
        structure_shift(s->n_vertex, vertex, -step, change, shifted);
        double back = s->ops->elastic_energy(s->self, shifted);
        structure_shift(s->n_vertex, vertex, step, change, shifted);
        gradient[k] = -(s->ops->elastic_energy(s->self, shifted) - back) / (2 * step);
    }
    for (int i = 0; i < s->n_vertex; i++) bough_wrench_store(force[i], values + 6 * i);
    structure_near(values, gradient, 6 * s->n_vertex, 1e-7, "elastic force");
    assert_true(s->ops->elastic.force(s->self, s->rest, force));
    structure_small(force, 6 * s->n_vertex, 1e-11, "elastic force at rest");
    check_near(s->ops->elastic_energy(s->self, s->rest), 0, 0, 1e-20);
}

// Elastic and viscous forces are inner ones: without resultant, and the same seen from the ground
// with the BRF's motion as from the BRF at rest.
static inline void structure_check_inner(const structure_case *c, const bough_structure_term *term) {
    const bough_structure *s = c->structure;
    bough_vertex vertex[STRUCTURE_MAX], seen[STRUCTURE_MAX];
    bough_wrench force[STRUCTURE_MAX], inner[STRUCTURE_MAX];
    bough_transform here = bough_transform_identity();
    bough_twist none = {{0, 0, 0}, {0, 0, 0}};
    structure_vertices(c, vertex);
    bough_body_frame_vertices(s->n_vertex, &here, none, c->relative, seen);
    assert_true(term->force(s->self, vertex, force));
    assert_true(term->force(s->self, seen, inner));
    for (int i = 0; i < s->n_vertex; i++) {
        inner[i].force = bough_mat3_mul(c->pose.rotation, inner[i].force);
    }
    structure_near(force, inner, 6 * s->n_vertex, 1e-12, "force in another frame");
    bough_wrench sum = structure_sum(s->n_vertex, vertex, force);
    structure_small(&sum, 6, 1e-10, "sum of inner forces");
}

// Viscous forces take energy, and none in a rigid motion of the deformed structure.
static inline void structure_check_dissipation(const structure_case *c) {
    const bough_structure *s = c->structure;
    bough_vertex vertex[STRUCTURE_MAX], moved[STRUCTURE_MAX];
    bough_vertex_change change[STRUCTURE_MAX];
    bough_wrench force[STRUCTURE_MAX];
    structure_vertices(c, vertex);
    for (int seed = 1; seed < 20; seed++) {
        structure_change(s->n_vertex, seed, change);
        memcpy(moved, vertex, sizeof moved);
        for (int i = 0; i < s->n_vertex; i++) {
            moved[i].velocity = change[i].velocity;
            moved[i].spin = change[i].spin;
        }
        assert_true(s->ops->viscous.force(s->self, moved, force));
        assert_true(structure_power(s->n_vertex, force, moved) < 0);
    }
    structure_case rigid = *c;
    for (int i = 0; i < s->n_vertex; i++) {
        rigid.relative[i].velocity = rigid.relative[i].spin = bough_v3(0, 0, 0);
    }
    structure_vertices(&rigid, vertex);
    assert_true(s->ops->viscous.force(s->self, vertex, force));
    structure_small(force, 6 * s->n_vertex, 1e-11, "viscous force in rigid motion");
    check_near(structure_power(s->n_vertex, force, vertex), 0, 0, 1e-11);
}

// M is symmetric, positive definite, and gives the momentum of the vertices' rigid bodies.
static inline void structure_check_mass(const structure_case *c) {
    const bough_structure *s = c->structure;
    double mass[36 * STRUCTURE_MAX];
    bough_vertex vertex[STRUCTURE_MAX];
    bough_twist velocity[STRUCTURE_MAX];
    bough_wrench momentum[STRUCTURE_MAX], expected = {{0, 0, 0}, {0, 0, 0}};
    structure_vertices(c, vertex);
    s->ops->mass(s->self, vertex, mass);
    for (int k = 0; k < 36 * s->n_vertex; k++) {
        int block = k / 36 * 36, i = k % 36 / 6, j = k % 6;
        check_near(mass[k], mass[block + 6 * j + i], 1e-14, 1e-14);
    }
    for (int i = 0; i < s->n_vertex; i++) assert_true(bough_cholesky_factor(6, mass + 36 * i));
    for (int i = 0; i < s->n_vertex; i++) {
        bough_transform x = {vertex[i].position, bough_rotation_matrix(vertex[i].rotation)};
        bough_twist own = {bough_mat3_tmul(x.rotation, vertex[i].velocity), vertex[i].spin};
        bough_wrench part = bough_inertia_mul(&c->inertia[i], own);
        expected = bough_wrench_add(expected, bough_wrench_to_parent(&x, part));
        velocity[i] = (bough_twist){vertex[i].velocity, vertex[i].spin};
    }
    structure_mass_times(s, vertex, velocity, momentum);
    bough_wrench sum = structure_sum(s->n_vertex, vertex, momentum);
    structure_near(&sum, &expected, 6, 1e-13, "momentum");
}

// The structure as one rigid body: M on a rigid field of accelerations gives the summed inertia.
static inline void structure_check_total_mass(const structure_case *c) {
    const bough_structure *s = c->structure;
    bough_vertex vertex[STRUCTURE_MAX];
    bough_inertia total = {0};
    structure_vertices(c, vertex);
    for (int i = 0; i < s->n_vertex; i++) {
        bough_transform x = {vertex[i].position, bough_rotation_matrix(vertex[i].rotation)};
        total = bough_inertia_add(total, bough_inertia_to_parent(&x, c->inertia[i]));
    }
    for (int j = 0; j < 6; j++) {
        double unit[6] = {0};
        unit[j] = 1;
        bough_twist field = bough_twist_load(unit), local[STRUCTURE_MAX];
        bough_wrench product[STRUCTURE_MAX], expected = bough_inertia_mul(&total, field);
        for (int i = 0; i < s->n_vertex; i++) {
            bough_mat3 r = bough_rotation_matrix(vertex[i].rotation);
            local[i].linear = bough_add(field.linear, bough_cross(field.angular, vertex[i].position));
            local[i].angular = bough_mat3_tmul(r, field.angular);
        }
        structure_mass_times(s, vertex, local, product);
        bough_wrench sum = structure_sum(s->n_vertex, vertex, product);
        structure_near(&sum, &expected, 6, 1e-13, "total inertia");
    }
}

// M a less the inertial forces is the rate of momentum, at every vertex.
static inline void structure_check_inertial(const structure_case *c) {
    const bough_structure *s = c->structure;
    const double step = 1e-5;
    int n = s->n_vertex;
    bough_vertex vertex[STRUCTURE_MAX], moved[STRUCTURE_MAX];
    bough_vertex_change motion[STRUCTURE_MAX];
    bough_twist a[STRUCTURE_MAX], velocity[STRUCTURE_MAX];
    bough_wrench rate[STRUCTURE_MAX], force[STRUCTURE_MAX], momentum[2][STRUCTURE_MAX];
    structure_vertices(c, vertex);
    structure_change(n, 7, motion);
    for (int i = 0; i < n; i++) {
        a[i] = (bough_twist){motion[i].velocity, motion[i].spin};
        motion[i].position = vertex[i].velocity;
        motion[i].turn = vertex[i].spin;
    }
    for (int side = 0; side < 2; side++) {
        structure_shift(n, vertex, side ? step : -step, motion, moved);
        for (int i = 0; i < n; i++) velocity[i] = (bough_twist){moved[i].velocity, moved[i].spin};
        structure_mass_times(s, moved, velocity, momentum[side]);
        for (int i = 0; i < n; i++) {
            momentum[side][i] = structure_sum(1, moved + i, momentum[side] + i);
        }
    }
    structure_mass_times(s, vertex, a, rate);
    assert_true(s->ops->inertial.force(s->self, vertex, force));
    for (int i = 0; i < n; i++) {
        double values[2][6], slope[6];
        bough_wrench difference = bough_wrench_sub(rate[i], force[i]);
        difference = structure_sum(1, vertex + i, &difference);
        for (int k = 0; k < 2; k++) bough_wrench_store(momentum[k][i], values[k]);
        for (int k = 0; k < 6; k++) slope[k] = (values[1][k] - values[0][k]) / (2 * step);
        structure_near(&difference, slope, 6, 1e-8, "rate of momentum");
    }
}

static inline void structure_check_tangent(const structure_case *c, const bough_structure_term *term) {
    const bough_structure *s = c->structure;
    const double step = 1e-6;
    int n = s->n_vertex;
    bough_vertex vertex[STRUCTURE_MAX], shifted[STRUCTURE_MAX];
    bough_vertex_change change[STRUCTURE_MAX];
    bough_wrench tangent[STRUCTURE_MAX], side[2][STRUCTURE_MAX], difference[STRUCTURE_MAX];
    structure_vertices(c, vertex);
    for (int seed = 1; seed < 5; seed++) {
        structure_change(n, seed, change);
        for (int k = 0; k < 2; k++) {
            structure_shift(n, vertex, k ? step : -step, change, shifted);
            assert_true(term->force(s->self, shifted, side[k]));
        }
        for (int i = 0; i < n; i++) {
            bough_wrench d = bough_wrench_sub(side[1][i], side[0][i]);
            difference[i].force = bough_scale(0.5 / step, d.force);
            difference[i].moment = bough_scale(0.5 / step, d.moment);
        }
        assert_true(term->tangent(s->self, vertex, change, tangent));
        structure_near(tangent, difference, 6 * n, 1e-7, "tangent");
    }
}

static inline void structure_check_mass_tangent(const structure_case *c) {
    const bough_structure *s = c->structure;
    const double step = 1e-6;
    int n = s->n_vertex;
    bough_vertex vertex[STRUCTURE_MAX], shifted[STRUCTURE_MAX];
    bough_vertex_change change[STRUCTURE_MAX];
    bough_twist a[STRUCTURE_MAX];
    bough_wrench tangent[STRUCTURE_MAX], side[2][STRUCTURE_MAX], difference[STRUCTURE_MAX];
    structure_vertices(c, vertex);
    structure_change(n, 3, change);
    for (int i = 0; i < n; i++) a[i] = (bough_twist){change[i].velocity, change[i].spin};
    for (int k = 0; k < 2; k++) {
        structure_shift(n, vertex, k ? step : -step, change, shifted);
        structure_mass_times(s, shifted, a, side[k]);
    }
    for (int i = 0; i < n; i++) {
        bough_wrench d = bough_wrench_sub(side[1][i], side[0][i]);
        difference[i].force = bough_scale(0.5 / step, d.force);
        difference[i].moment = bough_scale(0.5 / step, d.moment);
    }
    s->ops->mass_tangent(s->self, vertex, change, a, tangent);
    structure_near(tangent, difference, 6 * n, 1e-7, "mass tangent");
}

// Everything, at the case.
static inline void structure_check(const structure_case *c) {
    const bough_structure_ops *ops = c->structure->ops;
    structure_check_gradient(c);
    structure_check_inner(c, &ops->elastic);
    structure_check_inner(c, &ops->viscous);
    structure_check_dissipation(c);
    structure_check_mass(c);
    structure_check_total_mass(c);
    structure_check_inertial(c);
    structure_check_tangent(c, &ops->elastic);
    structure_check_tangent(c, &ops->viscous);
    structure_check_tangent(c, &ops->inertial);
    structure_check_mass_tangent(c);
}

#endif
