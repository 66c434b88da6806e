// A simulation of a scene, with tree, rods, aerodynamics and coupling, and queries to it.
#pragma once

#include "apps/bough/results/channels.h"
#include "apps/bough/scene/scene.h"
#include "core/tree/tree.h"
#include "cosim/master.h"
#include "flexbody/modal/modal_system.h"
#include "flexbody/rod/ground_load.h"
#include "flexbody/rod/rod_system.h"

struct bough_aero_link;
struct bough_control_link;
struct bough_drag_link;
struct bough_validity;

// A body with a rod, such as a blade, cable or tower, flexible or rigid.
typedef struct bough_beam {
    int index; // of the body in the scene
    const bough_scene_body *body;
    bough_rod_def def;           // the undeformed mesh in the body's frame
    int marker;                  // of the tree, the body's frame
    int port;                    // of the tree; −1 when rigid
    bool in_ground;              // it moves and has loads in ground axes
    int end;                     // of the tree, the end that carries bodies; −1 when it carries none
    bough_inertia vertex[2];     // of the root vertex in the body's frame, or of the whole rigid body, and of
                                 // the end in its section's frame; both belong to the tree
    bough_rod_body *rod;         // NULL unless a rod
    bough_modal_body *modal;     // NULL unless modal
    const bough_rod_model *mesh; // of either, NULL when rigid
    bough_rod_loads *loads;      // on it
    bough_ground_body *ground;   // around either, NULL unless in_ground
} bough_beam;

typedef struct bough_simulation {
    const bough_scene *scene;
    bough_tree *tree;
    bough_tree_data *view; // for queries between steps
    double *acceleration;  // of the tree (n_v), scratch of queries
    double *accelerated;   // (1) time for which `view` has its links' accelerations [s]; NAN: none
    bough_member leader;
    bough_assembly *assembly; // of leader, rods and FMUs: the master's, and one before it is built
    int first_marker;         // of the tree, the first of those that the scene names
    int n_beam;
    bough_beam *beam;  // (n_beam) bodies that have a rod, in the scene's order
    bough_member *rod; // (n_rod + n_fmu) in port order, the FMUs last
    int n_rod, n_end, n_fmu;
    double *input;                        // (scene->n_input) present values, SI; may be set between steps
    struct bough_aero_link *aero;         // NULL without an aero block
    struct bough_drag_link *drag;         // NULL without drag of tower and hub
    struct bough_control_link *control;   // NULL without a control block
    struct bough_validity *validity;      // limits of the models that the run has passed
    int n_sampled;                        // of these parts, in this order:
    bough_sampled_load sampled[5];        // inputs, air, drag, control, loads that jump
    bool jumps;                           // some loads jump
    const bough_schedule **load_schedule; // (n_load) of the factors of the scene's loads on rods
    bough_master *master;
    bough_pool *pool; // NULL: one thread
    // first and last of the rods that carry the rotor, NULL: none; undeformed top in the frame of the foot
    const bough_beam *tower_foot, *tower_top;
    bough_transform tower_rest;
    int n_motion_channel; // number of the first channels, which follow from the states
} bough_simulation;

// Adds the channels of all parts of the scene.
bough_status bough_simulation_channels(bough_simulation *s, bough_channels *channels);

// Brings `view` to the current synchronisation point; queries and channels read it.
void bough_simulation_update(bough_simulation *s);

// The memory of later steps, at a time when all loads are sampled: see bough_master_snapshot.
void bough_simulation_snapshot(bough_simulation *s, bough_snapshot *snapshot);

// BOUGH_INVALID if a part of the scene cannot be stored.
bough_status bough_simulation_storable(const bough_simulation *s);

// BOUGH_INVALID if the equations of a part, an FMU, are not known; `what` is the reason in the message.
bough_status bough_simulation_known(const bough_simulation *s, const char *what);

// Steps of all solvers since the start of the process, failed ones included.
long bough_simulation_steps(const bough_simulation *s);

// Sets input k to a value at once if it is a load; otherwise does nothing.
void bough_simulation_put(const bough_simulation *s, int k, double value);

// Number of bodies on joints that move.
int bough_simulation_n_joints(const bough_simulation *s);

// The beam of a scene body; NULL when it has no rod. That of blade k of the turbine.
bough_beam *bough_simulation_beam(const bough_simulation *s, int body);
static inline bough_beam *bough_simulation_blade(const bough_simulation *s, int k) {
    return bough_simulation_beam(s, s->scene->turbine.blade[k]);
}

// The frame of a scene body in ground axes, and that of a beam and its twist in its own axes, in `view`.
static inline bough_transform bough_body_pose(const bough_simulation *s, int body) {
    return bough_tree_frame_pose(s->view, &s->tree->bodies[body]);
}
static inline bough_transform bough_beam_pose(const bough_simulation *s, const bough_beam *beam) {
    return bough_tree_frame_pose(s->view, &s->tree->markers[beam->marker]);
}
static inline bough_twist bough_beam_twist(const bough_simulation *s, const bough_beam *beam) {
    return bough_tree_frame_twist(s->view, &s->tree->markers[beam->marker]);
}

// The first of a flexible beam's states among those of all members.
static inline int bough_beam_row(const bough_simulation *s, const bough_beam *beam) {
    return s->assembly->state_offset[beam->port + 1];
}

