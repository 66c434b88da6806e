#include "cosim/condense.h"

#include "core/linalg.h"

#include <math.h>
#include <string.h>

static const bough_subsystem *subsystem(const bough_condensed *k, int member) {
    return k->assembly->member[member];
}

// The member that feeds input j, numbered over all inputs, and by which of its outputs.
static const bough_answer *feeder(const bough_condensed *k, int j, int *output) {
    const bough_assembly *a = k->assembly;
    *output = a->source[j] - a->output_offset[a->source_member[j]];
    return &k->of[a->source_member[j]];
}

// -- shape ----------------------------------------------------------------------------------------

static void choose_leaders(bough_condensed *k) {
    const bough_assembly *a = k->assembly;
    for (int i = 0; i < a->n_member; i++)
        k->of[i].leads = a->stage[i] == 0;
    for (int i = 0; i < a->n_member; i++) {
        for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++) {
            int from = a->source_member[j];
            if (a->stage[i] == 0 || a->stage[from] == 0) continue;
            k->of[i].leads = k->of[from].leads = true;
        }
    }
}

static void choose_coordinates(bough_condensed *k, int member) {
    const bough_subsystem *s = subsystem(k, member);
    bough_answer *w = &k->of[member];
    w->leader = -1;
    w->by_state = w->leads && !k->assembly->feedthrough[member] && s->n_state < s->n_input;
    w->n = w->by_state ? s->n_state : s->n_input;
    if (!w->leads) return;
    w->first = k->n;
    k->n += w->n;
    for (int j = 0; j < s->n_input; j++) {
        k->lead[k->n_lead++] = k->assembly->input_offset[member] + j;
    }
}

// A follower that hangs on one leader with few states is asked along these.
static void choose_directions(bough_condensed *k, int member) {
    const bough_assembly *a = k->assembly;
    bough_answer *w = &k->of[member];
    int begin = a->input_offset[member], end = a->input_offset[member + 1];
    if (w->leads || begin == end) return;
    for (int j = begin; j < end; j++) {
        if (a->source_member[j] != a->source_member[begin]) return;
    }
    const bough_answer *leader = &k->of[a->source_member[begin]];
    if (!leader->by_state || leader->n >= w->n) return;
    w->leader = a->source_member[begin];
    w->n = leader->n;
}

static void take_answer(bough_condensed *k, bough_arena *arena, int member) {
    const bough_subsystem *s = subsystem(k, member);
    bough_answer *w = &k->of[member];
    size_t n = (size_t)w->n, n_state = (size_t)s->n_state, n_input = (size_t)s->n_input;
    w->column = bough_arena_doubles(arena, n_input * n_state);
    w->response = bough_arena_doubles(arena, n * (size_t)s->n_output);
    if (w->by_state) w->inverse = bough_arena_doubles(arena, n_state * n_state);
    if (w->leads) return;
    w->direction = bough_arena_doubles(arena, n * n_input);
    w->along = bough_arena_doubles(arena, n * n_state);
}

