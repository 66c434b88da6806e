#include "apps/bough/model/validity.h"

#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/equilibrium.h"
#include "core/base/rotation.h"
#include "core/tree/force.h"
#include "core/tree/loop.h"
#include "cosim/whole.h"

// Mach number of half: incompressible polars err by a seventh in the slope of lift there.
static const double most_mach = 0.5, speed_of_sound = 340;
static const double most_over_rated = 2;
// Largest error of the air's loads relative to them: it is up to 0.1 at a sufficient rate, near 1 where the
// loads' delay feeds vibrations.
static const double most_missed = 0.3;
// The wind may exceed both neighbouring samples by this fraction of its range.
static const double most_between = 0.05;
// Largest rotation of the rotor between two samples: a third harmonic is then sampled twice in its period.
static const double most_rotation = BOUGH_PI / 3;
// Largest angle between the ends of a segment: its constant strain is a coarse approximation beyond, and none
// beyond 120°.
static const double most_turn = 0.25 * BOUGH_PI;
// Largest displacement of a vertex by the shapes of a modal piece, relative to its length: the tip of such a
// cantilever approaches the root by 0.06 of the deflection, which linear shapes neglect.
static const double most_linear = 0.1;
// Least bough_loops_margin, absolute and relative to the largest so far: on random linkages it stays above
// 0.02 or above 0.03 of the largest, and falls to 1e-5 to 3e-3 where the links come to lie on one line.
static const double least_margin = 0.01, least_share = 0.1;
static const double most_open = 0.01;           // of the size of a closed loop
static const double most_uneven = BOUGH_DEGREE; // of the gap between two blades
static const double most_off = 0.02;            // of the hub's radius
// Cosine of the angle between axis and wind, 60°: beyond every yaw error of operation.
static const double least_along = 0.5;
// Macro steps with more solver steps are counted, and reported when their work, steps times states (at least
// a hundred), takes some seconds.
static const double many_steps = 100, most_work = 3e6;
static const int least_states = 100;
// Largest rotation of a bushing, and distance of a spring's ends over its length without force.
static const double most_bushing = 0.75 * BOUGH_PI, least_spring = 1e-6;
static const double small_turn = 0.98; // cosine of a quarter of most_turn

