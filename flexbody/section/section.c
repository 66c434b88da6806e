#include "flexbody/section/section.h"

#include "core/base/linalg.h"
#include "flexbody/rod/rod_segment.h"
#include "flexbody/section/section_axis.h"

// -- stiffness ------------------------------------------------------------------------------------

typedef double matrix6[6][6];

// theory (7): D = diag(√μ) C diag(√μ)
static void section_damping(const double mu[6], const double *stiffness, double *damping) {
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) {
            int k = bough_symmetric6_index(i, j);
            damping[k] = sqrt(mu[i] * mu[j]) * stiffness[k];
        }
    }
}

// sum += weight·aᵀ b
static void add_product(double weight, matrix6 a, matrix6 b, matrix6 sum) {
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            for (int k = 0; k < 6; k++) sum[i][j] += weight * a[k][i] * b[k][j];
        }
    }
}

// sum += weight·aᵀ b a for symmetric b, upper triangle only
static void add_congruent(double weight, matrix6 a, matrix6 b, double *sum) {
    matrix6 ba = {{0}};
    add_product(1, b, a, ba);
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) {
            double entry = 0;
            for (int k = 0; k < 6; k++) entry += a[k][i] * ba[k][j];
            sum[bough_symmetric6_index(i, j)] += weight * entry;
        }
    }
}

// b ← weight·aᵀ b a
static void make_congruent(double weight, matrix6 a, double b[21]) {
    matrix6 full;
    bough_symmetric6_unpack(b, full);
    memset(b, 0, 21 * sizeof *b);
    add_congruent(weight, a, full, b);
}

// The stress n(s) = c n, m(s) = c m − arm d₃×n; with c = 1 and arm = s − s_mid it is carried from the middle.
static void set_stress(double c, double arm, matrix6 stress) {
    memset(stress, 0, sizeof(matrix6));
    for (int i = 0; i < 6; i++) stress[i][i] = c;
    stress[3][1] = arm;
    stress[4][0] = -arm;
}

// The stress that a load per length adds to the one carried from the middle of a segment of length h,
// distributed to its vertices by hat functions; theory (31). Its moments vanish at both ends.
//     uniform load f, m:     n = −f σ,               m = d₃×f (σ² − h²/4)/2 − m σ
//     load f σ, m σ:         n = f (h²/24 − σ²/2),   m = d₃×f (σ³ − h²σ/4)/6 + m (h²/24 − σ²/2)
static void line_stress(double sigma, double h, bool slope, matrix6 stress) {
    double square = sigma * sigma, along = slope ? h * h / 24 - 0.5 * square : -sigma;
    double bend = (slope ? sigma / 6 : 0.5) * (square - 0.25 * h * h);
    set_stress(along, -bend, stress);
}

// Mass between the left end of a segment and s.
typedef struct mass_sum {
    double to, twist;  // s; of the segment's mid frame
    double mass, arm;  // ∫ρ, ∫ρ (s − s′)
    bough_vec3 offset; // ∫ρ c in the mid frame
} mass_sum;

static void add_mass(void *context, const bough_section_point *point) {
    mass_sum *c = context;
    bough_section_place p = point->place;
    double angle = -(bough_section_mix(p.fraction, p.low->twist, p.high->twist) - c->twist);
    double mass = point->weight * bough_section_mix(p.fraction, p.low->mass, p.high->mass);
    double x = bough_section_mix(p.fraction, p.low->centre[0], p.high->centre[0]);
    double y = bough_section_mix(p.fraction, p.low->centre[1], p.high->centre[1]);
    double cosine = cos(angle), sine = sin(angle);
    bough_vec3 centre = {cosine * x - sine * y, sine * x + cosine * y, 0};
    c->mass += mass;
    c->arm += mass * (c->to - point->s);
    c->offset = bough_axpy(mass, centre, c->offset);
}

// The same weighted with the left vertex' hat function.
typedef struct hat_sum {
    mass_sum *whole;
    double length, mass, curvature; // curvature: ∫ρ (s − a)(b − s)
    bough_vec3 moment;
} hat_sum;

