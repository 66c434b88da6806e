#include "apps/scene/build.h"

#include "apps/scene/aero_link.h"
#include "apps/scene/control_link.h"
#include "apps/scene/drag_link.h"
#include "apps/scene/force_link.h"
#include "apps/scene/load_link.h"
#include "apps/scene/placement.h"
#include "apps/scene/settle.h"
#include "core/tree_subsystem.h"
#include "flexbody/section.h"

#include <stdio.h>
#include <string.h>

// What is gathered while building; the pieces point into the arena.
typedef struct builder {
    bough_arena *arena;
    const bough_scene *scene;
    bough_simulation *s;
    bough_body_def *body;          // (n_body + n_end): the tree's body i is the scene's body i; after
                                   // them what each carrying rod ends in
    bough_end_def *end;            // (n_end)
    bough_force_link force;        // markers, those of the beams first, and what acts on them
    bough_port_def *port;          // (n_rod)
    bough_joint_load_def *load;    // (n_load): those on joints
    int n_load;
    bough_member *member;          // trunk, then rods
    bough_connection *connection;  // two per rod, two more of one that carries bodies
    int n_connection;
    double *event;                 // corners of loads and of the aerodynamics
    int n_event;
} builder;

static bough_status out_of_memory(void) {
    return bough_fail(BOUGH_OUT_OF_MEMORY, "out of memory while building the scene");
}

// The joint frame in the frame of the tree's body it hangs on: from where bodies hang on the parent
// the steps in order, then the pitch.
static bough_transform placement(const bough_scene_body *body, bough_transform x) {
    x = bough_transform_compose(
        x, bough_placement(body->joint.n_placement, body->joint.placement));
    if (body->pitch != 0) {
        bough_transform pitch = bough_transform_identity();
        pitch.rotation = bough_placement_turn(BOUGH_SCENE_Z, -body->pitch);
        x = bough_transform_compose(x, pitch);
    }
    return x;
}

// Columns from the entries Ixx Iyy Izz Ixy Ixz Iyz.
static bough_mat3 tensor(const double j[6]) {
    return (bough_mat3){{j[0], j[3], j[4]}, {j[3], j[1], j[5]}, {j[4], j[5], j[2]}};
}

static void set_motion(const bough_scene_motion *from, bough_motion_def *to) {
    if (from->node == NULL) return;
    *to = (bough_motion_def){true, from->speed, from->from, from->to, from->ramp[0],
                             from->ramp[1], from->n_time, from->times, from->values};
}

static void set_coordinates(const bough_scene_joint *joint, bough_body_def *to) {
    double *q = to->coordinates, *v = to->speeds;
    set_motion(&joint->motion, &to->motion);
    set_motion(&joint->second_motion, &to->second_motion);
    double c = cos(joint->angle), s = sin(joint->angle);
    switch (to->kind) {
    case BOUGH_JOINT_CYLINDRICAL:
        q[1] = joint->angle, v[1] = joint->angular_speed;
        q[0] = joint->position, v[0] = joint->speed;
        break;
    case BOUGH_JOINT_UNIVERSAL:
        memcpy(q, joint->angles, sizeof joint->angles);
        memcpy(v, joint->angular_speeds, sizeof joint->angular_speeds);
        break;
    case BOUGH_JOINT_PLANAR: // the tree's linear speeds are in body axes
        q[0] = joint->positions[0], v[0] = c * joint->speeds[0] + s * joint->speeds[1];
        q[1] = joint->positions[1], v[1] = c * joint->speeds[1] - s * joint->speeds[0];
        q[2] = joint->angle, v[2] = joint->angular_speed;
        break;
    default:
        q[0] = joint->position, v[0] = joint->speed;
        to->spring = (bough_joint_spring){joint->stiffness, joint->damping, joint->rest,
                                          joint->stop[0], joint->stop[1], joint->stop_stiffness};
        break;
    }
}

// Where bodies hang on a beam: at its end, in the axes of the beam's body, which turn with the last
// section. So a placement means the same whether the beam bends or not.
static bough_transform beam_end(const bough_beam *beam) {
    int n = beam->def.n_segment;
    bough_mat3 section = bough_rotation_matrix(beam->def.rotation[n]);
    if (beam->end < 0) {
        return (bough_transform){beam->def.position[n], bough_transform_identity().rotation};
    }
    return (bough_transform){{0, 0, 0}, bough_mat3_transpose(section)};
}

