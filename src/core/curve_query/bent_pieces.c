/* SPDX-License-Identifier: BSD-3-Clause */
/* The letters are those of doc/curve-bound.md. */
#include "curve_query/bent_pieces.h"

#include "base/rounding.h"

/* A piece over x in [-1/2, 1/2] is middle + x first + x² second, but for `rest`, and along a direction for
 * `rest_along`. */
typedef struct bent_piece {
  vec3 middle, first, second;
  double rest, rest_along;
} bent_piece;

static void halve(double *c, size_t n) {
  for (size_t i = 0; i < n; i++) c[i] = 0.5 * (c[i] + c[i + 1]);
}

/* The value at 1/2 of the polynomial of degree n with these n + 1 coefficients, and two derivatives. */
static void at_middle(double *c, size_t n, double value[3]) {
  double first = 0.0, second = 0.0;
  for (size_t left = n; left > 0; left--) {
    if (left == 2) second = (double)(n * (n - 1)) * (c[2] - 2.0 * c[1] + c[0]);
    if (left == 1) first = (double)n * (c[1] - c[0]);
    halve(c, left);
  }
  value[0] = c[0], value[1] = first, value[2] = second;
}

static bent_piece bend(const double *points, size_t n) {
  bent_piece b = {.rest = 0.0};
  double value[3][3], c[CPROX_MAX_DEGREE + 1];
  for (size_t k = 0; k < 3; k++) {
    for (size_t i = 0; i <= n; i++) c[i] = points[k * (n + 1) + i];
    at_middle(c, n, value[k]);
  }
  b.middle = vec(value[0][0], value[1][0], value[2][0]);
  b.first = vec(value[0][1], value[1][1], value[2][1]);
  b.second = vec_scale(0.5, vec(value[0][2], value[1][2], value[2][2]));
  return b;
}

static double third_difference(const double *c, size_t i) {
  return c[i + 3] - c[i] + 3.0 * (c[i + 1] - c[i + 2]);
}

/* The third derivative is at most n (n - 1) (n - 2) times the largest third difference; a sixth of it and an eighth. */
static void find_rest(const double *points, size_t n, vec3 along, bent_piece *b) {
  double most = 0.0, most_along = 0.0;
  for (size_t i = 0; i + 3 <= n; i++) {
    const vec3 d = vec(third_difference(points, i), third_difference(points + (n + 1), i),
                       third_difference(points + 2 * (n + 1), i));
    most = greater(vec_norm2(d), most), most_along = greater(fabs(vec_dot(d, along)), most_along);
  }
  const double factor = n < 3 ? 0.0 : ROUND_UP * (double)(n * (n - 1) * (n - 2)) / 48.0;
  b->rest = factor * sqrt(most), b->rest_along = factor * most_along;
}

/* The least of b y + c y² for |y| <= most. */
static double least_of_square(double b, double c, double most) {
  if (c > 0.0 && fabs(b) < 2.0 * c * most) return -b * b / (4.0 * c);
  return most * (c * most - fabs(b));
}

/* At least the least of b·x + x·(H x) over the square [-1/2, 1/2]², H = (h0, h1; h1, h2): along the axes of H. */
static double least_of_form(const double b[2], const double h[3]) {
  const double angle = 0.5 * atan2(2.0 * h[1], h[0] - h[2]), c = cos(angle), s = sin(angle);
  const double most = 0.5 * (fabs(c) + fabs(s)), twice = 2.0 * h[1] * c * s;
  return least_of_square(c * b[0] + s * b[1], c * c * h[0] + twice + s * s * h[2], most) +
         least_of_square(c * b[1] - s * b[0], s * s * h[0] - twice + c * c * h[2], most);
}

double bent_pieces_apart(const double *const points[2], const size_t degree[2], double magnitude) {
  bent_piece p = bend(points[0], degree[0]), q = bend(points[1], degree[1]);
  const vec3 apart = vec_sub(p.middle, q.middle);
  const double distance = vec_norm(apart);
  if (!(distance > 0.0)) return 0.0;
  const vec3 along = vec_scale(1.0 / distance, apart);
  find_rest(points[0], degree[0], along, &p);
  find_rest(points[1], degree[1], along, &q);

  /* the square of the distance of the two parabolas: what is of third order in x and y is bounded, what is of fourth
   * order is a square */
  const double b[2] = {2.0 * vec_dot(apart, p.first), -2.0 * vec_dot(apart, q.first)};
  const double h[3] = {2.0 * vec_dot(apart, p.second) + vec_norm2(p.first), -vec_dot(p.first, q.first),
                       vec_norm2(q.first) - 2.0 * vec_dot(apart, q.second)};
  const double cubic = 0.25 * (fabs(vec_dot(p.first, p.second)) + fabs(vec_dot(p.first, q.second)) +
                               fabs(vec_dot(q.first, p.second)) + fabs(vec_dot(q.first, q.second)));
  const double moved = 0.5 * (vec_norm(p.first) + vec_norm(q.first)) + 0.25 * (vec_norm(p.second) + vec_norm(q.second));
  const double sizes = (distance + moved) * (distance + moved);
  const double square = distance * distance + least_of_form(b, h) - cubic - 256.0 * ROUND_U * sizes;
  if (!(square > 0.0)) return 0.0;

  /* the rest counts along the parabolas' distance, which is nearly that of the middles */
  const double rest = p.rest + q.rest, turned = 2.0 * moved / distance;
  const double lost = lesser(rest, p.rest_along + q.rest_along + rest * turned);
  double steps = 0.0;
  for (int k = 0; k < 2; k++) {
    const double n = (double)degree[k] + 3.0;
    steps += n * n * n;
  }
  return sqrt(square) - ROUND_UP * lost - ROUND_U * steps * magnitude;
}
