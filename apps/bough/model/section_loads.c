#include "apps/bough/model/section_loads.h"

#include "apps/bough/model/build_internal.h"
#include "core/base/linalg.h"

// -- segments -------------------------------------------------------------------------------------

static bough_vec3 segment_row(const bough_section_loads *x, int i, int row) {
    const double *f = x->scratch.segment + i;
    int n = x->beam->mesh->stride;
    return bough_v3(f[row * n], f[(row + 1) * n], f[(row + 2) * n]);
}

bough_quaternion bough_section_loads_rotation(const bough_section_loads *x, int vertex) {
    const double *p = x->scratch.vertex + vertex;
    int n = x->beam->mesh->stride;
    return (bough_quaternion){p[3 * n], p[4 * n], p[5 * n], p[6 * n]};
}

bough_vec3 bough_section_loads_position(const bough_section_loads *x, int vertex) {
    const double *v = x->scratch.vertex + vertex;
    int n = x->beam->mesh->stride;
    return bough_v3(v[0], v[n], v[2 * n]);
}

static bough_mat3 vertex_axes(const bough_section_loads *x, int i) {
    return bough_rotation_matrix(bough_section_loads_rotation(x, i));
}

// The force of a segment, with what the added masses beyond it take from it.
static bough_vec3 segment_force(const bough_section_loads *x, int i) {
    return bough_add(segment_row(x, i, 0), x->lack[i].force);
}

static bough_vec3 step_between(const bough_section_loads *x, int i) {
    return bough_sub(bough_section_loads_position(x, i + 1), bough_section_loads_position(x, i));
}

// The moments of a segment, linear over its length, at its two vertices, in the body's axes [N m].
static void linear_moments(const bough_section_loads *x, int i, bough_vec3 moment[2]) {
    const bough_wrench *lack = &x->lack[i];
    bough_vec3 left = bough_mat3_mul(vertex_axes(x, i), segment_row(x, i, 3));
    bough_vec3 right = bough_mat3_mul(vertex_axes(x, i + 1), segment_row(x, i, 6));
    moment[0] = bough_add(left, lack->moment);
    moment[1] = bough_sub(bough_sub(lack->moment, bough_cross(step_between(x, i), lack->force)), right);
}

static bough_quaternion rotation_at(const bough_section_loads *x, int i, double fraction) {
    return bough_rotation_between(bough_section_loads_rotation(x, i), bough_section_loads_rotation(x, i + 1),
                                  fraction);
}

// The axes of the section at a fraction of a segment's length.
static bough_mat3 axes_at(const bough_section_loads *x, int i, double fraction) {
    return bough_rotation_matrix(rotation_at(x, i, fraction));
}

static double segment_length(const bough_section_loads *x, int i) {
    return x->beam->def.span[i + 1] - x->beam->def.span[i];
}

// From the left to the right vertex, per length.
static bough_vec3 chord(const bough_section_loads *x, int i) {
    return bough_scale(1 / segment_length(x, i), step_between(x, i));
}

// -- what acts within a segment -------------------------------------------------------------------

// Change of the acceleration along segment i, per length.
static bough_vec3 acceleration_slope(const bough_section_loads *x, int i) {
    bough_vec3 change = bough_sub(x->acceleration[i + 1], x->acceleration[i]);
    return bough_scale(1 / (x->centre[i + 1] - x->centre[i]), change);
}

bough_rod_place bough_section_loads_place(const bough_section_loads *x, int segment, double fraction) {
    const bough_rod_sections *sections = &x->beam->mesh->sections;
    const double *span = x->beam->def.span + segment;
    double at = span[0] + fraction * segment_length(x, segment);
    bough_rod_place p = {.segment = segment, .fraction = fraction};
    p.inner = sections->mass(sections->axis, &x->beam->def, segment, at);
    p.twist = sections->bend(sections->axis, span, at, p.bend);
    return p;
}

bough_rod_place bough_section_loads_end(const bough_section_loads *x, int segment, bool right) {
    bough_rod_place end = {.segment = segment, .fraction = right};
    if (right) end.inner = x->mass[segment];
    return end;
}

