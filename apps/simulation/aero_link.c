#include "apps/simulation/aero_link.h"

#include "core/base.h"
#include "core/force.h"
#include "flexbody/rod_load.h"

#include <math.h>
#include <string.h>

// A blade's loads at the last sample and the value the load signal has reached. Of a rod per vertex
// force and moment in the body's axes (6 × vertices), then the same per length along each segment in
// the axes of its middle (6 × segments); on a rigid body the resultant (6).
typedef struct blade_loads {
    const bough_beam *beam;
    double *sampled, *reached; // (n)
    double *value, *rate, *curve; // (n) of the signal that the body has, since the last sample
    double *fresh;             // (n)
    double *along;             // per length (6 × segments): its rate, of a modal body itself
    double *strain, *lumped;   // of a modal body, D q and the loads of it (6 × the mesh's stride)
    int n;
} blade_loads;

struct bough_aero_link {
    bough_simulation *simulation;
    const bough_rotor *rotor;
    bough_rotor_data data;
    bough_rotor_motion motion;
    bough_blade_motion *moving; // (n_blade), what `motion` points to …
    double *vertex;             // (n_blade × BOUGH_BLADE_ROWS × n_vertex) … and these
    int n_blade, n_vertex;
    blade_loads *blade; // (n_blade)
    double factor;      // of the ramp at the last sample
    double evaluated;   // time of what `data` holds [s]; NAN: none that a sample may use
    bough_vec3 hub;     // at the start, ground axes [m]
    double start, span; // of the signals, from the last sample to the next [s]
    bool started;
};

// -- build ----------------------------------------------------------------------------------------

static bough_status same_mesh(const bough_aero_link *l, const bough_beam *beam) {
    const bough_beam *first = l->blade[0].beam;
    if (beam->def.n_segment == first->def.n_segment) return bough_ok();
    return bough_fail(BOUGH_INVALID, "blades %s and %s have %d and %d segments; the aerodynamics"
                      " wants the same mesh on all blades", first->body->name, beam->body->name,
                      first->def.n_segment, beam->def.n_segment);
}

// How many numbers a blade's loads are, and what only some bodies need.
static void take_kind(bough_arena *arena, int n_vertex, blade_loads *blade) {
    const bough_beam *beam = blade->beam;
    size_t segments = (size_t)n_vertex - 1;
    blade->n = beam->port < 0 ? 6 : 6 * n_vertex;
    if (beam->port >= 0) blade->along = bough_arena_doubles(arena, 6 * segments);
    if (beam->rod != NULL) blade->n += 6 * (int)segments;
    if (beam->modal == NULL) return;
    size_t stride = (size_t)bough_beam_mesh(beam)->stride;
    blade->strain = bough_arena_doubles(arena, 6 * stride);
    blade->lumped = bough_arena_doubles(arena, 6 * stride);
}

static bough_status take_blades(bough_arena *arena, bough_aero_link *l) {
    const bough_scene_turbine *turbine = &l->simulation->scene->turbine;
    l->n_blade = turbine->n_blade;
    l->blade = bough_arena_take(arena, (size_t)l->n_blade * sizeof *l->blade);
    if (l->blade == NULL) return bough_fail(BOUGH_OUT_OF_MEMORY, "aerodynamics: out of memory");
    for (int b = 0; b < l->n_blade; b++) {
        blade_loads *blade = &l->blade[b];
        blade->beam = bough_simulation_beam(l->simulation, turbine->blade[b]);
        bough_status status = same_mesh(l, blade->beam);
        if (!bough_is_ok(&status)) return status;
        l->n_vertex = blade->beam->def.n_segment + 1;
        take_kind(arena, l->n_vertex, blade);
        blade->fresh = bough_arena_doubles(arena, (size_t)blade->n);
        blade->sampled = bough_arena_doubles(arena, (size_t)blade->n);
        blade->reached = bough_arena_doubles(arena, (size_t)blade->n);
        blade->value = bough_arena_doubles(arena, (size_t)blade->n);
        blade->rate = bough_arena_doubles(arena, (size_t)blade->n);
        blade->curve = bough_arena_doubles(arena, (size_t)blade->n);
    }
    return bough_ok();
}

