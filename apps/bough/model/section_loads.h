// Forces and moments in the sections of a rod, between its vertices too.
#pragma once

#include "apps/bough/model/simulation.h"
#include "flexbody/rod/rod_load.h"

// Between two rotations: p at fraction 0, q at fraction 1.
static inline bough_quaternion bough_rotation_between(bough_quaternion p, bough_quaternion q,
                                                      double fraction) {
    bough_quaternion step = bough_quaternion_product(bough_quaternion_conjugate(p), q);
    bough_vec3 part = bough_scale(fraction, bough_quaternion_logarithm(step));
    return bough_quaternion_product(p, bough_quaternion_exponential(part));
}

// A place on a rod: within a segment, at a fraction of its length.
typedef struct bough_rod_place {
    int segment;
    double fraction;
    bough_axial_mass inner; // of the segment's part up to there
    double bend[27], twist; // `bend` and its result, of bough_rod_sections
} bough_rod_place;

// A load of the scene on the rod.
typedef struct bough_section_scene_load {
    const bough_scene_load *of;
    const bough_schedule *schedule; // of its factor
    bough_rod_reach reach;
    double factor; // at the evaluation
} bough_section_scene_load;

typedef struct bough_section_loads {
    const bough_simulation *simulation;
    const bough_beam *beam;
    int n_load;
    bough_section_scene_load *load; // (n_load)
    bough_mat3 ground;              // from ground to the body's axes
    bough_rod_scratch scratch;      // vertices and segments at the evaluation
    bough_wrench *lack;             // (n_segment) theory (120), at the left vertices, in the body's axes
    bough_axial_mass *mass;         // (n_segment) of whole segments
    double *centre;                 // (n_segment + 1) arc length of the vertices' mass centres [m]
    bough_vec3 *acceleration;       // (n_segment + 1) a − g there, in the body's axes [m/s²]
    bough_wrench root, end;         // in the body's axes; end: of bodies and loads on it
} bough_section_loads;

// Of a body of fidelity rod.
bough_section_loads bough_section_loads_create(bough_arena *arena, const bough_simulation *s,
                                               const bough_beam *beam);

// Evaluates the rod at the current synchronisation point, time t [s]. False when the forces are not finite.
bool bough_section_loads_evaluate(bough_section_loads *x, double t);

bough_rod_place bough_section_loads_place(const bough_section_loads *x, int segment, double fraction);

// The left or the right end of a segment, for loads alone.
bough_rod_place bough_section_loads_end(const bough_section_loads *x, int segment, bool right);

// Wrench of the outer part on the inner part at the section, in the body's axes.
bough_wrench bough_section_loads_at(const bough_section_loads *x, const bough_rod_place *place);

// The section's axes in the body's, and its rotation vector against the undeformed one.
bough_mat3 bough_section_loads_axes(const bough_section_loads *x, const bough_rod_place *at,
                                    bough_vec3 *rotation);

// Position of a vertex [m] and rotation of the section there, in the body's frame.
bough_vec3 bough_section_loads_position(const bough_section_loads *x, int vertex);
bough_quaternion bough_section_loads_rotation(const bough_section_loads *x, int vertex);
