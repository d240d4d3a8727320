/* SPDX-License-Identifier: BSD-3-Clause */
/* Bounds by control poses: of bodies on pose splines of every kind, against what stands and against each other, over
 * intervals of a segment, against the vertices in long double. */
#include <math.h>

#include "robot_query/flight.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/robots.h"

enum { SAMPLES = 24, TURNINGS = 3 };

/* Every kind of joint, small and large turns; the first links hang on the world. */
static void any_robot(rng *r, size_t i, test_robot *t) {
  *t = (test_robot){0};
  const double size = rng_log_uniform(r, rng_index(r, 3) ? 0.02 : 1e-9, 4);
  robot_make_turning(r, size, (cprox_turning)(i % TURNINGS), 2 + rng_index(r, 4), t);
}

static void links_at(const test_robot *t, size_t segment, long double u, ref_pose *links) {
  const long double t0 = t->motion->times[segment], t1 = t->motion->times[segment + 1];
  long double values[TEST_MAX_VARIABLES + 1];
  robot_ref_values(t, (1 - u) * t0 + u * t1, values);
  robot_ref_links(t, values, links);
}

static robot_body body_of(const test_robot *t, size_t part) {
  const part_model *m = &t->robot->parts[part].model;
  return (robot_body){.side = {.shape = m->shape,
                               .margin = m->margin,
                               .error = t->motion->part_error[part],
                               .middle = m->middle,
                               .half = m->half},
                      .radius = m->radius,
                      .part = (int32_t)part};
}

typedef struct bound_case {
  flight f;
  size_t moving;
  int standing; /* -1: a point of the world */
  vec3 point;
  flight_plane plane;
  double from, to;
  flight_bound stands, turns;
} bound_case;

/* The distance along the plane's normal, and less both margins, of all vertices. */
static long double distance_along(const test_robot *t, const bound_case *c, long double x, bool turning) {
  ref_pose links[TEST_MAX_LINKS];
  vec3l seen[2][TEST_VERTICES];
  links_at(t, c->f.segment, c->f.a + ((long double)c->f.b - c->f.a) * x, links);
  robot_ref_vertices(t, links, c->moving, seen[0]);
  const long double away = turning ? x - c->plane.at : 0;
  const vec3l n = ref_add(ref_vec(c->plane.n), ref_scale(away, ref_vec(c->plane.rate)));
  long double low = INFINITY, high = -INFINITY;
  if (c->standing >= 0) robot_ref_vertices(t, links, (size_t)c->standing, seen[1]);
  for (size_t v = 0; v < TEST_VERTICES; v++) {
    low = fminl(low, ref_dot(n, seen[0][v]) / ref_norm(n));
    if (c->standing >= 0) high = fmaxl(high, ref_dot(n, seen[1][v]) / ref_norm(n));
  }
  if (c->standing < 0) high = ref_dot(n, ref_vec(c->point)) / ref_norm(n);
  return low - high - t->margin * (c->standing >= 0 ? 2 : 1);
}

