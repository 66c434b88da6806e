#include "aero/rotor/tower.h"

#include "tests/unit/check.h"

// The NREL 5 MW tower as a cone.
static bough_tower build(bough_arena *arena, bough_vec3 base) {
    static const double height[] = {0, 87.6}, diameter[] = {6, 3.87};
    const bough_tower_def def = {.base = base, .n = 2, .height = height, .diameter = diameter};
    bough_tower tower;
    bough_tower_build(arena, &def, &tower);
    return tower;
}

// Wind of 10 m/s at a blade point at `radius`, 5.0191 m upwind of the tower, hub at 90 m.
static bough_vec3 wind_at_blade(const bough_tower *tower, double azimuth, double radius) {
    bough_vec3 point = bough_v3(-5.0191, -radius * sin(azimuth), 90 + radius * cos(azimuth));
    return bough_tower_disturbed(tower, point, bough_v3(10, 0, 0));
}

// AeroDyn v5, baseline potential flow: azimuth, axial and edgewise wind at 52.75 m, axial at
// 24.05 m. At 95° the inner point is 0.3 m above the top, where the influence fades.
TEST(wind_at_passing_blade_matches_reference) {
    static const double table[][4] = {
        {45, 10, 0, 10},
        {90, 10, 0, 10},
        {95, 10.01356, 0.0002278431, 10.05382},
        {115, 10.02006, 0.0017998898, 10.074031},
        {145, 10.05947, 0.016619734, 10.16365},
        {160, 10.15365, 0.087073007, 10.234226},
        {175, 9.8776691, 1.387077, 8.8529763},
        {180, 7.4245616, 0, 8.0818308},
        {190, 10.317609, -0.48984364, 9.7947762},
        {250, 10.017825, -0.0012474044, 10.068014},
        {280, 10, 0, 10},
    };
    check_arena(arena);
    bough_tower tower = build(arena, bough_v3(0, 0, 0));
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        double azimuth = table[i][0] * BOUGH_DEGREE;
        bough_vec3 outer = wind_at_blade(&tower, azimuth, 52.75);
        check_near(outer.x, table[i][1], 1e-6, 0);
        check_near(outer.y * cos(azimuth), table[i][2], 1e-5, 1e-6);
        check_near(wind_at_blade(&tower, azimuth, 24.05).x, table[i][3], 1e-5, 0);
    }
}

// On the cylinder the flow is tangential, twice the wind at its side, at rest in front.
TEST(flow_follows_the_wall) {
    check_arena(arena);
    bough_vec3 base = bough_v3(3, -2, 10);
    bough_tower tower = build(arena, base);
    for (double a = 0; a < 2 * BOUGH_PI; a += 0.3) {
        bough_vec3 normal = bough_v3(cos(a), sin(a), 0);
        bough_vec3 wall = bough_axpy(3, normal, base);
        bough_vec3 wind = bough_tower_disturbed(&tower, wall, bough_v3(6, 8, 1));
        check_near(bough_dot(wind, normal), 0, 0, 1e-12);
        check_near(hypot(wind.x, wind.y), 20 * fabs(sin(a - atan2(8, 6))), 1e-12, 1e-12);
        check_near(wind.z, 1, 0, 0);
    }
}

static const double six_metres[] = {6, 6}, two_heights[] = {0, 100};

static bough_tower build_kind(bough_arena *arena, bough_tower_influence influence, bough_tower_shadow shadow,
                              const double *drag) {
    bough_tower_def def = {.n = 2, .height = two_heights, .diameter = six_metres, .drag = drag};
    def.influence = influence;
    def.shadow = shadow;
    bough_tower tower;
    bough_tower_build(arena, &def, &tower);
    return tower;
}

// AeroDyn v5 with Bak's correction, drag coefficient 1: axial wind at 52.75 m below the hub.
TEST(bak_matches_reference) {
    check_arena(arena);
    static const double height[] = {0, 87.6}, diameter[] = {6, 3.87}, drag[] = {0, 0};
    bough_tower_def def = {.n = 2, .height = height, .diameter = diameter, .influence = BOUGH_TOWER_BAK};
    bough_tower tower;
    bough_tower_build(arena, &def, &tower);
    check_near(wind_at_blade(&tower, BOUGH_PI, 52.75).x, 6.290952, 1e-6, 0);
    def.drag = drag; // without drag only the shift by a tenth of the radius is left
    bough_tower_build(arena, &def, &tower);
    double x = -5.0191 / (5.0943 / 2) + 0.1;
    check_near(wind_at_blade(&tower, BOUGH_PI, 52.75).x, 10 * (1 - 1 / (x * x)), 1e-4, 0);
}

