/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/superquadrics.h"

#include <float.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static double random_exponent(rng *r) {
  switch (rng_index(r, 6)) {
    case 0: return 1.0;
    case 1: return 1.0 + rng_log_uniform(r, 1e-3, 1.0);
    case 2: return 2.0;
    case 3: return 2.0 + rng_uniform(r, -0.1, 0.1);
    default: return 1.0 + rng_log_uniform(r, 1e-2, 49.0);
  }
}

superquadric superquadric_random(rng *r, double aspect) {
  superquadric s;
  for (int i = 0; i < 3; i++) {
    (&s.a.x)[i] = aspect > 1.0 ? rng_log_uniform(r, 1.0 / aspect, 1.0) : 1.0;
    (&s.p.x)[i] = random_exponent(r);
  }
  return s;
}

cprox_body *superquadric_body(const superquadric *s, cprox_workspace *workspace) {
  cprox_body *body = NULL;
  if (cprox_body_create_superquadric(s->a, s->p, workspace, &body)) fail_msg("%s", cprox_workspace_error(workspace));
  return body;
}

cprox_pose superquadric_random_pose(rng *r, double far) {
  cprox_pose pose = {.position = rng_in_cube(r, far), .orientation = rng_quat(r)};
  const double norm = rng_index(r, 4) == 0 ? 1.0 : rng_log_uniform(r, 1e-90, 1e90);
  cprox_quat *q = &pose.orientation;
  q->w *= norm, q->x *= norm, q->y *= norm, q->z *= norm;
  return pose;
}

long double superquadric_level(const superquadric *s, vec3l x) {
  return powl(fabsl(x.x) / s->a.x, s->p.x) + powl(fabsl(x.y) / s->a.y, s->p.y) + powl(fabsl(x.z) / s->a.z, s->p.z);
}

/* The logarithm of u with a u + lambda p u^(p-1)/a = y, by bisection that Newton's step may shorten; -infinity where u
 * is 0. And its derivative by log lambda. */
static long double row(long double a, long double p, long double y, long double log_lambda, long double *slope) {
  const long double push = log_lambda + logl(p / a), lead = logl(a), aim = logl(y);
  if (p == 1.0L) {
    const long double left = y - expl(push);
    *slope = left > 0 ? -expl(push) / left : 0;
    return left > 0 ? logl(left / a) : -(long double)INFINITY;
  }
  long double high = fminl(aim - lead, (aim - push) / (p - 1));
  long double low = fminl(aim - lead - 0.7L, (aim - push - 0.7L) / (p - 1));
  long double t = high;
  for (int i = 0; i < 80; i++) {
    const long double e1 = lead + t, e2 = push + (p - 1) * t, most = fmaxl(e1, e2);
    const long double w1 = expl(e1 - most), w2 = expl(e2 - most), miss = most + logl(w1 + w2) - aim;
    if (fabsl(miss) <= LDBL_EPSILON) break;
    if (miss > 0)
      high = t;
    else
      low = t;
    *slope = -w2 / (w1 + (p - 1) * w2);
    long double next = t - miss * (w1 + w2) / (w1 + (p - 1) * w2);
    if (!(next > low && next < high)) next = (low + high) / 2;
    if (fabsl(next - t) <= LDBL_EPSILON * fabsl(t)) break;
    t = next;
  }
  return t;
}

/* Drawn towards the centre until it is inside for certain. */
static vec3l draw_in(const superquadric *s, vec3l x) {
  const long double most = fmaxl(s->p.x, fmaxl(s->p.y, s->p.z));
  for (int i = 0; i < 200; i++) {
    const long double level = superquadric_level(s, x);
    if (level <= 1.0L - 8.0L * most * LDBL_EPSILON) return x;
    x = ref_scale(level > 1.0001L ? powl(level, -1.0L / most) : 1.0L - (level - 1.0L) - 16.0L * most * LDBL_EPSILON, x);
  }
  return (vec3l){0, 0, 0};
}

