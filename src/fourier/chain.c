/* SPDX-License-Identifier: BSD-3-Clause */
/* Solids made of many small parts: polylines with a radius, spheres swept along curves, grids of cells. */
#include <string.h>

#include "base/workspace.h"
#include "fourier/points.h"
#include "fourier/solid.h"

/* The capsule between two points, or the ball about them where they are one. */
static piece link_between(int dimension, vec3 a, vec3 b, double radius) {
  const vec3 d = vec_sub(b, a);
  const double length = vec_norm(d);
  piece p = piece_create(length > 0.0 ? PIECE_CAPSULE : PIECE_ELLIPSOID);
  p.centre = vec_axpy(a, 0.5, d);
  p.size[0] = p.size[1] = p.size[2] = radius;
  if (length == 0.0) return p;
  p.size[1] = 0.5 * length;

  /* its own axis along d: x in the plane, z in space */
  const vec3 along = vec_scale(1.0 / length, d);
  if (dimension == 2) {
    const double turn[9] = {along.x, -along.y, 0, along.y, along.x, 0, 0, 0, 1};
    memcpy(p.turn, turn, sizeof turn);
    return p;
  }
  const vec3 other = fabs(along.x) < 0.6 ? vec(1, 0, 0) : vec(0, 1, 0);
  const vec3 n = vec_cross(along, other), u = vec_scale(1.0 / vec_norm(n), n), v = vec_cross(along, u);
  const double turn[9] = {u.x, v.x, along.x, u.y, v.y, along.y, u.z, v.z, along.z};
  memcpy(p.turn, turn, sizeof turn);
  return p;
}

cprox_status solid_create_polyline(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  const vec3 *points_given = d->points;
  const size_t n = d->n;
  const int dimension = d->dimension;
  const double radius = d->radius;
  cprox_status status = solid_check_length("radius", radius, workspace);
  if (status != CPROX_OK) return status;
  if (!points_given) return fourier_fail(workspace, CPROX_INVALID, "points is NULL");
  if (n < 2) return fourier_fail(workspace, CPROX_INVALID, "a polyline needs at least 2 points, got %zu", n);
  status = solid_check_points("point", points_given, n, dimension, workspace);
  if (status != CPROX_OK) return status;

  cprox_solid *made = solid_allocate(dimension, n - 1);
  if (!made) return solid_out_of_memory(workspace);
  for (size_t i = 0; i + 1 < n; i++)
    made->pieces[i] = link_between(dimension, points_given[i], points_given[i + 1], radius);
  solid_bound(made);
  *solid = made;
  return CPROX_OK;
}

/* ---- Sweeps ---- */

enum { MOST_SEGMENTS = 1000000, MOST_HALVINGS = 30 };

/* How far the Bézier piece of the control points is from its chord at most: as far as a control point is. */
static double sagitta(const vec3 *p, size_t degree) {
  const vec3 d = vec_sub(p[degree], p[0]);
  const double length2 = vec_norm2(d);
  double most = 0.0;
  for (size_t i = 1; i < degree; i++) {
    const vec3 w = vec_sub(p[i], p[0]);
    const double s = length2 > 0.0 ? fmin(1.0, fmax(0.0, vec_dot(w, d) / length2)) : 0.0;
    most = fmax(most, vec_norm(vec_axpy(w, -s, d)));
  }
  return most;
}

/* Halves the piece on `stack` until each part is flat; parts in the order of the parameter. `stack` has room for
 * MOST_HALVINGS + 2 pieces. */
static void flatten(vec3 *stack, size_t degree, double tolerance, points *segments) {
  size_t depth[MOST_HALVINGS + 2], n = 1;
  depth[0] = 0;
  while (n > 0 && segments->n < 2 * MOST_SEGMENTS + 2) {
    vec3 *top = stack + (n - 1) * (degree + 1), *next = top + degree + 1;
    if (sagitta(top, degree) <= tolerance || depth[n - 1] == MOST_HALVINGS) {
      points_add(segments, top[0]);
      points_add(segments, top[degree]);
      n--;
      continue;
    }
    /* de Casteljau in place: the right half stays, the left half goes on top and is done first */
    for (size_t level = 0; level <= degree; level++) {
      next[level] = top[0];
      for (size_t i = 0; i + level < degree; i++) top[i] = vec_lerp(top[i], top[i + 1], 0.5);
    }
    depth[n] = ++depth[n - 1];
    n++;
  }
}

