/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/pair_distance.h"

#include <math.h>

#include "base/rounding.h"
#include "convex/pair.h"

enum { GAP_STEPS = 128, DEPTH_STEPS = 400 };

/* The difference of two places, turned back into a body's axes, less its box or along its plane, and less a radius: u,
 * 6 u, 2 u, a norm 3 u, 2 u, of all sizes. The rest is an allowance; what placing costs is in the sides' errors. */
static const double ROUND_BOX = 40.0;

/* ---- cheap distances ---- */

/* Of a point from the box round a body, or from its halfspace; inside minus the way out. */
static double from_box(const robot_body *body, vec3 point) {
  const vec3 y = placement_turn_back(&body->side.at, vec_sub(point, body->side.at.p));
  if (robot_body_is_halfspace(body)) {
    const double *h = body->side.shape->size;
    return h[0] * y.x + h[1] * y.y + h[2] * y.z + h[3];
  }
  const vec3 z = vec_sub(y, body->side.middle), half = body->side.half;
  const vec3 out = vec(fabs(z.x) - half.x, fabs(z.y) - half.y, fabs(z.z) - half.z);
  const double inside = greater(out.x, greater(out.y, out.z));
  if (inside <= 0.0) return inside;
  return vec_norm(vec(greater(out.x, 0.0), greater(out.y, 0.0), greater(out.z, 0.0)));
}

double robot_pair_balls(const robot_body *moving, const robot_body *standing) {
  if (robot_body_is_halfspace(standing)) return -INFINITY;
  const double between = vec_norm(vec_sub(moving->side.at.p, standing->side.at.p));
  const double radii = moving->radius + standing->radius;
  return between - radii -
         ROUND_UP * (moving->side.error + standing->side.error + ROUND_LENGTH * ROUND_U * (between + radii));
}

double robot_pair_ball_distance(const robot_body *moving, const robot_body *standing) {
  const vec3 apart = vec_sub(moving->side.at.p, standing->side.at.p);
  double most = from_box(standing, moving->side.at.p) - standing->side.margin - moving->radius;
  if (!robot_body_is_halfspace(standing))
    most = greater(most, from_box(moving, standing->side.at.p) - moving->side.margin - standing->radius);
  const double sizes = vec_norm(apart) + moving->radius +
                       (robot_body_is_halfspace(standing) ? fabs(standing->side.shape->size[3]) : standing->radius);
  return most - ROUND_UP * (moving->side.error + standing->side.error + ROUND_BOX * ROUND_U * sizes);
}

vec3 robot_pair_guess(const robot_body *moving, const robot_body *standing) {
  if (robot_body_is_halfspace(standing)) return vec(0, 0, 0);
  const vec3 apart = vec_sub(moving->side.at.p, standing->side.at.p), half = standing->side.half;
  const vec3 y = vec_sub(placement_turn_back(&standing->side.at, apart), standing->side.middle);
  const vec3 out = vec(copysign(greater(fabs(y.x) - half.x, 0.0), y.x), copysign(greater(fabs(y.y) - half.y, 0.0), y.y),
                       copysign(greater(fabs(y.z) - half.z, 0.0), y.z));
  const double length = vec_norm(out);
  return length > 0.0 ? vec_scale(1.0 / length, out) : vec(0, 0, 0);
}

double robot_pair_height(const robot_body *standing, vec3 normal) {
  if (!robot_body_is_halfspace(standing)) return bound_height(&standing->side, normal);
  return standing->side.margin - standing->side.shape->size[3];
}

/* ---- the distance ---- */

