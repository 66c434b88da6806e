// Models of other programs as scenes.
#pragma once

#include "core/base/status.h"

// What the user adds to a model or takes in place of its own; NULL: as the model has it.
typedef struct bough_import_options {
    const char *wind;              // file of the wind
    const char *controller;        // library with Bladed's interface
    bool clamp_base;               // an offshore turbine without what is below its tower
    double hub_mass, nacelle_mass; // of a WindIO turbine without them [kg]; 0: not given
    int trial_steps; // macro steps for which the scene is tried and its errors judged; 0: two, not judged
} bough_import_options;

// Turns an OpenFAST model of a land-based turbine (the .fst file and those that it names) into
// `folder`/scene.yaml with its tables, and import.txt, a list of what was taken, approximated and
// left out, which `echo` also receives (NULL: nobody). The tolerance of the scene's integrator is the first
// of a few with which its first steps are good enough; where none is, the macro step is halved. Nothing is
// written unless the whole model could be read and there is such a tolerance. BOUGH_INVALID says file:line,
// the value's name and what was expected; BOUGH_FAILED says how the last trial ended.
bough_status bough_import_openfast(const char *path, const char *folder, const bough_import_options *options,
                                   FILE *echo);

// The same with a turbine of the WindIO ontology, a YAML file in the layout of version 1 or 2;
// BOUGH_INVALID says file:line:col.
bough_status bough_import_windio(const char *path, const char *folder, const bough_import_options *options,
                                 FILE *echo);
