/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves end to end, as one curve of the highest of their degrees.
 *
 * Error: a Bézier curve is raised by convex combinations (i P_(i-1) + (k-i) P_i)/k in double-double arithmetic, which
 * adds (2 scale + add + divide) u² max|P| a degree; rounding the points costs u max|P|. Where a curve gets another
 * range its inner joints move with it: the new ends of a piece, each of them off by delta, move a point of the piece
 * along it by at most 2 delta/(its new length) degree max|P_(i+1) - P_i|. */
#include <string.h>

#include "base/workspace.h"
#include "curve/convert.h"

/* The ends of a curve's range, old and new. */
typedef struct piecewise_range {
  double t0, t1, to0, to1;
} piecewise_range;

static piecewise_range range_of(const cprox_curve *c, const double *ends) {
  const double t0 = c->breaks[0], t1 = c->breaks[c->n_pieces];
  return (piecewise_range){t0, t1, ends ? ends[0] : t0, ends ? ends[1] : t1};
}

static bool stays(const piecewise_range *r) {
  return r->t0 == r->to0 && r->t1 == r->to1;
}

/* Where an inner joint goes; *error is how far that may be from the exact place: three roundings of a weight, and those
 * of two products and a sum. */
static double place(const piecewise_range *r, double t, double *error) {
  *error = 0.0;
  if (stays(r)) return t;
  if (t == r->t0) return r->to0;
  if (t == r->t1) return r->to1;
  const double length = r->t1 - r->t0;
  *error = 6.0 * ROUND_U * (fabs(r->to0) + fabs(r->to1));
  return (r->t1 - t) / length * r->to0 + (t - r->t0) / length * r->to1;
}

/* max|P| and max|P_(i+1) - P_i| */
static double largest_norm(const vec3 *p, size_t n, double *leg) {
  double largest = 0.0;
  *leg = 0.0;
  for (size_t i = 0; i < n; i++) {
    largest = fmax(largest, vec_norm2(p[i]));
    if (i > 0) *leg = fmax(*leg, vec_norm(vec_sub(p[i], p[i - 1])));
  }
  return sqrt(largest);
}

/* A piece of one degree as one of another, at least as high; returns the error that adds. */
static double raise(const vec3 *p, size_t from, size_t to, double largest, vec3 *raised) {
  if (from == to) {
    memcpy(raised, p, (to + 1) * sizeof *p);
    return 0.0;
  }
  convert_point b[CPROX_MAX_DEGREE + 1];
  for (size_t i = 0; i <= from; i++)
    for (int c = 0; c < 3; c++) b[i].k[c] = dd_from(convert_coordinate(p[i], c));
  for (size_t k = from + 1; k <= to; k++) {
    const dd degree = dd_from((double)k);
    b[k] = b[k - 1];
    for (size_t i = k; i-- > 1;)
      for (int c = 0; c < 3; c++)
        b[i].k[c] = dd_divide(dd_add(dd_scale(b[i - 1].k[c], (double)i), dd_scale(b[i].k[c], (double)(k - i))), degree);
  }
  for (size_t i = 0; i <= to; i++) raised[i] = vec(b[i].k[0].high, b[i].k[1].high, b[i].k[2].high);
  const double steps = (double)(to - from) * (2.0 * DD_SCALE + DD_ADD + DD_DIVIDE);
  return ROUND_UP * (ROUND_U + 1.7320508075688774 * steps * DD_UNIT) * largest + CURVE_LEAST;
}

static cprox_status check_curves(const cprox_curve *const *curves, size_t n, const double *ends, double gap,
                                 cprox_workspace *workspace) {
  if (n < 1) return workspace_fail(workspace, CPROX_INVALID, "there is no curve to put end to end");
  if (!curves) return workspace_fail(workspace, CPROX_INVALID, "the curves are NULL");
  if (!(gap >= 0.0))
    return workspace_fail(workspace, CPROX_INVALID, "the largest gap is %g; it must be at least 0", gap);
  for (size_t i = 0; i < n; i++) {
    if (!curves[i]) return workspace_fail(workspace, CPROX_INVALID, "curve %zu is NULL", i);
    if (curves[i]->arcs)
      return workspace_fail(workspace, CPROX_INVALID, "curve %zu is known by its arc length; it has no pieces to join",
                            i);
  }
  for (size_t i = 0; i < n && ends; i++) {
    if (!(fabs(ends[i]) <= CURVE_LARGEST && fabs(ends[i + 1]) <= CURVE_LARGEST))
      return workspace_fail(workspace, CPROX_INVALID, "the range [%g, %g] of curve %zu is not finite or beyond %g",
                            ends[i], ends[i + 1], i, CURVE_LARGEST);
    if (!(ends[i] < ends[i + 1]))
      return workspace_fail(workspace, CPROX_INVALID, "the range of curve %zu is empty: it ends at %.15g, after %.15g",
                            i, ends[i + 1], ends[i]);
  }
  return CPROX_OK;
}

