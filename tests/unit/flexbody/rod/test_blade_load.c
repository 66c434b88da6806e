// The clamped NREL 5 MW blade under loads along it, in linear statics: against the integral of its
// sections' strains.
#include "tests/unit/blade_scene.h"
#include "tests/unit/sample_rod.h"

#include "core/base/linalg.h"
#include "flexbody/rod/rod_load.h"

enum { STEPS = 123000 }; // of the integrals along the blade, half a millimetre each

// A load per length along the blade, in its axes, constant between n + 1 places from root to tip (of the
// length).
typedef struct line_load {
    int n;
    double at[16];
    void (*value)(int k, double q[6]); // between places k and k + 1
} line_load;

static void load_at(const line_load *load, double s, double q[6]) {
    int k = 0;
    while (k < load->n - 1 && s >= load->at[k + 1]) k++;
    load->value(k, q);
}

typedef struct blade {
    bough_arena *arena;
    const bough_scene_structure *table;
    bough_rod_def def;
    bough_rod_model *model;
} blade;

static blade blade_with(int segments) {
    blade b = {.arena = check_memory()};
    bough_simulation *s = blade_scene(b.arena, segments);
    b.table = &s->scene->body[0].rod.structure;
    b.def = s->beam[0].def;
    check_ok(bough_rod_create(b.arena, &b.def, &b.model));
    return b;
}

// Compliance at s in the blade's axes.
static void compliance_at(const bough_scene_structure *table, double s, double full[36]) {
    int k = 0;
    while (k < table->n_station - 2 && s >= table->station[k + 1].def.position.z) k++;
    const bough_section_station *a = &table->station[k].def, *b = &table->station[k + 1].def;
    double share = (s - a->position.z) / (b->position.z - a->position.z), upper[21];
    for (int i = 0; i < 21; i++) upper[i] = a->stiffness[i] + share * (b->stiffness[i] - a->stiffness[i]);
    assert_true(bough_symmetric6_inverse(upper, upper));
    bough_symmetric6_rotate(upper, -(a->twist + share * (b->twist - a->twist)), upper);
    for (int i = 0; i < 36; i++) full[i] = upper[bough_symmetric6_index(i / 6, i % 6)];
}

static bough_vec3 vec(const double *x) { return bough_v3(x[0], x[1], x[2]); }

// Displacement and rotation at the vertices (6 × (n + 1)) by the midpoint rule: the stress from the
// tip inwards, then the strains from the root outwards.
static void integrate(const blade *b, const line_load *load, double *exact) {
    const bough_vec3 along = {0, 0, 1};
    int n = b->def.n_segment;
    double length = b->table->length, h = length / STEPS;
    double *stress = bough_arena_doubles(b->arena, 6 * (size_t)STEPS);
    bough_vec3 f = {0, 0, 0}, m = {0, 0, 0}, x = {0, 0, 0}, turn = {0, 0, 0};
    for (int k = STEPS - 1; k >= 0; k--) { // to the middle of each step, then past it
        for (int half = 0; half < 2; half++) {
            double q[6];
            load_at(load, (k + (half == 0 ? 0.75 : 0.25)) / STEPS, q);
            bough_vec3 df = bough_scale(0.5 * h, vec(q)), mean = bough_axpy(0.5, df, f);
            m = bough_axpy(0.5 * h, bough_add(vec(q + 3), bough_cross(along, mean)), m);
            f = bough_add(f, df);
            const double values[6] = {f.x, f.y, f.z, m.x, m.y, m.z};
            if (half == 0) memcpy(stress + 6 * (size_t)k, values, sizeof values);
        }
    }
    for (int k = 0; k < STEPS; k++) {
        double c[36], e[6] = {0};
        compliance_at(b->table, h * (k + 0.5), c);
        for (int i = 0; i < 36; i++) e[i / 6] += c[i] * stress[6 * (size_t)k + i % 6];
        bough_vec3 middle = bough_axpy(0.5 * h, vec(e + 3), turn);
        x = bough_axpy(h, bough_add(vec(e), bough_cross(middle, along)), x);
        turn = bough_axpy(h, vec(e + 3), turn);
        if ((k + 1) * n % STEPS != 0) continue;
        const double values[6] = {x.x, x.y, x.z, turn.x, turn.y, turn.z};
        memcpy(exact + 6 * ((k + 1) * n / STEPS), values, sizeof values);
    }
}

// The same of the rod: loads so small that it is linear.
static void solve(const blade *b, const line_load *load, double scale, double *found) {
    const bough_rod_model *m = b->model;
    const double at_rest[BOUGH_ROD_INPUTS] = {0};
    const bough_schedule always = {.start = 0};
    bough_rod_loads loads;
    bough_rod_static work;
    int n = m->n;
    double *state = bough_arena_doubles(b->arena, (size_t)BOUGH_ROD_STATES * n);
    bough_rod_loads_init(&loads, b->arena, m);
    bough_rod_static_init(&work, b->arena, m);
    bough_rod_ramped_load *to = bough_rod_loads_ramped(&loads, b->arena, m, false, &always);
    for (int k = 0; k < load->n; k++) {
        double q[6], length = m->span[n];
        load->value(k, q);
        for (int c = 0; c < 6; c++) q[c] *= scale;
        bough_rod_lump(m, (bough_rod_reach){load->at[k] * length, load->at[k + 1] * length}, q, NULL, to);
    }
    bough_rod_rest_state(m, at_rest, state);
    check_ok(rod_equilibrium(m, &loads, bough_v3(0, 0, 0), &work, state));
    for (int i = 1; i <= n; i++) {
        const double *y = state + i - 1;
        bough_quaternion p = {y[3 * n], y[4 * n], y[5 * n], y[6 * n]};
        bough_vec3 x = bough_sub(bough_v3(y[0], y[n], y[2 * n]), m->position0[i]);
        bough_vec3 turn = bough_quaternion_logarithm(
            bough_quaternion_product(p, bough_quaternion_conjugate(m->rotation0[i])));
        const double values[6] = {x.x, x.y, x.z, turn.x, turn.y, turn.z};
        for (int c = 0; c < 6; c++) found[6 * i + c] = values[c] / scale;
    }
}

