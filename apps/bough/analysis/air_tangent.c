#include "apps/bough/analysis/air_tangent.h"

#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/equilibrium.h"

#include <math.h>
#include <string.h>

static const double difference = 1e-5;     // of a state of the bodies, in units of its scale
static const double air_difference = 1e-6; // of a state of the air
static const double rate_time = 1e-5;      // over which the rate of a state of the air is taken [s]
static const double rest_time = 1e4;       // of one of the steps in which the air comes to rest [s]

enum { REST_STEPS = 4 };

typedef struct work {
    bough_simulation *simulation;
    bough_whole *whole;
    double time;
    bool dynamic;
    int n_memory, n_air;
    int *row;                        // (n_air) of the memory
    double *memory, *before, *after; // (n_memory): at rest; at both ends of rate_time
    double *state;                   // (n)
    double *rate[2], *air_rate[2];   // (n), (n_air) on either side
    const bough_blade_group *group;  // whose states are changed at once; NULL: each state by itself
    int n_per_blade, *blade_air;     // states of a blade's air; (n_part × n_per_blade) their rows
} work;

static void take(bough_arena *arena, work *w) {
    size_t n = (size_t)w->whole->assembly->n_state, m = (size_t)w->n_memory + 1;
    w->row = bough_arena_take(arena, m * sizeof *w->row);
    bough_arena_each(arena, m, &w->memory, &w->before, &w->after, &w->air_rate[0], &w->air_rate[1]);
    bough_arena_each(arena, n, &w->state, &w->rate[0], &w->rate[1]);
}

// Advances the air's states by `step` from `from`, which is changed, to `to`.
static void advance_air(work *w, double step, double *from, double *to) {
    from[0] = w->time - step;
    bough_aero_link_memory(w->simulation->aero, BOUGH_SNAPSHOT_RESTORE, from);
    bough_aero_link_continue(w->simulation->aero, w->time);
    bough_aero_link_memory(w->simulation->aero, BOUGH_SNAPSHOT_SAVE, to);
}

// Rates of all states at `state` under the loads that the air has for w->state and the memory in
// w->before. The first of two short steps makes the air's inputs those of this state.
static bough_status find_rates(work *w, const double *state, double *rate, double *air_rate) {
    bough_simulation *s = w->simulation;
    bough_equilibrium_set_state(s, w->whole->assembly, w->state);
    if (w->dynamic) {
        advance_air(w, rate_time, w->before, w->after);
        memcpy(w->before, w->after, (size_t)w->n_memory * sizeof *w->before);
        advance_air(w, rate_time, w->before, w->after);
        for (int k = 0; k < w->n_air; k++) {
            air_rate[k] = (w->after[w->row[k]] - w->before[w->row[k]]) / rate_time;
        }
    } else {
        bough_aero_link_hold(s->aero, w->time);
    }
    return bough_whole_rate(w->whole, w->time, state, rate);
}

// Brings the air to rest about `state`; what it remembers then, to w->memory.
static void settle(work *w, const double *state) {
    bough_simulation *s = w->simulation;
    bough_equilibrium_set_state(s, w->whole->assembly, state);
    bough_aero_link_hold(s->aero, w->time);
    if (!w->dynamic) return;
    bough_aero_link_continue(s->aero, w->time);
    bough_aero_link_memory(s->aero, BOUGH_SNAPSHOT_SAVE, w->before);
    for (int k = 0; k < REST_STEPS; k++) {
        advance_air(w, rest_time, w->before, w->memory);
        memcpy(w->before, w->memory, (size_t)w->n_memory * sizeof *w->before);
    }
}

// Both sides of a difference are in the work: their slopes, of the bodies' rates and of the air's.
static void set_column(const work *w, double between, double *column, double *air_column) {
    int n = w->whole->assembly->n_state;
    for (int k = 0; k < n; k++) column[k] = (w->rate[1][k] - w->rate[0][k]) / between;
    for (int k = 0; k < w->n_air; k++) {
        air_column[k] = (w->air_rate[1][k] - w->air_rate[0][k]) / between;
    }
}

// The state and the air at rest about it, to be changed.
static void begin_change(work *w, const double *state) {
    memcpy(w->state, state, (size_t)w->whole->assembly->n_state * sizeof *state);
    memcpy(w->before, w->memory, (size_t)w->n_memory * sizeof *w->before);
}

static bool meets_air(const bough_simulation *s, int member) {
    if (member == 0 || s->drag != NULL) return true;
    for (int b = 0; b < s->scene->turbine.n_blade; b++) {
        if (bough_simulation_beam(s, s->scene->turbine.blade[b])->port + 1 == member) return true;
    }
    return false;
}

