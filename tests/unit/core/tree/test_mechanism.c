// Mechanisms of rigid bodies as whole scenes: from the file to the channels.
#include "apps/bough/results/channels.h"
#include "core/base/rotation.h"
#include "cosim/analysis/stability.h"
#include "tests/unit/built_scene.h"
#include "tests/unit/tree_measure.h"

#include <dirent.h>
#include <unistd.h>

static void run(built *f, int steps) {
    for (int k = 0; k < steps; k++) scene_step(f->s);
}

TEST(joints_of_several_axes_start_and_are_recorded) {
    built f = built_open("tests/data/scenes/joints.yaml", no_sets);
    const double degree = acos(-1.0) / 180;
    check_near(channel(&f, "forkAng1Pos"), 90, 1e-14, 0);
    check_near(channel(&f, "forkAng2Pos"), 30, 1e-14, 0);
    check_near(channel(&f, "forkAng2Vel"), -1 / degree, 1e-14, 0);
    check_near(channel(&f, "pistonPos"), -1, 0, 0);
    check_near(channel(&f, "pistonAngPos"), 40, 1e-14, 0);
    check_near(channel(&f, "pistonAngVel"), 10 / degree, 1e-14, 0);
    check_near(channel(&f, "puck1Vel"), 3, 1e-14, 0);
    check_near(channel(&f, "puck2Vel"), 4, 1e-14, 0);
    // the turn about x takes the fork's y to the ground's z
    const bough_frame *piston = &f.s->tree->bodies[tree_find_body(f.s->tree, "piston")];
    bough_vec3 x = bough_tree_frame_pose(f.s->view, piston).position;
    check_near(x.x, -sin(30 * degree), 1e-14, 0);
    check_near(x.y, cos(30 * degree), 1e-14, 0);
    check_near(x.z, 5, 1e-14, 0);
    run(&f, 50);
    double t = 0.5, g = 9.80665 * sin(30 * degree);
    check_near(channel(&f, "puck1Pos"), 1 + 3 * t, 1e-6, 0);
    check_near(channel(&f, "puck2Pos"), 2 + 4 * t - 0.5 * g * t * t, 1e-6, 0);
    check_near(channel(&f, "puck2Vel"), 4 - g * t, 1e-6, 0);
    check_near(channel(&f, "puckAngPos"), 90 + 5 * t / degree, 1e-6, 0);
}

// The balance from rest at 0 towards 40°, and the slider, which its stop keeps from going further.
TEST(sprung_joints_move_by_themselves) {
    built f = built_open("tests/data/scenes/springs.yaml", no_sets);
    double delta = 0.4, omega = sqrt(16 - delta * delta), furthest = 0, t = 1.5;
    while (f.s->master->time < t - 1e-9) {
        run(&f, 1);
        furthest = fmax(furthest, channel(&f, "sliderPos"));
    }
    double turn = cos(omega * t) + delta / omega * sin(omega * t);
    check_near(channel(&f, "balancePos"), 40 * (1 - exp(-delta * t) * turn), 1e-6, 0);
    assert_true(furthest > 0.155 && furthest < 0.17); // 0.195 without the stop
}

// 8 N m until 0.4 s, falling to nothing at 1 s, on 4 kg m²; every time of the table is a step's end.
TEST(joint_loads_follow_their_table) {
    built f = built_open("tests/data/scenes/springs.yaml", no_sets);
    const double degree = acos(-1.0) / 180;
    assert_int_equal(f.s->master->n_event, 3);
    check_near(f.s->master->event[0], 0.205, 1e-14, 0);
    while (f.s->master->time < 0.4 - 1e-9) run(&f, 1);
    check_near(channel(&f, "wheelVel") * degree, 2 * 0.4, 1e-6, 0);
    while (f.s->master->time < 1.5) run(&f, 1);
    check_near(channel(&f, "wheelVel") * degree, 2 * 0.4 + 2 * 0.3, 1e-6, 0);
}

// The planar joint's normal is y: its first axis is z, its second x.
TEST(elastic_pendulum_passes_the_reference) {
    built f = built_open("apps/mechanisms/elastic-pendulum.yaml", no_sets);
    run(&f, 100);
    check_near(channel(&f, "bob2Pos"), -0.9801969361, 0, 1e-6);
    check_near(channel(&f, "bob1Pos"), -0.6150553214, 0, 1e-6);
    run(&f, 100);
    check_near(channel(&f, "bob2Pos"), -0.1744689353, 0, 1e-6);
    check_near(channel(&f, "bob1Pos"), -1.209469319, 0, 1e-6);
    double length = hypot(-0.1744689353, -1.209469319);
    check_near(channel(&f, "cordLen"), length, 0, 1e-6);
    check_near(channel(&f, "cordFrc"), 100 * (length - 1), 0, 1e-4);
}

