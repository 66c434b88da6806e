// Resolves the names of the turbine, its air and its control; see scene_link.c.
#include "aero/control/discon.h"
#include "apps/bough/scene/scene_internal.h"

// -- turbine --------------------------------------------------------------------------------------

static bool is_listed_before(const bough_scene_turbine *t, int k) {
    for (int i = 0; i < k; i++) {
        if (t->blade[i] == t->blade[k]) return true;
    }
    return false;
}

static void link_blade(bough_schema_reader *r, bough_scene *s, int k) {
    bough_scene_turbine *t = &s->turbine;
    const bough_node *node = bough_node_find(t->node, "blades")->value[k];
    const char *name = t->blade_name[k];
    bough_link_at(r, "turbine.blades[%d]", k);
    t->blade[k] = bough_link_body(r, s, node, "", name);
    if (t->blade[k] < 0) return;
    if (is_listed_before(t, k)) {
        bough_schema_error(r, node, "", "blade '%s' is given twice", name);
    } else if (bough_node_find(s->body[t->blade[k]].node, "rod") == NULL) {
        bough_schema_error(r, node, "", "body '%s' has no rod, so it cannot be a blade", name);
    } else if (t->rotor >= 0 && !bough_scene_carries(s, t->rotor, t->blade[k])) {
        bough_schema_error(r, node, "", "body '%s' is not carried by the rotor '%s'", name, t->rotor_name);
    }
}

void bough_link_turbine(bough_schema_reader *r, bough_scene *s) {
    bough_scene_turbine *t = &s->turbine;
    t->rotor = BOUGH_UNRESOLVED;
    if (t->node == NULL) return;
    bough_link_at(r, "turbine");
    t->rotor = bough_link_body(r, s, t->node, "rotor", t->rotor_name);
    int kind = t->rotor < 0 ? -1 : s->body[t->rotor].joint.kind;
    if (kind >= 0 && kind != BOUGH_JOINT_REVOLUTE) {
        bough_schema_error(r, t->node, "rotor", "the joint of '%s' must be revolute", t->rotor_name);
    }
    t->blade = bough_arena_take(r->arena, (size_t)t->n_blade * sizeof *t->blade);
    for (int k = 0; k < t->n_blade; k++) link_blade(r, s, k);
}

// -- aerodynamics ---------------------------------------------------------------------------------

// The index of the polar that a station's key names; −1 after an error.
static int find_polar(bough_schema_reader *r, bough_scene *s, const char *const *names, int i,
                      const char *key, const char *name) {
    const bough_scene_polars *polars = &s->aero.polars;
    for (int k = 0; k < polars->n_polar; k++) {
        if (names[k] != NULL && strcmp(names[k], name) == 0) return k;
    }
    bool compact = bough_node_find(s->aero.blade.node, "stations")->kind == BOUGH_MAPPING;
    bough_link_at(r, "stations%s[%d]", compact ? ".rows" : "", i);
    int n = r->errors->dropped > 0 ? 0 : polars->n_polar;
    bough_schema_error(r, s->aero.blade.station[i].node, key, "the polars file has no '%.48s'%s", name,
                       bough_suggest(name, names, n).text);
    return -1;
}

static void link_polar(bough_schema_reader *r, bough_scene *s, const char *const *names, int i) {
    bough_scene_aero_station *station = &s->aero.blade.station[i];
    bough_station_def *def = &station->def;
    def->polar = def->second = -1;
    if (station->polar_name != NULL) {
        def->polar = find_polar(r, s, names, i, "polar", station->polar_name);
    }
    if (station->second_name != NULL) {
        def->second = find_polar(r, s, names, i, "blend", station->second_name);
    } else if (def->share > 0) {
        bough_link_at(r, "stations[%d]", i);
        bough_schema_error(r, station->node, "share", "needs 'blend', which names a second polar");
    }
}

