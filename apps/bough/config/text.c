// The tree is built from libyaml's events, not by its document loader: that one takes minutes on
// hostile nesting and does not keep the positions of aliases. Children of open containers wait
// on one stack of pointers; a container that closes takes its slice of the stack.
#include "apps/bough/config/text.h"

#include "core/base/input_file.h"

#include <yaml.h>

enum {
    MAX_BYTES = 16 * 1024 * 1024,
    MAX_DEPTH = 64,
    MAX_NODES = 1000000,
    MAX_ANCHORS = 1000,
    MAX_ERRORS = 100,
    POOL_BYTES = 64 * 1024, // of one block; smaller for a short text
};

typedef struct anchor {
    const char *name;
    bough_node *node;
} anchor;

typedef struct open_container {
    bough_node *node;
    int start; // of its children on the stack
} open_container;

typedef struct reader {
    bough_arena *arena, *work; // of the tree; of the reader itself
    bough_errors *errors;
    const char *file;
    const char *text;
    size_t size;
    yaml_parser_t parser;
    yaml_event_t event;           // the present one
    yaml_mark_t quote, quote_end; // of the last quoted text
    char *pool; // small objects are cut from blocks: the arena's smallest block has 128 bytes
    size_t pool_left, pool_size;
    bough_node **stack; // (stack_capacity)
    int n_stack, stack_capacity;
    open_container open[MAX_DEPTH];
    int depth;
    anchor anchors[MAX_ANCHORS];
    int n_anchor;
    int n_node;
    int documents;
    bough_node *root;
} reader;

// -- errors ---------------------------------------------------------------------------------------

void bough_errors_add(bough_errors *errors, const bough_node *where, const char *path, const char *format,
                      ...) {
    if (errors->n >= MAX_ERRORS) {
        errors->dropped++;
        return;
    }
    errors->item =
        bough_arena_grow(errors->arena, errors->item, errors->n, &errors->capacity, sizeof *errors->item);
    char text[400];
    BOUGH_PRINT(text, format);
    errors->item[errors->n++] =
        (bough_error){bough_arena_string(errors->arena, where->file), where->line, where->column,
                      bough_arena_string(errors->arena, path), bough_arena_string(errors->arena, text)};
}

// Rank of an error's file: those without a position, the first file, the others.
static int file_rank(const bough_error *e, const char *first) {
    return e->line == 0 ? 0 : strcmp(e->file, first) == 0 ? 1 : 2;
}

static bool comes_before(const bough_error *a, const bough_error *b, const char *first) {
    int rank_a = file_rank(a, first), rank_b = file_rank(b, first);
    if (rank_a != rank_b) return rank_a < rank_b;
    int names = strcmp(a->file, b->file);
    if (names != 0) return names < 0;
    if (a->line != b->line) return a->line < b->line;
    return a->column < b->column;
}

// Removes repeated errors of a value that several places of the tree share.
static void drop_repetitions(bough_errors *errors) {
    int n = 0;
    for (int i = 0; i < errors->n; i++) {
        const bough_error *e = &errors->item[i];
        bool again = false;
        for (int k = n - 1; k >= 0 && !again && e->line > 0; k--) {
            const bough_error *kept = &errors->item[k];
            if (kept->line != e->line || kept->column != e->column || strcmp(kept->file, e->file) != 0) break;
            again = strcmp(kept->text, e->text) == 0;
        }
        if (!again) errors->item[n++] = *e;
    }
    errors->n = n;
}

// Insertion sort: the list is short and errors at one place must keep their order.
void bough_errors_sort(bough_errors *errors, const char *first) {
    for (int i = 1; i < errors->n; i++) {
        bough_error e = errors->item[i];
        int k = i;
        for (; k > 0 && comes_before(&e, &errors->item[k - 1], first); k--) {
            errors->item[k] = errors->item[k - 1];
        }
        errors->item[k] = e;
    }
    drop_repetitions(errors);
}

