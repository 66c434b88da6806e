#include "cosim/error_bound.h"

#include <math.h>

static const bough_error_window bound = {.defect = 0.05, .energy = 0.1},
                                hopeless = {.defect = 0.2, .energy = 0.2};
static const double above_least = 3; // the defect must have grown by that
static const double still_good = 1.5; // up to there the growth has not begun
static const double shrinking = 0.9; // below that times the window before, the error shrinks
enum { SUSTAINED = 2 };

static bool beyond(bough_error_window window, bough_error_window limit) {
    return window.defect > limit.defect && window.energy > limit.energy;
}

void bough_error_bound_close(bough_error_bound *b, bough_error_window window, int n_step,
                             double t) {
    bool grown = b->n_window > 0 && window.defect > above_least * b->least;
    bool holds = b->sustained == 0 || window.defect > shrinking * b->last.defect;
    b->sustained = grown && holds && beyond(window, bound) ? b->sustained + 1 : 0;
    b->growth = b->n_window > 0 && b->last.defect > 0
                    ? pow(window.defect / b->last.defect, 1.0 / n_step)
                    : 1;
    if (b->n_window == 0 || window.defect < b->least) b->least = window.defect;
    if (window.defect <= still_good * b->least) b->good_time = t;
    b->last = window;
    b->n_window++;
}

bool bough_error_bound_broken(const bough_error_bound *b) {
    return b->sustained >= SUSTAINED;
}

bool bough_error_bound_hopeless(const bough_error_bound *b) {
    return bough_error_bound_broken(b) && beyond(b->last, hopeless);
}
