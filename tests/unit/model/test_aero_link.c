// Between rotor and bodies: the loads put on rods and rigid blades, and how they go on between
// samples. The scene has a flexible and a rigid blade.
#include "tests/unit/built_scene.h"
#include "tests/unit/sample_numbers.h"

#include "apps/bough/model/aero_link.h"

#include <unistd.h>

static const char turbine[] = "tests/data/scenes/example-turbine.yaml";

static const double period = 0.02, ramp_end = 0.5; // of the scene's aerodynamics [s]

enum { SEGMENTS = 12, LOADS = 6 * (SEGMENTS + 1), FLEXIBLE = 0, RIGID = 1, HUB = 2 };

typedef struct fixture {
    bough_arena *arena;
    bough_simulation *s;
    bough_sampled_load load;
} fixture;

static fixture open_turbine(const char *const *sets) {
    fixture f = {.arena = check_memory()};
    f.s = scene_build(f.arena, turbine, sets);
    f.load = f.s->sampled[0];
    return f;
}

static void close_turbine(fixture *f) { bough_arena_destroy(f->arena); }

static bool sample(fixture *f, double t, double t_next) {
    bool jumped = false;
    check_ok(f->load.sample(f->load.self, t, t_next, &jumped));
    return jumped;
}

// A blade's load signal: value, rate and curve by time since the start, LOADS of a rod or 6 of a rigid blade,
// in the order that bodies keep them.
typedef struct signal {
    int n;
    double start, value[LOADS], rate[LOADS], curve[LOADS];
} signal;

static signal signal_of(const fixture *f, int blade) {
    const bough_beam *beam = &f->s->beam[blade];
    signal x = {.n = 6};
    if (beam->rod == NULL) {
        const bough_external *e = &f->s->tree->external[beam->marker];
        bough_wrench_store(e->value, x.value);
        bough_wrench_store(e->rate, x.rate);
        bough_wrench_store(e->curve, x.curve);
        x.start = e->start;
        return x;
    }
    const bough_rod_loads *loads = bough_rod_body_loads(beam->rod);
    int stride = bough_rod_body_model(beam->rod)->stride;
    x.n = LOADS;
    x.start = loads->start;
    for (int k = 0; k < LOADS; k++) {
        int at = k / (SEGMENTS + 1) * stride + k % (SEGMENTS + 1);
        x.value[k] = loads->value[at];
        x.rate[k] = loads->rate[at];
        x.curve[k] = loads->curve[at];
    }
    return x;
}

static double largest(const double *x, int n) {
    double most = 0;
    for (int k = 0; k < n; k++) most = fmax(most, fabs(x[k]));
    return most;
}

// -- balance --------------------------------------------------------------------------------------

// Force and moment about the ground's origin that a blade's body receives.
static bough_wrench received(const fixture *f, int blade) {
    const bough_beam *beam = &f->s->beam[blade];
    bough_transform pose = bough_tree_frame_pose(f->s->view, &f->s->tree->markers[beam->marker]);
    signal x = signal_of(f, blade);
    if (beam->rod == NULL) return bough_wrench_to_parent(&pose, bough_wrench_load(x.value));
    bough_vertex_motion vertex[SEGMENTS + 1];
    bough_simulation_beam_motion(f->s, beam, vertex);
    bough_wrench sum = {{0, 0, 0}, {0, 0, 0}};
    for (int i = 0; i <= SEGMENTS; i++) {
        double w[6];
        for (int c = 0; c < 6; c++) w[c] = x.value[c * (SEGMENTS + 1) + i];
        bough_transform at = {vertex[i].position, pose.rotation};
        sum = bough_wrench_add(sum, bough_wrench_to_parent(&at, bough_wrench_load(w)));
    }
    return sum;
}

