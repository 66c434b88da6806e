#include "aero/wind/wind.h"

#include "tests/unit/sample_numbers.h"
#include "tests/unit/scratch_name.h"

#include <unistd.h>

typedef struct place {
    bough_arena *arena;
    char path[SCRATCH_NAME];
} place;

static int set_up(void **state) {
    place *p = test_malloc(sizeof *p);
    p->arena = check_memory();
    int file = mkstemp(scratch_name(p->path));
    assert_true(file >= 0);
    close(file);
    *state = p;
    return 0;
}

static int tear_down(void **state) {
    place *p = *state;
    unlink(p->path);
    bough_arena_destroy(p->arena);
    test_free(p);
    return 0;
}

static void write_file(const place *p, const void *bytes, size_t n) {
    FILE *stream = fopen(p->path, "wb");
    assert_non_null(stream);
    assert_int_equal(fwrite(bytes, 1, n, stream), n);
    fclose(stream);
}

static bough_status build(place *p, bough_wind_source source, bough_wind *wind) {
    bough_wind_def def = bough_wind_def_default();
    def.source = source;
    def.file = p->path;
    def.reference_length = 126;
    return bough_wind_build(p->arena, &def, wind);
}

static void check_vec(bough_vec3 v, double x, double y, double z) {
    check_vec3(v, bough_v3(x, y, z), 1e-12, 1e-12);
}

// -- .wnd -----------------------------------------------------------------------------------------

static const char hub_text[] = "! Time Speed Dir Vert HShr PwrShr LinShr Gust\n"
                               "!  s   m/s  deg  m/s\n"
                               "0.0 8.0 0.0 0.0 0.0 0.0 0.0 0.0\n"
                               "10,12,0,1,0,0.2,0,0\r\n"
                               "\n"
                               " 20 10 30 0 0.1 0 0.3 2 ! gusty\n"
                               "30 10 0 0 0 0 0 0 8\n";

// Rows, between them and outside; direction clockwise, shears per reference length.
TEST_WITH(hub_rows_are_interpolated, set_up, tear_down) {
    place *p = *context;
    bough_wind wind;
    write_file(p, hub_text, strlen(hub_text));
    check_ok(build(p, BOUGH_WIND_HUB_FILE, &wind));
    assert_int_equal(wind.hub->n, 4);
    bough_vec3 hub = bough_v3(-5, 0, 90), above = bough_v3(0, 0, 180);
    check_vec(bough_wind_at(&wind, hub, -3), 8, 0, 0);
    check_vec(bough_wind_at(&wind, hub, 5), 10, 0, 0.5);
    check_vec(bough_wind_at(&wind, above, 10), 12 * pow(2, 0.2), 0, 1);
    check_vec(bough_wind_at(&wind, bough_v3(0, 0, -1), 10), 0, 0, 1);
    // 10 (1 + 0.1·50/126 + 0.3·21/126) + 2 towards −30°, 50 m beside the axis.
    bough_vec3 beside = bough_v3(50 * sin(30 * BOUGH_DEGREE), 50 * cos(30 * BOUGH_DEGREE), 111);
    double speed = 12 + 10 * (0.1 * 50 + 0.3 * 21) / 126;
    check_vec(bough_wind_at(&wind, beside, 20), speed * cos(30 * BOUGH_DEGREE),
              -speed * sin(30 * BOUGH_DEGREE), 0);
    check_vec(bough_wind_at(&wind, hub, 99), 10 * cos(8 * BOUGH_DEGREE), 0, 10 * sin(8 * BOUGH_DEGREE));
}

// A shear that comes and goes between two samples, 10 m/s at the half of the reference length above the hub.
TEST_WITH(what_lies_between_samples_of_a_hub_file_is_found, set_up, tear_down) {
    static const char text[] = "0 20 0 0 0 0 0 0\n1.01 20 0 0 0 0 0 0\n1.05 20 0 0 0 0 1 0\n"
                               "1.09 20 0 0 0 0 0 0\n";
    place *p = *context;
    bough_wind wind;
    write_file(p, text, strlen(text));
    check_ok(build(p, BOUGH_WIND_HUB_FILE, &wind));
    bough_wind_missed m = bough_wind_between(&wind, 0.1, 10);
    check_near(m.speed, 10, 1e-12, 0);
    check_near(m.time, 1.05, 0, 0);
    check_near(bough_wind_between(&wind, 0.01, 10).speed, 0, 0, 1e-9);
}

