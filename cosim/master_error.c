// How a run knows what it errs by: which estimate it carries, and what that says.
#include "cosim/master.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double second_rtol = 1e-5; // of the second solution beside a coupling
static const double finer = 64;         // times the tolerance of a run as one system, or that above
static const double tight = 1e-7; // tolerance of other monolithic methods from which on it is a reference

// Above so many states a second solution costs what people notice. On a heavy interface, under sub-solvers
// that tell their errors, ramp is told well by the linearised members (0.5 to 3 of the error).
static const int many_states = 600;
static const double heavy_interface = 0.25;

// Up to this tolerance of one system they tell a third of the error and more, at six times as much an eighth:
// land.yaml, the first 2 s, the generator's speed.
static const double measured_rtol = 5e-4;

static const double most_halvings = 6; // of the macro step that are worth trying

static bool has_order_three(const bough_integrator_options *o) {
    return o->kind == BOUGH_ROSENBROCK || o->kind == BOUGH_AUTOMATIC;
}

// Generalised-α takes the steps that it is given: rtol says nothing of their error.
static bool controls_error(const bough_integrator_options *o) { return o->kind != BOUGH_GENERALIZED_ALPHA; }

static double longest_step(const bough_master *m) {
    double step = m->coupling->options.integrator.step;
    return step > 0 ? fmin(step, m->macro_step) : m->macro_step;
}

// Beside one system the same method, finer: another one might lose more than the run. What methods of higher
// order lose at a loose tolerance does not follow it.
static bough_second_solution_def choose(const bough_master *m) {
    const bough_integrator_options *own = &m->coupling->options.integrator;
    if (!m->coupling->scheme->one_system) {
        return (bough_second_solution_def){BOUGH_AUTOMATIC, second_rtol, m->macro_step, {0}};
    }
    double step = longest_step(m) / 2, bounded = fmin(own->rtol, second_rtol);
    if (has_order_three(own)) return (bough_second_solution_def){BOUGH_AUTOMATIC, own->rtol / finer, step, {0}};
    if (controls_error(own)) return (bough_second_solution_def){own->kind, bounded / finer, step, {0}};
    return (bough_second_solution_def){BOUGH_AUTOMATIC, second_rtol / finer, step, {0}};
}

static bool members_tell(const bough_assembly *a) {
    for (int i = 1; i < a->n_member; i++) {
        if (!a->member[i]->own_error) return false;
    }
    return true;
}

// One system has no defects: what is told are the errors of its method, if that tells them.
static bool can_linearise(const bough_master *m) {
    const bough_coupling *c = m->coupling;
    if (!c->scheme->one_system) return true;
    return c->whole->own_error;
}

// Only ramp has a weight, and none where it repeats its steps.
static bool linearised_serves(const bough_master *m) {
    const bough_coupling *c = m->coupling;
    bool light = c->interface_ratio >= heavy_interface || c->theta > 0.501;
    if (!m->suits_linearised || light) return false;
    if (!c->scheme->one_system) return members_tell(m->assembly);
    return can_linearise(m) && c->options.integrator.rtol <= measured_rtol;
}

void bough_master_choose_estimate(bough_master *m) {
    if (m->error == BOUGH_ERROR_BY_LINEARISED_MEMBERS && !linearised_serves(m))
        m->error = BOUGH_ERROR_BY_SECOND_SOLUTION;
}

static bool wants_second(const bough_master *m) {
    if (m->error == BOUGH_ERROR_BY_SECOND_SOLUTION) return true;
    if (m->error != BOUGH_ERROR_BY_BEST) return false;
    const bough_integrator_options *own = &m->coupling->options.integrator;
    if (!m->coupling->scheme->one_system) {
        return !(linearised_serves(m) && m->coupling->theta > 0 && m->assembly->n_state >= many_states);
    }
    return has_order_three(own) || !controls_error(own) || own->rtol > tight;
}

bool bough_master_wants_second(const bough_master *m, bough_second_solution_def *def) {
    if (!wants_second(m)) return false;
    *def = choose(m);
    return true;
}

static bough_status step_second(void *self) { return bough_step(self); }

static double end_of_second(void *self) { return bough_master_next(self); }

static void stop_second(void *self, bool (*stop)(void)) { bough_master_stop_by(self, stop); }

