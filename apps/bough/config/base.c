#include "apps/bough/config/base.h"

#include "core/base/quote.h"

#include <sys/stat.h>

enum { MOST_BASES = 8, PATH = 200 };

static const char base_key[] = "base";

typedef struct merger {
    bough_arena *arena;
    bough_errors *errors;
    const char *first; // the file that builds on others
    char path[PATH];   // of the value that is merged
} merger;

bool bough_node_is_null(const bough_node *node) {
    bool plain = node != NULL && node->kind == BOUGH_SCALAR && !node->quoted;
    return plain && (strcmp(node->text, "null") == 0 || strcmp(node->text, "~") == 0);
}

const char *bough_directory_of(bough_arena *arena, const char *path) {
    return bough_arena_print(arena, "%.*s", (int)(bough_file_name(path) - path), path);
}

// -- merging --------------------------------------------------------------------------------------

bough_node *bough_node_start(bough_arena *arena, const bough_node *like, int room) {
    bough_node *node = bough_arena_take(arena, sizeof *node);
    bough_node **slots = bough_arena_take(arena, 2 * (size_t)room * sizeof *slots);
    *node = *like;
    node->n = 0;
    node->value = slots;
    node->key = like->kind == BOUGH_MAPPING ? slots + room : NULL;
    return node;
}

void bough_node_append(bough_node *node, bough_node *key, bough_node *value) {
    if (node->key != NULL) node->key[node->n] = key;
    node->value[node->n++] = value;
}

void bough_node_move(bough_node *node, const bough_node *at) {
    node->file = at->file;
    node->line = at->line;
    node->column = at->column;
    for (int i = 0; i < node->n; i++) {
        if (node->key != NULL) bough_node_move(node->key[i], at);
        bough_node_move(node->value[i], at);
    }
}

static bool has_names(const bough_node *list) {
    bool all = list->kind == BOUGH_SEQUENCE && list->n > 0;
    for (int i = 0; i < list->n && all; i++) all = bough_node_name(list, i) != NULL;
    return all;
}

static bough_node *merge(merger *m, bough_node *base, bough_node *over);

// Merges the values below a key of the base, or below a name of its list.
static bough_node *merge_at(merger *m, const char *before, const char *key, const char *after,
                            bough_node *base, bough_node *over) {
    size_t length = strlen(m->path);
    snprintf(m->path + length, sizeof m->path - length, "%s%s%s", before, key, after);
    bough_node *merged = merge(m, base, over);
    m->path[length] = '\0';
    return merged;
}

bough_suggestion bough_node_suggest(bough_arena *arena, const bough_node *node, const char *name) {
    const char **known = bough_arena_take(arena, ((size_t)node->n + 1) * sizeof *known);
    for (int i = 0; i < node->n; i++) known[i] = bough_node_name(node, i);
    return bough_suggest(name, known, node->n);
}

static void nothing_to_remove(merger *m, const bough_node *key, const bough_node *base) {
    bough_errors_add(m->errors, key, m->path, "the base has no '%.60s'%s", key->text,
                     bough_node_suggest(m->arena, base, key->text).text);
}

// Values have names by their keys in a mapping, by their own key `name` in a list.
static bough_node *merge_values(merger *m, const bough_node *base, const bough_node *over) {
    bool list = base->kind == BOUGH_SEQUENCE;
    const char *before = list ? "[" : m->path[0] ? "." : "", *after = list ? "]" : "";
    bough_node *merged = bough_node_start(m->arena, base, base->n + over->n);
    for (int i = 0; i < base->n; i++) {
        const char *name = bough_node_name(base, i);
        int other = bough_node_index(over, name);
        bough_node *value = base->value[i];
        if (other >= 0) value = merge_at(m, before, name, after, value, over->value[other]);
        if (value != NULL) bough_node_append(merged, list ? NULL : base->key[i], value);
    }
    for (int i = 0; i < over->n; i++) {
        if (bough_node_index(base, bough_node_name(over, i)) >= 0) continue;
        if (over->kind != base->kind || bough_node_is_null(over->value[i])) {
            nothing_to_remove(m, over->key[i], base);
        } else {
            bough_node_append(merged, list ? NULL : over->key[i], over->value[i]);
        }
    }
    return merged;
}

// The base's value as the other one changes it; NULL: it is removed.
static bough_node *merge(merger *m, bough_node *base, bough_node *over) {
    if (bough_node_is_null(over)) return NULL;
    if (base->kind == BOUGH_MAPPING && over->kind == BOUGH_MAPPING) return merge_values(m, base, over);
    bool table = bough_node_find(over, "columns") != NULL; // a list in another form
    bool by_name = has_names(over) || (over->kind == BOUGH_MAPPING && !table);
    return has_names(base) && by_name ? merge_values(m, base, over) : over;
}

bough_node *bough_node_merge(bough_arena *arena, bough_errors *errors, const char *path, bough_node *base,
                             bough_node *over) {
    merger m = {.arena = arena, .errors = errors};
    snprintf(m.path, sizeof m.path, "%s", path);
    return merge(&m, base, over);
}

// -- reading --------------------------------------------------------------------------------------

// Whether two paths lead to one file.
static bool same_file(const char *a, const char *b) {
    struct stat about_a, about_b;
    if (stat(a, &about_a) != 0 || stat(b, &about_b) != 0) return false;
    return about_a.st_dev == about_b.st_dev && about_a.st_ino == about_b.st_ino;
}

