// Pictures in SVG that are legible on light and on dark pages: begin, texts, and panels with two axes.
#ifndef BOUGH_APPS_RESULTS_PICTURE_H
#define BOUGH_APPS_RESULTS_PICTURE_H

#include <stdbool.h>
#include <stdio.h>

// Begins a picture [px]; "</svg>" ends it. The classes grid, axis and weak (text) have their own colours;
// other texts and shapes without a fill have the colour of text.
void bough_picture_begin(FILE *svg, int width, int height);

// The heading at the top, `left` from the edge [px].
void bough_picture_title(FILE *svg, int left, const char *title);

// A text within an element or an attribute: the characters that XML reserves are replaced.
void bough_picture_text(FILE *svg, const char *text);

// Number of characters of a text in UTF-8.
int bough_picture_letters(const char *text);

// The k-th colour of a line, told apart by colour-blind readers; there are BOUGH_PICTURE_COLOURS.
enum { BOUGH_PICTURE_COLOURS = 7 };
const char *bough_picture_colour(int k);

typedef struct bough_axis {
    double low, high; // values at its ends, of a logarithmic one their logarithms to base 10
    double from, to;  // its ends [px]
    bool logarithmic;
} bough_axis;

// An axis without values.
bough_axis bough_axis_between(double from, double to, bool logarithmic);

// Extends the axis to a value; values that have no place on it are left out.
void bough_axis_include(bough_axis *axis, double value);

// Adds a margin of this share of its length at both ends; a logarithmic axis covers at least a factor of ten.
void bough_axis_widen(bough_axis *axis, double share);

// Where a value is [px].
double bough_axis_place(const bough_axis *axis, double value);

typedef struct bough_panel {
    FILE *svg;
    bough_axis x, y;
} bough_panel;

// Draws grid, numbers and lines of both axes, a title above the panel and what x is below it (NULL: nothing).
void bough_panel_axes(const bough_panel *panel, const char *title, const char *across);

#endif
