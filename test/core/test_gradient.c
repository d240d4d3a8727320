/* SPDX-License-Identifier: BSD-3-Clause */
/* Gradients against central differences of distances; the weights against the curves themselves; and where none is to
 * be had. */
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/make_curve.h"
#include "support/meshes.h"
#include "support/random.h"
#include "support/reference.h"
#include "support/shapes.h"

/* ---- problems with parameters ---- */

enum { POINTS = 7, DEGREE = 3 };

typedef enum target_kind { BODY, CURVE, CLOCK } target_kind;

/* All that a distance depends on. */
typedef struct problem {
  bool spline, carries, is_signed;
  target_kind kind;
  vec3 points[POINTS], other[POINTS];
  double knots[POINTS + DEGREE + 1];
  double t0, t1;
  const cprox_body *body, *carried;
  cprox_pose pose;
  double radius, margin;
} problem;

static cprox_curve *make(const problem *p, const vec3 *points) {
  cprox_curve *curve = NULL;
  const cprox_status status =
      p->spline ? curve_from(describe_bspline(points, POINTS, DEGREE, p->knots, POINTS + DEGREE + 1, p->t0, p->t1), ws,
                             &curve)
                : curve_from(describe_bezier(points, POINTS, 0.0, 1.0), ws, &curve);
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  return curve;
}

/* Asks for the distance, and its gradient if there is room for it. */
static double ask(const problem *p, cprox_result *result, cprox_gradient *gradient) {
  cprox_curve *curve = make(p, p->points), *other = p->kind == BODY ? NULL : make(p, p->other);
  cprox_mover mover = cprox_tube_along(curve, p->radius), second = cprox_tube_along(other, p->margin);
  if (p->carried) mover.kind = CPROX_MOVER_BODY, mover.body = p->carried;
  if (p->kind == CLOCK && p->body) second.kind = CPROX_MOVER_BODY, second.body = p->body;
  cprox_obstacle target = p->kind == BODY    ? cprox_with_margin(cprox_obstacle_at(p->body, p->pose), p->margin)
                          : p->kind == CURVE ? cprox_obstacle_curve(other, p->margin)
                                             : cprox_synchronized(second);
  target.pose = p->pose;
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = gradient ? 1e-9 : 0.0;
  options.signed_distance = p->is_signed;
  assert_true(cprox_distance(mover, target, &options, ws, result) >= 0);
  if (gradient) {
    const cprox_status status = cprox_distance_gradient(mover, target, &options, result, ws, gradient);
    if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  }
  cprox_curve_free(curve);
  cprox_curve_free(other);
  return 0.5 * (result->lower + result->upper);
}

/* One direction in the space of all parameters. */
typedef struct step {
  vec3 points[POINTS], other[POINTS], position, turn;
  double radius, margin, t0, t1;
} step;

static step step_random(rng *r, const problem *p) {
  step d = {0};
  for (int i = 0; i < POINTS; i++) {
    d.points[i] = rng_in_cube(r, 1.0);
    if (p->kind != BODY) d.other[i] = rng_in_cube(r, 1.0);
  }
  d.position = rng_in_cube(r, 1.0);
  d.turn = rng_in_cube(r, 1.0);
  d.radius = p->radius > 0.0 ? rng_uniform(r, -1, 1) : 0.0;
  d.margin = p->margin > 0.0 ? rng_uniform(r, -1, 1) : 0.0;
  if (p->spline && p->kind == BODY) d.t0 = rng_uniform(r, -1, 1), d.t1 = rng_uniform(r, -1, 1);
  return d;
}