static void add_hat_mass(void *context, const bough_section_point *p) {
    hat_sum *c = context;
    mass_sum here = {.to = p->s, .twist = c->whole->twist};
    double hat = (c->whole->to - p->s) / c->length;
    add_mass(&here, p);
    c->mass += hat * here.mass;
    c->moment = bough_axpy(hat, here.offset, c->moment);
    c->curvature += here.mass * (1 - hat) * hat * c->length * c->length;
}

// The stress n = m g, m = s×g of an acceleration g on a mass and first moment, three columns.
static void mass_stress(bough_section_mass x, matrix6 stress) {
    memset(stress, 0, sizeof(matrix6));
    for (int i = 0; i < 3; i++) stress[i][i] = x.mass;
    stress[3][1] = -x.moment.z;
    stress[3][2] = x.moment.y;
    stress[4][0] = x.moment.z;
    stress[4][2] = -x.moment.x;
    stress[5][0] = -x.moment.y;
    stress[5][1] = x.moment.x;
}

enum { BOW = 6 }; // degree of the polynomials of the bow within a segment

typedef struct segment_sum {
    const bough_section_axis *axis;
    double from, length;     // [m]
    bough_section_mass left; // of the left vertex by hat functions
    double middle, twist;    // of the segment's mid frame [m, rad]
    double compliance[21];   // ∫ Tᵀ F T
    double loss[21];         // ∫ Tᵀ F D F T
    matrix6 line[2];         // ∫ Tᵀ F S, S of line_stress
    double taper[9];         // ∫ F (s − s_mid) of bending and twist
    matrix6 local[BOW + 1];  // ∫ P F T, P Legendre's polynomials over the segment
    matrix6 weight;          // the same of weight_stress, three columns
    bool definite;
} segment_sum;

// The stress by a uniform acceleration g, three columns, beyond the one carried from the middle, if the
// left vertex takes the given mass and first moment, theory (33):
//     n = (m_left − ∫ρ) g,   m = (s_left − ∫ρ c)×g − d₃×g (m_left (s − a) − ∫ρ (s − s′)).
static void weight_stress(const segment_sum *c, double s, matrix6 stress) {
    mass_sum below = {.to = s, .twist = c->twist};
    bough_section_integrate(c->axis, c->from, s, add_mass, &below);
    bough_vec3 arm = bough_sub(c->left.moment, below.offset);
    arm.z -= c->left.mass * (s - c->from) - below.arm;
    mass_stress((bough_section_mass){c->left.mass - below.mass, arm}, stress);
}

// theory (32): lumping by hat functions, with the first moment along the axis that minimises the error of a
// bending wave in a uniform segment, ½∫ρ (s − a)(b − s)/h.
static void lump_left(segment_sum *c) {
    double to = c->from + c->length;
    mass_sum whole = {.to = to, .twist = c->twist};
    hat_sum left = {.whole = &whole, .length = c->length};
    bough_section_integrate(c->axis, c->from, to, add_hat_mass, &left);
    c->left = (bough_section_mass){left.mass, left.moment};
    c->left.moment.z += 0.5 * left.curvature / c->length;
}

// Σ aᵢⱼ bᵢⱼ
static double trace(matrix6 a, matrix6 b) {
    double sum = 0;
    for (int i = 0; i < 36; i++) sum += a[i / 6][i % 6] * b[i / 6][i % 6];
    return sum;
}

