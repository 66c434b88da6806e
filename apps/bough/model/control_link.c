#include "apps/bough/model/control_link.h"

#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/fmu_instance.h"

// State of an event. Doubles only: a copy has no padding.
typedef struct event_state {
    double happened; // 0: not yet
    double since;    // [s]
    double torque;   // of the generator then [N m]
    double speed;    // of the generator then [rad/s]
    double angle;    // of the blade's pitch or the yaw joint then [rad]
    double running;  // after a start: 1 once the torque is that of the law
} event_state;

enum { BLADES = BOUGH_MOST_BLADES };

// Memory of the samples. Doubles only: a copy has no padding.
typedef struct memory {
    bough_controller_state law;
    double torque;                          // of the generator, reached at the next sample [N m]
    double speed;                           // of the generator at the last sample [rad/s]
    bough_motion_point pitch_joint[BLADES]; // reached at the next sample
    double sudden;     // last time at which the rate of a pitch changed by more than `least_sudden` [s]
    double nacelle[4]; // motion of the nacelle at the last sample: see nacelle_motion
    double started;
} memory;

struct bough_control_link {
    bough_simulation *simulation;
    const bough_scene_control *control;
    bough_discon *discon;    // NULL: none
    bough_fmu_instance *fmu; // NULL: none
    int load, n_blade;
    bool steers;                          // it pitches the blades
    event_state event[BOUGH_MOST_EVENTS]; // (control->n_event)
    int *column;                          // (n_event) channel of a threshold; −1: none
    bough_channels channels;              // for thresholds
    double *value;                        // (channels.count) scratch
    memory now;
};

// -- events ---------------------------------------------------------------------------------------

// Events in the operation of the turbine: start, stop, loss of the grid, faults of pitch and yaw, at given
// times or when a channel passes a threshold. They change the demands of the controller.

static bough_status find_channel(bough_arena *arena, bough_control_link *l, int i) {
    const char *name = l->control->event[i].channel;
    l->column[i] = name ? bough_channels_find(&l->channels, name) : -1;
    if (!name || l->column[i] >= 0) return bough_ok();
    const char *const *names = bough_channels_names(&l->channels, arena);
    char key[40];
    snprintf(key, sizeof key, "control.events[%d].channel", i);
    bough_status status = bough_fail(BOUGH_INVALID, "the scene has no channel '%.80s'%s", name,
                                     bough_suggest(name, names, l->channels.count).text);
    return bough_scene_blame(bough_node_find(l->control->event[i].node, "channel"), key, status);
}

bough_status bough_control_link_watch(bough_arena *arena, bough_control_link *l) {
    if (l->control->n_event == 0) return bough_ok();
    l->channels = bough_channels_start(arena);
    BOUGH_TRY(bough_simulation_channels(l->simulation, &l->channels));
    l->value = bough_arena_doubles(arena, (size_t)l->channels.count + 1);
    l->column = bough_arena_take(arena, (size_t)l->control->n_event * sizeof *l->column);
    for (int i = 0; i < l->control->n_event; i++) BOUGH_TRY(find_channel(arena, l, i));
    return bough_ok();
}

// -- when events happen ---------------------------------------------------------------------------

static double channel_at(bough_control_link *l, int column, double t) {
    for (int g = 0; g < l->channels.group_count; g++) {
        const bough_channel_group *group = &l->channels.group[g];
        if (column < group->first || column >= group->first + group->count) continue;
        group->sample(group->self, t, l->value + group->first);
    }
    return l->value[column];
}

static bool happens(bough_control_link *l, int i, double t) {
    const bough_scene_event *event = &l->control->event[i];
    double near = 1e-6 * l->simulation->master->macro_step;
    if (t < event->at - near) return false;
    if (l->column[i] < 0) return true;
    double value = channel_at(l, l->column[i], t);
    return event->falls ? value < event->threshold : value > event->threshold;
}

