// The channels of a simulation: what each part of the scene gives to be recorded. OpenFAST's names
// where the quantity is the same.
#include "apps/bough/model/observe.h"
#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/channel_table.h"
#include "apps/bough/model/control_link.h"
#include "apps/bough/model/simulation.h"
#include "core/tree/dynamics.h"
#include "core/tree/force.h"
#include "core/tree/loop.h"

#include <stdio.h>
#include <string.h>

// -- joints ---------------------------------------------------------------------------------------

static void joint_state(const bough_simulation *s, int body, double *coordinate, double *speed) {
    int q, v;
    bough_tree_joint_rows(s->tree, body, &q, &v);
    *coordinate = s->leader.state[q];
    *speed = s->leader.state[v];
}

static bool is_rotor(const bough_scene *scene, int body) {
    return scene->turbine.node != NULL && scene->turbine.rotor == body;
}

// The channels of a joint with axes: each coordinate and its rate.
static const struct {
    int n;
    bool angle[3];
    bough_channel_part part;
} joint_channels[BOUGH_JOINT_PLANAR + 1] = {
    [BOUGH_JOINT_REVOLUTE] = {1, {true}, BOUGH_CHANNELS_REVOLUTE},
    [BOUGH_JOINT_PRISMATIC] = {1, {false}, BOUGH_CHANNELS_PRISMATIC},
    [BOUGH_JOINT_CYLINDRICAL] = {2, {false, true}, BOUGH_CHANNELS_CYLINDRICAL},
    [BOUGH_JOINT_UNIVERSAL] = {2, {true, true}, BOUGH_CHANNELS_UNIVERSAL},
    [BOUGH_JOINT_PLANAR] = {3, {false, false, true}, BOUGH_CHANNELS_PLANAR},
};

static int n_recorded(const bough_scene *scene, int body) {
    return is_rotor(scene, body) ? 0 : joint_channels[scene->body[body].joint.kind].n;
}

// q̇ of the joints with axes: all speeds but the planar joint's are it.
static void joint_rates(const bough_simulation *s, int body, const double *q, double *rate) {
    int coordinate, speed;
    bough_tree_joint_rows(s->tree, body, &coordinate, &speed);
    const double *v = s->leader.state + speed;
    int n = joint_channels[s->scene->body[body].joint.kind].n;
    if (s->scene->body[body].joint.kind == BOUGH_JOINT_PLANAR) {
        bough_joint_rate(&s->tree->links[s->tree->bodies[body].link].joint, q, v, rate);
    } else {
        memcpy(rate, v, (size_t)n * sizeof *v);
    }
}

static void sample_joints(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    for (int i = 0; i < s->scene->n_body; i++) {
        int n = n_recorded(s->scene, i), coordinate, speed;
        if (n == 0) continue;
        double rate[3];
        bough_tree_joint_rows(s->tree, i, &coordinate, &speed);
        const double *q = s->leader.state + coordinate;
        joint_rates(s, i, q, rate);
        for (int k = 0; k < n; k++, value += 2) {
            bool angle = joint_channels[s->scene->body[i].joint.kind].angle[k];
            value[0] = q[k] / (angle ? BOUGH_DEGREE : 1);
            value[1] = rate[k] / (angle ? BOUGH_DEGREE : 1);
        }
    }
}

static void add_joints(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_joints, s);
    for (int i = 0; i < s->scene->n_body; i++) {
        const bough_scene_body *body = &s->scene->body[i];
        if (n_recorded(s->scene, i) == 0) continue;
        bough_channel_family_add(list, joint_channels[body->joint.kind].part, body->name, "");
    }
}

static bool is_free(const bough_scene_body *body) { return body->joint.kind == BOUGH_JOINT_FREE; }

static bool turns_freely(const bough_scene_body *body) {
    return is_free(body) || body->joint.kind == BOUGH_JOINT_SPHERICAL;
}

// Directions in place of angles: they know no jump.
static void sample_free_bodies(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    for (int i = 0; i < s->scene->n_body; i++) {
        const bough_scene_body *body = &s->scene->body[i];
        if (!turns_freely(body)) continue;
        const bough_frame *frame = &s->tree->bodies[i];
        bough_transform pose = bough_tree_frame_pose(s->view, frame);
        bough_twist velocity = bough_tree_frame_velocity(s->view, frame);
        if (is_free(body)) {
            value = bough_observe_vector(pose.position, 1, value);
            value = bough_observe_vector(velocity.linear, 1, value);
        }
        value = bough_observe_vector(pose.rotation.c1, 1, value);
        value = bough_observe_vector(pose.rotation.c3, 1, value);
        value = bough_observe_vector(velocity.angular, BOUGH_DEGREE, value);
    }
}

