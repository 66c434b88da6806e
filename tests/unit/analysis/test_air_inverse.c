// The inverse of a rotor of equal blades in blocks, beside the equations that it solves.
#include "apps/bough/analysis/air_inverse.h"
#include "apps/bough/analysis/vibration.h"
#include "tests/unit/built_scene.h"

// Four segments on each blade; a tower that bends, of more states than the blades; the rotor symmetric about
// its shaft in all but the tower.
static const char *const symmetric[] = {
    "gravity=[0, 0, 0]",
    "bodies[tower].rod.segments=16",
    "bodies[blade1].rod.segments=4",
    "bodies[blade2].rod.segments=4",
    "bodies[blade3].rod.segments=4",
    "aero.wind={kind: uniform, speed: 10 m/s}",
    "aero.tower={influence: potential, diameter: [1e-3, 1e-3], height: [0 m, 87.6 m]}",
    "aero.induction.skew=none",
    "bodies[hub].joint.placement=[move z 1.96256 m, move x -5.0191 m]",
    "modes.of=scene",
    NULL,
};

static const double going_back = 1e-6;

// What the inverse is of.
typedef struct scene {
    bough_vibration_point x;
    bough_air_tangent air;
    bough_aeroelastic system;
} scene;

static bough_air_inverse *create(bough_arena *arena, const scene *c) {
    bough_air_inverse *inverse;
    check_ok(bough_air_inverse_create(arena, &c->system, &inverse));
    return inverse;
}

// About the initial state: an equilibrium is not needed.
static void open_scene(bough_arena *arena, scene *c) {
    bough_simulation *s = scene_build(arena, "apps/turbine/land-operation.yaml", symmetric);
    check_ok(bough_vibration_point_find(arena, s, 0, &c->x));
    static const double same[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    bough_air_azimuth azimuth = {s, c->x.whole, 0, c->x.state, &c->x.group, s, &c->x.group, same, 1};
    c->air = (bough_air_tangent){0};
    check_ok(bough_air_tangent_add(arena, &azimuth, NULL, &c->air));
    bough_air_tangent_close(arena, &azimuth, &c->air);
    c->system = (bough_aeroelastic){s, c->x.whole, &c->x.def, &c->x.group, &c->air};
    assert_int_equal(c->x.group.n, 3);
    assert_true(c->x.def.spin > 0);
}

// (I − γ(J − S + A))⁻¹ z = y is y = P (z − γ(S − A) y): the largest miss in units of the scales, relative.
static double miss(bough_arena *arena, const scene *c, const double *z, const double *y) {
    const bough_modes_def *def = &c->x.def;
    size_t n = (size_t)c->air.n;
    double *force = bough_arena_copy(arena, z, n * sizeof *z), *scale = bough_arena_doubles(arena, n);
    const double *rate = bough_modes_rate(arena, def);
    double most = 0, size = 0;
    bough_assembly_scales(c->x.whole->assembly, scale);
    for (size_t j = 0; j < n; j++) {
        for (size_t i = 0; i < n; i++)
            force[i] += *bough_air_tangent_entry(&c->air, i, j) * y[j] / def->point;
    }
    for (int k = 0; k < 9; k++) {
        for (int j = 0; j < def->n_row; j++)
            force[def->row[k / 3 * def->n_row + j]] -=
                rate[k] / def->point * y[def->row[k % 3 * def->n_row + j]];
    }
    for (int k = 0; k < c->system.simulation->tree->n_q; k++) force[k] -= going_back * y[k];
    bough_whole_solve(c->x.whole, force);
    bough_whole_project(c->x.whole, def->state, force);
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(force[i] - y[i]) / scale[i]);
        size = fmax(size, fabs(y[i]) / scale[i]);
    }
    return most / size;
}

enum { VECTORS = 70 }; // more than are worked on at once

TEST(the_blocks_solve_the_equations_of_the_whole_rotor) {
    check_arena(arena);
    scene c;
    open_scene(arena, &c);
    bough_air_inverse *inverse = create(arena, &c);
    assert_non_null(inverse->blades);
    size_t n = (size_t)c.air.n;
    double *z = bough_arena_doubles(arena, n * VECTORS), *y = bough_arena_doubles(arena, n * VECTORS);
    for (size_t k = 0; k < VECTORS; k++) {
        bough_assembly_scales(c.x.whole->assembly, z + k * n);
        for (size_t i = 0; i < n; i++) z[k * n + i] *= sin((double)(i + 1) * (double)(k + 2));
        bough_whole_project(c.x.whole, c.x.state, z + k * n);
    }
    bough_air_inverse_apply(inverse, false, VECTORS, z, y);
    for (size_t k = 0; k < VECTORS; k++) assert_true(miss(arena, &c, z + k * n, y + k * n) < 1e-8);
}

