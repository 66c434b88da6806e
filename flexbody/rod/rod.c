// Builds the constant rod model from its discretised definition.
#include "flexbody/rod/rod.h"

#include "core/base/linalg.h"
#include "core/base/spatial.h"
#include "flexbody/rod/rod_segment.h"

// Arrays over segments and vertices.
static void take_arrays(bough_rod_model *m, bough_arena *arena) {
    size_t s = (size_t)m->stride;
    bough_arena_each(arena, s, &m->length, &m->inverse_length, &m->mass);
    bough_arena_each(arena, 6 * s, &m->strain0, &m->inertia);
    bough_arena_each(arena, 3 * s, &m->bend0, &m->moment);
    bough_arena_each(arena, 21 * s, &m->stiffness, &m->damping, &m->inverse_mass);
    m->line = bough_arena_doubles(arena, 72 * s);
    m->gradient = bough_arena_doubles(arena, 35 * s);
}

// h²/12 times the change of curvature along a segment, F m' + F' m (rod_elastic.h): L by the strains,
// G = h²/12 F by m', and R.
static void set_gradient(bough_rod_model *m, const bough_rod_def *def, int n, const double *compliance) {
    const double *c = def->stiffness + 21 * n, *u = m->strain0 + 3 * m->stride + n;
    double *gradient = bough_rod_tile(m->gradient, 35, n);
    double h = def->span[n + 1] - def->span[n], part = h * h / 12;
    double x = u[0], y = u[m->stride], z = u[2 * m->stride], stiffest = 0, softest = 0;
    const double turned[3][3] = {{0, z, -y}, {-z, 0, x}, {y, -x, 0}}; // m×κ⁰
    for (int i = 0; i < 3; i++) {
        // row i of the bending compliance F
        double f[3];
        for (int j = 0; j < 3; j++) f[j] = compliance[bough_symmetric6_index(3 + i, 3 + j)];
        // F m' + F' m by the stress (n, m): m' = −t×n + m×κ⁰, and F' from the taper of the sections
        double change[6] = {-f[1], f[0]};
        for (int j = 0; j < 3; j++) {
            change[3 + j] = def->taper ? def->taper[9 * n + 3 * i + j] : 0;
            for (int k = 0; k < 3; k++) change[3 + j] += f[k] * turned[k][j];
        }
        // L, by the strains: the stress is C e
        for (int j = 0; j < 6; j++) {
            double sum = 0;
            for (int k = 0; k < 6; k++) sum += change[k] * c[bough_symmetric6_index(k, j)];
            gradient[(6 * i + j) * BOUGH_LANES] = part * sum;
        }
        for (int j = i; j < 3; j++) {
            gradient[(18 + (i == 0 ? j : i + j + 1)) * BOUGH_LANES] = part * f[j];
        }
        stiffest += c[bough_symmetric6_index(3 + i, 3 + i)];
        softest += f[i];
    }
    // R, at least h²/12 times the ratio of the largest to the least bending stiffness; then B
    gradient[24 * BOUGH_LANES] = part * stiffest * softest;
    for (int k = 0; k < 10 && def->bow != NULL; k++) gradient[(25 + k) * BOUGH_LANES] = def->bow[10 * n + k];
}

// Segment n of the model; refuses one without length or stiffness, or that is too coarse.
static bough_status set_segment(bough_rod_model *m, const bough_rod_def *def, int n) {
    int s = m->stride;
    double h = def->span[n + 1] - def->span[n], compliance[21];
    if (!(h > 0)) {
        return bough_fail(BOUGH_INVALID, "rod %s: segment %d has length %g m", m->name, n + 1, h);
    }
    if (!bough_symmetric6_inverse(def->stiffness + 21 * n, compliance)) {
        return bough_fail(BOUGH_INVALID,
                          "rod %s: the stiffness of segment %d is not positive"
                          " definite",
                          m->name, n + 1);
    }
    // lengths and section matrices
    m->length[n] = h;
    m->inverse_length[n] = 1 / h;
    for (int k = 0; k < 21; k++) {
        bough_rod_tile(m->stiffness, 21, n)[k * BOUGH_LANES] = def->stiffness[21 * n + k];
        bough_rod_tile(m->damping, 21, n)[k * BOUGH_LANES] = def->damping[21 * n + k];
    }
    for (int k = 0; k < 72 && def->line != NULL; k++) m->line[k * s + n] = def->line[72 * n + k];
    // the undeformed shape: strains e⁰, and the change of the tangent, in the axes of the middle
    const bough_quaternion *p = def->rotation + n;
    segment_geometry shape = shape_between(def->position + n, p, 1 / h);
    if (shape.w < 0.5) {
        return bough_fail(BOUGH_INVALID,
                          "rod %s: the undeformed section rotates by more than 120°"
                          " over segment %d; use more segments",
                          m->name, n + 1);
    }
    bough_vec3 bend = bough_sub(bough_rotation_matrix(p[1]).c3, bough_rotation_matrix(p[0]).c3);
    bend = bough_mat3_tmul(shape.r, bend);
    const double bend0[3] = {bend.x, bend.y, bend.z};
    for (int k = 0; k < 3; k++) m->bend0[k * s + n] = bend0[k];
    const double e0[6] = {shape.stretch.x, shape.stretch.y, shape.stretch.z,
                          shape.phi.x / h, shape.phi.y / h, shape.phi.z / h};
    for (int k = 0; k < 6; k++) m->strain0[k * s + n] = e0[k];
    set_gradient(m, def, n, compliance);
    return bough_ok();
}

