// Loads of the sections, and their derivatives by the motion.
#include "aero/rotor/rotor_model.h"

// theory (84), Pitt and Peters: the wake leans, and induction is larger on the leeward half of the disk.
// D. M. Pitt, D. A. Peters, Vertica 5 (1981), with the wake angle χ = (1 + 0.6 a) χ₀; faded by
// the loss factor. `fraction` is the position on the radius, `leeward` the radial direction's
// component downwind.
BOUGH_INLINE double skewed(double axial, double loss, double skew, double fraction, double leeward) {
    double angle = (1 + 0.6 * axial) * skew;
    sine_cosine k = lane_sine_cosine(angle < BOUGH_PI / 2 ? angle : BOUGH_PI / 2);
    double lean = loss * (k.sine / (1 + k.cosine)) * (fraction < 1 ? fraction : 1); // tan χ/2
    return axial * (1 + 15 * BOUGH_PI / 32 * lean * leeward);
}

// The flow at the sections.
static void induce(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                   struct bough_rotor_scratch *scratch) {
    const blade_rows r = scratch->blade[blade];
    bough_mat3 frame = motion->blade[blade].frame.rotation;
    bough_vec3 shaft = bough_mat3_tmul(frame, motion->shaft);
    bough_vec3 downwind = bough_mat3_tmul(frame, scratch->downwind);
    const double *restrict free = rotor->station.free;
    double wake = scratch->wake, skew = rotor->skew ? scratch->skew : 0;
    double tip = fmax(r.radius[rotor->n_station - 1], 1e-3);
    int s = rotor->stride;
#pragma omp simd
    for (int j = 0; j < s; j++) {
        double leeward = bough_dot(bough_cross(shaft, lane_load(r.y, s, j)), downwind);
        // induction with skew, where the loss factor leaves it free, as strong as the wake is
        double leaning = skewed(r.axial[j], r.loss[j], skew, r.radius[j] / tip, leeward);
        double axial = wake * (free[j] > 0 ? leaning : r.axial[j]), tangential = wake * r.tangential[j];
        // inflow at the section: angle, speed, angle of attack in its own plane
        double u = r.inflow_x[j] * (1 - axial), v = r.inflow_y[j] * (1 + tangential);
        r.axial[j] = axial;
        r.tangential[j] = tangential;
        r.phi[j] = lane_angle(u, v);
        double seen = lane_angle(u + r.skew_normal[j] * v, (1 - r.skew_chord[j]) * v);
        r.alpha[j] = lane_remainder(seen - r.twist[j]);
        r.speed[j] = sqrt(u * u + v * v);
    }
}

// Lift, drag and moment coefficients with dynamic stall; as below.
static void advance_stall(const bough_rotor *rotor, double step, const blade_rows *r,
                          bough_stall_state *state, bool slopes) {
    const station_rows *m = &rotor->station;
    bough_stall_sections sections = {rotor->n_station, m->polar,      m->chord, r->speed,
                                     r->alpha,         r->pitch_rate, state};
    bough_stall_results to = {.coefficients = {r->lift, r->drag, r->moment},
                              .with_slopes = slopes,
                              .by_angle = {r->lift_slope, r->drag_slope, r->moment_slope},
                              .by_rate = {r->lift_rate, r->drag_rate, r->moment_rate},
                              .static_slope = r->static_slope};
    BOUGH_AT_LEVEL(bough_stall_advance)(&sections, step, &to);
}

// The same of the static polars, and their derivatives by the angle of attack; those by the section's
// rotation stay zero.
static void evaluate_polars(const bough_rotor *rotor, const blade_rows *r, bool slopes) {
    for (int j = 0; j < rotor->n_station; j++) {
        const bough_polar *polar = rotor->station.polar[j];
        bough_coefficients k = bough_polar_at(polar, r->alpha[j]);
        r->lift[j] = k.lift;
        r->drag[j] = k.drag;
        r->moment[j] = k.moment;
        if (!slopes) continue;
        bough_coefficients by = bough_polar_slope(polar, r->alpha[j]);
        r->static_slope[j] = r->lift_slope[j] = by.lift;
        r->drag_slope[j] = by.drag;
        r->moment_slope[j] = by.moment;
    }
}

