// The kinds of joints: S and N of theory (39, 45). Speeds are components in body axes.
#include "core/tree/joint.h"

#include "core/base/rotation.h"

// A joint slides along no, one, two or all axes, and then rotates.
typedef enum spin { NO_SPIN, ABOUT_AXIS, ALL_WAYS } spin;

static const struct {
    const char *name;
    int coordinates, speeds, axes;
    int slides; // the first coordinates and speeds
    spin spin;
} kinds[] = {
    [BOUGH_JOINT_FIXED] = {"fixed", 0, 0, 0, 0, NO_SPIN},
    [BOUGH_JOINT_REVOLUTE] = {"revolute", 1, 1, 1, 0, ABOUT_AXIS},
    [BOUGH_JOINT_PRISMATIC] = {"prismatic", 1, 1, 1, 1, NO_SPIN},
    [BOUGH_JOINT_SPHERICAL] = {"spherical", 4, 3, 0, 0, ALL_WAYS},
    [BOUGH_JOINT_FREE] = {"free", 7, 6, 0, 3, ALL_WAYS},
    [BOUGH_JOINT_CYLINDRICAL] = {"cylindrical", 2, 2, 1, 1, ABOUT_AXIS},
    [BOUGH_JOINT_UNIVERSAL] = {"universal", 2, 2, 2, 0, NO_SPIN}, // two revolute joints of the tree
    [BOUGH_JOINT_PLANAR] = {"planar", 3, 3, 2, 2, ABOUT_AXIS},
};

static int slides_of(const bough_joint *joint) { return kinds[joint->kind].slides; }

static spin spin_of(const bough_joint *joint) { return kinds[joint->kind].spin; }

const char *bough_joint_name(bough_joint_kind kind) { return kinds[kind].name; }

int bough_joint_n_coordinates(bough_joint_kind kind) { return kinds[kind].coordinates; }

int bough_joint_n_speeds(bough_joint_kind kind) { return kinds[kind].speeds; }

int bough_joint_n_axes(bough_joint_kind kind) { return kinds[kind].axes; }

int bough_joint_n_slides(bough_joint_kind kind) { return kinds[kind].slides; }

// Where the coordinates hold the quaternion; -1 without one.
static int quaternion_row(const bough_joint *joint) {
    return spin_of(joint) == ALL_WAYS ? slides_of(joint) : -1;
}

static bough_quaternion load(const double *p) { return (bough_quaternion){p[0], p[1], p[2], p[3]}; }

static bough_mat3 rotation_at(const double *p) {
    return bough_rotation_matrix(bough_quaternion_normalised(load(p)));
}

// The displacement or velocity by the slides' coordinates or speeds x: along the axis; of two slides along
// the second axis and axis × second.
static bough_vec3 slide(const bough_joint *joint, const double *x) {
    switch (slides_of(joint)) {
    case 1: return bough_scale(x[0], joint->axis);
    case 2:
        return bough_axpy(x[0], joint->second, bough_scale(x[1], bough_cross(joint->axis, joint->second)));
    case 3: return bough_v3_load(x);
    default: return bough_v3(0, 0, 0);
    }
}

bough_transform bough_joint_pose(const bough_joint *joint, const double *q) {
    bough_transform moved = {slide(joint, q), bough_mat3_identity()};
    q += slides_of(joint);
    if (spin_of(joint) == ABOUT_AXIS) moved.rotation = bough_rotation_about(joint->axis, q[0]);
    if (spin_of(joint) == ALL_WAYS) moved.rotation = rotation_at(q);
    return bough_transform_compose(joint->placement, moved);
}

bough_twist bough_joint_twist(const bough_joint *joint, const double *v) {
    bough_twist t = {slide(joint, v), {0, 0, 0}};
    v += slides_of(joint);
    if (spin_of(joint) == ABOUT_AXIS) t.angular = bough_scale(v[0], joint->axis);
    if (spin_of(joint) == ALL_WAYS) t.angular = bough_v3_load(v);
    return t;
}

