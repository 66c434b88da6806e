// The constraints of a joint, as equations between two frames a and b, which close a loop of bodies. With d =
// R_aᵀ(r_b − r_a) and E = R_aᵀR_b an equation is either
//     e·d = 0   or   a·E b = 0,   e, a fixed in the first frame, b in the second.
#pragma once

#include "core/tree/joint.h"

enum { BOUGH_CONSTRAINT_ROWS = 6 }; // the most any kind has

typedef struct bough_constraint {
    int n_translation, n_rotation;
    bough_vec3 along[3];            // e, unit vectors
    bough_vec3 first[3], second[3]; // a and b, unit vectors
} bough_constraint;

// One frame's motion.
typedef struct bough_frame_motion {
    bough_transform pose; // in the ground
    bough_twist twist;    // in its own axes [m/s, rad/s]
} bough_frame_motion;

// Motion of a frame b relative to a frame a, all in the axes of a.
typedef struct bough_relative_motion {
    bough_mat3 e;                  // E
    bough_vec3 d, d_rate;          // [m], [m/s]
    bough_vec3 omega;              // E Ω_b − Ω_a [rad/s]
    bough_vec3 w_first;            // Ω_a [rad/s]
    bough_vec3 v_second, w_second; // E v_b, E Ω_b [m/s, rad/s]
} bough_relative_motion;

bough_relative_motion bough_relate(const bough_frame_motion *a, const bough_frame_motion *b);

typedef struct bough_constraint_row {
    double value;           // left side of the equation [m, –]
    double rate;            // its rate [m/s, 1/s]
    double bias;            // its second rate without the rates of the twists' components [per s²]
    bough_wrench wrench[2]; // on the first and the second frame per unit of the multiplier, in its
                            // axes at its origin [–, m or 1]; rate = Σ twistᵀ wrench
} bough_constraint_row;

// The equations of a joint of this kind whose frames are a and b: the axis has the same components
// in both, a universal joint's second axis belongs to b. Not for free joints.
bough_constraint bough_constraint_make(bough_joint_kind kind, bough_vec3 axis, bough_vec3 second);

static inline int bough_constraint_n_rows(const bough_constraint *c) {
    return c->n_translation + c->n_rotation;
}

// All rows at one motion of the frames.
void bough_constraint_rows(const bough_constraint *c, const bough_frame_motion *a,
                           const bough_frame_motion *b, bough_constraint_row *row);
