// Springs and bushings between markers, applied wrenches, and their variations; theory (42).
#include "core/tree/force.h"

#include "core/base/rotation.h"

typedef bough_vec3 v3;

static v3 scaled(const double k[3], v3 x) { return bough_v3(k[0] * x.x, k[1] * x.y, k[2] * x.z); }

// -- spring: T = k (l − l₀) + c n·ẋ along n ------------------------------------------------------

typedef struct stretch {
    bough_frame_motion end[2]; // the markers
    v3 n, rate;                // unit vector from the first to the second, its ends' relative velocity
    double length, tension;
} stretch;

// A vector of an end's axes in the ground's.
static v3 in_ground(const stretch *x, int end, v3 own) {
    return bough_mat3_mul(x->end[end].pose.rotation, own);
}

// Length, direction, their rate and the tension of a spring.
static stretch stretch_of(const bough_tree *tree, const bough_tree_data *d, int spring) {
    const bough_spring_def *s = &tree->springs[spring];
    stretch x;
    v3 velocity[2];
    for (int end = 0; end < 2; end++) {
        x.end[end] = bough_tree_frame_motion(d, &tree->markers[s->marker[end]]);
        velocity[end] = in_ground(&x, end, x.end[end].twist.linear);
    }
    v3 way = bough_sub(x.end[1].pose.position, x.end[0].pose.position);
    x.length = bough_norm(way);
    x.n = x.length > 0 ? bough_scale(1 / x.length, way) : way;
    x.rate = bough_sub(velocity[1], velocity[0]);
    x.tension = s->stiffness * (x.length - s->length) + s->damping * bough_dot(x.n, x.rate);
    return x;
}

double bough_tree_spring(const bough_tree *tree, const bough_tree_data *data, int spring, double *tension,
                         bough_vec3 *direction) {
    stretch x = stretch_of(tree, data, spring);
    *tension = x.tension;
    *direction = x.n;
    return x.length;
}

// The force on an end in its own axes: f on the first, −f on the second.
static bough_wrench pull(const stretch *x, int end, v3 f) {
    v3 own = bough_mat3_tmul(x->end[end].pose.rotation, f);
    return (bough_wrench){end == 0 ? own : bough_scale(-1, own), {0, 0, 0}};
}

static bough_force_pair spring_force(const bough_tree *tree, const bough_tree_data *d, int spring,
                                     double *energy) {
    const bough_spring_def *s = &tree->springs[spring];
    stretch x = stretch_of(tree, d, spring);
    v3 f = bough_scale(x.tension, x.n);
    *energy = 0.5 * s->stiffness * (x.length - s->length) * (x.length - s->length);
    return (bough_force_pair){{pull(&x, 0, f), pull(&x, 1, f)}};
}

// δT n + T δn, resolved in the axes of each end.
static bough_force_pair spring_change(const bough_tree *tree, const bough_tree_data *d, int spring,
                                      const bough_twist shift[2], const bough_twist rate[2]) {
    const bough_spring_def *s = &tree->springs[spring];
    stretch x = stretch_of(tree, d, spring);
    v3 moved[2], sped[2]; // of each end, in the ground
    for (int end = 0; end < 2; end++) {
        moved[end] = in_ground(&x, end, shift[end].linear);
        v3 turned = bough_cross(shift[end].angular, x.end[end].twist.linear);
        sped[end] = in_ground(&x, end, bough_add(rate[end].linear, turned));
    }
    // variations of length, direction, and tension
    v3 dx = bough_sub(moved[1], moved[0]), dv = bough_sub(sped[1], sped[0]);
    double dl = bough_dot(x.n, dx), inverse = x.length > 0 ? 1 / x.length : 0;
    v3 dn = bough_scale(inverse, bough_axpy(-dl, x.n, dx));
    double dt = s->stiffness * dl + s->damping * (bough_dot(dn, x.rate) + bough_dot(x.n, dv));
    v3 f = bough_scale(x.tension, x.n);
    v3 df = bough_add(bough_scale(dt, x.n), bough_scale(x.tension, dn));
    bough_force_pair change;
    for (int end = 0; end < 2; end++) { // δ(Rᵀf) = Rᵀδf + Rᵀf × δ
        bough_wrench own = pull(&x, end, f);
        change.on[end] = pull(&x, end, df);
        change.on[end].force = bough_add(change.on[end].force, bough_cross(own.force, shift[end].angular));
    }
    return change;
}

