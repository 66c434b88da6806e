#include "apps/scene/scene.h"

#include "tests/check.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#define SCENES BOUGH_SOURCE_DIR "/tests/scenes/"

static const double degree = 3.14159265358979323846 / 180;

typedef struct fixture {
    bough_arena *arena;
    bough_errors errors;
    bough_scene *scene;
    bough_status status;
    char *printed;
} fixture;

static fixture read_scene(const char *path, const char *const *sets, int n_set) {
    fixture f = {.arena = bough_arena_create()};
    f.errors.arena = f.arena;
    f.status = bough_scene_read(f.arena, path, sets, n_set, &f.errors, &f.scene);
    size_t size;
    FILE *stream = open_memstream(&f.printed, &size);
    bough_errors_print(&f.errors, stream);
    fclose(stream);
    return f;
}

static void stop(fixture *f) {
    bough_arena_destroy(f->arena);
    free(f->printed);
}

// -- scenes written by the tests: into a directory of their own, so that paths in messages are
// short

static void write_file(const char *name, const char *text) {
    FILE *stream = fopen(name, "w");
    assert_non_null(stream);
    fputs(text, stream);
    fclose(stream);
}

static char directory[] = "/tmp/bough_scene_XXXXXX";

static int enter(void **state) {
    (void)state;
    if (mkdtemp(directory) == NULL || chdir(directory) != 0) return -1;
    return 0;
}

static int leave(void **state) {
    (void)state;
    const char *const names[] = {"s.yaml", "blade.yaml", "aero.yaml", "polars.yaml"};
    for (int i = 0; i < 4; i++)
        remove(names[i]);
    return chdir("/") == 0 && rmdir(directory) == 0 ? 0 : -1;
}

// Reading the scene must fail with exactly these lines.
static void refuses(const char *text, const char *lines) {
    write_file("s.yaml", text);
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, lines);
    assert_int_equal(f.status.code, lines[0] == '\0' ? BOUGH_OK : BOUGH_INVALID);
    if (lines[0] != '\0') assert_null(f.scene);
    stop(&f);
}

static void accepts(const char *text) { refuses(text, ""); }

// A scene with one body of this text (six spaces deep) in lines 5 and up.
#define SIMULATION "simulation: {duration: 1 s, macro_step: 10 ms}\n"
#define JOINT "    joint: {kind: fixed, parent: ground}\n"
#define ONE_BODY SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n" JOINT
#define ROD_BODY SIMULATION "bodies:\n  - name: a\n    fidelity: rod\n" JOINT

// -- good scenes
// --------------------------------------------------------------------------------------

static void check_blade(const bough_scene_body *b) {
    const bough_scene_structure *s = &b->rod.structure;
    check_near(b->pitch, 6.5 * degree, 1e-15, 0);
    assert_int_equal(b->rod.n_segment, 12);
    assert_string_equal(s->source, "made up");
    check_near(s->length, 10, 0, 0);
    check_near(s->damping[3], 1.4e-3, 1e-15, 0);
    assert_int_equal(s->n_station, 3);
    check_near(s->station[1].position[2], 5, 0, 0);
    check_near(s->station[0].twist, 13.308 * degree, 1e-15, 0);
    check_near(s->station[0].stiffness[7], 9.7e7, 0, 0);
    check_near(s->station[0].stiffness[1], 0, 0, 0);
    check_near(s->station[1].stiffness[6 * 3 + 4], 1e6, 0, 0);
    check_near(s->station[1].stiffness[6 * 4 + 3], 1e6, 0, 0);
    check_near(s->station[1].stiffness[35], 1e7, 0, 0);
    check_near(s->station[1].mass, 40, 0, 0);
    check_near(s->station[1].mass_centre[1], -0.02, 0, 0);
    check_near(s->station[1].inertia[2], 0.1, 0, 0);
    check_near(s->station[1].inertia[3], 10, 0, 0);
    check_near(s->station[0].inertia[3], 22, 0, 0); // Ixx + Iyy
}