// Bodies in a row keep the place of the first in the list and hang one on the other.
TEST(bodies_in_a_row_hang_on_each_other) {
    static const char *const sets[] = {"bodies[0].repeat=3", "bodies[1].joint.parent=rod3",
                                       "bodies[1].repeat=1", "markers[0].body=link1", NULL};
    check_arena(arena);
    bough_scene *s = scene_read(arena, "apps/mechanisms/chain.yaml", sets);
    static const char *const names[] = {"rod1", "link1", "rod2", "rod3"};
    static const int parents[] = {BOUGH_GROUND, 3, 0, 2};
    assert_int_equal(s->n_body, 4);
    for (int i = 0; i < 4; i++) {
        assert_string_equal(s->body[i].name, names[i]);
        assert_int_equal(s->body[i].joint.parent, parents[i]);
    }
}

// Every method, Radau where none is named, passes the positions in which the loops could branch, where all
// rods lie on one line: at 0.67 s, and about twenty times to 10 s. Of IFToMM's benchmark A02.
TEST(windows_pass_their_singular_positions) {
    static const struct {
        const char *set;
        double allowed; // [m]
    } methods[] = {{"simulation.master.rtol=1e-6", 3e-5},
                   {"simulation.master.rtol=1e-7", 3e-5},
                   {"simulation.master.rtol=1e-8", 3e-5},
                   {"simulation.master.rtol=1e-9", 3e-5},
                   {"simulation.master.rtol=8e-10", 3e-5},
                   {"simulation.master.rtol=1e-10", 3e-5},
                   {"simulation.master={solver: cvode-bdf, rtol: 1e-9}", 3e-5},
                   {"simulation.master={solver: cvode-bdf, rtol: 1e-11}", 3e-5},
                   {"simulation.master={solver: ida, rtol: 1e-7}", 3e-4},
                   {"simulation.master={solver: rosenbrock, rtol: 1e-6}", 1e-3}};
    for (size_t k = 0; k < sizeof methods / sizeof *methods; k++) {
        built f = built_open("apps/mechanisms/four-bar.yaml", sets_of(methods[k].set));
        run(&f, 1000);
        check_near(channel(&f, "topX"), 0.328458111534, 0, methods[k].allowed);
        check_near(channel(&f, "topZ"), 0.944518538181, 0, methods[k].allowed);
        assert_true(bough_member_statistics(bough_scheme_whole(f.s->master->coupling)).steps < 100000);
        bough_arena_destroy(f.arena);
    }
}

// However far its tolerance lets the loop open there, a parallelogram does not fold where its bars lie on one
// line: the rocker turns beside the crank.
TEST(parallelograms_do_not_fold) {
    static const char *const tolerances[] = {"1e-5", "5e-5", "3e-4", "1e-3"};
    for (size_t k = 0; k < sizeof tolerances / sizeof *tolerances; k++) {
        char rtol[64];
        snprintf(rtol, sizeof rtol, "simulation.master.rtol=%s", tolerances[k]);
        built f = built_open("tests/data/scenes/parallelogram.yaml", sets_of(rtol));
        run(&f, 60);
        check_near(remainder(channel(&f, "rockerPos") - channel(&f, "crankPos"), 360), 0, 0, 0.1);
        bough_arena_destroy(f.arena);
    }
}

// What keeps a loop closed may be a million times less mobile in one direction than in another. The
// crank's pin is at 0.2 m, the rod 1 m long.
TEST(light_rods_keep_their_length) {
    built f = built_open("tests/data/scenes/light-rod.yaml", no_sets);
    double turn = BOUGH_PI / 180;
    for (int k = 0; k < 10; k++) {
        run(&f, 10);
        double angle = turn * channel(&f, "crankPos"), across = 0.2 * sin(angle);
        double height = 0.2 * cos(angle) + sqrt(1 - across * across);
        check_near(channel(&f, "sliderPos") + 1.1856, height, 0, 1e-4);
    }
}

static void check_closed(built *f, double allowed) {
    double value, rate;
    bough_simulation_update(f->s);
    tree_closure_error(f->s->tree, f->s->view, 0, &value, &rate);
    check_near(value, 0, 0, allowed);
    check_near(rate, 0, 0, 10 * allowed);
}

