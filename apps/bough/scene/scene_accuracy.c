// Settings that follow from `simulation.accuracy` where a scene does not name them: methods, tolerances,
// steps, the rate of the air and segments. Each law has the order of the error that it limits; the factors
// are measured on the turbines of apps/turbine and on random scenes (docs/coupling.md).
#include "apps/bough/scene/scene_internal.h"

static const double usual = 0.005; // accuracy for which the following values are given

// -- tolerances -----------------------------------------------------------------------------------

// Accuracy over rtol: the largest error of any channel is at most this many rtol in nine of ten random
// scenes.
static const double whole_error = 100; // of all bodies as one system
static const double rod_error = 50;    // of a rod with a method of its own
static const double tree_error = 5000; // of the tree beside the rods, cheap and restarted in every macro step
static const double fine_rtol = 1e-6;  // below it the high orders of BDF take less time
static const double usual_step = 5e-3; // longest one of a rod's own method [s]; order 2

static bool is_named(const bough_node *map, const char *key) { return bough_node_find(map, key) != NULL; }

static void choose_micro(double accuracy, bough_scene_solver *micro) {
    if (!is_named(micro->node, "rtol")) micro->rtol = accuracy / rod_error;
    if (!is_named(micro->node, "step")) micro->step = usual_step * sqrt(accuracy / usual);
}

// Five free bodies. With more, the dense matrices of Radau IIA take over twice the time of the default
// method.
enum { FEW_STATES = 65 };

// Whether the scene has only rigid bodies, in closed loops or without samples and contacts, few enough for
// Radau IIA: at equal tolerance it takes half the time of the other methods and errs by a tenth. Its steps
// are long and hardly ever end near a singular position, from which errors of BDF can let a linkage continue
// the other way; order 5 conserves the momentum of a rotating free body better.
bool bough_scene_suits_radau(const bough_scene *s) {
    int states = 0;
    bool jumps = s->aero.node || s->control.node;
    for (int i = 0; i < s->n_body; i++) {
        const bough_scene_body *b = &s->body[i];
        if (b->fidelity != BOUGH_SCENE_RIGID || b->joint.kind < 0)
            return false; // reported as an unknown kind
        int own = bough_joint_n_coordinates(b->joint.kind) + bough_joint_n_speeds(b->joint.kind);
        states += b->repeat * own;
        jumps = jumps || b->joint.spring.stop_stiffness > 0;
    }
    if (s->n_connector[BOUGH_SCENE_CLOSURE] > 0)
        return states <= bough_integrator_find(BOUGH_RADAU5)->most_states;
    return states <= FEW_STATES && !jumps;
}

// Whether the scheme integrates all bodies as one system; false after an error in its name.
static bool is_whole(const bough_scene *s) {
    const bough_scheme *scheme = bough_scheme_at(s->simulation.coupling.scheme);
    return scheme && scheme->one_system;
}

static void choose_master(bough_scene *scene) {
    bough_scene_simulation *s = &scene->simulation;
    bough_scene_solver *master = &s->master;
    bool whole = is_whole(scene);
    if (!is_named(master->node, "rtol")) master->rtol = s->accuracy / (whole ? whole_error : tree_error);
    if (whole && !is_named(master->node, "solver")) {
        master->solver = bough_scene_suits_radau(scene) ? BOUGH_RADAU5
                         : master->rtol < fine_rtol     ? BOUGH_IDA
                                                        : BOUGH_AUTOMATIC;
    }
}

// -- mesh -----------------------------------------------------------------------------------------

// Segments over eight, since eight are computed at a time. The force at a rod's root has order 2.
static const double usual_lanes = 4;

// A blade bends in shorter waves where it is slender: three quarters as many graded segments are as accurate.
static const double slender = 0.1, blade_grading = 0.2, blade_lanes = 3;

// Whether the bending stiffness of the outer quarter is small compared with that at the root.
static bool is_blade(const bough_scene_rod *rod) {
    const bough_scene_structure *s = &rod->structure;
    double outer = 0, root = 0;
    for (int i = 0; i < s->n_station; i++) {
        const double *stiffness = s->station[i].def.stiffness;
        double bending = fmin(stiffness[15], stiffness[18]); // about x and y
        if (i == 0) root = bending;
        if (s->station[i].def.position.z >= 0.75 * s->length) outer = fmax(outer, bending);
    }
    return s->n_station > 1 && outer < slender * root;
}

