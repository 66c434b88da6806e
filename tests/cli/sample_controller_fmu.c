// The library's law of variable speed as an FMU for tests: inputs generator speed and pitch, outputs torque,
// pitch, and a pitch for each blade.
#include "tests/cli/sample_fmu.h"
#include "tests/unit/nrel5mw_control.h"

enum { SPEED = 1, PITCH, GAIN, TORQUE, DEMAND, TIME };

typedef struct sample {
    bough_controller_def law;
    bough_controller_state state;
    double speed, pitch, time, time_input;
} sample;

sample *instantiate(fmi3_string token, fmi3_string resources, fmi3_environment environment, fmi3_log *log) {
    (void)token, (void)resources, (void)environment, (void)log;
    sample *s = calloc(1, sizeof *s);
    if (s) s->law = nrel5mw_control;
    return s;
}

fmi3_status fmi3EnterInitializationMode(fmi3_instance instance, bool has_tolerance, double tolerance,
                                        double start, bool has_stop, double stop) {
    (void)has_tolerance, (void)tolerance;
    ((sample *)instance)->time = start;
    return has_stop && stop > start ? FMI3_OK : FMI3_ERROR;
}

fmi3_status fmi3GetFloat64(fmi3_instance instance, const fmi3_reference *reference, size_t n, double *value,
                           size_t n_value) {
    const sample *s = instance;
    for (size_t k = 0; k < n && n == n_value; k++) {
        if (reference[k] != TORQUE && reference[k] != DEMAND) return FMI3_ERROR;
        value[k] = reference[k] == TORQUE ? s->state.torque : s->state.pitch;
    }
    return n == n_value ? FMI3_OK : FMI3_ERROR;
}

fmi3_status fmi3SetFloat64(fmi3_instance instance, const fmi3_reference *reference, size_t n,
                           const double *value, size_t n_value) {
    sample *s = instance;
    for (size_t k = 0; k < n && n == n_value; k++) {
        if (reference[k] == SPEED) s->speed = value[k];
        if (reference[k] == PITCH) s->pitch = value[k];
        if (reference[k] == TIME) s->time_input = value[k];
        if (reference[k] == GAIN) s->law.optimal_gain = value[k];
    }
    return n == n_value ? FMI3_OK : FMI3_ERROR;
}

// Communication points follow each other, and the time at the input is theirs.
fmi3_status fmi3DoStep(fmi3_instance instance, double time, double step, bool no_return, bool *event,
                       bool *terminate, bool *early, double *reached) {
    sample *s = instance;
    (void)no_return, (void)event, (void)terminate;
    if (time - s->time > 1e-9 || s->time - time > 1e-9 || s->time_input != time) return FMI3_ERROR;
    bough_controller_advance(&s->law, s->speed, s->pitch, step, &s->state);
    *early = false;
    s->time = *reached = time + step;
    return FMI3_OK;
}
