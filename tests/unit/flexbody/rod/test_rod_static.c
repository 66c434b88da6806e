// Static shapes of the rod: analytic ones first, then order of convergence, then reference values.

#include "flexbody/rod/rod_load.h"
#include "flexbody/section/section.h"
#include "tests/unit/sample_rod.h"

static const double beam_inertia[4] = {1, 0.01, 0.01, 0.02};

typedef struct bent {
    bough_rod_model *model;
    double *state;
    bough_rod_loads loads;
    bough_rod_static work;
} bent;

static bent rod_at_rest(bough_arena *arena, bough_rod_model *model) {
    const double at_rest[BOUGH_ROD_INPUTS] = {0};
    bent b = {.model = model, .state = bough_arena_doubles(arena, (size_t)BOUGH_ROD_STATES * model->n)};
    bough_rod_loads_init(&b.loads, arena, model);
    bough_rod_static_init(&b.work, arena, model);
    bough_rod_rest_state(model, at_rest, b.state);
    return b;
}

static bent straight_rod(bough_arena *arena, int n, double length, const double stiffness[6]) {
    return rod_at_rest(arena, sample_uniform(arena, n, length, stiffness, 0, beam_inertia));
}

static void solve(bent *b) {
    bough_vec3 none = {0, 0, 0};
    check_ok(rod_equilibrium(b->model, &b->loads, none, &b->work, b->state));
}

static bough_vec3 vertex(const bent *b, int i) {
    int n = b->model->n;
    return bough_v3(b->state[i - 1], b->state[n + i - 1], b->state[2 * n + i - 1]);
}

// An end moment M bends a straight rod to an arc of curvature M/EI, whatever the mesh: full turns
// close the circle. Curvature φ/h with φ the logarithm makes every vertex' rotation exact, and
// chords are those of the arc.
TEST(end_moment_bends_rod_to_circle) {
    const double stiffness[6] = {1e4, 1e4, 1e4, 100, 100, 100};
    for (int turns = 1; turns <= 10; turns += 9) {
        check_arena(arena);
        int n = 12 * turns;
        bent b = straight_rod(arena, n, 10, stiffness);
        b.loads.value[3 * b.model->stride + n] = turns * 2 * BOUGH_PI * 100 / 10; // about x
        solve(&b);
        bough_vec3 tip = vertex(&b, n), quarter = vertex(&b, n / (4 * turns));
        check_near(tip.x, 0, 0, 1e-9);
        check_near(tip.y, 0, 0, 1e-8);
        check_near(tip.z, 0, 0, 1e-8);
        // on the circle; what is left are chords of segments that bend by 30 degrees
        double radius = 10 / (2 * BOUGH_PI * turns);
        check_near(quarter.y, -radius, 4e-4, 0);
        check_near(quarter.z, radius, 4e-4, 0);
    }
}

// Cantilever under a dead tip force, inextensible and without shear: the elastica by elliptic
// integrals, P L²/EI = 2 (Mattiasson 1981). Second order in h.
TEST(dead_tip_force_gives_the_elastica) {
    const double stiffness[6] = {1e9, 1e9, 1e9, 1, 1, 1};
    double error[2];
    for (int k = 0; k < 2; k++) {
        check_arena(arena);
        int n = 20 << k;
        bent b = straight_rod(arena, n, 1, stiffness);
        b.loads.value[n] = 2;
        solve(&b);
        bough_vec3 tip = vertex(&b, n);
        check_near(1 - tip.z, 0.160641721, 0, 2e-3);
        error[k] = tip.x - 0.493457480;
    }
    check_near(error[1], 0, 0, 3e-4);
    check_near(error[0] / error[1], 4, 0, 0.2);
}

// A cantilever under a load per length that falls linearly from q at the root to nothing at `to`, which
// may lie between vertices: beam theory with shear, to the fourth order of the segments' length.
TEST(load_that_falls_along_the_rod_bends_it_as_beam_theory_says) {
    // of shear with what the moment's change along a segment of 0.4 m adds
    const double shear_stiffness = 1 / (1e-4 + 0.4 * 0.4 / 12 / 3), q = 1e-4, length = 2;
    const double stiffness[6] = {shear_stiffness, shear_stiffness, 1e6, 3, 3, 1};
    const double start[6] = {q, 0, 0, 0, 0, 0}, end[6] = {0};
    const bough_schedule always = {.start = 0};
    for (int k = 0; k < 2; k++) {
        double to = k == 0 ? length : 1.1;
        check_arena(arena);
        bent b = straight_rod(arena, 5, length, stiffness);
        for (int n = 0; n < 5; n++) { // D of a uniform segment: d₃×f (σ² − h²/4)/2 over EI in the mean
            double mean = 0.4 * 0.4 / 12 / 3;
            b.model->line[(6 * 4 + 0) * b.model->stride + n] = -mean;
            b.model->line[(6 * 3 + 1) * b.model->stride + n] = mean;
        }
        bough_rod_lump(b.model, (bough_rod_reach){0, to}, start, end,
                       bough_rod_loads_ramped(&b.loads, arena, b.model, false, &always));
        solve(&b);
        double bending = q * pow(to, 4) / 30 / 3, turn = q * pow(to, 3) / 24 / 3;
        double shear = q * to * to / 6 / 1e4;
        check_near(vertex(&b, 5).x, bending + turn * (length - to) + shear, 5e-4, 0);
    }
}

