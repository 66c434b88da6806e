// The equations (12)–(15) of any structure in its body reference frame: their transformation
// against differences in time, their projection, and their solution against (10)/(11) in the
// ground. At a case of structure_contract.h, with wrenches.
#ifndef BOUGH_TESTS_REFERENCE_BODY_FRAME_CONTRACT_H
#define BOUGH_TESTS_REFERENCE_BODY_FRAME_CONTRACT_H

#include "tests/reference/structure_contract.h"

// Wrenches at the first, a middle and the last vertex, off their origins; in BRF axes.
enum { STRUCTURE_WRENCHES = 3 };

static inline bough_attachment structure_attachment(const structure_case *c, int which) {
    int at = 40 + which;
    int last = c->structure->n_vertex - 1;
    return (bough_attachment){which * last / 2, structure_vector(&at, 0.3)};
}

static inline bough_wrench structure_wrench(int which) {
    int at = 60 + 6 * which;
    bough_vec3 force = structure_vector(&at, 2);
    return (bough_wrench){force, structure_vector(&at, 1)};
}

static inline void structure_evaluate(const structure_case *c, bool wrenches, bough_body_frame *b) {
    assert_true(bough_body_frame_evaluate(b, &c->motion, c->relative));
    for (int k = 0; wrenches && k < STRUCTURE_WRENCHES; k++) {
        bough_attachment at = structure_attachment(c, k);
        bough_body_frame_add_wrench(b, &at, structure_wrench(k));
    }
}

// The reference: (10)/(11) of every vertex in the ground, solved for the accelerations.
static inline void structure_newton_euler(const structure_case *c, bool wrenches, bough_twist *acceleration) {
    const bough_structure *s = c->structure;
    const bough_structure_term terms[3] = {s->ops->elastic, s->ops->viscous, s->ops->inertial};
    bough_vertex vertex[STRUCTURE_MAX];
    bough_wrench sum[STRUCTURE_MAX] = {0}, force[STRUCTURE_MAX];
    bough_twist weight[STRUCTURE_MAX] = {0};
    double mass[36 * STRUCTURE_MAX];
    structure_vertices(c, vertex);
    for (int k = 0; k < 3; k++) {
        assert_true(terms[k].force(s->self, vertex, force));
        for (int i = 0; i < s->n_vertex; i++) sum[i] = bough_wrench_add(sum[i], force[i]);
    }
    for (int k = 0; wrenches && k < STRUCTURE_WRENCHES; k++) {
        bough_attachment at = structure_attachment(c, k);
        bough_wrench w = structure_wrench(k);
        w.force = bough_mat3_mul(c->pose.rotation, w.force);
        w.moment = bough_mat3_mul(c->pose.rotation, w.moment);
        bough_wrench add = bough_attachment_force(&at, vertex, w);
        sum[at.vertex] = bough_wrench_add(sum[at.vertex], add);
    }
    bough_vec3 gravity = bough_mat3_mul(c->pose.rotation, c->motion.gravity);
    for (int i = 0; i < s->n_vertex; i++) weight[i].linear = gravity;
    structure_mass_times(s, vertex, weight, force);
    s->ops->mass(s->self, vertex, mass);
    for (int i = 0; i < s->n_vertex; i++) {
        double a[6];
        bough_wrench_store(bough_wrench_add(sum[i], force[i]), a);
        assert_true(bough_cholesky_factor(6, mass + 36 * i));
        bough_cholesky_solve(6, mass + 36 * i, a);
        acceleration[i] = bough_twist_load(a);
    }
}

// (14) for every vertex: absolute accelerations into the ground's axes.
static inline void structure_to_ground(const structure_case *c, bough_twist *acceleration) {
    for (int i = 0; i < c->structure->n_vertex; i++) {
        acceleration[i].linear = bough_mat3_mul(c->pose.rotation, acceleration[i].linear);
    }
}

