// The rotor's shaft: how the hub turns, and the torque between hub and drive train.
#include "apps/bough/model/channel_table.h"
#include "apps/bough/model/observe.h"
#include "core/tree/loop.h"

typedef struct shaft {
    const bough_simulation *simulation;
    int body;              // carried by the joint about the rotor's axis that is nearest to the hub
    bough_inertia inertia; // of what this joint carries besides the hub, in its link's frame
} shaft;

// -- building -------------------------------------------------------------------------------------

static int parent_of(const bough_scene *scene, int body) { return scene->body[body].joint.parent; }

// The outermost body that carries all blades.
static int find_hub(const bough_scene *scene) {
    const bough_scene_turbine *turbine = &scene->turbine;
    int hub = parent_of(scene, turbine->blade[0]);
    for (int b = 1; b < turbine->n_blade; b++) {
        while (hub != turbine->rotor && !bough_scene_carries(scene, hub, turbine->blade[b]))
            hub = parent_of(scene, hub);
    }
    return hub;
}

static bool turns_about_rotor_axis(const bough_simulation *s, int body) {
    if (s->scene->body[body].joint.kind != BOUGH_JOINT_REVOLUTE) return false;
    bough_vec3 rotor = bough_simulation_joint_axis(s, s->scene->turbine.rotor);
    return bough_dot(bough_simulation_joint_axis(s, body), rotor) > 1 - 1e-9;
}

static bough_inertia inertia_of(const bough_scene_body *b) {
    const double *c = b->centre_of_mass, *v = b->inertia;
    bough_mat3 about = {{v[0], v[3], v[4]}, {v[3], v[1], v[5]}, {v[4], v[5], v[2]}};
    return bough_inertia_of(b->mass, bough_v3(c[0], c[1], c[2]), about);
}

static shaft *build_shaft(bough_arena *arena, const bough_simulation *s) {
    const bough_scene *scene = s->scene;
    const bough_frame *frame = s->tree->bodies;
    shaft *x = bough_arena_take(arena, sizeof *x);
    int hub = find_hub(scene), rotor = scene->turbine.rotor;
    *x = (shaft){.simulation = s, .body = hub};
    while (x->body >= 0 && x->body != rotor && !turns_about_rotor_axis(s, x->body))
        x->body = parent_of(scene, x->body);
    if (x->body < 0) x->body = rotor;
    for (int i = hub; i >= 0 && i != x->body;) {
        i = parent_of(scene, i);
        if (i < 0 || frame[i].link != frame[x->body].link) continue;
        bough_inertia own = bough_inertia_to_parent(&frame[i].placement, inertia_of(&scene->body[i]));
        x->inertia = bough_inertia_add(x->inertia, own);
    }
    return x;
}

// -- sampling -------------------------------------------------------------------------------------

void bough_simulation_hub_turn(const bough_simulation *s, double *angle, double *speed) {
    const bough_scene_turbine *turbine = &s->scene->turbine;
    *angle = *speed = 0;
    for (int i = turbine->blade[0]; i >= 0; i = i == turbine->rotor ? -1 : parent_of(s->scene, i)) {
        if (!turns_about_rotor_axis(s, i)) continue;
        bough_motion_point joint = bough_simulation_joint_point(s, i);
        *angle += joint.q;
        *speed += joint.v;
    }
}

static void sample_turn(void *self, double t, double *value) {
    (void)t;
    double angle, speed;
    bough_simulation_hub_turn(self, &angle, &speed);
    double turn = fmod(angle / BOUGH_DEGREE, 360);
    value[0] = speed / BOUGH_RPM;
    value[1] = turn < 0 ? turn + 360 : turn;
}

// Torque of the joint nearest to the hub on the hub's side: spring, loads, prescribed motion.
static double joint_torque(const bough_simulation *s, int body, double t) {
    const bough_tree *tree = s->tree;
    int q, v;
    bough_tree_joint_rows(tree, body, &q, &v);
    double torque = s->view->passive[v - tree->n_q];
    for (int k = 0; k < tree->n_loads; k++) {
        const bough_joint_load_def *load = &tree->loads[k];
        if (load->body != tree->bodies[body].link) continue;
        torque += load->value * bough_schedule_at(&load->schedule, t);
    }
    bool driven = s->scene->body[body].joint.motion[0].node != NULL;
    return torque + (driven ? s->view->drive[v - tree->n_q] : 0);
}

// I A + V ×* I V − I g about the joint's axis.
static double inertial_torque(const shaft *x) {
    const bough_simulation *s = x->simulation;
    const bough_tree_data *d = s->view;
    int link = s->tree->bodies[x->body].link;
    bough_twist fall = {d->gravity[link], {0, 0, 0}}, a = d->acceleration[link];
    a.linear = bough_sub(a.linear, fall.linear);
    bough_wrench w = bough_inertia_wrench(&x->inertia, a, d->twist[link]);
    return bough_dot(w.moment, bough_scene_direction(s->scene->body[x->body].joint.axis));
}

static bool has_inertia(const bough_inertia *i) {
    return i->mass != 0 || i->rotational.c1.x != 0 || i->rotational.c2.y != 0 || i->rotational.c3.z != 0;
}

// The hub accelerates what the joint carries besides it, against what the joint does.
static void sample_torque(void *self, double t, double *value) {
    const shaft *x = self;
    const bough_simulation *s = x->simulation;
    double angle, speed, torque = 0;
    bool heavy = has_inertia(&x->inertia);
    if (heavy || s->scene->body[x->body].joint.motion[0].node != NULL) bough_simulation_accelerate(s, t);
    if (heavy) torque = inertial_torque(x);
    torque -= joint_torque(s, x->body, t);
    bough_simulation_hub_turn(s, &angle, &speed);
    value[0] = torque / 1e3;
    value[1] = torque * speed / 1e3;
}

void bough_observe_turn(bough_simulation *s, bough_channels *list) {
    bough_channel_group_add(list, sample_turn, s, BOUGH_CHANNELS_ROTOR);
}

void bough_observe_shaft(bough_simulation *s, bough_channels *list) {
    bough_channel_group_add(list, sample_torque, build_shaft(list->arena, s), BOUGH_CHANNELS_SHAFT);
}
