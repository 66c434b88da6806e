#include "apps/bough/model/companion.h"

#include "apps/bough/model/aero_link.h"
#include "cosim/master.h"
#include "cosim/scheme.h"

// -- ratio of the errors --

static bool is_one_system(const bough_scene *scene) {
    return bough_scheme_at(scene->simulation.coupling.scheme)->one_system;
}

// Whether the integrator of the whole or of a body takes fixed steps, whose error the companion's steps by
// tolerance do not share. Fixed steps of its own would end at the corners of loads, as the run's do, and be
// as short.
static bool has_fixed_steps(const bough_scene *scene) {
    if (is_one_system(scene)) return scene->simulation.master.solver == BOUGH_GENERALIZED_ALPHA;
    for (int i = 0; i < scene->n_body; i++) {
        const bough_scene_body *b = &scene->body[i];
        if (bough_scene_has_mesh(b) && bough_scene_micro(scene, b)->solver == BOUGH_GENERALIZED_ALPHA)
            return true;
    }
    return false;
}

static bool holds_loads(const bough_scene *scene) { return scene->aero.hold == BOUGH_SCENE_CONSTANT; }

bool bough_coarser_steps_alone(const bough_scene *scene) {
    static const double tight = 1e-6;
    bool mesh = false;
    for (int i = 0; i < scene->n_body; i++) mesh = mesh || bough_scene_has_mesh(&scene->body[i]);
    bool sampled = scene->aero.node || scene->control.node;
    return is_one_system(scene) && scene->simulation.master.rtol < tight && !mesh && !sampled;
}

// All bodies as one system: a third in air whose loads follow the motion, as at order 2;
// two fifths without air, where vibrations do not decay and their phases and amplitudes err at a lower order;
// three tenths for rigid bodies, beside a companion of a still larger tolerance. A coupling scheme: the
// companion has no error of coupling, so that this error is the whole difference. It is taken as a whole for
// fixed steps and for a scheme that is explicit, repeats steps or is of order 1, as any is across a jump
// within a macro step; otherwise by half, as steps and mesh are a part of the difference.
static double usual_ratio(const bough_scene *scene) {
    const bough_scene_coupling *x = &scene->simulation.coupling;
    const bough_scheme *scheme = bough_scheme_at(x->scheme);
    if (has_fixed_steps(scene)) return 1;
    if (scheme->one_system) return scene->aero.node ? 1 / 3.0 : bough_coarser_steps_alone(scene) ? 0.3 : 0.4;
    bool whole = scheme->explicit_forces || scheme->repeats || bough_jump_times(scene, 0, NULL) > 0 ||
                 bough_scheme_error_order(scheme, &x->options) == 1;
    return whole ? 1 : 0.5;
}

// -- mesh -----------------------------------------------------------------------------------------

// A rod that carries bodies has an inner vertex.
static int least_segments(const bough_scene *scene, int body) {
    const bough_scene_body *b = &scene->body[body];
    if (b->fidelity == BOUGH_SCENE_SEGMENTED_MODAL) return b->modal.pieces;
    return bough_scene_carried_by(scene, body) >= 0 ? 2 : 1;
}

// Loads on vertices keep their places. The copy has its own values of tables, which inputs change.
static void copy_loads(bough_arena *arena, const bough_scene *scene, bough_scene *to) {
    to->load = bough_arena_copy(arena, scene->load, (size_t)scene->n_load * sizeof *to->load);
    for (int k = 0; k < scene->n_load; k++) {
        bough_scene_load *load = &to->load[k];
        load->values = bough_arena_copy(arena, load->values, (size_t)load->n_time * sizeof *load->values);
        if (load->body_name == NULL || load->place != BOUGH_SCENE_AT_VERTEX) continue;
        const bough_scene_rod *rod = &scene->body[load->body].rod;
        if (!rod->node) continue;
        load->place = BOUGH_SCENE_AT_SPAN;
        double part = bough_section_graded(rod->grading, (double)load->vertex / rod->n_segment);
        load->span[0] = bough_scene_arc_length(&rod->structure) * part;
    }
}