// Marks the events up to the time of `sensed`.
static void look_for_events(bough_control_link *l, const bough_discon_sensed *sensed) {
    event_state *state = l->event;
    for (int i = 0; i < l->control->n_event; i++) {
        const bough_scene_event *event = &l->control->event[i];
        if (state[i].happened != 0 || !happens(l, i, sensed->time)) continue;
        state[i] = (event_state){
            .happened = 1, .since = sensed->time, .torque = sensed->torque, .speed = sensed->generator_speed};
        if (event->blade > 0) state[i].angle = sensed->pitch[event->blade - 1];
        if (event->kind == BOUGH_SCENE_YAW_RUNAWAY)
            state[i].angle = bough_simulation_joint_point(l->simulation, event->body).q;
    }
}

// Whether the turbine idles before its start.
static bool idles(const bough_control_link *l) {
    for (int i = 0; i < l->control->n_event; i++)
        if (l->control->event[i].kind == BOUGH_SCENE_START && l->event[i].happened == 0) return true;
    return false;
}

// -- effects of events ----------------------------------------------------------------------------

static double towards(double from, double to, double reach) {
    return bough_clamp(to, from - reach, from + reach);
}

static double rate_of(const bough_control_link *l, const bough_scene_event *event) {
    const double normal = 4 * BOUGH_DEGREE, yaw = 0.3 * BOUGH_DEGREE; // [rad/s]
    if (event->rate > 0) return event->rate;
    if (event->kind == BOUGH_SCENE_STOP) return normal;
    return event->kind == BOUGH_SCENE_YAW_RUNAWAY ? yaw : l->control->law.pitch_rate;
}

static void pitch_to(const bough_control_link *l, const bough_scene_event *event, double to,
                     const bough_discon_sensed *sensed, bough_discon_demand *demand) {
    double reach = rate_of(l, event) * sensed->step;
    for (int b = 0; b < sensed->n_blade; b++) demand->pitch[b] = towards(sensed->pitch[b], to, reach);
}

// At a large pitch the law demands rated power at any speed, which would stop a rotor that starts: until it
// reaches rated speed or a small pitch, its torque is that at zero pitch.
static void run_up(const bough_control_link *l, const bough_discon_sensed *sensed, event_state *state,
                   bough_discon_demand *demand) {
    const bough_controller_def *law = &l->control->law;
    bool runs = sensed->generator_speed >= law->rated_speed || sensed->pitch[0] < law->power_pitch;
    if (runs) state->running = 1;
    if (state->running != 0) return;
    demand->torque = fmin(demand->torque, bough_controller_torque(law, sensed->generator_speed, 0));
}

// Falls to zero within ten seconds and, below half of the initial speed, with the speed: a constant torque
// would accelerate a rotor backwards that has stopped.
static double stopping_torque(const event_state *state, double gone, double speed) {
    const double ramp = 10; // [s]
    double left = fmax(0, 1 - gone / ramp), turning = state->speed > 0 ? 2 * speed / state->speed : 0;
    return state->torque * left * bough_clamp(turning, 0, 1);
}

// The joint moves at a constant rate; its speed jumps at the start and the end.
static void turn_yaw(const bough_control_link *l, const bough_scene_event *event,
                     const bough_discon_sensed *sensed, const event_state *state) {
    double rate = rate_of(l, event), gone = sensed->time - state->since;
    double now = towards(state->angle, event->angle, rate * gone);
    double then = towards(state->angle, event->angle, rate * (gone + sensed->step));
    double speed = (then - now) / sensed->step;
    bough_tree_steer(l->simulation->tree, event->body, sensed->time, sensed->step,
                     (bough_motion_point){now, speed, 0}, (bough_motion_point){then, speed, 0});
}

// Events of higher priority change the demand last: a stop after a change of pitch, the fault of one blade
// after demands for all blades.
enum { PRIORITIES = 3 };

static int priority_of(const bough_scene_event *event) {
    return event->blade > 0 ? 2 : event->kind != BOUGH_SCENE_PITCH_TO;
}

