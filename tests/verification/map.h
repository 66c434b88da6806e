// A map of runs as an SVG picture of coloured cells: blue for a run that held, darker for a smaller error;
// red for a run that was stopped. The text of a cell is shown when the pointer is on it.
#ifndef BOUGH_TESTS_VERIFICATION_MAP_H
#define BOUGH_TESTS_VERIFICATION_MAP_H

#include "core/base/status.h"

typedef struct bough_map_cell {
    enum { BOUGH_MAP_EMPTY, BOUGH_MAP_GOOD, BOUGH_MAP_STOPPED } kind;
    double shade;     // of a good one: 0 pale to 1 dark
    char text[24];    // shown in it, where there is room
    const char *hint; // shown when pointed at; NULL: the text
} bough_map_cell;

typedef struct bough_map {
    const char *title, *legend; // legend: what the colours mean
    const char *across;         // heads the columns
    int n_row, n_column;
    const char **row;     // (n_row) names; NULL leaves a gap
    const char **column;  // (n_column)
    bough_map_cell *cell; // (n_row × n_column)
    int column_width;     // [px]
} bough_map;

// Writes folder/name.
bough_status bough_map_write(const bough_map *map, const char *folder, const char *name);

#endif
