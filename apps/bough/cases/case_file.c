#include "apps/bough/cases/case_file.h"

#include "apps/bough/cases/result_file.h"

#include <math.h>
#include <string.h>

static bough_result_file file_of(const char *folder, const bough_load_set *set, int number) {
    bough_result_file file = {.folder = folder, .fingerprint = set->cases[number].fingerprint};
    snprintf(file.name, sizeof file.name, "%06d", number + 1);
    return file;
}

// The place of a bin in the counts.
static int slot(int64_t bin) { return (int)(((bin % BOUGH_LEVELS) + BOUGH_LEVELS) % BOUGH_LEVELS); }

// -- writing --------------------------------------------------------------------------------------

static void put_levels(FILE *f, const char *name, const bough_levels *l) {
    const double range[] = {l->started, l->exponent, (double)l->low, (double)l->high};
    double inside[BOUGH_LEVELS], crossed[BOUGH_LEVELS];
    int n = l->started ? (int)(l->high - l->low) + 1 : 0;
    for (int i = 0; i < n; i++) {
        inside[i] = bough_levels_inside(l, l->low + i);
        crossed[i] = bough_levels_crossed(l, l->low + i);
    }
    bough_result_put(f, name, 4, range);
    bough_result_put(f, "inside", n, inside);
    bough_result_put(f, "crossed", n, crossed);
}

static void put_channel(FILE *f, const bough_load_set *set, const bough_channel_counts *c) {
    const bough_sample_statistics *s = &c->statistics;
    const double statistics[] = {s->n, s->mean, s->squares, s->least, s->most, s->least_at, s->most_at};
    const double cycles[] = {c->rainflow.cycles, c->rainflow.forced};
    bough_result_put(f, "statistics", 7, statistics);
    if (set->sweep) return;
    bough_result_put(f, "cycles", 2, cycles);
    bough_result_put(f, "damage", set->n_slope, c->rainflow.damage);
    put_levels(f, "ranges", &c->rainflow.ranges);
    put_levels(f, "levels", &c->levels);
    bough_result_put(f, "least", set->n_channel, c->at_least);
    bough_result_put(f, "most", set->n_channel, c->at_most);
}

typedef struct content {
    const bough_load_set *set;
    const bough_case_result *result;
} content;

static void put_result(const void *self, FILE *f) {
    const content *x = self;
    const bough_case_result *r = x->result;
    const double run[] = {r->time, r->counted, r->cpu, r->wall, r->counts.broken};
    bough_result_put(f, "run", 5, run);
    for (int i = 0; bough_is_ok(&r->outcome) && i < x->set->n_channel; i++)
        put_channel(f, x->set, &r->counts.channel[i]);
}

bough_status bough_case_write(const char *folder, const bough_load_set *set, int number,
                              const bough_case_result *result) {
    const bough_result_file file = file_of(folder, set, number);
    const content x = {set, result};
    return bough_result_write(&file, &result->outcome, put_result, &x);
}

// -- reading --------------------------------------------------------------------------------------

static bool take_levels(FILE *f, const char *name, bough_levels *l) {
    double range[4], inside[BOUGH_LEVELS], crossed[BOUGH_LEVELS];
    memset(l, 0, sizeof *l);
    if (!bough_result_take(f, name, 4, range)) return false;
    for (int i = 0; i < 4; i++)
        if (!(fabs(range[i]) < 1e15)) return false;
    l->started = range[0] > 0;
    l->exponent = (int)fmax(-9999, fmin(range[1], 9999));
    l->low = (int64_t)range[2];
    l->high = (int64_t)range[3];
    if (l->started && (l->high < l->low || l->high - l->low >= BOUGH_LEVELS)) return false;
    int n = l->started ? (int)(l->high - l->low) + 1 : 0;
    if (!bough_result_take(f, "inside", n, inside) || !bough_result_take(f, "crossed", n, crossed))
        return false;
    for (int i = 0; i < n; i++) {
        l->inside[slot(l->low + i)] = inside[i];
        l->crossed[slot(l->low + i)] = crossed[i];
    }
    return true;
}

static bool take_channel(FILE *f, const bough_load_set *set, bough_channel_counts *c) {
    double s[7], cycles[2];
    if (!bough_result_take(f, "statistics", 7, s)) return false;
    c->statistics = (bough_sample_statistics){s[0], s[1], s[2], s[3], s[4], s[5], s[6]};
    if (set->sweep) return true;
    if (!bough_result_take(f, "cycles", 2, cycles)) return false;
    c->rainflow.cycles = cycles[0];
    c->rainflow.forced = cycles[1];
    return bough_result_take(f, "damage", set->n_slope, c->rainflow.damage) &&
           take_levels(f, "ranges", &c->rainflow.ranges) && take_levels(f, "levels", &c->levels) &&
           bough_result_take(f, "least", set->n_channel, c->at_least) &&
           bough_result_take(f, "most", set->n_channel, c->at_most);
}

static bool take_result(FILE *f, const bough_load_set *set, bough_case_result *r) {
    double run[5];
    if (!bough_result_take(f, "run", 5, run)) return false;
    r->time = run[0];
    r->counted = run[1];
    r->cpu = run[2];
    r->wall = run[3];
    r->counts.broken = run[4];
    for (int i = 0; bough_is_ok(&r->outcome) && i < set->n_channel; i++)
        if (!take_channel(f, set, &r->counts.channel[i])) return false;
    return true;
}

bough_status bough_case_read(const char *folder, const bough_load_set *set, int number,
                             bough_case_result *result) {
    const bough_result_file file = file_of(folder, set, number);
    FILE *stream;
    bough_status status = bough_result_open(&file, &result->outcome, &stream);
    result->done = false;
    if (!stream) return status;
    status = bough_result_close(&file, stream, take_result(stream, set, result));
    result->done = bough_is_ok(&status);
    return status;
}

bool bough_case_exists(const char *folder, const bough_load_set *set, int number) {
    const bough_result_file file = file_of(folder, set, number);
    bough_status outcome;
    FILE *stream;
    bough_result_open(&file, &outcome, &stream);
    if (stream) fclose(stream);
    return stream != NULL;
}
