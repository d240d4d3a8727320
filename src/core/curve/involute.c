/* SPDX-License-Identifier: BSD-3-Clause */
/* The involute of a circle, psi(t) = centre + r R(angle) (cos t + t sin t, sin t - t cos t); as a complex number r (1 -
 * it) e^ia, a = angle + t. psi' = r t e^ia, and k derivatives later psi^(k+1) = r (i^k t + k i^(k-1)) e^ia, so
 * |psi^(6)| = r sqrt(t² + 25).
 *
 * Rounding: cosine and sine of the double-double angle are within 6u; products and sums add u (1 + |t|), the factor r
 * one more: per coordinate at most u r (8 + 8|t|), and u r |t| 8 for the first derivative; the norm of two such is
 * sqrt(2) times that. */
#include "base/workspace.h"
#include "curve/angle.h"
#include "curve/compile.h"

typedef struct involute {
  double radius, turned;
} involute;

static void evaluate(void *self, double t, compile_jet *jet) {
  const involute *c = self;
  const angle at = angle_of(dd_sum(c->turned, t));
  const double r = c->radius, e = 12.0 * ROUND_U * r, size = fabs(t);
  jet->d[0] = vec(r * (at.cosine + t * at.sine), r * (at.sine - t * at.cosine), 0.0);
  jet->d[1] = vec(r * (t * at.cosine), r * (t * at.sine), 0.0);
  jet->d[2] = vec(r * (at.cosine - t * at.sine), r * (at.sine + t * at.cosine), 0.0);
  jet->error[0] = e * (1.0 + size);
  jet->error[1] = e * size;
  jet->error[2] = e * (1.0 + size);
}

static double sixth_derivative(void *self, double a, double b) {
  const involute *c = self;
  const double t = fmax(fabs(a), fabs(b));
  return ROUND_UP * c->radius * sqrt(t * t + 25.0);
}

cprox_status curve_create_involute(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  const cprox_vec3 centre = d->start;
  const double radius = d->radius, turned = d->heading;
  const double t0 = d->t0, t1 = d->t1;
  cprox_status status = curve_check_values("centre", &centre, 1, 1, workspace);
  if (status == CPROX_OK) status = curve_check_range(t0, t1, workspace);
  if (status != CPROX_OK) return status;
  if (!(radius > 0.0 && radius <= sqrt(CURVE_LARGEST)))
    return workspace_fail(workspace, CPROX_INVALID, "the radius is %g; an involute's is above 0 and at most %g m",
                          radius, sqrt(CURVE_LARGEST));
  if (!isfinite(turned)) return workspace_fail(workspace, CPROX_INVALID, "the angle is %g, not finite", turned);

  involute c = {.radius = radius, .turned = turned};
  const double size = radius * (1.0 + fmax(fabs(t0), fabs(t1)));
  const compile_source source = {.self = &c,
                                 .evaluate = evaluate,
                                 .sixth = sixth_derivative,
                                 .constant = centre,
                                 .accuracy = COMPILE_ACCURACY * size + ROUND_U * vec_norm(centre)};
  return compile_curve(&source, t0, t1, workspace, curve);
}
