// A scene as an FMU for co-simulation: a session behind the standard's functions. Value
// references: 0 the time, then the inputs, then the channels.
//
// resources/ holds scene.txt: the token, the path of the scene in resources/, its settings, a line each; and
// the scene with its files. Steps are whole numbers of macro steps.
#include "apps/bough/config/schema.h"
#include "apps/bough/exchange/bough.h"
#include "apps/bough/model/fmi3.h"

// NOLINTBEGIN(readability-function-size): FMI fixes the parameters

enum { MORE_SETTINGS = 2 };

typedef enum mode { INSTANTIATED, INITIALIZATION, STEP, TERMINATED } mode;

typedef struct instance {
    bough_session *session;
    double start; // time of the importer at the session's time 0 [s]
    double end;   // of the session's time, by the importer's stop time or the scene's duration [s]
    mode mode;
    bool changed; // inputs have other values than those at the start of the session, at its time 0
    char *scene;
    char **set; // (n_set + n_more), the last of a longer run
    int n_set, n_more;
    fmi3_log *log;
    fmi3_environment environment;
} instance;

typedef struct state {
    size_t size;
    double start;
    mode mode;
    bool changed;
    _Alignas(max_align_t) char copy[]; // (size)
} state;

// -- messages -------------------------------------------------------------------------------------

// Logs why a call fails: the standard has errors logged always.
__attribute__((format(printf, 2, 3))) static fmi3_status fail(const instance *x, const char *format, ...) {
    char text[2400];
    BOUGH_PRINT(text, format);
    if (x->log) x->log(x->environment, FMI3_ERROR, "logStatusError", text);
    return FMI3_ERROR;
}

static fmi3_status answer(const instance *x, int code) {
    if (code == BOUGH_SESSION_OK) return FMI3_OK;
    return fail(x, "%s", bough_session_error(x->session));
}

static fmi3_status misplaced(const instance *x, const char *function) {
    return fail(x, "%s: not allowed at this point", function);
}

const char *fmi3GetVersion(void) { return "3.0"; }

fmi3_status fmi3SetDebugLogging(fmi3_instance self, bool on, size_t n, const fmi3_string *category) {
    (void)self, (void)on, (void)n, (void)category;
    return FMI3_OK;
}

// The importer's time [s].
static double now(const instance *x) { return x->start + bough_session_time(x->session); }

// -- life -----------------------------------------------------------------------------------------

static char *join(const char *a, const char *b) {
    size_t size = strlen(a) + strlen(b) + 2;
    char *text = malloc(size);
    if (text) snprintf(text, size, "%s/%s", a, b);
    return text;
}

static bool add_setting(instance *x, const char *text) {
    char **set = realloc(x->set, ((size_t)x->n_set + 1 + MORE_SETTINGS) * sizeof *set);
    if (!set) return false;
    x->set = set;
    set[x->n_set] = strdup(text);
    return set[x->n_set++] != NULL;
}

// Reads resources/scene.txt; false when it is not there or of another FMU.
static bool read_resources(instance *x, const char *resources, const char *token) {
    char *line = NULL;
    size_t room = 0;
    char *path = join(resources, "scene.txt");
    FILE *file = path ? fopen(path, "r") : NULL;
    free(path);
    if (!file) return false;
    bool good = true;
    for (int number = 0; good && getline(&line, &room, file) >= 0; number++) {
        line[strcspn(line, "\r\n")] = '\0';
        if (number == 0) good = strcmp(line, token) == 0;
        if (number == 1) good = (x->scene = join(resources, line)) != NULL;
        if (number > 1) good = add_setting(x, line);
    }
    free(line);
    fclose(file);
    return good && x->n_set > 0;
}

static bool open_session(instance *x, const double *input) {
    bough_session_close(x->session);
    x->session = bough_session_open_with(x->scene, (const char *const *)x->set, x->n_set + x->n_more, input);
    x->end = bough_session_duration(x->session);
    x->changed = false;
    return x->session && bough_session_code(x->session) == BOUGH_SESSION_OK;
}

