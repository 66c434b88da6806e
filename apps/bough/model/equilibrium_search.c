#include "apps/bough/model/equilibrium_search.h"

#include "apps/bough/model/aero_link.h"
#include "core/tree/dynamics.h"
#include "flexbody/rod/rod_static.h"

enum { SAMPLES = 60 }; // of the air, most

// Smaller changes between samples of the air end the search, in units of the states' scales.
static const double still = 1e-8;

// -- why there is no equilibrium ------------------------------------------------------------------

static const double folded = 2; // between neighbouring sections, whose rotation has no direction beyond [rad]

// A shape that is bent beyond this angle is no equilibrium of a rod.
static bough_status explain_rods(const bough_simulation *s, int steps) {
    for (const bough_beam *beam = s->beam; beam < s->beam + s->n_beam; beam++) {
        if (!beam->rod) continue;
        const double *span = beam->def.span;
        bough_sharpest bend = bough_simulation_bend(s, beam);
        if (!(bend.angle >= folded)) continue;
        return bough_fail(
            BOUGH_FAILED,
            "%s: no equilibrium found in %d steps: the rod folds, by %.0f deg between %.3g and %.3g m; "
            "its segments may be too long for its load",
            beam->body->name, steps, bend.angle / BOUGH_DEGREE, span[bend.segment], span[bend.segment + 1]);
    }
    return bough_ok();
}

// Whether a connector acts across a joint: the joint carries only one of its ends.
static bool is_across(const bough_scene *scene, int joint, const int body[2]) {
    bool moves[2];
    for (int end = 0; end < 2; end++)
        moves[end] = body[end] != BOUGH_GROUND && bough_scene_carries(scene, joint, body[end]);
    return moves[0] != moves[1];
}

static bool is_tied(const bough_scene *scene, int joint) {
    for (int kind = 0; kind < BOUGH_SCENE_CONNECTORS; kind++) {
        const bough_scene_connector *c = scene->connector[kind], *end = c + scene->n_connector[kind];
        for (; c < end; c++)
            if (c->holds && is_across(scene, joint, c->body)) return true;
    }
    return false;
}

// The first body whose joint moves without a spring; NULL: there is none.
static const char *loose_joint(const bough_scene *scene) {
    for (int i = 0; i < scene->n_body; i++) {
        const bough_scene_joint *joint = &scene->body[i].joint;
        bool held = joint->kind == BOUGH_JOINT_FIXED || joint->motion[0].node || joint->speeds[0] != 0;
        if (!held && joint->spring.stiffness == 0 && !is_tied(scene, i)) return scene->body[i].name;
    }
    return NULL;
}

static int group_of(const int *group, int body) {
    while (group[body] != body) body = group[body];
    return body;
}

static void tie(int *group, const int body[2]) {
    int a = group_of(group, body[0] + 1), b = group_of(group, body[1] + 1);
    group[a > b ? a : b] = a > b ? b : a;
}

// The first body that is not connected with the ground, not even through other bodies; NULL: there is none.
static const char *floating_body(bough_arena *arena, const bough_scene *scene) {
    int *group = bough_arena_take(arena, ((size_t)scene->n_body + 1) * sizeof *group); // the ground first
    for (int i = 0; i <= scene->n_body; i++) group[i] = i;
    for (int i = 0; i < scene->n_body; i++) {
        const bough_scene_joint *joint = &scene->body[i].joint;
        if (joint->kind != BOUGH_JOINT_FREE) tie(group, (const int[2]){i, joint->parent});
    }
    for (int kind = 0; kind < BOUGH_SCENE_CONNECTORS; kind++) {
        const bough_scene_connector *c = scene->connector[kind], *end = c + scene->n_connector[kind];
        for (; c < end; c++)
            if (c->holds) tie(group, c->body);
    }
    for (int i = 0; i < scene->n_body; i++)
        if (group_of(group, i + 1) != 0) return scene->body[i].name;
    return NULL;
}

