#include "apps/bough/cases/lifetime.h"

#include <string.h>

// Hours, or of events their number, that a case stands for.
static double hours_of(const bough_study *set, int number) {
    return bough_case_weight(set, &set->cases[number], 3600);
}

bough_lifetime bough_lifetime_take(bough_arena *arena, const bough_study *set) {
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

// Forces and moments, also per length: their units begin with a newton.
static bool is_load(const char *unit) {
    const char *base = unit + strspn(unit, "kM");
    return base[0] == 'N' && (base[1] == '\0' || base[1] == '-' || base[1] == '/');
}

// sign: 1 for a largest value, -1 for a smallest.
static double factor_of(const bough_load_group *g, const char *unit, double value, int sign) {
    if (!is_load(unit)) return 1;
    return sign * value < 0 ? g->favourable : g->factor;
}

static void add_extreme(bough_extreme *e, const bough_study *set, int number, int channel, double value,
                        double at, const double *row, int sign) {
    double factor = factor_of(&set->group[set->cases[number].group], set->unit[channel], value, sign);
    if (e->found && !(sign * factor * value > sign * e->factor * e->value)) return;
    e->found = true;
    e->value = value;
    e->factor = factor;
    e->at = at;
    e->number = number;
    memcpy(e->row, row, (size_t)set->n_channel * sizeof *row);
}

static void add_extremes(bough_lifetime *l, int number, int i, const bough_channel_counts *c) {
    const bough_sample_statistics *s = &c->statistics;
    bough_lifetime_channel *to = &l->channel[i];
    if (!l->set->group[l->set->cases[number].group].extremes || s->n == 0) return;
    add_extreme(&to->least, l->set, number, i, s->least, s->least_at, c->at_least, -1);
    add_extreme(&to->most, l->set, number, i, s->most, s->most_at, c->at_most, 1);
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
    const bough_study *set = l->set;
    l->simulated += r->done ? r->time : 0;
    l->cpu += r->done ? r->cpu : 0;
    if (!r->done || !bough_is_ok(&r->outcome)) {
        l->n_missing += !r->done;
        l->n_failed += r->done;
        l->lacking += l->total > 0 ? hours_of(set, number) / l->total : 1. / set->n_case;
        return;
    }
    double weight = bough_case_weight(set, &set->cases[number], r->counted);
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
