#include "apps/bough/model/events.h"

#include "apps/bough/config/schema.h"
#include "core/base/base.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct bough_events {
    bough_simulation *simulation;
    int n;
    const bough_scene_event *event; // (n)
    bough_channels channels;
    int *column;   // (n) channel of a threshold; −1: none
    double *value; // (channels.count) scratch
};

// -- building -------------------------------------------------------------------------------------

static bough_status find_channel(bough_arena *arena, bough_events *e, int i) {
    const char *name = e->event[i].channel;
    e->column[i] = name ? bough_channels_find(&e->channels, name) : -1;
    if (!name || e->column[i] >= 0) return bough_ok();
    int n = e->channels.count;
    const char **names = bough_arena_take(arena, (size_t)(n + 1) * sizeof *names);
    for (int k = 0; k < n; k++) names[k] = e->channels.channel[k].name;
    char key[40];
    snprintf(key, sizeof key, "control.events[%d].channel", i);
    bough_status status = bough_fail(BOUGH_INVALID, "the scene has no channel '%.80s'%s", name,
                                     bough_suggest(name, names, n).text);
    return bough_scene_blame(bough_node_find(e->event[i].node, "channel"), key, status);
}

static bough_status find_channels(bough_arena *arena, bough_events *e) {
    e->channels = bough_channels_start(arena);
    bough_status status = bough_simulation_channels(e->simulation, &e->channels);
    if (!bough_is_ok(&status)) return status;
    e->value = bough_arena_doubles(arena, (size_t)e->channels.count + 1);
    e->column = bough_arena_take(arena, (size_t)e->n * sizeof *e->column);
    for (int i = 0; i < e->n && bough_is_ok(&status); i++) status = find_channel(arena, e, i);
    return status;
}

bough_status bough_events_build(bough_arena *arena, bough_simulation *simulation, bough_events **events) {
    const bough_scene_control *control = &simulation->scene->control;
    if (control->n_event == 0) return bough_ok();
    bough_events *e = bough_arena_take(arena, sizeof *e);
    e->simulation = simulation;
    e->n = control->n_event;
    e->event = control->event;
    *events = e;
    return find_channels(arena, e);
}

// -- when -----------------------------------------------------------------------------------------

static double channel_at(bough_events *e, int column, double t) {
    for (int g = 0; g < e->channels.group_count; g++) {
        const bough_channel_group *group = &e->channels.group[g];
        if (column < group->first || column >= group->first + group->count) continue;
        group->sample(group->self, t, e->value + group->first);
    }
    return e->value[column];
}

static bool happens(bough_events *e, int i, double t) {
    const bough_scene_event *event = &e->event[i];
    double near = 1e-6 * e->simulation->master->macro_step;
    if (t < event->at - near) return false;
    if (e->column[i] < 0) return true;
    double value = channel_at(e, e->column[i], t);
    return event->falls ? value < event->threshold : value > event->threshold;
}

static double yaw_angle(const bough_simulation *s, int body) {
    int q, v;
    bough_tree_joint_rows(s->tree, body, &q, &v);
    return s->leader.state[q];
}

void bough_events_look(bough_events *e, const bough_discon_sensed *sensed, bough_event_state *state) {
    for (int i = 0; i < e->n; i++) {
        const bough_scene_event *event = &e->event[i];
        if (state[i].happened != 0 || !happens(e, i, sensed->time)) continue;
        state[i] = (bough_event_state){
            .happened = 1, .since = sensed->time, .torque = sensed->torque, .speed = sensed->generator_speed};
        if (event->blade > 0) state[i].angle = sensed->pitch[event->blade - 1];
        if (event->kind == BOUGH_SCENE_YAW_RUNAWAY) state[i].angle = yaw_angle(e->simulation, event->body);
    }
}

bool bough_events_idle(const bough_events *e, const bough_event_state *state) {
    for (int i = 0; i < e->n; i++)
        if (e->event[i].kind == BOUGH_SCENE_START && state[i].happened == 0) return true;
    return false;
}

// -- what -----------------------------------------------------------------------------------------

static double towards(double from, double to, double reach) {
    return bough_clamp(to, from - reach, from + reach);
}

static double rate_of(const bough_events *e, const bough_scene_event *event) {
    const double normal = 4 * BOUGH_PI / 180, yaw = 0.3 * BOUGH_PI / 180; // [rad/s]
    if (event->rate > 0) return event->rate;
    if (event->kind == BOUGH_SCENE_STOP) return normal;
    return event->kind == BOUGH_SCENE_YAW_RUNAWAY ? yaw : e->simulation->scene->control.law.pitch_rate;
}

