// Static condensation, theory (56, 57). Each member is linearised and factored by itself.
#include "cosim/interface.h"

#include "core/base/linalg.h"

static const bough_system *system_of(const bough_interface *k, int member) {
    return &k->assembly->member[member]->system;
}

// The member that feeds input j, numbered over all inputs, and by which of its outputs.
static const bough_interface_member *feeder(const bough_interface *k, int j, int *output) {
    const bough_assembly *a = k->assembly;
    *output = a->source[j] - a->output_offset[a->source_member[j]];
    return &k->part[a->source_member[j]];
}

// -- shape ----------------------------------------------------------------------------------------

// A leader's coordinates are its states where these are fewer than its inputs, else its inputs.
static void choose_coordinates(bough_interface *k, int member) {
    const bough_system *s = system_of(k, member);
    bough_interface_member *part = &k->part[member];
    part->leader = -1;
    part->is_leader = k->assembly->leads[member];
    part->by_state = part->is_leader && !k->assembly->feedthrough[member] && s->n_state < s->n_input;
    part->n = part->by_state ? s->n_state : s->n_input;
    if (!part->is_leader) return;
    // its place among all coordinates and inputs of leaders
    part->first = k->n;
    k->n += part->n;
    for (int j = 0; j < s->n_input; j++) {
        k->leader_input[k->n_leader_input++] = k->assembly->input_offset[member] + j;
    }
}

// The directions of a follower whose inputs all come from one leader with few states are these states.
static void choose_directions(bough_interface *k, int member) {
    const bough_assembly *a = k->assembly;
    bough_interface_member *part = &k->part[member];
    int begin = a->input_offset[member], end = a->input_offset[member + 1];
    if (part->is_leader || begin == end) return;
    // one leader
    for (int j = begin; j < end; j++) {
        if (a->source_member[j] != a->source_member[begin]) return;
    }
    // fewer states than inputs
    const bough_interface_member *leader = &k->part[a->source_member[begin]];
    if (!leader->by_state || leader->n >= part->n) return;
    part->leader = a->source_member[begin];
    part->n = leader->n;
}

static void take_part(bough_interface *k, bough_arena *arena, int member) {
    const bough_system *s = system_of(k, member);
    bough_interface_member *part = &k->part[member];
    size_t n = (size_t)part->n, n_state = (size_t)s->n_state, n_input = (size_t)s->n_input;
    part->column = bough_arena_doubles(arena, n_input * n_state);
    part->output_change = bough_arena_doubles(arena, n * (size_t)s->n_output);
    if (part->by_state) part->inverse = bough_arena_doubles(arena, n_state * n_state);
    part->factors = s->ops->factors(s->self, arena);
    if (part->by_state) return;
    part->direction = bough_arena_doubles(arena, n * n_input);
    part->state_change = bough_arena_doubles(arena, n * n_state);
}

bough_interface *bough_interface_create(bough_arena *arena, const bough_assembly *assembly) {
    size_t n_member = (size_t)assembly->n_member;
    bough_interface *k = bough_arena_take(arena, sizeof *k);
    k->assembly = assembly;
    k->level = bough_level_chosen();
    k->part = bough_arena_take(arena, n_member * sizeof *k->part);
    k->leader_input = bough_arena_take(arena, (size_t)assembly->n_input * sizeof(int));
    // shape: leaders first, because followers refer to them
    for (int i = 0; i < assembly->n_member; i++) choose_coordinates(k, i);
    for (int i = 0; i < assembly->n_member; i++) choose_directions(k, i);
    for (int i = 0; i < assembly->n_member; i++) take_part(k, arena, i);
    // matrices of the interface
    size_t n = (size_t)k->n;
    k->gain = bough_arena_doubles(arena, (size_t)k->n_leader_input * n);
    bough_arena_each(arena, n * n, &k->loop, &k->matrix);
    k->eigen = bough_arena_doubles(arena, n * (n + 2) + BOUGH_EIGEN_WORK(n));
    k->pivot = bough_arena_take(arena, n * sizeof(int));
    bough_arena_each(arena, n, &k->coordinate, &k->sum);
    k->moved = bough_arena_doubles(arena, (size_t)assembly->n_output);
    k->right = bough_arena_doubles(arena, (size_t)k->n_leader_input);
    k->work = bough_arena_doubles(arena, (size_t)assembly->n_state);
    return k;
}