static void set_parent(const builder *b, const bough_scene_body *from, bough_body_def *to) {
    int parent = from->joint.parent;
    bough_transform start = bough_transform_identity();
    to->parent = parent == BOUGH_SCENE_GROUND ? BOUGH_GROUND : parent;
    const bough_beam *beam = parent < 0 ? NULL : bough_simulation_beam(b->s, parent);
    if (beam != NULL) {
        start = beam_end(beam);
        if (beam->end >= 0) to->parent = b->end[beam->end].body;
    }
    to->joint = placement(from, start);
}

static void set_joint(const builder *b, const bough_scene_body *from, bough_body_def *to) {
    const bough_scene_joint *joint = &from->joint;
    to->kind = bough_placement_joint(joint->kind);
    set_parent(b, from, to);
    bool universal = to->kind == BOUGH_JOINT_UNIVERSAL;
    to->axis = bough_placement_axis(joint->axis);
    to->second_axis = bough_placement_axis(universal ? joint->second_axis : (joint->axis + 1) % 3);
    if (bough_joint_n_axes(to->kind) > 0) {
        set_coordinates(joint, to);
        return;
    }
    int angular = to->kind == BOUGH_JOINT_FREE ? 3 : 0; // a free joint's linear speeds come first
    for (int k = 0; k < 3; k++) {
        if (angular == 3) to->speeds[k] = joint->velocity[k];
        to->speeds[angular + k] = joint->angular_velocity[k];
    }
}

// The mass of a rigid body, given or integrated from its rod's table.
static void set_mass(const bough_scene_body *from, const bough_beam *beam, bough_body_def *to) {
    if (beam == NULL) {
        to->mass = from->mass;
        to->mass_centre = bough_v3(from->centre_of_mass[0], from->centre_of_mass[1],
                                   from->centre_of_mass[2]);
        to->inertia = tensor(from->inertia);
        return;
    }
    bough_vertex_inertia whole = bough_section_rigid(&beam->def);
    bough_vec3 centre = bough_scale(1 / whole.mass, whole.moment);
    bough_mat3 steiner = bough_steiner(bough_scale(-0.5 * whole.mass, centre), centre);
    to->mass = whole.mass;
    to->mass_centre = centre;
    to->inertia = bough_mat3_add(tensor(whole.inertia), steiner);
}

// -- beams ----------------------------------------------------------------------------------------

static bough_status discretise(builder *b, bough_beam *beam) {
    const bough_scene_structure *rod = &beam->body->rod.structure;
    size_t count = (size_t)rod->n_station;
    bough_section_station *station = bough_arena_take(b->arena, count * sizeof *station);
    if (station == NULL) return out_of_memory();
    for (int k = 0; k < rod->n_station; k++) {
        const bough_scene_station *from = &rod->station[k];
        bough_section_station *to = &station[k];
        to->position = bough_v3(from->position[0], from->position[1], from->position[2]);
        to->twist = from->twist;
        to->mass = from->mass;
        memcpy(to->centre, from->mass_centre, sizeof to->centre);
        memcpy(to->inertia, from->inertia, sizeof to->inertia);
        for (int i = 0, at = 0; i < 6; i++) {
            for (int j = i; j < 6; j++) to->stiffness[at++] = from->stiffness[6 * i + j];
        }
    }
    bough_section_table table = {.name = beam->body->name,
                                 .n_station = rod->n_station,
                                 .station = station,
                                 .length = rod->length};
    memcpy(table.damping, rod->damping, sizeof table.damping);
    return bough_section_discretise(b->arena, &table, beam->body->rod.n_segment,
                                    &beam->def);
}

static bough_inertia vertex_inertia(const bough_vertex_inertia *v) {
    return (bough_inertia){v->mass, v->moment, tensor(v->inertia)};
}