static int usual_segments(const bough_scene *s, bool graded) {
    double lanes = graded ? blade_lanes : usual_lanes;
    return 8 * (int)ceil(lanes * sqrt(usual / s->simulation.accuracy) - 1e-9);
}

static void choose_segments(bough_scene *s) {
    for (int i = 0; i < s->n_body; i++) {
        bough_scene_rod *rod = &s->body[i].rod;
        if (!rod->node || is_named(rod->node, "segments")) continue;
        int pieces = s->body[i].fidelity == BOUGH_SCENE_SEGMENTED_MODAL ? s->body[i].modal.pieces : 0;
        if (!is_named(rod->node, "grading") && pieces == 0 && is_blade(rod)) rod->grading = blade_grading;
        int usual_number = usual_segments(s, rod->grading > 0);
        rod->n_segment = usual_number > pieces ? usual_number : pieces;
    }
}

// -- times ----------------------------------------------------------------------------------------

static const double usual_macro_step = 20e-3; // [s]
static const double fewest_steps = 100;       // of a run
static const double tip_speed = 80;           // of any turbine at rated power [m/s]
static const double usual_arc = 0.022; // of a blade between two samples of the air, at that speed [rad]

// The error of a step or of a sample has order 3.
static double scale_of_time(const bough_scene *s) { return cbrt(s->simulation.accuracy / usual); }

// Longest period between samples of the air [s]; 0 without blades.
static double air_period(const bough_scene *s) {
    const bough_scene_aero_blade *blade = &s->aero.blade;
    if (s->aero.node == NULL || blade->n_station == 0) return 0;
    double radius = s->aero.hub_radius + blade->station[blade->n_station - 1].def.span;
    return usual_arc * radius / tip_speed * scale_of_time(s);
}

enum { DURATION, INTERVAL, AIR, CONTROL, PERIODS };

// The periods that the scene names [s]; others are 0.
static void take_periods(const bough_scene *s, double period[PERIODS]) {
    const bough_scene_simulation *simulation = &s->simulation;
    period[DURATION] = simulation->duration;
    period[INTERVAL] = is_named(simulation->output.node, "interval") ? simulation->output.interval : 0;
    period[AIR] = s->aero.node && s->aero.rate > 0 ? 1 / s->aero.rate : 0;
    period[CONTROL] = s->control.node && s->control.rate > 0 ? 1 / s->control.rate : 0;
}

bool bough_scene_step_fits(const bough_scene *s, double macro_step) {
    double period[PERIODS];
    take_periods(s, period);
    for (int i = 0; i < PERIODS; i++) {
        if (!bough_scene_is_multiple(period[i], macro_step)) return false;
    }
    return true;
}

// 1, 1.25, 2, 2.5 or 5 times a power of ten, at most `limit`.
static double round_step(double limit) {
    static const double round[] = {5, 2.5, 2, 1.25, 1};
    double unit = pow(10, floor(log10(limit) + 1e-9)), multiple = limit / unit * (1 + 1e-9);
    int i = 0;
    while (i < 4 && multiple < round[i]) i++;
    return round[i] * unit;
}

static const double much_shorter = 0.25; // than the limit: then a step need not be round

// The longest macro step up to `limit` that fits: a round number, or else a fraction of the shortest period.
static double longest_step(const bough_scene *s, double limit) {
    for (double step = round_step(limit); step > much_shorter * limit; step = round_step(0.9 * step)) {
        if (bough_scene_step_fits(s, step)) return step;
    }
    double period[PERIODS], shortest = (double)INFINITY;
    take_periods(s, period);
    for (int i = 0; i < PERIODS; i++) {
        if (period[i] > 0) shortest = fmin(shortest, period[i]);
    }
    for (double parts = ceil(shortest / limit); shortest / parts > 1e-3 * limit; parts++) {
        if (bough_scene_step_fits(s, shortest / parts)) return shortest / parts;
    }
    return round_step(limit);
}

static void choose_times(bough_scene *s) {
    bough_scene_simulation *simulation = &s->simulation;
    double air = air_period(s);
    if (!is_named(simulation->node, "macro_step")) {
        double limit = usual_macro_step * scale_of_time(s);
        if (simulation->duration > 0) limit = fmin(limit, simulation->duration / fewest_steps);
        if (air > 0 && !is_named(s->aero.node, "rate")) limit = fmin(limit, air);
        simulation->macro_step = longest_step(s, limit);
    }
    if (air > 0 && !is_named(s->aero.node, "rate") && simulation->macro_step > 0) {
        s->aero.rate = 1 / (simulation->macro_step * fmax(1, floor(air / simulation->macro_step + 1e-9)));
    }
}

