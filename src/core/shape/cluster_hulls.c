/* SPDX-License-Identifier: BSD-3-Clause */
#include "shape/cluster_hulls.h"

#include <stdlib.h>
#include <string.h>

#include "base/rounding.h"

enum { PADDING = 8 };

/* ---- places ---- */

static bool is_repeated(const tree *t, uint32_t pack, uint32_t lane) {
  const uint32_t *ids = t->ids + (size_t)pack * TREE_LANES;
  return lane > 0 && ids[lane] == ids[lane - 1];
}

/* The places of all corners, each once. */
typedef struct places {
  vec3 *at; /* room for all corners */
  uint32_t n;
  uint32_t *corner; /* of corner k of lane l of pack p, at 3 (8 p + l) + k: the number of its place */
  uint32_t *slots;  /* a table of numbers, by their coordinates; NOWHERE: empty */
  size_t mask;      /* the table has so many slots, less one; a power of two */
} places;

enum { NOWHERE = UINT32_MAX };

static void places_free(places *p) {
  free(p->at);
  free(p->corner);
  free(p->slots);
}

/* Places that are equal have equal hashes: adding 0 turns -0 into 0. */
static size_t hash_of(vec3 p) {
  const double numbers[3] = {p.x + 0.0, p.y + 0.0, p.z + 0.0};
  uint64_t bits[3], h = 0;
  memcpy(bits, numbers, sizeof bits);
  for (int k = 0; k < 3; k++) {
    h = (h ^ bits[k]) * 0x9e3779b97f4a7c15u;
    h ^= h >> 32;
  }
  return (size_t)h;
}

static uint32_t number_of(places *p, vec3 at) {
  size_t slot = hash_of(at) & p->mask;
  while (p->slots[slot] != NOWHERE && !vec_equal(p->at[p->slots[slot]], at)) slot = (slot + 1) & p->mask;
  if (p->slots[slot] == NOWHERE) {
    p->slots[slot] = p->n;
    p->at[p->n++] = at;
  }
  return p->slots[slot];
}

/* False where memory is out. */
static bool places_find(const tree *t, places *p) {
  size_t slots = 64;
  while (slots < 6 * t->n) slots *= 2;
  *p = (places){.mask = slots - 1};
  p->at = malloc((3 * t->n + 1) * sizeof *p->at);
  p->corner = malloc((3 * TREE_LANES * t->n_packs + 1) * sizeof *p->corner);
  p->slots = malloc(slots * sizeof *p->slots);
  if (!p->at || !p->corner || !p->slots) return false;
  memset(p->slots, 0xff, slots * sizeof *p->slots);
  for (uint32_t pack = 0; pack < t->n_packs; pack++)
    for (uint32_t l = 0; l < TREE_LANES; l++) {
      if (is_repeated(t, pack, l)) continue;
      vec3 corners[3];
      tree_corners(t, (tree_place){pack, l}, corners);
      for (int k = 0; k < 3; k++) p->corner[3 * ((size_t)pack * TREE_LANES + l) + (size_t)k] = number_of(p, corners[k]);
    }
  return true;
}

/* ---- hulls ---- */

typedef struct builder {
  const tree *t;
  cluster_hulls *made;
  size_t room_of_hulls, room_of_vertices;
  places places;
  uint32_t *seen; /* of each place the number of the latest hull that has it, plus 1 */
  vec3 *corners;  /* of the hull at hand */
  bool failed;
} builder;

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
      const uint32_t *corner = b->places.corner + 3 * ((size_t)pack * TREE_LANES + l);
      for (int k = 0; k < 3; k++) {
        if (b->seen[corner[k]] == stamp) continue;
        b->seen[corner[k]] = stamp;
        b->corners[n++] = b->places.at[corner[k]];
      }
    }
  }
  return n;
}

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
  builder b = {.t = t, .made = calloc(1, sizeof *b.made)};
  b.failed = !b.made || !places_find(t, &b.places);
  if (!b.failed) {
    b.seen = calloc(b.places.n + 1, sizeof *b.seen);
    b.corners = malloc((b.places.n + 1) * sizeof *b.corners);
    b.failed = !b.seen || !b.corners;
  }
  if (!b.failed) add_hull(&b, 0);
  if (!b.failed) add_inside(&b, 0, 0);
  places_free(&b.places);
  free(b.seen);
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
