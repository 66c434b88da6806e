// Channels of bodies that move freely: place, directions of axes, velocities.
#include "tests/unit/built_scene.h"

static const char text[] = "gravity: [0, 0, 0]\n"
                           "simulation: {duration: 0.5 s, macro_step: 10 ms, master: {rtol: 1e-8}}\n"
                           "bodies:\n"
                           "  - name: top\n    fidelity: rigid\n    mass: 2\n    inertia: [1, 1, 1.5]\n"
                           "    joint: {kind: free, parent: ground, velocity: [3 m/s, 0, 0],\n"
                           "      angular_velocity: [0, 0, 180 deg/s], placement: [move z 1 m]}\n";

// Half a turn a second about its own z, which stays; thrown along x.
TEST(free_body_tells_where_it_is_and_how_it_turns) {
    static const struct {
        const char *name;
        double value;
    } expected[] = {{"topPosX", 1.5}, {"topPosZ", 1},  {"topVelX", 3},  {"topVelY", 0},     {"topDirXx", 0},
                    {"topDirXy", 1},  {"topDirXz", 0}, {"topDirZz", 1}, {"topOmegaZ", 180}, {"topOmegaX", 0}};
    check_arena(arena);
    built b = built_from(arena, scene_build_text(arena, text));
    run_until(&b, 0.5);
    for (size_t k = 0; k < sizeof expected / sizeof *expected; k++)
        check_near(channel(&b, expected[k].name), expected[k].value, 1e-5, 1e-5);
}

// Tumbling at 20 rad/s about its middle axis, with the tolerance that follows from the default accuracy.
TEST(a_tumbling_body_keeps_its_velocity) {
    check_arena(arena);
    built b = built_from(arena, scene_build_text(arena, "gravity: [0, 0, 0]\nsimulation: {duration: 10 s}\n"
                                                        "bodies:\n  - {name: b, fidelity: rigid, mass: 2, "
                                                        "inertia: [1, 2, 2.5], joint: {kind: free, parent: "
                                                        "ground, velocity: [1, 2, 3], angular_velocity: "
                                                        "[0, 20 rad/s, 0.1 rad/s]}}\n"));
    run_until(&b, 10);
    check_near(channel(&b, "bVelX"), 1, 1e-3, 0);
    check_near(channel(&b, "bVelY"), 2, 1e-3, 0);
    check_near(channel(&b, "bVelZ"), 3, 1e-3, 0);
}
