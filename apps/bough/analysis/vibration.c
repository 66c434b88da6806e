#include "apps/bough/analysis/vibration.h"

#include "apps/bough/analysis/aeroelastic.h"
#include "apps/bough/analysis/mode_shape.h"
#include "apps/bough/analysis/steady.h"
#include "cosim/analysis/modes.h"

#include <string.h>

// Eigenvalues are sought about this point of the real axis, and several times the spin [1/s].
static const double least_point = 1, spins = 4;

// |λ| below this share of the point is a free motion: its double zero comes out as the square root
// of the rounding.
static const double free_motion = 1e-3;

enum { FREE_MOTIONS = 8 }; // that may be found before the modes

static const double rounding = 1e-10; // damping ratios below it are none

static void set_value(const bough_eigen_pair *pair, bough_scene_mode *mode) {
    double modulus = hypot(pair->real, pair->imaginary);
    double ratio = -pair->real / modulus;
    mode->growth = pair->real;
    mode->frequency = modulus / (2 * BOUGH_PI);
    mode->damped_frequency = pair->imaginary / (2 * BOUGH_PI);
    mode->damping = fabs(ratio) > rounding ? ratio : 0;
    mode->residual = pair->residual;
}

static const double at_rest = 1e-9; // [rad/s]

// Whether something turns otherwise than a rotor whose blades allow the transform.
static bool is_frozen(const bough_simulation *s, const bough_blade_group *group) {
    bough_vec3 spin = {0, 0, 0};
    if (group->n > 0) {
        const bough_frame *rotor = &s->tree->bodies[s->scene->turbine.rotor];
        spin = bough_tree_frame_velocity(s->view, rotor).angular;
    }
    for (int i = 0; i < s->tree->n_links; i++) {
        bough_transform pose = s->view->pose[i];
        bough_vec3 w = bough_mat3_mul(pose.rotation, s->view->twist[i].angular);
        double other = bough_norm(bough_sub(w, spin));
        if (fmin(bough_norm(w), other) > at_rest) return true;
    }
    return false;
}

// Data of a solution.
typedef struct solution {
    bough_whole *coupled;
    bough_blade_group group;
    double *state; // (n_state)
    double *mean;  // (n_state) work
    int *held;     // rows of prescribed joints
    bough_modes_def def;
} solution;

static bough_status prepare(bough_arena *arena, bough_simulation *s, solution *x) {
    const bough_assembly *a = s->master->assembly;
    bough_arena_each(arena, (size_t)a->n_state + 1, &x->state, &x->mean);
    x->held = bough_arena_take(arena, ((size_t)s->leader.system.n_state + 1) * sizeof *x->held);
    bough_assembly_states(a, x->state);
    x->coupled = bough_whole_create(arena, a, NULL);
    int n_held = bough_equilibrium_held(s->tree, false, x->held);
    bough_whole_hold(arena, x->coupled, n_held, x->held);
    return bough_blade_group_find(arena, s, a, &x->group);
}

// Inputs of the equilibrium as it is, so that the rotor's whole weight and thrust are on the tree;
// the blades bend in their mean.
static void define(double time, solution *x) {
    const bough_blade_group *g = &x->group;
    bough_whole_inputs(x->coupled, time, x->state);
    x->def = (bough_modes_def){.time = time,
                               .state = x->state,
                               .input = x->coupled->input,
                               .point = least_point,
                               .n_part = g->n,
                               .n_row = g->n_row,
                               .row = g->row};
    if (g->n == 0 || fabs(g->speed) < at_rest) return;
    bough_blade_group_average(g, x->coupled->input, x->mean, x->state);
    x->def.spin = g->speed;
    x->def.point = fmax(least_point, spins * ((g->n - 1) / 2) * fabs(g->speed));
}

static bough_status describe(bough_arena *arena, const bough_simulation *s, const solution *x,
                             bough_vibration *v) {
    bough_mode_shape one = {
        .simulation = s, .assembly = s->master->assembly, .group = &x->group, .state = x->state};
    v->n_row = bough_mode_shape_rows(s);
    bough_mode_shape_take(arena, &one);
    for (int k = 0; k < v->found; k++) {
        one.pair = &v->pair[k];
        bough_mode_shape_set(&one);
        bough_scene_mode *mode = &v->mode[k];
        mode->share = bough_arena_doubles(arena, (size_t)s->scene->n_body);
        set_value(&v->pair[k], mode);
        bough_mode_share_set(&one, mode);
        if (!s->scene->modes.shapes) continue;
        mode->shape = bough_arena_take(arena, (size_t)v->n_row * sizeof *mode->shape);
        bough_mode_shape_move(&one, mode->shape);
    }
    return bough_ok();
}

