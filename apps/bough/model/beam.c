// The flexible body of a beam: its rod or the rod reduced to modes, and what both have in common.
#include "apps/bough/model/simulation.h"
#include "flexbody/rod/rod_tangent.h"

static bough_status build_rod(bough_arena *arena, bough_beam *beam, const double *input,
                              bough_system *system) {
    bough_rod_model *model = NULL;
    BOUGH_TRY(bough_rod_create(arena, &beam->def, &model));
    beam->rod = bough_rod_body_create(arena, model, input);
    beam->mesh = model;
    beam->loads = bough_rod_body_loads(beam->rod);
    *system = bough_rod_body_system(beam->rod);
    return bough_ok();
}

static bough_status build_modal(bough_arena *arena, bough_beam *beam, const double *input,
                                bough_system *system) {
    const bough_scene_modal *modal = &beam->body->modal;
    int pieces = beam->body->fidelity == BOUGH_SCENE_MODAL ? 1 : modal->pieces;
    bough_modal_options options = {modal->modes, modal->statics, modal->stiffening};
    bough_modal_model *model = NULL;
    BOUGH_TRY(bough_modal_create(arena, &beam->def, pieces, options, &model));
    beam->modal = bough_modal_body_create(arena, model, input);
    beam->mesh = model->rod;
    beam->loads = bough_modal_body_loads(beam->modal);
    *system = bough_modal_body_system(beam->modal);
    return bough_ok();
}

bough_status bough_beam_build(bough_arena *arena, bough_beam *beam, bough_integrator_options micro,
                              const double *input, bough_member *member) {
    bool rod = beam->body->fidelity == BOUGH_SCENE_ROD;
    bough_system system = {0};
    BOUGH_TRY(rod ? build_rod(arena, beam, input, &system) : build_modal(arena, beam, input, &system));
    if (beam->in_ground) {
        beam->ground = bough_ground_body_create(arena, &system, beam->mesh, beam->loads, beam->modal != NULL);
        system = bough_ground_body_system(beam->ground);
    }
    return bough_member_create(arena, &system, 0, &micro, member);
}

const double *bough_beam_state(const bough_simulation *s, const bough_beam *beam, int first) {
    const double *state = s->rod[beam->port].state;
    if (beam->rod != NULL) return state;
    double input[BOUGH_ROD_INPUTS] = {0}; // gravity does not matter
    bough_twist_store(bough_tree_frame_twist(s->view, &s->tree->markers[beam->marker]), input);
    return bough_modal_body_vertices(beam->modal, state, input, first);
}

void bough_beam_move_rigidly(const bough_beam *beam, const double *input, double *state) {
    if (beam->rod != NULL) {
        bough_rod_move_rigidly(beam->mesh, input, state);
    } else {
        bough_modal_body_move_rigidly(beam->modal, input, state);
    }
}
