/* SPDX-License-Identifier: BSD-3-Clause */
/* Motions of many segments: what is said of spans of them, against long double. Random robots with every type of joint
 * go along paths that are straight, dithered, kinked, stepped, smooth, back and forth, at even and at wild times. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "kinematics/bound.h"
#include "shape/body.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/of_list.h"
#include "support/robots.h"

enum { MAX_AXES = 4 * TEST_MAX_LINKS, MOST_DEGREE = 9 };

/* ---- paths ---- */

typedef enum path_shape { STRAIGHT, DITHERED, KINKED, STEPPED, SMOOTH, BACK_AND_FORTH, PATH_SHAPES } path_shape;
typedef enum path_times { EVEN, UNEVEN, SINCE_1970, NEARLY_EQUAL, PATH_TIMES } path_times;

typedef struct path {
  test_robot t;
  size_t n, points, degree; /* degree of a B-spline; 0: waypoints */
  cprox_interpolation interpolation;
  double *times, *values, *velocities, *accelerations; /* times or knots */
  cprox_motion *motion;
} path;

static void choose_times(rng *r, path *p, path_times times, size_t count) {
  double at = times == SINCE_1970 ? 1.7e9 + rng_uniform(r, 0, 1) : rng_uniform(r, -1, 1);
  size_t same = 0;
  for (size_t i = 0; i < count; i++) {
    p->times[i] = at;
    same = p->degree > 1 && rng_index(r, 8) == 0 && same + 1 < p->degree ? same + 1 : 0;
    if (same > 0) continue; /* knots may stand together */
    if (times == EVEN) at += 0.125;
    if (times == UNEVEN) at += rng_log_uniform(r, 1e-6, 10);
    if (times == SINCE_1970) at += rng_uniform(r, 0.5e-3, 1.5e-3);
    if (times == NEARLY_EQUAL) at = rng_index(r, 3) ? nextafter(at, INFINITY) : at + rng_uniform(r, 0, 1);
  }
}

static void choose_values(rng *r, path *p, path_shape shape, double speed) {
  for (size_t k = 0; k < p->n; k++) {
    const double from = p->t.rest[k], way = rng_uniform(r, -speed, speed), noise = rng_log_uniform(r, 1e-9, 1e-2);
    const double turns = rng_uniform(r, 1, 9);
    double walked = 0.0;
    for (size_t i = 0; i < p->points; i++) {
      const double s = (double)i / (double)(p->points - 1);
      double value = from + s * way;
      if (shape == DITHERED) value += rng_uniform(r, -noise, noise);
      if (shape == KINKED) value = from + (walked += rng_uniform(r, -speed, speed) / sqrt((double)p->points));
      if (shape == STEPPED) value = from + (walked += rng_index(r, 9) == 0 ? rng_uniform(r, -speed, speed) / 4 : 0.0);
      if (shape == SMOOTH) value = from + way * sin(turns * s);
      if (shape == BACK_AND_FORTH) value = from + way * fabs(fmod(turns * s, 2.0) - 1.0);
      p->values[i * p->n + k] = value;
      /* velocities times durations are of the size of a step: those of the longer segment beside the waypoint */
      double h = 0.0;
      if (i + 1 < p->points) h = p->times[i + 1] - p->times[i];
      if (i > 0) h = fmax(h, p->times[i] - p->times[i - 1]);
      const double step = shape == STRAIGHT ? way / (double)p->points : rng_uniform(r, -1, 1) / (double)p->points;
      p->velocities[i * p->n + k] = p->degree == 0 && rng_index(r, 4) ? step / h : 0.0;
      p->accelerations[i * p->n + k] = p->degree > 0 || rng_index(r, 4) ? 0.0 : step / h / h;
    }
  }
  /* quaternions stay away from 0: their real part is large */
  for (size_t l = 0; l < p->t.n_links; l++)
    for (size_t i = 0; i < p->points && p->t.links[l].type == CPROX_JOINT_FLOATING; i++)
      p->values[i * p->n + (size_t)p->t.links[l].variable + 6] += rng_index(r, 2) ? 5.0 : 8.0;
}

