#include "apps/bough/model/error_verdict.h"

#include "apps/bough/model/companion.h"
#include "apps/bough/model/simulation.h"
#include "apps/bough/results/progress.h"
#include "cosim/scheme.h"

#include <math.h>
#include <stdio.h>

const char *bough_error_share_name(bough_error_share_kind kind) {
    static const char *const names[BOUGH_SHARES] = {"mesh", "air", "time"};
    return names[kind];
}

static void unknown(bough_error_share *share, const char *why) {
    snprintf(share->unknown, sizeof share->unknown, "%.150s", why);
}

// -- further runs ---------------------------------------------------------------------------------

static const double most_times = 5; // the work of the run and its companion, by all further runs together
static const double little = 3e6;   // work that takes a few milliseconds

// A macro step of a further run, whose work is taken off what is left. Runs that need much more than the run
// and its companion follow another solution and may never end.
static bough_status step(const bough_simulation *s, double *left) {
    double before = bough_simulation_work(s);
    BOUGH_TRY(bough_step(s->master));
    *left -= bough_simulation_work(s) - before;
    if (*left >= 0) return bough_ok();
    return bough_fail(BOUGH_FAILED,
                      "further runs took more than %.0f times the work of this one and its "
                      "companion to %.6g s",
                      most_times, s->master->time);
}

static bough_status advance(bough_other_run *r, double t, double *left) {
    while (r->simulation->master->time < t) BOUGH_TRY(step(r->simulation, left));
    return bough_ok();
}

static bough_status look_for_stop(bool (*stop)(void)) {
    if (!stop || !stop()) return bough_ok();
    return bough_fail(BOUGH_INTERRUPTED, "interrupted during the search for the cause of the error");
}

// `part`, `held`: of the difference, that the run errs by; of channels whose last sample the base holds. Both
// runs are sampled.
static void compare(const bough_other_run *base, const bough_other_run *other, double part, double held,
                    double *largest) {
    bool holds = !bough_master_sampled(base->simulation->master);
    if (other->simulation->master->time != base->simulation->master->time) return;
    for (int i = 0; i < base->channels.count; i++) {
        const bough_channel *channel = &base->channels.channel[i];
        double difference = base->value[i] - other->value[i];
        if (channel->turn > 0) difference = remainder(difference, channel->turn);
        largest[i] = fmax(largest[i], (channel->sampled && holds ? held : part) * fabs(difference));
    }
}

typedef struct finding {
    bough_companion *companion;
    bool lost; // the companion may have lost the solution
    bool (*stop)(void);
    double end;   // of the run, less rounding [s]
    double *left; // work
    bough_error_shares *shares;
} finding;

static bool has_part(const bough_scene *scene, int kind) {
    if (kind == BOUGH_SHARE_TIME) return true;
    if (kind == BOUGH_SHARE_AIR) return scene->aero.node != NULL;
    for (int i = 0; i < scene->n_body; i++) {
        if (bough_scene_has_mesh(&scene->body[i])) return true;
    }
    return false;
}

// Whose error has no other part.
static bool has_time_alone(const bough_scene *scene) {
    return !has_part(scene, BOUGH_SHARE_MESH) && !has_part(scene, BOUGH_SHARE_AIR);
}

static const int coarser[BOUGH_SHARES] = {BOUGH_COARSER_MESH, BOUGH_COARSER_AIR, BOUGH_COARSER_TIME};

// With steps as the companion's.
static bough_status build_coarser(bough_arena *arena, const bough_companion *c, int parts,
                                  bough_other_run *other) {
    BOUGH_TRY(bough_other_run_build(arena, c->run, parts, other));
    other->simulation->master->split = (parts & BOUGH_COARSER_TIME) && c->coarser.simulation->master->split;
    return bough_ok();
}

static void build_finer(bough_arena *arena, const finding *x, bough_other_run finer[BOUGH_SHARES]) {
    const bough_simulation *run = x->companion->run;
    for (int k = 0; k < BOUGH_SHARES; k++) {
        bough_error_share *share = &x->shares->share[k];
        if (!has_part(run->scene, k)) {
            snprintf(share->unknown, sizeof share->unknown, "the scene has no %s",
                     bough_error_share_name((bough_error_share_kind)k));
            continue;
        }
        bough_status status = build_coarser(arena, x->companion, BOUGH_COARSER_ALL & ~coarser[k], &finer[k]);
        if (!bough_is_ok(&status)) unknown(share, status.message);
    }
}

