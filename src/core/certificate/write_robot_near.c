/* SPDX-License-Identifier: BSD-3-Clause */
/* The claim that somewhere along a motion two bodies are within delta: the place of the motion, a point of the robot's
 * part, and how the other body's nearest point is found. Both are drawn in by more than the rounding of both programs.
 */
#include <math.h>

#include "base/rounding.h"
#include "certificate/partition.h"
#include "certificate/partition_robot.h"
#include "certificate/write.h"

/* Of the errors of places here: the checker's own are up to ten times as large. */
static const double ERRORS = 256.0;
#define ROOM 640.0

/* By so many errors a claim may be lifted: a point that is drawn into a thin body moves by more than the error. */
static const double LIFTED = 1024.0;

/* ---- who and when ---- */

/* The convex body that a part of the robot is, NULL of a mesh. */
static const cprox_body *body_of_part(const cprox_robot *robot, int32_t part) {
  size_t first = (size_t)part;
  while (first > 0 && robot->parts[first - 1].geometry == robot->parts[part].geometry) first--;
  const cprox_body *all = robot->given_geometries[robot->parts[part].geometry].body;
  const cprox_body *body = body_part_at(all, (size_t)part - first);
  return body->mesh ? NULL : body;
}

static const cprox_body *body_of_obstacle(const robot_scene *s, int32_t obstacle) {
  const robot_body *o = &s->obstacles[obstacle];
  return body_part_at(s->q->obstacles[o->index].body, (size_t)o->part);
}

/* What stands in a pair, as answers number it: geometries of the robot itself come after the obstacles. */
static int32_t number_of_standing(const robot_scene *s, const robot_pair *pair) {
  if (!pair->self) return s->obstacles[pair->standing].index;
  return s->parts[pair->standing].body.index + (mover_is_whole(&s->q->mover) ? (int32_t)s->q->n : 0);
}

/* The nearest pair of the two that the answer names, -1: there is none. The scene is at the place. */
static int32_t nearest_pair(robot_scene *s, const cprox_result *answer, robot_gap *nearest) {
  int32_t found = -1;
  for (size_t i = 0; i < s->n_pairs; i++) {
    const robot_pair *pair = &s->pairs[i];
    if (s->parts[pair->moving].body.index != answer->mover_part) continue;
    if (number_of_standing(s, pair) != answer->obstacle_index) continue;
    robot_gap gap;
    placed_robot_pair p;
    placed_robot_pair_at(s, (int32_t)i, &p);
    robot_pair_measure(p.moving, p.standing, (robot_accuracy){0}, &gap);
    if (gap.support_failed || (found >= 0 && gap.upper >= nearest->upper)) continue;
    *nearest = gap;
    found = (int32_t)i;
  }
  return found;
}

/* ---- the claim ---- */

cprox_status partition_robot_near(const robot_cover *c, const cprox_result *answer) {
  robot_scene *s = c->scene;
  const cprox_motion *m = s->motion;
  if (answer->obstacle_index < 0 || !isfinite(answer->t)) return CPROX_PRECISION;
  size_t segment = 0;
  while (segment + 1 < m->n_segments && m->times[segment + 1] <= answer->t) segment++;
  const double u = (answer->t - m->times[segment]) / (m->times[segment + 1] - m->times[segment]);
  const double at = fmin(fmax(u, 0.0), 1.0);
  robot_scene_enter(s, segment, at, at);
  robot_gap gap = {.support_failed = false};
  const int32_t index = nearest_pair(s, answer, &gap);
  if (index < 0) return CPROX_PRECISION;
  placed_robot_pair placed;
  placed_robot_pair_at(s, index, &placed);
  const robot_pair *pair = placed.pair;
  const robot_cover_elements *elements = pair->self ? NULL : &c->elements[pair->standing];
  if (elements && !elements->order.t) elements = NULL;
  const robot_body *moving = placed.moving, *standing = elements ? &elements->standing : placed.standing;
  const cprox_body *part = body_of_part(m->robot, pair->moving);
  const cprox_body *other = elements     ? elements->body
                            : pair->self ? body_of_part(m->robot, pair->standing)
                                         : body_of_obstacle(s, pair->standing);
  if (!part || !other)
    return workspace_fail(s->q->workspace, CPROX_INVALID,
                          "geometry %d is a mesh: its convex hull cannot prove that it is near",
                          (int)s->parts[part ? pair->standing : pair->moving].body.index);

  cprox_certificate *to = c->certificate;
  certificate_begin(to, 8, CPROX_CLAIM_NEAR, c->delta, (uint32_t)s->n_pairs);
  certificate_count(to, (uint32_t)index);
  certificate_count(to, (uint32_t)segment);
  certificate_number(to, at);
  const vec3 x =
      partition_point_of(part, to, placement_turn_back(&moving->side.at, vec_sub(gap.on_moving, moving->side.at.p)));
  const vec3 world = placement_apply(&moving->side.at, x);
  const double sizes = vec_norm(vec_sub(world, standing->side.at.p)) + moving->radius +
                       (elements ? elements->order.t->scale : standing->side.shape->scale);
  const double error = ERRORS * (moving->side.error + standing->side.error) + ROOM * ROUND_U * sizes;
  const vec3 y = placement_turn_back(&standing->side.at, vec_sub(world, standing->side.at.p));
  const double apart = elements ? partition_near_element(elements->body, elements->order.first, to, y, error)
                                : partition_near_point(other, to, y, error);

  /* a claim that is too tight is lifted by what rounding may have cost */
  const double margins =
      moving->side.margin - part->shape.margin + standing->side.margin - (elements ? 0.0 : other->shape.margin);
  const double needed = apart > 0.0 ? apart + error - margins : 0.0;
  if (apart > 0.0 && needed > c->delta - error) {
    if (!(needed <= c->delta + LIFTED * error)) return CPROX_PRECISION;
    certificate_restate(to, fmax(c->delta, needed + error));
  }
  return isfinite(apart) && !to->failed ? CPROX_OK : to->failed ? CPROX_MEMORY : CPROX_PRECISION;
}
