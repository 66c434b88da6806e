#include "apps/study/study_stability.h"

#include "apps/output/folder.h"
#include "apps/study/study_map.h"
#include "apps/study/study_store.h"
#include "apps/study/study_table.h"
#include "core/pool.h"

#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

typedef struct stability {
    const bough_study *study;
    const bough_study_options *options;
    bough_study_result *reference; // (n_reference)
    bough_study_result *result;    // (n_cell)
    bough_study_store store;
    bough_pool *pool; // a group of runs each
    int done, to_do; // cells, in this call
    bough_status worst; // of the groups
    pthread_mutex_t mutex; // of store, done and worst
} stability;

// -- running --------------------------------------------------------------------------------------

static bool is_mine(const stability *x, int group) {
    return x->options->parts == 0 || group % x->options->parts == x->options->part - 1;
}

static int count_missing(const stability *x, int group) {
    int n = 0;
    for (int i = 0; i < x->study->n_cell; i++)
        n += x->study->cell[i].reference == group && !x->result[i].done;
    return n;
}

static bough_status keep(stability *x, const bough_study_cell *cell,
                         const bough_study_result *result) {
    pthread_mutex_lock(&x->mutex);
    bough_status status = bough_study_store_add(&x->store, cell, result);
    x->done++;
    if (!x->options->quiet) fprintf(stderr, "\r%d of %d runs", x->done, x->to_do);
    pthread_mutex_unlock(&x->mutex);
    return status;
}

// A reference that fails leaves its cells without errors.
static bough_status run_reference(stability *x, int group, bough_study_series *series,
                                  bough_study_drive *drive) {
    const bough_study_cell *cell = &x->study->reference_cell[group];
    bough_study_result *r = &x->reference[group];
    bool known = r->done;
    bough_status status = bough_study_run(x->study, cell, 1, drive, series, r);
    if (!bough_is_ok(&status) || known) return status;
    if (bough_is_ok(&r->outcome)) bough_study_compare(x->study, series, series, r->error);
    return keep(x, cell, r);
}

typedef struct one_group {
    stability *study;
    int group;
} one_group;

static bough_status run_group(bough_arena *arena, void *self) {
    const one_group *one = self;
    stability *x = one->study;
    int group = one->group;
    const bough_study *s = x->study;
    bough_study_drive drive = {.stop = x->options->stop,
                               .progress = bough_progress_start(0, s->duration, true)};
    bough_study_series reference = bough_study_series_take(arena, s);
    bough_study_series series = bough_study_series_take(arena, s);
    bough_status status = run_reference(x, group, &reference, &drive);
    for (int i = 0; i < s->n_cell && bough_is_ok(&status); i++) {
        bough_study_result *r = &x->result[i];
        if (s->cell[i].reference != group || r->done) continue;
        status = bough_study_run(s, &s->cell[i], s->repeat, &drive, &series, r);
        if (!bough_is_ok(&status)) break;
        bool both = bough_is_ok(&r->outcome) && bough_is_ok(&x->reference[group].outcome);
        if (both) bough_study_compare(s, &series, &reference, r->error);
        status = keep(x, &s->cell[i], r);
    }
    return status;
}

static void perform_group(void *self, int group) {
    stability *x = self;
    if (!is_mine(x, group) || count_missing(x, group) == 0) return;
    one_group one = {x, group};
    bough_status status = bough_arena_use(run_group, &one);
    if (bough_is_ok(&status)) return;
    pthread_mutex_lock(&x->mutex);
    x->worst = status;
    pthread_mutex_unlock(&x->mutex);
}

static void perform_groups(void *self) {
    stability *x = self;
    bough_pool_run(x->pool, x->study->n_reference, perform_group, x);
}

static bough_status run_groups(bough_arena *arena, stability *x) {
    int threads = x->study->threads > 0 ? x->study->threads : bough_pool_default(0);
    x->pool = bough_pool_create(arena, threads);
    x->worst.code = BOUGH_OK;
    pthread_mutex_init(&x->mutex, NULL);
    bough_pool_region(x->pool, perform_groups, x);
    pthread_mutex_destroy(&x->mutex);
    if (!x->options->quiet && x->done > 0) fputc('\n', stderr);
    if (x->worst.code != BOUGH_INTERRUPTED) return x->worst;
    return bough_fail(BOUGH_INTERRUPTED,
                      "interrupted after %d of %d runs, which are kept in %.150s; the same command "
                      "goes on from there",
                      x->done, x->to_do, x->options->folder);
}

static bough_status start(bough_arena *arena, stability *x) {
    const bough_study *s = x->study;
    char name[48] = "cells.csv";
    x->reference = bough_arena_take(arena, (size_t)s->n_reference * sizeof *x->reference);
    x->result = bough_arena_take(arena, (size_t)s->n_cell * sizeof *x->result);
    if (x->options->parts > 0) {
        snprintf(name, sizeof name, "cells-%d-of-%d.csv", x->options->part, x->options->parts);
    }
    bough_status status = bough_folder_make(x->options->folder);
    if (!bough_is_ok(&status)) return status;
    status = bough_study_store_open(arena, x->options->folder, name, s, x->reference,
                                         x->result, &x->store);
    for (int g = 0; g < s->n_reference; g++) {
        int missing = is_mine(x, g) ? count_missing(x, g) : 0;
        x->to_do += missing + (missing > 0 && !x->reference[g].done);
    }
    return status;
}

// -- verdict --------------------------------------------------------------------------------------

// By the first measure: errors below this may be the sub-solvers' own, which nobody estimates.
static const double large = 0.05;