bough_status bough_condensed_create(bough_arena *arena, const bough_assembly *assembly,
                                    bough_condensed **condensed) {
    size_t n_member = (size_t)assembly->n_member;
    bough_condensed *k = bough_arena_take(arena, sizeof *k);
    if (!k) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    k->assembly = assembly;
    k->of = bough_arena_take(arena, n_member * sizeof *k->of);
    k->lead = bough_arena_take(arena, (size_t)assembly->n_input * sizeof(int));
    if (bough_arena_exhausted(arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    choose_leaders(k);
    for (int i = 0; i < assembly->n_member; i++)
        choose_coordinates(k, i);
    for (int i = 0; i < assembly->n_member; i++)
        choose_directions(k, i);
    for (int i = 0; i < assembly->n_member; i++)
        take_answer(k, arena, i);
    size_t n = (size_t)k->n;
    k->gain = bough_arena_doubles(arena, (size_t)k->n_lead * n);
    k->loop = bough_arena_doubles(arena, n * n);
    k->matrix = bough_arena_doubles(arena, n * n);
    k->square = bough_arena_doubles(arena, n * n);
    k->pivot = bough_arena_take(arena, n * sizeof(int));
    k->coordinate = bough_arena_doubles(arena, n);
    k->moved = bough_arena_doubles(arena, (size_t)assembly->n_output);
    k->right = bough_arena_doubles(arena, (size_t)k->n_lead);
    k->unit = bough_arena_doubles(arena, (size_t)assembly->n_input);
    k->share = bough_arena_doubles(arena, (size_t)assembly->n_input);
    k->work = bough_arena_doubles(arena, (size_t)assembly->n_state);
    *condensed = k;
    return bough_arena_exhausted(arena) ? bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory")
                                        : bough_ok();
}

// -- members --------------------------------------------------------------------------------------

// Change of the outputs with the state and the inputs; either may be NULL.
static void output_change(const bough_subsystem *s, const bough_operating_point *at,
                          const double *state_change, const double *input_change, double *change) {
    s->ops->output_tangent(s->self, at->time, at->state, at->input, state_change, input_change,
                           change);
}

static bool factor(const bough_condensed *k, int member, const bough_operating_point *at) {
    const bough_subsystem *s = subsystem(k, member);
    if (at->kept && s->ops->newton_refactor) {
        if (!s->ops->newton_refactor(s->self, at->gamma)) return false;
        if (!k->of[member].leads) return true; // its columns have no γ in them
    } else if (!s->ops->newton_setup(s->self, at->time, at->state, at->input, at->gamma)) {
        return false;
    }
    s->ops->input_columns(s->self, at->time, at->state, at->input, k->of[member].column);
    return true;
}

enum { AT_ONCE = 4 };

// sum += Σ_j share_j column_j, in this order
static void add_some(int n, const double share[AT_ONCE], const double *const column[AT_ONCE],
                     double *restrict sum) {
    const double *restrict c0 = column[0], *restrict c1 = column[1];
    const double *restrict c2 = column[2], *restrict c3 = column[3];
    double s0 = share[0], s1 = share[1], s2 = share[2], s3 = share[3];
#pragma omp simd
    for (int i = 0; i < n; i++) {
        sum[i] = sum[i] + s0 * c0[i] + s1 * c1[i] + s2 * c2[i] + s3 * c3[i];
    }
}

// sum (n) += factor Σ_j weight_j column_j, the columns (count × n) one after the other
static void add_columns(int n, int count, const double *column, double factor,
                        const double *weight, double *sum) {
    const double *some[AT_ONCE];
    double share[AT_ONCE];
    int k = 0;
    for (int j = 0; j < count; j++, column += n) {
        if (weight[j] == 0) continue;
        share[k] = factor * weight[j];
        some[k++] = column;
        if (k == AT_ONCE) add_some(n, share, some, sum);
        k %= AT_ONCE;
    }
    if (k == 0) return;
    for (; k < AT_ONCE; k++) {
        share[k] = 0;
        some[k] = some[0];
    }
    add_some(n, share, some, sum);
}

void bough_condensed_add_columns(const bough_condensed *k, int member, double factor,
                                 const double *weight, double *sum) {
    const bough_subsystem *s = subsystem(k, member);
    add_columns(s->n_state, s->n_input, k->of[member].column, factor, weight, sum);
}

// columns ← (I − γJ)⁻¹ γ columns, by the inverse: there are fewer states than inputs
static void solve_columns(const bough_condensed *k, int member, double gamma) {
    const bough_subsystem *s = subsystem(k, member);
    const bough_answer *w = &k->of[member];
    double *right = k->work + k->assembly->state_offset[member], *column = w->column;
    int n = s->n_state;
    memset(w->inverse, 0, (size_t)n * (size_t)n * sizeof(double));
    for (int i = 0; i < n; i++) {
        w->inverse[i * n + i] = gamma;
        s->ops->newton_solve(s->self, w->inverse + (size_t)i * (size_t)n);
    }
    for (int j = 0; j < s->n_input; j++, column += n) {
        memcpy(right, column, (size_t)n * sizeof(double));
        memset(column, 0, (size_t)n * sizeof(double));
        for (int i = 0; i < n; i++) {
            for (int r = 0; r < n; r++)
                column[r] += right[i] * w->inverse[i * n + r];
        }
    }
}

// The outputs' change with each input, through the states and at once.
static void find_input_responses(const bough_condensed *k, int member,
                                 const bough_operating_point *at) {
    const bough_subsystem *s = subsystem(k, member);
    const bough_answer *w = &k->of[member];
    double *unit = k->unit + k->assembly->input_offset[member];
    double *column = w->column, *response = w->response;
    for (int j = 0; j < s->n_input; j++, column += s->n_state, response += s->n_output) {
        for (int i = 0; i < s->n_state; i++)
            column[i] *= at->gamma;
        s->ops->newton_solve(s->self, column);
        unit[j] = 1;
        output_change(s, at, column, unit, response);
        unit[j] = 0;
    }
}

static void find_state_responses(const bough_condensed *k, int member,
                                 const bough_operating_point *at) {
    const bough_subsystem *s = subsystem(k, member);
    double *state = k->work + k->assembly->state_offset[member];
    double *response = k->of[member].response;
    memset(state, 0, (size_t)s->n_state * sizeof(double));
    for (int i = 0; i < s->n_state; i++, response += s->n_output) {
        state[i] = 1;
        output_change(s, at, state, NULL, response);
        state[i] = 0;
    }
}

bool bough_condensed_factor_leader(bough_condensed *k, int member,
                                   const bough_operating_point *at) {
    const bough_answer *w = &k->of[member];
    if (!factor(k, member, at)) return false;
    if (!w->by_state) {
        find_input_responses(k, member, at);
        return true;
    }
    solve_columns(k, member, at->gamma);
    find_state_responses(k, member, at);
    return true;
}

// Whether a leader's output p changes with none of its coordinates.
static bool is_constant(const bough_answer *w, int p, int n_output) {
    for (int c = 0; c < w->n; c++) {
        if (w->response[c * n_output + p] != 0) return false;
    }
    return true;
}

// The input changes of a follower along each of its directions.
static void find_directions(bough_condensed *k, int member) {
    const bough_assembly *a = k->assembly;
    const bough_answer *w = &k->of[member];
    int n_input = a->member[member]->n_input;
    memset(w->direction, 0, (size_t)w->n * (size_t)n_input * sizeof(double));
    for (int j = 0; j < n_input; j++) {
        int p, input = a->input_offset[member] + j;
        const bough_answer *from = feeder(k, input, &p);
        int n_output = a->member[a->source_member[input]]->n_output;
        if (w->leader < 0) {
            w->direction[j * n_input + j] = is_constant(from, p, n_output) ? 0 : 1;
            continue;
        }
        for (int d = 0; d < w->n; d++) {
            w->direction[d * n_input + j] = from->response[d * n_output + p];
        }
    }
}

static bool any(const double *x, int n) {
    for (int i = 0; i < n; i++) {
        if (x[i] != 0) return true;
    }
    return false;
}

bool bough_condensed_factor_follower(bough_condensed *k, int member,
                                     const bough_operating_point *at) {
    const bough_subsystem *s = subsystem(k, member);
    const bough_answer *w = &k->of[member];
    if (!factor(k, member, at)) return false;
    find_directions(k, member);
    for (int d = 0; d < w->n; d++) {
        const double *direction = w->direction + (size_t)d * (size_t)s->n_input;
        double *along = w->along + (size_t)d * (size_t)s->n_state;
        double *response = w->response + (size_t)d * (size_t)s->n_output;
        memset(along, 0, (size_t)s->n_state * sizeof(double));
        memset(response, 0, (size_t)s->n_output * sizeof(double));
        if (!any(direction, s->n_input)) continue;
        bough_condensed_add_columns(k, member, at->gamma, direction, along);
        s->ops->newton_solve(s->self, along);
        output_change(s, at, along, direction, response);
    }
    return true;
}

// -- the interface --------------------------------------------------------------------------------

// Adds to K's row what the leaders' coordinates do to input j through the member that leads.
static void add_leading(const bough_condensed *k, double factor, int j, double *row) {
    int p;
    const bough_answer *w = feeder(k, j, &p);
    int n_output = subsystem(k, k->assembly->source_member[j])->n_output;
    for (int c = 0; c < w->n; c++)
        row[w->first + c] += factor * w->response[c * n_output + p];
}

static void find_gain_row(const bough_condensed *k, int l) {
    const bough_assembly *a = k->assembly;
    int p, from = a->source_member[k->lead[l]];
    const bough_answer *w = feeder(k, k->lead[l], &p);
    double *row = k->gain + (size_t)l * (size_t)k->n;
    memset(row, 0, (size_t)k->n * sizeof(double));
    if (w->leads) {
        add_leading(k, 1, k->lead[l], row);
        return;
    }
    for (int d = 0; d < w->n; d++) {
        double response = w->response[d * a->member[from]->n_output + p];
        if (response == 0) continue;
        if (w->leader >= 0) {
            row[k->of[w->leader].first + d] = response;
        } else {
            add_leading(k, response, a->input_offset[from] + d, row);
        }
    }
}

// z += Z u; the leaders' input l is u[l·stride]
static void add_coordinates(const bough_condensed *k, const double *u, int stride, double *z) {
    for (int i = 0, l = 0; i < k->assembly->n_member; i++) {
        const bough_answer *w = &k->of[i];
        if (!w->leads) continue;
        const double *column = w->column;
        for (int j = 0; j < subsystem(k, i)->n_input; j++, l++, column += w->n) {
            double input = u[(size_t)l * (size_t)stride];
            if (!w->by_state) {
                z[w->first + j] += input;
                continue;
            }
            for (int c = 0; c < w->n; c++)
                z[w->first + c] += input * column[c];
        }
    }
}

bool bough_condensed_close(bough_condensed *k) {
    int n = k->n;
    size_t size = (size_t)n * (size_t)n;
    for (int l = 0; l < k->n_lead; l++)
        find_gain_row(k, l);
    memset(k->loop, 0, size * sizeof(double));
    for (int c = 0; c < n; c++)
        add_coordinates(k, k->gain + c, n, k->loop + (size_t)c * n);
    for (size_t i = 0; i < size; i++)
        k->matrix[i] = -k->loop[i];
    for (int c = 0; c < n; c++)
        k->matrix[(size_t)c * n + c] += 1;
    return n == 0 || bough_dense_factor(n, k->matrix, k->pivot);
}

// The leaders' outputs' change with the coordinates.
static void move_outputs(bough_condensed *k) {
    for (int i = 0; i < k->assembly->n_member; i++) {
        const bough_answer *w = &k->of[i];
        if (!w->leads) continue;
        int n_output = subsystem(k, i)->n_output;
        double *moved = k->moved + k->assembly->output_offset[i];
        memset(moved, 0, (size_t)n_output * sizeof *moved);
        add_columns(n_output, w->n, w->response, 1, k->coordinate + w->first, moved);
    }
}

void bough_condensed_solve(bough_condensed *k, double *change) {
    const bough_assembly *a = k->assembly;
    int n = k->n;
    for (int l = 0; l < k->n_lead; l++)
        k->right[l] = change[k->lead[l]];
    add_coordinates(k, k->right, 1, k->coordinate);
    if (n > 0) bough_dense_solve(n, 1, k->matrix, k->pivot, k->coordinate);
    for (int l = 0; l < k->n_lead; l++) {
        const double *row = k->gain + (size_t)l * (size_t)n;
        for (int c = 0; c < n; c++)
            change[k->lead[l]] += row[c] * k->coordinate[c];
    }
    move_outputs(k);
    for (int i = 0; i < a->n_member; i++) {
        if (k->of[i].leads) continue;
        for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++)
            change[j] += k->moved[a->source[j]];
    }
}

void bough_condensed_add_answer(const bough_condensed *k, int member, double *x) {
    const bough_assembly *a = k->assembly;
    const bough_answer *w = &k->of[member];
    int n = subsystem(k, member)->n_state;
    if (w->by_state) {
        for (int i = 0; i < n; i++) x[i] += k->coordinate[w->first + i];
    } else if (w->leads) {
        add_columns(n, w->n, w->column, 1, k->coordinate + w->first, x);
    } else if (w->leader >= 0) {
        add_columns(n, w->n, w->along, 1, k->coordinate + k->of[w->leader].first, x);
    } else {
        double *share = k->share + a->input_offset[member];
        for (int d = 0; d < w->n; d++)
            share[d] = k->moved[a->source[a->input_offset[member] + d]];
        add_columns(n, w->n, w->along, 1, share, x);
    }
}

// -- how much the interface answers to itself -----------------------------------------------------

// result = a a (n × n, column-major)
static void square(int n, const double *a, double *result) {
    memset(result, 0, (size_t)n * (size_t)n * sizeof(double));
    for (int j = 0; j < n; j++) {
        for (int k = 0; k < n; k++) {
            double factor = a[j * n + k];
            for (int i = 0; i < n; i++)
                result[j * n + i] += factor * a[k * n + i];
        }
    }
}

// As ‖(Z K)ᵖ‖^(1/p) with p = 2¹².
double bough_condensed_radius(bough_condensed *k) {
    double logarithm = 0, weight = 1;
    int n = k->n;
    for (int doubling = 0; doubling < 12; doubling++) {
        double norm = 0;
        for (int i = 0; i < n * n; i++)
            norm = fmax(norm, fabs(k->loop[i]));
        if (norm == 0) return 0;
        logarithm += weight * log(norm);
        weight /= 2;
        for (int i = 0; i < n * n; i++)
            k->loop[i] /= norm;
        square(n, k->loop, k->square);
        memcpy(k->loop, k->square, (size_t)(n * n) * sizeof(double));
    }
    return exp(logarithm);
}
