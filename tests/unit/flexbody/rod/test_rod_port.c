// A rod that carries bodies: its last vertex moves as an input says and returns a wrench. The rest of
// test_rod.c and test_rod_system.c is about the port at the root.

#include "flexbody/rod/rod_system.h"
#include "tests/unit/contract.h"
#include "tests/unit/sample_rod.h"

enum { N = 5, WHOLE = BOUGH_ROD_STATES * N, STATES = WHOLE - BOUGH_ROD_STATES };

// The same rod twice, free at its end and carrying, in the same state under the same loads.
typedef struct pair {
    bough_arena *arena;
    bough_rod_model *free, *carrying;
    bough_rod_body *free_body, *carrying_body;
    double whole[WHOLE], state[STATES], input[BOUGH_ROD_MOST_INPUTS];
} pair;

static bough_rod_body *make(bough_arena *arena, bough_rod_model *model, const double *input) {
    bough_rod_body *body = bough_rod_body_create(arena, model, input);
    bough_rod_loads *loads = bough_rod_body_loads(body);
    sample_loads(model, loads);
    for (int k = 0; k < 2; k++) {
        const bough_schedule ramp = {.start = 0.1 * k, .end = 1};
        double *value = bough_rod_loads_ramped(loads, arena, model, k == 0, &ramp)->value;
        for (int i = 0; i < 6 * model->stride; i++) value[i] = 0.4 * sin(i + k);
    }
    return body;
}

// The end's components of the state, x p u W, are the inputs u W x p.
static void split(pair *p) {
    static const int component[BOUGH_ROD_END_INPUTS] = {7, 8, 9, 10, 11, 12, 0, 1, 2, 3, 4, 5, 6};
    for (int k = 0; k < BOUGH_ROD_END_INPUTS; k++) {
        p->input[BOUGH_ROD_INPUTS + k] = p->whole[component[k] * N + N - 1];
    }
    for (int c = 0; c < BOUGH_ROD_STATES; c++) {
        memcpy(p->state + c * (N - 1), p->whole + c * N, (N - 1) * sizeof(double));
    }
}

static pair make_pair(void) {
    static const double input[BOUGH_ROD_INPUTS] = {0.4, -0.3, 0.7, 0.5, -0.8, 0.6, 1, -2, -9};
    pair p = {.arena = check_memory()};
    memcpy(p.input, input, sizeof input);
    p.free = sample_general(p.arena, N);
    p.carrying = sample_general_as(p.arena, N, true);
    p.free_body = make(p.arena, p.free, p.input);
    p.carrying_body = make(p.arena, p.carrying, p.input);
    sample_state(p.free, p.input, p.whole);
    split(&p);
    return p;
}

TEST(operations_agree_on_a_rod_that_carries) {
    pair p = make_pair();
    bough_system s = bough_rod_body_system(p.carrying_body);
    assert_int_equal(s.n_state, STATES);
    assert_int_equal(s.n_input, 22);
    assert_int_equal(s.n_output, 12);
    bough_member *m =
        member_of(p.arena, &s, (bough_integrator_options){.kind = BOUGH_CVODE_BDF, .rtol = 1e-6});
    contract_point at = {0.5, p.state, p.input, 1e-5};
    contract_check(m, at, 0.03, 0.01);
    bough_rod_loads *loads = bough_rod_body_loads(p.carrying_body);
    sample_line(p.carrying);
    sample_loads_along(p.arena, p.carrying, loads);
    contract_check(m, at, 0.03, 0.01);
    loads->ramped = NULL; // the strains without stress still move
    contract_check(m, at, 0.03, 0.01);
}

// Vertices that both integrate accelerate alike, and the root feels the same.
TEST(end_moves_the_rest_as_its_own_vertex_would) {
    pair p = make_pair();
    bough_system whole = bough_rod_body_system(p.free_body);
    bough_system part = bough_rod_body_system(p.carrying_body);
    double a[WHOLE], b[STATES], wrench[6], wrenches[12];
    assert_true(whole.ops->derivative(whole.self, 0.5, p.whole, p.input, a));
    assert_true(part.ops->derivative(part.self, 0.5, p.state, p.input, b));
    whole.ops->output(whole.self, 0.5, p.whole, p.input, wrench);
    part.ops->output(part.self, 0.5, p.state, p.input, wrenches);
    for (int c = 0; c < BOUGH_ROD_STATES; c++) {
        for (int i = 0; i < N - 1; i++) check_near(b[c * (N - 1) + i], a[c * N + i], 1e-13, 1e-13);
    }
    for (int k = 0; k < 6; k++) check_near(wrenches[k], wrench[k], 1e-13, 1e-13);
}

