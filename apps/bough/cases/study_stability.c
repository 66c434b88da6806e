#include "apps/bough/cases/study_stability.h"

#include "apps/bough/cases/study_map.h"
#include "apps/bough/cases/study_table.h"

#include <math.h>
#include <string.h>

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

static bough_status make_map(bough_arena *arena, const bough_study_results *x, bough_map *map) {
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

static void print(const bough_study_results *x, const bough_map *map, FILE *f) {
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

static bough_status conclude(const bough_study_results *x, FILE *f) {
    int n_held = 0, n_silent = 0, n = x->study->n_cell;
    for (int i = 0; i < n; i++) {
        n_held += held(&x->result[i]);
        n_silent += is_silent(&x->result[i]);
    }
    fprintf(f, "%d of %d held, %d stopped with a diagnosis, %d silent\n", n_held, n, n - n_held, n_silent);
    if (n_silent == 0) return bough_ok();
    return bough_fail(BOUGH_FAILED, "%d of %d cells are silent: marked ?", n_silent, n);
}

bough_status bough_stability_perform(bough_arena *arena, const bough_study *study,
                                     const bough_study_options *options) {
    bough_study_results x;
    bough_map map;
    bough_status status = bough_study_cells(arena, study, options, &x);
    if (bough_is_ok(&status) && options->parts > 0) {
        fprintf(options->stream, "part %d of %d: %d runs, %d of %d cells still missing\n", options->part,
                options->parts, x.ran, bough_study_missing(&x), study->n_cell);
        return status;
    }
    if (bough_is_ok(&status)) status = bough_study_write_tables(&x, options->folder);
    if (bough_is_ok(&status)) status = make_map(arena, &x, &map);
    if (bough_is_ok(&status)) status = bough_map_write(&map, options->folder, "plot.svg");
    if (!bough_is_ok(&status)) return status;
    print(&x, &map, options->stream);
    return conclude(&x, options->stream);
}
