// Boxes from files in the style of Bladed and HAWC, written here by their formats: velocities at the
// grid's points by hand.
#include "apps/bough/import/wind.h"

#include "tests/unit/check.h"
#include "tests/unit/scratch_name.h"

#include <unistd.h>

enum { N_Z = 2, N_Y = 3, N_T = 4 };

typedef struct place {
    char folder[SCRATCH_NAME], wind[SCRATCH_PATH], sum[SCRATCH_PATH];
    bough_arena *arena;
} place;

static int set_up(void **state) {
    place *p = test_malloc(sizeof *p);
    assert_non_null(mkdtemp(scratch_name(p->folder)));
    snprintf(p->wind, sizeof p->wind, "%s/box.wnd", p->folder);
    snprintf(p->sum, sizeof p->sum, "%s/box.sum", p->folder);
    p->arena = check_memory();
    *state = p;
    return 0;
}

static int tear_down(void **state) {
    place *p = *state;
    char command[SCRATCH_PATH];
    snprintf(command, sizeof command, "rm -rf %s", p->folder);
    assert_int_equal(system(command), 0);
    bough_arena_destroy(p->arena);
    test_free(p);
    return 0;
}

static void put16(FILE *f, int v) {
    fputc(v & 255, f);
    fputc(v >> 8 & 255, f);
}

static void put32(FILE *f, long v) {
    put16(f, (int)(v & 0xFFFF));
    put16(f, (int)(v >> 16 & 0xFFFF));
}

static void put_real(FILE *f, double v) {
    float x = (float)v;
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    put32(f, bits);
}

static int normalised(int t, int z, int y, int c) { return 100 * t + 1000 * z - 30 * y + 7 * c; }

static void put_velocities(FILE *f) {
    for (int t = 0; t < N_T; t++)
        for (int z = 0; z < N_Z; z++)
            for (int y = 0; y < N_Y; y++)
                for (int c = 0; c < 3; c++) put16(f, normalised(t, z, y, c));
}

// Of model 4 with its own intensities 10, 8 and 5 %, or an old head and those of the summary.
static void write_bladed(const place *p, bool old, const char *clockwise, const char *more) {
    FILE *f = fopen(p->wind, "wb");
    assert_non_null(f);
    if (old) {
        const int head[] = {-3, 30000,      20000,      5000, N_T / 2, 100, 0, 0, 0, 0,
                            1,  1000 * N_Z, 1000 * N_Y, 0,    0,       0,   0, 0, 0};
        for (size_t i = 0; i < sizeof head / sizeof *head; i++) put16(f, head[i]);
    } else {
        const double own[] = {45, 0.03, 90, 10, 8, 5}, common[] = {30, 20, 5};
        put16(f, -99);
        put16(f, 4);
        put32(f, 3);
        for (int i = 0; i < 6; i++) put_real(f, own[i]);
        for (int i = 0; i < 3; i++) put_real(f, common[i]);
        put32(f, N_T / 2);
        put_real(f, 10);
        for (int i = 0; i < 3; i++) put_real(f, 0);
        put32(f, 0);
        put32(f, 77);
        put32(f, N_Z);
        put32(f, N_Y);
        for (int i = 0; i < 6; i++) put_real(f, 0);
    }
    put_velocities(f);
    fclose(f);
    f = fopen(p->sum, "w");
    assert_non_null(f);
    fprintf(f,
            "TurbSim\n\n%s  Clockwise rotation\n  90.0  Hub height [m]\n  80.0  Grid width [m]\n"
            "BLADED-STYLE BINARY SCALING PARAMETERS\n\n   UBAR  = 10.0 m/s\n   TI(u) = 10.0 %%\n"
            "   TI(v) =  8.0 %%\n   TI(w) =  5.0 %%\n\n   Height offset = 5.0 m\n%s",
            clockwise, more);
    fclose(f);
}

static void check_bladed(place *p, bool turned, double sideways) {
    bough_wind_box box;
    check_ok(bough_wind_bladed_read(p->arena, p->wind, &box));
    assert_int_equal(box.n_time, N_T);
    check_near(box.dt, 0.5, 1e-6, 0);
    check_near(box.bottom, 85 - 15, 1e-6, 0);
    const double scale[] = {1e-3 * 10 * 0.1, sideways * 1e-3 * 10 * 0.08, 1e-3 * 10 * 0.05};
    for (int t = 0; t < N_T; t++) {
        for (int z = 0; z < N_Z; z++) {
            for (int y = 0; y < N_Y; y++) {
                int from = turned ? N_Y - 1 - y : y;
                double later = box.periodic ? 0 : 20 / 10.; // it starts half a width downwind
                bough_vec3 v =
                    bough_wind_box_at(&box, bough_v3(0, -20 + 20 * y, 70 + 30 * z), 0.5 * t - later);
                check_near(v.x, 10 + scale[0] * normalised(t, z, from, 0), 1e-6, 1e-6);
                check_near(v.y, scale[1] * normalised(t, z, from, 1), 1e-6, 1e-6);
                check_near(v.z, scale[2] * normalised(t, z, from, 2), 1e-6, 1e-6);
            }
        }
    }
}

