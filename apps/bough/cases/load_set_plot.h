// Pictures: of a sweep a channel's mean, least and largest value over the first key of the grid; of a
// load set its ranges over how often they are exceeded in the life.
#ifndef BOUGH_APPS_STUDY_LOAD_SET_PLOT_H
#define BOUGH_APPS_STUDY_LOAD_SET_PLOT_H

#include "apps/bough/cases/lifetime.h"

enum { BOUGH_CASE_PANELS = 6 };

// Least, largest and mean of the first channels of every case; NaN where it failed.
typedef struct bough_case_plot {
    const bough_study *set;
    int n_panel;
    double *value; // (n_case × n_panel × 3)
} bough_case_plot;

bough_case_plot bough_case_plot_take(bough_arena *arena, const bough_study *set);
void bough_case_plot_add(bough_case_plot *plot, int number, const bough_case_result *result);

// Either writes folder/plot.svg.
bough_status bough_case_plot_write(const bough_case_plot *plot, const char *folder);
bough_status bough_lifetime_plot(const bough_lifetime *l, const char *folder);

#endif
