#include "apps/bough/model/build_internal.h"

#include "apps/bough/model/aero_link.h"
#include "apps/bough/model/control_link.h"

enum { MOST_TRIES = 60 };

static const double tolerance = 1e-5;            // of the balance of torques, relative to the rated torque
static const double slower = 0.85, faster = 1.1; // factors by which the speed is bracketed
static const double steeper = 4 * BOUGH_DEGREE;  // steps by which the pitch is bracketed [rad]
static const double standing = 0.1;              // of the reference speed: a slower rotor stands still

typedef struct search {
    bough_simulation *simulation;
    const bough_controller_def *law;
    double *state; // (n_state)
    double gear;
    int tries; // number of equilibria so far
    bough_status status;
} search;

// The torque of the air less that of the generator at a rotor speed and a pitch, relative to the rated
// torque; NAN if no equilibrium is found.
static double surplus(search *x, double speed, double pitch) {
    bough_simulation *s = x->simulation;
    int q, v;
    double factor;
    if (bough_is_ok(&x->status) && x->tries++ == MOST_TRIES)
        x->status = bough_fail(BOUGH_FAILED, "no steady operation found in %d tries", MOST_TRIES);
    if (!bough_is_ok(&x->status)) return (double)NAN;
    bough_tree_joint_rows(s->tree, s->scene->turbine.rotor, &q, &v);
    bough_assembly_states(s->assembly, x->state);
    s->tree->initial[v] = x->state[v] = speed;
    bough_control_link_stand(s->control, speed, pitch);
    bough_equilibrium_set_state(s, 0, x->state);
    x->status = bough_simulation_equilibrium(s, 0, 0, NULL);
    if (!bough_is_ok(&x->status)) return (double)NAN;
    double torque = bough_aero_link_data(s->aero, &factor)->torque;
    double generator = x->gear * bough_controller_torque(x->law, x->gear * speed, pitch);
    return (factor * torque - generator) / (x->gear * x->law->rated_power / x->law->rated_speed);
}

// Finds the zero between a, where the surplus is positive, and b, where it is not, of the speed or of the
// pitch, by regula falsi in the Illinois variant.
static void close_in(search *x, double a, double fa, double b, double fb, bool of_speed, double other) {
    int side = 0;
    while (bough_is_ok(&x->status)) {
        double c = (fa * b - fb * a) / (fa - fb);
        double f = of_speed ? surplus(x, c, other) : surplus(x, other, c);
        if (!(fabs(f) > tolerance)) return; // found, or failed
        if (f > 0) {
            a = c, fa = f;
            if (side > 0) fb /= 2;
            side = 1;
        } else {
            b = c, fb = f;
            if (side < 0) fa /= 2;
            side = -1;
        }
    }
}

static void seek_pitch(search *x, double speed, double f) {
    double low = x->law->least_pitch;
    while (low < x->law->most_pitch) {
        double high = fmin(low + steeper, x->law->most_pitch), g = surplus(x, speed, high);
        if (!bough_is_ok(&x->status)) return;
        if (g <= 0) {
            close_in(x, low, f, high, g, false, speed);
            return;
        }
        low = high, f = g;
    }
    x->status = bough_fail(BOUGH_FAILED,
                           "no steady operation: at a pitch of %.4g degrees the "
                           "rotor still accelerates at %.4g rpm",
                           low / BOUGH_DEGREE, speed / BOUGH_RPM);
}

// Searches upwards from a speed with a surplus (f > 0), or downwards from one without.
static void seek_speed(search *x, double speed, double f, double pitch) {
    double factor = f > 0 ? faster : slower, reference = speed;
    for (;;) {
        double next = factor * speed, g = surplus(x, next, pitch);
        if (!bough_is_ok(&x->status)) return;
        if (f > 0 && g <= 0) {
            close_in(x, speed, f, next, g, true, pitch);
            return;
        }
        if (f <= 0 && g > 0) {
            close_in(x, next, g, speed, f, true, pitch);
            return;
        }
        speed = next, f = g;
        if (speed > standing * reference && speed < reference / standing) continue;
        x->status = bough_fail(BOUGH_FAILED,
                               "no steady operation: the torque of the air equals "
                               "that of the generator at no speed from %.4g to %.4g rpm",
                               fmin(speed, reference) / BOUGH_RPM, fmax(speed, reference) / BOUGH_RPM);
        return;
    }
}

bough_status bough_simulation_trim(bough_arena *arena, bough_simulation *s) {
    const bough_scene_control *control = &s->scene->control;
    search x = {.simulation = s,
                .law = &control->law,
                .gear = control->gear_ratio,
                .state = bough_arena_doubles(arena, (size_t)s->assembly->n_state + 1),
                .status = bough_ok()};
    bool pitches = bough_control_link_pitches(s->control);
    double speed = x.law->reference_speed / x.gear;
    double pitch = pitches ? x.law->least_pitch : s->scene->body[s->scene->turbine.blade[0]].pitch;
    double f = surplus(&x, speed, pitch);
    if (bough_is_ok(&x.status) && f > tolerance && pitches) {
        seek_pitch(&x, speed, f);
    } else if (bough_is_ok(&x.status) && fabs(f) > tolerance) {
        seek_speed(&x, speed, f, pitch);
    }
    return x.status;
}
