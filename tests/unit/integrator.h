// An integrator stepped by itself, for tests.
#pragma once

#include "core/solve/integrator.h"

static inline bough_status integrator_advance(const bough_integrator *i, double t, double t1, bool restart,
                                              double *y) {
    return i->ops->advance(i->self, &t, t1, restart, y);
}
