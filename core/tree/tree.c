// Defaults of the tree's def; queries of poses and twists; loads and motions that change during a run.
#include "core/tree/tree.h"

bough_body_def bough_body_def_default(void) {
    bough_body_def def = {.name = "", .parent = BOUGH_GROUND, .axis = {0, 0, 1}, .second_axis = {1, 0, 0}};
    def.joint = bough_transform_identity();
    return def;
}

// theory (43): q(t) and v(t) of the given motions.
void bough_tree_prescribe(const bough_tree *tree, double t, double *state) {
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        if (link->motion == NULL) continue;
        bough_motion_point p = bough_motion_at(link->motion, t);
        state[link->first_coordinate] = p.q;
        state[tree->n_q + link->first_speed] = p.v;
    }
}

// A universal joint has two links, whose rows are neighbours.
bool bough_tree_joint_rows(const bough_tree *tree, int body, int *coordinate, int *speed) {
    int link = tree->bodies[body].link;
    if (link < 0 || tree->links[link].body != body) return false;
    link -= tree->links[link].part; // the links of a joint are neighbours
    *coordinate = tree->links[link].first_coordinate;
    *speed = tree->n_q + tree->links[link].first_speed;
    return true;
}

void bough_tree_set_wrench(bough_tree *tree, int marker, double start, const double *value,
                           const double *rate, const double *curve) {
    const double zero[6] = {0};
    bough_external *e = &tree->external[marker];
    e->active = value != NULL || rate != NULL;
    e->start = start;
    e->value = bough_wrench_load(value != NULL ? value : zero);
    e->rate = bough_wrench_load(rate != NULL ? rate : zero);
    e->curve = bough_wrench_load(curve != NULL ? curve : zero);
}

// The parabola of a sampled wrench.
bough_wrench bough_tree_wrench(const bough_tree *tree, int marker, double t) {
    const bough_external *e = &tree->external[marker];
    double dt = t - e->start;
    bough_vec3 force = bough_axpy(dt, e->curve.force, e->rate.force);
    bough_vec3 moment = bough_axpy(dt, e->curve.moment, e->rate.moment);
    if (!e->active) return (bough_wrench){0};
    return (bough_wrench){bough_axpy(dt, force, e->value.force), bough_axpy(dt, moment, e->value.moment)};
}

bough_transform bough_tree_frame_pose(const bough_tree_data *data, const bough_frame *frame) {
    if (frame->link < 0) return frame->placement;
    // on a link: the link's pose, then the placement
    return bough_transform_compose(data->pose[frame->link], frame->placement);
}

bough_twist bough_tree_frame_twist(const bough_tree_data *data, const bough_frame *frame) {
    if (frame->link < 0) return (bough_twist){{0, 0, 0}, {0, 0, 0}};
    return bough_twist_to_child(&frame->placement, data->twist[frame->link]);
}

bough_frame_motion bough_tree_frame_motion(const bough_tree_data *data, const bough_frame *frame) {
    return (bough_frame_motion){bough_tree_frame_pose(data, frame), bough_tree_frame_twist(data, frame)};
}

bough_twist bough_tree_frame_velocity(const bough_tree_data *data, const bough_frame *frame) {
    // from frame axes to ground axes
    bough_frame_motion m = bough_tree_frame_motion(data, frame);
    return (bough_twist){bough_mat3_mul(m.pose.rotation, m.twist.linear),
                         bough_mat3_mul(m.pose.rotation, m.twist.angular)};
}

void bough_tree_steer(bough_tree *tree, int body, double t, double span, bough_motion_point from,
                      bough_motion_point to) {
    bough_motion_steer(tree->links[tree->bodies[body].link].motion, t, span, from, to);
}

void bough_tree_steer_load(bough_tree *tree, int load, double t, double span, double from, double to) {
    // a line between two rows
    double *times = tree->steered + 4 * (size_t)load, *values = times + 2;
    times[0] = t;
    times[1] = t + span;
    values[0] = from;
    values[1] = to;
    tree->loads[load].value = 1;
    tree->loads[load].schedule = (bough_schedule){.n = 2, .times = times, .values = values};
}
