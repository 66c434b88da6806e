// The macro loop: its times, sampled loads, threads, and what it refuses.
#include "tests/unit/two_mass.h"

static bough_master_def definition(double macro_step, double duration) {
    bough_master_def def = bough_master_def_default();
    def.macro_step = macro_step;
    def.duration = duration;
    return def;
}

static bough_status run(bough_master *m) {
    bough_status status = bough_ok();
    while (bough_is_ok(&status) && !bough_master_done(m)) status = bough_step(m);
    return status;
}

// An event beside a grid point, as .3 beside 3 times .1, is its own time, which every grid shares.
TEST(steps_end_on_events_and_on_the_duration) {
    const double event[] = {.45, .3, .3, 7}, expected[] = {.1, .2, .3, .4, .45, .5, .55};
    bough_master_def def = definition(.1, .55);
    def.event = event;
    def.n_event = 4;
    bough_two_mass m = bough_two_mass_default();
    check_ok(bough_two_mass_build(check_memory(), &m, def));
    for (int k = 0; k < 7; k++) {
        assert_false(bough_master_done(m.master));
        check_ok(bough_step(m.master));
        check_near(m.master->time, expected[k], 0, 1e-15);
        bool at_event = k == 2 || k == 4;
        assert_int_equal(m.master->at_event, at_event);
        if (at_event) assert_true(m.master->time == expected[k]);
    }
    assert_true(bough_master_done(m.master));
}

// Halves among the first 64 steps of .01 `scale` s of a run of a hundred, and after them; changes of length.
static int count_halves(double scale, int *later, int *changes) {
    double last = 0;
    const double event[] = {.703 * scale}, h = .005 * scale;
    int halves = 0;
    bough_master_def def = definition(.01 * scale, scale);
    def.halves = true;
    def.event = event;
    def.n_event = 1;
    bough_two_mass m = bough_two_mass_default();
    check_ok(bough_two_mass_build(check_memory(), &m, def));
    *later = *changes = 0;
    while (!bough_master_done(m.master)) {
        double begun = m.master->time;
        check_ok(bough_step(m.master));
        *changes += fabs(m.master->time - begun - last) > 0.1 * h;
        last = m.master->time - begun;
        double half = m.master->time / h;
        bool between = fabs(half / 2 - round(half / 2)) > 1e-6;
        if (!between || fabs(half * h - event[0]) < 1e-6 * scale) continue;
        check_near(half, round(half), 1e-9, 0);
        if (half < 128) halves++;
        if (half > 128) ++*later;
    }
    return halves;
}

// Four of every eight of the first 64, all where members take several steps in each, four of every 32 later,
// and the one after an event before its middle; at the times of a run of half the steps.
TEST(some_steps_are_taken_in_halves) {
    int later, changes;
    int few = count_halves(0.1, &later, &changes);
    print_message("%d of the first, %d later, %d changes\n", few, later, changes);
    assert_true(few >= 32 && few <= 36);
    assert_int_equal(later, 9);
    assert_true(changes <= 30);
    assert_int_equal(count_halves(100, &later, &changes), 64);
    assert_int_equal(later, 9);
}

typedef struct samples {
    int count;
    double time[16], next[16];
} samples;

static bough_status sample(void *self, double t, double t_next, bool *jumped) {
    samples *s = self;
    s->time[s->count] = t;
    s->next[s->count++] = t_next;
    *jumped = false;
    return bough_ok();
}

TEST(loads_are_sampled_at_their_period) {
    samples taken = {0};
    const double event = .25;
    bough_sampled_load load = {.period = .2, .self = &taken, .sample = sample};
    bough_master_def def = definition(.1, .7);
    def.load = &load;
    def.event = &event;
    def.n_load = def.n_event = 1;
    bough_two_mass m = bough_two_mass_default();
    bough_two_mass_build(check_memory(), &m, def);
    check_ok(run(m.master));
    assert_int_equal(taken.count, 4);
    for (int k = 0; k < 4; k++) {
        check_near(taken.time[k], .2 * k, 0, 1e-15);
        check_near(taken.next[k], .2 * (k + 1), 0, 1e-15);
    }
}

// -- one leader, three followers ------------------------------------------------------------------

enum { N_FOLLOWER = 3 };

typedef struct star {
    bough_oscillator mass[1 + N_FOLLOWER];
    bough_member member[1 + N_FOLLOWER];
    bough_arena *arena;
    bough_master *master;
} star;

