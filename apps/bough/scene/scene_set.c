// Replacements from the command line: "bodies[2].pitch=5 deg". They change the tree of the text before the
// scene is read, so that they are checked as the text is.
#include "apps/bough/config/base.h"
#include "apps/bough/scene/scene_internal.h"

enum { PATH = 200, MAX_STEPS = 32 };

static const char origin[] = "--set"; // in place of a file's name

typedef struct replacement {
    bough_arena *arena;
    bough_errors *errors;
    char path[PATH]; // as given
    bough_node *value;
} replacement;

static bough_node *refuse(const replacement *s, const char *text) {
    bough_node where = {.file = origin};
    bough_errors_add(s->errors, &where, s->path, "%s", text);
    return NULL;
}

static bough_node *parse_value(replacement *s, const char *text) {
    int before = s->errors->n;
    bough_node *value = bough_text_parse(s->arena, origin, text, strlen(text), s->errors);
    for (int i = before; i < s->errors->n; i++) {
        bough_error *e = &s->errors->item[i];
        e->line = e->column = 0;
        e->path = bough_arena_string(s->arena, s->path);
    }
    if (value != NULL) bough_node_move(value, &(bough_node){.file = origin}); // without a line
    return value;
}

// A copy of a container with room for one value more.
static bough_node *copy_container(const replacement *s, const bough_node *node) {
    bough_node *copy = bough_node_start(s->arena, node, node->n + 1);
    for (int i = 0; i < node->n; i++)
        bough_node_append(copy, node->key ? node->key[i] : NULL, node->value[i]);
    return copy;
}

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

static bough_node *put(const replacement *s, const bough_node *node, const char *rest, int depth);

// The container without the value at index i.
static void remove_value(bough_node *copy, int i) {
    copy->n--;
    for (; i < copy->n; i++) {
        copy->value[i] = copy->value[i + 1];
        if (copy->key != NULL) copy->key[i] = copy->key[i + 1];
    }
}

// Whether the path ends here and the value is null, which removes the item.
static bool removes(const replacement *s, const char *rest) {
    return *rest == '\0' && bough_node_is_null(s->value);
}

// "[2]…" or "[blade1]…": an item that exists; "[2-4]…": several.
static bough_node *put_item(const replacement *s, const bough_node *node, const char *rest, int depth) {
    size_t length = strcspn(rest + 1, "]");
    char *inside = bough_arena_print(s->arena, "%.*s", (int)length, rest + 1), *end = inside;
    bool list = node != NULL && node->kind == BOUGH_SEQUENCE, number = is_digit(inside[0]);
    rest += 1 + length;
    long index = list ? bough_node_index(node, inside) : -1, last = index;
    if (index < 0 && !number && length > 0 && *rest == ']') {
        bough_suggestion near = {""};
        if (list) near = bough_node_suggest(s->arena, node, inside);
        return refuse(s, bough_arena_print(s->arena, "there is no item with 'name: %.60s' in that list%s",
                                           inside, near.text));
    }
    if (index < 0 && number) {
        last = index = strtol(inside, &end, 10);
        if (end[0] == '-' && is_digit(end[1])) last = strtol(end + 1, &end, 10);
        if (*end != '\0') index = -1;
    }
    if (index < 0 || *rest != ']' || last < index) {
        return refuse(s, "expected an index such as [0] or [0-2], or a name as [blade1]");
    }
    if (!list) return refuse(s, "this key has no list, so it takes no index");
    if (last >= node->n) {
        if (node->n == 0) return refuse(s, "the list has no items");
        return refuse(s,
                      bough_arena_print(s->arena, "index [%ld] is beyond the last, [%d]", last, node->n - 1));
    }
    bough_node *copy = copy_container(s, node);
    for (; removes(s, rest + 1) && index <= last; last--) remove_value(copy, (int)index);
    for (; index <= last; index++) {
        copy->value[index] = put(s, node->value[index], rest + 1, depth + 1);
        if (copy->value[index] == NULL) return NULL;
    }
    return copy;
}

// "key…": replaced or added, or removed by null; `node` NULL makes a new mapping.
static bough_node *put_key(const replacement *s, const bough_node *node, const char *rest, int depth) {
    size_t length = strcspn(rest, ".[");
    char *name = bough_arena_print(s->arena, "%.*s", (int)length, rest), shown[64];
    if (length == 0) return refuse(s, "expected a key");
    if (node != NULL && node->kind != BOUGH_MAPPING) {
        return refuse(s, bough_arena_print(s->arena, "key '%s' is looked for in %s", name,
                                           bough_node_shown(node, shown)));
    }
    bough_node empty = {.kind = BOUGH_MAPPING, .file = origin};
    bough_node *copy = copy_container(s, node == NULL ? &empty : node);
    int i = bough_node_index(copy, name);
    if (removes(s, rest + length)) {
        if (i >= 0) remove_value(copy, i);
        return copy;
    }
    bough_node *value = put(s, i >= 0 ? copy->value[i] : NULL, rest + length, depth + 1);
    if (value == NULL) return NULL;
    bough_node *key = bough_arena_take(s->arena, sizeof *key);
    *key = (bough_node){.kind = BOUGH_SCALAR, .text = name, .file = origin};
    if (i >= 0) {
        copy->key[i] = key;
        copy->value[i] = value;
    } else {
        bough_node_append(copy, key, value);
    }
    return copy;
}

// The replacement of `node` (NULL: there is none yet), below which the rest of the path leads to the value.
static bough_node *put(const replacement *s, const bough_node *node, const char *rest, int depth) {
    if (*rest == '\0') return s->value;
    if (depth > MAX_STEPS) return refuse(s, "the path is too deep");
    if (*rest == '[') return put_item(s, node, rest, depth);
    if (*rest == '.' && depth > 0) return put_key(s, node, rest + 1, depth);
    return depth == 0 ? put_key(s, node, rest, depth) : refuse(s, "expected '.' or '['");
}

bough_node *bough_scene_set(bough_arena *arena, bough_node *root, const char *set, bough_errors *errors) {
    replacement s = {.arena = arena, .errors = errors};
    const char *equals = strchr(set, '=');
    size_t length = equals == NULL ? 0 : (size_t)(equals - set);
    if (length == 0 || length >= PATH) {
        snprintf(s.path, sizeof s.path, "%.40s", set);
        return refuse(&s, length == 0 ? "expected KEY=VALUE" : "the path is too long");
    }
    memcpy(s.path, set, length);
    if (strcmp(s.path, "base") == 0) return refuse(&s, "bases are read before: name the file in the scene");
    if (equals[1 + strspn(equals + 1, " ")] == '\0') return refuse(&s, "expected a value after '='");
    s.value = parse_value(&s, equals + 1);
    return s.value == NULL ? NULL : put(&s, root, s.path, 0);
}