static void measure_halfspace(const robot_body *moving, const robot_body *standing, bool depth, robot_gap *gap) {
  const double *h = standing->side.shape->size;
  const vec3 n = placement_turn(&standing->side.at, vec(h[0], h[1], h[2]));
  vec3 at;
  const convex *shape = moving->side.shape;
  const vec3 down = placement_turn_back(&moving->side.at, vec_neg(n));
  const double low = -shape->ops->support(shape, down, NULL, &at);
  const double along = vec_dot(n, vec_sub(moving->side.at.p, standing->side.at.p));
  const double distance = along + h[3] + low - moving->side.margin - standing->side.margin;
  const double sizes =
      vec_norm(vec_sub(moving->side.at.p, standing->side.at.p)) + fabs(h[3]) + moving->radius + standing->side.margin;
  const double rounding =
      ROUND_UP * (moving->side.error + standing->side.error + ROUND_BOX * ROUND_U * sizes + 2.0 * shape->slack);
  /* the lowest point, drawn into the body */
  const vec3 drawn = convex_drawn(shape, at);
  const double reached = shape->drawn > 0.0 ? -vec_dot(down, drawn) - low : 0.0;
  const vec3 lowest = vec_axpy(placement_apply(&moving->side.at, drawn), -moving->side.margin, n);
  const double above = distance + reached;
  *gap = (robot_gap){.lower = distance - rounding,
                     .upper = above + rounding - ROUND_UP * 2.0 * (shape->slack - shape->outside),
                     .slack = rounding,
                     .on_moving = lowest,
                     .on_standing = depth || above > 0.0 ? vec_axpy(lowest, -above, n) : lowest,
                     .normal = n,
                     .support_failed = isnan(distance)};
}

/* What moves, in the frame of what stands. */
static pair_placement seen_from(const robot_body *standing, const robot_body *moving) {
  pair_placement seen = {.error = moving->side.error + standing->side.error};
  for (int i = 0; i < 3; i++) {
    const double *r = moving->side.at.r;
    const vec3 column = placement_turn_back(&standing->side.at, vec(r[i], r[3 + i], r[6 + i]));
    seen.r[i] = column.x, seen.r[3 + i] = column.y, seen.r[6 + i] = column.z;
  }
  const vec3 apart = vec_sub(moving->side.at.p, standing->side.at.p);
  seen.t = placement_turn_back(&standing->side.at, apart);
  seen.error += ROUND_UP * ROUND_U * ROUND_ROTATION * (vec_norm(apart) + moving->radius);
  return seen;
}

void robot_pair_measure(const robot_body *moving, const robot_body *standing, robot_accuracy accuracy, robot_gap *gap) {
  if (robot_body_is_halfspace(standing)) {
    measure_halfspace(moving, standing, accuracy.depth, gap);
    return;
  }
  const pair_placement seen = seen_from(standing, moving);
  const pair_goal goal = {.epsilon = accuracy.epsilon,
                          .floor = accuracy.floor,
                          .fraction = accuracy.fraction,
                          .verdict = accuracy.verdict,
                          .limit = accuracy.floor,
                          .start = vec_neg(accuracy.start),
                          .max_steps = accuracy.depth ? DEPTH_STEPS : GAP_STEPS,
                          .wants_feature = true,
                          .wants_depth = accuracy.depth};
  pair_answer answer;
  pair_separate(standing->side.shape, standing->side.margin, moving->side.shape, moving->side.margin, &seen, &goal,
                &answer);
  *gap = (robot_gap){
      .support_failed = answer.support_failed, .lower = answer.lower, .upper = answer.upper, .slack = answer.rounding};
  if (answer.support_failed) return;
  const bool apart = answer.upper > 0.0 || accuracy.depth;
  gap->on_standing = placement_apply(&standing->side.at, apart ? answer.on_a : answer.common);
  gap->on_moving = placement_apply(&standing->side.at, apart ? answer.on_b : answer.common);
  gap->normal = vec_neg(placement_turn(&standing->side.at, answer.normal));
  if (!apart) return;
  if (!answer.feature.flat) {
    for (int i = 0; i < 6; i++) gap->hessian[i] = answer.feature.hessian[i];
    return;
  }
  gap->n = answer.feature.n;
  for (int i = 0; i < gap->n && i < 3; i++) {
    gap->on_edge[i] = placement_apply(&moving->side.at, answer.feature.b[i]);
    gap->across[i] = vec_neg(placement_turn(&standing->side.at, answer.feature.w[i]));
  }
}

/* The direction from 0 to the flat through the points, towards `like`; (0,0,0) where there is none. */
static vec3 direction_of(const vec3 *w, int n, vec3 like) {
  vec3 v = w[0];
  if (n == 2) {
    const vec3 e = vec_sub(w[1], w[0]);
    v = vec_axpy(v, -vec_dot(v, e) / vec_norm2(e), e);
  } else if (n == 3) {
    v = vec_cross(vec_sub(w[1], w[0]), vec_sub(w[2], w[0]));
  }
  const double length = vec_norm(v);
  if (!(length > 0.0)) return vec(0, 0, 0);
  return vec_scale((vec_dot(v, like) < 0.0 ? -1.0 : 1.0) / length, v);
}

