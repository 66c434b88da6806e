// A scene as the user wrote it: plain structs in SI units and radians, with names resolved to indices and
// all values checked. The tables of scene_schema*.c read it from a YAML file; apps/bough/model builds the
// model. Examples of every form: tests/data/scenes/example-*.yaml.
//
// All memory belongs to the arena given to bough_scene_read. Every struct begins with its place in the
// text. An optional part that is absent has `node == NULL`, and its other fields have the defaults.
//
// Axes: ground z up. Section quantities are in the section's axes, whose z is the tangent of the reference
// axis, and about the reference axis; strains in the order shear x, shear y, axial, bend about x, bend about
// y, twist.
#pragma once

#include "aero/control/controller.h"
#include "aero/control/discon.h"
#include "apps/bough/config/schema.h"
#include "apps/bough/config/text.h"
#include "apps/bough/scene/scene_air.h"
#include "core/tree/tree.h"
#include "cosim/scheme.h"
#include "flexbody/section/section.h"

typedef struct bough_scene_coupling {
    const bough_node *node;
    int scheme;                   // place in the table of schemes: bough_scheme_name
    bough_scheme_options options; // name and rtol left out; tolerance 0: three times micro.rtol
} bough_scene_coupling;

typedef struct bough_scene_solver {
    const bough_node *node;
    int solver;  // bough_integrator_kind
    double rtol; // [-]
    double step; // generalised-α and Rosenbrock: longest step [s]; 0: none
    double rho;  // its spectral radius at infinite frequency [-]
    // of companions and further runs; not in a file
    bool coarse, by_bdf;
    int most_steps; // in a macro step; 0: the method's own limit
} bough_scene_solver;

typedef struct bough_scene_output {
    const bough_node *node;
    double interval;       // [s], a multiple of the macro step
    double from;           // start of the statistics [s]
    double frames;         // time between stored shapes [s]; 0: none
    bool binary;           // channels.outb beside channels.out
    int n_channel;         // 0: all
    const char **channels; // (n_channel) patterns of those that are recorded
} bough_scene_output;

typedef struct bough_scene_step_control {
    const bough_node *node;
    double tolerance; // 0: fixed steps
    double min;       // [s]
} bough_scene_step_control;

typedef enum bough_scene_initial {
    BOUGH_SCENE_UNDEFORMED,
    BOUGH_SCENE_IN_EQUILIBRIUM, // under the loads at time 0
    BOUGH_SCENE_IN_OPERATION,   // in equilibrium at the control law's speed and pitch
} bough_scene_initial;

typedef enum bough_scene_estimate {
    BOUGH_SCENE_COMPANION, // by a coarser simulation beside the run
    BOUGH_SCENE_NO_ESTIMATE,
} bough_scene_estimate;

typedef struct bough_scene_simulation {
    const bough_node *node;
    double duration;   // [s], a multiple of the macro step
    double macro_step; // [s]
    bool halves;       // of a companion: some macro steps are taken in two halves; not in a file
    double accuracy;   // aimed at, of each channel relative to its range
    bough_scene_step_control step_control;
    int initial; // bough_scene_initial: how the rods and joints start
    bough_scene_coupling coupling;
    bough_scene_solver master, micro;
    double error_bound; // of a channel's error relative to its range; 0: none
    int error_estimate; // bough_scene_estimate
    bool error_shares;  // the separate errors of mesh, air and time
    int threads;
    bough_scene_output output;
} bough_scene_simulation;

typedef enum bough_scene_axis { BOUGH_SCENE_X, BOUGH_SCENE_Y, BOUGH_SCENE_Z } bough_scene_axis;

// The rotation about it by an angle [rad]; bough_unit3 is its unit vector.
bough_mat3 bough_scene_rotation(int axis, double angle);

// The prescribed motion of an angle [rad, rad/s] or a displacement [m, m/s] of a joint.
typedef struct bough_scene_motion {
    const bough_node *node; // NULL: moved by forces
    const char *input;      // name of the input that replaces the constant of `def`; NULL: none
    bough_motion_def def;
} bough_scene_motion;

