// Channels of bodies that move freely: place, directions of axes, velocities.
#include "tests/unit/built_scene.h"
#include "tests/unit/scene_text.h"

// Half a turn a second about its own z, which stays; thrown along x.
TEST(free_body_tells_where_it_is_and_how_it_turns) {
    write_file("s.yaml", "gravity: [0, 0, 0]\n"
                         "simulation: {duration: 0.5 s, macro_step: 10 ms, master: {rtol: 1e-8}}\n"
                         "bodies:\n"
                         "  - name: top\n    fidelity: rigid\n    mass: 2\n    inertia: [1, 1, 1.5]\n"
                         "    joint: {kind: free, parent: ground, velocity: [3 m/s, 0, 0],\n"
                         "      angular_velocity: [0, 0, 180 deg/s], placement: [move z 1 m]}\n");
    check_arena(arena);
    bough_errors errors = {.arena = arena};
    bough_scene *scene = NULL;
    bough_simulation *s = NULL;
    bough_status status = bough_scene_read(arena, "s.yaml", NULL, 0, &errors, &scene);
    bough_errors_print(&errors, stderr);
    assert_int_equal(status.code, BOUGH_OK);
    check_ok(bough_simulation_build(arena, scene, &s));
    bough_channels list = {.arena = arena};
    check_ok(bough_simulation_channels(s, &list));
    while (!bough_master_done(s->master)) scene_step(s);
    static const struct {
        const char *name;
        double value;
    } expected[] = {{"topPosX", 1.5}, {"topPosZ", 1},  {"topVelX", 3},  {"topVelY", 0},     {"topDirXx", 0},
                    {"topDirXy", 1},  {"topDirXz", 0}, {"topDirZz", 1}, {"topOmegaZ", 180}, {"topOmegaX", 0}};
    for (size_t k = 0; k < sizeof expected / sizeof *expected; k++) {
        check_near(scene_channel(s, &list, expected[k].name), expected[k].value, 1e-5, 1e-5);
    }
}

GROUP(enter, leave)
