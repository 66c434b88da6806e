// The keys of a scene: simulation, modes, the whole. Its parts are in scene_schema_NAME.c.
#include "apps/bough/scene/scene_internal.h"

// clang-format would give each field of a key a line of its own:
// clang-format off

// -- solvers ------------------------------------------------------------------------------------

#define RTOL                                                                                       \
    {KEY(NUMBER, rtol), .range = "[1e-14, 0.1]", .example = "1e-5",                                \
     .help = "relative tolerance; default from simulation.accuracy"}
#define RHO                                                                                        \
    {KEY(NUMBER, rho), .range = "[0, 1]", .fallback = "0.8", .example = "0.6",                     \
     .help = "of generalized-alpha: spectral radius at infinite frequency"}
#define FILLS bough_scene_solver
static const bough_schema master_schema = {.name = "a solver", KEYS(
    {KEY(CHOICE, solver), .fallback = "ida", .choice = bough_integrator_name,
     .help = "ida, cvode-bdf: BDF of variable order; arkode-esdirk: Runge-Kutta of order 4; "
             "radau5: Runge-Kutta of order 5, up to 400 states; generalized-alpha: order 2; "
             "rosenbrock: linearly implicit Runge-Kutta of order 3; automatic: rosenbrock, and ida "
             "at a tenth of rtol where that takes fewer evaluations. The monolithic scheme's default is radau5 "
             "for rigid bodies alone, in closed loops up to 400 states, else up to 65 without air, control "
             "and stops; otherwise automatic, or ida with an rtol below 1e-6"},
    RTOL,
    {KEY(NUMBER, step), UNIT(TIME), .range = "[1e-7, 10]", .example = "10 ms",
     .help = "of generalized-alpha, rosenbrock and automatic: longest step; default the macro "
             "step, and of the last two, with a scheme for all bodies together, from simulation.accuracy "
             "and the rods"},
    RHO,
)};
const bough_schema bough_scene_micro_schema = {.name = "a solver", KEYS(
    {KEY(CHOICE, solver), .fallback = "cvode-bdf", .choice = bough_integrator_name,
     .help = "time integrator of each rod"},
    RTOL,
    {KEY(NUMBER, step), UNIT(TIME), .range = "[1e-7, 10]", .example = "10 ms",
     .help = "of generalized-alpha and rosenbrock: longest step; default from simulation.accuracy"},
    RHO,
)};
#undef FILLS

// -- simulation -----------------------------------------------------------------------------------

#define FILLS bough_scene_coupling
_Static_assert(sizeof(bough_exchange) == sizeof(int) && sizeof(bough_acceleration) == sizeof(int),
               "choices are stored as int");
// The schemes' own keys are allowed with any scheme, so that --set may change the scheme alone; bough_scene_warn
// names those that are not used.
static const bough_schema coupling_schema = {.name = "the coupling", KEYS(
    {KEY(CHOICE, scheme), .fallback = BOUGH_SCHEME_DEFAULT, .choice = bough_scheme_name,
     .help = "how sub-systems exchange their values. The default integrates all bodies as one system"},
    {NAMED("order", INTEGER), AT(options.order), .range = "[0, 2]", .fallback = "1", .example = "2",
     .help = "of extrapolated and of iterated end values: degree of the polynomial"},
    {NAMED("theta", NUMBER), AT(options.theta), .word = "auto", .range = "[0.5, 1]",
     .fallback = "auto", .example = "0.6",
     .help = "of ramp: weight of the predicted rates; auto: 0.5, and a scene on which that is "
             "unstable is refused"},
    {NAMED("exchange", CHOICE), AT(options.exchange),
     CHOICES([BOUGH_EXCHANGE_END_VALUES] = "end-values", [BOUGH_EXCHANGE_WAVEFORM] = "waveform"),
     .fallback = "end-values",
     .help = "of iterated: quantities on which the iteration converges: values at the end of the macro step, or cubics through values within it"},
    {NAMED("accelerator", CHOICE), AT(options.accelerator), .fallback = "iqn-ils",
     .choices = bough_acceleration_names,
     .help = "of iterated: how the next values of the iteration are computed"},
    {NAMED("relaxation", NUMBER), AT(options.relaxation), .range = "[0.001, 1]", .fallback = "0.5",
     .example = "0.7",
     .help = "of iterated: factor of the correction; the first one of aitken and iqn-ils"},
    {NAMED("tolerance", NUMBER), AT(options.tolerance), .word = "auto", .range = "[1e-12, 0.1]",
     .fallback = "auto", .example = "1e-5",
     .help = "of iterated: of the interface, relative to its largest values so far; auto: 3 rtol of micro"},
    {NAMED("iterations", INTEGER), AT(options.iterations), .range = "[1, 1000]", .fallback = "30",
     .example = "50", .help = "of iterated: largest number in a macro step"},
)};
#undef FILLS