static problem moved(problem p, const step *d, double h) {
  for (int i = 0; i < POINTS; i++) {
    p.points[i] = vec_axpy(p.points[i], h, d->points[i]);
    p.other[i] = vec_axpy(p.other[i], h, d->other[i]);
  }
  p.pose.position = vec_axpy(p.pose.position, h, d->position);
  /* exp([w]) R as a quaternion: half the angle about w first */
  const vec3 w = vec_scale(h, d->turn);
  const double angle = vec_norm(w), s = angle > 0.0 ? sin(0.5 * angle) / angle : 0.5, c = cos(0.5 * angle);
  const cprox_quat a = {c, s * w.x, s * w.y, s * w.z}, b = p.pose.orientation;
  p.pose.orientation =
      (cprox_quat){a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
                   a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
  p.radius += h * d->radius, p.margin += h * d->margin;
  p.t0 += h * d->t0, p.t1 += h * d->t1;
  return p;
}

static void weights_at(const problem *p, double t, double *weights) {
  if (p->spline)
    curve_weights(describe_bspline(NULL, POINTS, DEGREE, p->knots, POINTS + DEGREE + 1, 0.0, 1.0), t, weights);
  else
    curve_weights(describe_bezier(NULL, POINTS, 0.0, 1.0), t, weights);
}

/* The derivative along the step, by the gradient. */
static double derivative(const problem *p, const cprox_gradient *g, const step *d) {
  double w[POINTS], sum = vec_dot(g->position, d->position) + vec_dot(g->rotation, d->turn);
  weights_at(p, g->t, w);
  for (int i = 0; i < POINTS; i++) sum += w[i] * vec_dot(g->mover, d->points[i]);
  if (p->kind != BODY) {
    weights_at(p, g->t_obstacle, w);
    for (int i = 0; i < POINTS; i++) sum += w[i] * vec_dot(g->obstacle_point, d->other[i]);
  }
  sum += g->radius * d->radius + g->margin * d->margin;
  return sum + g->t0 * d->t0 + g->t1 * d->t1;
}

/* How far the derivative is from the nearest of four central differences with one extrapolation each: the distance is
 * but once differentiable where the nearest feature changes, so that one step size alone may straddle such a place. */
static double misfit(const problem *p, const step *d, double expected, double *scale) {
  double best = INFINITY;
  const double widths[] = {1e-3, 1e-4, 1e-5, 1e-6};
  for (int k = 0; k < 4; k++) {
    double slope[2];
    for (int m = 0; m < 2; m++) {
      const double h = widths[k] / (m + 1);
      cprox_result r;
      const problem ahead = moved(*p, d, h), behind = moved(*p, d, -h);
      slope[m] = (ask(&ahead, &r, NULL) - ask(&behind, &r, NULL)) / (2.0 * h);
    }
    best = fmin(best, fabs((4.0 * slope[1] - slope[0]) / 3.0 - expected));
  }
  *scale = 1.0 + fabs(expected);
  return best;
}

static problem problem_random(rng *r, target_kind kind, const cprox_body *body) {
  problem p = {.kind = kind, .body = body, .spline = rng_index(r, 2), .pose = rng_pose(r, 0.5), .t0 = 0.0, .t1 = 1.0};
  for (int i = 0; i < POINTS; i++) {
    p.points[i] = vec_add(rng_in_cube(r, 1.0), vec(1.5, 1.0, 0.5));
    p.other[i] = rng_in_cube(r, 1.0);
  }
  for (int i = 0; i < POINTS + DEGREE + 1; i++) p.knots[i] = 0.25 * (i - DEGREE);
  if (p.spline) p.t0 = 0.1, p.t1 = 0.9;
  p.radius = rng_index(r, 2) ? 0.0 : 0.05;
  p.margin = rng_index(r, 2) ? 0.0 : 0.05;
  return p;
}

/* Counts the problems with a gradient; each of those must fit. */
static size_t check(rng *r, const problem *p, double tolerance) {
  cprox_result result;
  cprox_gradient g;
  ask(p, &result, &g);
  if (!g.valid || fabs(result.upper) < 0.05) return 0;
  const step d = step_random(r, p);
  double scale;
  const double expected = derivative(p, &g, &d), off = misfit(p, &d, expected, &scale);
  if (!(off <= tolerance * scale))
    fail_msg("kind %d, %s past %s, t %.17g in [%g, %g], distance %.17g: %.12g, differences are off by %g", (int)p->kind,
             p->carried ? cprox_body_kind_name(cprox_body_get_info(p->carried).kind) : "point",
             p->body ? cprox_body_kind_name(cprox_body_get_info(p->body).kind) : "curve", g.t, p->t0, p->t1,
             result.upper, expected, off);
  return 1;
}

static const cprox_body_kind SOLID[] = {CPROX_BODY_SPHERE,   CPROX_BODY_BOX,  CPROX_BODY_CAPSULE,
                                        CPROX_BODY_CYLINDER, CPROX_BODY_CONE, CPROX_BODY_ELLIPSOID,
                                        CPROX_BODY_POLYTOPE};

/* Seed 101, 10000 problems against seven kinds of bodies, 2000 of two curves, 2000 synchronized: 1e-7 (1 +
 * |derivative|), which leaves the differences 1e-8 for their own rounding and truncation. */
CASE(gradients_are_the_limits_of_differences) {
  rng r = rng_seed(101);
  size_t valid = 0, all = 0;
  for (size_t k = 0; k < test_cases(10000); k++, all++) {
    test_shape s;
    shape_make(&r, SOLID[k % 7], 0.6, 3.0, &s);
    const problem p = problem_random(&r, BODY, s.body);
    valid += check(&r, &p, 1e-7);
    cprox_body_free(s.body);
  }
  print_message("bodies: %zu of %zu have a gradient\n", valid, all);
  assert_true(2 * valid > all);
  valid = all = 0;
  for (size_t k = 0; k < test_cases(2000); k++, all++) {
    const problem p = problem_random(&r, CURVE, NULL);
    valid += check(&r, &p, 1e-7);
  }
  print_message("curves: %zu of %zu\n", valid, all);
  assert_true(2 * valid > all);
  valid = all = 0;
  for (size_t k = 0; k < test_cases(2000); k++, all++) {
    test_shape s;
    shape_make(&r, SOLID[k % 7], 0.4, 3.0, &s);
    const problem p = problem_random(&r, CLOCK, k % 3 ? s.body : NULL);
    valid += check(&r, &p, 1e-7);
    cprox_body_free(s.body);
  }
  print_message("synchronized: %zu of %zu\n", valid, all);
  assert_true(2 * valid > all);
}

/* Seed 102, 1000 problems of carried bodies: the normal comes from a search between two bounds that are 1e-13 apart,
 * and is as exact as the root of that: 2e-6. */
CASE(carried_bodies_have_gradients) {
  rng r = rng_seed(102);
  size_t valid = 0, all = 0;
  for (size_t k = 0; k < test_cases(1000); k++, all++) {
    test_shape s, c;
    shape_make(&r, SOLID[k % 7], 0.5, 3.0, &s);
    shape_make(&r, SOLID[(k / 7) % 7], 0.2, 3.0, &c);
    problem p = problem_random(&r, BODY, s.body);
    p.carried = c.body;
    valid += check(&r, &p, 2e-6);
    cprox_body_free(s.body);
    cprox_body_free(c.body);
  }
  print_message("carried: %zu of %zu\n", valid, all);
  assert_true(4 * valid > all);
}

/* A few points with a radius, boxes, or a mesh: anywhere, a torus, that torus solid, that torus with its hull. */
typedef struct elements {
  cprox_body *body, *hull, *mesh; /* the last two, where the first is made of them */
} elements;

static elements elements_make(rng *r, size_t kind) {
  enum { ELEMENTS = 12 };
  elements e = {NULL, NULL, NULL};
  vec3 low[ELEMENTS], high[ELEMENTS];
  for (int i = 0; i < ELEMENTS; i++) {
    low[i] = rng_in_cube(r, 0.7);
    high[i] = vec_add(low[i], vec(rng_uniform(r, 0.0, 0.2), rng_uniform(r, 0.0, 0.2), rng_uniform(r, 0.0, 0.2)));
  }
  if (kind == 0) assert_int_equal(cprox_body_create_points(low, ELEMENTS, 0.05, SIZE_MAX, ws, &e.body), CPROX_OK);
  if (kind == 1) assert_int_equal(cprox_body_create_boxes(low, high, ELEMENTS, SIZE_MAX, ws, &e.body), CPROX_OK);
  if (kind < 2) return e;
  test_mesh mesh = kind == 2 ? mesh_soup(r, 8, 0.7, 0.5) : mesh_torus(6, 4, 0.5, 0.2, 0.2);
  e.body = mesh_body(&mesh, kind == 4 ? CPROX_MESH_FILL_SOLID : CPROX_MESH_FILL_SURFACE, ws);
  if (kind == 5) {
    e.mesh = e.body;
    assert_int_equal(cprox_body_create_polytope(mesh.vertices, mesh.n, ws, &e.hull), CPROX_OK);
    assert_int_equal(cprox_body_create_lod(e.hull, 0.0, e.mesh, ws, &e.body), CPROX_OK);
  }
  mesh_free(&mesh);
  return e;
}

static void elements_free(elements *e) {
  cprox_body_free(e->body);
  cprox_body_free(e->hull);
  cprox_body_free(e->mesh);
}

/* Seed 105, 2000 problems of points, boxes and meshes: 1e-7, as with bodies. */
CASE(meshes_points_and_boxes_have_gradients) {
  rng r = rng_seed(105);
  enum { KINDS = 6 };
  size_t valid[KINDS] = {0}, all = test_cases(2000);
  for (size_t k = 0; k < all; k++) {
    elements e = elements_make(&r, k % KINDS);
    const problem p = problem_random(&r, BODY, e.body);
    valid[k % KINDS] += check(&r, &p, 1e-7);
    elements_free(&e);
  }
  for (size_t k = 0; k < KINDS; k++) {
    print_message("kind %zu: %zu of %zu have a gradient\n", k, valid[k], all / KINDS);
    assert_true(2 * valid[k] > all / KINDS);
  }
}

/* Seed 103, 2000 problems through balls, ellipsoids and boxes: depths have gradients where one way out is the shortest.
 */
CASE(depths_have_gradients) {
  rng r = rng_seed(103);
  const cprox_body_kind kinds[] = {CPROX_BODY_SPHERE, CPROX_BODY_ELLIPSOID, CPROX_BODY_BOX, CPROX_BODY_CAPSULE};
  size_t valid = 0, all = 0;
  for (size_t k = 0; k < test_cases(2000); k++, all++) {
    test_shape s;
    shape_make(&r, kinds[k % 4], 1.2, 2.0, &s);
    problem p = problem_random(&r, BODY, s.body);
    p.is_signed = true;
    for (int i = 0; i < POINTS; i++) p.points[i] = rng_in_cube(&r, 1.5);
    valid += check(&r, &p, 1e-7);
    cprox_body_free(s.body);
  }
  print_message("signed: %zu of %zu\n", valid, all);
  assert_true(5 * valid > all);
}

/* ---- where there is none ---- */

static void assert_none(cprox_mover mover, cprox_obstacle target, bool is_signed, const char *why) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.signed_distance = is_signed;
  cprox_result result;
  cprox_gradient g = {.valid = true};
  assert_true(cprox_distance(mover, target, &options, ws, &result) >= 0);
  assert_int_equal(cprox_distance_gradient(mover, target, &options, &result, ws, &g), CPROX_OK);
  if (g.valid || strcmp(cprox_workspace_error(ws), why) != 0)
    fail_msg("valid %d: %s", g.valid, cprox_workspace_error(ws));
}

