// An N_Vector whose operations are plain loops over aligned data. No element takes a branch:
// choices are written as selections, which the compiler turns into masks.
#include "core/vector.h"

#include "core/base.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64 };

typedef struct content {
    int n;
    bool owns;
    double *data;
} content;

static content *of(N_Vector v) { return v->content; }

static int length(N_Vector v) { return of(v)->n; }

double *bough_vector_data(N_Vector v) { return of(v)->data; }

// -- construction ----------------------------------------------------------------------------

static N_Vector_ID id(N_Vector v) {
    (void)v;
    return SUNDIALS_NVEC_CUSTOM;
}

static sunindextype get_length(N_Vector v) { return length(v); }

static void space(N_Vector v, sunindextype *reals, sunindextype *integers) {
    *reals = length(v);
    *integers = 1;
}

static void set_data(double *data, N_Vector v) { of(v)->data = data; }

static void destroy(N_Vector v) {
    if (v == NULL) return;
    if (v->content != NULL && of(v)->owns) free(of(v)->data);
    free(v->content);
    N_VFreeEmpty(v);
}

static bool take_data(N_Vector v) {
    size_t size = (size_t)bough_padded(length(v)) * sizeof(double);
    content *c = of(v);
    c->data = aligned_alloc(ALIGNMENT, size > 0 ? size : ALIGNMENT);
    c->owns = c->data != NULL;
    if (c->owns) memset(c->data, 0, size);
    return c->owns;
}

static N_Vector clone_empty(N_Vector model) {
    N_Vector v = N_VNewEmpty(model->sunctx);
    if (v == NULL) return NULL;
    v->content = calloc(1, sizeof(content));
    if (v->content == NULL || N_VCopyOps(model, v) != 0) {
        destroy(v);
        return NULL;
    }
    of(v)->n = length(model);
    return v;
}

static N_Vector clone(N_Vector model) {
    N_Vector v = clone_empty(model);
    if (v != NULL && !take_data(v)) {
        destroy(v);
        return NULL;
    }
    return v;
}

// -- element by element ----------------------------------------------------------------------

static void linear_sum(double a, N_Vector vx, double b, N_Vector vy, N_Vector vz) {
    const double *x = bough_vector_data(vx), *y = bough_vector_data(vy);
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++)
        z[i] = a * x[i] + b * y[i];
}

static void constant(double c, N_Vector vz) {
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++)
        z[i] = c;
}

static void product(N_Vector vx, N_Vector vy, N_Vector vz) {
    const double *x = bough_vector_data(vx), *y = bough_vector_data(vy);
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++)
        z[i] = x[i] * y[i];
}

static void quotient(N_Vector vx, N_Vector vy, N_Vector vz) {
    const double *x = bough_vector_data(vx), *y = bough_vector_data(vy);
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++)
        z[i] = x[i] / y[i];
}

static void scale(double c, N_Vector vx, N_Vector vz) {
    const double *x = bough_vector_data(vx);
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++)
        z[i] = c * x[i];
}

static void absolute(N_Vector vx, N_Vector vz) {
    const double *x = bough_vector_data(vx);
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++)
        z[i] = fabs(x[i]);
}

static void inverse(N_Vector vx, N_Vector vz) {
    const double *x = bough_vector_data(vx);
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++)
        z[i] = 1 / x[i];
}

static void add_constant(N_Vector vx, double b, N_Vector vz) {
    const double *x = bough_vector_data(vx);
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++)
        z[i] = x[i] + b;
}

static void compare(double c, N_Vector vx, N_Vector vz) {
    const double *x = bough_vector_data(vx);
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++)
        z[i] = fabs(x[i]) >= c ? 1.0 : 0.0;
}

// -- reductions ------------------------------------------------------------------------------

static double dot(N_Vector vx, N_Vector vy) {
    const double *x = bough_vector_data(vx), *y = bough_vector_data(vy);
    double sum = 0;
    int n = length(vx);
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < n; i++)
        sum += x[i] * y[i];
    return sum;
}

static double max_norm(N_Vector vx) {
    const double *x = bough_vector_data(vx);
    double most = 0;
    int n = length(vx);
#pragma omp simd reduction(max : most)
    for (int i = 0; i < n; i++)
        most = fabs(x[i]) > most ? fabs(x[i]) : most;
    return most;
}

