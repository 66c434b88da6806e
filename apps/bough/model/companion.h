// The companion of a run: a second simulation of the same scene, coarser in mesh, air and time. The
// difference of the two at equal times measures the error of the run by mesh, air, time and coupling
// together, for every channel. During the first macro steps, and after a jump of a load or a prescribed
// motion, a third simulation, finer in time and air, resolves vibrations that decay in both.
//
// If the error falls with order p, a solution with twice the step errs by 2ᵖ times as much, and the run by
// 1/(2ᵖ − 1) of the difference: a third for order 2 (docs/theory.md).
#pragma once

#include "apps/bough/model/simulation.h"

// -- the coarser scene (coarser.c) ----------------------------------------------------------------

// A copy of a scene that is coarser by about a factor of two: for the companion of a run (companion.h).

// In what the copy is coarser or finer: a set of these.
enum {
    // Half the segments of each rod, seven tenths where the whole difference is the error, or more where it
    // has few.
    BOUGH_COARSER_MESH = 1,
    BOUGH_COARSER_AIR = 2, // half the aerodynamic sampling rate
    // Twice the macro step and the longest step, ten times the tolerance (twelve beside a finer mesh; 1.5 and
    // 3 times beside an explicit coupling; of rigid bodies four times the macro step, thirty times a
    // tight tolerance); all bodies as one system, without the error of a coupling.
    BOUGH_COARSER_TIME = 4,
    BOUGH_COARSER_ALL = 7,
    // Not coarser but finer in time: one system, a tenth of the tolerance and half the longest step.
    BOUGH_FINER_TIME = 8,
    BOUGH_FINEST_TIME = 16, // the same with a hundredth of the tolerance, not below 1e-6
    // Twice the aerodynamic sampling rate, in macro steps of half the length where it needs them. Not for a
    // scene with inputs.
    BOUGH_FINER_AIR = 32,
};

// In the arena; it shares with the scene what no run changes. It has no companion of its own.
bough_scene *bough_coarser_scene(bough_arena *arena, const bough_scene *scene, int parts);

// The same for the scene of a simulation, whose turbulence it shares.
bough_scene *bough_coarser_scene_beside(bough_arena *arena, const bough_simulation *run, int parts);

// The error of the scene's solution relative to its difference to that of such a copy: a quarter, between an
// order of 2 and of 3; half with a coupling, whose error the copy does not have; more if meshes differ by
// less than a factor of two; 1 if the mesh is finer or the coupling explicit.
double bough_coarser_ratio(const bough_scene *scene, const bough_scene *other);

// The same for the part of the air: loads held constant, an error of order 1, err by twice the difference to
// a copy of twice the rate.
double bough_coarser_air_ratio(const bough_scene *scene, const bough_scene *other);

// Whether only the integrator's steps err, at a tight tolerance: rigid bodies as one system, without air and
// controller.
bool bough_coarser_steps_alone(const bough_scene *scene);

// The same for a copy that is coarser in time alone.
double bough_coarser_time_ratio(const bough_scene *scene);

// Relative tolerance of the whole's integrator, the loosest of the sub-solvers beside another coupling.
double bough_scene_loosest_rtol(const bough_scene *scene);

// Whether the rods have more states than the dense matrices of master.solver allow, as those of a finer mesh
// or of all bodies as one system may.
bool bough_coarser_is_too_large(const bough_scene *scene);

// Whether the tolerance is so loose that the coarser copy has a tighter one.
bool bough_coarser_is_loose(const bough_scene *scene);

// The same for a copy that is finer in time, and in air.
double bough_finer_time_ratio(void);
double bough_finer_air_ratio(const bough_scene *scene);

// Another simulation of a run's scene, with the run's channels.
typedef struct bough_other_run {
    bough_simulation *simulation; // NULL: there is none
    bough_channels channels;
    double *value; // (channels.count) as sampled last
} bough_other_run;