static bent table_rod(bough_arena *arena, bough_section_table table, int n) {
    bough_rod_def def;
    bough_rod_model *model;
    check_ok(bough_section_discretise(arena, &table, n, &def));
    check_ok(bough_rod_create(arena, &def, &model));
    return rod_at_rest(arena, model);
}

// A strip of 1.5 m, bending stiffness 2 and 36, torsional 3, its ends turned by `pretwist`.
static bent strip_of(bough_arena *arena, int n, double pretwist) {
    const bough_section_station station[2] = {
        {.stiffness = {1e8, 0, 0, 0, 0, 0, 1e8, 0, 0, 0, 0, 1e8, 0, 0, 0, 2, 0, 0, 36, 0, 3},
         .mass = 1,
         .inertia = {0.01, 0.01, 0, 0.02}},
        {.position = {0, 0, 1.5},
         .twist = pretwist,
         .stiffness = {1e8, 0, 0, 0, 0, 0, 1e8, 0, 0, 0, 0, 1e8, 0, 0, 0, 2, 0, 0, 36, 0, 3},
         .mass = 1,
         .inertia = {0.01, 0.01, 0, 0.02}}};
    return table_rod(arena, (bough_section_table){.name = "strip", .n_station = 2, .station = station}, n);
}

// A cantilever under (s/L)⁵ per length. Each segment has the line with its resultant and moment, as loads
// from other meshes come to it; beam theory with shear, to the fourth order of the segments' length at every
// vertex.
static double polynomial_error(int n) {
    static const double place[3] = {-0.7745966692414834, 0, 0.7745966692414834},
                        weight[3] = {5. / 18, 4. / 9, 5. / 18};
    const double length = 1.5, scale = 1e-4;
    const bough_schedule always = {.start = 0};
    check_arena(arena);
    bent b = strip_of(arena, n, 0);
    bough_rod_ramped_load *load = bough_rod_loads_ramped(&b.loads, arena, b.model, false, &always);
    for (int k = 0; k < n; k++) {
        double h = length / n, mean = 0, slope = 0;
        for (int i = 0; i < 3; i++) {
            double q = scale * pow((k + 0.5 + place[i] / 2) / n, 5);
            mean += weight[i] * q;
            slope += weight[i] * q * 6 * place[i] / h;
        }
        const double start[6] = {mean - slope * h / 2}, end[6] = {mean + slope * h / 2};
        bough_rod_lump(b.model, (bough_rod_reach){k * h, (k + 1) * h}, start, end, load);
    }
    solve(&b);
    double worst = 0, tip = scale * pow(length, 4) / 36 * (3. / 8 - 1. / 9) / 6;
    for (int i = 1; i <= n; i++) {
        double x = 1. * i / n, bending = pow(x, 9) / 3024 - x * x * x / 36 + x * x / 14;
        double sheared = x / 6 - pow(x, 7) / 42;
        double exact = scale * (bending * pow(length, 4) / 36 + sheared * length * length / 1e8);
        worst = fmax(worst, fabs(vertex(&b, i).x - exact) / tip);
    }
    return worst;
}

TEST(polynomial_line_loads_converge_at_fourth_order) {
    double error[3];
    for (int k = 0; k < 3; k++) error[k] = polynomial_error(4 << k);
    assert_true(error[0] / error[1] > 14 && error[1] / error[2] > 14);
    assert_true(error[2] < 1e-5);
}

// A cantilever whose tension N is more than 12 EI/h²: P/N (L − tanh(kL)/k), k² = N/EI.
TEST(tension_stiffens_the_deflection_within_a_segment) {
    const double length = 1.5, tension = 1000, across = 1e-2, k = sqrt(tension / 2);
    double exact = across / tension * (length - tanh(k * length) / k), error[3];
    for (int i = 0; i < 3; i++) {
        check_arena(arena);
        int n = 8 << i;
        bent b = strip_of(arena, n, 0);
        b.loads.value[b.model->stride + n] = across;
        b.loads.value[2 * b.model->stride + n] = tension;
        solve(&b);
        error[i] = fabs(vertex(&b, n).y / exact - 1);
    }
    assert_true(error[0] < 3e-3 && error[0] / error[1] > 7 && error[1] / error[2] > 14);
}

