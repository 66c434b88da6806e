// The result of each case as a file of the study's folder, cases/NAME.case: text, complete or absent. Its
// head says of which input it is and how the run ended; then rows of a word and numbers, which keep all their
// digits. An interrupted study continues where it was, and a grid may grow.
//
// Claims say which process runs which case: each case has a record lock of fcntl(2) on one file of the
// study's folder. The operating system releases the lock when the process ends in any way, also on another
// machine of a cluster that shares the file system. On a file system without locks no process waits, and a
// case may run twice with the same result.
#ifndef BOUGH_APPS_CASES_STORE_H
#define BOUGH_APPS_CASES_STORE_H

#include "apps/bough/cases/case_run.h"

// Makes the folder cases/ of a study's folder.
bough_status bough_store_open(const char *folder);

bough_status bough_store_write(const char *folder, const bough_study *study, const bough_case *c,
                               bough_case_result *result);

// Reads a result, with statistics into memory of bough_case_take. result->done is false when there is none or
// it is of other input; BOUGH_IO when the file is damaged.
bough_status bough_store_read(const char *folder, const bough_study *study, const bough_case *c,
                              bough_case_result *result);

// Whether there is a result of this input, without reading its rows.
bool bough_store_has(const char *folder, const bough_study *study, const bough_case *c);

// The file of the claims, which is closed with the arena. A process opens it once only: closing it releases
// all locks of the process.
bough_status bough_claims_open(bough_arena *arena, const char *folder, int *claims);

// Takes a case for this process; false when another one has it.
bool bough_claim(int claims, int number);
void bough_claim_drop(int claims, int number);

#endif
