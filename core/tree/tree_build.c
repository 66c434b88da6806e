// Builds the tree from its def: bodies by level from the ground, welded bodies in one link, frames, forces.
#include "core/tree/tree.h"

#include "core/tree/dynamics.h"
#include "core/tree/loop.h"

// -- before it is built ---------------------------------------------------------------------------

// Placements are sums of steps, which may overflow.
static bough_status check_place(const char *what, const char *name, bough_vec3 x) {
    if (isfinite(x.x) && isfinite(x.y) && isfinite(x.z)) return bough_ok();
    return bough_fail(BOUGH_INVALID, "%s '%s': its position is not finite", what, name);
}

// Of joints and markers.
static bough_status check_places(const bough_tree_def *def) {
    for (int b = 0; b < def->n_bodies; b++) {
        const bough_body_def *body = &def->bodies[b];
        BOUGH_TRY(check_place("joint of body", body->name, body->joint.position));
    }
    for (int m = 0; m < def->n_markers; m++) {
        const bough_marker_def *marker = &def->markers[m];
        BOUGH_TRY(check_place("marker", marker->name, marker->placement.position));
    }
    return bough_ok();
}

// Levels from 1, 0 where not known yet. Every body is visited once.
static void find_level(const bough_tree_def *def, int body, int *level) {
    int steps = 0, top = body;
    for (; top >= 0 && level[top] == 0; top = def->bodies[top].parent) {
        steps++;
        assert(steps <= def->n_bodies);
    }
    int above = top < 0 ? 0 : level[top];
    for (int b = body; b != top; b = def->bodies[b].parent) level[b] = above + steps--;
}

// The bodies level by level from the ground, within a level in the order of the definition: order
// (n_bodies). scratch (2·n_bodies + 1) zeros.
static void order_bodies(const bough_tree_def *def, int *scratch, int *order) {
    int n = def->n_bodies, *level = scratch, *first = scratch + n; // first (n + 1): of each level
    for (int b = 0; b < n; b++) {
        find_level(def, b, level);
        first[level[b]]++;
    }
    // counting sort by level
    for (int k = 1; k <= n; k++) first[k] += first[k - 1];
    for (int b = 0; b < n; b++) order[first[level[b] - 1]++] = b;
}

// -- the model ------------------------------------------------------------------------------------

static bough_frame ground_frame(void) {
    return (bough_frame){.link = BOUGH_GROUND, .placement = bough_transform_identity()};
}

// Steiner: the inertia in the link's frame.
static void add_inertia(bough_tree *tree, const bough_frame *frame, bough_inertia inertia) {
    if (frame->link < 0) return; // the ground carries it
    bough_inertia *sum = &tree->links[frame->link].inertia;
    *sum = bough_inertia_add(*sum, bough_inertia_to_parent(&frame->placement, inertia));
}

static bough_vec3 direction(bough_vec3 axis) {
    double length = bough_norm(axis);
    return length > 0 ? bough_scale(1 / length, axis) : axis;
}

// A link of a body's joint; `parent` is a link or the ground.
static int add_link(bough_tree *tree, int body, int parent, bough_joint joint) {
    bough_link *link = &tree->links[tree->n_links];
    link->parent = parent;
    link->body = body;
    link->joint = joint;
    link->n_coordinates = bough_joint_n_coordinates(joint.kind);
    link->n_speeds = bough_joint_n_speeds(joint.kind);
    link->first_coordinate = tree->n_q;
    link->first_speed = tree->n_v;
    tree->n_q += link->n_coordinates;
    tree->n_v += link->n_speeds;
    return tree->n_links++;
}

// A universal joint has no constant motion subspace; two revolute ones have. A driven coordinate needs a link
// of its own.
static int add_links(bough_tree *tree, const bough_body_def *b, int body, bough_frame parent) {
    bough_joint joint = {b->kind, bough_transform_compose(parent.placement, b->joint), direction(b->axis),
                         direction(b->second_axis)};
    bool universal = b->kind == BOUGH_JOINT_UNIVERSAL;
    bool driven = b->motion.given || b->second_motion.given;
    if (!universal && !(driven && b->kind == BOUGH_JOINT_CYLINDRICAL)) {
        int only = add_link(tree, body, parent.link, joint);
        tree->links[only].spring = b->spring;
        return only;
    }
    joint.kind = universal ? BOUGH_JOINT_REVOLUTE : BOUGH_JOINT_PRISMATIC;
    // the first link carries no body, the second one the body
    int cross = add_link(tree, body, parent.link, joint);
    joint.kind = BOUGH_JOINT_REVOLUTE;
    joint.placement = bough_transform_identity();
    if (universal) joint.axis = joint.second;
    int link = add_link(tree, body, cross, joint);
    tree->links[link].part = 1;
    return link;
}

