#include "flexbody/section.h"

#include "core/symmetric6.h"
#include "flexbody/rod_segment.h"

#include <string.h>

enum { MOST_HALVINGS = 40 };

enum { POINTS = 8 }; // of Gauss–Legendre quadrature on each stretch without a station inside

static const double gauss_at[POINTS] = {-0.9602898564975363, -0.7966664774136267,
                                        -0.5255324099163290, -0.1834346424956498,
                                        0.1834346424956498,  0.5255324099163290,
                                        0.7966664774136267,  0.9602898564975363};
static const double gauss_weight[POINTS] = {0.1012285362903763, 0.2223810344533745,
                                            0.3137066458778873, 0.3626837833783620,
                                            0.3626837833783620, 0.3137066458778873,
                                            0.2223810344533745, 0.1012285362903763};

// The table with the arc length of each station.
typedef struct axis {
    const bough_section_table *table;
    int n;       // stations, 2 or more
    const bough_section_station *station;
    double *arc; // (n) [m]
} axis;

static bool axis_init(axis *a, bough_arena *arena, const bough_section_table *table) {
    a->table = table;
    a->n = table->n_station;
    a->station = table->station;
    if (table->n_station == 1) { // a uniform rod is two equal stations
        bough_section_station *two = bough_arena_take(arena, 2 * sizeof *two);
        if (two == NULL) return false;
        two[0] = two[1] = table->station[0];
        two[0].position = bough_v3(0, 0, 0);
        two[1].position = bough_v3(0, 0, table->length);
        a->station = two;
        a->n = 2;
    }
    a->arc = bough_arena_doubles(arena, (size_t)a->n);
    if (a->arc == NULL) return false;
    for (int k = 1; k < a->n; k++) {
        bough_vec3 step = bough_sub(a->station[k].position, a->station[k - 1].position);
        a->arc[k] = a->arc[k - 1] + bough_norm(step);
    }
    return true;
}

static double axis_length(const axis *a) {
    return a->arc[a->n - 1];
}

// The interval that holds s and the share of its upper station.
static int locate(const axis *a, double s, double *share) {
    int k = 0;
    while (k < a->n - 2 && s >= a->arc[k + 1]) k++;
    *share = bough_clamp((s - a->arc[k]) / (a->arc[k + 1] - a->arc[k]), 0, 1);
    return k;
}

static double mix(double share, double low, double high) {
    return low + share * (high - low);
}

static bough_vec3 mix3(double share, bough_vec3 low, bough_vec3 high) {
    return bough_axpy(share, bough_sub(high, low), low);
}

// The section at arc length s.
static bough_section_station section_at(const axis *a, double s) {
    double f;
    int k = locate(a, s, &f);
    const bough_section_station *l = &a->station[k], *h = l + 1;
    bough_section_station x;
    x.position = mix3(f, l->position, h->position);
    x.twist = mix(f, l->twist, h->twist);
    x.mass = mix(f, l->mass, h->mass);
    for (int i = 0; i < 21; i++) x.stiffness[i] = mix(f, l->stiffness[i], h->stiffness[i]);
    for (int i = 0; i < 2; i++) x.centre[i] = mix(f, l->centre[i], h->centre[i]);
    for (int i = 0; i < 4; i++) x.inertia[i] = mix(f, l->inertia[i], h->inertia[i]);
    return x;
}

// Tangent of the axis at s; at a station the mean of its two sides.
static bough_vec3 tangent_at(const axis *a, double s) {
    double f;
    int k = locate(a, s, &f);
    bough_vec3 t = bough_sub(a->station[k + 1].position, a->station[k].position);
    t = bough_scale(1 / bough_norm(t), t);
    if (f == 0 && k > 0) {
        bough_vec3 before = bough_sub(a->station[k].position, a->station[k - 1].position);
        t = bough_axpy(1 / bough_norm(before), before, t);
        t = bough_scale(1 / bough_norm(t), t);
    }
    return t;
}

// Section axes in the BRF: the shortest turn of z onto the tangent, then −twist about it.
static bough_quaternion rotation_at(const axis *a, double s) {
    bough_vec3 t = tangent_at(a, s);
    bough_quaternion lean = bough_quaternion_normalised((bough_quaternion){1 + t.z, -t.y, t.x, 0});
    double half = -0.5 * section_at(a, s).twist;
    return bough_quaternion_product(lean, (bough_quaternion){cos(half), 0, 0, sin(half)});
}