// As far as the base, with a run that is finer in part k.
static void advance_finer(const finding *x, int k, double t, const bough_other_run *base,
                          const bough_other_run *again, bough_other_run *finer, double part, double held) {
    bough_error_share *share = &x->shares->share[k];
    const bough_companion *c = x->companion;
    if (!finer->simulation || share->unknown[0]) return;
    bough_status own = advance(finer, fmin(t, x->end), x->left);
    if (!bough_is_ok(&own)) {
        unknown(share, own.message);
        return;
    }
    if (t < c->run->scene->simulation.output.from - 1e-6 * c->run->master->macro_step) return;
    bough_other_run_sample(finer);
    if (base->simulation) compare(base, finer, part, held, share->largest);
    if (again->simulation) compare(finer, again, c->share, c->share_held, share->others);
}

// Where the companion is lost, its failure ends no more than the comparison with it.
static bough_status step_base(const finding *x, bough_other_run *base, double *t) {
    const bough_simulation *s = base->simulation;
    bough_status status = s == NULL ? bough_ok() : step(s, x->left);
    if (s != NULL && bough_is_ok(&status)) {
        *t = s->master->time;
        bough_other_run_sample(base);
        return status;
    }
    *t += 2 * x->companion->run->master->macro_step;
    base->simulation = NULL;
    return x->lost ? bough_ok() : status;
}

static double time_share(const bough_companion *c) {
    return c->coarser.simulation->master->split ? bough_finer_time_share()
                                                : bough_coarser_time_share(c->run->scene);
}

// A run that fails leaves its share unknown.
static bough_status find(bough_arena *arena, void *self) {
    const finding *x = self;
    const bough_simulation *run = x->companion->run;
    const bough_scene *other = x->companion->coarser.simulation->scene;
    const double part[BOUGH_SHARES] = {[BOUGH_SHARE_MESH] = bough_coarser_share(run->scene, other),
                                       [BOUGH_SHARE_AIR] = bough_coarser_share(run->scene, run->scene),
                                       [BOUGH_SHARE_TIME] = time_share(x->companion)};
    // what is held longer than in the run is held so in two of the further runs as well
    const double held[BOUGH_SHARES] = {part[BOUGH_SHARE_MESH], x->companion->share_held,
                                       part[BOUGH_SHARE_TIME]};
    bough_other_run base, again = {0}, finer[BOUGH_SHARES] = {{0}};
    BOUGH_TRY(build_coarser(arena, x->companion, BOUGH_COARSER_ALL, &base));
    build_finer(arena, x, finer);
    if (has_time_alone(run->scene)) {
        memcpy(x->shares->share[BOUGH_SHARE_TIME].largest, x->companion->error,
               (size_t)x->shares->n_channel * sizeof(double));
        return bough_ok();
    }
    if (x->lost) BOUGH_TRY(bough_other_run_build(arena, run, 0, &again));
    bough_other_run_sample(&base);
    if (x->lost) bough_other_run_sample(&again);
    for (double t = 0;;) {
        for (int k = 0; k < BOUGH_SHARES; k++)
            advance_finer(x, k, t, &base, &again, &finer[k], part[k], held[k]);
        if (t >= x->end) return bough_ok();
        BOUGH_TRY(look_for_stop(x->stop));
        BOUGH_TRY(step_base(x, &base, &t));
        if (!x->lost) continue;
        BOUGH_TRY(advance(&again, fmin(t, x->end), x->left));
        bough_other_run_sample(&again);
    }
}

// -- a companion that has lost the solution -------------------------------------------------------

static const double lost = 0.25;     // of the range, which a companion errs by that has lost the solution
static const double much_less = 0.5; // of what the companion shows

// The two runs that differ least from the run itself; false: fewer are known.
static bool find_nearest(const bough_companion *c, const bough_error_shares *shares, int nearest[2],
                         double *relative) {
    double own[2] = {HUGE_VAL, HUGE_VAL};
    for (int k = 0; k < BOUGH_SHARES; k++) {
        if (shares->share[k].unknown[0]) continue;
        bough_error_verdict v = bough_error_verdict_of(c, true, shares->share[k].others);
        double next = v.channel < 0 ? 0 : v.relative;
        int place = next < own[0] ? 0 : 1;
        if (next >= own[1]) continue;
        if (place == 0) own[1] = own[0], nearest[1] = nearest[0];
        own[place] = next, nearest[place] = k;
    }
    *relative = own[0] + own[1];
    return isfinite(*relative);
}

