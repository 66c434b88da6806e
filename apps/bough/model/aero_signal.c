#include "apps/bough/model/aero_link.h"

#include "aero/rotor/rotor.h"
#include "flexbody/rod/rod_load.h"

// The signal between two samples. F are the loads at the next sample for the predicted motion, S their
// derivatives with respect to the motion of the vertices. Between the samples F − S·motion follows the
// parabola through its last three values, and a rod adds S·motion as it moves: damping and stiffness of the
// air act without delay, and the error of the prediction is corrected within the same sample.
//
// Loads of modal and rigid bodies change to F, plus 3 Δ τ(1 − τ) for the error of the previous sample,
// Δ = S·(motion − predicted motion): Adams' formula of third order.

struct bough_aero_signal {
    bough_simulation *simulation;
    const bough_beam *beam;
    int n, n_vertex;
    double start, span;           // [s]
    double damped;                // 1: the body adds S·motion
    double missed;                // mean square error of the loads, relative to that of the loads
    double *sampled;              // (n) loads at the previous sample
    double *reached;              // (n) loads at the end of the signal, for the predicted motion
    double *value, *rate, *curve; // (n) of the signal since `start`
    double *slope;                // S (BOUGH_SLOPES × n_vertex)
    double *angle;                // rotation of a section about its normal by its quaternion (4 × n_vertex)
    double *expected;             // S·expected motion (3 × n_vertex)
    double *row;                  // start of the block of all stored arrays, from `sampled` on
    // scratch
    double *fresh;           // (n)
    double *now, *before;    // S·motion (3 × n_vertex)
    double *whole, *last;    // (n) at the present and the previous sample
    double *along;           // per length (12 × segments): its rate, of a modal body itself
    double *strain, *lumped; // of a modal body, D q and the loads of it (6 × the mesh's stride)
};

// -- build ----------------------------------------------------------------------------------------

static int stored(const bough_aero_signal *s) { return 5 * s->n + (BOUGH_SLOPES + 7) * s->n_vertex; }

static void take(bough_arena *arena, bough_aero_signal *s) {
    size_t n = (size_t)s->n, vertices = (size_t)s->n_vertex, segments = vertices - 1;
    double *row = s->row = bough_arena_doubles(arena, (size_t)stored(s));
    double **const part[] = {&s->sampled, &s->reached, &s->value, &s->rate, &s->curve};
    for (int i = 0; i < 5; i++, row += n) *part[i] = row;
    s->slope = row;
    s->angle = row + BOUGH_SLOPES * vertices;
    s->expected = s->angle + 4 * vertices;
    bough_arena_each(arena, n, &s->fresh, &s->whole, &s->last);
    bough_arena_each(arena, 3 * vertices, &s->now, &s->before);
    if (s->beam->port >= 0) s->along = bough_arena_doubles(arena, 12 * segments);
    if (s->beam->modal == NULL) return;
    size_t stride = (size_t)s->beam->mesh->stride;
    bough_arena_each(arena, 6 * stride, &s->strain, &s->lumped);
}

bough_aero_signal *bough_aero_signal_build(bough_arena *arena, bough_simulation *simulation,
                                           const bough_beam *beam) {
    bough_aero_signal *s = bough_arena_take(arena, sizeof *s);
    s->simulation = simulation;
    s->beam = beam;
    s->n_vertex = beam->def.n_segment + 1;
    s->n = beam->port < 0 ? 6 : 6 * s->n_vertex;
    if (beam->rod != NULL) s->n += 12 * (s->n_vertex - 1);
    take(arena, s);
    return s;
}

// -- fresh loads ----------------------------------------------------------------------------------

// The resultant of loads on the vertices of a rigid blade; row[c]: component c (n_vertex), NULL: 0.
static void sum_loads(const bough_aero_signal *s, const double *const row[6], double sum[6]) {
    bough_wrench total = {{0, 0, 0}, {0, 0, 0}};
    for (int i = 0; i < s->n_vertex; i++) {
        double here[6];
        for (int c = 0; c < 6; c++) here[c] = row[c] == NULL ? 0 : row[c][i];
        bough_transform at = {s->beam->def.position[i], bough_mat3_identity()};
        total = bough_wrench_add(total, bough_wrench_to_parent(&at, bough_wrench_load(here)));
    }
    bough_wrench_store(total, sum);
}

// Modal bodies have loads on vertices only.
static void lump_line(bough_aero_signal *s) {
    const bough_rod_model *m = s->beam->mesh;
    int n = s->n_vertex, stride = m->stride;
    memset(s->lumped, 0, 6 * (size_t)stride * sizeof(double));
    bough_rod_line_strain(m, s->along, s->strain);
    bough_rod_lump_strain(m, s->strain, s->lumped);
    for (int c = 0; c < 6; c++) {
        for (int i = 0; i < n; i++) s->fresh[c * n + i] += s->lumped[c * stride + i];
    }
}