static void link_polars(bough_schema_reader *r, bough_scene *s) {
    const bough_scene_polars *polars = &s->aero.polars;
    bough_scene_aero_blade *blade = &s->aero.blade;
    if (polars->n_polar == 0) return;
    // other scenes may use the stations of the file with other polars
    blade->station =
        bough_arena_copy(r->arena, blade->station, (size_t)blade->n_station * sizeof *blade->station);
    const char **names = bough_arena_take(r->arena, (size_t)polars->n_polar * sizeof *names);
    for (int k = 0; k < polars->n_polar; k++) names[k] = polars->polar[k].name;
    for (int i = 0; i < blade->n_station; i++) {
        if (blade->station[i].node != NULL) link_polar(r, s, names, i);
    }
}

// The blade elements must end where the rods end.
static void check_blade_lengths(bough_schema_reader *r, const bough_scene *s) {
    const bough_scene_aero_blade *blade = &s->aero.blade;
    if (blade->n_station < 2) return;
    double span = blade->station[blade->n_station - 1].def.span;
    for (int k = 0; k < s->turbine.n_blade; k++) {
        if (s->turbine.blade[k] < 0) continue;
        const bough_scene_body *b = &s->body[s->turbine.blade[k]];
        double length = b->rod.structure.length;
        if (!(length > 0) || !(fabs(span - length) > 1e-3 * length)) continue;
        bough_schema_error(r, s->aero.node, "blade", "the blade elements end at %g m, but '%s' is %g m long",
                           span, b->name, length);
        return;
    }
}

// The body on which the tower's drag acts.
static void link_tower(bough_schema_reader *r, bough_scene *s) {
    bough_scene_tower *tower = &s->aero.tower;
    tower->body = bough_link_body(r, s, s->aero.node, "tower.body", tower->body_name);
    if (tower->body < 0) return;
    if (bough_scene_blade(s, tower->body) >= 0 || bough_node_find(s->body[tower->body].node, "rod") == NULL) {
        bough_schema_error(r, s->aero.node, "tower.body", "'%s' must have a rod and must not be a blade",
                           tower->body_name);
    }
}

void bough_link_aero(bough_schema_reader *r, bough_scene *s) {
    if (s->aero.node == NULL) return;
    bough_link_at(r, "aero");
    if (s->turbine.node == NULL) {
        bough_schema_error(r, s->aero.node, "", "needs 'turbine', which names rotor and blades");
    }
    bough_scene_check_ramp(r, s->aero.node, s->aero.ramp);
    for (int k = 0; k < s->aero.n_node; k++) {
        double node = s->aero.nodes[k];
        if (node == floor(node) && node <= s->aero.blade.n_station) continue;
        bough_schema_error(r, s->aero.node, "nodes", "expected numbers from 1 to %d, got %g",
                           s->aero.blade.n_station, node);
    }
    check_blade_lengths(r, s);
    if (s->aero.tower.body_name != NULL) link_tower(r, s);
    link_polars(r, s);
}

// -- control --------------------------------------------------------------------------------------

// A pitch joint is revolute with a prescribed motion.
static bool has_pitch_joint(const bough_scene_body *b) {
    return b->joint.kind == BOUGH_JOINT_REVOLUTE && b->joint.motion[0].node != NULL;
}

static void link_event(bough_schema_reader *r, bough_scene *s, int i) {
    bough_scene_event *e = &s->control.event[i];
    bool stops = e->kind == BOUGH_SCENE_STOP || e->kind == BOUGH_SCENE_EMERGENCY_STOP;
    bool pitches = stops || e->kind == BOUGH_SCENE_PITCH_TO || e->blade > 0;
    const bough_node *angle = bough_node_find(e->node, "angle");
    if (stops && (!angle || strcmp(angle->text, "auto") == 0)) e->angle = BOUGH_PI / 2; // feathered
    bough_link_at(r, "control.events[%d]", i);
    if (pitches && s->turbine.n_blade > 0 && s->turbine.blade[0] >= 0 &&
        !has_pitch_joint(&s->body[s->turbine.blade[0]])) {
        bough_schema_error(r, e->node, "", "needs blades on pitch joints: revolute with 'motion'");
    } else if (pitches && !s->control.pitch) {
        bough_schema_error(r, e->node, "", "needs 'control.pitch: true', without which no pitch changes");
    }
    if (e->blade > s->turbine.n_blade) {
        bough_schema_error(r, e->node, "blade", "the turbine has %d blades", s->turbine.n_blade);
    }
    if (e->body_name == NULL) return;
    e->body = bough_link_body(r, s, e->node, "body", e->body_name);
    if (e->body >= 0 && s->body[e->body].joint.motion[0].node == NULL) {
        bough_schema_error(r, e->node, "body", "the joint of '%s' has no 'motion'", e->body_name);
    }
}

