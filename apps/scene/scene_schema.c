// The keys of a scene and of its data files.
#include "apps/scene/scene_parts.h"

// One line a key would become one line a field:
// clang-format off
#define COUNT(table) (int)(sizeof(table) / sizeof(table)[0])
#define CHOICES(...) (const char *const[]){__VA_ARGS__, NULL}
#define SCHEMA(what, type, keys)                                                                   \
    .name = what, .size = sizeof(type), .n_key = COUNT(keys), .key = keys

static const char zero3[] = "[0, 0, 0]";
static const char zero6[] = "[0, 0, 0, 0, 0, 0]";
static const char stiffness_form[] =
    "6 numbers, the diagonal, or 21, the upper triangle row by row";
static const char placement_form[] = "list of 'move x|y|z LENGTH' and 'rotate x|y|z ANGLE'";
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
     .help = "position along z, from 0 at the root to the length"},
    {.name = "twist", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(twist), .help = "the section's axes are turned by -twist about z, like pitch"},
    {.name = "axis", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_axis_offset,
     .form = "[x, y] in m", .fallback = "[0, 0]", AT(position),
     .help = "offset of the reference axis"},
    {.name = "stiffness", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_stiffness,
     .form = stiffness_form, .required = true, AT(stiffness), .help = stiffness_help},
    {.name = "mass", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_section_mass,
     .form = mass_form, .required = true, .offset = 0, .help = mass_help},
};
#undef AT
static const bough_schema station_schema = {SCHEMA("a station", bough_scene_station, station_keys)};

#define AT(member) .offset = offsetof(bough_scene_structure, member)
static const bough_key structure_keys[] = {
    {.name = "source", .kind = BOUGH_KEY_TEXT, AT(source), .help = "where the data come from"},
    {.name = "length", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = "> 0",
     AT(length), .help = "extent along z; default the last span, required with one station"},
    {.name = "damping", .kind = BOUGH_KEY_VECTOR, .count = 6, .dimension = BOUGH_TIME,
     .range = ">= 0", .fallback = zero6, AT(damping),
     .help = "per strain: stress = stiffness (strain + damping x strain rate)"},
    {.name = "stations", .kind = BOUGH_KEY_LIST, .of = &station_schema, .count = 1,
     .required = true, AT(station), .count_offset = offsetof(bough_scene_structure, n_station),
     .help = "sections along the span, linear between; one station: uniform"},
};
#undef AT
static const bough_schema structure_schema = {
    SCHEMA("the structure of a rod", bough_scene_structure, structure_keys),
    .check = bough_scene_check_structure};

#define AT(member) .offset = offsetof(bough_scene_rod, member)
static const bough_key rod_keys[] = {
    {.name = "table", .kind = BOUGH_KEY_FILE, .of = &structure_schema, AT(structure),
     .help = "file with the structure, relative to the scene; without it give length, stiffness "
             "and mass of a uniform rod here"},
    {.name = "part", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_LENGTH,
     .range = ">= 0", AT(part),
     .help = "stretch of the table [from, to] along z: rods in a row are the whole, and bodies "
             "hang where two meet"},
    {.name = "segments", .kind = BOUGH_KEY_INTEGER, .range = "[1, 10000]", .fallback = "24",
     AT(n_segment), .help = "segments of equal length"},
    {.name = "damping", .kind = BOUGH_KEY_VECTOR, .count = 6, .dimension = BOUGH_TIME,
     .range = ">= 0", AT(damping), .help = "in place of the table's"},
    {.name = "length", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = "> 0",
     AT(length), .help = "of a uniform rod"},
    {.name = "twist", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(uniform.twist), .help = "of a uniform rod"},
    {.name = "stiffness", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_stiffness,
     .form = stiffness_form, AT(uniform.stiffness), .help = "of a uniform rod, as in a station"},
    {.name = "mass", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_section_mass,
     .form = mass_form, AT(uniform), .help = "of a uniform rod, as in a station"},
};
#undef AT
static const bough_schema rod_schema = {SCHEMA("a rod", bough_scene_rod, rod_keys),
                                        .check = bough_scene_check_rod};

// -- solvers ------------------------------------------------------------------------------------

#define RTOL(value)                                                                                \
    {.name = "rtol", .kind = BOUGH_KEY_NUMBER, .range = "[1e-14, 0.1]", .fallback = value,         \
     .offset = offsetof(bough_scene_solver, rtol), .help = "relative tolerance"}
static const bough_key master_keys[] = {
    {.name = "solver", .kind = BOUGH_KEY_CHOICE, .fallback = "ida",
     .choices = CHOICES("ida", "radau5"), .offset = offsetof(bough_scene_solver, solver),
     .help = "time integrator: BDF of variable order, or Radau IIA of order 5, which input that "
             "jumps does not slow, with dense algebra, for trees of up to some hundred states; the "
             "monolithic scheme has its own, ida"},
    RTOL("1e-6"),
};
#define AT(field) .offset = offsetof(bough_scene_solver, field)
static const bough_key micro_keys[] = {
    {.name = "solver", .kind = BOUGH_KEY_CHOICE, .fallback = "cvode-bdf",
     .choices = CHOICES("cvode-bdf", "generalized-alpha", "arkode-esdirk",
                        "rosenbrock"), AT(solver),
     .help = "time integrator of each rod"},
    RTOL("1e-4"),
    {.name = "step", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "[1e-7, 10]",
     .fallback = "5e-3", AT(step), .help = "of generalized-alpha and rosenbrock: longest step"},
    {.name = "rho", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0.8", AT(rho),
     .help = "of generalized-alpha: what a step leaves of the highest frequencies"},
};
#undef AT
static const bough_schema master_schema = {SCHEMA("a solver", bough_scene_solver, master_keys)};
static const bough_schema micro_schema = {SCHEMA("a solver", bough_scene_solver, micro_keys)};

