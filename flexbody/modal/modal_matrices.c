// The constant matrices of a modal piece, by sums over its vertices. A field has six components per
// vertex, the displacement of its mass centre and its rotation in frame axes: so mass matrices are
// diagonal in the vertices, and a rotation of the frame is e× on both components.
#include "flexbody/modal/modal.h"

#include "core/base/spatial.h"

typedef struct vertex_mass {
    double mass;
    bough_vec3 arm;      // of the mass centre from the vertex, in frame axes [m]
    bough_vec3 position; // of the mass centre [m]
    bough_mat3 inertia;  // about the mass centre, in frame axes [kg m²]
} vertex_mass;

typedef struct fields {
    bough_modal_piece *piece;
    vertex_mass *vertex; // (n)
    double *shape;       // the shapes as a field (6 n × stride)
    double *product;     // work (6 n × stride)
    double *rest[3];     // of the rotating shapes, outside the span of the shapes (6 n × stride)
} fields;

// -- fields ---------------------------------------------------------------------------------------

static bough_twist load(const fields *f, const double *field, int i, int k) {
    const double *x = field + (size_t)6 * i * f->piece->stride + k;
    int s = f->piece->stride;
    return (bough_twist){{x[0], x[s], x[2 * s]}, {x[3 * s], x[4 * s], x[5 * s]}};
}

static void put(const fields *f, double *field, int i, int k, bough_twist v) {
    double *x = field + (size_t)6 * i * f->piece->stride + k, values[6];
    bough_twist_store(v, values);
    for (int c = 0; c < 6; c++) x[c * f->piece->stride] = values[c];
}

static bough_twist rotated(const vertex_mass *v, bough_vec3 e, bough_twist x) {
    (void)v;
    return (bough_twist){bough_cross(e, x.linear), bough_cross(e, x.angular)};
}

static bough_twist momentum(const vertex_mass *v, bough_vec3 e, bough_twist x) {
    (void)e;
    return (bough_twist){bough_scale(v->mass, x.linear), bough_mat3_mul(v->inertia, x.angular)};
}

// Rates of momentum of a velocity field in a frame that rotates about e: m e×u and, from the quadratic W×IW,
// w×I e + e×I w.
static bough_twist gyroscopic(const vertex_mass *v, bough_vec3 e, bough_twist x) {
    bough_vec3 spin = bough_cross(x.angular, bough_mat3_mul(v->inertia, e));
    return (bough_twist){bough_scale(v->mass, bough_cross(e, x.linear)),
                         bough_add(spin, bough_cross(e, bough_mat3_mul(v->inertia, x.angular)))};
}

typedef bough_twist (*vertex_map)(const vertex_mass *v, bough_vec3 e, bough_twist x);

static void map_field(const fields *f, vertex_map map, bough_vec3 e, const double *from, double *to) {
    for (int i = 0; i < f->piece->n; i++) {
        for (int k = 0; k < f->piece->m; k++) {
            put(f, to, i, k, map(&f->vertex[i], e, load(f, from, i, k)));
        }
    }
}

// to += sign · Φᵀ field (m × stride)
static void add_projection(const fields *f, const double *field, double sign, double *to) {
    int s = f->piece->stride, m = f->piece->m;
    for (int row = 0; row < 6 * f->piece->n; row++) {
        const double *left = f->shape + (size_t)row * s, *right = field + (size_t)row * s;
        for (int k = 0; k < m; k++) {
            for (int l = 0; l < m; l++) to[l * s + k] += sign * left[k] * right[l];
        }
    }
}

// -- matrices -------------------------------------------------------------------------------------

// C: projections of the rigid motions, total momentum per η; theory (37).
static void set_rigid(const fields *f) {
    bough_modal_piece *p = f->piece;
    for (int i = 0; i < p->n; i++) {
        const vertex_mass *v = &f->vertex[i];
        for (int k = 0; k < p->m; k++) {
            bough_twist x = momentum(v, bough_unit3(0), load(f, f->shape, i, k));
            bough_vec3 moment = bough_add(x.angular, bough_cross(v->position, x.linear));
            const double values[6] = {x.linear.x, x.linear.y, x.linear.z, moment.x, moment.y, moment.z};
            for (int c = 0; c < 6; c++) p->rigid[c * p->stride + k] += values[c];
        }
        p->mass += v->mass;
    }
}

