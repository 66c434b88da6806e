// A rod, or a piece of one, reduced to shapes about its undeformed form: x̂ᵢ = x̂⁰ᵢ + Φᵢ q in the
// axes of a floating frame that is welded to its first vertex. Equations: theory (34, 35, 36, 37, 38).
//
// The shapes are the lowest modes of the clamped piece, the six rigid motions of its vertices
// relative to the frame, by choice the static deflections under accelerations of the frame, and, if
// another piece follows, under its wrench. The rigid motions put the piece's whole momentum in the span,
// so that as for a rod (rod.h) absolute velocities, here their modal coordinates η, take no
// acceleration of the frame as input and the carrier has the inertia of the first vertex only:
//     q̇ = η − Cᵀv − ω_a G_a q,      v = (u₀, ω) twist of the frame in its axes
//     η̇ = −Λ q − D q̇ − ω_a B_a η + (ω_a ω_b N_ab + a_k T_k + f_k F_k) q
//         + ω_a ω_b r_ab + C_tᵀ g + Φᵀf
// to first order in q; a = ω×u₀ − g the apparent acceleration, f_k a force at the last vertex.
#pragma once

#include "flexbody/rod/rod.h"

enum {
    BOUGH_MODAL_SQUARES = 6, // ω_a ω_b: xx yy zz xy xz yz
    BOUGH_MODAL_FIELDS = 12, // those, a_x a_y a_z, f_x f_y f_z
};

typedef struct bough_modal_options {
    int modes;       // of the clamped piece, all there are if fewer
    bool statics;    // static deflections under accelerations of the frame among the shapes
    bool stiffening; // by the axial force of centrifugal force, weight and the following pieces
} bough_modal_options;

// Matrices are (m × stride) by columns, row arrays (rows × stride); shapes are orthonormal in the
// mass and diagonal in the stiffness.
typedef struct bough_modal_piece {
    const bough_rod_model *rod; // the vertices and segments of the piece
    int first;                  // its first vertex among the body's
    int n;                      // moving vertices
    int m, stride;              // shapes; padded
    bool inner;                 // another piece hangs on its last vertex
    double mass;                // of the moving vertices [kg]
    double *square;             // Λ: squared angular frequencies (stride) [1/s²]
    double *damping;            // D
    double *rigid;              // C: projections of unit translations and rotations (6 × stride)
    double *rotating;           // G_a: projections of the shapes rotating with the frame (3 ·)
    double *gyroscopic;         // B_a (3 ·)
    double *field;              // N_ab, T_k, F_k (12 ·)
    double *centrifugal;        // r_ab (6 × stride)
    double *shape;              // Φ: displacement and rotation of vertices 1..n in frame axes
                                // (6 n × stride), row 6 (i − 1) + c
    double *scale;              // q that moves a vertex by 1 m or rotates it by 0.1 rad (stride)
} bough_modal_piece;

// Reduces vertices first..last of `def`; the frame is parallel to the body's and sits at `first`.
bough_status bough_modal_piece_create(bough_arena *arena, const bough_rod_def *def, int first, int last,
                                      bough_modal_options options, bough_modal_piece *piece);

// -- steps of the creation, each in a file of its own ---------------------------------------------

// Λ, D and the shapes, which go to piece->shape with rotations in frame axes.
bough_status bough_modal_basis(bough_arena *arena, bough_modal_options options, bough_modal_piece *piece);
