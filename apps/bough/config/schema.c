// Reading by table. Errors do not stop the reading: a wrong value leaves NaN, −1 or NULL behind and
// the rest is read, so that one run shows every error of a file.
#include "apps/bough/config/schema.h"

#include "core/base/input_file.h"

static void read_value(bough_schema_reader *r, const bough_key *key, const bough_node *node, void *item);

// Values that do not increase are not counted: checks across keys are possible in spite of them.
static int errors_so_far(const bough_schema_reader *r) {
    return r->errors->n + r->errors->dropped - r->out_of_order;
}

// -- tables ---------------------------------------------------------------------------------------

const bough_key *bough_schema_find(const bough_schema *schema, const char *name) {
    for (int i = 0; i < schema->n_key; i++) {
        if (strcmp(schema->key[i].name, name) == 0) return &schema->key[i];
    }
    return NULL;
}

static void unknown_key(bough_schema_reader *r, const bough_schema *schema, const bough_node *at,
                        const char *name) {
    const char *names[64];
    char shown[64];
    bough_node word = {.kind = BOUGH_SCALAR, .text = name};
    int n = 0;
    for (; n < schema->n_key && n < 64; n++) names[n] = schema->key[n].name;
    if (r->errors->dropped > 0) n = 0; // a hostile file: spelling costs time
    bough_schema_error(r, at, "", "unknown key %s%s", bough_node_shown(&word, shown),
                       bough_suggest(name, names, n).text);
}

// The heads of a compact table: key names with the unit of their plain numbers, "twist deg".
typedef struct columns {
    int n;
    bough_node **key;  // (n)
    const char **unit; // (n), NULL: SI
} columns;

// A column head: its name into a node, its unit or NULL.
static bool read_column(bough_schema_reader *r, const bough_schema *row, const bough_node *head,
                        bough_node *name, const char **unit) {
    if (head->kind != BOUGH_SCALAR || head->text[0] == '\0') {
        bough_schema_expected(r, head, "a column's name");
        return false;
    }
    char *text = bough_arena_string(r->arena, head->text), why[160];
    double factor;
    char *space = strchr(text, ' ');
    if (space != NULL) *space = '\0';
    *name = *head;
    name->text = text;
    *unit = space == NULL ? NULL : space + 1 + strspn(space + 1, " ");
    const bough_key *key = bough_schema_find(row, text);
    if (key == NULL) {
        unknown_key(r, row, head, text);
        return false;
    }
    if (*unit == NULL) return true;
    bool one_number = key->kind == BOUGH_KEY_NUMBER;
    if (one_number && bough_unit_fits(*unit, key->dimension, &factor, why)) return true;
    bough_schema_error(r, head, "", one_number ? "column '%s': %s" : "column '%s' takes no unit", text, why);
    return false;
}

static bool read_columns(bough_schema_reader *r, const bough_schema *row, const bough_node *heads,
                         columns *c) {
    if (heads->kind != BOUGH_SEQUENCE || heads->n == 0) {
        bough_schema_expected(r, heads, "a list of column names");
        return false;
    }
    bough_node *names = bough_arena_take(r->arena, (size_t)heads->n * sizeof *names);
    c->n = heads->n;
    c->key = bough_arena_take(r->arena, (size_t)c->n * sizeof *c->key);
    c->unit = bough_arena_take(r->arena, (size_t)c->n * sizeof *c->unit);
    bool good = true;
    for (int i = 0; i < c->n; i++) {
        c->key[i] = &names[i];
        bool read = read_column(r, row, heads->value[i], &names[i], &c->unit[i]);
        for (int k = 0; read && good && k < i; k++) {
            if (strcmp(names[k].text, names[i].text) != 0) continue;
            bough_schema_error(r, heads->value[i], "", "column '%s' is given twice", names[i].text);
            read = false;
        }
        good = good && read;
    }
    return good;
}

static void read_mapping(bough_schema_reader *r, const bough_schema *schema, const bough_node *node,
                         const char *const *units, void *item);

