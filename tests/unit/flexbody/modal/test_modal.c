// Modal bodies against the rod they stand for, and against the laws of conservation.

#include "cosim/signal.h"
#include "flexbody/rod/rod_modes.h"
#include "flexbody/section/section.h"
#include "tests/unit/contract.h"
#include "tests/unit/sample_rod.h"
#include "tests/verification/modal_static.h"

enum { N = 5 };

static const double swaying[BOUGH_ROD_INPUTS] = {0.4, -0.3, 0.7, 0.5, -0.8, 0.6, 1, -2, -9};
static const double at_rest[BOUGH_ROD_INPUTS] = {0};
static const bough_modal_options everything = {6 * N, true, false};

static bough_modal_model *general(bough_arena *arena, int n, int pieces, bough_modal_options options) {
    bough_rod_def def = sample_def(n, sample_general_arrays(arena, n), false);
    bough_modal_model *m = NULL;
    check_ok(bough_modal_create(arena, &def, pieces, options, &m));
    return m;
}

static bough_modal_body *body_of(bough_arena *arena, const bough_modal_model *m, const double *input) {
    return bough_modal_body_create(arena, m, input);
}

// -- the contract ---------------------------------------------------------------------------------

static void check_contract(int pieces, bough_modal_options options) {
    check_arena(arena);
    bough_modal_model *m = general(arena, 7, pieces, options);
    bough_modal_body *body = body_of(arena, m, swaying);
    bough_system s = bough_modal_body_system(body);
    double *state = bough_arena_doubles(arena, (size_t)m->n_state);
    unsigned seed = 3;
    for (int k = 0; k < m->n_state; k++) state[k] = s.initial[k] + 0.1 * s.scale[k] * sample_random(&seed);
    sample_loads(m->rod, bough_modal_body_loads(body));
    contract_point at = {0.5, state, swaying, 1e-5};
    bough_member *body_member =
        member_of(arena, &s, (bough_integrator_options){.kind = BOUGH_CVODE_BDF, .rtol = 1e-8});
    contract_check(body_member, at, 0.03, 0.01);
    contract_set_state(body_member, at, 1e-5);
}

TEST(operations_of_one_piece_agree) {
    check_contract(1, (bough_modal_options){5, true, true});
    check_contract(1, (bough_modal_options){3, false, false});
}

TEST(operations_of_a_chain_agree) {
    check_contract(3, (bough_modal_options){4, true, true});
    check_contract(7, (bough_modal_options){6, false, true});
}

// -- all shapes: the rod to first order -----------------------------------------------------------

typedef struct pair {
    bough_arena *arena;
    bough_modal_body *modal;
    bough_rod_model *rod;
    bough_rod_scratch scratch;
    bough_rod_loads loads;
} pair;

static pair make_pair(int pieces) {
    pair p = {.arena = check_memory()};
    p.modal = body_of(p.arena, general(p.arena, N, pieces, everything), swaying);
    p.rod = sample_general(p.arena, N);
    bough_rod_scratch_init(&p.scratch, p.arena, p.rod);
    bough_rod_loads_init(&p.loads, p.arena, p.rod);
    return p;
}

// Differences of the vertices' rates and of the root wrench, rod less modal, with a motion relative
// to the frame and loads of size `small`.
static void compare(pair *p, double small, double *rates, double *wrenches) {
    enum { STATES = BOUGH_ROD_STATES * N };
    double y[200], ahead[200], rate[200], state[STATES], moved[2][STATES];
    double expected[STATES], wrench[6], other[6];
    const double step = 1e-6;
    bough_rod_loads *const loads[] = {&p->loads, bough_modal_body_loads(p->modal)};
    bough_system s = bough_modal_body_system(p->modal);
    unsigned seed = 9;
    assert_true(s.n_state <= 200);
    for (int body = 0; body < 2; body++) {
        sample_loads(p->rod, loads[body]);
        for (int k = 0; k < 6 * p->rod->stride; k++) loads[body]->value[k] *= small;
        for (int k = 0; k < 6 * p->rod->stride; k++) loads[body]->rate[k] *= small;
    }
    for (int k = 0; k < s.n_state; k++) y[k] = s.initial[k] + small * sample_random(&seed);
    s.ops->derivative(s.self, 0.5, y, swaying, rate);
    s.ops->output(s.self, 0.5, y, swaying, wrench);
    for (int side = 0; side < 2; side++) {
        for (int k = 0; k < s.n_state; k++) ahead[k] = y[k] + (side == 0 ? step : -step) * rate[k];
        memcpy(moved[side], bough_modal_body_vertices(p->modal, ahead, swaying, 1), sizeof state);
    }
    memcpy(state, bough_modal_body_vertices(p->modal, y, swaying, 1), sizeof state);
    bough_rod_derivative(p->rod, &p->loads, 0.5, state, swaying, &p->scratch, expected);
    bough_rod_wrenches(p->rod, &p->loads, 0.5, state, swaying, &p->scratch, other);
    *rates = *wrenches = 0;
    for (int k = 0; k < STATES; k++) {
        *rates = fmax(*rates, fabs((moved[0][k] - moved[1][k]) / (2 * step) - expected[k]));
    }
    for (int k = 0; k < 6; k++) *wrenches = fmax(*wrenches, fabs(wrench[k] - other[k]));
}

