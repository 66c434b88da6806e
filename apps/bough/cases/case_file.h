// The result of one case of a load set as a file of the study's folder, cases/NUMBER.case.
#ifndef BOUGH_APPS_STUDY_CASE_FILE_H
#define BOUGH_APPS_STUDY_CASE_FILE_H

#include "apps/bough/cases/case_run.h"

bough_status bough_case_write(const char *folder, const bough_load_set *set, int number,
                              const bough_case_result *result);

// Reads a result into memory of bough_case_take. result->done is false when there is no
// result or it belongs to other input; BOUGH_IO when the file is damaged.
bough_status bough_case_read(const char *folder, const bough_load_set *set, int number,
                             bough_case_result *result);

// Whether there is a result of this input, without reading its counts.
bool bough_case_exists(const char *folder, const bough_load_set *set, int number);

#endif
