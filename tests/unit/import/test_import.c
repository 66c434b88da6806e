// Decks of OpenFAST as scenes: the numbers, by hand; the messages for bad decks; that a scene runs.
#include "tests/unit/import_deck.h"

#include "apps/bough/import/draft.h"
#include "apps/bough/import/section.h"

// A reference line of 5 m along z and 5 m on a slope of 3 to 4; a station at 6.25 m of it.
TEST(beamdyn_stations_keep_line_and_matrices) {
    trial t = import(NULL);
    const bough_node *blade = read_file(&t, "blade-structure.yaml");
    const bough_node *rows = at(blade, "stations.rows");
    assert_int_equal(rows->n, 3);
    check_near(number(blade, "length"), 9, 1e-9, 0);
    check_near(number(blade, "damping.4"), 5e-3, 1e-9, 0);
    check_near(number(rows, "1.0"), 6, 1e-9, 0);      // span
    check_near(number(rows, "1.1"), 5, 1e-9, 0);      // twist
    check_near(number(rows, "1.2.0"), 0.75, 1e-9, 0); // axis
    assert_int_equal(at(rows, "0.3")->n, 21);
    assert_int_equal(at(rows, "1.3")->n, 6);
    check_near(number(rows, "0.3.15"), 9e6, 1e-9, 0); // bend about x …
    check_near(number(rows, "0.3.17"), 1e5, 1e-9, 0); // … and its coupling with twist
    const double mass[] = {40, 0.2, 0.1, 0.9, 2.5, -0.3, 3.4};
    for (int i = 0; i < 7; i++) {
        char path[16];
        snprintf(path, sizeof path, "0.4.%d", i);
        check_near(number(rows, path), mass[i], 1e-9, 0);
    }
}

TEST(turbine_has_the_decks_values) {
    trial t = import(NULL);
    const bough_node *s = read_file(&t, "scene.yaml");
    check_near(number(s, "gravity.2"), -9.81, 1e-9, 0);
    check_near(number(s, "simulation.duration"), 3.02, 1e-9, 0); // whole macro steps
    check_near(number(s, "bodies.1.joint.stiffness"), 5e7, 1e-9, 0);
    check_near(number(s, "bodies.1.inertia.2"), 6000 - 8000 * 0.25, 1e-9, 0);
    assert_string_equal(text(s, "bodies.2.name"), "generator");
    assert_string_equal(text(s, "bodies.2.joint.placement.1"), "rotate y 6 deg");
    assert_string_equal(text(s, "bodies.2.joint.placement.2"), "move x -2.5 m");
    assert_string_equal(text(s, "bodies.2.joint.speed"), "20 rpm");
    check_near(number(s, "bodies.2.inertia.0"), 2 * 900, 1e-9, 0);
    assert_string_equal(text(s, "bodies.3.joint.parent"), "generator");
    check_near(number(s, "bodies.3.joint.stiffness"), 1e7, 1e-9, 0);
    check_near(number(s, "bodies.3.joint.damping"), 2e4, 1e-9, 0);
    check_near(number(s, "bodies.3.inertia.0"), 600, 1e-9, 0);
    assert_string_equal(text(s, "bodies.5.joint.placement.0"), "rotate x 120 deg");
    assert_string_equal(text(s, "bodies.6.pitch"), "5.5 deg");
    assert_string_equal(text(s, "turbine.rotor"), "generator");
    assert_string_equal(text(s, "aero.wind.kind"), "power");
    assert_string_equal(text(s, "aero.wind.direction"), "-15 deg");
    check_near(number(s, "aero.air_density"), 1.2, 1e-9, 0);
    assert_string_equal(text(s, "aero.induction.hub_loss"), "false");
    assert_string_equal(text(s, "aero.induction.inflow_time"), "2.5 s");
    assert_string_equal(text(s, "aero.dynamic_stall"), "hgm");
    assert_string_equal(text(s, "aero.pitching_moment"), "false");
    check_near(number(s, "aero.tower.drag.1"), 0.8, 1e-9, 0);
    check_near(number(s, "control.law.optimal_gain"), 0.0004 * pow(30 / acos(-1.0), 2), 1e-9, 0);
    assert_string_equal(text(s, "control.law.above_rated"), "torque");
    assert_true(list_says(&t, "spring and damper between hub and generator"));
}