// theory (86): force and moment per length on the reference axis.
static void load_stations(const bough_rotor *rotor, const blade_rows *rows) {
    const blade_rows r = *rows;
    const double *restrict chord = rotor->station.chord;
    double density = rotor->density, pitching = rotor->pitching_moment ? 1 : 0;
    int s = rotor->stride;
#pragma omp simd
    for (int j = 0; j < s; j++) {
        double q = 0.5 * density * r.speed[j] * r.speed[j] * chord[j];
        sine_cosine k = lane_sine_cosine(r.alpha[j]);
        double normal = q * (r.lift[j] * k.cosine + r.drag[j] * k.sine);
        double chordwise = q * (r.drag[j] * k.cosine - r.lift[j] * k.sine);
        bough_vec3 force =
            bough_axpy(chordwise, lane_load(r.chord, s, j), bough_scale(normal, lane_load(r.normal, s, j)));
        bough_vec3 moment = bough_axpy(pitching * q * chord[j] * r.moment[j], lane_load(r.z, s, j),
                                       bough_cross(lane_load(r.arm, s, j), force));
        r.force_x[j] = bough_dot(force, lane_load(r.x, s, j));
        r.force_y[j] = -bough_dot(force, lane_load(r.y, s, j));
        r.load[LOAD * j] = force.x;
        r.load[LOAD * j + 1] = force.y;
        r.load[LOAD * j + 2] = force.z;
        r.load[LOAD * j + 3] = moment.x;
        r.load[LOAD * j + 4] = moment.y;
        r.load[LOAD * j + 5] = moment.z;
    }
}

// theory (92): derivatives of the flow along the shaft by the wind and by the velocity of rotation, and of
// the angle of attack by the section's rotation, with the induction in balance.
typedef struct response {
    double flow, across, angle;
} response;

// −dF/dφ of Prandtl's F = 2/π acos exp(−x), x = factor/sin φ.
BOUGH_INLINE double loss_decline(double factor, sine_cosine phi) {
    double sine = fabs(phi.sine), s = sine > 1e-3 ? sine : 1e-3, x = lane_clamp(factor / s, 0, 40);
    double e = lane_exp(-x), square = 1 - e * e;
    return 2 / BOUGH_PI * e * x * fabs(phi.cosine) / (s * sqrt(square > 1e-6 ? square : 1e-6));
}

// `normal`, `slope`: Cn and its slope by α.
BOUGH_INLINE response in_balance(const bough_rotor *rotor, blade_rows r, int j, double normal, double slope) {
    double wind = fabs(r.inflow_x[j]), v = wind > 1 ? wind : 1, w = r.speed[j] > 1 ? r.speed[j] : 1;
    double loss = r.loss[j] > 1e-3 ? r.loss[j] : 1e-3, factor = r.solidity[j] / (4 * loss * v),
           a = r.axial[j];
    sine_cosine phi = lane_sine_cosine(r.phi[j]);
    // 0 or 1: with a branch the loop is not vectorised
    double tip = rotor->induction.tip_loss ? 1 : 0, hub = rotor->induction.hub_loss ? 1 : 0;
    double decline = tip * loss_decline(rotor->station.tip_factor[j], phi) +
                     hub * loss_decline(rotor->station.hub_factor[j], phi);
    // ∂R/∂u of the balance: momentum, loss factor, blade
    double free = 1 - 2 * a + a * (1 - a) * v / (w * loss) * decline;
    double sum = free + factor * w * slope, scale = 1 / (sum > 0.3 ? sum : 0.3);
    double across = -factor * r.inflow_y[j] * (2 * normal - slope * phi.sine) * scale;
    return (response){lane_clamp((1 - a) * scale, 0, 1.2), lane_clamp(across, -1, 1),
                      lane_clamp(free * scale, 0, 1.2)};
}