// The largest error of displacements and of rotations, each against the largest.
static double error_of(int segments, const line_load *load) {
    const double scale = 1e-4;
    blade b = blade_with(segments);
    double *exact = bough_arena_doubles(b.arena, 6 * ((size_t)segments + 1));
    double *found = bough_arena_doubles(b.arena, 6 * ((size_t)segments + 1));
    double error[2] = {0, 0}, size[2] = {0, 0};
    integrate(&b, load, exact);
    solve(&b, load, scale, found);
    for (int i = 0; i < 6 * (segments + 1); i++) {
        int kind = i % 6 / 3;
        error[kind] = fmax(error[kind], fabs(found[i] - exact[i]));
        size[kind] = fmax(size[kind], fabs(exact[i]));
    }
    bough_arena_destroy(b.arena);
    return fmax(error[0] / size[0], error[1] / size[1]);
}

static void steps(int k, double q[6]) {
    static const double force[3] = {1, -0.5, 0.3}, moment[3] = {0.4, 0.7, 2};
    for (int c = 0; c < 3; c++) q[c] = force[c] * cos(1 + k * (c + 1));
    for (int c = 0; c < 3; c++) q[3 + c] = moment[c] * cos(2 + k * (c + 2));
}

static void near_tip(int k, double q[6]) {
    const double values[6] = {k == 1, 0.2 * (k == 1), 0, 0, 0, 0};
    memcpy(q, values, sizeof values);
}

static void twisting(int k, double q[6]) {
    const double values[6] = {0, 0, 0, 0, 0, k >= 0};
    memcpy(q, values, sizeof values);
}

TEST(statics_is_exact_under_uniform_loads_on_segments) {
    line_load each = {.n = 12, .value = steps}, whole = {.n = 1, .at = {0, 1}, .value = twisting};
    for (int k = 0; k <= 12; k++) each.at[k] = k / 12.;
    assert_true(error_of(12, &whole) < 1e-6);
    assert_true(error_of(12, &each) < 1e-6);
}

// 61 to 61.5 m is a part of the last segment, whose stiffness falls by a factor.
TEST(statics_is_exact_under_loads_on_parts_of_segments) {
    const line_load parts = {.n = 7, .at = {0, 0.137, 0.4, 0.41, 0.531, 0.985, 0.996, 1}, .value = steps};
    const line_load tip = {.n = 2, .at = {0, 61 / 61.5, 1}, .value = near_tip};
    assert_true(error_of(12, &parts) < 1e-6);
    assert_true(error_of(40, &tip) < 1e-6);
}

// A linear load is the same load in pieces, and a force at a point that on a short piece.
static void check_pieces(const blade *b, bool follower, double piece, const bough_rod_reach *reach) {
    static const double start[6] = {1, -0.5, 0.3, 0.4, 0.7, 2}, end[6] = {-2, 1, 0.7, 0.2, -1, 0.5};
    const bough_rod_model *m = b->model;
    const bough_schedule always = {.start = 0};
    int pieces = (int)ceil((reach->to - reach->from) / piece);
    bough_rod_loads loads;
    bough_rod_loads_init(&loads, b->arena, m);
    bough_rod_ramped_load *whole = bough_rod_loads_add(&loads, b->arena, m, follower, &always);
    bough_rod_ramped_load *sum = bough_rod_loads_add(&loads, b->arena, m, follower, &always);
    bough_rod_lump(m, *reach, start, end, whole);
    for (int k = 0; k < pieces; k++) {
        double low[6], high[6], x = 1. * k / pieces, y = 1. * (k + 1) / pieces;
        for (int c = 0; c < 6; c++) {
            low[c] = start[c] + x * (end[c] - start[c]);
            high[c] = start[c] + y * (end[c] - start[c]);
        }
        double length = reach->to - reach->from;
        bough_rod_reach at = {reach->from + x * length, reach->from + y * length};
        bough_rod_lump(m, at, low, high, sum);
    }
    for (int c = 0; c < 6; c++) {
        for (int i = 0; i <= m->n; i++) {
            int k = c * m->stride + i;
            check_near(sum->value[k], whole->value[k], 1e-6, 1e-6);
            check_near(sum->line[k], whole->line[k], 1e-9, 1e-9);
            check_near(sum->line[6 * m->stride + k], whole->line[6 * m->stride + k], 1e-9, 1e-9);
        }
    }
}

TEST(a_linear_load_is_that_load_in_pieces) {
    const blade b = blade_with(12);
    const bough_rod_reach all = {0, 61.5}, part = {3.1, 60.7};
    for (int follower = 0; follower < 2; follower++) {
        check_pieces(&b, follower == 1, 0.5, &all);
        check_pieces(&b, follower == 1, 0.7, &part);
    }
    bough_arena_destroy(b.arena);
}
