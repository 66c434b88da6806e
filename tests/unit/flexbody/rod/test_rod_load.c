// Loads along a rod as loads on its vertices.

#include "flexbody/rod/rod_load.h"
#include "tests/unit/sample_rod.h"

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

static const double wrench[6] = {3, -2, 0.5, 1, 4, -0.7};

static bough_rod_ramped_load empty(bough_arena *arena, const bough_rod_model *m, bool follower) {
    size_t count = 6 * (size_t)m->stride;
    return (bough_rod_ramped_load){.follower = follower,
                                   .value = bough_arena_doubles(arena, count),
                                   .line = bough_arena_doubles(arena, 2 * count)};
}

TEST(resultant_of_a_point_load_is_the_load) {
    check_arena(arena);
    const bough_rod_model *m = sample_general(arena, N);
    for (int k = 0; k <= 13; k++) {
        double s = k * m->span[N] / 13;
        bough_rod_ramped_load load = empty(arena, m, false);
        bough_rod_lump(m, (bough_rod_reach){s, s}, wrench, NULL, &load);
        sums sum = resultant(m, load.value);
        int n = 0;
        while (n < N - 1 && s >= m->span[n + 1]) n++;
        double xi = (s - m->span[n]) / (m->span[n + 1] - m->span[n]);
        bough_vec3 at = bough_axpy(xi, bough_sub(m->position0[n + 1], m->position0[n]), m->position0[n]);
        bough_vec3 force = {3, -2, 0.5}, moment = {1, 4, -0.7};
        check_vec3(sum.force, force, 1e-12, 1e-12);
        check_vec3(sum.moment, bough_add(moment, bough_cross(at, force)), 1e-12, 1e-12);
    }
}

TEST(resultant_of_a_line_load_is_the_load) {
    const double stiffness[6] = {1, 1, 1, 1, 1, 1}, inertia[4] = {1, 1, 1, 1};
    const bough_rod_reach reach[] = {{0, 6}, {0.3, 0.7}, {1.2, 4.9}, {2, 3}};
    check_arena(arena);
    const bough_rod_model *m = sample_uniform(arena, N, 6, stiffness, 0, inertia);
    for (int k = 0; k < 4; k++) {
        bough_rod_ramped_load load = empty(arena, m, false);
        double length = reach[k].to - reach[k].from, at = 0.5 * (reach[k].to + reach[k].from);
        bough_rod_lump(m, reach[k], wrench, NULL, &load);
        sums sum = resultant(m, load.value);
        bough_vec3 force = bough_scale(length, bough_v3(3, -2, 0.5));
        bough_vec3 moment = bough_scale(length, bough_v3(1, 4, -0.7));
        check_vec3(sum.force, force, 1e-12, 1e-12);
        check_vec3(sum.moment, bough_add(moment, bough_cross(bough_v3(0, 0, at), force)), 1e-12, 1e-12);
    }
}

// q h at inner vertices, q h/2 at the ends, q along every segment, unless the load would bend a segment by
// more than linear statics is good for, as one of a cable; on a part of a segment the linear load with the
// same ∫ξ(1 − ξ)q and ∫ξ(1 − ξ)(ξ − ½)q.
TEST(line_load_goes_to_vertices_and_segments) {
    const double inertia[4] = {1, 1, 1, 1}, across[6] = {12, 0, 0, 0, 0, 0};
    for (int cable = 0; cable < 2; cable++) {
        const double bending = cable ? 1e-3 : 100, stiffness[6] = {1, 1, 1, bending, bending, bending};
        check_arena(arena);
        const bough_rod_model *m = sample_uniform(arena, N, 2 * N, stiffness, 0, inertia);
        bough_rod_ramped_load load = empty(arena, m, false), part = empty(arena, m, false);
        bough_rod_lump(m, (bough_rod_reach){0, 2 * N}, across, NULL, &load);
        assert_true(load.along == !cable);
        for (int i = 0; i <= N; i++) {
            check_near(load.value[i], i == 0 || i == N ? 12 : 24, 1e-12, 0);
            check_near(load.value[4 * m->stride + i], 0, 0, 0);
        }
        for (int k = 0; k <= N || (cable && k < 12 * m->stride); k++)
            check_near(load.line[k], k < N && !cable ? 12 : 0, 1e-12, 0);
        if (cable) break;
        bough_rod_lump(m, (bough_rod_reach){0, 1}, across, NULL, &part);
        assert_true(part.along);
        check_near(part.line[0], 6, 1e-12, 0);
        check_near(part.line[6 * m->stride], -120 * 12 / 64. / 2, 1e-12, 0);
    }
}

