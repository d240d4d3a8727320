/* SPDX-License-Identifier: BSD-3-Clause */
/* A shape of the user's own, about user_centre. size: the radius within which its points were promised to lie. */
#include "base/rounding.h"
#include "convex/feature.h"
#include "convex/gjk.h"

static double callback_support(const convex *shape, vec3 d, convex_hint *hint, vec3 *at) {
  (void)hint;
  const double direction[3] = {d.x, d.y, d.z};
  double point[3] = {NAN, NAN, NAN};
  shape->callback(shape->user, direction, point);

  /* an answer that is not a number or breaks the promise must not pass as a bound */
  const vec3 x = vec_sub(vec(point[0], point[1], point[2]), shape->user_centre);
  if (at) *at = x;
  const double reach = (shape->size[0] + shape->slack) * (1.0 + ROUND_LENGTH * ROUND_U);
  return vec_norm2(x) <= reach * reach ? vec_dot(d, x) : NAN;
}

static void callback_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  (void)hint;
  gjk_answer answer;
  gjk_nearest(shape, y, NULL, &answer);
  *near = (convex_near){.distance = answer.distance - shape->margin,
                        .point = vec_axpy(answer.point, shape->margin, answer.normal),
                        .normal = answer.normal};
}

/* near_rounding: as a polytope's; what the search could not close between its bounds shows in the certificate of the
 * query. */
const convex_ops convex_support_callback = {.kind = CPROX_BODY_SUPPORT,
                                            .near_rounding = 64.0,
                                            .proves_depth = true,
                                            .nearest = callback_nearest,
                                            .support = callback_support};
