// Stations of a blade: position, wind, induction; the kinematics of theory (86).
#include "aero/rotor/rotor_model.h"

// The blade elements follow the polar formulation of the reference code (AeroDyn v5): y is
// tangential at the element's own place, x normal to the bent but unswept, unpitched, untwisted
// blade, and momentum is balanced over the element's projection on the rotor plane. Lift and drag
// act in the section's own plane, where the angle of attack is taken. Axes of the blade root
// instead gave 0.4 % less thrust on a blade bent by 3 m. Loss factors are those of the undeformed
// rotor; forces are per length of the reference axis.
//
// All vectors of a blade are in its frame's axes, stations side by side in vector lanes.

BOUGH_INLINE bough_quaternion section_at(const double *restrict vertex, int n, int i) {
    return bough_quaternion_unit(lane_load_quaternion(vertex + BOUGH_BLADE_ROTATION * n, n, i));
}

// The axes of a blade element at `arm` from the hub.
typedef struct element_axes {
    bough_vec3 x, y, z;
    double radius; // from the shaft
} element_axes;

// y against the rotation, normal to shaft and arm; z as the section's, without sweep. `aside`: any
// direction normal to the shaft, taken on it.
BOUGH_INLINE element_axes axes_at(bough_vec3 shaft, bough_vec3 aside, bough_vec3 arm, bough_vec3 along) {
    bough_vec3 out = bough_axpy(-bough_dot(arm, shaft), shaft, arm);
    double radius = bough_norm(out), off = radius < 1e-9 ? 0 : 1, scale = off / (radius + 1 - off);
    bough_vec3 radial = bough_axpy(1 - off, aside, bough_scale(scale, out));
    double s = lane_clamp(bough_dot(along, shaft), -1, 1), c = sqrt(1 - s * s);
    return (element_axes){bough_axpy(-s, radial, bough_scale(c, shaft)), bough_cross(radial, shaft),
                          bough_axpy(s, shaft, bough_scale(c, radial)), radius};
}

// Tangent of the angle between a section's normal and the element's plane; more only beside the shaft or
// folded.
static const double most_skew = 0.2;

static bough_vec3 any_normal(bough_vec3 v) {
    bough_vec3 n = bough_cross(v, fabs(v.x) < 0.5 ? bough_v3(1, 0, 0) : bough_v3(0, 1, 0));
    return bough_scale(1 / bough_norm(n), n);
}

// Rotations of the vertices by deformation, and their second differences along the blade; at the ends those
// of the neighbours.
static void rotate_vertices(const bough_rotor *rotor, const double *restrict vertex,
                            blade_rows *restrict to) {
    int n = rotor->n_vertex;
    double *restrict rotation = to->rotation, *restrict bend = to->bend;
    const bough_quaternion *restrict undeformed = rotor->undeformed;
#pragma omp simd
    for (int i = 0; i < n; i++) {
        bough_quaternion d =
            bough_quaternion_product(section_at(vertex, n, i), bough_quaternion_conjugate(undeformed[i]));
        lane_store(rotation, n, i, bough_scale(copysign(2.0, d.w), bough_v3(d.x, d.y, d.z)));
    }
#pragma omp simd
    for (int i = 1; i < n - 1; i++) {
        bough_vec3 sum = bough_add(lane_load(rotation, n, i - 1), lane_load(rotation, n, i + 1));
        lane_store(bend, n, i, bough_axpy(-2, lane_load(rotation, n, i), sum));
    }
    for (int i = 0; i < n; i += n - 1) {
        bough_vec3 second = {0, 0, 0};
        if (n > 2) second = lane_load(bend, n, i == 0 ? 1 : n - 2);
        lane_store(bend, n, i, second);
    }
}

// R rotated by the small rotation phi.
BOUGH_INLINE bough_mat3 rotated_by(bough_vec3 phi, bough_mat3 r) {
    return (bough_mat3){bough_add(r.c1, bough_cross(phi, r.c1)), bough_add(r.c2, bough_cross(phi, r.c2)),
                        bough_add(r.c3, bough_cross(phi, r.c3))};
}

// Positions, axes and velocities of the stations of a blade.
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
    rotate_vertices(rotor, vertex, to);
    const double *restrict bend = to->bend;
