#include "apps/bough/model/control_link.h"

#include "aero/control/discon.h"
#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/events.h"
#include "apps/bough/model/input_link.h"
#include "core/base/base.h"

#include <string.h>

enum { BLADES = BOUGH_MOST_BLADES };

// Doubles only.
typedef struct memory {
    bough_controller_state law;
    double torque;                          // of the generator, reached at the next sample [N m]
    double speed;                           // of the generator at the last sample [rad/s]
    bough_motion_point pitch_joint[BLADES]; // reached at the next sample
    double nacelle[4];                      // its motion at the last sample: see nacelle_motion
    double started;
} memory;

struct bough_control_link {
    bough_simulation *simulation;
    const bough_scene_control *control;
    bough_discon *discon; // NULL: the law
    int load, n_blade;
    bool steers;                                // the blades are pitched
    bough_events *events;                       // NULL: none
    bough_event_state event[BOUGH_MOST_EVENTS]; // as far as there are events
    memory now;
};

static int blade_body(const bough_control_link *l, int b) { return l->simulation->scene->turbine.blade[b]; }

static bough_motion_point joint_point(const bough_simulation *s, int body) {
    int q, v;
    bough_tree_joint_rows(s->tree, body, &q, &v);
    return (bough_motion_point){s->leader.state[q], s->leader.state[v], 0};
}

bough_status bough_control_link_build(bough_arena *arena, bough_simulation *simulation, int load,
                                      bough_control_link **link) {
    const bough_scene *scene = simulation->scene;
    bough_control_link *l = bough_arena_take(arena, sizeof *l);
    l->simulation = simulation;
    l->control = &scene->control;
    l->load = load;
    l->n_blade = scene->turbine.n_blade;
    l->steers = scene->control.pitch && scene->body[scene->turbine.blade[0]].joint.motion.node != NULL;
    for (int b = 0; b < l->n_blade && l->steers; b++)
        l->now.pitch_joint[b] = joint_point(simulation, blade_body(l, b));
    *link = l;
    if (l->control->kind == BOUGH_SCENE_EXTERNAL) return bough_ok();
    if (l->control->kind == BOUGH_SCENE_VARIABLE_SPEED) {
        return bough_scene_blame(l->control->node, "control", bough_controller_check(&l->control->law));
    }
    bough_status status =
        bough_discon_open(arena, l->control->library, l->control->input, l->control->copied, &l->discon);
    return bough_scene_blame(bough_node_find(l->control->node, "library"), "control.library", status);
}

bough_status bough_control_link_watch(bough_arena *arena, bough_control_link *link) {
    return bough_events_build(arena, link->simulation, &link->events);
}

bool bough_control_link_pitches(const bough_control_link *link) { return link->steers; }

void bough_control_link_stand(bough_control_link *link, double speed, double pitch) {
    double gear = link->control->gear_ratio;
    bough_control_link_put(link, bough_controller_torque(&link->control->law, gear * speed, pitch), pitch);
    link->now.speed = gear * speed;
}

void bough_control_link_put(bough_control_link *link, double torque, double pitch) {
    bough_simulation *s = link->simulation;
    double gear = link->control->gear_ratio;
    bough_tree_steer_load(s->tree, link->load, 0, 1, -gear * torque, -gear * torque);
    for (int b = 0; b < link->n_blade && link->steers; b++) {
        int body = blade_body(link, b);
        bough_motion_point at = {s->scene->body[body].pitch - pitch, 0, 0};
        bough_tree_steer(s->tree, body, 0, 1, at, at);
        link->now.pitch_joint[b] = at;
    }
    link->now.torque = torque;
}

// -- sample ---------------------------------------------------------------------------------------

// Moments of a blade on its root out of the plane of rotation and in it.
static void root_moments(const bough_control_link *l, int b, double t, double *out, double *in) {
    const bough_beam *beam = bough_simulation_beam(l->simulation, blade_body(l, b));
    double root[BOUGH_ROD_MOST_OUTPUTS], pitch = bough_simulation_pitch(l->simulation, beam);
    bough_simulation_root(l->simulation, beam, t, root);
    *out = root[4] * cos(pitch) - root[3] * sin(pitch);
    *in = root[3] * cos(pitch) + root[4] * sin(pitch);
}

static double hub_wind(const bough_simulation *s) {
    double factor;
    if (s->aero == NULL) return 0;
    return bough_norm(bough_aero_link_data(s->aero, &factor)->disk_wind);
}

// How the body that carries the rotor moves: velocity of its origin in ground axes, and its angular
// velocity about its own y.
static void nacelle_motion(const bough_simulation *s, double motion[4]) {
    int body = s->scene->body[s->scene->turbine.rotor].joint.parent;
    memset(motion, 0, 4 * sizeof *motion);
    if (body == BOUGH_GROUND) return;
    const bough_frame *frame = &s->tree->bodies[body];
    bough_vec3 v = bough_tree_frame_velocity(s->view, frame).linear;
    motion[0] = v.x, motion[1] = v.y, motion[2] = v.z;
    motion[3] = bough_tree_frame_twist(s->view, frame).angular.y;
}

// Where nacelle and wind look, and the nacelle's accelerations, as differences over the last sample.
static void sense_nacelle(bough_control_link *l, double t, bough_discon_sensed *x) {
    const bough_simulation *s = l->simulation;
    bough_vec3 axis = bough_simulation_rotor(s).axis;
    double motion[4], *last = l->now.nacelle;
    x->heading = atan2(axis.y, axis.x);
    if (s->aero != NULL) {
        bough_vec3 wind = bough_aero_link_hub_wind(s->aero, t);
        if (wind.x != 0 || wind.y != 0)
            x->yaw_error = remainder(atan2(wind.y, wind.x) - x->heading, 2 * BOUGH_PI);
    }
    nacelle_motion(s, motion);
    if (l->now.started != 0) {
        double c = cos(x->heading), sine = sin(x->heading);
        double ax = (motion[0] - last[0]) / x->step, ay = (motion[1] - last[1]) / x->step;
        x->acceleration[0] = ax * c + ay * sine;
        x->acceleration[1] = ay * c - ax * sine;
        x->nodding = (motion[3] - last[3]) / x->step;
    }
    memcpy(last, motion, sizeof motion);
}

