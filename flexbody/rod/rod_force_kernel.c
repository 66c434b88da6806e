// Right-hand side of the rod: gather, segment forces, vertex balances.
#include "flexbody/rod/rod_lanes.h"

// Vertices whose motion is an input: the root, and the last one of a rod that carries bodies.
static void gather_input(const bough_rod_model *m, const double *input, bough_rod_scratch *scratch) {
    int s = m->stride;
    double *vertex = scratch->vertex;
    // the root: at the origin of the BRF, moving with it
    bough_quaternion p0 = m->rotation0[0];
    bough_vec3 omega = {input[3], input[4], input[5]};
    bough_vec3 w0 = bough_mat3_tmul(m->root, omega);
    const double root[BOUGH_ROD_STATES] = {0,        0,        0,        p0.w, p0.x, p0.y, p0.z,
                                           input[0], input[1], input[2], w0.x, w0.y, w0.z};
    for (int c = 0; c < BOUGH_ROD_STATES; c++) vertex[c * s] = root[c];
    if (!bough_rod_carries(m)) return;
    // the last vertex, with its quaternion normalised
    const double *u = input + BOUGH_ROD_INPUTS, *p = u + 9; // u W x p
    double scale = 1 / sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3]);
    const double end[BOUGH_ROD_STATES] = {u[6],         u[7],         u[8], scale * p[0], scale * p[1],
                                          scale * p[2], scale * p[3], u[0], u[1],         u[2],
                                          u[3],         u[4],         u[5]};
    for (int c = 0; c < BOUGH_ROD_STATES; c++) vertex[c * s + m->n + 1] = end[c];
}

// `count` moving vertices from the first on.
BOUGH_INLINE void gather_some(const bough_rod_model *m, const double *restrict state, int first, int count,
                              double *restrict vertex) {
    int n = m->n, s = m->stride;
#pragma omp simd
    for (int i = first; i < first + count; i++) {
        const double *restrict y = state + i - 1;
        bough_quaternion p = bough_quaternion_unit(lane_load_quaternion(y + 3 * n, n, 0));
        lane_store(vertex, s, i, lane_load(y, n, 0));
        vertex[3 * s + i] = p.w;
        lane_store(vertex + 4 * s, s, i, (bough_vec3){p.x, p.y, p.z});
        lane_store(vertex + 7 * s, s, i, lane_load(y + 7 * n, n, 0));
        lane_store(vertex + 10 * s, s, i, lane_load(y + 10 * n, n, 0));
    }
}

// Moving vertices first to last.
static void gather_state(const bough_rod_model *m, const double *state, int first, int last, double *vertex) {
    FOR_VECTORS(first, last, gather_some(m, state, v, count, vertex));
}

void AT(gather)(const bough_rod_model *m, const double *state, const double *input,
                bough_rod_scratch *scratch) {
    gather_input(m, input, scratch);
    gather_state(m, state, 1, m->n, scratch->vertex);
}

// The forces of as many segments as a vector has lanes into rows of the given stride, and cos θ/2 of each.
// Inlined into the loop over vectors, the pointers to all rows would be carried through it, in memory.
static __attribute__((noinline)) void find_forces(const bough_rod_model *m, const bough_rod_scratch *scratch,
                                                  int first, double *restrict out, int stride,
                                                  double *restrict cosine) {
    int s = m->stride;
    const double *restrict vertex = scratch->vertex + first, *restrict rest = scratch->rest + first;
    const double *restrict c = bough_rod_tile(m->stiffness, 21, first);
    const double *restrict d = bough_rod_tile(m->damping, 21, first);
    const double *restrict gradient = bough_rod_tile(m->gradient, 35, first);
    const double *restrict length = m->length + first, *restrict inverse = m->inverse_length + first;
#pragma omp simd
    for (int n = 0; n < BOUGH_WIDTH; n++) {
        vertex_state l = load_vertex(vertex, s, n), r = load_vertex(vertex, s, n + 1);
        // strains beyond those at rest, and their rates
        segment_geometry shape = segment_shape(l, r, inverse[n]);
        strain e = elastic_strain(shape, inverse[n], rest, s, n);
        strain rate = strain_rate(shape, segment_motion(shape, l, r), inverse[n]);
        // stress of the elastic law and of the viscosity, theory (4, 5), and its forces on the two vertices
        strain elastic = segment_stress(c, gradient, BOUGH_LANES, n, e);
        strain viscous = symmetric_times(d, BOUGH_LANES, n, rate);
        segment_force f = stress_force(shape, add_strain(elastic, viscous), length[n]);
        lane_store(out, stride, n, f.f);
        lane_store(out + 3 * stride, stride, n, f.ll);
        lane_store(out + 6 * stride, stride, n, f.lr);
        cosine[n] = length[n] > 0 ? shape.w : 1; // beyond the last: no segment
    }
}

