// An eigenvector of the whole scene as motion of its bodies, and its name.
#include "apps/bough/analysis/vibration.h"

#include "core/tree/dynamics.h"

#include <float.h>

// A flexible beam's vertices and their tangents along the shape, as rod.h lays them out.
typedef struct beam_shape {
    const double *state;      // (13 n)
    const double *tangent[2]; // (13 n) real and imaginary part
    double *memory;           // (3 × 13 n) of both unless a rod, whose own they are
} beam_shape;

typedef struct mode_shape {
    const bough_simulation *simulation;
    const bough_blade_group *group;
    const double *state; // (n_state) that the modes are about
    const bough_eigen_pair *pair;
    double *moved;    // (n_state) work
    beam_shape *beam; // (n_beam)
} mode_shape;

// The real or imaginary part of the eigenvector (n_state).
static const double *part_of(const mode_shape *x, int part) {
    return part == 0 ? x->pair->shape_real : x->pair->shape_imag;
}

static const beam_shape *beam_of(const mode_shape *x, const bough_beam *beam) {
    return &x->beam[beam - x->simulation->beam];
}

static void take(bough_arena *arena, mode_shape *x) {
    const bough_simulation *s = x->simulation;
    x->moved = bough_arena_doubles(arena, (size_t)x->simulation->assembly->n_state + 1);
    x->beam = bough_arena_take(arena, ((size_t)s->n_beam + 1) * sizeof *x->beam);
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].modal == NULL) continue;
        size_t n = (size_t)BOUGH_ROD_STATES * s->beam[k].mesh->n;
        x->beam[k].memory = bough_arena_doubles(arena, 3 * n);
    }
}

// -- beams ----------------------------------------------------------------------------------------

// The vertices of a modal body at its state and frame's twist moved by a part of the shape.
static void expand(const mode_shape *x, const bough_beam *beam, int part, double step, double *to) {
    const bough_simulation *s = x->simulation;
    const bough_frame *frame = &s->tree->markers[beam->marker];
    int at = bough_beam_row(x->simulation, beam), n = s->rod[beam->port].system.n_state;
    bough_twist twist = bough_tree_frame_twist(s->view, frame);
    double input[BOUGH_ROD_INPUTS] = {0}, change[6] = {0}; // gravity does not matter
    bough_twist_store(twist, input);
    if (frame->link >= 0) {
        bough_twist_store(bough_twist_to_child(&frame->placement, s->view->acceleration[frame->link]),
                          change);
    }
    for (int c = 0; c < 6; c++) input[c] += step * change[c];
    for (int k = 0; k < n; k++) x->moved[k] = x->state[at + k] + step * part_of(x, part)[at + k];
    memcpy(to, bough_modal_body_vertices(beam->modal, x->moved, input, 1),
           (size_t)BOUGH_ROD_STATES * beam->mesh->n * sizeof *to);
}

// Central differences, with steps that change no state by more than 1e-6.
static void set_modal(const mode_shape *x, const bough_beam *beam, beam_shape *b) {
    size_t n = (size_t)BOUGH_ROD_STATES * beam->mesh->n;
    for (int part = 0; part < 2; part++) {
        double most = DBL_MIN, *to = b->memory + (size_t)(1 + part) * n;
        for (int k = 0; k < x->simulation->assembly->n_state; k++)
            most = fmax(most, fabs(part_of(x, part)[k]));
        double step = 1e-6 / most;
        bough_tree_tangent(x->simulation->tree, x->state, part_of(x, part), x->simulation->view);
        expand(x, beam, part, -step, b->memory);
        expand(x, beam, part, step, to);
        for (size_t k = 0; k < n; k++) to[k] = (to[k] - b->memory[k]) / (2 * step);
        b->tangent[part] = to;
    }
    expand(x, beam, 0, 0, b->memory);
    b->state = b->memory;
}

// Finds the vertices of the beams for x->pair.
static void set_beams(const mode_shape *x) {
    for (int k = 0; k < x->simulation->n_beam; k++) {
        const bough_beam *beam = &x->simulation->beam[k];
        beam_shape *b = &x->beam[k];
        if (beam->port < 0) continue;
        int at = bough_beam_row(x->simulation, beam);
        if (beam->modal != NULL) {
            set_modal(x, beam, b);
            continue;
        }
        b->state = x->state + at;
        for (int part = 0; part < 2; part++) b->tangent[part] = part_of(x, part) + at;
    }
}

// -- rows -----------------------------------------------------------------------------------------

static int rows_of(const bough_simulation *s, int body) {
    const bough_beam *beam = bough_simulation_beam(s, body);
    return beam != NULL && beam->port >= 0 ? beam->def.n_segment + 1 : 1;
}

static int count_rows(const bough_simulation *s) {
    int n = 0;
    for (int i = 0; i < s->scene->n_body; i++) n += rows_of(s, i);
    return n;
}

