// The wind at a point: a formula, a hub-height file, a box of turbulence or a condition of IEC 61400-1, then
// inclined and veered.
#include "aero/wind/wind.h"

#include "aero/wind/wind_iec.h"
#include "core/base/base.h"
#include "core/base/schedule.h"

#include <assert.h>

bough_wind_def bough_wind_def_default(void) {
    return (bough_wind_def){.exponent = 0.2, .roughness = 0.03, .reference_height = 90};
}

static bough_status read_hub(bough_arena *arena, bough_wind *wind) {
    bough_wind_hub *hub = bough_arena_take(arena, sizeof *hub);
    hub->reference_height = wind->def.reference_height;
    hub->reference_length = wind->def.reference_length;
    wind->hub = hub;
    return bough_wind_hub_read(arena, wind->def.file, hub);
}

// A box that is not periodic must last until the end of the run.
static bough_status read_box(bough_arena *arena, bough_wind *wind) {
    bough_wind_box *box = bough_arena_take(arena, sizeof *box);
    wind->box = box;
    bough_status status = bough_wind_box_read(arena, wind->def.file, box);
    if (!bough_is_ok(&status) || bough_wind_box_lasts(box, wind->def.until)) return status;
    return bough_fail(BOUGH_INVALID,
                      "%s is not periodic and too short: it has %g s, of which %g s pass before "
                      "the box covers the rotor; %g s are needed.",
                      wind->def.file, box->duration, box->half_width / box->mean, wind->def.until);
}

static bough_status make_standard(bough_arena *arena, bough_wind *wind) {
    const bough_wind_iec_def *def = &wind->def.iec;
    BOUGH_TRY(bough_wind_iec_check(def));
    // turbulent conditions are a box, deterministic ones a formula
    if (bough_wind_iec_is_turbulent(def->condition)) {
        bough_wind_box *box = bough_arena_take(arena, sizeof *box);
        wind->box = box;
        return bough_turbulence_make(arena, def, box);
    }
    bough_wind_iec *iec = bough_arena_take(arena, sizeof *iec);
    *iec = bough_wind_iec_start(def);
    wind->iec = iec;
    return bough_ok();
}

static bough_status build(bough_arena *arena, const bough_wind_def *def, bough_wind *wind) {
    wind->box = def->box;
    if (def->box) return bough_ok();
    if (def->source == BOUGH_WIND_STANDARD) return make_standard(arena, wind);
    if (def->source == BOUGH_WIND_HUB_FILE) return read_hub(arena, wind);
    if (def->source == BOUGH_WIND_BOX_FILE) return read_box(arena, wind);
    // a formula, and its table of speeds
    if (def->shear == BOUGH_WIND_LOG) {
        assert(def->roughness > 0 && def->roughness < def->reference_height);
        wind->shear_scale = 1 / log(def->reference_height / def->roughness);
    }
    if (def->n_time == 0) return bough_ok();
    size_t size = (size_t)def->n_time * sizeof *def->time;
    wind->def.time = bough_arena_copy(arena, def->time, size);
    wind->def.speed_at_time = bough_arena_copy(arena, def->speed_at_time, size);
    return bough_ok();
}

bough_status bough_wind_build(bough_arena *arena, const bough_wind_def *def, bough_wind *wind) {
    *wind = (bough_wind){.def = *def,
                         .along_x = cos(def->direction),
                         .along_y = sin(def->direction),
                         .up_x = cos(def->upflow),
                         .up_z = sin(def->upflow)};
    bough_status status = build(arena, def, wind);
    wind->level = wind->box ? wind->box->hub : wind->iec ? def->iec.height : def->reference_height;
    return status;
}

// The profile over height, relative to the reference height.
static double profile_at(const bough_wind *wind, double height) {
    const bough_wind_def *def = &wind->def;
    switch (def->shear) {
    case BOUGH_WIND_UNIFORM: break;
    case BOUGH_WIND_POWER: return height <= 0 ? 0 : pow(height / def->reference_height, def->exponent);
    case BOUGH_WIND_LOG:
        return height <= def->roughness ? 0 : log(height / def->roughness) * wind->shear_scale;
    }
    return 1;
}

// From ground axes to those in which a file's wind blows along x.
static bough_vec3 to_file(const bough_wind *wind, bough_vec3 v) {
    return bough_v3(wind->along_x * v.x + wind->along_y * v.y, wind->along_x * v.y - wind->along_y * v.x,
                    v.z);
}

static bough_vec3 from_file(const bough_wind *wind, bough_vec3 v) {
    return bough_v3(wind->along_x * v.x - wind->along_y * v.y, wind->along_x * v.y + wind->along_y * v.x,
                    v.z);
}

// Formulas are defined everywhere, a box on its grid.
bool bough_wind_covers(const bough_wind *wind, bough_vec3 centre, double radius) {
    const bough_wind_box *box = wind->box;
    if (!box) return true;
    bough_vec3 p = to_file(wind, centre);
    double top = box->bottom + box->dz * (box->n_z - 1);
    return fabs(p.y) + radius <= box->half_width && p.z + radius <= top && p.z - radius >= box->bottom;
}

void bough_wind_passes(const bough_wind *wind, bough_vec3 place, double time[2]) {
    const bough_wind_box *box = wind->box;
    time[0] = -HUGE_VAL, time[1] = HUGE_VAL;
    if (!box || box->periodic) return;
    time[0] = (to_file(wind, place).x - box->half_width) / box->mean;
    time[1] = time[0] + box->duration;
}

// In the axes of a file, along whose x the wind blows.
static bough_vec3 along_at(const bough_wind *wind, bough_vec3 position, double t) {
    if (wind->hub) return bough_wind_hub_at(wind->hub, to_file(wind, position), t);
    if (wind->box) return bough_wind_box_at(wind->box, to_file(wind, position), t);
    if (wind->iec) return bough_wind_iec_at(wind->iec, to_file(wind, position), t);
    const bough_wind_def *def = &wind->def;
    double speed = def->speed;
    if (def->n_time > 0) speed = bough_table_value(def->n_time, def->time, def->speed_at_time, t);
    speed *= profile_at(wind, position.z);
    return bough_v3(speed, 0, def->vertical);
}

// Rotated upwards about the horizontal axis across the wind.
static bough_vec3 inclined(const bough_wind *wind, bough_vec3 v) {
    return bough_v3(wind->up_x * v.x - wind->up_z * v.z, v.y, wind->up_z * v.x + wind->up_x * v.z);
}

// Rotated about the vertical in proportion to the height above the reference.
static bough_vec3 veered(const bough_wind *wind, bough_vec3 v, double height) {
    double angle = wind->def.veer * (height - wind->level), c = cos(angle), s = sin(angle);
    return bough_v3(c * v.x + s * v.y, c * v.y - s * v.x, v.z);
}

bough_vec3 bough_wind_at(const bough_wind *wind, bough_vec3 position, double t) {
    // in the file's axes, then in those of the ground
    bough_vec3 v = along_at(wind, position, t);
    if (wind->def.upflow != 0) v = inclined(wind, v);
    if (wind->def.veer != 0) v = veered(wind, v, position.z);
    return from_file(wind, v);
}
