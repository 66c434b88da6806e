// The work-precision diagram: cost against error on logarithmic axes, a panel for each measure, a
// line for each combination of the settings before the last, which runs along the line.
#ifndef BOUGH_APPS_STUDY_STUDY_PLOT_H
#define BOUGH_APPS_STUDY_STUDY_PLOT_H

#include "apps/bough/cases/study_table.h"

// Writes folder/plot.svg. Runs that failed have no point; the legend names them.
bough_status bough_study_plot(const bough_study_results *results, const char *folder);

#endif
