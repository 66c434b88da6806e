// ElastoDyn and ServoDyn: bodies, joints, the generator.
#include "apps/import/openfast.h"

#include <math.h>
#include <unistd.h>

// -- tower and nacelle ----------------------------------------------------------------------------

static void put_tower(bough_openfast *o, double top_mass) {
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    if (o->rigid_tower) {
        fputs("  - name: tower\n    fidelity: rigid\n    joint: {kind: fixed, parent: ground}\n",
              file);
        return;
    }
    bough_openfast_tower(o, top_mass);
    fputs("  - name: tower\n    fidelity: rod\n    joint: {kind: fixed, parent: ground", file);
    if (o->tower_base != 0) fprintf(file, ", placement: [move z %.10g m]", o->tower_base);
    fprintf(file, "}\n    rod: {table: %s, segments: 20}\n", bough_import_name[BOUGH_IMPORT_TOWER]);
}

static void put_yaw(bough_openfast *o) {
    const bough_deck *e = o->elasto;
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    double yaw = bough_deck_number_or(e, "NacYaw", 0);
    bool turns = bough_deck_flag_or(e, "YawDOF", false) && o->servo;
    fprintf(file, "    joint: {kind: %s, parent: tower", turns ? "revolute, axis: z" : "fixed");
    if (o->rigid_tower || (yaw != 0 && !turns)) {
        fputs(", placement: [", file);
        if (o->rigid_tower) fprintf(file, "move z %.10g m", o->tower_top);
        if (o->rigid_tower && yaw != 0 && !turns) fputs(", ", file);
        if (yaw != 0 && !turns) fprintf(file, "rotate z %.10g deg", yaw);
        fputs("]", file);
    }
    if (turns) {
        fprintf(file, ", stiffness: %.10g, damping: %.10g", bough_deck_number(o->servo, "YawSpr"),
                bough_deck_number(o->servo, "YawDamp"));
        fprintf(file, ", angle: %.10g deg, rest: %.10g deg", yaw,
                bough_deck_number_or(o->servo, "YawNeut", 0));
        bough_draft_note(&o->draft, BOUGH_TAKEN, "yaw bearing with spring and damper");
    } else if (bough_deck_flag_or(e, "YawDOF", false)) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "YawDOF: without ServoDyn the nacelle is held");
    }
    fputs("}\n", file);
}

static void put_nacelle(bough_openfast *o) {
    const bough_deck *e = o->elasto;
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    double mass = bough_deck_number(e, "NacMass"), about_yaw = bough_deck_number(e, "NacYIner");
    double x = bough_deck_number(e, "NacCMxn"), y = bough_deck_number(e, "NacCMyn");
    double z = bough_deck_number(e, "NacCMzn"), polar = about_yaw - mass * (x * x + y * y);
    if (polar < 0) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                         "NacYIner is less than the mass' distance gives: "
                         "no inertia about the nacelle's own centre");
        polar = 0;
    }
    fputs("  - name: nacelle\n    fidelity: rigid\n", file);
    put_yaw(o);
    fprintf(file, "    mass: %.10g kg\n    centre_of_mass: [%.10g, %.10g, %.10g]\n", mass, x, y, z);
    fprintf(file, "    inertia: [%.10g, %.10g, %.10g]\n", polar / 2, polar / 2, polar);
    bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                     "nacelle: inertias about its other axes half of that "
                     "about the yaw axis");
    if (bough_deck_number_or(e, "YawBrMass", 0) != 0) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "YawBrMass %g kg",
                         bough_deck_number(e, "YawBrMass"));
    }
}

// -- rotor ----------------------------------------------------------------------------------------

static double generator_inertia(const bough_openfast *o) {
    double ratio = bough_deck_number(o->elasto, "GBRatio");
    return bough_deck_number(o->elasto, "GenIner") * ratio * ratio;
}

static void put_hub(bough_openfast *o, bool separate) {
    const bough_deck *e = o->elasto;
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    double inertia = bough_deck_number(e, "HubIner"), speed = bough_deck_number(e, "RotSpeed");
    double generator = separate ? 0 : generator_inertia(o);
    double angle = bough_deck_number_or(e, "Azimuth", 0) - bough_deck_number_or(e, "AzimB1Up", 0);
    fprintf(file,
            "  - name: hub\n    fidelity: rigid\n    joint:\n      kind: revolute\n"
            "      parent: nacelle\n      placement: [move z %.10g m, rotate y %.10g deg, "
            "move x %.10g m]\n      axis: x\n",
            bough_deck_number(e, "Twr2Shft"), -bough_deck_number(e, "ShftTilt"),
            bough_deck_number(e, "OverHang"));
    if (angle != 0) fprintf(file, "      angle: %.10g deg\n", angle);
    if (bough_deck_flag_or(e, "GenDOF", true)) {
        fprintf(file, "      speed: %.10g rpm\n", speed);
    } else {
        fprintf(file, "      motion: {speed: %.10g rpm}\n", speed);
        bough_draft_note(&o->draft, BOUGH_TAKEN, "GenDOF False: the rotor turns at %g rpm", speed);
    }
    fprintf(file, "    mass: %.10g kg\n    centre_of_mass: [%.10g, 0, 0]\n",
            bough_deck_number(e, "HubMass"), bough_deck_number_or(e, "HubCM", 0));
    fprintf(file, "    inertia: [%.10g, %.10g, %.10g]\n", inertia + generator, inertia / 2,
            inertia / 2);
    bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                     "hub: inertias about its other axes half of HubIner");
}

