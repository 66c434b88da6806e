#include "apps/bough/model/equilibrium.h"

#include "apps/bough/model/aero_link.h"
#include "cosim/analysis/equilibrium.h"
#include "cosim/analysis/modes.h"
#include "flexbody/rod/rod_static.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { SAMPLES = 60 }; // of the air, most

// Changes between samples of the air below it are none, in units of the states' scales.
static const double still = 1e-8;

bool bough_rods_are_independent(const bough_simulation *s) { return s->tree->n_v == 0 && s->aero == NULL; }

double bough_equilibrium_time(const bough_simulation *s) {
    double last = 0;
    for (int i = 0; i < s->master->n_event; i++) last = fmax(last, s->master->event[i]);
    return last;
}

void bough_equilibrium_set_state(bough_simulation *s, const bough_assembly *assembly, const double *state) {
    for (int i = 0; i < assembly->n_member; i++) {
        bough_member_set(assembly->member[i], 0, state + assembly->state_offset[i]);
    }
    bough_simulation_update(s);
}

// The tree's states are the first of all.
int bough_equilibrium_held(const bough_tree *tree, bool turning, int *row) {
    int n = 0;
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        const double *speed = tree->initial + tree->n_q + link->first_speed;
        bool held = link->motion != NULL;
        for (int k = 0; k < link->n_speeds; k++) held = held || (turning && speed[k] != 0);
        if (!held) continue;
        for (int k = 0; k < link->n_coordinates; k++) row[n++] = link->first_coordinate + k;
        for (int k = 0; k < link->n_speeds; k++) row[n++] = tree->n_q + link->first_speed + k;
    }
    return n;
}

// -- why there is none ----------------------------------------------------------------------------

static const double folded = 2; // between neighbouring sections: what lies beyond has no direction [rad]

// What is found beyond this angle is no equilibrium of a rod.
static bough_status explain_rod(const bough_simulation *s, const bough_beam *beam, int steps) {
    const double *span = beam->def.span;
    bough_sharpest bend = bough_simulation_bend(s, beam);
    if (bend.angle >= folded)
        return bough_fail(
            BOUGH_FAILED,
            "%s: no equilibrium found in %d steps: the rod folds, by %.0f deg between %.3g and %.3g m; "
            "its segments are too long for its load: try rod.segments: %d",
            beam->body->name, steps, bend.angle / BOUGH_DEGREE, span[bend.segment], span[bend.segment + 1],
            4 * beam->def.n_segment);
    return bough_ok();
}

static bough_status explain_rods(const bough_simulation *s, int steps) {
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].rod) BOUGH_TRY(explain_rod(s, &s->beam[k], steps));
    }
    return bough_ok();
}

// Whether a spring, bushing or closure between two bodies is one of a joint, too: only one of its ends moves.
static bool is_across(const bough_scene *scene, int joint, const int body[2]) {
    bool moves[2];
    for (int end = 0; end < 2; end++)
        moves[end] = body[end] != BOUGH_GROUND && bough_scene_carries(scene, joint, body[end]);
    return moves[0] != moves[1];
}

