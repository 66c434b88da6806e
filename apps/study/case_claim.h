// Which process runs which case: a record lock of fcntl(2) a case on one file of the study's folder.
// The system knows the owner and drops the lock with the process, in whatever way it ends, on the
// machines of a cluster through the shared file system: no claim grows stale. On a file system without
// locks nobody is held up, and a case may run twice, to the same result.
#ifndef BOUGH_APPS_STUDY_CASE_CLAIM_H
#define BOUGH_APPS_STUDY_CASE_CLAIM_H

#include "core/arena.h"
#include "core/status.h"

// The file of the claims, closed with the arena. One for a process: closing it drops them all.
bough_status bough_claims_open(bough_arena *arena, const char *folder, int *claims);

// Takes a case for this process; false when another one has it.
bool bough_claim(int claims, int number);
void bough_claim_drop(int claims, int number);

#endif
