/* SPDX-License-Identifier: BSD-3-Clause */
#include "curve_query/report.h"

#include "base/rounding.h"
#include "curve/relative_curve.h"
#include "narrowphase/witness.h"
#include "problem/carried_shape.h"
#include "problem/radius.h"

/* The direction from a surface point to the moving object's centre. The normal is that of the best lower bound: a
 * search that stops early, because its upper bound is good enough, leaves another direction between the two points that
 * attain that upper bound. */
static vec3 witness_direction(vec3 centre, vec3 surface, vec3 normal) {
  const vec3 between = vec_sub(centre, surface);
  const double length = vec_norm(between), sizes = vec_norm(centre) + vec_norm(surface);
  const bool aligned = vec_norm2(normal) == 0.0 || length - vec_dot(between, normal) <= 64.0 * ROUND_U * sizes;
  return aligned ? normal : vec_scale(1.0 / length, between);
}

/* The two surface points and their normal: where the ball of the mover and the padded obstacle come closest, or one
 * point of both where they overlap; signed, the two ends of the way out. */
static void report_points(const query *q, double margin, const curve_finding *seen, vec3 position, cprox_result *r) {
  const vec3 centre = vec_add(seen->centre, position), surface = vec_add(seen->surface, position);
  const double apart = seen->distance, radius = q->mover.radius;
  const vec3 normal = apart > 0.0 ? witness_direction(centre, surface, seen->normal) : seen->normal;
  r->normal = normal;
  if (q->is_signed || apart > margin + radius) {
    r->witness_obstacle = vec_axpy(surface, margin, normal);
    r->witness_mover = vec_axpy(centre, -radius, normal);
  } else {
    /* the padded obstacle's nearest point to the ball's centre */
    r->witness_mover = r->witness_obstacle = apart > margin ? vec_axpy(surface, margin, normal) : centre;
  }
}

/* A carried body that the search has seen apart from what stands, or in contact with it: it has kept the two points, or
 * the one. False where it has not, as of boxes with the same axes. */
static bool report_parts(const query *q, const placed_pair *p, const curve_finding *seen, vec3 position,
                         cprox_result *r) {
  if (!p->shape || !p->carried || !q->mover.body) return false;
  const bool ball = p->carried->kind == CPROX_BODY_POINT || p->carried->kind == CPROX_BODY_SPHERE;
  const double radius = p->offset - p->margin + (ball ? p->carried->shape.margin : 0.0);
  if (seen->is_contact && seen->parts_known && seen->distance <= 0.0) {
    r->normal = seen->normal;
    r->mover_part = p->which.mover_part;
    r->witness_mover = r->witness_obstacle = vec_add(frame_to_world(&p->frame, seen->on_standing), position);
    return true;
  }
  if (!(ball || seen->parts_known) || !(seen->distance > p->margin + radius)) return false;
  const vec3 on_standing = frame_to_world(&p->frame, seen->on_standing),
             on_carried = frame_to_world(&p->frame, seen->on_carried);
  const vec3 between = vec_sub(on_carried, on_standing), along = vec_scale(1.0 / vec_norm(between), between);
  r->normal = seen->normal;
  r->mover_part = p->which.mover_part;
  r->witness_obstacle = vec_add(vec_axpy(on_standing, p->margin, along), position);
  r->witness_mover = vec_add(vec_axpy(on_carried, -radius, along), position);
  return true;
}

/* The same where a body is carried, its curve at the centre, or what stands is on the clock: asked of the pair that
 * both make there. */
static cprox_status report_pair(const query *q, const placed_pair *p, const curve_finding *seen, vec3 position,
                                cprox_result *r) {
  const cprox_obstacle moved = {.body = q->mover.body ? q->mover.body : &carried_point,
                                .pose = {.position = vec_add(seen->centre, position), .orientation = {1, 0, 0, 0}},
                                .margin = q->mover.radius};
  cprox_obstacle standing = *p->obstacle;
  if (!p->shape) { /* of a curve, the point alone */
    standing = (cprox_obstacle){.body = &carried_point,
                                .pose = {.position = seen->surface, .orientation = {1, 0, 0, 0}},
                                .margin = p->obstacle->margin};
  } else if (standing.synchronized) {
    standing.pose.position = position;
    if (!standing.body) standing.body = &carried_point;
  }
  const size_t part = p->shape ? (size_t)p->which.part : 0;
  pair_witness witness;
  const cprox_status status = pair_witness_of(&moved, (size_t)p->which.mover_part, &standing, part, p->lod,
                                              q->is_signed, q->workspace, &witness);
  if (status < 0) return status;
  const bool normal_known = vec_norm2(seen->normal) > 0.0;
  r->normal = normal_known ? seen->normal : witness.normal;
  r->mover_part = p->which.mover_part;
  r->witness_mover = witness.on_a, r->witness_obstacle = witness.on_b;
  return CPROX_OK;
}

/* The same pair with the radii that are seen there. */
static cprox_status report_radius(const query *q, const placed_pair *p, const curve_finding *seen, cprox_result *r) {
  query there = *q;
  placed_pair pair = *p;
  cprox_obstacle obstacle = *p->obstacle;
  there.mover.radius += radius_at(q->mover.radius_curve, seen->t, seen->at_end, q->workspace);
  obstacle.margin += radius_at(obstacle.radius_curve, seen->t, seen->at_end, q->workspace);
  pair.margin += obstacle.margin - p->obstacle->margin;
  pair.offset += there.mover.radius - q->mover.radius + (obstacle.margin - p->obstacle->margin);
  pair.obstacle = &obstacle;
  pair.radius_changes = false;
  return report_finding(&there, &pair, seen, r);
}

cprox_status report_finding(const query *q, const placed_pair *p, const curve_finding *seen, cprox_result *r) {
  if (!seen->found) return CPROX_OK;
  if (p->radius_changes) return report_radius(q, p, seen, r);
  const cprox_obstacle *obstacle = p->obstacle;
  vec3 position = vec(0, 0, 0); /* of the obstacle's curve then */
  r->t = seen->t;
  if (!p->shape) r->t_obstacle = seen->t_obstacle;
  if (obstacle->synchronized) {
    position = relative_position(obstacle->curve, &obstacle->pose, r->t, seen->at_end, q->workspace);
    r->t_obstacle = r->t;
  }
  const bool by_points = p->shape && (p->shape->tree || p->shape->field);
  if (!by_points && (q->mover.body || obstacle->synchronized)) {
    const cprox_status status = report_parts(q, p, seen, position, r) ? CPROX_OK : report_pair(q, p, seen, position, r);
    if (status < 0) return status;
  } else {
    report_points(q, p->margin, seen, position, r);
  }
  r->obstacle_index = p->which.obstacle, r->obstacle_part = p->which.part;
  if (seen->is_contact) r->witness_obstacle = r->witness_mover;
  return CPROX_OK;
}
