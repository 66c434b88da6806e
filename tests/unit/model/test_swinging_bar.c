// The paper's example 5.1: a rubber bar hinged to the ground swings under gravity. The body-frame
// formulation in the tree must give the motion of a stand-alone rod in absolute coordinates, here
// integrated by the classical Runge–Kutta method straight from the segment forces; both are put
// beside an independent solution.
#include "tests/unit/built_scene.h"

enum { SEGMENTS = 16, COMPONENTS = 13, UNKNOWNS = COMPONENTS * SEGMENTS + 2 };

static const double gravity = 9.81; // along −z

// -- absolute coordinates -------------------------------------------------------------------------

// Unknowns: x p u W of vertices 1..N as rod.h lays them out, in ground axes; then the angle of the
// hinge about y and its rate. The bar at angle 0 points along x.
typedef struct absolute_bar {
    const bough_rod_model *model;
    bough_rod_scratch scratch;
} absolute_bar;

static bough_mat3 bar_axes(double angle) {
    double tilt = BOUGH_PI / 2 + angle; // rotation about y that takes z onto the bar
    return bough_rotation_matrix(bough_quaternion_exponential(bough_v3(0, tilt, 0)));
}

static void set_vertex(absolute_bar *b, int i, const double values[COMPONENTS]) {
    for (int c = 0; c < COMPONENTS; c++) b->scratch.vertex[c * b->model->stride + i] = values[c];
}

static void place_vertices(absolute_bar *b, const double *y) {
    double angle = y[COMPONENTS * SEGMENTS], rate = y[COMPONENTS * SEGMENTS + 1];
    bough_quaternion p = bough_quaternion_exponential(bough_v3(0, BOUGH_PI / 2 + angle, 0));
    set_vertex(b, 0, (const double[]){0, 0, 0, p.w, p.x, p.y, p.z, 0, 0, 0, 0, rate, 0});
    for (int i = 0; i < SEGMENTS; i++) {
        double values[COMPONENTS];
        for (int c = 0; c < COMPONENTS; c++) values[c] = y[c * SEGMENTS + i];
        double norm = sqrt(values[3] * values[3] + values[4] * values[4] + values[5] * values[5] +
                           values[6] * values[6]);
        for (int c = 3; c < 7; c++) values[c] /= norm;
        set_vertex(b, i + 1, values);
    }
}

static bough_vec3 part(const double *a, int stride, int i) {
    return bough_v3(a[i], a[stride + i], a[2 * stride + i]);
}

// (11) in section axes for a vertex whose first moment lies along its axis, s = (0, 0, s), and
// whose inertia is diagonal: solved by hand.
static void balance(const bough_vertex_inertia *v, bough_vec3 f, bough_vec3 l, bough_vec3 *a,
                    bough_vec3 *alpha) {
    double m = v->mass, s = v->moment.z;
    double jx = v->inertia[0] - s * s / m, jy = v->inertia[1] - s * s / m;
    alpha->x = (l.x + s / m * f.y) / jx;
    alpha->y = (l.y - s / m * f.x) / jy;
    alpha->z = l.z / v->inertia[2];
    a->x = (f.x - s * alpha->y) / m;
    a->y = (f.y + s * alpha->x) / m;
    a->z = f.z / m;
}

static void vertex_rate(const absolute_bar *b, int i, double *rate) {
    int s = b->model->stride, n = SEGMENTS;
    const double *x = b->scratch.vertex, *f = b->scratch.segment;
    const bough_vertex_inertia *v = &b->model->vertex[i];
    bough_quaternion p = {x[3 * s + i], x[4 * s + i], x[5 * s + i], x[6 * s + i]};
    bough_mat3 r = bough_rotation_matrix(p);
    bough_vec3 u = part(x + 7 * s, s, i), w = part(x + 10 * s, s, i);
    bough_vec3 force = bough_sub(part(f, s, i), part(f, s, i - 1));
    bough_vec3 moment = bough_add(part(f + 3 * s, s, i), part(f + 6 * s, s, i - 1));
    bough_vec3 offset = v->moment, weight = {0, 0, -gravity}, a, alpha;
    bough_vec3 inner = bough_sub(bough_mat3_tmul(r, force), bough_cross(w, bough_cross(w, offset)));
    bough_vec3 spin = bough_mat3_mul(bough_mat3_symmetric(v->inertia), w);
    bough_vec3 turn = bough_sub(moment, bough_cross(w, spin));
    balance(v, inner, turn, &a, &alpha);
    bough_vec3 udot = bough_add(bough_mat3_mul(r, a), weight);
    bough_quaternion pdot = bough_quaternion_product(p, (bough_quaternion){0, w.x, w.y, w.z});
    const double values[COMPONENTS] = {u.x,    u.y,    u.z,    pdot.w / 2, pdot.x / 2, pdot.y / 2, pdot.z / 2,
                                       udot.x, udot.y, udot.z, alpha.x,    alpha.y,    alpha.z};
    for (int c = 0; c < COMPONENTS; c++) rate[c * n + i - 1] = values[c];
}

