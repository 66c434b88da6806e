#include "apps/bough/results/recorder.h"

#include "apps/bough/results/folder.h"
#include "tests/unit/scratch.h"

#include <signal.h>
#include <sys/resource.h>

typedef struct fixture {
    bough_arena *arena;
    bough_channels channels;
    bough_recorder *recorder;
    double value[2];
} fixture;

static void sample(void *self, double t, double *value) {
    fixture *f = self;
    value[0] = f->value[0] + t;
    value[1] = f->value[1];
}

static bough_status open_recorder(fixture *f, const char *folder) {
    *f = (fixture){.arena = check_memory(), .value = {1, -2}};
    f->channels = bough_channels_start(f->arena);
    bough_channels_group(&f->channels, sample, f);
    bough_channels_add(&f->channels, "rpm", "RotSpeed");
    bough_channels_add(&f->channels, "kN-m", "a_name_longer_than_its_column");
    bough_recorder_def def = {.folder = folder, .title = "scene.yaml", .channels = &f->channels};
    return bough_recorder_open(f->arena, &def, &f->recorder);
}

// The text from line `number` (1, 2, …) on.
static const char *line_of(const char *text, int number) {
    for (int i = 1; i < number && text; i++) {
        text = strchr(text, '\n');
        if (text) text++;
    }
    return text;
}

TEST_IN_FOLDER(file_has_the_layout_that_readers_expect) {
    fixture f;
    bough_status ok = bough_ok();
    check_ok(open_recorder(&f, *context));
    f.value[1] = -1e-300;
    bough_recorder_sample(f.recorder, 0);
    f.value[1] = NAN;
    bough_recorder_sample(f.recorder, 0.25);
    assert_false(scratch_has(*context, "channels.out"));
    check_ok(bough_recorder_finish(f.recorder, &ok));
    assert_false(scratch_has(*context, "channels.out.partial"));

    char *text = scratch_read(*context, "channels.out");
    assert_non_null(text);
    char word[3][64];
    assert_memory_equal(line_of(text, 3), "Complete: 2 rows ", 17);
    assert_int_equal(sscanf(line_of(text, 7), "%63s\t%63s\t%63s", word[0], word[1], word[2]), 3);
    assert_string_equal(word[0], "Time");
    assert_string_equal(word[1], "RotSpeed");
    assert_string_equal(word[2], "a_name_longer_than_its_column");
    assert_int_equal(sscanf(line_of(text, 8), "%63s\t%63s\t%63s", word[0], word[1], word[2]), 3);
    assert_string_equal(word[0], "(s)");
    assert_string_equal(word[2], "(kN-m)");
    double value[3];
    assert_int_equal(sscanf(line_of(text, 9), "%lf %lf %lf", value, value + 1, value + 2), 3);
    check_near(value[2], -1e-300, 1e-15, 0);
    assert_int_equal(sscanf(line_of(text, 10), "%lf %lf %lf", value, value + 1, value + 2), 3);
    check_near(value[0], 0.25, 0, 0);
    check_near(value[1], 1.25, 0, 0);
    assert_true(isnan(value[2]));
    assert_int_equal(strlen(line_of(text, 11)), 0);
    free(text);
}

TEST_IN_FOLDER(failed_run_keeps_its_rows_and_is_marked) {
    fixture f;
    open_recorder(&f, *context);
    for (int i = 0; i < 5; i++) bough_recorder_sample(f.recorder, i);
    bough_status failure = bough_fail(BOUGH_FAILED, "blade1 gave up\nat 4.2 s");
    check_ok(bough_recorder_finish(f.recorder, &failure));
    char *text = scratch_read(*context, "channels.out");
    assert_non_null(text);
    static const char expected[] = "INCOMPLETE: 5 rows, then blade1 gave up at 4.2 s ";
    assert_memory_equal(line_of(text, 3), expected, sizeof expected - 1);
    assert_memory_equal(line_of(text, 7) + 14, "Time", 4);
    assert_int_equal(strlen(line_of(text, 14)), 0);
    free(text);
}

