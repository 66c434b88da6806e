// The rod's forces and balances; its tangents are under the contract in test_rod_system.c.

#include "core/base/spatial.h"
#include "flexbody/rod/rod_tangent.h"
#include "tests/unit/rod_energy.h"
#include "tests/unit/sample_rod.h"

enum { N = 7, STATES = BOUGH_ROD_STATES * N };

typedef struct fixture {
    bough_arena *arena;
    bough_rod_model *model;
    bough_rod_scratch scratch;
    bough_rod_loads loads;
    double state[STATES], input[BOUGH_ROD_INPUTS];
} fixture;

static int setup(void **context) {
    static const double input[BOUGH_ROD_INPUTS] = {0.4, -0.3, 0.7, 0.5, -0.8, 0.6, 1, -2, -9};
    fixture *f = calloc(1, sizeof *f);
    f->arena = check_memory();
    f->model = sample_general(f->arena, N);
    bough_rod_scratch_init(&f->scratch, f->arena, f->model);
    bough_rod_loads_init(&f->loads, f->arena, f->model);
    memcpy(f->input, input, sizeof input);
    sample_state(f->model, f->input, f->state);
    sample_loads(f->model, &f->loads);
    *context = f;
    return 0;
}

static int teardown(void **context) {
    fixture *f = *context;
    bough_arena_destroy(f->arena);
    free(f);
    return 0;
}

static void derivative(fixture *f, const double *state, const double *input, double *rate) {
    assert_true(bough_rod_derivative(f->model, &f->loads, 0.5, state, input, &f->scratch, rate));
}

TEST_WITH(undeformed_rod_moving_rigidly_feels_no_stress, setup, teardown) {
    fixture *f = *context;
    double wrench[6];
    memset(f->loads.value, 0, 6 * (size_t)f->model->stride * sizeof(double));
    memset(f->loads.rate, 0, 6 * (size_t)f->model->stride * sizeof(double));
    bough_rod_rest_state(f->model, f->input, f->state);
    bough_rod_gather(f->model, f->state, f->input, &f->scratch);
    assert_true(bough_rod_forces(f->model, 0, N, &f->scratch));
    for (int k = 0; k < 9; k++) {
        for (int n = 0; n < N; n++) {
            check_near(f->scratch.segment[k * f->model->stride + n], 0, 0, 1e-12);
        }
    }
    bough_rod_wrenches(f->model, &f->loads, 0, f->state, f->input, &f->scratch, wrench);
    for (int k = 0; k < 6; k++) check_near(wrench[k], 0, 0, 1e-12);
}

// Without damping the power of the vertex forces is minus the rate of the elastic energy.
TEST_WITH(forces_are_the_gradient_of_the_energy, setup, teardown) {
    fixture *f = *context;
    bough_rod_model *m = f->model;
    int s = m->stride;
    double rate[STATES], energy[2];
    memset(m->damping, 0, 21 * (size_t)s * sizeof(double));
    double still[BOUGH_ROD_INPUTS] = {0};
    memset(f->loads.value, 0, 6 * (size_t)s * sizeof(double));
    memset(f->loads.rate, 0, 6 * (size_t)s * sizeof(double));
    derivative(f, f->state, still, rate);
    const double *seg = f->scratch.segment, *v = f->scratch.vertex;
    double power = 0;
    for (int i = 1; i <= N; i++) {
        for (int c = 0; c < 3; c++) {
            power += (seg[c * s + i] - seg[c * s + i - 1]) * v[(BOUGH_ROD_U + c) * s + i];
            power += (seg[(3 + c) * s + i] + seg[(6 + c) * s + i - 1]) * v[(BOUGH_ROD_W + c) * s + i];
        }
    }
    for (int side = 0; side < 2; side++) {
        double moved[STATES], eps = side == 0 ? -1e-6 : 1e-6;
        for (int k = 0; k < STATES; k++) moved[k] = f->state[k] + eps * rate[k];
        bough_rod_gather(m, moved, still, &f->scratch);
        energy[side] = rod_elastic_energy(m, &f->scratch);
    }
    check_near(power, -(energy[1] - energy[0]) / 2e-6, 1e-7, 0);
}