static void change(bough_control_link *l, int i, const bough_discon_sensed *sensed,
                   bough_discon_demand *demand) {
    const bough_scene_event *event = &l->control->event[i];
    event_state *state = &l->event[i];
    int b = event->blade - 1;
    double gone = sensed->time + sensed->step - state->since;
    switch ((bough_scene_event_kind)event->kind) {
    case BOUGH_SCENE_START:
        if (l->control->kind != BOUGH_SCENE_VARIABLE_SPEED) break;
        run_up(l, sensed, state, demand);
        demand->torque = fmin(demand->torque, l->now.torque + l->control->law.torque_rate * sensed->step);
        break;
    case BOUGH_SCENE_STOP:
        demand->torque = stopping_torque(state, gone, sensed->generator_speed);
        pitch_to(l, event, event->angle, sensed, demand);
        break;
    case BOUGH_SCENE_EMERGENCY_STOP:
        demand->torque = 0;
        pitch_to(l, event, event->angle, sensed, demand);
        break;
    case BOUGH_SCENE_GRID_LOSS: demand->torque = 0; break;
    case BOUGH_SCENE_PITCH_STUCK: demand->pitch[b] = state->angle; break;
    case BOUGH_SCENE_PITCH_RUNAWAY:
        demand->pitch[b] = towards(sensed->pitch[b], event->angle, rate_of(l, event) * sensed->step);
        break;
    case BOUGH_SCENE_PITCH_TO: pitch_to(l, event, event->angle, sensed, demand); break;
    case BOUGH_SCENE_YAW_RUNAWAY: turn_yaw(l, event, sensed, state); break;
    }
}

// Changes the demand for the next step by the events so far.
static void change_demand(bough_control_link *l, const bough_discon_sensed *sensed,
                          bough_discon_demand *demand) {
    if (idles(l)) {
        demand->torque = 0;
        for (int b = 0; b < sensed->n_blade; b++) demand->pitch[b] = sensed->pitch[b];
    }
    for (int priority = 0; priority < PRIORITIES; priority++) {
        for (int i = 0; i < l->control->n_event; i++) {
            if (l->event[i].happened != 0 && priority_of(&l->control->event[i]) == priority)
                change(l, i, sensed, demand);
        }
    }
}

// -- steady operation -----------------------------------------------------------------------------

static int blade_body(const bough_control_link *l, int b) { return l->simulation->scene->turbine.blade[b]; }

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

// Moments of a blade at its root, for bending out of the plane of rotation and in it.
static void root_moments(const bough_control_link *l, int b, double t, double *out, double *in) {
    const bough_beam *beam = bough_simulation_blade(l->simulation, b);
    double root[BOUGH_ROD_MOST_OUTPUTS], pitch = bough_simulation_pitch(l->simulation, beam);
    bough_simulation_root(l->simulation, beam, t, root);
    *out = root[4] * cos(pitch) - root[3] * sin(pitch);
    *in = root[3] * cos(pitch) + root[4] * sin(pitch);
}

// Speed of the undisturbed wind at the hub, its horizontal part.
static double hub_wind(const bough_simulation *s, double t) {
    bough_vec3 wind = s->aero ? bough_aero_link_hub_wind(s->aero, t) : bough_v3(0, 0, 0);
    return hypot(wind.x, wind.y);
}

// Motion of the body that carries the rotor: velocity of its origin in ground axes, angular velocity about
// its y.
static void nacelle_motion(const bough_simulation *s, double motion[4]) {
    int body = s->scene->body[s->scene->turbine.rotor].joint.parent;
    memset(motion, 0, 4 * sizeof *motion);
    if (body == BOUGH_GROUND) return;
    const bough_frame *frame = &s->tree->bodies[body];
    bough_vec3 v = bough_tree_frame_velocity(s->view, frame).linear;
    motion[0] = v.x, motion[1] = v.y, motion[2] = v.z;
    motion[3] = bough_tree_frame_twist(s->view, frame).angular.y;
}

