// Queries between steps: poses, motions of beams, wrenches at their roots.
#include "apps/bough/model/simulation.h"

#include "aero/rotor/rotor.h"
#include "core/tree/dynamics.h"
#include "core/tree/loop.h"
#include "flexbody/rod/rod_tangent.h"

void bough_simulation_update(bough_simulation *s) {
    bough_tree_kinematics(s->tree, s->leader.state, s->view);
    *s->accelerated = (double)NAN;
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].ground == NULL) continue;
        bough_mat3 e = bough_mat3_transpose(bough_beam_pose(s, &s->beam[k]).rotation);
        const double axes[BOUGH_GROUND_AXES] = {e.c1.x, e.c1.y, e.c1.z, e.c2.x, e.c2.y,
                                                e.c2.z, e.c3.x, e.c3.y, e.c3.z};
        bough_ground_body_turn(s->beam[k].ground, axes);
    }
}

int bough_simulation_n_joints(const bough_simulation *s) {
    int n = 0;
    for (int i = 0; i < s->scene->n_body; i++) n += s->scene->body[i].joint.kind != BOUGH_JOINT_FIXED;
    return n;
}

long bough_simulation_steps(const bough_simulation *s) {
    bough_statistics sum = bough_master_statistics(s->master);
    return sum.steps + sum.failed_steps;
}

bough_beam *bough_simulation_beam(const bough_simulation *s, int body) {
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].body == &s->scene->body[body]) return &s->beam[k];
    }
    return NULL;
}

double bough_simulation_pitch(const bough_simulation *s, const bough_beam *beam) {
    const bough_scene_joint *joint = &beam->body->joint;
    if (joint->kind != BOUGH_JOINT_REVOLUTE || joint->axis != 2) return beam->body->pitch;
    return beam->body->pitch - bough_simulation_joint_point(s, beam->index).q;
}

const double *bough_beam_state(const bough_simulation *s, const bough_beam *beam, int first) {
    const double *state = s->rod[beam->port].state;
    if (beam->rod != NULL) return state;
    double input[BOUGH_ROD_INPUTS] = {0}; // gravity does not matter
    bough_twist_store(bough_beam_twist(s, beam), input);
    return bough_modal_body_vertices(beam->modal, state, input, first);
}

void bough_beam_move_rigidly(const bough_beam *beam, const double *input, double *state) {
    if (beam->rod != NULL) {
        bough_rod_move_rigidly(beam->mesh, input, state);
    } else {
        bough_modal_body_move_rigidly(beam->modal, input, state);
    }
}

bough_vec3 bough_simulation_joint_axis(const bough_simulation *s, int body) {
    bough_mat3 r = bough_body_pose(s, body).rotation;
    int axis = s->scene->body[body].joint.axis;
    return axis == BOUGH_SCENE_X ? r.c1 : axis == BOUGH_SCENE_Y ? r.c2 : r.c3;
}

bough_rotor_place bough_simulation_rotor(const bough_simulation *s) {
    const bough_scene *scene = s->scene;
    int body = scene->turbine.rotor;
    bough_transform hub = bough_body_pose(s, body);
    bough_rotor_place r = {hub.position, bough_simulation_joint_axis(s, body), 0};
    for (int k = 0; k < scene->turbine.n_blade; k++) {
        const bough_beam *blade = bough_simulation_blade(s, k);
        bough_transform root = bough_beam_pose(s, blade);
        bough_vec3 tip = blade->def.position[blade->def.n_segment];
        tip = bough_sub(bough_add(root.position, bough_mat3_mul(root.rotation, tip)), r.hub);
        tip = bough_sub(tip, bough_scale(bough_dot(tip, r.axis), r.axis));
        r.radius = fmax(r.radius, sqrt(bough_dot(tip, tip)));
    }
    return r;
}