bough_status bough_master_watch(bough_master *m, bough_arena *arena, bough_master *beside) {
    bough_status status = bough_ok();
    bough_second_solution_def chosen;
    if (bough_master_wants_second(m, &chosen)) {
        if (beside)
            chosen.beside =
                (bough_second_model){beside, beside->coupling, step_second, end_of_second, stop_second};
        status = bough_second_solution_create(arena, m->coupling, &chosen, &m->second);
    }
    bool one_system = m->coupling->scheme->one_system;
    bool linearised = one_system ? m->error == BOUGH_ERROR_BY_LINEARISED_MEMBERS && can_linearise(m)
                                 : m->error != BOUGH_ERROR_NOT_TOLD;
    if (bough_is_ok(&status) && linearised && !m->estimate) {
        m->estimate = bough_error_estimate_create(arena, m->coupling);
    }
    return status;
}

// -- answers --------------------------------------------------------------------------------------

// What tells the error where no second solution does. One that broke down leaves its place to the linearised
// members where they are known to be reliable; elsewhere they told a hundredth of errors, and 57 times
// others.
static const bough_error_estimate *told_by(const bough_master *m) {
    return !m->second || m->suits_linearised ? m->estimate : NULL;
}

bool bough_master_measures(const bough_master *m) {
    return m->second && bough_second_solution_error(m->second);
}

long bough_master_errors(const bough_master *m) {
    if (bough_master_measures(m)) return bough_second_solution_compared(m->second);
    if (m->second) return m->steps;
    return m->estimate ? bough_error_estimate_batches(m->estimate) : 0;
}

const double *bough_master_state_error(const bough_master *m) {
    if (bough_master_measures(m)) return bough_second_solution_error(m->second);
    return told_by(m) ? bough_error_estimate_states(m->estimate) : NULL;
}

const double *bough_master_inputs_error(const bough_master *m) {
    return bough_master_measures(m) ? bough_second_solution_input_error(m->second) : NULL;
}

double bough_master_error_safety(const bough_master *m) {
    return bough_master_measures(m) ? 1 : BOUGH_ERROR_SAFETY;
}

double bough_master_input_error(const bough_master *m, int j) {
    if (bough_master_measures(m)) return bough_second_solution_input(m->second, j);
    return told_by(m) ? bough_error_estimate_input(m->estimate, j) : (double)NAN;
}

static bool samples_loads(const bough_master *m) {
    for (int i = 0; i < m->n_load; i++) {
        if (m->load[i].sample) return true;
    }
    return false;
}

const char *bough_master_error_source(const bough_master *m) {
    if (bough_master_measures(m)) {
        bool same = samples_loads(m) && !bough_second_solution_has_loads(m->second);
        return same ? "second solution under the same air and control" : "second solution";
    }
    return told_by(m) ? "linearised members" : "not estimated";
}

static const char the_coupling[] = "the coupling";

// The sub-solvers are named when their own figures make up half of the error.
const char *bough_master_error_cause(const bough_master *m) {
    if (m->coupling->scheme->one_system) return "the integrator's steps";
    if (m->coupling->unfinished > 0) return "macro steps that have not converged";
    bool own = m->estimate && bough_error_estimate_own_share(m->estimate) > 0.5;
    return own ? "the sub-solvers' steps" : the_coupling;
}

// Ramp with another weight than 1/2, and where it repeats its steps on so light an interface, is of order 1.
static double order_of(const bough_coupling *c) {
    bool exact = c->scheme->explicit_forces || c->iteration || c->theta <= 0.501;
    return exact ? bough_scheme_defect_order(c->scheme, &c->options) : 1;
}

void bough_master_advise(const bough_master *m, double factor, char text[BOUGH_MASTER_ADVICE]) {
    const bough_coupling *c = m->coupling;
    const bough_integrator_options *own = &c->options.integrator;
    if (!c->scheme->one_system) {
        bool coupling = strcmp(bough_master_error_cause(m), the_coupling) == 0 && !m->control;
        double halvings = ceil(log2(4 * factor) / order_of(c));
        if (coupling && halvings <= most_halvings) {
            snprintf(text, BOUGH_MASTER_ADVICE, "scheme: monolithic or macro_step: %.9g s",
                     m->macro_step * pow(0.5, halvings));
        } else {
            snprintf(text, BOUGH_MASTER_ADVICE, "scheme: monolithic");
        }
    } else if (!controls_error(own)) {
        double step = longest_step(m) / sqrt(2 * factor);
        snprintf(text, BOUGH_MASTER_ADVICE, "master.step: %.2g s or master.solver: rosenbrock", step);
    } else if (has_order_three(own)) {
        snprintf(text, BOUGH_MASTER_ADVICE, "master.rtol: %.1g", 0.1 * own->rtol / fmin(factor, 1e3));
    } else {
        snprintf(text, BOUGH_MASTER_ADVICE, "master.rtol: %.1g", 0.1 * own->rtol);
    }
}
