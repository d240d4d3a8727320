/* SPDX-License-Identifier: BSD-3-Clause */
/* A motion over spans of many segments: for each span and variable how far it strays from the chord, the straight line
 * in joint space between the span's ends. A binary tree over the segments, made once a motion, has this for blocks of
 * 4, 8, 16 … segments; any other span is a row of blocks. doc/robot-clocks.md, Spans */
#ifndef CPROX_KINEMATICS_SPANS_H
#define CPROX_KINEMATICS_SPANS_H

#include <stdbool.h>
#include <stddef.h>

struct cprox_motion;
struct motion_track;

/* From u = a of segment `first` to u = b of segment last - 1: of a motion, or of one of its tracks. */
typedef struct motion_interval {
  double a, b;
  size_t first, last;
} motion_interval;

static inline bool motion_is_span(const motion_interval *over) {
  return over->first + 1 < over->last;
}

enum { SPAN_MOST_LEVELS = 48 };

typedef struct motion_spans {
  size_t levels;                  /* 0: the motion is one segment, and nothing is stored */
  size_t first[SPAN_MOST_LEVELS]; /* of a level, its first block */
  double *blocks;                 /* [block][low, high, below, above][moving variable] */
  double *knots;                  /* [every fourth knot and the last one][moving variable] */
  double *error;                  /* [moving variable]: of the coefficients, the largest of all segments */
} motion_spans;

/* Of a track whose segments are known. Linear in time and memory. False where memory is out. */
bool motion_spans_make(struct motion_track *track);
void motion_spans_free(motion_spans *spans);

/* Between these are all values of a moving variable over segments first … last - 1. */
void motion_track_range(const struct motion_track *track, size_t column, size_t first, size_t last, double *low,
                        double *high);

/* Where a span has its centre, and what it looks like. */
typedef struct span_centre {
  size_t segment;
  double u;
  double stray, chord; /* so far, at most, a variable strays from its chord; the length of the longest chord */
  bool bent;           /* it strays by more than a small part of the chord's length: halves tell more */
} span_centre;

/* The rows of motion_fill_track() over a span of the track's own segments. The values are those of the motion at the
 * centre; the derivatives are those of a straight line through it, which the motion follows at some pace, or by time,
 * within MOTION_STRAY. */
void motion_fill_span(const struct cprox_motion *motion, const struct motion_track *track, const motion_interval *over,
                      const motion_interval *own, span_centre *centre, double *rows);

#endif