// -- equal blades at once -------------------------------------------------------------------------

// Change of another blade's rates, relative to that of its own, below which blades move by themselves: what
// is left are means over the disk, which all blades change.
static const double apart = 1e-3;

// The largest change of the rates of a blade and its air, in units of the scales.
static double change_of(const work *w, const double *scale, int blade) {
    const bough_blade_group *g = w->group;
    double most = 0;
    for (int j = 0; j < g->n_row; j++) {
        int at = g->row[blade * g->n_row + j];
        most = fmax(most, fabs(w->rate[1][at] - w->rate[0][at]) / scale[at]);
    }
    for (int j = 0; j < w->n_per_blade; j++) {
        int at = w->blade_air[blade * w->n_per_blade + j];
        most = fmax(most, fabs(w->air_rate[1][at] - w->air_rate[0][at]));
    }
    return most;
}

// Leaves the group where a change of the first blade, its air and all of its states, moves the others.
static bough_status choose_group(bough_arena *arena, work *w, const double *state,
                                 const bough_blade_group *group) {
    if (group == NULL || group->n < 2) return bough_ok();
    double *scale = bough_arena_doubles(arena, (size_t)w->whole->assembly->n_state), own, others = 0;
    w->group = group;
    w->n_per_blade = w->n_air / w->simulation->scene->turbine.n_blade;
    w->blade_air = bough_arena_take(arena, (size_t)(group->n * w->n_per_blade + 1) * sizeof *w->blade_air);
    bough_air_tangent_rows(w->simulation, group, w->n_per_blade, w->blade_air);
    bough_assembly_scales(w->whole->assembly, scale);
    begin_change(w, state);
    for (int j = 0; j < group->n_row; j++) {
        int at = group->row[j];
        w->state[at] += difference * scale[at] * sin(1 + 7.3 * j);
    }
    for (int j = 0; j < w->n_per_blade; j++)
        w->before[w->row[w->blade_air[j]]] += air_difference * cos(2 + 5.1 * j);
    BOUGH_TRY(find_rates(w, state, w->rate[1], w->air_rate[1]));
    own = change_of(w, scale, 0);
    for (int k = 1; k < group->n; k++) others = fmax(others, change_of(w, scale, k));
    if (others > apart * own) w->group = NULL;
    return bough_ok();
}

// Whether the rates on both sides are the same but for the blades'.
static bool is_of_blades(const work *w) {
    const bough_blade_group *g = w->group;
    int own = g->n * g->n_row, changed = 0;
    for (int i = 0; i < w->whole->assembly->n_state; i++) changed += w->rate[1][i] != w->rate[0][i];
    for (int i = 0; i < own; i++) changed -= w->rate[1][g->row[i]] != w->rate[0][g->row[i]];
    return changed == 0;
}

// Slopes of each blade's rates, and of its air's, by its own state: columns (n_part) of the tangents.
static void set_blades(const work *w, double between, const int *from, double *of_state, double *of_air) {
    const bough_blade_group *g = w->group;
    for (int k = 0; k < g->n; k++) {
        double *column = of_state + (size_t)from[k] * (size_t)w->whole->assembly->n_state;
        double *air_column = of_air + (size_t)from[k] * (size_t)w->n_air;
        for (int j = 0; j < g->n_row; j++) {
            int at = g->row[k * g->n_row + j];
            column[at] = (w->rate[1][at] - w->rate[0][at]) / between;
        }
        for (int j = 0; j < w->n_per_blade; j++) {
            int at = w->blade_air[k * w->n_per_blade + j];
            air_column[at] = (w->air_rate[1][at] - w->air_rate[0][at]) / between;
        }
    }
}

// -- columns --------------------------------------------------------------------------------------

// States that take part in a difference: `n` of them, which are alike.
typedef struct changed {
    bool of_air;
    int n;
    const int *at;
    double size;
} changed;

static bough_status change_some(work *w, const double *state, const changed *c, int first, int n) {
    begin_change(w, state);
    for (int k = first; k < first + n; k++) {
        if (c->of_air)
            w->before[w->row[c->at[k]]] += c->size;
        else
            w->state[c->at[k]] += c->size;
    }
    return find_rates(w, state, w->rate[1], w->air_rate[1]);
}

