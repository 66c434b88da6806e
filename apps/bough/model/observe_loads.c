// Loads inside the structure: in sections of rods, on the tower's top, in the rotor's shaft.
#include "apps/bough/model/build_internal.h"
#include "apps/bough/model/channel_table.h"
#include "apps/bough/model/shape.h"
#include "core/base/linalg.h"
#include "core/tree/loop.h"

#include <stdio.h>

// -- sections -------------------------------------------------------------------------------------

// A place on a rod: within a segment, at a fraction of its length.
typedef struct place {
    int segment;
    double fraction;
} place;

typedef struct sensor {
    const bough_simulation *simulation;
    const bough_beam *beam;
    int n;
    place *place; // (n)
    bool *kink;   // (n_segment + 1) a concentrated force acts on the vertex
    bough_rod_scratch scratch;
} sensor;

enum { PLACE_CHANNELS = 12 };

// Position of a vertex in the body's frame, from scratch->vertex.
static bough_vec3 vertex_position(const sensor *x, int i) {
    const double *v = x->scratch.vertex + i;
    int n = x->beam->mesh->stride;
    return bough_v3(v[0], v[n], v[2 * n]);
}

static bough_quaternion vertex_rotation(const sensor *x, int i) {
    return bough_section_vertex_rotation(x->beam->mesh, &x->scratch, i);
}

// Rotation vector of a section against the undeformed one, in the body's axes.
static bough_vec3 vertex_turn(const sensor *x, int i) {
    bough_quaternion back = bough_quaternion_conjugate(x->beam->def.rotation[i]);
    return bough_quaternion_logarithm(bough_quaternion_product(vertex_rotation(x, i), back));
}

// Loads of the sections at both ends, in the body's axes.
typedef struct end_loads {
    bough_section_load root, end; // end: of a rod that carries bodies
} end_loads;

static end_loads loads_at_ends(const sensor *x, double t) {
    const bough_beam *beam = x->beam;
    int n = beam->def.n_segment;
    double w[BOUGH_ROD_MOST_OUTPUTS];
    bough_simulation_accelerate(x->simulation, t);
    bough_simulation_root(x->simulation, beam, t, w);
    bough_vec3 root = bough_v3(w[0], w[1], w[2]), arm = bough_cross(beam->def.position[0], root);
    bough_mat3 section = bough_rotation_matrix(vertex_rotation(x, n));
    return (end_loads){
        {root, bough_sub(bough_v3(w[3], w[4], w[5]), arm)},
        {bough_v3(-w[6], -w[7], -w[8]), bough_mat3_mul(section, bough_v3(-w[9], -w[10], -w[11]))}};
}

static double segment_length(const sensor *x, int i) {
    return x->beam->def.span[i + 1] - x->beam->def.span[i];
}

static bough_section_load middle_load(const sensor *x, int i) {
    return bough_section_in_segment(x->beam, &x->scratch, i, 0.5);
}

// From the middle of a segment to the next place at which the loads are known, the middle of a neighbour or
// an end of the rod.
typedef struct neighbour {
    bool known, inner;        // no concentrated force lies between both; it is a segment
    double distance;          // [m], negative towards the root
    bough_section_load slope; // change per length
} neighbour;

static neighbour neighbour_of(const sensor *x, const end_loads *ends, int i, int sign) {
    int next = i + sign, n = x->beam->def.n_segment;
    bool inner = next >= 0 && next < n;
    bough_section_load from = middle_load(x, i), to = {{0, 0, 0}, {0, 0, 0}};
    double length = segment_length(x, i) / 2;
    if (inner) {
        to = middle_load(x, next);
        length += segment_length(x, next) / 2;
    } else if (next < 0) {
        to = ends->root;
    } else if (x->beam->end >= 0) {
        to = ends->end;
    }
    bough_vec3 force = bough_sub(to.force, from.force), moment = bough_sub(to.moment, from.moment);
    bough_section_load slope = {bough_scale(sign / length, force), bough_scale(sign / length, moment)};
    return (neighbour){!x->kink[i + (sign > 0)], inner, sign * length, slope};
}