#define FILLS bough_scene_output
static const bough_schema output_schema = {.name = "the output", KEYS(
    {KEY(NUMBER, interval), UNIT(TIME), .range = "> 0", .example = "50 ms",
     .help = "time between recorded values, a multiple of the macro step; default the macro step"},
    {KEY(NUMBER, from), UNIT(TIME), .range = ">= 0", .fallback = "0", .example = "30 s",
     .help = "start of the statistics in summary.json"},
    {KEY(NUMBER, frames), UNIT(TIME), .range = "> 0", .example = "0.1 s",
     .help = "time between shapes stored for ParaView, with the section loads of rods, and for "
             "`bough report`; default none"},
    {KEY(BOOLEAN, binary), .fallback = "false",
     .help = "also writes channels.outb at the end, OpenFAST's binary format with 16 bits for each value "
             "and equal steps, without a last row at another time"},
    {KEY(TEXTS, channels), .count = 1, COUNT_AT(n_channel), .example = "[RotSpeed, 'Root*']",
     .help = "names or patterns of the channels that are recorded; default all"},
)};
#undef FILLS

#define FILLS bough_scene_step_control
static const bough_schema step_control_schema = {.name = "the step control", KEYS(
    {KEY(NUMBER, tolerance), .range = "[0, 1]", .fallback = "0", .example = "1e-3",
     .help = "largest difference between the value obtained at a port and the value applied, "
             "relative to the largest value so far; 0: fixed steps"},
    {KEY(NUMBER, min), UNIT(TIME), .range = "> 0", .fallback = "0.1 ms", .example = "1 ms",
     .help = "shortest macro step"},
)};
#undef FILLS

#define FILLS bough_scene_simulation
static const bough_schema simulation_schema = {.name = "the simulation", KEYS(
    {KEY(NUMBER, duration), UNIT(TIME), .range = ">= 1e-7", .required = true, .example = "40 s",
     .help = "simulated time, a multiple of the macro step"},
    {KEY(NUMBER, accuracy), .range = "[1e-7, 0.1]", .fallback = "0.005", .example = "0.001",
     .help = "largest error of a channel that the run aims at, relative to the channel's range. "
             "Tolerances, steps, the rate of the air and segments that the scene does not name "
             "follow from it"},
    {KEY(NUMBER, macro_step), UNIT(TIME), .range = "[1e-9, 1e4]", .example = "20 ms",
     .help = "time between exchanges; default from simulation.accuracy, such that the duration and "
             "the periods of output, air and control are multiples"},
    {KEY(MAPPING, step_control), .of = &step_control_schema,
     .help = "bisection of the macro step where the coupling error is too large"},
    {KEY(CHOICE, initial),
     CHOICES([BOUGH_SCENE_UNDEFORMED] = "undeformed",
             [BOUGH_SCENE_IN_EQUILIBRIUM] = "equilibrium",
             [BOUGH_SCENE_IN_OPERATION] = "operation"),
     .fallback = "undeformed",
     .help = "undeformed: as the scene says; equilibrium: with the loads at time 0, joints with a "
             "speed keep it, free, spherical and planar ones with all their motions; operation: equilibrium at the rotor speed and pitch at which the "
             "torque of the air equals that of 'control: {kind: variable-speed}'"},
    {KEY(MAPPING, coupling), .of = &coupling_schema, .help = "the coupling scheme"},
    {KEY(MAPPING, master), .of = &master_schema,
     .help = "integrator of the tree of bodies; of the monolithic scheme for all bodies together"},
    {KEY(MAPPING, micro), .of = &bough_scene_micro_schema, .help = "integrator of each rod"},
    {KEY(NUMBER, error_bound), .range = "[0, 1]", .fallback = "0.05", .example = "0.02",
     .help = "largest estimated error of a channel of motion, relative to the channel's range; a run with a larger "
             "error ends with exit code 3 and names the cause, or warns if the mesh alone is the cause; 0: no bound"},
    {KEY(CHOICE, error_estimate), .fallback = "companion",
     CHOICES([BOUGH_SCENE_COMPANION] = "companion", [BOUGH_SCENE_NO_ESTIMATE] = "none"),
     .help = "companion: a second solution beside the run that is coarser (half the segments, twice the "
             "steps, half the sampling rate of the air) gives the whole error of every channel, for a third to half "
             "of the run's cost; a rod of up to eight segments, or up to three times those of such a rod beside it, has twice as many there, at least eight, which mostly costs 0.4 to 1.2 of the run"},
    {KEY(BOOLEAN, error_shares), .fallback = "false",
     .help = "also gives the separate errors of mesh, air and time, by further runs after the run"},
    {KEY(INTEGER, threads), .range = "[0, 1024]", .fallback = "0", .example = "2",
     .help = "threads for the rods; --threads overrides; 0: OMP_NUM_THREADS, 1 where that is not set"},
    {KEY(MAPPING, output), .of = &output_schema, .help = "what is recorded"},
)};
#undef FILLS

