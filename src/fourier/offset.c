/* SPDX-License-Identifier: BSD-3-Clause */
/* Enlarged pieces: functions that are at least 1 within rho of the piece (doc/fourier.md, "Offsets"). */
#include <string.h>

#include "fourier/points.h"
#include "fourier/solid.h"

/* Arcs are cut into tangents at most this far apart, so that they reach at most 1/cos(pi/16) = 1.0196 rho. */
#define ARC_STEP 0.39269908169872415481

/* The raw offset of a corner between edges of outward normals m and n: around a convex corner tangents of its arc; a
 * reflex one is visited itself, so that the two strips beside it count as what they are. */
static void offset_corner(vec3 v, vec3 m, vec3 n, double rho, points *out) {
  const double turn = m.x * n.y - m.y * n.x, straight = m.x * n.x + m.y * n.y;
  if (turn < 0.0) {
    points_add(out, vec_axpy(v, rho, m));
    points_add(out, v);
    points_add(out, vec_axpy(v, rho, n));
    return;
  }
  const double angle = atan2(turn, straight);
  const int steps = angle > 0.0 ? (int)ceil(angle / ARC_STEP - 1e-9) : 1;
  const double half = 0.5 * angle / steps, radius = rho / cos(half);
  for (int j = 0; j < steps; j++) {
    const double c = cos((2 * j + 1) * half), s = sin((2 * j + 1) * half);
    points_add(out, vec_axpy(v, radius, vec(c * m.x - s * m.y, s * m.x + c * m.y, 0.0)));
  }
}

static void offset_loop(const vec3 *v, size_t n, double rho, points *out) {
  for (size_t i = 0; i < n; i++) {
    const vec3 d = vec_sub(v[i], v[(i + n - 1) % n]), e = vec_sub(v[(i + 1) % n], v[i]);
    offset_corner(v[i], vec_scale(1.0 / vec_norm(d), vec(d.y, -d.x, 0.0)),
                  vec_scale(1.0 / vec_norm(e), vec(e.y, -e.x, 0.0)), rho, out);
  }
}

/* A polytope by its half-spaces, each moved out by rho. The distance to the polytope is convex, so that it is largest
 * at a corner, from where the nearest corner is at least as far. */
static bool offset_polytope(const piece *p, double rho, piece *out, double *reach) {
  points corners = {0};
  if (!piece_polytope_faces(p, rho, &corners)) {
    free(corners.at);
    return false;
  }
  for (size_t i = 0; i < corners.n; i++) {
    double least = INFINITY;
    for (size_t j = 0; j < p->n_corners; j++) least = fmin(least, vec_norm(vec_sub(corners.at[i], p->corner[j])));
    *reach = fmax(*reach, least);
  }
  out->corner = corners.at, out->n_corners = corners.n;
  return true;
}

/* Corners of a polygon or a mesh: offset what was before clipping, then clip by the planes moved out by rho. */
static bool offset_corners(const piece *p, double rho, piece *out, double *reach) {
  points corners = {0};
  if (rho == 0.0) {
    for (size_t i = 0; i < p->n_corners; i++) points_add(&corners, p->corner[i]);
  } else if (p->kind == PIECE_POLYGON) {
    offset_loop(p->vertex, p->n_vertices, rho, &corners);
    *reach = fmax(*reach, rho / cos(0.5 * ARC_STEP));
  } else {
    out->folded = offset_mesh(p, rho, &corners, reach);
  }
  for (size_t i = 0; rho > 0.0 && i < p->n_planes; i++) {
    const double plane[4] = {p->plane[i][0], p->plane[i][1], p->plane[i][2], p->plane[i][3] + rho};
    (p->kind == PIECE_POLYGON ? clip_loop : clip_soup)(&corners, plane);
  }
  out->corner = corners.at, out->n_corners = corners.n;
  return !corners.failed;
}

/* a'² = (1 + 1/p) a² + (1 + p) rho² for any p > 0: h + rho <= h' for every support value h (Cauchy-Schwarz). h' - h is
 * convex in h, so that it is largest at an end. */
static void offset_ellipsoid(const piece *p, int dimension, double rho, piece *out, double *reach) {
  double mean = 0.0;
  for (int i = 0; i < dimension; i++) mean += p->size[i] * p->size[i] / dimension;
  const double weight = sqrt(mean) / rho;
  for (int i = 0; i < dimension; i++) {
    out->size[i] = sqrt((1.0 + 1.0 / weight) * p->size[i] * p->size[i] + (1.0 + weight) * rho * rho);
    *reach = fmax(*reach, out->size[i] - p->size[i]);
  }
}

#define FAR UINT32_MAX

/* Along a line: out[j] = least in[i] + max(|j - m - i| - 1, 0)² over |j - m - i| <= m, j = 0 … n + 2 m - 1. Cells that
 * border are 0 apart. */
static void spread_line(const uint32_t *in, int64_t stride, int64_t n, int64_t m, uint32_t *out, int64_t out_stride) {
  for (int64_t j = 0; j < n + 2 * m; j++) {
    uint32_t best = FAR;
    const int64_t first = j > 2 * m ? j - 2 * m : 0, last = j < n ? j : n - 1;
    for (int64_t i = first; i <= last; i++) {
      const int64_t away = (j - m < i ? i - j + m : j - m - i) - 1;
      const uint32_t add = away > 0 ? (uint32_t)(away * away) : 0;
      if (in[i * stride] != FAR && in[i * stride] + add < best) best = in[i * stride] + add;
    }
    out[j * out_stride] = best;
  }
}

