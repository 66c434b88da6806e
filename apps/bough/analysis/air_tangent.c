#include "apps/bough/analysis/air_tangent.h"

#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/equilibrium.h"

static const double difference = 1e-5;     // of a state of the members, in units of its scale
static const double air_difference = 1e-6; // of a state of the air
static const double rate_time = 1e-5;      // over which the rate of a state of the air is measured [s]
static const double rest_time = 1e4;       // of one of the steps in which the air comes to rest [s]

enum { REST_STEPS = 4 };

typedef struct work {
    bough_simulation *simulation;
    bough_whole *whole;
    double time;
    int n_memory, n_air;             // 0: the air has no memory
    int *row;                        // (n_air) of the memory
    double *memory, *before, *after; // (n_memory): at rest; at both ends of rate_time
    double *state;                   // (n)
    double *motion;                  // (n) for which the air was advanced last; NaN: not known
    double *rate[2], *air_rate[2];   // (n), (n_air) on either side
    bough_air_mean *mean;            // that columns are added to; NULL: they are set
    double *slope;                   // (n + n_air) of a column
} work;

static void take(bough_arena *arena, work *w) {
    size_t n = (size_t)w->simulation->assembly->n_state, m = (size_t)w->n_memory + 1;
    w->row = bough_arena_take(arena, m * sizeof *w->row);
    bough_arena_each(arena, m, &w->memory, &w->before, &w->after, &w->air_rate[0], &w->air_rate[1]);
    bough_arena_each(arena, n, &w->state, &w->motion, &w->rate[0], &w->rate[1]);
    w->slope = bough_arena_doubles(arena, n + m);
}

// Advances the air's states by `step` from `from`, which is changed, to `to`, where the bodies have been set
// to `state`; `loads`: also sets the loads on them.
static void advance_air(work *w, const double *state, bool loads, double step, double *from, double *to) {
    size_t size = (size_t)w->simulation->assembly->n_state * sizeof *state;
    bool moved = memcmp(w->motion, state, size) != 0;
    memcpy(w->motion, state, size);
    from[0] = w->time - step;
    bough_aero_link_memory(w->simulation->aero, BOUGH_SNAPSHOT_RESTORE, from);
    (loads ? bough_aero_link_continue : bough_aero_link_remember)(w->simulation->aero, w->time, moved);
    bough_aero_link_memory(w->simulation->aero, BOUGH_SNAPSHOT_SAVE, to);
}

// Rates of all states at `state` under the loads that the air has for w->state and the memory in
// w->before. The first of two short steps makes the air's inputs those of this state.
static bough_status find_rates(work *w, const double *state, double *rate, double *air_rate) {
    bough_simulation *s = w->simulation;
    bough_equilibrium_set_state(s, w->time, w->state);
    if (w->n_memory > 0) {
        advance_air(w, w->state, false, rate_time, w->before, w->after);
        memcpy(w->before, w->after, (size_t)w->n_memory * sizeof *w->before);
        advance_air(w, w->state, true, rate_time, w->before, w->after);
        for (int k = 0; k < w->n_air; k++) {
            air_rate[k] = (w->after[w->row[k]] - w->before[w->row[k]]) / rate_time;
        }
    } else {
        bough_aero_link_hold(s->aero, w->time);
    }
    return bough_whole_rate(w->whole, w->time, state, rate);
}

// Sets the air to equilibrium about `state` and stores its memory in w->memory.
static void settle(work *w, const double *state) {
    bough_simulation *s = w->simulation;
    bough_equilibrium_set_state(s, w->time, state);
    bough_aero_link_hold(s->aero, w->time);
    if (w->n_memory == 0) return;
    bough_aero_link_continue(s->aero, w->time, false);
    bough_aero_link_memory(s->aero, BOUGH_SNAPSHOT_SAVE, w->before);
    for (int k = 0; k < REST_STEPS; k++) {
        advance_air(w, state, k + 1 == REST_STEPS, rest_time, w->before, w->memory);
        memcpy(w->before, w->memory, (size_t)w->n_memory * sizeof *w->before);
    }
}

// Slopes of the rates of members and air, by the difference of both sides in the work.
static void set_column(const work *w, double between, double *column) {
    int n = w->simulation->assembly->n_state;
    for (int k = 0; k < n; k++) column[k] = (w->rate[1][k] - w->rate[0][k]) / between;
    for (int k = 0; k < w->n_air; k++) column[n + k] = (w->air_rate[1][k] - w->air_rate[0][k]) / between;
}

