// Mechanisms of rigid bodies as whole scenes: from the file to the channels.
#include "apps/output/channels.h"
#include "tests/built_scene.h"

#include <string.h>

static const char *const no_sets[] = {NULL};

typedef struct fixture {
    bough_arena *arena;
    bough_simulation *s;
    bough_channels channels;
    double value[64];
} fixture;

static fixture start(const char *path, const char *const *sets) {
    fixture f = {.arena = bough_arena_create()};
    f.s = scene_build(f.arena, path, sets);
    f.channels = bough_channels_start(f.arena);
    bough_status status = bough_simulation_channels(f.s, &f.channels);
    assert_int_equal(status.code, BOUGH_OK);
    assert_true(f.channels.count <= 64);
    return f;
}

static double channel(fixture *f, const char *name) {
    int index = bough_channels_find(&f->channels, name);
    if (index < 0) print_error("no channel %s\n", name);
    assert_true(index >= 0);
    bough_simulation_update(f->s);
    bough_channels_sample(&f->channels, f->s->master->time, f->value);
    return f->value[index];
}

static void run(fixture *f, int steps) {
    for (int k = 0; k < steps; k++)
        scene_step(f->s);
}

static void joints_of_several_axes_start_and_are_recorded(void **context) {
    (void)context;
    fixture f = start("tests/scenes/joints.yaml", no_sets);
    const double degree = acos(-1.0) / 180;
    check_near(channel(&f, "forkAng1Pos"), 90, 1e-14, 0);
    check_near(channel(&f, "forkAng2Pos"), 30, 1e-14, 0);
    check_near(channel(&f, "forkAng2Vel"), -1 / degree, 1e-14, 0);
    check_near(channel(&f, "pistonPos"), -1, 0, 0);
    check_near(channel(&f, "pistonAngPos"), 40, 1e-14, 0);
    check_near(channel(&f, "pistonAngVel"), 10 / degree, 1e-14, 0);
    check_near(channel(&f, "puck1Vel"), 3, 1e-14, 0);
    check_near(channel(&f, "puck2Vel"), 4, 1e-14, 0);
    // the turn about x takes the fork's y to the ground's z
    const bough_frame *piston = &f.s->tree->bodies[bough_tree_find_body(f.s->tree, "piston")];
    bough_vec3 x = bough_tree_frame_pose(f.s->view, piston).position;
    check_near(x.x, -sin(30 * degree), 1e-14, 0);
    check_near(x.y, cos(30 * degree), 1e-14, 0);
    check_near(x.z, 5, 1e-14, 0);
    run(&f, 50);
    double t = 0.5, g = 9.80665 * sin(30 * degree);
    check_near(channel(&f, "puck1Pos"), 1 + 3 * t, 1e-6, 0);
    check_near(channel(&f, "puck2Pos"), 2 + 4 * t - 0.5 * g * t * t, 1e-6, 0);
    check_near(channel(&f, "puck2Vel"), 4 - g * t, 1e-6, 0);
    check_near(channel(&f, "puckAngPos"), 90 + 5 * t / degree, 1e-6, 0);
    bough_arena_destroy(f.arena);
}

// The balance from rest at 0 towards 40°, and the slider, which its stop keeps from going further.
static void sprung_joints_move_by_themselves(void **context) {
    (void)context;
    fixture f = start("tests/scenes/springs.yaml", no_sets);
    double delta = 0.4, omega = sqrt(16 - delta * delta), furthest = 0, t = 1.5;
    while (f.s->master->time < t - 1e-9) {
        run(&f, 1);
        furthest = fmax(furthest, channel(&f, "sliderPos"));
    }
    double turn = cos(omega * t) + delta / omega * sin(omega * t);
    check_near(channel(&f, "balancePos"), 40 * (1 - exp(-delta * t) * turn), 1e-6, 0);
    assert_true(furthest > 0.155 && furthest < 0.17); // 0.195 without the stop
    bough_arena_destroy(f.arena);
}

// 8 N m until 0.4 s, falling to nothing at 1 s, on 4 kg m²; every time of the table is a step's end.
static void joint_loads_follow_their_table(void **context) {
    (void)context;
    fixture f = start("tests/scenes/springs.yaml", no_sets);
    const double degree = acos(-1.0) / 180;
    assert_int_equal(f.s->master->n_event, 3);
    check_near(f.s->master->event[0], 0.205, 1e-14, 0);
    while (f.s->master->time < 0.4 - 1e-9) run(&f, 1);
    check_near(channel(&f, "wheelVel") * degree, 2 * 0.4, 1e-6, 0);
    while (f.s->master->time < 1.5) run(&f, 1);
    check_near(channel(&f, "wheelVel") * degree, 2 * 0.4 + 2 * 0.3, 1e-6, 0);
    bough_arena_destroy(f.arena);
}

