#include "apps/bough/model/build_internal.h"

#include "apps/bough/model/fmi3.h"
#include "apps/bough/scene/fmu_archive.h"

#include <dlfcn.h>
#include <limits.h>
#include <math.h>
#include <string.h>
#include <unistd.h>

#if defined __x86_64__
#define PLATFORM "x86_64-linux"
#elif defined __aarch64__
#define PLATFORM "aarch64-linux"
#else
#define PLATFORM "unknown"
#endif

enum { MESSAGE = 200, MOST_STATES = 8 };

typedef struct fmu_member {
    const bough_scene_body *body;
    const bough_member *member;
    const char *folder; // where it is unpacked
    void *library;
    fmi3_instance instance;
    bool started;
    char message[MESSAGE]; // the FMU's last

    fmi3_instantiate *instantiate;
    fmi3_free *release;
    fmi3_enter_initialization *enter;
    fmi3_change *leave, *terminate;
    fmi3_get_float64 *get;
    fmi3_set_float64 *set;
    fmi3_do_step *step;
    fmi3_get_state *get_state, *free_state; // NULL unless it restores
    fmi3_set_state *set_state;

    int n_input, n_output;
    fmi3_reference input[BOUGH_SCENE_MOTION], output[BOUGH_SCENE_WRENCH];
    int from[BOUGH_SCENE_MOTION], to[BOUGH_SCENE_WRENCH]; // their components of motion and wrench
    double motion[BOUGH_SCENE_MOTION], wrench[BOUGH_SCENE_WRENCH];

    int n_state;
    fmi3_state state[MOST_STATES]; // that copies of this member refer to
    bool lost;                     // a copy of the state could not be made or restored
    long steps;
} fmu_member;

// -- messages -------------------------------------------------------------------------------------

static void hear(fmi3_environment environment, fmi3_status status, fmi3_string category, fmi3_string text) {
    fmu_member *x = environment;
    (void)category;
    if (status >= FMI3_DISCARD && text) snprintf(x->message, sizeof x->message, "%s", text);
}

static bool is_good(fmi3_status status) { return status == FMI3_OK || status == FMI3_WARNING; }

// After an error the standard allows an instance to be released only, after a fatal one not even that.
static bough_status refused(fmu_member *x, const char *function, double t, fmi3_status status) {
    static const char *const names[] = {"OK", "warning", "discard", "error", "fatal error"};
    const char *name = status <= FMI3_FATAL ? names[status] : "unknown status";
    x->started = false;
    if (status == FMI3_FATAL) x->instance = NULL;
    return bough_fail(BOUGH_FAILED, "%s: the FMU's %s at %.6g s: %s%s%s", x->body->name, function, t, name,
                      x->message[0] ? ": " : "", x->message);
}

// -- the library ----------------------------------------------------------------------------------

static void let_go(void *self) {
    fmu_member *x = self;
    for (int k = 0; k < x->n_state && x->instance; k++) x->free_state(x->instance, &x->state[k]);
    if (x->instance && x->started) x->terminate(x->instance);
    if (x->instance) x->release(x->instance);
    dlclose(x->library);
}

// Sets a pointer to the function of that name; the first that is missing remains in `missing`.
static void look_up(const fmu_member *x, const char *name, void *function, const char **missing) {
    void *symbol = dlsym(x->library, name);
    if (!symbol && !*missing) *missing = name;
    memcpy(function, &symbol, sizeof symbol); // of an object pointer: as POSIX has it
}

static bough_status misfit(const bough_scene_body *body, const char *what, const char *detail) {
    const bough_node *place = body->fmu.node;
    return bough_fail(BOUGH_INVALID, "%.160s:%d:%d: the FMU of '%.40s' %s %.200s", place->file, place->line,
                      place->column, body->name, what, detail);
}

static bough_status open_library(fmu_member *x, bough_arena *arena) {
    const bough_scene_fmu *fmu = &x->body->fmu;
    const bough_fmu_description *d = &fmu->description;
    char path[PATH_MAX];
    const char *missing = NULL;
    x->folder = fmu->folder;
    if (bough_fmu_is_archive(fmu->folder)) {
        bough_status status = bough_fmu_archive_unpack(arena, fmu->folder, &x->folder);
        if (!bough_is_ok(&status)) return status;
    }
    snprintf(path, sizeof path, "%s%s/binaries/" PLATFORM "/%s.so", strchr(x->folder, '/') ? "" : "./",
             x->folder, d->identifier);
    x->library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (!x->library) return misfit(x->body, "cannot be loaded:", dlerror());
    bough_arena_on_destroy(arena, let_go, x);
    look_up(x, "fmi3InstantiateCoSimulation", &x->instantiate, &missing);
    look_up(x, "fmi3FreeInstance", &x->release, &missing);
    look_up(x, "fmi3EnterInitializationMode", &x->enter, &missing);
    look_up(x, "fmi3ExitInitializationMode", &x->leave, &missing);
    look_up(x, "fmi3Terminate", &x->terminate, &missing);
    look_up(x, "fmi3GetFloat64", &x->get, &missing);
    look_up(x, "fmi3SetFloat64", &x->set, &missing);
    look_up(x, "fmi3DoStep", &x->step, &missing);
    if (d->restores) {
        look_up(x, "fmi3GetFMUState", &x->get_state, &missing);
        look_up(x, "fmi3SetFMUState", &x->set_state, &missing);
        look_up(x, "fmi3FreeFMUState", &x->free_state, &missing);
    }
    return missing ? misfit(x->body, "has no function", missing) : bough_ok();
}

