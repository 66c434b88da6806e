// How the air's loads follow the motion, about a steady state of the whole scene, by differences:
//     ẏ = … + A y + R m ,   ṁ = G y + H m + K u ,
// y the states of all members, m those of the air: delayed inductions, shed wakes, lags of pressure and
// separation (rotor.h). Of quasi-steady air there is no m: inductions and lift follow at once.
#ifndef BOUGH_APPS_ANALYSIS_AIR_TANGENT_H
#define BOUGH_APPS_ANALYSIS_AIR_TANGENT_H

#include "apps/bough/model/blade_group.h"
#include "cosim/whole.h"

typedef struct bough_air_tangent {
    int n, n_air;        // states of the members, of the air
    int n_per_blade;     // of the air, blade after blade
    double *motion;      // A (n × n), column-major as all
    double *lift;        // R (n × n_air)
    double *drive;       // G (n_air × n)
    double *lag;         // H (n_air × n_air)
    double *input;       // ẏ by the inputs, with and without the air (n × n_input)
    double *input_drive; // K (n_air × n_input)
} bough_air_tangent;

// What acts on the scene from outside.
typedef struct bough_air_inputs {
    int n;
    const double *size; // (n) of a difference
    void *self;
    void (*set)(void *self, int k, double change, double *state); // `state`: where a motion given is put
} bough_air_inputs;

// About `state` (n) at `time`; `dynamic`: with the memory that the scene's inflow and stall have; inputs
// NULL: none. `group`: rods whose states, and those of places that share no loads, are changed at once; means
// over the disk then count as of the blade's nearest state. Where a change of all misses by more than 1e-3
// with that, and for NULL, each state is changed by itself. The simulation is left in that state.
bough_status bough_air_tangent_find(bough_arena *arena, bough_simulation *s, bough_whole *whole, double time,
                                    const double *state, bool dynamic, const bough_blade_group *group,
                                    const bough_air_inputs *inputs, bough_air_tangent *tangent);

// The same for one change of bodies and air at once: the products that the matrices have with it.
typedef struct bough_air_change bough_air_change;

// Brings the air to rest about `state` (n), which is borrowed; *n_air: its states.
bough_air_change *bough_air_change_create(bough_arena *arena, bough_simulation *s, bough_whole *whole,
                                          double time, const double *state, bool dynamic, int *n_air);

// A y + R m and G y + H m into image (n + n_air), of change = y, m (n + n_air), by differences of `size`
// times it.
bough_status bough_air_change_follow(bough_air_change *x, double size, const double *change, double *image);

// Rows of the air's states of the group's blades (n × n_per_blade).
void bough_air_tangent_rows(const bough_simulation *s, const bough_blade_group *group, int n_per_blade,
                            int *row);

// Makes what blades do to blades that of the mean over as many azimuths as there are blades, at which
// gravity, tilt, shear and tower differ.
void bough_air_tangent_average(bough_arena *arena, const bough_simulation *s, const bough_blade_group *group,
                               bough_air_tangent *tangent);

#endif
