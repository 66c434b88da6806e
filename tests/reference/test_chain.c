// The chain as a second structure: the contract of any structure, its springs' laws, its free
// flight in both formulations, and definitions that are refused.
#include "tests/reference/body_frame_contract.h"

#include "tests/reference/chain.h"

#include <stdlib.h>

enum { N = 5 }; // links

typedef struct fixture {
    bough_arena *arena;
    bough_chain_link link[N];
    bough_vertex rest[N + 1];
    bough_inertia inertia[N + 1];
    bough_chain_def def;
} fixture;

// A crooked chain of unequal bodies with mass offsets, hooks off the vertices.
static int setup(void **context) {
    fixture *f = calloc(1, sizeof *f);
    int at = 500;
    f->arena = bough_arena_create();
    for (int i = 0; i <= N; i++) {
        bough_vec3 place = bough_axpy(0.8 * i, bough_v3(0.6, 0, 0.8), structure_vector(&at, 0.1));
        f->rest[i].position = place;
        f->rest[i].rotation = bough_quaternion_exponential(structure_vector(&at, 0.7));
        bough_mat3 about = {{0.3, 0.02, 0.01}, {0.02, 0.4, -0.03}, {0.01, -0.03, 0.5}};
        f->inertia[i] = bough_inertia_of(1.5 + 0.2 * i, structure_vector(&at, 0.1), about);
    }
    for (int i = 0; i < N; i++) {
        f->link[i] = (bough_chain_link){
            structure_vector(&at, 0.15), structure_vector(&at, 0.15), 40 + 3 * i, 25, 1.2, 15 - i, 0.7};
    }
    f->def = (bough_chain_def){"sample", N, 0, f->link, f->rest, f->inertia};
    *context = f;
    return 0;
}

static int teardown(void **context) {
    fixture *f = *context;
    bough_arena_destroy(f->arena);
    free(f);
    return 0;
}

static bough_structure *build(fixture *f) {
    bough_structure *structure = NULL;
    check_ok(bough_chain_create(f->arena, &f->def, &structure));
    return structure;
}

TEST_WITH(chain_fulfils_the_structural_contract, setup, teardown) {
    fixture *f = *context;
    structure_case c = structure_case_at(build(f), f->inertia, 0.3);
    structure_check(&c);
}

// Also with the BRF welded to a vertex within the chain or to its end.
TEST_WITH(body_frame_of_the_chain_is_exact, setup, teardown) {
    fixture *f = *context;
    for (int reference = 0; reference <= N; reference++) {
        f->def.reference = reference;
        structure_case c = structure_case_at(build(f), f->inertia, 0.3);
        structure_check_body_frame(&c);
    }
}

// -- two bodies on the z-axis, hooks on the vertices ----------------------------------------------

static bough_structure *build_pair(fixture *f) {
    for (int i = 0; i < 2; i++) {
        f->rest[i] = (bough_vertex){.position = {0, 0, 2 * i}, .rotation = {1, 0, 0, 0}};
    }
    f->link[0] = (bough_chain_link){.stiffness = 30,
                                    .hardening = 8,
                                    .damping = 0.5,
                                    .rotational_stiffness = 4,
                                    .rotational_damping = 0.3};
    f->def.n_link = 1;
    return build(f);
}

TEST_WITH(spring_and_damper_follow_their_laws, setup, teardown) {
    bough_structure *s = build_pair(*context);
    bough_vertex vertex[2] = {s->rest[0], s->rest[1]};
    bough_wrench force[2];
    vertex[1].position.z = 2.5; // e = 0.5, ℓ̇ = 3
    vertex[1].velocity = bough_v3(1, 0, 3);
    assert_true(s->ops->elastic.force(s->self, vertex, force));
    check_near(force[0].force.z, 30 * 0.5 + 8 * 0.125, 1e-14, 0);
    check_near(force[1].force.z, -16, 1e-14, 0);
    check_near(s->ops->elastic_energy(s->self, vertex), 15 * 0.25 + 2 * 0.0625, 1e-14, 0);
    assert_true(s->ops->viscous.force(s->self, vertex, force));
    check_near(force[0].force.z, 0.5 * 3, 1e-14, 0);
    check_near(force[0].force.x, 0, 0, 1e-15);
    assert_false(s->ops->elastic.force(s->self, (bough_vertex[]){vertex[0], vertex[0]}, force));
}