bough_status bough_errors_status(bough_errors *errors, const char *file, const char *what) {
    bough_errors_sort(errors, file);
    int n = errors->n + errors->dropped;
    if (n == 0) return bough_ok();
    return bough_fail(BOUGH_INVALID, "%s: %d error%s in the %s", file, n, n == 1 ? "" : "s", what);
}

// Control characters of a hostile file must not reach a terminal.
static void print_plain(const char *text, FILE *stream) {
    for (const char *c = text; *c != '\0'; c++) {
        bool control = (unsigned char)*c < 0x20 || *c == 0x7f;
        fputc(control ? '?' : *c, stream);
    }
}

void bough_errors_print(const bough_errors *errors, FILE *stream) {
    for (int i = 0; i < errors->n; i++) {
        const bough_error *e = &errors->item[i];
        print_plain(e->file, stream);
        if (e->line > 0) fprintf(stream, ":%d:%d", e->line, e->column);
        fputs(": error: ", stream);
        print_plain(e->path, stream);
        if (e->path[0] != '\0') fputs(": ", stream);
        print_plain(e->text, stream);
        fputc('\n', stream);
    }
    if (errors->dropped > 0) fprintf(stream, "%d more errors\n", errors->dropped);
}

void bough_errors_report(const bough_errors *errors, bough_status *status) {
    if (errors->n == 0 || status->code != BOUGH_INVALID) return;
    bough_errors_print(errors, stderr);
    status->message[0] = '\0';
}

// -- memory ---------------------------------------------------------------------------------------

static void *take(reader *r, size_t size) {
    size = (size + 15) / 16 * 16;
    if (size > r->pool_size / 8) return bough_arena_take(r->arena, size);
    if (size > r->pool_left) {
        r->pool = bough_arena_take(r->arena, r->pool_size);
        r->pool_left = r->pool_size;
    }
    void *p = r->pool;
    r->pool += size;
    r->pool_left -= size;
    return p;
}

// -- refusals -------------------------------------------------------------------------------------

static bool refuse(reader *r, yaml_mark_t at, const char *text) {
    bough_node where = {.file = r->file, .line = (int)at.line + 1, .column = (int)at.column + 1};
    bough_errors_add(r->errors, &where, "", "%s", text);
    return false;
}

// libyaml's terse messages in words for the writer of a file.
static const char *readable(const char *problem) {
    static const struct {
        const char *problem, *readable;
    } table[] = {
        {"cannot start any token", "unexpected character here (tabs cannot indent; quote text that "
                                   "starts with @, `, % or a bracket)"},
        {"mapping values are not allowed", "unexpected ':' (two keys on one line, or a line that is "
                                           "indented too far)"},
        {"did not find expected key", "expected 'key: value' here (check the indentation)"},
        {"could not find expected ':'", "expected ':' after a key (check the indentation)"},
        {"did not find expected ',' or ']'", "expected ',' or ']' to end the list"},
        {"did not find expected ',' or '}'", "expected ',' or '}' to end the mapping"},
        {"did not find expected '-'", "expected '- ' here (check the indentation of the list)"},
        {"unexpected end of stream", "the text that this quote opens has no end"},
    };
    for (size_t i = 0; i < sizeof table / sizeof table[0]; i++) {
        if (strstr(problem, table[i].problem) != NULL) return table[i].readable;
    }
    return problem;
}

// The decoder knows only the byte's offset.
static yaml_mark_t mark_of_offset(const reader *r, size_t offset) {
    yaml_mark_t at = {.index = offset};
    for (size_t i = 0; i < offset && i < r->size; i++) {
        at.column++;
        if (r->text[i] == '\n') {
            at.line++;
            at.column = 0;
        }
    }
    return at;
}

