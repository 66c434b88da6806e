// Arnoldi's method: an orthonormal basis of the space that a linear operator spans from its starting
// vectors, by Gram–Schmidt done twice, and the eigenvalues of the operator projected on it.
#pragma once

#include "core/base/arena.h"

enum { BOUGH_ARNOLDI_AT_ONCE = 8 }; // most

typedef struct bough_arnoldi {
    int length;               // of a vector
    int capacity;             // most vectors
    int count, done;          // vectors in the basis; those to which the operator was applied. Equal: the
                              // basis holds all there is
    double *basis;            // (capacity × length)
    double *h;                // operator in the basis (capacity × capacity), column j of vector j
    double *weight;           // of the inner product (length)
    int at_once;              // vectors to which the operator is applied together, ≤ BOUGH_ARNOLDI_AT_ONCE
    double *image;            // (at_once × length) scratch
    double *weighted, *along; // (at_once × length), (at_once × capacity) scratch
    // by bough_arnoldi_project: eigenvalues of the first `done` rows and columns of h
    double *value;         // real parts (done), then imaginary parts
    double *vector;        // (done × done) column by column; of a complex pair real, then imaginary part
    double *matrix, *work; // scratch
    // The operator: image = A z, of n ≤ at_once vectors.
    bough_status (*apply)(void *self, int n, const double *z, double *image);
    void *self;
} bough_arnoldi;

// Takes the memory for vectors of that length, the weights all 1.
void bough_arnoldi_create(bough_arena *arena, int length, int capacity, int at_once, bough_arnoldi *a);

// The inner product xᵀ W y, W the weights.
double bough_arnoldi_product(const bough_arnoldi *a, const double *x, const double *y);

// Makes x orthogonal to the basis and appends it at length 1; a vector that depends on the basis is dropped.
void bough_arnoldi_append(bough_arnoldi *a, double *x);

// Applies the operator to vectors of the basis until `target` are done or there are no more.
bough_status bough_arnoldi_extend(bough_arnoldi *a, int target);

// Eigenvalues and vectors of the projected operator. False when they are not found.
bool bough_arnoldi_project(bough_arnoldi *a);

// Modulus of eigenvalue k.
double bough_arnoldi_modulus(const bough_arnoldi *a, int k);

// Length of the part of the operator's image of an eigenvector that lies outside the basis: of the
// real vector k, or of the pair k, k + 1.
double bough_arnoldi_residual(const bough_arnoldi *a, int k);

// x (n × length) ← Σ y_k q_k over the vectors done, for y (n × done).
void bough_arnoldi_combine(const bough_arnoldi *a, int n, const double *y, double *x);