// Refuses a base that is in the chain already, and a chain that is too long.
static bool may_follow(const merger *m, const bough_schema_base *bases, const char *path,
                       const bough_node *where) {
    int depth = 0;
    bool again = same_file(m->first, path);
    for (const bough_schema_base *b = bases; b != NULL; b = b->next, depth++)
        again = again || same_file(b->path, path);
    if (again) bough_errors_add(m->errors, where, base_key, "file '%s' would build on itself", path);
    if (depth >= MOST_BASES)
        bough_errors_add(m->errors, where, base_key, "expected at most %d bases in a row", MOST_BASES);
    return !again && depth < MOST_BASES;
}

// The base that the value of the key names, in a file that is opened as `path`.
static bough_schema_base *find_base(const merger *m, const bough_node *name, const char *path,
                                    bool absolute) {
    const char *directory = name->text[0] == '/' ? "" : bough_directory_of(m->arena, path);
    bough_schema_base *base = bough_arena_take(m->arena, sizeof *base);
    base->path = bough_arena_print(m->arena, "%s%s", directory, name->text);
    base->directory = bough_directory_of(m->arena, base->path);
    base->absolute = absolute || name->text[0] == '/';
    return base;
}

// The tree of a file merged with its bases, the list of which begins at *next.
static bough_node *read_on_base(merger *m, const char *path, bool absolute, bough_schema_base **next,
                                bough_schema_base *const *bases) {
    bough_node *root = bough_text_read(m->arena, path, m->errors);
    const bough_node *name = bough_node_find(root, base_key);
    if (name == NULL) return root;
    if (name->kind != BOUGH_SCALAR || name->text[0] == '\0') {
        char shown[64];
        bough_errors_add(m->errors, name, base_key, "expected the name of a file, got %s",
                         bough_node_shown(name, shown));
        return NULL;
    }
    bough_schema_base *base = find_base(m, name, path, absolute);
    if (!may_follow(m, *bases, base->path, name)) return NULL;
    *next = base;
    bough_node *tree = read_on_base(m, base->path, base->absolute, &base->next, bases);
    if (tree == NULL || tree->kind != BOUGH_MAPPING) {
        bough_errors_add(m->errors, name, base_key, "'%s' is not a file to build on", base->path);
        return NULL;
    }
    return merge(m, tree, root);
}

bough_node *bough_base_read(bough_arena *arena, const char *path, bough_errors *errors,
                            bough_schema_base **bases) {
    merger m = {.arena = arena, .errors = errors, .first = path};
    *bases = NULL;
    return read_on_base(&m, path, false, bases, bases);
}

// -- writing --------------------------------------------------------------------------------------

typedef struct writer {
    const char *(*text)(void *self, const bough_node *scalar);
    void *self;
    FILE *stream;
} writer;

// Plain text that another reader could take for something else is quoted.
static void write_scalar(const writer *w, const bough_node *node) {
    const char *text = w->text(w->self, node);
    static const char safe[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_./+-^() ";
    size_t length = strlen(text);
    bool plain = !node->quoted && length > 0 && strspn(text, safe) == length && text[0] != ' ' &&
                 text[length - 1] != ' ' && strcmp(text, "-") != 0;
    if (plain && strncmp(text, "- ", 2) != 0) {
        fputs(text, w->stream);
    } else {
        bough_quote(w->stream, text);
    }
}

static bool is_flat(const bough_node *node) {
    for (int i = 0; i < node->n; i++) {
        if (node->value[i]->kind != BOUGH_SCALAR) return false;
    }
    return true;
}

// A list of scalars in one line.
static void write_flow(const writer *w, const bough_node *node) {
    fputc('[', w->stream);
    for (int i = 0; i < node->n; i++) {
        if (i > 0) fputs(", ", w->stream);
        write_scalar(w, node->value[i]);
    }
    fputc(']', w->stream);
}

static void write_items(const writer *w, const bough_node *node, int indent, bool begun);

// After "key:" or "-", whose items stand at `indent`.
static void write_value(const writer *w, const bough_node *node, int indent, bool in_list) {
    bool mapping = node->kind == BOUGH_MAPPING, flow = node->n == 0 || (!mapping && is_flat(node));
    if (node->kind == BOUGH_SCALAR || flow || (mapping && in_list)) fputc(' ', w->stream);
    if (node->kind == BOUGH_SCALAR) {
        write_scalar(w, node);
    } else if (node->n == 0) {
        fputs(mapping ? "{}" : "[]", w->stream);
    } else if (flow) {
        write_flow(w, node);
    } else {
        if (!(mapping && in_list)) fputc('\n', w->stream);
        write_items(w, node, indent, mapping && in_list);
        return;
    }
    fputc('\n', w->stream);
}

// `begun`: the first item continues a line.
static void write_items(const writer *w, const bough_node *node, int indent, bool begun) {
    for (int i = 0; i < node->n; i++) {
        if (indent == 0 && node->key != NULL && strcmp(node->key[i]->text, base_key) == 0) continue;
        if (i > 0 || !begun) fprintf(w->stream, "%*s", indent, "");
        if (node->key != NULL) write_scalar(w, node->key[i]);
        fputc(node->key != NULL ? ':' : '-', w->stream);
        write_value(w, node->value[i], indent + 2, node->key == NULL);
    }
}

void bough_node_write(const bough_node *node, const char *(*text)(void *self, const bough_node *scalar),
                      void *self, FILE *stream) {
    writer w = {text, self, stream};
    if (node->kind == BOUGH_SCALAR) {
        write_scalar(&w, node);
    } else {
        write_items(&w, node, 0, false);
    }
}
