#include "apps/bough/cases/counts.h"

// -- levels ---------------------------------------------------------------------------------------

// Bits of the first value that the finest bins resolve; bits of the largest shift of a bin's number.
enum { FINEST = 40, MOST_SHIFT = 62 };

static double bin_of(double x, int exponent) { return floor(ldexp(x, -exponent)); }

// Rounded down, also below zero.
static int64_t halved(int64_t bin, int64_t unit) { return bin >= 0 ? bin / unit : -((-bin - 1) / unit) - 1; }

// Merges bins to this exponent; crossings of edges that remain are kept.
static void coarsen(bough_levels *l, int exponent) {
    int shift = exponent - l->exponent;
    if (shift <= 0) return;
    int64_t unit = (int64_t)1 << (shift < MOST_SHIFT ? shift : MOST_SHIFT);
    bough_levels old = *l;
    memset(l->inside, 0, sizeof l->inside);
    memset(l->crossed, 0, sizeof l->crossed);
    for (int64_t k = old.low; k <= old.high; k++) {
        int64_t wide = halved(k, unit);
        l->inside[bough_levels_slot(wide)] += old.inside[bough_levels_slot(k)];
        if (k % unit == 0) l->crossed[bough_levels_slot(wide)] = old.crossed[bough_levels_slot(k)];
    }
    l->low = halved(old.low, unit);
    l->high = halved(old.high, unit);
    l->exponent = exponent;
}

static void start(bough_levels *l, int exponent, int64_t bin) {
    l->started = true;
    l->exponent = exponent;
    l->low = l->high = bin;
}

// The least exponent from `exponent` on whose bins hold both.
static int fitting(double least, double most, int exponent) {
    while (bin_of(most, exponent) - bin_of(least, exponent) + 1 > BOUGH_LEVELS) exponent++;
    return exponent;
}

// Extends the bins in use to a finite x and returns its bin.
static int64_t reach(bough_levels *l, double x) {
    int first;
    if (!l->started) {
        frexp(x, &first);
        start(l, first - FINEST, (int64_t)bin_of(x, first - FINEST));
    }
    double least = ldexp((double)l->low, l->exponent), most = ldexp((double)l->high, l->exponent);
    coarsen(l, fitting(fmin(x, least), fmax(x, most), l->exponent));
    int64_t bin = (int64_t)bin_of(x, l->exponent);
    if (bin < l->low) l->low = bin;
    if (bin > l->high) l->high = bin;
    return bin;
}

void bough_levels_add(bough_levels *levels, double x, double count) {
    if (!isfinite(x)) return;
    levels->inside[bough_levels_slot(reach(levels, x))] += count;
    levels->last = x;
}

void bough_levels_follow(bough_levels *levels, double x) {
    if (!isfinite(x)) return;
    bool first = !levels->started;
    int64_t to = reach(levels, x);
    int64_t from = first ? to : (int64_t)bin_of(levels->last, levels->exponent);
    for (int64_t k = from + 1; k <= to; k++) levels->crossed[bough_levels_slot(k)]++;
    levels->inside[bough_levels_slot(to)]++;
    levels->last = x;
}

void bough_levels_merge(bough_levels *levels, const bough_levels *part, double inside, double crossed) {
    if (!part->started) return;
    double least = ldexp((double)part->low, part->exponent);
    double most = ldexp((double)part->high, part->exponent);
    if (!levels->started) start(levels, part->exponent, part->low);
    if (part->exponent > levels->exponent) coarsen(levels, part->exponent);
    reach(levels, least);
    reach(levels, most);
    bough_levels same = *part;
    coarsen(&same, levels->exponent);
    for (int64_t k = same.low; k <= same.high; k++) {
        levels->inside[bough_levels_slot(k)] += inside * same.inside[bough_levels_slot(k)];
        levels->crossed[bough_levels_slot(k)] += crossed * same.crossed[bough_levels_slot(k)];
    }
}

double bough_levels_width(const bough_levels *levels) { return ldexp(1, levels->exponent); }

static bool is_used(const bough_levels *l, int64_t bin) {
    return l->started && bin >= l->low && bin <= l->high;
}

double bough_levels_inside(const bough_levels *levels, int64_t bin) {
    return is_used(levels, bin) ? levels->inside[bough_levels_slot(bin)] : 0;
}