/* Seed 46: curves that begin or end with velocity 0, beside a ball that lies ahead of that end. */
CASE(curves_that_end_at_rest_have_gradients_there) {
  rng r = rng_seed(46);
  cprox_body *ball = NULL;
  assert_int_equal(cprox_body_create_sphere(0.2, ws, &ball), CPROX_OK);
  for (int i = 0; i < 100; i++) {
    const bool backwards = i % 2;
    const vec3 end = rng_in_cube(&r, 1.0), way = vec(1.0, rng_uniform(&r, -0.3, 0.3), rng_uniform(&r, -0.3, 0.3));
    const vec3 points[4] = {vec_axpy(end, -2.0, way), vec_add(vec_axpy(end, -1.0, way), rng_in_cube(&r, 0.3)), end,
                            end};
    vec3 turned[4];
    for (int k = 0; k < 4; k++) turned[k] = points[backwards ? 3 - k : k];
    cprox_curve *curve = bezier(turned, 4);
    const vec3 ahead = vec_axpy(end, 0.5, way);
    const cprox_obstacle at = cprox_obstacle_at(ball, (cprox_pose){ahead, {1, 0, 0, 0}});
    const cprox_options options = accurate(1e-9);
    cprox_result result;
    cprox_gradient g;
    const cprox_mover mover = cprox_point_along(curve);
    assert_int_equal(cprox_distance(mover, at, &options, ws, &result), CPROX_OK);
    assert_int_equal(cprox_distance_gradient(mover, at, &options, &result, ws, &g), CPROX_OK);
    if (!g.valid) fail_msg("%d: %s", i, cprox_workspace_error(ws));
    assert_true(g.t == (backwards ? 0.0 : 1.0));
    const vec3 from = vec_sub(end, ahead);
    assert_true(vec_norm(vec_axpy(from, -vec_norm(from), g.mover)) < 1e-9);
    cprox_curve_free(curve);
  }
  cprox_body_free(ball);
}