// A vector of segments that are all wanted is written to scratch directly, of another only the wanted ones.
bool AT(forces)(const bough_rod_model *m, int first, int last, bough_rod_scratch *scratch) {
    int s = m->stride;
    double least = 1, cosine[BOUGH_WIDTH], some[9 * BOUGH_WIDTH];
    for (int at = first - first % BOUGH_WIDTH; at < last; at += BOUGH_WIDTH) {
        int begin = first > at ? first - at : 0, end = last - at < BOUGH_WIDTH ? last - at : BOUGH_WIDTH;
        bool whole = end - begin == BOUGH_WIDTH;
        double *out = scratch->segment + at;
        find_forces(m, scratch, at, whole ? out : some, whole ? s : BOUGH_WIDTH, cosine);
        for (int n = begin; n < end; n++) {
            least = cosine[n] < least ? cosine[n] : least;
            for (int k = 0; k < 9 && !whole; k++) out[k * s + n] = some[k * BOUGH_WIDTH + n];
        }
    }
    return least >= 0.5;
}

// Adds the ramped loads; followers are resolved by the sections in scratch->vertex.
static void add_ramped(const bough_rod_model *m, const bough_rod_loads *loads, double t,
                       bough_rod_scratch *scratch) {
    int s = m->stride;
    bool follow = bough_rod_loads_follow(loads);
    if (follow) memset(scratch->follower, 0, 6 * (size_t)s * sizeof(double));
    for (const bough_rod_ramped_load *l = loads->ramped; l != NULL; l = l->next) {
        double factor = bough_schedule_at(&l->schedule, t);
        double *to = l->follower ? scratch->follower : scratch->load;
        for (int k = 0; k < 6 * s; k++) to[k] += factor * l->value[k];
    }
    if (!follow) return;
    // followers from section to BRF axes
    for (int i = 0; i <= m->n_segment; i++) {
        bough_mat3 r = bough_rotation_matrix(load_vertex(scratch->vertex, s, i).p);
        for (int part = 0; part < 6; part += 3) {
            bough_vec3 f = bough_mat3_mul(r, lane_load(scratch->follower + part * s, s, i));
            lane_add(scratch->load + part * s, s, i, f);
        }
    }
}

static bool loads_lie_along(const bough_rod_loads *loads) {
    for (const bough_rod_ramped_load *l = loads->ramped; l != NULL; l = l->next) {
        if (l->along) return true;
    }
    return false;
}

// Adds the moments of the loads along segment n on its axis, which lies beside the chord.
static void add_line_moments_of(const bough_rod_model *m, int n, bough_rod_scratch *scratch) {
    int s = m->stride;
    double h = m->length[n];
    const double *c = bough_rod_tile(m->stiffness, 21, n), *gradient = bough_rod_tile(m->gradient, 35, n);
    segment_geometry shape = shape_at(m, scratch, n);
    strain e = elastic_strain(shape, m->inverse_length[n], scratch->rest, s, n);
    elastic_state elastic = elastic_at(c, gradient, BOUGH_LANES, 0, e);
    // dead loads: theory (22); followers: theory (23)
    dead_line dead = dead_line_at(c, 0, m->line, scratch->along, s, n, elastic);
    end_moments on = middle_moment(shape, axis_moment(m->line, s, n, h, dead.stress, dead.q));
    bough_vec3 bend = bough_axpy(-h, lane_load(m->strain0 + 3 * s, s, n), shape.phi);
    bough_vec3 follower = following_moment(h, bend, lane_load(scratch->following, s, n));
    // on both vertices, in BRF axes
    const bough_vec3 moment[2] = {on.left, on.right};
    for (int side = 0; side < 2; side++) {
        bough_mat3 axes = bough_rotation_matrix(load_vertex(scratch->vertex, s, n + side).p);
        bough_vec3 sum = bough_add(bough_mat3_mul(axes, moment[side]), bough_mat3_mul(shape.r, follower));
        lane_add(scratch->load + 3 * s, s, n + side, sum);
    }
}

