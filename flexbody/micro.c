#include "flexbody/micro.h"

#include "flexbody/micro_alpha.h"
#include "flexbody/micro_cvode.h"

static bough_status advance_cvode(void *self, double t, double t1, bool restart, double *y) {
    return bough_micro_cvode_advance(self, t, t1, restart, y);
}

static void count_cvode(const void *self, bough_statistics *sum) {
    bough_micro_cvode_statistics(self, sum);
}

static bough_status advance_alpha(void *self, double t, double t1, bool restart, double *y) {
    return bough_micro_alpha_advance(self, t, t1, restart, y);
}

static void count_alpha(const void *self, bough_statistics *sum) {
    bough_micro_alpha_statistics(self, sum);
}

bough_status bough_micro_create(bough_arena *arena, const bough_ode *ode, const double *scale,
                                bough_micro_options options, bough_micro *micro) {
    if (options.kind == BOUGH_MICRO_CVODE_BDF) {
        bough_micro_cvode *self = NULL;
        bough_status status = bough_micro_cvode_create(arena, ode, scale, options.rtol, &self);
        *micro = (bough_micro){"CVODE BDF", self, advance_cvode, count_cvode};
        return status;
    }
    bough_micro_alpha *self = NULL;
    bough_micro_alpha_options alpha = {options.step, options.rho, options.rtol};
    bough_status status = bough_micro_alpha_create(arena, ode, scale, alpha, &self);
    *micro = (bough_micro){"generalised-α", self, advance_alpha, count_alpha};
    return status;
}