// -- values ---------------------------------------------------------------------------------------

static bough_status set_motion(fmu_member *x, double t, const double *motion) {
    double value[BOUGH_SCENE_MOTION];
    for (int k = 0; k < x->n_input; k++) value[k] = motion[x->from[k]];
    if (x->n_input == 0) return bough_ok();
    fmi3_status status = x->set(x->instance, x->input, (size_t)x->n_input, value, (size_t)x->n_input);
    return is_good(status) ? bough_ok() : refused(x, "fmi3SetFloat64", t, status);
}

static bough_status get_wrench(fmu_member *x, double t) {
    double value[BOUGH_SCENE_WRENCH];
    if (x->n_output == 0) return bough_ok();
    fmi3_status status = x->get(x->instance, x->output, (size_t)x->n_output, value, (size_t)x->n_output);
    if (!is_good(status)) return refused(x, "fmi3GetFloat64", t, status);
    for (int k = 0; k < x->n_output; k++) {
        x->wrench[x->to[k]] = value[k];
        if (isfinite(value[k])) continue;
        return bough_fail(BOUGH_FAILED, "%s: output '%.60s' of the FMU at %.6g s: not a finite number",
                          x->body->name, x->body->fmu.output[x->to[k]]->name, t);
    }
    return bough_ok();
}

static void list_variables(fmu_member *x) {
    const bough_scene_fmu *fmu = &x->body->fmu;
    for (int k = 0; k < BOUGH_SCENE_MOTION; k++) {
        if (!fmu->input[k]) continue;
        x->from[x->n_input] = k;
        x->input[x->n_input++] = fmu->input[k]->reference;
    }
    for (int k = 0; k < BOUGH_SCENE_WRENCH; k++) {
        if (!fmu->output[k]) continue;
        x->to[x->n_output] = k;
        x->output[x->n_output++] = fmu->output[k]->reference;
    }
}

// -- own steps ------------------------------------------------------------------------------------

static bough_status step(fmu_member *x, double t, double h) {
    bool event = false, terminate = false, early = false;
    double reached = t + h;
    fmi3_status status =
        x->step(x->instance, t, h, !x->body->fmu.description.restores, &event, &terminate, &early, &reached);
    x->steps++;
    if (!is_good(status)) return refused(x, "fmi3DoStep", t, status);
    if (!terminate && !early) return bough_ok();
    return bough_fail(BOUGH_FAILED, "%s: the FMU ended its step at %.6g s, before %.6g s%s", x->body->name,
                      reached, t + h, terminate ? ": it asks to terminate" : "");
}

static bough_status advance(void *self, double *t, double pause, double t1, bool restart, double *y) {
    (void)pause, (void)restart, (void)y;
    fmu_member *x = self;
    const bough_signal *signal = x->member->signal;
    int n = x->body->fmu.steps;
    double t0 = *t, h = (t1 - t0) / n;
    double share = x->body->fmu.hold == BOUGH_SCENE_FMU_HELD ? 0.5 : 1;
    bough_status status = bough_ok();
    if (x->lost) {
        return bough_fail(BOUGH_FAILED, "%s: the FMU could not store or restore its state at %.6g s%s%s",
                          x->body->name, t0, x->message[0] ? ": " : "", x->message);
    }
    for (int k = 0; k < n && bough_is_ok(&status); k++) {
        double from = t0 + k * h;
        bough_signal_value(signal, from + share * h, x->motion);
        status = set_motion(x, from, x->motion);
        if (bough_is_ok(&status)) status = step(x, from, k < n - 1 ? h : t1 - from);
    }
    bough_signal_value(signal, t1, x->motion);
    if (bough_is_ok(&status)) status = set_motion(x, t1, x->motion);
    if (bough_is_ok(&status)) status = get_wrench(x, t1);
    *t = t1;
    return status;
}

static void statistics(const void *self, bough_statistics *sum) {
    const fmu_member *x = self;
    sum->steps += x->steps;
}

// A copy holds the number of one of the FMU's states, from 1, which later copies to that place replace.
static void transfer(void *self, bough_snapshot *s) {
    fmu_member *x = self;
    int *number = bough_snapshot_room(s, sizeof *number);
    bough_snapshot_doubles(s, x->wrench, BOUGH_SCENE_WRENCH);
    if (s->move == BOUGH_SNAPSHOT_MEASURE) return;
    bool known = *number >= 1 && *number <= x->n_state;
    if (s->move == BOUGH_SNAPSHOT_SAVE && !known && x->n_state < MOST_STATES) {
        *number = ++x->n_state;
        known = true;
    }
    if (!known) {
        x->lost = true;
        return;
    }
    fmi3_state *state = &x->state[*number - 1];
    fmi3_status status =
        s->move == BOUGH_SNAPSHOT_SAVE ? x->get_state(x->instance, state) : x->set_state(x->instance, *state);
    if (!is_good(status)) x->lost = true;
}

