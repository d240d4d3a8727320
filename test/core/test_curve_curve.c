/* SPDX-License-Identifier: BSD-3-Clause */
/* Curve against curve: reference answers, bounds against long double, the pairs on which other methods do not end. */
#include "base/rounding.h"
#include "curve/control.h"
#include "curve/curve.h"
#include "curve/packets.h"
#include "curve_proximity/cprox.h"
#include "curve_query/bent_pieces.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/csv.h"
#include "support/make_curve.h"
#include "support/of_list.h"
#include "support/random.h"
#include "support/reference.h"

enum { MAX_POINTS = 64, MAX_DEGREE = 12, MAX_OPEN = 64, STEPS = 20, INTERVALS = 120000 };

/* ---- references ---- */

static void check_case(const char *id, const cprox_curve *a, const cprox_curve *b, double reference) {
  /* epsilon 1e-9: the coordinates are those of the unit cube; the reference is a long double rounded to 17 digits */
  const double epsilon = 1e-9, doubt = 4.0 * ROUND_U * reference + (reference < 1e-15 ? 1e-16 : 0.0);
  const cprox_options options = accurate(epsilon);
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_point_along(a), cprox_obstacle_curve(b, 0.0), &options, ws, &r), CPROX_OK);
  if (r.lower > reference + doubt || r.upper < reference - doubt || r.upper - r.lower > epsilon)
    fail_msg("%s: [%.17g, %.17g] against %.17g", id, r.lower, r.upper, reference);

  /* the witness points are those of the parameters, and as far apart as upper says */
  vec3 p, q;
  assert_int_equal(cprox_curve_evaluate(a, r.t, ws, &p, NULL, NULL), CPROX_OK);
  assert_int_equal(cprox_curve_evaluate(b, r.t_obstacle, ws, &q, NULL, NULL), CPROX_OK);
  assert_true(vec_norm(vec_sub(p, r.witness_mover)) < 1e-12 && vec_norm(vec_sub(q, r.witness_obstacle)) < 1e-12);
  assert_true(fabs(vec_norm(vec_sub(r.witness_mover, r.witness_obstacle)) - r.upper) < 1e-12);

  /* the other way round, with tubes, and the verdicts */
  cprox_result other;
  assert_int_equal(cprox_distance(cprox_point_along(b), cprox_obstacle_curve(a, 0.0), &options, ws, &other), CPROX_OK);
  assert_true(other.lower <= r.upper && r.lower <= other.upper);
  if (reference < 1e-6) {
    assert_true(cprox_collision(cprox_point_along(a), cprox_obstacle_curve(b, 0.0), &options, ws, &other) >= 0);
    assert_true(other.verdict != CPROX_VERDICT_CLEAR || other.lower <= reference);
    assert_int_equal(cprox_collision(cprox_tube_along(a, 1e-3), cprox_obstacle_curve(b, 1e-3), &options, ws, &other),
                     CPROX_OK);
    assert_int_equal(other.verdict, CPROX_VERDICT_VIOLATED);
    return;
  }
  const double radius = 0.25 * reference;
  assert_int_equal(cprox_distance(cprox_tube_along(a, radius), cprox_obstacle_curve(b, radius), &options, ws, &other),
                   CPROX_OK);
  assert_true(other.lower <= 0.5 * reference + doubt && other.upper >= 0.5 * reference - doubt);
  assert_int_equal(cprox_collision(cprox_point_along(a), cprox_obstacle_curve(b, 0.0), &options, ws, &other), CPROX_OK);
  assert_int_equal(other.verdict, CPROX_VERDICT_CLEAR);
  const double factors[] = {0.5, 0.99, 1.01, 1.5};
  for (int k = 0; k < 4; k++) {
    const cprox_mover mover = cprox_point_along(a);
    assert_int_equal(cprox_tolerance(mover, cprox_obstacle_curve(b, 0.0), factors[k] * reference, &options, ws, &other),
                     CPROX_OK);
    assert_int_equal(other.verdict, factors[k] < 1.0 ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_VIOLATED);
  }
}

