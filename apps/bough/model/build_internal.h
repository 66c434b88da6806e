// What the files that build a simulation share among themselves.
#pragma once

#include "apps/bough/model/equilibrium.h"
#include "apps/bough/model/simulation.h"
#include "apps/bough/scene/scene.h"
#include "core/tree/tree.h"
#include "cosim/member.h"

// -- loads on rods, lumped to their vertices (load_link.c) ----------------------------------------

// Needs the rods and the view of a built simulation.
void bough_load_link_build(bough_arena *arena, bough_simulation *s);

// Where a load on a rod acts.
bough_rod_reach bough_load_reach(const bough_scene_load *load, const bough_rod_model *m);

// -- parts that are sampled, as far as the scene has them ------------------------------------------

// Each adds itself to the simulation's sampled loads.

// Inputs, which another program sets between steps (input_link.c): a value holds from the next macro step on;
// a joint with a prescribed motion reaches it at the end of that step. Before all other loads.
void bough_input_link_build(bough_arena *arena, bough_simulation *s);

// Loads that jump at a time: ramps without length. The step that ends at the jump is integrated without the
// load, the step that begins there with it; a function of time alone could not distinguish the two
// (load_link.c). Needs tree and rods.
void bough_jump_link_build(bough_arena *arena, bough_simulation *s);

// -- an FMU as a member (fmu_member.c) ------------------------------------------------------------

// An FMU as a member: it advances by its own steps between communication points under the motion of a body's
// frame and returns the wrench on the carrier. Its equations are not known, so that the system has outputs
// only: those of the last communication point.

// Loads the FMU's library and makes an instance, which the arena releases, at time 0 under `motion`
// (BOUGH_SCENE_MOTION); `duration` [s] is that of the run. BOUGH_INVALID: the library is missing or lacks a
// function of the standard. BOUGH_FAILED: the FMU reports an error; the message is its own. The member must
// not be moved.
bough_status bough_fmu_member_create(bough_arena *arena, const bough_scene_body *body, const double *motion,
                                     double duration, bough_member *member);

// -- the steady operation of a turbine as the start of a run (trim.c) -----------------------------

// Starts a run in the steady operation of a turbine in the wind at time 0, where the torque of the air equals
// that of the generator under the control law. Below rated power the pitch is the smallest of the law and the
// speed is found; otherwise the speed is that of the pitch controller and the pitch is found. The bodies are
// in equilibrium there (equilibrium.h).

// Needs a control law. BOUGH_FAILED if there is no steady operation.
bough_status bough_simulation_trim(bough_arena *arena, bough_simulation *s);

// -- the builder ----------------------------------------------------------------------------------

// Data of a simulation while it is built; arrays are in the arena.
typedef struct bough_builder {
    bough_arena *arena;
    const bough_scene *scene;
    bough_simulation *s;
    const bough_simulation *beside; // whose meshes are used for equal rods; NULL: none
    bough_tree_def tree;            // its arrays are `body` to `load`
    bough_body_def *body;           // (n_body + n_end): those of the scene, then the ends of rods
                                    // that carry bodies
    bough_end_def *end;             // (n_end)
    bough_marker_def *marker;       // (tree.n_markers), those of the beams first, then of the FMUs
    bough_port_def *port;           // (n_rod + n_fmu)
    bough_joint_load_def *load;     // (tree.n_loads): those on joints
    bough_assembly_member *member;  // leader, then rods
    bough_connection *connection;   // two per rod, two more of one that carries bodies
    int n_connection;
    double *event; // (n_event) corners of loads and of the aerodynamics
    int n_event, event_room;
} bough_builder;

// The beams' meshes, and the bodies of the tree.
bough_status bough_build_bodies(bough_builder *b);

// Builds the flexible body of a beam, a rod or a modal body, in a frame that moves with `input` (9)
// at the start.
bough_status bough_build_beam(bough_arena *arena, bough_beam *beam, const double *input,
                              bough_system *system);

// The index of a new marker of the tree.
int bough_build_marker(bough_builder *b, const char *name, int body, bough_transform placement);

// -- springs, bushings, closures, applied wrenches and recorded points (load_link.c) --------------

// Adds all of the scene, after the markers of beams and FMUs. The last marker is that of the hub's drag, if
// there is one.
void bough_build_forces(bough_builder *b);

// Places the second markers of the bushings so that the bushings are free of force in the simulation's view.
void bough_build_rest(const bough_simulation *s);

// -- channels that observe.c takes from observe_loads.c -------------------------------------------

// Writes a vector in this unit and returns the place after it.
static inline double *bough_observe_vector(bough_vec3 x, double unit, double *value) {
    value[0] = x.x / unit, value[1] = x.y / unit, value[2] = x.z / unit;
    return value + 3;
}

// Adds motion and section loads of rods at the places of the scene's sensors; torque and power of the hub on
// the drive train.
void bough_observe_sections(bough_simulation *s, bough_channels *list);
void bough_observe_shaft(bough_simulation *s, bough_channels *list);

// Samples speed and azimuth of the hub; the wrench of the nacelle on the tower's top. `self`: the simulation.
bough_channel_sample bough_observe_turn, bough_observe_yaw_bearing;
