// Loads inside the structure: in sections of rods, on the tower's top, in the rotor's shaft.
#include "apps/bough/model/build_internal.h"
#include "apps/bough/model/channel_table.h"
#include "apps/bough/model/section_loads.h"
#include "core/base/linalg.h"

// -- sections -------------------------------------------------------------------------------------

typedef struct sensor {
    bough_section_loads loads;
    int n;
    bough_rod_place *place; // (n)
} sensor;

enum { PLACE_CHANNELS = 12 };

// Displacement of a vertex, and slope of the axis there by rotation, (R − R₀) e₃, in the body's axes.
static bough_vec3 vertex_shift(const sensor *x, int i) {
    return bough_sub(bough_section_loads_position(&x->loads, i), x->loads.beam->def.position[i]);
}

static bough_vec3 vertex_slope(const sensor *x, int i) {
    bough_mat3 now = bough_rotation_matrix(bough_section_loads_rotation(&x->loads, i));
    return bough_sub(now.c3, bough_rotation_matrix(x->loads.beam->def.rotation[i]).c3);
}

// Between vertices the displacement is a parabola, whose second derivative follows from the slopes at both.
static void sample_place(const sensor *x, const bough_rod_place *at, double *value) {
    int left = at->segment, right = left + 1;
    const double *span = x->loads.beam->def.span;
    bough_wrench load = bough_section_loads_at(&x->loads, at);
    double bow = at->fraction * (at->fraction - 1) / 2 * (span[right] - span[left]);
    bough_vec3 shift = bough_between(vertex_shift(x, left), vertex_shift(x, right), at->fraction), turn;
    shift = bough_axpy(bow, bough_sub(vertex_slope(x, right), vertex_slope(x, left)), shift);
    bough_mat3 axes = bough_section_loads_axes(&x->loads, at, &turn);
    value = bough_observe_vector(turn, BOUGH_DEGREE, bough_observe_vector(shift, 1, value));
    value = bough_observe_vector(bough_mat3_tmul(axes, load.force), 1e3, value);
    bough_observe_vector(bough_mat3_tmul(axes, load.moment), 1e3, value);
}

static void sample_sections(void *self, double t, double *value) {
    sensor *x = self;
    bool good = bough_section_loads_evaluate(&x->loads, t);
    for (int k = 0; k < x->n; k++, value += PLACE_CHANNELS) {
        sample_place(x, &x->place[k], value);
        for (int c = 6; c < PLACE_CHANNELS && !good; c++) value[c] = (double)NAN;
    }
}

static bough_rod_place find_place(const bough_section_loads *x, double span) {
    const bough_rod_def *def = &x->beam->def;
    int i = 0;
    while (i < def->n_segment - 1 && def->span[i + 1] <= span) i++;
    return bough_section_loads_place(x, i, (span - def->span[i]) / (def->span[i + 1] - def->span[i]));
}

// Blades and a tower of one rod have OpenFAST's names.
static void add_place(const bough_simulation *s, const bough_beam *beam, int number, bough_channels *list) {
    int blade = bough_scene_blade(s->scene, beam->index);
    char b[12], a[12];
    snprintf(b, sizeof b, "%d", number);
    if (blade >= 0) {
        snprintf(a, sizeof a, "%d", blade + 1);
        bough_channel_family_add(list, BOUGH_CHANNELS_BLADE_SECTION, a, b);
        return;
    }
    bool tower = beam == s->tower_top && beam == s->tower_foot;
    bough_channel_family_add(list, tower ? BOUGH_CHANNELS_TOWER_SECTION : BOUGH_CHANNELS_SECTION,
                             tower ? "" : beam->body->name, b);
}

static void add_sensor(bough_simulation *s, const bough_scene_sensor *from, bough_channels *list) {
    bough_arena *arena = list->arena;
    sensor *x = bough_arena_take(arena, sizeof *x);
    const bough_beam *beam = bough_simulation_beam(s, from->body);
    *x = (sensor){bough_section_loads_create(arena, s, beam), from->n_at, NULL};
    x->place = bough_arena_take(arena, (size_t)x->n * sizeof *x->place);
    bough_channels_group(list, sample_sections, x);
    for (int k = 0; k < x->n; k++) {
        x->place[k] = find_place(&x->loads, from->at[k]);
        add_place(s, beam, k + 1, list);
    }
}

void bough_observe_sections(bough_simulation *s, bough_channels *list) {
    for (int k = 0; k < s->scene->n_sensor; k++) add_sensor(s, &s->scene->sensor[k], list);
}

// -- yaw bearing ----------------------------------------------------------------------------------

// The opposite of the wrench of the tower's end on the bodies that it carries, in the axes of the tower's
// body that rotate with the section.
void bough_observe_yaw_bearing(void *self, double t, double *value) {
    const bough_simulation *s = self;
    const bough_beam *top = s->tower_top;
    double w[BOUGH_ROD_MOST_OUTPUTS];
    bough_quaternion p;
    bough_simulation_accelerate(s, t);
    bough_simulation_root(s, top, t, w);
    bough_simulation_beam_tip(s, top, &p);
    bough_vec3 force = bough_v3(-w[6], -w[7], -w[8]);
    bough_vec3 moment = bough_mat3_mul(bough_rotation_matrix(p), bough_v3(-w[9], -w[10], -w[11]));
    bough_quaternion back = bough_quaternion_conjugate(top->def.rotation[top->def.n_segment]);
    bough_mat3 axes = bough_rotation_matrix(bough_quaternion_product(p, back));
    value = bough_observe_vector(bough_mat3_tmul(axes, force), 1e3, value);
    bough_observe_vector(bough_mat3_tmul(axes, moment), 1e3, value);
}

// -- the shaft: rotation of the hub, torque between hub and drive train -----------------------------

typedef struct shaft {
    const bough_simulation *simulation;
    int body;              // carried by the joint about the rotor's axis that is nearest to the hub
    bough_inertia inertia; // of what this joint carries besides the hub, in its link's frame
} shaft;

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
    return bough_inertia_of(b->mass, bough_v3_load(b->centre_of_mass), bough_mat3_symmetric(b->inertia));
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

void bough_observe_turn(void *self, double t, double *value) {
    (void)t;
    double angle, speed;
    bough_simulation_hub_turn(self, &angle, &speed);
    double turn = fmod(angle / BOUGH_DEGREE, 360);
    value[0] = speed / BOUGH_RPM;
    value[1] = turn < 0 ? turn + 360 : turn;
}

// Torque of the joint nearest to the hub on the hub: of spring, loads and prescribed motion.
static double joint_torque(const bough_simulation *s, int body, double t) {
    const bough_tree *tree = s->tree;
    int q, v;
    bough_tree_joint_rows(tree, body, &q, &v);
    double torque = s->view->passive[v - tree->n_q];
    for (int k = 0; k < tree->n_loads; k++) {
        const bough_joint_load_def *load = &tree->loads[k];
        if (load->body != body) continue;
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
    return bough_dot(w.moment, bough_unit3(s->scene->body[x->body].joint.axis));
}

static bool has_inertia(const bough_inertia *i) {
    return i->mass != 0 || i->rotational.c1.x != 0 || i->rotational.c2.y != 0 || i->rotational.c3.z != 0;
}

// The torque of the hub accelerates the other bodies on the joint, against the torque of the joint.
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

void bough_observe_shaft(bough_simulation *s, bough_channels *list) {
    bough_channel_group_add(list, sample_torque, build_shaft(list->arena, s), BOUGH_CHANNELS_SHAFT);
}
