// Joints: how a body moves relative to its parent. The body frame coincides with the joint frame where
// all coordinates are zero (quaternion: one); speeds are components of the relative twist in body
// axes, so that every motion subspace S is constant there.
//
// kind       coordinates q                       speeds v
// fixed      –                                   –
// revolute   angle [rad]                         q̇ [rad/s]
// prismatic  displacement [m]                    q̇ [m/s]
// spherical  quaternion (w, x, y, z)             Ω in body axes [rad/s]
// free       position in joint axes [m], quat.   velocity, Ω, both in body axes [m/s, rad/s]
// cylindric. displacement [m], angle [rad]       q̇ [m/s, rad/s]
// universal  angle about the axis, then about    q̇ [rad/s]
//            the second axis, which rotates with it [rad]
// planar     displacements along the second axis velocity along both in body axes [m/s],
//            and axis × second [m], angle [rad]  q̇ of the angle [rad/s]
//
// A universal joint's S is not constant: the tree replaces it by two revolute joints, and of the
// functions below only the first four accept it.
#pragma once

#include "core/base/spatial.h"

typedef enum bough_joint_kind {
    BOUGH_JOINT_FIXED,
    BOUGH_JOINT_REVOLUTE,
    BOUGH_JOINT_PRISMATIC,
    BOUGH_JOINT_SPHERICAL,
    BOUGH_JOINT_FREE,
    BOUGH_JOINT_CYLINDRICAL,
    BOUGH_JOINT_UNIVERSAL,
    BOUGH_JOINT_PLANAR, // the last
} bough_joint_kind;

enum { BOUGH_JOINT_COORDINATES = 7, BOUGH_JOINT_SPEEDS = 6 }; // the most any joint has

typedef struct bough_joint {
    bough_joint_kind kind;
    bough_transform placement; // of the joint frame in the parent's frame
    bough_vec3 axis;           // unit vector in joint axes, of those that have one
    bough_vec3 second;         // unit vector normal to it in joint axes; planar
} bough_joint;

// Forces along the axis of a revolute or prismatic joint: a linear spring and damper, and stops at both ends
// of its range, elastic and without friction.
typedef struct bough_joint_spring {
    double stiffness;      // [N m/rad] or [N/m]
    double damping;        // [N m s/rad] or [N s/m]
    double rest;           // coordinate without force [rad, m]
    double low, high;      // where the stops begin [rad, m]
    double stop_stiffness; // [N m/rad] or [N/m]; 0: no stops
} bough_joint_spring;

// The generalised force at coordinate q and speed v, and the energy stored [J].
double bough_joint_spring_force(const bough_joint_spring *spring, double q, double v, double *energy);

// −∂force/∂q
double bough_joint_spring_stiffness(const bough_joint_spring *spring, double q);

// The kind's name in scenes ("revolute"), and its numbers of coordinates, of speeds, and of axes that define
// it (axis, second axis).
const char *bough_joint_name(bough_joint_kind kind);
int bough_joint_n_coordinates(bough_joint_kind kind);
int bough_joint_n_speeds(bough_joint_kind kind);
int bough_joint_n_axes(bough_joint_kind kind);
int bough_joint_n_slides(bough_joint_kind kind); // how many of its coordinates, the first ones, are lengths

// The placement of the body frame in the parent's frame. A quaternion is used as q/|q|.
bough_transform bough_joint_pose(const bough_joint *joint, const double *q);

// S v: the relative twist in body axes.
bough_twist bough_joint_twist(const bough_joint *joint, const double *v);

// Column k of S.
static inline bough_twist bough_joint_column(const bough_joint *joint, int k) {
    double e[BOUGH_JOINT_SPEEDS] = {0};
    e[k] = 1;
    return bough_joint_twist(joint, e);
}

// Sᵀ f: the generalised force (n_speeds) of a wrench in body axes at the body's origin.
void bough_joint_force(const bough_joint *joint, bough_wrench f, double *force);

// q̇ = N(q) v. It keeps |p| of any quaternion.
void bough_joint_rate(const bough_joint *joint, const double *q, const double *v, double *rate);

// N⁺(q) δq: the speeds (n_speeds) that belong to a change of the coordinates; a quaternion's change
// along itself is no motion.
void bough_joint_speed(const bough_joint *joint, const double *q, const double *change, double *v);

// The change δq of the coordinates that solves c δq − δ(N(q) v) = r, where q and v change: r
// (n_coordinates), the change of v (n_speeds).
void bough_joint_change(const bough_joint *joint, const double *q, const double *v, double c, const double *r,
                        const double *speed_change, double *change);

// Scales the quaternion, if there is one, to |p| = 1 within 1e-15. Doing it again changes no bit.
void bough_joint_normalise(const bough_joint *joint, double *q);

// | |p| − 1 |; 0 without a quaternion.
double bough_joint_drift(const bough_joint *joint, const double *q);
