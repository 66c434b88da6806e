// Turbines of the WindIO ontology as scenes: the numbers, by hand; both layouts the same scene;
// the messages for bad files; that a scene runs.
#include "tests/unit/import.h"

// Imports a deck with a text replaced (NULL: none).
static trial attempt_given(const char *deck, const edit *change, const bough_import_options *options) {
    trial t = begin_trial();
    char path[SCRATCH_PATH];
    copy_deck(t.folder, deck, change, NULL);
    snprintf(path, sizeof path, "%s/%s", t.folder, deck);
    t.status = bough_import_windio(path, t.out, options, NULL);
    return t;
}

static trial attempt(const char *deck, const edit *change) {
    return attempt_given(deck, change, &(bough_import_options){0});
}

static trial import_given(const char *deck, const edit *change, const bough_import_options *options) {
    return imported(attempt_given(deck, change, options));
}

static trial import_of(const char *deck, const edit *change) {
    return import_given(deck, change, &(bough_import_options){0});
}

static trial import_with(const char *from, const char *to) {
    return import_of("turbine-1.yaml", &(edit){"turbine-1.yaml", from, to});
}

// The line is 5.0002 m and 5.0160 m long, its stations are those of line, stiffness and inertia.
TEST(blade_keeps_line_and_matrices) {
    trial t = import_of("turbine-1.yaml", NULL);
    const bough_node *blade = read_file(&t, "blade-structure.yaml");
    const bough_node *rows = at(blade, "stations.rows");
    assert_int_equal(rows->n, 3);
    check_near(number(blade, "length"), 10, 1e-9, 0);
    check_near(number(rows, "0.1"), 0.2 * 180 / acos(-1.0), 1e-9, 0);
    check_near(number(rows, "1.0"), 5, 1e-9, 0);
    check_near(number(rows, "1.2.1"), 0.05, 1e-9, 0);
    check_near(number(rows, "2.2.0"), -0.4, 1e-9, 0);
    const double stiffness[21] = {5e7, 0,   0, 0, 0,   0,   6e7, 0,   0, 0,  0,
                                  4e8, 1e6, 0, 0, 3e7, 2e5, 0,   2e7, 0, 9e6};
    const double mass[] = {60, 0.05, 0.1, 5, 4, -0.5, 9};
    char path[16];
    for (int i = 0; i < 21; i++) {
        snprintf(path, sizeof path, "0.3.%d", i);
        check_near(number(rows, path), stiffness[i], 1e-9, 0);
    }
    for (int i = 0; i < 7; i++) {
        snprintf(path, sizeof path, "0.4.%d", i);
        check_near(number(rows, path), mass[i], 1e-9, 0);
    }
    check_near(number(rows, "1.3.11"), 2.2e8, 1e-9, 0); // halfway
    assert_int_equal(at(rows, "2.3")->n, 6);
    double half = sqrt(25 + 0.0025), end = sqrt(25 + 0.0025 + 0.16);
    char words[40];
    snprintf(words, sizeof words, "it weighs %.7g kg", 50 * half + 25 * end);
    assert_true(list_says(&t, words));
}

