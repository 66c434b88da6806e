#include "apps/bough/cli/check_turbine.h"

#include "apps/bough/model/aero_link.h"

#include <math.h>

static const double degree = BOUGH_PI / 180;

// -- geometry -------------------------------------------------------------------------------------

// The vertical from which the overhang counts: that of the tower's top, else of the ground's origin.
static bough_vec3 tower_axis(const bough_simulation *s) {
    if (s->tower_top == NULL) return bough_v3(0, 0, 0);
    const bough_rod_def *top = &s->tower_top->def;
    bough_transform foot = bough_tree_frame_pose(s->view, &s->tree->markers[s->tower_top->marker]);
    return bough_add(foot.position, bough_mat3_mul(foot.rotation, top->position[top->n_segment]));
}

static void print_rotor(const bough_simulation *s, const bough_rotor_place *r, FILE *stream) {
    bough_vec3 from = bough_sub(r->hub, tower_axis(s));
    double level = hypot(r->axis.x, r->axis.y);
    fprintf(stream, "rotor: %d blade%s, radius %.6g m, hub height %.6g m, tilt %.6g deg, ",
            s->scene->turbine.n_blade, s->scene->turbine.n_blade == 1 ? "" : "s", r->radius, r->hub.z,
            atan2(-r->axis.z, level) / degree);
    if (level > 1e-6) {
        double along = (from.x * r->axis.x + from.y * r->axis.y) / (level * level);
        fprintf(stream, "overhang %.6g m %s", fabs(along), along < 0 ? "upwind" : "downwind");
    }
    fprintf(stream, " along the shaft\n");
}

static void print_blades(const bough_simulation *s, const bough_rotor_place *r, FILE *stream) {
    for (int k = 0; k < s->scene->turbine.n_blade; k++) {
        const bough_beam *blade = bough_simulation_beam(s, s->scene->turbine.blade[k]);
        bough_transform root = bough_tree_frame_pose(s->view, &s->tree->markers[blade->marker]);
        bough_vec3 z = bough_mat3_mul(root.rotation, bough_v3(0, 0, 1));
        bough_vec3 offset = bough_sub(root.position, r->hub);
        double cone = asin(fmax(-1, fmin(1, bough_dot(z, r->axis))));
        fprintf(stream, "blade %s: pitch %.6g deg, cone %.6g deg, root at %.6g m\n", blade->body->name,
                bough_simulation_pitch(s, blade) / degree, cone / degree, bough_dot(offset, z));
    }
}

// -- air ------------------------------------------------------------------------------------------

static void print_box(const bough_simulation *s, const bough_wind_box *box, const bough_rotor_place *r,
                      FILE *stream) {
    const bough_rotor *air = bough_aero_link_rotor(s->aero);
    bool covered = bough_rotor_in_wind(air, r->hub, r->radius);
    bool lasts = bough_wind_box_lasts(box, s->master->duration);
    fprintf(stream, ", mean %.6g m/s, %.6g s%s, heights %.6g to %.6g m, width %.6g m: %s the rotor%s",
            box->mean, box->duration, box->periodic ? " and repeats" : "", box->bottom,
            box->bottom + box->dz * (box->n_z - 1), 2 * box->half_width,
            covered ? "covers" : "does not cover", lasts ? "" : ", ends before the run");
}

// Mean speed of a hub-height file's rows over its time, by the trapezoidal rule.
static void print_hub_file(const bough_simulation *s, const bough_wind_hub *hub, FILE *stream) {
    double last = hub->row[hub->n - 1].time, span = last - hub->row[0].time, mean = 0;
    for (int i = 1; i < hub->n; i++) {
        const bough_wind_hub_row *a = &hub->row[i - 1], *b = &hub->row[i];
        mean += (b->time - a->time) * (a->speed + b->speed) / 2 / span;
    }
    fprintf(stream, ", mean %.6g m/s, %.6g s, the whole space at once%s",
            hub->n > 1 ? mean : hub->row[0].speed, span,
            last < s->master->duration ? ", then as its last row" : "");
}

