#include "apps/bough/model/companion.h"

#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/control_link.h"
#include "apps/bough/model/equilibrium_search.h"
#include "apps/bough/model/error_verdict.h"
#include "apps/bough/model/simulation.h"
#include "apps/bough/model/validity.h"
#include "cosim/scheme.h"

#include <limits.h>

// -- building -------------------------------------------------------------------------------------

static void take(bough_companion *c, bough_arena *arena) {
    size_t n = (size_t)c->channels->count + 1;
    bough_arena_each(arena, n, &c->value, &c->before, &c->error, &c->shown, &c->least, &c->grown, &c->low,
                     &c->high, &c->other_low, &c->other_high, &c->noticed);
    for (size_t i = 0; i < n; i++) {
        c->low[i] = c->other_low[i] = HUGE_VAL;
        c->high[i] = c->other_high[i] = -HUGE_VAL;
        c->noticed[i] = -1;
    }
}

// Inputs are not stored, so that a run with inputs cannot be repeated.
static void take_record(bough_companion *c, bough_arena *arena) {
    const bough_scene_simulation *s = &c->run->scene->simulation;
    if (c->run->input || !(s->error_bound > 0 || s->error_shares)) return;
    c->record = (bough_record){.width = BOUGH_RECORD_RUN + 2 * c->channels->count, .shared = 1};
    c->record.row = bough_arena_doubles(arena, (size_t)BOUGH_RECORD_MOST * (size_t)c->record.width);
}

static void give_up(bough_companion *c, const char *reason) {
    snprintf(c->reason, sizeof c->reason, "%s", reason);
    c->from = c->run->master->time;
}

// Greatest age of a sample that the run shows at a synchronisation point, over the time between two samples.
static double ratio_held(const bough_scene *scene) {
    double rate = scene->aero.node ? scene->aero.rate : scene->control.node ? scene->control.rate : 0;
    return fmax(1 - rate * scene->simulation.macro_step, 0);
}

static const bough_wind *wind_of(const bough_simulation *s) {
    return bough_rotor_wind(bough_aero_link_rotor(s->aero));
}

static void expect_jumps(bough_companion *c) {
    c->jump = c->run->aero ? bough_wind_jump(wind_of(c->run), 1 / c->run->scene->aero.rate, 0) : -1;
}

static bough_status build(bough_arena *arena, bough_companion *c) {
    BOUGH_TRY(bough_other_run_build(arena, c->run, BOUGH_COARSER_ALL, &c->coarser));
    for (int k = 0; k < BOUGH_COMPANION_ROWS; k++)
        c->row[k].value = bough_arena_doubles(arena, (size_t)c->channels->count + 1);
    BOUGH_TRY(bough_finer_build(arena, c->run, &c->finer));
    const bough_scene *scene = c->run->scene, *other = c->coarser.simulation->scene;
    c->ratio = fmax(bough_coarser_ratio(scene, other), bough_coarser_air_ratio(scene, other));
    if (bough_coarser_is_loose(scene)) c->ratio = fmax(c->ratio, bough_finer_time_ratio());
    c->ratio_held = ratio_held(scene);
    take_record(c, arena);
    expect_jumps(c);
    return bough_ok();
}

// Takes the channels of both into their ranges.
static void widen(int n, const double *value, double *low, double *high) {
    for (int i = 0; i < n; i++) {
        low[i] = value[i] < low[i] ? value[i] : low[i];
        high[i] = value[i] > high[i] ? value[i] : high[i];
    }
}

static void sample(bough_companion *c) {
    bough_simulation_update(c->run);
    bough_channels_sample(c->channels, c->run->master->time, c->value);
    widen(c->channels->count, c->value, c->low, c->high);
    widen(c->channels->count, c->coarser.value, c->other_low, c->other_high);
}

// Times before simulation.output.from do not count, as in the statistics.
static bool counts_now(const bough_companion *c, const bough_simulation *of) {
    const bough_scene_simulation *s = &c->run->scene->simulation;
    return of->master->time >= s->output.from - 1e-6 * s->macro_step;
}