TEST(blades_have_shorter_segments_towards_the_tip) {
    trial t = import(NULL);
    const bough_node *s = read_file(&t, "scene.yaml");
    check_near(number(s, "bodies.4.rod.segments"), 24, 0, 0);
    check_near(number(s, "bodies.6.rod.segments"), 24, 0, 0);
    check_near(number(s, "bodies.6.rod.grading"), 0.2, 0, 0);
}

TEST(air_tables_follow_their_headers) {
    trial t = import(NULL);
    const bough_node *blade = at(read_file(&t, "blade-aero.yaml"), "stations.rows");
    check_near(number(blade, "1.4"), 1.0, 1e-9, 0); // the chord stands behind the airfoil
    check_near(number(blade, "1.2"), -0.2, 1e-9, 0);
    const bough_node *polars = at(read_file(&t, "airfoils.yaml"), "polars");
    assert_int_equal(polars->n, 2);
    assert_string_equal(text(blade, "2.5"), text(polars, "1.name"));
    check_near(number(polars, "1.table.rows.2.0"), -10, 1e-9, 0);
    check_near(number(polars, "1.table.rows.2.1"), -0.9, 1e-9, 0);
}

// BEM_Mod 1 has Buhl's high thrust; decks that do not say which get a note.
TEST(high_thrust_is_the_decks) {
    trial t = import_main("v5/main.fst", &(edit){"v5/aero.dat", "2   BEM_Mod", "1   BEM_Mod"}, NULL);
    assert_string_equal(text(read_file(&t, "scene.yaml"), "aero.induction.high_thrust"), "buhl");
    assert_true(list_says(&t, "BEM_Mod 1"));
    t = import_main("v5/main.fst", NULL, NULL);
    assert_string_equal(text(read_file(&t, "scene.yaml"), "aero.induction.high_thrust"), "smooth");
    assert_false(list_says(&t, "BEM_Mod"));
}

// With the shape x² of a uniform blade ω² = 20 E I/(m l⁴), of the tower, without what it
// carries, 4 E I/l³/(m l/5).
TEST(elastodyn_structure_is_scaled_and_damped) {
    trial t = import(&by_modes);
    const bough_node *blade = read_file(&t, "blade-structure.yaml");
    check_near(number(blade, "length"), 9, 1e-9, 0);
    check_near(number(blade, "stations.rows.0.3.0"), 44, 1e-9, 0);
    check_near(number(blade, "stations.rows.1.2.4"), 8e6, 1e-9, 0); // flap is about y
    check_near(number(blade, "stations.rows.1.2.3"), 9e6, 1e-9, 0);
    check_near(number(blade, "damping.4"), 2 * 0.015 / sqrt(20 * 8e6 / (44 * 6561.0)), 1e-4, 0);
    check_near(number(blade, "damping.3"), 2 * 0.005 / sqrt(20 * 9e6 / (44 * 6561.0)), 1e-4, 0);
    const bough_node *tower = read_file(&t, "tower-structure.yaml");
    double omega2 = 4 * 2e9 / 8000 / (500 * 20 / 5.0);
    check_near(number(tower, "damping.4"), 2 * 0.01 / sqrt(omega2), 1e-4, 0);
    check_near(number(tower, "damping.3"), 2 * 0.02 / sqrt(omega2), 1e-4, 0);
    assert_true(list_says(&t, "no torsion"));
    // ElastoDyn does not use the torsional stiffness of older decks either
    trial older = import_with(&by_modes, &(edit){"parts/blade.dat", "PitchAxis", "GJStff"});
    check_same_file(&t, &older, "blade-structure.yaml");
}

