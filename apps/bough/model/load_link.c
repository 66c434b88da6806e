// The scene's loads on rods, lumped to their vertices; its springs, bushings, closures, applied wrenches and
// recorded points as parts of the tree.
#include "apps/bough/model/build_internal.h"

#include "flexbody/rod/rod_load.h"

bough_rod_reach bough_load_reach(const bough_scene_load *load, const bough_rod_model *m) {
    switch ((bough_scene_load_place)load->place) {
    case BOUGH_SCENE_AT_VERTEX: return (bough_rod_reach){m->span[load->vertex], m->span[load->vertex]};
    case BOUGH_SCENE_AT_SPAN: return (bough_rod_reach){load->span[0], load->span[0]};
    case BOUGH_SCENE_ALONG: return (bough_rod_reach){load->span[0], load->span[1]};
    case BOUGH_SCENE_AT_TIP: break;
    }
    return (bough_rod_reach){m->span[m->n_segment], m->span[m->n_segment]};
}

// Force and moment in the axes in which the rod needs them.
static void resolve(const bough_simulation *s, const bough_beam *beam, const bough_scene_load *load,
                    const double given[6], double wrench[6]) {
    bough_wrench w = bough_wrench_load(given);
    if (load->frame == BOUGH_SCENE_LOAD_GROUND) {
        bough_mat3 r = bough_beam_pose(s, beam).rotation;
        w = (bough_wrench){bough_mat3_tmul(r, w.force), bough_mat3_tmul(r, w.moment)};
    }
    bough_wrench_store(w, wrench);
}

// Both give the schedule that the rod has.
static const bough_schedule *add_ground(bough_arena *arena, const bough_beam *beam,
                                        const bough_scene_load *load) {
    bough_ground_load_def def = {.reach = bough_load_reach(load, beam->mesh),
                                 .schedule = bough_scene_load_schedule(load)};
    memcpy(def.wrench, load->wrench, sizeof def.wrench);
    memcpy(def.end, load->end, sizeof def.end);
    bough_ground_body_load(beam->ground, arena, &def);
    return &beam->loads->ramped->schedule;
}

static const bough_schedule *add(bough_arena *arena, const bough_simulation *s, const bough_beam *beam,
                                 const bough_scene_load *load) {
    const bough_rod_model *m = beam->mesh;
    bool follower = load->frame == BOUGH_SCENE_LOAD_FOLLOWER;
    bough_schedule schedule = bough_scene_load_schedule(load);
    bough_rod_ramped_load *to = bough_rod_loads_ramped(beam->loads, arena, m, follower, &schedule);
    double wrench[6], end[6];
    resolve(s, beam, load, load->wrench, wrench);
    resolve(s, beam, load, load->end, end);
    bool tapered = memcmp(wrench, end, sizeof end) != 0;
    bough_rod_lump(m, bough_load_reach(load, m), wrench, tapered ? end : NULL, to);
    if (beam->modal != NULL) bough_rod_lump_line(m, to);
    return &to->schedule;
}

// Loads in ground axes on a body that moves come last: loads of the same ramp in body axes are summed before.
void bough_load_link_build(bough_arena *arena, bough_simulation *s) {
    s->load_schedule = bough_arena_take(arena, (size_t)s->scene->n_load * sizeof *s->load_schedule);
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < s->scene->n_load; k++) {
            const bough_scene_load *load = &s->scene->load[k];
            if (load->body_name == NULL) continue;
            if (s->scene->body[load->body].fidelity == BOUGH_SCENE_RIGID) continue; // add_wrenches
            const bough_beam *beam = bough_simulation_beam(s, load->body);
            bool turns = beam->in_ground && load->frame == BOUGH_SCENE_LOAD_GROUND;
            if (turns != (pass == 1)) continue;
            s->load_schedule[k] = turns ? add_ground(arena, beam, load) : add(arena, s, beam, load);
        }
    }
}

// -- loads that jump ------------------------------------------------------------------------------

// A ramp of the model, whose times are set to 0 when the load acts, and to infinity before.
typedef struct jump {
    double at; // [s]
    bough_schedule *ramp;
} jump;

typedef struct jumps {
    int n;
    jump *jump; // (n)
} jumps;

static void add_jump(jumps *j, bough_schedule *ramp) {
    if (ramp->start > 0 && ramp->end <= ramp->start) j->jump[j->n++] = (jump){ramp->start, ramp};
}

static void begin(void *self, double t) {
    const jumps *j = self;
    for (int k = 0; k < j->n; k++)
        j->jump[k].ramp->start = j->jump[k].ramp->end = t >= j->jump[k].at ? 0 : HUGE_VAL;
}

