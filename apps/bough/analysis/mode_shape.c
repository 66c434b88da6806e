#include "apps/bough/analysis/mode_shape.h"

#include "core/tree/dynamics.h"

#include <float.h>
#include <string.h>

void bough_mode_shape_take(bough_arena *arena, bough_mode_shape *x) {
    const bough_simulation *s = x->simulation;
    x->moved = bough_arena_doubles(arena, (size_t)x->assembly->n_state + 1);
    x->beam = bough_arena_take(arena, ((size_t)s->n_beam + 1) * sizeof *x->beam);
    for (int k = 0; k < s->n_beam; k++) {
        if (s->beam[k].modal == NULL) continue;
        size_t n = (size_t)BOUGH_ROD_STATES * bough_beam_mesh(&s->beam[k])->n;
        x->beam[k].memory = bough_arena_doubles(arena, 3 * n);
    }
}

// -- beams ----------------------------------------------------------------------------------------

// The vertices of a modal body at its state and frame's twist moved by a part of the shape.
static void expand(const bough_mode_shape *x, const bough_beam *beam, int part, double step, double *to) {
    const bough_simulation *s = x->simulation;
    const bough_frame *frame = &s->tree->markers[beam->marker];
    int at = x->assembly->state_offset[beam->port + 1], n = s->rod[beam->port].system.n_state;
    bough_twist twist = bough_tree_frame_twist(s->view, frame);
    double input[BOUGH_ROD_INPUTS] = {0}, change[6] = {0}; // gravity does not matter
    bough_twist_store(twist, input);
    if (frame->link >= 0) {
        bough_twist_store(bough_twist_to_child(&frame->placement, s->view->acceleration[frame->link]),
                          change);
    }
    for (int c = 0; c < 6; c++) input[c] += step * change[c];
    for (int k = 0; k < n; k++)
        x->moved[k] = x->state[at + k] + step * bough_mode_shape_part(x, part)[at + k];
    memcpy(to, bough_modal_body_vertices(beam->modal, x->moved, input, 1),
           (size_t)BOUGH_ROD_STATES * bough_beam_mesh(beam)->n * sizeof *to);
}

// By central differences, of steps that move nothing by more than a millionth.
static void set_modal(const bough_mode_shape *x, const bough_beam *beam, bough_beam_shape *b) {
    size_t n = (size_t)BOUGH_ROD_STATES * bough_beam_mesh(beam)->n;
    for (int part = 0; part < 2; part++) {
        double most = DBL_MIN, *to = b->memory + (size_t)(1 + part) * n;
        for (int k = 0; k < x->assembly->n_state; k++)
            most = fmax(most, fabs(bough_mode_shape_part(x, part)[k]));
        double step = 1e-6 / most;
        bough_tree_tangent(x->simulation->tree, x->state, bough_mode_shape_part(x, part),
                           x->simulation->view);
        expand(x, beam, part, -step, b->memory);
        expand(x, beam, part, step, to);
        for (size_t k = 0; k < n; k++) to[k] = (to[k] - b->memory[k]) / (2 * step);
        b->tangent[part] = to;
    }
    expand(x, beam, 0, 0, b->memory);
    b->state = b->memory;
}

void bough_mode_shape_set(const bough_mode_shape *x) {
    for (int k = 0; k < x->simulation->n_beam; k++) {
        const bough_beam *beam = &x->simulation->beam[k];
        bough_beam_shape *b = &x->beam[k];
        if (beam->port < 0) continue;
        int at = x->assembly->state_offset[beam->port + 1];
        if (beam->modal != NULL) {
            set_modal(x, beam, b);
            continue;
        }
        b->state = x->state + at;
        for (int part = 0; part < 2; part++) b->tangent[part] = bough_mode_shape_part(x, part) + at;
    }
}

const bough_beam_shape *bough_mode_shape_beam(const bough_mode_shape *x, const bough_beam *beam) {
    return &x->beam[beam - x->simulation->beam];
}

// -- rows -----------------------------------------------------------------------------------------

static int rows_of(const bough_simulation *s, int body) {
    const bough_beam *beam = bough_simulation_beam(s, body);
    return beam != NULL && beam->port >= 0 ? beam->def.n_segment + 1 : 1;
}

int bough_mode_shape_rows(const bough_simulation *s) {
    int n = 0;
    for (int i = 0; i < s->scene->n_body; i++) n += rows_of(s, i);
    return n;
}

