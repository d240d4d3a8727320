/* SPDX-License-Identifier: BSD-3-Clause */
/* Covers of solids by cells (doc/fourier.md, "Covers and tables"). A cell is occupied where the piece comes within half
 * a diagonal of its middle; of meshes also where the winding number about its middle is not 0. */
#include "fourier/raster.h"

#include <stdlib.h>
#include <string.h>

#include "base/workspace.h"

enum { MOST_CELLS = 1 << 27 };

bool raster_is_possible(const cprox_solid *solid) {
  return solid->dimension == 3 && solid->pieces[0].kind != PIECE_SWEEP;
}

typedef struct raster {
  const cprox_solid *solid;
  cprox_workspace *workspace;
  double cell, half;  /* half: of a cell's diagonal */
  vec3 lowest;        /* corner of cell (0, 0, 0) */
  int64_t n[3];       /* cells along each axis */
  unsigned char *set; /* x fastest */
} raster;

static vec3 middle_of(const raster *r, const int64_t at[3]) {
  return vec_axpy(r->lowest, r->cell, vec((double)at[0] + 0.5, (double)at[1] + 0.5, (double)at[2] + 0.5));
}

static size_t index_of(const raster *r, const int64_t at[3]) {
  return (size_t)((at[2] * r->n[1] + at[1]) * r->n[0] + at[0]);
}

/* ---- convex pieces, and grids: a test of a cell's middle ---- */

static double beyond(double x) {
  return fmax(0.0, x);
}

/* A grid's cells within `half` of a point in its own axes, from its lowest corner. */
static bool grid_is_near(const piece *p, vec3 y, double half) {
  const double c = p->size[0], at[3] = {y.x, y.y, y.z};
  int64_t from[3], to[3];
  for (int j = 0; j < 3; j++) {
    from[j] = (int64_t)fmax(0.0, floor((at[j] - half) / c));
    to[j] = (int64_t)fmin((double)p->counts[j] - 1.0, floor((at[j] + half) / c));
  }
  for (int64_t z = from[2]; z <= to[2]; z++)
    for (int64_t v = from[1]; v <= to[1]; v++)
      for (int64_t x = from[0]; x <= to[0]; x++) {
        if (!p->cells[(z * p->counts[1] + v) * p->counts[0] + x]) continue;
        const double own[3] = {(double)x, (double)v, (double)z};
        double square = 0.0;
        for (int j = 0; j < 3; j++) {
          const double away = beyond(fmax(c * own[j] - at[j], at[j] - c * (own[j] + 1.0)));
          square += away * away;
        }
        if (square <= half * half) return true;
      }
  return false;
}

/* Whether the piece may come within `half` of the point; `grown` is the piece enlarged by so much, where that is asked
 * instead of the distance. */
static bool is_near(const piece *p, const piece *grown, vec3 point, double half) {
  if (p->kind == PIECE_SOUP) {
    for (size_t i = 0; i < p->n_planes; i++)
      if (vec_dot(vec(p->plane[i][0], p->plane[i][1], p->plane[i][2]), point) > p->plane[i][3] + half) return false;
    return true;
  }
  const vec3 y = rotate_back(p->turn, vec_sub(point, p->centre)), a = vec(fabs(y.x), fabs(y.y), fabs(y.z));
  const double *s = p->size;
  switch (p->kind) {
    case PIECE_BOX: return vec_norm(vec(beyond(a.x - s[0]), beyond(a.y - s[1]), beyond(a.z - s[2]))) <= half;
    case PIECE_CYLINDER: return hypot(beyond(hypot(y.x, y.y) - s[0]), beyond(a.z - s[1])) <= half;
    case PIECE_CAPSULE: return vec_norm(vec(y.x, y.y, beyond(a.z - s[1]))) <= s[0] + half;
    case PIECE_ELLIPSOID: return vec_norm(vec(y.x / grown->size[0], y.y / grown->size[1], y.z / grown->size[2])) <= 1.0;
    default: return grid_is_near(p, y, half);
  }
}

/* The cells of a box, cut to the raster. */
typedef struct cells {
  int64_t from[3], to[3];
} cells;

static cells cells_of(const raster *r, vec3 low, vec3 high, double more) {
  const double l[3] = {low.x - r->lowest.x, low.y - r->lowest.y, low.z - r->lowest.z};
  const double h[3] = {high.x - r->lowest.x, high.y - r->lowest.y, high.z - r->lowest.z};
  cells c;
  for (int j = 0; j < 3; j++) {
    c.from[j] = (int64_t)fmax(0.0, floor((l[j] - more) / r->cell));
    c.to[j] = (int64_t)fmin((double)r->n[j] - 1.0, floor((h[j] + more) / r->cell));
  }
  return c;
}