// A tuner of the first mode acts as the factor of the table does.
TEST(tuners_scale_the_stiffness) {
    static const edit scaled = {"parts/blade.dat", "2   AdjFlSt", "1 AdjFlSt\n2 FlStTunr(1)\n3 FlStTunr(2)"};
    trial one = import(&by_modes), two = import_with(&by_modes, &scaled);
    check_same_file(&one, &two, "blade-structure.yaml");
    assert_true(list_says(&two, "FlStTunr(2): that of the first mode is used"));
    trial t = import(&(edit){"parts/tower.dat", "1   TwrFADmp(1)",
                             "2 FAStTunr(1)\n2 FAStTunr(2)\n0.5 SSStTunr(1)\n1 TwrFADmp(1)"});
    const bough_node *row = at(read_file(&t, "tower-structure.yaml"), "stations.rows.0");
    check_near(number(row, "2.4"), 4e9, 1e-9, 0); // fore-aft is about y
    check_near(number(row, "2.3"), 1e9, 1e-9, 0);
    assert_false(list_says(&t, "FAStTunr"));
}

TEST(newer_names_are_known) {
    trial t = import(&(edit){"parts/aero.dat", "2   WakeMod ", "0   Wake_Mod"});
    assert_true(list_says(&t, "WakeMod 0"));
    t = import(&(edit){"parts/aero.dat", "2   SkewMod ", "0   Skew_Mod"});
    assert_string_equal(text(read_file(&t, "scene.yaml"), "aero.induction.skew"), "none");
}

// The same turbine in the files of versions 3, 4 and 5, blades by BeamDyn and by ElastoDyn.
TEST(versions_three_to_five_give_one_scene) {
    static const char *const newer[] = {"v4/main.fst", "v5/main.fst"};
    for (int elastic = 1; elastic <= 2; elastic++) {
        char value[32];
        snprintf(value, sizeof value, "%d    CompElast", elastic);
        trial old = import(&(edit){"main.fst", "2    CompElast", value});
        for (int i = 0; i < 2; i++) {
            trial t = import_main(newer[i], &(edit){newer[i], "2    CompElast", value}, NULL);
            for (int k = 0; k < N_RESULT; k++) check_same_file(&old, &t, results[k]);
            assert_false(list_says(&t, "undamped"));
        }
    }
}

TEST(what_version_five_adds_is_noted) {
    const edit modal = {"v5/beam-blade.dat", "1   damp_type", "2   damp_type"};
    const edit bearing = {"v5/elasto.dat", "False         PitchDOF", "True  PitchDOF"};
    trial t = import_main("v5/main.fst", &modal, &bearing);
    assert_true(list_says(&t, "edgewise mode's zeta 0.1 and 0.2"));
    const bough_node *times = at(read_file(&t, "blade-structure.yaml"), "damping");
    // flap is 4/9 as stiff as edge, so 2/3 as fast
    check_near(number(times, "4") / number(times, "3"), 0.5 * 1.5, 1e-9, 0);
    assert_true(list_says(&t, "PitchDOF: the pitch bearings are rigid"));
    const edit rotors = {"v5/main.fst", "1    NRotors", "2    NRotors"};
    check_refused(attempt("v5/main.fst", &rotors), BOUGH_INVALID, "NRotors: expected 1");
    const edit mirror = {"v5/main.fst", "F    MirrorRotor", "T    MirrorRotor"};
    check_refused(attempt("v5/main.fst", &mirror), BOUGH_INVALID, "main.fst:25: MirrorRotor: expected False");
    const edit redistribution = {"v5/aero.dat", "\"default\"     SkewRedistr_Mod", "0  SkewRedistr_Mod"};
    t = import_main("v5/main.fst", &redistribution, NULL);
    assert_string_equal(text(read_file(&t, "scene.yaml"), "aero.induction.skew"), "none");
}

// ω = 1.8751² √(E I/(m l⁴)); a wedge of constant width: 5.315 √(E I/(m l⁴)) with the root's values.
TEST(frequencies_are_those_of_beams) {
    const double span[] = {0, 3, 6}, same[] = {4, 4, 4}, mass[] = {9, 9, 9};
    check_near(bough_section_frequency(3, span, same, mass), 3.51602 * sqrt(4 / (9 * 1296.0)), 1e-4, 0);
    double x[41], stiffness[41], thin[41];
    for (int i = 0; i < 41; i++) {
        double left = 1 - 0.999 * i / 40;
        x[i] = 6.0 * i / 40;
        stiffness[i] = 4 * left * left * left;
        thin[i] = 9 * left;
    }
    check_near(bough_section_frequency(41, x, stiffness, thin), 5.315 * sqrt(4 / (9 * 1296.0)), 3e-3, 0);
}

