#include "apps/bough/model/aero_link.h"

// The tower's forces are on vertices in the body's axes, (3 × vertices) of a rod, or the resultant
// (6) on a rigid body; then come the hub's, (6) in the rotor's axes.
struct bough_drag_link {
    bough_simulation *simulation;
    const bough_rotor *rotor;
    const bough_beam *tower; // NULL: none
    int hub_marker;          // −1: none
    int n_vertex, n_tower, n;
    bough_vertex_motion *vertex; // of the tower
    double *fresh;               // (n) at this sample
    double *memory;              // (2 n + 2): value and rate of the signals, start, started
};

// -- sample ---------------------------------------------------------------------------------------

// The length of the tower that belongs to a vertex [m].
static double length_of(const bough_beam *tower, int i) {
    const double *s = tower->def.span;
    int low = i > 0 ? i - 1 : 0, high = i < tower->def.n_segment ? i + 1 : i;
    return (s[high] - s[low]) / 2;
}

static void sample_tower(bough_drag_link *l, double t, double factor) {
    bough_simulation *s = l->simulation;
    bough_mat3 axes = bough_beam_pose(s, l->tower).rotation;
    int n = l->n_vertex;
    bough_simulation_beam_motion(s, l->tower, l->vertex);
    if (l->tower->port < 0) memset(l->fresh, 0, 6 * sizeof *l->fresh);
    for (int i = 0; i < n; i++) {
        const bough_vertex_motion *v = &l->vertex[i];
        bough_vec3 f = bough_rotor_tower_drag(l->rotor, v->position, v->rotation.c3, v->velocity, t);
        f = bough_mat3_tmul(axes, bough_scale(factor * length_of(l->tower, i), f));
        if (l->tower->port >= 0) {
            l->fresh[i] = f.x, l->fresh[n + i] = f.y, l->fresh[2 * n + i] = f.z;
            continue;
        }
        double values[6];
        bough_wrench_store((bough_wrench){f, bough_cross(l->tower->def.position[i], f)}, values);
        for (int c = 0; c < 6; c++) l->fresh[c] += values[c];
    }
}

static void sample_hub(bough_drag_link *l, double t, double factor) {
    bough_simulation *s = l->simulation;
    const bough_frame *frame = &s->tree->markers[l->hub_marker];
    bough_transform pose = bough_tree_frame_pose(s->view, frame);
    bough_vec3 velocity = bough_tree_frame_velocity(s->view, frame).linear;
    bough_vec3 f = bough_rotor_hub_drag(l->rotor, s->scene->aero.hub_drag_area, pose.position, velocity, t);
    f = bough_mat3_tmul(pose.rotation, bough_scale(factor, f));
    bough_wrench_store((bough_wrench){f, {0, 0, 0}}, l->fresh + l->n_tower);
}

// Sets the signals on the bodies.
static void put(bough_drag_link *l) {
    const double *value = l->memory, *rate = value + l->n;
    double start = l->memory[2 * l->n];
    bough_tree *tree = l->simulation->tree;
    if (l->hub_marker >= 0) {
        bough_tree_set_wrench(tree, l->hub_marker, start, value + l->n_tower, rate + l->n_tower, NULL);
    }
    if (l->tower == NULL) return;
    if (l->tower->port < 0) {
        bough_tree_set_wrench(tree, l->tower->marker, start, value, rate, NULL);
        return;
    }
    bough_rod_loads *rod = l->tower->loads;
    int stride = l->tower->mesh->stride;
    for (int k = 0; k < l->n_tower; k++) {
        int at = k / l->n_vertex * stride + k % l->n_vertex;
        rod->value[at] = value[k];
        rod->rate[at] = rate[k];
    }
    rod->start = start;
}

static bough_status sample(void *self, double t, double t_next, bool *jumped) {
    bough_drag_link *l = self;
    double *value = l->memory, *rate = value + l->n, *start = value + 2 * l->n, factor;
    bool started = start[1] != 0;
    bough_simulation_update(l->simulation);
    bough_aero_link_data(l->simulation->aero, &factor);
    if (l->tower != NULL) sample_tower(l, t, factor);
    if (l->hub_marker >= 0) sample_hub(l, t, factor);
    for (int k = 0; k < l->n; k++) {
        value[k] = started ? value[k] + (t - start[0]) * rate[k] : l->fresh[k];
        rate[k] = (l->fresh[k] - value[k]) / (t_next - t);
    }
    start[0] = t;
    start[1] = 1;
    put(l);
    *jumped = !started;
    return bough_ok();
}

void bough_drag_link_hold(bough_drag_link *link, double t) {
    bool jumped;
    double *started = link->memory + 2 * link->n + 1;
    *started = 0;
    sample(link, t, t + 1, &jumped); // constant, as there is no previous sample
    *started = 0;
}

static void snapshot(void *self, bough_snapshot *s) {
    bough_drag_link *link = self;
    bough_snapshot_doubles(s, link->memory, 2 * link->n + 2);
    if (s->move == BOUGH_SNAPSHOT_RESTORE && link->memory[2 * link->n + 1] != 0) put(link);
}

void bough_drag_link_build(bough_arena *arena, bough_simulation *simulation) {
    const bough_scene_aero *aero = &simulation->scene->aero;
    bool tower = aero->tower.body_name != NULL, hub = aero->hub_drag_area > 0;
    if (aero->node == NULL || !(tower || hub)) return;
    bough_drag_link *l = bough_arena_take(arena, sizeof *l);
    l->simulation = simulation;
    l->rotor = bough_aero_link_rotor(simulation->aero);
    l->hub_marker = hub ? simulation->first_marker + simulation->scene->n_marker : -1;
    if (tower) {
        l->tower = bough_simulation_beam(simulation, aero->tower.body);
        l->n_vertex = l->tower->def.n_segment + 1;
        l->n_tower = l->tower->port < 0 ? 6 : 3 * l->n_vertex;
        l->vertex = bough_arena_take(arena, (size_t)l->n_vertex * sizeof *l->vertex);
    }
    l->n = l->n_tower + 6;
    l->fresh = bough_arena_doubles(arena, (size_t)l->n);
    l->memory = bough_arena_doubles(arena, 2 * (size_t)l->n + 2);
    simulation->drag = l;
    simulation->sampled[simulation->n_sampled++] =
        (bough_sampled_load){.period = 1 / aero->rate, .self = l, .sample = sample, .snapshot = snapshot};
}
