#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/companion.h"
#include "apps/bough/model/validity.h"

// How long the finer solution runs beside the run from the start, or from a jump on, and its most work.
typedef struct extent {
    int steps;     // macro steps; more where an error grows without air
    double part;   // most work over that of run and companion, extrapolated to the end
    double little; // work that is added to it [µs]; both hold for the start and for all jumps separately
} extent;

static extent extent_of(const bough_scene *scene) {
    return scene->aero.node ? (extent){8, 0.1, 2000} : (extent){4, 0.05, 1000};
}

// Steps in its first macro step that are never too much work.
static const double least_steps = 250;

// Least jump of a load or a prescribed motion, relative to its range, that may excite vibrations faster than
// the steps.
static const double least_jump = 0.1;

// Whether the run errs by a coupling or by fixed steps, whatever its tolerance.
static bool errs_at_any_tolerance(const bough_scene *scene) { return bough_coarser_ratio(scene, scene) == 1; }

// Whether it is needed: a tight tolerance resolves all vibrations, unless air is sampled. A controller's
// library is not loaded a third time: it would write to the companion's files.
static bool is_wanted(const bough_scene *scene) {
    static const double tight = 1e-5;
    double rtol = fmax(scene->simulation.master.rtol, bough_scene_loosest_rtol(scene));
    return (rtol >= tight || scene->aero.node || errs_at_any_tolerance(scene)) && !scene->control.library;
}

// Stores the memory of the sampled loads of a simulation.
static void snapshot_loads(const bough_simulation *s, bough_snapshot *to) {
    for (int k = 0; k < s->n_sampled; k++)
        if (s->sampled[k].snapshot) s->sampled[k].snapshot(s->sampled[k].self, to);
}

// When the wind, or the ramp of the air's loads, has jumped (bough_wind_jump); returns how often. time: NULL:
// not wanted.
static int air_jump_times(const bough_simulation *run, double *time) {
    if (!run->aero) return 0;
    const bough_wind *wind = bough_rotor_wind(bough_aero_link_rotor(run->aero));
    double period = 1 / run->scene->aero.rate;
    const double *ramp = run->scene->aero.ramp;
    int n = ramp[0] > 0 && ramp[1] - ramp[0] < period;
    if (n > 0 && time) time[0] = ramp[1];
    for (int k = bough_wind_jump(wind, period, 0); k >= 0; k = bough_wind_jump(wind, period, k + 1), n++)
        if (time) time[n] = bough_wind_row_time(wind, k + 1);
    return n;
}

// Times of all jumps.
static void expect_jumps(bough_arena *arena, const bough_simulation *run, bough_finer *f) {
    int loads = bough_jump_times(run->scene, least_jump, NULL);
    f->n_jump = loads + air_jump_times(run, NULL);
    f->jump = bough_arena_doubles(arena, (size_t)f->n_jump + 1);
    bough_jump_times(run->scene, least_jump, f->jump);
    air_jump_times(run, f->jump + loads);
    qsort(f->jump, (size_t)f->n_jump, sizeof *f->jump, bough_ascending);
}

bough_status bough_finer_build(bough_arena *arena, bough_simulation *run, bough_finer *f) {
    static const int parts = BOUGH_FINEST_TIME | BOUGH_FINER_AIR;
    bough_snapshot measure = {.move = BOUGH_SNAPSHOT_MEASURE};
    const bough_scene *scene = run->scene;
    if (!is_wanted(scene) || run->master->assembly->n_state == 0) return bough_ok(); // nothing moves
    BOUGH_TRY(bough_other_run_build(arena, run, parts, &f->other));
    f->follows = true;
    f->ratio = errs_at_any_tolerance(scene) ? 1 : bough_finer_time_ratio();
    f->until = (extent_of(scene).steps + 0.5) * scene->simulation.macro_step;
    expect_jumps(arena, run, f);
    snapshot_loads(run, &measure);
    f->loads = bough_arena_take(arena, measure.used + 1);
    return bough_ok();
}

