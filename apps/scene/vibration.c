#include "apps/scene/vibration.h"

#include "apps/scene/blade_group.h"
#include "apps/scene/steady.h"
#include "core/dynamics.h"
#include "cosim/modes.h"

#include <float.h>
#include <string.h>

const char *const bough_pattern_names[BOUGH_PATTERNS] = {
    "", "collective", "forward", "backward", "cosine", "sine", "reactionless"};

// Eigenvalues are sought about this point of the real axis, and several times the spin [1/s].
static const double least_point = 1, spins = 4;

// |λ| below this share of the point is a free motion: its double zero comes out as the square root
// of the rounding.
static const double free_motion = 1e-3;

enum { FREE_MOTIONS = 8 }; // that may be found before the modes

static const double rounding = 1e-10;   // damping ratios below it are none

// A flexible beam's vertices and their tangents along the shape, as rod.h lays them out.
typedef struct beam_shape {
    const double *state;       // (13 n)
    const double *tangent[2];  // (13 n) real and imaginary part
    double *memory;            // (3 × 13 n) of both unless a rod, whose own they are
} beam_shape;

// What shares are taken of.
typedef struct shape {
    const bough_simulation *simulation;
    const bough_assembly *assembly;
    const bough_blade_group *group;
    const double *state;          // (n_state) that the modes are about
    double *moved;                // (n_state) work
    const bough_eigen_pair *pair;
    beam_shape *beam;             // (n_beam)
} shape;

static const double *part_of(const shape *x, int part) {
    return part == 0 ? x->pair->shape_real : x->pair->shape_imag;
}

// -- beams ----------------------------------------------------------------------------------------

// The vertices of a modal body at its state and frame's twist moved by a part of the shape.
static void expand(const shape *x, const bough_beam *beam, int part, double step, double *to) {
    const bough_simulation *s = x->simulation;
    const bough_frame *frame = &s->tree->markers[beam->marker];
    int at = x->assembly->state_offset[beam->port + 1], n = s->rod[beam->port].n_state;
    bough_twist twist = bough_tree_frame_twist(s->view, frame);
    double input[BOUGH_ROD_INPUTS] = {0}, change[6] = {0}; // gravity does not matter
    bough_twist_store(twist, input);
    if (frame->link >= 0) {
        bough_twist_store(
            bough_twist_to_child(&frame->placement, s->view->acceleration[frame->link]), change);
    }
    for (int c = 0; c < 6; c++) input[c] += step * change[c];
    for (int k = 0; k < n; k++) x->moved[k] = x->state[at + k] + step * part_of(x, part)[at + k];
    memcpy(to, bough_modal_body_vertices(beam->modal, x->moved, input),
           (size_t)BOUGH_ROD_STATES * bough_beam_mesh(beam)->n * sizeof *to);
}

// By central differences, of steps that move nothing by more than a millionth.
static void set_modal(const shape *x, const bough_beam *beam, beam_shape *b) {
    size_t n = (size_t)BOUGH_ROD_STATES * bough_beam_mesh(beam)->n;
    for (int part = 0; part < 2; part++) {
        double most = DBL_MIN, *to = b->memory + (size_t)(1 + part) * n;
        for (int k = 0; k < x->assembly->n_state; k++) most = fmax(most, fabs(part_of(x, part)[k]));
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

static void set_beams(const shape *x) {
    for (int k = 0; k < x->simulation->n_beam; k++) {
        const bough_beam *beam = &x->simulation->beam[k];
        beam_shape *b = &x->beam[k];
        if (beam->port < 0) continue;
        int at = x->assembly->state_offset[beam->port + 1];
        if (beam->modal != NULL) {
            set_modal(x, beam, b);
            continue;
        }
        b->state = x->state + at;
        for (int part = 0; part < 2; part++) b->tangent[part] = part_of(x, part) + at;
    }
}

static const beam_shape *shape_of(const shape *x, const bough_beam *beam) {
    return &x->beam[beam - x->simulation->beam];
}

// -- energy ---------------------------------------------------------------------------------------

// The scene's body that moves with a link: the one on its joint, or of a rod's end the first that is
// fixed to it, or else the rod.
static int body_on(const bough_simulation *s, int link) {
    int n = s->scene->n_body, body = s->tree->links[link].body;
    for (int i = 0; i < n && body >= n; i++) {
        if (s->tree->bodies[i].link == link) body = i;
    }
    for (int k = 0; k < s->n_beam && body >= n; k++) {
        if (s->beam[k].end == s->tree->links[link].body - n) {
            body = (int)(s->beam[k].body - s->scene->body);
        }
    }
    return body;
}

// Kinetic energy of the links along the shape.
static void add_links(const shape *x, int part, double *share) {
    const bough_simulation *s = x->simulation;
    bough_tree_tangent(s->tree, x->state, part_of(x, part), s->view);
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        bough_twist v = s->view->acceleration[i];
        share[body_on(s, i)] += bough_power(v, bough_inertia_mul(&link->inertia, v));
    }
}

static bough_mat3 rotation_of(const double *y, int n, int i) {
    bough_quaternion p = {y[3 * n + i], y[4 * n + i], y[5 * n + i], y[6 * n + i]};
    return bough_rotation_matrix(bough_quaternion_normalised(p));
}

static double vertex_energy(const bough_vertex_inertia *v, bough_vec3 u, bough_vec3 w) {
    const double *j = v->inertia;
    bough_inertia inertia = {
        v->mass, v->moment, {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}}};
    bough_twist twist = {u, w};
    return bough_power(twist, bough_inertia_mul(&inertia, twist));
}

