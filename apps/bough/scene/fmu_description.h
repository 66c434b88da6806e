// The description of an FMU, modelDescription.xml, as far as an importer of real inputs and outputs needs
// it: FMI 3.0 (https://fmi-standard.org), co-simulation.
#ifndef BOUGH_APPS_SCENE_FMU_DESCRIPTION_H
#define BOUGH_APPS_SCENE_FMU_DESCRIPTION_H

#include "core/base/arena.h"
#include "core/base/status.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum bough_fmu_causality {
    BOUGH_FMU_INPUT,
    BOUGH_FMU_OUTPUT,
    BOUGH_FMU_LOCAL, // any other
} bough_fmu_causality;

// A variable of type Float64.
typedef struct bough_fmu_variable {
    const char *name;
    uint32_t reference;
    bough_fmu_causality causality;
    bool array;       // it has dimensions
    const char *unit; // as written; NULL: none
} bough_fmu_variable;

typedef struct bough_fmu_description {
    const char *identifier; // of the library
    const char *token;
    bool restores; // its state can be stored and restored
    bool once;     // only one instance in a process
    int n_variable;
    bough_fmu_variable *variable; // (n_variable)
    int n_scaled;
    const char **scaled; // (n_scaled) names of units that are not SI: with a factor or an offset
} bough_fmu_description;

// Reads FOLDER/modelDescription.xml of an unpacked FMU. BOUGH_INVALID: the file is missing or is no XML, the
// version is not 3, there is no co-simulation.
bough_status bough_fmu_describe(bough_arena *arena, const char *folder, bough_fmu_description *description);

// The variable of that name; NULL: there is none.
const bough_fmu_variable *bough_fmu_find(const bough_fmu_description *d, const char *name);

// Whether a variable's unit is declared with a factor other than 1 or with an offset.
bool bough_fmu_scaled(const bough_fmu_description *d, const bough_fmu_variable *variable);

#endif
