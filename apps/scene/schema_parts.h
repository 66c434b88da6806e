// What the files of the schema share among themselves: units and ranges.
#ifndef BOUGH_APPS_SCENE_SCHEMA_PARTS_H
#define BOUGH_APPS_SCENE_SCHEMA_PARTS_H

#include "apps/scene/schema.h"

// "rad/s"; "" for a pure number.
const char *bough_dimension_unit(bough_dimension dimension);

// "an angle (in rad, or with a unit, as '5 deg')"
void bough_dimension_expected(bough_dimension dimension, char text[96]);

// Whether the text is a unit of the dimension; `why` then says why not.
bool bough_unit_fits(const char *text, bough_dimension dimension, char why[160]);

// A whole number of at most nine digits.
bool bough_whole_number(const char *text, int *value);

#endif
