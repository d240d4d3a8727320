/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/section.h"

#include <math.h>

#include "base/round_down.h"
#include "base/rounding.h"

/* The capsule round the control points of [t0, t1] of one piece, and a little more, or of the whole piece where there
 * are none. */
static curve_capsule reach_of(const cprox_curve *curve, size_t piece, double t0, double t1,
                              cprox_workspace *workspace) {
  vec3 p[CPROX_MAX_DEGREE + 1];
  if (WORKSPACE_LEND(workspace, cprox_curve_control_points(curve, t0, t1, workspace, p)) != CPROX_OK)
    return curve_capsule_at(curve, curve->n_leaves + piece);
  curve_capsule c = {.a = p[0], .b = p[curve->degree]};
  double largest = 0.0;
  for (size_t i = 0; i <= curve->degree; i++) {
    /* the capsule round a chord contains the hull of points that are near the chord */
    c.radius = fmax(c.radius, vec_to_segment(p[i], c.a, c.b));
    largest = fmax(largest, vec_norm(curve_piece(curve, piece)[i]));
  }
  const double degree = (double)curve->degree;
  c.radius = ROUND_UP * (c.radius + curve->error[piece] + (44.0 * degree + 40.0) * ROUND_U * largest);
  return c;
}

/* What the section's ends lie farther out than asked, as a fraction of the piece. */
static const double SECTION_OUTWARD = 10.0 * ROUND_U;

/* The part of a piece between two of its parameters, rounded outward: so that sections which share an end leave nothing
 * out. */
static curve_interval section_between(const cprox_curve *curve, size_t piece, double t0, double t1) {
  const double from = curve->breaks[piece], to = curve->breaks[piece + 1];
  const double a =
      fmin(round_fraction_below(from, to, t0), 1.0 - 0x1p-52);            /* at least one double before the end, and */
  const double b = fmax(round_fraction_above(from, to, t1), a + 0x1p-52); /* one after the beginning */
  return curve_side_section(curve, piece, a, b);
}

/* A point that is farther out than asked may be that much nearer: the curve is no faster than the ends of its
 * hodograph. */
double section_outward(const cprox_curve *curve, size_t piece) {
  const vec3 *p = curve_piece(curve, piece);
  double longest = 0.0;
  for (size_t i = 1; i <= curve->degree; i++) longest = fmax(longest, vec_norm(vec_sub(p[i], p[i - 1])));
  return ROUND_UP * SECTION_OUTWARD * (double)curve->degree * longest;
}

void query_ask_section(query *q, size_t piece, double t0, double t1) {
  q->part = section_between(q->mover.curve, piece, t0, t1);
  q->t0 = t0, q->t1 = t1;
  q->reach = reach_of(q->mover.curve, piece, t0, t1, q->workspace);
}