static double least(N_Vector vx) {
    const double *x = bough_vector_data(vx);
    double low = DBL_MAX;
    int n = length(vx);
#pragma omp simd reduction(min : low)
    for (int i = 0; i < n; i++)
        low = x[i] < low ? x[i] : low;
    return low;
}

static double l1_norm(N_Vector vx) {
    const double *x = bough_vector_data(vx);
    double sum = 0;
    int n = length(vx);
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < n; i++)
        sum += fabs(x[i]);
    return sum;
}

static double weighted_squares(N_Vector vx, N_Vector vw) {
    const double *x = bough_vector_data(vx), *w = bough_vector_data(vw);
    double sum = 0;
    int n = length(vx);
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < n; i++)
        sum += (x[i] * w[i]) * (x[i] * w[i]);
    return sum;
}

static double wrms_norm(N_Vector vx, N_Vector vw) {
    return sqrt(weighted_squares(vx, vw) / length(vx));
}

static double wl2_norm(N_Vector vx, N_Vector vw) { return sqrt(weighted_squares(vx, vw)); }

static double wrms_norm_mask(N_Vector vx, N_Vector vw, N_Vector vm) {
    const double *x = bough_vector_data(vx), *w = bough_vector_data(vw);
    const double *m = bough_vector_data(vm);
    double sum = 0;
    int n = length(vx);
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < n; i++) {
        double term = (x[i] * w[i]) * (x[i] * w[i]);
        sum += m[i] > 0 ? term : 0;
    }
    return sqrt(sum / n);
}

// z = 1/x where x is not zero; true when it is nowhere zero. Elsewhere z keeps its value.
static sunbooleantype invert_test(N_Vector vx, N_Vector vz) {
    const double *x = bough_vector_data(vx);
    double *z = bough_vector_data(vz);
    int n = length(vz), zeros = 0;
#pragma omp simd reduction(+ : zeros)
    for (int i = 0; i < n; i++) {
        int is_zero = x[i] == 0;
        z[i] = is_zero ? z[i] : 1 / x[i];
        zeros += is_zero;
    }
    return zeros == 0 ? SUNTRUE : SUNFALSE;
}

// m = 1 where x breaks its constraint c (±2 strict sign, ±1 sign or zero, 0 free); true if nowhere.
static sunbooleantype constraint_mask(N_Vector vc, N_Vector vx, N_Vector vm) {
    const double *c = bough_vector_data(vc), *x = bough_vector_data(vx);
    double *m = bough_vector_data(vm), broken = 0;
    int n = length(vm);
#pragma omp simd reduction(+ : broken)
    for (int i = 0; i < n; i++) {
        double signed_x = x[i] * c[i], kind = fabs(c[i]);
        int strict = (kind > 1.5) & (signed_x <= 0), weak = (kind > 0.5) & (signed_x < 0);
        m[i] = strict | weak ? 1.0 : 0.0;
        broken += m[i];
    }
    return broken == 0 ? SUNTRUE : SUNFALSE;
}

// The least quotient with a denominator that is not zero
static double min_quotient(N_Vector vx, N_Vector vy) {
    const double *x = bough_vector_data(vx), *y = bough_vector_data(vy);
    double low = DBL_MAX;
    int n = length(vx);
#pragma omp simd reduction(min : low)
    for (int i = 0; i < n; i++) {
        double q = y[i] == 0 ? DBL_MAX : x[i] / y[i];
        low = q < low ? q : low;
    }
    return low;
}

// -- several vectors at once: each is read once ------------------------------------------------

// z += a x + b y
static void add_two(double a, const double *x, double b, const double *y, double *z, int n) {
#pragma omp simd
    for (int i = 0; i < n; i++)
        z[i] += a * x[i] + b * y[i];
}