static void a_scene_steps(const edit *one, const edit *two) {
    trial t = import_with(one, two);
    check_near(steps(&t, 4), 20, 0.2, 0);
}

TEST(scenes_step) {
    const edit stiff = {"parts/elasto.dat", "True          TwFADOF1", "False         TwFADOF1"};
    a_scene_steps(NULL, NULL);
    a_scene_steps(&stiff, &by_modes);
    a_scene_steps(&stiff, &(edit){"parts/servo.dat", "1   VSContrl", "0   VSContrl"});
    a_scene_steps(&stiff, &(edit){"parts/elasto.dat", "T             GenDOF", "F    GenDOF"});
    a_scene_steps(&stiff, &(edit){"main.fst", "2    CompAero", "0    CompAero"});
}

TEST(controller_libraries_and_wind_files_stay_in_place) {
    char line[512];
    snprintf(line, sizeof line,
             "5  VSContrl - library\n3  TPCOn\n5  PCMode - library\n\"%s\"  DLL_FileName\n"
             "\"parts\\in\"  DLL_InFile\n0  XContrl",
             BOUGH_SAMPLE_DISCON);
    const edit library = {"parts/servo.dat", "0   PCMode", line};
    const edit wind = {"parts/wind.dat", "1    WindType", "\"BOX.bts\"  FileName_BTS\n3    WindType"};
    trial t = import_with(&library, &wind);
    const bough_node *s = read_file(&t, "scene.yaml");
    assert_string_equal(text(s, "control.kind"), "bladed");
    assert_string_equal(text(s, "control.library"), BOUGH_SAMPLE_DISCON);
    assert_string_equal(text(s, "bodies.4.joint.kind"), "revolute");
    assert_true(list_says(&t, "TPCOn"));
    assert_string_equal(text(s, "aero.wind.kind"), "bts");
    assert_int_equal(text(s, "aero.wind.file")[0], '/');
    assert_non_null(strstr(text(s, "aero.wind.file"), "/parts/box.bts"));
    a_scene_steps(&library, &(edit){"parts/elasto.dat", "True          DrTrDOF", "F  DrTrDOF"});
}

static void put_library(char line[512], const char *input) {
    snprintf(line, 512, "5  VSContrl\n5  PCMode\n\"%s\"  DLL_FileName\n\"%s\"  DLL_InFile\n0  XContrl",
             BOUGH_SAMPLE_DISCON, input);
}

// Each trial is a process of its own, which calls the library from its first call on; after a failure it has
// a finer mesh, then smaller steps.
TEST(trials_call_the_library) {
    char line[512];
    const edit library = {"parts/servo.dat", "0   PCMode", line};
    put_library(line, "fifth"); // reports a failure in two trials, to the run and to its companion
    trial t = import(&library);
    assert_true(list_says(&t, "\ntried:\n  0.04 s in macro steps of 0.02 s with rtol 1e-3, steps of 0.02 s"));
    assert_true(list_says(&t, "\n  0.04 s in macro steps of 0.02 s with rtol 4.5e-4, steps of 0.01 s"));
    check_near(number(read_file(&t, "scene.yaml"), "simulation.master.rtol"), 4.5e-4, 1e-12, 0);
    check_near(number(read_file(&t, "scene.yaml"), "bodies.4.rod.segments"), 32, 0, 0);
    put_library(line, "refuse");
    check_refused(attempt("main.fst", &library), BOUGH_FAILED,
                  "cannot run, not even with macro steps of 0.02 s and rtol 1.5e-5: ");
    put_library(line, "crash");
    check_refused(attempt("main.fst", &library), BOUGH_INVALID,
                  BOUGH_SAMPLE_DISCON "' crashes in its first calls: Abort");
}

