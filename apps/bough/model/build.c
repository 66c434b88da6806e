// Builds a simulation part by part: tree, rods, ports, loads, master.

#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/build_internal.h"
#include "apps/bough/model/control_link.h"
#include "apps/bough/model/equilibrium.h"
#include "apps/bough/model/simulation.h"
#include "apps/bough/model/validity.h"
#include "core/base/linalg.h"
#include "core/tree/dynamics.h"
#include "core/tree/tree.h"

// -- loads and times ------------------------------------------------------------------------------

static void add_event(bough_builder *b, double time) {
    b->event = bough_arena_grow(b->arena, b->event, b->n_event, &b->event_room, sizeof *b->event);
    b->event[b->n_event++] = time;
}

static void add_events(bough_builder *b, double start, double end, int n, const double *times) {
    if (end > 0) add_event(b, start);
    if (end > start) add_event(b, end);
    for (int i = 0; i < n; i++) add_event(b, times[i]);
}

// Collects the corners of motions, loads and air as events, and the loads on joints for the tree.
static void set_loads(bough_builder *b) {
    for (int k = 0; k < 2 * b->scene->n_body; k++) {
        const bough_motion_def *def = &b->scene->body[k / 2].joint.motion[k % 2].def;
        add_events(b, def->start, def->end, def->n, def->times);
    }
    for (int k = 0; k < b->scene->n_load; k++) {
        const bough_scene_load *load = &b->scene->load[k];
        add_events(b, load->ramp[0], load->ramp[1], load->input == NULL ? load->n_time : 0, load->times);
        if (load->body_name != NULL) continue;
        b->load[b->tree.n_loads++] = (bough_joint_load_def){load->joint, load->n_time > 0 ? 1 : load->amount,
                                                            bough_scene_load_schedule(load)};
    }
    if (b->scene->aero.node != NULL) add_events(b, b->scene->aero.ramp[0], b->scene->aero.ramp[1], 0, NULL);
    // the generator's is the last, 0 until the control sets it
    if (b->scene->control.node != NULL)
        b->load[b->tree.n_loads++] = (bough_joint_load_def){.body = b->scene->turbine.rotor};
}

// -- parts ----------------------------------------------------------------------------------------

// The most steps of the tree in a macro step: more are only taken if the wrenches of the rods diverge.
enum { MOST_TREE_STEPS = 20000 };

static bough_integrator_options solver_options(const bough_scene_solver *solver) {
    return (bough_integrator_options){.kind = (bough_integrator_kind)solver->solver,
                                      .rtol = solver->rtol,
                                      .step = solver->step,
                                      .rho = solver->rho,
                                      .coarse = solver->coarse,
                                      .by_bdf = solver->by_bdf,
                                      .most_steps = solver->most_steps};
}

static bough_scheme_options scheme_options(const bough_scene *scene) {
    bough_scheme_options options = scene->simulation.coupling.options;
    options.name = bough_scheme_name(scene->simulation.coupling.scheme);
    // The iteration cannot converge below the error of the sub-solvers: residuals of the turbine stall at 0.2
    // to 0.6 of the micro rtol.
    double noise = 0;
    for (int i = 0; i < scene->n_body; i++) {
        noise = fmax(noise, bough_scene_micro(scene, &scene->body[i])->rtol);
    }
    if (!(options.tolerance > 0)) options.tolerance = 3 * noise;
    options.integrator = solver_options(&scene->simulation.master);
    return options;
}

// A method that refuses a system stands where the scene names it.
static bough_status blame_solver(const bough_scene_solver *solver, const char *key, bough_status status) {
    const bough_node *named = solver->node ? bough_node_find(solver->node, "solver") : NULL;
    return named ? bough_scene_blame(named, key, status) : status;
}

