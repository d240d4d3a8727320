/* SPDX-License-Identifier: BSD-3-Clause */
/* Witness points of ill-conditioned implicit bodies: plates down to 1e-8 of their width, turned, so that a computed
 * constraint says little about where a point is (`give` is up to 1e-6 of the size). In every query the witness points
 * lie in their bodies by constraints in long double, and are as far apart as `upper`. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/of_list.h"
#include "support/random.h"
#include "support/reference.h"

enum { PLANES, POWERS, BALL_AND_PLANES, FORMS };

static const cprox_pose HERE = {.orientation = {.w = 1.0}};

/* Points of the world are rounded to double, and so are poses: 1e1 m, a few times 1e-16. */
static const long double ROOM = 1e-14L;

typedef struct plate {
  int form;
  double row[3][3], half[3], p;
  cprox_body *body;
} plate;

static void plate_make(rng *r, plate *b) {
  b->form = (int)rng_index(r, FORMS);
  b->half[0] = 1.0, b->half[1] = rng_uniform(r, 0.3, 1.0),
  b->half[2] = rng_log_uniform(r, b->form == POWERS ? 1e-8 : 1e-6, 1e-2);
  b->p = rng_uniform(r, 1.5, 6.0);
  const cprox_pose turned = {.orientation = rng_quat(r)};
  double planes[6][4], terms[3][5];
  for (int i = 0; i < 3; i++) {
    const vec3l axis = ref_to_world(&turned, ref_vec(vec(i == 0, i == 1, i == 2)));
    const long double along[3] = {axis.x, axis.y, axis.z};
    for (int k = 0; k < 3; k++) {
      b->row[i][k] = terms[i][k] = (double)(along[k] / b->half[i]);
      planes[2 * i][k] = b->row[i][k], planes[2 * i + 1][k] = -b->row[i][k];
    }
    planes[2 * i][3] = planes[2 * i + 1][3] = -1.0;
    terms[i][3] = 0.0, terms[i][4] = b->p;
  }
  const double ball[10] = {1, 0, 0, 1, 0, 1, 0, 0, 0, -1};
  const cprox_hyperquadric power = {.terms = (const double(*)[5])terms, .n_terms = 3};
  cprox_implicit_description d = {0};
  if (b->form == POWERS) {
    d.hyperquadrics = &power, d.n_hyperquadrics = 1;
  } else {
    d.planes = (const double(*)[4])(b->form == PLANES ? planes : planes + 4), d.n_planes = b->form == PLANES ? 6 : 2;
    d.quadrics = &ball, d.n_quadrics = b->form == BALL_AND_PLANES;
  }
  if (cprox_body_create_implicit(&d, NULL, ws, &b->body) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
}

/* At most how far the point is outside: the gauge beyond 1 times a radius that fits inside. */
static long double plate_off(const plate *b, const cprox_pose *pose, vec3 witness) {
  const vec3l x = ref_to_local(pose, ref_vec(witness));
  long double sum = 0.0L, most = b->form == BALL_AND_PLANES ? ref_norm(x) : 0.0L;
  for (int i = b->form == BALL_AND_PLANES ? 2 : 0; i < 3; i++) {
    const long double value = fabsl(b->row[i][0] * x.x + b->row[i][1] * x.y + b->row[i][2] * x.z);
    most = fmaxl(most, value);
    sum += powl(value, b->p);
  }
  const long double gauge = b->form == POWERS ? powl(sum, 1.0L / b->p) : most;
  return (gauge - 1.0L) * b->half[2];
}

/* A body of the pair, or NULL: then `off` is not asked. */
typedef struct side {
  const plate *plate;
  cprox_pose pose;
} side;

/* The contract of all queries, where the two do not touch within rounding. */
static const long double ATTAINED = 1e-9L;
static const double TOUCHING = 1e-6;

static void check(const char *what, size_t i, const cprox_result *x, const side *mover, const side *obstacle) {
  if (!(x->upper > TOUCHING) || isinf(x->upper)) return;
  const long double apart = ref_norm(ref_sub(ref_vec(x->witness_mover), ref_vec(x->witness_obstacle)));
  if (!(fabsl(apart - x->upper) <= ATTAINED))
    fail_msg("%s %zu: upper is %.17g, the witness points are %.17Lg apart", what, i, x->upper, apart);
  const side *sides[2] = {mover, obstacle};
  for (int k = 0; k < 2; k++) {
    if (!sides[k]) continue;
    const vec3 witness = k == 0 ? x->witness_mover : x->witness_obstacle;
    const long double off = plate_off(sides[k]->plate, &sides[k]->pose, witness);
    if (!(off <= ROOM)) fail_msg("%s %zu: witness %d is %.3Lg outside form %d", what, i, k, off, sides[k]->plate->form);
  }
}

/* The solver finds no extreme point of some of the flattest bodies: an error, and not what is tested here. */
static size_t asked, refused;

static bool answered(cprox_status status) {
  asked++;
  if (status >= 0) return true;
  if (status != CPROX_INVALID || !strstr(cprox_workspace_error(ws), "an implicit body's solver"))
    fail_msg("%s", cprox_workspace_error(ws));
  refused++;
  return false;
}

static cprox_body *any_convex(rng *r) {
  cprox_body *body = NULL;
  switch (rng_index(r, 3)) {
    case 0: assert_int_equal(cprox_body_create_sphere(0.3, ws, &body), CPROX_OK); break;
    case 1: assert_int_equal(cprox_body_create_box((cprox_vec3){0.4, 0.5, 0.6}, ws, &body), CPROX_OK); break;
    default: assert_int_equal(cprox_body_create_cylinder(0.5, 0.2, ws, &body), CPROX_OK);
  }
  return body;
}

CASE(standing_pairs) {
  rng r = rng_seed(8101);
  cprox_body *ground = NULL;
  assert_int_equal(cprox_body_create_halfspace((cprox_vec3){0, 0, 1}, 2.5, ws, &ground), CPROX_OK);
  for (size_t i = 0; i < test_cases(200); i++) {
    plate a, b;
    plate_make(&r, &a), plate_make(&r, &b);
    cprox_body *other = any_convex(&r);
    const side first = {&a, rng_pose(&r, 1.5)}, second = {&b, rng_pose(&r, 1.5)};
    const cprox_obstacle at[4] = {cprox_obstacle_at(a.body, first.pose), cprox_obstacle_at(b.body, second.pose),
                                  cprox_obstacle_at(other, second.pose), cprox_obstacle_at(ground, HERE)};
    for (int k = 1; k < 4; k++) {
      cprox_result x;
      if (!answered(cprox_pair(at[0], at[k], NULL, ws, &x))) continue;
      check("pair", i, &x, &first, k == 1 ? &second : NULL);
      if (!answered(cprox_pair(at[k], at[0], NULL, ws, &x))) continue;
      check("pair turned round", i, &x, k == 1 ? &second : NULL, &first);
    }
    cprox_body_free(a.body), cprox_body_free(b.body), cprox_body_free(other);
  }
  cprox_body_free(ground);
}

CASE(points_and_bodies_on_curves) {
  rng r = rng_seed(8102);
  for (size_t i = 0; i < test_cases(100); i++) {
    plate a, b;
    plate_make(&r, &a), plate_make(&r, &b);
    cprox_body *other = any_convex(&r);
    vec3 points[4];
    for (int k = 0; k < 4; k++) points[k] = rng_in_cube(&r, 3.0);
    cprox_curve *curve = bezier(points, 4);
    const side stands = {&a, rng_pose(&r, 1.5)};
    const cprox_obstacle target = cprox_obstacle_at(a.body, stands.pose);
    const cprox_mover movers[4] = {cprox_point_along(curve), cprox_tube_along(curve, 0.05),
                                   cprox_body_along(other, curve), cprox_body_along(b.body, curve)};
    for (int k = 0; k < 4; k++) {
      cprox_result x;
      if (!answered(cprox_distance(movers[k], target, NULL, ws, &x))) continue;
      cprox_vec3 place;
      cprox_curve_evaluate(curve, x.t, ws, &place, NULL, NULL);
      const side moves = {&b, {.position = place, .orientation = {.w = 1.0}}};
      check("curve", i, &x, k == 3 ? &moves : NULL, &stands);
      if (!answered(cprox_tolerance(movers[k], target, x.upper + 0.01, NULL, ws, &x))) continue;
      check("curve's tolerance", i, &x, NULL, &stands);
    }
    cprox_curve_free(curve);
    cprox_body_free(a.body), cprox_body_free(b.body), cprox_body_free(other);
  }
}

/* Two shifts, so that the poses of links are known exactly. */
CASE(links_of_robots) {
  rng r = rng_seed(8103);
  cprox_body *ground = NULL;
  assert_int_equal(cprox_body_create_halfspace((cprox_vec3){0, 0, 1}, 2.5, ws, &ground), CPROX_OK);
  for (size_t i = 0; i < test_cases(100); i++) {
    plate a, b, c;
    plate_make(&r, &a), plate_make(&r, &b), plate_make(&r, &c);
    const cprox_pose own[2] = {rng_pose(&r, 1.0), rng_pose(&r, 1.0)};
    const cprox_link tree[2] = {
        {.parent = -1, .origin = HERE, .type = CPROX_JOINT_PRISMATIC, .axis = {1, 0, 0}, .multiplier = 1.0},
        {.parent = 0,
         .origin = HERE,
         .type = CPROX_JOINT_PRISMATIC,
         .axis = {0, 1, 0},
         .variable = 1,
         .multiplier = 1.0}};
    const cprox_link_geometry bodies[2] = {{.link = 0, .body = a.body, .pose = own[0]},
                                           {.link = 1, .body = b.body, .pose = own[1]}};
    const double from[2] = {-2.0, rng_uniform(&r, -2, 2)}, to[2] = {2.0, rng_uniform(&r, -2, 2)};
    const int32_t variables[2] = {0, 1};
    const cprox_waypoint waypoints[2] = {{.time = 0, .positions = from}, {.time = 1, .positions = to}};
    const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                        .variables = variables,
                                        .n_variables = 2,
                                        .waypoints = waypoints,
                                        .n_waypoints = 2,
                                        .interpolation = CPROX_INTERPOLATION_LINEAR};
    cprox_robot *robot = NULL;
    cprox_motion *motion = NULL;
    assert_int_equal(cprox_robot_create(tree, 2, bodies, 2, 2, ws, &robot), CPROX_OK);
    assert_int_equal(cprox_motion_create(robot, &d, ws, &motion), CPROX_OK);
    const side stands = {&c, rng_pose(&r, 2.0)};
    const cprox_obstacle targets[2] = {cprox_obstacle_at(c.body, stands.pose), cprox_obstacle_at(ground, HERE)};
    for (int k = 0; k < 2; k++) {
      cprox_result x;
      if (!answered(distance_of_list(cprox_robot_along(motion, NULL, 0), &targets[k], 1, NULL, ws, &x, NULL))) continue;
      double q[2];
      cprox_motion_evaluate(motion, x.t, q);
      side moves = {x.mover_part == 0 ? &a : &b, own[x.mover_part > 0]};
      moves.pose.position.x += q[0];
      if (x.mover_part > 0) moves.pose.position.y += q[1];
      check(k == 0 ? "robot" : "robot over the ground", i, &x, &moves, k == 0 ? &stands : NULL);
    }
    cprox_motion_free(motion);
    cprox_robot_free(robot);
    cprox_body_free(a.body), cprox_body_free(b.body), cprox_body_free(c.body);
  }
  cprox_body_free(ground);
}

CASE(most_were_answered) {
  print_message("%zu of %zu queries refused\n", refused, asked);
  assert_true(10 * refused < asked);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
