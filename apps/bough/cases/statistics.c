#include "apps/bough/cases/perform.h"

#include "apps/bough/results/folder.h"
#include "apps/bough/results/picture.h"

enum { PANELS = 6, VALUES = 3 }; // channels in plot.svg; minimum, maximum and mean of each

// Data of a case for costs.csv and plot.svg; its mean is NaN if it failed.
typedef struct note {
    double simulated, cpu, wall; // [s]
    double shown[PANELS][VALUES];
    const char *failure;  // the message; NULL: none
    const char *warnings; // likewise
} note;

// The tables and their data.
typedef struct conclusion {
    const bough_study *study;
    const char *folder;
    bough_lifetime lifetime;
    bough_chart chart;
    note *note; // (n_case)
} conclusion;

// -- cases ----------------------------------------------------------------------------------------

static void head_cases(const bough_study *s, FILE *f) {
    fputs("case", f);
    for (int i = 0; i < s->grid.n; i++) bough_csv_next(f, s->grid.axis[i].key);
    if (s->is.weighted) fputs(",load case,settings,occurrences [1]", f);
    fputs(",outcome", f);
    for (int i = 0; i < s->n_channel; i++) {
        static const char *const names[] = {"min", "max", "mean", "std"};
        for (int k = 0; k < 4; k++) fprintf(f, ",%s %s [%s]", s->channel[i], names[k], s->unit[i]);
        for (int k = 0; k < s->n_slope; k++)
            fprintf(f, ",%s DEL(m=%g; 1 Hz) [%s]", s->channel[i], s->slope[k], s->unit[i]);
    }
    fputs(",warnings", f);
    fputc('\n', f);
}

static void put_channel(const bough_study *s, const bough_case_result *r, int i, FILE *f) {
    const bough_channel_counts *c = &r->counts.channel[i];
    const bough_sample_statistics *x = &c->statistics;
    fprintf(f, ",%.10g,%.10g,%.10g,%.10g", x->least, x->most, x->mean, bough_sample_statistics_deviation(x));
    for (int k = 0; k < s->n_slope; k++) {
        fprintf(f, ",%.10g", bough_equivalent_load(c->rainflow.damage[k], s->slope[k], r->counted));
    }
}

static void put_case(const bough_study *s, int number, const bough_case_result *r, FILE *f) {
    const bough_case *c = &s->cases[number];
    bool good = bough_held(r);
    fprintf(f, "%d", number + 1);
    for (int i = 0; i < s->grid.n; i++) bough_csv_next(f, bough_study_value(s, c, i));
    if (s->is.weighted) {
        bough_csv_next(f, s->group[c->group].name);
        bough_csv_next(f, c->settings);
        fprintf(f, ",%.10g", good ? bough_case_weight(s, c, r->counted) : 0);
    }
    fprintf(f, ",%s", good ? "ok" : r->done ? "failed" : "missing");
    for (int i = 0; i < s->n_channel; i++) {
        if (good)
            put_channel(s, r, i, f);
        else
            for (int k = 0; k < 4 + s->n_slope; k++) fputs(",nan", f);
    }
    bough_csv_next(f, r->done ? r->warnings : "");
    fputc('\n', f);
}

// -- lifetime -------------------------------------------------------------------------------------

static void put_equivalent(const void *self, FILE *f) {
    const bough_lifetime *l = self;
    const bough_study *s = l->study;
    fputs("channel,unit", f);
    for (int k = 0; k < s->n_slope; k++) fprintf(f, ",DEL(m=%g; %g cycles)", s->slope[k], s->cycles);
    for (int k = 0; k < s->n_slope; k++) fprintf(f, ",error of DEL(m=%g)", s->slope[k]);
    fputs(",cycles in the life\n", f);
    for (int i = 0; i < s->n_channel; i++) {
        fprintf(f, "%s,%s", s->channel[i], s->unit[i]);
        for (int k = 0; k < s->n_slope; k++) fprintf(f, ",%.17g", bough_lifetime_equivalent(l, i, k));
        for (int k = 0; k < s->n_slope; k++) fprintf(f, ",%.6g", bough_lifetime_equivalent_error(l, i, k));
        fprintf(f, ",%.17g\n", l->channel[i].cycles);
    }
}

