// What the errors that a companion tells mean: which of them counts, beside what moves in the scene.
#ifndef BOUGH_APPS_MODEL_ERROR_VERDICT_H
#define BOUGH_APPS_MODEL_ERROR_VERDICT_H

#include "apps/bough/model/companion.h"

enum { BOUGH_ERROR_SIZE = 96 };

typedef struct bough_error_verdict {
    int channel;     // with the largest error relative to its range; −1: none counts
    double relative; // that error
    double time;     // when it became noticeable [s]; −1: it is not
} bough_error_verdict;

// Whether the channel is a displacement, an angle or a velocity of a body. Forces and moments answer errors
// of the highest frequencies; the motion shows what they mean.
bool bough_error_is_motion(const bough_channel *channel);

// Range of the channel in its unit: of the run or of the companion, whichever is less, so that one that runs
// away has a size. Components of a vector have one range, the largest of theirs; a velocity that hardly
// changes has a thousandth of its value, and where the whole scene is at rest a motion has the scene's size.
double bough_error_range(const bough_companion *c, int channel);

// An error of the channel, in its unit, relative to its range; NaN for one that keeps its value.
double bough_error_relative(const bough_companion *c, int channel, double error);

// Whether a channel counts: channels that move, or err, by less than a thousandth of other channels of their
// kind, and those whose motion is rounding do not.
bool bough_error_counts(const bough_companion *c, int channel);

// The channel with the largest relative error: of motion, or of forces and moments. `error`
// (channels->count): the companion's, or a share of it.
bough_error_verdict bough_error_verdict_of(const bough_companion *c, bool motion, const double *error);

// Up to `most` channels that count, with the largest relative errors first: their number.
int bough_error_worst(const bough_companion *c, int most, int *channel);

// The error of a channel in words, as "0.2 m, 0.03 of its range". A range of rounding is none to measure by:
// an error beyond ten ranges is said to be so.
void bough_error_size(const bough_companion *c, int channel, char text[BOUGH_ERROR_SIZE]);

// Notes which errors are noticeable now, at t [s].
void bough_error_notice(bough_companion *c, double t);

#endif
