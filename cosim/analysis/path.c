// Pseudo-arclength continuation, theory (73).
#include "cosim/analysis/path.h"

#include "cosim/analysis/equilibrium.h"

enum { CORRECTIONS = 30, FEW = 16, PARABOLAS = 5 };

// γ is so long that a step of implicit Euler is one of Newton's method: until the response to the loads
// changes by no more than `shift` when γ is four times as long. `newton`: the first one tried.
static const double shift = 0.03, longer = 4, newton = 30, longest = 1e6; // [-, -, s, s]
static const double most_turn = 0.5;  // rotation of a vertex or body in a correction [rad]
static const double rounding = 1e-5;  // corrections that only rounding keeps from contracting
static const double smooth = 0.97;    // least cosine between the tangents of neighbouring points
static const double straight = 0.995; // cosine from which steps grow
static const double growth = 1.6, shrink = 0.4, least_step = 1e-9;

bough_path_def bough_path_def_default(void) {
    return (bough_path_def){.step = 0.02, .tolerance = 1e-8, .steps = 2000};
}

// A point of the path and the direction there: state, then load factor; of norm 1.
typedef struct place {
    double factor, *state, *tangent; // (n), (n + 1)
} place;

typedef struct path {
    bough_whole *whole;
    const bough_path_def *def;
    int n;                                       // states
    double *scale, *rate, *full, *load, *change; // (n); load: (I − γJ)⁻¹ γ ∂F/∂λ
    double *moved;                               // (n)
    place here, next, limit, next_limit;
    double gamma; // [s]
} path;

static void take_place(bough_arena *arena, size_t n, place *p) {
    p->state = bough_arena_doubles(arena, n);
    p->tangent = bough_arena_doubles(arena, n + 1);
}

static void take(path *p, bough_arena *arena) {
    size_t n = (size_t)p->n;
    bough_arena_each(arena, n, &p->scale, &p->rate, &p->full, &p->load, &p->change, &p->moved);
    place *const places[] = {&p->here, &p->next, &p->limit, &p->next_limit};
    for (int i = 0; i < 4; i++) take_place(arena, n, places[i]);
}

// Scalar product: mean over the states in units of their scales, plus that of the load factors.
static double product(const path *p, const double *a, double a_factor, const double *b, double b_factor) {
    double sum = 0;
    for (int k = 0; k < p->n; k++) sum += a[k] / p->scale[k] * (b[k] / p->scale[k]);
    return sum / p->n + a_factor * b_factor;
}

// Moves a place by a change of state and load factor; false: by too large a rotation.
static bool add(path *p, place *at, const double *change, double factor) {
    if (!(p->def->move(p->def->self, at->state, change, p->moved) < most_turn)) return false;
    memcpy(at->state, p->moved, (size_t)p->n * sizeof *p->moved);
    at->factor += factor;
    p->def->rest(p->def->self, at->state);
    return true;
}

// F into p->rate, the factors and p->load at a place.
static bool linearise(path *p, const place *at) {
    double end = p->def->end, time = fmin(fmax(at->factor, 0), 1) * end;
    bough_status status = bough_whole_rate(p->whole, end, at->state, p->full);
    if (bough_is_ok(&status)) status = bough_whole_rate(p->whole, 0, at->state, p->rate);
    if (!bough_is_ok(&status)) return false;
    for (int k = 0; k < p->n; k++) {
        p->load[k] = p->gamma * (p->full[k] - p->rate[k]);
        p->rate[k] += at->factor * (p->full[k] - p->rate[k]);
    }
    bough_whole_inputs(p->whole, time, at->state);
    status = bough_whole_setup(p->whole, time, at->state, p->whole->input, p->gamma);
    if (!bough_is_ok(&status)) return false;
    bough_whole_solve(p->whole, p->load);
    return isfinite(bough_largest(p->n, p->load, p->scale));
}

// The factors' γ, and the factors and p->load of a place with it.
static bool choose_gamma(path *p, const place *at) {
    for (p->gamma = newton; linearise(p, at); p->gamma *= longer) {
        double change = 0, size = bough_largest(p->n, p->load, p->scale);
        for (int k = 0; k < p->n; k++) change = fmax(change, fabs(p->load[k] - p->change[k]) / p->scale[k]);
        bool same = change <= shift * size;
        memcpy(p->change, p->load, (size_t)p->n * sizeof *p->load);
        if (same || p->gamma > longest) return true;
    }
    return false;
}

