#include "apps/study/lifetime.h"

#include <string.h>

// Hours, or of events their number, that a case stands for.
static double hours_of(const bough_load_set *set, int number) {
    return bough_load_set_weight(set, &set->cases[number], 3600);
}

bough_lifetime bough_lifetime_take(bough_arena *arena, const bough_load_set *set) {
    size_t n = (size_t)set->n_channel;
    bough_lifetime l = {.set = set, .channel = bough_arena_take(arena, n * sizeof *l.channel)};
    double *rows = bough_arena_doubles(arena, 2 * n * n);
    for (size_t i = 0; i < n; i++) {
        l.channel[i].least.row = rows + 2 * i * n;
        l.channel[i].most.row = rows + (2 * i + 1) * n;
    }
    for (int i = 0; i < set->n_case; i++) l.total += hours_of(set, i);
    return l;
}

static void take_extreme(bough_extreme *e, const bough_load_set *set, int number, double value, double at,
                         const double *row) {
    double factor = set->group[set->cases[number].group].factor;
    e->found = true;
    e->value = factor * value;
    e->at = at;
    e->number = number;
    for (int i = 0; i < set->n_channel; i++) e->row[i] = factor * row[i];
}

static void add_extremes(bough_lifetime *l, int number, int i, const bough_channel_counts *c) {
    const bough_load_group *g = &l->set->group[l->set->cases[number].group];
    const bough_sample_statistics *s = &c->statistics;
    bough_lifetime_channel *to = &l->channel[i];
    if (!g->extremes || s->n == 0) return;
    if (!to->least.found || g->factor * s->least < to->least.value) {
        take_extreme(&to->least, l->set, number, s->least, s->least_at, c->at_least);
    }
    if (!to->most.found || g->factor * s->most > to->most.value) {
        take_extreme(&to->most, l->set, number, s->most, s->most_at, c->at_most);
    }
}

static void add_fatigue(bough_lifetime *l, int i, const bough_channel_counts *c, double weight,
                        double counted) {
    bough_lifetime_channel *to = &l->channel[i];
    double step = c->statistics.n > 0 ? counted / c->statistics.n : 0; // [s]
    for (int k = 0; k < l->set->n_slope; k++) to->damage[k] += weight * c->rainflow.damage[k];
    to->cycles += weight * c->rainflow.cycles;
    bough_levels_merge(&to->ranges, &c->rainflow.ranges, weight, 0);
    bough_levels_merge(&to->levels, &c->levels, weight * step / 3600, weight);
}

void bough_lifetime_add(bough_lifetime *l, int number, const bough_case_result *r) {
    const bough_load_set *set = l->set;
    l->simulated += r->done ? r->time : 0;
    l->cpu += r->done ? r->cpu : 0;
    if (!r->done || !bough_is_ok(&r->outcome)) {
        l->n_missing += !r->done;
        l->n_failed += r->done;
        l->lacking += l->total > 0 ? hours_of(set, number) / l->total : 1. / set->n_case;
        return;
    }
    double weight = bough_load_set_weight(set, &set->cases[number], r->counted);
    l->hours += weight * r->counted / 3600;
    for (int i = 0; i < set->n_channel; i++) {
        const bough_channel_counts *c = &r->counts.channel[i];
        add_extremes(l, number, i, c);
        if (weight > 0) add_fatigue(l, i, c, weight, r->counted);
    }
}

double bough_lifetime_equivalent(const bough_lifetime *l, int channel, int slope) {
    return bough_equivalent_load(l->channel[channel].damage[slope], l->set->slope[slope], l->set->cycles);
}
