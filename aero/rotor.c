#include "aero/rotor_model.h"

#include "aero/rotor_memory.h"

// The blade elements follow the polar formulation of the reference code (AeroDyn v5): y is
// tangential at the element's own place, x normal to the bent but unswept, unpitched, untwisted
// blade, and momentum is balanced over the element's projection on the rotor plane. Lift and drag act
// in the section's own plane, where the angle of attack is taken. Axes of the blade root instead gave
// 0.4 % less thrust on a blade bent by 3 m. Loss factors are those of the undeformed rotor; forces are
// per length of the reference axis.
//
// Everything of a blade is reckoned in its frame's axes, stations side by side in vector lanes.

// -- approach -------------------------------------------------------------------------------------

static inline bough_quaternion section_at(const double *restrict vertex, int n, int i) {
    const double *p = vertex + BOUGH_BLADE_ROTATION * n;
    return unit_quaternion(p[i], p[n + i], p[2 * n + i], p[3 * n + i]);
}

// The axes of a blade element at `arm` from the hub.
typedef struct element_axes {
    bough_vec3 x, y, z;
    double radius; // from the shaft
} element_axes;

// y against the rotation, normal to shaft and arm; z as the section's, without sweep. `aside`: any
// direction normal to the shaft, taken on it.
static inline element_axes axes_at(bough_vec3 shaft, bough_vec3 aside, bough_vec3 arm,
                                   bough_vec3 along) {
    bough_vec3 out = bough_axpy(-bough_dot(arm, shaft), shaft, arm);
    double radius = bough_norm(out), off = radius < 1e-9 ? 0 : 1, scale = off / (radius + 1 - off);
    bough_vec3 radial = bough_axpy(1 - off, aside, bough_scale(scale, out));
    double s = lane_clamp(bough_dot(along, shaft), -1, 1), c = sqrt(1 - s * s);
    return (element_axes){bough_axpy(-s, radial, bough_scale(c, shaft)),
                          bough_cross(radial, shaft),
                          bough_axpy(s, shaft, bough_scale(c, radial)), radius};
}

// Beyond this a section stands askew only where the blade is next to the shaft, or folded.
static const double most_skew = 0.2;

static bough_vec3 any_normal(bough_vec3 v) {
    bough_vec3 n = bough_cross(v, fabs(v.x) < 0.5 ? bough_v3(1, 0, 0) : bough_v3(0, 1, 0));
    return bough_scale(1 / bough_norm(n), n);
}

// Where the stations of a blade are, how they stand and move.
static void move_stations(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                          blade_rows *restrict to) {
    const station_rows m = rotor->station;
    const blade_rows r = *to;
    bough_transform frame = motion->blade[blade].frame;
    const double *restrict vertex = motion->blade[blade].vertex;
    bough_vec3 shaft = bough_mat3_tmul(frame.rotation, motion->shaft), aside = any_normal(shaft);
    bough_vec3 hub = bough_mat3_tmul(frame.rotation, bough_sub(motion->hub, frame.position));
    int n = rotor->n_vertex, s = rotor->stride;
    const double *restrict velocity = vertex + BOUGH_BLADE_VELOCITY * n;
    const double *restrict spin = vertex + BOUGH_BLADE_SPIN * n;
#pragma omp simd
    for (int j = 0; j < s; j++) {
        int a = m.vertex[j], b = a + 1;
        double w = m.weight[j];
        bough_quaternion p = section_at(vertex, n, a), q = section_at(vertex, n, b);
        bough_mat3 structure = rotation_between(p, q, w);
        bough_mat3 section = bough_mat3_product(structure, load_matrix(m.section, s, j));
        bough_vec3 arm = bough_mat3_mul(structure, lane_load(m.centre, s, j));
        bough_vec3 axis = vector_between(lane_load(vertex, n, a), lane_load(vertex, n, b), w);
        bough_vec3 centre = bough_add(axis, arm);
        element_axes e = axes_at(shaft, aside, bough_sub(centre, hub), section.c3);
        bough_vec3 turning = vector_between(bough_mat3_mul(matrix_of(p), lane_load(spin, n, a)),
                                            bough_mat3_mul(matrix_of(q), lane_load(spin, n, b)), w);
        bough_vec3 moving = vector_between(lane_load(velocity, n, a), lane_load(velocity, n, b), w);
        lane_store(r.arm, s, j, arm);
        lane_store(r.x, s, j, e.x);
        lane_store(r.y, s, j, e.y);
        lane_store(r.z, s, j, e.z);
        lane_store(r.velocity, s, j, bough_add(moving, bough_cross(turning, arm)));
        lane_store(r.place, s, j, bough_add(frame.position, bough_mat3_mul(frame.rotation, centre)));
        r.radius[j] = e.radius;
        r.turning[j] = bough_dot(turning, e.z);
        double along = bough_dot(section.c1, shaft), across = bough_dot(section.c2, shaft);
        double y1 = bough_dot(section.c1, e.y), y2 = bough_dot(section.c2, e.y);
        double size = sqrt(along * along + across * across), scale = 1 / (size > 1e-9 ? size : 1);
        lane_store(r.normal, s, j, section.c1);
        lane_store(r.chord, s, j, section.c2);
        r.twist[j] = lane_angle(across, along);
        r.skew_normal[j] = lane_clamp((along * y1 + across * y2) * scale, -most_skew, most_skew);
        r.skew_chord[j] = lane_clamp(1 - (along * y2 - across * y1) * scale, 0, most_skew);
    }
}