TEST_WITH(rotational_spring_and_damper_follow_their_laws, setup, teardown) {
    bough_structure *s = build_pair(*context);
    bough_vertex vertex[2] = {s->rest[0], s->rest[1]};
    bough_wrench force[2];
    vertex[1].rotation = bough_quaternion_exponential(bough_v3(0, 2.5, 0)); // beyond a right angle
    vertex[1].spin = bough_v3(0, 2, 0);
    assert_true(s->ops->elastic.force(s->self, vertex, force));
    check_near(force[0].moment.y, 4 * sin(2.5), 1e-14, 0);
    check_near(force[1].moment.y, -4 * sin(2.5), 1e-14, 0);
    check_near(s->ops->elastic_energy(s->self, vertex), 4 * (1 - cos(2.5)), 1e-14, 0);
    assert_true(s->ops->viscous.force(s->self, vertex, force));
    check_near(force[1].moment.y, -0.3 * 2, 1e-14, 0);
}

// -- free flight ----------------------------------------------------------------------------------

// A freely falling chain, once by (11) in the ground, once by (12) in its body frame; the unknowns
// are vertices, in the body frame with (x₀, p₀, v_R) in the reference vertex' place.
enum { UNKNOWNS = 13 * (N + 1) };

typedef struct flight {
    const bough_structure *structure;
    bough_vec3 gravity; // in the ground
    bough_body_frame frame;
} flight;

typedef void flight_rate(flight *f, const bough_vertex *y, bough_vertex *rate);

static bough_quaternion turn_rate(bough_quaternion p, bough_vec3 spin) {
    bough_quaternion w = {0, spin.x / 2, spin.y / 2, spin.z / 2};
    return bough_quaternion_product(p, w);
}

static void rate_in_the_ground(flight *f, const bough_vertex *y, bough_vertex *rate) {
    structure_case at = {.structure = f->structure, .pose = bough_transform_identity()};
    bough_twist a[STRUCTURE_MAX];
    bough_body_frame_relative(N + 1, at.motion.twist, y, at.relative);
    at.motion.gravity = f->gravity;
    structure_newton_euler(&at, false, a);
    for (int i = 0; i <= N; i++) {
        rate[i] =
            (bough_vertex){y[i].velocity, turn_rate(y[i].rotation, y[i].spin), a[i].linear, a[i].angular};
    }
}

static structure_case case_of(const flight *f, const bough_vertex *y) {
    const bough_structure *s = f->structure;
    const bough_vertex *brf = &y[s->reference], *rest = &s->rest[s->reference];
    structure_case at = {.structure = s};
    memcpy(at.relative, y, (N + 1) * sizeof *y); // same members
    at.relative[s->reference] =
        (bough_relative_vertex){.position = rest->position, .rotation = rest->rotation};
    at.pose = (bough_transform){brf->position, bough_rotation_matrix(brf->rotation)};
    at.motion.twist = (bough_twist){brf->velocity, brf->spin};
    at.motion.gravity = bough_mat3_tmul(at.pose.rotation, f->gravity);
    return at;
}

static void rate_in_the_frame(flight *f, const bough_vertex *y, bough_vertex *rate) {
    structure_case at = case_of(f, y);
    double inertia[36], v_r_rate[6], v_e_rate[6 * N];
    structure_evaluate(&at, false, &f->frame);
    bough_body_frame_reduce(&f->frame, inertia, v_r_rate);
    assert_true(bough_cholesky_factor(6, inertia));
    bough_cholesky_solve(6, inertia, v_r_rate);
    bough_body_frame_flexible(&f->frame, v_r_rate, v_e_rate);
    for (int i = 0, k = 0; i <= N; i++) {
        bool is_frame = i == f->structure->reference;
        bough_twist a = bough_twist_load(is_frame ? v_r_rate : v_e_rate + 6 * k++);
        bough_vec3 w = y[i].spin, u = y[i].velocity;
        if (is_frame) {
            rate[i] = (bough_vertex){bough_mat3_mul(at.pose.rotation, u), turn_rate(y[i].rotation, w),
                                     bough_sub(a.linear, bough_cross(w, u)), a.angular};
        } else { // ω̂ in BRF axes turns from the left
            bough_vec3 own = bough_mat3_tmul(bough_rotation_matrix(y[i].rotation), w);
            rate[i] = (bough_vertex){u, turn_rate(y[i].rotation, own), a.linear, a.angular};
        }
    }
}

