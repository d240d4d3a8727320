/* SPDX-License-Identifier: BSD-3-Clause */
/* Hulls of few points that cover a part of a robot. */
#include <stdlib.h>

#include "base/rounding.h"
#include "kinematics/part_cover.h"

/* Rings of points round a cylinder or a cone: a regular polygon about the circle is larger by 1 / cos(pi / 16). */
enum { RING = 16 };
static const double ROUND_RING = 1.01959115820831834,
                    COS[RING] = {1.0,  0.92387953251128674,  0.70710678118654752,  0.38268343236508977,
                                 0.0,  -0.38268343236508977, -0.70710678118654752, -0.92387953251128674,
                                 -1.0, -0.92387953251128674, -0.70710678118654752, -0.38268343236508977,
                                 0.0,  0.38268343236508977,  0.70710678118654752,  0.92387953251128674};

/* A hull whose other points are within this part of its radius has points enough. */
static const double NEAR_ENOUGH = 2e-3;

static const double UP = 1.0 + 0x1p-40;

/* ---- memory ---- */

static bool reserve(void **array, size_t size, size_t n, size_t *room) {
  if (n <= *room) return true;
  const size_t more = n + n / 2 + 64;
  void *grown = realloc(*array, more * size);
  if (!grown) return false;
  *array = grown, *room = more;
  return true;
}

/* One more hull of points that are still to come, which there is room for. NULL: memory is out. */
static cover_hull *begin_hull(cover_hulls *to, size_t points) {
  void *hull = to->hull, *point = to->point;
  bool good = reserve(&hull, sizeof *to->hull, to->n + 1, &to->room);
  to->hull = hull;
  good = good && reserve(&point, sizeof *to->point, to->n_points + points, &to->room_of_points);
  to->point = point;
  if (!good) return NULL;
  cover_hull *made = &to->hull[to->n++];
  *made = (cover_hull){.first = (uint32_t)to->n_points, .inner = -1.0};
  return made;
}

static void add_point(cover_hulls *to, cover_hull *hull, vec3 p) {
  to->point[to->n_points++] = p, hull->n++;
}

/* ---- few points of many ---- */

/* The points of a polyhedron, those that are taken, and of the others how far they are from the hull of these at most.
 */
typedef struct chosen {
  const convex *shape;
  double *apart; /* negative: it is taken */
  double *numbers;
  convex hull;
  double scale;
} chosen;

static vec3 point_of(const convex *shape, size_t i) {
  return vec(shape->x[i], shape->y[i], shape->z[i]);
}

static void choose(chosen *c, size_t i) {
  c->apart[i] = -1.0;
  const vec3 p = point_of(c->shape, i);
  for (size_t k = (size_t)c->hull.n; k < COVER_MOST_POINTS + 8; k++)
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
    if (c->hull.n == COVER_MOST_POINTS || !(now > enough)) return now;
    choose(c, most);
  }
}

/* The hull of a polyhedron's vertices about `centre`, of which few are taken. */
static bool add_polyhedron(const convex *shape, vec3 centre, double margin, double inner, cover_hulls *to) {
  enum { NUMBERS = COVER_MOST_POINTS + 8 };
  double numbers[3 * NUMBERS], radius = 0.0;
  chosen c = {.shape = shape, .apart = calloc((size_t)shape->n + 1, sizeof *c.apart)};
  cover_hull *made = c.apart ? begin_hull(to, COVER_MOST_POINTS) : NULL;
  if (!made) {
    free(c.apart);
    return false;
  }
  c.hull = (convex){.ops = &convex_polytope, .x = numbers, .y = numbers + NUMBERS, .z = numbers + 2 * NUMBERS};
  for (size_t i = 0; i < (size_t)shape->n; i++) radius = greater(vec_norm(point_of(shape, i)), radius);
  c.scale = c.hull.scale = radius * UP;
  const double left = choose_points(&c, NEAR_ENOUGH * radius);
  for (size_t i = 0; i < (size_t)c.hull.n; i++) add_point(to, made, vec_add(centre, point_of(&c.hull, i)));
  made->margin = UP * (margin + left) + 0x1p-48 * (vec_norm(centre) + radius);
  made->inner = inner;
  free(c.apart);
  return true;
}

/* ---- shapes ---- */

static bool add_box(const part_model *m, cover_hulls *to) {
  cover_hull *made = begin_hull(to, 8);
  if (!made) return false;
  const double *h = m->shape->size;
  for (int k = 0; k < 8; k++)
    add_point(to, made, vec(k & 1 ? h[0] : -h[0], k & 2 ? h[1] : -h[1], k & 4 ? h[2] : -h[2]));
  made->margin = UP * m->margin;
  made->inner = m->tree ? -1.0 : m->margin * (1.0 - 0x1p-40);
  return true;
}

static bool add_round(const part_model *m, cover_hulls *to) {
  cover_hull *made = begin_hull(to, 2 * RING);
  if (!made) return false;
  const double radius = ROUND_RING * UP * m->shape->size[0], half = m->shape->size[1];
  const bool is_cone = m->shape->ops->kind == CPROX_BODY_CONE;
  for (int k = 0; k < RING; k++) {
    const double x = radius * COS[k], y = radius * COS[(k + RING - RING / 4) % RING];
    add_point(to, made, vec(x, y, -half));
    if (!is_cone) add_point(to, made, vec(x, y, half));
  }
  if (is_cone) add_point(to, made, vec(0, 0, half));
  made->margin = UP * m->margin + 0x1p-40 * (radius + half);
  return true;
}

/* A mesh: the hull of all its triangles, of the triangles under each lane of its tree, and once more. */
static bool add_mesh(const part_model *m, cover_hulls *to) {
  const cluster_hulls *from = m->clusters;
  const size_t first = to->n;
  const cluster_hull *of[COVER_MOST_HULLS] = {&from->hull[0]};
  size_t n = 1;
  for (size_t k = 0; k < n; k++) {
    const vec3 centre = vec_add(m->tree_at, of[k]->centre);
    if (!add_polyhedron(&of[k]->shape, centre, m->tree_margin, m->tree_margin * (1.0 - 0x1p-40), to)) return false;
    if (m->winding || n + of[k]->count > COVER_MOST_HULLS || of[k]->inside[0] & TREE_LEAF) continue;
    to->hull[first + k].child = (uint32_t)n, to->hull[first + k].n_children = of[k]->count;
    for (uint32_t i = 0; i < of[k]->count; i++) of[n++] = &from->hull[of[k]->inside[i]];
  }
  return true;
}

bool cover_is_by_hulls(const part_model *m) {
  const cprox_body_kind kind = m->shape->ops->kind;
  if (m->clusters) return true;
  return m->shape->ops == &convex_polytope || kind == CPROX_BODY_BOX || kind == CPROX_BODY_CYLINDER ||
         kind == CPROX_BODY_CONE;
}

bool cover_by_hulls(const part_model *m, cover_hulls *to) {
  if (m->clusters) return add_mesh(m, to);
  if (m->shape->ops == &convex_polytope)
    return add_polyhedron(m->shape, vec(0, 0, 0), m->margin, m->tree ? -1.0 : m->margin * (1.0 - 0x1p-40), to);
  return m->shape->ops->kind == CPROX_BODY_BOX ? add_box(m, to) : add_round(m, to);
}