static bool make_motion(path *p) {
  cprox_waypoint *list = calloc(p->points, sizeof *list);
  for (size_t i = 0; i < p->points; i++)
    list[i] =
        (cprox_waypoint){p->times[i], p->values + i * p->n, p->velocities + i * p->n, p->accelerations + i * p->n};
  const cprox_motion_description d = {.kind = p->degree ? CPROX_MOTION_BSPLINE : CPROX_MOTION_WAYPOINTS,
                                      .variables = p->t.variables,
                                      .n_variables = p->n,
                                      .rest = p->t.rest,
                                      .waypoints = list,
                                      .n_waypoints = p->points,
                                      .interpolation = p->interpolation,
                                      .control = p->values,
                                      .n_control = p->points,
                                      .degree = p->degree,
                                      .knots = p->times,
                                      .n_knots = p->points + p->degree + 1};
  p->motion = NULL;
  const cprox_status status = cprox_motion_create(p->t.robot, &d, ws, &p->motion);
  free(list);
  return status == CPROX_OK;
}

static void path_free(path *p) {
  cprox_motion_free(p->motion);
  robot_free(&p->t);
  free(p->times);
  free(p->values);
  free(p->velocities);
  free(p->accelerations);
}

/* False where the core refuses it: a quaternion came near 0. */
static bool path_make(rng *r, size_t points, path_shape shape, path_times times, double speed, path *p) {
  *p = (path){.points = points};
  robot_make(r, 1.0, &p->t);
  p->n = p->t.n_variables;
  p->degree = rng_index(r, 3) == 0 ? 1 + rng_index(r, MOST_DEGREE) : 0;
  p->interpolation = (cprox_interpolation)(CPROX_INTERPOLATION_LINEAR + rng_index(r, 3));
  if (p->points < p->degree + 2) p->points = p->degree + 2;
  const size_t size = p->points * (p->n + 1);
  p->times = calloc(p->points + p->degree + 1, sizeof(double));
  p->values = calloc(size, sizeof(double));
  p->velocities = calloc(size, sizeof(double));
  p->accelerations = calloc(size, sizeof(double));
  choose_times(r, p, times, p->points + p->degree + 1);
  choose_values(r, p, shape, speed);
  return make_motion(p);
}

static path any_path(rng *r, size_t most) {
  path p;
  while (!path_make(r, 3 + rng_index(r, most), (path_shape)rng_index(r, PATH_SHAPES),
                    (path_times)rng_index(r, PATH_TIMES), rng_log_uniform(r, 0.02, 2), &p))
    path_free(&p);
  return p;
}

/* All variables at u of a segment of the core's motion, in long double from what was given. */
static void path_values(const path *p, size_t segment, long double u, long double *out) {
  const long double t0 = p->motion->times[segment], t1 = p->motion->times[segment + 1]; /* differences are exact */
  const double *x = p->times;
  const size_t d = p->degree, n = p->n;
  size_t span = d;
  while (d && !(x[span] == p->motion->times[segment] && x[span] < x[span + 1])) span++;
  for (size_t k = 0; k < n; k++) {
    if (d) {
      long double c[MOST_DEGREE + 1];
      for (size_t i = 0; i <= d; i++) c[i] = p->values[(span - d + i) * n + k];
      for (size_t r = 1; r <= d; r++)
        for (size_t i = d; i >= r; i--) {
          const long double left = x[span - d + i], right = x[i + 1 + span - r];
          const long double s = (t0 - left + u * (t1 - t0)) / (right - left);
          c[i] = (1 - s) * c[i - 1] + s * c[i];
        }
      out[k] = c[d];
      continue;
    }
    const size_t i = segment * n + k;
    const long double h = t1 - t0, a = p->values[i], b = p->values[i + n];
    const long double v = h * p->velocities[i], w = h * p->velocities[i + n], u2 = u * u, u3 = u2 * u;
    const long double e = h * h * p->accelerations[i], f = h * h * p->accelerations[i + n], u4 = u3 * u, u5 = u4 * u;
    out[k] = a + u * (b - a);
    if (p->interpolation == CPROX_INTERPOLATION_CUBIC)
      out[k] = (2 * u3 - 3 * u2 + 1) * a + (u3 - 2 * u2 + u) * v + (3 * u2 - 2 * u3) * b + (u3 - u2) * w;
    if (p->interpolation == CPROX_INTERPOLATION_QUINTIC)
      out[k] = (1 - 10 * u3 + 15 * u4 - 6 * u5) * a + (u - 6 * u3 + 8 * u4 - 3 * u5) * v +
               (u2 / 2 - 1.5L * u3 + 1.5L * u4 - u5 / 2) * e + (10 * u3 - 15 * u4 + 6 * u5) * b +
               (-4 * u3 + 7 * u4 - 3 * u5) * w + (u3 / 2 - u4 + u5 / 2) * f;
  }
}

