// Eigenvalues of the rod against closed forms and independent solutions.

#include "core/base/linalg.h"
#include "flexbody/rod/rod_modes.h"
#include "flexbody/section/section.h"
#include "tests/unit/sample_rod.h"

enum { MODES = 8 };

// A uniform rod of unit length along z; mass per length, mass matrix of the discretiser.
typedef struct uniform {
    double shear, axial, bend_x, bend_y, torsion; // stiffness
    double mass, inertia;                         // per length; inertia about x and y each
    double damping;                               // μ of all strains [s]
} uniform;

typedef struct bar {
    bough_arena *arena;
    bough_rod_model *model;
    bough_rod_loads loads;
    bough_rod_static work;
    double *state;
    const bough_rod_mode *mode; // (found)
    int found;
} bar;

static void build_graded(bar *b, uniform u, double grading, int segments) {
    b->arena = check_memory();
    bough_section_station section = {.stiffness = {[0] = u.shear,
                                                   [6] = u.shear,
                                                   [11] = u.axial,
                                                   [15] = u.bend_x,
                                                   [18] = u.bend_y,
                                                   [20] = u.torsion},
                                     .mass = u.mass,
                                     .inertia = {u.inertia, u.inertia, 0, 2 * u.inertia}};
    bough_section_table table = {
        .name = "bar", .n_station = 1, .station = &section, .length = 1, .grading = grading};
    for (int c = 0; c < 6; c++) table.damping[c] = u.damping;
    bough_rod_def def;
    bough_status s = bough_section_discretise(b->arena, &table, segments, &def);
    if (bough_is_ok(&s)) s = bough_rod_create(b->arena, &def, &b->model);
    assert_int_equal(s.code, BOUGH_OK);
    b->state = bough_arena_doubles(b->arena, (size_t)BOUGH_ROD_STATES * segments);
    bough_rod_loads_init(&b->loads, b->arena, b->model);
    bough_rod_static_init(&b->work, b->arena, b->model);
}

static void build(bar *b, uniform u, int segments) { build_graded(b, u, 0, segments); }

static void solve(bar *b, const double *input) {
    bough_rod_rest_state(b->model, input, b->state);
    bough_status s = bough_rod_steady(b->model, &b->loads, input, &b->work, b->state);
    bough_rod_mode_list list = {.wanted = MODES};
    if (bough_is_ok(&s)) {
        s = bough_rod_modes(b->arena, b->model, &b->work, input, b->state, &list);
    }
    b->mode = list.mode;
    b->found = list.found;
    check_ok(s);
    assert_int_equal(b->found, MODES);
    assert_non_null(b->mode);
}

// Circular frequency of the k-th mode of a direction [rad/s].
static double omega(const bar *b, bough_rod_direction direction, int k) {
    for (int i = 0; i < b->found; i++) {
        if (b->mode[i].dominant == direction && k-- == 0) {
            return b->mode[i].frequency * 2 * BOUGH_PI;
        }
    }
    return NAN;
}

static const double at_rest[BOUGH_ROD_INPUTS] = {0};

// -- at rest --------------------------------------------------------------------------------------

// A thin rod of equal bending stiffness has every frequency twice; the block finds both.
TEST(thin_rod_has_eulers_frequencies_twice) {
    const double exact[4] = {3.51601527, 22.03449157, 61.69721441, 120.90191606};
    bar b;
    build(&b, (uniform){1e9, 1e9, 1, 1, 1, 1, 1e-9, 0}, 50);
    solve(&b, at_rest);
    for (int k = 0; k < MODES; k++) {
        check_near(b.mode[k].frequency * 2 * BOUGH_PI, exact[k / 2], 2e-6, 0);
        check_near(b.mode[k].damping, 0, 0, 1e-9);
        check_near(b.mode[k].damped_frequency, b.mode[k].frequency, 1e-12, 0);
    }
}

