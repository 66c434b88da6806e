#include "apps/bough/model/input_link.h"

#include "apps/bough/model/aero_link.h"

struct bough_input_link {
    bough_simulation *simulation;
    double *value, *handed;    // (n_input) now, and handed on
    bough_motion_point *point; // (n_input) that a motion has reached
};

void bough_input_link_build(bough_arena *arena, bough_simulation *s) {
    size_t n = (size_t)s->scene->n_input;
    if (n == 0) return;
    bough_input_link *l = s->inputs = bough_arena_take(arena, sizeof *l);
    l->simulation = s;
    l->point = bough_arena_take(arena, n * sizeof *l->point);
    bough_arena_each(arena, n, &l->value, &l->handed);
    for (size_t k = 0; k < n; k++) {
        const bough_scene_input *input = &s->scene->input[k];
        l->value[k] = l->handed[k] = input->initial;
        bough_input_link_put(l, (int)k, input->initial);
        if (input->kind == BOUGH_INPUT_MOTION) l->point[k] = bough_simulation_joint_point(s, input->index);
    }
}

double *bough_input_link_values(bough_input_link *link) { return link->value; }

// Tree and rods read the table of the scene.
void bough_input_link_put(const bough_input_link *link, int k, double value) {
    const bough_scene *scene = link->simulation->scene;
    if (scene->input[k].kind != BOUGH_INPUT_LOAD) return;
    double *table = scene->load[scene->input[k].index].values;
    table[0] = table[1] = value;
}

static void move_joint(bough_input_link *l, int k, double t, double t_next) {
    bough_motion_point from = l->point[k], to = {l->value[k], 0, 0};
    to.v = (to.q - from.q) / (t_next - t);
    bough_tree_steer(l->simulation->tree, l->simulation->scene->input[k].index, t, t_next - t, from, to);
    l->point[k] = to;
}

static bough_status sample(void *self, double t, double t_next, bool *jumped) {
    bough_input_link *l = self;
    *jumped = false;
    for (int k = 0; k < l->simulation->scene->n_input; k++) {
        bough_scene_input_kind kind = l->simulation->scene->input[k].kind;
        bool changed = l->value[k] != l->handed[k];
        l->handed[k] = l->value[k];
        bough_input_link_put(l, k, l->value[k]);
        if (kind == BOUGH_INPUT_MOTION) move_joint(l, k, t, t_next);
        if (kind == BOUGH_INPUT_WIND && changed) bough_aero_link_set_wind(l->simulation->aero, l->value[k]);
        bool at_once = kind == BOUGH_INPUT_LOAD || kind == BOUGH_INPUT_WIND;
        *jumped = *jumped || (changed && at_once);
    }
    return bough_ok();
}

bough_sampled_load bough_input_link_load(bough_input_link *link, double macro_step) {
    return (bough_sampled_load){.period = macro_step, .self = link, .sample = sample};
}

void bough_input_link_snapshot(bough_input_link *l, bough_snapshot *s) {
    int n = l->simulation->scene->n_input;
    bough_snapshot_doubles(s, l->value, n);
    bough_snapshot_doubles(s, l->handed, n);
    bough_snapshot_take(s, l->point, (size_t)n * sizeof *l->point);
    for (int k = 0; k < n && s->move == BOUGH_SNAPSHOT_RESTORE; k++) {
        bough_input_link_put(l, k, l->handed[k]);
        if (l->simulation->scene->input[k].kind == BOUGH_INPUT_WIND)
            bough_aero_link_set_wind(l->simulation->aero, l->handed[k]);
    }
}
