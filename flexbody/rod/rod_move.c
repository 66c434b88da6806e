#include "flexbody/rod/rod_move.h"

#include "flexbody/rod/rod_segment.h"

#include <math.h>
#include <string.h>

// Numbers of vertex i + 1 in rows of n: its state's, or the end's.
typedef struct vertex_row {
    const double *at;
    int stride;
} vertex_row;

static vertex_row row_of(const bough_rod_model *m, const double *state, const double *end, int i) {
    bool own = i < m->n;
    return (vertex_row){own ? state + i : end, own ? m->n : 1};
}

static bough_quaternion quaternion_in(vertex_row r) {
    const double *p = r.at + (size_t)BOUGH_ROD_P * (size_t)r.stride;
    return (bough_quaternion){p[0], p[r.stride], p[2 * r.stride], p[3 * r.stride]};
}

static bough_vec3 position_in(vertex_row r) { return bough_v3(r.at[0], r.at[r.stride], r.at[2 * r.stride]); }

void bough_rod_change(const bough_rod_model *m, const double *state, const double *end, const double *rate,
                      const double *end_rate, double *change) {
    for (int i = 0; i < m->n_segment; i++, change += BOUGH_ROD_CHANGE) {
        vertex_row at = row_of(m, state, end, i), by = row_of(m, rate, end_rate, i);
        bough_vec3 shift = position_in(by);
        bough_quaternion turn =
            bough_quaternion_product(bough_quaternion_conjugate(quaternion_in(at)), quaternion_in(by));
        const double values[BOUGH_ROD_CHANGE] = {shift.x,    shift.y,    shift.z, 2 * turn.x,
                                                 2 * turn.y, 2 * turn.z, 0,       0};
        memcpy(change, values, sizeof values);
    }
}

static vertex_variation variation_of(const double *change, double share) {
    return (vertex_variation){.x = bough_scale(share, bough_v3(change[0], change[1], change[2])),
                              .phi = bough_scale(share, bough_v3(change[3], change[4], change[5]))};
}

double bough_rod_turn(const bough_rod_model *m, const double *change) {
    double turn = 0;
    for (int i = 0; i < m->n_segment; i++, change += BOUGH_ROD_CHANGE) {
        turn = fmax(turn, bough_norm(variation_of(change, 1).phi));
    }
    return turn;
}

// The chord that gives a segment of the shape `after` the strain of the one before and its change
// along the step to first order.
static bough_vec3 stretched(const segment_geometry *before, const segment_geometry *after, double h,
                            vertex_variation dl, vertex_variation dr) {
    segment_variation change = shape_variation(*before, dl, dr, 1 / h);
    bough_vec3 y = bough_add(before->stretch, change.stretch), v = after->v;
    bough_vec3 bow = bough_cross(v, bough_cross(v, y)); // the inverse of along_axis
    return bough_scale(h, bough_axpy(1 / (6 + bough_dot(v, v)), bow, y));
}

static void put_vertex(double *to, int stride, const vertex_state *v) {
    const double values[7] = {v->x.x, v->x.y, v->x.z, v->p.w, v->p.x, v->p.y, v->p.z};
    for (int c = 0; c < 7; c++) to[c * stride] = values[c];
}

void bough_rod_move(const bough_rod_model *m, const double *change, double share, double *state,
                    double *end) {
    vertex_state old = {.x = m->position0[0], .p = m->rotation0[0]}, now = old;
    vertex_variation dl = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (int i = 0; i < m->n_segment; i++, change += BOUGH_ROD_CHANGE) {
        vertex_row row = row_of(m, state, end, i);
        vertex_state r = {.x = position_in(row), .p = quaternion_in(row)}, moved = r;
        vertex_variation dr = variation_of(change, share);
        moved.p =
            bough_quaternion_normalised(bough_quaternion_product(r.p, bough_quaternion_exponential(dr.phi)));
        segment_geometry before = segment_shape(old, r, m->inverse_length[i]);
        segment_geometry after = segment_shape(now, moved, m->inverse_length[i]);
        bough_vec3 chord = stretched(&before, &after, m->length[i], dl, dr);
        moved.x = bough_add(now.x, bough_mat3_mul(after.r, chord));
        put_vertex(i < m->n ? state + i : end, row.stride, &moved);
        old = r;
        now = moved;
        dl = dr;
    }
}
