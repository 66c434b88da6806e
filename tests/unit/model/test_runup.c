// The main job, whole: the run-up of the three-bladed turbine with the default scheme against its
// physics (balance of angular momentum, once and three times per revolution), the monolithic
// solution and the reference of an independent code.
#include "tests/unit/built_scene.h"

#include "apps/bough/model/aero_link.h"

enum { MOST_ROWS = 2100, BLADES = 3 };

// What a run leaves behind, a row per macro step.
typedef struct history {
    int n;
    double time[MOST_ROWS], angle[MOST_ROWS], speed[MOST_ROWS];                      // [s, rad, rad/s]
    double thrust[MOST_ROWS], torque[MOST_ROWS], weight[MOST_ROWS], load[MOST_ROWS]; // [N, N m]
    double momentum[MOST_ROWS];        // about the shaft [kg m²/s]
    double out_of_plane[MOST_ROWS];    // blade 1 [m]
    bough_vec3 tip[MOST_ROWS][BLADES]; // in blade-root axes [m]
} history;

static const double load_torque = 11.9e6; // after its ramp of 20 s [N m]

// Angular momentum of a blade about the shaft and the moment of its weight, vertex by vertex in
// ground axes; the root vertex included.
static void add_blade(const bough_simulation *s, const bough_beam *beam, bough_vec3 hub, bough_vec3 shaft,
                      double *momentum, double *weight) {
    bough_vertex_motion vertex[64];
    bough_vec3 gravity = {0, 0, -9.80665};
    bough_simulation_beam_motion(s, beam, vertex);
    for (int i = 0; i <= beam->def.n_segment; i++) {
        const bough_vertex_inertia *v = &beam->def.inertia[i];
        bough_vertex_motion m = vertex[i];
        bough_vec3 x = bough_sub(m.position, hub), w = bough_mat3_tmul(m.rotation, m.angular);
        bough_vec3 arm = bough_mat3_mul(m.rotation, v->moment);
        bough_vec3 linear = bough_axpy(v->mass, m.velocity, bough_cross(m.angular, arm));
        const double *j = v->inertia;
        bough_vec3 spin = {j[0] * w.x + j[3] * w.y + j[4] * w.z, j[3] * w.x + j[1] * w.y + j[5] * w.z,
                           j[4] * w.x + j[5] * w.y + j[2] * w.z};
        bough_vec3 own = bough_add(bough_mat3_mul(m.rotation, spin), bough_cross(arm, m.velocity));
        bough_vec3 lever = bough_axpy(v->mass, x, arm);
        *momentum += bough_dot(shaft, bough_add(bough_cross(x, linear), own));
        *weight += bough_dot(shaft, bough_cross(lever, gravity));
    }
}

static void record(bough_simulation *s, history *h) {
    int k = h->n++;
    double factor;
    assert_true(k < MOST_ROWS);
    bough_simulation_update(s);
    const bough_rotor_data *aero = bough_aero_link_data(s->aero, &factor);
    int rotor = s->scene->turbine.rotor;
    bough_transform pose = bough_tree_frame_pose(s->view, &s->tree->bodies[rotor]);
    h->time[k] = s->master->time;
    h->angle[k] = s->leader.state[0];
    h->speed[k] = s->leader.state[1];
    h->thrust[k] = factor * aero->thrust;
    h->torque[k] = factor * aero->torque;
    h->load[k] = load_torque * fmin(s->master->time / 20, 1);
    h->momentum[k] = s->scene->body[rotor].inertia[0] * h->speed[k];
    h->weight[k] = 0;
    for (int b = 0; b < s->n_beam; b++) {
        const bough_beam *beam = &s->beam[b];
        int n = beam->def.n_segment;
        add_blade(s, beam, pose.position, pose.rotation.c1, &h->momentum[k], &h->weight[k]);
        if (beam->rod == NULL) continue;
        const double *y = s->rod[beam->port].state;
        h->tip[k][b] = bough_v3(y[n - 1], y[2 * n - 1], y[3 * n - 1]);
    }
    double pitch = s->beam[0].body->pitch;
    h->out_of_plane[k] = h->tip[k][0].x * cos(pitch) + h->tip[k][0].y * sin(pitch);
}

static history *run(const char *const *sets) {
    check_arena(arena);
    history *h = calloc(1, sizeof *h);
    bough_simulation *s = scene_build(arena, "apps/turbine/runup.yaml", sets);
    record(s, h);
    while (!bough_master_done(s->master)) {
        scene_step(s);
        record(s, h);
    }
    return h;
}

static history *default_run;

static int run_default(void **context) {
    (void)context;
    const char *sets[] = {"simulation.threads=1", NULL};
    default_run = run(sets);
    return 0;
}

static int release_default(void **context) {
    (void)context;
    free(default_run);
    return 0;
}

