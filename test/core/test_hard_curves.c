/* SPDX-License-Identifier: BSD-3-Clause */
/* Curves that break other methods. Every distance is known by construction; every answer ends within its budget with an
 * interval that contains it, at any epsilon, and no verdict contradicts it. DOUBT covers what the doubles of a case are
 * off the numbers meant. */
#include <math.h>

#include "support/builders.h"
#include "support/cases.h"
#include "support/make_curve.h"

#define DOUBT 1e-12
#define TURN 6.283185307179586

static cprox_body *box, *point; /* [-1, 1]^3; the origin */

static int setup(void **state) {
  return workspace_setup(state) || cprox_body_create_box(vec(2, 2, 2), ws, &box) ||
         cprox_body_create_point(vec(0, 0, 0), ws, &point);
}

static int teardown(void **state) {
  cprox_body_free(box);
  cprox_body_free(point);
  return workspace_teardown(state);
}

/* ---- makers ---- */

#define BEZIER(...) bezier((vec3[]){__VA_ARGS__}, sizeof((vec3[]){__VA_ARGS__}) / sizeof(vec3))

/* x = a t, z = c + t^power, t in [-1, 1]. */
static cprox_curve *graph(double a, double c, size_t power) {
  vec3 coefficients[10] = {{0, 0, c}};
  coefficients[1].x = a;
  coefficients[power].z += 1.0;
  cprox_curve *curve = NULL;
  if (curve_from(describe_polynomial(coefficients, power + 1, -1.0, 1.0), ws, &curve))
    fail_msg("%s", cprox_workspace_error(ws));
  return curve;
}

static cprox_curve *circle(double radius, double t1) {
  cprox_curve *curve = NULL;
  if (curve_from(describe_trigonometric((vec3[]){{0, 0, 0}, {radius, 0, 0}, {0, radius, 0}}, 3, 0.0, t1), ws, &curve))
    fail_msg("%s", cprox_workspace_error(ws));
  return curve;
}

/* ---- queries ---- */

static void check_verdict(cprox_mover mover, cprox_obstacle target, double truth, double delta) {
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = 1e-9;
  cprox_result r;
  assert_true(cprox_tolerance(mover, target, delta, &options, ws, &r) >= 0 && r.nodes <= options.max_nodes);
  if (r.verdict == CPROX_VERDICT_CLEAR && !(truth + DOUBT > delta)) fail_msg("clear of %g, but %g away", delta, truth);
  if (r.verdict == CPROX_VERDICT_VIOLATED && !(truth - DOUBT <= delta))
    fail_msg("within %g, but %g away", delta, truth);
}

/* Asks everything of a case; frees the curves. */
static void is_at(double truth, cprox_curve *curve, cprox_obstacle target, cprox_curve *second) {
  if (second) target = cprox_obstacle_curve(second, 0.0);
  const cprox_mover mover = cprox_point_along(curve);
  static const double epsilons[] = {1e-9, 0.0, 1e-300, 1e3};
  for (size_t k = 0; k < sizeof epsilons / sizeof *epsilons; k++) {
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = epsilons[k];
    options.max_nodes = 2000;
    cprox_result r;
    const cprox_status status = cprox_distance(mover, target, &options, ws, &r);
    assert_true(status == CPROX_OK || status == CPROX_PRECISION || status == CPROX_BUDGET);
    assert_true(r.nodes <= options.max_nodes);
    if (!(r.lower <= truth + DOUBT && truth - DOUBT <= r.upper && r.lower <= r.upper))
      fail_msg("[%.17g, %.17g] is not about %.17g (epsilon %g)", r.lower, r.upper, truth, epsilons[k]);
    if (status == CPROX_OK) assert_true(r.upper - r.lower <= epsilons[k]);
  }
  const double deltas[] = {truth, truth * (1.0 - 1e-6), truth + 1e-6, truth + 1.0};
  for (int k = 0; k < 4; k++) check_verdict(mover, target, truth, deltas[k]);
  cprox_result r;
  assert_true(cprox_collision(mover, target, NULL, ws, &r) >= 0);
  assert_true(r.verdict != (truth > DOUBT ? CPROX_VERDICT_VIOLATED : CPROX_VERDICT_CLEAR));
  cprox_curve_free(curve);
  cprox_curve_free(second);
}

