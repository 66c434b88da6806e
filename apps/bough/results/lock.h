// One process at a time writes into a results folder.
#ifndef BOUGH_OUTPUT_LOCK_H
#define BOUGH_OUTPUT_LOCK_H

#include "core/base/arena.h"
#include "core/base/status.h"

// Takes an existing folder until the arena is destroyed or the process ends, in whatever way. A folder
// that another process holds is refused with that process's number.
bough_status bough_lock_folder(bough_arena *arena, const char *folder);

#endif