static void print_wind(const bough_simulation *s, const bough_rotor_place *r, FILE *stream) {
    static const char *const kinds[] = {
        [BOUGH_SCENE_WIND_UNIFORM] = "uniform",     [BOUGH_SCENE_WIND_POWER] = "power law",
        [BOUGH_SCENE_WIND_LOG] = "logarithmic law", [BOUGH_SCENE_WIND_WND] = "hub-height file",
        [BOUGH_SCENE_WIND_BTS] = "box file",        [BOUGH_SCENE_WIND_IEC] = "IEC 61400-1",
    };
    const bough_scene_wind *given = &s->scene->aero.wind;
    const bough_wind *wind = bough_rotor_wind(bough_aero_link_rotor(s->aero));
    const bough_scene_wind_table *table = &given->table;
    bool from_file = given->kind == BOUGH_SCENE_WIND_WND || given->kind == BOUGH_SCENE_WIND_BTS;
    fprintf(stream, "wind: %s", kinds[given->kind]);
    if (from_file) fprintf(stream, " %s", given->def.file);
    if (table->node) {
        fprintf(stream, ", %d speeds from %.6g s to %.6g s", table->n_time, table->time[0],
                table->time[table->n_time - 1]);
    } else if (!from_file) {
        fprintf(stream, ", %.6g m/s", given->def.speed);
    }
    if (wind->box) print_box(s, wind->box, r, stream);
    if (wind->hub) print_hub_file(s, wind->hub, stream);
    fprintf(stream, ", to %.6g deg from x, %.6g m/s upwards", given->def.direction / degree,
            given->def.vertical);
    bough_vec3 hub = bough_aero_link_hub_wind(s->aero, 0);
    fprintf(stream, "; at the hub at 0 s [%.6g, %.6g, %.6g] m/s\n", hub.x, hub.y, hub.z);
}

static const char *tower_words(const bough_scene_tower *tower) {
    if (!tower->node) return "off";
    return tower->def.influence == BOUGH_TOWER_BAK ? "on (Bak)" : "on";
}

static void print_aero(const bough_simulation *s, const bough_rotor_place *r, FILE *stream) {
    const bough_scene_aero *aero = &s->scene->aero;
    if (!s->aero) {
        fprintf(stream, "aero: not built: no aero block\n");
        return;
    }
    long every = bough_master_multiple(1 / aero->rate, s->master->macro_step);
    fprintf(stream,
            "aero: built, %d blades of %d stations, %d polars, %.6g Hz (every %ld macro step%s), "
            "%s between samples, tower influence %s%s%s%s\n",
            s->scene->turbine.n_blade, aero->blade.n_station, aero->polars.n_polar, aero->rate, every,
            every == 1 ? "" : "s", aero->hold == BOUGH_SCENE_LINEAR ? "linear" : "constant",
            tower_words(&aero->tower),
            aero->tower.def.shadow == BOUGH_TOWER_SHADOW_POWLES ? ", Powles shadow" : "",
            aero->induction.inflow.kind == BOUGH_INFLOW_OYE ? ", dynamic inflow" : "",
            aero->dynamic_stall != BOUGH_STALL_NONE ? ", dynamic stall" : "");
    print_wind(s, r, stream);
}

// -- control --------------------------------------------------------------------------------------

static bool is_pitched(const bough_scene *scene) {
    const bough_scene_joint *joint = &scene->body[scene->turbine.blade[0]].joint;
    return joint->kind == BOUGH_JOINT_REVOLUTE && joint->motion.node != NULL;
}

static void print_control(const bough_simulation *s, FILE *stream) {
    const bough_scene_control *c = &s->scene->control;
    if (c->node == NULL) {
        fprintf(stream, "control: not built: no control block\n");
        return;
    }
    fprintf(stream, "control: built, %s%s, %.6g Hz, gear ratio %.6g, generator torque%s, %d event%s\n",
            c->kind == BOUGH_SCENE_BLADED     ? "library "
            : c->kind == BOUGH_SCENE_EXTERNAL ? "by inputs from outside"
                                              : "variable-speed law",
            c->kind == BOUGH_SCENE_BLADED ? c->library : "", c->rate, c->gear_ratio,
            is_pitched(s->scene) ? " and pitch" : " only", c->n_event, c->n_event == 1 ? "" : "s");
}

void bough_check_turbine(bough_simulation *s, FILE *stream) {
    bough_simulation_update(s);
    bool turbine = s->scene->turbine.node != NULL;
    bough_rotor_place r = {0};
    if (turbine) {
        r = bough_simulation_rotor(s);
        print_rotor(s, &r, stream);
        print_blades(s, &r, stream);
    }
    print_aero(s, &r, stream);
    if (turbine) print_control(s, stream);
}
