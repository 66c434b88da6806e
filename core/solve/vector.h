// Vectors for SUNDIALS: the library's serial one with vectorised operations, as its own cost three
// quarters of a rod's run. Only this file accesses the content of an N_Vector.
#pragma once

#include <sundials/sundials_nvector.h>

#include <stdbool.h>

// A vector of n zeros, aligned to 64 bytes; NULL when memory is exhausted. Freed by N_VDestroy.
N_Vector bough_vector_create(int n, SUNContext context);

// Whether an integrator of SUNDIALS with vectors of n components has room. The library (6.4) ends the
// process where memory does: it writes through the vector or the logger that it did not get.
bool bough_vector_room(int n);

// The n components of a vector made by bough_vector_create.
double *bough_vector_data(N_Vector v);
