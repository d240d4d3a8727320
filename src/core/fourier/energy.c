/* SPDX-License-Identifier: BSD-3-Clause */
/* The integral of the square of a solid's function, exactly where pieces are loops in the plane, else bounded from above: what
 * is left of it bounds the rest of a gap's sum (doc/fourier.md, "Early exit"). */
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
static double slab(const edges *e, double y, crossing *list) {
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
  }
  return sum;
}

/* Between two heights widths are linear in y, so that the middle times the height is exact. */
static double integrate(const edges *e, double *heights, crossing *list) {
  const size_t n = list_heights(e, heights);
  double sum = 0.0;
  for (size_t i = 0; i + 1 < n; i++)
    if (heights[i + 1] > heights[i])
      sum += (heights[i + 1] - heights[i]) * slab(e, 0.5 * (heights[i] + heights[i + 1]), list);
  return sum;
}

static double energy_of_loops(const cprox_solid *solid, bool *failed) {
  edges e = {0};
  for (size_t i = 0; i < solid->n; i++) e.n += solid->pieces[i].n_corners;
  e.from = malloc(e.n * sizeof *e.from);
  e.to = malloc(e.n * sizeof *e.to);
  double *heights = malloc((e.n + e.n * (e.n - 1) / 2) * sizeof *heights);
  crossing *list = malloc(e.n * sizeof *list);
  double sum = INFINITY;
  if (e.from && e.to && heights && list) {
    size_t at = 0;
    for (size_t i = 0; i < solid->n; i++) {
      const piece *p = &solid->pieces[i];
      for (size_t j = 0; j < p->n_corners; j++, at++) {
        e.from[at] = p->corner[j];
        e.to[at] = p->corner[(j + 1) % p->n_corners];
      }
    }
    sum = integrate(&e, heights, list) * (1.0 + 1e-12);
  } else {
    *failed = true;
  }
  free(e.from);
  free(e.to);
  free(heights);
  free(list);
  return sum;
}

/* A solid body's is its measure. Soups and sweeps may count more than once: unknown. */
static double energy_of_piece(const piece *p, int dimension) {
  return p->kind == PIECE_SOUP || p->kind == PIECE_SWEEP ? INFINITY : piece_measure(p, dimension);
}

static double box_overlap(const piece *a, const piece *b, int dimension) {
  vec3 la, ha, lb, hb;
  piece_box(a, dimension, &la, &ha);
  piece_box(b, dimension, &lb, &hb);
  const double x = fmin(ha.x, hb.x) - fmax(la.x, lb.x), y = fmin(ha.y, hb.y) - fmax(la.y, lb.y);
  const double z = dimension == 2 ? 1.0 : fmin(ha.z, hb.z) - fmax(la.z, lb.z);
  return x > 0.0 && y > 0.0 && z > 0.0 ? x * y * z : 0.0;
}

/* Beyond this many edges or pieces the pairs are not worth their time. */
enum { MOST_PAIRED = 3000 };

double solid_energy(const cprox_solid *solid, bool *failed) {
  size_t loops = 0, corners = 0;
  for (size_t i = 0; i < solid->n; i++) {
    loops += solid->pieces[i].kind == PIECE_POLYGON;
    corners += solid->pieces[i].n_corners;
  }
  if (loops == solid->n) return corners <= MOST_PAIRED ? energy_of_loops(solid, failed) : INFINITY;
  if (loops > 0 || solid->n > MOST_PAIRED) return INFINITY;

  double sum = 0.0;
  for (size_t i = 0; i < solid->n; i++) {
    const double own = energy_of_piece(&solid->pieces[i], solid->dimension);
    sum += own;
    for (size_t j = 0; j < i; j++)
      sum += 2.0 * fmin(fmin(own, energy_of_piece(&solid->pieces[j], solid->dimension)),
                        box_overlap(&solid->pieces[i], &solid->pieces[j], solid->dimension));
  }
  return sum * (1.0 + 1e-12);
}
