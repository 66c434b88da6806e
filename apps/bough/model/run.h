// One run of a scene: its model, its channels, its steps, the recording of results, and the copy from which
// it can continue. The command line, the library and the studies use this run.
#pragma once

#include "apps/bough/model/companion.h"
#include "apps/bough/results/progress.h"

enum { BOUGH_RUN_RECORDS = 4 };

// A record of the run at the multiples of an interval: at the first synchronisation point at or after each.
typedef struct bough_run_record {
    double interval;                              // [s]
    bool at_end;                                  // also where the run ends
    bough_status (*sample)(void *self, double t); // the simulation's `view` is at t
    void *self;
    long next;   // multiple of the interval that is due next
    double last; // time of the last sample [s]
} bough_run_record;

typedef struct bough_run {
    bough_simulation *simulation;
    bough_pool *pool;  // NULL: one thread
    bool side_by_side; // the companion's steps are a second task beside the run's, which then have one thread
    bough_channels channels;
    double *value;              // (channels.count) see bough_run_values
    bool sampled;               // `value` belongs to the present time
    bough_companion *companion; // estimates the errors of the channels
    int n_record;
    bough_run_record record[BOUGH_RUN_RECORDS];
    bough_statistics *earlier;  // (n_member + 1) work of the processes that this one continues, last
                                // that of the integrator of all members as one system
    double wall_from, cpu_from; // clocks up to which the times below are counted [s]
    double wall_s, cpu_s;       // of the stepping: wall time, CPU time of all threads [s]
    double until;               // time at which the present steps end [s]; 0: after one step
    bough_status outcome;       // how the last step ended

    // by the caller, before the first step
    bool beside;         // other runs are simultaneous: CPU time of the calling thread only
    bool (*stop)(void);  // asked before each step; NULL: the run is never stopped
    bool steps_together; // `stop` and `after` may wait for steps of the companion, and no copy is
                         // made between steps
    bough_status (*after)(void *self); // called after each step; NULL: nothing is
    void *self;                        // for `after`
    bough_progress *progress;          // the terminal's line; NULL: none
} bough_run;

// Builds the scene's model and its channels in the arena; the run is then at time 0.
bough_status bough_run_create(bough_arena *arena, const bough_scene *scene, bough_run *run);

// Adds a record: `sample` is called at the present and all later multiples of the interval.
void bough_run_record_at(bough_run *run, bough_run_record record);

// Records the results of the present time, the start.
bough_status bough_run_start(bough_run *run);

// One macro step, with that of the companion if one is due, the comparison and the records. After a failure
// the state is invalid, and the run can continue only from a copy.
bough_status bough_run_step(bough_run *run);

// Whether the duration is reached.
bool bough_run_done(const bough_run *run);

// Start, all steps and the last record, in one parallel region: sets `outcome`. BOUGH_INTERRUPTED when
// stopped: the run can continue.
void bough_run_all(bough_run *run);

// The channels at the present time (channels.count), computed once; NULL after a failure.
const double *bough_run_values(bough_run *run);

// Updates wall_s and cpu_s, within bough_run_all.
void bough_run_update_clock(bough_run *run);

// Work of a member over the whole run; member n_member: of the integrator of all members as one system.
bough_statistics bough_run_statistics(const bough_run *run, int member);

// The memory of the run at a time when its loads are sampled: simulation, error estimates, times of the next
// results, work so far. After a restore, a failed run continues, too.
void bough_run_snapshot(bough_run *run, bough_snapshot *snapshot);

// Whether the scene can be stored at all, and whether it can be stored now: BOUGH_INVALID gives the reason.
bough_status bough_run_storable(const bough_run *run);
