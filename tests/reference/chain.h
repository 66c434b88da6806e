// A chain of small rigid bodies, the second structure beside the rod. Neighbours are joined by a
// hardening spring with damper between hooks on the two bodies, tension
//     N = k e + k₃ e³ + d ℓ̇,   e = ℓ − ℓ₀, ℓ the distance of the hooks,
// and by a rotational spring and damper: moment c sin θ n for the relative rotation θ n against the
// undeformed one (energy c (1 − cos θ)), and b times the relative angular velocity.
// Hooks on the vertices themselves give point masses on springs; their rotations are then a chain
// of their own, so every body needs some rotary inertia.
#ifndef BOUGH_TESTS_REFERENCE_CHAIN_H
#define BOUGH_TESTS_REFERENCE_CHAIN_H

#include "core/base/arena.h"
#include "core/base/status.h"
#include "tests/reference/structure.h"

typedef struct bough_chain_link {
    bough_vec3 left, right;      // hooks, in the axes of the two vertices from their origins [m]
    double stiffness, hardening; // k, k₃ [N/m, N/m³]
    double damping;              // d [N s/m]
    double rotational_stiffness; // c [N m]
    double rotational_damping;   // b [N m s]
} bough_chain_link;

// Link i joins vertices i and i + 1; its springs are relaxed in the undeformed chain.
typedef struct bough_chain_def {
    const char *name;
    int n_link;
    int reference;                // the vertex that is welded to the BRF, 0..n_link
    const bough_chain_link *link; // (n_link)
    const bough_vertex *rest;     // undeformed and at rest, in the BRF (n_link + 1)
    const bough_inertia *inertia; // in vertex axes about the vertex (n_link + 1)
} bough_chain_def;

// Builds the chain, which copies its definition. BOUGH_INVALID names the vertex or link that is
// not usable. A force does not exist where two hooks coincide.
bough_status bough_chain_create(bough_arena *arena, const bough_chain_def *def, bough_structure **structure);

#endif