void bough_vertex_mass(const bough_vertex_inertia *v, double upper[21]) {
    const double *j = v->inertia;
    bough_vec3 s = v->moment;
    const double rows[21] = {v->mass, 0,   0,    0, s.z,  -s.y, v->mass, 0,    -s.z, 0,   s.x,
                             v->mass, s.y, -s.x, 0, j[0], j[3], j[4],    j[1], j[5], j[2]};
    memcpy(upper, rows, sizeof rows);
}

static double vertex_energy(const bough_vertex_inertia *v, bough_vec3 velocity, bough_vec3 angular) {
    bough_inertia inertia = {v->mass, v->moment, bough_mat3_symmetric(v->inertia)};
    bough_twist twist = {velocity, angular};
    return bough_power(twist, bough_inertia_mul(&inertia, twist));
}

double bough_rod_energy(const bough_rod_model *m, const double *state, const double *velocity) {
    double sum = 0;
    int n = m->n;
    for (int i = 0; i < n; i++) {
        const double *d = velocity + i;
        bough_vec3 u = bough_mat3_tmul(bough_rod_rotation(state, n, i), bough_v3(d[0], d[n], d[2 * n]));
        bough_vec3 w = {d[3 * n], d[4 * n], d[5 * n]};
        sum += vertex_energy(&m->vertex[i + 1], u, w);
    }
    return sum;
}

// Mass, first moment and inertia of vertex i, and the inverse of its 6×6 mass.
static bough_status set_vertex(bough_rod_model *m, const bough_rod_def *def, int i) {
    int s = m->stride;
    const bough_vertex_inertia *v = &def->inertia[i];
    double mass[21], inverse[21];
    bough_vertex_mass(v, mass);
    if (!bough_symmetric6_inverse(mass, inverse)) {
        return bough_fail(BOUGH_INVALID,
                          "rod %s: the inertia of vertex %d is not positive"
                          " definite",
                          m->name, i);
    }
    for (int k = 0; k < 21; k++) bough_rod_tile(m->inverse_mass, 21, i - 1)[k * BOUGH_LANES] = inverse[k];
    for (int k = 0; k < 6; k++) m->inertia[k * s + i - 1] = v->inertia[k];
    m->mass[i - 1] = v->mass;
    m->moment[i - 1] = v->moment.x;
    m->moment[s + i - 1] = v->moment.y;
    m->moment[2 * s + i - 1] = v->moment.z;
    return bough_ok();
}

bough_status bough_rod_create(bough_arena *arena, const bough_rod_def *def, bough_rod_model **model) {
    bough_rod_model *m = bough_arena_take(arena, sizeof *m);
    m->name = bough_arena_string(arena, def->name);
    m->level = bough_level_chosen();
    m->sections = def->sections;
    m->n_segment = def->n_segment;
    m->n = def->carries ? def->n_segment - 1 : def->n_segment;
    if (m->n < 1) {
        return bough_fail(BOUGH_INVALID, "rod %s: %d segments; a rod%s has at least %d", m->name,
                          m->n_segment, def->carries ? " that carries bodies" : "", def->carries ? 2 : 1);
    }
    m->stride = bough_padded(m->n_segment + BOUGH_LANES); // vertices go by lanes from 1 on
    take_arrays(m, arena);
    // the undeformed line
    size_t vertices = (size_t)m->n_segment + 1;
    m->span = bough_arena_copy(arena, def->span, vertices * sizeof *m->span);
    m->position0 = bough_arena_copy(arena, def->position, vertices * sizeof *m->position0);
    m->rotation0 = bough_arena_copy(arena, def->rotation, vertices * sizeof *m->rotation0);
    m->root = bough_rotation_matrix(m->rotation0[0]);
    // inertia and segments
    m->vertex = bough_arena_copy(arena, def->inertia, vertices * sizeof *m->vertex);
    for (int n = 0; n < m->n_segment; n++) {
        BOUGH_TRY(set_segment(m, def, n));
        BOUGH_TRY(set_vertex(m, def, n + 1));
    }
    *model = m;
    return bough_ok();
}