// The joint that carries a body. Its frame is the body's frame at zero joint displacement.
typedef struct bough_scene_joint {
    const bough_node *node;
    int kind;                  // bough_joint_kind
    const char *parent_name;   // as written
    int parent;                // index of a body, or BOUGH_GROUND
    bough_transform placement; // of the joint's frame in the parent's, on a body with a rod from the rod's
                               // end, in the axes of the rod's body, which turn with the last section
    int axis;                  // bough_scene_axis of all but fixed, spherical and free
    int second_axis;           // bough_scene_axis of universal, not the first
    double coordinates[BOUGH_JOINT_COORDINATES]; // initial, as core/tree/joint.h has them; of free and
                                                 // spherical 0 [rad, m]
    double
        speeds[BOUGH_JOINT_SPEEDS]; // likewise; the linear ones of planar in the joint's frame [rad/s, m/s]
    bough_joint_spring spring;      // of revolute and prismatic
    bough_scene_motion motion[2];   // of the first coordinate; of the second of cylindrical (the
                                    // angle) and universal
} bough_scene_joint;

// A section of a rod. Between stations everything is linear in span.
typedef struct bough_scene_station {
    const bough_node *node;
    bough_section_station def; // z of its position is the span
} bough_scene_station;

// The structure of a rod; a file holds one.
typedef struct bough_scene_structure {
    const bough_node *node;
    const char *source;           // where the data come from; NULL: not said
    double length;                // extent along z [m]
    double damping[6];            // stress = stiffness (strain + damping · strain rate) [s]
    int n_station;                // 1: uniform, that station holds for all of [0, length]
    bough_scene_station *station; // (n_station), spans strictly increasing from 0 to length; the
                                  // same pointer for bodies that name the same file
} bough_scene_structure;

typedef struct bough_scene_rod {
    const bough_node *node; // NULL: the body has no rod
    int n_segment;
    double grading;                  // of their lengths: bough_section_graded
    bough_scene_structure structure; // of the table, or of the one section given in the scene
    // As written in the scene; merged into `structure`:
    double part[2]; // interval of the table's span [m]
    bough_scene_station uniform;
} bough_scene_rod;

// Linear reductions of a body's rod.
typedef struct bough_scene_modal {
    const bough_node *node; // NULL: all defaults
    int modes;              // number in each piece
    bool statics;           // static deflections under accelerations are among the shapes
    bool stiffening;        // by axial forces
    int pieces;             // of a segmented-modal body
} bough_scene_modal;

typedef enum bough_scene_fidelity {
    BOUGH_SCENE_RIGID,
    BOUGH_SCENE_ROD,
    BOUGH_SCENE_MODAL,
    BOUGH_SCENE_SEGMENTED_MODAL,
    BOUGH_SCENE_FMU,
} bough_scene_fidelity;

enum { BOUGH_SCENE_MOTION = 9, BOUGH_SCENE_WRENCH = 6 };

typedef enum bough_fmu_causality {
    BOUGH_FMU_INPUT,
    BOUGH_FMU_OUTPUT,
    BOUGH_FMU_PARAMETER,
    BOUGH_FMU_LOCAL, // any other
} bough_fmu_causality;

// A variable of type Float64.
typedef struct bough_fmu_variable {
    const char *name;
    uint32_t reference;
    bough_fmu_causality causality;
    bool array;       // it has dimensions
    const char *unit; // as written; NULL: none
} bough_fmu_variable;

typedef struct bough_fmu_description {
    const char *identifier; // of the library
    const char *token;
    bool restores; // its state can be stored and restored
    bool once;     // only one instance in a process
    int n_variable;
    bough_fmu_variable *variable; // (n_variable)
    int n_scaled;
    const char **scaled; // (n_scaled) names of units that are not SI: with a factor or an offset
} bough_fmu_description;

// What a controller that is an FMU gets, besides each blade's pitch [rad]; SI.
typedef enum bough_scene_sensed {
    BOUGH_SENSED_TIME,
    BOUGH_SENSED_GENERATOR_SPEED,
    BOUGH_SENSED_ROTOR_SPEED,
    BOUGH_SENSED_TORQUE, // of the generator
    BOUGH_SENSED_POWER,  // electrical
    BOUGH_SENSED_WIND,   // at the hub, along the shaft
    BOUGH_SENSED_AZIMUTH,
    BOUGH_SENSED_YAW_ERROR,
    BOUGH_SCENE_SENSED,
} bough_scene_sensed;

enum { BOUGH_FMU_VALUES = BOUGH_SCENE_SENSED + BOUGH_MOST_BLADES };

// Variables of an FMU and the quantities of the scene that they stand for.
typedef struct bough_fmu_values {
    int n;
    int quantity[BOUGH_FMU_VALUES];       // (n) the quantity of each variable
    uint32_t reference[BOUGH_FMU_VALUES]; // (n)
} bough_fmu_values;

