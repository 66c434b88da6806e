// The flexible body of a beam: its rod or the rod reduced to modes, and what both have in common.
#include "apps/simulation/build.h"
#include "flexbody/rod_linear.h"

static bough_status build_rod(bough_arena *arena, bough_beam *beam, bough_integrator_options micro,
                              const double *input, bough_subsystem *subsystem) {
    bough_rod_model *model = NULL;
    bough_status status = bough_rod_create(arena, &beam->def, &model);
    if (!bough_is_ok(&status)) return status;
    status = bough_rod_body_create(arena, model, 0, micro, input, &beam->rod);
    if (bough_is_ok(&status)) *subsystem = bough_rod_body_subsystem(beam->rod);
    return status;
}

bough_status bough_beam_build(bough_arena *arena, bough_beam *beam, bough_integrator_options micro,
                              const double *input, bough_subsystem *subsystem) {
    const bough_scene_modal *modal = &beam->body->modal;
    if (beam->body->fidelity == BOUGH_SCENE_ROD) {
        return build_rod(arena, beam, micro, input, subsystem);
    }
    int pieces = beam->body->fidelity == BOUGH_SCENE_MODAL ? 1 : modal->pieces;
    bough_modal_options options = {modal->modes, modal->statics, modal->stiffening};
    bough_modal_model *model = NULL;
    bough_status status = bough_modal_create(arena, &beam->def, pieces, options, &model);
    if (!bough_is_ok(&status)) return status;
    status = bough_modal_body_create(arena, model, 0, micro, input, &beam->modal);
    if (bough_is_ok(&status)) *subsystem = bough_modal_body_subsystem(beam->modal);
    return status;
}

const bough_rod_model *bough_beam_mesh(const bough_beam *beam) {
    return beam->rod != NULL ? bough_rod_body_model(beam->rod) : bough_modal_body_rod(beam->modal);
}

bough_rod_loads *bough_beam_loads(const bough_beam *beam) {
    return beam->rod != NULL ? bough_rod_body_loads(beam->rod)
                             : bough_modal_body_loads(beam->modal);
}

const double *bough_beam_state(const bough_simulation *s, const bough_beam *beam, int first) {
    const double *state = s->rod[beam->port].state;
    if (beam->rod != NULL) return state;
    double input[BOUGH_ROD_INPUTS] = {0}; // gravity does not matter
    bough_twist_store(bough_tree_frame_twist(s->view, &s->tree->markers[beam->marker]), input);
    return bough_modal_body_vertices(beam->modal, state, input, first);
}

void bough_beam_ride(const bough_beam *beam, const double *input, double *state) {
    if (beam->rod != NULL) {
        bough_rod_ride(bough_rod_body_model(beam->rod), input, state);
    } else {
        bough_modal_body_ride(beam->modal, input, state);
    }
}