// Rings of 2 m and 1 m; the axis of an element stands at its share of the chord before the centre.
TEST(tower_and_elements_are_those_of_the_file) {
    trial t = import_of("turbine-1.yaml", NULL);
    const bough_node *rows_of = at(read_file(&t, "tower-structure.yaml"), "stations.rows"),
                     *foot = rows_of->value[0];
    assert_int_equal(rows_of->n, 3); // the diameter has one more than the height
    double pi = acos(-1.0), area = pi / 4 * (4 - 1.96 * 1.96), second = pi / 64 * (16 - pow(1.96, 4));
    check_near(number(foot, "2.2"), 2e11 * area, 1e-9, 0);
    check_near(number(foot, "2.0"), 8e10 * area / 2, 1e-9, 0);
    check_near(number(foot, "2.3"), 2e11 * second, 1e-9, 0);
    check_near(number(foot, "2.5"), 2 * 8e10 * second, 1e-9, 0);
    check_near(number(foot, "3.0"), 1.1 * 8000 * area, 1e-9, 0);
    check_near(number(foot, "3.3"), 1.1 * 8000 * second, 1e-9, 0);
    const bough_node *element = at(read_file(&t, "blade-aero.yaml"), "stations.rows");
    double back = 0.375 - 0.475; // half of either airfoil, on a chord of 1 m
    check_near(number(element, "1.1"), back * sin(0.18), 1e-9, 0);
    check_near(number(element, "1.2"), 0.01 + back * cos(0.18), 1e-9, 0);
    assert_string_equal(text(element, "1.5"), "1-round");
    assert_string_equal(text(element, "1.6"), "2-flat");
    check_near(number(element, "1.7"), 0.5, 1e-9, 0);
    check_near(number(element, "2.7"), 0, 1e-9, 0);
    const bough_node *rows = at(read_file(&t, "airfoils.yaml"), "polars.1.table.rows");
    assert_int_equal(rows->n, 5); // the angles of all three coefficients
    check_near(number(rows, "0.0"), -180, 1e-9, 0);
    check_near(number(rows, "1.1"), -1, 1e-9, 0);
    check_near(number(rows, "2.1"), 0, 1e-9, 1e-9);
    check_near(number(rows, "2.2"), 0.01, 1e-9, 0);
    check_near(number(rows, "2.3"), 0.02, 1e-9, 0);
}

TEST(turbine_has_the_files_values) {
    trial t = import_of("turbine-1.yaml", NULL);
    const bough_node *s = read_file(&t, "scene.yaml");
    char words[40];
    assert_string_equal(text(s, "bodies.0.joint.placement.0"), "move z 2 m");
    check_near(number(s, "bodies.1.centre_of_mass.2"), 8.0 / 9, 1e-9, 0); // with the yaw bearing
    check_near(number(s, "bodies.1.inertia.1"), 5000 + 8000.0 / 9 * 1.25, 1e-9, 0);
    check_near(number(s, "bodies.1.inertia.4"), -8000.0 / 9 * 0.5, 1e-9, 0);
    assert_string_equal(text(s, "bodies.2.joint.placement.1"), "move x -2 m");
    snprintf(words, sizeof words, "rotate y %.10g deg", 18 / acos(-1.0));
    assert_string_equal(text(s, "bodies.2.joint.placement.2"), words);
    check_near(number(s, "bodies.2.joint.speed"), 0.75 * 3, 1e-9, 0);
    snprintf(words, sizeof words, "rotate y %.10g deg", -9 / acos(-1.0));
    assert_string_equal(text(s, "bodies.4.joint.placement.1"), words);
    check_near(number(s, "bodies.5.pitch"), 3.6 / acos(-1.0), 1e-9, 0);
    check_near(number(s, "bodies.5.rod.segments"), 24, 0, 0);
    check_near(number(s, "bodies.5.rod.grading"), 0.2, 0, 0);
    check_near(number(s, "aero.wind.speed"), 0.75 * 3 * 11 * cos(0.05) / 7, 1e-5, 0);
    check_near(number(s, "control.law.rated_speed"), 0.99 * 30, 1e-9, 0);
    check_near(number(s, "control.law.reference_speed"), 30, 1e-9, 0);
    check_near(number(s, "control.law.rated_power"), 5e3 / 0.95, 1e-9, 0);
    check_near(number(s, "control.law.most_torque"), 1.1 * 5e3 / 0.95 / 29.7, 1e-9, 0);
    assert_string_equal(text(s, "control.pitch"), "false"); // the file has no gains
    assert_true(list_says(&t, "pitch control: the file has no gains, so the pitch is held"));
    check_near(number(s, "control.law.most_pitch"), 1.5, 1e-9, 0);
    check_near(number(s, "control.law.pitch_rate"), 0.1, 1e-9, 0);
    assert_string_equal(text(s, "bodies.3.joint.kind"), "revolute");
    t = import_with("control:", "environment: {air_density: 1.1, shear_exp: 0.1}\ncontrol:");
    s = read_file(&t, "scene.yaml");
    check_near(number(s, "aero.air_density"), 1.1, 1e-9, 0);
    assert_string_equal(text(s, "aero.wind.reference_height"), "21.5 m");
    t = import_with("rotor_orientation: Upwind", "rotor_orientation: Downwind");
    assert_string_equal(text(read_file(&t, "scene.yaml"), "bodies.2.joint.placement.1"), "move x 2 m");
}