// Adds D q of the ramped loads along every step-th segment, the dead ones turned into their middles, and
// their moments on the axis.
static void add_along(const bough_rod_model *m, const bough_rod_loads *loads, double t, int step,
                      bough_rod_scratch *scratch) {
    int s = m->stride;
    size_t bytes = 6 * (size_t)s * sizeof(double);
    if (!loads->moving) memcpy(scratch->own_rest, loads->rest, bytes);
    memset(scratch->along, 0, 2 * bytes);
    memset(scratch->following, 0, bytes / 2);
    scratch->turning = true;
    scratch->rest = scratch->own_rest;
    for (const bough_rod_ramped_load *l = loads->ramped; l != NULL; l = l->next) {
        double factor = bough_schedule_at(&l->schedule, t);
        if (!l->along) continue;
        for (int n = 0; n < m->n_segment; n += step) {
            // q in the axes of the middle: force, moment and their slopes
            bough_mat3 r = shape_at(m, scratch, n).r;
            bough_vec3 q[4];
            for (int part = 0; part < 4; part++) {
                double *to = l->follower ? scratch->following : scratch->along + 3 * part * s;
                q[part] = bough_scale(factor, lane_load(l->line + 3 * part * s, s, n));
                if (!l->follower) q[part] = bough_mat3_tmul(r, q[part]);
                if (l->follower && part > 0) continue;
                lane_add(to, s, n, q[part]);
            }
            // D q
            strain e = line_strain(m->line, s, n, q);
            lane_add(scratch->own_rest, s, n, e.v);
            lane_add(scratch->own_rest + 3 * s, s, n, e.u);
        }
    }
    for (int n = 0; n < m->n_segment; n += step) add_line_moments_of(m, n, scratch);
}

// e⁰ + D q of loads along the segments, `elapsed` after they were set.
static void move_rest(const bough_rod_model *m, const bough_rod_loads *loads, double elapsed,
                      bough_rod_scratch *scratch) {
    const double *restrict rest = loads->rest, *restrict rate = loads->rest_rate;
    double *restrict now = scratch->own_rest;
    int count = 6 * m->stride;
#pragma omp simd
    for (int k = 0; k < count; k++) now[k] = rest[k] + elapsed * rate[k];
    scratch->rest = now;
}

// Adds how the loads follow the motion of vertices first..last themselves.
static void add_damping(const bough_rod_model *m, const bough_rod_loads *loads, int first, int last,
                        bough_rod_scratch *scratch) {
    int s = m->stride;
    const double *restrict u = scratch->vertex + BOUGH_ROD_U * s, *restrict slope = loads->slope;
    const double *restrict p = scratch->vertex + BOUGH_ROD_P * s, *restrict angle = loads->angle;
    const double *restrict w = scratch->vertex + (BOUGH_ROD_W + 2) * s;
    double *restrict load = scratch->load;
#pragma omp simd
    for (int i = first; i <= last; i++) {
        // rotation of the section about its normal
        double phi = angle[i] * p[i] + angle[s + i] * p[s + i] + angle[2 * s + i] * p[2 * s + i] +
                     angle[3 * s + i] * p[3 * s + i];
        double x = u[i], y = u[s + i], z = w[i];
        const double *restrict fx = slope + i, *restrict fy = fx + 4 * s, *restrict mz = fx + 8 * s;
        load[i] += fx[0] * x + fx[s] * y + fx[2 * s] * phi + fx[3 * s] * z;
        load[s + i] += fy[0] * x + fy[s] * y + fy[2 * s] * phi + fy[3 * s] * z;
        load[5 * s + i] += mz[0] * x + mz[s] * y + mz[2 * s] * phi + mz[3 * s] * z;
    }
}