// -- bodies ----------------------------------------------------------------------------------------

#define AT(member) .offset = offsetof(bough_scene_joint, member)
static const bough_key joint_keys[] = {
    {.name = "kind", .kind = BOUGH_KEY_CHOICE, .required = true, AT(kind),
     .choices = CHOICES("fixed", "revolute", "prismatic", "spherical", "free", "cylindrical",
                        "universal", "planar"),
     .help = "what the joint lets move"},
    {.name = "parent", .kind = BOUGH_KEY_TEXT, .required = true, AT(parent_name),
     .help = "name of a body, or ground; on a body with a rod this one hangs at the rod's end"},
    {.name = "placement", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_placement,
     .form = placement_form, .offset = 0,
     .help = "from the parent's frame to the joint's, each step in the frame reached so far"},
    {.name = "axis", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("x", "y", "z"), .required = true,
     .when_key = "kind", .when = "revolute|prismatic|cylindrical|universal|planar", AT(axis),
     .help = "axis of the motion; of a universal joint the first, which does not move; of a planar "
             "joint the plane's normal"},
    {.name = "second_axis", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("x", "y", "z"),
     .required = true, .when_key = "kind", .when = "universal", AT(second_axis),
     .help = "another axis, which the turn about the first takes along"},
    {.name = "angle", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     .when_key = "kind", .when = "revolute", AT(position), .help = "initial angle"},
    {.name = "angle", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     .when_key = "kind", .when = "cylindrical|planar", AT(angle), .help = "initial angle"},
    {.name = "angles", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_ANGLE,
     .fallback = "[0, 0]", .when_key = "kind", .when = "universal", AT(angles),
     .help = "initial angles about the two axes"},
    {.name = "position", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .fallback = "0",
     .when_key = "kind", .when = "prismatic|cylindrical", AT(position),
     .help = "initial displacement"},
    {.name = "positions", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_LENGTH,
     .fallback = "[0, 0]", .when_key = "kind", .when = "planar", AT(positions),
     .help = "initial displacements along the two axes that follow the normal in x, y, z, x"},
    {.name = "speed", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGULAR_SPEED, .fallback = "0",
     .when_key = "kind", .when = "revolute", AT(speed), .help = "initial speed"},
    {.name = "speed", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_SPEED, .fallback = "0",
     .when_key = "kind", .when = "prismatic|cylindrical", AT(speed), .help = "initial speed"},
    {.name = "speeds", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_SPEED,
     .fallback = "[0, 0]", .when_key = "kind", .when = "planar", AT(speeds),
     .help = "initial speeds, along the axes of 'positions'"},
    {.name = "angular_speed", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGULAR_SPEED,
     .fallback = "0", .when_key = "kind", .when = "cylindrical|planar", AT(angular_speed),
     .help = "initial speed of the angle"},
    {.name = "angular_speeds", .kind = BOUGH_KEY_VECTOR, .count = 2,
     .dimension = BOUGH_ANGULAR_SPEED, .fallback = "[0, 0]", .when_key = "kind",
     .when = "universal", AT(angular_speeds), .help = "initial speeds of the angles"},
    {.name = "velocity", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_SPEED,
     .fallback = zero3, .when_key = "kind", .when = "free", AT(velocity),
     .help = "initial velocity in the joint's frame"},
    {.name = "angular_velocity", .kind = BOUGH_KEY_VECTOR, .count = 3,
     .dimension = BOUGH_ANGULAR_SPEED, .fallback = zero3, .when_key = "kind",
     .when = "spherical|free", AT(angular_velocity),
     .help = "initial angular velocity in the joint's frame"},
    {.name = "motion", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_motion, .when_key = "kind",
     .when = "revolute|prismatic|cylindrical|universal", .offset = 0,
     .form = "{speed: VALUES}, {angle: VALUES} or {position: VALUES}, of cylindrical also "
             "{angular_speed: VALUES}, of universal {first: {...}, second: {...}}; VALUES a number, "
             "{from: 0, to: ..., ramp: [...]} or {times: [...], values: [...]}",
     .help = "makes the joint move so, whatever force that takes (channel Trq or Frc); a ramp is "
             "smooth to the second derivative, a table of speeds linear, of positions a cubic "
             "spline at rest at its ends"},
    {.name = "stiffness", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0",
     .when_key = "kind", .when = "revolute|prismatic", AT(stiffness),
     .help = "of a spring along the axis, in N m/rad or N/m"},
    {.name = "damping", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0",
     .when_key = "kind", .when = "revolute|prismatic", AT(damping),
     .help = "of a damper along the axis, in N m s/rad or N s/m"},
    {.name = "rest", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     .when_key = "kind", .when = "revolute", AT(rest), .help = "angle at which the spring is free"},
    {.name = "rest", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .fallback = "0",
     .when_key = "kind", .when = "prismatic", AT(rest),
     .help = "displacement at which the spring is free"},
    {.name = "stop", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_ANGLE,
     .fallback = "[0, 0]", .when_key = "kind", .when = "revolute", AT(stop),
     .help = "angles at which elastic stops begin; needs 'stop_stiffness'"},
    {.name = "stop", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_LENGTH,
     .fallback = "[0, 0]", .when_key = "kind", .when = "prismatic", AT(stop),
     .help = "displacements at which elastic stops begin; needs 'stop_stiffness'"},
    {.name = "stop_stiffness", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0",
     .when_key = "kind", .when = "revolute|prismatic", AT(stop_stiffness),
     .help = "in N m/rad or N/m; reached softly over a hundredth of the way between the stops"},
};
#undef AT
static const bough_schema joint_schema = {SCHEMA("a joint", bough_scene_joint, joint_keys),
                                          .check = bough_scene_check_joint};