static void drop_more(instance *x) {
    while (x->n_more > 0) free(x->set[x->n_set + --x->n_more]);
}

fmi3_instance fmi3InstantiateCoSimulation(fmi3_string name, fmi3_string token, fmi3_string resources,
                                          bool visible, bool logging, bool event_mode, bool early_return,
                                          const fmi3_reference *intermediate, size_t n_intermediate,
                                          fmi3_environment environment, fmi3_log *log,
                                          fmi3_intermediate *update) {
    (void)visible, (void)logging, (void)early_return, (void)intermediate, (void)n_intermediate, (void)update;
    instance *x = calloc(1, sizeof *x);
    if (!x) return NULL;
    *x = (instance){.log = log, .environment = environment};
    bool good = false;
    if (!resources || !token || !read_resources(x, resources, token)) {
        fail(x, "%s: the resources are not those of this FMU", name ? name : "");
    } else if (event_mode) {
        fail(x, "the FMU has no event mode");
    } else {
        good = open_session(x, NULL);
        if (!good && x->session) fail(x, "%s", bough_session_error(x->session));
    }
    if (good) return x;
    fmi3FreeInstance(x);
    return NULL;
}

void fmi3FreeInstance(fmi3_instance self) {
    instance *x = self;
    if (!x) return;
    bough_session_close(x->session);
    drop_more(x);
    for (int k = 0; k < x->n_set; k++) free(x->set[k]);
    free(x->set);
    free(x->scene);
    free(x);
}

// Opens the session once more with its inputs as they are set: the state at time 0 follows from them.
static fmi3_status reopen(instance *x) {
    int n = bough_session_inputs(x->session);
    double *value = malloc(((size_t)n + 1) * sizeof *value), end = x->end;
    if (!value) return fail(x, "out of memory");
    for (int k = 0; k < n; k++) value[k] = bough_session_input_value(x->session, k);
    bool good = open_session(x, value);
    free(value);
    x->end = end;
    return good ? FMI3_OK : answer(x, BOUGH_SESSION_OTHER);
}

// A longer duration in macro steps of the same length.
static fmi3_status prolong(instance *x, double duration) {
    char longer[64], same_step[64];
    locale_t importers = bough_c_locale();
    snprintf(longer, sizeof longer, "simulation.duration=%.17g", duration);
    snprintf(same_step, sizeof same_step, "simulation.macro_step=%.17g",
             bough_session_macro_step(x->session));
    uselocale(importers);
    x->set[x->n_set] = strdup(longer);
    x->set[x->n_set + 1] = strdup(same_step);
    x->n_more = MORE_SETTINGS;
    return x->set[x->n_set] && x->set[x->n_set + 1] ? reopen(x) : fail(x, "out of memory");
}

fmi3_status fmi3EnterInitializationMode(fmi3_instance self, bool has_tolerance, double tolerance,
                                        double start, bool has_stop, double stop) {
    instance *x = self;
    (void)has_tolerance;
    (void)tolerance; // the scene's solvers have theirs
    if (x->mode != INSTANTIATED) return misplaced(x, "fmi3EnterInitializationMode");
    if (!isfinite(start)) return fail(x, "a run cannot start at %g s", start);
    if (has_stop && !(stop > start && isfinite(stop)))
        return fail(x, "a run from %g s cannot stop at %g s", start, stop);
    x->mode = INITIALIZATION;
    x->start = start;
    if (!has_stop) return FMI3_OK;
    double step = bough_session_macro_step(x->session), end = ceil((stop - start) / step - 1e-6) * step;
    bool longer = end > bough_session_duration(x->session) * (1 + 1e-12);
    fmi3_status status = longer ? prolong(x, end) : FMI3_OK;
    x->end = end;
    return status;
}

fmi3_status fmi3ExitInitializationMode(fmi3_instance self) {
    instance *x = self;
    if (x->mode != INITIALIZATION) return misplaced(x, "fmi3ExitInitializationMode");
    x->mode = STEP;
    return x->changed ? reopen(x) : FMI3_OK;
}

