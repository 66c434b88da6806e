// The outline of a blade's section: interpolated between the two nearest airfoils, whose sides have points at
// equal shares of their arcs, and scaled.
#ifndef BOUGH_IMPORT_WINDIO_OUTLINE_H
#define BOUGH_IMPORT_WINDIO_OUTLINE_H

#include "apps/bough/import/windio.h"

enum { BOUGH_OUTLINE_SIDE = 80, BOUGH_OUTLINE = 2 * BOUGH_OUTLINE_SIDE };

// Points from the trailing edge along the suction side to the leading edge and back along the pressure
// side, the last at the first one; in section axes about the reference line: x towards the suction
// side, y towards the trailing edge.
typedef struct bough_outline {
    double x[BOUGH_OUTLINE + 1], y[BOUGH_OUTLINE + 1]; // [m]
    double arc[BOUGH_OUTLINE + 1];                     // from 0 to 1
    double length;                                     // of the way round [m]
} bough_outline;

// Airfoils of unit chord, (n × 2 × (BOUGH_OUTLINE + 1)): x along the chord, y towards the suction side,
// of each place of the shape; NULL after a failure.
const double *bough_windio_airfoils(bough_windio *w);

// The outline at a share of the blade.
void bough_windio_outline_at(const bough_windio *w, const double *airfoils, double share, bough_outline *to);

// The arc where a straight line crosses a side (0 suction, 1 pressure). The line is normal to the direction
// that is turned from the chord towards the suction side by `turn` [rad]; `offset` is its distance from the
// reference line in that direction [m]. Without a crossing: the nearest point.
double bough_outline_crossing(const bough_outline *o, int side, double turn, double offset);

#endif
