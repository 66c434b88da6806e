#include "tests/reference/rod_structure.h"

#include "flexbody/rod/rod_elastic.h"
#include "tests/reference/lumped.h"
#include "tests/reference/rod_energy.h"

#include <string.h>

typedef struct rod_structure {
    const bough_rod_model *model;
    bough_lumped lumped;
} rod_structure;

// A segment between its vertices: what the kernel needs of it.
typedef struct segment {
    int n;
    double h, inverse;
    vertex_state left, right;
    segment_geometry shape;
} segment;

static bough_vec3 load3(const double *a, int s, int i) { return (bough_vec3){a[i], a[s + i], a[2 * s + i]}; }

static vertex_state state_of(const bough_vertex *v) {
    return (vertex_state){.x = v->position, .u = v->velocity, .w = v->spin, .p = v->rotation};
}

static vertex_variation variation_of(const bough_vertex_change *c) {
    return (vertex_variation){.x = c->position, .phi = c->turn, .u = c->velocity, .w = c->spin};
}

static segment segment_at(const bough_rod_model *m, const bough_vertex *vertex, int n) {
    segment g = {n,       m->length[n], m->inverse_length[n], state_of(vertex + n), state_of(vertex + n + 1),
                 {.w = 0}};
    g.shape = segment_shape(g.left, g.right, g.inverse);
    return g;
}

static strain strain_of(const bough_rod_model *m, const segment *g) {
    int s = m->stride;
    bough_vec3 v0 = load3(m->strain0, s, g->n), u0 = load3(m->strain0 + 3 * s, s, g->n);
    return (strain){bough_sub(g->shape.stretch, v0), bough_sub(bough_scale(g->inverse, g->shape.phi), u0)};
}

// Ĉ e of (4) and D̂ ė of (5)
static strain law_stress(const bough_rod_model *m, const segment *g) {
    return segment_stress(bough_rod_tile(m->stiffness, 21, g->n), bough_rod_tile(m->gradient, 35, g->n),
                          BOUGH_LANES, 0, strain_of(m, g));
}

static strain viscous_stress(const bough_rod_model *m, const segment *g) {
    strain rate = strain_rate(g->shape, segment_motion(g->shape, g->left, g->right), g->inverse);
    return symmetric_times(bough_rod_tile(m->damping, 21, g->n), BOUGH_LANES, 0, rate);
}

static strain law_stress_change(const bough_rod_model *m, const segment *g, const segment_variation *d) {
    strain change = {d->stretch, bough_scale(g->inverse, d->phi)};
    const double *c = bough_rod_tile(m->stiffness, 21, g->n), *l = bough_rod_tile(m->gradient, 35, g->n);
    elastic_state at = elastic_at(c, l, BOUGH_LANES, 0, strain_of(m, g));
    return elastic_variation(c, l, BOUGH_LANES, 0, at, change);
}

static strain viscous_stress_change(const bough_rod_model *m, const segment *g, const segment_variation *d,
                                    const vertex_variation *l, const vertex_variation *r) {
    segment_rate motion = segment_motion(g->shape, g->left, g->right);
    strain change = rate_variation(g->shape, motion, *d, l, r, g->inverse);
    return symmetric_times(bough_rod_tile(m->damping, 21, g->n), BOUGH_LANES, 0, change);
}

// A segment's forces onto its two vertices; the geometry holds up to 120° of relative rotation.
static bool add_segment(const segment *g, segment_force f, bough_wrench *left) {
    left[0].force = bough_add(left[0].force, f.f);
    left[1].force = bough_sub(left[1].force, f.f);
    left[0].moment = bough_add(left[0].moment, f.ll);
    left[1].moment = bough_add(left[1].moment, f.lr);
    return g->shape.w >= 0.5;
}

static void clear(const bough_rod_model *m, bough_wrench *force) {
    memset(force, 0, ((size_t)m->n_segment + 1) * sizeof *force);
}

static bool elastic(void *self, const bough_vertex *vertex, bough_wrench *force) {
    const bough_rod_model *m = ((const rod_structure *)self)->model;
    bool ok = true;
    clear(m, force);
    for (int n = 0; n < m->n_segment; n++) {
        segment g = segment_at(m, vertex, n);
        segment_force f = stress_force(g.shape, law_stress(m, &g), g.h);
        ok = add_segment(&g, f, force + n) && ok;
    }
    return ok;
}

static bool viscous(void *self, const bough_vertex *vertex, bough_wrench *force) {
    const bough_rod_model *m = ((const rod_structure *)self)->model;
    bool ok = true;
    clear(m, force);
    for (int n = 0; n < m->n_segment; n++) {
        segment g = segment_at(m, vertex, n);
        segment_force f = stress_force(g.shape, viscous_stress(m, &g), g.h);
        ok = add_segment(&g, f, force + n) && ok;
    }
    return ok;
}

