/* SPDX-License-Identifier: BSD-3-Clause */
/* A part of a curve, at a pose. Pieces that lie in the part are copied; the first and the last are cut by their
 * blossoms. A pose turns the control points, which costs 26 u of their length, and moves them, u of the result. */
#include <string.h>

#include "base/frame.h"
#include "base/workspace.h"
#include "curve/curve.h"

static cprox_status check_part(const cprox_curve_description *d, cprox_workspace *workspace) {
  if (d->n != 1 || !d->curves || !d->curves[0])
    return workspace_fail(workspace, CPROX_INVALID, "a part is made of one curve, got %zu", d->curves ? d->n : 0);
  const cprox_status status = curve_check_range(d->t0, d->t1, workspace);
  if (status != CPROX_OK) return status;
  double from, to;
  curve_domain(d->curves[0], &from, &to);
  if (!(from <= d->t0 && d->t1 <= to))
    return workspace_fail(workspace, CPROX_INVALID, "[%.17g, %.17g] leaves the curve's range [%.17g, %.17g]", d->t0,
                          d->t1, from, to);
  const char *reason = d->pose ? frame_pose_error(d->pose) : NULL;
  if (reason) return workspace_fail(workspace, CPROX_INVALID, "the pose of the curve: %s", reason);
  if (d->pose && d->curves[0]->arcs)
    return workspace_fail(workspace, CPROX_INVALID, "a curve known by its arc length cannot have a pose");
  return CPROX_OK;
}

/* One piece, or the part of it that lies in [t0, t1]; returns the error of that. */
static double cut_piece(const cprox_curve *whole, size_t i, double lo, double hi, vec3 *points) {
  const size_t degree = whole->degree;
  const double left = whole->breaks[i], right = whole->breaks[i + 1];
  if (lo == left && hi == right) {
    memcpy(points, curve_piece(whole, i), (degree + 1) * sizeof *points);
    return whole->error[i];
  }
  double knots[2 * CPROX_MAX_DEGREE];
  for (size_t k = 0; k < degree; k++) {
    knots[k] = left;
    knots[degree + k] = right;
  }
  return ROUND_UP * (whole->error[i] + curve_convert_span(curve_piece(whole, i), knots, degree, lo, hi, points));
}

static double place_points(const frame *f, vec3 *points, size_t n) {
  double error = 0.0;
  for (size_t i = 0; i < n; i++) {
    const double size = vec_norm(points[i]);
    points[i] = frame_to_world(f, points[i]);
    error = fmax(error, (f->rotated ? ROUND_ROTATION * size : 0.0) + vec_norm(points[i]));
  }
  return ROUND_UP * ROUND_U * error + CURVE_LEAST;
}

cprox_status curve_create_part(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  const cprox_status status = check_part(d, workspace);
  if (status != CPROX_OK) return status;
  const cprox_curve *whole = d->curves[0];
  if (whole->arcs) {
    const cprox_curve_description part = {.rectifiable = whole->arcs, .t0 = d->t0, .t1 = d->t1};
    return curve_create_rectifiable(&part, workspace, curve);
  }

  /* pieces first … last - 1 have a length in [t0, t1] */
  const size_t first = curve_piece_at(whole, d->t0);
  size_t last = first + 1;
  while (last < whole->n_pieces && whole->breaks[last] < d->t1) last++;
  const size_t n = last - first, points = whole->degree + 1;
  cprox_curve *part = curve_allocate(whole->degree, n);
  if (!part) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of %zu pieces", n);
  const frame f = d->pose ? frame_create(d->pose, vec(0, 0, 0)) : (frame){.rotated = false};
  for (size_t i = 0; i < n; i++) {
    part->breaks[i] = fmax(whole->breaks[first + i], d->t0);
    part->breaks[i + 1] = fmin(whole->breaks[first + i + 1], d->t1);
    vec3 *own = part->points + i * points;
    part->error[i] = cut_piece(whole, first + i, part->breaks[i], part->breaks[i + 1], own);
    if (d->pose) part->error[i] = ROUND_UP * (part->error[i] + place_points(&f, own, points));
  }
  return curve_finish(part, workspace, curve);
}