// Each sentence contains the value in its unit.
// clang-format off
static const struct {
    const char *name, *text;
} limits[BOUGH_LIMITS] = {
    [BOUGH_LIMIT_ATTACK] = {"angle_of_attack",
        "the polar's table has no rows at an angle of attack of %.4g deg; they are joined across the gap"},
    [BOUGH_LIMIT_MACH] = {"mach",
        "a section meets the air at %.4g m/s, more than half the speed of sound: the polars hold for incompressible flow"},
    [BOUGH_LIMIT_ROTOR_SPEED] = {"rotor_speed", "the rotor turns at %.4g rpm, more than twice the rated speed"},
    [BOUGH_LIMIT_TOWER] = {"tower_strike",
        "the blade is inside the tower, %.3g of its radius from the axis: nothing stops it there"},
    [BOUGH_LIMIT_SAMPLES] = {"air_samples",
        "the loads of the air miss its vibrations by %.2g of their size between two samples: take a higher aero.rate, or fidelity rod"},
    [BOUGH_LIMIT_TURN] = {"segment_turn",
        "the ends of a segment are rotated by %.3g deg to each other, more than 45 deg: take more segments"},
    [BOUGH_LIMIT_SHAPES] = {"modal_deflection",
        "its shapes, which hold for small deflections, move a vertex by %.2g of its length: take fidelity rod"},
    [BOUGH_LIMIT_SPACING] = {"blade_spacing",
        "the blades are not evenly spaced about its axis: between two of them are %.4g deg"},
    [BOUGH_LIMIT_ACROSS] = {"wind_across",
        "its axis is across the wind, or faces away from it: the angle between them is %.4g deg"},
    [BOUGH_LIMIT_HUB] = {"hub_radius",
        "it begins %.4g m from the rotor's axis, which aero.hub_radius contradicts: the losses at hub and tip belong to other radii"},
    [BOUGH_LIMIT_GROUND] = {"below_ground",
        "its blades reach %.4g m below the ground of the wind, z = 0"},
    [BOUGH_LIMIT_PLACE] = {"tower_place",
        "it is %.4g m beside aero.tower, which stands at x = y = 0 or where its 'body' begins"},
    [BOUGH_LIMIT_MESH] = {"one_segment",
        "a rod of one segment bends by a third too little under a load along it, and its first frequency is a tenth too high: take more segments than %g"},
    [BOUGH_LIMIT_SINGULAR] = {"singular_position",
        "its closed loop is near a singular position, where its bodies can continue in two ways and the smallest difference decides; forces there may err by more than estimated; margin %.2g"},
    [BOUGH_LIMIT_WIND] = {"wind_samples",
        "the wind changes by %.3g m/s and back between two samples of the air, which do not see it: take a higher aero.rate"},
    [BOUGH_LIMIT_ROTATION] = {"rotor_samples",
        "it turns by %.3g deg between two samples of the air, which miss what changes within a rotation: take a higher aero.rate"},
    [BOUGH_LIMIT_START] = {"unstable_start",
        "the equilibrium from which the run starts is unstable: small disturbances, which the error estimate does not contain, grow at %.3g 1/s"},
    [BOUGH_LIMIT_BUSHING] = {"bushing_turn",
        "a bushing on it is turned by %.4g deg: its moments follow the rotation vector, which at 180 deg jumps to the other side"},
    [BOUGH_LIMIT_SPRING] = {"spring_ends",
        "the ends of a spring on it meet: the force of a spring that is shorter than without force has no direction there; distance %.2g m"},
    [BOUGH_LIMIT_STEPS] = {"solver_steps",
        "most of the cost comes from motions so fast that a solver takes %.3g steps in a macro step: damping, a larger rtol or another solver (radau5, cvode-bdf) may help"},
    [BOUGH_LIMIT_FAST] = {"fast_vibrations",
        "vibrations much faster than the macro step of %.4g s may be missing from the results or err by more than the estimate, above all in forces and velocities: damp them, or take a smaller rtol"},
};
// clang-format on

const char *bough_limit_name(bough_limit limit) { return limits[limit].name; }

// Records that a limit is passed, the first time.
static void pass(bough_validity *v, bough_limit limit, int body, double time, double value) {
    if (v->limit[limit].passed) return;
    v->limit[limit] = (bough_passing){true, body, time, value};
}

// Notes that a beam passes a limit at the present time.
static void pass_beam(bough_simulation *s, bough_limit limit, const bough_beam *beam, double value) {
    pass(s->validity, limit, beam->index, s->master->time, value);
}

static void check_air(bough_simulation *s) {
    const bough_rotor *rotor = bough_aero_link_rotor(s->aero);
    double time = bough_aero_link_evaluated(s->aero);
    const bough_rotor_data *data = bough_aero_link_data(s->aero, NULL);
    bough_validity *v = s->validity;
    if (!(time > v->looked)) return;
    v->looked = time;
    for (int b = 0; b < s->scene->turbine.n_blade; b++) {
        bough_rotor_extremes x = bough_rotor_look(rotor, data, b);
        int body = s->scene->turbine.blade[b];
        double angle = x.alpha / BOUGH_DEGREE, missed = bough_aero_link_missed(s->aero, b);
        if (x.outside_table) pass(v, BOUGH_LIMIT_ATTACK, body, time, angle);
        if (x.speed > most_mach * speed_of_sound) pass(v, BOUGH_LIMIT_MACH, body, time, x.speed);
        bool modal = s->scene->body[body].fidelity != BOUGH_SCENE_ROD; // a rod damps between the samples
        if (modal && missed > most_missed) pass(v, BOUGH_LIMIT_SAMPLES, body, time, missed);
        if (x.distance < 1) pass(v, BOUGH_LIMIT_TOWER, body, time, x.distance);
    }
}

static double rotor_speed(const bough_simulation *s) {
    return bough_simulation_joint_point(s, s->scene->turbine.rotor).v;
}

