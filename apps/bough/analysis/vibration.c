#include "apps/bough/analysis/vibration.h"

#include "apps/bough/analysis/aeroelastic.h"
#include "apps/bough/analysis/azimuth.h"
#include "apps/bough/analysis/steady.h"
#include "apps/bough/model/companion.h"

#include <complex.h>

// |λ| below this fraction of the point is a free motion: the numerical value of a double zero is the square
// root of the rounding.
static const double free_motion = 1e-3;

// A slower oscillation or growth, down to this fraction of the point, is a mode if it is found again, to
// within `same`, about another point: `below` times the first or, where something turns, `above` times. The
// |λ| of a free motion grows with the point.
static const double slowest = 1e-5, below = 0.1, above = 2, same = 0.01;

enum { FREE_MOTIONS = 8 }; // that may be found before the modes

// Rounding in the solutions grows with the fourth power of |λ| over the point. If the residual of an
// eigenvector exceeds `exact`, the point moves to the lowest eigenvalue, if that is at least `nearer` times
// as far. A real λ within `beside` of the point hides the others; the point is then multiplied by `aside`.
static const double exact = 1e-9, nearer = 1.5, beside = 0.1, aside = 1.3;
enum { MOVES = 6 }; // of the point, most: the first values may be of rounding alone

static const double rounding = 1e-10; // damping ratios below it are none

static void set_value(const bough_eigen_pair *pair, const double change[2], bough_scene_mode *mode) {
    double modulus = hypot(pair->real, pair->imaginary);
    double ratio = -pair->real / modulus;
    mode->growth = pair->real;
    mode->frequency = modulus / (2 * BOUGH_PI);
    mode->damped_frequency = pair->imaginary / (2 * BOUGH_PI);
    mode->damping = fabs(ratio) > rounding ? ratio : 0;
    mode->residual = pair->residual;
    mode->frequency_change = change[0];
    mode->damping_change = change[1];
    mode->moved = (double)NAN;
}

static const double at_rest = 1e-9; // [rad/s]

// Whether something rotates while no multi-blade transform is used: the system is that of one azimuth.
static bool is_frozen(const bough_simulation *s, const bough_blade_group *group) {
    bool turns = false;
    for (int i = 0; i < s->tree->n_links; i++)
        turns = turns || bough_norm(s->view->twist[i].angular) > at_rest;
    return turns && group->n == 0;
}

// -- solution -------------------------------------------------------------------------------------

// Violations of closures decay at the rate of their stabilisation and are no motion of the scene.
static bool is_closure(const bough_tree *tree, const bough_eigen_pair *pair) {
    double rate = 1 / tree->closure_time;
    return tree->n_closures > 0 && hypot(pair->real + rate, pair->imaginary) < 1e-3 * rate;
}

static double modulus_of(const bough_eigen_pair *pair) { return hypot(pair->real, pair->imaginary); }

static bool oscillates(const bough_eigen_pair *pair) { return pair->imaginary > 0.5 * modulus_of(pair); }

// A decay without oscillation matters to nobody.
static bool may_be_slow(const bough_eigen_pair *pair, double point) {
    return modulus_of(pair) > slowest * point && (oscillates(pair) || pair->real > 0);
}

static bool is_mode(const bough_tree *tree, double point, const bough_vibration *v, int k) {
    bool slow = v->slow != NULL && v->slow[k];
    return (modulus_of(&v->pair[k]) > free_motion * point || slow) && !is_closure(tree, &v->pair[k]);
}

// Number of pairs up to that of the last wanted mode.
static int count_pairs(const bough_tree *tree, double point, int count, const bough_vibration *v) {
    int n = 0;
    for (int kept = 0; n < v->count.found && kept < count; n++) kept += is_mode(tree, point, v, n);
    return n;
}

static void drop_other_motions(const bough_tree *tree, double point, int count, bough_vibration *v) {
    int kept = 0, n = count_pairs(tree, point, count, v);
    for (int k = 0; k < n; k++) {
        if (!is_mode(tree, point, v, k)) continue;
        v->pair[kept] = v->pair[k];
        if (v->vector) v->vector[kept] = v->vector[k];
        memcpy(v->change[kept++], v->change[k], sizeof *v->change);
    }
    v->found = kept;
}

