/* SPDX-License-Identifier: BSD-3-Clause */
#include "batch/obstacle_batch.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/frame.h"
#include "base/rounding.h"
#include "base/workspace.h"
#include "problem/placed_pair.h"
#include "problem/validate.h"
#include "shape/kinds.h"

/* ---- inscribed balls ---- */

/* How deep a point of the shape's frame lies inside, at least; 0 or less: not known to be inside. */
static double depth_at(const convex *shape, vec3 y) {
  convex_near near;
  if (shape->ops->kind == CPROX_BODY_POLYGON)
    convex_polygon_nearest_in_plane(shape, y, &near);
  else
    shape->ops->nearest(shape, y, NULL, &near);
  const double sizes = vec_norm(y) + shape->scale + shape->margin;
  return -near.distance - ROUND_UP * (shape->ops->near_rounding * ROUND_U * sizes + shape->slack);
}

/* Climbs from the origin of the shape's frame, by steps along the axes that shrink. A deep point makes fast answers,
 * none is needed. */
static double deepest(const convex *shape, vec3 *centre) {
  enum { HALVINGS = 8 };
  const int axes = shape->ops->kind == CPROX_BODY_POLYGON ? 2 : 3;
  double best = depth_at(shape, vec(0, 0, 0));
  *centre = vec(0, 0, 0);
  double step = 0.25 * shape->scale;
  for (int round = 0; round < HALVINGS; round++, step *= 0.5) {
    for (int k = 0; k < 2 * axes; k++) {
      const double by = k % 2 ? -step : step;
      const vec3 moved = vec_add(*centre, vec(k / 2 == 0 ? by : 0, k / 2 == 1 ? by : 0, k / 2 == 2 ? by : 0));
      const double depth = depth_at(shape, moved);
      if (!(depth > best)) continue;
      best = depth;
      *centre = moved;
    }
  }
  return best;
}

/* About a centre of the shape's frame: the ball round the core where its vertices are known, else the one through the
 * other ball. */
static double outer_radius(const cprox_body *body, vec3 centre) {
  const convex *shape = &body->shape;
  const vec3 ball = vec_sub(body->ball_centre, body->centre);
  double most = vec_norm(vec_sub(centre, ball)) + body->ball_radius;
  if (shape->n > 0) {
    most = 0.0;
    for (int32_t i = 0; i < shape->n; i++)
      most = fmax(most, vec_norm(vec_sub(vec(shape->x[i], shape->y[i], shape->z[i]), centre)));
  }
  return most;
}

static batch_core core_of(const placed_pair *p, candidate_ball round) {
  const cprox_body *body = p->shape;
  batch_core core = {.centre = round.centre, .inner = -1.0, .outer = round.radius};
  if (!body || !body_kind_of(body->kind)->has_cheap_depth) return core;
  const frame f = frame_create(&p->pose, body->centre);
  core.flat = body->kind == CPROX_BODY_POLYGON;
  if (core.flat && !f.about_z) return core;
  vec3 centre;
  const double depth = deepest(&body->shape, &centre);
  if (!(depth > 0.0)) return core;
  core.centre = frame_to_world(&f, centre);
  core.inner = depth * (1.0 - 2.0 * ROUND_U);
  core.outer = outer_radius(body, centre);
  return core;
}

/* ---- OBBs ---- */

/* How far the shape reaches both ways along an axis of its frame, which stands in its middle; rounding included. */
static double half_along(const convex *shape, vec3 axis) {
  const double core =
      greater(shape->ops->support(shape, axis, NULL, NULL), shape->ops->support(shape, vec_neg(axis), NULL, NULL));
  return core + shape->margin + ROUND_UP * (ROUND_SUPPORT * ROUND_U * (shape->scale + shape->margin) + shape->slack);
}

/* A ball says more of a sphere than any box. */
static void lay_obb(const placed_pair *p, batch_core *core) {
  const cprox_body *body = p->shape;
  if (!body || !body_kind_of(body->kind)->has_cheap_depth || body->kind == CPROX_BODY_SPHERE) return;
  const convex *shape = &body->shape;
  const frame f = p->frame;
  packet_obb *obb = &core->obb;
  memcpy(obb->r, f.r, sizeof obb->r);
  obb->position = f.position;
  obb->centre = f.centre;
  core->has_obb = true;
  core->is_obb = body->kind == CPROX_BODY_BOX;
  obb->half = vec(shape->size[0], shape->size[1], shape->size[2]);
  if (!core->is_obb)
    obb->half = vec(half_along(shape, vec(1, 0, 0)), half_along(shape, vec(0, 1, 0)), half_along(shape, vec(0, 0, 1)));
  core->obb_sizes = vec_norm(f.position) + vec_norm(f.centre) + vec_norm(obb->half);
  core->obb_turned = f.misturned;
  core->obb_misplaced = f.misplaced;
}