// C D q of theory (30): the mean of what the moment of a segment is beside a linear one, by the loads along
// it.
static bough_vec3 bow_of_loads(const sensor *x, int i) {
    const bough_rod_model *m = x->beam->mesh;
    double stiffness[6][6], moment[3] = {0, 0, 0};
    bough_symmetric6_unpack(x->beam->def.stiffness + 21 * i, stiffness);
    for (int k = 0; k < 6; k++) {
        double strain = x->scratch.rest[k * m->stride + i] - m->strain0[k * m->stride + i];
        for (int c = 0; c < 3; c++) moment[c] += stiffness[3 + c][k] * strain;
    }
    bough_mat3 axes = bough_axes_between(vertex_rotation(x, i), vertex_rotation(x, i + 1), 0.5);
    return bough_mat3_mul(axes, bough_v3_load(moment));
}

// theory (119): force in the middle of a segment less that of the segment, whose second derivative is given,
// by the loads along it and its neighbours, whose mean bow is -(h²/12) d₃×f.
static bough_vec3 middle_excess(const sensor *x, int i, double distance, bough_vec3 second) {
    double h = segment_length(x, i);
    bough_mat3 axes = bough_axes_between(vertex_rotation(x, i), vertex_rotation(x, i + 1), 0.5);
    bough_vec3 before = bough_scale(pow(segment_length(x, i - 1), -2), bow_of_loads(x, i - 1));
    bough_vec3 after = bough_scale(pow(segment_length(x, i + 1), -2), bow_of_loads(x, i + 1));
    bough_vec3 slope = bough_scale(12 / distance, bough_cross(axes.c3, bough_sub(after, before)));
    return bough_scale(h * h / 24, bough_axpy(2, slope, second));
}

// The parabola through the middles of three segments, a line next to an end. A concentrated force makes a
// step at its vertex: towards it the slope of the segment's other half continues.
static bough_section_load load_between(const sensor *x, const end_loads *ends, place at) {
    double offset = (at.fraction - 0.5) * segment_length(x, at.segment);
    bough_section_load middle = middle_load(x, at.segment);
    neighbour a = neighbour_of(x, ends, at.segment, -1), b = neighbour_of(x, ends, at.segment, 1);
    bool left = offset < 0 ? a.known : !b.known;
    double weight = left ? 0 : 1, distance = b.distance - a.distance; // of b's slope
    if (a.known && b.known && a.inner && b.inner) {
        weight = (offset - a.distance) / distance;
        bough_vec3 second = bough_scale(2 / distance, bough_sub(b.slope.force, a.slope.force));
        middle.force = bough_add(middle.force, middle_excess(x, at.segment, distance, second));
    } else if (!a.known && !b.known) {
        return middle;
    }
    bough_vec3 force = bough_between(a.slope.force, b.slope.force, weight);
    bough_vec3 moment = bough_between(a.slope.moment, b.slope.moment, weight);
    return (bough_section_load){bough_axpy(offset, force, middle.force),
                                bough_axpy(offset, moment, middle.moment)};
}

// Change of the moment per length within a segment.
static bough_vec3 moment_slope(const sensor *x, int i) {
    bough_vec3 first = bough_section_in_segment(x->beam, &x->scratch, i, 0).moment;
    bough_vec3 last = bough_section_in_segment(x->beam, &x->scratch, i, 1).moment;
    return bough_scale(1 / segment_length(x, i), bough_sub(last, first));
}

// Second derivative of the moment: the mean over the neighbours that no concentrated force separates.
static bough_vec3 moment_curvature(const sensor *x, int i) {
    bough_vec3 sum = {0, 0, 0};
    int count = 0;
    for (int side = -1; side <= 1; side += 2) {
        int next = i + side;
        if (next < 0 || next >= x->beam->def.n_segment || x->kink[i + (side > 0)]) continue;
        double distance = (segment_length(x, i) + segment_length(x, next)) / 2;
        bough_vec3 change = bough_sub(moment_slope(x, next), moment_slope(x, i));
        sum = bough_axpy(side / distance, change, sum);
        count++;
    }
    return count > 1 ? bough_scale(0.5, sum) : sum;
}

