// Newton's method with increments of load for a rod with a held root, and finite changes of its shape.
#include "flexbody/rod/rod_static.h"

#include "core/base/linalg.h"
#include "flexbody/rod/rod_segment.h"

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
        // δφ = 2 Im(p̄∘δp)
        bough_quaternion half =
            bough_quaternion_product(bough_quaternion_conjugate(quaternion_in(at)), quaternion_in(by));
        const double values[BOUGH_ROD_CHANGE] = {shift.x,    shift.y,    shift.z, 2 * half.x,
                                                 2 * half.y, 2 * half.z, 0,       0};
        memcpy(change, values, sizeof values);
    }
}

static vertex_variation variation_of(const double *change, double factor) {
    return (vertex_variation){.x = bough_scale(factor, bough_v3_load(change)),
                              .phi = bough_scale(factor, bough_v3_load(change + 3))};
}

double bough_rod_turn(const bough_rod_model *m, const double *change) {
    double turn = 0;
    for (int i = 0; i < m->n_segment; i++, change += BOUGH_ROD_CHANGE) {
        turn = fmax(turn, bough_norm(variation_of(change, 1).phi));
    }
    return turn;
}

// The chord with which a segment of the shape `after` has the strain before the step plus its change by the
// step to first order.
static bough_vec3 stretched(const segment_geometry *before, const segment_geometry *after, double h,
                            vertex_variation dl, vertex_variation dr) {
    segment_variation change = shape_variation(*before, dl, dr, 1 / h);
    bough_vec3 y = bough_add(before->stretch, change.stretch), v = after->v;
    bough_vec3 bow = bough_cross(v, bough_cross(v, y)); // the inverse of along_axis
    return bough_scale(h, bough_axpy(1 / (6 + bough_dot(v, v)), bow, y));
}

void bough_rod_move(const bough_rod_model *m, const double *change, double fraction, double *state,
                    double *end) {
    vertex_state old = {.x = m->position0[0], .p = m->rotation0[0]}, now = old;
    vertex_variation dl = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
    for (int i = 0; i < m->n_segment; i++, change += BOUGH_ROD_CHANGE) {
        vertex_row row = row_of(m, state, end, i);
        vertex_state r = {.x = position_in(row), .p = quaternion_in(row)}, moved = r;
        vertex_variation dr = variation_of(change, fraction);
        // the rotated vertex
        moved.p =
            bough_quaternion_normalised(bough_quaternion_product(r.p, bough_quaternion_exponential(dr.phi)));
        // its place at the end of a chord that has the segment's strains
        segment_geometry before = segment_shape(old, r, m->inverse_length[i]);
        segment_geometry after = segment_shape(now, moved, m->inverse_length[i]);
        bough_vec3 chord = stretched(&before, &after, m->length[i], dl, dr);
        moved.x = bough_add(now.x, bough_mat3_mul(after.r, chord));
        const double values[] = {moved.x.x, moved.x.y, moved.x.z, moved.p.w, moved.p.x, moved.p.y, moved.p.z};
        for (int c = 0; c < BOUGH_ROD_U; c++) (i < m->n ? state + i : end)[c * row.stride] = values[c];
        old = r;
        now = moved;
        dl = dr;
    }
}

// -- equilibria --------------------------------------------------------------------------------

static const double most_turn = 0.5; // of a vertex in one Newton step [rad]

enum { BAND = 11, BAND_ROWS = 3 * BAND + 1 }; // of the stiffness, on either side of its diagonal

// Of the residual force, relative to the largest load or stress resultant, or of the last step [rad, lengths
// of the rod]
static const double tolerance = 1e-10;

enum {
    MOST_ITERATIONS = 30, // of Newton's method in an increment
    EASY = 8,             // iterations of an increment that encourage a larger one
    SHORTENED = 8,        // steps of an increment; more end in other equilibria
    HALVINGS = 12,        // of the whole load before giving up
};

// Beyond this slenderness rounding can keep Newton's method from converging.
static const double slender = 1e12;

// EA L²/EI.
static double slenderness(const bough_rod_model *m) {
    double largest = 0, length = m->span[m->n];
    for (int n = 0; n < m->n; n++) {
        const double *c = bough_rod_tile(m->stiffness, 21, n);
        double softest = fmin(c[15 * BOUGH_LANES], c[18 * BOUGH_LANES]);
        largest = fmax(largest, c[11 * BOUGH_LANES] * length * length / softest);
    }
    return largest;
}