static void put_extreme(const bough_lifetime *l, int i, const char *what, const bough_extreme *e, FILE *f) {
    const bough_study *s = l->study;
    if (!e->found) return;
    const bough_case *c = &s->cases[e->number];
    fprintf(f, "%s,%s,%s,%.17g,%g,%.17g,%d", s->channel[i], s->unit[i], what, e->value, e->factor,
            e->factor * e->value, e->number + 1);
    bough_csv_next(f, s->group[c->group].name);
    bough_csv_next(f, c->settings);
    fprintf(f, ",%.9g,%.6g,%d", e->at, bough_lifetime_extreme_error(l, i, e), l->n_compared[c->group]);
    for (int k = 0; k < s->n_channel; k++) fprintf(f, ",%.10g", e->row[k]);
    fputc('\n', f);
}

static void put_extremes(const void *self, FILE *f) {
    const bough_lifetime *l = self;
    const bough_study *s = l->study;
    fputs("channel,unit,extreme,characteristic,safety factor,design,case,load case,settings,time [s],"
          "error,companions of the load case",
          f);
    for (int k = 0; k < s->n_channel; k++) fprintf(f, ",%s [%s]", s->channel[k], s->unit[k]);
    fputc('\n', f);
    for (int i = 0; i < s->n_channel; i++) {
        put_extreme(l, i, "min", &l->channel[i].least, f);
        put_extreme(l, i, "max", &l->channel[i].most, f);
    }
}

// A row for each bin: cycles by range, or hours and crossings by level.
static void put_bins(const bough_lifetime *l, bool by_level, FILE *f) {
    fprintf(f, "channel,unit,%s\n",
            by_level ? "from,to,hours in the lifetime,upward crossings of from"
                     : "range from,range to,cycles in the lifetime");
    for (int i = 0; i < l->study->n_channel; i++) {
        const bough_levels *r = by_level ? &l->channel[i].levels : &l->channel[i].ranges;
        double width = bough_levels_width(r);
        for (int64_t k = r->low; r->started && k <= r->high; k++) {
            fprintf(f, "%s,%s,%.10g,%.10g,%.17g", l->study->channel[i], l->study->unit[i], width * (double)k,
                    width * (double)(k + 1), bough_levels_inside(r, k));
            if (by_level) fprintf(f, ",%.17g", bough_levels_crossed(r, k));
            fputc('\n', f);
        }
    }
}

static void put_ranges(const void *self, FILE *f) { put_bins(self, false, f); }

static void put_levels(const void *self, FILE *f) { put_bins(self, true, f); }

static bough_status write_lifetime(const bough_lifetime *l, const char *folder) {
    BOUGH_TRY(bough_folder_write(folder, "equivalent.csv", put_equivalent, l));
    BOUGH_TRY(bough_folder_write(folder, "extremes.csv", put_extremes, l));
    BOUGH_TRY(bough_folder_write(folder, "ranges.csv", put_ranges, l));
    return bough_folder_write(folder, "levels.csv", put_levels, l);
}

// -- table.txt -----------------------------------------------------------------------------------

// An unknown error is printed as a dash.
static void print_error(FILE *f, double error) {
    if (isfinite(error))
        fprintf(f, " %9.2g", error);
    else
        fprintf(f, " %9s", "-");
}

static void print_extreme(const bough_lifetime *l, int i, const bough_extreme *e, FILE *f) {
    const bough_study *s = l->study;
    if (!e->found) {
        fprintf(f, " %12s %9s %6s %12s %-24s", "-", "", "", "", "");
        return;
    }
    char where[64];
    snprintf(where, sizeof where, "%.14s #%d %.4g s", s->group[s->cases[e->number].group].name, e->number + 1,
             e->at);
    fprintf(f, " %12.5g", e->value);
    print_error(f, bough_lifetime_extreme_error(l, i, e));
    fprintf(f, " %6.3g %12.5g %-24s", e->factor, e->factor * e->value, where);
}