double bough_levels_crossed(const bough_levels *levels, int64_t bin) {
    return is_used(levels, bin) ? levels->crossed[bough_levels_slot(bin)] : 0;
}

// -- rainflow -------------------------------------------------------------------------------------

static void count(bough_rainflow *r, double range, double cycles) {
    for (int i = 0; i < r->n_slope; i++) r->damage[i] += cycles * pow(range, r->slope[i]);
    r->cycles += cycles;
    bough_levels_add(&r->ranges, range, cycles);
}

static double range_before(const bough_rainflow *r, int back) {
    return fabs(r->point[r->n - back] - r->point[r->n - back - 1]);
}

// Step 5 of the standard: half a cycle; its first point is dropped.
static void count_start(bough_rainflow *r) {
    count(r, range_before(r, 2), 0.5);
    memmove(r->point, r->point + 1, (size_t)--r->n * sizeof *r->point);
}

// Step 4: a whole cycle; its two points are dropped.
static void count_inside(bough_rainflow *r) {
    count(r, range_before(r, 2), 1);
    r->point[r->n - 3] = r->point[r->n - 1];
    r->n -= 2;
}

// Adds a reversal of the load and counts the ranges that it completes.
static void reversal(bough_rainflow *r, double point) {
    r->point[r->n++] = point;
    while (r->n >= 3 && range_before(r, 1) >= range_before(r, 2)) {
        if (r->n == 3)
            count_start(r);
        else
            count_inside(r);
    }
    if (r->n < BOUGH_RAINFLOW_OPEN) return;
    count(r, range_before(r, 1), 1);
    r->forced++;
    r->n -= 2;
}

void bough_rainflow_add(bough_rainflow *r, double x) {
    if (!r->started) {
        r->started = true;
        r->point[r->n++] = r->last = x;
        return;
    }
    int direction = (x > r->last) - (x < r->last);
    if (direction == 0) return;
    if (r->direction != 0 && direction != r->direction) reversal(r, r->last);
    r->direction = direction;
    r->last = x;
}

void bough_rainflow_finish(bough_rainflow *r) {
    if (r->direction != 0) reversal(r, r->last);
    for (; r->n > 1; r->n--) count(r, range_before(r, 1), 0.5);
}

// theory (99)
double bough_equivalent_load(double sum, double slope, double cycles) { return pow(sum / cycles, 1 / slope); }

// -- all counts of a run --------------------------------------------------------------------------

void bough_counts_take(bough_arena *arena, int n_channel, int n_slope, const double *slope,
                       bough_counts *counts) {
    size_t n = (size_t)n_channel;
    *counts = (bough_counts){.n_channel = n_channel};
    counts->channel = bough_arena_take(arena, n * sizeof *counts->channel);
    double *rows = bough_arena_doubles(arena, 2 * n * n);
    for (size_t i = 0; i < n; i++) {
        bough_channel_counts *c = &counts->channel[i];
        c->rainflow.n_slope = n_slope;
        for (int k = 0; k < n_slope; k++) c->rainflow.slope[k] = slope[k];
        c->at_least = rows + 2 * i * n;
        c->at_most = c->at_least + n;
    }
}

static void add(bough_channel_counts *c, double t, double x, const double *row, size_t size) {
    bough_sample_statistics *s = &c->statistics;
    bool first = s->n == 0, least = first || x < s->least, most = first || x > s->most;
    bough_sample_statistics_add(s, t, x);
    if (least) memcpy(c->at_least, row, size);
    if (most) memcpy(c->at_most, row, size);
    bough_rainflow_add(&c->rainflow, x);
    bough_levels_follow(&c->levels, x);
}

void bough_counts_add(bough_counts *counts, double t, const double *value) {
    int n = counts->n_channel;
    if (!bough_all_finite(n, value)) {
        counts->broken++;
        return;
    }
    for (int i = 0; i < n; i++) add(&counts->channel[i], t, value[i], value, (size_t)n * sizeof *value);
}

void bough_counts_finish(bough_counts *counts) {
    for (int i = 0; i < counts->n_channel; i++) bough_rainflow_finish(&counts->channel[i].rainflow);
}
