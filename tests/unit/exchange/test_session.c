// The library's public face.
#include "tests/unit/check.h"

#include "apps/bough/exchange/bough.h"

#include "tests/unit/scratch_name.h"

#include <locale.h>
#include <pthread.h>

static const char pendulum[] = BOUGH_SOURCE_DIR "/apps/mechanisms/pendulum.yaml";

TEST(steps_to_the_end_and_reads) {
    const char *const set[] = {"simulation.duration=0.5 s"};
    bough_session *s = bough_session_open(pendulum, set, 1);
    assert_int_equal(bough_session_code(s), BOUGH_SESSION_OK);
    assert_string_equal(bough_session_error(s), "");
    assert_true(bough_session_count(s) > 1);
    int channel = 0;
    assert_int_equal(bough_session_find(s, bough_session_name(s, channel)), channel);
    assert_true(bough_session_unit(s, channel)[0] != 0);
    double first = bough_session_read(s, channel);
    int steps = 0;
    while (bough_session_step(s) == BOUGH_SESSION_OK) steps++;
    assert_true(steps > 1);
    check_near(bough_session_time(s), 0.5, 1e-12, 0);
    check_near(bough_session_duration(s), 0.5, 1e-12, 0);
    check_near(bough_session_macro_step(s), 0.01, 1e-12, 0);
    assert_true(fabs(bough_session_read(s, channel) - first) > 1e-3);
    assert_int_equal(bough_session_step(s), BOUGH_SESSION_DONE);
    assert_int_equal(bough_session_code(s), BOUGH_SESSION_OK);
    bough_session_close(s);
}

TEST(errors_are_reported) {
    const char *const set[] = {"simulation.duration=-1 s", "simulation.macro_step=2 m"};
    bough_session *s = bough_session_open(pendulum, set, 2);
    assert_int_equal(bough_session_code(s), BOUGH_SESSION_INVALID);
    assert_non_null(strstr(bough_session_error(s), "duration"));
    assert_non_null(strstr(bough_session_error(s), "macro_step")); // both of them
    assert_int_equal(bough_session_step(s), BOUGH_SESSION_INVALID);
    assert_true(isnan(bough_session_time(s)));
    assert_true(isnan(bough_session_read(s, 0)));
    assert_int_equal(bough_session_find(s, "any"), -1);
    bough_session_close(s);
    s = bough_session_open("/nowhere/scene.yaml", NULL, 0);
    assert_int_not_equal(bough_session_code(s), BOUGH_SESSION_OK);
    assert_non_null(strstr(bough_session_error(s), "/nowhere/scene.yaml"));
    bough_session_close(s);
}

// Whether numbers of this program now have a comma: a locale of the system, or one that is made here.
static bool use_comma(void) {
    char folder[SCRATCH_NAME], command[2 * SCRATCH_PATH];
    if (setlocale(LC_ALL, "de_DE.UTF-8")) return true;
    assert_non_null(mkdtemp(scratch_name(folder)));
    snprintf(command, sizeof command, "localedef -i de_DE -f UTF-8 %s/de_DE.UTF-8 >%s/log 2>&1", folder,
             folder);
    bool made = system(command) == 0 && setenv("LOCPATH", folder, 1) == 0 && setlocale(LC_ALL, "de_DE.UTF-8");
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command) == 0 && made;
}

// Values, and the ranges of keys, are read with a point; the locale stays the caller's.
TEST(numbers_do_not_depend_on_the_locale) {
    if (!use_comma()) skip();
    const char *const set[] = {"simulation.duration=0.5 s", "simulation.master.rtol=0.01",
                               "loads=[{joint: bob, torque: 0, input: push}]"};
    bough_session *s = bough_session_open(pendulum, set, 3);
    assert_string_equal(bough_session_error(s), "");
    check_near(bough_session_duration(s), 0.5, 1e-12, 0);
    assert_int_equal(bough_session_set_text(s, 0, "1.5 N m"), BOUGH_SESSION_OK);
    check_near(bough_session_input_value(s, 0), 1.5, 1e-12, 0);
    assert_string_equal(localeconv()->decimal_point, ",");
    setlocale(LC_ALL, "C");
    bough_session_close(s);
}

// -- sessions without a scene ---------------------------------------------------------------------