enum { FEW_SEGMENTS = 9 };   // with fewer, half of them are too coarse for errors to fall with their order
enum { LEAST_SEGMENTS = 8 }; // of a finer rod: fewer save no time
// A blade of eight segments in air at half the rate can be unstable. Below SOME_SEGMENTS no smaller number
// differs by enough.
enum { LEAST_IN_AIR = 10, SOME_SEGMENTS = 14 };

static int finer_number(int n) { return 2 * n > LEAST_SEGMENTS ? 2 * n : LEAST_SEGMENTS; }

// About half of n segments, or seven tenths where the whole difference is the error. A rod of few segments,
// or one that cannot have many fewer, gets at least twice as many: the difference measures the error as well.
static int other_number(int n, int least, bool whole) {
    int part = whole ? 7 * n / 10 : (n + 1) / 2, fewer = part > least ? part : least;
    return n >= FEW_SEGMENTS && 4 * fewer <= 3 * n ? fewer : finer_number(n);
}

// All blades must have the same number of segments, for the air.
static int least_of_blades(const bough_scene *scene) {
    int most = 1;
    for (int k = 0; scene->turbine.node && k < scene->turbine.n_blade; k++) {
        int least = least_segments(scene, scene->turbine.blade[k]);
        most = least > most ? least : most;
    }
    return most;
}

// The states of a modal body are its modes, so that a finer mesh adds no states; few segments have too few
// modes.
static bool is_modal(const bough_scene *scene, int body) {
    return scene->body[body].fidelity != BOUGH_SCENE_ROD;
}

static bool has_modal_blades(const bough_scene *scene) {
    bool modal = false;
    for (int k = 0; k < scene->turbine.n_blade; k++)
        modal = modal || is_modal(scene, scene->turbine.blade[k]);
    return modal;
}

// The shortest pulse whose waves half as many segments resolve, the longest of all rods [s]: what a wave
// along the rod takes through a segment, or half the period of a bending wave as long as eight segments.
static double resolved_time(const bough_scene *scene) {
    double longest = 0;
    for (int i = 0; i < scene->n_body; i++) {
        const bough_scene_rod *rod = &scene->body[i].rod;
        if (!bough_scene_has_mesh(&scene->body[i])) continue;
        const bough_section_station *root = &rod->structure.station[0].def;
        double h = bough_scene_arc_length(&rod->structure) / rod->n_segment;
        double bending = fmin(root->stiffness[15], root->stiffness[18]);
        double wave = 16 * h * h / BOUGH_PI * sqrt(root->mass / bending); // λ²/4π, λ = 8 h
        longest = fmax(longest, fmax(h * sqrt(root->mass / root->stiffness[11]), wave));
    }
    return longest;
}

// Whether a load goes up and down, or down and up, in less than a time.
static bool has_pulse(const bough_scene_load *load, double time) {
    double began[2] = {-HUGE_VAL, -HUGE_VAL}; // the last fall and the last rise
    for (int k = 1; k < load->n_time; k++) {
        double change = load->values[k] - load->values[k - 1];
        if (change == 0) continue;
        bool rises = change > 0;
        if (load->times[k] - began[!rises] < time) return true;
        began[rises] = load->times[k - 1];
    }
    return false;
}

// A shorter pulse excites waves that half as many segments do not resolve.
static bool has_short_pulses(const bough_scene *scene) {
    double time = resolved_time(scene);
    bool found = false;
    for (int k = 0; k < scene->n_load; k++) found = found || has_pulse(&scene->load[k], time);
    return found;
}

// The largest angular speed at which a joint starts, or to which a revolute one is driven [rad/s].
static double fastest_turn(const bough_scene *scene) {
    double fastest = 0;
    for (int i = 0; i < scene->n_body; i++) {
        const bough_scene_joint *joint = &scene->body[i].joint;
        const bough_motion_def *given = &joint->motion[0].def;
        // the speed is the same about any axes
        bough_joint any = {(bough_joint_kind)joint->kind, bough_transform_identity(), {1, 0, 0}, {0, 1, 0}};
        fastest = fmax(fastest, bough_norm(bough_joint_twist(&any, joint->speeds).angular));
        if (joint->kind == BOUGH_JOINT_REVOLUTE && given->given && given->speed)
            fastest = fmax(fastest, fmax(fabs(given->from), fabs(given->to)));
    }
    return fastest;
}

