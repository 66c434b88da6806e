// Results of operations that can fail: a code and, when it is not BOUGH_OK, one message written
// where the failure arose. Mistakes of the program are caught by asserts.
#pragma once

#include "core/base/base.h"

typedef enum bough_code {
    BOUGH_OK = 0,
    BOUGH_RETRY,         // a smaller step may succeed; only the step controller gives up
    BOUGH_INVALID,       // bad input or usage: exit code 2
    BOUGH_FAILED,        // numerical failure, diagnosed: exit code 3
    BOUGH_IO,            // a file cannot be read or written: exit code 1
    BOUGH_OUT_OF_MEMORY, // exit code 1
    BOUGH_INTERRUPTED,   // the user asked to stop: exit code 130
} bough_code;

// Room for the longest message with its names and paths.
enum { BOUGH_MESSAGE = 1000 };

typedef struct bough_status {
    bough_code code;
    char message[BOUGH_MESSAGE]; // one sentence or two: what, where, when, what to try
} bough_status;

// The status of success; its message is not written, so it costs nothing to return.
bough_status bough_ok(void);

// A failure with a printf-style message. One that is too long ends after a whole word, with " ...".
bough_status bough_fail(bough_code code, const char *format, ...) __attribute__((format(printf, 2, 3)));

static inline bool bough_is_ok(const bough_status *status) { return status->code == BOUGH_OK; }

// Returns the status of `call` from the calling function unless it is BOUGH_OK.
#define BOUGH_TRY(call)                                                                                      \
    do {                                                                                                     \
        bough_status failed_ = (call);                                                                       \
        if (failed_.code != BOUGH_OK) return failed_;                                                        \
    } while (0)

// The exit code of the process for a final status.
int bough_exit_code(bough_code code);
