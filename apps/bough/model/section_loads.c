#include "apps/bough/model/section_loads.h"

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

void bough_section_loads_linear(const bough_section_loads *x, int i, bough_vec3 moment[2]) {
    const bough_section_load *lack = &x->lack[i];
    bough_vec3 left = bough_mat3_mul(vertex_axes(x, i), segment_row(x, i, 3));
    bough_vec3 right = bough_mat3_mul(vertex_axes(x, i + 1), segment_row(x, i, 6));
    moment[0] = bough_add(left, lack->moment);
    moment[1] = bough_sub(bough_sub(lack->moment, bough_cross(step_between(x, i), lack->force)), right);
}

// The axes of the section at a fraction of a segment's length.
static bough_mat3 axes_at(const bough_section_loads *x, int i, double fraction) {
    return bough_axes_between(bough_section_loads_rotation(x, i), bough_section_loads_rotation(x, i + 1),
                              fraction);
}

static double segment_length(const bough_section_loads *x, int i) {
    return x->beam->def.span[i + 1] - x->beam->def.span[i];
}

// From the left to the right vertex, per length.
static bough_vec3 chord(const bough_section_loads *x, int i) {
    return bough_scale(1 / segment_length(x, i), step_between(x, i));
}

// The force of a segment is constant over its length.
static bough_section_load middle_load(const bough_section_loads *x, int i) {
    bough_vec3 moment[2];
    bough_section_loads_linear(x, i, moment);
    return (bough_section_load){segment_force(x, i), bough_between(moment[0], moment[1], 0.5)};
}

// -- inertia --------------------------------------------------------------------------------------

// Change of the acceleration along segment i, per length.
static bough_vec3 acceleration_slope(const bough_section_loads *x, int i) {
    bough_vec3 change = bough_sub(x->acceleration[i + 1], x->acceleration[i]);
    return bough_scale(1 / (x->centre[i + 1] - x->centre[i]), change);
}

bough_rod_place bough_section_loads_place(const bough_section_loads *x, int segment, double fraction) {
    bough_rod_place p = {.segment = segment, .fraction = fraction};
    const bough_rod_sections *sections = &x->beam->mesh->sections;
    double to = x->beam->def.span[segment] + fraction * segment_length(x, segment);
    if (fraction == 1) p.inner = x->mass[segment];
    if (fraction > 0 && fraction < 1) p.inner = sections->mass(sections->axis, &x->beam->def, segment, to);
    return p;
}

// theory (121): what inertia and weight within a segment add, at a place, to the constant force and the
// linear moment that balance the masses at its vertices.
static bough_section_load inertia_load(const bough_section_loads *x, const bough_rod_place *p) {
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
    return (bough_section_load){bough_axpy(moment, slope, bough_scale(mass, a)),
                                bough_add(bough_cross(chord(x, i), arm), bough_cross(offset, a))};
}

// … at the left or the right end of a segment.
static bough_section_load inertia_at_end(const bough_section_loads *x, int i, bool right) {
    bough_rod_place end = {.segment = i, .fraction = right};
    if (right) end.inner = x->mass[i];
    return inertia_load(x, &end);
}

static bough_section_load sum_of(bough_section_load a, bough_section_load b) {
    return (bough_section_load){bough_add(a.force, b.force), bough_add(a.moment, b.moment)};
}

// -- force and torsional moment -------------------------------------------------------------------

// From the middle of a segment to the next place at which the loads are known, the middle of a neighbour or
// an end of the rod. The change of the force is that by loads along the rod.
typedef struct neighbour {
    bool known, inner;        // no concentrated force lies between both; it is a segment
    double distance;          // [m], negative towards the root
    bough_section_load slope; // change per length
} neighbour;

static neighbour neighbour_of(const bough_section_loads *x, int i, int sign) {
    int next = i + sign, n = x->beam->def.n_segment;
    bool inner = next >= 0 && next < n;
    bough_section_load from = sum_of(middle_load(x, i), inertia_at_end(x, i, sign > 0));
    bough_section_load to = {{0, 0, 0}, {0, 0, 0}};
    double length = segment_length(x, i) / 2;
    if (inner) {
        to = sum_of(middle_load(x, next), inertia_at_end(x, next, sign < 0));
        length += segment_length(x, next) / 2;
    } else if (next < 0) {
        to = x->root;
    } else {
        to = x->end;
    }
    bough_vec3 force = bough_sub(to.force, from.force), moment = bough_sub(to.moment, from.moment);
    bough_section_load slope = {bough_scale(sign / length, force), bough_scale(sign / length, moment)};
    return (neighbour){!x->kink[i + (sign > 0)], inner, sign * length, slope};
}