static void take_motion(bough_arena *arena, bough_aero_link *l) {
    size_t n = (size_t)l->n_vertex * BOUGH_BLADE_ROWS;
    l->moving = bough_arena_take(arena, (size_t)l->n_blade * sizeof *l->moving);
    l->vertex = bough_arena_doubles(arena, (size_t)l->n_blade * n);
    l->motion.blade = l->moving;
    for (int b = 0; l->moving && l->vertex && b < l->n_blade; b++)
        l->moving[b].vertex = l->vertex + (size_t)b * n;
}

// Tables of the scene in the rotor's form.
typedef struct tables {
    bough_polar_def *polar;
    bough_station_def *station;
    bough_mat3 *rotation;
    double *drag; // of the tower
} tables;

static bool take_tables(bough_arena *arena, const bough_aero_link *l, tables *t) {
    const bough_scene_aero *aero = &l->simulation->scene->aero;
    t->polar = bough_arena_take(arena, (size_t)aero->polars.n_polar * sizeof *t->polar);
    t->station = bough_arena_take(arena, (size_t)aero->blade.n_station * sizeof *t->station);
    t->rotation = bough_arena_take(arena, (size_t)l->n_vertex * sizeof *t->rotation);
    t->drag = bough_arena_doubles(arena, (size_t)aero->tower.n_height);
    if (bough_arena_exhausted(arena)) return false;
    for (int k = 0; k < aero->polars.n_polar; k++) {
        const bough_scene_polar *from = &aero->polars.polar[k];
        double *row = bough_arena_doubles(arena, 4 * (size_t)from->n_row);
        if (row == NULL) return false;
        for (int i = 0; i < from->n_row; i++) {
            const bough_scene_polar_row *r = &from->row[i];
            const double values[4] = {r->alpha * (180 / BOUGH_PI), r->cl, r->cd, r->cm};
            memcpy(row + 4 * i, values, sizeof values);
        }
        t->polar[k] = (bough_polar_def){from->name, from->n_row, row};
    }
    for (int k = 0; k < aero->blade.n_station; k++) {
        const bough_scene_aero_station *from = &aero->blade.station[k];
        t->station[k] = (bough_station_def){.span = from->span,
                                            .chord = from->chord,
                                            .twist = from->twist,
                                            .centre_x = from->ac[0],
                                            .centre_y = from->ac[1],
                                            .polar = from->polar,
                                            .second = from->second,
                                            .share = from->share};
    }
    for (int i = 0; i < aero->tower.n_height; i++) {
        t->drag[i] = aero->tower.drag[aero->tower.n_drag == 1 ? 0 : i];
    }
    for (int i = 0; i < l->n_vertex; i++) {
        t->rotation[i] = bough_rotation_matrix(l->blade[0].beam->def.rotation[i]);
    }
    return true;
}

static bough_tower_def tower_def(const bough_scene_tower *tower, const double *drag) {
    return (bough_tower_def){
        .n = tower->n_height,
        .height = tower->height,
        .diameter = tower->diameter,
        .drag = drag,
        .influence = (bough_tower_influence)tower->influence,
        .shadow = (bough_tower_shadow)tower->shadow,
    };
}

static double rotor_radius(const bough_scene_aero *aero) {
    return aero->hub_radius + aero->blade.station[aero->blade.n_station - 1].span;
}

// What the scene leaves to choose.
static bough_wind_iec_def standard_wind(const bough_scene *scene) {
    const bough_scene_wind *wind = &scene->aero.wind;
    bough_wind_iec_def def = wind->iec;
    def.speed = wind->speed;
    def.exponent = wind->exponent;
    def.height = wind->reference_height;
    if (!(def.diameter > 0)) def.diameter = 2 * rotor_radius(&scene->aero);
    if (!(def.width > 0)) def.width = 1.15 * def.diameter;
    if (!(def.period > 0)) def.period = fmax(scene->simulation.duration, 600);
    return def;
}

