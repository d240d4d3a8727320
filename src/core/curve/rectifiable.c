/* SPDX-License-Identifier: BSD-3-Clause */
/* Let A, B be the computed end points of an interval, each within e of the exact ones, and U at least its arc length.
 * Every exact point x of it is on a path from one exact end to the other no longer than U, so |x - A| + |x - B| <= W =
 * U + 2e: x lies in the ellipsoid with the foci A, B, whose support along a unit n is, with L = |B - A|, min n·x = (n·A
 * + n·B - sqrt(W² - L² + (n·(B - A))²))/2. Rounding is therefore that of the arithmetic alone, A and B being what they
 * are. W has two sums, so W² 4u and one u more; L² has 6u of itself (twice a difference, a square, two sums, each
 * coordinate); the difference u: together at most 12u W², for W >= L. r² = W² - L² + 12u W² is thus not too small, and
 * where it comes out below 0 the points contradict the arc length. It costs tightness: an interval never gets thinner
 * than 1.8e-8 of its length, far below what is left of it at that length. The support: n·(B - A) is within 4u L, sqrt
 * of the sum within 5u W, |n|² within 8u adds 2u W, the rest 5u of the foci's size.
 *
 * The ellipsoid lies in the capsule round AB of its half minor axis b = sqrt(W² - L²)/2: beside the segment |x - A| +
 * |x - B| is least for a given height at the middle, and beyond B, with y = |x - B|, W >= sqrt(L² + y²) + y gives y <=
 * (W² - L²)/(2W) <= b. */
#include "curve/rectifiable.h"

#include <stdlib.h>

#include "base/rounding.h"
#include "base/workspace.h"

/* Pieces from the start on: what obstacles are sorted by, and where a search begins. */
enum { PIECES = 64 };

cprox_status rectifiable_point(const cprox_curve *curve, double t, cprox_workspace *workspace, vec3 *point) {
  *point = vec(NAN, NAN, NAN);
  curve->arcs->point(curve->arcs->user, t, point);
  const bool small =
      fabs(point->x) <= CURVE_LARGEST && fabs(point->y) <= CURVE_LARGEST && fabs(point->z) <= CURVE_LARGEST;
  if (small) return CPROX_OK;
  return workspace_fail(workspace, CPROX_INVALID,
                        "at t = %.17g the curve's point is (%g, %g, %g), not finite or beyond %g", t, point->x,
                        point->y, point->z, CURVE_LARGEST);
}

/* sqrt(h times the integral of |psi'|²), which is no less than the arc length (Lemma 1), by the 15 points of Gauss and
 * Kronrod. Rounding: a square has 7u, the weights, products and sums 17u, the rest 4u; all terms are positive. */
static double length_by_velocity(const cprox_rectifiable_curve *c, double a, double b) {
  static const double node[8] = {
      0.99145537112081263921, 0.94910791234275852453, 0.86486442335976907279, 0.74153118559939443986,
      0.58608723546769113029, 0.40584515137739716691, 0.20778495500789846760, 0.0};
  static const double weight[8] = {0.02293532201052922496, 0.06309209262997855329, 0.10479001032225018384,
                                   0.14065325971552591875, 0.16900472663926790283, 0.19035057806478540991,
                                   0.20443294007529889241, 0.20948214108472782801};
  double sum = 0.0;
  for (int i = 0; i < 15; i++) {
    const int k = i < 8 ? i : 14 - i;
    const double s = 0.5 + (i < 8 ? -0.5 : 0.5) * node[k];
    vec3 velocity = vec(NAN, NAN, NAN);
    c->velocity(c->user, fmin((1.0 - s) * a + s * b, b), &velocity);
    const double speed = vec_norm(velocity) + c->velocity_error;
    sum += 0.5 * weight[k] * speed * speed;
  }
  const double h = b - a;
  return h * sqrt(sum * (1.0 + c->quadrature_error) * (1.0 + 32.0 * ROUND_U));
}

cprox_status rectifiable_length(const cprox_curve *curve, double a, double b, cprox_workspace *workspace,
                                double *length) {
  const cprox_rectifiable_curve *c = curve->arcs;
  *length = c->length ? c->length(c->user, a, b) : length_by_velocity(c, a, b);
  if (*length >= 0.0 && *length <= CURVE_LARGEST) return CPROX_OK;
  return workspace_fail(
      workspace, CPROX_INVALID,
      "between t = %.17g and %.17g the bound of the arc length is %g; it must be at least 0 and finite", a, b, *length);
}

