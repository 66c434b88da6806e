// Spatial algebra in six dimensions, linear part first: twists (v, ω), wrenches (force, moment),
// rigid inertias and the placement of one frame in another. A twist belongs to the body's point
// at the origin of the frame it is expressed in; so does the moment of a wrench.
#pragma once

#include "core/base/vec3.h"

typedef struct bough_twist {
    bough_vec3 linear;  // v [m/s]
    bough_vec3 angular; // ω [rad/s]
} bough_twist;

typedef struct bough_wrench {
    bough_vec3 force;  // [N]
    bough_vec3 moment; // [N m]
} bough_wrench;

// The placement of a child frame in its parent frame: x_parent = position + rotation · x_child.
typedef struct bough_transform {
    bough_vec3 position; // [m]
    bough_mat3 rotation; // its columns are the child's axes
} bough_transform;

// A rigid body's inertia about the origin of a frame.
typedef struct bough_inertia {
    double mass;           // m [kg]
    bough_vec3 first;      // first moment m ζ, ζ the mass centre [kg m]
    bough_mat3 rotational; // about the origin, symmetric [kg m²]
} bough_inertia;

static inline bough_transform bough_transform_identity(void) {
    return (bough_transform){{0, 0, 0}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
}

// The placement of c in a, from b in a and c in b.
static inline bough_transform bough_transform_compose(bough_transform b, bough_transform c) {
    return (bough_transform){bough_add(b.position, bough_mat3_mul(b.rotation, c.position)),
                             bough_mat3_product(b.rotation, c.rotation)};
}

// The placement of the parent in the child.
static inline bough_transform bough_transform_inverse(bough_transform x) {
    return (bough_transform){bough_scale(-1, bough_mat3_tmul(x.rotation, x.position)),
                             bough_mat3_transpose(x.rotation)};
}

static inline bough_twist bough_twist_add(bough_twist a, bough_twist b) {
    return (bough_twist){bough_add(a.linear, b.linear), bough_add(a.angular, b.angular)};
}

static inline bough_wrench bough_wrench_add(bough_wrench a, bough_wrench b) {
    return (bough_wrench){bough_add(a.force, b.force), bough_add(a.moment, b.moment)};
}

static inline bough_wrench bough_wrench_sub(bough_wrench a, bough_wrench b) {
    return (bough_wrench){bough_sub(a.force, b.force), bough_sub(a.moment, b.moment)};
}

static inline bough_wrench bough_wrench_scale(double factor, bough_wrench f) {
    return (bough_wrench){bough_scale(factor, f.force), bough_scale(factor, f.moment)};
}

// X V: the parent frame's twist expressed in the child frame, at the child's origin.
static inline bough_twist bough_twist_to_child(const bough_transform *x, bough_twist t) {
    bough_vec3 at = bough_add(t.linear, bough_cross(t.angular, x->position));
    return (bough_twist){bough_mat3_tmul(x->rotation, at), bough_mat3_tmul(x->rotation, t.angular)};
}

// Xᵀ f: the child frame's wrench expressed in the parent frame, at the parent's origin.
static inline bough_wrench bough_wrench_to_parent(const bough_transform *x, bough_wrench w) {
    bough_vec3 force = bough_mat3_mul(x->rotation, w.force);
    bough_vec3 moment = bough_mat3_mul(x->rotation, w.moment);
    return (bough_wrench){force, bough_add(moment, bough_cross(x->position, force))};
}

// V × U: the rate of a twist U that is carried along by a frame moving with V.
static inline bough_twist bough_twist_cross(bough_twist v, bough_twist u) {
    return (bough_twist){bough_add(bough_cross(v.angular, u.linear), bough_cross(v.linear, u.angular)),
                         bough_cross(v.angular, u.angular)};
}

// V ×* f: the rate of a wrench (or momentum) f that is carried along by a frame moving with V.
static inline bough_wrench bough_wrench_cross(bough_twist v, bough_wrench f) {
    return (bough_wrench){bough_cross(v.angular, f.force),
                          bough_add(bough_cross(v.angular, f.moment), bough_cross(v.linear, f.force))};
}

// Vᵀ f: power [W]
static inline double bough_power(bough_twist v, bough_wrench f) {
    return bough_dot(v.linear, f.force) + bough_dot(v.angular, f.moment);
}

// I V: the momentum (m v + ω×mζ, I ω + mζ×v)
static inline bough_wrench bough_inertia_mul(const bough_inertia *i, bough_twist v) {
    return (bough_wrench){
        bough_add(bough_scale(i->mass, v.linear), bough_cross(v.angular, i->first)),
        bough_add(bough_mat3_mul(i->rotational, v.angular), bough_cross(i->first, v.linear))};
}

// I A + V ×* I V: the wrench that gives a body moving with V the rate A of V's components; with A − g in
// place of A, against its weight.
static inline bough_wrench bough_inertia_wrench(const bough_inertia *i, bough_twist a, bough_twist v) {
    return bough_wrench_add(bough_inertia_mul(i, a), bough_wrench_cross(v, bough_inertia_mul(i, v)));
}

// 2 (a·b) E − a bᵀ − b aᵀ; with a = b = x/√2 the inertia |x|²E − xxᵀ of a unit mass at x.
static inline bough_mat3 bough_steiner(bough_vec3 a, bough_vec3 b) {
    double d = 2 * bough_dot(a, b), xy = -a.x * b.y - b.x * a.y, yz = -a.y * b.z - b.y * a.z,
           zx = -a.z * b.x - b.z * a.x;
    return (bough_mat3){
        {d - 2 * a.x * b.x, xy, zx}, {xy, d - 2 * a.y * b.y, yz}, {zx, yz, d - 2 * a.z * b.z}};
}

static inline bough_mat3 bough_mat3_add(bough_mat3 a, bough_mat3 b) {
    return (bough_mat3){bough_add(a.c1, b.c1), bough_add(a.c2, b.c2), bough_add(a.c3, b.c3)};
}

static inline bough_inertia bough_inertia_add(bough_inertia a, bough_inertia b) {
    return (bough_inertia){a.mass + b.mass, bough_add(a.first, b.first),
                           bough_mat3_add(a.rotational, b.rotational)};
}

// The inertia of a mass [kg] at `centre` [m], from that about its centre [kg m²] as in theory (10).
static inline bough_inertia bough_inertia_of(double mass, bough_vec3 centre, bough_mat3 about) {
    bough_vec3 first = bough_scale(mass, centre);
    return (bough_inertia){mass, first,
                           bough_mat3_add(about, bough_steiner(bough_scale(0.5, first), centre))};
}

// Xᵀ I X: the child frame's inertia expressed in the parent frame, about the parent's origin.
static inline bough_inertia bough_inertia_to_parent(const bough_transform *x, bough_inertia i) {
    bough_vec3 first = bough_mat3_mul(x->rotation, i.first);
    // Σ m (|ρ|²E − ρρᵀ) with ρ = r + R ρ'
    bough_vec3 arm = bough_axpy(0.5 * i.mass, x->position, first);
    bough_mat3 turned =
        bough_mat3_product(x->rotation, bough_mat3_product(i.rotational, bough_mat3_transpose(x->rotation)));
    return (bough_inertia){i.mass, bough_axpy(i.mass, x->position, first),
                           bough_mat3_add(turned, bough_steiner(arm, x->position))};
}

// Six components in the order of the ports: linear (force) first.
static inline void bough_twist_store(bough_twist t, double *out) {
    out[0] = t.linear.x, out[1] = t.linear.y, out[2] = t.linear.z;
    out[3] = t.angular.x, out[4] = t.angular.y, out[5] = t.angular.z;
}

static inline bough_twist bough_twist_load(const double *in) {
    return (bough_twist){{in[0], in[1], in[2]}, {in[3], in[4], in[5]}};
}

// 1 in component k, linear before angular.
static inline bough_twist bough_twist_unit(int k) {
    double e[6] = {0};
    e[k] = 1;
    return bough_twist_load(e);
}

static inline void bough_wrench_store(bough_wrench w, double *out) {
    out[0] = w.force.x, out[1] = w.force.y, out[2] = w.force.z;
    out[3] = w.moment.x, out[4] = w.moment.y, out[5] = w.moment.z;
}

static inline bough_wrench bough_wrench_load(const double *in) {
    return (bough_wrench){{in[0], in[1], in[2]}, {in[3], in[4], in[5]}};
}