TEST_WITH(bladed_files_are_boxes, set_up, tear_down) {
    place *p = *context;
    write_bladed(p, false, "F", "Creating a PERIODIC output file.\n");
    check_bladed(p, false, 1);
    write_bladed(p, false, "True", "");
    check_bladed(p, true, 1);
    write_bladed(p, true, "N", "   BLADED LEFT-HAND RULE\n");
    check_bladed(p, false, -1);
}

TEST_WITH(damaged_bladed_files_are_reported, set_up, tear_down) {
    place *p = *context;
    bough_wind_box box;
    check_fails(bough_wind_bladed_read(p->arena, p->wind, &box), BOUGH_INVALID, "box.wnd: ");
    write_bladed(p, false, "F", "");
    assert_int_equal(truncate(p->wind, 150), 0);
    check_fails(bough_wind_bladed_read(p->arena, p->wind, &box), BOUGH_INVALID,
                "ends before its last velocity");
    assert_int_equal(truncate(p->wind, 60), 0);
    check_fails(bough_wind_bladed_read(p->arena, p->wind, &box), BOUGH_INVALID,
                "not a full-field file in Bladed's format");
    write_bladed(p, false, "F", "");
    assert_int_equal(truncate(p->sum, 40), 0);
    check_fails(bough_wind_bladed_read(p->arena, p->wind, &box), BOUGH_INVALID,
                "box.sum: expected lines 'HUB HEIGHT'");
}

// -- HAWC -----------------------------------------------------------------------------------------

static double unscaled(int x, int y, int z, int c) { return (x % 2 ? 1 : -1) * (1 + 0.1 * y) + 0.01 * z + c; }

static void write_hawc(const place *p, char path[3][SCRATCH_PATH], const char *const **file) {
    static const char *list[3];
    for (int c = 0; c < 3; c++) {
        snprintf(path[c], SCRATCH_PATH, "%s/%c.bin", p->folder, "uvw"[c]);
        list[c] = path[c];
        FILE *f = fopen(path[c], "wb");
        assert_non_null(f);
        for (int x = 0; x < N_T; x++)
            for (int y = N_Y - 1; y >= 0; y--)
                for (int z = 0; z < N_Z; z++) put_real(f, unscaled(x, y, z, c));
        fclose(f);
    }
    *file = list;
}

static void check_hawc(const bough_wind_box *box, double factor, double mean_kept, double low, double high) {
    for (int x = 0; x < N_T; x++) {
        for (int z = 0; z < N_Z; z++) {
            for (int y = 0; y < N_Y; y++) {
                bough_vec3 v = bough_wind_box_at(box, bough_v3(0, -20 + 20 * y, 75 + 30 * z), 0.5 * x);
                double u = unscaled(x, y, z, 0), mean = 0.01 * z;
                check_near(v.x, (z ? high : low) + factor * (u - (1 - mean_kept) * mean), 0, 1e-3);
                check_near(v.y, factor * unscaled(x, y, z, 1), 0, 1e-3);
                check_near(v.z, factor * unscaled(x, y, z, 2), 0, 1e-3);
            }
        }
    }
}

TEST_WITH(hawc_files_are_boxes, set_up, tear_down) {
    place *p = *context;
    char path[3][SCRATCH_PATH];
    const char *const *file;
    write_hawc(p, path, &file);
    bough_hawc_def d = {
        .nx = N_T, .ny = N_Y, .nz = N_Z, .dx = 5, .dy = 20, .dz = 30, .height = 90, .mean = 10};
    memcpy(d.file, file, sizeof d.file);
    bough_wind_box box;
    check_ok(bough_wind_hawc_read(p->arena, &d, &box));
    check_hawc(&box, 1, 1, 10, 10);
    d.profile = BOUGH_HAWC_POWER;
    d.exponent = 0.2;
    d.scaling = 1;
    d.factor[0] = d.factor[1] = d.factor[2] = 1.5;
    check_ok(bough_wind_hawc_read(p->arena, &d, &box));
    check_hawc(&box, 1.5, 0, 10 * pow(75 / 90., 0.2), 10 * pow(105 / 90., 0.2));
    d.profile = BOUGH_HAWC_LOG;
    d.roughness = 0.03;
    d.scaling = 2; // in the middle the deviation is 1.1
    d.sigma[0] = d.sigma[1] = d.sigma[2] = 2.2;
    check_ok(bough_wind_hawc_read(p->arena, &d, &box));
    check_hawc(&box, 2, 0, 10 * log(75 / 0.03) / log(3000), 10 * log(105 / 0.03) / log(3000));
    d.nx = N_T + 1;
    check_fails(bough_wind_hawc_read(p->arena, &d, &box), BOUGH_INVALID,
                "u.bin: it ends before its last velocity");
    d.nx = 1;
    check_fails(bough_wind_hawc_read(p->arena, &d, &box), BOUGH_INVALID,
                "expected at least 2 points in each direction");
}
