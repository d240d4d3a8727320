/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/radius.h"

#include <math.h>
#include <stdio.h>

#include "base/workspace.h"
#include "curve/relative_curve.h"

/* A parameter of [a, b] at which a polynomial, given by its Bézier coefficients there, is below `least`, and its value
 * there; NAN: none that so many halvings find. */
static double place_below(const double *c, size_t degree, double least, double a, double b, int halvings,
                          double *value) {
  double left[CPROX_MAX_DEGREE + 1], right[CPROX_MAX_DEGREE + 1], lowest = INFINITY;
  for (size_t i = 0; i <= degree; i++) lowest = fmin(lowest, c[i]);
  if (lowest >= least) return NAN;
  *value = c[0] < least ? c[0] : c[degree];
  if (*value < least) return c[0] < least ? a : b;
  if (halvings == 0) return NAN;
  for (size_t i = 0; i <= degree; i++) right[i] = c[i];
  for (size_t level = 0; level <= degree; level++) {
    left[level] = right[0];
    for (size_t i = 0; i + level < degree; i++) right[i] = 0.5 * (right[i] + right[i + 1]);
  }
  const double middle = 0.5 * (a + b), found = place_below(left, degree, least, a, middle, halvings - 1, value);
  return isnan(found) ? place_below(right, degree, least, middle, b, halvings - 1, value) : found;
}

static cprox_status check_sign(const char *whose, const cprox_curve *radius, double constant,
                               cprox_workspace *workspace) {
  enum { HALVINGS = 26 };
  for (size_t piece = 0; piece < radius->n_pieces; piece++) {
    double c[CPROX_MAX_DEGREE + 1], value = 0.0;
    for (size_t i = 0; i <= radius->degree; i++) c[i] = curve_piece(radius, piece)[i].x;
    /* what rounding leaves of a radius that touches 0 */
    const double tolerance = radius->error[piece] + 1e-12 * (radius->largest + constant);
    const double t = place_below(c, radius->degree, -constant - tolerance, radius->breaks[piece],
                                 radius->breaks[piece + 1], HALVINGS, &value);
    if (isnan(t)) continue;
    return workspace_fail(workspace, CPROX_INVALID, "%s is %g at t = %.17g, must be 0 or more", whose, constant + value,
                          t);
  }
  return CPROX_OK;
}

/* Its parameters are those of `curve`, and with `constant` added it is never negative. */
static cprox_status check_radius(const char *whose, const cprox_curve *radius, double constant,
                                 const cprox_curve *curve, cprox_workspace *workspace) {
  if (radius->arcs || curve->arcs)
    return workspace_fail(workspace, CPROX_INVALID, "%s changes, but of %s only the arc length is known", whose,
                          radius->arcs ? "it" : "the curve");
  const double t0 = curve->breaks[0], t1 = curve->breaks[curve->n_pieces];
  const double u0 = radius->breaks[0], u1 = radius->breaks[radius->n_pieces];
  if (t0 != u0 || t1 != u1)
    return workspace_fail(workspace, CPROX_INVALID, "%s runs over [%.17g, %.17g], and the curve over [%.17g, %.17g]",
                          whose, u0, u1, t0, t1);
  if (!radius->in_reach) return workspace_fail(workspace, CPROX_INVALID, "%s is larger than %g m", whose, LENGTH_MOST);
  return check_sign(whose, radius, constant, workspace);
}

cprox_status radius_check(const cprox_mover *mover, const cprox_obstacle *obstacle, size_t index, arguments_query asked,
                          cprox_workspace *workspace) {
  if (!(asked.has & ARGUMENTS_RADIUS))
    return workspace_fail(workspace, CPROX_INVALID,
                          "a radius that changes does not apply to %s: ask for a distance, a verdict, a profile or a "
                          "time of contact",
                          asked.name);
  if (!obstacle) return check_radius("the mover's radius", mover->radius_curve, mover->radius, mover->curve, workspace);
  if (obstacle->curve && obstacle->curve->arcs)
    return workspace_fail(workspace, CPROX_INVALID,
                          "a radius that changes: of obstacle %zu only the arc length is known", index);
  if (!obstacle->radius_curve) return CPROX_OK;
  char whose[48];
  snprintf(whose, sizeof whose, "the radius of obstacle %zu", index);
  return check_radius(whose, obstacle->radius_curve, obstacle->margin, mover->curve, workspace);
}

double radius_at(const cprox_curve *radius, double t, bool from_left, cprox_workspace *workspace) {
  return radius ? relative_position(radius, &CPROX_POSE_IDENTITY, t, from_left, workspace).x : 0.0;
}