// The case a small time later, moving with the accelerations given.
static inline structure_case structure_later(const structure_case *c, double step, const double *v_r_rate,
                                             const double *v_e_rate) {
    structure_case d = *c;
    bough_twist v = c->motion.twist, rate = bough_twist_load(v_r_rate);
    bough_quaternion turn = bough_quaternion_exponential(bough_scale(step, v.angular));
    rate.linear = bough_sub(rate.linear, bough_cross(v.angular, v.linear));
    d.pose.position = bough_axpy(step, bough_mat3_mul(c->pose.rotation, v.linear), c->pose.position);
    d.pose.rotation = bough_mat3_product(c->pose.rotation, bough_rotation_matrix(turn));
    d.motion.twist.linear = bough_axpy(step, rate.linear, v.linear);
    d.motion.twist.angular = bough_axpy(step, rate.angular, v.angular);
    for (int i = 0, k = 0; i < c->structure->n_vertex; i++) {
        if (i == c->structure->reference) continue;
        bough_twist a = bough_twist_load(v_e_rate + 6 * k++);
        bough_relative_vertex *r = &d.relative[i];
        bough_quaternion own = bough_quaternion_exponential(bough_scale(step, r->spin));
        r->position = bough_axpy(step, r->velocity, r->position);
        r->rotation = bough_quaternion_product(own, r->rotation);
        r->velocity = bough_axpy(step, a.linear, r->velocity);
        r->spin = bough_axpy(step, a.angular, r->spin);
    }
    return d;
}

// F and G are the derivative in time of (13).
static inline void structure_check_transformation(const structure_case *c, bough_body_frame *b) {
    const double step = 1e-5;
    int n = c->structure->n_vertex, at = 9;
    double v_r_rate[6], v_e_rate[6 * STRUCTURE_MAX];
    bough_vertex side[2][STRUCTURE_MAX];
    bough_twist a[STRUCTURE_MAX], slope[STRUCTURE_MAX];
    for (int k = 0; k < 6; k++) v_r_rate[k] = structure_number(&at);
    for (int k = 0; k < 6 * n; k++) v_e_rate[k] = structure_number(&at);
    structure_evaluate(c, false, b);
    bough_body_frame_accelerations(b, v_r_rate, v_e_rate, a);
    structure_to_ground(c, a);
    for (int k = 0; k < 2; k++) {
        structure_case moved = structure_later(c, k ? step : -step, v_r_rate, v_e_rate);
        structure_vertices(&moved, side[k]);
    }
    for (int i = 0; i < n; i++) {
        bough_vec3 linear = bough_sub(side[1][i].velocity, side[0][i].velocity);
        bough_vec3 angular = bough_sub(side[1][i].spin, side[0][i].spin);
        slope[i].linear = bough_scale(0.5 / step, linear);
        slope[i].angular = bough_scale(0.5 / step, angular);
    }
    structure_near(a, slope, 6 * n, 1e-8, "F v + G");
}

// Virtual power: v̇ᵀ of (12)'s residual is aᵀ of (11)'s for every a = F v̇, weight included.
static inline void structure_check_projection(const structure_case *c, bough_body_frame *b) {
    int n = c->structure->n_vertex, n_e = 6 * (n - 1), at = 31;
    double x[2][6 + 6 * STRUCTURE_MAX] = {{0}}, zero[6 * STRUCTURE_MAX] = {0};
    bough_twist a[2][STRUCTURE_MAX], g[STRUCTURE_MAX];
    structure_evaluate(c, false, b);
    for (int k = 0; k < 2 * (6 + n_e); k++) x[k % 2][k / 2] = structure_number(&at);
    for (int k = 0; k < 2; k++) bough_body_frame_accelerations(b, x[k], x[k] + 6, a[k]);
    bough_body_frame_accelerations(b, zero, zero, g);
    double power = 0, reduced = 0, row[6 + 6 * STRUCTURE_MAX] = {0};
    for (int i = 0; i < n; i++) { // residual of (11) at accelerations a[0], against F x[1]
        bough_twist relative = {bough_sub(a[0][i].linear, c->motion.gravity), a[0][i].angular};
        bough_twist test = {bough_sub(a[1][i].linear, g[i].linear), bough_sub(a[1][i].angular, g[i].angular)};
        double values[6], product[6] = {0};
        bough_twist_store(relative, values);
        structure_multiply(b->mass + 36 * i, values, product);
        bough_wrench residual =
            bough_wrench_sub(bough_wrench_load(product), bough_wrench_load(b->force + 6 * i));
        power += bough_power(test, residual);
    }
    structure_multiply(b->m_r, x[0], row); // M v̇ of (12), then less h
    for (int k = 0; k < n - 1; k++) {
        for (int i = 0; i < 36; i++) row[i % 6] += b->s[36 * k + i] * x[0][6 + 6 * k + i / 6];
        structure_multiply(b->s + 36 * k, x[0], row + 6 + 6 * k);
        structure_multiply(b->m_e + 36 * k, x[0] + 6 + 6 * k, row + 6 + 6 * k);
    }
    for (int k = 0; k < 6 + n_e; k++) {
        reduced += x[1][k] * (row[k] - (k < 6 ? b->h_r[k] : b->h_e[k - 6]));
    }
    check_near(reduced, power, 1e-11, 0);
}

