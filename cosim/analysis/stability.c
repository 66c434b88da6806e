#include "cosim/analysis/stability.h"

#include "core/base/arnoldi.h"
#include "cosim/scheme.h"

enum { DIMENSION = 48, WARM_UP = 2, MOST_REPEATED = 24 };
static const double span = 0.06;      // this time passes per Arnoldi vector [s]
static const double sub_step = 5e-3;  // of the linear members at most [s]; a quarter of a macro
                                      // step, so that their own damping does not hide oscillations
static const double exact = 1e-4;     // relative to an eigenvalue
static const double threshold = 1e-2; // growth below is rounding or drift [1/s]

// The map z → z after `repeat` macro steps; z is what a step depends on, see bough_scheme_load.
typedef struct map {
    bough_arena *arena;
    const bough_assembly *real;
    const bough_scheme_options *options;
    bough_stability *result;
    bough_assembly assembly; // of the linear members
    bough_member *linear;    // (n_member)
    bough_coupling *coupling;
    double macro_step, sub_step;
    int repeat;
    int n; // n_state + 3 n_input
    bough_arnoldi arnoldi;
    int before;      // vectors done last time
    double *earlier; // (2 × before) eigenvalues then
    double *pair;    // (2 × n) real and imaginary part of a vector
} map;

// -- building -------------------------------------------------------------------------------------

// The assembly with linear members in place of its own.
static void build_linear_members(map *m, const bough_assembly *a, const double *input) {
    m->assembly = *a;
    m->linear = bough_arena_take(m->arena, (size_t)a->n_member * sizeof *m->linear);
    m->assembly.member = bough_arena_take(m->arena, (size_t)a->n_member * sizeof(void *));
    for (int i = 0; i < a->n_member; i++) {
        bough_linear_member_create(m->arena, a->member[i], input + a->input_offset[i], m->sub_step,
                                   &m->linear[i]);
        m->assembly.member[i] = &m->linear[i];
    }
}

static void take(map *m) {
    m->earlier = bough_arena_doubles(m->arena, 2 * (size_t)DIMENSION);
    m->pair = bough_arena_doubles(m->arena, 2 * (size_t)m->n);
    bough_arnoldi_create(m->arena, m->n, DIMENSION + 1, 1, &m->arnoldi);
}

// The analysis uses the converged solution of the iterated scheme, because the residual of its tolerance
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
    bough_assembly_outputs(a, a->member[0]->time, output, input);
    build_linear_members(m, a, input);
    // the scheme on the linear members
    BOUGH_TRY(bough_scheme_couple(m->arena, &m->assembly, &judged, NULL, &m->coupling));
    bough_coupling *c = m->coupling;
    m->n = bough_scheme_n_memory(c);
    m->repeat = (int)fmin(ceil(span / m->macro_step - 1e-6), MOST_REPEATED);
    c->t1 = c->t0 + m->macro_step;
    take(m);
    return c->scheme->prepare ? c->scheme->prepare(c) : bough_ok();
}

// -- the map --------------------------------------------------------------------------------------

// theory (69): image = Φⁿ z, z after `count` macro steps
static bough_status apply(map *m, int count, const double *z, double *image) {
    bough_coupling *c = m->coupling;
    bough_status status = bough_ok();
    bough_scheme_load(c, m->macro_step, z);
    for (int k = 0; k < count && bough_is_ok(&status); k++) {
        c->t0 = c->t1;
        c->t1 = (k + 1) * m->macro_step;
        status = bough_scheme_step(c);
    }
    bough_scheme_store(c, image);
    return status;
}

// One vector at a time.
static bough_status apply_repeated(void *self, __attribute__((unused)) int n, const double *z,
                                   double *image) {
    map *m = self;
    return apply(m, m->repeat, z, image);
}

