#include "apps/bough/model/aero_link.h"

struct bough_aero_link {
    bough_simulation *simulation;
    bough_rotor *rotor;
    int n_blade, n_vertex;
    const bough_beam **beam;    // (n_blade)
    bough_aero_signal **signal; // (n_blade)
    bough_aero_motion *motion;
    // Two evaluations: of the last sample and of the next one. Both use the memory of the first.
    bough_rotor_data data[2];
    double time[2];   // of each evaluation [s]; NAN: not evaluated
    double factor[2]; // of the ramp at that time
    int shown;        // the evaluation of the last sample
    int found;        // the latest evaluation; −1: none
    bough_vec3 hub;   // at the start, ground axes [m]
    bool started;
};

// -- build ----------------------------------------------------------------------------------------

static bough_status same_mesh(const bough_aero_link *l, const bough_beam *beam) {
    const bough_beam *first = l->beam[0];
    if (beam->def.n_segment == first->def.n_segment) return bough_ok();
    bough_status status = bough_fail(
        BOUGH_INVALID,
        "blades %s and %s have %d and %d segments; the aerodynamics needs the same mesh on all blades",
        first->body->name, beam->body->name, first->def.n_segment, beam->def.n_segment);
    const bough_node *segments = bough_node_find(beam->body->rod.node, "segments");
    return bough_scene_blame(segments ? segments : beam->body->rod.node, "rod.segments", status);
}

static bough_status take_blades(bough_arena *arena, bough_aero_link *l) {
    l->n_blade = l->simulation->scene->turbine.n_blade;
    l->beam = bough_arena_take(arena, (size_t)l->n_blade * sizeof *l->beam);
    l->signal = bough_arena_take(arena, (size_t)l->n_blade * sizeof *l->signal);
    for (int b = 0; b < l->n_blade; b++) {
        l->beam[b] = bough_simulation_blade(l->simulation, b);
        BOUGH_TRY(same_mesh(l, l->beam[b]));
        l->signal[b] = bough_aero_signal_build(arena, l->simulation, l->beam[b]);
    }
    l->n_vertex = l->beam[0]->def.n_segment + 1;
    l->motion = bough_aero_motion_build(arena, l->simulation, l->beam);
    return bough_ok();
}

// Length of the undeformed axis from the root to z, which is z itself for a straight blade.
static double arc_length(const bough_rod_def *mesh, int n_vertex, double z) {
    int i = 0;
    while (i < n_vertex - 2 && z > mesh->position[i + 1].z) i++;
    double from = mesh->position[i].z, to = mesh->position[i + 1].z;
    double excess = mesh->span[i] - from, next = mesh->span[i + 1] - to;
    return z + excess + (next - excess) * bough_clamp((z - from) / (to - from), 0, 1);
}

// The scene's polars as the rotor has them.
static const bough_polar_def *take_polars(bough_arena *arena, const bough_scene_polars *polars) {
    bough_polar_def *polar = bough_arena_take(arena, (size_t)polars->n_polar * sizeof *polar);
    for (int k = 0; k < polars->n_polar; k++) {
        const bough_scene_polar *from = &polars->polar[k];
        double *row = bough_arena_doubles(arena, 4 * (size_t)from->n_row);
        for (int i = 0; i < from->n_row; i++) {
            const bough_scene_polar_row *r = &from->row[i];
            const double values[4] = {r->alpha * (1 / BOUGH_DEGREE), r->cl, r->cd, r->cm};
            memcpy(row + 4 * i, values, sizeof values);
        }
        polar[k] = (bough_polar_def){from->n_row, row, from->indicial};
    }
    return polar;
}

static double rotor_radius(const bough_scene_aero *aero) {
    return aero->hub_radius + aero->blade.station[aero->blade.n_station - 1].def.span;
}