double bough_simulation_azimuth(const bough_simulation *s, const bough_beam *blade) {
    bough_vec3 shaft = bough_simulation_joint_axis(s, s->scene->turbine.rotor), zero = bough_v3(0, 0, 1);
    if (fabs(shaft.z) > 0.9) zero = bough_v3(1, 0, 0);
    zero = bough_axpy(-bough_dot(zero, shaft), shaft, zero);
    bough_vec3 span = bough_beam_pose(s, blade).rotation.c3;
    return atan2(bough_dot(span, bough_cross(shaft, zero)), bough_dot(span, zero));
}

bool bough_simulation_accelerate(const bough_simulation *s, double t) {
    if (*s->accelerated == t) return true;
    bool good = bough_tree_forward_dynamics(s->tree, s->view, t, s->master->coupling->input, s->acceleration);
    *s->accelerated = good ? t : (double)NAN;
    return good;
}

// A − g in the axes of a frame, which may be fixed to the ground.
static bough_twist less_gravity(const bough_simulation *s, const bough_frame *frame) {
    bool moves = frame->link >= 0;
    bough_twist a = moves ? s->view->acceleration[frame->link] : (bough_twist){0};
    a.linear = bough_sub(a.linear, moves ? s->view->gravity[frame->link] : s->tree->gravity);
    return bough_twist_to_child(&frame->placement, a);
}

// I (A - g) + V x* I V in the axes of a frame.
static bough_wrench inertial_wrench(const bough_simulation *s, const bough_frame *frame,
                                    const bough_inertia *inertia) {
    return bough_inertia_wrench(inertia, less_gravity(s, frame), bough_tree_frame_twist(s->view, frame));
}

// Adds the inertial wrench of the vertex, unless the rod is not yet strained, as at the start, when its
// motion has not reached the vertex.
static void add_vertex(bough_wrench inertial, double *wrench) {
    double force = bough_norm(inertial.force), strain = bough_norm(bough_v3_load(wrench));
    double values[6];
    if (strain <= 1e-9 * force) return;
    bough_wrench_store(inertial, values);
    for (int k = 0; k < 6; k++) wrench[k] -= values[k];
}

// Whether only its carrier, its weight and the air act on a body.
static bool stands_alone(const bough_scene *scene, int body) {
    bool alone = bough_scene_carried_by(scene, body) < 0;
    for (int kind = 0; kind < BOUGH_SCENE_CONNECTORS; kind++) {
        const bough_scene_connector *c = scene->connector[kind], *end = c + scene->n_connector[kind];
        for (; c < end; c++) alone = alone && c->body[0] != body && c->body[1] != body;
    }
    for (int k = 0; k < scene->n_load; k++)
        alone = alone && (scene->load[k].body_name == NULL || scene->load[k].body != body);
    return alone;
}

// Inertia and weight less the load of the air.
static void rigid_root(const bough_simulation *s, const bough_beam *beam, double t, double *root) {
    if (!stands_alone(s->scene, beam->index)) return;
    bough_wrench air = bough_tree_wrench(s->tree, beam->marker, t);
    bough_wrench inertial = inertial_wrench(s, &s->tree->markers[beam->marker], &beam->vertex[0]);
    bough_wrench_store(bough_wrench_sub(air, inertial), root);
}

void bough_simulation_root(const bough_simulation *s, const bough_beam *beam, double t,
                           double root[BOUGH_ROD_MOST_OUTPUTS]) {
    memset(root, 0, BOUGH_ROD_MOST_OUTPUTS * sizeof *root);
    if (beam->port < 0) {
        rigid_root(s, beam, t, root);
        return;
    }
    const bough_member *rod = &s->rod[beam->port];
    rod->system.ops->output(rod->system.self, t, rod->state, bough_simulation_rod_input(s, beam), root);
    add_vertex(inertial_wrench(s, &s->tree->markers[beam->marker], &beam->vertex[0]), root);
    if (beam->end < 0) return;
    bough_quaternion p;
    bough_simulation_beam_tip(s, beam, &p);
    bough_wrench w = inertial_wrench(s, &s->tree->ends[beam->end], &beam->vertex[1]);
    w.force = bough_mat3_mul(bough_rotation_matrix(p), w.force);
    add_vertex(w, root + 6);
}