static bool syntax_error(reader *r) {
    const yaml_parser_t *p = &r->parser;
    if (p->error == YAML_MEMORY_ERROR) bough_arena_leave(r->work);
    if (p->error != YAML_READER_ERROR) {
        bool open = strstr(p->problem, "unexpected end of stream") != NULL;
        // A quote that is not closed takes up the lines down to the next quote.
        if (r->quote_end.line > r->quote.line && r->quote_end.line == p->problem_mark.line)
            refuse(r, r->quote, "the text that this quote opens ends some lines below: is a quote missing?");
        return refuse(r, open ? p->context_mark : p->problem_mark, readable(p->problem));
    }
    bool control = strstr(p->problem, "control") != NULL;
    return refuse(r, mark_of_offset(r, p->problem_offset),
                  control ? "a control character is not allowed" : "this is not UTF-8 text");
}

// -- nodes ----------------------------------------------------------------------------------------

static bough_node *new_node(reader *r, bough_node_kind kind, yaml_mark_t at) {
    if (++r->n_node > MAX_NODES) {
        refuse(r, at, "more than a million values");
        return NULL;
    }
    bough_node *node = take(r, sizeof *node);
    *node = (bough_node){.kind = kind, .file = r->file, .weight = 1};
    node->line = (int)at.line + 1;
    node->column = (int)at.column + 1;
    return node;
}

static bool is_key(const reader *r) {
    if (r->depth == 0) return false;
    const open_container *c = &r->open[r->depth - 1];
    return c->node->kind == BOUGH_MAPPING && (r->n_stack - c->start) % 2 == 0;
}

// Adds a node to the innermost open container, or makes it the root.
static bool attach(reader *r, bough_node *node, yaml_mark_t at) {
    if (is_key(r) && node->kind != BOUGH_SCALAR) {
        return refuse(r, at, "a key must be plain text, not a list or a mapping");
    }
    if (r->depth == 0) {
        r->root = node;
        return true;
    }
    r->stack = bough_arena_grow(r->work, r->stack, r->n_stack, &r->stack_capacity, sizeof *r->stack);
    r->stack[r->n_stack++] = node;
    return true;
}

static bool remember_anchor(reader *r, const yaml_char_t *name, bough_node *node, yaml_mark_t at) {
    if (name == NULL) return true;
    if (r->n_anchor == MAX_ANCHORS) return refuse(r, at, "more than a thousand anchors");
    size_t size = strlen((const char *)name) + 1;
    char *copy = take(r, size);
    memcpy(copy, name, size);
    r->anchors[r->n_anchor++] = (anchor){copy, node};
    return true;
}

static bool add_scalar(reader *r, const yaml_event_t *e) {
    if (e->data.scalar.tag != NULL) return refuse(r, e->start_mark, "tags (!...) are not used here");
    bough_node *node = new_node(r, BOUGH_SCALAR, e->start_mark);
    if (node == NULL) return false;
    size_t length = e->data.scalar.length;
    if (memchr(e->data.scalar.value, '\0', length) != NULL) {
        return refuse(r, e->start_mark, "a control character is not allowed");
    }
    char *text = take(r, length + 1);
    memcpy(text, e->data.scalar.value, length + 1);
    node->text = text;
    node->quoted = e->data.scalar.style != YAML_PLAIN_SCALAR_STYLE;
    if (!node->quoted && is_key(r) && strcmp(text, "<<") == 0)
        return refuse(r, e->start_mark,
                      "merge keys (<<) are not read; 'base: FILE' takes the keys of another scene");
    yaml_scalar_style_t style = e->data.scalar.style;
    if (style == YAML_SINGLE_QUOTED_SCALAR_STYLE || style == YAML_DOUBLE_QUOTED_SCALAR_STYLE) {
        r->quote = e->start_mark;
        r->quote_end = e->end_mark;
    }
    return remember_anchor(r, e->data.scalar.anchor, node, e->start_mark) && attach(r, node, e->start_mark);
}

static bool is_open(const reader *r, const bough_node *node) {
    for (int i = 0; i < r->depth; i++) {
        if (r->open[i].node == node) return true;
    }
    return false;
}

