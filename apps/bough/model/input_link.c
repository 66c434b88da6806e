#include "apps/bough/model/input_link.h"

#include "apps/bough/model/aero_link.h"

#include <string.h>

struct bough_input_link {
    bough_simulation *simulation;
    int n;
    double **table; // (n) of a load: the two values of its table; NULL of others
    double *memory; // (5 n): values, values handed on, point reached of each motion
};

static bough_motion_point *points(bough_input_link *l) {
    return (bough_motion_point *)(void *)(l->memory + 2 * l->n);
}

static double *writable(const double *values) { return (double *)values; }

// The two values of a load's table where the model has them: loads on rods read the scene's.
static double *table_of(const bough_simulation *s, int index) {
    const bough_scene *scene = s->scene;
    const bough_scene_load *load = &scene->load[index];
    int on_joints = 0, on_bodies = 0;
    for (int k = 0; k < index; k++) {
        const bough_scene_load *x = &scene->load[k];
        if (x->body_name == NULL) {
            on_joints++;
        } else if (scene->body[x->body].fidelity == BOUGH_SCENE_RIGID) {
            on_bodies++;
        }
    }
    if (load->body_name == NULL) return writable(s->tree->loads[on_joints].schedule.values);
    if (scene->body[load->body].fidelity == BOUGH_SCENE_RIGID) {
        return writable(s->tree->applied[on_bodies].schedule.values);
    }
    return load->values;
}

bough_status bough_input_link_build(bough_arena *arena, bough_simulation *s) {
    int n = s->scene->n_input;
    if (n == 0) return bough_ok();
    bough_input_link *l = bough_arena_take(arena, sizeof *l);
    *l = (bough_input_link){s, n, bough_arena_take(arena, (size_t)n * sizeof *l->table),
                            bough_arena_doubles(arena, 5 * (size_t)n)};
    for (int k = 0; k < n; k++) {
        const bough_scene_input *input = &s->scene->input[k];
        l->memory[k] = l->memory[n + k] = input->initial;
        if (input->kind == BOUGH_INPUT_LOAD) l->table[k] = table_of(s, input->index);
        if (input->kind == BOUGH_INPUT_MOTION) points(l)[k] = bough_simulation_joint_point(s, input->index);
    }
    s->inputs = l;
    return bough_ok();
}

double *bough_input_link_values(bough_input_link *link) { return link->memory; }

bool bough_input_link_put(bough_input_link *link, int k, double value) {
    if (link->table[k] == NULL) return false;
    link->table[k][0] = link->table[k][1] = value;
    return true;
}

static void move_joint(bough_input_link *l, int k, double t, double t_next) {
    bough_motion_point from = points(l)[k], to = {l->memory[k], 0, 0};
    to.v = (to.q - from.q) / (t_next - t);
    bough_tree_steer(l->simulation->tree, l->simulation->scene->input[k].index, t, t_next - t, from, to);
    points(l)[k] = to;
}

static bough_status sample(void *self, double t, double t_next, bool *jumped) {
    bough_input_link *l = self;
    *jumped = false;
    for (int k = 0; k < l->n; k++) {
        bough_scene_input_kind kind = l->simulation->scene->input[k].kind;
        double value = l->memory[k], *handed = &l->memory[l->n + k];
        bool changed = value != *handed;
        *handed = value;
        if (kind == BOUGH_INPUT_LOAD) l->table[k][0] = l->table[k][1] = value;
        if (kind == BOUGH_INPUT_MOTION) move_joint(l, k, t, t_next);
        if (kind == BOUGH_INPUT_WIND && changed) bough_aero_link_set_wind(l->simulation->aero, value);
        bool at_once = kind == BOUGH_INPUT_LOAD || kind == BOUGH_INPUT_WIND;
        *jumped = *jumped || (changed && at_once);
    }
    return bough_ok();
}

bough_sampled_load bough_input_link_load(bough_input_link *link, double macro_step) {
    return (bough_sampled_load){.period = macro_step, .self = link, .sample = sample};
}

void bough_input_link_snapshot(bough_input_link *link, bough_snapshot *s) {
    bough_snapshot_doubles(s, link->memory, 5 * link->n);
    if (s->move != BOUGH_SNAPSHOT_RESTORE) return;
    for (int k = 0; k < link->n; k++) {
        double value = link->memory[link->n + k];
        if (link->table[k] != NULL) link->table[k][0] = link->table[k][1] = value;
        if (link->simulation->scene->input[k].kind == BOUGH_INPUT_WIND)
            bough_aero_link_set_wind(link->simulation->aero, value);
    }
}
