/* SPDX-License-Identifier: BSD-3-Clause */
/* Closed bodies: one hyperquadric of three independent terms, which an affine map makes of a superquadric. Support
 * function by one equation; where the rows are orthogonal, nearest points by four. */
#include "base/rounding.h"
#include "implicit/implicit.h"

/* The determinant of three unit rows: from here on their inverse loses no more than six digits. */
static const double ROWS_SPAN = 1e-6;

/* The cosine of two rows that stand across each other: what rounding makes of 0. */
static const double ACROSS = 1e-14;

/* What powers and roots round, with much to spare. */
static const double POWER_ROUNDING = 1e-12;

/* Of logarithms: Newton's steps that are shorter have converged to rounding; quadratic ones, to its root. */
static const double LOG_CONVERGED = 1e-14, ROOT_CONVERGED = 1e-15, SQUARE_CONVERGED = 1e-8;

bool implicit_is_closed(const implicit *body, double inverse[9]) {
  if (body->n_powers != 1 || body->n_planes + body->n_quadrics > 0 || body->n_terms != 3) return false;
  const vec3 a = body->term[0].a, b = body->term[1].a, c = body->term[2].a;
  const vec3 bc = vec_cross(b, c), ca = vec_cross(c, a), ab = vec_cross(a, b);
  const double det = vec_dot(a, bc);
  if (!(fabs(det) > ROWS_SPAN * vec_norm(a) * vec_norm(b) * vec_norm(c))) return false;
  const vec3 column[3] = {vec_scale(1.0 / det, bc), vec_scale(1.0 / det, ca), vec_scale(1.0 / det, ab)};
  for (int i = 0; i < 3; i++) {
    inverse[i] = column[i].x;
    inverse[3 + i] = column[i].y;
    inverse[6 + i] = column[i].z;
  }
  return true;
}

double implicit_closed_radius(const implicit *body) {
  const implicit_term *term = body->term;
  double most = 0.0, exponent = 1.0, sum = 0.0;
  for (int i = 0; i < 3; i++) {
    const vec3 a = term[i].a, b = term[(i + 1) % 3].a;
    if (fabs(vec_dot(a, b)) > ACROSS * vec_norm(a) * vec_norm(b)) return INFINITY;
    most = fmax(most, 1.0 / vec_norm(a));
    exponent = fmax(exponent, term[i].p);
  }
  const double up = 1.0 + POWER_ROUNDING;
  if (exponent <= 2.0) return up * most;
  /* sum (x_i/a_i)^p <= 1 for the largest p, so |x|² <= (sum a_i^2q)^(1/q), 1/p/2 + 1/q = 1, by Hölder's inequality */
  const double q = exponent / (exponent - 2.0);
  for (int i = 0; i < 3; i++) sum += pow(1.0 / (vec_norm(term[i].a) * most), 2.0 * q);
  return up * most * pow(sum, 0.5 / q);
}

/* The derivative of u by w: diag(c) - v v'/(mu K), v_i = u_i/(p_i - 1), c_i = v_i/w_i, mu K = mu sum p_i u_i^p_i/(p_i -
 * 1) = sum w_i v_i, since w_i = mu p_i u_i^(p_i-1). */