// Modes of the bodies; the forces of the air do not follow.
static bough_status solve_bodies(bough_arena *arena, const bough_simulation *s,
                                 const bough_vibration_point *x, int count, bough_vibration *v) {
    v->count.wanted = count + FREE_MOTIONS + 2 * s->tree->closure_rank;
    v->pair = bough_arena_take(arena, (size_t)v->count.wanted * sizeof *v->pair);
    return bough_modes_find(arena, x->whole, &x->def, v->pair, &v->count);
}

// The air about the state, as a mean over the azimuths.
typedef struct air_about {
    bool follows; // its forces follow the motion
    bool changes; // changes with the azimuth are wanted
    bough_azimuths azimuths;
    bough_air_tangent tangent;
} air_about;

static bough_status find_air(bough_arena *arena, bough_simulation *s, double time, bough_vibration_point *x,
                             air_about *air) {
    air->follows = bough_air_follows(s->scene);
    air->azimuths.n = 1;
    if (!air->follows) return bough_ok();
    BOUGH_TRY(bough_azimuths_find(arena, s, time, x, &air->azimuths));
    return bough_azimuths_tangent(arena, &air->azimuths, &air->tangent);
}

// The largest changes of frequency and damping ratio over the azimuths, change (azimuths × n).
static void set_changes(int n_azimuth, int n, const double complex *change, bough_vibration *v) {
    for (int k = 0; k < n; k++) {
        double complex mean = v->pair[k].real + v->pair[k].imaginary * (double complex)I;
        v->change[k][0] = v->change[k][1] = 0;
        for (int i = 0; i < n_azimuth; i++) {
            double complex value = mean + change[i * n + k];
            double longer = cabs(value) / cabs(mean) - 1;
            double damping = creal(value) / cabs(value) - creal(mean) / cabs(mean);
            v->change[k][0] = fmax(v->change[k][0], fabs(longer));
            v->change[k][1] = fmax(v->change[k][1], fabs(damping));
        }
        if (isnan(creal(change[k]))) v->change[k][0] = v->change[k][1] = (double)NAN;
    }
}

static bough_status solve_in_air(bough_arena *arena, bough_simulation *s, const bough_vibration_point *x,
                                 const air_about *air, int count, bough_vibration *v) {
    if (x->def.n_axes > 0)
        return bough_fail(BOUGH_INVALID,
                          "%.200s: modes in air that follows the motion are not computed where bodies turn "
                          "on free, spherical or planar joints: take 'modes.air: frozen'",
                          s->scene->file);
    int wanted = v->count.wanted = count + FREE_MOTIONS, azimuths = air->changes ? air->azimuths.n : 1;
    const bough_aeroelastic system = {s, x->whole, &x->def, &x->group, &air->tangent};
    v->pair = bough_arena_take(arena, (size_t)wanted * sizeof *v->pair);
    v->vector = azimuths > 1 ? bough_arena_take(arena, (size_t)wanted * sizeof *v->vector) : NULL;
    BOUGH_TRY(bough_aeroelastic_modes(arena, &system, v->pair, &v->count, v->vector, &v->unpaired));
    if (azimuths == 1) return bough_ok();
    int n = count_pairs(s->tree, x->def.point, count, v);
    double complex *change = bough_arena_take(arena, (size_t)(azimuths * wanted) * sizeof *change);
    BOUGH_TRY(bough_azimuths_change(arena, &air->azimuths, n, v->vector, change));
    set_changes(azimuths, n, change, v);
    return bough_ok();
}

static bough_status find_pairs(bough_arena *arena, bough_simulation *s, const bough_vibration_point *x,
                               const air_about *air, int count, bough_vibration *v) {
    return air->follows ? solve_in_air(arena, s, x, air, count, v) : solve_bodies(arena, s, x, count, v);
}