// At the very tip and root the loss factor holds the induction, dynamic inflow holds it everywhere, and
// without a wake it is zero.
BOUGH_INLINE response section_response(const bough_rotor *rotor, blade_rows r, bool delayed, double wake,
                                       int j, double normal, double slope) {
    response k = in_balance(rotor, r, j, normal, slope);
    bool free = rotor->station.free[j] > 0;
    k.flow = delayed ? 1 : free ? 1 + wake * (k.flow - 1) : 1 - r.axial[j];
    k.across = delayed || !free ? 0 : wake * k.across;
    k.angle = delayed || !free ? 1 : 1 + wake * (k.angle - 1);
    return k;
}

// Derivatives of force and pitching moment per length along two directions of the section's plane.
typedef struct plane {
    double normal, chord, moment;
} plane;

BOUGH_INLINE void store_slope(double *restrict to, plane d, bough_vec3 n, bough_vec3 c, bough_vec3 arm,
                              bough_vec3 z) {
    bough_vec3 force = bough_axpy(d.chord, c, bough_scale(d.normal, n));
    to[0] = force.x;
    to[4] = force.y;
    to[8] = arm.x * force.y - arm.y * force.x + d.moment * z.z;
}

// S of theory (93): derivatives of the loads by the velocity of the vertices, and by the section's rotation
// about its normal and its rate.
static void slope_stations(const bough_rotor *rotor, const blade_rows *rows, const bough_rotor_data *data) {
    bool delayed = data->memory.station != NULL;
    double wake = data->scratch->wake;
    const blade_rows r = *rows;
    const double *restrict chord = rotor->station.chord;
    double density = rotor->density, pitching = rotor->pitching_moment ? 1 : 0;
    int s = rotor->stride;
    double *restrict out = r.slope;
#pragma omp simd
    for (int j = 0; j < s; j++) {
        double q = 0.5 * density * r.speed[j] * chord[j], nose = pitching * chord[j];
        sine_cosine k = lane_sine_cosine(r.alpha[j]);
        // coefficients along normal and chord, and their slopes by the angle of attack
        plane f = {r.lift[j] * k.cosine + r.drag[j] * k.sine, r.drag[j] * k.cosine - r.lift[j] * k.sine,
                   nose * r.moment[j]};
        plane g = {r.lift_slope[j] * k.cosine + r.drag_slope[j] * k.sine + f.chord,
                   r.drag_slope[j] * k.cosine - r.lift_slope[j] * k.sine - f.normal,
                   nose * r.moment_slope[j]}; // by the angle of attack
        plane dn = {q * (2 * f.normal * k.sine + g.normal * k.cosine),
                    q * (2 * f.chord * k.sine + g.chord * k.cosine),
                    q * (2 * f.moment * k.sine + g.moment * k.cosine)}; // by the flow's normal part
        plane dc = {q * (2 * f.normal * k.cosine - g.normal * k.sine),
                    q * (2 * f.chord * k.cosine - g.chord * k.sine),
                    q * (2 * f.moment * k.cosine - g.moment * k.sine)}; // and along the chord
        double still = r.static_slope[j] * k.cosine + r.drag_slope[j] * k.sine + f.chord;
        response to = section_response(rotor, r, delayed, wake, j, f.normal, still);
        bough_vec3 n = lane_load(r.normal, s, j), c = lane_load(r.chord, s, j);
        bough_vec3 x = lane_load(r.x, s, j), y = lane_load(r.y, s, j), z = lane_load(r.z, s, j);
        bough_vec3 arm = lane_load(r.arm, s, j);
        double nx = bough_dot(n, x), ny = bough_dot(n, y) + to.across * nx;
        double cx = bough_dot(c, x), cy = bough_dot(c, y) + to.across * cx;
        // flow along normal and chord by the velocities
        bough_vec3 un = bough_axpy(to.flow * nx, x, bough_scale(ny, y)); // the flow's parts by the velocity
        bough_vec3 uc = bough_axpy(to.flow * cx, x, bough_scale(cy, y));
        bough_vec3 way = bough_cross(z, arm); // of the centre by the rotation
        double rn = bough_dot(un, way), rc = bough_dot(uc, way), w = q * r.speed[j];
        plane by_x = {-dn.normal * un.x - dc.normal * uc.x, -dn.chord * un.x - dc.chord * uc.x,
                      -dn.moment * un.x - dc.moment * uc.x};
        plane by_y = {-dn.normal * un.y - dc.normal * uc.y, -dn.chord * un.y - dc.chord * uc.y,
                      -dn.moment * un.y - dc.moment * uc.y};
        plane by_rate = {-dn.normal * rn - dc.normal * rc, -dn.chord * rn - dc.chord * rc,
                         -dn.moment * rn - dc.moment * rc};
        by_rate.normal += w * (r.lift_rate[j] * k.cosine + r.drag_rate[j] * k.sine);
        by_rate.chord += w * (r.drag_rate[j] * k.cosine - r.lift_rate[j] * k.sine);
        by_rate.moment += w * nose * r.moment_rate[j];
        // the force rotates with the section: z×n = c, z×c = −n
        plane by_angle = {w * (to.angle * g.normal - f.chord), w * (to.angle * g.chord + f.normal),
                          w * to.angle * g.moment};
        // rows of S at the axis
        store_slope(out + SLOPE * j, by_x, n, c, arm, z);
        store_slope(out + SLOPE * j + 1, by_y, n, c, arm, z);
        store_slope(out + SLOPE * j + 2, by_angle, n, c, arm, z);
        store_slope(out + SLOPE * j + 3, by_rate, n, c, arm, z);
    }
}