// C D q of theory (30): the mean deviation of a segment's moment from a linear one, by the loads along it.
static bough_vec3 bow_of_loads(const bough_section_loads *x, int i) {
    const bough_rod_model *m = x->beam->mesh;
    double stiffness[6][6], moment[3] = {0, 0, 0};
    bough_symmetric6_unpack(x->beam->def.stiffness + 21 * i, stiffness);
    for (int k = 0; k < 6; k++) {
        double strain = x->scratch.rest[k * m->stride + i] - m->strain0[k * m->stride + i];
        for (int c = 0; c < 3; c++) moment[c] += stiffness[3 + c][k] * strain;
    }
    return bough_mat3_mul(axes_at(x, i, 0.5), bough_v3_load(moment));
}

// theory (119): the force by loads along the rod in the middle of a segment, less its mean.
static bough_vec3 middle_excess(const bough_section_loads *x, int i, const neighbour *a, const neighbour *b) {
    double h = segment_length(x, i), distance = b->distance - a->distance; // between the places
    double ends = (b->inner ? 0 : 1 / b->distance) - (a->inner ? 0 : 1 / a->distance);
    bough_vec3 second = bough_scale(2 / distance, bough_sub(b->slope.force, a->slope.force));
    return bough_scale(-h * h / (24 - 2 * h * h * ends / distance), second);
}

// The parabola through the middles of three segments, or of two and an end. A concentrated force makes a
// step at its vertex: towards it the slope of the segment's other half continues.
static bough_section_load load_between(const bough_section_loads *x, const bough_rod_place *p) {
    int i = p->segment;
    double offset = (p->fraction - 0.5) * segment_length(x, i);
    bough_section_load middle = sum_of(middle_load(x, i), inertia_load(x, p));
    neighbour a = neighbour_of(x, i, -1), b = neighbour_of(x, i, 1);
    bool left = offset < 0 ? a.known : !b.known;
    double weight = left ? 0 : 1; // of b's slope
    if (a.known && b.known && (a.inner || b.inner)) {
        weight = (offset - a.distance) / (b.distance - a.distance);
        bough_vec3 excess = middle_excess(x, i, &a, &b);
        middle.force = bough_add(middle.force, excess);
        // a neighbour has the same excess, an end has none
        if (!a.inner) a.slope.force = bough_axpy(-1 / a.distance, excess, a.slope.force);
        if (!b.inner) b.slope.force = bough_axpy(-1 / b.distance, excess, b.slope.force);
    } else if (!a.known && !b.known) {
        return middle;
    }
    bough_vec3 force = bough_between(a.slope.force, b.slope.force, weight);
    bough_vec3 moment = bough_between(a.slope.moment, b.slope.moment, weight);
    return (bough_section_load){bough_axpy(offset, force, middle.force),
                                bough_axpy(offset, moment, middle.moment)};
}

// -- bending moment -------------------------------------------------------------------------------

// Second derivative of the moment by loads along the rod, the mean over the neighbours that no concentrated
// force separates; `curved`: the part that the forces have as the chords turn.
static bough_vec3 moment_curvature(const bough_section_loads *x, int i, bough_vec3 *curved) {
    bough_vec3 loaded = {0, 0, 0}, force = segment_force(x, i);
    int count = 0;
    *curved = loaded;
    for (int side = -1; side <= 1; side += 2) {
        int next = i + side;
        if (next < 0 || next >= x->beam->def.n_segment || x->kink[i + (side > 0)]) continue;
        double distance = side * (segment_length(x, i) + segment_length(x, next)) / 2;
        bough_vec3 turn = bough_sub(chord(x, next), chord(x, i)), other = segment_force(x, next);
        bough_vec3 along = bough_between(chord(x, i), chord(x, next), 0.5);
        bough_vec3 inner = bough_add(force, inertia_at_end(x, i, side > 0).force);
        bough_vec3 outer = bough_add(other, inertia_at_end(x, next, side < 0).force);
        bough_vec3 change = bough_cross(bough_sub(outer, inner), along);
        loaded = bough_axpy(1 / distance, change, loaded);
        *curved = bough_axpy(1 / distance, bough_cross(bough_between(force, other, 0.5), turn), *curved);
        count++;
    }
    *curved = bough_scale(count > 1 ? 0.5 : 1, *curved);
    return bough_add(*curved, bough_scale(count > 1 ? 0.5 : 1, loaded));
}

