// The scene's loads on rods, lumped to their vertices; its springs, bushings, closures, applied wrenches and
// recorded points as parts of the tree.
#include "apps/bough/model/build_internal.h"

#include "flexbody/rod/rod_load.h"

#include <string.h>

static bough_rod_reach reach_of(const bough_scene_load *load, const bough_rod_model *m) {
    switch ((bough_scene_load_place)load->place) {
    case BOUGH_SCENE_AT_VERTEX: return (bough_rod_reach){m->span[load->vertex], m->span[load->vertex]};
    case BOUGH_SCENE_AT_SPAN: return (bough_rod_reach){load->span[0], load->span[0]};
    case BOUGH_SCENE_ALONG: return (bough_rod_reach){load->span[0], load->span[1]};
    case BOUGH_SCENE_AT_TIP: break;
    }
    return (bough_rod_reach){m->span[m->n_segment], m->span[m->n_segment]};
}

// Force and moment in the axes that the rod wants.
static void resolve(const bough_simulation *s, const bough_beam *beam, const bough_scene_load *load,
                    const double *f, const double *l, double wrench[6]) {
    bough_vec3 force = {f[0], f[1], f[2]}, moment = {l[0], l[1], l[2]};
    if (load->frame == BOUGH_SCENE_LOAD_GROUND) {
        bough_mat3 r = bough_tree_frame_pose(s->view, &s->tree->markers[beam->marker]).rotation;
        force = bough_mat3_tmul(r, force);
        moment = bough_mat3_tmul(r, moment);
    }
    bough_wrench_store((bough_wrench){force, moment}, wrench);
}

static void add_ground(bough_arena *arena, const bough_beam *beam, const bough_scene_load *load) {
    bough_ground_load_def def = {.reach = reach_of(load, bough_beam_mesh(beam)),
                                 .schedule = bough_scene_load_schedule(load)};
    for (int c = 0; c < 3; c++) {
        def.wrench[c] = load->force[c], def.wrench[3 + c] = load->moment[c];
        def.end[c] = load->end_force[c], def.end[3 + c] = load->end_moment[c];
    }
    bough_ground_body_load(beam->ground, arena, &def);
}

static void add(bough_arena *arena, const bough_simulation *s, const bough_beam *beam,
                const bough_scene_load *load) {
    const bough_rod_model *m = bough_beam_mesh(beam);
    bool follower = load->frame == BOUGH_SCENE_LOAD_FOLLOWER;
    bough_schedule schedule = bough_scene_load_schedule(load);
    bough_rod_ramped_load *to = bough_rod_loads_ramped(bough_beam_loads(beam), arena, m, follower, &schedule);
    double wrench[6], end[6];
    resolve(s, beam, load, load->force, load->moment, wrench);
    resolve(s, beam, load, load->end_force, load->end_moment, end);
    bool tapered = memcmp(wrench, end, sizeof end) != 0;
    bough_rod_lump(m, reach_of(load, m), wrench, tapered ? end : NULL, to);
    if (beam->modal != NULL) bough_rod_lump_line(m, to);
}

// Loads in ground axes on a body that moves come last: loads of the same ramp in body axes are summed before.
bough_status bough_load_link_build(bough_arena *arena, bough_simulation *s) {
    for (int pass = 0; pass < 2; pass++) {
        for (int k = 0; k < s->scene->n_load; k++) {
            const bough_scene_load *load = &s->scene->load[k];
            if (load->body_name == NULL) continue;
            if (s->scene->body[load->body].fidelity == BOUGH_SCENE_RIGID) continue; // force_link.h
            const bough_beam *beam = bough_simulation_beam(s, load->body);
            bool turns = beam->in_ground && load->frame == BOUGH_SCENE_LOAD_GROUND;
            if (turns != (pass == 1)) continue;
            if (turns)
                add_ground(arena, beam, load);
            else
                add(arena, s, beam, load);
        }
    }
    return bough_ok();
}

// -- springs, bushings, closures, applied wrenches, recorded points -------------------------------