/* ---- bounds ---- */

enum { COMBINATIONS = 12, SPANS = 12, SAMPLES = 7, TURNS = 12 };

/* One geometry seen from another one or from the world, and what the core says of it. */
typedef struct claim {
  size_t moving;
  int standing; /* -1: the world */
  vec3 n, drift;
  chain_motion motion;
  double second, both;
  vec3l middle[TEST_VERTICES];
} claim;

static motion_interval any_span(rng *r, const cprox_motion *m) {
  motion_interval over = {.a = 0.0, .b = 1.0};
  over.first = rng_index(r, m->n_segments - 1);
  const size_t most = m->n_segments - over.first - 1;
  over.last = over.first + 2 + (rng_index(r, 2) ? rng_index(r, most) : rng_index(r, most < 6 ? most : 6));
  if (rng_index(r, 8) == 0) over.first = 0, over.last = m->n_segments;
  if (rng_index(r, 3) == 0) over.a = rng_uniform(r, 0, 1);
  if (rng_index(r, 3) == 0) over.b = rng_uniform(r, 0, 1);
  return over;
}

static void find_claim(rng *r, const path *p, const axis_state *axes, claim *c) {
  const cprox_robot *robot = p->t.robot;
  *c = (claim){.moving = rng_index(r, p->t.n_links), .standing = -1, .n = rng_unit(r)};
  if (rng_index(r, 2)) c->standing = (int)rng_index(r, p->t.n_links);
  c->n = vec_scale(1.0 / vec_norm(c->n), c->n);
  if (rng_index(r, 2)) c->drift = vec_scale(rng_log_uniform(r, 1e-3, 0.5), rng_unit(r));
  c->drift = vec_axpy(c->drift, -vec_dot(c->drift, c->n), c->n);

  double scratch[MAX_AXES];
  chain_axis chain[MAX_AXES];
  placement frames[MAX_AXES + 1];
  for (size_t i = 0; i < robot->n_axes; i++) frames[i] = axes[i].frame;
  const robot_part *part = &robot->parts[c->moving];
  const placement at = placement_under(frames, part->axis, &part->at);
  const double error = p->motion->part_error[c->moving];
  const size_t length =
      motion_chain(p->motion, c->standing < 0 ? -1 : robot->parts[c->standing].axis, part->axis, chain);
  motion_of_part(axes, chain, length, at.p, part->model.radius + error, scratch, &c->motion);
  cprox_body *origin;
  assert_int_equal(cprox_body_create_point(vec(0, 0, 0), NULL, &origin), CPROX_OK);
  const bound_side moving = {.shape = part->model.shape,
                             .at = at,
                             .margin = part->model.margin,
                             .error = error,
                             .middle = part->model.middle,
                             .half = part->model.half};
  const bound_side standing = {.shape = &origin->shape,
                               .at = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}},
                               .error = c->standing < 0 ? 0.0 : p->motion->part_error[c->standing]};
  const uint32_t steps = part->steps + (c->standing < 0 ? 0 : robot->parts[c->standing].steps);
  double slack;
  const double heights[2] = {bound_height(&standing, vec_axpy(c->n, -0.5, c->drift)),
                             bound_height(&standing, vec_axpy(c->n, 0.5, c->drift))};
  c->second = motion_plane_bound(&c->motion, &moving, &standing, c->n, c->drift, heights, steps, -INFINITY, &slack);
  c->both = motion_plane_bound(&c->motion, &moving, &standing, c->n, c->drift, heights, steps, INFINITY, &slack);
  cprox_body_free(origin);
}

