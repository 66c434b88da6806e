#include "apps/scene/blade_group.h"

#include <string.h>

static const double even = 1e-6; // [rad]

static bool same_structure(const bough_rod_def *a, const bough_rod_def *b) {
    size_t n = (size_t)a->n_segment;
    return a->n_segment == b->n_segment &&
           memcmp(a->stiffness, b->stiffness, 21 * n * sizeof *a->stiffness) == 0 &&
           memcmp(a->damping, b->damping, 21 * n * sizeof *a->damping) == 0 &&
           memcmp(a->position, b->position, (n + 1) * sizeof *a->position) == 0 &&
           memcmp(a->rotation, b->rotation, (n + 1) * sizeof *a->rotation) == 0 &&
           memcmp(a->inertia, b->inertia, (n + 1) * sizeof *a->inertia) == 0;
}

// Angle of a blade's span about the shaft from the upright, or from the ground's x where the shaft
// is upright, in [0, 2π).
static double azimuth_of(const bough_simulation *s, const bough_beam *blade) {
    int rotor = s->scene->turbine.rotor;
    bough_mat3 r = bough_tree_frame_pose(s->view, &s->tree->bodies[rotor]).rotation;
    const bough_vec3 axes[3] = {r.c1, r.c2, r.c3};
    bough_vec3 shaft = axes[s->scene->body[rotor].joint.axis], zero = bough_v3(0, 0, 1);
    if (fabs(shaft.z) > 0.9) zero = bough_v3(1, 0, 0);
    zero = bough_axpy(-bough_dot(zero, shaft), shaft, zero);
    bough_vec3 span = bough_tree_frame_pose(s->view, &s->tree->markers[blade->marker]).rotation.c3;
    double angle = atan2(bough_dot(span, bough_cross(shaft, zero)), bough_dot(span, zero));
    return angle < -even ? angle + 2 * BOUGH_PI : angle;
}

// The rotor's angular velocity along its shaft: of all joints that turn it.
static double spin_of(const bough_simulation *s) {
    int rotor = s->scene->turbine.rotor;
    bough_vec3 w = bough_tree_frame_twist(s->view, &s->tree->bodies[rotor]).angular;
    const double along[3] = {w.x, w.y, w.z};
    return along[s->scene->body[rotor].joint.axis];
}

// Inserts a blade by azimuth.
static void insert(const bough_simulation *s, const bough_beam *blade, bough_blade_group *group) {
    int k = group->n++;
    for (; k > 0 && azimuth_of(s, group->blade[k - 1]) > azimuth_of(s, blade); k--) {
        group->blade[k] = group->blade[k - 1];
    }
    group->blade[k] = blade;
}

static bool is_alike(const bough_simulation *s, const bough_blade_group *group, int k) {
    const bough_beam *first = group->blade[0], *blade = group->blade[k];
    int rotor = s->tree->bodies[s->scene->turbine.rotor].link;
    double angle = azimuth_of(s, blade) - azimuth_of(s, first) - 2 * BOUGH_PI * k / group->n;
    return blade->port >= 0 && blade->body->fidelity == first->body->fidelity &&
           s->rod[blade->port].n_state == s->rod[first->port].n_state &&
           s->tree->markers[blade->marker].link == rotor &&
           same_structure(&first->def, &blade->def) && fabs(angle) < even;
}

bough_status bough_blade_group_find(bough_arena *arena, const bough_simulation *s,
                                    const bough_assembly *assembly, bough_blade_group *group) {
    const bough_scene_turbine *turbine = &s->scene->turbine;
    int n = turbine->node == NULL ? 0 : turbine->n_blade;
    *group = (bough_blade_group){0};
    if (n == 0) return bough_ok();
    group->speed = spin_of(s);
    group->blade = bough_arena_take(arena, (size_t)n * sizeof *group->blade);
    group->first = bough_arena_take(arena, (size_t)n * sizeof *group->first);
    if (!group->blade || !group->first) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    for (int k = 0; k < n; k++) insert(s, bough_simulation_beam(s, turbine->blade[k]), group);
    bool alike = n >= 3;
    for (int k = 0; k < n; k++) alike = alike && is_alike(s, group, k);
    if (!alike) {
        group->n = 0;
        return bough_ok();
    }
    group->azimuth = azimuth_of(s, group->blade[0]);
    group->n_row = s->rod[group->blade[0]->port].n_state;
    group->row = bough_arena_take(arena, (size_t)n * (size_t)group->n_row * sizeof(int));
    if (!group->row) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    for (int k = 0; k < n; k++) {
        int member = group->blade[k]->port + 1, *row = group->row;
        group->first[k] = assembly->state_offset[member];
        for (int j = 0; j < group->n_row; j++) row[k * group->n_row + j] = group->first[k] + j;
    }
    return bough_ok();
}

void bough_blade_group_average(const bough_blade_group *group, double *state) {
    int n = group->n_row / BOUGH_ROD_STATES;
    double *mean = state + group->first[0];
    for (int j = 0; j < group->n_row; j++) {
        double sum = 0;
        for (int k = 0; k < group->n; k++) sum += state[group->first[k] + j];
        mean[j] = sum / group->n;
    }
    for (int i = 0; i < n && group->blade[0]->rod != NULL; i++) {
        double *p = mean + BOUGH_ROD_P * n + i;
        bough_quaternion unit =
            bough_quaternion_normalised((bough_quaternion){p[0], p[n], p[2 * n], p[3 * n]});
        p[0] = unit.w, p[n] = unit.x, p[2 * n] = unit.y, p[3 * n] = unit.z;
    }
    for (int k = 1; k < group->n; k++) {
        memcpy(state + group->first[k], mean, (size_t)group->n_row * sizeof *state);
    }
}
