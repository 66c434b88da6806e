#include "apps/bough/model/channel_table.h"

// clang-format off
// A channel without OpenFAST's name, and with it; the same as component i of a vector, from 1. Three channels along or
// about x, y and z, with small letters in their names and with capitals; `text` and `after` enclose the axis.
#define OURS(name, unit, text) {name, unit, text, NULL, 0, 0}
#define SAME(name, unit, text) {name, unit, text, name, 0, 0}
#define OURS_OF(i, name, unit, text) {name, unit, text, NULL, i, 0}
#define SAME_OF(i, name, unit, text) {name, unit, text, name, i, 0}
#define XYZ(name, end, unit, text, after)                                                          \
    OURS_OF(1, name "x" end, unit, text "x" after), OURS_OF(2, name "y" end, unit, text "y" after), \
    OURS_OF(3, name "z" end, unit, text "z" after)
#define SAME_XYZ(name, end, unit, text, after)                                                     \
    SAME_OF(1, name "x" end, unit, text "x" after), SAME_OF(2, name "y" end, unit, text "y" after), \
    SAME_OF(3, name "z" end, unit, text "z" after)
#define AXES(name, unit, text, after)                                                              \
    OURS_OF(1, name "X", unit, text "x" after), OURS_OF(2, name "Y", unit, text "y" after),        \
    OURS_OF(3, name "Z", unit, text "z" after)
// The twelve channels of a place on a rod: P before, S behind "TDx"; VECTOR and ROW with or without OpenFAST's name.
#define SECTION(P, S, VECTOR, ROW)                                                                 \
    VECTOR(P "TD", S, "m", "displacement along the body's ", ""),                                  \
    VECTOR(P "RD", S, "deg", "rotation vector of the section, ", " component in the body's axes"), \
    ROW(1, P "FLx" S, "kN", "force of the outer part on the inner part along x of the section axes"), \
    ROW(2, P "FLy" S, "kN", "force of the outer part on the inner part along y of the section axes"), \
    ROW(3, P "FLz" S, "kN", "force of the outer part on the inner part along z of the section axes, positive in tension"), \
    ROW(1, P "MLx" S, "kN-m", "moment of the outer part on the inner part about x of the section axes"), \
    ROW(2, P "MLy" S, "kN-m", "moment of the outer part on the inner part about y of the section axes"), \
    ROW(3, P "MLz" S, "kN-m", "moment of the outer part on the inner part about z of the section axes: torsion")
// Number and rows of a family.
#define ROWS(...)                                                                                  \
    (int)(sizeof((const bough_channel_row[]){__VA_ARGS__}) / sizeof(bough_channel_row)),             \
    (const bough_channel_row[]){__VA_ARGS__}
static const char body[] = "{a}: the body that the joint carries", named[] = "{a}: its name",
                  numbered[] = "{a}: number of the blade in turbine.blades, from 1";
