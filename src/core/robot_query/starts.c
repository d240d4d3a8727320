/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/starts.h"

#include <math.h>

#include "base/rounding.h"

/* ---- classes ---- */

/* The next clock after this one that has a tolerance; CLOCK_NONE: there is none. Tracks are in the order of their
 * clocks. */
static int32_t next_clock(const cprox_motion *m, int32_t after, double *tolerance) {
  for (size_t k = 0; k < m->n_tracks; k++) {
    *tolerance = m->tracks[k].tolerance;
    if (*tolerance > 0.0 && m->tracks[k].clock > after) return m->tracks[k].clock;
  }
  *tolerance = 0.0;
  return CLOCK_NONE;
}

/* Of each lead first what is at the same time, then each clock behind it. */
bool start_class_next(const cprox_motion *m, start_class *to) {
  to->other = next_clock(m, to->other < to->lead ? to->lead : to->other, &to->other_tolerance);
  if (to->other != CLOCK_NONE) return true;
  to->lead = next_clock(m, to->lead, &to->lead_tolerance);
  return to->lead != CLOCK_NONE;
}

int32_t start_clock_of(const cprox_motion *m, int32_t part) {
  const int32_t axis = part < 0 ? -1 : m->carrier[m->robot->parts[part].axis + 1];
  if (axis < 0) return CLOCK_STANDS;
  const motion_track *track = &m->tracks[m->track_of[m->robot->axes[axis].variable]];
  return track->tolerance > 0.0 ? track->clock : CLOCK_KNOWN;
}

bool start_class_has(const cprox_motion *m, const start_class *of, int32_t part, int32_t other) {
  if (!of) return true;
  const int32_t a = start_clock_of(m, part), b = start_clock_of(m, other);
  const int32_t low = a < b ? a : b, high = a < b ? b : a;
  if (high < 0) return of->lead == CLOCK_KNOWN && of->other == CLOCK_NONE;
  if (low == CLOCK_STANDS || low == high) return of->lead == high && of->other == CLOCK_NONE;
  return of->lead == low && of->other == high;
}

/* ---- two times ---- */

static double rounding_of(const start_times *t, double most) {
  return 16.0 * ROUND_U * (fabs(t->lead[0]) + fabs(t->lead[1]) + fabs(t->other[0]) + fabs(t->other[1]) + most);
}

bool start_times_fit(start_times *t, double most) {
  const double room = most + rounding_of(t, most);
  for (int side = 0; side < 2; side++) {
    double *own = side ? t->other : t->lead;
    const double *far = side ? t->lead : t->other;
    own[0] = greater(far[0] - room, own[0]);
    own[1] = lesser(far[1] + room, own[1]);
    if (!(own[0] <= own[1])) return false;
  }
  return true;
}

/* Where the lead is late and the other one early, and the other way round, a corner of the square may be cut off: two
 * take its place. */
size_t start_times_corners(const start_times *t, double most, double corners[START_CORNERS][2]) {
  const double w = t->lead[1] - t->lead[0], h = t->other[1] - t->other[0];
  size_t n = 0;
  for (int end = 0; end < 2; end++) {
    const double s = end ? 0.5 : -0.5;
    corners[n][0] = s, corners[n++][1] = s;
    const double apart = end ? t->lead[1] - t->other[0] : t->other[1] - t->lead[0];
    const double excess = apart - most - rounding_of(t, most);
    if (excess > 0.0 && excess < w && excess < h) {
      corners[n][0] = s, corners[n++][1] = -s + 2.0 * s * (1.0 - 0x1p-40) * excess / h;
      corners[n][0] = s - 2.0 * s * (1.0 - 0x1p-40) * excess / w, corners[n++][1] = -s;
    } else {
      corners[n][0] = s, corners[n++][1] = -s;
    }
  }
  return n;
}
