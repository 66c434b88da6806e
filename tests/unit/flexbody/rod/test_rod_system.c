// The rod behind the contract: its operations against each other, and its motion by its own steps
// against beam theory and the laws of conservation.

#include "core/base/linalg.h"
#include "flexbody/rod/rod_system.h"
#include "flexbody/section/section.h"
#include "tests/unit/contract.h"
#include "tests/unit/rod_energy.h"
#include "tests/unit/sample_rod.h"

enum { N = 5, STATES = BOUGH_ROD_STATES * N };

typedef struct rod {
    bough_arena *arena;
    bough_rod_model *model;
    bough_rod_body *body;
    bough_system s;
    bough_member *m;
} rod;

static const double at_rest[BOUGH_ROD_INPUTS] = {0};

static rod make(bough_arena *arena, bough_rod_model *model, double rtol, const double *input) {
    rod r = {.arena = arena, .model = model};
    r.body = bough_rod_body_create(arena, model, input);
    r.s = bough_rod_body_system(r.body);
    r.m = member_of(arena, &r.s, (bough_integrator_options){.kind = BOUGH_CVODE_BDF, .rtol = rtol});
    return r;
}

static rod general(double rtol, const double *input) {
    bough_arena *arena = check_memory();
    return make(arena, sample_general(arena, N), rtol, input);
}

// Advances to t1 under value + rate (t − now), rate may be NULL.
static void advance(const rod *r, double t1, const double *value, const double *rate) {
    double c[4 * BOUGH_ROD_INPUTS] = {0}, t0 = r->m->time;
    for (int k = 0; k < BOUGH_ROD_INPUTS; k++) {
        c[k] = value[k];
        if (rate != NULL) c[BOUGH_ROD_INPUTS + k] = rate[k] * (t1 - t0);
    }
    bough_signal input = {BOUGH_ROD_INPUTS, t0, t1, c};
    check_ok(bough_member_advance(r->m, t1, &input, false));
}

static bough_vec3 part(const double *state, int n, int component, int vertex) {
    const double *x = state + component * n + vertex - 1;
    return bough_v3(x[0], x[n], x[2 * n]);
}

static bough_quaternion turn_of(const double *state, int n, int vertex) {
    const double *x = state + BOUGH_ROD_P * n + vertex - 1;
    return bough_quaternion_normalised((bough_quaternion){x[0], x[n], x[2 * n], x[3 * n]});
}

// -- the contract ---------------------------------------------------------------------------------

// Loads that follow the motion of the vertices, about their rotations in the state.
static void follow_motion(const bough_rod_model *m, const double *state, bough_rod_loads *loads) {
    unsigned seed = 27;
    int s = m->stride;
    loads->damped = true;
    for (int v = 1; v <= N; v++) {
        for (int k = 0; k < 12; k++) loads->slope[k * s + v] = 5 * sample_random(&seed);
        bough_quaternion p = turn_of(state, N, v);
        const double row[4] = {-2 * p.z, 2 * p.y, -2 * p.x, 2 * p.w};
        for (int k = 0; k < 4; k++) loads->angle[k * s + v] = row[k];
    }
}

// Under loads on vertices, dead and following their sections or their motion, then with loads along the
// segments that change in time.
TEST(operations_agree_on_a_deformed_loaded_rod) {
    static const double input[BOUGH_ROD_INPUTS] = {0.4, -0.3, 0.7, 0.5, -0.8, 0.6, 1, -2, -9};
    double state[STATES];
    rod r = general(1e-6, input);
    bough_rod_loads *loads = bough_rod_body_loads(r.body);
    sample_state(r.model, input, state);
    sample_loads(r.model, loads);
    contract_point at = {0.5, state, input, 1e-6};
    contract_check(r.m, at, 0.03, 0.01);
    // by another method
    bough_integrator_options steps = {.kind = BOUGH_ROSENBROCK, .rtol = 1e-3, .step = 2e-3};
    contract_check(member_of(r.arena, &r.s, steps), at, 0.03, 0.01);
    for (int i = 0; i < N; i++) { // advance normalises the quaternions
        bough_quaternion p = turn_of(state, N, i + 1);
        const double normal[4] = {p.w, p.x, p.y, p.z};
        for (int c = 0; c < 4; c++) state[(BOUGH_ROD_P + c) * N + i] = normal[c];
    }
    contract_set_state(r.m, at, 1e-5);
    follow_motion(r.model, state, loads);
    contract_check_system(&r.s, at, 0.03);
    loads->damped = false;
    sample_line(r.model);
    sample_loads_along(r.arena, r.model, loads);
    contract_check(r.m, at, 0.03, 0.01);
    loads->ramped = NULL; // the strains without stress still move
    contract_check(r.m, at, 0.03, 0.01);
}