// The wind at the stations; its sum over them.
static bough_vec3 blow(const bough_rotor *rotor, double time, blade_rows *rows) {
    bough_vec3 sum = {0, 0, 0};
    int s = rotor->stride;
    for (int j = 0; j < rotor->n_station; j++) {
        bough_vec3 place = lane_load(rows->place, s, j);
        bough_vec3 wind = bough_wind_at(&rotor->wind, place, time);
        if (bough_tower_reaches(&rotor->tower, place)) {
            wind = bough_tower_disturbed(&rotor->tower, place, wind);
        }
        lane_store(rows->wind, s, j, wind);
        sum = bough_add(sum, wind);
    }
    for (int j = rotor->n_station; j < s; j++)
        lane_store(rows->wind, s, j, lane_load(rows->wind, s, j - 1));
    return sum;
}

// What the momentum balance asks of the stations.
static void meet_wind(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                      blade_rows *restrict to) {
    const blade_rows r = *to;
    bough_mat3 frame = motion->blade[blade].frame.rotation;
    bough_vec3 shaft = bough_mat3_tmul(frame, motion->shaft);
    const double *restrict chord = rotor->station.chord;
    double crowd = rotor->n_blade / (2 * BOUGH_PI);
    int s = rotor->stride;
#pragma omp simd
    for (int j = 0; j < s; j++) {
        bough_vec3 inflow = bough_sub(bough_mat3_tmul(frame, lane_load(r.wind, s, j)),
                                      lane_load(r.velocity, s, j));
        bough_vec3 y = lane_load(r.y, s, j), radial = bough_cross(shaft, y);
        double cone = bough_dot(radial, lane_load(r.z, s, j));
        double radius = r.radius[j] > 1e-3 ? r.radius[j] : 1e-3;
        r.inflow_x[j] = bough_dot(inflow, lane_load(r.x, s, j));
        r.inflow_y[j] = bough_dot(inflow, y);
        r.cone[j] = cone * cone;
        r.solidity[j] = crowd * chord[j] / radius;
    }
}

// What dynamic inflow leaves of the induction.
static void delay(const bough_rotor *rotor, double time, int blade, bough_rotor_data *data) {
    const blade_rows *r = data->scratch->blade + blade;
    const bough_inflow_clock *clock = data->memory.clock;
    for (int j = 0; j < rotor->n_station; j++) {
        if (rotor->station.free[j] == 0) continue;
        const double inflow[2] = {r->inflow_x[j], r->inflow_y[j]};
        bough_inflow_station *memory = data->memory.station + blade * rotor->n_station + j;
        bough_inflow_follow(clock, time - clock->time, inflow, &r->axial[j], &r->tangential[j],
                            memory);
    }
}

void bough_rotor_approach(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                          bough_rotor_data *data) {
    blade_rows *r = data->scratch->blade + blade;
    const station_rows *m = &rotor->station;
    move_stations(rotor, motion, blade, r);
    data->scratch->wind[blade] = blow(rotor, motion->time, r);
    meet_wind(rotor, motion, blade, r);
    bough_elements elements = {rotor->stride, m->polar, r->solidity, m->tip_factor, m->hub_factor,
                               r->cone,       r->twist, r->inflow_x, r->inflow_y,
                               r->skew_normal, r->skew_chord};
    bough_induction_solve_all(&rotor->induction, &elements, r->axial, r->tangential, r->loss);
    if (data->memory.station) delay(rotor, motion->time, blade, data);
}

// -- survey ---------------------------------------------------------------------------------------

