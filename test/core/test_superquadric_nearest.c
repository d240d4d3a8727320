/* SPDX-License-Identifier: BSD-3-Clause */
/* Nearest points of superquadrics against intervals in long double that rest on a point of the body and a tangent plane of it. */
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

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
