// Section tables along the axis: interpolation between stations, axes, quadrature.
#include "flexbody/section/section_axis.h"

#include "core/base/linalg.h"

enum { MOST_HALVINGS = 40 };

enum { POINTS = 8 }; // of Gauss–Legendre quadrature on each interval without a station inside

static const double gauss_at[POINTS] = {-0.9602898564975363, -0.7966664774136267, -0.5255324099163290,
                                        -0.1834346424956498, 0.1834346424956498,  0.5255324099163290,
                                        0.7966664774136267,  0.9602898564975363};
static const double gauss_weight[POINTS] = {0.1012285362903763, 0.2223810344533745, 0.3137066458778873,
                                            0.3626837833783620, 0.3626837833783620, 0.3137066458778873,
                                            0.2223810344533745, 0.1012285362903763};

// Where s lies in the interval behind station k.
static bough_section_place place_in(const bough_section_axis *a, int k, double s) {
    double fraction = bough_clamp((s - a->arc[k]) / (a->arc[k + 1] - a->arc[k]), 0, 1);
    return (bough_section_place){&a->station[k], &a->station[k + 1], fraction};
}

bough_section_place bough_section_find(const bough_section_axis *a, double s) {
    return place_in(a, bough_table_row(a->n, a->arc, 1, s), s);
}

// Diagonal entry i of the stiffness.
static double stiffness_at(bough_section_place p, int i) {
    int k = bough_symmetric6_index(i, i);
    return bough_section_mix(p.fraction, p.low->stiffness[k], p.high->stiffness[k]);
}

// Whether no stiffness varies by more than √2, so that no part of the interval need be halved.
static bool is_even(bough_section_place low, bough_section_place high) {
    const double most = 1.414; // less than √2 by more than rounding
    bool even = true;
    for (int i = 0; i < 6; i++) {
        double x = stiffness_at(low, i), y = stiffness_at(high, i);
        even = even && x > 0 && y > 0 && x < most * y && y < most * x;
    }
    return even;
}

void bough_section_axis_init(bough_section_axis *a, bough_arena *arena, const bough_section_table *table) {
    size_t given = (size_t)table->n_station;
    a->n = table->n_station == 1 ? 2 : table->n_station; // a uniform rod is two equal stations
    bough_section_station *station = bough_arena_take(arena, (size_t)a->n * sizeof *station);
    memcpy(station, table->station, given * sizeof *station);
    if (given == 1) {
        station[1] = station[0];
        station[0].position = bough_v3(0, 0, 0);
        station[1].position = bough_v3(0, 0, table->length);
    }
    a->station = station;
    memcpy(a->damping, table->damping, sizeof a->damping);
    a->arc = bough_arena_doubles(arena, (size_t)a->n);
    a->even = bough_arena_take(arena, (size_t)a->n * sizeof *a->even);
    // arc lengths are those of the polygon through the stations
    for (int k = 1; k < a->n; k++) {
        bough_vec3 step = bough_sub(a->station[k].position, a->station[k - 1].position);
        a->arc[k] = a->arc[k - 1] + bough_norm(step);
        a->even[k - 1] = is_even(place_in(a, k - 1, a->arc[k - 1]), place_in(a, k - 1, a->arc[k]));
    }
}

// Steiner's theorem, for the offset of the mass centre from the axis.
void bough_section_central(const bough_section_station *x, double central[4]) {
    double cx = x->centre[0], cy = x->centre[1];
    central[0] = x->inertia[0] - x->mass * cy * cy;
    central[1] = x->inertia[1] - x->mass * cx * cx;
    central[2] = x->inertia[2] + x->mass * cx * cy;
    central[3] = x->inertia[3] - x->mass * (cx * cx + cy * cy);
}

static bool is_positive(const double central[4]) {
    return central[0] > 0 && central[1] > 0 && central[3] > 0 &&
           central[0] * central[1] > central[2] * central[2];
}

// Between distant stations, a linear mass and a linear offset may need more inertia than the linear one
// gives: there the inertia about the mass centre is linear.
static void mend_inertia(const bough_section_station *low, const bough_section_station *high, double fraction,
                         bough_section_station *x) {
    double central[4], below[4], above[4];
    bough_section_central(x, central);
    if (is_positive(central)) return;
    bough_section_central(low, below);
    bough_section_central(high, above);
    for (int i = 0; i < 4; i++) x->inertia[i] += bough_section_mix(fraction, below[i], above[i]) - central[i];
}

