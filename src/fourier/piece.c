/* SPDX-License-Identifier: BSD-3-Clause */
#include "fourier/piece.h"

#include <stdlib.h>
#include <string.h>

piece piece_create(piece_kind kind) {
  return (piece){.kind = kind, .turn = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
}

void piece_free(piece *p) {
  free(p->corner);
  free(p->vertex);
  free(p->triangle);
  free(p->plane);
  free(p->cells);
  *p = (piece){0};
}

/* memcpy into new memory; NULL for none. *ok turns false where memory is out. */
static void *duplicate(const void *from, size_t count, size_t size, bool *ok) {
  if (!from || count == 0) return NULL;
  void *to = malloc(count * size);
  if (to)
    memcpy(to, from, count * size);
  else
    *ok = false;
  return to;
}

static void move_points(vec3 *points, size_t n, const double turn[9], vec3 shift) {
  for (size_t i = 0; points && i < n; i++) points[i] = vec_add(rotate(turn, points[i]), shift);
}

bool piece_copy(const piece *p, const double turn[9], vec3 shift, piece *copy) {
  bool ok = true;
  const size_t n_cells = (size_t)p->counts[0] * p->counts[1] * p->counts[2];
  *copy = *p;
  copy->corner = duplicate(p->corner, p->n_corners, sizeof *p->corner, &ok);
  copy->vertex = duplicate(p->vertex, p->n_vertices, sizeof *p->vertex, &ok);
  copy->triangle = duplicate(p->triangle, p->n_triangles, sizeof *p->triangle, &ok);
  copy->plane = duplicate(p->plane, p->n_planes, sizeof *p->plane, &ok);
  copy->cells = duplicate(p->cells, n_cells, 1, &ok);
  if (!ok) {
    piece_free(copy);
    return false;
  }

  rotation_compose(turn, p->turn, copy->turn);
  copy->centre = vec_add(rotate(turn, p->centre), shift);
  move_points(copy->corner, copy->n_corners, turn, shift);
  move_points(copy->vertex, copy->n_vertices, turn, shift);
  for (size_t i = 0; i < copy->n_planes; i++) {
    double *plane = copy->plane[i];
    const vec3 normal = rotate(turn, vec(plane[0], plane[1], plane[2]));
    plane[0] = normal.x, plane[1] = normal.y, plane[2] = normal.z;
    plane[3] += vec_dot(normal, shift);
  }
  return true;
}

/* Twice the area inside a loop, winding counted; about its first corner, so that the position does not round. */
static double loop_area2(const vec3 *c, size_t n) {
  double area = 0.0;
  for (size_t i = 1; i + 1 < n; i++) {
    const vec3 a = vec_sub(c[i], c[0]), b = vec_sub(c[i + 1], c[0]);
    area += a.x * b.y - a.y * b.x;
  }
  return area;
}

static double soup_volume(const vec3 *c, size_t n) {
  double six = 0.0;
  for (size_t i = 0; i + 2 < n; i += 3)
    six += vec_dot(vec_sub(c[i], c[0]), vec_cross(vec_sub(c[i + 1], c[0]), vec_sub(c[i + 2], c[0])));
  return six / 6.0;
}

static size_t occupied(const piece *p) {
  size_t n = 0;
  for (size_t i = 0; i < (size_t)p->counts[0] * p->counts[1] * p->counts[2]; i++) n += p->cells[i] != 0;
  return n;
}

double piece_measure(const piece *p, int dimension) {
  const double *s = p->size;
  const bool plane = dimension == 2;
  switch (p->kind) {
    case PIECE_ELLIPSOID: return ball_measure(dimension, 1.0) * s[0] * s[1] * (plane ? 1.0 : s[2]);
    case PIECE_BOX: return plane ? 4.0 * s[0] * s[1] : 8.0 * s[0] * s[1] * s[2];
    case PIECE_CYLINDER: return 2.0 * s[1] * ball_measure(2, s[0]);
    case PIECE_CAPSULE:
      return 2.0 * s[1] * (plane ? 2.0 * s[0] : ball_measure(2, s[0])) + ball_measure(dimension, s[0]);
    case PIECE_POLYGON: return 0.5 * loop_area2(p->corner, p->n_corners);
    case PIECE_SOUP: return soup_volume(p->corner, p->n_corners);
    case PIECE_SWEEP: {
      double length = 0.0;
      for (size_t i = 0; i < p->n_corners; i += 2) length += vec_norm(vec_sub(p->corner[i + 1], p->corner[i]));
      return length * ball_measure(dimension, s[0]);
    }
    case PIECE_GRID: break;
  }
  return (double)occupied(p) * s[0] * s[0] * (plane ? 1.0 : s[0]);
}

/* Half the extents in the piece's own frame, of the kinds that have one. */
static vec3 own_half(const piece *p, int dimension) {
  const double *s = p->size;
  switch (p->kind) {
    case PIECE_CYLINDER: return vec(s[0], s[0], s[1]);
    case PIECE_CAPSULE: return dimension == 2 ? vec(s[0] + s[1], s[0], 0.0) : vec(s[0], s[0], s[0] + s[1]);
    case PIECE_GRID: return vec_scale(0.5 * s[0], vec(p->counts[0], p->counts[1], dimension == 2 ? 0.0 : p->counts[2]));
    default: return vec(s[0], s[1], dimension == 2 ? 0.0 : s[2]);
  }
}

static vec3 own_middle(const piece *p, int dimension) {
  return p->kind == PIECE_GRID ? vec_add(p->centre, rotate(p->turn, own_half(p, dimension))) : p->centre;
}

double piece_radius_about(const piece *p, int dimension, vec3 point) {
  double most = 0.0;
  if (p->corner) {
    for (size_t i = 0; i < p->n_corners; i++) most = fmax(most, vec_norm(vec_sub(p->corner[i], point)));
    return most + (p->kind == PIECE_SWEEP ? p->size[0] : 0.0);
  }
  const vec3 half = own_half(p, dimension);
  const vec3 at = rotate_back(p->turn, vec_sub(own_middle(p, dimension), point));
  const vec3 away = vec(fabs(at.x), fabs(at.y), fabs(at.z));
  switch (p->kind) {
    case PIECE_ELLIPSOID: return vec_norm(away) + fmax(half.x, fmax(half.y, half.z));
    case PIECE_CAPSULE:
      return p->size[0] + vec_norm(vec_add(away, dimension == 2 ? vec(p->size[1], 0, 0) : vec(0, 0, p->size[1])));
    case PIECE_CYLINDER: return hypot(hypot(away.x, away.y) + half.x, away.z + half.z);
    default: return vec_norm(vec_add(away, half));
  }
}

double piece_height(const piece *p, int dimension, vec3 v) {
  double most = -INFINITY;
  if (p->corner) {
    for (size_t i = 0; i < p->n_corners; i++) most = fmax(most, vec_dot(v, p->corner[i]));
    return most + (p->kind == PIECE_SWEEP ? p->size[0] * vec_norm(v) : 0.0);
  }
  const vec3 half = own_half(p, dimension), u = rotate_back(p->turn, v);
  const double middle = vec_dot(v, own_middle(p, dimension));
  switch (p->kind) {
    case PIECE_ELLIPSOID: return middle + vec_norm(vec(half.x * u.x, half.y * u.y, half.z * u.z));
    case PIECE_CAPSULE: return middle + p->size[0] * vec_norm(v) + p->size[1] * fabs(dimension == 2 ? u.x : u.z);
    case PIECE_CYLINDER: return middle + half.x * hypot(u.x, u.y) + half.z * fabs(u.z);
    default: return middle + half.x * fabs(u.x) + half.y * fabs(u.y) + half.z * fabs(u.z);
  }
}

static void grow(vec3 *low, vec3 *high, vec3 at, vec3 half) {
  *low = vec(fmin(low->x, at.x - half.x), fmin(low->y, at.y - half.y), fmin(low->z, at.z - half.z));
  *high = vec(fmax(high->x, at.x + half.x), fmax(high->y, at.y + half.y), fmax(high->z, at.z + half.z));
}

void piece_box(const piece *p, int dimension, vec3 *low, vec3 *high) {
  *low = vec(INFINITY, INFINITY, INFINITY), *high = vec(-INFINITY, -INFINITY, -INFINITY);
  if (p->corner) {
    const double r = p->kind == PIECE_SWEEP ? p->size[0] : 0.0;
    for (size_t i = 0; i < p->n_corners; i++) grow(low, high, p->corner[i], vec(r, r, r));
    return;
  }
  const vec3 h = own_half(p, dimension);
  const double *t = p->turn;
  const vec3 half = p->kind == PIECE_ELLIPSOID ? vec(vec_norm(vec(t[0] * h.x, t[1] * h.y, t[2] * h.z)),
                                                     vec_norm(vec(t[3] * h.x, t[4] * h.y, t[5] * h.z)),
                                                     vec_norm(vec(t[6] * h.x, t[7] * h.y, t[8] * h.z)))
                                               : vec(fabs(t[0]) * h.x + fabs(t[1]) * h.y + fabs(t[2]) * h.z,
                                                     fabs(t[3]) * h.x + fabs(t[4]) * h.y + fabs(t[5]) * h.z,
                                                     fabs(t[6]) * h.x + fabs(t[7]) * h.y + fabs(t[8]) * h.z);
  grow(low, high, own_middle(p, dimension), half);
}

/* Length of a loop, area of a soup. */
static double boundary(const piece *p) {
  double sum = 0.0;
  const vec3 *c = p->corner;
  if (p->kind == PIECE_POLYGON)
    for (size_t i = 0; i < p->n_corners; i++) sum += vec_norm(vec_sub(c[(i + 1) % p->n_corners], c[i]));
  else
    for (size_t i = 0; i < p->n_corners; i += 3)
      sum += 0.5 * vec_norm(vec_cross(vec_sub(c[i + 1], c[i]), vec_sub(c[i + 2], c[i])));
  return sum;
}

double piece_error_scale(const piece *p, int dimension, double q) {
  const double measure = fabs(piece_measure(p, dimension));
  return p->kind == PIECE_POLYGON || p->kind == PIECE_SOUP ? fmax(measure, boundary(p) / q) : measure;
}

static double grid_boundary(const piece *p, int dimension) {
  const int64_t n[3] = {p->counts[0], p->counts[1], p->counts[2]}, stride[3] = {1, n[0], n[0] * n[1]};
  const int axes = dimension == 2 ? 2 : 3;
  size_t open = 0;
  for (int64_t i = 0; i < n[0] * n[1] * n[2]; i++)
    for (int j = 0; p->cells[i] && j < axes; j++) {
      const int64_t at = i / stride[j] % n[j];
      open += (size_t)(at == 0 || !p->cells[i - stride[j]]) + (size_t)(at + 1 == n[j] || !p->cells[i + stride[j]]);
    }
  return (double)open * p->size[0] * (dimension == 2 ? 1.0 : p->size[0]);
}

double piece_slope(const piece *p, int dimension) {
  const double *s = p->size;
  const bool plane = dimension == 2;
  const double disc = plane ? 2.0 * s[0] : ball_measure(2, s[0]);
  switch (p->kind) {
    case PIECE_ELLIPSOID: {
      const double least = fmin(s[0], fmin(s[1], s[2]));
      return plane ? 2.0 * fmax(s[0], s[1]) : ball_measure(2, 1.0) * s[0] * s[1] * s[2] / least;
    }
    case PIECE_BOX: return plane ? 2.0 * hypot(s[0], s[1]) : 4.0 * vec_norm(vec(s[0] * s[1], s[1] * s[2], s[2] * s[0]));
    case PIECE_CYLINDER: return hypot(disc, 4.0 * s[0] * s[1]);
    case PIECE_CAPSULE: return disc + (plane ? 2.0 * s[1] : 4.0 * s[0] * s[1]);
    case PIECE_SWEEP: return piece_measure(p, dimension) / ball_measure(dimension, s[0]) * disc;
    case PIECE_GRID: return 0.5 * grid_boundary(p, dimension);
    case PIECE_POLYGON:
    case PIECE_SOUP: break;
  }
  return 0.5 * boundary(p);
}
