// Resolves names to indices and checks what spans several parts of the scene. It runs also after errors in
// single parts, so that all errors are shown at once: invalid values are NaN, −1 or NULL here and cause no
// second error.
#include "apps/bough/scene/scene_internal.h"

void bough_link_at(bough_schema_reader *r, const char *format, ...) { BOUGH_PRINT(r->path, format); }

void bough_scene_refuse(bough_schema_reader *r, const bough_node *mapping, const char *keys,
                        const char *format, ...) {
    char key[32], text[300];
    BOUGH_PRINT(text, format);
    for (size_t n; *keys != '\0'; keys += n + (keys[n] == '|')) {
        n = strcspn(keys, "|");
        snprintf(key, sizeof key, "%.*s", (int)n, keys);
        if (bough_node_find(mapping, key) != NULL) bough_schema_error(r, mapping, key, "%s", text);
    }
}

static const char *name_of(const bough_scene_body *b) { return b->name == NULL ? "" : b->name; }

static int compare_names(const void *a, const void *b) {
    const bough_scene_body *x = *(bough_scene_body *const *)a, *y = *(bough_scene_body *const *)b;
    int names = strcmp(name_of(x), name_of(y));
    return names != 0 ? names : (x > y) - (x < y);
}

static void sort_names(bough_schema_reader *r, bough_scene *s) {
    s->by_name = bough_arena_take(r->arena, (size_t)s->n_body * sizeof *s->by_name);
    for (int i = 0; i < s->n_body; i++) s->by_name[i] = &s->body[i];
    qsort(s->by_name, (size_t)s->n_body, sizeof *s->by_name, compare_names);
}

// The first body of that name.
static int find_body(const bough_scene *s, const char *name) {
    int low = 0, high = s->n_body;
    while (low < high) {
        int middle = (low + high) / 2;
        if (strcmp(name_of(s->by_name[middle]), name) < 0)
            low = middle + 1;
        else
            high = middle;
    }
    bool found = low < s->n_body && s->by_name[low]->name != NULL && strcmp(s->by_name[low]->name, name) == 0;
    return found ? (int)(s->by_name[low] - s->body) : BOUGH_UNRESOLVED;
}

// The nearest name of a body; a parent may be the ground.
static bough_suggestion suggest_body(bough_schema_reader *r, const bough_scene *s, const char *key,
                                     const char *name) {
    if (r->errors->dropped > 0) return (bough_suggestion){""}; // a hostile file: spelling costs time
    const char **names = bough_arena_take(r->arena, ((size_t)s->n_body + 1) * sizeof *names);
    for (int i = 0; i < s->n_body; i++) names[i] = s->body[i].name;
    names[s->n_body] = "ground";
    return bough_suggest(name, names, s->n_body + (strcmp(key, "parent") == 0));
}

int bough_link_body(bough_schema_reader *r, const bough_scene *s, const bough_node *node, const char *key,
                    const char *name) {
    if (name == NULL) return BOUGH_UNRESOLVED;
    int index = find_body(s, name);
    if (index != BOUGH_UNRESOLVED) return index;
    bough_schema_error(r, node, key, "there is no body '%.48s'%s", name, suggest_body(r, s, key, name).text);
    return BOUGH_UNRESOLVED;
}

// The same, or the ground, also for a missing name, which is reported elsewhere.
static int link_frame(bough_schema_reader *r, const bough_scene *s, const bough_node *node, const char *key,
                      const char *name) {
    bool ground = name == NULL || strcmp(name, "ground") == 0;
    return ground ? BOUGH_GROUND : bough_link_body(r, s, node, key, name);
}

// -- bodies ---------------------------------------------------------------------------------------