static void turbine_is_read(void **state) {
    (void)state;
    fixture f = read_scene(SCENES "example-turbine.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    assert_int_equal(f.status.code, BOUGH_OK);
    const bough_scene *s = f.scene;
    assert_string_equal(s->title, "Two-bladed example");
    check_near(s->gravity[2], -9.80665, 0, 0);
    check_near(s->simulation.macro_step, 0.01, 1e-15, 0);
    assert_int_equal(s->simulation.coupling.scheme, BOUGH_SCENE_RAMP);
    check_near(s->simulation.coupling.theta, 0, 0, 0);
    check_near(s->simulation.output.interval, 0.05, 1e-15, 0);
    check_near(s->simulation.micro.rtol, 1e-4, 0, 0);
    assert_int_equal(s->n_body, 5);
    const bough_scene_joint *hub = &s->body[2].joint;
    assert_int_equal(hub->kind, BOUGH_SCENE_REVOLUTE);
    assert_int_equal(hub->parent, 1);
    assert_int_equal(hub->axis, BOUGH_SCENE_X);
    check_near(hub->speed, 0.5, 0, 0);
    assert_int_equal(hub->n_placement, 3);
    assert_false(hub->placement[0].rotate);
    assert_int_equal(hub->placement[0].axis, BOUGH_SCENE_Z);
    check_near(hub->placement[0].amount, 1.2, 0, 0);
    assert_true(hub->placement[1].rotate);
    assert_int_equal(hub->placement[1].axis, BOUGH_SCENE_Y);
    check_near(hub->placement[1].amount, 5 * degree, 1e-15, 0);
    check_near(hub->placement[2].amount, -2, 0, 0);
    check_near(s->body[1].mass, 2000, 0, 0);
    check_near(s->body[2].inertia[0], 1200, 0, 0);
    check_near(s->body[2].centre_of_mass[0], 0.1, 0, 0);
    assert_int_equal(s->body[0].joint.parent, BOUGH_SCENE_GROUND);
    check_blade(&s->body[3]);
    assert_ptr_equal(s->body[3].rod.structure.station, s->body[4].rod.structure.station);
    stop(&f);
}

static void aerodynamics_are_read(void **state) {
    (void)state;
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
    check_near(a->wind.speed, 12, 0, 0);
    check_near(a->ramp[1], 0.5, 0, 0);
    assert_int_equal(a->hold, BOUGH_SCENE_LINEAR);
    assert_int_equal(a->induction.skew, BOUGH_SCENE_PITT_PETERS);
    assert_true(a->induction.drag);
    assert_int_equal(a->tower.n_height, 2);
    check_near(a->tower.diameter[1], 1.2, 0, 0);
    assert_int_equal(a->wind.kind, BOUGH_SCENE_WIND_UNIFORM);
    assert_int_equal(a->induction.inflow, BOUGH_SCENE_EQUILIBRIUM);
    assert_null(a->wind.table.node);
    check_near(a->wind.direction, 0, 0, 0);
    assert_int_equal(a->tower.influence, BOUGH_SCENE_POTENTIAL);
    assert_int_equal(a->tower.shadow, BOUGH_SCENE_SHADOW_NONE);
    assert_int_equal(a->tower.n_drag, 1);
    check_near(a->tower.drag[0], 1, 0, 0);
    check_near(a->hub_radius, 1.5, 0, 0);
    assert_int_equal(a->blade.n_station, 3);
    check_near(a->blade.station[1].ac[1], -0.3, 0, 0);
    check_near(a->blade.station[1].twist, 6.5 * degree, 1e-15, 0);
    assert_int_equal(a->blade.station[0].polar, 0);
    assert_int_equal(a->blade.station[2].polar, 1);
    assert_int_equal(a->polars.polar[1].n_row, 6);
    check_near(a->polars.polar[1].row[3].alpha, 10 * degree, 1e-15, 0);
    check_near(a->polars.polar[1].row[4].cm, -0.2, 0, 0);
    stop(&f);
}

static void uniform_beam_needs_no_table(void **state) {
    (void)state;
    fixture f = read_scene(SCENES "example-beam.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    const bough_scene *s = f.scene;
    const bough_scene_structure *beam = &s->body[0].rod.structure;
    assert_int_equal(beam->n_station, 1);
    check_near(beam->length, 2, 0, 0);
    check_near(beam->station[0].stiffness[28], 700, 0, 0);
    check_near(beam->station[0].mass, 1.5, 0, 0);
    check_near(beam->damping[0], 0, 0, 0);
    check_near(s->simulation.output.interval, s->simulation.macro_step, 0, 0);
    assert_int_equal(s->simulation.threads, 1);
    assert_int_equal(s->simulation.coupling.scheme, BOUGH_SCENE_RAMP);
    assert_null(s->aero.node);
    assert_null(s->turbine.node);
    check_near(s->gravity[2], -9.80665, 0, 0);
    stop(&f);
}

// Every scene that the project ships must be a good one.
static void shipped_scenes_are_good(void **state) {
    (void)state;
    const char *const names[] = {"turbine/runup.yaml", "turbine/runup-rated.yaml",
                                 "beams/rubber-bar.yaml"};
    for (int i = 0; i < 3; i++) {
        char path[300];
        snprintf(path, sizeof path, "%s/apps/%s", BOUGH_SOURCE_DIR, names[i]);
        if (access(path, R_OK) != 0) continue;
        fixture f = read_scene(path, NULL, 0);
        assert_string_equal(f.printed, "");
        stop(&f);
    }
}

static void parents_come_first_in_the_order(void **state) {
    (void)state;
    write_file("s.yaml",
               SIMULATION "bodies:\n"
                          "  - {name: c, fidelity: rigid, joint: {kind: fixed, parent: b}}\n"
                          "  - {name: b, fidelity: rigid, joint: {kind: fixed, parent: a}}\n"
                          "  - {name: a, fidelity: rigid, joint: {kind: fixed, parent: ground}}\n");
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    assert_int_equal(f.scene->order[0], 2);
    assert_int_equal(f.scene->order[1], 1);
    assert_int_equal(f.scene->order[2], 0);
    stop(&f);
}

static void free_and_sliding_joints_start_moving(void **state) {
    (void)state;
    write_file("s.yaml", SIMULATION
               "bodies:\n"
               "  - name: a\n    fidelity: rigid\n    mass: 1\n    inertia: [1, 2, 3]\n"
               "    joint: {kind: free, parent: ground, velocity: [1, 2, 3 km/h],\n"
               "            angular_velocity: [0, 1 rpm, 0]}\n"
               "  - name: b\n    fidelity: rigid\n    mass: 2 kg\n"
               "    joint: {kind: prismatic, parent: a, axis: y, position: 2 cm, speed: -1 m/s}\n");
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    const bough_scene_joint *a = &f.scene->body[0].joint, *b = &f.scene->body[1].joint;
    check_near(a->velocity[2], 3 / 3.6, 1e-15, 0);
    check_near(a->angular_velocity[1], 6 * degree, 1e-15, 0);
    check_near(b->position, 0.02, 1e-15, 0);
    check_near(b->speed, -1, 0, 0);
    assert_int_equal(b->axis, BOUGH_SCENE_Y);
    check_near(f.scene->body[0].inertia[2], 3, 0, 0);
    check_near(f.scene->body[0].inertia[3], 0, 0, 0);
    stop(&f);
}

static void joints_of_several_axes_are_read(void **state) {
    (void)state;
    write_file("s.yaml", SIMULATION
               "bodies:\n"
               "  - {name: a, fidelity: rigid, mass: 1, inertia: [1, 2, 3], joint: {kind: universal,\n"
               "     parent: ground, axis: x, second_axis: y, angles: [10 deg, -5 deg],\n"
               "     angular_speeds: [0, 1 rpm]}}\n"
               "  - {name: b, fidelity: rigid, mass: 1, inertia: [1, 2, 3], joint: {kind: planar,\n"
               "     parent: a, axis: z, positions: [1, 2 cm], angle: 3 deg, speeds: [4, 5],\n"
               "     angular_speed: 6}}\n"
               "  - {name: c, fidelity: rigid, mass: 1, inertia: [1, 2, 3], joint: {kind:\n"
               "     cylindrical, parent: b, axis: z, position: 2 cm, angle: 90 deg, speed: 3,\n"
               "     angular_speed: 1 rpm}}\n");
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    const bough_scene_joint *a = &f.scene->body[0].joint, *b = &f.scene->body[1].joint;
    const bough_scene_joint *c = &f.scene->body[2].joint;
    assert_int_equal(a->second_axis, BOUGH_SCENE_Y);
    check_near(a->angles[1], -5 * degree, 1e-15, 0);
    check_near(a->angular_speeds[1], 6 * degree, 1e-15, 0);
    check_near(b->positions[1], 0.02, 1e-15, 0);
    check_near(b->angle, 3 * degree, 1e-15, 0);
    check_near(b->speeds[0], 4, 0, 0);
    check_near(b->angular_speed, 6, 0, 0);
    check_near(c->position, 0.02, 1e-15, 0);
    check_near(c->angle, 90 * degree, 1e-15, 0);
    check_near(c->speed, 3, 0, 0);
    check_near(c->angular_speed, 6 * degree, 1e-15, 0);
    stop(&f);
    refuses(SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n    mass: 1\n"
                       "    joint: {kind: universal, parent: ground, axis: x, second_axis: x}\n",
            "s.yaml:6:68: error: bodies[0].joint.second_axis: must not be the first axis\n");
}

static void stops_need_a_stiffness_and_an_order(void **state) {
    (void)state;
#define HINGE(more)                                                                                \
    SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n    inertia: [1, 1, 1]\n    joint:\n"     \
               "      {kind: revolute, parent: ground, axis: x, " more "}\n"
    accepts(HINGE("rest: 5 deg, stiffness: 3, stop: [-10 deg, 10 deg], stop_stiffness: 4"));
    refuses(HINGE("stop: [0, 1]"), "s.yaml:7:55: error: bodies[0].joint.stop: 'stop' and "
                                   "'stop_stiffness' go together\n");
    refuses(HINGE("stop: [1, 1], stop_stiffness: 4"),
            "s.yaml:7:55: error: bodies[0].joint.stop: the second must be greater than the "
            "first\n");
    refuses(HINGE("stiffness: -1"),
            "s.yaml:7:60: error: bodies[0].joint.stiffness: must be >= 0, got '-1'\n");
#undef HINGE
}

static void tables_of_joint_loads_are_checked(void **state) {
    (void)state;
#define LOADED(more)                                                                               \
    SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n    inertia: [1, 1, 1]\n"               \
               "    joint: {kind: revolute, parent: ground, axis: x}\nloads:\n"                    \
               "  - {joint: a, torque: " more "}\n"
    accepts(LOADED("{times: [0, 1 s], values: [2 kN m, 0]}"));
    refuses(LOADED("{times: [0, 1, 1], values: [2, 0, 1]}"),
            "s.yaml:8:39: error: loads[0].torque.times: must increase\n");
    refuses(LOADED("{times: [0, 1], values: [2, 0, 1]}"),
            "s.yaml:8:24: error: loads[0].torque: 2 times, but 3 values\n");
    refuses(LOADED("{times: [0, 1]}"),
            "s.yaml:8:24: error: loads[0].torque: required key 'values' is missing\n");
#undef LOADED
}

static void springs_join_two_rigid_bodies(void **state) {
    (void)state;
    accepts(ONE_BODY "springs:\n  - {name: s, from: ground, to: a, to_point: [1, 0, 0]}\n");
    refuses(ONE_BODY "springs:\n  - {name: s, from: a, to: a}\n",
            "s.yaml:7:28: error: springs[0].to: must be another body\n");
    refuses(ONE_BODY "springs:\n  - {name: s, from: zzzzz, to: a}\n",
            "s.yaml:7:21: error: springs[0].from: there is no body 'zzzzz'\n");
}

static void closures_join_two_rigid_bodies(void **state) {
    (void)state;
#define CLOSED(rest) ONE_BODY "closures:\n  - {name: c, from: ground, to: a, " rest "}\n"
    accepts(CLOSED("kind: spherical"));
    accepts(CLOSED("kind: revolute, axis: y, to_placement: [move x 1 m, rotate z 5 deg]"));
    refuses(CLOSED("kind: revolute"),
            "s.yaml:7:5: error: closures[0]: required key 'axis' is missing\n");
    refuses(CLOSED("kind: spherical, from_placement: [move q 1 m]"),
            "s.yaml:7:70: error: closures[0].from_placement[0]: expected 'move x|y|z LENGTH' or "
            "'rotate x|y|z ANGLE', got 'move q 1 m'\n");
    refuses(ONE_BODY "closures:\n  - {name: c, kind: fixed, from: a, to: a}\n",
            "s.yaml:7:41: error: closures[0].to: must be another body\n");
#undef CLOSED
}

static void rods_may_be_curved(void **state) {
    (void)state;
    write_file("blade.yaml", "damping: [1 ms, 0, 0, 0, 0, 0]\n"
                             "stations:\n"
                             "  columns: [span, axis, stiffness, mass]\n"
                             "  rows:\n"
                             "    - [0, [0, 0], [1, 1, 1, 1, 1, 1], [1, 0, 0, 1, 1, 0]]\n"
                             "    - [3, [0.1, -0.2], [1, 1, 1, 1, 1, 1], [1, 0, 0, 1, 1, 0]]\n");
    write_file("s.yaml", ROD_BODY "    rod: {table: blade.yaml, damping: [0, 0, 0, 0, 0, 2 ms]}\n");
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    const bough_scene_structure *s = &f.scene->body[0].rod.structure;
    check_near(s->length, 3, 0, 0); // the last span
    check_near(s->station[1].position[0], 0.1, 0, 0);
    check_near(s->station[1].position[1], -0.2, 0, 0);
    check_near(s->damping[0], 0, 0, 0); // the scene's, not the table's
    check_near(s->damping[5], 2e-3, 1e-15, 0);
    stop(&f);
}

static void rods_may_be_parts_of_a_table(void **state) {
    (void)state;
    write_file("blade.yaml", "stations:\n"
                             "  columns: [span, twist deg, axis, stiffness, mass]\n"
                             "  rows:\n"
                             "    - [0, 0, [0, 0], [1, 1, 1, 1, 1, 1], [1, 0, 0, 1, 1, 0]]\n"
                             "    - [2, 30, [0, 0], [1, 1, 1, 1, 1, 1], [3, 0, 0, 1, 1, 0]]\n"
                             "    - [3, 30, [0.4, 0], [1, 1, 9, 1, 1, 1], [7, 0, 0, 1, 1, 0]]\n");
    write_file("s.yaml", ROD_BODY "    rod: {table: blade.yaml, part: [0.5, 2.5]}\n");
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    const bough_scene_structure *s = &f.scene->body[0].rod.structure;
    static const double span[] = {0, 1.5, 2}, mass[] = {1.5, 3, 5}, shift[] = {0, 0, 0.2};
    static const double twist[] = {7.5, 30, 30}, axial[] = {1, 1, 5};
    check_near(s->length, 2, 0, 0);
    assert_int_equal(s->n_station, 3);
    for (int k = 0; k < 3; k++) {
        check_near(s->station[k].position[2], span[k], 1e-15, 0);
        check_near(s->station[k].position[0], shift[k], 1e-15, 0);
        check_near(s->station[k].mass, mass[k], 1e-15, 0);
        check_near(s->station[k].twist, twist[k] * degree, 1e-15, 0);
        check_near(s->station[k].stiffness[14], axial[k], 1e-15, 0);
    }
    stop(&f);
    refuses(ROD_BODY "    rod: {table: blade.yaml, part: [1, 4]}\n",
            "s.yaml:6:36: error: bodies[0].rod.part: must be a stretch of the table, which is 3 m "
            "long, got [1 m, 4 m]\n");
}

// -- bad scenes
// ---------------------------------------------------------------------------------------

static void all_errors_are_shown_in_order(void **state) {
    (void)state;
    refuses(
        "titel: x\n"
        "simulation:\n"
        "  duration: 1 kg\n"
        "  coupling: {scheme: rampe}\n"
        "bodies:\n"
        "  - name: a\n"
        "    fidelity: rigid\n"
        "    joint: {kind: revolute, parent: grond}\n"
        "    mass: -1\n"
        "loads:\n"
        "  - {joint: b, torque: 1}\n",
        "s.yaml:1:1: error: unknown key 'titel' (did you mean 'title'?)\n"
        "s.yaml:3:3: error: simulation: required key 'macro_step' is missing\n"
        "s.yaml:3:13: error: simulation.duration: expected a time (in s, or with a unit, as '20 "
        "ms'), got '1 kg': the unit 'kg' does not fit\n"
        "s.yaml:4:22: error: simulation.coupling.scheme: expected one of frozen, gauss-seidel, "
        "extrapolated, iterated, ramp, monolithic, got 'rampe' (did you mean 'ramp'?)\n"
        "s.yaml:8:12: error: bodies[0].joint: required key 'axis' is missing\n"
        "s.yaml:8:37: error: bodies[0].joint.parent: there is no body 'grond' (did you mean 'ground'?)\n"
        "s.yaml:9:11: error: bodies[0].mass: must be >= 0 kg, got '-1'\n"
        "s.yaml:11:13: error: loads[0].joint: there is no body 'b' (did you mean 'a'?)\n");
}

static void missing_parts_are_named(void **state) {
    (void)state;
    refuses("title: x\n", "s.yaml:1:1: error: required key 'simulation' is missing\n"
                          "s.yaml:1:1: error: required key 'bodies' is missing\n");
    refuses(SIMULATION "bodies: []\n", "s.yaml:2:9: error: bodies: expected at least 1 item, got "
                                       "0\n");
    refuses(SIMULATION "bodies:\n  - {}\n",
            "s.yaml:3:5: error: bodies[0]: required key 'name' is missing\n"
            "s.yaml:3:5: error: bodies[0]: required key 'fidelity' is missing\n"
            "s.yaml:3:5: error: bodies[0]: required key 'joint' is missing\n");
}

static void joint_keys_fit_the_kind(void **state) {
    (void)state;
    refuses(SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n    mass: 1\n"
                       "    joint: {kind: fixed, parent: ground, axis: x, angle: 0, speed: 1}\n",
            "s.yaml:6:42: error: bodies[0].joint.axis: only used with 'kind: "
            "revolute/prismatic/cylindrical/universal/planar'\n"
            "s.yaml:6:51: error: bodies[0].joint.angle: only used with 'kind: "
            "revolute/cylindrical/planar'\n"
            "s.yaml:6:61: error: bodies[0].joint.speed: only used with 'kind: "
            "revolute/prismatic/cylindrical'\n");
    refuses(
        SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n    mass: 1\n"
                   "    joint: {kind: prismatic, parent: ground, axis: w, position: 1 deg}\n",
        "s.yaml:6:52: error: bodies[0].joint.axis: expected one of x, y, z, got 'w' (did you "
        "mean 'x'?)\n"
        "s.yaml:6:65: error: bodies[0].joint.position: expected a length (in m, or with a unit, "
        "as '61.5 m'), got '1 deg': the unit 'deg' does not fit\n");
}

static void bad_placements_are_refused(void **state) {
    (void)state;
    refuses(SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n"
                       "    joint:\n      kind: fixed\n      parent: ground\n      placement:\n"
                       "        - shift z 1\n        - move w 1\n        - move z 1 deg\n"
                       "        - rotate x\n        - rotate x 5 deg 2\n        - [move]\n",
            "s.yaml:9:11: error: bodies[0].joint.placement[0]: expected 'move x|y|z LENGTH' or "
            "'rotate x|y|z ANGLE', got 'shift z 1'\n"
            "s.yaml:10:11: error: bodies[0].joint.placement[1]: expected 'move x|y|z LENGTH' or "
            "'rotate x|y|z ANGLE', got 'move w 1'\n"
            "s.yaml:11:11: error: bodies[0].joint.placement[2]: expected 'move x|y|z LENGTH' or "
            "'rotate x|y|z ANGLE', got 'move z 1 deg': the unit 'deg' does not fit\n"
            "s.yaml:12:11: error: bodies[0].joint.placement[3]: expected 'move x|y|z LENGTH' or "
            "'rotate x|y|z ANGLE', got 'rotate x'\n"
            "s.yaml:13:11: error: bodies[0].joint.placement[4]: expected 'move x|y|z LENGTH' or "
            "'rotate x|y|z ANGLE', got 'rotate x 5 deg 2': unknown unit '2'\n"
            "s.yaml:14:11: error: bodies[0].joint.placement[5]: expected 'move x|y|z LENGTH' or "
            "'rotate x|y|z ANGLE', got a list\n");
}

static void names_are_checked(void **state) {
    (void)state;
#define BODY(name, parent)                                                                         \
    "  - {name: " name ", fidelity: rigid, joint: {kind: fixed, parent: " parent "}}\n"
    refuses(SIMULATION "bodies:\n" BODY("a", "ground") BODY("a", "ground") BODY("ground", "a")
                BODY("a b/c", "a"),
            "s.yaml:4:12: error: bodies[1].name: body 'a' is given twice\n"
            "s.yaml:5:12: error: bodies[2].name: 'ground' is no name for a body\n"
            "s.yaml:6:12: error: bodies[3].name: a name has letters, digits, '_' and '-', got 'a "
            "b/c'\n");
    refuses(SIMULATION "bodies:\n" BODY("tower", "ground") BODY("hub", "twoer"),
            "s.yaml:4:63: error: bodies[1].joint.parent: there is no body 'twoer' (did you mean "
            "'tower'?)\n");
}

static void loops_of_parents_are_refused(void **state) {
    (void)state;
    refuses(SIMULATION "bodies:\n" BODY("a", "a"),
            "s.yaml:3:61: error: bodies[0].joint.parent: parents form a loop: a -> a\n");
    refuses(SIMULATION "bodies:\n" BODY("z", "c") BODY("b", "c") BODY("c", "d") BODY("d", "b")
                BODY("e", "ground"),
            "s.yaml:4:61: error: bodies[1].joint.parent: parents form a loop: b -> c -> d -> b\n");
}

static void moving_joints_need_mass(void **state) {
    (void)state;
    refuses(SIMULATION "bodies:\n  - {name: a, fidelity: rigid, joint: {kind: revolute, parent: "
                       "ground, axis: x}}\n" BODY("b", "a"),
            "s.yaml:3:5: error: bodies[0]: a joint that moves must carry mass: give 'mass' here or "
            "to a body that hangs on this one\n");
    accepts(SIMULATION
            "bodies:\n  - {name: a, fidelity: rigid, joint: {kind: revolute, parent: "
            "ground, axis: x}}\n"
            "  - {name: b, fidelity: rigid, mass: 1, joint: {kind: fixed, parent: a}}\n");
}

static void body_keys_fit_the_fidelity(void **state) {
    (void)state;
    refuses(ROD_BODY,
            "s.yaml:3:5: error: bodies[0]: required key 'rod' is missing (with 'fidelity: "
            "rod')\n");
    refuses(ONE_BODY "    pitch: 1 deg\n", "s.yaml:6:12: error: bodies[0].pitch: only used with a "
                                           "rod\n");
    refuses(ROD_BODY "    mass: 1\n"
                     "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, "
                     "0]}\n",
            "s.yaml:6:5: error: bodies[0].mass: only used with 'fidelity: rigid'\n");
    refuses(ONE_BODY "    mass: 1\n    inertia: [1, 1, 1]\n"
                     "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, "
                     "0]}\n",
            "s.yaml:6:11: error: bodies[0].mass: follows from the body's rod\n"
            "s.yaml:7:14: error: bodies[0].inertia: follows from the body's rod\n");
    refuses(ROD_BODY "    rod: {part: [0, 1], length: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, "
                     "0, 0, 1, 1, 0]}\n",
            "s.yaml:6:17: error: bodies[0].rod.part: only used with a table\n");
    refuses(ONE_BODY "    inertia: [1, 1, 1, 2, 0, 0]\n",
            "s.yaml:6:14: error: bodies[0].inertia: the inertia matrix must not be negative about "
            "any axis\n");
    refuses(ONE_BODY "    inertia: [1, 2]\n",
            "s.yaml:6:14: error: bodies[0].inertia: expected a list [Ixx, Iyy, Izz] or with Ixy, "
            "Ixz, Iyz, got 2 items\n");
}

static void rods_are_complete(void **state) {
    (void)state;
    refuses(
        ROD_BODY "    rod: {segments: 4}\n",
        "s.yaml:6:10: error: bodies[0].rod: required key 'length' is missing (without a "
        "table)\n"
        "s.yaml:6:10: error: bodies[0].rod: required key 'stiffness' is missing (without a "
        "table)\n"
        "s.yaml:6:10: error: bodies[0].rod: required key 'mass' is missing (without a table)\n");
    refuses(
        ROD_BODY "    rod: {table: none.yaml, segments: 0}\n",
        "s.yaml:6:18: error: bodies[0].rod.table: file 'none.yaml' cannot be read: No such file "
        "or directory\n"
        "s.yaml:6:39: error: bodies[0].rod.segments: must be in [1, 10000], got '0'\n");
    refuses(ROD_BODY "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1], mass: [1, 0, 0]}\n",
            "s.yaml:6:33: error: bodies[0].rod.stiffness: expected a list of 6 (diagonal) or 21 "
            "(upper triangle) numbers, got 5 items\n"
            "s.yaml:6:56: error: bodies[0].rod.mass: expected a list [m, cx, cy, Ixx, Iyy, Ixy] or "
            "with Izz, got 3 items\n");
    write_file("blade.yaml", "length: 1\nstations: [{span: 0, stiffness: [1, 1, 1, 1, 1, 1], mass: "
                             "[1, 0, 0, 1, 1, 0]}]\n");
    refuses(ROD_BODY "    rod: {table: blade.yaml, length: 2}\n",
            "s.yaml:6:38: error: bodies[0].rod.length: only used without a table\n");
}

static void section_matrices_are_checked(void **state) {
    (void)state;
    refuses(ROD_BODY
            "    rod:\n      length: 1\n"
            "      stiffness: [1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 1, 0, "
            "1]\n      mass: [1, 0, 0, 1, 1, 0]\n",
            "s.yaml:8:18: error: bodies[0].rod.stiffness: the stiffness matrix must be positive "
            "definite\n");
    refuses(ROD_BODY "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 0], mass: [0, 0, 0, 1, 1, "
                     "0]}\n",
            "s.yaml:6:33: error: bodies[0].rod.stiffness: the stiffness matrix must be positive "
            "definite\n"
            "s.yaml:6:60: error: bodies[0].rod.mass: the mass per length must be > 0 kg/m\n");
    // Negative in the last pivot only.
    refuses(ROD_BODY
            "    rod:\n      length: 1\n"
            "      stiffness: [1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2, "
            "1]\n      mass: [1, 0, 0, 1, 1, 0]\n",
            "s.yaml:8:18: error: bodies[0].rod.stiffness: the stiffness matrix must be positive "
            "definite\n");
    // About the mass centre nothing is left of Iyy = m cx².
    refuses(ROD_BODY "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [4, 0.5, 0, 1, 1, "
                     "0]}\n",
            "s.yaml:6:59: error: bodies[0].rod.mass: the inertia about the mass centre must be "
            "positive definite\n");
    accepts(ROD_BODY
            "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [4, 0.5, 0, 1, 1.01, "
            "0]}\n");
}

// A structure table with these spans must give these errors.
static void refuses_spans(const char *length, const char *spans[3], const char *lines) {
    char text[600];
    int used = snprintf(text, sizeof text,
                        "%sstations:\n  columns: [span, stiffness, mass]\n"
                        "  rows:\n",
                        length);
    for (int i = 0; i < 3 && spans[i] != NULL; i++) {
        used += snprintf(text + used, sizeof text - (size_t)used,
                         "  - [%s, [1, 1, 1, 1, 1, 1], [1, 0, 0, 1, 1, 0]]\n", spans[i]);
    }
    write_file("blade.yaml", text);
    refuses(ROD_BODY "    rod: {table: blade.yaml}\n", lines);
}

static void stations_run_from_zero_to_the_length(void **state) {
    (void)state;
    refuses_spans("", (const char *[3]){"0", "1", "2"}, "");
    refuses_spans("length: 200 cm\n", (const char *[3]){"0", "1", "2"}, "");
    refuses_spans("length: 5\n", (const char *[3]){"0"}, "");
    refuses_spans("", (const char *[3]){"0", "2", "2"},
                  "blade.yaml:6:6: error: stations.rows[2].span: must be more than the 2 m before "
                  "it, got 2 m\n");
    refuses_spans(
        "", (const char *[3]){"0.5", "0.1", "2"},
        "blade.yaml:4:6: error: stations.rows[0].span: the first must be 0 m, got 0.5 m\n"
        "blade.yaml:5:6: error: stations.rows[1].span: must be more than the 0.5 m before "
        "it, got 0.1 m\n");
    refuses_spans("length: 3\n", (const char *[3]){"0", "1", "2"},
                  "blade.yaml:1:9: error: length: is 3 m, but the last station stands at 2 m\n");
    refuses_spans("", (const char *[3]){"0"},
                  "blade.yaml:1:1: error: required key 'length' is missing (with one station)\n");
}

// Two bodies name the same bad table: its errors are shown once.
static void errors_of_a_table_are_shown_once(void **state) {
    (void)state;
    write_file("blade.yaml", "lenght: 3\n");
    refuses(ROD_BODY "    rod: {table: blade.yaml}\n"
                     "  - name: b\n    fidelity: rod\n" JOINT "    rod: {table: blade.yaml}\n",
            "blade.yaml:1:1: error: required key 'stations' is missing\n"
            "blade.yaml:1:1: error: unknown key 'lenght' (did you mean 'length'?)\n");
}

static void times_fit_the_macro_step(void **state) {
    (void)state;
    refuses(
        "simulation: {duration: 1.005, macro_step: 10 ms, output: {interval: 25 ms}}\n"
        "bodies:\n" BODY("a", "ground"),
        "s.yaml:1:24: error: simulation.duration: 1.005 s is not a multiple of the macro step, "
        "0.01 s\n"
        "s.yaml:1:69: error: simulation.output.interval: 0.025 s is not a multiple of the macro "
        "step, 0.01 s\n");
    refuses("simulation: {duration: 1, macro_step: 0.1, output: {interval: 10 ms}}\nbodies:\n" BODY(
                "a", "ground"),
            "s.yaml:1:63: error: simulation.output.interval: 0.01 s is not a multiple of the macro "
            "step, 0.1 s\n");
    accepts("simulation: {duration: 0.3, macro_step: 0.1}\nbodies:\n" BODY("a", "ground"));
}

static void loads_fit_their_joints(void **state) {
    (void)state;
    refuses(SIMULATION
            "bodies:\n" BODY("a", "ground") "  - {name: h, mass: 1, fidelity: rigid, joint: {kind: "
                                            "revolute, parent: a, axis: x}}\n"
                                            "loads:\n"
                                            "  - {joint: a, torque: 1}\n"
                                            "  - {joint: h, force: 1 N}\n"
                                            "  - {joint: h, force: 1 N m}\n"
                                            "  - {joint: h}\n"
                                            "  - {joint: h, torque: 1, force: 2}\n"
                                            "  - {joint: h, torque: 1, ramp: [2, 1]}\n",
            "s.yaml:6:13: error: loads[0].joint: the joint of 'a' must be revolute or prismatic to "
            "take a load\n"
            "s.yaml:7:23: error: loads[1].force: the joint of 'h' is revolute: give a torque\n"
            "s.yaml:8:23: error: loads[2].force: expected a force (in N, or with a unit, as '12 "
            "kN'), got '1 N m': the unit 'N m' does not fit\n"
            "s.yaml:8:23: error: loads[2].force: the joint of 'h' is revolute: give a torque\n"
            "s.yaml:9:5: error: loads[3]: expected either 'torque' or 'force'\n"
            "s.yaml:10:5: error: loads[4]: expected either 'torque' or 'force', got both\n"
            "s.yaml:10:34: error: loads[4].force: the joint of 'h' is revolute: give a torque\n"
            "s.yaml:11:33: error: loads[5].ramp: must end after it starts, got [2 s, 1 s]\n");
}

#define SMALL_ROD                                                                                  \
    "rod: {length: 2, segments: 4, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}"
#define TWO_RODS                                                                                   \
    SIMULATION "bodies:\n" BODY("a", "ground")                                                     \
        "  - {name: b, fidelity: rod, joint: {kind: fixed, parent: ground}, " SMALL_ROD "}\n"       \
        "  - {name: c, fidelity: rod, joint: {kind: revolute, parent: ground, axis: x}, "           \
        SMALL_ROD "}\nloads:\n"

#define MODAL(fidelity) SIMULATION "bodies:\n  - name: a\n    fidelity: " fidelity "\n" JOINT "    "   \
    SMALL_ROD "\n"

static void modal_bodies_are_rods_reduced(void **state) {
    (void)state;
    accepts(MODAL("modal"));
    accepts(MODAL("segmented-modal") "    modal: {modes: 3, statics: false, pieces: 4}\n");
    refuses(MODAL("modal") "    modal: {pieces: 4}\n",
            "s.yaml:7:21: error: bodies[0].modal.pieces: only used with 'fidelity: "
            "segmented-modal'\n");
    refuses(MODAL("segmented-modal"),
            "s.yaml:3:5: error: bodies[0].modal.pieces: 5 pieces of 4 segments: give the rod more "
            "segments\n");
    refuses(MODAL("rod") "    modal: {modes: 3}\n",
            "s.yaml:7:5: error: bodies[0].modal: only used with 'fidelity: "
            "modal/segmented-modal'\n");
    refuses(MODAL("modal") "  - {name: b, fidelity: rigid, joint: {kind: fixed, parent: a}}\n",
            "s.yaml:7:61: error: bodies[1].joint.parent: 'a' is a modal body, which carries none; "
            "make it a rod\n");
    refuses(MODAL("modal") "loads:\n  - {body: a, at: tip, force: [1, 0, 0], frame: follower}\n",
            "s.yaml:8:49: error: loads[0].frame: 'a' is a modal body, on which loads do not turn "
            "with its sections: make it a rod or give 'frame: body'\n");
}

static void loads_act_on_rods(void **state) {
    (void)state;
    write_file("s.yaml", TWO_RODS "  - {body: b, at: tip, force: [1 kN, 0, 2]}\n"
                                  "  - {body: c, at: 3, moment: [0, 0, 2 kN m], frame: follower}\n"
                                  "  - {body: b, at: 150 cm, force: [1, 0, 2], ramp: [0, 1]}\n"
                                  "  - {body: c, along: [0, 2], force: [0, 3 kN/m, 0], frame: body,\n"
                                  "     moment: [1, 2, 3 N m/m]}\n");
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    const bough_scene_load *load = f.scene->load;
    assert_int_equal(load[0].place, BOUGH_SCENE_AT_TIP);
    assert_int_equal(load[0].body, 1);
    check_near(load[0].force[0], 1000, 1e-15, 0);
    assert_int_equal(load[1].place, BOUGH_SCENE_AT_VERTEX);
    assert_int_equal(load[1].vertex, 3);
    assert_int_equal(load[1].frame, BOUGH_SCENE_LOAD_FOLLOWER);
    check_near(load[1].moment[2], 2000, 1e-15, 0);
    assert_int_equal(load[2].place, BOUGH_SCENE_AT_SPAN);
    check_near(load[2].span[0], 1.5, 1e-15, 0);
    check_near(load[2].ramp[1], 1, 0, 0);
    assert_int_equal(load[3].place, BOUGH_SCENE_ALONG);
    check_near(load[3].force[1], 3000, 1e-15, 0);
    check_near(load[3].moment[2], 3, 1e-15, 0);
    stop(&f);
}

static void loads_fit_their_rods(void **state) {
    (void)state;
    refuses(TWO_RODS "  - {torque: 1}\n"
                     "  - {body: b, joint: c, at: tip, force: [1, 2, 3]}\n"
                     "  - {body: b, force: [1, 2, 3]}\n"
                     "  - {body: b, at: tip}\n"
                     "  - {body: b, at: 1.5, force: 3}\n"
                     "  - {body: b, along: [2, 1], force: [1, 2, 3]}\n"
                     "  - {joint: c, torque: 1, at: tip}\n"
                     "  - {body: b, at: tip, torque: 1}\n"
                     "  - {body: b, along: [0, 1], force: [1 N, 2, 3]}\n"
                     "  - {body: a, at: tip, force: [1, 2, 3]}\n"
                     "  - {body: d, at: tip, force: [1, 2, 3]}\n"
                     "  - {body: b, at: 5, force: [1, 2, 3]}\n"
                     "  - {body: b, at: 2.1 m, force: [1, 2, 3]}\n"
                     "  - {body: b, along: [0, 3], force: [1, 2, 3]}\n"
                     "  - {body: c, at: tip, force: [1, 2, 3]}\n"
                     "  - {body: a, force: [1, 2, 3], frame: follower}\n"
                     "  - {body: b, at: tip, force: [1, 2, 3], point: [1, 2, 3]}\n",
            "s.yaml:7:5: error: loads[0]: expected either 'joint' or 'body'\n"
            "s.yaml:8:5: error: loads[1]: expected either 'joint' or 'body', got both\n"
            "s.yaml:9:5: error: loads[2]: expected either 'at' or 'along'\n"
            "s.yaml:10:5: error: loads[3]: expected a 'force' or a 'moment' or both\n"
            "s.yaml:11:19: error: loads[4].at: expected 'tip', the number of a vertex or a "
            "length with its unit, as '30 m', got '1.5'\n"
            "s.yaml:11:31: error: loads[4].force: expected a list of 3 numbers, got '3'\n"
            "s.yaml:12:22: error: loads[5].along: must end after it starts, got [2 m, 1 m]\n"
            "s.yaml:13:31: error: loads[6].at: only used with 'body'\n"
            "s.yaml:14:5: error: loads[7]: expected a 'force' or a 'moment' or both\n"
            "s.yaml:14:32: error: loads[7].torque: only used with 'joint'\n"
            "s.yaml:15:38: error: loads[8].force[0]: expected a force per length (in N/m, or "
            "with a unit, as '2 kN/m'), got '1 N': the unit 'N' does not fit\n"
            "s.yaml:16:19: error: loads[9].at: 'a' is rigid: give the 'point'\n"
            "s.yaml:17:12: error: loads[10].body: there is no body 'd' (did you mean 'a'?)\n"
            "s.yaml:18:19: error: loads[11].at: 'b' has the vertices 0 to 4, got 5\n"
            "s.yaml:19:19: error: loads[12].at: 'b' is 2 m long, got 2.1 m\n"
            "s.yaml:20:22: error: loads[13].along: 'b' is 2 m long, got 3 m\n"
            "s.yaml:21:12: error: loads[14].frame: 'c' moves with the joint of 'c'; loads in "
            "ground axes are built for rods at rest: give 'frame: body' or 'frame: follower'\n"
            "s.yaml:22:40: error: loads[15].frame: 'a' is rigid: 'frame: body' turns with it\n"
            "s.yaml:23:49: error: loads[16].point: only used with a rigid body\n");
    accepts(TWO_RODS "  - {body: a, moment: [1, 2, 3], factor: {times: [0, 1], values: [0, 2]}}\n");
}

static void modes_name_their_axis(void **state) {
    (void)state;
    refuses(TWO_RODS "  []\nmodes: {about: x, axis: [0, 0, 1]}\n",
            "s.yaml:8:16: error: modes.about: there is no body 'x' (did you mean 'a'?)\n"
            "s.yaml:8:25: error: modes.axis: only used without 'about'\n");
    refuses(TWO_RODS "  []\nmodes: {about: a, centre: [0, 0, 1], count: 0}\n",
            "s.yaml:8:16: error: modes.about: the joint of 'a' must be revolute\n"
            "s.yaml:8:27: error: modes.centre: only used with 'axis'\n"
            "s.yaml:8:45: error: modes.count: must be in [1, 60], got '0'\n");
    refuses(TWO_RODS "  []\nmodes: {speed: 10 rpm, axis: [0, 0, 0]}\n",
            "s.yaml:8:30: error: modes.axis: must not be zero\n");
    accepts(TWO_RODS "  []\nmodes: {speed: 10 rpm, about: c, shapes: true}\n");
}

#define ROTOR                                                                                      \
    SIMULATION                                                                                     \
    "bodies:\n  - {name: hub, mass: 1, fidelity: rigid, joint: {kind: revolute, parent: ground, "  \
    "axis: x}}\n"                                                                                  \
    "  - {name: b1, fidelity: rod, joint: {kind: fixed, parent: hub}, rod: &r {length: 5,\n"       \
    "      stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}}\n"                            \
    "  - {name: b2, fidelity: rod, joint: {kind: fixed, parent: ground}, rod: *r}\n"
#define AERO                                                                                       \
    "aero: {rate: 50 Hz, wind: {speed: 8}, blade: aero.yaml, polars: polars.yaml, hub_radius: "    \
    "1}\n"
#define BLADE "stations:\n- {span: 0, chord: 1, polar: p}\n- {span: 5, chord: 1, polar: p}\n"
#define POLARS                                                                                     \
    "polars:\n- name: p\n  table: {columns: [alpha deg, cl, cd, cm], rows: [[-180, 0, 0, 0], "     \
    "[180, 0, 0, 0]]}\n"

static void turbine_names_are_checked(void **state) {
    (void)state;
    refuses(ROTOR "turbine: {rotor: hbu, blades: [b1, b3]}\n",
            "s.yaml:7:18: error: turbine.rotor: there is no body 'hbu' (did you mean 'hub'?)\n"
            "s.yaml:7:36: error: turbine.blades[1]: there is no body 'b3' (did you mean 'b1'?)\n");
    refuses(ROTOR "turbine: {rotor: b1, blades: [b1, b1, hub]}\n",
            "s.yaml:7:18: error: turbine.rotor: the joint of 'b1' must be revolute\n"
            "s.yaml:7:35: error: turbine.blades[1]: blade 'b1' is given twice\n"
            "s.yaml:7:39: error: turbine.blades[2]: body 'hub' has no rod, so it is no blade\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1, b2]}\n",
            "s.yaml:7:36: error: turbine.blades[1]: body 'b2' does not hang on the rotor 'hub'\n");
}

static void aerodynamics_are_consistent(void **state) {
    (void)state;
    write_file("aero.yaml", BLADE);
    write_file("polars.yaml", POLARS);
    accepts(ROTOR "turbine: {rotor: hub, blades: [b1]}\n" AERO);
    refuses(ROTOR AERO, "s.yaml:7:7: error: aero: needs 'turbine', which names rotor and blades\n");
    refuses(
        ROTOR "turbine: {rotor: hub, blades: [b1]}\n"
              "aero: {rate: 30 Hz, wind: {speed: 8}, blade: aero.yaml, polars: polars.yaml,\n"
              "       hub_radius: 1, ramp: [1, 0], tower: {height: [0, 20, 10], diameter: [1, "
              "2]}}\n",
        "s.yaml:8:14: error: aero.rate: its period 0.0333333 s is not a multiple of the macro "
        "step, 0.01 s\n"
        "s.yaml:9:29: error: aero.ramp: must end after it starts, got [1 s, 0 s]\n"
        "s.yaml:9:61: error: aero.tower.height[2]: must be more than the 20 m before it, got 10 "
        "m\n"
        "s.yaml:9:76: error: aero.tower.diameter: has 2 values, but height has 3\n");
    refuses(
        ROTOR "turbine: {rotor: hub, blades: [b1]}\n"
              "aero: {rate: 50 Hz, wind: {speed: 8}, blade: aero.yaml, polars: polars.yaml,\n"
              "       hub_radius: 1, tower: {height: [0, 10, 20], diameter: [1, 1, 1], "
              "drag: [1, 2]}}\n",
        "s.yaml:9:79: error: aero.tower.drag: has 2 values, but height has 3; give one or as "
        "many\n");
    write_file("aero.yaml", "stations:\n- {span: 0, chord: 1, polar: p}\n"
                            "- {span: 6, chord: 0, polar: q}\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1]}\n" AERO,
            "s.yaml:8:46: error: aero.blade: the blade elements end at 6 m, but 'b1' is 5 m long\n"
            "aero.yaml:3:20: error: stations[1].chord: must be > 0 m, got '0'\n"
            "aero.yaml:3:30: error: stations[1].polar: the polars file has no 'q' (did you mean "
            "'p'?)\n");
    write_file("aero.yaml", "stations:\n- {span: 0, chord: 1, polar: p}\n"
                            "- {span: 0, chord: 1, polar: p}\n");
    refuses(ROTOR AERO, "s.yaml:7:7: error: aero: needs 'turbine', which names rotor and blades\n"
                        "aero.yaml:3:10: error: stations[1].span: must be more than the 0 m before "
                        "it, got 0 m\n");
}

#define WIND(keys)                                                                                 \
    ROTOR "turbine: {rotor: hub, blades: [b1]}\n"                                                  \
          "aero:\n  rate: 50 Hz\n  blade: aero.yaml\n  polars: polars.yaml\n"                      \
          "  hub_radius: 1\n"                                                                      \
          "  wind: {" keys "}\n"

static void wind_is_a_speed_or_a_table(void **state) {
    (void)state;
    write_file("aero.yaml", BLADE);
    write_file("polars.yaml", POLARS);
    accepts(WIND("table: {times: [0, 10 s], speeds: [8, 9]}, direction: 5 deg, vertical: -1"));
    accepts(WIND("kind: power, speed: 8, exponent: 0.14, reference_height: 90"));
    refuses(WIND("direction: 0"), "s.yaml:13:9: error: aero.wind: required key 'speed' is missing "
                                  "(without a table)\n");
    refuses(WIND("speed: 8, table: {times: [0, 1], speeds: [8, 9]}"),
            "s.yaml:13:17: error: aero.wind.speed: only used without a table\n");
    refuses(WIND("table: {times: [0, 1, 1], speeds: [8, 9]}"),
            "s.yaml:13:32: error: aero.wind.table.times[2]: must be more than the 1 s before it, "
            "got 1 s\n"
            "s.yaml:13:44: error: aero.wind.table.speeds: has 2 values, but times has 3\n");
    refuses(WIND("speed: 8, kind: log, reference_height: 1, roughness: 2"),
            "s.yaml:13:49: error: aero.wind.reference_height: must be more than the roughness, "
            "2 m, got 1 m\n");
}

static void polars_cover_the_circle(void **state) {
    (void)state;
    write_file("aero.yaml", BLADE);
    write_file("polars.yaml", "polars:\n- name: p\n  table:\n    columns: [alpha deg, cl, cd, cm]\n"
                              "    rows:\n    - [-180, 0, 0, 0]\n    - [-180, 0, 0, 0]\n"
                              "    - [180, 0, 0, 0]\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1]}\n" AERO,
            "polars.yaml:7:8: error: polars[0].table.rows[1].alpha: must be more than the -180 deg "
            "before it, got -180 deg\n");
    write_file("polars.yaml", "polars:\n- name: p\n  table:\n    columns: [alpha deg, cl, cd, cm]\n"
                              "    rows:\n    - [-180, 0, 0, 0]\n    - [90, 0, 0, 0]\n"
                              "- name: r\n  table:\n    columns: [alpha deg, cl, cd, cm]\n"
                              "    rows:\n    - [0, 0, 0, 0]\n    - [180, 0, 0, x]\n"
                              "- name: s\n  table: [{alpha: 0, cl: 0, cd: 0, cm: 0}, "
                              "{alpha: 180 deg, cl: 0, cd: 0, cm: 0}]\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1]}\n" AERO,
            "polars.yaml:7:8: error: polars[0].table.rows[1].alpha: the last must be 180 deg, got "
            "90 deg\n"
            "polars.yaml:13:19: error: polars[1].table.rows[1].cm: expected a number, got 'x'\n"
            "polars.yaml:15:19: error: polars[2].table[0].alpha: the first must be -180 deg, got 0 "
            "deg\n");
    write_file("polars.yaml", POLARS "- name: p\n  table: [{alpha: -180 deg, cl: 0, cd: 0, cm: 0}, "
                                     "{alpha: 180 deg, cl: 0, cd: 0, cm: 0}]\n");
    refuses(ROTOR "turbine: {rotor: hub, blades: [b1]}\n" AERO,
            "polars.yaml:4:9: error: polars[1].name: polar 'p' is given twice\n");
}

// -- replacements
// -------------------------------------------------------------------------------------

static void values_can_be_replaced_and_added(void **state) {
    (void)state;
    const char *const sets[] = {"simulation.coupling.scheme=extrapolated",
                                "simulation.coupling.order=2",
                                "bodies[3].pitch=5 deg",
                                "aero.wind={kind: uniform, speed: 9 m/s}",
                                "title=now: this",
                                "turbine.blades[1]=blade2"};
    fixture f = read_scene(SCENES "example-turbine.yaml", sets, 6);
    assert_string_equal(f.printed, "--set: error: title: expected text, got a mapping\n");
    stop(&f);
    f = read_scene(SCENES "example-turbine.yaml", sets, 4);
    assert_string_equal(f.printed, "");
    assert_int_equal(f.scene->simulation.coupling.scheme, BOUGH_SCENE_EXTRAPOLATED);
    assert_int_equal(f.scene->simulation.coupling.order, 2);
    check_near(f.scene->body[3].pitch, 5 * degree, 1e-15, 0);
    check_near(f.scene->body[4].pitch, 6.5 * degree, 1e-15, 0);
    check_near(f.scene->aero.wind.speed, 9, 0, 0);
    stop(&f);
}

static void missing_mappings_are_made(void **state) {
    (void)state;
    const char *const sets[] = {"simulation.micro.rtol=1e-8", "simulation.threads=3"};
    fixture f = read_scene(SCENES "example-beam.yaml", sets, 2);
    assert_string_equal(f.printed, "");
    check_near(f.scene->simulation.micro.rtol, 1e-8, 0, 0);
    assert_int_equal(f.scene->simulation.threads, 3);
    stop(&f);
}

// A rod shared by an alias changes for the named body only.
static void shared_values_are_copied_first(void **state) {
    (void)state;
    write_file("s.yaml", ROTOR);
    const char *const sets[] = {"bodies[1].rod.length=7"};
    fixture f = read_scene("s.yaml", sets, 1);
    assert_string_equal(f.printed, "");
    check_near(f.scene->body[1].rod.structure.length, 7, 0, 0);
    check_near(f.scene->body[2].rod.structure.length, 5, 0, 0);
    stop(&f);
}

static void bad_replacements_are_refused(void **state) {
    (void)state;
    const char *const sets[] = {"abc",
                                "=1",
                                "title=",
                                "bodies[7].pitch=1",
                                "bodies[x].pitch=1",
                                "bodies[0=1",
                                "title.x=1",
                                "title[0]=1",
                                "bodies.x=1",
                                "a..b=1",
                                "bodies[0]x=1",
                                "title=[1",
                                "simulation.thread=2",
                                "bodies[3].pitch=5 kg",
                                "simulation.macro_step=0"};
    fixture f = read_scene(SCENES "example-turbine.yaml", sets, 15);
    assert_string_equal(f.printed,
                        "--set: error: abc: expected KEY=VALUE\n"
                        "--set: error: =1: expected KEY=VALUE\n"
                        "--set: error: title: expected a value after '='\n"
                        "--set: error: bodies[7].pitch: index [7].pitch is beyond the last, [4]\n"
                        "--set: error: bodies[x].pitch: expected an index such as [0] or [0-2]\n"
                        "--set: error: bodies[0: expected an index such as [0] or [0-2]\n"
                        "--set: error: title.x: key 'x' is looked for in 'Two-bladed example'\n"
                        "--set: error: title[0]: there is no list to take an index of\n"
                        "--set: error: bodies.x: key 'x' is looked for in a list\n"
                        "--set: error: a..b: expected a key\n"
                        "--set: error: bodies[0]x: expected '.' or '['\n"
                        "--set: error: title: expected ',' or ']' to end the list\n"
                        "--set: error: simulation.macro_step: must be > 0 s, got '0'\n"
                        "--set: error: simulation: unknown key 'thread' (did you mean 'threads'?)\n"
                        "--set: error: bodies[3].pitch: expected an angle (in rad, or with a unit, "
                        "as '5 deg'), got "
                        "'5 kg': the unit 'kg' does not fit\n");
    assert_int_equal(f.status.code, BOUGH_INVALID);
    assert_null(f.scene);
    stop(&f);
}

// -- the rest
// -----------------------------------------------------------------------------------------

static void missing_scene_is_told(void **state) {
    (void)state;
    fixture f = read_scene("none.yaml", NULL, 0);
    assert_string_equal(f.printed, "none.yaml: error: cannot be read: No such file or directory\n");
    assert_int_equal(f.status.code, BOUGH_INVALID);
    assert_string_equal(f.status.message, "none.yaml: 1 error in the scene");
    stop(&f);
}

static void hostile_scenes_end_fast(void **state) {
    (void)state;
    FILE *stream = fopen("s.yaml", "w");
    fputs(SIMULATION "bodies:\n", stream);
    for (int i = 0; i < 9000; i++)
        fprintf(stream, "- {name: n%d, joint: {parent: m%d}}\n", i, i);
    fclose(stream);
    clock_t begin = clock();
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_int_equal(f.errors.n, 100);
    stop(&f);
    stream = fopen("s.yaml", "w");
    fputs(SIMULATION "bodies:\n", stream);
    for (int i = 0; i < 10001; i++)
        fputs("- {}\n", stream);
    fclose(stream);
    f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, "s.yaml:3:1: error: bodies: expected at most 10000 items, got "
                                   "10001\n");
    stop(&f);
    assert_true((double)(clock() - begin) / CLOCKS_PER_SEC < 10);
}

static void help_covers_scene_and_files(void **state) {
    (void)state;
    char *text;
    size_t size;
    FILE *stream = open_memstream(&text, &size);
    bough_scene_help(stream);
    fclose(stream);
    const char *const lines[] = {
        "\n  - macro_step: (number in s, > 0; required; e.g. 20 ms)\n",
        "\n    - scheme: (frozen|gauss-seidel|extrapolated|iterated|ramp|monolithic; default "
        "ramp; e.g. frozen)\n",
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

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(turbine_is_read),
        cmocka_unit_test(aerodynamics_are_read),
        cmocka_unit_test(uniform_beam_needs_no_table),
        cmocka_unit_test(shipped_scenes_are_good),
        cmocka_unit_test(parents_come_first_in_the_order),
        cmocka_unit_test(free_and_sliding_joints_start_moving),
        cmocka_unit_test(joints_of_several_axes_are_read),
        cmocka_unit_test(stops_need_a_stiffness_and_an_order),
        cmocka_unit_test(tables_of_joint_loads_are_checked),
        cmocka_unit_test(springs_join_two_rigid_bodies),
        cmocka_unit_test(closures_join_two_rigid_bodies),
        cmocka_unit_test(rods_may_be_curved),
        cmocka_unit_test(rods_may_be_parts_of_a_table),
        cmocka_unit_test(all_errors_are_shown_in_order),
        cmocka_unit_test(missing_parts_are_named),
        cmocka_unit_test(joint_keys_fit_the_kind),
        cmocka_unit_test(bad_placements_are_refused),
        cmocka_unit_test(names_are_checked),
        cmocka_unit_test(loops_of_parents_are_refused),
        cmocka_unit_test(moving_joints_need_mass),
        cmocka_unit_test(body_keys_fit_the_fidelity),
        cmocka_unit_test(rods_are_complete),
        cmocka_unit_test(section_matrices_are_checked),
        cmocka_unit_test(stations_run_from_zero_to_the_length),
        cmocka_unit_test(errors_of_a_table_are_shown_once),
        cmocka_unit_test(times_fit_the_macro_step),
        cmocka_unit_test(loads_fit_their_joints),
        cmocka_unit_test(modal_bodies_are_rods_reduced),
        cmocka_unit_test(loads_act_on_rods),
        cmocka_unit_test(loads_fit_their_rods),
        cmocka_unit_test(modes_name_their_axis),
        cmocka_unit_test(turbine_names_are_checked),
        cmocka_unit_test(aerodynamics_are_consistent),
        cmocka_unit_test(wind_is_a_speed_or_a_table),
        cmocka_unit_test(polars_cover_the_circle),
        cmocka_unit_test(values_can_be_replaced_and_added),
        cmocka_unit_test(missing_mappings_are_made),
        cmocka_unit_test(shared_values_are_copied_first),
        cmocka_unit_test(bad_replacements_are_refused),
        cmocka_unit_test(missing_scene_is_told),
        cmocka_unit_test(hostile_scenes_end_fast),
        cmocka_unit_test(help_covers_scene_and_files),
    };
    return cmocka_run_group_tests(tests, enter, leave);
}
