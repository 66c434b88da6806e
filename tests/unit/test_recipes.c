// The recipes of docs/extending.md for a joint and a channel, carried out: tests/CMakeLists.txt adds the
// joint `hinge`, which moves as a revolute joint does, and the channel {a}Height of free bodies in copies of
// the files that the recipes name. All other files are those of the program. (tests/unit/scheme_toy.c is the
// recipe for a scheme.)
#include "apps/bough/model/simulation.h"
#include "core/tree/joint.h"
#include "tests/unit/scene_text.h"

#define ARM(name, kind)                                                                                      \
    "  - {name: " name ", fidelity: rigid, mass: 2, centre_of_mass: [0, 0, -1], inertia: [0.1, 0.1, 0.1],\n" \
    "     joint: {kind: " kind ", axis: y, parent: ground, angle: 40 deg, speed: 1 rad/s}}\n"

TEST(a_joint_and_a_channel_are_rows) {
    double value[64];
    fixture f = accepts("simulation: {duration: 1, macro_step: 0.1}\nbodies:\n" ARM("a", "revolute")
                            ARM("b", "hinge") "  - {name: c, fidelity: rigid, mass: 1, inertia: [1, 1, 1], "
                                              "joint: {kind: free, parent: ground}}\n");
    assert_string_equal(bough_joint_name(BOUGH_JOINT_HINGE), "hinge");
    bough_simulation *s = NULL;
    check_ok(bough_simulation_build(f.arena, f.scene, &s));
    while (!bough_master_done(s->master)) check_ok(bough_step(s->master));
    bough_channels list = bough_channels_start(f.arena);
    check_ok(bough_simulation_channels(s, &list));
    assert_true(list.count <= 64);
    bough_simulation_update(s);
    bough_channels_sample(&list, s->master->time, value);
    int a = bough_channels_find(&list, "aPos"), b = bough_channels_find(&list, "bPos");
    assert_true(a >= 0 && b >= 0 && value[a] != 0);
    check_near(value[b], value[a], 1e-6, 0);
    int height = bough_channels_find(&list, "cHeight"), z = bough_channels_find(&list, "cPosZ");
    assert_true(height >= 0 && z >= 0);
    check_near(value[z], -9.80665 / 2, 1e-6, 0);
    check_near(value[height], value[z], 0, 0);
}

GROUP(enter, leave)