// Violations of closures decay at a rate of their own, which is no motion of the scene.
static bool is_closure(const bough_tree *tree, const bough_eigen_pair *pair) {
    double rate = 1 / tree->closure_time;
    return tree->n_closures > 0 && hypot(pair->real + rate, pair->imaginary) < 1e-3 * rate;
}

static void drop_other_motions(const bough_tree *tree, double point, int count, bough_vibration *v) {
    int kept = 0;
    for (int k = 0; k < v->count.found && kept < count; k++) {
        double modulus = hypot(v->pair[k].real, v->pair[k].imaginary);
        bool moves = modulus > free_motion * point && !is_closure(tree, &v->pair[k]);
        if (moves) v->pair[kept++] = v->pair[k];
    }
    v->found = kept;
}

// Modes of the bodies; the forces of the air do not follow.
static bough_status solve_bodies(bough_arena *arena, const bough_simulation *s, const solution *x, int count,
                                 bough_vibration *v) {
    v->count.wanted = count + FREE_MOTIONS + 2 * s->tree->closure_rank;
    v->pair = bough_arena_take(arena, (size_t)v->count.wanted * sizeof *v->pair);
    return bough_modes_find(arena, x->coupled, &x->def, v->pair, &v->count);
}

// Modes in the air whose forces follow the bodies' motion.
static bough_status solve_in_air(bough_arena *arena, bough_simulation *s, const solution *x, int count,
                                 bough_vibration *v) {
    bough_air_tangent air;
    bool dynamic = s->scene->modes.air == BOUGH_SCENE_AIR_DYNAMIC;
    BOUGH_TRY(bough_air_tangent_find(arena, s, x->coupled, x->def.time, x->state, dynamic, NULL, &air));
    bough_air_tangent_average(arena, s, &x->group, &air);
    bough_aeroelastic system = {s, x->coupled, &x->def, &x->group, &air};
    v->count.wanted = count + FREE_MOTIONS;
    v->pair = bough_arena_take(arena, (size_t)v->count.wanted * sizeof *v->pair);
    return bough_aeroelastic_modes(arena, &system, v->pair, &v->count, &v->unpaired);
}

static bough_status solve(bough_arena *arena, bough_simulation *s, double time, int count,
                          bough_vibration *v) {
    solution x = {0};
    v->mode = bough_arena_take(arena, (size_t)count * sizeof *v->mode);
    BOUGH_TRY(prepare(arena, s, &x));
    define(time, &x);
    v->n_blade = x.group.n;
    v->spin = fabs(x.group.speed) < at_rest ? 0 : x.group.speed;
    v->frozen = is_frozen(s, &x.group);
    bool in_air = s->aero && s->scene->modes.air != BOUGH_SCENE_AIR_FROZEN;
    bough_status status =
        in_air ? solve_in_air(arena, s, &x, count, v) : solve_bodies(arena, s, &x, count, v);
    if (!bough_is_ok(&status)) return status;
    drop_other_motions(s->tree, x.def.point, count, v);
    return describe(arena, s, &x, v);
}

bool bough_vibration_wanted(const bough_simulation *s) {
    const bough_scene_modes *modes = &s->scene->modes;
    if (modes->of != BOUGH_SCENE_MODES_AUTO) return modes->of == BOUGH_SCENE_MODES_SCENE;
    bool axis = modes->axis[0] != 0 || modes->axis[1] != 0 || modes->axis[2] != 0;
    bool reduced = bough_steady_rods(s) < s->n_rod; // a modal body has modes in the whole scene only
    return (!bough_rods_are_independent(s) || reduced) && modes->speed == 0 && !axis;
}

bough_status bough_vibration_find(bough_arena *arena, bough_simulation *s, int count,
                                  bough_vibration *vibration) {
    bool balanced = s->scene->modes.at == BOUGH_SCENE_IN_EQUILIBRIUM;
    double time = balanced ? bough_equilibrium_time(s) : 0;
    *vibration = (bough_vibration){.asked = count};
    bough_status status = bough_ok();
    if (balanced) status = bough_simulation_equilibrium(s, s->master->assembly, time, &vibration->work);
    return bough_is_ok(&status) ? solve(arena, s, time, count, vibration) : status;
}