// Directions of nacelle and wind, and accelerations of the nacelle by differences over the last sample.
static void sense_nacelle(bough_control_link *l, double t, bough_discon_sensed *x) {
    const bough_simulation *s = l->simulation;
    bough_vec3 axis = bough_simulation_joint_axis(s, s->scene->turbine.rotor);
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

// Losses reduce the power that the generator gives and add to the power that it takes [W].
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
                             .wind = hub_wind(s, t),
                             .azimuth = azimuth - 2 * BOUGH_PI * floor(azimuth / 2 / BOUGH_PI)};
    for (int b = 0; b < l->n_blade; b++) x.pitch[b] = bough_simulation_pitch(s, bough_simulation_blade(s, b));
    if (l->discon == NULL) return x;
    bough_simulation_accelerate(s, t);
    for (int b = 0; b < l->n_blade; b++) root_moments(l, b, t, &x.root_moment[b], &x.in_plane[b]);
    sense_nacelle(l, t, &x);
    return x;
}

static void take_inputs(const bough_simulation *s, bough_discon_demand *demand) {
    for (int k = 0; k < s->scene->n_input; k++) {
        const bough_scene_input *input = &s->scene->input[k];
        if (input->kind == BOUGH_INPUT_TORQUE) demand->torque = s->input[k];
        if (input->kind == BOUGH_INPUT_PITCH) demand->pitch[input->index] = s->input[k];
    }
}

// A communication step over the sample; the demands are for its end.
static bough_status step_fmu(bough_control_link *l, const bough_discon_sensed *x,
                             bough_discon_demand *demand) {
    const bough_scene_control_fmu *fmu = &l->control->fmu;
    double all[BOUGH_FMU_VALUES] = {[BOUGH_SENSED_TIME] = x->time,
                                    [BOUGH_SENSED_GENERATOR_SPEED] = x->generator_speed,
                                    [BOUGH_SENSED_ROTOR_SPEED] = x->rotor_speed,
                                    [BOUGH_SENSED_TORQUE] = x->torque,
                                    [BOUGH_SENSED_POWER] = x->electrical_power,
                                    [BOUGH_SENSED_WIND] = x->wind,
                                    [BOUGH_SENSED_AZIMUTH] = x->azimuth,
                                    [BOUGH_SENSED_YAW_ERROR] = x->yaw_error};
    memcpy(all + BOUGH_SCENE_SENSED, x->pitch, sizeof x->pitch);
    if (l->fmu->started) {
        BOUGH_TRY(bough_fmu_set(l->fmu, x->time, &fmu->inputs.values, all));
    } else {
        BOUGH_TRY(
            bough_fmu_initialise(l->fmu, x->time, l->simulation->master->duration, &fmu->inputs.values, all));
    }
    BOUGH_TRY(bough_fmu_step(l->fmu, x->time, x->step));
    all[BOUGH_SENSED_TORQUE] = 0; // unless it is an output
    BOUGH_TRY(bough_fmu_get(l->fmu, x->time + x->step, &fmu->outputs.values, all));
    demand->torque = all[BOUGH_SENSED_TORQUE];
    // a single pitch is for all blades; without any, blades keep theirs
    int n = fmu->outputs.n_pitch;
    for (int b = 0; b < x->n_blade; b++)
        demand->pitch[b] = n == 0 ? x->pitch[b] : all[BOUGH_SCENE_SENSED + (n == 1 ? 0 : b)];
    return bough_ok();
}

// The pitch of the blade that follows the last demand best: one with a fault does not lead the others.
static double led_pitch(const bough_discon_sensed *x, double demand) {
    double pitch = x->pitch[0];
    for (int b = 1; b < x->n_blade; b++)
        if (fabs(x->pitch[b] - demand) < fabs(pitch - demand)) pitch = x->pitch[b];
    return pitch;
}

static bough_status decide(bough_control_link *l, const bough_discon_sensed *x, bough_discon_demand *demand) {
    if (idles(l)) return bough_ok();
    if (l->discon) return bough_discon_call(l->discon, x, demand);
    if (l->fmu) return step_fmu(l, x, demand);
    if (l->control->kind == BOUGH_SCENE_EXTERNAL) {
        take_inputs(l->simulation, demand);
        return bough_ok();
    }
    bough_controller_state *law = &l->now.law;
    bough_controller_advance(&l->control->law, x->generator_speed, led_pitch(x, law->pitch), x->step, law);
    demand->torque = law->torque;
    for (int b = 0; b < BLADES; b++) demand->pitch[b] = law->pitch;
    return bough_ok();
}

