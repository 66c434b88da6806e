#include "apps/simulation/channel_table.h"

#include <assert.h>
#include <string.h>

// clang-format off
static const bough_channel_row rotor[] = {
    {"RotSpeed", "rpm", "speed of the rotor's joint, positive about its axis", "RotSpeed"},
    {"Azimuth", "deg", "its angle, from 0 to 360", "Azimuth"},
};
static const bough_channel_row revolute[] = {
    {"{a}Pos", "deg", "angle of the joint about its axis", NULL},
    {"{a}Vel", "deg/s", "its rate", NULL},
};
static const bough_channel_row prismatic[] = {
    {"{a}Pos", "m", "displacement of the joint along its axis", NULL},
    {"{a}Vel", "m/s", "its rate", NULL},
};
static const bough_channel_row cylindrical[] = {
    {"{a}Pos", "m", "displacement along the axis", NULL},
    {"{a}Vel", "m/s", "its rate", NULL},
    {"{a}AngPos", "deg", "angle about the axis", NULL},
    {"{a}AngVel", "deg/s", "its rate", NULL},
};
static const bough_channel_row universal[] = {
    {"{a}Ang1Pos", "deg", "angle about the first axis", NULL},
    {"{a}Ang1Vel", "deg/s", "its rate", NULL},
    {"{a}Ang2Pos", "deg", "angle about the second axis", NULL},
    {"{a}Ang2Vel", "deg/s", "its rate", NULL},
};
static const bough_channel_row planar[] = {
    {"{a}1Pos", "m", "displacement along the first axis after the normal, in the order x, y, z, x", NULL},
    {"{a}1Vel", "m/s", "its rate", NULL},
    {"{a}2Pos", "m", "displacement along the second", NULL},
    {"{a}2Vel", "m/s", "its rate", NULL},
    {"{a}AngPos", "deg", "angle about the normal", NULL},
    {"{a}AngVel", "deg/s", "its rate", NULL},
};
static const bough_channel_row free_body[] = {
    {"{a}PosX", "m", "place of the body's frame, ground axes", NULL},
    {"{a}PosY", "m", "likewise", NULL},
    {"{a}PosZ", "m", "likewise", NULL},
    {"{a}VelX", "m/s", "its velocity, ground axes", NULL},
    {"{a}VelY", "m/s", "likewise", NULL},
    {"{a}VelZ", "m/s", "likewise", NULL},
};
static const bough_channel_row turning_body[] = {
    {"{a}DirXx", "-", "direction of the body's x axis, ground axes", NULL},
    {"{a}DirXy", "-", "likewise", NULL},
    {"{a}DirXz", "-", "likewise", NULL},
    {"{a}DirZx", "-", "direction of the body's z axis, ground axes", NULL},
    {"{a}DirZy", "-", "likewise", NULL},
    {"{a}DirZz", "-", "likewise", NULL},
    {"{a}OmegaX", "deg/s", "angular velocity of the body, ground axes", NULL},
    {"{a}OmegaY", "deg/s", "likewise", NULL},
    {"{a}OmegaZ", "deg/s", "likewise", NULL},
};
static const bough_channel_row drive_torque[] = {
    {"{a}Trq", "N-m", "torque that the motion takes, on the body, about the axis", NULL},
};
static const bough_channel_row drive_force[] = {
    {"{a}Frc", "N", "force that the motion takes, on the body, along the axis", NULL},
};
static const bough_channel_row drive_universal[] = {
    {"{a}Trq{b}", "N-m", "torque that the motion takes, on the body, about the axis", NULL},
};
static const bough_channel_row spring[] = {
    {"{a}Len", "m", "its length", NULL},
    {"{a}Frc", "N", "the force that draws its ends together", NULL},
};
static const bough_channel_row bushing[] = {
    {"{a}FrcX", "N", "force on the second body, in the first one's axes", NULL},
    {"{a}FrcY", "N", "likewise", NULL},
    {"{a}FrcZ", "N", "likewise", NULL},
    {"{a}MomX", "N-m", "moment on the second body, in the first one's axes", NULL},
    {"{a}MomY", "N-m", "likewise", NULL},
    {"{a}MomZ", "N-m", "likewise", NULL},
};
static const bough_channel_row closure[] = {
    {"{a}Fx", "N", "force on the body 'to', in the joint's frame there", NULL},
    {"{a}Fy", "N", "likewise", NULL},
    {"{a}Fz", "N", "likewise", NULL},
    {"{a}Mx", "N-m", "moment on the body 'to', in the joint's frame there", NULL},
    {"{a}My", "N-m", "likewise", NULL},
    {"{a}Mz", "N-m", "likewise", NULL},
};
static const bough_channel_row marker[] = {
    {"{a}X", "m", "place of the point, ground axes", NULL},
    {"{a}Y", "m", "likewise", NULL},
    {"{a}Z", "m", "likewise", NULL},
};
static const bough_channel_row blade[] = {
    {"OoPDefl{a}", "m", "displacement of the tip along x before the pitch: downwind", "OoPDefl{a}"},
    {"IPDefl{a}", "m", "displacement of the tip along y before the pitch", "IPDefl{a}"},
    {"TwstDefl{a}", "deg", "third component of the rotation vector of the tip's section, blade axes", "TipRDzb{a}"},
    {"TipDxb{a}", "m", "displacement of the tip, blade axes", "TipDxb{a}"},
    {"TipDyb{a}", "m", "likewise", "TipDyb{a}"},
    {"TipDzb{a}", "m", "likewise", "TipDzb{a}"},
    {"RootFxb{a}", "kN", "force of the blade on the hub, blade axes", "RootFxb{a}"},
    {"RootFyb{a}", "kN", "likewise", "RootFyb{a}"},
    {"RootFzb{a}", "kN", "likewise", "RootFzb{a}"},
    {"RootMxb{a}", "kN-m", "moment of the blade on the hub at the root: edgewise", "RootMxb{a}"},
    {"RootMyb{a}", "kN-m", "likewise: flapwise", "RootMyb{a}"},
    {"RootMzb{a}", "kN-m", "likewise: torsion", "RootMzb{a}"},
};
static const bough_channel_row tower[] = {
    {"TTDspFA", "m", "displacement of the tower's top along its x", "TTDspFA"},
    {"TTDspSS", "m", "along its y", "TTDspSS"},
    {"TTDspAx", "m", "along its z", "TTDspAx"},
    {"TTDspRoll", "deg", "rotation vector of the tower's top about its x", "TTDspRoll"},
    {"TTDspPtch", "deg", "about its y", "TTDspPtch"},
    {"TTDspTwst", "deg", "about its z", "TTDspTwst"},
    {"TwrBsFxt", "kN", "force of the tower on the foundation, tower axes", "TwrBsFxt"},
    {"TwrBsFyt", "kN", "likewise", "TwrBsFyt"},
    {"TwrBsFzt", "kN", "likewise", "TwrBsFzt"},
    {"TwrBsMxt", "kN-m", "moment on the foundation at the tower's foot: side to side", "TwrBsMxt"},
    {"TwrBsMyt", "kN-m", "likewise: fore and aft", "TwrBsMyt"},
    {"TwrBsMzt", "kN-m", "likewise: torsion", "TwrBsMzt"},
};
static const bough_channel_row tip[] = {
    {"{a}TipX", "m", "place of the rod's end, ground axes", NULL},
    {"{a}TipY", "m", "likewise", NULL},
    {"{a}TipZ", "m", "likewise", NULL},
};
// Twelve of a place on a rod: P before, S behind "TDx".
#define SECTION(P, S, EP, ES)                                                                      \
    {P "TDx" S, "m", "displacement, in the body's axes", EP "TDx" ES},                             \
    {P "TDy" S, "m", "likewise", EP "TDy" ES},                                                     \
    {P "TDz" S, "m", "likewise", EP "TDz" ES},                                                     \
    {P "RDx" S, "deg", "rotation vector of the section, in the body's axes", EP "RDx" ES},         \
    {P "RDy" S, "deg", "likewise", EP "RDy" ES},                                                   \
    {P "RDz" S, "deg", "likewise", EP "RDz" ES},                                                   \
    {P "FLx" S, "kN", "force of the outer on the inner part, in axes of the body that turn with "  \
                      "the section", EP "FLx" ES},                                                 \
    {P "FLy" S, "kN", "likewise", EP "FLy" ES},                                                    \
    {P "FLz" S, "kN", "likewise: axial, positive in tension", EP "FLz" ES},                        \
    {P "MLx" S, "kN-m", "moment of the outer on the inner part, in the same axes", EP "MLx" ES},   \
    {P "MLy" S, "kN-m", "likewise", EP "MLy" ES},                                                  \
    {P "MLz" S, "kN-m", "likewise: torsion", EP "MLz" ES}