// Loads on all vertices, and along every step-th segment.
static void load_segments(const bough_rod_model *m, const bough_rod_loads *loads, double t, int step,
                          bough_rod_scratch *scratch) {
    // sampled loads on the vertices; all that bough_rod_vertex_rows took: whole registers
    double elapsed = t - loads->start;
    const double *restrict value = loads->value, *restrict rate = loads->rate;
    const double *restrict curve = loads->curve;
    double *restrict load = scratch->load;
    int count = 6 * m->stride;
#pragma omp simd
    for (int k = 1 - BOUGH_LANES; k <= count; k++) {
        load[k] = value[k] + elapsed * (rate[k] + elapsed * curve[k]);
    }
    if (loads->damped) add_damping(m, loads, 1, m->n_segment, scratch);
    // strains at rest
    scratch->rest = loads->rest;
    scratch->turning = false;
    if (loads->moving) move_rest(m, loads, elapsed, scratch);
    // loads on a schedule
    if (loads->ramped == NULL) return;
    add_ramped(m, loads, t, scratch);
    if (loads_lie_along(loads)) add_along(m, loads, t, step, scratch);
}

void AT(load)(const bough_rod_model *m, const bough_rod_loads *loads, double t, bough_rod_scratch *scratch) {
    load_segments(m, loads, t, 1, scratch);
}

// The same for one vertex and one segment, the first or the last; of ramped loads for both.
static void load_end(const bough_rod_model *m, const bough_rod_loads *loads, double t, int vertex,
                     int segment, bough_rod_scratch *scratch) {
    if (loads->ramped != NULL) {
        load_segments(m, loads, t, m->n_segment > 1 ? m->n_segment - 1 : 1, scratch);
        return;
    }
    double elapsed = t - loads->start;
    int s = m->stride;
    for (int k = vertex; k < 6 * s; k += s) {
        scratch->load[k] = loads->value[k] + elapsed * (loads->rate[k] + elapsed * loads->curve[k]);
    }
    if (loads->damped && vertex > 0) add_damping(m, loads, vertex, vertex, scratch);
    scratch->rest = loads->moving ? scratch->own_rest : loads->rest;
    scratch->turning = false;
    for (int k = segment; k < 6 * s && loads->moving; k += s) {
        scratch->own_rest[k] = loads->rest[k] + elapsed * loads->rest_rate[k];
    }
}

// theory (11) solved for the accelerations of as many vertices as a vector has lanes, into rows of the given
// stride: the linear part goes out in BRF axes.
BOUGH_INLINE void vertex_accelerations(const bough_rod_model *m, const bough_rod_scratch *scratch,
                                       const double *input, int from, double *restrict out, int stride) {
    int s = m->stride;
    const double *restrict v = scratch->vertex, *restrict f = scratch->segment;
    const double *restrict load = scratch->load;
    const double *restrict inverse = bough_rod_tile(m->inverse_mass, 21, from - 1);
    const double *restrict first = m->moment, *restrict inertia = m->inertia;
    bough_vec3 omega = {input[3], input[4], input[5]}, gravity = {input[6], input[7], input[8]};
#pragma omp simd
    for (int i = from; i < from + BOUGH_WIDTH; i++) {
        vertex_state a = load_vertex(v, s, i);
        bough_mat3 r = bough_rotation_matrix(a.p);
        // segments on both sides, and loads: force in BRF axes, moment in section axes
        bough_vec3 force =
            bough_add(bough_sub(lane_load(f, s, i), lane_load(f, s, i - 1)), lane_load(load, s, i));
        bough_vec3 moment = bough_add(bough_add(lane_load(f + 3 * s, s, i), lane_load(f + 6 * s, s, i - 1)),
                                      bough_mat3_tmul(r, lane_load(load + 3 * s, s, i)));
        // less the centrifugal and gyroscopic terms, W×(W×s) and W×I W
        bough_vec3 offset = lane_load(first, s, i - 1);
        bough_vec3 centrifugal = bough_cross(a.w, bough_cross(a.w, offset));
        bough_vec3 gyroscopic = bough_cross(a.w, inertia_times(inertia, s, i - 1, a.w));
        strain h = {bough_sub(bough_mat3_tmul(r, force), centrifugal), bough_sub(moment, gyroscopic)};
        // times the inverse mass; u̇ in the rotating BRF axes
        strain q = symmetric_times(inverse, BOUGH_LANES, i - from, h);
        bough_vec3 acceleration =
            bough_sub(bough_add(bough_mat3_mul(r, q.v), gravity), bough_cross(omega, a.u));
        lane_store(out, stride, i - from, acceleration);
        lane_store(out + 3 * stride, stride, i - from, q.u);
    }
}

