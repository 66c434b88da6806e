#include "apps/bough/cases/load_set_perform.h"

#include "apps/bough/cases/load_set_plot.h"
#include "apps/bough/cases/load_set_tables.h"
#include "apps/bough/cases/store.h"
#include "apps/bough/cases/study_batch.h"
#include "apps/bough/config/schema.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/results/progress.h"

#include <stdlib.h>
#include <string.h>

typedef struct work {
    const bough_study *set;
    const bough_study_options *options;
    bough_batch batch; // a piece is a case of the list
    int claims;
    int *to_do;            // (batch.n) cases
    int failed;            // in this call
    double simulated, cpu; // [s]
} work;

// -- a case ---------------------------------------------------------------------------------------

// A piece of text, quoted for a shell where it must be.
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

// That runs the case alone.
static void put_command(FILE *f, const bough_case *c) {
    fputs("bough run ", f);
    quote(f, c->scene);
    for (int i = 0; i < c->n_set; i++) {
        fputs(" --set ", f);
        quote(f, c->set[i]);
    }
}

static void tell_failure(const work *w, int number, const bough_status *outcome, FILE *f) {
    const bough_case *c = &w->set->cases[number];
    fprintf(f, "case %d failed (%s%s%s): %s\n    ", number + 1, w->set->group[c->group].name,
            c->settings[0] ? ", " : "", c->settings, outcome->message);
    put_command(f, c);
    fputc('\n', f);
}

static void count(work *w, int number, const bough_case_result *r) {
    bough_batch_enter(&w->batch);
    w->simulated += r->time;
    w->cpu += r->cpu;
    if (!bough_is_ok(&r->outcome)) {
        w->failed++;
        tell_failure(w, number, &r->outcome, stderr);
    }
    bough_batch_leave(&w->batch);
}

static bough_status run_case(bough_arena *arena, work *w, int number) {
    char name[48], folder[BOUGH_PATH_MAX];
    bough_case_result result = bough_case_take(arena, w->set);
    snprintf(name, sizeof name, "cases/%06d", number + 1);
    bough_status status = bough_folder_path(w->options->folder, name, folder);
    if (bough_is_ok(&status)) {
        bough_study_drive drive = {.stop = w->options->stop, .folder = w->set->series ? folder : NULL};
        status = bough_case_run(w->set, &w->set->cases[number], 1, &drive, NULL, &result);
    }
    if (bough_is_ok(&status)) {
        status = bough_store_write(w->options->folder, w->set, &w->set->cases[number], &result);
    }
    if (bough_is_ok(&status)) count(w, number, &result);
    return status;
}

// Another process may have run it since the list was made.
static bough_status perform_case(bough_arena *arena, void *self, int i) {
    work *w = self;
    int number = w->to_do[i];
    bough_status status = bough_ok();
    if (!bough_claim(w->claims, number)) return status;
    if (!bough_store_has(w->options->folder, w->set, &w->set->cases[number]))
        status = run_case(arena, w, number);
    bough_claim_drop(w->claims, number);
    return status;
}

// -- all cases ------------------------------------------------------------------------------------

static bool is_mine(const work *w, int number) {
    const char *name = w->set->group[w->set->cases[number].group].name;
    if (w->options->only && strcmp(w->options->only, name) != 0) return false;
    return w->options->parts == 0 || number % w->options->parts == w->options->part - 1;
}

static void list_cases(bough_arena *arena, work *w) {
    w->to_do = bough_arena_take(arena, (size_t)w->set->n_case * sizeof *w->to_do);
    for (int i = 0; i < w->set->n_case; i++) {
        bool wanted = is_mine(w, i) && !bough_store_has(w->options->folder, w->set, &w->set->cases[i]);
        if (wanted) w->to_do[w->batch.n++] = i;
    }
}

// Tables of an earlier state must not stand beside new cases.
static bough_status remove_tables(const char *folder) {
    static const char *const names[] = {"cases.csv",  "costs.csv",    "equivalent.csv", "ranges.csv",
                                        "levels.csv", "extremes.csv", "table.txt",      "plot.svg"};
    bough_status status = bough_ok();
    for (size_t i = 0; i < sizeof names / sizeof *names && bough_is_ok(&status); i++)
        status = bough_folder_remove(folder, names[i]);
    return status;
}

static bough_status check_name(bough_arena *arena, const work *w) {
    const bough_study *s = w->set;
    const char **names = bough_arena_take(arena, (size_t)s->n_group * sizeof *names);
    for (int i = 0; i < s->n_group; i++) {
        names[i] = s->group[i].name;
        if (!w->options->only || strcmp(names[i], w->options->only) == 0) return bough_ok();
    }
    return bough_fail(BOUGH_INVALID, "%s has no load case '%.80s'%s", s->file, w->options->only,
                      bough_suggest(w->options->only, names, s->n_group).text);
}

static bough_status start(bough_arena *arena, work *w) {
    bough_status status = check_name(arena, w);
    if (bough_is_ok(&status)) status = bough_store_open(w->options->folder);
    if (bough_is_ok(&status)) status = bough_claims_open(arena, w->options->folder, &w->claims);
    if (!bough_is_ok(&status)) return status;
    list_cases(arena, w);
    return w->batch.n > 0 ? remove_tables(w->options->folder) : status;
}

static bough_status run_cases(bough_arena *arena, work *w) {
    bough_batch *b = &w->batch;
    int threads = w->set->threads > 0 ? w->set->threads : bough_pool_default(0);
    if (threads > b->n) threads = b->n > 0 ? b->n : 1;
    double began = bough_wall_clock();
    b->to_do = b->n;
    bough_status status = bough_batch_run(arena, b, threads);
    if (b->done > 0) {
        fprintf(w->options->stream,
                "ran %d cases, %.4g simulated hours in %.4g s on %d threads: %.4g simulated hours per "
                "core hour\n",
                b->done, w->simulated / 3600, bough_wall_clock() - began, threads, w->simulated / w->cpu);
    }
    return status;
}

