// What public decks do differently: parts that are missing, tables that end early or late, other
// spellings, other generators. Each imports and steps, or is refused with its reason.
#include "tests/unit/import_deck.h"

static const bough_node *body(trial *t, const char *name) {
    const bough_node *list = at(read_file(t, "scene.yaml"), "bodies");
    for (int i = 0; i < list->n; i++) {
        if (strcmp(text(list->value[i], "name"), name) == 0) return list->value[i];
    }
    fail_msg("no body '%s'", name);
    return NULL;
}

// -- what is missing ------------------------------------------------------------------------------

TEST(missing_controller_leaves_the_speed) {
    const edit none = {"parts/servo.dat", "1   VSContrl   - simple",
                       "5   VSContrl\n\"none.dll\"  DLL_FileName"};
    trial t = import(&none);
    assert_true(list_says(&t, "a controller, to be given to the import by --controller FILE"));
    assert_string_equal(text(body(&t, "generator"), "joint.motion.speed"), "20 rpm");
    assert_null(bough_node_find(read_file(&t, "scene.yaml"), "control"));
    steps(&t, 2);
    bough_import_options given = {.controller = BOUGH_SAMPLE_DISCON};
    t = import_given("main.fst", &none, NULL, &given);
    assert_string_equal(text(read_file(&t, "scene.yaml"), "control.library"), BOUGH_SAMPLE_DISCON);
    assert_string_equal(text(body(&t, "blade1"), "joint.kind"), "revolute");
    given.controller = BOUGH_OTHER_LIBRARY;
    check_refused(attempt_given("main.fst", NULL, NULL, &given), BOUGH_INVALID,
                  "--controller: the controller");
}

// Without its motions a blade or tower is rigid, and its stiffness approximates nothing.
TEST(switched_off_motions_make_rigid_bodies) {
    trial t = import_with(&by_modes, &(edit){"parts/elasto.dat", "True          FlapDOF1", "F  FlapDOF1"});
    assert_string_equal(text(body(&t, "blade1"), "fidelity"), "rigid");
    assert_true(list_says(&t, "\n  FlapDOF1, FlapDOF2, EdgeDOF False: the blades are rigid\n"));
    assert_false(list_says(&t, "ElastoDyn's modes"));
    t = import(&by_modes);
    assert_true(list_says(&t, "\n  EdgeDOF False: the blade bends that way too\n"));
    t = import(&(edit){"parts/elasto.dat", "True          TwFADOF1", "F  TwFADOF1"});
    assert_true(list_says(&t, "\n  TwFADOF1, TwFADOF2, TwSSDOF1, TwSSDOF2 False: the tower is rigid\n"));
}

TEST(missing_wind_leaves_a_steady_one) {
    const edit none = {"parts/wind.dat", "1    WindType", "3    WindType\n\"none.bts\"  FileName_BTS"};
    trial t = import(&none);
    assert_true(
        list_says(&t, "NOT THE MODEL'S LOAD CASE, which also has:\n  its wind, to be given to the import by "
                      "--wind FILE (cannot open"));
    assert_string_equal(text(read_file(&t, "scene.yaml"), "aero.wind.speed"), "12 m/s");
    assert_string_equal(text(read_file(&t, "scene.yaml"), "aero.wind.kind"), "power");
    steps(&t, 2);
    static const char *const types[] = {"6    WindType", "7    WindType"};
    for (int i = 0; i < 2; i++) {
        t = import(&(edit){"parts/wind.dat", "1    WindType", types[i]});
        assert_true(list_says(&t, "12 m/s instead"));
    }
    // no text of a wind: an entry of a store of large files, in its place
    t = import(&(edit){"parts/wind.dat", "1    WindType", "3    WindType\n\"servo.dat\"  FileName_BTS"});
    assert_true(list_says(&t, "not a TurbSim full-field file"));
}