static const bough_channel_family families[BOUGH_CHANNEL_PARTS] = {
    [BOUGH_CHANNELS_ROTOR] = {"Rotor of a turbine", NULL, ROWS(
        SAME("RotSpeed", "rpm", "speed of the hub about the shaft, positive about the axis of the rotor's joint: of that joint and of a joint between generator and hub"),
        SAME("Azimuth", "deg", "angle of the hub about the shaft, from 0 to 360; 0 as the scene places the blades (OpenFAST: AzimB1Up 0)"))},
    [BOUGH_CHANNELS_REVOLUTE] = {"Revolute joint other than the rotor's", body, ROWS(
        OURS("{a}Pos", "deg", "angle of the joint about its axis"),
        OURS("{a}Vel", "deg/s", "rate of the angle"))},
    [BOUGH_CHANNELS_PRISMATIC] = {"Prismatic joint", body, ROWS(
        OURS("{a}Pos", "m", "displacement of the joint along its axis"),
        OURS("{a}Vel", "m/s", "rate of the displacement"))},
    [BOUGH_CHANNELS_CYLINDRICAL] = {"Cylindrical joint", body, ROWS(
        OURS("{a}Pos", "m", "displacement along the axis"),
        OURS("{a}Vel", "m/s", "rate of the displacement"),
        OURS("{a}AngPos", "deg", "angle about the axis"),
        OURS("{a}AngVel", "deg/s", "rate of the angle"))},
    [BOUGH_CHANNELS_UNIVERSAL] = {"Universal joint", body, ROWS(
        OURS("{a}Ang1Pos", "deg", "angle about the first axis"),
        OURS("{a}Ang1Vel", "deg/s", "rate of the first angle"),
        OURS("{a}Ang2Pos", "deg", "angle about the second axis"),
        OURS("{a}Ang2Vel", "deg/s", "rate of the second angle"))},
    [BOUGH_CHANNELS_PLANAR] = {"Planar joint", body, ROWS(
        OURS("{a}1Pos", "m", "displacement along the first axis after the normal, in the order x, y, z, x"),
        OURS("{a}1Vel", "m/s", "rate of the first displacement"),
        OURS("{a}2Pos", "m", "displacement along the second axis after the normal"),
        OURS("{a}2Vel", "m/s", "rate of the second displacement"),
        OURS("{a}AngPos", "deg", "angle about the normal"),
        OURS("{a}AngVel", "deg/s", "rate of the angle"))},
    [BOUGH_CHANNELS_FREE] = {"Body on a free joint", body, ROWS(
        AXES("{a}Pos", "m", "position of the body's frame along ground ", ""),
        AXES("{a}Vel", "m/s", "velocity of the body's frame along ground ", ""))},
    [BOUGH_CHANNELS_TURNING] = {"Body on a free or a spherical joint", body, ROWS(
        XYZ("{a}DirX", "", "-", "", " component of the body's x axis, ground axes"),
        XYZ("{a}DirZ", "", "-", "", " component of the body's z axis, ground axes"),
        AXES("{a}Omega", "deg/s", "angular velocity of the body about ground ", ""))},
    [BOUGH_CHANNELS_DRIVE_TORQUE] = {"Joint with prescribed angle or angular speed", body, ROWS(
        OURS("{a}Trq", "N-m", "torque on the body about the axis that the prescribed motion needs"))},
    [BOUGH_CHANNELS_DRIVE_FORCE] = {"Joint with prescribed displacement or speed", body, ROWS(
        OURS("{a}Frc", "N", "force on the body along the axis that the prescribed motion needs"))},
    [BOUGH_CHANNELS_DRIVE_UNIVERSAL] = {"Universal joint with a prescribed angle",
        "{a}: the body that the joint carries; {b}: 1 or 2, the axis", ROWS(
        OURS("{a}Trq{b}", "N-m", "torque on the body about the axis that the prescribed motion needs"))},
    [BOUGH_CHANNELS_SPRING] = {"Spring", named, ROWS(
        OURS("{a}Len", "m", "length of the spring"),
        OURS("{a}Frc", "N", "force of the spring, positive in tension"))},
    [BOUGH_CHANNELS_BUSHING] = {"Bushing", named, ROWS(
        AXES("{a}Frc", "N", "force on the second body, ", " axis of the first body"),
        AXES("{a}Mom", "N-m", "moment on the second body, ", " axis of the first body"))},
    [BOUGH_CHANNELS_CLOSURE] = {"Closure", named, ROWS(
        XYZ("{a}F", "", "N", "force on the body 'to', ", " axis of the joint's frame there"),
        XYZ("{a}M", "", "N-m", "moment on the body 'to', ", " axis of the joint's frame there"))},
    [BOUGH_CHANNELS_MARKER] = {"Marker", named, ROWS(
        AXES("{a}", "m", "position of the point along ground ", ""))},
    [BOUGH_CHANNELS_BLADE] = {"Blade of a turbine", numbered, ROWS(
        SAME_OF(1, "OoPDefl{a}", "m", "displacement of the tip along x before the pitch: downwind"),
        SAME_OF(2, "IPDefl{a}", "m", "displacement of the tip along y before the pitch"),
        {"TwstDefl{a}", "deg", "third component of the rotation vector of the tip's section, blade axes", "TipRDzb{a}", 0, 0},
        SAME_XYZ("TipD", "b{a}", "m", "displacement of the tip along the blade's ", ""),
        SAME_XYZ("RootF", "b{a}", "kN", "force of the blade on the hub along the blade's ", ""),
        SAME_OF(1, "RootMxb{a}", "kN-m", "moment of the blade on the hub at the root, about the blade's x: edgewise"),
        SAME_OF(2, "RootMyb{a}", "kN-m", "moment of the blade on the hub at the root, about the blade's y: flapwise"),
        SAME_OF(3, "RootMzb{a}", "kN-m", "moment of the blade on the hub at the root, about the blade's z: torsion"))},
    [BOUGH_CHANNELS_TOWER] = {"Tower: rods that carry a turbine's rotor", NULL, ROWS(
        SAME_OF(1, "TTDspFA", "m", "displacement of the tower's top along its x"),
        SAME_OF(2, "TTDspSS", "m", "displacement of the tower's top along its y"),
        SAME_OF(3, "TTDspAx", "m", "displacement of the tower's top along its z"),
        SAME_OF(1, "TTDspRoll", "deg", "rotation vector of the tower's top, x component"),
        SAME_OF(2, "TTDspPtch", "deg", "rotation vector of the tower's top, y component"),
        SAME_OF(3, "TTDspTwst", "deg", "rotation vector of the tower's top, z component"),
        SAME_XYZ("TwrBsF", "t", "kN", "force of the tower on the foundation along the tower's ", ""),
        SAME_OF(1, "TwrBsMxt", "kN-m", "moment of the tower on the foundation about the tower's x: side to side"),
        SAME_OF(2, "TwrBsMyt", "kN-m", "moment of the tower on the foundation about the tower's y: fore and aft"),
        SAME_OF(3, "TwrBsMzt", "kN-m", "moment of the tower on the foundation about the tower's z: torsion"))},
    [BOUGH_CHANNELS_TIP] = {"Any other body with a rod", named, ROWS(
        AXES("{a}Tip", "m", "position of the rod's end along ground ", ""))},
    [BOUGH_CHANNELS_FMU] = {"Body of fidelity fmu", named, ROWS(
        XYZ("{a}F", "", "N", "force of the FMU on the body that carries it, ", " axis of its frame"),
        XYZ("{a}M", "", "N-m", "moment of the FMU about its frame's origin, ", " axis of its frame"))},
    [BOUGH_CHANNELS_BLADE_SECTION] = {"Sensor on a blade",
        "{a}: number of the blade; {b}: number of the place in the sensor's list, from 1. The section axes are those "
        "of the rod's table, with the initial twist, turned with the deformed section",
        ROWS(SECTION("Spn{b}", "b{a}", SAME_XYZ, SAME_OF))},
    [BOUGH_CHANNELS_TOWER_SECTION] = {"Sensor on a tower of one rod",
        "{b}: number of the place in the sensor's list, from 1. The section axes are those of the rod's table, "
        "with the initial twist, turned with the deformed section",
        ROWS(SECTION("TwHt{b}", "t", SAME_XYZ, SAME_OF))},
    [BOUGH_CHANNELS_SECTION] = {"Sensor on any other rod",
        "{a}: the body's name; {b}: number of the place in the sensor's list, from 1. The section axes are those "
        "of the rod's table, with the initial twist, turned with the deformed section",
        ROWS(SECTION("{a}Spn{b}", "", XYZ, OURS_OF))},
    [BOUGH_CHANNELS_SHAFT] = {"Shaft of a turbine", NULL, ROWS(
        SAME("RotTorq", "kN-m", "torque of the hub on the shaft, positive when it brakes: of the spring between generator and hub, on a rigid shaft of the generator and what accelerates the bodies up to the hub"),
        SAME("RotPwr", "kW", "RotTorq times RotSpeed"))},
    [BOUGH_CHANNELS_YAW_BEARING] = {"Top of a tower", NULL, ROWS(
        SAME_XYZ("YawBrF", "p", "kN", "force of the nacelle on the tower's top, ", " axis of the top section"),
        SAME_XYZ("YawBrM", "p", "kN-m", "moment of the nacelle on the tower's top, ", " axis of the top section"))},
    [BOUGH_CHANNELS_AIR] = {"Air on a rotor, at the last aerodynamic sample", NULL, ROWS(
        SAME("RtAeroFxh", "N", "thrust of the air on the blades, along the hub's x; without the drag of the hub"),
        SAME("RtAeroMxh", "N-m", "torque of the air on the rotor, about the hub's x"),
        SAME("RtAeroPwr", "W", "RtAeroMxh times the angular velocity of the hub about the shaft")), .sampled = BOUGH_BY_AIR},
    [BOUGH_CHANNELS_WIND] = {"Wind", NULL, ROWS(
        SAME_OF(1, "Wind1VelX", "m/s", "undisturbed wind at the initial position of the hub, along ground x"),
        SAME_OF(2, "Wind1VelY", "m/s", "undisturbed wind at the initial position of the hub, along ground y"),
        SAME_OF(3, "Wind1VelZ", "m/s", "undisturbed wind at the initial position of the hub, along ground z")), .sampled = BOUGH_BY_TIME},
    [BOUGH_CHANNELS_ROTOR_WIND] = {"Wind on a rotor, at the last aerodynamic sample", NULL, ROWS(
        SAME_XYZ("RtVAvg", "h", "m/s", "wind relative to the blades, mean over all blade elements, with the tower's influence, along the hub's ", ""),
        {"RtTSR", "-", "tip-speed ratio: angular velocity of the hub about the shaft times the undeformed rotor's radius, divided by RtVAvgxh; 0 in still air", "RtTSR", 0, 3}), .sampled = BOUGH_BY_AIR},
    [BOUGH_CHANNELS_ELEMENT] = {"Blade element that aero.nodes names",
        "{a}: number of the blade; {b}: number of the element, with three digits", ROWS(
        SAME("AB{a}N{b}VRel", "m/s", "speed of the air relative to the element"),
        SAME("AB{a}N{b}Alpha", "deg", "angle of attack"),
        SAME("AB{a}N{b}Phi", "deg", "inflow angle"),
        SAME("AB{a}N{b}AxInd", "-", "axial induction factor"),
        SAME("AB{a}N{b}TnInd", "-", "tangential induction factor"),
        SAME("AB{a}N{b}Cl", "-", "lift coefficient"),
        SAME("AB{a}N{b}Cd", "-", "drag coefficient"),
        SAME("AB{a}N{b}Cm", "-", "moment coefficient"),
        SAME("AB{a}N{b}Fx", "N/m", "force per length normal to the coned, bent blade, in the plane of shaft and radius"),
        SAME("AB{a}N{b}Fy", "N/m", "force per length in the rotor plane, positive where it drives the rotor")), .sampled = BOUGH_BY_AIR},
    [BOUGH_CHANNELS_GENERATOR] = {"Generator", NULL, ROWS(
        SAME("GenSpeed", "rpm", "speed of the generator: speed of the rotor's joint times the gear ratio"))},
    [BOUGH_CHANNELS_CONTROL] = {"Control", NULL, ROWS(
        SAME("GenTq", "kN-m", "torque of the generator at the fast shaft, positive when it brakes, as demanded at the last sample of the control"),
        SAME("GenPwr", "kW", "electrical power, at the last sample of the control")), .sampled = BOUGH_BY_CONTROL},
    [BOUGH_CHANNELS_PITCH] = {"Control of a turbine's blades", numbered, ROWS(
        SAME("BldPitch{a}", "deg", "pitch of the blade: the body's pitch minus the joint's angle, positive towards feather"))},
    [BOUGH_CHANNELS_LAW] = {"Control of kind external", NULL, ROWS(
        OURS("LawGenSpeed", "rad/s", "speed of the generator now, as a control law uses it, without rounding"))},
    [BOUGH_CHANNELS_LAW_PITCH] = {"Control of kind external, of a turbine's blades", numbered, ROWS(
        OURS("LawBldPitch{a}", "rad", "pitch of the blade now, as a control law uses it, without rounding"))},
};
// clang-format on

