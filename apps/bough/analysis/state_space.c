// The linear system theory (78), by differences.
#include "apps/bough/analysis/state_space.h"

#include "apps/bough/analysis/air_tangent.h"
#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/control_link.h"
#include "apps/bough/model/equilibrium.h"

#include <stdarg.h>

// Differences: of a state in units of its scale, of an input relative to its value or to 1.
static const double difference = 3e-4;

typedef enum input_kind { SCENE_LOAD, GENERATOR_TORQUE, COLLECTIVE_PITCH, WIND_SPEED } input_kind;

typedef struct input {
    input_kind kind;
    int index; // of a scene's input
    double base;
} input;

typedef struct work {
    bough_simulation *s;
    bough_whole *whole;
    bough_channels channels;
    double time;
    const double *about;        // (n) states of the members
    double *state, *scale;      // (n)
    double *rate[2], *value[2]; // (n), (n_output) on either side
    int n_input;
    input *input; // (n_input)
    double *size; // (n_input)
} work;

__attribute__((format(printf, 3, 4))) static void name_signal(bough_signal_name *to, const char *unit,
                                                              const char *format, ...) {
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(to->name, sizeof to->name, format, arguments);
    va_end(arguments);
    to->unit = unit;
}

// -- inputs ---------------------------------------------------------------------------------------

// A change of pitch is a prescribed motion, to which the leader's state is set.
static void set_input(void *self, int k, double change, double *state) {
    const work *w = self;
    bough_simulation *s = w->s;
    double value = w->input[k].base + change, torque;
    switch (w->input[k].kind) {
    case SCENE_LOAD: bough_simulation_put(s, w->input[k].index, value); break;
    case WIND_SPEED: bough_aero_link_set_wind(s->aero, value); break;
    case GENERATOR_TORQUE:
    case COLLECTIVE_PITCH:
        torque = bough_control_link_generator(s->control).torque;
        double pitch = bough_simulation_pitch(s, bough_simulation_blade(s, 0));
        if (w->input[k].kind == GENERATOR_TORQUE) torque = value;
        if (w->input[k].kind == COLLECTIVE_PITCH) pitch = value;
        bough_control_link_put(s->control, torque, pitch);
        if (s->leader.system.ops->constrain)
            s->leader.system.ops->constrain(s->leader.system.self, w->time, state);
        break;
    }
}

static void add_input(work *w, input_kind kind, int index, double base, const char *name, const char *unit,
                      bough_state_space *to) {
    int k = w->n_input++;
    w->input[k] = (input){kind, index, base};
    w->size[k] = difference * fmax(1, fabs(base));
    name_signal(&to->input[k], unit, "%s", name);
    to->input[k].value = base;
}

static void find_inputs(work *w, bough_state_space *to) {
    const bough_simulation *s = w->s;
    const bough_scene_wind *wind = &s->scene->aero.wind;
    for (int k = 0; k < s->scene->n_input; k++) {
        const bough_scene_input *x = &s->scene->input[k];
        double value = s->input[k];
        if (x->kind == BOUGH_INPUT_LOAD)
            add_input(w, SCENE_LOAD, k, value, x->name, bough_dimension_unit((bough_dimension)x->dimension),
                      to);
    }
    if (s->control != NULL) {
        double torque = bough_control_link_generator(s->control).torque;
        add_input(w, GENERATOR_TORQUE, 0, torque, "generator torque, fast shaft", "N m", to);
        double pitch = bough_simulation_pitch(s, bough_simulation_blade(s, 0));
        if (bough_control_link_pitches(s->control))
            add_input(w, COLLECTIVE_PITCH, 0, pitch, "collective pitch", "rad", to);
    }
    if (bough_air_follows(s->scene) && bough_scene_wind_is_steady(wind))
        add_input(w, WIND_SPEED, 0, bough_rotor_wind(bough_aero_link_rotor(s->aero))->def.speed, "wind speed",
                  "m/s", to);
}

// -- names ----------------------------------------------------------------------------------------

