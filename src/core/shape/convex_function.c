/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/convex_function.h"

#include <stdlib.h>

#include "base/workspace.h"
#include "shape/construct.h"

/* All lengths below are fractions of the radius, about the interior point: the
 * body lies in the unit ball. */

/* f at a place, its gradient and its Hessian (xx, xy, xz, yy, yz, zz) there. */
typedef struct jet {
  vec3 at;
  double value;
  vec3 gradient;
  double hessian[6];
} jet;

/* Gaps that a search goes on for, and that a body may have. */
static const double GOAL = 1e-13, MOST_GAP = 1e-6;

static bool measure(const convex_function *f, vec3 at, jet *out) {
  const cprox_convex_function *given = &f->given;
  const vec3 x = vec_axpy(given->interior, given->radius, at);
  const double point[3] = {x.x, x.y, x.z}, r = given->radius;
  double gradient[3] = {NAN, NAN, NAN}, hessian[6] = {NAN, NAN, NAN, NAN, NAN, NAN};
  *out = (jet){.at = at, .value = given->evaluate(given->user, point, gradient, hessian)};
  if (given->planar) gradient[2] = hessian[2] = hessian[4] = hessian[5] = 0.0;
  out->gradient = vec(r * gradient[0], r * gradient[1], r * gradient[2]);
  bool finite = isfinite(out->value) && vec_finite(out->gradient);
  for (int i = 0; i < 6; i++) {
    out->hessian[i] = r * r * hessian[i];
    finite = finite && isfinite(out->hessian[i]);
  }
  return finite;
}

/* ---- the support function ---- */

/* The point of the ray through `toward` where f rises to -error: inside for
 * certain, and as far out as rounding lets it. Newton's steps from outside stay
 * outside, since f is convex; the bracket holds where f is not what it says. */
static bool reach_surface(const convex_function *f, vec3 toward, jet *out) {
  enum { STEPS = 100 };
  const double length = vec_norm(toward);
  if (!(length > 0.0)) return false;
  const vec3 ray = vec_scale(1.0 / length, toward);
  double inside = 0.0, outside = 1.0, s = lesser(length, 1.0), nearer = 4.0 * ROUND_U;
  jet last = {.value = NAN};
  for (int i = 0; i < STEPS; i++) {
    jet here;
    if (!measure(f, vec_scale(s, ray), &here)) return false;
    const double height = here.value + f->given.error, slope = vec_dot(here.gradient, ray);
    if (height > 0.0)
      outside = lesser(outside, s);
    else
      inside = s, last = here;
    if (outside - inside <= 8.0 * ROUND_U) break;
    const double next = slope > 0.0 ? s - height / slope : NAN;
    if (fabs(next - s) <= 4.0 * ROUND_U && height <= 0.0) break;
    if (fabs(next - s) <= 4.0 * ROUND_U) {
      s = greater(inside, s - nearer); /* the root is found: step inside */
      nearer *= 4.0;
    } else {
      s = next > inside && next < outside ? next : 0.5 * (inside + outside);
    }
  }
  *out = last;
  return !isnan(last.value);
}

/* Solves (multiplier H + damping) x = b by Cholesky's factors; false where the
 * matrix is not positive definite. */
static bool solve_damped(const double h[6], double multiplier, double damping, vec3 b, vec3 *x) {
  const double a = multiplier * h[0] + damping, d = multiplier * h[3] + damping, e = multiplier * h[5] + damping;
  if (!(a > 0.0)) return false;
  const double l0 = sqrt(a), l1 = multiplier * h[1] / l0, l2 = multiplier * h[2] / l0, m = d - l1 * l1;
  if (!(m > 0.0)) return false;
  const double l3 = sqrt(m), l4 = (multiplier * h[4] - l1 * l2) / l3, n = e - l2 * l2 - l4 * l4;
  if (!(n > 0.0)) return false;
  const double l5 = sqrt(n), y0 = b.x / l0, y1 = (b.y - l1 * y0) / l3, y2 = (b.z - l2 * y0 - l4 * y1) / l5;
  x->z = y2 / l5;
  x->y = (y1 - l4 * x->z) / l3;
  x->x = (y0 - l1 * x->y - l2 * x->z) / l0;
  return vec_finite(*x);
}

/* Newton's step along the surface towards larger u·x, from the conditions u =
 * multiplier ∇f, f = 0. */
static bool tangent_step(const jet *at, double multiplier, double damping, vec3 rest, vec3 *step) {
  vec3 by_rest, by_gradient;
  if (!solve_damped(at->hessian, multiplier, damping, rest, &by_rest) ||
      !solve_damped(at->hessian, multiplier, damping, at->gradient, &by_gradient))
    return false;
  const double w = vec_dot(at->gradient, by_rest) / vec_dot(at->gradient, by_gradient);
  *step = vec_axpy(by_rest, -w, by_gradient);
  return vec_finite(*step);
}

