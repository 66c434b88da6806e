// ServoDyn: the generator's torque, and the control of the pitch.
#include "apps/bough/import/openfast.h"

#include "aero/control/discon.h"

// -- control --------------------------------------------------------------------------------------

enum { NONE, SIMPLE, THEVENIN, USER, LIBRARY = 5 };

static const double least_speed = 1e-3; // of a generator with torque [rad/s]

// How torque (VSContrl) or pitch (PCMode) are controlled.
static int mode_of(const bough_openfast *o, const char *name) {
    return o->servo ? bough_deck_whole_or(o->servo, name, NONE) : NONE;
}

// -- speeds ---------------------------------------------------------------------------------------

// The synchronous speed of an induction generator [rad/s].
static double synchronous_speed(const bough_openfast *o) {
    if (bough_deck_whole_or(o->servo, "GenModel", SIMPLE) == SIMPLE) {
        return bough_deck_number(o->servo, "SIG_SySp") * BOUGH_RPM;
    }
    return 120 * BOUGH_RPM * bough_deck_number(o->servo, "TEC_Freq") /
           bough_deck_number(o->servo, "TEC_NPol");
}

double bough_openfast_rotor_speed(const bough_openfast *o) {
    const double usual_tip = 70; // [m/s]
    double speed = fabs(bough_deck_number(o->elasto, "RotSpeed")) * BOUGH_RPM, fast = 0;
    double ratio = bough_deck_number_or(o->elasto, "GBRatio", 1);
    bool free = bough_deck_flag_or(o->elasto, "GenDOF", true);
    if (!free || !o->servo) return speed;
    if (mode_of(o, "VSContrl") == SIMPLE) fast = bough_deck_number(o->servo, "VS_RtGnSp") * BOUGH_RPM;
    int model = bough_deck_whole_or(o->servo, "GenModel", SIMPLE);
    if (mode_of(o, "VSContrl") == NONE && (model == SIMPLE || model == THEVENIN)) fast = synchronous_speed(o);
    speed = fmax(speed, ratio > 0 && isfinite(fast) ? fabs(fast) / ratio : 0);
    return speed > 0 ? speed : usual_tip / bough_deck_number(o->elasto, "TipRad");
}

// -- what acts on the generator -------------------------------------------------------------------

// The generator has a torque that is not known: its speed is prescribed instead.
static void keep_speed(bough_openfast *o, const char *why) {
    o->unknown_torque = why;
    o->generator = BOUGH_GENERATOR_DRIVEN;
    bough_other_case(o,
                     "%s: the generator keeps its initial speed, %g rpm of the rotor, and the pitch is "
                     "constant",
                     why, bough_deck_number(o->elasto, "RotSpeed"));
}

static bool take_library(bough_openfast *o, const char *path, char why[200]) {
    bough_discon *discon;
    bough_status status = bough_discon_open(o->draft->arena, path, "", false, &discon);
    snprintf(why, 200, "%.190s", status.message);
    if (!bough_is_ok(&status)) return false;
    o->library = path;
    o->generator = BOUGH_GENERATOR_LIBRARY;
    bough_taken(o, "controller: %s, by its path", path);
    if (mode_of(o, "VSContrl") != mode_of(o, "PCMode")) {
        bough_approximated(o, "the library controls both torque and pitch");
    }
    return true;
}

// The deck's library, unless the user gives another.
static void find_library(bough_openfast *o) {
    char why[200];
    const char *given = o->draft->options->controller;
    if (given && !take_library(o, given, why)) {
        *o->draft->status = bough_fail(BOUGH_INVALID, "--controller: %.200s", why);
    }
    if (given) return;
    const char *path = bough_deck_path(o->servo, "DLL_FileName");
    if (!bough_is_ok(o->draft->status) || take_library(o, path, why)) return;
    if (mode_of(o, "VSContrl") == LIBRARY) {
        keep_speed(o, bough_arena_print(o->draft->arena,
                                        "a controller, to be given to the import by --controller FILE (%s)",
                                        why));
    } else {
        bough_other_case(o, "PCMode 5: the pitch is held: %s", why);
    }
}

