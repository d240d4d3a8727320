/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/flat.h"

#include "base/rounding.h"
#include "convex/feature.h"

/* Thinner than this fraction of its size, a core counts as flat: no bound rests on that. */
static const double FLAT = 1e-12;

static vec3 extreme(const convex *shape, vec3 d) {
  vec3 at = vec(0, 0, 0);
  shape->ops->support(shape, d, NULL, &at);
  return at;
}

/* The two points farthest apart along one of the axes. */
static void longest_chord(const convex *shape, vec3 *from, vec3 *to) {
  const vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double longest = -1.0;
  for (int i = 0; i < 3; i++) {
    const vec3 a = extreme(shape, vec_neg(axes[i])), b = extreme(shape, axes[i]);
    const double length = vec_norm(vec_sub(b, a));
    if (length > longest) longest = length, *from = a, *to = b;
  }
}

void flat_describe(const convex *shape, flat_shape *flat) {
  *flat = (flat_shape){.dimension = 3};
  vec3 to = vec(0, 0, 0);
  const double least = FLAT * shape->scale;
  if (shape->ops->kind == CPROX_BODY_HALFSPACE) return;
  longest_chord(shape, &flat->origin, &to);
  const double length = feature_unit(vec_sub(to, flat->origin), &flat->e);
  if (!(length > least)) flat->e = vec(1, 0, 0);

  /* what is farthest from that chord spans the plane with it */
  vec3 across[2], side = vec(0, 0, 0);
  feature_tangents(flat->e, &across[0], &across[1]);
  double farthest = 0.0;
  for (int i = 0; i < 4; i++) {
    const vec3 from = vec_sub(extreme(shape, i % 2 ? vec_neg(across[i / 2]) : across[i / 2]), flat->origin);
    const vec3 off = vec_axpy(from, -vec_dot(from, flat->e), flat->e);
    const double distance = vec_norm(off);
    if (distance > farthest) farthest = distance, side = off;
  }
  if (!(farthest > least)) side = across[0];
  feature_unit(side, &flat->f);
  flat->normal = vec_cross(flat->e, flat->f);

  const double up = shape->ops->support(shape, flat->normal, NULL, NULL) - vec_dot(flat->normal, flat->origin);
  const double down =
      shape->ops->support(shape, vec_neg(flat->normal), NULL, NULL) + vec_dot(flat->normal, flat->origin);
  flat->thickness = greater(fabs(up), fabs(down));
  if (!(flat->thickness <= least)) return;
  flat->dimension = farthest > least ? 2 : length > least ? 1 : 0;
}

/* ---- what it covers ---- */

/* The point of the core that is farthest along (dx, dy) of the plane, behind corner `after`. */
static void add_corner(const convex *shape, const flat_shape *flat, flat_region *region, double dx, double dy,
                       int after) {
  const vec3 p = vec_sub(extreme(shape, vec_axpy(vec_scale(dx, flat->e), dy, flat->f)), flat->origin);
  for (int i = region->n; i > after + 1; i--) region->x[i] = region->x[i - 1], region->y[i] = region->y[i - 1];
  region->x[after + 1] = vec_dot(flat->e, p);
  region->y[after + 1] = vec_dot(flat->f, p);
  region->n++;
  region->thickness = greater(region->thickness, fabs(vec_dot(flat->normal, p)) + 32.0 * ROUND_U * shape->scale);
}

void flat_region_begin(const convex *shape, const flat_shape *flat, flat_region *region) {
  enum { FIRST = 8 };
  *region = (flat_region){.n = 0};
  for (int i = 0; i < FIRST; i++) {
    const double angle = 0.78539816339744831 * i;
    add_corner(shape, flat, region, cos(angle), sin(angle), region->n - 1);
    const int last = region->n - 1;
    if (last > 0 && region->x[last] == region->x[last - 1] && region->y[last] == region->y[last - 1]) region->n--;
  }
  const int last = region->n - 1;
  if (last > 0 && region->x[last] == region->x[0] && region->y[last] == region->y[0]) region->n--;
}

/* By how much all points are to the left of the edge from corner i on, less what its rounding makes of that. */
static double least_left(const convex *shape, const flat_region *region, int i, const double *x, const double *y,
                         size_t n, double *ex, double *ey) {
  const int next = (i + 1) % region->n;
  const double dx = region->x[next] - region->x[i], dy = region->y[next] - region->y[i];
  const double length = feature_hypot(dx, dy);
  *ex = dx, *ey = dy;
  double least = INFINITY;
  for (size_t k = 0; k < n; k++) {
    const double px = x[k] - region->x[i], py = y[k] - region->y[i], size = shape->scale + fabs(px) + fabs(py);
    const double turned = 64.0 * ROUND_U * shape->scale * (fabs(px) + fabs(py)) / length;
    least = lesser(least, (dx * py - dy * px) / length - turned - 64.0 * ROUND_U * size);
  }
  return least; /* NaN where the edge has no length */
}

bool flat_region_covers(const convex *shape, const flat_shape *flat, flat_region *region, const double *x,
                        const double *y, size_t n, double room) {
  for (int i = 0; i < region->n;) {
    double ex, ey;
    if (least_left(shape, region, i, x, y, n, &ex, &ey) > room) {
      i++;
      continue;
    }
    /* another corner beyond this edge, if there is one */
    if (region->n < 2 || region->n == FLAT_MOST_CORNERS) return false;
    const double length = feature_hypot(ex, ey);
    if (!(length > 0.0)) return false;
    add_corner(shape, flat, region, ey / length, -ex / length, i);
    const double px = region->x[i + 1] - region->x[i], py = region->y[i + 1] - region->y[i];
    const double beyond = (ey * px - ex * py) / length;
    if (beyond > 32.0 * ROUND_U * shape->scale) continue;
    /* there is none: as it was */
    for (int k = i + 1; k + 1 < region->n; k++) region->x[k] = region->x[k + 1], region->y[k] = region->y[k + 1];
    region->n--;
    return false;
  }
  return region->n >= 3;
}