// Where no setting is good enough, the macro steps are halved, at most twice.
TEST(trials_shorten_the_macro_step) {
    char line[512];
    const edit library = {"parts/servo.dat", "0   PCMode", line};
    const bough_import_options judged = {.trial_steps = 2};
    put_library(line, "often");
    trial t = import_given("main.fst", &library, NULL, &judged);
    assert_true(list_says(&t, "in macro steps of 0.01 s with rtol "));
    check_near(number(read_file(&t, "scene.yaml"), "simulation.macro_step"), 0.01, 1e-12, 0);
    put_library(line, "refuse");
    check_refused(attempt_given("main.fst", &library, NULL, &judged), BOUGH_FAILED,
                  "macro steps of 0.005 s and rtol 1.5e-5: ");
    const edit fast = {"parts/elasto.dat", "20    RotSpeed", "188    RotSpeed"}; // from 2.5 ms on
    check_refused(attempt_given("main.fst", &library, &fast, &judged), BOUGH_FAILED,
                  "macro steps of 0.000625 s and rtol 1.5e-5: ");
}

static bough_status try_with(const trial *t, bough_scene *scene, double rtol, double bound, bool finer,
                             bool *by_air) {
    scene->simulation.master.rtol = rtol;
    return bough_import_trial(t->arena, scene, 10, bound, finer, by_air);
}

// Errors fall with the tolerance, so that some bound lies between those of two. Those of the mesh alone fail
// only where a finer one can be tried.
TEST(trials_judge_errors) {
    trial t = import(&(edit){"parts/servo.dat", "5E+07   YawSpr", "0   YawSpr"});
    char path[SCRATCH_PATH];
    snprintf(path, sizeof path, "%s/scene.yaml", t.out);
    bough_errors errors = {.arena = t.arena};
    bough_scene *scene;
    check_ok(bough_scene_read(t.arena, NULL, path, NULL, 0, &errors, &scene));
    scene->simulation.master.step = 0.01;
    bool by_air;
    check_ok(try_with(&t, scene, 1e-7, 4e-3, false, &by_air));
    check_fails(try_with(&t, scene, 1e-7, 4e-3, true, &by_air), BOUGH_FAILED, "errs by");
    for (int i = 0; i < scene->n_body; i++) scene->body[i].rod.n_segment = i == 0 ? 20 : 32;
    bough_status status = try_with(&t, scene, 1e-3, 0, false, &by_air);
    assert_string_equal(status.message, "");
    double bound = 1;
    do status = try_with(&t, scene, 1e-3, bound /= 4, false, &by_air);
    while (bound > 1e-9 && bough_is_ok(&status));
    check_fails(status, BOUGH_FAILED, "the error bound");
    assert_false(by_air);
    status = try_with(&t, scene, 1e-7, bound, false, &by_air);
    assert_string_equal(status.message, "");
    do status = try_with(&t, scene, 1e-7, bound /= 4, false, &by_air);
    while (bound > 1e-9 && bough_is_ok(&status));
    check_fails(status, BOUGH_FAILED, "the sampling of the air");
    assert_true(by_air);
}

// As the command does it: what it writes has been tried for 150 steps.
TEST(scenes_are_tried) {
    const edit wind = {"parts/wind.dat", "15    PropagationDir", "-30    PropagationDir"};
    trial t = import_given("main.fst", &wind, NULL, &(bough_import_options){.trial_steps = 150});
    assert_true(list_says(&t, "3 s in macro steps of 0.02 s with rtol "));
}

// The decks' titles begin as values do, "2 NumBl and 90 m TowerHt": every test here reads past them. Nor is
// there a value in the list of output channels, and of several numbers before a name the first counts.
TEST(lines_have_places_before_names) {
    const edit outputs = {"parts/servo.dat", "5E+07   YawSpr",
                          "5E+07   YawSpr\n1E+05 YawDamp\nOutList - channels\n12 YawNeut\nEND"};
    trial t = import(&outputs);
    assert_string_equal(text(read_file(&t, "scene.yaml"), "bodies.1.joint.rest"), "0 deg");
    trial base = import(NULL);
    t = import(&(edit){"parts/servo.dat", "1   VSContrl", "1,      5   VSContrl"});
    check_same_file(&base, &t, "scene.yaml");
}