// Every function of a session whose opening gave that code, for NULL too.
static void check_without_scene(bough_session *s, int code) {
    char copy[64];
    double pose[9];
    const char *const nothing[] = {bough_session_warning(s),       bough_session_name(s, 0),
                                   bough_session_unit(s, 0),       bough_session_input_name(s, 0),
                                   bough_session_input_unit(s, 0), bough_session_body_name(s, 0)};
    const double none[] = {bough_session_time(s),           bough_session_duration(s),
                           bough_session_macro_step(s),     bough_session_read(s, 0),
                           bough_session_input_value(s, 0), bough_session_estimate(s, 0)};
    for (int k = 0; k < 6; k++) assert_string_equal(nothing[k], "");
    for (int k = 0; k < 6; k++) assert_true(isnan(none[k]));
    assert_null(bough_session_values(s));
    assert_int_equal(bough_session_count(s) + bough_session_inputs(s), 0);
    assert_int_equal(bough_session_bodies(s) + bough_session_stations(s, 0), 0);
    assert_int_equal(bough_session_size(s), 0);
    const struct {
        const char *name;
        int code;
    } calls[] = {{"step", bough_session_step(s)},
                 {"save", bough_session_save(s, copy)},
                 {"save", bough_session_save(s, NULL)},
                 {"restore", bough_session_restore(s, copy)},
                 {"restore", bough_session_restore(s, NULL)},
                 {"poses", bough_session_poses(s, 0, pose, pose)},
                 {"set", bough_session_set(s, 0, 1)},
                 {"set", bough_session_set_text(s, 0, "1 m/s")},
                 {"set", bough_session_set_text(s, -1, NULL)}};
    for (int k = 0; k < 9; k++) assert_int_equal(calls[k].code, code);
    assert_int_equal(bough_session_find(s, "any"), -1);
    assert_int_equal(bough_session_find(s, NULL), -1);
    assert_int_equal(bough_session_input(s, "any"), -1);
    assert_int_equal(bough_session_code(s), code);
}

TEST(what_is_no_session_is_refused_in_every_call) {
    check_without_scene(NULL, BOUGH_SESSION_OTHER);
    assert_non_null(strstr(bough_session_error(NULL), "no session"));
    bough_session_close(NULL);
    static const struct {
        const char *scene, *set[2];
        int n;
        const char *message;
    } openings[] = {
        {NULL, {NULL}, 0, "no scene is given"},
        {pendulum, {"simulation.duration=1 s", NULL}, 2, "setting 2 of 2 is NULL"},
        {pendulum, {NULL}, -1, "number of settings is -1"},
        {pendulum, {"simulation.duratoin=1 s"}, 1, "did you mean 'duration'"},
        {"/nowhere/scene.yaml", {NULL}, 0, "/nowhere/scene.yaml"},
    };
    for (int k = 0; k < 5; k++) {
        bough_session *s = bough_session_open(openings[k].scene, openings[k].set, openings[k].n);
        int code = bough_session_code(s);
        assert_true(code == BOUGH_SESSION_INVALID || code == BOUGH_SESSION_OTHER);
        if (!strstr(bough_session_error(s), openings[k].message)) fail_msg("%s", bough_session_error(s));
        check_without_scene(s, code);
        bough_session_save(s, NULL);
        assert_string_equal(bough_session_error(s), "save: the scene could not be opened");
        bough_session_close(s);
    }
    bough_session *s = bough_session_open(pendulum, NULL, 2);
    assert_int_equal(bough_session_code(s), BOUGH_SESSION_INVALID);
    bough_session_close(s);
}

TEST(an_unknown_name_is_reported_with_the_nearest) {
    const char *const set[] = {"loads=[{joint: bob, torque: 0, input: push}]"};
    bough_session *s = bough_session_open(pendulum, set, 1);
    assert_int_equal(bough_session_find(s, "bobPoss"), -1);
    assert_string_equal(bough_session_error(s),
                        "the scene has no channel 'bobPoss' (did you mean 'bobPos'?)");
    assert_int_equal(bough_session_input(s, "psuh"), -1);
    assert_string_equal(bough_session_error(s), "the scene has no input 'psuh' (did you mean 'push'?)");
    assert_int_equal(bough_session_input(s, NULL), -1);
    double pose[9];
    assert_int_equal(bough_session_bodies(s), 1);
    assert_int_equal(bough_session_stations(s, 0), 1);
    assert_int_equal(bough_session_poses(s, 0, pose, pose), BOUGH_SESSION_OK);
    assert_int_equal(bough_session_poses(s, 1, pose, pose), BOUGH_SESSION_INVALID);
    assert_int_equal(bough_session_poses(s, 0, pose, NULL), BOUGH_SESSION_INVALID);
    assert_int_equal(bough_session_step(s), BOUGH_SESSION_OK);
    assert_string_equal(bough_session_error(s), "");
    assert_int_equal(bough_session_save(s, NULL), BOUGH_SESSION_INVALID);
    assert_int_equal(bough_session_restore(s, NULL), BOUGH_SESSION_INVALID);
    assert_int_equal(bough_session_set_text(s, 0, NULL), BOUGH_SESSION_INVALID);
    assert_int_equal(bough_session_set(s, 1, 0), BOUGH_SESSION_INVALID);
    assert_string_equal(bough_session_error(s), "the scene has no input of index 1: it has 1");
    bough_session_close(s);
    s = bough_session_open(pendulum, NULL, 0);
    assert_int_equal(bough_session_input(s, "push"), -1);
    assert_non_null(strstr(bough_session_error(s), "no input 'push': it declares none, as 'input: NAME'"));
    bough_session_close(s);
}

