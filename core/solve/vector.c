// SUNDIALS' serial vector with aligned data and, for the operations that steps are made of, loops
// that the compiler vectorises.
#include "core/solve/vector.h"

#include "core/base/base.h"

#include <nvector/nvector_serial.h>

enum { ALIGNMENT = 64 };

static int length(N_Vector v) { return (int)NV_LENGTH_S(v); }

double *bough_vector_data(N_Vector v) { return NV_DATA_S(v); }

// -- construction ----------------------------------------------------------------------------

// NULL, and the vector destroyed, without memory.
static N_Vector with_data(N_Vector v) {
    if (v == NULL) return NULL;
    size_t size = (size_t)bough_padded(length(v)) * sizeof(double);
    double *data = aligned_alloc(ALIGNMENT, size > 0 ? size : ALIGNMENT);
    if (data == NULL) {
        N_VDestroy(v);
        return NULL;
    }
    memset(data, 0, size);
    NV_DATA_S(v) = data;
    NV_OWN_DATA_S(v) = SUNTRUE;
    return v;
}

static N_Vector clone(N_Vector model) { return with_data(N_VCloneEmpty(model)); }

// -- operations --------------------------------------------------------------------------------

// z = a x + b y
static void linear_sum(double a, N_Vector vx, double b, N_Vector vy, N_Vector vz) {
    const double *x = bough_vector_data(vx), *y = bough_vector_data(vy);
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++) z[i] = a * x[i] + b * y[i];
}

static void constant(double c, N_Vector vz) {
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++) z[i] = c;
}

static void scale(double c, N_Vector vx, N_Vector vz) {
    const double *x = bough_vector_data(vx);
    double *z = bough_vector_data(vz);
    int n = length(vz);
#pragma omp simd
    for (int i = 0; i < n; i++) z[i] = c * x[i];
}

// √(Σ (x w)²/n)
static double wrms_norm(N_Vector vx, N_Vector vw) {
    const double *x = bough_vector_data(vx), *w = bough_vector_data(vw);
    double sum = 0;
    int n = length(vx);
#pragma omp simd reduction(+ : sum)
    for (int i = 0; i < n; i++) sum += (x[i] * w[i]) * (x[i] * w[i]);
    return sqrt(sum / n);
}

// z += a x + b y
static void add_two(double a, const double *x, double b, const double *y, double *z, int n) {
#pragma omp simd
    for (int i = 0; i < n; i++) z[i] += a * x[i] + b * y[i];
}

// z = Σ c_k X_k, two at a time; z may be X_0, which is read first.
static int linear_combination(int count, double *c, N_Vector *vx, N_Vector vz) {
    double *z = bough_vector_data(vz);
    int n = length(vz), k = 2;
    if (count == 1) {
        scale(c[0], vx[0], vz);
        return 0;
    }
    // two vectors in each pass over z
    linear_sum(c[0], vx[0], c[1], vx[1], vz);
    for (; k + 1 < count; k += 2)
        add_two(c[k], bough_vector_data(vx[k]), c[k + 1], bough_vector_data(vx[k + 1]), z, n);
    if (k < count) linear_sum(1, vz, c[k], vx[k], vz);
    return 0;
}

N_Vector bough_vector_create(int n, SUNContext context) {
    N_Vector v = with_data(N_VNewEmpty_Serial(n, context));
    if (v == NULL) return NULL;
    // all other operations, which steps do not use, are the serial vector's
    v->ops->nvclone = clone;
    v->ops->nvlinearsum = linear_sum;
    v->ops->nvconst = constant;
    v->ops->nvscale = scale;
    v->ops->nvwrmsnorm = wrms_norm;
    v->ops->nvlinearcombination = linear_combination;
    return v;
}

bool bough_vector_room(int n) {
    enum { VECTORS = 40, OBJECTS = 1 << 18 };
    size_t size = VECTORS * (ALIGNMENT + (size_t)bough_padded(n) * sizeof(double)) + OBJECTS;
    void *volatile block = aligned_alloc(ALIGNMENT, size); // else a compiler may leave both calls out
    bool room = block != NULL;
    free(block);
    return room;
}
