// The rod as a structure, and the body frame's equations (12)–(15) against the rod's own right-hand
// side.
#include "tests/reference/body_frame_contract.h"

#include "tests/reference/rod_energy.h"
#include "tests/reference/rod_structure.h"
#include "tests/unit/sample_rod.h"

#include <stdlib.h>

enum { N = 7, STATES = BOUGH_ROD_STATES * N };

typedef struct fixture {
    bough_arena *arena;
    bough_rod_model *model;
    bough_structure *structure;
    bough_inertia inertia[N + 1];
    structure_case at;
} fixture;

static int setup(void **context) {
    fixture *f = calloc(1, sizeof *f);
    f->arena = check_memory();
    f->model = sample_general(f->arena, N);
    check_ok(bough_rod_structure_create(f->arena, f->model, &f->structure));
    for (int i = 0; i <= N; i++) {
        const bough_vertex_inertia *v = &f->model->vertex[i];
        const double *j = v->inertia;
        f->inertia[i] =
            (bough_inertia){v->mass, v->moment, {{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}}};
    }
    f->at = structure_case_at(f->structure, f->inertia, 0.25);
    *context = f;
    return 0;
}

static int teardown(void **context) {
    fixture *f = *context;
    bough_arena_destroy(f->arena);
    free(f);
    return 0;
}

TEST_WITH(rod_fulfils_the_structural_contract, setup, teardown) {
    fixture *f = *context;
    structure_check(&f->at);
}

TEST_WITH(body_frame_of_the_rod_is_exact, setup, teardown) {
    fixture *f = *context;
    structure_check_body_frame(&f->at);
}

// The rod's state (rod.h) and input at the case: absolute velocities in BRF axes.
static void rod_state(const fixture *f, double *state, double *input) {
    bough_vertex vertex[STRUCTURE_MAX];
    bough_transform here = bough_transform_identity();
    bough_body_frame_vertices(N + 1, &here, f->at.motion.twist, f->at.relative, vertex);
    for (int i = 1; i <= N; i++) {
        const bough_vertex *v = &vertex[i];
        const double values[BOUGH_ROD_STATES] = {v->position.x, v->position.y, v->position.z, v->rotation.w,
                                                 v->rotation.x, v->rotation.y, v->rotation.z, v->velocity.x,
                                                 v->velocity.y, v->velocity.z, v->spin.x,     v->spin.y,
                                                 v->spin.z};
        for (int c = 0; c < BOUGH_ROD_STATES; c++) state[c * N + i - 1] = values[c];
    }
    bough_twist_store(f->at.motion.twist, input);
    input[6] = f->at.motion.gravity.x;
    input[7] = f->at.motion.gravity.y;
    input[8] = f->at.motion.gravity.z;
}

// Loads of the rod on all vertices, the root included, also as wrenches of (12).
static void load_both(const fixture *f, bough_rod_loads *loads, bough_body_frame *b) {
    bough_rod_loads_init(loads, f->arena, f->model);
    sample_loads(f->model, loads);
    memset(loads->rate, 0, 6 * (size_t)f->model->stride * sizeof(double));
    for (int i = 0; i <= N; i++) {
        double values[6];
        for (int c = 0; c < 6; c++) values[c] = loads->value[c * f->model->stride + i];
        bough_attachment at = {i, {0, 0, 0}};
        bough_body_frame_add_wrench(b, &at, bough_wrench_load(values));
    }
}

