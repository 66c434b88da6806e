// A rod that is a stretch of its table: a new table that begins and ends between the old one's
// stations, so that rods in a row are the whole and bodies may hang where two of them meet.
#include "apps/bough/scene/scene_internal.h"

#include <math.h>
#include <string.h>

static double between(double f, double a, double b) { return (1 - f) * a + f * b; }

static void blend(double f, const double *a, const double *b, int n, double *to) {
    for (int k = 0; k < n; k++) to[k] = between(f, a[k], b[k]);
}

// The section at a span, linear between the stations.
static bough_section_station section_at(const bough_scene_structure *s, double span) {
    int k = 0;
    while (k < s->n_station - 2 && span > s->station[k + 1].def.position.z) k++;
    const bough_section_station *a = &s->station[k].def, *b = &s->station[k + 1].def;
    bough_section_station c;
    double f = (span - a->position.z) / (b->position.z - a->position.z);
    c.position = bough_add(bough_scale(1 - f, a->position), bough_scale(f, b->position));
    blend(f, a->stiffness, b->stiffness, 21, c.stiffness);
    blend(f, a->centre, b->centre, 2, c.centre);
    blend(f, a->inertia, b->inertia, 4, c.inertia);
    c.twist = between(f, a->twist, b->twist);
    c.mass = between(f, a->mass, b->mass);
    return c;
}

// Stations from one span to another, positions from the first.
static void cut(bough_scene_structure *s, const double part[2], bough_scene_station *to) {
    int n = 0;
    to[n++].def = section_at(s, part[0]);
    for (int k = 0; k < s->n_station; k++) {
        double span = s->station[k].def.position.z;
        if (span > part[0] && span < part[1]) to[n++] = s->station[k];
    }
    to[n++].def = section_at(s, part[1]);
    bough_vec3 origin = to[0].def.position;
    for (int k = 0; k < n; k++) to[k].def.position = bough_sub(to[k].def.position, origin);
    s->n_station = n;
    s->station = to;
}

void bough_scene_take_part(bough_schema_reader *r, const bough_node *given, const double part[2],
                           bough_scene_structure *s) {
    bool good = part[0] >= 0 && part[0] < part[1] && part[1] <= s->length * (1 + 1e-9);
    if (s->n_station < 1 || !isfinite(s->length)) return; // told already
    if (!good) {
        bough_schema_error(r, given, "part",
                           "must be a stretch of the table, which is %g m long, got [%g m, %g m]", s->length,
                           part[0], part[1]);
        return;
    }
    s->length = part[1] - part[0];
    if (s->n_station == 1) return; // uniform
    bough_scene_station *to = bough_arena_take(r->arena, ((size_t)s->n_station + 2) * sizeof *to);
    cut(s, part, to);
}