// After the parent. A body on a fixed joint belongs to the parent's link.
static void place_body(bough_tree *tree, const bough_body_def *b, int body) {
    bough_frame parent = b->parent < 0 ? ground_frame() : tree->bodies[b->parent];
    bough_frame *frame = &tree->bodies[body];
    if (b->kind == BOUGH_JOINT_FIXED) {
        frame->link = parent.link;
        frame->placement = bough_transform_compose(parent.placement, b->joint);
    } else {
        frame->link = add_links(tree, b, body, parent);
        frame->placement = bough_transform_identity();
    }
    add_inertia(tree, frame, bough_inertia_of(b->mass, b->mass_centre, b->inertia));
}

// Markers, ports and ends on their links; the root vertex of a rod adds its inertia to the carrier's link.
static void place_attachments(bough_tree *tree, const bough_tree_def *def) {
    for (int m = 0; m < def->n_markers; m++) {
        const bough_marker_def *marker = &def->markers[m];
        bough_frame carrier = marker->body < 0 ? ground_frame() : tree->bodies[marker->body];
        tree->markers[m].link = carrier.link;
        tree->markers[m].placement = bough_transform_compose(carrier.placement, marker->placement);
    }
    for (int p = 0; p < def->n_ports; p++) {
        tree->ports[p].link = tree->markers[def->ports[p].marker].link;
        tree->ports[p].placement = tree->markers[def->ports[p].marker].placement;
        add_inertia(tree, &tree->ports[p], def->ports[p].root);
        if (def->ports[p].axes) tree->axes[tree->n_axes++] = p;
    }
    for (int e = 0; e < def->n_ends; e++) {
        assert(def->bodies[def->ends[e].body].kind == BOUGH_JOINT_FREE);
        tree->ends[e].link = tree->bodies[def->ends[e].body].link;
        tree->ends[e].placement = bough_transform_identity();
        add_inertia(tree, &tree->ends[e], def->ends[e].inertia);
    }
}

// Given motions belong to links of one coordinate.
static void create_motions(bough_arena *arena, const bough_tree_def *def, bough_tree *tree) {
    for (int i = 0; i < tree->n_links; i++) {
        bough_link *link = &tree->links[i];
        const bough_body_def *b = &def->bodies[link->body];
        const bough_motion_def *given = link->part == 0 ? &b->motion : &b->second_motion;
        if (!given->given) continue;
        assert(link->n_speeds == 1);
        link->motion = bough_motion_create(arena, given, b->coordinates[link->part]);
    }
}

// The initial state in the links' order, with given motions in place.
static void set_initial(bough_tree *tree, const bough_tree_def *def) {
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        const bough_body_def *b = &def->bodies[link->body];
        double *q = tree->initial + link->first_coordinate;
        memcpy(q, b->coordinates + link->part, (size_t)link->n_coordinates * sizeof(double));
        memcpy(tree->initial + tree->n_q + link->first_speed, b->speeds + link->part,
               (size_t)link->n_speeds * sizeof(double));
        bough_joint_normalise(&link->joint, q);
    }
    bough_tree_prescribe(tree, 0, tree->initial);
}

// Forces as in the definition.
static void copy_forces(bough_arena *arena, const bough_tree_def *def, bough_tree *tree) {
    tree->gravity = def->gravity;
    tree->n_loads = def->n_loads;
    tree->n_springs = def->n_springs;
    tree->n_bushings = def->n_bushings;
    tree->n_applied = def->n_applied;
    tree->loads = bough_arena_copy(arena, def->loads, (size_t)def->n_loads * sizeof *def->loads);
    tree->steered = bough_arena_doubles(arena, 4 * (size_t)def->n_loads);
    tree->springs = bough_arena_copy(arena, def->springs, (size_t)def->n_springs * sizeof *def->springs);
    tree->bushings = bough_arena_copy(arena, def->bushings, (size_t)def->n_bushings * sizeof *def->bushings);
    tree->applied = bough_arena_copy(arena, def->applied, (size_t)def->n_applied * sizeof *def->applied);
}

