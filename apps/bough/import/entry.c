#include "apps/bough/import/windio.h"

#include "apps/bough/config/schema.h"

enum { MOST = 4000, PATH = 200 };

void bough_entry_fail(bough_draft *d, const bough_node *where, const char *format, ...) {
    if (!bough_is_ok(d->status)) return;
    char text[300];
    BOUGH_PRINT(text, format);
    *d->status = bough_fail(BOUGH_INVALID, "%.150s:%d:%d: %s", where->file, where->line, where->column, text);
}

const bough_node *bough_entry_read(bough_draft *d, const char *path) {
    if (!bough_is_ok(d->status)) return NULL;
    bough_errors errors = {.arena = d->arena};
    const bough_node *root = bough_text_read(d->arena, path, &errors);
    if (root) return root;
    const bough_error *e = errors.item;
    char at[32] = "";
    if (e->line > 0) snprintf(at, sizeof at, ":%d:%d", e->line, e->column);
    *d->status = bough_fail(BOUGH_INVALID, "%.200s%s: %s", e->file, at, e->text);
    return NULL;
}

// -- paths ----------------------------------------------------------------------------------------

// The value of the first of the spellings "a|b" (n characters) that the mapping has.
static const bough_node *find(const bough_node *from, const char *names, size_t n) {
    char key[PATH];
    for (const char *p = names, *end = names + n; p < end; p++) {
        size_t length = strcspn(p, "|.");
        snprintf(key, sizeof key, "%.*s", (int)length, p);
        const bough_node *value = bough_node_find(from, key);
        if (value) return value;
        p += length;
    }
    return NULL;
}

// Follows the path as far as its keys exist; *rest is the remaining part, "" at its end.
static const bough_node *descend(const bough_node *from, const char *path, const char **rest) {
    while (from && *path) {
        size_t n = strcspn(path, ".");
        const bough_node *next = find(from, path, n);
        if (!next) break;
        from = next;
        path += n + (path[n] == '.');
    }
    *rest = path;
    return from;
}

const bough_node *bough_entry(const bough_node *from, const char *path) {
    const char *rest;
    const bough_node *node = descend(from, path, &rest);
    return *rest == '\0' ? node : NULL;
}

const bough_node *bough_entry_need(bough_draft *d, const bough_node *from, const char *path) {
    const char *rest;
    const bough_node *node = descend(from, path, &rest);
    if (!bough_is_ok(d->status) || !node) return NULL;
    if (*rest == '\0') return node;
    int done = (int)(rest - path);
    bough_entry_fail(d, node, "%.*s%sexpected a key '%.*s' here", done > 0 ? done - 1 : 0, path,
                     done > 0 ? ": " : "", (int)strcspn(rest, "."), rest);
    return NULL;
}

const bough_node *bough_entry_named(const bough_node *list, const char *name) {
    int i = list && list->kind == BOUGH_SEQUENCE ? bough_node_index(list, name) : -1;
    return i < 0 ? NULL : list->value[i];
}

// -- values ---------------------------------------------------------------------------------------

static double number_of(bough_draft *d, const bough_node *node, const char *path) {
    char why[160], shown[64];
    double value = 0;
    bool scalar = node->kind == BOUGH_SCALAR;
    if (scalar && bough_quantity(node->text, BOUGH_PURE_NUMBER, &value, why)) return value;
    bough_entry_fail(d, node, "%s%sexpected a number, got %s", path, path[0] ? ": " : "",
                     bough_node_shown(node, shown));
    return 0;
}

double bough_entry_number(bough_draft *d, const bough_node *from, const char *path) {
    const bough_node *node = bough_entry_need(d, from, path);
    return node ? number_of(d, node, path) : 0;
}

double bough_entry_number_or(bough_draft *d, const bough_node *from, const char *path, double fallback) {
    const bough_node *node = bough_entry(from, path);
    return node && bough_is_ok(d->status) ? number_of(d, node, path) : fallback;
}

const char *bough_entry_text(bough_draft *d, const bough_node *from, const char *path) {
    const bough_node *node = bough_entry_need(d, from, path);
    if (!node) return "";
    if (node->kind == BOUGH_SCALAR) return node->text;
    bough_entry_fail(d, node, "%s: expected a text", path);
    return "";
}

static bool is_list(bough_draft *d, const bough_node *node, const char *path, int wanted) {
    bool good = node->kind == BOUGH_SEQUENCE && node->n > 0 && node->n <= MOST;
    if (good && (wanted == 0 || node->n == wanted)) return true;
    bough_entry_fail(d, node, "%s%sexpected a list of %s%d numbers", path, path[0] ? ": " : "",
                     wanted > 0 ? "" : "1 to ", wanted > 0 ? wanted : (int)MOST);
    return false;
}

const double *bough_entry_numbers(bough_draft *d, const bough_node *from, const char *path, int *n) {
    const bough_node *node = bough_entry_need(d, from, path);
    if (!node || !is_list(d, node, path, *n)) return NULL;
    double *value = bough_arena_doubles(d->arena, (size_t)node->n);
    for (int i = 0; i < node->n; i++) value[i] = number_of(d, node->value[i], path);
    *n = node->n;
    return bough_is_ok(d->status) ? value : NULL;
}

// -- curves ---------------------------------------------------------------------------------------

bough_curve bough_curve_of(bough_draft *d, const bough_node *node, const double *x, const double *y, int n) {
    for (int i = 1; i < n; i++) {
        if (x[i] >= x[i - 1]) continue;
        bough_entry_fail(d, node,
                         "grid: expected increasing numbers, but number %d is not larger than the one before",
                         i + 1);
        return (bough_curve){0};
    }
    return (bough_curve){node, n, x, y};
}

bough_curve bough_entry_curve(bough_draft *d, const bough_node *from, const char *path) {
    const bough_node *node = bough_entry_need(d, from, path);
    int n = 0;
    const double *x = node ? bough_entry_numbers(d, node, "grid", &n) : NULL;
    const double *y = x ? bough_entry_numbers(d, node, "values", &n) : NULL;
    return y ? bough_curve_of(d, node, x, y, n) : (bough_curve){0};
}

double bough_curve_at(const bough_curve *c, double x) {
    return c->n > 0 ? bough_table_value(c->n, c->x, c->y, x) : 0;
}

int bough_curve_places(bough_draft *d, const bough_curve *const *curve, int n_curve, double least,
                       double **place) {
    int n = 0, kept = 0;
    for (int c = 0; c < n_curve; c++) n += curve[c]->n;
    double *x = *place = bough_arena_doubles(d->arena, (size_t)n + 2);
    n = 0;
    for (int c = 0; c < n_curve; c++) {
        for (int i = 0; i < curve[c]->n; i++) x[n++] = curve[c]->x[i];
    }
    qsort(x, (size_t)n, sizeof *x, bough_ascending);
    for (int i = 0; i < n; i++)
        if (kept == 0 || x[i] >= x[kept - 1] + least) x[kept++] = x[i];
    return kept;
}

int bough_curve_fractions(bough_draft *d, const bough_curve *const *curve, int n_curve, double least,
                          double **fraction) {
    double *all, *x;
    int n = bough_curve_places(d, curve, n_curve, least, &all), kept = 1;
    x = *fraction = bough_arena_doubles(d->arena, (size_t)n + 2);
    for (int i = 0; i < n; i++)
        if (all[i] >= least && all[i] < 1) x[kept++] = all[i];
    if (x[kept - 1] < 1 - least / 2) kept++;
    x[kept - 1] = 1;
    return kept;
}