// On the turbine in motion, its flexible blade bent and the rotor turned on.
TEST(bodies_receive_what_the_rotor_gives) {
    static const char *const sets[] = {"aero.hold=constant", "bodies[2].joint.angle=40 deg",
                                       "bodies[2].joint.speed=1.5 rad/s", NULL};
    fixture f = open_turbine(sets);
    for (int k = 0; k < 80; k++) scene_step(f.s);
    sample(&f, 0.8, 0.82);
    double factor;
    const bough_rotor_data *data = bough_aero_link_data(f.s->aero, &factor);
    bough_transform hub = bough_tree_frame_pose(f.s->view, &f.s->tree->bodies[HUB]);
    bough_vec3 shaft = hub.rotation.c1, force = {0, 0, 0}, moment = {0, 0, 0};
    for (int b = 0; b < 2; b++) {
        bough_wrench w = received(&f, b);
        const double *load = data->load + 6 * b * (SEGMENTS + 1);
        bough_vec3 sum = {0, 0, 0};
        for (int i = 0; i <= SEGMENTS; i++) {
            bough_vec3 here = {load[i], load[SEGMENTS + 1 + i], load[2 * (SEGMENTS + 1) + i]};
            sum = bough_add(sum, here);
        }
        int marker = f.s->beam[b].marker;
        bough_transform pose = bough_tree_frame_pose(f.s->view, &f.s->tree->markers[marker]);
        sum = bough_mat3_mul(pose.rotation, sum);
        check_vec3(w.force, sum, 0, 1e-9 * bough_norm(sum));
        force = bough_add(force, w.force);
        moment = bough_add(moment, w.moment);
    }
    check_near(factor, 1, 0, 0);
    moment = bough_sub(moment, bough_cross(hub.position, force)); // about the hub
    check_near(bough_dot(force, shaft), data->thrust, 1e-9, 0);
    // the rod takes its loads beside the chords of bent segments, the rotor's sum does not
    check_near(bough_dot(moment, shaft), data->torque, 1e-6, 0);
    assert_true(data->thrust > 1000 && fabs(data->torque) > 100);
    assert_true(f.s->rod[f.s->beam[FLEXIBLE].port].state[SEGMENTS - 1] > 5e-4);
    close_turbine(&f);
}

// The rotor sees the hub turn and the wind meet it under the shaft's tilt of 5°: at the root of the
// upright blade the turning comes from the side, the wind, little disturbed, from ahead.
TEST(rotor_sees_the_motion_of_the_hub) {
    static const char *const sets[] = {"bodies[2].joint.speed=3 rad/s", NULL};
    fixture f = open_turbine(sets);
    sample(&f, 0, period);
    double factor, degree = BOUGH_PI / 180;
    const bough_rotor_data *data = bough_aero_link_data(f.s->aero, &factor);
    bough_station root = bough_rotor_station(data, 0, 0);
    check_near(root.radius, 1.5 * cos(2.5 * degree), 2e-2, 0);
    check_near(root.inflow_y, 3 * root.radius, 1e-9, 0);
    check_near(root.inflow_x, 12 * cos(5 * degree), 0.03, 0);
    close_turbine(&f);
}

// The blades' mean velocity is the nacelle's: two opposite blades turn about their middle. RtVAvgxh and RtTSR
// are of the wind relative to it.
TEST(rotor_takes_the_wind_relative_to_the_blades) {
    static const char *const sets[2][3] = {
        {"bodies[2].joint.speed=3 rad/s", NULL},
        {"bodies[2].joint.speed=3 rad/s",
         "bodies[1].joint={kind: prismatic, axis: x, parent: tower, placement: [move z 20 m], "
         "motion: {speed: 2 m/s}}",
         NULL}};
    double wind[2], ratio[2];
    for (int i = 0; i < 2; i++) {
        fixture f = open_turbine(sets[i]);
        bough_channels list = scene_channels(f.arena, f.s);
        sample(&f, 0, period);
        wind[i] = scene_channel(f.s, &list, "RtVAvgxh");
        ratio[i] = scene_channel(f.s, &list, "RtTSR");
        close_turbine(&f);
    }
    check_near(wind[0] - wind[1], 2 * cos(5 * BOUGH_PI / 180), 1e-6, 0);
    check_near(ratio[1] / ratio[0], wind[0] / wind[1], 1e-6, 0);
}

// Without wind RtVAvgxh of a turning rotor is rounding, of either sign.
TEST(rotor_in_still_air_has_no_tip_speed_ratio) {
    static const char *const sets[] = {"bodies[2].joint.speed=3 rad/s", "aero.wind.speed=0", NULL};
    fixture f = open_turbine(sets);
    bough_channels list = scene_channels(f.arena, f.s);
    sample(&f, 0, period);
    check_near(scene_channel(f.s, &list, "RtVAvgxh"), 0, 0, 1e-12);
    assert_true(scene_channel(f.s, &list, "RtTSR") == 0);
    close_turbine(&f);
}