// Squares of the weights that make components comparable. The inputs of a member together weigh as much as
// all states.
static void choose_weights(map *m, const double *z) {
    const bough_assembly *a = &m->assembly;
    double *weight = m->arnoldi.weight, sum = 0;
    // states in units of their scales
    bough_assembly_scales(a, weight);
    for (int k = 0; k < a->n_state; k++) {
        weight[k] = 1 / (weight[k] * weight[k]);
        sum += z[k] * z[k] * weight[k];
    }
    for (int i = 0; i < a->n_member; i++) {
        int first = a->input_offset[i], last = a->input_offset[i + 1];
        double largest = 0;
        for (int j = first; j < last; j++) {
            largest = fmax(largest, fabs(z[a->n_state + 2 * a->n_input + j]));
        }
        double own = largest > 0 ? sum / a->n_input / (largest * largest) : 1;
        for (int j = first; j < last; j++) {
            for (int p = 0; p < 3; p++) weight[a->n_state + p * a->n_input + j] = own;
            if (m->coupling->scheme->impulse == NULL) continue;
            weight[a->n_state + 3 * a->n_input + j] = own / (m->macro_step * m->macro_step);
        }
    }
}

// A start that contains every mode but the stiff ones: fixed pseudo-random numbers after a few macro steps.
static bough_status start(map *m) {
    const bough_assembly *a = &m->assembly;
    double *x = m->pair, *image = m->pair + m->n;
    unsigned seed = 1;
    bough_assembly_scales(a, x);
    for (int k = 0; k < a->n_state; k++) {
        seed = seed * 1664525u + 1013904223u;
        x[k] *= (double)seed / 2147483648.0 - 1;
    }
    for (int k = 0; k < WARM_UP; k++) {
        BOUGH_TRY(apply(m, m->repeat, x, image));
        double length = sqrt(bough_scalar_product(a->n_state, image, image));
        for (int i = 0; i < m->n; i++) x[i] = image[i] / length;
    }
    m->arnoldi.apply = apply_repeated;
    m->arnoldi.self = m;
    choose_weights(m, x);
    bough_arnoldi_append(&m->arnoldi, x);
    return bough_ok();
}

// -- verdict --------------------------------------------------------------------------------------

// An eigenvalue of the Hessenberg matrix: first column of its vector, and its residual.
typedef struct ritz {
    int column;
    bool pair;
    double modulus, residual;
} ritz;

// Distance to the nearest eigenvalue of the space that was smaller.
static double moved(const map *m, const ritz *r) {
    const bough_arnoldi *a = &m->arnoldi;
    double nearest = HUGE_VAL;
    for (int k = 0; k < m->before; k++) {
        double real = a->value[r->column] - m->earlier[k];
        double imaginary = a->value[a->done + r->column] - m->earlier[m->before + k];
        nearest = fmin(nearest, hypot(real, imaginary));
    }
    return a->done == a->count ? 0 : nearest;
}

// Its uncertainty; values of the many slow modes that have not converged may exceed 1 by a little.
static double margin(const ritz *r) { return 0.3 * fabs(r->modulus - 1); }

static bool likely(const ritz *r) { return r->residual < margin(r) && r->residual < 0.05; }

// Accurate enough to decide whether it is above 1. For nearly parallel modes a small residual is not
// enough: the value must also have existed before the last vectors were added.
static bool certain(const map *m, const ritz *r) { return likely(r) && moved(m, r) < margin(r); }

static ritz ritz_value(const map *m, int column) {
    const bough_arnoldi *a = &m->arnoldi;
    return (ritz){.column = column,
                  .pair = a->value[a->done + column] != 0,
                  .modulus = bough_arnoldi_modulus(a, column),
                  .residual = bough_arnoldi_residual(a, column)};
}

// The member with the largest part of the vector, of those with an interface.
static int largest_body(const map *m, const double *real, const double *imaginary) {
    const bough_assembly *a = &m->assembly;
    double largest = -1;
    int body = 0;
    for (int k = 0; k < a->n_pair; k++) {
        int i = a->pair[k].body, first = a->state_offset[i], count = a->member[i]->system.n_state;
        const double *weight = m->arnoldi.weight;
        double part = 0;
        for (int j = first; j < first + count; j++) {
            part += weight[j] * (real[j] * real[j] + imaginary[j] * imaginary[j]);
        }
        if (part <= 1.01 * largest) continue; // of equals the first
        largest = part;
        body = i;
    }
    return body;
}

