// The kernel of one link of the chain: its shape, energy, forces and their derivative along a
// change of its two vertices. With x, R, u, Ω of the left (l) and right (r) vertex, hooks a and b:
//     y = x_r + R_r b − x_l − R_l a,   ℓ = |y|, n = y/ℓ, ℓ̇ = n·ẏ
//     d = p̄_l∘p_r∘d̄₀ = (w, v) = (cos θ/2, sin θ/2 n_θ),   sin θ n_θ = 2 w v
#ifndef BOUGH_TESTS_REFERENCE_CHAIN_LINK_H
#define BOUGH_TESTS_REFERENCE_CHAIN_LINK_H

#include "tests/reference/chain.h"

typedef struct chain_link {
    bough_chain_link link;
    double rest_length;         // ℓ₀ [m]
    bough_quaternion rest_turn; // d₀, left ← right vertex axes
} chain_link;

typedef struct link_shape {
    bough_mat3 l, r;       // R_l, R_r
    bough_vec3 wl, wr;     // Ω_l, Ω_r
    bough_vec3 n, ydot;    // direction, rate of y
    double length, rate;   // ℓ, ℓ̇
    bough_quaternion turn; // d
} link_shape;

// Derivatives along a change of the vertices.
typedef struct link_change {
    bough_vec3 turn_l, turn_r, wl, wr; // of the vertices, in their axes
    bough_vec3 n;
    double length, rate;
    bough_vec3 bend; // of sin θ n_θ, in left axes
} link_change;

typedef struct link_force {
    bough_wrench left, right; // generalised forces on the two vertices
} link_force;

static inline link_shape link_shape_of(const chain_link *k, const bough_vertex *l, const bough_vertex *r) {
    const bough_vec3 a = k->link.left, b = k->link.right;
    link_shape g = {.l = bough_rotation_matrix(l->rotation),
                    .r = bough_rotation_matrix(r->rotation),
                    .wl = l->spin,
                    .wr = r->spin};
    bough_vec3 hook_l = bough_add(l->position, bough_mat3_mul(g.l, a));
    bough_vec3 hook_r = bough_add(r->position, bough_mat3_mul(g.r, b));
    bough_vec3 rate_l = bough_add(l->velocity, bough_mat3_mul(g.l, bough_cross(g.wl, a)));
    bough_vec3 rate_r = bough_add(r->velocity, bough_mat3_mul(g.r, bough_cross(g.wr, b)));
    bough_vec3 y = bough_sub(hook_r, hook_l);
    g.ydot = bough_sub(rate_r, rate_l);
    g.length = bough_norm(y);
    g.n = bough_scale(1 / g.length, y);
    g.rate = bough_dot(g.n, g.ydot);
    bough_quaternion d = bough_quaternion_product(bough_quaternion_conjugate(l->rotation), r->rotation);
    g.turn = bough_quaternion_product(d, bough_quaternion_conjugate(k->rest_turn));
    return g;
}

static inline bough_vec3 turn_vector(bough_quaternion d) { return bough_v3(d.x, d.y, d.z); }

// c (1 − cos θ) = 2 c |v|²
static inline double link_energy(const chain_link *k, const link_shape *g) {
    double e = g->length - k->rest_length, square = e * e;
    bough_vec3 v = turn_vector(g->turn);
    return 0.5 * k->link.stiffness * square + 0.25 * k->link.hardening * square * square +
           2 * k->link.rotational_stiffness * bough_dot(v, v);
}

// A force f between the hooks, on the left vertex f, on the right one −f.
static inline link_force hook_force(const chain_link *k, const link_shape *g, bough_vec3 f) {
    bough_vec3 fl = bough_mat3_tmul(g->l, f), fr = bough_mat3_tmul(g->r, f);
    return (link_force){{f, bough_cross(k->link.left, fl)},
                        {bough_scale(-1, f), bough_cross(fr, k->link.right)}};
}

// Its derivative for δf = df: the moment arms turn with their vertices.
static inline link_force hook_force_change(const chain_link *k, const link_shape *g, const link_change *d,
                                           bough_vec3 f, bough_vec3 df) {
    link_force varied = hook_force(k, g, df);
    bough_vec3 fl = bough_cross(d->turn_l, bough_mat3_tmul(g->l, f));
    bough_vec3 fr = bough_cross(d->turn_r, bough_mat3_tmul(g->r, f));
    varied.left.moment = bough_sub(varied.left.moment, bough_cross(k->link.left, fl));
    varied.right.moment = bough_sub(varied.right.moment, bough_cross(fr, k->link.right));
    return varied;
}

static inline double spring_tension(const chain_link *k, const link_shape *g) {
    double e = g->length - k->rest_length;
    return e * (k->link.stiffness + k->link.hardening * e * e);
}

// c τ on the left vertex and −c D₀ᵀτ on the right one, τ = sin θ n_θ or its change
static inline link_force add_bending(const chain_link *k, bough_vec3 tau, link_force f) {
    bough_mat3 rest = bough_rotation_matrix(k->rest_turn);
    double c = k->link.rotational_stiffness;
    f.left.moment = bough_axpy(c, tau, f.left.moment);
    f.right.moment = bough_axpy(-c, bough_mat3_tmul(rest, tau), f.right.moment);
    return f;
}

static inline link_force link_elastic(const chain_link *k, const link_shape *g) {
    bough_vec3 tau = bough_scale(2 * g->turn.w, turn_vector(g->turn));
    return add_bending(k, tau, hook_force(k, g, bough_scale(spring_tension(k, g), g->n)));
}