/* false where memory is out, or stopped. */
static bool add_piece(raster *r, const piece *p) {
  piece grown = {0};
  double reach = r->half;
  if ((p->kind == PIECE_ELLIPSOID || piece_is_polytope(p)) && !piece_offset(p, 3, r->half, &grown, &reach))
    return false;
  vec3 low, high;
  piece_box(p, 3, &low, &high);
  const cells c = cells_of(r, low, high, reach);
  bool stopped = false;
  int64_t at[3];
  for (at[2] = c.from[2]; at[2] <= c.to[2] && !stopped; at[2]++) {
    stopped = cprox_workspace_wants_stop(r->workspace);
    for (at[1] = c.from[1]; at[1] <= c.to[1]; at[1]++)
      for (at[0] = c.from[0]; at[0] <= c.to[0]; at[0]++)
        if (!r->set[index_of(r, at)] && is_near(p, &grown, middle_of(r, at), r->half)) r->set[index_of(r, at)] = 1;
  }
  piece_free(&grown);
  return !stopped;
}

/* ---- meshes ---- */

static double distance_to_segment(vec3 p, vec3 a, vec3 b) {
  const vec3 d = vec_sub(b, a), w = vec_sub(p, a);
  const double t = fmin(1.0, fmax(0.0, vec_dot(w, d) / fmax(vec_norm2(d), 1e-300)));
  return vec_norm(vec_axpy(w, -t, d));
}

static double distance_to_triangle(vec3 p, const vec3 v[3]) {
  const vec3 n = vec_cross(vec_sub(v[1], v[0]), vec_sub(v[2], v[0]));
  const double area2 = vec_norm(n);
  bool above = area2 > 0.0; /* whether the foot on the plane is inside */
  double least = INFINITY;
  for (int j = 0; j < 3; j++) {
    const vec3 a = v[j], b = v[(j + 1) % 3];
    above = above && vec_dot(vec_cross(n, vec_sub(b, a)), vec_sub(p, a)) >= 0.0;
    least = fmin(least, distance_to_segment(p, a, b));
  }
  return above ? fmin(least, fabs(vec_dot(n, vec_sub(p, v[0]))) / area2) : least;
}

/* Of the soup about a point off its surface: the solid angles of its triangles (Van Oosterom and Strackee). */
static double winding_about(const piece *p, vec3 point) {
  double sum = 0.0;
  for (size_t i = 0; i + 2 < p->n_corners; i += 3) {
    vec3 v[3];
    double l[3];
    for (int j = 0; j < 3; j++) v[j] = vec_sub(p->corner[i + (size_t)j], point), l[j] = vec_norm(v[j]);
    const double top = vec_dot(v[0], vec_cross(v[1], v[2]));
    const double bottom =
        l[0] * l[1] * l[2] + vec_dot(v[0], v[1]) * l[2] + vec_dot(v[1], v[2]) * l[0] + vec_dot(v[2], v[0]) * l[1];
    sum += 2.0 * atan2(top, bottom);
  }
  return sum / 12.56637061435917295385;
}

enum { OPEN = 0, SURFACE = 1, INSIDE = 2, OUTSIDE = 3 };

/* Gives every open cell that hangs together with this one its mark. `stack` is room for all cells. */
static void flood(const raster *r, unsigned char *mark, size_t first, unsigned char with, size_t *stack) {
  size_t n = 0;
  stack[n++] = first, mark[first] = with;
  while (n > 0) {
    const int64_t i = (int64_t)stack[--n];
    const int64_t stride[3] = {1, r->n[0], r->n[0] * r->n[1]};
    for (int j = 0; j < 3; j++) {
      const int64_t at = i / stride[j] % r->n[j];
      for (int side = -1; side <= 1; side += 2) {
        const int64_t next = i + side * stride[j];
        if (at + side < 0 || at + side >= r->n[j] || mark[next] != OPEN) continue;
        mark[next] = with, stack[n++] = (size_t)next;
      }
    }
  }
}

/* The cells that the surface meets, and what lies inside of it: cells that hang together apart from the surface have
 * one winding number. */
