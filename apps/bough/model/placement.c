#include "apps/bough/model/placement.h"

#include "core/base/rotation.h"

bough_vec3 bough_placement_axis(int axis) {
    return bough_v3(axis == BOUGH_SCENE_X, axis == BOUGH_SCENE_Y, axis == BOUGH_SCENE_Z);
}

bough_mat3 bough_placement_turn(int axis, double angle) {
    bough_vec3 turn = bough_scale(angle, bough_placement_axis(axis));
    return bough_rotation_matrix(bough_quaternion_exponential(turn));
}

bough_transform bough_placement(int n, const bough_scene_step *step) {
    bough_transform x = bough_transform_identity();
    for (int k = 0; k < n; k++) {
        bough_transform move = bough_transform_identity();
        if (step[k].rotate) {
            move.rotation = bough_placement_turn(step[k].axis, step[k].amount);
        } else {
            move.position = bough_scale(step[k].amount, bough_placement_axis(step[k].axis));
        }
        x = bough_transform_compose(x, move);
    }
    return x;
}
