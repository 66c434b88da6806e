// Macro steps by their defects, theory (68).
#include "cosim/step_control.h"

#include "cosim/scheme.h"

bough_step_control *bough_step_control_create(bough_arena *arena, bough_coupling *c,
                                              const bough_step_control_def *def, double macro_step,
                                              int order) {
    bough_step_control *s = bough_arena_take(arena, sizeof *s);
    s->tolerance = def->tolerance;
    // a step twice as long has 2^order times the defect; half of the tolerance for safety
    s->easy = 0.5 * def->tolerance * pow(0.5, order);
    s->most = def->least > 0 ? (int)floor(log2(macro_step / def->least) + 1e-6) : 0;
    s->now.shortest = HUGE_VAL;
    bough_snapshot size = {.move = BOUGH_SNAPSHOT_MEASURE};
    bough_scheme_snapshot(c, &size);
    s->copy = bough_arena_take(arena, size.used);
    s->now.n_point = 1;
    s->curve = bough_signal_create(arena, c->assembly->n_input);
    bough_arena_each(arena, (size_t)c->assembly->n_input, &s->size, &s->obtained, &s->square);
    return s;
}

double bough_step_control_end(bough_step_control *s, double from, double to) {
    int n = 1 << s->now.level;
    if (s->now.part == 0) s->now.from = from;
    return s->now.part + 1 == n ? to : s->now.from + (to - s->now.from) * (s->now.part + 1) / n;
}

// -- copies ---------------------------------------------------------------------------------------

void bough_step_control_save(bough_step_control *s, bough_coupling *c) {
    bough_scheme_snapshot(c, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, s->copy, 0});
}

void bough_step_control_restore(bough_step_control *s, bough_coupling *c) {
    bough_scheme_snapshot(c, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, s->copy, 0});
}

void bough_step_control_snapshot(bough_step_control *s, bough_snapshot *snapshot) {
    BOUGH_SNAPSHOT(snapshot, s->now);
    bough_snapshot_doubles(snapshot, s->size, s->curve.n);
}

// -- defects --------------------------------------------------------------------------------------

// Squares of the norms of vectors, each at the place of its first component.
static void square_norms(bough_step_control *s, const bough_assembly *a, const double *x) {
    for (int j = 0; j < a->n_input; j++) {
        if (a->vector[j] == j) s->square[j] = 0;
        s->square[a->vector[j]] += x[j] * x[j];
    }
}

// Largest norm of a vector in x (n_input) relative to its size.
static double worst_relative(bough_step_control *s, const bough_assembly *a, const double *x) {
    double worst = 0;
    square_norms(s, a, x);
    for (int j = 0; j < a->n_input; j++) {
        if (a->vector[j] != j || !(s->square[j] > 0)) continue;
        double relative = sqrt(s->square[j]) / s->size[j];
        worst = relative <= worst ? worst : relative; // also if it is NaN
    }
    return worst;
}

// The obtained inputs: the polynomial through the last synchronisation points, none of them before a jump.
static void reconstruct(bough_step_control *s, const bough_coupling *c) {
    int past = c->restart ? 1 : s->now.n_point;
    s->curve.t0 = c->t0;
    s->curve.t1 = c->t1;
    for (int j = 0; j < s->curve.n; j++) {
        double value[BOUGH_PAST];
        for (int p = 0; p <= past; p++) value[p] = c->past.input[p][j];
        bough_signal_polynomial(&s->curve, j, past + 1, c->past.time, value);
    }
}

static double defect_near(bough_step_control *s, const bough_coupling *c, double t) {
    const bough_assembly *a = c->assembly;
    // obtained
    bough_signal_value(&s->curve, t, s->obtained);
    // applied
    for (int i = 0; i < a->n_member; i++) {
        double *applied = s->square + a->input_offset[i];
        bough_signal_value(&c->signal[i], t, applied);
    }
    for (int j = 0; j < a->n_input; j++) s->obtained[j] = c->followed[j] ? 0 : s->square[j] - s->obtained[j];
    return worst_relative(s, a, s->obtained);
}

// Largest relative change over the step. After a start or a jump the curvature is not known; a quarter of the
// change is taken for the defect.
static double change_over(bough_step_control *s, const bough_coupling *c) {
    for (int j = 0; j < s->curve.n; j++)
        s->obtained[j] = c->followed[j] ? 0 : c->input[j] - c->past.input[1][j];
    return worst_relative(s, c->assembly, s->obtained);
}

double bough_step_control_defect(bough_step_control *s, const bough_coupling *c) {
    const bough_assembly *a = c->assembly;
    // largest norms so far
    square_norms(s, a, c->input);
    for (int j = 0; j < a->n_input; j++) {
        if (a->vector[j] == j) s->size[j] = fmax(s->size[j], sqrt(s->square[j]));
    }
    // defects at the end and in the middle
    reconstruct(s, c);
    double end = defect_near(s, c, c->t1);
    double middle = defect_near(s, c, 0.5 * (c->t0 + c->t1));
    if (!isfinite(end) || !isfinite(middle)) return HUGE_VAL;
    bool first = c->restart || s->now.n_point == 1;
    return fmax(fmax(end, middle), first ? 0.25 * change_over(s, c) : 0);
}

// -- decisions ------------------------------------------------------------------------------------

bool bough_step_control_exhausted(const bough_step_control *s) { return s->now.level >= s->most; }

// The span in twice as many steps.
static void refine(bough_step_control *s) {
    s->now.level++;
    s->now.part *= 2;
    s->now.rejected++;
}

bool bough_step_control_accept(bough_step_control *s, const bough_coupling *c, double error) {
    bool good = error <= s->tolerance;
    if (!good && !bough_step_control_exhausted(s)) {
        refine(s);
        return false;
    }
    if (!isfinite(error)) return false;
    // counts
    s->now.accepted++;
    s->now.forced += !good;
    s->now.shortest = fmin(s->now.shortest, c->t1 - c->t0);
    s->now.n_point = c->restart ? 2 : s->now.n_point + 1 < BOUGH_PAST ? s->now.n_point + 1 : BOUGH_PAST - 1;
    // the next step, twice as long where the defects are small and an even number of steps is behind
    s->now.part++;
    if (s->now.part == 1 << s->now.level) s->now.part = 0;
    if (error < s->easy && s->now.level > 0 && s->now.part % 2 == 0) {
        s->now.level--;
        s->now.part /= 2;
    }
    return true;
}