fmi3_status fmi3Terminate(fmi3_instance self) {
    instance *x = self;
    if (x->mode != STEP) return misplaced(x, "fmi3Terminate");
    x->mode = TERMINATED;
    return FMI3_OK;
}

fmi3_status fmi3Reset(fmi3_instance self) {
    instance *x = self;
    x->mode = INSTANTIATED;
    x->start = 0;
    drop_more(x);
    return open_session(x, NULL) ? FMI3_OK : answer(x, BOUGH_SESSION_OTHER);
}

// -- values ---------------------------------------------------------------------------------------

fmi3_status fmi3GetFloat64(fmi3_instance self, const fmi3_reference *reference, size_t n, double *value,
                           size_t n_value) {
    instance *x = self;
    if (x->changed && x->mode == INITIALIZATION && reopen(x) != FMI3_OK) return FMI3_ERROR;
    size_t inputs = (size_t)bough_session_inputs(x->session);
    const double *channel = bough_session_values(x->session);
    size_t count = (size_t)bough_session_count(x->session);
    if (n != n_value) return fail(x, "fmi3GetFloat64: %zu values of %zu", n_value, n);
    for (size_t k = 0; k < n; k++) {
        size_t at = reference[k];
        if (at > inputs + count || (at > inputs && !channel)) {
            return fail(x, "fmi3GetFloat64: no value of reference %zu", at);
        }
        value[k] = at == 0        ? now(x)
                   : at <= inputs ? bough_session_input_value(x->session, (int)at - 1)
                                  : channel[at - inputs - 1];
    }
    return FMI3_OK;
}

fmi3_status fmi3SetFloat64(fmi3_instance self, const fmi3_reference *reference, size_t n, const double *value,
                           size_t n_value) {
    instance *x = self;
    if (x->mode == TERMINATED) return misplaced(x, "fmi3SetFloat64");
    if (n != n_value) return fail(x, "fmi3SetFloat64: %zu values of %zu", n_value, n);
    for (size_t k = 0; k < n; k++) {
        if (reference[k] == 0 || reference[k] > (size_t)bough_session_inputs(x->session)) {
            return fail(x, "fmi3SetFloat64: no input of reference %zu", (size_t)reference[k]);
        }
        int input = (int)reference[k] - 1;
        bool other = value[k] != bough_session_input_value(x->session, input);
        int code = bough_session_set(x->session, input, value[k]);
        if (code != BOUGH_SESSION_OK) return answer(x, code);
        x->changed = x->changed || (other && x->mode < STEP);
    }
    return FMI3_OK;
}

// An output may depend on all inputs and states: its dependencies are not listed.
fmi3_status fmi3GetNumberOfVariableDependencies(fmi3_instance self, fmi3_reference reference, size_t *n) {
    (void)self;
    (void)reference;
    *n = 0;
    return FMI3_OK;
}

// -- states ---------------------------------------------------------------------------------------

fmi3_status fmi3GetFMUState(fmi3_instance self, fmi3_state *to) {
    const instance *x = self;
    size_t size = bough_session_size(x->session);
    state *s = realloc(*to, sizeof *s + size);
    if (!s) return fail(x, "out of memory");
    *to = s;
    *s = (state){size, x->start, x->mode, x->changed};
    return answer(x, bough_session_save(x->session, s->copy));
}

fmi3_status fmi3SetFMUState(fmi3_instance self, fmi3_state from) {
    instance *x = self;
    const state *s = from;
    if (!s || s->size != bough_session_size(x->session)) {
        return fail(x, "fmi3SetFMUState: not a state of this FMU");
    }
    fmi3_status status = answer(x, bough_session_restore(x->session, s->copy));
    if (status == FMI3_OK) x->start = s->start, x->mode = s->mode, x->changed = s->changed;
    return status;
}

fmi3_status fmi3FreeFMUState(fmi3_instance self, fmi3_state *from) {
    (void)self;
    if (!from) return FMI3_OK;
    free(*from);
    *from = NULL;
    return FMI3_OK;
}

// -- stepping -------------------------------------------------------------------------------------