// One macro step of the vector x: λ = xᴴ M x / xᴴ x, whose angle is that of one step.
static bough_status refine(map *m, const ritz *r, bough_stability *result) {
    const bough_arnoldi *basis = &m->arnoldi;
    double *real = m->pair, *imaginary = m->pair + m->n, *image = m->arnoldi.image;
    memset(m->pair, 0, 2 * (size_t)m->n * sizeof(double));
    bough_arnoldi_combine(basis, r->pair ? 2 : 1, basis->vector + r->column * basis->done, m->pair);
    BOUGH_TRY(apply(m, 1, real, image));
    double a = bough_arnoldi_product(basis, real, image);
    double b = -bough_arnoldi_product(basis, imaginary, image);
    if (r->pair) BOUGH_TRY(apply(m, 1, imaginary, image));
    if (r->pair) {
        a += bough_arnoldi_product(basis, imaginary, image);
        b += bough_arnoldi_product(basis, real, image);
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

// The fastest growing oscillation among the eigenvalues. A mode that grows faster than it oscillates is not
// an oscillation: a free rotation, whose double eigenvalue 1 splits by rounding, or a fall. A mode that
// changes its sign from step to step is due to the coupling, however fast it grows.
static bough_status choose(map *m, bough_stability *result) {
    ritz found[DIMENSION];
    int count = 0;
    for (int k = 0; k < m->arnoldi.done; k++) {
        ritz r = ritz_value(m, k);
        if (r.pair) k++;
        if (likely(&r)) found[count++] = r;
    }
    qsort(found, (size_t)count, sizeof *found, descending);
    double decay = -1 / (m->repeat * m->macro_step);
    *result = (bough_stability){.growth = decay, .suspected = decay};
    for (int k = 0; k < count; k++) {
        bough_stability candidate;
        BOUGH_TRY(refine(m, &found[k], &candidate));
        bool alternates = candidate.frequency * m->macro_step > 0.25; // the mechanics are slower
        bool oscillates = 2 * BOUGH_PI * candidate.frequency > candidate.growth;
        candidate.rising = result->rising;
        if (!oscillates && !alternates) {
            result->rising = fmax(result->rising, candidate.growth);
            continue;
        }
        candidate.suspected = fmax(result->suspected, candidate.growth);
        result->suspected = candidate.suspected;
        if (!certain(m, &found[k])) continue;
        *result = candidate;
        break;
    }
    return bough_ok();
}

// Whether the largest eigenvalue so far grows fast, oscillates and is exact: the others do not matter.
static bool decided(const map *m) {
    ritz top = {0};
    for (int k = 0; k < m->arnoldi.done; k++) {
        ritz r = ritz_value(m, k);
        if (r.modulus > top.modulus) top = r;
        if (r.pair) k++;
    }
    bool oscillates = top.pair || m->arnoldi.value[top.column] < 0;
    return oscillates && top.modulus > 1.2 && top.residual < exact * top.modulus && certain(m, &top);
}

static bough_status judge(bough_arena *arena, void *self) {
    map *m = self;
    m->arena = arena;
    bough_status status = build(m, m->real, m->options);
    if (bough_is_ok(&status)) status = start(m);
    // two more vectors at a time, until the largest eigenvalue is known or the space is whole
    for (int wanted = 2; bough_is_ok(&status) && wanted <= DIMENSION; wanted += 2) {
        bough_arnoldi *space = &m->arnoldi;
        m->before = space->done;
        memcpy(m->earlier, space->value, 2 * (size_t)m->before * sizeof(double));
        status = bough_arnoldi_extend(space, wanted);
        if (bough_is_ok(&status) && !bough_arnoldi_project(space)) {
            status = bough_fail(BOUGH_FAILED, "the eigenvalues of the coupling were not found");
        }
        if (bough_is_ok(&status) && (space->done == space->count || decided(m))) break;
    }
    return bough_is_ok(&status) ? choose(m, m->result) : status;
}

bough_status bough_stability_judge(const bough_assembly *a, const bough_scheme_options *options,
                                   double macro_step, bough_stability *result) {
    return bough_stability_judge_by(a, options, macro_step, fmin(macro_step / 4, sub_step), result);
}

bough_status bough_stability_judge_by(const bough_assembly *a, const bough_scheme_options *options,
                                      double macro_step, double longest, bough_stability *result) {
    const bough_scheme *scheme = bough_scheme_find(options->name);
    if (!scheme || scheme->one_system) {
        return bough_fail(BOUGH_INVALID, "scheme %s has no coupling whose stability is in question",
                          options->name);
    }
    if (a->opaque) {
        return bough_fail(BOUGH_INVALID, "the tangents of a foreign simulator are not known");
    }
    map m = {.real = a,
             .options = options,
             .macro_step = macro_step,
             .sub_step = fmin(macro_step, longest),
             .result = result};
    return bough_arena_use(judge, &m);
}

// -- advice ---------------------------------------------------------------------------------------

bool bough_stability_grows(const bough_stability *s) { return s->growth > threshold; }

// Whether an alternative is stable; *least becomes the smallest growth of all tried.
static bool is_stable(const bough_assembly *a, const bough_scheme_options *options, double macro_step,
                      double *least) {
    bough_stability other = {0};
    bough_status status = bough_stability_judge(a, options, macro_step, &other);
    if (!bough_is_ok(&status)) return false;
    *least = fmin(*least, other.growth);
    return other.suspected <= threshold;
}

bough_status bough_stability_advise(const bough_assembly *a, const bough_scheme_options *options,
                                    double macro_step, bough_stability_advice *advice) {
    // divisors, so that periods which are multiples of the macro step stay so, and the step has few decimals
    static const int divisor[] = {2, 4, 5, 8, 10, 16};
    *advice = (bough_stability_advice){0};
    bough_status status = bough_stability_judge(a, options, macro_step, &advice->now);
    if (!bough_is_ok(&status) || !bough_stability_grows(&advice->now)) return status;
    bough_scheme_options instead = *options;
    const bough_scheme *other = bough_scheme_advised();
    instead.name = other->name;
    double least = advice->now.growth;
    bool differs = strcmp(options->name, other->name) != 0;
    if (differs && is_stable(a, &instead, macro_step, &least)) advice->scheme = other->name;
    // the growth of the mechanics
    instead = bough_scheme_damped(options);
    is_stable(a, &instead, macro_step, &least);
    for (size_t k = 0; k < sizeof divisor / sizeof *divisor && advice->macro_step == 0; k++) {
        double smaller = macro_step / divisor[k];
        if (is_stable(a, options, smaller, &least)) advice->macro_step = smaller;
    }
    // growth that is independent of the coupling belongs to the mechanics
    advice->unstable = advice->now.growth > 2 * least;
    return status;
}

void bough_stability_describe(const bough_assembly *a, const bough_stability_advice *advice,
                              const bough_scheme_options *options, double macro_step, char *text) {
    text[0] = 0;
    if (!advice->unstable) return;
    int length = snprintf(
        text, BOUGH_VERDICT,
        "scheme %s at a macro step of %.6g s is unstable without the damping of external loads: vibrations of %.3g Hz in %.40s grow by %.3g per second",
        options->name, macro_step, advice->now.frequency, a->member[advice->now.body]->system.name,
        advice->now.growth);
    if (advice->macro_step > 0) {
        length += snprintf(text + length, (size_t)(BOUGH_VERDICT - length),
                           "; macro_step: %.9g s is stable in this state", advice->macro_step);
    }
    if (advice->scheme) {
        snprintf(text + length, (size_t)(BOUGH_VERDICT - length), "; scheme: %s is stable in this state",
                 advice->scheme);
    }
}