// First row of the last `turns` whole revolutions.
static int last_turns(const history *h, int turns) {
    int k = h->n - 1;
    double end = h->angle[k];
    while (k > 0 && h->angle[k] > end - 2 * BOUGH_PI * turns) k--;
    return k;
}

static double mean_from(const history *h, const double *value, double t) {
    double sum = 0;
    int n = 0;
    for (int k = 0; k < h->n; k++) {
        if (h->time[k] < t) continue;
        sum += value[k];
        n++;
    }
    return sum / n;
}

// Aerodynamic torque and the weight's moment less the load torque change the angular momentum.
TEST(torque_balances_angular_momentum) {
    const history *h = default_run;
    for (int turns = 1; turns <= 2; turns++) {
        int first = last_turns(h, turns), last = h->n - 1;
        double impulse = 0;
        for (int k = first; k < last; k++) {
            double here = h->torque[k] + h->weight[k] - h->load[k];
            double next = h->torque[k + 1] + h->weight[k + 1] - h->load[k + 1];
            impulse += 0.5 * (here + next) * (h->time[k + 1] - h->time[k]);
        }
        double span = h->time[last] - h->time[first];
        double change = h->momentum[last] - h->momentum[first];
        check_near(impulse / span, change / span, 0, 0.005 * load_torque);
        assert_true(fabs(change) > 0); // the balance is not one of zeros
    }
}

TEST(tips_bend_beyond_a_tenth_of_the_blade) {
    const history *h = default_run;
    for (int k = last_turns(h, 2); k < h->n; k++) assert_true(h->out_of_plane[k] > 0.1 * 61.5);
}

// The value less its mean over the revolution about row k: the slow settling of the run removed.
static double periodic_part(const history *h, const double *value, int k) {
    double sum = 0, turn = 0;
    for (int i = 0; i < h->n - 1; i++) {
        if (fabs(h->angle[i] - h->angle[k]) > BOUGH_PI) continue;
        sum += value[i] * (h->angle[i + 1] - h->angle[i]);
        turn += h->angle[i + 1] - h->angle[i];
    }
    return value[k] - sum / turn;
}

// Amplitude of the `order`-th harmonic of the rotor angle, over two of the last three revolutions.
static double harmonic(const history *h, const double *value, int order) {
    int first = last_turns(h, 3);
    double c = 0, s = 0, turn = 0;
    for (int k = first; k < h->n - 1; k++) {
        double from_start = h->angle[k] - h->angle[first] - BOUGH_PI;
        if (from_start < 0 || from_start >= 4 * BOUGH_PI) continue;
        double step = h->angle[k + 1] - h->angle[k], flat = periodic_part(h, value, k);
        c += flat * cos(order * h->angle[k]) * step;
        s += flat * sin(order * h->angle[k]) * step;
        turn += step;
    }
    return 2 * sqrt(c * c + s * s) / turn;
}

static int strongest_harmonic(const history *h, const double *value) {
    int best = 1;
    for (int order = 2; order <= 12; order++) {
        if (harmonic(h, value, order) > harmonic(h, value, best)) best = order;
    }
    return best;
}

TEST(tip_moves_once_and_speed_three_times_per_revolution) {
    assert_int_equal(strongest_harmonic(default_run, default_run->out_of_plane), 1);
    assert_int_equal(strongest_harmonic(default_run, default_run->speed), 3);
}

// OpenFAST 5.0.0 with BeamDyn of order 8, means over 30 to 40 s.
TEST(means_are_those_of_the_reference) {
    const history *h = default_run;
    check_near(mean_from(h, h->speed, 30) * 30 / BOUGH_PI, 14.250, 0.005, 0);
    check_near(mean_from(h, h->out_of_plane, 30), 6.760, 0.005, 0);
    check_near(mean_from(h, h->thrust, 30), 1085e3, 0.005, 0);
    check_near(mean_from(h, h->torque, 30), 11676e3, 0.005, 0);
}

// The default against all equations in one implicit system at tight tolerance.
TEST(default_scheme_is_near_the_monolithic_solution) {
    const char *sets[] = {"simulation.threads=1", "simulation.coupling.scheme=monolithic",
                          "simulation.master={solver: ida, rtol: 1e-7}", NULL};
    history *reference = run(sets);
    double speed = 0, tip = 0;
    assert_int_equal(reference->n, default_run->n);
    for (int k = 0; k < reference->n; k++) {
        speed = fmax(speed, fabs(reference->speed[k] - default_run->speed[k]));
        for (int b = 0; b < BLADES; b++) {
            tip = fmax(tip, bough_norm(bough_sub(reference->tip[k][b], default_run->tip[k][b])));
        }
    }
    printf("largest difference from monolithic: tip %.2e m, rotor speed %.2e rad/s\n", tip, speed);
    assert_true(tip < 1e-2);
    assert_true(speed < 1e-3);
    free(reference);
}

GROUP(run_default, release_default)
