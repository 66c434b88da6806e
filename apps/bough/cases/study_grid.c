// From the grid to the runs: the cartesian product of its values.
#include "apps/bough/cases/study_internal.h"

#include <assert.h>
#include <stdio.h>
#include <string.h>

int bough_grid_count(const bough_study_grid *grid, int most) {
    long n = 1;
    for (int i = 0; i < grid->n && n <= most; i++) n *= grid->axis[i].value.n;
    return n <= most ? (int)n : most + 1;
}

void bough_grid_place(const bough_study_grid *grid, int number, int *index) {
    for (int i = grid->n - 1; i >= 0; i--) {
        index[i] = number % grid->axis[i].value.n;
        number /= grid->axis[i].value.n;
    }
}

const char *bough_grid_settings(bough_arena *arena, const bough_study_grid *grid, const int *index) {
    size_t size = 1, used = 0;
    for (int i = 0; i < grid->n; i++)
        size += strlen(grid->axis[i].label) + strlen(grid->axis[i].value.item[index[i]].value) + 3;
    char *text = bough_arena_take(arena, size);
    for (int i = 0; i < grid->n; i++) {
        used += (size_t)snprintf(text + used, size - used, "%s%s=%s", i ? ", " : "", grid->axis[i].label,
                                 grid->axis[i].value.item[index[i]].value);
    }
    return text;
}

static void add_set(bough_study_cell *cell, const bough_study_setting *setting) {
    cell->set[cell->n_set++] = setting->set;
}

static void take_sets(bough_arena *arena, const bough_study *s, int n_own, bough_study_cell *cell) {
    cell->set = bough_arena_take(arena, (size_t)(s->common.n + n_own) * sizeof *cell->set);
    for (int i = 0; i < s->common.n; i++) add_set(cell, &s->common.item[i]);
}

static void make_cell(bough_arena *arena, const bough_study *s, int number, bough_study_cell *cell) {
    bough_grid_place(&s->grid, number, cell->index);
    take_sets(arena, s, s->grid.n, cell);
    for (int i = 0; i < s->grid.n; i++) add_set(cell, &s->grid.axis[i].value.item[cell->index[i]]);
    cell->settings = bough_grid_settings(arena, &s->grid, cell->index);
}

// What is no setting of the simulation is a parameter of the model.
static bool is_model(const bough_study *s, int axis) {
    return s->kind == BOUGH_STUDY_STABILITY &&
           strncmp(s->grid.axis[axis].key, "simulation.", strlen("simulation.")) != 0;
}

static int count_references(const bough_study *s) {
    int n = 1;
    for (int i = 0; i < s->grid.n; i++)
        if (is_model(s, i)) n *= s->grid.axis[i].value.n;
    return n;
}

// The number of the reference with a cell's parameters of the model.
static int reference_of(const bough_study *s, const bough_study_cell *cell) {
    int number = 0;
    for (int i = 0; i < s->grid.n; i++)
        if (is_model(s, i)) number = number * s->grid.axis[i].value.n + cell->index[i];
    return number;
}

// "reference", or with the parameters "reference: damping=1e-3"
static const char *name_reference(bough_arena *arena, const bough_study *s, const bough_study_cell *cell) {
    char text[1024] = "reference";
    for (int i = 0; i < s->grid.n; i++) {
        size_t used = strlen(text);
        if (!is_model(s, i)) continue;
        snprintf(text + used, sizeof text - used, "%s %s=%s", used > 9 ? "," : ":", s->grid.axis[i].label,
                 bough_study_value(s, cell, i));
    }
    return bough_arena_string(arena, text);
}

static void make_reference(bough_arena *arena, const bough_study *s, int number, bough_study_cell *cell) {
    take_sets(arena, s, s->reference.n + s->grid.n, cell);
    for (int i = 0; i < BOUGH_STUDY_AXES; i++) cell->index[i] = -1;
    for (int i = s->grid.n - 1; i >= 0; i--) {
        if (!is_model(s, i)) continue;
        cell->index[i] = number % s->grid.axis[i].value.n;
        number /= s->grid.axis[i].value.n;
        add_set(cell, &s->grid.axis[i].value.item[cell->index[i]]);
    }
    for (int i = 0; i < s->reference.n; i++) add_set(cell, &s->reference.item[i]);
    cell->settings = name_reference(arena, s, cell);
}

static void make_references(bough_arena *arena, bough_study *s) {
    s->n_reference = count_references(s);
    s->reference_cell = bough_arena_take(arena, (size_t)s->n_reference * sizeof *s->reference_cell);
    for (int i = 0; i < s->n_reference; i++) make_reference(arena, s, i, &s->reference_cell[i]);
}

void bough_study_expand(bough_arena *arena, bough_study *s, bough_errors *errors) {
    int n = bough_grid_count(&s->grid, BOUGH_STUDY_CELLS);
    if (n > BOUGH_STUDY_CELLS) {
        bough_errors_add(errors, bough_node_find(s->node, "grid"), "grid", "expected at most %d combinations",
                         BOUGH_STUDY_CELLS);
        return;
    }
    make_references(arena, s);
    s->cell = bough_arena_take(arena, (size_t)n * sizeof *s->cell);
    s->n_cell = n;
    for (int i = 0; i < n; i++) {
        make_cell(arena, s, i, &s->cell[i]);
        s->cell[i].reference = reference_of(s, &s->cell[i]);
    }
}

static const char *find_value(const bough_study_settings *settings, const char *key) {
    for (int i = 0; i < settings->n; i++) {
        if (strcmp(settings->item[i].key, key) == 0) return settings->item[i].value;
    }
    return NULL;
}

const char *bough_study_value(const bough_study *study, const bough_study_cell *cell, int axis) {
    assert(axis < study->grid.n);
    const bough_study_axis *a = &study->grid.axis[axis];
    if (cell->index[axis] >= 0) return a->value.item[cell->index[axis]].value;
    const char *value = find_value(&study->reference, a->key);
    if (!value) value = find_value(&study->common, a->key);
    return value ? value : "";
}
