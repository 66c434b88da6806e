// Bad times and loads, each reported at its place.
#include "tests/unit/scene_text.h"

TEST(times_fit_the_macro_step) {
    refuses("simulation: {duration: 1.005, macro_step: 10 ms, output: {interval: 25 ms}}\n"
            "bodies:\n" BODY("a", "ground"),
            "s.yaml:1:24: error: simulation.duration: 1.005 s is not a multiple of the macro step, 0.01 s\n"
            "s.yaml:1:69: error: simulation.output.interval: 0.025 s is not a multiple of the macro "
            "step, 0.01 s\n");
    refuses("simulation: {duration: 1, macro_step: 0.1, output: {interval: 10 ms}}\nbodies:\n" BODY("a",
                                                                                                    "ground"),
            "s.yaml:1:63: error: simulation.output.interval: 0.01 s is not a multiple of the macro "
            "step, 0.1 s\n");
    accepts("simulation: {duration: 0.3, macro_step: 0.1}\nbodies:\n" BODY("a", "ground"));
}

TEST(loads_fit_their_joints) {
    refuses(
        SIMULATION "bodies:\n" BODY("a", "ground") "  - {name: h, mass: 1, fidelity: rigid, joint: {kind: "
                                                   "revolute, parent: a, axis: x}}\n"
                                                   "loads:\n"
                                                   "  - {joint: a, torque: 1}\n"
                                                   "  - {joint: h, force: 1 N}\n"
                                                   "  - {joint: h, force: 1 N m}\n"
                                                   "  - {joint: h}\n"
                                                   "  - {joint: h, torque: 1, force: 2}\n"
                                                   "  - {joint: h, torque: 1, ramp: [2, 1]}\n",
        "s.yaml:6:13: error: loads[0].joint: the joint of 'a' must be revolute or prismatic to take a load\n"
        "s.yaml:7:23: error: loads[1].force: the joint of 'h' is revolute: give a torque\n"
        "s.yaml:8:23: error: loads[2].force: expected a force (in N, or with a unit, as '12 "
        "kN'), got '1 N m': the unit 'N m' does not fit\n"
        "s.yaml:8:23: error: loads[2].force: the joint of 'h' is revolute: give a torque\n"
        "s.yaml:9:5: error: loads[3]: expected either 'torque' or 'force'\n"
        "s.yaml:10:5: error: loads[4]: expected either 'torque' or 'force', got both\n"
        "s.yaml:10:34: error: loads[4].force: the joint of 'h' is revolute: give a torque\n"
        "s.yaml:11:33: error: loads[5].ramp: must end after it starts, got [2 s, 1 s]\n");
}

#define MODAL(fidelity)                                                                                      \
    SIMULATION "bodies:\n  - name: a\n    fidelity: " fidelity "\n" JOINT "    " SMALL_ROD "\n"

TEST(modal_bodies_are_rods_reduced) {
    accepts(MODAL("modal"));
    accepts(MODAL("segmented-modal") "    modal: {modes: 3, statics: false, pieces: 4}\n");
    refuses(MODAL("modal") "    modal: {pieces: 4}\n",
            "s.yaml:7:21: error: bodies[0].modal.pieces: only used with 'fidelity: segmented-modal'\n");
    refuses(MODAL("segmented-modal"),
            "s.yaml:3:5: error: bodies[0].modal.pieces: 5 pieces of 4 segments: give the rod more "
            "segments\n");
    refuses(MODAL("rod") "    modal: {modes: 3}\n",
            "s.yaml:7:5: error: bodies[0].modal: only used with 'fidelity: modal/segmented-modal'\n");
    refuses(MODAL("modal") "  - {name: b, fidelity: rigid, joint: {kind: fixed, parent: a}}\n",
            "s.yaml:7:61: error: bodies[1].joint.parent: 'a' is a modal body, which cannot carry bodies; "
            "make it a rod\n");
    refuses(SIMULATION "bodies:\n  - name: a\n    fidelity: rod\n" JOINT
                       "    rod: {length: 1, segments: 1, stiffness: [1, 1, 1, 1, 1, 1], "
                       "mass: [1, 0, 0, 1, 1, 0]}\n"
                       "  - {name: b, fidelity: rigid, joint: {kind: fixed, parent: a}}\n",
            "s.yaml:6:32: error: bodies[0].rod.segments: a rod that carries bodies, as 'b', has at least 2 "
            "segments, got 1\n");
    refuses(MODAL("modal") "loads:\n  - {body: a, at: tip, force: [1, 0, 0], frame: follower}\n",
            "s.yaml:8:49: error: loads[0].frame: 'a' is a modal body, on which loads do not turn "
            "with its sections: make it a rod or give 'frame: body'\n");
}

TEST(loads_act_on_rods) {
    fixture f = accepts(TWO_RODS "  - {body: b, at: tip, force: [1 kN, 0, 2]}\n"
                                 "  - {body: c, at: 3, moment: [0, 0, 2 kN m], frame: follower}\n"
                                 "  - {body: b, at: 150 cm, force: [1, 0, 2], ramp: [0, 1]}\n"
                                 "  - {body: c, along: [0, 2], force: [0, 3 kN/m, 0], frame: body,\n"
                                 "     moment: [1, 2, 3 N m/m]}\n");
    const bough_scene_load *load = f.scene->load;
    assert_int_equal(load[0].place, BOUGH_SCENE_AT_TIP);
    assert_int_equal(load[0].body, 1);
    check_near(load[0].wrench[0], 1000, 1e-15, 0);
    assert_int_equal(load[1].place, BOUGH_SCENE_AT_VERTEX);
    assert_int_equal(load[1].vertex, 3);
    assert_int_equal(load[1].frame, BOUGH_SCENE_LOAD_FOLLOWER);
    check_near(load[1].wrench[5], 2000, 1e-15, 0);
    assert_int_equal(load[2].place, BOUGH_SCENE_AT_SPAN);
    check_near(load[2].span[0], 1.5, 1e-15, 0);
    check_near(load[2].ramp[1], 1, 0, 0);
    assert_int_equal(load[3].place, BOUGH_SCENE_ALONG);
    check_near(load[3].wrench[1], 3000, 1e-15, 0);
    check_near(load[3].wrench[5], 3, 1e-15, 0);
}

TEST(loads_fit_their_rods) {
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
                     "  - {body: b, at: tip, force: [1, 2, 3], point: [1, 2, 3]}\n"
                     "  - {body: b, at: tip, force: [1, 2, 3], end_force: [1, 2, 3]}\n"
                     "  - {body: b, at: tip, force: [1, 2, 3], factor: {times: [0, 1], values: "
                     "[1, 2]}, ramp: [0, 1]}\n",
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
            "s.yaml:22:40: error: loads[15].frame: 'a' is rigid: 'frame: body' rotates with it\n"
            "s.yaml:23:49: error: loads[16].point: only used with a rigid body\n"
            "s.yaml:24:53: error: loads[17].end_force: only used with 'along'\n"
            "s.yaml:25:89: error: loads[18].ramp: only used without 'factor'\n");
    accepts(TWO_RODS "  - {body: b, along: [0, 1], end_force: [1, 2, 3], factor: {times: [0, 1], "
                     "values: [0, 2]}}\n");
    accepts(TWO_RODS "  - {body: a, moment: [1, 2, 3], factor: {times: [0, 1], values: [0, 2]}}\n");
}

GROUP(enter, leave)
