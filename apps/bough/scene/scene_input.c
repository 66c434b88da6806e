// Inputs: named values that another program sets between steps.
#include "apps/bough/scene/scene_internal.h"

static bough_scene_input *add(bough_scene *s, const bough_node *node, const char *name,
                              bough_scene_input_kind kind) {
    bough_scene_input *input = &s->input[s->n_input++];
    *input = (bough_scene_input){.node = node, .name = name, .kind = kind};
    return input;
}

// -- loads ----------------------------------------------------------------------------------------

// Makes a table of the input's value, constant in time, which the input changes.
static void give_table(bough_arena *arena, bough_scene_load *load, double value) {
    load->n_time = 2;
    load->times = bough_arena_doubles(arena, 2);
    load->values = bough_arena_doubles(arena, 2);
    load->times[1] = 1;
    load->values[0] = load->values[1] = value;
}

static void add_joint_load(bough_arena *arena, bough_scene *s, int k) {
    bough_scene_load *load = &s->load[k];
    bough_scene_input *input = add(s, load->node, load->input, BOUGH_INPUT_LOAD);
    bool turns = load->joint >= 0 && s->body[load->joint].joint.kind == BOUGH_JOINT_REVOLUTE;
    input->dimension = turns ? BOUGH_MOMENT : BOUGH_FORCE;
    input->initial = load->amount;
    input->index = k;
    give_table(arena, load, load->amount);
}

// A unit load along component c of a load on a body, with the input as its factor.
static void add_component(bough_arena *arena, bough_scene *s, const bough_scene_load *from, int k, int c) {
    static const char *const ends[] = {"Fx", "Fy", "Fz", "Mx", "My", "Mz"};
    bool along = from->place == BOUGH_SCENE_ALONG, force = c < 3;
    double value = from->wrench[c];
    bough_scene_load *to = &s->load[k];
    *to = *from;
    memset(to->wrench, 0, sizeof to->wrench);
    to->wrench[c] = 1;
    memcpy(to->end, to->wrench, sizeof to->end);
    to->input = bough_arena_print(arena, "%.120s%s", from->input, ends[c]);
    bough_scene_input *input = add(s, from->node, to->input, BOUGH_INPUT_LOAD);
    input->dimension =
        force ? (along ? BOUGH_LINE_FORCE : BOUGH_FORCE) : (along ? BOUGH_LINE_MOMENT : BOUGH_MOMENT);
    input->initial = value;
    input->index = k;
    give_table(arena, to, value);
}

// The first component keeps the place of the load, the others come last.
static void add_loads(bough_arena *arena, bough_scene *s) {
    int n = s->n_load, next = n;
    for (int k = 0; k < n; k++) {
        bough_scene_load from = s->load[k];
        if (from.input == NULL) continue;
        if (from.joint_name != NULL) {
            add_joint_load(arena, s, k);
            continue;
        }
        for (int c = 0; c < 6; c++) add_component(arena, s, &from, c == 0 ? k : next++, c);
    }
    s->n_load = next;
}

// -- whole ----------------------------------------------------------------------------------------

static void add_motions(bough_scene *s) {
    for (int i = 0; i < s->n_body; i++) {
        const bough_scene_motion *motion = &s->body[i].joint.motion[0];
        if (motion->node == NULL || motion->input == NULL) continue;
        bool turns = s->body[i].joint.kind == BOUGH_JOINT_REVOLUTE;
        bough_scene_input *input = add(s, motion->node, motion->input, BOUGH_INPUT_MOTION);
        input->dimension = turns ? BOUGH_ANGLE : BOUGH_LENGTH;
        input->initial = motion->def.from;
        input->index = i;
    }
}

// Inputs by which an external control law gives its demands.
static void add_control(bough_arena *arena, bough_scene *s) {
    const bough_scene_control *control = &s->control;
    if (control->node == NULL || control->kind != BOUGH_SCENE_EXTERNAL) return;
    add(s, control->node, "GenTqCom", BOUGH_INPUT_TORQUE)->dimension = BOUGH_MOMENT;
    for (int b = 0; control->pitch && b < s->turbine.n_blade; b++) {
        const char *name = bough_arena_print(arena, "BlPitchCom%d", b + 1);
        bough_scene_input *input = add(s, control->node, name, BOUGH_INPUT_PITCH);
        input->dimension = BOUGH_ANGLE;
        input->index = b;
        if (s->turbine.blade[b] >= 0) input->initial = s->body[s->turbine.blade[b]].pitch;
    }
}

static void add_wind(bough_schema_reader *r, bough_scene *s) {
    const bough_scene_wind *wind = &s->aero.wind;
    if (s->aero.node == NULL || wind->input == NULL) return;
    bough_scene_input *input = add(s, wind->node, wind->input, BOUGH_INPUT_WIND);
    input->dimension = BOUGH_SPEED;
    input->range = WIND_SPEED_RANGE;
    input->initial = wind->def.speed;
    if (bough_scene_wind_is_steady(wind)) return;
    bough_link_at(r, "aero.wind");
    bough_schema_error(r, wind->node, "input",
                       "only of a uniform wind or one sheared by a law, with a 'speed'");
}

static void check_names(bough_schema_reader *r, const bough_scene *s) {
    for (int i = 0; i < s->n_input; i++) {
        for (int k = 0; k < i && s->input[k].name && s->input[i].name; k++) {
            if (strcmp(s->input[k].name, s->input[i].name) != 0) continue;
            bough_link_at(r, "inputs");
            bough_schema_error(r, s->input[i].node, "", "two inputs are named '%.80s'", s->input[i].name);
        }
    }
}

void bough_link_inputs(bough_schema_reader *r, bough_scene *s) {
    size_t loads = 0;
    for (int k = 0; k < s->n_load; k++) loads += s->load[k].input != NULL;
    size_t most = 6 * loads + (size_t)s->n_body + 5;
    s->input = bough_arena_take(r->arena, most * sizeof *s->input);
    bough_scene_load *load = bough_arena_take(r->arena, ((size_t)s->n_load + 5 * loads + 1) * sizeof *load);
    if (s->n_load > 0) memcpy(load, s->load, (size_t)s->n_load * sizeof *load);
    s->load = load;
    add_loads(r->arena, s);
    add_motions(s);
    add_control(r->arena, s);
    add_wind(r, s);
    check_names(r, s);
}

void bough_scene_start_input(bough_scene *s, int k, double value) {
    bough_scene_input *input = &s->input[k];
    input->initial = value;
    if (input->kind == BOUGH_INPUT_WIND) s->aero.wind.def.speed = value;
    if (input->kind == BOUGH_INPUT_MOTION) s->body[input->index].joint.motion[0].def.from = value;
}
