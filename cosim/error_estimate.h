// An estimate of the coupling error of all states while a run goes on. The run has integrated every
// member under inputs ũ(t) that differ from the actual outputs of the others, u(t), by the defect
// δ = ũ − u, which is known at the end of each macro step. To first order the difference ε of its states
// to those of one monolithic system satisfies
//     ε̇ = J ε + B υ + s,   υ = P (C ε + D υ) + δ,   ε(0) = 0,
// the linearised members coupled without any delay; s is the rate at which the members' own steps
// err, by the estimate of those that have one. The defects of a batch of steps are kept, then
// ε is taken through it by the generalised-α method, one solution a step, its Newton matrix condensed
// as in condense.h: with the factors of the ramp's predictions where these are at hand, else the
// members are linearised once. Each step takes the mean of δ over it, so that impulses are exact. So
// defects do not merely add up: they excite, ring and die as the mechanics let them.
//
// Not included: damping by loads from outside the members, such as aerodynamic damping, so ε is too large
// rather than too small; own errors of members without an estimate; terms of second order in ε.
#ifndef BOUGH_COSIM_ERROR_ESTIMATE_H
#define BOUGH_COSIM_ERROR_ESTIMATE_H

#include "cosim/coupling.h"

// What is reported is ε times this: measured against monolithic runs, ε alone is 0.8 to 2.3 of
// the error on oscillators and 0.3 to 1.4 on a rotor in the wind, whose air amplifies errors.
enum { BOUGH_ERROR_SAFETY = 2 };

typedef struct bough_error_estimate bough_error_estimate;

bough_error_estimate *bough_error_estimate_create(bough_arena *arena, const bough_coupling *c);

// The worst defect of a step just exchanged but not yet taken, at its middle and its end: of a vector
// of up to three inputs relative to its largest norm so far [1].
double bough_error_estimate_defect(bough_error_estimate *e, const bough_coupling *c);

// Takes the defects of the step just exchanged; ends the batch when it is full.
void bough_error_estimate_step(bough_error_estimate *e, bough_coupling *c);

// Ends the batch: ε is then that at the current synchronisation point.
void bough_error_estimate_finish(bough_error_estimate *e, bough_coupling *c);

// The open batch, the error and what the inputs have been.
void bough_error_estimate_snapshot(bough_error_estimate *e, bough_snapshot *s);

// Batches ended so far: ε is new when it has changed.
long bough_error_estimate_batches(const bough_error_estimate *e);

// ε at the end of the last batch (n_state), in the states' units; NULL when a member could not be
// linearised.
const double *bough_error_estimate_states(const bough_error_estimate *e);

// What the members' own steps erred by, summed up, relative to ε: of the state that is the worst for
// its scale [1].
double bough_error_estimate_own_share(const bough_error_estimate *e);

// Largest error so far of input j, as reported, in the port's unit: by ε, not by δ.
double bough_error_estimate_input(const bough_error_estimate *e, int j);

#endif