// Coordinates and speeds of a joint: lengths, then angles or a quaternion, which has more coordinates than
// speeds.
static void name_joint(const bough_tree *tree, const bough_link *link, bough_signal_name *state) {
    const char *body = tree->bodies[link->body].name;
    const char *angle = link->n_coordinates > link->n_speeds ? "-" : "rad";
    int slides = bough_joint_n_slides(link->joint.kind);
    for (int k = 0; k < link->n_coordinates; k++)
        name_signal(&state[link->first_coordinate + k], k < slides ? "m" : angle, "%s coordinate %d", body,
                    k + 1 + link->part);
    for (int k = 0; k < link->n_speeds; k++)
        name_signal(&state[tree->n_q + link->first_speed + k], k < slides ? "m/s" : "rad/s", "%s speed %d",
                    body, k + 1 + link->part);
}

// Rows of rod.h: component-major over the moving vertices.
static void name_rod(const bough_system *rod, bough_signal_name *state) {
    static const struct {
        const char *name, *unit;
    } row[BOUGH_BLADE_ROWS] = {{"x", "m"},      {"y", "m"},      {"z", "m"},     {"p0", "-"},   {"p1", "-"},
                               {"p2", "-"},     {"p3", "-"},     {"ux", "m/s"},  {"uy", "m/s"}, {"uz", "m/s"},
                               {"wx", "rad/s"}, {"wy", "rad/s"}, {"wz", "rad/s"}};
    int n = rod->n_state / BOUGH_BLADE_ROWS;
    for (int k = 0; k < rod->n_state; k++)
        name_signal(&state[k], row[k / n].unit, "%s %s of vertex %d", rod->name, row[k / n].name, k % n + 1);
}

static void name_air(const bough_simulation *s, int n_air, bough_signal_name *state) {
    int n_blade = s->scene->turbine.n_blade;
    for (int k = 0; k < n_air; k++) {
        const char *blade = s->scene->body[s->scene->turbine.blade[k / (n_air / n_blade)]].name;
        name_signal(&state[k], "-", "%s air %d", blade, k % (n_air / n_blade) + 1);
    }
}

static void name_states(const work *w, bough_state_space *to) {
    const bough_assembly *a = w->s->assembly;
    const bough_tree *tree = w->s->tree;
    for (int i = 0; i < tree->n_links; i++) name_joint(tree, &tree->links[i], to->state);
    for (int i = 1; i < a->n_member; i++) {
        const bough_system *member = &a->member[i]->system;
        for (int k = 0; k < member->n_state; k++)
            name_signal(&to->state[a->state_offset[i] + k], "-", "%s state %d", member->name, k + 1);
    }
    for (int k = 0; k < w->s->n_beam; k++) {
        const bough_beam *beam = &w->s->beam[k];
        if (beam->rod) name_rod(&w->s->rod[beam->port].system, to->state + bough_beam_row(w->s, beam));
    }
    for (int k = 0; k < a->n_state; k++) to->state[k].value = w->about[k];
    name_air(w->s, to->n - a->n_state, to->state + a->n_state);
}

static void name_outputs(const work *w, bough_state_space *to) {
    for (int k = 0; k < to->n_output; k++) {
        name_signal(&to->output[k], w->channels.channel[k].unit, "%s", w->channels.channel[k].name);
        to->output[k].value = w->value[0][k];
    }
}

// -- matrices -------------------------------------------------------------------------------------

// Rates and channels at a state, under the air's forces that the bodies have.
static bough_status evaluate(work *w, const double *state, int side) {
    bough_simulation *s = w->s;
    bough_equilibrium_set_state(s, w->time, state);
    BOUGH_TRY(bough_whole_rate(w->whole, w->time, state, w->rate[side]));
    memcpy(s->master->coupling->input, w->whole->input, (size_t)w->s->assembly->n_input * sizeof(double));
    bough_channels_sample(&w->channels, w->time, w->value[side]);
    return bough_ok();
}

