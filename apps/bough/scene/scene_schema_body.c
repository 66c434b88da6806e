// The keys of bodies: rods, joints, modal bodies.
#include "apps/bough/scene/scene_internal.h"

// clang-format would give each field of a key a line of its own:
// clang-format off

static const char zero6[] = "[0, 0, 0, 0, 0, 0]";
static const char stiffness_form[] =
    "6 numbers, the diagonal, or 21, the upper triangle row by row";
static const char mass_form[] = "[m, cx, cy, Ixx, Iyy, Ixy] or with Izz";
static const char mass_help[] =
    "mass per length [kg/m], its centre [m], inertia matrix per length about the reference axis "
    "[kg m] in section axes (Ixy = -integral of x y; Izz = Ixx + Iyy unless given)";
static const char stiffness_help[] =
    "section stiffness [N, N m, N m2] in section axes about the reference axis; strains: shear x, "
    "shear y, axial, bend about x, bend about y, twist";

// -- structure of a rod ---------------------------------------------------------------------------

#define FILLS bough_scene_station
static const bough_schema station_schema = {.name = "a station", KEYS(
    {NAMED("span", NUMBER), AT(def.position.z), UNIT(LENGTH), .required = true, .increasing = true,
     .example = "20.5 m", .help = "position along z, from 0 at the root to the length"},
    {NAMED("twist", NUMBER), AT(def.twist), UNIT(ANGLE), .fallback = "0", .example = "13.3 deg",
     .help = "the section's axes are turned by -twist about z, like pitch"},
    {NAMED("axis", VECTOR), AT(def.position), .count = 2, UNIT(LENGTH), .fallback = "[0, 0]",
     .example = "[0.1, 0]", .help = "offset of the reference axis, x and y"},
    {NAMED("stiffness", CUSTOM), AT(def.stiffness), .read = bough_scene_read_stiffness,
     .form = stiffness_form, .required = true, .example = "[1e9, 1e9, 9.7e9, 1.8e10, 1.8e10, 5.6e9]",
     .help = stiffness_help},
    {NAMED("mass", CUSTOM), AT(def), .read = bough_scene_read_section_mass, .form = mass_form,
     .required = true, .example = "[679, 0, 0, 970, 970, 0]", .help = mass_help},
)};
#undef FILLS

#define FILLS bough_scene_structure
static const bough_schema structure_schema = {
    .name = "the structure of a rod", .check = bough_scene_check_structure, KEYS(
    {KEY(TEXT, source), .example = "Jonkman et al. 2009, NREL/TP-500-38060",
     .help = "where the data come from"},
    {KEY(NUMBER, length), UNIT(LENGTH), .range = "[1e-9, 1e9]", .example = "61.5 m",
     .help = "extent along z; default the last span, required with one station"},
    {KEY(VECTOR, damping), .count = 6, UNIT(TIME), .range = ">= 0", .fallback = zero6,
     .example = "[0, 0, 0, 3 ms, 3 ms, 3 ms]",
     .help = "for each strain: stress = stiffness (strain + damping x strain rate); a mode of frequency f has the damping "
             "ratio pi f damping"},
    {NAMED("stations", LIST), AT(station), .of = &station_schema, .count = 1, .required = true,
     COUNT_AT(n_station),
     .help = "sections along the span, with linear interpolation; one station: uniform rod"},
)};
#undef FILLS

