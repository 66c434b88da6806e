// The keys of wind, airfoils, blade elements and tower.
#include "apps/bough/scene/scene_internal.h"

// clang-format would give each field of a key a line of its own:
// clang-format off

#define FILLS bough_scene_aero_station
static const bough_schema aero_station_schema = {.name = "a station", KEYS(
    {NAMED("span", NUMBER), AT(def.span), UNIT(LENGTH), .required = true, .increasing = true, .example = "20.5 m",
     .help = "distance from the root, along z"},
    {NAMED("ac_x", NUMBER), AT(def.centre_x), UNIT(LENGTH), .fallback = "0", .example = "0.1 m",
     .help = "aerodynamic centre from the pitch axis, blade-root x (flapwise)"},
    {NAMED("ac_y", NUMBER), AT(def.centre_y), UNIT(LENGTH), .fallback = "0", .example = "-0.5 m",
     .help = "aerodynamic centre from the pitch axis, blade-root y (edgewise)"},
    {NAMED("twist", NUMBER), AT(def.twist), UNIT(ANGLE), .fallback = "0", .example = "9 deg",
     .help = "the airfoil is rotated by -twist about z, like pitch, in the plane normal to the prebent axis of the blade"},
    {NAMED("chord", NUMBER), AT(def.chord), UNIT(LENGTH), .range = "> 0", .required = true, .example = "4.2 m",
     .help = "chord"},
    {NAMED("polar", TEXT), AT(polar_name), .required = true, .example = "DU25",
     .help = "name of a polar in the polars file"},
    {NAMED("blend", TEXT), AT(second_name), .example = "DU21",
     .help = "name of a second polar, with which the first is mixed"},
    {NAMED("share", NUMBER), AT(def.share), .range = "[0, 1]", .fallback = "0", .example = "0.4",
     .help = "share of the second polar"},
)};
#undef FILLS

#define FILLS bough_scene_aero_blade
static const bough_schema aero_blade_schema = {
    .name = "an aerodynamic blade", .check = bough_scene_check_aero_blade, KEYS(
    {KEY(TEXT, source), .example = "Jonkman et al. 2009, NREL/TP-500-38060",
     .help = "where the data come from"},
    {NAMED("stations", LIST), AT(station), .of = &aero_station_schema, .count = 2, .required = true,
     COUNT_AT(n_station), .help = "blade elements, from the root to the tip"},
)};
#undef FILLS

#define FILLS bough_scene_polar_row
#define ROW(member, shown, what)                                                                   \
    {KEY(NUMBER, member), .required = true, .example = shown, .help = what}
static const bough_schema polar_row_schema = {.name = "a row", KEYS(
    {KEY(NUMBER, alpha), UNIT(ANGLE), .required = true, .increasing = true, .example = "8 deg",
     .help = "angle of attack"},
    ROW(cl, "1.05", "lift coefficient"),
    ROW(cd, "0.012", "drag coefficient"),
    ROW(cm, "-0.11", "moment coefficient about the aerodynamic centre, nose up"),
)};
#undef FILLS

#define FILLS bough_scene_polar
static const bough_schema polar_schema = {.name = "a polar", .check = bough_scene_check_polar, KEYS(
    {KEY(TEXT, name), .required = true, .example = "DU25", .help = "unique"},
    {NAMED("table", LIST), AT(row), .of = &polar_row_schema, .count = 2, .required = true,
     COUNT_AT(n_row), .help = "rows from -180 deg to 180 deg, with linear interpolation"},
    {KEY(VECTOR, indicial), .count = 4, .range = ">= 0", .fallback = "[0.165, 0.335, 0.0455, 0.3]",
     .example = "[0.3, 0.7, 0.14, 0.53]",
     .help = "of dynamic stall: A1, A2, b1, b2 of the lift 1 - A1 exp(-b1 s) - A2 exp(-b2 s) after a step of "
             "the angle of attack, s in half chords; default a flat plate (Jones)"},
)};
#undef FILLS