void bough_jump_link_build(bough_arena *arena, bough_simulation *s) {
    jumps *j = bough_arena_take(arena, sizeof *j);
    j->jump = bough_arena_take(arena, (size_t)s->scene->n_load * sizeof *j->jump);
    for (int k = 0; k < s->tree->n_loads; k++) add_jump(j, &s->tree->loads[k].schedule);
    for (int k = 0; k < s->tree->n_applied; k++) add_jump(j, &s->tree->applied[k].schedule);
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].port < 0) continue;
        bough_rod_ramped_load *l = s->beam[k].loads->ramped;
        for (; l != NULL; l = l->next) add_jump(j, &l->schedule);
    }
    s->jumps = j->n > 0;
    if (!s->jumps) return;
    s->sampled[s->n_sampled++] =
        (bough_sampled_load){.period = s->scene->simulation.macro_step, .self = j, .begin = begin};
}

// -- springs, bushings, closures, applied wrenches, recorded points -------------------------------

static bough_transform at(const double x[3]) {
    return (bough_transform){bough_v3_load(x), bough_mat3_identity()};
}

// The marker of an end of a connector.
static int add_marker(bough_builder *b, const bough_scene_connector *c, int end, bough_transform placement) {
    return bough_build_marker(b, c->name, c->body[end], placement);
}

static void add_connectors(bough_builder *b) {
    const int *n = b->scene->n_connector;
    bough_spring_def *spring = bough_arena_take(b->arena, (size_t)n[BOUGH_SCENE_SPRING] * sizeof *spring);
    bough_bushing_def *bushing = bough_arena_take(b->arena, (size_t)n[BOUGH_SCENE_BUSHING] * sizeof *bushing);
    bough_closure_def *closure = bough_arena_take(b->arena, (size_t)n[BOUGH_SCENE_CLOSURE] * sizeof *closure);
    for (int k = 0; k < n[BOUGH_SCENE_SPRING]; k++) {
        const bough_scene_connector *c = &b->scene->connector[BOUGH_SCENE_SPRING][k];
        spring[k] = c->spring;
        for (int end = 0; end < 2; end++) spring[k].marker[end] = add_marker(b, c, end, at(c->point[end]));
    }
    for (int k = 0; k < n[BOUGH_SCENE_BUSHING]; k++) {
        const bough_scene_connector *c = &b->scene->connector[BOUGH_SCENE_BUSHING][k];
        bushing[k] = c->bushing;
        for (int end = 0; end < 2; end++) bushing[k].marker[end] = add_marker(b, c, end, at(c->point[0]));
    }
    for (int k = 0; k < n[BOUGH_SCENE_CLOSURE]; k++) {
        const bough_scene_connector *c = &b->scene->connector[BOUGH_SCENE_CLOSURE][k];
        closure[k] = (bough_closure_def){.name = c->name,
                                         .kind = (bough_joint_kind)c->kind,
                                         .axis = bough_unit3(c->axis),
                                         .second_axis = bough_unit3(c->second_axis)};
        for (int end = 0; end < 2; end++) closure[k].marker[end] = add_marker(b, c, end, c->placement[end]);
    }
    b->tree.springs = spring, b->tree.n_springs = n[BOUGH_SCENE_SPRING];
    b->tree.bushings = bushing, b->tree.n_bushings = n[BOUGH_SCENE_BUSHING];
    b->tree.closures = closure, b->tree.n_closures = n[BOUGH_SCENE_CLOSURE];
}

static void add_wrenches(bough_builder *b) {
    bough_applied_def *applied = bough_arena_take(b->arena, (size_t)b->scene->n_load * sizeof *applied);
    b->tree.applied = applied;
    for (int k = 0; k < b->scene->n_load; k++) {
        const bough_scene_load *load = &b->scene->load[k];
        if (load->body_name == NULL || b->scene->body[load->body].fidelity != BOUGH_SCENE_RIGID) continue;
        applied[b->tree.n_applied++] =
            (bough_applied_def){.marker = bough_build_marker(b, load->body_name, load->body, at(load->point)),
                                .wrench = bough_wrench_load(load->wrench),
                                .ground = load->frame == BOUGH_SCENE_LOAD_GROUND,
                                .schedule = bough_scene_load_schedule(load)};
    }
}

void bough_build_forces(bough_builder *b) {
    const bough_scene *scene = b->scene;
    add_connectors(b);
    add_wrenches(b);
    b->s->first_marker = b->tree.n_markers;
    for (int k = 0; k < scene->n_marker; k++) {
        const bough_scene_marker *from = &scene->marker[k];
        bough_build_marker(b, from->name, from->body, at(from->point));
    }
    if (scene->aero.node != NULL && scene->aero.hub_drag_area > 0)
        bough_build_marker(b, "hub", scene->turbine.rotor, bough_transform_identity());
}

void bough_build_rest(const bough_simulation *s) {
    for (int k = 0; k < s->tree->n_bushings; k++) {
        const int *marker = s->tree->bushings[k].marker;
        bough_transform pose = bough_tree_frame_pose(s->view, &s->tree->markers[marker[0]]);
        bough_frame *second = &s->tree->markers[marker[1]];
        if (second->link >= 0) {
            bough_transform back = bough_transform_inverse(s->view->pose[second->link]);
            pose = bough_transform_compose(back, pose);
        }
        second->placement = pose;
    }
}
