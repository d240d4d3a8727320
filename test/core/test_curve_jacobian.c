/* SPDX-License-Identifier: BSD-3-Clause */
/* Derivatives of points and of distances by the numbers that define a curve, against central differences of the curves
 * and the distances themselves. */
#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/make_curve.h"
#include "support/random.h"

enum { MOST = 16, POINTS = 4, KINDS = 6 };

/* A curve by its numbers, in the order of cprox_curve_jacobian(). */
typedef struct numbers {
  cprox_curve_kind kind;
  cprox_dubins_word word;
  size_t n;
  double value[MOST];
  vec3 start, points[POINTS];
  double t0, t1;
} numbers;

static const double KNOTS[] = {0, 0, 0, 0.6, 1, 1, 1};

/* The description refers to *room, the preimage of a hodograph. */
static cprox_curve_description describe(const numbers *c, cprox_quat *room) {
  const double *v = c->value;
  const vec3 from = c->start;
  switch (c->kind) {
    case CPROX_CURVE_CLOTHOID: return describe_clothoid(from, v[0], v[1], v[2], c->t0, c->t1);
    case CPROX_CURVE_INVOLUTE: return describe_involute(from, v[1], v[0], c->t0, c->t1);
    case CPROX_CURVE_DUBINS:
      return describe_dubins(vec(v[3], v[4], from.z), v[0], vec(v[5], v[6], from.z), v[1], v[2], c->word);
    case CPROX_CURVE_RATIONAL_BEZIER: return describe_rational_bezier(c->points, v, POINTS, c->t0, c->t1);
    case CPROX_CURVE_NURBS: return describe_nurbs(c->points, v, POINTS, 2, KNOTS, 7, 0.1, 0.9);
    default:
      for (size_t i = 0; i < c->n / 4; i++) room[i] = (cprox_quat){v[4 * i], v[4 * i + 1], v[4 * i + 2], v[4 * i + 3]};
      return describe_pythagorean_hodograph(from, room, c->n / 4, c->t0, c->t1);
  }
}