// Whether the generator is switched on by time, and not before the end of the run.
static bool stays_off(const bough_openfast *o) {
    return o->servo && bough_deck_flag_or(o->servo, "GenTiStr", true) &&
           bough_deck_number_or(o->servo, "TimGenOn", 0) >= bough_deck_number(o->main, "TMax");
}

// A generator without controller.
static void find_induction(bough_openfast *o) {
    int model = bough_deck_whole_or(o->servo, "GenModel", SIMPLE);
    if (model == SIMPLE || model == THEVENIN) o->generator = BOUGH_GENERATOR_LAW;
    if (model < SIMPLE || model > USER)
        bough_deck_refuse(o->servo, "GenModel", "expected one of 1 2 3, got %d", model);
    if (model == USER)
        keep_speed(o, bough_arena_print(o->draft->arena, "the user's generator of GenModel %d", model));
}

void bough_openfast_generator(bough_openfast *o) {
    if (!bough_is_ok(o->draft->status)) return;
    if (!bough_deck_flag_or(o->elasto, "GenDOF", true)) {
        o->generator = BOUGH_GENERATOR_DRIVEN;
        bough_taken(o, "GenDOF False: the rotor turns at %g rpm", bough_deck_number(o->elasto, "RotSpeed"));
        if (o->draft->options->controller) {
            bough_left_out(o, "--controller: GenDOF is False");
        }
        return;
    }
    int torque = mode_of(o, "VSContrl");
    if (torque == SIMPLE && !stays_off(o)) o->generator = BOUGH_GENERATOR_LAW;
    if (o->draft->options->controller || torque == LIBRARY || mode_of(o, "PCMode") == LIBRARY)
        find_library(o);
    if (o->generator != BOUGH_GENERATOR_FREE || !o->servo) return;
    if ((torque == NONE || torque == SIMPLE) && stays_off(o)) return;
    if (torque == NONE) {
        find_induction(o);
    } else {
        keep_speed(o, bough_arena_print(o->draft->arena, "the torque of VSContrl %d, the user's own routine",
                                        torque));
    }
}

// -- torque over speed ----------------------------------------------------------------------------

// The torque over the speed: zero or proportional to its square, then a line to the maximum, which holds
// beyond.
typedef struct torque_line {
    double gain;       // of the square [N m s2/rad2]
    double full_speed; // at which the torque reaches its maximum [rad/s]
    double most;       // [N m]
    double slip;       // full speed over that where the line begins, less 1
} torque_line;

static torque_line read_variable_speed(const bough_openfast *o) {
    const bough_deck *s = o->servo;
    torque_line l = {.gain = bough_deck_number(s, "VS_Rgn2K") / (BOUGH_RPM * BOUGH_RPM),
                     .full_speed = bough_deck_number(s, "VS_RtGnSp") * BOUGH_RPM,
                     .most = bough_deck_number(s, "VS_RtTq"),
                     .slip = bough_deck_number(s, "VS_SlPc") / 100};
    bool good = l.full_speed > 0 && l.most > 0 && l.most <= 1e9 && l.slip > 0 && l.slip <= 1 && l.gain >= 0;
    if (good && l.gain * l.full_speed * l.full_speed <= l.most * (1 + 1e-6)) {
        l.gain = fmin(l.gain, l.most / (l.full_speed * l.full_speed));
        return l;
    }
    bough_deck_fail(
        s, bough_deck_line(s, "VS_RtGnSp"),
        "VS_RtGnSp, VS_RtTq, VS_Rgn2K, VS_SlPc: expected positive values, VS_RtTq at most 1e9 N m, VS_SlPc "
        "at most 100 %%, and VS_Rgn2K VS_RtGnSp^2 at most VS_RtTq");
    return l;
}

// A line to the pull-out torque, which holds beyond.
static torque_line read_simple(const bough_openfast *o) {
    const bough_deck *s = o->servo;
    double ratio = bough_deck_number_or(s, "SIG_PORt", 1);
    torque_line l = {.slip = bough_deck_number(s, "SIG_SlPc") / 100 * ratio,
                     .most = bough_deck_number(s, "SIG_RtTq") * ratio};
    l.full_speed = synchronous_speed(o) * (1 + l.slip);
    if (l.slip > 0 && l.most > 0 && l.full_speed > 0) return l;
    bough_deck_fail(s, bough_deck_line(s, "SIG_SlPc"),
                    "SIG_SlPc, SIG_SySp, SIG_RtTq, SIG_PORt: expected positive values");
    return l;
}