static bough_status build_tree(bough_builder *b) {
    const bough_scene *scene = b->scene;
    bough_simulation *s = b->s;
    bough_build_forces(b);
    b->tree.gravity = bough_v3_load(scene->gravity);
    b->tree.n_bodies = scene->n_body + s->n_end;
    b->tree.n_ports = s->n_rod + s->n_fmu;
    b->tree.n_ends = s->n_end;
    b->tree.closure_time = scene->simulation.macro_step;
    BOUGH_TRY(bough_scene_blame_named(scene, bough_tree_create(b->arena, &b->tree, &s->tree)));
    s->view = bough_tree_data_create(b->arena, s->tree);
    s->acceleration = bough_arena_doubles(b->arena, s->tree->n_v);
    s->accelerated = bough_arena_doubles(b->arena, 1);
    if (b->tree.n_bushings > 0) {
        bough_tree_kinematics(s->tree, s->tree->initial, s->view);
        bough_build_rest(s);
    }
    bough_integrator_options master = solver_options(&scene->simulation.master);
    master.most_steps = MOST_TREE_STEPS;
    // with all bodies as one system this method is never used
    if (bough_scheme_at(scene->simulation.coupling.scheme)->one_system) master.kind = BOUGH_ROSENBROCK;
    bough_system tree = bough_tree_system_create(b->arena, s->tree, "tree");
    return blame_solver(&scene->simulation.master, "master.solver",
                        bough_member_create(b->arena, &tree, 0, &master, &s->leader));
}

static bough_status build_rods(bough_builder *b) {
    bough_simulation *s = b->s;
    double *motion = bough_arena_doubles(b->arena, (size_t)bough_tree_n_outputs(s->tree) + 1);
    const bough_system *tree = &s->leader.system;
    tree->ops->output(tree->self, 0, s->leader.state, NULL, motion);
    for (int k = 0; k < s->n_beam; k++) {
        bough_beam *beam = &s->beam[k];
        if (beam->port < 0) continue;
        const bough_scene_solver *micro = bough_scene_micro(b->scene, beam->body);
        bough_integrator_options options = solver_options(micro);
        bough_system system = {0};
        double input[BOUGH_ROD_MOST_INPUTS] = {0};
        memcpy(input, motion + BOUGH_PORT_OUTPUTS * beam->port, BOUGH_PORT_OUTPUTS * sizeof *input);
        if (beam->end >= 0) {
            const double *end = motion + BOUGH_PORT_OUTPUTS * s->tree->n_ports;
            memcpy(input + BOUGH_PORT_OUTPUTS, end + BOUGH_END_OUTPUTS * beam->end,
                   BOUGH_END_OUTPUTS * sizeof *input);
        }
        bough_status status = bough_build_beam(b->arena, beam, input, &system);
        BOUGH_TRY(bough_scene_blame(beam->body->rod.node, "rod", status));
        status = bough_member_create(b->arena, &system, 0, &options, &s->rod[beam->port]);
        BOUGH_TRY(blame_solver(micro, "micro.solver", status));
    }
    int port = s->n_rod; // of the FMUs, after the rods
    for (int i = 0; i < b->scene->n_body; i++) {
        if (b->scene->body[i].fidelity != BOUGH_SCENE_FMU) continue;
        BOUGH_TRY(bough_fmu_member_create(b->arena, &b->scene->body[i], motion + BOUGH_PORT_OUTPUTS * port,
                                          b->scene->simulation.duration, &s->rod[port]));
        port++;
    }
    return bough_ok();
}

static void connect_one(bough_builder *b, bough_connection connection) {
    b->connection[b->n_connection++] = connection;
}

// The end of a rod that carries bodies: its motion from the tree, the wrench on it from the rod.
static void connect_end(bough_builder *b, const bough_beam *beam) {
    const bough_tree *tree = b->s->tree;
    int motion = BOUGH_PORT_OUTPUTS * tree->n_ports + BOUGH_END_OUTPUTS * beam->end;
    int wrench = BOUGH_PORT_INPUTS * tree->n_ports + BOUGH_END_INPUTS * beam->end, rod = beam->port + 1;
    connect_one(b, (bough_connection){0, motion, rod, BOUGH_ROD_INPUTS, BOUGH_ROD_END_INPUTS, true});
    connect_one(b, (bough_connection){rod, BOUGH_ROD_OUTPUTS, 0, wrench, BOUGH_ROD_END_OUTPUTS, false});
}

// The ground's axes from the tree to the n-th beam with loads in these axes.
static void connect_axes(bough_builder *b, const bough_beam *beam, int n) {
    const bough_tree *tree = b->s->tree;
    int from = BOUGH_PORT_OUTPUTS * tree->n_ports + BOUGH_END_OUTPUTS * tree->n_ends + BOUGH_GROUND_AXES * n;
    int to = b->s->rod[beam->port].system.n_input - BOUGH_GROUND_AXES;
    connect_one(b, (bough_connection){0, from, beam->port + 1, to, BOUGH_GROUND_AXES, true});
}

