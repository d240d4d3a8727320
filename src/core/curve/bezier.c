/* SPDX-License-Identifier: BSD-3-Clause */
/* A Bézier curve is one piece, exact as it is given. */
#include <string.h>

#include "base/workspace.h"
#include "curve/curve.h"

cprox_status curve_create_bezier(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  const cprox_vec3 *points = d->points;
  const size_t n_points = d->n;
  const double t0 = d->t0, t1 = d->t1;
  if (n_points > CPROX_MAX_DEGREE + 1)
    return workspace_fail(workspace, CPROX_INVALID, "a Bézier curve has at most %d control points (degree %d), got %zu",
                          CPROX_MAX_DEGREE + 1, CPROX_MAX_DEGREE, n_points);
  cprox_status status = curve_check_points(points, n_points, workspace);
  if (status == CPROX_OK) status = curve_check_range(t0, t1, workspace);
  if (status != CPROX_OK) return status;

  cprox_curve *c = curve_allocate(n_points - 1, 1);
  if (!c) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of %zu control points", n_points);
  memcpy(c->points, points, n_points * sizeof *points);
  c->breaks[0] = t0;
  c->breaks[1] = t1;
  return curve_finish(c, workspace, curve);
}
