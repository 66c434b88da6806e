// (12)–(15): a structure's Newton–Euler equations in terms of the motion of its body reference
// frame (BRF) and of its vertices relative to it: the form in which a recursive multibody formalism
// takes any nodal body. The BRF is welded to the structure's reference vertex.
//
//     v̇_R = (R₀ᵀẍ₀, Ω̇₀)  acceleration of the BRF in its axes. The rate of the components of
//                        v_R = (R₀ᵀẋ₀, Ω₀), as the tree has it, is v̇_R − (Ω₀×R₀ᵀẋ₀, 0).
//     v̇_E = (…, x̂¨ₙ, ω̂˙ₙ, …)  of the other vertices by index, in BRF axes, 6 each
//
// It shows the equations rather than running them: every matrix is there to be read, and M_E's
// blocks are factored as they come. A rod's production path, rod.h, solves the same equations.
#ifndef BOUGH_TESTS_REFERENCE_BODY_FRAME_H
#define BOUGH_TESTS_REFERENCE_BODY_FRAME_H

#include "core/base/arena.h"
#include "tests/reference/structure.h"

// A vertex relative to the BRF, in BRF axes.
typedef struct bough_relative_vertex {
    bough_vec3 position;       // x̂ [m]
    bough_quaternion rotation; // p̂, BRF ← vertex axes
    bough_vec3 velocity;       // x̂˙ [m/s]
    bough_vec3 spin;           // ω̂ [rad/s]
} bough_relative_vertex;

// The BRF's motion as the tree gives it.
typedef struct bough_frame_motion {
    bough_twist twist;  // v_R [m/s, rad/s]
    bough_vec3 gravity; // in BRF axes [m/s²]
} bough_frame_motion;

// Matrices are row-major; 6×6 blocks have 36 doubles. Forces in N, moments in N m.
typedef struct bough_body_frame {
    const bough_structure *structure;
    // computed by bough_body_frame_evaluate: over all vertices, with the structure's coordinates
    bough_vertex *vertex; // (13) in BRF axes, absolute velocities
    double *f_r, *f_e;    // (14) F: blocks of v̇_R and of the vertex' own v̇_E (n_vertex × 36 each)
    double *g;            // (14) G (n_vertex × 6)
    double *mass;         // (11) (n_vertex × 36)
    double *force;        // right-hand side of (11) (n_vertex × 6)
    // the equations (12), n_E = 6 (n_vertex − 1)
    double m_r[36];
    double *s;          // S (n_E × 6)
    double *m_e;        // diagonal blocks of M_E (n_E/6 × 36)
    double *factor;     // their Cholesky factors (n_E/6 × 36)
    double h_r[6];      // with weight and the wrenches added
    double *h_e;        // (n_E)
    bough_wrench *term; // work (n_vertex)
} bough_body_frame;

// Takes the memory.
bool bough_body_frame_init(bough_body_frame *b, bough_arena *arena, const bough_structure *s);

// (13): n vertices in the frame in which the BRF has this pose; v_r in BRF axes.
void bough_body_frame_vertices(int n, const bough_transform *pose, bough_twist v_r,
                               const bough_relative_vertex *relative, bough_vertex *vertex);

// (13) undone for vertices in BRF axes with absolute velocities, the state of rod.h.
void bough_body_frame_relative(int n, bough_twist v_r, const bough_vertex *vertex,
                               bough_relative_vertex *relative);

// Sets up (12) without external wrenches. The reference vertex of `relative` (n_vertex) does not
// move. False when the structure has no force there or a vertex no positive mass.
bool bough_body_frame_evaluate(bough_body_frame *b, const bough_frame_motion *motion,
                               const bough_relative_vertex *relative);

// J_Rᵀ and J_Eᵀ of (12) for a wrench in BRF axes at an attachment, each 6×6: J_Eᵀ is the only
// non-zero block, rows 6 k to 6 k + 5 of v_E; returns k, or −1 at the reference vertex.
int bough_body_frame_jacobian(const bough_body_frame *b, const bough_attachment *at, double *j_r,
                              double *j_e);

// h_R += J_Rᵀ(f, l), h_E += J_Eᵀ(f, l)
void bough_body_frame_add_wrench(bough_body_frame *b, const bough_attachment *at, bough_wrench w);

// What the recursion passes down: M_R − SᵀM_E⁻¹S (6×6) and h_R − SᵀM_E⁻¹h_E (6).
void bough_body_frame_reduce(const bough_body_frame *b, double *inertia, double *force);

// v̇_E = M_E⁻¹(h_E − S v̇_R): v_e_rate (n_E)
void bough_body_frame_flexible(const bough_body_frame *b, const double *v_r_rate, double *v_e_rate);

// (14): a = F·(v̇_R, v̇_E) + G of every vertex (n_vertex): ẍ in BRF axes, Ω̇ in vertex axes.
void bough_body_frame_accelerations(const bough_body_frame *b, const double *v_r_rate, const double *v_e_rate,
                                    bough_twist *acceleration);

#endif
