// What a good scene is read as, and what the program says of scenes.
#include "core/base/linalg.h"
#include "tests/unit/scene_text.h"

#include <time.h>

// -- good scenes ----------------------------------------------------------------------------------

static void check_blade(const bough_scene_body *b) {
    const bough_scene_structure *s = &b->rod.structure;
    check_near(b->pitch, 6.5 * degree, 1e-15, 0);
    assert_int_equal(b->rod.n_segment, 12);
    assert_string_equal(s->source, "made up");
    check_near(s->length, 10, 0, 0);
    check_near(s->damping[3], 1.4e-3, 1e-15, 0);
    assert_int_equal(s->n_station, 3);
    check_near(s->station[1].def.position.z, 5, 0, 0);
    check_near(s->station[0].def.twist, 13.308 * degree, 1e-15, 0);
    check_near(s->station[0].def.stiffness[bough_symmetric6_index(1, 1)], 9.7e7, 0, 0);
    check_near(s->station[0].def.stiffness[bough_symmetric6_index(0, 1)], 0, 0, 0);
    check_near(s->station[1].def.stiffness[bough_symmetric6_index(3, 4)], 1e6, 0, 0);
    check_near(s->station[1].def.stiffness[bough_symmetric6_index(4, 3)], 1e6, 0, 0);
    check_near(s->station[1].def.stiffness[bough_symmetric6_index(5, 5)], 1e7, 0, 0);
    check_near(s->station[1].def.mass, 40, 0, 0);
    check_near(s->station[1].def.centre[1], -0.02, 0, 0);
    check_near(s->station[1].def.inertia[2], 0.1, 0, 0);
    check_near(s->station[1].def.inertia[3], 10, 0, 0);
    check_near(s->station[0].def.inertia[3], 22, 0, 0); // Ixx + Iyy
}

