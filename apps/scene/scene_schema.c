// The keys of a scene: simulation, modes, the whole. Its parts are in scene_schema_NAME.c.
#include "apps/scene/scene_tables.h"

// One line a key would become one line a field:
// clang-format off

// -- solvers ------------------------------------------------------------------------------------

#define RTOL(value)                                                                                \
    {.name = "rtol", .kind = BOUGH_KEY_NUMBER, .range = "[1e-14, 0.1]", .fallback = value,         \
     .offset = offsetof(bough_scene_solver, rtol), .example = "1e-5",                              \
     .help = "relative tolerance"}
#define RHO                                                                                        \
    {.name = "rho", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0.8", AT(rho),       \
     .example = "0.6",                                                                             \
     .help = "of generalized-alpha: spectral radius at infinite frequency"}
#define AT(field) .offset = offsetof(bough_scene_solver, field)
static const bough_key master_keys[] = {
    {.name = "solver", .kind = BOUGH_KEY_CHOICE, .fallback = "ida",
     .choice = bough_integrator_name, AT(solver),
     .help = "ida, cvode-bdf: BDF of variable order; arkode-esdirk: Runge-Kutta of order 4; "
             "radau5: Runge-Kutta of order 5, up to 400 states; generalized-alpha: order 2; "
             "rosenbrock: linearly implicit Runge-Kutta of order 3; automatic: rosenbrock, and ida at a "
             "tenth of rtol where that would take a thousand steps in a macro step"},
    RTOL("1e-6"),
    {.name = "step", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "[1e-7, 10]",
     AT(step), .example = "10 ms",
     .help = "of generalized-alpha, rosenbrock and automatic: longest step; default the macro step"},
    RHO,
};
static const bough_key micro_keys[] = {
    {.name = "solver", .kind = BOUGH_KEY_CHOICE, .fallback = "cvode-bdf",
     .choice = bough_integrator_name, AT(solver), .help = "time integrator of each rod"},
    RTOL("1e-4"),
    {.name = "step", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "[1e-7, 10]",
     .fallback = "5e-3", AT(step), .example = "10 ms",
     .help = "of generalized-alpha and rosenbrock: longest step"},
    RHO,
};
#undef AT
static const bough_schema master_schema = {SCHEMA("a solver", bough_scene_solver, master_keys)};
const bough_schema bough_scene_micro_schema = {SCHEMA("a solver", bough_scene_solver, micro_keys)};

// -- simulation -----------------------------------------------------------------------------------

#define AT(member) .offset = offsetof(bough_scene_coupling, options.member)
_Static_assert(sizeof(bough_exchange) == sizeof(int) && sizeof(bough_acceleration) == sizeof(int),
               "choices are stored as int");
// The schemes' own keys are allowed with any scheme, so that --set may change the scheme alone.
static const bough_key coupling_keys[] = {
    {.name = "scheme", .kind = BOUGH_KEY_CHOICE, .fallback = "monolithic",
     .choice = bough_scheme_name, .offset = offsetof(bough_scene_coupling, scheme),
     .help = "how sub-systems exchange their values. The default integrates all bodies as one "
             "system: by automatic to rtol 1e-5, unless master names a solver or an rtol below 1e-6"},
    {.name = "order", .kind = BOUGH_KEY_INTEGER, .range = "[0, 2]", .fallback = "1",
     AT(order), .example = "2", .help = "of extrapolated and of iterated end values: degree of the polynomial"},
    {.name = "theta", .kind = BOUGH_KEY_NUMBER, .word = "auto", .range = "[0.5, 1]",
     .fallback = "auto", AT(theta), .example = "0.6", .help = "of ramp: share of the new value"},
    {.name = "exchange", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("end-values", "waveform"),
     .fallback = "end-values", AT(exchange),
     .help = "of iterated: what the iteration makes agree: values at the end of the macro step, "
             "or cubics through values within it"},
    {.name = "accelerator", .kind = BOUGH_KEY_CHOICE, .fallback = "iqn-ils", AT(accelerator),
     .choices = bough_acceleration_names,
     .help = "of iterated: how the next values of the iteration are computed"},
    {.name = "relaxation", .kind = BOUGH_KEY_NUMBER, .range = "[0.001, 1]", .fallback = "0.5",
     AT(relaxation), .example = "0.7",
     .help = "of iterated: factor of the correction; the first one of aitken and "
                             "iqn-ils"},
    {.name = "tolerance", .kind = BOUGH_KEY_NUMBER, .word = "auto", .range = "[1e-12, 0.1]",
     .fallback = "auto", AT(tolerance),
     .example = "1e-5",
     .help = "of iterated: of the interface, relative to its largest values so far; auto: 3 rtol "
             "of micro"},
    {.name = "iterations", .kind = BOUGH_KEY_INTEGER, .range = "[1, 1000]", .fallback = "30",
     AT(iterations), .example = "50", .help = "of iterated: largest number in a macro step"},
};
#undef AT
static const bough_schema coupling_schema = {
    SCHEMA("the coupling", bough_scene_coupling, coupling_keys)};

static const bough_key output_keys[] = {
    {.name = "interval", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .offset = offsetof(bough_scene_output, interval),
     .example = "50 ms",
     .help = "time between recorded values, a multiple of the macro step; default the macro step"},
    {.name = "from", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = ">= 0",
     .fallback = "0", .offset = offsetof(bough_scene_output, from), .example = "30 s",
     .help = "start of the statistics in summary.json"},
    {.name = "frames", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .offset = offsetof(bough_scene_output, frames),
     .example = "0.1 s",
     .help = "time between shapes stored for ParaView, with the section loads of rods, and for "
             "`bough report`; default none"},
    {.name = "vertices", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .offset = offsetof(bough_scene_output, vertices),
     .example = "0.1 s",
     .help = "time between positions, rotations and section loads of all vertices stored in "
             "vertices.h5, by a program built with -DBOUGH_HDF5=ON; default none"},
    {.name = "binary", .kind = BOUGH_KEY_BOOLEAN, .fallback = "false",
     .offset = offsetof(bough_scene_output, binary),
     .help = "also writes channels.outb at the end, OpenFAST's binary format with 16 bits for "
             "each value"},
    {.name = "channels", .kind = BOUGH_KEY_TEXTS, .count = 1,
     .offset = offsetof(bough_scene_output, channels),
     .count_offset = offsetof(bough_scene_output, n_channel), .example = "[RotSpeed, 'Root*']",
     .help = "names or patterns of the channels that are recorded; default all"},
};
static const bough_schema output_schema = {SCHEMA("the output", bough_scene_output, output_keys)};

#define AT(member) .offset = offsetof(bough_scene_step_control, member)
static const bough_key step_control_keys[] = {
    {.name = "tolerance", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0",
     AT(tolerance), .example = "1e-3",
     .help = "largest difference between the value obtained at a port and the value applied, "
             "relative to the largest value so far; 0: fixed steps"},
    {.name = "min", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .fallback = "0.1 ms", AT(min), .example = "1 ms", .help = "shortest macro step"},
};
#undef AT
static const bough_schema step_control_schema = {
    SCHEMA("the step control", bough_scene_step_control, step_control_keys)};

#define AT(member) .offset = offsetof(bough_scene_simulation, member)
static const bough_key simulation_keys[] = {
    {.name = "duration", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME, .range = "> 0",
     .required = true, AT(duration), .example = "40 s",
     .help = "simulated time, a multiple of the macro step"},
    {.name = "macro_step", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_TIME,
     .range = "[1e-7, 1e4]", .required = true, AT(macro_step), .example = "20 ms", .help = "time between exchanges"},
    {.name = "step_control", .kind = BOUGH_KEY_MAPPING, .of = &step_control_schema,
     AT(step_control),
     .help = "bisection of the macro step where the coupling error is too large"},
    {.name = "initial", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("undeformed", "equilibrium", "operation"),
     .fallback = "undeformed", AT(initial),
     .help = "undeformed: as the scene says; equilibrium: with the loads at time 0, joints with a "
             "speed keep it; operation: equilibrium at the rotor speed and pitch at which the torque "
             "of the air equals that of 'control: {kind: variable-speed}'"},
    {.name = "coupling", .kind = BOUGH_KEY_MAPPING, .of = &coupling_schema, AT(coupling),
     .help = "the coupling scheme"},
    {.name = "master", .kind = BOUGH_KEY_MAPPING, .of = &master_schema, AT(master),
     .help = "integrator of the tree of bodies; of the monolithic scheme for all bodies together"},
    {.name = "micro", .kind = BOUGH_KEY_MAPPING, .of = &bough_scene_micro_schema, AT(micro),
     .help = "integrator of each rod"},
    {.name = "error_bound", .kind = BOUGH_KEY_NUMBER, .range = "[0, 1]", .fallback = "0.05",
     AT(error_bound), .example = "0.02",
     .help = "largest estimated error of a channel of motion, relative to the channel's range; a "
             "run with a larger error ends with exit code 3; 0: no bound"},
    {.name = "error_estimate", .kind = BOUGH_KEY_CHOICE, .fallback = "auto", AT(error_estimate),
     .choices = CHOICES("auto", "second-solution", "linearised", "none"),
     .help = "how the run estimates its error: by a second solution beside the run, or by the "
             "linearised members driven by the coupling defects; auto: linearised where that is "
             "known to be reliable"},
    {.name = "error_shares", .kind = BOUGH_KEY_BOOLEAN, .fallback = "false", AT(error_shares),
     .help = "also estimates the errors of mesh and air, by three more runs with short steps: as it is, with "
             "twice the segments of each rod, and with twice the aerodynamic sampling rate"},
    {.name = "threads", .kind = BOUGH_KEY_INTEGER, .range = "[0, 1024]", .fallback = "0",
     AT(threads), .example = "2",
     .help = "threads for the rods; --threads overrides; 0: OMP_NUM_THREADS, 1 where that is not "
             "set"},
    {.name = "output", .kind = BOUGH_KEY_MAPPING, .of = &output_schema, AT(output),
     .help = "what is recorded"},
};
#undef AT
static const bough_schema simulation_schema = {
    SCHEMA("the simulation", bough_scene_simulation, simulation_keys)};

// -- modes ----------------------------------------------------------------------------------------

#define AT(member) .offset = offsetof(bough_scene_modes, member)
static const bough_key modes_keys[] = {
    {.name = "count", .kind = BOUGH_KEY_INTEGER, .range = "[1, 60]", .fallback = "12", AT(count),
     .example = "20", .help = "number of modes of each rod or of the scene, from the lowest "
                              "frequency"},
    {.name = "of", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("auto", "rods", "scene"),
     .fallback = "auto", AT(of),
     .help = "rods: each rod with its root held; scene: the whole scene; auto: rods if no joint "
             "moves, or if a speed or an axis is given"},
    {.name = "at", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("undeformed", "equilibrium"),
     .fallback = "equilibrium", AT(at),
     .help = "state of the whole scene about which modes are computed; in equilibrium, joints "
             "with a speed keep it"},
    {.name = "speed", .kind = BOUGH_KEY_NUMBER, .dimension = BOUGH_ANGULAR_SPEED, .fallback = "0",
     AT(speed), .example = "12.1 rpm",
     .help = "steady rotation of the rods' roots; the whole scene rotates by the speeds of its "
             "joints"},
    {.name = "about", .kind = BOUGH_KEY_TEXT, AT(about_name),
     .example = "hub",
     .help = "body on the revolute joint about whose axis the roots rotate; default the nearest "
             "revolute joint that carries the rod"},
    {.name = "axis", .kind = BOUGH_KEY_VECTOR, .count = 3, .fallback = ZERO3, AT(axis),
     .example = "[1, 0, 0]", .help = "direction of the axis of rotation in ground axes; replaces "
                                     "'about'"},
    {.name = "centre", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_LENGTH,
     .fallback = ZERO3, AT(centre), .example = "[0, 0, 90 m]",
     .help = "a point of 'axis', ground axes"},
    {.name = "air", .kind = BOUGH_KEY_CHOICE, .choices = CHOICES("frozen", "quasi-steady", "dynamic"),
     .fallback = "frozen", AT(air),
     .help = "of the whole scene: frozen: the aerodynamic forces are those of the equilibrium; "
             "quasi-steady: they follow the motion immediately; dynamic: with the scene's dynamic "
             "inflow and stall"},
    {.name = "shapes", .kind = BOUGH_KEY_BOOLEAN, .fallback = "false", AT(shapes),
     .help = "writes the shapes of the modes"},
    {.name = "linear", .kind = BOUGH_KEY_BOOLEAN, .fallback = "false", AT(linear),
     .help = "of the whole scene: writes its linear state space, the matrices A to D and the names of its "
             "states, inputs and outputs"},
};
#undef AT
static const bough_schema modes_schema = {SCHEMA("the modes", bough_scene_modes, modes_keys)};

// -- the scene ------------------------------------------------------------------------------------

#define AT(member) .offset = offsetof(bough_scene, member)
static const bough_key scene_keys[] = {
    {.name = "title", .kind = BOUGH_KEY_TEXT, AT(title), .example = "A bar that swings",
     .help = "what the scene shows"},
    {.name = "gravity", .kind = BOUGH_KEY_VECTOR, .count = 3, .dimension = BOUGH_ACCELERATION,
     .fallback = "[0, 0, -9.80665]", AT(gravity), .example = "[0, 0, -9.81 m/s^2]",
     .help = "ground axes, z up"},
    {.name = "simulation", .kind = BOUGH_KEY_MAPPING, .of = &simulation_schema, .required = true,
     AT(simulation), .help = "time, coupling and solvers"},
    {.name = "bodies", .kind = BOUGH_KEY_LIST, .of = &bough_scene_body_schema, .count = 1,
     .required = true,
     AT(body), .count_offset = offsetof(bough_scene, n_body), .help = "the tree of bodies"},
    {.name = "loads", .kind = BOUGH_KEY_LIST, .of = &bough_scene_load_schema, AT(load),
     .count_offset = offsetof(bough_scene, n_load), .help = "loads on joints and bodies"},
    {.name = "springs", .kind = BOUGH_KEY_LIST, .of = &bough_scene_spring_schema, AT(spring),
     .count_offset = offsetof(bough_scene, n_spring),
     .help = "springs and dampers between points of rigid bodies"},
    {.name = "bushings", .kind = BOUGH_KEY_LIST, .of = &bough_scene_bushing_schema, AT(bushing),
     .count_offset = offsetof(bough_scene, n_bushing),
     .help = "springs and dampers in six directions between rigid bodies"},
    {.name = "closures", .kind = BOUGH_KEY_LIST, .of = &bough_scene_closure_schema, AT(closure),
     .count_offset = offsetof(bough_scene, n_closure),
     .help = "joints that close loops between rigid bodies"},
    {.name = "markers", .kind = BOUGH_KEY_LIST, .of = &bough_scene_marker_schema, AT(marker),
     .count_offset = offsetof(bough_scene, n_marker), .help = "points that are recorded"},
    {.name = "sensors", .kind = BOUGH_KEY_LIST, .of = &bough_scene_sensor_schema, AT(sensor),
     .count_offset = offsetof(bough_scene, n_sensor),
     .help = "places on rods whose motion and section loads are recorded"},
    {.name = "turbine", .kind = BOUGH_KEY_MAPPING, .of = &bough_scene_turbine_schema, AT(turbine),
     .help = "bodies of the turbine that channels and aerodynamics need"},
    {.name = "aero", .kind = BOUGH_KEY_MAPPING, .of = &bough_scene_aero_schema, AT(aero),
     .help = "aerodynamics; needs the key 'turbine'; default none"},
    {.name = "control", .kind = BOUGH_KEY_MAPPING, .of = &bough_scene_control_schema, AT(control),
     .help = "controller of the turbine's generator and pitch; default none"},
    {.name = "modes", .kind = BOUGH_KEY_MAPPING, .of = &modes_schema, AT(modes),
     .help = "settings of 'bough modes'"},
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
    fputs("# Scenes\n\nThis page lists all keys of a scene. A scene is a YAML file. Paths of files are "
          "relative to it. Values are SI\nnumbers or have a unit:\n\n", stream);
    bough_schema_help_units(stream);
    fputs("\nAn angle or an angular speed that is not 0 needs its unit.\n\n"
          "A list of mappings with the same keys may be written as a table. A unit after the name of "
          "a column applies to\nall numbers of the column:\n\n"
          "    stations:\n"
          "      columns: [span, twist deg, chord]\n"
          "      rows:\n"
          "        - [0, 13.3, 3.5]\n"
          "        - [10, 11.5, 4.6]\n", stream);
    fputs("\n## An example\n\n", stream);
    fputs(example, stream);
    fputs("\n## Keys\n\n", stream);
    bough_schema_help(&bough_scene_schema, 0, stream);
}

void bough_scene_json_schema(FILE *stream) {
    const bough_schema *schema[] = {&bough_scene_schema};
    bough_schema_json("A scene of bough", schema, 1, stream);
}