static void absolute_rate(absolute_bar *b, const double *y, double *rate) {
    place_vertices(b, y);
    assert_true(bough_rod_forces(b->model, 0, SEGMENTS, &b->scratch));
    for (int i = 1; i <= SEGMENTS; i++) vertex_rate(b, i, rate);
    const bough_vertex_inertia *root = &b->model->vertex[0];
    double angle = y[COMPONENTS * SEGMENTS];
    bough_vec3 weight = bough_mat3_tmul(bar_axes(angle), bough_v3(0, 0, -gravity));
    double moment = b->scratch.segment[4 * b->model->stride] + bough_cross(root->moment, weight).y;
    rate[COMPONENTS * SEGMENTS] = y[COMPONENTS * SEGMENTS + 1];
    rate[COMPONENTS * SEGMENTS + 1] = moment / root->inertia[1];
}

static void runge_kutta(absolute_bar *b, double h, double *y) {
    double k[4][UNKNOWNS], z[UNKNOWNS];
    const double node[3] = {0.5, 0.5, 1};
    absolute_rate(b, y, k[0]);
    for (int stage = 0; stage < 3; stage++) {
        for (int i = 0; i < UNKNOWNS; i++) z[i] = y[i] + node[stage] * h * k[stage][i];
        absolute_rate(b, z, k[stage + 1]);
    }
    for (int i = 0; i < UNKNOWNS; i++) {
        y[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
}

static void start_at_rest(const bough_rod_model *m, double *y) {
    bough_quaternion p = bough_quaternion_exponential(bough_v3(0, BOUGH_PI / 2, 0));
    memset(y, 0, UNKNOWNS * sizeof *y);
    for (int i = 0; i < SEGMENTS; i++) {
        y[i] = m->span[i + 1];
        y[3 * SEGMENTS + i] = p.w;
        y[5 * SEGMENTS + i] = p.y;
    }
}

// -- the tree's formulation -----------------------------------------------------------------------

static bough_simulation *in_the_tree(bough_arena *arena, const char *segments) {
    const char *sets[] = {"simulation.duration=0.4 s", "simulation.coupling.scheme=monolithic",
                          "simulation.master.rtol=1e-9", segments, NULL};
    return scene_build(arena, "apps/beams/rubber-bar.yaml", sets);
}

static bough_vec3 tip_of(bough_simulation *s) {
    const bough_beam *beam = &s->beam[0];
    int n = beam->def.n_segment;
    const double *y = s->rod[beam->port].state;
    bough_simulation_update(s);
    bough_transform pose = bough_tree_frame_pose(s->view, &s->tree->markers[beam->marker]);
    bough_vec3 x = {y[n - 1], y[2 * n - 1], y[3 * n - 1]};
    return bough_add(pose.position, bough_mat3_mul(pose.rotation, x));
}

static void advance_to(bough_simulation *s, double t) {
    while (s->master->time < t - 1e-9) scene_step(s);
}

// -- tests ----------------------------------------------------------------------------------------

TEST(body_frame_and_absolute_formulation_agree) {
    check_arena(arena);
    bough_simulation *s = in_the_tree(arena, "bodies[0].rod.segments=16");
    absolute_bar bar = {.model = bough_rod_body_model(s->beam[0].rod)};
    double y[UNKNOWNS];
    assert_int_equal(bar.model->n, SEGMENTS);
    bough_rod_scratch_init(&bar.scratch, arena, bar.model);
    start_at_rest(bar.model, y);
    const int steps = 2000; // per 0.1 s
    for (int k = 1; k <= 4; k++) {
        for (int i = 0; i < steps; i++) runge_kutta(&bar, 0.1 / steps, y);
        advance_to(s, 0.1 * k);
        bough_vec3 tip = tip_of(s);
        check_near(tip.x, y[SEGMENTS - 1], 0, 1e-6);
        check_near(tip.z, y[3 * SEGMENTS - 1], 0, 1e-6);
        check_near(tip.y, 0, 0, 1e-9);
    }
}

// Independent solution, extrapolated over meshes: tip (x, z) of the hinged bar.
TEST(motion_is_that_of_an_independent_rod) {
    const double reference[4][2] = {{0.9935974715, -0.04889315378},
                                    {0.9418956619, -0.1981176134},
                                    {0.797987699, -0.424504581},
                                    {0.4762209743, -0.8418855077}};
    check_arena(arena);
    bough_simulation *s = in_the_tree(arena, "bodies[0].rod.segments=40");
    for (int k = 0; k < 4; k++) {
        advance_to(s, 0.1 * (k + 1));
        bough_vec3 tip = tip_of(s);
        check_near(tip.x, reference[k][0], 0, 2e-3);
        check_near(tip.z, reference[k][1], 0, 2e-3);
    }
}
