#include "apps/bough/model/shape.h"

#include <string.h>

// -- section loads --------------------------------------------------------------------------------

bool bough_section_evaluate(const bough_simulation *s, const bough_beam *beam, double t,
                            bough_rod_scratch *scratch) {
    const bough_rod_model *m = beam->mesh;
    bough_rod_gather(m, bough_beam_state(s, beam, 1), bough_simulation_rod_input(s, beam), scratch);
    bough_rod_load(m, beam->loads, t, scratch);
    return bough_rod_forces(m, 0, m->n_segment, scratch);
}

static bough_vec3 segment_row(const bough_rod_model *m, const bough_rod_scratch *scratch, int segment,
                              int row) {
    const double *f = scratch->segment + segment;
    int n = m->stride;
    return bough_v3(f[row * n], f[(row + 1) * n], f[(row + 2) * n]);
}

bough_quaternion bough_section_vertex_rotation(const bough_rod_model *m, const bough_rod_scratch *scratch,
                                               int i) {
    const double *p = scratch->vertex + i;
    int n = m->stride;
    return (bough_quaternion){p[3 * n], p[4 * n], p[5 * n], p[6 * n]};
}

static bough_mat3 vertex_axes(const bough_rod_model *m, const bough_rod_scratch *scratch, int i) {
    return bough_rotation_matrix(bough_section_vertex_rotation(m, scratch, i));
}

// The moment is linear between that on the left vertex and the opposite of that on the right vertex.
bough_section_load bough_section_in_segment(const bough_beam *beam, const bough_rod_scratch *scratch,
                                            int segment, double fraction) {
    const bough_rod_model *m = beam->mesh;
    bough_vec3 first = bough_mat3_mul(vertex_axes(m, scratch, segment), segment_row(m, scratch, segment, 3));
    bough_vec3 last =
        bough_mat3_mul(vertex_axes(m, scratch, segment + 1), segment_row(m, scratch, segment, 6));
    return (bough_section_load){.force = segment_row(m, scratch, segment, 0),
                                .moment = bough_between(first, bough_scale(-1, last), fraction)};
}

// Load at a vertex, from 0 to n_segment: the mean of both segments, whose loads differ by the load on the
// vertex; at the ends that of the only segment.
static bough_section_load section_at_vertex(const bough_beam *beam, const bough_rod_scratch *scratch,
                                            int vertex) {
    int n = beam->mesh->n_segment;
    int inner = vertex > 0 ? vertex - 1 : 0, outer = vertex < n ? vertex : n - 1;
    bough_section_load a = bough_section_in_segment(beam, scratch, inner, vertex - inner);
    bough_section_load b = bough_section_in_segment(beam, scratch, outer, vertex - outer);
    return (bough_section_load){bough_between(a.force, b.force, 0.5), bough_between(a.moment, b.moment, 0.5)};
}

enum { RIGID_POINTS = 3 };

void bough_shape_create(bough_arena *arena, bough_simulation *s, bough_shape *shape) {
    size_t n = (size_t)s->scene->n_body, most = bough_simulation_most_vertices(s) + RIGID_POINTS;
    *shape = (bough_shape){.simulation = s, .n_line = s->scene->n_body};
    shape->line = bough_arena_take(arena, n * sizeof *shape->line);
    shape->scratch = bough_arena_take(arena, n * sizeof *shape->scratch);
    for (int i = 0; i < s->scene->n_body; i++) {
        const bough_beam *beam = bough_simulation_beam(s, i);
        shape->line[i].name = s->scene->body[i].name;
        shape->line[i].n_point = beam ? beam->def.n_segment + 1 : RIGID_POINTS;
        if (beam && beam->rod) bough_rod_scratch_init(&shape->scratch[i], arena, beam->mesh);
    }
    shape->vertex = bough_arena_take(arena, most * sizeof *shape->vertex);
}

static void rigid_line(const bough_simulation *s, int body, bough_vertex_motion *x) {
    const bough_scene_body *from = &s->scene->body[body];
    const double *c = from->centre_of_mass;
    int parent = from->joint.parent;
    bough_transform own = bough_tree_frame_pose(s->view, &s->tree->bodies[body]);
    x[0].position = x[1].position = own.position;
    if (parent >= 0) x[0].position = bough_tree_frame_pose(s->view, &s->tree->bodies[parent]).position;
    x[2].position = bough_add(own.position, bough_mat3_mul(own.rotation, bough_v3(c[0], c[1], c[2])));
}

void bough_shape_points(void *self, double *point) {
    bough_shape *shape = self;
    const bough_simulation *s = shape->simulation;
    bough_vertex_motion *x = shape->vertex;
    for (int i = 0; i < shape->n_line; i++) {
        const bough_beam *beam = bough_simulation_beam(s, i);
        if (beam) {
            bough_simulation_beam_motion(s, beam, x);
        } else {
            rigid_line(s, i, x);
        }
        for (int k = 0; k < shape->line[i].n_point; k++, point += 3) bough_v3_store(x[k].position, point);
    }
}

static void rod_loads(const bough_shape *shape, int body, double t, double *force, double *moment) {
    const bough_simulation *s = shape->simulation;
    const bough_beam *beam = bough_simulation_beam(s, body);
    if (!beam || !beam->rod) return;
    bough_rod_scratch *scratch = &shape->scratch[body];
    bough_mat3 axes = bough_tree_frame_pose(s->view, &s->tree->markers[beam->marker]).rotation;
    if (!bough_section_evaluate(s, beam, t, scratch)) return;
    for (int k = 0; k < shape->line[body].n_point; k++) {
        bough_section_load load = section_at_vertex(beam, scratch, k);
        bough_v3_store(bough_mat3_mul(axes, load.force), force + 3 * k);
        bough_v3_store(bough_mat3_mul(axes, load.moment), moment + 3 * k);
    }
}

void bough_shape_loads(void *self, double t, double *force, double *moment) {
    const bough_shape *shape = self;
    for (int i = 0; i < shape->n_line; i++) {
        int n = 3 * shape->line[i].n_point;
        memset(force, 0, (size_t)n * sizeof *force);
        memset(moment, 0, (size_t)n * sizeof *moment);
        rod_loads(shape, i, t, force, moment);
        force += n;
        moment += n;
    }
}