static bool is_tied(const bough_scene *scene, int joint) {
    for (int k = 0; k < scene->n_spring; k++)
        if (is_across(scene, joint, scene->spring[k].body)) return true;
    for (int k = 0; k < scene->n_bushing; k++)
        if (is_across(scene, joint, scene->bushing[k].body)) return true;
    for (int k = 0; k < scene->n_closure; k++)
        if (is_across(scene, joint, scene->closure[k].body)) return true;
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

// The states are the last ones reached.
static bough_status explain(const bough_simulation *s, const bough_assembly *assembly,
                            const bough_equilibrium_report *report) {
    char joint[200] = "";
    const char *loose = loose_joint(s->scene);
    BOUGH_TRY(explain_rods(s, report->steps));
    if (loose)
        snprintf(joint, sizeof joint,
                 "nothing but loads holds the joint of '%.80s': it needs a spring, a speed or a motion; or ",
                 loose);
    return bough_fail(
        BOUGH_FAILED,
        "%s: no equilibrium found in %d steps; it still moves by %.3g of its scale "
        "in a step, at a rate of %.3g; %sthe load is too large (try a part of it, or 'bough static "
        "--path'), or the mesh too coarse",
        bough_simulation_body_of(s, assembly, report->row), report->steps, report->change, report->rate,
        joint);
}

// -- the search -----------------------------------------------------------------------------------

// An equilibrium, its growth or a path of equilibria, within bough_arena_use.
typedef struct search {
    bough_simulation *simulation;
    const bough_assembly *assembly;
    double time;
    bough_equilibrium_def limits; // step, least, tolerance and steps of an equilibrium
    bough_equilibrium_work *work; // of an equilibrium
    bough_growth *growth;         // of a state
    bough_path_listener listener; // of a path
    bough_path_report *report;

    // by set_up
    bough_whole *whole;
    double *state;  // (n_state) at rest
    bool rests;     // whether states are brought to rest in between
    double *change; // of one rod's vertices, see rod_static.h
} search;

static double change_of(const bough_assembly *assembly, const double *a, const double *b) {
    double change = 0;
    for (int i = 0; i < assembly->n_member; i++) {
        int first = assembly->state_offset[i];
        for (int k = 0; k < assembly->member[i]->system.n_state; k++) {
            double size = fabs(a[first + k] - b[first + k]) / assembly->member[i]->system.scale[k];
            change = fmax(change, size);
        }
    }
    return change;
}

// The states in equilibrium under the air's forces as sampled last.
static bough_status balance(bough_arena *arena, search *x, bough_equilibrium_def *def) {
    bough_simulation *s = x->simulation;
    bough_equilibrium_report report;
    bough_status status = bough_equilibrium_find(arena, x->whole, def, x->state, &report);
    x->work->steps += report.steps;
    bough_equilibrium_set_state(s, x->assembly, x->state);
    if (status.code == BOUGH_FAILED) return explain(s, x->assembly, &report);
    if (bough_is_ok(&status)) status = explain_rods(s, report.steps);
    def->step = BOUGH_EQUILIBRIUM_LONGEST; // near it now
    return status;
}

static bough_status balance_in_air(bough_arena *arena, search *x, bough_equilibrium_def *def) {
    size_t n = (size_t)x->assembly->n_state;
    double *before = bough_arena_doubles(arena, n), change = 0;
    while (x->work->samples < SAMPLES) {
        memcpy(before, x->state, n * sizeof *before);
        bough_aero_link_hold(x->simulation->aero, def->time);
        x->work->samples++;
        BOUGH_TRY(balance(arena, x, def));
        change = change_of(x->assembly, x->state, before);
        if (change < still) return bough_ok();
    }
    return bough_fail(BOUGH_FAILED,
                      "no equilibrium in the air: the bodies still move by %.3g of their scales"
                      " after %d samples of its forces; they may flutter or stall: try another wind"
                      " speed or pitch",
                      change, x->work->samples);
}

// Rods turn without stretching, and what hangs on their ends goes with them.
static double move(void *self, const double *state, const double *change, double *moved) {
    const search *x = self;
    const bough_simulation *s = x->simulation;
    const bough_assembly *a = x->assembly;
    double turn = 0;
    for (int k = 0; k < a->n_state; k++) moved[k] = state[k] + change[k];
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (!beam->rod) continue;
        const bough_rod_model *m = beam->mesh;
        size_t own = (size_t)a->state_offset[beam->port + 1], size = BOUGH_ROD_U * (size_t)m->n;
        size_t end = 0; // of a rod that carries nothing: not read
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

// All joints but the held ones are at rest, and the rods move with them. Each step then starts at rest: it
// goes downhill and makes no vibration. A closed loop is not brought to rest unless something turns: it may
// have to close, which takes velocities.
static void bring_to_rest(void *self, double *state) {
    const search *x = self;
    const bough_simulation *s = x->simulation;
    const bough_assembly *a = x->assembly;
    const bough_tree *tree = s->tree;
    for (int k = tree->n_q; k < tree->n_q + tree->n_v; k++) {
        bool held = false;
        for (int i = 0; i < x->whole->n_held; i++) held = held || x->whole->held[i] == k;
        if (!held) state[k] = 0;
    }
    bough_whole_inputs(x->whole, x->time, state);
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        int member = beam->port + 1;
        if (beam->port < 0) continue;
        bough_beam_move_rigidly(beam, x->whole->input + a->input_offset[member],
                                state + a->state_offset[member]);
    }
}

static bool turns(const search *x) {
    for (int i = 0; i < x->whole->n_held; i++) {
        int row = x->whole->held[i];
        if (row >= x->simulation->tree->n_q && x->state[row] != 0) return true;
    }
    return false;
}

// The system and its states at rest at the time.
static void set_up(bough_arena *arena, search *x) {
    bough_simulation *s = x->simulation;
    x->state = bough_arena_doubles(arena, (size_t)x->assembly->n_state + 1);
    x->change = bough_arena_doubles(arena, BOUGH_ROD_CHANGE * bough_simulation_most_vertices(s));
    int *row = bough_arena_take(arena, ((size_t)s->leader.system.n_state + 1) * sizeof *row);
    x->whole = bough_whole_create(arena, x->assembly, NULL);
    for (int k = 0; k < s->n_sampled; k++) {
        if (s->sampled[k].begin) s->sampled[k].begin(s->sampled[k].self, x->time);
    }
    bough_whole_hold(arena, x->whole, bough_equilibrium_held(s->tree, true, row), row);
    bough_assembly_states(x->assembly, x->state);
    bough_tree_prescribe(s->tree, x->time, x->state);
    bring_to_rest(x, x->state);
    x->rests = turns(x) || s->tree->n_closures == 0;
}

static bough_equilibrium_def equilibrium_def(search *x) {
    bough_equilibrium_def def = x->limits;
    def.time = x->time;
    def.self = x;
    def.move = move;
    if (x->rests) def.rest = bring_to_rest;
    return def;
}

static bough_status balance_members(bough_arena *arena, void *self) {
    search *x = self;
    set_up(arena, x);
    bough_equilibrium_def def = equilibrium_def(x);
    return x->simulation->aero ? balance_in_air(arena, x, &def) : balance(arena, x, &def);
}

static bough_status search_within(bough_equilibrium_def limits, bough_simulation *s,
                                  const bough_assembly *assembly, double time, bough_equilibrium_work *work) {
    search x = {.simulation = s, .assembly = assembly, .time = time, .limits = limits, .work = work};
    return bough_arena_use(balance_members, &x);
}

// -- stability ------------------------------------------------------------------------------------

// Where growing eigenvalues of the Jacobian are looked for [1/s], how many values nearest to each, and the
// part of a point that is rounding; far beyond it lie values that a small system does not have.
static const double point[] = {1, 50, 1000}, rounded = 1e-3;
enum { POINTS = 3, NEAREST = 12 }; // the latter at the first, 4 at the others

// An oscillation grows by this part of its value at least, equally from both points to this part of it.
static const double rounded_oscillation = 1e-5, again = 2.7, equal = 0.01;

// Pairs with a larger residual are made by the rounding of long steps, as (72) is: nothing grows with them.
static const double trusted = 1e-4;

static bool oscillates(const bough_eigen_pair *pair) {
    return fabs(pair->imaginary) > rounded * fabs(pair->real);
}

static bough_status find_near(bough_arena *arena, const search *x, double at, bough_eigen_pair *pair,
                              bough_eigen_count *count) {
    bough_modes_def def = {.time = x->time, .state = x->state, .input = x->whole->input, .point = at};
    return bough_modes_find(arena, x->whole, &def, pair, count);
}

// The oscillation among the pairs that grows most, by parts of its value; NULL: none.
static const bough_eigen_pair *growing_oscillation(const bough_eigen_pair *pair, int n) {
    const bough_eigen_pair *most = NULL;
    for (int k = 0; k < n; k++) {
        double size = hypot(pair[k].real, pair[k].imaginary);
        bool slow = size > rounded && size < 1 / rounded && oscillates(&pair[k]);
        if (slow && pair[k].residual < trusted && pair[k].real > rounded_oscillation * size &&
            (most == NULL || pair[k].real > most->real))
            most = &pair[k];
    }
    return most;
}

// Rounding lets values grow otherwise from another point.
static bough_status confirm_oscillation(bough_arena *arena, const search *x, const bough_eigen_pair *found) {
    bough_eigen_pair pair[NEAREST];
    bough_eigen_count count = {.wanted = NEAREST};
    BOUGH_TRY(find_near(arena, x, again, pair, &count));
    for (int k = 0; k < count.found; k++) {
        double off = hypot(pair[k].real - found->real, fabs(pair[k].imaginary) - fabs(found->imaginary));
        if (off > equal * found->real) continue;
        x->growth->oscillation = found->real;
        x->growth->frequency = fabs(found->imaginary) / (2 * BOUGH_PI);
    }
    return bough_ok();
}

static bough_status find_growth(bough_arena *arena, void *self) {
    search *x = self;
    set_up(arena, x);
    bough_whole_inputs(x->whole, x->time, x->state);
    for (int i = 0; i < POINTS; i++) {
        bough_eigen_pair pair[NEAREST];
        bough_eigen_count count = {.wanted = i == 0 ? NEAREST : 4};
        bough_status status = find_near(arena, x, point[i], pair, &count);
        if (!bough_is_ok(&status) && i > 0) continue; // none is distinctly nearest: no growth near this point
        BOUGH_TRY(status);
        for (int k = 0; k < count.found; k++) {
            bool known = pair[k].real > rounded * point[i] && pair[k].real < point[i] / rounded;
            bool grows = !oscillates(&pair[k]) && known && pair[k].residual < trusted;
            if (grows) x->growth->rate = fmax(x->growth->rate, pair[k].real);
        }
        const bough_eigen_pair *found = growing_oscillation(pair, count.found);
        if (i > 0 || found == NULL || turns(x)) continue;
        BOUGH_TRY(confirm_oscillation(arena, x, found));
    }
    return bough_ok();
}

bough_status bough_simulation_growth(bough_simulation *s, const bough_assembly *assembly, double time,
                                     bough_growth *growth) {
    search x = {.simulation = s, .assembly = assembly, .time = time, .growth = growth};
    *growth = (bough_growth){0};
    return bough_arena_use(find_growth, &x);
}

// -- continuation in the stiffness of rods --------------------------------------------------------

// EI/(EA L²) of a bar that is as stiff as any: of eight times its thickness in length.
static const double thick = 1e-3;

enum { AXIAL = 11, STRAINS = 6, FIRST_BENDING = 3 };
static const int diagonal[STRAINS] = {0, 6, 11, 15, 18, 20}; // in the upper triangle by rows

// Theory (104). C ← S C S, S = diag(1, 1, 1, s₄, s₅, s₆): positive as before.
static void stiffen_section(double length, double exponent, double *stiffness) {
    double least = thick * stiffness[AXIAL] * length * length, factor[STRAINS];
    for (int i = 0; i < STRAINS; i++) {
        bool soft = i >= FIRST_BENDING && stiffness[diagonal[i]] < least;
        factor[i] = soft ? pow(least / stiffness[diagonal[i]], exponent / 2) : 1;
    }
    for (int i = 0; i < STRAINS; i++) {
        for (int j = i; j < STRAINS; j++) *stiffness++ *= factor[i] * factor[j];
    }
}

static void stiffen(bough_arena *arena, double exponent, bough_scene_structure *structure) {
    size_t n = (size_t)structure->n_station;
    bough_scene_station *station = bough_arena_copy(arena, structure->station, n * sizeof *station);
    for (size_t i = 0; i < n; i++) stiffen_section(structure->length, exponent, station[i].def.stiffness);
    structure->station = station;
}

// The scene, undeformed, with rods of the stiffness at this exponent: 1, of thick bars, to 0, their own.
static bough_status build_stiffened(bough_arena *arena, const bough_scene *given, double exponent,
                                    bough_simulation **simulation) {
    bough_scene *scene = bough_scene_copy(arena, given);
    scene->simulation.initial = BOUGH_SCENE_UNDEFORMED;
    for (int i = 0; i < scene->n_body; i++) {
        bough_scene_body *body = &scene->body[i];
        if (body->fidelity == BOUGH_SCENE_ROD) stiffen(arena, exponent, &body->rod.structure);
    }
    return bough_simulation_build(arena, scene, simulation);
}

// A search that takes more steps, or shorter ones, may follow a slack rod into folds: stiff rods come first.
static const double least_step = 5e-3; // [s]
enum { PATIENCE = 60 };

// From an equilibrium of stiffer rods on, Newton's method: its steps, its shortest γ, and the tolerance while
// the rods are not the scene's.
enum { NEAR_STEPS = 30 };
static const double near_least = 0.03, near_tolerance = 1e-2; // [s], [-]

// Changes of the exponent: the first, the least, and by how much they grow and shrink.
static const double first_part = 0.5, least_part = 0.004, easier = 1.6, harder = 0.5;

typedef struct continuation {
    bough_simulation *simulation;
    const bough_assembly *assembly;
    double time, exponent;
    bough_equilibrium_work *work;
    double *state; // (n_state) of the equilibrium found last
    bool started;
    bool unstable; // an unstable equilibrium is better than none
} continuation;

// The equilibrium of rods of the present exponent, from the one found last.
static bough_status find_stiffened(bough_arena *arena, void *data) {
    continuation *c = data;
    bough_equilibrium_def limits = bough_equilibrium_def_default();
    bough_simulation *s = c->simulation;
    const bough_assembly *a = c->assembly;
    limits.steps = PATIENCE;
    if (c->exponent > 0) {
        BOUGH_TRY(build_stiffened(arena, c->simulation->scene, c->exponent, &s));
        a = s->master->assembly;
    }
    if (c->exponent > 0) limits.tolerance = near_tolerance;
    if (c->started) {
        bough_equilibrium_set_state(s, a, c->state);
        limits.step = BOUGH_EQUILIBRIUM_LONGEST;
        limits.least = near_least;
        limits.steps = NEAR_STEPS;
    }
    BOUGH_TRY(search_within(limits, s, a, c->time, c->work));
    bough_assembly_states(a, c->state);
    c->started = true;
    return bough_ok();
}

// theory (104): each equilibrium starts the next, of softer rods.
static bough_status soften(continuation *c) {
    double part = first_part, found = 1;
    c->exponent = found;
    BOUGH_TRY(bough_arena_use(find_stiffened, c));
    bough_status status = bough_ok();
    while (found > 0) {
        c->exponent = fmax(0, found - part);
        status = bough_arena_use(find_stiffened, c);
        bool good = bough_is_ok(&status);
        if (good) found = c->exponent;
        part *= good ? easier : harder;
        if (part < least_part) return status;
    }
    return status;
}

// Whether the simulation is as its scene says, and has rods that stiffer ones could stand for.
static bool may_soften(const bough_simulation *s) {
    return s->n_rod > 0 && s->scene->simulation.initial != BOUGH_SCENE_IN_OPERATION;
}

// By stiffer rods from `start` on: a stable equilibrium; or an unstable one, unless the way downhill ends in
// a stable one.
static bough_status find_slack(continuation *c, const double *start) {
    bough_simulation *s = c->simulation;
    const bough_assembly *a = c->assembly;
    bough_equilibrium_def whole = bough_equilibrium_def_default();
    bough_growth growth = {0}, fallen = {0};
    bough_equilibrium_set_state(s, a, start);
    bough_status softened = soften(c);
    bough_equilibrium_work work = *c->work;
    if (bough_is_ok(&softened)) bough_simulation_growth(s, a, c->time, &growth);
    if (bough_is_ok(&softened) && growth.rate == 0) return softened;
    // downhill, however long it takes
    bough_equilibrium_set_state(s, a, start);
    *c->work = (bough_equilibrium_work){0};
    bough_status status = search_within(whole, s, a, c->time, c->work);
    if (!bough_is_ok(&softened) || !c->unstable) return status;
    if (bough_is_ok(&status)) bough_simulation_growth(s, a, c->time, &fallen);
    if (bough_is_ok(&status) && fallen.rate == 0) return status;
    bough_equilibrium_set_state(s, a, c->state);
    *c->work = work;
    return softened;
}

static bough_status find_equilibrium(bough_arena *arena, void *data) {
    continuation *c = data;
    bough_simulation *s = c->simulation;
    const bough_assembly *a = c->assembly;
    bough_equilibrium_def limits = bough_equilibrium_def_default();
    if (!may_soften(s)) return search_within(limits, s, a, c->time, c->work);
    double *start = bough_arena_doubles(arena, (size_t)a->n_state + 1);
    c->state = bough_arena_doubles(arena, (size_t)a->n_state + 1);
    bough_assembly_states(a, start);
    limits.least = least_step;
    limits.steps = PATIENCE;
    bough_status status = search_within(limits, s, a, c->time, c->work);
    return status.code == BOUGH_FAILED ? find_slack(c, start) : status;
}

static bough_status find_any(bool unstable, bough_simulation *s, const bough_assembly *assembly, double time,
                             bough_equilibrium_work *work) {
    continuation c = {
        .simulation = s, .assembly = assembly, .time = time, .work = work, .unstable = unstable};
    *work = (bough_equilibrium_work){0};
    return bough_arena_use(find_equilibrium, &c);
}

bough_status bough_simulation_equilibrium(bough_simulation *s, const bough_assembly *assembly, double time,
                                          bough_equilibrium_work *work) {
    return find_any(false, s, assembly, time, work);
}

bough_status bough_simulation_any_equilibrium(bough_simulation *s, const bough_assembly *assembly,
                                              double time, bough_equilibrium_work *work) {
    return find_any(true, s, assembly, time, work);
}

// -- paths ----------------------------------------------------------------------------------------

static bough_status tell_point(void *self, double share, const double *state, bool limit) {
    const search *x = self;
    double time = fmin(fmax(share, 0), 1) * bough_equilibrium_time(x->simulation);
    for (int i = 0; i < x->assembly->n_member; i++)
        bough_member_set(x->assembly->member[i], time, state + x->assembly->state_offset[i]);
    bough_simulation_update(x->simulation);
    bough_whole_inputs(x->whole, time, state);
    size_t size = (size_t)x->assembly->n_input * sizeof(double);
    memcpy(x->simulation->master->coupling->input, x->whole->input, size);
    return x->listener.point(x->listener.self, time, share, limit);
}

static bough_status refuse_path(const bough_simulation *s) {
    const char *file = s->scene->file;
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        if (link->motion == NULL) continue;
        return bough_fail(BOUGH_INVALID,
                          "%.200s: body '%s': a path of equilibria knows no prescribed motions: give its "
                          "joint a load",
                          file, s->tree->bodies[link->body].name);
    }
    if (s->aero != NULL) return bough_fail(BOUGH_INVALID, "%.200s: a path of equilibria knows no air", file);
    if (s->jumps)
        return bough_fail(BOUGH_INVALID, "%.200s: loads: a path of equilibria knows no jumps", file);
    if (bough_equilibrium_time(s) > 0) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "%.200s: loads: expected one that grows, as 'ramp: [0 s, 1 s]': its path is "
                      "followed over the ramp",
                      file);
}

static bough_status walk_path(bough_arena *arena, void *self) {
    search *x = self;
    bough_path_def def = bough_path_def_default();
    set_up(arena, x);
    bough_equilibrium_def start = equilibrium_def(x);
    BOUGH_TRY(balance(arena, x, &start));
    def.end = bough_equilibrium_time(x->simulation);
    def.self = x;
    def.move = move;
    def.rest = bring_to_rest;
    def.point = tell_point;
    return bough_path_follow(arena, x->whole, &def, x->state, x->report);
}

bough_status bough_simulation_path(bough_simulation *s, const bough_assembly *assembly,
                                   bough_path_listener listener, bough_path_report *report) {
    bough_equilibrium_work work = {0};
    search x = {s, assembly, .limits = bough_equilibrium_def_default(), .work = &work};
    x.listener = listener;
    x.report = report;
    *report = (bough_path_report){0};
    BOUGH_TRY(refuse_path(s));
    return bough_arena_use(walk_path, &x);
}