TEST(old_decks_name_two_files_alike) {
    const edit two = {"parts/wind.dat", "1    WindType",
                      "3    WindType\n"
                      "== Parameters for Uniform wind file ==\n\"none.wnd\"  Filename\n"
                      "== Parameters for Binary TurbSim Full-Field files ==\n\"box.bts\"  Filename"};
    trial t = import(&two);
    assert_non_null(strstr(text(read_file(&t, "scene.yaml"), "aero.wind.file"), "/box.bts"));
    steps(&t, 2);
}

// Each type's height is that of its own section.
TEST(old_decks_name_heights_alike) {
    const edit height = {"parts/wind.dat", "   0.2    PLexp          - (-)",
                         "0.2 PLexp\n== Parameters for Uniform wind file ==\n"
                         "\"" BOUGH_SOURCE_DIR
                         "/tests/fuzz/corpus/wind/hub.wnd\" Filename\n 33 RefHt\n 44 RefLength\n"
                         "== Parameters for Binary TurbSim Full-Field files ==\n\"box.bts\"  Filename\n"
                         "== Parameters for HAWC-format binary files ==\n\"u.bin\" FileName_u\n\"v.bin\" "
                         "FileName_v\n\"w.bin\" FileName_w\n8 nx\n8 ny\n8 nz\n3 dx\n3 dy\n3 dz\n55 RefHt\n"
                         "9 URef\n0.1 PLExp"};
    trial t = import_with(&(edit){"parts/wind.dat", "1    WindType", "2    WindType"}, &height);
    assert_string_equal(text(read_file(&t, "scene.yaml"), "aero.wind.reference_height"), "33 m");
    assert_string_equal(text(read_file(&t, "scene.yaml"), "aero.wind.reference_length"), "44 m");
    t = import_with(&(edit){"parts/wind.dat", "1    WindType", "5    WindType"}, &height);
    assert_true(list_says(&t, "its wind, to be given to the import by --wind FILE"));
}

TEST(offshore_turbines_stand_on_their_base) {
    const edit water = {"main.fst", "0    CompHydro", "1    CompHydro"};
    const edit base = {"parts/elasto.dat", "20    TowerHt     - (m)",
                       "20 TowerHt\n 4 TowerBsHt\nTrue  PtfmPDOF"};
    check_refused(attempt("main.fst", &water), BOUGH_INVALID,
                  "CompHydro: expected 0, a turbine on land; --clamp-base");
    trial t = import_given("main.fst", &water, &base, &(bough_import_options){.clamp_base = true});
    assert_true(list_says(&t, "CompHydro: the tower's base is clamped"));
    assert_true(list_says(&t, "PtfmPDOF"));
    assert_string_equal(text(body(&t, "tower"), "joint.placement.0"), "move z 4 m");
    check_near(number(read_file(&t, "tower-structure.yaml"), "length"), 16, 1e-9, 0);
    steps(&t, 2);
    const edit tidal = {"main.fst", "0    CompHydro", "1    MHK"};
    t = attempt_given("main.fst", &tidal, NULL, &(bough_import_options){.clamp_base = true});
    check_refused(t, BOUGH_INVALID, "MHK: expected 0, a turbine in air");
}

// -- tables ---------------------------------------------------------------------------------------

TEST(blade_elements_reach_root_and_tip) {
    static const struct {
        const char *from, *to; // of the last row's span
        int rows;
        double last[2];                                              // its span and chord
    } trials[] = {{"9.0    0.3", "9.004    0.3", 3, {9, 0.5004995}}, // a few mm beyond
                  {"9.0    0.3", "9.0005   0.3", 3, {9, 0.5000625}},
                  {"9.0    0.3", "10.0    0.3", 3, {9, 0.6}},
                  {"9.0    0.3", "8.5    0.3", 4, {9, 0.5}}};
    for (size_t i = 0; i < sizeof trials / sizeof *trials; i++) {
        trial t = import(&(edit){"parts/aero-blade.dat", trials[i].from, trials[i].to});
        const bough_node *rows = at(read_file(&t, "blade-aero.yaml"), "stations.rows");
        assert_int_equal(rows->n, trials[i].rows);
        const bough_node *last = rows->value[rows->n - 1];
        check_near(number(last, "0"), trials[i].last[0], 1e-9, 0);
        check_near(number(last, "4"), trials[i].last[1], 1e-6, 0);
        assert_int_equal(list_says(&t, "on a blade of 9 m"), i != 1);
        steps(&t, 2);
    }
    trial t = import(&(edit){"parts/aero-blade.dat", "   0.0    0.0 ", "   1.0    0.0 "});
    assert_int_equal(at(read_file(&t, "blade-aero.yaml"), "stations.rows")->n, 4);
}

