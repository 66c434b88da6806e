// theory (74), (113), (123).
#include "apps/bough/analysis/azimuth.h"

#include "apps/bough/model/companion.h"
#include "core/tree/dynamics.h"

#include <complex.h>

static const double at_rest = 1e-9; // [rad/s]

// -- the point of the modes -----------------------------------------------------------------------

// Eigenvalues are sought about this point of the real axis, and several times the spin [1/s].
static const double least_point = 1, spins = 4;

// A larger relative change of the solutions of the linear system is no rounding. Beside equal blades, whose
// deflection is their mean, a larger one is allowed: the tower of a turbine under its thrust causes 1.5e-4.
static const double constant = 1e-5, even = 1e-3;

static bough_status prepare(bough_arena *arena, bough_simulation *s, bough_vibration_point *x) {
    const bough_assembly *a = s->assembly;
    bough_arena_each(arena, (size_t)a->n_state + 1, &x->state, &x->mean);
    x->held = bough_arena_take(arena, ((size_t)s->leader.system.n_state + 1) * sizeof *x->held);
    bough_assembly_states(a, x->state);
    x->whole = bough_whole_create(arena, a, NULL);
    x->n_held = bough_equilibrium_held(s->tree, false, x->held);
    bough_whole_hold(arena, x->whole, x->n_held, x->held);
    return bough_blade_group_find(arena, s, &x->group);
}

// Converts the coordinates of the tree in a change of the state to or from speeds, which rotate with the
// bodies. In place; work: (n_q).
static void convert(const bough_tree *tree, const double *state, bool to_speeds, double *work, double *x) {
    memset(work, 0, (size_t)tree->n_q * sizeof *work);
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        int at = link->first_coordinate;
        if (to_speeds)
            bough_joint_speed(&link->joint, state + at, x + at, work + at);
        else
            bough_joint_rate(&link->joint, state + at, x + at, work + at);
    }
    memcpy(x, work, (size_t)tree->n_q * sizeof *x);
}

// The angular speed of the fastest joint [rad/s].
static double fastest_joint(const bough_simulation *s) {
    double fastest = 0;
    for (int i = 0; i < s->tree->n_links; i++)
        fastest = fmax(fastest, bough_norm(s->view->joint_twist[i].angular));
    return fastest;
}

// Advances all joints for a time at their speeds.
static void advance(const bough_tree *tree, double time, double *rate, double *state) {
    bough_tree_coordinate_rate(tree, state, rate);
    for (int k = 0; k < tree->n_q; k++) state[k] += time * rate[k];
    for (int i = 0; i < tree->n_links; i++)
        bough_joint_normalise(&tree->links[i].joint, state + tree->links[i].first_coordinate);
}

// theory (123): N dN⁺/dt of the coordinates, where it is not 0, by a difference in time.
static void define_axes(bough_arena *arena, const bough_simulation *s, bough_vibration_point *x) {
    static const double angle = 1e-5; // [rad]
    const bough_tree *tree = s->tree;
    double fastest = fastest_joint(s), largest = 0;
    if (fastest < at_rest) return;
    size_t n = (size_t)tree->n_q, size = (size_t)s->assembly->n_state;
    double *side[2], *change[2], *work, *axes = bough_arena_doubles(arena, n * n);
    bough_arena_each(arena, size, &side[0], &side[1], &work);
    bough_arena_each(arena, n, &change[0], &change[1]);
    for (int k = 0; k < 2; k++) {
        memcpy(side[k], x->state, size * sizeof(double));
        advance(tree, (2 * k - 1) * angle / fastest, work, side[k]);
    }
    for (size_t j = 0; j < n; j++) {
        double *column = axes + j * n;
        for (int k = 0; k < 2; k++) {
            memset(change[k], 0, n * sizeof(double));
            change[k][j] = 1;
            convert(tree, side[k], true, work, change[k]);
        }
        for (size_t i = 0; i < n; i++) {
            column[i] = (change[1][i] - change[0][i]) * fastest / (2 * angle);
            largest = fmax(largest, fabs(column[i]));
        }
        convert(tree, x->state, false, work, column);
    }
    if (largest < at_rest) return;
    x->def.n_axes = tree->n_q;
    x->def.axes = axes;
    x->def.point = fmax(x->def.point, spins * fastest);
}

// Inputs of the true equilibrium, so that weight and thrust of the whole rotor are on the tree; the blades
// have their mean deflection.
static void define(double time, bough_vibration_point *x) {
    const bough_blade_group *g = &x->group;
    bough_whole_inputs(x->whole, time, x->state);
    x->def = (bough_modes_def){.time = time,
                               .state = x->state,
                               .input = x->whole->input,
                               .point = least_point,
                               .n_part = g->n,
                               .n_row = g->n_row,
                               .row = g->row};
    if (g->n == 0 || fabs(g->speed) < at_rest) return;
    bough_blade_group_average(g, x->whole->input, x->mean, x->state);
    x->def.spin = g->speed;
    x->def.point = fmax(least_point, spins * ((g->n - 1) / 2) * fabs(g->speed));
}