static bough_wind_def wind_def(const bough_scene *scene) {
    const bough_scene_wind *wind = &scene->aero.wind;
    static const bough_wind_shear shears[] = {
        [BOUGH_SCENE_WIND_UNIFORM] = BOUGH_WIND_UNIFORM,
        [BOUGH_SCENE_WIND_POWER] = BOUGH_WIND_POWER,
        [BOUGH_SCENE_WIND_LOG] = BOUGH_WIND_LOG,
        [BOUGH_SCENE_WIND_WND] = BOUGH_WIND_UNIFORM,
        [BOUGH_SCENE_WIND_BTS] = BOUGH_WIND_UNIFORM,
        [BOUGH_SCENE_WIND_IEC] = BOUGH_WIND_UNIFORM,
    };
    static const bough_wind_source sources[] = {
        [BOUGH_SCENE_WIND_WND] = BOUGH_WIND_HUB_FILE,
        [BOUGH_SCENE_WIND_BTS] = BOUGH_WIND_BOX_FILE,
        [BOUGH_SCENE_WIND_IEC] = BOUGH_WIND_STANDARD,
    };
    return (bough_wind_def){
        .speed = wind->speed,
        .vertical = wind->vertical,
        .direction = wind->direction,
        .shear = shears[wind->kind],
        .exponent = wind->exponent,
        .roughness = wind->roughness,
        .reference_height = wind->reference_height > 0 ? wind->reference_height : 90,
        .n_time = wind->table.n_time,
        .time = wind->table.time,
        .speed_at_time = wind->table.speed,
        .source = sources[wind->kind],
        .file = wind->file,
        .reference_length = wind->reference_length,
        .until = scene->simulation.duration,
        .iec = wind->kind == BOUGH_SCENE_WIND_IEC ? standard_wind(scene) : wind->iec,
        .upflow = wind->upflow,
        .veer = wind->veer / 100,
    };
}

static bough_rotor_def rotor_def(const bough_aero_link *l, const tables *t) {
    const bough_scene_aero *aero = &l->simulation->scene->aero;
    const bough_rod_def *mesh = &l->blade[0].beam->def;
    bough_rotor_def def = bough_rotor_def_default();
    def.n_blade = l->n_blade;
    def.density = aero->air_density;
    def.hub_radius = aero->hub_radius;
    def.skew = aero->induction.skew != 0;
    def.induction = aero->induction.options;
    def.induction.axial_drag = def.induction.tangential_drag = aero->induction.drag;
    def.inflow = aero->induction.inflow;
    def.smooth_polars = aero->interpolation == BOUGH_SCENE_POLARS_SMOOTH;
    def.pitching_moment = aero->pitching_moment;
    def.stall = (bough_stall_kind)aero->dynamic_stall;
    def.wind = wind_def(l->simulation->scene);
    if (aero->tower.node != NULL) def.tower = tower_def(&aero->tower, t->drag);
    def.n_polar = aero->polars.n_polar;
    def.polar = t->polar;
    def.n_station = aero->blade.n_station;
    def.station = t->station;
    def.n_vertex = l->n_vertex;
    def.vertex_span = mesh->span;
    def.vertex_position = mesh->position;
    def.vertex_rotation = t->rotation;
    return def;
}

// A box must reach over the undeformed rotor.
static bough_status check_reach(bough_aero_link *l) {
    const bough_scene *scene = l->simulation->scene;
    const bough_frame *rotor = &l->simulation->tree->bodies[scene->turbine.rotor];
    bough_vec3 hub = l->hub = bough_tree_frame_pose(l->simulation->view, rotor).position;
    double radius = rotor_radius(&scene->aero);
    if (bough_rotor_in_wind(l->rotor, hub, radius)) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "aero.wind: the box of %s is too small for a rotor of %g m radius at %g m",
                      scene->aero.wind.file ? scene->aero.wind.file : "turbulence", radius, hub.z);
}