TEST(structures_reach_root_and_tip) {
    trial t = import_with(&by_modes, &(edit){"parts/blade.dat", "  1.0      0.25", "  0.9      0.25"});
    const bough_node *rows = at(read_file(&t, "blade-structure.yaml"), "stations.rows");
    assert_int_equal(rows->n, 3);
    check_near(number(rows, "2.0"), 9, 1e-9, 0);
    steps(&t, 2);
    t = import(&(edit){"parts/tower.dat", "2   NTwInpSt", "1   NTwInpSt"});
    rows = at(read_file(&t, "tower-structure.yaml"), "stations.rows");
    assert_int_equal(rows->n, 2);
    check_near(number(rows, "1.0"), 20, 1e-9, 0);
    steps(&t, 2);
    t = import(&(edit){"parts/beam-blade.dat", "\n  1.0\n", "\n  0.99995\n"});
    assert_int_equal(at(read_file(&t, "blade-structure.yaml"), "stations.rows")->n, 3);
    t = import(&(edit){"parts/beam-blade.dat", "\n  1.0\n", "\n  0.9\n"});
    assert_int_equal(at(read_file(&t, "blade-structure.yaml"), "stations.rows")->n, 4);
    assert_true(list_says(&t, "stations from 0 to 0.9 of the length"));
    // BeamDyn's blade is not ElastoDyn's
    import(&(edit){"parts/blade.dat", "4.0E6    9.0E6\n", "4.0E6    0.0\n"});
}

// A table that ends before 180 deg, and one whose ends differ, meet in their mean.
TEST(polars_go_round) {
    trial t = import(&(edit){"parts/foils/flat.dat", "   0.0   180.0   0.02", "   0.2   170.0   0.04"});
    const bough_node *rows = at(read_file(&t, "airfoils.yaml"), "polars.1.table.rows");
    assert_int_equal(rows->n, 8);
    check_near(number(rows, "0.1"), 0.1, 1e-9, 0);
    check_near(number(rows, "7.0"), 180, 1e-9, 0);
    check_near(number(rows, "7.2"), 0.03, 1e-9, 0);
    assert_true(list_says(&t, "from -180 to 170 deg; the value at 180 deg is the mean of its ends"));
    steps(&t, 2);
}

// Nothing damps the modes of such a deck, but ElastoDyn's blade has no shear, stretch and twist to ring.
TEST(undamped_blades_are_damped_where_elastodyn_is_rigid) {
    trial t = import_with(&by_modes,
                          &(edit){"parts/blade.dat", "1.5   BldFlDmp(1) - (%)\n   0.5", "0 BldFlDmp(1)\n 0"});
    const bough_node *s = read_file(&t, "blade-structure.yaml");
    assert_true(number(s, "damping.0") > 0 && number(s, "damping.2") > 0 && number(s, "damping.5") > 0);
    check_near(number(s, "damping.3"), 0, 0, 1e-15);
    check_near(number(s, "damping.4"), 0, 0, 1e-15);
    steps(&t, 2);
}

