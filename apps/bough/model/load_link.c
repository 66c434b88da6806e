#include "apps/bough/model/load_link.h"

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
    const double values[6] = {force.x, force.y, force.z, moment.x, moment.y, moment.z};
    memcpy(wrench, values, sizeof values);
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

// Those that turn in the body come last: others of the same ramp are summed, as these must not be.
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