// Far away from the tower the source spreads drag · radius · speed over the circle around it.
TEST(bak_displaces_half_the_drag) {
    enum { POINTS = 360 };
    check_arena(arena);
    static const double drag[] = {0.6, 0.6};
    bough_tower tower = build_kind(arena, BOUGH_TOWER_BAK, BOUGH_TOWER_SHADOW_NONE, drag);
    double out = 0, circle = 300;
    for (int k = 0; k < POINTS; k++) {
        double a = 2 * BOUGH_PI * k / POINTS;
        bough_vec3 normal = bough_v3(cos(a), sin(a), 0);
        bough_vec3 at = bough_axpy(circle, normal, bough_v3(0, 0, 50));
        bough_vec3 wind = bough_tower_disturbed(&tower, at, bough_v3(6, 8, 0));
        out += bough_dot(wind, normal) * circle * 2 * BOUGH_PI / POINTS;
    }
    check_near(out, 0.6 * 3 * 10, 1e-3, 0);
}

// On the wake's axis it takes drag/√x, at x radii, at most half; at |y| = (x² + y²)^¼ it ends.
TEST(powles_takes_its_share_behind) {
    check_arena(arena);
    static const double drag[] = {0.5, 1.5}; // 0.7 at 20 m
    bough_tower without = build_kind(arena, BOUGH_TOWER_POTENTIAL, BOUGH_TOWER_SHADOW_NONE, drag);
    bough_tower with = build_kind(arena, BOUGH_TOWER_POTENTIAL, BOUGH_TOWER_SHADOW_POWLES, drag);
    static const double table[][3] = {
        {4, 0, 0.35}, {9, 0, 0.7 / 3}, {1.5, 0, 0.5}, {-4, 0, 0},         {4, 2.2, 0},
        {4, -2.2, 0}, {0, 0.9, 0},     {4, 3, 0},     {3, 1.0, 0.158518}, {3, -1.0, 0.158518},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++) {
        double x = 3 * table[i][0], y = 3 * table[i][1];
        bough_vec3 at = bough_v3(0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, 20);
        bough_vec3 wind = bough_v3(6, 8, 2);
        bough_vec3 taken =
            bough_sub(bough_tower_disturbed(&without, at, wind), bough_tower_disturbed(&with, at, wind));
        check_near(taken.x, 6 * table[i][2], 0, 1e-5);
        check_near(taken.y, 8 * table[i][2], 0, 1e-5);
        check_near(taken.z, 0, 0, 0);
    }
}

TEST(inside_is_finite) {
    check_arena(arena);
    bough_tower tower = build(arena, bough_v3(0, 0, 0));
    for (double x = -1; x <= 1; x += 0.125) {
        bough_vec3 wind = bough_tower_disturbed(&tower, bough_v3(x, 0, 20), bough_v3(10, 0, 0));
        check_near(wind.x, 0, 0, 1e-12);
    }
}

// ½ρ c D V² along the wind across the axis, whatever blows along it.
TEST(drag_is_across_the_axis) {
    check_arena(arena);
    static const double height[] = {0, 100}, diameter[] = {6, 4}, drag[] = {0.5, 1};
    const bough_tower_def def = {
        .n = 2, .height = height, .diameter = diameter, .drag = drag, .base = {0, 0, 10}};
    bough_tower tower;
    bough_tower_build(arena, &def, &tower);
    bough_vec3 axis = bough_v3(sin(0.1), 0, cos(0.1));
    bough_vec3 wind = bough_axpy(7, axis, bough_v3(0, 9, 0));
    bough_vec3 f = bough_tower_drag(&tower, 1.2, bough_v3(1, 2, 60), axis, wind);
    check_near(f.y, 0.5 * 1.2 * 0.75 * 5 * 81, 1e-12, 0);
    check_near(hypot(f.x, f.z), 0, 0, 1e-9);
    f = bough_tower_drag(&tower, 1.2, bough_v3(0, 0, 300), bough_v3(0, 0, 1), bough_v3(3, 4, 0));
    check_near(f.x, 0.5 * 1.2 * 4 * 15, 1e-12, 0); // as at the top
}

TEST(no_tower_leaves_the_wind) {
    bough_tower tower;
    bough_tower_build(NULL, &(bough_tower_def){0}, &tower);
    check_near(bough_tower_disturbed(&tower, bough_v3(-1, 0, 5), bough_v3(7, 0, 0)).x, 7, 0, 0);
}