// Whether two times are equal but for rounding: within far less than a step, also long after time 0.
static bool near(double a, double b, double step) {
    return fabs(a - b) <= fmin(1e-9 * fmax(1, fabs(b)), 1e-3 * step);
}

static fmi3_status check_step(const instance *x, double time, double step) {
    double macro_step = bough_session_macro_step(x->session), macro_steps = step / macro_step;
    if (!near(time, now(x), step) || !(step > 0))
        return fail(x, "fmi3DoStep: a step of %.9g s from %.15g s, the FMU is at %.15g s", step, time,
                    now(x));
    if (bough_session_time(x->session) + step > x->end + 1e-3 * macro_step)
        return fail(x,
                    "fmi3DoStep: %.9g s lead beyond the end at %.15g s, to be set by the stop time at the "
                    "initialisation",
                    step, x->start + x->end);
    if (fabs(macro_steps - round(macro_steps)) > 1e-3 || macro_steps < 0.5)
        return fail(x, "fmi3DoStep: %.9g s is not a whole number of macro steps of %.9g s", step, macro_step);
    return FMI3_OK;
}

// Macro steps up to a communication point, counted in the session's own time, which has no rounding of a late
// start.
fmi3_status fmi3DoStep(fmi3_instance self, double time, double step, bool no_return, bool *event,
                       bool *terminate, bool *early, double *reached) {
    instance *x = self;
    (void)no_return;
    *event = *terminate = *early = false;
    *reached = now(x);
    if (x->mode != STEP) return misplaced(x, "fmi3DoStep");
    if (check_step(x, time, step) != FMI3_OK) return FMI3_ERROR;
    double end = bough_session_time(x->session) + step - 1e-3 * bough_session_macro_step(x->session);
    while (bough_session_time(x->session) < end) {
        int code = bough_session_step(x->session);
        *reached = now(x);
        if (code != BOUGH_SESSION_OK) return answer(x, code);
    }
    return FMI3_OK;
}

// -- functions of the standard that the FMU does not offer ----------------------------------------

// The standard's functions that a co-simulation FMU of real numbers, without events, clocks and
// derivatives, must export but does not support: each logs and returns an error.

#pragma GCC diagnostic ignored "-Wunused-parameter"