static void print_extremes(const bough_lifetime *l, FILE *f) {
    const bough_study *s = l->study;
    const char *const title[] = {"smallest", "largest"};
    fprintf(
        f,
        "Extremes: characteristic value, its error, partial safety factor of forces and moments, design value\n");
    fprintf(f, "%-12s %-6s", "channel", "unit");
    for (int k = 0; k < 2; k++) {
        fprintf(f, " %12s %9s %6s %12s %-24s", title[k], "error", "factor", "design", "case, time");
    }
    fputc('\n', f);
    for (int i = 0; i < s->n_channel; i++) {
        fprintf(f, "%-12s %-6s", s->channel[i], s->unit[i]);
        print_extreme(l, i, &l->channel[i].least, f);
        print_extreme(l, i, &l->channel[i].most, f);
        fputc('\n', f);
    }
}

static void print_lifetime(const bough_lifetime *l, FILE *f) {
    const bough_study *s = l->study;
    fprintf(f, "%d cases, %.6g hours of a lifetime of %g years; equivalent loads at %g cycles\n", s->n_case,
            l->hours, s->lifetime, s->cycles);
    if (l->n_failed + l->n_missing > 0) {
        fprintf(f, "INCOMPLETE: %d case%s failed, %d missing, %.3g %% of the weight is missing\n",
                l->n_failed, l->n_failed == 1 ? "" : "s", l->n_missing, 100 * l->missing);
    }
    int compared = l->n_compared[s->n_group];
    if (compared > 0)
        fprintf(f, "errors estimated from the companions of %d case%s\n", compared, compared == 1 ? "" : "s");
    else
        fprintf(f, "errors not estimated: %s\n",
                s->companions > 0 ? "the companions broke down" : "companions: none");
    fprintf(f, "%-12s %-6s", "channel", "unit");
    for (int k = 0; k < s->n_slope; k++) fprintf(f, "   DEL m=%-4g %9s", s->slope[k], "error");
    fputc('\n', f);
    for (int i = 0; i < s->n_channel; i++) {
        fprintf(f, "%-12s %-6s", s->channel[i], s->unit[i]);
        for (int k = 0; k < s->n_slope; k++) {
            fprintf(f, " %12.5g", bough_lifetime_equivalent(l, i, k));
            print_error(f, bough_lifetime_equivalent_error(l, i, k));
        }
        fputc('\n', f);
    }
    print_extremes(l, f);
}

// -- plot.svg -------------------------------------------------------------------------------------

// The value of the grid's first key as a number; its index if it is no number.
static double across_of(const bough_study *s, int number) {
    const bough_study_axis *axis = &s->grid.axis[0];
    int i = s->cases[number].index[0];
    char *end;
    double x = strtod(axis->value.item[i].value, &end);
    return end == axis->value.item[i].value ? i : x;
}

static void add_panel(bough_chart *chart, const bough_study *s, int i, const char *across, bool logarithmic) {
    const char *heading = bough_arena_print(chart->arena, "%s [%s]", s->channel[i], s->unit[i]);
    bough_chart_add_panel(chart, heading, across, logarithmic, false);
}

// Sweeps: mean, minimum and maximum of channels over the first key of the grid.
static void plot_sweep(bough_chart *chart, const bough_study *s, const note *notes) {
    for (int k = 0; k < s->n_channel && k < PANELS; k++) {
        add_panel(chart, s, k, s->grid.axis[0].label, false);
        bough_chart_add_line(chart, (bough_chart_line){.marked = true});
        for (int i = 0; i < s->n_case; i++) {
            const double *v = notes[i].shown[k];
            if (!isfinite(v[2])) continue;
            const char *hint = bough_arena_print(chart->arena, "%s: %.5g (%.5g to %.5g)",
                                                 s->cases[i].settings, v[2], v[0], v[1]);
            bough_chart_add(chart, (bough_chart_point){
                                       .x = across_of(s, i), .y = v[2], .bar = {v[0], v[1]}, .hint = hint});
        }
    }
}