// Sets the state and the air at rest about it, before a change.
static void begin_change(work *w, const double *state) {
    memcpy(w->state, state, (size_t)w->simulation->assembly->n_state * sizeof *state);
    memcpy(w->before, w->memory, (size_t)w->n_memory * sizeof *w->before);
}

static bool meets_air(const bough_simulation *s, int member) {
    if (member == 0 || s->drag != NULL) return true;
    for (int b = 0; b < s->scene->turbine.n_blade; b++) {
        if (bough_simulation_blade(s, b)->port + 1 == member) return true;
    }
    return false;
}

// Stores the slopes in the work as the column of a state, of the members and then of the air.
static void put_column(const work *w, int at, bough_air_tangent *t) {
    if (w->mean)
        bough_air_mean_add(w->mean, at, w->slope, t);
    else
        memcpy(bough_air_tangent_entry(t, 0, (size_t)at), w->slope, (size_t)t->all * sizeof *w->slope);
}

static void change(work *w, int at, double size) {
    int n = w->simulation->assembly->n_state;
    if (at < n)
        w->state[at] += size;
    else
        w->before[w->row[at - n]] += size;
}

static bough_status follow_state(work *w, const double *state, int at, double size, bough_air_tangent *t) {
    begin_change(w, state);
    change(w, at, size);
    BOUGH_TRY(find_rates(w, state, w->rate[1], w->air_rate[1]));
    set_column(w, size, w->slope);
    put_column(w, at, t);
    return bough_ok();
}

// One-sided differences: there are thousands of states, and the curvature of the loads within a difference is
// 1e-5 of their slope.
static bough_status follow_member(work *w, const double *state, int member, bough_air_tangent *t) {
    const bough_assembly *a = w->simulation->assembly;
    const bough_system *system = &a->member[member]->system;
    for (int k = 0; k < system->n_state; k++)
        BOUGH_TRY(follow_state(w, state, a->state_offset[member] + k, difference * system->scale[k], t));
    return bough_ok();
}

// -- equal blades ---------------------------------------------------------------------------------

// Loads of a section depend on neighbouring vertices and on the air there: states of all blades, and of
// places far enough apart, are changed together.

// States of one blade, then those of its air; places along it count aerodynamic stations.
typedef struct blades {
    work *w;
    const bough_blade_group *group;
    int n_row, n_air, n_all; // of a blade
    const int *at;           // (n_part × n_all) rows of them among the members' and then the air's
    double *place, *reach;   // (n_all); how far from it loads change
    double *size;            // (n_all) of differences
    int *nearest;            // (n_all) of the states changed at once
    double *changed;         // (n + n_air) rates less those of the state itself
    double *own;             // (n_all) slopes of a blade's rates by these, sums over the blades
    double *check;           // (n_part × n_all) by how much `check` changes the states
    double *expected;        // (n + n_air) rates by the tangent for these changes
    double *other, *blade;   // (n) 1 over the scale of a state; 0: of a blade's, or of the others
    int *number;             // (n_part) of each blade among the rotor's
    size_t n_load;           // of a copy of a blade's loads
    double *load[2];         // (n_part × n_load) of the state itself, of a changed one
} blades;

static bool is_of_air(const blades *b, int j) { return j >= b->n_row; }

// Places of spans between stations.
static double place_of(const bough_scene_aero_blade *aero, double span) {
    int k = 1;
    while (k + 1 < aero->n_station && aero->station[k].def.span < span) k++;
    double from = aero->station[k - 1].def.span, to = aero->station[k].def.span;
    return k - 1 + (span - from) / (to - from);
}

// A state of vertex i reaches sections between the vertices beside it; their loads, one station further.
static void set_places(blades *b) {
    const bough_rod_model *m = b->group->blade[0]->mesh;
    const bough_scene_aero_blade *aero = &b->w->simulation->scene->aero.blade;
    int per_station = b->n_air / aero->n_station;
    for (int j = 0; j < b->n_all; j++) {
        double span =
            is_of_air(b, j) ? aero->station[(j - b->n_row) / per_station].def.span : m->span[j % m->n + 1];
        int i = 1;
        while (i + 1 < m->n_segment && m->span[i] < span) i++;
        double gap = place_of(aero, m->span[i + 1]) - place_of(aero, m->span[i - 1]);
        b->place[j] = place_of(aero, span);
        b->reach[j] = 2 + gap;
    }
}

