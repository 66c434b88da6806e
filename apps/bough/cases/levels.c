#include "apps/bough/cases/counts.h"

#include <math.h>
#include <string.h>

// Bits of the first value that the finest bins resolve, and those of a whole double.
enum { FINEST = 40, MOST_SHIFT = 62 };

static int slot(int64_t bin) { return (int)(((bin % BOUGH_LEVELS) + BOUGH_LEVELS) % BOUGH_LEVELS); }

static double bin_of(double x, int exponent) { return floor(ldexp(x, -exponent)); }

// Rounded down, also below zero.
static int64_t halved(int64_t bin, int shift) {
    if (shift > MOST_SHIFT) return bin < 0 ? -1 : 0;
    int64_t unit = (int64_t)1 << shift;
    return bin >= 0 ? bin / unit : -((-bin - 1) / unit) - 1;
}

static bool is_multiple(int64_t bin, int shift) {
    return shift > MOST_SHIFT ? bin == 0 : bin % ((int64_t)1 << shift) == 0;
}

// Wider bins; of the edges only the common ones remain.
static void coarsen(bough_levels *l, int exponent) {
    int shift = exponent - l->exponent;
    if (shift <= 0) return;
    bough_levels old = *l;
    memset(l->inside, 0, sizeof l->inside);
    memset(l->crossed, 0, sizeof l->crossed);
    for (int64_t k = old.low; k <= old.high; k++) {
        int64_t wide = halved(k, shift);
        l->inside[slot(wide)] += old.inside[slot(k)];
        if (is_multiple(k, shift)) l->crossed[slot(wide)] = old.crossed[slot(k)];
    }
    l->low = halved(old.low, shift);
    l->high = halved(old.high, shift);
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

// Brings x into the bins in use; x is finite.
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
    levels->inside[slot(reach(levels, x))] += count;
    levels->last = x;
}

void bough_levels_follow(bough_levels *levels, double x) {
    if (!isfinite(x)) return;
    bool first = !levels->started;
    int64_t to = reach(levels, x);
    int64_t from = first ? to : (int64_t)bin_of(levels->last, levels->exponent);
    for (int64_t k = from + 1; k <= to; k++) levels->crossed[slot(k)]++;
    levels->inside[slot(to)]++;
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
        levels->inside[slot(k)] += inside * same.inside[slot(k)];
        levels->crossed[slot(k)] += crossed * same.crossed[slot(k)];
    }
}

double bough_levels_width(const bough_levels *levels) { return ldexp(1, levels->exponent); }

static bool is_used(const bough_levels *l, int64_t bin) {
    return l->started && bin >= l->low && bin <= l->high;
}

double bough_levels_inside(const bough_levels *levels, int64_t bin) {
    return is_used(levels, bin) ? levels->inside[slot(bin)] : 0;
}

double bough_levels_crossed(const bough_levels *levels, int64_t bin) {
    return is_used(levels, bin) ? levels->crossed[slot(bin)] : 0;
}
