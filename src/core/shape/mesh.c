/* SPDX-License-Identifier: BSD-3-Clause */
/* Triangle meshes, as surfaces and, where they are closed, as solids. */
#include <stdlib.h>

#include "base/workspace.h"
#include "bvh/winding.h"
#include "shape/construct.h"
#include "shape/elements.h"

static cprox_status check_triangles(const uint32_t (*triangles)[3], size_t m, size_t n, cprox_workspace *workspace) {
  for (size_t i = 0; i < m; i++)
    for (int k = 0; k < 3; k++)
      if (triangles[i][k] >= n)
        return workspace_fail(workspace, CPROX_INVALID, "triangle %zu names vertex %u, but there are only %zu", i,
                              triangles[i][k], n);
  return CPROX_OK;
}

/* ---- closedness ------------------------------------------------------------------------------------------------------- */

typedef struct placed_vertex {
  vec3 at;
  uint32_t index;
} placed_vertex;

static int compare_numbers(double a, double b) {
  return (a > b) - (a < b);
}

static int compare_places(const void *a, const void *b) {
  const vec3 p = ((const placed_vertex *)a)->at, q = ((const placed_vertex *)b)->at;
  const int x = compare_numbers(p.x, q.x), y = compare_numbers(p.y, q.y);
  return x ? x : y ? y : compare_numbers(p.z, q.z);
}

/* One number for each place: vertices with equal coordinates share theirs. */
static void merge_vertices(const vec3 *vertices, size_t n, placed_vertex *sorted, uint32_t *merged) {
  for (size_t i = 0; i < n; i++) sorted[i] = (placed_vertex){vertices[i], (uint32_t)i};
  qsort(sorted, n, sizeof *sorted, compare_places);
  for (size_t i = 0; i < n; i++) {
    const bool same = i > 0 && vec_equal(sorted[i].at, sorted[i - 1].at);
    merged[sorted[i].index] = same ? merged[sorted[i - 1].index] : (uint32_t)i;
  }
}

typedef struct edge {
  uint32_t low, high;
  int32_t way;
} edge;

static int compare_edges(const void *a, const void *b) {
  const edge *p = a, *q = b;
  if (p->low != q->low) return p->low < q->low ? -1 : 1;
  return (p->high > q->high) - (p->high < q->high);
}

/* Every edge is run through as often one way as the other: then the winding number is a whole one off the surface. */
static bool edges_balance(const uint32_t (*triangles)[3], size_t m, const uint32_t *merged, edge *edges) {
  size_t n = 0;
  for (size_t i = 0; i < m; i++) {
    for (int k = 0; k < 3; k++) {
      const uint32_t a = merged[triangles[i][k]], b = merged[triangles[i][(k + 1) % 3]];
      if (a != b) edges[n++] = a < b ? (edge){a, b, 1} : (edge){b, a, -1};
    }
  }
  qsort(edges, n, sizeof *edges, compare_edges);
  int64_t sum = 0;
  for (size_t i = 0; i < n; i++) {
    sum += edges[i].way;
    const bool last = i + 1 == n || compare_edges(&edges[i], &edges[i + 1]) != 0;
    if (last && sum != 0) return false;
  }
  return n > 0;
}

/* False where memory is out. No triangles close nothing. */
static bool find_closedness(const vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m, bool *closed) {
  *closed = false;
  if (n == 0 || m == 0) return true;
  placed_vertex *sorted = malloc(n * sizeof *sorted);
  uint32_t *merged = malloc(n * sizeof *merged);
  edge *edges = malloc(3 * m * sizeof *edges);
  const bool enough = sorted && merged && edges;
  if (enough) {
    merge_vertices(vertices, n, sorted, merged);
    *closed = edges_balance(triangles, m, merged, edges);
  }
  free(sorted);
  free(merged);
  free(edges);
  return enough;
}

/* ---- the constructor -------------------------------------------------------------------------------------------------- */

cprox_status cprox_body_create_mesh(const cprox_vec3 *vertices, size_t n, const uint32_t (*triangles)[3], size_t m,
                                    cprox_mesh_fill fill, size_t memory_limit, cprox_workspace *workspace,
                                    cprox_body **body) {
  if (!body) return workspace_fail(workspace, CPROX_INVALID, "body is NULL: nowhere to put the handle");
  if (n > UINT32_MAX)
    return workspace_fail(workspace, CPROX_INVALID, "%zu vertices, at most %u are possible", n, UINT32_MAX);
  if (n > 0 && !vertices) return workspace_fail(workspace, CPROX_INVALID, "vertices is NULL");
  if (m > 0 && !triangles) return workspace_fail(workspace, CPROX_INVALID, "triangles is NULL");
  if (fill != CPROX_MESH_SURFACE && fill != CPROX_MESH_SOLID)
    return workspace_fail(workspace, CPROX_INVALID, "fill is %d, neither surface nor solid", (int)fill);
  const size_t extra = fill == CPROX_MESH_SOLID ? winding_bytes_needed(tree_most_nodes(m, TREE_BY_AREA)) : 0;
  cprox_status status =
      elements_check_count("triangles", TREE_TRIANGLES, m, extra, TREE_BY_AREA, memory_limit, workspace);
  if (status == CPROX_OK) status = elements_check_points("vertex", vertices, n, workspace);
  if (status == CPROX_OK) status = check_triangles(triangles, m, n, workspace);
  if (status != CPROX_OK) return status;

  bool closed = false;
  if (fill == CPROX_MESH_SOLID && !find_closedness(vertices, n, triangles, m, &closed))
    return body_out_of_memory(workspace);
  tree_source source = {.kind = TREE_TRIANGLES, .n = m, .points = vertices, .triangles = triangles};
  cprox_body *made = NULL;
  status = elements_create(CPROX_MESH, &source, n, TREE_BY_AREA, 0.0, workspace, &made);
  if (status != CPROX_OK) return status;
  if (closed && !(made->winding = winding_create(made->tree))) {
    cprox_body_free(made);
    return body_out_of_memory(workspace);
  }
  *body = made;
  return CPROX_OK;
}
