// The keys of a turbine's controller.
#include "apps/bough/scene/scene_internal.h"

// clang-format off

// The constants of the law; the defaults are those of the NREL 5 MW turbine.
#define FILLS bough_controller_def
#define LAW(member, unit, given, shown, what)                                                      \
    {KEY(NUMBER, member), UNIT(unit), .fallback = given, .example = shown, .help = what}
static const bough_schema law_schema = {.name = "the law's constants", KEYS(
    LAW(corner, ANGULAR_SPEED, "1.570796 rad/s", "2 rad/s",
        "corner frequency of the low-pass filter of the generator's speed"),
    LAW(cut_in, ANGULAR_SPEED, "70.16224 rad/s", "670 rpm",
        "generator speed below which the torque is zero"),
    LAW(optimal_from, ANGULAR_SPEED, "91.21091 rad/s", "871 rpm",
        "generator speed from which the torque is optimal_gain speed^2"),
    LAW(optimal_gain, PURE_NUMBER, "2.332287", "2.4", "optimal gain, in N m s^2/rad^2"),
    LAW(rated_speed, ANGULAR_SPEED, "121.6805 rad/s", "1162 rpm",
        "generator speed from which power or torque is constant"),
    {KEY(CHOICE, above_rated),
     CHOICES([BOUGH_CONSTANT_POWER] = "power", [BOUGH_CONSTANT_TORQUE] = "torque"),
     .fallback = "power", .example = "torque",
     .help = "quantity that is constant above rated speed"},
    LAW(rated_power, POWER, "5296610", "5.3 MW", "rated mechanical power"),
    LAW(slip, PURE_NUMBER, "0.1", "0.05",
        "slip of the linear transition from the optimal to the rated torque"),
    LAW(most_torque, MOMENT, "47402.91", "47.4 kN m", "largest torque of the generator"),
    {KEY(BOOLEAN, motoring), .fallback = "false",
     .help = "an induction generator: below its synchronous speed, rated_speed / (1 + slip), it drives the "
             "rotor, by the same line down to -most_torque; needs optimal_gain 0"},
    LAW(torque_rate, PURE_NUMBER, "15000", "12e3", "largest rate of the torque, in N m/s"),
    LAW(power_pitch, ANGLE, "0.01745329 rad", "1 deg",
        "pitch above which the power is constant from optimal_from on, if the pitch is controlled"),
    LAW(reference_speed, ANGULAR_SPEED, "122.9096 rad/s", "1174 rpm",
        "generator speed to which the pitch controls"),
    LAW(proportional, PURE_NUMBER, "0.01882681", "0.02",
        "proportional gain of the pitch controller at zero pitch, in s"),
    LAW(integral, PURE_NUMBER, "0.008068634", "0.01",
        "integral gain of the pitch controller at zero pitch"),
    LAW(halving_pitch, ANGLE, "0.1099965 rad", "6.3 deg", "pitch at which both gains are halved"),
    LAW(least_pitch, ANGLE, "0", "-1 deg", "limit of the pitch"),
    LAW(most_pitch, ANGLE, "1.570796 rad", "85 deg", "limit of the pitch"),
    LAW(pitch_rate, ANGULAR_SPEED, "0.1396263 rad/s", "7 deg/s",
        "largest pitch rate, for all controllers"),
)};
#undef FILLS

#define FAULTS "pitch-stuck|pitch-runaway"
#define TURNS  "stop|emergency-stop|pitch-runaway|pitch-to|yaw-runaway"
static void check_event(bough_schema_reader *r, void *item) {
    bough_scene_event *e = item;
    bool above = bough_node_find(e->node, "above"), below = bough_node_find(e->node, "below");
    if (above + below != (e->channel != NULL)) {
        bough_schema_error(r, e->node, "", e->channel ? "'channel' needs one of 'above' and 'below'"
                                                      : "a threshold needs its 'channel'");
    }
    if (!e->channel && !bough_node_find(e->node, "at")) {
        bough_schema_error(r, e->node, "", "expected 'at' or 'channel' as the time of the event");
    }
    if (e->kind == BOUGH_SCENE_PITCH_TO && !bough_node_find(e->node, "angle")) {
        bough_schema_error(r, e->node, "", "pitch-to needs its 'angle'");
    }
    e->falls = below;
}

