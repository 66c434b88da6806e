#include "cosim/second_solution.h"

#include "cosim/coupled.h"

#include <assert.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// Largest number of evaluations, so that the second solution ends in an acceptable time. A step of the
// Rosenbrock method takes four, a step of IDA little more than one.
static const double most_evaluations = 80000;
static const double most_work = 4e7; // evaluations times states that small systems may take instead
static const double most_ratio = 16; // besides, for each step of the run

// Of the difference between run and second solution, which errs itself, that the run is taken to err by.
static const double share = 1.25;

struct bough_second_solution {
    const bough_assembly *assembly;
    bough_second_model beside; // with loads of its own; none: `whole`, under the loads of the run
    bough_member whole;   // all members as one system
    bough_coupled *evaluation; // of it
    double *error;                 // (n_state)
    double *input_error, *input_worst; // (n_input) of what inputs should be given: now, largest
    long compared;
    bool lost;
    char reason[BOUGH_SECOND_SOLUTION_REASON]; // of its loss
    double left; // evaluations that it may still take
    double seen, seen_run; // its evaluations and the run's steps that are counted in it, of this process
};

// -- building -------------------------------------------------------------------------------------

static void take(bough_second_solution *s, bough_arena *arena) {
    size_t n = (size_t)s->assembly->n_state, n_input = (size_t)s->assembly->n_input;
    s->error = bough_arena_doubles(arena, n);
    s->input_error = bough_arena_doubles(arena, n_input);
    s->input_worst = bough_arena_doubles(arena, n_input);
}

bough_status bough_second_solution_create(bough_arena *arena, const bough_coupling *c,
                                          const bough_second_solution_def *def,
                                          bough_second_solution **second) {
    bough_second_solution *s = bough_arena_take(arena, sizeof *s);
    const bough_assembly *a = s->assembly = c->assembly;
    take(s, arena);
    s->left = fmax(most_evaluations, most_work / fmax(a->n_state, 1));
    s->beside = def->beside;
    *second = s;
    if (s->beside.coupling) return bough_ok();
    bough_system system = bough_coupled_system(arena, a, c->pool, "second solution");
    s->evaluation = system.self;
    bough_integrator_options options = {
        .kind = def->kind, .rtol = def->rtol, .step = def->step};
    return bough_member_create(arena, &system, c->t0, &options, &s->whole);
}

// -- stepping -------------------------------------------------------------------------------------

static double steps_of(const bough_member *m) {
    bough_statistics sum = bough_member_statistics(m);
    return (double)(sum.steps + sum.failed_steps);
}

static double steps_of_run(const bough_coupling *c) {
    double steps = c->whole ? steps_of(c->whole) : 0;
    for (int i = 0; i < c->assembly->n_member; i++) steps += steps_of(c->assembly->member[i]);
    return steps;
}

static const bough_member *whole_of(const bough_second_solution *s) {
    return s->beside.coupling ? s->beside.coupling->whole : &s->whole;
}

static bool works_too_hard(bough_second_solution *s, const bough_coupling *c) {
    double own = (double)bough_member_statistics(whole_of(s)).derivatives, run = steps_of_run(c);
    s->left += most_ratio * (run - s->seen_run) - (own - s->seen);
    s->seen = own;
    s->seen_run = run;
    return s->left < 0;
}

static void give_up(bough_second_solution *s, double t, const char *why) {
    s->lost = true;
    snprintf(s->reason, sizeof s->reason, "from %.6g s on: %.280s", t, why);
}

static void compare(bough_second_solution *s, const bough_coupling *c) {
    s->compared++;
    const bough_assembly *a = s->assembly;
    const double *state = whole_of(s)->state, *input;
    bough_assembly_states(a, s->error);
    for (int k = 0; k < a->n_state; k++) s->error[k] = share * (s->error[k] - state[k]);
    if (s->beside.coupling) {
        input = s->beside.coupling->input;
    } else {
        bough_coupled_inputs(s->evaluation, c->t1, state);
        input = s->evaluation->input;
    }
    for (int j = 0; j < a->n_input; j++) {
        s->input_error[j] = share * (c->input[j] - input[j]);
        s->input_worst[j] = fmax(s->input_worst[j], fabs(s->input_error[j]));
    }
}

void bough_second_solution_stop_by(bough_second_solution *s, bool (*stop)(void)) {
    if (s->beside.coupling) {
        s->beside.stop_by(s->beside.self, stop);
    } else {
        s->whole.stop = stop;
    }
}

bool bough_second_solution_step(bough_second_solution *s, const bough_coupling *c) {
    if (s->lost) return true;
    const bough_member *whole = whole_of(s);
    if (s->beside.coupling && c->t1 < s->beside.end(s->beside.self)) return true;
    assert(s->beside.coupling || whole->time == c->t0);
    bough_status status = s->beside.coupling ? s->beside.step(s->beside.self)
                                             : bough_member_advance(&s->whole, c->t1, NULL, c->restart);
    if (!bough_is_ok(&status) && whole->stop && whole->stop()) return false;
    if (!bough_is_ok(&status)) {
        give_up(s, c->t0, status.message);
    } else if (works_too_hard(s, c)) {
        give_up(s, c->t0, "it takes more than four times the run's work");
    } else {
        compare(s, c);
    }
    return true;
}

long bough_second_solution_compared(const bough_second_solution *s) { return s->compared; }

const double *bough_second_solution_error(const bough_second_solution *s) {
    return s->lost ? NULL : s->error;
}

const double *bough_second_solution_input_error(const bough_second_solution *s) {
    return s->lost ? NULL : s->input_error;
}

double bough_second_solution_input(const bough_second_solution *s, int j) {
    return s->lost ? (double)NAN : s->input_worst[j];
}

bool bough_second_solution_has_loads(const bough_second_solution *s) { return s->beside.coupling != NULL; }

const char *bough_second_solution_reason(const bough_second_solution *s) {
    return s->lost ? s->reason : NULL;
}

void bough_second_solution_snapshot(bough_second_solution *s, bough_snapshot *snapshot) {
    const bough_assembly *a = s->assembly;
    if (!s->beside.coupling) bough_member_snapshot(&s->whole, snapshot);
    bough_snapshot_doubles(snapshot, s->error, a->n_state);
    bough_snapshot_doubles(snapshot, s->input_error, a->n_input);
    bough_snapshot_doubles(snapshot, s->input_worst, a->n_input);
    bough_snapshot_take(snapshot, &s->compared, sizeof s->compared);
    bough_snapshot_take(snapshot, &s->lost, sizeof s->lost);
    bough_snapshot_take(snapshot, s->reason, sizeof s->reason);
    bough_snapshot_take(snapshot, &s->left, sizeof s->left);
}
