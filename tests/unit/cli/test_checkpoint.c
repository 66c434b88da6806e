// A run that restores the copy it has just saved, and another that restores it, go on with the same
// bits.
#include "tests/unit/built_scene.h"

#include "cosim/scheme.h"

typedef struct copy {
    char *bytes;
    size_t size;
} copy;

static copy save(bough_simulation *s) {
    bough_snapshot measure = {.move = BOUGH_SNAPSHOT_MEASURE};
    bough_simulation_snapshot(s, &measure);
    copy c = {calloc(1, measure.used), measure.used};
    assert_non_null(c.bytes);
    bough_snapshot out = {BOUGH_SNAPSHOT_SAVE, c.bytes, 0};
    bough_simulation_snapshot(s, &out);
    assert_int_equal(out.used, c.size);
    return c;
}

static void restore(bough_simulation *s, copy c) {
    bough_snapshot in = {BOUGH_SNAPSHOT_RESTORE, c.bytes, 0};
    bough_simulation_snapshot(s, &in);
    assert_int_equal(in.used, c.size);
}

static void check_same(bough_simulation *a, bough_simulation *b) {
    copy x = save(a), y = save(b);
    assert_int_equal(x.size, y.size);
    assert_memory_equal(x.bytes, y.bytes, x.size);
    free(x.bytes);
    free(y.bytes);
}

// `until` steps, a copy, `more` steps of this run and of a new one that starts from it.
static void check_continued(const char *path, const char *const *sets, int until, int more) {
    check_arena(arena);
    bough_simulation *run = scene_build(arena, path, sets);
    bough_simulation *continued = scene_build(arena, path, sets);
    for (int k = 0; k < until; k++) scene_step(run);
    copy c = save(run);
    double start = run->master->time;
    assert_true(start > 0);
    restore(run, c);
    restore(continued, c);
    for (int k = 0; k < more; k++) {
        scene_step(run);
        scene_step(continued);
        check_same(run, continued);
    }
    assert_true(run->master->time > start);
    free(c.bytes);
}

static const char bar[] = "apps/beams/rubber-bar.yaml";
static const char runup[] = "apps/turbine/runup.yaml";

TEST(every_scheme_goes_on) {
    const char *name;
    for (int k = 0; (name = bough_scheme_name(k)) != NULL; k++) {
        char scheme[64];
        snprintf(scheme, sizeof scheme, "simulation.coupling.scheme=%s", name);
        const char *const sets[] = {scheme, "simulation.macro_step=0.5 ms", "bodies[0].rod.segments=6", NULL};
        check_continued(bar, sets, 45, 45); // over the ends of batches of 32 steps
    }
}

TEST(every_solver_goes_on) {
    static const char *const solver[] = {
        "simulation.micro.solver=cvode-bdf",     "simulation.micro.solver=generalized-alpha",
        "simulation.micro.solver=arkode-esdirk", "simulation.micro.solver=rosenbrock",
        "simulation.master={solver: radau5}",
    };
    for (size_t k = 0; k < sizeof solver / sizeof *solver; k++) {
        const char *const sets[] = {solver[k], "simulation.micro.step=0.5 ms", "bodies[0].rod.segments=6",
                                    NULL};
        check_continued(bar, sets, 20, 20);
    }
}

TEST(controlled_steps_go_on) {
    static const char *const sets[] = {"simulation.step_control={tolerance: 1e-3}",
                                       "bodies[0].rod.segments=6", NULL};
    check_continued(bar, sets, 64, 40);
}

// Air with a memory, followers whose tangents age, three rods.
TEST(the_turbine_goes_on) {
    static const char *const few = "bodies[3-5].rod.segments=8";
    const char *const plain[] = {few, NULL};
    check_continued(runup, plain, 14, 24);
    const char *const memory[] = {few, "aero.dynamic_stall=hgm", "aero.induction.inflow=oye", NULL};
    check_continued(runup, memory, 14, 24);
}

TEST(the_controlled_turbine_goes_on) {
    static const char *const sets[] = {"bodies[3-5].rod.segments=8", NULL};
    check_continued("apps/turbine/power.yaml", sets, 14, 24);
}

TEST(modal_bodies_go_on) {
    static const char *const sets[] = {"bodies[3-5].fidelity=modal", NULL};
    check_continued(runup, sets, 14, 24);
}
