#include "cosim/scheme.h"

#include <string.h>

static const bough_scheme *const schemes[] = {
    &bough_scheme_ramp,         &bough_scheme_gauss_seidel, &bough_scheme_extrapolated,
    &bough_scheme_iterated,     &bough_scheme_frozen,       &bough_scheme_monolithic,
};

static const char *const names[] = {"ramp",   "gauss-seidel", "extrapolated", "iterated",
                                    "frozen", "monolithic",   NULL};

bough_scheme_options bough_scheme_options_default(void) {
    return (bough_scheme_options){.name = "ramp",
                                  .order = 1,
                                  .interpolation = BOUGH_HERMITE,
                                  .rtol = 1e-6,
                                  .accelerator = BOUGH_ACCELERATE_IQN_ILS,
                                  .relaxation = 0.5,
                                  .tolerance = 1e-6,
                                  .iterations = 30};
}

const bough_scheme *bough_scheme_find(const char *name) {
    for (size_t i = 0; i < sizeof schemes / sizeof *schemes; i++) {
        if (strcmp(schemes[i]->name, name) == 0) return schemes[i];
    }
    return NULL;
}

const char *const *bough_scheme_names(void) {
    return names;
}