// The tip of a cantilever under force and moment per length that stay in its sections' axes and a force at
// the tip that does not, EI 2 and `edge`, in lengths.
static bough_vec3 followed_tip(int n, double edge, const double line[6], bough_vec3 force) {
    const bough_schedule always = {.start = 0};
    const double length = 1.5;
    const bough_section_station station = {
        .stiffness = {1e8, 0, 0, 0, 0, 0, 1e8, 0, 0, 0, 0, 1e8, 0, 0, 0, 2, 0, 0, edge, 0, 3},
        .mass = 1,
        .inertia = {0.01, 0.01, 0, 0.02}};
    check_arena(arena);
    bent b = table_rod(
        arena, (bough_section_table){.name = "strip", .n_station = 1, .station = &station, .length = length},
        n);
    bough_rod_ramped_load *load = bough_rod_loads_ramped(&b.loads, arena, b.model, true, &always);
    bough_rod_lump(b.model, (bough_rod_reach){0, length}, line, NULL, load);
    const double at_tip[3] = {force.x, force.y, force.z};
    for (int c = 0; c < 3; c++) b.loads.value[c * b.model->stride + n] = at_tip[c];
    solve(&b);
    bough_vec3 tip = bough_scale(1 / length, vertex(&b, n));
    return tip;
}

static void check_fourth_order(const double error[3]) {
    assert_true(error[0] / error[1] > 12 && error[1] / error[2] > 12);
}

// q L³/EI = 6 and m L²/EI = 2 in a plane, by the elastica integrated from the tip inwards; a load across the
// plane in which a force at the tip bends the rod, by many segments.
TEST(follower_line_loads_converge_at_fourth_order) {
    const double length = 1.5, across[6] = {0, 4 * 2 / pow(length, 3)};
    const double plane[6] = {6 * 36 / pow(length, 3), 0, 0, 0, 2 * 36 / pow(length, 2), 0};
    const bough_vec3 none = {0, 0, 0}, force = {3 * 2 / pow(length, 2), 0, 0};
    bough_vec3 exact = {0.8319616183, 0, 0.1925964621}, fine = followed_tip(128, 2, across, force);
    double error[2][3];
    for (int k = 0; k < 3; k++) {
        error[0][k] = bough_norm(bough_sub(followed_tip(4 << k, 36, plane, none), exact));
        error[1][k] = bough_norm(bough_sub(followed_tip(4 << k, 2, across, force), fine));
    }
    check_fourth_order(error[0]);
    check_fourth_order(error[1]);
}

// A cantilever under a force askew to its two ways of bending twists, to second order in the force, by
// Px Py (1/EIx − 1/EIy) L⁴/(12 GJ): what bends one way is the arm of the moment by the other force. Also of a
// pretwisted strip, against many segments.
static double askew_twist(int n, double pretwist) {
    check_arena(arena);
    bent b = strip_of(arena, n, pretwist);
    double before = b.state[(BOUGH_ROD_P + 3) * n + n - 1];
    b.loads.value[n] = 0.02;
    b.loads.value[b.model->stride + n] = 0.01;
    solve(&b);
    double twist = 2 * (b.state[(BOUGH_ROD_P + 3) * n + n - 1] - before);
    return twist;
}

TEST(bending_two_ways_twists) {
    double exact = 0.02 * 0.01 * (1.0 / 2 - 1.0 / 36) * pow(1.5, 4) / (12 * 3);
    check_near(fabs(askew_twist(4, 0)), exact, 1e-3, 0);
    check_near(askew_twist(6, 1), askew_twist(48, 1), 1e-3, 0);
}

// Tip of the follower cantilever of Argyris and Symeonidis (1981), displacement along the rod and
// across it, with 100·2^mesh segments.
static void follower_tip(double force, int mesh, double tip[2]) {
    const double stiffness[6] = {1.61538e8, 1.61538e8, 3.2307e8, 3.5e7, 3.5e7, 3.5e7};
    const bough_schedule constant = {.start = 0, .end = 0};
    check_arena(arena);
    int n = 100 << mesh;
    bent b = straight_rod(arena, n, 100, stiffness);
    bough_rod_loads_ramped(&b.loads, arena, b.model, true, &constant)->value[n] = force;
    solve(&b);
    tip[0] = vertex(&b, n).z - 100;
    tip[1] = vertex(&b, n).x;
}