// Load sets: ranges of channels over the number of cycles in the lifetime that reach them.
static void plot_ranges(bough_chart *chart, const bough_lifetime *l) {
    for (int i = 0; i < l->study->n_channel && i < PANELS; i++) {
        const bough_levels *r = &l->channel[i].ranges;
        add_panel(chart, l->study, i, "cycles in the lifetime with at least this range", true);
        bough_chart_add_line(chart, (bough_chart_line){.joined = true});
        double exceeded = 0;
        for (int64_t k = r->high; r->started && k >= r->low; k--) {
            exceeded += bough_levels_inside(r, k);
            bough_chart_add(chart,
                            (bough_chart_point){.x = exceeded, .y = bough_levels_width(r) * (double)k});
        }
    }
}

// -- failures ---------------------------------------------------------------------------------------

// A word of a command line, quoted for the shell if necessary.
static void quote(FILE *f, const char *text) {
    if (!strpbrk(text, " \t\"'\\$`&|;<>()[]{}*?#~!")) {
        fputs(text, f);
        return;
    }
    fputc('\'', f);
    for (const char *c = text; *c; c++) {
        if (*c == '\'')
            fputs("'\\''", f);
        else
            fputc(*c, f);
    }
    fputc('\'', f);
}

void bough_case_failed(const bough_study *s, int number, const char *message, FILE *f) {
    const bough_case *c = &s->cases[number];
    fprintf(f, "case %d failed (%s%s%s): %s\n    bough run ", number + 1, s->group[c->group].name,
            c->settings[0] ? ", " : "", c->settings, message);
    quote(f, c->scene);
    for (int i = 0; i < c->n_set; i++) {
        fputs(" --set ", f);
        quote(f, c->set[i]);
    }
    fputc('\n', f);
}

// -- conclusion -----------------------------------------------------------------------------------

static void keep(bough_arena *arena, const bough_study *s, const bough_case_result *r, note *to) {
    bool failed = r->done && !bough_is_ok(&r->outcome);
    if (failed) to->failure = bough_arena_string(arena, r->outcome.message);
    if (r->done && r->warnings[0]) to->warnings = bough_arena_string(arena, r->warnings);
    to->simulated = r->done ? r->time : 0;
    to->cpu = r->cpu;
    to->wall = r->wall;
    for (int k = 0; k < s->n_channel && k < PANELS; k++) {
        const bough_sample_statistics *x = &r->counts.channel[k].statistics;
        const double values[VALUES] = {x->least, x->most, bough_held(r) ? x->mean : (double)NAN};
        memcpy(to->shown[k], values, sizeof values);
    }
}

// Reads one result after the other into cases.csv and the conclusion, so that many results take little
// memory.
static bough_status read_all(bough_arena *arena, conclusion *c) {
    const bough_study *s = c->study;
    bough_case_result result = bough_case_take(arena, s);
    char path[BOUGH_PATH_MAX];
    FILE *file;
    BOUGH_TRY(bough_folder_open(c->folder, "cases.csv", path, &file));
    head_cases(s, file);
    bough_status status = bough_ok();
    for (int i = 0; i < s->n_case; i++) {
        status = bough_store_read(c->folder, s, &s->cases[i], &result);
        if (!bough_is_ok(&status)) break;
        put_case(s, i, &result, file);
        keep(arena, s, &result, &c->note[i]);
        bough_lifetime_add(&c->lifetime, i, &result);
    }
    return bough_folder_close(path, file, status);
}

static void put_costs(const void *self, FILE *f) {
    const conclusion *c = self;
    fputs("case,simulated [s],cpu [s],wall [s]\n", f);
    for (int i = 0; i < c->study->n_case; i++)
        fprintf(f, "%d,%.9g,%.6g,%.6g\n", i + 1, c->note[i].simulated, c->note[i].cpu, c->note[i].wall);
}

