// Builds the bodies of the tree, the undeformed beams, and the members of flexible beams.
#include "apps/bough/model/build_internal.h"

#include "flexbody/section/section.h"

// -- joints ---------------------------------------------------------------------------------------

// The frame of the joint in the body of the tree that carries it: from x, where bodies hang on the parent, by
// the joint's placement and the pitch.
static bough_transform placement(const bough_scene_body *body, bough_transform x) {
    x = bough_transform_compose(x, body->joint.placement);
    if (body->pitch != 0) {
        bough_transform pitch = bough_transform_identity();
        pitch.rotation = bough_scene_rotation(BOUGH_SCENE_Z, -body->pitch);
        x = bough_transform_compose(x, pitch);
    }
    return x;
}

// The frame in which bodies hang on a beam: at its end, with the axes of the beam's body, which rotate with
// the last section. A placement is then the same for flexible and rigid beams.
static bough_transform beam_end(const bough_beam *beam) {
    int n = beam->def.n_segment;
    bough_mat3 section = bough_rotation_matrix(beam->def.rotation[n]);
    if (beam->end < 0) {
        return (bough_transform){beam->def.position[n], bough_transform_identity().rotation};
    }
    return (bough_transform){{0, 0, 0}, bough_mat3_transpose(section)};
}

static void set_parent(const bough_builder *b, const bough_scene_body *from, bough_body_def *to) {
    int parent = from->joint.parent;
    bough_transform start = bough_transform_identity();
    to->parent = parent;
    const bough_beam *beam = parent < 0 ? NULL : bough_simulation_beam(b->s, parent);
    if (beam != NULL) {
        start = beam_end(beam);
        if (beam->end >= 0) to->parent = b->end[beam->end].body;
    }
    to->joint = placement(from, start);
}

static void set_joint(const bough_builder *b, const bough_scene_body *from, bough_body_def *to) {
    const bough_scene_joint *joint = &from->joint;
    to->kind = (bough_joint_kind)joint->kind;
    set_parent(b, from, to);
    bool universal = to->kind == BOUGH_JOINT_UNIVERSAL;
    to->axis = bough_unit3(joint->axis);
    to->second_axis = bough_unit3(universal ? joint->second_axis : (joint->axis + 1) % 3);
    to->motion = joint->motion[0].def;
    to->second_motion = joint->motion[1].def;
    to->spring = joint->spring;
    memcpy(to->coordinates, joint->coordinates, sizeof joint->coordinates);
    memcpy(to->speeds, joint->speeds, sizeof joint->speeds);
    if (to->kind != BOUGH_JOINT_PLANAR) return;
    // the tree's linear speeds are in body axes
    double c = cos(joint->coordinates[2]), s = sin(joint->coordinates[2]);
    to->speeds[0] = c * joint->speeds[0] + s * joint->speeds[1];
    to->speeds[1] = c * joint->speeds[1] - s * joint->speeds[0];
}

// Mass and inertia of a rigid body, given or integrated over its rod.
static void set_mass(const bough_scene_body *from, bough_beam *beam, bough_body_def *to) {
    if (beam == NULL) {
        to->mass = from->mass;
        to->mass_centre = bough_v3_load(from->centre_of_mass);
        to->inertia = bough_mat3_symmetric(from->inertia);
        return;
    }
    bough_vertex_inertia whole = bough_section_rigid(&beam->def);
    bough_vec3 centre = bough_scale(1 / whole.mass, whole.moment);
    bough_mat3 steiner = bough_steiner(bough_scale(-0.5 * whole.mass, centre), centre);
    to->mass = whole.mass;
    to->mass_centre = centre;
    to->inertia = bough_mat3_add(bough_mat3_symmetric(whole.inertia), steiner);
    beam->vertex[0] = bough_inertia_of(to->mass, to->mass_centre, to->inertia);
}

// -- beams ----------------------------------------------------------------------------------------

static bool equal_structures(const bough_scene_structure *x, const bough_scene_structure *y) {
    bool equal = x->n_station == y->n_station && x->length == y->length &&
                 memcmp(x->damping, y->damping, sizeof x->damping) == 0;
    for (int k = 0; k < x->n_station && equal; k++) {
        equal = memcmp(&x->station[k].def, &y->station[k].def, sizeof x->station[k].def) == 0;
    }
    return equal;
}

