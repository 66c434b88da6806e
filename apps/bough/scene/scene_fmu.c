// FMUs as bodies and as controllers: finds their variables and refuses what they cannot be used with.
#include "apps/bough/scene/scene_internal.h"

// -- one FMU --------------------------------------------------------------------------------------

static const char *const usual_motion[BOUGH_SCENE_MOTION] = {"vx", "vy", "vz", "wx", "wy",
                                                             "wz", "gx", "gy", "gz"};
static const char *const usual_wrench[BOUGH_SCENE_WRENCH] = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};

static void unknown(bough_schema_reader *r, const bough_fmu_description *d, const bough_node *node,
                    const char *key, const char *name) {
    const char **names = bough_arena_take(r->arena, (size_t)d->n_variable * sizeof *names);
    for (int k = 0; k < d->n_variable; k++) names[k] = d->variable[k].name;
    bough_schema_error(r, node, key, "the FMU has no variable '%.60s' of type Float64%s", name,
                       bough_suggest(name, names, d->n_variable).text);
}

// The variable of that name; NULL for "none" and after an error.
static const bough_fmu_variable *find(bough_schema_reader *r, const bough_scene_fmu_model *fmu,
                                      const bough_node *node, const char *key, const char *name,
                                      bough_fmu_causality causality) {
    static const char *const kinds[] = {
        [BOUGH_FMU_INPUT] = "input", [BOUGH_FMU_OUTPUT] = "output", [BOUGH_FMU_PARAMETER] = "parameter"};
    const bough_fmu_description *d = &fmu->description;
    if (!name || strcmp(name, "none") == 0) return NULL;
    const bough_fmu_variable *v = bough_fmu_find(d, name);
    if (!v) {
        unknown(r, d, node, key, name);
    } else if (v->causality != causality) {
        bough_schema_error(r, node, key, "the variable '%.60s' is not of causality %s", name,
                           kinds[causality]);
    } else if (v->array) {
        bough_schema_error(r, node, key, "the variable '%.60s' is an array", name);
    } else if (causality != BOUGH_FMU_PARAMETER && bough_fmu_scaled(d, v)) {
        bough_schema_error(r, node, key, "the variable '%.60s' is in %.20s; expected SI units", name,
                           v->unit);
    } else {
        return v;
    }
    return NULL;
}

// Adds the variable of a quantity; NULL: there is none.
static void enter(bough_fmu_values *values, int quantity, const bough_fmu_variable *v) {
    if (!v) return;
    values->quantity[values->n] = quantity;
    values->reference[values->n++] = v->reference;
}

static bool is_count(bough_schema_reader *r, const bough_scene_fmu *fmu, const char *key, int n,
                     int expected) {
    if (n == 0 || n == expected) return true;
    bough_schema_error(r, fmu->model.node, key,
                       "expected %d names, 'none' for those that the FMU does not have, got %d", expected, n);
    return false;
}

// field: bough_scene_values
void bough_scene_read_values(bough_schema_reader *r, const bough_node *node, void *field) {
    bough_scene_values *values = field;
    if (node->kind != BOUGH_MAPPING) {
        bough_schema_error(r, node, "",
                           "expected a mapping of names and numbers, {stiffness: 8, damping: 0.4}");
        return;
    }
    size_t n = (size_t)node->n;
    *values = (bough_scene_values){.n = node->n,
                                   .name = bough_arena_take(r->arena, (n + 1) * sizeof *values->name),
                                   .value = bough_arena_doubles(r->arena, node->n + 1),
                                   .node = bough_arena_take(r->arena, (n + 1) * sizeof *values->node)};
    for (int k = 0; k < node->n; k++) {
        values->name[k] = node->key[k]->text;
        values->node[k] = node->value[k];
        values->value[k] = bough_schema_number(r, node->value[k], BOUGH_PURE_NUMBER);
    }
}

