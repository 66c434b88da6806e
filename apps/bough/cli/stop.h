// SIGINT, SIGTERM, SIGHUP and SIGXCPU as a wish to stop after the current step.
#ifndef BOUGH_APPS_BOUGH_STOP_H
#define BOUGH_APPS_BOUGH_STOP_H

#include <stdbool.h>

// From now on the first of these signals is remembered; a second one ends the process at once, except
// SIGXCPU. A reader of the output that ends does not end the process.
void bough_stop_listen(void);

bool bough_stop_requested(void);

#endif
