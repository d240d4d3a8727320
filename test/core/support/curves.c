/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/curves.h"

void random_points(rng *r, size_t n, vec3 *points) {
  const size_t kind = rng_index(r, 5);
  const double scale = rng_index(r, 2) ? 1.0 : rng_log_uniform(r, 1e-6, 1e6);
  const vec3 offset = vec_scale(rng_index(r, 4) ? 0.0 : scale * rng_log_uniform(r, 1.0, 1e6), rng_unit(r));
  for (size_t i = 0; i < n; i++) {
    vec3 p = rng_in_cube(r, scale);
    if (kind == 1) p = vec(rng_awkward(r, scale), rng_awkward(r, scale), rng_awkward(r, scale));
    if (kind == 2) p = vec_scale(i % 2 ? -1.0 : 1.0, p);
    if (kind == 3 && i > 0 && rng_index(r, 3) == 0) p = vec_sub(points[i - 1], offset);
    if (kind == 4) p = vec_scale(scale, vec((double)i / (double)n, i % 2 ? 1e-9 : 0.0, 1.0));
    points[i] = vec_add(p, offset);
  }
}

double random_parameter(rng *r) {
  switch (rng_index(r, 8)) {
    case 0: return (double)rng_index(r, 2);
    case 1: return rng_log_uniform(r, 1e-300, 1.0);
    case 2: return 1.0 - rng_log_uniform(r, 1e-16, 1.0);
    case 3: return ldexp(1.0, -(int)rng_index(r, 60));
    default: return rng_uniform(r, 0.0, 1.0);
  }
}

size_t random_degree(rng *r) {
  return 1 + rng_index(r, rng_index(r, 4) ? 8 : 60);
}

test_spline random_spline(rng *r, size_t degree) {
  test_spline s = {.degree = degree, .n_points = degree + 1 + rng_index(r, 13)};
  s.n_knots = s.n_points + degree + 1;
  random_points(r, s.n_points, s.points);

  /* knots: clamped or not, evenly or unevenly apart, repeated or not */
  const bool clamped = rng_index(r, 2);
  const size_t spacing = rng_index(r, 3), repeat = rng_index(r, 3);
  double t = rng_index(r, 2) ? 0.0 : rng_uniform(r, -100.0, 100.0);
  for (size_t i = 0; i < s.n_knots; i++) {
    const bool fixed = clamped && ((i > 0 && i <= degree) || i > s.n_points);
    const bool repeated = i != s.n_points && repeat > 0 && rng_index(r, 4) < repeat;
    if (!fixed && !repeated)
      t += spacing == 0 ? 0.25 : spacing == 1 ? rng_uniform(r, 0.0, 1.0) : rng_log_uniform(r, 1e-6, 10.0);
    s.knots[i] = t;
  }

  /* all of the domain, or a part that may end in the middle of spans or at knots */
  const double low = s.knots[degree], high = s.knots[s.n_points];
  s.t0 = low;
  s.t1 = high;
  if (rng_index(r, 2)) {
    const double a = rng_index(r, 2) ? rng_uniform(r, low, high) : s.knots[degree + rng_index(r, s.n_points - degree)];
    const double b =
        rng_index(r, 2) ? rng_uniform(r, low, high) : s.knots[degree + 1 + rng_index(r, s.n_points - degree)];
    if (a < b) s.t0 = a, s.t1 = b;
  }
  return s;
}
