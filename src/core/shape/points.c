/* SPDX-License-Identifier: BSD-3-Clause */
/* Point clouds: every point a ball of the same radius. */
#include <math.h>

#include "base/rounding.h"
#include "base/workspace.h"
#include "shape/construct.h"
#include "shape/elements.h"

cprox_status cprox_body_create_points(const cprox_vec3 *points, size_t n, double radius, size_t memory_limit,
                                      cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  if (n > 0 && !points) return workspace_fail(workspace, CPROX_INVALID, "points is NULL");
  if (!(radius >= 0.0 && radius <= 1e60))
    return workspace_fail(workspace, CPROX_INVALID, "radius is %g, must be finite and 0 or more", radius);
  cprox_status status =
      elements_check_count("points", TREE_POINTS, n, tree_blocks_bytes(n), TREE_BY_MORTON, memory_limit, workspace);
  if (status == CPROX_OK) status = elements_check_points("point", points, n, workspace);
  if (status != CPROX_OK) return status;
  tree_source source = {.kind = TREE_POINTS, .n = n, .points = points};
  cprox_body *made = NULL;
  status = elements_create(CPROX_BODY_POINTS, &source, n, TREE_BY_MORTON, radius, workspace, &made);
  if (status != CPROX_OK) return status;
  if (!tree_begin_family(made->tree)) {
    cprox_body_free(made);
    return body_out_of_memory(workspace);
  }
  *body = made;
  return CPROX_OK;
}

static cprox_status check_update(const cprox_body *previous, const uint32_t *changed, const cprox_vec3 *points,
                                 size_t n, const cprox_body *retired, cprox_workspace *workspace) {
  if (!previous || previous->kind != CPROX_BODY_POINTS)
    return workspace_fail(workspace, CPROX_INVALID, "previous is %s, not points",
                          previous ? cprox_body_kind_name(previous->kind) : "NULL");
  if (retired &&
      (retired == previous || retired->kind != CPROX_BODY_POINTS || !tree_is_family(previous->tree, retired->tree)))
    return workspace_fail(workspace, CPROX_INVALID,
                          "retired was not made from the same points, or is the previous body");
  if (n > UINT32_MAX) return workspace_fail(workspace, CPROX_INVALID, "%zu changes are too many", n);
  if (n > 0 && !(changed && points))
    return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", changed ? "points" : "changed");
  for (size_t i = 0; i < n; i++)
    if (changed[i] >= previous->tree->n)
      return workspace_fail(workspace, CPROX_INVALID, "change %zu is of point %u, but there are only %zu", i,
                            changed[i], previous->tree->n);
  return elements_check_points("the new place of change", points, n, workspace);
}

cprox_status cprox_body_update_points(const cprox_body *previous, const uint32_t *changed, const cprox_vec3 *points,
                                      size_t n, cprox_body *retired, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  const cprox_status checked = check_update(previous, changed, points, n, retired, workspace);
  if (checked != CPROX_OK) return checked;
  cprox_body *made = retired ? retired : body_allocate(NULL, CPROX_BODY_POINTS);
  tree *t =
      made ? tree_update(previous->tree, changed, points, n, previous->centre, retired ? retired->tree : NULL) : NULL;
  if (!t) {
    if (!retired) cprox_body_free(made);
    return body_out_of_memory(workspace);
  }
  *made = *previous;
  made->tree = t;
  made->ball_centre = previous->centre;
  made->shape.scale = t->scale;
  made->ball_radius = (t->scale + made->shape.margin) * (1.0 + 16.0 * ROUND_U) + 1e-100;
  *body = made;
  return CPROX_OK;
}