// theory (121): what inertia and weight within a segment add, at a place, to the constant force and the
// linear moment that balance the masses at its vertices.
static bough_wrench inertia_load(const bough_section_loads *x, const bough_rod_place *p) {
    int i = p->segment;
    const bough_axial_mass *at_vertex = &x->beam->mesh->vertex[i].outer;
    double from = x->beam->def.span[i], distance = p->fraction * segment_length(x, i);
    double mass = p->inner.mass - at_vertex->mass, moment = p->inner.moment - at_vertex->moment;
    double second = p->inner.second - at_vertex->second;
    bough_vec3 offset = bough_mat3_mul(vertex_axes(x, i), bough_sub(p->inner.offset, at_vertex->offset));
    bough_vec3 slope = acceleration_slope(x, i);
    bough_vec3 a = bough_axpy(from - x->centre[i], slope, x->acceleration[i]);
    bough_vec3 arm = bough_scale(moment - distance * mass, a);
    arm = bough_axpy(second - distance * moment, slope, arm);
    return (bough_wrench){bough_axpy(moment, slope, bough_scale(mass, a)),
                          bough_add(bough_cross(chord(x, i), arm), bough_cross(offset, a))};
}

// Load k at a place on segment i, in the body's axes: the whole of a concentrated one, else per length.
static bough_wrench value_at(const bough_section_loads *x, int k, int i, double place) {
    const bough_scene_load *l = x->load[k].of;
    bough_rod_reach reach = x->load[k].reach;
    double part = reach.to > reach.from ? (place - reach.from) / (reach.to - reach.from) : 0, w[6];
    for (int c = 0; c < 6; c++) w[c] = x->load[k].factor * (l->wrench[c] + part * (l->end[c] - l->wrench[c]));
    bough_wrench value = bough_wrench_load(w);
    if (l->frame == BOUGH_SCENE_LOAD_BODY) return value;
    double fraction = (place - x->beam->def.span[i]) / segment_length(x, i);
    bough_mat3 axes = l->frame == BOUGH_SCENE_LOAD_GROUND ? x->ground : axes_at(x, i, fraction);
    return (bough_wrench){bough_mat3_mul(axes, value.force), bough_mat3_mul(axes, value.moment)};
}

// What load k, from one place to another on segment i, adds to the load in the section at s: by its part that
// the left vertex has, or because it lies before s.
static void add_part(const bough_section_loads *x, int k, int i, bough_rod_reach part, double s,
                     bool at_vertex, bough_wrench *sum) {
    double h = segment_length(x, i), from = x->beam->def.span[i], half = 0.5 * (part.to - part.from);
    for (int p = 0; p < (half > 0 ? 2 : 1); p++) { // Gauss's points, exact to degree 3
        double place = half > 0 ? part.from + half * (1 + (2 * p - 1) / sqrt(3)) : part.from;
        double weight = (half > 0 ? half : 1) * (at_vertex ? 1 - (place - from) / h : -1);
        bough_wrench value = value_at(x, k, i, place);
        bough_vec3 arm = bough_scale(at_vertex ? s - from : s - place, chord(x, i));
        value.moment = bough_sub(value.moment, bough_cross(arm, value.force));
        sum->force = bough_axpy(weight, value.force, sum->force);
        sum->moment = bough_axpy(weight, value.moment, sum->moment);
    }
}

// theory (106, 121): the same by inertia and by the scene's loads; a concentrated one at the section's own
// place is part of its load.
static bough_wrench within(const bough_section_loads *x, const bough_rod_place *p) {
    int i = p->segment;
    const double *span = x->beam->def.span;
    double s = p->fraction == 1 ? span[i + 1] : span[i] + p->fraction * segment_length(x, i);
    bough_wrench sum = inertia_load(x, p);
    for (int k = 0; k < x->n_load; k++) {
        bough_rod_reach part = x->load[k].reach;
        bool point = part.from == part.to, last = i == x->beam->def.n_segment - 1;
        // a point between two segments belongs to the right one
        if (part.to < span[i] || part.from > span[i + 1] || (point && !last && part.from == span[i + 1]))
            continue;
        part = (bough_rod_reach){fmax(part.from, span[i]), fmin(part.to, span[i + 1])};
        add_part(x, k, i, part, s, true, &sum);
        part.to = fmin(part.to, s);
        if (part.from < s) add_part(x, k, i, part, s, false, &sum);
    }
    return sum;
}

// Force and moment of the segment itself on its bowed axis, and of what is known to act within it.
static bough_wrench known_load(const bough_section_loads *x, const bough_rod_place *p) {
    int i = p->segment;
    double fraction = p->fraction;
    bough_wrench load = within(x, p);
    bough_vec3 linear[2], bend = bough_sub(vertex_axes(x, i + 1).c3, vertex_axes(x, i).c3);
    linear_moments(x, i, linear);
    load.force = bough_add(load.force, segment_force(x, i));
    load.moment = bough_add(load.moment, bough_between(linear[0], linear[1], fraction));
    double bow = segment_length(x, i) * fraction * (fraction - 1) / 2;
    load.moment = bough_axpy(-bow, bough_cross(bend, load.force), load.moment);
    return load;
}

