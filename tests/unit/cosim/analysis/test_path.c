// Paths of equilibria past limit points: two slides whose path is known, and a frame with a published limit
// load.
#include "apps/bough/model/equilibrium.h"
#include "tests/unit/built_scene.h"

enum { MOST = 400 };

typedef struct trace {
    bough_simulation *simulation;
    int n, n_limit;
    double share[MOST], q[MOST][2]; // of the first two coordinates
    double limit[8];
} trace;

static bough_status note(void *self, double time, double share, bool limit) {
    (void)time;
    trace *t = self;
    const double *q = t->simulation->leader.state;
    assert_true(t->n < MOST && t->n_limit < 8);
    if (limit) t->limit[t->n_limit++] = share;
    t->share[t->n] = share;
    memcpy(t->q[t->n++], q, sizeof t->q[0]);
    return bough_ok();
}

static bough_status walk(bough_simulation *s, trace *t, bough_path_report *report) {
    *t = (trace){.simulation = s};
    return bough_simulation_path(s, (bough_path_listener){t, note}, report);
}

// What presses the slide down by u: its bar from (1, −0.3) is 1000 N/m.
static double bar_force(double u) {
    const double rise = 0.3, length = sqrt(1 + rise * rise);
    double h = rise - u;
    return 1000 * (length / sqrt(1 + h * h) - 1) * h;
}

// Its most: (1 + h²)^(3/2) = the length.
static double bar_limit(void) {
    double h = sqrt(cbrt(1.09) - 1);
    return bar_force(0.3 - h);
}

// Each point is on the exact curve; the limit points are the curve's; the driver turns back on its way.
TEST(slides_snap_through_and_back) {
    check_build(arena, s, "tests/data/scenes/snapping-slide.yaml", no_sets);
    trace *t = bough_arena_take(arena, sizeof *t);
    bough_path_report report;
    check_ok(walk(s, t, &report));
    bool back = false;
    for (int i = 0; i < t->n; i++) {
        double load = 10 * t->share[i], u = -t->q[i][0], driver = -t->q[i][1];
        check_near(bar_force(u), load, 0, 1e-5);
        check_near(20 * (driver - u), load, 0, 1e-5);
        back = back || (i > 0 && t->q[i][1] > t->q[i - 1][1]);
    }
    assert_true(back);
    assert_int_equal(t->n_limit, 2);
    check_near(10 * t->limit[0], bar_limit(), 1e-6, 0);
    check_near(10 * t->limit[1], -bar_limit(), 1e-6, 0);
    check_near(t->share[t->n - 1], 1, 0, 1e-12);
    assert_true(t->q[t->n - 1][0] < -0.6);
}

typedef struct reaction {
    bough_simulation *simulation;
    bough_channels channels;
    int n;
} reaction;

static bough_status check_reaction(void *self, double time, double share, bool limit) {
    reaction *r = self;
    (void)limit;
    double value[64];
    int index = bough_channels_find(&r->channels, "propFz");
    assert_true(index >= 0 && r->channels.count <= 64);
    bough_channels_sample(&r->channels, time, value);
    check_near(value[index], -50 * share, 1e-5, 1e-8);
    r->n++;
    return bough_ok();
}

// A beam between two walls, pressed along by 300 N on each of its first metre of three: the far wall carries
// 300 1²/(2 3) of it, at every point of the path.
TEST(closures_carry_the_load_of_the_point) {
    const char *sets[] = {"loads=[{body: beam, along: [0 m, 1 m], force: [300, 0, 0], ramp: [0 s, 1 s]}]",
                          "gravity=[0, 0, 0]", NULL};
    check_arena(arena);
    reaction r = {scene_build(arena, "tests/data/scenes/prop.yaml", sets), bough_channels_start(arena), 0};
    check_ok(bough_simulation_channels(r.simulation, &r.channels));
    bough_path_report report;
    bough_path_listener listener = {&r, check_reaction};
    check_ok(bough_simulation_path(r.simulation, listener, &report));
    assert_true(r.n > 3);
}

// A load below the limit has no limit point.
TEST(short_of_the_limit) {
    check_build_with(arena, s, "tests/data/scenes/snapping-slide.yaml", "loads[0].force=-4.9");
    trace *t = bough_arena_take(arena, sizeof *t);
    bough_path_report report;
    check_ok(walk(s, t, &report));
    assert_int_equal(report.limits, 0);
    check_near(bar_force(-t->q[t->n - 1][0]), 4.9, 0, 1e-5);
}

TEST(lee_frame) {
    check_build(arena, s, "apps/beams/lee-frame.yaml", no_sets);
    trace *t = bough_arena_take(arena, sizeof *t);
    bough_path_report report;
    check_ok(walk(s, t, &report));
    assert_int_equal(report.limits, 2);
    check_near(4 * t->limit[0], 1.8552, 5e-4, 0);
    assert_true(t->limit[1] < 0); // it snaps back: held, it is pulled up
    check_near(report.factor, 1, 0, 1e-12);
}

static void refuses(const char *scene, const char *set, const char *why) {
    check_build_with(arena, s, scene, set);
    trace *t = bough_arena_take(arena, sizeof *t);
    bough_path_report report;
    check_fails(walk(s, t, &report), BOUGH_INVALID, why);
}

TEST(other_scenes_are_refused) {
    refuses("apps/beams/elastica.yaml", NULL, "expected one with a ramp");
    refuses("apps/turbine/runup.yaml", NULL, "allows no air");
    refuses("apps/turbine/rotor.yaml", NULL, "body 'hub': a path of equilibria allows no prescribed motions");
}