static bough_vec3 vector_at(const double *x, int stride, int i) {
    return bough_v3(x[i], x[stride + i], x[2 * stride + i]);
}

// Momentum of the moving vertices, angular about the origin of the frame, in its axes.
static bough_wrench momentum(const bough_rod_model *m, const double *y) {
    bough_wrench sum = {{0, 0, 0}, {0, 0, 0}};
    for (int i = 0; i < N; i++) {
        const bough_vertex_inertia *v = &m->vertex[i + 1];
        const double *j = v->inertia, *p = y + BOUGH_ROD_P * N + i;
        bough_quaternion turn = {p[0], p[N], p[2 * N], p[3 * N]};
        bough_inertia own = {
            v->mass, v->moment, {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}}};
        bough_transform at = {vector_at(y, N, i), bough_rotation_matrix(bough_quaternion_normalised(turn))};
        bough_vec3 u = vector_at(y + BOUGH_ROD_U * N, N, i);
        bough_twist twist = {bough_mat3_tmul(at.rotation, u), vector_at(y + BOUGH_ROD_W * N, N, i)};
        sum = bough_wrench_add(sum, bough_wrench_to_parent(&at, bough_inertia_mul(&own, twist)));
    }
    return sum;
}

// Weight and loads of the moving vertices at 0.5 s, and what the root takes from the first segment.
static bough_wrench outer_forces(fixture *f) {
    const bough_vec3 gravity = {f->input[6], f->input[7], f->input[8]};
    double root[6];
    bough_rod_wrenches(f->model, &f->loads, 0.5, f->state, f->input, &f->scratch, root);
    bough_wrench sum = bough_wrench_sub((bough_wrench){{0, 0, 0}, {0, 0, 0}}, bough_wrench_load(root));
    for (int i = 0; i <= N; i++) {
        double load[6];
        for (int c = 0; c < 6; c++) {
            int k = c * f->model->stride + i;
            load[c] = f->loads.value[k] + (0.5 - f->loads.start) * f->loads.rate[k];
        }
        bough_transform at = {i > 0 ? vector_at(f->state, N, i - 1) : bough_v3(0, 0, 0),
                              bough_mat3_identity()};
        sum = bough_wrench_add(sum, bough_wrench_to_parent(&at, bough_wrench_load(load)));
        if (i == 0) continue;
        const double *p = f->state + BOUGH_ROD_P * N + i - 1;
        bough_quaternion turn = {p[0], p[N], p[2 * N], p[3 * N]};
        at.rotation = bough_rotation_matrix(bough_quaternion_normalised(turn));
        bough_vec3 arm = bough_mat3_mul(at.rotation, f->model->vertex[i].moment);
        bough_vec3 lever = bough_axpy(f->model->vertex[i].mass, at.position, arm);
        bough_wrench weight = {bough_scale(f->model->vertex[i].mass, gravity), bough_cross(lever, gravity)};
        sum = bough_wrench_add(sum, weight);
    }
    return sum;
}

// Inner forces, elastic and viscous, have no resultant: a rod deformed and moving in a frame that moves.
TEST_WITH(momentum_changes_by_loads_weight_and_root_alone, setup, teardown) {
    fixture *f = *context;
    const double h = 1e-6;
    const bough_twist frame = bough_twist_load(f->input);
    double rate[STATES], moved[STATES], now[6], side[2][6], expected[6];
    derivative(f, f->state, f->input, rate);
    for (int s = 0; s < 2; s++) {
        for (int k = 0; k < STATES; k++) moved[k] = f->state[k] + (s == 0 ? -h : h) * rate[k];
        bough_wrench_store(momentum(f->model, moved), side[s]);
    }
    bough_wrench held = bough_wrench_cross(frame, momentum(f->model, f->state));
    bough_wrench_store(bough_wrench_sub(outer_forces(f), held), expected);
    for (int c = 0; c < 6; c++) {
        now[c] = (side[1][c] - side[0][c]) / (2 * h);
        check_near(now[c], expected[c], 1e-6, 1e-6);
    }
}

