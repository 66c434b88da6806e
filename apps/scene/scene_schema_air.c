// The keys of wind, airfoils, blade elements and tower.
#include "apps/scene/scene_tables.h"

// One line a key would become one line a field:
// clang-format off

#define AT(member) .offset = offsetof(bough_scene_aero_station, member)
static const bough_key aero_station_keys[] = {
    {.name = "span", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .required = true,
     AT(span), .example = "20.5 m", .help = "distance from the root, along z"},
    {.name = "ac_x", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .fallback = "0",
     AT(ac[0]), .example = "0.1 m",
     .help = "aerodynamic centre from the pitch axis, blade-root x (flapwise)"},
    {.name = "ac_y", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .fallback = "0",
     AT(ac[1]), .example = "-0.5 m",
     .help = "aerodynamic centre from the pitch axis, blade-root y (edgewise)"},
    {.name = "twist", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(twist), .example = "9 deg", .help = "the airfoil is turned by -twist about z, like pitch"},
    {.name = "chord", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = "> 0",
     .required = true, AT(chord), .example = "4.2 m", .help = "chord"},
    {.name = "polar", .kind = BOUGH_KEY_TEXT, .required = true, AT(polar_name),
     .example = "DU25", .help = "name of a polar in the polars file"},
    {.name = "blend", .kind = BOUGH_KEY_TEXT, AT(second_name),
     .example = "DU21", .help = "name of a second polar, with which the first is mixed"},
    {.name = "share", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0", AT(share),
     .example = "0.4",
     .help = "share of the second polar"},
};
#undef AT
static const bough_schema aero_station_schema = {
    SCHEMA("a station", bough_scene_aero_station, aero_station_keys)};

#define AT(member) .offset = offsetof(bough_scene_aero_blade, member)
static const bough_key aero_blade_keys[] = {
    {.name = "source", .kind = BOUGH_KEY_TEXT, AT(source),
     .example = "Jonkman et al. 2009, NREL/TP-500-38060",
     .help = "where the data come from"},
    {.name = "stations", .kind = BOUGH_KEY_LIST, .of = &aero_station_schema, .count = 2,
     .required = true, AT(station), .count_offset = offsetof(bough_scene_aero_blade, n_station),
     .help = "blade elements, from the root to the tip"},
};
#undef AT
static const bough_schema aero_blade_schema = {
    SCHEMA("an aerodynamic blade", bough_scene_aero_blade, aero_blade_keys),
    .check = bough_scene_check_aero_blade};

#define ROW(key_name, shown, what)                                                                 \
    {.name = #key_name, .kind = BOUGH_KEY_NUMBER, .required = true,                                \
     .offset = offsetof(bough_scene_polar_row, key_name), .example = shown, .help = what}
static const bough_key polar_row_keys[] = {
    {.name = "alpha", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .required = true,
     .offset = offsetof(bough_scene_polar_row, alpha), .example = "8 deg",
     .help = "angle of attack"},
    ROW(cl, "1.05", "lift coefficient"),
    ROW(cd, "0.012", "drag coefficient"),
    ROW(cm, "-0.11", "moment coefficient about the aerodynamic centre, nose up"),
};
static const bough_schema polar_row_schema = {
    SCHEMA("a row", bough_scene_polar_row, polar_row_keys)};

#define AT(member) .offset = offsetof(bough_scene_polar, member)
static const bough_key polar_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name), .example = "DU25",
     .help = "unique"},
    {.name = "table", .kind = BOUGH_KEY_LIST, .of = &polar_row_schema, .count = 2,
     .required = true, AT(row), .count_offset = offsetof(bough_scene_polar, n_row),
     .help = "rows from -180 deg to 180 deg, with linear interpolation"},
};
#undef AT
static const bough_schema polar_schema = {SCHEMA("a polar", bough_scene_polar, polar_keys),
                                          .check = bough_scene_check_polar};