// Segments that shorten from the root: their lengths, their mass, and frequencies of second order at least.
// The vertices of half as many segments are every second one.
TEST(graded_mesh_converges_to_eulers_frequencies) {
    const double exact[3] = {3.51601527, 22.03449157, 61.69721441};
    double error[2][3];
    bar b[2];
    for (int mesh = 0; mesh < 2; mesh++) {
        int n = 12 << mesh;
        build_graded(&b[mesh], (uniform){1e9, 1e9, 1, 1, 1, 1, 1e-9, 0}, 0.2, n);
        const bough_rod_model *m = b[mesh].model;
        double mass = 0;
        for (int i = 0; i <= n; i++) mass += m->vertex[i].mass;
        check_near(mass, 1, 1e-12, 0);
        check_near(m->length[0], (1 + 0.2 * (1 - 1.0 / n)) / n, 1e-12, 0);
        check_near(m->length[n - 1], (1 - 0.2 * (1 - 1.0 / n)) / n, 1e-12, 0);
        solve(&b[mesh], at_rest);
        for (int k = 0; k < 3; k++) {
            error[mesh][k] = fabs(b[mesh].mode[2 * k].frequency * 2 * BOUGH_PI / exact[k] - 1);
        }
    }
    for (int i = 0; i <= 12; i++) check_near(b[0].model->span[i], b[1].model->span[2 * i], 1e-14, 1e-14);
    for (int k = 0; k < 3; k++) {
        assert_true(error[0][k] < 2e-3);
        assert_true(error[1][k] < error[0][k] / 3.5);
    }
}

// Square section, depth a tenth of the length, ν = 0.3, shear factor 5/6: ratios to Euler's values
// by Timoshenko's frequency equation. Second order in h: two meshes extrapolate.
TEST(thick_rod_has_timoshenkos_frequencies) {
    const double euler[4] = {3.51601527, 22.03449157, 61.69721441, 120.90191606};
    const double ratio[3] = {.99213305, .94882677, .89126195};
    const double e = 12e4, area = 0.01, shear = 5.0 / 6 * e / 2.6 * area;
    double value[2][3];
    for (int mesh = 0; mesh < 2; mesh++) {
        bar b;
        build(&b, (uniform){shear, e * area, 1, 1.2, 1, 1, 1e-2 / 12, 0}, 40 << mesh);
        solve(&b, at_rest);
        // bending about x moves along y; the softer plane is the lower mode of each pair
        for (int k = 0; k < 3; k++) value[mesh][k] = omega(&b, BOUGH_ROD_EDGE, k) / euler[k];
        bough_arena_destroy(b.arena);
    }
    for (int k = 0; k < 3; k++) {
        check_near((4 * value[1][k] - value[0][k]) / 3, ratio[k], 2e-6, 0);
    }
}

// Axial and torsional waves: (2k − 1)π/2 times the wave speed over the length.
TEST(bar_and_shaft_have_their_frequencies) {
    bar b;
    build(&b, (uniform){1e6, 100, 1e4, 1e4, 0.4, 1, 0.01, 0}, 100);
    solve(&b, at_rest);
    for (int k = 0; k < 2; k++) {
        double wave = (2 * k + 1) * BOUGH_PI / 2;
        check_near(omega(&b, BOUGH_ROD_AXIAL, k), 10 * wave, 1e-3, 0);
        check_near(omega(&b, BOUGH_ROD_TORSION, k), sqrt(20) * wave, 1e-3, 0);
    }
}

// Dissipation in proportion to the stiffness: ζ = μω/2 for every mode.
TEST(kelvin_voigt_damping_grows_with_frequency) {
    const double mu = 2e-3;
    bar b;
    build(&b, (uniform){1e8, 1e8, 1, 3, 1, 1, 1e-6, mu}, 30);
    solve(&b, at_rest);
    for (int k = 0; k < MODES; k++) {
        const bough_rod_mode *m = &b.mode[k];
        check_near(m->damping, mu * m->frequency * BOUGH_PI, 1e-8, 0);
        check_near(m->damped_frequency, m->frequency * sqrt(1 - m->damping * m->damping), 1e-9, 0);
    }
}

