// Builds the chain and sums its links' forces over the vertices; one link: chain_link.h.
#include "tests/reference/chain.h"

#include "core/base/linalg.h"
#include "tests/reference/chain_link.h"
#include "tests/reference/lumped.h"

#include <string.h>

typedef struct chain {
    int n; // links
    const chain_link *link;
    bough_lumped lumped;
} chain;

static void add_pair(bough_wrench *vertex, link_force f) {
    vertex[0] = bough_wrench_add(vertex[0], f.left);
    vertex[1] = bough_wrench_add(vertex[1], f.right);
}

// One link's force, and its derivative.
typedef link_force link_function(const chain_link *k, const link_shape *g);
typedef link_force link_derivative(const chain_link *k, const link_shape *g, const link_change *change);

static bool sum_forces(const chain *c, const bough_vertex *vertex, link_function *force_of,
                       bough_wrench *force) {
    bool ok = true;
    memset(force, 0, ((size_t)c->n + 1) * sizeof *force);
    for (int i = 0; i < c->n; i++) {
        link_shape g = link_shape_of(c->link + i, vertex + i, vertex + i + 1);
        add_pair(force + i, force_of(c->link + i, &g));
        ok = ok && g.length > 0;
    }
    return ok;
}

static bool sum_tangents(const chain *c, const bough_vertex *vertex, const bough_vertex_change *change,
                         link_derivative *derivative_of, bough_wrench *force) {
    bool ok = true;
    memset(force, 0, ((size_t)c->n + 1) * sizeof *force);
    for (int i = 0; i < c->n; i++) {
        link_shape g = link_shape_of(c->link + i, vertex + i, vertex + i + 1);
        link_change d = link_change_of(c->link + i, &g, change + i, change + i + 1);
        add_pair(force + i, derivative_of(c->link + i, &g, &d));
        ok = ok && g.length > 0;
    }
    return ok;
}

static bool elastic(void *self, const bough_vertex *vertex, bough_wrench *force) {
    return sum_forces(self, vertex, link_elastic, force);
}

static bool elastic_tangent(void *self, const bough_vertex *vertex, const bough_vertex_change *change,
                            bough_wrench *force_change) {
    return sum_tangents(self, vertex, change, link_elastic_change, force_change);
}

static bool viscous(void *self, const bough_vertex *vertex, bough_wrench *force) {
    return sum_forces(self, vertex, link_viscous, force);
}

static bool viscous_tangent(void *self, const bough_vertex *vertex, const bough_vertex_change *change,
                            bough_wrench *force_change) {
    return sum_tangents(self, vertex, change, link_viscous_change, force_change);
}

static double elastic_energy(void *self, const bough_vertex *vertex) {
    const chain *c = self;
    double energy = 0;
    for (int i = 0; i < c->n; i++) {
        link_shape g = link_shape_of(c->link + i, vertex + i, vertex + i + 1);
        energy += link_energy(c->link + i, &g);
    }
    return energy;
}

static bool inertial(void *self, const bough_vertex *vertex, bough_wrench *force) {
    bough_lumped_inertial(&((chain *)self)->lumped, vertex, force);
    return true;
}

static bool inertial_tangent(void *self, const bough_vertex *vertex, const bough_vertex_change *change,
                             bough_wrench *force_change) {
    bough_lumped_inertial_tangent(&((chain *)self)->lumped, vertex, change, force_change);
    return true;
}

static void mass(void *self, const bough_vertex *vertex, double *block) {
    bough_lumped_mass(&((chain *)self)->lumped, vertex, block);
}

static void mass_tangent(void *self, const bough_vertex *vertex, const bough_vertex_change *change,
                         const bough_twist *acceleration, bough_wrench *product) {
    bough_lumped_mass_tangent(&((chain *)self)->lumped, vertex, change, acceleration, product);
}

static const bough_structure_ops chain_ops = {
    .elastic = {elastic, elastic_tangent},
    .viscous = {viscous, viscous_tangent},
    .inertial = {inertial, inertial_tangent},
    .elastic_energy = elastic_energy,
    .mass = mass,
    .mass_tangent = mass_tangent,
};

// -- build ----------------------------------------------------------------------------------------

static bool usable(const bough_chain_link *k) {
    return k->stiffness > 0 && k->hardening >= 0 && k->damping >= 0 && k->rotational_stiffness >= 0 &&
           k->rotational_damping >= 0;
}

static bough_status set_link(const bough_chain_def *def, int i, chain_link *k) {
    const bough_vertex *l = &def->rest[i], *r = &def->rest[i + 1];
    if (!usable(&def->link[i])) {
        return bough_fail(BOUGH_INVALID,
                          "chain %s: link %d needs a positive stiffness and no other"
                          " coefficient below 0",
                          def->name, i + 1);
    }
    k->link = def->link[i];
    k->rest_turn = bough_quaternion_identity();
    link_shape g = link_shape_of(k, l, r);
    if (!(g.length > 0)) {
        return bough_fail(BOUGH_INVALID, "chain %s: the hooks of link %d coincide", def->name, i + 1);
    }
    k->rest_length = g.length;
    k->rest_turn = g.turn;
    return bough_ok();
}

static bough_status check_vertices(const bough_chain_def *def) {
    if (def->n_link < 1) {
        return bough_fail(BOUGH_INVALID, "chain %s: needs at least one link", def->name);
    }
    if (def->reference < 0 || def->reference > def->n_link) {
        return bough_fail(BOUGH_INVALID,
                          "chain %s: %d links and reference vertex %d; the vertices"
                          " are 0 to %d",
                          def->name, def->n_link, def->reference, def->n_link);
    }
    for (int i = 0; i <= def->n_link; i++) {
        double block[36];
        bough_lumped one = {1, &def->inertia[i]};
        bough_lumped_mass(&one, &def->rest[i], block);
        if (!bough_cholesky_factor(6, block)) {
            return bough_fail(BOUGH_INVALID,
                              "chain %s: the inertia of vertex %d is not positive"
                              " definite",
                              def->name, i);
        }
    }
    return bough_ok();
}

bough_status bough_chain_create(bough_arena *arena, const bough_chain_def *def, bough_structure **structure) {
    bough_status status = check_vertices(def);
    if (!bough_is_ok(&status)) return status;
    size_t n = (size_t)def->n_link + 1;
    bough_structure *s = bough_arena_take(arena, sizeof *s);
    chain *self = bough_arena_take(arena, sizeof *self);
    chain_link *link = bough_arena_take(arena, (n - 1) * sizeof *link);
    bough_inertia *inertia = bough_arena_take(arena, n * sizeof *inertia);
    bough_vertex *rest = bough_arena_take(arena, n * sizeof *rest);
    const char *name = bough_arena_string(arena, def->name);
    for (int i = 0; i < def->n_link; i++) {
        status = set_link(def, i, link + i);
        if (!bough_is_ok(&status)) return status;
    }
    memcpy(inertia, def->inertia, n * sizeof *inertia);
    memcpy(rest, def->rest, n * sizeof *rest);
    *self = (chain){def->n_link, link, {(int)n, inertia}};
    *s = (bough_structure){name, (int)n, def->reference, rest, &chain_ops, self};
    *structure = s;
    return bough_ok();
}
