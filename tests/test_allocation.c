// Build allocates, stepping never does: every allocation of the process is counted while steps
// are taken, those inside libraries included.
//
// To see where one comes from: break on note_allocation in a debugger when counting is set.
#include "tests/built_scene.h"

#include "apps/output/channels.h"
#include "apps/output/recorder.h"
#include "tests/scratch.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdlib.h>

// glibc lets a program replace its allocator; under a sanitizer that is the sanitizer's to do.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define CAN_COUNT 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define CAN_COUNT 0
#else
#define CAN_COUNT 1
#endif
#else
#define CAN_COUNT 1
#endif

// -- the counter ----------------------------------------------------------------------------------

static atomic_bool counting;
static atomic_long allocations, releases;

#if CAN_COUNT
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *block, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void *block);

__attribute__((noinline)) static void note_allocation(void) {
    if (atomic_load(&counting)) atomic_fetch_add(&allocations, 1);
}

void *malloc(size_t size) {
    note_allocation();
    return __libc_malloc(size);
}

void *calloc(size_t count, size_t size) {
    note_allocation();
    return __libc_calloc(count, size);
}

void *realloc(void *block, size_t size) {
    note_allocation();
    return __libc_realloc(block, size);
}

void *aligned_alloc(size_t alignment, size_t size) {
    note_allocation();
    return __libc_memalign(alignment, size);
}

int posix_memalign(void **block, size_t alignment, size_t size) {
    note_allocation();
    *block = __libc_memalign(alignment, size);
    return *block != NULL ? 0 : ENOMEM;
}

void free(void *block) {
    if (block != NULL && atomic_load(&counting)) atomic_fetch_add(&releases, 1);
    __libc_free(block);
}
#endif

static void start_counting(void) {
    atomic_store(&allocations, 0);
    atomic_store(&releases, 0);
    atomic_store(&counting, true);
}

static void stop_counting(void) { atomic_store(&counting, false); }

static void every_kind_of_allocation_is_counted(void **context) {
    (void)context;
    if (!CAN_COUNT) skip();
    void *volatile block[5] = {0};
    void *aligned = NULL;
    start_counting();
    block[0] = malloc(24);
    block[1] = calloc(3, 8);
    block[2] = realloc(block[0], 4000);
    block[3] = aligned_alloc(64, 128);
    int bad = posix_memalign(&aligned, 64, 100);
    long seen = atomic_load(&allocations);
    for (int k = 1; k < 4; k++) free(block[k]);
    free(aligned);
    stop_counting();
    assert_int_equal(bad, 0);
    assert_int_equal(seen, 5);
    assert_int_equal(atomic_load(&releases), 4);
    free(malloc(8));
    assert_int_equal(atomic_load(&allocations), 5);
}

// A library's own: the C library takes memory for a file.
static void allocations_of_libraries_are_counted(void **context) {
    (void)context;
    if (!CAN_COUNT) skip();
    start_counting();
    FILE *file = fopen(BOUGH_SOURCE_DIR "/CMakeLists.txt", "r");
    stop_counting();
    assert_non_null(file);
    fclose(file);
    assert_true(atomic_load(&allocations) > 0);
}

// -- the steps ------------------------------------------------------------------------------------

enum { WARM_UP = 5, COUNTED = 50 };

typedef struct outlet {
    bough_channels channels;
    double *value;
    bough_recorder *recorder;
} outlet;

static outlet open_outlet(bough_arena *arena, bough_simulation *s, const char *folder) {
    outlet o = {.channels = bough_channels_start(arena)};
    bough_status status = bough_simulation_channels(s, &o.channels);
    assert_int_equal(status.code, BOUGH_OK);
    o.value = bough_arena_doubles(arena, (size_t)o.channels.count);
    assert_non_null(o.value);
    bough_recorder_def def = {.folder = folder, .title = "allocation", .channels = &o.channels};
    status = bough_recorder_open(arena, &def, &o.recorder);
    assert_int_equal(status.code, BOUGH_OK);
    return o;
}

static void take_step(bough_simulation *s, const outlet *o) {
    scene_step(s);
    bough_simulation_update(s);
    bough_channels_sample(&o->channels, s->master->time, o->value);
    bough_status status = bough_recorder_sample(o->recorder, s->master->time);
    assert_int_equal(status.code, BOUGH_OK);
}