static bough_status star_build(star *s, bough_master_def def) {
    bough_assembly_member part[1 + N_FOLLOWER];
    bough_connection connection[2 * N_FOLLOWER];
    for (int i = 0; i < N_FOLLOWER; i++) {
        bough_oscillator *follower = &s->mass[1 + i];
        *follower = bough_oscillator_motion_in((bough_spring_mass){1 + i, 20, .3}, 10, .5, .5 - .2 * i);
        s->mass[0] = bough_oscillator_force_in((bough_spring_mass){1, 10, .2}, 1, 0);
        oscillator_widen(&s->mass[0], follower);
        connection[2 * i] = (bough_connection){.to = 1 + i, .count = 3, .kinematic = true};
        connection[2 * i + 1] = (bough_connection){.from = 1 + i, .to_offset = i, .count = 1};
    }
    for (int i = 0; i <= N_FOLLOWER; i++) {
        bough_oscillator_member(&s->mass[i], i ? "follower" : "leader", &s->member[i]);
        part[i] = (bough_assembly_member){&s->member[i], i > 0};
    }
    def.assembly = (bough_assembly_def){
        .n_member = 1 + N_FOLLOWER, .member = part, .n_connection = 2 * N_FOLLOWER, .connection = connection};
    s->arena = check_memory();
    return bough_master_build(s->arena, &def, &s->master);
}

static star star_run(const char *scheme, double macro_step, int threads) {
    star s;
    bough_master_def def = definition(macro_step, 4);
    def.scheme.name = scheme;
    def.scheme.integrator.rtol = 1e-10;
    check_arena(arena);
    def.pool = bough_pool_create(arena, threads);
    bough_status status = star_build(&s, def);
    if (bough_is_ok(&status)) status = run(s.master);
    if (!bough_is_ok(&status)) fail_msg("%s: %s", scheme, status.message);
    bough_arena_destroy(s.arena);
    return s;
}

TEST(threads_do_not_change_a_bit) {
    const char *name;
    for (int k = 0; (name = bough_scheme_name(k)) != NULL; k++) {
        star one = star_run(name, .02, 1);
        for (int threads = 2; threads <= 8; threads += threads < 3 ? 1 : 5) {
            star many = star_run(name, .02, threads);
            for (int i = 0; i <= N_FOLLOWER; i++) {
                assert_memory_equal(one.mass[i].y, many.mass[i].y, sizeof one.mass[i].y);
            }
        }
    }
}

static double star_distance(const star *a, const star *b) {
    double worst = 0;
    for (int i = 0; i <= N_FOLLOWER; i++) {
        worst = fmax(worst, fabs(a->mass[i].y[0] - b->mass[i].y[0]));
    }
    return worst;
}

// Followers with more inputs than the leader has states, rates of motion held, several bodies.
TEST(schemes_converge_to_the_monolithic_run) {
    static const struct {
        const char *name;
        double order, error;
    } expected[] = {
        {"ramp", 3, 1e-4}, {"gauss-seidel", 1, 6e-3}, {"extrapolated", 2, 3e-4}, {"frozen", 1, 6e-3}};
    star exact = star_run("monolithic", .02, 1);
    for (int k = 0; k < 4; k++) {
        star coarse = star_run(expected[k].name, .02, 1), fine = star_run(expected[k].name, .01, 1);
        double e1 = star_distance(&coarse, &exact), e2 = star_distance(&fine, &exact);
        assert_true(e1 < expected[k].error);
        check_near(log2(e1 / e2), expected[k].order, 0, .25);
    }
}

TEST(algebraic_loops_are_refused) {
    bough_oscillator mass[2];
    bough_member member[2];
    bough_assembly_member part[2];
    bough_connection connection[2];
    for (int i = 0; i < 2; i++) {
        mass[i] = bough_oscillator_motion_in((bough_spring_mass){1, 20, .3}, 10, .5, 0);
        mass[i].n_output = 2;
        bough_oscillator_member(&mass[i], "mass", &member[i]);
        part[i] = (bough_assembly_member){&member[i], i};
        connection[i] = (bough_connection){.from = i, .to = 1 - i, .count = 2};
    }
    check_arena(arena);
    bough_assembly *assembly;
    bough_assembly_def def = {2, part, 2, connection};
    check_fails(bough_assembly_build(arena, &def, &assembly), BOUGH_INVALID, "algebraic loop");
}
