#include "apps/bough/model/companion.h"

#include <math.h>
#include <stdlib.h>

// Between the least and the largest value of a table.
static double range_of(const bough_scene_load *load) {
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (int k = 0; k < load->n_time; k++) {
        low = fmin(low, load->values[k]);
        high = fmax(high, load->values[k]);
    }
    return high - low;
}

// The largest change to row k of a table from a row less than a step before it, but `first` at least.
static double change_to(const bough_scene_load *load, int k, int first, double step) {
    double change = 0;
    for (int j = k - 1; j >= first && load->times[k] - load->times[j] < step; j--)
        change = fmax(change, fabs(load->values[k] - load->values[j]));
    return change;
}

// At the start everything begins anew.
static int first_row(const bough_scene_load *load) {
    int first = 0;
    while (first < load->n_time && load->times[first] <= 0) first++;
    return first;
}

static void note(double at, double *time, int *n) {
    if (time) time[*n] = at;
    ++*n;
}

int bough_load_jumps(const bough_scene *scene, double part, double *time) {
    double step = scene->simulation.macro_step;
    int n = 0;
    for (int i = 0; i < scene->n_load; i++) {
        const bough_scene_load *load = &scene->load[i];
        double least = load->n_time > 0 ? part * range_of(load) : 0;
        int first = first_row(load);
        if (load->ramp[0] > 0 && load->ramp[1] - load->ramp[0] < step) note(load->ramp[1], time, &n);
        for (int k = first + 1; k < load->n_time; k++)
            if (change_to(load, k, first, step) > least) note(load->times[k], time, &n);
    }
    if (time) qsort(time, (size_t)n, sizeof *time, bough_ascending);
    return n;
}
