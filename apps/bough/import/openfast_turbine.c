// ElastoDyn: bodies and joints.
#include "apps/bough/import/openfast.h"

// -- tower and nacelle ----------------------------------------------------------------------------

static void put_tower(bough_openfast *o) {
    if (o->rigid_tower) {
        bough_put(o, "  - name: tower\n    fidelity: rigid\n    joint: {kind: fixed, parent: ground}\n");
        bough_taken(o, "TwFADOF1, TwFADOF2, TwSSDOF1, TwSSDOF2 False: the tower is rigid");
        return;
    }
    bough_openfast_tower(o);
    bough_draft_tower(o->draft, o->tower_base);
}

static bool yaws(const bough_openfast *o) {
    return bough_deck_flag_or(o->elasto, "YawDOF", false) && o->servo;
}

static double neutral_yaw(const bough_openfast *o) { return bough_deck_number_or(o->servo, "YawNeut", 0); }

// Whether a drive rotates the bearing's spring during the run.
static bool has_yaw_drive(const bough_openfast *o) {
    double end = bough_deck_number(o->main, "TMax");
    return yaws(o) && bough_deck_number_or(o->servo, "TYawManS", end) < end &&
           bough_deck_number_or(o->servo, "NacYawF", neutral_yaw(o)) != neutral_yaw(o);
}

// Writes the speed of a joint that rotates by `way` [deg] from `start` [s] on at a constant rate [deg/s],
// with ramps of a macro step; `key`: the manoeuvre in the deck.
static void put_manoeuvre(bough_openfast *o, const char *key, double way, double start, double rate) {
    double speed = copysign(rate, way), lasts = way / speed;
    double half = fmin(fmin(o->draft->macro_step / 2, lasts / 4), start > 0 ? start / 2 : HUGE_VAL);
    if (!(fabs(rate) > 0) || !(start >= 0)) {
        bough_deck_refuse(o->servo, key, "expected a time from 0 on and a rate that is not zero");
    }
    bough_put(o, "motion: {speed: {times: [");
    if (start > 0) bough_put(o, "%.10g, %.10g, ", start - half, start + half);
    if (start == 0) bough_put(o, "0, ");
    bough_put(o, "%.10g, %.10g], values: [", start + lasts - half, start + lasts + half);
    if (start > 0) bough_put(o, "0 deg/s, ");
    bough_put(o, "%.10g deg/s, %.10g deg/s, 0 deg/s]}}", speed, speed);
    bough_taken(o, "%.*s: turns by %g deg from %g s on", (int)strcspn(key, "|"), key, fabs(way), start);
}

// A driven body between tower and nacelle, to which the spring of the yaw bearing is fixed.
static void put_yaw_drive(bough_openfast *o) {
    bough_put(o, "  - name: yaw # drive, against which the nacelle turns\n    fidelity: rigid\n"
                 "    joint: {kind: revolute, axis: z, parent: tower, ");
    if (o->rigid_tower) bough_put(o, "placement: [move z %.10g m], ", o->tower_top);
    bough_put(o, "angle: %.10g deg,\n            ", neutral_yaw(o));
    put_manoeuvre(o, "TYawManS", bough_deck_number(o->servo, "NacYawF") - neutral_yaw(o),
                  bough_deck_number(o->servo, "TYawManS"), bough_deck_number(o->servo, "YawManRat"));
    bough_put(o, "}\n");
}

static void put_yaw(bough_openfast *o) {
    const bough_deck *e = o->elasto;
    double yaw = bough_deck_number_or(e, "NacYaw", 0);
    bool turns = yaws(o), driven = has_yaw_drive(o), high = o->rigid_tower && !driven;
    bough_put(o, "    joint: {kind: %s, parent: %s", turns ? "revolute, axis: z" : "fixed",
              driven ? "yaw" : "tower");
    if (high || (yaw != 0 && !turns)) {
        bough_put(o, ", placement: [");
        if (high) bough_put(o, "move z %.10g m", o->tower_top);
        if (high && yaw != 0 && !turns) bough_put(o, ", ");
        if (yaw != 0 && !turns) bough_put(o, "rotate z %.10g deg", yaw);
        bough_put(o, "]");
    }
    if (turns) {
        bough_put(o, ", stiffness: %.10g, damping: %.10g", bough_deck_number(o->servo, "YawSpr"),
                  bough_deck_number(o->servo, "YawDamp"));
        double neutral = neutral_yaw(o);
        bough_put(o, ", angle: %.10g deg, rest: %.10g deg", driven ? yaw - neutral : yaw,
                  driven ? 0 : neutral);
        bough_taken(o, "yaw bearing with spring and damper");
    } else if (bough_deck_flag_or(e, "YawDOF", false)) {
        bough_left_out(o, "YawDOF: without ServoDyn the yaw angle is constant");
    }
    bough_put(o, "}\n");
}

