// Equations between two frames, theory (44), and their derivatives. Of a vector fixed in b, seen from a,
//     (E b)˙ = ω × E b,   ω = E Ω_b − Ω_a,   ḋ = E v_b − v_a − Ω_a × d.
#include "core/tree/constraint.h"

static bough_vec3 unit(bough_vec3 x) { return bough_scale(1 / bough_norm(x), x); }

// A unit vector normal to a unit vector, by Gram and Schmidt from the axis that is closest to normal.
static bough_vec3 normal_to(bough_vec3 a) {
    double x = fabs(a.x), y = fabs(a.y), z = fabs(a.z);
    bough_vec3 e = bough_v3(x <= y && x <= z, y < x && y <= z, z < x && z < y);
    return unit(bough_axpy(-bough_dot(e, a), a, e));
}

static void add_translation(bough_constraint *c, bough_vec3 along) { c->along[c->n_translation++] = along; }

static void add_rotation(bough_constraint *c, bough_vec3 first, bough_vec3 second) {
    c->first[c->n_rotation] = first;
    c->second[c->n_rotation++] = second;
}

bough_constraint bough_constraint_make(bough_joint_kind kind, bough_vec3 axis, bough_vec3 second) {
    assert(kind != BOUGH_JOINT_FREE);
    bough_constraint c = {0};
    bough_vec3 a = bough_joint_n_axes(kind) > 0 ? unit(axis) : bough_v3(0, 0, 1);
    bough_vec3 p = normal_to(a), r = bough_cross(a, p);
    // translations across the axis, and along it unless the joint slides
    bool along = kind == BOUGH_JOINT_CYLINDRICAL || kind == BOUGH_JOINT_PRISMATIC;
    if (kind != BOUGH_JOINT_PLANAR) {
        add_translation(&c, p);
        add_translation(&c, r);
    }
    if (!along) add_translation(&c, a);
    // rotations of the axis, and about it unless the joint spins
    if (kind == BOUGH_JOINT_UNIVERSAL) add_rotation(&c, a, unit(second));
    if (kind == BOUGH_JOINT_UNIVERSAL || kind == BOUGH_JOINT_SPHERICAL) return c;
    add_rotation(&c, p, a);
    add_rotation(&c, r, a);
    if (kind == BOUGH_JOINT_FIXED || kind == BOUGH_JOINT_PRISMATIC) add_rotation(&c, p, r);
    return c;
}

// Relative motion, common to all rows, in axes of the first frame
typedef struct relative {
    bough_mat3 e;           // E
    bough_vec3 d, d_rate;   // [m], [m/s]
    bough_vec3 d_bias;      // d̈ without v̇ and Ω̇ [m/s²]
    bough_vec3 omega, spin; // ω, E Ω_b [rad/s]
    bough_vec3 first_omega; // Ω_a [rad/s]
} relative;

static relative relate(const bough_frame_motion *a, const bough_frame_motion *b) {
    relative r;
    bough_mat3 to_a = bough_mat3_transpose(a->pose.rotation);
    r.e = bough_mat3_product(to_a, b->pose.rotation);
    r.d = bough_mat3_mul(to_a, bough_sub(b->pose.position, a->pose.position));
    r.first_omega = a->twist.angular;
    r.spin = bough_mat3_mul(r.e, b->twist.angular);
    r.omega = bough_sub(r.spin, r.first_omega);
    bough_vec3 carried = bough_mat3_mul(r.e, b->twist.linear); // E v_b
    r.d_rate = bough_sub(bough_sub(carried, a->twist.linear), bough_cross(r.first_omega, r.d));
    r.d_bias = bough_sub(bough_cross(r.omega, carried), bough_cross(r.first_omega, r.d_rate));
    return r;
}

// (e·d)˙ = e·ḋ
static bough_constraint_row translation(const relative *r, bough_vec3 along) {
    static const bough_vec3 none;
    return (bough_constraint_row){
        .value = bough_dot(along, r->d),
        .rate = bough_dot(along, r->d_rate),
        .bias = bough_dot(along, r->d_bias),
        .wrench = {{bough_scale(-1, along), bough_cross(along, r->d)}, {bough_mat3_tmul(r->e, along), none}},
    };
}

// (a·E b)˙ = c·ω with c = E b × a
static bough_constraint_row rotation(const relative *r, bough_vec3 a, bough_vec3 b) {
    static const bough_vec3 none;
    bough_vec3 seen = bough_mat3_mul(r->e, b), c = bough_cross(seen, a);
    bough_vec3 c_rate = bough_cross(bough_cross(r->omega, seen), a);
    bough_vec3 turned = bough_cross(r->omega, r->spin); // Ė Ω_b
    return (bough_constraint_row){
        .value = bough_dot(a, seen),
        .rate = bough_dot(c, r->omega),
        .bias = bough_dot(c_rate, r->omega) + bough_dot(c, turned),
        .wrench = {{none, bough_scale(-1, c)}, {none, bough_mat3_tmul(r->e, c)}},
    };
}

void bough_constraint_rows(const bough_constraint *c, const bough_frame_motion *a,
                           const bough_frame_motion *b, bough_constraint_row *row) {
    relative r = relate(a, b);
    for (int i = 0; i < c->n_translation; i++) row[i] = translation(&r, c->along[i]);
    for (int i = 0; i < c->n_rotation; i++)
        row[c->n_translation + i] = rotation(&r, c->first[i], c->second[i]);
}