static void reach_derivative(const implicit_term *term, const double w[3], const double u[3], double mu,
                             const double *inv, const double sign[3], double hessian[6]) {
  double v[3], c[3], whole = 0.0;
  const double most = 1e12; /* where w_i is 0 the surface is flat */
  for (int i = 0; i < 3; i++) {
    const bool moves = term[i].p > 1.0 && w[i] > 0.0;
    v[i] = moves ? u[i] * term[i].slope : 0.0;
    c[i] = moves ? fmin(v[i] / w[i], most * u[i] / mu + most) : 0.0;
    whole += w[i] * v[i];
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
  const double less = whole > 0.0 ? 1.0 / whole : 0.0;
  hessian[0] -= less * s.x * s.x;
  hessian[1] -= less * s.x * s.y;
  hessian[2] -= less * s.x * s.z;
  hessian[3] -= less * s.y * s.y;
  hessian[4] -= less * s.y * s.z;
  hessian[5] -= less * s.z * s.z;
}

double implicit_closed_support(const implicit *body, vec3 n, double *mu, vec3 *at, double hessian[6]) {
  enum { STEPS = 60 };
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
    double s[3];
    for (int i = 0; i < 3; i++) s[i] = sign[i] * u[i] - term[i].d;
    *at = vec(inv[0] * s[0] + inv[1] * s[1] + inv[2] * s[2], inv[3] * s[0] + inv[4] * s[1] + inv[5] * s[2],
              inv[6] * s[0] + inv[7] * s[1] + inv[8] * s[2]);
  }
  if (hessian) reach_derivative(term, w, u, *mu, inv, sign, hessian);
  return reach - offset;
}

/* ---- the nearest point ---- */

/* In logarithms: t_i = log u_i of the nearest point's rows, log_lambda of the multiplier, for
 *   u_i + lambda b_i u_i^(p_i-1) = |v_i|,   sum u_i^p_i = 1,   b_i = p_i |a_i|²,
 * v the rows of the point asked about. For a given lambda each row has one u_i, and their sum of powers falls with
 * lambda: so one equation is left, solved by Newton's method between bounds. */
typedef struct closest {
  double p[3], v[3], b[3]; /* logarithms of v and b */
  double t[3], log_lambda;
  bool live[3]; /* v_i is not 0; else u_i is */
} closest;

/* On the ray from the centre, as a start; lambda from the row that is farthest out. */
static void closest_begin(closest *c) {
  double most = -INFINITY, out = -INFINITY;
  for (int i = 0; i < 3; i++)
    if (c->live[i]) most = fmax(most, c->v[i]);
  double scale = -most;
  for (int step = 0; step < 3; step++) { /* sum exp(p (v + scale)) = 1, from above: a step or two is near enough */
    double sum = 0.0, slope = 0.0;
    for (int i = 0; i < 3; i++) {
      if (!c->live[i]) continue;
      const double power = exp(c->p[i] * (c->v[i] + scale));
      sum += power;
      slope += c->p[i] * power;
    }
    scale -= log(sum) * sum / slope;
  }
  for (int i = 0; i < 3; i++) {
    if (!c->live[i]) continue;
    c->t[i] = c->v[i] + scale;
    const double weight = c->b[i] + (c->p[i] - 1.0) * c->t[i]; /* log of b u^(p-1) */
    if (weight <= out) continue;
    out = weight;
    c->log_lambda = log(fmax(exp(c->v[i]) - exp(c->t[i]), 1e-300)) - weight;
  }
}

/* The row's u for the multiplier at hand. log(u + lambda b u^(p-1)) is convex and growing in t = log u, and where
 * either summand alone is |v| it is above by log 2 at most: from there Newton's method comes down. Returns the slope of
 * t by log_lambda. */
static double closest_row(closest *c, int i) {
  enum { STEPS = 12 };
  const double p1 = c->p[i] - 1.0, shift = c->log_lambda + c->b[i];
  double t = fmin(c->v[i], (c->v[i] - shift) / p1), slope = 0.0;
  for (int step = 0; step < STEPS; step++) {
    /* the smaller summand by the larger: neither may underflow both */
    const double lead = t, push = shift + p1 * t, most = fmax(lead, push);
    const double near = exp(lead - most), pushed = exp(push - most), whole = near + pushed;
    const double steep = (near + p1 * pushed) / whole, down = (most + log(whole) - c->v[i]) / steep;
    slope = -pushed / whole / steep;
    t -= down;
    if (!(fabs(down) > LOG_CONVERGED * (1.0 + fabs(t)))) break;
  }
  c->t[i] = t;
  return slope;
}

