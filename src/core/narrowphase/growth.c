/* SPDX-License-Identifier: BSD-3-Clause */
/* The growth distance and its derivatives. Both bodies scaled by g about their centres touch where, unscaled, they
 * would touch with the centres 1/g times as far apart: where a ray leaves the Minkowski difference (convex/ray.h). */
#include "narrowphase/growth.h"

#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "convex/depth.h"
#include "convex/feature.h"
#include "implicit/implicit.h"
#include "narrowphase/translation.h"
#include "problem/validate.h"

double growing_inner_radius(const convex *shape) {
  if (shape->implicit) return shape->implicit->inner;
  const vec3 origin = vec(0, 0, 0);
  convex_near near;
  shape->ops->nearest(shape, origin, NULL, &near);
  depth_complete(shape, origin, &near);
  return fmax(-0.999 * near.distance, 0.0);
}

static double inner_radius(const cprox_body *body) {
  return isfinite(body->ball_radius) ? growing_inner_radius(&body->shape) : 0.0;
}

static cprox_status check_growing(const char *name, const cprox_body *body, double inner, cprox_workspace *workspace) {
  if (inner > GROWING_COINCIDE * body->ball_radius) return CPROX_OK;
  return workspace_fail(workspace, CPROX_INVALID, "%s is a %s, must be bounded and have its centre inside", name,
                        cprox_body_kind_name(body->kind));
}

void growing_place(growing *g) {
  g->x = relative_pose_of_side(&g->a, 0), g->y = relative_pose_of_side(&g->b, 0);
  g->place = relative_pose_make(&g->x, &g->y);
}

cprox_status growing_begin(growing *g, const cprox_options *options, cprox_workspace *workspace) {
  const arguments_query kind = {"the growth distance", ARGUMENTS_STOP};
  cprox_status status;
  if (!workspace) return CPROX_INVALID;
  g->asked = validate_defaults(options);
  if ((status = validate_options(&g->asked, kind, workspace)) || (status = validate_obstacle(&g->a, 0, workspace)) ||
      (status = validate_obstacle(&g->b, 1, workspace)) || (status = translation_check_body("a", &g->a, workspace)) ||
      (status = translation_check_body("b", &g->b, workspace)))
    return status;
  if (g->a.margin > 0.0 || g->b.margin > 0.0)
    return workspace_fail(workspace, CPROX_INVALID, "margin is not scaled: it must be 0");
  g->inner_a = inner_radius(g->a.body), g->inner_b = inner_radius(g->b.body);
  if ((status = check_growing("a", g->a.body, g->inner_a, workspace)) ||
      (status = check_growing("b", g->b.body, g->inner_b, workspace)))
    return status;
  growing_place(g);
  return CPROX_OK;
}

cprox_status growing_measure(const growing *g, bool wants_derivatives, cprox_workspace *workspace, cprox_growth *growth,
                             ray_answer *ray) {
  const double far = vec_norm(g->place.t), reach = g->a.body->ball_radius + g->b.body->ball_radius;
  *growth = (cprox_growth){.status = CPROX_OK};
  *ray = (ray_answer){.found = false};
  if (far <= GROWING_COINCIDE * reach) {
    growth->upper = (far + g->place.error) / fmin(g->inner_a, g->inner_b);
    return CPROX_OK;
  }
  if (!g->asked.stop || !g->asked.stop(g->asked.stop_user))
    ray_leave(g->x.shape, g->x.margin, g->inner_a, g->y.shape, g->y.margin, g->inner_b, &g->place, wants_derivatives,
              ray);
  if (ray->found && ray->upper - ray->lower <= g->asked.epsilon * ray->upper) {
    growth->lower = ray->lower, growth->upper = ray->upper;
    growth->normal = vec_neg(frame_turn_to_world(&g->x.f, ray->slope));
    feature_unit(growth->normal, &growth->normal);
    growth->pairs = 1;
    return CPROX_OK;
  }
  cprox_status status = translation_growth(g->a, g->b, g->inner_a + g->inner_b, &g->asked, workspace, growth);
  if (status < 0) return status;
  if (ray->found) {
    growth->lower = fmax(growth->lower, ray->lower), growth->upper = fmin(growth->upper, ray->upper);
    const bool narrow = growth->upper - growth->lower <= g->asked.epsilon * growth->upper;
    if (narrow) growth->status = CPROX_OK;
  }
  workspace_clear(workspace);
  if (growth->status != CPROX_OK) workspace_fail(workspace, growth->status, "%s", cprox_status_text(growth->status));
  return growth->status;
}