static double rod_energy(const shape *x, const bough_beam *beam, int part) {
    const beam_shape *b = shape_of(x, beam);
    const bough_rod_model *m = bough_beam_mesh(beam);
    const double *d = b->tangent[part] + (size_t)BOUGH_ROD_U * m->n;
    double sum = 0;
    int n = m->n;
    for (int i = 0; i < n; i++) {
        bough_vec3 u = bough_mat3_tmul(rotation_of(b->state, n, i),
                                       bough_v3(d[i], d[n + i], d[2 * n + i]));
        bough_vec3 w = {d[3 * n + i], d[4 * n + i], d[5 * n + i]};
        sum += vertex_energy(&m->vertex[i + 1], u, w);
    }
    return sum;
}

static void set_shares(const shape *x, bough_scene_mode *mode) {
    const bough_simulation *s = x->simulation;
    int n_body = s->scene->n_body;
    double sum = 0, blades = 0;
    for (int part = 0; part < 2; part++) {
        add_links(x, part, mode->share);
        for (int k = 0; k < s->n_beam; k++) {
            if (s->beam[k].port < 0) continue;
            mode->share[s->beam[k].body - s->scene->body] += rod_energy(x, &s->beam[k], part);
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
    mode->body = (int)(x->group->blade[0]->body - s->scene->body);
}

// -- bending ------------------------------------------------------------------------------------

enum { BENDING = 6 };

// The square root of its inertia times displacement c < 3 or turn of a vertex against the body.
static double bending(const shape *x, const bough_beam *beam, int part, int i, int c) {
    const bough_rod_model *m = bough_beam_mesh(beam);
    int n = m->n;
    const double *d = shape_of(x, beam)->tangent[part], *y = shape_of(x, beam)->state;
    const bough_vertex_inertia *v = &m->vertex[i + 1];
    if (c < 3) return sqrt(v->mass) * d[c * n + i];
    bough_quaternion p = {y[3 * n + i], -y[4 * n + i], -y[5 * n + i], -y[6 * n + i]};
    bough_quaternion dp = {d[3 * n + i], d[4 * n + i], d[5 * n + i], d[6 * n + i]};
    bough_quaternion turn = bough_quaternion_product(p, dp);
    const double turns[3] = {turn.x, turn.y, turn.z};
    return 2 * sqrt(v->inertia[c - 3]) * turns[c - 3];
}

static void add_direction(const shape *x, const bough_beam *beam, double *sum) {
    for (int i = 0; i < bough_beam_mesh(beam)->n; i++) {
        for (int part = 0; part < 2; part++) {
            for (int c = 0; c < 3; c++) sum[c] += pow(bending(x, beam, part, i, c), 2);
            sum[BOUGH_ROD_TORSION] += pow(bending(x, beam, part, i, 5), 2);
        }
    }
}

// Of a rigid body: energy of its mass centre's motion along the ground's axes, and of its turn.
static void add_motion(const shape *x, int body, int part, double *sum) {
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

static void set_direction(const shape *x, bough_scene_mode *mode) {
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

// Squares of a pattern over the blades, by what they look like.
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

enum { MOST_BLADES = 16 };

// A pattern exp(−i 2πk/n) exp(iωt) is cos(ωt − 2πk/n): it runs towards growing azimuth.
static void set_pattern(const shape *x, bough_scene_mode *mode) {
    const bough_blade_group *g = x->group;
    pattern sum = {0};
    if (g->n == 0 || g->n > MOST_BLADES) return;
    for (int i = 0; i < bough_beam_mesh(g->blade[0])->n; i++) {
        for (int c = 0; c < BENDING; c++) {
            double real[MOST_BLADES], imaginary[MOST_BLADES];
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

// -- whole ----------------------------------------------------------------------------------------

static void set_value(const bough_eigen_pair *pair, bough_scene_mode *mode) {
    double modulus = hypot(pair->real, pair->imaginary);
    double ratio = -pair->real / modulus;
    mode->growth = pair->real;
    mode->frequency = modulus / (2 * BOUGH_PI);
    mode->damped_frequency = pair->imaginary / (2 * BOUGH_PI);
    mode->damping = fabs(ratio) > rounding ? ratio : 0;
}

static const double at_rest = 1e-9; // [rad/s]

// Whether something turns otherwise than a rotor whose blades allow the transform.
static bool is_frozen(const bough_simulation *s, const bough_blade_group *group) {
    bough_vec3 spin = {0, 0, 0};
    if (group->n > 0) {
        const bough_frame *rotor = &s->tree->bodies[s->scene->turbine.rotor];
        spin = bough_tree_frame_velocity(s->view, rotor).angular;
    }
    for (int i = 0; i < s->tree->n_links; i++) {
        bough_transform pose = s->view->pose[i];
        bough_vec3 w = bough_mat3_mul(pose.rotation, s->view->twist[i].angular);
        double other = bough_norm(bough_sub(w, spin));
        if (fmin(bough_norm(w), other) > at_rest) return true;
    }
    return false;
}

// What a solution needs.
typedef struct solution {
    bough_arrow *arrow;
    bough_blade_group group;
    double *state; // (n_state)
    int *held;     // rows of prescribed joints
    bough_modes_def def;
} solution;

static bough_status prepare(bough_arena *arena, bough_simulation *s, solution *x) {
    const bough_assembly *a = s->master->assembly;
    x->state = bough_arena_doubles(arena, (size_t)a->n_state + 1);
    x->held = bough_arena_take(arena, ((size_t)s->trunk.n_state + 1) * sizeof *x->held);
    if (!x->state || !x->held) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    bough_settle_state(a, x->state);
    bough_status status = bough_arrow_create(arena, a, 1, &x->arrow);
    if (!bough_is_ok(&status)) return status;
    int n_held = bough_settle_held(s->tree, false, x->held);
    status = bough_arrow_hold(arena, x->arrow, n_held, x->held);
    if (!bough_is_ok(&status)) return status;
    return bough_blade_group_find(arena, s, a, &x->group);
}

// Inputs of the equilibrium as it is, so that the rotor's whole weight and thrust are on the tree;
// the blades bend in their mean.
static void define(double time, solution *x) {
    const bough_blade_group *g = &x->group;
    bough_arrow_inputs(x->arrow, time, x->state);
    x->def = (bough_modes_def){.time = time,
                               .state = x->state,
                               .input = x->arrow->input,
                               .point = least_point,
                               .n_part = g->n,
                               .n_row = g->n_row,
                               .row = g->row};
    if (g->n == 0 || g->speed == 0) return;
    bough_blade_group_average(g, x->state);
    x->def.spin = g->speed;
    x->def.point = fmax(least_point, spins * ((g->n - 1) / 2) * fabs(g->speed));
}

static bool take_beams(bough_arena *arena, const bough_simulation *s, shape *x) {
    x->moved = bough_arena_doubles(arena, (size_t)x->assembly->n_state + 1);
    x->beam = bough_arena_take(arena, ((size_t)s->n_beam + 1) * sizeof *x->beam);
    for (int k = 0; x->beam && k < s->n_beam; k++) {
        if (s->beam[k].modal == NULL) continue;
        size_t n = (size_t)BOUGH_ROD_STATES * bough_beam_mesh(&s->beam[k])->n;
        x->beam[k].memory = bough_arena_doubles(arena, 3 * n);
    }
    return !bough_arena_exhausted(arena);
}

static bough_status describe(bough_arena *arena, const bough_simulation *s, const solution *x,
                             bough_vibration *v) {
    shape one = {.simulation = s,
                 .assembly = s->master->assembly,
                 .group = &x->group,
                 .state = x->state};
    if (!take_beams(arena, s, &one)) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    for (int k = 0; k < v->found; k++) {
        one.pair = &v->pair[k];
        set_beams(&one);
        bough_scene_mode *mode = &v->mode[k];
        mode->share = bough_arena_doubles(arena, (size_t)s->scene->n_body);
        if (!mode->share) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
        set_value(&v->pair[k], mode);
        set_shares(&one, mode);
        set_direction(&one, mode);
        set_pattern(&one, mode);
    }
    return bough_ok();
}

// Violations of closures decay at a rate of their own, which is no motion of the scene.
static bool is_closure(const bough_tree *tree, const bough_eigen_pair *pair) {
    double rate = 1 / tree->closure_time;
    return tree->n_closures > 0 && hypot(pair->real + rate, pair->imaginary) < 1e-3 * rate;
}

static void drop_other_motions(const bough_tree *tree, double point, int count,
                               bough_vibration *v) {
    int kept = 0;
    for (int k = 0; k < v->found && kept < count; k++) {
        double modulus = hypot(v->pair[k].real, v->pair[k].imaginary);
        bool moves = modulus > free_motion * point && !is_closure(tree, &v->pair[k]);
        if (moves) v->pair[kept++] = v->pair[k];
    }
    v->found = kept;
}

static bough_status solve(bough_arena *arena, bough_simulation *s, double time, int count,
                          bough_vibration *v) {
    solution x = {0};
    int wanted = count + FREE_MOTIONS + 2 * s->tree->closure_rank;
    v->pair = bough_arena_take(arena, (size_t)wanted * sizeof *v->pair);
    v->mode = bough_arena_take(arena, (size_t)count * sizeof *v->mode);
    if (!v->pair || !v->mode) return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory");
    bough_status status = prepare(arena, s, &x);
    if (!bough_is_ok(&status)) return status;
    define(time, &x);
    v->n_blade = x.group.n;
    v->spin = x.group.speed;
    v->frozen = is_frozen(s, &x.group);
    status = bough_modes_find(arena, x.arrow, &x.def, wanted, v->pair, &v->found);
    while (status.code == BOUGH_FAILED && wanted > 1) { // the highest may be beyond rounding
        wanted /= 2;
        status = bough_modes_find(arena, x.arrow, &x.def, wanted, v->pair, &v->found);
    }
    drop_other_motions(s->tree, x.def.point, count, v);
    return bough_is_ok(&status) ? describe(arena, s, &x, v) : status;
}

bool bough_vibration_wanted(const bough_simulation *s) {
    const bough_scene_modes *modes = &s->scene->modes;
    if (modes->of != BOUGH_SCENE_MODES_AUTO) return modes->of == BOUGH_SCENE_MODES_SCENE;
    bool axis = modes->axis[0] != 0 || modes->axis[1] != 0 || modes->axis[2] != 0;
    bool reduced = bough_steady_rods(s) < s->n_rod; // what is no rod has no modes by itself
    return (!bough_settle_apart(s) || reduced) && modes->speed == 0 && !axis;
}

bough_status bough_vibration_find(bough_arena *arena, bough_simulation *s, int count,
                                  bough_vibration *vibration) {
    bool settled = s->scene->modes.at == BOUGH_SCENE_IN_EQUILIBRIUM;
    double time = settled ? bough_settle_loaded(s) : 0;
    *vibration = (bough_vibration){0};
    bough_status status = bough_ok();
    if (settled) status = bough_settle(s, s->master->assembly, time, &vibration->settling);
    return bough_is_ok(&status) ? solve(arena, s, time, count, vibration) : status;
}