enum { WARNED = 10 }; // cases whose warnings are printed

static void print_warnings(const conclusion *c, FILE *f) {
    const bough_study *s = c->study;
    int n = 0;
    for (int i = 0; i < s->n_case; i++) {
        const bough_case *one = &s->cases[i];
        if (!c->note[i].warnings || n++ >= WARNED) continue;
        fprintf(f, "case %d (%s%s%s): warning: %s\n", i + 1, s->group[one->group].name,
                one->settings[0] ? ", " : "", one->settings, c->note[i].warnings);
    }
    if (n > WARNED) fprintf(f, "%d more cases have warnings: see cases.csv\n", n - WARNED);
}

static void print_table(const void *self, FILE *f) {
    const conclusion *c = self;
    const bough_study *s = c->study;
    fprintf(f, "%s\n", s->title ? s->title : s->file);
    if (!s->is.weighted) {
        fprintf(f, "%d runs, %d failed; statistics of %d channels from %g s on in cases.csv\n", s->n_case,
                c->lifetime.n_failed, s->n_channel, s->from);
    } else {
        print_lifetime(&c->lifetime, f);
    }
    for (int i = 0; i < s->n_case; i++)
        if (c->note[i].failure) bough_case_failed(s, i, c->note[i].failure, f);
    print_warnings(c, f);
}

static bough_status write_all(conclusion *c) {
    bool weighted = c->study->is.weighted;
    if (weighted)
        plot_ranges(&c->chart, &c->lifetime);
    else
        plot_sweep(&c->chart, c->study, c->note);
    BOUGH_TRY(bough_folder_write(c->folder, "costs.csv", put_costs, c));
    if (weighted) BOUGH_TRY(write_lifetime(&c->lifetime, c->folder));
    BOUGH_TRY(bough_folder_write(c->folder, "table.txt", print_table, c));
    return bough_folder_write(c->folder, "plot.svg", bough_chart_write, &c->chart);
}

static bough_status judge(const bough_study_results *x, const bough_lifetime *l) {
    if (l->n_failed == 0) return bough_ok();
    if (!x->study->is.weighted) {
        return bough_fail(BOUGH_FAILED, "%d of %d runs failed: see table.txt", l->n_failed, x->study->n_case);
    }
    return bough_fail(BOUGH_FAILED,
                      "%d of %d cases failed: the lifetime result is incomplete, %.3g %% of its "
                      "weight is missing",
                      l->n_failed, x->study->n_case, 100 * l->missing);
}

static bough_status conclude_in(bough_arena *arena, const bough_study_results *x) {
    const bough_study *study = x->study;
    conclusion c = {.study = study,
                    .folder = x->options->folder,
                    .lifetime = bough_lifetime_take(arena, study),
                    .chart = bough_chart_start(arena, NULL, 2),
                    .note = bough_arena_take(arena, (size_t)study->n_case * sizeof *c.note)};
    BOUGH_TRY(read_all(arena, &c));
    BOUGH_TRY(write_all(&c));
    print_table(&c, x->options->stream);
    return judge(x, &c.lifetime);
}

// There are no tables as long as cases are missing, nor after a part.
bough_status bough_statistics_conclude(bough_arena *arena, const bough_study_results *x) {
    int missing = bough_study_missing(x, -1), n = x->study->n_case;
    FILE *f = x->options->stream;
    if (x->options->parts > 0) {
        fprintf(f, "part %d of %d: %d cases run, %d of %d cases still missing\n", x->options->part,
                x->options->parts, x->ran, missing, n);
    } else if (missing > 0 && x->options->only) {
        fprintf(f, "%d of %d cases still missing\n", missing, n);
    } else if (missing > 0) {
        fprintf(f,
                "%d of %d cases are run by other processes; the same command makes the tables when "
                "they are done\n",
                missing, n);
    } else {
        return conclude_in(arena, x);
    }
    if (x->failed == 0) return bough_ok();
    return bough_fail(BOUGH_FAILED, "%d of the %d cases run here failed", x->failed, x->ran);
}