TEST(starts_at_rest_relative_to_its_frame) {
    static const double input[BOUGH_ROD_INPUTS] = {1, 2, 3, 0.5, -0.8, 0.6, 0, 0, 0};
    rod r = general(1e-6, input);
    double expected[STATES];
    bough_rod_rest_state(r.model, input, expected);
    for (int k = 0; k < STATES; k++) check_near(r.m->state[k], expected[k], 0, 1e-15);
    assert_ptr_equal(r.model, bough_rod_body_model(r.body));
    assert_int_equal(r.s.n_state, STATES);
    check_near(r.m->time, 0, 0, 0);
}

static const double swaying[BOUGH_ROD_INPUTS] = {0.4, -0.3, 0.7, 0.5, -0.8, 0.6, 1, -2, -9};

// After a state is set or restored the old history is worth nothing, whether or not the caller says
// so: bits are those of a rod that never moved otherwise.
TEST(set_and_restored_states_start_anew) {
    double state[STATES], unit[STATES];
    rod a = general(1e-6, swaying), b = general(1e-6, swaying);
    sample_state(a.model, swaying, state);
    advance(&a, 0.2, swaying, NULL);
    bough_member_set(a.m, 1, state);
    bough_member_set(b.m, 1, state);
    memcpy(unit, b.m->state, sizeof unit);
    char *copy = member_save(a.arena, a.m);
    advance(&a, 1.1, swaying, NULL);
    advance(&b, 1.1, swaying, NULL);
    assert_memory_equal(a.m->state, b.m->state, sizeof state);
    advance(&a, 1.3, swaying, NULL);
    member_restore(a.m, copy);
    assert_memory_equal(a.m->state, unit, sizeof unit);
    advance(&a, 1.1, swaying, NULL);
    assert_memory_equal(a.m->state, b.m->state, sizeof state);
}

TEST(quaternions_leave_a_step_normalised) {
    double state[STATES];
    rod r = general(1e-4, swaying);
    sample_state(r.model, swaying, state);
    bough_member_set(r.m, 0, state);
    advance(&r, 0.1, swaying, NULL);
    for (int i = 0; i < N; i++) {
        double square = 0;
        for (int c = 0; c < 4; c++) square += pow(r.m->state[(BOUGH_ROD_P + c) * N + i], 2);
        check_near(square, 1, 1e-14, 0);
    }
}

// -- steady and free motion -----------------------------------------------------------------------

enum { SPUN = 8 };

// A rod along z in a frame turning about x: tension carries what lies beyond, N = ω² Σ (m z + s).
static double stretched(const bough_rod_model *m, double stiffness, double omega, double *z) {
    double tension[SPUN + 1] = {0};
    for (int i = 0; i <= SPUN; i++) z[i] = m->span[i];
    for (int sweep = 0; sweep < 200; sweep++) {
        tension[SPUN] = 0;
        for (int i = SPUN; i > 0; i--) {
            const bough_vertex_inertia *v = &m->vertex[i];
            tension[i - 1] = tension[i] + omega * omega * (v->mass * z[i] + v->moment.z);
        }
        for (int i = 1; i <= SPUN; i++) {
            z[i] = z[i - 1] + (m->span[i] - m->span[i - 1]) * (1 + tension[i - 1] / stiffness);
        }
    }
    return tension[0];
}