#define AT(member) .offset = offsetof(bough_scene_modal, member)
static const bough_key modal_keys[] = {
    {.name = "modes", .kind = BOUGH_KEY_INTEGER, .range = "[1, 300]", .fallback = "12", AT(modes),
     .help = "clamped modes of each piece, from the lowest frequency, beside its rigid motions"},
    {.name = "statics", .kind = BOUGH_KEY_BOOLEAN, .fallback = "true", AT(statics),
     .help = "add the static answers to accelerations of the frame"},
    {.name = "stiffening", .kind = BOUGH_KEY_BOOLEAN, .fallback = "true", AT(stiffening),
     .help = "bending is stiffened by axial forces, centrifugal ones first of all"},
    {.name = "pieces", .kind = BOUGH_KEY_INTEGER, .range = "[1, 300]", .fallback = "5", AT(pieces),
     .help = "of segmented-modal: parts of the rod, each linear in its own frame"},
};
#undef AT
static const bough_schema modal_schema = {
    SCHEMA("a modal body", bough_scene_modal, modal_keys)};

#define AT(member) .offset = offsetof(bough_scene_body, member)
static const bough_key body_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name),
     .help = "letters, digits, '_' and '-'; unique"},
    {.name = "repeat", .kind = BOUGH_KEY_INTEGER, .range = "[1, 100000]", .fallback = "1",
     AT(repeat), .help = "so many such bodies in a row, each hung on the one before by the same "
                         "joint; named with numbers from 1"},
    {.name = "fidelity", .kind = BOUGH_KEY_CHOICE, .required = true, AT(fidelity),
     .choices = CHOICES("rigid", "rod", "modal", "segmented-modal"),
     .help = "how the body is modelled: rigid, its rod, or the rod's linear modes in one frame or "
             "in pieces"},
    {.name = "joint", .kind = BOUGH_KEY_MAPPING, .of = &joint_schema, .required = true, AT(joint),
     .help = "the joint that carries the body"},
    {.name = "pitch", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(pitch), .help = "last rotation of a body with a rod, about its z by -pitch"},
    {.name = "mass", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_MASS, .range = ">= 0",
     .fallback = "0", .when_key = "fidelity", .when = "rigid", AT(mass),
     .help = "of a rigid body without a rod"},
    {.name = "centre_of_mass", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = zero3, .when_key = "fidelity", .when = "rigid", AT(centre_of_mass),
     .help = "in the body's frame"},
    {.name = "inertia", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_inertia,
     .form = "[Ixx, Iyy, Izz] or with Ixy, Ixz, Iyz, in kg m^2", .fallback = zero3,
     .when_key = "fidelity", .when = "rigid", AT(inertia),
     .help = "entries of the inertia matrix about the centre of mass (Ixy = -integral of x y)"},
    {.name = "micro", .kind = BOUGH_KEY_MAPPING, .of = &micro_schema, .when_key = "fidelity",
     .when = "rod|modal|segmented-modal", AT(micro), .help = "sub-solver of this body in place of simulation.micro"},
    {.name = "rod", .kind = BOUGH_KEY_MAPPING, .of = &rod_schema, AT(rod),
     .help = "the rod; of a rigid body: integrated to a rigid body"},
    {.name = "modal", .kind = BOUGH_KEY_MAPPING, .of = &modal_schema, .when_key = "fidelity",
     .when = "modal|segmented-modal", AT(modal), .help = "how the rod is reduced to modes"},
};
#undef AT
static const bough_schema body_schema = {SCHEMA("a body", bough_scene_body, body_keys)};

// -- simulation ------------------------------------------------------------------------------------

#define AT(member) .offset = offsetof(bough_scene_coupling, member)
// The schemes' own keys are allowed with any scheme, so that --set may change the scheme alone.
static const bough_key coupling_keys[] = {
    {.name = "scheme", .kind = BOUGH_KEY_CHOICE, .fallback = "ramp", AT(scheme),
     .choices =
         CHOICES("frozen", "gauss-seidel", "extrapolated", "iterated", "ramp", "monolithic"),
     .help = "how sub-systems exchange their values"},
    {.name = "order", .kind = BOUGH_KEY_INTEGER, .range = "[0, 2]", .fallback = "1",
     AT(order), .help = "of extrapolated and iterated: degree of the polynomial"},
    {.name = "theta", .kind = BOUGH_KEY_NUMBER, .word = "auto", .range = "[0.5, 1]",
     .fallback = "auto", AT(theta), .help = "of ramp: share of the new value"},
    {.name = "accelerator", .kind = BOUGH_KEY_CHOICE, .fallback = "iqn-ils", AT(accelerator),
     .choices = CHOICES("none", "relaxation", "aitken", "iqn-ils"),
     .help = "of iterated: how the next end values are found"},
    {.name = "relaxation", .kind = BOUGH_KEY_NUMBER, .range = "[0.001, 1]", .fallback = "0.5",
     AT(relaxation), .help = "of iterated: factor of the correction; the first one of aitken and "
                             "iqn-ils"},
    {.name = "tolerance", .kind = BOUGH_KEY_NUMBER, .word = "auto", .range = "[1e-12, 0.1]",
     .fallback = "auto", AT(tolerance),
     .help = "of iterated: of the interface, relative to its largest values so far; auto: 3 rtol "
             "of micro"},
    {.name = "iterations", .kind = BOUGH_KEY_INTEGER, .range = "[1, 1000]", .fallback = "30",
     AT(iterations), .help = "of iterated: most in a macro step"},
};
#undef AT
static const bough_schema coupling_schema = {
    SCHEMA("the coupling", bough_scene_coupling, coupling_keys)};

