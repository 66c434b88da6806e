// Static equilibrium of the whole scene: tree, rods and springs together, under gravity, the loads
// at one time and the air's forces, which are sampled anew where the bodies come to rest.
//
// A joint of prescribed motion has its position at that time; one with an initial speed keeps coordinate and
// speed. The bodies on them rotate steadily at their present azimuth, and gravity keeps its direction in the
// rotating frame (frozen azimuth). All other joints come to rest.
#pragma once

#include "apps/bough/model/simulation.h"
#include "cosim/analysis/path.h"

typedef struct bough_equilibrium_work {
    int steps;   // of the solution, all samples of the air together
    int samples; // of the air; 0 without aerodynamics
} bough_equilibrium_work;

// Rows of the tree's states that are held (n_q + n_v at most): of joints of prescribed motion and,
// with `turning`, of those with an initial speed. Returns their number.
int bough_equilibrium_held(const bough_tree *tree, bool turning, int *row);

// Whether the rods are independent: each is held by the ground, without air. Then each has its own
// equilibrium and modes.
bool bough_rods_are_independent(const bough_simulation *s);

// The time after which no load grows any more [s].
double bough_equilibrium_time(const bough_simulation *s);

// How an equilibrium is searched for: a set of these.
enum {
    BOUGH_EQUILIBRIUM_NEAR = 1,     // the present state is near it: long steps from there are tried first
    BOUGH_EQUILIBRIUM_UNSTABLE = 2, // an unstable one is accepted where no stable one is found
    BOUGH_EQUILIBRIUM_ALONE = 4,    // a failure is not explained by searches on finer meshes
    // all three: on a finer mesh, from the shape of a coarser one (bough_simulation_take_shape)
    BOUGH_EQUILIBRIUM_FINER = 7,
};

// Brings the members of the simulation to equilibrium under the loads at `time`;
// their clocks are set to it. `work`: NULL: not wanted. BOUGH_FAILED names the body that finds none.
bough_status bough_simulation_equilibrium(bough_simulation *s, double time, int how,
                                          bough_equilibrium_work *work);

// Growth of motions from an equilibrium by the tangents, with constant forces of the air. If something
// rotates, the tangents of one azimuth do not determine oscillations: their growth is not given.
typedef struct bough_growth {
    double rate;        // the largest of a motion that does not oscillate [1/s]; 0: none grows
    double oscillation; // the largest of an oscillation, such as flutter [1/s]; 0: none grows
    double frequency;   // of that one [Hz]
    int row; // the state with the largest amplitude in the fastest growing motion, relative to its scale
    // Excluded: twist of a bent rod that grows because its segments are too long for its torsional stiffness.
    // The rod, NULL: none, and the number of segments with which it would not grow.
    const char *twisting;
    int segments;
} bough_growth;

// About the present states; `slow`: only by the twelve eigenvalues nearest to 1 over the
// scene's time, at an eighth of the cost.
bough_status bough_simulation_growth(bough_simulation *s, double time, bool slow, bough_growth *growth);

// Called at each point of a path, with members, inputs and the simulation's view there. `time`: when the
// loads are those of the point [s]; `factor`: of the full loads; `limit`: it has a local maximum or minimum
// there. A failure ends the path.
typedef struct bough_path_listener {
    void *self;
    bough_status (*point)(void *self, double time, double factor, bool limit);
} bough_path_listener;

// BOUGH_INVALID for scenes without a path of equilibria: with air, prescribed motions, jumps of loads, or
// loads that do not grow.
bough_status bough_equilibrium_check_path(const bough_simulation *s);

// Follows the equilibria of the members as the loads grow from those at time 0 to those at
// bough_equilibrium_time, in proportion, through limit points (cosim/analysis/path.h). BOUGH_INVALID by
// bough_equilibrium_check_path, BOUGH_FAILED when the path ends before.
bough_status bough_simulation_path(bough_simulation *s, bough_path_listener listener,
                                   bough_path_report *report);

// Brings `to`, a simulation of the same scene with other meshes, to rest in the shape of `from`: rods
// linearly between vertices, joints as they are.
void bough_simulation_take_shape(const bough_simulation *from, bough_simulation *to);

// Sets the states of all members (n_state), with prescribed motions as they are at `time`; `view` follows.
void bough_equilibrium_set_state(bough_simulation *s, double time, const double *state);
