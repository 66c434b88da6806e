#include "aero/tower.h"

#include "core/base.h"

// Closer than this to the axis, in radii, the flow is taken at this distance: the potential has a
// pole inside the cylinder, where only an ill-posed scene puts a blade.
static const double nearest = 1;

bough_status bough_tower_build(bough_arena *arena, const bough_tower_def *def, bough_tower *tower) {
    *tower = (bough_tower){.base = def->base, .n = def->n};
    if (def->n == 0) return bough_ok();
    if (def->n < 2) return bough_fail(BOUGH_INVALID, "The tower needs at least two sections.");
    double *height = bough_arena_doubles(arena, (size_t)def->n);
    double *radius = bough_arena_doubles(arena, (size_t)def->n);
    if (!height || !radius) return bough_fail(BOUGH_OUT_OF_MEMORY, "No memory for the tower.");
    for (int i = 0; i < def->n; i++) {
        if (i > 0 && !(def->height[i] > def->height[i - 1])) {
            return bough_fail(BOUGH_INVALID, "Tower section %d: heights must increase.", i + 1);
        }
        if (!(def->diameter[i] > 0)) {
            return bough_fail(BOUGH_INVALID, "Tower section %d: the diameter must be positive.",
                              i + 1);
        }
        height[i] = def->height[i];
        radius[i] = def->diameter[i] / 2;
    }
    tower->height = height;
    tower->radius = radius;
    return bough_ok();
}

// The radius at a height above the base, 0 where there is no tower. Above the top it fades over
// one radius, as in the reference code.
static double radius_at(const bough_tower *tower, double height) {
    int n = tower->n;
    if (n == 0 || height < tower->height[0]) return 0;
    double top = tower->radius[n - 1], above = height - tower->height[n - 1];
    if (above >= top) return 0;
    if (above > 0) return top * cos(BOUGH_PI / 2 * above / top);
    int i = 1;
    while (i < n - 1 && height > tower->height[i])
        i++;
    double w = (height - tower->height[i - 1]) / (tower->height[i] - tower->height[i - 1]);
    return tower->radius[i - 1] + w * (tower->radius[i] - tower->radius[i - 1]);
}

bough_vec3 bough_tower_disturbed(const bough_tower *tower, bough_vec3 position, bough_vec3 wind) {
    bough_vec3 d = bough_sub(position, tower->base);
    double radius = radius_at(tower, d.z), speed = hypot(wind.x, wind.y);
    if (radius == 0 || speed == 0) return wind;
    double cx = wind.x / speed, cy = wind.y / speed;
    double x = (cx * d.x + cy * d.y) / radius, y = (cx * d.y - cy * d.x) / radius;
    double r2 = x * x + y * y;
    if (r2 == 0) return bough_v3(0, 0, wind.z);
    double scale = r2 < nearest * nearest ? nearest / sqrt(r2) : 1;
    x *= scale;
    y *= scale;
    r2 *= scale * scale;
    double along = speed * (1 + (y * y - x * x) / (r2 * r2));
    double across = speed * (-2 * x * y / (r2 * r2));
    return bough_v3(cx * along - cy * across, cy * along + cx * across, wind.z);
}
