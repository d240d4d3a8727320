/* SPDX-License-Identifier: BSD-3-Clause */
/* A mesh and its convex hull as one body. */
#include <math.h>

#include "base/workspace.h"
#include "shape/cluster_hulls.h"
#include "shape/construct.h"

/* A hull that leaves out what the mesh has would call hits clear: along the axes, the diagonals of their planes and of
 * space the mesh must not reach farther. */
static cprox_status check_cover(const cprox_body *hull, double excess, const cprox_body *mesh,
                                cprox_workspace *workspace) {
  const double size = vec_norm(hull->ball_centre) + hull->ball_radius + vec_norm(mesh->ball_centre) + mesh->ball_radius;
  static const double SIGN[3] = {-1.0, 0.0, 1.0};
  for (size_t i = 0; i < 27; i++) {
    const vec3 d = vec(SIGN[i % 3], SIGN[i / 3 % 3], SIGN[i / 9]);
    if (vec_norm2(d) == 0.0) continue;
    const double out = cprox_body_support(mesh, d, NULL) - cprox_body_support(hull, d, NULL);
    const double allowed = vec_norm(d) * (excess + hull->shape.slack + 1e-12 * size);
    if (!(out <= allowed))
      return workspace_fail(workspace, CPROX_INVALID,
                            "the mesh reaches %g m beyond the hull along (%g, %g, %g), excess is only %g",
                            out / vec_norm(d), d.x, d.y, d.z, excess);
  }
  return CPROX_OK;
}

cprox_status cprox_body_create_lod(const cprox_body *hull, double excess, const cprox_body *mesh,
                                   cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  if (!hull || !mesh) return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", hull ? "mesh" : "hull");
  if (!hull->shape.ops || !isfinite(hull->ball_radius))
    return workspace_fail(workspace, CPROX_INVALID, "the hull is a %s, must be convex and bounded",
                          cprox_body_kind_name(hull->kind));
  if (!mesh->tree)
    return workspace_fail(workspace, CPROX_INVALID, "the finer model is a %s, must be a mesh, points or boxes",
                          cprox_body_kind_name(mesh->kind));
  if (!(excess >= 0.0) || !isfinite(excess))
    return workspace_fail(workspace, CPROX_INVALID, "excess is %g, must be finite and 0 or more", excess);
  if (excess > LENGTH_MOST)
    return workspace_fail(workspace, CPROX_INVALID, "excess is %g, must be at most %g", excess, LENGTH_MOST);
  const cprox_status covered = check_cover(hull, excess, mesh, workspace);
  if (covered != CPROX_OK) return covered;

  cprox_body *made = body_allocate(NULL, CPROX_BODY_LOD);
  const bool triangles = mesh->tree->kind == TREE_TRIANGLES;
  if (made && triangles) made->clusters = cluster_hulls_create(mesh->tree);
  if (!made || (triangles && !made->clusters)) {
    cprox_body_free(made);
    return body_out_of_memory(workspace);
  }
  made->hull = hull;
  made->mesh = mesh;
  made->excess = excess;
  made->centre = mesh->centre;
  made->ball_centre = mesh->ball_centre;
  made->ball_radius = mesh->ball_radius;
  made->shape.scale = mesh->shape.scale;
  *body = made;
  return CPROX_OK;
}
