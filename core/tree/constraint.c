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

bough_relative_motion bough_relate(const bough_frame_motion *a, const bough_frame_motion *b) {
    bough_relative_motion r;
    bough_mat3 to_a = bough_mat3_transpose(a->pose.rotation);
    r.e = bough_mat3_product(to_a, b->pose.rotation);
    r.d = bough_mat3_mul(to_a, bough_sub(b->pose.position, a->pose.position));
    r.w_first = a->twist.angular;
    r.v_second = bough_mat3_mul(r.e, b->twist.linear);
    r.w_second = bough_mat3_mul(r.e, b->twist.angular);
    r.omega = bough_sub(r.w_second, r.w_first);
    r.d_rate = bough_sub(bough_sub(r.v_second, a->twist.linear), bough_cross(r.w_first, r.d));
    return r;
}

// (e·d)˙ = e·ḋ
static bough_constraint_row translation(const bough_relative_motion *r, bough_vec3 bias, bough_vec3 along) {
    static const bough_vec3 none;
    return (bough_constraint_row){
        .value = bough_dot(along, r->d),
        .rate = bough_dot(along, r->d_rate),
        .bias = bough_dot(along, bias),
        .wrench = {{bough_scale(-1, along), bough_cross(along, r->d)}, {bough_mat3_tmul(r->e, along), none}},
    };
}

// (a·E b)˙ = c·ω with c = E b × a
static bough_constraint_row rotation(const bough_relative_motion *r, bough_vec3 a, bough_vec3 b) {
    static const bough_vec3 none;
    bough_vec3 seen = bough_mat3_mul(r->e, b), c = bough_cross(seen, a);
    bough_vec3 c_rate = bough_cross(bough_cross(r->omega, seen), a);
    bough_vec3 turned = bough_cross(r->omega, r->w_second); // Ė Ω_b
    return (bough_constraint_row){
        .value = bough_dot(a, seen),
        .rate = bough_dot(c, r->omega),
        .bias = bough_dot(c_rate, r->omega) + bough_dot(c, turned),
        .wrench = {{none, bough_scale(-1, c)}, {none, bough_mat3_tmul(r->e, c)}},
    };
}

void bough_constraint_rows(const bough_constraint *c, const bough_frame_motion *a,
                           const bough_frame_motion *b, bough_constraint_row *row) {
    bough_relative_motion r = bough_relate(a, b);
    // d̈ without v̇ and Ω̇
    bough_vec3 bias = bough_sub(bough_cross(r.omega, r.v_second), bough_cross(r.w_first, r.d_rate));
    for (int i = 0; i < c->n_translation; i++) row[i] = translation(&r, bias, c->along[i]);
    for (int i = 0; i < c->n_rotation; i++)
        row[c->n_translation + i] = rotation(&r, c->first[i], c->second[i]);
}