// At once where no rate but the blades' own changes, else one after the other. To one side: there are
// thousands of states, and the curvature of the loads within the difference is 1e-5 of their slope.
static bough_status follow(work *w, const double *state, changed c, bough_air_tangent *t) {
    double *of_state = c.of_air ? t->lift : t->motion, *of_air = c.of_air ? t->lag : t->drive;
    if (c.n > 1) {
        BOUGH_TRY(change_some(w, state, &c, 0, c.n));
        if (is_of_blades(w)) {
            set_blades(w, c.size, c.at, of_state, of_air);
            return bough_ok();
        }
    }
    for (int k = 0; k < c.n; k++) {
        BOUGH_TRY(change_some(w, state, &c, k, 1));
        set_column(w, c.size, of_state + (size_t)c.at[k] * (size_t)t->n,
                   of_air + (size_t)c.at[k] * (size_t)t->n_air);
    }
    return bough_ok();
}

enum { MOST_BLADES = 16 };

// The same state of all blades, of which state j is one of the first's; of others itself alone.
static changed states_with(const work *w, int n_row, const int *row, int state, int *at) {
    changed c = {.n = 1, .at = at};
    at[0] = state;
    for (int j = 0; w->group && w->group->n <= MOST_BLADES && j < w->group->n * n_row; j++) {
        if (row[j] != state) continue;
        c.n = j < n_row ? w->group->n : 0; // those of other blades are changed with it
        for (int k = 0; k < c.n; k++) at[k] = row[k * n_row + j];
        return c;
    }
    return c;
}

static bough_status follow_motion(work *w, const double *state, bough_air_tangent *t) {
    const bough_assembly *a = w->whole->assembly;
    int at[MOST_BLADES], n_row = w->group ? w->group->n_row : 0;
    for (int i = 0; i < a->n_member; i++) {
        if (!meets_air(w->simulation, i)) continue;
        for (int k = 0; k < a->member[i]->system.n_state; k++) {
            changed c = states_with(w, n_row, n_row ? w->group->row : NULL, a->state_offset[i] + k, at);
            c.size = difference * a->member[i]->system.scale[k];
            BOUGH_TRY(follow(w, state, c, t));
        }
    }
    return bough_ok();
}

static bough_status follow_memory(work *w, const double *state, bough_air_tangent *t) {
    int at[MOST_BLADES];
    for (int k = 0; k < w->n_air; k++) {
        changed c = states_with(w, w->n_per_blade, w->blade_air, k, at);
        c.of_air = true;
        c.size = air_difference;
        BOUGH_TRY(follow(w, state, c, t));
    }
    return bough_ok();
}

static bough_status follow_inputs(work *w, const double *state, const bough_air_inputs *inputs,
                                  bough_air_tangent *t) {
    size_t n = (size_t)w->whole->assembly->n_state;
    for (int k = 0; k < inputs->n; k++) {
        for (int side = 0; side < 2; side++) {
            begin_change(w, state);
            inputs->set(inputs->self, k, (2 * side - 1) * inputs->size[k], w->state);
            bough_status status = find_rates(w, w->state, w->rate[side], w->air_rate[side]);
            inputs->set(inputs->self, k, 0, w->state);
            if (!bough_is_ok(&status)) return status;
        }
        set_column(w, 2 * inputs->size[k], t->input + (size_t)k * n, t->input_drive + (size_t)k * t->n_air);
    }
    return bough_ok();
}

static work start(bough_arena *arena, bough_simulation *s, bough_whole *whole, double time, bool dynamic) {
    const bough_rotor *rotor = bough_aero_link_rotor(s->aero);
    int n_memory = dynamic ? bough_rotor_memory_size(rotor) : 0;
    work w = {.simulation = s, .whole = whole, .time = time, .n_memory = n_memory, .dynamic = n_memory > 0};
    take(arena, &w);
    if (w.dynamic) w.n_air = bough_rotor_memory_states(rotor, w.row);
    return w;
}

bough_status bough_air_tangent_find(bough_arena *arena, bough_simulation *s, bough_whole *whole, double time,
                                    const double *state, bool dynamic, const bough_blade_group *group,
                                    const bough_air_inputs *inputs, bough_air_tangent *t) {
    work w = start(arena, s, whole, time, dynamic);
    size_t n = (size_t)whole->assembly->n_state, m = (size_t)w.n_air;
    size_t n_input = inputs ? (size_t)inputs->n : 0;
    *t = (bough_air_tangent){.n = (int)n,
                             .n_air = w.n_air,
                             .n_per_blade = w.n_air / s->scene->turbine.n_blade,
                             .motion = bough_arena_doubles(arena, n * n),
                             .lift = bough_arena_doubles(arena, n * m + 1),
                             .drive = bough_arena_doubles(arena, n * m + 1),
                             .lag = bough_arena_doubles(arena, m * m + 1),
                             .input = bough_arena_doubles(arena, n * n_input + 1),
                             .input_drive = bough_arena_doubles(arena, m * n_input + 1)};
    settle(&w, state);
    begin_change(&w, state);
    bough_status status = find_rates(&w, state, w.rate[0], w.air_rate[0]);
    if (bough_is_ok(&status)) status = choose_group(arena, &w, state, group);
    if (bough_is_ok(&status)) status = follow_motion(&w, state, t);
    if (bough_is_ok(&status)) status = follow_memory(&w, state, t);
    if (bough_is_ok(&status) && inputs) status = follow_inputs(&w, state, inputs, t);
    settle(&w, state);
    return status;
}