// Thévenin's circuit as seen from the rotor's winding: slope at zero slip, and pull-out torque.
static torque_line read_thevenin(const bough_openfast *o) {
    const bough_deck *s = o->servo;
    double r = bough_deck_number(s, "TEC_SRes"), rotor = bough_deck_number(s, "TEC_RRes");
    double leak = bough_deck_number(s, "TEC_SLR"), mutual = bough_deck_number(s, "TEC_MR");
    double line = bough_deck_number(s, "TEC_VLL"), omega = synchronous_speed(o);
    double square = r * r + (leak + mutual) * (leak + mutual);
    double volts = line * line * mutual * mutual / square; // 3 V² of a phase
    double resistance = r * mutual * mutual / square;
    double reactance = mutual * (r * r + leak * (leak + mutual)) / square + bough_deck_number(s, "TEC_RLR");
    torque_line l = {.most = volts / (2 * omega * (hypot(resistance, reactance) - resistance))};
    l.slip = l.most * omega * rotor / volts;
    l.full_speed = omega * (1 + l.slip);
    if (l.most > 0 && l.slip > 0 && isfinite(l.full_speed) && l.full_speed > 0) return l;
    bough_deck_fail(s, bough_deck_line(s, "TEC_Freq"),
                    "TEC_Freq, TEC_NPol, TEC_SRes, TEC_RRes, TEC_VLL, TEC_SLR, TEC_RLR, TEC_MR: expected "
                    "positive values");
    return l;
}

static torque_line read_line(bough_openfast *o) {
    if (mode_of(o, "VSContrl") == SIMPLE) {
        bough_taken(o, "the generator's torque over its speed");
        return read_variable_speed(o);
    }
    int model = bough_deck_whole_or(o->servo, "GenModel", SIMPLE);
    if (model == SIMPLE) {
        bough_taken(o, "GenModel 1: the generator's torque over its slip, for both signs");
        return read_simple(o);
    }
    bough_approximated(
        o,
        "GenModel 2: torque grows linearly with the slip up to the pull-out torque and is then constant, for both signs; far below synchronous speed the deck's circuit gives less");
    return read_thevenin(o);
}

// The least slip at which the sampled torque is stable: the rate at which the line alone would slow the
// generator, times the sample's period, is `most_gain`; on a rigid shaft twice this is still stable.
static double least_slip(const bough_openfast *o, const torque_line *l) {
    const double most_gain = 0.75;
    double ratio = bough_deck_number(o->elasto, "GBRatio");
    double inertia = bough_openfast_generator_inertia(o);
    if (!bough_openfast_shaft_twists(o)) {
        inertia += o->n_blade * o->blade_inertia + bough_deck_number(o->elasto, "HubIner");
    }
    return ratio * ratio * l->most * o->draft->macro_step / (most_gain * inertia * l->full_speed);
}