// Equal beams, such as the blades of a rotor, share one mesh: a beam built before, or one of the simulation
// beside it; NULL: none is equal.
static const bough_beam *equal_beam(const bough_builder *b, const bough_beam *beam) {
    const bough_simulation *of[2] = {b->s, b->beside};
    const bough_scene_rod *rod = &beam->body->rod;
    for (int i = 0; i < 2 && of[i]; i++) {
        for (const bough_beam *other = of[i]->beam; other < of[i]->beam + of[i]->n_beam; other++) {
            const bough_scene_rod *its = &other->body->rod;
            bool equal = its->n_segment == rod->n_segment && its->grading == rod->grading;
            if (equal && equal_structures(&its->structure, &rod->structure)) return other;
        }
    }
    return NULL;
}

static bough_status discretise(bough_builder *b, bough_beam *beam) {
    const bough_beam *equal = equal_beam(b, beam);
    if (equal != NULL) {
        beam->def = equal->def;
        beam->def.name = beam->body->name;
        beam->def.carries = false;
        return bough_ok();
    }
    const bough_scene_structure *rod = &beam->body->rod.structure;
    size_t count = (size_t)rod->n_station;
    bough_section_station *station = bough_arena_take(b->arena, count * sizeof *station);
    for (int k = 0; k < rod->n_station; k++) station[k] = rod->station[k].def;
    bough_section_table table = {.name = beam->body->name,
                                 .n_station = rod->n_station,
                                 .station = station,
                                 .length = rod->length,
                                 .grading = beam->body->rod.grading};
    memcpy(table.damping, rod->damping, sizeof table.damping);
    return bough_scene_blame(
        beam->body->rod.node, "rod",
        bough_section_discretise(b->arena, &table, beam->body->rod.n_segment, &beam->def));
}

static bough_inertia vertex_inertia(const bough_vertex_inertia *v) {
    return (bough_inertia){v->mass, v->moment, bough_mat3_symmetric(v->inertia)};
}

// Inertia of the root vertex, which belongs to the carrier, in the body's frame about its origin.
static bough_inertia root_inertia(const bough_rod_def *def) {
    bough_transform x = {{0, 0, 0}, bough_rotation_matrix(def->rotation[0])};
    return bough_inertia_to_parent(&x, vertex_inertia(&def->inertia[0]));
}

// The last vertex becomes a body of the tree on a free joint to the rod's frame; it carries what the rod
// carries.
static void add_end(bough_builder *b, bough_beam *beam, int index) {
    const bough_rod_def *def = &beam->def;
    int n = def->n_segment, body = b->scene->n_body + b->s->n_end;
    bough_quaternion p = def->rotation[n];
    bough_vec3 x = def->position[n];
    const double q[BOUGH_JOINT_COORDINATES] = {x.x, x.y, x.z, p.w, p.x, p.y, p.z};
    bough_body_def *to = &b->body[body];
    *to = bough_body_def_default();
    to->name = bough_arena_print(b->arena, "%s end", beam->body->name);
    to->parent = index;
    to->kind = BOUGH_JOINT_FREE;
    memcpy(to->coordinates, q, sizeof q);
    beam->end = b->s->n_end++;
    beam->def.carries = true;
    beam->vertex[1] = vertex_inertia(&def->inertia[n]);
    b->end[beam->end] = (bough_end_def){body, beam->vertex[1]};
}

int bough_build_marker(bough_builder *b, const char *name, int body, bough_transform placement) {
    b->marker[b->tree.n_markers] = (bough_marker_def){name, body, placement};
    return b->tree.n_markers++;
}

static bool moves_under_ground_loads(const bough_scene *scene, int body) {
    for (int k = 0; k < scene->n_load; k++) {
        const bough_scene_load *load = &scene->load[k];
        if (load->body_name == NULL || load->body != body) continue;
        if (load->frame == BOUGH_SCENE_LOAD_GROUND) return bough_scene_moves(scene, body);
    }
    return false;
}

