#include "apps/bough/model/error_verdict.h"

#include "apps/bough/model/companion.h"
#include "apps/bough/model/simulation.h"
#include "apps/bough/results/progress.h"
#include "cosim/scheme.h"

const char *bough_error_share_name(bough_error_share_kind kind) {
    static const char *const names[BOUGH_SHARES] = {"mesh", "air", "time"};
    return names[kind];
}

static void unknown(bough_error_share *share, const char *why) {
    snprintf(share->unknown, sizeof share->unknown, "%s", why);
}

// -- further runs ---------------------------------------------------------------------------------

static const double most_times = 5; // the work of the run and its companion, by all further runs together
static const double most_alone = 2; // the same by one that is coarser
static const double little = 1e4;   // µs more
static const double patience = 1e6; // µs of further runs, beyond which the verdict is enough

typedef struct finding {
    bough_companion *companion;
    bool lost; // the companion may have lost the solution
    bool (*stop)(void);
    double left, left_alone; // work of all, and of the present one
    bool confirmed;          // a finer run has shown enough of the error
    bough_error_shares *shares;
} finding;

// A difference between two solutions.
typedef struct between {
    double part;     // error of the run relative to it
    double held;     // the same for channels whose last sample is held longer
    double *largest; // (n_channel) the largest errors; NULL: not wanted
} between;

// A run that is coarser or finer in these parts, compared with the record of run and companion.
typedef struct further {
    finding *of;
    int parts;
    between to_companion, to_run;
    double *least; // (n_channel) for is_confirmed; NULL: coarser runs
} further;

enum { OWN_MESH = BOUGH_COARSER_ALL & ~BOUGH_COARSER_MESH };

// A macro step of a further run. Its work is limited: runs that need much more than the run and its companion
// follow another solution and may never end.
static bough_status step(finding *x, const bough_simulation *s) {
    double before = bough_simulation_work(s);
    if (x->stop && x->stop())
        return bough_fail(BOUGH_INTERRUPTED, "interrupted during the search for the cause of the error");
    BOUGH_TRY(bough_step(s->master));
    double work = bough_simulation_work(s) - before;
    x->left -= work, x->left_alone -= work;
    if (x->left >= 0 && x->left_alone >= 0) return bough_ok();
    return bough_fail(BOUGH_FAILED,
                      "further runs took more than %.0f times the work of this one and its companion",
                      x->left < 0 ? most_times : most_alone);
}

// Updates the largest differences by two samples. Samples after the end of the companion are NaN and do not
// count.
static void compare(const bough_channels *channels, const double *a, const double *b, bool held,
                    const between *x) {
    for (int i = 0; x->largest && i < channels->count; i++) {
        const bough_channel *channel = &channels->channel[i];
        double difference = bough_channel_difference(channel, a[i], b[i]);
        x->largest[i] =
            fmax(x->largest[i], (channel->sampled && held ? x->held : x->part) * fabs(difference));
    }
}

static bool is_one_system(const bough_scene *scene) {
    return bough_scheme_at(scene->simulation.coupling.scheme)->one_system;
}

static bool has_part(const bough_scene *scene, int kind) {
    if (kind == BOUGH_SHARE_TIME) return true;
    if (kind == BOUGH_SHARE_AIR) return scene->aero.node != NULL;
    for (int i = 0; i < scene->n_body; i++) {
        if (bough_scene_has_mesh(&scene->body[i])) return true;
    }
    return false;
}

// The largest error of a motion relative to its range.
static double largest_of(const bough_companion *c, const double *error) {
    bough_error_verdict v = bough_error_verdict_of(c, true, error);
    return v.channel < 0 ? 0 : v.relative;
}

static const double hardly = 0.25, hardly_yet = 0.05; // of the mesh's error

// Whether all parts but the mesh err by much less than it, and within the bound, to the end of the run.
static bool is_mostly_mesh(const bough_companion *c, const bough_error_shares *shares, double bound,
                           double much) {
    const bough_error_share *mesh = &shares->share[BOUGH_SHARE_MESH];
    if (mesh->unknown[0] || c->reason[0]) return false;
    return largest_of(c, mesh->others) <= fmin(bound, much * largest_of(c, mesh->largest));
}

