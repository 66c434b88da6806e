// An eigenvector of the whole scene as motion of its bodies.
#ifndef BOUGH_APPS_ANALYSIS_MODE_SHAPE_H
#define BOUGH_APPS_ANALYSIS_MODE_SHAPE_H

#include "apps/bough/model/blade_group.h"
#include "core/base/eigen.h"
#include "flexbody/rod/rod_modes.h"

// A flexible beam's vertices and their tangents along the shape, as rod.h lays them out.
typedef struct bough_beam_shape {
    const double *state;      // (13 n)
    const double *tangent[2]; // (13 n) real and imaginary part
    double *memory;           // (3 × 13 n) of both unless a rod, whose own they are
} bough_beam_shape;

typedef struct bough_mode_shape {
    const bough_simulation *simulation;
    const bough_assembly *assembly;
    const bough_blade_group *group;
    const double *state; // (n_state) that the modes are about
    const bough_eigen_pair *pair;
    double *moved;          // (n_state) work
    bough_beam_shape *beam; // (n_beam)
} bough_mode_shape;

// The real or imaginary part of the eigenvector (n_state).
static inline const double *bough_mode_shape_part(const bough_mode_shape *x, int part) {
    return part == 0 ? x->pair->shape_real : x->pair->shape_imag;
}

// Takes the memory; simulation and assembly are set.
void bough_mode_shape_take(bough_arena *arena, bough_mode_shape *x);

// Finds the beams' vertices for x->pair.
void bough_mode_shape_set(const bough_mode_shape *x);

const bough_beam_shape *bough_mode_shape_beam(const bough_mode_shape *x, const bough_beam *beam);

// The motion of the whole, displacement [m] and rotation [rad] in ground axes: a row for each body
// of the scene at its frame, of a flexible one for each vertex.
typedef struct bough_shape_row {
    int body;
    double span;         // [m]; 0 of a rigid body
    double motion[2][6]; // real and imaginary part
} bough_shape_row;

int bough_mode_shape_rows(const bough_simulation *s); // their number

// Scaled so that the largest displacement, or else rotation, is real and 1.
void bough_mode_shape_move(const bough_mode_shape *x, bough_shape_row *row);

// -- shares of the bodies in a mode ---------------------------------------------------------------

// What a mode of the whole scene is, read from its shape: whose energy, in which direction, in
// which pattern over the blades.

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
    double residual;         // of its eigenvector: bough_eigen_residual
    double moved;            // by another mesh, |λ − λ'|/|λ|; NaN: not compared, or no such mode there
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
