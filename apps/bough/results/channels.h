// Names and units of what a run records, in groups: each source of values registers one group
// with its channels, which are always evaluated together. Building allocates, sampling does not.
#pragma once

#include "core/base/arena.h"

enum { BOUGH_CHANNEL_NAME = 48, BOUGH_CHANNEL_UNIT = 16 };

// Kind of a channel's quantity: what is compared with what, and how.
typedef enum bough_quantity_kind {
    BOUGH_KIND_OTHER, // coefficients, power, force per length
    BOUGH_KIND_LENGTH,
    BOUGH_KIND_ANGLE, // also the component of a direction, which is an angle where it is small
    BOUGH_KIND_VELOCITY,
    BOUGH_KIND_ANGULAR_VELOCITY,
    BOUGH_KIND_FORCE,
    BOUGH_KIND_MOMENT,
} bough_quantity_kind;

// What a channel is sampled by. Samples of the air approximate a continuous quantity; those of a controller
// are its output; what is a function of time has no error.
typedef enum bough_sampling {
    BOUGH_CONTINUOUS,
    BOUGH_BY_AIR,
    BOUGH_BY_CONTROL,
    BOUGH_BY_TIME
} bough_sampling;

typedef struct bough_channel {
    char name[BOUGH_CHANNEL_NAME]; // OpenFAST's name where the quantity is the same
    char unit[BOUGH_CHANNEL_UNIT]; // without parentheses: "m", "kN-m", "rpm", "-"
    bough_quantity_kind kind;
    const char *meaning; // one line; NULL: none
    double si;           // what one unit is in SI units
    double turn;         // of an angle: a whole turn in its unit; else 0
    bool load;           // a force or moment, also per length
    int vector;          // the first channel of the vector that it is a component of; its own index: a scalar
    int divisor;         // a quotient: its divisor is so many channels before it; 0: it is none
    bough_sampling sampled; // by what; where the values are known at samples only
} bough_channel;

// Of two values; an angle near its jump differs by a whole turn.
static inline double bough_channel_difference(const bough_channel *channel, double a, double b) {
    return channel->turn > 0 ? remainder(a - b, channel->turn) : a - b;
}

// Writes the group's values at time t [s], each in its channel's unit.
typedef void bough_channel_sample(void *self, double t, double *value);

typedef struct bough_channel_group {
    bough_channel_sample *sample;
    void *self;
    int first, count; // its channels
} bough_channel_group;

typedef struct bough_channels {
    bough_arena *arena;
    bough_channel *channel;     // (count); time is not among them
    bough_channel_group *group; // (group_count)
    int count, capacity;
    int *slot; // (2 capacity) channels by the hash of their names: index + 1, 0 where there is none
    int group_count, group_capacity;
    const double **known; // (1) present values, shared by copies of the list; NULL: the groups are evaluated
    bough_status status;  // BOUGH_INVALID where a name is not possible
} bough_channels;

// An empty list whose memory is the arena's.
bough_channels bough_channels_start(bough_arena *arena);

// Begins a group: the channels added next are written by `sample`.
void bough_channels_group(bough_channels *list, bough_channel_sample *sample, void *self);

// Adds a channel with a printf-style name. Names are unique, neither empty nor "Time" nor with
// blanks, since readers split the name row there; the first invalid one is in the list's status, and no
// channel is added after it.
void bough_channels_add(bough_channels *list, const char *unit, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Describes the channel added last: its meaning (not copied), which component of a vector it is (1, 2, 3; 0:
// a scalar), how many channels before it its divisor is (0: it is no quotient), and whether its values belong
// to the last sample of the air or the control.
void bough_channels_describe(bough_channels *list, const char *meaning, int component, int divisor,
                             bough_sampling sampled);

// The index of the channel with this name, −1 if there is none.
int bough_channels_find(const bough_channels *list, const char *name);

// The names (count), in the arena.
const char *const *bough_channels_names(const bough_channels *list, bough_arena *arena);

// Lists the channels of `all` whose names match one of n shell patterns ("Root*"), in their order; n = 0:
// all. `all` must outlive the list. Returns the first pattern that no name matches; −1: each matches one.
int bough_channels_choose(const bough_channels *all, int n, const char *const *pattern,
                          bough_channels *chosen);

// Sets the known values (count) of the list, its copies and the lists chosen from it, until the next call:
// they are then not evaluated a second time. NULL: no values are known.
void bough_channels_know(const bough_channels *list, const double *value);

// Evaluates every group unless the values are known: value (count).
void bough_channels_sample(const bough_channels *list, double t, double *value);