// Whether the mesh causes the error and no other part is needed. The rest must be much smaller: the companion
// of a coupled run is monolithic, and errors may cancel.
static bool is_by_mesh(const finding *x, double much) {
    const bough_companion *c = x->companion;
    const bough_scene_simulation *s = &c->run->scene->simulation;
    if (s->error_shares || c->flutters) return false;
    return is_mostly_mesh(c, x->shares, s->error_bound, much);
}

// The same before the end, where the mesh's error is beyond the bound. Without air and coupling schemes a
// rest that is so small hardly grows faster than the mesh's error, so that both are extrapolated in
// proportion.
static bool is_by_mesh_early(finding *x) {
    const bough_scene *scene = x->companion->run->scene;
    bough_error_share *mesh = &x->shares->share[BOUGH_SHARE_MESH];
    double own = largest_of(x->companion, mesh->largest),
           whole = largest_of(x->companion, x->companion->error);
    double bound = scene->simulation.error_bound, grows = fmax(whole / own, 1);
    if (has_part(scene, BOUGH_SHARE_AIR) || !is_one_system(scene) || own <= bound ||
        !is_by_mesh(x, hardly_yet))
        return false;
    if (grows * largest_of(x->companion, mesh->others) > bound) return false;
    for (int i = 0; i < x->shares->n_channel; i++) {
        mesh->largest[i] = fmax(mesh->largest[i], x->companion->error[i]);
        mesh->others[i] *= grows;
    }
    return true;
}

static const double much_less = 0.5; // of the companion's error

// Whether a finer run has shown that the steps err by more than the bound, in every way in which the error is
// judged later, and by about as much as the companion says: its rest cannot change the verdict. Short
// searches go to their end, for a better estimate.
static bool is_confirmed(const further *f) {
    const bough_companion *c = f->of->companion;
    double taken = most_times * bough_companion_work(c) + little - f->of->left;
    const bough_scene *scene = c->run->scene;
    if (!f->least || taken < patience || has_part(scene, BOUGH_SHARE_AIR) || scene->simulation.error_shares)
        return false;
    for (int i = 0; i < c->channels->count; i++) {
        double share = f->of->shares->share[BOUGH_SHARE_TIME].largest[i];
        f->least[i] = fmin(f->to_run.largest[i], fmin(share, c->error[i]));
    }
    double least = largest_of(c, f->least);
    return least > scene->simulation.error_bound && least >= much_less * largest_of(c, c->error);
}

static bough_status run_beside(bough_arena *arena, void *self) {
    const further *f = self;
    const bough_record *record = &f->of->companion->record;
    bough_other_run other;
    BOUGH_TRY(bough_other_run_build(arena, f->of->companion->run, f->parts, &other));
    bough_master *m = other.simulation->master;
    m->split = (f->parts & BOUGH_COARSER_TIME) && f->of->companion->coarser.simulation->master->split;
    for (int k = 0; k < record->n; k++) {
        const double *row = record->row + (size_t)record->width * (size_t)k;
        const double *run = row + BOUGH_RECORD_RUN, *companion = run + other.channels.count;
        while (m->time < row[BOUGH_RECORD_TIME]) BOUGH_TRY(step(f->of, other.simulation));
        if (m->time != row[BOUGH_RECORD_TIME]) continue;
        bough_other_run_sample(&other);
        compare(&other.channels, companion, other.value, row[BOUGH_RECORD_HELD] != 0, &f->to_companion);
        compare(&other.channels, run, other.value, !bough_companion_air_sampled(other.simulation),
                &f->to_run);
        if (f->parts == OWN_MESH && is_by_mesh_early(f->of)) break;
        if ((f->of->confirmed = is_confirmed(f))) break;
    }
    return bough_ok();
}

// -- errors of mesh, air and time -----------------------------------------------------------------

static const int coarser[BOUGH_SHARES] = {BOUGH_COARSER_MESH, BOUGH_COARSER_AIR, BOUGH_COARSER_TIME};