// The standard wind with defaults for what the scene does not give.
static bough_wind_iec_def standard_wind(const bough_scene *scene) {
    const bough_wind_def *wind = &scene->aero.wind.def;
    bough_wind_iec_def def = wind->iec;
    def.speed = wind->speed;
    def.exponent = wind->exponent;
    def.height = wind->reference_height;
    if (!(def.diameter > 0)) def.diameter = 2 * rotor_radius(&scene->aero);
    if (!(def.width > 0)) def.width = 1.15 * def.diameter;
    if (!(def.period > 0)) def.period = fmax(scene->simulation.duration, 600);
    return def;
}

bool bough_aero_link_turbulence(const bough_scene *scene, bough_wind_iec_def *def) {
    const bough_scene_wind *wind = &scene->aero.wind;
    if (scene->aero.node == NULL || wind->kind != BOUGH_SCENE_WIND_IEC) return false;
    *def = standard_wind(scene);
    return bough_wind_iec_is_turbulent(def->condition);
}

static bough_wind_def wind_def(const bough_scene *scene) {
    const bough_scene_wind *wind = &scene->aero.wind;
    static const bough_wind_shear shears[BOUGH_SCENE_WIND_IEC + 1] = {
        [BOUGH_SCENE_WIND_POWER] = BOUGH_WIND_POWER,
        [BOUGH_SCENE_WIND_LOG] = BOUGH_WIND_LOG,
    };
    static const bough_wind_source sources[] = {
        [BOUGH_SCENE_WIND_WND] = BOUGH_WIND_HUB_FILE,
        [BOUGH_SCENE_WIND_BTS] = BOUGH_WIND_BOX_FILE,
        [BOUGH_SCENE_WIND_IEC] = BOUGH_WIND_STANDARD,
    };
    bough_wind_def def = wind->def;
    def.shear = shears[wind->kind];
    def.source = sources[wind->kind];
    def.n_time = wind->table.n_time;
    def.time = wind->table.time;
    def.speed_at_time = wind->table.speed;
    def.until = scene->simulation.duration;
    def.veer /= 100;
    if (!(def.reference_height > 0)) def.reference_height = 90;
    if (wind->kind == BOUGH_SCENE_WIND_IEC) def.iec = standard_wind(scene);
    return def;
}

bough_vec3 bough_aero_link_foot(const bough_simulation *s) {
    const bough_scene_tower *tower = &s->scene->aero.tower;
    if (tower->body_name == NULL) return bough_v3(0, 0, 0);
    bough_vec3 foot = bough_body_pose(s, tower->body).position;
    return bough_v3(foot.x, foot.y, 0);
}

static bough_rotor_def rotor_def(bough_arena *arena, const bough_aero_link *l) {
    const bough_scene_aero *aero = &l->simulation->scene->aero;
    const bough_rod_def *mesh = &l->beam[0]->def;
    size_t n_station = (size_t)aero->blade.n_station, n_vertex = (size_t)l->n_vertex;
    bough_station_def *station = bough_arena_take(arena, n_station * sizeof *station);
    bough_mat3 *rotation = bough_arena_take(arena, n_vertex * sizeof *rotation);
    for (size_t k = 0; k < n_station; k++) {
        station[k] = aero->blade.station[k].def;
        station[k].span = arc_length(mesh, l->n_vertex, station[k].span);
    }
    for (size_t i = 0; i < n_vertex; i++) rotation[i] = bough_rotation_matrix(mesh->rotation[i]);
    bough_rotor_def def = bough_rotor_def_default();
    def.n_blade = l->n_blade;
    def.density = aero->air_density;
    def.hub_radius = aero->hub_radius;
    def.skew = aero->induction.skew != 0;
    def.slopes = aero->hold != BOUGH_SCENE_CONSTANT;
    def.induction = aero->induction.options;
    def.induction.axial_drag = def.induction.tangential_drag = aero->induction.drag;
    def.inflow = aero->induction.inflow;
    def.smooth_polars = aero->interpolation == BOUGH_SCENE_POLARS_SMOOTH;
    def.pitching_moment = aero->pitching_moment;
    def.stall = (bough_stall_kind)aero->dynamic_stall;
    def.wind = wind_def(l->simulation->scene);
    if (aero->tower.node != NULL) def.tower = aero->tower.def;
    def.tower.base = bough_aero_link_foot(l->simulation);
    def.n_polar = aero->polars.n_polar;
    def.polar = take_polars(arena, &aero->polars);
    def.n_station = aero->blade.n_station;
    def.station = station;
    def.n_vertex = l->n_vertex;
    def.vertex_span = mesh->span;
    def.vertex_position = mesh->position;
    def.vertex_rotation = rotation;
    return def;
}