// Of the two runs that show least of a channel's error, the sum; HUGE_VAL: fewer are known.
static double least_sum(const bough_error_shares *shares, int channel) {
    double sum = 0, most = 0;
    int known = 0;
    for (int k = 0; k < BOUGH_SHARES; k++) {
        if (shares->share[k].unknown[0]) continue;
        known++;
        sum += shares->share[k].others[channel];
        most = fmax(most, shares->share[k].others[channel]);
    }
    return known == BOUGH_SHARES ? sum - most : known == 2 ? sum : HUGE_VAL;
}

static void lower(bough_companion *c, bough_error_shares *shares, int i, double sum) {
    sum = fmax(sum, c->least[i]);
    // a companion that ended knows nothing of what came later, the two others do
    c->error[i] = c->reason[0] ? sum : fmin(c->error[i], sum);
    for (int k = 0; k < BOUGH_SHARES; k++)
        shares->share[k].largest[i] = fmin(shares->share[k].largest[i], sum);
}

// Blades that flutter in the companion show in some channels alone.
static void lower_some(bough_companion *c, bough_error_shares *shares) {
    for (int i = 0; i < c->channels->count; i++) {
        double sum = least_sum(shares, i);
        if (sum <= much_less * c->error[i]) lower(c, shares, i, sum);
    }
}

static void lower_errors(bough_companion *c, bough_error_shares *shares) {
    int nearest[2] = {0};
    double relative, whole = bough_error_verdict_of(c, true, c->error).relative;
    bool less = find_nearest(c, shares, nearest, &relative) && relative <= much_less * whole;
    for (int i = 0; less && i < c->channels->count; i++)
        lower(c, shares, i, shares->share[nearest[0]].others[i] + shares->share[nearest[1]].others[i]);
    if (less)
        c->reason[0] = 0;
    else if (c->flutters && !c->reason[0])
        lower_some(c, shares);
}

// -- steps and samples that a companion finds too long --------------------------------------------

typedef struct proof {
    const finding *of;
    bough_error_share_kind kind; // time or air
    bool others_known;
    double *own, *others; // (n_channel) largest errors: of that kind; of the two other kinds
} proof;

// A run that is finer in that kind alone, and its part of the difference to it that a run errs by.
static bough_status build_proof(bough_arena *arena, const proof *x, bough_other_run *finer, double *part) {
    const bough_simulation *run = x->of->companion->run;
    bool air = x->kind == BOUGH_SHARE_AIR;
    *part = air ? bough_finer_air_share(run->scene) : bough_finer_time_share();
    return bough_other_run_build(arena, run, air ? BOUGH_FINER_AIR : BOUGH_FINER_TIME, finer);
}

// The run once more, beside one that is finer in one kind and, where these are not known, one that is coarser
// in the two others alone.
static bough_status prove(bough_arena *arena, void *self) {
    const proof *x = self;
    const finding *of = x->of;
    const bough_companion *c = of->companion;
    const bough_simulation *run = c->run;
    double from = run->scene->simulation.output.from - 1e-6 * run->master->macro_step, part;
    bough_other_run r[3];
    int n = x->others_known ? 2 : 3;
    BOUGH_TRY(bough_other_run_build(arena, run, 0, &r[0]));
    BOUGH_TRY(build_proof(arena, x, &r[1], &part));
    if (n > 2) BOUGH_TRY(build_coarser(arena, c, BOUGH_COARSER_ALL & ~coarser[x->kind], &r[2]));
    for (double t = 0;; t = r[0].simulation->master->time) {
        for (int k = 0; k < n; k++) {
            BOUGH_TRY(advance(&r[k], t, of->left));
            bough_other_run_sample(&r[k]);
        }
        if (t >= from) compare(&r[0], &r[1], part, part, x->own);
        if (t >= from && n > 2) compare(&r[2], &r[0], c->share, c->share_held, x->others);
        if (t >= of->end) return bough_ok();
        BOUGH_TRY(look_for_stop(of->stop));
        BOUGH_TRY(step(r[0].simulation, of->left));
    }
}