#define AT(member) .offset = offsetof(bough_scene_polars, member)
static const bough_key polars_keys[] = {
    {.name = "source", .kind = BOUGH_KEY_TEXT, AT(source),
     .example = "Jonkman et al. 2009, NREL/TP-500-38060",
     .help = "where the data come from"},
    {.name = "polars", .kind = BOUGH_KEY_LIST, .of = &polar_schema, .count = 1, .required = true,
     AT(polar), .count_offset = offsetof(bough_scene_polars, n_polar), .help = "airfoils"},
};
#undef AT
static const bough_schema polars_schema = {
    SCHEMA("a set of polars", bough_scene_polars, polars_keys), .check = bough_scene_check_polars};

#define AT(member) .offset = offsetof(bough_scene_wind_table, member)
static const bough_key wind_table_keys[] = {
    {.name = "times", .kind = BOUGH_KEY_NUMBERS, .dimension = BOUGH_TIME, .count = 2,
     .required = true, AT(time), .count_offset = offsetof(bough_scene_wind_table, n_time),
     .example = "[0, 10 s, 12 s]", .help = "strictly increasing"},
    {.name = "speeds", .kind = BOUGH_KEY_NUMBERS, .dimension = BOUGH_SPEED, .range = ">= 0",
     .count = 2, .required = true, AT(speed),
     .count_offset = offsetof(bough_scene_wind_table, n_speed),
     .example = "[8, 8, 12 m/s]",
     .help = "speed at each time, linear between, constant before and after"},
};
#undef AT
static const bough_schema wind_table_schema = {
    SCHEMA("a table of wind speeds", bough_scene_wind_table, wind_table_keys),
    .check = bough_scene_check_wind_table};