TEST(sessions_live_side_by_side) {
    bough_session *a = bough_session_open(pendulum, NULL, 0);
    bough_session *b = bough_session_open(pendulum, NULL, 0);
    for (int k = 0; k < 20; k++) bough_session_step(a);
    for (int k = 0; k < 20; k++) {
        bough_session_step(b);
        if (k == 10) bough_session_step(a);
    }
    bough_session_step(b);
    for (int i = 0; i < bough_session_count(a); i++) {
        assert_true(bough_session_read(a, i) == bough_session_read(b, i));
    }
    bough_session_close(a);
    bough_session_close(b);
}

typedef struct application_thread {
    pthread_t id;
    int threads; // of its session
    double last;
} application_thread;

// Opens, steps and reads a session of its own.
static void *run_alone(void *self) {
    application_thread *a = self;
    char threads[32];
    snprintf(threads, sizeof threads, "simulation.threads=%d", a->threads);
    const char *const set[] = {"bodies[3-5].rod.segments=8", threads};
    bough_session *s = bough_session_open(BOUGH_SOURCE_DIR "/apps/turbine/runup.yaml", set, 2);
    for (int k = 0; k < 50; k++) bough_session_step(s);
    a->last = bough_session_read(s, bough_session_find(s, "OoPDefl1"));
    bough_session_close(s);
    return NULL;
}

TEST(sessions_run_at_the_same_time) {
    enum { THREADS = 4 };
    application_thread thread[THREADS], alone = {.threads = 1};
    for (int k = 0; k < THREADS; k++) {
        thread[k].threads = k % 3 + 1;
        assert_int_equal(pthread_create(&thread[k].id, NULL, run_alone, &thread[k]), 0);
    }
    for (int k = 0; k < THREADS; k++) pthread_join(thread[k].id, NULL);
    run_alone(&alone);
    assert_true(alone.last > 0.1);
    for (int k = 0; k < THREADS; k++) assert_true(thread[k].last == alone.last);
}

// -- copies ---------------------------------------------------------------------------------------

static const char runup[] = BOUGH_SOURCE_DIR "/apps/turbine/runup.yaml";
static const char few[] = "bodies[3-5].rod.segments=8";

static void *save(bough_session *s) {
    void *copy = malloc(bough_session_size(s));
    assert_non_null(copy);
    assert_int_equal(bough_session_save(s, copy), BOUGH_SESSION_OK);
    return copy;
}

static void check_same(bough_session *a, bough_session *b) {
    assert_true(bough_session_time(a) == bough_session_time(b));
    size_t bytes = (size_t)bough_session_count(a) * sizeof(double);
    assert_memory_equal(bough_session_values(a), bough_session_values(b), bytes);
}

// A run that goes on, the same taken back later, and another session that starts there.
static void check_goes_on(const char *scene, const char *const *set, int n_set) {
    enum { BEFORE = 25, AFTER = 30 };
    bough_session *run = bough_session_open(scene, set, n_set);
    bough_session *again = bough_session_open(scene, set, n_set);
    bough_session *other = bough_session_open(scene, set, n_set);
    for (int k = 0; k < BEFORE; k++) {
        bough_session_step(run);
        bough_session_step(again);
    }
    void *copy = save(run), *same = save(again);
    for (int k = 0; k < AFTER; k++) bough_session_step(again);
    assert_int_equal(bough_session_restore(again, same), BOUGH_SESSION_OK);
    assert_int_equal(bough_session_restore(other, copy), BOUGH_SESSION_OK);
    assert_true(bough_session_time(run) > 0);
    for (int k = 0; k < AFTER; k++) {
        check_same(run, again);
        check_same(run, other);
        assert_int_equal(bough_session_step(run), BOUGH_SESSION_OK);
        bough_session_step(again);
        bough_session_step(other);
    }
    check_same(run, again);
    check_same(run, other);
    free(copy);
    free(same);
    bough_session_close(run);
    bough_session_close(again);
    bough_session_close(other);
}

