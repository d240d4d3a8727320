/* SPDX-License-Identifier: BSD-3-Clause */
/* Nearest points and distances of superquadrics against intervals in long double that rest on a point of the body and a tangent plane. */
#include <math.h>

#include "shape/body.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/superquadrics.h"

/* Seed 1: the nearest point is a point of the body and its distance is the least. */
CASE(nearest_points_are_points_of_the_body) {
  rng r = rng_seed(1);
  size_t wrong = 0;
  for (size_t i = 0; i < test_cases(10000); i++) {
    static const double aspects[] = {1.0, 30.0, 1e3};
    const superquadric s = superquadric_random(&r, aspects[rng_index(&r, 3)]);
    cprox_body *body = superquadric_body(&s, ws);
    const vec3 y = rng_in_cube(&r, rng_log_uniform(&r, 0.1, 1e5));
    vec3 nearest;
    const double d = cprox_body_nearest(body, y, &nearest);
    const double rounding = 64.0 * 0x1p-53 * (vec_norm(y) + body->ball_radius) + body->shape.slack;
    const ref_interval truth = superquadric_distance(&s, ref_vec(y), NULL);
    const ref_interval outside = superquadric_distance(&s, ref_vec(nearest), NULL);
    const bool good = d <= 0.0 || (d + rounding >= truth.lower && outside.lower <= rounding);
    if (!good)
      print_message(
          "distance %.17g, true [%.17Lg, %.17Lg], the point is %Lg outside: axes %g %g %g, exponents %.17g %.17g "
          "%.17g, from %g %g %g\n",
          d, truth.lower, truth.upper, outside.lower, s.a.x, s.a.y, s.a.z, s.p.x, s.p.y, s.p.z, y.x, y.y, y.z);
    wrong += !good;
    cprox_body_free(body);
  }
  assert_int_equal(wrong, 0);
}

/* Exponents beside 1: the point that a support function finds may stay far behind the value that it proves, and a distance's lower
 * bound must rest on the value. The truth is the reference's, in long double; both orders. */
CASE(lower_bounds_of_pairs_hold_where_exponents_are_beside_1) {
  const superquadric s = {.a = {0.003677111554885204, 0.0021015665365774622, 0.74948478477294522},
                          .p = {1, 1.019770109814055, 20.260944529370203}};
  const cprox_pose pose = {
      .position = {12.115283171658501, -16.486839803998578, 4.340218479370467},
      .orientation = {-0.097194845860947357, 0.64241511631394432, -0.26372947927668428, 0.71295353427124353}};
  const vec3 at = {12.186027022828258, -16.537513651129863, 4.38130573521165};
  const cprox_pose turned = {.orientation = pose.orientation};
  const vec3l local = ref_to_local(&turned, ref_sub(ref_vec(at), ref_vec(pose.position)));
  const ref_interval truth = superquadric_distance(&s, local, NULL);
  cprox_body *body = superquadric_body(&s, ws), *point = NULL;
  assert_int_equal(cprox_body_create_point(at, ws, &point), CPROX_OK);
  const cprox_obstacle a = cprox_obstacle_at(body, pose), b = cprox_obstacle_at(point, cprox_pose_identity());
  for (int order = 0; order < 2; order++) {
    cprox_result r;
    cprox_options options = cprox_options_default();
    options.epsilon = 1e-9;
    assert_true(cprox_pair(order ? a : b, order ? b : a, &options, ws, &r) >= 0);
    assert_true(r.lower <= truth.upper && r.upper >= truth.lower);
  }
  cprox_body_free(point);
  cprox_body_free(body);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