// A row of a compact table as the mapping it stands for; false after an error.
static bool row_mapping(bough_schema_reader *r, const bough_node *row, const columns *c,
                        bough_node *mapping) {
    char what[60];
    snprintf(what, sizeof what, "a list of %d values, one per column", c->n);
    if (row->kind != BOUGH_SEQUENCE) {
        bough_schema_expected(r, row, what);
        return false;
    }
    if (row->n != c->n) {
        bough_schema_error(r, row, "", "expected %s, got %d", what, row->n);
        return false;
    }
    *mapping = *row;
    mapping->kind = BOUGH_MAPPING;
    mapping->key = c->key;
    return true;
}

// The values of some keys increase from row to row.
static void check_order(bough_schema_reader *r, const bough_schema *schema, void *before, void *row) {
    for (int i = 0; i < schema->n_key; i++) {
        const bough_key *key = &schema->key[i];
        if (!key->increasing) continue;
        const bough_node *last = bough_node_find(*(const bough_node **)before, key->name);
        const bough_node *now = bough_node_find(*(const bough_node **)row, key->name);
        if (last == NULL || now == NULL) continue;
        double value = *(double *)bough_field_at(row, key->offset);
        if (value <= *(double *)bough_field_at(before, key->offset))
            bough_schema_not_more(r, key->name, last, now);
    }
}

// A list of mappings; with columns the rows of a compact table.
static void read_rows(bough_schema_reader *r, const bough_key *key, const bough_node *node, const columns *c,
                      void *item) {
    size_t size = key->of->size;
    char *items = bough_schema_items(r, key, node, size, item);
    if (items == NULL) return;
    bough_node *mapping = bough_arena_take(r->arena, (c ? (size_t)node->n : 0) * sizeof *mapping);
    for (int i = 0; i < node->n; i++) {
        size_t length = bough_schema_push(r, "[%d]", i);
        char *row = items + (size_t)i * size;
        if (c == NULL) {
            bough_schema_read(r, key->of, node->value[i], row);
        } else if (row_mapping(r, node->value[i], c, &mapping[i])) {
            read_mapping(r, key->of, &mapping[i], c->unit, row);
        }
        if (i > 0) check_order(r, key->of, row - size, row);
        bough_schema_pop(r, length);
    }
}

// {columns: […], rows: [[…], …]}
static void read_table(bough_schema_reader *r, const bough_key *key, const bough_node *node, void *item) {
    const bough_node *heads = bough_node_find(node, "columns");
    const bough_node *rows = bough_node_find(node, "rows");
    for (int i = 0; i < node->n; i++) {
        if (node->value[i] == heads || node->value[i] == rows) continue;
        char shown[64];
        bough_schema_error(r, node->key[i], "", "unknown key %s: a table has 'columns' and 'rows'",
                           bough_node_shown(node->key[i], shown));
    }
    if (heads == NULL || rows == NULL) {
        bough_schema_error(r, node, "", "expected a list of mappings, or 'columns' and 'rows'");
        return;
    }
    columns c;
    size_t length = bough_schema_push_key(r, "columns");
    bool good = read_columns(r, key->of, heads, &c);
    bough_schema_pop(r, length);
    if (!good) return;
    length = bough_schema_push_key(r, "rows");
    read_rows(r, key, rows, &c, item);
    bough_schema_pop(r, length);
}

// -- files ----------------------------------------------------------------------------------------

// The record of a file as read by a schema, or, with NULL, of its name alone; NULL: none yet.
static const bough_schema_file *find_file(const bough_schema_file *f, const char *path,
                                          const bough_schema *schema) {
    while (f != NULL && (f->schema != schema || strcmp(f->path, path) != 0)) f = f->next;
    return f;
}

static void add_file(bough_arena *arena, bough_schema_file **files, bough_schema_file added) {
    bough_schema_file *file = bough_arena_take(arena, sizeof *file);
    *file = added;
    file->next = *files;
    *files = file;
}

void bough_schema_add_file(bough_schema_reader *r, const char *key, const char *path, bool absolute) {
    add_file(r->arena, &r->files, (bough_schema_file){.key = key, .path = path, .absolute = absolute});
}

