/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/cluster_hulls.h"

#include <stdlib.h>

#include "base/rounding.h"

enum { PADDING = 8 };

/* ---- vertices ---- */

static int compare_numbers(double a, double b) {
  return (a > b) - (a < b);
}

static int compare_places(const void *a, const void *b) {
  const vec3 *p = a, *q = b;
  const int x = compare_numbers(p->x, q->x), y = compare_numbers(p->y, q->y);
  return x ? x : y ? y : compare_numbers(p->z, q->z);
}

static bool is_repeated(const tree *t, uint32_t pack, uint32_t lane) {
  const uint32_t *ids = t->ids + (size_t)pack * TREE_LANES;
  return lane > 0 && ids[lane] == ids[lane - 1];
}

/* The corners of all triangles under a node or a pack; at most 3 a triangle. */
static void gather(const tree *t, uint32_t at, vec3 *corners, size_t *n) {
  uint32_t open[TREE_LANES * TREE_DEEPEST] = {at};
  for (size_t count = 1; count > 0;) {
    const uint32_t next = open[--count];
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      if (next & TREE_LEAF) {
        if (is_repeated(t, next & ~TREE_LEAF, l)) continue;
        tree_corners(t, (tree_place){next & ~TREE_LEAF, l}, corners + *n);
        *n += 3;
      } else if (t->nodes[next].lanes >> l & 1u) {
        open[count++] = t->nodes[next].child[l];
      }
    }
  }
}

/* Each place once; how many. */
static size_t merge(vec3 *corners, size_t n) {
  size_t kept = 0;
  qsort(corners, n, sizeof *corners, compare_places);
  for (size_t i = 0; i < n; i++)
    if (kept == 0 || !vec_equal(corners[i], corners[kept - 1])) corners[kept++] = corners[i];
  return kept;
}

/* ---- hulls ---- */

typedef struct builder {
  const tree *t;
  cluster_hulls *made;
  size_t room_of_hulls, room_of_vertices;
  vec3 *corners;
  bool failed;
} builder;

/* Room for one more hull, and for so many numbers. */
static bool make_room(builder *b, size_t numbers) {
  cluster_hulls *made = b->made;
  if (made->n == b->room_of_hulls) {
    const size_t room = 2 * b->room_of_hulls + 16;
    cluster_hull *grown = realloc(made->hull, room * sizeof *grown);
    if (!grown) return false;
    made->hull = grown, b->room_of_hulls = room;
  }
  if (b->made->n_vertices + numbers > b->room_of_vertices) {
    const size_t room = 2 * b->room_of_vertices + numbers;
    double *grown = realloc(made->vertices, room * sizeof *grown);
    if (!grown) return false;
    made->vertices = grown, b->room_of_vertices = room;
  }
  return true;
}

static void find_box(cluster_hull *hull, const vec3 *corners, size_t n) {
  vec3 low = corners[0], high = low;
  for (size_t i = 1; i < n; i++) {
    const vec3 p = corners[i];
    low = vec(lesser(low.x, p.x), lesser(low.y, p.y), lesser(low.z, p.z));
    high = vec(greater(high.x, p.x), greater(high.y, p.y), greater(high.z, p.z));
  }
  hull->centre = vec_axpy(vec_scale(0.5, low), 0.5, high);
  hull->half = vec(0, 0, 0);
}

/* The hull of what is under a node or a pack; its number. Pointers into the vertices are set at the end, when these
 * stay where they are. */
static uint32_t add_hull(builder *b, uint32_t at) {
  size_t n = 0;
  gather(b->t, at, b->corners, &n);
  n = merge(b->corners, n);
  const size_t padded = (n + PADDING - 1) / PADDING * PADDING;
  if (n == 0 || n > INT32_MAX / 2 || !make_room(b, 3 * padded) || !b->made->vertices) {
    b->failed = true;
    return 0;
  }
  cluster_hull hull = {.shape = {.ops = &convex_polytope, .n = (int32_t)n, .padded = (int32_t)padded}};
  find_box(&hull, b->corners, n);
  double *x = b->made->vertices + b->made->n_vertices;
  b->made->n_vertices += 3 * padded;
  for (size_t i = 0; i < padded; i++) {
    const vec3 p = vec_sub(b->corners[i < n ? i : n - 1], hull.centre);
    x[i] = p.x, x[padded + i] = p.y, x[2 * padded + i] = p.z;
    hull.half = vec(greater(hull.half.x, fabs(p.x)), greater(hull.half.y, fabs(p.y)), greater(hull.half.z, fabs(p.z)));
    hull.radius = greater(hull.radius, vec_norm(p));
  }
  hull.radius *= 1.0 + 8.0 * ROUND_U;
  hull.shape.scale = hull.radius;
  const uint32_t number = (uint32_t)b->made->n++;
  b->made->hull[number] = hull;
  return number;
}

/* What a node or a pack consists of. */
static void add_inside(builder *b, uint32_t number, uint32_t at) {
  const uint32_t pack = at & ~TREE_LEAF;
  for (uint32_t l = 0; l < TREE_LANES && !b->failed; l++) {
    uint32_t inner;
    if (at & TREE_LEAF) {
      if (is_repeated(b->t, pack, l)) continue;
      inner = (pack * TREE_LANES + l) | TREE_LEAF;
    } else {
      if (!(b->t->nodes[at].lanes >> l & 1u)) continue;
      const uint32_t child = b->t->nodes[at].child[l];
      inner = add_hull(b, child);
      if (!b->failed) add_inside(b, inner, child);
    }
    if (b->failed) return;
    cluster_hull *hull = &b->made->hull[number];
    hull->inside[hull->count++] = inner;
  }
}

cluster_hulls *cluster_hulls_create(const tree *t) {
  builder b = {.t = t, .made = calloc(1, sizeof *b.made), .corners = calloc(3 * t->n, sizeof *b.corners)};
  b.failed = !b.made || !b.corners;
  if (!b.failed) add_hull(&b, 0);
  if (!b.failed) add_inside(&b, 0, 0);
  free(b.corners);
  if (b.failed) {
    cluster_hulls_free(b.made);
    return NULL;
  }
  double *x = b.made->vertices;
  for (size_t i = 0; i < b.made->n; i++) {
    convex *shape = &b.made->hull[i].shape;
    shape->x = x, shape->y = x + shape->padded, shape->z = shape->y + shape->padded;
    x += 3 * shape->padded;
  }
  return b.made;
}

void cluster_hulls_free(cluster_hulls *hulls) {
  if (!hulls) return;
  free(hulls->hull);
  free(hulls->vertices);
  free(hulls);
}

size_t cluster_hulls_bytes(const cluster_hulls *hulls) {
  return sizeof *hulls + hulls->n * sizeof *hulls->hull + hulls->n_vertices * sizeof *hulls->vertices;
}