#define AT(member) .offset = offsetof(bough_scene_wind, member)
static const bough_key wind_keys[] = {
    {.name = "kind", .kind = BOUGH_KEY_CHOICE,
     .choices = CHOICES("uniform", "power", "log", "wnd", "bts", "iec"),
     .fallback = "uniform", AT(kind),
     .help = "uniform: the same speed at all heights; power, log: by a power or a logarithmic "
             "law; wnd: uniform wind file (hub height); bts: TurbSim's box; iec: condition of IEC "
             "61400-1"},
    {.name = "condition", .kind = BOUGH_KEY_CHOICE,
     .choices = CHOICES("ntm", "etm", "ewm", "ewm-steady", "nwp", "eog", "edc", "ecd", "ews"),
     .required = true, .when_key = "kind", .when = "iec", AT(iec.condition),
     .help = "ntm: normal turbulence; etm: extreme turbulence; ewm: extreme wind with turbulence; "
             "ewm-steady: steady extreme wind; nwp: normal profile; eog: extreme operating gust; "
             "edc: extreme change of direction; ecd: coherent gust with change of direction; ews: "
             "extreme shear"},
    {.name = "class", .kind = BOUGH_KEY_CHOICE,
     .choices = CHOICES("IA+", "IA", "IB", "IC", "IIA+", "IIA", "IIB", "IIC", "IIIA+", "IIIA",
                        "IIIB", "IIIC"),
     .fallback = "IB", .when_key = "kind", .when = "iec", AT(iec.wind_class),
     .help = "reference wind speed (I to III) and turbulence (A+ to C)"},
    {.name = "intensity", .kind = BOUGH_KEY_NUMBER, .range = "> 0", .word = "class",
     .fallback = "class", .when_key = "kind", .when = "iec", AT(iec.intensity), .example = "0.12",
     .help = "intensity of the longitudinal turbulence at this speed; class: that of the class"},
    {.name = "rotor_diameter", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH,
     .range = "> 0", .word = "auto", .fallback = "auto", .when_key = "kind", .when = "iec",
     AT(iec.diameter), .example = "126 m", .help = "auto: diameter of the scene's rotor"},
    {.name = "start", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .fallback = "0",
     .when_key = "kind", .when = "iec", AT(iec.start), .example = "60 s",
     .help = "start of a gust or a change of direction"},
    {.name = "sense", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("positive", "negative"),
     .fallback = "positive", .when_key = "kind", .when = "iec", AT(iec.negative),
     .help = "sign of a change of direction (positive: clockwise seen from above) or of a shear"},
    {.name = "shear", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("vertical", "horizontal"),
     .fallback = "vertical", .when_key = "kind", .when = "iec", AT(iec.horizontal),
     .help = "direction of the shear of ews"},
    {.name = "recurrence", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("50-years", "1-year"),
     .fallback = "50-years", .when_key = "kind", .when = "iec", AT(iec.yearly),
     .help = "recurrence period of ewm and ewm-steady"},
    {.name = "seed", .kind = BOUGH_KEY_INTEGER, .range = ">= 0", .fallback = "1",
     .when_key = "kind", .when = "iec", AT(iec.seed), .example = "7",
     .help = "seed of the turbulence; the same seed gives the same wind"},
    {.name = "points", .kind = BOUGH_KEY_INTEGER, .range = "[2, 41]", .fallback = "15",
     .when_key = "kind", .when = "iec", AT(iec.points), .example = "21",
     .help = "number of points of the turbulence's grid, in height and in width"},
    {.name = "width", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = "> 0",
     .word = "auto", .fallback = "auto", .when_key = "kind", .when = "iec", AT(iec.width),
     .example = "160 m", .help = "width and height of the turbulence's grid; auto: 1.15 rotor "
                                 "diameters"},
    {.name = "time_step", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .fallback = "0.05", .when_key = "kind", .when = "iec", AT(iec.time_step),
     .example = "0.1 s", .help = "time step of the turbulence"},
    {.name = "period", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .word = "auto", .fallback = "auto", .when_key = "kind", .when = "iec", AT(iec.period),
     .example = "700 s",
     .help = "period after which the turbulence repeats; auto: the duration, at least 600 s"},
    {.name = "file", .kind = BOUGH_KEY_TEXT, .required = true, .when_key = "kind",
     .when = "wnd|bts", AT(file), .example = "turbulence.bts", .help = "relative to the scene"},
    {.name = "speed", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_SPEED, .range = ">= 0",
     AT(speed), .example = "11.4 m/s",
     .help = "horizontal speed at the reference height; required unless there is a table or a "
             "file, or the class gives the speed (ewm)"},
    {.name = "input", .kind = BOUGH_KEY_TEXT, AT(input), .example = "wind",
     .help = "name of an input, by which another program sets the speed between steps; with kind "
             "uniform, power or log"},
    {.name = "table", .kind = BOUGH_KEY_MAPPING, .of = &wind_table_schema, AT(table),
     .help = "speed over time, for gusts and ramps; replaces 'speed'"},
    {.name = "exponent", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0.2",
     .when_key = "kind", .when = "power|iec", AT(exponent), .example = "0.14",
     .help = "speed grows with height^exponent; the default for the extreme wind (ewm) is 0.11"},
    {.name = "roughness", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = "> 0",
     .fallback = "0.03", .when_key = "kind", .when = "log", AT(roughness),
     .example = "0.01 m", .help = "length z0: speed grows with ln(height/z0)"},
    {.name = "reference_height", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH,
     .range = "> 0", .required = true, .when_key = "kind", .when = "power|log|wnd|iec",
     AT(reference_height), .example = "90 m", .help = "height above ground z = 0; with kind iec "
                                        "the hub height"},
    {.name = "reference_length", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH,
     .range = "> 0", .required = true, .when_key = "kind", .when = "wnd", AT(reference_length),
     .example = "126 m",
     .help = "length over which the file's linear shears are given: the rotor's diameter"},
    {.name = "direction", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(direction), .example = "15 deg", .help = "direction to which the wind blows, from ground "
                                        "x about z: the yaw misalignment of a rotor with its axis along x"},
    {.name = "upflow", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE,
     .range = "[-1.5, 1.5]", .fallback = "0", AT(upflow), .example = "8 deg",
     .help = "inclination of the whole wind, positive upwards"},
    {.name = "veer", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(veer), .example = "10 deg",
     .help = "change of the wind's direction over 100 m of height, clockwise seen from above; "
             "zero at the reference height, which for a box is its hub height, and 90 m for other "
             "winds without one"},
    {.name = "vertical", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_SPEED, .fallback = "0",
     AT(vertical), .example = "0.5 m/s", .help = "vertical speed, upwards, at every height and "
                                        "time"},
};
#undef AT
static const bough_schema wind_schema = {SCHEMA("the wind", bough_scene_wind, wind_keys),
                                         .check = bough_scene_check_wind};

