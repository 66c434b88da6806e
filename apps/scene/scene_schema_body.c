// The keys of bodies: rods, joints, modal bodies.
#include "apps/scene/scene_tables.h"

// One line a key would become one line a field:
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

#define AT(member) .offset = offsetof(bough_scene_station, member)
static const bough_key station_keys[] = {
    {.name = "span", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .required = true,
     .offset = offsetof(bough_scene_station, position) + 2 * sizeof(double),
     .example = "20.5 m", .help = "position along z, from 0 at the root to the length"},
    {.name = "twist", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(twist), .example = "13.3 deg",
     .help = "the section's axes are turned by -twist about z, like pitch"},
    {.name = "axis", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_axis_offset,
     .form = "[x, y] in m", .fallback = "[0, 0]", AT(position),
     .example = "[0.1, 0]", .help = "offset of the reference axis"},
    {.name = "stiffness", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_stiffness,
     .form = stiffness_form, .required = true, AT(stiffness),
     .example = "[1e9, 1e9, 9.7e9, 1.8e10, 1.8e10, 5.6e9]",
     .help = stiffness_help},
    {.name = "mass", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_section_mass,
     .form = mass_form, .required = true, .offset = 0, .example = "[679, 0, 0, 970, 970, 0]",
     .help = mass_help},
};
#undef AT
static const bough_schema station_schema = {SCHEMA("a station", bough_scene_station, station_keys)};

#define AT(member) .offset = offsetof(bough_scene_structure, member)
static const bough_key structure_keys[] = {
    {.name = "source", .kind = BOUGH_KEY_TEXT, AT(source),
     .example = "Jonkman et al. 2009, NREL/TP-500-38060",
     .help = "where the data come from"},
    {.name = "length", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = "> 0",
     AT(length), .example = "61.5 m",
     .help = "extent along z; default the last span, required with one station"},
    {.name = "damping", .kind = BOUGH_KEY_VECTOR, .count = 6, .dimension = BOUGH_TIME,
     .range = ">= 0", .fallback = zero6, AT(damping),
     .example = "[0, 0, 0, 3 ms, 3 ms, 3 ms]",
     .help = "for each strain: stress = stiffness (strain + damping x strain rate)"},
    {.name = "stations", .kind = BOUGH_KEY_LIST, .of = &station_schema, .count = 1,
     .required = true, AT(station), .count_offset = offsetof(bough_scene_structure, n_station),
     .help = "sections along the span, with linear interpolation; one station: uniform rod"},
};
#undef AT
static const bough_schema structure_schema = {
    SCHEMA("the structure of a rod", bough_scene_structure, structure_keys),
    .check = bough_scene_check_structure};

#define AT(member) .offset = offsetof(bough_scene_rod, member)
static const bough_key rod_keys[] = {
    {.name = "table", .kind = BOUGH_KEY_FILE, .of = &structure_schema, AT(structure),
     .example = "blade-structure.yaml",
     .help = "file with the structure, relative to the scene; a uniform rod has length, stiffness "
             "and mass here instead"},
    {.name = "part", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_LENGTH,
     .range = ">= 0", AT(part),
     .example = "[0, 40 m]",
     .help = "part of the table, from and to along z: several rods in a chain form the whole, and "
             "carry bodies where two of them meet"},
    {.name = "segments", .kind = BOUGH_KEY_INTEGER, .range = "[1, 10000]", .fallback = "24",
     AT(n_segment), .example = "48", .help = "segments of equal length"},
    {.name = "damping", .kind = BOUGH_KEY_VECTOR, .count = 6, .dimension = BOUGH_TIME,
     .range = ">= 0", AT(damping), .example = "[0, 0, 0, 3 ms, 3 ms, 3 ms]",
     .help = "replaces the damping of the table"},
    {.name = "length", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = "> 0",
     AT(length), .example = "2 m", .help = "of a uniform rod"},
    {.name = "twist", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(uniform.twist), .example = "10 deg", .help = "of a uniform rod"},
    {.name = "stiffness", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_stiffness,
     .form = stiffness_form, AT(uniform.stiffness), .example = "[1e5, 1e5, 3e5, 20, 20, 15]",
     .help = "of a uniform rod, as in a station"},
    {.name = "mass", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_section_mass,
     .form = mass_form, AT(uniform), .example = "[0.8, 0, 0, 5e-5, 5e-5, 0]",
     .help = "of a uniform rod, as in a station"},
};
#undef AT
static const bough_schema rod_schema = {SCHEMA("a rod", bough_scene_rod, rod_keys),
                                        .check = bough_scene_check_rod};

