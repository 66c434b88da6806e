// bough run: one run, its files and its checkpoints.
#ifndef BOUGH_APPS_BOUGH_RUN_H
#define BOUGH_APPS_BOUGH_RUN_H

#include "apps/bough/cli/job.h"
#include "apps/bough/results/summary.h"

// Reads and builds the scene of the options, with what the run records and estimates. Errors in the
// scene are told as by bough_open_scene.
bough_status bough_job_build(bough_job *job);

// Writes summary.json into the job's folder.
bough_status bough_run_summarise(const bough_job *job);

// What the run errs by (run_error.c): into the summary, and in the closing lines.
void bough_run_write_error(bough_summary *s, const bough_job *job);
void bough_run_tell_error(const bough_job *job, FILE *stream);

// Tells the user how it went: a few lines "key: value".
void bough_run_report(bough_job *job, FILE *stream);

#endif
