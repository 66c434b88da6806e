// What a mode of the whole scene is, read from its shape: whose energy, in which direction, in
// which pattern over the blades.
#ifndef BOUGH_APPS_ANALYSIS_MODE_SHARE_H
#define BOUGH_APPS_ANALYSIS_MODE_SHARE_H

#include "apps/bough/analysis/mode_shape.h"
#include "flexbody/rod/rod_modes.h"

// How the blades move against each other.
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
    double *share;           // of the kinetic energy per body of the scene, sum 1
    int body;                // the body of the largest, or a blade when all blades' together is
    bool blades;             // it is
    int direction;           // of the largest share: bough_rod_direction in these rods; of a rigid
                             // body 0..2 along the ground's axes, 3 turning
    bough_pattern pattern;   // of the blades
    double whirl[3];         // shares of the blades' motion: collective, forward, backward
    bough_shape_row *shape;  // (n_row); NULL unless the scene's modes block asks for shapes
} bough_scene_mode;

extern const char *const bough_pattern_names[BOUGH_PATTERNS];

// Sets mode->share (n_body, zero before), body, blades, direction, pattern and whirl.
void bough_mode_share_set(const bough_mode_shape *x, bough_scene_mode *mode);

#endif