// The yaw bearing's mass sits at the tower's top, the origin of the nacelle's frame, and so moves the
// common centre of mass towards it.
static void put_nacelle(bough_openfast *o) {
    const bough_deck *e = o->elasto;
    double mass = bough_deck_number(e, "NacMass"), about_yaw = bough_deck_number(e, "NacYIner");
    double bearing = bough_deck_number_or(e, "YawBrMass", 0), sum = mass + bearing;
    double fraction = sum > 0 ? mass / sum : 0;
    double x = fraction * bough_deck_number(e, "NacCMxn"), y = fraction * bough_deck_number(e, "NacCMyn");
    double z = fraction * bough_deck_number(e, "NacCMzn"), polar = about_yaw - sum * (x * x + y * y);
    if (polar < 0) {
        bough_approximated(o, "NacYIner is less than the mass times its squared distance: zero inertia about "
                              "the nacelle's centre of mass");
        polar = 0;
    }
    if (has_yaw_drive(o)) put_yaw_drive(o);
    bough_put(o, "  - name: nacelle\n    fidelity: rigid\n");
    put_yaw(o);
    bough_put(o, "    mass: %.10g kg\n    centre_of_mass: [%.10g, %.10g, %.10g]\n", sum, x, y, z);
    bough_put(o, "    inertia: [%.10g, %.10g, %.10g]\n", polar / 2, polar / 2, polar);
    bough_approximated(o, "nacelle: inertias about its other axes half of that about the yaw axis");
    if (bearing > 0) {
        bough_taken(o, "YawBrMass %g kg, with the nacelle", bearing);
    }
}

// -- shaft and hub --------------------------------------------------------------------------------

double bough_openfast_generator_inertia(const bough_openfast *o) {
    double ratio = bough_deck_number(o->elasto, "GBRatio");
    return bough_deck_number(o->elasto, "GenIner") * ratio * ratio;
}

bool bough_openfast_shaft_twists(const bough_openfast *o) {
    return bough_deck_flag_or(o->elasto, "DrTrDOF", false) && bough_openfast_generator_inertia(o) > 0 &&
           bough_deck_number(o->elasto, "DTTorSpr") > 0;
}

// The joint on the nacelle, which turns with the generator's speed.
static void put_main_joint(bough_openfast *o) {
    const bough_deck *e = o->elasto;
    double speed = bough_deck_number(e, "RotSpeed");
    double angle = bough_deck_number_or(e, "Azimuth", 0) - bough_deck_number_or(e, "AzimB1Up", 0);
    bough_put(o,
              "    joint:\n      kind: revolute\n      parent: nacelle\n      placement: [move z %.10g m, "
              "rotate y %.10g deg, move x %.10g m]\n      axis: x\n",
              bough_deck_number(e, "Twr2Shft"), -bough_deck_number(e, "ShftTilt"),
              bough_deck_number(e, "OverHang"));
    if (angle != 0) bough_put(o, "      angle: %.10g deg\n", angle);
    if (o->unknown_torque) {
        bough_put(o, "      # This scene lacks %s:\n      # the speed of the start is kept.\n",
                  o->unknown_torque);
    }
    bough_put(o,
              o->generator == BOUGH_GENERATOR_DRIVEN ? "      motion: {speed: %.10g rpm}\n"
                                                     : "      speed: %.10g rpm\n",
              speed);
}

static void put_generator(bough_openfast *o, bool twists) {
    bough_put(o, "  - name: generator # on the slow shaft\n    fidelity: rigid\n");
    put_main_joint(o);
    bough_put(o, "    inertia: [%.10g, 0, 0]\n", bough_openfast_generator_inertia(o));
    bough_taken(o, "drive train: %s between hub and generator", twists ? "spring and damper" : "rigid");
}

static bool teeters(const bough_openfast *o) {
    return o->n_blade == 2 && bough_deck_flag_or(o->elasto, "TeetDOF", false);
}

