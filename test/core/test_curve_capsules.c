/* SPDX-License-Identifier: BSD-3-Clause */
/* The tree of chord capsules: every capsule contains the part of the curve that it stands for. The points come from the
 * spline's own definition in long double, not from the pieces. */
#include <stdlib.h>

#include "curve/pack.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/reference.h"

/* The pieces [first, end) below a node of the heap. */
static void pieces_below(const cprox_curve *c, size_t node, size_t *first, size_t *end) {
  size_t low = node, high = node + 1;
  while (low < c->n_leaves) low *= 2, high *= 2;
  *first = low - c->n_leaves;
  *end = high - c->n_leaves < c->n_pieces ? high - c->n_leaves : c->n_pieces;
}

static bool contains(const curve_capsule *capsule, vec3l p, long double slack) {
  return ref_point_segment(p, ref_vec(capsule->a), ref_vec(capsule->b)) <= (long double)capsule->radius + slack;
}

/* Holds the capsules of every level above a piece against its control points and its error, which is all that can be
 * asked of them, and against the points of the exact curve where there is a spline. */
static void check_tree(const cprox_curve *c, const test_spline *s) {
  const size_t n = c->degree;
  for (size_t node = 1; node < 2 * c->n_leaves; node++) {
    size_t first, end;
    pieces_below(c, node, &first, &end);
    const curve_capsule capsule = curve_capsule_at(c, node);
    if (first >= end) {
      assert_true(capsule.radius < 0.0);
      continue;
    }
    assert_true(capsule.radius >= 0.0);
    assert_true(vec_equal(capsule.a, curve_piece(c, first)[0]));
    assert_true(vec_equal(capsule.b, curve_piece(c, end - 1)[n]));
    for (size_t i = first; i < end; i++) {
      for (size_t k = 0; k <= n; k++)
        assert_true(contains(&capsule, ref_vec(curve_piece(c, i)[k]), -(long double)c->error[i]));
      if (!s) continue;
      size_t r = s->degree;
      while (!(s->knots[r] <= c->breaks[i] && c->breaks[i + 1] <= s->knots[r + 1])) r++;
      const long double slack = 8.0L * (long double)n * 0x1p-64L * ref_largest(s->points + (r - n), n + 1);
      for (int k = 0; k <= 4; k++) {
        const double t = fmin(c->breaks[i] + 0.25 * k * (c->breaks[i + 1] - c->breaks[i]), c->breaks[i + 1]);
        assert_true(contains(&capsule, ref_bspline(s->points, n, s->knots, r, t, 0), slack));
      }
    }
  }
}

/* seed 301, 4000 splines of up to 13 spans, each point against all levels above it: more than 1e5 checks */
CASE(every_capsule_contains_its_part_of_the_curve) {
  rng r = rng_seed(301);
  for (size_t i = test_cases(4000); i-- > 0;) {
    const test_spline s = random_spline(&r, 1 + rng_index(&r, rng_index(&r, 8) ? 8 : 60));
    cprox_curve *c = NULL;
    assert_int_equal(
        curve_from(describe_bspline(s.points, s.n_points, s.degree, s.knots, s.n_knots, s.t0, s.t1), NULL, &c),
        CPROX_OK);
    check_tree(c, &s);

    /* the box of the whole curve likewise; t1 belongs to the span before it */
    vec3 low, high;
    low = cprox_curve_get_info(c).lowest, high = cprox_curve_get_info(c).highest;
    for (size_t k = 0; k <= 20; k++) {
      const double t = fmin(s.t0 + (double)k / 20.0 * (s.t1 - s.t0), s.t1);
      size_t span = s.degree;
      while (s.knots[span + 1] < s.t1 && s.knots[span + 1] <= t) span++;
      const vec3l p = ref_bspline(s.points, s.degree, s.knots, span, t, 0);
      const long double slack = 8.0L * (long double)s.degree * 0x1p-64L * ref_largest(s.points, s.n_points);
      assert_true(low.x - slack <= p.x && low.y - slack <= p.y && low.z - slack <= p.z);
      assert_true(high.x + slack >= p.x && high.y + slack >= p.y && high.z + slack >= p.z);
    }
    cprox_curve_free(c);
  }
}

/* Eight capsules at once reach no farther back along n than any control point below them (long double), and by no more
 * than their radii give away: a capsule's own ends are attained. 9 u of the sizes: 3 u a product, 2 u the sums, u a
 * difference. */