static const bough_key output_keys[] = {
    {.name = "interval", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .offset = offsetof(bough_scene_output, interval),
     .help = "between recorded values, a multiple of the macro step; default the macro step"},
    {.name = "frames", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .offset = offsetof(bough_scene_output, frames),
     .help = "between shapes stored for ParaView and `bough report`; default none"},
    {.name = "binary", .kind = BOUGH_KEY_BOOLEAN, .fallback = "false",
     .offset = offsetof(bough_scene_output, binary),
     .help = "at the end also channels.outb, OpenFAST's binary form: one scale and 16 bits a channel"},
};
static const bough_schema output_schema = {SCHEMA("the output", bough_scene_output, output_keys)};

#define AT(member) .offset = offsetof(bough_scene_step_control, member)
static const bough_key step_control_keys[] = {
    {.name = "tolerance", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0",
     AT(tolerance), .help = "of what a port turned out to be against what it was told, relative to "
                            "its largest value so far; 0: fixed steps"},
    {.name = "min", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .fallback = "0.1 ms", AT(min), .help = "shortest macro step"},
};
#undef AT
static const bough_schema step_control_schema = {
    SCHEMA("the step control", bough_scene_step_control, step_control_keys)};

#define AT(member) .offset = offsetof(bough_scene_simulation, member)
static const bough_key simulation_keys[] = {
    {.name = "duration", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .required = true, AT(duration), .help = "simulated time, a multiple of the macro step"},
    {.name = "macro_step", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .required = true, AT(macro_step), .help = "time between exchanges"},
    {.name = "step_control", .kind = BOUGH_KEY_MAPPING, .of = &step_control_schema,
     AT(step_control), .help = "halves of the macro step, and their halves, where the coupling errs"},
    {.name = "initial", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("undeformed", "equilibrium"),
     .fallback = "undeformed", AT(initial),
     .help = "start as the scene says, or from equilibrium with the loads at time 0; a joint with a "
             "speed keeps it"},
    {.name = "coupling", .kind = BOUGH_KEY_MAPPING, .of = &coupling_schema, AT(coupling),
     .help = "the coupling scheme"},
    {.name = "master", .kind = BOUGH_KEY_MAPPING, .of = &master_schema, AT(master),
     .help = "integrator of the tree of bodies"},
    {.name = "micro", .kind = BOUGH_KEY_MAPPING, .of = &micro_schema, AT(micro),
     .help = "integrator of each rod"},
    {.name = "threads", .kind = BOUGH_KEY_INTEGER, .range = "[1, 1024]", .fallback = "1",
     AT(threads), .help = "threads for the rods; --threads overrides"},
    {.name = "output", .kind = BOUGH_KEY_MAPPING, .of = &output_schema, AT(output),
     .help = "what is recorded"},
};
#undef AT
static const bough_schema simulation_schema = {
    SCHEMA("the simulation", bough_scene_simulation, simulation_keys)};

// -- loads and turbine -----------------------------------------------------------------------------

#define RAMP(type)                                                                                 \
    {.name = "ramp", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_TIME,                \
     .range = ">= 0", .fallback = "[0, 0]", .offset = offsetof(type, ramp),                        \
     .help = "grows linearly from nothing at the first time to all at the second"}

#define AT(member) .offset = offsetof(bough_scene_load, member)
static const bough_key load_keys[] = {
    {.name = "joint", .kind = BOUGH_KEY_TEXT, AT(joint_name),
     .help = "loads a joint: name of the body that the joint carries"},
    {.name = "torque", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_load_torque,
     .form = "number in N m, or {times: [...], values: [...]}", .offset = 0,
     .help = "about the axis of a revolute joint"},
    {.name = "body", .kind = BOUGH_KEY_TEXT, AT(body_name),
     .help = "loads a rod or a rigid body: its name"},
    {.name = "point", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = zero3, AT(point), .help = "of a rigid body, in its frame"},
    {.name = "at", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_load_place,
     .form = "tip, a vertex' number or a length as '30 m'", .offset = 0,
     .help = "where on the rod, counted from the root"},
    {.name = "along", .kind = BOUGH_KEY_VECTOR, .count = 2, .dimension = BOUGH_LENGTH,
     .range = ">= 0", AT(span), .help = "in place of 'at': from where to where the load is spread"},
    {.name = "force", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_load_force,
     .form = "number in N, {times: [...], values: [...]}, or 3 numbers in N, in N/m with 'along'", .offset = 0,
     .help = "along the axis of a prismatic joint, or on the body"},
    {.name = "moment", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_load_moment,
     .form = "3 numbers in N m, in N m/m with 'along'", .offset = 0, .help = "on the body"},
    {.name = "factor", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_load_factor,
     .form = "{times: [...], values: [...]}", .offset = 0,
     .help = "on a rigid body, in place of a ramp: by what the load is multiplied"},
    {.name = "frame", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("ground", "body", "follower"),
     .fallback = "ground", AT(frame),
     .help = "axes of a body's load: ground (not of rods whose root moves), body, or follower: a "
             "rod's section axes, with which it turns"},
    RAMP(bough_scene_load),
};
#undef AT
static const bough_schema load_schema = {SCHEMA("a load", bough_scene_load, load_keys),
                                         .check = bough_scene_check_load};