static const bough_channel_row blade_section[] = {SECTION("Spn{b}", "b{a}", "Spn{b}", "b{a}")};
static const bough_channel_row tower_section[] = {SECTION("TwHt{b}", "t", "TwHt{b}", "t")};
#undef SECTION
static const bough_channel_row section[] = {
    {"{a}Spn{b}TDx", "m", "displacement, in the body's axes", NULL},
    {"{a}Spn{b}TDy", "m", "likewise", NULL},
    {"{a}Spn{b}TDz", "m", "likewise", NULL},
    {"{a}Spn{b}RDx", "deg", "rotation vector of the section, in the body's axes", NULL},
    {"{a}Spn{b}RDy", "deg", "likewise", NULL},
    {"{a}Spn{b}RDz", "deg", "likewise", NULL},
    {"{a}Spn{b}FLx", "kN", "force of the outer on the inner part, in axes of the body that turn with the section", NULL},
    {"{a}Spn{b}FLy", "kN", "likewise", NULL},
    {"{a}Spn{b}FLz", "kN", "likewise: axial, positive in tension", NULL},
    {"{a}Spn{b}MLx", "kN-m", "moment of the outer on the inner part, in the same axes", NULL},
    {"{a}Spn{b}MLy", "kN-m", "likewise", NULL},
    {"{a}Spn{b}MLz", "kN-m", "likewise: torsion", NULL},
};
static const bough_channel_row shaft[] = {
    {"RotTorq", "kN-m", "torque of the rotor on what holds its joint: loads, spring, generator, motion; "
                        "positive when it brakes a rotor that turns forward", "RotTorq"},
    {"RotPwr", "kW", "that torque times the rotor's speed", "RotPwr"},
};
static const bough_channel_row yaw_bearing[] = {
    {"YawBrFxp", "kN", "force of what the tower carries on its top, in axes of the tower that turn with its top section", "YawBrFxp"},
    {"YawBrFyp", "kN", "likewise", "YawBrFyp"},
    {"YawBrFzp", "kN", "likewise", "YawBrFzp"},
    {"YawBrMxp", "kN-m", "moment of what the tower carries on its top, in the same axes", "YawBrMxp"},
    {"YawBrMyp", "kN-m", "likewise", "YawBrMyp"},
    {"YawBrMzp", "kN-m", "likewise: about the tower", "YawBrMzp"},
};
static const bough_channel_row air[] = {
    {"RtAeroFxh", "N", "thrust of the air on the rotor, along the hub's x", "RtAeroFxh"},
    {"RtAeroMxh", "N-m", "torque of the air on the rotor, about the hub's x", "RtAeroMxh"},
    {"RtAeroPwr", "W", "that torque times the rotor's speed", "RtAeroPwr"},
};
static const bough_channel_row wind[] = {
    {"Wind1VelX", "m/s", "undisturbed wind where the hub stood at the start, ground axes", "Wind1VelX"},
    {"Wind1VelY", "m/s", "likewise", "Wind1VelY"},
    {"Wind1VelZ", "m/s", "likewise", "Wind1VelZ"},
    {"RtVAvgxh", "m/s", "mean over the rotor of the wind with the tower's influence, the hub's axes", "RtVAvgxh"},
    {"RtVAvgyh", "m/s", "likewise", "RtVAvgyh"},
    {"RtVAvgzh", "m/s", "likewise", "RtVAvgzh"},
    {"RtTSR", "-", "tip-speed ratio: rotor speed times the undeformed rotor's radius, over RtVAvgxh", "RtTSR"},
};
static const bough_channel_row element[] = {
    {"AB{a}N{b}VRel", "m/s", "speed of the air past the element", "AB{a}N{b}VRel"},
    {"AB{a}N{b}Alpha", "deg", "angle of attack", "AB{a}N{b}Alpha"},
    {"AB{a}N{b}Phi", "deg", "inflow angle", "AB{a}N{b}Phi"},
    {"AB{a}N{b}AxInd", "-", "axial induction factor", "AB{a}N{b}AxInd"},
    {"AB{a}N{b}TnInd", "-", "tangential induction factor", "AB{a}N{b}TnInd"},
    {"AB{a}N{b}Cl", "-", "lift coefficient", "AB{a}N{b}Cl"},
    {"AB{a}N{b}Cd", "-", "drag coefficient", "AB{a}N{b}Cd"},
    {"AB{a}N{b}Cm", "-", "moment coefficient", "AB{a}N{b}Cm"},
    {"AB{a}N{b}Fx", "N/m", "force per length normal to the rotor's plane", "AB{a}N{b}Fx"},
    {"AB{a}N{b}Fy", "N/m", "force per length in the rotor's plane, against the rotation where the air brakes", "AB{a}N{b}Fy"},
};
static const bough_channel_row control[] = {
    {"GenSpeed", "rpm", "speed of the generator: the rotor's times the gear ratio", "GenSpeed"},
    {"GenTq", "kN-m", "torque of the generator, on the fast shaft, positive when it brakes", "GenTq"},
    {"GenPwr", "kW", "electrical power", "GenPwr"},
};
static const bough_channel_row pitch[] = {
    {"BldPitch{a}", "deg", "pitch of the blade: its own and its joint's, positive towards feather", "BldPitch{a}"},
};
static const bough_channel_row law[] = {
    {"LawGenSpeed", "rad/s", "speed of the generator at this moment, as a control law takes it, to the last bit", NULL},
};
static const bough_channel_row law_pitch[] = {
    {"LawBldPitch{a}", "rad", "pitch of the blade at this moment, likewise", NULL},
};

