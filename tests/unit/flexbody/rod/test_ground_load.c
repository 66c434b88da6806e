// Loads in ground axes on bodies that move: their resolution against statics on a turning arm, the motion
// they make against that under gravity, and the contract of the system.
#include "apps/bough/model/equilibrium.h"
#include "apps/bough/model/simulation.h"
#include "tests/unit/built_scene.h"
#include "tests/unit/contract.h"

static const char scene[] = "tests/data/scenes/dead-load.yaml";

static const char apart[] = "bodies[1].joint.parent=ground"; // the arm carries nothing

static void run_to_end(bough_simulation *s) {
    while (!bough_master_done(s->master)) scene_step(s);
    bough_simulation_update(s);
}

// -- a light, stiff arm turned at a given speed ---------------------------------------------------

// In every scheme the root's wrench is R^T (F, x × F + M).
TEST(load_keeps_its_direction_while_the_arm_turns) {
    const char *const schemes[] = {"monolithic", "ramp", "iterated", "gauss-seidel"};
    const bough_vec3 force = {3, -2, -5}, moment = {0.5, 2, -1};
    for (size_t k = 0; k < sizeof schemes / sizeof *schemes; k++) {
        char scheme[64];
        snprintf(scheme, sizeof scheme, "simulation.coupling={scheme: %s}", schemes[k]);
        const char *const sets[] = {
            scheme,
            "simulation.duration=1 s",
            "bodies[0].joint={kind: revolute, axis: y, parent: ground, placement: [rotate z 25 deg, "
            "rotate x 20 deg], motion: {angle: {from: 70 deg, to: 130 deg, ramp: [0, 0.9 s]}}}",
            apart,
            "bodies[0].rod.mass=[1e-3, 0, 0, 1e-7, 1e-7, 0]",
            "bodies[0].rod.stiffness=[1e9, 1e9, 1e9, 1e7, 1e7, 1e7]",
            "loads[0]={body: arm, at: tip, force: [3, -2, -5], moment: [0.5, 2, -1]}",
            NULL};
        check_build(arena, s, scene, sets);
        run_to_end(s);
        const bough_beam *arm = &s->beam[0];
        bough_mat3 r = bough_tree_frame_pose(s->view, &s->tree->markers[arm->marker]).rotation;
        bough_vec3 f = bough_mat3_tmul(r, force), m = bough_mat3_tmul(r, moment);
        m = bough_add(m, bough_cross(bough_v3(0, 0, 2), f));
        const double expected[6] = {f.x, f.y, f.z, m.x, m.y, m.z};
        double root[BOUGH_ROD_MOST_OUTPUTS];
        bough_simulation_root(s, arm, 1, root);
        for (int c = 0; c < 6; c++) check_near(root[c], expected[c], 0, 0.02);
    }
}

// -- gravity --------------------------------------------------------------------------------------

static bough_vec3 tip_after(const char *const *sets) {
    check_build(arena, s, scene, sets);
    run_to_end(s);
    bough_quaternion rotation;
    bough_vec3 tip = bough_simulation_beam_tip(s, &s->beam[0], &rotation);
    bough_transform pose = bough_tree_frame_pose(s->view, &s->tree->markers[s->beam[0].marker]);
    tip = bough_add(pose.position, bough_mat3_mul(pose.rotation, tip));
    return tip;
}

static void pendulum_swings_as_under_gravity(const char *scheme, const char *body) {
    const char *const heavy[] = {scheme, body, apart, "gravity=[1, -2, -9.8]", "loads[0].force=[0, 0, 0]",
                                 NULL};
    const char *const loaded[] = {scheme, body, apart, NULL};
    bough_vec3 expected = tip_after(heavy), tip = tip_after(loaded);
    check_near(bough_norm(bough_sub(tip, expected)), 0, 0, 1e-3);
}

TEST(load_of_a_weight_moves_a_pendulum_as_the_weight) {
    const char *const rod = "title=rod";
    pendulum_swings_as_under_gravity("simulation.coupling={scheme: monolithic}", rod);
    pendulum_swings_as_under_gravity("simulation.coupling={scheme: ramp}", rod);
    pendulum_swings_as_under_gravity("simulation.coupling={scheme: iterated}", rod);
    pendulum_swings_as_under_gravity("simulation.coupling={scheme: monolithic}", "bodies[0].fidelity=modal");
}

// A load at the end of a rod that carries a body is a load on that body.
TEST(load_at_a_carrying_end_is_one_on_what_it_carries) {
    const char *const on_rod[] = {"loads[0]={body: arm, at: tip, force: [1, 2, -3], moment: [0.5, 2, -1]}",
                                  NULL};
    const char *const on_body[] = {"loads[0]={body: bob, force: [1, 2, -3], moment: [0.5, 2, -1]}", NULL};
    bough_vec3 tip = tip_after(on_rod), expected = tip_after(on_body);
    check_near(bough_norm(bough_sub(tip, expected)), 0, 0, 1e-6);
}

// -- a load between vertices of a body that has turned ----------------------------------------------

// Of a soft rod that is bent by 70 degrees, on a weld and on a hinge that a motion holds where the weld is.
TEST(load_between_vertices_bends_a_rod_on_a_joint_as_one_on_the_ground) {
    static const char *const joint[] = {"{kind: fixed, parent: ground, placement: [rotate y 40 deg]}",
                                        "{kind: revolute, axis: y, parent: ground, motion: {angle: 40 deg}}"};
    bough_vec3 tip[2];
    for (int k = 0; k < 2; k++) {
        check_arena(arena);
        const char *set = bough_arena_print(
            arena,
            "bodies=[{name: bar, fidelity: rod, joint: %s, rod: {length: 1, segments: 4, stiffness: [1e4, 1e4, "
            "1e5, 1, 1, 1], mass: [1, 0, 0, 1e-4, 1e-4, 0]}}]",
            joint[k]);
        const char *sets[] = {
            set, "gravity=[0, 0, 0]",
            "loads=[{body: bar, at: 0.6 m, force: [4, 1, -1]}, {body: bar, along: [0 m, 1 m], "
            "force: [1, 0, -2]}]",
            NULL};
        bough_simulation *s = scene_build(arena, scene, sets);
        bough_vec3 turn;
        check_ok(bough_simulation_equilibrium(s, 0, 0, NULL));
        bough_simulation_shift(s, &s->beam[0], s->beam[0].def.n_segment, &tip[k], &turn);
    }
    assert_true(bough_norm(tip[0]) > 0.5);
    check_near(bough_norm(bough_sub(tip[1], tip[0])), 0, 0, 1e-7);
}

// -- the contract ---------------------------------------------------------------------------------

static void check_contract(const char *const *sets) {
    check_build(arena, s, scene, sets);
    for (int k = 0; k < 20; k++) scene_step(s);
    const bough_system *rod = &s->rod[0].system;
    contract_point at = {s->master->time, s->rod[0].state, bough_simulation_rod_input(s, &s->beam[0]), 5e-5};
    contract_check_system(rod, at, 1e-3);
    contract_point tree = {s->master->time, s->leader.state, s->master->coupling->input, 1e-5};
    contract_check_system(&s->leader.system, tree, 1e-3);
}

TEST(systems_fulfil_the_contract) {
    const char *const rod[] = {apart, NULL}, *const carrying[] = {NULL};
    const char *const modal[] = {apart, "bodies[0].fidelity=modal", NULL};
    check_contract(rod);
    check_contract(carrying);
    check_contract(modal);
}