static void check_packs(const cprox_curve *c, rng *r) {
  const vec3 n = rng_unit(r), from = rng_in_cube(r, 2.0);
  for (size_t begin = 1, count = 0; begin < 2 * c->n_leaves; begin += count) {
    count = 1;
    if (curve_is_empty_at(c, begin)) continue;
    while (count < CURVE_PACK && ((begin + count) & (begin + count - 1)) && !curve_is_empty_at(c, begin + count))
      count++;
    double least[CURVE_PACK], distance[CURVE_PACK], s[CURVE_PACK];
    curve_pack pack;
    curve_pack_fill(c, begin, count, &pack);
    curve_pack_distance(&pack, from, n, distance, s);
    curve_pack_reach(&pack, n, from, least);
    for (size_t lane = 0; lane < count; lane++) {
      const size_t node = begin + lane;
      size_t first, end;
      pieces_below(c, node, &first, &end);
      assert_true(first < end);
      long double exact = INFINITY;
      for (size_t i = first * (c->degree + 1); i < end * (c->degree + 1); i++) {
        const vec3l p = ref_sub(ref_vec(c->points[i]), ref_vec(from));
        exact = fminl(exact, ref_dot(ref_vec(n), p));
      }
      const long double slack = 9.0L * 0x1p-53L * (long double)(c->largest + vec_norm(from));
      const long double radius = (long double)pack.radius[lane];
      assert_true((long double)least[lane] <= exact + slack);
      assert_true((long double)least[lane] >= exact - 2.0L * radius - slack);

      /* the distance from a point; 64 u of the sizes, doc/curve-bound.md */
      const curve_capsule capsule = curve_capsule_at(c, node);
      const vec3l point = ref_add(ref_vec(from), ref_vec(n));
      const long double d = ref_point_segment(point, ref_vec(capsule.a), ref_vec(capsule.b));
      const long double room = 64.0L * 0x1p-53L * (long double)(c->largest + vec_norm(from) + 1.0);
      assert_true((long double)distance[lane] <= d + room && (long double)distance[lane] >= d - room);
      assert_true(s[lane] >= 0.0 && s[lane] <= 1.0);
    }
  }
}

/* seed 304, 2000 splines of up to 13 spans, some 1e5 capsules */
CASE(packs_reach_no_farther_than_what_they_contain) {
  rng r = rng_seed(304);
  for (size_t i = test_cases(2000); i-- > 0;) {
    const test_spline s = random_spline(&r, 1 + rng_index(&r, 8));
    cprox_curve *c = NULL;
    assert_int_equal(
        curve_from(describe_bspline(s.points, s.n_points, s.degree, s.knots, s.n_knots, s.t0, s.t1), NULL, &c),
        CPROX_OK);
    check_packs(c, &r);
    cprox_curve_free(c);
  }
}

/* seed 302: ends that coincide or nearly do; the chord says nothing, the radius must say it all */
CASE(closed_curves_are_contained) {
  rng r = rng_seed(302);
  for (size_t i = test_cases(4000); i-- > 0;) {
    const size_t degree = 2 + rng_index(&r, 10);
    vec3 p[61];
    random_points(&r, degree + 1, p);
    p[degree] = p[0];
    if (rng_index(&r, 2)) p[degree].x = nextafter(p[0].x, INFINITY);
    if (rng_index(&r, 4) == 0) p[degree].y += rng_log_uniform(&r, 1e-300, 1e-10);
    cprox_curve *c = NULL;
    assert_int_equal(curve_from(describe_bezier(p, degree + 1, 0.0, 1.0), NULL, &c), CPROX_OK);
    check_tree(c, NULL);
    cprox_curve_free(c);
  }
}

/* Curves that stand still, run to and fro on a line, or have sizes at the ends of the range. */
CASE(degenerate_curves_are_contained) {
  for (int exponent = -1020; exponent <= 495; exponent++) {
    const double size = ldexp(1.0, exponent);
    const vec3 curves[4][4] = {{{size, 0, 0}, {size, 0, 0}, {size, 0, 0}, {size, 0, 0}},
                               {{0, 0, 0}, {3 * size, 0, 0}, {-2 * size, 0, 0}, {size, 0, 0}},
                               {{0, 0, 0}, {0, size, 0}, {0, 0, size}, {0, 0, 0}},
                               {{-size, size, 0}, {1, 1, 1}, {0, 0, size}, {size, size, size}}};
    for (size_t k = 0; k < 4; k++) {
      cprox_curve *c = NULL;
      assert_int_equal(curve_from(describe_bezier(curves[k], 4, 0.0, 1.0), NULL, &c), CPROX_OK);
      check_tree(c, NULL);
      assert_true(isfinite(curve_capsule_at(c, 1).radius));
      cprox_curve_free(c);
    }
  }
}

/* A capsule that is far too wide would be as true and useless. A straight spline's radius is rounding alone; for a
 * half circle of 64 pieces the root is at most twice its height over the chord. */
CASE(capsules_are_no_wider_than_they_need_be) {
  vec3 straight[67], arc[67];
  double knots[71];
  for (size_t i = 0; i < 67; i++) {
    const double angle = 3.141592653589793 * ((double)i - 1.0) / 64.0;
    straight[i] = vec(1e6 + (double)i, 2e6 + 2.0 * (double)i, 0.0);
    arc[i] = vec(cos(angle), sin(angle), 0.0);
  }
  for (size_t i = 0; i < 71; i++) knots[i] = (double)i;
  cprox_curve *c = NULL;
  assert_int_equal(curve_from(describe_bspline(straight, 67, 3, knots, 71, 3.0, 67.0), NULL, &c), CPROX_OK);
  assert_true(curve_capsule_at(c, 1).radius < 2e-8); /* six levels of 2^-53 · 2e6, and 1e-9 of the leaf's */
  cprox_curve_free(c);
  assert_int_equal(curve_from(describe_bspline(arc, 67, 3, knots, 71, 3.0, 67.0), NULL, &c), CPROX_OK);
  assert_true(curve_capsule_at(c, 1).radius >= 0.99 && curve_capsule_at(c, 1).radius < 2.0);
  assert_true(curve_capsule_at(c, 64).radius < 1e-3);
  cprox_curve_free(c);
}

int main(void) {
  return cases_run(NULL, NULL);
}