/* A place of the surface as a support point: u = multiplier ∇f + rest there,
 * and the rest is 0 at the best one. */
typedef struct candidate {
  jet at;
  double along; /* u·x */
  double multiplier;
  vec3 rest;
} candidate;

static candidate candidate_at(const jet *at, vec3 u) {
  const double steepness = vec_norm2(at->gradient);
  const double multiplier = steepness > 0.0 ? greater(vec_dot(u, at->gradient) / steepness, 0.0) : 0.0;
  return (candidate){
      .at = *at, .along = vec_dot(u, at->at), .multiplier = multiplier, .rest = vec_axpy(u, -multiplier, at->gradient)};
}

/* Farther along u, or as far and with half the rest: near the end u·x no longer
 * tells places apart, the rest does. */
static bool is_better(const candidate *next, const candidate *last) {
  const double gain = next->along - last->along, noise = 64.0 * ROUND_U;
  return gain > noise || (gain > -noise && vec_norm2(next->rest) < 0.25 * vec_norm2(last->rest));
}

/* Goes on to a better place. The damping falls where steps succeed. */
static bool climb(const convex_function *f, vec3 u, candidate *best, double *damping) {
  enum { TRIALS = 30 };
  const double curvature = best->multiplier > 0.0 ? best->multiplier : 1.0 / vec_norm(best->at.gradient);
  for (int i = 0; i < TRIALS; i++, *damping *= 8.0) {
    vec3 step;
    jet at;
    if (!tangent_step(&best->at, curvature, *damping, best->rest, &step)) continue;
    if (!reach_surface(f, vec_add(best->at.at, step), &at)) return false;
    const candidate next = candidate_at(&at, u);
    if (!is_better(&next, best)) continue;
    *best = next;
    *damping *= 1.0 / 64.0;
    return true;
  }
  return false;
}

/* A point of the body that is farthest along the unit vector u but for the gap,
 * which is proven: where f is g·(x - p) + f(p) at least, u = l g + r gives u·x
 * <= l (g·p - f(p)) + |r| in the unit ball. The gap is NaN where f answers with
 * no number, negative where it is not convex. */
static vec3 support_point(const convex_function *f, vec3 u, double *gap) {
  enum { STEPS = 200 };
  jet start;
  *gap = NAN;
  if (!reach_surface(f, u, &start)) return vec(0, 0, 0);
  candidate best = candidate_at(&start, u);
  double damping = 1e-6;
  for (int i = 0; i < STEPS; i++) {
    const jet *at = &best.at;
    const double tangent = vec_dot(at->gradient, at->at) - at->value + f->given.error;
    *gap = best.multiplier * tangent + vec_norm(best.rest) - best.along;
    if (!(*gap > GOAL) || !climb(f, u, &best, &damping)) break;
  }
  return best.at.at;
}

/* In the plane only the direction's part in it counts. */
static bool direction_of(const convex_function *f, vec3 d, vec3 *u) {
  if (f->given.planar) d.z = 0.0;
  const double length = vec_norm(d);
  if (!(length > 0.0)) return false;
  *u = vec_scale(1.0 / length, d);
  return true;
}

/* In the shape of cprox_support_fn. */
static void function_support(const void *shape, const double direction[3], double point[3]) {
  const convex_function *f = shape;
  vec3 u, at = vec(0, 0, 0);
  double gap = 0.0;
  if (direction_of(f, vec(direction[0], direction[1], direction[2]), &u)) at = support_point(f, u, &gap);
  const bool good = gap <= f->gap && gap >= -f->gap;
  const vec3 x = vec_axpy(f->given.interior, f->given.radius, at);
  point[0] = good ? x.x : NAN, point[1] = good ? x.y : NAN, point[2] = good ? x.z : NAN;
}

/* ---- what the constructor checks ---- */

/* The i-th of n unit vectors that are spread evenly: on a circle in the plane,
 * else on a spiral. */
static vec3 spread(const convex_function *f, size_t i, size_t n) {
  const double turn = 2.399963229728653 * (double)i, pi = 3.141592653589793;
  if (f->given.planar) return vec(cos(2.0 * pi * (double)i / (double)n), sin(2.0 * pi * (double)i / (double)n), 0.0);
  const double z = (2.0 * (double)i + 1.0) / (double)n - 1.0, across = sqrt(1.0 - z * z);
  return vec(across * cos(turn), across * sin(turn), z);
}

static vec3 place(const convex_function *f, vec3 at) {
  return vec_axpy(f->given.interior, f->given.radius, at);
}

static cprox_status no_number(const convex_function *f, vec3 at, cprox_workspace *workspace) {
  const vec3 x = place(f, at);
  return workspace_fail(workspace, CPROX_INVALID,
                        "the convex function, its gradient or its Hessian is "
                        "not finite at (%g, %g, %g)",
                        x.x, x.y, x.z);
}