// The direction at a place from p->load, towards that of `before` (n + 1), or with a growing load factor.
static void direct(path *p, const double *before, double *tangent) {
    double norm = sqrt(product(p, p->load, 1, p->load, 1)), sign = 1;
    if (before) sign = copysign(1, product(p, p->load, 1, before, before[p->n]));
    for (int k = 0; k < p->n; k++) tangent[k] = sign * p->load[k] / norm;
    tangent[p->n] = sign / norm;
}

// Corrects a predicted place in the plane normal to `tangent`, or at its load factor where `fixed`; leaves
// the factors and p->load of nearly that place. The number of corrections, 0: they failed.
static int correct(path *p, const double *tangent, bool fixed, place *at) {
    double before = INFINITY;
    for (int i = 1; i <= CORRECTIONS; i++) {
        // the correction at a constant load factor, and its part along the tangent
        if (!linearise(p, at)) return 0;
        for (int k = 0; k < p->n; k++) p->change[k] = p->gamma * p->rate[k];
        bough_whole_solve(p->whole, p->change);
        double along = product(p, p->change, 0, tangent, tangent[p->n]);
        double factor = fixed ? 0 : -along / product(p, p->load, 1, tangent, tangent[p->n]);
        for (int k = 0; k < p->n; k++) p->change[k] += factor * p->load[k];
        // applied, until it is small or only rounding is left
        double size = fmax(bough_largest(p->n, p->change, p->scale), fabs(factor));
        if (!isfinite(size) || !add(p, at, p->change, factor)) return 0;
        if (size < p->def->tolerance || (size < rounding && !(size < 0.5 * before))) return i;
        if (i > 2 && !(size < before)) return 0;
        before = size;
    }
    return 0;
}

static void copy_place(const path *p, const place *from, place *to) {
    memcpy(to->state, from->state, (size_t)p->n * sizeof *to->state);
    memcpy(to->tangent, from->tangent, (size_t)(p->n + 1) * sizeof *to->tangent);
    to->factor = from->factor;
}

// From `here` by a step along its tangent to `to`, with the direction there. The number of corrections, 0:
// they failed.
static int go(path *p, double step, place *to) {
    copy_place(p, &p->here, to);
    for (int k = 0; k < p->n; k++) p->change[k] = step * p->here.tangent[k];
    if (!add(p, to, p->change, step * p->here.tangent[p->n])) return 0;
    int corrections = correct(p, p->here.tangent, false, to);
    if (corrections > 0) direct(p, p->here.tangent, to->tangent);
    return corrections;
}

static double cosine(const path *p, const place *a, const place *b) {
    return product(p, a->tangent, a->tangent[p->n], b->tangent, b->tangent[p->n]);
}

// Place of the extremum of the parabola through three points (s, load factor), in order.
static double extremum(const double s[3], const double factor[3]) {
    double left = s[1] - s[0], right = s[2] - s[1];
    double before = (factor[1] - factor[0]) / left, after = (factor[2] - factor[1]) / right;
    double curvature = (after - before) / (left + right); // half the second derivative
    return s[1] - 0.5 * (before + curvature * left) / curvature;
}

// The limit point about `here` into p->limit: `before` and `next` lie at s[0] and s[2] from it. Its
// distance; load factors are those of points on the path, so it does not depend on the error of tangents.
static double find_limit(path *p, double s[3], double factor[3]) {
    double found = 0;
    copy_place(p, &p->here, &p->limit);
    for (int i = 0; i < PARABOLAS; i++) {
        double at = extremum(s, factor);
        if (!(at > s[0] && at < s[2]) || fabs(at - s[1]) < 1e-4 * (s[2] - s[0])) break;
        if (go(p, at, &p->next_limit) == 0) break;
        // the new point replaces the middle one or a side
        bool better = (p->next_limit.factor - factor[1]) * (factor[1] - factor[0]) >= 0;
        int side = at < s[1] ? 0 : 2;
        if (better) {
            place old = p->limit;
            p->limit = p->next_limit;
            p->next_limit = old;
            found = at;
            s[2 - side] = s[1], factor[2 - side] = factor[1];
            s[1] = at, factor[1] = p->limit.factor;
        } else {
            s[side] = at, factor[side] = p->next_limit.factor;
        }
    }
    return found;
}