#define FILLS bough_scene_rod
static const bough_schema rod_schema = {.name = "a rod", .check = bough_scene_check_rod, KEYS(
    {NAMED("table", FILE), AT(structure), .of = &structure_schema,
     .example = "blade-structure.yaml",
     .help = "file with the structure, relative to the scene; a uniform rod has length, stiffness "
             "and mass here instead"},
    {KEY(VECTOR, part), .count = 2, UNIT(LENGTH), .range = ">= 0", .example = "[0, 40 m]",
     .help = "part of the table, from and to along z: several rods in a chain form the whole, and "
             "carry bodies where two of them meet"},
    {NAMED("segments", INTEGER), AT(n_segment), .range = "[1, 10000]", .example = "48",
     .help = "default from simulation.accuracy"},
    {KEY(NUMBER, grading), .range = "[0, 0.5]", .fallback = "0", .example = "0.2",
     .help = "g: segments shorten from the root, the first (1 + g)/(1 - g) times as long as the last; "
             "0: equal ones. With 0.2 a blade needs about two thirds of them; its default where neither this nor "
             "'segments' is named and the rod is a tenth as stiff towards its end"},
    {NAMED("damping", VECTOR), AT(structure.damping), .count = 6, UNIT(TIME), .range = ">= 0",
     .example = "[0, 0, 0, 3 ms, 3 ms, 3 ms]", .help = "replaces the damping of the table"},
    {NAMED("length", NUMBER), AT(structure.length), UNIT(LENGTH), .range = "[1e-9, 1e9]", .example = "2 m",
     .help = "of a uniform rod"},
    {NAMED("twist", NUMBER), AT(uniform.def.twist), UNIT(ANGLE), .fallback = "0", .example = "10 deg",
     .help = "of a uniform rod"},
    {NAMED("stiffness", CUSTOM), AT(uniform.def.stiffness), .read = bough_scene_read_stiffness,
     .form = stiffness_form, .example = "[1e5, 1e5, 3e5, 20, 20, 15]",
     .help = "of a uniform rod, as in a station"},
    {NAMED("mass", CUSTOM), AT(uniform.def), .read = bough_scene_read_section_mass, .form = mass_form,
     .example = "[0.8, 0, 0, 5e-5, 5e-5, 0]", .help = "of a uniform rod, as in a station"},
)};
#undef FILLS

// -- bodies ---------------------------------------------------------------------------------------

