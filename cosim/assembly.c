// The connections of theory (54), built once.
#include "cosim/assembly.h"

// Members, and where their states, inputs and outputs begin among all.
static void take_members(bough_assembly *a, bough_arena *arena, const bough_assembly_def *def) {
    size_t n = (size_t)def->n_member;
    a->n_member = def->n_member;
    a->member = bough_arena_take(arena, n * sizeof *a->member);
    a->level = bough_arena_take(arena, n * sizeof *a->level);
    a->state_offset = bough_arena_take(arena, (n + 1) * sizeof(int));
    a->input_offset = bough_arena_take(arena, (n + 1) * sizeof(int));
    a->output_offset = bough_arena_take(arena, (n + 1) * sizeof(int));
    a->feedthrough = bough_arena_take(arena, n * sizeof(bool));
    a->order = bough_arena_take(arena, n * sizeof(int));
    a->leads = bough_arena_take(arena, n * sizeof(bool));
    a->by_role = bough_arena_take(arena, n * sizeof(int));
    // each begins where the one before ends
    for (int i = 0; i < def->n_member; i++) {
        a->member[i] = def->member[i].member;
        const bough_system *s = &a->member[i]->system;
        a->level[i] = def->member[i].level;
        a->opaque = a->opaque || a->member[i]->opaque;
        if (a->level[i] >= a->n_level) a->n_level = a->level[i] + 1;
        a->state_offset[i + 1] = a->state_offset[i] + s->n_state;
        a->input_offset[i + 1] = a->input_offset[i] + s->n_input;
        a->output_offset[i + 1] = a->output_offset[i] + s->n_output;
    }
    // sums over the members
    a->n_state = a->state_offset[def->n_member];
    a->n_input = a->input_offset[def->n_member];
    a->n_output = a->output_offset[def->n_member];
}

// One connection: every input has one source.
static void connect(bough_assembly *a, const bough_connection *c) {
    assert(c->from_offset + c->count <= a->member[c->from]->system.n_output);
    assert(c->to_offset + c->count <= a->member[c->to]->system.n_input);
    for (int j = 0; j < c->count; j++) {
        int input = a->input_offset[c->to] + c->to_offset + j;
        assert(a->source[input] < 0); // connected once
        a->receiver[input] = c->to;
        a->source[input] = a->output_offset[c->from] + c->from_offset + j;
        a->source_member[input] = c->from;
        a->kinematic[input] = c->kinematic;
    }
}

// Every input is connected.
static void connect_all(bough_assembly *a, const bough_assembly_def *def) {
    for (int j = 0; j < a->n_input; j++) a->source[j] = -1;
    for (int k = 0; k < def->n_connection; k++) connect(a, &def->connection[k]);
    for (int j = 0; j < a->n_input; j++) assert(a->source[j] >= 0);
}

// A vector is up to three inputs in a row of one connection.
static void find_vectors(bough_assembly *a) {
    for (int j = 0; j < a->n_input; j++) {
        bool continues = j > 0 && a->receiver[j] == a->receiver[j - 1] &&
                         a->source[j] == a->source[j - 1] + 1 &&
                         a->source_member[j] == a->source_member[j - 1] &&
                         a->kinematic[j] == a->kinematic[j - 1] && j - a->vector[j - 1] < 3;
        a->vector[j] = continues ? a->vector[j - 1] : j;
    }
}

// The connection of forces against the n-th connection of motions between two members: the n-th in the
// opposite direction.
static const bough_connection *partner(const bough_assembly_def *def, int forward) {
    const bough_connection *c = &def->connection[forward];
    int skip = 0;
    for (int k = 0; k < forward; k++) {
        const bough_connection *o = &def->connection[k];
        if (o->kinematic && o->from == c->from && o->to == c->to) skip++;
    }
    for (int k = 0; k < def->n_connection; k++) {
        const bough_connection *o = &def->connection[k];
        if (!o->kinematic && o->from == c->to && o->to == c->from && skip-- == 0) return o;
    }
    return NULL;
}

// Pairs of ports that exchange power: a motion and the force against it.
static void pair_ports(bough_assembly *a, const bough_assembly_def *def) {
    for (int k = 0; k < def->n_connection; k++) {
        const bough_connection *c = &def->connection[k];
        const bough_connection *back = c->kinematic ? partner(def, k) : NULL;
        if (!back) continue;
        a->pair[a->n_pair++] = (bough_port_pair){.body = c->to,
                                                 .wrench = a->input_offset[back->to] + back->to_offset,
                                                 .twist = a->input_offset[c->to] + c->to_offset,
                                                 .count = back->count < c->count ? back->count : c->count};
    }
}

// Whether an output changes with an input at a constant state.
static bool probe_feedthrough(const bough_member *m, double *input, double *output) {
    const bough_system *s = &m->system;
    bool found = false;
    double *direction = input + s->n_input;
    for (int j = 0; j < s->n_input; j++) {
        direction[j] = 1;
        s->ops->output_tangent(s->self, m->time, m->state, input, NULL, direction, output);
        direction[j] = 0;
        for (int k = 0; k < s->n_output; k++) found = found || output[k] != 0;
    }
    return found;
}