// A rod on a closed loop under every scheme and either master, against the monolithic solution.
TEST(closed_loops_run_under_every_scheme) {
    static const struct {
        const char *scheme;
        double allowed; // of the crank's angle, in degrees
    } schemes[] = {{"monolithic", 0},
                   {"gauss-seidel", 0.05},
                   {"extrapolated", 0.01},
                   {"iterated", 0.01},
                   {"ramp", 0.01}};
    double reference = 0;
    for (int k = 0; k < 5; k++) {
        for (int solver = 0; solver < 2; solver++) {
            char scheme[64];
            snprintf(scheme, sizeof scheme, "simulation.coupling.scheme=%s", schemes[k].scheme);
            const char *sets[] = {
                scheme, "simulation.macro_step=1 ms", "simulation.micro.rtol=1e-8",
                solver == 0 ? "simulation.master.solver=ida" : "simulation.master.solver=radau5", NULL};
            built f = built_open("tests/data/scenes/closed.yaml", sets);
            check_near(channel(&f, "crankVel"), 2 * 180 / acos(-1.0), 1e-12, 0); // the others follow
            check_closed(&f, 1e-9);
            run(&f, 200);
            check_closed(&f, 1e-6);
            double angle = channel(&f, "crankPos");
            if (k == 0) reference = angle;
            check_near(angle, reference, 0, schemes[k].allowed);
            bough_arena_destroy(f.arena);
        }
    }
}

// A loop through a rod, from its equilibrium: the beam's x is down at the tip.
TEST(propped_beams_rest_on_their_closure) {
    built f = built_open("tests/data/scenes/prop.yaml", no_sets);
    double prop = 0.375 * 6 * 9.81; // Euler and Bernoulli; shear and 24 segments add 1e-4
    check_near(channel(&f, "propFx"), -prop, 2e-4, 0);
    run(&f, 50);
    check_near(channel(&f, "propFx"), -prop, 2e-4, 0);
    check_closed(&f, 1e-9);
}

// Where a closed loop with a rod on it rests is found, and it stays there.
TEST(closed_loops_come_to_rest) {
    const char *const still[] = {"bodies[0].joint.speed=0", "simulation.initial=equilibrium", NULL};
    built f = built_open("tests/data/scenes/closed.yaml", still);
    check_closed(&f, 1e-9);
    double angle = channel(&f, "crankPos");
    assert_true(fabs(angle - 20) > 90); // it has swung through
    run(&f, 20);
    check_near(channel(&f, "crankPos"), angle, 0, 1e-7);
}

// A stage that ended after one iteration of Newton's method would err by ten times as much.
TEST(stages_at_a_loose_tolerance_converge) {
    const char *const loose[] = {"simulation.master={solver: arkode-esdirk, rtol: 1e-4}", NULL};
    const char *const tight[] = {"simulation.master={solver: ida, rtol: 1e-9}", NULL};
    built f = built_open("apps/mechanisms/four-bar.yaml", loose);
    built truth = built_open("apps/mechanisms/four-bar.yaml", tight);
    double off = 0, most = 0;
    for (double t = 0.1; t < 3; t += 0.1) {
        run_until(&f, t);
        run_until(&truth, t);
        double exact = channel(&truth, "rightVel");
        off = fmax(off, fabs(channel(&f, "rightVel") - exact));
        most = fmax(most, fabs(exact));
    }
    print_message("off by %.2g of %.3g\n", off, most);
    assert_true(off < 1e-4 * most);
}

// With a crank, coupler and rocker that weigh little against the rod the frozen coupling grows.
TEST(stability_of_closed_loops_is_judged) {
    static const char *const names[] = {"frozen", "ramp"};
    const char *const *light = sets_of("bodies[0].mass=0.003", "bodies[0].inertia=[1e-4, 1e-4, 2e-5]",
                                       "bodies[1].mass=0.002", "bodies[1].inertia=[2e-5, 2e-4, 2e-4]",
                                       "bodies[2].mass=0.003", "bodies[2].inertia=[1e-4, 1e-4, 2e-5]");
    for (int k = 0; k < 2; k++) {
        built f = built_open("tests/data/scenes/closed.yaml", light);
        bough_scheme_options options = f.s->master->coupling->options;
        bough_stability stability;
        options.name = names[k];
        check_ok(bough_stability_judge(f.s->master->assembly, &options, 5e-3, &stability));
        print_message("%s: growth %.3g 1/s\n", names[k], stability.growth);
        assert_true((stability.growth > 1) == (k == 0));
        bough_arena_destroy(f.arena);
    }
}

// -- mechanisms in other directions ---------------------------------------------------------------

static const double turns[][3] = {{0, 0, 1}, {37, -112, 64}, {-141, 23, 178}}; // [deg] about x, y, z in turn

static bough_mat3 rotation_of(const double *turn) {
    const double degree = acos(-1.0) / 180;
    bough_mat3 r = bough_mat3_identity();
    for (int k = 0; k < 3; k++) {
        bough_vec3 about = bough_v3(k == 0, k == 1, k == 2);
        bough_quaternion q = bough_quaternion_exponential(bough_scale(turn[k] * degree, about));
        r = bough_mat3_product(r, bough_rotation_matrix(q));
    }
    return r;
}

