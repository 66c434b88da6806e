#include "cosim/stability.h"

#include "core/base.h"
#include "core/linalg.h"
#include "cosim/linear_member.h"
#include "cosim/scheme.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { DIMENSION = 48, WARM_UP = 2, MOST_REPEATED = 24 };
static const double span = 0.06;      // this time passes per Arnoldi vector [s]
static const double sub_step = 5e-3;  // of the linear members at most [s]; a quarter of a macro
                                     // step, so that their own damping does not hide what rings
static const double exact = 1e-4;     // share of an eigenvalue
static const double threshold = 1e-2; // growth below is rounding or drift [1/s]

// The map z → z after `repeat` macro steps; z = (states, inputs one and two steps ago, applied inputs,
// deficit impulses).
typedef struct map {
    bough_arena *arena;
    bough_assembly assembly; // of the linear members
    bough_subsystem *linear; // (n_member)
    bough_coupling *coupling;
    double macro_step, sub_step;
    int repeat;
    int n;          // n_state + 3 n_input
    double *weight; // (n) makes the components comparable
    // Arnoldi
    int dimension;
    bool complete;      // nothing lies outside the space
    double *basis;      // ((DIMENSION + 1) × n)
    double *hessenberg; // (column j from j · DIMENSION, j + 2 long)
    double *packed;     // (dimension × dimension)
    double *value, *vector, *work; // for its eigenvalues
    int before;                    // dimension last time
    double *earlier;               // (2 × before) eigenvalues then
    double *z, *image;  // (n)
    double *pair;       // (2 × n) real and imaginary part of a vector
} map;

// -- building -------------------------------------------------------------------------------------