// Whether the outputs of member i can be evaluated: its inputs are known or do not matter.
static bool resolvable(const bough_assembly *a, int i, const bool *resolved) {
    if (!a->feedthrough[i]) return true;
    for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
        if (!resolved[a->source_member[j]]) return false;
    }
    return true;
}

// An order in which every member comes after those on whose outputs its own depend directly.
static bough_status order_outputs(bough_assembly *a, bool *resolved) {
    for (int n = 0; n < a->n_member; n++) {
        // the next one has the lowest level of all that can be evaluated
        int best = -1;
        for (int i = 0; i < a->n_member; i++) {
            if (resolved[i] || !resolvable(a, i, resolved)) continue;
            if (best < 0 || a->level[i] < a->level[best]) best = i;
        }
        if (best < 0) {
            return bough_fail(BOUGH_INVALID, "the outputs of the coupled bodies depend on each "
                                             "other without delay (an algebraic loop)");
        }
        resolved[best] = true;
        a->order[n] = best;
    }
    return bough_ok();
}

static void find_leaders(bough_assembly *a) {
    int n = 0;
    // level 0, and members of higher levels that are connected with each other
    for (int i = 0; i < a->n_member; i++) a->leads[i] = a->level[i] == 0;
    for (int j = 0; j < a->n_input; j++) {
        int to = a->receiver[j], from = a->source_member[j];
        if (a->level[to] != 0 && a->level[from] != 0) a->leads[to] = a->leads[from] = true;
    }
    for (int i = 0; i < a->n_member; i++)
        if (!a->leads[i]) a->by_role[n++] = i;
    a->n_follower = n;
    for (int i = 0; i < a->n_member; i++)
        if (a->leads[i]) a->by_role[n++] = i;
    // outputs of leaders that depend on those of followers directly
    a->followers_last = true;
    for (int j = 0; j < a->n_input; j++) {
        int to = a->receiver[j];
        if (a->feedthrough[to] && a->leads[to] && !a->leads[a->source_member[j]]) a->followers_last = false;
    }
}

bough_status bough_assembly_build(bough_arena *arena, const bough_assembly_def *def,
                                  bough_assembly **assembly) {
    bough_assembly *a = bough_arena_take(arena, sizeof *a);
    take_members(a, arena, def);
    size_t n_input = (size_t)a->n_input;
    a->receiver = bough_arena_take(arena, n_input * sizeof(int));
    a->source = bough_arena_take(arena, n_input * sizeof(int));
    a->source_member = bough_arena_take(arena, n_input * sizeof(int));
    a->kinematic = bough_arena_take(arena, n_input * sizeof(bool));
    a->vector = bough_arena_take(arena, n_input * sizeof(int));
    a->pair = bough_arena_take(arena, (size_t)def->n_connection * sizeof *a->pair);
    bool *resolved = bough_arena_take(arena, (size_t)a->n_member * sizeof(bool));
    double *input = bough_arena_doubles(arena, 2 * n_input);
    double *output = bough_arena_doubles(arena, (size_t)a->n_output);
    // connections
    connect_all(a, def);
    find_vectors(a);
    pair_ports(a, def);
    // which members lead, and in which order outputs are evaluated
    for (int i = 0; i < a->n_member; i++) {
        a->feedthrough[i] = probe_feedthrough(a->member[i], input, output);
    }
    find_leaders(a);
    bough_status status = order_outputs(a, resolved);
    if (bough_is_ok(&status)) *assembly = a;
    return status;
}

void bough_assembly_states(const bough_assembly *a, double *state) {
    for (int i = 0; i < a->n_member; i++) {
        const bough_member *m = a->member[i];
        memcpy(state + a->state_offset[i], m->state, (size_t)m->system.n_state * sizeof *state);
    }
}

void bough_assembly_scales(const bough_assembly *a, double *scale) {
    for (int i = 0; i < a->n_member; i++) {
        const bough_system *s = &a->member[i]->system;
        memcpy(scale + a->state_offset[i], s->scale, (size_t)s->n_state * sizeof *scale);
    }
}

void bough_assembly_gather(const bough_assembly *a, int member, const double *output, double *input) {
    for (int j = a->input_offset[member]; j < a->input_offset[member + 1]; j++) {
        input[j] = output[a->source[j]];
    }
}

void bough_assembly_outputs(const bough_assembly *a, double t, double *output, double *input) {
    // theory (54): o_i = h_i(t, y_i, u_i), u = P o
    for (int n = 0; n < a->n_member; n++) {
        int i = a->order[n];
        const bough_system *s = &a->member[i]->system;
        bough_assembly_gather(a, i, output, input);
        s->ops->output(s->self, t, a->member[i]->state, input + a->input_offset[i],
                       output + a->output_offset[i]);
    }
    for (int i = 0; i < a->n_member; i++) bough_assembly_gather(a, i, output, input);
}