// -- bodies ---------------------------------------------------------------------------------------

#define AT(member) .offset = offsetof(bough_scene_joint, member)
static const bough_key joint_keys[] = {
    {.name = "kind", .kind = BOUGH_KEY_CHOICE, .required = true, AT(kind),
     .choices = CHOICES("fixed", "revolute", "prismatic", "spherical", "free", "cylindrical",
                        "universal", "planar"),
     .help = "kind of joint"},
    {.name = "parent", .kind = BOUGH_KEY_TEXT, .required = true, AT(parent_name),
     .example = "hub",
     .help = "name of a body, or ground; a parent with a rod carries this body at the rod's end"},
    {.name = "placement", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_placement,
     .form = PLACEMENT_FORM, .offset = 0,
     .example = "[rotate x 120 deg, move z 1.5 m]",
     .help = "from the parent's frame to the joint's frame; each step is in the frame that the "
             "previous steps give"},
    {.name = "axis", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("x", "y", "z"), .required = true,
     .when_key = "kind", .when = "revolute|prismatic|cylindrical|universal|planar", AT(axis),
     .help = "axis of the motion; of a universal joint the first axis, fixed in the parent; of a "
             "planar joint the normal of the plane"},
    {.name = "second_axis", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("x", "y", "z"),
     .required = true, .when_key = "kind", .when = "universal", AT(second_axis),
     .help = "second axis, which rotates about the first"},
    {.name = "angle", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     .when_key = "kind", .when = "revolute", AT(position), .example = "90 deg",
     .help = "initial angle"},
    {.name = "angle", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     .when_key = "kind", .when = "cylindrical|planar", AT(angle), .example = "90 deg",
     .help = "initial angle"},
    {.name = "angles", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_ANGLE,
     .fallback = "[0, 0]", .when_key = "kind", .when = "universal", AT(angles),
     .example = "[10 deg, 0]", .help = "initial angles about the two axes"},
    {.name = "position", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .fallback = "0",
     .when_key = "kind", .when = "prismatic|cylindrical", AT(position),
     .example = "0.2 m", .help = "initial displacement"},
    {.name = "positions", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_LENGTH,
     .fallback = "[0, 0]", .when_key = "kind", .when = "planar", AT(positions),
     .example = "[0.2 m, 0]",
     .help = "initial displacements along the two axes that follow the normal in x, y, z, x"},
    {.name = "speed", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGULAR_SPEED, .fallback = "0",
     .when_key = "kind", .when = "revolute", AT(speed), .example = "0.5 rad/s",
     .help = "initial speed"},
    {.name = "speed", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_SPEED, .fallback = "0",
     .when_key = "kind", .when = "prismatic|cylindrical", AT(speed), .example = "1 m/s",
     .help = "initial speed"},
    {.name = "speeds", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_SPEED,
     .fallback = "[0, 0]", .when_key = "kind", .when = "planar", AT(speeds),
     .example = "[1 m/s, 0]", .help = "initial speeds, along the axes of 'positions'"},
    {.name = "angular_speed", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGULAR_SPEED,
     .fallback = "0", .when_key = "kind", .when = "cylindrical|planar", AT(angular_speed),
     .example = "12.1 rpm", .help = "initial angular speed"},
    {.name = "angular_speeds", .kind = BOUGH_KEY_VECTOR, .count = 2,
     .dimension = BOUGH_ANGULAR_SPEED, .fallback = "[0, 0]", .when_key = "kind",
     .when = "universal", AT(angular_speeds), .example = "[12.1 rpm, 0]",
     .help = "initial angular speeds about the two axes"},
    {.name = "velocity", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_SPEED,
     .fallback = ZERO3, .when_key = "kind", .when = "free", AT(velocity),
     .example = "[0, 0, 2 m/s]", .help = "initial velocity in the joint's frame"},
    {.name = "angular_velocity", .kind = BOUGH_KEY_VECTOR, .count = 3,
     .dimension = BOUGH_ANGULAR_SPEED, .fallback = ZERO3, .when_key = "kind",
     .when = "spherical|free", AT(angular_velocity),
     .example = "[0, 0, 12.1 rpm]", .help = "initial angular velocity in the joint's frame"},
    {.name = "motion", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_motion,
     .when_key = "kind",
     .when = "revolute|prismatic|cylindrical|universal", .offset = 0,
     .form = "{speed: VALUES}, {angle: VALUES} or {position: VALUES}, of cylindrical also "
             "{angular_speed: VALUES}, of universal {first: {...}, second: {...}}; VALUES a "
             "number, "
             "{from: 0, to: ..., ramp: [...]} or {times: [...], values: [...]}",
     .example = "{speed: {from: 0, to: 12.1 rpm, ramp: [0, 10 s]}}",
     .help = "prescribes the motion of the joint; the channel Trq or Frc is the torque or force "
             "that this needs; a ramp is smooth to the second derivative; a table of speeds is "
             "linear between its times, a table of positions is a cubic spline at rest at its ends"},
    {.name = "stiffness", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0",
     .when_key = "kind", .when = "revolute|prismatic", AT(spring.stiffness),
     .example = "8.7e8", .help = "of a spring along the axis, in N m/rad or N/m"},
    {.name = "damping", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0",
     .when_key = "kind", .when = "revolute|prismatic", AT(spring.damping),
     .example = "6.2e6", .help = "of a damper along the axis, in N m s/rad or N s/m"},
    {.name = "rest", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     .when_key = "kind", .when = "revolute", AT(spring.rest), .example = "5 deg",
     .help = "angle at which the spring is free of force"},
    {.name = "rest", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .fallback = "0",
     .when_key = "kind", .when = "prismatic", AT(spring.rest),
     .example = "0.1 m", .help = "displacement at which the spring is free of force"},
    {.name = "stop", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_ANGLE,
     .fallback = "[0, 0]", .when_key = "kind", .when = "revolute", AT(spring.low),
     .example = "[-90 deg, 90 deg]",
     .help = "angles at which elastic stops begin; needs 'stop_stiffness'"},
    {.name = "stop", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_LENGTH,
     .fallback = "[0, 0]", .when_key = "kind", .when = "prismatic", AT(spring.low),
     .example = "[-0.1 m, 0.1 m]",
     .help = "displacements at which elastic stops begin; needs 'stop_stiffness'"},
    {.name = "stop_stiffness", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0",
     .when_key = "kind", .when = "revolute|prismatic", AT(spring.stop_stiffness),
     .example = "1e6",
     .help = "in N m/rad or N/m; it grows smoothly over a hundredth of the distance between the "
             "stops"},
};
#undef AT
static const bough_schema joint_schema = {SCHEMA("a joint", bough_scene_joint, joint_keys),
                                          .check = bough_scene_check_joint};

