// Pictures in SVG that are legible on light and on dark pages: texts, and charts of panels with two axes.
#pragma once

#include "core/base/arena.h"

// Begins a picture [px]; "</svg>" ends it. The classes grid, axis and weak (text) have their own colours;
// other texts and shapes without a fill have the colour of text.
void bough_picture_begin(FILE *svg, int width, int height);

// A text within an element or an attribute: the characters that XML reserves are replaced.
void bough_picture_text(FILE *svg, const char *text);

// Characters of a text, not bytes.
int bough_picture_letters(const char *text);

// -- charts ---------------------------------------------------------------------------------------

typedef struct bough_axis {
    double low, high; // values at its ends, of a logarithmic one their logarithms to base 10
    double from, to;  // its ends [px]
    bool logarithmic;
} bough_axis;

typedef struct bough_chart_point {
    double x, y;       // not drawn where it has no place on an axis
    double bar[2];     // ends of a vertical bar through it, unless equal
    const char *label; // beside it; NULL: none
    const char *hint;  // what a viewer shows for it; NULL: none
    double size;       // of its mark over the usual one; 0: usual
} bough_chart_point;

typedef struct bough_chart_line {
    const char *name;    // in the legend; NULL: not there
    int colour;          // each has its own mark; −1: grey, dashed, without marks
    bool joined, marked; // its points are joined; each has a mark
    int end;             // of its points in the chart
} bough_chart_line;

typedef struct bough_chart_panel {
    const char *heading, *across; // above it; below it, what x is
    bough_axis x, y;              // begin with the range that includes every point
    int end;                      // of its lines in the chart
} bough_chart_panel;

// Panels of one size in rows, below them a legend of the first panel's lines. Filled in order: a line belongs
// to the panel added last, a point to the line added last. Texts are not copied.
typedef struct bough_chart {
    bough_arena *arena;
    const char *title; // NULL: none
    int per_row;       // panels side by side
    int right;         // room for labels beside a panel [px]
    int n_panel, n_line, n_point, room[3];
    bough_chart_panel *panel; // (n_panel)
    bough_chart_line *line;   // (n_line)
    bough_chart_point *point; // (n_point)
} bough_chart;

bough_chart bough_chart_start(bough_arena *arena, const char *title, int per_row);
void bough_chart_add_panel(bough_chart *chart, const char *heading, const char *across, bool log_x,
                           bool log_y);
void bough_chart_add_line(bough_chart *chart, bough_chart_line line);
void bough_chart_add(bough_chart *chart, bough_chart_point point);

// Writes the picture; `chart`: a bough_chart.
void bough_chart_write(const void *chart, FILE *svg);