// Below this tip-speed ratio the wake is too disturbed for momentum theory: no induction; from
// the second value on, full induction.
static const double wakeless_ratio = 1, full_wake_ratio = 2;

static double wake_strength(const bough_rotor *rotor, const bough_rotor_data *data, double axial) {
    double tip = 0;
    for (int b = 0; b < rotor->n_blade; b++)
        tip += data->scratch->blade[b].inflow_y[rotor->n_station - 1] / rotor->n_blade;
    if (fabs(tip) >= full_wake_ratio * fabs(axial)) return 1;
    double above = fabs(tip / axial) - wakeless_ratio;
    if (above <= 0) return 0;
    return (1 - cos(BOUGH_PI * above / (full_wake_ratio - wakeless_ratio))) / 2;
}

void bough_rotor_survey(const bough_rotor *rotor, const bough_rotor_motion *motion,
                        bough_rotor_data *data) {
    struct bough_rotor_scratch *scratch = data->scratch;
    bough_vec3 wind = {0, 0, 0};
    for (int b = 0; b < rotor->n_blade; b++) wind = bough_add(wind, scratch->wind[b]);
    wind = bough_scale(1. / (rotor->n_blade * rotor->n_station), wind);
    data->disk_wind = wind;
    double axial = bough_dot(wind, motion->shaft);
    bough_vec3 across = bough_axpy(-axial, motion->shaft, wind);
    double size = bough_norm(across);
    scratch->skew = atan2(size, axial);
    scratch->wake = wake_strength(rotor, data, axial);
    bool yawed = size > 1e-9 * fabs(axial);
    scratch->downwind = yawed ? bough_scale(1 / size, across) : bough_v3(0, 0, 0);
}

// -- load -----------------------------------------------------------------------------------------

// Pitt and Peters: the wake leans, and the half of the disk it leans over is induced more.
// D. M. Pitt, D. A. Peters, Vertica 5 (1981), with the wake angle χ = (1 + 0.6 a) χ₀; faded by
// the loss factor. `share` is the place on the radius, `leeward` the radial direction's part
// downwind.
static inline double skewed(double axial, double loss, double skew, double share, double leeward) {
    double angle = (1 + 0.6 * axial) * skew;
    sine_cosine k = lane_sine_cosine(angle < BOUGH_PI / 2 ? angle : BOUGH_PI / 2);
    double lean = loss * (k.sine / (1 + k.cosine)) * (share < 1 ? share : 1); // tan χ/2
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
        double leaning = skewed(r.axial[j], r.loss[j], skew, r.radius[j] / tip, leeward);
        double axial = free[j] > 0 ? wake * leaning : r.axial[j];
        double tangential = free[j] > 0 ? wake * r.tangential[j] : r.tangential[j];
        double u = r.inflow_x[j] * (1 - axial), v = r.inflow_y[j] * (1 + tangential);
        r.axial[j] = axial;
        r.tangential[j] = tangential;
        r.phi[j] = lane_angle(u, v);
        double seen = lane_angle(u + r.skew_normal[j] * v, (1 - r.skew_chord[j]) * v);
        r.alpha[j] = seen - r.twist[j];
        r.speed[j] = sqrt(u * u + v * v);
    }
}

// Lift, drag and moment coefficients: of the static polars, or what dynamic stall makes of them.
static void ask_polars(const bough_rotor *rotor, double time, int blade, bough_rotor_data *data) {
    const blade_rows *r = data->scratch->blade + blade;
    for (int j = 0; j < rotor->n_station; j++) {
        bough_coefficients k;
        if (data->memory.stall) {
            bough_stall_inflow inflow = {r->speed[j], r->alpha[j], r->turning[j]};
            k = bough_stall_advance(rotor->airfoil + j, rotor->station.chord[j], inflow,
                                    time - data->memory.clock->time,
                                    data->memory.stall + blade * rotor->n_station + j);
        } else {
            k = bough_polar_at(rotor->station.polar[j], r->alpha[j]);
        }
        r->lift[j] = k.lift;
        r->drag[j] = k.drag;
        r->moment[j] = k.moment;
    }
}

