// Condensed interfaces of random linear members against the system as a whole.
#include "core/base/linalg.h"
#include "cosim/scheme.h"
#include "cosim/whole.h"
#include "tests/unit/sample_numbers.h"

enum { MOST = 12, MEMBERS = 4, STATES = MEMBERS * MOST, PORTS = MEMBERS * MOST };

// ẏ = A y + B u, o = C y + D u
typedef struct member {
    bough_system s;
    bough_member m;
    double a[MOST * MOST], b[MOST * MOST], c[MOST * MOST], d[MOST * MOST];
    double matrix[MOST * MOST], state[MOST];
    int pivot[MOST];
} member;

static void add_product(int rows, int columns, const double *m, const double *x, double *sum) {
    for (int i = 0; i < rows && x != NULL; i++) {
        for (int j = 0; j < columns; j++) sum[i] += m[i * MOST + j] * x[j];
    }
}

static bool derivative(void *self, double t, const double *y, const double *u, double *rate) {
    (void)t;
    const member *m = self;
    memset(rate, 0, (size_t)m->s.n_state * sizeof(double));
    add_product(m->s.n_state, m->s.n_state, m->a, y, rate);
    add_product(m->s.n_state, m->s.n_input, m->b, u, rate);
    return true;
}

static void output(void *self, double t, const double *y, const double *u, double *out) {
    (void)t;
    const member *m = self;
    memset(out, 0, (size_t)m->s.n_output * sizeof(double));
    add_product(m->s.n_output, m->s.n_state, m->c, y, out);
    add_product(m->s.n_output, m->s.n_input, m->d, u, out);
}

// NOLINTNEXTLINE(readability-function-size): the contract fixes the parameters
static void output_tangent(void *self, double t, const double *y, const double *u, const double *state_rate,
                           const double *input_rate, double *rate) {
    (void)y, (void)u;
    output(self, t, state_rate, input_rate, rate);
}

static void input_columns(void *self, double t, const double *y, const double *u, double *column) {
    (void)t, (void)y, (void)u;
    const member *m = self;
    for (int j = 0; j < m->s.n_input; j++) {
        for (int i = 0; i < m->s.n_state; i++) *column++ = m->b[i * MOST + j];
    }
}

static void *factors(void *self, bough_arena *arena) {
    (void)arena;
    return self;
}

static bool linearise(void *self, double t, const double *y, const double *u, void *factors) {
    (void)self, (void)t, (void)y, (void)u, (void)factors;
    return true;
}

static bool factor(void *self, void *factors, double gamma) {
    (void)factors;
    member *m = self;
    int n = m->s.n_state;
    for (int j = 0; j < n; j++) {
        for (int i = 0; i < n; i++) m->matrix[j * n + i] = (i == j) - gamma * m->a[i * MOST + j];
    }
    return n == 0 || bough_dense_factor(n, m->matrix, m->pivot);
}

static void solve(void *self, void *factors, double *x) {
    (void)factors;
    const member *m = self;
    if (m->s.n_state > 0) bough_dense_solve(m->s.n_state, 1, m->matrix, m->pivot, x);
}

static void make(member *m, int n_state, int n_input, int n_output, bool feedthrough, unsigned seed) {
    static const bough_system_ops ops = {BOUGH_SYSTEM_REQUIRED};
    static const double scale[MOST] = {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1};
    *m = (member){.s = {.name = "member",
                        .n_state = n_state,
                        .n_input = n_input,
                        .n_output = n_output,
                        .scale = scale,
                        .ops = &ops,
                        .self = m}};
    m->m = (bough_member){.system = m->s, .state = m->state};
    for (int k = 0; k < MOST * MOST; k++) {
        m->a[k] = sample_random(&seed);
        m->b[k] = sample_random(&seed);
        m->c[k] = sample_random(&seed);
        m->d[k] = feedthrough ? .3 * sample_random(&seed) : 0;
    }
}

typedef struct plan {
    const char *what;
    int n_state[MEMBERS], n_input[MEMBERS], n_output[MEMBERS], stage[MEMBERS];
    bool feedthrough[MEMBERS];
    int n_connection;
    const bough_connection *connection;
    int unknowns; // of the interface
} plan;

