// Every integrator of the table on every kind of system: a tree, a rod, a modal body, a mass, and an
// assembly as a whole. Each goes where a far tighter run goes, keeps the contract of members, counts its
// work, and says so before where it does not suit.
#include "tests/unit/contract.h"
#include "tests/unit/rigid_tree.h"
#include "tests/unit/sample_rod.h"
#include "tests/unit/two_mass.h"

#include "cosim/whole.h"
#include "flexbody/modal/modal_system.h"
#include "flexbody/rod/rod_system.h"

enum { SEGMENTS = 3, LONG = 31, MOST_STATES = 13 * LONG };

static const double swaying[BOUGH_ROD_INPUTS] = {0.4, -0.3, 0.7, 0.5, -0.8, 0.6, 1, -2, -9};
static const double length = 0.02; // of a run [s]

typedef struct specimen {
    const char *what;
    bough_system system;
    const double *input;
} specimen;

static bough_system make_rod(bough_arena *arena, int segments) {
    bough_rod_body *body = bough_rod_body_create(arena, sample_general(arena, segments), swaying);
    return bough_rod_body_system(body);
}

static bough_system make_modal(bough_arena *arena) {
    bough_rod_def def = sample_def(SEGMENTS, sample_general_arrays(arena, SEGMENTS), false);
    bough_modal_model *model = NULL;
    bough_modal_options options = {4, false, false};
    check_ok(bough_modal_create(arena, &def, 1, options, &model));
    return bough_modal_body_system(bough_modal_body_create(arena, model, swaying));
}

// Two masses on springs as one system.
static bough_system make_assembly(bough_two_mass *m) {
    *m = bough_two_mass_default();
    bough_master_def def = bough_master_def_default();
    def.macro_step = def.duration = length;
    check_ok(bough_two_mass_build(check_memory(), m, def));
    return bough_whole_system(m->arena, m->master->assembly, NULL, "assembly");
}

static void run(bough_member *m, const double *input, double t1) {
    double *coefficient = contract_doubles(4 * m->system.n_input);
    memcpy(coefficient, input, (size_t)m->system.n_input * sizeof *coefficient);
    bough_signal signal = {m->system.n_input, m->time, t1, coefficient};
    check_ok(bough_member_advance(m, t1, &signal, false));
    free(coefficient);
}

static double distance(const bough_member *a, const double *expected) {
    double worst = 0;
    for (int k = 0; k < a->system.n_state; k++) {
        worst = fmax(worst, fabs(a->state[k] - expected[k]) / a->system.scale[k]);
    }
    return worst;
}

// Whether the method suits the system.
static bool check_method(bough_arena *arena, const specimen *x, bough_integrator_kind kind,
                         const double *expected) {
    bough_integrator_options options = {.kind = kind, .rtol = 1e-6, .step = 1e-4, .rho = 0.8};
    const bough_integrator_ops *ops = bough_integrator_find(kind);
    bough_member *m = bough_arena_take(arena, sizeof *m);
    bough_status status = bough_member_create(arena, &x->system, 0, &options, m);
    if (ops->most_states > 0 && x->system.n_state > ops->most_states) {
        assert_int_equal(status.code, BOUGH_INVALID);
        assert_non_null(strstr(status.message, ops->title));
        return false;
    }
    if (!bough_is_ok(&status)) fail_msg("%s, %s: %s", x->what, ops->name, status.message);
    run(m, x->input, length / 2);
    run(m, x->input, length);
    if (!(distance(m, expected) < 2e-4)) {
        fail_msg("%s, %s: %g off", x->what, ops->name, distance(m, expected));
    }
    bough_statistics work = bough_member_statistics(m);
    assert_true(work.steps > 0 && work.derivatives > 0 && work.jacobians > 0);
    contract_point at = {0, x->system.initial, x->input, 1e-5};
    contract_save_restore(m, at, length / 4, true);
    contract_save_restore(m, at, length / 4, false);
    return true;
}

// How many methods suit it.
static int check_system(bough_arena *arena, const specimen *x) {
    bough_integrator_options tight = {.kind = BOUGH_CVODE_BDF, .rtol = 1e-10};
    bough_member *exact = member_of(arena, &x->system, tight);
    run(exact, x->input, length);
    int suit = 0;
    for (int kind = 0; bough_integrator_name(kind) != NULL; kind++) {
        suit += check_method(arena, x, (bough_integrator_kind)kind, exact->state);
    }
    return suit;
}

TEST(every_method_integrates_every_system) {
    check_arena(arena);
    fixture tree = everything(1e-6);
    bough_two_mass assembly;
    bough_oscillator mass = bough_oscillator_motion_in((bough_spring_mass){1, 20, .3}, 10, .5, .2);
    const double motion[2] = {0.3, -0.1};
    const specimen specimens[] = {
        {"tree", tree.s, some_input},
        {"rod", make_rod(arena, SEGMENTS), swaying},
        {"long rod", make_rod(arena, LONG), swaying}, // too long for Radau
        {"modal body", make_modal(arena), swaying},
        {"mass", bough_oscillator_system(&mass, "mass"), motion},
        {"assembly", make_assembly(&assembly), NULL},
    };
    static const double none[1] = {0};
    for (size_t k = 0; k < sizeof specimens / sizeof *specimens; k++) {
        specimen x = specimens[k];
        if (x.input == NULL) x.input = none;
        assert_true(x.system.n_state > 0 && x.system.n_state <= MOST_STATES);
        assert_int_equal(check_system(arena, &x), x.system.n_state == MOST_STATES ? 6 : 7);
    }
}

TEST(every_system_keeps_the_contract) {
    bough_two_mass assembly;
    bough_system s = make_assembly(&assembly);
    const double none[1] = {0};
    contract_check_system(&s, (contract_point){0, s.initial, none, 1e-5}, 0.05);
}