// The planar joint's normal is y: its first axis is z, its second x.
static void elastic_pendulum_passes_the_reference(void **context) {
    (void)context;
    fixture f = start("apps/mechanisms/elastic-pendulum.yaml", no_sets);
    run(&f, 100);
    check_near(channel(&f, "bob2Pos"), -0.9801969361, 0, 1e-6);
    check_near(channel(&f, "bob1Pos"), -0.6150553214, 0, 1e-6);
    run(&f, 100);
    check_near(channel(&f, "bob2Pos"), -0.1744689353, 0, 1e-6);
    check_near(channel(&f, "bob1Pos"), -1.209469319, 0, 1e-6);
    double length = hypot(-0.1744689353, -1.209469319);
    check_near(channel(&f, "cordLen"), length, 0, 1e-6);
    check_near(channel(&f, "cordFrc"), 100 * (length - 1), 0, 1e-4);
    bough_arena_destroy(f.arena);
}

// A point of a body in the ground.
static bough_vec3 point_of(fixture *f, const char *body, bough_vec3 x) {
    bough_simulation_update(f->s);
    const bough_frame *frame = &f->s->tree->bodies[bough_tree_find_body(f->s->tree, body)];
    bough_transform pose = bough_tree_frame_pose(f->s->view, frame);
    return bough_add(pose.position, bough_mat3_mul(pose.rotation, x));
}

static void pendulum_passes_the_reference(void **context) {
    (void)context;
    static const char *const radau[] = {"simulation.master.solver=radau5", NULL};
    const char *const *const sets[] = {no_sets, radau};
    for (int k = 0; k < 2; k++) {
        fixture f = start("apps/mechanisms/pendulum.yaml", sets[k]);
        assert_string_equal(f.s->trunk.solver, k == 0 ? "IDA" : "Radau IIA");
        run(&f, 1000);
        bough_vec3 x = point_of(&f, "bob", bough_v3(-1, 0, 0));
        check_near(x.x, -0.2750874625761, 0, k == 0 ? 1e-6 : 1e-9);
        check_near(x.z, -0.9614192050991, 0, k == 0 ? 1e-6 : 1e-9);
        bough_arena_destroy(f.arena);
    }
}

// Bodies in a row keep the place of the first in the list and hang one on the other.
static void bodies_in_a_row_hang_on_each_other(void **context) {
    (void)context;
    static const char *const sets[] = {"bodies[0].repeat=3", "bodies[1].joint.parent=rod3",
                                       "bodies[1].repeat=1", "markers[0].body=link1", NULL};
    bough_arena *arena = bough_arena_create();
    bough_scene *s = scene_read(arena, "apps/mechanisms/chain.yaml", sets);
    static const char *const names[] = {"rod1", "link1", "rod2", "rod3"};
    static const int parents[] = {BOUGH_SCENE_GROUND, 3, 0, 2};
    assert_int_equal(s->n_body, 4);
    for (int i = 0; i < 4; i++) {
        assert_string_equal(s->body[i].name, names[i]);
        assert_int_equal(s->body[i].joint.parent, parents[i]);
    }
    bough_arena_destroy(arena);
}

static void chain_passes_the_reference(void **context) {
    (void)context;
    fixture f = start("apps/mechanisms/chain.yaml", no_sets);
    run(&f, 100);
    check_near(channel(&f, "tipX"), 0.5335694751, 0, 1e-6);
    check_near(channel(&f, "tipZ"), -4.9197095976, 0, 1e-6);
    run(&f, 100);
    check_near(channel(&f, "tipX"), -4.5960015766, 0, 1e-4);
    check_near(channel(&f, "tipZ"), -0.7560764306, 0, 1e-4);
    bough_vec3 x = point_of(&f, "link4", bough_v3(1, 0, 0));
    check_near(channel(&f, "tipX"), x.x, 0, 0);
    bough_arena_destroy(f.arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(joints_of_several_axes_start_and_are_recorded),
        cmocka_unit_test(sprung_joints_move_by_themselves),
        cmocka_unit_test(pendulum_passes_the_reference),
        cmocka_unit_test(chain_passes_the_reference),
        cmocka_unit_test(bodies_in_a_row_hang_on_each_other),
        cmocka_unit_test(elastic_pendulum_passes_the_reference),
        cmocka_unit_test(joint_loads_follow_their_table),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
