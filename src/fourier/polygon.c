/* SPDX-License-Identifier: BSD-3-Clause */
/* Simple polygons: what is refused, and the constructor. Their offset is in offset.c. */
#include <stdlib.h>

#include "fourier/solid.h"

static double cross2(vec3 a, vec3 b) {
  return a.x * b.y - a.y * b.x;
}

static double side(vec3 a, vec3 b, vec3 c) {
  return cross2(vec_sub(b, a), vec_sub(c, a));
}

/* Whether c, collinear with a and b, lies on the segment between them. */
static bool within(vec3 a, vec3 b, vec3 c) {
  return fmin(a.x, b.x) <= c.x && c.x <= fmax(a.x, b.x) && fmin(a.y, b.y) <= c.y && c.y <= fmax(a.y, b.y);
}

static bool segments_meet(vec3 a, vec3 b, vec3 c, vec3 d) {
  const double s = side(a, b, c), t = side(a, b, d), u = side(c, d, a), v = side(c, d, b);
  if (((s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0)) && ((u > 0.0 && v < 0.0) || (u < 0.0 && v > 0.0))) return true;
  return (s == 0.0 && within(a, b, c)) || (t == 0.0 && within(a, b, d)) || (u == 0.0 && within(c, d, a)) ||
         (v == 0.0 && within(c, d, b));
}

/* Edges i and j, i < j, of n: neighbours may share their corner alone. */
static bool edges_meet(const vec3 *v, size_t n, size_t i, size_t j) {
  const vec3 a = v[i], b = v[i + 1], c = v[j], d = v[(j + 1) % n];
  if (j == i + 1) return side(a, b, d) == 0.0 && vec_dot(vec_sub(b, a), vec_sub(d, b)) < 0.0;
  if (i == 0 && j == n - 1) return side(c, d, b) == 0.0 && vec_dot(vec_sub(d, c), vec_sub(b, a)) < 0.0;
  return segments_meet(a, b, c, d);
}

static cprox_status check_loop(const vec3 *v, size_t n, cprox_workspace *workspace) {
  for (size_t i = 0; i < n; i++)
    if (vec_equal(v[i], v[(i + 1) % n]))
      return fourier_fail(workspace, CPROX_INVALID, "vertices %zu and %zu of the polygon are the same point", i,
                          (i + 1) % n);
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++)
      if (edges_meet(v, n, i, j))
        return fourier_fail(workspace, CPROX_INVALID, "the polygon meets itself: edges %zu and %zu touch or cross", i,
                            j);
  double area2 = 0.0;
  for (size_t i = 1; i + 1 < n; i++) area2 += side(v[0], v[i], v[i + 1]);
  if (area2 < 0.0)
    return fourier_fail(workspace, CPROX_INVALID,
                        "the polygon is clockwise (area %g): give its vertices counter-clockwise", 0.5 * area2);
  if (!(area2 > 0.0)) return fourier_fail(workspace, CPROX_INVALID, "the polygon has no area");
  return CPROX_OK;
}

cprox_status solid_create_polygon(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  const double(*vertices)[2] = d->corners;
  const size_t n = d->n;
  if (!vertices) return fourier_fail(workspace, CPROX_INVALID, "corners is NULL");
  if (n < 3) return fourier_fail(workspace, CPROX_INVALID, "a polygon needs at least 3 vertices, got %zu", n);

  piece p = piece_create(PIECE_POLYGON);
  p.corner = calloc(n, sizeof *p.corner);
  p.vertex = calloc(n, sizeof *p.vertex);
  if (!p.corner || !p.vertex) {
    piece_free(&p);
    return solid_out_of_memory(workspace);
  }
  p.n_corners = p.n_vertices = n;
  for (size_t i = 0; i < n; i++) p.corner[i] = p.vertex[i] = vec(vertices[i][0], vertices[i][1], 0.0);
  cprox_status status = solid_check_points("vertex", p.vertex, n, 2, workspace);
  if (status == CPROX_OK) status = check_loop(p.vertex, n, workspace);
  if (status != CPROX_OK) {
    piece_free(&p);
    return status;
  }
  return solid_of_piece(2, &p, workspace, solid);
}