#define AT(member) .offset = offsetof(bough_scene_spring, member)
static const bough_key spring_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name),
     .help = "of its channels: Len and Frc, the force that draws its ends together"},
    {.name = "from", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[0]),
     .help = "name of a rigid body, or ground"},
    {.name = "from_point", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = zero3, AT(point[0]), .help = "in that body's frame"},
    {.name = "to", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[1]),
     .help = "name of another rigid body, or ground"},
    {.name = "to_point", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = zero3, AT(point[1]), .help = "in that body's frame; the points must never meet"},
    {.name = "stiffness", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_STIFFNESS, .range = ">= 0",
     .fallback = "0", AT(stiffness), .help = "of the spring"},
    {.name = "damping", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0", AT(damping),
     .help = "of the damper beside it, in N s/m"},
    {.name = "length", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = ">= 0",
     .fallback = "0", AT(length), .help = "without force"},
};
#undef AT
static const bough_schema spring_schema = {SCHEMA("a spring", bough_scene_spring, spring_keys)};

#define AT(member) .offset = offsetof(bough_scene_bushing, member)
#define THREE(member, what)                                                                        \
    {.name = #member, .kind = BOUGH_KEY_VECTOR, .count = 3, .range = ">= 0", .fallback = zero3,    \
     AT(member), .help = what}
static const bough_key bushing_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name),
     .help = "of its channels: FrcX to MomZ, what it does to the second body, in the first's axes"},
    {.name = "from", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[0]),
     .help = "name of a rigid body, or ground, with whose axes the bushing turns"},
    {.name = "to", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[1]),
     .help = "name of another; without force as it stands at the start"},
    {.name = "point", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = zero3, AT(point), .help = "in the first body's frame"},
    THREE(stiffness, "along x, y, z, in N/m"),
    THREE(damping, "along x, y, z, in N s/m"),
    THREE(rotational_stiffness, "about x, y, z, in N m/rad, by the rotation vector (below 180 deg)"),
    THREE(rotational_damping, "about x, y, z, in N m s/rad"),
};
#undef THREE
#undef AT
static const bough_schema bushing_schema = {
    SCHEMA("a bushing", bough_scene_bushing, bushing_keys)};

#define AT(member) .offset = offsetof(bough_scene_closure, member)
static const bough_key closure_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name),
     .help = "of its channels: force Fx Fy Fz and moment Mx My Mz on 'to', in its frame there"},
    {.name = "kind", .kind = BOUGH_KEY_CHOICE, .required = true, AT(kind),
     .choices = CHOICES("fixed", "revolute", "prismatic", "spherical", "cylindrical", "universal",
                        "planar"),
     .help = "the joint whose motion remains; what it forbids may be forbidden already"},
    {.name = "from", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[0]),
     .help = "name of a rigid body, or ground"},
    {.name = "from_placement", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_steps,
     .form = placement_form, AT(placement[0]), .help = "of the joint's frame in that body's"},
    {.name = "to", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name[1]),
     .help = "name of another rigid body, or ground"},
    {.name = "to_placement", .kind = BOUGH_KEY_CUSTOM, .read = bough_scene_read_steps,
     .form = placement_form, AT(placement[1]),
     .help = "of the joint's frame in that body's; the two must almost meet at the start: the "
             "rest is closed by moving all joints a little, and joints without a speed follow"},
    {.name = "axis", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("x", "y", "z"), .required = true,
     .when_key = "kind", .when = "revolute|prismatic|cylindrical|universal|planar", AT(axis),
     .help = "of the motion, as of a joint; of a universal joint in the frame of 'from'"},
    {.name = "second_axis", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("x", "y", "z"),
     .required = true, .when_key = "kind", .when = "universal", AT(second_axis),
     .help = "normal to the axis, in the frame of 'to'"},
};
#undef AT
static const bough_schema closure_schema = {SCHEMA("a closure", bough_scene_closure, closure_keys)};

#define AT(member) .offset = offsetof(bough_scene_marker, member)
static const bough_key marker_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name),
     .help = "of its channels: X, Y, Z in ground axes"},
    {.name = "body", .kind = BOUGH_KEY_TEXT, .required = true, AT(body_name),
     .help = "name of a rigid body, or ground"},
    {.name = "point", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = zero3, AT(point), .help = "in that body's frame"},
};
#undef AT
static const bough_schema marker_schema = {SCHEMA("a marker", bough_scene_marker, marker_keys)};

#define AT(member) .offset = offsetof(bough_scene_turbine, member)
static const bough_key turbine_keys[] = {
    {.name = "rotor", .kind = BOUGH_KEY_TEXT, .required = true, AT(rotor_name),
     .help = "body on the revolute joint of the rotor"},
    {.name = "blades", .kind = BOUGH_KEY_TEXTS, .required = true, .count = 1, AT(blade_name),
     .count_offset = offsetof(bough_scene_turbine, n_blade),
     .help = "bodies with a rod, carried by the rotor"},
};
#undef AT
static const bough_schema turbine_schema = {
    SCHEMA("the turbine", bough_scene_turbine, turbine_keys)};

// -- aerodynamics ----------------------------------------------------------------------------------

#define AT(member) .offset = offsetof(bough_scene_aero_station, member)
static const bough_key aero_station_keys[] = {
    {.name = "span", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .required = true,
     AT(span), .help = "along z from the root"},
    {.name = "ac_x", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .fallback = "0",
     AT(ac[0]), .help = "aerodynamic centre from the pitch axis, blade-root x (flapwise)"},
    {.name = "ac_y", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .fallback = "0",
     AT(ac[1]), .help = "aerodynamic centre from the pitch axis, blade-root y (edgewise)"},
    {.name = "twist", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(twist), .help = "the airfoil is turned by -twist about z, like pitch"},
    {.name = "chord", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = "> 0",
     .required = true, AT(chord), .help = "chord"},
    {.name = "polar", .kind = BOUGH_KEY_TEXT, .required = true, AT(polar_name),
     .help = "name of a polar in the polars file"},
    {.name = "blend", .kind = BOUGH_KEY_TEXT, AT(second_name),
     .help = "name of a second polar, with which the first is mixed"},
    {.name = "share", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0", AT(share),
     .help = "of the second polar, as by the place or the thickness between two airfoils"},
};
#undef AT
static const bough_schema aero_station_schema = {
    SCHEMA("a station", bough_scene_aero_station, aero_station_keys)};