// The line below the headings is that of the units, however they are written.
TEST(units_may_be_written_anyhow) {
    static const edit units[] = {
        {"parts/tower.dat", "  (-)     (kg/m)    (Nm^2)    (Nm^2)", "-  kg/m  Nm^2  Nm^2"},
        {"parts/aero-blade.dat", "   (m)    (m)", "   [m]    [m]"},
        {"parts/blade.dat", "  (-)      (-)       (deg)", "---- ---- deg"}};
    for (int i = 0; i < 3; i++) {
        import_with(i == 2 ? &by_modes : NULL, &units[i]);
    }
}

// -- other parts ----------------------------------------------------------------------------------

TEST(masses_on_tips_and_yaw_bearing) {
    const edit masses = {"parts/elasto.dat", "8000    NacMass",
                         "8000 NacMass\n2000 YawBrMass\n12 TipMass(1)\n12 TipMass(2)\n12 TipMass(3)"};
    trial t = import_with(&by_modes, &masses);
    const bough_node *nacelle = body(&t, "nacelle");
    assert_string_equal(text(nacelle, "mass"), "10000 kg");
    check_near(number(nacelle, "centre_of_mass.0"), 0.4, 1e-9, 0);
    check_near(number(nacelle, "inertia.2"), 6000 - 10000 * 0.16, 1e-9, 0);
    assert_string_equal(text(body(&t, "tip3"), "joint.parent"), "blade3");
    steps(&t, 2);
}

// The hub is a rod along the blades of 600 kg m2 about the pin, of which 2000 kg at 0.3 m have 180.
TEST(two_blades_teeter) {
    const edit blades = {
        "parts/elasto.dat", "         3    NumBl",
        "2 NumBl\nTrue TeetDOF\n0.3 UndSling\n30 Delta3\n5 TeetDefl\n1 TeetMod\n3E4 TeetDmp\n"
        "20 TeetHStP\n5E6 TeetHSSp"};
    trial t = import(&blades);
    const bough_node *hub = body(&t, "hub");
    assert_string_equal(text(hub, "joint.axis"), "y");
    assert_string_equal(text(hub, "joint.angle"), "5 deg");
    check_near(number(hub, "joint.damping"), 3e4, 1e-9, 0);
    check_near(number(hub, "joint.stop_stiffness"), 5e6, 1e-9, 0);
    check_near(number(hub, "centre_of_mass.0"), -0.3, 1e-9, 0);
    check_near(number(hub, "inertia.0"), (600 - 180) / 0.75, 1e-9, 0);
    check_near(number(hub, "inertia.1"), (600 - 180) / 0.75, 1e-9, 0);
    check_near(number(hub, "inertia.2"), 0, 0, 0);
    assert_string_equal(text(body(&t, "blade2"), "joint.placement.0"), "move x -0.3 m");
    assert_string_equal(text(body(&t, "blade2"), "joint.placement.1"), "rotate x 180 deg");
    steps(&t, 2);
}

TEST(any_number_of_blades_is_taken) {
    static const edit number[] = {{"parts/elasto.dat", "         3    NumBl", "         1    NumBl"},
                                  {"parts/elasto.dat", "         3    NumBl",
                                   "5 NumBl\n1 BlPitch(4)\n2 BlPitch(5)\n-3 PreCone(4)\n-2 PreCone(5)"}};
    for (int k = 0; k < 2; k++) {
        trial t = import(&number[k]);
        int n = k == 0 ? 1 : 5;
        assert_int_equal(at(read_file(&t, "scene.yaml"), "turbine.blades")->n, n);
        if (k == 1) {
            assert_string_equal(text(body(&t, "blade5"), "pitch"), "2 deg");
            assert_string_equal(text(body(&t, "blade5"), "joint.placement.0"), "rotate x 288 deg");
            assert_string_equal(text(body(&t, "blade5"), "joint.placement.1"), "rotate y -2 deg");
        }
        steps(&t, 2);
    }
}