static void check_second_order(int pieces) {
    double rates[2], wrenches[2];
    pair p = make_pair(pieces);
    compare(&p, 1e-2, &rates[0], &wrenches[0]);
    compare(&p, 5e-3, &rates[1], &wrenches[1]);
    check_near(rates[0] / rates[1], 4, 0.1, 0);
    check_near(wrenches[0] / wrenches[1], 4, 0.1, 0);
    bough_arena_destroy(p.arena);
}

TEST(errors_with_all_shapes_are_of_second_order) {
    check_second_order(1);
    check_second_order(2);
    check_second_order(N);
}

// -- frequencies and statics against the rod ------------------------------------------------------

enum { SEGMENTS = 16, WANTED = 8 };

// A blade-like bar along z, 60 m long: soft in x, stiffer in y, no damping.
static bough_rod_def bar_def(bough_arena *arena) {
    bough_section_station section = {
        .stiffness = {[0] = 1e9, [6] = 1e9, [11] = 8e9, [15] = 4e9, [18] = 1e9, [20] = 1e8},
        .mass = 300,
        .inertia = {400, 100, 0, 500}};
    bough_section_table table = {.name = "bar", .n_station = 1, .station = &section, .length = 60};
    bough_rod_def def;
    check_ok(bough_section_discretise(arena, &table, SEGMENTS, &def));
    return def;
}

typedef struct bar {
    bough_arena *arena;
    bough_rod_def def;
    bough_rod_model *rod;
    bough_modal_body *modal;
    bough_rod_static work;
    bough_rod_loads loads;
    double *state, *vertices; // of the modal body, of the rod
} bar;

static bar make_bar(int pieces, bough_modal_options options) {
    bar b = {.arena = check_memory()};
    bough_modal_model *model = NULL;
    b.def = bar_def(b.arena);
    check_ok(bough_rod_create(b.arena, &b.def, &b.rod));
    check_ok(bough_modal_create(b.arena, &b.def, pieces, options, &model));
    b.modal = body_of(b.arena, model, at_rest);
    bough_rod_static_init(&b.work, b.arena, b.rod);
    bough_rod_loads_init(&b.loads, b.arena, b.rod);
    b.state = bough_arena_doubles(b.arena, (size_t)model->n_state);
    b.vertices = bough_arena_doubles(b.arena, (size_t)BOUGH_ROD_STATES * b.rod->n);
    return b;
}

static void rest_rod(bar *b, const double *input) {
    bough_rod_rest_state(b->rod, input, b->vertices);
    check_ok(bough_rod_steady(b->rod, &b->loads, input, &b->work, b->vertices));
}

static void rest_modal(bar *b, const double *input) {
    memset(b->state, 0, (size_t)bough_modal_body_model(b->modal)->n_state * sizeof *b->state);
    memcpy(bough_modal_body_loads(b->modal)->value, b->loads.value,
           6 * (size_t)b->rod->stride * sizeof(double));
    bough_modal_body_move_rigidly(b->modal, input, b->state);
    check_ok(bough_modal_steady(b->modal, 0, input, b->arena, b->state));
}

static void frequencies(bar *b, const double *input, double *rod, double *modal) {
    bough_rod_mode_list list = {.wanted = WANTED};
    int found = 0;
    rest_rod(b, input);
    rest_modal(b, input);
    check_ok(bough_rod_modes(b->arena, b->rod, &b->work, input, b->vertices, &list));
    check_ok(bough_modal_frequencies(b->arena, b->modal, 0, input, b->state, WANTED, modal, &found));
    assert_int_equal(list.found, WANTED);
    assert_int_equal(found, WANTED);
    for (int k = 0; k < WANTED; k++) rod[k] = list.mode[k].frequency;
}