CASE(where_the_minimiser_is_not_unique_the_flag_says_so) {
  const char *elsewhere = "no gradient: the distance is as small elsewhere along the curve";
  cprox_body *box = NULL, *ball = NULL, *two = NULL;
  assert_int_equal(cprox_body_create_box(vec(2, 2, 2), ws, &box), CPROX_OK);
  assert_int_equal(cprox_body_create_sphere(1.0, ws, &ball), CPROX_OK);
  const cprox_obstacle at = cprox_obstacle_at(box, CPROX_POSE_IDENTITY),
                       round = cprox_obstacle_at(ball, CPROX_POSE_IDENTITY);

  /* along a face; down and up twice; through the body; into it along the diagonal between two faces */
  cprox_curve *parallel = bezier((vec3[]){{-0.5, 0, 2}, {0.5, 0, 2}}, 2);
  cprox_curve *twice = bezier((vec3[]){{-1, 0, 3}, {-1, 0, -1}, {0, 0, 6}, {1, 0, -1}, {1, 0, 3}}, 5);
  cprox_curve *through = bezier((vec3[]){{-2, 0.1, 0.2}, {2, 0.2, 0.3}}, 2);
  cprox_curve *between = bezier((vec3[]){{3, 3, 0.1}, {0.5, 0.5, 0}}, 2);
  assert_none(cprox_point_along(parallel), at, false, elsewhere);
  assert_none(cprox_point_along(twice), at, false, elsewhere);
  assert_none(cprox_point_along(through), at, false, "no gradient: the distance is 0");
  assert_none(cprox_point_along(between), at, true, "no gradient: there is more than one way out");
  assert_none(cprox_point_along(parallel), cprox_obstacle_curve(parallel, 0.0), false,
              "no gradient: there is no normal");

  /* two parts of one target */
  const cprox_pose poses[2] = {{{-2, 0, 0}, {1, 0, 0, 0}}, {{2, 0, 0}, {1, 0, 0, 0}}};
  assert_int_equal(cprox_body_create_compound((const cprox_body *[]){ball, ball}, poses, 2, ws, &two), CPROX_OK);
  cprox_curve *middle = bezier((vec3[]){{0, 0, 0}, {0, 2, 0}}, 2);
  assert_none(cprox_point_along(middle), cprox_obstacle_at(two, CPROX_POSE_IDENTITY), false,
              "no gradient: two parts are equally near");

  /* two points of a cloud; a solid that begins round it */
  const vec3 pair[2] = {{-1, 0, 0}, {1, 0, 0}};
  cprox_body *cloud = NULL;
  assert_int_equal(cprox_body_create_points(pair, 2, 0.1, SIZE_MAX, ws, &cloud), CPROX_OK);
  assert_none(cprox_point_along(middle), cprox_obstacle_at(cloud, CPROX_POSE_IDENTITY), false,
              "no gradient: the nearest points are not the only ones");
  test_mesh mesh = mesh_box(vec(3, 3, 3));
  cprox_body *solid = mesh_body(&mesh, CPROX_MESH_FILL_SOLID, ws);
  mesh_free(&mesh);
  assert_none(cprox_point_along(middle), cprox_obstacle_at(solid, CPROX_POSE_IDENTITY), false,
              "no gradient: the distance is 0");

  /* a plain case, which has one */
  cprox_curve *plain = bezier((vec3[]){{-1, 0, 4}, {0, 0, 1}, {1.5, 0, 4}}, 3);
  cprox_result result;
  cprox_gradient g;
  assert_int_equal(cprox_distance(cprox_point_along(plain), round, NULL, ws, &result), CPROX_OK);
  assert_int_equal(cprox_distance_gradient(cprox_point_along(plain), round, NULL, &result, ws, &g), CPROX_OK);
  assert_true(g.valid && fabs(vec_norm(g.mover) - 1.0) < 1e-12 && g.radius == -1.0 && g.t0 == 0.0 && g.t1 == 0.0);
  assert_string_equal(cprox_workspace_error(ws), "");

  /* a result without a witness */
  const cprox_result none = {.obstacle_index = -1, .upper = INFINITY};
  assert_int_equal(cprox_distance_gradient(cprox_point_along(plain), round, NULL, &none, ws, &g), CPROX_INVALID);
  cprox_curve *curves[] = {parallel, twice, through, between, middle, plain};
  for (size_t i = 0; i < sizeof curves / sizeof *curves; i++) cprox_curve_free(curves[i]);
  cprox_body_free(cloud);
  cprox_body_free(solid);
  cprox_body_free(two);
  cprox_body_free(box);
  cprox_body_free(ball);
}