#pragma omp simd
    for (int j = 0; j < s; j++) {
        int a = m.vertex[j], b = a + 1;
        double w = m.weight[j];
        bough_quaternion p = section_at(vertex, n, a), q = section_at(vertex, n, b);
        bough_vec3 second = bough_add(lane_load(bend, n, a), lane_load(bend, n, b));
        bough_vec3 beside = bough_scale(-0.25 * w * (1 - w), second);
        // structural section at the station: between two vertices, with the second difference
        bough_mat3 structure = rotated_by(beside, rotation_between(p, q, w));
        bough_mat3 section = bough_mat3_product(structure, lane_load_matrix(m.section, s, j));
        bough_vec3 arm = bough_mat3_mul(structure, lane_load(m.centre, s, j));
        bough_vec3 axis = bough_between(lane_load(vertex, n, a), lane_load(vertex, n, b), w);
        // aerodynamic centre on the bent axis
        bough_vec3 ends = bough_sub(bough_rotation_matrix(q).c3, bough_rotation_matrix(p).c3);
        ends = bough_sub(ends, bough_mat3_mul(structure, lane_load(m.ends, s, j)));
        bough_vec3 bow = bough_scale(m.bow[j], ends); // of the axis from the chord, by bending
        axis = bough_add(axis, bow);
        bough_vec3 centre = bough_add(axis, arm);
        element_axes e = axes_at(shaft, aside, bough_sub(centre, hub), section.c3);
        // velocity of the centre
        bough_vec3 spinning =
            bough_between(bough_mat3_mul(bough_rotation_matrix(p), lane_load(spin, n, a)),
                          bough_mat3_mul(bough_rotation_matrix(q), lane_load(spin, n, b)), w);
        bough_vec3 moving = bough_between(lane_load(velocity, n, a), lane_load(velocity, n, b), w);
        lane_store(r.arm, s, j, arm);
        lane_store(r.x, s, j, e.x);
        lane_store(r.y, s, j, e.y);
        lane_store(r.z, s, j, e.z);
        lane_store(r.velocity, s, j, bough_add(moving, bough_cross(spinning, bough_add(arm, bow))));
        bough_vec3 place = bough_add(frame.position, bough_mat3_mul(frame.rotation, centre));
        lane_store(r.place, s, j, place);
        r.radius[j] = e.radius;
        r.pitch_rate[j] =
            bough_dot(spinning, bough_cross(shaft, e.y)); // about the radius, normal to the shaft
        // the section in the element's axes
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
    for (int j = rotor->n_station; j < s; j++) lane_store(rows->wind, s, j, lane_load(rows->wind, s, j - 1));
    return sum;
}

// The sum of the stations' velocities, in ground axes.
static bough_vec3 sum_velocity(const bough_rotor *rotor, const bough_mat3 frame, const blade_rows *rows) {
    bough_vec3 sum = {0, 0, 0};
    for (int j = 0; j < rotor->n_station; j++)
        sum = bough_add(sum, lane_load(rows->velocity, rotor->stride, j));
    return bough_mat3_mul(frame, sum);
}

// Inputs of the momentum balance: inflow, solidity, cone.
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
        bough_vec3 inflow =
            bough_sub(bough_mat3_tmul(frame, lane_load(r.wind, s, j)), lane_load(r.velocity, s, j));
        bough_vec3 y = lane_load(r.y, s, j), radial = bough_cross(shaft, y);
        double cone = bough_dot(radial, lane_load(r.z, s, j));
        double radius = r.radius[j] > 1e-3 ? r.radius[j] : 1e-3;
        r.inflow_x[j] = bough_dot(inflow, lane_load(r.x, s, j));
        r.inflow_y[j] = bough_dot(inflow, y);
        r.cone[j] = cone * cone;
        r.solidity[j] = crowd * chord[j] / radius;
    }
}

// theory (85) in place of the induction in equilibrium.
static void delay(const bough_rotor *rotor, double time, int blade, bough_rotor_data *data) {
    const blade_rows *r = data->scratch->blade + blade;
    const bough_inflow_clock *clock = data->memory.clock;
    for (int j = 0; j < rotor->n_station; j++) {
        if (rotor->station.free[j] == 0) continue;
        const double inflow[2] = {r->inflow_x[j], r->inflow_y[j]};
        bough_inflow_station *memory = data->memory.station + blade * rotor->n_station + j;
        bough_inflow_follow(clock, time - clock->time, inflow, &r->axial[j], &r->tangential[j], memory);
    }
}

void BOUGH_AT_LEVEL(bough_rotor_approach)(const bough_rotor *rotor, const bough_rotor_motion *motion,
                                          int blade, bough_rotor_data *data) {
    blade_rows *r = data->scratch->blade + blade;
    move_stations(rotor, motion, blade, r);
    data->scratch->wind[blade] = blow(rotor, motion->time, r);
    data->scratch->velocity[blade] = sum_velocity(rotor, motion->blade[blade].frame.rotation, r);
    meet_wind(rotor, motion, blade, r);
}

// The angle of the shaft and the undisturbed wind relative to the hub.
static double skew_of(const bough_rotor *rotor, const bough_rotor_motion *motion) {
    bough_vec3 wind = bough_wind_at(&rotor->wind, motion->hub, motion->time);
    wind = bough_sub(wind, motion->hub_velocity);
    double axial = bough_dot(wind, motion->shaft);
    return atan2(bough_norm(bough_axpy(-axial, motion->shaft, wind)), fabs(axial));
}

void BOUGH_AT_LEVEL(bough_rotor_induce)(const bough_rotor *rotor, const bough_rotor_motion *motion, int blade,
                                        bough_rotor_data *data) {
    const blade_rows *r = data->scratch->blade + blade;
    const station_rows *m = &rotor->station;
    size_t size = (size_t)rotor->stride * sizeof(double);
    bough_elements elements = {rotor->stride, m->polar,       r->solidity,   m->tip_factor,
                               m->hub_factor, r->cone,        r->twist,      r->inflow_x,
                               r->inflow_y,   r->skew_normal, r->skew_chord, skew_of(rotor, motion)};
    if (!data->same_motion) {
        BOUGH_AT_LEVEL(bough_induction_solve)
        (&rotor->induction, &elements, r->balanced_axial, r->balanced_tangential, r->loss);
    }
    memcpy(r->axial, r->balanced_axial, size);
    memcpy(r->tangential, r->balanced_tangential, size);
    if (data->memory.station) delay(rotor, motion->time, blade, data);
}
