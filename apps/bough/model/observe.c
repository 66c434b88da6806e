// The channels of a simulation, part by part of the scene, with OpenFAST's names for equal quantities.
#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/build_internal.h"
#include "apps/bough/model/channel_table.h"
#include "apps/bough/model/control_link.h"
#include "apps/bough/model/simulation.h"
#include "core/tree/dynamics.h"
#include "core/tree/force.h"
#include "core/tree/loop.h"

// Adds the channels of the n parts of a kind. A part has the name that name() returns (NULL: it has no
// channels) or, without name(), its number. They form a group with the function `sample`; NULL: they belong
// to the last group.
static void add_each(bough_simulation *s, bough_channels *list, bough_channel_sample *sample,
                     bough_channel_part part, int n, const char *(*name)(const bough_simulation *s, int k)) {
    if (sample) bough_channels_group(list, sample, s);
    for (int k = 0; k < n; k++) {
        char number[12];
        snprintf(number, sizeof number, "%d", k + 1);
        const char *a = name ? name(s, k) : number;
        if (a) bough_channel_family_add(list, part, a, "");
    }
}

// -- joints ---------------------------------------------------------------------------------------

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
    bool rotor = scene->turbine.node != NULL && scene->turbine.rotor == body;
    return rotor ? 0 : joint_channels[scene->body[body].joint.kind].n;
}