TEST(steady_rotation_stretches_and_stays) {
    static const double stiffness[6] = {4e3, 4e3, 1e3, 50, 60, 40};
    static const double inertia[4] = {2, 0.02, 0.03, 0.05};
    static const double input[BOUGH_ROD_INPUTS] = {0, 0, 0, 6};
    double z[SPUN + 1], state[BOUGH_ROD_STATES * SPUN], rate[BOUGH_ROD_STATES * SPUN], wrench[6];
    check_arena(arena);
    rod r = make(arena, sample_uniform(arena, SPUN, 2, stiffness, 1e-3, inertia), 1e-8, input);
    double tension = stretched(r.model, stiffness[2], input[3], z);
    assert_true(z[SPUN] > 2.1); // a stretch to speak of
    memcpy(state, r.m->state, sizeof state);
    for (int i = 1; i <= SPUN; i++) {
        state[2 * SPUN + i - 1] = z[i];
        state[(BOUGH_ROD_U + 1) * SPUN + i - 1] = -input[3] * z[i];
    }
    assert_true(r.s.ops->derivative(r.s.self, 0, state, input, rate));
    for (int k = 0; k < BOUGH_ROD_STATES * SPUN; k++) check_near(rate[k], 0, 0, 1e-9);
    r.s.ops->output(r.s.self, 0, state, input, wrench);
    const double pull[6] = {0, 0, tension, 0, 0, 0};
    for (int k = 0; k < 6; k++) check_near(wrench[k], pull[k], 1e-12, 1e-9);
    bough_member_set(r.m, 0, state);
    for (int k = 1; k <= 20; k++) advance(&r, 0.1 * k, input, NULL);
    for (int k = 0; k < BOUGH_ROD_STATES * SPUN; k++) {
        check_near(r.m->state[k], state[k], 0, 1e-6);
    }
}

// Root and gravity accelerate alike: nothing is strained, whatever the shape of the rod.
TEST(free_fall_strains_nothing) {
    static const double input[BOUGH_ROD_INPUTS] = {0, 0, 0, 0, 0, 0, 1, -2, -9};
    static const double rate[BOUGH_ROD_INPUTS] = {1, -2, -9};
    double start[STATES], wrench[6], end[BOUGH_ROD_INPUTS];
    rod r = general(1e-8, input);
    memcpy(start, r.m->state, sizeof start);
    advance(&r, 0.7, input, rate);
    for (int k = 0; k < BOUGH_ROD_U * N; k++) check_near(r.m->state[k], start[k], 0, 1e-7);
    for (int i = 1; i <= N; i++) {
        bough_vec3 u = part(r.m->state, N, BOUGH_ROD_U, i), w = part(r.m->state, N, BOUGH_ROD_W, i);
        check_vec3(u, bough_v3(0.7, -1.4, -6.3), 0, 1e-7);
        check_near(bough_norm(w), 0, 0, 1e-7);
    }
    for (int k = 0; k < BOUGH_ROD_INPUTS; k++) end[k] = input[k] + 0.7 * rate[k];
    r.s.ops->output(r.s.self, 0.7, r.m->state, end, wrench);
    for (int k = 0; k < 6; k++) check_near(wrench[k], 0, 0, 2e-5);
}

// The same motion in a frame that moves steadily, velocities apart.
TEST(steady_translation_changes_nothing) {
    static const double moving[BOUGH_ROD_INPUTS] = {3, -1, 2, 0, 0, 0, 0.5, 1, -2};
    static const double still[BOUGH_ROD_INPUTS] = {0, 0, 0, 0, 0, 0, 0.5, 1, -2};
    rod a = general(1e-9, still), b = general(1e-9, moving);
    advance(&a, 0.5, still, NULL);
    advance(&b, 0.5, moving, NULL);
    double travelled = 0;
    for (int c = 0; c < BOUGH_ROD_STATES; c++) {
        for (int i = 0; i < N; i++) {
            bool linear = c >= BOUGH_ROD_U && c < BOUGH_ROD_W;
            double shift = linear ? moving[c - BOUGH_ROD_U] : 0;
            check_near(b.m->state[c * N + i] - shift, a.m->state[c * N + i], 0, 1e-6);
        }
    }
    for (int k = BOUGH_ROD_U * N; k < STATES; k++) travelled = fmax(travelled, fabs(a.m->state[k]));
    assert_true(travelled > 0.05);
}

// -- loads ----------------------------------------------------------------------------------------

static const double soft[6] = {1e-12, 1e-12, 1e-12, 1e-12, 1e-12, 1e-12};
static const double ball[4] = {2, 0.3, 0.3, 0.3};