// Advances all joints at their speeds, the fastest by `angle`.
static void move_on(const bough_tree *tree, double fastest, double angle, double *rate, double *state) {
    enum { STEPS = 200 };
    for (int step = 0; step < STEPS; step++) advance(tree, angle / fastest / STEPS, rate, state);
}

// (I − γJ)⁻¹ of a vector with all motions in it, those of equal blades alike.
static bough_status respond(const bough_simulation *s, const bough_vibration_point *x, double time,
                            double gamma, const double *state, double *work, double *response) {
    const bough_assembly *a = s->assembly;
    const bough_blade_group *g = &x->group;
    bough_assembly_scales(a, response);
    for (int k = 0; k < a->n_state; k++) response[k] *= 1 + 0.5 * sin(k);
    for (int k = 1; k < g->n; k++)
        memcpy(response + g->first[k], response + g->first[0], (size_t)g->n_row * sizeof *response);
    convert(s->tree, state, false, work, response);
    bough_whole_project(x->whole, state, response);
    bough_whole_inputs(x->whole, time, state);
    BOUGH_TRY(bough_whole_setup(x->whole, time, state, x->whole->input, gamma));
    bough_whole_solve(x->whole, response);
    bough_whole_project(x->whole, state, response);
    convert(s->tree, state, true, work, response);
    return bough_ok();
}

// Compares the linear system at the present state with those after rotation by two angles, by its solutions
// about a point of the real axis [1/s]: the largest relative change. They differ if a rotor of two blades, or
// an unbalanced one, is on a flexible support. With equal blades, which exchange their parts, those of the
// other bodies are compared.
static bough_status find_change(bough_arena *arena, const bough_simulation *s, const bough_vibration_point *x,
                                double point, double *largest) {
    static const double angles[] = {1, 2.3};
    const bough_assembly *a = s->assembly;
    size_t n = (size_t)a->n_state;
    double *state, *work, *present, *turned, *scale, *input, fastest = fastest_joint(s);
    *largest = 0;
    if (fastest < at_rest) return bough_ok();
    bough_arena_each(arena, n + 1, &state, &work, &present, &turned, &scale);
    input = bough_arena_copy(arena, x->whole->input, (size_t)a->n_input * sizeof *input);
    bough_assembly_scales(a, scale);
    for (int k = 0; k < x->group.n * x->group.n_row; k++) scale[x->group.row[k]] = HUGE_VAL;
    bool driven = false; // by given motions, which go on with time
    for (int i = 0; i < s->tree->n_links; i++) {
        double speed = bough_norm(s->view->joint_twist[i].angular);
        driven = driven || (s->tree->links[i].motion != NULL && speed > at_rest);
    }
    BOUGH_TRY(respond(s, x, x->def.time, 1 / point, x->state, work, present));
    for (int k = 0; k < 2; k++) {
        double time = x->def.time + (driven ? angles[k] / fastest : 0), change = 0, size = 0;
        memcpy(state, x->state, n * sizeof *state);
        move_on(s->tree, fastest, angles[k], work, state);
        BOUGH_TRY(respond(s, x, time, 1 / point, state, work, turned));
        for (size_t i = 0; i < n; i++) {
            change = fmax(change, fabs(turned[i] - present[i]) / scale[i]);
            size = fmax(size, fabs(present[i]) / scale[i]);
        }
        *largest = fmax(*largest, change / size);
    }
    bough_whole_inputs(x->whole, x->def.time,
                       x->state); // the motion of the bodies is that of the state again
    memcpy(x->whole->input, input, (size_t)a->n_input * sizeof *input);
    return bough_ok();
}

static bool is_constant(const bough_vibration_point *x, double change) {
    return change <= (x->group.n > 0 ? even : constant);
}

bough_status bough_vibration_check_constant(bough_arena *arena, const bough_simulation *s,
                                            const bough_vibration_point *x, double point) {
    double change;
    if (s->scene->modes.linear) return bough_ok();
    BOUGH_TRY(find_change(arena, s, x, point, &change));
    if (is_constant(x, change)) return bough_ok();
    return bough_fail(
        BOUGH_INVALID,
        "%.200s: the linear system changes by %.2g of itself as the bodies turn (a rotor with two or unequal blades, with blades on hinges, with springs or other moving bodies on it, or out of balance): its solutions are periodic (Floquet) and not computed; take 'modes.linear: true' for the system at the present azimuth, or modes at rest",
        s->scene->file, change);
}

