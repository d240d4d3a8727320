/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/few_points.h"

#include <stdlib.h>

#include "base/rounding.h"

/* Points are enough when all others are within this part of the radius. */
static const double NEAR_ENOUGH = 2e-3;

static const double UP = 1.0 + 0x1p-40;

/* The points of a polyhedron, those that are taken, and of the others how far they are from the hull of these at most.
 */
typedef struct chosen {
  const convex *shape;
  double *apart; /* negative: it is taken */
  convex hull;
  double scale;
} chosen;

static vec3 point_of(const convex *shape, size_t i) {
  return vec(shape->x[i], shape->y[i], shape->z[i]);
}

static void choose(chosen *c, size_t i) {
  c->apart[i] = -1.0;
  const vec3 p = point_of(c->shape, i);
  for (size_t k = (size_t)c->hull.n; k < FEW_POINTS_MOST + 8; k++)
    c->hull.x[k] = p.x, c->hull.y[k] = p.y, c->hull.z[k] = p.z;
  c->hull.n++, c->hull.padded = (c->hull.n + 7) / 8 * 8;
}

/* From above. */
static double apart_from(const chosen *c, size_t i) {
  const vec3 p = point_of(c->shape, i);
  convex_hint hint = {0};
  convex_near near = {.distance = 0.0};
  c->hull.ops->nearest(&c->hull, p, &hint, &near);
  const double distance = near.distance > 0.0 ? near.distance : 0.0;
  const double above = distance + c->hull.ops->near_rounding * ROUND_U * (vec_norm(p) + c->scale);
  return near.distance == near.distance ? above : INFINITY;
}

/* The farthest points along the axes, then again and again the one that is farthest from the hull of all before it:
 * that distance only shrinks, so one that is the largest when it is measured anew is the largest. Returns what is left.
 */
static double choose_points(chosen *c, double enough) {
  const size_t n = (size_t)c->shape->n;
  for (size_t i = 0; i < n; i++) c->apart[i] = INFINITY;
  for (int side = 0; side < 6; side++) {
    const double *x = side % 3 == 0 ? c->shape->x : side % 3 == 1 ? c->shape->y : c->shape->z;
    size_t most = 0;
    for (size_t i = 1; i < n; i++)
      if (side < 3 ? x[i] > x[most] : x[i] < x[most]) most = i;
    if (c->apart[most] >= 0.0) choose(c, most);
  }
  for (size_t i = 0; i < n; i++)
    if (c->apart[i] >= 0.0) c->apart[i] = apart_from(c, i);
  for (;;) {
    size_t most = 0;
    for (size_t i = 1; i < n; i++)
      if (c->apart[i] > c->apart[most]) most = i;
    if (!(c->apart[most] > enough)) return c->apart[most] > 0.0 ? c->apart[most] : 0.0;
    const double now = apart_from(c, most);
    size_t next = n;
    for (size_t i = 0; i < n && next == n; i++)
      if (i != most && c->apart[i] > now) next = i;
    c->apart[most] = now;
    if (next < n) continue;
    if (c->hull.n == FEW_POINTS_MOST || !(now > enough)) return now;
    choose(c, most);
  }
}

few_points *few_points_of(const convex *shape) {
  enum { NUMBERS = FEW_POINTS_MOST + 8 };
  double numbers[3 * NUMBERS], radius = 0.0;
  chosen c = {.shape = shape, .apart = calloc((size_t)shape->n + 1, sizeof *c.apart)};
  if (!c.apart) return NULL;
  c.hull = (convex){.ops = &convex_polytope, .x = numbers, .y = numbers + NUMBERS, .z = numbers + 2 * NUMBERS};
  for (size_t i = 0; i < (size_t)shape->n; i++) radius = greater(vec_norm(point_of(shape, i)), radius);
  c.scale = c.hull.scale = radius * UP;
  const double left = choose_points(&c, NEAR_ENOUGH * radius);
  free(c.apart);
  const size_t n = (size_t)c.hull.n;
  few_points *out = malloc(sizeof *out + n * sizeof *out->point);
  if (!out) return NULL;
  *out = (few_points){.left = left, .radius = radius, .n = n};
  for (size_t i = 0; i < n; i++) out->point[i] = point_of(&c.hull, i);
  return out;
}