static void put_law(bough_openfast *o) {
    torque_line l = read_line(o);
    double ratio = bough_deck_number(o->elasto, "GBRatio");
    double start = fabs(bough_deck_number(o->elasto, "RotSpeed")) * ratio * BOUGH_RPM;
    if (l.full_speed < start / 10) { // of a deck whose torque is constant
        l.full_speed = 0.75 * start;
        bough_approximated(o, "torque has its maximum from %g rpm of the generator on",
                           l.full_speed / BOUGH_RPM);
    }
    double least = least_slip(o, &l), full = l.full_speed;
    if (!bough_is_ok(o->draft->status)) return;
    if (!(l.slip >= least) && isfinite(least)) {
        bough_approximated(o,
                           "torque grows to its maximum over %.2g %% of the speed, not %.2g %%, which "
                           "would be unstable with samples every %g s",
                           100 * least, 100 * l.slip, o->draft->macro_step);
        if (l.gain == 0) full *= (1 + least) / (1 + l.slip);
        l.slip = least;
    }
    if (!(l.slip <= 1) || !(full > 2 * (1 + l.slip) * least_speed)) {
        bough_deck_fail(
            o->servo, bough_deck_line(o->servo, mode_of(o, "VSContrl") == SIMPLE ? "VS_RtGnSp" : "GenModel"),
            "the torque reaches its maximum of %g N m at %.3g rpm of the generator, too suddenly "
            "for samples every %g s",
            l.most, full / BOUGH_RPM, o->draft->macro_step);
    }
    bough_put(o,
              "control:\n  kind: variable-speed\n  rate: %.10g Hz\n  gear_ratio: %.10g\n"
              "  efficiency: %.10g\n  pitch: false\n  law:\n    corner: %.10g rad/s\n    cut_in: 0 rad/s\n"
              "    optimal_from: %g rad/s\n    optimal_gain: %.10g\n    rated_speed: %.10g rad/s\n"
              "    rated_power: %.10g\n    above_rated: torque\n    slip: %.10g\n"
              "    most_torque: %.10g\n    torque_rate: 1e9\n",
              1 / o->draft->macro_step, bough_deck_number(o->elasto, "GBRatio"),
              bough_deck_number_or(o->servo, "GenEff", 100) / 100, 2 / o->draft->macro_step, least_speed,
              l.gain, full, l.most * full, l.slip, l.most);
    if (mode_of(o, "VSContrl") == NONE) bough_put(o, "    motoring: true\n");
}

// Events that connect the generator, and disconnect it for good.
static void put_switches(bough_openfast *o) {
    const bough_deck *s = o->servo;
    bool law = o->generator == BOUGH_GENERATOR_LAW;
    bool timed = bough_deck_flag_or(s, "GenTiStr", true), stops = bough_deck_flag_or(s, "GenTiStp", true);
    double on = bough_deck_number_or(s, timed ? "TimGenOn" : "SpdGenOn", 0);
    double end = bough_deck_number(o->main, "TMax"), off = bough_deck_number_or(s, "TimGenOf", end);
    bool starts = law && on > 0, by_time = stops && off < end,
         by_power = !stops && law && mode_of(o, "VSContrl") == NONE;
    if (on > 0 && !law) {
        bough_other_case(o, "%s: the library controls the torque from the start",
                         timed ? "TimGenOn" : "SpdGenOn");
    }
    if (!starts && !by_time && !by_power) return;
    bough_put(o, "  events:\n");
    if (starts && timed) bough_put(o, "    - {kind: start, at: %.10g s}\n", on);
    if (starts && !timed) bough_put(o, "    - {kind: start, channel: GenSpeed, above: %.10g}\n", on);
    if (by_time) bough_put(o, "    - {kind: grid-loss, at: %.10g s}\n", off);
    if (by_power) bough_put(o, "    - {kind: grid-loss, channel: GenPwr, below: 0}\n");
    const char *first = timed ? "TimGenOn" : "SpdGenOn", *last = by_time ? "TimGenOf" : "GenTiStp False";
    bool both = starts && (by_time || by_power);
    bough_taken(o, "the generator's switches: %s%s%s", starts ? first : last, both ? ", " : "",
                both ? last : "");
}

// -- library --------------------------------------------------------------------------------------

// What ServoDyn adds to a library.
static void leave_interface(bough_openfast *o) {
    static const char zero[] = "this record is 0";
    static const bough_openfast_rest rest[] = {
        {zero, 0, {"Ptch_SetPnt", "Ptch_Min", "Ptch_Max", "PtchRate_Min", "PtchRate_Max", "GenPwr_Dem"}},
        {zero, 0, {"Gain_OM", "GenSpd_MinOM", "GenSpd_MaxOM", "GenSpd_Dem", "GenTrq_Dem", "DLL_NumTrq"}},
        {"directions count from ground x", 0, {"NacYaw_North"}},
        {"demands hold from call to call", 0, {"DLL_Ramp"}},
    };
    bough_openfast_leave(o, o->servo, rest, sizeof rest / sizeof *rest, BOUGH_LEFT_OUT);
    double cut = bough_deck_number_or(o->servo, "BPCutoff", HUGE_VAL);
    if (cut < 0.5 / o->draft->macro_step) bough_left_out(o, "BPCutoff %g Hz: no filter of the pitch", cut);
    bool own = !o->draft->options->controller, named = bough_deck_line(o->servo, "DLL_ProcName") >= 0;
    const char *name = own && named ? bough_deck_text(o->servo, "DLL_ProcName") : "DISCON";
    if (strcmp(name, "DISCON") != 0)
        bough_other_case(o, "DLL_ProcName %s: the library's function DISCON is called", name);
}

