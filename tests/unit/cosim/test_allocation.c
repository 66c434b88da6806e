// Build allocates, stepping never does: every allocation of the process is counted while steps
// are taken, those inside libraries included.
//
// To see where one comes from: break on note_allocation in a debugger when counting is set.
#include "tests/unit/built_scene.h"

#include "apps/bough/results/channels.h"
#include "apps/bough/results/recorder.h"
#include "tests/unit/scratch.h"

#include <errno.h>
#include <stdatomic.h>
#include <sys/mman.h>
#include <sys/syscall.h>

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
extern long syscall(long number, ...);
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

// OpenBLAS's.
void *mmap(void *at, size_t size, int protection, int flags, int file, off_t offset) {
    note_allocation();
    long block = syscall(SYS_mmap, at, size, protection, flags, file, offset);
    return (void *)block; // NOLINT(performance-no-int-to-ptr)
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

TEST(every_kind_of_allocation_is_counted) {
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
    for (int k = 1; k < 5; k++) free(block[k]);
    free(aligned);
    stop_counting();
    assert_int_equal(bad, 0);
    assert_int_equal(seen, 5);
    assert_int_equal(atomic_load(&releases), 4);
    free(malloc(8));
    assert_int_equal(atomic_load(&allocations), 5);
}

// A library's own: the C library takes memory for a file.
TEST(allocations_of_libraries_are_counted) {
    if (!CAN_COUNT) skip();
    start_counting();
    FILE *file = fopen(BOUGH_SOURCE_DIR "/CMakeLists.txt", "r");
    stop_counting();
    assert_non_null(file);
    fclose(file);
    assert_true(atomic_load(&allocations) > 0);
}

// -- the steps ------------------------------------------------------------------------------------

enum { COUNTED = 50 };

typedef struct outlet {
    bough_channels channels;
    double *value;
    bough_recorder *recorder;
} outlet;

static void open_outlet(bough_arena *arena, bough_simulation *s, const char *folder, outlet *o) {
    o->channels = bough_channels_start(arena);
    check_ok(bough_simulation_channels(s, &o->channels));
    o->value = bough_arena_doubles(arena, (size_t)o->channels.count);
    assert_non_null(o->value);
    bough_recorder_def def = {.folder = folder, .title = "allocation", .channels = &o->channels};
    check_ok(bough_recorder_open(arena, &def, &o->recorder));
}

static void take_step(bough_simulation *s, const outlet *o) {
    scene_step(s);
    bough_simulation_update(s);
    bough_channels_sample(&o->channels, s->master->time, o->value);
    check_ok(bough_recorder_sample(o->recorder, s->master->time));
}

typedef struct counted_run {
    bough_simulation *simulation;
    outlet outlet;
    int steps;
    const char *what;
} counted_run;

// All steps, the first one included.
static void take_steps(void *self) {
    counted_run *run = self;
    start_counting();
    for (int k = 0; k < run->steps; k++) take_step(run->simulation, &run->outlet);
    stop_counting();
    long taken = atomic_load(&allocations), released = atomic_load(&releases);
    if (taken == 0 && released == 0) return;
    fail_msg("%s: %ld allocations and %ld releases in %d steps", run->what, taken, released, run->steps);
}

static void count_steps(const char *folder, const char *path, int steps, const char *what,
                        const char *const *sets) {
    check_arena(arena);
    counted_run run = {.simulation = scene_build(arena, path, sets), .steps = steps, .what = what};
    open_outlet(arena, run.simulation, folder, &run.outlet);
    bough_pool_region(run.simulation->pool, take_steps, &run);
}

static const char runup[] = "apps/turbine/runup.yaml";

// Explicit schemes want a small macro step; the aerodynamics are sampled every second one.
TEST_IN_FOLDER(every_scheme_and_sub_solver_takes_no_memory) {
    if (!CAN_COUNT) skip();
    static const char *const solver[] = {"cvode-bdf", "arkode-esdirk", "ida", "generalized-alpha",
                                         "rosenbrock"};
    char scheme_set[64], solver_set[64], what[128];
    const char *const *sets =
        sets_of("simulation.duration=2 s", "simulation.threads=1", "simulation.macro_step=1 ms",
                "simulation.micro.step=1 ms", "aero.rate=500 Hz", "bodies[3-5].rod.segments=8", scheme_set,
                solver_set);
    for (int i = 0; bough_scheme_name(i); i++) {
        for (int k = 0; k < 4; k++) {
            const char *scheme = bough_scheme_name(i);
            snprintf(scheme_set, sizeof scheme_set, "simulation.coupling.scheme=%s", scheme);
            snprintf(solver_set, sizeof solver_set, "simulation.micro.solver=%s", solver[k]);
            snprintf(what, sizeof what, "%s with %s", scheme, solver[k]);
            count_steps(*context, runup, COUNTED, what, sets);
        }
    }
}

// The tree's integrator, and that of the whole assembly.
TEST_IN_FOLDER(every_master_solver_takes_no_memory) {
    if (!CAN_COUNT) skip();
    char scheme_set[64], solver_set[64], what[128];
    const char *const *sets =
        sets_of("simulation.duration=2 s", "simulation.threads=1", "simulation.macro_step=2 ms",
                "bodies[3-5].rod.segments=8", scheme_set, solver_set);
    for (int whole = 0; whole < 2; whole++) {
        for (int i = 0; bough_integrator_name(i); i++) {
            const char *scheme = whole ? "monolithic" : "ramp", *solver = bough_integrator_name(i);
            if (whole && strcmp(solver, "radau5") == 0) continue; // not on so large a system
            snprintf(scheme_set, sizeof scheme_set, "simulation.coupling.scheme=%s", scheme);
            snprintf(solver_set, sizeof solver_set, "simulation.master.solver=%s", solver);
            snprintf(what, sizeof what, "%s with master %s", scheme, solver);
            count_steps(*context, runup, COUNTED, what, sets);
        }
    }
}

TEST_IN_FOLDER(waveforms_by_newton_take_no_memory) {
    if (!CAN_COUNT) skip();
    const char *const *sets =
        sets_of("simulation.duration=2 s", "simulation.threads=1", "simulation.coupling.scheme=iterated",
                "simulation.coupling.exchange=waveform", "simulation.coupling.accelerator=interface-newton");
    count_steps(*context, runup, COUNTED, "waveforms by Newton", sets);
}

// Steps are taken back and repeated with shorter ones.
TEST_IN_FOLDER(controlled_steps_take_no_memory) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.duration=2 s", "simulation.threads=1",
                          "simulation.step_control.tolerance=1e-4", NULL};
    count_steps(*context, runup, COUNTED, "step control", sets);
}