// G_a, B_a of theory (35, 36), and the part of the rotating shapes e×φ outside the span.
static void set_rotating(const fields *f, int a) {
    bough_modal_piece *p = f->piece;
    int s = p->stride;
    double *rotating = p->rotating + (size_t)a * p->m * s, *rest = f->rest[a];
    map_field(f, rotated, bough_unit3(a), f->shape, rest);
    // G_a: the mass projection of e×φ
    map_field(f, momentum, bough_unit3(a), rest, f->product);
    add_projection(f, f->product, 1, rotating);
    // B_a
    map_field(f, gyroscopic, bough_unit3(a), f->shape, f->product);
    add_projection(f, f->product, 1, p->gyroscopic + (size_t)a * p->m * s);
    // e×φ less its projection
    for (int row = 0; row < 6 * p->n; row++) {
        for (int k = 0; k < p->m; k++) {
            double phi = f->shape[(size_t)row * s + k];
            for (int l = 0; l < p->m; l++) rest[(size_t)row * s + l] -= phi * rotating[l * s + k];
        }
    }
}

// The axes a, b of ω_a ω_b, which stands for both orders of different axes.
static const int square_of[BOUGH_MODAL_SQUARES][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
static int orders(int j) { return j < 3 ? 1 : 2; }

static double *field_matrix(const fields *f, int j) {
    return f->piece->field + (size_t)j * f->piece->m * f->piece->stride;
}

// N_ab without stiffening: centrifugal forces by the part of the rotating shapes outside the span.
static void set_softening(const fields *f, int j) {
    for (int order = 0; order < orders(j); order++) {
        int a = square_of[j][order], b = square_of[j][1 - order];
        map_field(f, gyroscopic, bough_unit3(b), f->rest[a], f->product);
        add_projection(f, f->product, -1, field_matrix(f, j));
    }
}

// r_ab: e_a × I e_b. In W×IW of a rigid rotation, −ω_a B_a η contains the square of ω twice.
static void set_centrifugal(const fields *f, int j) {
    const bough_modal_piece *p = f->piece;
    for (int i = 0; i < p->n; i++) {
        bough_vec3 spin = {0, 0, 0};
        for (int order = 0; order < orders(j); order++) {
            int a = square_of[j][order], b = square_of[j][1 - order];
            bough_vec3 h = bough_mat3_mul(f->vertex[i].inertia, bough_unit3(b));
            spin = bough_add(spin, bough_cross(bough_unit3(a), h));
        }
        for (int k = 0; k < p->m; k++) {
            p->centrifugal[j * p->stride + k] += bough_dot(load(f, f->shape, i, k).angular, spin);
        }
    }
}

// -- stiffening -----------------------------------------------------------------------------------

// The force on vertex i (from 0, of the moving ones) that belongs to field j, per unit of it.
static bough_vec3 field_force(const fields *f, int j, int i) {
    const vertex_mass *v = &f->vertex[i];
    if (j >= 9) return i == f->piece->n - 1 ? bough_unit3(j - 9) : bough_v3(0, 0, 0);
    if (j >= BOUGH_MODAL_SQUARES) return bough_scale(-v->mass, bough_unit3(j - BOUGH_MODAL_SQUARES));
    bough_vec3 sum = {0, 0, 0};
    for (int order = 0; order < orders(j); order++) {
        int a = square_of[j][order], b = square_of[j][1 - order];
        sum = bough_add(sum, bough_cross(bough_unit3(a), bough_cross(bough_unit3(b), v->position)));
    }
    return bough_scale(-v->mass, sum);
}

static bough_vec3 displacement(const bough_modal_piece *p, int i, int k) {
    if (i == 0) return bough_v3(0, 0, 0);
    const double *x = p->shape + (size_t)6 * (i - 1) * p->stride + k;
    return bough_v3(x[0], x[p->stride], x[2 * p->stride]);
}

// theory (38): the axial force N of a segment stiffens, −N/h (E − t tᵀ) between the displacements of its
// ends.
static void subtract_string(const fields *f, int n, double tension, double *to) {
    const bough_modal_piece *p = f->piece;
    bough_vec3 t = bough_sub(p->rod->position0[n + 1], p->rod->position0[n]);
    double h = bough_norm(t), weight = tension / h;
    t = bough_scale(1 / h, t);
    for (int k = 0; k < p->m; k++) {
        bough_vec3 d = bough_sub(displacement(p, n + 1, k), displacement(p, n, k));
        bough_vec3 across = bough_axpy(-bough_dot(t, d), t, d);
        for (int l = 0; l < p->m; l++) {
            bough_vec3 e = bough_sub(displacement(p, n + 1, l), displacement(p, n, l));
            to[k * p->stride + l] -= weight * bough_dot(across, e);
        }
    }
}

// The axial force of each segment by field j, summed from the tip inwards.
static void set_stiffening(const fields *f, int j) {
    const bough_rod_model *rod = f->piece->rod;
    bough_vec3 outer = {0, 0, 0}; // force on the vertices beyond the segment
    for (int n = f->piece->n - 1; n >= 0; n--) {
        outer = bough_add(outer, field_force(f, j, n));
        bough_vec3 t = bough_sub(rod->position0[n + 1], rod->position0[n]);
        subtract_string(f, n, bough_dot(outer, t) / bough_norm(t), field_matrix(f, j));
    }
}

// -- whole ----------------------------------------------------------------------------------------

// Inertia of a vertex about its mass centre, by Steiner, in frame axes.
static vertex_mass mass_of(const bough_rod_model *rod, int i) {
    const bough_vertex_inertia *v = &rod->vertex[i];
    bough_mat3 r = bough_rotation_matrix(rod->rotation0[i]);
    bough_vec3 zeta = bough_scale(1 / v->mass, v->moment);
    bough_mat3 about = bough_mat3_symmetric(v->inertia);
    about = bough_mat3_add(about, bough_steiner(bough_scale(-0.5 * v->mass, zeta), zeta));
    bough_vec3 arm = bough_mat3_mul(r, zeta);
    about = bough_mat3_product(r, bough_mat3_product(about, bough_mat3_transpose(r)));
    return (vertex_mass){v->mass, arm, bough_add(rod->position0[i], arm), about};
}

static void take_memory(bough_arena *arena, bough_arena *work, fields *f) {
    bough_modal_piece *p = f->piece;
    size_t s = (size_t)p->stride, matrix = (size_t)p->m * s, field = 6 * (size_t)p->n * s;
    p->rigid = bough_arena_doubles(arena, 6 * s);
    p->centrifugal = bough_arena_doubles(arena, BOUGH_MODAL_SQUARES * s);
    bough_arena_each(arena, 3 * matrix, &p->rotating, &p->gyroscopic);
    p->field = bough_arena_doubles(arena, BOUGH_MODAL_FIELDS * matrix);
    f->vertex = bough_arena_take(work, (size_t)p->n * sizeof *f->vertex);
    bough_arena_each(work, field, &f->shape, &f->product, &f->rest[0], &f->rest[1], &f->rest[2]);
}

static void set_all(fields *f, bool stiffening) {
    bough_modal_piece *p = f->piece;
    // shapes as fields: displacements of the mass centres
    for (int i = 0; i < p->n; i++) {
        f->vertex[i] = mass_of(p->rod, i + 1);
        for (int k = 0; k < p->m; k++) {
            bough_twist x = load(f, p->shape, i, k);
            x.linear = bough_add(x.linear, bough_cross(x.angular, f->vertex[i].arm));
            put(f, f->shape, i, k, x);
        }
    }
    set_rigid(f);
    for (int a = 0; a < 3; a++) set_rotating(f, a);
    for (int j = 0; j < BOUGH_MODAL_SQUARES; j++) {
        set_softening(f, j);
        set_centrifugal(f, j);
    }
    for (int j = 0; j < BOUGH_MODAL_FIELDS && stiffening; j++) set_stiffening(f, j);
}

// All other matrices from the shapes.
static void modal_matrices(bough_arena *arena, bough_modal_options options, bough_modal_piece *piece) {
    fields f = {.piece = piece};
    bough_arena *work = bough_arena_child(arena);
    take_memory(arena, work, &f);
    set_all(&f, options.stiffening);
    bough_arena_destroy(work);
}

// -- a piece --------------------------------------------------------------------------------------

bough_status bough_modal_piece_create(bough_arena *arena, const bough_rod_def *def, int first, int last,
                                      bough_modal_options options, bough_modal_piece *piece) {
    size_t vertices = (size_t)(last - first) + 1;
    bough_vec3 *position = bough_arena_take(arena, vertices * sizeof *position);
    bough_rod_model *rod = NULL;
    for (size_t i = 0; i < vertices; i++) {
        position[i] = bough_sub(def->position[first + i], def->position[first]);
    }
    bough_rod_def part = *def;
    part.carries = false;
    part.n_segment = last - first;
    part.span += first;
    part.position = position;
    part.rotation += first;
    part.stiffness += 21 * first;
    part.damping += 21 * first;
    part.inertia += first;
    part.bow = NULL;
    part.line = NULL; // the whole body's loads are lumped
    BOUGH_TRY(bough_rod_create(arena, &part, &rod));
    *piece =
        (bough_modal_piece){.rod = rod, .first = first, .n = last - first, .inner = last < def->n_segment};
    BOUGH_TRY(bough_modal_basis(arena, options, piece));
    modal_matrices(arena, options, piece);
    return bough_ok();
}