static void sample_joints(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    for (int i = 0; i < s->scene->n_body; i++) {
        int n = n_recorded(s->scene, i), coordinate, speed;
        if (n == 0) continue;
        bough_tree_joint_rows(s->tree, i, &coordinate, &speed);
        int kind = s->scene->body[i].joint.kind;
        double rate[3];
        const double *q = s->leader.state + coordinate, *v = s->leader.state + speed;
        memcpy(rate, v, (size_t)n * sizeof *v);
        // only of a planar joint the speeds, in the body's axes, are not the rates of the coordinates
        if (kind == BOUGH_JOINT_PLANAR)
            bough_joint_rate(&s->tree->links[s->tree->bodies[i].link].joint, q, v, rate);
        for (int k = 0; k < n; k++, value += 2) {
            double unit = joint_channels[kind].angle[k] ? BOUGH_DEGREE : 1;
            value[0] = q[k] / unit;
            value[1] = rate[k] / unit;
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

// Directions in place of angles, which would jump.
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

// Forces and torques of prescribed motions under the rods' present forces.
static void sample_drives(void *self, double t, double *value) {
    const bough_simulation *s = self;
    bough_simulation_accelerate(s, t);
    for (int i = 0; i < s->scene->n_body; i++) {
        for (int k = 0, q, v; k < 2; k++) {
            if (s->scene->body[i].joint.motion[k].node == NULL) continue;
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
        if (body->joint.motion[i % 2].node != NULL) add_drive(body, i % 2, list);
    }
}

static void sample_springs(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    bough_vec3 direction;
    for (int k = 0; k < s->tree->n_springs; k++, value += 2)
        value[0] = bough_tree_spring(s->tree, s->view, k, &value[1], &direction);
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

// Forces and moments of closures under the rods' present forces.
static void sample_closures(void *self, double t, double *value) {
    const bough_simulation *s = self;
    bough_simulation_accelerate(s, t);
    for (int k = 0; k < s->tree->n_closures; k++, value += 6)
        bough_wrench_store(bough_loops_wrench(s->tree, s->view, k), value);
}

static void add_connectors(bough_simulation *s, bough_channels *list, bough_channel_sample *sample,
                           bough_channel_part part, bough_scene_connector_kind kind) {
    bough_channels_group(list, sample, s);
    for (int k = 0; k < s->scene->n_connector[kind]; k++)
        bough_channel_family_add(list, part, s->scene->connector[kind][k].name, "");
}

static void sample_markers(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    for (int k = 0; k < s->scene->n_marker; k++) {
        const bough_frame *marker = &s->tree->markers[s->first_marker + k];
        value = bough_observe_vector(bough_tree_frame_pose(s->view, marker).position, 1, value);
    }
}

static const char *name_marker(const bough_simulation *s, int k) { return s->scene->marker[k].name; }

// -- beams ----------------------------------------------------------------------------------------

// The root wrench is the blade's on the hub, in blade-root axes; out of and in plane are the tip's
// displacement along the axes before the pitch.
static void sample_blades(void *self, double t, double *value) {
    const bough_simulation *s = self;
    bough_simulation_accelerate(s, t);
    for (int b = 0; b < s->scene->turbine.n_blade; b++) {
        const bough_beam *beam = bough_simulation_blade(s, b);
        double pitch = bough_simulation_pitch(s, beam), c = cos(pitch), sine = sin(pitch);
        double root[BOUGH_ROD_MOST_OUTPUTS];
        bough_vec3 d, turn;
        bough_simulation_shift(s, beam, beam->def.n_segment, &d, &turn);
        bough_simulation_root(s, beam, t, root);
        *value++ = d.x * c + d.y * sine;
        *value++ = d.y * c - d.x * sine;
        *value++ = turn.z / BOUGH_DEGREE;
        value = bough_observe_vector(d, 1, value);
        for (int k = 0; k < 6; k++) *value++ = root[k] / 1e3;
    }
}

// Finds the chain of rods that carry the rotor: tower_top, the nearest to it, to tower_foot.
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

// The section of the top in the frame of the foot; `tip`: the section in its body's frame.
static bough_transform top_at_foot(const bough_simulation *s, bough_transform tip) {
    bough_transform foot = bough_beam_pose(s, s->tower_foot), top = bough_beam_pose(s, s->tower_top);
    return bough_transform_compose(bough_transform_inverse(foot), bough_transform_compose(top, tip));
}

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
    bough_channel_group_add(list, sample_tower, s, BOUGH_CHANNELS_TOWER);
}

static bool is_blade(const bough_simulation *s, const bough_beam *beam) {
    return bough_scene_blade(s->scene, beam->index) >= 0;
}

// Positions of the tips of rods other than blades, in ground axes.
static void sample_tips(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (is_blade(s, beam)) continue;
        bough_transform pose = bough_beam_pose(s, beam);
        bough_vec3 d, turn;
        bough_simulation_shift(s, beam, beam->def.n_segment, &d, &turn);
        bough_vec3 x = bough_add(beam->def.position[beam->def.n_segment], d);
        x = bough_add(pose.position, bough_mat3_mul(pose.rotation, x));
        value = bough_observe_vector(x, 1, value);
    }
}

static const char *name_tip(const bough_simulation *s, int k) {
    return is_blade(s, &s->beam[k]) ? NULL : s->beam[k].body->name;
}

// -- aerodynamics ---------------------------------------------------------------------------------

// The hub's angular velocity about the shaft [rad/s].
static double hub_spin(const bough_simulation *s) {
    int hub = s->scene->body[s->scene->turbine.blade[0]].joint.parent;
    bough_vec3 velocity = bough_tree_frame_velocity(s->view, &s->tree->bodies[hub]).angular;
    return bough_dot(velocity, bough_simulation_joint_axis(s, s->scene->turbine.rotor));
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

// Where the hub stood at the start, in ground axes.
static void sample_wind(void *self, double t, double *value) {
    const bough_simulation *s = self;
    bough_vec3 wind = bough_aero_link_hub_wind(s->aero, t);
    value[0] = wind.x, value[1] = wind.y, value[2] = wind.z;
}

// The mean over the rotor of the wind with the tower's influence relative to the blades, in the hub's axes.
static void sample_rotor_wind(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    bough_mat3 axes = bough_body_pose(s, s->scene->turbine.rotor).rotation;
    const bough_rotor_data *data = bough_aero_link_data(s->aero, NULL);
    bough_vec3 mean = bough_mat3_tmul(axes, bough_sub(data->disk_wind, data->disk_velocity));
    double tip = hub_spin(s) * bough_simulation_rotor(s).radius;
    bool blows = fabs(mean.x) > 1e-12 * fabs(tip); // beyond rounding
    value[0] = mean.x, value[1] = mean.y, value[2] = mean.z;
    value[3] = blows ? tip / mean.x : 0;
}

static void sample_nodes(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    const bough_scene_aero *aero = &s->scene->aero;
    double factor;
    const bough_rotor_data *data = bough_aero_link_data(s->aero, &factor);
    for (int k = 0; k < s->scene->turbine.n_blade * aero->n_node; k++) {
        int node = (int)aero->nodes[k % aero->n_node] - 1;
        bough_station x = bough_rotor_station(data, k / aero->n_node, node);
        *value++ = x.speed;
        *value++ = x.alpha / BOUGH_DEGREE;
        *value++ = x.phi / BOUGH_DEGREE;
        *value++ = x.axial;
        *value++ = x.tangential;
        *value++ = x.coefficients.lift;
        *value++ = x.coefficients.drag;
        *value++ = x.coefficients.moment;
        *value++ = factor * x.force_x;
        *value++ = factor * x.force_y;
    }
}

static void add_aero(bough_simulation *s, bough_channels *list) {
    const bough_scene_aero *aero = &s->scene->aero;
    bough_channel_group_add(list, sample_aero, s, BOUGH_CHANNELS_AIR);
    bough_channel_group_add(list, sample_wind, s, BOUGH_CHANNELS_WIND);
    bough_channel_group_add(list, sample_rotor_wind, s, BOUGH_CHANNELS_ROTOR_WIND);
    bough_channels_group(list, sample_nodes, s);
    for (int k = 0; k < s->scene->turbine.n_blade * aero->n_node; k++) {
        char blade[12], node[12];
        snprintf(blade, sizeof blade, "%d", k / aero->n_node + 1);
        snprintf(node, sizeof node, "%03d", (int)aero->nodes[k % aero->n_node]);
        bough_channel_family_add(list, BOUGH_CHANNELS_ELEMENT, blade, node);
    }
}

// -- FMUs -----------------------------------------------------------------------------------------

static void sample_fmus(void *self, double t, double *value) {
    const bough_simulation *s = self;
    for (int k = 0; k < s->n_fmu; k++, value += BOUGH_SCENE_WRENCH) {
        const bough_system *fmu = &s->rod[s->n_rod + k].system;
        fmu->ops->output(fmu->self, t, NULL, NULL, value);
    }
}

static const char *name_fmu(const bough_simulation *s, int k) { return s->rod[s->n_rod + k].system.name; }

// -- control --------------------------------------------------------------------------------------

static void sample_control(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    bough_generator generator = bough_control_link_generator(s->control);
    double speed = bough_simulation_joint_point(s, s->scene->turbine.rotor).v;
    value[0] = s->scene->control.gear_ratio * speed / BOUGH_RPM;
    value[1] = generator.torque / 1e3;
    value[2] = generator.power / 1e3;
    for (int b = 0; b < s->scene->turbine.n_blade; b++) {
        const bough_beam *blade = bough_simulation_blade(s, b);
        value[3 + b] = bough_simulation_pitch(s, blade) / BOUGH_DEGREE;
    }
}

// The measurements of a control law outside the program.
static void sample_law(void *self, double t, double *value) {
    (void)t;
    const bough_simulation *s = self;
    double speed = bough_simulation_joint_point(s, s->scene->turbine.rotor).v;
    value[0] = s->scene->control.gear_ratio * speed;
    for (int b = 0; b < s->scene->turbine.n_blade; b++) {
        value[1 + b] = bough_simulation_pitch(s, bough_simulation_blade(s, b));
    }
}

static void add_control(bough_simulation *s, bough_channels *list) {
    int n_blade = s->scene->turbine.n_blade;
    bough_channel_group_add(list, sample_control, s, BOUGH_CHANNELS_GENERATOR);
    bough_channel_family_add(list, BOUGH_CHANNELS_CONTROL, "", "");
    add_each(s, list, NULL, BOUGH_CHANNELS_PITCH, n_blade, NULL);
    if (s->scene->control.kind != BOUGH_SCENE_EXTERNAL) return;
    bough_channel_group_add(list, sample_law, s, BOUGH_CHANNELS_LAW);
    add_each(s, list, NULL, BOUGH_CHANNELS_LAW_PITCH, n_blade, NULL);
}

bough_status bough_simulation_channels(bough_simulation *s, bough_channels *channels) {
    const bough_scene *scene = s->scene;
    bool turbine = scene->turbine.node != NULL;
    if (turbine) bough_channel_group_add(channels, bough_observe_turn, s, BOUGH_CHANNELS_ROTOR);
    add_joints(s, channels);
    add_free_bodies(s, channels);
    add_drives(s, channels);
    add_connectors(s, channels, sample_springs, BOUGH_CHANNELS_SPRING, BOUGH_SCENE_SPRING);
    add_connectors(s, channels, sample_bushings, BOUGH_CHANNELS_BUSHING, BOUGH_SCENE_BUSHING);
    add_connectors(s, channels, sample_closures, BOUGH_CHANNELS_CLOSURE, BOUGH_SCENE_CLOSURE);
    add_each(s, channels, sample_markers, BOUGH_CHANNELS_MARKER, scene->n_marker, name_marker);
    add_each(s, channels, sample_blades, BOUGH_CHANNELS_BLADE, scene->turbine.n_blade, NULL);
    find_tower(s);
    if (s->tower_top != NULL) add_tower(s, channels);
    add_each(s, channels, sample_tips, BOUGH_CHANNELS_TIP, s->n_beam, name_tip);
    bough_observe_sections(s, channels);
    if (s->tower_top != NULL)
        bough_channel_group_add(channels, bough_observe_yaw_bearing, s, BOUGH_CHANNELS_YAW_BEARING);
    s->n_motion_channel = channels->count;
    add_each(s, channels, sample_fmus, BOUGH_CHANNELS_FMU, s->n_fmu, name_fmu);
    if (turbine) bough_observe_shaft(s, channels);
    if (s->aero != NULL) add_aero(s, channels);
    if (s->control != NULL) add_control(s, channels);
    return bough_scene_blame_named(scene, channels->status);
}
