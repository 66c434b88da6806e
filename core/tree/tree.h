// The rigid multibody tree in joint coordinates: the user's definition (def), the constant model with its
// loads, and the data of one evaluation. Bodies that cannot move relative to each other form one link, so
// fixed joints cost no states and no work. tree_build.c builds the tree, force.h contains its forces,
// dynamics.h the recursions, loop.h the closures.
#pragma once

#include "core/base/schedule.h"
#include "core/solve/system.h"
#include "core/tree/constraint.h"
#include "core/tree/joint.h"
#include "core/tree/motion.h"

enum { BOUGH_GROUND = -1 }; // as a body's parent, a marker's body or a link's parent
enum {
    BOUGH_PORT_INPUTS = 6,
    BOUGH_PORT_OUTPUTS = 9,
    BOUGH_END_INPUTS = 6,
    BOUGH_END_OUTPUTS = 13,
    BOUGH_AXES_OUTPUTS = 9,
};

// -- def -------------------------------------------------------------------------------------

typedef struct bough_body_def {
    const char *name;
    int parent;                     // index of a body, in any order, or BOUGH_GROUND
    bough_joint_kind kind;          // the joint to the parent
    bough_transform joint;          // joint frame in the parent's body frame
    bough_vec3 axis;                // in joint axes, scaled to length 1; of those that have one
    bough_vec3 second_axis;         // normal to it, scaled to length 1; universal and planar
    bough_joint_spring spring;      // of a revolute or prismatic joint; zero: none
    bough_motion_def motion;        // of the first coordinate of a joint of one or two; zero: moved
                                    // by forces
    bough_motion_def second_motion; // of the second, of a universal or cylindrical joint
    double coordinates[BOUGH_JOINT_COORDINATES]; // initial, see joint.h [rad, m, –]
    double speeds[BOUGH_JOINT_SPEEDS];           // initial, see joint.h [rad/s, m/s]
    double mass;                                 // [kg]
    bough_vec3 mass_centre;                      // in body axes [m]
    bough_mat3 inertia;                          // about the mass centre in body axes [kg m²]
} bough_body_def;

// A massless body fixed at the origin of the ground; coordinates and quaternions at rest.
bough_body_def bough_body_def_default(void);

// A frame on a body, where things are attached and observed.
typedef struct bough_marker_def {
    const char *name;
    int body;                  // index, or BOUGH_GROUND
    bough_transform placement; // in the body frame
} bough_marker_def;

// A marker at which a flexible body is welded. Inputs, 6 per port: the wrench (force, moment) on
// the tree at the marker's origin in marker axes [N, N m]. Outputs, 9 per port: the marker's twist
// (linear, angular velocity) and the gravity vector, all in marker axes [m/s, rad/s, m/s²].
typedef struct bough_port_def {
    int marker;         // index
    bough_inertia root; // of the flexible body's root vertex, in the marker frame: the tree
                        // carries its inertia and weight, so the wrench must not contain them
    bool axes; // 9 more outputs, after those of all ends: the ground's x, y and z axis in marker axes
} bough_port_def;

// The other end of a flexible body that carries bodies: a body on a free joint, whose joint frame
// is the flexible body's frame, so that the joint's coordinates are the end's pose there. Inputs, 6
// per end after those of the ports: the wrench on it, force in joint axes and moment in body axes
// [N, N m]. Outputs, 13 per end after those of the ports: its absolute velocity in joint axes,
// angular velocity in body axes, position in joint axes and quaternion [m/s, rad/s, m, –].
typedef struct bough_end_def {
    int body;              // index, on a free joint
    bough_inertia inertia; // of the flexible body's vertex there, in body axes, as at a port
} bough_end_def;

// A load along a joint's axis: value × factor.
typedef struct bough_joint_load_def {
    int body;                // whose joint; revolute or prismatic
    double value;            // [N m] or [N]
    bough_schedule schedule; // of the factor; its table must outlive the tree
} bough_joint_load_def;

// A linear spring and damper on the line between two markers, which must not meet.
typedef struct bough_spring_def {
    int marker[2];                     // indices
    double stiffness, damping, length; // [N/m], [N s/m], without force [m]
} bough_spring_def;

// A joint between two markers that closes a loop, loop.h. The kinds are those of joints but free; the
// axis has the same components in both markers' axes, a universal joint's second axis is the second
// marker's.
typedef struct bough_closure_def {
    const char *name;
    bough_joint_kind kind;
    int marker[2]; // indices
    bough_vec3 axis, second_axis;
} bough_closure_def;

// A linear bushing: springs and dampers along and about the axes of its first marker, for displacement and
// rotation vector (of less than π) of the second marker relative to it.
typedef struct bough_bushing_def {
    int marker[2];                   // indices
    double stiffness[6], damping[6]; // three along, three about [N/m, N m/rad; times s]
} bough_bushing_def;

