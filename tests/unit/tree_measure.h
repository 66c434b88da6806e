// Sums, mass matrix and closures' errors of a tree, for tests. All are taken after
// bough_tree_kinematics at the same state.
#pragma once

#include "core/tree/loop.h"

#include <assert.h>

// Sums over the moving links. Potential energy is zero with all mass centres in the ground's origin
// plane normal to gravity; angular momentum is about the ground's origin, in ground axes.
typedef struct tree_sums {
    double mass;                 // [kg]
    double kinetic, potential;   // [J]
    double elastic;              // of springs and bushings [J]
    bough_vec3 linear_momentum;  // [kg m/s]
    bough_vec3 angular_momentum; // [kg m²/s]
    bough_vec3 mass_centre;      // in the ground [m]
} tree_sums;

static inline tree_sums tree_sum(const bough_tree *tree, const bough_tree_data *data) {
    tree_sums s = {0};
    bough_vec3 first = {0, 0, 0};
    for (int i = 0; i < tree->n_links; i++) {
        const bough_inertia *inertia = &tree->links[i].inertia;
        bough_wrench momentum = bough_inertia_mul(inertia, data->twist[i]);
        bough_wrench ground = bough_wrench_to_parent(&data->pose[i], momentum);
        s.mass += inertia->mass;
        s.kinetic += 0.5 * bough_power(data->twist[i], momentum);
        s.linear_momentum = bough_add(s.linear_momentum, ground.force);
        s.angular_momentum = bough_add(s.angular_momentum, ground.moment);
        first = bough_add(first, bough_inertia_to_parent(&data->pose[i], *inertia).first);
    }
    s.elastic = data->elastic;
    s.potential = -bough_dot(tree->gravity, first);
    if (s.mass > 0) s.mass_centre = bough_scale(1 / s.mass, first);
    return s;
}

// Column k of link i of M: the wrench of a unit speed, felt by the link's own joint and its
// ancestors'; `composite`: the inertia of the link and all that it carries.
static inline void tree_mass_column(const bough_tree *tree, const bough_tree_data *d, bough_inertia composite,
                                    int i, int k, double *mass) {
    const bough_link *link = &tree->links[i];
    int n = tree->n_v, row = link->first_speed + k;
    double unit[BOUGH_JOINT_SPEEDS] = {0};
    unit[k] = 1;
    bough_wrench f = bough_inertia_mul(&composite, bough_joint_twist(&link->joint, unit));
    for (int j = i; j >= 0; j = tree->links[j].parent) {
        const bough_link *at = &tree->links[j];
        double felt[BOUGH_JOINT_SPEEDS];
        bough_joint_force(&at->joint, f, felt);
        for (int c = 0; c < at->n_speeds; c++) {
            mass[n * row + at->first_speed + c] = felt[c];
            mass[n * (at->first_speed + c) + row] = felt[c];
        }
        f = bough_wrench_to_parent(&d->relative[j], f);
    }
}

// M(q) (n_v × n_v), symmetric, by composite rigid bodies.
static inline void tree_mass_matrix(const bough_tree *tree, const bough_tree_data *d, double *mass) {
    enum { MOST_LINKS = 64 };
    bough_inertia composite[MOST_LINKS];
    assert(tree->n_links <= MOST_LINKS);
    memset(mass, 0, (size_t)tree->n_v * (size_t)tree->n_v * sizeof(double));
    for (int i = 0; i < tree->n_links; i++) composite[i] = tree->links[i].inertia;
    for (int i = tree->n_links - 1; i >= 0; i--) {
        const bough_link *link = &tree->links[i];
        for (int k = 0; k < link->n_speeds; k++) tree_mass_column(tree, d, composite[i], i, k, mass);
        if (link->parent < 0) continue;
        bough_inertia *up = &composite[link->parent];
        *up = bough_inertia_add(*up, bough_inertia_to_parent(&d->relative[i], composite[i]));
    }
}

// How far a closure is from being satisfied: the largest of its equations [m, –] and of their
// rates [m/s, 1/s].
static inline void tree_closure_error(const bough_tree *tree, bough_tree_data *d, int closure, double *value,
                                      double *rate) {
    const bough_closure *c = &tree->closures[closure];
    bough_loops_rows(tree, d);
    *value = *rate = 0;
    for (int k = c->first_row; k < c->first_row + bough_constraint_n_rows(&c->constraint); k++) {
        *value = fmax(*value, fabs(d->loops->row[k].value));
        *rate = fmax(*rate, fabs(d->loops->row[k].rate));
    }
}

// Index of a body by name; -1 when there is none.
static inline int tree_find_body(const bough_tree *tree, const char *name) {
    int i = tree->n_bodies - 1;
    while (i >= 0 && strcmp(tree->bodies[i].name, name) != 0) i--;
    return i;
}
