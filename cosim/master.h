// The macro loop. Macro times are T_k = k·H, by multiplication; a step is split where an event time
// falls inside it, and the last one ends exactly on the duration. A run that is compared with one of half its
// macro step takes some steps in halves: what happens only within macro steps would never be compared, and a
// vibration with a period of two macro steps at one phase only.
#pragma once

#include "cosim/analysis/stability.h"
#include "cosim/scheme.h"
#include "cosim/step_control.h"
#include "cosim/watch/monitor.h"

// Loads with a sampling rate of their own: sample() is called at multiples of the period, between steps,
// and sets the loads inside the members for [t, t_next]. It may be NULL if there is only begin().
typedef struct bough_sampled_load {
    double period; // [s] an integer multiple of the macro step
    void *self;
    // *jumped is true on return when the loads are discontinuous at t.
    bough_status (*sample)(void *self, double t, double t_next, bool *jumped);
    // Called as soon as t, the time of the next sample, is reached: evaluates the values of that sample
    // for the results at that time, without setting loads. NULL: there are none.
    void (*evaluate)(void *self, double t);
    // Called before every macro step, which begins at t; NULL: nothing to do. Loads that jump at an event
    // take the value after the jump here.
    void (*begin)(void *self, double t);
    // What the next samples depend on; restoring gives the members their loads back. NULL: nothing. The
    // master's own snapshot does not contain it.
    void (*snapshot)(void *self, bough_snapshot *snapshot);
} bough_sampled_load;

typedef struct bough_master_def {
    bough_assembly_def assembly;
    bough_scheme_options scheme;
    double macro_step; // H, the longest [s]
    // Some macro steps are taken in halves, for a system that is integrated as one: of the first 64 four of
    // every eight, or all where its integrator takes several steps in each; later four of every 32; those
    // after events; and those for which `halve` is set.
    bool halves;
    bough_step_control_def control; // shorter ones by error; tolerance 0: none
    double duration;                // [s]; the run starts at time 0
    int n_load;
    const bough_sampled_load *load; // (n_load), copied
    int n_event;
    const double *event; // (n_event) times where loads have corners [s], any order, copied
    bough_pool *pool;    // borrowed; NULL: one thread
} bough_master_def;

// The default scheme, one thread, no loads, no events; assembly, macro_step and duration are the caller's.
bough_master_def bough_master_def_default(void);

typedef struct bough_master {
    // constant once built
    double macro_step, duration; // [s]
    bool halves;                 // see the def
    bough_assembly *assembly;
    int n_load, n_event;
    bough_sampled_load *load; // (n_load)
    long *load_every;         // (n_load) macro steps per period
    double *event;            // (n_event) ascending, each once [s]

    // about the initial state, by building
    bough_stability_advice advice; // empty when not judged
    char verdict[BOUGH_VERDICT];   // a warning that the coupling is unstable; may be empty

    // by the caller
    bool compared; // another solution shows the error, so that growth of forces is not judged and steps that
                   // have not converged go on
    bool split;    // what lies between two events or points of the grid is taken in two steps
    bool halve;    // the next macro step is taken in halves, where some are
    bool (*stop)(void); // NULL: never

    // by each step
    bough_coupling *coupling;
    bough_monitor *monitor;
    bough_step_control *control; // NULL: fixed steps
    double time;                 // the current synchronisation point [s]
    long steps;                  // macro steps taken
    long grid_index;             // k of the last grid point at or before `time`
    int next_event;              // first event after `time`
    bool at_event;               // `time` is an event
    double begun;                // start of the last macro step [s]
    bool many_steps;             // integrators took several steps in it; known where halves are taken
} bough_master;

// Whether a period is an integer multiple of the macro step within 1e-9: the multiple, 0 if not.
long bough_master_multiple(double period, double macro_step);

// Builds everything in the arena; stepping allocates nothing. The stability of a coupling is analysed
// about the initial state. The result is only a warning, because external loads may add damping.
bough_status bough_master_build(bough_arena *arena, const bough_master_def *def, bough_master **master);

// One macro step: samples loads, advances the members, exchanges values, checks the result. A caller that
// takes many steps should do so within one bough_pool_region; otherwise each step opens its own.
bough_status bough_step(bough_master *m);

// Steps ask stop() at each evaluation and, once it is true, end with BOUGH_INTERRUPTED and with time and
// states of the start of the macro step in progress. They must not go on then. NULL: never.
void bough_master_stop_by(bough_master *m, bool (*stop)(void));

// Work of all members' integrators since they were built.
bough_statistics bough_master_statistics(const bough_master *m);

// The memory that later steps and the reports depend on, without that of the loads, at a time when all
// loads are sampled. After a restore, integrators restart and Newton matrices are computed again. A run
// that restores the copy it has just saved continues bit for bit like another process that restores it.
void bough_master_snapshot(bough_master *m, bough_snapshot *s);

// Puts it where another master of the same bodies is: its time, between two of its steps, and the states of
// all members, whose integrators restart. Loads are not touched.
void bough_master_join(bough_master *m, const bough_master *other);

// Whether all loads are sampled at `time`, which a snapshot requires.
bool bough_master_sampled(const bough_master *m);

// The next synchronisation point without step control: grid point, event or the end, whichever comes first
// [s].
double bough_master_next(const bough_master *m);

// Whether the duration is reached.
bool bough_master_done(const bough_master *m);
