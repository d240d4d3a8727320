/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions on one clock whose starts have tolerances: their pairs are searched class by class. A pair depends on the
 * starts of its own two sides alone. doc/robot-clocks.md, Starts with a tolerance */
#ifndef CPROX_ROBOT_QUERY_STARTS_H
#define CPROX_ROBOT_QUERY_STARTS_H

#include "kinematics/motion.h"

/* Pairs whose sides are on two clocks, or on one. Each clock has a time of its own: what the clock of all would show if
 * this one had started on time. */
typedef struct start_class {
  int32_t lead;  /* CLOCK_KNOWN: all clocks without a tolerance, and what stands */
  int32_t other; /* another clock, at a time of its own; CLOCK_NONE: both sides are on `lead`, or one of them stands */
  double lead_tolerance, other_tolerance; /* [s] */
} start_class;

enum { CLOCK_KNOWN = -1, CLOCK_STANDS = -2, CLOCK_NONE = -3 };

/* The class of all pairs without a tolerance, which comes first; the others by this: false after the last one. */
static inline start_class start_class_first(void) {
  return (start_class){.lead = CLOCK_KNOWN, .other = CLOCK_NONE};
}
bool start_class_next(const cprox_motion *motion, start_class *to);

static inline bool start_class_is_one_of_many(const cprox_motion *motion) {
  start_class first = start_class_first();
  return start_class_next(motion, &first);
}

/* Whether a pair of parts, or of a part and an obstacle (-1), belongs to a class; NULL: to any. */
bool start_class_has(const cprox_motion *motion, const start_class *of, int32_t part, int32_t other);

/* The clock that moves a part, if it has a tolerance; else CLOCK_KNOWN, or CLOCK_STANDS where nothing moves it. */
int32_t start_clock_of(const cprox_motion *motion, int32_t part);

/* What is possible of an interval of the times of a class's two clocks. */
typedef struct start_times {
  double lead[2], other[2]; /* [s] from, to */
} start_times;

/* Two times that are possible together are no farther apart than this. Takes off what is not possible with any time of
 * the other clock; then the middle of what is left is possible. False: nothing is left. Rounding is on the side of
 * more. */
bool start_times_fit(start_times *times, double most);

/* Corners of a polygon that contains all that is possible, the times going from -1/2 to 1/2 each: (lead, other). */
enum { START_CORNERS = 6 };
size_t start_times_corners(const start_times *times, double most, double corners[START_CORNERS][2]);

#endif