// Reads the FMU's description and finds its parameters; false after an error.
static bool describe(bough_schema_reader *r, bough_scene_fmu_model *m) {
    const bough_scene_values *p = &m->parameters;
    if (!m->node || !m->folder) return false;
    m->folder = bough_schema_path(r, m->node, "folder", m->folder);
    m->unpacked = m->folder;
    bough_status status = bough_ok();
    if (bough_fmu_is_archive(m->folder)) status = bough_fmu_archive_unpack(r->arena, m->folder, &m->unpacked);
    if (bough_is_ok(&status)) status = bough_fmu_describe(r->arena, m->folder, m->unpacked, &m->description);
    if (!bough_is_ok(&status)) {
        bough_schema_error(r, m->node, "folder", "%s", status.message);
        return false;
    }
    m->reference = bough_arena_take(r->arena, (size_t)(p->n + 1) * sizeof *m->reference);
    for (int k = 0; k < p->n; k++) {
        const bough_fmu_variable *v = find(r, m, p->node[k], "parameters", p->name[k], BOUGH_FMU_PARAMETER);
        if (v) m->reference[k] = v->reference;
    }
    return true;
}

void bough_scene_check_fmu(bough_schema_reader *r, void *item) {
    bough_scene_fmu *fmu = item;
    if (!describe(r, &fmu->model)) return;
    bool counts = is_count(r, fmu, "motion", fmu->n_motion, BOUGH_SCENE_MOTION);
    if (!is_count(r, fmu, "wrench", fmu->n_wrench, BOUGH_SCENE_WRENCH) || !counts) return;
    for (int k = 0; k < BOUGH_SCENE_MOTION; k++) {
        const char *name = fmu->n_motion > 0 ? fmu->motion[k] : usual_motion[k];
        enter(&fmu->input, k, find(r, &fmu->model, fmu->model.node, "motion", name, BOUGH_FMU_INPUT));
    }
    for (int k = 0; k < BOUGH_SCENE_WRENCH; k++) {
        const char *name = fmu->n_wrench > 0 ? fmu->wrench[k] : usual_wrench[k];
        enter(&fmu->output, k, find(r, &fmu->model, fmu->model.node, "wrench", name, BOUGH_FMU_OUTPUT));
    }
}

static void find_terminals(bough_schema_reader *r, const bough_scene_fmu_model *m, const char *key,
                           bough_fmu_causality causality, bough_scene_terminals *to) {
    for (int k = 0; k < BOUGH_SCENE_SENSED; k++) {
        const bough_node *place = to->node;
        for (int i = 0; i < to->node->n && to->name[k]; i++) {
            const char *text = to->node->value[i]->text;
            if (text && strcmp(text, to->name[k]) == 0) place = to->node->value[i];
        }
        enter(&to->values, k, find(r, m, place, key, to->name[k], causality));
    }
    const bough_node *pitch = bough_node_find(to->node, "pitch");
    for (int b = 0; b < to->n_pitch && b < BOUGH_MOST_BLADES; b++)
        enter(&to->values, BOUGH_SCENE_SENSED + b, find(r, m, pitch, key, to->pitch[b], causality));
}

void bough_scene_check_control_fmu(bough_schema_reader *r, void *item) {
    bough_scene_control_fmu *fmu = item;
    if (!describe(r, &fmu->model) || !fmu->inputs.node || !fmu->outputs.node) return;
    find_terminals(r, &fmu->model, "inputs", BOUGH_FMU_INPUT, &fmu->inputs);
    find_terminals(r, &fmu->model, "outputs", BOUGH_FMU_OUTPUT, &fmu->outputs);
}

// -- what FMUs can be used with -------------------------------------------------------------------

// The names of the schemes that can be used with the FMU, "A, B or C".
static const char *list_schemes(const bough_scene_fmu *fmu, char text[BOUGH_SCHEME_TEXT]) {
    const char *found[BOUGH_SCHEME_TEXT / 2] = {0};
    const bough_scheme *s;
    int n = 0, length = 0;
    for (int i = 0; (s = bough_scheme_at(i)) != NULL; i++) {
        if (s->foreign && (!s->repeats || fmu->model.description.restores)) found[n++] = s->name;
    }
    for (int i = 0; i < n; i++) {
        const char *before = i == 0 ? "" : i < n - 1 ? ", " : " or ";
        length += snprintf(text + length, (size_t)(BOUGH_SCHEME_TEXT - length), "%s%s", before, found[i]);
    }
    return text;
}

