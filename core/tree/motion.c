// Given motions of joints: smooth ramps, cubic splines through tables, and cubics that are set during a run.
#include "core/tree/motion.h"

// -- evaluation ------------------------------------------------------------------------------

// The smooth step s(τ) = τ − sin(2πτ)/2π with s' and s'' zero at both ends.
static bough_motion_point ramp_of_position(double tau, double length) {
    double angle = 2 * BOUGH_PI * tau, w = 1 / length;
    return (bough_motion_point){tau - sin(angle) / (2 * BOUGH_PI), w * (1 - cos(angle)),
                                w * w * 2 * BOUGH_PI * sin(angle)};
}

// Its integral over time, s and s'
static bough_motion_point ramp_of_speed(double tau, double length) {
    double angle = 2 * BOUGH_PI * tau;
    double integral = 0.5 * tau * tau + (cos(angle) - 1) / (4 * BOUGH_PI * BOUGH_PI);
    return (bough_motion_point){length * integral, tau - sin(angle) / (2 * BOUGH_PI),
                                (1 - cos(angle)) / length};
}

static bough_motion_point unit_ramp(const bough_motion *m, double t) {
    double length = m->end - m->start;
    if (t < m->start) return (bough_motion_point){0, 0, 0};
    if (t >= m->end) {
        if (!m->of_speed) return (bough_motion_point){1, 0, 0};
        return (bough_motion_point){0.5 * length + (t - m->end), 1, 0};
    }
    double tau = (t - m->start) / length;
    return m->of_speed ? ramp_of_speed(tau, length) : ramp_of_position(tau, length);
}

bough_motion_point bough_motion_at(const bough_motion *m, double t) {
    int i = 0;
    while (i < m->n && t >= m->times[i]) i++;
    double d = t - (m->n == 0 ? 0 : m->times[i == 0 ? 0 : i - 1]);
    const double *c = m->piece + 4 * i;
    bough_motion_point p = {c[0] + d * (c[1] + d * (c[2] + d * c[3])), c[1] + d * (2 * c[2] + d * 3 * c[3]),
                            2 * c[2] + d * 6 * c[3]};
    if (m->rise == 0) return p;
    bough_motion_point r = unit_ramp(m, t);
    return (bough_motion_point){p.q + m->rise * r.q, p.v + m->rise * r.v, p.a + m->rise * r.a};
}

// -- tables ----------------------------------------------------------------------------------

// A speed linear in pieces: q is its integral.
static void integrate_speeds(const bough_motion_def *def, bough_motion *m) {
    double q = 0;
    m->piece[1] = def->values[0];
    for (int i = 0; i < def->n; i++) {
        double *c = m->piece + 4 * (i + 1), v = def->values[i];
        c[0] = q;
        c[1] = v;
        if (i == def->n - 1) break;
        double d = def->times[i + 1] - def->times[i];
        c[2] = 0.5 * (def->values[i + 1] - v) / d;
        q += d * 0.5 * (v + def->values[i + 1]);
    }
}

static double chord_slope(const bough_motion_def *def, int i) {
    return (def->values[i + 1] - def->values[i]) / (def->times[i + 1] - def->times[i]);
}

// Slopes of the cubic spline, zero at both ends, by elimination of its tridiagonal equations
//     (s_{i−1} + 2 s_i)/d_{i−1} + (2 s_i + s_{i+1})/d_i = 3 (r_{i−1}/d_{i−1} + r_i/d_i),
// r_i the slope of the chord; `gain` (n) is scratch.
static void spline_slopes(const bough_motion_def *def, double *slope, double *gain) {
    int last = def->n - 1;
    slope[0] = slope[last] = gain[0] = 0;
    for (int i = 1; i < last; i++) {
        double left = 1 / (def->times[i] - def->times[i - 1]);
        double right = 1 / (def->times[i + 1] - def->times[i]);
        double pivot = 2 * (left + right) - left * gain[i - 1];
        double side = 3 * left * chord_slope(def, i - 1) + 3 * right * chord_slope(def, i);
        gain[i] = right / pivot;
        slope[i] = (side - left * slope[i - 1]) / pivot;
    }
    for (int i = last - 1; i > 0; i--) slope[i] -= gain[i] * slope[i + 1];
}