// The first shape of a cantilever: 1 at the tip, φ' = 1.3765 there.
TEST(shape_is_scaled_to_its_largest_displacement) {
    bar b;
    build(&b, (uniform){1e9, 1e9, 1, 4, 1, 1, 1e-9, 0}, 50);
    solve(&b, at_rest);
    const bough_rod_mode *m = &b.mode[0]; // bending about x: along −y for a positive turn
    assert_int_equal(m->dominant, BOUGH_ROD_EDGE);
    check_near(m->share[BOUGH_ROD_EDGE], 1, 1e-9, 0);
    check_near(m->real[50 + 49], 1, 1e-12, 0);
    check_near(m->imaginary[50 + 49], 0, 0, 1e-12);
    check_near(m->real[50 + 24], 0.33952, 1e-3, 0);
    check_near(m->real[3 * 50 + 49], -1.37651, 1e-3, 0);
}

// -- rotating -------------------------------------------------------------------------------------

typedef struct spinning {
    double speed, hub; // Ω√(ρA L⁴/EI), hub radius over length
    double flap[2], lag[2];
} spinning;

// Rows of Wright et al. (1982), continued to the lag: ω_lag² = ω_flap² − Ω².
TEST(rotating_rod_stiffens_as_wrights) {
    const spinning rows[] = {{1, 0, {3.681647, 22.181011}, {3.543236, 22.158458}},
                             {2, 5, {6.941510, 26.143245}, {6.647146, 26.066632}},
                             {6, 1, {10.443866, 32.027244}, {8.548353, 31.460203}},
                             {6, 0, {7.360373, 26.809082}, {4.263225, 26.129042}},
                             {10, 0, {11.202328, 33.640366}, {5.048975, 32.119686}}};
    for (int r = 0; r < 5; r++) {
        double speed = rows[r].speed, hub = rows[r].hub;
        // about x, which is flap's direction: u₀ = ω×(hub z)
        const double input[BOUGH_ROD_INPUTS] = {0, -speed * hub, 0, speed, 0, 0, 0, 0, 0};
        bar b;
        build(&b, (uniform){1e9, 1e9, 1, 1, 1, 1, 1e-9, 0}, 60);
        solve(&b, input);
        for (int k = 0; k < 2; k++) {
            check_near(omega(&b, BOUGH_ROD_FLAP, k), rows[r].flap[k], 3e-4, 0);
            check_near(omega(&b, BOUGH_ROD_EDGE, k), rows[r].lag[k], 5e-4, 0);
        }
        bough_arena_destroy(b.arena);
    }
}

// -- follower loads -------------------------------------------------------------------------------

static void press(bar *b, double force) {
    const bough_schedule constant = {.start = 0, .end = 0};
    build(b, (uniform){1e8, 1e8, 1, 9, 10, 1, 1e-8, 0}, 60);
    double *value = bough_rod_loads_ramped(&b->loads, b->arena, b->model, true, &constant)->value;
    value[2 * b->model->stride + b->model->n] = -force;
    solve(b, at_rest);
}

// Beck's column in the plane of the softer bending: frequencies approach each other with the
// tangential force, meet at 20.051 EI/L² and one of the pair then grows.
TEST(tangential_force_makes_becks_column_flutter) {
    const double force[3] = {10, 15, 19};
    const double exact[3][2] = {{5.17576, 18.58679}, {6.62741, 16.25983}, {8.88070, 13.32546}};
    bar b;
    for (int k = 0; k < 3; k++) {
        press(&b, force[k]);
        check_near(omega(&b, BOUGH_ROD_EDGE, 0), exact[k][0], 2e-3, 0);
        check_near(omega(&b, BOUGH_ROD_EDGE, 1), exact[k][1], 2e-3, 0);
        bough_arena_destroy(b.arena);
    }
    press(&b, 22);
    double growth = NAN, frequency = NAN;
    for (int i = 0; i < b.found; i++) {
        if (!(b.mode[i].damping < -1e-3)) continue;
        growth = -b.mode[i].damping * b.mode[i].frequency * 2 * BOUGH_PI;
        frequency = b.mode[i].damped_frequency * 2 * BOUGH_PI;
    }
    check_near(growth, 3.05491, 5e-3, 0);
    check_near(frequency, 10.85588, 1e-3, 0);
}