/* A convex function lies above each of its tangents. */
static cprox_status check_tangent(const convex_function *f, const jet *a, const jet *b, cprox_workspace *workspace) {
  const double rise = vec_dot(a->gradient, vec_sub(b->at, a->at)), least = a->value + rise;
  const double slack = 2.0 * f->given.error + 1e-9 * (fabs(a->value) + fabs(b->value) + fabs(rise));
  if (b->value >= least - slack) return CPROX_OK;
  const vec3 p = place(f, a->at), q = place(f, b->at);
  return workspace_fail(workspace, CPROX_INVALID,
                        "the function is not convex, or its gradient is wrong: "
                        "value and gradient at (%g, %g, %g) ask "
                        "for at least %.9g at (%g, %g, %g), where it is %.9g",
                        p.x, p.y, p.z, least, q.x, q.y, q.z, b->value);
}

/* Values at places in the ball: numbers, above 0 where the ball ends, above
 * each other's tangents. */
static cprox_status check_samples(const convex_function *f, cprox_workspace *workspace) {
  enum { N = 96 };
  jet samples[N + 1];
  cprox_status status;
  for (size_t i = 0; i <= N; i++) {
    const double part = i % 3 == 0 ? 1.0 : i % 3 == 1 ? 0.6 : 0.2;
    const vec3 at = i == N ? vec(0, 0, 0) : vec_scale(part, spread(f, i, N));
    if (!measure(f, at, &samples[i])) return no_number(f, at, workspace);
    const vec3 x = place(f, at);
    if (i < N && part == 1.0 && !(samples[i].value > f->given.error))
      return workspace_fail(workspace, CPROX_INVALID,
                            "the convex function is %g at (%g, %g, %g), %g "
                            "from the interior point: the body must lie "
                            "within the radius",
                            samples[i].value, x.x, x.y, x.z, f->given.radius);
  }
  if (!(samples[N].value < -f->given.error))
    return workspace_fail(workspace, CPROX_INVALID,
                          "the convex function is %g at the interior point "
                          "(%g, %g, %g), must be below %g",
                          samples[N].value, f->given.interior.x, f->given.interior.y, f->given.interior.z,
                          -f->given.error);
  for (size_t i = 0; i <= N; i++)
    for (size_t k = 0; k <= N; k++)
      if ((status = check_tangent(f, &samples[i], &samples[k], workspace))) return status;
  return CPROX_OK;
}

/* What support points attain: eight times the widest gap of some directions is
 * what all of them may have. */
static cprox_status measure_gap(convex_function *f, cprox_workspace *workspace) {
  enum { N = 64 };
  double widest = GOAL;
  for (size_t i = 0; i < N; i++) {
    const vec3 u = spread(f, i, N);
    double gap;
    const vec3 at = support_point(f, u, &gap);
    if (isnan(gap)) return no_number(f, at, workspace);
    widest = greater(widest, fabs(gap));
    if (8.0 * widest > MOST_GAP)
      return workspace_fail(workspace, CPROX_INVALID,
                            "along (%g, %g, %g) the support point of the convex function is "
                            "known to %g of the radius "
                            "only: its gradient or Hessian is wrong, or its error is too large",
                            u.x, u.y, u.z, fabs(gap));
  }
  f->gap = 8.0 * widest;
  return CPROX_OK;
}

cprox_status cprox_body_create_convex_function(const cprox_convex_function *function, double margin,
                                               cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!function || !function->evaluate) return workspace_fail(workspace, CPROX_INVALID, "the convex function is NULL");
  if (!(function->error >= 0.0 && isfinite(function->error)))
    return workspace_fail(workspace, CPROX_INVALID, "error is %g, must be >= 0 and finite", function->error);
  if (function->planar && function->interior.z != 0.0)
    return workspace_fail(workspace, CPROX_INVALID, "interior.z is %g, must be 0 in the plane", function->interior.z);

  convex_function *kept = malloc(sizeof *kept);
  if (!kept) return body_out_of_memory(workspace);
  *kept = (convex_function){.given = *function, .gap = MOST_GAP};
  cprox_body *made = NULL; /* checks lengths before anything is evaluated */
  cprox_status status =
      WORKSPACE_LEND(workspace, cprox_body_create_support(function_support, kept, function->interior, function->radius,
                                                          0.0, margin, workspace, body ? &made : NULL));
  if (!status) status = check_samples(kept, workspace);
  if (!status) status = measure_gap(kept, workspace);
  if (status) {
    cprox_body_free(made);
    free(kept);
    return status;
  }
  made->function = kept;
  made->shape.slack += 2.0 * kept->gap * function->radius; /* rounding of the point included */
  *body = made;
  return CPROX_OK;
}