cprox_status cprox_growth_distance(cprox_obstacle a, cprox_obstacle b, const cprox_options *options,
                                   cprox_workspace *workspace, cprox_growth *growth) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  growing g = {.a = a, .b = b};
  const cprox_status status = growing_begin(&g, options, workspace);
  if (status) return status;
  if (!growth) return workspace_fail(workspace, CPROX_INVALID, "growth is NULL: nowhere to put the answer");
  ray_answer ray;
  return growing_measure(&g, false, workspace, growth, &ray);
}

/* ---- derivatives ---- */

const char *growing_tie(const ray_answer *ray) {
  if (!ray->found) return "the centres coincide, or the search was stopped";
  if (!ray->solved) return "the optimum was not found as exactly as rounding allows";
  if (!ray->slope_alone) return "more than one plane fits between the scaled bodies";
  if (!ray->point_alone) return "the scaled bodies touch in more than one point";
  return NULL;
}

/* T h T^T for the rotation of a's frame. */
static void hessian_to_world(const frame *f, const double h[6], double out[6]) {
  static const vec3 axis[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int i = 0, k = 0; i < 3; i++)
    for (int j = i; j < 3; j++)
      out[k++] = feature_quadratic(h, frame_turn_to_local(f, axis[i]), frame_turn_to_local(f, axis[j]));
}

const char *growing_differentiate(const growing *g, const cprox_growth *growth, const ray_answer *ray,
                                  cprox_growth_derivatives *derivatives) {
  cprox_growth_derivatives d = {.valid = false, .touch = vec(NAN, NAN, NAN)};
  if (ray->found) {
    const vec3 slope = frame_turn_to_world(&g->x.f, ray->slope);
    d.touch = frame_to_world(&g->x.f, vec_scale(0.5 * (growth->lower + growth->upper), ray->on_a));
    d.a_position = vec_neg(slope), d.b_position = slope;
    d.a_rotation = vec_cross(vec_sub(d.touch, g->a.pose.position), d.a_position);
    d.b_rotation = vec_cross(vec_sub(d.touch, g->b.pose.position), d.b_position);
  }
  d.valid_position = ray->solved && ray->slope_alone;
  d.valid = d.valid_position && ray->point_alone;
  d.bends = d.valid_position && ray->bends;
  for (int i = 0; i < 6; i++) d.hessian[i] = NAN;
  if (d.bends) hessian_to_world(&g->x.f, ray->hessian, d.hessian);
  *derivatives = d;
  return growing_tie(ray);
}

cprox_status cprox_growth_gradient(cprox_obstacle a, cprox_obstacle b, const cprox_options *options,
                                   cprox_workspace *workspace, cprox_growth *growth,
                                   cprox_growth_derivatives *derivatives) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  growing g = {.a = a, .b = b};
  cprox_status status = growing_begin(&g, options, workspace);
  if (status) return status;
  if (!growth || !derivatives)
    return workspace_fail(workspace, CPROX_INVALID, "%s is NULL: nowhere to put the answer",
                          growth ? "derivatives" : "growth");
  ray_answer ray;
  cprox_growth value;
  status = growing_measure(&g, true, workspace, &value, &ray);
  if (status < 0) return status;
  const char *tie = growing_differentiate(&g, &value, &ray, derivatives);
  *growth = value;
  if (tie && status == CPROX_OK) workspace_fail(workspace, CPROX_OK, "no gradient: %s", tie);
  return status;
}