// The mass of a body or its rod.
static double mass_of(const bough_scene_body *b) {
    bool mesh = bough_scene_has_mesh(b);
    return mesh ? b->rod.structure.station[0].def.mass * bough_scene_arc_length(&b->rod.structure) : b->mass;
}

// The masses of a rod and of all that it carries.
static double mass_beyond(const bough_scene *scene, int rod) {
    double sum = 0;
    for (int i = 0; i < scene->n_body; i++) {
        int up = i;
        while (up != rod && up >= 0) up = scene->body[up].joint.parent;
        if (up == rod) sum += mass_of(&scene->body[i]);
    }
    return sum;
}

// h²N/EI: the square of a segment over the length in which a rod bends under the tension N by the weight and
// the rotation of what it carries.
static double slackness(const bough_scene *scene, int body) {
    const bough_scene_rod *rod = &scene->body[body].rod;
    const bough_section_station *root = &rod->structure.station[0].def;
    double length = bough_scene_arc_length(&rod->structure), h = length / rod->n_segment;
    double turn = fastest_turn(scene),
           pull = bough_norm(bough_v3_load(scene->gravity)) + turn * turn * length;
    return h * h * mass_beyond(scene, body) * pull / fmin(root->stiffness[15], root->stiffness[18]);
}

// Of a slack rope even the errors of many segments fall at order 1, or not at all.
static const double rope = 1, slack_rope = 8;

// Whether the errors of half as many segments do not fall with their order. Those of more segments are small,
// and twice as many cost most.
static bool is_rope(const bough_scene *scene, int body) {
    double q = slackness(scene, body);
    return scene->body[body].rod.n_segment <= (q > slack_rope ? 24 : 16) && q > rope;
}

// Whether the axis turns by more than an eighth of a circle over a segment of mean length: twice as much is
// no small angle.
static bool is_coiled(const bough_scene_rod *rod) {
    const bough_scene_station *at = rod->structure.station;
    double turn = 0;
    for (int k = 2; k < rod->structure.n_station; k++) {
        bough_vec3 before = bough_sub(at[k - 1].def.position, at[k - 2].def.position);
        bough_vec3 after = bough_sub(at[k].def.position, at[k - 1].def.position);
        turn += atan2(bough_norm(bough_cross(before, after)), bough_dot(before, after));
    }
    return turn > BOUGH_PI / 4 * rod->n_segment;
}

static int least_of(const bough_scene *scene, int body) {
    return bough_scene_blade(scene, body) >= 0 ? least_of_blades(scene) : least_segments(scene, body);
}

// Modal bodies get pieces of equal length; unequal ones of run and companion can err alike.
static int finer_segments(const bough_scene *scene, int body) {
    int n = finer_number(scene->body[body].rod.n_segment), pieces = least_of(scene, body);
    return (n + pieces - 1) / pieces * pieces;
}

// What a rod gets whatever the others have. `whole`: the whole difference is the error.
static int own_segments(const bough_scene *scene, int body, bool whole) {
    int n = scene->body[body].rod.n_segment, least = least_of(scene, body);
    bool blade = bough_scene_blade(scene, body) >= 0;
    bool modal = blade ? has_modal_blades(scene) : is_modal(scene, body);
    if (modal || has_short_pulses(scene) || is_rope(scene, body) || is_coiled(&scene->body[body].rod))
        return finer_segments(scene, body);
    if (blade && n >= SOME_SEGMENTS && least < LEAST_IN_AIR) least = LEAST_IN_AIR;
    return other_number(n, least, whole);
}

// The largest number of segments among the rods that get more; 0: none does.
static int most_refined(const bough_scene *scene) {
    int most = 0;
    for (int i = 0; i < scene->n_body; i++) {
        int n = scene->body[i].rod.n_segment;
        if (bough_scene_has_mesh(&scene->body[i]) && n > most && own_segments(scene, i, false) > n) most = n;
    }
    return most;
}

static bool some_finer(const bough_scene *scene) { return most_refined(scene) > 0; }

// Fewer segments of one rod hide in the difference what more of another one show, where their errors may be
// of one size: with up to BESIDE times as many as a refined rod has it is refined too.
enum { BESIDE = 3 };