// From 600 rpm to 1.5 times 300 N m at 1.5 times 2 %; the line of a circuit beside its formula.
TEST(induction_generators_are_lines) {
    const edit none = {"parts/servo.dat", "1   VSContrl", "0   VSContrl"};
    const edit light = {"parts/elasto.dat", "2.0    GenIner", "200    GenIner"};
    trial t = import_with(&none, &light);
    const bough_node *law = at(read_file(&t, "scene.yaml"), "control.law");
    check_near(number(law, "slip"), 0.03, 1e-9, 0);
    check_near(number(law, "most_torque"), 450, 1e-9, 0);
    check_near(number(law, "rated_speed"), 600 * 1.03 * acos(-1.0) / 30, 1e-9, 0);
    assert_string_equal(text(law, "motoring"), "true");
    steps(&t, 2);
    const edit circuit = {"parts/servo.dat", "1   VSContrl",
                          "60 TEC_Freq\n6 TEC_NPol\n0.0185 TEC_SRes\n0.017 TEC_RRes\n480 TEC_VLL\n"
                          "0.034 TEC_SLR\n0.005 TEC_RLR\n0.775 TEC_MR\n2 GenModel\n0   VSContrl"};
    t = import_with(&circuit, &light);
    law = at(read_file(&t, "scene.yaml"), "control.law");
    // the steady torque of the circuit at a small slip s: 3 V² R2/s / (ω |Z|²)
    double omega = 120 * 60 / 6. * acos(-1.0) / 30, slip = -1e-4, x = 0.034 + 0.775;
    double volts = 480 * 480 * 0.775 * 0.775 / (0.0185 * 0.0185 + x * x);
    double real = 0.0185 * 0.775 * 0.775 / (0.0185 * 0.0185 + x * x);
    double imaginary = 0.775 * (0.0185 * 0.0185 + 0.034 * x) / (0.0185 * 0.0185 + x * x) + 0.005;
    double load = 0.017 / slip;
    double torque = -volts * load / (omega * ((real + load) * (real + load) + imaginary * imaginary));
    double full = number(law, "rated_speed"), low = full / (1 + number(law, "slip"));
    double line = number(law, "most_torque") / (full - low) * (omega * 1e-4);
    check_near(low, omega, 1e-6, 0);
    check_near(line, torque, 0.01, 0);
    t = import(&(edit){"parts/servo.dat", "1   VSContrl", "3 GenModel\n0   VSContrl"});
    assert_true(list_says(&t, "the user's generator of GenModel 3"));
}

// On line by time or by speed, off by time or when the power is negative.
TEST(generators_are_switched) {
    const edit light = {"parts/elasto.dat", "2.0    GenIner", "200    GenIner"};
    const edit timed = {"parts/servo.dat", "1   VSContrl", "2 TimGenOf\nTrue GenTiStp\n0   VSContrl"};
    const edit fast = {"parts/servo.dat", "1   VSContrl",
                       "False GenTiStr\n590 SpdGenOn\nFalse GenTiStp\n0   VSContrl"};
    trial t = import_with(&timed, &light);
    const bough_node *events = at(read_file(&t, "scene.yaml"), "control.events");
    assert_int_equal(events->n, 1);
    assert_string_equal(text(events, "0.kind"), "grid-loss");
    assert_string_equal(text(events, "0.at"), "2 s");
    steps(&t, 2);
    t = import_with(&fast, &light);
    events = at(read_file(&t, "scene.yaml"), "control.events");
    assert_int_equal(events->n, 2);
    assert_string_equal(text(events, "0.kind"), "start");
    assert_string_equal(text(events, "0.channel"), "GenSpeed");
    check_near(number(events, "0.above"), 590, 0, 0);
    assert_string_equal(text(events, "1.channel"), "GenPwr");
    check_near(number(events, "1.below"), 0, 0, 0);
    steps(&t, 2);
}