cprox_status solid_create_sweep(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  const cprox_curve *curve = d->curve;
  const int dimension = d->dimension;
  const double radius = d->radius, tolerance = d->tolerance;
  cprox_status status = solid_check_length("tolerance", tolerance, workspace);
  if (status != CPROX_OK) return status;
  if (!curve) return fourier_fail(workspace, CPROX_INVALID, "curve is NULL");
  const cprox_curve_info info = cprox_curve_get_info(curve);
  if (info.kind == CPROX_CURVE_RECTIFIABLE)
    return fourier_fail(workspace, CPROX_INVALID,
                        "a curve known by its arc lengths alone cannot be swept: it has no control points");
  if (!(radius >= 0.0) || radius > SOLID_LARGEST)
    return fourier_fail(workspace, CPROX_INVALID, "radius is %g, must be >= 0 and at most %g", radius, SOLID_LARGEST);
  if (!(info.error < 0.5 * tolerance))
    return fourier_fail(workspace, CPROX_INVALID, "tolerance %g is below twice the curve's own rounding, %g", tolerance,
                        info.error);

  points segments = {0};
  const size_t width = info.degree + 1;
  vec3 *stack = malloc((MOST_HALVINGS + 2) * width * sizeof *stack);
  if (!stack) segments.failed = true;
  for (size_t i = 0; !segments.failed && status == CPROX_OK && i < info.n_pieces; i++) {
    const cprox_curve_piece_info part = cprox_curve_get_piece_info(curve, i);
    status = WORKSPACE_LEND(workspace, cprox_curve_control_points(curve, part.t0, part.t1, workspace, stack));
    if (status == CPROX_OK) status = solid_check_points("control point", stack, width, dimension, workspace);
    if (status == CPROX_OK) flatten(stack, info.degree, tolerance - info.error, &segments);
  }
  free(stack);
  if (status != CPROX_OK) {
    free(segments.at);
    return status;
  }
  piece p = piece_create(PIECE_SWEEP);
  p.corner = segments.at, p.n_corners = segments.n;
  p.size[0] = radius + tolerance;
  double length = 0.0;
  for (size_t i = 0; i + 1 < p.n_corners; i += 2) length += vec_norm(vec_sub(p.corner[i + 1], p.corner[i]));
  if (segments.failed || segments.n > 2 * MOST_SEGMENTS || !(length > 0.0)) {
    const bool failed = segments.failed, many = segments.n > 2 * MOST_SEGMENTS;
    piece_free(&p);
    if (failed) return solid_out_of_memory(workspace);
    return many ? fourier_fail(workspace, CPROX_INVALID, "tolerance %g needs more than %d segments", tolerance,
                               MOST_SEGMENTS)
                : fourier_fail(workspace, CPROX_INVALID, "the curve stands still: use a ball");
  }
  return solid_of_piece(dimension, &p, workspace, solid);
}

/* ---- Grids ---- */

cprox_status solid_check_grid(const cprox_solid_description *d, cprox_workspace *workspace) {
  const uint32_t *counts = d->counts;
  cprox_status status = solid_check_length("cell", d->cell, workspace);
  if (status == CPROX_OK) status = solid_check_points("lowest corner", &d->lowest, 1, d->dimension, workspace);
  if (status != CPROX_OK) return status;
  const double cells = (double)counts[0] * counts[1] * counts[2];
  if (!(cells >= 1.0) || cells > 1073741824.0 || (d->dimension == 2 && counts[2] != 1))
    return fourier_fail(workspace, CPROX_INVALID, "counts are %u × %u × %u, must be 1 or more, together at most 2^30%s",
                        counts[0], counts[1], counts[2], d->dimension == 2 ? ", the last 1 in the plane" : "");
  return CPROX_OK;
}

cprox_status solid_create_grid(const cprox_solid_description *d, cprox_workspace *workspace, cprox_solid **solid) {
  const unsigned char *occupied = d->occupied;
  if (!occupied) return fourier_fail(workspace, CPROX_INVALID, "occupied is NULL");
  const cprox_status status = solid_check_grid(d, workspace);
  if (status != CPROX_OK) return status;
  const size_t n = (size_t)d->counts[0] * d->counts[1] * d->counts[2];
  size_t first = 0;
  while (first < n && !occupied[first]) first++;
  if (first == n) return fourier_fail(workspace, CPROX_INVALID, "no cell of the grid is occupied");

  piece p = piece_create(PIECE_GRID);
  p.size[0] = d->cell, p.centre = d->lowest;
  memcpy(p.counts, d->counts, sizeof p.counts);
  p.cells = malloc(n);
  if (!p.cells) return solid_out_of_memory(workspace);
  memcpy(p.cells, occupied, n);
  return solid_of_piece(d->dimension, &p, workspace, solid);
}