// Columns of state k, or of input k, by differences of order 4: a transverse change of slender rods stretches
// segments, with a force that grows with its third power. The jump of a periodic angle is removed.
static bough_status differentiate(work *w, bool by_input, int k, double size, bough_state_space *to) {
    const bough_assembly *a = w->s->assembly;
    double *rate = (by_input ? to->b : to->a) + (size_t)k * (size_t)to->n;
    double *value = (by_input ? to->d : to->c) + (size_t)k * (size_t)to->n_output;
    for (int times = 1; times <= 2; times++) {
        double weight = times == 1 ? 8 / (12 * size) : -1 / (12 * size);
        for (int side = 0; side < 2; side++) {
            double change = (2 * side - 1) * times * size;
            memcpy(w->state, w->about, (size_t)a->n_state * sizeof *w->state);
            if (by_input)
                set_input(w, k, change, w->state);
            else
                w->state[k] += change;
            bough_status status = evaluate(w, w->state, side);
            if (by_input) bough_equilibrium_set_state(w->s, w->time, w->about);
            if (by_input) set_input(w, k, 0, w->state);
            if (!bough_is_ok(&status)) return status;
        }
        for (int i = 0; i < a->n_state; i++) rate[i] += weight * (w->rate[1][i] - w->rate[0][i]);
        for (int i = 0; i < to->n_output; i++) {
            double changed = w->value[1][i] - w->value[0][i], turn = w->channels.channel[i].turn;
            value[i] += weight * (turn > 0 ? remainder(changed, turn) : changed);
        }
    }
    return bough_ok();
}

// Adds the air: its part of the rates of the bodies, and its own rates.
static void add_air(const work *w, const bough_air_tangent *t, bough_state_space *to) {
    size_t all = (size_t)t->all;
    for (size_t k = 0; k < all * all; k++) to->a[k] += t->matrix[k];
    memcpy(to->b, t->input, all * (size_t)w->n_input * sizeof *to->b);
}

// -- the whole ------------------------------------------------------------------------------------

static bough_status prepare(bough_arena *arena, work *w) {
    bough_simulation *s = w->s;
    const bough_assembly *a = s->assembly;
    size_t n = (size_t)a->n_state, most = (size_t)s->scene->n_input + 3;
    w->channels = bough_channels_start(arena);
    BOUGH_TRY(bough_simulation_channels(s, &w->channels));
    w->whole = bough_whole_create_evaluation(arena, a, NULL);
    double *about;
    w->input = bough_arena_take(arena, most * sizeof *w->input);
    w->size = bough_arena_doubles(arena, most);
    bough_arena_each(arena, n + 1, &about, &w->state, &w->scale, &w->rate[0], &w->rate[1]);
    bough_arena_each(arena, (size_t)w->channels.count + 1, &w->value[0], &w->value[1]);
    bough_assembly_states(a, about);
    w->about = about;
    return bough_ok();
}

static void take(bough_arena *arena, int n_air, const work *w, bough_state_space *to) {
    to->n = w->s->assembly->n_state + n_air;
    to->n_input = w->n_input;
    to->n_output = w->s->n_motion_channel;
    size_t n = (size_t)to->n, u = (size_t)to->n_input, o = (size_t)to->n_output;
    to->a = bough_arena_doubles(arena, n * n + 1);
    to->b = bough_arena_doubles(arena, n * u + 1);
    to->c = bough_arena_doubles(arena, n * o + 1);
    to->d = bough_arena_doubles(arena, o * u + 1);
    to->state = bough_arena_take(arena, (n + 1) * sizeof *to->state);
    to->output = bough_arena_take(arena, (o + 1) * sizeof *to->output);
}

bough_status bough_state_space_find(bough_arena *arena, bough_simulation *s, double time,
                                    bough_state_space *space) {
    work w = {.s = s, .time = time};
    bough_air_tangent air = {0};
    BOUGH_TRY(prepare(arena, &w));
    *space = (bough_state_space){
        .input = bough_arena_take(arena, ((size_t)s->scene->n_input + 3) * sizeof *space->input)};
    find_inputs(&w, space);
    if (bough_air_follows(s->scene)) {
        bough_air_inputs inputs = {w.n_input, w.size, &w, set_input};
        bough_air_azimuth about = {.simulation = s, .whole = w.whole, .time = time, .state = w.about};
        BOUGH_TRY(bough_air_tangent_add(arena, &about, &inputs, &air));
    }
    take(arena, air.n_air, &w, space);
    bough_assembly_scales(s->assembly, w.scale);
    for (int k = 0; k < s->assembly->n_state; k++)
        BOUGH_TRY(differentiate(&w, false, k, difference * w.scale[k], space));
    for (int k = 0; k < w.n_input; k++) BOUGH_TRY(differentiate(&w, true, k, w.size[k], space));
    BOUGH_TRY(evaluate(&w, w.about, 0));
    if (bough_air_follows(s->scene)) add_air(&w, &air, space);
    name_states(&w, space);
    name_outputs(&w, space);
    return bough_ok();
}