// Mean over the stations, which the tower disturbs a little; the 12 m/s of the scene at 50 m.
TEST(wind_of_the_scene_reaches_the_rotor) {
    static const char *const sets[][6] = {
        {"aero.wind.direction=90 deg", "aero.wind.vertical=2 m/s", NULL},
        {"aero.wind={table: {times: [0 s, 2 s], speeds: [12, 6]}, kind: power, exponent: 0.5,"
         " reference_height: 500 m}",
         NULL},
        {"aero.wind={table: {times: [0 s, 2 s], speeds: [12, 6]}, kind: log, roughness: 1 m,"
         " reference_height: 10000 m}",
         NULL},
    };
    for (int i = 0; i < 3; i++) {
        fixture f = open_turbine(sets[i]);
        sample(&f, 1, 1 + period);
        double factor, z = 0;
        const bough_rotor_data *data = bough_aero_link_data(f.s->aero, &factor);
        bough_vec3 hub = bough_tree_frame_pose(f.s->view, &f.s->tree->bodies[HUB]).position;
        z = hub.z;
        const bough_vec3 expected[3] = {{0, 12, 2}, {9 * sqrt(z / 500), 0, 0}, {9 * log(z) / log(1e4), 0, 0}};
        check_vec3(data->disk_wind, expected[i], 0, 0.5);
        close_turbine(&f);
    }
}

// Dynamic inflow begins in equilibrium; after a sudden gust the old induction stays for a while.
TEST(wind_of_a_file_reaches_the_rotor) {
    char path[SCRATCH_NAME], set[SCRATCH_PATH];
    int file = mkstemp(scratch_name(path));
    assert_true(file >= 0);
    static const char text[] = "! time speed direction\n0 12 0 0 0 0 0 0\n2 6 0 4 0 0 0 0\n";
    assert_int_equal(write(file, text, sizeof text - 1), sizeof text - 1);
    close(file);
    snprintf(set, sizeof set,
             "aero.wind={kind: wnd, file: %s, reference_height: 90 m, "
             "reference_length: 126 m, direction: 90 deg}",
             path);
    const char *const sets[] = {set, NULL};
    fixture f = open_turbine(sets);
    sample(&f, 1, 1 + period);
    double factor;
    check_vec3(bough_aero_link_data(f.s->aero, &factor)->disk_wind, bough_v3(0, 9, 2), 0, 0.5);
    close_turbine(&f);
    unlink(path);
}

TEST(inflow_of_the_scene_reaches_the_rotor) {
#define GUST "aero.wind={table: {times: [0 s, 1 s, 1.02 s], speeds: [12, 12, 15]}}"
#define SPEED "bodies[2].joint.speed=3 rad/s"
    static const char *const sets[][5] = {
        {SPEED, GUST, NULL},
        {SPEED, GUST, "aero.induction.inflow=oye", "aero.induction.inflow_time=5 s", NULL}};
    double thrust[2][2], factor;
    for (int i = 0; i < 2; i++) {
        fixture f = open_turbine(sets[i]);
        for (int k = 0; k < 2; k++) {
            sample(&f, 1 + k * period, 1 + (k + 1) * period);
            thrust[i][k] = bough_aero_link_data(f.s->aero, &factor)->thrust;
        }
        close_turbine(&f);
    }
    check_near(thrust[1][0], thrust[0][0], 1e-12, 0);
    assert_true(fabs(thrust[1][1] / thrust[0][1] - 1) > 1e-6);
}

// -- between samples ------------------------------------------------------------------------------

enum { SAMPLES = 30 };

static void check_continuous(const signal *before, const signal *now) {
    double allowed = 1e-12 * largest(now->value, now->n);
    for (int i = 0; i < now->n; i++) {
        double dt = now->start - before->start;
        double reached = before->value[i] + dt * (before->rate[i] + dt * before->curve[i]);
        check_near(now->value[i], reached, 0, allowed);
    }
}

// Value and rate as shares of the whole load.
static void check_share(const signal *now, const signal *whole, double value, double rate) {
    double allowed = 1e-12 * largest(whole->value, whole->n);
    assert_true(allowed > 0);
    for (int i = 0; i < now->n; i++) {
        check_near(now->value[i], value * whole->value[i], 0, allowed);
        check_near(now->rate[i], rate * whole->value[i], 0, allowed / period);
        check_near(now->curve[i], 0, 0, allowed / (period * period));
    }
}