// -- stepping -------------------------------------------------------------------------------------

static bool alive(const bough_companion *c) { return c->coarser.simulation && !c->reason[0]; }

static const bough_companion_row *last(const bough_companion *c) { return &c->row[c->n_row - 1]; }

bool bough_companion_due(const bough_companion *c) {
    return alive(c) && bough_is_ok(&c->status) && last(c)->time <= c->run->master->time &&
           !bough_master_done(c->coarser.simulation->master);
}

// Whether the companion is where a macro step of the run ends. Between these, at corners of loads and
// motions, the run shows no values.
static bool meets_run(const bough_companion *c) {
    const bough_master *m = c->coarser.simulation->master;
    double step = c->run->scene->simulation.macro_step;
    return bough_master_done(m) || fabs(remainder(m->time, step)) < 1e-6 * step;
}

bool bough_companion_air_sampled(const bough_simulation *s) {
    return !s->aero || fabs(remainder(s->master->time * s->scene->aero.rate, 1)) < 1e-6;
}

static double missed_air(const bough_simulation *s) {
    double missed = 0;
    for (int b = 0; s->aero && b < s->scene->turbine.n_blade; b++)
        missed = fmax(missed, bough_aero_link_missed(s->aero, b));
    return missed;
}

static void take_row(bough_companion *c) {
    bough_simulation *s = c->coarser.simulation;
    bough_companion_row *row = &c->row[c->n_row++];
    row->time = s->master->time;
    row->sampled = bough_master_sampled(s->master);
    row->air_sampled = bough_companion_air_sampled(s);
    row->missed_air = missed_air(s);
    row->work = bough_simulation_work(s);
    c->coarser.value = row->value;
    if (counts_now(c, s)) bough_other_run_sample(&c->coarser);
}

enum { MANY = 8 }; // steps of the run, and corners among them

static bool has_equal_steps(const bough_companion *c) {
    return c->run->scene->aero.node == NULL &&
           c->coarser.simulation->master->macro_step == c->run->master->macro_step;
}

// Whether a comparison may yet split the steps of the companion: see split_steps.
static bool may_split(const bough_companion *c) {
    bool may = c->run->master->n_event >= MANY || bough_coarser_is_loose(c->run->scene) || has_equal_steps(c);
    return may && !c->coarser.simulation->master->split;
}

// Whether a joint has just touched one of its stops or will within a macro step.
static bool strikes(const bough_simulation *s) {
    for (int i = 0; i < s->scene->n_body; i++) {
        const bough_joint_spring *x = &s->scene->body[i].joint.spring;
        if (!(x->stop_stiffness > 0)) continue;
        bough_motion_point now = bough_simulation_joint_point(s, i);
        double reach = fabs(now.v) * s->master->macro_step;
        if (now.q - reach < x->low || now.q + reach > x->high) return true;
    }
    return false;
}

void bough_companion_step(bough_companion *c, bool ahead) {
    const bough_master *m = c->coarser.simulation->master;
    bool alone = c->run->scene->n_input == 0 && !may_split(c); // its steps need nothing of the run
    int most = ahead && alone ? BOUGH_COMPANION_ROWS : 1;
    c->n_row = c->present = 0;
    while (c->n_row < most && bough_is_ok(&c->status) && !bough_master_done(m)) {
        do {
            // a contact may be over within its macro step
            c->coarser.simulation->master->halve = strikes(c->coarser.simulation);
            c->status = bough_other_run_step(&c->coarser, c->run);
        } while (bough_is_ok(&c->status) && !meets_run(c));
        if (bough_is_ok(&c->status)) take_row(c);
    }
}

// -- comparing ------------------------------------------------------------------------------------

// A force of a body with a mesh follows accelerations, whose errors are of a lower order.
static const double least_ratio_of_force = 0.4;