// (P_b⁻¹ + N) y = z is y = P_b (z − N y), each blade by itself, in units of the scales.
TEST(the_blades_are_solved_with_their_kinematic_rows_eliminated) {
    check_arena(arena);
    scene c;
    open_scene(arena, &c);
    const bough_blade_inverse *blades = create(arena, &c)->blades;
    assert_non_null(blades);
    size_t n = (size_t)c.air.n, all = 3 * (size_t)c.x.group.n_row;
    double *scale, *z, *y, *force, *expected, *work = bough_arena_doubles(arena, 2 * all), miss = 0, size = 0;
    bough_arena_each(arena, n, &scale, &z, &y, &force, &expected);
    bough_assembly_scales(c.x.whole->assembly, scale);
    for (size_t i = 0; i < n; i++) force[i] = scale[i] * sin(1 + 3.7 * (double)i);
    bough_blade_inverse_gather(blades, 1, force, z);
    bough_blade_inverse_apply(blades, false, 1, z, work, y);
    memset(force, 0, n * sizeof *force);
    bough_blade_inverse_force(blades, false, 1, y, work, force);
    for (size_t i = 0; i < all; i++) z[i] -= force[i];
    bough_blade_inverse_scatter(blades, 1, z, force);
    bough_blade_inverse_scatter(blades, 1, y, expected);
    for (int k = 0; k < 3; k++) {
        size_t first = (size_t)c.x.group.first[k];
        bough_interface_solve_member(c.x.whole->interface, c.x.group.blade[k]->port + 1, force + first);
        for (size_t i = first; i < first + all / 3; i++) {
            miss = fmax(miss, fabs(force[i] - expected[i]) / scale[i]);
            size = fmax(size, fabs(expected[i]) / scale[i]);
        }
    }
    assert_true(miss < 1e-9 * size);
}

// Of products with two vectors, relative.
static double transpose_miss(bough_arena *arena, const scene *c, bough_air_inverse *inverse) {
    size_t n = (size_t)c->air.n;
    double *z, *left, *y, *image, *scale, one = 0, other = 0, size = 0;
    bough_arena_each(arena, n, &z, &left, &y, &image, &scale);
    bough_assembly_scales(c->x.whole->assembly, scale);
    for (size_t i = 0; i < n; i++) z[i] = scale[i] * sin((double)i), left[i] = cos(3 * (double)i) / scale[i];
    bough_air_inverse_apply(inverse, false, 1, z, y);
    bough_air_inverse_apply(inverse, true, 1, left, image);
    for (size_t i = 0; i < n; i++) {
        one += left[i] * y[i];
        other += image[i] * z[i];
        size += fabs(left[i] * y[i]);
    }
    return fabs(one - other) / size;
}

TEST(the_transpose_has_the_same_products) {
    check_arena(arena);
    scene c;
    open_scene(arena, &c);
    assert_true(transpose_miss(arena, &c, create(arena, &c)) < 1e-12);
}

// One blade bent, which the others are not: the blocks would be those of another rotor.
TEST(unlike_blades_are_solved_as_a_whole) {
    check_arena(arena);
    scene c;
    open_scene(arena, &c);
    int n = c.x.group.n_row / BOUGH_BLADE_ROWS;
    double *state = c.x.state + c.x.group.first[1];
    for (int i = 0; i < n; i++) state[4 * n + i] += 0.05 * (i + 1); // a part of the quaternions
    bough_air_inverse *inverse = create(arena, &c);
    assert_null(inverse->blades);
    double *z = bough_arena_doubles(arena, (size_t)c.air.n), *y = bough_arena_doubles(arena, (size_t)c.air.n);
    bough_assembly_scales(c.x.whole->assembly, z);
    bough_whole_project(c.x.whole, c.x.state, z);
    bough_air_inverse_apply(inverse, false, 1, z, y);
    assert_true(miss(arena, &c, z, y) < 1e-8);
    assert_true(transpose_miss(arena, &c, inverse) < 1e-12);
}
