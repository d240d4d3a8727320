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

/* Appends half-spaces with normals of unit length; false where memory is out. */
static bool add_planes(piece *p, const double (*region)[4], size_t n) {
  double(*plane)[4] = realloc(p->plane, (p->n_planes + n) * sizeof *plane);
  if (!plane) return false;
  p->plane = plane;
  for (size_t i = 0; i < n; i++, p->n_planes++) {
    const double norm = vec_norm(vec(region[i][0], region[i][1], region[i][2]));
    for (int j = 0; j < 4; j++) plane[p->n_planes][j] = region[i][j] / norm;
  }
  return true;
}

bool piece_polytope_faces(const piece *p, double grow, points *out) {
  const double size = (1.0 + 1e-9) * (vec_norm(vec(p->size[0], p->size[1], p->size[2])) + sqrt(3.0) * grow);
  return polytope_soup((const double(*)[4])p->plane, p->n_planes, grow, p->centre, size, out);
}

/* A box in space as the polytope of its faces. */
static bool box_to_polytope(piece *p) {
  double face[6][4];
  for (int i = 0; i < 6; i++) {
    const double sign = i & 1 ? -1.0 : 1.0;
    const vec3 u = vec(sign * p->turn[i / 2], sign * p->turn[3 + i / 2], sign * p->turn[6 + i / 2]);
    face[i][0] = u.x, face[i][1] = u.y, face[i][2] = u.z, face[i][3] = vec_dot(u, p->centre) + p->size[i / 2];
  }
  p->kind = PIECE_SOUP;
  return add_planes(p, (const double(*)[4])face, 6);
}

/* Clips a polytope, whose faces are made anew: a soup's caps would be cut again and again. */
static bool clip_polytope(piece *p, const double (*region)[4], size_t n) {
  points corners = {0};
  const bool ok = add_planes(p, region, n) && piece_polytope_faces(p, 0.0, &corners);
  free(p->corner);
  p->corner = corners.at, p->n_corners = corners.n;
  return ok;
}

/* Adds the region to what clips the piece, and clips its corners. round: the region has many half-spaces. */
static bool clip_piece(piece *p, int dimension, const double (*region)[4], size_t n, bool round) {
  if (round && p->kind == PIECE_BOX && dimension == 3 && !box_to_polytope(p)) return false;
  if (piece_is_polytope(p)) return clip_polytope(p, region, n);
  if (p->kind == PIECE_BOX && !box_to_corners(p, dimension)) return false;
  const size_t first = p->n_planes;
  if (!add_planes(p, region, n)) return false;
  points corners = {.at = p->corner, .n = p->n_corners, .room = p->n_corners};
  for (size_t i = first; i < p->n_planes; i++)
    (p->kind == PIECE_POLYGON ? clip_loop : clip_soup)(&corners, p->plane[i]);
  p->corner = corners.at, p->n_corners = corners.n;
  return !corners.failed;
}

/* Tangents of a body, in evenly spread directions; they contain it. */
enum { TANGENTS_IN_PLANE = 32, TANGENTS_IN_SPACE = 48 };

static cprox_status add_tangents(const cprox_body *body, int dimension, cprox_workspace *workspace,
                                 double (*plane)[4]) {
  const cprox_body_info info = cprox_body_get_info(body);
  const int n = dimension == 2 ? TANGENTS_IN_PLANE : TANGENTS_IN_SPACE;
  for (int i = 0; i < n; i++) {
    const double z = dimension == 2 ? 0.0 : 1.0 - (2.0 * i + 1.0) / n, r = sqrt(1.0 - z * z);
    const double angle = dimension == 2 ? 6.28318530717958647693 * i / n : 2.39996322972865332 * i;
    const vec3 u = vec(r * cos(angle), r * sin(angle), z);
    const double height = cprox_body_support(body, u, NULL);
    if (!isfinite(height) || !isfinite(info.radius))
      return fourier_fail(workspace, CPROX_INVALID, "a %s is not bounded: it is no region",
                          cprox_body_kind_name(info.kind));
    plane[i][0] = u.x, plane[i][1] = u.y, plane[i][2] = u.z;
    plane[i][3] = height + 1e-12 * (info.radius + vec_norm(info.centre)); /* its rounding, and that of u's length */
  }
  return CPROX_OK;
}

static cprox_status check_planes(const cprox_solid *solid, const double (*region)[4], size_t n,
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
  return CPROX_OK;
}

static cprox_status check_pieces(const cprox_solid *solid, bool round, cprox_workspace *workspace) {
  for (size_t i = 0; i < solid->n; i++) {
    const piece_kind kind = solid->pieces[i].kind;
    if (round && kind == PIECE_SOUP && !piece_is_polytope(&solid->pieces[i]))
      return fourier_fail(workspace, CPROX_INVALID, "piece %zu is a mesh: in space a body clips boxes only", i);
    if (kind != PIECE_BOX && kind != PIECE_POLYGON && !(kind == PIECE_SOUP))
      return fourier_fail(workspace, CPROX_INVALID,
                          "piece %zu cannot be clipped: only boxes, polygons and meshes can; give one that holds it",
                          i);
  }
  return CPROX_OK;
}

static cprox_status clip_solid(const cprox_solid *solid, const double (*region)[4], size_t n, bool round,
                               cprox_workspace *workspace, cprox_solid **clipped) {
  cprox_solid *made = solid_allocate(solid->dimension, solid->n);
  if (!made) return solid_out_of_memory(workspace);
  const double no_turn[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  size_t kept = 0;
  for (size_t i = 0; i < solid->n; i++) {
    piece *p = &made->pieces[kept];
    if (!piece_copy(&solid->pieces[i], no_turn, vec(0, 0, 0), p) ||
        !clip_piece(p, solid->dimension, region, n, round)) {
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

cprox_status solid_create_clipped(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **clipped) {
  const cprox_solid *solid = d->solid;
  if (!solid) return fourier_fail(workspace, CPROX_INVALID, "solid is NULL");
  cprox_status status = d->body && d->n == 0 ? CPROX_OK : check_planes(solid, d->region, d->n, workspace);
  if (status == CPROX_OK) status = check_pieces(solid, d->body != NULL, workspace);
  if (status != CPROX_OK) return status;
  const size_t n = d->n + (!d->body ? 0 : solid->dimension == 2 ? TANGENTS_IN_PLANE : TANGENTS_IN_SPACE);
  double(*region)[4] = malloc((n + 1) * sizeof *region);
  if (!region) return solid_out_of_memory(workspace);
  if (d->n > 0) memcpy(region, d->region, d->n * sizeof *region);
  if (d->body) status = add_tangents(d->body, solid->dimension, workspace, region + d->n);
  if (status == CPROX_OK)
    status = clip_solid(solid, (const double(*)[4])region, n, d->body != NULL, workspace, clipped);
  free(region);
  return status;
}
