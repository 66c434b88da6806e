// Steady operation as the start of a run: torques in balance, published speeds and pitch angles of the NREL
// 5 MW turbine (Jonkman et al. 2009, figure 9-1), and no start-up to speak of.
#include "aero/control/controller.h"
#include "apps/bough/model/aero_link.h"
#include "tests/unit/built_scene.h"

static const double rpm = BOUGH_PI / 30, degree = BOUGH_PI / 180;

static bough_simulation *operate(bough_arena *arena, const char *wind) {
    const char *const *sets =
        sets_of("simulation.initial=operation", "aero.ramp=[0 s, 0 s]", wind, "simulation.duration=12 s",
                "simulation.output={interval: 40 ms}", "bodies[3-5].rod.segments=12", "simulation.threads=1");
    return scene_build(arena, "apps/turbine/land-operation.yaml", sets);
}

static double rotor_speed(const bough_simulation *s) {
    int q, v;
    bough_tree_joint_rows(s->tree, s->scene->turbine.rotor, &q, &v);
    return s->leader.state[v];
}

static double pitch_of(const bough_simulation *s) {
    return bough_simulation_pitch(s, bough_simulation_beam(s, s->scene->turbine.blade[0]));
}

static void check_operation(const char *wind, double speed, double pitch) {
    check_arena(arena);
    bough_simulation *s = operate(arena, wind);
    double factor, start = rotor_speed(s), first = pitch_of(s);
    const bough_controller_def *law = &s->scene->control.law;
    double torque = 97 * bough_controller_torque(law, 97 * start, first);
    bough_aero_link_hold(s->aero, 0);
    check_near(bough_aero_link_data(s->aero, &factor)->torque, torque, 1e-4, 0);
    check_near(start, speed, 0.02, 0);
    check_near(first, pitch, 0, 1.2 * degree); // of stiff blades in a wind without shear
    double low = start, high = start;
    while (!bough_master_done(s->master)) {
        scene_step(s);
        low = fmin(low, rotor_speed(s));
        high = fmax(high, rotor_speed(s));
    }
    check_near(low, start, 1e-2, 0);
    check_near(high, start, 1e-2, 0);
    check_near(pitch_of(s), first, 0, 0.4 * degree);
}

TEST(below_rated_the_speed_is_found) {
    check_operation("aero.wind={kind: uniform, speed: 8 m/s}", 9.16 * rpm, 0);
}

TEST(above_rated_the_pitch_is_found) {
    check_operation("aero.wind={kind: uniform, speed: 18 m/s}", 12.1 * rpm, 14.92 * degree);
}