// Builds one that is coarser in these parts, with the pool of the run.
bough_status bough_other_run_build(bough_arena *arena, const bough_simulation *run, int parts,
                                   bough_other_run *other);

// Work so far: the CPU time that the evaluations and factorisations of all members take on a processor of
// 2023, by their number and size [µs]. The same on every machine.
double bough_simulation_work(const bough_simulation *s);

// The same for a step of the Rosenbrock method, without tangents.
double bough_other_run_work_of_step(const bough_other_run *other);

// Limits the steps of the Rosenbrock method in each macro step; one for which more are foreseen fails.
void bough_other_run_limit(bough_other_run *other, int most_steps);

void bough_other_run_sample(bough_other_run *other);

// A macro step of its own, with the inputs of the run.
bough_status bough_other_run_step(bough_other_run *other, const bough_simulation *run);

// -- loads and motions that jump (jump_times.c) ----------------------------------------------------

// Number of changes of loads and prescribed motions by more than a fraction `part` of their range within less
// than a macro step, except at the start. time: when they have changed, ascending [s]; NULL: not wanted.
int bough_jump_times(const bough_scene *scene, double part, double *time);

// -- the finer solution (finer.c) -----------------------------------------------------------------

// A solution that is finer in time and air. It runs beside the first macro steps, and beside those after a
// jump, until the excited vibrations have decayed in the run; without air, while an error grows.
typedef struct bough_finer {
    bough_other_run other; // its simulation is NULL where the scene has none
    bool follows;          // it runs beside the run
    double from, until;    // from and up to these times [s]
    double left;           // when it would have taken too much work to go on [s]; 0: it has not
    double ratio;          // error of the run over the difference
    double work;           // so far (bough_simulation_work)
    long run_steps;        // of the run's solvers so far
    int n_jump;
    double *jump;        // (n_jump) of the jumps, in order [s]
    char *loads;         // memory of the run's loads while they are copied
    bough_status status; // of its last step
} bough_finer;

bough_status bough_finer_build(bough_arena *arena, bough_simulation *run, bough_finer *f);

// Advances to the time of the run and samples there. False: it does not follow the run, or cannot continue.
// `work`: of run and companion so far, which limits its own. Where it gives up, the run passes
// BOUGH_LIMIT_FAST.
bool bough_finer_advance(bough_finer *f, bough_simulation *run, double work);

// It runs beside some more macro steps.
void bough_finer_go_on(bough_finer *f, const bough_master *run);

// Sets it to the state of the run if there is a jump within `reach` [s].
void bough_finer_begin(bough_finer *f, bough_simulation *run, double reach, double work);

void bough_finer_snapshot(bough_finer *f, bough_snapshot *snapshot);

// -- the record -----------------------------------------------------------------------------------

// Run and companion at the times of their comparisons, for further runs that find the cause of an error. If
// there are more times than rows, neighbouring times share a row, that of the largest error.
typedef struct bough_record {
    int n;              // rows so far
    int width;          // of a row
    long shared, taken; // times in each row; in the last one so far
    double *row; // (BOUGH_RECORD_MOST × width) time [s], largest error of a motion over its range, whether
                 // the companion's samples are held [1], channels of the run, of the companion; NULL:
                 // none is kept
} bough_record;

enum { BOUGH_RECORD_MOST = 512 };
enum { BOUGH_RECORD_TIME, BOUGH_RECORD_ERROR, BOUGH_RECORD_HELD, BOUGH_RECORD_RUN };

// -- the companion --------------------------------------------------------------------------------

// Counts of a run.
typedef struct bough_run_counts {
    long macro_steps;
    long corners;  // of loads and motions; only the first within a macro step
    long advances; // of members through a macro step, with repetitions
    long steps;    // of the integrator that takes fewest
} bough_run_counts;

enum { BOUGH_COMPANION_ROWS = 16 };