// Vertices that hardly feel each other move by F = value + rate (t − start) alone.
TEST(loads_grow_linearly_from_their_start) {
    check_arena(arena);
    rod r = make(arena, sample_uniform(arena, 4, 4, soft, 0, ball), 1e-9, at_rest);
    bough_rod_loads *loads = bough_rod_body_loads(r.body);
    int s = r.model->stride, at = 2;
    const double force[3] = {1, -2, 3}, force_rate[3] = {4, 5, -6};
    const bough_vertex_inertia *v = &r.model->vertex[at];
    for (int c = 0; c < 3; c++) {
        loads->value[c * s + at] = force[c];
        loads->rate[c * s + at] = force_rate[c];
    }
    loads->value[5 * s + at] = 0.2;
    loads->rate[5 * s + at] = -0.3;
    loads->start = -0.5; // at time 0 half a second has passed
    advance(&r, 0.4, at_rest, NULL);
    bough_vec3 u = part(r.m->state, 4, BOUGH_ROD_U, at), w = part(r.m->state, 4, BOUGH_ROD_W, at);
    const double reached[3] = {u.x, u.y, u.z};
    for (int c = 0; c < 3; c++) {
        double impulse = 0.4 * (force[c] + force_rate[c] * (0.5 + 0.2));
        check_near(reached[c], impulse / v->mass, 0, 1e-7);
    }
    check_near(w.z, 0.4 * (0.2 - 0.3 * (0.5 + 0.2)) / v->inertia[2], 0, 1e-7);
    check_near(bough_norm(part(r.m->state, 4, BOUGH_ROD_U, 1)), 0, 0, 1e-7);
}

// A moment is given in the frame's axes, whatever way the section points; what is put on the root
// goes straight to the carrier.
TEST(loads_are_in_the_axes_of_the_frame) {
    check_arena(arena);
    rod r = make(arena, sample_uniform(arena, 4, 4, soft, 0, ball), 1e-9, at_rest);
    bough_rod_loads *loads = bough_rod_body_loads(r.body);
    double state[BOUGH_ROD_STATES * 4], rate[BOUGH_ROD_STATES * 4], wrench[6];
    int s = r.model->stride;
    bough_quaternion p = bough_quaternion_exponential(bough_v3(0, BOUGH_PI / 2, 0));
    const double turned[4] = {p.w, p.x, p.y, p.z};
    memcpy(state, r.m->state, sizeof state);
    for (int c = 0; c < 4; c++) state[(BOUGH_ROD_P + c) * 4 + 1] = turned[c];
    for (int c = 0; c < 6; c++) {
        loads->value[c * s] = c + 1;
        loads->rate[c * s] = 10;
    }
    loads->value[3 * s + 2] = 0.6;
    assert_true(r.s.ops->derivative(r.s.self, 0, state, at_rest, rate));
    bough_vec3 along = bough_mat3_tmul(bough_rotation_matrix(p), bough_v3(1, 0, 0));
    bough_vec3 w = part(rate, 4, BOUGH_ROD_W, 2);
    check_near(fabs(along.z), 1, 1e-14, 0);
    check_near(w.z, along.z * 0.6 / r.model->vertex[2].inertia[2], 1e-9, 0);
    check_near(w.x, 0, 0, 1e-9);
    r.s.ops->output(r.s.self, 0.3, r.m->state, at_rest, wrench);
    for (int c = 0; c < 6; c++) check_near(wrench[c], c + 1 + 3, 1e-9, 0);
}

// -- vibration ------------------------------------------------------------------------------------

enum { BEAM = 16 };

static const double bending = 20, line_mass = 0.5, beam_length = 4; // EI [N m²], ρA [kg/m], L [m]
static const double beta = 1.8751040687119611;                      // cos β cosh β = −1

static double natural_frequency(void) {
    return beta * beta * sqrt(bending / (line_mass * pow(beam_length, 4)));
}

// A slender uniform cantilever along z, stiff against shear and stretch.
static rod cantilever(double mu) {
    bough_arena *arena = check_memory();
    bough_section_station station = {.mass = line_mass, .inertia = {1e-5, 1e-5, 0, 2e-5}};
    const double diagonal[6] = {1e5, 1e5, 1e5, bending, bending, bending};
    for (int k = 0; k < 6; k++) station.stiffness[bough_symmetric6_index(k, k)] = diagonal[k];
    bough_section_table table = {"cantilever", 1, &station, beam_length, {mu, mu, mu, mu, mu, mu}, 0};
    bough_rod_def def;
    bough_rod_model *model = NULL;
    check_ok(bough_section_discretise(arena, &table, BEAM, &def));
    check_ok(bough_rod_create(arena, &def, &model));
    return make(arena, model, 1e-8, at_rest);
}