CASE(curve_curve_intervals_contain_their_references) {
  csv_table in = csv_read("reference/curve_curve_inputs.csv"), ref = csv_read("reference/curve_curve_ref.csv");
  assert_true(in.n > 50);
  for (size_t i = 0; i < in.n; i++) {
    const csv_row *row = &in.row[i];
    const size_t dim = csv_count(&in, row, 2), na = csv_count(&in, row, 3) + 1, nb = csv_count(&in, row, 4) + 1;
    vec3 a[MAX_POINTS], b[MAX_POINTS];
    csv_points(&in, row, 5, dim, na, a);
    csv_points(&in, row, 5 + dim * na, dim, nb, b);
    cprox_curve *first = bezier(a, na), *second = bezier(b, nb);
    check_case(row->field[0], first, second, csv_number(&ref, csv_find(&ref, row->field[0]), 1));
    cprox_curve_free(first);
    cprox_curve_free(second);
  }
  csv_free(&in);
  csv_free(&ref);
}

/* ---- the bound ---- */

typedef struct problem {
  size_t degree[2];
  vec3 points[2][MAX_DEGREE + 1];
  cprox_pose pose; /* of the second */
  cprox_curve *curve[2];
} problem;

static problem problem_random(rng *r) {
  problem p;
  const double scale = rng_log_uniform(r, 1e-6, 1e6);
  for (int k = 0; k < 2; k++) {
    p.degree[k] = 1 + rng_index(r, rng_index(r, 4) ? 5 : MAX_DEGREE);
    for (size_t i = 0; i <= p.degree[k]; i++) p.points[k][i] = rng_in_cube(r, scale);
    p.curve[k] = bezier(p.points[k], p.degree[k] + 1);
  }
  p.pose = rng_index(r, 2) ? CPROX_POSE_IDENTITY : rng_pose(r, scale);
  return p;
}

static long double true_distance(const problem *p, double s, double t) {
  const vec3l x = ref_bezier(p->points[0], p->degree[0], s, 0);
  const vec3l y = ref_to_world(&p->pose, ref_bezier(p->points[1], p->degree[1], t, 0));
  return ref_norm(ref_sub(x, y));
}

/* Two points well inside: the intervals' ends are labels in double, the pieces themselves are cut exactly. */
static size_t check_node(const problem *p, rng *r, const search_node *node, const curve_curve *o) {
  const curve_interval *a = &curve_curve_known(node)->side[0], *b = &curve_curve_known(node)->side[1];
  if (a->b - a->a < 1e-9 || b->b - b->a < 1e-9) return 0;
  for (int k = 0; k < 2; k++) {
    const double s = a->a + rng_uniform(r, 1e-3, 1.0 - 1e-3) * (a->b - a->a);
    const double t = b->a + rng_uniform(r, 1e-3, 1.0 - 1e-3) * (b->b - b->a);
    const long double d = true_distance(p, s, t);
    if ((long double)node->lower > d)
      fail_msg("bound %.17g above the distance %.17Lg at (%g, %g)", node->lower, d, s, t);
  }
  if (o->incumbent > 0 && (long double)o->best_bound.upper < true_distance(p, o->best.s[0], o->best.s[1]))
    fail_msg("upper bound %.17g below the distance at its own point", o->best_bound.upper);
  return 1;
}

static size_t attack(const problem *p, rng *r) {
  curve_curve o;
  assert_true(curve_curve_begin(&o, p->curve[0], p->curve[1], &p->pose, 0.0, ws));
  o.effort.good_enough = rng_index(r, 2) ? -INFINITY : INFINITY;
  const search_oracle oracle = curve_curve_oracle(&o);
  const bool chase = rng_index(r, 2);
  search_node open[MAX_OPEN + SEARCH_MAX_CHILDREN];
  search_best best = {.upper = INFINITY};
  size_t n = 1, checked = 0;
  open[0] = curve_curve_root(&o);
  for (int step = 0; step < STEPS && n < MAX_OPEN; step++) {
    size_t i = rng_index(r, n);
    for (size_t k = 0; chase && o.incumbent > 0 && k < n; k++) {
      const curve_interval *a = &curve_curve_known(&open[k])->side[0], *b = &curve_curve_known(&open[k])->side[1];
      if (a->a <= o.best.s[0] && o.best.s[0] <= a->b && b->a <= o.best.s[1] && o.best.s[1] <= b->b) i = k;
    }
    oracle.filter(oracle.self, &open[i], INFINITY);
    checked += check_node(p, r, &open[i], &o);
    assert_int_equal(oracle.probe(oracle.self, &open[i], &best), CPROX_OK);
    checked += check_node(p, r, &open[i], &o);
    search_node child[SEARCH_MAX_CHILDREN];
    const int children = oracle.split(oracle.self, &open[i], child);
    if (children < 2) break;
    open[i] = child[0];
    for (int k = 1; k < children; k++) open[n++] = child[k];
    for (int k = 0; k < children; k++) checked += check_node(p, r, &child[k], &o);
  }
  return checked;
}

