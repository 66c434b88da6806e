// What a run will take, before it starts.
#ifndef BOUGH_APPS_BOUGH_FORECAST_H
#define BOUGH_APPS_BOUGH_FORECAST_H

#include "apps/bough/run.h"

// Of a long run, tells steps, time and bytes on stderr: of more than a million macro steps or a
// gigabyte. BOUGH_INVALID where the results cannot fit on the disk of the job's folder.
bough_status bough_run_forecast(const bough_job *job);

#endif
