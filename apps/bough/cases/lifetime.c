#include "apps/bough/cases/perform.h"

// Hours, or number of events, that a case represents.
static double hours_of(const bough_study *study, int number) {
    return bough_case_weight(study, &study->cases[number], 3600);
}

bough_lifetime bough_lifetime_take(bough_arena *arena, const bough_study *study) {
    size_t n = (size_t)study->n_channel;
    bough_lifetime l = {.study = study, .channel = bough_arena_take(arena, n * sizeof *l.channel)};
    double *rows = bough_arena_doubles(arena, 2 * n * n);
    for (size_t i = 0; i < n; i++) {
        l.channel[i].least.row = rows + 2 * i * n;
        l.channel[i].most.row = rows + (2 * i + 1) * n;
    }
    size_t rows_of_errors = (size_t)study->n_group + 1;
    l.n_compared = bough_arena_take(arena, rows_of_errors * sizeof *l.n_compared);
    l.errors = bough_arena_take(arena, rows_of_errors * n * sizeof *l.errors);
    for (int i = 0; i < study->n_case; i++) l.total += hours_of(study, i);
    return l;
}

// sign: 1 of a maximum, −1 of a minimum.
static void add_extreme(bough_extreme *e, const bough_study *study, int number, int channel,
                        const bough_channel_counts *c, int sign) {
    const bough_sample_statistics *s = &c->statistics;
    double value = sign > 0 ? s->most : s->least;
    const bough_load_group *g = &study->group[study->cases[number].group];
    double factor = !study->load[channel] ? 1 : sign * value < 0 ? g->favourable : g->factor;
    if (e->found && !(sign * factor * value > sign * e->factor * e->value)) return;
    e->found = true;
    e->value = value;
    e->factor = factor;
    e->range = s->most - s->least;
    e->at = sign > 0 ? s->most_at : s->least_at;
    e->number = number;
    memcpy(e->row, sign > 0 ? c->at_most : c->at_least, (size_t)study->n_channel * sizeof *e->row);
}

static void add_extremes(bough_lifetime *l, int number, int i, const bough_channel_counts *c) {
    bough_lifetime_channel *to = &l->channel[i];
    if (!l->study->group[l->study->cases[number].group].extremes || c->statistics.n == 0) return;
    add_extreme(&to->least, l->study, number, i, c, -1);
    add_extreme(&to->most, l->study, number, i, c, 1);
}

static void add_fatigue(bough_lifetime *l, int i, const bough_channel_counts *c, double weight,
                        double counted) {
    bough_lifetime_channel *to = &l->channel[i];
    double step = c->statistics.n > 0 ? counted / c->statistics.n : 0; // [s]
    for (int k = 0; k < l->study->n_slope; k++) to->damage[k] += weight * c->rainflow.damage[k];
    to->cycles += weight * c->rainflow.cycles;
    bough_levels_merge(&to->ranges, &c->rainflow.ranges, weight, 0);
    bough_levels_merge(&to->levels, &c->levels, weight * step / 3600, weight);
}

static void add_errors(bough_lifetime *l, int number, const bough_case_result *r, double weight) {
    const bough_study *study = l->study;
    const int rows[] = {study->cases[number].group, study->n_group};
    for (int row = 0; row < 2; row++) {
        l->n_compared[rows[row]]++;
        for (int i = 0; i < study->n_channel; i++) {
            const bough_sample_statistics *s = &r->counts.channel[i].statistics;
            bough_extreme_errors *to = &l->errors[rows[row] * study->n_channel + i];
            to->range += (s->most - s->least) * (s->most - s->least);
            to->least += r->load_error[i].least * r->load_error[i].least;
            to->most += r->load_error[i].most * r->load_error[i].most;
        }
    }
    for (int i = 0; i < study->n_channel; i++) {
        for (int k = 0; k < study->n_slope; k++) {
            l->channel[i].compared[k] += weight * r->load_error[i].damage[k];
            l->channel[i].larger[k] += weight * r->load_error[i].larger[k];
        }
    }
}

void bough_lifetime_add(bough_lifetime *l, int number, const bough_case_result *r) {
    const bough_study *study = l->study;
    l->simulated += r->done ? r->time : 0;
    l->cpu += r->done ? r->cpu : 0;
    if (!bough_held(r)) {
        l->n_missing += !r->done;
        l->n_failed += r->done;
        l->missing += l->total > 0 ? hours_of(study, number) / l->total : 1. / study->n_case;
        return;
    }
    double weight = bough_case_weight(study, &study->cases[number], r->counted);
    l->hours += weight * r->counted / 3600;
    for (int i = 0; i < study->n_channel; i++) {
        const bough_channel_counts *c = &r->counts.channel[i];
        add_extremes(l, number, i, c);
        if (weight > 0) add_fatigue(l, i, c, weight, r->counted);
    }
    if (r->has_companion) add_errors(l, number, r, weight);
}

double bough_lifetime_equivalent(const bough_lifetime *l, int channel, int slope) {
    return bough_equivalent_load(l->channel[channel].damage[slope], l->study->slope[slope], l->study->cycles);
}

// x/whole; 0 for 0/0.
static double ratio(double x, double whole) { return x == 0 ? 0 : whole > 0 ? x / whole : (double)NAN; }

double bough_lifetime_equivalent_error(const bough_lifetime *l, int channel, int slope) {
    const bough_lifetime_channel *c = &l->channel[channel];
    double m = l->study->slope[slope];
    if (l->n_compared[l->study->n_group] == 0) return (double)NAN;
    double load = bough_equivalent_load(c->compared[slope], m, l->study->cycles);
    double larger = bough_equivalent_load(c->larger[slope], m, l->study->cycles);
    return ratio(fmax(larger - load, 0), load) * bough_lifetime_equivalent(l, channel, slope);
}

double bough_lifetime_extreme_error(const bough_lifetime *l, int channel, const bough_extreme *e) {
    int group = l->study->cases[e->number].group;
    int row = l->n_compared[group] > 0 ? group : l->study->n_group;
    const bough_extreme_errors *sum = &l->errors[row * l->study->n_channel + channel];
    if (!e->found || l->n_compared[row] == 0) return (double)NAN;
    bool least = e == &l->channel[channel].least;
    return sqrt(ratio(least ? sum->least : sum->most, sum->range)) * e->range;
}
