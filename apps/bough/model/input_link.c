#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/build_internal.h"

typedef struct inputs {
    bough_simulation *simulation;
    double *applied;           // (n_input) values in effect
    bough_motion_point *point; // (n_input) reached by motions
} inputs;

// Tree and rods read the tables of the scene's loads.
void bough_simulation_put(const bough_simulation *s, int k, double value) {
    if (s->scene->input[k].kind != BOUGH_INPUT_LOAD) return;
    double *table = s->scene->load[s->scene->input[k].index].values;
    table[0] = table[1] = value;
}

static void move_joint(inputs *l, int k, double t, double t_next) {
    const bough_simulation *s = l->simulation;
    bough_motion_point from = l->point[k], to = {s->input[k], 0, 0};
    to.v = (to.q - from.q) / (t_next - t);
    bough_tree_steer(s->tree, s->scene->input[k].index, t, t_next - t, from, to);
    l->point[k] = to;
}

static bough_status sample(void *self, double t, double t_next, bool *jumped) {
    inputs *l = self;
    const bough_simulation *s = l->simulation;
    *jumped = false;
    for (int k = 0; k < s->scene->n_input; k++) {
        bough_scene_input_kind kind = s->scene->input[k].kind;
        bool changed = s->input[k] != l->applied[k];
        l->applied[k] = s->input[k];
        bough_simulation_put(s, k, s->input[k]);
        if (kind == BOUGH_INPUT_MOTION) move_joint(l, k, t, t_next);
        if (kind == BOUGH_INPUT_WIND && changed) bough_aero_link_set_wind(s->aero, s->input[k]);
        bool at_once = kind == BOUGH_INPUT_LOAD || kind == BOUGH_INPUT_WIND;
        *jumped = *jumped || (changed && at_once);
    }
    return bough_ok();
}

static void snapshot(void *self, bough_snapshot *copy) {
    inputs *l = self;
    const bough_simulation *s = l->simulation;
    int n = s->scene->n_input;
    bough_snapshot_doubles(copy, s->input, n);
    bough_snapshot_doubles(copy, l->applied, n);
    bough_snapshot_take(copy, l->point, (size_t)n * sizeof *l->point);
    for (int k = 0; k < n && copy->move == BOUGH_SNAPSHOT_RESTORE; k++) {
        bough_simulation_put(s, k, l->applied[k]);
        if (s->scene->input[k].kind == BOUGH_INPUT_WIND) bough_aero_link_set_wind(s->aero, l->applied[k]);
    }
}

void bough_input_link_build(bough_arena *arena, bough_simulation *s) {
    size_t n = (size_t)s->scene->n_input;
    if (n == 0) return;
    inputs *l = bough_arena_take(arena, sizeof *l);
    l->simulation = s;
    l->point = bough_arena_take(arena, n * sizeof *l->point);
    bough_arena_each(arena, n, &s->input, &l->applied);
    for (size_t k = 0; k < n; k++) {
        const bough_scene_input *input = &s->scene->input[k];
        s->input[k] = l->applied[k] = input->initial;
        bough_simulation_put(s, (int)k, input->initial);
        if (input->kind == BOUGH_INPUT_MOTION) l->point[k] = bough_simulation_joint_point(s, input->index);
    }
    s->sampled[s->n_sampled++] = (bough_sampled_load){
        .period = s->scene->simulation.macro_step, .self = l, .sample = sample, .snapshot = snapshot};
}
