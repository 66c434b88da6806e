// Section tables integrated into segments and vertices.
#include "tests/unit/sample_numbers.h"

#include "core/base/linalg.h"
#include "flexbody/section/section.h"

static bough_section_station station(double z, double mass) {
    bough_section_station s = {.position = {0, 0, z}, .mass = mass};
    const double diagonal[6] = {3e5, 4e5, 5e6, 2e4, 3e4, 1e4};
    for (int i = 0; i < 6; i++) s.stiffness[bough_symmetric6_index(i, i)] = diagonal[i];
    s.centre[0] = 0.1;
    s.centre[1] = -0.05;
    s.inertia[0] = 0.02 * mass;
    s.inertia[1] = 0.05 * mass;
    s.inertia[3] = 0.07 * mass;
    return s;
}

static bough_rod_def discretised(bough_arena *arena, const bough_section_station *s, int n_station,
                                 int segments) {
    bough_section_table table = {.name = "test", .n_station = n_station, .station = s, .length = 4};
    for (int i = 0; i < 6; i++) table.damping[i] = 1e-3 * (i + 1);
    bough_rod_def def;
    check_ok(bough_section_discretise(arena, &table, segments, &def));
    return def;
}

// ρ linear from 3 to 1 over 4 m: M = 8, ∫ρ s = 40/3, ∫ρ s² = 32, each exact on any mesh.
TEST(lumped_moments_are_exact_for_linear_tables) {
    const bough_section_station s[2] = {station(0, 3), station(4, 1)};
    for (int segments = 1; segments <= 9; segments += 4) {
        check_arena(arena);
        bough_rod_def def = discretised(arena, s, 2, segments);
        bough_vertex_inertia whole = bough_section_rigid(&def);
        check_near(whole.mass, 8, 1e-12, 0);
        check_near(whole.moment.z, 40.0 / 3, 1e-12, 0);
        check_near(whole.moment.x, 0.8, 1e-12, 0);
        check_near(whole.inertia[0], 32 + 0.02 * 8, 1e-12, 0);
        check_near(whole.inertia[2], 0.07 * 8, 1e-12, 0);
    }
}

// A slender rod whose section inertia cannot balance the end terms: still positive, still exact.
TEST(slender_rod_keeps_positive_inertia) {
    check_arena(arena);
    bough_section_station s = station(0, 1);
    memset(s.centre, 0, sizeof s.centre);
    s.inertia[0] = s.inertia[1] = 1e-9;
    s.inertia[3] = 2e-9;
    bough_rod_def def = discretised(arena, &s, 1, 8);
    bough_rod_model *model;
    check_ok(bough_rod_create(arena, &def, &model));
    bough_vertex_inertia whole = bough_section_rigid(&def);
    check_near(whole.mass, 4, 1e-12, 0);
    check_near(whole.moment.z, 8, 1e-12, 0);
    check_near(whole.inertia[0], 64.0 / 3 + 4e-9, 1e-12, 0);
}

// A mass centre off the axis, on coarse and fine meshes: accepted, with exact products of inertia
// for offsets that vary along the rod.
TEST(offset_mass_centre_keeps_exact_products) {
    for (int segments = 1; segments <= 64; segments *= 4) {
        check_arena(arena);
        bough_section_station s[2] = {station(0, 1.5), station(2, 1.5)};
        for (int k = 0; k < 2; k++) {
            s[k].centre[0] = 0.3 * k; // c = 0.15 s
            s[k].centre[1] = 0;
            s[k].inertia[0] = 2e-3;
            s[k].inertia[1] = s[k].inertia[3] = 2e-3 + 1.5 * 0.3 * 0.3;
        }
        bough_rod_def def = discretised(arena, s, 2, segments);
        bough_rod_model *model;
        check_ok(bough_rod_create(arena, &def, &model));
        bough_vertex_inertia whole = bough_section_rigid(&def);
        check_near(whole.moment.x, 1.5 * 0.15 * 2, 1e-12, 0);
        check_near(whole.inertia[4], -1.5 * 0.15 * 8 / 3, 1e-12, 0); // −∫ρ x z
        if (segments > 1) check_near(whole.inertia[0], 1.5 * 8 / 3 + 4e-3, 1e-12, 0);
    }
}

// A uniform segment meets end forces exactly: bending h/EI, shear h/GA + h³/12EI.
TEST(segment_is_exact_for_end_forces) {
    check_arena(arena);
    const bough_section_station s = station(0, 1);
    bough_rod_def def = discretised(arena, &s, 1, 2);
    double compliance[21], h = 2;
    assert_true(bough_symmetric6_inverse(def.stiffness, compliance));
    check_near(compliance[bough_symmetric6_index(3, 3)], 1 / 2e4, 1e-12, 0);
    check_near(compliance[bough_symmetric6_index(0, 0)], 1 / 3e5 + h * h / 12 / 3e4, 1e-12, 0);
    check_near(compliance[bough_symmetric6_index(1, 1)], 1 / 4e5 + h * h / 12 / 2e4, 1e-12, 0);
    check_near(compliance[bough_symmetric6_index(2, 2)], 1 / 5e6, 1e-12, 0);
}

