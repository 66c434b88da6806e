// One line on a terminal: how far a run is, how fast, and how long it still takes.
#pragma once

#include <stdbool.h>
#include <stddef.h>

typedef struct bough_progress {
    bool visible;        // stderr is a terminal and the user did not ask for quiet
    double start, end;   // simulated [s]
    double began, shown; // wall clock [s]
    const char *label;   // what runs, in place of the speed; NULL: none
} bough_progress;

bough_progress bough_progress_start(double t, double t_end, bool quiet);

// Call as often as convenient: the line is renewed at most ten times per second.
void bough_progress_show(bough_progress *p, double t);

// Clears the line, so that what is printed next starts at the margin.
void bough_progress_clear(const bough_progress *p);

// The text of a line with room for so many characters, at simulated time t after `wall` seconds: the speed
// and the time that is left, or the label, shortened to leave room for the time.
void bough_progress_text(const bough_progress *p, double t, double wall, int room, char *text, size_t size);

// CPU time of the process, or of the calling thread alone [s].
double bough_cpu_clock(bool thread);

// Monotonic wall clock [s], from an arbitrary origin.
double bough_wall_clock(void);