// Sets the view so that twists of frames are their displacements along a part of the shape: the speeds of
// joints are set to the changes of their coordinates.
static void set_displacements(const mode_shape *x, int part) {
    const bough_tree *tree = x->simulation->tree;
    memcpy(x->moved, x->state, (size_t)tree->n_q * sizeof *x->moved);
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        int q = link->first_coordinate;
        bough_joint_speed(&link->joint, x->state + q, part_of(x, part) + q,
                          x->moved + tree->n_q + link->first_speed);
    }
    bough_tree_kinematics(tree, x->moved, x->simulation->view);
}

// A vertex with states, against its frame's displacement, in the frame's axes.
static bough_twist add_vertex(const mode_shape *x, const bough_beam *beam, int part, int i,
                              bough_twist frame) {
    const beam_shape *b = beam_of(x, beam);
    const double *y = b->state + i - 1, *d = b->tangent[part] + i - 1;
    int n = beam->mesh->n;
    bough_vec3 arm = {y[0], y[n], y[2 * n]}, shift = {d[0], d[n], d[2 * n]};
    bough_quaternion p = {y[3 * n], y[4 * n], y[5 * n], y[6 * n]};
    bough_quaternion dp = {d[3 * n], d[4 * n], d[5 * n], d[6 * n]};
    bough_quaternion turn = bough_quaternion_product(dp, bough_quaternion_conjugate(p));
    bough_vec3 swept = bough_add(frame.linear, bough_cross(frame.angular, arm));
    return (bough_twist){bough_add(swept, shift),
                         bough_axpy(2, bough_v3(turn.x, turn.y, turn.z), frame.angular)};
}

static void store(const bough_simulation *s, const bough_frame *frame, bough_twist motion, double to[6]) {
    bough_mat3 r = bough_tree_frame_pose(s->view, frame).rotation;
    bough_twist_store((bough_twist){bough_mat3_mul(r, motion.linear), bough_mat3_mul(r, motion.angular)}, to);
}

static void move_body(const mode_shape *x, int body, int part, bough_shape_row *row) {
    const bough_simulation *s = x->simulation;
    const bough_beam *beam = bough_simulation_beam(s, body);
    const bough_frame *frame = &s->tree->bodies[body];
    bough_twist own = bough_tree_frame_twist(s->view, frame);
    for (int i = 0; i < rows_of(s, body); i++, row++) {
        row->body = body;
        row->span = i == 0 ? 0 : beam->def.span[i];
        if (i == 0) {
            store(s, frame, own, row->motion[part]);
        } else if (i <= beam->mesh->n) {
            store(s, frame, add_vertex(x, beam, part, i, own), row->motion[part]);
        } else {
            const bough_frame *end = &s->tree->bodies[s->scene->n_body + beam->end];
            store(s, end, bough_tree_frame_twist(s->view, end), row->motion[part]);
        }
    }
}

// The component whose modulus is the largest, of displacements or else of rotations.
static void scale_rows(bough_shape_row *row, int n) {
    const double *at[2] = {row->motion[0], row->motion[1]};
    double most = 0;
    for (int from = 0; from < 6 && most == 0; from += 3) {
        for (int k = 0; k < 3 * n; k++) {
            bough_shape_row *r = &row[k / 3];
            int c = from + k % 3;
            double square = pow(r->motion[0][c], 2) + pow(r->motion[1][c], 2);
            if (square > most) at[0] = &r->motion[0][c], at[1] = &r->motion[1][c];
            most = fmax(most, square);
        }
    }
    double real = most > 0 ? *at[0] / most : 1, imaginary = most > 0 ? -*at[1] / most : 0;
    for (int k = 0; k < 6 * n; k++) {
        double *a = &row[k / 6].motion[0][k % 6], *b = &row[k / 6].motion[1][k % 6], old = *a;
        *a = real * old - imaginary * *b;
        *b = real * *b + imaginary * old;
    }
}

// Scaled so that the largest displacement, or else rotation, is real and 1.
static void set_rows(const mode_shape *x, bough_shape_row *row) {
    const bough_simulation *s = x->simulation;
    for (int part = 0; part < 2; part++) {
        bough_shape_row *next = row;
        set_displacements(x, part);
        for (int i = 0; i < s->scene->n_body; i++) {
            move_body(x, i, part, next);
            next += rows_of(s, i);
        }
    }
    scale_rows(row, count_rows(s));
    bough_tree_kinematics(s->tree, x->state, s->view);
}

// -- energy ---------------------------------------------------------------------------------------

