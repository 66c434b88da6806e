// Studies of kind sweep and load-set: many cases, each a run of a scene with its own settings. A study
// keeps the statistics of the channels of each case. A load set also keeps load cycles, load levels and
// extremes, weighted by the number of times that a case occurs in the turbine's lifetime.
//
// All memory belongs to the arena given to bough_load_set_read. Every struct that is read begins with
// its place in the text.
#ifndef BOUGH_APPS_STUDY_LOAD_SET_H
#define BOUGH_APPS_STUDY_LOAD_SET_H

#include "apps/bough/cases/counts.h"
#include "apps/bough/cases/study.h"

enum { BOUGH_MOST_CASES = 100000 };

// Cases of one kind, a design load case: a grid of settings.
typedef struct bough_load_group {
    const bough_node *node;
    const char *name;
    const char *scene_name; // in place of the set's; NULL: that
    bough_study_settings set;
    bough_study_grid grid;
    // How often: one of these, or none for extremes alone.
    double weibull;    // share of all hours, spread over the speeds of the grid; 0: not
    double hours;      // a year, of all cases together; 0: not
    double events;     // a year, of all cases together; 0: not
    double factor;     // partial safety factor of extreme loads
    double favourable; // of those that relieve: the largest below zero, the smallest above
    bool extremes;     // whether they count
} bough_load_group;

typedef struct bough_load_wind {
    const bough_node *node;
    double average; // of the year at hub height [m/s]
    double shape;   // of Weibull's distribution; 2: Rayleigh's
} bough_load_wind;

typedef struct bough_load_case {
    int group;
    int index[BOUGH_STUDY_AXES]; // of its value on each axis of the group
    const char *scene;           // path
    int n_set;
    const char **set;     // (n_set) replacements in the scene
    const char *settings; // "speed=12 m/s, seed=3"
    const char *command;  // that runs it alone
    double share;         // of its group's hours or events
    uint64_t files;       // fingerprint of the scene's files, which must stay as they are; 0: may change
    uint64_t fingerprint; // of all that its result depends on
} bough_load_case;

typedef struct bough_load_set {
    const bough_node *node;
    const char *file, *title, *scene_name;
    int kind;    // of the text; the study's own tells
    bool sweep;  // statistics alone
    double from; // what is before it is left out [s]
    bool series; // every case keeps its channels
    int n_wanted;
    const char **wanted; // (n_wanted) channels; none: all
    int n_slope;
    double *slope;   // (n_slope) exponents of the S-N curves
    double cycles;   // at which the lifetime's equivalent loads are told
    double lifetime; // [years]
    bough_load_wind wind;
    bough_study_settings common;
    bough_study_grid grid; // of a sweep
    int n_group;
    bough_load_group *group; // (n_group)

    // by bough_load_set_expand and bough_load_set_check
    int threads; // cases side by side; 0: as many as processors
    int n_case;
    bough_load_case *cases; // (n_case) by group, in it the last axis runs fastest
    int n_channel;
    const char **channel, **unit; // (n_channel)
} bough_load_set;

// Reads a study of either kind from its text and checks it with the scene of every case. Errors are added
// to `errors`; the set is NULL when there are any.
bough_load_set *bough_load_set_read(bough_arena *arena, const char *path, const bough_node *root, int threads,
                                    bough_errors *errors, bough_status *status);

// How many times the case's run occurs in the lifetime, of which `counted` seconds were counted;
// 0: no fatigue.
double bough_load_set_weight(const bough_load_set *set, const bough_load_case *c, double counted);

#endif
