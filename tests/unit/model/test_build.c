// What is built of a scene: everything it names, in the right place, and nothing else.
#include "tests/unit/built_scene.h"
#include "tests/unit/sample_numbers.h"
#include "tests/unit/tree_measure.h"

#include "flexbody/section/section.h"

static const char runup[] = "apps/turbine/runup.yaml", arms[] = "tests/data/scenes/arms.yaml";

// -- parts ----------------------------------------------------------------------------------------

TEST(scene_without_aero_samples_nothing) {
    bough_arena *arena = bough_arena_create();
    bough_simulation *s = scene_build(arena, arms, no_sets);
    assert_null(s->aero);
    assert_int_equal(s->master->n_load, 0);
    assert_int_equal(s->n_beam, 3);
    assert_int_equal(s->n_rod, 2);
    assert_int_equal(s->master->assembly->n_member, 3);
    bough_arena_destroy(arena);
    arena = bough_arena_create();
    s = scene_build(arena, runup, no_sets);
    assert_non_null(s->aero);
    assert_int_equal(s->master->n_load, 1);
    check_near(s->master->load[0].period, 0.02, 1e-15, 0);
    bough_arena_destroy(arena);
}

TEST(rods_take_ports_in_the_order_of_the_scene) {
    static const char *const names[] = {"third", "stiff", "first"};
    static const int ports[] = {0, -1, 1}, bodies[] = {0, 2, 3};
    check_build(arena, s, arms, no_sets);
    for (int k = 0; k < 3; k++) {
        const bough_beam *beam = &s->beam[k];
        assert_string_equal(beam->body->name, names[k]);
        assert_string_equal(s->tree->markers[beam->marker].name, names[k]);
        assert_int_equal(beam->port, ports[k]);
        assert_ptr_equal(bough_simulation_beam(s, bodies[k]), beam);
        assert_int_equal(beam->rod == NULL, ports[k] < 0);
        if (beam->rod == NULL) continue;
        assert_ptr_equal(s->rod[beam->port].system.self, beam->rod);
        assert_ptr_equal(s->master->assembly->member[beam->port + 1], &s->rod[beam->port]);
        assert_string_equal(s->rod[beam->port].system.name, names[k]);
        assert_int_equal(s->tree->ports[beam->port].link, s->tree->markers[beam->marker].link);
    }
    assert_null(bough_simulation_beam(s, 1));
    assert_ptr_equal(s->master->assembly->member[0], &s->leader);
}

// Each rod is moved by its own root and its wrench returns there.
TEST(rods_are_connected_to_their_roots) {
    check_build(arena, s, arms, no_sets);
    const bough_assembly *a = s->master->assembly;
    static const double radius[] = {3, 1}; // of the ports' roots
    for (int p = 0; p < 2; p++) {
        const double *input = s->master->coupling->input + a->input_offset[p + 1];
        double speed = sqrt(input[0] * input[0] + input[1] * input[1] + input[2] * input[2]);
        double weight = sqrt(input[6] * input[6] + input[7] * input[7] + input[8] * input[8]);
        check_near(speed, 2 * radius[p], 1e-14, 0);
        check_near(input[3], p == 0 ? 2 * cos(BOUGH_PI / 6) : 2, 1e-14, 0); // pitch turns the axes
        check_near(weight, 9.8, 1e-14, 0);
        for (int c = 0; c < BOUGH_PORT_INPUTS; c++) {
            int j = a->input_offset[0] + BOUGH_PORT_INPUTS * p + c;
            assert_int_equal(a->source_member[j], p + 1);
            assert_int_equal(a->source[j], a->output_offset[p + 1] + c);
            assert_false(a->kinematic[j]);
        }
        assert_true(a->kinematic[a->input_offset[p + 1]]);
    }
}

TEST(rigid_blades_leave_the_tree_alone) {
    check_build_with(arena, s, runup, "bodies[3-5].fidelity=rigid");
    assert_int_equal(s->n_rod, 0);
    assert_int_equal(s->n_beam, 3);
    assert_int_equal(s->leader.system.n_state, 2);
    assert_int_equal(s->leader.system.n_input, 0);
    assert_int_equal(s->master->assembly->n_member, 1);
    assert_int_equal(s->master->assembly->n_state, 2);
    for (int k = 0; k < 3; k++) assert_null(s->beam[k].rod);
    assert_non_null(s->aero); // which loads them as bodies
    for (int k = 0; k < 10; k++) scene_step(s);
    assert_true(s->leader.state[1] > 0.5);
}