// References by shooting; the tip turns beyond 180°, where only small increments converge. Second
// order in h, so that two meshes extrapolate to 1e-5 of the length.
TEST(follower_force_bends_the_rod_beyond_a_half_turn) {
    const double force[4] = {20e3, 60e3, 100e3, 134e3};
    const double exact[4][2] = {{-92.0292110, 75.3857493},
                                {-85.7679471, 40.0633388},
                                {-50.7541937, -11.6260703},
                                {-80.1635764, -49.5251013}};
    for (int k = 0; k < 4; k++) {
        double coarse[2], fine[2];
        follower_tip(force[k], 0, coarse);
        follower_tip(force[k], 1, fine);
        for (int c = 0; c < 2; c++) {
            check_near(fine[c], exact[k][c], 0, 2e-2);
            check_near((4 * fine[c] - coarse[c]) / 3, exact[k][c], 0, 1e-3);
        }
    }
}

// A bar turning about its root stretches: tip by mass Ω² L³/(3 EA) for small strains.
TEST(turning_bar_stretches) {
    const double stiffness[6] = {1e9, 1e9, 1e9, 100, 100, 100};
    const double input[BOUGH_ROD_INPUTS] = {0, 0, 0, 20, 0, 0, 0, 0, 0};
    check_arena(arena);
    bent b = straight_rod(arena, 100, 10, stiffness);
    check_ok(bough_rod_steady(b.model, &b.loads, input, &b.work, b.state));
    check_near(vertex(&b, 100).z - 10, 400 * 1000 / (3 * 1e9), 5e-4, 0);
    for (int i = 0; i < 100; i++) { // velocities ride along: ω×x
        check_near(b.state[(BOUGH_ROD_U + 1) * 100 + i], -20 * b.state[200 + i], 1e-12, 0);
        check_near(b.state[BOUGH_ROD_W * 100 + i], 20, 1e-12, 0);
    }
}

// A wire that hangs by its weight from a horizontal clamp, q L³/EI = 100, against the exact elastica.
// Twenty-five thousand times longer than thick it takes hardly more iterations than a short one: its
// axial stiffness, EA L²/EI = 1e10, must not answer to the square of the turns of a step.
TEST(slender_rod_takes_few_iterations) {
    for (int k = 0; k < 2; k++) {
        double ea = k == 0 ? 1e6 : 1e10;
        double shear = 12 * 200.0 * 200.0; // that stands for the bending of a segment, 12 EI/h²
        const double stiffness[6] = {shear, shear, ea, 1, 1, 1};
        check_arena(arena);
        bent b = straight_rod(arena, 200, 1, stiffness);
        bough_vec3 weight = {100, 0, 0}; // of 1 kg/m
        check_ok(rod_equilibrium(b.model, &b.loads, weight, &b.work, b.state));
        assert_in_range(b.work.iterations, 2, 15);
        check_near(vertex(&b, 200).x, 0.9375239354, 0, 2e-4);
        check_near(vertex(&b, 200).z, 0.1592233826, 0, 2e-4);
    }
}

// P L²/EI = 10 across the tip of a rod of slenderness EA L²/EI.
static bough_status bend_slender(double slenderness, int n) {
    const double stiffness[6] = {slenderness, slenderness, slenderness, 1, 1, 1};
    check_arena(arena);
    bent b = straight_rod(arena, n, 1, stiffness);
    b.loads.value[n] = 10;
    bough_vec3 none = {0, 0, 0};
    bough_status s = rod_equilibrium(b.model, &b.loads, none, &b.work, b.state);
    // chords that do not shear bend by less than the elastica
    if (bough_is_ok(&s)) check_near(vertex(&b, n).x, 0.81061, 0, 0.5 / n / n);
    return s;
}

// A slender rod bends as the elastica on every mesh; one for which a double is too short ends with a
// diagnosis that does not depend on the mesh.
TEST(slender_rods_bend_on_every_mesh) {
    const double slenderness[4] = {1e9, 1e10, 1.6e11, 1e12};
    for (int k = 0; k < 4; k++) {
        for (int n = 8; n <= 512; n *= 2) {
            bough_status s = bend_slender(slenderness[k], n);
            if (!bough_is_ok(&s)) print_error("%d segments: %s\n", n, s.message);
            assert_int_equal(s.code, BOUGH_OK);
        }
    }
    bough_status first = bend_slender(1e18, 8);
    for (int n = 8; n <= 512; n *= 8) {
        bough_status s = bend_slender(1e18, n);
        check_fails(s, BOUGH_FAILED, "EA L²/EI is 1e+18");
        assert_string_equal(s.message, first.message);
    }
}

// What has no equilibrium ends with a diagnosis: a spring-soft rod pushed beyond its length.
TEST(hopeless_load_is_diagnosed) {
    const double stiffness[6] = {1, 1, 1, 1, 1, 1};
    check_arena(arena);
    bent b = straight_rod(arena, 4, 1, stiffness);
    b.loads.value[3 * b.model->stride + 4] = 1e3; // 120° per segment is exceeded
    bough_vec3 none = {0, 0, 0};
    check_fails(rod_equilibrium(b.model, &b.loads, none, &b.work, b.state), BOUGH_FAILED, "sample");
}