// Words and numbers side by side.
static void same(const bough_node *a, const bough_node *b) {
    assert_int_equal(a->kind, b->kind);
    assert_int_equal(a->n, b->n);
    for (int i = 0; i < a->n; i++) same(a->value[i], b->value[i]);
    if (a->kind != BOUGH_SCALAR) return;
    char *rest_a, *rest_b;
    double x = strtod(a->text, &rest_a), y = strtod(b->text, &rest_b);
    check_near(x, y, 1e-8, 1e-9);
    assert_string_equal(rest_a, rest_b);
}

TEST(both_layouts_give_one_scene) {
    trial first = import_of("turbine-1.yaml", NULL), second = import_of("turbine-2.yaml", NULL);
    for (int i = 0; i < N_RESULT; i++) same(read_file(&first, results[i]), read_file(&second, results[i]));
    assert_true(list_says(&second, "the layout of version 2"));
    // the nacelle's inertia about its own centre and about the tower's top
    second = import_of("turbine-2.yaml", &(edit){"turbine-2.yaml", "[12000, 15000, 8000, 0, -4000, 0]",
                                                 "[4000, 5000, 6000]\n      inertia_tt: [12000]"});
    same(read_file(&first, "scene.yaml"), read_file(&second, "scene.yaml"));
}

TEST(what_is_not_given_is_noted) {
    trial t =
        import_of("turbine-2.yaml",
                  &(edit){"turbine-2.yaml", "efficiency: 0.95}",
                          "efficiency: 0.95}\n    generator: {elastic_properties: {inertia: [3, 1, 1]}}"});
    const bough_node *s = read_file(&t, "scene.yaml"); // the generator by itself, for the shaft's torque
    assert_string_equal(text(s, "turbine.rotor"), "generator");
    assert_string_equal(text(s, "bodies.3.joint.parent"), "generator");
    check_near(number(s, "bodies.2.inertia.0"), 3 * 100, 1e-9, 0);
    check_near(number(s, "bodies.3.inertia.0"), 900, 1e-9, 0);
    t = import_with("      layers:", "      other:");
    assert_true(list_says(&t, "no layers, so it is rigid"));
    assert_string_equal(text(read_file(&t, "scene.yaml"), "bodies.0.name"), "nacelle");
    assert_string_equal(text(read_file(&t, "scene.yaml"), "bodies.0.joint.placement.0"), "move z 20 m");
    t = import_with("  rated_power", "  other");
    assert_true(list_says(&t, "no rated_power: no torque"));
    assert_null(bough_node_find(read_file(&t, "scene.yaml"), "control"));
    assert_string_equal(text(read_file(&t, "scene.yaml"), "bodies.3.joint.kind"), "fixed");
    t = import_with("values: [0.02, 0.02]", "values: [0.02, -0.01]");
    assert_true(list_says(&t, "deg; the value at 180 deg is the mean of its ends"));
    check_near(number(read_file(&t, "airfoils.yaml"), "polars.1.table.rows.0.3"), 5e-3, 1e-9, 0);
    t = import_of("turbine-2.yaml",
                  &(edit){"turbine-2.yaml", "mu: [0, 0, 0, 0, 0, 0]", "mu: [1.e-3, 0, 0, 0, 4.e-3, 0]"});
    check_near(number(read_file(&t, "blade-structure.yaml"), "damping.4"), 4e-3, 1e-9, 0);
}

