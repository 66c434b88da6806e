// A study: runs of one or more scenes, all of which are checked before the first run starts. Runs are
// compared with a reference, or statistics of their channels are computed; of a load set also load cycles,
// load levels and extremes, weighted by the number of occurrences of each case in the turbine's lifetime.
//
// All memory belongs to the arena given to bough_study_read. Every struct begins with its place in
// the text.
#pragma once

#include "apps/bough/config/schema.h"
#include "apps/bough/config/text.h"

enum { BOUGH_STUDY_AXES = 6, BOUGH_STUDY_MEASURES = 8, BOUGH_MOST_CASES = 100000 };

typedef enum bough_study_kind {
    BOUGH_STUDY_WORK_PRECISION,
    BOUGH_STUDY_TIMING,
    BOUGH_STUDY_STABILITY,
    BOUGH_STUDY_SWEEP,
    BOUGH_STUDY_LOAD_SET,
} bough_study_kind;

// What distinguishes the kinds.
typedef struct bough_study_traits {
    bool compared; // each run is compared with a reference; otherwise it has statistics of its channels
    bool parallel; // runs are simultaneous, each on one thread, and may be divided into parts
    bool weighted; // loads over a lifetime
} bough_study_traits;

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

// A key of the grid with its values.
typedef struct bough_study_axis {
    const char *key;
    const char *label; // the end of the key that distinguishes it from the others
    bough_study_settings value;
} bough_study_axis;

typedef struct bough_study_grid {
    int n;
    bough_study_axis *axis; // (n)
} bough_study_grid;

// Channels as components of vectors.
typedef struct bough_study_vectors {
    int n_channel, n_vector;
    const char **channel; // (n_channel) vector after vector
    int *end;             // (n_vector) index after the last channel of each
} bough_study_vectors;

typedef enum bough_study_norm { BOUGH_STUDY_EUCLID, BOUGH_STUDY_LARGEST } bough_study_norm;

// Largest difference to the reference over the run: the norm of a vector, the largest of several vectors.
typedef struct bough_study_measure {
    const bough_node *node;
    const char *name;
    const char *channel; // as written; copied to `channels`
    bough_study_vectors channels;
    int norm;         // bough_study_norm
    double scale;     // from the channels' unit to `unit`
    const char *unit; // of the scaled difference; by default the channels' unit
} bough_study_measure;

// A design load case: a grid of settings.
typedef struct bough_load_group {
    const bough_node *node;
    const char *name;
    const char *scene_name; // replaces that of the set; NULL: it does not
    bough_study_settings set;
    bough_study_grid grid;
    // occurrence: one of these, or none if only extremes count
    double weibull;    // fraction of all hours, distributed over the speeds of the grid; 0: none
    double hours;      // in a year, of all cases together; 0: none
    double events;     // in a year, of all cases together; 0: none
    double factor;     // partial safety factor of extreme loads
    double favourable; // factor of a maximum below zero and a minimum above zero
    bool extremes;     // its extremes count
} bough_load_group;

typedef struct bough_load_wind {
    const bough_node *node;
    double average; // yearly mean at hub height [m/s]
    double shape;   // of the Weibull distribution; 2: Rayleigh distribution
} bough_load_wind;

// One run of the study.
typedef struct bough_case {
    int group;
    int index[BOUGH_STUDY_AXES]; // of its value on each axis of the group; −1: a reference has none
    const char *scene;           // path
    int n_set;
    const char **set;                    // (n_set) replacements in the scene
    const bough_study_setting **setting; // (n_set) where the study has each of them; NULL: nowhere
    const char *settings; // the settings that distinguish it from the others, "scheme=ramp, macro_step=5 ms"
    int reference;        // number of the reference that it is compared with
    double fraction;      // of its group's hours or events
    int next;             // next case with the same turbulence, to be run after it; −1: none
    bool follows;         // it is run after another case with the same turbulence
    uint64_t files; // fingerprint of the scene's files, which must not change during the study; 0: they may
    uint64_t fingerprint; // of everything that its result depends on
} bough_case;