// Parameters of an FMU by their names.
typedef struct bough_scene_values {
    int n;
    const char **name;              // (n)
    double *value;                  // (n) in the unit that the FMU declares
    const struct bough_node **node; // (n)
} bough_scene_values;

// A model of another program: a co-simulation FMU of FMI 3.0.
typedef struct bough_scene_fmu_model {
    const bough_node *node;
    const char *folder;   // path of its archive or of its unpacked folder
    const char *unpacked; // path of the unpacked folder, of an archive a temporary one
    bough_scene_values parameters;
    uint32_t *reference; // (parameters.n) of the parameters
    bough_fmu_description description;
} bough_scene_fmu_model;

// An FMU at a body's frame. Its inputs are velocity, angular velocity and gravity of the frame in body axes,
// its outputs force and moment on the frame's carrier about the frame's origin in body axes; SI.
typedef struct bough_scene_fmu {
    bough_scene_fmu_model model;
    int n_motion, n_wrench;
    const char **motion,
        **wrench; // names of its variables, "none" where it has none; NULL: the default names
    int hold;     // bough_scene_fmu_hold
    int steps;    // communication steps per macro step
    bough_fmu_values input, output; // of motion and wrench
} bough_scene_fmu;

// What an FMU does with its inputs over a communication step.
typedef enum bough_scene_fmu_hold {
    BOUGH_SCENE_FMU_HELD,    // it keeps them
    BOUGH_SCENE_FMU_REACHED, // it reaches them at the end of the step
} bough_scene_fmu_hold;

typedef struct bough_scene_body {
    const bough_node *node;
    const char *name;
    int repeat;   // number of such bodies in a chain; when the scene is read they become bodies of their own
    int fidelity; // bough_scene_fidelity
    bough_scene_joint joint;
    double pitch;             // [rad]: last rotation of the placement, about z by −pitch
    double mass;              // [kg] of a rigid body without a rod; of an FMU what it adds to its carrier
    double centre_of_mass[3]; // [m] body axes
    double inertia[6];        // Ixx Iyy Izz Ixy Ixz Iyz about the centre of mass [kg m²]: entries
                              // of the inertia matrix, Ixy = −∫xy
    bough_scene_solver micro; // of this body in place of the simulation's; node NULL: none
    bough_scene_rod rod;      // of a flexible body; mass and inertia of a rigid body follow from it
    bough_scene_modal modal;  // fidelity modal and segmented-modal
    bough_scene_fmu fmu;      // fidelity fmu
} bough_scene_body;

// Whether the body is a rod, a modal body or an FMU; false after an error in its fidelity.
static inline bool bough_scene_is_flexible(const bough_scene_body *body) {
    return body->fidelity == BOUGH_SCENE_ROD || body->fidelity == BOUGH_SCENE_MODAL ||
           body->fidelity == BOUGH_SCENE_SEGMENTED_MODAL || body->fidelity == BOUGH_SCENE_FMU;
}

// Whether the body has a mesh: a rod or a modal body.
static inline bool bough_scene_has_mesh(const bough_scene_body *body) {
    return body->rod.node != NULL && body->fidelity != BOUGH_SCENE_RIGID;
}

typedef enum bough_scene_load_frame {
    BOUGH_SCENE_LOAD_GROUND,   // ground axes
    BOUGH_SCENE_LOAD_BODY,     // axes of the body's frame
    BOUGH_SCENE_LOAD_FOLLOWER, // section axes: the load rotates with the section
} bough_scene_load_frame;

// Where a load acts on a rod, in arc length.
typedef enum bough_scene_load_place {
    BOUGH_SCENE_AT_TIP,
    BOUGH_SCENE_AT_VERTEX,
    BOUGH_SCENE_AT_SPAN,
    BOUGH_SCENE_ALONG, // distributed
} bough_scene_load_place;