// The last vertices, which do not fill a vector: beyond them are lanes of zeros.
static void accelerate_last(const bough_rod_model *m, const bough_rod_scratch *scratch, const double *input,
                            int from, double *restrict out) {
    double some[6 * BOUGH_WIDTH];
    vertex_accelerations(m, scratch, input, from, some, BOUGH_WIDTH);
    for (int k = 0; k < 6; k++) {
        for (int i = 0; i <= m->n - from; i++) out[k * m->n + i] = some[k * BOUGH_WIDTH + i];
    }
}

static void accelerate_vertices(const bough_rod_model *m, const bough_rod_scratch *scratch,
                                const double *input, double *restrict rate) {
    int n = m->n, whole = whole_vectors(n, BOUGH_WIDTH);
    double *restrict out = rate + BOUGH_ROD_U * n - 1;
    for (int i = 1; i <= whole; i += BOUGH_WIDTH) vertex_accelerations(m, scratch, input, i, out + i, n);
    if (whole < n) accelerate_last(m, scratch, input, whole + 1, out + whole + 1);
}

// theory (16): ẋ = u − u₀ − ω×x and ṗ = ½ (p∘(0,W) − (0,ω)∘p) + κ(1 − |p|²)p: the last term takes back what
// integration errors do to the norm, in about a second, and does not rotate the section.
BOUGH_INLINE void vertex_kinematics(int n, const double *restrict state, const double *input, int from,
                                    int count, double *restrict rate) {
    bough_vec3 u0 = {input[0], input[1], input[2]}, omega = {input[3], input[4], input[5]};
#pragma omp simd
    for (int i = from - 1; i < from - 1 + count; i++) {
        bough_vec3 x = lane_load(state, n, i), u = lane_load(state + 7 * n, n, i);
        bough_vec3 w = lane_load(state + 10 * n, n, i);
        bough_quaternion p = lane_load_quaternion(state + 3 * n, n, i);
        bough_vec3 v = {p.x, p.y, p.z};
        // p∘(0,W) − (0,ω)∘p = (−v·(W − ω), p₀(W − ω) + v×(W + ω))
        bough_vec3 difference = bough_sub(w, omega), sum = bough_add(w, omega);
        bough_vec3 turn = bough_axpy(p.w, difference, bough_cross(v, sum));
        double restore = BOUGH_ROD_NORM_RATE * (1 - p.w * p.w - bough_dot(v, v));
        lane_store(rate, n, i, bough_sub(bough_sub(u, u0), bough_cross(omega, x)));
        rate[3 * n + i] = -0.5 * bough_dot(v, difference) + restore * p.w;
        lane_store(rate + 4 * n, n, i, bough_axpy(restore, v, bough_scale(0.5, turn)));
    }
}

// The balances of all vertices under the segments' forces in scratch.
static bool balance_vertices(const bough_rod_model *m, const double *state, const double *input,
                             const bough_rod_scratch *scratch, double *restrict rate) {
    int n = m->n;
    FOR_VECTORS(1, n, vertex_kinematics(n, state, input, v, count, rate));
    accelerate_vertices(m, scratch, input, rate);
    double sum = 0; // NaN and infinity survive a sum of squares
    int last = BOUGH_ROD_STATES * n;
#pragma omp simd reduction(+ : sum)
    for (int k = BOUGH_ROD_U * n; k < last; k++) sum += rate[k] * rate[k];
    return isfinite(sum);
}

