// Two masses on springs to the walls and a spring between them, cut in two and coupled by a scheme:
// the linear model on which schemes are compared, with its exact solution.
#pragma once

#include "cosim/master.h"
#include "tests/verification/oscillator.h"

typedef enum bough_cut {
    BOUGH_CUT_FORCE_DISPLACEMENT,        // mass 1 takes the force, mass 2 the motion
    BOUGH_CUT_DISPLACEMENT_DISPLACEMENT, // both hold the coupling spring and take the other's motion
    BOUGH_CUT_FORCE_FORCE,               // both take the force
} bough_cut;

typedef struct bough_two_mass {
    bough_spring_mass s1, s2;
    double k, c;  // of the coupling [N/m, N s/m]
    double y0[4]; // (x1, v1, x2, v2) at time 0 [m, m/s]
    bough_cut cut;
    bool kinematic;           // motions are marked as such: where held, by their rate
    bough_oscillator mass[3]; // the third is the spring of the force–force cut
    bough_member member[3];
    bough_arena *arena;
    bough_master *master;
} bough_two_mass;

// m = 1, 1; k = 10, 10, 20 and c = .2, .5, .3 from wall to wall; x2(0) = .5; mass 1 leads.
bough_two_mass bough_two_mass_default(void);

// The solution at t, forwards or backwards in time: y (4).
void bough_two_mass_at(const bough_two_mass *m, double t, double y[4]);

// Takes y (4) on by a duration.
void bough_two_mass_exact(const bough_two_mass *m, double duration, double y[4]);

// Builds the coupled run in the arena; def's assembly is ignored. The model must stay where it is.
bough_status bough_two_mass_build(bough_arena *arena, bough_two_mass *m, bough_master_def def);

// Replaces the start-up by exact history.
void bough_two_mass_history(bough_two_mass *m);

// Runs to the end: the largest error of either position at the synchronisation points.
bough_status bough_two_mass_error(bough_two_mass *m, double *worst);

// Largest modulus of the eigenvalues of one macro step, of any length, as a map of states and
// remembered inputs. The run's state is lost.
bough_status bough_two_mass_radius(bough_two_mass *m, double macro_step, double *radius);
