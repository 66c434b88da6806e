// What samples of the wind at equal times miss: a table or a hub-height file can rise and fall between two of
// them, which no sample shows.
#include "aero/wind/wind.h"

#include <math.h>

// Of the hub, and of a point that feels both shears of a hub-height file.
enum { POINTS = 2 };

typedef struct samples {
    const bough_wind *wind;
    double period;                        // from one sample to the next [s]
    bough_vec3 point[POINTS];             // where the wind is looked at
    bough_vec3 low[POINTS], high[POINTS]; // over all times looked at [m/s]
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

bough_wind_missed bough_wind_between(const bough_wind *wind, double period, double until) {
    const bough_wind_def *def = &wind->def;
    bool file = wind->hub != NULL;
    int n = file ? wind->hub->n : wind->box || wind->iec ? 0 : def->n_time;
    double aside = file ? 0.5 * def->reference_length : 0;
    samples s = {
        .wind = wind,
        .period = period,
        .point = {bough_v3(0, 0, def->reference_height), bough_v3(0, aside, def->reference_height + aside)}};
    for (int k = 0; k < POINTS; k++) s.low[k] = s.high[k] = bough_wind_at(wind, s.point[k], 0);
    for (int i = 0; i < n; i++) {
        double t = file ? wind->hub->row[i].time : def->time[i];
        if (t > 0 && t < until) look(&s, t);
    }
    s.missed.range = largest_range(&s);
    return s.missed;
}
