// The functions of the Functional Mock-up Interface 3.0, declared from its text
// (https://fmi-standard.org): those of co-simulation, and those of other kinds that a library must
// show too.
#ifndef BOUGH_APPS_FMU_FMI3_H
#define BOUGH_APPS_FMU_FMI3_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define FMI3_API __attribute__((visibility("default")))

typedef void *fmi3_instance;
typedef void *fmi3_environment;
typedef void *fmi3_state;
typedef uint32_t fmi3_reference;
typedef const char *fmi3_string;
typedef const uint8_t *fmi3_binary;

typedef enum fmi3_status { FMI3_OK, FMI3_WARNING, FMI3_DISCARD, FMI3_ERROR, FMI3_FATAL } fmi3_status;

typedef void fmi3_log(fmi3_environment environment, fmi3_status status, fmi3_string category,
                      fmi3_string message);
typedef void fmi3_intermediate(fmi3_environment environment, double time, bool set, bool get,
                               bool finished, bool can_return, bool *return_asked,
                               double *return_time);
typedef void fmi3_clock(fmi3_environment environment);
typedef void fmi3_lock(void);

FMI3_API const char *fmi3GetVersion(void);
FMI3_API fmi3_status fmi3SetDebugLogging(fmi3_instance instance, bool on, size_t n,
                                         const fmi3_string *category);
FMI3_API fmi3_instance fmi3InstantiateCoSimulation(
    fmi3_string name, fmi3_string token, fmi3_string resources, bool visible, bool logging,
    bool event_mode, bool early_return, const fmi3_reference *intermediate, size_t n_intermediate,
    fmi3_environment environment, fmi3_log *log, fmi3_intermediate *update);
FMI3_API void fmi3FreeInstance(fmi3_instance instance);
FMI3_API fmi3_status fmi3EnterInitializationMode(fmi3_instance instance, bool has_tolerance,
                                                 double tolerance, double start, bool has_stop,
                                                 double stop);
FMI3_API fmi3_status fmi3ExitInitializationMode(fmi3_instance instance);
FMI3_API fmi3_status fmi3Terminate(fmi3_instance instance);
FMI3_API fmi3_status fmi3Reset(fmi3_instance instance);
FMI3_API fmi3_status fmi3GetFloat64(fmi3_instance instance, const fmi3_reference *reference,
                                    size_t n, double *value, size_t n_value);
FMI3_API fmi3_status fmi3SetFloat64(fmi3_instance instance, const fmi3_reference *reference,
                                    size_t n, const double *value, size_t n_value);
FMI3_API fmi3_status fmi3GetFMUState(fmi3_instance instance, fmi3_state *state);
FMI3_API fmi3_status fmi3SetFMUState(fmi3_instance instance, fmi3_state state);
FMI3_API fmi3_status fmi3FreeFMUState(fmi3_instance instance, fmi3_state *state);
FMI3_API fmi3_status fmi3GetNumberOfVariableDependencies(fmi3_instance instance,
                                                         fmi3_reference reference, size_t *n);
FMI3_API fmi3_status fmi3DoStep(fmi3_instance instance, double time, double step, bool no_return,
                                bool *event, bool *terminate, bool *early, double *reached);

#endif