// A wrench on a marker: value × factor.
typedef struct bough_applied_def {
    int marker;              // index
    bough_wrench wrench;     // [N, N m]
    bool ground;             // in ground axes, else in the marker's
    bough_schedule schedule; // of the factor; its table must outlive the tree
} bough_applied_def;

typedef struct bough_tree_def {
    bough_vec3 gravity; // in ground axes [m/s²]
    int n_bodies, n_markers, n_ports, n_loads;
    const bough_body_def *bodies;
    const bough_marker_def *markers;
    const bough_port_def *ports;
    const bough_joint_load_def *loads;
    int n_springs;
    const bough_spring_def *springs;
    int n_closures;
    const bough_closure_def *closures;
    double closure_time; // in which violations of closures decay; 0: 0.01 [s]
    int n_bushings, n_applied;
    const bough_bushing_def *bushings;
    const bough_applied_def *applied;
    int n_ends;
    const bough_end_def *ends;
} bough_tree_def;

// -- model: constant once built, but for external wrenches and what is steered -------------------

// A moving body with all that is welded to it; its frame is the moving body's.
typedef struct bough_link {
    int parent;                          // link of smaller index, or BOUGH_GROUND
    int body;                            // the def's body whose joint moves it
    int part;                            // 0 or 1: a universal joint, and a driven cylindrical one,
                                         // has two links, the first without a body
    bough_joint_spring spring;           // zero: none
    bough_motion *motion;                // NULL: moved by forces; changed by bough_tree_steer only
    bough_joint joint;                   // placed in the parent link's frame
    int first_coordinate, n_coordinates; // its rows of q
    int first_speed, n_speeds;           // its rows of v
    bough_inertia inertia;               // of everything welded, in the link frame
    double matrix[36];                   // the same as a symmetric 6×6 matrix
} bough_link;

// A frame on a link (or on the ground), for bodies, markers and ports.
typedef struct bough_frame {
    char *name;
    int link;
    bough_transform placement; // in the link's frame
} bough_frame;

typedef struct bough_external {
    bool active;
    double start;                    // [s]
    bough_wrench value, rate, curve; // in marker axes [N, N m; per s; per s²]
} bough_external;

typedef struct bough_closure {
    char *name;
    int marker[2];
    bough_constraint constraint;
    int first_row; // of the equations of all closures
} bough_closure;

typedef struct bough_tree {
    bough_vec3 gravity; // in ground axes [m/s²]
    int n_links, n_bodies, n_markers, n_ports, n_loads;
    int n_q, n_v;                // the state is (q, v), n_q + n_v
    bough_link *links;           // (n_links), parents first
    bough_frame *bodies;         // (n_bodies), as in the def
    bough_frame *markers;        // (n_markers), as in the def
    bough_frame *ports;          // (n_ports), as in the def, the marker's placement
    bough_joint_load_def *loads; // (n_loads), as in the def
    double *steered;             // (n_loads × 4) two times, two values: tables of steered loads
    int n_springs;
    bough_spring_def *springs; // (n_springs), as in the def
    int n_closures, n_rows;    // n_rows: equations of all closures
    bough_closure *closures;   // (n_closures), as in the def
    double closure_time;       // [s]
    int closure_rank;          // how many of the equations are independent at the start
    double closure_moved;      // how far assembly moved a coordinate [rad, m]
    double closure_size;       // extent of the bodies and closures at the start [m]
    double closure_dependent;  // up to which eigenvalues may count as zero, relative to the largest
    int n_bushings, n_applied;
    bough_bushing_def *bushings; // (n_bushings), as in the def
    bough_applied_def *applied;  // (n_applied), as in the def
    int n_ends;
    bough_frame *ends; // (n_ends), as in the def, the body's frame
    int n_axes;
    int *axes;                // (n_axes) the ports that output the ground's axes
    bough_external *external; // (n_markers), changed by bough_tree_set_wrench only
    double *initial;          // initial state (n_q + n_v)
} bough_tree;

// Sizes of the input and the output of all ports and ends.
static inline int bough_tree_n_inputs(const bough_tree *tree) {
    return BOUGH_PORT_INPUTS * tree->n_ports + BOUGH_END_INPUTS * tree->n_ends;
}

static inline int bough_tree_n_outputs(const bough_tree *tree) {
    return BOUGH_PORT_OUTPUTS * tree->n_ports + BOUGH_END_OUTPUTS * tree->n_ends +
           BOUGH_AXES_OUTPUTS * tree->n_axes;
}

// The rows of the state that hold the first coordinate and the first speed of a body's own joint;
// the same row of the state's rate is its acceleration. False when the joint is fixed.
bool bough_tree_joint_rows(const bough_tree *tree, int body, int *coordinate, int *speed);

// Coordinates and speeds of the prescribed joints at t into a state (n_q + n_v).
void bough_tree_prescribe(const bough_tree *tree, double t, double *state);