static void add_free_bodies(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_free_bodies, s);
    for (int i = 0; i < s->scene->n_body; i++) {
        const bough_scene_body *body = &s->scene->body[i];
        if (is_free(body)) bough_channel_family_add(list, BOUGH_CHANNELS_FREE, body->name, "");
        if (turns_freely(body)) {
            bough_channel_family_add(list, BOUGH_CHANNELS_TURNING, body->name, "");
        }
    }
}

// Whether coordinate k of a joint is prescribed
static bool is_driven(const bough_scene_joint *joint, int k) {
    return (k == 0 ? &joint->motion : &joint->second_motion)->node != NULL;
}

// Forces and torques of prescribed motions under the rods' present forces.
static void sample_drives(void *self, double t, double *value) {
    const bough_simulation *s = self;
    bough_simulation_accelerate(s, t);
    for (int i = 0; i < s->scene->n_body; i++) {
        for (int k = 0, q, v; k < 2; k++) {
            if (!is_driven(&s->scene->body[i].joint, k)) continue;
            bough_tree_joint_rows(s->tree, i, &q, &v);
            *value++ = s->view->drive[v - s->tree->n_q + k];
        }
    }
}

static void add_drive(const bough_scene_body *body, int k, bough_channels *list) {
    int kind = body->joint.kind;
    bool force = kind == BOUGH_JOINT_PRISMATIC || (kind == BOUGH_JOINT_CYLINDRICAL && k == 0);
    bough_channel_part part = kind == BOUGH_JOINT_UNIVERSAL ? BOUGH_CHANNELS_DRIVE_UNIVERSAL
                              : force                       ? BOUGH_CHANNELS_DRIVE_FORCE
                                                            : BOUGH_CHANNELS_DRIVE_TORQUE;
    bough_channel_family_add(list, part, body->name, k == 0 ? "1" : "2");
}

static void add_drives(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_drives, s);
    for (int i = 0; i < 2 * s->scene->n_body; i++) {
        const bough_scene_body *body = &s->scene->body[i / 2];
        if (is_driven(&body->joint, i % 2)) add_drive(body, i % 2, list);
    }
}

static void sample_springs(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    bough_vec3 direction;
    for (int k = 0; k < s->tree->n_springs; k++, value += 2)
        value[0] = bough_tree_spring(s->tree, s->view, k, &value[1], &direction);
}

static void add_springs(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_springs, s);
    for (int k = 0; k < s->scene->n_spring; k++)
        bough_channel_family_add(list, BOUGH_CHANNELS_SPRING, s->scene->spring[k].name, "");
}

static void sample_bushings(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    for (int k = 0; k < s->tree->n_bushings; k++, value += 6) {
        double energy;
        int element = s->tree->n_springs + k;
        bough_force_pair pair = bough_element_force(s->tree, s->view, element, &energy);
        bough_transform first = bough_tree_frame_pose(s->view, bough_element_frame(s->tree, element, 0));
        bough_transform second = bough_tree_frame_pose(s->view, bough_element_frame(s->tree, element, 1));
        bough_mat3 r = bough_mat3_product(bough_mat3_transpose(first.rotation), second.rotation);
        bough_wrench w = {bough_mat3_mul(r, pair.on[1].force), bough_mat3_mul(r, pair.on[1].moment)};
        bough_wrench_store(w, value);
    }
}

static void add_bushings(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_bushings, s);
    for (int k = 0; k < s->scene->n_bushing; k++)
        bough_channel_family_add(list, BOUGH_CHANNELS_BUSHING, s->scene->bushing[k].name, "");
}

// Forces and moments of closures under the rods' present forces.
static void sample_closures(void *self, double t, double *value) {
    const bough_simulation *s = self;
    bough_simulation_accelerate(s, t);
    for (int k = 0; k < s->tree->n_closures; k++, value += 6)
        bough_wrench_store(bough_loops_wrench(s->tree, s->view, k), value);
}

static void add_closures(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_closures, s);
    for (int k = 0; k < s->scene->n_closure; k++)
        bough_channel_family_add(list, BOUGH_CHANNELS_CLOSURE, s->scene->closure[k].name, "");
}

