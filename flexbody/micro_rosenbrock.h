// Micro steps by a linearly implicit Runge–Kutta method, ROS34PW2 (Rang and Angermann 2005): four
// stages of one evaluation and one solution each, no iteration, order 3 with error control, L-stable,
// stiffly accurate. It is a W-method: its order needs no exact tangents, so that one linearisation
// serves many steps.
//
//     (I − γhJ) u_i = γh [ f(t + α_i h, y + Σ_j a_ij u_j) + γ_i h ∂f/∂t ] + Σ_j c_ij u_j,   j < i,
//     y₁ = y + Σ_i m_i u_i,   error ≈ Σ_i e_i u_i
#ifndef BOUGH_FLEXBODY_MICRO_ROSENBROCK_H
#define BOUGH_FLEXBODY_MICRO_ROSENBROCK_H

#include "flexbody/micro.h"

typedef struct bough_micro_rosenbrock_options {
    double step; // longest step [s]; a macro step is divided into equal parts no longer than this
    double rtol; // error of a step: below rtol · scale per state, root mean square
} bough_micro_rosenbrock_options;

typedef struct bough_micro_rosenbrock bough_micro_rosenbrock;

// Builds the integrator in the arena, for errors of each state against scale (n).
bough_status bough_micro_rosenbrock_create(bough_arena *arena, const bough_ode *ode,
                                           const double *scale,
                                           bough_micro_rosenbrock_options options,
                                           bough_micro_rosenbrock **micro);

// As bough_micro_cvode_advance. `restart`: steps and tangents are chosen anew.
bough_status bough_micro_rosenbrock_advance(bough_micro_rosenbrock *micro, double t, double t1,
                                            bool restart, double *y);

// The same from *t, but ends with the first step that reaches `pause`; *t tells where. Going on from
// there to t1 takes the steps of an advance in one go.
bough_status bough_micro_rosenbrock_advance_part(bough_micro_rosenbrock *micro, double *t,
                                                 double pause, double t1, bool restart, double *y);

// (n) sum of the errors of all steps, which a reader sets to zero; NULL without integrator. The
// embedded solution is of order 2, so of its error a twentieth is counted: measured on blades, whose
// stiffness takes both orders down, the run errs by 0.04 to 0.1 of it at steps of 2.5 to 20 ms.
double *bough_micro_rosenbrock_error(const bough_micro_rosenbrock *micro);

void bough_micro_rosenbrock_statistics(const bough_micro_rosenbrock *micro,
                                       bough_statistics *sum);

#endif
