/* SPDX-License-Identifier: BSD-3-Clause */
/* What of a solid lies in a region. */
#include <stdlib.h>
#include <string.h>

#include "fourier/points.h"
#include "fourier/solid.h"

/* A box as a loop or a soup, which can be clipped. */
static void box_boundary(const piece *p, int dimension, points *out) {
  vec3 c[8];
  for (int i = 0; i < 8; i++) {
    const vec3 own = vec(i & 1 ? p->size[0] : -p->size[0], i & 2 ? p->size[1] : -p->size[1],
                         dimension == 2 ? 0.0 : (i & 4 ? p->size[2] : -p->size[2]));
    c[i] = vec_add(p->centre, rotate(p->turn, own));
  }
  if (dimension == 2) {
    const int order[4] = {0, 1, 3, 2};
    for (int i = 0; i < 4; i++) points_add(out, c[order[i]]);
    return;
  }
  static const int quad[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  for (int i = 0; i < 6; i++) {
    points_add_triangle(out, c[quad[i][0]], c[quad[i][1]], c[quad[i][2]]);
    points_add_triangle(out, c[quad[i][0]], c[quad[i][2]], c[quad[i][3]]);
  }
}

/* Gives a box the corners, and the sources of offsets, of a polygon or a mesh. */
static bool box_to_corners(piece *p, int dimension) {
  const bool plane = dimension == 2;
  points boundary = {0};
  box_boundary(p, dimension, &boundary);
  if (!boundary.failed) {
    p->vertex = malloc(boundary.n * sizeof *p->vertex);
    p->triangle = plane ? NULL : malloc(boundary.n / 3 * sizeof *p->triangle);
  }
  if (!p->vertex || (!plane && !p->triangle)) {
    free(boundary.at);
    return false;
  }
  p->kind = plane ? PIECE_POLYGON : PIECE_SOUP;
  p->corner = boundary.at, p->n_corners = boundary.n;
  if (plane) {
    memcpy(p->vertex, boundary.at, boundary.n * sizeof *p->vertex);
    p->n_vertices = boundary.n;
    return true;
  }
  for (size_t i = 0; i < boundary.n; i++) {
    size_t same = 0;
    while (same < p->n_vertices && !vec_equal(p->vertex[same], boundary.at[i])) same++;
    if (same == p->n_vertices) p->vertex[p->n_vertices++] = boundary.at[i];
    p->triangle[i / 3][i % 3] = (uint32_t)same;
  }
  p->n_triangles = boundary.n / 3;
  return true;
}

/* Adds the region to what clips the piece, and clips its corners. */
static bool clip_piece(piece *p, int dimension, const double (*region)[4], size_t n) {
  if (p->kind == PIECE_BOX && !box_to_corners(p, dimension)) return false;
  double(*plane)[4] = realloc(p->plane, (p->n_planes + n) * sizeof *plane);
  if (!plane) return false;
  p->plane = plane;
  points corners = {.at = p->corner, .n = p->n_corners, .room = p->n_corners};
  for (size_t i = 0; i < n; i++) {
    const double norm = vec_norm(vec(region[i][0], region[i][1], region[i][2]));
    for (int j = 0; j < 4; j++) plane[p->n_planes][j] = region[i][j] / norm;
    (p->kind == PIECE_POLYGON ? clip_loop : clip_soup)(&corners, plane[p->n_planes++]);
  }
  p->corner = corners.at, p->n_corners = corners.n;
  return !corners.failed;
}

static cprox_status check_region(const cprox_solid *solid, const double (*region)[4], size_t n,
                                 cprox_workspace *workspace) {
  if (n == 0 || !region) return fourier_fail(workspace, CPROX_INVALID, "the region has no half-space");
  for (size_t i = 0; i < n; i++) {
    const vec3 a = vec(region[i][0], region[i][1], region[i][2]);
    if (!vec_finite(a) || !isfinite(region[i][3]) || !(vec_norm(a) > SOLID_LEAST) || vec_norm(a) > SOLID_LARGEST)
      return fourier_fail(workspace, CPROX_INVALID, "half-space %zu of the region has the normal (%g, %g, %g) and %g",
                          i, a.x, a.y, a.z, region[i][3]);
    if (solid->dimension == 2 && a.z != 0.0)
      return fourier_fail(workspace, CPROX_INVALID, "half-space %zu of the region has c = %g, in the plane it is 0", i,
                          a.z);
  }
  for (size_t i = 0; i < solid->n; i++) {
    const piece_kind kind = solid->pieces[i].kind;
    if (kind != PIECE_BOX && kind != PIECE_POLYGON && !(kind == PIECE_SOUP))
      return fourier_fail(workspace, CPROX_INVALID,
                          "piece %zu cannot be clipped: only boxes, polygons and meshes can; give one that holds it",
                          i);
  }
  return CPROX_OK;
}

cprox_status solid_create_clipped(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **clipped) {
  const cprox_solid *solid = d->solid;
  const double(*region)[4] = d->region;
  const size_t n = d->n;
  if (!solid) return fourier_fail(workspace, CPROX_INVALID, "solid is NULL");
  cprox_status status = check_region(solid, region, n, workspace);
  if (status != CPROX_OK) return status;

  cprox_solid *made = solid_allocate(solid->dimension, solid->n);
  if (!made) return solid_out_of_memory(workspace);
  const double no_turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  size_t kept = 0;
  for (size_t i = 0; i < solid->n; i++) {
    piece *p = &made->pieces[kept];
    if (!piece_copy(&solid->pieces[i], no_turn, vec(0, 0, 0), p) || !clip_piece(p, solid->dimension, region, n)) {
      cprox_solid_free(made);
      return solid_out_of_memory(workspace);
    }
    if (p->n_corners > 0 && piece_measure(p, solid->dimension) > 0.0)
      kept++;
    else
      piece_free(p);
  }
  made->n = kept;
  if (kept == 0) {
    cprox_solid_free(made);
    return fourier_fail(workspace, CPROX_INVALID, "nothing of the solid lies in the region");
  }
  solid_bound(made);
  *clipped = made;
  return CPROX_OK;
}