// Beyond this rotation run and companion may both sample a blade at the same azimuths in each rotation.
static void check_rotation(bough_simulation *s) {
    double turned = fabs(rotor_speed(s)) / s->scene->aero.rate;
    if (turned <= most_rotation) return;
    pass(s->validity, BOUGH_LIMIT_ROTATION, s->scene->turbine.rotor, s->master->time, turned / BOUGH_DEGREE);
}

static void check_speed(bough_simulation *s) {
    const bough_scene_control *control = &s->scene->control;
    if (!control->node || control->kind != BOUGH_SCENE_VARIABLE_SPEED) return;
    int rotor = s->scene->turbine.rotor;
    double speed = rotor_speed(s);
    double rated = control->law.rated_speed / control->gear_ratio;
    if (fabs(speed) <= most_over_rated * fabs(rated)) return;
    pass(s->validity, BOUGH_LIMIT_ROTOR_SPEED, rotor, s->master->time, speed / BOUGH_RPM);
}

static double dot(bough_quaternion p, bough_quaternion q) {
    return p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z;
}

// Whether no segment rotates by more than a quarter of most_turn, now or undeformed; p: rows of all sections
// but the root's.
static bool turn_little(const bough_rod_model *m, const double *restrict p) {
    const bough_quaternion *restrict rest = m->rotation0, first = {p[0], p[m->n], p[2 * m->n], p[3 * m->n]};
    double least = fmin(fabs(dot(rest[0], first)), fabs(dot(rest[0], rest[1])));
#pragma omp simd reduction(min : least)
    for (int k = 1; k < m->n; k++) {
        double now = 0;
        for (int c = 0; c < 4; c++) now += p[c * m->n + k - 1] * p[c * m->n + k];
        double at_rest = fabs(dot(rest[k], rest[k + 1]));
        now = fabs(now) < at_rest ? fabs(now) : at_rest;
        least = now < least ? now : least;
    }
    return least > small_turn;
}

static void check_turns(bough_simulation *s) {
    for (int i = 0; i < s->n_beam; i++) {
        const bough_beam *beam = &s->beam[i];
        if (!beam->rod || s->validity->limit[BOUGH_LIMIT_TURN].passed) continue;
        const bough_rod_model *m = beam->mesh;
        if (turn_little(m, bough_beam_state(s, beam, 0) + (size_t)BOUGH_ROD_P * (size_t)m->n)) continue;
        double turn = bough_simulation_bend(s, beam).angle;
        if (turn > most_turn) pass_beam(s, BOUGH_LIMIT_TURN, beam, turn / BOUGH_DEGREE);
    }
}

// The largest displacement of a vertex over the length of the piece.
static double deflection_of(const bough_modal_piece *p, const double *q) {
    double square = 0, length = 0;
    for (int i = 1; i <= p->n; i++) {
        bough_vec3 shift = bough_modal_vertex(p, i, q).linear;
        square = fmax(square, bough_dot(shift, shift));
        length += p->rod->length[i - 1];
    }
    return sqrt(square) / length;
}

static void check_shapes(bough_simulation *s) {
    for (int i = 0; i < s->n_beam; i++) {
        const bough_beam *beam = &s->beam[i];
        if (!beam->modal || s->validity->limit[BOUGH_LIMIT_SHAPES].passed) continue;
        const bough_modal_model *m = bough_modal_body_model(beam->modal);
        for (int k = 0; k < m->n_piece; k++) {
            double deflection = deflection_of(&m->piece[k], s->rod[beam->port].state + m->offset[k]);
            if (deflection <= most_linear) continue;
            pass_beam(s, BOUGH_LIMIT_SHAPES, beam, deflection);
            break;
        }
    }
}

static void check_closures(bough_simulation *s) {
    double t = s->master->time;
    int closure = 0;
    bough_validity *v = s->validity;
    if (v->limit[BOUGH_LIMIT_SINGULAR].passed) return;
    bough_simulation_update(s);
    if (!bough_simulation_accelerate(s, t)) return;
    double margin = bough_loops_margin(s->tree, s->view, &closure);
    v->margin = fmax(v->margin, margin);
    if (!(margin <= least_margin && margin <= least_share * v->margin)) return;
    const int *body = s->scene->connector[BOUGH_SCENE_CLOSURE][closure].body;
    pass(v, BOUGH_LIMIT_SINGULAR, body[body[0] == BOUGH_GROUND], t, margin);
}

