#include "apps/bough/model/section_load.h"

bool bough_section_evaluate(const bough_simulation *s, const bough_beam *beam, double t,
                            bough_rod_scratch *scratch) {
    const bough_rod_model *m = bough_beam_mesh(beam);
    bough_rod_gather(m, bough_beam_state(s, beam, 1), bough_simulation_rod_input(s, beam), scratch);
    bough_rod_load(m, bough_beam_loads(beam), t, scratch);
    return bough_rod_forces(m, 0, m->n_segment, scratch);
}

static bough_vec3 segment_row(const bough_rod_model *m, const bough_rod_scratch *scratch,
                              int segment, int row) {
    const double *f = scratch->segment + segment;
    int n = m->stride;
    return bough_v3(f[row * n], f[(row + 1) * n], f[(row + 2) * n]);
}

static bough_mat3 vertex_axes(const bough_rod_model *m, const bough_rod_scratch *scratch, int i) {
    const double *p = scratch->vertex + i;
    int n = m->stride;
    return bough_rotation_matrix((bough_quaternion){p[3 * n], p[4 * n], p[5 * n], p[6 * n]});
}

static bough_vec3 blend(bough_vec3 a, bough_vec3 b, double share) {
    return bough_add(a, bough_scale(share, bough_sub(b, a)));
}

// The moment goes linearly from what the segment does to the left vertex to the opposite of what it
// does to the right one.
bough_section_load bough_section_in_segment(const bough_beam *beam, const bough_rod_scratch *scratch,
                                            int segment, double share) {
    const bough_rod_model *m = bough_beam_mesh(beam);
    bough_vec3 first = bough_mat3_mul(vertex_axes(m, scratch, segment),
                                      segment_row(m, scratch, segment, 3));
    bough_vec3 last = bough_mat3_mul(vertex_axes(m, scratch, segment + 1),
                                     segment_row(m, scratch, segment, 6));
    return (bough_section_load){.force = segment_row(m, scratch, segment, 0),
                                .moment = blend(first, bough_scale(-1, last), share)};
}

bough_section_load bough_section_at_vertex(const bough_beam *beam, const bough_rod_scratch *scratch,
                                           int vertex) {
    int n = bough_beam_mesh(beam)->n_segment;
    int inner = vertex > 0 ? vertex - 1 : 0, outer = vertex < n ? vertex : n - 1;
    bough_section_load a = bough_section_in_segment(beam, scratch, inner, vertex - inner);
    bough_section_load b = bough_section_in_segment(beam, scratch, outer, vertex - outer);
    return (bough_section_load){blend(a.force, b.force, 0.5), blend(a.moment, b.moment, 0.5)};
}
