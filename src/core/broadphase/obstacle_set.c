/* SPDX-License-Identifier: BSD-3-Clause */
/* Many obstacles in one BVH. */
#include "broadphase/obstacle_set.h"

#include <math.h>
#include <stdlib.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "kinematics/link_model.h"
#include "problem/level_of_detail.h"
#include "shape/body.h"

/* The box of an obstacle in the world, rounding included. False where it has none. */
static bool box_of(const cprox_obstacle *obstacle, vec3 *low, vec3 *high) {
  if (obstacle->synchronized) return false;
  const query q = {.obstacles = obstacle, .n = 1};
  const candidate c = {0};
  if (!obstacle->body) {
    double sizes;
    const candidate_ball round = candidate_bounding_ball(&q, &c, &sizes);
    const double r = round.radius + obstacle->margin + ROUND_BALLS * ROUND_U * sizes;
    *low = vec_sub(round.centre, vec(r, r, r));
    *high = vec_add(round.centre, vec(r, r, r));
    return isfinite(r);
  }
  const cprox_body *body = obstacle->body;
  if (!isfinite(body->ball_radius)) return false;
  const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
  double reach[6];
  const double sizes = vec_norm(body->ball_centre) + body->ball_radius + vec_norm(f.position) + obstacle->margin;
  for (int k = 0; k < 6; k++) {
    const double sign = k < 3 ? 1.0 : -1.0;
    const vec3 d = vec(k % 3 == 0 ? sign : 0.0, k % 3 == 1 ? sign : 0.0, k % 3 == 2 ? sign : 0.0);
    const double h = cprox_body_support(body, frame_turn_to_local(&f, d), NULL);
    reach[k] = h + vec_dot(d, f.position) + obstacle->margin + body->shape.slack + 256.0 * ROUND_U * sizes;
  }
  *high = vec(reach[0], reach[1], reach[2]);
  *low = vec(-reach[3], -reach[4], -reach[5]);
  return vec_finite(*low) && vec_finite(*high);
}

static bool has_elements(const cprox_obstacle *obstacle) {
  return obstacle->body && (lod_has_tree(obstacle->body, CPROX_LOD_MESH) || obstacle->body->field);
}

/* Boxes of obstacles that have one, the others apart. */
static void sort_obstacles(obstacle_bvh *set) {
  vec3 low = vec(INFINITY, INFINITY, INFINITY), high = vec(-INFINITY, -INFINITY, -INFINITY);
  for (size_t i = 0; i < set->n; i++) {
    const cprox_obstacle *obstacle = &set->obstacles[i];
    set->has_clock = set->has_clock || obstacle->synchronized;
    set->has_elements = set->has_elements || has_elements(obstacle);
    set->has_curves = set->has_curves || !obstacle->body;
    set->has_solids = set->has_solids || (obstacle->body && part_model_is_solid(obstacle->body));
    set->has_fields = set->has_fields || (obstacle->body && obstacle->body->field);
    vec3 *a = &set->low[set->n_boxes], *b = &set->high[set->n_boxes];
    if (!box_of(obstacle, a, b)) {
      set->unbounded[set->n_unbounded++] = (uint32_t)i;
      continue;
    }
    low = vec(fmin(low.x, a->x), fmin(low.y, a->y), fmin(low.z, a->z));
    high = vec(fmax(high.x, b->x), fmax(high.y, b->y), fmax(high.z, b->z));
    set->of_box[set->n_boxes++] = (uint32_t)i;
  }
  if (set->n_boxes > 0) set->centre = vec_axpy(vec_scale(0.5, low), 0.5, high);
}

static obstacle_bvh *allocate(size_t n) {
  obstacle_bvh *set = calloc(1, sizeof *set);
  if (!set) return NULL;
  set->n = n;
  set->low = calloc(2 * n + 1, sizeof *set->low);
  set->of_box = calloc(2 * n + 1, sizeof *set->of_box);
  if (set->low && set->of_box) {
    set->high = set->low + n;
    set->unbounded = set->of_box + n;
    return set;
  }
  obstacle_bvh_free(set);
  return NULL;
}

cprox_status obstacle_bvh_create(const cprox_obstacle *obstacles, size_t n, cprox_workspace *workspace,
                                 obstacle_bvh **set) {
  if (n > TREE_MOST_ELEMENTS)
    return workspace_fail(workspace, CPROX_INVALID, "%zu obstacles, at most %zu are possible", n, TREE_MOST_ELEMENTS);
  obstacle_bvh *made = allocate(n);
  if (!made) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a set of %zu obstacles", n);
  made->obstacles = obstacles;
  sort_obstacles(made);
  if (made->n_boxes > 0) {
    const tree_source source = {
        .kind = TREE_BOXES, .n = made->n_boxes, .points = made->low, .high = made->high, .centre = made->centre};
    made->boxes = tree_create(&source, TREE_BY_AREA);
    if (!made->boxes) {
      obstacle_bvh_free(made);
      return workspace_fail(workspace, CPROX_MEMORY, "no memory for a set of %zu obstacles", n);
    }
    for (size_t i = 0; i < made->n_boxes; i++) {
      made->low[i] = vec_sub(made->low[i], made->centre);
      made->high[i] = vec_sub(made->high[i], made->centre);
    }
  }
  *set = made;
  return CPROX_OK;
}

void obstacle_bvh_free(obstacle_bvh *set) {
  if (!set) return;
  free(set->low);    /* high is in the same block */
  free(set->of_box); /* unbounded is in the same block */
  tree_free(set->boxes);
  free(set);
}