// Uses the present azimuth, with the deflection of each blade there.
static void leave_transform(const bough_simulation *s, bough_vibration_point *x) {
    x->group.n = x->group.n_row = x->def.n_part = x->def.n_row = 0;
    x->def.spin = 0;
    bough_assembly_states(s->assembly, x->state);
    bough_whole_inputs(x->whole, x->def.time, x->state);
}

bough_status bough_vibration_point_find(bough_arena *arena, bough_simulation *s, double time,
                                        bough_vibration_point *point) {
    *point = (bough_vibration_point){0};
    BOUGH_TRY(prepare(arena, s, point));
    define(time, point);
    define_axes(arena, s, point);
    if (!s->scene->modes.linear || point->def.spin == 0) return bough_ok();
    double change;
    BOUGH_TRY(find_change(arena, s, point, point->def.point, &change));
    if (!is_constant(point, change)) leave_transform(s, point);
    return bough_ok();
}

// -- the azimuths ---------------------------------------------------------------------------------

static const double difference = 1e-5; // of the largest entry of a vector in units of its scale

static const double complex imaginary = (double complex)I;

enum { AZIMUTHS = 4 };

// C_kl = (1/n) Σ_h exp(i h (2π(k − l)/n + turn)), |h| <= (n − 1)/2; what alternates from blade to blade
// stays.
static double *blend_of(bough_arena *arena, int n, double turn) {
    double *c = bough_arena_doubles(arena, (size_t)(n * n));
    for (int k = 0; k < n; k++) {
        for (int l = 0; l < n; l++) {
            double sum = n % 2 == 0 ? 1 + cos(BOUGH_PI * (k - l)) : 1;
            for (int h = 1; h <= (n - 1) / 2; h++) sum += 2 * cos(h * (2 * BOUGH_PI * (k - l) / n + turn));
            c[k * n + l] = sum / n;
        }
    }
    return c;
}

// A copy of the scene whose rotor starts at a greater angle.
static bough_scene *turned_scene(bough_arena *arena, const bough_simulation *s, double turn) {
    bough_scene *to = bough_coarser_scene_beside(arena, s, 0);
    bough_scene_joint *joint = &to->body[to->turbine.rotor].joint;
    bough_motion_def *motion = &joint->motion[0].def;
    joint->coordinates[0] += turn;
    if (!motion->given || motion->speed) return to;
    motion->from += turn;
    motion->to += turn;
    double *values = bough_arena_copy(arena, motion->values, (size_t)motion->n * sizeof *values);
    for (int i = 0; i < motion->n; i++) values[i] += turn;
    motion->values = values;
    return to;
}

// Starts from the state at the scene's azimuth, with the deflections of the blades that an observer at rest
// sees there, which is near the equilibrium.
static void begin(const bough_azimuths *a, bough_azimuth *x, double time, double *state) {
    const bough_simulation *s = a->at[0].simulation;
    int azimuth, speed;
    bough_assembly_states(s->assembly, state);
    bough_air_mean_blend(x->blend, false, a->group->n, a->group->n_row, a->group->row, state);
    for (int k = 0; k < a->group->n; k++) { // quaternions of length 1
        const bough_system *system = &s->rod[a->group->blade[k]->port].system;
        if (system->ops->constrain) system->ops->constrain(system->self, time, state + a->group->first[k]);
    }
    bough_tree_joint_rows(s->tree, s->scene->turbine.rotor, &azimuth, &speed);
    state[azimuth] += x->turn;
    bough_equilibrium_set_state(x->simulation, time, state);
}

static bough_status turn_on(bough_arena *arena, const bough_azimuths *a, double time, bough_azimuth *x) {
    const bough_simulation *s = a->at[0].simulation;
    BOUGH_TRY(
        bough_simulation_build_on(arena, turned_scene(arena, s, x->turn), s->pool, NULL, &x->simulation));
    begin(a, x, time, bough_arena_doubles(arena, (size_t)s->assembly->n_state));
    if (s->scene->modes.at == BOUGH_SCENE_IN_EQUILIBRIUM) {
        bough_status status = bough_simulation_equilibrium(x->simulation, time, BOUGH_EQUILIBRIUM_NEAR, NULL);
        if (!bough_is_ok(&status))
            return bough_fail(status.code, "with the rotor turned further by %.3g degrees: %.380s",
                              x->turn / BOUGH_DEGREE, status.message);
    }
    return bough_vibration_point_find(arena, x->simulation, time, &x->point);
}

// Sets the blades to their mean shape, in which their loads differ little.
static void set_mean(const bough_azimuths *a, double *state) {
    const bough_blade_group *g = a->group;
    for (int j = 0; j < g->n * g->n_row; j++) {
        double sum = 0;
        for (int k = 0; k < a->n; k++) sum += a->at[k].point.state[g->row[j]];
        state[g->row[j]] = sum / a->n;
    }
}

