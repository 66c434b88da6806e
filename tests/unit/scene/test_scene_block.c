// A turbine in one block.
#include "tests/unit/scene_text.h"

static void link_data(const char *name) {
    char path[300];
    snprintf(path, sizeof path, BOUGH_SOURCE_DIR "/apps/turbine/%s", name);
    assert_true(access(name, F_OK) == 0 || symlink(path, name) == 0);
}

// The rotor of runup.yaml; `more` are keys of the block, and then of the scene.
static fixture with_block(const char *more, const char *const *sets, int n_set) {
    char text[2000];
    link_data("blade-structure.yaml");
    link_data("blade-aero.yaml");
    link_data("airfoils.yaml");
    snprintf(text, sizeof text,
             SIMULATION "aero: {rate: 100 Hz, wind: {kind: uniform, speed: 20 m/s}, blade: blade-aero.yaml,\n"
                        "       polars: airfoils.yaml}\n"
                        "turbine:\n  blades: 3\n  tower_height: 87.6 m\n  shaft_height: 1.96256 m\n"
                        "  tilt: 5 deg\n  overhang: 5.0191 m\n  cone: 2.5 deg\n  hub_radius: 1.5 m\n"
                        "  speed: 0.5 rad/s\n  nacelle: {mass: 240 t, centre_of_mass: [1.9, 0, 1.75]}\n"
                        "  hub: {mass: 56780 kg, inertia: [5.1414234e6, 2.6e6, 2.6e6]}\n"
                        "  blade: {rod: {table: blade-structure.yaml, segments: 24, grading: 0.19}}\n%s",
             more);
    write_file("s.yaml", text);
    fixture f = read_scene("s.yaml", sets, n_set);
    remove("blade-structure.yaml");
    remove("blade-aero.yaml");
    remove("airfoils.yaml");
    return f;
}

static void check_same_placement(const bough_scene_joint *a, const bough_scene_joint *b) {
    assert_int_equal(a->kind, b->kind);
    assert_int_equal(a->parent, b->parent);
    assert_memory_equal(&a->placement, &b->placement, sizeof a->placement);
}

// The block stands for the long form of runup.yaml, to the last bit.
TEST(a_block_is_its_long_form) {
    fixture f = with_block("  pitch: 6.5 deg\n", NULL, 0);
    assert_string_equal(f.printed, "");
    fixture g = read_scene(BOUGH_SOURCE_DIR "/apps/turbine/runup.yaml", NULL, 0);
    assert_string_equal(g.printed, "");
    assert_int_equal(f.scene->n_body, g.scene->n_body);
    for (int i = 0; i < g.scene->n_body; i++) {
        const bough_scene_body *a = &f.scene->body[i], *b = &g.scene->body[i];
        assert_string_equal(a->name, b->name);
        assert_int_equal(a->fidelity, b->fidelity);
        assert_true(a->pitch == b->pitch && a->mass == b->mass && a->joint.speeds[0] == b->joint.speeds[0]);
        check_same_placement(&a->joint, &b->joint);
    }
    assert_int_equal(f.scene->turbine.rotor, g.scene->turbine.rotor);
    assert_int_equal(f.scene->turbine.n_blade, 3);
    for (int k = 0; k < 3; k++) assert_int_equal(f.scene->turbine.blade[k], g.scene->turbine.blade[k]);
    assert_true(f.scene->aero.hub_radius == 1.5);
}

TEST(a_controlled_blade_hangs_on_a_joint) {
    const char *const sets[] = {"turbine.blades=2", "turbine.pitch=controlled",
                                "bodies[blade2].rod.segments=7"};
    fixture f = with_block("", sets, 3);
    assert_string_equal(f.printed, "");
    const bough_scene_body *blade = &f.scene->body[4];
    assert_int_equal(f.scene->n_body, 5);
    assert_int_equal(blade->joint.kind, BOUGH_JOINT_REVOLUTE);
    assert_int_equal(blade->joint.axis, BOUGH_SCENE_Z);
    assert_non_null(blade->joint.motion[0].node);
    check_near(blade->joint.placement.rotation.c2.y, -1, 1e-15, 0);
    assert_int_equal(blade->rod.n_segment, 7);
    assert_int_equal(f.scene->body[3].rod.n_segment, 24);
}

// A part changes its body; the scene's own bodies change and add some.
TEST(bodies_change_and_join_those_of_the_block) {
    fixture f =
        with_block("bodies:\n  - {name: blade2, pitch: 1 deg}\n"
                   "  - {name: mast, fidelity: rigid, mass: 2, joint: {kind: fixed, parent: nacelle}}\n",
                   NULL, 0);
    assert_string_equal(f.printed, "");
    assert_int_equal(f.scene->n_body, 7);
    assert_true(f.scene->body[4].pitch == degree && f.scene->body[3].pitch == 0);
    assert_string_equal(f.scene->body[6].name, "mast");
    const char *const sets[] = {"turbine.nacelle.joint={kind: revolute, axis: z, stiffness: 9e9}"};
    f = with_block("", sets, 1);
    assert_string_equal(f.printed, "");
    assert_int_equal(f.scene->body[1].joint.kind, BOUGH_JOINT_REVOLUTE);
    check_near(f.scene->body[1].joint.placement.position.z, 87.6, 0, 0);
}

TEST(a_tower_with_a_rod_carries_the_nacelle_at_its_end) {
    const char *const sets[] = {"turbine.tower_height=null",
                                "turbine.tower.rod={length: 80, stiffness: [1, 1, 1, 1, 1, 1], "
                                "mass: [1, 0, 0, 1, 1, 0]}"};
    fixture f = with_block("", sets, 2);
    assert_string_equal(f.printed, "");
    assert_int_equal(f.scene->body[0].fidelity, BOUGH_SCENE_ROD);
    check_near(f.scene->body[1].joint.placement.position.z, 0, 0, 0);
    f = with_block("", sets + 1, 1);
    assert_string_equal(
        f.printed, "s.yaml:6:17: error: turbine.tower_height: only of a rigid tower: this one has a rod\n");
}

// An error in what all blades share stands once, where it is written.
TEST(errors_of_a_block_have_a_place) {
    fixture f = with_block("  pich: 3\n", NULL, 0);
    assert_string_equal(f.printed,
                        "s.yaml:16:3: error: turbine: unknown key 'pich' (did you mean 'pitch'?)\n");
    f = with_block("  tower: 3\n", NULL, 0);
    assert_string_equal(f.printed,
                        "s.yaml:16:10: error: turbine.tower: expected a mapping with keys of a body\n");
    f = with_block("  tower: {name: a}\n", NULL, 0);
    assert_string_equal(f.printed,
                        "s.yaml:16:17: error: turbine.tower.name: the block names its bodies itself\n");
    write_file("s.yaml",
               SIMULATION "turbine:\n  blades: 2\n  hub_radius: 1 m\n  blade:\n    rod: {lenght: 3}\n");
    f = read_scene("s.yaml", NULL, 0);
    assert_non_null(strstr(f.printed, "s.yaml:6:11: error: bodies[3].rod: unknown key 'lenght' (did you mean "
                                      "'length'?)\n"));
    assert_null(strstr(f.printed, "bodies[4]"));
}

TEST(a_scene_without_bodies_is_refused) {
    refuses(SIMULATION, "s.yaml:1:1: error: required key 'bodies' is missing\n");
}

GROUP(enter, leave)
