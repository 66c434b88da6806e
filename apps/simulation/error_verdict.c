// What the errors that a run tells mean for it.
#include "apps/simulation/error_probe.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double noticeable = BOUGH_ERROR_NOTICEABLE;
static const double rounding = 1e-6; // of the largest range of all motion or value up to 1, in SI units
static const double least_share = 1e-3; // of the largest range with that unit: moves less, says nothing;
                                        // and of a speed: what it changes by at least

// -- vectors --------------------------------------------------------------------------------------

// OpenFAST's names of the displacement and the rotation of a tower's top, and of a blade's tip.
static bool are_named_components(const char *x, const char *y) {
    static const char *const names[][2] = {{"TTDspFA", "TTDspSS"}, {"TTDspFA", "TTDspAx"},
                                           {"TTDspRoll", "TTDspPtch"}, {"TTDspRoll", "TTDspTwst"},
                                           {"OoPDefl", "IPDefl"}};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        size_t n = strlen(names[k][0]), m = strlen(names[k][1]);
        bool begin = strncmp(x, names[k][0], n) == 0 && strncmp(y, names[k][1], m) == 0;
        if (begin && strcmp(x + n, y + m) == 0) return true;
    }
    return false;
}

// "TipX" and "TipY", "TipDxb1" and "TipDyb1": of one length, and x, y, z in one place.
static bool are_components(const bough_channel *a, const bough_channel *b) {
    const char *x = a->name, *y = b->name;
    int differ = 0;
    if (strcmp(a->unit, b->unit) != 0) return false;
    if (are_named_components(x, y)) return true;
    for (; *x && *y; x++, y++) {
        if (*x == *y) continue;
        bool letters = (strchr("xyz", *x) && strchr("xyz", *y)) || (strchr("XYZ", *x) && strchr("XYZ", *y));
        if (!letters || ++differ > 1) return false;
    }
    return *x == *y && differ == 1;
}

void bough_error_probe_find_vectors(const bough_channels *channels, int *vector) {
    for (int i = 0; i < channels->count; i++) {
        vector[i] = i;
        if (i > 0 && are_components(&channels->channel[vector[i - 1]], &channels->channel[i])) {
            vector[i] = vector[i - 1];
        }
    }
}

// Of what is recorded or, when that is less, of what it would be without the error: where one of the
// two has run away, the other still has a size. Few values are known without the error; the range of all of
// them is at least the recorded one less twice the error.
static double own_range(const bough_error_probe *p, int i) {
    double range = p->high[i] - p->low[i], corrected = p->true_high[i] - p->true_low[i];
    if (p->batches <= 1 || !(corrected < range)) return fmax(range, 0);
    return fmax(fmax(corrected, range - 2 * p->largest[i]), 0);
}

static double largest_of(const bough_error_probe *p, int i) { return fmax(fabs(p->high[i]), fabs(p->low[i])); }

static bool is_speed(const bough_channel *channel) {
    return strstr(channel->unit, "/s") || strcmp(channel->unit, "rpm") == 0;
}

// Of the vector that the channel is one of. A speed that hardly changes has a share of its value instead.
static double range_of(const bough_error_probe *p, int channel) {
    double range = 0, size = 0;
    for (int i = p->vector[channel]; i < p->channels->count && p->vector[i] == p->vector[channel]; i++) {
        range = fmax(range, own_range(p, i));
        size = fmax(size, largest_of(p, i));
    }
    return is_speed(&p->channels->channel[channel]) ? fmax(range, least_share * size) : range;
}

double bough_error_probe_relative(const bough_error_probe *p, int channel, double error) {
    double range = range_of(p, channel);
    return range > 0 ? error / range : (double)NAN;
}

void bough_error_probe_widen(bough_error_probe *p, const double *value) {
    for (int i = 0; i < p->channels->count; i++) {
        p->low[i] = fmin(p->low[i], value[i]);
        p->high[i] = fmax(p->high[i], value[i]);
    }
}

void bough_error_probe_mark(bough_error_probe *p, double t) {
    for (int i = 0; i < p->simulation->n_motion_channel; i++) {
        if (p->passed[i] < 0 && !(p->largest[i] <= noticeable * range_of(p, i))) p->passed[i] = t;
    }
}

// -- the verdict ----------------------------------------------------------------------------------

// Forces and moments answer errors of the highest frequencies; what they mean shows in the motion.
static bool is_motion(const bough_channel *channel) {
    return strchr(channel->unit, 'N') == NULL;
}

// What a value is in SI units, in which lengths, angles and speeds of one motion are alike.
static double in_si(const bough_channel *channel, double value) {
    static const double degree = 0.017453292519943295, rpm = 0.10471975511965977;
    if (strstr(channel->unit, "deg")) return degree * value;
    return strcmp(channel->unit, "rpm") == 0 ? rpm * value : value;
}

// Of one unit, or an angle and the component of a direction, which is the angle where it is small.
static bool alike(const char *unit, const char *other) {
    bool angle = strcmp(unit, "deg") == 0 || strcmp(unit, "-") == 0;
    bool other_angle = strcmp(other, "deg") == 0 || strcmp(other, "-") == 0;
    return strcmp(unit, other) == 0 || (angle && other_angle);
}

// In SI units, of the channels that are like this one.
static double largest_range(const bough_error_probe *p, const bough_channel *one) {
    double largest = 0;
    for (int i = 0; i < p->simulation->n_motion_channel; i++) {
        const bough_channel *channel = &p->channels->channel[i];
        if (alike(channel->unit, one->unit)) largest = fmax(largest, in_si(channel, own_range(p, i)));
    }
    return largest;
}