static void take_frames(bough_arena *arena, const bough_tree_def *def, bough_tree *tree) {
    size_t n = (size_t)def->n_bodies, n_markers = (size_t)def->n_markers, n_ports = (size_t)def->n_ports;
    tree->n_bodies = def->n_bodies;
    tree->n_markers = def->n_markers;
    tree->n_ports = def->n_ports;
    tree->n_ends = def->n_ends;
    tree->links = bough_arena_take(arena, 2 * n * sizeof(bough_link)); // a universal joint is two
    tree->bodies = bough_arena_take(arena, n * sizeof(bough_frame));
    tree->markers = bough_arena_take(arena, n_markers * sizeof(bough_frame));
    tree->external = bough_arena_take(arena, n_markers * sizeof(bough_external));
    tree->ports = bough_arena_take(arena, n_ports * sizeof(bough_frame));
    tree->axes = bough_arena_take(arena, n_ports * sizeof(int));
    tree->ends = bough_arena_take(arena, (size_t)def->n_ends * sizeof(bough_frame));
    tree->initial = bough_arena_doubles(arena, (BOUGH_JOINT_COORDINATES + BOUGH_JOINT_SPEEDS) * n);
    for (int b = 0; b < def->n_bodies; b++)
        tree->bodies[b].name = bough_arena_string(arena, def->bodies[b].name);
    for (int m = 0; m < def->n_markers; m++)
        tree->markers[m].name = bough_arena_string(arena, def->markers[m].name);
}

// A joint that moves no inertia has no acceleration; loops must close.
static bough_status check_dynamics(bough_arena *arena, const bough_tree_def *def, bough_tree *tree) {
    bough_tree_data *data = bough_tree_data_create(arena, tree);
    double *acceleration = bough_arena_doubles(arena, (size_t)tree->n_v);
    // the dynamics at the initial state find a joint without inertia
    bough_tree_kinematics(tree, tree->initial, data);
    if (bough_tree_free_dynamics(tree, data, 0, NULL, acceleration)) {
        return bough_loops_assemble(tree, data);
    }
    const bough_body_def *b = &def->bodies[tree->links[data->singular].body];
    return bough_fail(BOUGH_INVALID,
                      "body '%s': its %s joint moves no inertia in some direction; give the body "
                      "or what it carries a mass and a moment of inertia",
                      b->name, bough_joint_name(b->kind));
}

bough_status bough_tree_create(bough_arena *arena, const bough_tree_def *def, bough_tree **out) {
    BOUGH_TRY(check_places(def));
    size_t n = (size_t)def->n_bodies;
    int *scratch = bough_arena_take(arena, (3 * n + 1) * sizeof *scratch), *order = scratch;
    order_bodies(def, scratch + n, order);
    bough_tree *tree = bough_arena_take(arena, sizeof *tree);
    // memory and forces, then links from the ground, then what is on them
    take_frames(arena, def, tree);
    copy_forces(arena, def, tree);
    for (int k = 0; k < def->n_bodies; k++) place_body(tree, &def->bodies[order[k]], order[k]);
    place_attachments(tree, def);
    for (int i = 0; i < tree->n_links; i++) {
        bough_tree_rigid_matrix(&tree->links[i].inertia, tree->links[i].matrix);
    }
    create_motions(arena, def, tree);
    set_initial(tree, def);
    *out = tree;
    BOUGH_TRY(bough_loops_place(arena, def, tree));
    return check_dynamics(arena, def, tree);
}

bough_tree_data *bough_tree_data_create(bough_arena *arena, const bough_tree *tree) {
    size_t n = (size_t)tree->n_links;
    bough_tree_data *d = bough_arena_take(arena, sizeof *d);
    d->relative = bough_arena_take(arena, n * sizeof *d->relative);
    d->pose = bough_arena_take(arena, n * sizeof *d->pose);
    d->joint_twist = bough_arena_take(arena, n * sizeof *d->joint_twist);
    d->twist = bough_arena_take(arena, n * sizeof *d->twist);
    d->gravity = bough_arena_take(arena, n * sizeof *d->gravity);
    d->acceleration = bough_arena_take(arena, n * sizeof *d->acceleration);
    d->rotation = bough_arena_take(arena, n * sizeof *d->rotation);
    d->wrench = bough_arena_take(arena, n * sizeof *d->wrench);
    bough_arena_each(arena, 36 * n, &d->articulated, &d->joint_gain, &d->joint_factor);
    bough_arena_each(arena, (size_t)tree->n_v, &d->force, &d->drive, &d->passive);
    d->loops = bough_loops_create(arena, tree);
    return d;
}
