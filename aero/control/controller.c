// theory (94, 95)
#include "aero/control/controller.h"

#include "core/base/base.h"

static double synchronous(const bough_controller_def *d) { return d->rated_speed / (1 + d->slip); }

// The slope of the line from zero torque at the synchronous speed to rated torque.
static double slope(const bough_controller_def *d) {
    return d->rated_power / d->rated_speed / (d->rated_speed - synchronous(d));
}

// Where that line meets the parabola of best tip-speed ratio: gain ω² = slope (ω − ω₀), solved without
// a difference of large numbers when the slip is small.
static double transition(const bough_controller_def *d) {
    double first = synchronous(d);
    return 2 * first / (1 + sqrt(fmax(1 - 4 * d->optimal_gain * first / slope(d), 0)));
}

bough_status bough_controller_check(const bough_controller_def *d) {
    const double positive[] = {d->corner,        d->optimal_from, d->rated_speed, d->rated_power,
                               d->slip,          d->most_torque,  d->torque_rate, d->reference_speed,
                               d->halving_pitch, d->pitch_rate,   d->integral};
    for (size_t i = 0; i < sizeof positive / sizeof *positive; i++) {
        if (positive[i] > 0 && isfinite(positive[i])) continue;
        return bough_fail(BOUGH_INVALID,
                          "the controller's speeds, power, torque, rates, gains and slip must be positive");
    }
    if (!(d->cut_in >= 0 && d->optimal_gain >= 0 && d->proportional >= 0)) {
        return bough_fail(BOUGH_INVALID, "the controller's cut-in speed, optimal gain and proportional gain "
                                         "must not be negative");
    }
    if (d->motoring && d->optimal_gain > 0) {
        return bough_fail(BOUGH_INVALID,
                          "with 'motoring' the torque follows from the slip alone: optimal_gain must be 0");
    }
    if (!(d->least_pitch < d->most_pitch)) {
        return bough_fail(BOUGH_INVALID, "the controller's smallest pitch must be below its largest");
    }
    if (!(d->cut_in < d->optimal_from && d->optimal_from <= transition(d) &&
          transition(d) <= d->rated_speed)) {
        return bough_fail(
            BOUGH_INVALID,
            "the controller's speeds must increase from cut-in to the optimal range to rated speed, and the torque at the end of the optimal range must be below rated torque");
    }
    return bough_ok();
}

double bough_controller_torque(const bough_controller_def *d, double speed, double pitch) {
    // a pitched rotor runs at constant power below rated speed, too
    bool pitched = pitch >= d->power_pitch;
    double torque;
    // the regions of the torque, from low to high speed
    if (d->motoring && speed < synchronous(d)) {
        return fmax(slope(d) * (speed - synchronous(d)), -d->most_torque);
    }
    if (speed <= d->cut_in) {
        torque = 0;
    } else if (speed >= d->rated_speed && d->above_rated == BOUGH_CONSTANT_TORQUE) {
        torque = d->rated_power / d->rated_speed;
    } else if (speed >= d->rated_speed || (pitched && speed >= d->optimal_from)) {
        torque = d->rated_power / speed;
    } else if (speed < d->optimal_from) { // a line from none at cut-in to constant power or the parabola
        double parabola = d->optimal_gain * d->optimal_from * d->optimal_from;
        double end = fmin(pitched ? d->rated_power / d->optimal_from : parabola, d->most_torque);
        torque = end * (speed - d->cut_in) / (d->optimal_from - d->cut_in);
    } else if (speed < transition(d)) {
        torque = d->optimal_gain * speed * speed;
    } else {
        torque = slope(d) * (speed - synchronous(d));
    }
    return fmin(torque, d->most_torque);
}

// 1/(1 + θ/θ_K): the gains fall as the rotor's sensitivity to pitch grows.
static double schedule(const bough_controller_def *d, double pitch) {
    return 1 / (1 + fmax(pitch, 0) / d->halving_pitch);
}

static void start(const bough_controller_def *d, double speed, double pitch, bough_controller_state *s) {
    double held = bough_clamp(pitch, d->least_pitch, d->most_pitch);
    *s = (bough_controller_state){.started = 1,
                                  .speed = speed,
                                  .integral = held / (schedule(d, held) * d->integral),
                                  .torque = bough_controller_torque(d, speed, held),
                                  .pitch = held};
}

void bough_controller_advance(const bough_controller_def *d, double speed, double pitch, double step,
                              bough_controller_state *s) {
    if (s->started == 0) {
        start(d, speed, pitch, s);
        return;
    }
    // filtered speed; the torque follows its law within its rate
    s->speed = speed + (s->speed - speed) * exp(-step * d->corner);
    double most = d->torque_rate * step, torque = bough_controller_torque(d, s->speed, s->pitch);
    s->torque = bough_clamp(torque, s->torque - most, s->torque + most);
    if (speed <= 0 && !d->motoring)
        s->torque = 0; // which the filter and the torque's rate would keep while it reverses
    // the pitch, then its limits of rate and angle
    double gain = schedule(d, s->pitch), error = s->speed - d->reference_speed;
    // no wind-up: the integral alone stays within the range of the pitch
    double unit = gain * d->integral;
    s->integral = bough_clamp(s->integral + error * step, d->least_pitch / unit, d->most_pitch / unit);
    double sought =
        bough_clamp(gain * d->proportional * error + unit * s->integral, d->least_pitch, d->most_pitch);
    double reach = d->pitch_rate * step;
    double rated = bough_clamp(sought, pitch - reach, pitch + reach);
    s->pitch = bough_clamp(rated, d->least_pitch, d->most_pitch);
}