// The motion stands still, so that loads grow with the ramp: linearly, to its end at sample 25.
TEST(linear_hold_is_continuous_and_exact_for_linear_loads) {
#define STILL "bodies[2].joint.speed=0 rad/s"
    static const char *const ramped[] = {STILL, NULL};
    static const char *const full[] = {STILL, "aero.ramp=[0 s, 0 s]", NULL};
    fixture f = open_turbine(ramped), g = open_turbine(full);
    sample(&g, 0, period);
    const signal whole[2] = {signal_of(&g, FLEXIBLE), signal_of(&g, RIGID)};
    signal last[2];
    for (int k = 0; k < SAMPLES; k++) {
        assert_int_equal(sample(&f, k * period, (k + 1) * period), k == 0);
        for (int b = 0; b < 2; b++) {
            signal now = signal_of(&f, b);
            if (k > 0) check_continuous(&last[b], &now);
            if (k >= 2 && k < 25) check_share(&now, &whole[b], k * period / ramp_end, 1 / ramp_end);
            last[b] = now;
        }
    }
    // two periods after the ramp's end the corner is forgotten
    for (int b = 0; b < 2; b++) check_share(&last[b], &whole[b], 1, 0);
    close_turbine(&f);
    close_turbine(&g);
}

// What the flexible blade gets in all, with what its motion adds; along x and y.
static void whole_load(const fixture *f, double t, double load[2 * SEGMENTS]) {
    const bough_rod_loads *l = bough_rod_body_loads(f->s->beam[FLEXIBLE].rod);
    const double *state = bough_beam_state(f->s, &f->s->beam[FLEXIBLE], 1);
    int s = bough_rod_body_model(f->s->beam[FLEXIBLE].rod)->stride, n = SEGMENTS;
    double dt = t - l->start;
    for (int c = 0; c < 2; c++) {
        for (int i = 0; i < n; i++) {
            const double *slope = l->slope + 4 * c * s + i + 1, *p = state + BOUGH_ROD_P * n + i;
            double angle = 0, norm = 0;
            for (int k = 0; k < 4; k++) {
                angle += l->angle[k * s + i + 1] * p[k * n];
                norm += p[k * n] * p[k * n];
            }
            int at = c * s + i + 1;
            load[c * n + i] =
                l->value[at] + dt * (l->rate[at] + dt * l->curve[at]) +
                slope[0] * state[BOUGH_ROD_U * n + i] + slope[s] * state[(BOUGH_ROD_U + 1) * n + i] +
                slope[2 * s] * angle / sqrt(norm) + slope[3 * s] * state[(BOUGH_ROD_W + 2) * n + i];
        }
    }
}

// In motion the slopes change from sample to sample and the loads do not jump.
TEST(loads_that_follow_the_motion_are_continuous) {
    static const char *const sets[] = {"bodies[2].joint.speed=1 rad/s", NULL};
    fixture f = open_turbine(sets);
    double before[2 * SEGMENTS], after[2 * SEGMENTS];
    for (int k = 0; k < 80; k++) scene_step(f.s);
    for (int k = 0; k < 5; k++) {
        whole_load(&f, 0.8 + k * period, before);
        sample(&f, 0.8 + k * period, 0.82 + k * period);
        whole_load(&f, 0.8 + k * period, after);
        double most = largest(before, 2 * SEGMENTS);
        for (int i = 0; i < 2 * SEGMENTS; i++) check_near(after[i], before[i], 0, 1e-10 * most);
    }
    close_turbine(&f);
}

TEST(constant_hold_takes_each_sample_at_once) {
    static const char *const sets[] = {"aero.hold=constant", NULL};
    fixture f = open_turbine(sets);
    double factor;
    sample(&f, ramp_end, ramp_end + period);
    const signal full[2] = {signal_of(&f, FLEXIBLE), signal_of(&f, RIGID)};
    for (int k = 0; k < SAMPLES; k++) {
        double t = k * period, share = fmin(t / ramp_end, 1);
        assert_true(sample(&f, t, t + period));
        bough_aero_link_data(f.s->aero, &factor);
        check_near(factor, share, 1e-14, 0);
        for (int b = 0; b < 2; b++) {
            signal now = signal_of(&f, b);
            for (int i = 0; i < now.n; i++) {
                check_near(now.value[i], share * full[b].value[i], 1e-12, 1e-12);
                check_near(now.rate[i], 0, 0, 0);
                check_near(now.curve[i], 0, 0, 0);
            }
        }
    }
    close_turbine(&f);
}