bough_status bough_aero_link_build(bough_arena *arena, bough_simulation *simulation,
                                   bough_aero_link **link) {
    bough_aero_link *l = bough_arena_take(arena, sizeof *l);
    tables t;
    if (l == NULL) return bough_fail(BOUGH_OUT_OF_MEMORY, "aerodynamics: out of memory");
    l->simulation = simulation;
    bough_status status = take_blades(arena, l);
    if (!bough_is_ok(&status)) return status;
    take_motion(arena, l);
    if (!take_tables(arena, l, &t)) {
        return bough_fail(BOUGH_OUT_OF_MEMORY, "aerodynamics: out of memory");
    }
    bough_rotor_def def = rotor_def(l, &t);
    status = bough_rotor_build(arena, &def, &l->rotor);
    if (bough_is_ok(&status)) status = check_reach(l);
    if (bough_is_ok(&status)) status = bough_rotor_data_build(arena, l->rotor, &l->data);
    bough_aero_link_renew(l);
    if (bough_is_ok(&status)) *link = l;
    return status;
}

// -- sample ---------------------------------------------------------------------------------------

static void gather_rotor(bough_aero_link *l, double t) {
    bough_simulation *s = l->simulation;
    const bough_scene_turbine *turbine = &s->scene->turbine;
    bough_simulation_update(s);
    bough_transform rotor = bough_tree_frame_pose(s->view, &s->tree->bodies[turbine->rotor]);
    const bough_vec3 axes[3] = {rotor.rotation.c1, rotor.rotation.c2, rotor.rotation.c3};
    l->motion.time = t;
    l->motion.hub = rotor.position;
    l->motion.shaft = axes[s->scene->body[turbine->rotor].joint.axis];
}

static void gather_blade(bough_aero_link *l, int b) {
    bough_simulation *s = l->simulation;
    const bough_beam *beam = l->blade[b].beam;
    l->moving[b].frame = bough_tree_frame_pose(s->view, &s->tree->markers[beam->marker]);
    bough_simulation_beam_rows(s, beam, l->vertex + b * BOUGH_BLADE_ROWS * l->n_vertex);
}

// The height of τ(1 − τ) that gives what the error 1 of an extrapolation has left out, half of it for
// the step to the sample itself and 5/12 for the period before, times 6.
static const double debt = 5.5;

// The signal of fresh loads until the next sample. Linear: continuous, from what was reached to the value
// extrapolated from the last two samples. In between it runs above or below the straight line by what
// the last extrapolation has left out: 5/12 of its error times the span, by Adams' formula with the
// sample before. So impulses are right to the third order, one sample late at most.
static void follow(const bough_aero_link *l, blade_loads *blade) {
    bool held = l->simulation->scene->aero.hold == BOUGH_SCENE_CONSTANT || !l->started;
    double *restrict value = blade->value, *restrict rate = blade->rate;
    double *restrict reached = blade->reached, *restrict sampled = blade->sampled;
    double *restrict curve = blade->curve;
    const double *restrict fresh = blade->fresh;
    double factor = l->factor, span = l->span;
    for (int k = 0; k < blade->n; k++) {
        double now = factor * fresh[k], before = held ? now : reached[k];
        double next = held ? now : 2 * now - sampled[k], bump = debt * (now - before);
        value[k] = before;
        rate[k] = (next - before + bump) / span;
        curve[k] = -bump / (span * span);
        reached[k] = next;
        sampled[k] = now;
    }
}

// Hands a blade's signal to its body.
static void put(bough_aero_link *l, int b) {
    blade_loads *blade = &l->blade[b];
    if (blade->beam->port < 0) {
        bough_tree_set_wrench(l->simulation->tree, blade->beam->marker, l->start, blade->value,
                              blade->rate, blade->curve);
        return;
    }
    bough_rod_loads *rod = bough_beam_loads(blade->beam);
    size_t stride = (size_t)bough_beam_mesh(blade->beam)->stride, n = (size_t)l->n_vertex;
    for (size_t c = 0; c < 6; c++) {
        memcpy(rod->value + c * stride, blade->value + c * n, n * sizeof(double));
        memcpy(rod->rate + c * stride, blade->rate + c * n, n * sizeof(double));
        memcpy(rod->curve + c * stride, blade->curve + c * n, n * sizeof(double));
    }
    rod->start = l->start;
    if (blade->beam->rod == NULL) return;
    size_t first = 6 * n; // along the segments: on the straight line
    for (size_t k = first; k < (size_t)blade->n; k++) {
        blade->along[k - first] = (blade->reached[k] - blade->value[k]) / l->span;
    }
    bough_rod_loads_along(bough_beam_mesh(blade->beam), blade->value + first, blade->along, rod);
}