// -- members --------------------------------------------------------------------------------------

void bough_interface_output_change(const bough_interface *k, int member, const bough_operating_point *at,
                                   const double *state_change, const double *input_change, double *change) {
    const bough_system *s = system_of(k, member);
    bool (*kept)(void *, const void *, const double *, const double *, double *) = s->ops->kept_tangent;
    if (kept && kept(s->self, k->part[member].factors, state_change, input_change, change)) return;
    s->ops->output_tangent(s->self, at->time, at->state, at->input, state_change, input_change, change);
}

// ∂f/∂u
static void find_columns(const bough_interface *k, int member, const bough_operating_point *at) {
    const bough_system *s = system_of(k, member);
    s->ops->input_columns(s->self, at->time, at->state, at->input, k->part[member].column);
}

// Columns without γ, which changes more often; those of a leader by states have γ.
bool bough_interface_linearise(bough_interface *k, int member, const bough_operating_point *at) {
    const bough_system *s = system_of(k, member);
    const bough_interface_member *part = &k->part[member];
    if (!s->ops->linearise(s->self, at->time, at->state, at->input, part->factors)) return false;
    if (!part->by_state) find_columns(k, member, at);
    return true;
}

void bough_interface_solve_member(const bough_interface *k, int member, double *x) {
    const bough_system *s = system_of(k, member);
    s->ops->solve(s->self, k->part[member].factors, x);
}

// sum (n) += factor Σ_j weight_j column_j, the columns (count × n) one after the other
static void add_columns(const bough_interface *k, int n, int count, const double *column, double factor,
                        const double *weight, double *sum) {
    BOUGH_OF_LEVEL(bough_add_columns, k->level)(n, count, column, factor, weight, sum);
}

void bough_interface_add_columns(const bough_interface *k, int member, double factor, const double *weight,
                                 double *sum) {
    const bough_system *s = system_of(k, member);
    add_columns(k, s->n_state, s->n_input, k->part[member].column, factor, weight, sum);
}

// (I − γJ)⁻¹ column by column.
static void find_inverse(const bough_interface *k, int member) {
    const bough_interface_member *part = &k->part[member];
    size_t n = (size_t)part->n;
    memset(part->inverse, 0, n * n * sizeof(double));
    for (size_t i = 0; i < n; i++) {
        part->inverse[i * n + i] = 1;
        bough_interface_solve_member(k, member, part->inverse + i * n);
    }
}

// The outputs' change with each state.
static void find_state_responses(const bough_interface *k, int member, const bough_operating_point *at) {
    const bough_system *s = system_of(k, member);
    double *state = k->work + k->assembly->state_offset[member];
    double *response = k->part[member].output_change;
    memset(state, 0, (size_t)s->n_state * sizeof(double));
    for (int i = 0; i < s->n_state; i++, response += s->n_output) {
        state[i] = 1;
        bough_interface_output_change(k, member, at, state, NULL, response);
        state[i] = 0;
    }
}

// The input changes of a member along each of its directions.
static void find_directions(bough_interface *k, int member) {
    const bough_assembly *a = k->assembly;
    const bough_interface_member *part = &k->part[member];
    int n_input = a->member[member]->system.n_input;
    memset(part->direction, 0, (size_t)part->n * (size_t)n_input * sizeof(double));
    for (int j = 0; j < n_input; j++) {
        int p, input = a->input_offset[member] + j;
        const bough_interface_member *from = feeder(k, input, &p);
        int n_output = a->member[a->source_member[input]]->system.n_output;
        if (part->leader < 0) { // its own inputs
            part->direction[j * n_input + j] = 1;
            continue;
        }
        for (int d = 0; d < part->n; d++) {
            part->direction[d * n_input + j] = from->output_change[d * n_output + p];
        }
    }
}

