/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/deviation.h"

#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "problem/obstacles.h"

/* ---- axes ---- */

static const deviation *axis_deviation(robot_scene *s, int32_t axis) {
  axis_deviations *state = &s->deviations[axis];
  if (state->found != s->node) {
    state->of = errors_of_axis(s->motion, s->q->errors, axis, s->centre.segment, s->centre.u, &s->over);
    state->found = s->node;
  }
  return &state->of;
}

/* ---- parts ---- */

/* A sum over the axes from one up to, not including, another one above it. */
static deviation along_chain(robot_scene *s, int32_t from, int32_t to, vec3 centre, double radius, double *travel) {
  for (int32_t i = from; i != to; i = s->motion->robot->axes[i].parent) axis_deviation(s, i);
  return errors_along_chain(s->motion, s->axes, s->deviations, from, to, centre, radius, travel);
}

/* Against what stands in the world; not counting how obstacles turn. */
static part_deviation part_deviation_of(robot_scene *s, int32_t part, const robot_body *body) {
  const cprox_error_bounds *b = s->q->errors->bounds;
  const double scale = ROUND_UP * s->q->errors->scale, radius = body->core;
  const int32_t axis = s->motion->robot->parts[part].axis;
  part_deviation d = {.found = s->node};
  d.joints = along_chain(s, axis, -1, body->side.at.p, radius, &d.travel);
  d.places = errors_of_base(s->q->errors, body->side.at.p, radius, d.travel);
  d.places.middle += scale * (b->object_position + b->sensor + (axis >= 0 ? b->flex : 0.0));
  return d;
}

/* Of whole parts it is found once a node. */
static const part_deviation *whole_part(robot_scene *s, int32_t part, const robot_body *body) {
  part_deviation *state = &s->part_deviations[part];
  if (state->found != s->node) *state = part_deviation_of(s, part, body);
  return state;
}

/* ---- pairs ---- */

/* Where an obstacle turns about a point, the part turns about it against the obstacle, from wherever it may be: the
 * shorter arm of both counts. */
static deviation turn_of_obstacle(const robot_scene *s, double reach, double arm, const part_deviation *part) {
  const double angle = ROUND_UP * s->q->errors->scale * s->q->errors->bounds->object_rotation;
  if (!(angle > 0.0)) return (deviation){0.0, 0.0};
  const deviation off = deviation_sum(part->joints, part->places);
  const double middle = lesser(reach, arm + off.middle),
               most = lesser(reach, arm + off.middle + part->travel + off.growth);
  return (deviation){angle * middle, angle * (most - middle)};
}

deviation deviation_of_cluster(robot_scene *s, int32_t part) {
  const part_deviation *whole = whole_part(s, part, robot_scene_part(s, part));
  const deviation turn = turn_of_obstacle(s, s->q->errors->object_size, INFINITY, whole);
  return deviation_sum(deviation_sum(whole->joints, whole->places), turn);
}

static deviation of_self_pair(robot_scene *s, const robot_pair *pair, const robot_body *moving,
                              const robot_body *standing, deviation *places) {
  const cprox_robot *robot = s->motion->robot;
  const int32_t axis[2] = {robot->parts[pair->moving].axis, robot->parts[pair->standing].axis};
  const int32_t common = pair->common;
  double travel;
  const deviation d = along_chain(s, axis[0], common, moving->side.at.p, moving->core, &travel);
  const deviation e = along_chain(s, axis[1], common, standing->side.at.p, standing->core, &travel);
  const double flex = ROUND_UP * s->q->errors->scale * s->q->errors->bounds->flex;
  *places = (deviation){flex * ((axis[0] >= 0) + (axis[1] >= 0)), 0.0};
  return deviation_sum(deviation_sum(d, e), *places);
}

deviation deviation_of_pair(robot_scene *s, const robot_pair *pair, const robot_body *moving,
                            const robot_body *standing, deviation *places) {
  if (pair->self) return of_self_pair(s, pair, moving, standing, places);
  const part_deviation part = pair->element[0] == ROBOT_WHOLE ? *whole_part(s, pair->moving, moving)
                                                              : part_deviation_of(s, pair->moving, moving);
  const cprox_obstacle *obstacle = &s->q->obstacles[standing->index];
  const double arm = vec_norm(vec_sub(moving->side.at.p, obstacle->pose.position)) + moving->core;
  *places = deviation_sum(part.places, turn_of_obstacle(s, obstacle_reach(obstacle), ROUND_UP * arm, &part));
  return deviation_sum(part.joints, *places);
}

/* ---- along a normal ---- */

/* The axes between both sides of a pair, that nearest to the moving side first; the world stands. */
static size_t axes_between(robot_scene *s, const robot_pair *pair) {
  const cprox_robot *robot = s->motion->robot;
  const int32_t from = robot->parts[pair->moving].axis, to = pair->self ? robot->parts[pair->standing].axis : -1;
  const int32_t common = robot_common_axis(robot, from, to);
  size_t n = 0;
  for (int32_t i = from; i != common; i = robot->axes[i].parent) s->chain[n++].axis = i;
  size_t first = n;
  for (int32_t i = to; i != common; i = robot->axes[i].parent) s->chain[n++].axis = i;
  for (size_t k = n; first + 1 < k; first++) {
    const int32_t swapped = s->chain[first].axis;
    s->chain[first].axis = s->chain[--k].axis;
    s->chain[k].axis = swapped;
  }
  return n;
}