// -- modes ----------------------------------------------------------------------------------------

#define FILLS bough_scene_modes
static const bough_schema modes_schema = {.name = "the modes", KEYS(
    {KEY(INTEGER, count), .range = "[1, 60]", .fallback = "12", .example = "20",
     .help = "number of modes of each rod or of the scene, from the lowest frequency"},
    {KEY(CHOICE, of),
     CHOICES([BOUGH_SCENE_MODES_AUTO] = "auto", [BOUGH_SCENE_MODES_RODS] = "rods",
             [BOUGH_SCENE_MODES_SCENE] = "scene"), .fallback = "auto",
     .help = "rods: each rod with its root held; scene: the whole scene; auto: rods if no joint "
             "moves, or if a speed or an axis is given"},
    {KEY(CHOICE, at),
     CHOICES([BOUGH_SCENE_UNDEFORMED] = "undeformed",
             [BOUGH_SCENE_IN_EQUILIBRIUM] = "equilibrium"), .fallback = "equilibrium",
     .help = "state of the whole scene about which modes are computed; in equilibrium, joints with "
             "a speed keep it"},
    {KEY(NUMBER, speed), UNIT(ANGULAR_SPEED), .fallback = "0", .example = "12.1 rpm",
     .help = "steady rotation of the rods' roots; the whole scene rotates by the speeds of its joints"},
    {NAMED("about", TEXT), AT(about_name), .example = "hub",
     .help = "body on the revolute joint about whose axis the roots rotate; default the nearest "
             "revolute joint that carries the rod"},
    {KEY(VECTOR, axis), .count = 3, .fallback = ZERO3, .example = "[1, 0, 0]",
     .help = "direction of the axis of rotation in ground axes; replaces 'about'"},
    {KEY(VECTOR, centre), .count = 3, UNIT(LENGTH), .fallback = ZERO3, .example = "[0, 0, 90 m]",
     .help = "a point of 'axis', ground axes"},
    {KEY(CHOICE, air),
     CHOICES([BOUGH_SCENE_AIR_FROZEN] = "frozen", [BOUGH_SCENE_AIR_QUASI_STEADY] = "quasi-steady",
             [BOUGH_SCENE_AIR_DYNAMIC] = "dynamic"), .fallback = "frozen",
     .help = "of the whole scene: frozen: the aerodynamic forces are those of the equilibrium; "
             "quasi-steady: they follow the motion immediately; dynamic: with the scene's dynamic "
             "inflow and stall"},
    {KEY(BOOLEAN, shapes), .fallback = "false", .help = "writes the shapes of the modes"},
    {KEY(BOOLEAN, linear), .fallback = "false",
     .help = "of the whole scene: writes its linear state space, the matrices A to D and the names "
             "of its states, inputs and outputs"},
)};
#undef FILLS

