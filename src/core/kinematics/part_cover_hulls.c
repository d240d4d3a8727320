/* SPDX-License-Identifier: BSD-3-Clause */
/* Hulls of few points that cover a part of a robot. */
#include <stdlib.h>

#include "base/rounding.h"
#include "convex/few_points.h"
#include "kinematics/part_cover.h"

/* Rings of points round a cylinder or a cone: a regular polygon about the circle is larger by 1 / cos(pi / 16). */
enum { RING = 16 };
static const double ROUND_RING = 1.01959115820831834,
                    COS[RING] = {1.0,  0.92387953251128674,  0.70710678118654752,  0.38268343236508977,
                                 0.0,  -0.38268343236508977, -0.70710678118654752, -0.92387953251128674,
                                 -1.0, -0.92387953251128674, -0.70710678118654752, -0.38268343236508977,
                                 0.0,  0.38268343236508977,  0.70710678118654752,  0.92387953251128674};

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

/* The hull of a polyhedron's vertices about `centre`, of which few are taken. */
static bool add_few(const few_points *few, vec3 centre, double margin, double inner, cover_hulls *to) {
  cover_hull *made = few ? begin_hull(to, few->n) : NULL;
  if (!made) return false;
  for (size_t i = 0; i < few->n; i++) add_point(to, made, vec_add(centre, few->point[i]));
  made->margin = UP * (margin + few->left) + 0x1p-48 * (vec_norm(centre) + few->radius);
  made->inner = inner;
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
    const few_points *few = cluster_hulls_few(from, (size_t)(of[k] - from->hull));
    if (!add_few(few, centre, m->tree_margin, m->tree_margin * (1.0 - 0x1p-40), to)) return false;
    if (m->winding || n + of[k]->count > COVER_MOST_HULLS || of[k]->inside[0] & TREE_LEAF) continue;
    to->hull[first + k].child = (uint32_t)n, to->hull[first + k].n_children = of[k]->count;
    for (uint32_t i = 0; i < of[k]->count; i++) of[n++] = &from->hull[of[k]->inside[i]];
  }
  return true;
}

static bool add_polytope(const part_model *m, cover_hulls *to) {
  few_points *few = few_points_of(m->shape);
  const bool good = add_few(few, vec(0, 0, 0), m->margin, m->tree ? -1.0 : m->margin * (1.0 - 0x1p-40), to);
  free(few);
  return good;
}

bool cover_is_by_hulls(const part_model *m) {
  const cprox_body_kind kind = m->shape->ops->kind;
  if (m->clusters) return true;
  return m->shape->ops == &convex_polytope || kind == CPROX_BODY_BOX || kind == CPROX_BODY_CYLINDER ||
         kind == CPROX_BODY_CONE;
}

bool cover_by_hulls(const part_model *m, cover_hulls *to) {
  if (m->clusters) return add_mesh(m, to);
  if (m->shape->ops == &convex_polytope) return add_polytope(m, to);
  return m->shape->ops->kind == CPROX_BODY_BOX ? add_box(m, to) : add_round(m, to);
}
