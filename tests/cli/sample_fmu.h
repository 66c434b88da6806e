// What the FMUs for tests have in common: the arguments of an instance that they read, and its end.
#pragma once

#include "apps/bough/model/fmi3.h"

#include <stdlib.h>

struct sample *instantiate(fmi3_string token, fmi3_string resources, fmi3_environment environment,
                           fmi3_log *log);

fmi3_instance fmi3InstantiateCoSimulation(fmi3_string name, fmi3_string token, fmi3_string resources,
                                          bool visible, bool logging, bool event_mode, bool early_return,
                                          const fmi3_reference *intermediate, size_t n_intermediate,
                                          fmi3_environment environment, fmi3_log *log,
                                          fmi3_intermediate *update) {
    (void)name, (void)visible, (void)logging, (void)event_mode, (void)early_return, (void)intermediate;
    (void)n_intermediate, (void)update;
    return instantiate(token, resources, environment, log);
}

void fmi3FreeInstance(fmi3_instance instance) { free(instance); }

fmi3_status fmi3ExitInitializationMode(fmi3_instance instance) { return instance ? FMI3_OK : FMI3_ERROR; }

fmi3_status fmi3Terminate(fmi3_instance instance) { return instance ? FMI3_OK : FMI3_ERROR; }
