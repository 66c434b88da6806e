// RotSpeed, Azimuth, RotTorq and RotPwr beside formulas: they are the hub's, as LSSTipVxa, LSSTipPxa,
// LSShftMxa and RotPwr of OpenFAST.
#include "tests/unit/built_scene.h"

static const char scene[] = "tests/data/scenes/shaft.yaml";
static const double generator = 3000, hub = 5000, drive = 16e3, brake = 4e3; // [kg m2], [N m]

// On a rigid shaft the hub accelerates the generator: its inertia times (drive - brake) / (sum of inertias),
// and carries the brake. So free of the brake, and with a constant speed, which leaves the driving moment.
TEST(rigid_shaft_carries_the_generators_inertia) {
    static const char *const braked[] = {NULL}, *const free[] = {"loads[1].torque=0", NULL};
    static const char *const driven[] = {"bodies[generator].joint={kind: revolute, parent: nacelle, axis: x, "
                                         "motion: {speed: 1 rad/s}}",
                                         "loads[1].torque=0", NULL};
    for (int i = 0; i < 2; i++) {
        built f = built_open(scene, i == 0 ? braked : free);
        double against = i == 0 ? brake : 0, rate = (drive - against) / (generator + hub);
        run_until(&f, 1);
        check_near(1e3 * channel(&f, "RotTorq"), against + generator * rate, 1e-6, 0);
        check_near(channel(&f, "RotSpeed") * BOUGH_PI / 30, 1 + rate, 1e-6, 0);
        check_near(1e3 * channel(&f, "RotPwr"), (against + generator * rate) * (1 + rate), 1e-6, 0);
        bough_arena_destroy(f.arena);
    }
    built f = built_open(scene, driven);
    run_until(&f, 0.1);
    check_near(1e3 * channel(&f, "RotTorq"), drive, 1e-6, 0);
}

// Against a spring of k the hub swings about the mean twist: with m the reduced inertia and the generator's
// and hub's loads, twist = (1 - cos wt) m (drive/hub + brake/generator) / k, w2 = k/m. RotTorq is k times the
// twist, and the hub's speed is that of the common motion with its part of the twist's rate.
TEST(spring_between_hub_and_generator_carries_the_torque) {
    static const char *const sets[] = {"bodies[hub].joint={kind: revolute, axis: x, parent: generator, "
                                       "stiffness: 1e6}",
                                       NULL};
    built f = built_open(scene, sets);
    const double k = 1e6, reduced = generator * hub / (generator + hub), w = sqrt(k / reduced);
    const double mean = reduced * (drive / hub + brake / generator) / k;
    for (int i = 1; i <= 20; i++) {
        double t = 0.1 * i, twist = mean * (1 - cos(w * t)), rate = mean * w * sin(w * t);
        double together = 1 + (drive - brake) / (generator + hub) * t;
        double speed = together + generator / (generator + hub) * rate;
        run_until(&f, t);
        check_near(1e3 * channel(&f, "RotTorq"), k * twist, 1e-4, 1);
        check_near(channel(&f, "RotSpeed") * BOUGH_PI / 30, speed, 1e-5, 0);
        check_near(1e3 * channel(&f, "RotPwr"), k * twist * speed, 1e-4, 1);
        double angle =
            t + (drive - brake) / (generator + hub) * t * t / 2 + generator / (generator + hub) * twist;
        check_near(channel(&f, "Azimuth"), fmod(angle * 180 / BOUGH_PI, 360), 1e-5, 1e-3);
    }
}