static bough_status add_beam(bough_builder *b, int index) {
    bough_simulation *s = b->s;
    bough_beam *beam = &s->beam[s->n_beam];
    beam->index = index;
    beam->body = &b->scene->body[index];
    beam->port = beam->end = -1;
    BOUGH_TRY(discretise(b, beam));
    beam->marker = bough_build_marker(b, beam->body->name, index, bough_transform_identity());
    s->n_beam++;
    if (beam->body->fidelity == BOUGH_SCENE_RIGID) return bough_ok();
    beam->port = s->n_rod;
    beam->vertex[0] = root_inertia(&beam->def);
    beam->in_ground = moves_under_ground_loads(b->scene, index);
    b->port[s->n_rod++] = (bough_port_def){beam->marker, beam->vertex[0], beam->in_ground};
    if (bough_scene_carried_by(b->scene, index) >= 0) add_end(b, beam, index);
    return bough_ok();
}

// Its marker and port come after those of all beams.
static void add_fmu(bough_builder *b, int index) {
    const char *name = b->scene->body[index].name;
    int marker = bough_build_marker(b, name, index, bough_transform_identity());
    b->port[b->s->n_rod + b->s->n_fmu++] = (bough_port_def){.marker = marker};
}

// -- a flexible beam as a member --------------------------------------------------------------------

static bough_status build_rod(bough_arena *arena, bough_beam *beam, const double *input,
                              bough_system *system) {
    bough_rod_model *model = NULL;
    BOUGH_TRY(bough_rod_create(arena, &beam->def, &model));
    beam->rod = bough_rod_body_create(arena, model, input);
    beam->mesh = model;
    beam->loads = bough_rod_body_loads(beam->rod);
    *system = bough_rod_body_system(beam->rod);
    return bough_ok();
}

static bough_status build_modal(bough_arena *arena, bough_beam *beam, const double *input,
                                bough_system *system) {
    const bough_scene_modal *modal = &beam->body->modal;
    int pieces = beam->body->fidelity == BOUGH_SCENE_MODAL ? 1 : modal->pieces;
    bough_modal_options options = {modal->modes, modal->statics, modal->stiffening};
    bough_modal_model *model = NULL;
    BOUGH_TRY(bough_modal_create(arena, &beam->def, pieces, options, &model));
    beam->modal = bough_modal_body_create(arena, model, input);
    beam->mesh = model->rod;
    beam->loads = bough_modal_body_loads(beam->modal);
    *system = bough_modal_body_system(beam->modal);
    return bough_ok();
}

bough_status bough_build_beam(bough_arena *arena, bough_beam *beam, const double *input,
                              bough_system *system) {
    bool rod = beam->body->fidelity == BOUGH_SCENE_ROD;
    BOUGH_TRY(rod ? build_rod(arena, beam, input, system) : build_modal(arena, beam, input, system));
    if (beam->in_ground) {
        beam->ground = bough_ground_body_create(arena, system, beam->mesh, beam->loads, beam->modal != NULL);
        *system = bough_ground_body_system(beam->ground);
    }
    return bough_ok();
}

// -- whole ----------------------------------------------------------------------------------------

bough_status bough_build_bodies(bough_builder *b) {
    for (int i = 0; i < b->scene->n_body; i++) { // beams first: bodies hang on their ends
        if (b->scene->body[i].rod.node == NULL) continue;
        BOUGH_TRY(add_beam(b, i));
    }
    for (int i = 0; i < b->scene->n_body; i++) {
        if (b->scene->body[i].fidelity == BOUGH_SCENE_FMU) add_fmu(b, i);
    }
    for (int i = 0; i < b->scene->n_body; i++) {
        const bough_scene_body *from = &b->scene->body[i];
        bough_body_def *to = &b->body[i];
        *to = bough_body_def_default();
        to->name = from->name;
        set_joint(b, from, to);
        if (from->fidelity != BOUGH_SCENE_RIGID && from->fidelity != BOUGH_SCENE_FMU) continue;
        set_mass(from, bough_simulation_beam(b->s, i), to);
    }
    return bough_ok();
}