// The generator's losses lower what it gives and add to what it takes [W].
static double electrical_power(const bough_scene_control *c, double speed, double torque) {
    bool takes = torque < 0 && c->efficiency > 0;
    return takes ? speed * torque / c->efficiency : speed * torque * c->efficiency;
}

static bough_discon_sensed sense(bough_control_link *l, double t, double step, double speed) {
    const bough_simulation *s = l->simulation;
    double azimuth, hub_speed;
    bough_simulation_hub_turn(s, &azimuth, &hub_speed);
    bough_discon_sensed x = {.time = t,
                             .step = step,
                             .last = t + step > s->master->duration - 1e-6 * step,
                             .n_blade = l->n_blade,
                             .individual = l->control->individual,
                             .generator_speed = speed,
                             .rotor_speed = hub_speed,
                             .torque = l->now.torque,
                             .shaft_power = speed * l->now.torque,
                             .electrical_power = electrical_power(l->control, speed, l->now.torque),
                             .wind = hub_wind(s),
                             .azimuth = azimuth - 2 * BOUGH_PI * floor(azimuth / 2 / BOUGH_PI)};
    for (int b = 0; b < l->n_blade; b++) {
        x.pitch[b] = bough_simulation_pitch(s, bough_simulation_beam(s, blade_body(l, b)));
        root_moments(l, b, t, &x.root_moment[b], &x.in_plane[b]);
    }
    if (l->discon) sense_nacelle(l, t, &x);
    return x;
}

static bough_status take_inputs(const bough_control_link *l, bough_discon_demand *demand) {
    const bough_scene *scene = l->simulation->scene;
    const double *value = bough_input_link_values(l->simulation->inputs);
    for (int k = 0; k < scene->n_input; k++) {
        const bough_scene_input *input = &scene->input[k];
        if (input->kind == BOUGH_INPUT_TORQUE) demand->torque = value[k];
        if (input->kind == BOUGH_INPUT_PITCH) demand->pitch[input->index] = value[k];
    }
    return bough_ok();
}

static bough_status decide(bough_control_link *l, const bough_discon_sensed *x, bough_discon_demand *demand) {
    if (l->events && bough_events_idle(l->events, l->event)) return bough_ok();
    if (l->discon) return bough_discon_call(l->discon, x, demand);
    if (l->control->kind == BOUGH_SCENE_EXTERNAL) return take_inputs(l, demand);
    bough_controller_state *law = &l->now.law;
    bough_controller_advance(&l->control->law, x->generator_speed, x->pitch[0], x->step, law);
    demand->torque = law->torque;
    for (int b = 0; b < BLADES; b++) demand->pitch[b] = law->pitch;
    return bough_ok();
}

// To the demanded pitch, as fast as it may turn.
static void steer(bough_control_link *l, int b, double t, double step, double pitch) {
    bough_simulation *s = l->simulation;
    int body = blade_body(l, b);
    double reach = l->control->law.pitch_rate * step;
    bough_motion_point from = l->now.pitch_joint[b], to;
    to.q = bough_clamp(s->scene->body[body].pitch - pitch, from.q - reach, from.q + reach);
    to.v = (to.q - from.q) / step;
    to.a = 0;
    bough_tree_steer(s->tree, body, t, step, from, to);
    l->now.pitch_joint[b] = to;
}

static bough_status sample(void *self, double t, double t_next, bool *jumped) {
    bough_control_link *l = self;
    bough_simulation *s = l->simulation;
    const bough_scene_control *control = l->control;
    double step = t_next - t;
    bough_simulation_update(s);
    bough_motion_point rotor = joint_point(s, s->scene->turbine.rotor);
    double speed = control->gear_ratio * rotor.v;
    bough_discon_sensed sensed = sense(l, t, step, speed);
    bough_discon_demand demand = {0};
    if (l->events) {
        bough_events_look(l->events, &sensed, l->event);
    }
    bough_status status = decide(l, &sensed, &demand);
    if (!bough_is_ok(&status)) return status;
    if (l->events) {
        bough_events_change(l->events, &sensed, l->event, &demand);
    }
    double before = l->now.started != 0 ? l->now.torque : demand.torque;
    bough_tree_steer_load(s->tree, l->load, t, step, -control->gear_ratio * before,
                          -control->gear_ratio * demand.torque);
    for (int b = 0; b < l->n_blade && l->steers; b++) steer(l, b, t, step, demand.pitch[b]);
    *jumped = l->now.started == 0;
    l->now.torque = demand.torque;
    l->now.speed = speed;
    l->now.started = 1;
    return bough_ok();
}

bough_sampled_load bough_control_link_load(bough_control_link *link) {
    return (bough_sampled_load){1 / link->control->rate, link, sample, NULL, NULL};
}

void bough_control_link_generator(const bough_control_link *l, double *speed, double *torque, double *power) {
    *speed = l->now.speed;
    *torque = l->now.torque;
    *power = electrical_power(l->control, l->now.speed, l->now.torque);
}

void bough_control_link_snapshot(bough_control_link *link, bough_snapshot *s) {
    size_t events = link->events ? (size_t)link->control->n_event : 0;
    bough_snapshot_take(s, &link->now, sizeof link->now);
    bough_snapshot_take(s, link->event, events * sizeof *link->event);
}