// The input of a rod at the current synchronisation point: see rod.h.
const double *bough_simulation_rod_input(const bough_simulation *s, const bough_beam *beam);

// Angle or displacement of a body's joint and its rate, in the leader's state.
bough_motion_point bough_simulation_joint_point(const bough_simulation *s, int body);

// Position of vertex i of a beam in the body's frame, in which `rotation` is its section's; and of the last.
bough_vec3 bough_simulation_vertex(const bough_simulation *s, const bough_beam *beam, int i,
                                   bough_quaternion *rotation);
bough_vec3 bough_simulation_beam_tip(const bough_simulation *s, const bough_beam *beam,
                                     bough_quaternion *rotation);

// Displacement of vertex i [m] and rotation vector of the section there [rad] from the undeformed beam, in
// the body's axes.
void bough_simulation_shift(const bough_simulation *s, const bough_beam *beam, int i, bough_vec3 *shift,
                            bough_vec3 *turn);

// States of the vertices of a flexible beam from `first` on, as in rod.h, at `view`; valid until the next
// call for the same beam.
const double *bough_beam_state(const bough_simulation *s, const bough_beam *beam, int first);

// Sets the velocities of a flexible beam's state to rest relative to its frame, whose twist is in `input`.
void bough_beam_move_rigidly(const bough_beam *beam, const double *input, double *state);

// The axis of a body's joint in `view`, a unit vector in ground axes, which the joint's own angle does not
// change.
bough_vec3 bough_simulation_joint_axis(const bough_simulation *s, int body);

// The turbine's rotor in `view`: hub and axis of its joint in ground axes, and the largest distance of the
// blades' undeformed tips from that axis.
typedef struct bough_rotor_place {
    bough_vec3 hub, axis;
    double radius; // [m]
} bough_rotor_place;
bough_rotor_place bough_simulation_rotor(const bough_simulation *s);

// Angle of a blade's span about the rotor's axis from the upright, or from the ground's x where that axis is
// upright [rad].
double bough_simulation_azimuth(const bough_simulation *s, const bough_beam *blade);

// Angle and speed of the hub about the shaft: sums over the joints about the rotor's axis between the body
// that carries the rotor and the blades [rad], [rad/s].
void bough_simulation_hub_turn(const bough_simulation *s, double *angle, double *speed);

// The name of the body, or of the group of bodies, to which row `row` of the assembly's states belongs.
const char *bough_simulation_body_of(const bough_simulation *s, int row);

// The pitch of a blade: its body's, and what its pitch joint adds, positive by −z [rad].
double bough_simulation_pitch(const bough_simulation *s, const bough_beam *beam);

// The largest rotation over a segment [rad], and the segment.
typedef struct bough_sharpest {
    double angle;
    int segment;
} bough_sharpest;

// The largest rotation between the ends of a segment of a rod, less that of the undeformed rod.
bough_sharpest bough_simulation_bend(const bough_simulation *s, const bough_beam *beam);

// Computes the accelerations of the tree's links under the rods' present forces into s->view, valid until
// bough_simulation_update; false as bough_tree_forward_dynamics.
bool bough_simulation_accelerate(const bough_simulation *s, double t);

// The wrench of a rod on its carrier, in the body's axes at its origin, and behind it that of its end on the
// bodies that it carries, force in the body's axes and moment in the section's [N, N m]. For a rigid body the
// wrench on its carrier, zero where other bodies, elements or loads act on it. Weight and inertia of the end
// vertices, which the tree carries, are included. Reads the accelerations of bough_simulation_accelerate.
void bough_simulation_root(const bough_simulation *s, const bough_beam *beam, double t,
                           double root[BOUGH_ROD_MOST_OUTPUTS]);

// Motion of a vertex of a beam; `rotation` has the axes of its section.
typedef struct bough_vertex_motion {
    bough_vec3 position, velocity, angular;
    bough_mat3 rotation;
} bough_vertex_motion;

// The largest number of vertices of a beam; 1 without beams.
size_t bough_simulation_most_vertices(const bough_simulation *s);

// theory (13): motion of all vertices of a beam (n_segment + 1) in ground axes, by `view` and the rod's
// state.
void bough_simulation_beam_motion(const bough_simulation *s, const bough_beam *beam,
                                  bough_vertex_motion *vertex);

// The same in the body's axes, as rows of n_segment + 1 numbers like those of a blade's motion: see rotor.h.
void bough_simulation_beam_rows(const bough_simulation *s, const bough_beam *beam, double *rows);

// -- building (build.c) ---------------------------------------------------------------------------

// Number of threads of the scene, or else of the environment.
int bough_simulation_threads(const bough_scene *scene);

// Builds the parts that the scene names, and no others, in the arena.
bough_status bough_simulation_build(bough_arena *arena, const bough_scene *scene,
                                    bough_simulation **simulation);

// The same on the threads of a pool (NULL: one thread), which several simulations may share, and with the
// meshes of `beside` for equal rods; NULL, or a simulation that outlives it.
bough_status bough_simulation_build_on(bough_arena *arena, const bough_scene *scene, bough_pool *pool,
                                       const bough_simulation *beside, bough_simulation **simulation);