static bough_assembly *build(bough_arena *arena, const plan *p, member m[MEMBERS]) {
    bough_assembly_member part[MEMBERS];
    for (int i = 0; i < MEMBERS; i++) {
        make(&m[i], p->n_state[i], p->n_input[i], p->n_output[i], p->feedthrough[i], 7u + i);
        part[i] = (bough_assembly_member){&m[i].m, p->stage[i]};
    }
    bough_assembly_def def = {MEMBERS, part, p->n_connection, p->connection};
    bough_assembly *a = NULL;
    bough_status status = bough_assembly_build(arena, &def, &a);
    if (!bough_is_ok(&status)) fail_msg("%s: %s", p->what, status.message);
    return a;
}

static void check(const plan *p) {
    check_arena(arena);
    member m[MEMBERS];
    bough_assembly *a = build(arena, p, m);
    bough_whole *whole = bough_whole_create(arena, a, NULL);
    assert_int_equal(whole->interface->n, p->unknowns);

    unsigned seed = 3;
    double y[STATES], r[STATES], x[STATES], before[STATES], after[STATES];
    double input[PORTS], gamma = .2;
    for (int k = 0; k < a->n_state; k++) y[k] = sample_random(&seed), r[k] = x[k] = sample_random(&seed);
    bough_whole_rate(whole, 0, y, before);
    memcpy(input, whole->input, (size_t)a->n_input * sizeof(double));
    check_ok(bough_whole_setup(whole, 0, y, input, gamma));
    bough_whole_solve(whole, x);

    // x = r + γ (A x + B δu) member by member, δu = P (C x + D δu)
    double change[PORTS], answer[PORTS];
    for (int i = 0; i < MEMBERS; i++) {
        const double *du = whole->change + a->input_offset[i], *dx = x + a->state_offset[i];
        output(&m[i], 0, dx, du, answer + a->output_offset[i]);
        derivative(&m[i], 0, dx, du, after + a->state_offset[i]);
    }
    for (int j = 0; j < a->n_input; j++) change[j] = answer[a->source[j]];
    for (int j = 0; j < a->n_input; j++) check_near(whole->change[j], change[j], 0, 1e-9);
    for (int k = 0; k < a->n_state; k++) check_near(x[k] - gamma * after[k], r[k], 0, 1e-9);
}

// Three followers on one leader.
static const bough_connection star[] = {{0, 0, 1, 0, 4, true},  {0, 4, 2, 0, 4, true},
                                        {0, 8, 3, 0, 4, true},  {1, 0, 0, 0, 3, false},
                                        {2, 0, 0, 3, 3, false}, {3, 0, 0, 6, 3, false}};

#define ON_STAR .n_input = {9, 4, 4, 4}, .n_output = {12, 3, 3, 3}, .n_connection = 6, .connection = star
static const plan plans[] = {{.what = "three on a leader of two states, along these",
                              .n_state = {2, 7, 6, 5},
                              .stage = {0, 1, 1, 1},
                              .feedthrough = {false, true, true, false},
                              .unknowns = 2,
                              ON_STAR},
                             {.what = "a leader of many states, by its inputs",
                              .n_state = {12, 7, 6, 5},
                              .stage = {0, 1, 1, 2},
                              .feedthrough = {false, true, true, false},
                              .unknowns = 9,
                              ON_STAR},
                             {.what = "a leader that answers at once",
                              .n_state = {2, 7, 6, 5},
                              .stage = {0, 1, 1, 1},
                              .feedthrough = {true, false, false, false},
                              .unknowns = 9,
                              ON_STAR},
                             {.what = "two leaders, one follower on both, one leader without states",
                              .n_state = {2, 0, 6, 5},
                              .n_input = {3, 3, 4, 4},
                              .n_output = {6, 2, 4, 2},
                              .stage = {0, 0, 1, 1},
                              .feedthrough = {false, false, true, true},
                              .n_connection = 6,
                              .unknowns = 2,
                              .connection = (const bough_connection[]){{0, 0, 2, 0, 2, true},
                                                                       {1, 0, 2, 2, 2, true},
                                                                       {0, 2, 3, 0, 4, true},
                                                                       {2, 0, 0, 0, 3, false},
                                                                       {2, 3, 1, 0, 1, false},
                                                                       {3, 0, 1, 1, 2, false}}},
                             {.what = "followers connected with each other lead",
                              .n_state = {2, 7, 6, 5},
                              .n_input = {3, 4, 4, 2},
                              .n_output = {6, 6, 3, 3},
                              .stage = {0, 1, 1, 1},
                              .feedthrough = {false, true, false, false},
                              .n_connection = 5,
                              .unknowns = 2 + 4 + 4,
                              .connection = (const bough_connection[]){{0, 0, 1, 0, 4, true},
                                                                       {0, 4, 3, 0, 2, true},
                                                                       {1, 0, 2, 0, 4, true},
                                                                       {2, 0, 0, 0, 2, false},
                                                                       {3, 0, 0, 2, 1, false}}}};