static void put_generator(bough_openfast *o) {
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    fprintf(file,
            "  - name: generator\n    fidelity: rigid\n    joint: {kind: revolute, axis: x, "
            "parent: hub, stiffness: %.10g, damping: %.10g}\n    inertia: [%.10g, 0, 0]\n",
            bough_deck_number(o->elasto, "DTTorSpr"), bough_deck_number(o->elasto, "DTTorDmp"),
            generator_inertia(o));
    bough_draft_note(&o->draft, BOUGH_TAKEN,
                     "drive train: the generator turns against the hub on a "
                     "spring and damper");
}

static void put_blade(bough_openfast *o, int k) {
    char pitch[48], cone[48], mass[48];
    snprintf(pitch, sizeof pitch, "BlPitch(%d)|BlPitch%d", k, k);
    snprintf(cone, sizeof cone, "PreCone(%d)|PreCone%d", k, k);
    snprintf(mass, sizeof mass, "TipMass(%d)|TipMass%d", k, k);
    fprintf(o->draft.file[BOUGH_IMPORT_SCENE],
            "  - name: blade%d\n    fidelity: %s\n    joint: {%s, parent: hub, placement: "
            "[rotate x %.10g deg, rotate y %.10g deg, move z %.10g m]}\n    pitch: %.10g deg\n"
            "    rod: {table: %s, segments: 48}\n",
            k, o->rigid_blade ? "rigid" : "rod",
            o->library ? "kind: revolute, axis: z, motion: {angle: 0 deg}" : "kind: fixed",
            360.0 * (k - 1) / o->n_blade, bough_deck_number(o->elasto, cone), o->hub_radius,
            bough_deck_number(o->elasto, pitch), bough_import_name[BOUGH_IMPORT_BLADE]);
    if (bough_deck_number_or(o->elasto, mass, 0) != 0) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "TipMass(%d)", k);
    }
}

void bough_openfast_library(bough_openfast *o) {
    if (!bough_is_ok(o->draft.status) || !o->servo) return;
    int torque = bough_deck_whole_or(o->servo, "VSContrl", 0);
    int pitch = bough_deck_whole_or(o->servo, "PCMode", 0);
    if (torque != 5 && pitch != 5) return;
    const char *path = bough_deck_path(o->servo, "DLL_FileName");
    if (!bough_is_ok(o->draft.status)) return;
    if (access(path, R_OK) != 0 || !bough_deck_flag_or(o->elasto, "GenDOF", true)) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "DLL_FileName: no library %s", path);
        return;
    }
    o->library = path;
    bough_draft_note(&o->draft, BOUGH_TAKEN, "controller: %s, by its path", path);
    if (torque != pitch) {
        bough_draft_note(&o->draft, BOUGH_APPROXIMATED, "the library steers both torque and pitch");
    }
}

bool bough_openfast_controlled(const bough_openfast *o) {
    if (o->library) return true;
    return o->servo && bough_deck_flag_or(o->elasto, "GenDOF", true) &&
           bough_deck_whole_or(o->servo, "VSContrl", 0) == 1;
}

static void put_rotor(bough_openfast *o) {
    const bough_deck *e = o->elasto;
    bool free = bough_deck_flag_or(e, "GenDOF", true);
    bool twists = bough_deck_flag_or(e, "DrTrDOF", false);
    bool separate = twists && free && !bough_openfast_controlled(o);
    put_hub(o, separate);
    if (separate)
        put_generator(o);
    else if (twists)
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "DrTrDOF: the drive train is rigid");
    for (int k = 1; k <= o->n_blade; k++)
        put_blade(o, k);
    fprintf(o->draft.file[BOUGH_IMPORT_SCENE], "turbine:\n  rotor: hub\n  blades: [blade1%s%s]\n",
            o->n_blade > 1 ? ", blade2" : "", o->n_blade > 2 ? ", blade3" : "");
}

static void note_left(bough_openfast *o) {
    static const char *const freedoms[] = {"PtfmSgDOF", "PtfmSwDOF", "PtfmHvDOF", "PtfmRDOF",
                                           "PtfmPDOF",  "PtfmYDOF",  "Furling"};
    static const char *const starts[] = {"OoPDefl", "IPDefl", "TTDspFA", "TTDspSS"};
    for (size_t i = 0; i < sizeof freedoms / sizeof *freedoms; i++) {
        if (bough_deck_flag_or(o->elasto, freedoms[i], false)) {
            bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "%s", freedoms[i]);
        }
    }
    for (size_t i = 0; i < sizeof starts / sizeof *starts; i++) {
        if (bough_deck_number_or(o->elasto, starts[i], 0) != 0) {
            bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "%s: the run starts undeformed", starts[i]);
        }
    }
    if (o->n_blade == 2 && bough_deck_flag_or(o->elasto, "TeetDOF", false)) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "TeetDOF: the hub is rigid");
    }
    if (bough_deck_flag_or(o->elasto, "PitchDOF", false)) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "PitchDOF: the pitch bearings are rigid");
    }
    if (bough_deck_whole_or(o->elasto, "YawFrctMod", 0) != 0) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "YawFrctMod: the yaw bearing has no friction");
    }
    if (bough_deck_number_or(o->elasto, "GBoxEff", 100) != 100) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "GBoxEff: the gearbox loses nothing");
    }
}

