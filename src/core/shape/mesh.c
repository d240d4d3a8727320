/* SPDX-License-Identifier: BSD-3-Clause */
/* Triangle meshes, as surfaces and, where they are closed, as solids. */
#include <stdlib.h>

#include "base/workspace.h"
#include "bvh/winding.h"
#include "shape/construct.h"
#include "shape/elements.h"
#include "shape/places.h"

static cprox_status check_triangles(const uint32_t (*triangles)[3], size_t m, size_t n, cprox_workspace *workspace) {
  for (size_t i = 0; i < m; i++)
    for (int k = 0; k < 3; k++)
      if (triangles[i][k] >= n)
        return workspace_fail(workspace, CPROX_INVALID, "triangle %zu names vertex %u, but there are only %zu", i,
                              triangles[i][k], n);
  return CPROX_OK;
}

/* ---- closedness ---- */

/* A use of an edge, in the list of its vertex with the lower number. */
typedef struct edge_use {
  uint32_t high;
  int32_t way;
} edge_use;

static int compare_uses(const void *a, const void *b) {
  const uint32_t p = ((const edge_use *)a)->high, q = ((const edge_use *)b)->high;
  return (p > q) - (p < q);
}

/* Whether the uses of each edge of one vertex add up to 0. Sorts them. */
static bool uses_balance(edge_use *uses, size_t n) {
  enum { FEW = 24 };
  if (n > FEW) {
    qsort(uses, n, sizeof *uses, compare_uses);
  } else {
    for (size_t i = 1; i < n; i++) {
      const edge_use moved = uses[i];
      size_t k = i;
      for (; k > 0 && uses[k - 1].high > moved.high; k--) uses[k] = uses[k - 1];
      uses[k] = moved;
    }
  }
  int64_t sum = 0;
  for (size_t i = 0; i < n; i++) {
    sum += uses[i].way;
    const bool last = i + 1 == n || uses[i].high != uses[i + 1].high;
    if (last && sum != 0) return false;
  }
  return true;
}

/* Every edge is run through as often one way as the other: then the winding number is a whole one off the surface. The
 * uses are sorted by the lower vertex in linear time; `start` has room for n + 1 numbers, `uses` for 3 m. */
static bool edges_balance(const uint32_t (*triangles)[3], size_t m, const uint32_t *merged, size_t n, size_t *start,
                          edge_use *uses) {
  for (size_t i = 0; i <= n; i++) start[i] = 0;
  for (size_t i = 0; i < m; i++) {
    for (int k = 0; k < 3; k++) {
      const uint32_t a = merged[triangles[i][k]], b = merged[triangles[i][(k + 1) % 3]];
      if (a != b) start[(a < b ? a : b) + 1]++;
    }
  }
  for (size_t i = 0; i < n; i++) start[i + 1] += start[i];
  const size_t all = start[n];
  for (size_t i = 0; i < m; i++) {
    for (int k = 0; k < 3; k++) {
      const uint32_t a = merged[triangles[i][k]], b = merged[triangles[i][(k + 1) % 3]];
      if (a != b) uses[start[a < b ? a : b]++] = a < b ? (edge_use){b, 1} : (edge_use){a, -1};
    }
  }
  /* now start[i] is where the list of vertex i ends */
  for (size_t i = 0, first = 0; i < n; first = start[i++])
    if (!uses_balance(uses + first, start[i] - first)) return false;
  return all > 0;
}

/* False where memory is out. No triangles close nothing. */
static bool find_closedness(const vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m, bool *closed) {
  *closed = false;
  if (n == 0 || m == 0) return true;
  places merging = {0};
  uint32_t *merged = malloc(n * sizeof *merged);
  size_t *start = malloc((n + 1) * sizeof *start);
  edge_use *uses = calloc(3 * m, sizeof *uses);
  const bool enough = places_begin(&merging, n) && merged && start && uses;
  if (enough) {
    for (size_t i = 0; i < n; i++) merged[i] = places_number(&merging, vertices[i]);
    *closed = edges_balance(triangles, m, merged, n, start, uses);
  }
  places_free(&merging);
  free(merged);
  free(start);
  free(uses);
  return enough;
}

/* ---- the constructors ---- */

cprox_status cprox_body_create_mesh(const cprox_vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m,
                                    cprox_mesh_fill fill, size_t memory_limit, cprox_workspace *workspace,
                                    cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  if (n > UINT32_MAX)
    return workspace_fail(workspace, CPROX_INVALID, "%zu vertices, at most %u are possible", n, UINT32_MAX);
  if (n > 0 && !vertices) return workspace_fail(workspace, CPROX_INVALID, "vertices is NULL");
  if (m > 0 && !triangles) return workspace_fail(workspace, CPROX_INVALID, "triangles is NULL");
  if (fill != CPROX_MESH_FILL_SURFACE && fill != CPROX_MESH_FILL_SOLID)
    return workspace_fail(workspace, CPROX_INVALID, "fill is %d, neither surface nor solid", (int)fill);
  const size_t extra = fill == CPROX_MESH_FILL_SOLID ? winding_bytes_needed(tree_most_nodes(m, TREE_BY_AREA)) : 0;
  cprox_status status =
      elements_check_count("triangles", TREE_TRIANGLES, m, extra, TREE_BY_AREA, memory_limit, workspace);
  if (status == CPROX_OK) status = elements_check_points("vertex", vertices, n, workspace);
  if (status == CPROX_OK) status = check_triangles(triangles, m, n, workspace);
  if (status != CPROX_OK) return status;

  bool closed = false;
  if (fill == CPROX_MESH_FILL_SOLID && !find_closedness(vertices, n, triangles, m, &closed))
    return body_out_of_memory(workspace);
  tree_source source = {.kind = TREE_TRIANGLES, .n = m, .points = vertices, .triangles = triangles};
  cprox_body *made = NULL;
  status = elements_create(CPROX_BODY_MESH, &source, n, TREE_BY_AREA, 0.0, workspace, &made);
  if (status != CPROX_OK) return status;
  if (closed && !(made->winding = winding_create(made->tree))) {
    cprox_body_free(made);
    return body_out_of_memory(workspace);
  }
  *body = made;
  return CPROX_OK;
}

cprox_status cprox_body_create_surface(const cprox_body *mesh, cprox_workspace *workspace, cprox_body **body) {
  WORKSPACE_USE(workspace);
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  if (!mesh || mesh->kind != CPROX_BODY_MESH)
    return workspace_fail(workspace, CPROX_INVALID, "the body is %s, must be a mesh",
                          mesh ? cprox_body_kind_name(mesh->kind) : "NULL");
  cprox_body *made = body_allocate(NULL, CPROX_BODY_MESH);
  if (!made) return body_out_of_memory(workspace);
  made->tree = mesh->tree;
  made->borrows_tree = true;
  made->centre = mesh->centre;
  made->ball_centre = mesh->ball_centre;
  made->ball_radius = mesh->ball_radius;
  made->shape.margin = mesh->shape.margin;
  made->shape.scale = mesh->shape.scale;
  *body = made;
  return CPROX_OK;
}