// Damping dissipates what the sections would: under a steadily growing shear force the segment's
// stress lags as bending (μ₅) and shear (μ₁) share the compliance.
TEST(damping_weighs_the_sections) {
    check_arena(arena);
    const bough_section_station s = station(0, 1);
    bough_rod_def def = discretised(arena, &s, 1, 2);
    double shear = 1 / 3e5, bending = 4.0 / 12 / 3e4, c = 1 / (shear + bending);
    double expected = c * c * (1e-3 * shear + 5e-3 * bending);
    check_near(def.damping[0], expected, 1e-12, 0);
    check_near(def.damping[bough_symmetric6_index(3, 3)], 4e-3 * 2e4, 1e-12, 0);
}

// Twist turns the section axes by −twist about the tangent and mixes the bending stiffnesses.
TEST(twist_turns_sections) {
    check_arena(arena);
    bough_section_station s[2] = {station(0, 1), station(4, 1)};
    s[0].twist = s[1].twist = 0.3;
    bough_rod_def def = discretised(arena, s, 2, 3);
    bough_mat3 r = bough_rotation_matrix(def.rotation[2]);
    check_near(r.c1.x, cos(0.3), 1e-14, 0);
    check_near(r.c1.y, -sin(0.3), 1e-14, 0);
    check_near(def.stiffness[bough_symmetric6_index(3, 3)], 2e4, 1e-12, 0);
    s[1].twist = 0.9; // within a segment the compliance is that of the turned sections
    bough_rod_def turned = discretised(arena, s, 2, 1);
    double compliance[21], turn = 0.6, half = 0.5 * turn, mean = 0.5 - 0.5 * sin(turn) / turn; // sin²
    double tangent = half / sin(half); // the rod's bending by the ends' rotation over the length
    assert_true(bough_symmetric6_inverse(turned.stiffness, compliance));
    check_near(compliance[bough_symmetric6_index(3, 3)], tangent * tangent * ((1 - mean) / 2e4 + mean / 3e4),
               1e-12, 0);
}

// A number between 10⁻² and 10².
static double decades(unsigned *seed) { return pow(10, sample_between(seed, -2, 2)); }

// A straight table whose stations have mass, offset and radii of gyration of their own.
static void draw_table(unsigned *seed, int n, bough_section_station *s) {
    double z = 0;
    for (int k = 0; k < n; k++) {
        double mass = 10 * decades(seed), x = 0.1 * decades(seed), y = -0.1 * decades(seed);
        double ix = mass * 0.01 * decades(seed), iy = mass * 0.01 * decades(seed);
        s[k] = station(z, mass);
        s[k].centre[0] = x;
        s[k].centre[1] = y;
        s[k].inertia[0] = ix + mass * y * y;
        s[k].inertia[1] = iy + mass * x * x;
        s[k].inertia[2] = -mass * x * y;
        s[k].inertia[3] = ix + iy + mass * (x * x + y * y);
        for (int i = 0; i < 21; i++) s[k].stiffness[i] *= decades(seed);
        z += decades(seed);
    }
}

// Whatever physical table: every vertex has a positive inertia, and the totals are those of a fine
// mesh. Second moments differ a little where the linear inertia between two stations is too small for
// mass and offset there, and is not taken.
TEST(any_physical_table_builds) {
    const int segments[] = {1, 2, 3, 7, 24, 48, 61};
    unsigned seed = 1;
    for (int draw = 0; draw < 60; draw++) {
        bough_section_station s[12];
        check_arena(arena);
        int n = 2 + draw % 11;
        draw_table(&seed, n, s);
        bough_rod_def fine = discretised(arena, s, n, 200);
        bough_vertex_inertia whole = bough_section_rigid(&fine);
        for (int k = 0; k < 7; k++) {
            bough_rod_def def = discretised(arena, s, n, segments[k]);
            bough_vertex_inertia sum = bough_section_rigid(&def);
            bough_rod_model *model = NULL;
            check_ok(bough_rod_create(arena, &def, &model));
            check_near(sum.mass, whole.mass, 1e-10, 0);
            check_near(sum.moment.x, whole.moment.x, 1e-10, 1e-10 * whole.mass);
            check_near(sum.moment.z, whole.moment.z, 1e-10, 0);
            for (int i = 0; i < 6; i++) {
                check_near(sum.inertia[i], whole.inertia[i], 2e-3, 2e-3 * whole.inertia[0]);
            }
        }
    }
}
