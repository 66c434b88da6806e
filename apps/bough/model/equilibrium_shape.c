// The shape of one simulation as the start of another with other meshes.
#include "apps/bough/model/equilibrium.h"
#include "apps/bough/model/shape.h"

#include <string.h>

typedef struct place {
    bough_vec3 position;   // in the axes of the rod's body [m]
    bough_quaternion turn; // of the section, from its undeformed one
} place;

static bough_quaternion turn_of(const bough_rod_model *m, int i, bough_quaternion rotation) {
    return bough_quaternion_product(rotation, bough_quaternion_conjugate(m->rotation0[i]));
}

// Of vertex i of a rod, 0 at its root, which does not move.
static place place_of(const bough_simulation *s, const bough_beam *beam, int i) {
    const bough_rod_model *m = beam->mesh;
    if (i == 0) return (place){m->position0[0], {1, 0, 0, 0}};
    const double *y = s->rod[beam->port].state + i - 1;
    int n = m->n;
    if (i > n) { // belongs to what the rod carries
        y = s->leader.state + s->tree->links[s->tree->ends[beam->end].link].first_coordinate;
        n = 1;
    }
    bough_quaternion p = {y[3 * n], y[4 * n], y[5 * n], y[6 * n]};
    return (place){bough_v3(y[0], y[n], y[2 * n]), turn_of(m, i, bough_quaternion_normalised(p))};
}

// Of the rod at a distance from the root, linear between vertices.
static place place_at(const bough_simulation *s, const bough_beam *beam, double span) {
    const bough_rod_model *m = beam->mesh;
    int k = 0;
    while (k + 1 < m->n_segment && span > m->span[k + 1]) k++;
    double part = (span - m->span[k]) / (m->span[k + 1] - m->span[k]);
    place a = place_of(s, beam, k), b = place_of(s, beam, k + 1);
    bough_mat3 axes = bough_axes_between(a.turn, b.turn, part);
    return (place){bough_between(a.position, b.position, part), bough_quaternion_of_matrix(axes)};
}

static void shape_rod(const bough_simulation *from, const bough_beam *given, const bough_beam *beam,
                      double *state) {
    const bough_rod_model *m = beam->mesh;
    int n = m->n;
    memset(state, 0, (size_t)BOUGH_ROD_STATES * (size_t)n * sizeof *state);
    for (int i = 0; i < n; i++) {
        place x = place_at(from, given, m->span[i + 1]);
        bough_quaternion p = bough_quaternion_product(x.turn, m->rotation0[i + 1]);
        const double row[BOUGH_ROD_U] = {x.position.x, x.position.y, x.position.z, p.w, p.x, p.y, p.z};
        for (int c = 0; c < BOUGH_ROD_U; c++) state[c * n + i] = row[c];
    }
}

void bough_simulation_take_shape(const bough_simulation *from, bough_simulation *to) {
    size_t joints = (size_t)to->leader.system.n_state;
    memcpy(to->leader.state, from->leader.state, joints * sizeof(double));
    for (int k = 0; k < to->n_beam; k++) {
        const bough_beam *beam = &to->beam[k];
        if (beam->rod) shape_rod(from, &from->beam[k], beam, to->rod[beam->port].state);
    }
    bough_simulation_update(to);
}