static bool elastic_tangent(void *self, const bough_vertex *vertex, const bough_vertex_change *change,
                            bough_wrench *force_change) {
    const bough_rod_model *m = ((const rod_structure *)self)->model;
    bool ok = true;
    clear(m, force_change);
    for (int n = 0; n < m->n_segment; n++) {
        segment g = segment_at(m, vertex, n);
        vertex_variation l = variation_of(change + n), r = variation_of(change + n + 1);
        segment_variation d = shape_variation(g.shape, l, r, g.inverse);
        strain stress = law_stress(m, &g), varied = law_stress_change(m, &g, &d);
        segment_force f = force_variation(g.shape, d, stress, varied, g.h);
        ok = add_segment(&g, f, force_change + n) && ok;
    }
    return ok;
}

static bool viscous_tangent(void *self, const bough_vertex *vertex, const bough_vertex_change *change,
                            bough_wrench *force_change) {
    const bough_rod_model *m = ((const rod_structure *)self)->model;
    bool ok = true;
    clear(m, force_change);
    for (int n = 0; n < m->n_segment; n++) {
        segment g = segment_at(m, vertex, n);
        vertex_variation l = variation_of(change + n), r = variation_of(change + n + 1);
        segment_variation d = shape_variation(g.shape, l, r, g.inverse);
        strain stress = viscous_stress(m, &g), varied = viscous_stress_change(m, &g, &d, &l, &r);
        segment_force f = force_variation(g.shape, d, stress, varied, g.h);
        ok = add_segment(&g, f, force_change + n) && ok;
    }
    return ok;
}

static double elastic_energy(void *self, const bough_vertex *vertex) {
    const bough_rod_model *m = ((const rod_structure *)self)->model;
    double energy = 0;
    for (int n = 0; n < m->n_segment; n++) { // (4)
        segment g = segment_at(m, vertex, n);
        energy += g.h * segment_energy(bough_rod_tile(m->stiffness, 21, n),
                                       bough_rod_tile(m->gradient, 35, n), BOUGH_LANES, 0, strain_of(m, &g));
    }
    return energy;
}

static bool inertial(void *self, const bough_vertex *vertex, bough_wrench *force) {
    bough_lumped_inertial(&((rod_structure *)self)->lumped, vertex, force);
    return true;
}

static bool inertial_tangent(void *self, const bough_vertex *vertex, const bough_vertex_change *change,
                             bough_wrench *force_change) {
    bough_lumped_inertial_tangent(&((rod_structure *)self)->lumped, vertex, change, force_change);
    return true;
}

static void mass(void *self, const bough_vertex *vertex, double *block) {
    bough_lumped_mass(&((rod_structure *)self)->lumped, vertex, block);
}

static void mass_tangent(void *self, const bough_vertex *vertex, const bough_vertex_change *change,
                         const bough_twist *acceleration, bough_wrench *product) {
    bough_lumped_mass_tangent(&((rod_structure *)self)->lumped, vertex, change, acceleration, product);
}

static const bough_structure_ops rod_ops = {
    .elastic = {elastic, elastic_tangent},
    .viscous = {viscous, viscous_tangent},
    .inertial = {inertial, inertial_tangent},
    .elastic_energy = elastic_energy,
    .mass = mass,
    .mass_tangent = mass_tangent,
};

static bough_inertia inertia_of(const bough_vertex_inertia *v) {
    const double *j = v->inertia; // xx yy zz xy xz yz
    return (bough_inertia){v->mass, v->moment, {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}}};
}

bough_status bough_rod_structure_create(bough_arena *arena, const bough_rod_model *model,
                                        bough_structure **structure) {
    size_t n = (size_t)model->n_segment + 1;
    bough_structure *s = bough_arena_take(arena, sizeof *s);
    rod_structure *self = bough_arena_take(arena, sizeof *self);
    bough_inertia *inertia = bough_arena_take(arena, n * sizeof *inertia);
    bough_vertex *rest = bough_arena_take(arena, n * sizeof *rest);
    if (!s || !self || !inertia || !rest) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "rod %s: out of memory", model->name);
    }
    for (size_t i = 0; i < n; i++) {
        inertia[i] = inertia_of(&model->vertex[i]);
        rest[i].position = model->position0[i];
        rest[i].rotation = model->rotation0[i];
    }
    *self = (rod_structure){model, {(int)n, inertia}};
    *s = (bough_structure){model->name, (int)n, 0, rest, &rod_ops, self};
    *structure = s;
    return bough_ok();
}
