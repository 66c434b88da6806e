#include "aero/rotor/tower.h"

#include "core/base/base.h"
#include "core/base/schedule.h"

#include <assert.h>

// Closer than this to the axis, in radii, the flow is taken at this distance: the potential has a
// pole inside the cylinder, where only an ill-posed scene puts a blade.
static const double nearest = 1;

// Largest velocity deficit of the wake relative to the wind.
static const double deepest_shadow = 0.5;

void bough_tower_build(bough_arena *arena, const bough_tower_def *def, bough_tower *tower) {
    size_t size = (size_t)def->n * sizeof(double);
    *tower = *def;
    if (def->n == 0) return;
    assert(def->n >= 2);
    tower->height = bough_arena_copy(arena, def->height, size);
    tower->diameter = bough_arena_copy(arena, def->diameter, size);
    if (def->drag) tower->drag = bough_arena_copy(arena, def->drag, size);
}

// The radius at a height above the base, 0 where there is no tower. Above the top it fades over
// one radius, as in the reference code.
static double radius_at(const bough_tower *tower, double height) {
    int n = tower->n;
    if (n == 0 || height < tower->height[0]) return 0;
    double top = tower->diameter[n - 1] / 2, above = height - tower->height[n - 1];
    if (above >= top) return 0;
    if (above > 0) return top * cos(BOUGH_PI / 2 * above / top);
    return bough_table_value(n, tower->height, tower->diameter, height) / 2;
}

static double drag_at(const bough_tower *tower, double height) {
    return tower->drag ? bough_table_value(tower->n, tower->height, tower->drag, height) : 1;
}

// A horizontal wind relative to the undisturbed one, along and across it.
typedef struct flow {
    double along, across;
} flow;

// theory (87) about a cylinder of radius 1, at a position in radii from the axis; x > 0: behind.
static flow potential(double x, double y, double r2) {
    return (flow){1 + (y * y - x * x) / (r2 * r2), -2 * x * y / (r2 * r2)};
}

static flow bak(double drag, double x, double y) {
    double xs = x + 0.1, r2 = xs * xs + y * y, source = drag / (2 * BOUGH_PI * r2);
    flow f = potential(xs, y, r2);
    return (flow){f.along + source * xs, f.across + source * y};
}

// Velocity deficit of the wake.
static double shadow(double drag, double x, double y) {
    double width = sqrt(hypot(x, y));
    if (x <= 0 || fabs(y) >= width) return 0;
    double c = cos(BOUGH_PI / 2 * y / width);
    return fmin(drag / width * c * c, deepest_shadow);
}

double bough_tower_distance(const bough_tower *tower, bough_vec3 position) {
    bough_vec3 d = bough_sub(position, tower->base);
    double radius = radius_at(tower, d.z);
    return radius > 0 ? hypot(d.x, d.y) / radius : HUGE_VAL;
}

bough_vec3 bough_tower_disturbed(const bough_tower *tower, bough_vec3 position, bough_vec3 wind) {
    bough_vec3 d = bough_sub(position, tower->base);
    double radius = radius_at(tower, d.z);
    if (radius == 0) return wind;
    double speed = sqrt(wind.x * wind.x + wind.y * wind.y);
    if (speed == 0) return wind;
    double cx = wind.x / speed, cy = wind.y / speed;
    double x = (cx * d.x + cy * d.y) / radius, y = (cx * d.y - cy * d.x) / radius;
    double r2 = x * x + y * y;
    if (r2 == 0) return bough_v3(0, 0, wind.z);
    double scale = r2 < nearest * nearest ? nearest / sqrt(r2) : 1;
    x *= scale;
    y *= scale;
    r2 *= scale * scale;
    flow f = potential(x, y, r2);
    if (tower->influence == BOUGH_TOWER_BAK) f = bak(drag_at(tower, d.z), x, y);
    if (tower->shadow == BOUGH_TOWER_SHADOW_POWLES) f.along -= shadow(drag_at(tower, d.z), x, y);
    double along = speed * f.along, across = speed * f.across;
    return bough_v3(cx * along - cy * across, cy * along + cx * across, wind.z);
}

// Above the top, where a bent tower may reach, diameter and drag are those of the top.
bough_vec3 bough_tower_drag(const bough_tower *tower, double density, bough_vec3 position, bough_vec3 axis,
                            bough_vec3 inflow) {
    if (tower->n == 0) return bough_v3(0, 0, 0);
    double top = tower->height[tower->n - 1];
    double height = bough_clamp(position.z - tower->base.z, tower->height[0], top);
    double diameter = 2 * radius_at(tower, height);
    bough_vec3 across = bough_axpy(-bough_dot(inflow, axis), axis, inflow);
    double q = 0.5 * density * bough_norm(across) * drag_at(tower, height) * diameter;
    return bough_scale(q, across);
}