static void change_segments(const bough_scene *scene, bool whole, bough_scene *to) {
    int most = BESIDE * most_refined(scene);
    for (int i = 0; i < scene->n_body; i++) {
        if (!scene->body[i].rod.node) continue;
        bool beside = scene->body[i].rod.n_segment <= most;
        to->body[i].rod.n_segment = beside ? finer_segments(scene, i) : own_segments(scene, i, whole);
    }
}

// At order 2 the error of n segments is 1/(r² − 1) of the difference to n/r segments; beside a finer mesh it
// is the whole difference.
double bough_coarser_ratio(const bough_scene *scene, const bough_scene *other) {
    double ratio = usual_ratio(scene);
    for (int i = 0; i < scene->n_body; i++) {
        if (!bough_scene_has_mesh(&scene->body[i])) continue;
        double r = (double)scene->body[i].rod.n_segment / other->body[i].rod.n_segment;
        bool whole = r < 1 || slackness(scene, i) > slack_rope;
        if (r != 1) ratio = fmax(ratio, whole ? 1 : 0.75 / (r * r - 1));
    }
    return ratio;
}

// Loads that are held constant lag by half a sample, an error of order 1.
double bough_coarser_air_ratio(const bough_scene *scene, const bough_scene *other) {
    if (!scene->aero.node || !holds_loads(scene)) return usual_ratio(scene);
    return other->aero.rate > scene->aero.rate ? bough_finer_air_ratio(scene) : 1;
}

// -- time -----------------------------------------------------------------------------------------

// Tolerance, longest step and macro step over the run's, and the largest tolerance.
typedef struct looser {
    double rtol, step, macro_step, most;
} looser;

static const double loosest = 0.02;
// Beside fixed steps, whose tolerance says nothing of their error, that of the companion is at least so
// large.
static const double tight_enough = 1e-5;
// The vibrations of a finer mesh have to be resolved, above all beside sub-solvers, which start anew so often
// that they err by less than their tolerance.
static const double loosest_beside_mesh = 2e-3, loosest_beside_whole = 3e-4;

// Where the run's error is taken as the whole difference, the steps of the companion must err little: up to
// twice as much as the run beside an explicit coupling; a few times as much beside a finer mesh, which would
// otherwise cost as much as the run, and more at a tight tolerance, where the mesh causes the error.
// Elsewhere they err by a multiple, of which the run's error is a part. At a tight tolerance integrators
// have a high order, and each end of a macro step cuts one of their steps short: macro steps are then four
// times as long.
static looser looser_of(const bough_scene *scene) {
    double rtol = bough_scene_loosest_rtol(scene);
    bool finer = some_finer(scene);
    if (usual_ratio(scene) == 1) {
        double times = has_fixed_steps(scene) ? fmax(3, tight_enough / rtol) : 3;
        return (looser){times, 1.5, 2, finer ? loosest_beside_whole : loosest};
    }
    if (finer) return (looser){fmax(12, fmin(100, 1e-6 / rtol)), 2, 2, fmax(loosest_beside_mesh, rtol)};
    return bough_coarser_steps_alone(scene) ? (looser){30, 2, 4, loosest} : (looser){10, 2, 2, loosest};
}

double bough_coarser_time_ratio(const bough_scene *scene) {
    if (bough_coarser_is_loose(scene)) return bough_finer_time_ratio();
    return fmax(usual_ratio(scene), looser_of(scene).step < 2 ? 0.6 : 0);
}

double bough_finer_time_ratio(void) { return 4 / 3.0; } // half the steps, at order 2

double bough_finer_air_ratio(const bough_scene *scene) { return holds_loads(scene) ? 2 : 4 / 3.0; } // order 1

static bool samples_fit(double rate, double macro_step) {
    return bough_master_multiple(1 / rate, macro_step) > 0;
}

// Inputs are set for one macro step of the run, and the rate of a controller is not changed.
static bool steps_fit(const bough_scene *scene, double step) {
    bool air = !scene->aero.node || samples_fit(scene->aero.rate, step);
    bool control = !scene->control.node || samples_fit(scene->control.rate, step);
    return scene->n_input == 0 && air && control;
}

