#include "apps/simulation/second_model.h"

#include "apps/simulation/build.h"

static bool loads_react(const bough_scene *scene) { return scene->aero.node || scene->control.node; }

static bool can_follow(const bough_simulation *s) { return !s->inputs && !s->master->assembly->opaque; }

static bool has_library(const bough_scene *scene) {
    return scene->control.node && scene->control.kind == BOUGH_SCENE_BLADED;
}

bough_status bough_second_model_build(bough_arena *arena, const bough_simulation *s,
                                      bough_simulation **second) {
    bough_second_solution_def def;
    *second = NULL;
    if (!loads_react(s->scene) || !can_follow(s) || !bough_master_wants_second(s->master, &def))
        return bough_ok();
    bough_scene *scene = bough_arena_take(arena, sizeof *scene);
    *scene = *s->scene;
    bough_scene_simulation *simulation = &scene->simulation;
    simulation->coupling.scheme = bough_scheme_index("monolithic");
    simulation->master.solver = (int)def.kind;
    simulation->master.rtol = def.rtol;
    simulation->master.step = def.step;
    simulation->error_estimate = BOUGH_ERROR_NOT_TOLD;
    simulation->threads = 1;
    scene->control.copied = true;
    bough_status status = bough_simulation_build(arena, scene, second);
    if (status.code != BOUGH_INVALID || !has_library(scene)) return status;
    *second = NULL; // a library that cannot be copied
    return bough_ok();
}