static void keep_loads(const blades *b, int side) {
    for (int k = 0; k < b->group->n; k++)
        bough_aero_link_loads(b->w->simulation->aero, BOUGH_SNAPSHOT_SAVE, b->number[k],
                              b->load[side] + (size_t)k * b->n_load);
}

// The present loads are those of the undisturbed state.
static blades take_blades(bough_arena *arena, work *w, const bough_blade_group *group) {
    const bough_simulation *s = w->simulation;
    int n_air = w->n_air / s->scene->turbine.n_blade, n_row = group->n_row;
    blades b = {.w = w, .group = group, .n_row = n_row, .n_air = n_air, .n_all = n_row + n_air};
    size_t all = (size_t)b.n_all + 1, parts = (size_t)group->n;
    int n = w->simulation->assembly->n_state;
    double *scale = b.other = bough_arena_doubles(arena, (size_t)n);
    b.blade = bough_arena_doubles(arena, (size_t)n);
    bough_arena_each(arena, all, &b.place, &b.reach, &b.size, &b.own);
    b.nearest = bough_arena_take(arena, all * sizeof *b.nearest);
    b.check = bough_arena_doubles(arena, parts * all);
    bough_arena_each(arena, (size_t)(n + w->n_air) + 1, &b.expected, &b.changed);
    b.at = bough_air_tangent_rows(arena, s, group, n_air);
    b.number = bough_arena_take(arena, parts * sizeof *b.number);
    for (int k = 0; k < group->n; k++) b.number[k] = bough_air_tangent_blade(s, group, k);
    b.n_load = (size_t)bough_aero_link_loads(s->aero, BOUGH_SNAPSHOT_MEASURE, b.number[0], NULL);
    bough_arena_each(arena, parts * b.n_load, &b.load[0], &b.load[1]);
    keep_loads(&b, 0);
    bough_assembly_scales(w->simulation->assembly, scale);
    for (int j = 0; j < b.n_all; j++)
        b.size[j] = is_of_air(&b, j) ? air_difference : difference * scale[group->row[j]];
    for (int k = 0; k < group->n; k++)
        for (int j = 0; j < b.n_all; j++) b.check[k * b.n_all + j] = b.size[j] * sin(1 + 7.3 * j + 3.1 * k);
    for (int i = 0; i < n; i++) b.other[i] = 1 / b.other[i];
    for (int i = 0; i < group->n * n_row; i++) {
        b.blade[group->row[i]] = b.other[group->row[i]];
        b.other[group->row[i]] = 0;
    }
    set_places(&b);
    return b;
}

static void find_changes(blades *b) { set_column(b->w, 1, b->changed); }

// Slopes of a blade's rates by its own state nearest to them.
static void add_own(blades *b, int blade, bough_air_tangent *t) {
    const int *at = b->at + blade * b->n_all;
    const double *check = b->check + blade * b->n_all;
    for (int i = 0; i < b->n_all; i++) {
        int j = b->nearest[i];
        double slope = b->changed[at[i]] / b->size[j];
        b->expected[at[i]] += check[j] * slope;
        b->own[i] += slope;
        if (!b->w->mean) *bough_air_tangent_entry(t, (size_t)at[i], (size_t)at[j]) = slope;
    }
}

static void set_nearest(blades *b, int n, const int *some) {
    for (int i = 0; i < b->n_all; i++) {
        int at = 0;
        double here = b->place[i];
        for (int k = 1; k < n; k++)
            if (fabs(b->place[some[k]] - here) < fabs(b->place[some[at]] - here)) at = k;
        b->nearest[i] = some[at];
    }
}

// Changes of the rates of bodies that carry the blades, relative to those of the blades, in units of the
// scales: smaller ones come from means over the disk.
static const double carried = 1e-8;

static bool moves_blades_only(const blades *b) {
    double blade = 0, other = 0;
#pragma omp simd reduction(max : blade, other)
    for (int i = 0; i < b->w->simulation->assembly->n_state; i++) {
        double size = fabs(b->changed[i]), of_blade = b->blade[i] * size, of_other = b->other[i] * size;
        blade = of_blade > blade ? of_blade : blade;
        other = of_other > other ? of_other : other;
    }
    return other <= carried * blade;
}

