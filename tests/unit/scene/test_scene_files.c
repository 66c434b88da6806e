// The one list of the files that a scene names: every key that names one is in it, and the fingerprint
// changes with each of them.
#include "apps/bough/scene/scene_files.h"
#include "tests/unit/scene_text.h"

#include <sys/stat.h>

#define FMU                                                                                                  \
    "<?xml version='1.0'?>\n<fmiModelDescription fmiVersion='3.0' modelName='m' instantiationToken='t'>\n"   \
    "<CoSimulation modelIdentifier='m'/><ModelVariables/><ModelStructure/></fmiModelDescription>\n"

static const char scene[] =
    "simulation: {duration: 1 s, macro_step: 10 ms, error_estimate: none, coupling: {scheme: gauss-seidel}}\n"
    "bodies:\n"
    "  - {name: hub, mass: 1, fidelity: rigid, joint: {kind: revolute, parent: ground, axis: x}}\n"
    "  - {name: b1, fidelity: rod, joint: {kind: fixed, parent: hub}, rod: {table: rod.yaml}}\n"
    "  - {name: b2, fidelity: rod, joint: {kind: fixed, parent: hub}, rod: {table: rod.yaml}}\n"
    "  - {name: damper, mass: 1, fidelity: fmu, joint: {kind: fixed, parent: ground},\n"
    "     fmu: {folder: damper, motion: [none, none, none, none, none, none, none, none, none],\n"
    "           wrench: [none, none, none, none, none, none]}}\n"
    "turbine: {rotor: hub, blades: [b1, b2]}\n"
    "aero: {rate: 50 Hz, wind: {kind: bts, file: wind.bts}, blade: aero.yaml, polars: polars.yaml, "
    "hub_radius: 1}\n"
    "control: {kind: bladed, library: control/law.so, input: control/law.in, pitch: false}\n";

static const struct {
    const char *key, *path, *text;
} files[] = {
    {"", "s.yaml", scene},
    {"bodies[1].rod.table", "rod.yaml",
     "length: 5\nstations:\n- {span: 0, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}\n"
     "- {span: 5, stiffness: [1, 1, 1, 1, 1, 1], mass: [1, 0, 0, 1, 1, 0]}\n"},
    {"bodies[3].fmu.folder", "damper/modelDescription.xml", FMU},
    {"bodies[3].fmu.folder", "damper/resources/oil.txt", "warm\n"},
    {"aero.wind.file", "wind.bts", "gusts\n"},
    {"aero.blade", "aero.yaml",
     "stations:\n- {span: 0, chord: 1, polar: p}\n- {span: 5, chord: 1, polar: p}\n"},
    {"aero.polars", "polars.yaml",
     "polars:\n- name: p\n  table: {columns: [alpha deg, cl, cd, cm], rows: [[-180, 0, 0, 0], "
     "[180, 0, 0, 0]]}\n"},
    {"control.library", "control/law.so", "code\n"},
    {"control.input", "control/law.in", "100 ! gain\n\"../tables/Cp.txt\" ! a table, not Ct.txt\n"},
    {"control.input", "control/../tables/Cp.txt", "0.4 0.5\n"},
};
enum { FILES = sizeof files / sizeof *files };

static int enter_files(void **state) {
    if (enter(state) != 0) return -1;
    const char *const folders[] = {"damper", "damper/resources", "control", "tables"};
    for (int k = 0; k < 4; k++) {
        if (mkdir(folders[k], 0755) != 0) return -1;
    }
    for (int k = 0; k < FILES; k++) write_file(files[k].path, files[k].text);
    write_file("tables/Ct.txt", "named by nobody beside the input\n");
    return 0;
}

static uint64_t fingerprint(const bough_scene *s, bough_arena *arena) {
    uint64_t sum = BOUGH_FINGERPRINT_START;
    bough_mix_scene(&sum, &(bough_file_sums){.arena = arena}, s);
    return sum;
}

TEST(every_key_that_names_a_file_is_in_the_list) {
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_string_equal(f.printed, "");
    bough_scene_files list = bough_scene_list_files(f.arena, f.scene);
    assert_int_equal(list.n, FILES);
    for (int k = 0; k < FILES; k++) {
        int i = 0;
        while (i < list.n && strcmp(list.item[i].path, files[k].path) != 0) i++;
        if (i == list.n) print_message("not in the list: %s\n", files[k].path);
        assert_true(i < list.n);
        assert_string_equal(list.item[i].key, files[k].key);
        assert_false(list.item[i].absolute);
    }
    assert_string_equal(list.item[0].path, "s.yaml");
}

