// The shape of a scene, and the section loads along it.
#include "apps/bough/model/equilibrium.h"
#include "apps/bough/model/shape.h"
#include "tests/unit/built_scene.h"

// A bent rod under a force at its tip: every section carries the force and its moment about the section.
TEST(tip_force_passes_all_sections) {
    const char *sets[] = {"loads[0].force=[10, 0, 0]", "bodies[0].joint.placement=[rotate x 30 deg]", NULL};
    check_build(arena, s, "apps/beams/elastica.yaml", sets);
    double t = bough_equilibrium_time(s);
    check_ok(bough_simulation_equilibrium(s, t, 0, NULL));
    bough_simulation_update(s);
    bough_shape shape;
    bough_shape_create(arena, s, &shape);
    int n = shape.line[0].n_point;
    double *point = bough_arena_doubles(arena, 9 * (size_t)n);
    double *force = point + 3 * n, *moment = force + 3 * n;
    bough_shape_points(&shape, point);
    bough_shape_loads(&shape, t, force, moment);
    const double *tip = point + 3 * (n - 1);
    for (int i = 0; i < n; i++) {
        bough_vec3 arm =
            bough_v3(tip[0] - point[3 * i], tip[1] - point[3 * i + 1], tip[2] - point[3 * i + 2]);
        bough_vec3 expected = bough_cross(arm, bough_v3(10, 0, 0));
        check_near(force[3 * i], 10, 1e-7, 0);
        check_near(force[3 * i + 1], 0, 0, 1e-6);
        check_near(force[3 * i + 2], 0, 0, 1e-6);
        check_near(moment[3 * i], expected.x, 0, 1e-6);
        check_near(moment[3 * i + 1], expected.y, 0, 1e-6);
        check_near(moment[3 * i + 2], expected.z, 0, 1e-6);
    }
    assert_true(moment[1] > 3); // bent far: 10 N m on the straight rod
}

// An inclined bar of 2 kg/m and 2 m: the force of a vertex is the weight above it.
TEST(the_loads_of_a_vertex_are_those_of_the_section) {
    check_arena(arena);
    bough_simulation *s = scene_build_text(
        arena,
        "gravity: [0, 0, -10]\nsimulation: {duration: 1 s, macro_step: 10 ms, initial: equilibrium}\nbodies:\n"
        "  - {name: a, fidelity: rod, joint: {kind: fixed, parent: ground, placement: [rotate y 60 deg]},\n"
        "     rod: {length: 2, segments: 5, stiffness: [1e8, 1e8, 1e8, 1e7, 1e7, 1e7],\n"
        "           mass: [2, 0, 0, 0.1, 0.1, 0]}}\n");
    bough_shape shape;
    bough_shape_create(arena, s, &shape);
    double force[18], moment[18];
    bough_shape_loads(&shape, 0, force, moment);
    for (int i = 0; i < 6; i++) {
        double beyond = 2 - 0.4 * i;
        check_near(force[3 * i + 2], -20 * beyond, 0, 1e-4);
        check_near(moment[3 * i + 1], 10 * beyond * beyond * sin(60 * BOUGH_DEGREE), 0, 1e-4);
    }
}

// A rigid body has no sections.
TEST(rigid_bodies_carry_no_section_loads) {
    check_build(arena, s, "apps/mechanisms/pendulum.yaml", no_sets);
    bough_shape shape;
    bough_shape_create(arena, s, &shape);
    double force[9], moment[9] = {1};
    bough_shape_loads(&shape, 0, force, moment);
    for (int i = 0; i < 9; i++) {
        check_near(force[i], 0, 0, 0);
        check_near(moment[i], 0, 0, 0);
    }
}