static bool add_mesh(raster *r, const piece *p) {
  const size_t n = (size_t)(r->n[0] * r->n[1] * r->n[2]);
  unsigned char *mark = calloc(n, 1);
  size_t *stack = malloc(n * sizeof *stack);
  bool ok = mark && stack;
  for (size_t i = 0; ok && i + 2 < p->n_corners; i += 3) {
    if (i % 192 == 0 && cprox_workspace_wants_stop(r->workspace)) ok = false;
    const vec3 *v = p->corner + i;
    const vec3 low =
        vec(fmin(v[0].x, fmin(v[1].x, v[2].x)), fmin(v[0].y, fmin(v[1].y, v[2].y)), fmin(v[0].z, fmin(v[1].z, v[2].z)));
    const vec3 high =
        vec(fmax(v[0].x, fmax(v[1].x, v[2].x)), fmax(v[0].y, fmax(v[1].y, v[2].y)), fmax(v[0].z, fmax(v[1].z, v[2].z)));
    const cells c = cells_of(r, low, high, r->half);
    int64_t at[3];
    for (at[2] = c.from[2]; at[2] <= c.to[2]; at[2]++)
      for (at[1] = c.from[1]; at[1] <= c.to[1]; at[1]++)
        for (at[0] = c.from[0]; at[0] <= c.to[0]; at[0]++) {
          unsigned char *here = &mark[index_of(r, at)];
          if (*here == OPEN && distance_to_triangle(middle_of(r, at), v) <= r->half) *here = SURFACE;
        }
  }
  for (size_t i = 0; ok && i < n; i++) {
    if (mark[i] != OPEN) continue;
    if (cprox_workspace_wants_stop(r->workspace)) ok = false;
    const int64_t at[3] = {(int64_t)i % r->n[0], (int64_t)i / r->n[0] % r->n[1], (int64_t)i / (r->n[0] * r->n[1])};
    const bool inside = fabs(winding_about(p, middle_of(r, at))) > 0.5;
    flood(r, mark, i, inside ? INSIDE : OUTSIDE, stack);
  }
  for (size_t i = 0; ok && i < n; i++)
    if (mark[i] == SURFACE || mark[i] == INSIDE) r->set[i] = 1;
  free(mark);
  free(stack);
  return ok;
}

/* ---- the whole ---- */

static bool begin(raster *r) {
  vec3 low = vec(INFINITY, INFINITY, INFINITY), high = vec(-INFINITY, -INFINITY, -INFINITY);
  for (size_t i = 0; i < r->solid->n; i++) {
    vec3 l, h;
    piece_box(&r->solid->pieces[i], 3, &l, &h);
    low = vec(fmin(low.x, l.x), fmin(low.y, l.y), fmin(low.z, l.z));
    high = vec(fmax(high.x, h.x), fmax(high.y, h.y), fmax(high.z, h.z));
  }
  const double size[3] = {high.x - low.x, high.y - low.y, high.z - low.z};
  double all = 1.0;
  for (int j = 0; j < 3; j++) {
    const double n =
        ceil(size[j] / r->cell) + 2.0; /* a layer of cells that are not met all around, at least half each */
    all *= n;
    if (all > (double)MOST_CELLS) return false;
    r->n[j] = (int64_t)n;
  }
  const vec3 spare = vec((double)r->n[0], (double)r->n[1], (double)r->n[2]);
  r->lowest = vec_axpy(vec_scale(0.5, vec_add(low, high)), -0.5 * r->cell, spare);
  r->set = calloc((size_t)(r->n[0] * r->n[1] * r->n[2]), 1);
  return r->set != NULL;
}

static double half_diagonal(double cell) {
  return 0.5 * sqrt(3.0) * cell * (1.0 + 1e-9);
}

double raster_growth(const cprox_solid *solid, double cell) {
  double most = 2.0 * half_diagonal(cell);
  for (size_t i = 0; i < solid->n; i++) {
    piece grown;
    double reach = 0.0;
    if (solid->pieces[i].kind != PIECE_ELLIPSOID)
      continue; /* of the others the distance is asked, or their half-spaces */
    piece_offset(&solid->pieces[i], 3, half_diagonal(cell), &grown, &reach);
    most = fmax(most, reach + half_diagonal(cell));
  }
  return most;
}

cprox_solid *raster_cover(const cprox_solid *solid, double cell, cprox_workspace *workspace) {
  raster r = {.solid = solid, .workspace = workspace, .cell = cell, .half = half_diagonal(cell)};
  bool ok = begin(&r);
  for (size_t i = 0; ok && i < solid->n; i++) {
    const piece *p = &solid->pieces[i];
    ok = p->kind == PIECE_SOUP && !piece_is_polytope(p) ? add_mesh(&r, p) : add_piece(&r, p);
  }
  cprox_solid *made = ok ? solid_allocate(3, 1) : NULL;
  if (!made) {
    free(r.set);
    return NULL;
  }
  piece p = piece_create(PIECE_GRID);
  p.size[0] = cell, p.centre = r.lowest;
  for (int j = 0; j < 3; j++) p.counts[j] = (uint32_t)r.n[j];
  p.cells = r.set;
  made->kind = solid->kind;
  made->pieces[0] = p;
  made->centre = solid->centre;
  made->radius = solid->radius + raster_growth(solid, cell);
  return made;
}