// Sets the straight beam going in its first bending mode, tip speed 2 × size: u_x = v, W_y = v'.
static void strike(const rod *r, double size) {
    double state[BOUGH_ROD_STATES * BEAM], ratio = (cosh(beta) + cos(beta)) / (sinh(beta) + sin(beta));
    memcpy(state, r->m->state, sizeof state);
    for (int i = 1; i <= BEAM; i++) {
        double x = beta * i / BEAM, k = beta / beam_length;
        double v = cosh(x) - cos(x) - ratio * (sinh(x) - sin(x));
        double slope = k * (sinh(x) + sin(x) - ratio * (cosh(x) - cos(x)));
        state[BOUGH_ROD_U * BEAM + i - 1] = size * v;
        state[(BOUGH_ROD_W + 1) * BEAM + i - 1] = size * slope;
    }
    bough_member_set(r->m, 0, state);
}

typedef struct crossing {
    double time, speed; // [s, m/s]
} crossing;

// When and how fast the tip passes the middle for the `count`-th time upwards.
static crossing pass(const rod *r, int count) {
    const double *x = &r->m->state[BEAM - 1], *v = &r->m->state[(BOUGH_ROD_U + 1) * BEAM - 1];
    double step = 0.01 * 2 * BOUGH_PI / natural_frequency();
    for (;;) {
        double t0 = r->m->time, x0 = *x, v0 = *v;
        advance(r, t0 + step, at_rest, NULL);
        if (!(x0 < 0 && *x >= 0) || --count > 0) continue;
        double f = -x0 / (*x - x0);
        return (crossing){t0 + f * step, v0 + f * (*v - v0)};
    }
}

TEST(cantilever_vibrates_at_its_natural_frequency) {
    rod r = cantilever(2e-3 / natural_frequency()); // as little as damps the stiff modes
    strike(&r, 0.01);
    crossing fifth = pass(&r, 5);
    check_near(5 * 2 * BOUGH_PI / fifth.time, natural_frequency(), 1e-4, 0);
}

// Stress C(ε + μ ε̇) damps a mode of frequency ω by ζ = μω/2.
TEST(viscosity_damps_as_kelvin_and_voigt_say) {
    double zeta = 0.02;
    rod r = cantilever(2 * zeta / natural_frequency());
    strike(&r, 0.01);
    crossing first = pass(&r, 1);
    double start = first.time;
    crossing last = pass(&r, 4);
    double decrement = log(first.speed / last.speed);
    double measured = decrement / (natural_frequency() * (last.time - start));
    check_near(measured, zeta, 2e-3, 0);
}

// -- energy ---------------------------------------------------------------------------------------

static const double field[BOUGH_ROD_INPUTS] = {0, 0, 0, 0, 0, 0, 0.3, 1, -4};

// Kinetic, elastic and potential energy in a frame at rest.
static double energy(const rod *r, const double *input, bough_rod_scratch *scratch) {
    int n = r->model->n;
    bough_rod_gather(r->model, r->m->state, input, scratch);
    double sum = rod_elastic_energy(r->model, scratch);
    bough_vec3 gravity = {input[6], input[7], input[8]};
    for (int i = 1; i <= n; i++) {
        const bough_vertex_inertia *v = &r->model->vertex[i];
        const double *j = v->inertia;
        bough_vec3 x = part(r->m->state, n, 0, i), u = part(r->m->state, n, BOUGH_ROD_U, i);
        bough_vec3 w = part(r->m->state, n, BOUGH_ROD_W, i);
        bough_mat3 axes = bough_rotation_matrix(turn_of(r->m->state, n, i));
        bough_vec3 spin = {j[0] * w.x + j[3] * w.y + j[4] * w.z, j[3] * w.x + j[1] * w.y + j[5] * w.z,
                           j[4] * w.x + j[5] * w.y + j[2] * w.z};
        bough_vec3 swing = bough_mat3_mul(axes, bough_cross(w, v->moment));
        bough_vec3 lever = bough_axpy(v->mass, x, bough_mat3_mul(axes, v->moment));
        sum += 0.5 * v->mass * bough_dot(u, u) + bough_dot(u, swing) + 0.5 * bough_dot(w, spin);
        sum -= bough_dot(gravity, lever);
    }
    return sum;
}