#define FILLS bough_scene_joint
static const bough_schema joint_schema = {.name = "a joint", .check = bough_scene_check_joint, KEYS(
    {KEY(CHOICE, kind), .required = true,
     CHOICES([BOUGH_JOINT_FIXED] = "fixed", [BOUGH_JOINT_REVOLUTE] = "revolute",
             [BOUGH_JOINT_PRISMATIC] = "prismatic", [BOUGH_JOINT_SPHERICAL] = "spherical",
             [BOUGH_JOINT_FREE] = "free", [BOUGH_JOINT_CYLINDRICAL] = "cylindrical",
             [BOUGH_JOINT_UNIVERSAL] = "universal", [BOUGH_JOINT_PLANAR] = "planar"),
     .help = "kind of joint"},
    {NAMED("parent", TEXT), AT(parent_name), .required = true, .example = "hub",
     .help = "name of a body, or ground; a parent with a rod carries this body at the rod's end"},
    {KEY(CUSTOM, placement), .read = bough_scene_read_placement, .form = PLACEMENT_FORM, .fallback = "[]",
     .example = "[rotate x 120 deg, move z 1.5 m]",
     .help = "from the parent's frame to the joint's frame; each step is in the frame that the "
             "previous steps give"},
    {KEY(CHOICE, axis), AXIS, .required = true,
     WHEN("kind", "revolute|prismatic|cylindrical|universal|planar"),
     .help = "axis of the motion; of a universal joint the first axis, fixed in the parent; of a "
             "planar joint the normal of the plane"},
    {KEY(CHOICE, second_axis), AXIS, .required = true, WHEN("kind", "universal"),
     .help = "second axis, which rotates about the first"},
    {NAMED("angle", NUMBER), AT(coordinates), UNIT(ANGLE), .fallback = "0", WHEN("kind", "revolute"),
     .example = "90 deg", .help = "initial angle"},
    {NAMED("angle", NUMBER), AT(coordinates[1]), UNIT(ANGLE), .fallback = "0", WHEN("kind", "cylindrical"),
     .example = "90 deg", .help = "initial angle"},
    {NAMED("angle", NUMBER), AT(coordinates[2]), UNIT(ANGLE), .fallback = "0", WHEN("kind", "planar"),
     .example = "90 deg", .help = "initial angle"},
    {NAMED("angles", VECTOR), AT(coordinates), .count = 2, UNIT(ANGLE), .fallback = "[0, 0]", WHEN("kind", "universal"),
     .example = "[10 deg, 0]", .help = "initial angles about the two axes"},
    {NAMED("position", NUMBER), AT(coordinates), UNIT(LENGTH), .fallback = "0", WHEN("kind", "prismatic|cylindrical"),
     .example = "0.2 m", .help = "initial displacement"},
    {NAMED("positions", VECTOR), AT(coordinates), .count = 2, UNIT(LENGTH), .fallback = "[0, 0]", WHEN("kind", "planar"),
     .example = "[0.2 m, 0]",
     .help = "initial displacements along the two axes that follow the normal in x, y, z, x"},
    {NAMED("speed", NUMBER), AT(speeds), UNIT(ANGULAR_SPEED), .fallback = "0", WHEN("kind", "revolute"),
     .example = "0.5 rad/s", .help = "initial speed"},
    {NAMED("speed", NUMBER), AT(speeds), UNIT(SPEED), .fallback = "0", WHEN("kind", "prismatic|cylindrical"),
     .example = "1 m/s", .help = "initial speed"},
    {KEY(VECTOR, speeds), .count = 2, UNIT(SPEED), .fallback = "[0, 0]", WHEN("kind", "planar"),
     .example = "[1 m/s, 0]", .help = "initial speeds, along the axes of 'positions'"},
    {NAMED("angular_speed", NUMBER), AT(speeds[1]), UNIT(ANGULAR_SPEED), .fallback = "0",
     WHEN("kind", "cylindrical"), .example = "12.1 rpm", .help = "initial angular speed"},
    {NAMED("angular_speed", NUMBER), AT(speeds[2]), UNIT(ANGULAR_SPEED), .fallback = "0",
     WHEN("kind", "planar"), .example = "12.1 rpm", .help = "initial angular speed"},
    {NAMED("angular_speeds", VECTOR), AT(speeds), .count = 2, UNIT(ANGULAR_SPEED), .fallback = "[0, 0]",
     WHEN("kind", "universal"), .example = "[12.1 rpm, 0]",
     .help = "initial angular speeds about the two axes"},
    {NAMED("velocity", VECTOR), AT(speeds), .count = 3, UNIT(SPEED), .fallback = ZERO3, WHEN("kind", "free"),
     .example = "[0, 0, 2 m/s]", .help = "initial velocity in the joint's frame"},
    {NAMED("angular_velocity", VECTOR), AT(speeds), .count = 3, UNIT(ANGULAR_SPEED), .fallback = ZERO3,
     WHEN("kind", "spherical"), .example = "[0, 0, 12.1 rpm]",
     .help = "initial angular velocity in the joint's frame"},
    {NAMED("angular_velocity", VECTOR), AT(speeds[3]), .count = 3, UNIT(ANGULAR_SPEED), .fallback = ZERO3,
     WHEN("kind", "free"), .example = "[0, 0, 12.1 rpm]",
     .help = "initial angular velocity in the joint's frame"},
    {NAMED("motion", CUSTOM), .read = bough_scene_read_motion,
     WHEN("kind", "revolute|prismatic|cylindrical|universal"),
     .form = "{speed: VALUES}, {angle: VALUES} or {position: VALUES}, of cylindrical also "
             "{angular_speed: VALUES}, of universal {first: {...}, second: {...}}; VALUES a "
             "number, {from: 0, to: ..., ramp: [...]} or {times: [...], values: [...]}",
     .example = "{speed: {from: 0, to: 12.1 rpm, ramp: [0, 10 s]}}",
     .help = "prescribes the motion of the joint; the channel Trq or Frc is the torque or force "
             "that this needs; a ramp is smooth to the second derivative; a table of speeds is "
             "linear between its times, a table of positions is a cubic spline at rest at its "
             "ends, with slopes made so small that it rises and falls only where the values do; "
             "the angle of a blade's joint about z is minus the pitch that it adds"},
    {NAMED("stiffness", NUMBER), AT(spring.stiffness), .range = ">= 0", .fallback = "0",
     WHEN("kind", "revolute|prismatic"), .example = "8.7e8",
     .help = "of a spring along the axis, in N m/rad or N/m"},
    {NAMED("damping", NUMBER), AT(spring.damping), .range = ">= 0", .fallback = "0",
     WHEN("kind", "revolute|prismatic"), .example = "6.2e6",
     .help = "of a damper along the axis, in N m s/rad or N s/m"},
    {NAMED("rest", NUMBER), AT(spring.rest), UNIT(ANGLE), .fallback = "0", WHEN("kind", "revolute"),
     .example = "5 deg", .help = "angle at which the spring is free of force"},
    {NAMED("rest", NUMBER), AT(spring.rest), UNIT(LENGTH), .fallback = "0",
     WHEN("kind", "prismatic"), .example = "0.1 m",
     .help = "displacement at which the spring is free of force"},
    {NAMED("stop", VECTOR), AT(spring.low), .count = 2, UNIT(ANGLE), .fallback = "[0, 0]",
     WHEN("kind", "revolute"), .example = "[-90 deg, 90 deg]",
     .help = "angles at which elastic stops begin; needs 'stop_stiffness'"},
    {NAMED("stop", VECTOR), AT(spring.low), .count = 2, UNIT(LENGTH), .fallback = "[0, 0]",
     WHEN("kind", "prismatic"), .example = "[-0.1 m, 0.1 m]",
     .help = "displacements at which elastic stops begin; needs 'stop_stiffness'"},
    {NAMED("stop_stiffness", NUMBER), AT(spring.stop_stiffness), .range = ">= 0", .fallback = "0",
     WHEN("kind", "revolute|prismatic"), .example = "1e6",
     .help = "in N m/rad or N/m; it grows smoothly over a hundredth of the distance between the stops"},
)};
#undef FILLS

