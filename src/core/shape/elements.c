/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/elements.h"

#include <stdlib.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "bvh/winding.h"
#include "shape/cluster_hulls.h"
#include "shape/construct.h"

/* Fourth powers of lengths must not overflow. */
static const double MOST_LENGTH = 1e60;

/* ---- checks ---- */

cprox_status elements_check_points(const char *name, const vec3 *points, size_t n, cprox_workspace *workspace) {
  for (size_t i = 0; i < n; i++) {
    const vec3 p = points[i];
    if (!vec_finite(p))
      return workspace_fail(workspace, CPROX_INVALID, "%s %zu is not finite: (%g, %g, %g)", name, i, p.x, p.y, p.z);
    if (fmax(fabs(p.x), fmax(fabs(p.y), fabs(p.z))) > MOST_LENGTH)
      return workspace_fail(workspace, CPROX_INVALID, "%s %zu is (%g, %g, %g), farther than %g from the origin", name,
                            i, p.x, p.y, p.z, MOST_LENGTH);
  }
  return CPROX_OK;
}

cprox_status elements_check_count(const char *names, tree_kind kind, size_t n, size_t extra, tree_build build,
                                  size_t memory_limit, cprox_workspace *workspace) {
  if (n == 0) return workspace_fail(workspace, CPROX_INVALID, "there are no %s: at least 1 is needed", names);
  if (n > TREE_MOST_ELEMENTS)
    return workspace_fail(workspace, CPROX_INVALID, "%zu %s, at most %zu are possible", n, names, TREE_MOST_ELEMENTS);
  const size_t bytes = tree_bytes_needed(kind, n, build) + extra;
  if (bytes <= memory_limit) return CPROX_OK;
  return workspace_fail(workspace, CPROX_MEMORY, "%zu %s need up to %zu bytes, above the limit of %zu", n, names, bytes,
                        memory_limit);
}

/* ---- making ---- */

static void widen(vec3 *low, vec3 *high, vec3 p) {
  low->x = p.x < low->x ? p.x : low->x, high->x = p.x > high->x ? p.x : high->x;
  low->y = p.y < low->y ? p.y : low->y, high->y = p.y > high->y ? p.y : high->y;
  low->z = p.z < low->z ? p.z : low->z, high->z = p.z > high->z ? p.z : high->z;
}

static double reach_from(vec3 centre, const vec3 *points, size_t n, double reach2) {
  for (size_t i = 0; i < n; i++) {
    const double d2 = vec_norm2(vec_sub(points[i], centre));
    if (d2 > reach2) reach2 = d2;
  }
  return reach2;
}

cprox_status elements_create(cprox_body_kind kind, tree_source *source, size_t n_points, tree_build build,
                             double margin, cprox_workspace *workspace, cprox_body **body) {
  vec3 low = source->points[0], high = low;
  for (size_t i = 0; i < n_points; i++) {
    widen(&low, &high, source->points[i]);
    if (source->high) widen(&low, &high, source->high[i]);
  }
  source->centre = vec_axpy(vec_scale(0.5, low), 0.5, high);

  source->workspace = workspace;
  cprox_body *made = body_allocate(NULL, kind);
  if (made) made->tree = tree_create(source, build);
  if (!made || !made->tree) {
    const bool stopped = made && workspace_has_stopped(workspace);
    cprox_body_free(made);
    if (stopped)
      return workspace_fail(workspace, CPROX_INVALID, "stopped while the BVH of %zu elements was being built",
                            source->n);
    return body_out_of_memory(workspace);
  }
  made->centre = made->ball_centre = source->centre;
  double reach2 = reach_from(source->centre, source->points, n_points, 0.0);
  if (source->high) {
    /* a corner is as far as the farther of its two coordinates along each axis */
    const vec3 half = vec_axpy(vec_scale(0.5, high), -0.5, low);
    reach2 = vec_norm2(half);
  }
  made->shape.margin = margin;
  made->shape.scale = made->tree->scale;
  made->ball_radius = (sqrt(reach2) + margin) * (1.0 + 16.0 * ROUND_U) + 1e-100;
  *body = made;
  return CPROX_OK;
}