// All shapes: those of the same mesh. Twelve: the clamped modes are among the shapes as they are.
TEST(frequencies_at_rest_are_the_rods) {
    static const bough_modal_options options[] = {{6 * SEGMENTS, false, true}, {12, true, true}};
    for (int k = 0; k < 2; k++) {
        double rod[WANTED], modal[WANTED];
        bar b = make_bar(1, options[k]);
        frequencies(&b, at_rest, rod, modal);
        for (int i = 0; i < WANTED; i++) check_near(modal[i], rod[i], 1e-9, 0);
        bough_arena_destroy(b.arena);
    }
}

// About the axis x through a point 1.5 m below the root, as in a rotor; Southwell: stiffened.
TEST(rotation_stiffens_as_it_does_the_rod) {
    const double omega = 1.6, input[BOUGH_ROD_INPUTS] = {0, -1.5 * 1.6, 0, omega, 0, 0, 0, 0, 0};
    double rest[WANTED], rod[WANTED], modal[WANTED], plain[WANTED], unused[WANTED];
    bar b = make_bar(1, (bough_modal_options){12, true, true});
    frequencies(&b, at_rest, rest, unused);
    frequencies(&b, input, rod, modal);
    bar c = make_bar(1, (bough_modal_options){12, true, false});
    frequencies(&c, input, unused, plain);
    for (int i = 0; i < WANTED; i++) check_near(modal[i], rod[i], 1e-3, 0);
    assert_true(rod[0] > 1.1 * rest[0] && plain[0] < 1.001 * rest[0]);
}

// -- statics --------------------------------------------------------------------------------------

// The tip's flapwise displacement under a line load: modal less rod.
static double deflection_error(int pieces, double load, double *rod) {
    bar b = make_bar(pieces, (bough_modal_options){6, true, true});
    for (int i = 1; i <= SEGMENTS; i++) b.loads.value[i] = i < SEGMENTS ? load : load / 2;
    rest_rod(&b, at_rest);
    rest_modal(&b, at_rest);
    *rod = b.vertices[SEGMENTS - 1];
    double error = bough_modal_body_vertices(b.modal, b.state, at_rest, 1)[SEGMENTS - 1] - *rod;
    bough_arena_destroy(b.arena);
    return error;
}

TEST(linear_statics_err_by_the_cube_of_the_load) {
    double rod[2], large = deflection_error(1, 8e3, &rod[0]);
    double half = deflection_error(1, 4e3, &rod[1]);
    assert_true(large < 0.01 * rod[0] && large > 1e-4 * rod[0]);
    check_near(large / half, 8, 0.05, 0);
}

// Deflected by 7 % of the length; second order in the length of the pieces.
TEST(pieces_converge_to_the_bent_rod) {
    double rod, error[3];
    for (int k = 0; k < 3; k++) error[k] = deflection_error(2 << k, 1e4, &rod);
    assert_true(rod > 0.07 * 60);
    for (int k = 0; k < 2; k++) check_near(log2(error[k] / error[k + 1]), 2.15, 0.15, 0);
    assert_true(fabs(error[2]) < 1e-4 * rod);
}

// -- conservation ---------------------------------------------------------------------------------

// Momentum of the moving vertices, mass centres at the vertices, about the frame's origin.
static void momentum(const bough_rod_model *rod, const double *state, double *to) {
    bough_vec3 p = {0, 0, 0}, l = {0, 0, 0};
    int n = rod->n;
    for (int i = 0; i < n; i++) {
        const double *y = state + i, *j = rod->vertex[i + 1].inertia;
        bough_vec3 x = {y[0], y[n], y[2 * n]};
        bough_vec3 mu = bough_scale(rod->vertex[i + 1].mass, bough_v3(y[7 * n], y[8 * n], y[9 * n]));
        bough_vec3 w = {y[10 * n], y[11 * n], y[12 * n]};
        bough_quaternion q = {y[3 * n], y[4 * n], y[5 * n], y[6 * n]};
        bough_vec3 h = {j[0] * w.x + j[3] * w.y + j[4] * w.z, j[3] * w.x + j[1] * w.y + j[5] * w.z,
                        j[4] * w.x + j[5] * w.y + j[2] * w.z};
        h = bough_mat3_mul(bough_rotation_matrix(bough_quaternion_normalised(q)), h);
        p = bough_add(p, mu);
        l = bough_add(l, bough_add(bough_cross(x, mu), h));
    }
    bough_wrench_store((bough_wrench){p, l}, to);
}