// Names become parts of channels and file names.
static void check_name(bough_schema_reader *r, const bough_scene *s, int i) {
    static const char allowed[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-";
    const bough_scene_body *b = &s->body[i];
    if (b->name == NULL) return;
    char shown[64];
    if (strspn(b->name, allowed) != strlen(b->name)) {
        bough_schema_error(r, b->node, "name", "a name has letters, digits, '_' and '-', got %s",
                           bough_node_shown(bough_node_find(b->node, "name"), shown));
    } else if (strcmp(b->name, "ground") == 0) {
        bough_schema_error(r, b->node, "name", "'ground' cannot be the name of a body");
    } else if (find_body(s, b->name) != i) {
        bough_schema_error(r, b->node, "name", "body '%s' is given twice", b->name);
    }
}

static void link_parent(bough_schema_reader *r, bough_scene *s, int i) {
    bough_scene_joint *joint = &s->body[i].joint;
    joint->parent = BOUGH_UNRESOLVED;
    if (joint->parent_name == NULL) return;
    bough_link_at(r, "bodies[%d].joint", i);
    joint->parent = link_frame(r, s, joint->node, "parent", joint->parent_name);
    if (joint->parent >= 0 && bough_scene_is_flexible(&s->body[joint->parent]) &&
        s->body[joint->parent].fidelity != BOUGH_SCENE_ROD) {
        bool fmu = s->body[joint->parent].fidelity == BOUGH_SCENE_FMU;
        bough_schema_error(r, joint->node, "parent", "'%s' is %s, which cannot carry bodies; %s",
                           joint->parent_name, fmu ? "an FMU" : "a modal body",
                           fmu ? "let the body that carries it carry them" : "make it a rod");
    }
    const bough_scene_body *carrier = joint->parent >= 0 ? &s->body[joint->parent] : NULL;
    if (carrier && carrier->fidelity == BOUGH_SCENE_ROD && carrier->rod.n_segment == 1) {
        bough_link_at(r, "bodies[%d].rod", joint->parent);
        bough_schema_error(r, carrier->rod.node, "segments",
                           "a rod that carries bodies, as '%s', has at least 2 segments, got 1",
                           s->body[i].name);
    }
}

// The first body of the loop of parents that is reached from a body.
static int body_in_loop(const bough_scene *s, int i) {
    for (int k = 0; k < s->n_body; k++) i = s->body[i].joint.parent;
    int lowest = i;
    for (int k = s->body[i].joint.parent; k != i; k = s->body[k].joint.parent) {
        if (k < lowest) lowest = k;
    }
    return lowest;
}

static void report_loop(bough_schema_reader *r, const bough_scene *s, int start) {
    char loop[200];
    int first = body_in_loop(s, start), length = 0;
    for (int k = first, more = 1; more; k = s->body[k].joint.parent) {
        length += snprintf(loop + length, sizeof loop - (size_t)length, "%s -> ", s->body[k].name);
        if (length >= (int)sizeof loop) length = (int)sizeof loop - 1;
        more = s->body[k].joint.parent != first;
    }
    bough_link_at(r, "bodies[%d].joint", first);
    bough_schema_error(r, s->body[first].joint.node, "parent", "parents form a loop: %s%s", loop,
                       s->body[first].name);
}

// Orders parents before children. Bodies that remain hang on a loop or on an unknown parent.
static bool order_bodies(bough_schema_reader *r, bough_scene *s) {
    s->order = bough_arena_take(r->arena, (size_t)s->n_body * sizeof *s->order);
    bool *placed = bough_arena_take(r->arena, (size_t)s->n_body * sizeof *placed);
    int n = 0;
    for (int before = -1; n > before;) {
        before = n;
        for (int i = 0; i < s->n_body; i++) {
            int parent = s->body[i].joint.parent;
            if (placed[i] || parent == BOUGH_UNRESOLVED) continue;
            if (parent >= 0 && !placed[parent]) continue;
            placed[i] = true;
            s->order[n++] = i;
        }
    }
    for (int i = 0; i < s->n_body; i++) {
        int k = i;
        for (int steps = 0; k >= 0 && !placed[k] && steps < s->n_body; steps++) {
            k = s->body[k].joint.parent;
        }
        bool loop = k >= 0 && !placed[k];
        if (loop) report_loop(r, s, i);
        if (loop) break;
        for (k = i; k >= 0 && !placed[k]; k = s->body[k].joint.parent)
            placed[k] = true; // reported or without a loop
    }
    return n == s->n_body;
}

static bool has_mass(const bough_scene_body *b) {
    bool flexible = b->fidelity != BOUGH_SCENE_RIGID && b->fidelity != BOUGH_SCENE_FMU;
    return bough_node_find(b->node, "rod") != NULL || flexible ||
           !(b->mass == 0 && b->inertia[0] == 0 && b->inertia[1] == 0 && b->inertia[2] == 0);
}

// Every joint that moves must carry mass, or its motion is not defined. Needs the order of the bodies.
static void check_moving_mass(bough_schema_reader *r, const bough_scene *s) {
    bool *carries = bough_arena_take(r->arena, (size_t)s->n_body * sizeof *carries);
    for (int k = s->n_body - 1; k >= 0; k--) {
        int i = s->order[k];
        const bough_scene_body *b = &s->body[i];
        carries[i] = carries[i] || has_mass(b);
        if (carries[i] && b->joint.parent >= 0) carries[b->joint.parent] = true;
        bool driven = b->joint.motion[0].node != NULL;
        if (carries[i] || driven || b->joint.kind < 0 || b->joint.kind == BOUGH_JOINT_FIXED) continue;
        bough_link_at(r, "bodies[%d]", i);
        bough_schema_error(r, b->node, "",
                           "a joint that moves must carry mass: give 'mass' here or "
                           "to a body that hangs on this one");
    }
}

static void link_bodies(bough_schema_reader *r, bough_scene *s) {
    for (int i = 0; i < s->n_body; i++) {
        bough_link_at(r, "bodies[%d]", i);
        check_name(r, s, i);
        link_parent(r, s, i);
    }
    if (order_bodies(r, s)) check_moving_mass(r, s);
}

// -- loads and turbine ----------------------------------------------------------------------------

static void link_joint_load(bough_schema_reader *r, const bough_scene *s, bough_scene_load *load) {
    load->joint = bough_link_body(r, s, load->node, "joint", load->joint_name);
    if (load->joint < 0) return;
    int kind = s->body[load->joint].joint.kind;
    if (kind < 0) return;
    bool revolute = kind == BOUGH_JOINT_REVOLUTE;
    if (!revolute && kind != BOUGH_JOINT_PRISMATIC) {
        bough_schema_error(r, load->node, "joint",
                           "the joint of '%s' must be revolute or prismatic to take a load",
                           load->joint_name);
        return;
    }
    bough_scene_refuse(r, load->node, revolute ? "force" : "torque", "the joint of '%s' is %s: give a %s",
                       load->joint_name, revolute ? "revolute" : "prismatic", revolute ? "torque" : "force");
}

static void link_load(bough_schema_reader *r, const bough_scene *s, void *item) {
    bough_scene_load *load = item;
    load->joint = load->body = BOUGH_UNRESOLVED;
    if (load->body_name != NULL) {
        load->body = bough_link_body(r, s, load->node, "body", load->body_name);
        if (load->body >= 0) bough_scene_check_body_load(r, s, load);
    } else {
        link_joint_load(r, s, load);
    }
}

static void link_connector(bough_schema_reader *r, const bough_scene *s, void *item) {
    static const char *const keys[] = {"from", "to"};
    bough_scene_connector *c = item;
    for (int end = 0; end < 2; end++) {
        c->body[end] = link_frame(r, s, c->node, keys[end], c->body_name[end]);
        if (c->body[end] < 0 || !bough_scene_is_flexible(&s->body[c->body[end]])) continue;
        bough_schema_error(r, c->node, keys[end],
                           "'%s' must be a rigid body; it may hang on a rod and needs no mass",
                           c->body_name[end]);
    }
    if (c->body_name[0] != NULL && c->body_name[1] != NULL && strcmp(c->body_name[0], c->body_name[1]) == 0) {
        bough_schema_error(r, c->node, "to", "must be another body");
    }
    c->holds = c->spring.stiffness > 0;
    for (int k = 0; k < 6; k++) c->holds = c->holds || c->bushing.stiffness[k] > 0;
}

// The joints of the tree by the kinds of a closure.
static const int closure_kinds[] = {BOUGH_JOINT_FIXED,     BOUGH_JOINT_REVOLUTE,    BOUGH_JOINT_PRISMATIC,
                                    BOUGH_JOINT_SPHERICAL, BOUGH_JOINT_CYLINDRICAL, BOUGH_JOINT_UNIVERSAL,
                                    BOUGH_JOINT_PLANAR};

static void link_closure(bough_schema_reader *r, const bough_scene *s, void *item) {
    bough_scene_connector *c = item;
    link_connector(r, s, c);
    c->holds = true;
    if (c->kind >= 0) c->kind = closure_kinds[c->kind];
}

static void link_marker(bough_schema_reader *r, const bough_scene *s, void *item) {
    bough_scene_marker *marker = item;
    marker->body = link_frame(r, s, marker->node, "body", marker->body_name);
    if (marker->body < 0 || !bough_scene_is_flexible(&s->body[marker->body])) return;
    bough_schema_error(r, marker->node, "body",
                       s->body[marker->body].fidelity == BOUGH_SCENE_FMU
                           ? "'%s' is an FMU: name the body that carries it"
                           : "'%s' is a rod, whose tip is recorded",
                       marker->body_name);
}

static bool is_sensed_before(const bough_scene *s, const bough_scene_sensor *sensor) {
    for (const bough_scene_sensor *x = s->sensor; x < sensor; x++) {
        if (x->node != NULL && x->body == sensor->body) return true;
    }
    return false;
}

static void link_sensor(bough_schema_reader *r, const bough_scene *s, void *item) {
    bough_scene_sensor *sensor = item;
    sensor->body = bough_link_body(r, s, sensor->node, "body", sensor->body_name);
    if (sensor->body < 0) return;
    const bough_scene_body *body = &s->body[sensor->body];
    if (body->fidelity != BOUGH_SCENE_ROD) {
        bough_schema_error(r, sensor->node, "body", "'%s' is not of fidelity rod", body->name);
    } else if (is_sensed_before(s, sensor)) {
        bough_schema_error(r, sensor->node, "body",
                           "'%s' already has a sensor: give all places in that "
                           "sensor",
                           body->name);
    }
    double length = body->rod.structure.length;
    for (int k = 0; k < sensor->n_at && length > 0; k++) {
        if (!(sensor->at[k] > length * (1 + 1e-9))) continue; // NaN: refused before
        bough_schema_error(r, sensor->node, "at", "%.9g m is beyond the end of '%s', at %.9g m",
                           sensor->at[k], body->name, length);
    }
}

// -- modes ----------------------------------------------------------------------------------------

static void link_modes(bough_schema_reader *r, bough_scene *s) {
    bough_scene_modes *m = &s->modes;
    m->about = BOUGH_UNRESOLVED;
    if (m->node == NULL) return;
    bough_link_at(r, "modes");
    bool axis = bough_node_find(m->node, "axis") != NULL;
    if (m->of == BOUGH_SCENE_MODES_SCENE)
        bough_scene_refuse(r, m->node, "speed", "only used with 'of: rods'");
    if (m->about_name != NULL) {
        m->about = bough_link_body(r, s, m->node, "about", m->about_name);
        if (m->about >= 0 && s->body[m->about].joint.kind >= 0 &&
            s->body[m->about].joint.kind != BOUGH_JOINT_REVOLUTE) {
            bough_schema_error(r, m->node, "about", "the joint of '%s' must be revolute", m->about_name);
        }
        bough_scene_refuse(r, m->node, "axis", "only used without 'about'");
    }
    if (axis && m->axis[0] == 0 && m->axis[1] == 0 && m->axis[2] == 0) {
        bough_schema_error(r, m->node, "axis", "must not be zero");
    }
    if (!axis) bough_scene_refuse(r, m->node, "centre", "only used with 'axis'");
}

// -- times ----------------------------------------------------------------------------------------

static const double most_steps = 1e9; // macro steps of a run: hours of computation

bool bough_scene_is_multiple(double time, double step) {
    if (!(time > 0) || !(step > 0)) return true;
    double count = time / step;
    return count > 0.5 && fabs(count - round(count)) <= 1e-9 * count;
}

static void check_multiple(bough_schema_reader *r, const bough_scene *s, const char *key, const char *what,
                           double time) {
    double step = s->simulation.macro_step;
    if (bough_scene_is_multiple(time, step)) return;
    bough_schema_error(r, s->node, key, "%s%g s is not a multiple of the macro step, %g s", what, time, step);
}

static void check_times(bough_schema_reader *r, bough_scene *s) {
    const bough_scene_simulation *x = &s->simulation;
    double step = x->macro_step;
    if (bough_node_find(x->output.node, "interval") == NULL) s->simulation.output.interval = step;
    check_multiple(r, s, "simulation.duration", "", x->duration);
    check_multiple(r, s, "simulation.output.interval", "", x->output.interval);
    if (s->control.node) check_multiple(r, s, "control.rate", "its period ", 1 / s->control.rate);
    if (s->aero.node && s->aero.rate > 0) check_multiple(r, s, "aero.rate", "its period ", 1 / s->aero.rate);
    if (x->duration > most_steps * step) {
        bough_schema_error(r, s->node, "simulation.duration",
                           "%g s are %.3g macro steps of %g s; at most %.3g are taken", x->duration,
                           x->duration / step, step, most_steps);
    }
    // shapes are stored at ends of macro steps
    if (x->output.frames > 0 && x->output.frames < (1 - 1e-9) * step) {
        bough_schema_error(r, s->node, "simulation.output.frames", "%g s is less than the macro step, %g s",
                           x->output.frames, step);
    }
}

#define LIST(what, items, count, link)                                                                       \
    what, offsetof(bough_scene, items), offsetof(bough_scene, count), sizeof *((bough_scene *)0)->items, link
#define CONNECTORS(what, KIND, link)                                                                         \
    LIST(what, connector[BOUGH_SCENE_##KIND], n_connector[BOUGH_SCENE_##KIND], link)
static const struct {
    const char *name;
    size_t items, count, size; // place of the pointer and of the number of items, size of one
    void (*link)(bough_schema_reader *r, const bough_scene *s, void *item);
    const char *one; // how messages call an item of a list with names
    size_t own_name; // place of its name
} lists[] = {
    {LIST("bodies", body, n_body, NULL), "body", offsetof(bough_scene_body, name)},
    {LIST("loads", load, n_load, link_load), NULL, 0},
    {LIST("markers", marker, n_marker, link_marker), "marker", offsetof(bough_scene_marker, name)},
    {LIST("sensors", sensor, n_sensor, link_sensor), NULL, 0},
    {CONNECTORS("bushings", BUSHING, link_connector), "bushing", offsetof(bough_scene_connector, name)},
    {CONNECTORS("springs", SPRING, link_connector), "spring", offsetof(bough_scene_connector, name)},
    {CONNECTORS("closures", CLOSURE, link_closure), "closure", offsetof(bough_scene_connector, name)},
};

static void link_lists(bough_schema_reader *r, bough_scene *s) {
    for (size_t k = 0; k < sizeof lists / sizeof *lists; k++) {
        char *items = *(char **)(void *)((char *)s + lists[k].items);
        int count = lists[k].link ? *(int *)(void *)((char *)s + lists[k].count) : 0;
        for (int i = 0; i < count; i++) {
            void *item = items + (size_t)i * lists[k].size;
            bough_link_at(r, "%s[%d]", lists[k].name, i);
            if (*(const bough_node **)item != NULL) lists[k].link(r, s, item);
        }
    }
}

// Whether a message is about this item, or about a channel whose name begins with the item's.
static bool is_about(const char *message, const char *one, const char *name) {
    static const char named[] = "channels are named '";
    char quoted[200];
    const char *channel = strstr(message, named);
    channel = channel ? channel + strlen(named) : message + (message[0] == '\'');
    snprintf(quoted, sizeof quoted, "%s '%.160s'", one, name);
    return strstr(message, quoted) || (channel > message && strncmp(channel, name, strlen(name)) == 0);
}

bough_status bough_scene_blame_named(const bough_scene *s, bough_status status) {
    const bough_node *place = NULL;
    char key[200];
    size_t longest = 0;
    for (size_t k = 0; k < sizeof lists / sizeof *lists && status.code == BOUGH_INVALID; k++) {
        const char *item = *(char *const *)(const void *)((const char *)s + lists[k].items);
        int count = lists[k].one ? *(const int *)(const void *)((const char *)s + lists[k].count) : 0;
        for (int i = 0; i < count; i++, item += lists[k].size) {
            const char *name = *(const char *const *)(const void *)(item + lists[k].own_name);
            if (strlen(name) < longest || !is_about(status.message, lists[k].one, name)) continue;
            longest = strlen(name);
            place = *(const bough_node *const *)(const void *)item;
            snprintf(key, sizeof key, "%s[%.160s]", lists[k].name, name);
        }
    }
    return place ? bough_scene_blame(place, key, status) : status;
}

void bough_scene_link(bough_schema_reader *r, bough_scene *scene) {
    sort_names(r, scene);
    check_times(r, scene);
    link_bodies(r, scene);
    link_lists(r, scene);
    bough_link_fmus(r, scene);
    bough_link_turbine(r, scene);
    bough_link_aero(r, scene);
    bough_link_control(r, scene);
    if (r->errors->n == 0) bough_link_inputs(r, scene);
    link_modes(r, scene);
    bough_link_at(r, "%s", "");
}
