// Drag of tower and hub on the bodies of a simulation.
#include "tests/unit/built_scene.h"

#include "apps/bough/model/aero_link.h"

static const char turbine[] = "apps/turbine/land.yaml";

#define FEW "simulation.threads=1", "bodies[0].rod.segments=10", "bodies[4-6].rod.segments=12"
#define DRAG "aero.ramp=[0 s, 0 s]", "aero.tower.body=tower", "aero.tower.drag=[0.8]"

// ½ρ c V² ∫D dz of the scene's tower, at 20 m/s [N].
static double whole_tower(const bough_scene *scene) {
    const bough_scene_tower *t = &scene->aero.tower;
    double area = 0;
    for (int i = 1; i < t->def.n; i++)
        area += (t->def.diameter[i] + t->def.diameter[i - 1]) / 2 * (t->def.height[i] - t->def.height[i - 1]);
    return 0.5 * 1.225 * 0.8 * 400 * area;
}

static bough_simulation *sampled(bough_arena *arena, const char *const *sets, double t) {
    bough_simulation *s = scene_build(arena, turbine, sets);
    bough_sampled_load aero = s->sampled[0], drag = s->sampled[1];
    bool jumped;
    aero.sample(aero.self, t, t + 0.02, &jumped);
    check_ok(drag.sample(drag.self, t, t + 0.02, &jumped));
    assert_true(jumped);
    return s;
}

static bough_wrench on(const bough_simulation *s, int marker) { return s->tree->external[marker].value; }

// At rest: the sum over the vertices.
TEST(tower_drag_is_the_integral) {
    static const char *const flexible[] = {FEW, DRAG, NULL};
    check_arena(arena);
    bough_simulation *s = sampled(arena, flexible, 0);
    const bough_beam *tower = bough_simulation_beam(s, 0);
    const bough_rod_loads *loads = tower->loads;
    double sum = 0, across = 0;
    for (int i = 0; i <= 10; i++) {
        sum += loads->value[i];
        across += fabs(loads->value[tower->mesh->stride + i]);
    }
    check_near(sum, whole_tower(s->scene), 1e-3, 0);
    check_near(across, 0, 0, 1e-9);
    assert_true(sum > 1e4);
}

// On the rotor, in its axes.
TEST(hub_drag_blows_downwind) {
    static const char *const sets[] = {FEW, "aero.ramp=[0 s, 0 s]", "aero.hub_drag_area=7", NULL};
    check_arena(arena);
    bough_simulation *s = sampled(arena, sets, 0);
    int marker = s->tree->n_markers - 1;
    bough_wrench w = on(s, marker);
    check_near(bough_norm(w.force), 0.5 * 1.225 * 7 * 400, 1e-9, 0);
    bough_transform pose = bough_tree_frame_pose(s->view, &s->tree->markers[marker]);
    bough_vec3 ground = bough_mat3_mul(pose.rotation, w.force);
    check_near(ground.x, bough_norm(w.force), 1e-9, 0);
    check_near(bough_norm(w.moment), 0, 0, 0);
}

// The run goes on with drag, and samples repeat from the saved row.
TEST(drag_runs_and_repeats) {
    check_build_with(arena, s, turbine, FEW, DRAG, "aero.hub_drag_area=7");
    while (s->master->time < 0.5 - 1e-9) scene_step(s);
    bough_sampled_load load = s->sampled[1];
    bough_snapshot room = {BOUGH_SNAPSHOT_MEASURE, NULL, 0};
    load.snapshot(load.self, &room);
    size_t n = room.used;
    char *saved = calloc(1, n), *first = calloc(1, n), *again = calloc(1, n);
    bool jumped;
    load.snapshot(load.self, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, saved, 0});
    load.sample(load.self, 0.5, 0.52, &jumped);
    load.snapshot(load.self, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, first, 0});
    load.snapshot(load.self, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, saved, 0});
    load.sample(load.self, 0.5, 0.52, &jumped);
    load.snapshot(load.self, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, again, 0});
    assert_false(jumped);
    assert_memory_equal(first, again, n);
    assert_memory_not_equal(first, saved, n);
    free(saved);
    free(first);
    free(again);
}

// Held for an equilibrium the drag is constant, and the run's first sample begins anew.
TEST(held_drag_is_constant) {
    static const char *const sets[] = {FEW, DRAG, NULL};
    check_arena(arena);
    bough_simulation *s = sampled(arena, sets, 0);
    bough_rod_loads *loads = bough_simulation_beam(s, 0)->loads;
    double sum = 0;
    bough_drag_link_hold(s->drag, 0);
    for (int i = 0; i <= 10; i++) {
        sum += loads->value[i];
        check_near(loads->rate[i], 0, 0, 0);
    }
    check_near(sum, whole_tower(s->scene), 1e-3, 0);
    bough_sampled_load load = s->sampled[1];
    bool jumped;
    load.sample(load.self, 0, 0.02, &jumped);
    assert_true(jumped);
}

TEST(bad_bodies_are_refused) {
    scene_refused("apps/turbine/land.yaml", "aero.tower.body=nacelle", "must have a rod");
    scene_refused("apps/turbine/land.yaml", "aero.tower.body=blade1", "must have a rod");
    scene_refused("apps/turbine/land.yaml", "aero.tower.body=towr", "did you mean 'tower'");
}
