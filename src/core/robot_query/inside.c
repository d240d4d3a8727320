/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/inside.h"

#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "bvh/winding.h"
#include "robot_query/measure.h"

/* Lengths that enter where one of the two has its elements or its shape, seen from the other. */
static double placing_error(const robot_body *host, const robot_body *guest) {
  const double apart = vec_norm(vec_sub(guest->side.at.p, host->side.at.p));
  double sizes = apart + vec_norm(host->tree_at) + host->tree->scale + guest->side.shape->scale;
  if (guest->tree) sizes += vec_norm(guest->tree_at) + guest->tree->scale;
  return host->side.error + guest->side.error + ROUND_UP * ROUND_U * (4.0 * ROUND_ROTATION) * sizes;
}

/* A point of the world, in the frame of the host's elements. */
static vec3 to_elements(const robot_body *host, vec3 world) {
  return vec_sub(placement_turn_back(&host->side.at, vec_sub(world, host->side.at.p)), host->tree_at);
}

static winding_side find_elements(const robot_body *host, const robot_body *guest, vec3 *world) {
  const vec3 from = placement_apply(&guest->side.at, guest->tree_at);
  winding_guest elements = {.elements = guest->tree, .at = to_elements(host, from)};
  elements.error = placing_error(host, guest);
  const double *r = guest->side.at.r;
  for (int k = 0; k < 3; k++) {
    const vec3 column = placement_turn_back(&host->side.at, vec(r[k], r[3 + k], r[6 + k]));
    elements.r[k] = column.x, elements.r[3 + k] = column.y, elements.r[6 + k] = column.z;
  }
  vec3 point = vec(0, 0, 0);
  const winding_side side = winding_find_inside(host->winding, host->tree, &elements, &point);
  *world = placement_apply(&guest->side.at, vec_add(guest->tree_at, point));
  return side;
}

/* One point of what is convex. False: it has none, for want of a support function. */
static bool find_convex(const robot_body *host, const robot_body *guest, vec3 *world, winding_side *side) {
  const convex *shape = guest->side.shape;
  vec3 at;
  if (isnan(shape->ops->support(shape, vec(1, 0, 0), NULL, &at))) return false;
  *world = placement_apply(&guest->side.at, convex_drawn(shape, at));
  *side =
      winding_side_of(host->winding, host->tree, to_elements(host, *world), placing_error(host, guest) + shape->slack);
  return true;
}

/* The pair's hulls or balls tell most apart; then each solid side is asked about the other one. */
static cprox_status look_at_pair(robot_search *o, int32_t index) {
  if (!robot_pair_is_whole(&o->scene.pairs[index])) return CPROX_OK;
  placed_robot_pair p;
  placed_robot_pair_at(&o->scene, index, &p);
  const robot_body *const side[2] = {p.moving, p.standing};
  if (!side[0]->winding && !side[1]->winding) return CPROX_OK;
  if (robot_is_answered(o) || robot_pair_balls(side[0], side[1]) > 0.0) return CPROX_OK;
  if (robot_pair_ball_distance(side[0], side[1]) > 0.0) return CPROX_OK;
  robot_gap gap;
  robot_pair_measure(side[0], side[1],
                     (robot_accuracy){.epsilon = ROBOT_GAP_FRACTION * o->goal.epsilon, .fraction = 0.5}, &gap);
  o->gaps++;
  if (gap.support_failed) return workspace_fail(o->scene.q->workspace, CPROX_INVALID, CONVEX_NO_SUPPORT);
  if (gap.lower > 0.0) return CPROX_OK;
  for (int k = 0; k < 2; k++) {
    const robot_body *host = side[k], *guest = side[1 - k];
    if (!host->winding || !host->tree || robot_body_is_halfspace(guest)) continue; /* none is inside what is bounded */
    winding_side found = WINDING_OUTSIDE;
    vec3 world = vec(0, 0, 0);
    o->refined = true;
    if (guest->tree)
      found = find_elements(host, guest, &world);
    else if (!find_convex(host, guest, &world, &found))
      return workspace_fail(o->scene.q->workspace, CPROX_INVALID, CONVEX_NO_SUPPORT);
    if (found == WINDING_INSIDE) robot_keep_common(o, index, world);
    if (found == WINDING_INSIDE) break;
    o->unsure = o->unsure || found == WINDING_NEAR;
  }
  return CPROX_OK;
}

cprox_status robot_look_inside(robot_search *o, const search_node *node) {
  if (o->looked_inside || !o->scene.has_solids) return CPROX_OK;
  o->looked_inside = true;
  cprox_status status = robot_visit_near(o, node, robot_known(node)->list, look_at_pair);
  if (status >= 0 && !isfinite(o->touch_at)) status = robot_visit_near(o, node, o->standing, look_at_pair);
  if (o->unsure) o->dropped = fmin(o->dropped, 0.0);
  return status;
}
