// An instance of an FMU of FMI 3.0 for co-simulation: its library, its values and its communication steps.
#pragma once

#include "apps/bough/model/fmi3.h"
#include "apps/bough/scene/scene.h"

enum { BOUGH_FMU_MESSAGE = 200 };

typedef struct bough_fmu_instance {
    const char *name; // of the part of the scene
    const bough_scene_fmu_model *model;
    void *library;
    fmi3_instance instance;
    bool started;
    char message[BOUGH_FMU_MESSAGE]; // the FMU's last

    fmi3_instantiate *instantiate;
    fmi3_free *release;
    fmi3_enter_initialization *enter;
    fmi3_change *leave, *terminate;
    fmi3_get_float64 *get;
    fmi3_set_float64 *set;
    fmi3_do_step *step;
    fmi3_get_state *get_state, *free_state; // NULL unless it restores
    fmi3_set_state *set_state;
} bough_fmu_instance;

// Loads the library, makes an instance, which the arena releases, and sets the scene's parameters. `x` must
// not be moved. BOUGH_INVALID, with the place in the scene: no such library, or it lacks a function of the
// standard. Here and below BOUGH_FAILED: the FMU reports an error; the message is its own.
bough_status bough_fmu_open(bough_arena *arena, const bough_scene_fmu_model *model, const char *name,
                            bough_fmu_instance *x);

// Initialises the FMU at t [s] with its inputs out of `all` quantities; `end` of the run [s].
bough_status bough_fmu_initialise(bough_fmu_instance *x, double t, double end, const bough_fmu_values *inputs,
                                  const double *all);

bough_status bough_fmu_set(bough_fmu_instance *x, double t, const bough_fmu_values *inputs,
                           const double *all);

// Writes the FMU's outputs into `all` quantities. BOUGH_FAILED also if a value is not finite.
bough_status bough_fmu_get(bough_fmu_instance *x, double t, const bough_fmu_values *outputs, double *all);

// A communication step from t to t + h [s]. BOUGH_FAILED also if the FMU ends it early.
bough_status bough_fmu_step(bough_fmu_instance *x, double t, double h);

bool bough_fmu_is_good(fmi3_status status);