// The root of a rod or an FMU, port k: its motion from the tree, the wrench on it from the member.
static void connect_root(bough_builder *b, int k) {
    b->member[k + 1] = (bough_assembly_member){&b->s->rod[k], 1};
    connect_one(b, (bough_connection){0, BOUGH_PORT_OUTPUTS * k, k + 1, 0, BOUGH_PORT_OUTPUTS, true});
    connect_one(b, (bough_connection){k + 1, 0, 0, BOUGH_PORT_INPUTS * k, BOUGH_PORT_INPUTS, false});
}

static void connect(bough_builder *b) {
    bough_simulation *s = b->s;
    b->member[0] = (bough_assembly_member){&s->leader, 0};
    for (int i = 0, axes = 0; i < s->n_beam; i++) {
        const bough_beam *beam = &s->beam[i];
        if (beam->port >= 0) connect_root(b, beam->port);
        if (beam->end >= 0) connect_end(b, beam);
        if (beam->in_ground) connect_axes(b, beam, axes++);
    }
    for (int k = s->n_rod; k < s->n_rod + s->n_fmu; k++) connect_root(b, k);
}

// The run starts from equilibrium: the members move there before their master is built.
static bough_status find_equilibrium(bough_arena *arena, const bough_assembly_def *def, bough_simulation *s) {
    BOUGH_TRY(bough_assembly_build(arena, def, &s->assembly));
    bool in_operation = s->scene->simulation.initial == BOUGH_SCENE_IN_OPERATION;
    return in_operation ? bough_simulation_trim(arena, s) : bough_simulation_equilibrium(s, 0, 0, NULL);
}

static bough_status build_master(bough_builder *b) {
    bough_simulation *s = b->s;
    const bough_scene_simulation *sim = &b->scene->simulation;
    bough_master_def def = bough_master_def_default();
    def.assembly = (bough_assembly_def){s->n_rod + s->n_fmu + 1, b->member, b->n_connection, b->connection};
    def.scheme = scheme_options(b->scene);
    def.macro_step = sim->macro_step;
    def.halves = sim->halves;
    def.control = (bough_step_control_def){sim->step_control.tolerance, sim->step_control.min};
    def.duration = sim->duration;
    def.event = b->event;
    def.n_event = b->n_event;
    def.pool = s->pool;
    def.n_load = s->n_sampled;
    def.load = s->sampled;
    if (sim->initial != BOUGH_SCENE_UNDEFORMED) BOUGH_TRY(find_equilibrium(b->arena, &def.assembly, s));
    bough_status status = bough_master_build(b->arena, &def, &s->master);
    if (bough_is_ok(&status)) s->assembly = s->master->assembly;
    if (bough_scheme_at(sim->coupling.scheme)->one_system)
        return blame_solver(&sim->master, "master.solver", status);
    const bough_node *scheme = sim->coupling.node ? bough_node_find(sim->coupling.node, "scheme") : NULL;
    return scheme ? bough_scene_blame(scheme, "coupling.scheme", status) : status;
}

// -- whole ----------------------------------------------------------------------------------------

// Takes arrays of the largest sizes that the scene can need.
static void take_arrays(bough_builder *b) {
    const bough_scene *scene = b->scene;
    size_t bodies = (size_t)scene->n_body, loads = (size_t)scene->n_load;
    size_t markers = bodies + loads + (size_t)scene->n_marker + 1;
    for (int k = 0; k < BOUGH_SCENE_CONNECTORS; k++) markers += 2 * (size_t)scene->n_connector[k];
    b->s = bough_arena_take(b->arena, sizeof *b->s);
    b->tree.bodies = b->body = bough_arena_take(b->arena, 2 * bodies * sizeof *b->body); // and ends of rods
    b->tree.ends = b->end = bough_arena_take(b->arena, bodies * sizeof *b->end);
    b->tree.markers = b->marker = bough_arena_take(b->arena, markers * sizeof *b->marker);
    b->tree.ports = b->port = bough_arena_take(b->arena, bodies * sizeof *b->port);
    b->tree.loads = b->load = bough_arena_take(b->arena, (loads + 2) * sizeof *b->load); // the generator's
    b->member = bough_arena_take(b->arena, (bodies + 1) * sizeof *b->member);
    b->connection = bough_arena_take(b->arena, 5 * bodies * sizeof *b->connection); // root, end, axes
    b->s->validity = bough_arena_take(b->arena, sizeof *b->s->validity);
    b->s->scene = scene;
    b->s->beam = bough_arena_take(b->arena, bodies * sizeof *b->s->beam);
    b->s->rod = bough_arena_take(b->arena, bodies * sizeof *b->s->rod);
}

