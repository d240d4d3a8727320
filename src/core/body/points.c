/* SPDX-License-Identifier: BSD-3-Clause */
/* Point clouds: every point a ball of the same radius. */
#include <math.h>

#include "base/workspace.h"
#include "body/elements.h"

cprox_status cprox_body_create_points(const cprox_vec3 *points, size_t n, double radius, size_t memory_limit,
                                      cprox_workspace *workspace, cprox_body **body) {
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  if (n > 0 && !points) return workspace_fail(workspace, CPROX_INVALID, "points is NULL");
  if (!(radius >= 0.0 && radius <= 1e60))
    return workspace_fail(workspace, CPROX_INVALID, "radius is %g, must be finite and 0 or more", radius);
  cprox_status status = elements_check_count("points", TREE_POINTS, n, 0, TREE_BY_MORTON, memory_limit, workspace);
  if (status == CPROX_OK) status = elements_check_points("point", points, n, workspace);
  if (status != CPROX_OK) return status;
  tree_source source = {.kind = TREE_POINTS, .n = n, .points = points};
  return elements_create(CPROX_POINTS, &source, n, TREE_BY_MORTON, radius, workspace, body);
}
