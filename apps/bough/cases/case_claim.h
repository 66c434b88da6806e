// Which process runs which case: each case has a record lock of fcntl(2) on one file of the study's
// folder. The operating system releases the lock when the process ends in any way, also on another machine
// of a cluster that shares the file system. On a file system without locks no process waits, and a case may
// run twice with the same result.
#ifndef BOUGH_APPS_STUDY_CASE_CLAIM_H
#define BOUGH_APPS_STUDY_CASE_CLAIM_H

#include "core/base/arena.h"
#include "core/base/status.h"

// The file of the claims, which is closed with the arena. A process opens it once only: closing it releases
// all locks of the process.
bough_status bough_claims_open(bough_arena *arena, const char *folder, int *claims);

// Takes a case for this process; false when another one has it.
bool bough_claim(int claims, int number);
void bough_claim_drop(int claims, int number);

#endif
