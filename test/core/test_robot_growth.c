/* SPDX-License-Identifier: BSD-3-Clause */
/* The least growth distance of a robot along its motion, against growth distances at single times by kinematics of its
 * own, and its gradient against central differences. */
#include <stdio.h>
#include <stdlib.h>

#include "curve_proximity/cprox.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/gradient_case.h"
#include "support/robots.h"
#include "support/shapes.h"

static cprox_body *make_body(rng *r, double scale) {
  static const cprox_body_kind KINDS[] = {CPROX_BODY_SPHERE,   CPROX_BODY_BOX,  CPROX_BODY_CAPSULE,
                                          CPROX_BODY_CYLINDER, CPROX_BODY_CONE, CPROX_BODY_ELLIPSOID};
  test_shape shape;
  shape_make(r, KINDS[rng_index(r, 6)], scale, 3.0, &shape);
  return shape.body;
}

/* A random robot of bodies with their centres inside, without margins. */
static void make_case(rng *r, gradient_case *p) {
  gradient_case_make(r, true, p);
  p->growth = true, p->is_signed = false;
  for (size_t i = 0; i < p->robot.n_links; i++) {
    cprox_body_free((cprox_body *)p->robot.geometries[i].body);
    p->robot.geometries[i].body = make_body(r, 0.2);
    p->robot.geometries[i].margin = 0.0;
  }
  p->robot.margin = 0.0;
  robot_rebuild(&p->robot);
  for (int i = 0; i < GRADIENT_TARGETS; i++) {
    cprox_body_free((cprox_body *)p->targets[i].body);
    p->targets[i].body = make_body(r, 0.5);
    p->targets[i].margin = 0.0;
  }
}

static cprox_status ask(const gradient_case *p, double epsilon, cprox_motion_growth *found,
                        cprox_motion_gradient *gradient) {
  cprox_obstacles *obstacles = NULL;
  const cprox_obstacle_index index = p->indexed ? CPROX_INDEX_BVH : CPROX_INDEX_NONE;
  assert_int_equal(cprox_obstacles_create(p->targets, GRADIENT_TARGETS, index, ws, &obstacles), CPROX_OK);
  cprox_mover mover = cprox_robot_along(p->robot.motion, NULL, 0);
  mover.kind = p->kind;
  const cprox_options options = accurate(epsilon);
  const cprox_status status =
      cprox_robot_growth(p->kind == CPROX_MOVER_ROBOT_SELF ? NULL : obstacles, mover, &options, ws, found, gradient);
  cprox_obstacles_free(obstacles);
  return status;
}

/* Seed 71, 60 robots against bodies, themselves or both, 100 times each: no value is below `lower`, and that at t is
 * `upper`. 1e-9 of the value: the reference's poses are rounded to double. */
CASE(the_least_value_along_a_motion_is_below_that_at_every_time) {
  rng r = rng_seed(71);
  size_t places = 0, asked = 0, deep = 0;
  for (size_t i = 0; i < test_cases(60); i++) {
    gradient_case p;
    make_case(&r, &p);
    cprox_motion_growth found;
    const double epsilon = rng_index(&r, 2) ? 1e-9 : 1e-4;
    const cprox_status status = ask(&p, epsilon, &found, NULL);
    if (status != CPROX_OK) fail_msg("problem %zu: %s", i, cprox_workspace_error(ws));
    const cprox_growth *g = &found.growth;
    if (found.mover_part >= 0) {
      assert_true(g->lower <= g->upper);
      assert_true(g->upper - g->lower <= 1.001 * epsilon * fmax(g->upper, 1e-3));
      const double here = gradient_case_growth_at(&p, found.t);
      if (fabs(here - g->upper) > 1e-9 * (1.0 + here)) fail_msg("problem %zu: %.15g at t, %.15g", i, g->upper, here);
      places += g->pairs, asked++, deep += g->upper < 1.0;
    }
    const cprox_motion_info info = cprox_motion_get_info(p.robot.motion);
    for (int k = 0; k <= 100; k++) {
      const double t = info.t0 + (info.t1 - info.t0) * k / 100.0, there = gradient_case_growth_at(&p, t);
      if (!(there >= g->lower * (1.0 - 1e-9) - 1e-12))
        fail_msg("problem %zu, kind %d: %.15g at %.17g, above %.15g is claimed", i, (int)p.kind, there, t, g->lower);
    }
    gradient_case_free(&p);
  }
  print_message("%zu robots, %zu of them in contact, %.1f places each\n", asked, deep, (double)places / (double)asked);
  assert_true(deep * 5 > asked);
}

/* Seed 72, 60 robots: derivatives by all numbers of the waypoints, by the duration, and by the poses of robot and
 * obstacle, along one random direction: 1e-5 (1 + |derivative|), as the reference knows values within 1e-12. One in five
 * may have none: links that the motion does not move, and round ones that turn about themselves, are as near all the
 * time. */