#define FILLS bough_scene_modal
static const bough_schema modal_schema = {.name = "a modal body", KEYS(
    {KEY(INTEGER, modes), .range = "[1, 300]", .fallback = "12", .example = "20",
     .help = "number of clamped modes of each piece, from the lowest frequency, besides its rigid motions"},
    {KEY(BOOLEAN, statics), .fallback = "true",
     .help = "adds the static deflections under accelerations of the frame"},
    {KEY(BOOLEAN, stiffening), .fallback = "true",
     .help = "axial forces, such as centrifugal forces, stiffen the bending"},
    {KEY(INTEGER, pieces), .range = "[1, 300]", .fallback = "5", .example = "10",
     .help = "of segmented-modal: number of parts of the rod, each linear in its own frame"},
)};
#undef FILLS

#define FILLS bough_scene_fmu
static const bough_schema fmu_schema = {.name = "an FMU", .check = bough_scene_check_fmu, KEYS(
    BOUGH_FMU_KEYS("damper.fmu", "{stiffness: 8, damping: 0.4}"),
    {KEY(TEXTS, motion), .count = 1, COUNT_AT(n_motion),
     .example = "[none, none, v, none, none, none, none, none, none]",
     .help = "names of its inputs for the frame's velocity [m/s], angular velocity [rad/s] and "
             "gravity [m/s^2], x, y and z in body axes; none: no input; default [vx, vy, vz, wx, "
             "wy, wz, gx, gy, gz]"},
    {KEY(TEXTS, wrench), .count = 1, COUNT_AT(n_wrench),
     .example = "[none, none, force, none, none, none]",
     .help = "names of its outputs for the force [N] and the moment [N m] about the frame's origin "
             "that act on the body that carries the FMU, x, y and z in body axes; none: zero; "
             "default [Fx, Fy, Fz, Mx, My, Mz]"},
    {NAMED("inputs", CHOICE), AT(hold),
     CHOICES([BOUGH_SCENE_FMU_HELD] = "held", [BOUGH_SCENE_FMU_REACHED] = "reached"),
     .fallback = "held",
     .help = "what the FMU does with its inputs in a communication step: it keeps them, and gets "
             "the motion in the middle of the step; or they are reached at the end of the step"},
    {KEY(INTEGER, steps), .range = "[1, 100000]", .fallback = "1", .example = "10",
     .help = "communication steps in a macro step"},
)};
#undef FILLS