// The resultant of the loads on a rigid blade's vertices.
static void sum_loads(const bough_aero_link *l, int b, double sum[6]) {
    const double *load = l->data.load + 6 * b * l->n_vertex;
    bough_wrench total = {{0, 0, 0}, {0, 0, 0}};
    for (int i = 0; i < l->n_vertex; i++) {
        double here[6];
        for (int c = 0; c < 6; c++) here[c] = load[c * l->n_vertex + i];
        bough_transform at = {l->blade[b].beam->def.position[i], bough_mat3_identity()};
        total = bough_wrench_add(total, bough_wrench_to_parent(&at, bough_wrench_load(here)));
    }
    bough_wrench_store(total, sum);
}

// The loads on a rod's vertices and along its segments.
static void take_loads(const bough_aero_link *l, int b, blade_loads *blade) {
    int n = l->n_vertex;
    const double *line = l->data.line + 6 * b * (n - 1);
    const double *rotation = l->moving[b].vertex + BOUGH_BLADE_ROTATION * n;
    memcpy(blade->fresh, l->data.load + 6 * b * n, 6 * (size_t)n * sizeof(double));
    bough_rod_line_axes(n - 1, rotation, line,
                        blade->beam->rod != NULL ? blade->fresh + 6 * n : blade->along);
}

// A modal body knows loads on vertices only.
static void lump_line(const bough_aero_link *l, blade_loads *blade) {
    const bough_rod_model *m = bough_beam_mesh(blade->beam);
    int n = l->n_vertex, s = m->stride;
    memset(blade->lumped, 0, 6 * (size_t)s * sizeof(double));
    bough_rod_line_strain(m, blade->along, blade->strain);
    bough_rod_lump_strain(m, blade->strain, blade->lumped);
    for (int c = 0; c < 6; c++) {
        for (int i = 0; i < n; i++) blade->fresh[c * n + i] += blade->lumped[c * s + i];
    }
}

static void apply(bough_aero_link *l, int b) {
    blade_loads *blade = &l->blade[b];
    if (blade->beam->port < 0) {
        sum_loads(l, b, blade->fresh);
    } else {
        take_loads(l, b, blade);
        if (blade->beam->modal != NULL) lump_line(l, blade);
    }
    follow(l, blade);
    put(l, b);
}

// Tasks, a blade each.
static void approach_blade(void *self, int b, bough_part part) {
    bough_aero_link *l = self;
    if (part != BOUGH_SECOND_HALF) {
        gather_blade(l, b);
        bough_rotor_approach(l->rotor, &l->motion, b, &l->data);
    }
    if (part != BOUGH_FIRST_HALF) bough_rotor_induce(l->rotor, &l->motion, b, &l->data);
}

static void load_blade(void *self, int b) {
    bough_aero_link *l = self;
    bough_rotor_load(l->rotor, &l->motion, b, &l->data);
}

static void evaluate(void *self, double t) {
    bough_aero_link *l = self;
    bough_pool *pool = l->simulation->pool;
    const double *ramp = l->simulation->scene->aero.ramp;
    bool jump = ramp[1] <= ramp[0]; // which a sample at its time follows, up to rounding
    l->factor = bough_ramp_factor(ramp[0], ramp[1], jump ? t * (1 + 1e-12) : t);
    gather_rotor(l, t);
    bough_pool_run_turns(pool, l->n_blade, approach_blade, l);
    bough_rotor_survey(l->rotor, &l->motion, &l->data);
    bough_pool_run(pool, l->n_blade, load_blade, l);
    bough_rotor_conclude(l->rotor, &l->motion, &l->data);
    l->evaluated = t;
}

