/* SPDX-License-Identifier: BSD-3-Clause */
/* A motion over spans of many segments: for each span and variable how far it strays from the chord, the straight line
 * in joint space between the span's ends. A binary tree over the segments, made once a motion, has this for blocks of
 * 4, 8, 16 … segments; any other span is a row of blocks. doc/robot-bounds.md, Spans */
#ifndef CPROX_KINEMATICS_SPANS_H
#define CPROX_KINEMATICS_SPANS_H

#include <stdbool.h>
#include <stddef.h>

struct cprox_motion;

enum { SPAN_MOST_LEVELS = 48 };

typedef struct motion_spans {
  size_t levels;                  /* 0: the motion is one segment, and nothing is stored */
  size_t first[SPAN_MOST_LEVELS]; /* of a level, its first block */
  double *blocks;                 /* [block][low, high, below, above][moving variable] */
  double *knots;                  /* [every fourth knot and the last one][moving variable] */
  double *error;                  /* [moving variable]: of the coefficients, the largest of all segments */
} motion_spans;

/* Linear in time and memory. False where memory is out. */
bool motion_spans_make(struct cprox_motion *motion);
void motion_spans_free(motion_spans *spans);

/* Where a span has its centre, and what it looks like. */
typedef struct span_centre {
  size_t segment;
  double u;
  bool bent; /* it strays from its chord by more than a small part of the chord's length: halves tell more */
} span_centre;

/* The rows of motion_fill_rows() over a span, from u = a of segment `first` to u = b of segment last - 1, which are at
 * least two. The values are those of the motion at the centre; the derivatives are those of a straight line through
 * it, which the motion follows at some pace, within MOTION_STRAY. */
span_centre motion_fill_span(const struct cprox_motion *motion, size_t first, double a, size_t last, double b,
                             double *rows);

#endif