static void put_library(bough_openfast *o) {
    double step = o->draft->macro_step;
    double efficiency = o->servo ? bough_deck_number_or(o->servo, "GenEff", 100) / 100 : 1;
    bool input = o->servo && bough_deck_line(o->servo, "DLL_InFile") >= 0;
    bough_draft_library(o->draft, o->library, input ? bough_deck_path(o->servo, "DLL_InFile") : NULL,
                        bough_deck_number(o->elasto, "GBRatio"), efficiency);
    if (o->servo && bough_deck_whole_or(o->servo, "Ptch_Cntrl", 0) == 1) {
        bough_put(o, "  individual_pitch: true\n");
    }
    if (o->servo && bough_deck_number_or(o->servo, "TPCOn", 0) > 0) {
        bough_left_out(o, "TPCOn: the library controls the pitch from the start");
    }
    double asked = o->servo ? bough_deck_number_or(o->servo, "DLL_DT", step) : step;
    if (fabs(asked - step) > 1e-9) {
        bough_approximated(o, "DLL_DT %g s: the library is called every %g s", asked, step);
    }
    if (mode_of(o, "VSContrl") == LIBRARY || mode_of(o, "PCMode") == LIBRARY) leave_interface(o);
}

// Manoeuvres that begin within the run.
static void note_manoeuvres(bough_openfast *o) {
    double end = bough_deck_number(o->main, "TMax");
    bool brake = bough_deck_whole_or(o->servo, "HSSBrMode", 1) != 0;
    bool library = o->generator == BOUGH_GENERATOR_LIBRARY;
    for (int k = 1; k <= o->n_blade && library; k++) {
        if (bough_deck_number_or(o->servo, bough_deck_kth(o->servo, "TPitManS", k), end) < end)
            bough_other_case(o, "TPitManS(%d): the pitch manoeuvre of blade %d", k, k);
    }
    if (brake && bough_deck_number_or(o->servo, "THSSBrDp", end) < end)
        bough_other_case(o, "THSSBrDp: the brake");
    if (!bough_deck_flag_or(o->elasto, "YawDOF", false) &&
        bough_deck_number_or(o->servo, "TYawManS", end) < end)
        bough_taken(o, "TYawManS: without YawDOF the nacelle does not turn");
}

// Tuned masses and dampers are flags before OpenFAST 2.5.
static const bough_openfast_rest rest[] = {
    {"yaw control", 0, {"YCMode"}},
    {"cable control", 0, {"CCmode"}},
    {"structural control", 0, {"NumBStC", "NumNStC", "NumTStC", "NumSStC", "CompNTMD", "CompTTMD"}},
    {"flaps and other airfoil control", 0, {"AfCmode"}},
};

void bough_openfast_control(bough_openfast *o) {
    if (!bough_is_ok(o->draft->status)) return;
    if (o->generator == BOUGH_GENERATOR_LIBRARY) put_library(o);
    if (o->generator == BOUGH_GENERATOR_LAW) put_law(o);
    if (!o->servo) return;
    if (o->generator == BOUGH_GENERATOR_LIBRARY || o->generator == BOUGH_GENERATOR_LAW) put_switches(o);
    int pitch = mode_of(o, "PCMode");
    if (o->generator == BOUGH_GENERATOR_FREE) {
        bough_taken(o, "TimGenOn: no torque acts on the generator");
    }
    if (pitch != NONE && pitch != LIBRARY && o->generator != BOUGH_GENERATOR_LIBRARY)
        bough_other_case(o, "PCMode %d: the pitch is held", pitch);
    note_manoeuvres(o);
    bough_openfast_leave(o, o->servo, rest, sizeof rest / sizeof *rest, BOUGH_OTHER_CASE);
}