/* log sum u^p and its slope by log_lambda. */
static double closest_miss(closest *c, double *slope) {
  double sum = 0.0, change = 0.0;
  for (int i = 0; i < 3; i++) {
    if (!c->live[i]) continue;
    const double by = closest_row(c, i), power = exp(c->p[i] * c->t[i]);
    sum += power;
    change += c->p[i] * power * by;
  }
  *slope = sum > 0.0 ? change / sum : -1.0;
  return log(sum);
}

/* All four equations at once: a third of the work, where it converges. */
static bool closest_together(closest *c) {
  enum { STEPS = 12 };
  for (int step = 0; step < STEPS; step++) {
    double g[3] = {0.0}, s[3] = {0.0}, r[3] = {0.0}, q[3] = {0.0}, sum = 0.0, miss = 0.0, pull = 0.0;
    for (int i = 0; i < 3; i++) {
      if (!c->live[i]) continue;
      const double p1 = c->p[i] - 1.0, near = exp(c->t[i]), push = exp(c->log_lambda + c->b[i] + p1 * c->t[i]);
      const double whole = near + push;
      g[i] = log(whole) - c->v[i];
      s[i] = push / whole;
      r[i] = (near + p1 * push) / whole;
      q[i] = exp(c->p[i] * c->t[i]);
      sum += q[i];
    }
    for (int i = 0; i < 3; i++) {
      if (!c->live[i]) continue;
      q[i] *= c->p[i] / sum;
      miss += q[i] * g[i] / r[i];
      pull += q[i] * s[i] / r[i];
    }
    const double change = (log(sum) - miss) / pull;
    if (!(fabs(change) < 20.0)) return false;
    double longest = fabs(change);
    c->log_lambda += change;
    for (int i = 0; i < 3; i++) {
      if (!c->live[i]) continue;
      const double down = (g[i] + s[i] * change) / r[i];
      if (!(fabs(down) < 200.0)) return false;
      c->t[i] = fmin(c->t[i] - down, c->v[i]); /* u_i <= |v_i| */
      longest = fmax(longest, fabs(down));
    }
    if (longest < SQUARE_CONVERGED) return true; /* what is left is the square */
  }
  return false;
}

static bool closest_outside(closest *c) {
  enum { STEPS = 80 };
  double low = -INFINITY, high = INFINITY;
  for (int step = 0; step < STEPS; step++) {
    double slope;
    const double miss = closest_miss(c, &slope), here = c->log_lambda;
    if (isnan(miss)) return false;
    if (miss > 0.0)
      low = here;
    else
      high = here;
    double next = here - miss / slope;
    if (!isfinite(next) || fabs(next - here) > 30.0) next = here + (miss > 0.0 ? 30.0 : -30.0);
    if (!(next > low && next < high)) next = isfinite(low) && isfinite(high) ? 0.5 * (low + high) : next;
    if (fabs(next - here) <= ROOT_CONVERGED * (1.0 + fabs(here)) || fabs(miss) <= 4.0 * ROUND_U) return true;
    c->log_lambda = next;
  }
  return true;
}

void implicit_across(vec3 n, vec3 *e, vec3 *f) {
  const double x = fabs(n.x), y = fabs(n.y), z = fabs(n.z);
  const vec3 axis = x <= y && x <= z ? vec(1, 0, 0) : y <= z ? vec(0, 1, 0) : vec(0, 0, 1);
  const vec3 w = vec_cross(axis, n);
  *e = vec_scale(1.0 / vec_norm(w), w);
  *f = vec_cross(n, *e);
}