// A rod of any number of segments, in a strongly deformed state.
typedef struct sized {
    bough_arena *arena;
    bough_rod_model *model;
    bough_rod_scratch scratch;
    bough_rod_loads loads;
    bough_rod_tangent tangent;
    double *state, *x, *rate, *moved; // (13 n)
    double input[BOUGH_ROD_MOST_INPUTS];
} sized;

static sized build_sized(int n_segment, bool carries) {
    sized r = {.arena = check_memory(), .input = {0.4, -0.3, 0.7, 0.5, -0.8, 0.6, 1, -2, -9}};
    r.model = sample_general_as(r.arena, n_segment, carries);
    bough_rod_scratch_init(&r.scratch, r.arena, r.model);
    bough_rod_loads_init(&r.loads, r.arena, r.model);
    bough_rod_tangent_init(&r.tangent, r.arena, r.model);
    double **const arrays[] = {&r.state, &r.x, &r.rate, &r.moved};
    for (int k = 0; k < 4; k++) {
        *arrays[k] = bough_arena_doubles(r.arena, BOUGH_ROD_STATES * (size_t)r.model->n);
    }
    sample_state(r.model, r.input, r.state);
    sample_loads(r.model, &r.loads);
    bough_vec3 x = r.model->position0[n_segment];
    bough_quaternion p = r.model->rotation0[n_segment];
    const double end[BOUGH_ROD_END_INPUTS] = {0.1, 0.2, 0.3, 0.3, 0.2, 0.1, x.x,
                                              x.y, x.z, p.w, p.x, p.y, p.z};
    memcpy(r.input + BOUGH_ROD_INPUTS, end, sizeof end);
    return r;
}

// (I − γJ) d for a random d into x, by differences; d itself by the solution.
static void check_sized(int n_segment, bool carries) {
    const double eps = 1e-6, gamma = 0.07;
    sized r = build_sized(n_segment, carries);
    int count = BOUGH_ROD_STATES * r.model->n;
    for (int side = -1; side <= 1; side += 2) {
        unsigned seed = 3;
        for (int k = 0; k < count; k++) r.moved[k] = r.state[k] + side * eps * sample_random(&seed);
        assert_true(bough_rod_derivative(r.model, &r.loads, 0.5, r.moved, r.input, &r.scratch, r.rate));
        for (int k = 0; k < count; k++) r.x[k] -= side * gamma * r.rate[k] / (2 * eps);
    }
    unsigned seed = 3;
    for (int k = 0; k < count; k++) r.x[k] += sample_random(&seed);
    assert_true(bough_rod_linearise(r.model, &r.loads, 0.5, r.state, r.input, &r.scratch, &r.tangent));
    assert_true(bough_rod_factor(r.model, &r.tangent, gamma));
    bough_rod_solve(r.model, &r.tangent, r.x);
    seed = 3;
    for (int k = 0; k < count; k++) check_near(r.x[k], sample_random(&seed), 0, 1e-6);
    bough_arena_destroy(r.arena);
}

// Segments go by eight: fewer, just as many, one more, some more.
TEST(newton_solution_holds_for_any_number_of_segments) {
    const int sizes[] = {1, 2, 7, 8, 9, 10, 12, 16, 17, 25};
    for (int k = 0; k < 10; k++) {
        check_sized(sizes[k], false);
        if (sizes[k] > 1) check_sized(sizes[k], true);
    }
}

// Vectors of two, four and eight vertices, the last of which repeats some or is not full.
static void check_rates(int n_segment, bool carries) {
    sized r = build_sized(n_segment, carries);
    int count = BOUGH_ROD_STATES * r.model->n;
    for (bough_level level = BOUGH_LEVEL_V2; level < BOUGH_LEVEL_COUNT; level++) {
        if (!bough_level_runs(level)) continue;
        r.model->level = level;
        double *rate = level == BOUGH_LEVEL_V2 ? r.rate : r.moved;
        for (int k = 0; k < count; k++) rate[k] = NAN;
        assert_true(bough_rod_derivative(r.model, &r.loads, 0.5, r.state, r.input, &r.scratch, rate));
        for (int k = 0; k < count; k++) check_near(rate[k], r.rate[k], 1e-9, 1e-9);
    }
    bough_arena_destroy(r.arena);
}