// v̇_E of (12) whatever the given v̇_R, by (14) into rates of u and W: u̇ = ẍ − Ω₀×u.
TEST_WITH(accelerations_are_those_of_the_rods_right_hand_side, setup, teardown) {
    fixture *f = *context;
    bough_rod_loads loads;
    bough_rod_scratch scratch;
    bough_body_frame b;
    double state[STATES], input[BOUGH_ROD_INPUTS], rate[STATES], v_e_rate[6 * N];
    double expected[6 * N], values[6 * N];
    const double v_r_rate[2][6] = {{0}, {3, -7, 5, 2, -4, 9}};
    bough_rod_scratch_init(&scratch, f->arena, f->model);
    assert_true(bough_body_frame_init(&b, f->arena, f->structure));
    structure_evaluate(&f->at, false, &b);
    load_both(f, &loads, &b);
    rod_state(f, state, input);
    assert_true(bough_rod_derivative(f->model, &loads, 0, state, input, &scratch, rate));
    for (int k = 0; k < 6 * N; k++) expected[k] = rate[(BOUGH_ROD_U + k / N) * N + k % N];
    for (int which = 0; which < 2; which++) {
        bough_twist a[N + 1];
        bough_body_frame_flexible(&b, v_r_rate[which], v_e_rate);
        bough_body_frame_accelerations(&b, v_r_rate[which], v_e_rate, a);
        for (int i = 1; i <= N; i++) {
            bough_vec3 turn = bough_cross(f->at.motion.twist.angular, b.vertex[i].velocity);
            double one[6];
            bough_twist_store((bough_twist){bough_sub(a[i].linear, turn), a[i].angular}, one);
            for (int c = 0; c < 6; c++) values[c * N + i - 1] = one[c];
        }
        structure_near(values, expected, 6 * N, 1e-10, "rate of u and W");
    }
}

// The reduced force is the wrench that rod.h hands to the carrier, and the root vertex' own terms.
TEST_WITH(reduced_force_is_the_root_wrench, setup, teardown) {
    fixture *f = *context;
    bough_rod_loads loads;
    bough_rod_scratch scratch;
    bough_body_frame b;
    double state[STATES], input[BOUGH_ROD_INPUTS], wrench[6], inertia[36], force[6];
    bough_rod_scratch_init(&scratch, f->arena, f->model);
    assert_true(bough_body_frame_init(&b, f->arena, f->structure));
    structure_evaluate(&f->at, false, &b);
    load_both(f, &loads, &b);
    rod_state(f, state, input);
    bough_rod_root_wrench(f->model, &loads, 0, state, input, &scratch, wrench);
    bough_body_frame_reduce(&b, inertia, force);
    bough_transform x = {{0, 0, 0}, bough_rotation_matrix(f->model->rotation0[0])};
    bough_inertia root = bough_inertia_to_parent(&x, f->inertia[0]);
    bough_twist spin = {{0, 0, 0}, f->at.motion.twist.angular};
    bough_twist fall = {f->at.motion.gravity, {0, 0, 0}};
    bough_wrench own = bough_wrench_sub(bough_inertia_mul(&root, fall),
                                        bough_wrench_cross(spin, bough_inertia_mul(&root, spin)));
    bough_wrench sum = bough_wrench_add(bough_wrench_load(wrench), own);
    structure_near(force, &sum, 6, 1e-10, "reduced force");
}

// The energy in rod.h's own terms is the structure's.
TEST_WITH(energy_is_that_of_the_rod, setup, teardown) {
    fixture *f = *context;
    bough_rod_scratch scratch;
    bough_vertex vertex[STRUCTURE_MAX];
    double state[STATES], input[BOUGH_ROD_INPUTS];
    bough_rod_scratch_init(&scratch, f->arena, f->model);
    rod_state(f, state, input);
    bough_rod_gather(f->model, state, input, &scratch);
    structure_vertices(&f->at, vertex);
    double energy = f->structure->ops->elastic_energy(f->structure->self, vertex);
    check_near(energy, rod_elastic_energy(f->model, &scratch), 1e-12, 0);
}

TEST_WITH(relative_coordinates_are_undone, setup, teardown) {
    fixture *f = *context;
    bough_vertex vertex[STRUCTURE_MAX];
    bough_relative_vertex back[STRUCTURE_MAX];
    bough_transform here = bough_transform_identity();
    bough_body_frame_vertices(N + 1, &here, f->at.motion.twist, f->at.relative, vertex);
    bough_body_frame_relative(N + 1, f->at.motion.twist, vertex, back);
    structure_near(back, f->at.relative, 13 * (N + 1), 1e-14, "relative coordinates");
}

TEST_WITH(overturned_segment_is_refused, setup, teardown) {
    fixture *f = *context;
    bough_body_frame b;
    assert_true(bough_body_frame_init(&b, f->arena, f->structure));
    f->at.relative[4].rotation = (bough_quaternion){0, 1, 0, 0};
    assert_false(bough_body_frame_evaluate(&b, &f->at.motion, f->at.relative));
}