#define NONE(name, ...)                                                                                      \
    FMI3_API fmi3_status name(__VA_ARGS__);                                                                  \
    fmi3_status name(__VA_ARGS__) { return fail(self, "%s: not supported", #name); }

#define SELF fmi3_instance self
#define REFERENCES SELF, const fmi3_reference *reference, size_t n
#define ACCESS(type, name)                                                                                   \
    NONE(fmi3Get##name, REFERENCES, type *value, size_t n_value)                                             \
    NONE(fmi3Set##name, REFERENCES, const type *value, size_t n_value)

ACCESS(float, Float32)
ACCESS(int8_t, Int8)
ACCESS(uint8_t, UInt8)
ACCESS(int16_t, Int16)
ACCESS(uint16_t, UInt16)
ACCESS(int32_t, Int32)
ACCESS(uint32_t, UInt32)
ACCESS(int64_t, Int64)
ACCESS(uint64_t, UInt64)
ACCESS(bool, Boolean)
ACCESS(fmi3_string, String)
NONE(fmi3GetBinary, REFERENCES, size_t *size, fmi3_binary *value, size_t n_value)
NONE(fmi3SetBinary, REFERENCES, const size_t *size, const fmi3_binary *value, size_t n_value)
NONE(fmi3GetClock, REFERENCES, bool *value)
NONE(fmi3SetClock, REFERENCES, const bool *value)

NONE(fmi3GetVariableDependencies, SELF, fmi3_reference dependent, size_t *element,
     fmi3_reference *independent, size_t *independent_element, int *kind, size_t n)
NONE(fmi3SerializedFMUStateSize, SELF, fmi3_state copy, size_t *size)
NONE(fmi3SerializeFMUState, SELF, fmi3_state copy, uint8_t *bytes, size_t size)
NONE(fmi3DeserializeFMUState, SELF, const uint8_t *bytes, size_t size, fmi3_state *copy)
NONE(fmi3GetDirectionalDerivative, SELF, const fmi3_reference *unknown, size_t n_unknown,
     const fmi3_reference *known, size_t n_known, const double *seed, size_t n_seed, double *value,
     size_t n_value)
NONE(fmi3GetAdjointDerivative, SELF, const fmi3_reference *unknown, size_t n_unknown,
     const fmi3_reference *known, size_t n_known, const double *seed, size_t n_seed, double *value,
     size_t n_value)

NONE(fmi3EnterConfigurationMode, SELF)
NONE(fmi3ExitConfigurationMode, SELF)
NONE(fmi3EnterEventMode, SELF)
NONE(fmi3EnterStepMode, SELF)
NONE(fmi3GetIntervalDecimal, REFERENCES, double *interval, int *qualifier)
NONE(fmi3GetIntervalFraction, REFERENCES, uint64_t *counter, uint64_t *resolution, int *qualifier)
NONE(fmi3GetShiftDecimal, REFERENCES, double *shift)
NONE(fmi3GetShiftFraction, REFERENCES, uint64_t *counter, uint64_t *resolution)
NONE(fmi3SetIntervalDecimal, REFERENCES, const double *interval)
NONE(fmi3SetIntervalFraction, REFERENCES, const uint64_t *counter, const uint64_t *resolution)
NONE(fmi3SetShiftDecimal, REFERENCES, const double *shift)
NONE(fmi3SetShiftFraction, REFERENCES, const uint64_t *counter, const uint64_t *resolution)
NONE(fmi3EvaluateDiscreteStates, SELF)
NONE(fmi3UpdateDiscreteStates, SELF, bool *again, bool *terminate, bool *nominals, bool *values,
     bool *has_next, double *next)
NONE(fmi3GetOutputDerivatives, REFERENCES, const int32_t *order, double *value, size_t n_value)

// Model exchange and scheduled execution
NONE(fmi3EnterContinuousTimeMode, SELF)
NONE(fmi3CompletedIntegratorStep, SELF, bool no_return, bool *event, bool *terminate)
NONE(fmi3SetTime, SELF, double time)
NONE(fmi3SetContinuousStates, SELF, const double *copy, size_t n)
NONE(fmi3GetContinuousStateDerivatives, SELF, double *rate, size_t n)
NONE(fmi3GetEventIndicators, SELF, double *indicator, size_t n)
NONE(fmi3GetContinuousStates, SELF, double *copy, size_t n)
NONE(fmi3GetNominalsOfContinuousStates, SELF, double *nominal, size_t n)
NONE(fmi3GetNumberOfEventIndicators, SELF, size_t *n)
NONE(fmi3GetNumberOfContinuousStates, SELF, size_t *n)
NONE(fmi3ActivateModelPartition, SELF, fmi3_reference clock, double time)

FMI3_API fmi3_instance fmi3InstantiateModelExchange(fmi3_string name, fmi3_string token,
                                                    fmi3_string resources, bool visible, bool logging,
                                                    fmi3_environment environment, fmi3_log *log);
fmi3_instance fmi3InstantiateModelExchange(fmi3_string name, fmi3_string token, fmi3_string resources,
                                           bool visible, bool logging, fmi3_environment environment,
                                           fmi3_log *log) {
    return NULL;
}

FMI3_API fmi3_instance fmi3InstantiateScheduledExecution(fmi3_string name, fmi3_string token,
                                                         fmi3_string resources, bool visible, bool logging,
                                                         fmi3_environment environment, fmi3_log *log,
                                                         fmi3_clock *clock, fmi3_lock *lock,
                                                         fmi3_lock *unlock);
fmi3_instance fmi3InstantiateScheduledExecution(fmi3_string name, fmi3_string token, fmi3_string resources,
                                                bool visible, bool logging, fmi3_environment environment,
                                                fmi3_log *log, fmi3_clock *clock, fmi3_lock *lock,
                                                fmi3_lock *unlock) {
    return NULL;
}

// NOLINTEND(readability-function-size)
