// Scenes that build on another one.
#include "apps/bough/config/base.h"
#include "apps/bough/scene/scene_files.h"
#include "tests/unit/scene_text.h"

#include <sys/stat.h>

// s.yaml on polars.yaml, which is the rotor.
static fixture on_rotor(const char *text, const char *const *sets, int n_set) {
    char all[2000];
    snprintf(all, sizeof all, "base: polars.yaml\n%s", text);
    write_file("polars.yaml", ROTOR);
    write_file("s.yaml", all);
    return read_scene("s.yaml", sets, n_set);
}

TEST(mappings_and_lists_of_names_merge) {
    fixture f = on_rotor("simulation: {threads: 3}\n"
                         "bodies:\n"
                         "  - {name: b2, pitch: 3 deg, rod: {length: 7}}\n"
                         "  - {name: end, mass: 2, fidelity: rigid, joint: {kind: fixed, parent: b2}}\n",
                         NULL, 0);
    assert_string_equal(f.printed, "");
    assert_string_equal(f.scene->base, "polars.yaml");
    assert_int_equal(f.scene->simulation.threads, 3);
    assert_int_equal(f.scene->n_body, 4);
    const bough_scene_body *body = f.scene->body;
    check_near(body[1].rod.structure.length, 5, 0, 0); // the mapping that an alias shares is not changed
    check_near(body[2].rod.structure.length, 7, 0, 0);
    check_near(body[2].pitch, 3 * degree, 1e-15, 0);
    assert_string_equal(body[3].name, "end");
}

TEST(a_mapping_changes_and_removes_items_by_name) {
    fixture f = on_rotor("bodies: {b1: null, b2: {pitch: 3 deg}}\n", NULL, 0);
    assert_string_equal(f.printed, "");
    assert_int_equal(f.scene->n_body, 2);
    assert_string_equal(f.scene->body[1].name, "b2");
    check_near(f.scene->body[1].pitch, 3 * degree, 1e-15, 0);
}

TEST(null_removes_a_key_in_settings_too) {
    const char *const sets[] = {"bodies[b2].pitch=null", "bodies[b1]=~", "title=null"};
    fixture f = on_rotor("title: rotor\nbodies: {b2: {pitch: 3 deg}}\n", sets, 3);
    assert_string_equal(f.printed, "");
    assert_int_equal(f.scene->n_body, 2);
    assert_true(f.scene->body[1].pitch == 0);
    assert_null(f.scene->title);
}

TEST(what_does_not_fit_the_base_is_named) {
    fixture f = on_rotor("bodies: {b3: {pitch: 1}, b1: {pich: null}}\nsimulation: {macro_stp: null}\n"
                         "title: [1]\n",
                         NULL, 0);
    assert_string_equal(
        f.printed,
        "s.yaml:2:10: error: bodies: the base has no 'b3' (did you mean 'b1'?)\n"
        "s.yaml:2:31: error: bodies[b1]: the base has no 'pich'\n"
        "s.yaml:3:14: error: simulation: the base has no 'macro_stp' (did you mean 'macro_step'?)\n"
        "s.yaml:4:8: error: title: expected text, got a list\n");
}

// A wrong value is found where it stands, in either file.
TEST(values_keep_their_place) {
    write_file("polars.yaml", "title: a\nsimulation: {duration: 1 kg, macro_step: 1 s}\nbodies: []\n");
    write_file("s.yaml", "base: polars.yaml\nsimulation: {macro_step: 2 kg}\n");
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_non_null(strstr(f.printed, "s.yaml:2:26: error: simulation.macro_step"));
    assert_non_null(strstr(f.printed, "polars.yaml:2:24: error: simulation.duration"));
}

TEST(a_base_that_is_none_is_refused) {
    refuses("base: s.yaml\n", "s.yaml:1:7: error: base: file 's.yaml' would build on itself\n");
    refuses("base: [1]\n", "s.yaml:1:7: error: base: expected the name of a file, got a list\n");
    refuses("base: none.yaml\n", "none.yaml: error: cannot be read: No such file or directory\n"
                                 "s.yaml:1:7: error: base: 'none.yaml' is not a file to build on\n");
    write_file("polars.yaml", "base: s.yaml\n");
    refuses("base: polars.yaml\n", "s.yaml:1:7: error: base: 'polars.yaml' is not a file to build on\n"
                                   "polars.yaml:1:7: error: base: file 's.yaml' would build on itself\n");
    write_file("polars.yaml", "[1]\n");
    refuses("base: polars.yaml\n", "s.yaml:1:7: error: base: 'polars.yaml' is not a file to build on\n");
}

// Paths are relative to the file that they stand in; the base is one of the scene's files.
TEST(a_base_has_a_directory_of_its_own) {
    assert_int_equal(mkdir("inner", 0700), 0);
    write_file(
        "blade.yaml",
        "length: 1\nstations:\n  - {span: 0, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}\n"
        "  - {span: 1, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}\n");
    write_file("polars.yaml",
               SIMULATION "bodies:\n  - {name: a, fidelity: rod, joint: {kind: fixed, parent: ground}, "
                          "rod: {table: blade.yaml}}\n");
    write_file("inner/s.yaml", "base: ../polars.yaml\nbodies: {a: {rod: {segments: 3}}}\n");
    fixture f = read_scene("inner/s.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    check_near(f.scene->body[0].rod.structure.length, 1, 0, 0);
    bough_scene_files files = bough_scene_list_files(f.arena, f.scene);
    assert_int_equal(files.n, 3);
    assert_string_equal(files.item[1].path, "inner/../polars.yaml");
    assert_string_equal(files.item[2].path, "inner/../blade.yaml");
}

static const char *as_it_is(void *self, const bough_node *scalar) {
    (void)self;
    return scalar->text;
}

// What is written reads as the same tree: written again, it is the same text.
TEST(a_tree_is_written_as_it_reads) {
    static const char text[] = "a: [1, [2, x y], {}]\n'b: c': {d: \"null\", e: null, f: ''}\n"
                               "g:\n  - name: h # why\n    i: [[1, 2], [3, 4]]\n  - - j\n    - {k: '- l'}\n"
                               "m: |\n  two\n  lines\nbase: x\n";
    check_arena(arena);
    bough_errors errors = {.arena = arena};
    char *first = NULL, *second = NULL;
    size_t size;
    const bough_node *node = bough_text_parse(arena, "t", text, strlen(text), &errors);
    for (int k = 0; k < 2; k++) {
        FILE *stream = open_memstream(k == 0 ? &first : &second, &size);
        bough_node_write(node, as_it_is, NULL, stream);
        fclose(stream);
        if (k == 0) node = bough_text_parse(arena, "t", first, size, &errors);
    }
    assert_string_equal(printed_errors(&errors), "");
    assert_string_equal(first, second);
    assert_string_equal(first,
                        "a:\n  - 1\n  - [2, x y]\n  - {}\n\"b: c\":\n  d: \"null\"\n  e: null\n  f: \"\"\n"
                        "g:\n  - name: h\n    i:\n      - [1, 2]\n      - [3, 4]\n  -\n    - j\n"
                        "    - k: \"- l\"\nm: \"two\\nlines\\n\"\n");
    free(first);
    free(second);
}

GROUP(enter, leave)