// The states are the last ones reached.
static bough_status explain(bough_arena *arena, const bough_simulation *s,
                            const bough_equilibrium_report *report) {
    char joint[200] = "";
    const char *loose = loose_joint(s->scene), *floating = floating_body(arena, s->scene);
    if (floating)
        return bough_fail(
            BOUGH_FAILED,
            "%s: no equilibrium found: nothing ties it to the ground, not even through other bodies: "
            "it needs a joint, spring, bushing or closure",
            floating);
    BOUGH_TRY(explain_rods(s, report->steps));
    if (loose)
        snprintf(joint, sizeof joint,
                 "nothing but loads holds the joint of '%.80s': it needs a spring, a speed or a motion; or ",
                 loose);
    bool path = false; // unknown while the run is built
    if (s->master) {
        bough_status status = bough_equilibrium_check_path(s);
        path = bough_is_ok(&status);
    }
    return bough_fail(
        BOUGH_FAILED,
        "%s: no equilibrium found in %d steps; it still moves by %.3g of its scale "
        "in a step, at a rate of %.3g; %sthe load is too large (try a part of it%s), or the mesh too coarse",
        bough_simulation_body_of(s, report->row), report->steps, report->change, report->rate, joint,
        path ? ", or 'bough static --path'" : "");
}

// -- the search -----------------------------------------------------------------------------------

bough_status bough_equilibrium_search_balance(bough_arena *arena, bough_equilibrium_search *x,
                                              bough_equilibrium_def *def) {
    bough_simulation *s = x->simulation;
    bough_equilibrium_report report;
    bough_status status = bough_equilibrium_find(arena, x->whole, def, x->state, &report);
    x->work->steps += report.steps;
    bough_equilibrium_set_state(s, x->time, x->state);
    if (status.code == BOUGH_FAILED) return explain(arena, s, &report);
    if (bough_is_ok(&status)) status = explain_rods(s, report.steps);
    def->step = BOUGH_EQUILIBRIUM_LONGEST; // near it now
    def->kept = report.kept;
    return status;
}

static bough_status balance_in_air(bough_arena *arena, bough_equilibrium_search *x,
                                   bough_equilibrium_def *def) {
    size_t n = (size_t)x->simulation->assembly->n_state;
    double *before, *scale, change = 0;
    bough_arena_each(arena, n, &before, &scale);
    bough_assembly_scales(x->simulation->assembly, scale);
    while (x->work->samples < SAMPLES) {
        memcpy(before, x->state, n * sizeof *before);
        bough_aero_link_hold(x->simulation->aero, def->time);
        x->work->samples++;
        BOUGH_TRY(bough_equilibrium_search_balance(arena, x, def));
        change = 0;
        for (size_t k = 0; k < n; k++) change = fmax(change, fabs(x->state[k] - before[k]) / scale[k]);
        if (change < still) return bough_ok();
    }
    return bough_fail(BOUGH_FAILED,
                      "no equilibrium in the air: the bodies still move by %.3g of their scales"
                      " after %d samples of its forces; they may flutter or stall: try another wind"
                      " speed or pitch",
                      change, x->work->samples);
}

// Rods rotate without stretching, and bodies on their ends move with them.
double bough_equilibrium_search_move(void *self, const double *state, const double *change, double *moved) {
    const bough_equilibrium_search *x = self;
    const bough_simulation *s = x->simulation;
    double turn = 0;
    for (int k = 0; k < s->assembly->n_state; k++) moved[k] = state[k] + change[k];
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (!beam->rod) continue;
        const bough_rod_model *m = beam->mesh;
        size_t own = (size_t)bough_beam_row(s, beam), size = BOUGH_ROD_U * (size_t)m->n;
        size_t end = 0; // not read of a rod that carries nothing
        if (beam->end >= 0) {
            int link = s->tree->ends[beam->end].link;
            end = (size_t)s->tree->links[link].first_coordinate;
        }
        bough_rod_change(m, state + own, state + end, change + own, change + end, x->change);
        memcpy(moved + own, state + own, size * sizeof *moved);
        if (beam->end >= 0) memcpy(moved + end, state + end, BOUGH_ROD_U * sizeof *moved);
        bough_rod_move(m, x->change, 1, moved + own, moved + end);
        turn = fmax(turn, bough_rod_turn(m, x->change));
    }
    return turn;
}

