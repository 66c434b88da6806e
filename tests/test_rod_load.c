// Loads along a rod as loads on its vertices.
#include "tests/check.h"

#include "flexbody/rod_load.h"
#include "tests/sample_rod.h"

enum { N = 6 };

typedef struct sums {
    bough_vec3 force, moment; // about the BRF's origin
} sums;

static sums resultant(const bough_rod_model *m, const double *value) {
    sums sum = {{0, 0, 0}, {0, 0, 0}};
    for (int i = 0; i <= m->n; i++) {
        const double *v = value + i;
        int s = m->stride;
        bough_vec3 force = {v[0], v[s], v[2 * s]}, moment = {v[3 * s], v[4 * s], v[5 * s]};
        sum.force = bough_add(sum.force, force);
        sum.moment = bough_add(sum.moment, bough_cross(m->position0[i], force));
        sum.moment = bough_add(sum.moment, moment);
    }
    return sum;
}

static void check_vector(bough_vec3 value, bough_vec3 expected) {
    check_near(value.x, expected.x, 1e-12, 1e-12);
    check_near(value.y, expected.y, 1e-12, 1e-12);
    check_near(value.z, expected.z, 1e-12, 1e-12);
}

static const double wrench[6] = {3, -2, 0.5, 1, 4, -0.7};

static void resultant_of_a_point_load_is_the_load(void **context) {
    (void)context;
    bough_arena *arena = bough_arena_create();
    const bough_rod_model *m = sample_general(arena, N);
    for (int k = 0; k <= 13; k++) {
        double s = k * m->span[N] / 13;
        double *value = bough_arena_doubles(arena, 6 * (size_t)m->stride);
        bough_rod_lump(m, (bough_rod_reach){s, s}, wrench, false, value);
        sums sum = resultant(m, value);
        int n = 0;
        while (n < N - 1 && s >= m->span[n + 1]) n++;
        double xi = (s - m->span[n]) / (m->span[n + 1] - m->span[n]);
        bough_vec3 at = bough_axpy(xi, bough_sub(m->position0[n + 1], m->position0[n]),
                                   m->position0[n]);
        bough_vec3 force = {3, -2, 0.5}, moment = {1, 4, -0.7};
        check_vector(sum.force, force);
        check_vector(sum.moment, bough_add(moment, bough_cross(at, force)));
    }
    bough_arena_destroy(arena);
}

static void resultant_of_a_line_load_is_the_load(void **context) {
    (void)context;
    const double stiffness[6] = {1, 1, 1, 1, 1, 1}, inertia[4] = {1, 1, 1, 1};
    const bough_rod_reach reach[] = {{0, 6}, {0.3, 0.7}, {1.2, 4.9}, {2, 3}};
    bough_arena *arena = bough_arena_create();
    const bough_rod_model *m = sample_uniform(arena, N, 6, stiffness, 0, inertia);
    for (int k = 0; k < 4; k++) {
        double *value = bough_arena_doubles(arena, 6 * (size_t)m->stride);
        double length = reach[k].to - reach[k].from, at = 0.5 * (reach[k].to + reach[k].from);
        bough_rod_lump(m, reach[k], wrench, false, value);
        sums sum = resultant(m, value);
        bough_vec3 force = bough_scale(length, bough_v3(3, -2, 0.5));
        bough_vec3 moment = bough_scale(length, bough_v3(1, 4, -0.7));
        check_vector(sum.force, force);
        check_vector(sum.moment, bough_add(moment, bough_cross(bough_v3(0, 0, at), force)));
    }
    bough_arena_destroy(arena);
}

// q h at inner vertices, q h/2 and q h²/12 at the ends.
static void uniform_load_leaves_moments_at_the_ends(void **context) {
    (void)context;
    const double stiffness[6] = {1, 1, 1, 1, 1, 1}, inertia[4] = {1, 1, 1, 1};
    const double across[6] = {12, 0, 0, 0, 0, 0};
    bough_arena *arena = bough_arena_create();
    const bough_rod_model *m = sample_uniform(arena, N, 2 * N, stiffness, 0, inertia);
    double *value = bough_arena_doubles(arena, 6 * (size_t)m->stride);
    bough_rod_lump(m, (bough_rod_reach){0, 2 * N}, across, false, value);
    for (int i = 0; i <= N; i++) {
        check_near(value[i], i == 0 || i == N ? 12 : 24, 1e-12, 0);
        check_near(value[4 * m->stride + i], i == 0 ? 4 : i == N ? -4 : 0, 1e-12, 1e-12);
    }
    bough_arena_destroy(arena);
}

// Seen in its section, a follower's couple is that of a dead load.
static void follower_is_lumped_in_section_axes(void **context) {
    (void)context;
    bough_arena *arena = bough_arena_create();
    const bough_rod_model *m = sample_general(arena, N);
    int s = m->stride;
    double *dead = bough_arena_doubles(arena, 6 * (size_t)s);
    double *follower = bough_arena_doubles(arena, 6 * (size_t)s);
    double in_section[6];
    bough_mat3 r = bough_rotation_matrix(m->rotation0[N]);
    bough_vec3 f = bough_mat3_tmul(r, bough_v3(3, -2, 0.5));
    bough_vec3 l = bough_mat3_tmul(r, bough_v3(1, 4, -0.7));
    const double turned[6] = {f.x, f.y, f.z, l.x, l.y, l.z};
    memcpy(in_section, turned, sizeof turned);
    bough_rod_reach last = {m->span[N - 1], m->span[N]};
    bough_rod_lump(m, last, wrench, false, dead);
    bough_rod_lump(m, last, in_section, true, follower);
    for (int c = 0; c < 6; c += 3) {
        bough_vec3 seen = {follower[c * s + N], follower[(c + 1) * s + N],
                           follower[(c + 2) * s + N]};
        check_vector(bough_mat3_mul(r, seen), bough_v3(dead[c * s + N], dead[(c + 1) * s + N],
                                                       dead[(c + 2) * s + N]));
    }
    bough_arena_destroy(arena);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(resultant_of_a_point_load_is_the_load),
        cmocka_unit_test(resultant_of_a_line_load_is_the_load),
        cmocka_unit_test(uniform_load_leaves_moments_at_the_ends),
        cmocka_unit_test(follower_is_lumped_in_section_axes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
