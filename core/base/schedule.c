// Ramps and tables over time.
#include "core/base/schedule.h"

#include "core/base/base.h"

double bough_ramp_factor(double start, double end, double t) {
    if (end <= start) return t >= start || start == 0;
    return bough_clamp((t - start) / (end - start), 0, 1);
}

int bough_table_row(int n, const double *times, int stride, double t) {
    // bisection
    int low = 0, high = n - 1; // invariant: times[low] ≤ t < times[high]
    while (high - low > 1) {
        int middle = (low + high) / 2;
        if (t < times[middle * stride]) {
            high = middle;
        } else {
            low = middle;
        }
    }
    return low;
}

double bough_table_value(int n, const double *times, const double *values, double t) {
    // held outside, linear inside
    if (t <= times[0]) return values[0];
    if (t >= times[n - 1]) return values[n - 1];
    int k = bough_table_row(n, times, 1, t);
    double f = (t - times[k]) / (times[k + 1] - times[k]);
    return (1 - f) * values[k] + f * values[k + 1];
}

double bough_schedule_at(const bough_schedule *s, double t) {
    return s->n > 0 ? bough_table_value(s->n, s->times, s->values, t)
                    : bough_ramp_factor(s->start, s->end, t);
}