// Motion of a vertex in the body's frame: of a rod by its state, otherwise undeformed and rigid.
typedef bough_vertex_motion vertex;

static vertex rigid_vertex(const bough_beam *beam, int i, bough_twist twist) {
    bough_vec3 x = beam->def.position[i];
    return (vertex){x, bough_add(twist.linear, bough_cross(twist.angular, x)), twist.angular,
                    bough_rotation_matrix(beam->def.rotation[i])};
}

static vertex rod_vertex(const bough_beam *beam, const double *state, int i) {
    const double *y = state + i - 1;
    int n = beam->mesh->n;
    bough_mat3 r = bough_rod_rotation(state, n, i - 1);
    bough_vec3 w = {y[10 * n], y[11 * n], y[12 * n]};
    return (vertex){{y[0], y[n], y[2 * n]}, {y[7 * n], y[8 * n], y[9 * n]}, bough_mat3_mul(r, w), r};
}

// The last vertex of a rod that carries bodies; its velocity is resolved in its own axes.
static vertex end_vertex(const bough_simulation *s, const bough_beam *beam) {
    bough_quaternion p;
    bough_vec3 x = bough_simulation_beam_tip(s, beam, &p);
    bough_mat3 r = bough_rotation_matrix(p);
    bough_twist twist = s->view->twist[s->tree->ends[beam->end].link];
    return (vertex){x, bough_mat3_mul(r, twist.linear), bough_mat3_mul(r, twist.angular), r};
}

// state: of the vertices, NULL of a rigid body.
static vertex vertex_of(const bough_simulation *s, const bough_beam *beam, const double *state, int i,
                        bough_twist twist) {
    if (i == 0 || state == NULL) return rigid_vertex(beam, i, twist);
    if (i > beam->mesh->n) return end_vertex(s, beam);
    return rod_vertex(beam, state, i);
}

bough_sharpest bough_simulation_bend(const bough_simulation *s, const bough_beam *beam) {
    const double *state = s->rod[beam->port].state;
    bough_mat3 section = bough_rotation_matrix(beam->def.rotation[0]), rest = section;
    bough_sharpest bend = {0};
    for (int i = 1; i <= beam->def.n_segment; i++) {
        bough_mat3 next = vertex_of(s, beam, state, i, (bough_twist){0}).rotation;
        bough_mat3 next_rest = bough_rotation_matrix(beam->def.rotation[i]);
        bough_mat3 now = bough_mat3_product(bough_mat3_transpose(section), next);
        bough_mat3 before = bough_mat3_product(bough_mat3_transpose(rest), next_rest);
        double trace =
            bough_dot(now.c1, before.c1) + bough_dot(now.c2, before.c2) + bough_dot(now.c3, before.c3);
        double angle = acos(fmax(-1, fmin(0.5 * (trace - 1), 1)));
        if (angle > bend.angle) bend = (bough_sharpest){angle, i - 1};
        section = next, rest = next_rest;
    }
    return bend;
}

bough_vec3 bough_simulation_vertex(const bough_simulation *s, const bough_beam *beam, int i,
                                   bough_quaternion *rotation) {
    int stride = 1;
    const double *x = NULL;
    *rotation = beam->def.rotation[i];
    if (i == 0 || beam->port < 0) return beam->def.position[i];
    if (i <= beam->mesh->n) {
        stride = beam->mesh->n;
        x = bough_beam_state(s, beam, i) + i - 1;
    } else {
        x = s->leader.state + s->tree->links[s->tree->ends[beam->end].link].first_coordinate;
    }
    const double *p = x + 3 * stride;
    *rotation =
        bough_quaternion_normalised((bough_quaternion){p[0], p[stride], p[2 * stride], p[3 * stride]});
    return bough_v3(x[0], x[stride], x[2 * stride]);
}

bough_vec3 bough_simulation_beam_tip(const bough_simulation *s, const bough_beam *beam,
                                     bough_quaternion *rotation) {
    return bough_simulation_vertex(s, beam, beam->def.n_segment, rotation);
}

