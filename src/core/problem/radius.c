/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/radius.h"

#include <math.h>

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

cprox_status radius_check(const char *whose, const cprox_curve *radius, double constant, const cprox_curve *curve,
                          cprox_workspace *workspace) {
  if (!radius) return CPROX_OK;
  if (radius->arcs || curve->arcs)
    return workspace_fail(workspace, CPROX_INVALID, "%s changes, but of %s only the arc length is known", whose,
                          radius->arcs ? "it" : "the curve");
  double t0, t1, u0, u1;
  curve_domain(curve, &t0, &t1);
  curve_domain(radius, &u0, &u1);
  if (t0 != u0 || t1 != u1)
    return workspace_fail(workspace, CPROX_INVALID, "%s runs over [%.17g, %.17g], and the curve over [%.17g, %.17g]",
                          whose, u0, u1, t0, t1);
  if (!curve_is_in_reach(radius))
    return workspace_fail(workspace, CPROX_INVALID, "%s is larger than %g m", whose, LENGTH_MOST);
  return check_sign(whose, radius, constant, workspace);
}

double radius_most(const cprox_curve *radius) {
  if (!radius) return 0.0;
  const curve_capsule whole = curve_whole(radius), *all = &whole;
  return ROUND_UP * (fmax(fabs(all->a.x), fabs(all->b.x)) + all->radius);
}

double radius_at(const cprox_curve *radius, double t, bool from_left, cprox_workspace *workspace) {
  return radius ? relative_position(radius, &CPROX_POSE_IDENTITY, t, from_left, workspace).x : 0.0;
}
