// The project's verification of itself: studies of test models, exact solutions and other programs'
// figures, read from YAML as other studies are.
#pragma once

#include "apps/bough/config/text.h"
#include "core/base/arena.h"
#include "core/base/status.h"

typedef struct bough_verification_options {
    const char *folder; // for the results; made if missing
    int threads;        // 0: as the scenes say
    bool quiet;         // no progress line
    bool (*stop)(void); // asked before each step; NULL: never stops
    FILE *stream;       // receives the table
} bough_verification_options;

// A kind of study. What `read` returns `perform` takes.
typedef struct bough_verification_kind {
    const char *name; // of the key `kind`
    void *(*read)(bough_arena *arena, const char *path, const bough_node *root, bough_errors *errors);
    bough_status (*perform)(bough_arena *arena, const void *study, const bough_verification_options *options);
} bough_verification_kind;

typedef struct bough_verification {
    const bough_verification_kind *kind;
    void *study; // of that kind
} bough_verification;

// Reads a study and checks it. Every error found is added to `errors`; then the status is
// BOUGH_INVALID.
bough_status bough_verification_read(bough_arena *arena, const char *path, bough_errors *errors,
                                     bough_verification *verification);

// Writes the results into the folder and the table to the stream. BOUGH_FAILED when a figure is not
// the expected one, BOUGH_INTERRUPTED when stopped.
bough_status bough_verification_perform(bough_arena *arena, const bough_verification *verification,
                                        const bough_verification_options *options);
