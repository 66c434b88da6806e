// Samples of the wind at equal times: a table or a hub-height file can rise and fall between two of them,
// which no sample shows, or jump there.
#include "aero/wind/wind.h"

// The hub, and a point that has both shears of a hub-height file.
enum { POINTS = 2 };

typedef struct samples {
    const bough_wind *wind;
    double period;                        // from one sample to the next [s]
    bough_vec3 point[POINTS];             // at which the wind is evaluated
    bough_vec3 low[POINTS], high[POINTS]; // over all times [m/s]
    bough_wind_missed missed;
} samples;

static bough_vec3 least(bough_vec3 a, bough_vec3 b) {
    return bough_v3(fmin(a.x, b.x), fmin(a.y, b.y), fmin(a.z, b.z));
}

static bough_vec3 most(bough_vec3 a, bough_vec3 b) {
    return bough_v3(fmax(a.x, b.x), fmax(a.y, b.y), fmax(a.z, b.z));
}

// The largest component of how far v lies outside of the range from low to high.
static double beyond(bough_vec3 v, bough_vec3 low, bough_vec3 high) {
    double x = fmax(low.x - v.x, v.x - high.x), y = fmax(low.y - v.y, v.y - high.y);
    double z = fmax(low.z - v.z, v.z - high.z);
    return fmax(fmax(x, y), fmax(z, 0));
}

// A row of the table between two samples.
static void look(samples *s, double t) {
    double before = floor(t / s->period) * s->period, after = before + s->period;
    for (int k = 0; k < POINTS; k++) {
        bough_vec3 v = bough_wind_at(s->wind, s->point[k], t);
        bough_vec3 a = bough_wind_at(s->wind, s->point[k], before);
        bough_vec3 b = bough_wind_at(s->wind, s->point[k], after);
        double missed = beyond(v, least(a, b), most(a, b));
        if (missed > s->missed.speed) s->missed.speed = missed, s->missed.time = t;
        s->low[k] = least(s->low[k], v), s->high[k] = most(s->high[k], v);
    }
}

static double largest_range(const samples *s) {
    double range = 0;
    for (int k = 0; k < POINTS; k++) {
        bough_vec3 d = bough_sub(s->high[k], s->low[k]);
        range = fmax(range, fmax(d.x, fmax(d.y, d.z)));
    }
    return range;
}

// Of the table or the hub-height file; 0 for other winds.
static int row_count(const bough_wind *wind) {
    if (wind->hub) return wind->hub->n;
    return wind->box || wind->iec ? 0 : wind->def.n_time;
}

double bough_wind_row_time(const bough_wind *wind, int row) {
    return wind->hub ? wind->hub->row[row].time : wind->def.time[row];
}

bough_wind_missed bough_wind_between(const bough_wind *wind, double period, double until) {
    const bough_wind_def *def = &wind->def;
    int n = row_count(wind);
    double aside = wind->hub ? 0.5 * def->reference_length : 0;
    samples s = {
        .wind = wind,
        .period = period,
        .point = {bough_v3(0, 0, def->reference_height), bough_v3(0, aside, def->reference_height + aside)}};
    for (int k = 0; k < POINTS; k++) s.low[k] = s.high[k] = bough_wind_at(wind, s.point[k], 0);
    // what two samples do not show is at the rows between them
    for (int i = 0; i < n; i++) {
        double t = bough_wind_row_time(wind, i);
        if (t > 0 && t < until) look(&s, t);
    }
    s.missed.range = largest_range(&s);
    return s.missed;
}

static const double large = 0.1; // change of the wind, of the higher speed

// Whether the wind jumps from row k to the next.
static bool jumps(const bough_wind *wind, int k, double period) {
    double start = bough_wind_row_time(wind, k), end = bough_wind_row_time(wind, k + 1);
    if (end - start >= period) return false;
    if (k > 0 && start - bough_wind_row_time(wind, k - 1) < period) return false;
    if (k + 2 < row_count(wind) && bough_wind_row_time(wind, k + 2) - end < period) return false;
    bough_vec3 point = bough_v3(0, 0, wind->def.reference_height);
    bough_vec3 a = bough_wind_at(wind, point, start), b = bough_wind_at(wind, point, end);
    return bough_norm(bough_sub(b, a)) > large * fmax(bough_norm(a), bough_norm(b));
}

int bough_wind_jump(const bough_wind *wind, double period, int row) {
    for (int k = row; k + 1 < row_count(wind); k++)
        if (jumps(wind, k, period)) return k;
    return -1;
}