#define FILLS bough_scene_event
static const bough_schema event_schema = {.name = "an event", .check = check_event, KEYS(
    {KEY(CHOICE, kind),
     CHOICES([BOUGH_SCENE_START] = "start", [BOUGH_SCENE_STOP] = "stop",
             [BOUGH_SCENE_EMERGENCY_STOP] = "emergency-stop",
             [BOUGH_SCENE_GRID_LOSS] = "grid-loss", [BOUGH_SCENE_PITCH_STUCK] = "pitch-stuck",
             [BOUGH_SCENE_PITCH_RUNAWAY] = "pitch-runaway", [BOUGH_SCENE_PITCH_TO] = "pitch-to",
             [BOUGH_SCENE_YAW_RUNAWAY] = "yaw-runaway"),
     .required = true,
     .help = "start: until then the turbine idles, without torque, with the pitch of its joints; stop: pitch to "
             "feather, torque to zero in 10 s and as the rotor stops; emergency-stop: pitch to feather at the largest "
             "rate, no torque; grid-loss: no torque, the pitch is controlled; pitch-stuck: one "
             "blade keeps its pitch; pitch-runaway: one blade pitches to 'angle'; pitch-to: all "
             "blades pitch to 'angle' and stay there, while the torque is controlled, until a stop or a "
             "later pitch-to of the list; yaw-runaway: the yaw drive turns to 'angle'"},
    {KEY(NUMBER, at), UNIT(TIME), .range = ">= 0", .fallback = "0", .example = "90 s",
     .help = "time of the event; with a channel the earliest time"},
    {KEY(TEXT, channel), .example = "GenSpeed",
     .help = "channel whose threshold triggers the event; default: the event occurs at the time"},
    {NAMED("above", NUMBER), AT(threshold), .example = "1300",
     .help = "the event occurs when the channel is above this threshold, in the channel's unit"},
    {NAMED("below", NUMBER), AT(threshold), .example = "100",
     .help = "the event occurs when the channel is below this threshold, in the channel's unit"},
    {KEY(INTEGER, blade), .range = ">= 1", .required = true, WHEN("kind", FAULTS), .example = "2",
     .help = "number of the blade in turbine.blades"},
    {NAMED("body", TEXT), AT(body_name), .required = true, WHEN("kind", "yaw-runaway"),
     .example = "yaw", .help = "body on the yaw joint, which must have a motion"},
    {KEY(NUMBER, angle), UNIT(ANGLE), .word = "auto", .fallback = "auto",
     WHEN("kind", TURNS), .example = "20 deg",
     .help = "final angle, of blades the pitch, positive towards feather; auto: 90 degrees for stops, 0 "
             "for runaways; pitch-to needs a value"},
    {KEY(NUMBER, rate), UNIT(ANGULAR_SPEED), .range = "> 0", .word = "auto", .fallback = "auto",
     WHEN("kind", TURNS), .example = "2 deg/s",
     .help = "rate of the motion, for pitch at most the law's pitch_rate; auto: 4 deg/s for a "
             "stop, 0.3 deg/s for the yaw, else the law's pitch_rate"},
)};
#undef FILLS

