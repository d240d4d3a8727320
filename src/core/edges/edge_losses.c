/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges/edge_losses.h"

#include <math.h>

#include "edges/edge_build.h"
#include "kinematics/errors.h"
#include "problem/obstacles.h"

/* Single precision places what is in a part no farther than this, by the largest distance from its frame. */
#define EDGE_PLACE 0x1p-20

bool edge_losses_begin(const query *q, const cprox_edge_checker *c, size_t first, size_t last, edge_losses *l) {
  const size_t n_axes = q->mover.motion->robot->n_axes, rows = MOTION_ROWS * q->mover.motion->row_size;
  edge_arena sizes = {0};
  for (int filled = 0; filled < 2; filled++) {
    l->axes = edge_take(&sizes, n_axes, sizeof *l->axes);
    l->rows = edge_take(&sizes, rows, sizeof *l->rows);
    l->off = edge_take(&sizes, n_axes, sizeof *l->off);
    l->standing = edge_take(&sizes, c->n_parts, sizeof *l->standing);
    l->most = edge_take(&sizes, c->n_parts, sizeof *l->most);
    l->axis_of = edge_take(&sizes, c->n_frames, sizeof *l->axis_of);
    l->standing_room = edge_take(&sizes, c->n_parts, sizeof *l->standing_room);
    l->pairs = edge_take(&sizes, c->n_lane_pairs, sizeof *l->pairs);
    if (filled) break;
    char *memory = workspace_reserve(q->workspace, WORKSPACE_EDGE_LOSSES, sizes.bytes + 64);
    if (!memory) return false;
    sizes = (edge_arena){.at = memory + 64 - (uintptr_t)memory % 64};
  }
  l->axis_of[0] = -1;
  for (size_t i = 0; i < n_axes; i++)
    if (c->frame_of[i] > 0) l->axis_of[c->frame_of[i]] = (int32_t)i;
  l->object_reach = 0.0, l->object_far = -INFINITY;
  for (size_t i = first; i < last; i++) {
    const double reach = obstacle_reach(&q->targets[i]);
    if (reach < INFINITY)
      l->object_reach = greater(reach, l->object_reach);
    else
      l->object_far = greater(vec_norm(vec_sub(q->targets[i].pose.position, c->base)), l->object_far);
  }
  return true;
}

/* A ball round what a part has in lanes, without its margins. */
typedef struct part_ball {
  int32_t axis;
  vec3 centre;
  double radius;
} part_ball;

static part_ball ball_of(const query *q, const cprox_edge_checker *c, const edge_losses *l, const edge_part *part) {
  part_ball ball = {.axis = l->axis_of[part->frame],
                    .centre = vec((double)part->centre[0], (double)part->centre[1], (double)part->centre[2]),
                    .radius = (double)part->core + EDGE_PLACE * part->farthest + ROUND_WORLD * vec_norm(c->base)};
  if (ball.axis < 0) {
    ball.centre = vec_add(c->base, ball.centre);
    return ball;
  }
  const placement turn = edge_turn_of_axis(&q->mover.motion->robot->axes[ball.axis]);
  ball.centre = placement_apply(&l->axes[ball.axis].frame, placement_apply(&turn, ball.centre));
  return ball;
}

/* Anywhere in the interval, by all that is off. */
static double standing_loss(const query *q, const cprox_edge_checker *c, const edge_losses *l, const part_ball *ball) {
  const cprox_error_bounds *b = q->errors->bounds;
  const double scale = q->errors->scale;
  double travel = 0.0;
  const deviation joints =
      errors_along_chain(q->mover.motion, l->axes, l->off, ball->axis, -1, ball->centre, ball->radius, &travel);
  const double arm = vec_norm(vec_sub(ball->centre, b->base_origin)) + ball->radius + travel;
  const double off = joints.middle + joints.growth +
                     scale * (b->base_position + b->base_rotation * arm + b->object_position + b->sensor +
                              (ball->axis >= 0 ? b->flex : 0.0));
  /* an obstacle without an end stands, and the part turns about its pose's position */
  const double about = l->object_far + vec_norm(vec_sub(ball->centre, c->base)) + ball->radius + travel + off;
  return ROUND_UP * (off + scale * b->object_rotation * greater(l->object_reach, about));
}

static double pair_loss(const query *q, const edge_losses *l, const part_ball *a, const part_ball *b) {
  const cprox_motion *m = q->mover.motion;
  const int32_t common = robot_common_axis(m->robot, a->axis, b->axis);
  double travel;
  const deviation one = errors_along_chain(m, l->axes, l->off, a->axis, common, a->centre, a->radius, &travel),
                  other = errors_along_chain(m, l->axes, l->off, b->axis, common, b->centre, b->radius, &travel);
  const double bent = q->errors->scale * q->errors->bounds->flex * ((a->axis >= 0) + (b->axis >= 0));
  return ROUND_UP * (one.middle + one.growth + other.middle + other.growth + bent);
}

void edge_losses_over(const query *q, const cprox_edge_checker *c, const motion_interval *over, edge_losses *l) {
  const cprox_motion *m = q->mover.motion;
  motion_node(m, over->first, over->a, over->b, l->rows, l->axes);
  for (size_t f = 1; f < c->n_frames; f++)
    l->off[l->axis_of[f]].of =
        errors_of_axis(m, q->errors, l->axis_of[f], over->first, 0.5 * (over->a + over->b), over);
  for (size_t i = 0; i < c->n_parts; i++) {
    const part_ball ball = ball_of(q, c, l, &c->parts[i]);
    l->standing[i] = standing_loss(q, c, l, &ball);
  }
  for (size_t i = 0; i < c->n_lane_pairs; i++) {
    const part_ball a = ball_of(q, c, l, &c->parts[c->lane_pairs[i].a]),
                    b = ball_of(q, c, l, &c->parts[c->lane_pairs[i].b]);
    l->pairs[i] = edge_float_above(pair_loss(q, l, &a, &b));
  }
}

void edge_losses_add(const query *q, const cprox_edge_checker *c, const motion_interval *over, edge_losses *l,
                     edge_motion *m) {
  edge_losses_over(q, c, over, l);
  for (size_t i = 0; i < c->n_parts; i++) l->standing_room[i] = edge_float_above((double)m->room[i] + l->standing[i]);
  m->standing_room = l->standing_room, m->pair_losses = l->pairs;
}
