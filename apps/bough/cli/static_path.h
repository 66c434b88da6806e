// bough static --path: equilibria while the loads grow, with their limit points.
#ifndef BOUGH_APPS_BOUGH_STATIC_PATH_H
#define BOUGH_APPS_BOUGH_STATIC_PATH_H

#include "apps/bough/model/simulation.h"

// Prints the limit points and writes every channel at every point to static-path.csv in the folder. What
// has been followed is written also when the path ends before the loads are whole; the failure is
// returned.
bough_status bough_static_path(bough_arena *arena, bough_simulation *s, const char *folder);

#endif