// z = Σ c_k X_k, two at a time; z may be X_0, which is read first.
static int linear_combination(int count, double *c, N_Vector *vx, N_Vector vz) {
    double *z = bough_vector_data(vz);
    int n = length(vz), k = 2;
    if (count == 1) {
        scale(c[0], vx[0], vz);
        return 0;
    }
    linear_sum(c[0], vx[0], c[1], vx[1], vz);
    for (; k + 1 < count; k += 2)
        add_two(c[k], bough_vector_data(vx[k]), c[k + 1], bough_vector_data(vx[k + 1]), z, n);
    if (k < count) linear_sum(1, vz, c[k], vx[k], vz);
    return 0;
}

// Z_k = a_k x + Y_k
static int scale_add_multi(int count, double *a, N_Vector x, N_Vector *y, N_Vector *z) {
    for (int k = 0; k < count; k++)
        linear_sum(a[k], x, 1, y[k], z[k]);
    return 0;
}

static int dot_multi(int count, N_Vector x, N_Vector *y, double *dots) {
    for (int k = 0; k < count; k++)
        dots[k] = dot(x, y[k]);
    return 0;
}

static int linear_sum_array(int count, double a, N_Vector *x, double b, N_Vector *y, N_Vector *z) {
    for (int k = 0; k < count; k++)
        linear_sum(a, x[k], b, y[k], z[k]);
    return 0;
}

static int scale_array(int count, double *c, N_Vector *x, N_Vector *z) {
    for (int k = 0; k < count; k++)
        scale(c[k], x[k], z[k]);
    return 0;
}

static int constant_array(int count, double c, N_Vector *z) {
    for (int k = 0; k < count; k++)
        constant(c, z[k]);
    return 0;
}

static int wrms_norm_array(int count, N_Vector *x, N_Vector *w, double *norms) {
    for (int k = 0; k < count; k++)
        norms[k] = wrms_norm(x[k], w[k]);
    return 0;
}

static int wrms_norm_mask_array(int count, N_Vector *x, N_Vector *w, N_Vector m, double *norms) {
    for (int k = 0; k < count; k++)
        norms[k] = wrms_norm_mask(x[k], w[k], m);
    return 0;
}

static const struct _generic_N_Vector_Ops operations = {
    .nvgetvectorid = id,
    .nvclone = clone,
    .nvcloneempty = clone_empty,
    .nvdestroy = destroy,
    .nvspace = space,
    .nvgetarraypointer = bough_vector_data,
    .nvsetarraypointer = set_data,
    .nvgetlength = get_length,
    .nvlinearsum = linear_sum,
    .nvconst = constant,
    .nvprod = product,
    .nvdiv = quotient,
    .nvscale = scale,
    .nvabs = absolute,
    .nvinv = inverse,
    .nvaddconst = add_constant,
    .nvdotprod = dot,
    .nvmaxnorm = max_norm,
    .nvwrmsnorm = wrms_norm,
    .nvwrmsnormmask = wrms_norm_mask,
    .nvmin = least,
    .nvwl2norm = wl2_norm,
    .nvl1norm = l1_norm,
    .nvcompare = compare,
    .nvinvtest = invert_test,
    .nvconstrmask = constraint_mask,
    .nvminquotient = min_quotient,
    .nvlinearcombination = linear_combination,
    .nvscaleaddmulti = scale_add_multi,
    .nvdotprodmulti = dot_multi,
    .nvlinearsumvectorarray = linear_sum_array,
    .nvscalevectorarray = scale_array,
    .nvconstvectorarray = constant_array,
    .nvwrmsnormvectorarray = wrms_norm_array,
    .nvwrmsnormmaskvectorarray = wrms_norm_mask_array,
};

N_Vector bough_vector_create(int n, SUNContext context) {
    N_Vector v = N_VNewEmpty(context);
    if (v == NULL) return NULL;
    *v->ops = operations;
    v->content = calloc(1, sizeof(content));
    if (v->content != NULL) of(v)->n = n;
    if (v->content == NULL || !take_data(v)) {
        destroy(v);
        return NULL;
    }
    return v;
}

bool bough_vector_room(int n) {
    enum { VECTORS = 40, OBJECTS = 1 << 18 };
    size_t size = VECTORS * (ALIGNMENT + (size_t)bough_padded(n) * sizeof(double)) + OBJECTS;
    void *volatile block = malloc(size); // else a compiler may leave both calls out
    bool room = block != NULL;
    free(block);
    return room;
}