void bough_interface_respond(bough_interface *k, int member, const bough_operating_point *at) {
    const bough_system *s = system_of(k, member);
    const bough_interface_member *part = &k->part[member];
    find_directions(k, member);
    for (int d = 0; d < part->n; d++) {
        const double *direction = part->direction + (size_t)d * (size_t)s->n_input;
        double *state = part->state_change + (size_t)d * (size_t)s->n_state;
        double *response = part->output_change + (size_t)d * (size_t)s->n_output;
        memset(state, 0, (size_t)s->n_state * sizeof(double));
        memset(response, 0, (size_t)s->n_output * sizeof(double));
        if (bough_all_zero(s->n_input, direction)) continue;
        // x = (I − γJ)⁻¹ γ ∂f/∂u δu, then the outputs
        bough_interface_add_columns(k, member, at->gamma, direction, state);
        bough_interface_solve_member(k, member, state);
        bough_interface_output_change(k, member, at, state, direction, response);
    }
}

bool bough_interface_factor(bough_interface *k, int member, const bough_operating_point *at) {
    const bough_interface_member *part = &k->part[member];
    const bough_system *s = system_of(k, member);
    if (!s->ops->factor(s->self, part->factors, at->gamma)) return false;
    if (part->is_leader && !part->by_state) bough_interface_respond(k, member, at);
    if (!part->by_state) return true;
    // γ ∂f/∂u, and the responses to its states
    find_columns(k, member, at);
    for (int i = 0; i < s->n_input * s->n_state; i++) part->column[i] *= at->gamma;
    find_inverse(k, member);
    find_state_responses(k, member, at);
    return true;
}

// -- the interface --------------------------------------------------------------------------------

// Adds to row l of K the response of input j to the coordinates of the leader that feeds it.
static void add_leading(const bough_interface *k, double factor, int j, int l) {
    int p;
    const bough_interface_member *part = feeder(k, j, &p);
    int n_output = system_of(k, k->assembly->source_member[j])->n_output;
    for (int c = 0; c < part->n; c++) {
        k->gain[(part->first + c) * k->n_leader_input + l] += factor * part->output_change[c * n_output + p];
    }
}

// Row l of K: the response of a leader's input to all coordinates.
static void find_gain_row(const bough_interface *k, int l) {
    const bough_assembly *a = k->assembly;
    int p, from = a->source_member[k->leader_input[l]];
    const bough_interface_member *part = feeder(k, k->leader_input[l], &p);
    // a leader feeds it
    if (part->is_leader) {
        add_leading(k, 1, k->leader_input[l], l);
        return;
    }
    // a follower feeds it: through its directions
    for (int d = 0; d < part->n; d++) {
        double response = part->output_change[d * a->member[from]->system.n_output + p];
        if (response == 0) continue;
        if (part->leader >= 0) {
            k->gain[(k->part[part->leader].first + d) * k->n_leader_input + l] = response;
        } else {
            add_leading(k, response, a->input_offset[from] + d, l);
        }
    }
}

// z += u of a leader by inputs, γ ∂f/∂u u of one by states; u (n_leader_input)
static void add_inputs(const bough_interface *k, const double *u, double *z) {
    for (int i = 0; i < k->assembly->n_member; i++) {
        const bough_interface_member *part = &k->part[i];
        int n_input = system_of(k, i)->n_input;
        if (!part->is_leader) continue;
        if (part->by_state) {
            add_columns(k, part->n, n_input, part->column, 1, u, z + part->first);
        } else {
            for (int j = 0; j < n_input; j++) z[part->first + j] += u[j];
        }
        u += n_input;
    }
}