// Force and moment per length on the reference axis.
static void load_stations(const bough_rotor *rotor, const blade_rows *rows) {
    const blade_rows r = *rows;
    const double *restrict chord = rotor->station.chord;
    double density = rotor->density, pitching = rotor->pitching_moment ? 1 : 0;
    int s = rotor->stride;
#pragma omp simd
    for (int j = 0; j < s; j++) {
        double q = 0.5 * density * r.speed[j] * r.speed[j] * chord[j];
        sine_cosine k = lane_sine_cosine(lane_remainder(r.alpha[j]));
        double normal = q * (r.lift[j] * k.cosine + r.drag[j] * k.sine);
        double chordwise = q * (r.drag[j] * k.cosine - r.lift[j] * k.sine);
        bough_vec3 force = bough_axpy(chordwise, lane_load(r.chord, s, j),
                                      bough_scale(normal, lane_load(r.normal, s, j)));
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

// The line loads on the vertices.
static void spread(const bough_rotor *rotor, const double *restrict line, double *restrict load) {
    int n = rotor->n_vertex;
    for (int i = 0; i < n; i++) {
        vertex_row row = rotor->row[i];
        double sum[LOAD] = {0};
        for (int k = 0; k < row.count; k++) {
            const double *from = line + LOAD * (row.first + k);
            for (int c = 0; c < LOAD; c++) sum[c] += row.weight[k] * from[c];
        }
        for (int c = 0; c < 6; c++) load[c * n + i] = sum[c];
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
        bough_vec3 force = lane_load(load, n, i), arm = bough_sub(lane_load(vertex, n, i), hub);
        bough_vec3 about = bough_add(bough_cross(arm, force), lane_load(load + 3 * n, n, i));
        thrust += bough_dot(force, shaft);
        torque += bough_dot(about, shaft);
    }
    data->scratch->thrust[blade] = thrust;
    data->scratch->torque[blade] = torque;
}

void bough_rotor_load(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                      bough_rotor_data *data) {
    const blade_rows *r = data->scratch->blade + blade;
    induce(rotor, motion, blade, data->scratch);
    ask_polars(rotor, motion->time, blade, data);
    load_stations(rotor, r);
    spread(rotor, r->load, data->load + 6 * blade * rotor->n_vertex);
    sum_blade(rotor, motion, blade, data);
}

// -- the whole ------------------------------------------------------------------------------------

void bough_rotor_conclude(const bough_rotor *rotor, const bough_rotor_motion *motion,
                          bough_rotor_data *data) {
    data->thrust = data->torque = 0;
    for (int b = 0; b < rotor->n_blade; b++) {
        data->thrust += data->scratch->thrust[b];
        data->torque += data->scratch->torque[b];
    }
    if (data->memory.clock) bough_rotor_remember(rotor, motion, data);
}

void bough_rotor_sample(const bough_rotor *rotor, const bough_rotor_motion *motion,
                        bough_rotor_data *data) {
    for (int b = 0; b < rotor->n_blade; b++) bough_rotor_approach(rotor, motion, b, data);
    bough_rotor_survey(rotor, motion, data);
    for (int b = 0; b < rotor->n_blade; b++) bough_rotor_load(rotor, motion, b, data);
    bough_rotor_conclude(rotor, motion, data);
}

bough_station bough_rotor_station(const bough_rotor_data *data, int blade, int station) {
    const blade_rows *r = data->scratch->blade + blade;
    int j = station;
    return (bough_station){.radius = r->radius[j],
                           .inflow_x = r->inflow_x[j],
                           .inflow_y = r->inflow_y[j],
                           .axial = r->axial[j],
                           .tangential = r->tangential[j],
                           .alpha = r->alpha[j],
                           .phi = r->phi[j],
                           .twist = r->twist[j],
                           .speed = r->speed[j],
                           .coefficients = {r->lift[j], r->drag[j], r->moment[j]},
                           .force_x = r->force_x[j],
                           .force_y = r->force_y[j]};
}

bool bough_rotor_in_wind(const bough_rotor *rotor, bough_vec3 hub, double radius) {
    return bough_wind_covers(&rotor->wind, hub, radius);
}

bough_vec3 bough_rotor_tower_drag(const bough_rotor *rotor, bough_vec3 position, bough_vec3 axis,
                                  bough_vec3 velocity, double t) {
    bough_vec3 inflow = bough_sub(bough_wind_at(&rotor->wind, position, t), velocity);
    return bough_tower_drag(&rotor->tower, rotor->density, position, axis, inflow);
}

bough_vec3 bough_rotor_hub_drag(const bough_rotor *rotor, double area, bough_vec3 position,
                                bough_vec3 velocity, double t) {
    bough_vec3 inflow = bough_sub(bough_wind_at(&rotor->wind, position, t), velocity);
    return bough_scale(0.5 * rotor->density * area * bough_norm(inflow), inflow);
}