static bool add_alias(reader *r, const yaml_event_t *e) {
    const char *name = (const char *)e->data.alias.anchor;
    bough_node *node = NULL;
    for (int i = r->n_anchor - 1; i >= 0 && node == NULL; i--) {
        if (strcmp(r->anchors[i].name, name) == 0) node = r->anchors[i].node;
    }
    if (node == NULL) return refuse(r, e->start_mark, "this alias has no anchor before it");
    if (is_open(r, node)) return refuse(r, e->start_mark, "this alias contains itself");
    if (r->depth + node->height > MAX_DEPTH) {
        return refuse(r, e->start_mark, "nesting is deeper than 64 levels");
    }
    return attach(r, node, e->start_mark);
}

static bool open_node(reader *r, const yaml_event_t *e, bough_node_kind kind) {
    bool mapping = kind == BOUGH_MAPPING;
    const yaml_char_t *tag = mapping ? e->data.mapping_start.tag : e->data.sequence_start.tag;
    const yaml_char_t *name = mapping ? e->data.mapping_start.anchor : e->data.sequence_start.anchor;
    if (tag != NULL) return refuse(r, e->start_mark, "tags (!...) are not used here");
    if (r->depth == MAX_DEPTH) return refuse(r, e->start_mark, "nesting is deeper than 64 levels");
    bough_node *node = new_node(r, kind, e->start_mark);
    if (node == NULL || !remember_anchor(r, name, node, e->start_mark)) return false;
    if (!attach(r, node, e->start_mark)) return false;
    r->open[r->depth++] = (open_container){node, r->n_stack};
    return true;
}

// Sorts by name, then by place.
static int compare_keys(const void *a, const void *b) {
    const bough_node *x = *(bough_node *const *)a, *y = *(bough_node *const *)b;
    int names = strcmp(x->text, y->text);
    if (names != 0) return names;
    return x->line != y->line ? x->line - y->line : x->column - y->column;
}

// Adds an error for every key given before. Sorted, as a hostile file may hold half a million keys, where the
// mapping's children have just left the stack.
static void check_duplicates(reader *r, const bough_node *mapping) {
    if (mapping->n < 2) return;
    bough_node **sorted = r->stack + r->n_stack;
    memcpy(sorted, mapping->key, (size_t)mapping->n * sizeof *sorted);
    qsort(sorted, (size_t)mapping->n, sizeof *sorted, compare_keys);
    for (int i = 1; i < mapping->n; i++) {
        if (strcmp(sorted[i - 1]->text, sorted[i]->text) == 0) {
            bough_errors_add(r->errors, sorted[i], "", "key '%s' is given twice (first in line %d)",
                             sorted[i]->text, sorted[i - 1]->line);
        }
    }
}

// Moves the children of the container from the stack into it.
static bool take_children(reader *r, bough_node *node, int start) {
    int count = r->n_stack - start, stride = node->kind == BOUGH_MAPPING ? 2 : 1;
    node->n = count / stride;
    if (count == 0) return true;
    bough_node **slots = take(r, (size_t)count * sizeof *slots);
    node->value = slots;
    node->key = stride == 2 ? slots + node->n : NULL;
    for (int i = 0; i < node->n; i++) {
        bough_node *value = r->stack[start + stride * i + stride - 1];
        node->value[i] = value;
        if (stride == 2) node->key[i] = r->stack[start + 2 * i];
        node->weight += value->weight;
        if (value->height > node->height) node->height = value->height;
        if (node->weight > MAX_NODES) {
            bough_errors_add(r->errors, node, "", "aliases expand to more than a million values");
            return false;
        }
    }
    node->height++;
    r->n_stack = start;
    return true;
}

static bool close_node(reader *r) {
    open_container c = r->open[--r->depth];
    if (!take_children(r, c.node, c.start)) return false;
    if (c.node->kind == BOUGH_MAPPING) check_duplicates(r, c.node);
    return true;
}