// Largest error of the air's loads between two samples. With a larger one the period of vibrations is near
// that of the samples, and at half the sampling rate the error is no multiple of the run's.
static const double most_missed = 0.1;
static const double fluttering = 0.3; // with a larger error the air feeds the vibrations
// Times what the run's samples miss: at half the rate errors of order 2 are four times as large.
static const double far_more = 20;

// Whether vibrations grow in the companion alone.
static bool flutters(double run, double companion) {
    double most = fmax(fmin(far_more * run, fluttering), most_missed);
    return run <= most_missed && companion > most;
}

// 1/Q of a channel. A sampled channel that the companion holds one sample longer differs by the change in
// that time.
static double ratio_of(const bough_companion *c, const bough_channel *channel, double ratio, bool held) {
    if (channel->sampled == BOUGH_BY_TIME) return 0; // a jump may come later in the companion
    if (channel->sampled) return held ? c->ratio_held : ratio;
    bool follows = channel->kind == BOUGH_KIND_FORCE && !bough_coarser_steps_alone(c->run->scene);
    return follows ? fmax(ratio, least_ratio_of_force) : ratio;
}

// The length of a vector's components from the channel `first` on.
static double length_from(const bough_companion *c, int first, const double *value) {
    const bough_channel *list = c->channels->channel;
    double square = 0;
    for (int k = first; k < c->channels->count && list[k].vector == list[first].vector; k++)
        square += value[k] * value[k];
    return sqrt(square);
}

static double change_from(const bough_companion *c, int first) {
    return fabs(length_from(c, first, c->value) - length_from(c, first, c->before));
}

// Change of a channel since the last comparison. In rotating axes the components of a vector change without a
// new sample; they count at most by the change of the vector's length, and those normal to x, about which a
// rotor turns, at most by the change of their own.
static double change_of(const bough_companion *c, int i) {
    const bough_channel *list = c->channels->channel;
    int x = list[i].vector;
    double change = fabs(bough_channel_difference(&list[i], c->value[i], c->before[i]));
    bool component = x != i || (i + 1 < c->channels->count && list[i + 1].vector == i);
    if (!component) return change;
    change = fmin(change, change_from(c, x));
    return x == i ? change : fmin(change, change_from(c, x + 1));
}

// Error of a sampled channel just before the next sample: both solutions may hold it during the same change.
// If both have the same bits, the value depends on time alone and is not held.
static double stale(const bough_companion *c, int i) {
    const bough_channel *channel = &c->channels->channel[i];
    bool held = channel->sampled == BOUGH_BY_AIR && c->compared > 1 && c->value[i] != c->coarser.value[i];
    return held ? c->ratio_held * change_of(c, i) : 0;
}

// Whether the channel is a quotient whose divisor may pass zero within its error: it may have any value.
static bool may_be_singular(const bough_companion *c, int i) {
    int divisor = i - c->channels->channel[i].divisor;
    return divisor != i && c->error[divisor] > fabs(c->value[divisor]) / 2;
}

// Whether an error is noticeable and more than a quarter of the channel's largest so far; not in a scene at
// rest, whose forces differ by rounding.
static bool is_large(const bough_companion *c, int i, double error) {
    double accuracy = c->run->scene->simulation.accuracy;
    return error > 0.25 * c->error[i] && error > 0.1 * accuracy * bough_error_range(c, i) &&
           bough_error_counts(c, i) && c->rest == 0;
}

static const double most_growth = 2;   // of an error since the finer solution ended
static const double least_shown = 0.5; // of an error, where the companion goes on to show it

// Errors that grew in the second half of what the finer solution followed, until it would have taken too much
// work, grow on in proportion to time, up to half the channel's range: that of a vibration that decays.
// Beyond twice their size they may grow unseen, unless the companion has shown them, too.
static void extrapolate(bough_companion *c) {
    const bough_finer *f = &c->finer;
    double followed = f->left - f->from, t = c->run->master->time;
    if (!(followed > 0) || c->run->aero) return;
    double times = fmin((t - f->from) / followed, most_growth);
    for (int i = 0; i < c->channels->count; i++) {
        if (c->grown[i] < f->left - followed / 2 || !is_large(c, i, c->least[i])) continue;
        c->error[i] = fmax(c->error[i], fmin(times * c->least[i], bough_error_range(c, i) / 2));
        bool seen = c->shown[i] >= least_shown * c->least[i];
        if (times == most_growth && !seen) bough_validity_pass_fast(c->run);
    }
}