TEST_WITH(bad_hub_files_are_refused, set_up, tear_down) {
    place *p = *context;
    static const char *const bad[][2] = {
        {"! nothing\n\n", "no rows"},
        {"0 8 0 0 0 0 0\n", ":1:"},
        {"0 8 0 0 0 0 0 0\n5 8 0 east 0 0 0 0\n", ":2:"},
        {"0 8 0 0 0 0 0 nan\n", ":1:"},
        {"0 8 0 0 0 0 0 0\n0 8 0 0 0 0 0 0\n", ":2: times must increase: 0 s is followed by 0 s"}};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        bough_wind wind;
        write_file(p, bad[i][0], strlen(bad[i][0]));
        check_fails(build(p, BOUGH_WIND_HUB_FILE, &wind), BOUGH_INVALID, bad[i][1]);
    }
}

// -- .bts -----------------------------------------------------------------------------------------

enum { NZ = 3, NY = 4, TOWER = 2, TIMES = 6, POINTS = NZ * NY + TOWER, TEXT = 5 };
enum { SIZE = 70 + TEXT + 6 * POINTS * TIMES };
static const double dz = 20, dy = 30, dt = 2, bottom = 50;

static unsigned char *put(unsigned char *at, const void *from, size_t n) {
    memcpy(at, from, n);
    return at + n;
}

// Velocities linear in place and time, which the interpolation then gives exactly, times 100.
static void fill_box(unsigned char *bytes, int kind) {
    const int16_t id = (int16_t)kind;
    const int32_t count[4] = {NZ, NY, TOWER, TIMES}, text = TEXT;
    const float head[12] = {20, 30, 2, 10, 90, 50, 100, 0, 100, -50, 200, 10};
    unsigned char *at = put(bytes, &id, 2);
    at = put(at, count, sizeof count);
    at = put(at, head, sizeof head);
    at = put(at, &text, 4);
    at = put(at, "hello", TEXT);
    for (int t = 0; t < TIMES; t++) {
        for (int k = 0; k < POINTS; k++) {
            int z = k < NZ * NY ? k / NY : NZ * NY - 1 - k, y = k < NZ * NY ? k % NY : 0;
            double middle = k < NZ * NY ? y - 1.5 : 0;
            const int16_t v[3] = {(int16_t)(1000 + 10 * t + 30 * z + lround(20 * middle)),
                                  (int16_t)(-50 + 4 * t), (int16_t)(10 + 8 * z)};
            at = put(at, v, sizeof v);
        }
    }
    assert_int_equal(at - bytes, SIZE);
}

static bough_vec3 expected(double time, double y, double z) {
    return bough_v3(10 + 0.1 * time / dt + 0.3 * (z - bottom) / dz + 0.2 * y / dy, 0.04 * time / dt,
                    0.04 * (z - bottom) / dz);
}

static void check_point(const bough_wind *wind, double x, double y, double z, double t, double time) {
    bough_vec3 e = expected(time, y, z);
    check_vec(bough_wind_at(wind, bough_v3(x, y, z), t), e.x, e.y, e.z);
}

TEST_WITH(box_is_interpolated, set_up, tear_down) {
    place *p = *context;
    unsigned char bytes[SIZE];
    bough_wind wind;
    fill_box(bytes, 7);
    write_file(p, bytes, SIZE);
    check_ok(build(p, BOUGH_WIND_BOX_FILE, &wind));
    check_near(wind.box->half_width, 45, 0, 0);
    check_near(wind.box->duration, 10, 0, 0);
    check_point(&wind, 45, 0, 70, 0, 0);
    check_point(&wind, 45, 0, 70, 3.1, 3.1);
    check_point(&wind, 15, 0, 70, 3.1, 6.1); // upwind it was there 3 s earlier
    check_point(&wind, 45, -22.3, 61.7, 4.4, 4.4);
    check_point(&wind, 45, 45, 90, 10, 10);
    check_point(&wind, 45, 0, 24, 4.4, 4.4); // between tower points
    check_point(&wind, 45, 0, 45, 4.4, 4.4); // between grid and tower
    // Beyond the edges their values.
    bough_vec3 far = bough_wind_at(&wind, bough_v3(45, 300, 500), 99), edge = expected(10, 45, 90);
    check_vec(far, edge.x, edge.y, edge.z);
    far = bough_wind_at(&wind, bough_v3(45, 0, -80), 0), edge = expected(0, 0, 10);
    check_vec(far, edge.x, edge.y, edge.z);
    assert_true(bough_wind_covers(&wind, bough_v3(-5, 0, 70), 20));
    assert_false(bough_wind_covers(&wind, bough_v3(-5, 0, 70), 20.1));
    assert_false(bough_wind_covers(&wind, bough_v3(-5, 30, 70), 16));
    assert_true(bough_wind_box_lasts(wind.box, 5.5));
    assert_false(bough_wind_box_lasts(wind.box, 5.6));
    double passes[2];
    bough_wind_passes(&wind, bough_v3(-5, 0, 70),
                      passes); // half a width later and 0.5 s earlier than at x = 0
    check_near(passes[0], -5, 1e-12, 0);
    check_near(passes[1], 5, 1e-12, 0);
}

