// The tangent of the air's loads with respect to the motion, about a steady state of the whole scene, by
// differences:
//     ẏ = … + A y + R m ,   ṁ = G y + H m + K u ,
// y the states of all members, m those of the air: delayed inductions, shed wakes, lags of pressure and
// separation (rotor.h). Quasi-steady air has no m: inductions and lift follow without delay.
#pragma once

#include "apps/bough/model/blade_group.h"
#include "cosim/whole.h"

// Whether the forces of the air follow the motion in modes and linear models of the scene.
static inline bool bough_air_follows(const bough_scene *scene) {
    return scene->aero.node != NULL && scene->modes.air != BOUGH_SCENE_AIR_FROZEN;
}

typedef struct bough_air_tangent {
    int n, n_air;    // states of the members, of the air
    int all;         // n + n_air
    int n_per_blade; // of the air, blade after blade
    double *matrix;  // [A R; G H] (all × all), column-major
    double *input;   // ẏ by the inputs, with and without the air, and K (all × n_input), column-major
} bough_air_tangent;

static inline double *bough_air_tangent_entry(const bough_air_tangent *tangent, size_t row, size_t column) {
    return tangent->matrix + column * (size_t)tangent->all + row;
}

// Inputs of the scene.
typedef struct bough_air_inputs {
    int n;
    const double *size; // (n) of a difference
    void *self;
    void (*set)(void *self, int k, double change, double *state); // `state`: receives a prescribed motion
} bough_air_inputs;

// The state of a tangent, which may be that of an azimuth of a mean, theory (113); all borrowed.
typedef struct bough_air_azimuth {
    bough_simulation *simulation;
    bough_whole *whole;
    double time;
    const double *state;            // (n)
    const bough_blade_group *group; // its equal blades; NULL or none: each state is by itself
    // of a mean; otherwise 0
    const bough_simulation *first;  // of the first azimuth
    const bough_blade_group *parts; // the same blades there, in whose order they are the mean's parts
    const double *blend;            // C (group->n × group->n)
    double share;                   // of the mean
} bough_air_azimuth;

// About the azimuth's state, or an azimuth's share of the mean, which is added; a tangent that is {0} takes
// its matrices. With the memory that the scene's inflow and stall have if modes.air is dynamic; inputs NULL:
// none, as of a mean. States of a group of rods, and of places that share no loads, are changed at once;
// means over the disk then count as of the blade's nearest state. Where a change of all misses by more than
// 1e-3 with that, each state is changed by itself. The simulation is left in that state.
bough_status bough_air_tangent_add(bough_arena *arena, const bough_air_azimuth *azimuth,
                                   const bough_air_inputs *inputs, bough_air_tangent *tangent);

// The same for one change of bodies and air at once: the products that the matrices have with it.
typedef struct bough_air_change bough_air_change;

// Brings the air to rest about the state of one of a mean's azimuths; *n_air: its states.
bough_air_change *bough_air_change_create(bough_arena *arena, const bough_air_azimuth *azimuth, int *n_air);

// Cᵀ (A y + R m) and Cᵀ (G y + H m) into image (n + n_air), of C change = y, m (n + n_air), without the
// rotor's angle where there are several azimuths, by differences of `size` times it, to both sides or, at
// half the cost, to one.
bough_status bough_air_change_follow(bough_air_change *x, double size, bool to_one_side, const double *change,
                                     double *image);

// -- mean over azimuths and blades (air_mean.c) ---------------------------------------------------

// After the last azimuth: what the first blade does holds for the others.
void bough_air_tangent_close(bough_arena *arena, const bough_air_azimuth *azimuth,
                             bough_air_tangent *tangent);

typedef struct bough_air_mean bough_air_mean;

bough_air_mean *bough_air_mean_create(bough_arena *arena, const bough_air_azimuth *azimuth,
                                      const bough_air_tangent *tangent);

// Adds the slopes (n + n_air) by a state, `at` among those of the members and then of the air.
void bough_air_mean_add(const bough_air_mean *mean, int at, const double *slope, bough_air_tangent *tangent);

// Adds slopes that are sums over the blades, as means: of each row of a blade, its states and then its air's,
// by the state `column` of the row.
void bough_air_mean_add_own(const bough_air_mean *mean, const int *column, const double *slope,
                            bough_air_tangent *tangent);

// Entries of the blades, in n rows of each, by C or its transpose, in place: row (n_part × n).
void bough_air_mean_blend(const double *blend, bool transposed, int n_part, int n, const int *row, double *x);

// Switches the sign of what is added from now on.
void bough_air_mean_negate(bough_air_mean *mean);

// Rows of the states of the group's blades among the members' and then the air's: of each blade its own, then
// the n_per_blade of its air (group->n × (group->n_row + n_per_blade)).
const int *bough_air_tangent_rows(bough_arena *arena, const bough_simulation *s,
                                  const bough_blade_group *group, int n_per_blade);

// Number of blade k of the group among the rotor's.
int bough_air_tangent_blade(const bough_simulation *s, const bough_blade_group *group, int k);