bough_status bough_azimuths_find(bough_arena *arena, bough_simulation *s, double time,
                                 bough_vibration_point *point, bough_azimuths *a) {
    int n = point->group.n;
    *a = (bough_azimuths){
        .n = n > 0 && n <= BOUGH_MOST_BLADES && fabs(point->group.speed) > at_rest ? AZIMUTHS : 1,
        .group = &point->group};
    a->at = bough_arena_take(arena, (size_t)a->n * sizeof *a->at);
    for (int k = 0; k < a->n; k++) {
        bough_azimuth *x = &a->at[k];
        x->turn = n > 0 ? 2 * BOUGH_PI / n * k / a->n : 0;
        x->blend = blend_of(arena, n, x->turn);
        if (k == 0)
            *x = (bough_azimuth){x->turn, s, *point, x->blend};
        else
            BOUGH_TRY(turn_on(arena, a, time, x));
    }
    a->at[0].point.state =
        bough_arena_copy(arena, point->state, (size_t)s->assembly->n_state * sizeof(double));
    if (a->n > 1) set_mean(a, point->state);
    return bough_ok();
}

// -- the mean tangent -----------------------------------------------------------------------------

bough_air_azimuth bough_azimuths_air(const bough_azimuths *a, int k) {
    const bough_azimuth *x = &a->at[k];
    const bough_vibration_point *p = &x->point;
    return (bough_air_azimuth){.simulation = x->simulation,
                               .whole = p->whole,
                               .time = p->def.time,
                               .state = p->state,
                               .group = &p->group,
                               .first = a->at[0].simulation,
                               .parts = a->group,
                               .blend = x->blend,
                               .share = 1. / a->n};
}

bough_status bough_azimuths_tangent(bough_arena *arena, const bough_azimuths *a, bough_air_tangent *mean) {
    bough_air_azimuth of;
    *mean = (bough_air_tangent){0};
    for (int k = 0; k < a->n; k++) {
        of = bough_azimuths_air(a, k);
        BOUGH_TRY(bough_air_tangent_add(arena, &of, NULL, mean));
    }
    bough_air_tangent_close(arena, &of, mean);
    return bough_ok();
}

// -- changes with the azimuth ---------------------------------------------------------------------

// yᵀ A x/(yᵀ x) of an eigenvector; scale (all), image: work.
static bough_status quotient(bough_air_change *air, size_t all, const bough_mode_vectors *v,
                             const double *scale, double *image, double complex *value) {
    double complex length = 0, sum = 0;
    for (size_t part = 0; part < 2; part++) {
        const double *right = v->right + part * all;
        double complex unit = part == 0 ? 1 : imaginary;
        double largest = bough_largest((int)all, right, scale);
        if (largest == 0) continue;
        BOUGH_TRY(bough_air_change_follow(air, difference / largest, true, right, image));
        for (size_t i = 0; i < all; i++) {
            double complex left = v->left[i] + imaginary * v->left[all + i];
            length += unit * left * right[i];
            sum += unit * left * image[i];
        }
    }
    *value = sum / length;
    return bough_ok();
}

static bough_status find_quotients(bough_arena *arena, const bough_azimuths *a, int k, int n,
                                   const bough_mode_vectors *vector, double complex *value) {
    const bough_assembly *assembly = a->at[k].simulation->assembly;
    bough_air_azimuth of = bough_azimuths_air(a, k);
    int n_air;
    bough_air_change *air = bough_air_change_create(arena, &of, &n_air);
    size_t n_state = (size_t)assembly->n_state, all = n_state + (size_t)n_air;
    double *scale, *image;
    bough_arena_each(arena, all, &scale, &image);
    bough_assembly_scales(assembly, scale);
    for (size_t i = n_state; i < all; i++) scale[i] = 1;
    for (int i = 0; i < n; i++) {
        value[i] = (double)NAN;
        if (vector[i].left) BOUGH_TRY(quotient(air, all, &vector[i], scale, image, &value[i]));
    }
    return bough_ok();
}

bough_status bough_azimuths_change(bough_arena *arena, const bough_azimuths *a, int n,
                                   const bough_mode_vectors *vector, double complex *change) {
    for (int i = 0; i < a->n; i++) {
        bough_arena *own = bough_arena_child(arena);
        bough_status status = find_quotients(own, a, i, n, vector, change + i * n);
        bough_arena_destroy(own);
        if (!bough_is_ok(&status)) return status;
    }
    // from their mean
    for (int k = 0; k < n; k++) {
        double complex mean = 0;
        for (int i = 0; i < a->n; i++) mean += change[i * n + k] / a->n;
        for (int i = 0; i < a->n; i++) change[i * n + k] -= mean;
    }
    return bough_ok();
}
