// Joints: poses by hand, and N(q) against differences of the pose.
#include "tests/unit/check.h"

#include "core/base/rotation.h"
#include "core/tree/joint.h"

static const bough_joint_kind kinds[] = {BOUGH_JOINT_FIXED,     BOUGH_JOINT_REVOLUTE, BOUGH_JOINT_PRISMATIC,
                                         BOUGH_JOINT_SPHERICAL, BOUGH_JOINT_FREE,     BOUGH_JOINT_CYLINDRICAL,
                                         BOUGH_JOINT_PLANAR};
enum { N_KINDS = sizeof kinds / sizeof *kinds };

// The quaternions have length 2: only their direction may count.
static const double coordinates[N_KINDS][7] = {
    {0}, {0.7}, {-0.4}, {1, -1, 1, 1}, {0.3, 0.2, -0.5, 1, 1, -1, 1}, {0.4, -1.3}, {0.6, -0.2, 2.1}};
static const double speeds[6] = {0.3, -0.8, 0.5, 1.2, -0.6, 0.9};

static bough_joint joint_of(bough_joint_kind kind) {
    return (bough_joint){
        kind,
        {{1, 2, 3}, bough_rotation_matrix(bough_quaternion_exponential(bough_v3(0.2, 1, -0.5)))},
        {0.6, 0, 0.8},
        {0, 1, 0}};
}

TEST(sizes_match_the_kinds) {
    const int nq[] = {0, 1, 1, 4, 7, 2, 3}, nv[] = {0, 1, 1, 3, 6, 2, 3};
    for (int k = 0; k < N_KINDS; k++) {
        assert_int_equal(bough_joint_n_coordinates(kinds[k]), nq[k]);
        assert_int_equal(bough_joint_n_speeds(kinds[k]), nv[k]);
    }
    assert_string_equal(bough_joint_name(BOUGH_JOINT_SPHERICAL), "spherical");
    assert_string_equal(bough_joint_name(BOUGH_JOINT_UNIVERSAL), "universal");
    assert_int_equal(bough_joint_n_axes(BOUGH_JOINT_UNIVERSAL), 2);
    assert_int_equal(bough_joint_n_axes(BOUGH_JOINT_CYLINDRICAL), 1);
}

TEST(poses_by_hand) {
    bough_joint j = {BOUGH_JOINT_REVOLUTE, bough_transform_identity(), {0, 0, 1}, {1, 0, 0}};
    double quarter = acos(-1.0) / 2;
    bough_transform x = bough_joint_pose(&j, &quarter);
    check_near(x.rotation.c1.y, 1, 1e-15, 0); // x turns to y
    check_near(x.rotation.c2.x, -1, 1e-15, 0);
    check_near(x.rotation.c3.z, 1, 0, 0);
    j.kind = BOUGH_JOINT_PRISMATIC;
    j.placement.position = bough_v3(1, 0, 0);
    x = bough_joint_pose(&j, &quarter);
    check_near(x.position.x, 1, 0, 0);
    check_near(x.position.z, quarter, 0, 0);
    j.kind = BOUGH_JOINT_CYLINDRICAL;
    x = bough_joint_pose(&j, (double[]){2, quarter});
    check_near(x.position.z, 2, 0, 0);
    check_near(x.rotation.c1.y, 1, 1e-15, 0);
    j.kind = BOUGH_JOINT_PLANAR; // in the plane of x and y
    x = bough_joint_pose(&j, (double[]){2, 3, quarter});
    check_near(x.position.x, 3, 0, 0); // placed at x = 1
    check_near(x.position.y, 3, 0, 0);
    check_near(x.rotation.c1.y, 1, 1e-15, 0);
    double q[7] = {4, 5, 6, 0, 0, 3, 0}; // half a turn about y
    j.kind = BOUGH_JOINT_FREE;
    x = bough_joint_pose(&j, q);
    check_near(x.position.x, 5, 0, 0);
    check_near(x.rotation.c1.x, -1, 1e-15, 0);
    check_near(x.rotation.c2.y, 1, 1e-15, 0);
}

// Ẋ of the pose moved along q̇ = N(q) v is the twist S v.
TEST(rate_moves_the_pose_by_the_twist) {
    const double h = 1e-6;
    for (int k = 1; k < N_KINDS; k++) {
        bough_joint j = joint_of(kinds[k]);
        double rate[7], q[7];
        bough_transform side[2], here = bough_joint_pose(&j, coordinates[k]);
        bough_joint_rate(&j, coordinates[k], speeds, rate);
        for (int s = 0; s < 2; s++) {
            for (int i = 0; i < 7; i++) q[i] = coordinates[k][i];
            for (int i = 0; i < bough_joint_n_coordinates(kinds[k]); i++) {
                q[i] += (s ? h : -h) * rate[i];
            }
            side[s] = bough_joint_pose(&j, q);
        }
        bough_twist v = bough_joint_twist(&j, speeds);
        bough_vec3 moved = bough_mat3_tmul(here.rotation, bough_sub(side[1].position, side[0].position));
        bough_vec3 turned = bough_quaternion_logarithm(bough_quaternion_of_matrix(
            bough_mat3_product(bough_mat3_transpose(side[0].rotation), side[1].rotation)));
        check_near(bough_norm(bough_axpy(-2 * h, v.linear, moved)), 0, 0, 1e-8 * 2 * h);
        check_near(bough_norm(bough_axpy(-2 * h, v.angular, turned)), 0, 0, 1e-8 * 2 * h);
        assert_true(bough_norm(v.linear) + bough_norm(v.angular) > 0.2);
    }
}