#define N(rows) (int)(sizeof(rows) / sizeof *(rows)), rows
static const char body[] = "{a}: the body that the joint carries", named[] = "{a}: its name",
                  numbered[] = "{a}: number of the blade in turbine.blades, from 1";
const bough_channel_family bough_channel_families[BOUGH_CHANNEL_PARTS] = {
    [BOUGH_CHANNELS_ROTOR] = {"Rotor of a turbine", NULL, N(rotor)},
    [BOUGH_CHANNELS_REVOLUTE] = {"Revolute joint other than the rotor's", body, N(revolute)},
    [BOUGH_CHANNELS_PRISMATIC] = {"Prismatic joint", body, N(prismatic)},
    [BOUGH_CHANNELS_CYLINDRICAL] = {"Cylindrical joint", body, N(cylindrical)},
    [BOUGH_CHANNELS_UNIVERSAL] = {"Universal joint", body, N(universal)},
    [BOUGH_CHANNELS_PLANAR] = {"Planar joint", body, N(planar)},
    [BOUGH_CHANNELS_FREE] = {"Body on a free joint", body, N(free_body)},
    [BOUGH_CHANNELS_TURNING] = {"Body on a free or a spherical joint", body, N(turning_body)},
    [BOUGH_CHANNELS_DRIVE_TORQUE] = {"Prescribed turn of a joint", body, N(drive_torque)},
    [BOUGH_CHANNELS_DRIVE_FORCE] = {"Prescribed displacement of a joint", body, N(drive_force)},
    [BOUGH_CHANNELS_DRIVE_UNIVERSAL] = {"Prescribed turn of a universal joint",
        "{a}: the body that the joint carries; {b}: 1 or 2, the axis", N(drive_universal)},
    [BOUGH_CHANNELS_SPRING] = {"Spring", named, N(spring)},
    [BOUGH_CHANNELS_BUSHING] = {"Bushing", named, N(bushing)},
    [BOUGH_CHANNELS_CLOSURE] = {"Closure", named, N(closure)},
    [BOUGH_CHANNELS_MARKER] = {"Marker", named, N(marker)},
    [BOUGH_CHANNELS_BLADE] = {"Blade of a turbine", numbered, N(blade)},
    [BOUGH_CHANNELS_TOWER] = {"Tower: rods that carry a turbine's rotor", NULL, N(tower)},
    [BOUGH_CHANNELS_TIP] = {"Any other body with a rod", "{a}: its name", N(tip)},
    [BOUGH_CHANNELS_BLADE_SECTION] = {"Sensor on a blade",
        "{a}: number of the blade, {b}: of the place, from 1 as in the sensor's list", N(blade_section)},
    [BOUGH_CHANNELS_TOWER_SECTION] = {"Sensor on a tower of one rod",
        "{b}: number of the place, from 1 as in the sensor's list", N(tower_section)},
    [BOUGH_CHANNELS_SECTION] = {"Sensor on any other rod",
        "{a}: the body's name, {b}: number of the place, from 1 as in the sensor's list", N(section)},
    [BOUGH_CHANNELS_SHAFT] = {"Shaft of a turbine", NULL, N(shaft)},
    [BOUGH_CHANNELS_YAW_BEARING] = {"Top of a tower", NULL, N(yaw_bearing)},
    [BOUGH_CHANNELS_AIR] = {"Air on a rotor, of the last sample", NULL, N(air)},
    [BOUGH_CHANNELS_WIND] = {"Wind", NULL, N(wind)},
    [BOUGH_CHANNELS_ELEMENT] = {"Blade element that aero.nodes names",
        "{a}: number of the blade, {b}: of the element with three digits", N(element)},
    [BOUGH_CHANNELS_CONTROL] = {"Control", NULL, N(control)},
    [BOUGH_CHANNELS_PITCH] = {"Control of a turbine's blades", numbered, N(pitch)},
    [BOUGH_CHANNELS_LAW] = {"Control of kind external", NULL, N(law)},
    [BOUGH_CHANNELS_LAW_PITCH] = {"Control of kind external, of a turbine's blades", numbered, N(law_pitch)},
};
// clang-format on