static void write_line(FILE *out, const char *line, bough_vec3 gravity, const double *turn) {
    if (strncmp(line, "gravity:", 8) == 0) {
        fprintf(out, "gravity: [%.17g, %.17g, %.17g]\n", gravity.x, gravity.y, gravity.z);
        return;
    }
    for (const char *ground; (ground = strstr(line, ": ground")) != NULL; line = ground + strlen(": ground"))
        fprintf(out, "%.*s: base", (int)(ground - line), line);
    fputs(line, out);
    if (strcmp(line, "bodies:\n") != 0) return;
    fprintf(out,
            "  - {name: base, fidelity: rigid, mass: 1, joint: {kind: fixed, parent: ground,\n"
            "     placement: [rotate x %.17g deg, rotate y %.17g deg, rotate z %.17g deg]}}\n",
            turn[0], turn[1], turn[2]);
}

// The scene on a base that is turned against the ground, and gravity with it, into `name`.
static void write_turned(const char *path, const double *turn, const char *name) {
    char line[512], file[512];
    snprintf(file, sizeof file, BOUGH_SOURCE_DIR "/%s", path);
    FILE *in = fopen(file, "r"), *out = fopen(name, "w");
    assert_true(in != NULL && out != NULL);
    bough_vec3 down = strstr(path, "squeezer") ? bough_v3(0, 0, 0) : bough_v3(0, 0, -9.81);
    down = bough_mat3_mul(rotation_of(turn), down);
    while (fgets(line, sizeof line, in)) write_line(out, line, down, turn);
    fclose(in);
    fclose(out);
}

static built open_file(const char *path) {
    bough_arena *arena = check_memory();
    bough_simulation *s = NULL;
    check_ok(bough_simulation_build(arena, scene_read_file(arena, path, no_sets), &s));
    return built_from(arena, s);
}

// Whether the channel is the first of a vector in ground axes; all others are seen from a joint or a body.
static bool starts_vector(const bough_channels *list, int i) {
    const char *name = list->channel[i].name;
    size_t n = strlen(name);
    bool direction = n > 5 && strncmp(name + n - 5, "Dir", 3) == 0 && name[n - 1] == 'x';
    return i + 2 < list->count && (name[n - 1] == 'X' || direction);
}

static void check_same(built *still, built *turned, bough_mat3 r) {
    double a[64], b[64];
    assert_int_equal(still->channels.count, turned->channels.count);
    assert_true(still->channels.count <= 64);
    bough_simulation_update(still->s), bough_simulation_update(turned->s);
    bough_channels_sample(&still->channels, still->s->master->time, a);
    bough_channels_sample(&turned->channels, turned->s->master->time, b);
    for (int i = 0; i < still->channels.count; i++) {
        double expected[3] = {a[i]};
        int n = starts_vector(&still->channels, i) ? 3 : 1;
        if (n == 3) bough_v3_store(bough_mat3_mul(r, bough_v3(a[i], a[i + 1], a[i + 2])), expected);
        for (int k = 0; k < n; k++) {
            if (!(fabs(b[i + k] - expected[k]) < 1e-5 * (1 + fabs(expected[k]))))
                print_error("channel %s\n", still->channels.channel[i + k].name);
            check_near(b[i + k], expected[k], 1e-5, 1e-5);
        }
        i += n - 1;
    }
}

// The motion of a mechanism does not depend on the direction of its ground.
static void check_turned(const char *path, const char *folder) {
    char name[SCRATCH_PATH];
    snprintf(name, sizeof name, "%s/turned.yaml", folder);
    for (int k = 0; k < (int)(sizeof turns / sizeof *turns); k++) {
        print_message("%s turned by %g, %g, %g deg\n", path, turns[k][0], turns[k][1], turns[k][2]);
        write_turned(path, turns[k], name);
        built still = built_open(path, no_sets), turned = open_file(name);
        assert_int_equal(still.s->tree->closure_rank, turned.s->tree->closure_rank);
        check_same(&still, &turned, rotation_of(turns[k]));
        run(&still, 40), run(&turned, 40);
        check_same(&still, &turned, rotation_of(turns[k]));
        bough_arena_destroy(still.arena);
        bough_arena_destroy(turned.arena);
    }
    remove(name);
}

TEST(mechanisms_move_alike_in_every_direction) {
    char folder[SCRATCH_NAME], path[512];
    assert_non_null(mkdtemp(scratch_name(folder)));
    DIR *shipped = opendir(BOUGH_SOURCE_DIR "/apps/mechanisms");
    assert_non_null(shipped);
    for (const struct dirent *entry; (entry = readdir(shipped)) != NULL;) {
        if (entry->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "apps/mechanisms/%s", entry->d_name);
        check_turned(path, folder);
    }
    closedir(shipped);
    check_turned("tests/data/scenes/closed.yaml", folder); // assembled from near, with a rod
    check_turned("tests/data/scenes/prop.yaml", folder);   // from an equilibrium
    rmdir(folder);
}