void bough_rod_static_init(bough_rod_static *work, bough_arena *arena, const bough_rod_model *m) {
    size_t states = (size_t)BOUGH_ROD_STATES * m->n;
    const bough_schedule always = {0};
    bough_rod_scratch_init(&work->scratch, arena, m);
    bough_rod_tangent_init(&work->tangent, arena, m);
    bough_rod_loads_init(&work->scaled, arena, m);
    bough_arena_each(arena, states, &work->rate, &work->trial);
    work->step = bough_arena_doubles(arena, (size_t)BOUGH_COLUMN * m->n);
    work->force = bough_arena_doubles(arena, (size_t)6 * m->n);
    work->band = bough_arena_doubles(arena, (size_t)BAND_ROWS * 6 * m->n);
    work->pivot = bough_arena_take(arena, (size_t)6 * m->n * sizeof *work->pivot);
    work->follower = bough_rod_loads_add(&work->scaled, arena, m, true, &always);
    work->dead = bough_rod_loads_add(&work->scaled, arena, m, false, &always);
}

// Residual forces M v̇ of all vertices into step (n × 8); returns the largest component, forces and
// moments measured against `reference`.
static double residual(const bough_rod_model *m, bough_rod_static *w, double reference) {
    int n = m->n;
    const double *a = w->rate + (size_t)BOUGH_ROD_U * n;
    double largest = 0;
    for (int i = 0; i < n; i++) {
        double *row = w->step + (size_t)BOUGH_COLUMN * i;
        const double minus[BOUGH_COLUMN] = {
            -a[i], -a[n + i], -a[2 * n + i], -a[3 * n + i], -a[4 * n + i], -a[5 * n + i], 0, 0};
        memset(row, 0, BOUGH_COLUMN * sizeof *row);
        bough_block_subtract(w->tangent.blocks.mass + (size_t)i * BOUGH_BLOCK, minus, row);
        for (int c = 0; c < 6; c++) largest = fmax(largest, fabs(row[c]));
    }
    return largest / reference;
}

// The largest stress resultant and load: what a residual is small against.
static double magnitude(const bough_rod_model *m, const bough_rod_static *w) {
    double largest = 1e-300;
    for (int c = 0; c < 9; c++) {
        for (int i = 0; i < m->n; i++) {
            largest = fmax(largest, fabs(w->scratch.segment[c * m->stride + i]));
        }
    }
    for (int k = 0; k < 6 * m->stride; k++) largest = fmax(largest, fabs(w->scratch.load[k]));
    return largest;
}

// Moves the rod by a step, shortened so that no vertex turns by more than most_turn. Returns the
// largest change, lengths measured against the rod's.
static double update(const bough_rod_model *m, const double *step, double *state) {
    double turn = bough_rod_turn(m, step), shift = 0;
    for (int i = 0; i < m->n; i++)
        shift = fmax(shift, bough_norm(bough_v3_load(step + BOUGH_COLUMN * i)) / m->span[m->n]);
    bough_rod_move(m, step, turn > most_turn ? most_turn / turn : 1, state, NULL);
    return fmax(turn, shift);
}

// The block that couples vertex i to j.
static void put_in_band(const double *block, int i, int j, double *band) {
    for (int column = 0; column < 6; column++) {
        double *to = band + (size_t)BAND_ROWS * (6 * j + column) + 2 * BAND + 6 * (i - j) - column;
        for (int row = 0; row < 6; row++) to[row] = block[BOUGH_COLUMN * column + row];
    }
}

// theory (27), with the stiffness −K: in place in step. With pivoting: blocks eliminated in their order leave
// of the residual what would strain a slender rod.
static bool newton_step(const bough_rod_model *m, bough_rod_static *w, const double *input,
                        const double *state) {
    const bough_block_tridiagonal *a = &w->tangent.matrix;
    // K in LAPACK's band storage
    bough_rod_linear_stiffness(m, &w->tangent.blocks, input, state, &w->tangent.matrix);
    memset(w->band, 0, (size_t)BAND_ROWS * 6 * m->n * sizeof(double));
    for (int i = 0; i < m->n; i++) {
        size_t at = (size_t)i * BOUGH_BLOCK;
        put_in_band(a->diagonal + at, i, i, w->band);
        if (i > 0) put_in_band(a->lower + at, i, i - 1, w->band);
        if (i < m->n - 1) put_in_band(a->upper + at, i, i + 1, w->band);
        memcpy(w->force + 6 * i, w->step + BOUGH_COLUMN * i, 6 * sizeof(double));
    }
    if (!bough_band_solve(6 * m->n, BAND, w->band, w->pivot, w->force)) return false;
    for (int i = 0; i < m->n; i++) memcpy(w->step + BOUGH_COLUMN * i, w->force + 6 * i, 6 * sizeof(double));
    return true;
}