static void add_compliance(void *context, const bough_section_point *p) {
    segment_sum *c = context;
    bough_section_station x = bough_section_of(p->place);
    const double s = p->s, weight = p->weight;
    double compliance[21], damping[21], angle = -(x.twist - c->twist);
    matrix6 t, f, d, line, ft = {{0}};
    if (!bough_symmetric6_inverse(x.stiffness, compliance)) {
        c->definite = false;
        return;
    }
    section_damping(c->axis->damping, x.stiffness, damping);
    bough_symmetric6_unpack(compliance, f);
    for (int i = 0; i < 9; i++) c->taper[i] += weight * (s - c->middle) * f[3 + i / 3][3 + i % 3];
    bough_symmetric6_rotate(compliance, angle, compliance);
    bough_symmetric6_rotate(damping, angle, damping);
    bough_symmetric6_unpack(compliance, f);
    bough_symmetric6_unpack(damping, d);
    set_stress(1, s - c->middle, t);
    add_congruent(weight, t, f, c->compliance);
    add_product(1, f, t, ft);
    add_congruent(weight, ft, d, c->loss);
    double x1 = 2 * (s - c->middle) / c->length, value[2] = {1, 0}; // of P of degree l and l − 1
    for (int l = 0; l <= BOW; l++) {
        for (int i = 0; i < 36; i++) c->local[l][i / 6][i % 6] += weight * value[0] * ft[i / 6][i % 6];
        double next = ((2 * l + 1) * x1 * value[0] - l * value[1]) / (l + 1);
        value[1] = value[0];
        value[0] = next;
    }
    for (int slope = 0; slope < 2; slope++) {
        line_stress(s - c->middle, c->length, slope == 1, line);
        add_product(weight, ft, line, c->line[slope]);
    }
    weight_stress(c, s, line);
    add_product(weight, ft, line, c->weight);
}

// theory (33): mass and first moment to be moved from the right vertex to the left one, so that the weight
// causes the least strain energy beyond that of the lumped masses: normal equations in the stress of the
// lumped masses in the middle, by the compliance there. Linear statics under weight is then exact at the
// vertices wherever four numbers can make it so, and so are slow waves.
static bough_section_mass best_gain(segment_sum *c) {
    enum { UNKNOWNS = 4 };
    matrix6 compliance, stress[UNKNOWNS];
    double normal[UNKNOWNS * UNKNOWNS], gain[UNKNOWNS];
    const bough_section_mass unit[UNKNOWNS] = {
        {1, {0, 0, -0.5 * c->length}}, {0, {1, 0, 0}}, {0, {0, 1, 0}}, {0, {0, 0, 1}}};
    bough_symmetric6_unpack(c->compliance, compliance);
    for (int k = 0; k < UNKNOWNS; k++) mass_stress(unit[k], stress[k]);
    for (int k = 0; k < UNKNOWNS; k++) {
        matrix6 product = {{0}}, whole = {{0}};
        add_product(1, compliance, stress[k], product);
        for (int l = 0; l < UNKNOWNS; l++) normal[UNKNOWNS * k + l] = trace(product, stress[l]);
        add_product(1, stress[k], c->weight, whole);
        gain[k] = 0;
        for (int j = 0; j < 3; j++) gain[k] -= whole[j][j];
    }
    if (!bough_cholesky_factor(UNKNOWNS, normal)) return (bough_section_mass){0};
    bough_cholesky_solve(UNKNOWNS, normal, gain);
    return (bough_section_mass){gain[0], bough_v3_load(gain + 1)};
}

// The rod's strains by the mean strains of a straight, untwisted segment, e = Q (γ, κ), linearised at
// the undeformed one: with a and b the rotations of the ends in the middle's axes,
//     κ = (b − a)/h,  U = H κ,  γ = Δx/h + y×(a + b)/2,  y = γ + (h/2) y×(κ×t),
// and V by y and by δv of h κ (rod_segment.h).
static void strain_map(segment_geometry shape, double h, matrix6 q) {
    memset(q, 0, sizeof(matrix6));
    for (int j = 0; j < 3; j++) {
        bough_vec3 own = along_axis(shape.v, bough_unit3(j));
        bough_vec3 chord = bough_cross(shape.chord, bough_cross(bough_unit3(j), shape.t));
        bough_vec3 bend_half = half_turn(shape.v, shape.t, bough_unit3(j));
        bough_vec3 shear = along_axis_variation(shape.v, bend_half, shape.chord, bough_scale(0.5, chord));
        bough_vec3 bend = rotation_tangent(shape.c, shape.g, shape.v, bough_unit3(j));
        const double column[6] = {h * shear.x, h * shear.y, h * shear.z, bend.x, bend.y, bend.z};
        q[0][j] = own.x;
        q[1][j] = own.y;
        q[2][j] = own.z;
        for (int i = 0; i < 6; i++) q[i][3 + j] = column[i];
    }
}

