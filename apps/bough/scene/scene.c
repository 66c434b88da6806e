// Reading a scene: text, replacements, tables, links. All errors are collected before it gives up.
#include "apps/bough/scene/scene_internal.h"

#include <string.h>

// The directory of a path, with its slash; "" for the current one.
static const char *directory_of(bough_arena *arena, const char *path) {
    char *copy = bough_arena_string(arena, path);
    char *slash = strrchr(copy, '/');
    copy[slash == NULL ? 0 : slash - copy + 1] = '\0';
    return copy;
}

// Applies every replacement that is good; the others leave an error.
static bough_node *replace(bough_arena *arena, bough_node *root, const char *const *sets, int n_set,
                           bough_errors *errors) {
    for (int i = 0; i < n_set; i++) {
        bough_node *changed = bough_scene_set(arena, root, sets[i], errors);
        if (changed != NULL) root = changed;
    }
    return root;
}

static bough_status finish(const char *path, bough_errors *errors) {
    int n = errors->n + errors->dropped;
    if (n == 0) return bough_ok();
    bough_errors_sort(errors, path);
    return bough_fail(BOUGH_INVALID, "%s: %d error%s in the scene", path, n, n == 1 ? "" : "s");
}

// A study is told as such, in place of an error for each of its keys.
static bool is_study(const char *path, const bough_node *root, bough_errors *errors) {
    const bough_node *kind = bough_node_find(root, "kind");
    if (kind == NULL || bough_node_find(root, "bodies") != NULL) return false;
    bough_errors_add(errors, kind, "kind", "this is a study, not a scene: 'bough study %.200s' runs it",
                     path);
    return true;
}

bough_status bough_scene_read(bough_arena *arena, const char *path, const char *const *sets, int n_set,
                              bough_errors *errors, bough_scene **scene) {
    *scene = NULL;
    bough_scene *s = bough_arena_take(arena, sizeof *s);
    bough_node *root = bough_text_read(arena, path, errors);
    if (root == NULL) return finish(path, errors);
    if (is_study(path, root, errors)) return finish(path, errors);
    root = replace(arena, root, sets, n_set, errors);
    bough_schema_reader reader = {.arena = arena, .errors = errors, .directory = directory_of(arena, path)};
    s->file = bough_arena_string(arena, path);
    bough_schema_read(&reader, &bough_scene_schema, root, s);
    bough_scene_apply_accuracy(s);
    if (s->node != NULL && errors->n == 0) bough_scene_repeat(&reader, s);
    if (s->node != NULL) bough_scene_link(&reader, s);
    s->named = reader.files;
    bough_status status = finish(path, errors);
    if (bough_is_ok(&status)) *scene = s;
    return status;
}

const char *bough_scene_place(const bough_node *value, char *text, size_t size) {
    text[0] = '\0';
    if (value == NULL) return text;
    if (value->line > 0) snprintf(text, size, "%s:%d:%d: ", value->file, value->line, value->column);
    if (value->line == 0) snprintf(text, size, "%s: ", value->file);
    return text;
}

bough_status bough_scene_blame(const bough_node *value, const char *key, bough_status status) {
    char place[300];
    if (status.code != BOUGH_INVALID) return status;
    return bough_fail(status.code, "%s%s: %s", bough_scene_place(value, place, sizeof place), key,
                      status.message);
}

const bough_scene_solver *bough_scene_micro(const bough_scene *scene, const bough_scene_body *body) {
    return body->micro.node != NULL ? &body->micro : &scene->simulation.micro;
}

bool bough_scene_moves(const bough_scene *scene, int body) {
    for (int steps = 0; body >= 0 && steps <= scene->n_body; steps++) {
        if (scene->body[body].joint.kind > BOUGH_JOINT_FIXED) return true;
        body = scene->body[body].joint.parent;
        if (body >= 0 && scene->body[body].fidelity == BOUGH_SCENE_ROD) return true;
    }
    return false;
}
