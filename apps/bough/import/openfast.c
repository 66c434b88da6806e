// The main file of an OpenFAST model, and the order in which the scene is written.

#include "apps/bough/import/openfast.h"

// -- what a deck may have -------------------------------------------------------------------------

// Limits of the numbers of all decks, each in the unit of its line: no two decks use one name for two
// quantities. A value beyond its limits would only be refused in the scene, which the user has not written.
static const struct {
    double low, high;
    const char *names[8]; // ends with NULL
} limits[] = {
    {-1e4, 1e4, {"RotSpeed"}},
    {-360, 360, {"NacYaw", "ShftTilt"}},
    {-180, 180, {"BlPitch(1)|BlPitch1", "BlPitch(2)|BlPitch2", "BlPitch(3)|BlPitch3", "TeetDefl"}},
    {-89, 89, {"PreCone(1)|PreCone1", "PreCone(2)|PreCone2", "PreCone(3)|PreCone3", "Delta3"}},
    {-80, 80, {"VFlowAng"}},
    {0.01, 1e3, {"TipRad"}},
    {1e-3, 1e3, {"HubRad"}},
    {1e-3, 1e4, {"GBRatio"}},
    {-1e3, 1e3, {"HubCM", "UndSling", "OverHang", "NacCMxn", "NacCMyn", "NacCMzn", "Twr2Shft"}},
    {-1e3, 1e4, {"TowerHt", "TowerBsHt"}},
    {0, 1e9, {"HubMass", "GenIner", "NacMass", "YawBrMass"}},
    {0, 1e9, {"TipMass(1)|TipMass1", "TipMass(2)|TipMass2", "TipMass(3)|TipMass3"}},
    {0, 1e20, {"TPCOn", "TimGenOn", "TimGenOf", "SpdGenOn", "THSSBrDp", "TYCOn", "TYawManS"}},
    {0, 1e20, {"TPitManS(1)|TPitManS1", "TPitManS(2)|TPitManS2", "TPitManS(3)|TPitManS3"}},
    {0, 1e15, {"HubIner", "NacYIner"}},
    {0, 1e20, {"TeetDmp", "TeetHSSp", "DTTorSpr", "DTTorDmp", "YawSpr", "YawDamp"}},
    {0, 200, {"HWindSpeed", "Gravity"}},
    {1e-3, 1e4, {"AirDens"}},
    {0, 1, {"PLExp", "UAStartRad", "UAEndRad"}},
    {0, 100, {"GenEff", "GBoxEff", "BldFlDmp(1)|BldFlDmp1", "BldEdDmp(1)|BldEdDmp1"}},
    {0, 100, {"TwrFADmp(1)|TwrFADmp1", "TwrSSDmp(1)|TwrSSDmp1"}},
    {1e-6, 1e6, {"AdjBlMs", "AdjFlSt", "AdjEdSt", "AdjTwMa", "AdjFASt", "AdjSSSt"}},
    {1e-6, 1e6, {"FlStTunr(1)|FlStTunr1", "FAStTunr(1)|FAStTunr1", "SSStTunr(1)|SSStTunr1"}},
};

// Values that OpenFAST knows of the switches.
static const struct {
    const char *values, *names[5];
} switches[] = {
    {"0 1", {"Ptch_Cntrl", "SkewRedistr_Mod"}},
    {"0 1 2", {"TwrPotent", "TwrShadow", "SkewMod", "TeetMod", "damp_type"}},
    {"0 1 2 3", {"WakeMod", "YawFrctMod"}},
    {"0 1 2 3 4 5 6 7 8", {"UAMod|UA_Mod"}},
    {"0 1 3", {"Wake_Mod"}},
    {"0 1 3 4 5", {"VSContrl", "HSSBrMode"}},
    {"0 1 4 5", {"AfCmode"}},
    {"0 3 4 5", {"PCMode", "YCMode"}},
    {"0 4 5", {"CCmode"}},
    {"1 2", {"AFAeroMod", "BEM_Mod"}},
    {"1 2 3", {"AFTabMod"}},
    {"-1 0 1", {"Skew_Mod"}},
    {"-1 0 1 2 3", {"DBEMT_Mod"}},
};