// Loads on a body of few shapes in free motion less the rate of its momentum and its root wrench:
// what is lost of force and of moment. Little rotary inertia: of it the linear shapes lose ½ψ×ψ̈.
static void lost(double small, double *force, double *moment) {
    check_arena(arena);
    sample_arrays arrays = sample_general_arrays(arena, N);
    for (int i = 0; i <= N; i++) {
        arrays.inertia[i].moment = bough_v3(0, 0, 0);
        for (int c = 0; c < 6; c++) arrays.inertia[i].inertia[c] *= 1e-5;
    }
    bough_rod_def def = sample_def(N, arrays, false);
    bough_modal_model *m = NULL;
    check_ok(bough_modal_create(arena, &def, 1, (bough_modal_options){4, false, true}, &m));
    bough_modal_body *body = body_of(arena, m, swaying);
    bough_system s = bough_modal_body_system(body);
    double y[60], rate[60], moved[60], p[3][6], root[6];
    const double step = 1e-6;
    unsigned seed = 2;
    assert_true(m->n_state <= 60);
    for (int k = 0; k < m->n_state; k++) y[k] = s.initial[k] + small * sample_random(&seed);
    s.ops->derivative(body, 0, y, swaying, rate);
    s.ops->output(body, 0, y, swaying, root);
    for (int side = -1; side <= 1; side++) {
        for (int k = 0; k < m->n_state; k++) moved[k] = y[k] + side * step * rate[k];
        momentum(m->rod, bough_modal_body_vertices(body, moved, swaying, 1), p[side + 1]);
    }
    bough_wrench held = bough_wrench_cross(bough_twist_load(swaying), bough_wrench_load(p[1]));
    bough_wrench left = bough_wrench_add(bough_wrench_load(root), held);
    bough_vec3 g = {swaying[6], swaying[7], swaying[8]};
    const double *vertices = bough_modal_body_vertices(body, y, swaying, 1);
    for (int i = 0; i < N; i++) {
        bough_vec3 w = bough_scale(m->rod->vertex[i + 1].mass, g);
        bough_vec3 x = {vertices[i], vertices[N + i], vertices[2 * N + i]};
        left = bough_wrench_sub(left, (bough_wrench){w, bough_cross(x, w)});
    }
    double rest[6];
    bough_wrench_store(left, rest);
    *force = *moment = 0;
    for (int c = 0; c < 6; c++) {
        double *to = c < 3 ? force : moment;
        *to = fmax(*to, fabs(rest[c] + (p[2][c] - p[0][c]) / (2 * step)));
    }
}

// Of force nothing, of moment what is of second order in q, whatever the number of shapes.
TEST(few_shapes_keep_momentum) {
    double force[2], moment[2];
    lost(1e-2, &force[0], &moment[0]);
    lost(5e-3, &force[1], &moment[1]);
    assert_true(force[0] < 1e-7 && moment[1] < 1e-3);
    check_near(moment[0] / moment[1], 4, 0.2, 0);
}

// Loads that bend over a step act as they are: the tip follows them whether the step is taken in one or in
// eight.
TEST(loads_bend_over_a_step) {
    const double still[BOUGH_ROD_INPUTS] = {0};
    const int parts[2] = {1, 8};
    double reached[2];
    for (int k = 0; k < 2; k++) {
        bough_arena *arena = bough_arena_create();
        bough_modal_model *m = general(arena, 7, 1, (bough_modal_options){3, false, false});
        bough_modal_body *body = body_of(arena, m, still);
        bough_modal_body_loads(body)->curve[m->rod->n] = 1e3; // along x at the tip
        bough_system s = bough_modal_body_system(body);
        bough_member *member =
            member_of(arena, &s, (bough_integrator_options){.kind = BOUGH_ROSENBROCK, .rtol = 1e-9});
        bough_signal input = bough_signal_create(arena, BOUGH_ROD_INPUTS);
        for (int i = 0; i < parts[k]; i++) {
            input.t0 = 0.02 * i / parts[k];
            input.t1 = 0.02 * (i + 1) / parts[k];
            check_ok(bough_member_advance(member, input.t1, &input, i == 0));
        }
        reached[k] = bough_modal_body_vertices(body, member->state, still, m->rod->n)[m->rod->n - 1] -
                     m->rod->position0[m->rod->n].x;
        bough_arena_destroy(arena);
    }
    assert_true(reached[0] > 0);
    check_near(reached[0], reached[1], 1e-4, 0);
}