// A stretch of the axis and what is summed over it.
typedef struct stretch {
    const axis *axis;
    double from, to; // [m]
} stretch;

typedef void (*visitor)(void *context, double s, double weight);

static void integrate_piece(double from, double to, visitor visit, void *context) {
    double half = 0.5 * (to - from);
    for (int p = 0; p < POINTS; p++) {
        visit(context, 0.5 * (from + to) + half * gauss_at[p], half * gauss_weight[p]);
    }
}

// How often a stretch is to be halved towards its softer end: compliances, 1/(a + b s), then vary by
// little more than a factor of two over each piece.
static int halvings(const axis *a, double soft, double stiff) {
    bough_section_station low = section_at(a, soft), high = section_at(a, stiff);
    double ratio = 1;
    for (int i = 0; i < 6; i++) {
        int k = bough_symmetric6_index(i, i);
        if (low.stiffness[k] > 0) ratio = fmax(ratio, high.stiffness[k] / low.stiffness[k]);
    }
    return (int)fmin(ceil(log2(ratio) - 0.5), MOST_HALVINGS);
}

// A stretch without a station inside.
static void integrate_stretch(const axis *a, double from, double to, visitor visit,
                              void *context) {
    double middle = 0.5 * (from + to), inside = to - 1e-9 * (to - from); // before a station
    int below = halvings(a, from, inside), above = halvings(a, inside, from);
    if (below == 0 && above == 0) {
        integrate_piece(from, to, visit, context);
        return;
    }
    double low = from + ldexp(middle - from, -below), high = to - ldexp(to - middle, -above);
    integrate_piece(from, low, visit, context);
    for (int k = below - 1; k >= 0; k--) {
        double next = from + ldexp(middle - from, -k);
        integrate_piece(low, next, visit, context);
        low = next;
    }
    for (int k = 1; k <= above; k++) {
        double next = to - ldexp(to - middle, -k);
        integrate_piece(low, next, visit, context);
        low = next;
    }
    integrate_piece(high, to, visit, context);
}

// Calls visit(context, s, weight) at the quadrature points of a stretch, split at the stations.
static void integrate(stretch x, visitor visit, void *context) {
    double from = x.from;
    for (int k = 0; k < x.axis->n && from < x.to; k++) {
        double to = k + 1 < x.axis->n ? x.axis->arc[k + 1] : x.to;
        if (to <= from) continue;
        if (to > x.to) to = x.to;
        integrate_stretch(x.axis, from, to, visit, context);
        from = to;
    }
}

// -- stiffness ------------------------------------------------------------------------------------

typedef double matrix6[6][6];

// D = diag(√μ) C diag(√μ)
static void section_damping(const double mu[6], const double *stiffness, double *damping) {
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) {
            int k = bough_symmetric6_index(i, j);
            damping[k] = sqrt(mu[i] * mu[j]) * stiffness[k];
        }
    }
}

static void unpack(const double *upper, matrix6 full) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) full[i][j] = upper[bough_symmetric6_index(i, j)];
    }
}

// sum += weight·aᵀ b a for symmetric b, upper triangle only
static void add_congruent(double weight, matrix6 a, matrix6 b, double *sum) {
    matrix6 ba;
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            ba[i][j] = 0;
            for (int k = 0; k < 6; k++) ba[i][j] += b[i][k] * a[k][j];
        }
    }
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) {
            double entry = 0;
            for (int k = 0; k < 6; k++) entry += a[k][i] * ba[k][j];
            sum[bough_symmetric6_index(i, j)] += weight * entry;
        }
    }
}

// The stress at s from the one at the middle: n(s) = n, m(s) = m − (s − s_mid) d₃×n.
static void carry(double distance, matrix6 t) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) t[i][j] = i == j;
    }
    t[3][1] = distance;
    t[4][0] = -distance;
}

