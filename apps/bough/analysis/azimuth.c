// theory (113).
#include "apps/bough/analysis/azimuth.h"

#include "apps/bough/model/companion.h"

#include <complex.h>

static const double at_rest = 1e-9;    // [rad/s]
static const double difference = 1e-5; // of the largest entry of a vector in units of its scale

static const double complex imaginary = (double complex)I;

enum { AZIMUTHS = 4 };

// -- the azimuths ---------------------------------------------------------------------------------

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