// A companion's longer steps and rarer samples can err by far more than the share of the difference that is
// the run's. Before the run fails by its own, finer ones are to show that they err. BOUGH_INTERRUPTED by
// stop().
static bough_status prove_kind(bough_arena *arena, const finding *x, bough_error_share_kind kind) {
    bough_companion *c = x->companion;
    size_t n = (size_t)c->channels->count;
    const bough_error_share *found = &x->shares->share[kind];
    proof p = {x, kind, has_time_alone(c->run->scene) || (x->lost && !found->unknown[0]), NULL,
               found->others};
    bough_arena_each(arena, n + 1, &p.own);
    bough_status status = bough_arena_use(prove, &p);
    if (status.code == BOUGH_INTERRUPTED) return status;
    for (size_t i = 0; i < n && bough_is_ok(&status); i++) {
        for (int k = 0; k < BOUGH_SHARES; k++) {
            double *share = &x->shares->share[k].largest[i];
            *share = fmin(*share, k == (int)kind ? p.own[i] : p.others[i]);
        }
        c->error[i] = fmax(fmin(c->error[i], p.own[i] + p.others[i]), c->least[i]);
    }
    return bough_ok();
}

// -- causes ---------------------------------------------------------------------------------------

// Whether the error of a motion is above the bound.
static bool exceeds(const bough_companion *c, double bound) {
    bough_error_verdict v = bough_error_verdict_of(c, true, c->error);
    return bound > 0 && v.channel >= 0 && v.relative > bound;
}

// The largest share; the mesh only if time and air alone stay below the bound. Negative: not known.
static int cause_of(const bough_companion *c, const bough_error_shares *shares, double bound,
                    double *relative) {
    int cause = -1;
    *relative = 0;
    for (int k = 0; k < BOUGH_SHARES; k++) {
        const bough_error_share *share = &shares->share[k];
        if (share->unknown[0]) continue;
        bough_error_verdict v = bough_error_verdict_of(c, true, share->largest);
        double own = v.channel < 0 ? 0 : v.relative;
        bool before = cause == BOUGH_SHARE_MESH && own > bound;
        if (!before && own <= *relative) continue;
        cause = k;
        *relative = own;
    }
    bool time_unknown = shares->share[BOUGH_SHARE_TIME].unknown[0];
    return cause == BOUGH_SHARE_MESH && time_unknown ? -1 : cause;
}

// An error of a part of the range, above the bound, or blades that flutter in it alone: the companion may
// have lost the solution.
static bool has_lost(const bough_companion *c) {
    double bound = c->run->scene->simulation.error_bound;
    return bound > 0 && exceeds(c, c->flutters ? bound : fmax(bound, lost));
}

// Time, air, or −1: the error is within the bound, or the mesh's, or its cause is not known.
static int fails_by(const bough_companion *c, const bough_error_shares *shares) {
    double relative, bound = c->run->scene->simulation.error_bound;
    int cause = exceeds(c, bound) ? cause_of(c, shares, bound, &relative) : -1;
    return cause == BOUGH_SHARE_MESH ? -1 : cause;
}

// Whichever of time and air the run fails by, and the other where it fails by that then.
static bough_status prove_causes(bough_arena *arena, const finding *x) {
    bool proved[BOUGH_SHARES] = {false};
    for (;;) {
        int kind = fails_by(x->companion, x->shares);
        if (kind < 0 || proved[kind]) return bough_ok();
        BOUGH_TRY(prove_kind(arena, x, (bough_error_share_kind)kind));
        proved[kind] = true;
    }
}

bough_status bough_error_shares_find(bough_arena *arena, bough_companion *c, bool (*stop)(void),
                                     bough_error_shares *shares) {
    double end = c->run->scene->simulation.duration - 1e-6 * c->run->master->macro_step;
    double left = 0;
    finding x = {c, has_lost(c), stop, end, &left, shares};
    double cpu = bough_cpu_clock(false);
    *shares = (bough_error_shares){.found = true, .n_channel = c->channels->count};
    for (int k = 0; k < BOUGH_SHARES; k++)
        bough_arena_each(arena, (size_t)c->channels->count + 1, &shares->share[k].largest,
                         &shares->share[k].others);
    bough_status status = bough_ok();
    if (!c->coarser.simulation) {
        status = bough_fail(BOUGH_FAILED, "%s", c->reason);
    } else if (c->run->input) {
        status = bough_fail(BOUGH_FAILED, "the run has inputs, whose values are no longer known");
    } else {
        left = most_times * bough_companion_work(c) + little;
        status = bough_arena_use(find, &x);
    }
    if (status.code == BOUGH_INTERRUPTED) return status;
    if (bough_is_ok(&status) && x.lost) lower_errors(c, shares);
    if (bough_is_ok(&status)) BOUGH_TRY(prove_causes(arena, &x));
    shares->cpu_s = bough_cpu_clock(false) - cpu;
    for (int k = 0; k < BOUGH_SHARES && !bough_is_ok(&status); k++)
        unknown(&shares->share[k], status.message);
    return bough_ok();
}

