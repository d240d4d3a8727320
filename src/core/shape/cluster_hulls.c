/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/cluster_hulls.h"

#include <stdlib.h>

#include "base/rounding.h"
#include "shape/places.h"

enum { PADDING = 8 };

static bool is_repeated(const tree *t, uint32_t pack, uint32_t lane) {
  const uint32_t *ids = t->ids + (size_t)pack * TREE_LANES;
  return lane > 0 && ids[lane] == ids[lane - 1];
}

/* ---- hulls ---- */

typedef struct builder {
  const tree *t;
  cluster_hulls *made;
  size_t room_of_hulls, room_of_vertices;
  places places;    /* of all corners */
  uint32_t *corner; /* of corner k of lane l of pack p, at 3 (8 p + l) + k: the number of its place */
  uint32_t *seen;   /* of each place the number of the latest hull that has it, plus 1 */
  vec3 *corners;    /* of the hull at hand */
  bool failed;
} builder;

/* False where memory is out. */
static bool number_corners(builder *b) {
  const tree *t = b->t;
  b->corner = malloc((3 * TREE_LANES * t->n_packs + 1) * sizeof *b->corner);
  if (!b->corner || !places_begin(&b->places, 3 * t->n)) return false;
  for (uint32_t pack = 0; pack < t->n_packs; pack++)
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      if (is_repeated(t, pack, l)) continue;
      uint32_t *number = b->corner + 3 * ((size_t)pack * TREE_LANES + l);
      vec3 corners[3];
      tree_corners(t, (tree_place){pack, l}, corners);
      for (int k = 0; k < 3; k++) number[k] = places_number(&b->places, corners[k]);
    }
  return true;
}

/* The places of all corners of the triangles under a node or a pack, each once; how many. */
static size_t gather(builder *b, uint32_t at) {
  const tree *t = b->t;
  const uint32_t stamp = (uint32_t)b->made->n + 1;
  uint32_t open[TREE_LANES * TREE_DEEPEST] = {at};
  size_t n = 0;
  for (size_t count = 1; count > 0;) {
    const uint32_t next = open[--count], pack = next & ~TREE_LEAF;
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      if (!(next & TREE_LEAF)) {
        if (t->nodes[next].lanes >> l & 1u) open[count++] = t->nodes[next].child[l];
        continue;
      }
      if (is_repeated(t, pack, l)) continue;
      const uint32_t *corner = b->corner + 3 * ((size_t)pack * TREE_LANES + l);
      for (int k = 0; k < 3; k++) {
        if (b->seen[corner[k]] == stamp) continue;
        b->seen[corner[k]] = stamp;
        b->corners[n++] = b->places.at[corner[k]];
      }
    }
  }
  return n;
}

/* Room for one more hull, and for so many numbers. What the first room is for is seldom more. */
static bool make_room(builder *b, size_t numbers) {
  cluster_hulls *made = b->made;
  const size_t n = b->t->n;
  if (made->n == b->room_of_hulls) {
    const size_t room = b->room_of_hulls > 0 ? 2 * b->room_of_hulls : n / 4 + 16;
    cluster_hull *grown = realloc(made->hull, room * sizeof *grown);
    if (!grown) return false;
    made->hull = grown, b->room_of_hulls = room;
  }
  if (b->made->n_vertices + numbers > b->room_of_vertices) {
    const size_t room = (b->room_of_vertices > 0 ? 2 * b->room_of_vertices : 16 * n) + numbers;
    double *grown = realloc(made->vertices, room * sizeof *grown);
    if (!grown) return false;
    made->vertices = grown, b->room_of_vertices = room;
  }
  return true;
}

/* The room that was not needed. */
static void give_back(cluster_hulls *made) {
  cluster_hull *hull = realloc(made->hull, made->n * sizeof *hull);
  if (hull) made->hull = hull;
  double *vertices = realloc(made->vertices, made->n_vertices * sizeof *vertices);
  if (vertices) made->vertices = vertices;
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
  const size_t n = gather(b, at);
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
  hull.radius *= 1.0 + ROUND_LENGTH * ROUND_U;
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
  builder b = {.t = t, .made = calloc(1, sizeof *b.made)};
  b.failed = !b.made || !number_corners(&b);
  if (!b.failed) {
    b.seen = calloc(b.places.n + 1, sizeof *b.seen);
    b.corners = malloc((b.places.n + 1) * sizeof *b.corners);
    b.failed = !b.seen || !b.corners;
  }
  if (!b.failed) add_hull(&b, 0);
  if (!b.failed) add_inside(&b, 0, 0);
  places_free(&b.places);
  free(b.corner);
  free(b.seen);
  free(b.corners);
  if (!b.failed) {
    give_back(b.made);
    b.made->few = calloc(b.made->n, sizeof *b.made->few);
    b.failed = !b.made->few;
  }
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
  for (size_t i = 0; hulls->few && i < hulls->n; i++) free(atomic_load_explicit(&hulls->few[i], memory_order_relaxed));
  free(hulls->few);
  free(hulls->hull);
  free(hulls->vertices);
  free(hulls);
}

const few_points *cluster_hulls_few(const cluster_hulls *hulls, size_t hull) {
  _Atomic(few_points *) *few = &hulls->few[hull];
  few_points *known = atomic_load_explicit(few, memory_order_acquire);
  if (known) return known;
  few_points *made = few_points_of(&hulls->hull[hull].shape);
  if (made && atomic_compare_exchange_strong_explicit(few, &known, made, memory_order_acq_rel, memory_order_acquire))
    return made;
  free(made);
  return known; /* that of another thread, which was faster */
}

size_t cluster_hulls_bytes(const cluster_hulls *hulls) {
  return sizeof *hulls + hulls->n * (sizeof *hulls->hull + sizeof *hulls->few) +
         hulls->n_vertices * sizeof *hulls->vertices;
}