cprox_status rectifiable_hull_of(const cprox_curve *curve, double ta, double tb, vec3 a, vec3 b, double error,
                                 cprox_workspace *workspace, rectifiable_hull *hull) {
  double length;
  const cprox_status status = rectifiable_length(curve, ta, tb, workspace, &length);
  if (status != CPROX_OK) return status;
  hull->axis = length + 2.0 * error + CURVE_LEAST;
  const double axis2 = hull->axis * hull->axis, chord2 = vec_norm2(vec_sub(b, a));
  const double minor2 = (axis2 - chord2) + 12.0 * ROUND_U * axis2;
  if (!(minor2 >= 0.0))
    return workspace_fail(workspace, CPROX_INVALID,
                          "between t = %.17g and %.17g the arc length is said to be at most %.17g m, but the ends are "
                          "%.17g m apart",
                          ta, tb, length, sqrt(chord2));
  hull->radius = 0.5 * sqrt(minor2);
  return CPROX_OK;
}

double rectifiable_reach(const rectifiable_hull *hull, vec3 a, vec3 b, vec3 n) {
  const double along = vec_dot(n, vec_sub(b, a)), minor = 2.0 * hull->radius;
  return 0.5 * (vec_dot(n, a) + vec_dot(n, b) - sqrt(minor * minor + along * along));
}

static cprox_status check_functions(const cprox_rectifiable_curve *c, cprox_workspace *workspace) {
  if (!c) return workspace_fail(workspace, CPROX_INVALID, "the curve's functions are NULL");
  if (!c->point) return workspace_fail(workspace, CPROX_INVALID, "the function point is NULL");
  if (!c->length && !c->velocity)
    return workspace_fail(workspace, CPROX_INVALID, "the functions length and velocity are both NULL; one is needed");
  const double errors[3] = {c->error, c->velocity_error, c->quadrature_error};
  static const char *const name[3] = {"error", "velocity_error", "quadrature_error"};
  for (int k = 0; k < (c->length ? 1 : 3); k++)
    if (!(errors[k] >= 0.0 && errors[k] <= CURVE_LARGEST))
      return workspace_fail(workspace, CPROX_INVALID, "%s is %g; it must be at least 0 and finite", name[k], errors[k]);
  return CPROX_OK;
}

/* Pieces of about the same range; fewer where there are not as many doubles. */
static size_t cut_range(double t0, double t1, double *breaks) {
  size_t n = 0;
  breaks[0] = t0;
  for (int i = 1; i < PIECES; i++) {
    const double s = (double)i / PIECES, cut = (1.0 - s) * t0 + s * t1;
    if (breaks[n] < cut && cut < t1) breaks[++n] = cut;
  }
  breaks[++n] = t1;
  return n;
}

/* Chords of the pieces; the curve is within a hull's radius of them. */
static cprox_status fill_pieces(cprox_curve *c, cprox_workspace *workspace) {
  vec3 at0, at1;
  cprox_status status = rectifiable_point(c, c->breaks[0], workspace, &at0);
  for (size_t i = 0; i < c->n_pieces && status == CPROX_OK; i++, at0 = at1) {
    const double from = c->breaks[i], to = c->breaks[i + 1];
    rectifiable_hull hull = {0};
    status = rectifiable_point(c, to, workspace, &at1);
    if (status == CPROX_OK) status = rectifiable_hull_of(c, from, to, at0, at1, c->arcs->error, workspace, &hull);
    if (status != CPROX_OK) return status;
    c->points[2 * i] = at0;
    c->points[2 * i + 1] = at1;
    c->error[i] = ROUND_UP * hull.radius + CURVE_LEAST;
  }
  return status;
}

cprox_status curve_create_rectifiable(const cprox_curve_description *d, cprox_workspace *workspace,
                                      cprox_curve **curve) {
  const cprox_rectifiable_curve *functions = d->rectifiable;
  const double t0 = d->t0, t1 = d->t1;
  cprox_status status = check_functions(functions, workspace);
  if (status == CPROX_OK) status = curve_check_range(t0, t1, workspace);
  if (status != CPROX_OK) return status;

  double breaks[PIECES + 1];
  const size_t n = cut_range(t0, t1, breaks);
  cprox_curve *c = curve_allocate(1, n);
  if (c) c->arcs = malloc(sizeof *c->arcs);
  if (!c || !c->arcs) {
    cprox_curve_free(c);
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for a curve of %zu pieces", n);
  }
  *c->arcs = *functions;
  for (size_t i = 0; i <= n; i++) c->breaks[i] = breaks[i];
  status = fill_pieces(c, workspace);
  if (status != CPROX_OK) {
    cprox_curve_free(c);
    return status;
  }
  return curve_finish(c, workspace, curve);
}
