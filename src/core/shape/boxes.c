/* SPDX-License-Identifier: BSD-3-Clause */
/* Boxes along the axes: the occupied leaves of an octree. */
#include "base/workspace.h"
#include "shape/elements.h"

cprox_status cprox_body_create_boxes(const cprox_vec3 *low, const cprox_vec3 *high, size_t n, size_t memory_limit,
                                     cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  if (n > 0 && !(low && high)) return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", low ? "high" : "low");
  cprox_status status = elements_check_count("boxes", TREE_BOXES, n, 0, TREE_BY_MORTON, memory_limit, workspace);
  if (status == CPROX_OK) status = elements_check_points("the low corner of box", low, n, workspace);
  if (status == CPROX_OK) status = elements_check_points("the high corner of box", high, n, workspace);
  if (status != CPROX_OK) return status;
  for (size_t i = 0; i < n; i++) {
    if (low[i].x > high[i].x || low[i].y > high[i].y || low[i].z > high[i].z)
      return workspace_fail(workspace, CPROX_INVALID, "box %zu: low (%g, %g, %g) is not below high (%g, %g, %g)", i,
                            low[i].x, low[i].y, low[i].z, high[i].x, high[i].y, high[i].z);
  }
  tree_source source = {.kind = TREE_BOXES, .n = n, .points = low, .high = high};
  return elements_create(CPROX_BODY_OCTREE, &source, n, TREE_BY_MORTON, 0.0, workspace, body);
}