// The pin about which a two-bladed hub teeters, on the shaft.
static void put_teeter(bough_openfast *o, const char *shaft) {
    const bough_deck *e = o->elasto;
    bool standard = bough_deck_whole_or(e, "TeetMod", 0) == 1;
    double stop = standard ? bough_deck_number_or(e, "TeetHStP", 0) : 0;
    double stiffness = standard ? bough_deck_number_or(e, "TeetHSSp", 0) : 0;
    double damping = standard ? bough_deck_number_or(e, "TeetDmp", 0) : 0;
    bough_put(o,
              "    joint: {kind: revolute, axis: y, parent: %s, placement: [rotate x %.10g deg], "
              "angle: %.10g deg",
              shaft, -bough_deck_number_or(e, "Delta3", 0), bough_deck_number_or(e, "TeetDefl", 0));
    if (damping > 0) bough_put(o, ", damping: %.10g", damping);
    bool stops = stop > 0 && stop < 90 && stiffness > 0;
    if (stops) {
        bough_put(o, ", stop: [%.10g rad, %.10g rad], stop_stiffness: %.10g", -stop * BOUGH_DEGREE,
                  stop * BOUGH_DEGREE, stiffness);
    }
    bough_put(o, "}\n");
    bough_taken(o, "TeetDOF: the hub teeters%s%s", damping > 0 ? ", with its damper" : "",
                stops ? ", with hard stops" : "");
    if (bough_deck_whole_or(e, "TeetMod", 0) == 2)
        bough_left_out(o, "TeetMod 2: the user's own routine of springs and dampers");
    bool more = bough_deck_number_or(e, "TeetCDmp", 0) != 0 || bough_deck_number_or(e, "TeetSSSp", 0) > 1;
    if (standard && (more || bough_deck_number_or(e, "TeetDmpP", 0) != 0)) {
        bough_left_out(o, "teeter: Coulomb damping, soft stops, the damper's position");
    }
}

static double undersling(const bough_openfast *o) {
    return o->n_blade == 2 ? bough_deck_number_or(o->elasto, "UndSling", 0) : 0;
}

static bool has_generator(const bough_openfast *o) { return bough_openfast_generator_inertia(o) > 0; }

// The joint of the shaft, with the nacelle or with the generator.
static void put_shaft_joint(bough_openfast *o, bool twists) {
    if (twists) {
        bough_put(o,
                  "    joint: {kind: revolute, axis: x, parent: generator, stiffness: %.10g, "
                  "damping: %.10g}\n",
                  bough_deck_number(o->elasto, "DTTorSpr"), bough_deck_number(o->elasto, "DTTorDmp"));
    } else if (has_generator(o)) {
        bough_put(o, "    joint: {kind: fixed, parent: generator}\n");
    } else {
        put_main_joint(o);
    }
}

// The hub's frame is on the shaft's axis, of a teetering hub at the pin; HubCM counts from the apex.
static void put_hub(bough_openfast *o, bool twists) {
    const bough_deck *e = o->elasto;
    double mass = bough_deck_number(e, "HubMass"), about = bough_deck_number(e, "HubIner"),
           others = about / 2;
    double arm = bough_deck_number_or(e, "HubCM", 0) - undersling(o), along = others;
    bool generator_is_shaft = has_generator(o) && !twists;
    if (teeters(o) && !generator_is_shaft) {
        bough_put(o, "  - name: shaft\n    fidelity: rigid\n");
        put_shaft_joint(o, twists);
    }
    bough_put(o, "  - name: hub\n    fidelity: rigid\n");
    if (teeters(o)) {
        put_teeter(o, generator_is_shaft ? "generator" : "shaft");
    } else {
        put_shaft_joint(o, twists);
    }
    if (o->n_blade == 2) { // a cylinder along the blades, whose inertia is given about the teeter axis
        double cosine = cos(bough_deck_number_or(e, "Delta3", 0) * BOUGH_DEGREE);
        about = others = (about - mass * arm * arm) / (cosine * cosine);
        along = 0;
        if (!(about >= 0))
            bough_deck_refuse(e, "HubIner", "expected at least %g, that of HubMass at its place",
                              mass * arm * arm);
    } else {
        bough_approximated(o, "hub: inertias about its other axes half of HubIner");
    }
    bough_put(o, "    mass: %.10g kg\n    centre_of_mass: [%.10g, 0, 0]\n", mass, arm);
    bough_put(o, "    inertia: [%.10g, %.10g, %.10g]\n", about, others, along);
}

// -- blades ---------------------------------------------------------------------------------------

static void put_tip(bough_openfast *o, int k) {
    double mass = bough_deck_number_or(o->elasto, bough_deck_kth(o->elasto, "TipMass", k), 0);
    if (mass == 0) return;
    if (o->beamdyn) {
        bough_left_out(o, "TipMass(%d): only for ElastoDyn's blades, not for BeamDyn's", k);
        return;
    }
    bough_put(o,
              "  - {name: tip%d, fidelity: rigid, joint: {kind: fixed, parent: blade%d}, "
              "mass: %.10g kg}\n",
              k, k, mass);
    bough_taken(o, "TipMass(%d): %g kg", k, mass);
}

// Where nothing controls the pitch, OpenFAST 5 holds the controller's neutral one from the start [deg].
static double pitch_of(const bough_openfast *o, int k) {
    double pitch = bough_deck_number(o->elasto, bough_deck_kth(o->elasto, "BlPitch", k));
    bool held = o->servo && bough_deck_whole_or(o->servo, "PCMode", 0) == 0;
    return held ? bough_deck_number_or(o->servo, bough_deck_kth(o->servo, "PitNeut", k), pitch) : pitch;
}

