// Length and time of a scene, so that a search takes the same steps for a beam of a millimetre and of a
// kilometre.
#include "apps/bough/model/equilibrium_search.h"

#include "core/tree/dynamics.h"

// Length and time for which the scales of the states and the constants of the search are chosen [m], [s].
static const double usual_length = 500, usual_time = 8;

// -- length ---------------------------------------------------------------------------------------

static double spring_extent(const bough_simulation *s, const bough_spring_def *spring) {
    const bough_frame *frame = s->tree->markers;
    bough_vec3 a = bough_tree_frame_pose(s->view, &frame[spring->marker[0]]).position,
               b = bough_tree_frame_pose(s->view, &frame[spring->marker[1]]).position;
    return bough_norm(bough_sub(b, a));
}

// The longest rod, link, spring or distance to a mass centre [m]; 0: there is none.
static double find_length(const bough_simulation *s) {
    double length = 0;
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        length = fmax(length, beam->def.span[beam->def.n_segment]);
    }
    for (int i = 0; i < s->tree->n_links; i++) {
        const bough_link *link = &s->tree->links[i];
        const bough_inertia *inertia = &link->inertia;
        if (inertia->mass > 0) length = fmax(length, bough_norm(inertia->first) / inertia->mass);
        if (link->parent != BOUGH_GROUND) length = fmax(length, bough_norm(link->joint.placement.position));
    }
    for (int i = 0; i < s->tree->n_springs; i++)
        length = fmax(length, spring_extent(s, &s->tree->springs[i]));
    return length;
}

// -- acceleration ---------------------------------------------------------------------------------

static double find_mass(const bough_simulation *s) {
    double mass = 0;
    for (int i = 0; i < s->tree->n_links; i++) mass += s->tree->links[i].inertia.mass;
    for (int k = 0; k < s->n_beam; k++) {
        const bough_rod_model *m = s->beam[k].mesh;
        for (int i = 1; m && i <= m->n; i++) mass += m->vertex[i].mass;
    }
    return mass;
}

static double size_of(const double w[6], double length) {
    return hypot(w[0], hypot(w[1], w[2])) + hypot(w[3], hypot(w[4], w[5])) / length;
}

static double largest_value(const bough_scene_load *load, double otherwise) {
    double largest = load->n_time > 0 ? 0 : otherwise;
    for (int i = 0; i < load->n_time; i++) largest = fmax(largest, fabs(load->values[i]));
    return largest;
}

// [N]
static double load_of(const bough_simulation *s, const bough_scene_load *load, double length) {
    if (load->joint_name) {
        bool turns = s->scene->body[load->joint].joint.kind == BOUGH_JOINT_REVOLUTE;
        return fabs(largest_value(load, load->amount)) / (turns ? length : 1);
    }
    double size = size_of(load->wrench, length), factor = largest_value(load, 1);
    if (load->place != BOUGH_SCENE_ALONG) return factor * size;
    double end = size_of(load->end, length);
    return factor * (size + end) / 2 * (load->span[1] - load->span[0]);
}

// Force of a joint's spring at the start [N].
static double joint_force(const bough_tree *tree, const bough_link *link, double length) {
    double q = link->n_coordinates > 0 ? tree->initial[link->first_coordinate] : 0;
    double force = link->spring.stiffness * fabs(q - link->spring.rest);
    return link->joint.kind == BOUGH_JOINT_REVOLUTE ? force / length : force;
}

// [rad/s]
static double find_spin(const bough_tree *tree) {
    double spin = 0;
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        int slides = bough_joint_n_slides(link->joint.kind);
        for (int k = slides; k < link->n_speeds; k++)
            spin = fmax(spin, fabs(tree->initial[tree->n_q + link->first_speed + k]));
    }
    return spin;
}

// Sum of gravity, centripetal acceleration, and that of the whole mass by all loads and springs [m/s²].
static double find_acceleration(const bough_simulation *s, double length) {
    const bough_tree *tree = s->tree;
    double force = 0, mass = find_mass(s), spin = find_spin(tree);
    for (int i = 0; i < s->scene->n_load; i++) force += load_of(s, &s->scene->load[i], length);
    for (int i = 0; i < tree->n_links; i++) force += joint_force(tree, &tree->links[i], length);
    for (int i = 0; i < tree->n_springs; i++) {
        const bough_spring_def *spring = &tree->springs[i];
        force += spring->stiffness * fabs(spring_extent(s, spring) - spring->length);
    }
    double pushed = mass > 0 && isfinite(force / mass) ? force / mass : 0;
    return bough_norm(tree->gravity) + spin * spin * length + pushed;
}

// -- units ----------------------------------------------------------------------------------------

bough_equilibrium_units bough_equilibrium_measure(bough_simulation *s) {
    bough_equilibrium_units unit = {1, 1, 1, 0, 0};
    bough_tree_kinematics(s->tree, s->tree->initial, s->view);
    double length = find_length(s);
    double acceleration = length > 0 ? find_acceleration(s, length) : 0;
    if (length > 0) unit.length = length / usual_length;
    if (acceleration > 0) unit.period = sqrt(length / acceleration);
    if (acceleration > 0) unit.time = unit.period / usual_time;
    unit.force = find_mass(s) * acceleration;
    unit.moment = unit.force * length;
    bough_simulation_update(s);
    return unit;
}

static void scale_links(const bough_tree *tree, bough_equilibrium_units unit, double *scale) {
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        int slides = bough_joint_n_slides(link->joint.kind);
        for (int k = 0; k < slides; k++) scale[link->first_coordinate + k] *= unit.length;
        for (int k = 0; k < link->n_speeds; k++)
            scale[tree->n_q + link->first_speed + k] *= (k < slides ? unit.length : 1) / unit.time;
    }
}

static void scale_rod(int vertices, bough_equilibrium_units unit, double *scale) {
    for (int k = 0; k < BOUGH_ROD_STATES * vertices; k++) {
        int part = k / vertices;
        bool speed = part >= BOUGH_ROD_U, turns = part >= (speed ? BOUGH_ROD_W : BOUGH_ROD_P);
        scale[k] *= (turns ? 1 : unit.length) / (speed ? unit.time : 1);
    }
}

bough_equilibrium_units bough_equilibrium_find_units(bough_simulation *s, double *scale) {
    bough_equilibrium_units unit = bough_equilibrium_measure(s);
    bough_assembly_scales(s->assembly, scale);
    scale_links(s->tree, unit, scale);
    for (int k = 0; k < s->n_beam; k++) {
        const bough_beam *beam = &s->beam[k];
        if (beam->rod) scale_rod(beam->mesh->n, unit, scale + bough_beam_row(s, beam));
    }
    return unit;
}