// -- one change -----------------------------------------------------------------------------------

struct bough_air_change {
    work w;
    const double *about;
};

bough_air_change *bough_air_change_create(bough_arena *arena, bough_simulation *s, bough_whole *whole,
                                          double time, const double *state, bool dynamic, int *n_air) {
    bough_air_change *x = bough_arena_take(arena, sizeof *x);
    *x = (bough_air_change){start(arena, s, whole, time, dynamic), state};
    settle(&x->w, state);
    *n_air = x->w.n_air;
    return x;
}

bough_status bough_air_change_follow(bough_air_change *x, double size, const double *change, double *image) {
    work *w = &x->w;
    int n = w->whole->assembly->n_state;
    for (int side = 0; side < 2; side++) {
        double factor = (2 * side - 1) * size;
        for (int k = 0; k < n; k++) w->state[k] = x->about[k] + factor * change[k];
        memcpy(w->before, w->memory, (size_t)w->n_memory * sizeof *w->before);
        for (int k = 0; k < w->n_air; k++) w->before[w->row[k]] += factor * change[n + k];
        BOUGH_TRY(find_rates(w, x->about, w->rate[side], w->air_rate[side]));
    }
    set_column(w, 2 * size, image, image + n);
    return bough_ok();
}

// -- mean over azimuths ---------------------------------------------------------------------------

// a (rows × ·): its block of parts (k, l) becomes the mean over all (k + i, l + i).
typedef struct blocks {
    int n_part, rows;
    int n_to, n_from;     // entries of a part
    const int *to, *from; // (n_part × n_to), (n_part × n_from)
} blocks;

// NOLINTNEXTLINE(readability-function-size): one sum over six indices
static void average(const blocks *b, double *a) {
    for (int between = 0; between < b->n_part; between++) {
        for (int j = 0; j < b->n_from; j++) {
            for (int i = 0; i < b->n_to; i++) {
                double sum = 0;
                for (int pass = 0; pass < 2; pass++) {
                    for (int k = 0; k < b->n_part; k++) {
                        int l = (k + between) % b->n_part;
                        size_t column = (size_t)b->from[l * b->n_from + j] * (size_t)b->rows;
                        double *entry = a + column + (size_t)b->to[k * b->n_to + i];
                        if (pass == 0) sum += *entry / b->n_part;
                        if (pass == 1) *entry = sum;
                    }
                }
            }
        }
    }
}

void bough_air_tangent_rows(const bough_simulation *s, const bough_blade_group *group, int n_per_blade,
                            int *row) {
    const bough_scene_turbine *turbine = &s->scene->turbine;
    for (int k = 0; k < group->n; k++) {
        for (int b = 0; b < turbine->n_blade; b++) {
            if (bough_simulation_beam(s, turbine->blade[b]) != group->blade[k]) continue;
            for (int j = 0; j < n_per_blade; j++) row[k * n_per_blade + j] = b * n_per_blade + j;
        }
    }
}

void bough_air_tangent_average(bough_arena *arena, const bough_simulation *s, const bough_blade_group *group,
                               bough_air_tangent *t) {
    if (group->n == 0) return;
    int *air = bough_arena_take(arena, ((size_t)t->n_air + 1) * sizeof *air);
    bough_air_tangent_rows(s, group, t->n_per_blade, air);
    int n = group->n, m = t->n_per_blade;
    average(&(blocks){n, t->n, group->n_row, group->n_row, group->row, group->row}, t->motion);
    average(&(blocks){n, t->n, group->n_row, m, group->row, air}, t->lift);
    average(&(blocks){n, t->n_air, m, group->n_row, air, group->row}, t->drive);
    average(&(blocks){n, t->n_air, m, m, air, air}, t->lag);
    if (fabs(group->speed) > 0) { // over a revolution the mean of a slope in azimuth is none
        int azimuth, speed;
        bough_tree_joint_rows(s->tree, s->scene->turbine.rotor, &azimuth, &speed);
        memset(t->motion + (size_t)azimuth * (size_t)t->n, 0, (size_t)t->n * sizeof(double));
        memset(t->drive + (size_t)azimuth * (size_t)t->n_air, 0, (size_t)t->n_air * sizeof(double));
    }
}