/* The vertices of the moving geometry as the standing one sees them, brought to where that is in the middle. */
static void seen(const path *p, const claim *c, const ref_pose *links, const ref_pose *middle, vec3l *out) {
  robot_ref_vertices(&p->t, links, c->moving, out);
  for (size_t v = 0; v < TEST_VERTICES && c->standing >= 0; v++)
    out[v] = ref_pose_apply(&middle[c->standing], ref_pose_undo(&links[c->standing], out[v]));
}

/* The best of planes that turn: which one the bound means is not known. A step of the turn can miss it by its part of
 * the drift. */
static long double height(const path *p, const claim *c, const vec3l *x) {
  const int turns = vec_norm2(c->drift) > 0.0 ? TURNS : 0;
  long double best = -HUGE_VALL;
  for (int k = 0; k <= turns; k++) {
    const vec3l n = ref_add(ref_vec(c->n), ref_scale(turns ? (long double)k / turns - 0.5L : 0.0L, ref_vec(c->drift)));
    long double least = HUGE_VALL;
    for (size_t v = 0; v < TEST_VERTICES; v++)
      least = fminl(least, ref_dot(n, x[v]) / ref_norm(n) - p->t.margin +
                               (turns ? ref_norm(ref_vec(c->drift)) * ref_norm(x[v]) / turns : 0.0L));
    best = fmaxl(best, least);
  }
  return best;
}

CASE(no_point_is_nearer_than_spans_say) {
  rng r = rng_seed(4420);
  size_t checks = 0, straight = 0, spans = 0;
  double nearest = 0.0;
  for (size_t i = 0; i < test_cases(720); i++) {
    path p = any_path(&r, i % 8 == 0 ? 300 : 40);
    for (int s = 0; s < SPANS && p.motion->n_segments > 1; s++) {
      const motion_interval over = any_span(&r, p.motion);
      double rows[MOTION_ROWS * (TEST_MAX_VARIABLES + MOTION_LANES)];
      axis_state axes[MAX_AXES + 1];
      const span_centre centre = motion_span_node(p.motion, &over, rows, axes);
      const size_t stride = p.motion->row_size;
      straight += !centre.bent, spans++;
      assert_true(centre.segment >= over.first && centre.segment < over.last);
      assert_true(centre.segment > over.first || centre.u >= over.a);
      assert_true(centre.segment + 1 < over.last || centre.u <= over.b);
      claim claims[COMBINATIONS];
      long double values[TEST_MAX_VARIABLES + 1];
      ref_pose middle[TEST_MAX_LINKS], links[TEST_MAX_LINKS];
      path_values(&p, centre.segment, centre.u, values);
      robot_ref_links(&p.t, values, middle);
      for (int k = 0; k < COMBINATIONS; k++) {
        find_claim(&r, &p, axes, &claims[k]);
        seen(&p, &claims[k], middle, middle, claims[k].middle);
        checks++;
      }
      for (int k = 0; k <= SAMPLES; k++) {
        size_t segment = over.first + rng_index(&r, over.last - over.first);
        if (k < 2) segment = k == 0 ? over.first : over.last - 1;
        const double low = segment == over.first ? over.a : 0.0, high = segment + 1 == over.last ? over.b : 1.0;
        const double u = k == 0 ? low : k == 1 || rng_index(&r, 4) == 0 ? high : rng_uniform(&r, low, high);
        path_values(&p, segment, u, values);
        robot_ref_links(&p.t, values, links);
        for (size_t j = 0; j < p.motion->tracks->n_moving; j++) {
          const long double way = fabsl(values[p.motion->tracks->moving[j]] - rows[j]);
          const double said = rows[MOTION_SHIFT * stride + j];
          if (way > said) fail_msg("path %zu: a variable goes %.17Lg, said to be %.17g at most", i, way, said);
          nearest = fmax(nearest, (double)way / said);
        }
        for (int c = 0; c < COMBINATIONS; c++) {
          vec3l x[TEST_VERTICES];
          seen(&p, &claims[c], links, middle, x);
          const long double high_enough = height(&p, &claims[c], x);
          if (high_enough < claims[c].second || high_enough < claims[c].both)
            fail_msg("path %zu span %d: height %.17Lg below the bounds %.17g, %.17g", i, s, high_enough,
                     claims[c].second, claims[c].both);
          for (size_t v = 0; v < TEST_VERTICES; v++) {
            const long double way = ref_norm(ref_sub(x[v], claims[c].middle[v]));
            if (way > claims[c].motion.displacement + 1e-15L)
              fail_msg("path %zu span %d: travels %.17Lg, said to be %.17g at most", i, s, way,
                       claims[c].motion.displacement);
          }
        }
      }
    }
    path_free(&p);
  }
  print_message("%zu checks of %zu spans, %zu of them straight; largest way of a variable / bound: %.4f\n", checks,
                spans, straight, nearest);
  assert_true(straight > spans / 10 && nearest > 0.99);
}

