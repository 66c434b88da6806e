// Bad bodies, joints and rods, each reported at its place.
#include "tests/unit/scene_text.h"

TEST(all_errors_are_shown_in_order) {
    refuses("titel: x\n"
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
            "s.yaml:3:13: error: simulation.duration: expected a time (in s, or with a unit, as '20 "
            "ms'), got '1 kg': the unit 'kg' does not fit\n"
            "s.yaml:4:22: error: simulation.coupling.scheme: expected one of frozen, gauss-seidel, "
            "extrapolated, iterated, ramp, monolithic, got 'rampe' (did you mean 'ramp'?)\n"
            "s.yaml:8:12: error: bodies[0].joint: required key 'axis' is missing\n"
            "s.yaml:8:37: error: bodies[0].joint.parent: there is no body 'grond' (did you mean 'ground'?)\n"
            "s.yaml:9:11: error: bodies[0].mass: must be in [0, 1e12] kg, got '-1'\n"
            "s.yaml:11:13: error: loads[0].joint: there is no body 'b' (did you mean 'a'?)\n");
}

TEST(missing_parts_are_named) {
    refuses("title: x\n", "s.yaml:1:1: error: required key 'simulation' is missing\n"
                          "s.yaml:1:1: error: required key 'bodies' is missing\n");
    refuses(SIMULATION "bodies: []\n", "s.yaml:2:9: error: bodies: expected at least 1 item, got 0\n");
    refuses(SIMULATION "bodies:\n  - {}\n",
            "s.yaml:3:5: error: bodies[0]: required key 'name' is missing\n"
            "s.yaml:3:5: error: bodies[0]: required key 'fidelity' is missing\n"
            "s.yaml:3:5: error: bodies[0]: required key 'joint' is missing\n");
}

TEST(joint_keys_fit_the_kind) {
    refuses(SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n    mass: 1\n"
                       "    joint: {kind: fixed, parent: ground, axis: x, angle: 0, speed: 1}\n",
            "s.yaml:6:42: error: bodies[0].joint.axis: only used with 'kind: "
            "revolute/prismatic/cylindrical/universal/planar'\n"
            "s.yaml:6:51: error: bodies[0].joint.angle: only used with 'kind: revolute/cylindrical/planar'\n"
            "s.yaml:6:61: error: bodies[0].joint.speed: only used with 'kind: "
            "revolute/prismatic/cylindrical'\n");
    refuses(SIMULATION "bodies:\n  - name: a\n    fidelity: rigid\n    mass: 1\n"
                       "    joint: {kind: prismatic, parent: ground, axis: w, position: 1 deg}\n",
            "s.yaml:6:52: error: bodies[0].joint.axis: expected one of x, y, z, got 'w' (did you mean 'x'?)\n"
            "s.yaml:6:65: error: bodies[0].joint.position: expected a length (in m, or with a unit, "
            "as '61.5 m'), got '1 deg': the unit 'deg' does not fit\n");
}

