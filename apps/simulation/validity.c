#include "apps/simulation/validity.h"

#include "apps/simulation/aero_link.h"

#include <math.h>
#include <stdio.h>

// Incompressible polars err by a seventh in the slope of lift there.
static const double most_mach = 0.5, speed_of_sound = 340;
static const double most_over_rated = 2;

// Each sentence ends with the value in its unit.
static const struct {
    const char *name, *text;
} limits[BOUGH_LIMITS] = {
    [BOUGH_LIMIT_ATTACK] = {"angle_of_attack", "the polar's table has no rows at an angle of attack"
                                               " of %.4g deg; they are joined across the gap"},
    [BOUGH_LIMIT_MACH] = {"mach", "a section meets the air at %.4g m/s, more than half the speed of"
                                  " sound: the polars hold for incompressible flow"},
    [BOUGH_LIMIT_ROTOR_SPEED] = {"rotor_speed", "the rotor turns at %.4g rpm, more than twice the"
                                                " rated speed"},
    [BOUGH_LIMIT_TOWER] = {"tower_strike", "the blade is inside the tower, %.3g of its radius"
                                        " from the axis: nothing stops it there"},
};

const char *bough_limit_name(bough_limit limit) { return limits[limit].name; }

void bough_validity_pass(bough_validity *v, bough_limit limit, int body, double time,
                         double value) {
    if (v->limit[limit].passed) return;
    v->limit[limit] = (bough_passing){true, body, time, value};
}

static void check_air(bough_simulation *s) {
    const bough_rotor *rotor = bough_aero_link_rotor(s->aero);
    double factor, time = bough_aero_link_evaluated(s->aero);
    const bough_rotor_data *data = bough_aero_link_data(s->aero, &factor);
    if (!(time > s->validity->looked)) return;
    s->validity->looked = time;
    for (int b = 0; b < s->scene->turbine.n_blade; b++) {
        bough_rotor_extremes x = bough_rotor_look(rotor, data, b);
        int body = s->scene->turbine.blade[b];
        if (x.outside_table) {
            bough_validity_pass(s->validity, BOUGH_LIMIT_ATTACK, body, time,
                                x.alpha * (180 / BOUGH_PI));
        }
        if (x.speed > most_mach * speed_of_sound) {
            bough_validity_pass(s->validity, BOUGH_LIMIT_MACH, body, time, x.speed);
        }
        if (x.distance < 1) {
            bough_validity_pass(s->validity, BOUGH_LIMIT_TOWER, body, time, x.distance);
        }
    }
}

static void check_speed(bough_simulation *s) {
    const bough_scene_control *control = &s->scene->control;
    if (!control->node || control->kind != BOUGH_SCENE_VARIABLE_SPEED) return;
    int rotor = s->scene->turbine.rotor, q, v;
    bough_tree_joint_rows(s->tree, rotor, &q, &v);
    double speed = s->leader.state[v], rated = control->law.rated_speed / control->gear_ratio;
    if (fabs(speed) <= most_over_rated * fabs(rated)) return;
    bough_validity_pass(s->validity, BOUGH_LIMIT_ROTOR_SPEED, rotor, s->master->time,
                        speed * (30 / BOUGH_PI));
}

void bough_validity_check(bough_simulation *s) {
    if (s->aero) check_air(s);
    check_speed(s);
}

void bough_validity_describe(const bough_simulation *s, bough_limit limit, char *text, size_t size) {
    const bough_passing *p = &s->validity->limit[limit];
    int n = snprintf(text, size, "%s at %.6g s: ", s->scene->body[p->body].name, p->time);
    if (n < 0 || (size_t)n >= size) return;
    snprintf(text + n, size - (size_t)n, limits[limit].text, p->value);
}