void bough_simulation_shift(const bough_simulation *s, const bough_beam *beam, int i, bough_vec3 *shift,
                            bough_vec3 *turn) {
    bough_quaternion p, undeformed = bough_quaternion_conjugate(beam->def.rotation[i]);
    *shift = bough_sub(bough_simulation_vertex(s, beam, i, &p), beam->def.position[i]);
    *turn = i == 0 ? bough_v3(0, 0, 0) : bough_quaternion_logarithm(bough_quaternion_product(p, undeformed));
}

const double *bough_simulation_rod_input(const bough_simulation *s, const bough_beam *beam) {
    const bough_coupling *c = s->master->coupling;
    return c->input + c->assembly->input_offset[beam->port + 1];
}

size_t bough_simulation_most_vertices(const bough_simulation *s) {
    int most = 1;
    for (int k = 0; k < s->n_beam; k++) {
        int n = s->beam[k].def.n_segment + 1;
        if (n > most) most = n;
    }
    return (size_t)most;
}

void bough_simulation_beam_motion(const bough_simulation *s, const bough_beam *beam, vertex *moving) {
    bough_transform pose = bough_beam_pose(s, beam);
    bough_twist twist = bough_beam_twist(s, beam);
    const double *state = beam->port < 0 ? NULL : bough_beam_state(s, beam, 1);
    for (int i = 0; i <= beam->def.n_segment; i++) {
        vertex v = vertex_of(s, beam, state, i, twist);
        moving[i] =
            (vertex){bough_add(pose.position, bough_mat3_mul(pose.rotation, v.position)),
                     bough_mat3_mul(pose.rotation, v.velocity), bough_mat3_mul(pose.rotation, v.angular),
                     bough_mat3_product(pose.rotation, v.rotation)};
    }
}

static void put_vertex(vertex v, bough_quaternion p, int i, int n, double *rows) {
    bough_vec3 w = bough_mat3_tmul(v.rotation, v.angular);
    const double values[BOUGH_BLADE_ROWS] = {v.position.x, v.position.y, v.position.z, p.w, p.x, p.y, p.z,
                                             v.velocity.x, v.velocity.y, v.velocity.z, w.x, w.y, w.z};
    for (int c = 0; c < BOUGH_BLADE_ROWS; c++) rows[c * n + i] = values[c];
}

// The inner vertices of a flexible beam are in its state as they are; the root, the end of a rod
// that carries bodies and a rigid beam's vertices one by one.
void bough_simulation_beam_rows(const bough_simulation *s, const bough_beam *beam, double *rows) {
    bough_twist twist = bough_beam_twist(s, beam);
    const double *state = beam->port < 0 ? NULL : bough_beam_state(s, beam, 1);
    int n = beam->def.n_segment + 1, inner = state ? beam->mesh->n : 0;
    for (int c = 0; state && c < BOUGH_BLADE_ROWS; c++)
        memcpy(rows + c * n + 1, state + c * inner, (size_t)inner * sizeof *rows);
    put_vertex(rigid_vertex(beam, 0, twist), beam->def.rotation[0], 0, n, rows);
    for (int i = inner + 1; i < n; i++) {
        vertex v = vertex_of(s, beam, state, i, twist);
        put_vertex(v, state ? bough_quaternion_of_matrix(v.rotation) : beam->def.rotation[i], i, n, rows);
    }
}

const char *bough_simulation_body_of(const bough_simulation *s, int row) {
    const bough_tree *tree = s->tree;
    int member = 0;
    while (row >= s->assembly->state_offset[member + 1]) member++;
    if (member > 0) return s->assembly->member[member]->system.name;
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        int q = row - link->first_coordinate, v = row - tree->n_q - link->first_speed;
        if ((q >= 0 && q < link->n_coordinates) || (v >= 0 && v < link->n_speeds)) {
            return tree->bodies[link->body].name;
        }
    }
    return s->leader.system.name;
}

bough_motion_point bough_simulation_joint_point(const bough_simulation *s, int body) {
    int q, v;
    bough_tree_joint_rows(s->tree, body, &q, &v);
    return (bough_motion_point){s->leader.state[q], s->leader.state[v], 0};
}