static bough_status sample(void *self, double t, double t_next, bool *jumped) {
    bough_aero_link *l = self;
    if (l->evaluated != t) evaluate(l, t);
    l->start = t;
    l->span = t_next - t;
    for (int b = 0; b < l->n_blade; b++) apply(l, b);
    *jumped = !l->started || l->simulation->scene->aero.hold == BOUGH_SCENE_CONSTANT;
    l->started = true;
    return bough_ok();
}

double bough_aero_link_evaluated(const bough_aero_link *link) { return link->evaluated; }

void bough_aero_link_renew(bough_aero_link *link) { link->evaluated = (double)NAN; }

void bough_aero_link_set_wind(bough_aero_link *link, double speed) {
    bough_rotor_set_speed(link->rotor, speed);
    bough_aero_link_renew(link);
}

void bough_aero_link_go_on(bough_aero_link *link, double t) {
    bool jumped;
    link->started = false;
    bough_aero_link_renew(link);
    sample(link, t, t + 1, &jumped); // constant: there is none before it
    link->started = false;
    bough_aero_link_renew(link);
}

void bough_aero_link_hold(bough_aero_link *link, double t) {
    bough_rotor_forget(link->rotor, &link->data);
    bough_aero_link_go_on(link, t);
    bough_rotor_forget(link->rotor, &link->data);
}

void bough_aero_link_remember(const bough_aero_link *link, double *to) {
    bough_rotor_save(link->rotor, &link->data, to);
}

void bough_aero_link_remind(bough_aero_link *link, const double *from) {
    bough_rotor_restore(link->rotor, from, &link->data);
}

bough_sampled_load bough_aero_link_load(bough_aero_link *link) {
    return (bough_sampled_load){1 / link->simulation->scene->aero.rate, link, sample, evaluate, NULL};
}

const bough_rotor *bough_aero_link_rotor(const bough_aero_link *link) { return link->rotor; }

const bough_rotor_data *bough_aero_link_data(const bough_aero_link *link, double *factor) {
    *factor = link->factor;
    return &link->data;
}

bough_vec3 bough_aero_link_hub_wind(const bough_aero_link *link, double t) {
    return bough_wind_at(bough_rotor_wind(link->rotor), link->hub, t);
}

// -- saving ---------------------------------------------------------------------------------------

enum { SCALARS = 4, PER_LOAD = 5 };

int bough_aero_link_size(const bough_aero_link *link) {
    int n = SCALARS + bough_rotor_memory_size(link->rotor);
    for (int b = 0; b < link->n_blade; b++)
        n += PER_LOAD * link->blade[b].n;
    return n;
}

void bough_aero_link_save(const bough_aero_link *link, double *to) {
    *to++ = link->factor;
    *to++ = link->start;
    *to++ = link->span;
    *to++ = link->started;
    for (int b = 0; b < link->n_blade; b++) {
        const blade_loads *blade = &link->blade[b];
        const double *const part[PER_LOAD] = {blade->sampled, blade->reached, blade->value,
                                              blade->rate, blade->curve};
        for (int i = 0; i < PER_LOAD; i++, to += blade->n)
            memcpy(to, part[i], (size_t)blade->n * sizeof *to);
    }
    bough_rotor_save(link->rotor, &link->data, to);
}

void bough_aero_link_restore(bough_aero_link *link, const double *from) {
    link->factor = *from++;
    link->start = *from++;
    link->span = *from++;
    link->started = *from++ != 0;
    for (int b = 0; b < link->n_blade; b++) {
        const blade_loads *blade = &link->blade[b];
        double *const part[PER_LOAD] = {blade->sampled, blade->reached, blade->value, blade->rate,
                                        blade->curve};
        for (int i = 0; i < PER_LOAD; i++, from += blade->n)
            memcpy(part[i], from, (size_t)blade->n * sizeof *from);
        if (link->started) put(link, b);
    }
    bough_rotor_restore(link->rotor, from, &link->data);
    bough_aero_link_renew(link);
}