// z ← (I − γJ)⁻¹ z of the leaders by states
static void apply_inverses(const bough_interface *k, double *z) {
    for (int i = 0; i < k->assembly->n_member; i++) {
        const bough_interface_member *part = &k->part[i];
        if (!part->by_state) continue;
        memcpy(k->sum, z + part->first, (size_t)part->n * sizeof *z);
        memset(z + part->first, 0, (size_t)part->n * sizeof *z);
        add_columns(k, part->n, part->n, part->inverse, 1, k->sum, z + part->first);
    }
}

bool bough_interface_close(bough_interface *k) {
    size_t n = (size_t)k->n, size = n * n;
    // K
    memset(k->gain, 0, n * (size_t)k->n_leader_input * sizeof(double));
    for (int l = 0; l < k->n_leader_input; l++) find_gain_row(k, l);
    // Z K, column by column
    memset(k->loop, 0, size * sizeof(double));
    for (size_t c = 0; c < n; c++) {
        add_inputs(k, k->gain + c * (size_t)k->n_leader_input, k->loop + c * n);
        apply_inverses(k, k->loop + c * n);
    }
    // factors of I − Z K
    for (size_t i = 0; i < size; i++) k->matrix[i] = (i % (n + 1) == 0) - k->loop[i];
    return n == 0 || bough_dense_factor(k->n, k->matrix, k->pivot);
}

// The leaders' outputs' change with the coordinates.
static void move_outputs(bough_interface *k) {
    for (int i = 0; i < k->assembly->n_member; i++) {
        const bough_interface_member *part = &k->part[i];
        if (!part->is_leader) continue;
        int n_output = system_of(k, i)->n_output;
        double *moved = k->moved + k->assembly->output_offset[i];
        memset(moved, 0, (size_t)n_output * sizeof *moved);
        add_columns(k, n_output, part->n, part->output_change, 1, k->coordinate + part->first, moved);
    }
}

void bough_interface_solve(bough_interface *k, double *change) {
    const bough_assembly *a = k->assembly;
    // (I − Z K) w = Z b
    for (int l = 0; l < k->n_leader_input; l++) k->right[l] = change[k->leader_input[l]];
    add_inputs(k, k->right, k->coordinate);
    apply_inverses(k, k->coordinate);
    if (k->n > 0) bough_dense_solve(k->n, 1, k->matrix, k->pivot, k->coordinate);
    // u = b + K w
    add_columns(k, k->n_leader_input, k->n, k->gain, 1, k->coordinate, k->right);
    for (int l = 0; l < k->n_leader_input; l++) change[k->leader_input[l]] = k->right[l];
    // the followers' inputs move with the leaders' outputs
    move_outputs(k);
    for (int j = 0; j < a->n_input; j++) {
        if (!k->part[a->receiver[j]].is_leader) change[j] += k->moved[a->source[j]];
    }
}

void bough_interface_add_response(const bough_interface *k, int member, const double *change, double *x) {
    const bough_interface_member *part = &k->part[member];
    int n = system_of(k, member)->n_state;
    if (part->by_state) {
        for (int i = 0; i < n; i++) x[i] += k->coordinate[part->first + i];
    } else if (part->is_leader) {
        add_columns(k, n, part->n, part->state_change, 1, k->coordinate + part->first, x);
    } else if (part->leader >= 0) {
        add_columns(k, n, part->n, part->state_change, 1, k->coordinate + k->part[part->leader].first, x);
    } else {
        add_columns(k, n, part->n, part->state_change, 1, change, x);
    }
}

void bough_interface_add_output_response(const bough_interface *k, int member, const double *change,
                                         double *output_change) {
    const bough_interface_member *part = &k->part[member];
    if (part->leader >= 0) return;
    add_columns(k, system_of(k, member)->n_output, part->n, part->output_change, 1, change, output_change);
}

// theory (57)
double bough_interface_radius(bough_interface *k) {
    size_t n = (size_t)k->n;
    double *value = k->eigen + n * n, radius = 0;
    if (!bough_dense_eigen(k->n, k->loop, value, k->eigen, value + 2 * n)) return (double)NAN;
    for (size_t i = 0; i < n; i++) radius = fmax(radius, hypot(value[i], value[n + i]));
    return radius;
}
