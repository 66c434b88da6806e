// The functions of the Functional Mock-up Interface 3.0, declared from its text
// (https://fmi-standard.org): those of co-simulation.
#pragma once

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
typedef void fmi3_intermediate(fmi3_environment environment, double time, bool set, bool get, bool finished,
                               bool can_return, bool *return_asked, double *return_time);
typedef void fmi3_clock(fmi3_environment environment);
typedef void fmi3_lock(void);

// Types of the functions, for an importer that looks them up by name too.
typedef const char *fmi3_get_version(void);
typedef fmi3_status fmi3_set_logging(fmi3_instance instance, bool on, size_t n, const fmi3_string *category);
typedef fmi3_instance fmi3_instantiate(fmi3_string name, fmi3_string token, fmi3_string resources,
                                       bool visible, bool logging, bool event_mode, bool early_return,
                                       const fmi3_reference *intermediate, size_t n_intermediate,
                                       fmi3_environment environment, fmi3_log *log,
                                       fmi3_intermediate *update);
typedef void fmi3_free(fmi3_instance instance);
typedef fmi3_status fmi3_enter_initialization(fmi3_instance instance, bool has_tolerance, double tolerance,
                                              double start, bool has_stop, double stop);
typedef fmi3_status fmi3_change(fmi3_instance instance);
typedef fmi3_status fmi3_get_float64(fmi3_instance instance, const fmi3_reference *reference, size_t n,
                                     double *value, size_t n_value);
typedef fmi3_status fmi3_set_float64(fmi3_instance instance, const fmi3_reference *reference, size_t n,
                                     const double *value, size_t n_value);
typedef fmi3_status fmi3_get_state(fmi3_instance instance, fmi3_state *state);
typedef fmi3_status fmi3_set_state(fmi3_instance instance, fmi3_state state);
typedef fmi3_status fmi3_count_dependencies(fmi3_instance instance, fmi3_reference reference, size_t *n);
typedef fmi3_status fmi3_do_step(fmi3_instance instance, double time, double step, bool no_return,
                                 bool *event, bool *terminate, bool *early, double *reached);

FMI3_API fmi3_get_version fmi3GetVersion;
FMI3_API fmi3_set_logging fmi3SetDebugLogging;
FMI3_API fmi3_instantiate fmi3InstantiateCoSimulation;
FMI3_API fmi3_free fmi3FreeInstance;
FMI3_API fmi3_enter_initialization fmi3EnterInitializationMode;
FMI3_API fmi3_change fmi3ExitInitializationMode, fmi3Terminate, fmi3Reset;
FMI3_API fmi3_get_float64 fmi3GetFloat64;
FMI3_API fmi3_set_float64 fmi3SetFloat64;
FMI3_API fmi3_get_state fmi3GetFMUState, fmi3FreeFMUState;
FMI3_API fmi3_set_state fmi3SetFMUState;
FMI3_API fmi3_count_dependencies fmi3GetNumberOfVariableDependencies;
FMI3_API fmi3_do_step fmi3DoStep;
