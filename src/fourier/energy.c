/* SPDX-License-Identifier: BSD-3-Clause */
/* The integral of the square of a solid's function and its largest value: exactly where pieces are loops in the plane,
 * else bounded from above. What is left of the first bounds the rest of a gap's sum, the second enters the over-reach
 * (doc/fourier.md, "Early exit" and "Over-reach"). */
#include <stdlib.h>

#include "fourier/solid.h"

typedef struct crossing {
  double x;
  int winding;
} crossing;

static int by_value(const void *a, const void *b) {
  const double p = *(const double *)a, q = *(const double *)b;
  return p < q ? -1 : p > q;
}

static int by_x(const void *a, const void *b) {
  const double p = ((const crossing *)a)->x, q = ((const crossing *)b)->x;
  return p < q ? -1 : p > q;
}

/* Edge i of all loops of the solid, counted through. */
typedef struct edges {
  size_t n;
  vec3 *from, *to;
} edges;

/* The heights between which no edges begin, end or cross. n + pairs of them at most. */
static size_t list_heights(const edges *e, double *heights) {
  size_t n = 0;
  for (size_t i = 0; i < e->n; i++) heights[n++] = e->from[i].y;
  for (size_t i = 0; i < e->n; i++)
    for (size_t j = i + 1; j < e->n; j++) {
      const vec3 d = vec_sub(e->to[i], e->from[i]), f = vec_sub(e->to[j], e->from[j]),
                 w = vec_sub(e->from[j], e->from[i]);
      const double det = d.x * f.y - d.y * f.x;
      const double s = (w.x * f.y - w.y * f.x) / det, t = (w.x * d.y - w.y * d.x) / det;
      if (s > 0.0 && s < 1.0 && t > 0.0 && t < 1.0) heights[n++] = e->from[i].y + s * d.y;
    }
  qsort(heights, n, sizeof *heights, by_value);
  return n;
}

/* The integral over the slab at height y, per unit of height: widths times the winding number squared. */
static double slab(const edges *e, double y, crossing *list, double *peak) {
  size_t n = 0;
  for (size_t i = 0; i < e->n; i++) {
    const vec3 a = e->from[i], b = e->to[i];
    if ((a.y <= y) == (b.y <= y)) continue;
    list[n++] = (crossing){a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x), a.y <= y ? -1 : 1};
  }
  qsort(list, n, sizeof *list, by_x);
  double sum = 0.0;
  int winding = 0;
  for (size_t i = 0; i + 1 < n; i++) {
    winding += list[i].winding;
    sum += (list[i + 1].x - list[i].x) * winding * winding;
    *peak = fmax(*peak, winding);
  }
  return sum;
}

/* Between two heights widths are linear in y, so that the middle times the height is exact. */
static solid_bounds integrate(const edges *e, double *heights, crossing *list) {
  const size_t n = list_heights(e, heights);
  solid_bounds bounds = {0.0, 0.0};
  for (size_t i = 0; i + 1 < n; i++)
    if (heights[i + 1] > heights[i])
      bounds.energy += (heights[i + 1] - heights[i]) * slab(e, 0.5 * (heights[i] + heights[i + 1]), list, &bounds.peak);
  return bounds;
}

static bool bound_loops(const cprox_solid *solid, solid_bounds *bounds) {
  edges e = {0};
  for (size_t i = 0; i < solid->n; i++) e.n += solid->pieces[i].n_corners;
  if (e.n == 0) return true; /* without an edge the function is 0, and so are its bounds */
  e.from = malloc(e.n * sizeof *e.from);
  e.to = malloc(e.n * sizeof *e.to);
  double *heights = malloc((e.n + e.n * (e.n - 1) / 2) * sizeof *heights);
  crossing *list = malloc(e.n * sizeof *list);
  const bool ok = e.from && e.to && heights && list;
  size_t at = 0;
  for (size_t i = 0; ok && i < solid->n; i++) {
    const piece *p = &solid->pieces[i];
    for (size_t j = 0; j < p->n_corners; j++, at++) {
      e.from[at] = p->corner[j];
      e.to[at] = p->corner[(j + 1) % p->n_corners];
    }
  }
  if (ok) *bounds = integrate(&e, heights, list);
  free(e.from);
  free(e.to);
  free(heights);
  free(list);
  return ok;
}