#define AT(member) .offset = offsetof(bough_scene_aero_blade, member)
static const bough_key aero_blade_keys[] = {
    {.name = "source", .kind = BOUGH_KEY_TEXT, AT(source), .help = "where the data come from"},
    {.name = "stations", .kind = BOUGH_KEY_LIST, .of = &aero_station_schema, .count = 2,
     .required = true, AT(station), .count_offset = offsetof(bough_scene_aero_blade, n_station),
     .help = "blade elements, from the root to the tip"},
};
#undef AT
static const bough_schema aero_blade_schema = {
    SCHEMA("an aerodynamic blade", bough_scene_aero_blade, aero_blade_keys),
    .check = bough_scene_check_aero_blade};

#define ROW(key_name, what)                                                                        \
    {.name = #key_name, .kind = BOUGH_KEY_NUMBER, .required = true,                                \
     .offset = offsetof(bough_scene_polar_row, key_name), .help = what}
static const bough_key polar_row_keys[] = {
    {.name = "alpha", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .required = true,
     .offset = offsetof(bough_scene_polar_row, alpha), .help = "angle of attack"},
    ROW(cl, "lift coefficient"),
    ROW(cd, "drag coefficient"),
    ROW(cm, "moment coefficient about the aerodynamic centre, nose up"),
};
static const bough_schema polar_row_schema = {
    SCHEMA("a row", bough_scene_polar_row, polar_row_keys)};

#define AT(member) .offset = offsetof(bough_scene_polar, member)
static const bough_key polar_keys[] = {
    {.name = "name", .kind = BOUGH_KEY_TEXT, .required = true, AT(name), .help = "unique"},
    {.name = "table", .kind = BOUGH_KEY_LIST, .of = &polar_row_schema, .count = 2,
     .required = true, AT(row), .count_offset = offsetof(bough_scene_polar, n_row),
     .help = "from -180 deg to 180 deg, linear between"},
};
#undef AT
static const bough_schema polar_schema = {SCHEMA("a polar", bough_scene_polar, polar_keys),
                                          .check = bough_scene_check_polar};

#define AT(member) .offset = offsetof(bough_scene_polars, member)
static const bough_key polars_keys[] = {
    {.name = "source", .kind = BOUGH_KEY_TEXT, AT(source), .help = "where the data come from"},
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
     .help = "strictly increasing"},
    {.name = "speeds", .kind = BOUGH_KEY_NUMBERS, .dimension = BOUGH_SPEED, .range = ">= 0",
     .count = 2, .required = true, AT(speed),
     .count_offset = offsetof(bough_scene_wind_table, n_speed),
     .help = "at each time, linear between, constant before and after"},
};
#undef AT
static const bough_schema wind_table_schema = {
    SCHEMA("a table of wind speeds", bough_scene_wind_table, wind_table_keys),
    .check = bough_scene_check_wind_table};

#define AT(member) .offset = offsetof(bough_scene_wind, member)
static const bough_key wind_keys[] = {
    {.name = "kind", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("uniform", "power", "log", "wnd", "bts"),
     .fallback = "uniform", AT(kind),
     .help = "how the speed grows with the height: not, by a power or a logarithmic law; or from a "
             "file: uniform (hub height) or TurbSim's box"},
    {.name = "file", .kind = BOUGH_KEY_TEXT, .required = true, .when_key = "kind",
     .when = "wnd|bts", AT(file), .help = "relative to the scene"},
    {.name = "speed", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_SPEED, .range = ">= 0",
     AT(speed), .help = "horizontal, at the reference height; required without table and file"},
    {.name = "table", .kind = BOUGH_KEY_MAPPING, .of = &wind_table_schema, AT(table),
     .help = "in place of speed: the speed over time, for gusts and ramps"},
    {.name = "exponent", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0.2",
     .when_key = "kind", .when = "power", AT(exponent), .help = "speed grows with height^exponent"},
    {.name = "roughness", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = "> 0",
     .fallback = "0.03", .when_key = "kind", .when = "log", AT(roughness),
     .help = "length z0: speed grows with ln(height/z0)"},
    {.name = "reference_height", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH,
     .range = "> 0", .required = true, .when_key = "kind", .when = "power|log|wnd",
     AT(reference_height), .help = "above ground z = 0"},
    {.name = "reference_length", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH,
     .range = "> 0", .required = true, .when_key = "kind", .when = "wnd", AT(reference_length),
     .help = "over which the file's linear shears are told: the rotor's diameter"},
    {.name = "direction", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGLE, .fallback = "0",
     AT(direction), .help = "where the wind blows to, from ground x about z"},
    {.name = "vertical", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_SPEED, .fallback = "0",
     AT(vertical), .help = "upwards, at every height and time"},
};
#undef AT
static const bough_schema wind_schema = {SCHEMA("the wind", bough_scene_wind, wind_keys),
                                         .check = bough_scene_check_wind};

#define SWITCH(member, what)                                                                       \
    {.name = #member, .kind = BOUGH_KEY_BOOLEAN, .fallback = "true",                               \
     .offset = offsetof(bough_scene_induction, member), .help = what}
