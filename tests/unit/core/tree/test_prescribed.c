// Prescribed joints are where their motion says at the end of every step, under every scheme and every
// integrator, and what hangs on them feels that motion: by tables, by ramps and steered step by step.
#include "tests/unit/built_scene.h"

static const char *const scene = "tests/data/scenes/pitching.yaml";

enum { MOST = 512, HUB = 0, STEERED = 1, RAMPED = 2 };

typedef struct end {
    int n; // states of all members
    double state[MOST];
} end;

// As a controller does: each step a cubic from where the joint is to where it shall be at its end.
static void steer(bough_simulation *s, double t, double h) {
    double q = 0.3 * (1 - cos(2 * t)), next = 0.3 * (1 - cos(2 * (t + h)));
    bough_motion_point from = {q, 0.6 * sin(2 * t), 0}, to = {next, 0.6 * sin(2 * (t + h)), 0};
    bough_tree_steer(s->tree, STEERED, t, h, from, to);
}

static void check_given(const bough_simulation *s, int body, double angle, double speed) {
    int q, v;
    assert_true(bough_tree_joint_rows(s->tree, body, &q, &v));
    check_near(s->leader.state[q], angle, 0, 1e-13);
    check_near(s->leader.state[v], speed, 0, 1e-13);
}

static void run(const char *scheme, const char *solver, const char *rtol, bool steered, end *at) {
    char sets[3][80];
    snprintf(sets[0], sizeof sets[0], "simulation.coupling.scheme=%s", scheme);
    snprintf(sets[1], sizeof sets[1], "simulation.master.solver=%s", solver);
    snprintf(sets[2], sizeof sets[2], "simulation.master.rtol=%s", rtol);
    check_build_with(arena, s, scene, sets[0], sets[1], sets[2]);
    const bough_motion *ramped = s->tree->links[RAMPED].motion;
    const bough_motion *table = s->tree->links[STEERED].motion;
    for (long k = 1; !bough_master_done(s->master); k++) {
        double t = s->master->time;
        if (steered) steer(s, t, 0.005);
        scene_step(s);
        t = s->master->time;
        bough_motion_point p = bough_motion_at(ramped, t), given = bough_motion_at(table, t);
        check_given(s, RAMPED, p.q, p.v);
        check_given(s, STEERED, given.q, given.v);
        if (steered) check_given(s, STEERED, 0.3 * (1 - cos(2 * t)), 0.6 * sin(2 * t));
    }
    const bough_assembly *a = s->master->assembly;
    at->n = a->n_state;
    assert_true(at->n <= MOST);
    for (int i = 0; i < a->n_member; i++) {
        memcpy(at->state + a->state_offset[i], a->member[i]->state,
               (size_t)a->member[i]->system.n_state * sizeof(double));
    }
}

static double distance(const end *a, const end *b) {
    double largest = 0;
    for (int i = 0; i < a->n; i++) largest = fmax(largest, fabs(a->state[i] - b->state[i]));
    return largest;
}

static const char *const solvers[] = {"ida",    "cvode-bdf",         "arkode-esdirk",
                                      "radau5", "generalized-alpha", "rosenbrock"};
enum { SOLVERS = sizeof solvers / sizeof *solvers };

// Speeds are of up to 20 m/s; a spline's acceleration jumps at the ends of the table.
static void check_schemes(bool steered) {
    static const char *const schemes[] = {"ramp", "extrapolated", "iterated", "gauss-seidel", "frozen"};
    static const double bound[] = {1e-4, 5e-4, 1e-3, 5e-3, 5e-3};
    end exact, found;
    run("monolithic", "rosenbrock", "1e-9", steered, &exact);
    for (int i = 0; i < 5; i++) {
        for (int k = 0; k < SOLVERS; k++) {
            run(schemes[i], solvers[k], "1e-6", steered, &found);
            double error = distance(&found, &exact);
            assert_true(error < (steered ? 1 : 200) * bound[i]);
        }
    }
}

TEST(tables_and_ramps_under_every_scheme) { check_schemes(false); }

TEST(steered_under_every_scheme) { check_schemes(true); }

// All integrators come to one motion, whatever their tangents make of the given states.
TEST(monolithic_with_every_integrator) {
    for (int steered = 0; steered < 2; steered++) {
        end exact, found;
        run("monolithic", "rosenbrock", "1e-9", steered, &exact);
        for (int k = 0; k < SOLVERS; k++) {
            run("monolithic", solvers[k], "1e-7", steered, &found);
            double error = distance(&found, &exact);
            // generalised-α has no error control: order 2 in the macro step
            assert_true(error < (strcmp(solvers[k], "generalized-alpha") == 0 ? 0.1 : 2e-4));
        }
    }
}