// The scheme must not need the equations of all members, and must not repeat steps unless the FMU can restore
// its state.
static void check_scheme(bough_schema_reader *r, const bough_scene *s, const bough_scene_body *b) {
    const bough_scene_coupling *coupling = &s->simulation.coupling;
    const bough_node *node = s->simulation.node;
    const bough_scheme *scheme = bough_scheme_at(coupling->scheme);
    if (scheme == NULL) return;
    char expected[BOUGH_SCHEME_TEXT];
    if (!scheme->foreign) {
        bough_schema_error(r, node, "coupling.scheme",
                           "'%s' is an FMU, whose equations are not known: expected %s, got %s", b->name,
                           list_schemes(&b->fmu, expected), scheme->name);
    } else if (!scheme->repeats) {
        return;
    } else if (!b->fmu.model.description.restores) {
        bough_schema_error(r, node, "coupling.scheme",
                           "%s repeats steps, and the FMU '%s' cannot restore its state: expected %s",
                           scheme->name, b->name, list_schemes(&b->fmu, expected));
    } else if (coupling->options.accelerator == BOUGH_ACCELERATE_NEWTON) {
        bough_schema_error(r, node, "coupling.accelerator",
                           "interface-newton needs tangents, which the FMU '%s' does not give", b->name);
    } else if (coupling->options.exchange != BOUGH_EXCHANGE_END_VALUES) {
        bough_schema_error(r, node, "coupling.exchange",
                           "the FMU '%s' stops at communication points only: expected end-values", b->name);
    }
}

static void check_simulation(bough_schema_reader *r, const bough_scene *s, const bough_scene_body *b) {
    const bough_scene_simulation *x = &s->simulation;
    bough_link_at(r, "simulation");
    check_scheme(r, s, b);
    if (x->step_control.tolerance > 0) {
        bough_schema_error(r, x->node, "step_control.tolerance",
                           "not with an FMU ('%s'): expected fixed steps", b->name);
    }
    if (x->initial == BOUGH_SCENE_IN_EQUILIBRIUM || x->initial == BOUGH_SCENE_IN_OPERATION) {
        bough_schema_error(r, x->node, "initial",
                           "the equilibrium of the FMU '%s' is not known: expected undeformed", b->name);
    }
}

// The first FMU that cannot restore its state, or else the first FMU; NULL: there is none.
static const bough_scene_body *hardest(const bough_scene *s) {
    const bough_scene_body *found = NULL;
    for (int i = 0; i < s->n_body; i++) {
        const bough_scene_body *b = &s->body[i];
        if (b->fidelity != BOUGH_SCENE_FMU || !b->name) continue;
        if (!found || (found->fmu.model.description.restores && !b->fmu.model.description.restores))
            found = b;
    }
    return found;
}

static void check_once(bough_schema_reader *r, const bough_scene *s, int i) {
    const bough_scene_fmu *fmu = &s->body[i].fmu;
    for (int k = 0; k < i; k++) {
        const char *folder = s->body[k].fmu.model.folder, *own = fmu->model.folder;
        if (s->body[k].fidelity != BOUGH_SCENE_FMU || !folder || !own || strcmp(folder, own) != 0) continue;
        bough_link_at(r, "bodies[%d].fmu", i);
        bough_schema_error(r, fmu->model.node, "folder", "only one body can use this FMU, and '%s' does",
                           s->body[k].name);
        return;
    }
}

static void check_pitch(bough_schema_reader *r, const bough_scene *s, const bough_scene_terminals *x,
                        const char *key, bool common) {
    int n = s->turbine.n_blade;
    if (!x->node || x->n_pitch == 0 || x->n_pitch == n || (common && x->n_pitch == 1)) return;
    bough_schema_error(r, s->control.fmu.model.node, key,
                       "expected %sa name for each of the %d blades, got %d",
                       common ? "one name for all blades, or " : "", n, x->n_pitch);
}

void bough_link_fmus(bough_schema_reader *r, bough_scene *s) {
    if (s->control.node && s->control.kind == BOUGH_SCENE_CONTROL_FMU) {
        bough_link_at(r, "control.fmu");
        check_pitch(r, s, &s->control.fmu.inputs, "inputs.pitch", false);
        check_pitch(r, s, &s->control.fmu.outputs, "outputs.pitch", true);
    }
    const bough_scene_body *b = hardest(s);
    if (!b) return;
    check_simulation(r, s, b);
    for (int i = 0; i < s->n_body; i++) {
        if (s->body[i].fidelity == BOUGH_SCENE_FMU && s->body[i].fmu.model.description.once)
            check_once(r, s, i);
    }
}