// Replaces {a} and {b} in a template. The text is cut at `size`: no channel has such a long name.
static void fill(const char *form, const char *a, const char *b, char *text, size_t size) {
    size_t used = 0;
    for (const char *c = form; *c;) {
        const char *part = strncmp(c, "{a}", 3) == 0 ? a : strncmp(c, "{b}", 3) == 0 ? b : NULL;
        size_t length = part ? strlen(part) : 1;
        if (used + length + 1 > size) break;
        memcpy(text + used, part ? part : c, length);
        used += length;
        c += part ? 3 : 1;
    }
    text[used] = '\0';
}

void bough_channel_family_add(bough_channels *list, bough_channel_part part, const char *a, const char *b) {
    const bough_channel_family *family = &families[part];
    for (int k = 0; k < family->n; k++) {
        const bough_channel_row *row = &family->row[k];
        char name[2 * BOUGH_CHANNEL_NAME];
        fill(row->name, a, b, name, sizeof name);
        bough_channels_add(list, row->unit, "%s", name);
        bough_channels_describe(list, row->meaning, row->component, row->divisor, family->sampled);
    }
}

void bough_channel_group_add(bough_channels *list, bough_channel_sample *sample, void *self,
                             bough_channel_part part) {
    bough_channels_group(list, sample, self);
    bough_channel_family_add(list, part, "", "");
}

// -- help -----------------------------------------------------------------------------------------

static void print_family(const bough_channel_family *f, FILE *stream) {
    fprintf(stream, "\n## %s\n\n", f->title);
    if (f->parts) fprintf(stream, "%s.\n\n", f->parts);
    fputs("| channel | unit | description | OpenFAST |\n|---|---|---|---|\n", stream);
    for (int k = 0; k < f->n; k++) {
        const bough_channel_row *r = &f->row[k];
        fprintf(stream, "| %s | %s | %s | %s |\n", r->name, r->unit, r->meaning,
                r->openfast ? r->openfast : "");
    }
}

void bough_channel_table_help(FILE *stream) {
    fputs((const char *)bough_channel_help_text, stream);
    for (int i = 0; i < BOUGH_CHANNEL_PARTS; i++) print_family(&families[i], stream);
}