// Whether a motion is mainly the rotation of a free rotor of equal blades: by its own weight it has a slow
// one at each azimuth, and none in the mean.
static bool turns_rotor(const bough_simulation *s, const bough_blade_group *group,
                        const bough_eigen_pair *pair) {
    if (group->n == 0) return false;
    const bough_link *link = &s->tree->links[s->tree->bodies[s->scene->turbine.rotor].link];
    double largest = 0, part = 0;
    for (int k = 0; k < s->tree->n_q; k++) {
        double size = hypot(pair->shape_real[k], pair->shape_imag[k]);
        largest = fmax(largest, size);
        if (k >= link->first_coordinate && k < link->first_coordinate + link->n_coordinates)
            part = fmax(part, size);
    }
    return link->motion == NULL && part > 0.5 * largest;
}

// Finds which of the values near 0 are modes.
static bough_status find_slow(bough_arena *arena, bough_simulation *s, const bough_vibration_point *x,
                              const air_about *air, int count, bough_vibration *v) {
    double point = x->def.point;
    bough_vibration other = {0};
    bough_vibration_point there = *x;
    air_about alone = *air;
    alone.changes = false;
    bool doubtful = false, turns = x->def.spin != 0 || x->def.n_axes > 0;
    for (int k = 0; k < v->count.found; k++) {
        bool small = modulus_of(&v->pair[k]) <= free_motion * point;
        bool may = small && may_be_slow(&v->pair[k], point);
        doubtful = doubtful || (may && !turns_rotor(s, &x->group, &v->pair[k]));
    }
    if (!doubtful) return bough_ok();
    there.def.point *= turns ? above : below; // the series converges above
    BOUGH_TRY(find_pairs(arena, s, &there, &alone, count, &other));
    v->slow = bough_arena_take(arena, (size_t)v->count.found * sizeof *v->slow);
    for (int k = 0; k < v->count.found; k++) {
        const bough_eigen_pair *a = &v->pair[k];
        double size = modulus_of(a);
        bool may = may_be_slow(a, point) && !turns_rotor(s, &x->group, a);
        for (int i = 0; i < other.count.found && may; i++) {
            const bough_eigen_pair *b = &other.pair[i];
            double off = hypot(a->real - b->real, fabs(a->imaginary) - fabs(b->imaginary));
            v->slow[k] = v->slow[k] || off < same * size;
        }
    }
    return bough_ok();
}

// The eigenvalues about the point.
static bough_status solve_about(bough_arena *arena, bough_simulation *s, const bough_vibration_point *x,
                                const air_about *air, int count, bough_vibration *v) {
    size_t most = (size_t)(count + FREE_MOTIONS + 2 * s->tree->closure_rank);
    v->change = bough_arena_take(arena, most * sizeof *v->change);
    v->slow = NULL;
    BOUGH_TRY(find_pairs(arena, s, x, air, count, v));
    BOUGH_TRY(find_slow(arena, s, x, air, count, v));
    drop_other_motions(s->tree, x->def.point, count, v);
    return bough_ok();
}

// The point, or one that no real eigenvalue is near.
static double clear_of(const bough_vibration *v, double point) {
    for (int k = 0; k < v->found; k++) {
        bool real = v->pair[k].imaginary == 0;
        if (real && fabs(v->pair[k].real - point) < beside * point) return clear_of(v, aside * point);
    }
    return point;
}

// A better point on the real axis; 0 where all residuals are good or none is nearer.
static double better_point(const bough_vibration *v, double point) {
    double lowest = HUGE_VAL, largest = 0;
    for (int k = 0; k < v->found; k++) {
        lowest = fmin(lowest, modulus_of(&v->pair[k]));
        largest = fmax(largest, v->pair[k].residual);
    }
    bool moves = largest > exact && lowest > nearer * point && v->found > 0;
    double best = clear_of(v, moves ? lowest : point);
    return best > point ? best : 0;
}

bool bough_vibration_wanted(const bough_simulation *s) {
    const bough_scene_modes *modes = &s->scene->modes;
    if (modes->of != BOUGH_SCENE_MODES_AUTO) return modes->of == BOUGH_SCENE_MODES_SCENE;
    bool axis = modes->axis[0] != 0 || modes->axis[1] != 0 || modes->axis[2] != 0;
    bool reduced = bough_steady_rods(s) < s->n_rod; // a modal body has modes in the whole scene only
    return (!bough_rods_are_independent(s) || reduced) && modes->speed == 0 && !axis;
}