static const bough_key induction_keys[] = {
    SWITCH(tip_loss, "Prandtl's loss factor at the tip"),
    SWITCH(hub_loss, "Prandtl's loss factor at the hub"),
    SWITCH(tangential, "tangential induction"),
    SWITCH(drag, "drag counts in the induction"),
    {.name = "high_thrust", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("smooth", "buhl"),
     .fallback = "smooth", .offset = offsetof(bough_scene_induction, high_thrust),
     .help = "how thrust grows beyond momentum theory: as AeroDyn's newer formulation or by Buhl's "
             "parabola"},
    {.name = "skew", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("none", "pitt-peters"),
     .fallback = "pitt-peters", .offset = offsetof(bough_scene_induction, skew),
     .help = "correction for oblique inflow"},
    {.name = "inflow", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("equilibrium", "oye"),
     .fallback = "equilibrium", .offset = offsetof(bough_scene_induction, inflow),
     .help = "how the induction follows a change of load: at once, or by Oye's dynamic inflow"},
    {.name = "inflow_time", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .word = "auto",
     .range = "> 0", .fallback = "auto", .when_key = "inflow", .when = "oye",
     .offset = offsetof(bough_scene_induction, inflow_time),
     .help = "its slow time constant; auto: 1.1/(1 - 1.3 a) R/U"},
};
static const bough_schema induction_schema = {
    SCHEMA("the induction", bough_scene_induction, induction_keys)};

#define AT(member) .offset = offsetof(bough_scene_tower, member)
static const bough_key tower_keys[] = {
    {.name = "influence", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("potential", "bak"),
     .fallback = "potential", AT(influence),
     .help = "how the tower changes the wind: potential flow about a cylinder, or with Bak's "
             "correction for its drag"},
    {.name = "shadow", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("none", "powles"),
     .fallback = "none", AT(shadow), .help = "wake behind the tower"},
    {.name = "height", .kind = BOUGH_KEY_NUMBERS, .dimension = BOUGH_LENGTH, .range = ">= 0",
     .count = 2, .required = true, AT(height),
     .count_offset = offsetof(bough_scene_tower, n_height), .help = "above the ground's origin"},
    {.name = "diameter", .kind = BOUGH_KEY_NUMBERS, .dimension = BOUGH_LENGTH, .range = "> 0",
     .count = 2, .required = true, AT(diameter),
     .count_offset = offsetof(bough_scene_tower, n_diameter), .help = "at each height"},
    {.name = "drag", .kind = BOUGH_KEY_NUMBERS, .range = ">= 0", .count = 1, .fallback = "[1]",
     AT(drag), .count_offset = offsetof(bough_scene_tower, n_drag),
     .help = "drag coefficient: one for the whole tower, or one at each height; for bak, powles and "
             "the drag on a body"},
    {.name = "body", .kind = BOUGH_KEY_TEXT, AT(body_name),
     .help = "body with a rod on which the tower's drag acts; left out: no drag"},
};
#undef AT
static const bough_schema tower_schema = {SCHEMA("a tower", bough_scene_tower, tower_keys),
                                          .check = bough_scene_check_tower};

#define AT(member) .offset = offsetof(bough_scene_aero, member)
static const bough_key aero_keys[] = {
    {.name = "rate", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_FREQUENCY, .range = "> 0",
     .required = true, AT(rate), .help = "samples; their period is a multiple of the macro step"},
    {.name = "air_density", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_DENSITY, .range = "> 0",
     .fallback = "1.225", AT(air_density), .help = "density of the air"},
    {.name = "wind", .kind = BOUGH_KEY_MAPPING, .of = &wind_schema, .required = true, AT(wind),
     .help = "the undisturbed wind"},
    RAMP(bough_scene_aero),
    {.name = "hold", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("linear", "constant"),
     .fallback = "linear", AT(hold), .help = "how loads go between samples"},
    {.name = "blade", .kind = BOUGH_KEY_FILE, .of = &aero_blade_schema, .required = true,
     AT(blade), .help = "file with the blade elements, relative to the scene"},
    {.name = "polars", .kind = BOUGH_KEY_FILE, .of = &polars_schema, .required = true, AT(polars),
     .help = "file with the polars, relative to the scene"},
    {.name = "induction", .kind = BOUGH_KEY_MAPPING, .of = &induction_schema, AT(induction),
     .help = "parts of the blade element momentum theory"},
    {.name = "tower", .kind = BOUGH_KEY_MAPPING, .of = &tower_schema, AT(tower),
     .help = "vertical tower in front of which the blades pass; left out: no influence"},
    {.name = "hub_radius", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_LENGTH, .range = ">= 0",
     .required = true, AT(hub_radius), .help = "from the rotor axis to the blade roots"},
    {.name = "hub_drag_area", .kind = BOUGH_KEY_NUMBER, .range = ">= 0", .fallback = "0",
     AT(hub_drag_area), .help = "drag coefficient times area of the hub, in m2; drag on the rotor"},
    {.name = "dynamic_stall", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("none", "hgm"),
     .fallback = "none", AT(dynamic_stall),
     .help = "how lift follows the angle of attack: at once, or by the Beddoes-Leishman model of "
             "Hansen, Gaunaa and Madsen"},
    {.name = "interpolation", .kind = BOUGH_KEY_CHOICE,
     .choices = CHOICES("linear", "monotone-cubic"), .fallback = "linear", AT(interpolation),
     .help = "of the polars between their rows"},
    {.name = "pitching_moment", .kind = BOUGH_KEY_BOOLEAN, .fallback = "true", AT(pitching_moment),
     .help = "the sections' moment coefficients count"},
    {.name = "nodes", .kind = BOUGH_KEY_NUMBERS, .range = ">= 1", .count = 1, AT(nodes),
     .count_offset = offsetof(bough_scene_aero, n_node),
     .help = "numbers of blade elements, from 1 at the root, whose flow is recorded"},
};
#undef AT
static const bough_schema aero_schema = {SCHEMA("the aerodynamics", bough_scene_aero, aero_keys)};

// -- modes ----------------------------------------------------------------------------------------