// Lines that the decks of all versions have, and what is taken where one is missing: OpenFAST finds most
// lines by their order, so that a name may be another one.
static const struct {
    const char *file, *taken, *names[10];
} lines[] = {
    {"EDFile", "0", {"NacYaw", "Azimuth", "AzimB1Up", "HubCM", "TowerBsHt", "YawBrMass"}},
    {"EDFile", "0", {"TipMass(1)|TipMass1", "TipMass(2)|TipMass2", "TipMass(3)|TipMass3"}},
    {"EDFile", "False", {"FlapDOF1", "FlapDOF2", "EdgeDOF", "DrTrDOF", "YawDOF"}},
    {"EDFile", "False", {"TwFADOF1", "TwFADOF2", "TwSSDOF1", "TwSSDOF2"}},
    {"EDFile", "True", {"GenDOF"}},
    {"ServoFile", "0", {"PCMode", "VSContrl", "YCMode", "YawNeut", "TimGenOn"}},
    {"ServoFile", "1", {"GenModel"}},
    {"ServoFile", "100", {"GenEff"}},
    {"ServoFile", "True", {"GenTiStr", "GenTiStp"}},
    {"ServoFile", "the end of the run", {"TimGenOf", "THSSBrDp", "TYawManS", "TPitManS(1)|TPitManS1"}},
    {"AeroFile", "0", {"TwrPotent", "TwrShadow", "InCol_Cm"}},
    {"AeroFile", "1", {"WakeMod|Wake_Mod", "SkewMod|Skew_Mod", "InCol_Alfa"}},
    {"AeroFile", "2", {"InCol_Cl"}},
    {"AeroFile", "3", {"InCol_Cd"}},
    {"AeroFile", "4", {"UAMod|UA_Mod"}},
    {"AeroFile", "that of the main file, or 1.225", {"AirDens"}},
    {"AeroFile", "False", {"TwrAero"}},
    {"AeroFile", "True", {"TipLoss", "HubLoss", "TanInd", "AIDrag", "TIDrag", "UseBlCm"}},
    {"InflowFile", "0", {"PropagationDir|PropogationDir", "PLExp"}},
    {"BldFile(1)", "1", {"AdjBlMs", "AdjFlSt", "AdjEdSt"}},
    {"TwrFile", "1", {"AdjTwMa", "AdjFASt", "AdjSSSt"}},
    {"TwrFile", "that of fore-aft", {"TwSSM1Sh(2)"}},
};

static void check_limits(const bough_deck *deck) {
    for (size_t k = 0; k < sizeof limits / sizeof *limits; k++) {
        double low = limits[k].low, high = limits[k].high;
        for (const char *const *names = limits[k].names; *names; names++) {
            double value = bough_deck_number_or(deck, *names, low);
            if (value >= low && value <= high) continue;
            bough_deck_refuse(deck, *names, "expected %g to %g, got %g", low, high, value);
        }
    }
}

static bool is_among(const char *values, double value) {
    for (char *end; *values; values = end)
        if (strtod(values, &end) == value) return true;
    return false;
}

static void check_switches(const bough_deck *deck) {
    for (size_t k = 0; k < sizeof switches / sizeof *switches; k++) {
        for (int i = 0; i < 5 && switches[k].names[i]; i++) {
            const char *name = switches[k].names[i], *values = switches[k].values;
            double value = bough_deck_switch_or(deck, name, HUGE_VAL);
            if (value < HUGE_VAL && !is_among(values, value))
                bough_deck_refuse(deck, name, "expected one of %s, got %g", values, value);
        }
    }
}

static void note_missing(bough_openfast *o, const bough_deck *deck, const char *file) {
    for (size_t k = 0; k < sizeof lines / sizeof *lines; k++) {
        const char *missing = "";
        size_t n = strlen(lines[k].file);
        if (n != strcspn(file, "|") || strncmp(file, lines[k].file, n) != 0) continue;
        for (const char *const *name = lines[k].names; *name; name++) {
            if (bough_deck_line(deck, *name) >= 0) continue;
            missing = bough_arena_print(deck->arena, "%s%s%.*s", missing, missing[0] ? ", " : "",
                                        (int)strcspn(*name, "|"), *name);
        }
        if (missing[0])
            bough_approximated(o, "%s has no %s: %s is taken", bough_file_name(deck->path), missing,
                               lines[k].taken);
    }
}

bough_deck *bough_openfast_open(bough_openfast *o, const bough_deck *from, const char *names) {
    const char *path = from ? bough_deck_file(from, names) : names;
    bough_deck *deck = bough_deck_open(o->draft->arena, path, BOUGH_DECK_HEADING, o->draft->status);
    if (!deck) return NULL;
    if (from) bough_taken(o, "%.*s: %s", (int)strcspn(names, "|"), names, path);
    check_limits(deck);
    check_switches(deck);
    note_missing(o, deck, names);
    return deck;
}