// -- remedies -------------------------------------------------------------------------------------

enum { ADVICE = 160 };
static const double mesh_order = 2, air_order = 2, time_order = 2; // at least
static const double few_order = 1.5;                               // of a mesh of few segments
enum { FEW = 9, MOST_TIMES = 10 };     // more than so many times as many segments: the order says nothing
static const double most_halvings = 6; // of the macro step that are worth trying
static const double margin = 1.1;      // of the settings that are proposed

// The segments that divide the mesh's error by a factor: their number where all rods have the same.
static void advise_mesh(const bough_scene *scene, double factor, char text[ADVICE]) {
    int n = 0, least = FEW;
    bool equal = true;
    for (int i = 0; i < scene->n_body; i++) {
        if (!bough_scene_has_mesh(&scene->body[i])) continue;
        equal = equal && (n == 0 || n == scene->body[i].rod.n_segment);
        n = scene->body[i].rod.n_segment;
        least = n < least ? n : least;
    }
    double times = margin * pow(factor, 1 / (least < FEW ? few_order : mesh_order));
    times = fmin(times, MOST_TIMES);
    if (equal) {
        snprintf(text, ADVICE, "rod.segments: %.0f", ceil(times * n));
    } else {
        snprintf(text, ADVICE, "%.2g times as many rod.segments", times);
    }
}

// Doubled until it suffices; a sample of the air needs a macro step of its own.
static void advise_air(const bough_scene *scene, double factor, char text[ADVICE]) {
    double times = exp2(ceil(log2(pow(factor, 1 / air_order)))), rate = times * scene->aero.rate;
    int n = snprintf(text, ADVICE, "aero.rate: %.4g Hz", rate);
    if (rate * scene->simulation.macro_step > 1 + 1e-9)
        snprintf(text + n, (size_t)(ADVICE - n), " with macro_step: %.4g s", 1 / rate);
}

static void advise_time(const bough_scene *s, double factor, char text[ADVICE]) {
    const bough_scene_simulation *x = &s->simulation;
    const bough_scheme *scheme = bough_scheme_at(x->coupling.scheme);
    double shorter = pow(factor, -1 / time_order) / margin;
    if (!scheme->one_system) {
        double halvings =
            ceil(log2(margin * factor) / bough_scheme_defect_order(scheme, &x->coupling.options));
        int n = snprintf(text, ADVICE, "scheme: %s", BOUGH_SCHEME_DEFAULT);
        if (halvings <= most_halvings)
            snprintf(text + n, (size_t)(ADVICE - n), " or macro_step: %.9g s",
                     x->macro_step * exp2(-halvings));
    } else if (x->master.solver == BOUGH_GENERALIZED_ALPHA) {
        double step = x->master.step > 0 ? fmin(x->master.step, x->macro_step) : x->macro_step;
        snprintf(text, ADVICE, "master.step: %.2g s or master.solver: rosenbrock", shorter * step);
    } else {
        int n = snprintf(text, ADVICE, "master.rtol: %.1g", 0.5 * x->master.rtol / fmin(factor, 1e3));
        if (x->master.step > 0)
            snprintf(text + n, (size_t)(ADVICE - n), " and master.step: %.2g s", shorter * x->master.step);
    }
}

static void advise(const bough_scene *scene, int kind, double factor, char text[ADVICE]) {
    if (kind == BOUGH_SHARE_MESH) advise_mesh(scene, factor, text);
    if (kind == BOUGH_SHARE_AIR) advise_air(scene, factor, text);
    if (kind == BOUGH_SHARE_TIME) advise_time(scene, factor, text);
}

static const char *cause_name(const bough_scene *scene, int kind) {
    if (kind == BOUGH_SHARE_MESH) return "the mesh";
    if (kind == BOUGH_SHARE_AIR) return "the sampling of the air";
    bool one_system = bough_scheme_at(scene->simulation.coupling.scheme)->one_system;
    return one_system ? "the integrator's steps" : "the coupling or the sub-solvers' steps";
}

static int describe(const bough_companion *c, const bough_error_verdict *v, char *text, size_t size) {
    char error[BOUGH_ERROR_SIZE];
    bough_error_size(c, v->channel, error);
    return snprintf(text, size, "%s errs by %s, noticeably from %.6g s on",
                    c->channels->channel[v->channel].name, error, v->time);
}

