/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/robot_depth.h"

#include <math.h>

#include "kinematics/motion.h"
#include "problem/level_of_detail.h"

/* ---- what there is ---- */

static bool geometry_has_mesh(const cprox_robot *robot, int32_t geometry) {
  for (size_t i = 0; i < robot->n_parts; i++)
    if (robot->parts[i].geometry == geometry && robot->parts[i].model.tree) return true;
  return false;
}

bool robot_depth_has_meshes(const query *q, size_t first, size_t last) {
  if (q->options.max_lod < CPROX_LOD_MESH) return false;
  const cprox_robot *robot = q->mover.motion->robot;
  for (size_t i = 0; i < robot->n_parts; i++)
    if (robot->parts[i].model.tree) return true;
  for (size_t i = first; i < last; i++)
    if (lod_has_tree(q->obstacles[i].body, CPROX_LOD_MESH)) return true;
  return false;
}

/* Whether the pair that was nearest has a mesh. */
static bool nearest_has_mesh(const query *q, const cprox_result *r) {
  const cprox_robot *robot = q->mover.motion->robot;
  if (geometry_has_mesh(robot, r->mover_part)) return true;
  if (mover_is_self(&q->mover)) return geometry_has_mesh(robot, r->obstacle_index);
  if ((size_t)r->obstacle_index >= q->n) return geometry_has_mesh(robot, r->obstacle_index - (int32_t)q->n);
  return body_part_at(q->obstacles[r->obstacle_index].body, (size_t)r->obstacle_part)->kind == CPROX_BODY_LOD;
}

/* ---- the two queries ---- */

query robot_depth_apart(const query *q) {
  query apart = *q;
  apart.is_signed = apart.options.signed_distance = false;
  return apart;
}

query robot_depth_hulls(const query *q) {
  query hulls = *q;
  if (hulls.options.max_lod > CPROX_LOD_HULL) hulls.options.max_lod = CPROX_LOD_HULL;
  hulls.set = NULL; /* hulls may reach out of the boxes */
  return hulls;
}

cprox_status robot_depth_join(const query *q, double cutoff, const cprox_result *apart, cprox_result *hulls) {
  cprox_status failure = hulls->status;
  if (hulls->obstacle_index < 0 || nearest_has_mesh(q, hulls)) hulls->upper = INFINITY;
  if (apart->upper < hulls->upper) {
    hulls->upper = apart->upper;
    if (apart->upper > 0.0 && apart->status != CPROX_OK) failure = apart->status;
  }
  hulls->lower = fmin(hulls->lower, hulls->upper);
  hulls->nodes += apart->nodes, hulls->distance_queries += apart->distance_queries;
  return query_conclude(q, cutoff, failure == CPROX_OK ? CPROX_OVERLAP : failure, hulls);
}