static const double least_sudden = 1 * BOUGH_DEGREE; // [rad/s]

double bough_control_link_sudden(const bough_control_link *link) { return link->now.sudden; }

// Moves a blade towards the demanded pitch, at most at the largest rate.
static void steer(bough_control_link *l, int b, double t, double step, double pitch) {
    bough_simulation *s = l->simulation;
    int body = blade_body(l, b);
    double reach = l->control->law.pitch_rate * step;
    bough_motion_point from = l->now.pitch_joint[b], to;
    to.q = bough_clamp(s->scene->body[body].pitch - pitch, from.q - reach, from.q + reach);
    to.v = (to.q - from.q) / step;
    to.a = 0;
    bough_tree_steer(s->tree, body, t, step, from, to);
    if (fabs(to.v - from.v) > least_sudden) l->now.sudden = t;
    l->now.pitch_joint[b] = to;
}

static bough_status sample(void *self, double t, double t_next, bool *jumped) {
    bough_control_link *l = self;
    bough_simulation *s = l->simulation;
    const bough_scene_control *control = l->control;
    double step = t_next - t;
    bough_simulation_update(s);
    bough_motion_point rotor = bough_simulation_joint_point(s, s->scene->turbine.rotor);
    double speed = control->gear_ratio * rotor.v;
    bough_discon_sensed sensed = sense(l, t, step, speed);
    bough_discon_demand demand = {0};
    look_for_events(l, &sensed);
    BOUGH_TRY(decide(l, &sensed, &demand));
    change_demand(l, &sensed, &demand);
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

bough_generator bough_control_link_generator(const bough_control_link *l) {
    double speed = l->now.speed, torque = l->now.torque;
    return (bough_generator){speed, torque, electrical_power(l->control, speed, torque)};
}

// The memory of a controller outside the program is not included.
static void snapshot(void *self, bough_snapshot *s) {
    bough_control_link *link = self;
    bough_snapshot_take(s, &link->now, sizeof link->now);
    bough_snapshot_take(s, link->event, (size_t)link->control->n_event * sizeof *link->event);
}

// -- whole ----------------------------------------------------------------------------------------

bough_status bough_control_link_build(bough_arena *arena, bough_simulation *simulation) {
    const bough_scene *scene = simulation->scene;
    if (scene->control.node == NULL) return bough_ok();
    bough_control_link *l = bough_arena_take(arena, sizeof *l);
    l->simulation = simulation;
    l->control = &scene->control;
    l->load = simulation->tree->n_loads - 1;
    l->n_blade = scene->turbine.n_blade;
    l->now.sudden = -HUGE_VAL;
    l->steers = scene->control.pitch && scene->body[scene->turbine.blade[0]].joint.motion[0].node != NULL;
    for (int b = 0; b < l->n_blade && l->steers; b++)
        l->now.pitch_joint[b] = bough_simulation_joint_point(simulation, blade_body(l, b));
    simulation->control = l;
    simulation->sampled[simulation->n_sampled++] = (bough_sampled_load){
        .period = 1 / l->control->rate, .self = l, .sample = sample, .snapshot = snapshot};
    if (l->control->kind == BOUGH_SCENE_EXTERNAL) return bough_ok();
    if (l->control->kind == BOUGH_SCENE_VARIABLE_SPEED) {
        return bough_scene_blame(l->control->node, "control", bough_controller_check(&l->control->law));
    }
    if (l->control->kind == BOUGH_SCENE_CONTROL_FMU) {
        l->fmu = bough_arena_take(arena, sizeof *l->fmu);
        return bough_fmu_open(arena, &l->control->fmu.model, "control", l->fmu);
    }
    bough_status status =
        bough_discon_open(arena, l->control->library, l->control->input, l->control->copied, &l->discon);
    return bough_scene_blame(bough_node_find(l->control->node, "library"), "control.library", status);
}
