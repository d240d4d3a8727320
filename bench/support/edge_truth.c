/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/edge_truth.h"

#include <math.h>

#include "base/frame.h"
#include "base/vec.h"
#include "kinematics/joint_tree.h"
#include "shape/body.h"

/* Nothing is told apart from contact within this [m], and no more states are looked at than that. */
static const double TOUCHING = 1e-7;
enum { MOST_STATES = 200000 };

/* Where an obstacle stands, and what it is. */
typedef struct standing {
  frame at;
  vec3 position;
  cprox_body_kind kind;
  double size[3], margin;
} standing;

static bool standing_of(const cprox_obstacle *target, standing *s) {
  const cprox_body *body = target->body;
  const cprox_body_kind kind = body->kind;
  if (kind != CPROX_BODY_BOX && kind != CPROX_BODY_SPHERE && kind != CPROX_BODY_CAPSULE && kind != CPROX_BODY_CYLINDER)
    return false;
  *s = (standing){.at = frame_create(&target->pose, vec(0, 0, 0)),
                  .position = target->pose.position,
                  .kind = kind,
                  .margin = body->shape.margin};
  for (int k = 0; k < 3; k++) s->size[k] = body->shape.size[k];
  return true;
}

/* The distance of a point, negative inside. */
static double distance_from(const standing *s, vec3 x) {
  const vec3 d = vec_sub(x, s->position);
  double y[3];
  for (int k = 0; k < 3; k++) y[k] = s->at.r[k] * d.x + s->at.r[3 + k] * d.y + s->at.r[6 + k] * d.z;
  if (s->kind == CPROX_BODY_SPHERE) return vec_norm(d) - s->margin;
  if (s->kind == CPROX_BODY_CAPSULE) {
    const double over = fmax(fabs(y[2]) - s->size[1], 0.0);
    return sqrt(y[0] * y[0] + y[1] * y[1] + over * over) - s->size[0];
  }
  double beyond[3] = {fabs(y[0]) - s->size[0], fabs(y[1]) - s->size[1], fabs(y[2]) - s->size[2]};
  if (s->kind == CPROX_BODY_CYLINDER)
    beyond[0] = hypot(y[0], y[1]) - s->size[0], beyond[1] = fabs(y[2]) - s->size[1], beyond[2] = -INFINITY;
  const double most = fmax(fmax(beyond[0], beyond[1]), beyond[2]);
  if (most <= 0.0) return most;
  double sum = 0.0;
  for (int k = 0; k < 3; k++) sum += beyond[k] > 0.0 ? beyond[k] * beyond[k] : 0.0;
  return sqrt(sum);
}

/* How fast a point may be, at `local` in the frame of a link, when the edge takes a unit of time. */
static double speed_of(const cprox_robot *robot, size_t link, vec3 local, const double *from, const double *to) {
  double reach = vec_norm(robot->links[link].at.p) + vec_norm(local), speed = 0.0;
  for (int32_t i = robot->links[link].axis; i >= 0; i = robot->axes[i].parent) {
    const robot_axis *axis = &robot->axes[i];
    speed += fabs(axis->multiplier * (to[axis->variable] - from[axis->variable])) * reach;
    reach += vec_norm(axis->at.p);
  }
  return speed;
}

/* The longest time from a state in which nothing that is apart can touch; negative: something touches. Nearer than
 * what is told apart, time goes on all the same. */
static double time_from(const robot_case *model, const standing *stands, size_t n, const vec3 *centres,
                        const double *radii, const double *speeds, bool *near) {
  double least = INFINITY;
  for (size_t g = 0; g < model->n_geometries; g++)
    for (size_t k = 0; k < n; k++) {
      const double d = distance_from(&stands[k], centres[g]) - radii[g];
      if (d < 0.0) return -1.0;
      *near = *near || d < TOUCHING;
      least = fmin(least, fmax(d, TOUCHING) / speeds[g]);
    }
  for (size_t k = 0; k < model->n_self_pairs; k++) {
    const int32_t a = model->self_pairs[k].geometry, b = model->self_pairs[k].other;
    const double d = vec_norm(vec_sub(centres[a], centres[b])) - radii[a] - radii[b];
    if (d < 0.0) return -1.0;
    *near = *near || d < TOUCHING;
    least = fmin(least, fmax(d, TOUCHING) / (speeds[a] + speeds[b]));
  }
  return least;
}

edge_truth edge_truth_of(const robot_case *model, const cprox_obstacle *targets, size_t n_targets, const double *from,
                         const double *to) {
  const cprox_robot *robot = model->robot;
  standing stands[CASE_MAX_OBJECTS];
  placement axes[CASE_MAX_LINKS];
  vec3 centres[CASE_MAX_GEOMETRIES];
  double radii[CASE_MAX_GEOMETRIES], speeds[CASE_MAX_GEOMETRIES], values[CASE_MAX_VARIABLES];
  for (size_t i = 0; i < robot->n_axes; i++)
    if (robot->axes[i].kind != AXIS_REVOLUTE || robot->n_axes > CASE_MAX_LINKS) return EDGE_TRUTH_UNKNOWN;
  for (size_t k = 0; k < n_targets; k++)
    if (!standing_of(&targets[k], &stands[k])) return EDGE_TRUTH_UNKNOWN;
  for (size_t g = 0; g < model->n_geometries; g++) {
    if (model->bodies[g]->kind != CPROX_BODY_SPHERE) return EDGE_TRUTH_UNKNOWN;
    radii[g] = model->bodies[g]->shape.margin;
    speeds[g] = speed_of(robot, (size_t)model->links[g], model->poses[g].position, from, to) + 1e-12;
  }
  double t = 0.0;
  bool near = false;
  for (int states = 0; states < MOST_STATES; states++) {
    for (size_t k = 0; k < model->n_variables; k++) values[k] = from[k] + t * (to[k] - from[k]);
    robot_place_axes(robot, values, axes);
    for (size_t g = 0; g < model->n_geometries; g++) {
      const robot_link *link = &robot->links[model->links[g]];
      const placement at = link->axis < 0 ? link->at : placement_compose(&axes[link->axis], &link->at);
      const vec3 p = model->poses[g].position;
      centres[g] = vec(at.p.x + at.r[0] * p.x + at.r[1] * p.y + at.r[2] * p.z,
                       at.p.y + at.r[3] * p.x + at.r[4] * p.y + at.r[5] * p.z,
                       at.p.z + at.r[6] * p.x + at.r[7] * p.y + at.r[8] * p.z);
    }
    const double step = time_from(model, stands, n_targets, centres, radii, speeds, &near);
    if (step < 0.0) return EDGE_TRUTH_HITS;
    if (t >= 1.0) return near ? EDGE_TRUTH_UNKNOWN : EDGE_TRUTH_CLEAR;
    t = fmin(t + step, 1.0);
  }
  return EDGE_TRUTH_UNKNOWN;
}
