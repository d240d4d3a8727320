/* SPDX-License-Identifier: BSD-3-Clause */
/* What control points tell of a piece: halves within the error they state, distances from a centre never above the true
 * ones. */
#include "base/rounding.h"
#include "curve/control.h"
#include "curve/curve.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/reference.h"

enum { MAX_DEGREE = 60, CASES = 100000 };

static size_t degree_random(rng *r) {
  return 1 + rng_index(r, rng_index(r, 10) ? 8 : MAX_DEGREE);
}

static void to_arrays(const vec3 *p, size_t degree, double *points) {
  for (size_t i = 0; i <= degree; i++) {
    points[i] = p[i].x;
    points[degree + 1 + i] = p[i].y;
    points[2 * (degree + 1) + i] = p[i].z;
  }
}

static vec3 at(const double *points, size_t degree, size_t i) {
  return vec(points[i], points[degree + 1 + i], points[2 * (degree + 1) + i]);
}

/* The largest distance between computed and exact control points of [s0, s1]. */
static long double section_error(const vec3 *p, size_t degree, double s0, double s1, const double *half) {
  vec3l exact[MAX_DEGREE + 1];
  ref_bezier_section(p, degree, s0, s1, exact);
  long double most = 0;
  for (size_t i = 0; i <= degree; i++) most = fmaxl(most, ref_error(exact[i], at(half, degree, i)));
  return most;
}

/* Seed 21, 1e5 cuts of degrees 1 to 60 at 0.5 and elsewhere, coordinates with awkward mantissas. The bound is T1 of
 * doc/rounding.md; long double itself is off by degree 2^-64 |P|, a 2048th of it. */
CASE(halves_are_within_the_error_that_the_cut_states) {
  rng r = rng_seed(21);
  long double worst = 0;
  for (size_t k = 0; k < test_cases(CASES); k++) {
    const size_t degree = degree_random(&r);
    const double scale = rng_log_uniform(&r, 1e-6, 1e6);
    vec3 p[MAX_DEGREE + 1];
    for (size_t i = 0; i <= degree; i++)
      p[i] = vec(rng_awkward(&r, scale), rng_awkward(&r, scale), rng_index(&r, 3) ? rng_awkward(&r, scale) : 0.0);
    double left[3 * (MAX_DEGREE + 1)], right[3 * (MAX_DEGREE + 1)];
    to_arrays(p, degree, right);
    const double s = rng_index(&r, 2) ? 0.5 : rng_uniform(&r, 0.0, 1.0), magnitude = control_magnitude(right, degree);
    const double bound = control_split(left, right, degree, s, magnitude) + 1e-300;
    const long double error = fmaxl(section_error(p, degree, 0.0, s, left), section_error(p, degree, s, 1.0, right));
    if (error > (long double)bound) fail_msg("degree %zu, s = %.17g: error %Lg, stated %g", degree, s, error, bound);
    worst = fmaxl(worst, error / (long double)bound);
    for (int c = 0; c < 3; c++) {
      const size_t row = (size_t)c * (degree + 1);
      assert_true(left[row + degree] == right[row]); /* the cover has no gap */
    }
  }
  print_message("largest error / stated error: %.2Lf\n", worst);
  assert_true(worst > 0.05L); /* the bound is not margin */
}

/* A short arc at nearly constant distance from the centre: there the Bernstein coefficients lie close to the truth, and
 * a bound that forgot its rounding would show. */
static void arc_random(rng *r, size_t degree, double scale, vec3 centre, const vec3 *axis, vec3 *p) {
  const vec3 out = rng_unit(r);
  const double reach = scale * rng_uniform(r, 0.5, 2.0), bend = scale * rng_log_uniform(r, 1e-12, 1e-4);
  for (size_t i = 0; i <= degree; i++) p[i] = vec_add(vec_axpy(centre, reach, out), rng_in_cube(r, bend));
  if (axis && rng_index(r, 2))
    for (size_t i = 0; i <= degree; i++) p[i] = vec_axpy(p[i], scale * rng_uniform(r, -100.0, 100.0), *axis);
}

/* Seed 22, 1e5 pieces of degrees 1 to 60, wide ones and arcs, with and without an axis; each at both ends, where the
 * bound may be attained, and at two points between. Tolerance 0: the slack is in the bound. */
CASE(distances_from_a_centre_are_never_overstated) {
  rng r = rng_seed(22);
  long double tightest = 1e30L;
  for (size_t k = 0; k < test_cases(CASES); k++) {
    const size_t degree = degree_random(&r);
    const double scale = rng_log_uniform(&r, 1e-6, 1e6);
    const vec3 centre = rng_in_cube(&r, scale), axis = rng_unit(&r);
    const vec3 *along = rng_index(&r, 2) ? &axis : NULL;
    vec3 p[MAX_DEGREE + 1];
    if (rng_index(&r, 3))
      arc_random(&r, degree, scale, centre, along, p);
    else
      for (size_t i = 0; i <= degree; i++) p[i] = rng_in_cube(&r, 2.0 * scale);
    double points[3 * (MAX_DEGREE + 1)];
    to_arrays(p, degree, points);
    double tables[2 * (MAX_DEGREE + 1)];
    curve_fill_tables(degree, tables);
    const double bound = control_distance_from(points, degree, tables, centre, along);
    for (int i = 0; i < 4; i++) {
      const double s = i == 0 ? 0.0 : i == 1 ? 1.0 : rng_uniform(&r, 0.0, 1.0);
      vec3l w = ref_sub(ref_bezier(p, degree, s, 0), ref_vec(centre));
      if (along)
        w = ref_sub(w, ref_scale(ref_dot(w, ref_vec(axis)) / ref_dot(ref_vec(axis), ref_vec(axis)), ref_vec(axis)));
      const long double d = ref_norm(w);
      if ((long double)bound > d) fail_msg("degree %zu: bound %.17g above %.17Lg at s = %g", degree, bound, d, s);
      if (d > 0) tightest = fminl(tightest, (d - bound) / d);
    }
  }
  assert_true(tightest < 1e-13L); /* some come within rounding of the truth */
}

/* Seed 23, 1e5 directions. A dot product of three terms is off by 3 u |n||P|. */
CASE(the_least_ordinate_is_that_of_the_lowest_control_point) {
  rng r = rng_seed(23);
  for (size_t k = 0; k < test_cases(CASES); k++) {
    const size_t degree = degree_random(&r);
    vec3 p[MAX_DEGREE + 1];
    for (size_t i = 0; i <= degree; i++) p[i] = rng_in_cube(&r, 1.0);
    double points[3 * (MAX_DEGREE + 1)];
    to_arrays(p, degree, points);
    const vec3 n = rng_unit(&r);
    double least = INFINITY;
    for (size_t i = 0; i <= degree; i++) least = fmin(least, vec_dot(n, p[i]));
    assert_true(fabs(control_least(points, degree, n) - least) <= 6.0 * ROUND_U * control_magnitude(points, degree));
    assert_true(fabs(control_magnitude(points, degree) - ref_largest(p, degree + 1)) <= 4.0 * ROUND_U * 2.0);
  }
}

int main(void) {
  return cases_run(NULL, NULL);
}
