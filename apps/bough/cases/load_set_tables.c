#include "apps/bough/cases/load_set_tables.h"

#include "apps/bough/cases/study_table.h"
#include "apps/bough/results/folder.h"

#include <inttypes.h>
#include <math.h>
#include <string.h>

// -- cases ----------------------------------------------------------------------------------------

static void head_cases(const bough_study *s, FILE *f) {
    fputs("case,", f);
    if (!s->is.weighted) {
        for (int i = 0; i < s->grid.n; i++) {
            bough_csv_text(f, s->grid.axis[i].key);
            fputc(',', f);
        }
    } else {
        fputs("load case,settings,occurrences [1],", f);
    }
    fputs("outcome", f);
    for (int i = 0; i < s->n_channel; i++) {
        static const char *const names[] = {"min", "max", "mean", "std"};
        for (int k = 0; k < 4; k++) fprintf(f, ",%s %s [%s]", s->channel[i], names[k], s->unit[i]);
        for (int k = 0; k < s->n_slope; k++)
            fprintf(f, ",%s DEL(m=%g; 1 Hz) [%s]", s->channel[i], s->slope[k], s->unit[i]);
    }
    fputc('\n', f);
}

static const char *outcome_of(const bough_case_result *r) {
    if (!r->done) return "missing";
    return bough_is_ok(&r->outcome) ? "ok" : "failed";
}

static void put_channel(const bough_study *s, const bough_case_result *r, int i, FILE *f) {
    const bough_channel_counts *c = &r->counts.channel[i];
    const bough_sample_statistics *x = &c->statistics;
    fprintf(f, ",%.10g,%.10g,%.10g,%.10g", x->least, x->most, x->mean, bough_sample_statistics_deviation(x));
    for (int k = 0; k < s->n_slope; k++) {
        fprintf(f, ",%.10g", bough_equivalent_load(c->rainflow.damage[k], s->slope[k], r->counted));
    }
}

bough_status bough_case_tables_open(const char *folder, const bough_study *set, bough_case_tables *t) {
    *t = (bough_case_tables){.set = set};
    bough_status status = bough_folder_open(folder, "cases.csv", t->cases_path, &t->cases);
    if (bough_is_ok(&status)) status = bough_folder_open(folder, "costs.csv", t->costs_path, &t->costs);
    if (!bough_is_ok(&status)) return status;
    head_cases(set, t->cases);
    fputs("case,simulated [s],cpu [s],wall [s]\n", t->costs);
    return status;
}

void bough_case_tables_add(bough_case_tables *t, int number, const bough_case_result *r) {
    const bough_study *s = t->set;
    const bough_case *c = &s->cases[number];
    FILE *f = t->cases;
    bool good = r->done && bough_is_ok(&r->outcome);
    fprintf(f, "%d,", number + 1);
    if (!s->is.weighted) {
        for (int i = 0; i < s->grid.n; i++) {
            bough_csv_text(f, s->grid.axis[i].value.item[c->index[i]].value);
            fputc(',', f);
        }
    } else {
        bough_csv_text(f, s->group[c->group].name);
        fputc(',', f);
        bough_csv_text(f, c->settings);
        fprintf(f, ",%.10g,", good ? bough_case_weight(s, c, r->counted) : 0);
    }
    fputs(outcome_of(r), f);
    for (int i = 0; i < s->n_channel; i++) {
        if (good)
            put_channel(s, r, i, f);
        else
            for (int k = 0; k < 4 + s->n_slope; k++) fputs(",nan", f);
    }
    fputc('\n', f);
    fprintf(t->costs, "%d,%.9g,%.6g,%.6g\n", number + 1, r->done ? r->time : 0, r->cpu, r->wall);
}

bough_status bough_case_tables_close(bough_case_tables *t, bool keep) {
    bough_status status = bough_ok();
    FILE *const file[] = {t->cases, t->costs};
    const char *const path[] = {t->cases_path, t->costs_path};
    for (int i = 0; i < 2; i++) {
        if (!file[i]) continue;
        if (!keep) {
            bough_folder_discard(path[i], file[i]);
            continue;
        }
        bough_status end = bough_folder_commit(path[i], file[i]);
        if (bough_is_ok(&status)) status = end;
    }
    return status;
}

// -- lifetime -------------------------------------------------------------------------------------

static void put_equivalent(const void *self, FILE *f) {
    const bough_lifetime *l = self;
    const bough_study *s = l->set;
    fputs("channel,unit", f);
    for (int k = 0; k < s->n_slope; k++) fprintf(f, ",DEL(m=%g; %g cycles)", s->slope[k], s->cycles);
    fputs(",cycles in the life\n", f);
    for (int i = 0; i < s->n_channel; i++) {
        fprintf(f, "%s,%s", s->channel[i], s->unit[i]);
        for (int k = 0; k < s->n_slope; k++) fprintf(f, ",%.17g", bough_lifetime_equivalent(l, i, k));
        fprintf(f, ",%.17g\n", l->channel[i].cycles);
    }
}