static void do_nothing(void *unused) { (void)unused; }

// Each step opens a region, as in the library, which has opened one before.
TEST_IN_FOLDER(regions_again_take_no_memory) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.duration=2 s", "simulation.threads=2", NULL};
    check_arena(arena);
    counted_run run = {scene_build(arena, runup, sets), .steps = COUNTED, .what = "regions"};
    open_outlet(arena, run.simulation, *context, &run.outlet);
    bough_pool_region(run.simulation->pool, do_nothing, NULL);
    take_steps(&run);
}

// The team of threads is the region's, not a step's.
TEST_IN_FOLDER(many_threads_take_no_memory) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.duration=2 s", "simulation.threads=2", NULL};
    const char *modal[] = {"simulation.duration=2 s", "simulation.threads=3",
                           "bodies[3-5].fidelity=segmented-modal", NULL};
    count_steps(*context, runup, COUNTED, "two threads", sets);
    count_steps(*context, runup, COUNTED, "modal bodies on three threads", modal);
}

TEST_IN_FOLDER(rods_that_carry_take_no_memory) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.duration=2 s", "simulation.threads=1", NULL};
    count_steps(*context, "apps/turbine/land.yaml", COUNTED, "land turbine", sets);
}

TEST_IN_FOLDER(modal_bodies_take_no_memory) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.duration=2 s", "simulation.threads=1", "bodies[3].fidelity=modal",
                          "bodies[4].fidelity=segmented-modal", NULL};
    count_steps(*context, runup, COUNTED, "modal bodies", sets);
}

TEST_IN_FOLDER(closed_loops_take_no_memory) {
    if (!CAN_COUNT) skip();
    const char *sets[] = {"simulation.macro_step=1 ms", NULL};
    const char *radau[] = {"simulation.macro_step=1 ms", "simulation.master.solver=radau5", NULL};
    count_steps(*context, "tests/data/scenes/closed.yaml", COUNTED, "closed loop by IDA", sets);
    count_steps(*context, "tests/data/scenes/closed.yaml", COUNTED, "closed loop by Radau", radau);
}