// The third beam equals the first one, unless a value of its section, its damping or its mesh differs.
TEST(equal_beams_have_one_mesh) {
    static const char *const other[] = {NULL, "bodies[first].rod.segments=5",
                                        "bodies[first].rod.mass=[1.5, 0, 0, 2e-3, 3e-3, 1e-9]",
                                        "bodies[first].rod.damping=[0, 0, 0, 0, 0, 1e-3]"};
    for (int k = 0; k < 4; k++) {
        check_build_with(arena, s, arms, other[k]);
        assert_ptr_not_equal(s->beam[1].def.stiffness, s->beam[0].def.stiffness);
        assert_int_equal(s->beam[2].def.stiffness == s->beam[0].def.stiffness, k == 0);
        assert_string_equal(s->beam[2].def.name, "first");
    }
}

// Half a second of the run-up: the rotor turns as with rods, the tips bend as theirs.
TEST(modal_blades_move_as_rods) {
    static const char *const sets[3][2] = {{"bodies[3-5].fidelity=rod", NULL},
                                           {"bodies[3-5].fidelity=modal", NULL},
                                           {"bodies[3-5].fidelity=segmented-modal", NULL}};
    double speed[3], tip[3];
    for (int k = 0; k < 3; k++) {
        check_arena(arena);
        bough_quaternion turn;
        bough_simulation *s = scene_build(arena, runup, sets[k]);
        assert_int_equal(s->n_rod, 3);
        assert_true((s->beam[0].rod != NULL) == (k == 0));
        for (int i = 0; i < 50; i++) scene_step(s);
        bough_simulation_update(s);
        speed[k] = s->leader.state[1];
        tip[k] = bough_simulation_beam_tip(s, &s->beam[0], &turn).x -
                 s->beam[0].def.position[s->beam[0].def.n_segment].x;
    }
    for (int k = 1; k < 3; k++) {
        check_near(speed[k], speed[0], 2e-3, 0);
        check_near(tip[k], tip[0], 0.02, 0);
    }
}

// -- placement and initial motion -----------------------------------------------------------------

static bough_transform pose_of(const bough_simulation *s, const char *body) {
    return bough_tree_frame_pose(s->view, &s->tree->bodies[tree_find_body(s->tree, body)]);
}

static const char carrying[] = "tests/data/scenes/carrying.yaml";

// From the undeformed end, in the axes of the rod's body whatever the section's twist.
TEST(bodies_hang_on_the_end_of_a_rod_bent_or_rigid) {
    static const char *const fidelity[] = {"bodies[0].fidelity=rod", "bodies[0].fidelity=rigid"};
    for (int k = 0; k < 2; k++) {
        check_build_with(arena, s, carrying, fidelity[k]);
        bough_transform pose = pose_of(s, "weight");
        check_vec3(pose.position, bough_v3(1, -0.3, 2), 1e-14, 0);
        check_near(pose.rotation.c1.x, 0, 0, 1e-15);
        check_near(pose.rotation.c1.y, 1, 1e-14, 0);
        check_near(pose.rotation.c3.z, 1, 1e-14, 0);
    }
}

TEST(end_of_a_rod_is_connected_to_its_body) {
    check_build(arena, s, carrying, no_sets);
    const bough_assembly *a = s->master->assembly;
    const bough_beam *beam = &s->beam[0];
    assert_int_equal(beam->end, 0);
    assert_int_equal(s->n_end, 1);
    assert_int_equal(s->tree->n_bodies, 3);
    assert_int_equal(s->leader.system.n_state, 13); // the end is free, the weight welded to it
    assert_int_equal(s->rod[0].system.n_state, 13 * 3);
    assert_int_equal(a->n_pair, 2);
    assert_int_equal(a->pair[1].body, 1);
    assert_int_equal(a->pair[1].twist, a->input_offset[1] + BOUGH_ROD_INPUTS);
    assert_int_equal(a->pair[1].wrench, BOUGH_PORT_INPUTS);
    const double *end = bough_simulation_rod_input(s, beam) + BOUGH_ROD_INPUTS;
    bough_quaternion p = beam->def.rotation[4];
    const double expected[BOUGH_ROD_END_INPUTS] = {0, 0, 0, 0, 0, 0, 0, 0, 2, p.w, p.x, p.y, p.z};
    for (int k = 0; k < BOUGH_ROD_END_INPUTS; k++) check_near(end[k], expected[k], 1e-15, 1e-15);
}

