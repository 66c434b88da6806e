#include "apps/bough/model/run.h"

#include "apps/bough/model/simulation.h"
#include "apps/bough/model/validity.h"
#include "apps/bough/results/progress.h"
#include "core/base/linalg.h"

#include <assert.h>

// -- building -------------------------------------------------------------------------------------

// Whether run and companion each have one thread: of two threads, or if too few flexible bodies could use
// more.
static bool fits_side_by_side(const bough_scene *scene, int threads) {
    int n = 0;
    for (int i = 0; i < scene->n_body; i++) n += bough_scene_has_mesh(&scene->body[i]);
    return scene->simulation.error_estimate == BOUGH_SCENE_COMPANION && (threads == 2 || n < 2);
}

bough_status bough_run_create(bough_arena *arena, const bough_scene *scene, bough_run *run) {
    *run = (bough_run){.outcome = bough_ok()};
    int threads = bough_simulation_threads(scene);
    bough_linalg_room(arena, threads);
    run->pool = bough_pool_create(arena, threads);
    run->side_by_side = run->pool && fits_side_by_side(scene, threads);
    bough_pool *own = run->side_by_side ? NULL : run->pool;
    BOUGH_TRY(bough_simulation_build_on(arena, scene, own, NULL, &run->simulation));
    bough_validity_check_equilibrium(run->simulation);
    run->channels = bough_channels_start(arena);
    BOUGH_TRY(bough_simulation_channels(run->simulation, &run->channels));
    size_t n = (size_t)run->simulation->assembly->n_member;
    run->value = bough_arena_doubles(arena, (size_t)run->channels.count + 1);
    run->earlier = bough_arena_take(arena, (n + 1) * sizeof *run->earlier);
    // the caller may copy the run: the companion has a list of its own
    bough_channels *channels = bough_arena_take(arena, sizeof *channels);
    *channels = run->channels;
    run->companion = bough_arena_take(arena, sizeof *run->companion);
    return bough_companion_create(arena, run->simulation, channels, run->companion);
}

// -- recording ------------------------------------------------------------------------------------

// Times closer than this are equal [s].
static double resolution(const bough_run *run) { return 1e-6 * run->simulation->master->macro_step; }

void bough_run_record_at(bough_run *run, bough_run_record record) {
    assert(run->n_record < BOUGH_RUN_RECORDS && record.interval > 0);
    double now = run->simulation->master->time;
    record.next = (long)ceil((now - resolution(run)) / record.interval);
    record.last = -HUGE_VAL;
    run->record[run->n_record++] = record;
}

static bough_status take_record(bough_run *run, bough_run_record *r) {
    double now = run->simulation->master->time;
    while ((double)r->next * r->interval <= now + resolution(run)) r->next++;
    r->last = now;
    bough_simulation_update(run->simulation);
    return r->sample(r->self, now);
}

static bough_status record_due(bough_run *run) {
    double now = run->simulation->master->time;
    bough_status status = bough_ok();
    for (int i = 0; i < run->n_record && bough_is_ok(&status); i++) {
        bough_run_record *r = &run->record[i];
        if (now < (double)r->next * r->interval - resolution(run)) continue;
        status = take_record(run, r);
    }
    return status;
}

bough_status bough_run_start(bough_run *run) { return record_due(run); }

// After a numerical failure the state is invalid: only a run that could continue has a last record.
static bough_status record_end(bough_run *run, bough_status status) {
    if (!bough_is_ok(&status) && status.code != BOUGH_INTERRUPTED) return status;
    for (int i = 0; i < run->n_record; i++) {
        bough_run_record *r = &run->record[i];
        if (!r->at_end || r->last >= run->simulation->master->time) continue;
        BOUGH_TRY(take_record(run, r));
    }
    return status;
}

const double *bough_run_values(bough_run *run) {
    bool failed = !bough_is_ok(&run->outcome) && run->outcome.code != BOUGH_INTERRUPTED;
    if (failed) return NULL;
    if (!run->sampled) {
        bough_simulation_update(run->simulation);
        bough_channels_sample(&run->channels, run->simulation->master->time, run->value);
    }
    run->sampled = true;
    return run->value;
}

// -- stepping -------------------------------------------------------------------------------------

static void finish_step(bough_run *run) {
    run->sampled = false;
    bough_validity_check(run->simulation);
    if (bough_is_ok(&run->outcome)) run->outcome = bough_validity_check_closed(run->simulation);
    if (bough_is_ok(&run->outcome)) bough_validity_check_work(run->simulation);
    if (bough_is_ok(&run->outcome)) run->outcome = record_due(run);
    bough_channels_know(&run->channels, NULL);
}

