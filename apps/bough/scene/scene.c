// Reading a scene: text, replacements, tables, links. All errors are collected before it gives up.
#include "apps/bough/config/base.h"
#include "apps/bough/scene/scene_internal.h"

// -- bodies ---------------------------------------------------------------------------------------

bool bough_scene_carries(const bough_scene *s, int carrier, int body) {
    for (int steps = 0; body >= 0 && steps <= s->n_body; steps++) {
        if (body == carrier) return true;
        body = s->body[body].joint.parent;
    }
    return false;
}

int bough_scene_carried_by(const bough_scene *s, int body) {
    for (int i = 0; i < s->n_body; i++) {
        if (s->body[i].joint.parent == body) return i;
    }
    return -1;
}

int bough_scene_blade(const bough_scene *s, int body) {
    int k = s->turbine.blade ? s->turbine.n_blade - 1 : -1;
    while (k >= 0 && s->turbine.blade[k] != body) k--;
    return k;
}

// -- chains of bodies -----------------------------------------------------------------------------

// A body with `repeat: n` becomes n bodies, each carried by the previous one on the same joint, with names
// that end with numbers from 1. The first stays where it is in the list, the others come last, so that the
// bodies of the text keep their index.

enum { MOST_BODIES = 10000, MOST_SEGMENTS = 1000000 };

// Number of bodies with all repetitions; 0 after an error: a few lines of text must not exhaust the memory.
static size_t count_bodies(bough_schema_reader *r, const bough_scene *s) {
    size_t bodies = 0, segments = 0;
    for (int i = 0; i < s->n_body; i++) {
        bodies += (size_t)s->body[i].repeat;
        if (s->body[i].rod.node == NULL) continue;
        segments += (size_t)s->body[i].repeat * (size_t)s->body[i].rod.n_segment;
    }
    if (bodies > MOST_BODIES || segments > MOST_SEGMENTS) {
        bough_schema_error(r, s->node, "bodies",
                           "expected at most %d bodies and %d segments of "
                           "rods in all, got %zu and %zu",
                           MOST_BODIES, MOST_SEGMENTS, bodies, segments);
        return 0;
    }
    return bodies;
}

static void scene_repeat(bough_schema_reader *r, bough_scene *s) {
    bough_arena *arena = r->arena;
    int n = s->n_body, next = n;
    size_t total = count_bodies(r, s);
    if (total == 0) return;
    bough_scene_body *body = bough_arena_take(arena, total * sizeof *body);
    memcpy(body, s->body, (size_t)n * sizeof *body);
    for (int i = 0; i < n; i++) {
        if (bough_node_find(body[i].node, "repeat") == NULL) continue;
        const char *name = body[i].name, *before;
        before = body[i].name = bough_arena_print(arena, "%.140s1", name);
        for (int k = 2; k <= body[i].repeat; k++, next++) {
            body[next] = body[i];
            body[next].joint.parent_name = before;
            before = body[next].name = bough_arena_print(arena, "%.140s%d", name, k);
        }
    }
    s->body = body;
    s->n_body = next;
}

// -- reading --------------------------------------------------------------------------------------

static bool begins(const char *text, const char *with) { return strncmp(text, with, strlen(with)) == 0; }

// Whether a replacement changes a turbine in one block, not the names of its bodies.
static bool is_of_block(const char *set) {
    static const char *const names[] = {"turbine.rotor", "turbine.blades[", "turbine.blades=["};
    bool of_names = false;
    for (int i = 0; i < 3; i++) of_names = of_names || begins(set, names[i]);
    return (begins(set, "turbine.") || begins(set, "turbine=")) && !of_names;
}

// Applies the replacements in the turbine's block, or all others; each invalid one leaves an error.
static bough_node *replace(bough_arena *arena, bough_node *root, const char *const *sets, int n_set,
                           bool of_block, bough_errors *errors) {
    for (int i = 0; i < n_set; i++) {
        if (is_of_block(sets[i]) != of_block) continue;
        bough_node *changed = bough_scene_set(arena, root, sets[i], errors);
        if (changed != NULL) root = changed;
    }
    return root;
}

// A study that is read as a scene gives one error, not one for each of its keys.
static bool is_study(const char *path, const bough_node *root, bough_errors *errors) {
    const bough_node *kind = bough_node_find(root, "kind");
    if (kind == NULL || bough_node_find(root, "bodies") != NULL) return false;
    bough_errors_add(errors, kind, "kind", "this is a study, not a scene: 'bough study %.200s' runs it",
                     path);
    return true;
}

bough_status bough_scene_read(bough_arena *arena, bough_schema_shared *shared, const char *path,
                              const char *const *sets, int n_set, bough_errors *errors, bough_scene **scene) {
    *scene = NULL;
    bough_scene *s = bough_arena_take(arena, sizeof *s);
    bough_schema_base *bases;
    bough_node *root = bough_base_read(arena, path, errors, &bases);
    if (root == NULL || is_study(path, root, errors)) return bough_errors_status(errors, path, "scene");
    const char *directory = bough_directory_of(arena, path);
    bough_schema_reader reader = {
        .arena = arena, .errors = errors, .directory = directory, .bases = bases, .shared = shared};
    root = bough_scene_expand(&reader, replace(arena, root, sets, n_set, true, errors));
    if (root == NULL) return bough_errors_status(errors, path, "scene");
    root = replace(arena, root, sets, n_set, false, errors);
    for (const bough_schema_base *base = bases; base != NULL; base = base->next)
        bough_schema_add_file(&reader, "base", base->path, base->absolute);
    s->file = bough_arena_string(arena, path);
    bough_schema_read(&reader, &bough_scene_schema, root, s);
    if (root->kind == BOUGH_MAPPING && bough_node_find(root, "bodies") == NULL)
        bough_schema_error(&reader, root, "", "required key 'bodies' is missing");
    bough_scene_apply_accuracy(s);
    if (s->node != NULL && errors->n == 0) scene_repeat(&reader, s);
    if (s->node != NULL) bough_scene_link(&reader, s);
    s->named = reader.files;
    s->bases = bases;
    bough_status status = bough_errors_status(errors, path, "scene");
    if (bough_is_ok(&status)) *scene = s;
    return status;
}

bough_scene *bough_scene_copy(bough_arena *arena, const bough_scene *scene) {
    bough_scene *copy = bough_arena_copy(arena, scene, sizeof *scene);
    copy->body = bough_arena_copy(arena, scene->body, (size_t)scene->n_body * sizeof *scene->body);
    return copy;
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
        if (scene->body[body].joint.kind != BOUGH_JOINT_FIXED) return true;
        body = scene->body[body].joint.parent;
        if (body >= 0 && scene->body[body].fidelity == BOUGH_SCENE_ROD) return true;
    }
    return false;
}
