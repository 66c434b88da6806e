#include "cosim/arrow.h"

#include "core/linalg.h"

#include <string.h>

// work(arrow, member) for every member, in parallel; the first failure in member order.
static bough_status each(bough_arrow *a, void (*work)(bough_arrow *a, int member)) {
    int n = a->assembly->n_member;
    for (int i = 0; i < n; i++) a->status[i].code = BOUGH_OK;
    if (a->threads > 1) {
#pragma omp parallel for schedule(dynamic, 1) num_threads(a->threads)
        for (int i = 0; i < n; i++) work(a, i);
    } else {
        for (int i = 0; i < n; i++) work(a, i);
    }
    for (int i = 0; i < n; i++) {
        if (!bough_is_ok(&a->status[i])) return a->status[i];
    }
    return bough_ok();
}

// -- evaluation -----------------------------------------------------------------------------------

void bough_arrow_inputs(bough_arrow *arrow, double t, const double *state) {
    const bough_assembly *a = arrow->assembly;
    for (int n = 0; n < a->n_member; n++) {
        int i = a->order[n];
        const bough_subsystem *s = a->member[i];
        bough_assembly_gather(a, i, arrow->output, arrow->input);
        s->ops->output(s->self, t, state + a->state_offset[i], arrow->input + a->input_offset[i],
                       arrow->output + a->output_offset[i]);
    }
    for (int i = 0; i < a->n_member; i++) bough_assembly_gather(a, i, arrow->output, arrow->input);
}

static void evaluate(bough_arrow *arrow, int i) {
    const bough_assembly *a = arrow->assembly;
    const bough_subsystem *s = a->member[i];
    if (!s->ops->derivative(s->self, arrow->time, arrow->at + a->state_offset[i],
                            arrow->input + a->input_offset[i], arrow->x + a->state_offset[i])) {
        arrow->status[i] = bough_fail(BOUGH_FAILED, "%s: no finite rate of change at %.6g s",
                                      s->name, *s->time);
    }
}

bough_status bough_arrow_rate(bough_arrow *arrow, double t, const double *state, double *rate) {
    bough_arrow_inputs(arrow, t, state);
    arrow->time = t;
    arrow->at = state;
    arrow->x = rate;
    return each(arrow, evaluate);
}

// -- factors --------------------------------------------------------------------------------------

static void factor(bough_arrow *arrow, int i) {
    const bough_assembly *a = arrow->assembly;
    const bough_subsystem *s = a->member[i];
    const double *state = arrow->setup_state + a->state_offset[i];
    const double *input = arrow->setup_input + a->input_offset[i];
    double *column = arrow->column + arrow->column_offset[i];
    double *response = arrow->response + arrow->response_offset[i];
    double *unit = arrow->unit + a->input_offset[i];
    double t = arrow->setup_time;
    if (!s->ops->newton_setup(s->self, t, state, input, arrow->gamma)) {
        arrow->status[i] = bough_fail(BOUGH_RETRY, "%s: singular Newton matrix", s->name);
        return;
    }
    s->ops->input_columns(s->self, t, state, input, column);
    memset(unit, 0, (size_t)s->n_input * sizeof(double));
    for (int j = 0; j < s->n_input; j++, column += s->n_state, response += s->n_output) {
        for (int k = 0; k < s->n_state; k++) column[k] *= arrow->gamma;
        s->ops->newton_solve(s->self, column);
        unit[j] = 1;
        s->ops->output_tangent(s->self, t, state, input, column, unit, response);
        unit[j] = 0;
    }
}

// matrix = I − P · response
static void assemble_interface(bough_arrow *arrow) {
    const bough_assembly *a = arrow->assembly;
    int n = a->n_input;
    memset(arrow->matrix, 0, (size_t)n * (size_t)n * sizeof(double));
    for (int row = 0; row < n; row++) {
        int from = a->source_member[row], p = a->source[row] - a->output_offset[from];
        const double *response = arrow->response + arrow->response_offset[from];
        arrow->matrix[row * n + row] = 1;
        for (int j = 0; j < a->member[from]->n_input; j++) {
            int column = a->input_offset[from] + j;
            arrow->matrix[column * n + row] -= response[j * a->member[from]->n_output + p];
        }
    }
}

static bool factor_border(bough_arrow *arrow);

bough_status bough_arrow_setup(bough_arrow *arrow, double t, const double *state,
                               const double *input, double gamma) {
    int n = arrow->assembly->n_input;
    memcpy(arrow->setup_state, state, (size_t)arrow->assembly->n_state * sizeof(double));
    memcpy(arrow->setup_input, input, (size_t)n * sizeof(double));
    arrow->setup_time = t;
    arrow->gamma = gamma;
    bough_status status = each(arrow, factor);
    if (!bough_is_ok(&status)) return status;
    assemble_interface(arrow);
    if (n == 0 || bough_dense_factor(n, arrow->matrix, arrow->pivot)) {
        if (factor_border(arrow)) return status;
    }
    return bough_fail(BOUGH_RETRY, "the interface's Newton matrix is singular");
}

// -- solution -------------------------------------------------------------------------------------

// x_i = (I − γJ_i)⁻¹ r_i and the outputs' change with it, the inputs held
static void solve_alone(bough_arrow *arrow, int i) {
    const bough_assembly *a = arrow->assembly;
    const bough_subsystem *s = a->member[i];
    double *x = arrow->x + a->state_offset[i];
    s->ops->newton_solve(s->self, x);
    s->ops->output_tangent(s->self, arrow->setup_time, arrow->setup_state + a->state_offset[i],
                           arrow->setup_input + a->input_offset[i], x, NULL,
                           arrow->output_change + a->output_offset[i]);
}