// The root vertex' inertia in the body's frame, about its origin.
static bough_inertia root_inertia(const bough_rod_def *def) {
    bough_transform x = {{0, 0, 0}, bough_rotation_matrix(def->rotation[0])};
    return bough_inertia_to_parent(&x, vertex_inertia(&def->inertia[0]));
}

static bool carries_bodies(const bough_scene *scene, int body) {
    for (int i = 0; i < scene->n_body; i++) {
        if (scene->body[i].joint.parent == body) return true;
    }
    return false;
}

// The last vertex becomes a body of the tree, free against the rod's frame; what the rod carries
// hangs on it.
static bough_status add_end(builder *b, bough_beam *beam, int index) {
    const bough_rod_def *def = &beam->def;
    int n = def->n_segment, body = b->scene->n_body + b->s->n_end;
    size_t length = strlen(beam->body->name) + sizeof " end";
    char *name = bough_arena_take(b->arena, length);
    if (name == NULL) return out_of_memory();
    snprintf(name, length, "%s end", beam->body->name);
    bough_quaternion p = def->rotation[n];
    bough_vec3 x = def->position[n];
    const double q[BOUGH_JOINT_COORDINATES] = {x.x, x.y, x.z, p.w, p.x, p.y, p.z};
    bough_body_def *to = &b->body[body];
    *to = bough_body_def_default();
    to->name = name;
    to->parent = index;
    to->kind = BOUGH_JOINT_FREE;
    memcpy(to->coordinates, q, sizeof q);
    beam->end = b->s->n_end++;
    beam->def.carries = true;
    b->end[beam->end] = (bough_end_def){name, body, vertex_inertia(&def->inertia[n])};
    return bough_ok();
}

static bough_status add_beam(builder *b, int index) {
    bough_simulation *s = b->s;
    bough_beam *beam = &s->beam[s->n_beam];
    beam->body = &b->scene->body[index];
    beam->marker = s->n_beam;
    beam->port = beam->end = -1;
    bough_status status = discretise(b, beam);
    if (!bough_is_ok(&status)) return status;
    b->force.marker[s->n_beam++] =
        (bough_marker_def){beam->body->name, index, bough_transform_identity()};
    if (beam->body->fidelity == BOUGH_SCENE_RIGID) return bough_ok();
    beam->port = s->n_rod;
    b->port[s->n_rod++] = (bough_port_def){beam->body->name, beam->marker,
                                           root_inertia(&beam->def)};
    return carries_bodies(b->scene, index) ? add_end(b, beam, index) : bough_ok();
}

static bough_status set_bodies(builder *b) {
    for (int i = 0; i < b->scene->n_body; i++) { // bodies hang on beams that stand already
        if (b->scene->body[i].rod.node == NULL) continue;
        bough_status status = add_beam(b, i);
        if (!bough_is_ok(&status)) return status;
    }
    for (int i = 0; i < b->scene->n_body; i++) {
        const bough_scene_body *from = &b->scene->body[i];
        bough_body_def *to = &b->body[i];
        *to = bough_body_def_default();
        to->name = from->name;
        set_joint(b, from, to);
        if (from->fidelity != BOUGH_SCENE_RIGID) continue;
        set_mass(from, bough_simulation_beam(b->s, i), to);
    }
    return bough_ok();
}

// -- loads and times ------------------------------------------------------------------------------

static void add_ramp(builder *b, const double ramp[2]) {
    if (ramp[1] <= ramp[0]) return;
    b->event[b->n_event++] = ramp[0];
    b->event[b->n_event++] = ramp[1];
}

static void add_motion(builder *b, const bough_scene_motion *motion) {
    add_ramp(b, motion->ramp);
    for (int i = 0; i < motion->n_time; i++) b->event[b->n_event++] = motion->times[i];
}

// The last of the loads; its two rows are set sample by sample.
static void add_generator(builder *b) {
    static const double times[2] = {0, 1}, values[2] = {0, 0};
    b->load[b->n_load++] = (bough_joint_load_def){
        .body = b->scene->turbine.rotor, .n = 2, .times = times, .values = values};
}

