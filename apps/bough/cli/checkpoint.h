// Checkpoints of a run: DIR/checkpoint.bin holds all that the run goes on from. It is replaced,
// never overwritten, so that whenever the process dies the last one is whole.
//
// Integrators hide their histories, so they start anew at each checkpoint, in the run that writes
// it as in the one that goes on from it: a continued run is bitwise equal to an uninterrupted one
// with the same interval.
#ifndef BOUGH_APPS_BOUGH_CHECKPOINT_H
#define BOUGH_APPS_BOUGH_CHECKPOINT_H

#include "apps/bough/cli/job.h"

// Reads the options and, to resume, the checkpoint in the run's folder; the simulation is then at
// its time. BOUGH_INVALID where the interval does not suit the scene, there is no checkpoint, it is
// damaged or of another program, scene or setting.
bough_status bough_checkpoint_open(bough_job *job);

// After a step of a bough_job: writes a checkpoint where one is due and goes on from it.
bough_status bough_checkpoint_update(void *job);

// Removes that of an earlier run, or of one that is complete.
bough_status bough_checkpoint_remove(const char *folder);

#endif