static vec3 orthogonal_part(vec3 normal_rate, vec3 normal) {
  return vec_finite(normal_rate) ? vec_axpy(normal_rate, -vec_dot(normal_rate, normal), normal) : vec(0, 0, 0);
}

static vec3 times_symmetric(const double h[6], vec3 v) {
  return vec(h[0] * v.x + h[1] * v.y + h[2] * v.z, h[1] * v.x + h[3] * v.y + h[4] * v.z,
             h[2] * v.x + h[4] * v.y + h[5] * v.z);
}

/* How the core's extreme point along d moves where d turns so, in world axes; (0,0,0) of polyhedra. `at` is the nearest
 * point, margin included. */
static vec3 extreme_rate(const robot_body *body, vec3 d, vec3 at, vec3 rate) {
  const bound_side *side = &body->side;
  if (!side->shape->ops->curvature) return vec(0, 0, 0);
  double s[6];
  const vec3 own = placement_turn_back(&side->at, d);
  const vec3 x = vec_axpy(placement_turn_back(&side->at, vec_sub(at, side->at.p)), -side->margin, own);
  side->shape->ops->curvature(side->shape, vec_scale(1.0 / vec_norm(own), own), x, s);
  return placement_turn(&side->at, times_symmetric(s, placement_turn_back(&side->at, rate)));
}

/* (distance + how both cores bend) n' = v + (how the moving one bends) (omega x n); the Hessian of the distance is the
 * inverse of that sum. What a face bends is not known, then the other side and that sum say it. */
static vec3 normal_rate_of_curved(const robot_gap *gap, const robot_body *moving, const robot_body *standing,
                                  const chain_motion *motion) {
  const vec3 n = vec_scale(1.0 / vec_norm(gap->normal), gap->normal), turned = vec_cross(motion->omega, n);
  const vec3 core = vec_axpy(vec_sub(gap->on_moving, moving->side.at.p), moving->side.margin, n);
  const bool by_moving = moving->side.shape->ops->curvature && !standing->side.shape->ops->curvature;
  vec3 v = vec_add(motion->v, vec_cross(motion->omega, core)), rest = vec(0, 0, 0);
  if (by_moving) {
    v = vec_add(v, extreme_rate(moving, vec_neg(n), gap->on_moving, turned));
  } else {
    const double apart =
        vec_dot(n, vec_sub(gap->on_moving, gap->on_standing)) + moving->side.margin + standing->side.margin;
    v = vec_sub(v, vec_axpy(extreme_rate(standing, n, gap->on_standing, turned), apart, turned));
    rest = turned;
  }
  const vec3 seen = times_symmetric(gap->hessian, placement_turn_back(&standing->side.at, v));
  return orthogonal_part(vec_add(rest, placement_turn(&standing->side.at, seen)), n);
}

/* By a difference quotient: any rate of the normal is allowed, this one is near the best. */
vec3 robot_pair_normal_rate(const robot_gap *gap, const robot_body *moving, const robot_body *standing,
                            const chain_motion *motion) {
  static const double STEP = 1e-5;
  vec3 n[2];
  if (robot_body_is_halfspace(standing)) return vec(0, 0, 0); /* it has one direction, whatever moves */
  if (gap->n < 1) return normal_rate_of_curved(gap, moving, standing, motion);
  for (int k = 0; k < 2; k++) {
    vec3 w[3];
    for (int i = 0; i < gap->n; i++) {
      const vec3 from = vec_sub(gap->on_edge[i], moving->side.at.p);
      const vec3 velocity = vec_add(motion->v, vec_cross(motion->omega, from));
      w[i] = vec_axpy(gap->across[i], k == 0 ? -STEP : STEP, velocity);
    }
    n[k] = direction_of(w, gap->n, gap->normal);
  }
  return orthogonal_part(vec_scale(0.5 / STEP, vec_sub(n[1], n[0])), gap->normal);
}