// The way of a table of speeds in steps of a line.
static double way_of(const bough_node *motion, int n) {
    double sum = 0;
    char time[2][24], value[2][24];
    for (int i = 1; i < n; i++) {
        for (int k = 0; k < 2; k++) {
            snprintf(time[k], sizeof time[k], "speed.times.%d", i - 1 + k);
            snprintf(value[k], sizeof value[k], "speed.values.%d", i - 1 + k);
        }
        double mean = (number(motion, value[0]) + number(motion, value[1])) / 2;
        sum += mean * (number(motion, time[1]) - number(motion, time[0]));
    }
    return sum;
}

// As OpenFAST 5 does, which takes a pitch that nothing controls from ServoDyn.
TEST(a_pitch_without_control_is_the_neutral_one) {
    trial t = import_main("v5/main.fst", &(edit){"v5/servo.dat", "4.5   PitNeut", "2   PitNeut"}, NULL);
    assert_string_equal(text(body(&t, "blade1"), "pitch"), "2 deg");
    assert_string_equal(text(body(&t, "blade2"), "pitch"), "4.5 deg");
}

// What the bearing's spring is fixed to turns from 2 to -10 deg at 3 deg/s, from 1 s on or from the start; so
// do blades that no library steers. Without the yaw's freedom nothing turns, as in OpenFAST.
TEST(manoeuvres_are_motions_of_joints) {
    for (int begin = 0; begin < 2; begin++) {
        char line[200];
        snprintf(
            line, sizeof line,
            "%d TYawManS\n3 YawManRat\n-10 NacYawF\n2 YawNeut\n%d TPitManS(2)\n8 PitManRat(2)\n90 BlPitchF(2)\n"
            "1   VSContrl",
            begin, begin);
        const edit turn = {"parts/servo.dat", "1   VSContrl", line};
        trial t = import_with(&turn, NULL);
        const bough_node *yaw = body(&t, "yaw"), *nacelle = body(&t, "nacelle"), *blade = body(&t, "blade2");
        int n = begin > 0 ? 4 : 3;
        check_near(way_of(at(yaw, "joint.motion"), n), -12, 0, begin > 0 ? 1e-9 : 0.031);
        check_near(way_of(at(blade, "joint.motion"), n), -85.5, 0, begin > 0 ? 1e-9 : 0.081);
        assert_string_equal(text(yaw, "joint.angle"), "2 deg");
        assert_string_equal(text(nacelle, "joint.parent"), "yaw");
        assert_string_equal(text(nacelle, "joint.angle"), "-2 deg");
        assert_string_equal(text(nacelle, "joint.rest"), "0 deg");
        assert_string_equal(text(body(&t, "blade1"), "joint.kind"), "fixed");
        assert_false(list_says(&t, "LOAD CASE"));
        steps(&t, 2);
        t = import_with(&turn, &(edit){"parts/elasto.dat", "True          YawDOF", "False         YawDOF"});
        assert_string_equal(text(body(&t, "nacelle"), "joint.parent"), "tower");
        assert_true(list_says(&t, "without YawDOF the nacelle does not turn"));
    }
    const edit still = {"parts/servo.dat", "1   VSContrl",
                        "2 TYawManS\n0 YawManRat\n5 NacYawF\n1   VSContrl"};
    check_refused(attempt("main.fst", &still), BOUGH_INVALID, "a rate that is not zero");
}

// What makes another load case of the run stands first.
TEST(another_load_case_is_said_first) {
    trial t = import(&(edit){"parts/servo.dat", "1   VSContrl", "1 HSSBrMode\n3 THSSBrDp\n1   VSContrl"});
    static const char first[] = "NOT THE MODEL'S LOAD CASE, which also has:\n  THSSBrDp: the brake\n";
    char *list = scratch_read(t.out, "import.txt");
    assert_memory_equal(list, first, strlen(first));
    free(list);
    t = import(&(edit){"main.fst", "0    CompHydro", "True Linearize\nTrue CalcSteady\n0    CompHydro"});
    assert_true(list_says(&t, "also has:\n  CalcSteady: "));
}