// -- the scene ------------------------------------------------------------------------------------

static void already_expanded(bough_schema_reader *r, const bough_node *node, void *field) {
    (void)r, (void)node, (void)field;
}

#define FILLS bough_scene
const bough_schema bough_scene_schema = {.name = "a scene", KEYS(
    {KEY(TEXT, base), .example = "runup.yaml",
     .help = "scene on which this one builds: the file has only what differs"},
    {KEY(TEXT, title), .example = "A bar that swings", .help = "what the scene shows"},
    {KEY(VECTOR, gravity), .count = 3, UNIT(ACCELERATION), .fallback = "[0, 0, -9.80665]",
     .example = "[0, 0, -9.81 m/s^2]", .help = "ground axes, z up"},
    {KEY(MAPPING, simulation), .of = &simulation_schema, .required = true,
     .help = "time, coupling and solvers"},
    {NAMED("bodies", LIST), AT(body), .of = &bough_scene_body_schema, .count = 1,
     COUNT_AT(n_body), .help = "the tree of bodies; required unless the turbine is one block"},
    {NAMED("loads", LIST), AT(load), .of = &bough_scene_load_schema, COUNT_AT(n_load),
     .help = "loads on joints and bodies"},
    {NAMED("springs", LIST), AT(connector[BOUGH_SCENE_SPRING]), .of = &bough_scene_spring_schema,
     COUNT_AT(n_connector[BOUGH_SCENE_SPRING]), .help = "springs and dampers between points of rigid bodies"},
    {NAMED("bushings", LIST), AT(connector[BOUGH_SCENE_BUSHING]), .of = &bough_scene_bushing_schema,
     COUNT_AT(n_connector[BOUGH_SCENE_BUSHING]), .help = "springs and dampers in six directions between rigid bodies"},
    {NAMED("closures", LIST), AT(connector[BOUGH_SCENE_CLOSURE]), .of = &bough_scene_closure_schema,
     COUNT_AT(n_connector[BOUGH_SCENE_CLOSURE]), .help = "joints that close loops between rigid bodies"},
    {NAMED("markers", LIST), AT(marker), .of = &bough_scene_marker_schema, COUNT_AT(n_marker),
     .help = "points that are recorded"},
    {NAMED("sensors", LIST), AT(sensor), .of = &bough_scene_sensor_schema, COUNT_AT(n_sensor),
     .help = "places on rods whose motion and section loads are recorded"},
    {KEY(MAPPING, turbine), .of = &bough_scene_turbine_schema,
     .help = "bodies of the turbine that channels and aerodynamics need"},
    {NAMED("turbine", CUSTOM), .of = &bough_scene_block_schema, .read = already_expanded, .form = "or one block",
     .example = "{blades: 3, hub_radius: 1.5 m, cone: 2.5 deg, blade: {rod: {table: blade.yaml}}}",
     .help = "with a number of blades: tower, nacelle, hub and equal blades, which become bodies of these names"},
    {KEY(MAPPING, aero), .of = &bough_scene_aero_schema,
     .help = "aerodynamics; needs the key 'turbine'; default none"},
    {KEY(MAPPING, control), .of = &bough_scene_control_schema,
     .help = "controller of the turbine's generator and pitch; default none"},
    {KEY(MAPPING, modes), .of = &modes_schema, .help = "settings of 'bough modes'"},
)};
#undef FILLS
// clang-format on

void bough_scene_help(FILE *stream) {
    static const char mark[] = "@UNITS@\n";
    const char *text = (const char *)bough_scene_help_text, *units = strstr(text, mark);
    fprintf(stream, "%.*s", (int)(units - text), text);
    bough_schema_help_units(stream);
    fputs(units + sizeof mark - 1, stream);
    bough_schema_help(&bough_scene_schema, 0, stream);
}

void bough_scene_json_schema(FILE *stream) {
    const bough_schema *schema[] = {&bough_scene_schema};
    bough_schema_json("A scene of bough", schema, 1, stream);
}
