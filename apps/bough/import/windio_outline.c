#include "apps/bough/import/windio_outline.h"

#include <math.h>
#include <string.h>

enum { SIDE = BOUGH_OUTLINE_SIDE, ROUND = BOUGH_OUTLINE, POINTS = ROUND + 1 };

// -- airfoils -------------------------------------------------------------------------------------

// Points of an airfoil from its trailing edge along the suction side.
typedef struct points {
    int n;
    double *x, *y; // (n + 2)
} points;

// The mean height of some points.
static double mean(const double *y, int from, int to) {
    double sum = 0;
    for (int i = from; i < to; i++) sum += y[i];
    return to > from ? sum / (to - from) : 0;
}

static int leading_edge(const points *p) {
    int least = 0;
    for (int i = 1; i < p->n; i++) {
        if (p->x[i] < p->x[least]) least = i;
    }
    return least;
}

static void reverse(double *value, int n) {
    for (int i = 0; i < n / 2; i++) {
        double kept = value[i];
        value[i] = value[n - 1 - i];
        value[n - 1 - i] = kept;
    }
}

// A blunt trailing edge begins and ends in its middle.
static void close_edge(points *p) {
    double x = (p->x[0] + p->x[p->n - 1]) / 2, y = (p->y[0] + p->y[p->n - 1]) / 2;
    if (hypot(p->x[0] - x, p->y[0] - y) > 1e-9) {
        memmove(p->x + 1, p->x, (size_t)p->n * sizeof(double));
        memmove(p->y + 1, p->y, (size_t)p->n * sizeof(double));
        p->n += 2;
        p->x[0] = p->x[p->n - 1] = x;
        p->y[0] = p->y[p->n - 1] = y;
    }
}

static points read_points(bough_windio *w, const bough_node *airfoil) {
    bough_draft *d = &w->draft;
    points p = {0};
    const double *x = bough_entry_numbers(d, airfoil, "coordinates.x", &p.n);
    const double *y = x ? bough_entry_numbers(d, airfoil, "coordinates.y", &p.n) : NULL;
    p.x = bough_arena_doubles(d->arena, (size_t)p.n + 2);
    p.y = bough_arena_doubles(d->arena, (size_t)p.n + 2);
    if (!y || !p.x || !p.y) return (points){0};
    memcpy(p.x, x, (size_t)p.n * sizeof(double));
    memcpy(p.y, y, (size_t)p.n * sizeof(double));
    int edge = leading_edge(&p);
    if (p.n < 5 || edge < 2 || edge > p.n - 3) {
        bough_entry_fail(d, airfoil,
                         "coordinates: expected points around the airfoil from its "
                         "trailing edge");
        return (points){0};
    }
    if (mean(p.y, 0, edge) < mean(p.y, edge + 1, p.n)) {
        reverse(p.x, p.n);
        reverse(p.y, p.n);
    }
    close_edge(&p);
    return p;
}

// Draws points `from` to `to` at equal shares of their arc: SIDE + 1 of them.
static void draw_side(const points *p, int from, int to, double *x, double *y) {
    double length = 0, done = 0;
    for (int i = from; i < to; i++) length += hypot(p->x[i + 1] - p->x[i], p->y[i + 1] - p->y[i]);
    int i = from;
    for (int k = 0; k <= SIDE; k++) {
        double wanted = length * k / SIDE, part;
        while (part = hypot(p->x[i + 1] - p->x[i], p->y[i + 1] - p->y[i]),
               i < to - 1 && done + part < wanted) {
            done += part;
            i++;
        }
        double s = part > 0 ? fmin((wanted - done) / part, 1) : 0;
        x[k] = p->x[i] + s * (p->x[i + 1] - p->x[i]);
        y[k] = p->y[i] + s * (p->y[i + 1] - p->y[i]);
    }
}

static void draw(const points *p, double *x, double *y) {
    int edge = leading_edge(p);
    draw_side(p, 0, edge, x, y);
    draw_side(p, edge, p->n - 1, x + SIDE, y + SIDE);
    double least = x[SIDE], chord = fmax(x[0] - least, 1e-9);
    for (int k = 0; k < POINTS; k++) {
        x[k] = (x[k] - least) / chord;
        y[k] /= chord;
    }
}

const double *bough_windio_airfoils(bough_windio *w) {
    const bough_windio_shape *a = &w->outline;
    double *all = bough_arena_doubles(w->draft.arena, (size_t)a->n * 2 * POINTS);
    for (int i = 0; i < a->n && bough_is_ok(w->draft.status); i++) {
        points p = read_points(w, a->place[i].airfoil);
        if (p.n > 0) draw(&p, all + (size_t)i * 2 * POINTS, all + (size_t)i * 2 * POINTS + POINTS);
    }
    return bough_is_ok(w->draft.status) ? all : NULL;
}

// -- the section ----------------------------------------------------------------------------------

void bough_windio_outline_at(const bough_windio *w, const double *airfoils, double share, bough_outline *to) {
    double mix, chord = bough_curve_at(&w->outline.chord, share);
    int i = bough_windio_neighbours(&w->outline, share, &mix);
    const double *one = airfoils + (size_t)i * 2 * POINTS, *two = mix > 0 ? one + 2 * POINTS : one;
    double line = bough_windio_line(&w->outline, share);
    double up = bough_curve_at(&w->outline.offset_x, share);
    for (int k = 0; k < POINTS; k++) {
        to->y[k] = chord * ((1 - mix) * one[k] + mix * two[k]) - line;
        to->x[k] = chord * ((1 - mix) * one[POINTS + k] + mix * two[POINTS + k]) + up;
    }
    to->arc[0] = 0;
    for (int k = 1; k < POINTS; k++)
        to->arc[k] = to->arc[k - 1] + hypot(to->x[k] - to->x[k - 1], to->y[k] - to->y[k - 1]);
    to->length = to->arc[ROUND];
    for (int k = 1; k < POINTS; k++) to->arc[k] /= to->length;
}

double bough_outline_crossing(const bough_outline *o, int side, double turn, double offset) {
    double nearest = HUGE_VAL, found = side ? 0.75 : 0.25;
    for (int k = side * SIDE; k < (side + 1) * SIDE; k++) {
        double a = o->y[k] * cos(turn) + o->x[k] * sin(turn) - offset;
        double b = o->y[k + 1] * cos(turn) + o->x[k + 1] * sin(turn) - offset;
        if ((a <= 0) != (b <= 0)) return o->arc[k] + a / (a - b) * (o->arc[k + 1] - o->arc[k]);
        if (fabs(a) >= nearest) continue;
        nearest = fabs(a);
        found = o->arc[k];
    }
    return found;
}