static between between_companion_and(const bough_companion *c, int kind, double *largest) {
    const bough_scene *run = c->run->scene, *other = c->coarser.simulation->scene;
    double part = kind == BOUGH_SHARE_MESH               ? bough_coarser_ratio(run, other)
                  : kind == BOUGH_SHARE_AIR              ? bough_coarser_air_ratio(run, other)
                  : c->coarser.simulation->master->split ? bough_finer_time_ratio()
                                                         : bough_coarser_time_ratio(run);
    // channels that the companion holds longer are held longer in two of the further runs, too
    return (between){part, kind == BOUGH_SHARE_AIR ? c->ratio_held : part, largest};
}

// Error of the run over the difference to such a run. Beside the air of the run neither held loads nor jumps
// of the wind differ.
static double ratio_of_others(const bough_companion *c, int kind) {
    if (kind != BOUGH_SHARE_AIR) return c->ratio;
    return fmax(between_companion_and(c, BOUGH_SHARE_MESH, NULL).part,
                between_companion_and(c, BOUGH_SHARE_TIME, NULL).part);
}

// A run that is as fine as the run itself in one part differs from the companion by that part and from the
// run by the others. If it fails, that error is unknown. BOUGH_INTERRUPTED by stop().
static bough_status find_share(finding *x, int kind) {
    const bough_companion *c = x->companion;
    bough_error_share *share = &x->shares->share[kind];
    if (!has_part(c->run->scene, kind)) {
        snprintf(share->unknown, sizeof share->unknown, "the scene has no %s",
                 bough_error_share_name((bough_error_share_kind)kind));
        return bough_ok();
    }
    x->left_alone = most_alone * bough_companion_work(c) + little;
    further f = {x, BOUGH_COARSER_ALL & ~coarser[kind], between_companion_and(c, kind, share->largest),
                 (between){ratio_of_others(c, kind), c->ratio_held, share->others}, NULL};
    bough_status status = bough_arena_use(run_beside, &f);
    if (status.code == BOUGH_INTERRUPTED) return status;
    if (!bough_is_ok(&status)) unknown(share, status.message);
    return bough_ok();
}

// The mesh first: that run is the cheapest, and often the only one.
static bough_status find(finding *x) {
    const bough_companion *c = x->companion;
    bough_error_share *share = x->shares->share;
    bough_error_share *mesh = &share[BOUGH_SHARE_MESH], *time = &share[BOUGH_SHARE_TIME];
    size_t size = (size_t)x->shares->n_channel * sizeof(double);
    bool air = has_part(c->run->scene, BOUGH_SHARE_AIR);
    BOUGH_TRY(find_share(x, BOUGH_SHARE_MESH));
    if (!air) BOUGH_TRY(find_share(x, BOUGH_SHARE_AIR));
    if (!air && !has_part(c->run->scene, BOUGH_SHARE_MESH)) {
        memcpy(share[BOUGH_SHARE_TIME].largest, c->error, size);
        return bough_ok();
    }
    bool alone = is_by_mesh(x, hardly);
    if (air && !alone) BOUGH_TRY(find_share(x, BOUGH_SHARE_AIR));
    if (!alone) BOUGH_TRY(find_share(x, BOUGH_SHARE_TIME));
    // with two parts each is the remainder of the other
    bool other_fails = !air && !c->reason[0] && time->unknown[0] && !mesh->unknown[0];
    if (alone || other_fails) {
        memcpy(time->largest, mesh->others, size);
        memcpy(time->others, mesh->largest, size);
        time->unknown[0] = '\0';
    }
    if (alone && air) unknown(&share[BOUGH_SHARE_AIR], "it is in that of time");
    return bough_ok();
}

// -- a companion that has lost the solution -------------------------------------------------------

static const double lost = 0.25; // of the range, errors of a companion that may have lost the solution

// The two further runs that differ least from the run; false: fewer are known.
static bool find_nearest(const bough_companion *c, const bough_error_shares *shares, int nearest[2],
                         double *relative) {
    double own[2] = {HUGE_VAL, HUGE_VAL};
    for (int k = 0; k < BOUGH_SHARES; k++) {
        if (shares->share[k].unknown[0]) continue;
        double next = largest_of(c, shares->share[k].others);
        int place = next < own[0] ? 0 : 1;
        if (next >= own[1]) continue;
        if (place == 0) own[1] = own[0], nearest[1] = nearest[0];
        own[place] = next, nearest[place] = k;
    }
    *relative = own[0] + own[1];
    return isfinite(*relative);
}