// Vibrations that are faster than the steps decay in run and companion and leave no difference, and those
// that are faster than the samples of the air are aliased. The finer solution resolves them, and goes on
// while a difference grows.
static void compare_finer(bough_companion *c, double work) {
    bough_finer *f = &c->finer;
    if (!bough_finer_advance(f, c->run, work)) {
        extrapolate(c);
        return;
    }
    bool held = !bough_companion_air_sampled(c->run), grows = false;
    for (int i = 0; i < c->channels->count; i++) {
        const bough_channel *channel = &c->channels->channel[i];
        if (held && channel->sampled) continue; // an older sample than the finer one
        double error = f->ratio * fabs(bough_channel_difference(channel, c->value[i], f->other.value[i]));
        if (!(error > c->least[i])) continue;
        grows = grows || is_large(c, i, error);
        c->least[i] = error;
        c->grown[i] = c->run->master->time;
        if (c->error[i] < error) c->error[i] = error;
    }
    if (grows && !c->run->aero) bough_finer_go_on(f, c->run->master);
}

// Halves the number of rows: of two neighbours the one with the larger error is kept.
static void halve(bough_record *r) {
    size_t width = (size_t)r->width;
    r->n = BOUGH_RECORD_MOST / 2;
    r->shared *= 2;
    for (int k = 0; k < r->n; k++) {
        const double *pair = r->row + 2 * width * (size_t)k;
        bool second = pair[width + BOUGH_RECORD_ERROR] > pair[BOUGH_RECORD_ERROR];
        memmove(r->row + width * (size_t)k, pair + second * width, width * sizeof *pair);
    }
}

// Records the present time; `error` of a motion over its range.
static void record(bough_companion *c, double error) {
    bough_record *r = &c->record;
    size_t n = (size_t)c->channels->count;
    if (!r->row) return;
    if (r->taken == r->shared) r->taken = 0;
    if (r->taken == 0 && r->n == BOUGH_RECORD_MOST) halve(r);
    if (r->taken == 0) r->n++;
    double *row = r->row + (size_t)r->width * (size_t)(r->n - 1);
    if (r->taken++ > 0 && error <= row[BOUGH_RECORD_ERROR]) return;
    row[BOUGH_RECORD_TIME] = c->run->master->time;
    row[BOUGH_RECORD_ERROR] = error;
    row[BOUGH_RECORD_HELD] = !c->row[c->present].air_sampled;
    memcpy(row + BOUGH_RECORD_RUN, c->value, n * sizeof *row);
    memcpy(row + BOUGH_RECORD_RUN + n, c->coarser.value, n * sizeof *row);
}

// After the companion has ended: the further runs may go on.
static void record_alone(bough_companion *c) {
    if (!c->record.row || !counts_now(c, c->run)) return;
    bough_simulation_update(c->run);
    bough_channels_sample(c->channels, c->run->master->time, c->value);
    for (int i = 0; i < c->channels->count; i++) c->coarser.value[i] = (double)NAN;
    record(c, 0);
}

// Until run and companion are both sampled again, at the latest.
static double reach(const bough_companion *c) {
    const bough_scene *scene = c->coarser.simulation->scene;
    double step = scene->simulation.macro_step;
    return 2 * (scene->aero.node ? fmax(step, 1 / scene->aero.rate) : step);
}

enum { EXPECTED = 3 };               // samples of the air by which the next is expected
enum { SPACING = 3 };                // macro steps from corner to corner, the largest mean of close ones
enum { COUNTED = 32 };               // macro steps after which the counts begin again
static const double few_steps = 1.5; // of the integrator in each step of the run