// A box must reach over the undeformed rotor, and pass the hub during the whole run.
static bough_status check_reach(bough_aero_link *l) {
    const bough_scene *scene = l->simulation->scene;
    const bough_wind *wind = bough_rotor_wind(l->rotor);
    double passes[2];
    bough_vec3 hub = l->hub = bough_body_pose(l->simulation, scene->turbine.rotor).position;
    double radius = rotor_radius(&scene->aero);
    bough_wind_passes(wind, hub, passes);
    if (passes[0] > 1e-9 || passes[1] < wind->def.until * (1 - 1e-9))
        return bough_fail(BOUGH_INVALID, "the box of %s passes the hub from %.4g to %.4g s only, of %.4g s",
                          scene->aero.wind.def.file, passes[0], passes[1], wind->def.until);
    if (bough_wind_covers(wind, hub, radius)) return bough_ok();
    return bough_fail(BOUGH_INVALID, "the box of %s is too small for a rotor of %g m radius at %g m",
                      scene->aero.wind.def.file ? scene->aero.wind.def.file : "turbulence", radius, hub.z);
}

// -- sample ---------------------------------------------------------------------------------------

// Factor of the ramp at t. A jump is sampled at its time, up to rounding.
static double ramp_factor(const double ramp[2], double t) {
    bool jump = ramp[1] <= ramp[0];
    return bough_ramp_factor(ramp[0], ramp[1], jump ? t * (1 + 1e-12) : t);
}

static bough_aero_fresh fresh_loads(const bough_aero_link *l, int b) {
    const bough_rotor_data *data = &l->data[l->found];
    size_t n = (size_t)l->n_vertex, blade = (size_t)b;
    bool slopes = l->simulation->scene->aero.hold != BOUGH_SCENE_CONSTANT;
    return (bough_aero_fresh){.load = data->load + 6 * n * blade,
                              .line = data->line + 12 * (n - 1) * blade,
                              .slope = slopes ? data->slope + BOUGH_SLOPES * n * blade : NULL,
                              .factor = l->factor[l->found]};
}

// The time over which a signal is defined.
typedef struct interval {
    double start, span; // [s]
} interval;

// An evaluation of the rotor.
typedef struct evaluation {
    bough_aero_link *link;
    const bough_rotor_motion *motion;
    bough_rotor_data *data;
    void (*move)(bough_aero_motion *m, int blade); // NULL: it is that of the last evaluation of `data`
    const interval *next;                          // of the blades' signals; NULL: they are not set
} evaluation;

// The wind at each blade, then its inductions.
static void approach_blade(void *self, int k) {
    const evaluation *e = self;
    const bough_aero_link *l = e->link;
    if (k < l->n_blade) {
        if (!e->move) return;
        e->move(l->motion, k);
        bough_rotor_approach(l->rotor, e->motion, k, e->data);
        return;
    }
    bough_pool_await(l->simulation->pool, k - l->n_blade);
    bough_rotor_induce(l->rotor, e->motion, k - l->n_blade, e->data);
}

// The loads on each blade, then its signal up to the next sample.
static void load_blade(void *self, int k) {
    const evaluation *e = self;
    const bough_aero_link *l = e->link;
    int b = k % l->n_blade;
    if (k < l->n_blade) {
        bough_rotor_load(l->rotor, e->motion, b, e->data);
        return;
    }
    bough_pool_await(l->simulation->pool, b);
    bough_aero_signal_follow(l->signal[b], fresh_loads(l, b), bough_aero_motion_course(l->motion, b),
                             e->next->start, e->next->span);
}