// Sᵀ f, component by component.
void bough_joint_force(const bough_joint *joint, bough_wrench f, double *force) {
    switch (slides_of(joint)) {
    case 1: force[0] = bough_dot(joint->axis, f.force); break;
    case 2:
        force[0] = bough_dot(joint->second, f.force);
        force[1] = bough_dot(bough_cross(joint->axis, joint->second), f.force);
        break;
    case 3: bough_v3_store(f.force, force); break;
    default: break;
    }
    force += slides_of(joint);
    if (spin_of(joint) == ABOUT_AXIS) force[0] = bough_dot(joint->axis, f.moment);
    if (spin_of(joint) == ALL_WAYS) bough_v3_store(f.moment, force);
}

// ṗ = ½ p∘(0,Ω), with p as it stands: |p| keeps its value exactly and only p/|p| is used.
static void quaternion_rate(const double *p, const double *omega, double *rate) {
    bough_quaternion w = {0, omega[0], omega[1], omega[2]};
    bough_quaternion r = bough_quaternion_product(load(p), w);
    rate[0] = 0.5 * r.w, rate[1] = 0.5 * r.x, rate[2] = 0.5 * r.y, rate[3] = 0.5 * r.z;
}

// Ω = 2 vec(p̄∘δp)/|p|²
static void quaternion_speed(const double *p, const double *change, double *omega) {
    bough_quaternion c = bough_quaternion_product(bough_quaternion_conjugate(load(p)), load(change));
    double square = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3];
    bough_v3_store(bough_scale(2 / square, bough_v3(c.x, c.y, c.z)), omega);
}

// Rotates (x, y) by an angle.
static void rotate_plane(double angle, const double *x, double *rotated) {
    double c = cos(angle), s = sin(angle);
    rotated[0] = c * x[0] - s * x[1];
    rotated[1] = s * x[0] + c * x[1];
}

// Slides, then the rotation.
void bough_joint_rate(const bough_joint *joint, const double *q, const double *v, double *rate) {
    int n = slides_of(joint);
    if (n == 1) rate[0] = v[0];
    if (n == 2) rotate_plane(q[2], v, rate);
    if (n == 3) bough_v3_store(bough_mat3_mul(rotation_at(q + 3), bough_v3_load(v)), rate);
    if (spin_of(joint) == ABOUT_AXIS) rate[n] = v[n];
    if (spin_of(joint) == ALL_WAYS) quaternion_rate(q + n, v + n, rate + n);
}

void bough_joint_speed(const bough_joint *joint, const double *q, const double *change, double *v) {
    int n = slides_of(joint);
    if (n == 1) v[0] = change[0];
    if (n == 2) rotate_plane(-q[2], change, v);
    if (n == 3) bough_v3_store(bough_mat3_tmul(rotation_at(q + 3), bough_v3_load(change)), v);
    if (spin_of(joint) == ABOUT_AXIS) v[n] = change[n];
    if (spin_of(joint) == ALL_WAYS) quaternion_speed(q + n, change + n, v + n);
}

// δp∘(c − ½Ω) = r + ½ p∘δΩ
static void quaternion_change(const double *p, const double *omega, double c, const double *r,
                              const double *omega_change, double *change) {
    double rate[4], square = 0;
    quaternion_rate(p, omega_change, rate);
    for (int k = 0; k < 3; k++) square += omega[k] * omega[k];
    // multiply by the inverse of c − ½Ω
    double f = 1 / (c * c + 0.25 * square);
    bough_quaternion side = {r[0] + rate[0], r[1] + rate[1], r[2] + rate[2], r[3] + rate[3]};
    bough_quaternion inverse = {f * c, 0.5 * f * omega[0], 0.5 * f * omega[1], 0.5 * f * omega[2]};
    bough_quaternion d = bough_quaternion_product(side, inverse);
    change[0] = d.w, change[1] = d.x, change[2] = d.y, change[3] = d.z;
}