static bough_wrench known_at_end(const bough_section_loads *x, int i, bool right) {
    bough_rod_place end = bough_section_loads_end(x, i, right);
    return known_load(x, &end);
}

// -- what acts on the vertices --------------------------------------------------------------------

static bough_wrench mix(double a, bough_wrench x, double b, bough_wrench y) {
    return (bough_wrench){bough_axpy(a, x.force, bough_scale(b, y.force)),
                          bough_axpy(a, x.moment, bough_scale(b, y.moment))};
}

// theory (119): what a vertex carries beyond the known, as a load per length there: the air, and inertia of
// sections that turn.
static bough_wrench jump_at(const bough_section_loads *x, int j) {
    int n = x->beam->def.n_segment;
    bough_wrench inner = j > 0 ? known_at_end(x, j - 1, true) : x->root;
    bough_wrench outer = j < n ? known_at_end(x, j, false) : x->end;
    double length = (j > 0 ? segment_length(x, j - 1) : 0) + (j < n ? segment_length(x, j) : 0);
    return mix(2 / length, inner, -2 / length, outer);
}

static bough_wrench spread_at(const bough_section_loads *x, int j) {
    int n = x->beam->def.n_segment;
    if (j > 0 && j < n) return jump_at(x, j);
    double own = n > 1 ? 1.5 : 2;
    return mix(own, jump_at(x, j), 1 - own, jump_at(x, j > 0 ? j - 1 : 1));
}

// theory (118)
bough_wrench bough_section_loads_at(const bough_section_loads *x, const bough_rod_place *place) {
    int i = place->segment;
    double f = place->fraction, h = segment_length(x, i);
    double left = f * (f * f / 6 - f / 2 + 1. / 3), right = f * (1 - f * f) / 6;
    bough_wrench a = spread_at(x, i), b = spread_at(x, i + 1);
    bough_wrench more = mix(h * (1. / 3 - f + f * f / 2), a, h * (1. / 6 - f * f / 2), b);
    bough_vec3 arm = bough_axpy(left, a.force, bough_scale(right, b.force));
    more.moment = bough_axpy(-h * h, bough_cross(chord(x, i), arm), more.moment);
    return mix(1, known_load(x, place), 1, more);
}

// -- whole ----------------------------------------------------------------------------------------

static void find_scene_loads(bough_arena *arena, bough_section_loads *x) {
    const bough_simulation *s = x->simulation;
    x->load = bough_arena_take(arena, (size_t)s->scene->n_load * sizeof *x->load);
    for (int k = 0; k < s->scene->n_load; k++) {
        const bough_scene_load *load = &s->scene->load[k];
        if (load->body_name == NULL || &s->scene->body[load->body] != x->beam->body) continue;
        x->load[x->n_load++] =
            (bough_section_scene_load){load, s->load_schedule[k], bough_load_reach(load, x->beam->mesh), 0};
    }
}

bough_section_loads bough_section_loads_create(bough_arena *arena, const bough_simulation *s,
                                               const bough_beam *beam) {
    const bough_rod_model *m = beam->mesh;
    bough_section_loads x = {.simulation = s, .beam = beam};
    find_scene_loads(arena, &x);
    bough_rod_scratch_init(&x.scratch, arena, m);
    size_t n = (size_t)m->n_segment;
    x.lack = bough_arena_take(arena, n * sizeof *x.lack);
    x.acceleration = bough_arena_take(arena, (n + 1) * sizeof *x.acceleration);
    x.centre = bough_arena_doubles(arena, n + 1);
    x.mass = bough_arena_take(arena, n * sizeof *x.mass);
    for (int i = 0; i <= m->n_segment; i++) {
        x.centre[i] = m->span[i] + m->vertex[i].moment.z / m->vertex[i].mass;
        if (i == m->n_segment) break;
        x.mass[i] = m->sections.mass(m->sections.axis, &beam->def, i, m->span[i + 1]);
    }
    return x;
}

// The force on the mass of vertex i by loads, segments and what is beyond the ends, per mass: a − g of its
// mass centre.
static bough_vec3 acceleration_of(const bough_section_loads *x, int i) {
    const double *load = x->scratch.load + i;
    int stride = x->beam->mesh->stride, n = x->beam->mesh->n_segment;
    bough_vec3 force = bough_v3(load[0], load[stride], load[2 * stride]);
    force = bough_sub(force, i > 0 ? segment_row(x, i - 1, 0) : x->root.force);
    force = bough_add(force, i < n ? segment_row(x, i, 0) : x->end.force);
    return bough_scale(1 / x->beam->mesh->vertex[i].mass, force);
}