static bool handle(reader *r, const yaml_event_t *e) {
    switch (e->type) {
    case YAML_DOCUMENT_START_EVENT:
        if (r->documents++ > 0) return refuse(r, e->start_mark, "a file holds one document only");
        return true;
    case YAML_ALIAS_EVENT: return add_alias(r, e);
    case YAML_SCALAR_EVENT: return add_scalar(r, e);
    case YAML_SEQUENCE_START_EVENT: return open_node(r, e, BOUGH_SEQUENCE);
    case YAML_MAPPING_START_EVENT: return open_node(r, e, BOUGH_MAPPING);
    case YAML_SEQUENCE_END_EVENT:
    case YAML_MAPPING_END_EVENT: return close_node(r);
    default: return true;
    }
}

static bool parse_events(reader *r) {
    for (bool more = true; more;) {
        if (!yaml_parser_parse(&r->parser, &r->event)) return syntax_error(r);
        more = r->event.type != YAML_STREAM_END_EVENT;
        bool handled = handle(r, &r->event);
        yaml_event_delete(&r->event);
        if (!handled) return false;
    }
    if (r->root != NULL) return true;
    return refuse(r, (yaml_mark_t){0}, "the file is empty");
}

// -- reading --------------------------------------------------------------------------------------

static void release(void *self) {
    reader *r = self;
    yaml_event_delete(&r->event);
    yaml_parser_delete(&r->parser);
}

bough_node *bough_text_parse(bough_arena *arena, const char *file, const char *text, size_t size,
                             bough_errors *errors) {
    bough_arena *work = bough_arena_child(arena);
    reader *r = bough_arena_take(work, sizeof *r);
    if (!yaml_parser_initialize(&r->parser)) bough_arena_leave(work);
    bough_arena_on_destroy(work, release, r);
    bool bom = size >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0;
    r->arena = arena;
    r->work = work;
    r->errors = errors;
    r->file = bough_arena_string(arena, file);
    r->text = bom ? text + 3 : text;
    r->size = bom ? size - 3 : size;
    r->pool_size = size < POOL_BYTES / 64 ? POOL_BYTES / 64 : POOL_BYTES;
    yaml_parser_set_encoding(&r->parser, YAML_UTF8_ENCODING);
    yaml_parser_set_input_string(&r->parser, (const unsigned char *)r->text, r->size);
    int before = errors->n + errors->dropped;
    bool parsed = parse_events(r) && errors->n + errors->dropped == before;
    bough_node *root = parsed ? r->root : NULL;
    bough_arena_destroy(work);
    return root;
}

bough_node *bough_text_read(bough_arena *arena, const char *path, bough_errors *errors) {
    size_t size = 0;
    bough_arena *work = bough_arena_child(arena);
    char why[BOUGH_INPUT_REASON];
    const char *bytes = bough_input_read(work, path, MAX_BYTES, &size, why);
    if (!bytes) bough_errors_add(errors, &(bough_node){.file = path}, "", "cannot be read: %s", why);
    bough_node *root = bytes ? bough_text_parse(arena, path, bytes, size, errors) : NULL;
    bough_arena_destroy(work);
    return root;
}

const char *bough_node_name(const bough_node *node, int i) {
    if (node->kind == BOUGH_MAPPING) return node->key[i]->text;
    const bough_node *name = bough_node_find(node->value[i], "name");
    return name != NULL && name->kind == BOUGH_SCALAR ? name->text : NULL;
}

int bough_node_index(const bough_node *node, const char *name) {
    for (int i = 0; node != NULL && i < node->n; i++) {
        const char *text = bough_node_name(node, i);
        if (text != NULL && strcmp(text, name) == 0) return i;
    }
    return -1;
}

bough_node *bough_node_find(const bough_node *node, const char *key) {
    int i = node != NULL && node->kind == BOUGH_MAPPING ? bough_node_index(node, key) : -1;
    return i < 0 ? NULL : node->value[i];
}

const bough_node *bough_node_below(const bough_node *node, const char *path, const bough_node **last) {
    char key[64];
    for (size_t n; node != NULL && *path != '\0'; path += n + (path[n] == '.')) {
        n = strcspn(path, ".");
        snprintf(key, sizeof key, "%.*s", (int)n, path);
        if (last != NULL) *last = node;
        node = bough_node_find(node, key);
    }
    if (node != NULL && last != NULL) *last = node;
    return node;
}