/* Whether curve i may follow the one before it. */
static cprox_status check_joint(const cprox_curve *const *curves, size_t i, bool own_ranges, double gap,
                                cprox_workspace *workspace) {
  const cprox_curve *before = curves[i - 1], *after = curves[i];
  const size_t last = before->n_pieces - 1;
  const double end = before->breaks[before->n_pieces], begin = after->breaks[0];
  if (own_ranges && end != begin)
    return workspace_fail(workspace, CPROX_INVALID, "curve %zu ends at t = %.15g, curve %zu begins at t = %.15g", i - 1,
                          end, i, begin);
  const vec3 a = curve_piece(before, last)[before->degree], b = curve_piece(after, 0)[0];
  const double apart = vec_norm(vec_sub(a, b));
  if (apart - before->error[last] - after->error[0] > gap)
    return workspace_fail(workspace, CPROX_INVALID, "curves %zu and %zu do not join: they are %.3g m apart, above %g",
                          i - 1, i, apart, gap);
  return CPROX_OK;
}

/* The pieces of one curve, from piece `first` of the whole on. */
static cprox_status append(cprox_curve *whole, size_t first, const cprox_curve *c, const piecewise_range *range,
                           size_t index, cprox_workspace *workspace) {
  for (size_t i = 0; i < c->n_pieces; i++) {
    const vec3 *p = curve_piece(c, i);
    vec3 *raised = whole->points + (first + i) * (whole->degree + 1);
    double leg, error[2];
    const double largest = largest_norm(p, c->degree + 1, &leg);
    const double from = place(range, c->breaks[i], &error[0]), to = place(range, c->breaks[i + 1], &error[1]);
    if (!(from < to))
      return workspace_fail(workspace, CPROX_INVALID, "curve %zu has too many pieces for its range [%.15g, %.15g]",
                            index, range->to0, range->to1);
    const double moved = (error[0] + error[1]) / (to - from) * (double)c->degree * leg;
    whole->breaks[first + i] = from;
    whole->breaks[first + i + 1] = to;
    whole->error[first + i] = c->error[i] + raise(p, c->degree, whole->degree, largest, raised) + ROUND_UP * moved;
  }
  return CPROX_OK;
}

cprox_status curve_create_piecewise(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  const cprox_curve *const *curves = d->curves;
  const double *ends = d->knots;
  const size_t n_curves = d->n;
  const double gap = d->gap;
  if (ends && d->n_knots != n_curves + 1)
    return workspace_fail(workspace, CPROX_INVALID, "%zu curves need n + 1 = %zu ends of their ranges, got %zu",
                          n_curves, n_curves + 1, d->n_knots);
  cprox_status status = check_curves(curves, n_curves, ends, gap, workspace);
  for (size_t i = 1; i < n_curves && status == CPROX_OK; i++) status = check_joint(curves, i, !ends, gap, workspace);
  if (status != CPROX_OK) return status;

  size_t degree = 0, n = 0;
  for (size_t i = 0; i < n_curves; i++) {
    degree = curves[i]->degree > degree ? curves[i]->degree : degree;
    n += curves[i]->n_pieces;
  }
  cprox_curve *whole = curve_allocate(degree, n);
  if (!whole) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of %zu pieces", n);
  size_t first = 0;
  for (size_t i = 0; i < n_curves && status == CPROX_OK; i++) {
    const piecewise_range range = range_of(curves[i], ends ? ends + i : NULL);
    status = append(whole, first, curves[i], &range, i, workspace);
    first += curves[i]->n_pieces;
  }
  if (status != CPROX_OK) {
    cprox_curve_free(whole);
    return status;
  }
  return curve_finish(whole, workspace, curve);
}
