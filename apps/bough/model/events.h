// Events in the turbine's operation: start, stop, loss of the grid, faults of pitch and yaw, at given
// times or when a channel passes a threshold. They change what the controller demands.
#ifndef BOUGH_APPS_SIMULATION_EVENTS_H
#define BOUGH_APPS_SIMULATION_EVENTS_H

#include "aero/control/discon.h"
#include "apps/bough/model/simulation.h"

enum { BOUGH_MOST_EVENTS = 8 };

// Doubles only, saved and restored with the controller's memory.
typedef struct bough_event_state {
    double happened; // 0: not yet
    double since;    // [s]
    double torque;   // of the generator then [N m]
    double speed;    // of the generator then [rad/s]
    double angle;    // of the blade's pitch or the yaw joint then [rad]
    double running;  // after a start: whether the law's own torque holds
} bough_event_state;

typedef struct bough_events bough_events;

// The events of the scene's control block; NULL without. Called when all else is built.
bough_status bough_events_build(bough_arena *arena, bough_simulation *simulation, bough_events **events);

// Whether the turbine idles at t because its start is yet to come.
bool bough_events_idle(const bough_events *events, const bough_event_state *state);

// Marks the events that have happened up to the time of `sensed`.
void bough_events_look(bough_events *events, const bough_discon_sensed *sensed, bough_event_state *state);

// Changes the controller's demand for the next step by the events that have happened.
void bough_events_change(const bough_events *events, const bough_discon_sensed *sensed,
                         bough_event_state *state, bough_discon_demand *demand);

#endif