#define FILLS bough_scene_body
const bough_schema bough_scene_body_schema = {.name = "a body", .check = bough_scene_check_body, KEYS(
    {KEY(TEXT, name), .required = true, .example = "blade1",
     .help = "letters, digits, '_' and '-'; unique"},
    {KEY(INTEGER, repeat), .range = "[1, 10000]", .fallback = "1", .example = "10",
     .help = "number of such bodies in a chain, each carried by the previous one on the same "
             "joint; their names end with numbers from 1"},
    {KEY(CHOICE, fidelity), .required = true,
     CHOICES([BOUGH_SCENE_RIGID] = "rigid", [BOUGH_SCENE_ROD] = "rod",
             [BOUGH_SCENE_MODAL] = "modal", [BOUGH_SCENE_SEGMENTED_MODAL] = "segmented-modal",
             [BOUGH_SCENE_FMU] = "fmu"),
     .help = "model of the body: rigid, a geometrically exact rod, the rod's linear modes in one "
             "frame or in pieces, or a model of another program (FMU)"},
    {KEY(MAPPING, joint), .of = &joint_schema, .required = true,
     .help = "the joint that carries the body"},
    {KEY(NUMBER, pitch), UNIT(ANGLE), .fallback = "0", .example = "6.5 deg",
     .help = "rotation of a body with a rod about its z axis by -pitch, after the joint: positive towards "
             "feather, against the sign of a joint's angle"},
    {KEY(NUMBER, mass), UNIT(MASS), .range = "[0, 1e12]", .fallback = "0",
     WHEN("fidelity", "rigid|fmu"), .example = "240 t",
     .help = "of a rigid body without a rod; of an FMU what it leaves to its carrier"},
    {KEY(VECTOR, centre_of_mass), .count = 3, UNIT(LENGTH), .fallback = ZERO3,
     WHEN("fidelity", "rigid|fmu"), .example = "[1.9, 0, 1.75]", .help = "in the body's frame"},
    {KEY(CUSTOM, inertia), .read = bough_scene_read_inertia,
     .form = "[Ixx, Iyy, Izz] or with Ixy, Ixz, Iyz, in kg m^2", .fallback = ZERO3,
     WHEN("fidelity", "rigid|fmu"), .example = "[5.1e6, 2.6e6, 2.6e6]",
     .help = "entries of the inertia matrix about the centre of mass (Ixy = -integral of x y)"},
    {KEY(MAPPING, micro), .of = &bough_scene_micro_schema,
     WHEN("fidelity", "rod|modal|segmented-modal"),
     .help = "sub-solver of this body; replaces simulation.micro"},
    {KEY(MAPPING, rod), .of = &rod_schema,
     .help = "the rod; a rigid body takes mass and inertia from it"},
    {KEY(MAPPING, modal), .of = &modal_schema, WHEN("fidelity", "modal|segmented-modal"),
     .help = "how the rod is reduced to modes"},
    {KEY(MAPPING, fmu), .of = &fmu_schema, .required = true, WHEN("fidelity", "fmu"),
     .help = "the model of the other program, at the body's frame"},
)};
#undef FILLS
// clang-format on
