#include "apps/bough/analysis/steady.h"

int bough_steady_rods(const bough_simulation *s) {
    int n = 0;
    for (int k = 0; k < s->n_beam; k++) n += s->beam[k].rod != NULL;
    return n;
}

// The named body, or the nearest on a revolute joint below the rod; NULL when there is none.
static const bough_scene_body *pivot_of(const bough_scene *scene, const bough_beam *beam) {
    const bough_scene_body *body = beam->body;
    if (scene->modes.about_name != NULL) {
        bool good = bough_scene_carries(scene, scene->modes.about, (int)(body - scene->body));
        return good ? &scene->body[scene->modes.about] : NULL;
    }
    while (body->joint.kind != BOUGH_JOINT_REVOLUTE) {
        if (body->joint.parent == BOUGH_GROUND) return NULL;
        body = &scene->body[body->joint.parent];
    }
    return body;
}

bough_status bough_steady_turning(const bough_simulation *s, const bough_beam *beam, bough_turning *turning) {
    const bough_scene_modes *modes = &s->scene->modes;
    bough_vec3 axis = bough_v3_load(modes->axis);
    *turning = (bough_turning){.speed = modes->speed};
    if (modes->speed == 0) return bough_ok();
    if (bough_norm(axis) > 0) {
        turning->axis = bough_scale(1 / bough_norm(axis), axis);
        turning->centre = bough_v3_load(modes->centre);
        return bough_ok();
    }
    const bough_scene_body *pivot = pivot_of(s->scene, beam);
    if (pivot == NULL) {
        bough_status status = bough_fail(
            BOUGH_INVALID, "rod %s: no revolute joint%s%s carries it; name an 'axis' for this speed",
            beam->body->name, modes->about_name ? " of " : "", modes->about_name ? modes->about_name : "");
        return bough_scene_blame(bough_node_find(modes->node, "speed"), "modes.speed", status);
    }
    int body = (int)(pivot - s->scene->body);
    turning->axis = bough_simulation_joint_axis(s, body);
    turning->centre = bough_body_pose(s, body).position;
    return bough_ok();
}

// The forces of bodies on a rod are not known here.
static bough_status check_carries_none(const bough_simulation *s, const bough_beam *beam) {
    int carried = bough_scene_carried_by(s->scene, beam->index);
    if (carried < 0) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "rod %s carries the body %s, whose forces a single rod does not have: take "
                      "modes.of: scene",
                      beam->body->name, s->scene->body[carried].name);
}

// Twist and gravity of the body's frame.
static void set_input(const bough_simulation *s, const bough_turning *turning, bough_steady *x) {
    bough_transform pose = bough_beam_pose(s, x->beam);
    bough_vec3 gravity = s->tree->gravity;
    bough_vec3 omega = bough_scale(turning->speed, turning->axis);
    bough_vec3 arm = bough_sub(pose.position, turning->centre);
    if (turning->speed != 0) {
        gravity = bough_scale(bough_dot(gravity, turning->axis), turning->axis);
    }
    bough_v3_store(bough_mat3_tmul(pose.rotation, bough_cross(omega, arm)), x->input);
    bough_v3_store(bough_mat3_tmul(pose.rotation, omega), x->input + 3);
    bough_v3_store(bough_mat3_tmul(pose.rotation, gravity), x->input + 6);
}

bough_status bough_steady_find(bough_arena *arena, const bough_simulation *s, const bough_beam *beam,
                               const bough_turning *turning, bough_steady *steady) {
    BOUGH_TRY(check_carries_none(s, beam));
    steady->beam = beam;
    steady->model = bough_rod_body_model(beam->rod);
    steady->state = bough_arena_doubles(arena, (size_t)BOUGH_ROD_STATES * steady->model->n);
    bough_rod_static_init(&steady->work, arena, steady->model);
    set_input(s, turning, steady);
    bough_rod_rest_state(steady->model, steady->input, steady->state);
    return bough_rod_steady(steady->model, bough_rod_body_loads(beam->rod), steady->input, &steady->work,
                            steady->state);
}