#define FILLS bough_scene_terminals
#define SENSED(key, place, shown, what)                                                            \
    {NAMED(key, TEXT), AT(name[BOUGH_SENSED_##place]), .example = shown, .help = what}
static const bough_schema input_schema = {.name = "the inputs", KEYS(
    SENSED("time", TIME, "t", "time [s]"),
    SENSED("generator_speed", GENERATOR_SPEED, "omega", "of the fast shaft [rad/s]"),
    SENSED("rotor_speed", ROTOR_SPEED, "omega_rotor", "of the hub [rad/s]"),
    SENSED("torque", TORQUE, "T", "of the generator, on the fast shaft [N m]"),
    SENSED("power", POWER, "P", "electrical [W]"),
    SENSED("wind", WIND, "v", "undisturbed, at the hub, horizontal [m/s]"),
    SENSED("azimuth", AZIMUTH, "psi", "of blade 1 [rad]"),
    SENSED("yaw_error", YAW_ERROR, "gamma", "direction of the wind less the nacelle's [rad]"),
    {KEY(TEXTS, pitch), .count = 1, COUNT_AT(n_pitch), .example = "[beta1, beta2, beta3]",
     .help = "of each blade [rad]; none: no input"},
)};
static const bough_schema output_schema = {.name = "the outputs", KEYS(
    {NAMED("torque", TEXT), AT(name[BOUGH_SENSED_TORQUE]), .required = true, .example = "T_demand",
     .help = "of the generator, on the fast shaft [N m]"},
    {KEY(TEXTS, pitch), .count = 1, COUNT_AT(n_pitch), .example = "[beta_demand]",
     .help = "of all blades, or of each [rad]; default: the blades keep their pitch"},
)};
#undef FILLS

#define FILLS bough_scene_control_fmu
static const bough_schema fmu_schema = {.name = "an FMU", .check = bough_scene_check_control_fmu, KEYS(
    BOUGH_FMU_KEYS("controller.fmu", "{gain: 100}"),
    {KEY(MAPPING, inputs), .of = &input_schema, .required = true,
     .help = "names of its inputs for what is measured at the beginning of each sample"},
    {KEY(MAPPING, outputs), .of = &output_schema, .required = true,
     .help = "names of its outputs for what it demands by the end of the sample"},
)};
#undef FILLS

static void check_control(bough_schema_reader *r, void *item) {
    bough_scene_control *c = item;
    if (!c->pitch) c->law.power_pitch = INFINITY; // the law's power region does not depend on a pitch that is not controlled
    if (c->kind != BOUGH_SCENE_BLADED) return;
    if (c->library) c->library = bough_schema_path(r, c->node, "library", c->library);
    c->input = c->input && c->input[0] ? bough_schema_path(r, c->node, "input", c->input) : "";
}

#define FILLS bough_scene_control
const bough_schema bough_scene_control_schema = {.name = "the control", .check = check_control, KEYS(
    {KEY(CHOICE, kind),
     CHOICES([BOUGH_SCENE_VARIABLE_SPEED] = "variable-speed", [BOUGH_SCENE_BLADED] = "bladed",
             [BOUGH_SCENE_EXTERNAL] = "external", [BOUGH_SCENE_CONTROL_FMU] = "fmu"), .required = true,
     .help = "variable-speed: the baseline law of the NREL 5 MW turbine; bladed: a shared library "
             "with Bladed's interface (function DISCON); external: another program, by the inputs "
             "GenTqCom (torque on the fast shaft) and BlPitchCom1, 2 ...; fmu: an FMU"},
    {KEY(NUMBER, rate), UNIT(FREQUENCY), .range = "> 0", .fallback = "50", .example = "80 Hz",
     .help = "sampling rate; the period is a multiple of the macro step"},
    {KEY(NUMBER, gear_ratio), .range = "> 0", .fallback = "97", .example = "105",
     .help = "generator speed divided by rotor speed"},
    {KEY(NUMBER, efficiency), .range = "(0, 1]", .fallback = "0.944", .example = "0.965",
     .help = "electrical power divided by mechanical power of the generator; the inverse where the generator "
             "drives the rotor"},
    {KEY(BOOLEAN, pitch), .fallback = "true",
     .help = "controls the pitch of the blades, which need joints that can pitch; false: torque only"},
    {NAMED("individual_pitch", BOOLEAN), AT(individual), .fallback = "false",
     WHEN("kind", "bladed"), .example = "true",
     .help = "each blade follows its own demand (records 42 to 44) instead of the collective one "
             "(record 45)"},
    {KEY(TEXT, library), .required = true, WHEN("kind", "bladed"), .example = "libdiscon.so",
     .help = "file relative to the scene"},
    {KEY(TEXT, input), WHEN("kind", "bladed"), .example = "DISCON.IN",
     .help = "the controller's own input file, relative to the scene"},
    {KEY(MAPPING, fmu), .of = &fmu_schema, .required = true, WHEN("kind", "fmu"),
     .help = "model of another program, which takes a communication step in each sample"},
    {KEY(MAPPING, law), .of = &law_schema,
     .help = "constants of the control law; the defaults are those of the NREL 5 MW turbine"},
    {NAMED("events", LIST), AT(event), .of = &event_schema, COUNT_AT(n_event),
     .help = "events of the turbine, at most 8"},
)};
#undef FILLS
// clang-format on
