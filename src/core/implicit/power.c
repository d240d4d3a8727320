/* SPDX-License-Identifier: BSD-3-Clause */
/* How far a power body sum |u_i|^p_i <= 1 reaches: for every mu >= 0
 *   max sum w_i u_i <= mu + sum over i of max over 0 <= u <= 1 of (w_i u - mu u^p_i),
 * with equality at one mu, where the maximisers u_i(mu) = (w_i/(mu p_i))^(1/(p_i-1)) make sum u^p = 1. Newton's method in
 * log mu on the logarithm of that sum. */
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

/* Newton's last step, times the largest k: its square is below rounding. */
static const double LAST_STEP = 1e-9;

/* The multiplier where sum u^p = 1, by Newton's method in z = log mu on log sum exp(k_i (log(w_i/p_i) - z)), k = p/(p-1):
 * convex and falling in z, so that from the left every step stays left of the root. Warm, it may start right of it. After a step d what
 * is left is at most max k d²/2: a last step to see that it is nothing need not be made. */
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

double implicit_power_reach(const implicit_term *term, int32_t n, const double *w, double *mu, int steps, double *u) {
  /* mu may not fall below the weight of a term with p = 1, whose part of the bound would be positive */
  double least = 0.0, start = 0.0;
  for (int32_t i = 0; i < n; i++) {
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

  /* the maximiser is drawn onto the surface along its ray, off which it is by rounding alone; terms with p = 1 take what the
   * others leave, mu being the weight of one of them */
  double by = 0.0;
  for (int32_t i = 0; i < n; i++) by += term[i].p > 1.0 ? u[i] * w[i] : 0.0; /* sum p u^p times mu */
  by /= *mu;
  if (*mu == least && sum < 1.0) {
    for (int32_t i = 0; i < n; i++) {
      if (term[i].p != 1.0 || w[i] != least) continue;
      u[i] = 1.0 - sum;
      return bound;
    }
  }
  if (by > 0.0 && fabs(sum - 1.0) < 0.01)
    for (int32_t i = 0; i < n; i++) u[i] *= 1.0 - (sum - 1.0) / by;
  return bound;
}