// The stress that a load per length, uniform over a segment of length h, adds to the one carried from
// the middle: n = −f σ, m = d₃×f (σ² − h²/4)/2 − m σ. Its moments vanish at both ends, where the
// vertices take the halves of the load.
static void line_stress(double distance, double h, matrix6 stress) {
    double bend = 0.5 * (distance * distance - 0.25 * h * h);
    memset(stress, 0, sizeof(matrix6));
    for (int i = 0; i < 6; i++) stress[i][i] = -distance;
    stress[3][1] = -bend;
    stress[4][0] = bend;
}

typedef struct segment_sum {
    const axis *axis;
    double length;        // [m]
    double middle, twist; // of the segment's mid frame [m, rad]
    double compliance[21]; // ∫ Tᵀ F T
    double loss[21];       // ∫ Tᵀ F D F T
    matrix6 line;          // ∫ Tᵀ F S, S of line_stress
    bool definite;
} segment_sum;

// sum += weight·aᵀ b
static void add_product(double weight, matrix6 a, matrix6 b, matrix6 sum) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            for (int k = 0; k < 6; k++) sum[i][j] += weight * a[k][i] * b[k][j];
        }
    }
}

static void add_compliance(void *context, double s, double weight) {
    segment_sum *c = context;
    bough_section_station x = section_at(c->axis, s);
    double compliance[21], damping[21], turn = -(x.twist - c->twist);
    matrix6 t, f, d, ft, line;
    if (!bough_symmetric6_inverse(x.stiffness, compliance)) {
        c->definite = false;
        return;
    }
    section_damping(c->axis->table->damping, x.stiffness, damping);
    bough_symmetric6_turn(compliance, turn, compliance);
    bough_symmetric6_turn(damping, turn, damping);
    unpack(compliance, f);
    unpack(damping, d);
    carry(s - c->middle, t);
    add_congruent(weight, t, f, c->compliance);
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            ft[i][j] = 0;
            for (int k = 0; k < 6; k++) ft[i][j] += f[i][k] * t[k][j];
        }
    }
    add_congruent(weight, ft, d, c->loss);
    line_stress(s - c->middle, c->length, line);
    add_product(weight, ft, line, c->line);
}

