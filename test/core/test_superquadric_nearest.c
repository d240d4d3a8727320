/* SPDX-License-Identifier: BSD-3-Clause */
/* Nearest points and distances of superquadrics against intervals in long double that rest on a point of the body and a
 * tangent plane. */
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

/* Exponents beside 1: the point that a support function finds may stay far behind the value that it proves, and a
 * distance's lower bound must rest on the value. The truth is the reference's, in long double; both orders. */
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
  const cprox_obstacle a = cprox_obstacle_at(body, pose), b = cprox_obstacle_at(point, CPROX_POSE_IDENTITY);
  for (int order = 0; order < 2; order++) {
    cprox_result r;
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-9;
    assert_true(cprox_pair(order ? a : b, order ? b : a, &options, ws, &r) >= 0);
    assert_true(r.lower <= truth.upper && r.upper >= truth.lower);
  }
  cprox_body_free(point);
  cprox_body_free(body);
}

/* How deep y is in the octahedron of the semi-axes. A body of exponents above 1 contains the octahedron, so y is as
 * deep there at least. */
static long double depth_in_octahedron(const superquadric *s, vec3 y) {
  const vec3l n = {1.0L / s->a.x, 1.0L / s->a.y, 1.0L / s->a.z};
  return (1.0L - fabsl(y.x) * n.x - fabsl(y.y) * n.y - fabsl(y.z) * n.z) / ref_norm(n);
}

/* Seed 2: no plane may prove a point to be less deep than it is, where exponents are beside 1 and the support point
 * stays behind the support value. */
CASE(depths_hold_where_exponents_are_beside_1) {
  rng r = rng_seed(2);
  size_t wrong = 0;
  for (size_t i = 0; i < test_cases(20000); i++) {
    superquadric s = {.a = {rng_log_uniform(&r, 0.05, 1), rng_log_uniform(&r, 0.05, 1), 1.0}};
    s.p = vec(1.0 + rng_log_uniform(&r, 1e-9, 1e-1), 1.0 + rng_log_uniform(&r, 1e-9, 1e-1),
              rng_index(&r, 2) ? 1.0 : rng_uniform(&r, 1, 20));
    const vec3 y =
        vec(s.a.x * rng_uniform(&r, -0.3, 0.3), s.a.y * rng_uniform(&r, -0.3, 0.3), s.a.z * rng_uniform(&r, -0.3, 0.3));
    const long double deep = depth_in_octahedron(&s, y);
    cprox_body *body = superquadric_body(&s, ws), *point = NULL; /* what lies about y */
    cprox_pose at_y = CPROX_POSE_IDENTITY;
    at_y.position = y;
    const superquadric small = {.a = {1e-3, 2e-3, 1e-3}, .p = {s.p.y, s.p.x, s.p.z}};
    const vec3 origin = {0, 0, 0};
    const size_t kind = rng_index(&r, 3);
    if (kind == 0) assert_int_equal(cprox_body_create_point(origin, ws, &point), CPROX_OK);
    if (kind == 1) assert_int_equal(cprox_body_create_box(vec(1e-3, 1e-2, 1e-3), ws, &point), CPROX_OK);
    if (kind == 2) point = superquadric_body(&small, ws);
    const cprox_obstacle a = cprox_obstacle_at(body, CPROX_POSE_IDENTITY), b = cprox_obstacle_at(point, at_y);
    cprox_result x;
    cprox_options options = CPROX_OPTIONS_DEFAULT;
    options.epsilon = 1e-6;
    assert_true(cprox_pair(a, b, &options, ws, &x) >= 0);
    const bool good = x.lower <= -deep;
    if (!good)
      print_message("[%.17g, %.17g], truth at most %.17Lg: axes %g %g %g, exponents %.17g %.17g %.17g, from %g %g %g\n",
                    x.lower, x.upper, -deep, s.a.x, s.a.y, s.a.z, s.p.x, s.p.y, s.p.z, y.x, y.y, y.z);
    wrong += !good;
    cprox_body_free(point);
    cprox_body_free(body);
  }
  assert_int_equal(wrong, 0);
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
