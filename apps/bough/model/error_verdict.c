#include "apps/bough/model/error_verdict.h"

static const double rounding = 1e-6;    // of the largest range of all motion or value up to 1, in SI units
static const double least_share = 1e-3; // of the largest range of that kind
static const double least_turn = 1e-3,
                    least_move = 1e-2; // least range of a velocity, relative to its value

static bool is_force(const bough_channel *channel) {
    return channel->kind == BOUGH_KIND_FORCE || channel->kind == BOUGH_KIND_MOMENT;
}

static bool is_velocity(const bough_channel *channel) {
    return channel->kind == BOUGH_KIND_VELOCITY || channel->kind == BOUGH_KIND_ANGULAR_VELOCITY;
}

bool bough_error_is_motion(const bough_channel *channel) {
    bool place = channel->kind == BOUGH_KIND_LENGTH || channel->kind == BOUGH_KIND_ANGLE;
    return (place || is_velocity(channel)) && !channel->sampled;
}

// -- ranges ---------------------------------------------------------------------------------------

// fmin and fmax would be calls, and every comparison of run and companion finds the ranges of all channels.
static double smaller(double a, double b) { return b < a ? b : a; }
static double larger(double a, double b) { return b > a ? b : a; }

// Range of the channel alone: the smaller of run and companion.
static double own_range(const bough_companion *c, int i) {
    return larger(0, smaller(c->high[i] - c->low[i], c->other_high[i] - c->other_low[i]));
}

static double largest_value(const bough_companion *c, int i) {
    double run = larger(fabs(c->high[i]), fabs(c->low[i]));
    return smaller(run, larger(fabs(c->other_high[i]), fabs(c->other_low[i])));
}

// Whether the vector of which the channel is a component moves by no more than rounding, in run and
// companion.
static bool at_rest(const bough_companion *c, int channel) {
    const bough_channel *list = c->channels->channel;
    double range = 0;
    for (int i = list[channel].vector; i < c->channels->count && list[i].vector == list[channel].vector; i++)
        range = fmax(range, fmax(c->high[i] - c->low[i], c->other_high[i] - c->other_low[i]));
    return list[channel].si * range <= rounding * c->motion;
}

// A constant channel beside moving ones, such as the deflection of a blade in steady operation, has no range:
// its value is used, up to 1 in SI units.
double bough_error_range(const bough_companion *c, int channel) {
    const bough_channel *list = c->channels->channel;
    double range = 0, value = 0, si = list[channel].si;
    for (int i = list[channel].vector; i < c->channels->count && list[i].vector == list[channel].vector;
         i++) {
        range = fmax(range, own_range(c, i));
        value = fmax(value, largest_value(c, i));
    }
    if (is_velocity(&list[channel]))
        range = fmax(range, (list[channel].kind == BOUGH_KIND_VELOCITY ? least_move : least_turn) * value);
    if (!bough_error_is_motion(&list[channel])) return range;
    if (at_rest(c, channel)) range = fmax(range, fmin(value, 1 / si));
    return fmax(range, c->rest / si);
}

double bough_error_relative(const bough_companion *c, int channel, double error) {
    double range = bough_error_range(c, channel);
    return range > 0 ? error / range : (double)NAN;
}

// -- what counts ----------------------------------------------------------------------------------

static const double least_motion = 1e-12; // [m], [rad], [m/s], [rad/s]: less is always rounding
static const double least_load = 1e-9;    // of the largest force or moment, in SI units: likewise

static double kind_range(const bough_companion *c, bough_quantity_kind kind) {
    double largest = 0;
    for (int i = 0; i < c->channels->count; i++) {
        const bough_channel *channel = &c->channels->channel[i];
        if (channel->kind == kind && !channel->sampled)
            largest = fmax(largest, channel->si * own_range(c, i));
    }
    return largest;
}

// The largest range of that kind; of rotations no less than the displacements at the arm of the longest rod.
static double range_of_kind(const bough_companion *c, bough_quantity_kind kind) {
    double largest = kind_range(c, kind);
    bool rate = kind == BOUGH_KIND_ANGULAR_VELOCITY;
    if ((!rate && kind != BOUGH_KIND_ANGLE) || c->arm == 0) return largest;
    return fmax(largest, kind_range(c, rate ? BOUGH_KIND_VELOCITY : BOUGH_KIND_LENGTH) / c->arm);
}

static double largest_load(const bough_companion *c) {
    double largest = 0;
    for (int i = 0; i < c->channels->count; i++) {
        const bough_channel *channel = &c->channels->channel[i];
        if (is_force(channel)) largest = larger(largest, channel->si * largest_value(c, i));
    }
    return largest;
}