static void set_loads(builder *b) {
    for (int k = 0; k < b->scene->n_body; k++) {
        add_motion(b, &b->scene->body[k].joint.motion);
        add_motion(b, &b->scene->body[k].joint.second_motion);
    }
    for (int k = 0; k < b->scene->n_load; k++) {
        const bough_scene_load *load = &b->scene->load[k];
        add_ramp(b, load->ramp);
        for (int i = 0; i < load->n_time; i++) b->event[b->n_event++] = load->times[i];
        if (load->body_name != NULL) continue;
        b->load[b->n_load++] = (bough_joint_load_def){
            load->joint, load->amount, load->ramp[0], load->ramp[1],
            load->n_time, load->times, load->values};
    }
    if (b->scene->aero.node != NULL) add_ramp(b, b->scene->aero.ramp);
    if (b->scene->control.node != NULL) add_generator(b);
}

static size_t count_corners(const bough_scene *scene) {
    size_t n = 2 * (size_t)scene->n_load + 2; // two per ramp, of loads and of the aerodynamics
    for (int k = 0; k < scene->n_load; k++) n += (size_t)scene->load[k].n_time;
    for (int k = 0; k < scene->n_body; k++) {
        const bough_scene_joint *joint = &scene->body[k].joint;
        n += 4 + (size_t)joint->motion.n_time + (size_t)joint->second_motion.n_time;
    }
    return n;
}

// -- parts ----------------------------------------------------------------------------------------

static bough_status build_tree(builder *b) {
    b->force.n_marker = b->s->n_beam;
    bough_force_link_fill(b->scene, &b->force);
    b->s->first_marker = b->force.first_own;
    const bough_scene *scene = b->scene;
    bough_simulation *s = b->s;
    bough_tree_def def = {.gravity = bough_v3(scene->gravity[0], scene->gravity[1],
                                              scene->gravity[2]),
                          .n_bodies = scene->n_body + s->n_end,
                          .n_markers = b->force.n_marker,
                          .n_ports = s->n_rod,
                          .n_loads = b->n_load,
                          .bodies = b->body,
                          .markers = b->force.marker,
                          .ports = b->port,
                          .loads = b->load,
                          .n_springs = scene->n_spring,
                          .springs = b->force.spring,
                          .n_bushings = scene->n_bushing,
                          .bushings = b->force.bushing,
                          .n_applied = b->force.n_applied,
                          .applied = b->force.applied,
                          .n_ends = s->n_end,
                          .ends = b->end,
                          .n_closures = scene->n_closure,
                          .closures = b->force.closure,
                          .closure_time = scene->simulation.macro_step};
    bough_status status = bough_tree_create(b->arena, &def, &s->tree);
    if (bough_is_ok(&status)) status = bough_tree_data_create(b->arena, s->tree, &s->view);
    if (bough_is_ok(&status)) s->acceleration = bough_arena_doubles(b->arena, s->tree->n_v);
    if (!bough_is_ok(&status)) return status;
    if (scene->n_bushing > 0) {
        bough_tree_kinematics(s->tree, s->tree->initial, s->view);
        bough_force_link_rest(scene, s->view, s->tree);
    }
    const bough_scene_solver *master = &scene->simulation.master;
    bough_tree_solver solver =
        master->solver == BOUGH_SCENE_RADAU ? BOUGH_TREE_RADAU : BOUGH_TREE_IDA;
    return bough_tree_subsystem_create(b->arena, s->tree, "tree", 0, solver, master->rtol,
                                       &s->trunk);
}

static bough_micro_options micro_options(const builder *b, const bough_scene_body *body) {
    static const bough_micro_kind kinds[] = {
        [BOUGH_SCENE_CVODE_BDF] = BOUGH_MICRO_CVODE_BDF,
        [BOUGH_SCENE_GENERALIZED_ALPHA] = BOUGH_MICRO_GENERALIZED_ALPHA,
        [BOUGH_SCENE_ARKODE_ESDIRK] = BOUGH_MICRO_ARKODE_ESDIRK,
        [BOUGH_SCENE_ROSENBROCK] = BOUGH_MICRO_ROSENBROCK};
    const bough_scene_solver *micro = bough_scene_micro(b->scene, body);
    return (bough_micro_options){kinds[micro->solver], micro->rtol, micro->step, micro->rho};
}

