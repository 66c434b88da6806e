// Loads that jump, between macro steps' times and at them: parabolas from the jump on.
#include "tests/unit/built_scene.h"

// A slide pushed by its joint, a free rigid body, a free rod under a load along it; each of 2 kg.
#define BODIES                                                                                               \
    "bodies:\n"                                                                                              \
    "  - {name: slide, fidelity: rigid, mass: 2, inertia: [1, 1, 1],\n"                                      \
    "     joint: {kind: prismatic, axis: x, parent: ground}}\n"                                              \
    "  - {name: body, fidelity: rigid, mass: 2, inertia: [1, 1, 1],\n"                                       \
    "     joint: {kind: free, parent: ground}}\n"                                                            \
    "  - name: rod\n    fidelity: rod\n    joint: {kind: free, parent: ground}\n"                            \
    "    rod: {length: 1 m, segments: 4, stiffness: [1e4, 1e4, 1e4, 10, 10, 10],\n"                          \
    "      damping: [0.01, 0.01, 0.01, 0.01, 0.01, 0.01], mass: [2, 0, 0, 0.01, 0.01, 0]}\n"
#define LOADS(ramp)                                                                                          \
    "loads:\n  - {joint: slide, force: 6, ramp: " ramp "}\n"                                                 \
    "  - {body: body, force: [6, 0, 0], ramp: " ramp "}\n"                                                   \
    "  - {body: rod, along: [0, 1 m], force: [6, 0, 0], frame: body, ramp: " ramp "}\n"                      \
    "markers:\n  - {name: at, body: body}\n"

static double after(double t, double jump) { return t > jump ? 1.5 * (t - jump) * (t - jump) : 0; }

// The rod takes part in the coupling, whose error counts.
static void check_parabolas(const char *text, double jump, double tolerance, double coupled) {
    check_arena(arena);
    bough_simulation *s = scene_build_text(arena, text);
    bough_channels list = scene_channels(arena, s);
    assert_true(s->jumps);
    while (!bough_master_done(s->master)) {
        scene_step(s);
        double x = after(s->master->time, jump);
        check_near(scene_channel(s, &list, "slidePos"), x, 0, tolerance);
        check_near(scene_channel(s, &list, "atX"), x, 0, tolerance);
        check_near(scene_channel(s, &list, "rodTipX"), x, 0, coupled);
    }
    assert_true(after(s->master->time, jump) > 0.1);
}

#define SIMULATE(more) "gravity: [0, 0, 0]\nsimulation: {duration: 1 s, macro_step: 20 ms" more "}\n"

TEST(a_load_that_jumps_acts_from_its_time_on) {
    check_parabolas(SIMULATE("") BODIES LOADS("[0.507 s, 0.507 s]"), 0.507, 1e-5, 4e-3);
    check_parabolas(SIMULATE("") BODIES LOADS("[0.5 s, 0.5 s]"), 0.5, 1e-5, 4e-3);
    check_parabolas(SIMULATE(", coupling: {scheme: monolithic}, master: {solver: rosenbrock, rtol: 1e-6}")
                        BODIES LOADS("[0.507 s, 0.507 s]"),
                    0.507, 1e-7, 1e-7);
    check_parabolas(SIMULATE(", coupling: {scheme: monolithic}, master: {rtol: 1e-8}")
                        BODIES LOADS("[0.5 s, 0.5 s]"),
                    0.5, 1e-6, 1e-6);
}

// Without a jump there is nothing to do, and a load from time 0 on is none.
TEST(loads_without_a_jump_take_no_part) {
    check_arena(arena);
    assert_false(scene_build_text(arena, SIMULATE("") BODIES LOADS("[0 s, 0 s]"))->jumps);
    assert_false(scene_build_text(arena, SIMULATE("") BODIES LOADS("[0.2 s, 0.5 s]"))->jumps);
}