// A load on a joint, a rod or a rigid body. Its factor over time is 0 before ramp[0], 1 after ramp[1], linear
// between, a jump where they are equal; {0, 0}: always 1.
typedef struct bough_scene_load {
    const bough_node *node;
    const char *joint_name; // NULL: the load acts on a body
    int joint;              // index of the body that the joint carries
    double amount;          // torque [N m] of a revolute joint, force [N] of a prismatic one
    int n_time;             // rows of a table in place of the amount, 0: none
    double *times, *values; // (n_time) [s], [N m] or [N], on a body factors; linear between, constant
                            // before and after
    const char *body_name;  // NULL: the load acts on a joint
    int body;               // index of a body
    int place;              // bough_scene_load_place
    int vertex;             // AT_VERTEX: 0 is the root
    double span[2];         // AT_SPAN: the first; ALONG: from, to [m]
    double wrench[6];       // force [N], moment [N m]; ALONG: [N/m], [N m/m]
    double end[6];          // ALONG: at span[1], linear between; by default as above
    int frame;              // bough_scene_load_frame
    double ramp[2];         // [s]
    const char *input;      // name of its input; NULL: none
    double point[3];        // on a rigid body: in its frame [m]
} bough_scene_load;

// The factor of a load over time; the table stays the scene's.
static inline bough_schedule bough_scene_load_schedule(const bough_scene_load *load) {
    return (bough_schedule){load->ramp[0], load->ramp[1], load->n_time, load->times, load->values};
}

typedef enum bough_scene_connector_kind {
    BOUGH_SCENE_SPRING,  // a linear spring and damper between two points
    BOUGH_SCENE_BUSHING, // springs and dampers along and about the axes of the first body, at a point of it,
                         // free of force in the initial position
    BOUGH_SCENE_CLOSURE, // a joint that closes a loop
    BOUGH_SCENE_CONNECTORS,
} bough_scene_connector_kind;

// Acts between two rigid bodies, or one and the ground.
typedef struct bough_scene_connector {
    const bough_node *node;
    const char *name;
    const char *body_name[2];
    int body[2];               // indices, or BOUGH_GROUND
    bool holds;                // by stiffness or a joint, not by damping alone
    double point[2][3];        // of a spring, in the bodies' frames; the first also of a bushing [m]
    bough_spring_def spring;   // without markers
    bough_bushing_def bushing; // without markers
    // of a closure
    int kind;                     // bough_joint_kind, not free
    bough_transform placement[2]; // of the joint's frame in either body's
    int axis, second_axis; // bough_scene_axis in the first body's placement; of universal in the second's
} bough_scene_connector;

// A point of a rigid body or the ground that is recorded.
typedef struct bough_scene_marker {
    const bough_node *node;
    const char *name, *body_name;
    int body;        // index, or BOUGH_GROUND
    double point[3]; // in the body's frame [m]
} bough_scene_marker;

// Places on a rod whose motion and section loads are recorded.
typedef struct bough_scene_sensor {
    const bough_node *node;
    const char *body_name;
    int body; // index of a body of fidelity rod
    int n_at;
    double *at; // (n_at) arc lengths from the root [m]
} bough_scene_sensor;

typedef struct bough_scene_turbine {
    const bough_node *node; // NULL: no turbine
    const char *rotor_name;
    int rotor; // index of the body on the rotor's revolute joint
    int n_blade;
    const char **blade_name; // (n_blade)
    int *blade;              // (n_blade) indices of bodies with a rod
} bough_scene_turbine;

typedef enum bough_scene_controller {
    BOUGH_SCENE_VARIABLE_SPEED,
    BOUGH_SCENE_BLADED,
    BOUGH_SCENE_EXTERNAL, // another program, by inputs
    BOUGH_SCENE_CONTROL_FMU,
} bough_scene_controller;

// Names of an FMU's variables for quantities of the turbine.
typedef struct bough_scene_terminals {
    const bough_node *node;
    const char *name[BOUGH_SCENE_SENSED]; // NULL: none; of the outputs only the torque is used
    int n_pitch;
    const char **pitch;      // (n_pitch) of blade 1, 2 …; a single output is that of all blades
    bough_fmu_values values; // of `name`, then of `pitch`
} bough_scene_terminals;

typedef struct bough_scene_control_fmu {
    bough_scene_fmu_model model;
    bough_scene_terminals inputs, outputs;
} bough_scene_control_fmu;

typedef enum bough_scene_event_kind {
    BOUGH_SCENE_START,
    BOUGH_SCENE_STOP,
    BOUGH_SCENE_EMERGENCY_STOP,
    BOUGH_SCENE_GRID_LOSS,
    BOUGH_SCENE_PITCH_STUCK,
    BOUGH_SCENE_PITCH_RUNAWAY,
    BOUGH_SCENE_PITCH_TO,
    BOUGH_SCENE_YAW_RUNAWAY,
} bough_scene_event_kind;