// The joint of a blade: steered by a library, turned by a manoeuvre, or fixed. Its angle is that of the pitch
// with the opposite sign.
static void put_blade_joint(bough_openfast *o, int k) {
    const bough_deck *e = o->elasto, *s = o->servo;
    const char *start = bough_deck_kth(e, "TPitManS", k), *rate = bough_deck_kth(e, "PitManRat", k);
    double from = pitch_of(o, k);
    double to = s ? bough_deck_number_or(s, bough_deck_kth(s, "BlPitchF", k), from) : from;
    double end = bough_deck_number(o->main, "TMax");
    if (o->generator == BOUGH_GENERATOR_LIBRARY) {
        bough_put(o, "kind: revolute, axis: z, motion: {angle: 0 deg}");
    } else if (s && bough_deck_number_or(s, start, end) < end && to != from) {
        bough_put(o, "kind: revolute, axis: z, ");
        put_manoeuvre(o, start, from - to, bough_deck_number(s, start), bough_deck_number(s, rate));
    } else {
        bough_put(o, "kind: fixed");
    }
}

static void put_blade(bough_openfast *o, int k) {
    const bough_deck *e = o->elasto;
    bough_put(o, "  - name: blade%d\n    fidelity: %s\n    joint: {", k, o->rigid_blade ? "rigid" : "rod");
    put_blade_joint(o, k);
    bough_put(o, ", parent: hub, placement: [");
    if (undersling(o) != 0) bough_put(o, "move x %.10g m, ", -undersling(o));
    bough_put(o, "rotate x %.10g deg, rotate y %.10g deg, move z %.10g m]}\n    pitch: %.10g deg\n",
              360.0 * (k - 1) / o->n_blade, bough_deck_number(e, bough_deck_kth(e, "PreCone", k)),
              o->hub_radius, pitch_of(o, k));
    bough_draft_blade_rod(o->draft);
    put_tip(o, k);
}

static void put_rotor(bough_openfast *o) {
    bool twists = bough_openfast_shaft_twists(o);
    if (has_generator(o)) put_generator(o, twists);
    if (!twists && bough_deck_flag_or(o->elasto, "DrTrDOF", false)) {
        bough_left_out(o, "DrTrDOF: the shaft is rigid, because the generator's inertia or the spring is "
                          "zero");
    }
    put_hub(o, twists);
    for (int k = 1; k <= o->n_blade; k++) put_blade(o, k);
    bough_draft_turbine(o->draft, has_generator(o) ? "generator" : teeters(o) ? "shaft" : "hub", o->n_blade);
}

static const bough_openfast_rest rest[] = {
    {NULL, 0, {"PtfmSgDOF", "PtfmSwDOF", "PtfmHvDOF", "PtfmRDOF", "PtfmPDOF", "PtfmYDOF"}},
    {"the run starts undeformed, without initial displacement",
     0,
     {"OoPDefl", "IPDefl", "TTDspFA", "TTDspSS"}},
    {"the pitch bearings are rigid", 0, {"PitchDOF"}},
    {"the gearbox has no losses", 100, {"GBoxEff"}},
};

// A platform that cannot move keeps its displacement of the start.
static void leave_platform(bough_openfast *o) {
    static const char *const start[][2] = {{"PtfmSurge", "PtfmSgDOF"}, {"PtfmSway", "PtfmSwDOF"},
                                           {"PtfmHeave", "PtfmHvDOF"}, {"PtfmRoll", "PtfmRDOF"},
                                           {"PtfmPitch", "PtfmPDOF"},  {"PtfmYaw", "PtfmYDOF"}};
    for (size_t i = 0; i < sizeof start / sizeof *start; i++) {
        if (bough_deck_number_or(o->elasto, start[i][0], 0) == 0) continue;
        bool moves = bough_deck_flag_or(o->elasto, start[i][1], false);
        bough_draft_note(o->draft, moves ? BOUGH_LEFT_OUT : BOUGH_OTHER_CASE,
                         "%s: the platform stands upright in its place", start[i][0]);
    }
}

void bough_openfast_bodies(bough_openfast *o) {
    if (!bough_is_ok(o->draft->status)) return;
    const bough_deck *e = o->elasto;
    bough_put(o, "bodies:\n");
    put_tower(o);
    put_nacelle(o);
    put_rotor(o);
    if (bough_deck_whole_or(e, "YawFrctMod", 0) != 0)
        bough_other_case(o, "YawFrctMod: the friction of the yaw bearing");
    leave_platform(o);
    bough_openfast_leave(o, e, rest, sizeof rest / sizeof *rest, BOUGH_LEFT_OUT);
}