/* ---- weights ---- */

/* Seed 104, 500 curves a basis: the weighted sum of the coefficients is the point. 1e-11: what the lesser bases lose at
 * degree 9. */
CASE(weighted_coefficients_make_the_point) {
  rng r = rng_seed(104);
  for (size_t k = 0; k < test_cases(3000); k++) {
    const size_t basis = k % 6, n = basis == 5 ? 3 + 2 * rng_index(&r, 3) : 3 + rng_index(&r, 7);
    const double t0 = rng_uniform(&r, -1, 1), t1 = t0 + rng_uniform(&r, 0.5, 1.5), t = rng_uniform(&r, t0, t1);
    vec3 c[10];
    double w[10], knots[16], nodes[10];
    for (size_t i = 0; i < n; i++) {
      c[i] = rng_in_cube(&r, 1.0);
      nodes[i] = t0 + (t1 - t0) * (double)i / (double)(n - 1);
    }
    for (size_t i = 0; i < n + 3; i++) knots[i] = t0 + (t1 - t0) * ((double)i - 2.0) / (double)(n - 2);
    if (n > 3 && rng_index(&r, 2)) knots[3] = knots[2]; /* a double knot at the beginning */
    cprox_curve *curve = NULL;
    cprox_status status = CPROX_INVALID;
    if (basis == 0)
      status = curve_from(describe_bezier(c, n, t0, t1), ws, &curve),
      curve_weights(describe_bezier(NULL, n, t0, t1), t, w);
    if (basis == 1) {
      status = curve_from(describe_bspline(c, n, 2, knots, n + 3, fmax(t0, knots[2]), fmin(t1, knots[n])), ws, &curve);
      curve_weights(describe_bspline(NULL, n, 2, knots, n + 2 + 1, 0.0, 1.0), fmin(fmax(t, knots[2]), knots[n]), w);
    }
    if (basis == 2)
      status = curve_from(describe_polynomial(c, n, t0, t1), ws, &curve),
      curve_weights(describe_polynomial(NULL, n, 0.0, 1.0), t, w);
    if (basis == 3)
      status = curve_from(describe_legendre(c, n, t0, t1), ws, &curve),
      curve_weights(describe_legendre(NULL, n, t0, t1), t, w);
    if (basis == 4)
      status = curve_from(describe_lagrange(c, nodes, n, t0, t1), ws, &curve),
      curve_weights(describe_lagrange(NULL, nodes, n, 0.0, 1.0), t, w);
    if (basis == 5)
      status = curve_from(describe_trigonometric(c, n, t0, t1), ws, &curve),
      curve_weights(describe_trigonometric(NULL, n, 0.0, 1.0), t, w);
    if (status != CPROX_OK) fail_msg("basis %zu: %s", basis, cprox_workspace_error(ws));
    vec3 at, sum = vec(0, 0, 0);
    double u0, u1;
    u0 = cprox_curve_get_info(curve).t0, u1 = cprox_curve_get_info(curve).t1;
    assert_int_equal(cprox_curve_evaluate(curve, fmin(fmax(t, u0), u1), ws, &at, NULL, NULL), CPROX_OK);
    for (size_t i = 0; i < n; i++) sum = vec_axpy(sum, w[i], c[i]);
    if (!(vec_norm(vec_sub(at, sum)) < 1e-11))
      fail_msg("basis %zu, n %zu: off by %g", basis, n, vec_norm(vec_sub(at, sum)));
    cprox_curve_free(curve);
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