/* How fast the points of a side come down along n as one axis turns: at the shape's x it is a·x + b. */
typedef struct descent_rate {
  vec3 a;
  double b;
} descent_rate;

static descent_rate rate_along(const robot_scene *s, int32_t index, const placement *at, vec3 n) {
  const robot_axis *axis = &s->motion->robot->axes[index];
  const placement *moved = &s->axes[index].frame;
  const vec3 z = placement_turn(moved, axis->z);
  if (axis->kind == AXIS_PRISMATIC) return (descent_rate){vec(0, 0, 0), vec_dot(n, z)};
  const vec3 w = vec_cross(n, z);
  return (descent_rate){placement_turn_back(at, w), vec_dot(w, vec_sub(at->p, moved->p))};
}

/* Adds e |a·x + b| of each vertex, or of the corners of the box round what has none. */
static void add_losses(const bound_side *side, descent_rate rate, double e, double *losses) {
  const convex *shape = side->shape;
  const vec3 a = rate.a;
  if (shape->x) {
    const double *restrict x = shape->x, *restrict y = shape->y, *restrict z = shape->z;
    double *restrict to = losses;
    for (int32_t i = 0; i < shape->n; i++) to[i] += e * fabs(a.x * x[i] + a.y * y[i] + a.z * z[i] + rate.b);
    return;
  }
  const double b = rate.b + vec_dot(a, side->middle);
  for (int i = 0; i < 8; i++) {
    const double x = i & 1 ? a.x : -a.x, y = i & 2 ? a.y : -a.y, z = i & 4 ? a.z : -a.z;
    losses[i] += e * fabs(b + x * side->half.x + y * side->half.y + z * side->half.z);
  }
}

bool deviation_losses(robot_scene *s, const placed_robot_pair *p, vec3 n, double normal_rate, bool over,
                      bound_side *side) {
  enum { CORNERS = 8 };
  const size_t count = side->shape->x ? (size_t)side->shape->n : CORNERS;
  double *losses = workspace_reserve(s->q->workspace, WORKSPACE_ROBOT_LOSSES, count * sizeof *losses);
  if (!losses) return false;
  for (size_t i = 0; i < count; i++) losses[i] = 0.0;

  /* from the moving side on: lever arms over the node, how far the axes so far move it, all turns of both kinds */
  const robot_axis *axes = s->motion->robot->axes;
  const size_t n_axes = axes_between(s, p->pair);
  const double radius = p->nominal->core;
  double moved = 0.0, turns = 0.0, off = 0.0;
  if (!p->pair->self) off = s->q->errors->scale * s->q->errors->bounds->base_rotation;
  for (size_t k = 0; k < n_axes; k++) {
    const int32_t i = s->chain[k].axis;
    const axis_state *state = &s->axes[i];
    const double shift = over && s->motion->axis_moves[i] ? state->shift : 0.0;
    const deviation *e = axis_deviation(s, i);
    double arm = 1.0;
    if (axes[i].kind != AXIS_PRISMATIC) {
      const vec3 away = vec_sub(side->at.p, state->frame.p);
      arm =
          ROUND_UP *
          (vec_norm(axes[i].kind == AXIS_REVOLUTE ? vec_cross(placement_turn(&state->frame, axes[i].z), away) : away) +
           radius);
      turns += shift, off += e->middle + (over ? e->growth : 0.0);
    }
    s->scratch[k] = axes[i].kind == AXIS_PRISMATIC ? arm : arm + moved;
    moved += shift * arm;
  }

  /* what an axis does along n where it is in the middle; that changes with the axes on either side, and errors of those
   * nearer to the standing side turn it */
  double constant = 0.0, any = 0.0, tipside = 0.0;
  for (size_t k = 0; k < n_axes; k++) {
    const int32_t i = s->chain[k].axis;
    const bool turning = axes[i].kind != AXIS_PRISMATIC;
    const double arm = s->scratch[k], shift = over && s->motion->axis_moves[i] ? s->axes[i].shift : 0.0;
    const deviation *known = axis_deviation(s, i);
    const double e = known->middle + (over ? known->growth : 0.0);
    if (turning) off -= e;
    const double bends = greater(off, 0.0) + (turning ? 0.5 * e : 0.0);
    if (e > 0.0) add_losses(side, rate_along(s, i, &side->at, n), e, losses);
    constant += e * arm * (bends + greater(turns, 0.0)) + (turning ? e * tipside : 0.0);
    any += e * arm;
    if (turning) turns -= shift;
    tipside += shift * arm;
  }
  const double places = p->places.middle + (over ? p->places.growth : 0.0);
  const double errors = p->errors.middle + (over ? p->errors.growth : 0.0), turned = 0.5 * normal_rate;
  constant = ROUND_UP * (constant + places + turned * (any + places));
  const double most = ROUND_UP * (1.0 + turned) * errors;
  side->loss = 0.0;
  for (size_t i = 0; i < count; i++) {
    losses[i] = lesser(ROUND_UP * losses[i] + constant, most);
    side->loss = greater(losses[i], side->loss);
  }
  side->losses = side->shape->x ? losses : NULL;
  return true;
}