// The largest slope at an end of interval i, where the spline has `slope`, without an overshoot: three times
// the chord's. Near the top of a smooth curve a parabola through the neighbouring points has half of their
// step per interval as its slope; a little more than that is allowed.
static double largest_slope(const bough_motion_def *def, int i, double slope) {
    double most = 3 * fabs(chord_slope(def, i));
    if (i == 0 || i == def->n - 2) return most;
    double d = def->times[i + 1] - def->times[i];
    double before = def->values[i] - def->values[i - 1], after = def->values[i + 2] - def->values[i + 1];
    bool top = before * after < 0 && fabs(slope) < most + 0.6 * fmin(fabs(before), fabs(after)) / d;
    return top ? fabs(slope) : most;
}

// Slopes with which the motion rises and falls where the values do (J. Hyman, SIAM J. Sci. Stat. Comput. 4
// (1983)). The spline's are kept where they suit; elsewhere the acceleration jumps, as at the corners of a
// table of speeds.
static void limit_slopes(const bough_motion_def *def, double *slope) {
    for (int i = 1; i < def->n - 1; i++) {
        double before = chord_slope(def, i - 1), after = chord_slope(def, i);
        double most = fmin(largest_slope(def, i - 1, slope[i]), largest_slope(def, i, slope[i]));
        bool rises = before > 0 && after > 0, falls = before < 0 && after < 0;
        slope[i] = bough_clamp(slope[i], rises ? 0 : -most, falls ? 0 : most);
    }
}

static void fit_positions(const bough_motion_def *def, bough_motion *m, double *slope) {
    spline_slopes(def, slope, slope + def->n);
    limit_slopes(def, slope);
    m->piece[0] = def->values[0];
    for (int i = 0; i < def->n; i++) {
        double *c = m->piece + 4 * (i + 1);
        c[0] = def->values[i];
        if (i == def->n - 1) break;
        double d = def->times[i + 1] - def->times[i];
        c[1] = slope[i];
        bough_cubic_bend(chord_slope(def, i), slope[i], slope[i + 1], d, c + 2);
    }
}

// -- construction ----------------------------------------------------------------------------

bough_motion *bough_motion_create(bough_arena *arena, const bough_motion_def *def, double initial) {
    size_t n = (size_t)def->n;
    bough_motion *m = bough_arena_take(arena, sizeof *m);
    size_t room = n > 0 ? n : 1; // a motion that is set during a run has one break
    double *times = bough_arena_doubles(arena, room);
    double *piece = bough_arena_doubles(arena, 4 * room + 4);
    double *slope = bough_arena_doubles(arena, 2 * n);
    *m = (bough_motion){.n = def->n, .times = times, .piece = piece, .of_speed = def->speed};
    if (n == 0) {
        piece[def->speed ? 1 : 0] = def->from;
        m->rise = def->to - def->from, m->start = def->start, m->end = def->end;
    } else {
        memcpy(times, def->times, n * sizeof(double));
        if (def->speed) {
            integrate_speeds(def, m);
        } else {
            fit_positions(def, m, slope);
        }
    }
    double shift = def->speed ? initial - bough_motion_at(m, 0).q : 0;
    for (int i = 0; i <= def->n; i++) piece[4 * i] += shift;
    return m;
}

void bough_motion_steer(bough_motion *m, double t, double span, bough_motion_point from,
                        bough_motion_point to) {
    double *c = m->piece;
    m->n = 1;
    m->times[0] = t;
    m->rise = 0;
    c[0] = from.q;
    c[1] = from.v;
    bough_cubic_bend((to.q - from.q) / span, from.v, to.v, span, c + 2);
    memcpy(c + 4, c, 4 * sizeof *c);
}