/* ---- queries --------------------------------------------------------------------------------------------------------
 * */

bool elements_are_solid(const cprox_body *body) {
  return body->mesh ? elements_are_solid(body->mesh) : body->kind != CPROX_BODY_MESH || body->winding;
}

size_t elements_bytes(const cprox_body *body) {
  if (body->clusters) return cluster_hulls_bytes(body->clusters);
  return body->tree ? sizeof *body + tree_bytes(body->tree) + winding_bytes(body->winding) : 0;
}

/* The best of a pack along a direction. */
static void support_of_pack(const tree *t, uint32_t pack, vec3 d, double *most, vec3 *at) {
  for (uint32_t lane = 0; lane < TREE_LANES; lane++) {
    vec3 corner[3];
    const int n = tree_corners(t, (tree_place){pack, lane}, corner);
    for (int k = 0; k < (t->kind == TREE_BOXES ? 1 : n); k++) {
      vec3 v = corner[k];
      if (t->kind == TREE_BOXES)
        v = vec(d.x > 0.0 ? corner[1].x : v.x, d.y > 0.0 ? corner[1].y : v.y, d.z > 0.0 ? corner[1].z : v.z);
      const double h = vec_dot(d, v);
      if (h > *most) *most = h, *at = v;
    }
  }
}

/* No corner in a lane's box is farther along the direction, as vec_dot() computes it: rounding keeps the order. */
static double support_of_lane(const tree_node *node, uint32_t l, vec3 d) {
  return vec_dot(d, vec(d.x > 0.0 ? node->high[0][l] : node->low[0][l], d.y > 0.0 ? node->high[1][l] : node->low[1][l],
                        d.z > 0.0 ? node->high[2][l] : node->low[2][l]));
}

double elements_support(const cprox_body *body, vec3 direction, vec3 *point) {
  const tree *t = body->tree;
  double most = -INFINITY, bounds[TREE_LANES * TREE_DEEPEST];
  uint32_t open[TREE_LANES * TREE_DEEPEST];
  size_t count = 0;
  vec3 at = vec(0, 0, 0);
  open[0] = 0, bounds[count++] = INFINITY;
  while (count > 0) {
    const uint32_t next = open[--count];
    if (!(bounds[count] > most)) continue;
    if (next & TREE_LEAF) {
      support_of_pack(t, next & ~TREE_LEAF, direction, &most, &at);
      continue;
    }
    /* the lane that promises most is opened first */
    const tree_node *node = &t->nodes[next];
    const size_t first = count;
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      if (!(node->lanes >> l & 1u)) continue;
      const double bound = support_of_lane(node, l, direction);
      if (!(bound > most)) continue;
      size_t i = count++;
      for (; i > first && bounds[i - 1] > bound; i--) open[i] = open[i - 1], bounds[i] = bounds[i - 1];
      open[i] = node->child[l], bounds[i] = bound;
    }
  }
  const double margin = body->shape.margin, norm = vec_norm(direction);
  if (point) *point = vec_add(vec_axpy(at, margin / norm, direction), body->centre);
  return most + norm * margin + vec_dot(direction, body->centre);
}

double elements_nearest(const cprox_body *body, vec3 point, vec3 *nearest) {
  const vec3 x = vec_sub(point, body->centre);
  const tree_hit hit = tree_nearest(body->tree, x, INFINITY);
  tree_near near;
  tree_element_near(body->tree, hit.at, x, &near);
  const double margin = body->shape.margin;
  const bool inside = body->winding && winding_is_inside(body->winding, body->tree, x);
  if (nearest) *nearest = vec_add(vec_axpy(near.point, margin, near.normal), body->centre);
  return inside ? -near.distance : near.distance - margin;
}