#define AT(member) .offset = offsetof(bough_scene_modal, member)
static const bough_key modal_keys[] = {
    {.name = "modes", .kind = BOUGH_KEY_INTEGER, .range = "[1, 300]", .fallback = "12", AT(modes),
     .example = "20",
     .help = "number of clamped modes of each piece, from the lowest frequency, besides its rigid "
             "motions"},
    {.name = "statics", .kind = BOUGH_KEY_BOOLEAN, .fallback = "true", AT(statics),
     .help = "adds the static deflections under accelerations of the frame"},
    {.name = "stiffening", .kind = BOUGH_KEY_BOOLEAN, .fallback = "true", AT(stiffening),
     .help = "axial forces, such as centrifugal forces, stiffen the bending"},
    {.name = "pieces", .kind = BOUGH_KEY_INTEGER, .range = "[1, 300]", .fallback = "5", AT(pieces),
     .example = "10", .help = "of segmented-modal: number of parts of the rod, each linear in its "
                              "own frame"},
};
#undef AT
static const bough_schema modal_schema = {
    SCHEMA("a modal body", bough_scene_modal, modal_keys)};

#define AT(member) .offset = offsetof(bough_scene_fmu, member)
static const bough_key fmu_keys[] = {
    {.name = "folder", .kind = BOUGH_KEY_TEXT, .required = true, AT(folder), .example = "damper",
     .help = "unpacked FMU of FMI 3.0 for co-simulation, relative to the scene"},
    {.name = "motion", .kind = BOUGH_KEY_TEXTS, .count = 1, AT(motion),
     .count_offset = offsetof(bough_scene_fmu, n_motion),
     .example = "[none, none, v, none, none, none, none, none, none]",
     .help = "names of its inputs for the frame's velocity [m/s], angular velocity [rad/s] and "
             "gravity [m/s^2], x, y and z in body axes; none: no input; default [vx, vy, vz, wx, wy, wz, "
             "gx, gy, gz]"},
    {.name = "wrench", .kind = BOUGH_KEY_TEXTS, .count = 1, AT(wrench),
     .count_offset = offsetof(bough_scene_fmu, n_wrench),
     .example = "[none, none, force, none, none, none]",
     .help = "names of its outputs for the force [N] and the moment [N m] about the frame's origin "
             "that act on the body that carries the FMU, x, y and z in body axes; none: zero; default "
             "[Fx, Fy, Fz, Mx, My, Mz]"},
    {.name = "inputs", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("held", "reached"),
     .fallback = "held", AT(hold),
     .help = "what the FMU does with its inputs in a communication step: it keeps them, and gets the "
             "motion in the middle of the step; or they are reached at the end of the step, as FMUs of "
             "bough do"},
    {.name = "steps", .kind = BOUGH_KEY_INTEGER, .range = "[1, 100000]", .fallback = "1", AT(steps),
     .example = "10", .help = "communication steps in a macro step"},
};
#undef AT
static const bough_schema fmu_schema = {SCHEMA("an FMU", bough_scene_fmu, fmu_keys),
                                        .check = bough_scene_check_fmu};

