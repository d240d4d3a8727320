/* SPDX-License-Identifier: BSD-3-Clause */
/* A ray from the point crosses a closed mesh as often outwards as inwards, but for the winding number. A crossing is
 * counted by the signs of volumes; where a sign is not known, another ray is tried. */
#include "winding.h"

#include <stdlib.h>

#include "quick.h"

/* ---- closed meshes ---- */

static int compare_vertices(const double *a, const double *b) {
  for (int k = 0; k < 3; k++)
    if (a[k] != b[k]) return a[k] < b[k] ? -1 : 1;
  return 0;
}

static int compare_edges(const void *a, const void *b) {
  const winding_edge *first = a, *second = b;
  const int order = compare_vertices(first->end[0], second->end[0]);
  return order != 0 ? order : compare_vertices(first->end[1], second->end[1]);
}

bool winding_is_closed(const set *s, winding_edge *edges) {
  for (size_t i = 0; i < s->n; i++) {
    const double *from = s->vertices[i], *to = s->vertices[i % 3 == 2 ? i - 2 : i + 1];
    const int order = compare_vertices(from, to); /* 0: the edge is a point, and cancels itself */
    edges[i] = order <= 0 ? (winding_edge){{from, to}, -order} : (winding_edge){{to, from}, -1};
  }
  qsort(edges, s->n, sizeof *edges, compare_edges);
  long sum = 0;
  bool closed = true;
  for (size_t i = 0; i < s->n && closed; i++) {
    if (i > 0 && compare_edges(&edges[i - 1], &edges[i]) != 0) {
      closed = sum == 0;
      sum = 0;
    }
    sum += edges[i].sign;
  }
  return closed && sum == 0;
}

/* ---- rays ---- */

typedef enum sign { NEGATIVE = -1, NO_SIGN, POSITIVE } sign;

static sign sign_of(num a) {
  return num_bottom(a) > 0.0 ? POSITIVE : num_top(a) < 0.0 ? NEGATIVE : NO_SIGN;
}

/* How the ray from 0 along d crosses the triangle: +-1, 0 where it does not, 2 where that is not known. */
static int crossing(const vec v[3], const vec *d) {
  vec across[3]; /* a x b, b x c, c x a */
  num along[3], sum = num_of(0.0);
  int positive = 0, negative = 0;
  for (int k = 0; k < 3; k++) {
    across[k] = vec_cross(&v[k], &v[(k + 1) % 3]);
    along[k] = vec_dot(d, &across[k]);
    sum = num_add(sum, along[k]);
    const sign s = sign_of(along[k]);
    positive += s == POSITIVE;
    negative += s == NEGATIVE;
  }
  if (positive > 0 && negative > 0) return 0; /* it misses the triangle */
  const sign facing = sign_of(sum), ahead = sign_of(vec_dot(&v[0], &across[1]));
  if (facing != NO_SIGN && ahead == -facing) return 0; /* the plane is behind */
  if (positive < 3 && negative < 3) return 2;
  return facing != NO_SIGN && ahead == facing ? (int)facing : 2;
}

/* Outside of the box round the vertices. */
static bool is_beyond_box(const set *s, const vec *y) {
  bool beyond = false;
  for (int k = 0; k < 3; k++) {
    const num at = {y->m[k], y->e};
    beyond = beyond || num_bottom(at) > s->high[k] || num_top(at) < s->low[k];
  }
  return beyond;
}

/* The triangle is on one side of a plane through the ray: e is orthogonal to it, exactly. */
static bool is_beside(const vec v[3], const double e[3]) {
  int sides = 0;
  for (int k = 0; k < 3; k++) {
    const double m = e[0] * v[k].m[0] + e[1] * v[k].m[1] + e[2] * v[k].m[2];
    const double slack = 0x1p-48 * (fabs(v[k].m[0]) + fabs(v[k].m[1]) + fabs(v[k].m[2])) + 2.0 * v[k].e;
    sides += m > slack ? 1 : m < -slack ? -1 : 0;
  }
  return sides == 3 || sides == -3;
}

side winding_side(const set *s, const vec *y) {
  static const double ways[][3] = {{0.61, 0.35, 0.71},   {-0.23, 0.89, -0.39}, {0.47, -0.68, 0.56},
                                   {-0.83, -0.29, 0.47}, {0.17, 0.41, -0.89},  {0.93, -0.31, -0.19}};
  if (is_beyond_box(s, y)) return OUTSIDE;
  for (size_t i = 0; i < sizeof ways / sizeof *ways; i++) {
    const vec d = vec_of(ways[i]);
    const double beside[2][3] = {{d.m[1], -d.m[0], 0.0}, {0.0, d.m[2], -d.m[1]}};
    long winding = 0;
    size_t k = 0;
    for (; k < s->n; k += 3) {
      vec v[3];
      for (size_t j = 0; j < 3; j++) {
        const vec corner = vec_of(s->vertices[k + j]);
        v[j] = vec_sub(&corner, y);
      }
      if (is_beside(v, beside[0]) || is_beside(v, beside[1])) continue;
      const int crossed = crossing(v, &d);
      if (crossed == 2) break;
      winding += crossed;
    }
    if (k >= s->n) return winding != 0 ? INSIDE : OUTSIDE;
  }
  return UNKNOWN_SIDE;
}

/* ---- who asks ---- */

bool winding_pieces_begin_outside(const set *s, pieces *p, double from, double until) {
  const vec centre = vec_of(s->centre);
  for (size_t i = (size_t)floor(from); (double)i < until; i++) {
    vec y;
    if (!quick_point(p, i, fmax(from - (double)i, 0.0), &y)) return false;
    y = quick_to_frame(s, &y);
    y = vec_sub(&y, &centre);
    if (winding_side(s, &y) != OUTSIDE) return false;
  }
  return true;
}

vec winding_ball_of(const iv x[3]) {
  vec v = {.e = 0.0};
  for (int k = 0; k < 3; k++) {
    const double low = mpfr_get_d(x[k].lo, MPFR_RNDD), high = mpfr_get_d(x[k].hi, MPFR_RNDU);
    v.m[k] = 0.5 * (low + high);
    v.e += GROW(high - low + BALL_U * fabs(v.m[k]));
  }
  v.e = GROW(v.e);
  return v;
}