static const bough_integrator_ops steps = {.title = "FMU", .advance = advance, .statistics = statistics};
static const bough_integrator_ops steps_and_states = {
    .title = "FMU", .advance = advance, .statistics = statistics, .transfer = transfer};

// -- the system -----------------------------------------------------------------------------------

static void output(void *self, double t, const double *state, const double *input, double *out) {
    (void)t, (void)state, (void)input;
    const fmu_member *x = self;
    memcpy(out, x->wrench, sizeof x->wrench);
}

// There are no states, and the outputs do not follow the inputs of the same time.
static bool derivative(void *self, double t, const double *state, const double *input, double *rate) {
    (void)self, (void)t, (void)state, (void)input, (void)rate;
    return true;
}

// NOLINTNEXTLINE(readability-function-size): the contract fixes the parameters
static void output_tangent(void *self, double t, const double *state, const double *input,
                           const double *state_rate, const double *input_rate, double *rate) {
    (void)self, (void)t, (void)state, (void)input, (void)state_rate, (void)input_rate;
    memset(rate, 0, BOUGH_SCENE_WRENCH * sizeof *rate);
}

static void input_columns(void *self, double t, const double *state, const double *input, double *column) {
    (void)self, (void)t, (void)state, (void)input, (void)column;
}

static void *factors(void *self, bough_arena *arena) {
    (void)arena;
    return self;
}

static bool linearise(void *self, double t, const double *state, const double *input, void *kept) {
    (void)self, (void)t, (void)state, (void)input, (void)kept;
    return true;
}

static bool factor(void *self, void *kept, double gamma) {
    (void)self, (void)kept, (void)gamma;
    return true;
}

static void solve(void *self, void *kept, double *x) { (void)self, (void)kept, (void)x; }

static const bough_system_ops operations = {BOUGH_SYSTEM_REQUIRED};

// -- the beginning --------------------------------------------------------------------------------

static bough_status instantiate(fmu_member *x) {
    const bough_scene_fmu *fmu = &x->body->fmu;
    char here[PATH_MAX] = "", resources[2 * PATH_MAX + 16];
    bool absolute = x->folder[0] == '/';
    if (!absolute && !getcwd(here, sizeof here)) {
        return bough_fail(BOUGH_IO, "the name of the current folder is not known");
    }
    snprintf(resources, sizeof resources, "%s%s%s/resources/", here, absolute ? "" : "/", x->folder);
    x->instance = x->instantiate(x->body->name, fmu->description.token, resources, false, true, false, false,
                                 NULL, 0, x, hear, NULL);
    if (!x->instance) return refused(x, "fmi3InstantiateCoSimulation", 0, FMI3_ERROR);
    size_t n = (size_t)fmu->parameters.n;
    fmi3_status answer = n > 0 ? x->set(x->instance, fmu->reference, n, fmu->parameters.value, n) : FMI3_OK;
    return is_good(answer) ? bough_ok() : refused(x, "fmi3SetFloat64", 0, answer);
}

static bough_status initialise(fmu_member *x, const double *motion, double duration) {
    fmi3_status answer = x->enter(x->instance, false, 0, 0, true, duration);
    if (!is_good(answer)) return refused(x, "fmi3EnterInitializationMode", 0, answer);
    bough_status status = set_motion(x, 0, motion);
    if (bough_is_ok(&status)) {
        answer = x->leave(x->instance);
        x->started = is_good(answer);
        if (!x->started) return refused(x, "fmi3ExitInitializationMode", 0, answer);
    }
    return bough_is_ok(&status) ? get_wrench(x, 0) : status;
}

bough_status bough_fmu_member_create(bough_arena *arena, const bough_scene_body *body, const double *motion,
                                     double duration, bough_member *member) {
    fmu_member *x = bough_arena_take(arena, sizeof *x);
    *x = (fmu_member){.body = body, .member = member};
    list_variables(x);
    bough_status status = open_library(x, arena);
    if (bough_is_ok(&status)) status = instantiate(x);
    if (bough_is_ok(&status)) status = initialise(x, motion, duration);
    bool restores = body->fmu.description.restores;
    *member = (bough_member){.system = {.name = body->name,
                                        .kind = "FMU",
                                        .n_input = BOUGH_SCENE_MOTION,
                                        .n_output = BOUGH_SCENE_WRENCH,
                                        .ops = &operations,
                                        .self = x},
                             .solver = "FMU",
                             .opaque = true,
                             .state = bough_arena_doubles(arena, 1),
                             .integrated = bough_arena_doubles(arena, 1),
                             .input = bough_arena_doubles(arena, BOUGH_SCENE_MOTION),
                             .factors = x,
                             .integrator = {.ops = restores ? &steps_and_states : &steps, .self = x}};
    return status;
}
