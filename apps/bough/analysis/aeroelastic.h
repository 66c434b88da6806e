// The whole scene and its air as one small linear system about a steady state, as an observer at rest
// sees it where a rotor turns (cosim/analysis/modes.h):
//     ż = a z ,   z = (u, m) ,   y = U u ,
// u the motion in the invariant subspace of the bodies' lowest modes, m the states of the air, whose
// forces couple all (air_tangent.h). Right and left subspace by simultaneous iteration on
// (I − γ(J − S))⁻¹, so that forces are shared out to the modes as the full system does; modes left out
// follow the air's forces at once.
#ifndef BOUGH_APPS_ANALYSIS_AEROELASTIC_H
#define BOUGH_APPS_ANALYSIS_AEROELASTIC_H

#include "apps/bough/analysis/air_tangent.h"
#include "apps/bough/model/blade_group.h"
#include "cosim/analysis/modes.h"

typedef struct bough_aeroelastic {
    int n, n_motion, n_air, n_all; // states of the members, of u, of m, of both
    double *shape;                 // U (n × n_motion), column-major as all
    double *left;                  // (n_motion × n): of a rate of y what drives u
    double *motion;                // (n_motion × n_motion): the rates of u without the air
    double *rate;                  // a (n_all × n_all)
} bough_aeroelastic;

// Reduces the system of `def` to n_motion states of motion and those of the tangent's air.
bough_status bough_aeroelastic_reduce(bough_arena *arena, const bough_simulation *s, bough_whole *coupled,
                                      const bough_modes_def *def, const bough_blade_group *group,
                                      const bough_air_tangent *tangent, int n_motion,
                                      bough_aeroelastic *reduced);

// Its oscillations and growing motions in which the bodies take part, by |λ|: pairs (room for n_all),
// shapes (n).
bough_status bough_aeroelastic_modes(bough_arena *arena, const bough_aeroelastic *reduced,
                                     bough_eigen_pair *pair, int *found);

#endif
