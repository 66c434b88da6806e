#include "apps/bough/model/shape.h"

enum { RIGID_POINTS = 3 };

void bough_shape_create(bough_arena *arena, bough_simulation *s, bough_shape *shape) {
    size_t n = (size_t)s->scene->n_body, most = bough_simulation_most_vertices(s) + RIGID_POINTS;
    *shape = (bough_shape){.simulation = s, .n_line = s->scene->n_body};
    shape->line = bough_arena_take(arena, n * sizeof *shape->line);
    shape->loads = bough_arena_take(arena, n * sizeof *shape->loads);
    for (int i = 0; i < s->scene->n_body; i++) {
        const bough_beam *beam = bough_simulation_beam(s, i);
        shape->line[i].name = s->scene->body[i].name;
        shape->line[i].n_point = beam ? beam->def.n_segment + 1 : RIGID_POINTS;
        if (beam && beam->rod) shape->loads[i] = bough_section_loads_create(arena, s, beam);
    }
    shape->vertex = bough_arena_take(arena, most * sizeof *shape->vertex);
}

static void rigid_line(const bough_simulation *s, int body, bough_vertex_motion *x) {
    const bough_scene_body *from = &s->scene->body[body];
    const double *c = from->centre_of_mass;
    int parent = from->joint.parent;
    bough_transform own = bough_body_pose(s, body);
    x[0].position = x[1].position = own.position;
    if (parent >= 0) x[0].position = bough_body_pose(s, parent).position;
    x[2].position = bough_add(own.position, bough_mat3_mul(own.rotation, bough_v3_load(c)));
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
    bough_section_loads *loads = &shape->loads[body];
    bough_mat3 frame = bough_beam_pose(s, beam).rotation;
    if (!bough_section_loads_evaluate(loads, t)) return;
    for (int k = 0; k < shape->line[body].n_point; k++) {
        bool last = k == beam->def.n_segment;
        bough_rod_place vertex = bough_section_loads_end(loads, last ? k - 1 : k, last);
        bough_wrench load = bough_section_loads_at(loads, &vertex);
        bough_v3_store(bough_mat3_mul(frame, load.force), force + 3 * k);
        bough_v3_store(bough_mat3_mul(frame, load.moment), moment + 3 * k);
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