static bough_status build_rods(builder *b) {
    bough_simulation *s = b->s;
    double *motion = bough_arena_doubles(b->arena, (size_t)bough_tree_n_outputs(s->tree) + 1);
    if (motion == NULL) return out_of_memory();
    s->trunk.ops->output(s->trunk.self, 0, s->trunk.state, NULL, motion);
    for (int k = 0; k < s->n_beam; k++) {
        bough_beam *beam = &s->beam[k];
        if (beam->port < 0) continue;
        bough_status status = bough_beam_build(b->arena, beam, micro_options(b, beam->body),
                                               motion + BOUGH_PORT_OUTPUTS * beam->port,
                                               &s->rod[beam->port]);
        if (!bough_is_ok(&status)) return status;
    }
    return bough_ok();
}

// A motion to a rod and the wrench that answers it.
static void add_port(builder *b, int rod, const bough_connection *motion,
                     const bough_connection *wrench) {
    bough_connection *to = &b->connection[b->n_connection], *back = to + 1;
    b->n_connection += 2;
    *to = *motion;
    *back = *wrench;
    to->to = back->from = rod + 1;
    to->kinematic = true;
}

static void connect_end(builder *b, const bough_beam *beam) {
    const bough_tree *tree = b->s->tree;
    int outputs = BOUGH_PORT_OUTPUTS * tree->n_ports, inputs = BOUGH_PORT_INPUTS * tree->n_ports;
    bough_connection motion = {.from_offset = outputs + BOUGH_END_OUTPUTS * beam->end,
                               .to_offset = BOUGH_ROD_INPUTS,
                               .count = BOUGH_ROD_END_INPUTS};
    bough_connection wrench = {.from_offset = BOUGH_ROD_OUTPUTS,
                               .to_offset = inputs + BOUGH_END_INPUTS * beam->end,
                               .count = BOUGH_ROD_END_OUTPUTS};
    add_port(b, beam->port, &motion, &wrench);
}

static void connect(builder *b) {
    bough_simulation *s = b->s;
    b->member[0] = (bough_member){&s->trunk, 0};
    for (int i = 0; i < s->n_beam; i++) {
        const bough_beam *beam = &s->beam[i];
        int k = beam->port;
        if (k < 0) continue;
        b->member[k + 1] = (bough_member){&s->rod[k], 1};
        bough_connection motion = {.from_offset = BOUGH_PORT_OUTPUTS * k,
                                   .count = BOUGH_PORT_OUTPUTS};
        bough_connection wrench = {.to_offset = BOUGH_PORT_INPUTS * k,
                                   .count = BOUGH_PORT_INPUTS};
        add_port(b, k, &motion, &wrench);
        if (beam->end >= 0) connect_end(b, beam);
    }
}

static bough_scheme_options scheme_options(const bough_scene *scene) {
    static const char *const names[] = {[BOUGH_SCENE_FROZEN] = "frozen",
                                        [BOUGH_SCENE_GAUSS_SEIDEL] = "gauss-seidel",
                                        [BOUGH_SCENE_EXTRAPOLATED] = "extrapolated",
                                        [BOUGH_SCENE_ITERATED] = "iterated",
                                        [BOUGH_SCENE_RAMP] = "ramp",
                                        [BOUGH_SCENE_MONOLITHIC] = "monolithic"};
    static const bough_acceleration kinds[] = {
        [BOUGH_SCENE_UNACCELERATED] = BOUGH_ACCELERATE_NONE,
        [BOUGH_SCENE_RELAXATION] = BOUGH_ACCELERATE_RELAXATION,
        [BOUGH_SCENE_AITKEN] = BOUGH_ACCELERATE_AITKEN,
        [BOUGH_SCENE_IQN_ILS] = BOUGH_ACCELERATE_IQN_ILS,
        [BOUGH_SCENE_INTERFACE_NEWTON] = BOUGH_ACCELERATE_NEWTON};
    const bough_scene_coupling *coupling = &scene->simulation.coupling;
    bough_scheme_options options = bough_scheme_options_default();
    options.name = names[coupling->scheme];
    options.order = coupling->order;
    options.theta = coupling->theta;
    options.exchange = (bough_exchange)coupling->exchange;
    options.accelerator = kinds[coupling->accelerator];
    options.relaxation = coupling->relaxation;
    // A body answers with the noise of its own tolerance, below which nothing converges: measured
    // on the turbine, residuals stall at 0.2 to 0.6 of the micro rtol.
    double noise = 0;
    for (int i = 0; i < scene->n_body; i++) {
        noise = fmax(noise, bough_scene_micro(scene, &scene->body[i])->rtol);
    }
    options.tolerance = coupling->tolerance > 0 ? coupling->tolerance : 3 * noise;
    options.iterations = coupling->iterations;
    options.rtol = scene->simulation.master.rtol;
    return options;
}

