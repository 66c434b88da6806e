// Reads replacements of keys and the axes of a grid, and finds the values of a case.
#include "apps/bough/cases/study.h"

// -- replacements ---------------------------------------------------------------------------------

// Writes a value in one line: 'text', [1, 2], {a: [1, 2]}. False if it is nested too deeply for recursion.
static bool put_flow(FILE *f, const bough_node *value) {
    enum { DEEPEST = 8 };
    if (value->height > DEEPEST) return false;
    if (value->kind == BOUGH_SCALAR) {
        if (value->quoted) fputc('\'', f);
        for (const char *c = value->text; *c; c++) {
            if (value->quoted && *c == '\'') fputc('\'', f);
            fputc(*c, f);
        }
        if (value->quoted) fputc('\'', f);
        return true;
    }
    bool mapping = value->kind == BOUGH_MAPPING;
    fputc(mapping ? '{' : '[', f);
    for (int i = 0; i < value->n; i++) {
        if (i) fputs(", ", f);
        if (mapping) fprintf(f, "%s: ", value->key[i]->text);
        if (!put_flow(f, value->value[i])) return false;
    }
    fputc(mapping ? '}' : ']', f);
    return true;
}

static const char *write_flow(bough_arena *arena, const bough_node *value) {
    char *text = NULL;
    size_t size = 0;
    FILE *f = open_memstream(&text, &size);
    if (!f) return NULL;
    bool whole = put_flow(f, value);
    fclose(f);
    const char *kept = whole ? bough_arena_string(arena, text) : NULL;
    free(text);
    return kept;
}

// A quoted value is quoted in the replacement, too, so that it stays a text.
static void read_setting(bough_schema_reader *r, const char *key, const bough_node *value,
                         bough_study_setting *setting) {
    char shown[64];
    const char *flow = write_flow(r->arena, value), *text = value->kind == BOUGH_SCALAR ? value->text : flow;
    if (!flow || text[0] == '\0') {
        bough_schema_error(r, value, key, "expected one value, got %s", bough_node_shown(value, shown));
        return;
    }
    *setting = (bough_study_setting){value, key, text, bough_arena_print(r->arena, "%s=%s", key, flow)};
}

static bool is_mapping(bough_schema_reader *r, const bough_node *node, const char *what) {
    if (node->kind == BOUGH_MAPPING && node->n > 0) return true;
    bough_schema_expected(r, node, what);
    return false;
}

void bough_study_read_settings(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_study_settings *settings = field;
    if (!is_mapping(r, node, "keys of the scene with their values")) return;
    settings->item = bough_arena_take(r->arena, (size_t)node->n * sizeof *settings->item);
    settings->n = node->n;
    for (int i = 0; i < node->n; i++) read_setting(r, node->key[i]->text, node->value[i], &settings->item[i]);
}

// -- grid -----------------------------------------------------------------------------------------

// A value that is given twice would be run twice and count twice.
static void check_different(bough_schema_reader *r, const bough_study_axis *axis) {
    const bough_study_settings *value = &axis->value;
    for (int i = 1; i < value->n; i++) {
        for (int k = 0; k < i && value->item[i].value && value->item[k].value; k++) {
            if (strcmp(value->item[i].value, value->item[k].value) != 0) continue;
            bough_schema_error(r, value->item[i].node, axis->key, "'%.80s' is given twice",
                               value->item[i].value);
            return;
        }
    }
}

static void read_axis(bough_schema_reader *r, const bough_node *key, const bough_node *values,
                      bough_study_axis *axis) {
    char shown[64];
    *axis = (bough_study_axis){.key = key->text, .label = key->text};
    if (values->kind != BOUGH_SEQUENCE || values->n == 0) {
        bough_schema_error(r, values, key->text, "expected a list of values, got %s",
                           bough_node_shown(values, shown));
        return;
    }
    axis->value.item = bough_arena_take(r->arena, (size_t)values->n * sizeof *axis->value.item);
    axis->value.n = values->n;
    for (int i = 0; i < values->n; i++) read_setting(r, key->text, values->value[i], &axis->value.item[i]);
    check_different(r, axis);
}

// The last part of the key, or as many parts as distinguish it from the other axes' keys.
static const char *short_label(const bough_study_grid *grid, int axis) {
    const char *key = grid->axis[axis].key;
    for (const char *label = key + strlen(key); label > key; label--) {
        bool unique = label[-1] == '.' && *label;
        for (int i = 0; unique && i < grid->n; i++)
            unique = i == axis || !bough_ends_with(grid->axis[i].key, label);
        if (unique) return label;
    }
    return key;
}

void bough_study_read_grid(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_study_grid *grid = field;
    if (!is_mapping(r, node, "keys of the scene, each with a list of values")) return;
    if (node->n > BOUGH_STUDY_AXES) {
        bough_schema_error(r, node, "", "expected at most %d keys, got %d", BOUGH_STUDY_AXES, node->n);
        return;
    }
    grid->axis = bough_arena_take(r->arena, (size_t)node->n * sizeof *grid->axis);
    grid->n = node->n;
    for (int i = 0; i < node->n; i++) read_axis(r, node->key[i], node->value[i], &grid->axis[i]);
    for (int i = 0; i < node->n; i++) grid->axis[i].label = short_label(grid, i);
}

// -- values of a case -----------------------------------------------------------------------------

const char *bough_grid_others(bough_arena *arena, const bough_study *study, const bough_case *c, int axis) {
    const char *text = "";
    for (int i = 0; i < study->grid.n; i++) {
        if (i == axis || study->grid.axis[i].value.n < 2) continue;
        text = bough_arena_print(arena, "%s%s%s", text, text[0] ? ", " : "", bough_study_value(study, c, i));
    }
    return text;
}

static const char *find_value(const bough_study_settings *settings, const char *key) {
    for (int i = 0; i < settings->n; i++) {
        if (strcmp(settings->item[i].key, key) == 0) return settings->item[i].value;
    }
    return NULL;
}

const char *bough_study_value(const bough_study *study, const bough_case *c, int axis) {
    assert(axis < study->grid.n);
    const bough_study_axis *a = &study->grid.axis[axis];
    if (c->index[axis] >= 0) return a->value.item[c->index[axis]].value;
    const char *value = find_value(&study->reference, a->key);
    if (!value) value = find_value(&study->common, a->key);
    return value ? value : "";
}