// A body on one end of a connector.
static int body_on(const bough_simulation *s, bough_scene_connector_kind kind, int k) {
    const int *body = s->scene->connector[kind][k].body;
    return body[body[1] != BOUGH_GROUND];
}

static void check_bushings(bough_simulation *s) {
    const bough_tree *tree = s->tree;
    for (int k = 0; k < tree->n_bushings; k++) {
        const bough_bushing_def *b = &tree->bushings[k];
        bough_mat3 r[2];
        for (int end = 0; end < 2; end++)
            r[end] = bough_tree_frame_pose(s->view, &tree->markers[b->marker[end]]).rotation;
        bough_mat3 between = bough_mat3_product(bough_mat3_transpose(r[0]), r[1]);
        double turn = bough_norm(bough_quaternion_logarithm(bough_quaternion_of_matrix(between)));
        bool acts = false;
        for (int c = 3; c < 6; c++) acts = acts || b->stiffness[c] != 0;
        if (acts && turn > most_bushing)
            pass(s->validity, BOUGH_LIMIT_BUSHING, body_on(s, BOUGH_SCENE_BUSHING, k), s->master->time,
                 turn / BOUGH_DEGREE);
    }
}

static void check_springs(bough_simulation *s) {
    for (int k = 0; k < s->tree->n_springs; k++) {
        const bough_spring_def *spring = &s->tree->springs[k];
        bough_vec3 direction;
        double tension, length = bough_tree_spring(s->tree, s->view, k, &tension, &direction);
        if (spring->stiffness != 0 && length < least_spring * spring->length)
            pass(s->validity, BOUGH_LIMIT_SPRING, body_on(s, BOUGH_SCENE_SPRING, k), s->master->time, length);
    }
}

static void check_elements(bough_simulation *s) {
    if (bough_tree_n_elements(s->tree) == 0) return;
    bough_simulation_update(s);
    check_bushings(s);
    check_springs(s);
}

// -- at the start ---------------------------------------------------------------------------------

static double azimuth(const bough_simulation *s, int blade) {
    return bough_simulation_azimuth(s, bough_simulation_blade(s, blade));
}

// The narrowest gap between two blades [rad].
static double narrowest_gap(const bough_simulation *s) {
    double narrowest = 2 * BOUGH_PI;
    for (int k = 0; k < s->scene->turbine.n_blade; k++) {
        for (int j = 0; j < k; j++) {
            double gap = remainder(azimuth(s, j) - azimuth(s, k), 2 * BOUGH_PI);
            narrowest = fmin(narrowest, fabs(gap));
        }
    }
    return narrowest;
}

static void check_rotor(bough_simulation *s) {
    int n = s->scene->turbine.n_blade, body = s->scene->turbine.rotor;
    bough_rotor_place r = bough_simulation_rotor(s);
    double gap = narrowest_gap(s);
    if (gap < 2 * BOUGH_PI / n - most_uneven) {
        pass(s->validity, BOUGH_LIMIT_SPACING, body, 0, gap / BOUGH_DEGREE);
    }
    if (!s->aero) return;
    bough_vec3 wind = bough_aero_link_hub_wind(s->aero, 0);
    double speed = sqrt(bough_dot(wind, wind)), along = bough_dot(wind, r.axis);
    if (along >= least_along * speed) return;
    double angle = acos(fmax(-1, along / speed));
    pass(s->validity, BOUGH_LIMIT_ACROSS, body, 0, angle / BOUGH_DEGREE);
}