// The last place into p->limit: at this load factor, between `here` and `next`.
static bool finish(path *p, double factor) {
    double ahead = factor - p->here.factor, slope = p->here.tangent[p->n];
    copy_place(p, &p->here, &p->limit);
    if (!(ahead * slope > 0)) return ahead == 0;
    for (int k = 0; k < p->n; k++) p->change[k] = ahead / slope * p->here.tangent[k];
    return add(p, &p->limit, p->change, ahead) && correct(p, p->here.tangent, true, &p->limit) > 0;
}

// One point for the caller and the report.
static bough_status report_point(path *p, const place *at, bool limit, bough_path_report *report) {
    report->points++;
    report->limits += limit;
    report->factor = at->factor;
    return p->def->point ? p->def->point(p->def->self, at->factor, at->state, limit) : bough_ok();
}

// Reports `here`, and the limit point about it if there is one; `back` and `step` are the distances to the
// points before, whose load factor was `before`, and after.
static bough_status report_here(path *p, double back, double before, double step, bough_path_report *report) {
    double s[3] = {-back, 0, step}, factor[3] = {before, p->here.factor, p->next.factor};
    bool turns = back > 0 && (factor[1] - factor[0]) * (factor[2] - factor[1]) < 0;
    double at = turns ? find_limit(p, s, factor) : 0;
    bough_status status = bough_ok();
    if (turns && at < 0) status = report_point(p, &p->limit, true, report);
    if (bough_is_ok(&status) && (!turns || at != 0)) status = report_point(p, &p->here, false, report);
    if (bough_is_ok(&status) && turns && at >= 0) status = report_point(p, &p->limit, true, report);
    return status;
}

// From `here` to the load factor 1 or −1.
static bough_status follow(path *p, bough_path_report *report) {
    double step = p->def->step, back = 0, before = 0;
    bough_status status = bough_ok();
    while (bough_is_ok(&status) && report->steps++ < p->def->steps && step > least_step) {
        // a step, refused if the path turns sharply
        int corrections = go(p, step, &p->next);
        double turned = corrections > 0 ? cosine(p, &p->here, &p->next) : -1;
        bool over = fabs(p->next.factor) >= 1;
        double last = copysign(1, p->next.factor);
        if (corrections == 0 || turned < smooth || (over && !finish(p, last))) {
            if (corrections == 0) p->gamma = fmax(p->gamma / longer, newton); // less rounding
            step *= shrink;
            continue;
        }
        // the end of the loads
        if (over) {
            status = report_point(p, &p->here, false, report);
            copy_place(p, &p->limit, &p->here);
            return bough_is_ok(&status) ? report_point(p, &p->here, false, report) : status;
        }
        status = report_here(p, back, before, step, report);
        // the next point is the present one
        place old = p->here;
        back = step, before = old.factor;
        p->here = p->next;
        p->next = old;
        if (corrections <= FEW && turned > straight) step *= growth;
    }
    if (bough_is_ok(&status)) status = report_point(p, &p->here, false, report);
    BOUGH_TRY(status);
    return bough_fail(BOUGH_FAILED, "the path of equilibria ends at %.6g times the loads after %d steps",
                      p->here.factor, report->steps);
}

bough_status bough_path_follow(bough_arena *arena, bough_whole *whole, const bough_path_def *def,
                               double *state, bough_path_report *report) {
    const bough_assembly *a = whole->assembly;
    path p = {.whole = whole, .def = def, .n = a->n_state};
    *report = (bough_path_report){0};
    take(&p, arena);
    bough_assembly_scales(a, p.scale);
    memcpy(p.here.state, state, (size_t)p.n * sizeof *state);
    if (!choose_gamma(&p, &p.here)) {
        return bough_fail(BOUGH_FAILED, "the equilibrium without load is unstable or not unique");
    }
    direct(&p, NULL, p.here.tangent);
    bough_status status = follow(&p, report);
    memcpy(state, p.here.state, (size_t)p.n * sizeof *state);
    return status;
}
