// What a run will take, before it starts.
#ifndef BOUGH_APPS_BOUGH_FORECAST_H
#define BOUGH_APPS_BOUGH_FORECAST_H

#include "apps/bough/cli/job.h"

// What a run records.
typedef struct bough_forecast {
    double rows;  // of channels.out
    double bytes; // of all files
} bough_forecast;

// Points of all lines of a shape.
double bough_forecast_points(const bough_shape *shape);

// Of the simulation with its channels and a shape of so many points.
bough_forecast bough_run_results(const bough_simulation *simulation, const bough_channels *channels,
                                 double n_point);

// Writes "results: 101 rows of 6 columns, 0.012 MB".
void bough_forecast_print(bough_forecast forecast, const bough_channels *channels, FILE *stream);

// Tells what the job records, and of a long run (more than a million macro steps or a gigabyte)
// steps and time on stderr. BOUGH_INVALID where the results cannot fit on the disk of its folder.
bough_status bough_run_forecast(const bough_job *job, FILE *stream);

#endif