CASE(no_vertex_is_nearer_than_control_poses_say) {
  rng r = rng_seed(7301);
  size_t bounds = 0, refused = 0;
  double tightest = INFINITY;
  cprox_body *origin;
  assert_int_equal(cprox_body_create_point(vec(0, 0, 0), NULL, &origin), CPROX_OK);
  for (size_t i = 0; i < test_cases(600); i++) {
    test_robot t;
    any_robot(&r, i, &t);
    for (int k = 0; k < 24; k++) {
      bound_case c = {.moving = rng_index(&r, t.n_links), .standing = -1};
      if (rng_index(&r, 2)) c.standing = (int)rng_index(&r, t.n_links);
      if (c.standing == (int)c.moving) continue;
      const size_t segment = rng_index(&r, t.motion->n_segments);
      const double width = rng_index(&r, 3) ? rng_log_uniform(&r, 1e-3, 1.0) : 1.0, a = rng_uniform(&r, 0, 1.0 - width);
      const motion_interval over = {.a = a, .b = fmin(a + width, 1.0), .first = segment, .last = segment + 1};
      robot_body moving = body_of(&t, c.moving), standing = {.side = {.shape = &origin->shape}};
      c.point = rng_in_cube(&r, 2.0);
      standing.side.at = (placement){.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .p = c.point};
      if (c.standing >= 0) standing = body_of(&t, (size_t)c.standing);
      const robot_body *const body[2] = {&moving, &standing};
      const double tolerance = rng_log_uniform(&r, 1e-10, 1e-2);
      if (!flight_begin(&c.f, t.motion, body, c.standing >= 0, &over, tolerance, ws)) {
        refused++;
        continue;
      }
      assert_true(c.f.error <= 5.0 * tolerance);
      vec3 n = rng_unit(&r);
      n = vec_scale(1.0 / vec_norm(n), n);
      flight_plane_make(&c.f, n, rng_uniform(&r, 0, 1), &c.plane);
      vec3 rate = vec_scale(rng_log_uniform(&r, 1e-3, 0.5), rng_unit(&r));
      rate = vec_axpy(rate, -vec_dot(rate, n), n);
      flight_plane_turn(&c.f, rate, &c.plane);
      c.from = rng_index(&r, 2) ? 0.0 : rng_uniform(&r, 0, 1),
      c.to = rng_index(&r, 2) ? 1.0 : rng_uniform(&r, c.from, 1);
      const double level = rng_uniform(&r, -2, 1), goal = rng_index(&r, 2) ? INFINITY : rng_uniform(&r, -2, 2);
      flight_bound_over(&c.f, &c.plane, false, c.from, c.to, goal, level, &c.stands);
      flight_bound_over(&c.f, &c.plane, true, c.from, c.to, goal, level, &c.turns);
      bounds += 2;
      for (int turning = 0; turning < 2; turning++) {
        const flight_bound *bound = turning ? &c.turns : &c.stands;
        long double least = INFINITY;
        for (int s = 0; s <= 2 * SAMPLES; s++) {
          /* half of them where the distance is clear of the level, up to the very end of that */
          const long double part = s <= SAMPLES ? (long double)s / SAMPLES
                                                : bound->clear * (1 - (long double)(s - SAMPLES - 1) / SAMPLES),
                            x = c.from + ((long double)c.to - c.from) * part;
          const long double d = distance_along(&t, &c, x, turning);
          least = fminl(least, d);
          if (d < bound->lower || (part <= bound->clear && bound->clear > 0.0 && d < level && level > 0.0))
            fail_msg("robot %zu, bound %d: distance %.17Lg at %.3Lg, bound %.17g, at least %.17g up to %.3g", i,
                     turning, d, part, bound->lower, level, bound->clear);
        }
        if (!turning && isinf(goal)) tightest = fmin(tightest, (double)least - bound->lower);
      }
    }
    robot_free(&t);
  }
  cprox_body_free(origin);
  print_message("%zu bounds, %zu pairs of another kind, tightest %.3g\n", bounds, refused, tightest);
  assert_true(bounds > 4 * test_cases(600) && tightest < 1e-3);
}

/* ---- the search ---- */

static const cprox_pose HERE = {.orientation = {.w = 1.0}};
static const int32_t SIX[6] = {0, 1, 2, 3, 4, 5};

typedef struct turning_box {
  cprox_body *body, *other;
  cprox_robot *robot;
  cprox_motion *motion;
  cprox_obstacle target;
} turning_box;

/* A box along a Bézier curve of rotation vectors and places, beside another box. */
static void turning_box_make(double control[4][6], cprox_pose at, turning_box *t) {
  static const double KNOTS[8] = {0, 0, 0, 0, 1, 1, 1, 1};
  const cprox_link link = {.parent = -1, .type = CPROX_JOINT_ROTATION_VECTOR, .origin = HERE};
  assert_int_equal(cprox_body_create_box(vec(1, 1, 1), ws, &t->body), CPROX_OK);
  assert_int_equal(cprox_body_create_box(vec(1, 1, 1), ws, &t->other), CPROX_OK);
  const cprox_link_geometry geometry = {.body = t->body, .pose = HERE};
  assert_int_equal(cprox_robot_create(&link, 1, &geometry, 1, 6, ws, &t->robot), CPROX_OK);
  const cprox_motion_description d = {.kind = CPROX_MOTION_BSPLINE,
                                      .variables = SIX,
                                      .n_variables = 6,
                                      .control = control[0],
                                      .n_control = 4,
                                      .degree = 3,
                                      .knots = KNOTS,
                                      .n_knots = 8};
  assert_int_equal(cprox_motion_create(t->robot, &d, ws, &t->motion), CPROX_OK);
  t->target = cprox_obstacle_at(t->other, at);
}

