#include "apps/study/load_set_perform.h"

#include "apps/config/schema.h"
#include "apps/output/folder.h"
#include "apps/output/progress.h"
#include "apps/study/case_claim.h"
#include "apps/study/case_file.h"
#include "apps/study/load_set_plot.h"
#include "apps/study/load_set_tables.h"
#include "core/pool.h"

#include <pthread.h>
#include <stdlib.h>
#include <string.h>

typedef struct work {
    const bough_load_set *set;
    const bough_study_options *options;
    bough_pool *pool;
    int claims;
    int n_to_do;
    int *to_do; // (n_to_do) cases
    int ran, failed; // in this call
    double simulated, cpu; // [s]
    bough_status worst;
    pthread_mutex_t mutex; // of the four above
} work;

// -- a case ---------------------------------------------------------------------------------------

static void tell_failure(const work *w, int number, const bough_status *outcome, FILE *f) {
    const bough_load_case *c = &w->set->cases[number];
    fprintf(f, "case %d failed (%s%s%s): %s\n    %s\n", number + 1, w->set->group[c->group].name,
            c->settings[0] ? ", " : "", c->settings, outcome->message, c->command);
}

static void count(work *w, int number, const bough_case_result *r) {
    pthread_mutex_lock(&w->mutex);
    w->ran++;
    w->simulated += r->time;
    w->cpu += r->cpu;
    if (!bough_is_ok(&r->outcome)) {
        w->failed++;
        tell_failure(w, number, &r->outcome, stderr);
    }
    if (!w->options->quiet) fprintf(stderr, "\r%d of %d cases", w->ran, w->n_to_do);
    pthread_mutex_unlock(&w->mutex);
}

typedef struct one_case {
    work *work;
    int number;
} one_case;

static bough_status run_case(bough_arena *arena, void *self) {
    const one_case *x = self;
    work *w = x->work;
    int number = x->number;
    char name[48], folder[BOUGH_PATH_MAX];
    bough_case_result result = bough_case_take(arena, w->set);
    snprintf(name, sizeof name, "cases/%06d", number + 1);
    bough_status status = bough_folder_path(w->options->folder, name, folder);
    if (bough_is_ok(&status)) {
        status = bough_case_run(w->set, &w->set->cases[number], folder, w->options->stop, &result);
    }
    if (bough_is_ok(&status)) {
        status = bough_case_write(w->options->folder, w->set, number, &result);
    }
    if (bough_is_ok(&status)) count(w, number, &result);
    return status;
}

// Another process may have run it since the list was made.
static void perform_case(void *self, int i) {
    work *w = self;
    int number = w->to_do[i];
    bough_status outcome;
    pthread_mutex_lock(&w->mutex);
    bool go_on = bough_is_ok(&w->worst);
    pthread_mutex_unlock(&w->mutex);
    if (!go_on || !bough_claim(w->claims, number)) return;
    if (!bough_case_exists(w->options->folder, w->set, number, &outcome)) {
        one_case x = {w, number};
        bough_status status = bough_arena_use(run_case, &x);
        pthread_mutex_lock(&w->mutex);
        if (bough_is_ok(&w->worst)) w->worst = status;
        pthread_mutex_unlock(&w->mutex);
    }
    bough_claim_drop(w->claims, number);
}

static void perform_all(void *self) {
    work *w = self;
    bough_pool_run(w->pool, w->n_to_do, perform_case, w);
}

// -- all cases ------------------------------------------------------------------------------------

static bool is_mine(const work *w, int number) {
    const char *name = w->set->group[w->set->cases[number].group].name;
    if (w->options->only && strcmp(w->options->only, name) != 0) return false;
    return w->options->parts == 0 || number % w->options->parts == w->options->part - 1;
}

static bough_status list_cases(bough_arena *arena, work *w) {
    const char *folder = w->options->folder;
    w->to_do = bough_arena_take(arena, (size_t)w->set->n_case * sizeof *w->to_do);
    for (int i = 0; i < w->set->n_case; i++) {
        bough_status outcome;
        if (is_mine(w, i) && !bough_case_exists(folder, w->set, i, &outcome)) {
            w->to_do[w->n_to_do++] = i;
        }
    }
    return bough_ok();
}

// Tables of an earlier state must not stand beside new cases.
static bough_status remove_tables(const char *folder) {
    static const char *const names[] = {"cases.csv",  "costs.csv",  "equivalent.csv",
                                        "ranges.csv", "levels.csv", "extremes.csv",
                                        "table.txt",  "plot.svg"};
    bough_status status = bough_ok();
    for (size_t i = 0; i < sizeof names / sizeof *names && bough_is_ok(&status); i++)
        status = bough_folder_remove(folder, names[i]);
    return status;
}

static bough_status check_name(bough_arena *arena, const work *w) {
    const bough_load_set *s = w->set;
    const char **names = bough_arena_take(arena, (size_t)s->n_group * sizeof *names);
    for (int i = 0; i < s->n_group; i++) {
        names[i] = s->group[i].name;
        if (!w->options->only || strcmp(names[i], w->options->only) == 0) return bough_ok();
    }
    return bough_fail(BOUGH_INVALID, "%s has no load case '%.80s'%s", s->file, w->options->only,
                      bough_suggest(w->options->only, names, s->n_group).text);
}