/* ---- the batch ---- */

static obstacle_batch *allocate(size_t n_obstacles, size_t n_parts) {
  obstacle_batch *batch = calloc(1, sizeof *batch);
  if (!batch) return NULL;
  const size_t n_clusters = (n_parts + CLUSTER - 1) / CLUSTER, padded = n_clusters * CLUSTER;
  const size_t padded_clusters = (n_clusters + CLUSTER - 1) / CLUSTER * CLUSTER;
  batch->n = n_obstacles;
  batch->balls.n = n_parts;
  batch->balls.padded = padded;
  batch->clusters.n = n_clusters;
  batch->clusters.padded = padded_clusters;
  batch->parts = calloc(n_parts + 1, sizeof *batch->parts);
  batch->cores = calloc(n_parts + 1, sizeof *batch->cores);
  batch->balls.x = calloc(5 * padded + 7 * padded_clusters + 1, sizeof(double));
  if (!batch->parts || !batch->cores || !batch->balls.x) {
    obstacle_batch_free(batch);
    return NULL;
  }
  batch->balls.y = batch->balls.x + padded;
  batch->balls.z = batch->balls.y + padded;
  batch->balls.reach = batch->balls.z + padded;
  batch->balls.sizes = batch->balls.reach + padded;
  double *next = batch->balls.sizes + padded;
  for (int axis = 0; axis < 3; axis++) {
    batch->clusters.low[axis] = next;
    batch->clusters.high[axis] = next + padded_clusters;
    next += 2 * padded_clusters;
  }
  batch->clusters.sizes = next;
  return batch;
}

/* The balls of one part. What is on the mover's clock has none that would hold for every mover. */
static void describe(obstacle_batch *batch, const query *q, size_t k) {
  const candidate *c = &batch->parts[k];
  const cprox_obstacle *obstacle = &batch->obstacles[c->obstacle];
  if (obstacle->synchronized) return;
  double placing;
  const candidate_ball round = candidate_bounding_ball(q, c, &placing);
  batch->balls.x[k] = round.centre.x;
  batch->balls.y[k] = round.centre.y;
  batch->balls.z[k] = round.centre.z;
  batch->balls.reach[k] = round.radius + obstacle->margin;
  batch->balls.sizes[k] = vec_norm(round.centre) + placing + batch->balls.reach[k];
  const placed_pair placed = placed_pair_resolve(q, c);
  batch->cores[k] = core_of(&placed, round);
  batch->cores[k].plane = obstacle->pose.position.z;
  batch->cores[k].margin = obstacle->margin;
  lay_obb(&placed, &batch->cores[k]);
}

/* All parts, those that stand together one after the other; what is everywhere comes last. False where memory is out.
 */
static bool list_parts(obstacle_batch *batch, const query *q) {
  batch_place *places = calloc(batch->balls.n + 1, sizeof *places);
  if (!places) return false;
  size_t bounded = 0, n = 0;
  for (size_t i = 0; i < batch->n; i++) {
    for (size_t part = 0; part < body_n_parts(batch->obstacles[i].body); part++) {
      batch_place place = {.part = {.obstacle = (int32_t)i, .part = (int32_t)part}};
      double unused;
      const candidate_ball round = candidate_bounding_ball(q, &place.part, &unused);
      place.at = round.centre;
      places[n++] = place;
      if (!isfinite(round.radius)) continue;
      places[n - 1] = places[bounded];
      places[bounded++] = place;
    }
  }
  batch_clusters_gather(places, bounded);
  for (size_t k = 0; k < n; k++) batch->parts[k] = places[k].part;
  free(places);
  return true;
}

cprox_status obstacle_batch_create(const cprox_obstacle *obstacles, size_t n, cprox_workspace *workspace,
                                   obstacle_batch **batch) {
  size_t n_parts = 0;
  for (size_t i = 0; i < n; i++) n_parts += body_n_parts(obstacles[i].body);
  obstacle_batch *made = allocate(n, n_parts);
  if (!made) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a batch of %zu obstacles", n);
  made->obstacles = obstacles;
  for (size_t i = 0; i < n; i++) made->synchronized = made->synchronized || obstacles[i].synchronized;
  const query q = {.obstacles = made->obstacles, .n = n};
  if (!list_parts(made, &q)) {
    obstacle_batch_free(made);
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for a batch of %zu obstacles", n);
  }
  for (size_t k = 0; k < n_parts; k++) describe(made, &q, k);
  batch_clusters_surround(made);
  *batch = made;
  return CPROX_OK;
}

void obstacle_batch_free(obstacle_batch *batch) {
  if (!batch) return;
  free(batch->parts);
  free(batch->cores);
  free(batch->balls.x); /* all arrays of the balls are one allocation */
  free(batch);
}
