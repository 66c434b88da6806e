#include "apps/bough/model/equilibrium.h"

#include "apps/bough/model/equilibrium_search.h"
#include "apps/bough/model/section_loads.h"
#include "core/base/linalg.h"

bool bough_rods_are_independent(const bough_simulation *s) { return s->tree->n_v == 0 && s->aero == NULL; }

double bough_equilibrium_time(const bough_simulation *s) {
    double last = 0;
    for (int i = 0; i < s->master->n_event; i++) last = fmax(last, s->master->event[i]);
    return last;
}

void bough_equilibrium_set_state(bough_simulation *s, double time, const double *state) {
    const bough_assembly *a = s->assembly;
    for (int i = 0; i < a->n_member; i++) bough_member_set(a->member[i], time, state + a->state_offset[i]);
    bough_simulation_update(s);
}

// The tree's states are the first of all. The speeds of a cylindrical joint are the rates of its coordinates,
// so that one of them alone may be held.
int bough_equilibrium_held(const bough_tree *tree, bool turning, int *row) {
    int n = 0;
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        const double *speed = tree->initial + tree->n_q + link->first_speed;
        bool given = link->motion != NULL, moves = false;
        bool separate = link->joint.kind == BOUGH_JOINT_CYLINDRICAL;
        for (int k = 0; k < link->n_speeds; k++) moves = moves || (turning && speed[k] != 0);
        for (int k = 0; k < link->n_coordinates + link->n_speeds; k++) {
            bool rate = k >= link->n_coordinates;
            int own = rate ? k - link->n_coordinates : k;
            if (!given && !(moves && (!separate || speed[own] != 0))) continue;
            row[n++] = rate ? tree->n_q + link->first_speed + own : link->first_coordinate + own;
        }
    }
    return n;
}

// -- continuation in the stiffness of rods --------------------------------------------------------

// EI/(EA L²) of a bar that is eight times as long as thick; the search is no easier with stiffer rods.
static const double thick = 1e-3;

enum { AXIAL = 2, STRAINS = 6, FIRST_BENDING = 3 };