// Of all motion, whatever its unit: where nothing moves, the ranges are those of rounding.
static double largest_value(const bough_error_probe *p) {
    double largest = 0;
    for (int i = 0; i < p->simulation->n_motion_channel; i++) {
        const bough_channel *channel = &p->channels->channel[i];
        if (!is_motion(channel)) continue;
        double size = in_si(channel, largest_of(p, i));
        largest = fmax(largest, fmax(fmin(size, 1), in_si(channel, own_range(p, i))));
    }
    return largest;
}

// What moves, or errs, by next to nothing has none: a range that is rounding is no range. A force that
// hardly changes has none either.
static bool has_say(const bough_error_probe *p, int i, double error) {
    const bough_channel *channel = &p->channels->channel[i];
    double moves = fmax(range_of(p, i), error);
    bool moving = is_motion(channel) ? in_si(channel, moves) > rounding * largest_value(p)
                                     : moves > least_share * largest_of(p, i);
    return moving && in_si(channel, moves) >= least_share * largest_range(p, channel);
}

// Of the errors (n_motion_channel); those of the estimate may be unknown.
static bough_error_verdict verdict_of(const bough_error_probe *p, bool motion, const double *error) {
    bough_error_verdict v = {.channel = -1};
    for (int i = 0; i < p->simulation->n_motion_channel; i++) {
        if (is_motion(&p->channels->channel[i]) != motion) continue;
        bool known = error != p->largest || bough_error_probe_knows(p, i);
        v.unknown += !known;
        if (!known || !has_say(p, i, error[i])) continue;
        double range = range_of(p, i);
        double relative = range > 0 ? error[i] / range : error[i] > 0 ? HUGE_VAL : 0;
        if (v.channel >= 0 && relative <= v.relative) continue;
        v = (bough_error_verdict){i, relative, p->passed[i], v.unknown};
    }
    return v;
}

bough_error_verdict bough_error_probe_verdict(const bough_error_probe *p) {
    return verdict_of(p, true, p->largest);
}

bough_error_verdict bough_error_probe_verdict_of(const bough_error_probe *p, const double *error) {
    return verdict_of(p, true, error);
}

bough_error_verdict bough_error_probe_force_verdict(const bough_error_probe *p) {
    return verdict_of(p, false, p->largest);
}

static const double hopeless = 3; // times the range
enum { HOPELESS_FOR = 8 };

bool bough_error_probe_hopeless(const bough_error_probe *p) { return p->lost_for >= HOPELESS_FOR; }

void bough_error_probe_watch(bough_error_probe *p) {
    bough_error_verdict v = bough_error_probe_verdict(p);
    bool lost = v.channel >= 0 && v.relative > hopeless &&
                fabs(p->difference[v.channel]) > 0.5 * p->largest[v.channel];
    p->lost_for = lost ? p->lost_for + 1 : 0;
    if (v.channel < 0) return;
    p->last = v;
    p->last_error = p->largest[v.channel];
}

static void describe(const bough_error_probe *p, const bough_error_verdict *v, double error, char *text,
                     size_t size) {
    const bough_channel *channel = &p->channels->channel[v->channel];
    const bough_master *m = p->simulation->master;
    snprintf(text, size, "%s errs by %.2g %s, %.2g of its range, noticeably from %.6g s on; cause: %s",
             channel->name, error, channel->unit, v->relative, v->time, bough_master_error_cause(m));
}

void bough_error_probe_warn(const bough_error_probe *p, double bound, char text[BOUGH_ERROR_WARNING]) {
    bough_error_verdict v = bough_error_probe_verdict(p);
    text[0] = '\0';
    const bough_second_solution *second = p->simulation->master->second;
    const char *reason = second ? bough_second_solution_reason(second) : NULL;
    if (reason) {
        int n = snprintf(text, BOUGH_ERROR_WARNING,
                         "the second solution, by which errors are measured, was given "
                         "up %s; errors since then: %s",
                         reason, bough_master_error_source(p->simulation->master));
        if (v.channel >= 0 || p->last.channel < 0) return;
        snprintf(text + n, (size_t)(BOUGH_ERROR_WARNING - n),
                 "; until then the largest was that of %s, %.2g of its range",
                 p->channels->channel[p->last.channel].name, p->last.relative);
        return;
    }
    if (v.channel < 0 || v.relative <= noticeable || (bound > 0 && v.relative > bound)) return;
    describe(p, &v, p->largest[v.channel], text, BOUGH_ERROR_WARNING);
}

void bough_error_probe_warn_of_force(const bough_error_probe *p, double bound,
                                     char text[BOUGH_ERROR_WARNING]) {
    bough_error_verdict v = bough_error_probe_force_verdict(p);
    text[0] = '\0';
    if (v.channel < 0 || !(bound > 0) || v.relative <= bound) return;
    describe(p, &v, p->largest[v.channel], text, BOUGH_ERROR_WARNING);
}

bough_status bough_error_probe_judge(const bough_error_probe *p, double bound) {
    char what[200], hold[BOUGH_MASTER_ADVICE];
    bough_error_verdict v = bough_error_probe_verdict(p);
    if (v.channel < 0 && v.unknown > 0) v = p->last;
    if (!(bound > 0) || v.channel < 0 || v.relative <= bound) return bough_ok();
    describe(p, &v, v.channel == p->last.channel ? p->last_error : p->largest[v.channel], what, sizeof what);
    bough_master_advise(p->simulation->master, v.relative / bound, hold);
    return bough_fail(BOUGH_FAILED, "the error bound %.3g is exceeded: %s; try %s", bound, what, hold);
}