// Masses that the file lacks come from the user, not from other turbines.
TEST(missing_masses_are_asked_for) {
    const edit hub = {"turbine-1.yaml", "    elastic_properties_mb: {system_mass: 3000",
                      "    other: {a: 3000"};
    const edit nacelle = {"turbine-2.yaml", "    elastic_properties:\n      mass: 8000",
                          "    other:\n      mass: 8000"};
    check_refused(attempt("turbine-1.yaml", &hub), BOUGH_INVALID,
                  ": expected the mass of the hub, 'elastic_properties.mass'; --hub-mass KG");
    trial t = import_given("turbine-1.yaml", &hub, &(bough_import_options){.hub_mass = 2500});
    check_near(number(read_file(&t, "scene.yaml"), "bodies.2.mass"), 2500, 1e-9, 0);
    check_near(number(read_file(&t, "scene.yaml"), "bodies.2.inertia.0"), 2. / 3 * 2500, 1e-9, 0);
    check_refused(attempt("turbine-2.yaml", &nacelle), BOUGH_INVALID, ": expected the mass of the nacelle");
    t = import_given("turbine-1.yaml", NULL, &(bough_import_options){.hub_mass = 2500, .nacelle_mass = 9000});
    check_near(number(read_file(&t, "scene.yaml"), "bodies.2.mass"), 3000, 1e-9, 0);
    assert_true(list_says(&t, "--hub-mass: the file has the mass of the hub"));
    assert_true(list_says(&t, "--nacelle-mass: the file has the mass of the nacelle"));
    t = import_given("turbine-2.yaml", &nacelle, &(bough_import_options){.nacelle_mass = 9000});
    check_near(number(read_file(&t, "scene.yaml"), "bodies.1.mass"), 9000 + 1000, 1e-9, 0);
}

// Matrices of a blade without shear have zeros for it.
TEST(no_shear_is_stiff) {
    trial t =
        import_of("turbine-2.yaml", &(edit){"turbine-2.yaml", "K11: [50000000, 5000000]", "K11: [0, 0]"});
    assert_true(list_says(&t, "shear stiffness of zero (K11, K22)"));
    const bough_node *rows = at(read_file(&t, "blade-structure.yaml"), "stations.rows");
    check_near(number(rows, "0.3.0"), 4e8, 1e-9, 0);
    check_near(number(rows, "0.3.6"), 6e7, 1e-9, 0);
    check_near(number(rows, "2.3.0"), 4e7, 1e-9, 0);
}

// The names of version 1 in a file of version 2, which has degrees and rpm; of two limits of the speed the
// lower one counts.
TEST(units_are_those_of_the_layout) {
    trial t = import_of("turbine-2.yaml", &(edit){"turbine-2.yaml", "  rated_rotor_speed: 28.64788975654116",
                                                  "  supervisory: {maxTS: 16}\n  torque: {VS_maxspd: 20}\n"
                                                  "  pitch: {max_pitch: 80, max_pitch_rate: 3}"});
    const bough_node *s = read_file(&t, "scene.yaml");
    double degree = acos(-1.0) / 180, radius = 11 * cos(2.8647889756541165 * degree);
    check_near(number(s, "control.law.reference_speed"), 10 * 16 / radius, 1e-9, 0);
    check_near(number(s, "control.law.most_pitch"), 80 * degree, 1e-9, 0);
    check_near(number(s, "control.law.pitch_rate"), 3 * degree, 1e-9, 0);
    t = import_of("turbine-2.yaml", &(edit){"turbine-2.yaml", "  rated_rotor_speed: 28.64788975654116",
                                            "  torque: {VS_maxspd: 20}"});
    check_near(number(read_file(&t, "scene.yaml"), "control.law.reference_speed"), 10 * 120 * degree, 1e-9,
               0);
}

// The nacelle is what the whole rotor-nacelle assembly weighs beyond hub and blades.
TEST(assembly_gives_the_nacelle) {
    trial t = import_with("      elastic_properties_mb:\n        system_mass: 8000\n"
                          "        system_inertia: [4000, 5000, 6000]\n"
                          "        system_center_mass: [0.5, 0, 1]\n        yaw_mass: 1000\n",
                          "  RNA: {elastic_properties_mb: {mass: 20000, center_mass: [-0.5, 0, 1.2]}}\n");
    const bough_node *nacelle = at(read_file(&t, "scene.yaml"), "bodies.1");
    double head = 3000 + 3 * (50 * sqrt(25.0025) + 25 * sqrt(25.1625)), mass = 20000 - head;
    check_near(number(nacelle, "mass"), mass, 1e-9, 0);
    check_near(number(nacelle, "centre_of_mass.0"), (-0.5 * 20000 + 2 * head) / mass, 1e-8, 0);
    check_near(number(nacelle, "centre_of_mass.2"), (1.2 * 20000 - 1.5 * head) / mass, 1e-8, 0);
    check_near(number(nacelle, "inertia.0"), mass * 4 / 4, 1e-9, 0);
}