// Counts the last corner, unless it follows another in less than a macro step.
static void count_corners(bough_companion *c) {
    const bough_master *m = c->run->master;
    double corner = m->next_event > 0 ? m->event[m->next_event - 1] : -HUGE_VAL;
    if (corner < c->corner + 0.99 * m->macro_step) return;
    c->corner = corner;
    c->corners++;
}

static bough_run_counts counts_of(const bough_companion *c) {
    const bough_master *m = c->run->master;
    const bough_member *whole = bough_scheme_whole(m->coupling);
    long sweeps = bough_scheme_reported(m->coupling).sweeps;
    bough_run_counts p = {m->grid_index, c->corners, sweeps > 0 ? sweeps : m->steps, LONG_MAX};
    for (int i = 0; i < (whole ? 1 : m->assembly->n_member); i++) {
        const bough_member *member = whole ? whole : m->assembly->member[i];
        long own = member->system.n_state > 0 ? bough_member_statistics(member).steps : LONG_MAX;
        p.steps = own < p.steps ? own : p.steps;
    }
    return p;
}

static bough_run_counts counts_since(const bough_run_counts *now, const bough_run_counts *then) {
    return (bough_run_counts){now->macro_steps - then->macro_steps, now->corners - then->corners,
                              now->advances - then->advances, now->steps - then->steps};
}

// If corners of loads are nearly as close as macro steps, they end the steps of the companion where they end
// those of the run; with inputs or a controller without air both have the same macro steps. Their errors are
// then equal, and the companion takes two steps for each unless the integrators take short steps anyway.
static void split_steps(bough_companion *c) {
    const bough_scene *scene = c->run->scene;
    count_corners(c);
    bough_run_counts now = counts_of(c), n = counts_since(&now, &c->counted);
    // the companion of a loose tolerance has half the run's macro steps: several corners are in each of them
    bool close = bough_coarser_is_loose(scene) ? n.advances >= SPACING * n.macro_steps
                                               : n.corners >= MANY && SPACING * n.corners >= n.macro_steps;
    if ((close || has_equal_steps(c)) && n.advances >= MANY &&
        (double)n.steps <= few_steps * (double)n.advances) {
        c->coarser.simulation->master->split = true;
        c->ratio = fmax(c->ratio, bough_finer_time_ratio());
    } else if (n.macro_steps >= COUNTED) {
        c->counted = now;
    }
}

// Includes the error of a jump of the air at a time.
static void take_jump(bough_companion *c, double time) {
    double sample = time * c->run->scene->aero.rate;
    if (time <= c->run->master->time) c->ratio = fmax(c->ratio, 2 * fabs(sample - floor(sample) - 0.5));
}

// The run spreads a jump of the wind, or of the loads' ramp, over its sample, the companion over two samples,
// whose middle is half a sample away; the error of the run is the time from the jump to the middle of its
// sample.
static void pass_jumps(bough_companion *c) {
    if (!c->run->aero) return;
    const bough_scene_aero *aero = &c->run->scene->aero;
    const double *ramp = aero->ramp;
    if (ramp[0] > 0 && (ramp[1] - ramp[0]) * aero->rate < 1) take_jump(c, (ramp[0] + ramp[1]) / 2);
    const bough_wind *wind = wind_of(c->run);
    while (c->jump >= 0) {
        double start = bough_wind_row_time(wind, c->jump), end = bough_wind_row_time(wind, c->jump + 1);
        if (end > c->run->master->time) return;
        take_jump(c, (start + end) / 2);
        c->jump = bough_wind_jump(wind, 1 / aero->rate, c->jump + 1);
    }
}

// The air expects blades where their last three samples lead, so that it errs after a sudden change of their
// pitch's rate, and that of the companion, whose samples are the control's, alike.
static bool pitches_suddenly(const bough_simulation *s) {
    if (!s->aero || !s->control) return false;
    double since = s->master->time - bough_control_link_sudden(s->control);
    return since <= (EXPECTED + 1) / s->scene->aero.rate;
}