static bough_twist velocity_of(const bough_simulation *s, const char *body) {
    return bough_tree_frame_velocity(s->view, &s->tree->bodies[tree_find_body(s->tree, body)]);
}

// The hub stands at 90°: what points along z at 0 points along −y.
TEST(bodies_start_where_the_scene_puts_them) {
    check_build(arena, s, arms, no_sets);
    double half = sqrt(3) / 2;
    check_vec3(pose_of(s, "first").position, bough_v3(0, -1, 10), 0, 1e-14);
    check_vec3(pose_of(s, "stiff").position, bough_v3(0, 1, 10 - 2 * half), 0, 1e-14);
    check_vec3(pose_of(s, "third").position, bough_v3(0, 1.5, 10 + 3 * half), 0, 1e-14);
    check_vec3(pose_of(s, "carriage").position, bough_v3(0, 0.5, 0), 0, 1e-14);
    check_vec3(velocity_of(s, "first").linear, bough_v3(0, 0, -2), 0, 1e-14);
    check_vec3(velocity_of(s, "carriage").linear, bough_v3(0, -3, 0), 0, 1e-14);
    check_vec3(velocity_of(s, "thrown").linear, bough_v3(1, 2, 3), 0, 1e-14);
    check_vec3(velocity_of(s, "thrown").angular, bough_v3(4, 5, 6), 0, 1e-14);
    // pitch is the last rotation, by −30° about the arm
    bough_mat3 r = pose_of(s, "third").rotation;
    check_vec3(r.c3, bough_v3(0, 0.5, half), 0, 1e-14);
    check_vec3(bough_v3(r.c1.x, r.c2.x, r.c3.x), bough_v3(half, 0.5, 0), 0, 1e-14);
}

// Vertices of beams, flexible or rigid, lie along their arm and turn with the hub.
TEST(beams_move_with_the_hub_at_first) {
    static const char *const names[] = {"third", "stiff", "first"};
    bough_vec3 omega = {2, 0, 0}, hub = {0, 0, 10};
    bough_vertex_motion vertex[5];
    check_build(arena, s, arms, no_sets);
    for (int k = 0; k < 3; k++) {
        bough_transform root = pose_of(s, names[k]);
        bough_simulation_beam_motion(s, &s->beam[k], vertex);
        for (int i = 0; i < 5; i++) {
            bough_vec3 expected = bough_axpy(0.5 * i, root.rotation.c3, root.position);
            check_vec3(vertex[i].position, expected, 0, 1e-14);
            check_vec3(vertex[i].velocity, bough_cross(omega, bough_sub(expected, hub)), 0, 1e-13);
            check_vec3(vertex[i].angular, omega, 0, 1e-14);
            check_vec3(vertex[i].rotation.c1, root.rotation.c1, 0, 1e-14);
            check_vec3(vertex[i].rotation.c3, root.rotation.c3, 0, 1e-14);
        }
    }
}

TEST(a_body_may_have_its_own_sub_solver) {
    check_build_with(arena, s, arms, "bodies[0].micro.solver=arkode-esdirk",
                     "simulation.micro.solver=generalized-alpha");
    assert_string_equal(s->rod[0].solver, "ARKODE ESDIRK");
    assert_string_equal(s->rod[1].solver, "generalised-α");
    for (int k = 0; k < 5; k++) {
        check_ok(bough_step(s->master));
    }
}

TEST(joint_loads_act_and_their_corners_are_events) {
    bough_arena *arena = bough_arena_create();
    bough_simulation *s = scene_build(arena, arms, no_sets);
    assert_int_equal(s->master->n_event, 2);
    check_near(s->master->event[0], 0.2, 1e-15, 0);
    check_near(s->master->event[1], 0.4, 1e-15, 0);
    for (int k = 0; k < 600; k++) scene_step(s);
    // impulse 8 N · (0.1 + 0.2) s on 4 kg
    bough_simulation_update(s);
    check_near(velocity_of(s, "carriage").linear.y, -3 + 8 * 0.3 / 4, 1e-5, 0); // IDA at 1e-6
    bough_arena_destroy(arena);
    arena = bough_arena_create();
    s = scene_build(arena, runup, no_sets);
    assert_int_equal(s->master->n_event, 3);
    check_near(s->master->event[0], 0, 1e-15, 0); // of both
    check_near(s->master->event[1], 2, 1e-15, 0); // of the aerodynamics
    check_near(s->master->event[2], 20, 1e-15, 0);
    bough_arena_destroy(arena);
}