TEST(restored_runs_go_on_to_the_same_bits) {
    const char *const set[] = {few, "aero.dynamic_stall=hgm", "aero.induction.inflow=oye"};
    check_goes_on(pendulum, NULL, 0);
    check_goes_on(runup, set, 3);
    check_goes_on(BOUGH_SOURCE_DIR "/apps/turbine/power.yaml", set, 1);
}

// From the same moment, one with another wind: nothing differs until the air is sampled again.
TEST(another_wind_makes_a_what_if) {
    const char *const set[] = {few, "aero.wind.speed=30 m/s"};
    bough_session *run = bough_session_open(runup, set, 1);
    bough_session *gust = bough_session_open(runup, set, 2);
    int thrust = bough_session_find(run, "RtAeroFxh");
    while (bough_session_time(run) < 1.99) bough_session_step(run);
    void *copy = save(run);
    assert_int_equal(bough_session_restore(gust, copy), BOUGH_SESSION_OK);
    check_same(run, gust);
    while (bough_session_time(run) < 2.49) {
        bough_session_step(run);
        bough_session_step(gust);
    }
    assert_true(bough_session_read(gust, thrust) > 1.3 * bough_session_read(run, thrust));
    free(copy);
    bough_session_close(run);
    bough_session_close(gust);
}

TEST(a_failed_session_is_restored) {
    const char *const set[] = {"simulation.coupling.scheme=frozen", few, "bodies[2].mass=1",
                               "bodies[2].inertia=[10, 10, 10, 0, 0, 0]", "aero.wind.input=wind"};
    bough_session *s = bough_session_open(runup, set, 5);
    void *copy = save(s);
    double end[2];
    for (int k = 0; k < 2; k++) {
        int code = BOUGH_SESSION_OK;
        while (code == BOUGH_SESSION_OK) code = bough_session_step(s);
        assert_int_equal(code, BOUGH_SESSION_FAILED);
        assert_null(bough_session_values(s));
        end[k] = bough_session_time(s);
        char why[600];
        snprintf(why, sizeof why, "%s", bough_session_error(s));
        assert_int_equal(bough_session_save(s, copy), BOUGH_SESSION_FAILED);
        assert_memory_equal(bough_session_error(s), "save: a step has failed", 23);
        assert_int_equal(bough_session_set(s, 0, 9), BOUGH_SESSION_FAILED);
        assert_int_equal(bough_session_find(s, "none"), -1);
        assert_int_equal(bough_session_step(s), BOUGH_SESSION_FAILED); // whatever was called between
        assert_string_equal(bough_session_error(s), why);
        assert_int_equal(bough_session_restore(s, copy), BOUGH_SESSION_OK);
        assert_string_equal(bough_session_error(s), "");
    }
    assert_true(end[0] == end[1]);
    free(copy);
    bough_session_close(s);
}

TEST(unfit_copies_are_refused) {
    const char *const often[] = {few, "simulation.macro_step=5 ms"};
    bough_session *a = bough_session_open(pendulum, NULL, 0);
    bough_session *b = bough_session_open(runup, often, 2);
    void *copy = save(a);
    assert_int_equal(bough_session_restore(b, copy), BOUGH_SESSION_INVALID);
    assert_non_null(strstr(bough_session_error(b), "other parts"));
    assert_int_equal(bough_session_step(b), BOUGH_SESSION_OK); // nothing has happened to it
    void *between = malloc(bough_session_size(b));
    assert_int_equal(bough_session_save(b, between), BOUGH_SESSION_INVALID);
    assert_non_null(strstr(bough_session_error(b), "between two samples"));
    ((char *)copy)[0] = 'x';
    assert_int_equal(bough_session_restore(a, copy), BOUGH_SESSION_INVALID);
    assert_int_equal(bough_session_step(a), BOUGH_SESSION_OK);
    free(copy);
    free(between);
    bough_session_close(a);
    bough_session_close(b);
}