/* ---- queries ---- */

/* The distance of a point from the robot, in long double. */
static long double distance_at(const path *p, size_t segment, long double u, vec3 point) {
  long double values[TEST_MAX_VARIABLES + 1], least = HUGE_VALL;
  ref_pose links[TEST_MAX_LINKS];
  path_values(p, segment, u, values);
  robot_ref_links(&p->t, values, links);
  for (size_t g = 0; g < p->t.n_links; g++) {
    vec3l exact[TEST_VERTICES];
    vec3 v[TEST_VERTICES];
    robot_ref_vertices(&p->t, links, g, exact);
    for (size_t k = 0; k < TEST_VERTICES; k++) v[k] = vec((double)exact[k].x, (double)exact[k].y, (double)exact[k].z);
    least = fminl(least, fmaxl(ref_point_hull(ref_vec(point), v, TEST_VERTICES) - p->t.margin, 0.0L));
  }
  return least;
}

CASE(no_sample_of_a_long_motion_is_nearer_than_lower) {
  rng r = rng_seed(4421);
  enum { LOOKS = 40 };
  for (size_t i = 0; i < test_cases(80); i++) {
    path p = any_path(&r, i % 8 == 0 ? 3000 : 200);
    const vec3 point = rng_in_cube(&r, 2.0);
    cprox_body *body;
    assert_int_equal(cprox_body_create_point(point, ws, &body), CPROX_OK);
    const cprox_obstacle target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
    const cprox_mover mover = cprox_robot_along(p.motion, NULL, 0);
    cprox_result d, first, clear;
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-5;
    assert_true(distance_of_list(mover, &target, 1, &options, ws, &d, NULL) >= 0);
    if (d.status != CPROX_OK) fail_msg("path %zu: %s", i, cprox_workspace_error(ws));
    if (d.obstacle_index >= 0) {
      assert_true(time_of_contact_of_list(mover, &target, 1, &options, ws, &first) >= 0);
      assert_true(tolerance_of_list(mover, &target, 1, 0.9 * d.lower, &options, ws, &clear, NULL) >= 0);
      if (d.lower > 0.0) assert_int_equal(clear.verdict, CPROX_VERDICT_CLEAR);
      if (d.lower > 0.0) assert_int_equal(first.verdict, CPROX_VERDICT_CLEAR);
      if (first.verdict == CPROX_VERDICT_VIOLATED) assert_true(first.t >= first.t_contact_lower && d.upper <= 0.0);
      for (int k = 0; k < LOOKS; k++) {
        const size_t segment = rng_index(&r, p.motion->n_segments);
        const double u = rng_index(&r, 3) ? rng_uniform(&r, 0, 1) : 0.0;
        const long double at = distance_at(&p, segment, u, point);
        if (at < d.lower)
          fail_msg("path %zu: %.12Lg in segment %zu at %.12g, lower is %.12g", i, at, segment, u, d.lower);
        if (at <= 0.0L && motion_time(p.motion, segment, u) < first.t_contact_lower)
          fail_msg("path %zu: contact at %.12g, late at %.12g", i, motion_time(p.motion, segment, u),
                   first.t_contact_lower);
      }
      /* steep segments magnify the rounding of times; a place within one that is an ulp long has no time of its own */
      const size_t segment = motion_segment_at(p.motion, d.t);
      const double *times = p.motion->times, t0 = times[segment], h = times[segment + 1] - t0;
      const double shortest = segment > 0 ? fmin(h, t0 - times[segment - 1]) : h;
      if (shortest > 1e-7 * fmax(1.0, fabs(t0)))
        assert_true(distance_at(&p, segment, ((long double)d.t - t0) / h, point) <= d.upper + 1e-6L);
    }
    cprox_body_free(body);
    path_free(&p);
  }
}