// theory (118): a parabola of known mean over the segment. In the outer half of the first and the last
// segment it ends at the moment of the root and of the end.
static bough_vec3 bending_at(const sensor *x, const end_loads *ends, place at) {
    const bough_beam *beam = x->beam;
    int i = at.segment, n = beam->def.n_segment;
    double f = at.fraction, square = segment_length(x, i) * segment_length(x, i);
    bough_vec3 bend = bough_scale(square / 2, moment_curvature(x, i)), mean = bow_of_loads(x, i);
    bough_vec3 middle = bough_axpy(-1. / 12, bend, bough_add(mean, middle_load(x, i).moment));
    if (i == 0 && f < 0.5)
        return bough_axpy(f * (f - 0.5), bend, bough_between(ends->root.moment, middle, 2 * f));
    if (i == n - 1 && f > 0.5 && !x->kink[n]) {
        bough_vec3 end = beam->end >= 0 ? ends->end.moment : bough_v3(0, 0, 0);
        return bough_axpy((f - 0.5) * (f - 1), bend, bough_between(middle, end, 2 * f - 1));
    }
    bough_vec3 linear = bough_section_in_segment(beam, &x->scratch, i, f).moment;
    return bough_axpy((f - 0.5) * (f - 0.5) - 1. / 12, bend, bough_add(mean, linear));
}

// Displacement of a vertex, and slope of the axis there by rotation, (R − R₀) e₃, in the body's axes.
static bough_vec3 vertex_shift(const sensor *x, int i) {
    return bough_sub(vertex_position(x, i), x->beam->def.position[i]);
}

static bough_vec3 vertex_slope(const sensor *x, int i) {
    bough_mat3 now = bough_rotation_matrix(vertex_rotation(x, i));
    return bough_sub(now.c3, bough_rotation_matrix(x->beam->def.rotation[i]).c3);
}

// Change of the curvature over the segment of a place whose sections have these axes, by its moments.
static bough_vec3 curvature_change(const sensor *x, place at, const bough_mat3 *axes) {
    bough_vec3 first = bough_section_in_segment(x->beam, &x->scratch, at.segment, 0).moment;
    bough_vec3 last = bough_section_in_segment(x->beam, &x->scratch, at.segment, 1).moment;
    double m[3], k[3] = {0, 0, 0}, compliance[21];
    bough_v3_store(bough_mat3_tmul(*axes, bough_sub(last, first)), m);
    if (bough_symmetric6_inverse(x->beam->def.stiffness + 21 * at.segment, compliance))
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) k[i] += compliance[bough_symmetric6_index(3 + i, 3 + j)] * m[j];
    return bough_mat3_mul(*axes, bough_v3(k[0], k[1], k[2]));
}

// Between vertices displacement and rotation are parabolas, whose second derivatives follow from the slopes
// and the moments at both.
static void sample_place(const sensor *x, const end_loads *ends, place at, double *value) {
    int left = at.segment, right = left + 1;
    bough_mat3 axes = bough_axes_between(vertex_rotation(x, left), vertex_rotation(x, right), at.fraction);
    double bow = at.fraction * (at.fraction - 1) / 2 * segment_length(x, left);
    bough_vec3 shift = bough_between(vertex_shift(x, left), vertex_shift(x, right), at.fraction);
    shift = bough_axpy(bow, bough_sub(vertex_slope(x, right), vertex_slope(x, left)), shift);
    bough_vec3 turn = bough_between(vertex_turn(x, left), vertex_turn(x, right), at.fraction);
    turn = bough_axpy(bow, curvature_change(x, at, &axes), turn);
    // a segment's moment has no slope in torsion
    bough_section_load load = load_between(x, ends, at);
    bough_vec3 force = bough_mat3_tmul(axes, load.force);
    bough_vec3 moment = bough_mat3_tmul(axes, bending_at(x, ends, at));
    moment.z = bough_mat3_tmul(axes, load.moment).z;
    value = bough_observe_vector(turn, BOUGH_DEGREE, bough_observe_vector(shift, 1, value));
    bough_observe_vector(moment, 1e3, bough_observe_vector(force, 1e3, value));
}