// Twice the rate, with `shorter` in macro steps of half the length where it needs them; or as it is.
static void double_rate(const bough_scene *scene, bool shorter, bough_scene *to) {
    double rate = 2 * scene->aero.rate, step = scene->simulation.macro_step;
    bool fits = samples_fit(rate, step);
    if (!fits && !(shorter && steps_fit(scene, step / 2))) return;
    to->aero.rate = rate;
    if (!fits) to->simulation.macro_step = step / 2;
}

// Half the rate; beside a finer mesh twice the rate where macro steps allow it: a coarser one can hide in the
// difference what the mesh shows. Loads that are held between samples and meshes of few segments err most:
// for them macro steps of half the length make room, but not for modal bodies, which err little by theirs.
static void change_rate(const bough_scene *scene, bool finer, bough_scene *to) {
    bool shorter = holds_loads(scene);
    for (int i = 0; i < scene->n_body; i++)
        shorter = shorter || (scene->body[i].fidelity == BOUGH_SCENE_ROD &&
                              own_segments(scene, i, false) > scene->body[i].rod.n_segment);
    to->aero.rate = scene->aero.rate / 2;
    if (scene->aero.node && finer) double_rate(scene, shorter, to);
}

// When the loads show a jump from a time on, held constant between samples.
static double shown_at(double time, double rate) { return (floor(time * rate + 1e-6) + 1) / rate; }

static const double little_late = 0.1; // samples

// How much later the companion has a jump of the air. Both solutions may show it from the same sample on and
// err alike; then it is delayed beyond that one.
static double delay(const bough_scene *scene, const bough_scene *to, double start, double end) {
    double rate = scene->aero.rate, time = (start + end) / 2, shown = shown_at(time, rate);
    bool alike = fabs(shown_at(time, to->aero.rate) - shown) * rate < 1e-6;
    return alike && (shown - time) * rate > little_late ? (1 + 1e-6) * (shown - start) : 0;
}

static void delay_jumps(bough_arena *arena, const bough_simulation *run, bough_scene *to) {
    const bough_scene *scene = run->scene;
    double period = 1 / scene->aero.rate, *ramp = to->aero.ramp;
    if (ramp[0] > 0 && ramp[1] - ramp[0] < period) {
        double late = delay(scene, to, ramp[0], ramp[1]);
        ramp[0] += late, ramp[1] += late;
    }
    bough_scene_wind_table *x = &to->aero.wind.table;
    if (x->n_time == 0) return;
    x->time = bough_arena_copy(arena, x->time, (size_t)x->n_time * sizeof *x->time);
    const bough_wind *wind = bough_rotor_wind(bough_aero_link_rotor(run->aero));
    for (int k = bough_wind_jump(wind, period, 0); k >= 0; k = bough_wind_jump(wind, period, k + 1)) {
        double late = delay(scene, to, x->time[k], x->time[k + 1]);
        bool room = k + 2 == x->n_time || x->time[k + 1] + late < x->time[k + 2];
        for (int i = k; room && i < k + 2; i++) x->time[i] += late;
    }
}

static void lengthen_macro_step(double times, bough_scene *to) {
    double step = times * to->simulation.macro_step;
    if (!steps_fit(to, step)) return;
    to->simulation.macro_step = step;
    to->simulation.halves = true;
}

// The loosest tolerance and the longest step of the bodies' sub-solvers, and whether all are by BDF.
static bough_scene_solver all_sub_solvers(const bough_scene *scene) {
    bough_scene_solver all = {0};
    bool limited = true;
    all.by_bdf = !scene->aero.node && !scene->control.node; // whose samples would start it anew
    for (int i = 0; i < scene->n_body; i++) {
        if (!bough_scene_has_mesh(&scene->body[i])) continue;
        const bough_scene_solver *micro = bough_scene_micro(scene, &scene->body[i]);
        limited = limited && micro->step > 0;
        all.by_bdf = all.by_bdf && (micro->solver == BOUGH_CVODE_BDF || micro->solver == BOUGH_IDA);
        all.rtol = fmax(all.rtol, micro->rtol);
        all.step = fmax(all.step, micro->step);
    }
    if (!(all.rtol > 0)) return scene->simulation.master;
    if (!limited) all.step = 0;
    return all;
}