static void sample_markers(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    for (int k = 0; k < s->scene->n_marker; k++) {
        const bough_frame *marker = &s->tree->markers[s->first_marker + k];
        value = bough_observe_vector(bough_tree_frame_pose(s->view, marker).position, 1, value);
    }
}

static void add_markers(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_markers, s);
    for (int k = 0; k < s->scene->n_marker; k++)
        bough_channel_family_add(list, BOUGH_CHANNELS_MARKER, s->scene->marker[k].name, "");
}

// -- beams ----------------------------------------------------------------------------------------

// The channels of a part with a number in place of {a}.
static void add_numbered(bough_channels *list, bough_channel_part part, int number) {
    char text[12];
    snprintf(text, sizeof text, "%d", number);
    bough_channel_family_add(list, part, text, "");
}

enum { BLADE_CHANNELS = 12 };

// The root wrench is the blade's on the hub, in blade-root axes; out of and in plane are the tip's
// displacement along the axes before the pitch.
static void sample_blades(void *self, double t, double *value) {
    const bough_simulation *s = self;
    bough_simulation_accelerate(s, t);
    for (int b = 0; b < s->scene->turbine.n_blade; b++, value += BLADE_CHANNELS) {
        const bough_beam *beam = bough_simulation_beam(s, s->scene->turbine.blade[b]);
        double pitch = bough_simulation_pitch(s, beam), c = cos(pitch), sine = sin(pitch);
        double root[BOUGH_ROD_MOST_OUTPUTS];
        bough_vec3 d, turn;
        bough_simulation_tip_shift(s, beam, &d, &turn);
        bough_simulation_root(s, beam, t, root);
        const double values[BLADE_CHANNELS] = {d.x * c + d.y * sine,
                                               d.y * c - d.x * sine,
                                               turn.z / BOUGH_DEGREE,
                                               d.x,
                                               d.y,
                                               d.z,
                                               root[0] / 1e3,
                                               root[1] / 1e3,
                                               root[2] / 1e3,
                                               root[3] / 1e3,
                                               root[4] / 1e3,
                                               root[5] / 1e3};
        for (int k = 0; k < BLADE_CHANNELS; k++) value[k] = values[k];
    }
}

static void add_blades(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_blades, s);
    for (int b = 0; b < s->scene->turbine.n_blade; b++) add_numbered(list, BOUGH_CHANNELS_BLADE, b + 1);
}

// The rod nearest to the rotor that carries it, and the last of the rods that carry that one.
static void find_tower(bough_simulation *s) {
    const bough_scene *scene = s->scene;
    if (scene->turbine.node == NULL) return;
    for (int i = scene->turbine.rotor; i >= 0; i = scene->body[i].joint.parent) {
        const bough_beam *beam = bough_simulation_beam(s, i);
        bool carries = beam != NULL && beam->end >= 0;
        if (!carries && s->tower_top != NULL) break;
        if (!carries) continue;
        if (s->tower_top == NULL) s->tower_top = beam;
        s->tower_foot = beam;
    }
}

// The section of the top in the frame of the foot, `tip` being that in its own body's.
static bough_transform top_at_foot(const bough_simulation *s, bough_transform tip) {
    const bough_frame *markers = s->tree->markers;
    bough_transform foot = bough_tree_frame_pose(s->view, &markers[s->tower_foot->marker]);
    bough_transform top = bough_tree_frame_pose(s->view, &markers[s->tower_top->marker]);
    return bough_transform_compose(bough_transform_inverse(foot), bough_transform_compose(top, tip));
}

enum { TOWER_CHANNELS = 12 };

// Displacement and rotation of the top and the wrench on the foundation, all in the tower's axes.
static void sample_tower(void *self, double t, double *value) {
    const bough_simulation *s = self;
    double root[BOUGH_ROD_MOST_OUTPUTS];
    bough_quaternion p;
    bough_vec3 x = bough_simulation_beam_tip(s, s->tower_top, &p);
    bough_transform top = top_at_foot(s, (bough_transform){x, bough_rotation_matrix(p)});
    bough_vec3 d = bough_sub(top.position, s->tower_rest.position);
    bough_mat3 turned = bough_mat3_product(top.rotation, bough_mat3_transpose(s->tower_rest.rotation));
    bough_vec3 turn = bough_quaternion_logarithm(bough_quaternion_of_matrix(turned));
    value = bough_observe_vector(turn, BOUGH_DEGREE, bough_observe_vector(d, 1, value));
    bough_simulation_accelerate(s, t);
    bough_simulation_root(s, s->tower_foot, t, root);
    for (int k = 0; k < 6; k++) value[k] = root[k] / 1e3;
}