/* Seed 31, 120,000 pairs of intervals, each at two random points. Tolerance 0: the slack is in the bound; long double
 * is off by a 2048th of it. */
CASE(no_bound_lies_above_the_distance_of_two_points) {
  rng r = rng_seed(31);
  for (size_t checked = 0; checked < test_cases(INTERVALS);) {
    problem p = problem_random(&r);
    checked += attack(&p, &r);
    for (int k = 0; k < 2; k++) cprox_curve_free(p.curve[k]);
  }
}

/* ---- where others do not end ---- */

/* Each within its budget, with a true interval. */
static cprox_result ask(const vec3 *a, size_t na, const vec3 *b, size_t nb, double epsilon, uint32_t most_nodes) {
  cprox_curve *first = bezier(a, na), *second = bezier(b, nb);
  const cprox_options options = accurate(epsilon);
  cprox_result r, verdict;
  assert_true(cprox_distance(cprox_point_along(first), cprox_obstacle_curve(second, 0.0), &options, ws, &r) >= 0);
  assert_true(cprox_collision(cprox_point_along(first), cprox_obstacle_curve(second, 0.0), &options, ws, &verdict) >=
              0);
  if (r.upper <= epsilon) assert_int_not_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
  if (r.lower > 0.0) assert_int_equal(verdict.verdict, CPROX_VERDICT_CLEAR);
  if (r.nodes > most_nodes || verdict.nodes > most_nodes) fail_msg("%u and %u nodes", r.nodes, verdict.nodes);
  cprox_curve_free(first);
  cprox_curve_free(second);
  return r;
}

/* Control points of a piece like an arc, of a straight one, or any; as a curve's pieces have them, too. */
static void draw_piece(rng *r, size_t degree, vec3 near, double length, vec3 *p, double *points) {
  const size_t kind = rng_index(r, 3);
  const vec3 along = rng_unit(r), across = rng_unit(r);
  for (size_t i = 0; i <= degree; i++) {
    const double x = (double)i / (double)degree - 0.5;
    const double noise = kind == 0 ? 1.0 : kind == 1 ? 1e-2 : 0.0;
    p[i] = vec_axpy(near, length * x, along);
    p[i] = vec_axpy(p[i], length * length * x * x, across);
    p[i] = vec_axpy(p[i], noise * length, rng_in_cube(r, 1.0));
    points[i] = p[i].x, points[degree + 1 + i] = p[i].y, points[2 * (degree + 1) + i] = p[i].z;
  }
}

/* 20,000 pairs of pieces of degrees 1 … 12 (seed 407), from 1e-4 to 3 long and from 1e-3 to 3 apart, each at 15 by 15
 * parameters. */
CASE(no_two_points_of_bent_pieces_are_nearer_than_their_bound) {
  enum { PLACES = 14 };
  rng r = rng_seed(407);
  const size_t cases = test_cases(20000);
  size_t told = 0;
  for (size_t i = 0; i < cases; i++) {
    vec3 p[2][MAX_DEGREE + 1];
    double points[2][3 * (MAX_DEGREE + 1)];
    const size_t degree[2] = {1 + rng_index(&r, MAX_DEGREE), 1 + rng_index(&r, MAX_DEGREE)};
    const double length = rng_log_uniform(&r, 1e-4, 3.0);
    draw_piece(&r, degree[0], vec(0, 0, 0), length, p[0], points[0]);
    draw_piece(&r, degree[1], vec_scale(rng_log_uniform(&r, 1e-3, 3.0), rng_unit(&r)),
               length * rng_log_uniform(&r, 0.1, 10.0), p[1], points[1]);
    double magnitude = 0.0;
    for (int k = 0; k < 2; k++) magnitude += control_magnitude(points[k], degree[k]);
    const double bound = bent_pieces_apart((const double *const[2]){points[0], points[1]}, degree, magnitude);
    long double least = INFINITY;
    for (int s = 0; s <= PLACES; s++)
      for (int t = 0; t <= PLACES; t++) {
        const vec3l x = ref_bezier(p[0], degree[0], (long double)s / PLACES, 0);
        const vec3l y = ref_bezier(p[1], degree[1], (long double)t / PLACES, 0);
        least = fminl(least, ref_norm(ref_sub(x, y)));
      }
    if (bound > (double)least) fail_msg("case %zu: %.17g, but %.17Lg", i, bound, least);
    told += bound > 0.9 * (double)least;
  }
  assert_true(3 * told > cases);
}