ref_interval superquadric_distance(const superquadric *s, vec3l y, vec3l *nearest) {
  if (nearest) *nearest = y;
  if (superquadric_level(s, y) <= 1.0L) return (ref_interval){0, 0};
  const long double a[3] = {s->a.x, s->a.y, s->a.z}, p[3] = {s->p.x, s->p.y, s->p.z};
  const long double v[3] = {fabsl(y.x), fabsl(y.y), fabsl(y.z)};

  /* the multiplier: the level of the rows' points falls with it */
  long double t[3], low = -200.0L, high = 200.0L, at = logl(ref_norm(y));
  for (int step = 0; step < 100; step++) {
    long double level = 0, fall = 0;
    for (int i = 0; i < 3; i++) {
      long double slope = 0;
      t[i] = v[i] > 0 ? row(a[i], p[i], v[i], at, &slope) : -(long double)INFINITY;
      const long double power = isfinite(t[i]) ? expl(fminl(p[i] * t[i], 1000.0L)) : 0;
      level += power;
      fall += p[i] * power * slope;
    }
    if (fabsl(level - 1) <= 4 * LDBL_EPSILON || high - low <= 4 * LDBL_EPSILON * fabsl(at)) break;
    if (level > 1)
      low = at;
    else
      high = at;
    long double next = fall < 0 ? at - logl(level) * level / fall : NAN;
    if (!(next > low && next < high) || step % 3 == 2) next = (low + high) / 2; /* Newton's alone may go to and fro */
    if (fabsl(next - at) <= 2 * LDBL_EPSILON * fabsl(at)) break;
    at = next;
  }

  /* the tangent plane at x: f(x) + g·(z - x) <= 0 for every z of the body */
  long double x[3], g[3], f = -1, lambda = expl(at), size = 0;
  for (int i = 0; i < 3; i++) {
    const bool none = !isfinite(t[i]);
    x[i] = none ? 0 : a[i] * expl(t[i]);
    g[i] = none ? (p[i] == 1.0L ? fminl(v[i] / lambda, 1 / a[i]) : 0) : p[i] * expl((p[i] - 1) * t[i]) / a[i];
    f += none ? 0 : powl(x[i] / a[i], p[i]);
    size = fmaxl(size, p[i]);
  }
  const long double steep = sqrtl(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
  long double lower = f - 8 * size * LDBL_EPSILON, reach = 0;
  for (int i = 0; i < 3; i++) {
    lower += g[i] * (v[i] - x[i]);
    reach += v[i] + a[i];
  }
  const vec3l inside = draw_in(s, (vec3l){copysignl(x[0], y.x), copysignl(x[1], y.y), copysignl(x[2], y.z)});
  if (nearest) *nearest = inside;
  const long double rounding = 16 * LDBL_EPSILON * reach;
  return (ref_interval){fmaxl(lower / steep - rounding, 0), ref_norm(ref_sub(y, inside)) + rounding};
}

/* max of w·u over sum u^p <= 1 is at most mu + sum of max over 0 <= u <= 1 of (w u - mu u^p), whatever mu. */
static long double reach_for(const long double w[3], const long double p[3], long double mu) {
  long double sum = mu;
  for (int i = 0; i < 3; i++) {
    if (p[i] == 1.0L) {
      sum += fmaxl(w[i] - mu, 0);
      continue;
    }
    const long double u = w[i] > 0 ? fminl(powl(w[i] / (mu * p[i]), 1 / (p[i] - 1)), 1) : 0;
    sum += w[i] * u - mu * powl(u, p[i]);
  }
  return sum * (1 + 64 * LDBL_EPSILON);
}

long double superquadric_reach(const superquadric *s, vec3l d) {
  const long double w[3] = {fabsl(d.x) * s->a.x, fabsl(d.y) * s->a.y, fabsl(d.z) * s->a.z};
  const long double p[3] = {s->p.x, s->p.y, s->p.z}, most = w[0] + w[1] + w[2];
  if (!(most > 0)) return 0;
  long double low = most / 200, high = most;
  for (int i = 0; i < 70; i++) { /* the bound is convex in mu: by the sign of its slope */
    const long double mu = (low + high) / 2;
    long double slope = 1;
    for (int k = 0; k < 3; k++)
      if (w[k] > 0) slope -= p[k] == 1.0L ? w[k] > mu : powl(fminl(powl(w[k] / (mu * p[k]), 1 / (p[k] - 1)), 1), p[k]);
    if (slope < 0)
      low = mu;
    else
      high = mu;
  }
  return fminl(reach_for(w, p, low), reach_for(w, p, high));
}