// -- conclusion -----------------------------------------------------------------------------------

// Reads the results one after the other: their number costs no memory.
static bough_status read_all(bough_arena *arena, const work *w, bough_case_tables *tables,
                             bough_case_plot *plot, bough_lifetime *lifetime, FILE *failures) {
    bough_case_result result = bough_case_take(arena, w->set);
    for (int i = 0; i < w->set->n_case; i++) {
        bough_status status = bough_store_read(w->options->folder, w->set, &w->set->cases[i], &result);
        if (!bough_is_ok(&status)) return status;
        bough_case_tables_add(tables, i, &result);
        bough_case_plot_add(plot, i, &result);
        bough_lifetime_add(lifetime, i, &result);
        if (result.done && !bough_is_ok(&result.outcome)) {
            tell_failure(w, i, &result.outcome, failures);
        }
    }
    return bough_ok();
}

// What the tables are made of.
typedef struct conclusion {
    const bough_study *set;
    const char *folder;
    const bough_lifetime *lifetime;
    const bough_case_plot *plot;
    char *failures; // a text
} conclusion;

static void print_table(const void *self, FILE *f) {
    const conclusion *c = self;
    const bough_study *s = c->set;
    fprintf(f, "%s\n", s->title ? s->title : s->file);
    if (!s->is.weighted) {
        fprintf(f, "%d runs, %d failed; statistics of %d channels from %g s on in cases.csv\n", s->n_case,
                c->lifetime->n_failed, s->n_channel, s->from);
    } else {
        bough_lifetime_print(c->lifetime, f);
    }
    fputs(c->failures, f);
}

static bough_status write_all(const conclusion *c) {
    bool sweep = !c->set->is.weighted;
    bough_status status = sweep ? bough_ok() : bough_lifetime_write(c->lifetime, c->folder);
    if (bough_is_ok(&status)) status = bough_folder_write(c->folder, "table.txt", print_table, c);
    if (!bough_is_ok(&status)) return status;
    return sweep ? bough_case_plot_write(c->plot, c->folder) : bough_lifetime_plot(c->lifetime, c->folder);
}

static bough_status judge(const work *w, const bough_lifetime *l) {
    if (l->n_failed == 0) return bough_ok();
    if (!w->set->is.weighted) {
        return bough_fail(BOUGH_FAILED, "%d of %d runs failed: see table.txt", l->n_failed, w->set->n_case);
    }
    return bough_fail(BOUGH_FAILED,
                      "%d of %d cases failed: the lifetime result is incomplete, %.3g %% of its "
                      "weight is missing",
                      l->n_failed, w->set->n_case, 100 * l->lacking);
}

static bough_status conclude_in(bough_arena *arena, const work *w) {
    bough_lifetime lifetime = bough_lifetime_take(arena, w->set);
    bough_case_plot plot = bough_case_plot_take(arena, w->set);
    bough_case_tables tables;
    conclusion all = {w->set, w->options->folder, &lifetime, &plot, NULL};
    size_t size = 0;
    FILE *stream = open_memstream(&all.failures, &size);
    if (!stream) bough_arena_leave(arena);
    bough_status status = bough_case_tables_open(w->options->folder, w->set, &tables);
    if (bough_is_ok(&status)) status = read_all(arena, w, &tables, &plot, &lifetime, stream);
    bough_status end = bough_case_tables_close(&tables, bough_is_ok(&status));
    if (bough_is_ok(&status)) status = end;
    fclose(stream);
    if (bough_is_ok(&status)) status = write_all(&all);
    if (bough_is_ok(&status)) print_table(&all, w->options->stream);
    if (bough_is_ok(&status)) status = judge(w, &lifetime);
    free(all.failures);
    return status;
}

static int count_missing(const work *w) {
    int n = 0;
    for (int i = 0; i < w->set->n_case; i++)
        n += !bough_store_has(w->options->folder, w->set, &w->set->cases[i]);
    return n;
}

// A part, and a call that leaves cases to others, has no tables.
static bough_status conclude(bough_arena *arena, const work *w) {
    int missing = count_missing(w), n = w->set->n_case;
    FILE *f = w->options->stream;
    if (w->options->parts > 0) {
        fprintf(f, "part %d of %d: %d cases run, %d of %d cases still missing\n", w->options->part,
                w->options->parts, w->batch.done, missing, n);
    } else if (missing > 0 && w->options->only) {
        fprintf(f, "%d of %d cases still missing\n", missing, n);
    } else if (missing > 0) {
        fprintf(f,
                "%d of %d cases are run by other processes; the same command makes the tables when "
                "they are done\n",
                missing, n);
    } else {
        return conclude_in(arena, w);
    }
    if (w->failed == 0) return bough_ok();
    return bough_fail(BOUGH_FAILED, "%d of the %d cases run here failed", w->failed, w->batch.done);
}

bough_status bough_load_set_perform(bough_arena *arena, const bough_study *study,
                                    const bough_study_options *options) {
    work w = {.set = study, .options = options};
    w.batch = (bough_batch){options, "cases", .counts = !options->quiet, .perform = perform_case, .self = &w};
    bough_status status = start(arena, &w);
    if (bough_is_ok(&status)) status = run_cases(arena, &w);
    return bough_is_ok(&status) ? conclude(arena, &w) : status;
}