// Sets all joints to rest except the held ones, and the rods to move with them. Each step then starts from
// rest: it goes downhill and excites no vibration. A closed loop is not set to rest unless something rotates:
// velocities may be needed to close it.
void bough_equilibrium_search_rest(void *self, double *state) {
    const bough_equilibrium_search *x = self;
    const bough_simulation *s = x->simulation;
    const bough_tree *tree = s->tree;
    for (int k = tree->n_q; k < tree->n_q + tree->n_v; k++) {
        bool held = false;
        for (int i = 0; i < x->whole->n_held; i++) held = held || x->whole->held[i] == k;
        if (!held) state[k] = 0;
    }
    bough_whole_inputs(x->whole, x->time, state);
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (beam->port < 0) continue;
        const double *input = x->whole->input + s->assembly->input_offset[beam->port + 1];
        bough_beam_move_rigidly(beam, input, state + bough_beam_row(s, beam));
    }
}

// Twice the kinetic energy of rigid bodies and rods.
double bough_equilibrium_search_kinetic(void *self, const double *state) {
    const bough_equilibrium_search *x = self;
    const bough_simulation *s = x->simulation;
    double sum = 0;
    bough_tree_kinematics(s->tree, state, s->view);
    for (int i = 0; i < s->tree->n_links; i++) {
        bough_twist twist = s->view->twist[i];
        sum += bough_power(twist, bough_inertia_mul(&s->tree->links[i].inertia, twist));
    }
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (!beam->rod) continue;
        const double *own = state + bough_beam_row(s, beam);
        sum += bough_rod_energy(beam->mesh, own, own + (size_t)BOUGH_ROD_U * (size_t)beam->mesh->n);
    }
    return sum;
}

bool bough_equilibrium_search_turns(const bough_equilibrium_search *x) {
    for (int i = 0; i < x->whole->n_held; i++) {
        int row = x->whole->held[i];
        if (row >= x->simulation->tree->n_q && x->state[row] != 0) return true;
    }
    return false;
}

void bough_equilibrium_search_set_up(bough_arena *arena, bough_equilibrium_search *x) {
    bough_simulation *s = x->simulation;
    size_t states = (size_t)s->assembly->n_state + 1;
    bough_arena_each(arena, states, &x->state, &x->scale);
    x->unit = bough_equilibrium_find_units(s, x->scale);
    x->change = bough_arena_doubles(arena, BOUGH_ROD_CHANGE * bough_simulation_most_vertices(s));
    int *row = bough_arena_take(arena, ((size_t)s->leader.system.n_state + 1) * sizeof *row);
    x->whole = bough_whole_create(arena, s->assembly, NULL);
    for (int k = 0; k < s->n_sampled; k++) {
        if (s->sampled[k].begin) s->sampled[k].begin(s->sampled[k].self, x->time);
    }
    bough_whole_hold(arena, x->whole, bough_equilibrium_held(s->tree, true, row), row);
    bough_assembly_states(s->assembly, x->state);
    bough_tree_prescribe(s->tree, x->time, x->state);
    bough_equilibrium_search_rest(x, x->state);
    x->rests = bough_equilibrium_search_turns(x) || s->tree->n_closures == 0;
}

bough_equilibrium_def bough_equilibrium_search_def(bough_equilibrium_search *x) {
    bough_equilibrium_def def = x->limits;
    def.time = x->time;
    def.unit = x->unit.time;
    def.scale = x->scale;
    def.self = x;
    def.move = bough_equilibrium_search_move;
    if (x->rests || def.kinetic) def.rest = bough_equilibrium_search_rest;
    // the kinetic energy of a steady rotation is constant and no criterion
    if (bough_equilibrium_search_turns(x)) def.kinetic = NULL;
    return def;
}

static bough_status balance_members(bough_arena *arena, void *self) {
    bough_equilibrium_search *x = self;
    bough_equilibrium_search_set_up(arena, x);
    bough_equilibrium_def def = bough_equilibrium_search_def(x);
    return x->simulation->aero ? balance_in_air(arena, x, &def)
                               : bough_equilibrium_search_balance(arena, x, &def);
}

bough_status bough_equilibrium_search_within(bough_equilibrium_def limits, bough_simulation *s, double time,
                                             bough_equilibrium_work *work) {
    bough_equilibrium_search x = {.simulation = s, .time = time, .limits = limits, .work = work};
    return bough_arena_use(balance_members, &x);
}