void bough_openfast_leave(bough_openfast *o, const bough_deck *deck, const bough_openfast_rest *rest,
                          size_t n, int list) {
    for (size_t i = 0; i < n; i++) {
        for (const char *const *name = rest[i].names; *name; name++) {
            if (bough_deck_switch_or(deck, *name, rest[i].neutral) == rest[i].neutral) continue;
            const char *text = rest[i].text;
            bough_draft_note(o->draft, list, "%s%s%s", *name, text ? ": " : "", text ? text : "");
        }
    }
}

// -- reading --------------------------------------------------------------------------------------

// What is below the tower is left out where its base is to be clamped.
static void leave_water(bough_openfast *o) {
    static const char *const part[] = {"CompHydro",   "CompSeaSt", "CompSub",
                                       "CompMooring", "CompIce",   "CompSoil"};
    for (size_t i = 0; i < sizeof part / sizeof *part; i++) {
        if (bough_deck_whole_or(o->main, part[i], 0) == 0) continue;
        if (o->draft->options->clamp_base) {
            bough_left_out(o, "%s: the tower's base is clamped", part[i]);
            continue;
        }
        bough_deck_refuse(
            o->main, part[i],
            "expected 0, a turbine on land; --clamp-base imports it clamped at the tower's base");
    }
    if (bough_deck_whole_or(o->main, "MHK", 0) != 0) {
        bough_deck_refuse(o->main, "MHK", "expected 0, a turbine in air");
    }
}

// Since version 5.
static void refuse_other_rotors(const bough_openfast *o) {
    if (bough_deck_whole_or(o->main, "NRotors", 1) != 1) {
        bough_deck_refuse(o->main, "NRotors", "expected 1");
    } else if (bough_deck_flag_or(o->main, "MirrorRotor", false)) {
        bough_deck_refuse(o->main, "MirrorRotor", "expected False, a rotor that turns clockwise");
    }
}

// Main files of other programs of the family.
static void refuse_other_files(const bough_openfast *o) {
    static const char *const key[] = {"ADFile|ADAMSPrep", "Mod_AmbWind", "AnalysisType|DynamicSolve"};
    static const char *const what[] = {"a model of FAST 8.07 or older: convert it to OpenFAST's files",
                                       "a wind farm: give the main file of one of its turbines",
                                       "the file of a driver: give the main file of a turbine"};
    if (bough_deck_line(o->main, "CompElast") >= 0) return;
    for (int i = 0; i < 3; i++) {
        int line = bough_deck_line(o->main, key[i]);
        if (line >= 0)
            bough_deck_fail(o->main, line, "expected a turbine's main file of OpenFAST, got %s", what[i]);
    }
}

static void open_modules(bough_openfast *o) {
    refuse_other_files(o);
    int elastic = bough_deck_whole(o->main, "CompElast", 1, 3);
    int air = bough_deck_whole(o->main, "CompAero", 0, 3);
    if (elastic == 3) {
        bough_deck_refuse(o->main, "CompElast",
                          "expected 1 (ElastoDyn) or 2 (with BeamDyn), got 3 "
                          "(Simplified ElastoDyn), which describes no blades");
    }
    leave_water(o);
    refuse_other_rotors(o);
    if (bough_deck_flag_or(o->main, "Linearize", false) && bough_deck_flag_or(o->main, "CalcSteady", false))
        bough_other_case(o, "CalcSteady: torque, pitch or yaw are trimmed to the speed of the start");
    o->beamdyn = elastic == 2;
    o->elasto = bough_openfast_open(o, o->main, "EDFile");
    if (bough_deck_whole(o->main, "CompInflow", 0, 2) == 1) {
        o->inflow = bough_openfast_open(o, o->main, "InflowFile");
    }
    if (air == 1 || air == 3) {
        bough_deck_refuse(o->main, "CompAero",
                          "expected 0 or 2 (AeroDyn 15 and later), got %d: AeroDyn 14, "
                          "AeroDisk and external loads are not supported",
                          air);
    }
    if (air == 2) o->aero = bough_openfast_open(o, o->main, "AeroFile");
    if (bough_deck_whole(o->main, "CompServo", 0, 1) == 1) {
        o->servo = bough_openfast_open(o, o->main, "ServoFile");
    }
}