static void compare(bough_companion *c) {
    // of two rates the lower one holds its samples longer
    bool rarer = c->coarser.simulation->scene->aero.rate <= c->run->scene->aero.rate;
    const bough_companion_row *row = &c->row[c->present];
    const bool held[] = {[BOUGH_BY_AIR] = rarer && !row->air_sampled,
                         [BOUGH_BY_CONTROL] = rarer && !row->sampled,
                         [BOUGH_BY_TIME] = false};
    bool resolved = missed_air(c->run) <= most_missed && !pitches_suddenly(c->run);
    pass_jumps(c);
    // steps of any length meet a contact at a chance time, so that both solutions err alike
    if (c->ratio < 1 && strikes(c->run)) c->ratio = 1;
    double ratio = resolved ? c->ratio : fmax(c->ratio, 1);
    c->flutters = c->flutters || flutters(missed_air(c->run), row->missed_air);
    memcpy(c->before, c->value, (size_t)c->channels->count * sizeof(double));
    sample(c);
    c->compared++;
    double largest = 0;
    for (int i = 0; i < c->channels->count; i++) {
        const bough_channel *channel = &c->channels->channel[i];
        double error = ratio_of(c, channel, ratio, held[channel->sampled]) *
                       fabs(bough_channel_difference(channel, c->value[i], c->coarser.value[i]));
        double late = stale(c, i);
        error = error > late ? error : late;
        if (may_be_singular(c, i)) error = HUGE_VAL;
        if (!(error <= c->error[i])) c->error[i] = error; // a NaN wins
        if (c->finer.follows) c->shown[i] = fmax(c->shown[i], error);
        if (bough_error_is_motion(channel) && error > largest * (c->high[i] - c->low[i]))
            largest = error / (c->high[i] - c->low[i]);
    }
    record(c, largest);
    double work = c->earlier + bough_simulation_work(c->run) + row->work;
    compare_finer(c, work);
    if (may_split(c)) split_steps(c);
    bough_finer_begin(&c->finer, c->run, reach(c), work);
    bough_error_notice(c, c->run->master->time);
}

// -- the start -------------------------------------------------------------------------------------

static const double least_of_scene = 1e-12; // of the scene's weight and loads: less is rounding

bough_status bough_companion_create(bough_arena *arena, bough_simulation *run, const bough_channels *channels,
                                    bough_companion *c) {
    *c = (bough_companion){.run = run, .channels = channels, .status = bough_ok()};
    take(c, arena);
    bough_equilibrium_units unit = bough_equilibrium_measure(run);
    c->force = least_of_scene * unit.force, c->moment = least_of_scene * unit.moment;
    for (int i = 0; i < run->scene->n_body; i++) {
        const bough_scene_body *body = &run->scene->body[i];
        if (!bough_scene_has_mesh(body)) continue;
        double length = bough_scene_arc_length(&body->rod.structure);
        double force = 2e-16 * body->rod.structure.station[0].def.stiffness[11]; // of strains by rounding
        c->arm = fmax(c->arm, length);
        c->force = fmax(c->force, force), c->moment = fmax(c->moment, force * length);
    }
    if (run->scene->simulation.error_estimate != BOUGH_SCENE_COMPANION) {
        give_up(c, "simulation.error_estimate is none");
    } else if (run->n_fmu > 0 || run->scene->control.fmu.model.description.once) {
        give_up(c, "an FMU has memory of its own and cannot be loaded a second time for the companion");
    } else {
        bough_status status = build(arena, c);
        if (status.code == BOUGH_IO) return status;
        if (!bough_is_ok(&status)) give_up(c, status.message);
    }
    if (!c->coarser.simulation) return bough_ok();
    run->master->compared = true;
    take_row(c);
    if (!counts_now(c, c->run)) return bough_ok();
    compare(c);
    c->compared = 0; // one that ends in its first step knows no error
    return bough_ok();
}

// By rounding, a synchronisation point of the companion may be just before that of the run.
static bool lags(const bough_companion *c) {
    return bough_is_ok(&c->status) && last(c)->time < c->run->master->time;
}

