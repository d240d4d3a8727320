/* SPDX-License-Identifier: BSD-3-Clause */
/* Closed triangle meshes: what is refused, and the constructor. Their offset is in offset_mesh.c. */
#include <stdlib.h>
#include <string.h>

#include "fourier/solid.h"

/* A directed edge. */
typedef struct edge {
  uint32_t from, to;
} edge;

static int by_ends(const void *a, const void *b) {
  const edge *p = a, *q = b;
  if (p->from != q->from) return p->from < q->from ? -1 : 1;
  return p->to < q->to ? -1 : p->to > q->to;
}

/* Each directed edge stands once, and its reverse too. `edges` is room for 3m. */
static cprox_status check_closed(const uint32_t (*triangles)[3], size_t m, edge *edges, cprox_workspace *workspace) {
  for (size_t i = 0; i < m; i++)
    for (int j = 0; j < 3; j++) edges[3 * i + (size_t)j] = (edge){triangles[i][j], triangles[i][(j + 1) % 3]};
  qsort(edges, 3 * m, sizeof *edges, by_ends);
  for (size_t i = 0; i < 3 * m; i++) {
    const edge e = edges[i], reverse = {e.to, e.from};
    if (i > 0 && by_ends(&edges[i - 1], &e) == 0)
      return fourier_fail(
          workspace, CPROX_INVALID,
          "the edge from vertex %u to %u belongs to two triangles in the same direction: the mesh is not "
          "oriented, or more than two triangles meet there",
          e.from, e.to);
    if (!bsearch(&reverse, edges, 3 * m, sizeof *edges, by_ends))
      return fourier_fail(workspace, CPROX_INVALID, "the mesh is open: nothing borders the edge from vertex %u to %u",
                          e.from, e.to);
  }
  return CPROX_OK;
}

static cprox_status check_triangles(const vec3 *v, size_t n, const uint32_t (*triangles)[3], size_t m,
                                    cprox_workspace *workspace) {
  double volume = 0.0;
  for (size_t i = 0; i < m; i++) {
    for (int j = 0; j < 3; j++)
      if (triangles[i][j] >= n)
        return fourier_fail(workspace, CPROX_INVALID, "triangle %zu names vertex %u of %zu", i, triangles[i][j], n);
    const vec3 a = v[triangles[i][0]], b = vec_sub(v[triangles[i][1]], a), c = vec_sub(v[triangles[i][2]], a);
    const vec3 normal = vec_cross(b, c);
    if (!(vec_norm(normal) > 1e-14 * (vec_norm(b) + vec_norm(c)) * vec_norm(b)))
      return fourier_fail(workspace, CPROX_INVALID, "triangle %zu has no area", i);
    volume += vec_dot(vec_sub(a, v[triangles[0][0]]), normal);
  }
  if (!(volume > 0.0))
    return fourier_fail(workspace, CPROX_INVALID,
                        "the mesh holds the volume %g: triangles must be counter-clockwise from outside", volume / 6.0);
  return CPROX_OK;
}

cprox_status solid_create_mesh(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  const vec3 *vertices = d->points;
  const uint32_t(*triangles)[3] = d->triangles;
  const size_t n = d->n, m = d->n_triangles;
  if (!vertices || !triangles)
    return fourier_fail(workspace, CPROX_INVALID, "%s is NULL", vertices ? "triangles" : "points");
  if (n < 4 || m < 4)
    return fourier_fail(workspace, CPROX_INVALID, "a closed mesh needs 4 vertices and 4 triangles, got %zu and %zu", n,
                        m);
  if (n > UINT32_MAX || m > 100000000)
    return fourier_fail(workspace, CPROX_INVALID, "%zu vertices and %zu triangles are too many", n, m);
  cprox_status status = solid_check_points("vertex", vertices, n, 3, workspace);
  if (status == CPROX_OK) status = check_triangles(vertices, n, triangles, m, workspace);
  if (status != CPROX_OK) return status;

  edge *edges = malloc(3 * m * sizeof *edges);
  if (!edges) return solid_out_of_memory(workspace);
  status = check_closed(triangles, m, edges, workspace);
  free(edges);
  if (status != CPROX_OK) return status;

  piece p = piece_create(PIECE_SOUP);
  p.vertex = malloc(n * sizeof *p.vertex);
  p.triangle = malloc(m * sizeof *p.triangle);
  p.corner = malloc(3 * m * sizeof *p.corner);
  if (!p.vertex || !p.triangle || !p.corner) {
    piece_free(&p);
    return solid_out_of_memory(workspace);
  }
  memcpy(p.vertex, vertices, n * sizeof *p.vertex);
  memcpy(p.triangle, triangles, m * sizeof *p.triangle);
  for (size_t i = 0; i < 3 * m; i++) p.corner[i] = vertices[triangles[i / 3][i % 3]];
  p.n_vertices = n, p.n_triangles = m, p.n_corners = 3 * m;
  return solid_of_piece(3, &p, workspace, solid);
}
