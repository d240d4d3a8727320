/* SPDX-License-Identifier: BSD-3-Clause */
/* A clothoid (Euler spiral): a planar curve whose curvature is linear in arc length. heading.c bounds its point, which
 * is a Fresnel integral, and its derivatives. */
#include "base/workspace.h"
#include "curve/heading.h"

/* Beyond this many radians the heading's sizes leave the range that the bounds were made for. */
#define MOST_TURNING 1e12

static cprox_status check_clothoid(vec3 start, double heading, double curvature, double rate, double most,
                                   cprox_workspace *workspace) {
  const cprox_status status = curve_check_values("start point", &start, 1, 1, workspace);
  if (status != CPROX_OK) return status;
  if (!isfinite(heading) || !isfinite(curvature) || !isfinite(rate))
    return workspace_fail(workspace, CPROX_INVALID, "heading %g, curvature %g and its rate %g are not all finite",
                          heading, curvature, rate);
  const double turning = fabs(heading) + (fabs(curvature) + fabs(rate) * most) * most;
  if (!(turning <= MOST_TURNING))
    return workspace_fail(workspace, CPROX_INVALID, "the clothoid turns by up to %.3g rad, more than %g", turning,
                          MOST_TURNING);
  return CPROX_OK;
}

cprox_status curve_create_clothoid(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  const cprox_vec3 start = d->start;
  const double heading = d->heading, curvature = d->curvature, curvature_rate = d->curvature_rate;
  const double t0 = d->t0, t1 = d->t1;
  cprox_status status = curve_check_range(t0, t1, workspace);
  const double most = fmax(fabs(t0), fabs(t1));
  if (status == CPROX_OK) status = check_clothoid(start, heading, curvature, curvature_rate, most, workspace);
  if (status != CPROX_OK) return status;

  /* from the start, at t = 0, to where the range begins */
  heading_curve c = {.rate = curvature_rate, .heading = dd_from(heading), .curvature = dd_from(curvature)};
  if (!heading_advance(&c, t0))
    return workspace_fail(workspace, CPROX_INVALID, "the clothoid turns too often between t = 0 and %.15g", t0);
  compile_source source = heading_source(&c);
  source.constant = start;
  source.accuracy = HEADING_ACCURACY * (t1 - t0) + ROUND_U * vec_norm(start);
  status = compile_curve(&source, t0, t1, workspace, curve);
  if (status == CPROX_INVALID && !(c.steps <= HEADING_MOST_STEPS))
    return workspace_fail(workspace, status, "the clothoid turns too often between t = %.15g and %.15g", t0, t1);
  return status;
}