TEST(every_shape_solves_the_whole) {
    for (size_t k = 0; k < sizeof plans / sizeof *plans; k++) check(&plans[k]);
}

// Steps by stages, member by member, against those of the whole system by itself.
static void check_stages(const plan *p) {
    check_arena(arena);
    member m[MEMBERS];
    unsigned seed = 5;
    bough_assembly *a = build(arena, p, m);
    for (int i = 0; i < MEMBERS; i++)
        for (int k = 0; k < p->n_state[i]; k++) m[i].state[k] = sample_random(&seed);
    bough_scheme_options options = bough_scheme_options_default();
    options.name = "monolithic";
    options.integrator = (bough_integrator_options){.kind = BOUGH_ROSENBROCK, .rtol = 1, .step = .01};
    bough_system system = bough_whole_system(arena, a, NULL, "whole");
    bough_member whole;
    bough_coupling *c;
    check_ok(bough_member_create(arena, &system, 0, &options.integrator, &whole));
    check_ok(bough_member_advance(&whole, .05, NULL, true));
    check_ok(bough_scheme_couple(arena, a, &options, NULL, &c));
    c->t1 = .05;
    c->restart = true;
    check_ok(bough_scheme_step(c));
    for (int i = 0; i < MEMBERS; i++)
        for (int k = 0; k < p->n_state[i]; k++)
            check_near(m[i].state[k], whole.state[a->state_offset[i] + k], 0, 1e-12);
}

TEST(every_shape_steps_by_stages_as_the_whole) {
    for (size_t k = 0; k < sizeof plans / sizeof *plans; k++) check_stages(&plans[k]);
}

// The gain of the interface.
TEST(radius_is_that_of_the_loop) {
    check_arena(arena);
    member m[2];
    make(&m[0], 2, 3, 3, false, 1);
    make(&m[1], 4, 3, 3, false, 2);
    const bough_assembly_member part[] = {{&m[0].m, 0}, {&m[1].m, 1}};
    const bough_connection connection[] = {{0, 0, 1, 0, 3, true}, {1, 0, 0, 0, 3, false}};
    bough_assembly_def def = {2, part, 2, connection};
    bough_assembly *a;
    bough_interface *k;
    check_ok(bough_assembly_build(arena, &def, &a));
    k = bough_interface_create(arena, a);
    const double zero[MOST] = {0};
    bough_operating_point at = {.state = zero, .input = zero, .gamma = .4};
    for (int i = 0; i < 2; i++) assert_true(bough_interface_linearise(k, i, &at));
    for (int i = 0; i < 2; i++) assert_true(bough_interface_factor(k, i, &at));
    bough_interface_respond(k, 1, &at);
    assert_true(bough_interface_close(k));
    // the larger root of the 2 × 2 loop
    assert_true(fabs(k->loop[0]) > 1e-3);
    double trace = k->loop[0] + k->loop[3];
    double det = k->loop[0] * k->loop[3] - k->loop[1] * k->loop[2];
    double square = .25 * trace * trace - det;
    double radius = square > 0 ? .5 * fabs(trace) + sqrt(square) : sqrt(det);
    check_near(bough_interface_radius(k), radius, 1e-9, 0);
}