bool bough_coarser_is_too_large(const bough_scene *scene) {
    int states = 0, most = bough_integrator_find(scene->simulation.master.solver)->most_states;
    for (int i = 0; i < scene->n_body; i++) {
        const bough_scene_body *b = &scene->body[i];
        if (b->fidelity == BOUGH_SCENE_ROD) states += BOUGH_ROD_STATES * b->rod.n_segment * b->repeat;
    }
    return most > 0 && states > most;
}

static void make_one_system(bough_scene *to) {
    bough_scene_simulation *x = &to->simulation;
    x->step_control.tolerance = 0;
    if (is_one_system(to)) {
        if (has_fixed_steps(to) || bough_coarser_is_too_large(to)) x->master.solver = BOUGH_AUTOMATIC;
        return;
    }
    bough_scene_solver sub_solvers = all_sub_solvers(to);
    x->master.solver = BOUGH_AUTOMATIC;
    x->master.by_bdf = sub_solvers.by_bdf;
    x->master.rtol = sub_solvers.rtol;
    x->master.step = sub_solvers.step;
    x->coupling.scheme = bough_scheme_index(BOUGH_SCHEME_DEFAULT);
}

// Larger tolerances cannot be multiplied by ten.
static const double loose = 5e-3;

double bough_scene_loosest_rtol(const bough_scene *scene) {
    return is_one_system(scene) ? scene->simulation.master.rtol : all_sub_solvers(scene).rtol;
}

bool bough_coarser_is_loose(const bough_scene *scene) { return bough_scene_loosest_rtol(scene) > loose; }

// A tenth of a loose tolerance, and two steps at least where the run may take one.
static void tighten_steps(bough_scene *to) {
    bough_scene_simulation *x = &to->simulation;
    x->master.rtol = fmin(x->master.rtol / 10, loose / 5);
    x->master.step /= 2;
    if (steps_fit(to, x->macro_step / 2)) x->macro_step /= 2;
}

static void lengthen_steps(const bough_scene *scene, bough_scene *to) {
    bough_scene_simulation *x = &to->simulation;
    make_one_system(to);
    if (bough_coarser_is_loose(scene)) {
        tighten_steps(to);
        return;
    }
    looser by = looser_of(scene);
    if (bough_coarser_steps_alone(scene) && bough_scene_suits_radau(scene)) x->master.solver = BOUGH_RADAU5;
    x->master.rtol = fmin(by.rtol * x->master.rtol, by.most);
    x->master.step *= by.step;
    if (x->master.step == 0 && by.step < by.macro_step) x->master.step = by.step * x->macro_step;
    x->master.coarse = true;
    lengthen_macro_step(by.macro_step, to);
}

static const double largest_rtol = 1e-4; // of the finer solution

enum { MOST_STEPS = 1000 }; // of the finer solution in a macro step

// The finer solution follows vibrations by the Rosenbrock method: IDA takes up to twenty times as long, and
// the tangents of Radau's method as many evaluations as there are states.
static void follow_vibrations(bough_scene *to) {
    to->simulation.master.solver = BOUGH_ROSENBROCK;
    to->simulation.master.most_steps = MOST_STEPS;
}

// A run whose tolerance allows longer steps takes one in a macro step.
static void shorten_steps(bough_scene *to, double tighter, double least_rtol) {
    bough_scene_solver *master = &to->simulation.master;
    double macro_step = to->simulation.macro_step;
    make_one_system(to);
    master->rtol = fmin(fmax(tighter * master->rtol, least_rtol), largest_rtol);
    master->step = 0.5 * (master->step > 0 ? fmin(master->step, macro_step) : macro_step);
}

// -- all ------------------------------------------------------------------------------------------

bough_scene *bough_coarser_scene(bough_arena *arena, const bough_scene *scene, int parts) {
    bough_scene *to = bough_scene_copy(arena, scene);
    copy_loads(arena, scene, to);
    // a copy for an analysis of the mesh alone has neither steps nor a coupling
    bool whole = parts != BOUGH_COARSER_MESH && usual_ratio(scene) == 1;
    if (parts & BOUGH_COARSER_MESH) change_segments(scene, whole, to);
    if (parts & BOUGH_COARSER_AIR) change_rate(scene, parts & BOUGH_COARSER_MESH && some_finer(scene), to);
    if (parts & BOUGH_COARSER_TIME) lengthen_steps(scene, to);
    if (parts & BOUGH_FINER_TIME) shorten_steps(to, 0.1, 0);
    if (parts & BOUGH_FINER_AIR) double_rate(scene, true, to);
    if (parts & BOUGH_FINEST_TIME) shorten_steps(to, 0.01, 1e-6), follow_vibrations(to);
    to->simulation.error_estimate = BOUGH_SCENE_NO_ESTIMATE;
    to->simulation.error_bound = 0;
    to->simulation.error_shares = false;
    to->control.copied = true;
    return to;
}

