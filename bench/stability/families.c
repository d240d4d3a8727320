/* SPDX-License-Identifier: BSD-3-Clause */
/* The families: each draws a case whose distance is known by construction. */
#include <math.h>
#include <stdlib.h>

#include "stability/hard.h"

/* A unit square below y = 0, whose upper side is hard to tell apart along. */
static void square_below(hard *h) {
  h->n = 4, h->planar = true;
  const vec3 corner[4] = {{-1.0, -1.0, 0.0}, {1.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}};
  for (size_t i = 0; i < 4; i++) h->vertex[i] = corner[i];
}

static void one_point(hard *h, vec3 p) {
  h->n = 1, h->planar = true;
  h->vertex[0] = p;
}

/* The control points of (x(t), c (x(t))^power + gap) for x = 2t - 1: by the elevation of a monomial to Bernstein form.
 */
static void graph_of_power(hard *h, size_t power, double c, double gap) {
  h->degree = power;
  for (size_t i = 0; i <= power; i++) {
    const double x = 2.0 * (double)i / (double)power - 1.0;
    /* (2t - 1)^p has the Bernstein coefficients (-1)^(p - i) */
    const double y = ((power - i) % 2 == 0 ? c : -c) + gap;
    h->points[i] = vec(0.5 * x, y, 0.0);
  }
}

/* Keeps the part from 0 to t of a curve (de Casteljau), or with `last` the part from t to 1. */
static void cut(vec3 *points, size_t degree, double t, bool last) {
  vec3 p[MAX_POINTS], kept[MAX_POINTS];
  for (size_t i = 0; i <= degree; i++) p[i] = points[i];
  for (size_t k = 0; k <= degree; k++) {
    kept[last ? degree - k : k] = p[last ? degree - k : 0];
    for (size_t i = 0; i + k < degree; i++) p[i] = vec_add(vec_scale(1.0 - t, p[i]), vec_scale(t, p[i + 1]));
  }
  for (size_t i = 0; i <= degree; i++) points[i] = kept[i];
}

/* What is special about a curve is in its middle at first, where every halving meets it: moved elsewhere. */
static void shift_middle(rng *r, hard *h) {
  cut(h->points, h->degree, rng_uniform(r, 0.7, 1.0), false);
  cut(h->points, h->degree, rng_uniform(r, 0.0, 0.3), true);
}

/* Along a side at an uneven speed. */
static void parallel_to_side(rng *r, hard *h) {
  square_below(h);
  h->degree = 5;
  h->truth = rng_uniform(r, 0.1, 0.5);
  for (size_t i = 0; i <= 5; i++) h->points[i] = vec(rng_uniform(r, -0.9, 0.9), h->truth, 0.0);
}

/* A parabola or a flatter curve that all but touches. */
static void near_tangent(rng *r, hard *h) {
  square_below(h);
  h->truth = 1e-9 * rng_uniform(r, 0.5, 2.0);
  graph_of_power(h, 2, rng_uniform(r, 0.1, 1.0), h->truth);
  shift_middle(r, h);
}

static void eightfold_contact(rng *r, hard *h) {
  square_below(h);
  h->truth = rng_uniform(r, 0.01, 0.1);
  graph_of_power(h, 8, rng_uniform(r, 0.1, 1.0), h->truth);
  shift_middle(r, h);
}

static void touching(rng *r, hard *h) {
  square_below(h);
  h->truth = 0.0;
  graph_of_power(h, 2, rng_uniform(r, 0.1, 1.0), 0.0);
  shift_middle(r, h);
}

static void end_touches(rng *r, hard *h) {
  square_below(h);
  h->degree = 3;
  h->truth = 0.0;
  for (size_t i = 0; i <= 3; i++) h->points[i] = vec(rng_uniform(r, -0.5, 0.5), 0.2 * (double)i, 0.0);
}

/* The cusp of (s², s³ + gap …), turned to the square: its tip is nearest. */
static void cusp(rng *r, hard *h) {
  square_below(h);
  h->degree = 3;
  h->truth = rng_uniform(r, 0.05, 0.2);
  /* x = s³, y = s² + gap, s = 2t - 1: Bernstein of s² at degree 3: 1, -1/3, -1/3, 1; of s³: -1, 1, -1, 1 */
  const double x[4] = {-1.0, 1.0, -1.0, 1.0}, y[4] = {1.0, -1.0 / 3.0, -1.0 / 3.0, 1.0};
  for (size_t i = 0; i < 4; i++) h->points[i] = vec(0.4 * x[i], 0.3 * y[i] + h->truth, 0.0);
  shift_middle(r, h);
}

static void constant_curve(rng *r, hard *h) {
  h->degree = 5;
  const vec3 p = vec(rng_uniform(r, -1.0, 1.0), rng_uniform(r, -1.0, 1.0), 0.0);
  for (size_t i = 0; i <= 5; i++) h->points[i] = p;
  one_point(h, vec(p.x + 0.3, p.y + 0.4, 0.0));
  h->truth = vec_norm(vec_sub(h->vertex[0], p));
}

static void through_the_point(rng *r, hard *h) {
  h->degree = 4;
  for (size_t i = 0; i <= 4; i++) h->points[i] = vec(rng_uniform(r, -1.0, 1.0), rng_uniform(r, -1.0, 1.0), 0.0);
  h->points[2] = vec(-(h->points[0].x + 4.0 * h->points[1].x + 4.0 * h->points[3].x + h->points[4].x) / 6.0,
                     -(h->points[0].y + 4.0 * h->points[1].y + 4.0 * h->points[3].y + h->points[4].y) / 6.0, 0.0);
  one_point(h, vec(0.0, 0.0, 0.0)); /* psi(1/2) = 0 */
  h->truth = 0.0;
  shift_middle(r, h);
}

