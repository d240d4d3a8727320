/* SPDX-License-Identifier: BSD-3-Clause */
/* The ellipsoid of Theorem 1 (A. Lakshmanan et al. 2019), for callers: every point of a part of a curve is as far from
 * its two ends, summed, as the part is long. Queries use it for curves without control points only. */
#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "curve/rectifiable.h"

static cprox_status ellipsoid_by_length(const cprox_curve *curve, double a, double b, cprox_workspace *workspace,
                                        cprox_curve_ellipsoid *made) {
  vec3 ends[2];
  rectifiable_hull hull;
  cprox_status status = rectifiable_point(curve, a, workspace, &ends[0]);
  if (status == CPROX_OK) status = rectifiable_point(curve, b, workspace, &ends[1]);
  if (status == CPROX_OK)
    status = rectifiable_hull_of(curve, a, b, ends[0], ends[1], curve->arcs->error, workspace, &hull);
  if (status == CPROX_OK) *made = (cprox_curve_ellipsoid){{ends[0], ends[1]}, hull.axis, hull.radius};
  return status;
}

/* No curve is longer than its control polygon; the exact curve is within the piece's error of the one that the points
 * describe, and the points lose some roundings where they are those of a part. */
static cprox_status ellipsoid_by_polygon(const cprox_curve *curve, double a, double b, cprox_workspace *workspace,
                                         cprox_curve_ellipsoid *made) {
  vec3 points[CPROX_MAX_DEGREE + 1];
  const size_t degree = curve->degree;
  double length = 0.0, error = 0.0;
  for (size_t i = curve_piece_at(curve, a); i < curve->n_pieces && curve->breaks[i] < b; i++) {
    const double from = fmax(a, curve->breaks[i]), to = fmin(b, curve->breaks[i + 1]);
    const cprox_status status =
        WORKSPACE_LEND(workspace, cprox_curve_control_points(curve, from, to, workspace, points));
    if (status != CPROX_OK) return status;
    double largest = vec_norm(points[0]);
    for (size_t k = 0; k < degree; k++) {
      length += vec_norm(vec_sub(points[k + 1], points[k]));
      largest = fmax(largest, vec_norm(points[k + 1]));
    }
    error = fmax(error, curve->error[i] + (12.0 * (double)degree + 20.0) * ROUND_U * largest);
    if (from == a) made->foci[0] = points[0];
    made->foci[1] = points[degree];
  }
  const double pieces = (double)curve->n_pieces, terms = pieces * (double)(degree + 1);
  made->axis = length * (1.0 + 4.0 * ROUND_U * (terms + 4.0)) + (4.0 + 2.0 * pieces) * error;
  const double axis2 = made->axis * made->axis, chord2 = vec_norm2(vec_sub(made->foci[1], made->foci[0]));
  made->radius = 0.5 * sqrt(fmax(axis2 - chord2, 0.0) + 12.0 * ROUND_U * axis2);
  return CPROX_OK;
}

cprox_status cprox_curve_get_ellipsoid(const cprox_curve *curve, double a, double b, cprox_workspace *workspace,
                                       cprox_curve_ellipsoid *ellipsoid) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  if (!curve || !ellipsoid)
    return workspace_fail(workspace, CPROX_INVALID, "the %s is NULL", curve ? "ellipsoid" : "curve");
  double t0, t1;
  curve_domain(curve, &t0, &t1);
  if (!(a < b)) return workspace_fail(workspace, CPROX_INVALID, "a = %.17g is not below b = %.17g", a, b);
  if (!(t0 <= a && b <= t1))
    return workspace_fail(workspace, CPROX_INVALID, "[%.17g, %.17g] leaves the curve's range [%.17g, %.17g]", a, b, t0,
                          t1);
  cprox_curve_ellipsoid made;
  const cprox_status status = (curve->arcs ? ellipsoid_by_length : ellipsoid_by_polygon)(curve, a, b, workspace, &made);
  if (status == CPROX_OK) *ellipsoid = made;
  return status;
}