// Rates under the changed loads of one blade alone, whose effect on other bodies belongs to state j of the
// blade.
static bough_status follow_loads(const blades *b, const double *state, int blade, int j,
                                 bough_air_tangent *t) {
    work *w = b->w;
    for (int k = 0; k < b->group->n; k++)
        bough_aero_link_loads(w->simulation->aero, BOUGH_SNAPSHOT_RESTORE, b->number[k],
                              b->load[k == blade] + (size_t)k * b->n_load);
    BOUGH_TRY(bough_whole_rate(w->whole, w->time, state, w->rate[1]));
    set_column(w, b->size[j], w->slope);
    for (int i = 0; i < b->n_row; i++) w->slope[b->at[blade * b->n_all + i]] = 0;
    memset(w->slope + t->n, 0, (size_t)t->n_air * sizeof(double));
    put_column(w, b->at[blade * b->n_all + j], t);
    for (int r = 0; r < t->n; r++) b->expected[r] += b->check[blade * b->n_all + j] * w->slope[r];
    return bough_ok();
}

// Changes n states of all blades together, from the root outwards. If loads at the root move the bodies that
// carry the blades, and so other blades, their rates are found blade by blade.
static bough_status follow_some(blades *b, const double *state, int n, const int *some,
                                bough_air_tangent *t) {
    work *w = b->w;
    begin_change(w, state);
    for (int k = 0; k < b->group->n; k++)
        for (int i = 0; i < n; i++) change(w, b->at[k * b->n_all + some[i]], b->size[some[i]]);
    BOUGH_TRY(find_rates(w, state, w->rate[1], w->air_rate[1]));
    find_changes(b);
    bool at_root = !moves_blades_only(b);
    if (at_root) keep_loads(b, 1);
    set_nearest(b, n, some);
    memset(b->own, 0, (size_t)b->n_all * sizeof *b->own);
    for (int k = 0; k < b->group->n; k++) {
        if (at_root) BOUGH_TRY(follow_loads(b, state, k, some[0], t));
        if (at_root) find_changes(b);
        add_own(b, k, t);
    }
    if (w->mean) bough_air_mean_add_own(w->mean, b->nearest, b->own, t);
    return bough_ok();
}

// n states of one kind along the blade, from `first` on, `stride` apart: those without common loads are
// changed together.
static bough_status follow_along(bough_arena *arena, blades *b, const double *state, int first, int stride,
                                 int n, bough_air_tangent *t) {
    bool *done = bough_arena_take(arena, (size_t)n * sizeof *done);
    int *some = bough_arena_take(arena, (size_t)n * sizeof *some), left = n;
    while (left > 0) {
        int count = 0;
        double end = -HUGE_VAL;
        for (int i = 0; i < n; i++) {
            int j = first + i * stride;
            if (done[i] || b->place[j] - b->reach[j] < end) continue;
            some[count++] = j;
            done[i] = true;
            left--;
            end = b->place[j] + b->reach[j];
        }
        BOUGH_TRY(follow_some(b, state, count, some, t));
    }
    return bough_ok();
}

static bough_status follow_blades(bough_arena *arena, blades *b, const double *state, bough_air_tangent *t) {
    int n = b->group->blade[0]->mesh->n, stations = b->w->simulation->scene->aero.blade.n_station;
    for (int c = 0; c < b->n_row / n; c++) BOUGH_TRY(follow_along(arena, b, state, c * n, 1, n, t));
    for (int c = 0; c < b->n_air / stations; c++)
        BOUGH_TRY(follow_along(arena, b, state, b->n_row + c, b->n_air / stations, stations, t));
    return bough_ok();
}

// Largest relative error of the blades' tangent by means over the disk, which depend on all states of a
// blade.
static const double disk = 1e-3;