void bough_force_link_take(bough_arena *arena, const bough_scene *scene, int n_beam, bough_force_link *link) {
    size_t springs = (size_t)scene->n_spring, bushings = (size_t)scene->n_bushing;
    size_t closures = (size_t)scene->n_closure, loads = (size_t)scene->n_load;
    size_t markers =
        (size_t)n_beam + 2 * (springs + bushings + closures) + loads + (size_t)scene->n_marker + 1;
    link->marker = bough_arena_take(arena, markers * sizeof *link->marker);
    link->spring = bough_arena_take(arena, springs * sizeof *link->spring);
    link->bushing = bough_arena_take(arena, bushings * sizeof *link->bushing);
    link->closure = bough_arena_take(arena, closures * sizeof *link->closure);
    link->applied = bough_arena_take(arena, loads * sizeof *link->applied);
}

static bough_vec3 point(const double x[3]) { return bough_v3(x[0], x[1], x[2]); }

// The index of a new marker at a point of a body.
static int add_marker(bough_force_link *link, const char *name, int body, const double at[3]) {
    bough_marker_def *marker = &link->marker[link->n_marker];
    *marker = (bough_marker_def){name, body, bough_transform_identity()};
    marker->placement.position = point(at);
    return link->n_marker++;
}

static void add_springs(const bough_scene *scene, bough_force_link *link) {
    for (int k = 0; k < scene->n_spring; k++) {
        const bough_scene_spring *from = &scene->spring[k];
        link->spring[k] = from->def;
        for (int end = 0; end < 2; end++)
            link->spring[k].marker[end] = add_marker(link, from->name, from->body[end], from->point[end]);
    }
}

static void add_bushings(const bough_scene *scene, bough_force_link *link) {
    for (int k = 0; k < scene->n_bushing; k++) {
        const bough_scene_bushing *from = &scene->bushing[k];
        link->bushing[k] = from->def;
        for (int end = 0; end < 2; end++)
            link->bushing[k].marker[end] = add_marker(link, from->name, from->body[end], from->point);
    }
}

static void add_closures(const bough_scene *scene, bough_force_link *link) {
    static const double origin[3];
    for (int k = 0; k < scene->n_closure; k++) {
        const bough_scene_closure *from = &scene->closure[k];
        bough_closure_def *to = &link->closure[k];
        to->name = from->name;
        to->kind = (bough_joint_kind)from->kind;
        to->axis = bough_placement_axis(from->axis);
        to->second_axis = bough_placement_axis(from->second_axis);
        for (int end = 0; end < 2; end++) {
            const bough_scene_placement *steps = &from->placement[end];
            to->marker[end] = add_marker(link, from->name, from->body[end], origin);
            link->marker[to->marker[end]].placement = bough_placement(steps->n, steps->step);
        }
    }
}

static void add_wrenches(const bough_scene *scene, bough_force_link *link) {
    for (int k = 0; k < scene->n_load; k++) {
        const bough_scene_load *load = &scene->load[k];
        if (load->body_name == NULL || scene->body[load->body].fidelity != BOUGH_SCENE_RIGID) {
            continue;
        }
        int marker = add_marker(link, load->body_name, load->body, load->point);
        link->applied[link->n_applied++] =
            (bough_applied_def){.marker = marker,
                                .wrench = {point(load->force), point(load->moment)},
                                .ground = load->frame == BOUGH_SCENE_LOAD_GROUND,
                                .schedule = bough_scene_load_schedule(load)};
    }
}

void bough_force_link_fill(const bough_scene *scene, bough_force_link *link) {
    add_springs(scene, link);
    add_bushings(scene, link);
    add_closures(scene, link);
    add_wrenches(scene, link);
    link->first_own = link->n_marker;
    for (int k = 0; k < scene->n_marker; k++) {
        const bough_scene_marker *from = &scene->marker[k];
        add_marker(link, from->name, from->body, from->point);
    }
    static const double origin[3];
    link->hub = -1;
    if (scene->aero.node != NULL && scene->aero.hub_drag_area > 0) {
        link->hub = add_marker(link, "hub", scene->turbine.rotor, origin);
    }
}

void bough_force_link_rest(const bough_scene *scene, const bough_tree_data *data, bough_tree *tree) {
    for (int k = 0; k < scene->n_bushing; k++) {
        const int *marker = tree->bushings[k].marker;
        bough_transform pose = bough_tree_frame_pose(data, &tree->markers[marker[0]]);
        bough_frame *second = &tree->markers[marker[1]];
        if (second->link >= 0) {
            bough_transform back = bough_transform_inverse(data->pose[second->link]);
            pose = bough_transform_compose(back, pose);
        }
        second->placement = pose;
    }
}