static void box_is_at(double truth, cprox_curve *curve) {
  is_at(truth, curve, cprox_obstacle_at(box, CPROX_POSE_IDENTITY), NULL);
}

static void point_is_at(double truth, cprox_curve *curve) {
  is_at(truth, curve, cprox_obstacle_at(point, CPROX_POSE_IDENTITY), NULL);
}

static void curves_are_at(double truth, cprox_curve *first, cprox_curve *second) {
  is_at(truth, first, (cprox_obstacle){0}, second);
}

/* ---- curves and bodies ---- */

CASE(a_line_parallel_to_a_face_at_uneven_speed) {
  box_is_at(0.5, BEZIER({-0.9, 0, 1.5}, {-0.9, 0, 1.5}, {-0.85, 0, 1.5}, {0.9, 0, 1.5}));
}

CASE(near_tangent_at_1e_9_and_tangent) {
  box_is_at(1e-9, graph(0.5, 1.0 + 1e-9, 2));
  box_is_at(0.0, graph(0.5, 1.0, 2));
}

CASE(resting_on_a_face_passing_through_and_ending_on_it) {
  box_is_at(0.0, BEZIER({-0.5, 0, 1}, {0.5, 0.2, 1}));
  box_is_at(0.0, BEZIER({0.1, 0.2, 3}, {0, 0, -3}));
  box_is_at(0.0, BEZIER({2, 2, 3}, {0, 0, 1}));
  box_is_at(0.0, BEZIER({1, 1, 1}, {2, 3, 4}, {5, 3, 4}));
}

CASE(a_cusp_towards_a_face_and_towards_a_point) {
  /* (t³, 0, c + t²) */
  for (int k = 0; k < 2; k++) {
    cprox_curve *curve = NULL;
    assert_int_equal(curve_from(describe_polynomial((vec3[]){{0, 0, k ? 0.25 : 1.25}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}},
                                                    4, -1.0, 1.0),
                                ws, &curve),
                     CPROX_OK);
    if (k)
      point_is_at(0.25, curve);
    else
      box_is_at(0.25, curve);
  }
}

CASE(contacts_of_order_4_and_8) {
  box_is_at(0.25, graph(0.5, 1.25, 4));
  box_is_at(0.0, graph(0.5, 1.0, 4));
  box_is_at(0.25, graph(0.5, 1.25, 8));
  box_is_at(0.0, graph(0.5, 1.0, 8));
}

CASE(a_curve_that_stands_still) {
  box_is_at(2.0, BEZIER({0, 0, 3}, {0, 0, 3}, {0, 0, 3}));
  point_is_at(0.0, BEZIER({0, 0, 0}, {0, 0, 0}));
}

/* The arc's quintic form is within 3e-4 outside the circle and meets it at its ends. */
CASE(an_arc_with_the_point_at_its_centre_and_off_it) {
  const double k = 0.5522847498307936, a = 3.0 / 5.0 * k, b = 3.0 / 10.0 + 3.0 / 5.0 * k;
  const vec3 arc[6] = {{1, 0, 0}, {1, a, 0}, {0.1 + 0.6 + 0.3 * k, b, 0}, {b, 0.1 + 0.6 + 0.3 * k, 0},
                       {a, 1, 0}, {0, 1, 0}};
  point_is_at(1.0, bezier(arc, 6));
  vec3 moved[6];
  for (int i = 0; i < 6; i++) moved[i] = vec_sub(arc[i], vec(-0.25, 0, 0));
  point_is_at(sqrt(1.0 + 0.0625), bezier(moved, 6)); /* its far end is the nearest */
}

CASE(a_circle_with_the_point_at_its_centre) {
  point_is_at(1.0, circle(1.0, TURN));
}

CASE(a_point_on_the_curve) {
  point_is_at(0.0, BEZIER({-1, -1, -1}, {1, 1, 1}));
  point_is_at(0.0, BEZIER({0, 0, 0}, {1, 2, 3}, {4, 5, 7}));
  point_is_at(0.0, graph(1.0, 0.0, 3));
}