// Steps up to `until`, at least one. The last is finished later, after the step of the companion.
static void step_own(bough_run *run) {
    const bough_master *m = run->simulation->master;
    run->outcome = bough_step(run->simulation->master);
    while (bough_is_ok(&run->outcome) && m->time < run->until) {
        finish_step(run);
        if (bough_is_ok(&run->outcome)) run->outcome = bough_step(run->simulation->master);
    }
}

// 0: step of the run, 1: of the companion; they are independent.
static void step_one(void *self, int which) {
    bough_run *run = self;
    if (which == 0) step_own(run);
    if (which == 1) bough_companion_step(run->companion, run->steps_together && !run->side_by_side);
}

static bough_status interrupted(const bough_run *run) {
    const bough_master *m = run->simulation->master;
    return bough_fail(BOUGH_INTERRUPTED, "interrupted at %.9g s of %.9g s", m->time, m->duration);
}

bough_status bough_run_step(bough_run *run) {
    bool due = bough_companion_due(run->companion);
    if (due && run->side_by_side) {
        bough_pool_run(run->pool, 2, step_one, run);
    } else {
        for (int k = 0; k <= due; k++) step_one(run, k);
    }
    if (bough_is_ok(&run->outcome)) bough_companion_compare(run->companion);
    if (bough_is_ok(&run->outcome) && bough_companion_stopped(run->companion))
        run->outcome = interrupted(run);
    finish_step(run);
    return run->outcome;
}

bool bough_run_done(const bough_run *run) { return bough_master_done(run->simulation->master); }

void bough_run_update_clock(bough_run *run) {
    double wall = bough_wall_clock(), cpu = bough_cpu_clock(run->beside);
    run->wall_s += wall - run->wall_from;
    run->cpu_s += cpu - run->cpu_from;
    run->wall_from = wall;
    run->cpu_from = cpu;
}

static bough_status step(bough_run *run) {
    if (run->stop && run->stop()) return interrupted(run);
    // several steps of the run beside one of the companion, so that no thread waits in between
    bool together = run->side_by_side && run->steps_together && bough_companion_due(run->companion);
    run->until = together ? bough_master_next(run->companion->coarser.simulation->master) : 0;
    bough_status status = bough_run_step(run);
    return bough_is_ok(&status) && run->after ? run->after(run->self) : status;
}

static void step_all(void *self) {
    bough_run *run = self;
    run->wall_from = bough_wall_clock();
    run->cpu_from = bough_cpu_clock(run->beside);
    bough_master_stop_by(run->simulation->master, run->stop);
    bough_companion_stop_by(run->companion, run->stop);
    bough_status status = bough_run_start(run);
    while (bough_is_ok(&status) && !bough_run_done(run)) {
        status = step(run);
        if (run->progress) bough_progress_show(run->progress, run->simulation->master->time);
    }
    run->outcome = record_end(run, status);
    bough_run_update_clock(run);
}

void bough_run_all(bough_run *run) { bough_pool_region(run->pool, step_all, run); }

// -- copies ---------------------------------------------------------------------------------------

bough_statistics bough_run_statistics(const bough_run *run, int member) {
    const bough_master *m = run->simulation->master;
    const bough_member *whole = bough_scheme_whole(m->coupling);
    bough_statistics done = {0};
    if (member < m->assembly->n_member) {
        done = bough_member_statistics(m->assembly->member[member]);
    } else if (whole) {
        done = bough_member_statistics(whole);
    }
    bough_statistics_add(&done, 1, &run->earlier[member]);
    return done;
}

// The solvers count the work of this process; `earlier` has that of the processes that it continues.
static void take_statistics(bough_run *run, bough_snapshot *s) {
    const bough_assembly *a = run->simulation->assembly;
    for (int i = 0; i <= a->n_member; i++) {
        bough_statistics *earlier = &run->earlier[i];
        bough_statistics total = bough_run_statistics(run, i), now = total;
        bough_statistics_add(&now, -1, earlier);
        bough_snapshot_take(s, &total, sizeof total);
        bough_statistics_add(&total, -1, &now);
        *earlier = total;
    }
}

void bough_run_snapshot(bough_run *run, bough_snapshot *s) {
    bough_simulation_snapshot(run->simulation, s);
    bough_companion_snapshot(run->companion, s);
    take_statistics(run, s);
    for (int i = 0; i < run->n_record; i++) {
        BOUGH_SNAPSHOT(s, run->record[i].next, run->record[i].last);
    }
    if (s->move != BOUGH_SNAPSHOT_RESTORE) return;
    run->outcome = bough_ok();
    run->sampled = false;
}

bough_status bough_run_storable(const bough_run *run) {
    const bough_master *m = run->simulation->master;
    if (bough_master_sampled(m) && bough_companion_storable(run->companion))
        return bough_simulation_storable(run->simulation);
    return bough_fail(BOUGH_INVALID,
                      "at %.9g s the air or the control is between two samples; a copy can be "
                      "made at their next sample",
                      m->time);
}