// Newton's method under w->scaled. False when it does not converge.
static bool converge(const bough_rod_model *m, const double *input, bough_rod_static *w, double *state) {
    int shortened = 0;
    for (int k = 0; k < MOST_ITERATIONS; k++) {
        w->iterations++;
        // tangent and residual at rest in the moving frame
        bough_rod_move_rigidly(m, input, state);
        if (!bough_rod_linearise(m, &w->scaled, 0, state, input, &w->scratch, &w->tangent)) {
            return false;
        }
        bough_rod_derivative(m, &w->scaled, 0, state, input, &w->scratch, w->rate);
        if (residual(m, w, magnitude(m, w)) < tolerance) return true;
        if (!newton_step(m, w, input, state)) return false;
        // the step; one that is shortened again and again leads to another equilibrium
        double change = update(m, w->step, state);
        shortened += change > most_turn;
        if (shortened > SHORTENED) return false;
        // rounding in a stiff rod keeps the residual up; then a small step is convergence
        if (change < tolerance) {
            bough_rod_move_rigidly(m, input, state);
            return true;
        }
    }
    return false;
}

// Adds what the ramped loads of one kind end with. Whether there are any.
static bool sum_ramped(const bough_rod_model *m, const bough_rod_loads *loads, double fraction,
                       bough_rod_ramped_load *sum) {
    size_t count = 6 * (size_t)m->stride;
    bool any = false;
    memset(sum->value, 0, count * sizeof(double));
    memset(sum->line, 0, 2 * count * sizeof(double));
    sum->along = false;
    for (const bough_rod_ramped_load *l = loads->ramped; l != NULL; l = l->next) {
        if (l->follower != sum->follower) continue;
        any = true;
        sum->along = sum->along || l->along;
        // the factor at the end of its schedule
        double factor = fraction * (l->schedule.n > 0 ? l->schedule.values[l->schedule.n - 1] : 1);
        for (size_t k = 0; k < count; k++) sum->value[k] += factor * l->value[k];
        for (size_t k = 0; k < 2 * count; k++) sum->line[k] += factor * l->line[k];
    }
    return any;
}

// w->scaled ← `fraction` of all loads: those on the vertices, strains of loads along the segments, ramped
// ones.
static void scale_loads(const bough_rod_model *m, const bough_rod_loads *loads, double fraction,
                        bough_rod_static *w) {
    int count = 6 * m->stride;
    for (int k = 0; k < count; k++) {
        w->scaled.value[k] = fraction * loads->value[k];
        w->scaled.rest[k] = m->strain0[k] + fraction * (loads->rest[k] - m->strain0[k]);
    }
    w->scaled.ramped = NULL;
    bough_rod_ramped_load *const kinds[2] = {w->follower, w->dead};
    for (int k = 0; k < 2; k++) {
        if (!sum_ramped(m, loads, fraction, kinds[k])) continue;
        kinds[k]->next = w->scaled.ramped;
        w->scaled.ramped = kinds[k];
    }
}

// Centrifugal forces grow with the square of the twist.
static void scale_input(const double *input, double fraction, double *scaled) {
    for (int k = 0; k < BOUGH_ROD_INPUTS; k++) {
        scaled[k] = (k < BOUGH_ROD_INPUTS - 3 ? sqrt(fraction) : fraction) * input[k];
    }
}

// The failure, with its likely cause.
static bough_status not_found(const bough_rod_model *m, double reached) {
    double ratio = slenderness(m);
    if (ratio > slender) {
        return bough_fail(
            BOUGH_FAILED,
            "rod %s: no static equilibrium found: EA L²/EI is %.2g, and beyond %.0e rounding of the positions bends the rod; EA = %.0e EI/L² gives the same bending",
            m->name, ratio, slender, 1e8);
    }
    return bough_fail(BOUGH_FAILED,
                      "rod %s: no static equilibrium found beyond %.4g %% of"
                      " the load; the rod may buckle there, or more segments are needed",
                      m->name, 100 * reached);
}

bough_status bough_rod_steady(const bough_rod_model *m, const bough_rod_loads *loads, const double *input,
                              bough_rod_static *work, double *state) {
    size_t bytes = (size_t)BOUGH_ROD_STATES * m->n * sizeof *state;
    double reached = 0, increment = 1;
    work->iterations = 0;
    while (reached < 1) {
        // the next increment, from the last equilibrium
        double target = fmin(reached + increment, 1), scaled[BOUGH_ROD_INPUTS];
        int before = work->iterations;
        scale_loads(m, loads, target, work);
        scale_input(input, target, scaled);
        memcpy(work->trial, state, bytes);
        // accepted, and doubled where it was easy; else halved
        if (converge(m, scaled, work, work->trial)) {
            memcpy(state, work->trial, bytes);
            reached = target;
            if (work->iterations - before <= EASY) increment = fmin(2 * increment, 1);
        } else if ((increment /= 2) < ldexp(1, -HALVINGS)) {
            return not_found(m, reached);
        }
    }
    return bough_ok();
}
