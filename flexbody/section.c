#include "flexbody/section.h"

#include "core/symmetric6.h"

#include <string.h>

enum { POINTS = 4 }; // of Gauss–Legendre quadrature on each stretch without a station inside

static const double gauss_at[POINTS] = {-0.8611363115940526, -0.3399810435848563,
                                        0.3399810435848563, 0.8611363115940526};
static const double gauss_weight[POINTS] = {0.3478548451374538, 0.6521451548625461,
                                            0.6521451548625461, 0.3478548451374538};

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

// Calls visit(context, s, weight) at the quadrature points of a stretch, split at the stations.
static void integrate(stretch x, void (*visit)(void *context, double s, double weight),
                      void *context) {
    double from = x.from;
    for (int k = 0; k < x.axis->n && from < x.to; k++) {
        double to = k + 1 < x.axis->n ? x.axis->arc[k + 1] : x.to;
        if (to <= from) continue;
        if (to > x.to) to = x.to;
        for (int p = 0; p < POINTS; p++) {
            double half = 0.5 * (to - from);
            visit(context, 0.5 * (from + to) + half * gauss_at[p], half * gauss_weight[p]);
        }
        from = to;
    }
}

// -- stiffness ------------------------------------------------------------------------------------

typedef struct compliance_sum {
    const axis *axis;
    double twist; // of the segment's mid frame [rad]
    double sum[21];
    bool definite;
} compliance_sum;

static void add_compliance(void *context, double s, double weight) {
    compliance_sum *c = context;
    bough_section_station x = section_at(c->axis, s);
    double compliance[21];
    if (!bough_symmetric6_inverse(x.stiffness, compliance)) {
        c->definite = false;
        return;
    }
    bough_symmetric6_turn(compliance, -(x.twist - c->twist), compliance);
    for (int i = 0; i < 21; i++) c->sum[i] += weight * compliance[i];
}

// Mean compliance of the segment, inverted: exact where force and moment are constant.
static bool segment_stiffness(const axis *a, double from, double to, double *stiffness) {
    compliance_sum c = {.axis = a, .definite = true};
    c.twist = 0.5 * (section_at(a, from).twist + section_at(a, to).twist);
    integrate((stretch){a, from, to}, add_compliance, &c);
    for (int i = 0; i < 21; i++) c.sum[i] /= to - from;
    return c.definite && bough_symmetric6_inverse(c.sum, stiffness);
}

static void segment_damping(const double mu[6], const double *stiffness, double *damping) {
    for (int i = 0; i < 6; i++) {
        for (int j = i; j < 6; j++) {
            int k = bough_symmetric6_index(i, j);
            damping[k] = sqrt(mu[i] * mu[j]) * stiffness[k];
        }
    }
}

// -- inertia --------------------------------------------------------------------------------------

typedef struct inertia_sum {
    const axis *axis;
    bough_vec3 position; // of the vertex
    bough_mat3 rotation;
    bough_vertex_inertia sum;
} inertia_sum;

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

// Adds weight·R I Rᵀ for the section's tensor (Ixx Iyy Ixy Izz).
static void add_turned(double *j, double weight, bough_mat3 r, const double inertia[4]) {
    double xx = inertia[0], yy = inertia[1], xy = inertia[2], zz = inertia[3];
    bough_vec3 rx = bough_add(bough_scale(xx, r.c1), bough_scale(xy, r.c2));
    bough_vec3 ry = bough_add(bough_scale(xy, r.c1), bough_scale(yy, r.c2));
    bough_vec3 rz = bough_scale(zz, r.c3);
    const bough_vec3 left[3] = {rx, ry, rz}, right[3] = {r.c1, r.c2, r.c3};
    for (int k = 0; k < 3; k++) {
        j[0] += weight * left[k].x * right[k].x;
        j[1] += weight * left[k].y * right[k].y;
        j[2] += weight * left[k].z * right[k].z;
        j[3] += weight * left[k].x * right[k].y;
        j[4] += weight * left[k].x * right[k].z;
        j[5] += weight * left[k].y * right[k].z;
    }
}

