// A study: many runs of one scene and what is asked of them, as the user said it, checked down to
// the last run's settings before the first run starts.
//
// All memory belongs to the arena given to bough_study_read. Every struct begins with its place in
// the text.
#ifndef BOUGH_APPS_STUDY_STUDY_H
#define BOUGH_APPS_STUDY_STUDY_H

#include "apps/bough/config/text.h"
#include "core/base/arena.h"
#include "core/base/status.h"

#include <stdint.h>
#include <stdio.h>

enum { BOUGH_STUDY_AXES = 6, BOUGH_STUDY_MEASURES = 8, BOUGH_STUDY_CELLS = 10000 };

typedef enum bough_study_kind {
    BOUGH_STUDY_WORK_PRECISION,
    BOUGH_STUDY_TIMING,
    BOUGH_STUDY_STABILITY,
    BOUGH_STUDY_SWEEP,
    BOUGH_STUDY_LOAD_SET,
} bough_study_kind;

// A replacement in the scene.
typedef struct bough_study_setting {
    const bough_node *node; // of the value
    const char *key;        // "simulation.macro_step"
    const char *value;      // "5 ms", as written
    const char *set;        // "simulation.macro_step=5 ms", for bough_scene_read
} bough_study_setting;

typedef struct bough_study_settings {
    int n;
    bough_study_setting *item; // (n)
} bough_study_settings;

// A key of the grid with the values it takes.
typedef struct bough_study_axis {
    const bough_node *node; // of the key
    const char *key;
    const char *label; // the end of the key that tells it from the others
    bough_study_settings value;
} bough_study_axis;

typedef struct bough_study_grid {
    int n;
    bough_study_axis *axis; // (n)
} bough_study_grid;

// Channels whose differences form one vector.
typedef struct bough_study_vector {
    int n;
    const char **channel; // (n)
} bough_study_vector;

typedef struct bough_study_vectors {
    int n;
    bough_study_vector *item; // (n)
} bough_study_vectors;

typedef enum bough_study_norm { BOUGH_STUDY_EUCLID, BOUGH_STUDY_LARGEST } bough_study_norm;

// Largest difference to the reference over the run: of a vector by its norm, of several vectors
// the largest.
typedef struct bough_study_measure {
    const bough_node *node;
    const char *name;
    const char *channel; // as written; contained in `channels`
    bough_study_vectors channels;
    int norm;         // bough_study_norm
    double scale;     // from the channels' unit to `unit`
    const char *unit; // of the scaled difference; the channels' own unless given
} bough_study_measure;

// One run of the study.
typedef struct bough_study_cell {
    int index[BOUGH_STUDY_AXES]; // of its value on each axis; −1 for the reference
    int n_set;
    const char **set;     // (n_set) replacements in the scene
    int reference;        // to compare with
    uint64_t files;       // fingerprint of the scene's files, which must stay as they are; 0: may change
    const char *settings; // those that tell it from the other cells, "scheme=ramp, macro_step=5 ms"
} bough_study_cell;

typedef struct bough_study {
    const bough_node *node;
    const char *file; // path of the study
    const char *title;
    const char *scene_name, *scene; // as written; path
    int kind;                       // bough_study_kind
    bough_study_settings reference, common;
    bough_study_grid grid;
    int n_measure;
    bough_study_measure *measure;    // (n_measure)
    int repeat;                      // runs of each cell; times are their medians
    int threads;                     // 0: as the scene says
    struct bough_load_set *load_set; // all there is of kinds sweep and load-set, else NULL

    // by bough_study_expand
    int n_reference; // 1; of kind stability one for each combination of the model's parameters
    bough_study_cell *reference_cell; // (n_reference)
    int n_cell;
    bough_study_cell *cell; // (n_cell), the last axis runs fastest

    // by bough_study_check, common to all runs
    double duration, interval; // [s] interval: between the common output times
    int n_channel;
    const char **channel; // (n_channel) of all measures in their order
    uint64_t fingerprint; // of all that the cells' results depend on, besides their settings and files
} bough_study;

// Reads a study and checks it with every scene that its runs see. `threads` replaces the scene's
// unless 0. Every error found is added to `errors`; then the status is BOUGH_INVALID and *study is
// NULL.
bough_status bough_study_read(bough_arena *arena, const char *path, int threads, bough_errors *errors,
                              bough_study **study);

// Writes every key of a study, as Markdown and as JSON Schema.
void bough_study_help(FILE *stream);
void bough_study_json_schema(FILE *stream);

// A scene's path from that of the study which names it.
const char *bough_study_path(bough_arena *arena, const char *study, const char *scene);

// The value of a grid key in a cell; for the reference what its replacements say, "" if nothing.
const char *bough_study_value(const bough_study *study, const bough_study_cell *cell, int axis);

#endif
