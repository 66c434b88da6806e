#include "flexbody/micro.h"

#include "flexbody/micro_alpha.h"
#include "flexbody/micro_arkode.h"
#include "flexbody/micro_cvode.h"
#include "flexbody/micro_rosenbrock.h"

static bough_status advance_cvode(void *self, double t, double t1, bool restart, double *y) {
    return bough_micro_cvode_advance(self, t, t1, restart, y);
}

static void count_cvode(const void *self, bough_statistics *sum) {
    bough_micro_cvode_statistics(self, sum);
}

static bough_status advance_arkode(void *self, double t, double t1, bool restart, double *y) {
    return bough_micro_arkode_advance(self, t, t1, restart, y);
}

static void count_arkode(const void *self, bough_statistics *sum) {
    bough_micro_arkode_statistics(self, sum);
}

static bough_status advance_alpha(void *self, double t, double t1, bool restart, double *y) {
    return bough_micro_alpha_advance(self, t, t1, restart, y);
}

static void count_alpha(const void *self, bough_statistics *sum) {
    bough_micro_alpha_statistics(self, sum);
}

static bough_status advance_rosenbrock(void *self, double t, double t1, bool restart, double *y) {
    return bough_micro_rosenbrock_advance(self, t, t1, restart, y);
}

static bough_status advance_rosenbrock_part(void *self, double *t, double pause, double t1,
                                            bool restart, double *y) {
    return bough_micro_rosenbrock_advance_part(self, t, pause, t1, restart, y);
}

static void count_rosenbrock(const void *self, bough_statistics *sum) {
    bough_micro_rosenbrock_statistics(self, sum);
}

static bough_status create_cvode(bough_arena *arena, const bough_ode *ode, const double *scale,
                                 bough_micro_options options, bough_micro *micro) {
    bough_micro_cvode *self = NULL;
    bough_status status = bough_micro_cvode_create(arena, ode, scale, options.rtol, &self);
    *micro = (bough_micro){"CVODE BDF", self, advance_cvode, count_cvode, NULL,
                           bough_micro_cvode_error(self)};
    return status;
}

static bough_status create_arkode(bough_arena *arena, const bough_ode *ode, const double *scale,
                                  bough_micro_options options, bough_micro *micro) {
    bough_micro_arkode *self = NULL;
    bough_status status = bough_micro_arkode_create(arena, ode, scale, options.rtol, &self);
    *micro = (bough_micro){"ARKODE ESDIRK", self, advance_arkode, count_arkode, NULL, NULL};
    return status;
}

static bough_status create_alpha(bough_arena *arena, const bough_ode *ode, const double *scale,
                                 bough_micro_options options, bough_micro *micro) {
    bough_micro_alpha *self = NULL;
    bough_micro_alpha_options alpha = {options.step, options.rho, options.rtol};
    bough_status status = bough_micro_alpha_create(arena, ode, scale, alpha, &self);
    *micro = (bough_micro){"generalised-α", self, advance_alpha, count_alpha, NULL,
                           bough_micro_alpha_error(self)};
    return status;
}

static bough_status create_rosenbrock(bough_arena *arena, const bough_ode *ode,
                                      const double *scale, bough_micro_options options,
                                      bough_micro *micro) {
    bough_micro_rosenbrock *self = NULL;
    bough_micro_rosenbrock_options own = {options.step, options.rtol};
    bough_status status = bough_micro_rosenbrock_create(arena, ode, scale, own, &self);
    *micro = (bough_micro){"Rosenbrock", self, advance_rosenbrock, count_rosenbrock,
                           advance_rosenbrock_part, bough_micro_rosenbrock_error(self)};
    return status;
}

bough_status bough_micro_create(bough_arena *arena, const bough_ode *ode, const double *scale,
                                bough_micro_options options, bough_micro *micro) {
    switch (options.kind) {
    case BOUGH_MICRO_ARKODE_ESDIRK: return create_arkode(arena, ode, scale, options, micro);
    case BOUGH_MICRO_GENERALIZED_ALPHA: return create_alpha(arena, ode, scale, options, micro);
    case BOUGH_MICRO_ROSENBROCK: return create_rosenbrock(arena, ode, scale, options, micro);
    default: return create_cvode(arena, ode, scale, options, micro);
    }
}