static void add_inertia(void *context, double s, double weight) {
    inertia_sum *c = context;
    bough_section_station x = section_at(c->axis, s);
    bough_mat3 section = bough_rotation_matrix(rotation_at(c->axis, s));
    bough_mat3 r = bough_mat3_product(bough_mat3_transpose(c->rotation), section);
    bough_vec3 d = bough_mat3_tmul(c->rotation, bough_sub(x.position, c->position));
    bough_vec3 centre = bough_mat3_mul(r, bough_v3(x.centre[0], x.centre[1], 0));
    double mass = weight * x.mass;
    c->sum.mass += mass;
    c->sum.moment = bough_axpy(mass, bough_add(d, centre), c->sum.moment);
    add_turned(c->sum.inertia, weight, r, x.inertia);
    add_offsets(c->sum.inertia, mass, d, d);
    add_offsets(c->sum.inertia, 2 * mass, d, centre);
}

static bough_vertex_inertia vertex_inertia(const axis *a, const bough_rod_def *def, int i) {
    int n = def->n_segment;
    double from = i == 0 ? 0 : 0.5 * (def->span[i - 1] + def->span[i]);
    double to = i == n ? def->span[n] : 0.5 * (def->span[i] + def->span[i + 1]);
    inertia_sum c = {.axis = a,
                     .position = def->position[i],
                     .rotation = bough_rotation_matrix(def->rotation[i])};
    integrate((stretch){a, from, to}, add_inertia, &c);
    return c.sum;
}

// -- whole ----------------------------------------------------------------------------------------

typedef struct arrays {
    double *span, *stiffness, *damping;
    bough_vec3 *position;
    bough_quaternion *rotation;
    bough_vertex_inertia *inertia;
} arrays;

static arrays take_arrays(bough_arena *arena, int n) {
    size_t vertices = (size_t)n + 1;
    arrays a = {.span = bough_arena_doubles(arena, vertices),
                .stiffness = bough_arena_doubles(arena, 21 * (size_t)n),
                .damping = bough_arena_doubles(arena, 21 * (size_t)n),
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
    *def = (bough_rod_def){table->name,  n_segment, m.span,   m.position, m.rotation,
                           m.stiffness, m.damping, m.inertia};
    for (int i = 0; i <= n_segment; i++) {
        m.span[i] = axis_length(&a) * i / n_segment;
        m.position[i] = section_at(&a, m.span[i]).position;
        m.rotation[i] = rotation_at(&a, m.span[i]);
    }
    for (int i = 0; i <= n_segment; i++) m.inertia[i] = vertex_inertia(&a, def, i);
    for (int k = 0; k < n_segment; k++) {
        double *stiffness = m.stiffness + 21 * (size_t)k;
        if (!segment_stiffness(&a, m.span[k], m.span[k + 1], stiffness)) {
            return bough_fail(BOUGH_INVALID, "rod %s: the stiffness between %g m and %g m is not"
                              " positive definite", table->name, m.span[k], m.span[k + 1]);
        }
        segment_damping(table->damping, stiffness, m.damping + 21 * (size_t)k);
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
        const bough_vec3 column[3] = {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}};
        const bough_vec3 axes[3] = {r.c1, r.c2, r.c3};
        double turned[6] = {0};
        for (int k = 0; k < 3; k++) { // R I Rᵀ = Σ (R I eₖ) (R eₖ)ᵀ
            bough_vec3 l = bough_mat3_mul(r, column[k]), x = axes[k];
            const double add[6] = {l.x * x.x, l.y * x.y, l.z * x.z, l.x * x.y, l.x * x.z, l.y * x.z};
            for (int c = 0; c < 6; c++) turned[c] += add[c];
        }
        for (int c = 0; c < 6; c++) sum.inertia[c] += turned[c];
        add_offsets(sum.inertia, v->mass, d, d);
        add_offsets(sum.inertia, 2, d, moment);
        sum.mass += v->mass;
        sum.moment = bough_add(sum.moment, bough_axpy(v->mass, d, moment));
    }
    return sum;
}