const char *bough_schema_path(bough_schema_reader *r, const bough_node *node, const char *key,
                              const char *name) {
    const bough_node *written = key[0] == '\0' ? node : bough_node_find(node, key);
    const bough_schema_base *base = written != NULL ? r->bases : NULL;
    while (base != NULL && strcmp(base->path, written->file) != 0) base = base->next;
    const char *directory = name[0] == '/' ? "" : base != NULL ? base->directory : r->directory;
    const char *path = bough_arena_print(r->arena, "%s%s", directory, name);
    const bough_schema_file *known = find_file(r->files, path, NULL);
    if (known != NULL) return known->path;
    size_t length = key[0] == '\0' ? strlen(r->path) : bough_schema_push_key(r, key);
    bough_schema_add_file(r, bough_arena_string(r->arena, r->path), path,
                          name[0] == '/' || (base != NULL && base->absolute));
    bough_schema_pop(r, length);
    return path;
}

// Reads the file's struct; errors inside it have paths that start at the file's top.
static void *load(bough_schema_reader *r, const bough_schema *schema, const char *path) {
    void *item = bough_arena_take(r->arena, schema->size);
    add_file(r->arena, &r->files, (bough_schema_file){.path = path, .schema = schema, .item = item});
    bough_node *root = bough_text_read(r->arena, path, r->errors);
    if (root == NULL) return item;
    char outer[sizeof r->path];
    memcpy(outer, r->path, sizeof outer);
    r->path[0] = '\0';
    bough_schema_read(r, schema, root, item);
    memcpy(r->path, outer, sizeof outer);
    return item;
}

// Reads a file for all scenes that share it. It names no further files, which each scene would have to
// record.
static void *load_shared(bough_schema_reader *r, const bough_schema *schema, const char *path) {
    bough_schema_shared *shared = r->shared;
    bough_arena *own = r->arena;
    int before = r->errors->n + r->errors->dropped;
    r->arena = shared->arena;
    bough_schema_file file = {.path = bough_arena_string(r->arena, path), .schema = schema};
    void *item = load(r, schema, file.path);
    r->arena = own;
    assert(r->files->item == item);
    if (r->errors->n + r->errors->dropped == before) file.item = item;
    add_file(shared->arena, &shared->file, file);
    return item;
}

static void read_file(bough_schema_reader *r, const bough_schema *schema, const bough_node *node,
                      void *field) {
    if (node->kind != BOUGH_SCALAR || node->text[0] == '\0') {
        bough_schema_expected(r, node, "the name of a file");
        return;
    }
    const char *path = bough_schema_path(r, node, "", node->text);
    const bough_schema_file *known =
        find_file(r->files, path, schema); // bodies that name it share its tables
    if (known == NULL && r->shared != NULL) known = find_file(r->shared->file, path, schema);
    if (known != NULL && known->item != NULL) {
        memcpy(field, known->item, schema->size);
        return;
    }
    char why[BOUGH_INPUT_REASON];
    FILE *stream = bough_input_open(path, BOUGH_INPUT_TEXT, why);
    if (stream == NULL) {
        bough_schema_error(r, node, "", "file '%s' cannot be read: %s", path, why);
        return;
    }
    fclose(stream);
    bool shares = r->shared != NULL && !r->shared->complete && known == NULL;
    memcpy(field, shares ? load_shared(r, schema, path) : load(r, schema, path), schema->size);
}

// -- mappings -------------------------------------------------------------------------------------

static void read_value(bough_schema_reader *r, const bough_key *key, const bough_node *node, void *item) {
    void *field = bough_field_at(item, key->offset);
    switch (key->kind) {
    case BOUGH_KEY_MAPPING: bough_schema_read(r, key->of, node, field); break;
    case BOUGH_KEY_LIST:
        if (node->kind == BOUGH_MAPPING) {
            read_table(r, key, node, item);
        } else {
            read_rows(r, key, node, NULL, item);
        }
        break;
    case BOUGH_KEY_FILE: read_file(r, key->of, node, field); break;
    case BOUGH_KEY_CUSTOM:
        r->key = key;
        key->read(r, node, field);
        break;
    default: bough_schema_value(r, key, node, item);
    }
}

