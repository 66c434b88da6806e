// What is wrong with a def, before a tree is built from it.
#include "core/tree_internal.h"

#include <math.h>

static bool finite3(bough_vec3 v) { return isfinite(v.x) && isfinite(v.y) && isfinite(v.z); }

static bool is_rotation(bough_mat3 r) {
    bough_mat3 e = bough_mat3_product(bough_mat3_transpose(r), r);
    double off = fabs(e.c1.x - 1) + fabs(e.c2.y - 1) + fabs(e.c3.z - 1) + fabs(e.c1.y) +
                 fabs(e.c2.z) + fabs(e.c3.x);
    return off < 1e-9 && bough_dot(bough_cross(r.c1, r.c2), r.c3) > 0;
}

static bough_status check_placement(const char *what, const char *name, bough_transform x) {
    if (!finite3(x.position)) {
        return bough_fail(BOUGH_INVALID, "%s '%s': its position is not finite", what, name);
    }
    if (!is_rotation(x.rotation)) {
        return bough_fail(BOUGH_INVALID,
                          "%s '%s': its rotation is not a right-handed orthonormal "
                          "matrix",
                          what, name);
    }
    return bough_ok();
}

static bool has_direction(bough_vec3 axis) { return bough_norm(axis) > 0 && finite3(axis); }

static bough_status check_axes(const bough_body_def *b) {
    int n = bough_joint_n_axes(b->kind);
    if ((n > 0 && !has_direction(b->axis)) || (n > 1 && !has_direction(b->second_axis))) {
        return bough_fail(BOUGH_INVALID, "body '%s': the axis of its %s joint has no direction",
                          b->name, bough_joint_name(b->kind));
    }
    double cosine = bough_dot(b->axis, b->second_axis);
    if (n > 1 && fabs(cosine) > 1e-9 * bough_norm(b->axis) * bough_norm(b->second_axis)) {
        return bough_fail(BOUGH_INVALID,
                          "body '%s': the axes of its %s joint are not normal to each other",
                          b->name, bough_joint_name(b->kind));
    }
    return bough_ok();
}

// The joint's axes and initial values
static bough_status check_joint(const bough_body_def *b) {
    if (b->kind > BOUGH_JOINT_PLANAR) {
        return bough_fail(BOUGH_INVALID, "body '%s': unknown kind of joint", b->name);
    }
    bough_status status = check_axes(b);
    if (!bough_is_ok(&status)) return status;
    for (int k = 0; k < BOUGH_JOINT_COORDINATES; k++) {
        bool speed_ok = k >= BOUGH_JOINT_SPEEDS || isfinite(b->speeds[k]);
        if (!isfinite(b->coordinates[k]) || !speed_ok) {
            return bough_fail(BOUGH_INVALID, "body '%s': its initial state is not finite", b->name);
        }
    }
    return bough_ok();
}

static bough_status check_spring(const bough_body_def *b) {
    const bough_joint_spring *s = &b->spring;
    bool used = s->stiffness != 0 || s->damping != 0 || s->stop_stiffness != 0;
    if (used && bough_joint_n_speeds(b->kind) != 1) {
        return bough_fail(BOUGH_INVALID,
                          "body '%s': a spring acts on revolute and prismatic joints, not on a %s "
                          "one",
                          b->name, bough_joint_name(b->kind));
    }
    bool good = isfinite(s->stiffness) && isfinite(s->damping) && isfinite(s->rest) &&
                s->stiffness >= 0 && s->damping >= 0 && s->stop_stiffness >= 0;
    if (!good || (s->stop_stiffness > 0 && !(isfinite(s->high - s->low) && s->low < s->high))) {
        return bough_fail(BOUGH_INVALID,
                          "body '%s': its joint's stiffness and damping must not be negative, and "
                          "its stops in order",
                          b->name);
    }
    return bough_ok();
}

static bough_status check_motion(const bough_body_def *b) {
    bool two = b->kind == BOUGH_JOINT_UNIVERSAL || b->kind == BOUGH_JOINT_CYLINDRICAL;
    bool one = two || b->kind == BOUGH_JOINT_REVOLUTE || b->kind == BOUGH_JOINT_PRISMATIC;
    if ((!b->motion.given || one) && (!b->second_motion.given || two)) return bough_ok();
    return bough_fail(BOUGH_INVALID,
                      "body '%s': motion is prescribed of revolute, prismatic, cylindrical and "
                      "universal joints, not of a %s one",
                      b->name, bough_joint_name(b->kind));
}

static bough_status check_body(const bough_tree_def *def, int body) {
    const bough_body_def *b = &def->bodies[body];
    if (b->parent < BOUGH_GROUND || b->parent >= def->n_bodies) {
        return bough_fail(BOUGH_INVALID, "body '%s': its parent does not exist", b->name);
    }
    bool finite = isfinite(b->mass) && finite3(b->mass_centre) && finite3(b->inertia.c1) &&
                  finite3(b->inertia.c2) && finite3(b->inertia.c3);
    if (!finite || b->mass < 0) {
        return bough_fail(BOUGH_INVALID,
                          "body '%s': mass, mass centre and inertia must be finite "
                          "and the mass not negative",
                          b->name);
    }
    bough_status status = check_joint(b);
    if (bough_is_ok(&status)) status = check_spring(b);
    if (bough_is_ok(&status)) status = check_motion(b);
    return bough_is_ok(&status) ? check_placement("joint of body", b->name, b->joint) : status;
}

