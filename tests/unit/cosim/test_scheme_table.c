// A scheme is one file and one line of the table: what scheme_toy.c adds is found, read from
// scenes, described, judged, stepped and diagnosed like any other.
#include "tests/unit/scene_text.h"
#include "tests/unit/two_mass.h"

TEST(the_table_lists_it_once) {
    int found = 0, n = 0;
    for (const char *name; (name = bough_scheme_name(n)) != NULL; n++) found += !strcmp(name, "toy");
    assert_int_equal(found, 1);
    assert_int_equal(n, 10);
    assert_string_equal(bough_scheme_find("toy")->name, "toy");
    assert_null(bough_scheme_name(-1));
    assert_null(bough_scheme_find("toys"));
}

TEST(entries_name_schemes_of_the_table) {
    const char *name;
    for (int i = 0; (name = bough_scheme_name(i)) != NULL; i++) {
        const bough_scheme *s = bough_scheme_find(name);
        char text[BOUGH_SCHEME_TEXT];
        bough_scheme_options options = bough_scheme_options_default();
        assert_ptr_equal(s, bough_scheme_find(s->name));
        bough_scheme_describe(s, &options, text);
        assert_memory_equal(text, name, strlen(name));
    }
}

#define SCENE(scheme)                                                                                        \
    "simulation: {duration: 1, macro_step: 0.1, coupling: {scheme: " scheme "}}\n"                           \
    "bodies:\n" BODY("a", "ground")

TEST(scenes_name_it) {
    fixture f = accepts(SCENE("toy"));
    assert_string_equal(bough_scheme_name(f.scene->simulation.coupling.scheme), "toy");
    write_file("s.yaml", SCENE("toi"));
    f = read_scene("s.yaml", NULL, 0);
    assert_non_null(strstr(f.printed, "(did you mean 'toy'?)"));
}

TEST(it_is_stepped_at_its_order) {
    double error[2];
    for (int k = 0; k < 2; k++) {
        bough_two_mass m = bough_two_mass_default();
        check_ok(bough_two_mass_build(check_memory(), &m, two_mass_def("toy", .02 / (k + 1), 10)));
        bough_two_mass_history(&m);
        error[k] = two_mass_error(&m);
        assert_string_equal(m.master->verdict, "");
    }
    check_near(error[0] / error[1], 4, .1, 0);
}

TEST(it_is_judged_and_diagnosed) {
    bough_two_mass m = bough_two_mass_default();
    bough_master_def def = two_mass_def("toy", .5, 10);
    def.duration = 1000;
    check_ok(bough_two_mass_build(check_memory(), &m, def));
    assert_non_null(strstr(m.master->verdict, "scheme toy at a macro step of 0.5 s is unstable"));
    assert_non_null(strstr(m.master->verdict, "scheme: ramp is stable in this state"));
    double worst;
    bough_status status = bough_two_mass_error(&m, &worst);
    check_fails(status, BOUGH_FAILED, "scheme toy");
    assert_non_null(strstr(status.message, "or scheme: monolithic"));
}

GROUP(enter, leave)
