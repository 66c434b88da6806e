// What the tree asks of a nonlinear structural model with nodes: mass, elastic, viscous and
// inertial forces of its vertices, each by itself, and their tangents. Whoever fills in this table
// has the equations of a flexible body by body_frame.h, which knows nothing else of the model.
//
// Vertices are given in the axes of any inertial frame, so the model needs no word of moving
// frames. At an instant that frame may coincide with a moving one: with the body reference frame's
// (BRF) axes and absolute velocities the coordinates are those of rod.h (x, p, u, W).
// Generalised forces and accelerations go with the velocities (ẋ, Ω): linear parts in the frame's
// axes, moments and Ω̇ in vertex axes, as in (11).
#ifndef BOUGH_TESTS_REFERENCE_STRUCTURE_H
#define BOUGH_TESTS_REFERENCE_STRUCTURE_H

#include "core/base/rotation.h"
#include "core/base/spatial.h"

#include <stdbool.h>

typedef struct bough_vertex {
    bough_vec3 position;       // x [m]
    bough_quaternion rotation; // p, frame ← vertex axes, of norm 1
    bough_vec3 velocity;       // ẋ [m/s]
    bough_vec3 spin;           // Ω = Rᵀω, in vertex axes [rad/s]
} bough_vertex;

// A small change of a vertex; its rotation becomes p∘exp(turn), turn in vertex axes [rad].
typedef struct bough_vertex_change {
    bough_vec3 position, turn, velocity, spin;
} bough_vertex_change;

// One kind of generalised force; arrays are over all vertices (n_vertex).
typedef struct bough_structure_term {
    // False when the model has no force there (for instance a mesh turned too far).
    bool (*force)(void *self, const bough_vertex *vertex, bough_wrench *force);

    // The force's derivative along a change of the vertices: the tangent times a vector.
    bool (*tangent)(void *self, const bough_vertex *vertex, const bough_vertex_change *change,
                    bough_wrench *force_change);
} bough_structure_term;

typedef struct bough_structure_ops {
    bough_structure_term elastic;  // −∂(4)/∂q
    bough_structure_term viscous;  // of (5)
    bough_structure_term inertial; // gyroscopic and centrifugal: right-hand side of (11)

    // [J] whose negative gradient are the elastic forces.
    double (*elastic_energy)(void *self, const bough_vertex *vertex);

    // M of (10) or (11), masses lumped at the vertices: mass (n_vertex × 6 × 6), row-major, acts on
    // (ẍ, Ω̇) of its vertex [kg, kg m, kg m²].
    void (*mass)(void *self, const bough_vertex *vertex, double *mass);

    // (δM) a along a change of the vertices, for given accelerations a (n_vertex).
    void (*mass_tangent)(void *self, const bough_vertex *vertex, const bough_vertex_change *change,
                         const bough_twist *acceleration, bough_wrench *product);
} bough_structure_ops;

typedef struct bough_structure {
    const char *name;
    int n_vertex;
    int reference;            // the vertex that is welded to the BRF
    const bough_vertex *rest; // undeformed and at rest, in BRF axes from its origin (n_vertex)
    const bough_structure_ops *ops;
    void *self;
} bough_structure;

// A point carried rigidly by a vertex: where a joint, a constraint or a load acts.
typedef struct bough_attachment {
    int vertex;
    bough_vec3 arm; // from the vertex, in vertex axes [m]
} bough_attachment;

// Jᵀ(f, l): the generalised force on the attachment's vertex of a wrench at the attachment, the
// wrench in the frame's axes.
static inline bough_wrench bough_attachment_force(const bough_attachment *at, const bough_vertex *vertex,
                                                  bough_wrench w) {
    bough_mat3 r = bough_rotation_matrix(vertex[at->vertex].rotation);
    bough_vec3 lever = bough_cross(at->arm, bough_mat3_tmul(r, w.force));
    return (bough_wrench){w.force, bough_add(bough_mat3_tmul(r, w.moment), lever)};
}

#endif
