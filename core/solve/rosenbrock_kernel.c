// The formulas of a step of the Rosenbrock method. theory (52, 53)
#include "core/solve/rosenbrock.h"

#define AT(name) BOUGH_AT_LEVEL(bough_rosenbrock_##name)

enum { STAGES = BOUGH_ROSENBROCK_STAGES };

// The published coefficients Γ, A, b, b̂ in the form that needs no product with J: row sums of Γ, a = A Γ⁻¹,
// c = E − γ Γ⁻¹, m = bᵀ Γ⁻¹, e = (b − b̂)ᵀ Γ⁻¹. The last row of a is m without its last entry, 1.
static const double slope[STAGES] = {0.4358665215084590, -0.4358665215084590, -0.4133333762338865, 0};
static const double a[STAGES][3] = {{0, 0, 0},
                                    {2, 0, 0},
                                    {1.4192173174557647, -0.2592322116729697, 0},
                                    {4.1847604823191600, -0.2851920173554959, 2.2942803602790420}};
static const double c[STAGES][3] = {{0, 0, 0},
                                    {-2, 0, 0},
                                    {-1.8239969947745136, 0.1243056525667201, 0},
                                    {-2.7756761163024684, -2.9619836625547890, 1.2509798950560604}};
static const double e[STAGES] = {0.2777499476479672, -1.4032398951759988, 1.7726301276675507, 0.5};

// Σ_j weight_j u_j over the stages before stage i; the compiler moves the tests of i out of loops.
BOUGH_INLINE double stages_before(const bough_rosenbrock_step *s, int i, const double weight[3], int k) {
    double sum = weight[0] * s->u[0][k];
    if (i > 1) sum += weight[1] * s->u[1][k];
    if (i > 2) sum += weight[2] * s->u[2][k];
    return sum;
}

// at = y + Σ_j a_ij u_j
BOUGH_INLINE void set_argument(bough_rosenbrock_step *s, int i, int first, int last) {
    double *restrict at = s->at;
    const double *restrict y = s->y;
#pragma omp simd
    for (int k = first; k < last; k++) at[k] = y[k] + stages_before(s, i, a[i], k);
}

// Inlined with the stage known, each has a loop of its own.
void AT(argument)(bough_rosenbrock_step *s, int i, int first, int last) {
    switch (i) {
    case 1: set_argument(s, 1, first, last); break;
    case 2: set_argument(s, 2, first, last); break;
    default: set_argument(s, 3, first, last);
    }
}

// u_0 = γh [f + γ₁h ∂f/∂t], f standing in u_0
static void set_first_right_side(bough_rosenbrock_step *s, int first, int last) {
    double *restrict u = s->u[0], *restrict drift = s->drift;
    double h = s->h, f = s->gamma, d = slope[0] * h;
    if (s->drifts) { // it holds f at the step's end
#pragma omp simd
        for (int k = first; k < last; k++) drift[k] = (drift[k] - u[k]) / h;
    }
#pragma omp simd
    for (int k = first; k < last; k++) u[k] = f * (u[k] + d * drift[k]);
}

// u_i = γh [f + γ_i h ∂f/∂t] + Σ_j c_ij u_j, f standing in u_i
BOUGH_INLINE void set_right_side(bough_rosenbrock_step *s, int i, int first, int last) {
    double *restrict u = s->u[i];
    const double *restrict drift = s->drift;
    double f = s->gamma, d = s->gamma * slope[i] * s->h;
#pragma omp simd
    for (int k = first; k < last; k++) u[k] = f * u[k] + d * drift[k] + stages_before(s, i, c[i], k);
}

void AT(right_side)(bough_rosenbrock_step *s, int i, int first, int last) {
    switch (i) {
    case 0: set_first_right_side(s, first, last); break;
    case 1: set_right_side(s, 1, first, last); break;
    case 2: set_right_side(s, 2, first, last); break;
    default: set_right_side(s, 3, first, last);
    }
}

// y₁ into `at`, whose last argument lacks the last stage only.
double AT(end)(bough_rosenbrock_step *s, int first, int last) {
    double *restrict at = s->at;
    const double *restrict u0 = s->u[0], *restrict u1 = s->u[1], *restrict u2 = s->u[2];
    const double *restrict u3 = s->u[3], *restrict weight = s->weight;
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int k = first; k < last; k++) {
        at[k] += u3[k];
        double error = weight[k] * (e[0] * u0[k] + e[1] * u1[k] + e[2] * u2[k] + e[3] * u3[k]);
        sum += error * error;
    }
    return sum;
}

void AT(error)(const bough_rosenbrock_step *s, int n, double *restrict error) {
    const double *restrict u0 = s->u[0], *restrict u1 = s->u[1], *restrict u2 = s->u[2];
    const double *restrict u3 = s->u[3];
#pragma omp simd
    for (int k = 0; k < n; k++) error[k] = e[0] * u0[k] + e[1] * u1[k] + e[2] * u2[k] + e[3] * u3[k];
}

void AT(increment)(const bough_rosenbrock_step *s, int n, double *restrict x) {
#pragma omp simd
    for (int k = 0; k < n; k++) x[k] = stages_before(s, 3, a[3], k) + s->u[3][k];
}
