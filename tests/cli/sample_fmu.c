// A small FMU for tests, written against the standard and not against bough: a spring and a damper that
// follow a velocity, F = −k ∫v dt − c v. The instantiation token names a fault.
#include "tests/cli/sample_fmu.h"

#include <stdio.h>
#include <string.h>

enum { VELOCITY = 10, FORCE = 20, STIFFNESS = 30, DAMPING = 31 };

typedef struct sample {
    double x, v, time, stiffness, damping;
    bool entered; // the initialization
    const char *fault;
    void *environment;
    fmi3_log *log;
} sample;

static const char *const faults[] = {"", "late", "infinite", "early"};

sample *instantiate(fmi3_string token, fmi3_string resources, fmi3_environment environment, fmi3_log *log) {
    if (strcmp(token, "refuses") == 0) {
        log(environment, FMI3_ERROR, "all", "no licence");
        return NULL;
    }
    if (resources[0] != '/' || resources[strlen(resources) - 1] != '/') return NULL;
    sample *s = calloc(1, sizeof *s);
    if (!s) return NULL;
    *s = (sample){.stiffness = 8, .damping = 0.4, .fault = "", .environment = environment, .log = log};
    for (size_t k = 0; k < sizeof faults / sizeof *faults; k++) {
        if (strcmp(token, faults[k]) == 0) s->fault = faults[k];
    }
    return s;
}

fmi3_status fmi3EnterInitializationMode(fmi3_instance instance, bool has_tolerance, double tolerance,
                                        double start, bool has_stop, double stop) {
    (void)has_tolerance, (void)tolerance;
    ((sample *)instance)->entered = true;
    return start == 0 && has_stop && stop > 0 ? FMI3_OK : FMI3_ERROR;
}

fmi3_status fmi3GetFloat64(fmi3_instance instance, const fmi3_reference *reference, size_t n, double *value,
                           size_t n_value) {
    const sample *s = instance;
    if (n != 1 || n_value != 1 || reference[0] != FORCE) return FMI3_ERROR;
    value[0] = -s->stiffness * s->x - s->damping * s->v;
    if (strcmp(s->fault, "infinite") == 0 && s->time > 0.5) value[0] = 1 / (s->v - s->v);
    return FMI3_OK;
}

fmi3_status fmi3SetFloat64(fmi3_instance instance, const fmi3_reference *reference, size_t n,
                           const double *value, size_t n_value) {
    sample *s = instance;
    for (size_t k = 0; k < n && n == n_value; k++) {
        bool parameter = reference[k] == STIFFNESS || reference[k] == DAMPING;
        if (parameter == s->entered) return FMI3_ERROR; // parameters are set before, inputs after that
        if (reference[k] == VELOCITY) s->v = value[k];
        if (reference[k] == STIFFNESS) s->stiffness = value[k];
        if (reference[k] == DAMPING) s->damping = value[k];
    }
    return n == n_value ? FMI3_OK : FMI3_ERROR;
}

#ifndef LACKS_STEP
fmi3_status fmi3DoStep(fmi3_instance instance, double time, double step, bool no_return, bool *event,
                       bool *terminate, bool *early, double *reached) {
    sample *s = instance;
    (void)no_return, (void)event;
    if (strcmp(s->fault, "late") == 0 && time > 0.5) {
        s->log(s->environment, FMI3_ERROR, "all", "the oil is too hot");
        return FMI3_ERROR;
    }
    if (strcmp(s->fault, "early") == 0 && time > 0.5) *terminate = true;
    *early = false;
    s->x += step * s->v;
    s->time = *reached = time + step;
    return FMI3_OK;
}
#endif

fmi3_status fmi3GetFMUState(fmi3_instance instance, fmi3_state *state) {
    if (!*state) *state = malloc(sizeof(sample));
    if (!*state) return FMI3_ERROR;
    memcpy(*state, instance, sizeof(sample));
    return FMI3_OK;
}

fmi3_status fmi3SetFMUState(fmi3_instance instance, fmi3_state state) {
    memcpy(instance, state, sizeof(sample));
    return FMI3_OK;
}

fmi3_status fmi3FreeFMUState(fmi3_instance instance, fmi3_state *state) {
    (void)instance;
    free(*state);
    *state = NULL;
    return FMI3_OK;
}