// The row of the run's time, or the next one.
static const bough_companion_row *find_present(bough_companion *c) {
    while (c->present < c->n_row - 1 && c->row[c->present].time < c->run->master->time) c->present++;
    c->coarser.value = c->row[c->present].value;
    return &c->row[c->present];
}

void bough_companion_compare(bough_companion *c) {
    if (!alive(c)) {
        record_alone(c);
        return;
    }
    while (lags(c)) bough_companion_step(c, false);
    if (bough_companion_stopped(c)) return;
    const bough_companion_row *row = find_present(c);
    // a failure counts from the end of the failed step, however many steps of the run were beside it
    if (!bough_is_ok(&c->status) &&
        c->run->master->time >= bough_master_next(c->coarser.simulation->master)) {
        give_up(c, c->status.message);
        c->run->master->compared = false;
    } else if (row->time == c->run->master->time && counts_now(c, c->run)) {
        compare(c);
        bough_channels_know(c->channels, c->value);
    }
}

bool bough_companion_compares(const bough_companion *c) {
    const bough_companion_row *row = &c->row[c->present];
    return alive(c) && row->time == c->run->master->time && counts_now(c, c->run) && row->sampled;
}

bool bough_companion_knows(const bough_companion *c, int channel) {
    return c->compared > 0 && isfinite(c->error[channel]);
}

void bough_companion_stop_by(bough_companion *c, bool (*stop)(void)) {
    if (c->coarser.simulation) bough_master_stop_by(c->coarser.simulation->master, stop);
    const bough_simulation *finer = c->finer.other.simulation;
    if (finer) bough_master_stop_by(finer->master, stop);
}

bool bough_companion_stopped(const bough_companion *c) {
    return c->status.code == BOUGH_INTERRUPTED || c->finer.status.code == BOUGH_INTERRUPTED;
}

double bough_companion_work(const bough_companion *c) {
    return c->earlier + bough_simulation_work(c->run) + bough_simulation_work(c->coarser.simulation);
}

// -- copies ---------------------------------------------------------------------------------------

bool bough_companion_storable(const bough_companion *c) {
    bool ahead = c->present < c->n_row - 1;
    return !alive(c) ||
           (bough_is_ok(&c->status) && !ahead && bough_master_sampled(c->coarser.simulation->master));
}

void bough_companion_snapshot(bough_companion *c, bough_snapshot *s) {
    if (!c->coarser.simulation) return;
    int n = c->channels->count;
    bough_simulation_snapshot(c->coarser.simulation, s);
    bough_finer_snapshot(&c->finer, s);
    double *const rows[] = {c->value, c->error, c->shown,     c->least,      c->grown,
                            c->low,   c->high,  c->other_low, c->other_high, c->noticed};
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) bough_snapshot_doubles(s, rows[k], n);
    // a restored companion goes on from the stored work, whatever its own counters are
    double work = bough_companion_work(c), now = work - c->earlier;
    bough_snapshot_take(s, &work, sizeof work);
    c->earlier = work - now;
    // a restored integrator counts on: what is kept are its steps since then
    long steps = counts_of(c).steps;
    c->counted.steps = steps - c->counted.steps;
    BOUGH_SNAPSHOT(s, c->counted, c->corners, c->corner);
    c->counted.steps = steps - c->counted.steps;
    BOUGH_SNAPSHOT(s, c->compared, c->ratio, c->flutters, c->reason, c->from, c->run->master->compared);
    BOUGH_SNAPSHOT(s, c->record.n, c->record.shared, c->record.taken);
    bough_snapshot_doubles(s, c->record.row, c->record.row ? BOUGH_RECORD_MOST * c->record.width : 0);
    if (s->move != BOUGH_SNAPSHOT_RESTORE) return;
    c->status = c->finer.status = bough_ok();
    expect_jumps(c);
    c->n_row = c->present = 0;
    if (alive(c)) take_row(c);
}