// text = the template with its parts put in; false where it does not fit.
static bool fill(const char *form, const char *a, const char *b, char *text, size_t size) {
    size_t used = 0;
    for (const char *c = form; *c;) {
        const char *part = strncmp(c, "{a}", 3) == 0 ? a : strncmp(c, "{b}", 3) == 0 ? b : NULL;
        size_t length = part ? strlen(part) : 1;
        if (used + length + 1 > size) return false;
        memcpy(text + used, part ? part : c, length);
        used += length;
        c += part ? 3 : 1;
    }
    text[used] = '\0';
    return true;
}

bough_status bough_channel_family_add(bough_channels *list, bough_channel_part part, const char *a,
                                      const char *b) {
    const bough_channel_family *family = &bough_channel_families[part];
    bough_status status = bough_ok();
    for (int k = 0; k < family->n && bough_is_ok(&status); k++) {
        char name[2 * BOUGH_CHANNEL_NAME];
        if (!fill(family->row[k].name, a, b, name, sizeof name))
            return bough_fail(BOUGH_INVALID, "the name '%.60s' is too long for a channel", a);
        status = bough_channels_add(list, family->row[k].unit, "%s", name);
    }
    return status;
}

// -- help -----------------------------------------------------------------------------------------

static void print_family(const bough_channel_family *f, FILE *stream) {
    fprintf(stream, "\n## %s\n\n", f->title);
    if (f->parts) fprintf(stream, "%s.\n\n", f->parts);
    fputs("| channel | unit | what it is | OpenFAST |\n|---|---|---|---|\n", stream);
    for (int k = 0; k < f->n; k++) {
        const bough_channel_row *r = &f->row[k];
        fprintf(stream, "| %s | %s | %s | %s |\n", r->name, r->unit, r->meaning,
                r->openfast ? r->openfast : "");
    }
}

void bough_channel_table_help(FILE *stream) {
    fputs("# Channels\n\n"
          "What a run records in `channels.out`, by part of the scene: a part that the scene does "
          "not have has no\nchannels. `bough check SCENE` counts them; "
          "`simulation.output.channels` chooses some by name. Ground\naxes: z up. Blade axes: the "
          "body's, z from root to tip, turned with the pitch. OpenFAST's names stand where the\n"
          "quantity is the same; section loads are in axes that do not turn with the section's "
          "initial twist.\n",
          stream);
    for (int i = 0; i < BOUGH_CHANNEL_PARTS; i++) print_family(&bough_channel_families[i], stream);
}