// Sets the finer solution to the state of the run.
static void join(bough_finer *f, bough_simulation *run) {
    bough_master_join(f->other.simulation->master, run->master);
    snapshot_loads(run, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, f->loads, 0});
    snapshot_loads(f->other.simulation, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, f->loads, 0});
}

// The next jump after a time; HUGE_VAL: none.
static double next_jump(const bough_finer *f, double t) {
    int k = 0;
    while (k < f->n_jump && f->jump[k] <= t) k++;
    return k < f->n_jump ? f->jump[k] : HUGE_VAL;
}

// The work that it may still take; unlimited at time 0.
static double work_left(const bough_finer *f, const bough_master *run, double work) {
    double whole = run->time > 0 ? work * run->duration / run->time : HUGE_VAL;
    extent most = extent_of(f->other.simulation->scene);
    return most.part * whole + most.little - f->work;
}

// The steps that it may take in the next macro step: the first alone may need more work than all may.
static int most_steps(const bough_finer *f, const bough_master *run, double work) {
    const bough_simulation *own = f->other.simulation;
    int most = own->scene->simulation.master.most_steps;
    if (own->master->time > f->from) return most;
    double allowed = work_left(f, run, work) / bough_other_run_work_of_step(&f->other);
    return (int)fmin(most, fmax(least_steps, allowed));
}

// From a time at which both have new samples of the air, at most `reach` before the jump.
void bough_finer_begin(bough_finer *f, bough_simulation *run, double reach, double work) {
    const bough_master *m = run->master;
    double jump = f->other.simulation ? next_jump(f, m->time) : HUGE_VAL;
    if (jump > m->time + reach || !bough_master_sampled(m)) return;
    if (!f->follows && f->from == 0) f->work = 0;
    if (work_left(f, m, work) < 0) return;
    if (!f->follows) join(f, run), f->from = m->time, f->left = 0, f->run_steps = bough_simulation_steps(run);
    f->follows = true;
    f->until = jump + (extent_of(run->scene).steps + 0.5) * m->macro_step;
}

void bough_finer_go_on(bough_finer *f, const bough_master *run) {
    int more = extent_of(f->other.simulation->scene).steps;
    f->until = fmax(f->until, 2 * run->time - f->from + more * run->macro_step);
}

// Whether it has failed because it needs more steps than are allowed, and the run may pass over the same
// vibrations: the run takes less than a quarter of the steps that a finer solution has at most.
static bool gave_up(const bough_finer *f, int allowed, long steps, long by_run) {
    int most = f->other.simulation->scene->simulation.master.most_steps;
    return f->status.code == BOUGH_FAILED && steps >= allowed / 5 && 4 * by_run < most;
}

bool bough_finer_advance(bough_finer *f, bough_simulation *run, double work) {
    const bough_simulation *own = f->other.simulation;
    if (!f->follows || run->master->time > f->until) return f->follows = false;
    if (work_left(f, run->master, work) < 0) {
        f->left = own->master->time;
        return f->follows = false;
    }
    long before = bough_simulation_steps(own), by_run = bough_simulation_steps(run) - f->run_steps;
    int most = most_steps(f, run->master, work);
    bough_other_run_limit(&f->other, most);
    f->run_steps += by_run;
    f->work -= bough_simulation_work(own);
    f->status = bough_ok();
    while (bough_is_ok(&f->status) && own->master->time < run->master->time)
        f->status = bough_other_run_step(&f->other, run);
    f->work += bough_simulation_work(own);
    if (gave_up(f, most, bough_simulation_steps(own) - before, by_run)) bough_validity_pass_fast(run);
    f->follows = bough_is_ok(&f->status) && own->master->time == run->master->time;
    if (f->follows) bough_other_run_sample(&f->other);
    return f->follows;
}

void bough_finer_snapshot(bough_finer *f, bough_snapshot *s) {
    if (!f->other.simulation) return;
    bough_simulation_snapshot(f->other.simulation, s);
    BOUGH_SNAPSHOT(s, f->follows, f->from, f->until, f->left, f->work);
}