// Brings the scene to the state of its modes, and finds the air about it.
static bough_status settle(bough_arena *arena, bough_simulation *s, bough_vibration *v,
                           bough_vibration_point *x, air_about *air) {
    bool balanced = s->scene->modes.at == BOUGH_SCENE_IN_EQUILIBRIUM;
    v->time = balanced ? bough_equilibrium_time(s) : 0;
    if (balanced) BOUGH_TRY(bough_simulation_equilibrium(s, v->time, 0, NULL));
    BOUGH_TRY(bough_vibration_point_find(arena, s, v->time, x));
    v->spin = fabs(x->group.speed) < at_rest ? 0 : x->group.speed;
    v->n_blade = x->group.n;
    v->frozen = is_frozen(s, &x->group);
    BOUGH_TRY(bough_vibration_check_constant(arena, s, x, x->def.point));
    BOUGH_TRY(find_air(arena, s, v->time, x, air));
    v->n_azimuth = air->azimuths.n;
    return bough_ok();
}

// Finds the eigenvalues and what their modes are.
static bough_status solve(bough_arena *arena, bough_simulation *s, int count, bough_vibration_point *x,
                          const air_about *air, bough_vibration *v) {
    double point;
    v->asked = count;
    v->mode = bough_arena_take(arena, (size_t)count * sizeof *v->mode);
    bough_status status = solve_about(arena, s, x, air, count, v);
    if (status.code == BOUGH_FAILED) { // a growing motion at the point makes it singular
        x->def.point *= aside;
        status = solve_about(arena, s, x, air, count, v);
    }
    BOUGH_TRY(status);
    bool dynamic = air->follows && s->scene->modes.air == BOUGH_SCENE_AIR_DYNAMIC; // with other residuals
    for (int k = 0; k < MOVES && !dynamic && (point = better_point(v, x->def.point)) > 0; k++) {
        x->def.point = point;
        BOUGH_TRY(solve_about(arena, s, x, air, count, v));
    }
    for (int k = 0; k < v->found; k++) set_value(&v->pair[k], v->change[k], &v->mode[k]);
    bough_vibration_describe(arena, s, x, v);
    return bough_ok();
}

// Least ratio of the angular frequencies at which the linear system is checked: the solutions near one hardly
// depend on what causes much faster and much slower motions.
static const double farther = 3;

// The linear system is constant also at the frequencies of the modes.
static bough_status check_modes(bough_arena *arena, const bough_simulation *s, const bough_vibration_point *x,
                                const bough_vibration *v) {
    double last = x->def.point;
    for (int k = 0; k < v->found; k++) {
        double at = 2 * BOUGH_PI * v->mode[k].frequency;
        if (at < farther * last && (at <= last || k < v->found - 1)) continue;
        last = at;
        BOUGH_TRY(bough_vibration_check_constant(arena, s, x, at));
    }
    return bough_ok();
}

bough_status bough_vibration_find(bough_arena *arena, bough_simulation *s, int count, bough_vibration *v) {
    bough_vibration_point x;
    air_about air = {.changes = true};
    *v = (bough_vibration){0};
    bough_arena *of_air = bough_arena_child(arena);
    BOUGH_TRY(settle(of_air, s, v, &x, &air));
    BOUGH_TRY(solve(arena, s, count, &x, &air, v));
    BOUGH_TRY(check_modes(of_air, s, &x, v));
    bough_arena_destroy(of_air);
    return bough_ok();
}

// -- another mesh ---------------------------------------------------------------------------------

// Modes beyond those compared, among which the partners of the highest may be.
enum { MODES_BEYOND = 6 };

static bool has_other_mesh(const bough_scene *scene, const bough_scene *other) {
    for (int i = 0; i < scene->n_body; i++) {
        bool meshed = bough_scene_has_mesh(&scene->body[i]);
        if (meshed && scene->body[i].rod.n_segment != other->body[i].rod.n_segment) return true;
    }
    return false;
}