// Where the rotor is for the air. Roots are at the hub's radius from its axis or, of coned blades, its
// centre.
static void check_place(bough_simulation *s) {
    const bough_scene_aero *aero = &s->scene->aero;
    int rotor = s->scene->turbine.rotor;
    bough_rotor_place r = bough_simulation_rotor(s);
    for (int k = 0; k < s->scene->turbine.n_blade; k++) {
        const bough_beam *blade = bough_simulation_blade(s, k);
        bough_vec3 root = bough_sub(bough_beam_pose(s, blade).position, r.hub);
        double away = bough_norm(bough_axpy(-bough_dot(root, r.axis), r.axis, root));
        bool inside = aero->hub_radius < (1 - most_off) * away;
        if (inside || aero->hub_radius > (1 + most_off) * bough_norm(root))
            pass_beam(s, BOUGH_LIMIT_HUB, blade, away);
    }
    double lowest = r.hub.z - r.radius * sqrt(fmax(0, 1 - r.axis.z * r.axis.z));
    if (aero->wind.kind != BOUGH_SCENE_WIND_UNIFORM && lowest < 0)
        pass(s->validity, BOUGH_LIMIT_GROUND, rotor, 0, -lowest);
    bough_vec3 foot = bough_aero_link_foot(s);
    double beside = hypot(r.hub.x - foot.x, r.hub.y - foot.y);
    if (aero->tower.node && beside > r.radius / 2) pass(s->validity, BOUGH_LIMIT_PLACE, rotor, 0, beside);
}

static void check_wind(bough_simulation *s) {
    const bough_wind *wind = bough_rotor_wind(bough_aero_link_rotor(s->aero));
    bough_wind_missed missed =
        bough_wind_between(wind, 1 / s->scene->aero.rate, s->scene->simulation.duration);
    if (missed.speed <= most_between * missed.range) return;
    pass(s->validity, BOUGH_LIMIT_WIND, s->scene->turbine.rotor, missed.time, missed.speed);
}

// Connected rods form one rod: only a single one is too coarse.
static void check_mesh(bough_simulation *s) {
    for (int i = 0; i < s->n_beam; i++) {
        const bough_beam *beam = &s->beam[i];
        int parent = beam->body->joint.parent;
        bool in_row = beam->end >= 0 || (parent >= 0 && s->scene->body[parent].fidelity == BOUGH_SCENE_ROD);
        if (beam->port < 0 || in_row || beam->def.n_segment > 1) continue;
        pass_beam(s, BOUGH_LIMIT_MESH, beam, 1);
    }
}

void bough_validity_start(bough_simulation *s) {
    if (s->scene->turbine.node) check_rotor(s);
    if (s->aero) check_place(s);
    if (s->aero) check_wind(s);
    check_mesh(s);
    check_elements(s);
}

// The body of that name, which a blank and "end" may follow: the tree calls the end of a rod so.
static int find_body(const bough_scene *scene, const char *name) {
    size_t length = strcspn(name, " ");
    for (int i = 0; i < scene->n_body; i++) {
        const char *own = scene->body[i].name;
        if (strlen(own) == length && strncmp(own, name, length) == 0) return i;
    }
    return 0;
}

void bough_validity_check_equilibrium(bough_simulation *s) {
    bough_growth growth;
    if (s->scene->simulation.initial == BOUGH_SCENE_UNDEFORMED) return;
    bough_status status = bough_simulation_growth(s, 0, true, &growth);
    double rate = fmax(growth.rate, growth.oscillation);
    if (!bough_is_ok(&status) || !(rate > 0)) return;
    int body = find_body(s->scene, bough_simulation_body_of(s, growth.row));
    pass(s->validity, BOUGH_LIMIT_START, body, 0, rate);
}

// -- after each step ------------------------------------------------------------------------------

void bough_validity_check(bough_simulation *s) {
    if (s->tree->n_closures > 0) check_closures(s);
    check_elements(s);
    if (s->aero) check_air(s);
    if (s->aero) check_rotation(s);
    check_turns(s);
    check_shapes(s);
    check_speed(s);
}

static bool is_driven(const bough_tree *tree) {
    bool driven = false;
    for (int i = 0; i < tree->n_links; i++) driven = driven || tree->links[i].motion != NULL;
    return driven;
}