static void sample_sections(void *self, double t, double *value) {
    sensor *x = self;
    bool good = bough_section_evaluate(x->simulation, x->beam, t, &x->scratch);
    end_loads ends = loads_at_ends(x, t);
    for (int k = 0; k < x->n; k++, value += PLACE_CHANNELS) {
        sample_place(x, &ends, x->place[k], value);
        for (int c = 6; c < PLACE_CHANNELS && !good; c++) value[c] = (double)NAN;
    }
}

static place find_place(const bough_rod_def *def, double span) {
    int i = 0;
    while (i < def->n_segment - 1 && def->span[i + 1] <= span) i++;
    return (place){i, (span - def->span[i]) / (def->span[i + 1] - def->span[i])};
}

// Marks vertices with concentrated loads; of a load within a segment both vertices of the segment.
static void mark_kinks(const bough_scene *scene, const bough_beam *beam, bool *kink) {
    int n = beam->def.n_segment;
    for (int k = 0; k < scene->n_load; k++) {
        const bough_scene_load *load = &scene->load[k];
        if (load->body_name == NULL || &scene->body[load->body] != beam->body) continue;
        if (load->place == BOUGH_SCENE_AT_VERTEX) kink[load->vertex] = true;
        if (load->place == BOUGH_SCENE_AT_TIP) kink[n] = true;
        if (load->place != BOUGH_SCENE_AT_SPAN) continue;
        place at = find_place(&beam->def, load->span[0]);
        kink[at.segment] |= at.fraction < 1;
        kink[at.segment + 1] |= at.fraction > 0;
    }
    kink[n] &= beam->end < 0; // the wrench of bodies on the end is known
}

// Blades and a tower of one rod have OpenFAST's names.
static void add_place(const bough_simulation *s, const bough_beam *beam, int number, bough_channels *list) {
    int blade = bough_scene_blade(s->scene, (int)(beam->body - s->scene->body));
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
    *x = (sensor){s, bough_simulation_beam(s, from->body), from->n_at, NULL, NULL, {0}};
    x->place = bough_arena_take(arena, (size_t)x->n * sizeof *x->place);
    x->kink = bough_arena_take(arena, ((size_t)x->beam->def.n_segment + 1) * sizeof *x->kink);
    mark_kinks(s->scene, x->beam, x->kink);
    bough_rod_scratch_init(&x->scratch, arena, x->beam->mesh);
    bough_channels_group(list, sample_sections, x);
    for (int k = 0; k < x->n; k++) {
        x->place[k] = find_place(&x->beam->def, from->at[k]);
        add_place(s, x->beam, k + 1, list);
    }
}

void bough_observe_sections(bough_simulation *s, bough_channels *list) {
    for (int k = 0; k < s->scene->n_sensor; k++) add_sensor(s, &s->scene->sensor[k], list);
}

// -- yaw bearing ----------------------------------------------------------------------------------

// The opposite of the wrench of the tower's end on the bodies that it carries, in the axes of the tower's
// body that rotate with the section.
static void sample_yaw_bearing(void *self, double t, double *value) {
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

void bough_observe_yaw_bearing(bough_simulation *s, bough_channels *list) {
    bough_channel_group_add(list, sample_yaw_bearing, s, BOUGH_CHANNELS_YAW_BEARING);
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

// Torque of the joint nearest to the hub on the hub: of spring, loads and prescribed motion.
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

void bough_observe_turn(bough_simulation *s, bough_channels *list) {
    bough_channel_group_add(list, sample_turn, s, BOUGH_CHANNELS_ROTOR);
}

void bough_observe_shaft(bough_simulation *s, bough_channels *list) {
    bough_channel_group_add(list, sample_torque, build_shaft(list->arena, s), BOUGH_CHANNELS_SHAFT);
}