CASE(features_of_1e_6_at_1e6) {
  /* all numbers are exact: 1e6 + 1 + 2^-20 */
  const double away = 1e6, z = away + 1.0 + 0x1p-20;
  const cprox_obstacle target = cprox_obstacle_at(box, (cprox_pose){{away, -away, away}, {1, 0, 0, 0}});
  is_at(0x1p-20, BEZIER({away - 0.5, -away, z}, {away, -away, z}, {away + 0.5, -away, z + 1.0}), target, NULL);
}

CASE(repeated_control_points_and_knots) {
  box_is_at(1.0, BEZIER({0, 0, 2}, {0, 0, 2}, {0, 0, 2}, {0, 0, 5}, {0, 0, 5}, {1, 0, 5}));
  /* a jump in direction at the triple knot, and a knot that comes twice */
  const vec3 points[] = {{-3, 0, 4}, {-2, 0, 3}, {-1, 0, 2.5}, {0, 0, 2}, {1, 0, 2.5},
                         {2, 0, 3},  {3, 0, 4},  {3, 0, 5},    {3, 0, 6}};
  const double knots[] = {0, 0, 0, 0, 1, 1, 1, 2, 2, 3, 3, 3, 3};
  cprox_curve *curve = NULL;
  assert_int_equal(curve_from(describe_bspline(points, 9, 3, knots, 13, 0.0, 3.0), ws, &curve), CPROX_OK);
  box_is_at(1.0, curve);
}

CASE(order_45_and_60) {
  for (size_t order = 45; order <= 60; order += 15) {
    vec3 points[61];
    for (size_t i = 0; i <= order; i++)
      points[i] = vec(sin((double)(i * i)), cos((double)i), 2.0 + 0.01 * (double)(i % 7));
    points[0] = vec(0, 0, 1.75);
    box_is_at(0.75, bezier(points, order + 1));
  }
}

/* ---- curves and curves ---- */

CASE(identical_reversed_and_overlapping_curves) {
  curves_are_at(0.0, BEZIER({0, 0, 0}, {1, 2, 0}, {2, 0, 1}), BEZIER({0, 0, 0}, {1, 2, 0}, {2, 0, 1}));
  curves_are_at(0.0, BEZIER({0, 0, 0}, {1, 2, 0}, {2, 0, 1}), BEZIER({2, 0, 1}, {1, 2, 0}, {0, 0, 0}));
  curves_are_at(0.0, BEZIER({0, 0, 0}, {2, 0, 0}), BEZIER({1, 0, 0}, {3, 0, 0}));
  curves_are_at(0.0, graph(1.0, 0.0, 2), BEZIER({0, 0, 0}, {0.25, 0, 0}, {0.5, 0, 0.25}));
}

CASE(crossing_and_touching_curves) {
  curves_are_at(0.0, BEZIER({-1, 0, 0}, {1, 0, 0}), BEZIER({0, -1, 0}, {0, 1, 0}));
  curves_are_at(0.0, graph(1.0, 0.0, 2), BEZIER({-1, 0, 0}, {1, 0, 0}));
  curves_are_at(0.0, BEZIER({-1, 0, 0}, {1, 0, 0}), BEZIER({1, 0, 0}, {2, 5, 0}));
  curves_are_at(1e-9, graph(1.0, 1e-9, 2), BEZIER({-1, 0, 0}, {1, 0, 0}));
}

CASE(parallel_lines_and_nested_parabolas) {
  curves_are_at(0.25, BEZIER({-1, 0, 0}, {1, 0, 0}), BEZIER({-0.5, 0.25, 0}, {1.5, 0.25, 0}));
  curves_are_at(0.0, graph(1.0, 0.0, 2), graph(0.5, 0.0, 2));
  curves_are_at(0.125, graph(1.0, -0.125, 2), graph(0.25, 0.0, 2));
}

CASE(concentric_arcs_and_circles) {
  curves_are_at(1.0, circle(1.0, 1.0), circle(2.0, 1.0));
  curves_are_at(1.0, circle(1.0, TURN), circle(2.0, TURN));
}

int main(void) {
  return cases_run(setup, teardown);
}