CASE(derivatives_of_the_least_value_along_a_motion_are_central_differences) {
  rng r = rng_seed(72);
  size_t asked = 0, valid = 0, unknown = 0;
  double worst = 0.0;
  for (size_t i = 0; i < test_cases(60); i++) {
    gradient_case p;
    gradient_answer a;
    make_case(&r, &p);
    gradient_case_ask(&p, &a);
    if (a.result.mover_part >= 0) {
      asked++;
      gradient_step d = gradient_step_random(&r, &p);
      d.margin = 0.0;
      if (a.gradient.valid) {
        const double expected = gradient_derivative(&p, &a, &d);
        const gradient_fit fit = gradient_compare(&p, &a, &d, expected);
        const double off = fit.off / (1.0 + fabs(expected));
        const bool beside = fit.kink > 1e-4 && fit.one_sided < 1e-5;
        valid++, unknown += !fit.is_known;
        if (off > 10.0 * GRADIENT_TOLERANCE && !beside && fit.is_known)
          fail_msg("problem %zu, kind %d, t %.17g, value %.12g: %.12g, differences are off by %g", i, (int)p.kind,
                   a.gradient.t, a.result.upper, expected, fit.off);
        if (!beside && fit.is_known) worst = fmax(worst, off);
      } else if (getenv("CPROX_TEST_SCALE")) {
        print_message("%zu: %s\n", i, cprox_workspace_error(ws));
      }
    }
    gradient_case_free(&p);
  }
  print_message("%zu of %zu have a gradient, off by %g at most; of %zu differences do not tell\n", valid, asked, worst,
                unknown);
  assert_true(5 * valid >= 4 * asked);
  assert_true(10 * unknown <= asked);
}

/* Seed 73, 20 robots: a state has the growth distance of its pairs, to the last digits, and its derivative by each
 * variable is the central difference of that (1e-5). */
CASE(a_state_is_as_near_as_its_pairs) {
  rng r = rng_seed(73);
  size_t valid = 0;
  for (size_t i = 0; i < 20; i++) {
    gradient_case p;
    make_case(&r, &p);
    p.kind = CPROX_MOVER_ROBOT;
    const cprox_motion_info info = cprox_motion_get_info(p.robot.motion);
    const double t = 0.3 * info.t0 + 0.7 * info.t1;
    double values[TEST_MAX_VARIABLES], by[TEST_MAX_VARIABLES];
    cprox_motion_evaluate(p.robot.motion, t, values);
    cprox_motion *moving = p.robot.motion;
    const cprox_motion_description still = {.kind = CPROX_MOTION_STATE, .rest = values};
    cprox_motion_growth found;
    cprox_motion_gradient gradient = {.variables = by};
    assert_int_equal(cprox_motion_create(p.robot.robot, &still, ws, &p.robot.motion), CPROX_OK);
    const cprox_status status = ask(&p, 1e-9, &found, &gradient);
    if (status < 0) fail_msg("problem %zu: %s", i, cprox_workspace_error(ws));
    const double value = gradient_case_growth_at(&p, t);
    assert_true(found.growth.lower <= value * (1.0 + 1e-9) && found.growth.upper >= value * (1.0 - 1e-9));
    cprox_motion_free(p.robot.motion);
    for (size_t v = 0; v < p.robot.n_variables && gradient.valid; v++) {
      const double h = 1e-5, here = values[v];
      double side[2];
      for (int k = 0; k < 2; k++) {
        cprox_motion_growth beside;
        values[v] = here + (k ? h : -h);
        assert_int_equal(cprox_motion_create(p.robot.robot, &still, ws, &p.robot.motion), CPROX_OK);
        assert_true(ask(&p, 1e-12, &beside, NULL) >= 0);
        side[k] = 0.5 * (beside.growth.lower + beside.growth.upper);
        cprox_motion_free(p.robot.motion);
      }
      values[v] = here;
      const double slope = (side[1] - side[0]) / (2.0 * h);
      if (fabs(slope - by[v]) > 1e-5 * (1.0 + fabs(slope)))
        fail_msg("problem %zu, variable %zu: %.12g, differences say %.12g", i, v, by[v], slope);
    }
    valid += gradient.valid;
    p.robot.motion = moving;
    gradient_case_free(&p);
  }
  assert_true(valid >= 18);
}

CASE(what_has_no_growth_distance_is_refused) {
  rng r = rng_seed(74);
  gradient_case p;
  make_case(&r, &p);
  p.kind = CPROX_MOVER_ROBOT;
  cprox_motion_growth found = {.t = -1.0};
  p.targets[1].margin = 0.1;
  assert_int_equal(ask(&p, 1e-6, &found, NULL), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws), "obstacle 1 has a margin, which is not scaled");
  p.targets[1].margin = 0.0;
  const cprox_body *ball = p.targets[1].body;
  cprox_body *point;
  assert_int_equal(cprox_body_create_point(vec(0, 0, 0), ws, &point), CPROX_OK);
  p.targets[1].body = point;
  assert_int_equal(ask(&p, 1e-6, &found, NULL), CPROX_INVALID);
  assert_string_equal(cprox_workspace_error(ws),
                      "obstacle 1 is a point, must be convex and bounded and have its centre inside");
  assert_true(found.t == -1.0);
  cprox_body_free(point);
  p.targets[1].body = ball;
  gradient_case_free(&p);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