static void turning_box_free(turning_box *t) {
  cprox_motion_free(t->motion);
  cprox_robot_free(t->robot);
  cprox_body_free(t->body);
  cprox_body_free(t->other);
}

/* Its corner is lowest, straight above the other box, in the middle. */
CASE(a_box_that_turns_by_a_right_angle_is_answered_on_one_node) {
  double control[4][6] = {{-2, 2, 0}, {-2, -2, 0}, {2, -2, 0}, {2, 2, 0}};
  for (int i = 0; i < 4; i++) control[i][5] = acos(0.0) * i / 3.0;
  turning_box t;
  turning_box_make(control, (cprox_pose){.position = {0.3, -3, 0.2}, .orientation = {.w = 1.0}}, &t);
  cprox_result r;
  const cprox_mover mover = cprox_robot_along(t.motion, NULL, 0);
  assert_int_equal(distance_of_list(mover, &t.target, 1, NULL, ws, &r, NULL), CPROX_OK);
  assert_true(fabs(r.upper - (1.5 - sqrt(0.5))) < 1e-12 && r.upper - r.lower <= 1e-6 && fabs(r.t - 0.5) < 1e-6);
  assert_true(r.nodes == 1 && r.distance_queries <= 3);
  turning_box_free(&t);
}

/* Where it is at a time. */
static cprox_result still_distance(const turning_box *t, double time) {
  double v[6];
  cprox_motion_evaluate(t->motion, time, v);
  const double angle = sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5]), s = angle > 0.0 ? sin(angle / 2) / angle : 0.5;
  const cprox_pose at = {.position = {v[0], v[1], v[2]},
                         .orientation = {.w = cos(angle / 2), .x = s * v[3], .y = s * v[4], .z = s * v[5]}};
  cprox_options o = CPROX_OPTIONS_DEFAULT;
  o.epsilon = 1e-9;
  cprox_result r;
  assert_true(cprox_pair(cprox_obstacle_at(t->body, at), t->target, &o, ws, &r) >= 0);
  return r;
}

/* Any turns, corners and edges beside corners and edges: against the same distance at many times. */
CASE(boxes_that_turn_are_answered_in_few_intervals) {
  enum { TIMES = 400 };
  rng r = rng_seed(7302);
  size_t nodes = 0, distances = 0, most = 0;
  for (size_t i = 0; i < test_cases(200); i++) {
    double control[4][6];
    const vec3 a = rng_in_cube(&r, 3.0), turn = rng_in_cube(&r, 1.5);
    for (int k = 0; k < 4; k++) {
      const vec3 at = vec_add(a, rng_in_cube(&r, 2.0)), bent = vec_axpy(turn, 0.3 * k, rng_in_cube(&r, 1.0));
      const double row[6] = {at.x, at.y, at.z, bent.x, bent.y, bent.z};
      for (int j = 0; j < 6; j++) control[k][j] = row[j];
    }
    turning_box t;
    turning_box_make(control, (cprox_pose){.orientation = rng_quat(&r)}, &t);
    const cprox_mover mover = cprox_robot_along(t.motion, NULL, 0);
    cprox_result answer;
    assert_int_equal(distance_of_list(mover, &t.target, 1, NULL, ws, &answer, NULL), CPROX_OK);
    nodes += answer.nodes, distances += answer.distance_queries;
    most = answer.nodes > most ? answer.nodes : most;
    assert_true(answer.upper - answer.lower <= 1e-6);
    for (int k = 0; k <= TIMES + 1; k++) {
      const bool where_least = k > TIMES;
      const cprox_result there = still_distance(&t, where_least ? answer.t : (double)k / TIMES);
      if (fmax(there.upper, 0.0) < answer.lower)
        fail_msg("boxes %zu: %.12g at time %d, answer %.12g", i, there.upper, k, answer.lower);
      assert_true(!where_least || there.lower <= answer.upper + 1e-12);
    }
    turning_box_free(&t);
  }
  print_message("%zu boxes: %zu nodes, at most %zu; %zu distances\n", test_cases(200), nodes, most, distances);
  assert_true(nodes <= 8 * test_cases(200) && distances <= 10 * test_cases(200) && most <= 40);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