// The body of the scene that moves with a link: the one on its joint; for the end of a rod the first body
// fixed to it, or else the rod.
static int body_on(const bough_simulation *s, int link) {
    int n = s->scene->n_body, body = s->tree->links[link].body;
    for (int i = 0; i < n && body >= n; i++) {
        if (s->tree->bodies[i].link == link) body = i;
    }
    for (int k = 0; k < s->n_beam && body >= n; k++) {
        if (s->beam[k].end == s->tree->links[link].body - n) {
            body = s->beam[k].index;
        }
    }
    return body;
}

// Kinetic energy of the links along the shape.
static void add_links(const mode_shape *x, int part, double *share) {
    const bough_simulation *s = x->simulation;
    bough_tree_tangent(s->tree, x->state, part_of(x, part), s->view);
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        bough_twist v = s->view->acceleration[i];
        share[body_on(s, i)] += bough_power(v, bough_inertia_mul(&link->inertia, v));
    }
}

static double beam_energy(const mode_shape *x, const bough_beam *beam, int part) {
    const beam_shape *b = beam_of(x, beam);
    return bough_rod_energy(beam->mesh, b->state, b->tangent[part] + (size_t)BOUGH_ROD_U * beam->mesh->n);
}

static void set_shares(const mode_shape *x, bough_scene_mode *mode) {
    const bough_simulation *s = x->simulation;
    int n_body = s->scene->n_body;
    double sum = 0, blades = 0;
    for (int part = 0; part < 2; part++) {
        add_links(x, part, mode->share);
        for (int k = 0; k < s->n_beam; k++) {
            if (s->beam[k].port < 0) continue;
            mode->share[s->beam[k].body - s->scene->body] += beam_energy(x, &s->beam[k], part);
        }
    }
    for (int i = 0; i < n_body; i++) sum += mode->share[i];
    for (int i = 0; i < n_body; i++) {
        mode->share[i] /= sum > 0 ? sum : 1;
        if (mode->share[i] > mode->share[mode->body]) mode->body = i;
    }
    for (int k = 0; k < x->group->n; k++) {
        blades += mode->share[x->group->blade[k]->body - s->scene->body];
    }
    if (blades <= mode->share[mode->body]) return;
    mode->blades = true;
    mode->body = x->group->blade[0]->index;
}

// -- bending ------------------------------------------------------------------------------------

enum { BENDING = 6 };

// Displacement (c < 3) or rotation of a vertex relative to the body, times the square root of its mass or
// inertia.
static double bending(const mode_shape *x, const bough_beam *beam, int part, int i, int c) {
    const bough_rod_model *m = beam->mesh;
    int n = m->n;
    const double *d = beam_of(x, beam)->tangent[part], *y = beam_of(x, beam)->state;
    const bough_vertex_inertia *v = &m->vertex[i + 1];
    if (c < 3) return sqrt(v->mass) * d[c * n + i];
    bough_quaternion p = {y[3 * n + i], -y[4 * n + i], -y[5 * n + i], -y[6 * n + i]};
    bough_quaternion dp = {d[3 * n + i], d[4 * n + i], d[5 * n + i], d[6 * n + i]};
    bough_quaternion turn = bough_quaternion_product(p, dp);
    const double turns[3] = {turn.x, turn.y, turn.z};
    return 2 * sqrt(v->inertia[c - 3]) * turns[c - 3];
}

static void add_direction(const mode_shape *x, const bough_beam *beam, double *sum) {
    for (int i = 0; i < beam->mesh->n; i++) {
        for (int part = 0; part < 2; part++) {
            for (int c = 0; c < 3; c++) sum[c] += pow(bending(x, beam, part, i, c), 2);
            sum[BOUGH_ROD_TORSION] += pow(bending(x, beam, part, i, 5), 2);
        }
    }
}

// Kinetic energy of a rigid body: of its mass centre along the ground's axes, and of its rotation.
static void add_motion(const mode_shape *x, int body, int part, double *sum) {
    const bough_simulation *s = x->simulation;
    int link = s->tree->bodies[body].link;
    if (link < 0) return;
    const bough_inertia *inertia = &s->tree->links[link].inertia;
    bough_tree_tangent(s->tree, x->state, part_of(x, part), s->view);
    bough_twist twist = s->view->acceleration[link];
    bough_wrench momentum = bough_inertia_mul(inertia, twist);
    bough_vec3 p = bough_mat3_mul(s->view->pose[link].rotation, momentum.force);
    const double along[3] = {p.x, p.y, p.z};
    sum[3] += bough_power(twist, momentum);
    for (int c = 0; c < 3; c++) {
        double energy = along[c] * along[c] / fmax(inertia->mass, DBL_MIN);
        sum[c] += energy;
        sum[3] -= energy;
    }
}