// -- steps ----------------------------------------------------------------------------------------

// Tolerances neglect vibrations that are small compared with the size of a rod. If steps are longer than a
// part of their period, the run and its companion both damp them, and the estimate of the error misses them.
static const double second_wave = 4.694; // wave number of a clamped rod's second bending over its length
static const double parts_of_period = 10;

// Period of the second bending mode in the softer direction, by means over the span [s].
static double second_period(const bough_scene_rod *rod) {
    const bough_scene_structure *s = &rod->structure;
    double bending = 0, mass = 0;
    for (int i = 0; i < s->n_station; i++) {
        const bough_section_station *d = &s->station[i].def;
        double from = s->station[i > 0 ? i - 1 : 0].def.position.z;
        double to = s->station[i + 1 < s->n_station ? i + 1 : i].def.position.z;
        double part = s->n_station == 1 ? 1 : 0.5 * (to - from) / s->length;
        bending += part * fmin(d->stiffness[15], d->stiffness[18]);
        mass += part * d->mass;
    }
    double wave = second_wave / s->length;
    return 2 * BOUGH_PI / (wave * wave) * sqrt(mass / bending);
}

// Limits the steps of all bodies as one system, to no less than the usual step of a rod's own method.
static void limit_step(bough_scene *s) {
    bough_scene_solver *master = &s->simulation.master;
    bool reads_step = master->solver == BOUGH_ROSENBROCK || master->solver == BOUGH_AUTOMATIC;
    if (!is_whole(s) || !reads_step || is_named(master->node, "step")) return;
    double step = (double)INFINITY, least = usual_step * sqrt(s->simulation.accuracy / usual);
    for (int i = 0; i < s->n_body; i++) {
        if (!bough_scene_has_mesh(&s->body[i])) continue;
        double part = second_period(&s->body[i].rod) / parts_of_period * scale_of_time(s);
        step = fmin(step, fmax(part, least));
    }
    if (step < s->simulation.macro_step) master->step = step;
}

// -- what errors to expect ------------------------------------------------------------------------

static void expect_mesh(const bough_scene *s, bough_scene_expectation *e) {
    for (int i = 0; i < s->n_body; i++) {
        const bough_scene_rod *rod = &s->body[i].rod;
        if (!bough_scene_has_mesh(&s->body[i])) continue;
        double coarser = (double)usual_segments(s, rod->grading > 0) / rod->n_segment;
        if (coarser * coarser <= e->error[0]) continue;
        e->error[0] = coarser * coarser;
        e->named[0] = is_named(rod->node, "segments");
    }
}

// Fixed steps err at order 2 whatever the accuracy; the tolerance limits the error of all others.
static void expect_time(const bough_scene *s, bough_scene_expectation *e) {
    const bough_scene_simulation *simulation = &s->simulation;
    bool whole = is_whole(s), fixed = whole && simulation->master.solver == BOUGH_GENERALIZED_ALPHA;
    const bough_scene_solver *solver = whole ? &simulation->master : &simulation->micro;
    double step = solver->step > 0 ? fmin(solver->step, simulation->macro_step) : simulation->macro_step;
    double error =
        fixed ? usual * pow(step / usual_step, 2) : solver->rtol * (whole ? whole_error : rod_error);
    e->error[2] = error / simulation->accuracy;
    e->named[2] = fixed || is_named(solver->node, "rtol");
}

bough_scene_expectation bough_scene_expect_errors(const bough_scene *s) {
    bough_scene_expectation e = {0};
    double air = air_period(s);
    expect_mesh(s, &e);
    if (air > 0) e.error[1] = pow(1 / (s->aero.rate * air), 3);
    e.named[1] = air > 0 && (is_named(s->aero.node, "rate") || is_named(s->simulation.node, "macro_step"));
    expect_time(s, &e);
    return e;
}

void bough_scene_apply_accuracy(bough_scene *s) {
    if (!(s->simulation.accuracy > 0)) s->simulation.accuracy = usual; // after an error
    choose_master(s);
    choose_micro(s->simulation.accuracy, &s->simulation.micro);
    for (int i = 0; i < s->n_body; i++) {
        if (s->body[i].micro.node) choose_micro(s->simulation.accuracy, &s->body[i].micro);
    }
    choose_segments(s);
    choose_times(s);
    limit_step(s);
}