static void put_extreme(const bough_lifetime *l, int i, const char *what, const bough_extreme *e, FILE *f) {
    const bough_study *s = l->set;
    if (!e->found) return;
    const bough_case *c = &s->cases[e->number];
    fprintf(f, "%s,%s,%s,%.17g,%g,%.17g,%d,", s->channel[i], s->unit[i], what, e->value, e->factor,
            e->factor * e->value, e->number + 1);
    bough_csv_text(f, s->group[c->group].name);
    fputc(',', f);
    bough_csv_text(f, c->settings);
    fprintf(f, ",%.9g", e->at);
    for (int k = 0; k < s->n_channel; k++) fprintf(f, ",%.10g", e->row[k]);
    fputc('\n', f);
}

static void put_extremes(const void *self, FILE *f) {
    const bough_lifetime *l = self;
    const bough_study *s = l->set;
    fputs("channel,unit,extreme,characteristic,safety factor,design,case,load case,settings,time [s]", f);
    for (int k = 0; k < s->n_channel; k++) fprintf(f, ",%s [%s]", s->channel[k], s->unit[k]);
    fputc('\n', f);
    for (int i = 0; i < s->n_channel; i++) {
        put_extreme(l, i, "min", &l->channel[i].least, f);
        put_extreme(l, i, "max", &l->channel[i].most, f);
    }
}

static void put_ranges(const void *self, FILE *f) {
    const bough_lifetime *l = self;
    fputs("channel,unit,range from,range to,cycles in the lifetime\n", f);
    for (int i = 0; i < l->set->n_channel; i++) {
        const bough_levels *r = &l->channel[i].ranges;
        double width = bough_levels_width(r);
        for (int64_t k = r->low; r->started && k <= r->high; k++) {
            fprintf(f, "%s,%s,%.10g,%.10g,%.17g\n", l->set->channel[i], l->set->unit[i], width * (double)k,
                    width * (double)(k + 1), bough_levels_inside(r, k));
        }
    }
}

static void put_levels(const void *self, FILE *f) {
    const bough_lifetime *l = self;
    fputs("channel,unit,from,to,hours in the lifetime,upward crossings of from\n", f);
    for (int i = 0; i < l->set->n_channel; i++) {
        const bough_levels *r = &l->channel[i].levels;
        double width = bough_levels_width(r);
        for (int64_t k = r->low; r->started && k <= r->high; k++) {
            fprintf(f, "%s,%s,%.10g,%.10g,%.17g,%.17g\n", l->set->channel[i], l->set->unit[i],
                    width * (double)k, width * (double)(k + 1), bough_levels_inside(r, k),
                    bough_levels_crossed(r, k));
        }
    }
}

bough_status bough_lifetime_write(const bough_lifetime *l, const char *folder) {
    bough_status status = bough_folder_write(folder, "equivalent.csv", put_equivalent, l);
    if (bough_is_ok(&status)) status = bough_folder_write(folder, "extremes.csv", put_extremes, l);
    if (bough_is_ok(&status)) status = bough_folder_write(folder, "ranges.csv", put_ranges, l);
    return bough_is_ok(&status) ? bough_folder_write(folder, "levels.csv", put_levels, l) : status;
}

// -- for people -----------------------------------------------------------------------------------

static void print_extreme(const bough_lifetime *l, const bough_extreme *e, FILE *f) {
    const bough_study *s = l->set;
    if (!e->found) {
        fprintf(f, " %12s %6s %12s %-24s", "-", "", "", "");
        return;
    }
    char where[64];
    snprintf(where, sizeof where, "%.14s #%d %.4g s", s->group[s->cases[e->number].group].name, e->number + 1,
             e->at);
    fprintf(f, " %12.5g %6.3g %12.5g %-24s", e->value, e->factor, e->factor * e->value, where);
}

static void print_extremes(const bough_lifetime *l, FILE *f) {
    const bough_study *s = l->set;
    const char *const title[] = {"smallest", "largest"};
    fprintf(f, "Extremes: characteristic value, partial safety factor of forces and moments, design value\n");
    fprintf(f, "%-12s %-6s", "channel", "unit");
    for (int k = 0; k < 2; k++) {
        fprintf(f, " %12s %6s %12s %-24s", title[k], "factor", "design", "case, time");
    }
    fputc('\n', f);
    for (int i = 0; i < s->n_channel; i++) {
        fprintf(f, "%-12s %-6s", s->channel[i], s->unit[i]);
        print_extreme(l, &l->channel[i].least, f);
        print_extreme(l, &l->channel[i].most, f);
        fputc('\n', f);
    }
}

void bough_lifetime_print(const bough_lifetime *l, FILE *f) {
    const bough_study *s = l->set;
    fprintf(f, "%d cases, %.6g hours of a lifetime of %g years; equivalent loads at %g cycles\n", s->n_case,
            l->hours, s->lifetime, s->cycles);
    if (l->n_failed + l->n_missing > 0) {
        fprintf(f, "INCOMPLETE: %d cases failed, %d are missing, %.3g %% of the weight is missing\n",
                l->n_failed, l->n_missing, 100 * l->lacking);
    }
    fprintf(f, "%-12s %-6s", "channel", "unit");
    for (int k = 0; k < s->n_slope; k++) fprintf(f, "   DEL m=%-4g", s->slope[k]);
    fputc('\n', f);
    for (int i = 0; i < s->n_channel; i++) {
        fprintf(f, "%-12s %-6s", s->channel[i], s->unit[i]);
        for (int k = 0; k < s->n_slope; k++) fprintf(f, " %12.5g", bough_lifetime_equivalent(l, i, k));
        fputc('\n', f);
    }
    print_extremes(l, f);
}