bough_section_station bough_section_of(bough_section_place p) {
    const bough_section_station *l = p.low, *h = p.high;
    bough_section_station x;
    x.position = bough_between(l->position, h->position, p.fraction);
    x.twist = bough_section_mix(p.fraction, l->twist, h->twist);
    x.mass = bough_section_mix(p.fraction, l->mass, h->mass);
    for (int i = 0; i < 21; i++) {
        x.stiffness[i] = bough_section_mix(p.fraction, l->stiffness[i], h->stiffness[i]);
    }
    for (int i = 0; i < 2; i++) x.centre[i] = bough_section_mix(p.fraction, l->centre[i], h->centre[i]);
    for (int i = 0; i < 4; i++) x.inertia[i] = bough_section_mix(p.fraction, l->inertia[i], h->inertia[i]);
    mend_inertia(l, h, p.fraction, &x);
    return x;
}

bough_section_station bough_section_between(const bough_section_station *low,
                                            const bough_section_station *high, double fraction) {
    return bough_section_of((bough_section_place){low, high, fraction});
}

bough_section_station bough_section_at(const bough_section_axis *a, double s) {
    return bough_section_of(bough_section_find(a, s));
}

bough_vec3 bough_section_direction(bough_vec3 from, bough_vec3 to) {
    bough_vec3 step = bough_sub(to, from);
    return bough_scale(1 / bough_norm(step), step);
}

// The smallest rotation of z onto the tangent, then −twist about it.
bough_quaternion bough_section_rotation(bough_vec3 t, double twist) {
    bough_quaternion lean = bough_quaternion_normalised((bough_quaternion){1 + t.z, -t.y, t.x, 0});
    return bough_quaternion_product(lean, (bough_quaternion){cos(0.5 * twist), 0, 0, -sin(0.5 * twist)});
}

bough_quaternion bough_section_rotation_in(bough_section_place p) {
    bough_vec3 t = bough_section_direction(p.low->position, p.high->position);
    return bough_section_rotation(t, bough_section_mix(p.fraction, p.low->twist, p.high->twist));
}

// A part of the interval behind station k, of whose quadrature the points are visited.
typedef struct stretch {
    const bough_section_axis *axis;
    int k;
    bough_section_visitor visit;
    void *context;
} stretch;

// One quadrature from one arc length to another.
static void integrate_piece(const stretch *x, double from, double to) {
    double half = 0.5 * (to - from);
    for (int i = 0; i < POINTS; i++) {
        bough_section_point p = {0.5 * (from + to) + half * gauss_at[i], half * gauss_weight[i], {0}};
        p.place = place_in(x->axis, x->k, p.s);
        x->visit(x->context, &p);
    }
}

// Halvings of an interval towards its softer end, so that compliances, 1/(a + b s), vary by little more than
// a factor of two over each part.
static int halvings(const stretch *x, double soft, double stiff) {
    bough_section_place low = place_in(x->axis, x->k, soft), high = place_in(x->axis, x->k, stiff);
    double ratio = 1;
    for (int i = 0; i < 6; i++) {
        double least = stiffness_at(low, i), most = stiffness_at(high, i);
        if (least > 0) ratio = fmax(ratio, most / least);
    }
    return (int)fmin(ceil(log2(ratio) - 0.5), MOST_HALVINGS);
}

static void integrate_stretch(const stretch *x, double from, double to) {
    double middle = 0.5 * (from + to), inside = to - 1e-9 * (to - from); // before a station
    bool even = x->axis->even[x->k];
    int below = even ? 0 : halvings(x, from, inside), above = even ? 0 : halvings(x, inside, from);
    if (below == 0 && above == 0) {
        integrate_piece(x, from, to);
        return;
    }
    // parts that halve towards both ends
    double low = from + ldexp(middle - from, -below), high = to - ldexp(to - middle, -above);
    integrate_piece(x, from, low);
    for (int k = below - 1; k >= 0; k--) {
        double next = from + ldexp(middle - from, -k);
        integrate_piece(x, low, next);
        low = next;
    }
    for (int k = 1; k <= above; k++) {
        double next = to - ldexp(to - middle, -k);
        integrate_piece(x, low, next);
        low = next;
    }
    integrate_piece(x, high, to);
}

void bough_section_integrate(const bough_section_axis *a, double from, double to, bough_section_visitor visit,
                             void *context) {
    // piece by piece between stations; the last interval continues beyond the last station
    for (int k = 0; k < a->n && from < to; k++) {
        double end = k + 1 < a->n ? a->arc[k + 1] : to;
        if (end <= from) continue;
        if (end > to) end = to;
        integrate_stretch(&(stretch){a, k < a->n - 1 ? k : k - 1, visit, context}, from, end);
        from = end;
    }
}
