// The bound on the coupling error of one interface. The error is evaluated over windows of at least a second
// and 64 steps, by two measures:
//   - the defect, which is the obtained force minus the applied force, as its root mean square relative
//     to the largest force so far,
//   - the gross energy residual Σ|∫ defect · twist dt| relative to the energy exchanged.
// The solution is lost if both exceed the bound over two windows without a decrease, and are well above
// the earlier error of the same run. The last condition distinguishes an instability from a coarse but
// stable coupling, whose error stays at the level that the loads cause.
//
// Measured on a rotor of three flexible bodies, macro step 20 ms: stable explicit runs stay below
// 0.05 and 0.07 in their start-up and 0.02 and 0.04 after it; unstable ones end at 0.3 and 0.3.
#ifndef BOUGH_COSIM_ERROR_BOUND_H
#define BOUGH_COSIM_ERROR_BOUND_H

#include <stdbool.h>

typedef struct bough_error_window {
    double defect; // root mean square, relative [1]
    double energy; // gross residual, relative [1]
} bough_error_window;

typedef struct bough_error_bound {
    bough_error_window last; // the last closed window
    double growth;           // of the defect from the window before, per step [ratio]
    double least;            // smallest defect of a window so far
    double good_time;        // end of the last window before the defect grew [s]
    int n_window;
    int sustained; // number of successive windows beyond the bound
} bough_error_bound;

// Adds the window of n_step steps that ends at t.
void bough_error_bound_close(bough_error_bound *b, bough_error_window window, int n_step, double t);

// Whether the bound is broken for long enough.
bool bough_error_bound_broken(const bough_error_bound *b);

// Whether the error is so large that the run is meaningless, whatever its cause.
bool bough_error_bound_hopeless(const bough_error_bound *b);

#endif
