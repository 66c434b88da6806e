// The clamped blade of a study of blade models: equilibrium and frequencies of whatever models it.
#include "apps/bough/analysis/steady.h"
#include "flexbody/rod/rod_modes.h"
#include "tests/verification/blade_models_internal.h"
#include "tests/verification/modal_static.h"

bough_status bough_model_scene_sets(bough_arena *arena, const char *scene, const bough_model_sets *given,
                                    const bough_blade_model *model, bough_model_sets *sets) {
    bough_errors errors = {.arena = arena};
    bough_scene *read;
    BOUGH_TRY(bough_scene_read(arena, NULL, scene, given->item, given->n, &errors, &read));
    int most = given->n + model->set.n * read->n_body;
    sets->n = given->n;
    sets->item = bough_arena_take(arena, (size_t)(most + 1) * sizeof *sets->item);
    for (int k = 0; k < given->n; k++) sets->item[k] = given->item[k];
    for (int i = 0; i < read->n_body; i++) {
        bool beam = read->body[i].rod.node && read->body[i].fidelity != BOUGH_SCENE_RIGID;
        for (int k = 0; beam && k < model->set.n; k++) {
            char set[256];
            snprintf(set, sizeof set, "bodies[%d].%.200s", i, model->set.item[k]);
            sets->item[sets->n++] = bough_arena_string(arena, set);
        }
    }
    return bough_ok();
}

// Displacements of the vertices in a rod's state.
static void set_shape(const bough_rod_model *m, const double *y, bough_model_blade *blade) {
    int n = m->n;
    for (int i = 0; i <= n; i++) blade->span[i] = m->span[i];
    for (int i = 0; i < n; i++) {
        bough_quaternion p = {y[3 * n + i], y[4 * n + i], y[5 * n + i], y[6 * n + i]};
        bough_quaternion undeformed = bough_quaternion_conjugate(m->rotation0[i + 1]);
        bough_vec3 turn =
            bough_quaternion_logarithm(bough_quaternion_product(bough_quaternion_normalised(p), undeformed));
        blade->flap[i + 1] = y[i] - m->position0[i + 1].x;
        blade->twist[i + 1] = turn.z;
    }
}

static bough_status find_rod(bough_arena *arena, bough_simulation *s, const bough_beam *beam,
                             double *frequency, bough_model_blade *blade) {
    const bough_turning rest = {0};
    bough_rod_mode_list list = {.wanted = BOUGH_BLADE_MODELS_FREQUENCIES};
    bough_steady found;
    bough_status status = bough_steady_find(arena, s, beam, &rest, &found);
    if (bough_is_ok(&status)) {
        status = bough_rod_modes(arena, found.model, &found.work, found.input, found.state, &list);
    }
    if (!bough_is_ok(&status)) return status;
    for (int k = 0; k < list.found; k++) frequency[k] = list.mode[k].frequency;
    set_shape(found.model, found.state, blade);
    return status;
}

static bough_status find_modal(bough_arena *arena, bough_simulation *s, const bough_beam *beam,
                               double *frequency, bough_model_blade *blade) {
    const bough_modal_model *m = bough_modal_body_model(beam->modal);
    bough_transform pose = bough_tree_frame_pose(s->view, &s->tree->markers[beam->marker]);
    bough_vec3 g = bough_mat3_tmul(pose.rotation, s->tree->gravity);
    const double input[BOUGH_ROD_INPUTS] = {0, 0, 0, 0, 0, 0, g.x, g.y, g.z};
    double time = s->scene->simulation.duration; // loads have grown
    int found = 0;
    double *state = bough_arena_doubles(arena, (size_t)m->n_state);
    bough_status status = bough_modal_steady(beam->modal, time, input, arena, state);
    if (bough_is_ok(&status)) {
        status = bough_modal_frequencies(arena, beam->modal, time, input, state,
                                         BOUGH_BLADE_MODELS_FREQUENCIES, frequency, &found);
    }
    if (bough_is_ok(&status)) {
        set_shape(m->rod, bough_modal_body_vertices(beam->modal, state, input, 1), blade);
    }
    return status;
}

// Under these replacements; the first beam of the scene.
static bough_status find(bough_arena *arena, const char *path, const bough_model_sets *given,
                         const bough_blade_model *model, double *frequency, bough_model_blade *blade) {
    bough_errors errors = {.arena = arena};
    bough_model_sets sets;
    bough_scene *scene;
    bough_simulation *s;
    bough_status status = bough_model_scene_sets(arena, path, given, model, &sets);
    if (bough_is_ok(&status)) {
        status = bough_scene_read(arena, NULL, path, sets.item, sets.n, &errors, &scene);
    }
    if (errors.n > 0) bough_errors_print(&errors, stderr);
    if (bough_is_ok(&status)) status = bough_simulation_build(arena, scene, &s);
    BOUGH_TRY(status);
    if (s->n_rod == 0) return bough_fail(BOUGH_INVALID, "%.200s: nothing in it bends", path);
    const bough_beam *beam = s->beam;
    while (beam->port < 0) beam++;
    size_t vertices = (size_t)beam->def.n_segment + 1;
    blade->n = beam->def.n_segment;
    blade->n_state = s->rod[beam->port].system.n_state;
    blade->span = bough_arena_doubles(arena, vertices);
    blade->flap = bough_arena_doubles(arena, vertices);
    blade->twist = bough_arena_doubles(arena, vertices);
    return beam->rod ? find_rod(arena, s, beam, frequency, blade)
                     : find_modal(arena, s, beam, frequency, blade);
}

bough_status bough_model_blade_find(bough_arena *arena, const bough_blade_models *study,
                                    const bough_blade_model *model, bough_model_blade *blade) {
    const bough_model_sets none = {0, NULL};
    BOUGH_TRY(find(arena, study->blade, &none, model, blade->rest, blade));
    return find(arena, study->blade, &study->load, model, blade->bent, blade);
}