static void set_direction(const mode_shape *x, bough_scene_mode *mode) {
    const bough_beam *beam = bough_simulation_beam(x->simulation, mode->body);
    double sum[BOUGH_ROD_DIRECTIONS] = {0};
    bool rigid = !mode->blades && (beam == NULL || beam->port < 0);
    for (int part = 0; rigid && part < 2; part++) add_motion(x, mode->body, part, sum);
    if (!mode->blades && !rigid) add_direction(x, beam, sum);
    for (int k = 0; mode->blades && k < x->group->n; k++) add_direction(x, x->group->blade[k], sum);
    mode->direction = 0;
    for (int c = 0; c < BOUGH_ROD_DIRECTIONS; c++) {
        if (sum[c] > sum[mode->direction]) mode->direction = c;
    }
}

// -- patterns -------------------------------------------------------------------------------------

const char *const bough_pattern_names[BOUGH_PATTERNS] = {"",       "collective", "forward",     "backward",
                                                         "cosine", "sine",       "reactionless"};

// Mean squares of a pattern over the blades, by its components.
typedef struct pattern {
    double whole, collective, plus, minus, cosine, sine;
} pattern;

static double square(const double x[2]) { return x[0] * x[0] + x[1] * x[1]; }

static void add_pattern(const bough_blade_group *group, const double *real, const double *imaginary,
                        pattern *sum) {
    double share[2], c[2] = {0, 0}, s[2] = {0, 0};
    int n = group->n;
    for (int k = 0; k < n; k++) {
        double angle = group->azimuth + 2 * BOUGH_PI * k / n;
        sum->whole += (real[k] * real[k] + imaginary[k] * imaginary[k]) / n;
        c[0] += cos(angle) * real[k] / n, c[1] += cos(angle) * imaginary[k] / n;
        s[0] += sin(angle) * real[k] / n, s[1] += sin(angle) * imaginary[k] / n;
    }
    sum->cosine += square(c);
    sum->sine += square(s);
    bough_modes_harmonic(n, 0, real, imaginary, share);
    sum->collective += square(share);
    bough_modes_harmonic(n, 1, real, imaginary, share);
    sum->plus += square(share);
    bough_modes_harmonic(n, -1, real, imaginary, share);
    sum->minus += square(share);
}

static bough_pattern name_pattern(const pattern *p, const double whirl[3]) {
    double whirling = whirl[1] + whirl[2], rest = 1 - whirl[0] - whirling;
    if (whirl[0] >= fmax(whirling, rest)) return BOUGH_PATTERN_COLLECTIVE;
    if (rest > whirling) return BOUGH_PATTERN_REACTIONLESS;
    if (whirl[1] > 2 * whirl[2]) return BOUGH_PATTERN_FORWARD;
    if (whirl[2] > 2 * whirl[1]) return BOUGH_PATTERN_BACKWARD;
    return p->cosine > p->sine ? BOUGH_PATTERN_COSINE : BOUGH_PATTERN_SINE;
}

// A pattern exp(−i 2πk/n) exp(iωt) is cos(ωt − 2πk/n): it runs towards growing azimuth.
static void set_pattern(const mode_shape *x, bough_scene_mode *mode) {
    const bough_blade_group *g = x->group;
    pattern sum = {0};
    if (g->n == 0 || g->n > BOUGH_MOST_BLADES) return;
    for (int i = 0; i < g->blade[0]->mesh->n; i++) {
        for (int c = 0; c < BENDING; c++) {
            double real[BOUGH_MOST_BLADES], imaginary[BOUGH_MOST_BLADES];
            for (int k = 0; k < g->n; k++) {
                real[k] = bending(x, g->blade[k], 0, i, c);
                imaginary[k] = bending(x, g->blade[k], 1, i, c);
            }
            add_pattern(g, real, imaginary, &sum);
        }
    }
    if (!(sum.whole > 0)) return;
    bool reversed = g->speed < 0;
    mode->whirl[0] = sum.collective / sum.whole;
    mode->whirl[1] = (reversed ? sum.plus : sum.minus) / sum.whole;
    mode->whirl[2] = (reversed ? sum.minus : sum.plus) / sum.whole;
    mode->pattern = name_pattern(&sum, mode->whirl);
}

void bough_vibration_describe(bough_arena *arena, const bough_simulation *s,
                              const bough_vibration_point *point, bough_vibration *v) {
    mode_shape x = {.simulation = s, .group = &point->group, .state = point->state};
    v->n_row = count_rows(s);
    take(arena, &x);
    for (int k = 0; k < v->found; k++) {
        bough_scene_mode *mode = &v->mode[k];
        x.pair = &v->pair[k];
        set_beams(&x);
        mode->share = bough_arena_doubles(arena, (size_t)s->scene->n_body);
        set_shares(&x, mode);
        set_direction(&x, mode);
        set_pattern(&x, mode);
        if (!s->scene->modes.shapes) continue;
        mode->shape = bough_arena_take(arena, (size_t)v->n_row * sizeof *mode->shape);
        set_rows(&x, mode->shape);
    }
}