// A marker's twist in BRF axes, its Jacobian by differences: linear in the velocities.
static inline bough_twist structure_marker_twist(const structure_case *c, const bough_attachment *at) {
    bough_vertex vertex[STRUCTURE_MAX];
    bough_transform here = bough_transform_identity();
    bough_body_frame_vertices(c->structure->n_vertex, &here, c->motion.twist, c->relative, vertex);
    const bough_vertex *v = &vertex[at->vertex];
    bough_mat3 r = bough_rotation_matrix(v->rotation);
    bough_vec3 lever = bough_mat3_mul(r, bough_cross(v->spin, at->arm));
    return (bough_twist){bough_add(v->velocity, lever), bough_mat3_mul(r, v->spin)};
}

static inline void structure_check_jacobians(const structure_case *c, bough_body_frame *b) {
    structure_evaluate(c, false, b);
    for (int which = 0; which < STRUCTURE_WRENCHES; which++) {
        bough_attachment at = structure_attachment(c, which);
        double j_r[36], j_e[36], expected_r[36], expected_e[36] = {0}, before[6], after[6];
        int k = bough_body_frame_jacobian(b, &at, j_r, j_e);
        assert_int_equal(k < 0, at.vertex == c->structure->reference);
        bough_twist_store(structure_marker_twist(c, &at), before);
        for (int j = 0; j < 6; j++) {
            structure_case moved = *c;
            double twist[6], own[6];
            bough_twist_store(c->motion.twist, twist);
            twist[j] += 1;
            moved.motion.twist = bough_twist_load(twist);
            bough_twist_store(structure_marker_twist(&moved, &at), after);
            for (int i = 0; i < 6; i++) expected_r[6 * j + i] = after[i] - before[i];
            if (k < 0) continue;
            moved = *c;
            bough_relative_vertex *r = &moved.relative[at.vertex];
            bough_twist_store((bough_twist){r->velocity, r->spin}, own);
            own[j] += 1;
            r->velocity = bough_v3(own[0], own[1], own[2]);
            r->spin = bough_v3(own[3], own[4], own[5]);
            bough_twist_store(structure_marker_twist(&moved, &at), after);
            for (int i = 0; i < 6; i++) expected_e[6 * j + i] = after[i] - before[i];
        }
        structure_near(j_r, expected_r, 36, 1e-13, "J_R");
        structure_near(j_e, expected_e, 36, 1e-13, "J_E");
    }
}