// -- bushing, all in the axes of the first marker ------------------------------------------------

static bough_relative_motion relative_of(const bough_tree *tree, const bough_tree_data *d,
                                         const bough_bushing_def *b) {
    bough_frame_motion first = bough_tree_frame_motion(d, &tree->markers[b->marker[0]]);
    bough_frame_motion second = bough_tree_frame_motion(d, &tree->markers[b->marker[1]]);
    return bough_relate(&first, &second);
}

// Rotation vector of the second marker.
static v3 rotation_of(const bough_relative_motion *x) {
    return bough_quaternion_logarithm(bough_quaternion_of_matrix(x->e));
}

// theory (42), the gradient of ½ θᵀKθ: κ + ½ θ×κ + β θ×(θ×κ), κ = Kθ.
static v3 elastic_moment(v3 theta, v3 kappa, double beta) {
    v3 once = bough_cross(theta, kappa);
    return bough_add(kappa, bough_axpy(0.5, once, bough_scale(beta, bough_cross(theta, once))));
}

// Force and moment on the second marker.
static bough_wrench on_second(const bough_bushing_def *b, const bough_relative_motion *x, v3 theta) {
    double beta, slope;
    bough_log_factors(bough_norm(theta), &beta, &slope);
    v3 force = bough_add(scaled(b->stiffness, x->d), scaled(b->damping, x->d_rate));
    v3 moment = elastic_moment(theta, scaled(b->stiffness + 3, theta), beta);
    moment = bough_add(moment, scaled(b->damping + 3, x->omega));
    return (bough_wrench){bough_scale(-1, force), bough_scale(-1, moment)};
}

static bough_force_pair bushing_force(const bough_tree *tree, const bough_tree_data *d,
                                      const bough_bushing_def *b, double *energy) {
    bough_relative_motion x = relative_of(tree, d, b);
    v3 theta = rotation_of(&x);
    bough_wrench w = on_second(b, &x, theta);
    *energy =
        0.5 * (bough_dot(x.d, scaled(b->stiffness, x.d)) + bough_dot(theta, scaled(b->stiffness + 3, theta)));
    v3 moment = bough_add(w.moment, bough_cross(x.d, w.force));
    return (bough_force_pair){{{bough_scale(-1, w.force), bough_scale(-1, moment)},
                               {bough_mat3_tmul(x.e, w.force), bough_mat3_tmul(x.e, w.moment)}}};
}

// δ of the elastic moment along δθ
static v3 moment_change(const bough_bushing_def *b, v3 theta, v3 change) {
    double beta, slope;
    bough_log_factors(bough_norm(theta), &beta, &slope);
    v3 kappa = scaled(b->stiffness + 3, theta), once = bough_cross(theta, kappa);
    v3 sum = elastic_moment(theta, scaled(b->stiffness + 3, change), beta);
    v3 turned = bough_cross(change, kappa);
    sum = bough_add(sum, bough_scale(0.5, turned));
    sum = bough_axpy(beta, bough_add(bough_cross(change, once), bough_cross(theta, turned)), sum);
    return bough_axpy(slope * bough_dot(theta, change), bough_cross(theta, once), sum);
}