void bough_openfast_bodies(bough_openfast *o) {
    if (!bough_is_ok(o->draft.status)) return;
    const bough_deck *e = o->elasto;
    double top = bough_deck_number(e, "NacMass") + bough_deck_number(e, "HubMass") +
                 o->n_blade * o->blade_mass;
    fputs("bodies:\n", o->draft.file[BOUGH_IMPORT_SCENE]);
    put_tower(o, top);
    put_nacelle(o);
    put_rotor(o);
    note_left(o);
}

// -- control --------------------------------------------------------------------------------------

static void put_library(bough_openfast *o) {
    FILE *file = o->draft.file[BOUGH_IMPORT_SCENE];
    fprintf(file,
            "control:\n  kind: bladed\n  rate: 50 Hz\n  gear_ratio: %.10g\n"
            "  efficiency: %.10g\n  library: ",
            bough_deck_number(o->elasto, "GBRatio"),
            bough_deck_number_or(o->servo, "GenEff", 100) / 100);
    bough_import_path(file, o->library);
    if (bough_deck_line(o->servo, "DLL_InFile") >= 0) {
        const char *input = bough_deck_path(o->servo, "DLL_InFile");
        fputs("\n  input: ", file);
        bough_import_path(file, input);
    }
    fputc('\n', file);
}

static void put_law(bough_openfast *o) {
    const bough_deck *s = o->servo;
    double rpm = acos(-1.0) / 30, rated = bough_deck_number(s, "VS_RtGnSp") * rpm;
    double torque = bough_deck_number(s, "VS_RtTq"), slip = bough_deck_number(s, "VS_SlPc") / 100;
    double gain = bough_deck_number(s, "VS_Rgn2K") / (rpm * rpm);
    if (!(rated > 0 && torque > 0 && slip > 0 && gain >= 0 && gain * rated * rated <= torque)) {
        bough_deck_fail(s, bough_deck_line(s, "VS_RtGnSp"),
                        "VS_RtGnSp, VS_RtTq, VS_Rgn2K, VS_SlPc: expected positive values, and "
                        "VS_Rgn2K VS_RtGnSp^2 at most VS_RtTq");
    }
    fprintf(o->draft.file[BOUGH_IMPORT_SCENE],
            "control:\n  kind: variable-speed\n  rate: 50 Hz\n  gear_ratio: %.10g\n"
            "  efficiency: %.10g\n  pitch: false\n  law:\n    corner: 100 rad/s\n    cut_in: 0\n    optimal_from: 1e-3 rad/s\n"
            "    optimal_gain: %.10g\n    rated_speed: %.10g rad/s\n    rated_power: %.10g\n"
            "    slip: %.10g\n    most_torque: %.10g\n    torque_rate: 1e9\n    power_pitch: 100 rad\n",
            bough_deck_number(o->elasto, "GBRatio"), bough_deck_number(s, "GenEff") / 100, gain,
            rated, torque * rated, slip, torque);
    bough_draft_note(&o->draft, BOUGH_TAKEN,
                     "the generator's torque over its speed up to the rated one");
    bough_draft_note(&o->draft, BOUGH_APPROXIMATED,
                     "above the rated speed constant power, not torque");
    if (bough_deck_number_or(s, "TimGenOn", 0) > 0) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "TimGenOn: the generator works from the start");
    }
}

void bough_openfast_control(bough_openfast *o) {
    if (!bough_is_ok(o->draft.status) || !o->servo) return;
    int torque = bough_deck_whole_or(o->servo, "VSContrl", 0);
    int pitch = bough_deck_whole_or(o->servo, "PCMode", 0);
    if (o->library) {
        put_library(o);
    } else if (bough_openfast_controlled(o)) {
        put_law(o);
    } else if (torque != 0) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "VSContrl %d: no torque acts on the generator",
                         torque);
    } else if (bough_deck_number_or(o->servo, "TimGenOn", 0) < bough_deck_number(o->main, "TMax")) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "GenModel %d: no torque acts on the generator",
                         bough_deck_whole_or(o->servo, "GenModel", 0));
    }
    if (pitch != 0 && !o->library)
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "PCMode %d: the pitch is held", pitch);
    if (bough_deck_whole_or(o->servo, "YCMode", 0) != 0) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "YCMode: yaw control");
    }
    if (bough_deck_whole_or(o->servo, "HSSBrMode", 0) != 0) {
        bough_draft_note(&o->draft, BOUGH_LEFT_OUT, "HSSBrMode: the brake");
    }
}