int bough_simulation_threads(const bough_scene *scene) {
    return scene->simulation.threads > 0 ? scene->simulation.threads : bough_pool_default(1);
}

// Whether joints carry the loads of the air from the start on, which rods let rise with their deformation.
static bool has_rigid_blades(const bough_scene *scene) {
    bool undeformed = scene->simulation.initial == BOUGH_SCENE_UNDEFORMED;
    return scene->aero.node && undeformed &&
           scene->body[scene->turbine.blade[0]].fidelity == BOUGH_SCENE_RIGID;
}

bough_status bough_simulation_build(bough_arena *arena, const bough_scene *scene,
                                    bough_simulation **simulation) {
    int threads = bough_simulation_threads(scene);
    bough_linalg_room(arena, threads);
    return bough_simulation_build_on(arena, scene, bough_pool_create(arena, threads), NULL, simulation);
}

bough_status bough_simulation_build_on(bough_arena *arena, const bough_scene *scene, bough_pool *pool,
                                       const bough_simulation *beside, bough_simulation **simulation) {
    bough_builder b = {.arena = arena, .scene = scene, .beside = beside};
    take_arrays(&b);
    b.s->pool = pool;
    BOUGH_TRY(bough_build_bodies(&b));
    set_loads(&b);
    BOUGH_TRY(build_tree(&b));
    BOUGH_TRY(build_rods(&b));
    connect(&b);
    bough_simulation_update(b.s);
    bough_load_link_build(arena, b.s);
    bough_input_link_build(arena, b.s);
    BOUGH_TRY(bough_aero_link_build(arena, b.s));
    bough_drag_link_build(arena, b.s);
    BOUGH_TRY(bough_control_link_build(arena, b.s));
    bough_jump_link_build(arena, b.s);
    BOUGH_TRY(build_master(&b));
    if (b.s->control != NULL) BOUGH_TRY(bough_control_link_watch(arena, b.s->control));
    bough_simulation_update(b.s);
    if (has_rigid_blades(scene)) bough_aero_link_hold(b.s->aero, 0); // for the row at the start
    bough_validity_start(b.s);
    *simulation = b.s;
    return bough_ok();
}

// -- memory of the parts, in order ----------------------------------------------------------------

void bough_simulation_snapshot(bough_simulation *s, bough_snapshot *snapshot) {
    bough_master_snapshot(s->master, snapshot);
    for (int k = 0; k < s->n_sampled; k++) {
        if (s->sampled[k].snapshot) s->sampled[k].snapshot(s->sampled[k].self, snapshot);
    }
    bough_snapshot_take(snapshot, s->validity, sizeof *s->validity);
}

bough_status bough_simulation_known(const bough_simulation *s, const char *what) {
    if (s->n_fmu == 0) return bough_ok();
    return bough_fail(BOUGH_INVALID, "%.200s: '%.40s' is an FMU, whose equations are not known: %s",
                      s->scene->file, s->rod[s->n_rod].system.name, what);
}

bough_status bough_simulation_storable(const bough_simulation *s) {
    if (s->n_fmu > 0) {
        return bough_fail(BOUGH_INVALID, "the FMU of '%.40s' has memory of its own, which cannot be stored",
                          s->rod[s->n_rod].system.name);
    }
    const bough_scene_control *control = &s->scene->control;
    if (!bough_scene_control_is_foreign(control)) return bough_ok();
    bool fmu = control->kind == BOUGH_SCENE_CONTROL_FMU;
    return bough_fail(BOUGH_INVALID, "the controller %.200s has memory of its own, which cannot be stored",
                      fmu ? control->fmu.model.folder : control->library);
}
