// The built rotor, and the rows of a sample; for rotor*.c only.
#pragma once

#include "aero/rotor/rotor.h"
#include "core/base/lanes.h"
#include "core/base/level.h"
#include "core/base/rotation.h"

BOUGH_DECLARE_LEVELS(bough_rotor_approach);
BOUGH_DECLARE_LEVELS(bough_rotor_induce);
BOUGH_DECLARE_LEVELS(bough_rotor_load);

// Stations of one blade, padded to `stride` by copies of the last; a 3×3 matrix by its columns.
typedef struct station_rows {
    const bough_polar **polar; // (stride)
    int *vertex;               // (stride) the station lies between this vertex and the next
    double *weight;            // (stride) of the next
    double *section;           // (9 × stride) aero section axes in the interpolated structural section
    double *centre;            // (3 × stride) aerodynamic centre there, from the reference axis [m]
    double *ends; // (3 × stride) change of the undeformed tangent between the two vertices, there
    double *bow;  // (stride) of an arc beside its chord by that change [m]
    double *chord, *tip_factor, *hub_factor; // (stride)
    double *free; // (stride) 0: at the very tip or root, where the loss factor sets the induction
} station_rows;

// Row i of the mapping: vertex i takes Σ_k weight[k] · line load of station first + k.
typedef struct vertex_row {
    int first, count;
    const double *weight; // (count) [m]
} vertex_row;

struct bough_rotor {
    bough_level level; // of the kernels
    int n_blade, n_station, n_vertex, stride;
    double density;
    bool pitching_moment, skew, slopes, stalls; // stalls: dynamically
    bough_induction_options induction;
    bough_inflow_def inflow;
    bough_wind wind;
    bough_tower tower;
    station_rows station;
    const bough_quaternion *undeformed; // section axes of the vertices (n_vertex)
    vertex_row *row;                    // (n_vertex)
    vertex_row *mean, *slope;           // (n_vertex − 1) over a segment, weights [-], [1/m]
};

enum { LOAD = 8 };   // force, moment per length and two zeros: one vector
enum { SLOPE = 16 }; // BOUGH_SLOPES and four zeros: whole vectors

enum { RESULTS = 17 }; // rows of a blade's results

// Of one blade, in its frame's axes; y is tangential, x normal, z along the blade.
typedef struct blade_rows {
    double *arm;             // (3 × stride) from the reference axis to the centre [m]
    double *x, *y, *z;       // (3 × stride) axes of the blade element
    double *velocity, *wind; // (3 × stride) of the aerodynamic centre and there [m/s]
    double *pitch_rate;      // (stride) rotation nose up [rad/s]
    double *normal, *chord;  // (3 × stride) axes of the section, leading to trailing edge
    double *solidity, *cone, *skew_normal, *skew_chord; // (stride) of the momentum balance
    double *loss;                                       // (stride)
    double *balanced_axial, *balanced_tangential;       // (stride) induction in balance
    double *lift_slope, *drag_slope, *moment_slope;     // (stride) by the angle [1/rad]
    double *lift_rate, *drag_rate, *moment_rate;        // (stride) by the rotation nose up [s/rad]
    double *static_slope;                               // (stride) of the static lift [1/rad]
    double *load;                                       // (stride × LOAD) [N/m], [N]
    double *slope;    // (stride × SLOPE) bough_rotor_data.slope, per length
    double *rotation; // (3 × n_vertex) rotation by deformation, of vertices
    double *bend;     // (3 × n_vertex) its second difference
    // what a sample reports, one row after the other in `results` (RESULTS × stride), in this order
    double *results;
    double *place;                // (3 × stride) the centre, in ground axes [m]
    double *radius, *twist;       // (stride) [m], [rad]
    double *inflow_x, *inflow_y;  // (stride) without induction [m/s]
    double *axial, *tangential;   // (stride)
    double *phi, *alpha, *speed;  // (stride) [rad], [rad], [m/s]
    double *lift, *drag, *moment; // (stride) coefficients
    double *force_x, *force_y;    // (stride) [N/m]
} blade_rows;

struct bough_rotor_scratch {
    blade_rows *blade;       // (n_blade)
    bough_vec3 *wind;        // (n_blade) sum over the stations, in ground axes [m/s]
    bough_vec3 *velocity;    // (n_blade) the same of the stations' own motion
    double *thrust, *torque; // (n_blade)
    // of the whole rotor, for each station
    double skew;         // acute angle of the wind and the shaft [rad]
    bough_vec3 downwind; // unit vector of the wind's component in the rotor plane, 0 if none
    double wake;         // 0: too slow for momentum theory, 1: full induction
};

// The rotation between p and q at a fraction of the way. Within the few degrees between neighbouring vertices
// the normalised chord is as good as the arc, and like it independent of the frame.
BOUGH_INLINE bough_mat3 rotation_between(bough_quaternion p, bough_quaternion q, double weight) {
    double side = p.w * q.w + p.x * q.x + p.y * q.y + p.z * q.z;
    double wp = 1 - weight, wq = side < 0 ? -weight : weight;
    bough_quaternion sum = {wp * p.w + wq * q.w, wp * p.x + wq * q.x, wp * p.y + wq * q.y,
                            wp * p.z + wq * q.z};
    return bough_rotation_matrix(bough_quaternion_unit(sum));
}