// Sums over a segment divided by its length, in the rod's strains.
static void change_strains(segment_sum *c, matrix6 q) {
    matrix6 transposed;
    for (int i = 0; i < 36; i++) transposed[i / 6][i % 6] = q[i % 6][i / 6];
    make_congruent(1 / c->length, transposed, c->compliance);
    make_congruent(1 / c->length, transposed, c->loss);
    for (int slope = 0; slope < 2; slope++) {
        matrix6 line = {{0}};
        add_product(1 / c->length, transposed, c->line[slope], line);
        memcpy(c->line[slope], line, sizeof line);
    }
}

// Rotations of the sections against the middle and shear strains, both lateral, by Legendre's polynomials
// over the segment, under a unit of one of the rod's strains.
typedef struct bow_shape {
    double turn[BOW][2], shear[BOW][2];
} bow_shape;

static bow_shape bow_shape_of(const segment_sum *c, const double stress[6]) {
    double local[BOW + 1][6]; // ∫ P e ds of the sections' strains e
    bow_shape x;
    for (int i = 0; i < 6 * (BOW + 1); i++) {
        local[i / 6][i % 6] = 0;
        for (int j = 0; j < 6; j++) local[i / 6][i % 6] += c->local[i / 6][i % 6][j] * stress[j];
    }
    for (int i = 0; i < 2 * BOW; i++) {
        int l = i / 2, a = i % 2;
        x.turn[l][a] = 0.5 * ((l > 0 ? local[l - 1][3 + a] : 0) - local[l + 1][3 + a]);
        x.shear[l][a] = (2 * l + 1) / c->length * local[l][a];
    }
    return x;
}

// theory (107): B of a segment with the stiffness k of the rod's strains Q (γ, κ).
static void bow_matrix(const segment_sum *c, matrix6 q, matrix6 k, double bow[10]) {
    static const int strains[4] = {0, 1, 3, 4};
    bow_shape shape[4];
    for (int j = 0, entry = 0; j < 4; j++) {
        double stress[6] = {0};
        for (int i = 0; i < 36; i++) stress[i / 6] += q[i % 6][i / 6] * k[i % 6][strains[j]];
        shape[j] = bow_shape_of(c, stress);
        for (int i = 0; i <= j; i++, entry++) {
            bow[entry] = i == j && i > 1 ? -c->length * c->length / 12 : 0;
            for (int l = 0; l < BOW; l++) {
                const double *a = shape[i].turn[l], *b = shape[j].turn[l];
                const double *x = shape[i].shear[l], *y = shape[j].shear[l];
                double mixed = a[1] * y[0] - a[0] * y[1] + b[1] * x[0] - b[0] * x[1];
                bow[entry] += (a[0] * b[0] + a[1] * b[1] + mixed) / (2 * l + 1);
            }
        }
    }
}

// What the segments are discretised to.
typedef struct segment_laws {
    double *stiffness, *damping; // (21 n)
    double *line;                // (72 n): two matrices by rows each
    double *taper;               // (9 n)
    double *bow;                 // (10 n)
    bough_section_mass *gain;    // (n)
} segment_laws;

// theory (29, 30): stiffness and damping of a segment that is exact in linear statics under end forces, the
// inverse of the compliance of the section tables under a constant force and a linear moment. Bending within
// the segment appears as compliance in shear (MacNeal's residual bending flexibility). Damping dissipates
// what the sections would. `line` is D, the mean strain by a load along the segment.
static bool segment_matrices(const bough_section_axis *a, const bough_rod_def *def, int n,
                             const segment_laws *laws) {
    double from = def->span[n], to = def->span[n + 1];
    double *stiffness = laws->stiffness + 21 * n;
    segment_sum c = {
        .axis = a, .from = from, .length = to - from, .middle = 0.5 * (from + to), .definite = true};
    matrix6 q, k;
    c.twist = 0.5 * (bough_section_at(a, from).twist + bough_section_at(a, to).twist);
    lump_left(&c);
    bough_section_integrate(a, from, to, add_compliance, &c);
    laws->gain[n] = c.definite ? best_gain(&c) : (bough_section_mass){0};
    strain_map(shape_between(def->position + n, def->rotation + n, 1 / c.length), c.length, q);
    change_strains(&c, q);
    if (!c.definite || !bough_symmetric6_inverse(c.compliance, stiffness)) return false;
    bough_symmetric6_unpack(stiffness, k);
    make_congruent(1, k, c.loss);
    memcpy(laws->damping + 21 * n, c.loss, sizeof c.loss);
    memcpy(laws->line + 72 * n, c.line, sizeof c.line);
    bow_matrix(&c, q, k, laws->bow + 10 * n);
    for (int i = 0; i < 9; i++) laws->taper[9 * n + i] = 12 / (c.length * c.length * c.length) * c.taper[i];
    return true;
}