TEST(speed_inverts_the_rate) {
    for (int k = 0; k < N_KINDS; k++) {
        bough_joint j = joint_of(kinds[k]);
        double rate[7] = {0}, v[6] = {0};
        bough_joint_rate(&j, coordinates[k], speeds, rate);
        int row = kinds[k] == BOUGH_JOINT_FREE ? 3 : 0; // stretching a quaternion is no motion
        if (bough_joint_n_coordinates(kinds[k]) >= 4) {
            for (int i = row; i < row + 4; i++) rate[i] += 0.3 * coordinates[k][i];
        }
        bough_joint_speed(&j, coordinates[k], rate, v);
        for (int i = 0; i < bough_joint_n_speeds(kinds[k]); i++) {
            check_near(v[i], speeds[i], 1e-14, 0);
        }
    }
}

// Sᵀ is the transpose of S: vᵀ(Sᵀ f) = (S v)ᵀ f
TEST(force_is_dual_to_the_twist) {
    bough_wrench f = {{1, -2, 3}, {0.5, 4, -1}};
    for (int k = 0; k < N_KINDS; k++) {
        bough_joint j = joint_of(kinds[k]);
        double tau[6] = {0}, power = 0;
        bough_joint_force(&j, f, tau);
        for (int i = 0; i < bough_joint_n_speeds(kinds[k]); i++) power += tau[i] * speeds[i];
        check_near(power, bough_power(bough_joint_twist(&j, speeds), f), 1e-14, 0);
    }
}

TEST(normalising_keeps_the_pose) {
    bough_joint j = joint_of(BOUGH_JOINT_FREE);
    double q[7];
    memcpy(q, coordinates[4], sizeof q);
    check_near(bough_joint_drift(&j, q), 1, 1e-15, 0);
    bough_joint_normalise(&j, q);
    check_near(bough_joint_drift(&j, q), 0, 0, 1e-15);
    check_near(q[3], 0.5, 1e-15, 0);
    check_near(q[2], -0.5, 0, 0);    // the position is left alone
    for (int k = 0; k < 1000; k++) { // twice is as once
        double once[7], twice[7];
        for (int i = 0; i < 7; i++) once[i] = sin(1.3 * k + 0.7 * i * i);
        bough_joint_normalise(&j, once);
        memcpy(twice, once, sizeof once);
        bough_joint_normalise(&j, twice);
        assert_memory_equal(once, twice, sizeof once);
    }
    bough_vec3 a = bough_joint_pose(&j, q).rotation.c1;
    bough_vec3 b = bough_joint_pose(&j, coordinates[4]).rotation.c1;
    check_near(bough_norm(bough_sub(a, b)), 0, 0, 1e-15);
}

// -- spatial algebra -------------------------------------------------------------------------

static const bough_twist some_twist = {{1, -2, 0.5}, {0.3, 0.7, -1}};

static bough_transform some_placement(void) { return joint_of(BOUGH_JOINT_FIXED).placement; }

TEST(power_does_not_depend_on_the_frame) {
    bough_transform x = some_placement();
    bough_wrench f = {{1, -2, 3}, {0.5, 4, -1}};
    check_near(bough_power(bough_twist_to_child(&x, some_twist), f),
               bough_power(some_twist, bough_wrench_to_parent(&x, f)), 1e-14, 0);
}

// Kinetic energy of four point masses, directly and by the inertia in another frame.
TEST(inertia_moves_with_the_frame) {
    const bough_vec3 at[4] = {{1, 0, 0.5}, {0, 2, -1}, {-0.3, 0.4, 1}, {0.2, 0.1, 0.7}};
    bough_transform x = some_placement();
    bough_inertia child = {0};
    double energy = 0;
    for (int i = 0; i < 4; i++) {
        bough_mat3 none = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        child = bough_inertia_add(child, bough_inertia_of(1 + i, at[i], none));
        bough_vec3 r = bough_add(x.position, bough_mat3_mul(x.rotation, at[i]));
        bough_vec3 v = bough_add(some_twist.linear, bough_cross(some_twist.angular, r));
        energy += 0.5 * (1 + i) * bough_dot(v, v);
    }
    bough_inertia parent = bough_inertia_to_parent(&x, child);
    bough_twist inside = bough_twist_to_child(&x, some_twist);
    check_near(0.5 * bough_power(some_twist, bough_inertia_mul(&parent, some_twist)), energy, 1e-14, 0);
    check_near(0.5 * bough_power(inside, bough_inertia_mul(&child, inside)), energy, 1e-14, 0);
}

TEST(inverse_placement_undoes) {
    bough_transform x = some_placement();
    bough_transform one = bough_transform_compose(bough_transform_inverse(x), x);
    check_near(bough_norm(one.position), 0, 0, 1e-15);
    check_near(one.rotation.c1.x + one.rotation.c2.y + one.rotation.c3.z, 3, 1e-15, 0);
}
