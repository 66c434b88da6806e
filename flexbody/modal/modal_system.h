// A modal body, one linear piece or several in a row, behind the contract of core/solve/system.h: kind
// "modal". Each piece has its own floating frame: the tip of a piece carries the frame of the next, which
// moves with the tip and exerts its root wrench on it. No acceleration crosses from piece to piece, so rates
// follow from two sweeps: motions outwards, wrenches inwards. One piece is the classic modal body.
//
// State: per piece q (m), then η (m). Ports, loads and the state of vertices are those of a rod
// (rod_system.h), but there are no follower loads.
#pragma once

#include "core/base/spatial.h"
#include "core/solve/system.h"
#include "flexbody/modal/modal.h"

// -- one piece ------------------------------------------------------------------------------------

// One modal piece at an instant: its rates, the wrench at its root, and their tangents. Given are the motion
// of its frame and the wrench of the next piece on its tip.
//
// The root wrench is the balance of momentum, P = C_tη and L_a = (C_a + G_a q)ᵀη about the frame's
// origin: external loads at the displaced vertices less the rate of P and L. So momentum is conserved with
// any number of shapes.

// The frame of a piece; twist and gravity in its own axes.
typedef struct bough_modal_frame {
    bough_vec3 velocity, spin, gravity;
    bough_transform pose; // in the body's frame
} bough_modal_frame;

// A change of the frame; its pose changes by exp(rotation) in its own axes only.
typedef struct bough_modal_frame_change {
    bough_vec3 velocity, spin, gravity, rotation;
} bough_modal_frame_change;

typedef struct bough_modal_point {
    const bough_modal_piece *piece;
    const double *q, *eta; // (m) where evaluated
    // computed by bough_modal_forward
    bough_modal_frame frame;
    double *rotating_q; // G_a q (3 × stride)
    double *rate_q;     // q̇ (stride)
    // of a piece that has an inner one
    bough_twist tip_shift, tip_rate; // displacement and rotation vector of the last vertex, their rates
    bough_mat3 tip_rotation;         // exp of that rotation vector
    bough_modal_frame tip;           // the last vertex': the next piece's frame
    // computed by bough_modal_backward
    bough_wrench outer;    // on the tip, in the tip's axes
    double *force;         // Φᵀf of vertex loads and outer wrench (stride)
    double *coefficient;   // of the fields (12)
    double *rate_eta;      // η̇ (stride)
    double *rotating_rate; // G_a q̇ (3 × stride)
    double *rest;          // C_tᵀg − η̇ (stride)
    bough_wrench root;     // on the carrier, in frame axes
    // computed by bough_modal_slopes
    double *lever;                         // moment of the forces about the frame's axes per unit of q
                                           // (3 × stride)
    double *rotating, *gyroscopic, *field; // combined (m × stride each)
    double *field_q, *gyroscopic_eta;      // of each field (12 × stride), of each axis (3 × stride)
    double *eta_rotating, *rest_rotating;  // ηᵀG_a and (C_tᵀg − η̇)ᵀG_a (3 × stride)
    double *force_by_rotation;             // of force per unit rotation of the frame (3 × stride)
    bough_vec3 moment_by_rotation[3];      // of the loads' moment, likewise
} bough_modal_point;

void bough_modal_point_init(bough_modal_point *point, bough_arena *arena, const bough_modal_piece *piece);

// From the frame and the state: q̇ and the tip.
void bough_modal_forward(bough_modal_point *point, const bough_modal_frame *frame, const double *q,
                         const double *eta);

// From the loads on the body's vertices (6 × load_stride, the body's axes) and the outer wrench: η̇
// and, if `root`, the root wrench.
void bough_modal_backward(bough_modal_point *point, const double *load, int load_stride, bough_wrench outer,
                          bool root);

// Prepares the tangents; after forward and backward (with the root).
void bough_modal_slopes(bough_modal_point *point, const double *load, int load_stride);

// Derivatives along dq, deta (m; both NULL for none) and a change of the frame (NULL for none): of q̇ to
// rate (m), and the tip's change.
void bough_modal_forward_tangent(const bough_modal_point *point, const double *dq, const double *deta,
                                 const bough_modal_frame_change *frame, double *rate,
                                 bough_modal_frame_change *tip);

// Further of η̇ to rate (m), with the outer wrench's change in the tip's axes and drate_q from
// the forward tangent; returns that of the root wrench.
bough_wrench bough_modal_backward_tangent(const bough_modal_point *point, const double *dq,
                                          const double *deta, const double *drate_q,
                                          const bough_modal_frame_change *frame, bough_wrench outer,
                                          double *rate);

// Displacement and rotation vector of moving vertex i = 1..n for modal coordinates, or their rates
// for rates, in frame axes.
bough_twist bough_modal_vertex(const bough_modal_piece *piece, int i, const double *q);

// exp(ψ)'s spin in the axes that ψ is resolved in: J(ψ) ψ̇.
bough_vec3 bough_modal_spin(bough_vec3 psi, bough_vec3 rate);

typedef struct bough_modal_model {
    const char *name;
    const bough_rod_model *rod; // the body's vertices and segments
    int n_piece;
    bough_modal_piece *piece; // (n_piece) from the root
    int *offset;              // of each piece in the state (n_piece)
    int n_state;
} bough_modal_model;

// Divides the rod into `pieces` of equally many segments, or of one more or less.
bough_status bough_modal_create(bough_arena *arena, const bough_rod_def *def, int pieces,
                                bough_modal_options options, bough_modal_model **model);

typedef struct bough_modal_body bough_modal_body;

// Builds the body in the arena. It starts at rest relative to its frame, which moves with `input` (9);
// tolerances are those of a rod for the vertex that a shape moves most.
bough_modal_body *bough_modal_body_create(bough_arena *arena, const bough_modal_model *model,
                                          const double *input);

// The contract's view; valid as long as the arena.
bough_system bough_modal_body_system(bough_modal_body *body);

const bough_modal_model *bough_modal_body_model(const bough_modal_body *body);

// The loads, to be changed between steps only; follower loads are not possible.
bough_rod_loads *bough_modal_body_loads(bough_modal_body *body);

// Sets η to that of a body at rest relative to its frame in the shape of the state, q̇ = 0.
void bough_modal_body_move_rigidly(bough_modal_body *body, const double *input, double *state);

// The state of vertices from `first` on, in a state of the body, as rod.h lays out that of a rod
// (13 n), absolute velocities for the frame's twist in `input`; valid until the next call.
const double *bough_modal_body_vertices(bough_modal_body *body, const double *state, const double *input,
                                        int first);
