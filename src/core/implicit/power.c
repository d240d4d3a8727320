/* SPDX-License-Identifier: BSD-3-Clause */
/* How far a power body sum |u_i|^p_i <= 1 reaches: for every mu >= 0
 *   max sum w_i u_i <= mu + sum over i of max over 0 <= u <= 1 of (w_i u - mu u^p_i),
 * with equality at one mu, where the maximisers u_i(mu) = (w_i/(mu p_i))^(1/(p_i-1)) make sum u^p = 1. Newton's method in
 * log mu on the logarithm of that sum. */
#include "base/rounding.h"
#include "implicit/implicit.h"

/* The bound, the sum S of the powers and its logarithmic slope D for one mu. The powers are not cut at u = 1, or Newton's
 * method would stand on a plateau; the bound is. */
static double reach_at(const implicit_term *term, int32_t n, const double *w, double mu, double *u, double *sum,
                       double *slope) {
  double bound = mu;
  *sum = *slope = 0.0;
  for (int32_t i = 0; i < n; i++) {
    u[i] = 0.0;
    if (!(w[i] > 0.0) || term[i].p == 1.0) continue;
    const double q = w[i] / (mu * term[i].p), v = term[i].p == 2.0 ? q : pow(q, term[i].slope), power = v * q;
    u[i] = fmin(v, 1.0);
    bound += v < 1.0 ? w[i] * v * (1.0 - term[i].root) : w[i] - mu;
    *sum += power;
    *slope += term[i].p * term[i].slope * power;
  }
  return bound;
}

double implicit_power_reach(const implicit_term *term, int32_t n, const double *w, double *mu, int steps, double *u) {
  /* mu may not fall below the weight of a term with p = 1, whose part of the bound would be positive; and starts where one
   * u_i is 1 at least */
  double least = 0.0, start = 0.0;
  for (int32_t i = 0; i < n; i++) {
    if (term[i].p == 1.0) least = fmax(least, w[i]);
    start = fmax(start, w[i] * term[i].root);
  }
  for (int32_t i = 0; i < n; i++) u[i] = 0.0;
  if (!(start > 0.0)) {
    *mu = 0.0;
    return 0.0;
  }
  double m = fmax(*mu > 0.0 && isfinite(*mu) ? *mu : start, least);

  double sum, slope, bound = reach_at(term, n, w, m, u, &sum, &slope);
  for (int i = 0; i < steps; i++) {
    if (!(slope > 0.0) || !(sum > 0.0) || !isfinite(sum) || !isfinite(slope)) {
      /* all powers have underflowed, or one overflowed: not from there */
      const double again = fmax(start, least);
      if (m == again) break;
      m = again;
    } else {
      const double miss = log(sum);
      if (fabs(miss) <= 8.0 * ROUND_U || (m == least && miss <= 0.0)) break;
      const double next = fmax(m * exp(fmin(fmax(miss * sum / slope, -40.0), 40.0)), least);
      if (next == m) break;
      m = next;
    }
    bound = reach_at(term, n, w, m, u, &sum, &slope);
  }
  *mu = m;

  /* terms with p = 1 take what the others leave: mu is the weight of one of them */
  if (m == least && sum < 1.0) {
    for (int32_t i = 0; i < n; i++) {
      if (term[i].p != 1.0 || w[i] != least) continue;
      u[i] = 1.0 - sum;
      break;
    }
  }
  return bound;
}

/* Draws the maximiser onto the surface: along the ray from 0 by one Newton step, since it is off by rounding alone. */
static void reach_pull(const implicit_term *term, double u[3]) {
  double sum = -1.0, slope = 0.0;
  for (int i = 0; i < 3; i++) {
    const double power = implicit_raise(&term[i], u[i]);
    sum += power;
    slope += term[i].p * power;
  }
  if (!(slope > 0.0)) return;
  const double scale = 1.0 - sum / slope;
  for (int i = 0; i < 3; i++) u[i] *= scale;
}

/* The derivative of u by w: diag(c) - v v'/(mu K), v_i = u_i/(p_i - 1), c_i = v_i/w_i, K = sum p_i u_i^p_i/(p_i - 1). */
static void reach_derivative(const implicit_term *term, const double w[3], const double u[3], double mu,
                             const double *inv, const double sign[3], double hessian[6]) {
  double v[3], c[3], k = 0.0;
  const double most = 1e12; /* where w_i is 0 the surface is flat */
  for (int i = 0; i < 3; i++) {
    const bool moves = term[i].p > 1.0 && w[i] > 0.0;
    v[i] = moves ? u[i] * term[i].slope : 0.0;
    c[i] = moves ? fmin(v[i] / w[i], most * u[i] / mu + most) : 0.0;
    k += moves ? term[i].p * term[i].slope * implicit_raise(&term[i], u[i]) : 0.0;
    v[i] *= sign[i];
  }
  vec3 s = vec(0, 0, 0);
  for (int i = 0; i < 6; i++) hessian[i] = 0.0;
  for (int i = 0; i < 3; i++) {
    const vec3 column = vec(inv[i], inv[3 + i], inv[6 + i]);
    s = vec_axpy(s, v[i], column);
    hessian[0] += c[i] * column.x * column.x;
    hessian[1] += c[i] * column.x * column.y;
    hessian[2] += c[i] * column.x * column.z;
    hessian[3] += c[i] * column.y * column.y;
    hessian[4] += c[i] * column.y * column.z;
    hessian[5] += c[i] * column.z * column.z;
  }
  const double less = mu > 0.0 && k > 0.0 ? 1.0 / (mu * k) : 0.0;
  hessian[0] -= less * s.x * s.x;
  hessian[1] -= less * s.x * s.y;
  hessian[2] -= less * s.x * s.z;
  hessian[3] -= less * s.y * s.y;
  hessian[4] -= less * s.y * s.z;
  hessian[5] -= less * s.z * s.z;
}

double implicit_closed_support(const implicit *body, vec3 n, double *mu, vec3 *at, double hessian[6]) {
  enum { STEPS = 40 };
  const implicit_term *term = body->term;
  const double *inv = body->inverse;
  /* x = A^-1 (u - d): n·x = w·u - w·d with w = A^-T n */
  const double along[3] = {inv[0] * n.x + inv[3] * n.y + inv[6] * n.z, inv[1] * n.x + inv[4] * n.y + inv[7] * n.z,
                           inv[2] * n.x + inv[5] * n.y + inv[8] * n.z};
  double w[3], sign[3], u[3], offset = 0.0;
  for (int i = 0; i < 3; i++) {
    sign[i] = along[i] < 0.0 ? -1.0 : 1.0;
    w[i] = fabs(along[i]);
    offset += along[i] * term[i].d;
  }
  const double reach = implicit_power_reach(term, 3, w, mu, STEPS, u);
  if (at) {
    reach_pull(term, u);
    double s[3];
    for (int i = 0; i < 3; i++) s[i] = sign[i] * u[i] - term[i].d;
    *at = vec(inv[0] * s[0] + inv[1] * s[1] + inv[2] * s[2], inv[3] * s[0] + inv[4] * s[1] + inv[5] * s[2],
              inv[6] * s[0] + inv[7] * s[1] + inv[8] * s[2]);
  }
  if (hessian) reach_derivative(term, w, u, *mu, inv, sign, hessian);
  return reach - offset;
}