static bool is_silent(const bough_study_result *r) {
    if (!bough_is_ok(&r->outcome) || r->warned || !isfinite(r->error[0])) return false;
    return !(r->error[0] <= 3 * r->estimate[0]) && r->error[0] > large;
}

static bool held(const bough_study_result *r) { return r->done && bough_is_ok(&r->outcome); }

// "[1, 2, 3]" is shown by its first.
static void shorten(const char *value, char text[24]) {
    snprintf(text, 24, "%s", value + (value[0] == '['));
    text[strcspn(text, ",]")] = '\0';
}

static void name_row(const bough_study *s, const bough_study_cell *cell, char *text, size_t size) {
    size_t used = 0;
    text[0] = '\0';
    for (int i = 0; i + 1 < s->grid.n && used < size; i++) {
        char value[24];
        shorten(bough_study_value(s, cell, i), value);
        used += (size_t)snprintf(text + used, size - used, "%s%s", i ? ", " : "", value);
    }
}

static void paint(const bough_study_result *r, bough_map_cell *cell) {
    cell->kind = held(r) ? BOUGH_MAP_GOOD : BOUGH_MAP_STOPPED;
    cell->shade = -log10(fmax(r->error[0], 1e-12)) / 4;
    cell->hint = held(r) ? NULL : r->outcome.message;
    if (!held(r)) {
        snprintf(cell->text, sizeof cell->text, "%.3g s", r->time);
    } else if (isfinite(r->error[0])) {
        snprintf(cell->text, sizeof cell->text, "%.1e%s", r->error[0], r->warned ? "!" : "");
    } else {
        snprintf(cell->text, sizeof cell->text, "held");
    }
}

static bough_status make_map(bough_arena *arena, const stability *x, bough_map *map) {
    const bough_study *s = x->study;
    const bough_study_axis *across = &s->grid.axis[s->grid.n - 1];
    char legend[160], row[160];
    snprintf(legend, sizeof legend,
             "%.60s [%.20s]; !: warning before the run; red: stopped with a diagnosis, with its "
             "time",
             s->measure[0].name, s->measure[0].unit);
    *map = (bough_map){.title = s->title ? s->title : s->file,
                       .legend = bough_arena_string(arena, legend),
                       .across = across->label,
                       .n_column = across->value.n,
                       .n_row = s->n_cell / across->value.n,
                       .column_width = 66};
    map->row = bough_arena_take(arena, (size_t)map->n_row * sizeof *map->row);
    map->column = bough_arena_take(arena, (size_t)map->n_column * sizeof *map->column);
    map->cell = bough_arena_take(arena, (size_t)s->n_cell * sizeof *map->cell);
    for (int k = 0; k < map->n_column; k++) map->column[k] = across->value.item[k].value;
    for (int i = 0; i < map->n_row; i++) {
        name_row(s, &s->cell[i * map->n_column], row, sizeof row);
        map->row[i] = bough_arena_string(arena, row);
    }
    for (int i = 0; i < s->n_cell; i++) paint(&x->result[i], &map->cell[i]);
    return bough_ok();
}

static void print(const stability *x, const bough_map *map) {
    FILE *f = x->options->stream;
    fprintf(f, "%s\n%s\n%-40s", map->title, map->legend, "");
    for (int k = 0; k < map->n_column; k++) fprintf(f, " %9s", map->column[k]);
    for (int i = 0; i < map->n_row; i++) {
        fprintf(f, "\n%-40.40s", map->row[i]);
        for (int k = 0; k < map->n_column; k++) {
            const bough_map_cell *cell = &map->cell[i * map->n_column + k];
            bool silent = is_silent(&x->result[i * map->n_column + k]);
            fprintf(f, " %8s%s", cell->text, silent ? "?" : " ");
        }
    }
    fputc('\n', f);
}

static bough_status conclude(const stability *x) {
    int n_held = 0, n_silent = 0, n = x->study->n_cell;
    for (int i = 0; i < n; i++) {
        n_held += held(&x->result[i]);
        n_silent += is_silent(&x->result[i]);
    }
    fprintf(x->options->stream, "%d of %d held, %d stopped with a diagnosis, %d silent\n", n_held,
            n, n - n_held, n_silent);
    if (n_silent == 0) return bough_ok();
    return bough_fail(BOUGH_FAILED, "%d of %d cells are silent: marked ?", n_silent, n);
}

static bough_status report(bough_arena *arena, const stability *x) {
    int missing = 0;
    bough_map map;
    for (int g = 0; g < x->study->n_reference; g++) missing += count_missing(x, g);
    if (x->options->parts > 0) {
        fprintf(x->options->stream, "part %d of %d: %d runs, %d of %d cells still missing\n",
                x->options->part, x->options->parts, x->done, missing, x->study->n_cell);
        return bough_ok();
    }
    bough_study_results results = {x->study, x->reference[0], x->result};
    bough_status status = bough_study_write_tables(&results, x->options->folder);
    if (bough_is_ok(&status)) status = make_map(arena, x, &map);
    if (bough_is_ok(&status)) status = bough_map_write(&map, x->options->folder, "plot.svg");
    if (!bough_is_ok(&status)) return status;
    print(x, &map);
    return conclude(x);
}

bough_status bough_stability_perform(bough_arena *arena, const bough_study *study,
                                     const bough_study_options *options) {
    stability x = {.study = study, .options = options};
    bough_status status = start(arena, &x);
    if (bough_is_ok(&status)) status = run_groups(arena, &x);
    bough_study_store_close(&x.store);
    return bough_is_ok(&status) ? report(arena, &x) : status;
}