// -- loads on parts of segments -------------------------------------------------------------------

typedef struct part_sum {
    const bough_section_axis *axis;
    const bough_rod_part *part;
    double middle, twist; // of the segment's mid frame [m, rad]
    double from;          // its left end [m]
    double left[6];       // what its left vertex takes
    double strain[6];     // ∫ Tᵀ F S
} part_sum;

// theory (106): S at s of a load on a part of the segment.
static void part_stress(const part_sum *c, double s, double stress[6]) {
    double length = c->part->to - c->part->from, past = s - c->part->from;
    double x = bough_clamp(past, 0, length), force[6], arm[6]; // ∫q, ∫q (s − s′) up to s
    for (int i = 0; i < 6; i++) {
        double start = c->part->start[i], slope = c->part->slope[i];
        force[i] = x * (start + 0.5 * x * slope);
        arm[i] = x * x * (start / 2 + x * slope / 6) + (past - x) * force[i];
        if (length == 0) {
            force[i] = past > 0 ? start : 0;
            arm[i] = past * force[i];
        }
        stress[i] = c->left[i] - force[i];
    }
    stress[3] += c->left[1] * (s - c->from) - arm[1];
    stress[4] -= c->left[0] * (s - c->from) - arm[0];
}

// Of the sections there, in axes of a given twist.
static void compliance_at(const bough_section_point *p, double twist, matrix6 f) {
    bough_section_station x = bough_section_of(p->place);
    double compliance[21];
    bough_symmetric6_inverse(x.stiffness, compliance); // bough_section_discretise has done so
    bough_symmetric6_rotate(compliance, twist - x.twist, compliance);
    bough_symmetric6_unpack(compliance, f);
}

static void add_part_strain(void *context, const bough_section_point *p) {
    part_sum *c = context;
    const double s = p->s, weight = p->weight;
    double stress[6], own[6] = {0};
    matrix6 f;
    compliance_at(p, c->twist, f);
    part_stress(c, s, stress);
    for (int i = 0; i < 36; i++) own[i / 6] += f[i / 6][i % 6] * stress[i % 6];
    own[1] += (s - c->middle) * own[3];
    own[0] -= (s - c->middle) * own[4];
    for (int i = 0; i < 6; i++) c->strain[i] += weight * own[i];
}

static void part_strain(const void *axis, const bough_rod_model *m, int n, const bough_rod_part *part,
                        double mean[6]) {
    const bough_section_axis *a = axis;
    double from = m->span[n], to = m->span[n + 1], h = to - from, length = part->to - part->from;
    part_sum c = {.axis = a, .part = part, .middle = 0.5 * (from + to), .from = from};
    c.twist = 0.5 * (bough_section_at(a, from).twist + bough_section_at(a, to).twist);
    for (int i = 0; i < 6; i++) {
        double start = part->start[i], slope = part->slope[i];
        double whole = length > 0 ? length * (start + 0.5 * length * slope) : start;
        double moment = length * length * (start / 2 + length * slope / 6); // about its end
        c.left[i] = (whole * (to - part->to) + moment) / h;
    }
    const double at[4] = {from, part->from, part->to, to}; // S is smooth between
    for (int k = 0; k < 3; k++) bough_section_integrate(a, at[k], at[k + 1], add_part_strain, &c);
    matrix6 q;
    strain_map(shape_between(m->position0 + n, m->rotation0 + n, 1 / h), h, q);
    memset(mean, 0, 6 * sizeof *mean);
    for (int i = 0; i < 36; i++) mean[i / 6] += q[i / 6][i % 6] * c.strain[i % 6] / h;
}