// The companion at one of its synchronisation points.
typedef struct bough_companion_row {
    double time;       // [s]
    bool sampled;      // its loads are sampled
    bool air_sampled;  // the air among them
    double missed_air; // largest error of the air's loads between two samples [1]
    double work;       // so far (bough_simulation_work)
    double *value;     // (channels->count); sampled from simulation.output.from on
} bough_companion_row;

typedef struct bough_companion {
    bough_simulation *run;
    bough_other_run coarser;
    bough_finer finer;
    bough_record record;
    const bough_channels *channels; // of the run
    double ratio;                   // error of the run over the difference: 1/Q of theory (71)
    double ratio_held;              // the same for a channel of which the companion holds an older sample
    char reason[BOUGH_MESSAGE];     // why errors are not or no longer known; "": they are known
    double from;                    // time from which they are not known [s]
    double motion;                  // largest range of all motion, or value up to 1, in SI units
    double rest;                    // motion of a scene at rest; 0: it moves
    double arm;                     // length of the longest rod [m]; 0: there is none
    double force, moment;           // less is rounding [N, N m]
    long compared;                  // times
    bough_run_counts counted;       // of the run, from where steps and corners are counted
    long corners;                   // so far
    double corner;                  // the last of them [s]
    int jump;                       // row from which the wind jumps next; −1: never
    double earlier;                 // work of both before a copy was restored
    double *value;                  // (channels->count) of the run at the last of them
    double *before;                 // (channels->count) of the run at the comparison before
    double *error;                  // (channels->count) largest so far, in the channels' units
    double *shown;                  // (channels->count) the companion's, up to the end of the finer solution
    double *least;                  // (channels->count) beside the finer solution
    double *grown;                  // (channels->count) when that grew last [s]
    double *low, *high;             // (channels->count) range of the run
    double *other_low, *other_high; // (channels->count) of the companion
    double *noticed;                // (channels->count) when the error first passed the accuracy [s]
    bool flutters;                  // its blades flutter, those of the run do not
    bough_status status;            // of its last step

    int n_row, present; // rows of the last bough_companion_step; that of the run's time, or the next one
    bough_companion_row row[BOUGH_COMPANION_ROWS];
} bough_companion;

// Builds the companion of the run's scene, with the run's pool, at time 0. Sets `reason` if it cannot be
// built.
bough_status bough_companion_create(bough_arena *arena, bough_simulation *run, const bough_channels *channels,
                                    bough_companion *companion);

// Work of run and companion since time 0 (bough_simulation_work).
double bough_companion_work(const bough_companion *c);

// Whether it is not ahead of the run and can go on, so that its next step is due.
bool bough_companion_due(const bough_companion *c);

// A macro step of its own, as long as two of the run's, or two steps in one of the run's; `ahead`: up to
// BOUGH_COMPANION_ROWS at once, where nothing of the run affects them. A run and its companion that take
// turns at every step evict each other's data from the processor's caches. It does not change the run.
void bough_companion_step(bough_companion *c, bool ahead);

// After a step of the run: compares the two if they are at one time; the run's channels are then known
// (bough_channels_know). Changes no result.
void bough_companion_compare(bough_companion *c);

// Whether `value` and `coarser.value` are of the present time of the run, at which the companion's loads are
// sampled.
bool bough_companion_compares(const bough_companion *c);

// Whether the channel's error is known.
bool bough_companion_knows(const bough_companion *c, int channel);

// Whether the air of a run, or of another beside it, is sampled at its time; true without air.
bool bough_companion_air_sampled(const bough_simulation *s);

// Whether the companion can be stored now, when it may be a step ahead of the run: its loads are sampled, as
// a copy needs.
bool bough_companion_storable(const bough_companion *c);

// Its steps end, as those of the run, once stop() is true; see bough_master_stop_by. The run has to end, too
// (bough_companion_stopped): what follows would have no errors.
void bough_companion_stop_by(bough_companion *c, bool (*stop)(void));
bool bough_companion_stopped(const bough_companion *c);

// What the companion remembers, when it can be stored.
void bough_companion_snapshot(bough_companion *c, bough_snapshot *snapshot);