TEST(rates_are_the_same_at_each_level_for_any_number_of_segments) {
    for (int n = 1; n <= 25; n++) {
        check_rates(n, false);
        if (n > 1) check_rates(n, true);
    }
}

// What is left out depends on neither time nor input.
TEST(second_evaluation_at_a_state_is_the_same) {
    for (int carries = 0; carries < 2; carries++) {
        sized r = build_sized(11, carries);
        int count = BOUGH_ROD_STATES * r.model->n;
        const bough_rod_loads *l = &r.loads;
        bough_rod_derivative(r.model, l, 0.5, r.state, r.input, &r.scratch, r.rate);
        for (int k = 0; k < 12; k++) r.input[k] += 0.1 * k - 0.3;
        assert_true(bough_rod_derivative_again(r.model, l, 0.75, r.state, r.input, &r.scratch, r.x));
        assert_true(bough_rod_derivative(r.model, l, 0.75, r.state, r.input, &r.scratch, r.rate));
        for (int k = 0; k < count; k++) check_near(r.x[k], r.rate[k], 1e-12, 1e-12);
        bough_arena_destroy(r.arena);
    }
}

// Half of the ramp is reached at the time of evaluation.
static bough_rod_ramped_load *ramped(fixture *f, bool follower) {
    const bough_schedule ramp = {.start = 0.25, .end = 0.75};
    bough_rod_ramped_load *l = bough_rod_loads_ramped(&f->loads, f->arena, f->model, follower, &ramp);
    assert_non_null(l);
    assert_ptr_equal(l, bough_rod_loads_ramped(&f->loads, f->arena, f->model, follower, &ramp));
    return l;
}

// Random loads along all segments, dead ones and followers, and strains by them.
static void lay_along(fixture *f) {
    unsigned seed = 23;
    bough_rod_ramped_load *load[2] = {ramped(f, true), ramped(f, false)};
    for (int k = 0; k < 36 * f->model->stride; k++) f->model->line[k] = 0.05 * sample_random(&seed);
    for (int kind = 0; kind < 2; kind++) {
        load[kind]->along = true;
        for (int k = 0; k < 6 * f->model->stride; k++) load[kind]->line[k] = 5 * sample_random(&seed);
    }
}

TEST_WITH(second_evaluation_knows_loads_along_segments, setup, teardown) {
    fixture *f = *context;
    double first[STATES], again[STATES];
    lay_along(f);
    derivative(f, f->state, f->input, first);
    assert_true(bough_rod_derivative_again(f->model, &f->loads, 0.7, f->state, f->input, &f->scratch, again));
    assert_true(bough_rod_derivative(f->model, &f->loads, 0.7, f->state, f->input, &f->scratch, first));
    for (int k = 0; k < STATES; k++) check_near(again[k], first[k], 1e-12, 1e-12);
}

// Between the two the coupled bodies ask for the wrench at the later time.
TEST_WITH(second_evaluation_is_no_other_after_a_wrench, setup, teardown) {
    fixture *f = *context;
    double first[STATES], again[2][STATES], wrench[6], change = 0;
    unsigned seed = 29;
    f->loads.moving = true;
    for (int k = 0; k < 6 * f->model->stride; k++) f->loads.rest_rate[k] = 0.01 * sample_random(&seed);
    for (int asked = 0; asked < 2; asked++) {
        derivative(f, f->state, f->input, first);
        if (asked) {
            bough_rod_wrenches(f->model, &f->loads, 0.7, f->state, f->input, &f->scratch, wrench);
        }
        assert_true(bough_rod_derivative_again(f->model, &f->loads, 0.7, f->state, f->input, &f->scratch,
                                               again[asked]));
    }
    for (int k = 0; k < STATES; k++) {
        assert_true(again[0][k] == again[1][k]);
        change = fmax(change, fabs(again[0][k] - first[k]));
    }
    assert_true(change > 1e-3);
}