// Whether the tangent gives the rates that a change of all states of the blades and their air causes.
static bough_status check(blades *b, const double *state, bool *good) {
    work *w = b->w;
    double miss = 0, size = 0;
    begin_change(w, state);
    for (int k = 0; k < b->group->n; k++)
        for (int j = 0; j < b->n_all; j++) change(w, b->at[k * b->n_all + j], b->check[k * b->n_all + j]);
    BOUGH_TRY(find_rates(w, state, w->rate[1], w->air_rate[1]));
    find_changes(b);
    for (int k = 0; k < b->group->n; k++) {
        for (int j = 0; j < b->n_all; j++) {
            int at = b->at[k * b->n_all + j];
            double own = b->changed[at], unit = is_of_air(b, j) ? 1 : b->size[j] / difference;
            miss = fmax(miss, fabs(own - b->expected[at]) / unit);
            size = fmax(size, fabs(own) / unit);
        }
    }
    *good = miss <= disk * size;
    return bough_ok();
}

// Whether columns of the blades may be found together.
static bool may_be_at_once(const work *w, const bough_blade_group *group) {
    return group && group->n > 0 && group->blade[0]->rod && w->simulation->drag == NULL;
}

static bough_status follow_group(bough_arena *arena, work *w, const double *state,
                                 const bough_blade_group *group, bough_air_tangent *t, bool *good) {
    blades b = take_blades(arena, w, group);
    BOUGH_TRY(follow_blades(arena, &b, state, t));
    return check(&b, state, good);
}

// -- all ------------------------------------------------------------------------------------------

static bool is_of_group(const bough_blade_group *group, int member) {
    for (int k = 0; k < group->n; k++)
        if (group->blade[k]->port + 1 == member) return true;
    return false;
}

// All columns except those of a group and its air; `found` NULL: all.
static bough_status follow_others(work *w, const double *state, const bough_blade_group *found,
                                  bough_air_tangent *t) {
    const bough_assembly *a = w->simulation->assembly;
    for (int i = 0; i < a->n_member; i++) {
        if (!meets_air(w->simulation, i) || (found && is_of_group(found, i))) continue;
        BOUGH_TRY(follow_member(w, state, i, t));
    }
    for (int k = 0; k < w->n_air && !found; k++)
        BOUGH_TRY(follow_state(w, state, a->n_state + k, air_difference, t));
    return bough_ok();
}

static bough_status follow_inputs(work *w, const double *state, const bough_air_inputs *inputs,
                                  bough_air_tangent *t) {
    for (int k = 0; k < inputs->n; k++) {
        for (int side = 0; side < 2; side++) {
            begin_change(w, state);
            inputs->set(inputs->self, k, (2 * side - 1) * inputs->size[k], w->state);
            w->motion[0] = (double)NAN; // the wind may change
            bough_status status = find_rates(w, w->state, w->rate[side], w->air_rate[side]);
            inputs->set(inputs->self, k, 0, w->state);
            if (!bough_is_ok(&status)) return status;
        }
        set_column(w, 2 * inputs->size[k], t->input + (size_t)k * (size_t)t->all);
    }
    return bough_ok();
}

static work start(bough_arena *arena, const bough_air_azimuth *at) {
    const bough_rotor *rotor = bough_aero_link_rotor(at->simulation->aero);
    bool dynamic = at->simulation->scene->modes.air == BOUGH_SCENE_AIR_DYNAMIC;
    int n_memory = dynamic ? bough_rotor_memory_size(rotor) : 0;
    work w = {.simulation = at->simulation, .whole = at->whole, .time = at->time, .n_memory = n_memory};
    take(arena, &w);
    if (n_memory > 0) w.n_air = bough_rotor_memory_states(rotor, w.row);
    return w;
}

static bough_air_tangent take_tangent(bough_arena *arena, const work *w, int inputs) {
    int n = w->simulation->assembly->n_state, all = n + w->n_air;
    return (bough_air_tangent){.n = n,
                               .n_air = w->n_air,
                               .all = all,
                               .n_per_blade = w->n_air / w->simulation->scene->turbine.n_blade,
                               .matrix = bough_arena_doubles(arena, (size_t)all * (size_t)all),
                               .input = bough_arena_doubles(arena, (size_t)(all * inputs) + 1)};
}

// Brings the air to rest about the state and finds the rates there.
static bough_status begin_differences(work *w, const double *state) {
    settle(w, state);
    begin_change(w, state);
    return find_rates(w, state, w->rate[0], w->air_rate[0]);
}