// theory (118): a parabola of known mean over the segment. In the outer half of the first and the last
// segment it ends at the moment of the root and of the end.
static bough_vec3 bending_at(const bough_section_loads *x, const bough_rod_place *p) {
    const bough_beam *beam = x->beam;
    int n = beam->def.n_segment, i = p->segment;
    double f = p->fraction;
    double square = segment_length(x, i) * segment_length(x, i);
    bough_vec3 curved, bend = bough_scale(square / 2, moment_curvature(x, i, &curved)), linear[2];
    bough_vec3 mean = bough_axpy(-square / 12, curved, bow_of_loads(x, i));
    bough_vec3 middle = bough_axpy(-1. / 12, bend, bough_add(mean, middle_load(x, i).moment));
    bough_vec3 inertia = inertia_load(x, p).moment;
    if (i == 0 && f < 0.5) {
        bough_vec3 root = bough_sub(x->root.moment, inertia_at_end(x, i, false).moment);
        bough_vec3 straight = bough_add(inertia, bough_between(root, middle, 2 * f));
        return bough_axpy(f * (f - 0.5), bend, straight);
    }
    if (i == n - 1 && f > 0.5 && !x->kink[n]) {
        bough_vec3 end = bough_sub(x->end.moment, inertia_at_end(x, i, true).moment);
        bough_vec3 straight = bough_add(inertia, bough_between(middle, end, 2 * f - 1));
        return bough_axpy((f - 0.5) * (f - 1), bend, straight);
    }
    bough_section_loads_linear(x, i, linear);
    bough_vec3 straight = bough_add(inertia, bough_between(linear[0], linear[1], f));
    return bough_axpy((f - 0.5) * (f - 0.5) - 1. / 12, bend, bough_add(mean, straight));
}

// -- whole ----------------------------------------------------------------------------------------

// Of a load within a segment both vertices of the segment are marked.
static bool *find_kinks(bough_arena *arena, const bough_scene *scene, const bough_beam *beam) {
    int n = beam->def.n_segment;
    const double *span = beam->def.span;
    bool *kink = bough_arena_take(arena, ((size_t)n + 1) * sizeof *kink);
    for (int k = 0; k < scene->n_load; k++) {
        const bough_scene_load *load = &scene->load[k];
        if (load->body_name == NULL || &scene->body[load->body] != beam->body) continue;
        if (load->place == BOUGH_SCENE_AT_VERTEX) kink[load->vertex] = true;
        if (load->place == BOUGH_SCENE_AT_TIP) kink[n] = true;
        for (int i = 0; load->place == BOUGH_SCENE_AT_SPAN && i < n; i++) {
            kink[i] |= load->span[0] >= span[i] && load->span[0] < span[i + 1];
            kink[i + 1] |= load->span[0] > span[i] && load->span[0] <= span[i + 1];
        }
    }
    kink[n] &= beam->end < 0; // the wrench of bodies on the end is known
    return kink;
}

bough_section_loads bough_section_loads_create(bough_arena *arena, const bough_simulation *s,
                                               const bough_beam *beam) {
    const bough_rod_model *m = beam->mesh;
    bough_section_loads x = {.simulation = s, .beam = beam, .kink = find_kinks(arena, s->scene, beam)};
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
    bough_section_load sum = {{0, 0, 0}, {0, 0, 0}};
    for (int i = m->n_segment; i > 0; i--) {
        const bough_vertex_inertia *vertex = &m->vertex[i];
        bough_vec3 slope = acceleration_slope(x, i - 1);
        bough_vec3 a = bough_axpy(m->span[i] - x->centre[i], slope, x->acceleration[i]);
        sum.force = bough_axpy(vertex->added_mass, a, sum.force);
        bough_vec3 turn = bough_cross(vertex_axes(x, i).c3, slope);
        sum.moment = bough_axpy(vertex->added_inertia, turn, sum.moment);
        sum.moment = bough_add(sum.moment, bough_cross(step_between(x, i - 1), sum.force));
        x->lack[i - 1] = sum;
    }
}

// Forces and moments at the ends.
static void find_ends(bough_section_loads *x, double t) {
    const bough_beam *beam = x->beam;
    double w[BOUGH_ROD_MOST_OUTPUTS];
    bough_simulation_accelerate(x->simulation, t);
    bough_simulation_root(x->simulation, beam, t, w);
    bough_vec3 root = bough_v3_load(w), arm = bough_cross(beam->def.position[0], root);
    x->root = (bough_section_load){root, bough_sub(bough_v3_load(w + 3), arm)};
    if (beam->end < 0) return;
    bough_vec3 moment = bough_mat3_mul(vertex_axes(x, beam->mesh->n_segment), bough_v3_load(w + 9));
    x->end = (bough_section_load){bough_v3(-w[6], -w[7], -w[8]), bough_scale(-1, moment)};
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
    return finite;
}

bough_section_load bough_section_loads_at(const bough_section_loads *x, const bough_rod_place *place,
                                          bough_mat3 *axes) {
    *axes = axes_at(x, place->segment, place->fraction);
    bough_section_load load = load_between(x, place);
    bough_vec3 moment = bough_mat3_tmul(*axes, bending_at(x, place));
    moment.z = bough_mat3_tmul(*axes, load.moment).z; // a segment's moment has no slope in torsion
    return (bough_section_load){bough_mat3_tmul(*axes, load.force), moment};
}