bough_scene *bough_coarser_scene_beside(bough_arena *arena, const bough_simulation *run, int parts) {
    bough_scene *to = bough_coarser_scene(arena, run->scene, parts);
    if (run->aero) to->aero.wind.def.box = bough_rotor_wind(bough_aero_link_rotor(run->aero))->box;
    if (run->aero && parts & BOUGH_COARSER_AIR && holds_loads(to)) delay_jumps(arena, run, to);
    return to;
}

bough_status bough_other_run_build(bough_arena *arena, const bough_simulation *run, int parts,
                                   bough_other_run *other) {
    bough_simulation *simulation;
    *other = (bough_other_run){.channels = bough_channels_start(arena)};
    const bough_scene *scene = bough_coarser_scene_beside(arena, run, parts);
    BOUGH_TRY(bough_simulation_build_on(arena, scene, run->pool, run, &simulation));
    BOUGH_TRY(bough_simulation_channels(simulation, &other->channels));
    other->value = bough_arena_doubles(arena, (size_t)other->channels.count + 1);
    other->simulation = simulation;
    simulation->master->compared = true; // as the run beside it
    return bough_ok();
}

// CPU time of an evaluation on a processor of 2023, within a factor of two [µs]: fixed, for each state, for
// each coordinate of the tree, for each modal body.
static const double of_call = 0.7, of_state = 0.015, of_coordinate = 0.5, of_modal_body = 7;

static double work_of_tree(const bough_simulation *s) { return of_call + of_coordinate * s->tree->n_q; }

static double work_of_whole(const bough_simulation *s) {
    double work = work_of_tree(s) + of_state * s->assembly->n_state;
    for (int i = 0; i < s->n_beam; i++) work += s->beam[i].modal ? of_modal_body : 0;
    return work;
}

// The tree is member 0; −1: the whole.
static double work_of_member(const bough_simulation *s, int i) {
    if (i < 0) return work_of_whole(s);
    return i == 0 ? work_of_tree(s) : of_call + of_state * s->assembly->member[i]->system.n_state;
}

// Evaluations for the tangents of closed loops, by central differences.
static double evaluations_of_tangent(const bough_simulation *s) {
    return s->tree->n_closures > 0 ? 2 * (s->tree->n_q + s->tree->n_v) : 0;
}

double bough_simulation_work(const bough_simulation *s) {
    const bough_assembly *a = s->assembly;
    const bough_member *whole = bough_scheme_whole(s->master->coupling);
    double work = 0;
    for (int i = whole ? -1 : 0; i < a->n_member; i++) {
        bough_statistics own = bough_member_statistics(i < 0 ? whole : a->member[i]);
        work += (double)(own.derivatives + own.factorisations) * work_of_member(s, i);
        if (i <= 0) work += (double)own.jacobians * evaluations_of_tangent(s) * work_of_tree(s);
    }
    return work;
}

double bough_other_run_work_of_step(const bough_other_run *other) {
    enum { EVALUATIONS = 4 }; // of the Rosenbrock method
    return EVALUATIONS * work_of_whole(other->simulation);
}

void bough_other_run_limit(bough_other_run *other, int most_steps) {
    const bough_integrator *x = &bough_scheme_whole(other->simulation->master->coupling)->integrator;
    x->ops->limit(x->self, most_steps);
}

void bough_other_run_sample(bough_other_run *other) {
    bough_simulation_update(other->simulation);
    bough_channels_sample(&other->channels, other->simulation->master->time, other->value);
}

bough_status bough_other_run_step(bough_other_run *other, const bough_simulation *run) {
    size_t size = (size_t)run->scene->n_input * sizeof(double);
    if (run->input) memcpy(other->simulation->input, run->input, size);
    return bough_step(other->simulation->master);
}