// The generator is a body of its own, so that RotTorq is the hub's; no body has an inertia that none can
// have.
TEST(rigid_drive_trains_have_a_generator) {
    const edit rigid = {"parts/elasto.dat", "True          DrTrDOF", "False         DrTrDOF"};
    const edit teeter = {"parts/elasto.dat", "         3    NumBl", "2 NumBl\nTrue TeetDOF"};
    for (int i = 0; i < 2; i++) {
        trial t = import_with(&rigid, i == 0 ? NULL : &teeter);
        const bough_node *hub = body(&t, "hub"), *generator = body(&t, "generator");
        assert_string_equal(text(hub, "joint.kind"), i == 0 ? "fixed" : "revolute");
        assert_string_equal(text(hub, "joint.parent"), "generator");
        assert_string_equal(text(read_file(&t, "scene.yaml"), "turbine.rotor"), "generator");
        check_near(number(hub, "inertia.0"), 600, 0, 0);
        check_near(number(generator, "inertia.0"), 2 * 30 * 30, 0, 0);
        steps(&t, 2);
    }
}

TEST(generators_that_stay_off_have_no_torque) {
    for (int mode = 0; mode <= 1; mode++) {
        char line[32];
        snprintf(line, sizeof line, "%d   VSContrl", mode);
        trial t = import_with(&(edit){"parts/servo.dat", "1   VSContrl", line},
                              &(edit){"parts/servo.dat", "0   TimGenOn", "9999   TimGenOn"});
        assert_true(list_says(&t, "TimGenOn: no torque acts on the generator"));
        assert_null(bough_node_find(read_file(&t, "scene.yaml"), "control"));
    }
}

// What ServoDyn also steers is on the list.
TEST(structural_control_is_on_the_list) {
    trial t = import(&(edit){"parts/servo.dat", "1   VSContrl",
                             "2 NumTStC\nTrue CompNTMD\n1 AfCmode\n0 NumBStC\n1   VSContrl"});
    assert_true(list_says(&t, "NumTStC: structural control"));
    assert_true(list_says(&t, "CompNTMD: structural control"));
    assert_true(list_says(&t, "AfCmode"));
    assert_true(list_says(&t, "NOT THE MODEL'S LOAD CASE"));
    assert_false(list_says(&t, "NumBStC"));
    t = import(&(edit){"parts/elasto.dat", "20    RotSpeed", "1 YawFrctMod\n20    RotSpeed"});
    assert_true(list_says(&t, "also has:\n  YawFrctMod: the friction of the yaw bearing\n"));
}

// A line that is as good as vertical becomes the steepest that samples hold.
TEST(steep_torque_lines_are_taken) {
    trial t = import(&(edit){"parts/servo.dat", "10   VS_SlPc", "1E-5   VS_SlPc"});
    double slip = number(read_file(&t, "scene.yaml"), "control.law.slip");
    assert_true(slip > 0.01 && slip < 0.1);
    assert_true(list_says(&t, "not 1e-05 %"));
    steps(&t, 2);
    // a constant torque begins at three quarters of the initial speed of 20 rpm times 30
    t = import(&(edit){"parts/servo.dat", "900   VS_RtGnSp", "9E-9   VS_RtGnSp"});
    check_near(number(read_file(&t, "scene.yaml"), "control.law.rated_speed"), 15 * acos(-1.0), 1e-9, 0);
    assert_true(list_says(&t, "its maximum from 450 rpm of the generator on"));
    steps(&t, 2);
}

// A fast small rotor has short steps, by halves of 20 ms.
TEST(steps_follow_the_rotor) {
    trial t = import(&(edit){"parts/elasto.dat", "20    RotSpeed", "188    RotSpeed"});
    const bough_node *s = read_file(&t, "scene.yaml");
    check_near(number(s, "simulation.macro_step"), 2.5e-3, 1e-9, 0);
    check_near(number(s, "aero.rate"), 400, 1e-9, 0);
    check_near(number(s, "control.rate"), 400, 1e-9, 0);
}