static void read_fallback(bough_schema_reader *r, const bough_key *key, void *item) {
    if (key->kind == BOUGH_KEY_MAPPING) {
        bough_schema_read(r, key->of, NULL, bough_field_at(item, key->offset));
        return;
    }
    if (key->fallback == NULL) return;
    bough_node scalar = {.kind = BOUGH_SCALAR, .text = key->fallback, .file = "default"};
    const bough_node *node = &scalar;
    if (key->fallback[0] == '[') {
        node = bough_text_parse(r->arena, "default", key->fallback, strlen(key->fallback), r->errors);
    }
    if (node != NULL) read_value(r, key, node, item);
}

typedef enum relevance { APPLIES, APPLIES_NOT, UNKNOWN } relevance;

// Whether the key applies under the choices read before it.
static relevance applies(const bough_schema *schema, const bough_key *key, void *item) {
    if (key->when == NULL) return APPLIES;
    const bough_key *by = bough_schema_find(schema, key->when_key);
    int choice = *(int *)bough_field_at(item, by->offset);
    if (choice < 0) return UNKNOWN;
    return bough_word_is_among(bough_key_choice(by, choice), key->when, '|') ? APPLIES : APPLIES_NOT;
}

// Refuses a key that does not apply here, unless another key of that name does. The error lists the choices
// under which it applies.
static void refuse_key(bough_schema_reader *r, const bough_schema *schema, const bough_key *key,
                       const bough_node *at, void *item) {
    char where[120] = "";
    for (int i = 0; i < schema->n_key; i++) {
        const bough_key *other = &schema->key[i];
        if (strcmp(other->name, key->name) != 0) continue;
        if (other < key || applies(schema, other, item) != APPLIES_NOT) return;
        size_t used = strlen(where);
        snprintf(where + used, sizeof where - used, "%s%s", used == 0 ? "" : "|", other->when);
    }
    for (char *c = strchr(where, '|'); c != NULL; c = strchr(c, '|')) *c = '/';
    bough_schema_error(r, at, key->name, "only used with '%s: %s'", key->when_key, where);
}

static void read_one_key(bough_schema_reader *r, const bough_schema *schema, const bough_key *key,
                         const bough_node *node, const char *const *units, void *item) {
    int index = bough_node_index(node, key->name);
    relevance use = applies(schema, key, item);
    if (index >= 0 && use == APPLIES) {
        size_t length = bough_schema_push_key(r, key->name);
        r->unit = units == NULL ? NULL : units[index];
        read_value(r, key, node->value[index], item);
        r->unit = NULL;
        bough_schema_pop(r, length);
    } else if (index >= 0 && use == APPLIES_NOT) {
        refuse_key(r, schema, key, node->key[index], item);
    } else if (index < 0 && use == APPLIES) {
        if (key->required && node != NULL) {
            bough_schema_error(r, node, "", "required key '%s' is missing", key->name);
        }
        read_fallback(r, key, item);
    }
}

static void read_mapping(bough_schema_reader *r, const bough_schema *schema, const bough_node *node,
                         const char *const *units, void *item) {
    int before = errors_so_far(r);
    *(const bough_node **)item = node;
    for (int i = 0; i < schema->n_key; i++) {
        read_one_key(r, schema, &schema->key[i], node, units, item);
    }
    for (int i = 0; node != NULL && i < node->n; i++) {
        if (bough_schema_find(schema, node->key[i]->text) == NULL) {
            unknown_key(r, schema, node->key[i], node->key[i]->text);
        }
    }
    bool good = errors_so_far(r) == before;
    if (schema->check != NULL && node != NULL && good) {
        schema->check(r, item);
    }
}

void bough_schema_read(bough_schema_reader *reader, const bough_schema *schema, const bough_node *node,
                       void *item) {
    if (node != NULL && node->kind != BOUGH_MAPPING) {
        char what[80];
        snprintf(what, sizeof what, "%s (a mapping of keys)", schema->name);
        bough_schema_expected(reader, node, what);
        node = NULL;
    }
    read_mapping(reader, schema, node, NULL, item);
}
