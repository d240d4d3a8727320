/* SPDX-License-Identifier: BSD-3-Clause */
/* Cosine and sine of an angle that is known to more digits than a double holds. */
#ifndef CPROX_CURVE_ANGLE_H
#define CPROX_CURVE_ANGLE_H

#include <math.h>

#include "base/double_double.h"

typedef struct angle {
  double cosine, sine;
} angle;

/* Each within 6u of the exact one, given cos() and sin() within 2u: by the sum formulas from those of the high and the
 * low part, whose products and sums add 4u. A low part below 1e-9 is its own sine, and its cosine 1, to less than
 * u/100. */
#define ANGLE_ERROR (6.0 * ROUND_U)

static inline angle angle_of(dd radians) {
  const double cos_high = cos(radians.high), sin_high = sin(radians.high);
  if (fabs(radians.low) < 1e-9)
    return (angle){.cosine = cos_high - sin_high * radians.low, .sine = sin_high + cos_high * radians.low};
  const double cos_low = cos(radians.low), sin_low = sin(radians.low);
  return (angle){.cosine = cos_high * cos_low - sin_high * sin_low, .sine = sin_high * cos_low + cos_high * sin_low};
}

#endif
