// The one way to open a file that somebody else has written: only a plain file of bounded size is
// opened, so that no reader waits for a pipe or reads from a device without end.
#pragma once

#include "core/base/arena.h"

enum { BOUGH_INPUT_REASON = 96 };

// Bytes: of a text that people write, and of data (wind, results, programs).
#define BOUGH_INPUT_TEXT (INT64_C(16) << 20)
#define BOUGH_INPUT_DATA (INT64_C(64) << 30)

// Opens a regular file of at most `most` bytes for reading. NULL: `reason` in a few words,
// errno as of open(2), EISDIR, EINVAL for anything else that is not a regular file, EFBIG.
FILE *bough_input_open(const char *path, int64_t most, char reason[BOUGH_INPUT_REASON]);

// The same file as a whole, *size bytes and a NUL behind them, in the arena's memory; NULL: `reason` as
// above.
char *bough_input_read(bough_arena *arena, const char *path, int64_t most, size_t *size,
                       char reason[BOUGH_INPUT_REASON]);