enum { BOUGH_MOST_EVENTS = 8 };

// An event of the turbine at a time, or later when a channel passes a threshold.
typedef struct bough_scene_event {
    const bough_node *node;
    int kind;              // bough_scene_event_kind
    double at;             // earliest time [s]
    const char *channel;   // whose threshold triggers it; NULL: it happens at that time
    double threshold;      // in the channel's unit
    bool falls;            // the event occurs below it, else above
    int blade;             // number of the blade with the fault, from 1; 0: no blade
    const char *body_name; // YAW_RUNAWAY: on the yaw joint
    int body;              // its index
    double angle;          // final pitch or yaw [rad]
    double rate;           // of the motion to the angle [rad/s]; 0: that of the kind ("auto")
} bough_scene_event;

// Controls the generator's torque, and the pitch of blades on joints with a motion.
typedef struct bough_scene_control {
    const bough_node *node;      // NULL: no controller
    int kind;                    // bough_scene_controller
    double rate;                 // samples per second [Hz]
    double gear_ratio;           // generator speed over rotor speed
    double efficiency;           // electrical over mechanical power
    bool pitch;                  // is controlled too
    bool individual;             // BLADED: each blade follows its own demand
    const char *library, *input; // BLADED: paths; no input: ""
    bool copied;                 // BLADED: the library is loaded as a copy, for a companion; not in a file
    bough_scene_control_fmu fmu; // CONTROL_FMU
    int n_event;
    bough_scene_event *event; // (n_event)
    bough_controller_def law; // BLADED, CONTROL_FMU: only the pitch rate is used
} bough_scene_control;

// Whether the controller is a library or an FMU, whose memory cannot be copied.
static inline bool bough_scene_control_is_foreign(const bough_scene_control *control) {
    return control->node && (control->kind == BOUGH_SCENE_BLADED || control->kind == BOUGH_SCENE_CONTROL_FMU);
}

typedef enum bough_scene_modes_of {
    BOUGH_SCENE_MODES_AUTO, // of the rods where they are independent, or `speed` or `axis` is given
    BOUGH_SCENE_MODES_RODS,
    BOUGH_SCENE_MODES_SCENE,
} bough_scene_modes_of;

// How the forces of the air follow the motion in modes.
typedef enum bough_scene_modes_air {
    BOUGH_SCENE_AIR_FROZEN,
    BOUGH_SCENE_AIR_QUASI_STEADY,
    BOUGH_SCENE_AIR_DYNAMIC,
} bough_scene_modes_air;

// Settings of `bough modes`, which a run ignores.
typedef struct bough_scene_modes {
    const bough_node *node;
    int of;                 // bough_scene_modes_of
    int at;                 // bough_scene_initial: state about which modes of the whole scene are computed
    int count;              // modes of each rod, or of the scene
    double speed;           // of a steady rotation [rad/s]; 0: at rest
    const char *about_name; // NULL: the nearest revolute joint that carries the rod
    int about;              // index of the body on the revolute joint, when named
    double axis[3];         // replaces `about`, ground axes; {0, 0, 0}: not given
    double centre[3];       // a point of that axis, in the ground [m]
    int air;                // bough_scene_modes_air; of the whole scene
    bool shapes;            // are written too
    bool linear;            // the linear state space of the whole scene is written too
} bough_scene_modes;

// An input: a value with a name, which another program sets between steps.
typedef enum bough_scene_input_kind {
    BOUGH_INPUT_LOAD,   // multiplies a load, or is one along a joint
    BOUGH_INPUT_MOTION, // where a joint is
    BOUGH_INPUT_WIND,   // the wind's speed
    BOUGH_INPUT_TORQUE, // demanded of the generator, on the fast shaft
    BOUGH_INPUT_PITCH,  // demanded of a blade
} bough_scene_input_kind;

typedef struct bough_scene_input {
    const bough_node *node; // where it is named
    const char *name;
    bough_scene_input_kind kind;
    int dimension;     // bough_dimension
    const char *range; // of its values, SI: that of the key that it replaces; NULL: any
    double initial;    // value until it is set, SI
    int index;         // of the load, the body on the joint, or the blade
} bough_scene_input;