static void take_fresh(bough_aero_signal *s, bough_aero_fresh fresh, const double *rows) {
    int n = s->n_vertex;
    if (s->beam->port < 0) {
        const double *const row[6] = {fresh.load,         fresh.load + n,     fresh.load + 2 * n,
                                      fresh.load + 3 * n, fresh.load + 4 * n, fresh.load + 5 * n};
        sum_loads(s, row, s->fresh);
    } else {
        memcpy(s->fresh, fresh.load, 6 * (size_t)n * sizeof(double));
        bough_rod_take_line(s->beam->mesh, rows + BOUGH_BLADE_ROTATION * n, fresh.line,
                            s->beam->rod != NULL ? s->fresh + 6 * n : s->along, s->fresh);
        if (s->beam->modal != NULL) lump_line(s);
    }
    double *restrict loads = s->fresh;
#pragma omp simd
    for (int k = 0; k < s->n; k++) loads[k] *= fresh.factor;
}

// -- slopes ---------------------------------------------------------------------------------------

// The row that gives the rotation about the section's normal, 2 p₀*∘p, when it is multiplied by p.
static void set_angle(int n, const double *rows, double *restrict angle) {
    const double *restrict p = rows + BOUGH_BLADE_ROTATION * n;
#pragma omp simd
    for (int i = 0; i < n; i++) {
        double w = p[i], x = p[n + i], y = p[2 * n + i], z = p[3 * n + i];
        double scale = 2 / sqrt(w * w + x * x + y * y + z * z);
        angle[i] = -scale * z;
        angle[n + i] = scale * y;
        angle[2 * n + i] = -scale * x;
        angle[3 * n + i] = scale * w;
    }
}

// S·motion: force along x and y, moment about z.
static void apply_slope(const bough_aero_signal *s, const double *rows, double *restrict load) {
    int n = s->n_vertex;
    const double *restrict p = rows + BOUGH_BLADE_ROTATION * n, *restrict angle = s->angle;
    const double *restrict u = rows + BOUGH_BLADE_VELOCITY * n, *restrict slope = s->slope;
    const double *restrict spin = rows + (BOUGH_BLADE_SPIN + 2) * n;
#pragma omp simd
    for (int i = 0; i < n; i++) {
        double w = p[i], x = p[n + i], y = p[2 * n + i], z = p[3 * n + i];
        double phi = angle[i] * w + angle[n + i] * x + angle[2 * n + i] * y + angle[3 * n + i] * z;
        phi /= sqrt(w * w + x * x + y * y + z * z);
        for (int c = 0; c < 3; c++) {
            const double *restrict row = slope + 4 * c * n + i;
            load[c * n + i] = row[0] * u[i] + row[n] * u[n + i] + row[2 * n] * phi + row[3 * n] * spin[i];
        }
    }
}

// Adds factor times these loads to those of the body.
static void add_slope(const bough_aero_signal *s, double factor, const double *from, double *to) {
    int n = s->n_vertex;
    if (s->beam->port < 0) {
        const double *const row[6] = {from, from + n, NULL, NULL, NULL, from + 2 * n};
        double sum[6];
        sum_loads(s, row, sum);
        for (int c = 0; c < 6; c++) to[c] += factor * sum[c];
        return;
    }
    static const int place[3] = {0, 1, 5};
    for (int c = 0; c < 3; c++) {
        double *restrict row = to + place[c] * n;
#pragma omp simd
        for (int i = 0; i < n; i++) row[i] += factor * from[c * n + i];
    }
}

static void take_slope(bough_aero_signal *s, bough_aero_fresh fresh, bough_aero_course course) {
    int n = s->n_vertex;
    double *restrict slope = s->slope;
#pragma omp simd
    for (int k = 0; k < BOUGH_SLOPES * n; k++) slope[k] = fresh.factor * fresh.slope[k];
    for (int c = 0; c < BOUGH_SLOPES; c++) { // vertices moved by inputs are no states
        slope[c * n] = 0;
        if (s->beam->rod && bough_rod_carries(s->beam->mesh)) slope[c * n + n - 1] = 0;
    }
    set_angle(n, course.now, s->angle);
    apply_slope(s, course.next, s->expected);
}

// -- the signal -----------------------------------------------------------------------------------

