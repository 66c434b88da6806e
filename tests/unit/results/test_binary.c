// channels.outb read byte by byte, as its readers do.
#include "apps/bough/results/recorder.h"
#include "tests/unit/scratch.h"

enum { CHANNELS = 4, ROWS = 41, BYTES = 4096 };

typedef struct fixture {
    bough_arena *arena;
    bough_channels channels;
    bough_status status;
} fixture;

// A wave, a constant, a small ripple on a large value, and zero.
static void sample(void *self, double t, double *value) {
    (void)self;
    value[0] = 12 * sin(3 * t) - 4;
    value[1] = 7.25;
    value[2] = 1e6 + 0.5 * cos(t);
    value[3] = 0;
}

static void sample_endless(void *self, double t, double *value) {
    sample(self, t, value);
    value[3] = t > 0.5 ? HUGE_VAL : 0;
}

// Rows at 2 s and every 50 ms from there, then one 20 ms later, and the file from them.
static fixture write_folder(const char *folder, bough_channel_sample *source) {
    fixture f = {.arena = check_memory()};
    bough_recorder *recorder;
    f.channels = bough_channels_start(f.arena);
    bough_channels_group(&f.channels, source, NULL);
    bough_channels_add(&f.channels, "rpm", "RotSpeed");
    bough_channels_add(&f.channels, "kN-m", "a_name_longer_than_ten");
    bough_channels_add(&f.channels, "N", "load");
    bough_channels_add(&f.channels, "-", "rest");
    bough_recorder_def def = {.folder = folder, .title = "scene.yaml", .channels = &f.channels};
    f.status = bough_recorder_open(f.arena, &def, &recorder);
    for (int i = 0; i < ROWS && bough_is_ok(&f.status); i++)
        f.status = bough_recorder_sample(recorder, 2 + 0.05 * i);
    if (bough_is_ok(&f.status)) f.status = bough_recorder_sample(recorder, 4.02);
    if (bough_is_ok(&f.status)) f.status = bough_recorder_finish(recorder, &f.status);
    assert_string_equal(f.status.message, "");
    return f;
}

static bough_status pack(fixture *f, const char *folder) {
    return bough_binary_write(&(bough_binary_def){
        .folder = folder, .title = "scene.yaml", .channels = &f->channels, .interval = 0.05});
}

typedef struct bytes {
    unsigned char all[BYTES];
    size_t n, at;
} bytes;

static bytes read_bytes(const char *folder) {
    bytes b = {0};
    FILE *file = scratch_open(folder, "channels.outb", "rb");
    b.n = fread(b.all, 1, BYTES, file);
    fclose(file);
    return b;
}

static uint64_t take(bytes *b, int n) {
    uint64_t bits = 0;
    assert_true(b->at + n <= b->n);
    for (int i = 0; i < n; i++) bits |= (uint64_t)b->all[b->at++] << 8 * i;
    return bits;
}

static double take_double(bytes *b) {
    uint64_t bits = take(b, 8);
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static float take_float(bytes *b) {
    uint32_t bits = (uint32_t)take(b, 4);
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

static void take_word(bytes *b, int width, const char *expected) {
    char word[64];
    snprintf(word, sizeof word, "%-*s", width, expected);
    assert_memory_equal(b->all + b->at, word, width);
    b->at += width;
}

TEST_IN_FOLDER(values_are_those_of_the_rows) {
    fixture f = write_folder(*context, sample);
    check_ok(pack(&f, *context));
    assert_false(scratch_has(*context, "channels.outb.partial"));
    bytes b = read_bytes(*context);
    assert_int_equal(take(&b, 2), 4);
    int width = (int)take(&b, 2);
    assert_int_equal(width, strlen("a_name_longer_than_ten"));
    assert_int_equal(take(&b, 4), CHANNELS);
    assert_int_equal(take(&b, 4), ROWS);
    check_near(take_double(&b), 2, 0, 0);
    check_near(take_double(&b), 0.05, 0, 0);
    float scale[CHANNELS], offset[CHANNELS];
    for (int k = 0; k < CHANNELS; k++) scale[k] = take_float(&b);
    for (int k = 0; k < CHANNELS; k++) offset[k] = take_float(&b);
    take_word(&b, (int)take(&b, 4), "scene.yaml");
    const char *const word[] = {
        "Time", "RotSpeed", "a_name_longer_than_ten", "load", "rest", "(s)", "(rpm)", "(kN-m)", "(N)", "(-)"};
    for (int k = 0; k < 10; k++) take_word(&b, width, word[k]);
    const double range[CHANNELS] = {24, 0, 1, 0}, size[CHANNELS] = {16, 7.25, 1e6, 0};
    for (int i = 0; i < ROWS; i++) {
        double expected[CHANNELS];
        sample(NULL, 2 + 0.05 * i, expected);
        for (int k = 0; k < CHANNELS; k++) {
            int16_t step = (int16_t)take(&b, 2);
            double value = ((double)step - (double)offset[k]) / (double)scale[k];
            check_near(value, expected[k], 0, 0.51 * range[k] / 65535 + 1.3e-7 * size[k]);
        }
    }
    assert_int_equal(b.at, b.n);
}

TEST_IN_FOLDER(what_it_cannot_hold_is_refused) {
    fixture f = write_folder(*context, sample_endless);
    check_fails(pack(&f, *context), BOUGH_INVALID, "rest = inf at 2 s");
    assert_false(scratch_has(*context, "channels.outb"));
}

TEST_IN_FOLDER(rows_that_are_gone_are_reported) {
    char path[256];
    fixture f = write_folder(*context, sample);
    snprintf(path, sizeof path, "%s/channels.out", (char *)*context);
    assert_int_equal(truncate(path, 1500), 0);
    check_fails(pack(&f, *context), BOUGH_IO, "cannot read row 13");
    assert_false(scratch_has(*context, "channels.outb"));
    remove(path);
    check_fails(pack(&f, *context), BOUGH_IO, "channels.out'");
}