bool AT(derivative)(const bough_rod_model *m, const bough_rod_loads *loads, double t, const double *state,
                    const double *input, bough_rod_scratch *scratch, double *rate) {
    AT(gather)(m, state, input, scratch);
    AT(load)(m, loads, t, scratch);
    scratch->time = t;
    // whole registers: segments beyond the last exert nothing
    if (!AT(forces)(m, 0, bough_padded(m->n_segment), scratch)) return false;
    return balance_vertices(m, state, input, scratch, rate);
}

// Adds the forces by the change Δ of D q in the present shape to those of the segments: f = −R C Δ, moments
// ∓h/2 f×V + C Δ, without the segments' own rotation φ.
static void add_drift(const bough_rod_model *m, const bough_rod_loads *loads, double elapsed,
                      bough_rod_scratch *scratch) {
    int s = m->stride;
    for (int first = 0; first < m->n_segment; first += BOUGH_LANES) {
        const double *restrict vertex = scratch->vertex + first, *restrict rate = loads->rest_rate + first;
        const double *restrict c = m->stiffness + 21 * first, *restrict e0 = m->strain0 + first;
        const double *restrict length = m->length + first;
        double *restrict out = scratch->segment + first;
#pragma omp simd
        for (int n = 0; n < BOUGH_LANES; n++) {
            bough_quaternion p = load_vertex(vertex, s, n).p, q = load_vertex(vertex, s, n + 1).p;
            bough_mat3 r = mid_frame_between(p, q);
            strain e = {bough_scale(elapsed, lane_load(rate, s, n)),
                        bough_scale(elapsed, lane_load(rate + 3 * s, s, n))};
            strain stress = symmetric_times(c, BOUGH_LANES, n, e);
            bough_vec3 tau = bough_scale(0.5 * length[n], bough_cross(stress.v, lane_load(e0, s, n)));
            lane_add(out, s, n, bough_scale(-1, bough_mat3_mul(r, stress.v)));
            lane_add(out + 3 * s, s, n, bough_sub(tau, stress.u));
            lane_add(out + 6 * s, s, n, bough_add(tau, stress.u));
        }
    }
}

bool AT(derivative_again)(const bough_rod_model *m, const bough_rod_loads *loads, double t,
                          const double *state, const double *input, bough_rod_scratch *scratch,
                          double *rate) {
    int n = m->n_segment;
    double before = scratch->time;
    // the vertices that the input moves, and the loads at the new time
    gather_input(m, input, scratch);
    AT(load)(m, loads, t, scratch);
    // all segments if ramped loads lie along them, else those that touch the input
    bool all = loads_lie_along(loads);
    if (!all && loads->moving) add_drift(m, loads, t - before, scratch);
    bool ok = AT(forces)(m, 0, all ? bough_padded(n) : 1, scratch);
    if (bough_rod_carries(m) && !all) ok = AT(forces)(m, n - 1, n, scratch) && ok;
    return ok && balance_vertices(m, state, input, scratch, rate);
}

void AT(wrenches)(const bough_rod_model *m, const bough_rod_loads *loads, double t, const double *state,
                  const double *input, bough_rod_scratch *scratch, double *wrench) {
    int end = m->n_segment;
    bool carries = bough_rod_carries(m);
    gather_input(m, input, scratch);
    gather_state(m, state, 1, 1, scratch->vertex);
    if (carries) gather_state(m, state, m->n, m->n, scratch->vertex);
    load_end(m, loads, t, 0, 0, scratch);
    if (carries && loads->ramped == NULL)
        load_end(m, loads, t, end, end - 1, scratch); // else both are loaded
    AT(forces)(m, 0, 1, scratch);
    if (carries) AT(forces)(m, end - 1, end, scratch);
    bough_rod_present_wrenches(m, scratch, wrench);
}
