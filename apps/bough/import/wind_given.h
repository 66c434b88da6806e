// Files of wind in an imported scene: which form they have, and how the scene names them.
#ifndef BOUGH_IMPORT_WIND_GIVEN_H
#define BOUGH_IMPORT_WIND_GIVEN_H

#include "apps/bough/import/draft.h"

typedef enum bough_wind_form {
    BOUGH_WIND_UNIFORM_FILE, // rows over time
    BOUGH_WIND_TURBSIM,      // a box
    BOUGH_WIND_BLADED,       // another, with a .sum beside it
} bough_wind_form;

// The form of a file by how it begins.
bough_wind_form bough_wind_form_of(const char *path);

// Reads the file to check it and writes the beginning of the scene's `wind` without the closing brace. Height
// of the hub and diameter of the rotor [m] are used for files of rows. BOUGH_INVALID says what is wrong with
// the file; nothing is then written.
bough_status bough_wind_given(bough_draft *d, bough_wind_form form, const char *path, double height,
                              double diameter);

// The same for a box that was converted from other files; `path` is the first of them.
void bough_wind_made(bough_draft *d, const bough_wind_box *box, const char *path);

#endif