// The run starts from equilibrium: the members move there before their master is built.
static bough_status settle(const bough_assembly_def *def, bough_simulation *s) {
    bough_arena *arena = bough_arena_create();
    bough_assembly *assembly;
    bough_settling settling;
    if (arena == NULL) return out_of_memory();
    bough_status status = bough_assembly_build(arena, def, &assembly);
    if (bough_is_ok(&status)) status = bough_settle(s, assembly, 0, &settling);
    bough_arena_destroy(arena);
    return status;
}

static bough_status build_master(builder *b) {
    bough_simulation *s = b->s;
    const bough_scene_simulation *sim = &b->scene->simulation;
    bough_master_def def = bough_master_def_default();
    bough_sampled_load load[3];
    def.assembly = (bough_assembly_def){s->n_rod + 1, b->member, b->n_connection,
                                        b->connection};
    def.scheme = scheme_options(b->scene);
    def.macro_step = sim->macro_step;
    def.control = (bough_step_control_def){sim->step_control.tolerance, sim->step_control.min};
    def.duration = sim->duration;
    def.event = b->event;
    def.n_event = b->n_event;
    def.pool = s->pool;
    if (s->aero != NULL) {
        load[def.n_load++] = bough_aero_link_load(s->aero);
    }
    if (s->drag != NULL) load[def.n_load++] = bough_drag_link_load(s->drag);
    if (s->control != NULL) load[def.n_load++] = bough_control_link_load(s->control);
    def.load = load;
    if (sim->initial == BOUGH_SCENE_IN_EQUILIBRIUM) {
        bough_status status = settle(&def.assembly, s);
        if (!bough_is_ok(&status)) return status;
    }
    return bough_master_build(b->arena, &def, &s->master);
}

// -- whole ----------------------------------------------------------------------------------------

static bool take_arrays(builder *b) {
    size_t bodies = (size_t)b->scene->n_body, loads = (size_t)b->scene->n_load;
    b->s = bough_arena_take(b->arena, sizeof *b->s);
    b->body = bough_arena_take(b->arena, 2 * bodies * sizeof *b->body);
    b->end = bough_arena_take(b->arena, bodies * sizeof *b->end);
    bough_force_link_take(b->arena, b->scene, b->scene->n_body, &b->force);
    b->port = bough_arena_take(b->arena, bodies * sizeof *b->port);
    b->load = bough_arena_take(b->arena, (loads + 2) * sizeof *b->load);
    b->member = bough_arena_take(b->arena, (bodies + 1) * sizeof *b->member);
    b->connection = bough_arena_take(b->arena, 4 * bodies * sizeof *b->connection);
    b->event = bough_arena_doubles(b->arena, count_corners(b->scene));
    if (b->s == NULL) return false;
    b->s->scene = b->scene;
    b->s->beam = bough_arena_take(b->arena, bodies * sizeof *b->s->beam);
    b->s->rod = bough_arena_take(b->arena, bodies * sizeof *b->s->rod);
    return !bough_arena_exhausted(b->arena);
}

