// Quaternions, their matrices and the exponential.
#include "tests/unit/check.h"

#include "core/base/rotation.h"

static const double pi = 3.14159265358979323846;

static double distance(bough_mat3 a, bough_mat3 b) {
    return bough_norm(bough_sub(a.c1, b.c1)) + bough_norm(bough_sub(a.c2, b.c2)) +
           bough_norm(bough_sub(a.c3, b.c3));
}

// Rodrigues' formula for a unit axis, by its action on the three unit vectors
static bough_mat3 rodrigues(bough_vec3 a, double angle) {
    bough_mat3 r = bough_mat3_identity();
    bough_vec3 *columns[3] = {&r.c1, &r.c2, &r.c3};
    for (int k = 0; k < 3; k++) {
        bough_vec3 e = *columns[k], across = bough_cross(a, e);
        e = bough_axpy(sin(angle), across, e);
        *columns[k] = bough_axpy(1 - cos(angle), bough_cross(a, across), e);
    }
    return r;
}

static const bough_vec3 axis = {2.0 / 7, 3.0 / 7, -6.0 / 7};

TEST(exponential_is_rodrigues_formula) {
    const double angles[] = {0, 1e-9, 0.99e-4, 1.01e-4, 0.3, 2, pi, 5, 2 * pi, 40};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        bough_quaternion p = bough_quaternion_exponential(bough_scale(angles[i], axis));
        check_near(distance(bough_rotation_matrix(p), rodrigues(axis, angles[i])), 0, 0, 5e-15);
        check_near(p.w * p.w + p.x * p.x + p.y * p.y + p.z * p.z, 1, 1e-15, 0);
    }
}

TEST(logarithm_inverts_the_exponential) {
    const double angles[] = {0, 1e-12, 1e-7, 1e-4, 0.3, 2, 3.1, pi - 1e-9};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        bough_quaternion p = bough_quaternion_exponential(bough_scale(angles[i], axis));
        bough_quaternion other = {-p.w, -p.x, -p.y, -p.z}; // the same rotation
        bough_vec3 back = bough_quaternion_logarithm(p), also = bough_quaternion_logarithm(other);
        bough_vec3 expected = bough_scale(angles[i], axis);
        check_near(bough_norm(bough_sub(back, expected)), 0, 0, 1e-15 + 1e-15 * angles[i]);
        check_near(bough_norm(bough_sub(also, expected)), 0, 0, 1e-15 + 1e-15 * angles[i]);
    }
    bough_quaternion beyond = bough_quaternion_exponential(bough_scale(2 * pi - 0.5, axis));
    check_near(bough_norm(bough_add(bough_quaternion_logarithm(beyond), bough_scale(0.5, axis))), 0, 0,
               1e-14);
}

TEST(product_composes_rotations) {
    bough_quaternion p = bough_quaternion_exponential(bough_v3(0.4, -1.2, 0.7));
    bough_quaternion q = bough_quaternion_exponential(bough_v3(-2, 0.3, 0.1));
    bough_mat3 both = bough_mat3_product(bough_rotation_matrix(p), bough_rotation_matrix(q));
    check_near(distance(bough_rotation_matrix(bough_quaternion_product(p, q)), both), 0, 0, 5e-15);
    bough_quaternion one = bough_quaternion_product(p, bough_quaternion_conjugate(p));
    check_near(one.w, 1, 1e-15, 0);
    check_near(fabs(one.x) + fabs(one.y) + fabs(one.z), 0, 0, 1e-15);
}

// Half turns about each axis drive every branch of the inversion.
TEST(matrix_gives_the_quaternion_back) {
    const bough_vec3 turns[] = {{0, 0, 0},       {pi, 0, 0},     {0, pi, 0},     {0, 0, pi},
                                {3, 0.2, -0.1},  {-0.3, 3, 0.2}, {0.1, -0.2, 3}, {0.5, 0.6, 0.7},
                                {2.2, 2.2, 0.1}, {0, 2.2, -2.2}};
    for (size_t i = 0; i < sizeof turns / sizeof *turns; i++) {
        bough_mat3 r = bough_rotation_matrix(bough_quaternion_exponential(turns[i]));
        bough_quaternion p = bough_quaternion_of_matrix(r);
        assert_true(p.w >= 0);
        check_near(distance(bough_rotation_matrix(p), r), 0, 0, 3e-15);
    }
}

TEST(normalising_handles_zero) {
    bough_quaternion p = bough_quaternion_normalised((bough_quaternion){0, 0, 0, 0});
    check_near(p.w, 1, 0, 0);
    p = bough_quaternion_normalised((bough_quaternion){0, 3, 0, -4});
    check_near(p.x, 0.6, 1e-15, 0);
    check_near(p.z, -0.8, 1e-15, 0);
}

// J by differences of exp(ψ + h v) exp(ψ)⁻¹, its change by differences of J, its inverse by β: on both sides
// of where the factors change from series to formula.
TEST(tangents_are_derivatives_and_inverses) {
    const double angles[] = {1e-9, 0.05, 0.0999, 0.1001, 0.2236, 0.2237, 1, 3}, h = 1e-5;
    const bough_vec3 v = {0.3, -0.5, 0.8}, d = {-0.2, 0.7, 0.4};
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        bough_vec3 psi = bough_scale(angles[i], axis), side[2], map[2];
        for (int k = 0; k < 2; k++) {
            bough_vec3 at = bough_axpy(k ? h : -h, v, psi), beside = bough_axpy(k ? h : -h, d, psi);
            side[k] = bough_quaternion_logarithm(
                bough_quaternion_product(bough_quaternion_exponential(at),
                                         bough_quaternion_conjugate(bough_quaternion_exponential(psi))));
            map[k] = bough_exp_tangent(bough_exp_factors_of(beside), beside, v);
        }
        bough_exp_factors j = bough_exp_factors_of(psi);
        bough_vec3 w = bough_exp_tangent(j, psi, v), change = bough_exp_tangent_change(j, psi, d, v);
        check_near(bough_norm(bough_axpy(-0.5 / h, bough_sub(side[1], side[0]), w)), 0, 0, 1e-9);
        check_near(bough_norm(bough_axpy(-0.5 / h, bough_sub(map[1], map[0]), change)), 0, 0, 1e-9);
        double beta, slope, more, less, none;
        bough_log_factors(angles[i], &beta, &slope);
        bough_vec3 once = bough_cross(psi, w);
        bough_vec3 back = bough_axpy(beta, bough_cross(psi, once), bough_axpy(-0.5, once, w));
        check_near(bough_norm(bough_sub(back, v)), 0, 0, 1e-14);
        if (angles[i] < 0.2 && angles[i] > 0.06) continue; // differences across the change lose digits
        bough_log_factors(angles[i] + h, &more, &none);
        bough_log_factors(fabs(angles[i] - h), &less, &none);
        check_near(slope * angles[i], (more - less) / (2 * h), 0, 1e-8);
    }
    bough_mat3 about = bough_rotation_about(bough_v3(0.6, 0, 0.8), 2.5);
    bough_quaternion p = bough_quaternion_exponential(bough_v3(1.5, 0, 2));
    check_near(distance(about, bough_rotation_matrix(p)), 0, 0, 1e-15);
}
