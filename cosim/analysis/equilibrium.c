// Implicit Euler steps of growing length, theory (72).
#include "cosim/analysis/equilibrium.h"

#include <float.h>

// Largest ratio of the second correction of a step to the first, and the ratio aimed at; it grows with the
// square of γ, or faster. The second correction has tangents of its own: with those of the first a slender
// body that has rotated would respond with its axial stiffness. γ grows and shrinks by these factors at most,
// after a refusal by `cautious`.
static const double contracting = 0.5, aim = 0.2, growth = 8, shrink = 0.1, cautious = 1.5;

// A state farther away, in units of its scale, has no equilibrium: nothing holds it.
static const double far_away = 1e9;
static const double rounding = 1e-6; // changes that only rounding keeps from contracting
static const double most_turn = 1;   // of a vertex or body in a correction [rad]
static const double small = 1e-3;    // changes after which the next step may have the same factors

bough_equilibrium_def bough_equilibrium_def_default(void) {
    return (bough_equilibrium_def){.unit = 1, .step = 0.1, .least = 1e-9, .tolerance = 1e-10, .steps = 1000};
}

typedef struct search {
    bough_whole *whole;
    const bough_equilibrium_def *def;
    int n;                                         // states
    double *scale, *rate, *first, *second, *trial; // (n)
    double gamma;
    bool kept; // the factors are those of this γ about a state near
} search;

static void take(search *s, bough_arena *arena) {
    size_t n = (size_t)s->n;
    bough_arena_each(arena, n, &s->scale, &s->rate, &s->first, &s->second, &s->trial);
}

static bool find_rate(search *s, const double *state) {
    bough_status status = bough_whole_rate(s->whole, s->def->time, state, s->rate);
    return bough_is_ok(&status);
}

static double size_of(const search *s, const double *x, int *row) {
    double largest = 0;
    for (int k = 0; k < s->n; k++) {
        double size = fabs(x[k]) / s->scale[k];
        if (size > largest) *row = k;
        largest = fmax(largest, size);
    }
    return largest;
}

// moved ← state after the change, by the caller's rule; its largest rotation [rad].
static double move(const search *s, const double *state, const double *change, double *moved) {
    if (s->def->move) return s->def->move(s->def->self, state, change, moved);
    for (int k = 0; k < s->n; k++) moved[k] = state[k] + change[k];
    return 0;
}

// Factors about a state, unless those of another are kept.
static bool set_up(search *s, const double *state) {
    if (s->kept) return true;
    bough_status status = bough_whole_setup(s->whole, s->def->time, state, s->whole->input, s->gamma);
    return bough_is_ok(&status);
}

// Two corrections of one implicit Euler step from `state`, into first and second; the ratio of the second to
// the first, infinite where the step fails. s->rate belongs to `state`.
static double step(search *s, const double *state, bough_equilibrium_report *report) {
    int row = 0;
    if (!set_up(s, state)) return INFINITY;
    for (int k = 0; k < s->n; k++) s->first[k] = s->gamma * s->rate[k];
    bough_whole_solve(s->whole, s->first);
    report->change = size_of(s, s->first, &report->row);
    report->rate = s->rate[report->row];
    if (!isfinite(report->change)) return INFINITY;
    if (!(move(s, state, s->first, s->trial) < most_turn)) return INFINITY;
    if (!find_rate(s, s->trial)) return INFINITY;
    for (int k = 0; k < s->n; k++) s->second[k] = s->gamma * s->rate[k] - s->first[k];
    if (!set_up(s, s->trial)) return INFINITY;
    bough_whole_solve(s->whole, s->second);
    return size_of(s, s->second, &row) / (report->change + DBL_MIN);
}

// Whether the state after a last step is the equilibrium: its change is zero, or as small as rounding lets it
// be. After shorter last steps the sum of all changes to come must be within the tolerance.
static bool is_found(const search *s, double longest, double change, double before) {
    if (longest >= s->def->unit * BOUGH_EQUILIBRIUM_LONGEST)
        return change < s->def->tolerance || (change < rounding && !(change < contracting * before));
    if (!(change < before)) return isfinite(before) && change < rounding;
    double ratio = change / before;
    return isfinite(before) && change * ratio / (1 - ratio) < s->def->tolerance;
}

// Sets the state to rest after a step; if a kinetic energy is given, only when that falls below the one
// `before`: theory (112).
static void rest(const bough_equilibrium_def *def, double *before, double *state) {
    double now = def->kinetic ? def->kinetic(def->self, state) : 0;
    bool falls = def->kinetic == NULL || now < *before;
    if (falls && def->rest) def->rest(def->self, state);
    *before = falls ? 0 : now;
}

bough_status bough_equilibrium_find(bough_arena *arena, bough_whole *whole, const bough_equilibrium_def *def,
                                    double *state, bough_equilibrium_report *report) {
    const bough_assembly *a = whole->assembly;
    search s = {.whole = whole, .def = def, .n = a->n_state, .gamma = def->unit * def->step};
    *report = (bough_equilibrium_report){0};
    take(&s, arena);
    bough_assembly_scales(a, s.scale);
    if (def->scale) memcpy(s.scale, def->scale, (size_t)s.n * sizeof *s.scale);
    double newton = def->unit * BOUGH_EQUILIBRIUM_LONGEST, longest = newton;
    double most = growth, before = INFINITY, taken = INFINITY;
    double kinetic = 0;
    s.kept = def->kept && s.gamma == newton;
    while (report->steps < def->steps && s.gamma > def->unit * def->least && find_rate(&s, state)) {
        double contraction = step(&s, state, report);
        bool last = s.gamma >= longest, near = report->change < rounding;
        // factors of another state that contract too little are replaced
        if (s.kept && !(contraction <= aim) && !(report->change < def->tolerance)) {
            s.kept = false;
            continue;
        }
        report->steps++;
        report->kept = s.gamma == newton;
        if (last && is_found(&s, longest, report->change, before)) return bough_ok();
        before = last && near ? report->change : (double)INFINITY;
        bool lowered = longest < newton;
        if (near && !lowered) contraction = 0; // what remains is rounding
        bool refused = !(contraction < contracting);
        most = refused ? cautious : fmin(growth, most * cautious);
        s.gamma *= fmin(most, fmax(shrink, sqrt(aim / (contraction + DBL_MIN))));
        // rounding of long steps leads away from where shorter ones came to rest
        if (refused && taken < rounding) longest = fmin(longest, s.gamma);
        // a stiffness that vanishes with the deflection takes ever longer steps
        if (last && !refused && !lowered && report->change > contracting * taken) longest *= growth;
        s.gamma = fmin(s.gamma, longest);
        s.kept = !refused && report->kept && s.gamma == newton && (s.kept || report->change < small);
        if (refused) continue;
        taken = report->change;
        move(&s, s.trial, s.second, state);
        if (!(size_of(&s, state, &report->row) < far_away)) break;
        rest(def, &kinetic, state);
    }
    return bough_fail(BOUGH_FAILED, "no equilibrium found in %d steps", report->steps);
}
