// Turbulence that runs share: one box for each wind, the same as a run's own.
#include "apps/bough/cases/case_run.h"

#include "aero/wind/wind_iec.h"
#include "apps/bough/model/aero_link.h"
#include "tests/unit/built_scene.h"

static const char operation[] = "apps/turbine/land-operation.yaml";

static const bough_scene *turbulent(bough_arena *arena, const char *change) {
    const char *const sets[] = {"aero.wind.points=3", "aero.wind.period=20 s", change, NULL};
    return scene_read(arena, operation, sets);
}

TEST(equal_winds_share_a_box) {
    static const char *const other[] = {"aero.wind.seed=2", "aero.wind.speed=13 m/s",
                                        "aero.wind.condition=etm"};
    bough_arena *arena = bough_arena_create();
    bough_boxes *boxes = bough_boxes_create(arena, 3);
    const bough_wind_box *first = bough_boxes_lend(boxes, turbulent(arena, NULL));
    assert_non_null(first);
    assert_ptr_equal(bough_boxes_lend(boxes, turbulent(arena, "aero.wind.direction=8 deg")), first);
    bough_boxes_give_back(boxes, first);
    for (int k = 0; k < 3; k++) { // two places for three winds
        const bough_wind_box *box = bough_boxes_lend(boxes, turbulent(arena, other[k]));
        assert_non_null(box);
        assert_ptr_not_equal(box, first);
        bough_boxes_give_back(boxes, box);
    }
    assert_ptr_equal(bough_boxes_lend(boxes, turbulent(arena, NULL)), first); // in use all the time
    bough_arena_destroy(arena);
}

TEST(a_lent_box_is_the_scenes_own) {
    bough_arena *arena = bough_arena_create();
    bough_boxes *boxes = bough_boxes_create(arena, 1);
    bough_wind_iec_def def;
    bough_wind_box own;
    for (int k = 0; k < 2; k++) { // the second in the place of the first
        const bough_scene *scene = turbulent(arena, k == 0 ? NULL : "aero.wind.seed=2");
        const bough_wind_box *box = bough_boxes_lend(boxes, scene);
        assert_true(bough_aero_link_turbulence(scene, &def));
        check_ok(bough_turbulence_make(arena, &def, &own));
        assert_int_equal(box->n_time, own.n_time);
        assert_memory_equal(box->value, own.value, 27 * (size_t)own.n_time * sizeof *own.value);
        bough_boxes_give_back(boxes, box);
    }
    bough_arena_destroy(arena);
}

TEST(a_wind_without_turbulence_has_no_box) {
    static const char *const gust[] = {"aero.wind.condition=eog", NULL};
    bough_arena *arena = bough_arena_create();
    bough_boxes *boxes = bough_boxes_create(arena, 1);
    assert_null(bough_boxes_lend(boxes, scene_read(arena, "apps/turbine/runup.yaml", no_sets)));
    assert_null(bough_boxes_lend(boxes, scene_read(arena, operation, gust)));
    bough_boxes_give_back(boxes, NULL);
    bough_arena_destroy(arena);
}
