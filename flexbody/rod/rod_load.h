// Forces and moments along a rod as work-equivalent loads on its vertices.
#pragma once

#include "flexbody/rod/rod.h"

// Where a load acts, in arc length: at `from` if to == from, else constant along [from, to].
typedef struct bough_rod_reach {
    double from, to; // [m]
} bough_rod_reach;

// Adds to the load a wrench (force, moment) [N, N m], in the load's axes. Along a stretch `wrench` is per
// length [N/m, N m/m] at its start and `end` at its end, linear between; NULL: the same. It is distributed to
// the vertices by hat functions. Between them it goes to load->line as well: on a part of a segment, or at a
// point of it, as the linear load that bends a uniform segment equally; not where it bends the segment by
// more than half a radian, as in a cable. Where sections vary, they bend by more or less: the difference
// becomes forces and moments on the segment's two vertices whose resultant is zero, in the axes of the
// undeformed rod.
void bough_rod_lump(const bough_rod_model *m, bough_rod_reach reach, const double *wrench, const double *end,
                    bough_rod_ramped_load *load);

// Puts what load->line does to the undeformed rod into load->value: forces and moments on the two vertices of
// each segment whose resultant is zero. For bodies that take loads on vertices only.
void bough_rod_lump_line(const bough_rod_model *m, bough_rod_ramped_load *load);

// The same of a strain D q (6 × stride) on a dead load: adds to value (6 × stride).
void bough_rod_lump_strain(const bough_rod_model *m, const double *line_strain, double *value);

// Loads per length in the axes of the segments' middles (12 × n_segment) from those in BRF axes (same);
// `rotation` are the vertices' quaternions, of about unit length (4 × (n_segment + 1)). Adds to the
// loads on the vertices (6 × (n_segment + 1), BRF axes) their moments about the segments' chords: they
// act on the axis, which bends away from the chords.
void bough_rod_take_line(const bough_rod_model *m, const double *rotation, const double *line, double *turned,
                         double *load);

// A kernel, called at its model's level.
BOUGH_DECLARE_LEVELS(bough_rod_take_line);
#define bough_rod_take_line(m, ...) BOUGH_OF_LEVEL(bough_rod_take_line, (m)->level)(m, __VA_ARGS__)