static bough_status start(bough_arena *arena, work *w) {
    char cases[BOUGH_PATH_MAX];
    bough_status status = check_name(arena, w);
    if (!bough_is_ok(&status)) return status;
    status = bough_folder_path(w->options->folder, "cases", cases);
    if (bough_is_ok(&status)) status = bough_folder_make(cases);
    if (bough_is_ok(&status)) status = bough_claims_open(arena, w->options->folder, &w->claims);
    if (bough_is_ok(&status)) status = list_cases(arena, w);
    if (bough_is_ok(&status) && w->n_to_do > 0) status = remove_tables(w->options->folder);
    return status;
}

static bough_status run_cases(bough_arena *arena, work *w) {
    int threads = w->set->threads > 0 ? w->set->threads : bough_pool_default(0);
    if (threads > w->n_to_do) threads = w->n_to_do > 0 ? w->n_to_do : 1;
    w->pool = bough_pool_create(arena, threads);
    double began = bough_wall_clock();
    w->worst = bough_ok();
    pthread_mutex_init(&w->mutex, NULL);
    bough_pool_region(w->pool, perform_all, w);
    pthread_mutex_destroy(&w->mutex);
    if (!w->options->quiet && w->ran > 0) fputc('\n', stderr);
    if (w->ran > 0) {
        fprintf(w->options->stream,
                "ran %d cases, %.4g simulated hours in %.4g s on %d threads: %.4g simulated hours per "
                "core hour\n", w->ran, w->simulated / 3600, bough_wall_clock() - began, threads,
                w->simulated / w->cpu);
    }
    if (w->worst.code != BOUGH_INTERRUPTED) return w->worst;
    return bough_fail(BOUGH_INTERRUPTED,
                      "interrupted after %d of %d cases, which are kept in %.150s; the same command "
                      "goes on from there", w->ran, w->n_to_do, w->options->folder);
}

// -- conclusion -----------------------------------------------------------------------------------

// Reads the results one after the other: their number costs no memory.
static bough_status read_all(bough_arena *arena, const work *w, bough_case_tables *tables,
                             bough_case_plot *plot, bough_lifetime *lifetime, FILE *failures) {
    bough_case_result result = bough_case_take(arena, w->set);
    for (int i = 0; i < w->set->n_case; i++) {
        bough_status status = bough_case_read(w->options->folder, w->set, i, &result);
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
    const bough_load_set *set;
    const char *folder;
    const bough_lifetime *lifetime;
    const bough_case_plot *plot;
    char *failures; // a text
} conclusion;

static void print_table(const void *self, FILE *f) {
    const conclusion *c = self;
    const bough_load_set *s = c->set;
    fprintf(f, "%s\n", s->title ? s->title : s->file);
    if (s->sweep) {
        fprintf(f, "%d runs, %d failed; statistics of %d channels from %g s on in cases.csv\n",
                s->n_case, c->lifetime->n_failed, s->n_channel, s->from);
    } else {
        bough_lifetime_print(c->lifetime, f);
    }
    fputs(c->failures, f);
}

static bough_status write_all(const conclusion *c) {
    bool sweep = c->set->sweep;
    bough_status status = sweep ? bough_ok() : bough_lifetime_write(c->lifetime, c->folder);
    if (bough_is_ok(&status)) status = bough_folder_write(c->folder, "table.txt", print_table, c);
    if (!bough_is_ok(&status)) return status;
    return sweep ? bough_case_plot_write(c->plot, c->folder) : bough_lifetime_plot(c->lifetime, c->folder);
}

static bough_status judge(const work *w, const bough_lifetime *l) {
    if (l->n_failed == 0) return bough_ok();
    if (w->set->sweep) {
        return bough_fail(BOUGH_FAILED, "%d of %d runs failed: see table.txt", l->n_failed,
                          w->set->n_case);
    }
    return bough_fail(BOUGH_FAILED,
                      "%d of %d cases failed: the lifetime result is incomplete, %.3g %% of its "
                      "weight is missing", l->n_failed, w->set->n_case, 100 * l->lacking);
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
    for (int i = 0; i < w->set->n_case; i++) {
        bough_status outcome;
        n += !bough_case_exists(w->options->folder, w->set, i, &outcome);
    }
    return n;
}

// A part, and a call that leaves cases to others, has no tables.
static bough_status conclude(bough_arena *arena, const work *w) {
    int missing = count_missing(w), n = w->set->n_case;
    FILE *f = w->options->stream;
    if (w->options->parts > 0) {
        fprintf(f, "part %d of %d: %d cases run, %d of %d cases still missing\n", w->options->part,
                w->options->parts, w->ran, missing, n);
    } else if (missing > 0 && w->options->only) {
        fprintf(f, "%d of %d cases still missing\n", missing, n);
    } else if (missing > 0) {
        fprintf(f, "%d of %d cases are run by other processes; the same command makes the tables when "
                   "they are done\n", missing, n);
    } else {
        return conclude_in(arena, w);
    }
    if (w->failed == 0) return bough_ok();
    return bough_fail(BOUGH_FAILED, "%d of the %d cases run here failed", w->failed, w->ran);
}

bough_status bough_load_set_perform(bough_arena *arena, const bough_study *study,
                                    const bough_study_options *options) {
    work w = {.set = study->load_set, .options = options};
    bough_status status = start(arena, &w);
    if (bough_is_ok(&status)) status = run_cases(arena, &w);
    return bough_is_ok(&status) ? conclude(arena, &w) : status;
}