// Subtracts the columns of a group from the mean.
static bough_status take_back(bough_arena *arena, work *w, const double *state,
                              const bough_blade_group *group, bough_air_tangent *t) {
    bool good;
    bough_air_mean_negate(w->mean);
    BOUGH_TRY(follow_group(arena, w, state, group, t, &good));
    bough_air_mean_negate(w->mean);
    return bough_ok();
}

// All columns, those of a group together if that is accurate.
static bough_status follow_all(bough_arena *arena, work *w, const double *state,
                               const bough_blade_group *group, bough_air_tangent *t) {
    bool good = false;
    BOUGH_TRY(begin_differences(w, state));
    if (may_be_at_once(w, group)) {
        BOUGH_TRY(follow_group(arena, w, state, group, t, &good));
        if (!good && w->mean) BOUGH_TRY(take_back(arena, w, state, group, t));
    }
    return follow_others(w, state, good ? group : NULL, t);
}

bough_status bough_air_tangent_add(bough_arena *arena, const bough_air_azimuth *x,
                                   const bough_air_inputs *inputs, bough_air_tangent *t) {
    work w = start(arena, x);
    if (t->matrix == NULL) *t = take_tangent(arena, &w, inputs ? inputs->n : 0);
    if (x->blend && x->group->n > 0) w.mean = bough_air_mean_create(arena, x, t);
    bough_status status = follow_all(arena, &w, x->state, x->group, t);
    if (bough_is_ok(&status) && inputs) status = follow_inputs(&w, x->state, inputs, t);
    settle(&w, x->state);
    return status;
}

// -- one change -----------------------------------------------------------------------------------

struct bough_air_change {
    work w;
    bough_air_azimuth at;
    int n_row;      // states of a blade with those of its air
    const int *row; // (n_part × n_row)
    int angle;      // the row of the rotor's; −1: it counts
    double *change; // (n + n_air) as at this azimuth
    bool known;     // the rates of its state are in w.rate[0]
};

bough_air_change *bough_air_change_create(bough_arena *arena, const bough_air_azimuth *at, int *n_air) {
    bough_simulation *s = at->simulation;
    bough_air_change *x = bough_arena_take(arena, sizeof *x);
    *x = (bough_air_change){.w = start(arena, at), .at = *at, .angle = -1};
    settle(&x->w, at->state);
    *n_air = x->w.n_air;
    int n_per_blade = *n_air / s->scene->turbine.n_blade, speed;
    x->n_row = at->parts->n_row + n_per_blade;
    x->row = bough_air_tangent_rows(arena, at->first, at->parts, n_per_blade);
    x->change = bough_arena_doubles(arena, (size_t)(s->assembly->n_state + *n_air));
    if (at->share < 1) bough_tree_joint_rows(s->tree, s->scene->turbine.rotor, &x->angle, &speed);
    return x;
}

static void blend(const bough_air_change *x, bool transposed, double *y) {
    bough_air_mean_blend(x->at.blend, transposed, x->at.parts->n, x->n_row, x->row, y);
}

// The rates with `factor` times the change.
static bough_status change_by(bough_air_change *x, double factor, int side) {
    work *w = &x->w;
    int n = w->simulation->assembly->n_state;
    for (int k = 0; k < n; k++) w->state[k] = x->at.state[k] + factor * x->change[k];
    memcpy(w->before, w->memory, (size_t)w->n_memory * sizeof *w->before);
    for (int k = 0; k < w->n_air; k++) w->before[w->row[k]] += factor * x->change[n + k];
    return find_rates(w, x->at.state, w->rate[side], w->air_rate[side]);
}

bough_status bough_air_change_follow(bough_air_change *x, double size, bool to_one_side, const double *change,
                                     double *image) {
    size_t all = (size_t)(x->w.simulation->assembly->n_state + x->w.n_air);
    memcpy(x->change, change, all * sizeof *change);
    blend(x, false, x->change);
    if (x->angle >= 0) x->change[x->angle] = 0;
    x->w.motion[0] = (double)NAN; // others may have moved the bodies
    if (!to_one_side || !x->known) BOUGH_TRY(change_by(x, to_one_side ? 0 : -size, 0));
    x->known = to_one_side;
    BOUGH_TRY(change_by(x, size, 1));
    set_column(&x->w, to_one_side ? size : 2 * size, image);
    blend(x, true, image);
    return bough_ok();
}