// c δx − δ(R v) = r with δ(R v) = R (δv + δη × v), δη from the change of the quaternion.
static void free_change(const double *q, const double *v, double c, const double *r,
                        const double *speed_change, const double *quaternion, double *change) {
    double eta[3];
    quaternion_speed(q + 3, quaternion, eta);
    bough_vec3 own =
        bough_add(bough_v3_load(speed_change), bough_cross(bough_v3_load(eta), bough_v3_load(v)));
    bough_vec3 sum = bough_add(bough_v3_load(r), bough_mat3_mul(rotation_at(q + 3), own));
    bough_v3_store(bough_scale(1 / c, sum), change);
}

// The same in the plane, where δη × v is the angle's change times v rotated by a right angle.
static void planar_change(const double *q, const double *v, double c, const double *r,
                          const double *speed_change, double angle, double *change) {
    const double own[2] = {speed_change[0] - angle * v[1], speed_change[1] + angle * v[0]};
    rotate_plane(q[2], own, change);
    for (int k = 0; k < 2; k++) change[k] = (r[k] + change[k]) / c;
}

void bough_joint_change(const bough_joint *joint, const double *q, const double *v, double c, const double *r,
                        const double *speed_change, double *change) {
    int n = slides_of(joint);
    // rotations first: displacements in rotated axes depend on their change
    if (spin_of(joint) == ABOUT_AXIS) change[n] = (r[n] + speed_change[n]) / c;
    if (spin_of(joint) == ALL_WAYS) {
        quaternion_change(q + n, v + n, c, r + n, speed_change + n, change + n);
    }
    if (n == 1) change[0] = (r[0] + speed_change[0]) / c;
    if (n == 2) planar_change(q, v, c, r, speed_change, change[2], change);
    if (n == 3) free_change(q, v, c, r, speed_change, change + 3, change);
}

void bough_joint_normalise(const bough_joint *joint, double *q) {
    int row = quaternion_row(joint);
    // A length that is one to rounding stays: normalising twice gives the same bits as once.
    if (row < 0 || bough_joint_drift(joint, q) < 1e-15) return;
    bough_quaternion p = bough_quaternion_normalised(load(q + row));
    q[row] = p.w, q[row + 1] = p.x, q[row + 2] = p.y, q[row + 3] = p.z;
}

double bough_joint_drift(const bough_joint *joint, const double *q) {
    int row = quaternion_row(joint);
    if (row < 0) return 0;
    bough_quaternion p = load(q + row);
    return fabs(sqrt(p.w * p.w + p.x * p.x + p.y * p.y + p.z * p.z) - 1);
}

// A stop pressed by a depth p: its stiffness grows from 0 to k over w, so that the force's derivative
// is continuous and an integrator of variable order passes it. Force and energy.
static double stop_force(double k, double w, double p, double *energy) {
    if (p <= 0) return 0;
    if (p < w) {
        *energy += k * p * p * p / (6 * w);
        return 0.5 * k * p * p / w;
    }
    *energy += 0.5 * k * (p * p - w * p + w * w / 3);
    return k * (p - 0.5 * w);
}

double bough_joint_spring_force(const bough_joint_spring *spring, double q, double v, double *energy) {
    double stretch = q - spring->rest, k = spring->stop_stiffness;
    double force = -spring->stiffness * stretch - spring->damping * v;
    *energy = 0.5 * spring->stiffness * stretch * stretch;
    if (k == 0) return force;
    // stops, whose stiffness grows over a hundredth of the range
    double width = 0.01 * (spring->high - spring->low);
    force += stop_force(k, width, spring->low - q, energy);
    return force - stop_force(k, width, q - spring->high, energy);
}

static double stop_slope(double k, double w, double p) { return p <= 0 ? 0 : p < w ? k * p / w : k; }

double bough_joint_spring_stiffness(const bough_joint_spring *spring, double q) {
    double k = spring->stop_stiffness, width = 0.01 * (spring->high - spring->low);
    if (k == 0) return spring->stiffness;
    return spring->stiffness + stop_slope(k, width, spring->low - q) + stop_slope(k, width, q - spring->high);
}