// (11) of the last vertex with the wrench as the only force beside its weight: its acceleration as a
// part of the whole rod makes the balance hold.
TEST(end_wrench_is_what_moves_the_last_vertex) {
    pair p = make_pair();
    bough_system whole = bough_rod_body_system(p.free_body);
    bough_system part = bough_rod_body_system(p.carrying_body);
    double rate[WHOLE], wrench[12];
    assert_true(whole.ops->derivative(whole.self, 0.5, p.whole, p.input, rate));
    part.ops->output(part.self, 0.5, p.state, p.input, wrench);
    const double *end = p.input + BOUGH_ROD_INPUTS, *a = rate + N - 1;
    const bough_vertex_inertia *v = &p.carrying->vertex[N];
    const double *j = v->inertia;
    bough_mat3 inertia = {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}};
    bough_mat3 r = bough_rotation_matrix(
        bough_quaternion_normalised((bough_quaternion){end[9], end[10], end[11], end[12]}));
    bough_vec3 u = {end[0], end[1], end[2]}, w = {end[3], end[4], end[5]};
    bough_vec3 omega = {p.input[3], p.input[4], p.input[5]};
    bough_vec3 gravity = {p.input[6], p.input[7], p.input[8]};
    bough_vec3 udot = {a[7 * N], a[8 * N], a[9 * N]}, wdot = {a[10 * N], a[11 * N], a[12 * N]};
    bough_vec3 c = bough_mat3_tmul(r, bough_sub(bough_add(udot, bough_cross(omega, u)), gravity));
    bough_vec3 centrifugal = bough_cross(w, bough_cross(w, v->moment));
    bough_vec3 force = bough_axpy(v->mass, c, bough_add(bough_cross(wdot, v->moment), centrifugal));
    bough_vec3 moment = bough_add(bough_cross(v->moment, c), bough_mat3_mul(inertia, wdot));
    moment = bough_add(moment, bough_cross(w, bough_mat3_mul(inertia, w)));
    force = bough_mat3_mul(r, force);
    const double expected[6] = {force.x, force.y, force.z, moment.x, moment.y, moment.z};
    for (int k = 0; k < 6; k++) check_near(wrench[6 + k], expected[k], 1e-11, 1e-11);
}

// A straight rod, stiff in shear and tension, whose end is not where it was built: no vertex is driven, as
// the next to the end would be, by 1, if only the last segment were strained.
TEST(starts_in_balance_where_its_end_is) {
    check_arena(arena);
    sample_arrays a = sample_general_arrays(arena, N);
    const double stiffness[21] = {[0] = 1e6, [6] = 1e6, [11] = 1e6, [15] = 1, [18] = 2, [20] = 1};
    for (int i = 0; i <= N; i++) {
        a.rotation[i] = bough_quaternion_identity();
        a.position[i] = bough_v3(0, 0, a.span[i]);
        a.inertia[i] = (bough_vertex_inertia){.mass = 1, .inertia = {1, 1, 1}};
        if (i < N) memcpy(a.stiffness + 21 * i, stiffness, sizeof stiffness);
    }
    double state[STATES], rate[STATES], input[BOUGH_ROD_MOST_INPUTS] = {0};
    const double end[] = {1e-6, -1e-6, 1e-6 + a.span[N], 1, 1e-6, 1e-6, -1e-6}; // x, p
    memcpy(input + BOUGH_ROD_INPUTS + 6, end, sizeof end);
    bough_rod_body *body = bough_rod_body_create(arena, sample_build(arena, N, a, true), input);
    bough_system s = bough_rod_body_system(body);
    memcpy(state, s.initial, sizeof state);
    assert_true(s.ops->derivative(s.self, 0, state, input, rate));
    for (int k = 0; k < 6 * (N - 1); k++) check_near(rate[BOUGH_ROD_U * (N - 1) + k], 0, 0, 0.03);
}

TEST(too_short_a_rod_carries_nothing) {
    check_arena(arena);
    sample_arrays a = sample_take(arena, 1);
    bough_rod_def def = {.name = "stub", .n_segment = 1, .span = a.span, .carries = true};
    bough_rod_model *model = NULL;
    check_fails(bough_rod_create(arena, &def, &model), BOUGH_INVALID,
                "rod stub: 1 segments; a rod that carries bodies");
}
