// bough run: one run, its files and its checkpoints.
#ifndef BOUGH_APPS_BOUGH_RUN_H
#define BOUGH_APPS_BOUGH_RUN_H

#include "apps/bough/job.h"
#include "apps/output/summary.h"

// Reads and builds the scene of the options, with what the run records and estimates. Errors in the
// scene are told as by bough_open_scene.
bough_status bough_job_build(bough_job *job);

// Writes summary.json into the job's folder.
bough_status bough_run_summarise(const bough_job *job);

// The shares of mesh and air (run_shares.c): into the summary; for the line of a channel; and why one
// is not estimated.
void bough_run_write_shares(bough_summary *s, const bough_job *job);
void bough_run_tell_channel_shares(const bough_job *job, int channel, FILE *stream);
void bough_run_tell_shares(const bough_job *job, FILE *stream);

// Tells the user how it went: a few lines "key: value".
void bough_run_report(bough_job *job, FILE *stream);

#endif