// -- inertia --------------------------------------------------------------------------------------

static bough_mat3 about(int axis, double angle) {
    bough_vec3 unit = {axis == 0, axis == 1, axis == 2};
    return bough_rotation_matrix(bough_quaternion_exponential(bough_scale(angle, unit)));
}

// A blade of the run-up about the hub, straight from the table: sections between two stations in
// thin slices.
static bough_inertia blade_about_hub(const bough_scene_body *body, double azimuth) {
    const bough_scene_structure *table = &body->rod.structure;
    enum { SLICES = 200 };
    bough_inertia sum = {0};
    bough_mat3 lean = bough_mat3_product(about(0, azimuth), about(1, -2.5 * BOUGH_DEGREE));
    for (int k = 0; k + 1 < table->n_station; k++) {
        const bough_section_station *low = &table->station[k].def, *high = &table->station[k + 1].def;
        double thickness = (high->position.z - low->position.z) / SLICES;
        for (int slice = 0; slice < SLICES; slice++) {
            double f = (slice + 0.5) / SLICES, g = 1 - f;
            double z = g * low->position.z + f * high->position.z;
            double twist = g * low->twist + f * high->twist;
            double ix = g * low->inertia[0] + f * high->inertia[0];
            double iy = g * low->inertia[1] + f * high->inertia[1];
            double mass = thickness * (g * low->mass + f * high->mass);
            bough_mat3 own = {{thickness * ix, 0, 0}, {0, thickness * iy, 0}, {0, 0, thickness * (ix + iy)}};
            bough_transform x = {bough_scale(1.5 + z, lean.c3),
                                 bough_mat3_product(lean, about(2, -twist - 6.5 * BOUGH_DEGREE))};
            bough_inertia section = {mass, {0, 0, 0}, own};
            sum = bough_inertia_add(sum, bough_inertia_to_parent(&x, section));
        }
    }
    return sum;
}

static void check_inertia(bough_inertia value, bough_inertia expected, double tolerance) {
    check_near(value.mass, expected.mass, tolerance, 0);
    check_vec3(value.first, expected.first, 0, tolerance * 60 * expected.mass);
    double size = tolerance * expected.rotational.c1.x;
    check_vec3(value.rotational.c1, expected.rotational.c1, 0, size);
    check_vec3(value.rotational.c2, expected.rotational.c2, 0, size);
    check_vec3(value.rotational.c3, expected.rotational.c3, 0, size);
}

TEST(rigid_blades_have_the_inertia_of_their_table) {
    check_build_with(arena, s, runup, "bodies[3-5].fidelity=rigid", "bodies[3-5].rod.segments=12");
    bough_mat3 hub = {{5.1414234e6, 0, 0}, {0, 2.6e6, 0}, {0, 0, 2.6e6}};
    bough_inertia expected = {56780, {0, 0, 0}, hub};
    for (int b = 0; b < 3; b++) {
        bough_inertia blade = blade_about_hub(&s->scene->body[3 + b], b * 2 * BOUGH_PI / 3);
        check_near(blade.mass, 16844.75, 1e-5, 0); // as the table's head says
        expected = bough_inertia_add(expected, blade);
    }
    assert_int_equal(s->tree->n_links, 1);
    check_inertia(s->tree->links[0].inertia, expected, 1e-6);
}

// Arms of a uniform section, one with its mass beside the axis, in the hub's axes.
TEST(rigid_arms_have_their_mass_where_the_section_says) {
    static const char *const sets[] = {"bodies[0].fidelity=rigid", "bodies[3].fidelity=rigid", NULL};
    static const double angle[] = {4 * BOUGH_PI / 3, 2 * BOUGH_PI / 3, 0}, radius[] = {3, 2, 1};
    check_build(arena, s, arms, sets);
    bough_inertia expected = {50, {0, 0, 0}, {{5, 0, 0}, {0, 3, 0}, {0, 0, 3}}};
    for (int k = 0; k < 3; k++) { // 1.5 kg/m from 0 to 2 m
        double cx = k == 1 ? 0.02 : 0, cy = k == 1 ? -0.01 : 0, xy = k == 1 ? 1e-3 : 0;
        bough_mat3 about_root = {
            {4 + 4e-3, 2 * xy, -3 * cx}, {2 * xy, 4 + 6e-3, -3 * cy}, {-3 * cx, -3 * cy, 1e-2}};
        bough_mat3 r = bough_mat3_product(about(0, angle[k]), about(2, k == 0 ? -BOUGH_PI / 6 : 0));
        bough_transform x = {bough_scale(radius[k], r.c3), r};
        bough_inertia arm = {3, bough_v3(3 * cx, 3 * cy, 3), about_root};
        expected = bough_inertia_add(expected, bough_inertia_to_parent(&x, arm));
    }
    bough_inertia hub = s->tree->links[s->tree->bodies[1].link].inertia;
    check_inertia(hub, expected, 1e-12);
}

