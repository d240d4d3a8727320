/* SPDX-License-Identifier: BSD-3-Clause */
#include "named.h"
#include "support/make_curve.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double PI = 3.14159265358979323846;

static void check(cprox_status status) {
  if (status >= 0) return;
  fprintf(stderr, "a problem could not be made: %s\n", cprox_status_text(status));
  exit(1);
}

/* ---- trigonometric series ---- */

static vec3 series_point(const void *self, double t) {
  const named_curve *c = self;
  vec3 x = c->coefficient[0];
  for (size_t k = 1; k <= c->harmonics; k++) {
    x = vec_axpy(x, cos((double)k * t), c->coefficient[2 * k - 1]);
    x = vec_axpy(x, sin((double)k * t), c->coefficient[2 * k]);
  }
  return x;
}

static double series_energy(const void *self, double t) {
  const named_curve *c = self;
  double sum = c->energy[0] * t;
  for (size_t k = 1; k <= 2 * c->harmonics; k++)
    sum += (c->energy[2 * k - 1] * sin((double)k * t) + c->energy[2 * k] * (1.0 - cos((double)k * t))) / (double)k;
  return sum;
}

/* psi' has the coefficients k b_k of cos kt and -k a_k of sin kt; products of two waves are sums of waves. */
static void square_of_derivative(named_curve *c) {
  for (size_t i = 1; i <= c->harmonics; i++) {
    for (size_t j = 1; j <= c->harmonics; j++) {
      const vec3 pi = vec_scale((double)i, c->coefficient[2 * i]),
                 qi = vec_scale(-(double)i, c->coefficient[2 * i - 1]);
      const vec3 pj = vec_scale((double)j, c->coefficient[2 * j]),
                 qj = vec_scale(-(double)j, c->coefficient[2 * j - 1]);
      const double pp = vec_dot(pi, pj), qq = vec_dot(qi, qj), pq = vec_dot(pi, qj), qp = vec_dot(qi, pj);
      const size_t sum = i + j, difference = i > j ? i - j : j - i;
      const double sign = i > j ? 1.0 : -1.0;
      c->energy[2 * sum - 1] += 0.5 * (pp - qq);
      c->energy[2 * sum] += 0.5 * (pq + qp);
      if (difference == 0) {
        c->energy[0] += 0.5 * (pp + qq);
      } else {
        c->energy[2 * difference - 1] += 0.5 * (pp + qq);
        c->energy[2 * difference] += 0.5 * sign * (qp - pq);
      }
    }
  }
}

/* The first 2 harmonics + 1 coefficients are set. */
static void finish_series(named_curve *c, vec3 centre, double size) {
  for (size_t k = 0; k < 2 * c->harmonics + 1; k++) c->coefficient[k] = vec_scale(size, c->coefficient[k]);
  c->coefficient[0] = vec_add(c->coefficient[0], centre);
  square_of_derivative(c);
  check(curve_from(describe_trigonometric(c->coefficient, 2 * c->harmonics + 1, 0.0, 2.0 * PI), NULL, &c->curve));
  c->paper = (paper_curve){.t1 = 2.0 * PI, .planar = true, .self = c, .point = series_point, .energy = series_energy};
}

/* x = sin³ t, y = (13 cos t - 5 cos 2t - 2 cos 3t - cos 4t)/16. */
void named_heart(vec3 centre, double size, named_curve *c) {
  *c = (named_curve){.harmonics = 4};
  c->coefficient[2].x = 0.75, c->coefficient[6].x = -0.25;
  c->coefficient[1].y = 13.0 / 16.0, c->coefficient[3].y = -5.0 / 16.0;
  c->coefficient[5].y = -2.0 / 16.0, c->coefficient[7].y = -1.0 / 16.0;
  finish_series(c, centre, size);
}

/* Three cusps: x = (4 cos t - cos 4t)/5, y = (4 sin t - sin 4t)/5. */
void named_epicycloid(vec3 centre, double size, named_curve *c) {
  *c = (named_curve){.harmonics = 4};
  c->coefficient[1].x = 0.8, c->coefficient[7].x = -0.2;
  c->coefficient[2].y = 0.8, c->coefficient[8].y = -0.2;
  finish_series(c, centre, size);
}

/* x = cos t - sin² t/sqrt 2, y = cos t sin t. */
void named_fish(vec3 centre, double size, named_curve *c) {
  *c = (named_curve){.harmonics = 2};
  const double q = 0.5 / sqrt(2.0);
  c->coefficient[0].x = -q, c->coefficient[1].x = 1.0, c->coefficient[3].x = q;
  c->coefficient[4].y = 0.5;
  finish_series(c, centre, size);
}

/* x = sin 3t, y = sin 2t. */
void named_lissajous(vec3 centre, double size, named_curve *c) {
  *c = (named_curve){.harmonics = 3};
  c->coefficient[6].x = 1.0, c->coefficient[4].y = 1.0;
  finish_series(c, centre, size);
}

/* ---- the others ---- */

static vec3 involute_point(const void *self, double t) {
  const named_curve *c = self;
  return vec(c->centre.x + cos(t) + t * sin(t), c->centre.y + sin(t) - t * cos(t), 0.0);
}

static double involute_energy(const void *self, double t) {
  (void)self;
  return t * t * t / 3.0;
}