// Sets the view so that twists of frames are their displacements along a part of the shape: the
// joints' speeds are the changes of their coordinates.
static void set_displacements(const bough_mode_shape *x, int part) {
    const bough_tree *tree = x->simulation->tree;
    memcpy(x->moved, x->state, (size_t)tree->n_q * sizeof *x->moved);
    for (int i = 0; i < tree->n_links; i++) {
        const bough_link *link = &tree->links[i];
        int q = link->first_coordinate;
        bough_joint_speed(&link->joint, x->state + q, bough_mode_shape_part(x, part) + q,
                          x->moved + tree->n_q + link->first_speed);
    }
    bough_tree_kinematics(tree, x->moved, x->simulation->view);
}

// A vertex with states, against its frame's displacement, in the frame's axes.
static bough_twist add_vertex(const bough_mode_shape *x, const bough_beam *beam, int part, int i,
                              bough_twist frame) {
    const bough_beam_shape *b = bough_mode_shape_beam(x, beam);
    const double *y = b->state + i - 1, *d = b->tangent[part] + i - 1;
    int n = bough_beam_mesh(beam)->n;
    bough_vec3 arm = {y[0], y[n], y[2 * n]}, shift = {d[0], d[n], d[2 * n]};
    bough_quaternion p = {y[3 * n], y[4 * n], y[5 * n], y[6 * n]};
    bough_quaternion dp = {d[3 * n], d[4 * n], d[5 * n], d[6 * n]};
    bough_quaternion turn = bough_quaternion_product(dp, bough_quaternion_conjugate(p));
    bough_vec3 swept = bough_add(frame.linear, bough_cross(frame.angular, arm));
    return (bough_twist){bough_add(swept, shift),
                         bough_axpy(2, bough_v3(turn.x, turn.y, turn.z), frame.angular)};
}

static void store(const bough_simulation *s, const bough_frame *frame, bough_twist motion, double to[6]) {
    bough_mat3 r = bough_tree_frame_pose(s->view, frame).rotation;
    bough_twist_store((bough_twist){bough_mat3_mul(r, motion.linear), bough_mat3_mul(r, motion.angular)}, to);
}

static void move_body(const bough_mode_shape *x, int body, int part, bough_shape_row *row) {
    const bough_simulation *s = x->simulation;
    const bough_beam *beam = bough_simulation_beam(s, body);
    const bough_frame *frame = &s->tree->bodies[body];
    bough_twist own = bough_tree_frame_twist(s->view, frame);
    for (int i = 0; i < rows_of(s, body); i++, row++) {
        row->body = body;
        row->span = i == 0 ? 0 : beam->def.span[i];
        if (i == 0) {
            store(s, frame, own, row->motion[part]);
        } else if (i <= bough_beam_mesh(beam)->n) {
            store(s, frame, add_vertex(x, beam, part, i, own), row->motion[part]);
        } else {
            const bough_frame *end = &s->tree->bodies[s->scene->n_body + beam->end];
            store(s, end, bough_tree_frame_twist(s->view, end), row->motion[part]);
        }
    }
}

// The component whose modulus is the largest, of displacements or else of rotations.
static void scale_rows(bough_shape_row *row, int n) {
    const double *at[2] = {row->motion[0], row->motion[1]};
    double most = 0;
    for (int from = 0; from < 6 && most == 0; from += 3) {
        for (int k = 0; k < 3 * n; k++) {
            bough_shape_row *r = &row[k / 3];
            int c = from + k % 3;
            double square = pow(r->motion[0][c], 2) + pow(r->motion[1][c], 2);
            if (square > most) at[0] = &r->motion[0][c], at[1] = &r->motion[1][c];
            most = fmax(most, square);
        }
    }
    double real = most > 0 ? *at[0] / most : 1, imaginary = most > 0 ? -*at[1] / most : 0;
    for (int k = 0; k < 6 * n; k++) {
        double *a = &row[k / 6].motion[0][k % 6], *b = &row[k / 6].motion[1][k % 6], old = *a;
        *a = real * old - imaginary * *b;
        *b = real * *b + imaginary * old;
    }
}

void bough_mode_shape_move(const bough_mode_shape *x, bough_shape_row *row) {
    const bough_simulation *s = x->simulation;
    for (int part = 0; part < 2; part++) {
        bough_shape_row *next = row;
        set_displacements(x, part);
        for (int i = 0; i < s->scene->n_body; i++) {
            move_body(x, i, part, next);
            next += rows_of(s, i);
        }
    }
    scale_rows(row, bough_mode_shape_rows(s));
    bough_tree_kinematics(s->tree, x->state, s->view);
}