static bough_force_pair bushing_change(const bough_tree *tree, const bough_tree_data *d,
                                       const bough_bushing_def *b, const bough_twist shift[2],
                                       const bough_twist rate[2]) {
    bough_relative_motion x = relative_of(tree, d, b);
    v3 theta = rotation_of(&x);
    bough_wrench w = on_second(b, &x, theta);
    double beta, slope;
    bough_log_factors(bough_norm(theta), &beta, &slope);
    // variations of the relative rotation, position, angular velocity and velocity, in axes of the first
    // marker
    v3 eta = bough_sub(bough_mat3_mul(x.e, shift[1].angular), shift[0].angular);
    v3 once = bough_cross(theta, eta);
    v3 dtheta = bough_axpy(-0.5, once, bough_axpy(beta, bough_cross(theta, once), eta));
    // relative displacement and its rate
    v3 dd = bough_sub(bough_mat3_mul(x.e, shift[1].linear),
                      bough_add(shift[0].linear, bough_cross(shift[0].angular, x.d)));
    v3 domega = bough_add(bough_cross(eta, x.w_second),
                          bough_sub(bough_mat3_mul(x.e, rate[1].angular), rate[0].angular));
    v3 dv = bough_add(bough_cross(eta, x.v_second), bough_mat3_mul(x.e, rate[1].linear));
    dv = bough_sub(dv, bough_add(rate[0].linear, bough_cross(rate[0].angular, x.d)));
    dv = bough_sub(dv, bough_cross(x.w_first, dd));
    v3 df = bough_scale(-1, bough_add(scaled(b->stiffness, dd), scaled(b->damping, dv)));
    v3 dm = bough_scale(-1, bough_add(moment_change(b, theta, dtheta), scaled(b->damping + 3, domega)));
    // force and moment on both markers
    v3 arm = bough_add(bough_cross(dd, w.force), bough_cross(x.d, df));
    return (bough_force_pair){{{bough_scale(-1, df), bough_scale(-1, bough_add(dm, arm))},
                               {bough_mat3_tmul(x.e, bough_sub(df, bough_cross(eta, w.force))),
                                bough_mat3_tmul(x.e, bough_sub(dm, bough_cross(eta, w.moment)))}}};
}

// -- elements ------------------------------------------------------------------------------------

static const bough_bushing_def *bushing(const bough_tree *tree, int element) {
    return &tree->bushings[element - tree->n_springs];
}

const bough_frame *bough_element_frame(const bough_tree *tree, int element, int end) {
    bool spring = element < tree->n_springs;
    return &tree->markers[spring ? tree->springs[element].marker[end] : bushing(tree, element)->marker[end]];
}

bough_force_pair bough_element_force(const bough_tree *tree, const bough_tree_data *data, int element,
                                     double *energy) {
    if (element < tree->n_springs) return spring_force(tree, data, element, energy);
    return bushing_force(tree, data, bushing(tree, element), energy);
}

bough_force_pair bough_element_change(const bough_tree *tree, const bough_tree_data *data, int element,
                                      const bough_twist shift[2], const bough_twist rate[2]) {
    if (element < tree->n_springs) return spring_change(tree, data, element, shift, rate);
    return bushing_change(tree, data, bushing(tree, element), shift, rate);
}

// -- applied wrenches ----------------------------------------------------------------------------

bough_wrench bough_applied_force(const bough_tree *tree, const bough_tree_data *data, int k, double t) {
    const bough_applied_def *a = &tree->applied[k];
    bough_wrench w = bough_wrench_scale(bough_schedule_at(&a->schedule, t), a->wrench);
    // constant in the ground: resolved in the marker's axes
    if (!a->ground) return w;
    bough_mat3 r = bough_tree_frame_pose(data, &tree->markers[a->marker]).rotation;
    return (bough_wrench){bough_mat3_tmul(r, w.force), bough_mat3_tmul(r, w.moment)};
}

bough_wrench bough_applied_change(const bough_tree *tree, const bough_tree_data *data, int k, double t,
                                  bough_twist shift) {
    bough_wrench w = bough_applied_force(tree, data, k, t);
    if (!tree->applied[k].ground) return (bough_wrench){{0, 0, 0}, {0, 0, 0}};
    return (bough_wrench){bough_cross(w.force, shift.angular), bough_cross(w.moment, shift.angular)};
}