/* A quarter of a circle, as a cubic as near to it as a cubic can be, about its centre: the distance is nearly the same
 * everywhere; it is least where the cubic meets the circle, at its ends and its middle. */
static void about_the_centre(rng *r, hard *h) {
  h->degree = 3;
  const double size = rng_uniform(r, 0.5, 2.0), k = 4.0 / 3.0 * (sqrt(2.0) - 1.0);
  h->points[0] = vec(size, 0.0, 0.0);
  h->points[1] = vec(size, k * size, 0.0);
  h->points[2] = vec(k * size, size, 0.0);
  h->points[3] = vec(0.0, size, 0.0);
  one_point(h, vec(0.0, 0.0, 0.0));
  h->truth = size;
}

/* Small things far from the origin. */
static void far_away(rng *r, hard *h) {
  square_below(h);
  h->truth = 1e-6 * rng_uniform(r, 0.5, 2.0);
  graph_of_power(h, 2, 1e-6 * rng_uniform(r, 0.1, 1.0), h->truth);
  const vec3 away = vec(1e6, 1e6, 0.0);
  for (size_t i = 0; i <= h->degree; i++) h->points[i] = vec_add(vec(1e-6 * h->points[i].x, h->points[i].y, 0.0), away);
  for (size_t i = 0; i < h->n; i++) h->vertex[i] = vec_add(vec_scale(1e-6, h->vertex[i]), away);
  h->truth =
      h->points[1].y - h->vertex[2].y; /* the control polygon's own, as rounded; the apex is between its points */
  h->truth = 0.25 * (h->points[0].y + 2.0 * h->points[1].y + h->points[2].y) - h->vertex[2].y;
}

/* Two curves. */
static void same_twice(rng *r, hard *h) {
  h->degree = 5, h->planar = true;
  for (size_t i = 0; i <= 5; i++)
    h->points[i] = h->other[i] = vec(rng_uniform(r, -1.0, 1.0), rng_uniform(r, -1.0, 1.0), 0.0);
  h->truth = 0.0;
}

static void crossing(rng *r, hard *h) {
  h->degree = 3, h->planar = true;
  for (size_t i = 0; i <= 3; i++) {
    const double s = (double)i / 1.5 - 1.0;
    h->points[i] = vec(s, rng_uniform(r, -0.3, 0.3), 0.0);
    h->other[i] = vec(rng_uniform(r, -0.3, 0.3), s, 0.0);
  }
  h->truth = 0.0; /* one goes from left to right below and above the other's ends */
}

static void parallel_lines(rng *r, hard *h) {
  h->degree = 3, h->planar = true;
  h->truth = rng_uniform(r, 0.1, 0.5);
  for (size_t i = 0; i <= 3; i++) {
    h->points[i] = vec((double)i / 3.0, 0.0, 0.0);
    h->other[i] = vec((double)i / 3.0 + 0.1, h->truth, 0.0);
  }
}

static void nested_parabolas(rng *r, hard *h) {
  h->degree = 2, h->planar = true;
  h->truth = rng_uniform(r, 0.05, 0.2);
  const double c = rng_uniform(r, 0.02, 0.1);
  hard upper;
  graph_of_power(h, 2, c, 0.0);
  graph_of_power(&upper, 2, 2.0 * c, h->truth);
  for (size_t i = 0; i <= 2; i++) h->other[i] = upper.points[i];
  shift_middle(r, h);
}

/* The same curve by polynomials of the degree 45. */
static void order_45(rng *r, hard *h) {
  near_tangent(r, h);
  for (; h->degree < MAX_POINTS - 1; h->degree++) {
    const double n = (double)h->degree + 1.0;
    h->points[h->degree + 1] = h->points[h->degree];
    for (size_t i = h->degree; i > 0; i--)
      h->points[i] = vec_add(vec_scale((double)i / n, h->points[i - 1]), vec_scale(1.0 - (double)i / n, h->points[i]));
  }
}

/* Chebyshev's polynomial of the degree 16, which is as low at eight places; its control points are up to 5e4 times as
 * high. Its Bernstein coefficients are (-1)^(n - i) C(2n, 2i)/C(n, i). */
static void eight_minima(rng *r, hard *h) {
  square_below(h);
  h->degree = 16;
  h->truth = rng_uniform(r, 0.05, 0.2);
  const double c = rng_uniform(r, 0.01, 0.1), n = 16.0;
  double coefficient = 1.0;
  for (size_t i = 0; i <= h->degree; i++) {
    const double k = (double)i;
    h->points[i] = vec(1.8 * k / n - 0.9, c * ((i % 2 == 0 ? coefficient : -coefficient) + 1.0) + h->truth, 0.0);
    coefficient *= (2.0 * n - 2.0 * k - 1.0) / (2.0 * k + 1.0);
  }
}

const family FAMILIES[] = {{"parallel to a side", parallel_to_side}, {"near tangent at 1e-9", near_tangent},
                           {"eightfold contact", eightfold_contact}, {"touching", touching},
                           {"its end touches", end_touches},         {"cusp", cusp},
                           {"constant curve", constant_curve},       {"through the point", through_the_point},
                           {"about its centre", about_the_centre},   {"1e-6 m at 1e6 m", far_away},
                           {"the same curve twice", same_twice},     {"crossing curves", crossing},
                           {"parallel lines", parallel_lines},       {"nested parabolas", nested_parabolas},
                           {"near tangent of order 45", order_45},   {"eight minima of order 16", eight_minima}};

const size_t N_FAMILIES = sizeof FAMILIES / sizeof *FAMILIES;