/* Parallel arcs, ever shorter: what is lost falls like the third power of their length or faster. */
CASE(the_bound_of_bent_pieces_is_of_third_order) {
  double last = 0.0;
  for (int k = 0; k < 5; k++) {
    const double w = 0.4 / (1 << k);
    double points[2][12];
    for (int side = 0; side < 2; side++) {
      const double radius = 1.0 + side, x = radius * sin(w), y = radius * cos(w), h = radius * 4.0 / 3.0 * tan(0.5 * w);
      const double arc[12] = {-x, -x + h * cos(w), x - h * cos(w), x, y, y + h * sin(w), y + h * sin(w), y, 0, 0, 0, 0};
      for (int i = 0; i < 12; i++) points[side][i] = arc[i];
    }
    const double lost =
        1.0 - bent_pieces_apart((const double *const[2]){points[0], points[1]}, (const size_t[2]){3, 3}, 6.0);
    assert_true(lost > 0.0 && lost < 8.0 * w * w * w);
    if (k > 0) assert_true(lost < last / 7.0);
    last = lost;
  }
}

CASE(contacts_of_every_kind_end_within_their_budget) {
  const vec3 s[] = {{0, 0, 0}, {0.3, 1, 0.2}, {0.6, -1, 0.4}, {1, 0.2, 0}};
  const vec3 reversed[] = {{1, 0.2, 0}, {0.6, -1, 0.4}, {0.3, 1, 0.2}, {0, 0, 0}};
  const vec3 moved[] = {{0, 0, 1e-3}, {0.3, 1, 0.2 + 1e-3}, {0.6, -1, 0.4 + 1e-3}, {1, 0.2, 1e-3}};
  const vec3 line[] = {{-1, 0, 0}, {1, 0, 0}}, crossing[] = {{0, -1, 0}, {0, 1, 0}},
             over[] = {{0.1, -1, 1e-3}, {0.1, 1, 1e-3}};
  const vec3 beside[] = {{-0.5, 0.25, 0}, {1.5, 0.25, 0}}, ahead[] = {{1, 0, 0}, {2, 0, 0}},
             part[] = {{0.5, 0, 0}, {3, 0, 0}};
  const vec3 bowl[] = {{-1, 1, 0}, {0, -1, 0}, {1, 1, 0}}, deeper[] = {{-1, 1.5, 0}, {0, -1.5, 0}, {1, 1.5, 0}};
  const vec3 still[] = {{0, 0.5, 0}, {0, 0.5, 0}};
  assert_true(ask(s, 4, s, 4, 1e-9, 200).upper <= 1e-9);
  assert_true(ask(s, 4, reversed, 4, 1e-9, 200).upper <= 1e-9);
  assert_true(ask(line, 2, crossing, 2, 1e-9, 200).upper <= 1e-9);
  assert_true(ask(line, 2, ahead, 2, 1e-9, 200).upper <= 1e-9);
  assert_true(ask(line, 2, part, 2, 1e-9, 200).upper <= 1e-9);
  assert_true(ask(bowl, 3, deeper, 3, 1e-9, 2000).upper <= 1e-9);
  cprox_result r = ask(line, 2, over, 2, 1e-9, 200);
  assert_true(r.lower <= 1e-3 && r.upper >= 1e-3 && r.upper - r.lower <= 1e-9);
  r = ask(line, 2, beside, 2, 1e-9, 2000);
  assert_true(r.lower <= 0.25 && r.upper >= 0.25 && r.upper - r.lower <= 1e-9);
  r = ask(line, 2, still, 2, 1e-9, 200);
  assert_true(r.lower <= 0.5 && r.upper >= 0.5 && r.upper - r.lower <= 1e-9);
  r = ask(s, 4, moved, 4, 1e-9, 20001);
  assert_true(r.upper >= 1e-4 && r.upper <= 1e-3 + 1e-15); /* the tangent leans towards the move */
}