static cprox_curve *make(const numbers *c) {
  cprox_quat room[MOST / 4];
  cprox_curve *curve = NULL;
  if (curve_from(describe(c, room), ws, &curve) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return curve;
}

static numbers numbers_random(rng *r, size_t k) {
  static const cprox_curve_kind kinds[KINDS] = {CPROX_CURVE_CLOTHOID,        CPROX_CURVE_DUBINS,
                                                CPROX_CURVE_INVOLUTE,        CPROX_CURVE_PYTHAGOREAN_HODOGRAPH,
                                                CPROX_CURVE_RATIONAL_BEZIER, CPROX_CURVE_NURBS};
  numbers c = {.kind = kinds[k % KINDS], .start = rng_in_cube(r, 1.0)};
  double *v = c.value;
  for (int i = 0; i < POINTS; i++) c.points[i] = rng_in_cube(r, 1.0);
  c.t0 = rng_uniform(r, -1, 1), c.t1 = c.t0 + rng_uniform(r, 0.5, 2.0);
  switch (c.kind) {
    case CPROX_CURVE_CLOTHOID:
      c.n = 3, v[0] = rng_uniform(r, -3, 3), v[1] = rng_uniform(r, -3, 3), v[2] = rng_uniform(r, -3, 3);
      if (k % 4 == 0) v[2] = 0.0;
      break;
    case CPROX_CURVE_INVOLUTE: c.n = 2, v[0] = rng_uniform(r, -3, 3), v[1] = rng_log_uniform(r, 0.1, 1.0); break;
    case CPROX_CURVE_DUBINS: {
      c.n = 7, v[0] = rng_uniform(r, -3, 3), v[1] = rng_uniform(r, -3, 3), v[2] = rng_log_uniform(r, 0.1, 0.5);
      for (int i = 3; i < 7; i++) v[i] = rng_uniform(r, -1, 1);
      c.word = CPROX_DUBINS_SHORTEST;
      cprox_curve *curve = make(&c);
      const cprox_curve_info info = cprox_curve_get_info(curve);
      c.word = info.dubins.word, c.t0 = 0.0, c.t1 = info.t1;
      cprox_curve_free(curve);
      break;
    }
    case CPROX_CURVE_PYTHAGOREAN_HODOGRAPH:
      c.n = 4 * (1 + rng_index(r, MOST / 4));
      for (size_t i = 0; i < c.n; i++) v[i] = rng_uniform(r, -1, 1);
      break;
    default:
      c.n = POINTS;
      for (size_t i = 0; i < c.n; i++) v[i] = rng_log_uniform(r, 0.2, 5.0);
      c.t0 = 0.1, c.t1 = 0.9;
  }
  return c;
}

/* A Dubins path beside whose numbers there may be no other of its word, or none of which all turns stay in order. */
static bool is_near_a_jump(const numbers *c) {
  if (c->kind != CPROX_CURVE_DUBINS) return false;
  cprox_curve *curve = make(c);
  const cprox_dubins_path path = cprox_curve_get_info(curve).dubins;
  cprox_curve_free(curve);
  double from = 0.0;
  for (int i = 0; i < 3; i++) {
    const double turned = (path.ends[i] - from) / c->value[2];
    if (i != 1 && (turned < 0.1 || turned > 6.18)) return true;
    /* circles that nearly touch or coincide; a middle arc of nearly half a turn, whose outer circles are 4 radii apart */
    if (i == 1 && turned < (path.word >= CPROX_DUBINS_RLR ? 3.5 : 0.4)) return true;
    from = path.ends[i];
  }
  return false;
}

/* Two parts of a Dubins path join at t, give or take what a step moves their joint by. */
static bool is_near_a_joint(const numbers *c, double t) {
  if (c->kind != CPROX_CURVE_DUBINS) return false;
  cprox_curve *curve = make(c);
  const cprox_dubins_path path = cprox_curve_get_info(curve).dubins;
  cprox_curve_free(curve);
  return fabs(t - path.ends[0]) < 0.03 || fabs(t - path.ends[1]) < 0.03;
}

static vec3 point_at(const numbers *c, double t) {
  cprox_curve *curve = make(c);
  vec3 at;
  assert_int_equal(cprox_curve_evaluate(curve, t, ws, &at, NULL, NULL), CPROX_OK);
  cprox_curve_free(curve);
  return at;
}

/* Seed 431, 100 curves a kind, each number of each curve. Differences of 5e-5 and 1e-4 with one extrapolation: their
 * remainder is 2e-17 times the fifth derivative, which short Dubins paths make 1e8, and the curves' own 1e-13 over 5e-5
 * is 2e-9. */
CASE(columns_are_the_derivatives_of_the_point) {
  rng r = rng_seed(431);
  size_t held = 0;
  for (size_t k = 0; k < test_cases(100 * KINDS); k++) {
    numbers c = numbers_random(&r, k);
    const double t = c.t0 + (c.t1 - c.t0) * rng_uniform(&r, 0.01, 0.99);
    if (is_near_a_jump(&c) || is_near_a_joint(&c, t)) continue;
    cprox_quat room[MOST / 4];
    const cprox_curve_description d = describe(&c, room);
    cprox_vec3 columns[MOST];
    assert_int_equal(cprox_curve_jacobian(&d, t, columns), CPROX_OK);
    for (size_t i = 0; i < c.n; i++) {
      vec3 slope[2];
      for (int m = 0; m < 2; m++) {
        const double h = 1e-4 / (m + 1);
        numbers ahead = c, behind = c;
        ahead.value[i] += h, behind.value[i] -= h;
        slope[m] = vec_scale(0.5 / h, vec_sub(point_at(&ahead, t), point_at(&behind, t)));
      }
      const vec3 expected = vec_scale(1.0 / 3.0, vec_sub(vec_scale(4.0, slope[1]), slope[0]));
      const double misfit = vec_norm(vec_sub(columns[i], expected));
      if (!(misfit < 1e-6 * (1.0 + vec_norm(columns[i]))))
        fail_msg("case %zu, kind %d, number %zu of %zu: off by %g of %g", k, (int)c.kind, i, c.n, misfit,
                 vec_norm(expected));
      held++;
    }
  }
  assert_true(held > test_cases(1500));
}

/* Seed 432: the end of a Dubins path is its end point, whatever else changes. */
CASE(the_end_of_a_path_moves_with_its_end_point) {
  rng r = rng_seed(432);
  for (size_t k = 0; k < test_cases(500); k++) {
    const numbers c = numbers_random(&r, 1);
    cprox_curve *curve = make(&c);
    const double end = cprox_curve_get_info(curve).t1;
    cprox_curve_free(curve);
    if (is_near_a_jump(&c)) continue;
    cprox_vec3 columns[7];
    const cprox_curve_description d = describe(&c, NULL);
    assert_int_equal(cprox_curve_jacobian(&d, end, columns), CPROX_OK);
    for (int i = 0; i < 7; i++) {
      const vec3 expected = vec(i == 5, i == 6, 0.0);
      if (!(vec_norm(vec_sub(columns[i], expected)) < 1e-9))
        fail_msg("case %zu, column %d: (%g, %g)", k, i, columns[i].x, columns[i].y);
    }
  }
}

/* ---- distances ---- */

typedef struct near {
  const cprox_body *body;
  cprox_pose pose;
  double radius;
} near;

static double distance(const numbers *c, const near *o, cprox_gradient *gradient) {
  cprox_curve *curve = make(c);
  const cprox_mover mover = cprox_tube_along(curve, o->radius);
  const cprox_obstacle obstacle = cprox_obstacle_at(o->body, o->pose);
  cprox_options options = accurate(gradient ? 1e-9 : 0.0);
  options.signed_distance = true;
  cprox_result result;
  if (cprox_distance(mover, obstacle, &options, ws, &result) < 0) fail_msg("%s", cprox_workspace_error(ws));
  if (gradient && cprox_distance_gradient(mover, obstacle, &options, &result, ws, gradient) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  cprox_curve_free(curve);
  return 0.5 * (result.lower + result.upper);
}

/* One direction in the space of all numbers. */
typedef struct direction {
  double value[MOST], t0, t1;
  vec3 start;
} direction;

static numbers moved(numbers c, const direction *d, double h) {
  for (size_t i = 0; i < c.n; i++) c.value[i] += h * d->value[i];
  c.start = vec_axpy(c.start, h, d->start);
  c.t0 += h * d->t0, c.t1 += h * d->t1;
  return c;
}

static direction direction_random(rng *r, const numbers *c) {
  direction d = {.t0 = 0.0};
  for (size_t i = 0; i < c->n; i++) d.value[i] = rng_uniform(r, -1, 1) * fmin(1.0, 0.3 + fabs(c->value[i]));
  const bool has_start =
      c->kind != CPROX_CURVE_DUBINS && c->kind != CPROX_CURVE_RATIONAL_BEZIER && c->kind != CPROX_CURVE_NURBS;
  if (has_start) d.start = rng_in_cube(r, 1.0);
  if (c->kind == CPROX_CURVE_CLOTHOID || c->kind == CPROX_CURVE_INVOLUTE)
    d.t0 = rng_uniform(r, -1, 1), d.t1 = rng_uniform(r, -1, 1);
  return d;
}

/* The derivative along the direction, as the gradient and the Jacobian say. */
static double derivative(const numbers *c, const direction *d, const cprox_gradient *g) {
  cprox_quat room[MOST / 4];
  const cprox_curve_description described = describe(c, room);
  cprox_vec3 columns[MOST];
  assert_int_equal(cprox_curve_jacobian(&described, g->t, columns), CPROX_OK);
  double sum = vec_dot(g->mover, d->start) + g->t0 * d->t0 + g->t1 * d->t1;
  for (size_t i = 0; i < c->n; i++) sum += vec_dot(g->mover, columns[i]) * d->value[i];
  return sum;
}

/* As in test_gradient.c: the nearest of four central differences, as features may change beside the place. */
static double misfit(const numbers *c, const near *o, const direction *d, double expected) {
  double best = INFINITY;
  for (int k = 0; k < 4; k++) {
    double slope[2];
    for (int m = 0; m < 2; m++) {
      const double h = 1e-3 * pow(10.0, -k) / (m + 1);
      const numbers ahead = moved(*c, d, h), behind = moved(*c, d, -h);
      slope[m] = (distance(&ahead, o, NULL) - distance(&behind, o, NULL)) / (2.0 * h);
    }
    best = fmin(best, fabs((4.0 * slope[1] - slope[0]) / 3.0 - expected));
  }
  return best;
}

/* Seed 433, 60 curves a kind past balls and boxes, a direction each. 1e-6: what differences of 1e-5 leave of the
 * distance's last digits. */
CASE(distances_change_as_the_numbers_say) {
  rng r = rng_seed(433);
  cprox_body *ball = NULL, *box = NULL;
  assert_int_equal(cprox_body_create_sphere(0.2, ws, &ball), CPROX_OK);
  assert_int_equal(cprox_body_create_box(vec(0.2, 0.1, 0.3), ws, &box), CPROX_OK);
  size_t valid[KINDS] = {0}, at_ends = 0;
  for (size_t k = 0; k < test_cases(60 * KINDS); k++) {
    const numbers c = numbers_random(&r, k);
    const near o = {.body = rng_index(&r, 2) ? ball : box, .pose = rng_pose(&r, 1.5), .radius = 0.05};
    const direction d = direction_random(&r, &c);
    if (is_near_a_jump(&c)) continue;
    cprox_gradient g;
    distance(&c, &o, &g);
    if (!g.valid) continue;
    const double expected = derivative(&c, &d, &g), off = misfit(&c, &o, &d, expected);
    if (!(off < 1e-6 * (1.0 + fabs(expected))))
      fail_msg("case %zu, kind %d, t %.17g of [%g, %g]: %g, off by %g", k, (int)c.kind, g.t, c.t0, c.t1, expected, off);
    valid[k % KINDS]++;
    at_ends += g.t == c.t0 || g.t == c.t1;
  }
  for (size_t k = 0; k < KINDS; k++) assert_true(valid[k] > test_cases(25));
  assert_true(at_ends > test_cases(20));
  cprox_body_free(ball);
  cprox_body_free(box);
}

/* ---- where there is none ---- */

CASE(kinds_without_numbers_of_their_own_are_refused) {
  const vec3 points[2] = {{0, 0, 0}, {1, 0, 0}};
  const cprox_vec3 untouched = {7.0, 7.0, 7.0};
  cprox_vec3 columns[MOST];
  for (int i = 0; i < MOST; i++) columns[i] = untouched;
  const cprox_curve_description refused[] = {
      describe_bezier(points, 2, 0.0, 1.0),
      /* too near each other for a path of this word; one circle, on which the turns are not told apart */
      describe_dubins(vec(0, 0, 0), 0.0, vec(0.1, 0.1, 0), 3.0, 1.0, CPROX_DUBINS_LSR),
      describe_dubins(vec(1, 0, 0), 0.5 * 3.14159265358979, vec(0, 1, 0), 3.14159265358979, 1.0, CPROX_DUBINS_LSL),
      describe_clothoid(vec(0, 0, 0), 0.0, 1e9, 0.0, 0.0, 1.0),
      {.kind = CPROX_CURVE_PYTHAGOREAN_HODOGRAPH, .t1 = 1.0},
  };
  for (size_t i = 0; i < sizeof refused / sizeof *refused; i++)
    if (cprox_curve_jacobian(&refused[i], 0.5, columns) != CPROX_INVALID) fail_msg("description %zu", i);
  assert_int_equal(cprox_curve_jacobian(NULL, 0.5, columns), CPROX_INVALID);
  const cprox_curve_description line = describe_clothoid(vec(0, 0, 0), 0.0, 0.0, 0.0, 0.0, 1.0);
  assert_int_equal(cprox_curve_jacobian(&line, NAN, columns), CPROX_INVALID);
  for (int i = 0; i < MOST; i++) assert_true(columns[i].x == 7.0);
}

/* A straight path between poses that face each other is one of two words; both say the same across the path. */
CASE(a_straight_path_has_the_derivatives_of_both_its_words) {
  cprox_vec3 columns[2][7];
  for (int k = 0; k < 2; k++) {
    const cprox_curve_description d =
        describe_dubins(vec(0, 0, 0), 0.0, vec(3, 0, 0), 0.0, 0.5, k ? CPROX_DUBINS_RSR : CPROX_DUBINS_LSL);
    assert_int_equal(cprox_curve_jacobian(&d, 1.2, columns[k]), CPROX_OK);
  }
  for (int i = 0; i < 7; i++) assert_true(fabs(columns[0][i].y - columns[1][i].y) < 1e-12);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