enum { ROWS = 50 };

// Tips of the run-up that starts in full wind, every 20 ms for a second.
static void start_suddenly(const char *rate, const char *fidelity, double tip[ROWS][3]) {
    char set[32], kind[40];
    snprintf(set, sizeof set, "aero.rate=%s", rate);
    snprintf(kind, sizeof kind, "bodies[3-5].fidelity=%s", fidelity);
    check_build_with(arena, s, "apps/turbine/runup.yaml", set, kind, "aero.ramp=[0 s, 0 s]",
                     "bodies[2].joint.speed=0.8 rad/s", // no fading of the wake
                     "simulation.macro_step=2.5 ms", "simulation.micro.step=2.5 ms", "simulation.threads=1");
    for (int k = 0; k < ROWS; k++) {
        bough_quaternion p;
        for (int i = 0; i < 8; i++) scene_step(s);
        bough_simulation_update(s);
        bough_vec3 x = bough_simulation_beam_tip(s, bough_simulation_beam(s, 3), &p);
        tip[k][0] = x.x, tip[k][1] = x.y, tip[k][2] = x.z;
    }
}

static double furthest(double (*a)[3], double (*b)[3]) {
    double most = 0;
    for (int k = 0; k < ROWS; k++) {
        bough_vec3 d = {a[k][0] - b[k][0], a[k][1] - b[k][1], a[k][2] - b[k][2]};
        most = fmax(most, bough_norm(d));
    }
    return most;
}

// What samples leave out falls by the third order of their period, from 25 to 100 Hz; straight lines to
// extrapolated values erred by 6.6 mm at 50 Hz and by the second order.
static void check_sampling(const char *fidelity, double most, double falls) {
    static const char *const rate[] = {"25 Hz", "50 Hz", "100 Hz", "400 Hz"};
    static double tip[4][ROWS][3];
    double off[3];
    for (int k = 0; k < 4; k++) start_suddenly(rate[k], fidelity, tip[k]);
    for (int k = 0; k < 3; k++) {
        off[k] = furthest(tip[k], tip[3]);
        print_message("%s: tip: %.2e m at %s\n", fidelity, off[k], rate[k]);
    }
    assert_true(off[1] < most && off[0] > falls * off[2]);
}

TEST(sampling_errs_by_the_third_order) {
    check_sampling("rod", 5e-4, 32);
    check_sampling("modal", 1.05e-3, 16); // whose loads do not follow the motion between samples
}

// Samples come every fourth macro step, here, and what they leave stays until the next.
TEST(loads_are_sampled_at_their_rate) {
    static const char *const sets[] = {"simulation.macro_step=5 ms", NULL};
    fixture f = open_turbine(sets);
    for (int k = 0; k < 20; k++) {
        scene_step(f.s);
        check_near(signal_of(&f, FLEXIBLE).start, k / 4 * period, 1e-14, 1e-15);
        check_near(signal_of(&f, RIGID).start, k / 4 * period, 1e-14, 1e-15);
    }
    close_turbine(&f);
}

// From the saved row samples repeat to the bit, and at once the loads are those of before.
TEST(samples_repeat_from_saved) {
    static const char *const sets[] = {"aero.dynamic_stall=hgm", "aero.induction.inflow=oye", NULL};
    fixture f = open_turbine(sets);
    for (int k = 0; k < 4; k++) sample(&f, k * period, (k + 1) * period);
    bough_snapshot room = {BOUGH_SNAPSHOT_MEASURE, NULL, 0};
    f.load.snapshot(f.load.self, &room);
    char *saved = calloc(1, room.used);
    signal before[2], first[2];
    f.load.snapshot(f.load.self, &(bough_snapshot){BOUGH_SNAPSHOT_SAVE, saved, 0});
    for (int b = 0; b < 2; b++) before[b] = signal_of(&f, b);
    for (int round = 0; round < 2; round++) {
        sample(&f, 4 * period, 5 * period);
        sample(&f, 5 * period, 6 * period);
        for (int b = 0; b < 2; b++) {
            signal now = signal_of(&f, b);
            if (round == 0) first[b] = now;
            assert_memory_equal(now.value, first[b].value, (size_t)now.n * sizeof(double));
            assert_memory_equal(now.rate, first[b].rate, (size_t)now.n * sizeof(double));
        }
        f.load.snapshot(f.load.self, &(bough_snapshot){BOUGH_SNAPSHOT_RESTORE, saved, 0});
        for (int b = 0; b < 2; b++) {
            signal now = signal_of(&f, b);
            assert_memory_equal(now.value, before[b].value, (size_t)now.n * sizeof(double));
            check_near(now.start, 3 * period, 0, 0);
        }
    }
    free(saved);
    close_turbine(&f);
}