// Evaluates the rotor; `move` sets the motion of a blade, NULL: it has not changed.
static void evaluate_rotor(bough_aero_link *l, int to, void (*move)(bough_aero_motion *, int),
                           const interval *next) {
    bough_pool *pool = l->simulation->pool;
    evaluation e = {l, bough_aero_motion_found(l->motion), &l->data[to], move, next};
    l->time[to] = e.motion->time;
    l->factor[to] = ramp_factor(l->simulation->scene->aero.ramp, e.motion->time);
    l->found = to;
    e.data->skips_slopes = next == NULL; // only signals need them
    e.data->same_motion = move == NULL;
    bough_pool_run_pairs(pool, 0, l->n_blade, 2 * l->n_blade, approach_blade, &e);
    bough_rotor_survey(l->rotor, e.motion, e.data);
    bough_pool_run_pairs(pool, 0, l->n_blade, next ? 2 * l->n_blade : l->n_blade, load_blade, &e);
    bough_rotor_conclude(l->rotor, e.motion, e.data);
}

static void evaluate_present(bough_aero_link *l, double t) {
    bough_aero_motion_rotor(l->motion, t);
    evaluate_rotor(l, l->shown, bough_aero_motion_blade, NULL);
}

// Whether the previous sample has evaluated this one in advance; the times are equal up to rounding.
static bool looked_ahead(const bough_aero_link *l, double t) {
    return fabs(l->time[1 - l->shown] - t) <= 1e-9 * (fabs(t) + 1e-3);
}

static void evaluate(void *self, double t) {
    bough_aero_link *l = self;
    if (l->time[l->shown] == t) return;
    if (looked_ahead(l, t)) {
        l->shown = 1 - l->shown;
        l->time[l->shown] = t;
        l->time[1 - l->shown] = (double)NAN;
    } else {
        evaluate_present(l, t);
    }
}

// Keeps the present loads constant from t on.
static void keep(bough_aero_link *l, double t) {
    for (int b = 0; b < l->n_blade; b++)
        bough_aero_signal_hold(l->signal[b], fresh_loads(l, b), bough_aero_motion_course(l->motion, b), t);
}

static void hold(bough_aero_link *l, double t) {
    if (l->time[l->shown] != t || l->found != l->shown) evaluate_present(l, t);
    keep(l, t);
}

static bough_status sample(void *self, double t, double t_next, bool *jumped) {
    bough_aero_link *l = self;
    bool constant = l->simulation->scene->aero.hold == BOUGH_SCENE_CONSTANT;
    *jumped = !l->started || constant;
    if (*jumped) {
        hold(l, t);
    } else if (looked_ahead(l, t)) {
        evaluate(l, t);
    }
    l->started = true;
    if (constant) return bough_ok();
    interval next = {t, t_next - t};
    bough_aero_motion_expect_rotor(l->motion, t, next.span);
    evaluate_rotor(l, 1 - l->shown, bough_aero_motion_expect_blade, &next);
    return bough_ok();
}

double bough_aero_link_evaluated(const bough_aero_link *link) { return link->time[link->shown]; }

void bough_aero_link_renew(bough_aero_link *link) { link->time[0] = link->time[1] = (double)NAN; }

void bough_aero_link_set_wind(bough_aero_link *link, double speed) {
    bough_rotor_set_speed(link->rotor, speed);
    bough_aero_link_renew(link);
}

static void begin_anew(bough_aero_link *link) {
    link->started = false;
    bough_aero_motion_forget(link->motion);
    bough_aero_link_renew(link);
}

static void evaluate_anew(bough_aero_link *link, double t, bool moved) {
    begin_anew(link);
    if (moved)
        evaluate_present(link, t);
    else
        evaluate_rotor(link, link->shown, NULL, NULL);
}

