// Limits of the models' validity: a run reports each limit once, when it first exceeds it.
#pragma once

#include "apps/bough/model/simulation.h"

typedef enum bough_limit {
    BOUGH_LIMIT_ATTACK,      // the angle of attack lies where the polar's table has no rows
    BOUGH_LIMIT_MACH,        // the inflow at a section is half the speed of sound
    BOUGH_LIMIT_ROTOR_SPEED, // the rotor turns twice as fast as the control law's rated speed
    BOUGH_LIMIT_TOWER,       // a blade is inside the tower
    BOUGH_LIMIT_SAMPLES,     // the air is sampled too rarely for the vibrations of a modal blade
    BOUGH_LIMIT_TURN,        // a rod's segment turns its ends against each other by more than 45°
    BOUGH_LIMIT_SHAPES,      // a modal body, or a piece of one, bends by more than a tenth of its length
    BOUGH_LIMIT_SPACING,     // the blades are not evenly spaced about the rotor's axis
    BOUGH_LIMIT_ACROSS,      // the rotor's axis is across the wind, or faces away from it
    BOUGH_LIMIT_HUB,         // aero.hub_radius is not where the blades begin
    BOUGH_LIMIT_GROUND,      // the rotor reaches below the ground of a wind that has one
    BOUGH_LIMIT_PLACE,       // the rotor stands beside the tower that disturbs its wind
    BOUGH_LIMIT_MESH,        // a rod has one segment
    BOUGH_LIMIT_SINGULAR,    // a closed loop is near a singular position
    BOUGH_LIMIT_WIND,        // the wind changes and returns between two samples of the air
    BOUGH_LIMIT_ROTATION,    // the rotor turns by a sixth of a rotation between two samples of the air
    BOUGH_LIMIT_START,       // the equilibrium from which the run starts is unstable
    BOUGH_LIMIT_STEPS,       // short steps of a solver take most of the time
    BOUGH_LIMIT_FAST,        // vibrations are too fast for the run and for the finer solution beside it
    BOUGH_LIMIT_BUSHING,     // a bushing is turned so far that its rotation vector soon changes its sign
    BOUGH_LIMIT_SPRING,      // the ends of a spring meet, so that its force has no direction
    BOUGH_LIMITS,
} bough_limit;

// Plain data, a part of the simulation's snapshot.
typedef struct bough_passing {
    bool passed;
    int body;     // of the scene
    double time;  // [s]
    double value; // in the limit's unit
} bough_passing;

typedef struct bough_validity {
    bough_passing limit[BOUGH_LIMITS];
    double looked; // time of the last sample of the air that was checked [s]
    double margin; // largest of the closed loops so far, see bough_loops_margin
    double steps;  // of all solvers at the last check
    double work;   // steps times states of the macro steps of very many steps so far
} bough_validity;

// Checks the model at the start, with `view` up to date.
void bough_validity_start(bough_simulation *s);

// Checks the equilibrium from which a run starts, where its scene asks for one.
void bough_validity_check_equilibrium(bough_simulation *s);

// Checks the state after a step, without changing a result.
void bough_validity_check(bough_simulation *s);

// BOUGH_FAILED where a closed loop is open.
bough_status bough_validity_check_closed(bough_simulation *s);

// Counts macro steps with very many steps of solvers.
void bough_validity_check_work(bough_simulation *s);

// The finer solution beside the run needs too much work and ends.
void bough_validity_pass_fast(bough_simulation *s);

// The name of a limit in summary.json, and the sentence about its passing, at most `size` bytes.
const char *bough_limit_name(bough_limit limit);
void bough_validity_describe(const bough_simulation *s, bough_limit limit, char *text, size_t size);

// The sentences about all limits that are passed, as many as `size` bytes hold.
void bough_validity_list(const bough_simulation *s, char *text, size_t size);

// Writes a line for each limit that is passed.
void bough_validity_print(const bough_simulation *s, FILE *stream);
