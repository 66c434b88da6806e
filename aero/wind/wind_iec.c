// Conditions of IEC 61400-1:2019, whose equation numbers stand beside the lines.
#include "aero/wind/wind_iec.h"

#include "core/base/base.h"

bool bough_wind_iec_is_turbulent(int condition) {
    return condition == BOUGH_WIND_NTM || condition == BOUGH_WIND_ETM || condition == BOUGH_WIND_EWM;
}

bool bough_wind_iec_is_extreme_speed(int condition) {
    return condition == BOUGH_WIND_EWM || condition == BOUGH_WIND_EWM_STEADY;
}

// Table 1: classes I to III.
static double reference_speed(const bough_wind_iec_def *d) {
    static const double speed[] = {50, 42.5, 37.5};
    return speed[d->wind_class / 4];
}

// Table 1: categories A+ to C.
static double reference_intensity(const bough_wind_iec_def *d) {
    static const double intensity[] = {0.18, 0.16, 0.14, 0.12};
    return intensity[d->wind_class % 4];
}

double bough_wind_iec_speed(const bough_wind_iec_def *d) {
    if (!bough_wind_iec_is_extreme_speed(d->condition)) return d->speed;
    double gust = d->condition == BOUGH_WIND_EWM_STEADY ? 1.4 : 1; // (14), (16)
    return gust * (d->yearly ? 0.8 : 1) * reference_speed(d);      // (15), (17)
}

double bough_wind_iec_scale(double height) { return height <= 60 ? 0.7 * height : 42; } // (5)

static double normal_deviation(const bough_wind_iec_def *d) {
    return reference_intensity(d) * (0.75 * d->speed + 5.6); // (10)
}

static double extreme_deviation(const bough_wind_iec_def *d) {
    const double c = 2, average = 0.2 * reference_speed(d);
    return c * reference_intensity(d) * (0.072 * (average / c + 3) * (d->speed / c - 4) + 10); // (19)
}

// Longitudinal standard deviation of the turbulence.
double bough_wind_iec_deviation(const bough_wind_iec_def *d) {
    // given, of the extreme wind speed model, or of the turbulence models
    if (d->intensity > 0) return d->intensity * bough_wind_iec_speed(d);
    if (bough_wind_iec_is_extreme_speed(d->condition)) return 0.11 * bough_wind_iec_speed(d);
    return d->condition == BOUGH_WIND_ETM ? extreme_deviation(d) : normal_deviation(d);
}

bough_status bough_wind_iec_check(const bough_wind_iec_def *d) {
    if (!(d->height > 0 && d->diameter > 0)) {
        return bough_fail(BOUGH_INVALID, "Wind: hub height and rotor diameter must be positive.");
    }
    if (!(bough_wind_iec_speed(d) > 0)) {
        return bough_fail(BOUGH_INVALID, "Wind: the mean speed must be positive.");
    }
    if (!bough_wind_iec_is_turbulent(d->condition)) return bough_ok();
    if (d->points >= 2 && d->width >= d->diameter && d->time_step > 0 && d->period >= 4 * d->time_step) {
        return bough_ok();
    }
    return bough_fail(BOUGH_INVALID,
                      "Wind: turbulence needs at least 2 x 2 points, a width of at "
                      "least the rotor's diameter, %g m, and 4 time steps.",
                      d->diameter);
}

// -- gusts ----------------------------------------------------------------------------------------

static double operating_gust(const bough_wind_iec_def *d, double deviation, double ratio) {
    double yearly = 1.4 * 0.8 * reference_speed(d);
    return fmin(1.35 * (yearly - d->speed), 3.3 * deviation / (1 + 0.1 * ratio)); // (18)
}

// Change of direction in the coherent gust.
static double coherent_veer(double speed) {
    return (speed < 4 ? 180 : 720 / speed) * BOUGH_DEGREE; // (25)
}

// Duration, amplitude and change of direction of a deterministic condition.
bough_wind_iec bough_wind_iec_start(const bough_wind_iec_def *def) {
    bough_wind_iec w = {.def = *def, .speed = bough_wind_iec_speed(def)};
    double deviation = bough_wind_iec_deviation(def);
    double ratio = def->diameter / bough_wind_iec_scale(def->height); // D/Λ₁
    double sign = def->negative ? -1 : 1;
    switch (def->condition) {
    case BOUGH_WIND_EOG:
        w.length = 10.5;
        w.gust = fmax(operating_gust(def, deviation, ratio), 0);
        break;
    case BOUGH_WIND_EDC: {
        double veer = 4 * atan(deviation / (w.speed * (1 + 0.1 * ratio))); // (21)
        w.length = 6;
        w.change = sign * fmin(veer, BOUGH_PI);
        break;
    }
    case BOUGH_WIND_ECD:
        w.length = 10;
        w.gust = 15;
        w.change = sign * coherent_veer(w.speed);
        break;
    case BOUGH_WIND_EWS:
        w.length = 12;
        w.gust = sign * (2.5 + 0.2 * 6.4 * deviation * pow(ratio, 0.25)) / def->diameter; // (27)
        break;
    default: break;
    }
    return w;
}

// Power law; uniform with exponent 0.
double bough_wind_iec_profile(const bough_wind_iec_def *def, double height) {
    double speed = bough_wind_iec_speed(def);
    if (def->exponent == 0) return speed;
    return height <= 0 ? 0 : speed * pow(height / def->height, def->exponent);
}

bough_vec3 bough_wind_iec_at(const bough_wind_iec *w, bough_vec3 position, double t) {
    const bough_wind_iec_def *d = &w->def;
    double speed = bough_wind_iec_profile(d, position.z);
    // the deterministic change, from its start over its duration
    double phase = w->length > 0 ? bough_clamp((t - d->start) / w->length, 0, 1) : 0;
    double pulse = 1 - cos(2 * BOUGH_PI * phase);    // rises and falls
    double step = 0.5 * (1 - cos(BOUGH_PI * phase)); // rises and stays
    switch (d->condition) {
    case BOUGH_WIND_EOG: speed -= 0.37 * w->gust * sin(3 * BOUGH_PI * phase) * pulse; break; // (18)
    case BOUGH_WIND_ECD: speed += w->gust * step; break;                                     // (23)
    case BOUGH_WIND_EWS:
        speed += w->gust * pulse * (d->horizontal ? position.y : position.z - d->height);
        break;
    default: break;
    }
    // change of direction, to the right looking downwind
    double angle = w->change * step;
    return bough_v3(speed * cos(angle), -speed * sin(angle), 0);
}