static void pitch_to(const bough_events *e, const bough_scene_event *event, double to,
                     const bough_discon_sensed *sensed, bough_discon_demand *demand) {
    double reach = rate_of(e, event) * sensed->step;
    for (int b = 0; b < sensed->n_blade; b++) demand->pitch[b] = towards(sensed->pitch[b], to, reach);
}

static void feather(const bough_events *e, const bough_scene_event *event, const bough_discon_sensed *sensed,
                    bough_discon_demand *demand) {
    pitch_to(e, event, event->angle > 0 ? event->angle : BOUGH_PI / 2, sensed, demand);
}

// Pitched, the law demands rated power at any speed, which would stop a rotor that starts: until it is at
// rated speed or no longer pitched, it has the torque of an unpitched one.
static void run_up(const bough_events *e, const bough_discon_sensed *sensed, bough_event_state *state,
                   bough_discon_demand *demand) {
    const bough_controller_def *law = &e->simulation->scene->control.law;
    bool runs = sensed->generator_speed >= law->rated_speed || sensed->pitch[0] < law->power_pitch;
    if (runs) state->running = 1;
    if (state->running != 0) return;
    demand->torque = fmin(demand->torque, bough_controller_torque(law, sensed->generator_speed, 0));
}

// In ten seconds to none, below half the speed of the start also with the speed: a torque that stayed would
// turn a rotor that has stopped backwards.
static double stopping_torque(const bough_event_state *state, double gone, double speed) {
    const double ramp = 10; // [s]
    double left = fmax(0, 1 - gone / ramp), turning = state->speed > 0 ? 2 * speed / state->speed : 0;
    return state->torque * left * bough_clamp(turning, 0, 1);
}

// The joint goes at its rate; its speed jumps where that begins and ends.
static void turn_yaw(const bough_events *e, const bough_scene_event *event, const bough_discon_sensed *sensed,
                     const bough_event_state *state) {
    double rate = rate_of(e, event), gone = sensed->time - state->since;
    double now = towards(state->angle, event->angle, rate * gone);
    double then = towards(state->angle, event->angle, rate * (gone + sensed->step));
    double speed = (then - now) / sensed->step;
    bough_tree_steer(e->simulation->tree, event->body, sensed->time, sensed->step,
                     (bough_motion_point){now, speed, 0}, (bough_motion_point){then, speed, 0});
}

// Later orders prevail: a stop over a change of pitch, the fault of one blade over what all blades shall do.
enum { ORDERS = 3 };

static int order_of(const bough_scene_event *event) {
    return event->blade > 0 ? 2 : event->kind != BOUGH_SCENE_PITCH_TO;
}

static void change(const bough_events *e, int i, const bough_discon_sensed *sensed, bough_event_state *state,
                   bough_discon_demand *demand) {
    const bough_scene_event *event = &e->event[i];
    int b = event->blade - 1;
    double gone = sensed->time + sensed->step - state->since;
    switch ((bough_scene_event_kind)event->kind) {
    case BOUGH_SCENE_START:
        if (e->simulation->scene->control.kind == BOUGH_SCENE_VARIABLE_SPEED)
            run_up(e, sensed, state, demand);
        break;
    case BOUGH_SCENE_STOP:
        demand->torque = stopping_torque(state, gone, sensed->generator_speed);
        feather(e, event, sensed, demand);
        break;
    case BOUGH_SCENE_EMERGENCY_STOP:
        demand->torque = 0;
        feather(e, event, sensed, demand);
        break;
    case BOUGH_SCENE_GRID_LOSS: demand->torque = 0; break;
    case BOUGH_SCENE_PITCH_STUCK: demand->pitch[b] = state->angle; break;
    case BOUGH_SCENE_PITCH_RUNAWAY:
        demand->pitch[b] = towards(sensed->pitch[b], event->angle, rate_of(e, event) * sensed->step);
        break;
    case BOUGH_SCENE_PITCH_TO: pitch_to(e, event, event->angle, sensed, demand); break;
    case BOUGH_SCENE_YAW_RUNAWAY: turn_yaw(e, event, sensed, state); break;
    }
}

void bough_events_change(const bough_events *e, const bough_discon_sensed *sensed, bough_event_state *state,
                         bough_discon_demand *demand) {
    if (bough_events_idle(e, state)) {
        demand->torque = 0;
        for (int b = 0; b < sensed->n_blade; b++) demand->pitch[b] = sensed->pitch[b];
    }
    for (int order = 0; order < ORDERS; order++) {
        for (int i = 0; i < e->n; i++) {
            if (state[i].happened != 0 && order_of(&e->event[i]) == order)
                change(e, i, sensed, &state[i], demand);
        }
    }
}