/* Whether a loop turns left alone, once around: then its function is an indicator. Loops here wind once at least, and
 * the offset of a convex loop turns by 2 pi exactly. */
static bool is_convex(const piece *p) {
  double turned = 0.0;
  for (size_t i = 0; i < p->n_corners; i++) {
    const vec3 a = p->corner[i], b = p->corner[(i + 1) % p->n_corners], c = p->corner[(i + 2) % p->n_corners];
    const vec3 d = vec_sub(b, a), e = vec_sub(c, b);
    const double cross = d.x * e.y - d.y * e.x;
    if (cross < 0.0) return false;
    turned += atan2(cross, d.x * e.x + d.y * e.y);
  }
  return turned < 9.0;
}

static bool is_indicator(const piece *p) {
  if (p->kind == PIECE_POLYGON) return is_convex(p);
  return p->kind != PIECE_SWEEP && !(p->kind == PIECE_SOUP && p->folded);
}

static double box_overlap(const piece *a, const piece *b, int dimension) {
  vec3 la, ha, lb, hb;
  piece_box(a, dimension, &la, &ha);
  piece_box(b, dimension, &lb, &hb);
  const double x = fmin(ha.x, hb.x) - fmax(la.x, lb.x), y = fmin(ha.y, hb.y) - fmax(la.y, lb.y);
  const double z = dimension == 2 ? 1.0 : fmin(ha.z, hb.z) - fmax(la.z, lb.z);
  return x > 0.0 && y > 0.0 && z > 0.0 ? x * y * z : 0.0;
}

/* Beyond this many edges the slabs are not worth their time, and beyond this many pieces their pairs. */
enum { MOST_EDGES = 300, MOST_PIECES = 3000 };

/* Pieces that are indicators: each pair overlaps no more than its boxes and its smaller one do; the function is at most
 * one more than the number of boxes that meet a piece's. */
static void bound_pairs(const cprox_solid *solid, solid_bounds *bounds) {
  for (size_t i = 0; i < solid->n; i++) {
    const double own = piece_measure(&solid->pieces[i], solid->dimension);
    double meeting = 1.0;
    bounds->energy += own;
    for (size_t j = 0; j < solid->n; j++) {
      const double overlap = j == i ? 0.0 : box_overlap(&solid->pieces[i], &solid->pieces[j], solid->dimension);
      meeting += overlap > 0.0;
      bounds->energy += fmin(overlap, fmin(own, piece_measure(&solid->pieces[j], solid->dimension)));
    }
    bounds->peak = fmax(bounds->peak, meeting);
  }
}

bool solid_find_bounds(const cprox_solid *solid, solid_bounds *bounds) {
  size_t loops = 0, corners = 0, indicators = 0;
  for (size_t i = 0; i < solid->n; i++) {
    loops += solid->pieces[i].kind == PIECE_POLYGON;
    corners += solid->pieces[i].n_corners;
    indicators += is_indicator(&solid->pieces[i]);
  }
  *bounds = (solid_bounds){0.0, 0.0};
  bool ok = true;
  if (solid->n == 1 && indicators == 1)
    *bounds = (solid_bounds){cprox_solid_get_info(solid).measure, 1.0};
  else if (loops == solid->n && corners <= MOST_EDGES)
    ok = bound_loops(solid, bounds);
  else if (indicators == solid->n && solid->n <= MOST_PIECES)
    bound_pairs(solid, bounds);
  else
    *bounds = (solid_bounds){INFINITY, INFINITY};
  bounds->energy *= 1.0 + 1e-12;
  return ok;
}