/* ---- cost ---- */

/* The same straight motion with more and more waypoints takes as many nodes and distance queries as with two. */
CASE(waypoints_on_a_line_cost_next_to_nothing) {
  static const size_t COUNTS[] = {2, 1000, 10000, 100000};
  enum { ROBOTS = 6, QUERIES = 3 };
  uint64_t nodes[QUERIES][4] = {{0}}, measured[QUERIES][4] = {{0}};
  for (int c = 0; c < 4; c++) {
    for (int i = 0; i < ROBOTS; i++) {
      rng r = rng_seed(4430 + (uint64_t)i);
      path p;
      const size_t size = COUNTS[c];
      p = (path){.points = size, .interpolation = CPROX_INTERPOLATION_LINEAR};
      robot_make(&r, 1.0, &p.t);
      p.n = p.t.n_variables;
      const vec3 point = rng_in_cube(&r, 2.0);
      p.times = calloc(size, sizeof(double));
      p.values = calloc(size * (p.n + 1), sizeof(double));
      p.velocities = calloc(size * (p.n + 1), sizeof(double));
      p.accelerations = calloc(size * (p.n + 1), sizeof(double));
      for (size_t k = 0; k < p.n; k++) {
        const double way = rng_uniform(&r, -1, 1);
        const bool real = p.t.positions[0][k] > 2.5; /* a quaternion's */
        for (size_t s = 0; s < size; s++)
          p.values[s * p.n + k] = (real ? 5.0 : p.t.rest[k]) + way * (double)s / (double)(size - 1);
      }
      for (size_t s = 0; s < size; s++) p.times[s] = 10.0 * (double)s / (double)(size - 1);
      cprox_body *body;
      assert_int_equal(cprox_body_create_point(point, ws, &body), CPROX_OK);
      const cprox_obstacle target = cprox_obstacle_at(body, CPROX_POSE_IDENTITY);
      assert_true(make_motion(&p));
      const cprox_mover mover = cprox_robot_along(p.motion, NULL, 0);
      cprox_result result[QUERIES];
      assert_int_equal(distance_of_list(mover, &target, 1, NULL, ws, &result[0], NULL), CPROX_OK);
      assert_true(tolerance_of_list(mover, &target, 1, 0.99 * result[0].lower, NULL, ws, &result[1], NULL) >= 0);
      assert_true(time_of_contact_of_list(mover, &target, 1, NULL, ws, &result[2]) >= 0);
      for (int q = 0; q < QUERIES; q++) nodes[q][c] += result[q].nodes, measured[q][c] += result[q].distance_queries;
      cprox_body_free(body);
      path_free(&p);
    }
    for (int q = 0; q < QUERIES; q++) {
      print_message("%zu waypoints, query %d: %g nodes, %g distances\n", COUNTS[c], q, (double)nodes[q][c],
                    (double)measured[q][c]);
      assert_true((double)nodes[q][c] <= 1.3 * (double)nodes[q][0]);
      assert_true((double)measured[q][c] <= 1.3 * (double)measured[q][0]);
    }
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