static bool flutters(double force) {
    bar b;
    bool grows = false;
    press(&b, force);
    for (int i = 0; i < b.found; i++) grows = grows || b.mode[i].damping < -1e-6;
    bough_arena_destroy(b.arena);
    return grows;
}

TEST(becks_load_is_found) {
    double low = 19, high = 21;
    for (int k = 0; k < 14; k++) {
        double middle = 0.5 * (low + high);
        if (flutters(middle)) {
            high = middle;
        } else {
            low = middle;
        }
    }
    check_near(low, 20.05095, 1e-3, 0);
}

// -- everything at once ---------------------------------------------------------------------------

enum { N = 5, STATES = BOUGH_ROD_STATES * N };

// ∂f/∂y by differences (column-major).
static void jacobian(bar *b, const double *input, double *matrix) {
    const double eps = 1e-6;
    double moved[STATES], high[STATES], low[STATES];
    for (int j = 0; j < STATES; j++) {
        for (int side = 0; side < 2; side++) {
            memcpy(moved, b->state, sizeof moved);
            moved[j] += side == 0 ? eps : -eps;
            assert_true(bough_rod_derivative(b->model, &b->loads, 0, moved, input, &b->work.scratch,
                                             side == 0 ? high : low));
        }
        for (int i = 0; i < STATES; i++) matrix[j * STATES + i] = (high[i] - low[i]) / (2 * eps);
    }
}

// Distance of λ from the nearest of the eigenvalues.
static double distance(const double *value, int n, double real, double imaginary) {
    double nearest = HUGE_VAL;
    for (int i = 0; i < n; i++) {
        nearest = fmin(nearest, hypot(value[i] - real, value[n + i] - imaginary));
    }
    return nearest;
}

// A curved, whole, damped rod with mass offsets, dead and follower loads, gravity, turning about
// an oblique axis off its root: every mode is an eigenvalue of the differential equation.
TEST(modes_are_eigenvalues_of_the_equation_of_motion) {
    const double input[BOUGH_ROD_INPUTS] = {0.4, -0.3, 0.7, 0.5, -0.8, 0.6, 1, -2, -0.5};
    const bough_schedule constant = {.start = 0, .end = 0};
    static double matrix[STATES * STATES], vector[STATES * STATES];
    double value[2 * STATES], work[BOUGH_EIGEN_WORK(STATES)];
    unsigned seed = 4;
    bar b = {.arena = check_memory()};
    b.model = sample_general(b.arena, N);
    b.state = bough_arena_doubles(b.arena, STATES);
    bough_rod_loads_init(&b.loads, b.arena, b.model);
    bough_rod_static_init(&b.work, b.arena, b.model);
    double *follower = bough_rod_loads_ramped(&b.loads, b.arena, b.model, true, &constant)->value;
    for (int k = 0; k < 6 * b.model->stride; k++) {
        follower[k] = sample_random(&seed);
        b.loads.value[k] = sample_random(&seed);
    }
    for (int k = 0; k < 21 * b.model->stride; k++) b.model->damping[k] *= 0.05;
    solve(&b, input);
    jacobian(&b, input, matrix);
    assert_true(bough_dense_eigen(STATES, matrix, value, vector, work));
    double found[2 * MODES], last = b.mode[MODES - 1].frequency * 2 * BOUGH_PI;
    for (int k = 0; k < MODES; k++) {
        double modulus = b.mode[k].frequency * 2 * BOUGH_PI;
        found[k] = -b.mode[k].damping * modulus;
        found[MODES + k] = b.mode[k].damped_frequency * 2 * BOUGH_PI;
        check_near(distance(value, STATES, found[k], found[MODES + k]), 0, 0, 1e-6 * modulus);
    }
    for (int i = 0; i < STATES; i++) { // and none below the last one is missing
        double real = value[i], imaginary = value[STATES + i], modulus = hypot(real, imaginary);
        if (imaginary < 1e-3 || modulus > last * (1 + 1e-6)) continue;
        check_near(distance(found, MODES, real, imaginary), 0, 0, 1e-6 * modulus);
    }
}
