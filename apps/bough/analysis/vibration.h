// Modes of the whole scene about its equilibrium, at rest or in steady rotation, or about the state
// it begins in. The air's forces are those of the equilibrium, or follow the motion (aeroelastic.h).
//
// Where the turbine's rotor turns, its blades are equal and evenly spaced and at least three, the
// frequencies are those an observer at rest sees: the multi-blade transform of cosim/analysis/modes.h, about
// the mean of the blades' shapes. In any other rotation they are those of the present azimuth; where the
// linear system changes with the azimuth, its motions are no modes, and the search is refused.
#pragma once

#include "apps/bough/model/blade_group.h"
#include "apps/bough/model/equilibrium.h"
#include "core/base/eigen.h"
#include "cosim/analysis/modes.h"
#include "flexbody/rod/rod_modes.h"

// -- a mode: bodies, direction, pattern over the blades -------------------------------------------

// Motion of the scene, displacement [m] and rotation [rad] in ground axes: a row for the frame of each body,
// of a flexible one for each vertex.
typedef struct bough_shape_row {
    int body;
    double span;         // [m]; 0 of a rigid body
    double motion[2][6]; // real and imaginary part
} bough_shape_row;

// Pattern of the motion over the blades.
typedef enum bough_pattern {
    BOUGH_PATTERN_NONE,         // there are no blades to compare
    BOUGH_PATTERN_COLLECTIVE,   // all alike
    BOUGH_PATTERN_FORWARD,      // whirling in the sense of the rotation, at rest of the shaft's axis
    BOUGH_PATTERN_BACKWARD,     // against it
    BOUGH_PATTERN_COSINE,       // standing, as the cosine of the azimuth: the rotor tilts
    BOUGH_PATTERN_SINE,         // standing, as the sine: it yaws
    BOUGH_PATTERN_REACTIONLESS, // of four blades and more
    BOUGH_PATTERNS,
} bough_pattern;

typedef struct bough_scene_mode {
    double frequency;        // |λ|/2π [Hz]
    double damped_frequency; // Im λ/2π [Hz]; 0: it grows without oscillating
    double damping;          // ratio −Re λ/|λ|; negative: it grows
    double growth;           // Re λ [1/s]
    double residual;         // of its eigenvector: bough_eigen_residual
    double
        frequency_change;  // largest change from the mean over the azimuths to one, relative; NaN: not known
    double damping_change; // the same of the damping ratio
    double moved;  // |λ − λ'|/|λ| to the mode on another mesh; NaN: not compared, HUGE_VAL: no such mode
    double *share; // of the kinetic energy for each body of the scene, sum 1
    bool blades;   // all blades together have more kinetic energy than any other body
    int body;      // the body with the largest share; with `blades` the first blade
    int direction; // in which these move most: bough_rod_direction; of a rigid body 0..2 along the
                   // ground's axes, 3 rotation
    bough_pattern pattern;  // of the blades
    double whirl[3];        // shares of the blades' motion: collective, forward, backward
    bough_shape_row *shape; // (n_row); NULL unless the scene's modes block asks for shapes
} bough_scene_mode;

extern const char *const bough_pattern_names[BOUGH_PATTERNS];

// -- the modes of a scene -------------------------------------------------------------------------

typedef struct bough_vibration {
    double time;             // of the loads [s]
    double spin;             // of the rotor [rad/s]
    bool frozen;             // of one azimuth: something rotates, not only a rotor that allows the transform
    int n_blade;             // compared; 0: none
    int n_row;               // of a shape
    int asked;               // modes
    bough_eigen_count count; // of the eigenvalues among which they are sought
    int unpaired;            // eigenvectors left out of the system with air: see aeroelastic.h
    int found;
    bough_scene_mode *mode;            // (found) by the distance of λ from a point near 0
    bough_eigen_pair *pair;            // (found)
    struct bough_mode_vectors *vector; // (found) of the same in the air; NULL: not found
    int n_azimuth;                     // over which the system is averaged; 1: the scene's azimuth alone
    bool *slow;          // (count.found) which of the pairs near 0 are modes; NULL: none is near
    double (*change)[2]; // (found) of each mode over them, as frequency_change and damping_change
} bough_vibration;

// The state of the modes: the simulation's present state, with the mean deflection of rotating blades (not on
// an unbalanced hub with modes.linear).
typedef struct bough_vibration_point {
    bough_whole *whole;
    bough_blade_group group;
    double *state;     // (n_state)
    double *mean;      // (n_state) work
    int n_held, *held; // rows of prescribed joints
    bough_modes_def def;
} bough_vibration_point;

// (azimuth.c)
bough_status bough_vibration_point_find(bough_arena *arena, bough_simulation *s, double time,
                                        bough_vibration_point *point);

// BOUGH_INVALID where the linear system, by its solutions about a point of the real axis [1/s], changes as
// the bodies turn, unless the scene asks for it as it is (modes.linear).
bough_status bough_vibration_check_constant(bough_arena *arena, const bough_simulation *s,
                                            const bough_vibration_point *x, double point);

// Sets v->mode from the eigenvectors v->pair about the point (mode_shape.c), but for their eigenvalues.
void bough_vibration_describe(bough_arena *arena, const bough_simulation *s, const bough_vibration_point *x,
                              bough_vibration *v);

// Whether the scene's modes block, or the scene without it, asks for modes of the whole.
bool bough_vibration_wanted(const bough_simulation *s);

// The `count` lowest modes, or fewer if not so many converge to 1e-9; free
// motions, whose eigenvalue is 0, are left out. The simulation is left in the state they are about.
// BOUGH_INVALID where the linear system is periodic, unless the scene asks for it as it is (modes.linear).
bough_status bough_vibration_find(bough_arena *arena, bough_simulation *s, int count,
                                  bough_vibration *vibration);

// Sets each mode's `moved` from the modes of the same scene with about half the segments, of modal bodies
// twice (coarser.h); *compared: false, and nothing is set, where no body has segments.
bough_status bough_vibration_compare(bough_arena *arena, const bough_simulation *s,
                                     bough_vibration *vibration, bool *compared);
