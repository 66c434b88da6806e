#include "apps/bough/model/blade_group.h"

#include "apps/bough/model/section_loads.h"

static const double even = 1e-6; // [rad]

// In [0, 2π).
static double azimuth_of(const bough_simulation *s, const bough_beam *blade) {
    double angle = bough_simulation_azimuth(s, blade);
    return angle < -even ? angle + 2 * BOUGH_PI : angle;
}

// The angular velocity of the link that carries the blades, along the shaft.
static double spin_of(const bough_simulation *s, int hub) {
    const bough_frame frame = {.link = hub, .placement = bough_transform_identity()};
    bough_vec3 shaft = bough_simulation_joint_axis(s, s->scene->turbine.rotor);
    return bough_dot(bough_tree_frame_velocity(s->view, &frame).angular, shaft);
}

// Inserts a blade by azimuth.
static void insert(const bough_simulation *s, const bough_beam *blade, bough_blade_group *group) {
    int k = group->n++;
    for (; k > 0 && azimuth_of(s, group->blade[k - 1]) > azimuth_of(s, blade); k--) {
        group->blade[k] = group->blade[k - 1];
    }
    group->blade[k] = blade;
}

// The link that carries a blade, below its joints of prescribed motion.
static int hub_of(const bough_simulation *s, const bough_beam *blade) {
    const bough_tree *tree = s->tree;
    int link = tree->markers[blade->marker].link, rotor = tree->bodies[s->scene->turbine.rotor].link;
    while (link != rotor && link >= 0 && tree->links[link].motion != NULL) link = tree->links[link].parent;
    return link;
}

// Whether a link turns about the rotor's shaft; `length` is that of a blade.
static bool turns_about_shaft(const bough_simulation *s, int link, double length) {
    const bough_joint *joint = &s->tree->links[link].joint;
    const bough_transform *pose = &s->view->pose[link];
    bough_vec3 shaft = bough_simulation_joint_axis(s, s->scene->turbine.rotor);
    bough_vec3 centre = bough_body_pose(s, s->scene->turbine.rotor).position;
    bough_vec3 tilted = bough_cross(bough_mat3_mul(pose->rotation, joint->axis), shaft);
    bough_vec3 off = bough_cross(bough_sub(pose->position, centre), shaft);
    return joint->kind == BOUGH_JOINT_REVOLUTE && bough_norm(tilted) < even &&
           bough_norm(off) < even * length;
}

// Whether the link that carries the blades is the rotor or rotates about its axis, as at the end of an
// elastic shaft.
static bool is_on_shaft(const bough_simulation *s, int hub, double length) {
    int rotor = s->tree->bodies[s->scene->turbine.rotor].link;
    while (hub > rotor && turns_about_shaft(s, hub, length)) hub = s->tree->links[hub].parent;
    return hub == rotor;
}

// Difference of the pitch from that of the first blade, rotated by `angle` about the shaft [rad].
static double pitch_between(const bough_simulation *s, const bough_beam *first, const bough_beam *blade,
                            double angle) {
    bough_vec3 turn = bough_scale(angle, bough_simulation_joint_axis(s, s->scene->turbine.rotor));
    bough_mat3 p = bough_beam_pose(s, first).rotation;
    bough_mat3 q = bough_beam_pose(s, blade).rotation;
    bough_mat3 moved = bough_rotation_matrix(bough_quaternion_exponential(turn));
    return bough_norm(bough_sub(q.c1, bough_mat3_mul(moved, p.c1)));
}

static bool is_alike(const bough_simulation *s, const bough_blade_group *group, int k) {
    const bough_beam *first = group->blade[0], *blade = group->blade[k];
    int hub = hub_of(s, first);
    double angle = azimuth_of(s, blade) - azimuth_of(s, first) - 2 * BOUGH_PI * k / group->n;
    return blade->port >= 0 && blade->body->fidelity == first->body->fidelity &&
           s->rod[blade->port].system.n_state == s->rod[first->port].system.n_state &&
           hub_of(s, blade) == hub &&
           is_on_shaft(s, hub, bough_norm(blade->def.position[blade->def.n_segment])) &&
           first->def.stiffness == blade->def.stiffness && // equal beams have one mesh
           fabs(angle) < even && pitch_between(s, first, blade, 2 * BOUGH_PI * k / group->n) < even;
}