/* The squares of distances to occupied cells, in cells, axis by axis: cells of `out` where it is at most rho. from,
 * rows, line: room for nx ny nz, wx wy nz and wz. */
static void spread_grid(const piece *p, const int64_t m[3], double rho, piece *out, uint32_t *from, uint32_t *rows,
                        uint32_t *line) {
  const int64_t nx = p->counts[0], ny = p->counts[1], nz = p->counts[2];
  const int64_t wx = out->counts[0], wy = out->counts[1], wz = out->counts[2];
  for (int64_t i = 0; i < nx * ny * nz; i++) from[i] = p->cells[i] ? 0 : FAR;
  uint32_t *wide = rows + wx * wy * nz; /* wx ny nz: rows alone */
  for (int64_t i = 0; i < ny * nz; i++) spread_line(from + nx * i, 1, nx, m[0], wide + wx * i, 1);
  for (int64_t z = 0; z < nz; z++)
    for (int64_t x = 0; x < wx; x++) spread_line(wide + x + wx * ny * z, wx, ny, m[1], rows + x + wx * wy * z, wx);
  for (int64_t i = 0; i < wx * wy; i++) {
    spread_line(rows + i, wx * wy, nz, m[2], line, 1);
    for (int64_t z = 0; z < wz; z++)
      out->cells[i + wx * wy * z] = line[z] != FAR && p->size[0] * sqrt((double)line[z]) <= rho;
  }
}

/* Cells that come within rho of an occupied one. */
static bool offset_grid(const piece *p, int dimension, double rho, piece *out, double *reach) {
  const double cell = p->size[0];
  const int64_t near = (int64_t)floor(rho / cell) + 1, m[3] = {near, near, dimension == 2 ? 0 : near};
  const int64_t nx = p->counts[0], ny = p->counts[1], nz = p->counts[2];
  const int64_t wx = nx + 2 * m[0], wy = ny + 2 * m[1], wz = nz + 2 * m[2];
  if ((double)wx * (double)wy * (double)wz > 4e9) return false;
  out->counts[0] = (uint32_t)wx, out->counts[1] = (uint32_t)wy, out->counts[2] = (uint32_t)wz;
  out->centre = vec_sub(p->centre, rotate(p->turn, vec_scale(cell, vec((double)m[0], (double)m[1], (double)m[2]))));
  out->cells = calloc((size_t)(wx * wy * wz), 1);
  uint32_t *room = calloc((size_t)(nx * ny * nz + wz + wx * (wy + ny) * nz), sizeof *room);
  if (out->cells && room) spread_grid(p, m, rho, out, room, room + nx * ny * nz + wz, room + nx * ny * nz);
  const bool ok = out->cells && room;
  free(room);
  *reach = fmax(*reach, rho + cell * sqrt((double)dimension));
  return ok;
}

static bool copy_cells(const piece *p, piece *out) {
  const size_t n = (size_t)p->counts[0] * p->counts[1] * p->counts[2];
  out->cells = malloc(n);
  if (out->cells) memcpy(out->cells, p->cells, n);
  return out->cells != NULL;
}

bool piece_offset(const piece *p, int dimension, double rho, piece *out, double *reach) {
  *out = piece_create(p->kind);
  memcpy(out->size, p->size, sizeof out->size);
  memcpy(out->turn, p->turn, sizeof out->turn);
  memcpy(out->counts, p->counts, sizeof out->counts);
  out->centre = p->centre;

  bool ok = true;
  switch (p->kind) {
    case PIECE_ELLIPSOID:
      if (rho > 0.0) offset_ellipsoid(p, dimension, rho, out, reach);
      break;
    case PIECE_BOX:
      for (int i = 0; i < dimension; i++) out->size[i] += rho;
      *reach = fmax(*reach, rho * sqrt((double)dimension));
      break;
    case PIECE_CYLINDER:
      out->size[0] += rho, out->size[1] += rho;
      *reach = fmax(*reach, rho * sqrt(2.0));
      break;
    case PIECE_CAPSULE:
      out->size[0] += rho;
      *reach = fmax(*reach, rho);
      break;
    case PIECE_SWEEP: {
      points corners = {0};
      for (size_t i = 0; i < p->n_corners; i++) points_add(&corners, p->corner[i]);
      out->corner = corners.at, out->n_corners = corners.n;
      out->size[0] += rho;
      *reach = fmax(*reach, rho);
      ok = !corners.failed;
      break;
    }
    case PIECE_POLYGON:
    case PIECE_SOUP:
      ok = rho > 0.0 && piece_is_polytope(p) ? offset_polytope(p, rho, out, reach) : offset_corners(p, rho, out, reach);
      break;
    case PIECE_GRID: ok = rho > 0.0 ? offset_grid(p, dimension, rho, out, reach) : copy_cells(p, out); break;
  }
  if (!ok) piece_free(out);
  return ok;
}
