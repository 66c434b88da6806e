// The formulas of a step of the Rosenbrock method (core/solve/integrator_rosenbrock.c) over ranges of states,
// for a caller that evaluates and solves a system of several members itself.
#pragma once

#include "core/base/level.h"
#include "core/solve/integrator.h"

enum { BOUGH_ROSENBROCK_STAGES = 4 };

// The step in progress. A bough_rosenbrock_find fills u, drift and at.
typedef struct bough_rosenbrock_step {
    bough_level level;                  // of the kernels
    double t, h, gamma;                 // its start, its length, and γh [s]
    const double *y;                    // (n) at t
    bool drifts;                        // ∂f/∂t is to be found: from f at t + h, in `drift`, and f at t
    double *drift;                      // (n) ∂f/∂t
    double *at;                         // (n) argument of f from the second stage on, then y₁
    double *u[BOUGH_ROSENBROCK_STAGES]; // (n) f in the stage's argument, then its right side, then u_i
    const double *weight;               // (n) 1/tolerance
} bough_rosenbrock_step;

// Computes the stages u_i, ∂f/∂t and y₁ with the current factors of I − γhJ. Returns the sum of squares of
// the error relative to the tolerance, NaN where f has no value.
typedef double (*bough_rosenbrock_find)(void *self, bough_rosenbrock_step *step);

// Lets `find` compute the steps of this integrator, which is of the kind BOUGH_ROSENBROCK.
void bough_rosenbrock_find_by(bough_integrator *integrator, bough_rosenbrock_find find, void *self);

// The time at which stage i evaluates f.
double bough_rosenbrock_time(const bough_rosenbrock_step *step, int i);

// All for states first … last − 1. The argument of f in stage i > 0, from the stages before:
void bough_rosenbrock_argument(bough_rosenbrock_step *step, int i, int first, int last);

// The right side of stage i, in place of f in u_i:
void bough_rosenbrock_right_side(bough_rosenbrock_step *step, int i, int first, int last);

// y₁ from all stages; returns the error's sum of squares.
double bough_rosenbrock_end(bough_rosenbrock_step *step, int first, int last);

// For all n states: the error of y₁ by the embedded method, and y₁ − y.
void bough_rosenbrock_error(const bough_rosenbrock_step *step, int n, double *error);
void bough_rosenbrock_increment(const bough_rosenbrock_step *step, int n, double *increment);

BOUGH_DECLARE_LEVELS(bough_rosenbrock_argument);
BOUGH_DECLARE_LEVELS(bough_rosenbrock_right_side);
BOUGH_DECLARE_LEVELS(bough_rosenbrock_end);
BOUGH_DECLARE_LEVELS(bough_rosenbrock_error);
BOUGH_DECLARE_LEVELS(bough_rosenbrock_increment);

#define bough_rosenbrock_argument(step, ...)                                                                 \
    BOUGH_OF_LEVEL(bough_rosenbrock_argument, (step)->level)(step, __VA_ARGS__)
#define bough_rosenbrock_right_side(step, ...)                                                               \
    BOUGH_OF_LEVEL(bough_rosenbrock_right_side, (step)->level)(step, __VA_ARGS__)
#define bough_rosenbrock_end(step, ...) BOUGH_OF_LEVEL(bough_rosenbrock_end, (step)->level)(step, __VA_ARGS__)
#define bough_rosenbrock_error(step, ...)                                                                    \
    BOUGH_OF_LEVEL(bough_rosenbrock_error, (step)->level)(step, __VA_ARGS__)
#define bough_rosenbrock_increment(step, ...)                                                                \
    BOUGH_OF_LEVEL(bough_rosenbrock_increment, (step)->level)(step, __VA_ARGS__)