// Angular velocities in the other vertex' axes.
static inline bough_vec3 left_seen_right(const link_shape *g, bough_vec3 wl) {
    return bough_mat3_tmul(g->r, bough_mat3_mul(g->l, wl));
}

static inline bough_vec3 right_seen_left(const link_shape *g, bough_vec3 wr) {
    return bough_mat3_tmul(g->l, bough_mat3_mul(g->r, wr));
}

static inline link_force link_viscous(const chain_link *k, const link_shape *g) {
    double b = k->link.rotational_damping;
    link_force f = hook_force(k, g, bough_scale(k->link.damping * g->rate, g->n));
    bough_vec3 left = bough_sub(right_seen_left(g, g->wr), g->wl);
    bough_vec3 right = bough_sub(left_seen_right(g, g->wl), g->wr);
    f.left.moment = bough_axpy(b, left, f.left.moment);
    f.right.moment = bough_axpy(b, right, f.right.moment);
    return f;
}

// -- derivatives ----------------------------------------------------------------------------------

// δ of the hook's place x + R a and of its velocity u + R (Ω×a)
static inline void hook_change(bough_mat3 r, bough_vec3 w, bough_vec3 a, const bough_vertex_change *c,
                               bough_vec3 *place, bough_vec3 *rate) {
    bough_vec3 carried = bough_add(bough_cross(c->turn, bough_cross(w, a)), bough_cross(c->spin, a));
    *place = bough_add(c->position, bough_mat3_mul(r, bough_cross(c->turn, a)));
    *rate = bough_add(c->velocity, bough_mat3_mul(r, carried));
}

// δ(2 w v) for d → d∘exp(ψ), ψ = D₀δφ_r − Dᵀδφ_l: δw = −½ v·ψ, δv = ½ (wψ + v×ψ)
static inline bough_vec3 bend_change(const chain_link *k, const link_shape *g, const bough_vertex_change *l,
                                     const bough_vertex_change *r) {
    bough_mat3 rest = bough_rotation_matrix(k->rest_turn), turn = bough_rotation_matrix(g->turn);
    bough_vec3 psi = bough_sub(bough_mat3_mul(rest, r->turn), bough_mat3_tmul(turn, l->turn));
    double w = g->turn.w;
    bough_vec3 v = turn_vector(g->turn);
    bough_vec3 twice = bough_axpy(w, psi, bough_cross(v, psi)); // 2 δv
    return bough_axpy(-bough_dot(v, psi), v, bough_scale(w, twice));
}

static inline link_change link_change_of(const chain_link *k, const link_shape *g,
                                         const bough_vertex_change *l, const bough_vertex_change *r) {
    link_change d = {.turn_l = l->turn, .turn_r = r->turn, .wl = l->spin, .wr = r->spin};
    bough_vec3 place_l, place_r, rate_l, rate_r;
    hook_change(g->l, g->wl, k->link.left, l, &place_l, &rate_l);
    hook_change(g->r, g->wr, k->link.right, r, &place_r, &rate_r);
    bough_vec3 dy = bough_sub(place_r, place_l);
    d.length = bough_dot(g->n, dy);
    d.n = bough_scale(1 / g->length, bough_axpy(-d.length, g->n, dy));
    d.rate = bough_dot(d.n, g->ydot) + bough_dot(g->n, bough_sub(rate_r, rate_l));
    d.bend = bend_change(k, g, l, r);
    return d;
}

static inline link_force link_elastic_change(const chain_link *k, const link_shape *g, const link_change *d) {
    double e = g->length - k->rest_length, tension = spring_tension(k, g);
    double slope = k->link.stiffness + 3 * k->link.hardening * e * e;
    bough_vec3 df = bough_axpy(slope * d->length, g->n, bough_scale(tension, d->n));
    link_force f = hook_force_change(k, g, d, bough_scale(tension, g->n), df);
    return add_bending(k, d->bend, f);
}

static inline link_force link_viscous_change(const chain_link *k, const link_shape *g, const link_change *d) {
    double b = k->link.rotational_damping, tension = k->link.damping * g->rate;
    bough_vec3 df = bough_axpy(k->link.damping * d->rate, g->n, bough_scale(tension, d->n));
    link_force f = hook_force_change(k, g, d, bough_scale(tension, g->n), df);
    // δ(R_lᵀ R_r Ω_r) = R_lᵀ R_r (δΩ_r + δφ_r×Ω_r) − δφ_l×(R_lᵀ R_r Ω_r), and l with r exchanged
    bough_vec3 carried_r = bough_add(d->wr, bough_cross(d->turn_r, g->wr));
    bough_vec3 carried_l = bough_add(d->wl, bough_cross(d->turn_l, g->wl));
    bough_vec3 turned_r = bough_cross(d->turn_l, right_seen_left(g, g->wr));
    bough_vec3 turned_l = bough_cross(d->turn_r, left_seen_right(g, g->wl));
    bough_vec3 left = bough_sub(bough_sub(right_seen_left(g, carried_r), turned_r), d->wl);
    bough_vec3 right = bough_sub(bough_sub(left_seen_right(g, carried_l), turned_l), d->wr);
    f.left.moment = bough_axpy(b, left, f.left.moment);
    f.right.moment = bough_axpy(b, right, f.right.moment);
    return f;
}

#endif