// Steady operation needs a control law, air from the start on, and a rotor without a prescribed motion.
static void check_operation(bough_schema_reader *r, const bough_scene *s) {
    if (s->simulation.initial != BOUGH_SCENE_IN_OPERATION) return;
    bool law = s->control.node != NULL && s->control.kind == BOUGH_SCENE_VARIABLE_SPEED;
    bough_link_at(r, "%s", "");
    if (!law || s->aero.node == NULL || s->turbine.node == NULL) {
        bough_schema_error(r, s->node, "simulation.initial",
                           "operation needs 'aero' and 'control: {kind: "
                           "variable-speed}'; else give the rotor's speed and 'equilibrium'");
    } else if (s->aero.ramp[1] > 0) {
        bough_schema_error(r, s->node, "simulation.initial",
                           "operation needs the air from the start on: leave out 'aero.ramp'");
    } else if (s->turbine.rotor >= 0 && s->body[s->turbine.rotor].joint.motion[0].node != NULL) {
        bough_schema_error(r, s->node, "simulation.initial",
                           "the motion of '%s' already prescribes its speed", s->turbine.rotor_name);
    }
}

void bough_link_control(bough_schema_reader *r, bough_scene *s) {
    check_operation(r, s);
    if (s->control.node == NULL) return;
    bough_link_at(r, "control");
    if (s->turbine.node == NULL) {
        bough_schema_error(r, s->control.node, "", "needs 'turbine', which names rotor and blades");
    }
    for (int k = 0; k < s->turbine.n_blade && s->turbine.blade && s->turbine.blade[0] >= 0; k++) {
        if (s->turbine.blade[k] < 0) return;
        if (k == 0 && s->control.pitch && !has_pitch_joint(&s->body[s->turbine.blade[0]])) {
            bough_schema_error(r, s->control.node, "",
                               "the joint of '%s' cannot pitch it: expected 'kind: revolute, axis: "
                               "z' with a 'motion', or 'pitch: false' here",
                               s->turbine.blade_name[0]);
        }
        const bough_scene_body *first = &s->body[s->turbine.blade[0]];
        const bough_scene_body *b = &s->body[s->turbine.blade[k]];
        if (s->control.pitch && has_pitch_joint(b) != has_pitch_joint(first)) {
            bough_schema_error(r, b->node, "",
                               "blades '%s' and '%s': all or none are pitched by a joint with 'motion'",
                               first->name, b->name);
        } else if (s->control.pitch && has_pitch_joint(b) && b->joint.axis != 2) {
            bough_schema_error(r, b->node, "", "the pitch joint of '%s' must turn about z", b->name);
        }
    }
    if (s->turbine.n_blade > BOUGH_MOST_BLADES) {
        bough_schema_error(r, s->control.node, "", "expected a rotor of at most %d blades, got %d",
                           (int)BOUGH_MOST_BLADES, s->turbine.n_blade);
    }
    if (s->control.n_event > BOUGH_MOST_EVENTS) {
        bough_link_at(r, "control");
        bough_schema_error(r, s->control.node, "events", "expected at most %d, got %d",
                           (int)BOUGH_MOST_EVENTS, s->control.n_event);
    }
    for (int i = 0; i < s->control.n_event && s->turbine.blade; i++) link_event(r, s, i);
}
