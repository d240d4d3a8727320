/* SPDX-License-Identifier: BSD-3-Clause */
/* Clothoids, Dubins paths and involutes against their definitions in long double: every point of the compiled pieces is
 * within their error. Clothoids are integrated anew, by Gauss' rule with 16 nodes in steps of half a radian at most. */
#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"
#include "curve/compile.h"
#include "support/cases.h"
#include "support/curves.h"
#include "support/make_curve.h"
#include "support/quad.h"
#include "support/reference.h"

/* Long double's unit roundoff. */
#define UL (0.5L * LDBL_EPSILON)

#define PI 3.14159265358979323846264338327950288L

/* ---- the definitions ---- */

enum { NODES = 16 };

static long double node[NODES], weight[NODES];

/* Gauss' nodes on [0, 1]: the roots of the Legendre polynomial, by Newton's method. */
static int find_nodes(void **state) {
  (void)state;
  for (int i = 0; i < NODES; i++) {
    long double x = cosl(PI * ((long double)i + 0.75L) / (NODES + 0.5L)), slope = 1.0L;
    for (int step = 0; step < 30; step++) {
      long double before = 1.0L, p = x;
      for (int k = 2; k <= NODES; k++) {
        const long double next = ((2 * k - 1) * x * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = NODES * (x * p - before) / (x * x - 1.0L);
      x -= p / slope;
    }
    node[i] = 0.5L * (1.0L - x);
    weight[i] = 1.0L / ((1.0L - x * x) * slope * slope);
  }
  return 0;
}

/* A point that goes along a curve of heading h + k (t - origin) + r (t - origin)²/2. */
typedef struct walker {
  long double origin, heading, curvature, rate, at, x, y;
} walker;

static long double heading_of(const walker *w, long double t) {
  const long double along = t - w->origin;
  return w->heading + (w->curvature + 0.5L * w->rate * along) * along;
}

static void walk(walker *w, long double to) {
  const long double ends = fabsl(w->curvature + w->rate * (w->at - w->origin)) +
                           fabsl(w->curvature + w->rate * (to - w->origin)) + sqrtl(fabsl(w->rate));
  const long double from = w->at, steps = ceill(2.0L * ends * fabsl(to - from)) + 1.0L, h = (to - from) / steps;
  for (long double i = 0; i < steps; i++) {
    for (int k = 0; k < NODES; k++) {
      const long double heading = heading_of(w, from + (i + node[k]) * h);
      w->x += weight[k] * h * cosl(heading);
      w->y += weight[k] * h * sinl(heading);
    }
  }
  w->at = to;
}

/* ---- what is checked ---- */

/* The largest errors over the bound, in the middle of pieces and at their ends. */
typedef struct worst {
  double inside, at_ends;
  size_t points;
} worst;

static void compare(const cprox_curve *c, size_t piece, double t, quad3 should, double reference, worst *w) {
  const double error = quad_distance(should, quad_piece(c, piece, t)), bound = c->error[piece];
  if (!(error <= bound + reference))
    fail_msg("t = %.17g of [%.17g, %.17g]: off by %g, the bound is %g, the reference's own %g", t, c->breaks[0],
             c->breaks[c->n_pieces], error, bound, reference);
  w->points++;
  if (reference > 0.05 * bound) return;
  double *which = t == c->breaks[piece] ? &w->at_ends : &w->inside;
  *which = fmax(*which, error / bound);
}

enum { POINTS = 40 };

static int by_size(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* Parameters in ascending order; every other one is the middle of a piece. */
static void parameters(const cprox_curve *c, rng *r, double *t) {
  for (int k = 0; k < POINTS; k++) {
    const size_t piece = rng_index(r, c->n_pieces);
    t[k] = k % 2 ? quad_parameter(c, r) : 0.5 * c->breaks[piece] + 0.5 * c->breaks[piece + 1];
  }
  qsort(t, POINTS, sizeof *t, by_size);
}

static quad3 placed(vec3 start, long double x, long double y) {
  return (quad3){{(quad)start.x + (quad)x, (quad)start.y + (quad)y, (quad)start.z}};
}

static vec3 random_start(rng *r, double scale) {
  switch (rng_index(r, 3)) {
    case 0: return vec(0, 0, 0);
    case 1: return rng_in_cube(r, scale);
    default: return rng_in_cube(r, 1e6);
  }
}

static double signed_uniform(rng *r, double low, double high) {
  return (rng_index(r, 2) ? 1.0 : -1.0) * rng_log_uniform(r, low, high);
}

/* seed 601, 2500 clothoids, 40 points each. What long double loses: 30 roundings of the length and those of the
 * heading. */
CASE(clothoids_are_within_their_error) {
  rng r = rng_seed(601);
  worst w = {0};
  size_t pieces = 0;
  for (size_t i = test_cases(2500); i-- > 0;) {
    const double scale = rng_log_uniform(&r, 1e-6, 1e6);
    const vec3 start = random_start(&r, scale);
    const double heading = rng_uniform(&r, -10.0, 10.0);
    const double curvature = rng_index(&r, 4) ? signed_uniform(&r, 1e-3, 20.0) / scale : 0.0;
    const double rate = rng_index(&r, 4) ? signed_uniform(&r, 1e-3, 20.0) / (scale * scale) : 0.0;
    const double t0 = rng_index(&r, 3) ? scale * rng_uniform(&r, -2.0, 1.0) : 0.0;
    const double t1 = t0 + scale * rng_log_uniform(&r, 1e-4, 2.0);
    cprox_curve *c = NULL;
    assert_int_equal(curve_from(describe_clothoid(start, heading, curvature, rate, t0, t1), NULL, &c), CPROX_OK);
    pieces += c->n_pieces;

    double t[POINTS];
    parameters(c, &r, t);
    walker walking = {.heading = heading, .curvature = curvature, .rate = rate};
    const double turned = fabs(heading) + 4.0 * scale * (fabs(curvature) + 4.0 * fabs(rate) * scale);
    const double reference = (double)UL * 4.0 * scale * (30.0 + 4.0 * turned);
    for (int k = 0; k < POINTS; k++) {
      walk(&walking, t[k]);
      compare(c, quad_piece_at(c, t[k]), t[k], placed(start, walking.x, walking.y), reference, &w);
    }
    cprox_curve_free(c);
  }
  print_message("clothoids: %zu points, %zu pieces, largest error %.2f of its bound, %.2f at ends of pieces\n",
                w.points, pieces, w.inside, w.at_ends);
  assert_true(w.inside > 0.5 && w.at_ends > 0.01);
}

/* seed 602, 2500 involutes, 40 points each. */
CASE(involutes_are_within_their_error) {
  rng r = rng_seed(602);
  worst w = {0};
  for (size_t i = test_cases(2500); i-- > 0;) {
    const double radius = rng_log_uniform(&r, 1e-6, 1e6), turned = rng_uniform(&r, -10.0, 10.0);
    const vec3 centre = random_start(&r, radius);
    const double t0 = rng_index(&r, 3) ? rng_uniform(&r, -30.0, 30.0) : 0.0;
    const double t1 = t0 + rng_log_uniform(&r, 1e-4, 20.0);
    cprox_curve *c = NULL;
    assert_int_equal(curve_from(describe_involute(centre, radius, turned, t0, t1), NULL, &c), CPROX_OK);
    double t[POINTS];
    parameters(c, &r, t);
    for (int k = 0; k < POINTS; k++) {
      const long double along = t[k], at = turned + along, x = cosl(at) + along * sinl(at),
                        y = sinl(at) - along * cosl(at);
      const double reference = (double)UL * radius * (10.0 + 4.0 * fabs(t[k])) * (4.0 + fabs(t[k]) + fabs(turned));
      compare(c, quad_piece_at(c, t[k]), t[k], placed(centre, radius * x, radius * y), reference, &w);
    }
    cprox_curve_free(c);
  }
  print_message("involutes: %zu points, largest error %.2f of its bound, %.2f at ends of pieces\n", w.points, w.inside,
                w.at_ends);
  assert_true(w.inside > 0.5 && w.at_ends > 0.01);
}

/* ---- Dubins paths ---- */

typedef struct poses {
  vec3 start, end;
  double heading[2], radius;
} poses;

/* Near, far, on the same circle, in line: where words change and formulas lose their digits. */
static poses random_poses(rng *r) {
  poses p = {.radius = rng_log_uniform(r, 1e-6, 1e6)};
  p.start = random_start(r, p.radius);
  p.heading[0] = rng_uniform(r, -7.0, 7.0);
  p.heading[1] = rng_index(r, 4) ? rng_uniform(r, -7.0, 7.0) : p.heading[0];
  const double distance = p.radius * (rng_index(r, 2) ? rng_uniform(r, 0.0, 5.0) : rng_log_uniform(r, 1e-3, 1e3));
  const double towards = rng_index(r, 3) ? rng_uniform(r, -3.2, 3.2) : p.heading[0];
  p.end = vec(p.start.x + distance * cos(towards), p.start.y + distance * sin(towards), p.start.z);
  if (rng_index(r, 6) == 0) {
    /* along the circle to the left of the start */
    const double turned = rng_uniform(r, 0.0, 6.0), half = 0.5 * turned;
    const double chord = 2.0 * p.radius * sin(half), along = p.heading[0] + half;
    p.end = vec(p.start.x + chord * cos(along), p.start.y + chord * sin(along), p.start.z);
    p.heading[1] = p.heading[0] + turned;
  }
  return p;
}

static int turn_of(cprox_dubins_word word, int part) {
  static const char *const words[] = {"", "LSL", "LSR", "RSL", "RSR", "RLR", "LRL"};
  const char c = words[word][part];
  return c == 'L' ? 1 : c == 'R' ? -1 : 0;
}

/* Where the walker is on the part that holds t; it goes from part to part. */
typedef struct dubins_walker {
  walker w;
  int part;
} dubins_walker;

static void walk_path(dubins_walker *d, const cprox_dubins_path *path, double radius, double t) {
  for (;;) {
    d->w.curvature = turn_of(path->word, d->part) / (long double)radius;
    const double end = path->ends[d->part];
    walk(&d->w, t < end || d->part == 2 ? t : end);
    if (t < end || d->part == 2) return;
    d->w.heading = heading_of(&d->w, end);
    d->w.origin = end;
    d->part++;
  }
}

/* seed 603, 3200 pairs of poses, one word each, 40 points. The end: two turns that may be left out, and 40 roundings of
 * the path and of the coordinates; its heading besides: two roundings of a joint's arc length. */
CASE(dubins_paths_are_within_their_error_and_reach_their_end) {
  rng r = rng_seed(603);
  worst w = {0};
  double largest_gap = 0.0;
  size_t of_word[7] = {0}, missing = 0;
  for (size_t i = test_cases(3200); i-- > 0;) {
    const poses p = random_poses(&r);
    const cprox_dubins_word word = (cprox_dubins_word)rng_index(&r, 7);
    cprox_curve *c = NULL;
    const cprox_status status =
        curve_from(describe_dubins(p.start, p.heading[0], p.end, p.heading[1], p.radius, word), NULL, &c);
    if (status != CPROX_OK) {
      missing++;
      continue;
    }
    const cprox_dubins_path path = cprox_curve_get_info(c).dubins;
    of_word[path.word]++;
    assert_true(c->breaks[0] == 0.0 && c->breaks[c->n_pieces] == path.ends[2]);

    double t[POINTS];
    parameters(c, &r, t);
    t[POINTS - 1] = path.ends[2];
    dubins_walker d = {.w = {.heading = p.heading[0]}};
    const double turned = 30.0 + path.ends[2] / p.radius, reference = (double)UL * 10.0 * path.ends[2] * turned;
    for (int k = 0; k < POINTS; k++) {
      walk_path(&d, &path, p.radius, t[k]);
      compare(c, quad_piece_at(c, t[k]), t[k], placed(p.start, d.w.x, d.w.y), reference, &w);
    }
    const double gap = quad_distance(placed(p.start, d.w.x, d.w.y), placed(p.end, 0, 0));
    const double turning = (double)remainderl(heading_of(&d.w, path.ends[2]) - (long double)p.heading[1], 2.0L * PI);
    const double left_out = 2e-15 * (8.0 + fabs(p.heading[0]) + fabs(p.heading[1]));
    const double allowed = left_out * (path.ends[2] + p.radius) +
                           40.0 * ROUND_U * (path.ends[2] + p.radius + vec_norm(p.start) + vec_norm(p.end));
    if (gap > allowed || fabs(turning) > left_out + 1e-14 + 4.0 * ROUND_U * path.ends[2] / p.radius)
      fail_msg("word %d, %.17g from the end, %g allowed; the heading is off by %g", path.word, gap, allowed, turning);
    largest_gap = fmax(largest_gap, gap / allowed);
    cprox_curve_free(c);
  }
  print_message(
      "Dubins: %zu points, largest error %.2f of its bound, %.2f at ends of pieces; largest gap at the end %.2f of "
      "what is allowed; %zu words without a path\n",
      w.points, w.inside, w.at_ends, largest_gap, missing);
  assert_true(w.inside > 0.5 && w.at_ends > 0.005);
  for (int k = 1; k <= 6; k++) assert_true(of_word[k] > 0);
}

/* The shortest is as short as each of the six, and a straight line or an arc stays one: no turn is made of rounding. */
CASE(the_shortest_word_is_the_shortest) {
  rng r = rng_seed(604);
  for (size_t i = test_cases(500); i-- > 0;) {
    const poses p = random_poses(&r);
    double least = INFINITY, shortest = 0.0;
    for (int word = 6; word >= 0; word--) {
      cprox_curve *c = NULL;
      if (curve_from(describe_dubins(p.start, p.heading[0], p.end, p.heading[1], p.radius, (cprox_dubins_word)word),
                     NULL, &c) != CPROX_OK)
        continue;
      const cprox_dubins_path path = cprox_curve_get_info(c).dubins;
      if (word == 0)
        shortest = path.ends[2];
      else
        least = fmin(least, path.ends[2]);
      cprox_curve_free(c);
    }
    assert_true(fabs(shortest - least) <= 4.0 * ROUND_U * least);
  }
  for (int k = 0; k < 200; k++) {
    const double heading = rng_uniform(&r, -7.0, 7.0), turned = rng_uniform(&r, 0.01, 3.0), half = 0.5 * turned;
    const double side = k % 2 ? 1.0 : -1.0, chord = 2.0 * sin(half), along = heading + side * half;
    cprox_curve *c = NULL;
    /* an arc of radius 1, then a line of length 3 */
    assert_int_equal(curve_from(describe_dubins(vec(0, 0, 0), heading, vec(chord * cos(along), chord * sin(along), 0),
                                                heading + side * turned, 1.0, CPROX_DUBINS_SHORTEST),
                                NULL, &c),
                     CPROX_OK);
    assert_true(fabs(cprox_curve_get_info(c).dubins.ends[2] - turned) < 1e-13);
    cprox_curve_free(c);
    assert_int_equal(curve_from(describe_dubins(vec(5, 0, 0), heading, vec(5 + 3 * cos(heading), 3 * sin(heading), 0),
                                                heading, 1.0, CPROX_DUBINS_SHORTEST),
                                NULL, &c),
                     CPROX_OK);
    assert_true(fabs(cprox_curve_get_info(c).dubins.ends[2] - 3.0) < 1e-13);
    cprox_curve_free(c);
  }
}

/* ---- bad input ---- */

static void refused(cprox_status status, cprox_workspace *workspace, const char *reason) {
  assert_int_equal(status, CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(workspace), reason);
}

CASE(bad_clothoids_and_involutes_are_refused) {
  cprox_workspace *ws = cprox_workspace_create();
  cprox_curve *c = NULL;
  const vec3 o = {0, 0, 0};
  refused(curve_from(describe_clothoid(vec(NAN, 0, 0), 0, 0, 0, 0, 1), ws, &c), ws,
          "start point 0 is (nan, 0, 0), not finite");
  refused(curve_from(describe_clothoid(o, NAN, 0, 0, 0, 1), ws, &c), ws,
          "heading nan, curvature 0 and its rate 0 are not all finite");
  refused(curve_from(describe_clothoid(o, 0, 0, 0, 1, 1), ws, &c), ws, "t0 = 1 is not below t1 = 1");
  refused(curve_from(describe_clothoid(o, 0, 1, 0, 0, 1e13), ws, &c), ws,
          "the clothoid turns by up to 1e+13 rad, more than 1e+12");
  refused(curve_from(describe_clothoid(o, 0, 1, 0, 1e9, 1e9 + 1), ws, &c), ws,
          "the clothoid turns too often between t = 0 and 1000000000");
  /* so far away that one piece may hold a million turns, and many pieces are needed */
  refused(curve_from(describe_clothoid(vec(1e30, 0, 0), 0, 1e11, 0, 0, 1), ws, &c), ws,
          "the clothoid turns too often between t = 0 and 1");
  refused(curve_from(describe_clothoid(o, 0, 0, 0, 0, 1), ws, NULL), ws, "the pointer for the new curve is NULL");
  assert_int_equal(curve_from(describe_clothoid(o, 0, 1, 0, 0, 1e8), ws, &c), CPROX_INVALID);
  assert_non_null(strstr(cprox_workspace_error(ws), "would need more than 65536 pieces"));
  refused(curve_from(describe_involute(o, 0, 0, 0, 1), ws, &c), ws,
          "the radius is 0; an involute's is above 0 and at most 1e+75 m");
  refused(curve_from(describe_involute(o, NAN, 0, 0, 1), ws, &c), ws,
          "the radius is nan; an involute's is above 0 and at most 1e+75 m");
  refused(curve_from(describe_involute(o, 1, INFINITY, 0, 1), ws, &c), ws, "the angle is inf, not finite");
  refused(curve_from(describe_involute(vec(0, INFINITY, 0), 1, 0, 0, 1), ws, &c), ws,
          "centre 0 is (0, inf, 0), not finite");
  assert_null(c);
  cprox_workspace_free(ws);
}

/* No constructor leads there: what is without length is refused before. */
CASE(a_curve_without_pieces_is_not_made) {
  cprox_workspace *ws = cprox_workspace_create();
  compile none = {.workspace = ws};
  cprox_curve *c = NULL;
  refused(compile_finish(&none, &c), ws, "the curve has no pieces");
  assert_null(c);
  cprox_workspace_free(ws);
}

CASE(bad_dubins_paths_are_refused) {
  cprox_workspace *ws = cprox_workspace_create();
  cprox_curve *c = NULL;
  const vec3 o = {0, 0, 0}, e = {1, 0, 0};
  const cprox_dubins_word any = CPROX_DUBINS_SHORTEST;
  refused(curve_from(describe_dubins(o, 0, e, 0, 0, any), ws, &c), ws,
          "the turning radius is 0; it must be above 0 and finite");
  refused(curve_from(describe_dubins(o, 0, e, 0, -1, any), ws, &c), ws,
          "the turning radius is -1; it must be above 0 and finite");
  refused(curve_from(describe_dubins(o, 0, e, 0, NAN, any), ws, &c), ws,
          "the turning radius is nan; it must be above 0 and finite");
  refused(curve_from(describe_dubins(o, NAN, e, 0, 1, any), ws, &c), ws,
          "a heading, nan or 0, is not finite or beyond 1e+06 rad");
  refused(curve_from(describe_dubins(o, 0, vec(1, NAN, 0), 0, 1, any), ws, &c), ws,
          "end point 0 is (1, nan, 0), not finite");
  refused(curve_from(describe_dubins(o, 0, vec(1, 0, 2), 0, 1, any), ws, &c), ws,
          "the path starts at z = 0 and ends at z = 2; it is planar");
  refused(curve_from(describe_dubins(o, 0, o, 0, 1, any), ws, &c), ws,
          "start and end pose are the same: the path has no length");
  refused(curve_from(describe_dubins(o, 0, e, 0, 1e-13, any), ws, &c), ws,
          "the poses are 1 m apart, more than 1e+12 turning radii of 1e-13 m");
  refused(curve_from(describe_dubins(o, 0, vec(9, 0, 0), 0, 1, CPROX_DUBINS_LRL), ws, &c), ws,
          "the poses are too far apart for a path of this word");
  refused(curve_from(describe_dubins(o, 0, vec(0, 0.5, 0), 0, 1, CPROX_DUBINS_LSR), ws, &c), ws,
          "the poses are too near each other for a path of this word");
  refused(curve_from(describe_dubins(o, 0, e, 0, 1, (cprox_dubins_word)7), ws, &c), ws,
          "7 is no word of a Dubins path");
  assert_null(c);
  cprox_workspace_free(ws);
}

int main(void) {
  return cases_run(find_nodes, NULL);
}