static bough_status judge_excess(const bough_companion *c, const bough_error_shares *shares, double bound,
                                 const bough_error_verdict *v, char warning[BOUGH_ERROR_WARNING]) {
    const bough_scene *scene = c->run->scene;
    char what[240], remedy[ADVICE];
    double relative;
    int cause = cause_of(c, shares, bound, &relative);
    describe(c, v, what, sizeof what);
    // what is not known to be right ends the run: the steps
    advise(scene, cause < 0 ? BOUGH_SHARE_TIME : cause, fmax(fmax(relative, v->relative) / bound, 1), remedy);
    if (cause < 0) {
        return bough_fail(BOUGH_FAILED,
                          "the error bound %.3g is exceeded: %s; the cause was not found: %s; try %s", bound,
                          what, shares->share[BOUGH_SHARE_TIME].unknown, remedy);
    }
    snprintf(warning, BOUGH_ERROR_WARNING, "%s; cause: %s; try %s", what, cause_name(scene, cause), remedy);
    if (cause == BOUGH_SHARE_MESH) return bough_ok();
    bough_status failed = bough_fail(BOUGH_FAILED, "the error bound %.3g is exceeded: %s", bound, warning);
    warning[0] = '\0';
    return failed;
}

// What each part may add to the error, over the accuracy: what the settings lead one to expect, at most the
// whole. Where that is less than the error, all parts are larger in proportion.
static void find_parts(const bough_scene_expectation *expected, double factor, double part[BOUGH_SHARES]) {
    double largest = 0;
    for (int k = 0; k < BOUGH_SHARES; k++) largest = fmax(largest, expected->error[k]);
    for (int k = 0; k < BOUGH_SHARES; k++)
        part[k] = fmin(factor, expected->error[k] * fmax(1, factor / largest));
}

// The settings that bring each part to half the accuracy: keys that the scene names, and the accuracy for
// others.
static void advise_for_accuracy(const bough_scene *scene, double factor, char *text, size_t size) {
    double part[BOUGH_SHARES], accuracy = 1;
    int n = 0;
    bough_scene_expectation expected = bough_scene_expect_errors(scene);
    find_parts(&expected, factor, part);
    for (int k = 0; k < BOUGH_SHARES; k++) {
        char remedy[ADVICE];
        if (part[k] <= 0.5) continue;
        if (expected.named[k]) {
            advise(scene, k, fmax(2 * part[k], 1), remedy);
            n += snprintf(text + n, size - (size_t)n, "%s%s", n > 0 ? " and " : "", remedy);
        } else {
            accuracy = fmin(accuracy, 0.5 / part[k]);
        }
    }
    if (accuracy == 1) return;
    snprintf(text + n, size - (size_t)n, "%ssimulation.accuracy: %.1g", n > 0 ? " and " : "",
             accuracy / margin * scene->simulation.accuracy);
}

static void warn_of_error(const bough_companion *c, const bough_error_verdict *v,
                          char warning[BOUGH_ERROR_WARNING]) {
    const bough_scene *scene = c->run->scene;
    double accuracy = scene->simulation.accuracy;
    int n = describe(c, v, warning, BOUGH_ERROR_WARNING);
    n += snprintf(warning + n, (size_t)(BOUGH_ERROR_WARNING - n),
                  "; to err by less than %.3g (simulation.accuracy) try ", accuracy);
    advise_for_accuracy(scene, v->relative / accuracy, warning + n, (size_t)(BOUGH_ERROR_WARNING - n));
}

bough_status bough_error_judge(bough_arena *arena, bough_companion *c, bool (*stop)(void), double bound,
                               bough_error_shares *shares, char warning[BOUGH_ERROR_WARNING]) {
    warning[0] = '\0';
    if (exceeds(c, bound) && !shares->found) BOUGH_TRY(bough_error_shares_find(arena, c, stop, shares));
    bough_error_verdict v = bough_error_verdict_of(c, true, c->error);
    if (c->compared > 0 && c->reason[0])
        snprintf(warning, BOUGH_ERROR_WARNING, "errors are not known from %.6g s on: %s", c->from, c->reason);
    if (v.channel < 0) return bough_ok();
    if (bound > 0 && v.relative > bound) return judge_excess(c, shares, bound, &v, warning);
    if (v.relative > c->run->scene->simulation.accuracy && !warning[0]) warn_of_error(c, &v, warning);
    return bough_ok();
}