// The rod's strains by the mean strains of a straight, untwisted segment, e = Q (γ, κ), linearised at
// the undeformed one: with a and b the rotations of the ends in the middle's axes,
//     κ = (b − a)/h,  U = H κ,  γ = Δx/h + V×(a + b)/2,  V = γ + (h/2) V×(κ×t)    (rod_segment.h).
static void strain_map(segment_geometry shape, double h, matrix6 q) {
    const bough_vec3 unit[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    memset(q, 0, sizeof(matrix6));
    for (int j = 0; j < 3; j++) {
        bough_vec3 shear = bough_cross(shape.stretch, bough_cross(unit[j], shape.t));
        bough_vec3 bend = rotation_tangent(shape.c, shape.g, shape.v, unit[j]);
        const double column[6] = {0.5 * h * shear.x, 0.5 * h * shear.y, 0.5 * h * shear.z,
                                  bend.x, bend.y, bend.z};
        q[j][j] = 1;
        for (int i = 0; i < 6; i++) q[i][3 + j] = column[i];
    }
}

// Sums over a segment divided by its length, in the rod's strains.
static void change_strains(segment_sum *c, matrix6 q) {
    matrix6 turned, compliance, line = {{0}};
    double f[21] = {0};
    for (int i = 0; i < 36; i++) turned[i / 6][i % 6] = q[i % 6][i / 6];
    unpack(c->compliance, compliance);
    add_congruent(1 / c->length, turned, compliance, f);
    memcpy(c->compliance, f, sizeof f);
    unpack(c->loss, compliance);
    memset(f, 0, sizeof f);
    add_congruent(1 / c->length, turned, compliance, f);
    memcpy(c->loss, f, sizeof f);
    add_product(1 / c->length, turned, c->line, line);
    memcpy(c->line, line, sizeof line);
}

// What a segment is discretised to.
typedef struct segment_law {
    double *stiffness, *damping; // (21)
    double *line;                // (36) by rows
} segment_law;

// Stiffness and damping of a segment whose end forces are met exactly in linear statics: the
// inverse of the compliance that the stress, constant force and linear moment, meets on its way
// through the section tables. Bending within the segment appears as compliance in shear
// (MacNeal's residual bending flexibility). Damping dissipates what the sections would. `line` is the
// mean strain that a load along the segment makes (THEORY 6).
static bool segment_matrices(const axis *a, const bough_rod_def *def, int n, segment_law law) {
    double from = def->span[n], to = def->span[n + 1];
    vertex_state left = {.x = def->position[n], .p = def->rotation[n]};
    vertex_state right = {.x = def->position[n + 1], .p = def->rotation[n + 1]};
    segment_sum c = {
        .axis = a, .length = to - from, .middle = 0.5 * (from + to), .definite = true};
    matrix6 q, k, loss;
    c.twist = 0.5 * (section_at(a, from).twist + section_at(a, to).twist);
    integrate((stretch){a, from, to}, add_compliance, &c);
    strain_map(segment_shape(left, right, 1 / c.length), c.length, q);
    change_strains(&c, q);
    if (!c.definite || !bough_symmetric6_inverse(c.compliance, law.stiffness)) return false;
    unpack(law.stiffness, k);
    unpack(c.loss, loss);
    memset(law.damping, 0, 21 * sizeof *law.damping);
    add_congruent(1, k, loss, law.damping);
    memcpy(law.line, c.line, sizeof c.line);
    return true;
}

// -- inertia --------------------------------------------------------------------------------------

// Adds weight·(2 (a·b) E − a bᵀ − b aᵀ)/2, the inertia of a product of offsets.
static void add_offsets(double *j, double weight, bough_vec3 a, bough_vec3 b) {
    double d = bough_dot(a, b);
    j[0] += weight * (d - a.x * b.x);
    j[1] += weight * (d - a.y * b.y);
    j[2] += weight * (d - a.z * b.z);
    j[3] -= weight * 0.5 * (a.x * b.y + a.y * b.x);
    j[4] -= weight * 0.5 * (a.x * b.z + a.z * b.x);
    j[5] -= weight * 0.5 * (a.y * b.z + a.z * b.y);
}

// Adds weight·R I Rᵀ for a tensor with the columns given.
static void add_turned(double *j, double weight, bough_mat3 r, bough_mat3 tensor) {
    const bough_vec3 left[3] = {bough_mat3_mul(r, tensor.c1), bough_mat3_mul(r, tensor.c2),
                                bough_mat3_mul(r, tensor.c3)};
    const bough_vec3 right[3] = {r.c1, r.c2, r.c3};
    for (int k = 0; k < 3; k++) { // R I Rᵀ = Σ (R I eₖ) (R eₖ)ᵀ
        j[0] += weight * left[k].x * right[k].x;
        j[1] += weight * left[k].y * right[k].y;
        j[2] += weight * left[k].z * right[k].z;
        j[3] += weight * left[k].x * right[k].y;
        j[4] += weight * left[k].x * right[k].z;
        j[5] += weight * left[k].y * right[k].z;
    }
}

static bough_mat3 section_tensor(const double inertia[4]) {
    return (bough_mat3){{inertia[0], inertia[2], 0}, {inertia[2], inertia[1], 0}, {0, 0, inertia[3]}};
}

typedef struct lumping {
    const axis *axis;
    const bough_rod_def *def;
    bough_vertex_inertia *vertex;
    int segment;
    double curvature;          // ∫ ρ (s − a)(b − s) over the segment [kg m²]
    bough_vec3 offset_curvature; // ∫ ρ c (s − a)(b − s), c the mass centre's offset, BRF [kg m³]
} lumping;

// The share of a mass element at s that vertex i takes, where the chord would carry it.
static void lump(lumping *c, int i, double share, bough_vec3 offset, double s, double weight) {
    bough_section_station x = section_at(c->axis, s);
    bough_vertex_inertia *v = &c->vertex[i];
    bough_mat3 vertex = bough_mat3_transpose(bough_rotation_matrix(c->def->rotation[i]));
    bough_mat3 section = bough_rotation_matrix(rotation_at(c->axis, s));
    bough_mat3 r = bough_mat3_product(vertex, section);
    bough_vec3 d = bough_mat3_mul(vertex, offset);
    bough_vec3 centre = bough_mat3_mul(r, bough_v3(x.centre[0], x.centre[1], 0));
    double mass = share * weight * x.mass;
    v->mass += mass;
    v->moment = bough_axpy(mass, bough_add(d, centre), v->moment);
    add_turned(v->inertia, share * weight, r, section_tensor(x.inertia));
    add_offsets(v->inertia, mass, d, d);
    add_offsets(v->inertia, 2 * mass, d, centre);
}

static void add_mass(void *context, double s, double weight) {
    lumping *c = context;
    const bough_rod_def *def = c->def;
    int k = c->segment;
    double a = def->span[k], b = def->span[k + 1], share = (s - a) / (b - a);
    bough_section_station x = section_at(c->axis, s);
    bough_vec3 chord = mix3(share, def->position[k], def->position[k + 1]);
    bough_vec3 offset = bough_sub(x.position, chord);
    lump(c, k, 1 - share, offset, s, weight);
    lump(c, k + 1, share, offset, s, weight);
    double bubble = weight * x.mass * (s - a) * (b - s);
    bough_mat3 section = bough_rotation_matrix(rotation_at(c->axis, s));
    bough_vec3 centre = bough_mat3_mul(section, bough_v3(x.centre[0], x.centre[1], 0));
    c->curvature += bubble;
    c->offset_curvature = bough_axpy(bubble, centre, c->offset_curvature);
}

// Least inertia across z about the mass centre.
static double central_inertia(const bough_vertex_inertia *v) {
    bough_vec3 c = bough_scale(1 / v->mass, v->moment);
    double xx = v->inertia[0] - v->mass * (c.y * c.y + c.z * c.z);
    double yy = v->inertia[1] - v->mass * (c.x * c.x + c.z * c.z);
    double xy = v->inertia[3] + v->mass * c.x * c.y, half = 0.5 * (xx - yy);
    return 0.5 * (xx + yy) - sqrt(half * half + xy * xy);
}

// Gives vertex i an inertia across direction d, and takes its second moment back by masses
// (ε, −2ε, ε) on three neighbours, which change neither mass nor first moment.
static void add_spread(lumping *c, int i, double spread, bough_vec3 d) {
    int n = c->def->n_segment, middle = i == 0 ? 1 : i == n ? n - 1 : i;
    add_offsets(c->vertex[i].inertia, spread, d, d);
    if (n < 2) return;
    double h = 0.5 * (c->def->span[middle + 1] - c->def->span[middle - 1]);
    double mass = 0.5 * spread / (h * h);
    c->vertex[middle - 1].mass -= mass;
    c->vertex[middle].mass += 2 * mass;
    c->vertex[middle + 1].mass -= mass;
}

// First moments of one vertex from the curvature integrals of its segments, and what they make of
// the mass centre's offset in the products of inertia.
static void add_end_terms(lumping *c, int i, const double *curvature, const bough_vec3 *offset) {
    const bough_rod_def *def = c->def;
    bough_vertex_inertia *v = &c->vertex[i];
    bough_mat3 vertex = bough_rotation_matrix(def->rotation[i]);
    double own = central_inertia(v);
    bough_vec3 shift = {0, 0, 0};
    for (int k = i - 1; k <= i; k++) {
        if (k < 0 || k >= def->n_segment) continue;
        double h = def->span[k + 1] - def->span[k], sign = k < i ? -1 : 1;
        bough_vec3 chord = bough_sub(def->position[k + 1], def->position[k]);
        bough_vec3 along = bough_mat3_tmul(vertex, bough_scale(sign * 0.5 / (h * h), chord));
        shift = bough_axpy(curvature[k], along, shift);
        add_offsets(v->inertia, 2, along, bough_mat3_tmul(vertex, offset[k]));
    }
    v->moment = bough_add(v->moment, shift);
    double length = bough_norm(shift), spread = 1.1 * length * length / v->mass - own;
    if (spread > 0) add_spread(c, i, spread, bough_scale(1 / length, shift));
}

// Lumped inertia with exact total mass, first and second moments, whose kinetic energy of bending
// waves errs only at fourth order: hat functions give each vertex its mass; their error, that of
// the trapezoidal rule for ρ w², is a difference of end values (Euler–Maclaurin) and is removed by
// first moments ±½∫ρ(s−a)(b−s)/h of each segment at its two vertices.
static bool lump_inertia(bough_arena *arena, const axis *a, const bough_rod_def *def,
                         bough_vertex_inertia *vertex) {
    lumping c = {.axis = a, .def = def, .vertex = vertex};
    int n = def->n_segment;
    double *curvature = bough_arena_doubles(arena, (size_t)n);
    bough_vec3 *offset = bough_arena_take(arena, (size_t)n * sizeof *offset);
    if (curvature == NULL || offset == NULL) return false;
    for (c.segment = 0; c.segment < n; c.segment++) {
        c.curvature = 0;
        c.offset_curvature = bough_v3(0, 0, 0);
        integrate((stretch){a, def->span[c.segment], def->span[c.segment + 1]}, add_mass, &c);
        curvature[c.segment] = c.curvature;
        offset[c.segment] = c.offset_curvature;
    }
    for (int i = 0; i <= n; i++) add_end_terms(&c, i, curvature, offset);
    return true;
}

// -- whole ----------------------------------------------------------------------------------------

typedef struct arrays {
    double *span, *stiffness, *damping, *line;
    bough_vec3 *position;
    bough_quaternion *rotation;
    bough_vertex_inertia *inertia;
} arrays;

static arrays take_arrays(bough_arena *arena, int n) {
    size_t vertices = (size_t)n + 1;
    arrays a = {.span = bough_arena_doubles(arena, vertices),
                .stiffness = bough_arena_doubles(arena, 21 * (size_t)n),
                .damping = bough_arena_doubles(arena, 21 * (size_t)n),
                .line = bough_arena_doubles(arena, 36 * (size_t)n),
                .position = bough_arena_take(arena, vertices * sizeof(bough_vec3)),
                .rotation = bough_arena_take(arena, vertices * sizeof(bough_quaternion)),
                .inertia = bough_arena_take(arena, vertices * sizeof(bough_vertex_inertia))};
    return a;
}

bough_status bough_section_discretise(bough_arena *arena, const bough_section_table *table,
                                      int n_segment, bough_rod_def *def) {
    axis a;
    bool ok = axis_init(&a, arena, table);
    arrays m = take_arrays(arena, n_segment);
    if (!ok || bough_arena_exhausted(arena)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "rod %s: out of memory", table->name);
    }
    *def = (bough_rod_def){.name = table->name,
                           .n_segment = n_segment,
                           .span = m.span,
                           .position = m.position,
                           .rotation = m.rotation,
                           .stiffness = m.stiffness,
                           .damping = m.damping,
                           .line = m.line,
                           .inertia = m.inertia};
    for (int i = 0; i <= n_segment; i++) {
        m.span[i] = axis_length(&a) * i / n_segment;
        m.position[i] = section_at(&a, m.span[i]).position;
        m.rotation[i] = rotation_at(&a, m.span[i]);
    }
    if (!lump_inertia(arena, &a, def, m.inertia)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "rod %s: out of memory", table->name);
    }
    for (int k = 0; k < n_segment; k++) {
        segment_law law = {m.stiffness + 21 * (size_t)k, m.damping + 21 * (size_t)k,
                           m.line + 36 * (size_t)k};
        if (!segment_matrices(&a, def, k, law)) {
            return bough_fail(BOUGH_INVALID, "rod %s: the stiffness between %g m and %g m is not"
                              " positive definite", table->name, m.span[k], m.span[k + 1]);
        }
    }
    return bough_ok();
}

bough_vertex_inertia bough_section_rigid(const bough_rod_def *def) {
    bough_vertex_inertia sum = {0};
    for (int i = 0; i <= def->n_segment; i++) {
        const bough_vertex_inertia *v = &def->inertia[i];
        bough_mat3 r = bough_rotation_matrix(def->rotation[i]);
        bough_vec3 d = def->position[i], moment = bough_mat3_mul(r, v->moment);
        const double *j = v->inertia;
        bough_mat3 tensor = {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}};
        add_turned(sum.inertia, 1, r, tensor);
        add_offsets(sum.inertia, v->mass, d, d);
        add_offsets(sum.inertia, 2, d, moment);
        sum.mass += v->mass;
        sum.moment = bough_add(sum.moment, bough_axpy(v->mass, d, moment));
    }
    return sum;
}
