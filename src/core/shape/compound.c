/* SPDX-License-Identifier: BSD-3-Clause */
#include <stdlib.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "shape/construct.h"

/* The bounding sphere of a part in the frame of the union, rounding included. */
static double part_ball(const body_part *part, vec3 *centre) {
  const vec3 own = part->body->ball_centre;
  const double radius = part->body->ball_radius;
  const frame f = frame_create(&part->pose, vec(0, 0, 0));
  *centre = frame_to_world(&f, own);
  const double moved = ROUND_U * (ROUND_ROTATION * vec_norm(own) + 3.0 * vec_norm(*centre));
  return (radius + moved) * (1.0 + 4.0 * ROUND_U);
}

/* About the middle of the box of all the parts' balls. */
static void compound_bound(cprox_body *body) {
  vec3 low = vec(INFINITY, INFINITY, INFINITY), high = vec(-INFINITY, -INFINITY, -INFINITY), c;
  for (size_t i = 0; i < body->n_parts; i++) {
    const double r = part_ball(&body->parts[i], &c);
    if (isinf(r)) { /* a halfspace */
      body->ball_centre = c;
      body->ball_radius = INFINITY;
      return;
    }
    low = vec(fmin(low.x, c.x - r), fmin(low.y, c.y - r), fmin(low.z, c.z - r));
    high = vec(fmax(high.x, c.x + r), fmax(high.y, c.y + r), fmax(high.z, c.z + r));
  }
  body->ball_centre = vec_axpy(vec_scale(0.5, low), 0.5, high);
  for (size_t i = 0; i < body->n_parts; i++) {
    const double r = part_ball(&body->parts[i], &c);
    body->ball_radius = fmax(body->ball_radius, vec_norm(vec_sub(c, body->ball_centre)) + r);
  }
  body->ball_radius *= 1.0 + ROUND_LENGTH * ROUND_U;
}

cprox_status cprox_body_create_compound(const cprox_body *const *parts, const cprox_pose *poses, size_t n,
                                        cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  if (n == 0) return workspace_fail(workspace, CPROX_INVALID, "a compound needs at least 1 part, got none");
  if (!parts || !poses) return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", parts ? "poses" : "parts");
  if (n > INT32_MAX)
    return workspace_fail(workspace, CPROX_INVALID, "%zu parts, at most %d are possible", n, INT32_MAX);
  for (size_t i = 0; i < n; i++) {
    if (!parts[i]) return workspace_fail(workspace, CPROX_INVALID, "part %zu is NULL", i);
    if (parts[i]->kind == CPROX_BODY_COMPOUND)
      return workspace_fail(workspace, CPROX_INVALID, "part %zu is a compound itself: give its parts instead", i);
    if (parts[i]->field)
      return workspace_fail(workspace, CPROX_INVALID, "part %zu is known by its distance alone: give it by itself", i);
    const char *support_failed = frame_pose_error(&poses[i]);
    if (support_failed) return workspace_fail(workspace, CPROX_INVALID, "the pose of part %zu: %s", i, support_failed);
  }

  cprox_body *made = body_allocate(NULL, CPROX_BODY_COMPOUND);
  if (made) made->parts = malloc(n * sizeof *made->parts);
  if (!made || !made->parts) {
    cprox_body_free(made);
    return body_out_of_memory(workspace);
  }
  made->n_parts = n;
  for (size_t i = 0; i < n; i++) made->parts[i] = (body_part){.body = parts[i], .pose = poses[i]};
  compound_bound(made);
  *body = made;
  return CPROX_OK;
}

double compound_support(const cprox_body *body, vec3 direction, vec3 *point) {
  double most = -INFINITY;
  for (size_t i = 0; i < body->n_parts; i++) {
    const frame f = frame_create(&body->parts[i].pose, vec(0, 0, 0));
    vec3 at;
    const double h = cprox_body_support(body->parts[i].body, frame_turn_to_local(&f, direction), &at) +
                     vec_dot(direction, f.position);
    if (h <= most) continue;
    most = h;
    if (point) *point = frame_to_world(&f, at);
  }
  return most;
}

double compound_nearest(const cprox_body *body, vec3 point, vec3 *nearest) {
  double least = INFINITY;
  for (size_t i = 0; i < body->n_parts; i++) {
    const frame f = frame_create(&body->parts[i].pose, vec(0, 0, 0));
    vec3 at;
    double unused = 0.0;
    const double d = cprox_body_nearest(body->parts[i].body, frame_to_local(&f, point, &unused), &at);
    if (d >= least) continue;
    least = d;
    if (nearest) *nearest = frame_to_world(&f, at);
  }
  return least;
}
