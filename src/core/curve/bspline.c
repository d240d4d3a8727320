/* SPDX-License-Identifier: BSD-3-Clause */
/* A B-spline is cut into its polynomial spans. Span r, [knots[r], knots[r+1]], depends on the control points r-p … r
 * and on the knots r-p+1 … r+p; its blossom at the two ends of the span gives the Bézier points.
 *
 * Error of a span, M = max|control point| and p the degree: 5 p u M by curve_blossom(). Far from the origin most of
 * that is needless: with the points taken about one of them, o, and L = max|point - o|, the differences are off by u L,
 * the blossom by 5 p u L, and adding o again by u times the result. The smaller of the two is taken, so the error never
 * exceeds 5 p u M. The control points of a piece being within the error of the exact ones, so is every point of it. */
#include "base/rounding.h"
#include "base/workspace.h"
#include "curve/curve.h"

static cprox_status check_knots(const double *knots, size_t n_points, size_t degree, size_t n_knots,
                                cprox_workspace *workspace) {
  if (degree < 1) return workspace_fail(workspace, CPROX_INVALID, "the degree is 0; a curve needs at least 1");
  if (degree > CPROX_MAX_DEGREE)
    return workspace_fail(workspace, CPROX_INVALID, "the degree is %zu, above %d", degree, CPROX_MAX_DEGREE);
  if (n_points < degree + 1)
    return workspace_fail(workspace, CPROX_INVALID,
                          "a B-spline of degree %zu needs at least %zu control points, got %zu", degree, degree + 1,
                          n_points);
  if (n_knots != n_points + degree + 1)
    return workspace_fail(workspace, CPROX_INVALID, "%zu control points of degree %zu need %zu knots, got %zu",
                          n_points, degree, n_points + degree + 1, n_knots);
  if (!knots) return workspace_fail(workspace, CPROX_INVALID, "the knots are NULL");
  for (size_t i = 0; i < n_knots; i++) {
    if (!(fabs(knots[i]) <= CURVE_LARGEST))
      return workspace_fail(workspace, CPROX_INVALID, "knot %zu is %g, not finite or beyond %g", i, knots[i],
                            CURVE_LARGEST);
    if (i > 0 && knots[i] < knots[i - 1])
      return workspace_fail(workspace, CPROX_INVALID, "knot %zu is %.15g, below knot %zu at %.15g", i, knots[i], i - 1,
                            knots[i - 1]);
  }
  if (!(knots[degree] < knots[n_points]))
    return workspace_fail(workspace, CPROX_INVALID, "the spline's domain is empty: knots %zu to %zu are all %.15g",
                          degree, n_points, knots[degree]);
  return CPROX_OK;
}

/* The part of span r that lies inside [t0, t1]; false where that has no length. */
static bool cut_span(const double *knots, size_t r, double t0, double t1, double *lo, double *hi) {
  *lo = knots[r] > t0 ? knots[r] : t0;
  *hi = knots[r + 1] < t1 ? knots[r + 1] : t1;
  return *lo < *hi;
}

/* At least max|point|, up to its rounding. */
static double largest_norm(const vec3 *points, size_t n) {
  double largest = 0.0;
  for (size_t i = 0; i < n; i++) largest = fmax(largest, vec_norm2(points[i]));
  return sqrt(largest) + CURVE_LEAST;
}

double curve_convert_span(const vec3 *control, const double *knots, size_t degree, double lo, double hi, vec3 *bezier) {
  const double p = (double)degree;

  /* about a control point where the span is small against its distance from the origin */
  vec3 local[CPROX_MAX_DEGREE + 1];
  const vec3 origin = control[degree / 2];
  for (size_t i = 0; i <= degree; i++) local[i] = vec_sub(control[i], origin);
  const double size = largest_norm(local, degree + 1), reach = largest_norm(control, degree + 1);
  if (2.0 * size >= reach) {
    curve_blossom(control, knots, degree, lo, hi, bezier);
    return ROUND_UP * ROUND_U * 5.0 * p * reach;
  }

  curve_blossom(local, knots, degree, lo, hi, bezier);
  for (size_t i = 0; i <= degree; i++) bezier[i] = vec_add(bezier[i], origin);
  return ROUND_UP * ROUND_U * ((5.0 * p + 1.0) * size + largest_norm(bezier, degree + 1));
}

cprox_status curve_check_spline(const cprox_curve_description *d, cprox_workspace *workspace) {
  cprox_status status = curve_check_points(d->points, d->n, workspace);
  if (status == CPROX_OK) status = check_knots(d->knots, d->n, d->degree, d->n_knots, workspace);
  if (status == CPROX_OK) status = curve_check_range(d->t0, d->t1, workspace);
  if (status != CPROX_OK) return status;
  const double from = d->knots[d->degree], to = d->knots[d->n];
  if (d->t0 < from || d->t1 > to)
    return workspace_fail(workspace, CPROX_INVALID,
                          "[t0, t1] = [%.15g, %.15g] leaves the spline's domain [%.15g, %.15g]", d->t0, d->t1, from,
                          to);
  return CPROX_OK;
}

cprox_status curve_create_bspline(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  const cprox_status status = curve_check_spline(d, workspace);
  if (status != CPROX_OK) return status;
  const cprox_vec3 *points = d->points;
  const double *knots = d->knots;
  const size_t n_points = d->n, degree = d->degree;
  const double t0 = d->t0, t1 = d->t1;

  /* spans that have a length */
  double lo, hi;
  size_t n_pieces = 0;
  for (size_t r = degree; r < n_points; r++) n_pieces += cut_span(knots, r, t0, t1, &lo, &hi);

  cprox_curve *c = curve_allocate(degree, n_pieces);
  if (!c) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of %zu pieces", n_pieces);
  size_t i = 0;
  for (size_t r = degree; r < n_points; r++) {
    if (!cut_span(knots, r, t0, t1, &lo, &hi)) continue;
    c->error[i] = curve_convert_span(points + (r - degree), knots + (r - degree + 1), degree, lo, hi,
                                     c->points + i * (degree + 1));
    c->breaks[i++] = lo;
    c->breaks[i] = hi;
    if (curve_stops(i, workspace)) return curve_stopped(c, workspace);
  }
  return curve_finish(c, workspace, curve);
}