TEST(energy_is_kept_without_damping_and_falls_with_it) {
    for (int damped = 0; damped < 2; damped++) {
        double state[STATES], kept = 0;
        rod r = general(1e-9, field);
        bough_rod_scratch scratch;
        bough_rod_scratch_init(&scratch, r.arena, r.model);
        if (!damped) memset(r.model->damping, 0, 21 * (size_t)r.model->stride * sizeof(double));
        sample_state(r.model, field, state);
        bough_member_set(r.m, 0, state);
        double start = energy(&r, field, &scratch), last = start;
        for (int k = 1; k <= 100; k++) {
            advance(&r, 0.02 * k, field, NULL);
            double now = energy(&r, field, &scratch);
            if (damped) assert_true(now < last);
            kept = fmax(kept, fabs(now - start));
            last = now;
        }
        if (!damped) check_near(kept, 0, 0, 1e-6 * fabs(start));
        bough_arena_destroy(r.arena);
    }
}

// Sets a straight rod going in the first bending mode of a cantilever of 1 Hz, deflection `size` at the tip.
static void swing(const rod *r, double length, double size) {
    int n = r->model->n;
    double *state = bough_arena_doubles(r->arena, (size_t)r->s.n_state), speed = BOUGH_PI * size;
    double ratio = (cosh(beta) + cos(beta)) / (sinh(beta) + sin(beta));
    memcpy(state, r->m->state, (size_t)r->s.n_state * sizeof *state);
    for (int i = 0; i < n; i++) {
        double x = beta * (i + 1) / n;
        state[BOUGH_ROD_U * n + i] = speed * (cosh(x) - cos(x) - ratio * (sinh(x) - sin(x)));
        state[(BOUGH_ROD_W + 1) * n + i] =
            speed * beta / length * (sinh(x) + sin(x) - ratio * (cosh(x) - cos(x)));
    }
    bough_member_set(r->m, 0, state);
}

// Tangents kept over many steps would let it grow, by a damping ratio of −5e-4.
TEST(stiff_rod_keeps_its_amplitude_under_the_rosenbrock_method) {
    const double length = 10, period = 1;
    const double stiffness[6] = {3e8, 3e8, 1e9, 3.2e4, 3.2e4, 2.5e4}, inertia[4] = {1.002, 1e-4, 1e-4, 2e-4};
    const bough_integrator_options steps = {.kind = BOUGH_ROSENBROCK, .rtol = 3e-4, .step = 0.01};
    check_arena(arena);
    rod r = make(arena, sample_uniform(arena, 24, length, stiffness, 0, inertia), 1e-6, at_rest);
    r.m = member_of(arena, &r.s, steps);
    bough_rod_scratch scratch;
    bough_rod_scratch_init(&scratch, arena, r.model);
    swing(&r, length, 0.01);
    double start = 0, from = 2 * period, to = 40 * period; // higher modes have gone by then
    for (int k = 1; k <= (int)(to / 0.02 + 0.5); k++) {
        advance(&r, 0.02 * k, at_rest, NULL);
        if (0.02 * k <= from) start = energy(&r, at_rest, &scratch);
    }
    double ratio = log(start / energy(&r, at_rest, &scratch)) / (4 * BOUGH_PI * (to - from) / period);
    check_near(ratio, 0, 0, 5e-5);
}

// -- failure --------------------------------------------------------------------------------------

// A moment that winds one segment up beyond the range of a rotation vector.
TEST(overturned_rod_is_a_failure_by_name) {
    check_arena(arena);
    rod r = make(arena, sample_uniform(arena, 2, 2, soft, 0, ball), 1e-6, at_rest);
    bough_rod_body_loads(r.body)->value[3 * r.model->stride + 2] = 10;
    double c[4 * BOUGH_ROD_INPUTS] = {0};
    bough_signal input = {BOUGH_ROD_INPUTS, 0, 5, c};
    bough_status status = bough_member_advance(r.m, 5, &input, false);
    check_fails(status, BOUGH_FAILED, "sample at t = ");
    assert_non_null(strstr(status.message, "120°"));
}