#define AT(member) .offset = offsetof(bough_scene_body, member)
static const bough_key body_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name),
     .example = "blade1", .help = "letters, digits, '_' and '-'; unique"},
    {.name = "repeat", .kind = BOUGH_KEY_INTEGER, .range = "[1, 10000]", .fallback = "1",
     AT(repeat), .example = "10",
     .help = "number of such bodies in a chain, each carried by the previous one on the same "
             "joint; their names end with numbers from 1"},
    {.name = "fidelity", .kind = BOUGH_KEY_CHOICE, .required = true, AT(fidelity),
     .choices = CHOICES("rigid", "rod", "modal", "segmented-modal", "fmu"),
     .help = "model of the body: rigid, a geometrically exact rod, the rod's linear modes in one "
             "frame or in pieces, or a model of another program (FMU)"},
    {.name = "joint", .kind = BOUGH_KEY_MAPPING, .of = &joint_schema, .required = true, AT(joint),
     .help = "the joint that carries the body"},
    {.name = "pitch", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(pitch), .example = "6.5 deg",
     .help = "rotation of a body with a rod about its z axis by -pitch, after the joint"},
    {.name = "mass", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_MASS, .range = "[0, 1e12]",
     .fallback = "0", .when_key = "fidelity", .when = "rigid|fmu", AT(mass),
     .example = "240 t", .help = "of a rigid body without a rod; of an FMU what it leaves to its carrier"},
    {.name = "centre_of_mass", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = ZERO3, .when_key = "fidelity", .when = "rigid|fmu", AT(centre_of_mass),
     .example = "[1.9, 0, 1.75]", .help = "in the body's frame"},
    {.name = "inertia", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_inertia,
     .form = "[Ixx, Iyy, Izz] or with Ixy, Ixz, Iyz, in kg m^2", .fallback = ZERO3,
     .when_key = "fidelity", .when = "rigid|fmu", AT(inertia),
     .example = "[5.1e6, 2.6e6, 2.6e6]",
     .help = "entries of the inertia matrix about the centre of mass (Ixy = -integral of x y)"},
    {.name = "micro", .kind = BOUGH_KEY_MAPPING, .of = &bough_scene_micro_schema,
     .when_key = "fidelity",
     .when = "rod|modal|segmented-modal", AT(micro),
     .help = "sub-solver of this body; replaces simulation.micro"},
    {.name = "rod", .kind = BOUGH_KEY_MAPPING, .of = &rod_schema, AT(rod),
     .help = "the rod; a rigid body takes mass and inertia from it"},
    {.name = "modal", .kind = BOUGH_KEY_MAPPING, .of = &modal_schema, .when_key = "fidelity",
     .when = "modal|segmented-modal", AT(modal), .help = "how the rod is reduced to modes"},
    {.name = "fmu", .kind = BOUGH_KEY_MAPPING, .of = &fmu_schema, .required = true,
     .when_key = "fidelity", .when = "fmu", AT(fmu),
     .help = "the model of the other program, at the body's frame"},
};
#undef AT
const bough_schema bough_scene_body_schema = {SCHEMA("a body", bough_scene_body, body_keys)};
// clang-format on