// The largest range or value of all motion, of any kind.
static double largest_motion(const bough_companion *c) {
    double largest = 0;
    for (int i = 0; i < c->channels->count; i++) {
        const bough_channel *channel = &c->channels->channel[i];
        if (!bough_error_is_motion(channel)) continue;
        double value = smaller(1, channel->si * largest_value(c, i));
        largest = larger(largest, larger(value, channel->si * own_range(c, i)));
    }
    return largest;
}

// Size of a scene at rest, whose channels have no range: the largest value; 0: the scene moves.
static double size_at_rest(const bough_companion *c) {
    double size = c->motion;
    for (int i = 0; i < c->channels->count; i++) {
        const bough_channel *channel = &c->channels->channel[i];
        if (bough_error_is_motion(channel) && channel->si * own_range(c, i) > rounding * size) return 0;
    }
    return size;
}

bool bough_error_counts(const bough_companion *c, int i) {
    const bough_channel *channel = &c->channels->channel[i];
    double moves = channel->si * fmax(bough_error_range(c, i), c->error[i]);
    bool moving = bough_error_is_motion(channel) ? moves > fmax(rounding * c->motion, least_motion)
                                                 : moves > least_share * channel->si * largest_value(c, i);
    double least = channel->kind == BOUGH_KIND_MOMENT ? c->moment : c->force;
    if (is_force(channel) && moves <= fmax(least_load * largest_load(c), least)) return false;
    return moving && moves >= least_share * range_of_kind(c, channel->kind);
}

// -- the verdict ----------------------------------------------------------------------------------

static double relative_of(const bough_companion *c, int i, double error) {
    double relative = bough_error_relative(c, i, error);
    return isnan(relative) && error > 0 ? HUGE_VAL : relative;
}

bough_error_verdict bough_error_verdict_of(const bough_companion *c, bool motion, const double *error) {
    bough_error_verdict v = {.channel = -1};
    for (int i = 0; i < c->channels->count; i++) {
        const bough_channel *channel = &c->channels->channel[i];
        bool wanted = motion ? bough_error_is_motion(channel) : is_force(channel) && !channel->sampled;
        if (!wanted || !bough_companion_knows(c, i) || !bough_error_counts(c, i)) continue;
        double relative = relative_of(c, i, error[i]);
        if (v.channel >= 0 && relative <= v.relative) continue;
        v = (bough_error_verdict){i, relative, c->noticed[i]};
    }
    return v;
}

int bough_error_worst(const bough_companion *c, int most, int *channel) {
    int n = 0;
    for (int i = 0; i < c->channels->count; i++) {
        bool judged = bough_error_is_motion(&c->channels->channel[i]) || is_force(&c->channels->channel[i]);
        if (!judged || !bough_companion_knows(c, i) || !bough_error_counts(c, i)) continue;
        double relative = relative_of(c, i, c->error[i]);
        int k = n < most ? n++ : most;
        for (; k > 0 && !(relative_of(c, channel[k - 1], c->error[channel[k - 1]]) >= relative); k--) {
            if (k < most) channel[k] = channel[k - 1];
        }
        if (k < most) channel[k] = i;
    }
    return n;
}

void bough_error_size(const bough_companion *c, int channel, char text[BOUGH_ERROR_SIZE]) {
    static const double beyond = 10;
    double error = c->error[channel], relative = relative_of(c, channel, error);
    const char *unit = c->channels->channel[channel].unit;
    bool pure = strcmp(unit, "-") == 0;
    int n = snprintf(text, BOUGH_ERROR_SIZE, "%.2g%s%.40s, ", error, pure ? "" : " ", pure ? "" : unit);
    if (relative > beyond)
        snprintf(text + n, (size_t)(BOUGH_ERROR_SIZE - n), "more than %.0f times its range", beyond);
    else
        snprintf(text + n, (size_t)(BOUGH_ERROR_SIZE - n), "%.2g of its range", relative);
}

// Whether the error is within a fraction of the range. The channel's own range, no larger, is checked first.
static bool is_within(const bough_companion *c, int i, double fraction) {
    double error = c->error[i];
    return error <= fraction * own_range(c, i) || error <= fraction * bough_error_range(c, i);
}

void bough_error_notice(bough_companion *c, double t) {
    double accuracy = c->run->scene->simulation.accuracy;
    c->motion = largest_motion(c);
    c->rest = size_at_rest(c);
    for (int i = 0; i < c->channels->count; i++) {
        if (c->noticed[i] < 0 && !is_within(c, i, accuracy)) c->noticed[i] = t;
    }
}