// The sum of the two smallest errors of a channel in the further runs; HUGE_VAL: fewer are known.
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
    // after the end of the companion only the further runs measure errors
    c->error[i] = c->reason[0] ? sum : fmin(c->error[i], sum);
    for (int k = 0; k < BOUGH_SHARES; k++)
        shares->share[k].largest[i] = fmin(shares->share[k].largest[i], sum);
}

// Blades that flutter in the companion affect only some channels.
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

// The error of a companion by longer steps and a lower sampling rate can be far more than the assumed
// multiple of the run's. Before a run fails, a run that is finer in that part alone must confirm its error.
// BOUGH_INTERRUPTED by stop().
static bough_status prove_kind(bough_arena *arena, finding *x, bough_error_share_kind kind) {
    bough_companion *c = x->companion;
    size_t n = (size_t)c->channels->count;
    bool air = kind == BOUGH_SHARE_AIR;
    double *own = bough_arena_doubles(arena, n + 1), *others = x->shares->share[kind].others;
    double part = air ? bough_finer_air_ratio(c->run->scene) : bough_finer_time_ratio();
    further f = {.of = x,
                 .parts = air ? BOUGH_FINER_AIR : BOUGH_FINER_TIME,
                 .to_run = {part, part, own},
                 .least = bough_arena_doubles(arena, n + 1)};
    x->left_alone = x->left;
    bough_status status = bough_arena_use(run_beside, &f);
    if (status.code == BOUGH_INTERRUPTED) return status;
    for (size_t i = 0; i < n && bough_is_ok(&status); i++) {
        if (x->confirmed) own[i] = HUGE_VAL; // its largest errors are not known
        for (int k = 0; k < BOUGH_SHARES; k++) {
            double *share = &x->shares->share[k].largest[i];
            *share = fmin(*share, k == (int)kind ? own[i] : others[i]);
        }
        c->error[i] = fmax(fmin(c->error[i], own[i] + others[i]), c->least[i]);
    }
    return bough_ok();
}

// -- causes ---------------------------------------------------------------------------------------

// Whether the error of a motion exceeds the bound.
static bool exceeds(const bough_companion *c, double bound) {
    bough_error_verdict v = bough_error_verdict_of(c, true, c->error);
    return bound > 0 && v.channel >= 0 && v.relative > bound;
}

// The part with the largest error; the mesh only if time and air stay below the bound. Negative: not known.
static int cause_of(const bough_companion *c, const bough_error_shares *shares, double bound,
                    double *relative) {
    int cause = -1;
    *relative = 0;
    for (int k = 0; k < BOUGH_SHARES; k++) {
        const bough_error_share *share = &shares->share[k];
        if (share->unknown[0]) continue;
        double own = largest_of(c, share->largest);
        bool before = cause == BOUGH_SHARE_MESH && own > bound;
        if (!before && own <= *relative) continue;
        cause = k;
        *relative = own;
    }
    bool time_unknown =
        shares->share[BOUGH_SHARE_TIME].unknown[0] && !is_mostly_mesh(c, shares, bound, hardly);
    return cause == BOUGH_SHARE_MESH && time_unknown ? -1 : cause;
}

// Whether the companion may have lost the solution: its error is a large fraction of the range and above the
// bound, or blades flutter in it alone.
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

