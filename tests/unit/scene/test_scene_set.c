// Values replaced by --set.
#include "tests/unit/scene_text.h"

TEST(values_can_be_replaced_and_added) {
    const char *const sets[] = {"simulation.coupling.scheme=extrapolated",
                                "simulation.coupling.order=2",
                                "bodies[3].pitch=5 deg",
                                "aero.wind={kind: uniform, speed: 9 m/s}",
                                "title=now: this",
                                "turbine.blades[1]=blade2"};
    fixture f = read_scene(SCENES "example-turbine.yaml", sets, 6);
    assert_string_equal(f.printed, "--set: error: title: expected text, got a mapping\n");
    f = read_scene(SCENES "example-turbine.yaml", sets, 4);
    assert_string_equal(f.printed, "");
    assert_string_equal(bough_scheme_name(f.scene->simulation.coupling.scheme), "extrapolated");
    assert_int_equal(f.scene->simulation.coupling.options.order, 2);
    check_near(f.scene->body[3].pitch, 5 * degree, 1e-15, 0);
    check_near(f.scene->body[4].pitch, 6.5 * degree, 1e-15, 0);
    check_near(f.scene->aero.wind.def.speed, 9, 0, 0);
}

TEST(missing_mappings_are_made) {
    const char *const sets[] = {"simulation.micro.rtol=1e-8", "simulation.threads=3"};
    fixture f = read_scene(SCENES "example-beam.yaml", sets, 2);
    assert_string_equal(f.printed, "");
    check_near(f.scene->simulation.micro.rtol, 1e-8, 0, 0);
    assert_int_equal(f.scene->simulation.threads, 3);
}

// A rod shared by an alias changes for the named body only.
TEST(shared_values_are_copied_first) {
    write_file("s.yaml", ROTOR);
    const char *const sets[] = {"bodies[1].rod.length=7"};
    fixture f = read_scene("s.yaml", sets, 1);
    assert_string_equal(f.printed, "");
    check_near(f.scene->body[1].rod.structure.length, 7, 0, 0);
    check_near(f.scene->body[2].rod.structure.length, 5, 0, 0);
}

TEST(bad_replacements_are_refused) {
    const char *const sets[] = {"abc",
                                "=1",
                                "title=",
                                "bodies[7].pitch=1",
                                "bodies[x].pitch=1",
                                "bodies[0=1",
                                "title.x=1",
                                "title[0]=1",
                                "bodies.x=1",
                                "a..b=1",
                                "bodies[0]x=1",
                                "title=[1",
                                "simulation.thread=2",
                                "bodies[3].pitch=5 kg",
                                "simulation.macro_step=0"};
    fixture f = read_scene(SCENES "example-turbine.yaml", sets, 15);
    assert_string_equal(
        f.printed, "--set: error: abc: expected KEY=VALUE\n"
                   "--set: error: =1: expected KEY=VALUE\n"
                   "--set: error: title: expected a value after '='\n"
                   "--set: error: bodies[7].pitch: index [7] is beyond the last, [4]\n"
                   "--set: error: bodies[x].pitch: there is no item with 'name: x' in that list\n"
                   "--set: error: bodies[0: expected an index such as [0] or [0-2], or a name as [blade1]\n"
                   "--set: error: title.x: key 'x' is looked for in 'Two-bladed example'\n"
                   "--set: error: title[0]: this key has no list, so it takes no index\n"
                   "--set: error: bodies.x: key 'x' is looked for in a list\n"
                   "--set: error: a..b: expected a key\n"
                   "--set: error: bodies[0]x: expected '.' or '['\n"
                   "--set: error: title: expected ',' or ']' to end the list\n"
                   "--set: error: simulation.macro_step: must be in [1e-9, 1e4] s, got '0'\n"
                   "--set: error: simulation: unknown key 'thread' (did you mean 'threads'?)\n"
                   "--set: error: bodies[3].pitch: expected an angle with its unit, as '5 deg', "
                   "got '5 kg': the unit 'kg' does not fit\n");
    assert_int_equal(f.status.code, BOUGH_INVALID);
    assert_null(f.scene);
}

GROUP(enter, leave)