// Motions that decay without oscillating are not compared, because many have nearly one rate, nor are vectors
// with a large residual.
static bool is_compared(const bough_scene_mode *mode) {
    bool oscillates = mode->damped_frequency > 0.01 * mode->frequency;
    return (oscillates || mode->growth > 0) && mode->residual < 0.01;
}

// Distance of the eigenvalues relative to that of a.
static double distance(const bough_scene_mode *a, const bough_scene_mode *b) {
    double difference =
        hypot(a->growth - b->growth, 2 * BOUGH_PI * (a->damped_frequency - b->damped_frequency));
    return difference / (2 * BOUGH_PI * a->frequency);
}

// Relative changes of λ: farther is another motion; nearer follow from the vectors to a tenth.
static const double farthest = 0.5, little = 0.02;

// The least distance first. Modes of other bodies and directions are farther: but in round sections, and
// where two modes nearly have one frequency, the direction means little.
static void pair_modes(const bough_vibration *v, const bough_vibration *other, bool *taken) {
    static const double unlike = 4;
    for (int first = 0, second; first >= 0;) {
        double least = farthest;
        first = second = -1;
        for (int i = 0; i < v->found; i++) {
            const bough_scene_mode *a = &v->mode[i];
            for (int j = 0; j < other->found && isnan(a->moved) && is_compared(a); j++) {
                const bough_scene_mode *b = &other->mode[j];
                bool alike = a->body == b->body && a->blades == b->blades && a->direction == b->direction;
                double cost = distance(a, b) * (alike ? 1 : unlike);
                if (!taken[j] && is_compared(b) && cost < least) least = cost, first = i, second = j;
            }
        }
        if (first < 0) break;
        taken[second] = true;
        v->mode[first].moved = distance(&v->mode[first], &other->mode[second]);
    }
    for (int i = 0; i < v->found; i++)
        if (isnan(v->mode[i].moved) && is_compared(&v->mode[i])) v->mode[i].moved = HUGE_VAL;
}

// Follows the modes by their vectors; false where that is not possible, or not accurate because they change
// by much.
static bool follow_modes(bough_arena *arena, const bough_simulation *s, const bough_aeroelastic *other,
                         bough_vibration *v) {
    const bough_known_modes known = {s, v->found, v->pair, v->vector};
    double complex *there = bough_arena_take(arena, ((size_t)v->found + 1) * sizeof *there);
    // shapes of a modal body on another mesh are not the same states
    if (!v->vector || bough_steady_rods(s) < s->n_rod) return false;
    bough_status status = bough_mesh_change_find(arena, &known, other, there);
    bool good = bough_is_ok(&status);
    for (int k = 0; k < v->found && good; k++) {
        if (!is_compared(&v->mode[k])) continue;
        double complex value = v->pair[k].real + v->pair[k].imaginary * (double complex)I;
        v->mode[k].moved = cabs(there[k] - value) / cabs(value);
        good = v->mode[k].moved <= little;
    }
    for (int k = 0; k < v->found && !good; k++) v->mode[k].moved = (double)NAN;
    return good;
}

bough_status bough_vibration_compare(bough_arena *arena, const bough_simulation *s, bough_vibration *v,
                                     bool *compared) {
    const bough_scene *other = bough_coarser_scene_beside(arena, s, BOUGH_COARSER_MESH);
    bough_simulation *companion;
    bough_vibration of_other = {0};
    bough_vibration_point x;
    air_about air = {0};
    *compared = has_other_mesh(s->scene, other);
    if (!*compared) return bough_ok();
    BOUGH_TRY(bough_simulation_build(arena, other, &companion));
    BOUGH_TRY(settle(arena, companion, &of_other, &x, &air));
    const bough_aeroelastic system = {companion, x.whole, &x.def, &x.group, &air.tangent};
    if (follow_modes(arena, s, &system, v)) return bough_ok();
    BOUGH_TRY(solve(arena, companion, v->found + MODES_BEYOND, &x, &air, &of_other));
    pair_modes(v, &of_other, bough_arena_take(arena, ((size_t)of_other.found + 1) * sizeof(bool)));
    return bough_ok();
}
