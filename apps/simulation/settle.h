// Static equilibrium of the whole scene: tree, rods and springs together, under gravity, the loads
// at one time and the air's forces, which are sampled anew where the bodies come to rest.
//
// A joint of prescribed motion is where it is then; one with an initial speed keeps coordinate and
// speed. What they carry turns steadily, at the azimuth where it is (frozen azimuth: gravity does
// not go round). All other joints come to rest.
#ifndef BOUGH_APPS_SIMULATION_SETTLE_H
#define BOUGH_APPS_SIMULATION_SETTLE_H

#include "apps/simulation/build.h"

typedef struct bough_settling {
    int steps;   // of the solution, all samples of the air together
    int samples; // of the air; 0 without aerodynamics
} bough_settling;

// Rows of the tree's states that are held (n_q + n_v at most): of joints of prescribed motion and,
// with `turning`, of those with an initial speed. Returns their number.
int bough_settle_held(const bough_tree *tree, bool turning, int *row);

// Whether the rods do not know of each other: each is held by the ground, without air. Then each
// has its own equilibrium and modes.
bool bough_settle_apart(const bough_simulation *s);

// The time after which no load grows any more [s].
double bough_settle_loaded(const bough_simulation *s);

// Brings the members of the assembly, the simulation's, to equilibrium under the loads at `time`;
// their clocks stay at 0. BOUGH_FAILED names the body that does not settle.
bough_status bough_settle(bough_simulation *s, const bough_assembly *assembly, double time,
                          bough_settling *settling);

// States of all members (n_state) into a row.
void bough_settle_state(const bough_assembly *assembly, double *state);

#endif
