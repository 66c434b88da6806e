// The standard's functions that a co-simulation FMU of real numbers, without events, clocks and
// derivatives, only shows: each answers that it is not there.
#include "apps/bough/model/fmi3.h"

#pragma GCC diagnostic ignored "-Wunused-parameter"

#define NONE(name, ...)                                                                                      \
    FMI3_API fmi3_status name(__VA_ARGS__);                                                                  \
    fmi3_status name(__VA_ARGS__) { return FMI3_ERROR; }

#define SELF fmi3_instance instance
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
NONE(fmi3SerializedFMUStateSize, SELF, fmi3_state state, size_t *size)
NONE(fmi3SerializeFMUState, SELF, fmi3_state state, uint8_t *bytes, size_t size)
NONE(fmi3DeserializeFMUState, SELF, const uint8_t *bytes, size_t size, fmi3_state *state)
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
NONE(fmi3SetContinuousStates, SELF, const double *state, size_t n)
NONE(fmi3GetContinuousStateDerivatives, SELF, double *rate, size_t n)
NONE(fmi3GetEventIndicators, SELF, double *indicator, size_t n)
NONE(fmi3GetContinuousStates, SELF, double *state, size_t n)
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
