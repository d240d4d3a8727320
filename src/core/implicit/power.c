/* SPDX-License-Identifier: BSD-3-Clause */
/* How far a power body sum |u_i|^p_i <= 1 reaches: for every mu >= 0
 *   max sum w_i u_i <= mu + sum over i of max over 0 <= u <= 1 of (w_i u - mu u^p_i),
 * with equality at one mu, where the maximisers u_i(mu) = (w_i/(mu p_i))^(1/(p_i-1)) make sum u^p = 1. Newton's method
 * in log mu on the logarithm of that sum. */
#include "base/rounding.h"
#include "implicit/implicit.h"

/* The bound for one mu, and the sum of the powers. u is not cut at 1; the bound is. */
static double reach_at(const implicit_term *term, int32_t n, const double *w, double mu, double *u, double *sum) {
  double bound = mu;
  *sum = 0.0;
  for (int32_t i = 0; i < n; i++) {
    u[i] = 0.0;
    if (!(w[i] > 0.0) || term[i].p == 1.0) continue;
    const double q = w[i] / (mu * term[i].p), v = term[i].p == 2.0 ? q : pow(q, term[i].slope), power = v * q;
    u[i] = v;
    bound += v < 1.0 ? w[i] * v * (1.0 - term[i].root) : w[i] - mu;
    *sum += power;
  }
  return bound;
}

/* Newton's last step, times the largest k. What is left of z is 5e-9 then. The bound is least at the root, so that it
 * is off by the square of that, and the point is drawn to the surface. */
static const double LAST_STEP = 1e-4;

/* The multiplier where sum u^p = 1, by Newton's method in z = log mu on log sum exp(k_i (log(w_i/p_i) - z)), k =
 * p/(p-1): convex and falling in z, so that from the left every step stays left of the root. Warm, it may start right
 * of it. After a step d what is left is at most max k d²/2: a last step to see that it is nothing need not be made. */
static double reach_multiplier(const implicit_term *term, int32_t n, const double *w, double start, double least,
                               int steps) {
  enum { MOST = IMPLICIT_MOST_TERMS };
  double k[MOST], c[MOST], steepest = 0.0; /* the exponents are c - k z */
  int32_t live = 0;
  for (int32_t i = 0; i < n; i++) {
    if (!(w[i] > 0.0) || term[i].p == 1.0) continue;
    k[live] = term[i].p * term[i].slope;
    c[live] = k[live] * log(w[i] * term[i].root);
    steepest = fmax(steepest, k[live]);
    live++;
  }
  double z = log(start);
  for (int step = 0; step < steps; step++) {
    double sum = 0.0, slope = 0.0;
    for (int32_t i = 0; i < live; i++) {
      const double power = exp(c[i] - k[i] * z);
      sum += power;
      slope += k[i] * power;
    }
    if (!(sum > 0.0) || !isfinite(slope)) { /* under- or overflow: not from there */
      double left = -INFINITY;
      for (int32_t i = 0; i < live; i++) left = fmax(left, c[i] / k[i]);
      if (z == left) break;
      z = left;
      continue;
    }
    const double next = z + log(sum) * sum / slope;
    const double moved = fabs(next - z);
    z = next;
    if (moved * steepest <= LAST_STEP || moved <= 4.0 * ROUND_U * (1.0 + fabs(z))) break;
  }
  return live > 0 ? fmax(exp(z), least) : least;
}

/* Draws u along its ray to sum u^p = 1, from wherever it is: the logarithm of the sum is convex in that of the length,
 * so that Newton's method comes down from outside. What it cannot draw becomes the point 0, which is inside. */
static void draw(const implicit_term *term, int32_t n, double *u) {
  enum { STEPS = 60 };
  double most = 0.0, steepest = 1.0;
  for (int32_t i = 0; i < n; i++) {
    most = fmax(most, u[i]);
    steepest = fmax(steepest, term[i].p);
  }
  double by = most > 0.0 && isfinite(most) ? 1.0 / most : 0.0;
  for (int32_t i = 0; i < n; i++) u[i] = by > 0.0 ? by * u[i] : 0.0;
  for (int step = 0; by > 0.0 && step < STEPS; step++) {
    double sum = 0.0, slope = 0.0;
    for (int32_t i = 0; i < n; i++) {
      const double power = implicit_raise(&term[i], u[i]);
      sum += power;
      slope += term[i].p * power;
    }
    const bool last = implicit_is_drawn(sum - 1.0, slope, steepest);
    by = last ? 1.0 - (sum - 1.0) / slope : exp(-log(sum) * sum / slope);
    for (int32_t i = 0; i < n; i++) u[i] *= by;
    if (last) return;
  }
  for (int32_t i = 0; i < n; i++) u[i] = 0.0;
}

double implicit_power_reach(const implicit_term *term, int32_t n, const double *w, double *mu, int steps, double *u) {
  /* mu may not fall below the weight of a term with p = 1, whose part of the bound would be positive */
  double least = 0.0, start = 0.0, steepest = 1.0;
  for (int32_t i = 0; i < n; i++) {
    steepest = fmax(steepest, term[i].p);
    if (term[i].p == 1.0) least = fmax(least, w[i]);
    start = fmax(start, w[i] * term[i].root);
    u[i] = 0.0;
  }
  if (!(start > 0.0)) {
    *mu = 0.0;
    return 0.0;
  }
  if (*mu > 0.0 && isfinite(*mu)) start = *mu;
  *mu = reach_multiplier(term, n, w, fmax(start, least), least, steps);
  double sum;
  const double bound = reach_at(term, n, w, *mu, u, &sum);

  /* terms with p = 1 take what the others leave, mu being the weight of one of them */
  if (*mu == least && sum < 1.0) {
    for (int32_t i = 0; i < n; i++) {
      if (term[i].p != 1.0 || w[i] != least) continue;
      u[i] = 1.0 - sum;
      return bound;
    }
  }
  double slope = 0.0; /* sum p u^p */
  for (int32_t i = 0; i < n; i++) slope += term[i].p > 1.0 ? u[i] * w[i] : 0.0;
  slope /= *mu;
  if (fabs(sum - 1.0) < 0.01 && implicit_is_drawn(sum - 1.0, slope, steepest))
    for (int32_t i = 0; i < n; i++) u[i] *= 1.0 - (sum - 1.0) / slope;
  else
    draw(term, n, u);
  return bound;
}