// Confirms time or air, by which the run fails, then the other if the run still fails.
static bough_status prove_causes(bough_arena *arena, finding *x) {
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
    finding x = {.companion = c,
                 .lost = has_lost(c),
                 .stop = stop,
                 .left = most_times * bough_companion_work(c) + little,
                 .shares = shares};
    double cpu = bough_cpu_clock(false);
    *shares = (bough_error_shares){.found = true, .n_channel = c->channels->count};
    for (int k = 0; k < BOUGH_SHARES; k++)
        bough_arena_each(arena, (size_t)c->channels->count + 1, &shares->share[k].largest,
                         &shares->share[k].others);
    bough_status status = bough_ok();
    if (c->run->input)
        status = bough_fail(BOUGH_FAILED, "the run has inputs, whose values are no longer known");
    else if (!c->coarser.simulation || (c->reason[0] && !x.lost))
        status = bough_fail(BOUGH_FAILED, "%s", c->reason);
    else
        status = find(&x);
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
enum { FEW = 9, MOST_TIMES = 10 };    // beyond this multiple of the segments the order is no guide
static const double margin = 1.1;     // of the settings that are proposed
static const double shortened = 0.75; // fixed steps: large errors fall less than at their order

// The number of segments that divides the mesh's error by a factor, if all rods have the same; otherwise the
// multiple.
static void advise_mesh(const bough_scene *scene, double factor, char *text) {
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

// All bodies as one system, by a solver that suits it. Shorter macro steps are no sure remedy: beside a light
// carrier the error falls at a lower order than the scheme has.
static int advise_one_system(const bough_scene *scene, char *text, size_t size) {
    return snprintf(text, size, "scheme: %s%s", BOUGH_SCHEME_DEFAULT,
                    bough_coarser_is_too_large(scene) ? " with master.solver: automatic" : "");
}

static void advise_time(const bough_scene *s, double factor, char text[ADVICE]) {
    const bough_scene_simulation *x = &s->simulation;
    double shorter = pow(factor, -1 / time_order) / margin;
    if (!is_one_system(s)) {
        advise_one_system(s, text, ADVICE);
    } else if (x->master.solver == BOUGH_GENERALIZED_ALPHA) {
        double step = x->master.step > 0 ? fmin(x->master.step, x->macro_step) : x->macro_step;
        snprintf(text, ADVICE, "master.step: %.2g s or master.solver: rosenbrock",
                 shortened * shorter * step);
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
    return is_one_system(scene) ? "the integrator's steps" : "the coupling or the sub-solvers' steps";
}

static int describe(const bough_companion *c, const bough_error_verdict *v, char *text, size_t size) {
    char error[BOUGH_ERROR_SIZE];
    bough_error_size(c, v->channel, error);
    return snprintf(text, size, "%s errs by %s, noticeably from %.6g s on",
                    c->channels->channel[v->channel].name, error, v->time);
}

// The largest error of the mesh; 0: not known.
static double mesh_error(const bough_companion *c, const bough_error_shares *shares) {
    const bough_error_share *share = &shares->share[BOUGH_SHARE_MESH];
    return share->unknown[0] ? 0 : largest_of(c, share->largest);
}

static bough_status judge_excess(const bough_companion *c, const bough_error_shares *shares, double bound,
                                 const bough_error_verdict *v, char warning[BOUGH_ERROR_WARNING]) {
    const bough_scene *scene = c->run->scene;
    char what[240], remedy[2 * ADVICE + 8];
    double relative, mesh = mesh_error(c, shares);
    int cause = cause_of(c, shares, bound, &relative);
    describe(c, v, what, sizeof what);
    // without a known cause the run fails by its steps
    double own = cause < 0 || relative <= bound ? v->relative : relative;
    advise(scene, cause < 0 ? BOUGH_SHARE_TIME : cause, fmax(own / bound, 1), remedy);
    if (cause >= 0 && cause != BOUGH_SHARE_MESH && mesh > bound) {
        size_t length = strlen(remedy), more = (size_t)snprintf(remedy + length, ADVICE, " and ");
        advise_mesh(scene, mesh / bound, remedy + length + more);
    }
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

// Errors of the parts relative to the accuracy: those expected from the settings, at most the whole error,
// and scaled up if the largest is smaller than the error.
static void find_parts(const bough_scene_expectation *expected, double factor, double part[BOUGH_SHARES]) {
    double largest = 0;
    for (int k = 0; k < BOUGH_SHARES; k++) largest = fmax(largest, expected->error[k]);
    for (int k = 0; k < BOUGH_SHARES; k++)
        part[k] = fmin(factor, expected->error[k] * fmax(1, factor / largest));
}

// The settings that reduce each part to half the accuracy: keys that the scene names, or else the accuracy.
static void advise_settings(const bough_scene *scene, double factor, char *text, size_t size) {
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

// No setting but the scheme follows from the error of a coupling, which is not known beside the others.
static void advise_for_accuracy(const bough_scene *scene, double factor, char *text, size_t size) {
    if (is_one_system(scene))
        advise_settings(scene, factor, text, size);
    else
        advise_one_system(scene, text, size);
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