bough_status bough_blade_group_find(bough_arena *arena, const bough_simulation *s, bough_blade_group *group) {
    const bough_scene_turbine *turbine = &s->scene->turbine;
    int n = turbine->node == NULL ? 0 : turbine->n_blade;
    *group = (bough_blade_group){0};
    if (n == 0) return bough_ok();
    group->blade = bough_arena_take(arena, (size_t)n * sizeof *group->blade);
    group->first = bough_arena_take(arena, (size_t)n * sizeof *group->first);
    group->first_input = bough_arena_take(arena, (size_t)n * sizeof *group->first_input);
    for (int k = 0; k < n; k++) insert(s, bough_simulation_blade(s, k), group);
    group->speed = spin_of(s, hub_of(s, group->blade[0]));
    bool alike = n >= 3;
    for (int k = 0; k < n; k++) alike = alike && is_alike(s, group, k);
    if (!alike) {
        group->n = 0;
        return bough_ok();
    }
    group->azimuth = azimuth_of(s, group->blade[0]);
    group->n_row = s->rod[group->blade[0]->port].system.n_state;
    group->row = bough_arena_take(arena, (size_t)n * (size_t)group->n_row * sizeof(int));
    for (int k = 0; k < n; k++) {
        const bough_beam *blade = group->blade[k];
        group->first[k] = bough_beam_row(s, blade);
        group->first_input[k] = s->assembly->input_offset[blade->port + 1];
        for (int j = 0; j < group->n_row; j++) group->row[k * group->n_row + j] = group->first[k] + j;
    }
    return bough_ok();
}

// Position and rotation of a rod's vertex in its body's frame; the root is held.
static void vertex_of(const bough_rod_model *m, const double *y, int i, bough_vec3 *x, bough_quaternion *p) {
    int n = m->n, at = i - 1;
    *x = m->position0[0];
    *p = m->rotation0[0];
    if (i == 0) return;
    *x = bough_v3(y[at], y[n + at], y[2 * n + at]);
    *p = bough_quaternion_normalised(
        (bough_quaternion){y[3 * n + at], y[4 * n + at], y[5 * n + at], y[6 * n + at]});
}

// The chord from vertex i − 1 to i in the frame halfway, mean over the blades.
static bough_vec3 mean_chord(const bough_blade_group *group, const bough_rod_model *m, int i,
                             const double *state) {
    bough_vec3 sum = {0, 0, 0}, x[2];
    bough_quaternion p[2];
    for (int k = 0; k < group->n; k++) {
        for (int end = 0; end < 2; end++) {
            vertex_of(m, state + group->first[k], i - 1 + end, &x[end], &p[end]);
        }
        bough_vec3 chord = bough_mat3_tmul(bough_rotation_matrix(bough_rotation_between(p[0], p[1], 0.5)),
                                           bough_sub(x[1], x[0]));
        sum = bough_axpy(1.0 / group->n, chord, sum);
    }
    return sum;
}

// Mean rotations, and positions by the mean strains: the mean of positions would be shorter than the rods and
// compress them.
static void average_rods(const bough_blade_group *group, const double *state, double *mean) {
    const bough_rod_model *m = group->blade[0]->mesh;
    int n = m->n;
    for (int i = 1; i <= n; i++) {
        bough_vec3 x;
        bough_quaternion before, p;
        double sum[4] = {0, 0, 0, 0};
        for (int k = 0; k < group->n; k++) {
            for (int c = 0; c < 4; c++) sum[c] += state[group->first[k] + (3 + c) * n + i - 1];
        }
        p = bough_quaternion_normalised((bough_quaternion){sum[0], sum[1], sum[2], sum[3]});
        vertex_of(m, mean, i - 1, &x, &before);
        x = bough_add(x, bough_mat3_mul(bough_rotation_matrix(bough_rotation_between(before, p, 0.5)),
                                        mean_chord(group, m, i, state)));
        const double values[7] = {x.x, x.y, x.z, p.w, p.x, p.y, p.z};
        for (int c = 0; c < 7; c++) mean[c * n + i - 1] = values[c];
    }
}

void bough_blade_group_average(const bough_blade_group *group, const double *input, double *mean,
                               double *state) {
    for (int j = 0; j < group->n_row; j++) {
        mean[j] = 0;
        for (int k = 0; k < group->n; k++) mean[j] += state[group->first[k] + j] / group->n;
    }
    if (group->blade[0]->rod != NULL) average_rods(group, state, mean);
    for (int k = 0; k < group->n; k++) {
        memcpy(state + group->first[k], mean, (size_t)group->n_row * sizeof *state);
        bough_beam_move_rigidly(group->blade[k], input + group->first_input[k], state + group->first[k]);
    }
}