#define SWITCH(member, what)                                                                       \
    {.name = #member, .kind = BOUGH_KEY_BOOLEAN, .fallback = "true",                               \
     .offset = offsetof(bough_scene_induction, options.member), .help = what}
static const bough_key induction_keys[] = {
    SWITCH(tip_loss, "Prandtl's loss factor at the tip"),
    SWITCH(hub_loss, "Prandtl's loss factor at the hub"),
    SWITCH(tangential, "tangential induction"),
    {.name = "drag", .kind = BOUGH_KEY_BOOLEAN, .fallback = "true",
     .offset = offsetof(bough_scene_induction, drag), .help = "includes drag in the induction"},
    {.name = "high_thrust", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("smooth", "buhl"),
     .fallback = "smooth", .offset = offsetof(bough_scene_induction, options.high_thrust),
     .help = "thrust beyond the validity of momentum theory: by AeroDyn's newer formulation, or "
             "by Buhl's parabola"},
    {.name = "skew", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("none", "pitt-peters"),
     .fallback = "pitt-peters", .offset = offsetof(bough_scene_induction, skew),
     .help = "correction for oblique inflow"},
    {.name = "skewed_momentum", .kind = BOUGH_KEY_BOOLEAN, .fallback = "false",
     .when_key = "high_thrust", .when = "smooth",
     .offset = offsetof(bough_scene_induction, options.skewed_momentum), .example = "true",
     .help = "momentum theory of a disk at an angle to the wind, by Glauert: AeroDyn's SkewMomCorr"},
    {.name = "inflow", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("equilibrium", "oye"),
     .fallback = "equilibrium", .offset = offsetof(bough_scene_induction, inflow.kind),
     .help = "reaction of the induction to a change of load: immediate, or by Oye's dynamic "
             "inflow"},
    {.name = "inflow_time", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .word = "auto",
     .range = "> 0", .fallback = "auto", .when_key = "inflow", .when = "oye",
     .offset = offsetof(bough_scene_induction, inflow.time),
     .example = "5 s", .help = "slow time constant of the dynamic inflow; auto: 1.1/(1 - 1.3 a) "
                               "R/U"},
};
static const bough_schema induction_schema = {
    SCHEMA("the induction", bough_scene_induction, induction_keys)};

#define AT(member) .offset = offsetof(bough_scene_tower, member)
static const bough_key tower_keys[] = {
    {.name = "influence", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("potential", "bak"),
     .fallback = "potential", AT(influence),
     .help = "wind in front of the tower: potential flow about a cylinder, or with Bak's "
             "correction for its drag"},
    {.name = "shadow", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("none", "powles"),
     .fallback = "none", AT(shadow), .help = "wake behind the tower"},
    {.name = "height", .kind = BOUGH_KEY_NUMBERS, .dimension = BOUGH_LENGTH, .range = ">= 0",
     .count = 2, .required = true, AT(height),
     .count_offset = offsetof(bough_scene_tower, n_height), .example = "[0, 45 m, 87.6 m]",
     .help = "above the ground's origin"},
    {.name = "diameter", .kind = BOUGH_KEY_NUMBERS, .dimension = BOUGH_LENGTH, .range = "> 0",
     .count = 2, .required = true, AT(diameter),
     .count_offset = offsetof(bough_scene_tower, n_diameter), .example = "[6, 4.9 m, 3.87 m]",
     .help = "diameter at each height"},
    {.name = "drag", .kind = BOUGH_KEY_NUMBERS, .range = ">= 0", .count = 1, .fallback = "[1]",
     AT(drag), .count_offset = offsetof(bough_scene_tower, n_drag),
     .example = "[0.5]",
     .help = "drag coefficient: one for the whole tower, or one at each height; for bak, powles "
             "and "
             "the drag on a body"},
    {.name = "body", .kind = BOUGH_KEY_TEXT, AT(body_name),
     .example = "tower",
     .help = "body with a rod on which the tower's drag acts; default no drag"},
};
#undef AT
static const bough_schema tower_schema = {SCHEMA("a tower", bough_scene_tower, tower_keys),
                                          .check = bough_scene_check_tower};