// A follower load is at every state the dead load that its section's rotation makes of it.
TEST_WITH(follower_load_turns_with_its_section, setup, teardown) {
    fixture *f = *context;
    int s = f->model->stride;
    unsigned seed = 8;
    double with[STATES], same[STATES], wrench[2][6];
    double *value = ramped(f, true)->value;
    for (int k = 0; k < 6 * s; k++) value[k] = sample_random(&seed);
    derivative(f, f->state, f->input, with);
    bough_rod_wrenches(f->model, &f->loads, 0.5, f->state, f->input, &f->scratch, wrench[0]);
    f->loads.ramped = NULL;
    for (int i = 0; i <= N; i++) {
        bough_quaternion p = f->model->rotation0[0];
        const double *y = f->state + i - 1;
        if (i > 0) p = (bough_quaternion){y[3 * N], y[4 * N], y[5 * N], y[6 * N]};
        bough_mat3 r = bough_rotation_matrix(bough_quaternion_normalised(p));
        for (int c = 0; c < 6; c += 3) {
            bough_vec3 part = {value[c * s + i], value[(c + 1) * s + i], value[(c + 2) * s + i]};
            part = bough_scale(0.5, bough_mat3_mul(r, part));
            f->loads.value[c * s + i] += part.x;
            f->loads.value[(c + 1) * s + i] += part.y;
            f->loads.value[(c + 2) * s + i] += part.z;
        }
    }
    derivative(f, f->state, f->input, same);
    bough_rod_wrenches(f->model, &f->loads, 0.5, f->state, f->input, &f->scratch, wrench[1]);
    for (int k = 0; k < STATES; k++) check_near(with[k], same[k], 1e-12, 1e-12);
    for (int k = 0; k < 6; k++) check_near(wrench[0][k], wrench[1][k], 1e-12, 1e-12);
}

// p and −p are the same rotation at any vertex.
TEST_WITH(quaternion_sign_does_not_matter, setup, teardown) {
    fixture *f = *context;
    double a[STATES], b[STATES];
    derivative(f, f->state, f->input, a);
    for (int c = 3; c < 7; c++) f->state[c * N + 3] *= -1;
    derivative(f, f->state, f->input, b);
    for (int k = 7 * N; k < STATES; k++) check_near(b[k], a[k], 0, 1e-12 * fabs(a[k]) + 1e-12);
}

// A rod carried by a turning frame moves as the same rod seen from the frame at rest.
TEST_WITH(motion_does_not_depend_on_the_frame, setup, teardown) {
    fixture *f = *context;
    double rate[STATES], seen[STATES], still[BOUGH_ROD_INPUTS] = {0, 0, 0, 0, 0, 0, 1, -2, -9};
    // the first segment would feel the root's motion: compare the vertices beyond it
    derivative(f, f->state, still, rate);
    derivative(f, f->state, f->input, seen);
    bough_vec3 omega = {f->input[3], f->input[4], f->input[5]};
    for (int i = 1; i < N; i++) {
        bough_vec3 u = {f->state[7 * N + i], f->state[8 * N + i], f->state[9 * N + i]};
        bough_vec3 turn = bough_cross(omega, u);
        check_near(seen[7 * N + i] + turn.x, rate[7 * N + i], 1e-12, 1e-12);
        check_near(seen[8 * N + i] + turn.y, rate[8 * N + i], 1e-12, 1e-12);
        check_near(seen[10 * N + i], rate[10 * N + i], 1e-12, 1e-12);
    }
}

TEST_WITH(overturned_segment_is_refused, setup, teardown) {
    fixture *f = *context;
    double rate[STATES];
    double half[4] = {0, 1, 0, 0};
    for (int c = 0; c < 4; c++) f->state[(3 + c) * N + 4] = half[c];
    bool ok = bough_rod_derivative(f->model, &f->loads, 0, f->state, f->input, &f->scratch, rate);
    assert_false(ok);
}