// Vertex 1 begins a register; vertex 0 is the last entry of the register before.
double *bough_rod_vertex_rows(bough_arena *arena, const bough_rod_model *model, int rows) {
    size_t room = (size_t)rows * (size_t)model->stride + BOUGH_LANES;
    return bough_arena_doubles(arena, room) + BOUGH_LANES - 1;
}

void bough_rod_scratch_init(bough_rod_scratch *scratch, bough_arena *arena, const bough_rod_model *model) {
    size_t s = (size_t)model->stride;
    *scratch = (bough_rod_scratch){.vertex = bough_rod_vertex_rows(arena, model, BOUGH_ROD_STATES),
                                   .segment = bough_arena_doubles(arena, 9 * s),
                                   .load = bough_rod_vertex_rows(arena, model, 6),
                                   .follower = bough_rod_vertex_rows(arena, model, 6),
                                   .following = bough_arena_doubles(arena, 3 * s),
                                   .rest = model->strain0,
                                   .along = bough_arena_doubles(arena, 12 * s),
                                   .own_rest = bough_arena_doubles(arena, 6 * s)};
    for (size_t i = 0; i < s; i++) scratch->vertex[BOUGH_ROD_P * s + i] = 1; // beyond the last: no rotation
}

void bough_rod_loads_init(bough_rod_loads *loads, bough_arena *arena, const bough_rod_model *model) {
    size_t strains = 6 * (size_t)model->stride;
    *loads = (bough_rod_loads){.value = bough_rod_vertex_rows(arena, model, 6),
                               .rate = bough_rod_vertex_rows(arena, model, 6),
                               .curve = bough_rod_vertex_rows(arena, model, 6),
                               .slope = bough_rod_vertex_rows(arena, model, 12),
                               .angle = bough_rod_vertex_rows(arena, model, 4),
                               .rest = bough_arena_copy(arena, model->strain0, strains * sizeof(double)),
                               .rest_rate = bough_arena_doubles(arena, strains)};
}

bough_rod_ramped_load *bough_rod_loads_add(bough_rod_loads *loads, bough_arena *arena,
                                           const bough_rod_model *model, bool follower,
                                           const bough_schedule *schedule) {
    bough_rod_ramped_load *fresh = bough_arena_take(arena, sizeof *fresh);
    *fresh = (bough_rod_ramped_load){.next = loads->ramped,
                                     .schedule = *schedule,
                                     .follower = follower,
                                     .value = bough_rod_vertex_rows(arena, model, 6),
                                     .line = bough_arena_doubles(arena, 12 * (size_t)model->stride)};
    loads->ramped = fresh;
    return fresh;
}

bough_rod_ramped_load *bough_rod_loads_ramped(bough_rod_loads *loads, bough_arena *arena,
                                              const bough_rod_model *model, bool follower,
                                              const bough_schedule *schedule) {
    for (bough_rod_ramped_load *l = loads->ramped; l != NULL && schedule->n == 0; l = l->next) {
        const bough_schedule *own = &l->schedule;
        // loads of one kind on one ramp are one load
        bool same = own->n == 0 && own->start == schedule->start && own->end == schedule->end;
        if (same && l->follower == follower) return l;
    }
    return bough_rod_loads_add(loads, arena, model, follower, schedule);
}

void bough_rod_loads_along(const bough_rod_model *m, const double *line, const double *rate,
                           bough_rod_loads *loads) {
    bough_rod_line_strain(m, line, loads->rest);
    bough_rod_line_strain(m, rate, loads->rest_rate);
    loads->moving = true;
    // e⁰ + D q
    double *restrict rest = loads->rest;
    const double *restrict strain0 = m->strain0;
#pragma omp simd
    for (int k = 0; k < 6 * m->stride; k++) rest[k] += strain0[k];
}

// Of the ramped loads; sampled ones are dead.
bool bough_rod_loads_follow(const bough_rod_loads *loads) {
    for (const bough_rod_ramped_load *l = loads->ramped; l != NULL; l = l->next) {
        if (l->follower) return true;
    }
    return false;
}

void bough_rod_rest_state(const bough_rod_model *m, const double *input, double *state) {
    int n = m->n;
    bough_vec3 u0 = bough_v3_load(input), omega = bough_v3_load(input + 3);
    for (int i = 0; i < n; i++) {
        bough_vec3 x = m->position0[i + 1];
        bough_quaternion p = m->rotation0[i + 1];
        // velocities of the frame's rigid motion: u₀ + ω×x, and Rᵀω
        bough_vec3 u = bough_add(u0, bough_cross(omega, x));
        bough_vec3 w = bough_mat3_tmul(bough_rotation_matrix(p), omega);
        const double values[BOUGH_ROD_STATES] = {x.x, x.y, x.z, p.w, p.x, p.y, p.z,
                                                 u.x, u.y, u.z, w.x, w.y, w.z};
        for (int c = 0; c < BOUGH_ROD_STATES; c++) state[c * n + i] = values[c];
    }
}