#define FILLS bough_scene_polars
static const bough_schema polars_schema = {.name = "a set of polars", .check = bough_scene_check_polars, KEYS(
    {KEY(TEXT, source), .example = "Jonkman et al. 2009, NREL/TP-500-38060",
     .help = "where the data come from"},
    {NAMED("polars", LIST), AT(polar), .of = &polar_schema, .count = 1, .required = true,
     COUNT_AT(n_polar), .help = "airfoils"},
)};
#undef FILLS

#define FILLS bough_scene_wind_table
static const bough_schema wind_table_schema = {
    .name = "a table of wind speeds", .check = bough_scene_check_wind_table, KEYS(
    {NAMED("times", NUMBERS), AT(time), UNIT(TIME), .count = 2, .required = true, .increasing = true, COUNT_AT(n_time),
     .example = "[0, 10 s, 12 s]", .help = "strictly increasing"},
    {NAMED("speeds", NUMBERS), AT(speed), UNIT(SPEED), .range = WIND_SPEED_RANGE, .count = 2,
     .required = true, COUNT_AT(n_speed), .example = "[8, 8, 12 m/s]",
     .help = "speed at each time, linear between, constant before and after"},
)};
#undef FILLS

#define FILLS bough_scene_wind
#define DEF(member) NAMED(#member, NUMBER), AT(def.member)
static const bough_schema wind_schema = {.name = "the wind", .check = bough_scene_check_wind, KEYS(
    {KEY(CHOICE, kind),
     CHOICES([BOUGH_SCENE_WIND_UNIFORM] = "uniform", [BOUGH_SCENE_WIND_POWER] = "power",
             [BOUGH_SCENE_WIND_LOG] = "log", [BOUGH_SCENE_WIND_WND] = "wnd",
             [BOUGH_SCENE_WIND_BTS] = "bts", [BOUGH_SCENE_WIND_IEC] = "iec"),
     .fallback = "uniform",
     .help = "uniform: the same speed at all heights; power, log: by a power or a logarithmic law; "
             "wnd: uniform wind file (hub height); bts: TurbSim's box; iec: condition of IEC 61400-1"},
    {NAMED("condition", CHOICE), AT(def.iec.condition),
     CHOICES([BOUGH_WIND_NTM] = "ntm", [BOUGH_WIND_ETM] = "etm", [BOUGH_WIND_EWM] = "ewm",
             [BOUGH_WIND_EWM_STEADY] = "ewm-steady", [BOUGH_WIND_NWP] = "nwp",
             [BOUGH_WIND_EOG] = "eog", [BOUGH_WIND_EDC] = "edc", [BOUGH_WIND_ECD] = "ecd",
             [BOUGH_WIND_EWS] = "ews"),
     .required = true, WHEN("kind", "iec"),
     .help = "ntm: normal turbulence; etm: extreme turbulence; ewm: extreme wind with turbulence; "
             "ewm-steady: steady extreme wind; nwp: normal profile; eog: extreme operating gust; "
             "edc: extreme change of direction; ecd: coherent gust with change of direction; ews: "
             "extreme shear"},
    {NAMED("class", CHOICE), AT(def.iec.wind_class),
     CHOICES([BOUGH_WIND_IA_PLUS] = "IA+", [BOUGH_WIND_IA] = "IA", [BOUGH_WIND_IB] = "IB",
             [BOUGH_WIND_IC] = "IC", [BOUGH_WIND_IIA_PLUS] = "IIA+", [BOUGH_WIND_IIA] = "IIA",
             [BOUGH_WIND_IIB] = "IIB", [BOUGH_WIND_IIC] = "IIC", [BOUGH_WIND_IIIA_PLUS] = "IIIA+",
             [BOUGH_WIND_IIIA] = "IIIA", [BOUGH_WIND_IIIB] = "IIIB", [BOUGH_WIND_IIIC] = "IIIC"),
     .fallback = "IB", WHEN("kind", "iec"),
     .help = "reference wind speed (I to III) and turbulence (A+ to C)"},
    {NAMED("intensity", NUMBER), AT(def.iec.intensity), .range = "> 0", .word = "class",
     .fallback = "class", WHEN("kind", "iec"), .example = "0.12",
     .help = "intensity of the longitudinal turbulence at this speed; class: that of the class"},
    {NAMED("rotor_diameter", NUMBER), AT(def.iec.diameter), UNIT(LENGTH), .range = "> 0",
     .word = "auto", .fallback = "auto", WHEN("kind", "iec"), .example = "126 m",
     .help = "auto: diameter of the scene's rotor"},
    {NAMED("start", NUMBER), AT(def.iec.start), UNIT(TIME), .fallback = "0", WHEN("kind", "iec"),
     .example = "60 s", .help = "start of a gust or a change of direction"},
    {NAMED("sense", CHOICE), AT(def.iec.negative), CHOICES("positive", "negative"),
     .fallback = "positive", WHEN("kind", "iec"),
     .help = "sign of a change of direction (positive: clockwise seen from above) or of a shear"},
    {NAMED("shear", CHOICE), AT(def.iec.horizontal), CHOICES("vertical", "horizontal"),
     .fallback = "vertical", WHEN("kind", "iec"), .help = "direction of the shear of ews"},
    {NAMED("recurrence", CHOICE), AT(def.iec.yearly), CHOICES("50-years", "1-year"),
     .fallback = "50-years", WHEN("kind", "iec"),
     .help = "recurrence period of ewm and ewm-steady"},
    {NAMED("seed", INTEGER), AT(def.iec.seed), .range = ">= 0", .fallback = "1", WHEN("kind", "iec"),
     .example = "7", .help = "seed of the turbulence; the same seed gives the same wind"},
    {NAMED("points", INTEGER), AT(def.iec.points), .range = "[2, 41]", .fallback = "15",
     WHEN("kind", "iec"), .example = "21",
     .help = "number of points of the turbulence's grid, in height and in width"},
    {NAMED("width", NUMBER), AT(def.iec.width), UNIT(LENGTH), .range = "> 0", .word = "auto",
     .fallback = "auto", WHEN("kind", "iec"), .example = "160 m",
     .help = "width and height of the turbulence's grid; auto: 1.15 rotor diameters"},
    {NAMED("time_step", NUMBER), AT(def.iec.time_step), UNIT(TIME), .range = "> 0", .fallback = "0.05",
     WHEN("kind", "iec"), .example = "0.1 s", .help = "time step of the turbulence"},
    {NAMED("period", NUMBER), AT(def.iec.period), UNIT(TIME), .range = "> 0", .word = "auto",
     .fallback = "auto", WHEN("kind", "iec"), .example = "720 s",
     .help = "period after which the turbulence repeats: an even number of time steps without factors other "
             "than 2, 3 and 5; auto: the next such number for the duration, at least for 600 s"},
    {NAMED("file", TEXT), AT(def.file), .required = true, WHEN("kind", "wnd|bts"), .example = "turbulence.bts",
     .help = "relative to the scene"},
    {DEF(speed), UNIT(SPEED), .range = WIND_SPEED_RANGE, .example = "11.4 m/s",
     .help = "horizontal speed at the reference height; required unless there is a table or a "
             "file, or the class gives the speed (ewm)"},
    {KEY(TEXT, input), .example = "wind",
     .help = "name of an input, by which another program sets the speed between steps; with kind "
             "uniform, power or log"},
    {KEY(MAPPING, table), .of = &wind_table_schema,
     .help = "speed over time, for gusts and ramps; replaces 'speed'"},
    {DEF(exponent), .range = "[0, 1]", .fallback = "0.2", WHEN("kind", "power|iec"),
     .example = "0.14",
     .help = "speed grows with height^exponent; the default for the extreme wind (ewm) is 0.11"},
    {DEF(roughness), UNIT(LENGTH), .range = "> 0", .fallback = "0.03", WHEN("kind", "log"),
     .example = "0.01 m", .help = "length z0: speed grows with ln(height/z0)"},
    {DEF(reference_height), UNIT(LENGTH), .range = "> 0", .required = true,
     WHEN("kind", "power|log|wnd|iec"), .example = "90 m",
     .help = "height above ground z = 0; with kind iec the hub height"},
    {DEF(reference_length), UNIT(LENGTH), .range = "> 0", .required = true,
     WHEN("kind", "wnd"), .example = "126 m",
     .help = "length over which the file's linear shears are given: the rotor's diameter"},
    {DEF(direction), UNIT(ANGLE), .fallback = "0", .example = "15 deg",
     .help = "direction to which the wind blows, from ground x about z: the yaw misalignment of a "
             "rotor with its axis along x"},
    {DEF(upflow), UNIT(ANGLE), .range = "[-1.5, 1.5]", .fallback = "0", .example = "8 deg",
     .help = "inclination of the whole wind, positive upwards"},
    {DEF(veer), UNIT(ANGLE), .fallback = "0", .example = "10 deg",
     .help = "change of the wind's direction over 100 m of height, clockwise seen from above; zero "
             "at the reference height, which for a box is its hub height, and 90 m for other winds "
             "without one"},
    {DEF(vertical), UNIT(SPEED), .fallback = "0", .example = "0.5 m/s",
     .help = "vertical speed, upwards, at every height and time; with kind uniform, power or log"},
)};
#undef FILLS
#undef DEF