static void add_interface(bough_arrow *arrow, int i) {
    const bough_assembly *a = arrow->assembly;
    const double *column = arrow->column + arrow->column_offset[i];
    double *x = arrow->x + a->state_offset[i];
    int n = a->member[i]->n_state;
    for (int j = a->input_offset[i]; j < a->input_offset[i + 1]; j++, column += n) {
        for (int k = 0; k < n; k++) x[k] += arrow->change[j] * column[k];
    }
}

static void solve_free(bough_arrow *arrow, double *x) {
    bough_arrow_solve_driven(arrow, NULL, x);
}

void bough_arrow_solve_driven(bough_arrow *arrow, const double *outside, double *x) {
    int n = arrow->assembly->n_input;
    arrow->x = x;
    each(arrow, solve_alone);
    for (int j = 0; j < n; j++) {
        arrow->change[j] = arrow->output_change[arrow->assembly->source[j]];
        if (outside) arrow->change[j] += outside[j];
    }
    if (n > 0) bough_dense_solve(n, 1, arrow->matrix, arrow->pivot, arrow->change);
    each(arrow, add_interface);
}

// The border's multipliers make the held entries of its solutions vanish.
static bool factor_border(bough_arrow *arrow) {
    int n = arrow->assembly->n_state, held = arrow->n_held;
    for (int j = 0; j < held; j++) {
        double *column = arrow->border + (size_t)j * n;
        memset(column, 0, (size_t)n * sizeof *column);
        column[arrow->held[j]] = 1;
        solve_free(arrow, column);
        for (int i = 0; i < held; i++) {
            arrow->multiplier[j * held + i] = column[arrow->held[i]];
        }
    }
    return held == 0 || bough_dense_factor(held, arrow->multiplier, arrow->held_pivot);
}

void bough_arrow_solve(bough_arrow *arrow, double *x) {
    int n = arrow->assembly->n_state, held = arrow->n_held;
    solve_free(arrow, x);
    if (held == 0) return;
    for (int i = 0; i < held; i++) arrow->share[i] = x[arrow->held[i]];
    bough_dense_solve(held, 1, arrow->multiplier, arrow->held_pivot, arrow->share);
    for (int j = 0; j < held; j++) {
        const double *column = arrow->border + (size_t)j * n;
        for (int k = 0; k < n; k++) x[k] -= arrow->share[j] * column[k];
    }
    for (int i = 0; i < held; i++) x[arrow->held[i]] = 0;
}

// -- memory ---------------------------------------------------------------------------------------

static bool take(bough_arrow *arrow, bough_arena *arena) {
    const bough_assembly *a = arrow->assembly;
    size_t n_input = (size_t)a->n_input, n_output = (size_t)a->n_output;
    size_t n_member = (size_t)a->n_member, columns = 0, responses = 0;
    arrow->column_offset = bough_arena_take(arena, n_member * sizeof(size_t));
    arrow->response_offset = bough_arena_take(arena, n_member * sizeof(size_t));
    arrow->status = bough_arena_take(arena, n_member * sizeof *arrow->status);
    if (bough_arena_exhausted(arena)) return false;
    for (int i = 0; i < a->n_member; i++) {
        const bough_subsystem *s = a->member[i];
        arrow->column_offset[i] = columns;
        arrow->response_offset[i] = responses;
        columns += (size_t)s->n_input * (size_t)s->n_state;
        responses += (size_t)s->n_input * (size_t)s->n_output;
    }
    arrow->column = bough_arena_doubles(arena, columns);
    arrow->response = bough_arena_doubles(arena, responses);
    arrow->setup_state = bough_arena_doubles(arena, (size_t)a->n_state);
    arrow->setup_input = bough_arena_doubles(arena, n_input);
    arrow->input = bough_arena_doubles(arena, n_input);
    arrow->unit = bough_arena_doubles(arena, n_input);
    arrow->change = bough_arena_doubles(arena, n_input);
    arrow->output = bough_arena_doubles(arena, n_output);
    arrow->output_change = bough_arena_doubles(arena, n_output);
    arrow->matrix = bough_arena_doubles(arena, n_input * n_input);
    arrow->pivot = bough_arena_take(arena, n_input * sizeof(int));
    return !bough_arena_exhausted(arena);
}

bough_status bough_arrow_create(bough_arena *arena, const bough_assembly *assembly, int threads,
                                bough_arrow **arrow) {
    bough_arrow *a = bough_arena_take(arena, sizeof *a);
    if (!a) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    a->assembly = assembly;
    a->threads = threads;
    if (!take(a, arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    *arrow = a;
    return bough_ok();
}

bough_status bough_arrow_hold(bough_arena *arena, bough_arrow *arrow, int n, const int *held) {
    size_t count = (size_t)n;
    arrow->n_held = n;
    arrow->held = held;
    arrow->border = bough_arena_doubles(arena, count * (size_t)arrow->assembly->n_state);
    arrow->multiplier = bough_arena_doubles(arena, count * count);
    arrow->share = bough_arena_doubles(arena, count);
    arrow->held_pivot = bough_arena_take(arena, (count + 1) * sizeof(int));
    return bough_arena_exhausted(arena) ? bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory")
                                        : bough_ok();
}