// theory (120)
static void find_lack(bough_section_loads *x) {
    const bough_rod_model *m = x->beam->mesh;
    bough_wrench sum = {{0, 0, 0}, {0, 0, 0}};
    for (int i = m->n_segment; i > 0; i--) {
        const bough_vertex_inertia *vertex = &m->vertex[i];
        bough_vec3 slope = acceleration_slope(x, i - 1);
        bough_vec3 a = bough_axpy(m->span[i] - x->centre[i], slope, x->acceleration[i]);
        sum.force = bough_axpy(vertex->added_mass, a, sum.force);
        bough_vec3 angular = bough_cross(vertex_axes(x, i).c3, slope);
        sum.moment = bough_axpy(vertex->added_inertia, angular, sum.moment);
        sum.moment = bough_add(sum.moment, bough_cross(step_between(x, i - 1), sum.force));
        x->lack[i - 1] = sum;
    }
}

// The scene's loads at t; those at the tip are part of the load there.
static void set_scene_loads(bough_section_loads *x, double t) {
    const bough_rod_model *m = x->beam->mesh;
    double tip = m->span[m->n_segment];
    x->ground = bough_mat3_transpose(bough_beam_pose(x->simulation, x->beam).rotation);
    for (int k = 0; k < x->n_load; k++) {
        x->load[k].factor = bough_schedule_at(x->load[k].schedule, t);
        if (x->load[k].reach.from == tip)
            x->end = bough_wrench_add(x->end, value_at(x, k, m->n_segment - 1, tip));
    }
}

// The wrenches of what is beyond the ends.
static void find_ends(bough_section_loads *x, double t) {
    const bough_beam *beam = x->beam;
    double w[BOUGH_ROD_MOST_OUTPUTS];
    bough_simulation_accelerate(x->simulation, t);
    bough_simulation_root(x->simulation, beam, t, w);
    bough_vec3 root = bough_v3_load(w), arm = bough_cross(beam->def.position[0], root);
    x->root = (bough_wrench){root, bough_sub(bough_v3_load(w + 3), arm)};
    x->end = (bough_wrench){{0, 0, 0}, {0, 0, 0}};
    if (beam->end < 0) return;
    bough_vec3 moment = bough_mat3_mul(vertex_axes(x, beam->mesh->n_segment), bough_v3_load(w + 9));
    x->end = (bough_wrench){bough_v3(-w[6], -w[7], -w[8]), bough_scale(-1, moment)};
}

bool bough_section_loads_evaluate(bough_section_loads *x, double t) {
    const bough_simulation *s = x->simulation;
    const bough_rod_model *m = x->beam->mesh;
    bough_rod_gather(m, bough_beam_state(s, x->beam, 1), bough_simulation_rod_input(s, x->beam), &x->scratch);
    bough_rod_load(m, x->beam->loads, t, &x->scratch);
    bool finite = bough_rod_forces(m, 0, m->n_segment, &x->scratch);
    find_ends(x, t);
    for (int i = 0; i <= m->n_segment; i++) x->acceleration[i] = acceleration_of(x, i);
    find_lack(x);
    set_scene_loads(x, t);
    return finite;
}

// theory (122)
bough_mat3 bough_section_loads_axes(const bough_section_loads *x, const bough_rod_place *at,
                                    bough_vec3 *rotation) {
    int i = at->segment;
    double stress[9], angle[3] = {0, 0, 0};
    bough_vec3 linear[2];
    linear_moments(x, i, linear);
    const bough_vec3 row[3] = {segment_force(x, i), bough_between(linear[0], linear[1], 0.5),
                               bough_scale(1 / segment_length(x, i), bough_sub(linear[1], linear[0]))};
    for (int k = 0; k < 3; k++) bough_v3_store(bough_mat3_tmul(axes_at(x, i, 0.5), row[k]), stress + 3 * k);
    for (int k = 0; k < 27; k++) angle[k / 9] += at->bend[k] * stress[k % 9];
    bough_quaternion more = bough_quaternion_exponential(bough_v3_load(angle));
    bough_quaternion now = bough_quaternion_product(rotation_at(x, i, at->fraction), more);
    const bough_quaternion *rest = x->beam->def.rotation + i;
    bough_quaternion back =
        bough_quaternion_conjugate(bough_rotation_between(rest[0], rest[1], at->fraction));
    *rotation = bough_quaternion_logarithm(bough_quaternion_product(now, back));
    bough_quaternion twist = bough_quaternion_exponential(bough_v3(0, 0, at->twist));
    return bough_rotation_matrix(bough_quaternion_product(now, twist));
}
