// vertices.h5, read back by the library itself; and what a program without the library says.
#include "apps/bough/results/vertices.h"
#include "tests/unit/check.h"
#include "tests/unit/scratch.h"

#include <signal.h>
#include <sys/resource.h>

static const bough_polyline bodies[] = {{"hub", 1}, {"blade", 3}};
enum { POINTS = 4, SAMPLES = 70 };

// Vertex k, component c of sample n is 100 n + 10 k + c.
static void move(void *self, double *position, double *rotation) {
    int *n = self;
    for (int k = 0; k < POINTS; k++) {
        for (int c = 0; c < 3; c++) position[3 * k + c] = 100 * *n + 10 * k + c;
        for (int c = 0; c < 9; c++) rotation[9 * k + c] = 100 * *n + 10 * k + c;
    }
    ++*n;
}

static void load(void *self, double t, double *force, double *moment) {
    (void)self;
    for (int k = 0; k < 3 * POINTS; k++) force[k] = t + k, moment[k] = -t - k;
}

static bough_status open_file(bough_arena *arena, const char *folder, int *n,
                              bough_vertices **vertices) {
    *n = 0;
    bough_vertices_def def = {
        .folder = folder, .n_body = 2, .body = bodies, .motion = move, .loads = load, .self = n};
    return bough_vertices_open(arena, &def, vertices);
}

#ifdef BOUGH_HDF5
#include <hdf5.h>

static void check_series(hid_t file, const char *name, int rank, const hsize_t *shape,
                         const char *units, double *value) {
    char text[8] = "";
    hsize_t size[4];
    hid_t set = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(set);
    assert_int_equal(H5Sget_simple_extent_dims(space, size, NULL), rank);
    for (int k = 0; k < rank; k++) assert_int_equal(size[k], shape[k]);
    hid_t attribute = H5Aopen(set, "units", H5P_DEFAULT), type = H5Aget_type(attribute);
    assert_true(H5Aread(attribute, type, text) >= 0);
    assert_string_equal(text, units);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    H5Tclose(type);
    H5Aclose(attribute);
    H5Sclose(space);
    H5Dclose(set);
}

static void what_is_written_is_read_back(void **state) {
    static double time[SAMPLES], position[SAMPLES][3][3], rotation[SAMPLES][3][9], hub[SAMPLES][3];
    static double force[SAMPLES][3][3], moment[SAMPLES][3][3];
    bough_arena *arena = bough_arena_create();
    bough_vertices *v;
    int n;
    char path[200];
    bough_status status = open_file(arena, *state, &n, &v);
    assert_int_equal(status.code, BOUGH_OK);
    for (int i = 0; i < SAMPLES; i++) {
        status = bough_vertices_sample(v, 0.5 * i);
        assert_int_equal(status.code, BOUGH_OK);
    }
    assert_false(scratch_has(*state, "vertices.h5"));
    status = bough_vertices_finish(v);
    assert_int_equal(status.code, BOUGH_OK);
    assert_false(scratch_has(*state, "vertices.h5.partial"));
    snprintf(path, sizeof path, "%s/vertices.h5", (char *)*state);
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(file >= 0);
    const hsize_t shape[] = {SAMPLES, 3, 3, 3}, alone[] = {SAMPLES, 1, 3};
    check_series(file, "/time", 1, shape, "s", time);
    check_series(file, "/body/hub/position", 3, alone, "m", &hub[0][0]);
    check_series(file, "/body/blade/position", 3, shape, "m", &position[0][0][0]);
    check_series(file, "/body/blade/rotation", 4, shape, "1", &rotation[0][0][0]);
    check_series(file, "/body/blade/force", 3, shape, "N", &force[0][0][0]);
    check_series(file, "/body/blade/moment", 3, shape, "N m", &moment[0][0][0]);
    for (int i = 0; i < SAMPLES; i++) {
        check_near(time[i], 0.5 * i, 0, 0);
        check_near(hub[i][2], 100 * i + 2, 0, 0);
        for (int k = 0; k < 3; k++) {
            check_near(position[i][k][1], 100 * i + 10 * (k + 1) + 1, 0, 0);
            check_near(force[i][k][2], 0.5 * i + 3 * (k + 1) + 2, 0, 0);
            check_near(moment[i][k][0], -0.5 * i - 3 * (k + 1), 0, 0);
            check_near(rotation[i][k][8], 100 * i + 10 * (k + 1) + 8, 0, 0);
        }
    }
    H5Fclose(file);
    bough_arena_destroy(arena);
}

static void an_unfinished_file_is_not_there(void **state) {
    bough_arena *arena = bough_arena_create();
    bough_vertices *v;
    int n;
    bough_status status = open_file(arena, *state, &n, &v);
    assert_int_equal(status.code, BOUGH_OK);
    bough_vertices_sample(v, 0);
    bough_arena_destroy(arena);
    assert_false(scratch_has(*state, "vertices.h5"));
    assert_false(scratch_has(*state, "vertices.h5.partial"));
}

static void a_full_disk_is_told(void **state) {
    bough_arena *arena = bough_arena_create();
    struct rlimit before, small = {20000, RLIM_INFINITY};
    bough_vertices *v;
    int n;
    signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    small.rlim_max = before.rlim_max;
    bough_status status = open_file(arena, *state, &n, &v);
    setrlimit(RLIMIT_FSIZE, &small);
    for (int i = 0; i < 1000 && bough_is_ok(&status); i++) status = bough_vertices_sample(v, i);
    if (bough_is_ok(&status)) status = bough_vertices_finish(v);
    bough_arena_destroy(arena);
    setrlimit(RLIMIT_FSIZE, &before);
    assert_int_equal(status.code, BOUGH_IO);
    assert_non_null(strstr(status.message, "vertices.h5"));
    assert_false(scratch_has(*state, "vertices.h5"));
    assert_false(scratch_has(*state, "vertices.h5.partial"));
}

#else

static void without_the_library_it_is_refused(void **state) {
    bough_arena *arena = bough_arena_create();
    bough_vertices *v;
    int n;
    bough_status status = open_file(arena, *state, &n, &v);
    assert_int_equal(status.code, BOUGH_INVALID);
    assert_non_null(strstr(status.message, "without HDF5"));
    assert_false(scratch_has(*state, "vertices.h5.partial"));
    bough_arena_destroy(arena);
}

#endif

#define in_scratch(test) cmocka_unit_test_setup_teardown(test, scratch_make, scratch_remove)

int main(void) {
    const struct CMUnitTest tests[] = {
#ifdef BOUGH_HDF5
        in_scratch(what_is_written_is_read_back),
        in_scratch(an_unfinished_file_is_not_there),
        in_scratch(a_full_disk_is_told),
#else
        in_scratch(without_the_library_it_is_refused),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