typedef struct bough_scene {
    const bough_node *node;
    const char *file;                      // path of the scene
    const struct bough_schema_file *named; // the files that its keys name, last first: see scene_files.h
    const struct bough_schema_base *bases; // the files on which it builds
    const char *base;                      // file on which the scene builds, as written; NULL: none
    const char *title;
    double gravity[3]; // [m/s²] ground axes
    bough_scene_simulation simulation;
    int n_body;
    bough_scene_body *body;           // (n_body) in the file's order; a parent may come after its child
    int *order;                       // (n_body) indices of bodies, parents before children
    const bough_scene_body **by_name; // (n_body) by name, then by place
    int n_load;
    bough_scene_load *load; // (n_load)
    int n_connector[BOUGH_SCENE_CONNECTORS];
    bough_scene_connector *connector[BOUGH_SCENE_CONNECTORS]; // (n_connector) by kind
    int n_marker;
    bough_scene_marker *marker; // (n_marker)
    int n_sensor;
    bough_scene_sensor *sensor; // (n_sensor)
    bough_scene_turbine turbine;
    bough_scene_aero aero;       // needs the turbine
    bough_scene_control control; // likewise
    bough_scene_modes modes;
    int n_input;
    bough_scene_input *input; // (n_input) of all parts above
} bough_scene;

// Reads and checks the scene with the replacements `sets` ("bodies[2].pitch=5 deg"). Every error
// found is added to `errors`; then the status is BOUGH_INVALID and *scene is NULL. `shared`: tables of files
// that several scenes have in common; NULL: none.
bough_status bough_scene_read(bough_arena *arena, bough_schema_shared *shared, const char *path,
                              const char *const *sets, int n_set, bough_errors *errors, bough_scene **scene);

// A copy whose bodies may be changed; the rest is shared.
bough_scene *bough_scene_copy(bough_arena *arena, const bough_scene *scene);

// Gives the k-th input another value at time 0 (SI): the scene is then as if its own key had that value.
void bough_scene_start_input(bough_scene *scene, int k, double value);

// The place of a value before a message, "file:line:column: " or "--set: ", written into `text`; "" of NULL.
const char *bough_scene_place(const bough_node *value, char *text, size_t size);

// Puts place and key of the value before the message of a BOUGH_INVALID, found while the scene is built.
bough_status bough_scene_blame(const bough_node *value, const char *key, bough_status status);

// The same for a message that quotes the name of a body, a marker or a connector, or of one of their
// channels.
bough_status bough_scene_blame_named(const bough_scene *scene, bough_status status);

// Writes a warning for each value that is valid but probably an error: an inertia that no mass distribution
// has, a setting that the chosen scheme, solver, control, wind or estimate does not use.
void bough_scene_warn(const bough_scene *scene, FILE *stream);

// The sub-solver of a flexible body: its own or the simulation's.
const bough_scene_solver *bough_scene_micro(const bough_scene *scene, const bough_scene_body *body);

// Whether `carrier` is a body or carries it, by any number of joints; false in a loop of parents.
bool bough_scene_carries(const bough_scene *scene, int carrier, int body);

// The first body that hangs on `body` by its joint; −1: none.
int bough_scene_carried_by(const bough_scene *scene, int body);

// The index of a body among the turbine's blades; −1: it is no blade.
int bough_scene_blade(const bough_scene *scene, int body);

// Length of a rod's axis, straight between its stations [m].
double bough_scene_arc_length(const bough_scene_structure *structure);

// The errors that the settings of a scene should cause, relative to its accuracy.
typedef struct bough_scene_expectation {
    double error[3]; // of mesh, air and time; 0: the scene has no such part
    bool named[3];   // the scene names the setting; otherwise it follows from the accuracy
} bough_scene_expectation;

bough_scene_expectation bough_scene_expect_errors(const bough_scene *scene);

// Whether the duration and the periods of output, air and control are multiples of the macro step [s].
bool bough_scene_step_fits(const bough_scene *scene, double macro_step);

// Whether a body's frame moves: on its joint, or with a body or a rod that carries it.
bool bough_scene_moves(const bough_scene *scene, int body);

// Whether the inertia matrix with the entries xx, yy, zz, xy, xz, yz is positive semidefinite.
bool bough_scene_semidefinite(const double entry[6]);

// Writes every key of a scene and of its data files with unit, range, default and meaning.
void bough_scene_help(FILE *stream);

// Writes the same as JSON Schema.
void bough_scene_json_schema(FILE *stream);

// Whether Radau IIA is the cheapest method for it: a few rigid bodies whose loads are not sampled
// (scene_accuracy.c).
bool bough_scene_suits_radau(const bough_scene *scene);