TEST(the_fingerprint_changes_with_each_file) {
    fixture f = read_scene("s.yaml", NULL, 0);
    assert_non_null(f.scene);
    uint64_t before = fingerprint(f.scene, f.arena);
    assert_true(before == fingerprint(f.scene, f.arena));
    for (int k = 0; k < FILES; k++) {
        char other[4096];
        snprintf(other, sizeof other, "%s# more\n", files[k].text);
        write_file(files[k].path, other);
        if (fingerprint(f.scene, f.arena) == before) fail_msg("%s has no effect", files[k].path);
        write_file(files[k].path, files[k].text);
        assert_true(fingerprint(f.scene, f.arena) == before);
    }
}

// A sum is taken once for all scenes that share it.
TEST(a_shared_file_is_read_once) {
    fixture f = read_scene("s.yaml", NULL, 0);
    bough_file_sums sums = {.arena = f.arena};
    uint64_t first = BOUGH_FINGERPRINT_START, second = BOUGH_FINGERPRINT_START;
    bough_mix_scene(&first, &sums, f.scene);
    write_file("wind.bts", "other gusts\n");
    bough_mix_scene(&second, &sums, f.scene);
    assert_true(first == second);
    assert_true(first != fingerprint(f.scene, f.arena));
    write_file("wind.bts", "gusts\n");
}

TEST(a_path_from_the_root_is_known_as_one) {
    char law[600], text[700];
    snprintf(law, sizeof law, "%s/control/law.so", (const char *)*context);
    snprintf(text, sizeof text, "control.library=%s", law);
    fixture f = read_scene("s.yaml", (const char *const[]){text}, 1);
    bough_scene_files list = bough_scene_list_files(f.arena, f.scene);
    int absolute = 0;
    for (int k = 0; k < list.n; k++) absolute += list.item[k].absolute && strcmp(list.item[k].path, law) == 0;
    assert_int_equal(absolute, 1);
}

// -- scenes that share files ----------------------------------------------------------------------

static const char two_polars[] =
    "polars:\n- {name: q, table: &t {columns: [alpha deg, cl, cd, cm], rows: [[-180, 0, 0, 0], "
    "[180, 0, 0, 0]]}}\n- {name: p, table: *t}\n";

static bough_scene *read_shared(bough_schema_shared *shared, const char *set, bough_errors *errors) {
    bough_scene *scene_read;
    bough_scene_read(shared->arena, shared, "s.yaml", &set, 1, errors, &scene_read);
    return scene_read;
}

TEST(scenes_share_the_tables_of_a_file) {
    bough_schema_shared shared = {.arena = check_memory()};
    bough_errors errors = {.arena = shared.arena};
    const bough_scene *a = read_shared(&shared, "gravity=[0, 0, 0]", &errors);
    write_file("rod.yaml", "no table\n");
    shared.complete = true;
    const bough_scene *b = read_shared(&shared, "gravity=[0, 0, 1]", &errors);
    write_file("rod.yaml", files[1].text);
    assert_non_null(b);
    assert_ptr_equal(a->body[1].rod.structure.station, b->body[2].rod.structure.station);
    assert_ptr_equal(a->aero.polars.polar, b->aero.polars.polar);
    check_near(b->gravity[2], 1, 0, 0);
    assert_int_equal(bough_scene_list_files(shared.arena, b).n, FILES);
}

// A station's polar has another place in each scene's list of polars.
TEST(scenes_link_shared_stations_to_polars_of_their_own) {
    bough_schema_shared shared = {.arena = check_memory()};
    bough_errors errors = {.arena = shared.arena};
    write_file("two.yaml", two_polars);
    const bough_scene *a = read_shared(&shared, "aero.polars=polars.yaml", &errors);
    const bough_scene *b = read_shared(&shared, "aero.polars=two.yaml", &errors);
    assert_int_equal(a->aero.blade.station[1].def.polar, 0);
    assert_int_equal(b->aero.blade.station[1].def.polar, 1);
}

TEST(every_scene_reports_the_errors_of_a_shared_file) {
    bough_schema_shared shared = {.arena = check_memory()};
    write_file("rod.yaml", "length: 5\nstations: []\n");
    for (int k = 0; k < 3; k++) {
        bough_errors errors = {.arena = shared.arena};
        assert_null(read_shared(&shared, "gravity=[0, 0, 0]", &errors));
        assert_string_equal(printed_errors(&errors),
                            "rod.yaml:2:11: error: stations: expected at least 1 item, got 0\n");
    }
    write_file("rod.yaml", files[1].text);
}

GROUP(enter_files, leave)