static void add_tower(bough_simulation *s, bough_channels *list) {
    const bough_rod_def *top = &s->tower_top->def;
    int n = top->n_segment;
    bough_tree_kinematics(s->tree, s->tree->initial, s->view); // where no rod is bent
    s->tower_rest =
        top_at_foot(s, (bough_transform){top->position[n], bough_rotation_matrix(top->rotation[n])});
    bough_simulation_update(s);
    bough_channels_group(list, sample_tower, s);
    bough_channel_family_add(list, BOUGH_CHANNELS_TOWER, "", "");
}

static bool is_blade(const bough_scene *scene, const bough_scene_body *body) {
    return bough_scene_blade(scene, (int)(body - scene->body)) >= 0;
}

// Where the tip of a rod that is no blade is, in ground axes.
static void sample_tips(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (is_blade(s->scene, beam->body)) continue;
        bough_transform pose = bough_tree_frame_pose(s->view, &s->tree->markers[beam->marker]);
        bough_vec3 d, turn;
        bough_simulation_tip_shift(s, beam, &d, &turn);
        bough_vec3 x = bough_add(beam->def.position[beam->def.n_segment], d);
        x = bough_add(pose.position, bough_mat3_mul(pose.rotation, x));
        value = bough_observe_vector(x, 1, value);
    }
}

static void add_tips(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_tips, s);
    for (int k = 0; k < s->n_beam; k++) {
        const bough_scene_body *body = s->beam[k].body;
        if (!is_blade(s->scene, body)) {
            bough_channel_family_add(list, BOUGH_CHANNELS_TIP, body->name, "");
        }
    }
}

// -- aerodynamics ---------------------------------------------------------------------------------

// The hub's angular velocity about the shaft [rad/s].
static double hub_spin(const bough_simulation *s) {
    int hub = s->scene->body[s->scene->turbine.blade[0]].joint.parent;
    bough_vec3 velocity = bough_tree_frame_velocity(s->view, &s->tree->bodies[hub]).angular;
    return bough_dot(velocity, bough_simulation_rotor(s).axis);
}

static void sample_aero(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    double factor;
    const bough_rotor_data *data = bough_aero_link_data(s->aero, &factor);
    value[0] = factor * data->thrust;
    value[1] = factor * data->torque;
    value[2] = factor * data->torque * hub_spin(s);
}

// The undisturbed wind where the hub stood at the start, in ground axes, and the mean over the rotor
// of the wind with the tower's influence relative to the blades, in the hub's.
static void sample_wind(void *self, double t, double *value) {
    const bough_simulation *s = self;
    double factor;
    const bough_frame *rotor = &s->tree->bodies[s->scene->turbine.rotor];
    bough_mat3 axes = bough_tree_frame_pose(s->view, rotor).rotation;
    bough_vec3 wind = bough_aero_link_hub_wind(s->aero, t);
    const bough_rotor_data *data = bough_aero_link_data(s->aero, &factor);
    bough_vec3 mean = bough_mat3_tmul(axes, bough_sub(data->disk_wind, data->disk_velocity));
    double ratio = hub_spin(s) * bough_simulation_rotor(s).radius / mean.x;
    const double values[] = {wind.x, wind.y, wind.z, mean.x, mean.y, mean.z, isfinite(ratio) ? ratio : 0};
    memcpy(value, values, sizeof values);
}

static void add_wind(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_wind, s);
    bough_channel_family_add(list, BOUGH_CHANNELS_WIND, "", "");
}

enum { NODE_CHANNELS = 10 };

static void sample_nodes(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    const bough_scene_aero *aero = &s->scene->aero;
    double factor;
    const bough_rotor_data *data = bough_aero_link_data(s->aero, &factor);
    for (int k = 0; k < s->scene->turbine.n_blade * aero->n_node; k++, value += NODE_CHANNELS) {
        int node = (int)aero->nodes[k % aero->n_node] - 1;
        bough_station x = bough_rotor_station(data, k / aero->n_node, node);
        const double values[NODE_CHANNELS] = {x.speed,
                                              x.alpha / BOUGH_DEGREE,
                                              x.phi / BOUGH_DEGREE,
                                              x.axial,
                                              x.tangential,
                                              x.coefficients.lift,
                                              x.coefficients.drag,
                                              x.coefficients.moment,
                                              factor * x.force_x,
                                              factor * x.force_y};
        memcpy(value, values, sizeof values);
    }
}

