// The port of the tree at which a flexible body that carries bodies ends.
#include "tests/unit/contract.h"
#include "tests/unit/rigid_tree.h"
#include "tests/unit/tree_measure.h"

enum { BASE, WELDED, END, TOP, BODIES };
enum { INPUTS = 12, OUTPUTS = 22 };

static bough_body_def body(const char *name, int parent, bough_joint_kind kind, double mass) {
    bough_body_def b = bough_body_def_default();
    b.name = name;
    b.parent = parent;
    b.kind = kind;
    b.joint.position = bough_v3(0.3, -0.2, 0.5);
    b.joint.rotation = turned(.4, -.7, .2);
    b.mass = mass;
    b.mass_centre = bough_v3(0.1, 0.2, -0.1);
    b.inertia = (bough_mat3){{mass, 0, 0}, {0, 1.2 * mass, 0.1 * mass}, {0, 0.1 * mass, mass}};
    return b;
}

typedef struct ended {
    fixture f;
    double state[MOST], input[INPUTS];
} ended;

// A flexible body hangs on a body that is welded to a hinged one, and ends where a hinge follows.
static ended make(void) {
    bough_body_def bodies[BODIES] = {[BASE] = body("base", BOUGH_GROUND, BOUGH_JOINT_REVOLUTE, 2),
                                     [WELDED] = body("welded", BASE, BOUGH_JOINT_FIXED, 0),
                                     [END] = body("end", WELDED, BOUGH_JOINT_FREE, 0),
                                     [TOP] = body("top", END, BOUGH_JOINT_REVOLUTE, 3)};
    bodies[END].coordinates[3] = 1;
    const bough_marker_def marker = {"root", WELDED, bough_transform_identity()};
    const bough_inertia vertex = {0.7, {0.1, 0, -0.2}, diagonal(0.3, 0.4, 0.5)};
    const bough_port_def port = {.root = vertex};
    const bough_end_def end = {END, vertex};
    const bough_tree_def def = {.gravity = {1, -2, -9},
                                .n_bodies = BODIES,
                                .bodies = bodies,
                                .n_markers = 1,
                                .markers = &marker,
                                .n_ports = 1,
                                .ports = &port,
                                .n_ends = 1,
                                .ends = &end};
    ended e = {.f = build(&def, 1e-8)};
    for (int i = 0; i < e.f.s.n_state; i++) e.state[i] = sin(2.3 * i + 0.4);
    int p = e.f.tree->links[e.f.tree->ends[0].link].first_coordinate + 3;
    bough_quaternion q = bough_quaternion_exponential(bough_v3(0.5, 0.3, -1));
    e.state[p] = q.w, e.state[p + 1] = q.x, e.state[p + 2] = q.y, e.state[p + 3] = q.z;
    for (int j = 0; j < INPUTS; j++) e.input[j] = cos(1.9 * j);
    return e;
}

TEST(tree_with_an_end_fulfils_the_contract) {
    ended e = make();
    fixture f = e.f;
    assert_int_equal(f.s.n_input, INPUTS);
    assert_int_equal(f.s.n_output, OUTPUTS);
    contract_point at = {0.2, e.state, e.input, 1e-5};
    contract_check(f.m, at, 0.07, 0.05);
    contract_set_state(f.m, at, 1e-4);
}

// Position and rotation in the frame of the flexible body, velocity of the same point in its axes.
TEST(outputs_are_the_motion_in_the_frame_of_the_flexible_body) {
    ended e = make();
    fixture f = e.f;
    double out[OUTPUTS];
    f.s.ops->output(f.s.self, 0, e.state, e.input, out);
    const double *end = out + BOUGH_PORT_OUTPUTS;
    bough_tree_kinematics(f.tree, e.state, f.data);
    bough_body_def joint = body("", 0, BOUGH_JOINT_FREE, 0); // its placement
    bough_transform frame =
        bough_transform_compose(bough_tree_frame_pose(f.data, &f.tree->bodies[WELDED]), joint.joint);
    bough_transform pose = bough_tree_frame_pose(f.data, &f.tree->bodies[END]);
    bough_twist twist = bough_tree_frame_velocity(f.data, &f.tree->bodies[END]);
    bough_transform local = bough_transform_compose(bough_transform_inverse(frame), pose);
    bough_quaternion p = {end[9], end[10], end[11], end[12]};
    bough_mat3 r = bough_rotation_matrix(p);
    bough_vec3 u = bough_mat3_tmul(frame.rotation, twist.linear);
    bough_vec3 w = bough_mat3_tmul(pose.rotation, twist.angular);
    const double expected[9] = {
        u.x, u.y, u.z, w.x, w.y, w.z, local.position.x, local.position.y, local.position.z};
    for (int k = 0; k < 9; k++) check_near(end[k], expected[k], 1e-13, 1e-13);
    check_near(bough_norm(bough_sub(r.c1, local.rotation.c1)), 0, 0, 1e-13);
    check_near(bough_norm(bough_sub(r.c2, local.rotation.c2)), 0, 0, 1e-13);
}

// v·M Δv̇ = wrench · twist: the six inputs are conjugate to the first six outputs.
TEST(wrench_and_twist_are_conjugate) {
    ended e = make();
    fixture f = e.f;
    double with[MOST], without[MOST], mass[MOST * MOST], out[OUTPUTS], power = 0, expected = 0;
    double none[INPUTS] = {0};
    memcpy(none, e.input, BOUGH_PORT_INPUTS * sizeof(double));
    assert_true(f.s.ops->derivative(f.s.self, 0, e.state, e.input, with));
    assert_true(f.s.ops->derivative(f.s.self, 0, e.state, none, without));
    f.s.ops->output(f.s.self, 0, e.state, e.input, out);
    int n = f.tree->n_v, q = f.tree->n_q;
    bough_tree_kinematics(f.tree, e.state, f.data);
    tree_mass_matrix(f.tree, f.data, mass);
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++) {
            power += e.state[q + i] * mass[n * i + j] * (with[q + j] - without[q + j]);
        }
    }
    for (int k = 0; k < 6; k++) expected += e.input[6 + k] * out[BOUGH_PORT_OUTPUTS + k];
    check_near(power, expected, 1e-12, 1e-12);
}