// (12) for a given acceleration of the BRF gives the accelerations of (11) in the ground; with the
// reduced equation's own v̇_R those of the free body, the reference vertex included.
static inline void structure_check_equivalence(const structure_case *c, bough_body_frame *b) {
    int n = c->structure->n_vertex;
    bough_twist expected[STRUCTURE_MAX], a[STRUCTURE_MAX];
    double v_r_rate[6] = {0.9, -1.4, 2.2, -0.6, 1.1, 0.8}, v_e_rate[6 * STRUCTURE_MAX];
    double inertia[36], force[6];
    structure_newton_euler(c, true, expected);
    structure_evaluate(c, true, b);
    bough_body_frame_flexible(b, v_r_rate, v_e_rate);
    bough_body_frame_accelerations(b, v_r_rate, v_e_rate, a);
    structure_to_ground(c, a);
    a[c->structure->reference] = expected[c->structure->reference]; // prescribed
    structure_near(a, expected, 6 * n, 1e-10, "acceleration");
    bough_body_frame_reduce(b, inertia, force);
    assert_true(bough_cholesky_factor(6, inertia));
    bough_cholesky_solve(6, inertia, force);
    bough_body_frame_flexible(b, force, v_e_rate);
    bough_body_frame_accelerations(b, force, v_e_rate, a);
    structure_to_ground(c, a);
    structure_near(a, expected, 6 * n, 1e-10, "acceleration of the free body");
}

// The forces on the reference vertex about the BRF's origin: its share of the inner forces and of
// the wrenches, and the gyroscopic term and weight of its own inertia, here those of a rigid body.
static inline bough_wrench structure_reference_forces(const structure_case *c, const bough_body_frame *b,
                                                      const bough_inertia *own) {
    const bough_structure *s = c->structure;
    const bough_vertex *v = b->vertex + s->reference;
    bough_twist spin = {{0, 0, 0}, c->motion.twist.angular}, fall = {c->motion.gravity, {0, 0, 0}};
    bough_wrench gyroscopic = bough_wrench_cross(spin, bough_inertia_mul(own, spin));
    bough_wrench sum = bough_wrench_sub(bough_inertia_mul(own, fall), gyroscopic);
    bough_wrench term[STRUCTURE_MAX];
    assert_true(s->ops->elastic.force(s->self, b->vertex, term));
    sum = bough_wrench_add(sum, structure_sum(1, v, term + s->reference));
    assert_true(s->ops->viscous.force(s->self, b->vertex, term));
    sum = bough_wrench_add(sum, structure_sum(1, v, term + s->reference));
    for (int k = 0; k < STRUCTURE_WRENCHES; k++) {
        bough_attachment at = structure_attachment(c, k);
        if (at.vertex != s->reference) continue;
        bough_wrench add = bough_attachment_force(&at, b->vertex, structure_wrench(k));
        sum = bough_wrench_add(sum, structure_sum(1, v, &add));
    }
    return sum;
}

// The tree feels a lumped structure only through its reference vertex: the reduced inertia is that
// vertex' own, the reduced force the forces on it, here with inertial forces, weight and wrenches.
static inline void structure_check_reduced(const structure_case *c, bough_body_frame *b) {
    const bough_structure *s = c->structure;
    const bough_inertia *own = &c->inertia[s->reference];
    double inertia[36], force[6], expected[36];
    bough_transform x = {s->rest[s->reference].position,
                         bough_rotation_matrix(s->rest[s->reference].rotation)};
    bough_inertia carried = bough_inertia_to_parent(&x, *own);
    structure_evaluate(c, true, b);
    bough_body_frame_reduce(b, inertia, force);
    for (int j = 0; j < 6; j++) {
        double unit[6] = {0}, column[6];
        unit[j] = 1;
        bough_wrench_store(bough_inertia_mul(&carried, bough_twist_load(unit)), column);
        for (int i = 0; i < 6; i++) expected[6 * i + j] = column[i];
    }
    structure_near(inertia, expected, 36, 1e-11, "reduced inertia");
    bough_wrench sum = structure_reference_forces(c, b, &carried);
    structure_near(force, &sum, 6, 1e-10, "reduced force");
}

static inline void structure_check_body_frame(const structure_case *c) {
    bough_body_frame b;
    check_arena(arena);
    assert_true(bough_body_frame_init(&b, arena, c->structure));
    structure_check_transformation(c, &b);
    structure_check_projection(c, &b);
    structure_check_jacobians(c, &b);
    structure_check_equivalence(c, &b);
    structure_check_reduced(c, &b);
}

#endif