/* Circular arcs about one centre: every point of one is nearest to some point of the other. How they bend settles it. */
CASE(concentric_arcs_are_answered_to_1e_12) {
  const double k = 0.5522847498;
  const vec3 inner[] = {{1, 0, 0}, {1, k, 0}, {k, 1, 0}, {0, 1, 0}},
             outer[] = {{2, 0, 0}, {2, 2 * k, 0}, {2 * k, 2, 0}, {0, 2, 0}};
  cprox_curve *first = bezier(inner, 4), *second = bezier(outer, 4);
  double width = INFINITY;
  cprox_status last = CPROX_BUDGET;
  for (uint32_t budget = 100; budget <= 10000; budget *= 10) {
    cprox_options options = accurate(1e-12);
    options.max_nodes = budget;
    cprox_result r;
    const cprox_status status =
        cprox_distance(cprox_point_along(first), cprox_obstacle_curve(second, 0.0), &options, ws, &r);
    assert_true(status == CPROX_BUDGET || status == CPROX_OK);
    assert_true(r.lower <= 1.0 && r.upper >= 1.0 - 1e-9 && r.upper - r.lower <= width);
    width = r.upper - r.lower, last = status;
  }
  assert_int_equal(last, CPROX_OK);
  assert_true(width <= 1e-12);
  cprox_curve_free(first);
  cprox_curve_free(second);
}

/* Seed 33: two splines of 300 cubic spans each, against sampling; and a curve among bodies in one list of targets. */
CASE(long_splines_are_searched_by_their_trees) {
  enum { N = 303 };
  vec3 points[2][N];
  double knots[N + 4];
  for (int i = 0; i < N + 4; i++) knots[i] = i;
  for (int i = 0; i < N; i++) {
    const double a = 0.05 * i;
    points[0][i] = vec(cos(a), sin(a), 0.02 * i);
    points[1][i] = vec(2.1 + cos(1.3 * a), sin(1.3 * a), 0.02 * i + 0.3 * sin(0.7 * a));
  }
  cprox_curve *curve[2] = {NULL, NULL};
  for (int k = 0; k < 2; k++)
    assert_int_equal(curve_from(describe_bspline(points[k], N, 3, knots, N + 4, knots[3], knots[N]), ws, &curve[k]),
                     CPROX_OK);
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_point_along(curve[0]), cprox_obstacle_curve(curve[1], 0.0), NULL, ws, &r),
                   CPROX_OK);
  assert_true(r.upper - r.lower <= 1e-6);
  double least = INFINITY;
  for (int i = 0; i <= 3000; i++) {
    vec3 x;
    assert_int_equal(cprox_curve_evaluate(curve[0], knots[3] + (knots[N] - knots[3]) * i / 3000.0, ws, &x, NULL, NULL),
                     CPROX_OK);
    for (int j = 0; j <= 600; j++) {
      vec3 y;
      assert_int_equal(cprox_curve_evaluate(curve[1], knots[3] + (knots[N] - knots[3]) * j / 600.0, ws, &y, NULL, NULL),
                       CPROX_OK);
      least = fmin(least, vec_norm(vec_sub(x, y)));
    }
  }
  assert_true(r.lower <= least && r.upper <= least);
  assert_true(least - r.upper < 1e-2);

  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  const cprox_pose far = {.position = {-50, 0, 0}, .orientation = {1, 0, 0, 0}};
  const cprox_obstacle targets[] = {cprox_obstacle_at(ball, far), cprox_obstacle_curve(curve[1], 0.0)};
  cprox_result all;
  assert_int_equal(distance_of_list(cprox_point_along(curve[0]), targets, 2, NULL, ws, &all, NULL), CPROX_OK);
  assert_true(all.obstacle_index == 1 && all.lower <= r.upper && r.lower <= all.upper);
  cprox_body_free(ball);
  for (int k = 0; k < 2; k++) cprox_curve_free(curve[k]);
}

/* Control points within a cube of half width 1, one array a coordinate. */
static size_t random_piece(rng *r, double *points) {
  const size_t degree = 1 + rng_index(r, MAX_DEGREE);
  for (size_t i = 0; i < 3 * (degree + 1); i++) points[i] = rng_uniform(r, -1.0, 1.0);
  return degree;
}

static vec3l point_of(const double *points, size_t degree, double s) {
  vec3 control[MAX_DEGREE + 1];
  for (size_t i = 0; i <= degree; i++)
    control[i] = vec(points[i], points[degree + 1 + i], points[2 * (degree + 1) + i]);
  return ref_bezier(control, degree, (long double)s, 0);
}

/* Seed 41, 1000 pairs of pieces of degrees 1 to 12: no two of 17 points of each, in long double, are nearer than those
 * that are found, within (10 n + 16) u of the size 2 for either point. */