// Seen in its section, a follower is a dead load.
TEST(follower_is_lumped_in_section_axes) {
    check_arena(arena);
    const bough_rod_model *m = sample_general(arena, N);
    int s = m->stride;
    bough_rod_ramped_load dead = empty(arena, m, false), follower = empty(arena, m, true);
    double in_section[6];
    bough_mat3 r = bough_rotation_matrix(m->rotation0[N]);
    bough_vec3 f = bough_mat3_tmul(r, bough_v3(3, -2, 0.5));
    bough_vec3 l = bough_mat3_tmul(r, bough_v3(1, 4, -0.7));
    const double turned[6] = {f.x, f.y, f.z, l.x, l.y, l.z};
    memcpy(in_section, turned, sizeof turned);
    bough_rod_reach last = {0.5 * (m->span[N - 1] + m->span[N]), m->span[N]};
    bough_rod_lump(m, last, wrench, NULL, &dead);
    bough_rod_lump(m, last, in_section, NULL, &follower);
    for (int c = 0; c < 6; c += 3) {
        const double *v = follower.value + c * s + N, *d = dead.value + c * s + N;
        check_vec3(bough_mat3_mul(r, bough_v3(v[0], v[s], v[2 * s])), bough_v3(d[0], d[s], d[2 * s]), 1e-12,
                   1e-12);
    }
}

// What a load along segments does to the undeformed rod, as loads on vertices: no resultant, and the
// accelerations of the rod at rest are the same, but for squares of the strain.
TEST(line_lumped_to_vertices_does_the_same_at_rest) {
    check_arena(arena);
    for (int kind = 0; kind < 2; kind++) {
        bough_rod_model *m = sample_general(arena, N);
        const double input[BOUGH_ROD_INPUTS] = {0};
        const bough_schedule ramp = {.start = 0};
        double state[BOUGH_ROD_STATES * N], rate[2][BOUGH_ROD_STATES * N];
        bough_rod_loads loads;
        bough_rod_scratch scratch;
        unsigned seed = 3;
        bough_rod_loads_init(&loads, arena, m);
        bough_rod_scratch_init(&scratch, arena, m);
        bough_rod_rest_state(m, input, state);
        bough_rod_ramped_load *load = bough_rod_loads_ramped(&loads, arena, m, kind == 0, &ramp);
        for (int k = 0; k < 36 * m->stride; k++) m->line[k] = 1e-6 * sample_random(&seed);
        for (int k = 0; k < 6 * m->stride; k++) load->line[k] = sample_random(&seed);
        load->along = true;
        assert_true(bough_rod_derivative(m, &loads, 0, state, input, &scratch, rate[0]));
        bough_rod_lump_line(m, load);
        assert_false(load->along);
        if (kind == 1) { // in the body's axes
            sums sum = resultant(m, load->value);
            check_vec3(sum.force, bough_v3(0, 0, 0), 1e-12, 1e-12);
            check_vec3(sum.moment, bough_v3(0, 0, 0), 1e-12, 1e-12);
        }
        assert_true(bough_rod_derivative(m, &loads, 0, state, input, &scratch, rate[1]));
        for (int k = 0; k < BOUGH_ROD_STATES * N; k++) {
            check_near(rate[0][k], rate[1][k], 1e-11, 1e-11);
        }
    }
}

// The moments of a bent rod's vertices about their own axes: of its segments and of a load on it.
static double rolling_moment(const bough_rod_model *m, const bough_rod_scratch *scratch,
                             const double *state) {
    int s = m->stride, n = m->n;
    double sum = 0;
    for (int k = 0; k < n; k++) sum += scratch->segment[5 * s + k] + scratch->segment[8 * s + k];
    for (int i = 0; i <= n; i++) {
        bough_quaternion p = bough_quaternion_identity();
        const double *at = state + i - 1;
        if (i > 0) p = (bough_quaternion){at[3 * n], at[4 * n], at[5 * n], at[6 * n]};
        const double *l = scratch->load + 3 * s + i;
        bough_vec3 axis = bough_rotation_matrix(bough_quaternion_normalised(p)).c3;
        sum += bough_dot(axis, bough_v3(l[0], l[s], l[2 * s]));
    }
    return sum;
}

// A dead force on the axis of a round rod does no work when all sections roll about their own axes, however
// the rod is bent and however soft it is: a cable on a spherical joint would spin.
TEST(force_between_vertices_does_not_roll_a_bent_rod) {
    const double inertia[4] = {1, 1, 1, 1}, input[BOUGH_ROD_INPUTS] = {0};
    const bough_schedule always = {0};
    for (int k = 0; k < 3; k++) {
        double bending = pow(10, k);
        const double stiffness[6] = {3000, 3000, 9000, bending, bending, bending};
        const double force[6] = {0.2, -0.5, 0.3, 0, 0, 0};
        double state[BOUGH_ROD_STATES * N];
        bough_rod_loads loads;
        bough_rod_scratch scratch;
        unsigned seed = 5;
        check_arena(arena);
        const bough_rod_model *m = sample_uniform(arena, N, N, stiffness, 0, inertia);
        bough_rod_loads_init(&loads, arena, m);
        bough_rod_scratch_init(&scratch, arena, m);
        bough_rod_rest_state(m, input, state);
        for (int i = 0; i < 7 * N; i++) state[i] += 0.05 * sample_random(&seed);
        bough_rod_lump(m, (bough_rod_reach){2.3, 2.3}, force, NULL,
                       bough_rod_loads_ramped(&loads, arena, m, false, &always));
        bough_rod_gather(m, state, input, &scratch);
        bough_rod_load(m, &loads, 0, &scratch);
        assert_true(bough_rod_forces(m, 0, N, &scratch));
        check_near(rolling_moment(m, &scratch, state), 0, 0, 1e-13);
    }
}