#define FILLS bough_scene_induction
#define SWITCH(member, what)                                                                       \
    {NAMED(#member, BOOLEAN), AT(options.member), .fallback = "true", .help = what}
static const bough_schema induction_schema = {.name = "the induction", KEYS(
    SWITCH(tip_loss, "Prandtl's loss factor at the tip"),
    SWITCH(hub_loss, "Prandtl's loss factor at the hub"),
    SWITCH(tangential, "tangential induction"),
    {KEY(BOOLEAN, drag), .fallback = "true", .help = "includes drag in the induction"},
    {NAMED("high_thrust", CHOICE), AT(options.high_thrust),
     CHOICES([BOUGH_HIGH_THRUST_SMOOTH] = "smooth", [BOUGH_HIGH_THRUST_BUHL] = "buhl"),
     .fallback = "smooth",
     .help = "thrust beyond the validity of momentum theory: by AeroDyn's newer formulation, or by "
             "Buhl's parabola"},
    {KEY(CHOICE, skew), CHOICES("none", "pitt-peters"), .fallback = "pitt-peters",
     .help = "correction for oblique inflow"},
    {NAMED("skewed_momentum", BOOLEAN), AT(options.skewed_momentum), .fallback = "false",
     WHEN("high_thrust", "smooth"), .example = "true",
     .help = "momentum theory of a disk at an angle to the wind, by Glauert: AeroDyn's SkewMomCorr"},
    {NAMED("inflow", CHOICE), AT(inflow.kind),
     CHOICES([BOUGH_INFLOW_EQUILIBRIUM] = "equilibrium", [BOUGH_INFLOW_OYE] = "oye"),
     .fallback = "equilibrium",
     .help = "reaction of the induction to a change of load: immediate, or by Oye's dynamic inflow"},
    {NAMED("inflow_time", NUMBER), AT(inflow.time), UNIT(TIME), .word = "auto", .range = "> 0",
     .fallback = "auto", WHEN("inflow", "oye"), .example = "5 s",
     .help = "slow time constant of the dynamic inflow; auto: 1.1/(1 - 1.3 a) R/U"},
)};
#undef FILLS

#define FILLS bough_scene_tower
static const bough_schema tower_schema = {.name = "a tower", .check = bough_scene_check_tower, KEYS(
    {NAMED("influence", CHOICE), AT(def.influence),
     CHOICES([BOUGH_TOWER_POTENTIAL] = "potential", [BOUGH_TOWER_BAK] = "bak"),
     .fallback = "potential",
     .help = "wind in front of the tower: potential flow about a cylinder, or with Bak's "
             "correction for its drag"},
    {NAMED("shadow", CHOICE), AT(def.shadow),
     CHOICES([BOUGH_TOWER_SHADOW_NONE] = "none", [BOUGH_TOWER_SHADOW_POWLES] = "powles"),
     .fallback = "none",
     .help = "wake behind the tower"},
    {NAMED("height", NUMBERS), AT(def.height), UNIT(LENGTH), .range = ">= 0", .count = 2, .required = true,
     .increasing = true, COUNT_AT(def.n), .example = "[0, 45 m, 87.6 m]", .help = "above the ground"},
    {NAMED("diameter", NUMBERS), AT(def.diameter), UNIT(LENGTH), .range = "> 0", .count = 2, .required = true,
     COUNT_AT(n_diameter), .example = "[6, 4.9 m, 3.87 m]", .help = "diameter at each height"},
    {NAMED("drag", NUMBERS), AT(def.drag), .range = ">= 0", .count = 1, .fallback = "[1]", COUNT_AT(n_drag),
     .example = "[0.5]",
     .help = "drag coefficient: one for the whole tower, or one at each height; for bak, powles "
             "and the drag on a body"},
    {NAMED("body", TEXT), AT(body_name), .example = "tower",
     .help = "body with a rod on which the tower's drag acts, and at whose origin the tower stands; default no drag"},
)};
#undef FILLS

#define FILLS bough_scene_aero
const bough_schema bough_scene_aero_schema = {.name = "the aerodynamics", KEYS(
    {KEY(NUMBER, rate), UNIT(FREQUENCY), .range = "> 0", .example = "50 Hz",
     .help = "sampling rate; the period is a multiple of the macro step; default from "
             "simulation.accuracy and the rotor's radius"},
    {KEY(NUMBER, air_density), UNIT(DENSITY), .range = "> 0", .fallback = "1.225", .example = "1.2",
     .help = "density of the air"},
    {KEY(MAPPING, wind), .of = &wind_schema, .required = true, .help = "the undisturbed wind"},
    RAMP,
    {KEY(CHOICE, hold),
     CHOICES([BOUGH_SCENE_LINEAR] = "linear", [BOUGH_SCENE_CONSTANT] = "constant"),
     .fallback = "linear",
     .help = "continuation of the loads between samples"},
    {KEY(FILE, blade), .of = &aero_blade_schema, .required = true, .example = "blade-aero.yaml",
     .help = "file with the blade elements, relative to the scene"},
    {KEY(FILE, polars), .of = &polars_schema, .required = true, .example = "airfoils.yaml",
     .help = "file with the polars, relative to the scene"},
    {KEY(MAPPING, induction), .of = &induction_schema,
     .help = "parts of the blade element momentum theory"},
    {KEY(MAPPING, tower), .of = &tower_schema,
     .help = "influence of a vertical tower on the wind at the blades, at x = y = 0 or where its 'body' begins; default none"},
    {KEY(NUMBER, hub_radius), UNIT(LENGTH), .range = "> 0", .required = true, .example = "1.5 m",
     .help = "from the rotor axis to the blade roots"},
    {KEY(NUMBER, hub_drag_area), .range = ">= 0", .fallback = "0", .example = "5",
     .help = "drag coefficient times area of the hub, in m2; drag on the rotor"},
    {KEY(CHOICE, dynamic_stall),
     CHOICES([BOUGH_STALL_NONE] = "none", [BOUGH_STALL_HGM] = "hgm"), .fallback = "none",
     .help = "reaction of the lift to the angle of attack: immediate, or by the Beddoes-Leishman "
             "model of Hansen, Gaunaa and Madsen"},
    {KEY(CHOICE, interpolation),
     CHOICES([BOUGH_SCENE_POLARS_LINEAR] = "linear",
             [BOUGH_SCENE_POLARS_SMOOTH] = "monotone-cubic"), .fallback = "linear",
     .help = "interpolation between the rows of the polars"},
    {KEY(BOOLEAN, pitching_moment), .fallback = "true",
     .help = "includes the moment coefficients of the sections"},
    {KEY(NUMBERS, nodes), .range = ">= 1", .count = 1, COUNT_AT(n_node), .example = "[9, 15]",
     .help = "numbers of blade elements, from 1 at the root, whose flow is recorded"},
)};
#undef FILLS
// clang-format on