TEST_WITH(periodic_box_repeats, set_up, tear_down) {
    place *p = *context;
    unsigned char bytes[SIZE];
    bough_wind wind;
    fill_box(bytes, 8);
    write_file(p, bytes, SIZE);
    check_ok(build(p, BOUGH_WIND_BOX_FILE, &wind));
    check_near(wind.box->duration, 12, 0, 0);
    assert_true(bough_wind_box_lasts(wind.box, 1e6));
    check_point(&wind, 0, 10, 70, 3.1, 3.1);
    check_point(&wind, 0, 10, 70, 3.1 + 24, 3.1);
    check_point(&wind, 20, 10, 70, 0, 10);
    bough_vec3 a = expected(10, 0, 70), b = expected(0, 0, 70);
    check_vec(bough_wind_at(&wind, bough_v3(0, 0, 70), 11), (a.x + b.x) / 2, (a.y + b.y) / 2, a.z);
}

// Every cut, and heads that promise too much, are refused without reading on.
TEST_WITH(damaged_boxes_are_refused, set_up, tear_down) {
    place *p = *context;
    unsigned char bytes[SIZE + 1] = {0};
    bough_wind wind;
    for (size_t n = 0; n <= SIZE + 1; n += n < 80 ? 1 : 13) {
        fill_box(bytes, 7);
        if (n == SIZE) continue;
        write_file(p, bytes, n);
        check_fails(build(p, BOUGH_WIND_BOX_FILE, &wind), BOUGH_INVALID, p->path);
    }
    static const struct {
        int at;
        unsigned char byte[4];
    } damage[] = {{0, {9, 0}},
                  {2, {0xff, 0xff, 0xff, 0x7f}}, // huge and negative numbers of points
                  {2, {0xff, 0xff, 0xff, 0xff}},
                  {6, {0, 0xe1, 0xf5, 5}},
                  {10, {0, 0, 0, 0x80}},
                  {14, {0, 0xe1, 0xf5, 5}},
                  {14, {1, 0, 0, 0}},
                  {18, {0, 0, 0xc0, 0x7f}}, // not a number
                  {26, {0, 0, 0, 0}},       // no time step
                  {30, {0, 0, 0x20, 0xc1}}, // mean speed −10
                  {42, {0, 0, 0, 0}},       // no slope
                  {66, {0xff, 0xff, 0xff, 0x7f}},
                  {66, {0, 0, 0, 0x80}}};
    for (size_t i = 0; i < sizeof damage / sizeof *damage; i++) {
        fill_box(bytes, 7);
        memcpy(bytes + damage[i].at, damage[i].byte, damage[i].at == 0 ? 2 : 4);
        write_file(p, bytes, SIZE);
        check_fails(build(p, BOUGH_WIND_BOX_FILE, &wind), BOUGH_INVALID, p->path);
    }
    unlink(p->path);
    check_fails(build(p, BOUGH_WIND_BOX_FILE, &wind), BOUGH_INVALID, p->path);
}

// Turned by a right angle the box comes from the other side.
TEST_WITH(direction_turns_a_file, set_up, tear_down) {
    place *p = *context;
    unsigned char bytes[SIZE];
    bough_wind wind;
    fill_box(bytes, 7);
    write_file(p, bytes, SIZE);
    bough_wind_def def = {.source = BOUGH_WIND_BOX_FILE, .file = p->path, .direction = 90 * BOUGH_DEGREE};
    check_ok(bough_wind_build(p->arena, &def, &wind));
    bough_vec3 e = expected(1, -20, 70), v = bough_wind_at(&wind, bough_v3(20, 45, 70), 1);
    check_vec(v, -e.y, e.x, e.z);
    def.until = 6;
    check_fails(bough_wind_build(p->arena, &def, &wind), BOUGH_INVALID, "too short");
}