// Sets the signal on the body.
static void put(bough_aero_signal *s) {
    const bough_beam *beam = s->beam;
    if (beam->port < 0) {
        bough_tree_set_wrench(s->simulation->tree, beam->marker, s->start, s->value, s->rate, s->curve);
        return;
    }
    bough_rod_loads *rod = beam->loads;
    size_t stride = (size_t)beam->mesh->stride, n = (size_t)s->n_vertex;
    for (size_t c = 0; c < 6; c++) {
        memcpy(rod->value + c * stride, s->value + c * n, n * sizeof(double));
        memcpy(rod->rate + c * stride, s->rate + c * n, n * sizeof(double));
        memcpy(rod->curve + c * stride, s->curve + c * n, n * sizeof(double));
    }
    rod->start = s->start;
    if (beam->rod == NULL) return;
    rod->damped = s->damped > 0;
    for (size_t c = 0; c < BOUGH_SLOPES && rod->damped; c++)
        memcpy(rod->slope + c * stride, s->slope + c * n, n * sizeof(double));
    for (size_t c = 0; c < 4 && rod->damped; c++)
        memcpy(rod->angle + c * stride, s->angle + c * n, n * sizeof(double));
    int first = 6 * s->n_vertex, count = s->n - first; // along the segments: linear
    const double *restrict from = s->value + first, *restrict to = s->reached + first;
    double *restrict along = s->along, inverse = 1 / s->span;
#pragma omp simd
    for (int k = 0; k < count; k++) along[k] = (to[k] - from[k]) * inverse;
    bough_rod_loads_along(beam->mesh, from, along, rod);
}

void bough_aero_signal_hold(bough_aero_signal *s, bough_aero_fresh fresh, bough_aero_course course,
                            double start) {
    size_t bytes = (size_t)s->n * sizeof(double), n = (size_t)s->n_vertex;
    take_fresh(s, fresh, course.next);
    memcpy(s->sampled, s->fresh, bytes);
    memcpy(s->reached, s->fresh, bytes);
    memcpy(s->value, s->fresh, bytes);
    memset(s->rate, 0, bytes);
    memset(s->curve, 0, bytes);
    memset(s->slope, 0, BOUGH_SLOPES * n * sizeof(double));
    memset(s->expected, 0, 3 * n * sizeof(double));
    s->damped = 0;
    s->missed = 0;
    s->start = start;
    s->span = 1;
    put(s);
}

// The parabola from `from` to `next` with the curvature of the one through last, now and next: a straight
// line plus bump·τ(1 − τ).
static void bend(bough_aero_signal *s, const double *from, const double *next, const double *now,
                 const double *last) {
    double *restrict value = s->value, *restrict rate = s->rate, *restrict curve = s->curve;
    double inverse = 1 / s->span, square = inverse * inverse;
#pragma omp simd
    for (int k = 0; k < s->n; k++) {
        double bump = -0.5 * (next[k] - 2 * now[k] + last[k]) + 3 * (now[k] - from[k]);
        value[k] = from[k];
        rate[k] = (next[k] - from[k] + bump) * inverse;
        curve[k] = -bump * square;
    }
}

// Error of the prediction in the forces normal to the blade, mean over about ten samples.
static void note_missed(bough_aero_signal *s) {
    const double *restrict now = s->now, *restrict expected = s->expected, *restrict whole = s->whole;
    double missed = 0, size = 0;
#pragma omp simd reduction(+ : missed, size)
    for (int k = 0; k < 2 * s->n_vertex; k++) {
        missed += (now[k] - expected[k]) * (now[k] - expected[k]);
        size += whole[k] * whole[k];
    }
    if (size > 0) s->missed += 0.1 * (fmin(missed / size, 1) - s->missed);
}

void bough_aero_signal_follow(bough_aero_signal *s, bough_aero_fresh fresh, bough_aero_course course,
                              double start, double span) {
    size_t bytes = (size_t)s->n * sizeof(double);
    double *whole = s->whole, *last = s->last;
    bool rod = s->beam->rod != NULL;
    s->start = start;
    s->span = span;
    s->damped = rod;
    take_fresh(s, fresh, course.next);
    apply_slope(s, course.now, s->now); // by the slopes of the previous sample
    memcpy(whole, s->reached, bytes);
    add_slope(s, 1, s->now, whole);
    add_slope(s, -1, s->expected, whole);
    if (s->beam->port >= 0) note_missed(s);
    memcpy(last, s->sampled, bytes);
    memcpy(s->sampled, whole, bytes);
    take_slope(s, fresh, course);
    if (rod) {
        apply_slope(s, course.now, s->now);
        apply_slope(s, course.before, s->before);
        add_slope(s, -1, s->now, whole);
        add_slope(s, -1, s->before, last);
        add_slope(s, -1, s->expected, s->fresh);
        bend(s, whole, s->fresh, whole, last);
        add_slope(s, 1, s->expected, s->fresh);
    } else {
        bend(s, s->reached, s->fresh, whole, last);
    }
    memcpy(s->reached, s->fresh, bytes);
    put(s);
}

double bough_aero_signal_missed(const bough_aero_signal *s) { return sqrt(s->missed); }

// -- saving ---------------------------------------------------------------------------------------

void bough_aero_signal_snapshot(bough_aero_signal *s, bough_snapshot *snapshot) {
    BOUGH_SNAPSHOT(snapshot, s->start, s->span, s->damped, s->missed);
    bough_snapshot_doubles(snapshot, s->row, stored(s));
    if (snapshot->move == BOUGH_SNAPSHOT_RESTORE && s->span > 0) put(s);
}