// Levels from 1, 0 where not known yet; false in a cycle. Every body is walked over once.
static bool find_level(const bough_tree_def *def, int body, int *level) {
    int steps = 0, top = body;
    for (; top >= 0 && level[top] == 0; top = def->bodies[top].parent) {
        if (++steps > def->n_bodies) return false;
    }
    int above = top < 0 ? 0 : level[top];
    for (int b = body; b != top; b = def->bodies[b].parent) level[b] = above + steps--;
    return true;
}

bough_status bough_tree_order(const bough_tree_def *def, int *scratch, int *order) {
    int n = def->n_bodies, *level = scratch, *first = scratch + n; // first (n + 1): of each level
    for (int b = 0; b < n; b++) {
        if (!find_level(def, b, level)) {
            return bough_fail(BOUGH_INVALID,
                              "body '%s': its chain of parents is a cycle and "
                              "never reaches the ground",
                              def->bodies[b].name);
        }
        first[level[b]]++;
    }
    for (int k = 1; k <= n; k++) first[k] += first[k - 1];
    for (int b = 0; b < n; b++) order[first[level[b] - 1]++] = b;
    return bough_ok();
}

static bool is_increasing(int n, const double *times) {
    for (int i = 1; i < n; i++) {
        if (!(times[i] > times[i - 1])) return false;
    }
    return true;
}

static bool has_marker(const bough_tree_def *def, int marker) {
    return marker >= 0 && marker < def->n_markers;
}

static bough_status check_forces(const bough_tree_def *def) {
    for (int k = 0; k < def->n_springs; k++) {
        const int *m = def->springs[k].marker;
        if (has_marker(def, m[0]) && has_marker(def, m[1])) continue;
        return bough_fail(BOUGH_INVALID, "spring %d: its marker does not exist", k);
    }
    for (int k = 0; k < def->n_bushings; k++) {
        const int *m = def->bushings[k].marker;
        if (has_marker(def, m[0]) && has_marker(def, m[1])) continue;
        return bough_fail(BOUGH_INVALID, "bushing %d: its marker does not exist", k);
    }
    for (int k = 0; k < def->n_applied; k++) {
        const bough_applied_def *a = &def->applied[k];
        if (has_marker(def, a->marker) && is_increasing(a->n, a->times)) continue;
        return bough_fail(BOUGH_INVALID, "applied wrench %d: it needs a marker, and times that "
                                         "increase", k);
    }
    return bough_ok();
}

static bough_status check_attachments(const bough_tree_def *def) {
    for (int m = 0; m < def->n_markers; m++) {
        const bough_marker_def *marker = &def->markers[m];
        if (marker->body < BOUGH_GROUND || marker->body >= def->n_bodies) {
            return bough_fail(BOUGH_INVALID, "marker '%s': its body does not exist", marker->name);
        }
        bough_status status = check_placement("marker", marker->name, marker->placement);
        if (!bough_is_ok(&status)) return status;
    }
    for (int p = 0; p < def->n_ports; p++) {
        if (def->ports[p].marker < 0 || def->ports[p].marker >= def->n_markers) {
            return bough_fail(BOUGH_INVALID, "port '%s': its marker does not exist",
                              def->ports[p].name);
        }
    }
    for (int e = 0; e < def->n_ends; e++) {
        int body = def->ends[e].body;
        bool known = body >= 0 && body < def->n_bodies;
        if (!known || def->bodies[body].kind != BOUGH_JOINT_FREE) {
            return bough_fail(BOUGH_INVALID, "end '%s': it needs a body on a free joint",
                              def->ends[e].name);
        }
    }
    for (int k = 0; k < def->n_loads; k++) {
        if (!is_increasing(def->loads[k].n, def->loads[k].times)) {
            return bough_fail(BOUGH_INVALID, "joint load %d: the times of its table must increase",
                              k);
        }
        int body = def->loads[k].body;
        bool known = body >= 0 && body < def->n_bodies;
        if (!known || bough_joint_n_speeds(def->bodies[body].kind) != 1) {
            return bough_fail(BOUGH_INVALID,
                              "joint load on '%s': it needs a body with a revolute "
                              "or prismatic joint",
                              known ? def->bodies[body].name : "?");
        }
    }
    return check_forces(def);
}

bough_status bough_tree_check(const bough_tree_def *def) {
    for (int b = 0; b < def->n_bodies; b++) {
        bough_status status = check_body(def, b);
        if (!bough_is_ok(&status)) return status;
    }
    return check_attachments(def);
}