CASE(the_first_pair_is_the_nearest_of_all_points_looked_at) {
  rng r = rng_seed(41);
  for (size_t round = 0; round < test_cases(1000); round++) {
    double points[2][3 * (MAX_DEGREE + 1)], s[2];
    const size_t degree[2] = {random_piece(&r, points[0]), random_piece(&r, points[1])};
    const double *basis[2];
    assert_true(packet_bases(degree, ws, basis));
    packet_first_pair(&(packet_piece){basis[0], points[0], degree[0]}, &(packet_piece){basis[1], points[1], degree[1]},
                      s);
    const vec3l found[2] = {point_of(points[0], degree[0], s[0]), point_of(points[1], degree[1], s[1])};
    const long double nearest =
        ref_norm(ref_sub(found[0], found[1])) - 4.0L * (10.0L * MAX_DEGREE + 16.0L) * (long double)ROUND_U;
    vec3l second[CHORDS + 1];
    for (size_t k = 0; k <= CHORDS; k++) second[k] = point_of(points[1], degree[1], (double)k / CHORDS);
    for (size_t i = 0; i <= CHORDS; i++) {
      const vec3l first = point_of(points[0], degree[0], (double)i / CHORDS);
      for (size_t k = 0; k <= CHORDS; k++) assert_true(nearest <= ref_norm(ref_sub(first, second[k])));
    }
  }
}

/* Seed 42, 400 pairs of degree 5 in neighbouring cubes, of which those count that are more than 0.02 apart. Nine in ten
 * are seen at the first node to come within 1.1 times their distance, and half are known within four to stay beyond 0.9
 * of it. */
CASE(verdicts_about_pieces_take_few_nodes) {
  enum { PAIRS = 400, POINTS = 6 };
  rng r = rng_seed(42);
  uint32_t seen_at_once = 0, settled_soon = 0, asked = 0;
  for (size_t i = 0; i < PAIRS; i++) {
    cprox_curve *curve[2];
    for (int k = 0; k < 2; k++) {
      vec3 points[POINTS];
      for (size_t j = 0; j < POINTS; j++) points[j] = vec_add(vec(1.1 * k, 0, 0), rng_in_cube(&r, 0.5));
      curve[k] = bezier(points, POINTS);
    }
    const cprox_mover mover = cprox_point_along(curve[0]);
    const cprox_obstacle target = cprox_obstacle_curve(curve[1], 0.0);
    cprox_result distance, violated, clear;
    assert_int_equal(cprox_distance(mover, target, NULL, ws, &distance), CPROX_OK);
    if (distance.lower > 0.02) {
      assert_int_equal(cprox_tolerance(mover, target, 1.1 * distance.upper, NULL, ws, &violated), CPROX_OK);
      assert_int_equal(cprox_tolerance(mover, target, 0.9 * distance.lower, NULL, ws, &clear), CPROX_OK);
      assert_true(violated.verdict == CPROX_VERDICT_VIOLATED && clear.verdict == CPROX_VERDICT_CLEAR);
      asked++;
      seen_at_once += violated.nodes == 1;
      settled_soon += clear.nodes <= 4;
    }
    for (int k = 0; k < 2; k++) cprox_curve_free(curve[k]);
  }
  assert_true(asked > PAIRS / 2);
  assert_true(10 * seen_at_once > 9 * asked && 2 * settled_soon > asked);
}

CASE(a_target_is_a_body_or_a_curve_and_not_both) {
  cprox_curve *curve = bezier((vec3[]){{0, 0, 0}, {1, 0, 0}}, 2);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.1, ws, &ball), CPROX_OK);
  cprox_obstacle both = cprox_obstacle_curve(curve, 0.0);
  both.body = ball;
  cprox_result r;
  assert_int_equal(cprox_distance(cprox_point_along(curve), both, NULL, ws, &r), CPROX_INVALID);
  assert_int_equal(cprox_distance(cprox_point_along(curve), cprox_obstacle_curve(NULL, 0.0), NULL, ws, &r),
                   CPROX_INVALID);
  assert_int_equal(cprox_distance(cprox_point_along(curve), cprox_obstacle_curve(curve, -1.0), NULL, ws, &r),
                   CPROX_INVALID);
  assert_int_equal(
      cprox_pair(cprox_obstacle_curve(curve, 0.0), cprox_obstacle_at(ball, CPROX_POSE_IDENTITY), NULL, ws, &r),
      CPROX_INVALID);
  cprox_body_free(ball);
  cprox_curve_free(curve);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