static bough_status build_linear_members(map *m, const bough_assembly *a, const double *input) {
    m->assembly = *a;
    m->linear = bough_arena_take(m->arena, (size_t)a->n_member * sizeof *m->linear);
    m->assembly.member = bough_arena_take(m->arena, (size_t)a->n_member * sizeof(void *));
    if (bough_arena_exhausted(m->arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    for (int i = 0; i < a->n_member; i++) {
        bough_status status = bough_linear_member_create(
            m->arena, a->member[i], input + a->input_offset[i], m->sub_step, &m->linear[i]);
        if (!bough_is_ok(&status)) return status;
        m->assembly.member[i] = &m->linear[i];
    }
    return bough_ok();
}

static bough_status take(map *m) {
    size_t n = (size_t)m->n, k = DIMENSION;
    m->weight = bough_arena_doubles(m->arena, n);
    m->basis = bough_arena_doubles(m->arena, (k + 1) * n);
    m->hessenberg = bough_arena_doubles(m->arena, (k + 1) * k);
    m->packed = bough_arena_doubles(m->arena, k * k);
    m->value = bough_arena_doubles(m->arena, 2 * k);
    m->earlier = bough_arena_doubles(m->arena, 2 * k);
    m->vector = bough_arena_doubles(m->arena, k * k);
    m->work = bough_arena_doubles(m->arena, 8 * k);
    m->z = bough_arena_doubles(m->arena, n);
    m->image = bough_arena_doubles(m->arena, n);
    m->pair = bough_arena_doubles(m->arena, 2 * n);
    return bough_arena_exhausted(m->arena) ? bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory")
                                           : bough_ok();
}

// What the iterated scheme converges to is judged, however it gets there: what its tolerance leaves
// would look like growth.
static bough_scheme_options converged(const bough_scheme_options *options) {
    bough_scheme_options o = *options;
    o.accelerator = BOUGH_ACCELERATE_IQN_ILS;
    o.tolerance = 1e-8;
    o.iterations = 100;
    return o;
}

static bough_status build(map *m, const bough_assembly *a, const bough_scheme_options *options) {
    bough_scheme_options judged = converged(options);
    double *output = bough_arena_doubles(m->arena, (size_t)a->n_output);
    double *input = bough_arena_doubles(m->arena, (size_t)a->n_input);
    if (bough_arena_exhausted(m->arena)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    bough_assembly_outputs(a, *a->member[0]->time, output, input);
    bough_status status = build_linear_members(m, a, input);
    if (!bough_is_ok(&status)) return status;
    bough_coupling *c = NULL;
    status = bough_scheme_couple(m->arena, &m->assembly, &judged, NULL, &c);
    if (!bough_is_ok(&status) || !c) return status;
    m->coupling = c;
    m->n = a->n_state + (c->deficit != NULL ? 4 : 3) * a->n_input;
    m->repeat = (int)fmin(ceil(span / m->macro_step - 1e-6), MOST_REPEATED);
    return take(m);
}

// -- the map --------------------------------------------------------------------------------------

static void load(map *m, const double *z) {
    bough_coupling *c = m->coupling;
    const bough_assembly *a = &m->assembly;
    for (int i = 0; i < a->n_member; i++) {
        const bough_subsystem *s = a->member[i];
        s->ops->set_state(s->self, 0, z + a->state_offset[i]);
    }
    size_t size = (size_t)a->n_input * sizeof(double);
    bough_assembly_outputs(a, 0, c->output, c->input);
    memcpy(c->past[0], c->input, size);
    memcpy(c->past[1], z + a->n_state, size);
    memcpy(c->past[2], z + a->n_state + a->n_input, size);
    memcpy(c->applied, z + a->n_state + 2 * a->n_input, size);
    for (int j = 0; j < a->n_input && c->deficit != NULL; j++) {
        bool paid = j < a->input_offset[1];
        c->deficit[j] = paid ? z[a->n_state + 3 * a->n_input + j] : 0;
    }
    for (int p = 0; p < BOUGH_HISTORY; p++) c->past_time[p] = -p * m->macro_step;
    c->n_past = BOUGH_HISTORY;
    c->t1 = 0;
}

static void store(const map *m, double *z) {
    const bough_coupling *c = m->coupling;
    const bough_assembly *a = &m->assembly;
    for (int i = 0; i < a->n_member; i++) {
        const bough_subsystem *s = a->member[i];
        memcpy(z + a->state_offset[i], s->state, (size_t)s->n_state * sizeof(double));
    }
    size_t size = (size_t)a->n_input * sizeof(double);
    memcpy(z + a->n_state, c->past[1], size);
    memcpy(z + a->n_state + a->n_input, c->past[2], size);
    memcpy(z + a->n_state + 2 * a->n_input, c->applied, size);
    if (c->deficit != NULL) memcpy(z + a->n_state + 3 * a->n_input, c->deficit, size);
}

// image = z after `count` macro steps
static bough_status apply(map *m, int count, const double *z, double *image) {
    bough_coupling *c = m->coupling;
    bough_status status = bough_ok();
    load(m, z);
    for (int k = 0; k < count && bough_is_ok(&status); k++) {
        c->t0 = c->t1;
        c->t1 = (k + 1) * m->macro_step;
        c->refactor = true; // a linear member advances by the same factors
        status = c->scheme->step(c);
        bough_coupling_exchange(c);
    }
    store(m, image);
    return status;
}

// The same on weighted vectors.
static bough_status apply_weighted(map *m, int count, const double *x, double *image) {
    for (int k = 0; k < m->n; k++) m->z[k] = x[k] / m->weight[k];
    bough_status status = apply(m, count, m->z, image);
    for (int k = 0; k < m->n; k++) image[k] *= m->weight[k];
    return status;
}

// -- vectors --------------------------------------------------------------------------------------

static double dot(int n, const double *x, const double *y) {
    double sum = 0;
    for (int k = 0; k < n; k++) sum += x[k] * y[k];
    return sum;
}

static void add(int n, double factor, const double *x, double *sum) {
    for (int k = 0; k < n; k++) sum[k] += factor * x[k];
}

static void divide(int n, double divisor, double *x) {
    for (int k = 0; k < n; k++) x[k] /= divisor;
}

// Inputs weigh what they do to the whole against the states: each member's as its largest.
static void choose_weights(map *m, const double *z) {
    const bough_assembly *a = &m->assembly;
    double sum = 0;
    for (int i = 0, k = 0; i < a->n_member; i++) {
        for (int j = 0; j < a->member[i]->n_state; j++, k++) {
            m->weight[k] = 1 / a->member[i]->scale[j];
            sum += z[k] * z[k] * m->weight[k] * m->weight[k];
        }
    }
    for (int i = 0; i < a->n_member; i++) {
        int first = a->input_offset[i], last = a->input_offset[i + 1];
        double largest = 0;
        for (int j = first; j < last; j++) {
            largest = fmax(largest, fabs(z[a->n_state + 2 * a->n_input + j]));
        }
        double weight = largest > 0 ? sqrt(sum / a->n_input) / largest : 1;
        for (int j = first; j < last; j++) {
            for (int p = 0; p < 3; p++) m->weight[a->n_state + p * a->n_input + j] = weight;
            if (m->coupling->deficit == NULL) continue;
            m->weight[a->n_state + 3 * a->n_input + j] = weight / m->macro_step;
        }
    }
}

// A start in which every mode takes part, the stiff ones damped away: fixed pseudo-random numbers
// after a few macro steps.
static bough_status start(map *m) {
    const bough_assembly *a = &m->assembly;
    double *x = m->basis;
    unsigned seed = 1;
    for (int i = 0, k = 0; i < a->n_member; i++) {
        for (int j = 0; j < a->member[i]->n_state; j++, k++) {
            seed = seed * 1664525u + 1013904223u;
            x[k] = a->member[i]->scale[j] * ((double)seed / 2147483648.0 - 1);
        }
    }
    for (int k = 0; k < WARM_UP; k++) {
        bough_status status = apply(m, m->repeat, x, m->image);
        if (!bough_is_ok(&status)) return status;
        memcpy(x, m->image, (size_t)m->n * sizeof(double));
        divide(m->n, sqrt(dot(a->n_state, x, x)), x);
    }
    choose_weights(m, x);
    for (int k = 0; k < m->n; k++) x[k] *= m->weight[k];
    divide(m->n, sqrt(dot(m->n, x, x)), x);
    return bough_ok();
}

// -- Arnoldi --------------------------------------------------------------------------------------

// Extends the space from m->dimension vectors to `wanted`.
static bough_status extend(map *m, int wanted) {
    int n = m->n;
    for (int j = m->dimension; j < wanted && !m->complete; j++) {
        double *next = m->basis + (size_t)(j + 1) * (size_t)n;
        double *column = m->hessenberg + (size_t)j * DIMENSION;
        bough_status status = apply_weighted(m, m->repeat, next - n, next);
        if (!bough_is_ok(&status)) return status;
        double before = sqrt(dot(n, next, next));
        for (int pass = 0; pass < 2; pass++) {
            for (int i = 0; i <= j; i++) {
                const double *q = m->basis + (size_t)i * (size_t)n;
                double h = dot(n, q, next);
                column[i] += h;
                add(n, -h, q, next);
            }
        }
        m->dimension = j + 1;
        column[j + 1] = sqrt(dot(n, next, next));
        m->complete = m->dimension == n || !(column[j + 1] > 1e-12 * before);
        if (m->complete) {
            column[j + 1] = 0;
        } else {
            divide(n, column[j + 1], next);
        }
    }
    return bough_ok();
}

// Eigenvalues and vectors of the Hessenberg matrix of the dimension reached.
static bough_status solve_small(map *m) {
    int n = m->dimension;
    for (int j = 0; j < n; j++) {
        memcpy(m->packed + j * n, m->hessenberg + (size_t)j * DIMENSION, (size_t)n * sizeof(double));
    }
    if (bough_dense_eigen(n, m->packed, m->value, m->vector, m->work)) return bough_ok();
    return bough_fail(BOUGH_FAILED, "the eigenvalues of the coupling were not found");
}

// x (n) = basis · column of the eigenvectors
static void ritz_vector(const map *m, int column, double *x) {
    memset(x, 0, (size_t)m->n * sizeof(double));
    for (int j = 0; j < m->dimension; j++) {
        add(m->n, m->vector[column * m->dimension + j], m->basis + (size_t)j * (size_t)m->n, x);
    }
}

// -- verdict --------------------------------------------------------------------------------------

// An eigenvalue of the Hessenberg matrix: first column of its vector and how well it is found.
typedef struct ritz {
    int column;
    bool pair;
    double modulus, residual;
} ritz;

// Distance to the nearest eigenvalue of the space that was smaller.
static double moved(const map *m, const ritz *r) {
    double nearest = HUGE_VAL;
    for (int k = 0; k < m->before; k++) {
        double real = m->value[r->column] - m->earlier[k];
        double imaginary = m->value[m->dimension + r->column] - m->earlier[m->before + k];
        nearest = fmin(nearest, hypot(real, imaginary));
    }
    return m->complete ? 0 : nearest;
}

// What its residual leaves open; unfinished values of the many slow modes may exceed 1 by a little.
static double margin(const ritz *r) {
    return 0.3 * fabs(r->modulus - 1);
}

static bool likely(const ritz *r) {
    return r->residual < margin(r) && r->residual < 0.05;
}

// Known well enough to say on which side of 1 it lies. Where modes are nearly parallel a small
// residual is not enough: the value must have been there before the last vectors came.
static bool certain(const map *m, const ritz *r) {
    return likely(r) && moved(m, r) < margin(r);
}

static ritz ritz_value(const map *m, int column) {
    int n = m->dimension;
    const double *last = m->vector + column * n + n - 1;
    ritz r = {.column = column, .pair = m->value[n + column] != 0};
    r.modulus = hypot(m->value[column], m->value[n + column]);
    double part = r.pair ? hypot(last[0], last[n]) : fabs(last[0]);
    r.residual = m->hessenberg[(n - 1) * DIMENSION + n] * part;
    return r;
}

// The member of the vector's largest part, of those that hang on an interface.
static int largest_body(const map *m, const double *real, const double *imaginary) {
    const bough_assembly *a = &m->assembly;
    double largest = -1;
    int body = 0;
    for (int k = 0; k < a->n_interface; k++) {
        int i = a->interface[k].body, first = a->state_offset[i], count = a->member[i]->n_state;
        double part = dot(count, real + first, real + first) +
                      dot(count, imaginary + first, imaginary + first);
        if (part <= 1.01 * largest) continue; // of equals the first
        largest = part;
        body = i;
    }
    return body;
}

// One macro step of the vector x: λ = xᴴ M x / xᴴ x, whose angle is not folded over.
static bough_status refine(map *m, const ritz *r, bough_stability *result) {
    int n = m->n;
    double *real = m->pair, *imaginary = m->pair + n;
    memset(imaginary, 0, (size_t)n * sizeof(double));
    ritz_vector(m, r->column, real);
    if (r->pair) ritz_vector(m, r->column + 1, imaginary);
    bough_status status = apply_weighted(m, 1, real, m->image);
    if (!bough_is_ok(&status)) return status;
    double a = dot(n, real, m->image), b = -dot(n, imaginary, m->image);
    if (r->pair) status = apply_weighted(m, 1, imaginary, m->image);
    if (!bough_is_ok(&status)) return status;
    if (r->pair) {
        a += dot(n, imaginary, m->image);
        b += dot(n, real, m->image);
    }
    double time = m->repeat * m->macro_step;
    result->growth = log(r->modulus) / time;
    result->frequency = fabs(atan2(b, a)) / (2 * BOUGH_PI * m->macro_step);
    result->body = largest_body(m, real, imaginary);
    return bough_ok();
}

static int descending(const void *a, const void *b) {
    double x = ((const ritz *)a)->modulus, y = ((const ritz *)b)->modulus;
    return (x < y) - (x > y);
}

// The fastest growing oscillation among the eigenvalues. What grows by more than it turns is no
// oscillation: a free rotation, whose double eigenvalue 1 splits by rounding, or a fall. But what
// changes sign from step to step is the coupling's, however fast it grows.
static bough_status choose(map *m, bough_stability *result) {
    ritz found[DIMENSION];
    int count = 0;
    for (int k = 0; k < m->dimension; k++) {
        ritz r = ritz_value(m, k);
        if (r.pair) k++;
        if (likely(&r)) found[count++] = r;
    }
    qsort(found, (size_t)count, sizeof *found, descending);
    double decay = -1 / (m->repeat * m->macro_step);
    *result = (bough_stability){.growth = decay, .suspected = decay};
    for (int k = 0; k < count; k++) {
        bough_stability candidate;
        bough_status status = refine(m, &found[k], &candidate);
        if (!bough_is_ok(&status)) return status;
        bool alternates = candidate.frequency * m->macro_step > 0.25; // no mechanics do within a step
        bool turns = 2 * BOUGH_PI * candidate.frequency > candidate.growth;
        candidate.rising = result->rising;
        if (!turns && !alternates) {
            result->rising = fmax(result->rising, candidate.growth);
            continue;
        }
        candidate.suspected = fmax(result->suspected, candidate.growth);
        result->suspected = candidate.suspected;
        if (!certain(m, &found[k])) continue;
        *result = candidate;
        return status;
    }
    return bough_ok();
}

// Whether the largest eigenvalue so far grows fast, turns and is exact: the others do not matter.
static bool decided(const map *m) {
    ritz top = {0};
    for (int k = 0; k < m->dimension; k++) {
        ritz r = ritz_value(m, k);
        if (r.modulus > top.modulus) top = r;
        if (r.pair) k++;
    }
    bool turns = top.pair || m->value[top.column] < 0;
    return turns && top.modulus > 1.2 && top.residual < exact * top.modulus && certain(m, &top);
}

static bough_status judge(map *m, const bough_assembly *a, const bough_scheme_options *options,
                          bough_stability *result) {
    bough_status status = build(m, a, options);
    if (bough_is_ok(&status)) status = start(m);
    for (int wanted = 2; bough_is_ok(&status) && wanted <= DIMENSION; wanted += 2) {
        m->before = m->dimension;
        memcpy(m->earlier, m->value, 2 * (size_t)m->before * sizeof(double));
        status = extend(m, wanted);
        if (bough_is_ok(&status)) status = solve_small(m);
        if (bough_is_ok(&status) && (m->complete || decided(m))) break;
    }
    return bough_is_ok(&status) ? choose(m, result) : status;
}

bough_status bough_stability_judge(const bough_assembly *a, const bough_scheme_options *options,
                                   double macro_step, bough_stability *result) {
    return bough_stability_judge_by(a, options, macro_step, fmin(macro_step / 4, sub_step), result);
}

bough_status bough_stability_judge_by(const bough_assembly *a, const bough_scheme_options *options,
                                      double macro_step, double longest, bough_stability *result) {
    const bough_scheme *scheme = bough_scheme_find(options->name);
    if (!scheme || scheme->one_system) {
        return bough_fail(BOUGH_INVALID, "scheme %s has no coupling to judge", options->name);
    }
    map m = {.arena = bough_arena_create(),
             .macro_step = macro_step,
             .sub_step = fmin(macro_step, longest)};
    if (!m.arena) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    bough_status status = judge(&m, a, options, result);
    bough_arena_destroy(m.arena);
    return status;
}

// -- advice ---------------------------------------------------------------------------------------

bool bough_stability_grows(const bough_stability *s) {
    return s->growth > threshold;
}

// Judges an alternative; true when it holds. The least growth seen is kept.
static bool holds(const bough_assembly *a, const bough_scheme_options *options, double macro_step,
                  double *least) {
    bough_stability other = {0};
    bough_status status = bough_stability_judge(a, options, macro_step, &other);
    if (!bough_is_ok(&status)) return false;
    *least = fmin(*least, other.growth);
    return other.suspected <= threshold;
}

bough_status bough_stability_advise(const bough_assembly *a, const bough_scheme_options *options,
                                    double macro_step, bough_stability_advice *advice) {
    // divisors, so that periods which are multiples of the macro step stay so; stability need not
    // be monotone in the macro step, so none is skipped
    static const int divisor[] = {2, 3, 4, 5, 6, 8, 10, 12, 16};
    *advice = (bough_stability_advice){0};
    bough_status status = bough_stability_judge(a, options, macro_step, &advice->now);
    if (!bough_is_ok(&status) || !bough_stability_grows(&advice->now)) return status;
    bough_scheme_options instead = *options;
    instead.name = bough_scheme_find(options->name)->instead;
    instead.theta = 0;
    double least = advice->now.growth;
    advice->instead_holds = instead.name && holds(a, &instead, macro_step, &least);
    for (size_t k = 0; k < sizeof divisor / sizeof *divisor && advice->macro_step == 0; k++) {
        double smaller = macro_step / divisor[k];
        if (holds(a, options, smaller, &least)) advice->macro_step = smaller;
    }
    // what grows as fast whatever the coupling does is the mechanics' own
    advice->unstable = advice->now.growth > 2 * least;
    return status;
}

void bough_stability_describe(const bough_assembly *a, const bough_stability_advice *advice,
                              const bough_scheme_options *options, double macro_step, char *text) {
    text[0] = 0;
    if (!advice->unstable) return;
    int length = snprintf(text, BOUGH_VERDICT,
                          "scheme %s at a macro step of %.6g s is unstable without the damping of "
                          "outer loads: %.3g Hz in %.40s grow by %.3g per second",
                          options->name, macro_step, advice->now.frequency,
                          a->member[advice->now.body]->name, advice->now.growth);
    if (advice->macro_step > 0) {
        length += snprintf(text + length, (size_t)(BOUGH_VERDICT - length),
                           "; macro_step: %.4g s holds", advice->macro_step);
    }
    if (advice->instead_holds) {
        snprintf(text + length, (size_t)(BOUGH_VERDICT - length), "; scheme: %s holds",
                 bough_scheme_find(options->name)->instead);
    }
}