#define AT(member) .offset = offsetof(bough_scene_aero, member)
static const bough_key aero_keys[] = {
    {.name = "rate", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_FREQUENCY, .range = "> 0",
     .required = true, AT(rate), .example = "50 Hz",
     .help = "sampling rate; the period is a multiple of the macro step"},
    {.name = "air_density", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_DENSITY, .range = "> 0",
     .fallback = "1.225", AT(air_density), .example = "1.2", .help = "density of the air"},
    {.name = "wind", .kind = BOUGH_KEY_MAPPING, .of = &wind_schema, .required = true, AT(wind),
     .help = "the undisturbed wind"},
    RAMP(bough_scene_aero),
    {.name = "hold", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("linear", "constant"),
     .fallback = "linear", AT(hold), .help = "continuation of the loads between samples"},
    {.name = "blade", .kind = BOUGH_KEY_FILE, .of = &aero_blade_schema, .required = true,
     AT(blade), .example = "blade-aero.yaml",
     .help = "file with the blade elements, relative to the scene"},
    {.name = "polars", .kind = BOUGH_KEY_FILE, .of = &polars_schema, .required = true, AT(polars),
     .example = "airfoils.yaml", .help = "file with the polars, relative to the scene"},
    {.name = "induction", .kind = BOUGH_KEY_MAPPING, .of = &induction_schema, AT(induction),
     .help = "parts of the blade element momentum theory"},
    {.name = "tower", .kind = BOUGH_KEY_MAPPING, .of = &tower_schema, AT(tower),
     .help = "influence of a vertical tower on the wind at the blades; default none"},
    {.name = "hub_radius", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = ">= 0",
     .required = true, AT(hub_radius), .example = "1.5 m",
     .help = "from the rotor axis to the blade roots"},
    {.name = "hub_drag_area", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0",
     AT(hub_drag_area), .example = "5",
     .help = "drag coefficient times area of the hub, in m2; drag on the rotor"},
    {.name = "dynamic_stall", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("none", "hgm"),
     .fallback = "none", AT(dynamic_stall),
     .help = "reaction of the lift to the angle of attack: immediate, or by the Beddoes-Leishman "
             "model of Hansen, Gaunaa and Madsen"},
    {.name = "interpolation", .kind = BOUGH_KEY_CHOICE,
     .choices = CHOICES("linear", "monotone-cubic"), .fallback = "linear", AT(interpolation),
     .help = "interpolation between the rows of the polars"},
    {.name = "pitching_moment", .kind = BOUGH_KEY_BOOLEAN, .fallback = "true", AT(pitching_moment),
     .help = "includes the moment coefficients of the sections"},
    {.name = "nodes", .kind = BOUGH_KEY_NUMBERS, .range = ">= 1", .count = 1, AT(nodes),
     .count_offset = offsetof(bough_scene_aero, n_node),
     .example = "[9, 15]",
     .help = "numbers of blade elements, from 1 at the root, whose flow is recorded"},
};
#undef AT
const bough_schema bough_scene_aero_schema = {
    SCHEMA("the aerodynamics", bough_scene_aero, aero_keys)};
// clang-format on
