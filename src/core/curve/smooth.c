/* SPDX-License-Identifier: BSD-3-Clause */
/* A curve by a caller's functions: value, two derivatives, and a bound of the sixth. What they say is checked where the
 * compilation asks: that numbers are finite, and that the middle of every piece, where the remainder is largest, is as
 * near to its quintic as the bounds allow. */
#include "base/workspace.h"
#include "curve/compile.h"

typedef struct smooth {
  const cprox_smooth_curve *given;
  /* the first bound that is none */
  bool unusable;
  double from, to, sixth;
} smooth;

static void evaluate(void *self, double t, compile_jet *jet) {
  const smooth *s = self;
  for (int k = 0; k < 3; k++) {
    jet->d[k] = vec(NAN, NAN, NAN);
    jet->error[k] = s->given->error[k];
  }
  s->given->evaluate(s->given->user, t, jet->d);
}

static double sixth_derivative(void *self, double a, double b) {
  smooth *s = self;
  const double sixth = s->given->sixth(s->given->user, a, b);
  if (!(sixth >= 0.0) && !s->unusable) {
    s->unusable = true;
    s->from = a, s->to = b, s->sixth = sixth;
  }
  return sixth >= 0.0 ? sixth : INFINITY;
}

static cprox_status check_smooth(const cprox_smooth_curve *given, cprox_workspace *workspace) {
  if (!given) return workspace_fail(workspace, CPROX_INVALID, "the curve's functions are NULL");
  if (!given->evaluate || !given->sixth)
    return workspace_fail(workspace, CPROX_INVALID, "the function %s is NULL", given->evaluate ? "sixth" : "evaluate");
  for (int k = 0; k < 3; k++)
    if (!(given->error[k] >= 0.0 && given->error[k] <= CURVE_LARGEST))
      return workspace_fail(workspace, CPROX_INVALID, "error[%d] is %g; it must be at least 0 and finite", k,
                            given->error[k]);
  if (!(given->accuracy > 0.0 && given->accuracy <= CURVE_LARGEST))
    return workspace_fail(workspace, CPROX_INVALID, "the accuracy is %g; it must be above 0 and finite",
                          given->accuracy);
  return CPROX_OK;
}

cprox_status curve_create_smooth(const cprox_curve_description *d, cprox_workspace *workspace, cprox_curve **curve) {
  const cprox_smooth_curve *functions = d->smooth;
  const double t0 = d->t0, t1 = d->t1;
  cprox_status status = check_smooth(functions, workspace);
  if (status == CPROX_OK) status = curve_check_range(t0, t1, workspace);
  if (status != CPROX_OK) return status;

  smooth s = {.given = functions};
  const compile_source source = {
      .self = &s, .evaluate = evaluate, .sixth = sixth_derivative, .accuracy = functions->accuracy, .doubted = true};
  status = compile_curve(&source, t0, t1, workspace, curve);
  if (status < 0 && s.unusable)
    return workspace_fail(workspace, CPROX_INVALID, "on [%.15g, %.15g] the bound of the sixth derivative is %g", s.from,
                          s.to, s.sixth);
  return status;
}
