// Replacements from the command line: "bodies[2].pitch=5 deg". They change the tree of the text
// before it is read, so that they are checked like everything else.
#include "apps/bough/config/base.h"
#include "apps/bough/scene/scene_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

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

// Nodes of the command line have no line.
static void forget_position(bough_node *node) {
    node->file = origin;
    node->line = node->column = 0;
    for (int i = 0; i < node->n; i++) {
        if (node->key != NULL) forget_position(node->key[i]);
        forget_position(node->value[i]);
    }
}

static bough_node *parse_value(replacement *s, const char *text) {
    int before = s->errors->n;
    bough_node *value = bough_text_parse(s->arena, origin, text, strlen(text), s->errors);
    for (int i = before; i < s->errors->n; i++) {
        bough_error *e = &s->errors->item[i];
        e->line = e->column = 0;
        e->path = bough_arena_string(s->arena, s->path);
    }
    if (value != NULL) forget_position(value);
    return value;
}

// A copy of a container with room for one value more.
static bough_node *copy_container(const replacement *s, const bough_node *node) {
    bough_node *copy = bough_arena_take(s->arena, sizeof *copy);
    size_t room = (size_t)node->n + 1;
    bough_node **slots = bough_arena_take(s->arena, 2 * room * sizeof *slots);
    *copy = *node;
    copy->value = slots;
    copy->key = node->kind == BOUGH_MAPPING ? slots + room : NULL;
    for (int i = 0; i < node->n; i++) {
        copy->value[i] = node->value[i];
        if (copy->key != NULL) copy->key[i] = node->key[i];
    }
    return copy;
}

static bough_node *new_node(const replacement *s, bough_node_kind kind, const char *text) {
    bough_node *node = bough_arena_take(s->arena, sizeof *node);
    *node = (bough_node){.kind = kind, .text = text, .file = origin};
    return node;
}

static bough_node *put(const replacement *s, const bough_node *node, const char *rest, int depth);

// The index of the item whose key 'name' is the word in brackets; −1 if there is none.
static int named_item(const bough_node *node, const char *rest, char **end) {
    size_t length = strcspn(rest + 1, "]");
    *end = (char *)rest + 1 + length;
    for (int i = 0; node != NULL && node->kind == BOUGH_SEQUENCE && i < node->n; i++) {
        const bough_node *name = bough_node_find(node->value[i], "name");
        bool plain = name != NULL && name->kind == BOUGH_SCALAR && strlen(name->text) == length;
        if (plain && strncmp(name->text, rest + 1, length) == 0) return i;
    }
    return -1;
}

// The name in a list that is nearest to a misspelt one.
static bough_suggestion suggest_item(const replacement *s, const bough_node *node, const char *name) {
    if (node == NULL || node->kind != BOUGH_SEQUENCE) return (bough_suggestion){""};
    const char **names = bough_arena_take(s->arena, (size_t)node->n * sizeof *names);
    for (int i = 0; i < node->n; i++) {
        const bough_node *given = bough_node_find(node->value[i], "name");
        names[i] = given && given->kind == BOUGH_SCALAR ? given->text : NULL;
    }
    return bough_suggest(name, names, node->n);
}

// The container without the value at index i.
static void remove_value(bough_node *copy, int i) {
    copy->n--;
    for (; i < copy->n; i++) {
        copy->value[i] = copy->value[i + 1];
        if (copy->key != NULL) copy->key[i] = copy->key[i + 1];
    }
}

// Whether the rest of the path ends here and the value is null, which removes what is there.
static bool removes(const replacement *s, const char *rest) {
    return *rest == '\0' && bough_node_is_null(s->value);
}

// "[2]…" or "[blade1]…": an item that exists; "[2-4]…": several.
static bough_node *put_item(const replacement *s, const bough_node *node, const char *rest, int depth) {
    char *end, text[200];
    int named = named_item(node, rest, &end);
    bool is_name = rest[1] != ']' && (rest[1] < '0' || rest[1] > '9') && *end == ']';
    if (is_name && named < 0) {
        char name[61];
        snprintf(name, sizeof name, "%.*s", (int)fmin(60, (double)(end - rest - 1)), rest + 1);
        snprintf(text, sizeof text, "there is no item with 'name: %s' in that list%s", name,
                 suggest_item(s, node, name).text);
        return refuse(s, text);
    }
    long index = named >= 0                         ? named
                 : rest[1] >= '0' && rest[1] <= '9' ? strtol(rest + 1, &end, 10)
                                                    : -1,
         last = index;
    if (named < 0 && index >= 0 && *end == '-' && end[1] >= '0' && end[1] <= '9') {
        last = strtol(end + 1, &end, 10);
    }
    if (index < 0 || *end != ']' || last < index) {
        return refuse(s, "expected an index such as [0] or [0-2], or a name as [blade1]");
    }
    if (node == NULL || node->kind != BOUGH_SEQUENCE) {
        return refuse(s, "this key has no list, so it takes no index");
    }
    if (last >= node->n) {
        if (node->n == 0) return refuse(s, "the list has no items");
        snprintf(text, sizeof text, "index [%ld] is beyond the last, [%d]", last, node->n - 1);
        return refuse(s, text);
    }
    bough_node *copy = copy_container(s, node);
    for (; removes(s, end + 1) && index <= last; last--) remove_value(copy, (int)index);
    for (; index <= last; index++) {
        copy->value[index] = put(s, node->value[index], end + 1, depth + 1);
        if (copy->value[index] == NULL) return NULL;
    }
    return copy;
}

// "key…": replaced or added, or removed by null; `node` NULL makes a new mapping.
static bough_node *put_key(const replacement *s, const bough_node *node, const char *rest, int depth) {
    size_t length = strcspn(rest, ".[");
    char name[PATH], text[PATH + 80], shown[64];
    if (length == 0) return refuse(s, "expected a key");
    snprintf(name, sizeof name, "%.*s", (int)length, rest);
    if (node != NULL && node->kind != BOUGH_MAPPING) {
        snprintf(text, sizeof text, "key '%s' is looked for in %s", name, bough_node_shown(node, shown));
        return refuse(s, text);
    }
    bough_node empty = {.kind = BOUGH_MAPPING, .file = origin};
    bough_node *copy = copy_container(s, node == NULL ? &empty : node);
    int i = 0;
    while (i < copy->n && strcmp(copy->key[i]->text, name) != 0) i++;
    if (removes(s, rest + length)) {
        if (i < copy->n) remove_value(copy, i);
        return copy;
    }
    bough_node *value = put(s, i < copy->n ? copy->value[i] : NULL, rest + length, depth + 1);
    bough_node *key = new_node(s, BOUGH_SCALAR, bough_arena_string(s->arena, name));
    if (value == NULL) return NULL;
    copy->key[i] = key;
    copy->value[i] = value;
    if (i == copy->n) copy->n++;
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
    if (equals[1 + strspn(equals + 1, " ")] == '\0') return refuse(&s, "expected a value after '='");
    s.value = parse_value(&s, equals + 1);
    return s.value == NULL ? NULL : put(&s, root, s.path, 0);
}