static void add_nodes(bough_simulation *s, bough_channels *list) {
    const bough_scene_aero *aero = &s->scene->aero;
    bough_channels_group(list, sample_nodes, s);
    for (int k = 0; k < s->scene->turbine.n_blade * aero->n_node; k++) {
        char blade[12], node[12];
        snprintf(blade, sizeof blade, "%d", k / aero->n_node + 1);
        snprintf(node, sizeof node, "%03d", (int)aero->nodes[k % aero->n_node]);
        bough_channel_family_add(list, BOUGH_CHANNELS_ELEMENT, blade, node);
    }
}

static void add_aero(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_aero, s);
    bough_channel_family_add(list, BOUGH_CHANNELS_AIR, "", "");
    add_wind(s, list);
    add_nodes(s, list);
}

// -- FMUs -----------------------------------------------------------------------------------------

static void sample_fmus(void *self, double t, double *value) {
    const bough_simulation *s = self;
    for (int k = 0; k < s->n_fmu; k++, value += BOUGH_SCENE_WRENCH) {
        const bough_system *fmu = &s->rod[s->n_rod + k].system;
        fmu->ops->output(fmu->self, t, NULL, NULL, value);
    }
}

static void add_fmus(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_fmus, s);
    for (int k = 0; k < s->n_fmu; k++) {
        bough_channel_family_add(list, BOUGH_CHANNELS_FMU, s->rod[s->n_rod + k].system.name, "");
    }
}

// -- control --------------------------------------------------------------------------------------

static void sample_control(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    double angle, speed, torque, power;
    bough_control_link_generator(s->control, &speed, &torque, &power);
    joint_state(s, s->scene->turbine.rotor, &angle, &speed);
    value[0] = s->scene->control.gear_ratio * speed / BOUGH_RPM;
    value[1] = torque / 1e3;
    value[2] = power / 1e3;
    for (int b = 0; b < s->scene->turbine.n_blade; b++) {
        const bough_beam *blade = bough_simulation_beam(s, s->scene->turbine.blade[b]);
        value[3 + b] = bough_simulation_pitch(s, blade) / BOUGH_DEGREE;
    }
}

static void add_control(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_control, s);
    bough_channel_family_add(list, BOUGH_CHANNELS_CONTROL, "", "");
    for (int b = 0; b < s->scene->turbine.n_blade; b++) add_numbered(list, BOUGH_CHANNELS_PITCH, b + 1);
}

// The measurements of a control law outside.
static void sample_law(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    double angle, speed;
    joint_state(s, s->scene->turbine.rotor, &angle, &speed);
    value[0] = s->scene->control.gear_ratio * speed;
    for (int b = 0; b < s->scene->turbine.n_blade; b++) {
        value[1 + b] = bough_simulation_pitch(s, bough_simulation_beam(s, s->scene->turbine.blade[b]));
    }
}

static void add_law(bough_simulation *s, bough_channels *list) {
    bough_channels_group(list, sample_law, s);
    bough_channel_family_add(list, BOUGH_CHANNELS_LAW, "", "");
    for (int b = 0; b < s->scene->turbine.n_blade; b++) add_numbered(list, BOUGH_CHANNELS_LAW_PITCH, b + 1);
}

bough_status bough_simulation_channels(bough_simulation *s, bough_channels *channels) {
    bool turbine = s->scene->turbine.node != NULL;
    const bough_scene_control *control = &s->scene->control;
    if (turbine) bough_observe_turn(s, channels);
    add_joints(s, channels);
    add_free_bodies(s, channels);
    add_drives(s, channels);
    add_springs(s, channels);
    add_bushings(s, channels);
    add_closures(s, channels);
    add_markers(s, channels);
    if (turbine) add_blades(s, channels);
    find_tower(s);
    if (s->tower_top != NULL) add_tower(s, channels);
    add_tips(s, channels);
    bough_observe_sections(s, channels);
    if (s->tower_top != NULL) bough_observe_yaw_bearing(s, channels);
    s->n_motion_channel = channels->count;
    add_fmus(s, channels);
    if (turbine) bough_observe_shaft(s, channels);
    if (s->aero != NULL) add_aero(s, channels);
    if (s->control != NULL) add_control(s, channels);
    if (control->node != NULL && control->kind == BOUGH_SCENE_EXTERNAL) add_law(s, channels);
    return channels->status;
}