/* The second derivative of the distance d: S (1 + d S)^-1, S the shape operator in the tangent plane. */
static void closest_hessian(const implicit *body, const double u[3], double slope, vec3 n, double d, double h[6]) {
  vec3 e, f;
  implicit_across(n, &e, &f);
  double ee = 0.0, ef = 0.0, ff = 0.0;
  for (int i = 0; i < 3; i++) {
    const implicit_term *term = &body->term[i];
    const double bend = term->p * (term->p - 1.0) * (term->p == 2.0 ? 1.0 : pow(u[i], term->p - 2.0));
    const double c = fmin(bend, 1e12) / slope, x = vec_dot(term->a, e), y = vec_dot(term->a, f);
    ee += c * x * x;
    ef += c * x * y;
    ff += c * y * y;
  }
  const double det = ee * ff - ef * ef, spread = 1.0 / (1.0 + d * (ee + ff) + d * d * det);
  const double a = spread * (ee + d * det), b = spread * ef, c = spread * (ff + d * det);
  h[0] = a * e.x * e.x + 2.0 * b * e.x * f.x + c * f.x * f.x;
  h[1] = a * e.x * e.y + b * (e.x * f.y + e.y * f.x) + c * f.x * f.y;
  h[2] = a * e.x * e.z + b * (e.x * f.z + e.z * f.x) + c * f.x * f.z;
  h[3] = a * e.y * e.y + 2.0 * b * e.y * f.y + c * f.y * f.y;
  h[4] = a * e.y * e.z + b * (e.y * f.z + e.z * f.y) + c * f.y * f.z;
  h[5] = a * e.z * e.z + 2.0 * b * e.z * f.z + c * f.z * f.z;
}

bool implicit_closed_nearest(const implicit *body, vec3 y, double width, implicit_answer *answer) {
  closest c = {0};
  double sign[3], u[3] = {0, 0, 0};
  for (int i = 0; i < 3; i++) {
    const implicit_term *term = &body->term[i];
    const double row = implicit_row(term, y);
    if (!(term->p > 1.0)) return false;
    sign[i] = row < 0.0 ? -1.0 : 1.0;
    c.p[i] = term->p;
    c.b[i] = log(term->p * vec_norm2(term->a));
    c.live[i] = fabs(row) > 1e-200;
    c.v[i] = c.live[i] ? log(fabs(row)) : 0.0;
  }
  closest_begin(&c);
  const closest start = c;
  if (!closest_together(&c)) {
    c = start;
    if (!closest_outside(&c)) return false;
  }

  /* what rounding left is drawn onto the surface; the search may also have ended elsewhere, and then nothing is known
   */
  double sum = -1.0, slope = 0.0, steepest = 1.0;
  vec3 gradient = vec(0, 0, 0);
  for (int i = 0; i < 3; i++) {
    if (!c.live[i]) continue;
    u[i] = exp(c.t[i]);
    const double power = exp(c.p[i] * c.t[i]);
    sum += power;
    slope += c.p[i] * power;
    steepest = fmax(steepest, c.p[i]);
    gradient = vec_axpy(gradient, sign[i] * c.p[i] * exp((c.p[i] - 1.0) * c.t[i]), body->term[i].a);
  }
  if (!implicit_is_drawn(sum, slope, steepest)) return false;
  vec3 x = vec(0, 0, 0);
  const double *inv = body->inverse, by = 1.0 - sum / slope - 4.0 * ROUND_U;
  for (int i = 0; i < 3; i++)
    x = vec_axpy(x, sign[i] * by * u[i] - body->term[i].d, vec(inv[i], inv[3 + i], inv[6 + i]));

  const double steep = vec_norm(gradient);
  const vec3 n = vec_scale(1.0 / steep, gradient);
  double mu = 1.0 / steep; /* n's rows are mu p u^(p-1) */
  *answer = (implicit_answer){.x = x, .normal = vec_neg(n), .certified = true};
  answer->height = implicit_closed_support(body, n, &mu, NULL, NULL);
  answer->upper = vec_norm(vec_sub(y, x));
  answer->lower = vec_dot(n, y) - answer->height;
  if (!(answer->upper - answer->lower <= width)) return false;
  closest_hessian(body, u, steep, n, answer->upper, answer->hessian);
  return true;
}