bough_status bough_validity_check_closed(bough_simulation *s) {
    int closure = 0;
    if (s->tree->n_closures == 0) return bough_ok();
    bough_simulation_update(s);
    double opening = bough_loops_opening(s->tree, s->view, &closure);
    if (opening <= most_open) return bough_ok();
    return bough_fail(
        BOUGH_FAILED,
        "closure '%s' at %.6g s under scheme %s: its loop is open by %.2g of its size: %sthe steps are too long (try a smaller rtol or macro_step), or one of its bodies is much lighter than the others and needs more mass and inertia",
        s->scene->connector[BOUGH_SCENE_CLOSURE][closure].name, s->master->time,
        bough_scheme_name(s->scene->simulation.coupling.scheme), opening,
        is_driven(s->tree) ? "it cannot follow the motion that a joint prescribes, or " : "");
}

// -- work -----------------------------------------------------------------------------------------

typedef struct fastest {
    const bough_simulation *simulation;
    int body; // of the scene
} fastest;

// The body whose state changes fastest, measured by the tolerance.
static bough_status find_fastest(bough_arena *arena, void *self) {
    fastest *f = self;
    const bough_simulation *s = f->simulation;
    size_t n = (size_t)s->assembly->n_state;
    double *state, *rate, *scale, largest = 0;
    bough_arena_each(arena, n, &state, &rate, &scale);
    bough_assembly_states(s->assembly, state);
    bough_assembly_scales(s->assembly, scale);
    bough_whole *whole = bough_whole_create_evaluation(arena, s->assembly, NULL);
    bough_status status = bough_whole_rate(whole, s->master->time, state, rate);
    for (int k = 0; bough_is_ok(&status) && k < (int)n; k++) {
        if (!(fabs(rate[k]) / scale[k] > largest)) continue;
        largest = fabs(rate[k]) / scale[k];
        f->body = find_body(s->scene, bough_simulation_body_of(s, k));
    }
    return status;
}

static void pass_fastest(bough_simulation *s, bough_limit limit, double value) {
    fastest f = {s, 0};
    bough_status status = bough_arena_use(find_fastest, &f);
    (void)status; // without a rate the first body is named
    pass(s->validity, limit, f.body, s->master->time, value);
}

void bough_validity_check_work(bough_simulation *s) {
    bough_validity *v = s->validity;
    double steps = (double)bough_simulation_steps(s);
    double taken = steps < v->steps ? steps : steps - v->steps; // a resumed run counts from 0
    v->steps = steps;
    if (taken < many_steps || v->limit[BOUGH_LIMIT_STEPS].passed) return;
    int states = s->assembly->n_state;
    v->work += taken * (states > least_states ? states : least_states);
    if (v->work < most_work) return;
    pass_fastest(s, BOUGH_LIMIT_STEPS, taken);
}

void bough_validity_pass_fast(bough_simulation *s) {
    pass_fastest(s, BOUGH_LIMIT_FAST, s->scene->simulation.macro_step);
}

void bough_validity_describe(const bough_simulation *s, bough_limit limit, char *text, size_t size) {
    const bough_passing *p = &s->validity->limit[limit];
    int n = snprintf(text, size, "%s at %.6g s: ", s->scene->body[p->body].name, p->time);
    if (n < 0 || (size_t)n >= size) return;
    snprintf(text + n, size - (size_t)n, limits[limit].text, p->value);
}

void bough_validity_list(const bough_simulation *s, char *text, size_t size) {
    size_t n = 0;
    text[0] = '\0';
    for (int k = 0; k < BOUGH_LIMITS && n + 2 < size; k++) {
        if (!s->validity->limit[k].passed) continue;
        if (n > 0) n += (size_t)snprintf(text + n, size - n, "; ");
        bough_validity_describe(s, (bough_limit)k, text + n, size - n);
        n += strlen(text + n);
    }
}

void bough_validity_print(const bough_simulation *s, FILE *stream) {
    char text[400];
    for (int k = 0; k < BOUGH_LIMITS; k++) {
        if (!s->validity->limit[k].passed) continue;
        bough_validity_describe(s, (bough_limit)k, text, sizeof text);
        fprintf(stream, "warning: %s\n", text);
    }
}