static void count_steps(const char *folder, const char *path, const char *const *sets) {
    bough_arena *arena = bough_arena_create();
    bough_simulation *s = scene_build(arena, path, sets);
    outlet o = open_outlet(arena, s, folder);
    for (int k = 0; k < WARM_UP; k++) take_step(s, &o);
    start_counting();
    for (int k = 0; k < COUNTED; k++) take_step(s, &o);
    stop_counting();
    long taken = atomic_load(&allocations), released = atomic_load(&releases);
    if (taken != 0 || released != 0) {
        fail_msg("%s: %ld allocations and %ld releases in %d steps", s->master->coupling->scheme->name, taken,
                 released, COUNTED);
    }
    bough_arena_destroy(arena);
}

static void turbine_steps(void **context, const char *scheme) {
    if (!CAN_COUNT) skip();
    char scheme_set[64];
    snprintf(scheme_set, sizeof scheme_set, "simulation.coupling.scheme=%s", scheme);
    // explicit schemes want a small macro step; the aerodynamics are sampled every second one
    const char *sets[] = {"simulation.duration=2 s", "simulation.threads=1",
                          "simulation.macro_step=1 ms", "aero.rate=500 Hz", scheme_set, NULL};
    count_steps(*context, "apps/turbine/runup.yaml", sets);
}

static void frozen_steps_take_no_memory(void **context) { turbine_steps(context, "frozen"); }

static void gauss_seidel_steps_take_no_memory(void **context) {
    turbine_steps(context, "gauss-seidel");
}

static void extrapolated_steps_take_no_memory(void **context) {
    turbine_steps(context, "extrapolated");
}

static void iterated_steps_take_no_memory(void **context) { turbine_steps(context, "iterated"); }

static void waveforms_by_newton_take_no_memory(void **context) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.duration=2 s",
                          "simulation.threads=1",
                          "simulation.coupling.scheme=iterated",
                          "simulation.coupling.exchange=waveform",
                          "simulation.coupling.accelerator=interface-newton",
                          NULL};
    count_steps(*context, "apps/turbine/runup.yaml", sets);
}

static void ramp_steps_take_no_memory(void **context) { turbine_steps(context, "ramp"); }

static void monolithic_steps_take_no_memory(void **context) {
    turbine_steps(context, "monolithic");
}

// The default step on two threads, whose pool is made in the warm-up.
static void two_threads_take_no_memory(void **context) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.duration=2 s", "simulation.threads=2", NULL};
    count_steps(*context, "apps/turbine/runup.yaml", sets);
}

static void rods_that_carry_take_no_memory(void **context) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.duration=2 s", "simulation.threads=1", NULL};
    count_steps(*context, "apps/turbine/land.yaml", sets);
}

static void modal_bodies_take_no_memory(void **context) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.duration=2 s", "simulation.threads=1",
                          "bodies[3].fidelity=modal", "bodies[4].fidelity=segmented-modal", NULL};
    count_steps(*context, "apps/turbine/runup.yaml", sets);
}

static void closed_loops_take_no_memory(void **context) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.macro_step=1 ms", NULL};
    const char *radau[] = {"simulation.macro_step=1 ms", "simulation.master.solver=radau5", NULL};
    count_steps(*context, "tests/scenes/closed.yaml", sets);
    count_steps(*context, "tests/scenes/closed.yaml", radau);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_of_allocation_is_counted),
        cmocka_unit_test(allocations_of_libraries_are_counted),
        cmocka_unit_test_setup_teardown(frozen_steps_take_no_memory, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(gauss_seidel_steps_take_no_memory, scratch_make,
                                        scratch_remove),
        cmocka_unit_test_setup_teardown(extrapolated_steps_take_no_memory, scratch_make,
                                        scratch_remove),
        cmocka_unit_test_setup_teardown(waveforms_by_newton_take_no_memory, scratch_make,
                                        scratch_remove),
        cmocka_unit_test_setup_teardown(iterated_steps_take_no_memory, scratch_make,
                                        scratch_remove),
        cmocka_unit_test_setup_teardown(ramp_steps_take_no_memory, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(monolithic_steps_take_no_memory, scratch_make,
                                        scratch_remove),
        cmocka_unit_test_setup_teardown(two_threads_take_no_memory, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(modal_bodies_take_no_memory, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(closed_loops_take_no_memory, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(rods_that_carry_take_no_memory, scratch_make,
                                        scratch_remove),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