TEST(any_number_of_blades_is_taken) {
    trial t = import_with("number_of_blades: 3", "number_of_blades: 5");
    const bough_node *s = read_file(&t, "scene.yaml");
    assert_string_equal(text(s, "turbine.blades.4"), "blade5");
    assert_string_equal(text(s, "bodies.7.joint.placement.0"), "rotate x 288 deg");
}

TEST(polars_go_round) {
    trial t = import_with("[-3.14, -0.5, 0.5, 3.14]", "[-1.5, -0.5, 0.5, 1.5]");
    assert_true(list_says(&t, "from -85.9437 to 85.9437 deg, constant beyond"));
}

TEST(scene_steps) {
    trial t = import_of("turbine-1.yaml", NULL);
    check_near(steps(&t, 4), 67.5 / acos(-1.0), 0.05, 0); // torque acts before there is wind
}

TEST(bad_files_are_reported_with_their_place) {
    const struct {
        const char *from, *to, *says;
    } bad[] = {
        {"components:", "parts:", "turbine-1.yaml:2:1: expected a key 'components' here"},
        {"    elastic_properties_mb:\n      six", "    other:\n      six",
         "turbine-1.yaml:11:5: expected stiffness and inertia of the blade: 'elastic_"},
        {"chord: {grid", "cord: {grid", "turbine-1.yaml:12:7: expected a key 'chord' here"},
        {"values: [1.0, 1.0, 1.2, 0.4]", "values: [1.0, 1.0, 1.2]",
         "turbine-1.yaml:15:51: values: expected a list of 4 numbers"},
        {"values: [1.0, 1.0, 1.2, 0.4]", "values: [1.0, 1.0, 1.2, wide]",
         "turbine-1.yaml:15:67: values: expected a number, got 'wide'"},
        {"values: [1.0, 1.0, 1.2, 0.4]", "values: [1.0, 1.0, 1.2, 0.0]",
         "turbine-1.yaml:15:14: chord: expected a positive value"},
        {"grid: [0.0, 0.1, 0.5, 1.0]", "grid: [0.0, 0.6, 0.5, 1.0]",
         "turbine-1.yaml:15:14: grid: expected increasing numbers, but number 3 is not larger than the one before"},
        {"values: [0.2, 0.0]", "values: [11.5, 0.0]",
         "twist: expected angles up to 1.5708 rad, as version 1 has them, got 11.5"},
        {"values: [0.0, 10.0]", "values: [0.0, 0.0]", "reference_axis.z: expected increasing values, but"},
        {"labels: [round, flat, flat]", "labels: [round, flat, steep]",
         "turbine-1.yaml:14:31: no airfoil is named 'steep'"},
        {"labels: [round, flat, flat]", "labels: [round, flat]", "labels: expected 3 names"},
        {"            - [5.e+6, 0, 0,", "            - [5.e+6, 0,",
         "turbine-1.yaml:32:15: expected a list of 21 numbers"},
        {"            - [5.e+7,", "            - [-5.e+7,",
         "at 0 of the span: expected stiffness and inertia"},
        {"[-3.14, -0.5, 0.5, 3.14]", "[-5.14, -0.5, 0.5, 3.14]",
         "grid: expected angles from -180 to 180 deg, got -294.5"},
        {"material: steel", "material: wood", "material: no material is named 'wood'"},
        {"values: [0.02, 0.01]", "values: [1.02, 0.01]", "thickness: expected a value from 0 to the"},
        {"diameter: 2.0", "diameter: 0", "diameter: expected a positive value"},
        {"number_of_blades: 3", "number_of_blades: 2.5",
         "number_of_blades: expected a whole number from 1 to 16, got 2.5"},
        {"gear_ratio: 10", "gear_ratio: 10\n      gear_ratio: 10", "is given twice"},
        {"gear_ratio: 10", "gear_ratio: -1", "gear_ratio: expected a positive value"},
        {"[4000, 5000, 6000]", "[0, 0, 0, 0, 0, 6000]",
         "inertia: expected xx, yy, zz, xy, xz, yz of a matrix"},
        {"VS_maxspd", "VS_other", "control: expected the rotor's rated speed, 'torque.VS_maxspd' or"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const edit change = {"turbine-1.yaml", bad[i].from, bad[i].to};
        check_refused(attempt("turbine-1.yaml", &change), BOUGH_INVALID, bad[i].says);
    }
}