// A prescribed joint goes from one point to another in [t, t + span]: bough_motion_steer.
void bough_tree_steer(bough_tree *tree, int body, double t, double span, bough_motion_point from,
                      bough_motion_point to);

// Makes a load linear from one value to another in [t, t + span].
void bough_tree_steer_load(bough_tree *tree, int load, double t, double span, double from, double to);

// The external wrench on the tree at a marker from now on: value + τ (rate + τ curve), τ = t − start,
// each (6), force then moment, in marker axes at the marker's origin. NULL for zero.
void bough_tree_set_wrench(bough_tree *tree, int marker, double start, const double *value,
                           const double *rate, const double *curve);

// That wrench at a time.
bough_wrench bough_tree_wrench(const bough_tree *tree, int marker, double t);

// -- data of one evaluation ------------------------------------------------------------------

// Of the closures: what loop.h computes.
typedef struct bough_loops {
    bough_constraint_row *row; // (n_rows)
    double *response;          // M⁻¹Gᵀ (n_rows × n_v), a row per equation
    double *matrix;            // eigenvectors of the scaled G M⁻¹Gᵀ (n_rows × n_rows)
    double *value;             // its eigenvalues (n_rows)
    double *scale;             // (n_rows) 1/√ of its diagonal; 0: nothing moves
    double *work;              // (8 n_rows)
    double *multiplier;        // λ (n_rows) [N, N m]
    double *correction;        // M⁻¹Gᵀ μ (n_v)
    double *speed;             // (n_v) scratch
    int rank;                  // how many equations are independent
    bool found;                // response, matrix, value and scale are of the data's coordinates
} bough_loops;

typedef struct bough_tree_data {
    // computed by bough_tree_kinematics (dynamics.h), each (n_links), in link axes where nothing else is
    // stated
    bough_transform *relative; // link in its parent
    bough_transform *pose;     // link in the ground
    bough_twist *joint_twist;  // S v
    bough_twist *twist;        // of the link
    bough_vec3 *gravity;       // [m/s²]
    double *passive;           // generalised forces of the joints' springs (n_v)
    double elastic;            // energy in them [J]
    // computed by the recursions of dynamics.h
    bough_twist *acceleration; // rate of the twist's components, or a tangent
    bough_vec3 *rotation;      // tangent of the link's rotation: axes in the ground change by × rotation
    bough_wrench *wrench;      // accumulated
    double *articulated;       // articulated inertia (n_links × 6 × 6, row-major)
    double *joint_gain;        // U = Iᴬ S (n_links × 6 speeds × 6)
    double *joint_factor;      // Cholesky factor of SᵀU (n_links × 6 × 6, row-major)
    bool factored;             // the last three arrays belong to the data's coordinates
    double *force;             // generalised forces (n_v)
    double *drive;             // forces that drive prescribed joints, else 0 (n_v) [N m, N]
    int singular;              // the link whose joint moves no inertia, else -1
    bough_loops *loops;        // of the closures; NULL without
} bough_tree_data;

// The queries below read what bough_tree_kinematics has computed.

// The placement of a frame (of tree->bodies, markers or ports) in the ground.
bough_transform bough_tree_frame_pose(const bough_tree_data *data, const bough_frame *frame);

// The twist of a frame in its own axes, the same with its placement, and the twist in ground axes.
bough_twist bough_tree_frame_twist(const bough_tree_data *data, const bough_frame *frame);
bough_frame_motion bough_tree_frame_motion(const bough_tree_data *data, const bough_frame *frame);
bough_twist bough_tree_frame_velocity(const bough_tree_data *data, const bough_frame *frame);

// -- building ----------------------------------------------------------------------------------

// Builds the tree in the arena from a def whose indices are valid, parents without a cycle.
// BOUGH_INVALID, naming the body, for a place that is not finite, a joint that moves no inertia and a
// loop that does not close.
bough_status bough_tree_create(bough_arena *arena, const bough_tree_def *def, bough_tree **tree);

// Data for evaluations of the tree; as many as there are threads or users.
bough_tree_data *bough_tree_data_create(bough_arena *arena, const bough_tree *tree);

// -- as a system -------------------------------------------------------------------------------

// The rigid tree behind the contract of system.h: kind "tree". State (q, v), input 6 and output 9
// per port, 6 and 13 per end, output 9 per port with axes, as in tree.h; q̇ = N(q) v and v̇ by the
// recursive forward dynamics, in O(n). Prescribed joints follow their motion exactly: f and h do not depend
// on their states, which hold q(t) and v(t) at the end of every step, so that nothing drifts under any
// integrator or scheme. Newton's systems are solved in O(n) by tree_newton.h; with closures by dense matrices
// from differences. In the arena; `name` is copied. Tolerance per state: rtol × (1 rad, 1 m, 1 of a
// quaternion, 1 rad/s, 1 m/s).
bough_system bough_tree_system_create(bough_arena *arena, bough_tree *tree, const char *name);