// theory (104). C ← S C S, S = diag(1, 1, 1, s₄, s₅, s₆): positive as before.
static void stiffen_section(double length, double exponent, double *stiffness) {
    double least = thick * stiffness[bough_symmetric6_index(AXIAL, AXIAL)] * length * length, factor[STRAINS];
    for (int i = 0; i < STRAINS; i++) {
        double own = stiffness[bough_symmetric6_index(i, i)];
        factor[i] = i >= FIRST_BENDING && own < least ? pow(least / own, exponent / 2) : 1;
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

// The undeformed scene with rods of the stiffness at this exponent: from 1, that of thick bars, to 0, their
// own.
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

// A search with more or shorter steps may follow a slack rod into folds: rods are then stiffened.
static const double least_step = 5e-3; // in units of the scene's time
enum { PATIENCE = 60, RIGID_STEPS = 200 };

// Newton's method from an equilibrium of stiffer rods: its steps, its smallest γ, and the tolerance for
// stiffened rods.
enum { NEAR_STEPS = 30 };
static const double near_least = 0.03, near_tolerance = 1e-2;

// Changes of the exponent: the first, the least, and the factors by which they grow and shrink.
static const double first_part = 0.5, least_part = 0.004, easier = 1.6, harder = 0.5;

typedef struct continuation {
    bough_simulation *simulation;
    double time, exponent;
    bough_equilibrium_work *work;
    double *state; // (n_state) of the equilibrium found last
    int how;
    int finer; // segments relative to the scene's, where a finer mesh is tried
    bool started;
} continuation;

// The equilibrium of rods of the present exponent, from the one found last.
static bough_status find_stiffened(bough_arena *arena, void *data) {
    continuation *c = data;
    bough_equilibrium_def limits = bough_equilibrium_def_default();
    bough_simulation *s = c->simulation;
    limits.steps = PATIENCE;
    if (c->exponent > 0) {
        BOUGH_TRY(build_stiffened(arena, c->simulation->scene, c->exponent, &s));
        limits.tolerance = near_tolerance;
    }
    if (c->started) {
        bough_equilibrium_set_state(s, c->time, c->state);
        limits.step = BOUGH_EQUILIBRIUM_LONGEST;
        limits.least = near_least;
        limits.steps = NEAR_STEPS;
    }
    BOUGH_TRY(bough_equilibrium_search_within(limits, s, c->time, c->work));
    bough_assembly_states(s->assembly, c->state);
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

// Searches from `start`: first with stiffened rods, then, if that finds no stable equilibrium, downhill. If
// both find none that is stable, an unstable one is kept if `how` accepts it.
static bough_status find_slack(continuation *c, const double *start) {
    bough_simulation *s = c->simulation;
    bough_equilibrium_def whole = bough_equilibrium_def_default();
    whole.kinetic = bough_equilibrium_search_kinetic;
    bough_growth growth = {0}, fallen = {0};
    bough_equilibrium_set_state(s, c->time, start);
    bough_status softened = s->n_rod > 0 ? soften(c) : bough_fail(BOUGH_FAILED, "no rods");
    bough_equilibrium_work work = *c->work;
    if (bough_is_ok(&softened)) bough_simulation_growth(s, c->time, false, &growth);
    if (bough_is_ok(&softened) && growth.rate == 0) return softened;
    // downhill, with any number of steps
    bough_equilibrium_set_state(s, c->time, start);
    *c->work = (bough_equilibrium_work){0};
    bough_status status = bough_equilibrium_search_within(whole, s, c->time, c->work);
    if (!bough_is_ok(&softened) || !(c->how & BOUGH_EQUILIBRIUM_UNSTABLE)) return status;
    if (bough_is_ok(&status)) bough_simulation_growth(s, c->time, false, &fallen);
    if (bough_is_ok(&status) && fallen.rate == 0) return status;
    bough_equilibrium_set_state(s, c->time, c->state);
    *c->work = work;
    return softened;
}

// The searches on the scene's own mesh; a single one in operation, where trim.c varies speed and pitch.
static bough_status find_on_mesh(bough_arena *arena, continuation *c) {
    bough_simulation *s = c->simulation;
    bool once = s->scene->simulation.initial == BOUGH_SCENE_IN_OPERATION;
    bough_equilibrium_def limits = bough_equilibrium_def_default();
    double *start;
    bough_arena_each(arena, (size_t)s->assembly->n_state + 1, &start, &c->state);
    bough_assembly_states(s->assembly, start);
    if (!once) limits.steps = s->n_rod > 0 ? PATIENCE : RIGID_STEPS;
    if (!once && s->n_rod > 0) limits.least = least_step;
    bough_status status = bough_equilibrium_search_within(limits, s, c->time, c->work);
    return status.code == BOUGH_FAILED && !once ? find_slack(c, start) : status;
}

// -- equilibrium on a finer mesh ------------------------------------------------------------------

// Segments of the finer meshes relative to the scene's, and the most of all rods together.
static const int finer[] = {4, 16};
enum { FINER = 2, MOST_SEGMENTS = 2000 };

// A rod whose sections rotate by this angle over a segment may need shorter segments [rad].
static const double sharp = 0.7;

static int count_segments(const bough_scene *scene) {
    int n = 0;
    for (int i = 0; i < scene->n_body; i++) {
        if (scene->body[i].fidelity == BOUGH_SCENE_ROD) n += scene->body[i].rod.n_segment;
    }
    return n;
}

// The rod with the largest rotation over a segment; NULL: none is sharply bent.
static const bough_beam *sharpest_rod(const bough_simulation *s) {
    const bough_beam *found = NULL;
    double largest = sharp;
    for (int k = 0; k < s->n_beam; k++) {
        if (!s->beam[k].rod) continue;
        bough_sharpest bend = bough_simulation_bend(s, &s->beam[k]);
        if (!(bend.angle > largest)) continue;
        found = &s->beam[k];
        largest = bend.angle;
    }
    return found;
}

static bough_status find_on_finer(bough_arena *arena, void *data) {
    continuation fine = *(const continuation *)data;
    bough_scene *scene = bough_scene_copy(arena, fine.simulation->scene);
    scene->simulation.initial = BOUGH_SCENE_UNDEFORMED;
    for (int i = 0; i < scene->n_body; i++) {
        if (scene->body[i].fidelity == BOUGH_SCENE_ROD) scene->body[i].rod.n_segment *= fine.finer;
    }
    BOUGH_TRY(bough_simulation_build(arena, scene, &fine.simulation));
    fine.started = false;
    return find_on_mesh(arena, &fine);
}

// Completes the failure on the scene's mesh by whether a finer mesh has an equilibrium.
static bough_status explain_by_finer(continuation *c, bough_status failure) {
    const bough_beam *beam = sharpest_rod(c->simulation);
    int times = 0;
    if (beam == NULL) return failure;
    for (int k = 0; k < FINER && finer[k] * count_segments(c->simulation->scene) <= MOST_SEGMENTS; k++) {
        times = c->finer = finer[k];
        bough_status status = bough_arena_use(find_on_finer, c);
        if (bough_is_ok(&status))
            return bough_fail(BOUGH_FAILED,
                              "%s: no equilibrium found: its segments are too long for its load; with %d "
                              "times the segments in each rod (here %d) one is found",
                              beam->body->name, times, times * beam->def.n_segment);
    }
    if (times == 0) return failure;
    return bough_fail(BOUGH_FAILED, "%s; none found with up to %d times the segments either", failure.message,
                      times);
}

static bough_status find_from_anywhere(bough_arena *arena, continuation *c) {
    bough_status status = find_on_mesh(arena, c);
    bool explains = c->simulation->scene->simulation.initial != BOUGH_SCENE_IN_OPERATION &&
                    !(c->how & BOUGH_EQUILIBRIUM_ALONE);
    return status.code == BOUGH_FAILED && explains ? explain_by_finer(c, status) : status;
}

// From the present state by long steps if it is near the equilibrium, otherwise by all searches.
static bough_status find_equilibrium(bough_arena *arena, void *data) {
    continuation *c = data;
    if (!(c->how & BOUGH_EQUILIBRIUM_NEAR)) return find_from_anywhere(arena, c);
    const bough_assembly *a = c->simulation->assembly;
    double *start = c->state = bough_arena_doubles(arena, (size_t)a->n_state + 1);
    bough_assembly_states(a, start);
    c->started = true;
    bough_status status = find_stiffened(arena, c);
    if (bough_is_ok(&status)) return status; // otherwise `start` is unchanged
    bough_equilibrium_set_state(c->simulation, c->time, start);
    c->started = false;
    *c->work = (bough_equilibrium_work){0};
    return find_from_anywhere(arena, c);
}

bough_status bough_simulation_equilibrium(bough_simulation *s, double time, int how,
                                          bough_equilibrium_work *work) {
    bough_equilibrium_work done = {0};
    continuation c = {s, time, .work = &done, .how = how};
    bough_status status = bough_arena_use(find_equilibrium, &c);
    if (work) *work = done;
    return status;
}

// -- paths of equilibria while the loads grow -------------------------------------------------------

static bough_status report_point(void *self, double factor, const double *state, bool limit) {
    const bough_equilibrium_search *x = self;
    double time = fmin(fmax(factor, 0), 1) * bough_equilibrium_time(x->simulation);
    bough_equilibrium_set_state(x->simulation, time, state);
    bough_whole_inputs(x->whole, time, state);
    size_t size = (size_t)x->simulation->assembly->n_input * sizeof(double);
    memcpy(x->simulation->master->coupling->input, x->whole->input, size);
    return x->listener.point(x->listener.self, time, factor, limit);
}

bough_status bough_equilibrium_check_path(const bough_simulation *s) {
    const char *file = s->scene->file;
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        if (link->motion == NULL) continue;
        return bough_fail(BOUGH_INVALID,
                          "%.200s: body '%s': a path of equilibria allows no prescribed motions: give its "
                          "joint a load",
                          file, s->tree->bodies[link->body].name);
    }
    if (s->aero != NULL) return bough_fail(BOUGH_INVALID, "%.200s: a path of equilibria allows no air", file);
    if (s->jumps)
        return bough_fail(BOUGH_INVALID, "%.200s: loads: a path of equilibria allows no jumps", file);
    if (bough_equilibrium_time(s) > 0) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "%.200s: loads: the path follows a growing load: expected one with a ramp, such as "
                      "'ramp: [0 s, 1 s]'",
                      file);
}

static bough_status walk_path(bough_arena *arena, void *self) {
    bough_equilibrium_search *x = self;
    bough_path_def def = bough_path_def_default();
    bough_equilibrium_search_set_up(arena, x);
    bough_equilibrium_def start = bough_equilibrium_search_def(x);
    BOUGH_TRY(bough_equilibrium_search_balance(arena, x, &start));
    def.end = bough_equilibrium_time(x->simulation);
    def.self = x;
    def.move = bough_equilibrium_search_move;
    def.rest = bough_equilibrium_search_rest;
    def.point = report_point;
    return bough_path_follow(arena, x->whole, &def, x->state, x->report);
}

bough_status bough_simulation_path(bough_simulation *s, bough_path_listener listener,
                                   bough_path_report *report) {
    bough_equilibrium_work work = {0};
    bough_equilibrium_search x = {s, .limits = bough_equilibrium_def_default(), .work = &work};
    x.listener = listener;
    x.report = report;
    *report = (bough_path_report){0};
    BOUGH_TRY(bough_equilibrium_check_path(s));
    return bough_arena_use(walk_path, &x);
}

// -- the shape of one simulation as the start of another with other meshes --------------------------

typedef struct place {
    bough_vec3 position;   // in the axes of the rod's body [m]
    bough_quaternion turn; // of the section, from its undeformed one
} place;

static place place_of(const bough_simulation *s, const bough_beam *beam, int i) {
    bough_quaternion p, undeformed = bough_quaternion_conjugate(beam->def.rotation[i]);
    bough_vec3 position = bough_simulation_vertex(s, beam, i, &p);
    return (place){position, bough_quaternion_product(p, undeformed)};
}

// Place at a distance from the root, linear between vertices.
static place place_at(const bough_simulation *s, const bough_beam *beam, double span) {
    const bough_rod_model *m = beam->mesh;
    int k = 0;
    while (k + 1 < m->n_segment && span > m->span[k + 1]) k++;
    double part = (span - m->span[k]) / (m->span[k + 1] - m->span[k]);
    place a = place_of(s, beam, k), b = place_of(s, beam, k + 1);
    bough_mat3 axes = bough_rotation_matrix(bough_rotation_between(a.turn, b.turn, part));
    return (place){bough_between(a.position, b.position, part), bough_quaternion_of_matrix(axes)};
}

static void shape_rod(const bough_simulation *from, const bough_beam *given, const bough_beam *beam,
                      double *state) {
    const bough_rod_model *m = beam->mesh;
    int n = m->n;
    memset(state, 0, (size_t)BOUGH_ROD_STATES * (size_t)n * sizeof *state);
    for (int i = 0; i < n; i++) {
        place x = place_at(from, given, m->span[i + 1]);
        bough_quaternion p = bough_quaternion_product(x.turn, m->rotation0[i + 1]);
        const double row[BOUGH_ROD_U] = {x.position.x, x.position.y, x.position.z, p.w, p.x, p.y, p.z};
        for (int c = 0; c < BOUGH_ROD_U; c++) state[c * n + i] = row[c];
    }
}

void bough_simulation_take_shape(const bough_simulation *from, bough_simulation *to) {
    size_t joints = (size_t)to->leader.system.n_state;
    memcpy(to->leader.state, from->leader.state, joints * sizeof(double));
    for (int k = 0; k < to->n_beam; k++) {
        const bough_beam *beam = &to->beam[k];
        if (beam->rod) shape_rod(from, &from->beam[k], beam, to->rod[beam->port].state);
    }
    bough_simulation_update(to);
}