// A rod's vertices but the root, in the axes of the link that carries it.
static bough_inertia moving_inertia(const bough_simulation *s, const bough_beam *beam) {
    const bough_rod_model *m = bough_rod_body_model(beam->rod);
    bough_inertia sum = {0};
    for (int i = 1; i <= m->n; i++) {
        const double *j = m->vertex[i].inertia;
        bough_inertia own = {m->vertex[i].mass,
                             m->vertex[i].moment,
                             {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}}};
        bough_transform at = {m->position0[i], bough_rotation_matrix(m->rotation0[i])};
        bough_transform x = bough_transform_compose(s->tree->markers[beam->marker].placement, at);
        sum = bough_inertia_add(sum, bough_inertia_to_parent(&x, own));
    }
    return sum;
}

// Of a flexible blade, here a twisted one, the tree carries the root vertex, the rod all others.
TEST(flexible_blade_shares_its_inertia_with_the_tree) {
    static const char turbine[] = "tests/data/scenes/example-turbine.yaml";
    static const char *const sets[] = {"bodies[3].fidelity=rigid", NULL};
    check_arena(arena);
    bough_simulation *rigid = scene_build(arena, turbine, sets);
    bough_simulation *s = scene_build(arena, turbine, no_sets);
    bough_inertia link = s->tree->links[0].inertia, moving = moving_inertia(s, &s->beam[0]);
    assert_true(moving.mass > 300);
    check_inertia(bough_inertia_add(link, moving), rigid->tree->links[0].inertia, 1e-13);
}

// -- threads --------------------------------------------------------------------------------------

enum { MOST_STATES = 1000 };

static int final_state(const char *scheme, int threads, double *state) {
    char scheme_set[64], thread_set[64];
    snprintf(scheme_set, sizeof scheme_set, "simulation.coupling.scheme=%s", scheme);
    snprintf(thread_set, sizeof thread_set, "simulation.threads=%d", threads);
    check_build_with(arena, s, runup, "simulation.duration=1 s", "simulation.macro_step=4 ms", scheme_set,
                     thread_set, "simulation.micro.step=2 ms", "bodies[3-5].rod.segments=12");
    while (!bough_master_done(s->master)) scene_step(s);
    const bough_assembly *a = s->master->assembly;
    assert_true(a->n_state + a->n_output <= MOST_STATES);
    for (int i = 0; i < a->n_member; i++) {
        size_t bytes = (size_t)a->member[i]->system.n_state * sizeof *state;
        memcpy(state + a->state_offset[i], a->member[i]->state, bytes);
    }
    memcpy(state + a->n_state, s->master->coupling->output, (size_t)a->n_output * sizeof *state);
    return a->n_state + a->n_output;
}

TEST(threads_do_not_change_a_bit_of_any_scheme) {
    static const int threads[] = {2, 3, 8};
    double one[MOST_STATES], many[MOST_STATES];
    const char *scheme;
    for (int k = 0; (scheme = bough_scheme_name(k)) != NULL; k++) {
        int n = final_state(scheme, 1, one);
        assert_true(one[1] > 0.5); // the rotor turns faster than it began
        for (int i = 0; i < 3; i++) {
            assert_int_equal(final_state(scheme, threads[i], many), n);
            assert_memory_equal(one, many, (size_t)n * sizeof *one);
        }
    }
}

// A base of 0.9 MHz beside a rod, which the tree's integrator cannot follow through a macro step.
TEST(a_tree_that_takes_too_many_steps_says_so) {
    check_build_with(
        arena, s, "tests/data/scenes/small-vibration.yaml", "simulation.coupling.scheme=frozen",
        "simulation.error_estimate=none",
        "bodies[base].joint={kind: prismatic, axis: x, parent: ground, speed: 1 m/s, stiffness: 1e14}");
    check_fails(bough_step(s->master), BOUGH_FAILED, "20000 steps would not reach the end of the macro step");
}