#define AT(member) .offset = offsetof(bough_scene_modes, member)
static const bough_key modes_keys[] = {
    {.name = "count", .kind = BOUGH_KEY_INTEGER, .range = "[1, 60]", .fallback = "12", AT(count),
     .help = "of each rod or of the scene, from the lowest frequency"},
    {.name = "of", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("auto", "rods", "scene"),
     .fallback = "auto", AT(of),
     .help = "each rod with its root held, or the whole scene; auto: the rods where no joint moves "
             "or speed or axis is given"},
    {.name = "at", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("undeformed", "equilibrium"),
     .fallback = "equilibrium", AT(at),
     .help = "of the whole scene: about its initial state or its equilibrium, in which a joint with "
             "a speed keeps it"},
    {.name = "speed", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGULAR_SPEED, .fallback = "0",
     AT(speed), .help = "of a steady rotation of the rods' roots; the whole scene turns as its joints do"},
    {.name = "about", .kind = BOUGH_KEY_TEXT, AT(about_name),
     .help = "body on the revolute joint about whose axis they turn; default the nearest that "
             "carries the rod"},
    {.name = "axis", .kind = BOUGH_KEY_VECTOR, .count = 3, .fallback = zero3, AT(axis),
     .help = "in place of a joint: direction of the axis in ground axes"},
    {.name = "centre", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = zero3, AT(centre), .help = "of 'axis': a point of it, in the ground"},
    {.name = "shapes", .kind = BOUGH_KEY_BOOLEAN, .fallback = "false", AT(shapes),
     .help = "write the modes' shapes"},
};
#undef AT
static const bough_schema modes_schema = {SCHEMA("the modes", bough_scene_modes, modes_keys)};

// -- the scene -------------------------------------------------------------------------------------

#define AT(member) .offset = offsetof(bough_scene, member)
static const bough_key scene_keys[] = {
    {.name = "title", .kind = BOUGH_KEY_TEXT, AT(title), .help = "what the scene shows"},
    {.name = "gravity", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_ACCELERATION,
     .fallback = "[0, 0, -9.80665]", AT(gravity), .help = "ground axes, z up"},
    {.name = "simulation", .kind = BOUGH_KEY_MAPPING, .of = &simulation_schema, .required = true,
     AT(simulation), .help = "time, coupling and solvers"},
    {.name = "bodies", .kind = BOUGH_KEY_LIST, .of = &body_schema, .count = 1, .required = true,
     AT(body), .count_offset = offsetof(bough_scene, n_body), .help = "the tree of bodies"},
    {.name = "loads", .kind = BOUGH_KEY_LIST, .of = &load_schema, AT(load),
     .count_offset = offsetof(bough_scene, n_load), .help = "loads on joints and bodies"},
    {.name = "springs", .kind = BOUGH_KEY_LIST, .of = &spring_schema, AT(spring),
     .count_offset = offsetof(bough_scene, n_spring),
     .help = "springs and dampers between points of rigid bodies"},
    {.name = "bushings", .kind = BOUGH_KEY_LIST, .of = &bushing_schema, AT(bushing),
     .count_offset = offsetof(bough_scene, n_bushing),
     .help = "springs and dampers in six directions between rigid bodies"},
    {.name = "closures", .kind = BOUGH_KEY_LIST, .of = &closure_schema, AT(closure),
     .count_offset = offsetof(bough_scene, n_closure),
     .help = "joints that close loops between rigid bodies"},
    {.name = "markers", .kind = BOUGH_KEY_LIST, .of = &marker_schema, AT(marker),
     .count_offset = offsetof(bough_scene, n_marker), .help = "points that are recorded"},
    {.name = "turbine", .kind = BOUGH_KEY_MAPPING, .of = &turbine_schema, AT(turbine),
     .help = "names what channels and aerodynamics need"},
    {.name = "aero", .kind = BOUGH_KEY_MAPPING, .of = &aero_schema, AT(aero),
     .help = "aerodynamics; needs the turbine; left out: none"},
    {.name = "control", .kind = BOUGH_KEY_MAPPING, .of = &bough_scene_control_schema, AT(control),
     .help = "controller of the turbine's generator and pitch; left out: none"},
    {.name = "modes", .kind = BOUGH_KEY_MAPPING, .of = &modes_schema, AT(modes),
     .help = "what 'bough modes' finds"},
};
#undef AT
// clang-format on
const bough_schema bough_scene_schema = {SCHEMA("a scene", bough_scene, scene_keys)};

static const char example[] =
    "    title: A bar that swings from a bearing and bends\n"
    "    simulation: {duration: 2 s, macro_step: 10 ms, output: {interval: 20 ms}}\n"
    "    bodies:\n"
    "      - name: hinge\n"
    "        fidelity: rigid\n"
    "        mass: 1 kg\n"
    "        inertia: [0.1, 0.1, 0.1]\n"
    "        joint: {kind: revolute, parent: ground, axis: y, angle: 90 deg}\n"
    "      - name: bar\n"
    "        fidelity: rod\n"
    "        joint: {kind: fixed, parent: hinge}\n"
    "        rod:\n"
    "          length: 2 m\n"
    "          segments: 8\n"
    "          stiffness: [1e5, 1e5, 3e5, 20, 20, 15]\n"
    "          mass: [0.8, 0, 0, 5e-5, 5e-5, 0]\n";

void bough_scene_help(FILE *stream) {
    fputs("# Scenes\n\nA scene is a YAML file. Files that it names are relative to it. Values are SI "
          "numbers or carry a unit:\n\n", stream);
    bough_schema_help_units(stream);
    fputs("\n## An example\n\n", stream);
    fputs(example, stream);
    fputs("\n## Keys\n\n", stream);
    bough_schema_help(&bough_scene_schema, 0, stream);
}
