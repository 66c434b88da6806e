// How kernels go through the n moving vertices of a rod, BOUGH_WIDTH of them in a vector.
#ifndef BOUGH_FLEXBODY_ROD_ROD_VECTORS_H
#define BOUGH_FLEXBODY_ROD_ROD_VECTORS_H

#include "core/base/base.h"
#include "core/base/level.h"

// Those of whole vectors.
BOUGH_INLINE int whole_vectors(int n) { return n - n % BOUGH_WIDTH; }

// Whether the others go by one more vector that ends with the last vertex: it repeats some of the vector
// before, and takes less time than they do one by one.
BOUGH_INLINE bool one_more_vector(int n) { return n > BOUGH_WIDTH && n % BOUGH_WIDTH > 1; }

#endif
