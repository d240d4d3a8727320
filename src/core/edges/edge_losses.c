/* SPDX-License-Identifier: BSD-3-Clause */
#include "edges/edge_losses.h"

#include <math.h>

#include "edges/edge_build.h"
#include "kinematics/errors.h"
#include "problem/obstacles.h"

/* Single precision places what is in a part no farther than this, by the largest distance from its frame. */
#define EDGE_PLACE 0x1p-20

/* Lever arms of lanes are off by the places of the part and of the axis, by the direction of the axis, and by what they
 * are computed with: each of them by less than the part's room. doc/rounding.md */
enum { ROUND_ARM = 4 };

bool edge_losses_begin(const query *q, const cprox_edge_checker *c, size_t first, size_t last, edge_losses *l) {
  edge_arena sizes = {0};
  for (int filled = 0; filled < 2; filled++) {
    l->still = edge_take(&sizes, c->n_frames, sizeof *l->still);
    l->by_rate = edge_take(&sizes, c->n_frames, sizeof *l->by_rate);
    l->most = edge_take(&sizes, c->n_frames, sizeof *l->most);
    l->slack = edge_take(&sizes, c->n_parts, sizeof *l->slack);
    l->standing = edge_take(&sizes, c->n_parts, sizeof *l->standing);
    l->pairs = edge_take(&sizes, c->n_lane_pairs, sizeof *l->pairs);
    l->axis_of = edge_take(&sizes, c->n_frames, sizeof *l->axis_of);
    if (filled) break;
    char *memory = workspace_reserve(q->workspace, WORKSPACE_EDGE_LOSSES, sizes.bytes);
    if (!memory) return false;
    sizes = (edge_arena){.at = memory};
  }
  l->axis_of[0] = -1;
  for (size_t i = 0; i < q->mover.motion->robot->n_axes; i++)
    if (c->frame_of[i] > 0) l->axis_of[c->frame_of[i]] = (int32_t)i;

  const cprox_error_bounds *b = q->errors->bounds;
  const double scale = q->errors->scale;
  const vec3 origin = vec_sub(b->base_origin, c->base);
  l->base_origin[0] = (float)origin.x, l->base_origin[1] = (float)origin.y, l->base_origin[2] = (float)origin.z;
  const double rounded = EDGE_U * vec_norm(origin);
  l->base_rotation = edge_float_above(scale * b->base_rotation);
  l->object_rotation = edge_float_above(scale * b->object_rotation);
  l->places =
      edge_float_above(scale * (b->base_position + b->base_rotation * rounded + b->object_position + b->sensor));
  l->flex = edge_float_above(scale * b->flex);
  double reach = 0.0, far = -INFINITY;
  for (size_t i = first; i < last; i++) {
    const double ends = obstacle_reach(&q->obstacles[i]);
    if (ends < INFINITY)
      reach = greater(ends, reach);
    else
      far = greater(vec_norm(vec_sub(q->obstacles[i].pose.position, c->base)), far);
  }
  l->object_reach = edge_float_above(reach), l->object_far = edge_float_above(far);
  return true;
}

static void bound_axis(const query *q, const motion_interval *over, size_t f, edge_losses *l) {
  const cprox_motion *m = q->mover.motion;
  const axis_error e = errors_of_axis_over(m, q->errors, l->axis_of[f], over);
  const double duration = (over->b - over->a) * (m->times[over->first + 1] - m->times[over->first]);
  const bool by_rate = duration > 0.0 && e.by_speed < 1e18 * duration; /* else it is off by the most at all times */
  l->most[f] = edge_float_above(e.most);
  l->still[f] = by_rate ? edge_float_above(e.still) : l->most[f];
  l->by_rate[f] = by_rate ? edge_float_above(e.by_speed / duration) : 0.0f;
}

/* A part is in a ball about an axis, anywhere on the edge. */
static double loss_of_axis(const cprox_edge_checker *c, const edge_motion *edge, const edge_losses *l,
                           const edge_part *part, int32_t f) {
  const double arm = edge->bounds[part->frame].reach - edge->bounds[f].reach + part->farthest;
  return (double)l->most[f] * (c->frames[f].shifts ? 1.0 : arm + ROUND_WORLD * edge->bounds[part->frame].reach);
}

static double standing_loss(const cprox_edge_checker *c, const edge_motion *edge, const edge_losses *l, size_t i) {
  const edge_part *part = &c->parts[i];
  const float *o = l->base_origin;
  const double reach = edge_motion_reach(c, edge, i) + (double)l->slack[i];
  double off = (double)l->places + (part->frame > 0 ? (double)l->flex : 0.0) +
               (double)l->base_rotation * (reach + vec_norm(vec((double)o[0], (double)o[1], (double)o[2])));
  for (int32_t f = part->frame; f > 0; f = c->frames[f].parent) off += loss_of_axis(c, edge, l, part, f);
  return off + (double)l->object_rotation * greater((double)l->object_reach, (double)l->object_far + reach + off);
}

static double pair_loss(const cprox_edge_checker *c, const edge_motion *edge, const edge_losses *l,
                        const edge_pair *pair) {
  const edge_part *one = &c->parts[pair->a], *other = &c->parts[pair->b];
  double off = (double)l->flex * ((one->frame > 0) + (other->frame > 0));
  for (int32_t f = one->frame, g = other->frame; f != g;) {
    if (f > g)
      off += loss_of_axis(c, edge, l, one, f), f = c->frames[f].parent;
    else
      off += loss_of_axis(c, edge, l, other, g), g = c->frames[g].parent;
  }
  return off;
}

void edge_losses_over(const query *q, const cprox_edge_checker *c, const motion_interval *over, const edge_motion *edge,
                      edge_losses *l) {
  for (size_t f = 1; f < c->n_frames; f++) bound_axis(q, over, f, l);
  for (size_t i = 0; i < c->n_parts; i++) {
    const edge_part *part = &c->parts[i];
    l->slack[i] = edge_float_above(EDGE_PLACE * part->farthest + ROUND_ARM * (double)edge->room[i] +
                                   ROUND_WORLD * vec_norm(c->base));
    l->standing[i] = edge_float_above(ROUND_UP * standing_loss(c, edge, l, i));
  }
  for (size_t i = 0; i < c->n_lane_pairs; i++)
    l->pairs[i] = edge_float_above(ROUND_UP * pair_loss(c, edge, l, &c->lane_pairs[i]));
}