static void runge_kutta(flight *f, flight_rate *rate_of, double h, double *y) {
    double k[4][UNKNOWNS], z[UNKNOWNS];
    const double node[4] = {0, 0.5, 0.5, 1};
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < UNKNOWNS; i++) {
            z[i] = y[i] + (stage > 0 ? node[stage] * h * k[stage - 1][i] : 0);
        }
        bough_vertex at[N + 1], rate[N + 1];
        memcpy(at, z, sizeof z);
        rate_of(f, at, rate);
        memcpy(k[stage], rate, sizeof rate);
    }
    for (int i = 0; i < UNKNOWNS; i++) {
        y[i] += h / 6 * (k[0][i] + 2 * k[1][i] + 2 * k[2][i] + k[3][i]);
    }
}

static bough_vec3 momentum_of(const bough_structure *s, const bough_vertex *vertex) {
    bough_twist velocity[N + 1];
    bough_wrench momentum[N + 1];
    for (int i = 0; i <= N; i++) velocity[i] = (bough_twist){vertex[i].velocity, vertex[i].spin};
    structure_mass_times(s, vertex, velocity, momentum);
    return structure_sum(N + 1, vertex, momentum).force;
}

TEST_WITH(free_flight_is_one_in_both_formulations, setup, teardown) {
    fixture *f = *context;
    f->def.reference = 2;
    flight ride = {.structure = build(f), .gravity = {1, -2, -9}};
    structure_case start = structure_case_at(ride.structure, f->inertia, 0.2);
    bough_vertex vertex[STRUCTURE_MAX], inner[N + 1], from_frame[N + 1];
    double ground[UNKNOWNS], frame[UNKNOWNS], mass = 0;
    const double h = 1e-3, steps = 400;
    assert_true(bough_body_frame_init(&ride.frame, f->arena, ride.structure));
    structure_vertices(&start, vertex);
    bough_vec3 before = momentum_of(ride.structure, vertex);
    memcpy(inner, start.relative, sizeof inner);
    inner[2] = (bough_vertex){start.pose.position, bough_quaternion_of_matrix(start.pose.rotation),
                              start.motion.twist.linear, start.motion.twist.angular};
    memcpy(ground, vertex, sizeof ground);
    memcpy(frame, inner, sizeof frame);
    for (int i = 0; i < steps; i++) {
        runge_kutta(&ride, rate_in_the_ground, h, ground);
        runge_kutta(&ride, rate_in_the_frame, h, frame);
    }
    memcpy(vertex, ground, sizeof ground);
    memcpy(inner, frame, sizeof inner);
    structure_case end = case_of(&ride, inner);
    structure_vertices(&end, from_frame);
    for (int i = 0; i <= N; i++) {
        bough_vec3 gap = bough_sub(from_frame[i].position, vertex[i].position);
        check_near(bough_norm(gap), 0, 0, 1e-7);
        mass += f->inertia[i].mass;
    }
    bough_vec3 after = momentum_of(ride.structure, from_frame);
    bough_vec3 fallen = bough_axpy(mass * h * steps, ride.gravity, before);
    check_near(bough_norm(bough_sub(after, fallen)), 0, 0, 1e-6);
}

// -- refusals -------------------------------------------------------------------------------------

static void refuse(fixture *f, const char *message) {
    bough_structure *structure = NULL;
    bough_status status = bough_chain_create(f->arena, &f->def, &structure);
    assert_int_equal(status.code, BOUGH_INVALID);
    assert_string_equal(status.message, message);
    assert_null(structure);
}

TEST_WITH(unusable_definitions_are_refused_by_name, setup, teardown) {
    fixture *f = *context;
    fixture good = *f;
    f->link[3].stiffness = 0;
    refuse(f, "chain sample: link 4 needs a positive stiffness and no other coefficient below 0");
    memcpy(f->link, good.link, sizeof f->link);
    f->inertia[2].mass = -1;
    refuse(f, "chain sample: the inertia of vertex 2 is not positive definite");
    memcpy(f->inertia, good.inertia, sizeof f->inertia);
    f->rest[1] = f->rest[0];
    f->link[0].left = f->link[0].right;
    refuse(f, "chain sample: the hooks of link 1 coincide");
    f->def.reference = N + 1;
    refuse(f, "chain sample: 5 links and reference vertex 6; the vertices are 0 to 5");
}