TEST(bad_placements_are_refused) {
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

TEST(names_are_checked) {
    refuses(SIMULATION "bodies:\n" BODY("a", "ground") BODY("a", "ground") BODY("ground", "a")
                BODY("a b/c", "a"),
            "s.yaml:4:12: error: bodies[1].name: body 'a' is given twice\n"
            "s.yaml:5:12: error: bodies[2].name: 'ground' cannot be the name of a body\n"
            "s.yaml:6:12: error: bodies[3].name: a name has letters, digits, '_' and '-', got 'a b/c'\n");
    refuses(SIMULATION "bodies:\n" BODY("tower", "ground") BODY("hub", "twoer"),
            "s.yaml:4:63: error: bodies[1].joint.parent: there is no body 'twoer' (did you mean 'tower'?)\n");
}

TEST(loops_of_parents_are_refused) {
    refuses(SIMULATION "bodies:\n" BODY("a", "a"),
            "s.yaml:3:61: error: bodies[0].joint.parent: parents form a loop: a -> a\n");
    refuses(SIMULATION "bodies:\n" BODY("z", "c") BODY("b", "c") BODY("c", "d") BODY("d", "b")
                BODY("e", "ground"),
            "s.yaml:4:61: error: bodies[1].joint.parent: parents form a loop: b -> c -> d -> b\n");
}

TEST(moving_joints_need_mass) {
    refuses(SIMULATION "bodies:\n  - {name: a, fidelity: rigid, joint: {kind: revolute, parent: "
                       "ground, axis: x}}\n" BODY("b", "a"),
            "s.yaml:3:5: error: bodies[0]: a joint that moves must carry mass: give 'mass' here or "
            "to a body that hangs on this one\n");
    accepts(SIMULATION "bodies:\n  - {name: a, fidelity: rigid, joint: {kind: revolute, parent: "
                       "ground, axis: x}}\n"
                       "  - {name: b, fidelity: rigid, mass: 1, joint: {kind: fixed, parent: a}}\n");
}

TEST(body_keys_fit_the_fidelity) {
    refuses(ROD_BODY, "s.yaml:3:5: error: bodies[0]: required key 'rod' is missing (with 'fidelity: rod')\n");
    refuses(ONE_BODY "    pitch: 1 deg\n", "s.yaml:6:12: error: bodies[0].pitch: only used with a rod\n");
    refuses(ROD_BODY "    mass: 1\n"
                     "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}\n",
            "s.yaml:6:5: error: bodies[0].mass: only used with 'fidelity: rigid/fmu'\n");
    refuses(ONE_BODY "    mass: 1\n    inertia: [1, 1, 1]\n"
                     "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}\n",
            "s.yaml:8:10: error: bodies[0].rod: a rigid body gets its mass from a rod or from 'mass', "
            "'centre_of_mass' and 'inertia', not from both\n");
    refuses(ONE_BODY
            "    mass: 1\n    centre_of_mass: [1, 0, 0]\n    inertia: [1, 1, 1]\n    rod: {segments: 4}\n",
            "s.yaml:9:10: error: bodies[0].rod: a rigid body gets its mass from a rod or from 'mass', "
            "'centre_of_mass' and 'inertia', not from both\n");
    refuses(ROD_BODY "    rod: {part: [0, 1], length: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, "
                     "0, 0, 1, 1, 0]}\n",
            "s.yaml:6:17: error: bodies[0].rod.part: only used with a table\n");
    refuses(ONE_BODY "    inertia: [1, 1, 1, 2, 0, 0]\n",
            "s.yaml:6:14: error: bodies[0].inertia: the inertia matrix must not be negative about "
            "any axis, but Ixx Iyy - Ixy^2 is\n");
    refuses(ONE_BODY "    inertia: [1, 1, -1]\n",
            "s.yaml:6:14: error: bodies[0].inertia: the inertia matrix must not be negative about "
            "any axis, but Izz is\n");
    // Each plane is positive, the space is not.
    refuses(ONE_BODY "    inertia: [1, 1, 1, 0.9, 0.9, -0.9]\n",
            "s.yaml:6:14: error: bodies[0].inertia: the inertia matrix must not be negative about "
            "any axis, but the determinant is\n");
    refuses(ONE_BODY "    inertia: [1, 2]\n",
            "s.yaml:6:14: error: bodies[0].inertia: expected a list [Ixx, Iyy, Izz] or with Ixy, "
            "Ixz, Iyz, got 2 items\n");
}

TEST(rods_are_complete) {
    refuses(
        ROD_BODY "    rod: {segments: 4}\n",
        "s.yaml:6:10: error: bodies[0].rod: required keys 'length', 'stiffness', 'mass' are missing (without a table)\n");
    refuses(ROD_BODY "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 1]}\n",
            "s.yaml:6:10: error: bodies[0].rod: required key 'mass' is missing (without a table)\n");
    refuses(ROD_BODY "    rod: {table: none.yaml, segments: 0}\n",
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

TEST(lengths_have_limits) {
    refuses(ROD_BODY "    rod: {length: 1e300, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}\n",
            "s.yaml:6:19: error: bodies[0].rod.length: must be in [1e-9, 1e9] m, got '1e300'\n");
}

TEST(section_matrices_are_checked) {
    refuses(
        ROD_BODY "    rod:\n      length: 1\n"
                 "      stiffness: [1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 2, 0, 1, 0, "
                 "1]\n      mass: [1, 0, 0, 1, 1, 0]\n",
        "s.yaml:8:73: error: bodies[0].rod.stiffness[18]: the stiffness matrix must be positive definite: "
        "in the row of bend about y the entries off the diagonal are too large\n");
    refuses(ROD_BODY "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 0], mass: [0, 0, 0, 1, 1, 0]}\n",
            "s.yaml:6:49: error: bodies[0].rod.stiffness[5]: the stiffness matrix must be positive definite: "
            "the diagonal has 0 for twist\n"
            "s.yaml:6:60: error: bodies[0].rod.mass: the mass per length must be > 0 kg/m\n");
    // Negative in the last pivot only.
    refuses(
        ROD_BODY "    rod:\n      length: 1\n"
                 "      stiffness: [1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 1, 2, "
                 "1]\n      mass: [1, 0, 0, 1, 1, 0]\n",
        "s.yaml:8:79: error: bodies[0].rod.stiffness[20]: the stiffness matrix must be positive definite: "
        "in the row of twist the entries off the diagonal are too large\n");
    // About the mass centre nothing is left of Iyy = m cx².
    refuses(ROD_BODY "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [4, 0.5, 0, 1, 1, 0]}\n",
            "s.yaml:6:59: error: bodies[0].rod.mass: the inertia about the mass centre must be "
            "positive definite: the diagonal has 0 for Iyy - m cx^2\n");
    accepts(ROD_BODY "    rod: {length: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [4, 0.5, 0, 1, 1.01, 0]}\n");
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

TEST(stations_run_from_zero_to_the_length) {
    refuses_spans("", (const char *[3]){"0", "1", "2"}, "");
    refuses_spans("length: 200 cm\n", (const char *[3]){"0", "1", "2"}, "");
    refuses_spans("length: 5\n", (const char *[3]){"0"}, "");
    refuses_spans("", (const char *[3]){"0", "2", "2"},
                  "blade.yaml:6:6: error: stations.rows[2].span: must be more than '2' before it, got '2'\n");
    refuses_spans("", (const char *[3]){"0.5", "0.1", "2"},
                  "blade.yaml:4:6: error: stations.rows[0].span: the first must be 0 m, got 0.5 m\n"
                  "blade.yaml:5:6: error: stations.rows[1].span: must be more than '0.5' before it, "
                  "got '0.1'\n");
    refuses_spans("length: 3\n", (const char *[3]){"0", "1", "2"},
                  "blade.yaml:1:9: error: length: is 3 m, but the last station stands at 2 m\n");
    refuses_spans("", (const char *[3]){"0"},
                  "blade.yaml:1:1: error: required key 'length' is missing (with one station)\n");
}

// Two bodies name the same bad table: its errors are shown once.
TEST(errors_of_a_table_are_shown_once) {
    write_file("blade.yaml", "lenght: 3\n");
    refuses(ROD_BODY "    rod: {table: blade.yaml}\n"
                     "  - name: b\n    fidelity: rod\n" JOINT "    rod: {table: blade.yaml}\n",
            "blade.yaml:1:1: error: required key 'stations' is missing\n"
            "blade.yaml:1:1: error: unknown key 'lenght' (did you mean 'length'?)\n");
}

GROUP(enter, leave)