// -- rotation within a segment --------------------------------------------------------------------

typedef struct bend_sum {
    double middle, twist; // of the segment's mid frame [m, rad]
    double weight, *bend;
} bend_sum;

static void add_bend(void *context, const bough_section_point *p) {
    bend_sum *c = context;
    matrix6 f;
    compliance_at(p, c->twist, f);
    for (int i = 0; i < 18; i++) c->bend[9 * (i / 6) + i % 6] += c->weight * p->weight * f[3 + i / 6][i % 6];
    for (int i = 0; i < 9; i++)
        c->bend[9 * (i / 3) + 6 + i % 3] +=
            c->weight * p->weight * (p->s - c->middle) * f[3 + i / 3][3 + i % 3];
}

static double bend_at(const void *axis, const double span[2], double s, double bend[27]) {
    const bough_section_axis *a = axis;
    double low = bough_section_at(a, span[0]).twist, high = bough_section_at(a, span[1]).twist;
    double fraction = (s - span[0]) / (span[1] - span[0]);
    bend_sum c = {0.5 * (span[0] + span[1]), 0.5 * (low + high), 1 - fraction, bend};
    memset(bend, 0, 27 * sizeof *bend);
    bough_section_integrate(a, span[0], s, add_bend, &c);
    c.weight = -fraction;
    bough_section_integrate(a, s, span[1], add_bend, &c);
    return bough_section_mix(fraction, low, high) - bough_section_at(a, s).twist;
}

// -- whole ----------------------------------------------------------------------------------------

bough_status bough_section_discretise(bough_arena *arena, const bough_section_table *table, int n_segment,
                                      bough_rod_def *def) {
    bough_section_axis *a = bough_arena_take(arena, sizeof *a);
    bough_section_axis_init(a, arena, table);
    size_t n = (size_t)n_segment;
    double *span = bough_arena_doubles(arena, n + 1);
    bough_vec3 *position = bough_arena_take(arena, (n + 1) * sizeof *position);
    bough_quaternion *rotation = bough_arena_take(arena, (n + 1) * sizeof *rotation);
    bough_vertex_inertia *inertia = bough_arena_take(arena, (n + 1) * sizeof *inertia);
    segment_laws laws = {.gain = bough_arena_take(arena, n * sizeof *laws.gain)};
    bough_arena_each(arena, 21 * n, &laws.stiffness, &laws.damping);
    laws.line = bough_arena_doubles(arena, 72 * n);
    laws.taper = bough_arena_doubles(arena, 9 * n);
    laws.bow = bough_arena_doubles(arena, 10 * n);
    *def = (bough_rod_def){.name = table->name,
                           .n_segment = n_segment,
                           .span = span,
                           .position = position,
                           .rotation = rotation,
                           .stiffness = laws.stiffness,
                           .damping = laws.damping,
                           .line = laws.line,
                           .taper = laws.taper,
                           .bow = laws.bow,
                           .inertia = inertia,
                           .sections = {part_strain, bough_section_mass_below, bend_at, a}};
    for (int i = 0; i <= n_segment; i++) {
        span[i] = a->arc[a->n - 1] * bough_section_graded(table->grading, (double)i / n_segment);
        bough_section_place place = bough_section_find(a, span[i]);
        position[i] = bough_section_of(place).position;
        rotation[i] = bough_section_rotation_in(place);
    }
    // between vertices the axis may bend at one side of a vertex or at the other, as the stations lie
    for (int i = 1; i < n_segment; i++) {
        bough_vec3 t = bough_add(bough_section_direction(position[i - 1], position[i]),
                                 bough_section_direction(position[i], position[i + 1]));
        t = bough_section_direction(bough_v3(0, 0, 0), t);
        rotation[i] = bough_section_rotation(t, bough_section_at(a, span[i]).twist);
    }
    for (int k = 0; k < n_segment; k++) {
        if (segment_matrices(a, def, k, &laws)) continue;
        return bough_fail(BOUGH_INVALID,
                          "rod %s: the stiffness between %g m and %g m is not positive definite", table->name,
                          span[k], span[k + 1]);
    }
    bough_section_lump(arena, a, def, laws.gain, inertia);
    return bough_ok();
}