typedef struct bough_study {
    const bough_node *node;
    const char *file; // path of the study
    const char *title, *scene_name;
    int kind; // bough_study_kind
    bough_study_traits is;
    bough_study_settings common;
    bough_study_grid grid; // of a load set: see its groups
    int threads;           // 0: those of the scene; with simultaneous runs as many as processors

    // of compared runs
    bough_study_settings reference;
    int n_measure;
    bough_study_measure *measure; // (n_measure)
    int repeat;                   // runs of each case; times are their medians

    // of statistics
    double from; // start of the statistics [s]
    bool series; // each case writes its channels
    int n_wanted;
    const char **wanted; // (n_wanted) channels; 0: all

    // of a lifetime
    int n_slope;
    double *slope;   // (n_slope) exponents of the S-N curves
    double cycles;   // of the equivalent loads
    double lifetime; // [years]
    int companions;  // every n-th case, from the first on, has a companion; 0: none
    bough_load_wind wind;
    int n_group;
    bough_load_group *group; // (n_group) load cases; of other studies one group of all cases

    // by bough_study_expand
    int n_reference;            // 1; of kind stability one for each combination of the model parameters
    bough_case *reference_case; // (n_reference)
    int n_case;
    bough_case *cases; // (n_case) group after group, the last axis varies fastest

    // by bough_study_check, common to all runs
    double duration, interval; // of compared runs; interval: between the common output times [s]
    int n_channel;
    const char **channel;       // (n_channel) of all measures in their order, or those of the statistics
    const char **unit;          // (n_channel) of those of the statistics
    bool *load;                 // (n_channel) whether they are forces or moments, also per length
    bough_schema_shared *files; // of the scenes, each read once
} bough_study;

// Reads a study and checks it with the scenes of all its runs. `threads` replaces the scene's number
// unless 0. Every error found is added to `errors`; then the status is BOUGH_INVALID and *study is
// NULL.
bough_status bough_study_read(bough_arena *arena, const char *path, int threads, bough_errors *errors,
                              bough_study **study);

// Writes every key of a study, as Markdown, which begins with study_help.md, and as JSON Schema.
extern const unsigned char bough_study_help_text[];
void bough_study_help(FILE *stream);
void bough_study_json_schema(FILE *stream);

// The path of a scene that a study names relative to itself.
const char *bough_study_path(bough_arena *arena, const char *study, const char *scene);

// The value of a grid key in a case; in a reference that of its replacements, "" if they have none.
const char *bough_study_value(const bough_study *study, const bough_case *c, int axis);

// The values of all other keys that have several: "ramp, 5 ms".
const char *bough_grid_others(bough_arena *arena, const bough_study *study, const bough_case *c, int axis);

// Whether a case is a reference of the study.
static inline bool bough_is_reference(const bough_study *study, const bough_case *c) {
    return c >= study->reference_case && c < study->reference_case + study->n_reference;
}

// Number of occurrences of a case's run, of which `counted` seconds are counted, in the lifetime; 0: it does
// not count for fatigue.
double bough_case_weight(const bough_study *study, const bough_case *c, double counted);

// -- reading a study ------------------------------------------------------------------------------

// What the files that read a study share among themselves.

// The study and its cases, without its scenes; NULL after an error.
bough_study *bough_study_parse(bough_arena *arena, const char *path, const bough_node *root,
                               bough_errors *errors);

// Readers of keys with their values, and of keys with lists of values.
void bough_study_read_settings(bough_schema_reader *r, const bough_node *node, void *field);
void bough_study_read_grid(bough_schema_reader *r, const bough_node *node, void *field);

// Makes the cases of all groups, and the references.
void bough_study_expand(bough_arena *arena, bough_study *study, bough_errors *errors);

// Reads every case's scene, looks up the channels and takes the fingerprints.
bough_status bough_study_check(bough_arena *arena, bough_study *study, bough_errors *errors);