bough_status bough_simulation_build(bough_arena *arena, const bough_scene *scene,
                                    bough_simulation **simulation) {
    builder b = {.arena = arena, .scene = scene};
    if (!take_arrays(&b)) return out_of_memory();
    bough_status status = bough_pool_create(arena, scene->simulation.threads, &b.s->pool);
    if (bough_is_ok(&status)) status = set_bodies(&b);
    if (bough_is_ok(&status)) set_loads(&b);
    if (bough_is_ok(&status)) status = build_tree(&b);
    if (bough_is_ok(&status)) status = build_rods(&b);
    if (bough_is_ok(&status)) connect(&b);
    if (bough_is_ok(&status)) bough_simulation_update(b.s);
    if (bough_is_ok(&status)) status = bough_load_link_build(arena, b.s);
    if (bough_is_ok(&status) && scene->aero.node != NULL) {
        status = bough_aero_link_build(arena, b.s, &b.s->aero);
    }
    if (bough_is_ok(&status) && bough_drag_link_wanted(scene)) {
        status = bough_drag_link_build(arena, b.s, b.force.hub, &b.s->drag);
    }
    if (bough_is_ok(&status) && scene->control.node != NULL) {
        status = bough_control_link_build(arena, b.s, b.n_load - 1, &b.s->control);
    }
    if (bough_is_ok(&status)) status = build_master(&b);
    if (bough_is_ok(&status) && bough_arena_exhausted(arena)) status = out_of_memory();
    if (bough_is_ok(&status)) *simulation = b.s;
    return status;
}

// -- queries --------------------------------------------------------------------------------------

void bough_simulation_update(bough_simulation *s) {
    bough_tree_kinematics(s->tree, s->trunk.state, s->view);
}

int bough_simulation_n_joints(const bough_simulation *s) {
    int n = 0;
    for (int i = 0; i < s->scene->n_body; i++)
        n += s->scene->body[i].joint.kind != BOUGH_SCENE_FIXED;
    return n;
}

bough_beam *bough_simulation_beam(const bough_simulation *s, int body) {
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].body == &s->scene->body[body]) return &s->beam[k];
    }
    return NULL;
}

double bough_simulation_pitch(const bough_simulation *s, const bough_beam *beam) {
    const bough_scene_joint *joint = &beam->body->joint;
    if (joint->kind != BOUGH_SCENE_REVOLUTE || joint->axis != 2) return beam->body->pitch;
    int coordinate, speed;
    bough_tree_joint_rows(s->tree, (int)(beam->body - s->scene->body), &coordinate, &speed);
    return beam->body->pitch - s->trunk.state[coordinate];
}

void bough_simulation_root(const bough_simulation *s, const bough_beam *beam, double t,
                           double root[BOUGH_ROD_MOST_OUTPUTS]) {
    memset(root, 0, BOUGH_ROD_MOST_OUTPUTS * sizeof *root);
    if (beam->port < 0) return;
    const bough_subsystem *rod = &s->rod[beam->port];
    rod->ops->output(rod->self, t, rod->state, bough_simulation_rod_input(s, beam), root);
}

// A vertex in the body's frame: of a rod from its state, else undeformed and carried along.
typedef struct vertex {
    bough_vec3 position, velocity, angular; // angular velocity in body axes
    bough_mat3 rotation;
} vertex;

static vertex rigid_vertex(const bough_beam *beam, int i, bough_twist twist) {
    bough_vec3 x = beam->def.position[i];
    return (vertex){x, bough_add(twist.linear, bough_cross(twist.angular, x)), twist.angular,
                    bough_rotation_matrix(beam->def.rotation[i])};
}

static vertex rod_vertex(const bough_beam *beam, const double *state, int i) {
    const double *y = state + i - 1;
    int n = bough_beam_mesh(beam)->n;
    bough_quaternion p = {y[3 * n], y[4 * n], y[5 * n], y[6 * n]};
    bough_mat3 r = bough_rotation_matrix(bough_quaternion_normalised(p));
    bough_vec3 w = {y[10 * n], y[11 * n], y[12 * n]};
    return (vertex){{y[0], y[n], y[2 * n]},
                    {y[7 * n], y[8 * n], y[9 * n]},
                    bough_mat3_mul(r, w),
                    r};
}

// The last vertex of a rod that carries bodies; its velocity is resolved in its own axes.
static vertex end_vertex(const bough_simulation *s, const bough_beam *beam) {
    bough_quaternion p;
    bough_vec3 x = bough_simulation_beam_tip(s, beam, &p);
    bough_mat3 r = bough_rotation_matrix(p);
    bough_twist twist = s->view->twist[s->tree->ends[beam->end].link];
    return (vertex){x, bough_mat3_mul(r, twist.linear), bough_mat3_mul(r, twist.angular), r};
}

