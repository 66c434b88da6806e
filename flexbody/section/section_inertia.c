// Inertia of a section table lumped to vertices.
#include "core/base/linalg.h"
#include "flexbody/rod/rod_segment.h"
#include "flexbody/section/section_axis.h"

// A segment's mass is lumped in one of two ways, with exact total mass, first and second moments:
//   fine:  by hat functions, where the chord carries it. Their error in the kinetic energy of bending
//          waves, that of the trapezoidal rule for ρ w², is a difference of end values
//          (Euler–Maclaurin) and is removed by first moments ±½∫ρ (s − a)(b − s)/h at the two
//          vertices, so that it errs only at fourth order. Torsional inertia is distributed in
//          proportion to the twist in statics.
//   rigid: by hat functions at its own position, so that the inertia of a vertex is positive for any table.
// Fine lumping can leave a light vertex beside a heavy segment without a positive inertia; the segments
// at this vertex are then lumped rigidly.

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
static void add_rotated(double *j, double weight, bough_mat3 r, bough_mat3 tensor) {
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

enum { FINE, RIGID, WAYS };

// Inertia of one segment at its two vertices.
typedef struct segment_inertia {
    bough_vertex_inertia side[WAYS][2];
    bough_axial_mass left[WAYS]; // at the left vertex
    double right;                // first moment of the fine way along the segment at the right one [kg m]
    bool rigid;                  // the way taken
} segment_inertia;

typedef struct lumping {
    const bough_section_axis *axis;
    const bough_rod_def *def;
    int segment;
    double twist;                // ∫1/GJ over the segment
    double curvature;            // ∫ρ (s − a)(b − s) [kg m²]
    double second;               // of the left vertex by hat functions, ∫ρ (s − a)²(b − s)/h [kg m²]
    bough_vec3 offset_curvature; // ∫ρ c (s − a)(b − s), c the mass centre's offset, BRF [kg m³]
    segment_inertia sum;
} lumping;

// A mass element: its position and orientation in the axes of a vertex.
typedef struct element {
    double mass;
    bough_vec3 offset, centre; // of the axis from the vertex or the chord, of the mass centre from it
    bough_mat3 axes;
    double inertia[4]; // about the mass centre
} element;

static void lump(const element *e, double fraction, double rotated, bough_vertex_inertia *v) {
    double mass = fraction * e->mass;
    v->mass += mass;
    v->moment = bough_axpy(mass, bough_add(e->offset, e->centre), v->moment);
    add_rotated(v->inertia, rotated, e->axes, section_tensor(e->inertia));
    bough_vec3 arm = bough_add(e->offset, e->centre);
    add_offsets(v->inertia, mass, arm, arm);
}

// section: its axes in the BRF
static element element_of(const lumping *c, const bough_section_station *x, bough_mat3 section, double weight,
                          int vertex, bough_vec3 from) {
    bough_mat3 axes = bough_mat3_transpose(bough_rotation_matrix(c->def->rotation[vertex]));
    element e = {.mass = weight * x->mass, .axes = bough_mat3_product(axes, section)};
    double cx = x->centre[0], cy = x->centre[1];
    e.offset = bough_mat3_mul(axes, bough_sub(x->position, from));
    e.centre = bough_mat3_mul(e.axes, bough_v3(cx, cy, 0));
    double central[4];
    bough_section_central(x, central);
    for (int i = 0; i < 4; i++) e.inertia[i] = weight * central[i];
    return e;
}

static void add_twist(void *context, const bough_section_point *point) {
    lumping *c = context;
    bough_section_place p = point->place;
    c->twist +=
        point->weight * (1 / bough_section_mix(p.fraction, p.low->stiffness[20], p.high->stiffness[20]));
}

// Twist at s for a unit twist over the segment.
static double twist_fraction(const lumping *c, double s) {
    lumping below = {.axis = c->axis};
    bough_section_integrate(c->axis, c->def->span[c->segment], s, add_twist, &below);
    return below.twist / c->twist;
}

// Where a point of the segment's axis would be on its chord.
static bough_vec3 on_chord_at(const bough_rod_def *def, int k, double s) {
    double fraction = (s - def->span[k]) / (def->span[k + 1] - def->span[k]);
    return bough_between(def->position[k], def->position[k + 1], fraction);
}

static void add_mass(void *context, const bough_section_point *p) {
    lumping *c = context;
    const double s = p->s, weight = p->weight;
    const bough_rod_def *def = c->def;
    int k = c->segment;
    double a = def->span[k], b = def->span[k + 1], fraction = (s - a) / (b - a);
    double twisted = twist_fraction(c, s);
    bough_section_station x = bough_section_of(p->place);
    bough_vec3 chord = on_chord_at(def, k, s);
    bough_mat3 section = bough_rotation_matrix(bough_section_rotation_in(p->place));
    for (int side = 0; side < 2; side++) {
        double hat = side == 0 ? 1 - fraction : fraction;
        element on_chord = element_of(c, &x, section, weight, k + side, chord);
        element in_place = element_of(c, &x, section, weight, k + side, def->position[k + side]);
        lump(&on_chord, hat, side == 0 ? 1 - twisted : twisted, &c->sum.side[FINE][side]);
        lump(&in_place, hat, hat, &c->sum.side[RIGID][side]);
    }
    double bubble = weight * x.mass * (s - a) * (b - s);
    bough_vec3 centre = bough_mat3_mul(section, bough_v3(x.centre[0], x.centre[1], 0));
    c->curvature += bubble;
    c->second += (1 - fraction) * weight * x.mass * (s - a) * (s - a);
    c->offset_curvature = bough_axpy(bubble, centre, c->offset_curvature);
}

// First moments of the fine lumps, and the products of inertia that these and the mass centre's offset give.
static void add_end_terms(lumping *c) {
    const bough_rod_def *def = c->def;
    int k = c->segment;
    double h = def->span[k + 1] - def->span[k];
    bough_vec3 chord = bough_sub(def->position[k + 1], def->position[k]);
    for (int side = 0; side < 2; side++) {
        bough_mat3 axes = bough_rotation_matrix(def->rotation[k + side]);
        double sign = side == 0 ? 1 : -1;
        bough_vec3 along = bough_mat3_tmul(axes, bough_scale(sign * 0.5 / (h * h), chord));
        bough_vertex_inertia *v = &c->sum.side[FINE][side];
        v->moment = bough_axpy(c->curvature, along, v->moment);
        add_offsets(v->inertia, 2, along, bough_mat3_tmul(axes, c->offset_curvature));
    }
}

// Moves mass and first moment from the right vertex to the left one, and subtracts their second moments from
// both.
static void add_gain(lumping *c, bough_section_mass gain) {
    const bough_rod_def *def = c->def;
    int k = c->segment;
    bough_mat3 middle = mid_frame_between(def->rotation[k], def->rotation[k + 1]);
    bough_vec3 chord = bough_sub(def->position[k + 1], def->position[k]);
    bough_vec3 left = bough_mat3_mul(middle, gain.moment);
    const bough_vec3 moment[2] = {left, bough_axpy(gain.mass, chord, bough_scale(-1, left))};
    const double mass[2] = {gain.mass, -gain.mass};
    for (int side = 0; side < 2; side++) {
        bough_mat3 axes = bough_rotation_matrix(def->rotation[k + side]);
        bough_vec3 along = bough_mat3_tmul(axes, chord);
        bough_vec3 second = bough_mat3_tmul(axes, bough_sub(moment[1], moment[0]));
        bough_vertex_inertia *v = &c->sum.side[FINE][side];
        v->mass += mass[side];
        v->moment = bough_add(v->moment, bough_mat3_tmul(axes, moment[side]));
        add_offsets(v->inertia, -0.5, along, second);
    }
}

static segment_inertia lump_segment(const bough_section_axis *a, const bough_rod_def *def, int k,
                                    bough_section_mass gain) {
    lumping c = {.axis = a, .def = def, .segment = k};
    double from = def->span[k], to = def->span[k + 1];
    bough_section_integrate(a, from, to, add_twist, &c);
    bough_section_integrate(a, from, to, add_mass, &c);
    double h = to - from, bend = c.curvature / h;
    segment_inertia *s = &c.sum;
    add_end_terms(&c);
    add_gain(&c, gain);
    const double moment[WAYS] = {0.5 * bend + gain.moment.z, bend},
                 second[WAYS] = {h * gain.moment.z - h * h * gain.mass / 2, c.second};
    s->right = h * gain.mass - moment[FINE];
    bough_vec3 chord = bough_scale(1 / h, bough_sub(def->position[k + 1], def->position[k]));
    chord = bough_mat3_tmul(bough_rotation_matrix(def->rotation[k]), chord);
    for (int way = 0; way < WAYS; way++) {
        const bough_vertex_inertia *v = &s->side[way][0];
        bough_vec3 offset = bough_axpy(-moment[way], chord, v->moment);
        s->left[way] = (bough_axial_mass){v->mass, moment[way], second[way], offset};
    }
    return *s;
}

static void add_inertia(const bough_vertex_inertia *part, bough_vertex_inertia *sum) {
    sum->mass += part->mass;
    sum->moment = bough_add(sum->moment, part->moment);
    for (int i = 0; i < 6; i++) sum->inertia[i] += part->inertia[i];
}

// -- vertices -------------------------------------------------------------------------------------

// Least inertia across z about the mass centre.
static double central_inertia(const bough_vertex_inertia *v) {
    bough_vec3 c = bough_scale(1 / v->mass, v->moment);
    double xx = v->inertia[0] - v->mass * (c.y * c.y + c.z * c.z);
    double yy = v->inertia[1] - v->mass * (c.x * c.x + c.z * c.z);
    double xy = v->inertia[3] + v->mass * c.x * c.y, half = 0.5 * (xx - yy);
    return 0.5 * (xx + yy) - sqrt(half * half + xy * xy);
}

// The inertia that a vertex lacks for its fine first moment, with a tenth of it to spare.
static double lack(const bough_vertex_inertia *v, double shift) {
    bough_vertex_inertia without = *v;
    without.moment.z -= shift;
    return 1.1 * shift * shift / v->mass - central_inertia(&without);
}

// Gives vertex i an inertia across its axis, and takes its second moment back by masses on
// three neighbours, which change neither mass nor first moment.
static void add_spread(const bough_rod_def *def, int i, double spread, bough_vertex_inertia *vertex) {
    const bough_vec3 along = {0, 0, 1};
    int n = def->n_segment, middle = i == 0 ? 1 : i == n ? n - 1 : i;
    add_offsets(vertex[i].inertia, spread, along, along);
    vertex[i].added_inertia = spread;
    double left = def->span[middle] - def->span[middle - 1],
           right = def->span[middle + 1] - def->span[middle];
    const double mass[3] = {-spread / (left * (left + right)), spread / (left * right),
                            -spread / (right * (left + right))};
    for (int k = 0; k < 3; k++) {
        vertex[middle - 1 + k].mass += mass[k];
        vertex[middle - 1 + k].added_mass += mass[k];
    }
}

static bool positive(const bough_vertex_inertia *v) {
    const double most = 1.03; // of the first moment
    bough_vertex_inertia more = *v;
    double upper[21];
    more.moment = bough_scale(most, v->moment);
    bough_vertex_mass(&more, upper);
    return bough_symmetric6_inverse(upper, upper);
}

// Sums over the segments at each vertex, lumped in the way that each segment is.
static void sum_vertices(const bough_rod_def *def, const segment_inertia *segment,
                         bough_vertex_inertia *vertex) {
    int n = def->n_segment;
    memset(vertex, 0, ((size_t)n + 1) * sizeof *vertex);
    for (int k = 0; k < n; k++) {
        for (int side = 0; side < 2; side++) {
            add_inertia(&segment[k].side[segment[k].rigid][side], &vertex[k + side]);
        }
        vertex[k].outer = segment[k].left[segment[k].rigid];
    }
    for (int i = 0; i <= n && n > 1; i++) {
        double shift = (i < n && !segment[i].rigid ? segment[i].left[FINE].moment : 0) +
                       (i > 0 && !segment[i - 1].rigid ? segment[i - 1].right : 0);
        double spread = shift == 0 ? 0 : lack(&vertex[i], shift);
        if (spread > 0) add_spread(def, i, spread, vertex);
    }
}

// Takes the segments about vertex i rigid, `reach` on either side. Whether that is a change.
static bool make_rigid(int i, int reach, int n, segment_inertia *segment) {
    bool change = false;
    for (int k = i - reach; k < i + reach; k++) {
        if (k < 0 || k >= n) continue;
        change = change || !segment[k].rigid;
        segment[k].rigid = true;
    }
    return change;
}

void bough_section_lump(bough_arena *arena, const bough_section_axis *a, const bough_rod_def *def,
                        const bough_section_mass *gain, bough_vertex_inertia *vertex) {
    int n = def->n_segment;
    segment_inertia *segment = bough_arena_take(arena, (size_t)n * sizeof *segment);
    for (int k = 0; k < n; k++) segment[k] = lump_segment(a, def, k, gain[k]);
    for (bool change = true; change;) {
        change = false;
        sum_vertices(def, segment, vertex);
        for (int i = 0; i <= n; i++) {
            if (positive(&vertex[i])) continue;
            // add_spread takes mass from vertices up to three segments away
            change = make_rigid(i, 1, n, segment) || make_rigid(i, 3, n, segment) || change;
        }
    }
}

// -- within segments ------------------------------------------------------------------------------

typedef struct part {
    const lumping *whole;
    bough_axial_mass mass;
} part;

static void add_part(void *context, const bough_section_point *p) {
    part *c = context;
    const lumping *whole = c->whole;
    bough_section_station x = bough_section_of(p->place);
    bough_mat3 section = bough_rotation_matrix(bough_section_rotation_in(p->place));
    bough_vec3 chord = on_chord_at(whole->def, whole->segment, p->s);
    element e = element_of(whole, &x, section, p->weight, whole->segment, chord);
    double distance = p->s - whole->def->span[whole->segment];
    c->mass.mass += e.mass;
    c->mass.moment += e.mass * distance;
    c->mass.second += e.mass * distance * distance;
    c->mass.offset = bough_axpy(e.mass, bough_add(e.offset, e.centre), c->mass.offset);
}

bough_axial_mass bough_section_mass_below(const void *axis, const bough_rod_def *def, int n, double to) {
    lumping whole = {.axis = axis, .def = def, .segment = n};
    part c = {.whole = &whole};
    bough_section_integrate(axis, def->span[n], to, add_part, &c);
    return c.mass;
}

bough_vertex_inertia bough_section_rigid(const bough_rod_def *def) {
    bough_vertex_inertia sum = {0};
    for (int i = 0; i <= def->n_segment; i++) {
        const bough_vertex_inertia *v = &def->inertia[i];
        bough_mat3 r = bough_rotation_matrix(def->rotation[i]);
        bough_vec3 d = def->position[i], moment = bough_mat3_mul(r, v->moment);
        add_rotated(sum.inertia, 1, r, bough_mat3_symmetric(v->inertia));
        add_offsets(sum.inertia, v->mass, d, d);
        add_offsets(sum.inertia, 2, d, moment);
        sum.mass += v->mass;
        sum.moment = bough_add(sum.moment, bough_axpy(v->mass, d, moment));
    }
    return sum;
}