void named_involute(vec3 centre, double t1, named_curve *c) {
  *c = (named_curve){.centre = centre};
  check(curve_from(describe_involute(centre, 1.0, 0.0, 0.0, t1), NULL, &c->curve));
  c->paper = (paper_curve){.t1 = t1, .planar = true, .self = c, .point = involute_point, .energy = involute_energy};
}

static vec3 compiled_point(const void *self, double t) {
  const named_curve *c = self;
  vec3 x;
  check(cprox_curve_evaluate(c->curve, t, NULL, &x, NULL, NULL));
  return x;
}

static double unit_energy(const void *self, double t) {
  (void)self;
  return t + 2.0 * PI;
}

/* By the Bernstein coefficients of |psi'|² - 1 of each piece. What rounding takes from control points 1e-16 off, 5 of
 * them over a piece's width, is counted as 1e-12. */
static double stretch_of(const cprox_curve *curve) {
  static const double rounding = 1e-12;
  const cprox_curve_info info = cprox_curve_get_info(curve);
  const size_t n = info.degree - 1;
  double most = 0.0;
  for (size_t i = 0; i < info.n_pieces; i++) {
    vec3 p[CPROX_MAX_DEGREE + 1];
    double square[2 * CPROX_MAX_DEGREE] = {0}, weight[2 * CPROX_MAX_DEGREE] = {0}, first = 1.0;
    const cprox_curve_piece_info piece = cprox_curve_get_piece_info(curve, i);
    check(cprox_curve_control_points(curve, piece.t0, piece.t1, NULL, p));
    for (size_t k = 0; k <= n; k++)
      p[k] = vec_scale((double)info.degree / (piece.t1 - piece.t0), vec_sub(p[k + 1], p[k]));
    for (size_t k = 0; k <= n; first *= (double)(n - k) / (double)(k + 1), k++) {
      double second = 1.0;
      for (size_t l = 0; l <= n; second *= (double)(n - l) / (double)(l + 1), l++) {
        square[k + l] += first * second * (vec_dot(p[k], p[l]) - 1.0);
        weight[k + l] += first * second;
      }
    }
    for (size_t k = 0; k <= 2 * n; k++) most = fmax(most, square[k] / weight[k]);
  }
  return most + rounding;
}

void named_spiral(vec3 centre, named_curve *c) {
  *c = (named_curve){.centre = centre};
  check(curve_from(describe_clothoid(centre, 0.0, 0.0, 1.0, -2.0 * PI, 2.0 * PI), NULL, &c->curve));
  c->stretch = stretch_of(c->curve);
  c->paper = (paper_curve){
      .t0 = -2.0 * PI, .t1 = 2.0 * PI, .planar = true, .self = c, .point = compiled_point, .energy = unit_energy};
}

/* ---- errors ---- */

/* A wave is within 2u of its coefficient, its product with that included, and u |kt| for the angle unless k is a power
 * of two; a sum adds u of all coefficients a wave. An evaluation of the spiral's pieces has 3 degree + 3 roundings. */
double named_error(const named_curve *c) {
  const double u = 1.1102230246251565e-16;
  if (c->harmonics == 0) {
    const cprox_curve_info info = cprox_curve_get_info(c->curve);
    const double size = fmax(vec_norm(info.lowest), vec_norm(info.highest));
    return (3.0 * (double)info.degree + 3.0) * u * size;
  }
  vec3 error = {0}, sum = {0};
  for (size_t i = 0; i < 2 * c->harmonics + 1; i++) {
    const size_t k = (i + 1) / 2;
    const vec3 p = c->coefficient[i], size = vec(fabs(p.x), fabs(p.y), fabs(p.z));
    sum = vec_add(sum, size);
    error = vec_axpy(error, (k > 0 ? 2.0 : 0.0) + (k & (k - 1) ? (double)k * c->paper.t1 : 0.0), size);
    const vec3 added = vec(size.x > 0.0 ? sum.x : 0.0, size.y > 0.0 ? sum.y : 0.0, 0.0); /* a zero is added exactly */
    error = vec_add(error, added);
  }
  return 1.01 * u * vec_norm(error);
}

/* ---- energies of intervals ---- */

/* sin kb - sin ka = 2 cos k(a + b)/2 sin k(b - a)/2, likewise of cos: a term's error is that of its factors, 3u each, and
 * of the mean's angle, 2u |angle|; sums have 20u. */
double named_energy(const named_curve *c, double a, double b, double *error) {
  const double u = 1.1102230246251565e-16;
  if (c->harmonics == 0) {
    *error = (2.0 * u + c->stretch) * (b - a);
    return b - a;
  }
  double sum = c->energy[0] * (b - a), sizes = fabs(c->energy[0]), angles = 0.0;
  for (size_t k = 1; k <= 2 * c->harmonics; k++) {
    const double middle = 0.5 * (double)k * (a + b), wave = sin(0.5 * (double)k * (b - a)),
                 size = fabs(c->energy[2 * k - 1]) + fabs(c->energy[2 * k]);
    sum += (c->energy[2 * k - 1] * cos(middle) + c->energy[2 * k] * sin(middle)) * 2.0 * wave / (double)k;
    sizes += size, angles += size * fabs(middle);
  }
  *error = u * (b - a) * (40.0 * sizes + 2.0 * angles);
  return sum;
}