// state: of the vertices, NULL of a rigid body.
static vertex vertex_of(const bough_simulation *s, const bough_beam *beam, const double *state,
                        int i, bough_twist twist) {
    if (i == 0 || state == NULL) return rigid_vertex(beam, i, twist);
    if (i > bough_beam_mesh(beam)->n) return end_vertex(s, beam);
    return rod_vertex(beam, state, i);
}

bough_vec3 bough_simulation_beam_tip(const bough_simulation *s, const bough_beam *beam,
                                     bough_quaternion *rotation) {
    int last = beam->def.n_segment, stride = 1;
    const double *x = NULL;
    *rotation = beam->def.rotation[last];
    if (beam->port < 0) return beam->def.position[last];
    if (beam->end < 0) {
        stride = last;
        x = bough_beam_state(s, beam, last) + last - 1;
    } else {
        x = s->trunk.state + s->tree->links[s->tree->ends[beam->end].link].first_coordinate;
    }
    const double *p = x + 3 * stride;
    *rotation = bough_quaternion_normalised(
        (bough_quaternion){p[0], p[stride], p[2 * stride], p[3 * stride]});
    return bough_v3(x[0], x[stride], x[2 * stride]);
}

const double *bough_simulation_rod_input(const bough_simulation *s, const bough_beam *beam) {
    const bough_coupling *c = s->master->coupling;
    return c->input + c->assembly->input_offset[beam->port + 1];
}

void bough_simulation_beam_motion(const bough_simulation *s, const bough_beam *beam,
                                  bough_beam_motion motion) {
    const bough_frame *frame = &s->tree->markers[beam->marker];
    bough_transform pose = bough_tree_frame_pose(s->view, frame);
    bough_twist twist = bough_tree_frame_twist(s->view, frame);
    const double *state = beam->port < 0 ? NULL : bough_beam_state(s, beam, 1);
    for (int i = 0; i <= beam->def.n_segment; i++) {
        vertex v = vertex_of(s, beam, state, i, twist);
        motion.position[i] = bough_add(pose.position, bough_mat3_mul(pose.rotation, v.position));
        motion.rotation[i] = bough_mat3_product(pose.rotation, v.rotation);
        motion.velocity[i] = bough_mat3_mul(pose.rotation, v.velocity);
        motion.angular_velocity[i] = bough_mat3_mul(pose.rotation, v.angular);
    }
}

static void put_vertex(vertex v, bough_quaternion p, int i, int n, double *rows) {
    bough_vec3 w = bough_mat3_tmul(v.rotation, v.angular);
    const double values[BOUGH_BLADE_ROWS] = {v.position.x, v.position.y, v.position.z, p.w, p.x,
                                             p.y, p.z, v.velocity.x, v.velocity.y, v.velocity.z,
                                             w.x, w.y, w.z};
    for (int c = 0; c < BOUGH_BLADE_ROWS; c++) rows[c * n + i] = values[c];
}

void bough_simulation_beam_rows(const bough_simulation *s, const bough_beam *beam, double *rows) {
    bough_twist twist = bough_tree_frame_twist(s->view, &s->tree->markers[beam->marker]);
    int n = beam->def.n_segment + 1, inner = 0;
    if (beam->port >= 0) {
        const double *state = bough_beam_state(s, beam, 1);
        inner = bough_beam_mesh(beam)->n;
        for (int c = 0; c < BOUGH_BLADE_ROWS; c++)
            memcpy(rows + c * n + 1, state + c * inner, (size_t)inner * sizeof *rows);
    }
    put_vertex(rigid_vertex(beam, 0, twist), beam->def.rotation[0], 0, n, rows);
    for (int i = inner + 1; i < n; i++) {
        bough_quaternion p = beam->def.rotation[i];
        if (beam->port >= 0) bough_simulation_beam_tip(s, beam, &p);
        put_vertex(beam->port >= 0 ? end_vertex(s, beam) : rigid_vertex(beam, i, twist), p, i, n,
                   rows);
    }
}
