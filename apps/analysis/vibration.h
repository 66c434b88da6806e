// Modes of the whole scene about its equilibrium, at rest or in steady rotation, or about the state
// it begins in. The air's forces are those of the equilibrium, or follow the motion (aeroelastic.h).
//
// Where the turbine's rotor turns, its blades are equal and evenly spaced and at least three, the
// frequencies are those an observer at rest sees: the multi-blade transform of cosim/modes.h, about
// the mean of the blades' shapes. In any other rotation they are those of the frozen azimuth.
#ifndef BOUGH_APPS_ANALYSIS_VIBRATION_H
#define BOUGH_APPS_ANALYSIS_VIBRATION_H

#include "apps/analysis/mode_shape.h"
#include "apps/simulation/equilibrium.h"
#include "flexbody/rod_modes.h"

// How the blades move against each other.
typedef enum bough_pattern {
    BOUGH_PATTERN_NONE,       // there are no blades to compare
    BOUGH_PATTERN_COLLECTIVE, // all alike
    BOUGH_PATTERN_FORWARD,    // whirling in the sense of the rotation, at rest of the shaft's axis
    BOUGH_PATTERN_BACKWARD,   // against it
    BOUGH_PATTERN_COSINE,     // standing, as the cosine of the azimuth: the rotor tilts
    BOUGH_PATTERN_SINE,       // standing, as the sine: it yaws
    BOUGH_PATTERN_REACTIONLESS, // of four blades and more
    BOUGH_PATTERNS,
} bough_pattern;

typedef struct bough_scene_mode {
    double frequency;        // |λ|/2π [Hz]
    double damped_frequency; // Im λ/2π [Hz]; 0: it grows without oscillating
    double damping;          // ratio −Re λ/|λ|; negative: it grows
    double growth;           // Re λ [1/s]
    double *share;           // of the kinetic energy per body of the scene, sum 1
    int body;                // the body of the largest, or a blade when all blades' together is
    bool blades;             // it is
    int direction;           // of the largest share: bough_rod_direction in these rods; of a rigid
                             // body 0..2 along the ground's axes, 3 turning
    bough_pattern pattern;   // of the blades
    double whirl[3];         // shares of the blades' motion: collective, forward, backward
    bough_shape_row *shape;  // (n_row); NULL unless the scene's modes block asks for shapes
} bough_scene_mode;

typedef struct bough_vibration {
    bough_equilibrium_work work; // how the equilibrium was found; 0 steps: none was sought
    double spin;             // of the rotor [rad/s]
    bool frozen;             // it turns, but the blades allow no transform
    int n_blade;             // compared; 0: none
    int n_row;               // of a shape
    int found;
    bough_scene_mode *mode;  // (found) by the distance of λ from a point near 0
    bough_eigen_pair *pair;  // (found)
    struct bough_aeroelastic *reduced; // in the air that follows: what they are the modes of; or NULL
} bough_vibration;

extern const char *const bough_pattern_names[BOUGH_PATTERNS];

// Whether the scene's modes block, or the scene without it, asks for modes of the whole.
bool bough_vibration_wanted(const bough_simulation *s);

// The `count` lowest modes, or fewer if there are not so many that can be told to 1e-9; free
// motions, whose eigenvalue is 0, are left out. The simulation is left in the state they are about.
bough_status bough_vibration_find(bough_arena *arena, bough_simulation *s, int count,
                                  bough_vibration *vibration);

#endif