void bough_aero_link_remember(bough_aero_link *link, double t, bool moved) {
    evaluate_anew(link, t, moved);
    begin_anew(link);
}

void bough_aero_link_continue(bough_aero_link *link, double t, bool moved) {
    evaluate_anew(link, t, moved);
    keep(link, t);
    begin_anew(link);
    if (link->simulation->drag) bough_drag_link_hold(link->simulation->drag, t);
}

void bough_aero_link_hold(bough_aero_link *link, double t) {
    bough_rotor_forget(link->rotor, &link->data[0]);
    bough_aero_link_continue(link, t, true);
    bough_rotor_forget(link->rotor, &link->data[0]);
}

void bough_aero_link_memory(bough_aero_link *link, bough_snapshot_move move, double *memory) {
    bough_rotor_memory_snapshot(link->rotor, &link->data[0], &(bough_snapshot){move, (char *)memory, 0});
}

int bough_aero_link_loads(bough_aero_link *link, bough_snapshot_move move, int blade, double *memory) {
    bough_snapshot s = {move, (char *)memory, 0};
    bough_aero_signal_snapshot(link->signal[blade], &s);
    return (int)(s.used / sizeof(double));
}

const bough_rotor *bough_aero_link_rotor(const bough_aero_link *link) { return link->rotor; }

double bough_aero_link_missed(const bough_aero_link *link, int blade) {
    return bough_aero_signal_missed(link->signal[blade]);
}

const bough_rotor_data *bough_aero_link_data(const bough_aero_link *link, double *factor) {
    if (factor) *factor = link->factor[link->shown];
    return &link->data[link->shown];
}

bough_vec3 bough_aero_link_hub_wind(const bough_aero_link *link, double t) {
    return bough_wind_at(bough_rotor_wind(link->rotor), link->hub, t);
}

// -- saving ---------------------------------------------------------------------------------------

// Stores the results of both evaluations, without the loads.
static void snapshot(void *self, bough_snapshot *s) {
    bough_aero_link *link = self;
    if (s->move == BOUGH_SNAPSHOT_RESTORE) link->shown = 0, link->found = -1;
    bough_snapshot_take(s, &link->started, sizeof link->started);
    for (int i = 0; i < 2; i++) {
        int k = i == 0 ? link->shown : 1 - link->shown;
        BOUGH_SNAPSHOT(s, link->factor[k], link->time[k]);
        bough_rotor_result_snapshot(link->rotor, &link->data[k], s);
    }
    for (int b = 0; b < link->n_blade; b++) bough_aero_signal_snapshot(link->signal[b], s);
    bough_aero_motion_snapshot(link->motion, s);
    bough_rotor_memory_snapshot(link->rotor, &link->data[0], s);
}

// -- whole ----------------------------------------------------------------------------------------

bough_status bough_aero_link_build(bough_arena *arena, bough_simulation *simulation) {
    const bough_scene_aero *aero = &simulation->scene->aero;
    if (aero->node == NULL) return bough_ok();
    bough_aero_link *l = bough_arena_take(arena, sizeof *l);
    l->simulation = simulation;
    BOUGH_TRY(take_blades(arena, l));
    bough_rotor_def def = rotor_def(arena, l);
    bough_status status = bough_rotor_build(arena, &def, &l->rotor);
    if (bough_is_ok(&status)) status = check_reach(l);
    const bough_node *file = bough_node_find(aero->wind.node, "file");
    if (!bough_is_ok(&status)) {
        return bough_scene_blame(file ? file : aero->node, file ? "aero.wind.file" : "aero", status);
    }
    for (int i = 0; i < 2; i++) bough_rotor_data_build(arena, l->rotor, &l->data[i]);
    l->data[1].memory = l->data[0].memory;
    bough_aero_link_renew(l);
    simulation->aero = l;
    simulation->sampled[simulation->n_sampled++] =
        (bough_sampled_load){1 / aero->rate, l, sample, evaluate, NULL, snapshot};
    return status;
}