TEST_IN_FOLDER(long_message_is_cut_between_characters) {
    fixture f;
    open_recorder(&f, *context);
    char long_message[301] = "";
    for (int i = 0; i < 300; i += 2) {
        long_message[i] = "ω"[0];
        long_message[i + 1] = "ω"[1];
    }
    bough_status failure = bough_fail(BOUGH_FAILED, "%s", long_message);
    bough_recorder_finish(f.recorder, &failure);
    char *text = scratch_read(*context, "channels.out");
    const unsigned char *end = (const unsigned char *)line_of(text, 4) - 2;
    while (*end == ' ') end--;
    assert_int_equal(end[0], 0x89); // "ω" is CF 89
    assert_int_equal(end[-1], 0xCF);
    free(text);
}

TEST_IN_FOLDER(unfinished_recorder_leaves_only_a_partial) {
    fixture f;
    open_recorder(&f, *context);
    bough_status ok = bough_ok();
    bough_recorder_finish(f.recorder, &ok);
    bough_arena_destroy(f.arena);
    assert_true(scratch_has(*context, "channels.out"));

    open_recorder(&f, *context); // the old result stays until a new one can replace it
    bough_recorder_sample(f.recorder, 0);
    bough_arena_destroy(f.arena);
    char *old = scratch_read(*context, "channels.out");
    assert_non_null(old);
    assert_non_null(strstr(old, "Complete: 0 rows"));
    free(old);
    char *text = scratch_read(*context, "channels.out.partial");
    assert_non_null(text);
    assert_non_null(strstr(text, "INCOMPLETE"));
    free(text);
}

TEST(a_folder_that_cannot_be_made_is_an_error_of_files) {
    fixture f;
    check_fails(open_recorder(&f, "/proc/none"), BOUGH_IO, "/proc/none");
}

TEST_IN_FOLDER(full_device_is_an_error_of_files) {
    char partial[128];
    snprintf(partial, sizeof partial, "%s/channels.out.partial", (char *)*context);
    assert_int_equal(symlink("/dev/full", partial), 0);
    fixture f;
    check_fails(open_recorder(&f, *context), BOUGH_IO, "channels.out");
}

TEST_IN_FOLDER(device_that_fills_up_leaves_whole_rows) {
    fixture f;
    open_recorder(&f, *context);
    signal(SIGXFSZ, SIG_IGN);
    struct rlimit old, small;
    getrlimit(RLIMIT_FSIZE, &old);
    small = old;
    small.rlim_cur = 100001;
    setrlimit(RLIMIT_FSIZE, &small);
    bough_status status = bough_ok();
    for (int i = 0; i < 10000 && bough_is_ok(&status); i++) {
        status = bough_recorder_sample(f.recorder, i);
    }
    assert_int_equal(status.code, BOUGH_IO);
    bough_status end = bough_recorder_finish(f.recorder, &status);
    setrlimit(RLIMIT_FSIZE, &old);
    assert_int_equal(end.code, BOUGH_IO);
    assert_false(scratch_has(*context, "channels.out"));
    char *text = scratch_read(*context, "channels.out.partial");
    assert_non_null(strstr(text, "INCOMPLETE"));
    assert_true(strlen(text) > 90000);
    assert_int_equal((strlen(text) - (size_t)(line_of(text, 9) - text)) % 55, 0);
    free(text);
}

TEST_IN_FOLDER(folder_is_made_with_its_parents) {
    char path[128], file[160];
    snprintf(path, sizeof path, "%s/a/b/", (char *)*context);
    check_ok(bough_folder_make(path));
    check_ok(bough_folder_make(path)); // it exists

    snprintf(file, sizeof file, "%s/taken", (char *)*context);
    fclose(fopen(file, "w"));
    check_fails(bough_folder_make(file), BOUGH_IO, "is a file");
    snprintf(file, sizeof file, "%s/taken/below", (char *)*context);
    check_fails(bough_folder_make(file), BOUGH_IO, "taken");
    check_fails(bough_folder_make(""), BOUGH_INVALID, "");
    check_fails(bough_folder_make("/proc/none/here"), BOUGH_IO, "/proc/none");
    rmdir(path);
}
