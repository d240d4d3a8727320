/* SPDX-License-Identifier: BSD-3-Clause */
/* psi' = T = (cos, sin)(heading). With curvature k and rate r, psi'' = k (-sin, cos), and by Leibniz' rule
 *   T^(j+1) = i (k T^(j) + j r T^(j-1)),   so   |T^(j)| <= q_j,   q_0 = 1,   q_(j+1) = K q_j + j |r| q_(j-1),   K =
 * max|k|, K being attained at an end of the interval. |psi^(6)| <= q_5.
 *
 * The point goes along by Gauss' rule with 8 nodes, in steps h with .6 K h + 1.2 sqrt(r) h <= 1: its remainder is
 *   h^17 (8!)^4 / (17 (16!)^3) q_16 = 1.7e-23 h^17 q_16        (P. J. Davis, P. Rabinowitz, Methods of Numerical
 * Integration). Rounding of a step: a node's distance from the step's beginning is within 3u of itself, the angle
 * turned on it within 8u of
 * (|k| + |r| h/2) h <= 2Kh; cosine and sine within 6u; the weight, its product, the sum of 8 and the factor h cost 11u:
 * together at most h u (20 + 16 K h). The steps' sum is double-double. The heading itself is double-double, within 32u²
 * of the sizes of its terms. */
#include "curve/heading.h"

#include "base/rounding.h"

#define GAUSS_REMAINDER 1.7e-23

enum { NODES = 8, GAUSS_ORDER = 16 };

/* q_j for a curvature of at most K */
static double derivative_bound(double curvature, double rate, int j) {
  double before = 0.0, q = 1.0;
  for (int i = 0; i < j; i++) {
    const double next = curvature * q + i * rate * before;
    before = q;
    q = next;
  }
  return q;
}

static dd curvature_at(const heading_curve *c, double t) {
  return dd_add(c->curvature, dd_scale(dd_sum(t, -c->origin), c->rate));
}

static double largest_curvature(const heading_curve *c, double a, double b) {
  return ROUND_UP * fmax(fabs(curvature_at(c, a).high), fabs(curvature_at(c, b).high));
}

dd heading_at(const heading_curve *c, double t, double *error) {
  const dd along = dd_sum(t, -c->origin);
  const dd turned = dd_multiply(dd_add(c->curvature, dd_scale(along, 0.5 * c->rate)), along);
  const double size = fabs(along.high);
  *error += c->heading_error +
            32.0 * DD_UNIT * (fabs(c->heading.high) + (fabs(c->curvature.high) + fabs(c->rate) * size) * size);
  return dd_add(c->heading, turned);
}

/* Gauss' rule of NODES points on [0, 1]. */
static const double node[NODES] = {0.019855071751231884, 0.10166676129318663, 0.23723379504183551, 0.40828267875217510,
                                   0.59171732124782490,  0.76276620495816449, 0.89833323870681337, 0.98014492824876812};
static const double weight[NODES] = {0.05061426814518813, 0.11119051722668724, 0.15685332293894364,
                                     0.18134189168918099, 0.18134189168918099, 0.15685332293894364,
                                     0.11119051722668724, 0.05061426814518813};

/* One step of Gauss' rule. */
static void step(heading_curve *c, double to) {
  double angle_error = 0.0;
  const dd heading = heading_at(c, c->at, &angle_error);
  const double h = to - c->at, curvature = curvature_at(c, c->at).high;
  double x = 0.0, y = 0.0;
  for (int j = 0; j < NODES; j++) {
    const double along = h * node[j], turned = along * (curvature + 0.5 * c->rate * along);
    const angle at = angle_of(dd_add(heading, dd_from(turned)));
    x += weight[j] * at.cosine;
    y += weight[j] * at.sine;
  }
  c->x = dd_add(c->x, dd_from(h * x));
  c->y = dd_add(c->y, dd_from(h * y));

  const double length = fabs(h), most = largest_curvature(c, c->at, to);
  const double of_rounding = length * (ROUND_U * (20.0 + 16.0 * most * length) + angle_error);
  const double growth = derivative_bound(most * length, fabs(c->rate) * length * length, GAUSS_ORDER);
  c->error += ROUND_UP * (of_rounding + GAUSS_REMAINDER * length * growth);
  c->at = to;
}

/* Steps of Gauss' rule between two parameters. */
static double steps_between(const heading_curve *c, double from, double to) {
  const double a_unit = 0.6 * largest_curvature(c, from, to) + 1.2 * sqrt(fabs(c->rate));
  return fmax(1.0, ceil(a_unit * fabs(to - from)));
}

bool heading_advance(heading_curve *c, double to) {
  const double steps = steps_between(c, c->at, to);
  c->steps += steps;
  if (!(c->steps <= HEADING_MOST_STEPS)) return false;
  const double from = c->at;
  const int n = (int)steps;
  for (int i = 1; i < n; i++) step(c, from + (to - from) * (i / steps));
  step(c, to);
  return true;
}

bool heading_moments(const heading_curve *c, double to, vec3 moment[3]) {
  const double steps = steps_between(c, c->origin, to), h = (to - c->origin) / steps;
  for (int j = 0; j < 3; j++) moment[j] = vec(0.0, 0.0, 0.0);
  if (!(steps <= HEADING_MOST_STEPS)) return false;
  for (int i = 0; i < (int)steps; i++) {
    for (int k = 0; k < NODES; k++) {
      const double along = h * (i + node[k]);
      const dd turned = dd_scale(dd_add(c->curvature, dd_from(0.5 * c->rate * along)), along);
      const angle at = angle_of(dd_add(c->heading, turned));
      double share = h * weight[k];
      for (int j = 0; j < 3; j++, share *= along) {
        moment[j].x += share * at.cosine;
        moment[j].y += share * at.sine;
      }
    }
  }
  return true;
}

static void evaluate(void *self, double t, compile_jet *jet) {
  heading_curve *c = self;
  if (t != c->at && !heading_advance(c, t)) c->x = dd_from(NAN);
  double angle_error = 0.0;
  const angle at = angle_of(heading_at(c, t, &angle_error));
  const double curvature = curvature_at(c, t).high;
  const double direction = 1.4142135623730951 * ANGLE_ERROR + angle_error;
  jet->d[0] = vec(c->x.high, c->y.high, 0.0);
  jet->d[1] = vec(at.cosine, at.sine, 0.0);
  jet->d[2] = vec(-curvature * at.sine, curvature * at.cosine, 0.0);
  jet->error[0] = c->error + ROUND_U * vec_norm(jet->d[0]);
  jet->error[1] = direction;
  jet->error[2] = fabs(curvature) * (direction + 2.0 * ROUND_U);
}

static double sixth_derivative(void *self, double a, double b) {
  const heading_curve *c = self;
  return ROUND_UP * derivative_bound(largest_curvature(c, a, b), fabs(c->rate), 5);
}

compile_source heading_source(heading_curve *c) {
  return (compile_source){.self = c, .evaluate = evaluate, .sixth = sixth_derivative};
}
