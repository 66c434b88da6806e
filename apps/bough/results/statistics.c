#include "apps/bough/results/statistics.h"

#include <math.h>

void bough_sample_statistics_add(bough_sample_statistics *s, double t, double x) {
    if (s->n == 0 || x < s->least) {
        s->least = x;
        s->least_at = t;
    }
    if (s->n == 0 || x > s->most) {
        s->most = x;
        s->most_at = t;
    }
    s->n++;
    double off = x - s->mean;
    s->mean += off / s->n;
    s->squares += off * (x - s->mean);
}

double bough_sample_statistics_deviation(const bough_sample_statistics *s) {
    return s->n > 0 ? sqrt(s->squares / s->n) : (double)NAN;
}