// Inductions in balance that are kept are those that are found again, where inflow and stall go on.
TEST(memory_goes_on_alike_where_the_motion_is_known) {
    static const char *const sets[] = {"aero.dynamic_stall=hgm", "aero.induction.inflow=oye",
                                       "bodies[2].joint.speed=1 rad/s", NULL};
    fixture f = open_turbine(sets);
    bough_aero_link *aero = f.s->aero;
    const bough_rotor *rotor = bough_aero_link_rotor(aero);
    size_t n = (size_t)bough_rotor_memory_size(rotor);
    int *row = calloc(n, sizeof *row), n_state = bough_rotor_memory_states(rotor, row);
    double *before = calloc(3 * n, sizeof *before), *after = before + n;
    signal found[2];
    bough_aero_link_continue(aero, 0.3, true);
    bough_aero_link_memory(aero, BOUGH_SNAPSHOT_SAVE, before);
    before[0] = 0.25; // the time from which it goes on, away from equilibrium
    for (int i = 0; i < n_state; i++) before[row[i]] += 0.01;
    for (size_t k = 0; k < 2; k++) {
        bough_aero_link_memory(aero, BOUGH_SNAPSHOT_RESTORE, before);
        bough_aero_link_continue(aero, 0.3, k == 0);
        bough_aero_link_memory(aero, BOUGH_SNAPSHOT_SAVE, after + k * n);
        found[k] = signal_of(&f, FLEXIBLE);
    }
    assert_memory_equal(after, after + n, n * sizeof *after);
    assert_memory_equal(found[0].value, found[1].value, sizeof found[0].value);
    // without loads
    bough_aero_link_memory(aero, BOUGH_SNAPSHOT_RESTORE, before);
    bough_aero_link_remember(aero, 0.3, true);
    bough_aero_link_memory(aero, BOUGH_SNAPSHOT_SAVE, after);
    assert_memory_equal(after, after + n, n * sizeof *after);
    bough_aero_link_remember(aero, 0.4, true);
    found[0] = signal_of(&f, FLEXIBLE);
    assert_memory_equal(found[0].value, found[1].value, sizeof found[0].value);
    check_near(found[0].start, 0.3, 0, 0);
    int changed = 0;
    for (int i = 0; i < n_state; i++) changed += after[row[i]] != before[row[i]];
    assert_true(3 * changed > n_state);
    free(row);
    free(before);
    close_turbine(&f);
}

// At every time of a sample the results are those of that time, before the loads act.
TEST(results_are_of_their_own_time) {
    static const char *const sets[] = {"bodies[2].joint.speed=1 rad/s", NULL};
    fixture f = open_turbine(sets);
    double factor, before = 0;
    for (int k = 0; k < 4; k++) {
        double thrust = bough_aero_link_data(f.s->aero, &factor)->thrust;
        check_near(factor, k * period / ramp_end, 1e-12, 1e-15);
        assert_true(fabs(thrust - before) > 1e-6 * fabs(thrust));
        bough_aero_link_renew(f.s->aero);
        sample(&f, k * period, (k + 1) * period);
        check_near(bough_aero_link_data(f.s->aero, &factor)->thrust, thrust, 1e-14, 0);
        before = thrust;
        for (int step = 0; step < 2; step++) scene_step(f.s);
    }
    close_turbine(&f);
}

TEST(blades_want_one_mesh) {
    scene_refused(
        turbine, "bodies[4].rod.segments=10",
        "--set: rod.segments: blades blade1 and blade2 have 12 and 10 segments; the aerodynamics needs the same mesh on all blades");
}