// Whether one of the motions is enabled, so that the blade or tower bends.
static bool any(const bough_deck *deck, const char *const *name) {
    for (; *name; name++) {
        if (bough_deck_flag_or(deck, *name, false)) return true;
    }
    return false;
}

// Notes motions that the deck switches off and the scene has: a rod bends in all directions.
static void note_some(bough_openfast *o, const char *const *name, const char *part) {
    bool bends = any(o->elasto, name);
    for (; *name && bends; name++) {
        bool known = bough_deck_line(o->elasto, *name) >= 0;
        if (known && !bough_deck_flag_or(o->elasto, *name, false))
            bough_other_case(o, "%s False: the %s bends that way too", *name, part);
    }
}

static void read_shape(bough_openfast *o) {
    static const char *const blade[] = {"FlapDOF1", "FlapDOF2", "EdgeDOF", NULL};
    static const char *const tower[] = {"TwFADOF1", "TwFADOF2", "TwSSDOF1", "TwSSDOF2", NULL};
    const bough_deck *e = o->elasto;
    o->n_blade = bough_deck_whole(e, "NumBl", 1, BOUGH_IMPORT_BLADES);
    o->hub_radius = bough_deck_number(e, "HubRad");
    o->tower_top = bough_deck_number(e, "TowerHt");
    o->tower_base = bough_deck_number_or(e, "TowerBsHt", 0);
    if (!bough_is_ok(o->draft->status)) return;
    if (bough_deck_flag_or(e, "Furling", false)) {
        bough_deck_refuse(e, "Furling", "expected False: tails and rotors that furl are not supported");
    }
    if (!(o->tower_top > o->tower_base)) {
        bough_deck_refuse(e, "TowerHt", "expected more than TowerBsHt");
    }
    o->rigid_blade = !o->beamdyn && !any(e, blade);
    o->rigid_tower = !any(e, tower);
    if (!o->beamdyn) note_some(o, blade, "blade");
    note_some(o, tower, "tower");
}

// -- writing --------------------------------------------------------------------------------------

static void put_head(bough_openfast *o, const char *path) {
    bool own = bough_deck_line(o->main, "Gravity") >= 0; // before version 3 ElastoDyn has it
    double g = bough_deck_number(own ? o->main : o->elasto, "Gravity");
    double most = bough_deck_number(o->main, "TMax"), turn = bough_openfast_rotor_speed(o);
    if (!(most >= 0 && most <= 1e6)) {
        bough_deck_refuse(o->main, "TMax", "expected a time from 0 to 1e6 s");
    }
    bough_draft_head(o->draft, bough_file_name(path), "an OpenFAST model", g, most, turn);
    bough_left_out(o, "solver settings, output channels, visualisation, linearisation: the scene has its "
                      "own");
}

static void note_other_blades(bough_openfast *o, const bough_deck *deck, const char *stem) {
    const char *first = bough_deck_kth(deck, stem, 1);
    for (int k = 2; k <= o->n_blade && bough_is_ok(o->draft->status); k++) {
        const char *name = bough_deck_kth(deck, stem, k);
        if (bough_deck_line(deck, name) < 0) continue;
        if (strcmp(bough_deck_text(deck, name), bough_deck_text(deck, first)) == 0) continue;
        bough_approximated(o, "%s(%d): blade %d is as the first", stem, k, k);
    }
}

static void write_scene(bough_openfast *o, const char *path) {
    if (!bough_is_ok(o->draft->status)) return;
    put_head(o, path);
    if (o->beamdyn)
        bough_openfast_beamdyn(o);
    else
        bough_openfast_blade(o);
    bough_openfast_generator(o);
    bough_openfast_bodies(o);
    bough_openfast_aero_tables(o);
    bough_openfast_aero(o);
    bough_openfast_control(o);
    note_other_blades(o, o->beamdyn ? o->main : o->elasto, o->beamdyn ? "BDBldFile" : "BldFile");
    if (o->aero) note_other_blades(o, o->aero, "ADBlFile");
}

static void convert(bough_draft *d, const char *path) {
    bough_openfast *o = bough_arena_take(d->arena, sizeof *o);
    o->draft = d;
    o->main = bough_openfast_open(o, NULL, path);
    if (o->main) open_modules(o);
    if (bough_is_ok(o->draft->status)) read_shape(o);
    write_scene(o, path);
}

bough_status bough_import_openfast(const char *path, const char *folder, const bough_import_options *options,
                                   FILE *echo) {
    return bough_draft_import(convert, path, folder, options, echo);
}