// Distributes values per length at the stations (`width` each, whole vectors) by n rows of the mapping, the
// first `count` of them, to the vertices or along the segments.
BOUGH_INLINE void spread(int n, const vertex_row *rows, int width, int count, const double *restrict line,
                         double *restrict load) {
    for (int i = 0; i < n; i++) {
        vertex_row row = rows[i];
        double sum[SLOPE] = {0};
        for (int k = 0; k < row.count; k++) {
            const double *from = line + width * (row.first + k);
            for (int c = 0; c < width; c++) sum[c] += row.weight[k] * from[c];
        }
        for (int c = 0; c < count; c++) load[c * n + i] = sum[c];
    }
}

static void sum_blade(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                      bough_rotor_data *data) {
    bough_transform frame = motion->blade[blade].frame;
    bough_vec3 shaft = bough_mat3_tmul(frame.rotation, motion->shaft);
    bough_vec3 hub = bough_mat3_tmul(frame.rotation, bough_sub(motion->hub, frame.position));
    int n = rotor->n_vertex;
    const double *restrict vertex = motion->blade[blade].vertex;
    const double *restrict load = data->load + 6 * blade * n;
    double thrust = 0, torque = 0;
#pragma omp simd reduction(+ : thrust, torque)
    for (int i = 0; i < n; i++) {
        // resultants about the hub
        bough_vec3 force = lane_load(load, n, i), arm = bough_sub(lane_load(vertex, n, i), hub);
        bough_vec3 about = bough_add(bough_cross(arm, force), lane_load(load + 3 * n, n, i));
        thrust += bough_dot(force, shaft);
        torque += bough_dot(about, shaft);
    }
    data->scratch->thrust[blade] = thrust;
    data->scratch->torque[blade] = torque;
}

void BOUGH_AT_LEVEL(bough_rotor_load)(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                                      bough_rotor_data *data) {
    const blade_rows *r = data->scratch->blade + blade;
    induce(rotor, motion, blade, data->scratch);
    bool slopes = rotor->slopes && !data->skips_slopes;
    if (data->memory.stall) {
        advance_stall(rotor, motion->time - data->memory.clock->time, r,
                      data->memory.stall + blade * rotor->n_station, slopes);
    } else {
        evaluate_polars(rotor, r, slopes);
    }
    load_stations(rotor, r);
    int n = rotor->n_vertex;
    spread(n, rotor->row, LOAD, 6, r->load, data->load + 6 * blade * n);
    double *line = data->line + 12 * blade * (n - 1);
    spread(n - 1, rotor->mean, LOAD, 6, r->load, line);
    spread(n - 1, rotor->slope, LOAD, 6, r->load, line + 6 * (n - 1));
    if (slopes) {
        slope_stations(rotor, r, data);
        spread(n, rotor->row, SLOPE, BOUGH_SLOPES, r->slope, data->slope + BOUGH_SLOPES * blade * n);
    }
    sum_blade(rotor, motion, blade, data);
}