TEST(bad_decks_are_reported_with_their_place) {
    const struct {
        edit change;
        const char *says;
    } bad[] = {
        {{"parts/elasto.dat", "20    RotSpeed", "2x    RotSpeed"},
         "elasto.dat:13: RotSpeed: expected a number, got '2x'"},
        {{"parts/elasto.dat", "HubRad", "HubRat"}, "no 'HubRad': expected a line 'number  HubRad'"},
        {{"main.fst", "2    CompElast", "3  NumBl\n1  ADAMSPrep"},
         "main.fst:7: expected a turbine's main file of OpenFAST, got a model of FAST 8.07 or older"},
        {{"parts/foils/flat.dat", "-0.9   -10.0   0.05", "-0.9   -10.0"},
         "flat.dat:7: a row of the polar: expected 3 numbers in the line, got 2"},
        {{"parts/elasto.dat", "30    GBRatio", "-97    GBRatio"},
         "elasto.dat:35: GBRatio: expected 0.001 to 10000, got -97"},
        {{"parts/elasto.dat", "2000    HubMass", "-2000    HubMass"},
         "elasto.dat:27: HubMass: expected 0 to 1e+09, got -2000"},
        {{"parts/servo.dat", "95   GenEff", "195   GenEff"},
         "servo.dat:5: GenEff: expected 0 to 100, got 195"},
        {{"parts/wind.dat", "12    HWindSpeed", "-1 HWindSpeed"},
         "wind.dat:6: HWindSpeed: expected 0 to 200, got -1"},
        {{"parts/elasto.dat", "3    NumBl", "40    NumBl"}, "elasto.dat:14: NumBl: expected a whole"},
        {{"parts/elasto.dat", "True          YawDOF", "Maybe         YawDOF"},
         "elasto.dat:7: YawDOF: expected True or False, got 'Maybe'"},
        {{"main.fst", "parts/wind.dat", "parts/wand.dat"}, "main.fst:17: cannot read"},
        {{"main.fst", "0    CompHydro", "1    CompHydro"}, "main.fst:10: CompHydro: expected 0"},
        {{"parts/wind.dat", "1    WindType", "4    WindType"}, "wind.dat:3: WindType 4: expected a line"},
        {{"parts/beam.dat", "kp_zr", "kp_z"}, "beam.dat: no table with the columns kp_xr"},
        {{"parts/beam.dat", "5.0     6.0", "nan     6.0"}, "beam.dat:10: kp_zr: expected a number"},
        {{"parts/beam.dat", "5.0     6.0", "9.5     6.0"}, "kp_zr: expected increasing values"},
        {{"parts/beam-blade.dat", "  0.625", "  1.625"}, "beam-blade.dat:24: the station is at 1.625"},
        {{"parts/beam-blade.dat", "3   station_total", "4   station_total"}, "the file ends"},
        {{"parts/aero-blade.dat", "6.0       2 ", "6.0       3 "}, "BlAFID: row 2: expected"},
        {{"parts/aero-blade.dat", "  3   NumBlNds", "  4   NumBlNds"}, "3 rows, expected 4"},
        {{"parts/foils/flat.dat", "-10.0", "-190.0"}, "flat.dat:7: alpha: expected"},
        {{"parts/aero-blade.dat", "2       1.0\n", "2       0.0\n"},
         "aero-blade.dat:3: BlChord: row 2: expected a positive chord"},
        {{"parts/servo.dat", "400   VS_RtTq", "4   VS_RtTq"}, "servo.dat:7: VS_RtGnSp"},
        {{"parts/servo.dat", "400   VS_RtTq", "1E9   VS_RtTq"},
         "servo.dat:7: the torque reaches its maximum of 1e+09 N m"},
        {{"main.fst", "2    CompAero", "1    CompAero"}, "main.fst:8: CompAero: expected 0 or 2"},
        {{"parts/elasto.dat", "True          YawDOF", "True Furling\nTrue YawDOF"},
         "elasto.dat:7: Furling: expected False"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        check_refused(attempt("main.fst", &bad[i].change), BOUGH_INVALID, bad[i].says);
    }
}