TEST(turbine_is_read) {
    fixture f = read_scene(SCENES "example-turbine.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    assert_int_equal(f.status.code, BOUGH_OK);
    const bough_scene *s = f.scene;
    assert_string_equal(s->title, "Two-bladed example");
    check_near(s->gravity[2], -9.80665, 0, 0);
    check_near(s->simulation.macro_step, 0.01, 1e-15, 0);
    assert_string_equal(bough_scheme_name(s->simulation.coupling.scheme), "ramp");
    check_near(s->simulation.coupling.options.theta, 0, 0, 0);
    check_near(s->simulation.output.interval, 0.05, 1e-15, 0);
    check_near(s->simulation.micro.rtol, 1e-4, 0, 0);
    assert_int_equal(s->n_body, 5);
    const bough_scene_joint *hub = &s->body[2].joint;
    assert_int_equal(hub->kind, BOUGH_JOINT_REVOLUTE);
    assert_int_equal(hub->parent, 1);
    assert_int_equal(hub->axis, BOUGH_SCENE_X);
    check_near(hub->speeds[0], 0.5, 0, 0);
    // up by 1.2 m, turned about y, then back by 2 m
    check_near(hub->placement.position.x, -2 * cos(5 * degree), 1e-15, 0);
    check_near(hub->placement.position.y, 0, 0, 0);
    check_near(hub->placement.position.z, 1.2 + 2 * sin(5 * degree), 1e-15, 0);
    check_near(hub->placement.rotation.c1.z, -sin(5 * degree), 1e-15, 0);
    check_near(hub->placement.rotation.c3.x, sin(5 * degree), 1e-15, 0);
    check_near(s->body[1].mass, 2000, 0, 0);
    check_near(s->body[2].inertia[0], 1200, 0, 0);
    check_near(s->body[2].centre_of_mass[0], 0.1, 0, 0);
    assert_int_equal(s->body[0].joint.parent, BOUGH_GROUND);
    check_blade(&s->body[3]);
    assert_ptr_equal(s->body[3].rod.structure.station, s->body[4].rod.structure.station);
}

TEST(aerodynamics_are_read) {
    fixture f = read_scene(SCENES "example-turbine.yaml", NULL, 0);
    assert_non_null(f.scene);
    const bough_scene_aero *a = &f.scene->aero;
    assert_int_equal(f.scene->load[0].joint, 2);
    check_near(f.scene->load[0].amount, -12e3, 0, 0);
    check_near(f.scene->load[0].ramp[1], 1, 0, 0);
    assert_int_equal(f.scene->turbine.rotor, 2);
    assert_int_equal(f.scene->turbine.n_blade, 2);
    assert_int_equal(f.scene->turbine.blade[1], 4);
    check_near(a->rate, 50, 0, 0);
    check_near(a->wind.def.speed, 12, 0, 0);
    check_near(a->ramp[1], 0.5, 0, 0);
    assert_int_equal(a->hold, BOUGH_SCENE_LINEAR);
    assert_int_equal(a->induction.skew, 1);
    assert_true(a->induction.drag);
    assert_int_equal(a->tower.def.n, 2);
    check_near(a->tower.def.diameter[1], 1.2, 0, 0);
    assert_int_equal(a->wind.kind, BOUGH_SCENE_WIND_UNIFORM);
    assert_int_equal(a->induction.inflow.kind, BOUGH_INFLOW_EQUILIBRIUM);
    assert_null(a->wind.table.node);
    check_near(a->wind.def.direction, 0, 0, 0);
    assert_int_equal(a->tower.def.influence, BOUGH_TOWER_POTENTIAL);
    assert_int_equal(a->tower.def.shadow, BOUGH_TOWER_SHADOW_NONE);
    assert_int_equal(a->tower.n_drag, 1);
    check_near(a->tower.def.drag[0], 1, 0, 0);
    check_near(a->hub_radius, 1.5, 0, 0);
    assert_int_equal(a->blade.n_station, 3);
    check_near(a->blade.station[1].def.centre_y, -0.3, 0, 0);
    check_near(a->blade.station[1].def.twist, 6.5 * degree, 1e-15, 0);
    assert_int_equal(a->blade.station[0].def.polar, 0);
    assert_int_equal(a->blade.station[2].def.polar, 1);
    assert_int_equal(a->polars.polar[1].n_row, 6);
    check_near(a->polars.polar[1].row[3].alpha, 10 * degree, 1e-15, 0);
    check_near(a->polars.polar[1].row[4].cm, -0.2, 0, 0);
}

TEST(uniform_beam_needs_no_table) {
    fixture f = read_scene(SCENES "example-beam.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    const bough_scene *s = f.scene;
    const bough_scene_structure *beam = &s->body[0].rod.structure;
    assert_int_equal(beam->n_station, 1);
    check_near(beam->length, 2, 0, 0);
    check_near(beam->station[0].def.stiffness[bough_symmetric6_index(4, 4)], 700, 0, 0);
    check_near(beam->station[0].def.mass, 1.5, 0, 0);
    check_near(beam->damping[0], 0, 0, 0);
    check_near(s->simulation.output.interval, s->simulation.macro_step, 0, 0);
    assert_int_equal(s->simulation.threads, 0);
    assert_string_equal(bough_scheme_name(s->simulation.coupling.scheme), "monolithic");
    assert_int_equal(s->simulation.master.solver, BOUGH_AUTOMATIC);
    check_near(s->simulation.master.rtol, 5e-5, 1e-12, 0);
    assert_null(s->aero.node);
    assert_null(s->turbine.node);
    check_near(s->gravity[2], -9.80665, 0, 0);
}

TEST(parents_come_first_in_the_order) {
    fixture f = accepts(SIMULATION "bodies:\n"
                                   "  - {name: c, fidelity: rigid, joint: {kind: fixed, parent: b}}\n"
                                   "  - {name: b, fidelity: rigid, joint: {kind: fixed, parent: a}}\n"
                                   "  - {name: a, fidelity: rigid, joint: {kind: fixed, parent: ground}}\n");
    assert_int_equal(f.scene->order[0], 2);
    assert_int_equal(f.scene->order[1], 1);
    assert_int_equal(f.scene->order[2], 0);
}

TEST(free_and_sliding_joints_start_moving) {
    fixture f = accepts(SIMULATION
                        "bodies:\n"
                        "  - name: a\n    fidelity: rigid\n    mass: 1\n    inertia: [1, 2, 3]\n"
                        "    joint: {kind: free, parent: ground, velocity: [1, 2, 3 km/h],\n"
                        "            angular_velocity: [0, 1 rpm, 0]}\n"
                        "  - name: b\n    fidelity: rigid\n    mass: 2 kg\n"
                        "    joint: {kind: prismatic, parent: a, axis: y, position: 2 cm, speed: -1 m/s}\n");
    const bough_scene_joint *a = &f.scene->body[0].joint, *b = &f.scene->body[1].joint;
    check_near(a->speeds[2], 3 / 3.6, 1e-15, 0);
    check_near(a->speeds[4], 6 * degree, 1e-15, 0);
    check_near(b->coordinates[0], 0.02, 1e-15, 0);
    check_near(b->speeds[0], -1, 0, 0);
    assert_int_equal(b->axis, BOUGH_SCENE_Y);
    check_near(f.scene->body[0].inertia[2], 3, 0, 0);
    check_near(f.scene->body[0].inertia[3], 0, 0, 0);
}

TEST(joints_of_several_axes_are_read) {
    fixture f = accepts(
        SIMULATION "bodies:\n"
                   "  - {name: a, fidelity: rigid, mass: 1, inertia: [1, 2, 3], joint: {kind: universal,\n"
                   "     parent: ground, axis: x, second_axis: y, angles: [10 deg, -5 deg],\n"
                   "     angular_speeds: [0, 1 rpm]}}\n"
                   "  - {name: b, fidelity: rigid, mass: 1, inertia: [1, 2, 3], joint: {kind: planar,\n"
                   "     parent: a, axis: z, positions: [1, 2 cm], angle: 3 deg, speeds: [4, 5],\n"
                   "     angular_speed: 6 rad/s}}\n"
                   "  - {name: c, fidelity: rigid, mass: 1, inertia: [1, 2, 3], joint: {kind:\n"
                   "     cylindrical, parent: b, axis: z, position: 2 cm, angle: 90 deg, speed: 3,\n"
                   "     angular_speed: 1 rpm}}\n");
    const bough_scene_joint *a = &f.scene->body[0].joint, *b = &f.scene->body[1].joint;
    const bough_scene_joint *c = &f.scene->body[2].joint;
    assert_int_equal(a->second_axis, BOUGH_SCENE_Y);
    check_near(a->coordinates[1], -5 * degree, 1e-15, 0);
    check_near(a->speeds[1], 6 * degree, 1e-15, 0);
    check_near(b->coordinates[1], 0.02, 1e-15, 0);
    check_near(b->coordinates[2], 3 * degree, 1e-15, 0);
    check_near(b->speeds[0], 4, 0, 0);
    check_near(b->speeds[2], 6, 0, 0);
    check_near(c->coordinates[0], 0.02, 1e-15, 0);
    check_near(c->coordinates[1], 90 * degree, 1e-15, 0);
    check_near(c->speeds[0], 3, 0, 0);
    check_near(c->speeds[1], 6 * degree, 1e-15, 0);
    refuses(SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n    mass: 1\n"
                       "    joint: {kind: universal, parent: ground, axis: x, second_axis: x}\n",
            "s.yaml:6:68: error: bodies[0].joint.second_axis: must not be the first axis\n");
}

TEST(stops_need_a_stiffness_and_an_order) {
#define HINGE(more)                                                                                          \
    SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n    inertia: [1, 1, 1]\n    joint:\n"             \
               "      {kind: revolute, parent: ground, axis: x, " more "}\n"
    accepts(HINGE("rest: 5 deg, stiffness: 3, stop: [-10 deg, 10 deg], stop_stiffness: 4"));
    refuses(HINGE("stop: [0, 1 rad]"), "s.yaml:7:55: error: bodies[0].joint.stop: 'stop' and "
                                       "'stop_stiffness' go together\n");
    refuses(HINGE("stop: [1 rad, 1 rad], stop_stiffness: 4"),
            "s.yaml:7:55: error: bodies[0].joint.stop: the second must be greater than the first\n");
    refuses(HINGE("stiffness: -1"),
            "s.yaml:7:60: error: bodies[0].joint.stiffness: must be >= 0, got '-1'\n");
#undef HINGE
}

TEST(tables_of_joint_loads_are_checked) {
#define LOADED(more)                                                                                         \
    SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n    inertia: [1, 1, 1]\n"                         \
               "    joint: {kind: revolute, parent: ground, axis: x}\nloads:\n"                              \
               "  - {joint: a, torque: " more "}\n"
    accepts(LOADED("{times: [0, 1 s], values: [2 kN m, 0]}"));
    refuses(LOADED("{times: [0, 1, 1], values: [2, 0, 1]}"),
            "s.yaml:8:39: error: loads[0].torque.times[2]: must be more than '1' before it, got '1'\n");
    refuses(LOADED("{times: [0, 1], values: [2, 0, 1]}"),
            "s.yaml:8:24: error: loads[0].torque: 2 times, but 3 values\n");
    refuses(LOADED("{times: [0, 1]}"),
            "s.yaml:8:24: error: loads[0].torque: required key 'values' is missing\n");
#undef LOADED
}

TEST(springs_join_two_rigid_bodies) {
    accepts(ONE_BODY "springs:\n  - {name: s, from: ground, to: a, to_point: [1, 0, 0]}\n");
    refuses(ONE_BODY "springs:\n  - {name: s, from: a, to: a}\n",
            "s.yaml:7:28: error: springs[0].to: must be another body\n");
    refuses(ONE_BODY "springs:\n  - {name: s, from: zzzzz, to: a}\n",
            "s.yaml:7:21: error: springs[0].from: there is no body 'zzzzz'\n");
}

TEST(closures_join_two_rigid_bodies) {
#define CLOSED(rest) ONE_BODY "closures:\n  - {name: c, from: ground, to: a, " rest "}\n"
    accepts(CLOSED("kind: spherical"));
    accepts(CLOSED("kind: revolute, axis: y, to_placement: [move x 1 m, rotate z 5 deg]"));
    refuses(CLOSED("kind: revolute"), "s.yaml:7:5: error: closures[0]: required key 'axis' is missing\n");
    refuses(CLOSED("kind: spherical, from_placement: [move q 1 m]"),
            "s.yaml:7:70: error: closures[0].from_placement[0]: expected 'move x|y|z LENGTH' or "
            "'rotate x|y|z ANGLE', got 'move q 1 m'\n");
    refuses(ONE_BODY "closures:\n  - {name: c, kind: fixed, from: a, to: a}\n",
            "s.yaml:7:41: error: closures[0].to: must be another body\n");
#undef CLOSED
}

TEST(rods_may_be_curved) {
    write_file("blade.yaml", "damping: [1 ms, 0, 0, 0, 0, 0]\n"
                             "stations:\n"
                             "  columns: [span, axis, stiffness, mass]\n"
                             "  rows:\n"
                             "    - [0, [0, 0], [1, 1, 1, 1, 1, 1], [1, 0, 0, 1, 1, 0]]\n"
                             "    - [3, [0.1, -0.2], [1, 1, 1, 1, 1, 1], [1, 0, 0, 1, 1, 0]]\n");
    fixture f = accepts(ROD_BODY "    rod: {table: blade.yaml, damping: [0, 0, 0, 0, 0, 2 ms]}\n");
    const bough_scene_structure *s = &f.scene->body[0].rod.structure;
    check_near(s->length, 3, 0, 0); // the last span
    check_near(s->station[1].def.position.x, 0.1, 0, 0);
    check_near(s->station[1].def.position.y, -0.2, 0, 0);
    check_near(s->damping[0], 0, 0, 0); // the scene's, not the table's
    check_near(s->damping[5], 2e-3, 1e-15, 0);
}

TEST(rods_may_be_parts_of_a_table) {
    write_file("blade.yaml", "stations:\n"
                             "  columns: [span, twist deg, axis, stiffness, mass]\n"
                             "  rows:\n"
                             "    - [0, 0, [0, 0], [1, 1, 1, 1, 1, 1], [1, 0, 0, 1, 1, 0]]\n"
                             "    - [2, 30, [0, 0], [1, 1, 1, 1, 1, 1], [3, 0, 0, 1, 1, 0]]\n"
                             "    - [3, 30, [0.4, 0], [1, 1, 9, 1, 1, 1], [7, 0, 0, 1, 1, 0]]\n");
    fixture f = accepts(ROD_BODY "    rod: {table: blade.yaml, part: [0.5, 2.5]}\n");
    const bough_scene_structure *s = &f.scene->body[0].rod.structure;
    static const double span[] = {0, 1.5, 2}, mass[] = {1.5, 3, 5}, shift[] = {0, 0, 0.2};
    static const double twist[] = {7.5, 30, 30}, axial[] = {1, 1, 5};
    check_near(s->length, 2, 0, 0);
    assert_int_equal(s->n_station, 3);
    for (int k = 0; k < 3; k++) {
        check_near(s->station[k].def.position.z, span[k], 1e-15, 0);
        check_near(s->station[k].def.position.x, shift[k], 1e-15, 0);
        check_near(s->station[k].def.mass, mass[k], 1e-15, 0);
        check_near(s->station[k].def.twist, twist[k] * degree, 1e-15, 0);
        check_near(s->station[k].def.stiffness[bough_symmetric6_index(2, 2)], axial[k], 1e-15, 0);
    }
    refuses(ROD_BODY "    rod: {table: blade.yaml, part: [1, 4]}\n",
            "s.yaml:6:36: error: bodies[0].rod.part: must be an interval of the table, which is 3 m "
            "long, got [1 m, 4 m]\n");
}

// -- the rest -------------------------------------------------------------------------------------

TEST(missing_scene_is_reported) {
    fixture f = read_scene("none.yaml", NULL, 0);
    assert_string_equal(f.printed, "none.yaml: error: cannot be read: No such file or directory\n");
    assert_int_equal(f.status.code, BOUGH_INVALID);
    assert_string_equal(f.status.message, "none.yaml: 1 error in the scene");
}

TEST(hostile_scenes_end_fast) {
    FILE *stream = fopen("s.yaml", "w");
    fputs(SIMULATION "bodies:\n", stream);
    for (int i = 0; i < 9000; i++) fprintf(stream, "- {name: n%d, joint: {parent: m%d}}\n", i, i);
    fclose(stream);
    clock_t begin = clock();
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_int_equal(f.errors.n, 100);
    stream = fopen("s.yaml", "w");
    fputs(SIMULATION "bodies:\n", stream);
    for (int i = 0; i < 10001; i++) fputs("- {}\n", stream);
    fclose(stream);
    f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, "s.yaml:3:1: error: bodies: expected at most 10000 items, got 10001\n");
    assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < 10);
}

TEST(help_covers_scene_and_files) {
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    bough_scene_help(stream);
    fclose(stream);
    const char *const lines[] = {
        "\n  - macro_step: (number in s, [1e-9, 1e4]; e.g. 20 ms)\n",
        "\n    - scheme: (frozen|gauss-seidel|extrapolated|iterated|ramp|monolithic; default "
        "monolithic; e.g. frozen)\n",
        "\n    - axis: (x|y|z; required; with kind: revolute|prismatic|cylindrical|"
        "universal|planar; e.g. x)\n",
        "\n        - alpha: (number in rad; required; e.g. 8 deg)\n",
        "\n        - stiffness: (6 numbers, the diagonal, or 21, the upper triangle row by row; "
        "required; e.g. [1e9, 1e9, 9.7e9, 1.8e10, 1.8e10, 5.6e9])\n",
    };
    for (size_t i = 0; i < sizeof lines / sizeof lines[0]; i++) {
        if (strstr(text, lines[i]) == NULL) fail_msg("not in the help: %s", lines[i]);
    }
    free(text);
}

GROUP(enter, leave)
