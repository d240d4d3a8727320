/* SPDX-License-Identifier: BSD-3-Clause */
/* Two balls anywhere: their signed distance has a closed form. The shortest family, and the one to begin another from.
 */
#include <float.h>

#include "attack.h"
#include "support/reference.h"

static void one_case(attack *a, rng *r) {
  /* sizes and places */
  const double scale = rng_log_uniform(r, 1e-6, 1e6);
  const double away = rng_index(r, 2) ? 0.0 : scale * rng_log_uniform(r, 1.0, 1e6);
  const double radius[2] = {scale * rng_log_uniform(r, 1e-3, 1.0), scale * rng_log_uniform(r, 1e-3, 1.0)};
  const vec3 origin = rng_in_cube(r, away);
  cprox_pose pose[2];
  cprox_body *body[2] = {NULL, NULL};
  for (int i = 0; i < 2; i++) {
    pose[i] = rng_pose(r, 2.0 * scale);
    pose[i].position = vec_add(pose[i].position, origin);
    if (cprox_body_create_sphere(radius[i], a->ws, &body[i]) < 0) attack_fail(a, "%s", cprox_workspace_error(a->ws));
  }
  attack_kind(a, away > 0.0 ? "far from the origin" : "near the origin");

  /* the answer against the truth, which is exact to a few roundings of long double */
  const long double apart = ref_norm(ref_sub(ref_vec(pose[0].position), ref_vec(pose[1].position)));
  const long double truth = apart - (long double)radius[0] - (long double)radius[1];
  const long double room = 8.0L * LDBL_EPSILON * (long double)(scale + away);
  cprox_options options = CPROX_OPTIONS_DEFAULT;
  options.epsilon = rng_index(r, 2) ? 0.0 : 1e-6 * scale;
  cprox_result result;
  const cprox_status status =
      cprox_pair(cprox_obstacle_at(body[0], pose[0]), cprox_obstacle_at(body[1], pose[1]), &options, a->ws, &result);
  attack_check(a, status >= 0, "%s", cprox_workspace_error(a->ws));
  if (!attack_failed(a))
    attack_check(a, (long double)result.lower <= truth + room && truth - room <= (long double)result.upper,
                 "[%.17g, %.17g] does not hold %.19Lg (radii %.17g and %.17g, epsilon %g)", result.lower, result.upper,
                 truth, radius[0], radius[1], options.epsilon);
  for (int i = 0; i < 2; i++) cprox_body_free(body[i]);
}

int main(int argc, char **argv) {
  return attack_main(argc, argv, "spheres", one_case);
}
