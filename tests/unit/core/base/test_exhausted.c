// Memory that ends anywhere while a run is set up: it is reported, nothing leaks, nothing crashes.
#include "apps/bough/model/companion.h"
#include "apps/bough/model/shape.h"
#include "apps/bough/model/simulation.h"
#include "apps/bough/results/folder.h"
#include "apps/bough/results/frames.h"
#include "apps/bough/results/recorder.h"
#include "tests/unit/scratch.h"

#include <sundials/sundials_nvector.h>

#include <sys/mman.h>

// -- the allocator --------------------------------------------------------------------------------

static bool armed, once; // once: a single allocation is refused, the next ones succeed
static long left;        // allocations before that
static int spared;       // allocations to come that are not counted
static bool no_room;     // the pages refused were LAPACK's: nothing else can take their place

// The linker puts these in place of the functions by which our own code takes memory: aligned_alloc, mmap,
// and calloc for single objects. SUNDIALS, where it is linked statically, takes its own by malloc and by
// calloc for arrays, and does not always look whether it got any.
void *__real_calloc(size_t count, size_t size);
void *__real_aligned_alloc(size_t alignment, size_t size);
N_Vector __real_N_VCloneEmpty(N_Vector model);
N_Vector __wrap_N_VCloneEmpty(N_Vector model);
void *__wrap_calloc(size_t count, size_t size);
void *__wrap_aligned_alloc(size_t alignment, size_t size);
void *__real_mmap(void *at, size_t size, int access, int flags, int file, off_t offset);
void *__wrap_mmap(void *at, size_t size, int access, int flags, int file, off_t offset);

static bool refuse(void) {
    if (!armed || spared-- > 0) return false;
    spared = 0;
    left--;
    return once ? left == -1 : left < 0;
}

void *__wrap_calloc(size_t count, size_t size) {
    return count == 1 && refuse() ? NULL : __real_calloc(count, size);
}

void *__wrap_aligned_alloc(size_t alignment, size_t size) {
    return refuse() ? NULL : __real_aligned_alloc(alignment, size);
}

void *__wrap_mmap(void *at, size_t size, int access, int flags, int file, off_t offset) {
    if (!refuse()) return __real_mmap(at, size, access, flags, file, offset);
    no_room = no_room || size >= (size_t)129 << 20;
    return MAP_FAILED;
}

// SUNDIALS clones vectors and does not look whether it got one: see bough_vector_room.
N_Vector __wrap_N_VCloneEmpty(N_Vector model) {
    spared = 1; // the data
    return __real_N_VCloneEmpty(model);
}

// -- what is tried --------------------------------------------------------------------------------

typedef struct subject {
    const char *path, *folder;
    const char *const *set; // ends with NULL
} subject;

static bough_status open_output(bough_arena *arena, const subject *x, bough_simulation *s) {
    bough_channels channels = bough_channels_start(arena);
    bough_status status = bough_simulation_channels(s, &channels);
    bough_companion companion;
    if (bough_is_ok(&status)) status = bough_companion_create(arena, s, &channels, &companion);
    bough_recorder *recorder;
    bough_recorder_def def = {.folder = x->folder, .title = "x", .channels = &channels};
    if (bough_is_ok(&status)) status = bough_recorder_open(arena, &def, &recorder);
    if (bough_is_ok(&status)) status = bough_recorder_sample(recorder, 0);
    bough_shape shape;
    if (bough_is_ok(&status)) bough_shape_create(arena, s, &shape);
    if (!bough_is_ok(&status)) return status;
    bough_frames *frames;
    bough_frames_def frames_def = {.folder = x->folder,
                                   .n_line = shape.n_line,
                                   .line = shape.line,
                                   .points = bough_shape_points,
                                   .loads = bough_shape_loads,
                                   .self = &shape};
    status = bough_frames_open(arena, &frames_def, &frames);
    return bough_is_ok(&status) ? bough_frames_sample(frames, 0) : status;
}

// What `bough run` does before its first step, and that step.
static bough_status set_up(bough_arena *arena, void *self) {
    const subject *x = self;
    bough_errors errors = {.arena = arena};
    bough_scene *scene;
    bough_simulation *s;
    int n = 0;
    while (x->set[n]) n++;
    bough_status status = bough_scene_read(arena, NULL, x->path, x->set, n, &errors, &scene);
    if (bough_is_ok(&status)) status = bough_simulation_build(arena, scene, &s);
    if (bough_is_ok(&status)) status = open_output(arena, x, s);
    return bough_is_ok(&status) ? bough_step(s->master) : status;
}

static bool names_memory(const bough_status *status) {
    return status->code == BOUGH_OUT_OF_MEMORY && strstr(status->message, "memory");
}

// Returns whether an allocation was refused.
static bool try_without(subject *x, long k, bool only_one) {
    left = k;
    once = only_one;
    armed = true;
    no_room = false;
    bough_status status = bough_arena_use(set_up, x);
    armed = false;
    bool refused = left < 0;
    if (bough_is_ok(&status) ? no_room : !refused || !names_memory(&status)) {
        print_error("%s, allocation %ld: code %d: %s\n", x->path, k, status.code, status.message);
        fail();
    }
    return refused;
}

// One allocation after the other is refused, alone and with all that follow.
static void try_all(void **state, const char *path, int stride, const char *const *set) {
    char file[512];
    subject x = {.path = file, .folder = *state, .set = set};
    snprintf(file, sizeof file, BOUGH_SOURCE_DIR "/%s", path);
    for (int only_one = 1; only_one >= 0; only_one--) { // room for LAPACK is sought once in a process
        long k = 0;
        while (try_without(&x, k, only_one)) k += stride;
        assert_true(k > 100);
    }
}

TEST_IN_FOLDER(a_rod_of_every_kind_is_reported) {
    static const char *const micro[] = {"rosenbrock", "cvode-bdf", "arkode-esdirk", "generalized-alpha"};
    for (int i = 0; i < 4; i++) {
        char text[80];
        snprintf(text, sizeof text, "simulation.micro.solver=%s", micro[i]);
        try_all(context, "apps/beams/rubber-bar.yaml", i == 0 ? 1 : 5,
                (const char *const[]){"bodies[0].rod.segments=4", text, NULL});
    }
    try_all(context, "apps/beams/rubber-bar.yaml", 29,
            (const char *const[]){"bodies[0].rod.segments=4", "bodies[0].fidelity=modal", NULL});
}

TEST_IN_FOLDER(every_scheme_is_reported) {
    static const char *const scheme[] = {"frozen", "gauss-seidel", "extrapolated", "iterated", "monolithic"};
    for (int i = 0; i < 5; i++) {
        char text[80];
        snprintf(text, sizeof text, "simulation.coupling={scheme: %s}", scheme[i]);
        try_all(context, "apps/beams/rubber-bar.yaml", 3,
                (const char *const[]){"bodies[0].rod.segments=1", text, NULL});
    }
}

TEST_IN_FOLDER(a_mechanism_is_reported) {
    const char *const none[] = {NULL};
    try_all(context, "tests/data/scenes/closed.yaml", 3, none);
    try_all(context, "tests/data/scenes/arms.yaml", 7, none);
}

TEST_IN_FOLDER(a_turbine_is_reported) {
    try_all(context, "tests/data/scenes/example-turbine.yaml", 23, (const char *const[]){NULL});
}
