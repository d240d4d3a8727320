/* SPDX-License-Identifier: BSD-3-Clause */
/* EPA: the depth of 0 inside a convex set (expanding polytope algorithm, G. van den Bergen, Game Developers
 * Conference 2001).
 *
 * The facets of a closed surface round 0 are kept, whose vertices belong to the set.
 *   1. Begin with the tetrahedron, triangle or edge that GJK ends with, completed by support points.
 *   2. Take the facet with the least offset: this offset is a lower bound of the depth.
 *   3. The support point along its normal gives an upper bound of the depth.
 *   4. End when the bounds have met, or when the support point is no farther out than the facet.
 *   5. Replace the facets that the support point sees by facets from their horizon to it.
 *
 * Departures: the depth is an interval. Along any unit n every point p of a facet has n·p >= min n·w over its
 * vertices, so step 2 is proven whatever the accuracy of the normals. Where the horizon is no simple loop, because
 * of rounding, the nearest facet alone is replaced. If 0 lies on planes through vertices, a place beside it is
 * enclosed first (epa_beside()). Coaxial bodies of revolution have a plane problem (epa_ring.c). */
#include "convex/epa.h"

#include <stdlib.h>

#include "base/rounding.h"
#include "convex/double_double_cross.h"
#include "convex/feature.h"

enum {
  MOST_STEPS = 400,
  MOST_VERTICES = MOST_STEPS + 4,
  MOST_FACETS = 2 * MOST_VERTICES,
  MOST_HORIZON = 128,
  MOST_SEEN = 256
};

typedef struct facet {
  int32_t vertex[3];    /* counter-clockwise from outside */
  int32_t neighbour[3]; /* beyond the edge from vertex k to vertex k + 1 */
  vec3 normal;
  double offset; /* min of normal·w over the vertices */
  bool alive;
} facet;

typedef struct surface {
  vec3 shift; /* w of the vertices are relative to this: 0, or a place beside it */
  simplex_vertex *vertex;
  int32_t n_vertices, most_vertices;
  facet *facet;
  int32_t n_facets, most_facets;
  int32_t *free, n_free;
  double *offset; /* of each facet, beside the others so that the least is found quickly; infinity where it is free */
} surface;

/* Where a surface stands: as large as a query needs, without allocation, or allocated. */
typedef struct surface_room {
  simplex_vertex vertex[MOST_VERTICES];
  facet facet[MOST_FACETS];
  int32_t free[MOST_FACETS];
  double offset[MOST_FACETS];
  void *allocated;
} surface_room;

static void surface_place(surface *s, surface_room *room, int32_t wanted) {
  *s = (surface){.vertex = room->vertex,
                 .most_vertices = MOST_VERTICES,
                 .facet = room->facet,
                 .most_facets = MOST_FACETS,
                 .free = room->free,
                 .offset = room->offset};
  room->allocated = NULL;
  if (wanted <= MOST_VERTICES) return;
  const size_t n = (size_t)wanted, m = 2 * n;
  char *bytes = malloc(n * sizeof *s->vertex + m * (sizeof *s->facet + sizeof *s->offset + sizeof *s->free));
  if (!bytes) return;
  room->allocated = bytes;
  s->most_vertices = wanted, s->most_facets = 2 * wanted;
  s->vertex = (simplex_vertex *)bytes;
  s->facet = (facet *)(s->vertex + n);
  s->offset = (double *)(s->facet + m);
  s->free = (int32_t *)(s->offset + m);
}

/* ---- facets ---- */

static inline double offset_along(const surface *s, const facet *f, vec3 n) {
  return lesser(vec_dot(n, s->vertex[f->vertex[0]].w),
                lesser(vec_dot(n, s->vertex[f->vertex[1]].w), vec_dot(n, s->vertex[f->vertex[2]].w)));
}

/* Takes a normal if it proves more. */
static inline void facet_try(const surface *s, facet *f, vec3 n) {
  const double offset = offset_along(s, f, n);
  if (!(offset > f->offset)) return;
  f->offset = offset;
  f->normal = n;
}

/* Whether the edges enclose an angle whose sine is below 0.1: it multiplies the rounding of their product. */
static bool is_sliver(vec3 cross, vec3 ab, vec3 ac) {
  return !(vec_norm2(cross) > 1e-2 * vec_norm2(ab) * vec_norm2(ac));
}

/* A sliver's own normal is computed in sums of two doubles; where it has no area at all, the direction in which it lies
 * from 0 is a better one. */
static void facet_try_sliver(const surface *s, facet *f) {
  const vec3 a = s->vertex[f->vertex[0]].w, b = s->vertex[f->vertex[1]].w, c = s->vertex[f->vertex[2]].w;
  const vec3 ab = vec_sub(b, a), ac = vec_sub(c, a), cross = double_double_cross(a, b, c);
  vec3 n;
  feature_unit(cross, &n);
  facet_try(s, f, n);
  if (vec_norm2(cross) > 1e-24 * vec_norm2(ab) * vec_norm2(ac)) return;
  simplex flat = {.n = 3};
  for (int k = 0; k < 3; k++) flat.vertex[k] = s->vertex[f->vertex[k]];
  simplex_nearest nearest;
  simplex_reduce(&flat, &nearest);
  facet_try(s, f, nearest.normal);
}

/* The normal of the triangle itself, wherever that is well defined. */
static inline void facet_find_normal(const surface *s, facet *f) {
  const vec3 a = s->vertex[f->vertex[0]].w, b = s->vertex[f->vertex[1]].w, c = s->vertex[f->vertex[2]].w;
  const vec3 ab = vec_sub(b, a), ac = vec_sub(c, a), cross = vec_cross(ab, ac);
  vec3 n;
  feature_unit(cross, &n);
  facet_try(s, f, n);
  if (is_sliver(cross, ab, ac)) facet_try_sliver(s, f);
}

/* Adds a facet: there is room. Its neighbours are set by who joins it to them. */
static int32_t surface_add(surface *s, int32_t a, int32_t b, int32_t c) {
  const int32_t at = s->n_free > 0 ? s->free[--s->n_free] : s->n_facets++;
  facet *f = &s->facet[at];
  f->vertex[0] = a, f->vertex[1] = b, f->vertex[2] = c;
  f->normal = vec(0, 0, 0);
  f->offset = -INFINITY;
  f->alive = true;
  facet_find_normal(s, f);
  s->offset[at] = f->offset;
  return at;
}

static void surface_drop(surface *s, int32_t at) {
  s->facet[at].alive = false;
  s->offset[at] = INFINITY;
  s->free[s->n_free++] = at;
}

/* The facet that is nearest to 0. There are few, and a scan has no branches to guess: a heap takes longer. */
static inline int32_t surface_nearest(const surface *s) {
  double least = INFINITY;
#pragma omp simd reduction(min : least)
  for (int32_t i = 0; i < s->n_facets; i++) least = s->offset[i] < least ? s->offset[i] : least;
  int32_t at = 0;
  while (at + 1 < s->n_facets && s->offset[at] != least) at++;
  return at;
}

/* ---- expanding ---- */

/* An edge between what is seen from the new vertex and what is not. */
typedef struct horizon_edge {
  int32_t from, to; /* as the facet that goes has it */
  int32_t beyond;   /* the facet that stays */
} horizon_edge;

typedef struct view {
  int32_t seen[MOST_SEEN], n_seen;
  horizon_edge edge[MOST_HORIZON];
  int32_t n_edges;
} view;

/* Only facets that lie beyond the rounding may go: then the tetrahedra between them and the new vertex do not contain
 * 0, and what takes their place encloses 0 as they did. */
static bool is_seen(const facet *f, vec3 w, double rounding) {
  return f->offset > rounding && vec_dot(f->normal, w) > f->offset;
}

/* All facets that see w and hang together with the first one, and the edges round them. */
static bool view_from(surface *s, int32_t first, vec3 w, double rounding, view *v) {
  v->n_edges = 0;
  v->n_seen = 1;
  v->seen[0] = first;
  s->facet[first].alive = false; /* marks what has been reached */
  bool room = true;
  for (int32_t i = 0; i < v->n_seen && room; i++) {
    const facet *f = &s->facet[v->seen[i]];
    for (int k = 0; k < 3 && room; k++) {
      facet *g = &s->facet[f->neighbour[k]];
      if (g->alive && is_seen(g, w, rounding)) {
        room = v->n_seen < MOST_SEEN;
        if (!room) break;
        g->alive = false;
        v->seen[v->n_seen++] = f->neighbour[k];
      }
    }
  }
  for (int32_t i = 0; i < v->n_seen && room; i++) {
    const facet *f = &s->facet[v->seen[i]];
    for (int k = 0; k < 3; k++) {
      if (!s->facet[f->neighbour[k]].alive) continue;
      room = v->n_edges < MOST_HORIZON;
      if (!room) break;
      v->edge[v->n_edges++] =
          (horizon_edge){.from = f->vertex[k], .to = f->vertex[(k + 1) % 3], .beyond = f->neighbour[k]};
    }
  }
  for (int32_t i = 0; i < v->n_seen; i++) s->facet[v->seen[i]].alive = true;
  return room;
}

/* Puts the edges in order, each beginning where the one before ends. False where they do not make one loop. */
static bool view_close(view *v) {
  for (int32_t i = 0; i + 1 < v->n_edges; i++) {
    int32_t next = i + 1;
    while (next < v->n_edges && v->edge[next].from != v->edge[i].to) next++;
    if (next == v->n_edges) return false;
    const horizon_edge moved = v->edge[i + 1];
    v->edge[i + 1] = v->edge[next];
    v->edge[next] = moved;
  }
  return v->n_edges >= 3 && v->edge[v->n_edges - 1].to == v->edge[0].from;
}

/* That facet alone: what is seen need not hang together round a surface that is not convex yet. */
static void view_alone(const surface *s, int32_t first, view *v) {
  const facet *f = &s->facet[first];
  v->n_seen = 1;
  v->seen[0] = first;
  v->n_edges = 3;
  for (int k = 0; k < 3; k++)
    v->edge[k] = (horizon_edge){.from = f->vertex[k], .to = f->vertex[(k + 1) % 3], .beyond = f->neighbour[k]};
}

/* Takes the seen facets away and joins the loop to the new vertex. False where there is no room; nothing has changed
 * then. */
static bool surface_grow(surface *s, const simplex_vertex *x, const view *v) {
  if (s->n_vertices == s->most_vertices) return false;
  if (s->n_free + v->n_seen + s->most_facets - s->n_facets < v->n_edges) return false;
  const int32_t top = s->n_vertices++;
  s->vertex[top] = *x;
  for (int32_t i = 0; i < v->n_seen; i++) surface_drop(s, v->seen[i]);
  int32_t made[MOST_HORIZON];
  for (int32_t i = 0; i < v->n_edges; i++) made[i] = surface_add(s, v->edge[i].from, v->edge[i].to, top);
  for (int32_t i = 0; i < v->n_edges; i++) {
    facet *f = &s->facet[made[i]], *beyond = &s->facet[v->edge[i].beyond];
    f->neighbour[0] = v->edge[i].beyond;
    f->neighbour[1] = made[(i + 1) % v->n_edges];
    f->neighbour[2] = made[(i + v->n_edges - 1) % v->n_edges];
    for (int k = 0; k < 3; k++)
      if (beyond->vertex[k] == v->edge[i].to && beyond->vertex[(k + 1) % 3] == v->edge[i].from)
        beyond->neighbour[k] = made[i];
  }
  return true;
}

/* ---- the search ---- */

/* The set's point farthest along n, seen from the middle that the surface is round. */
static simplex_vertex farthest_from(const epa_set *set, vec3 shift, vec3 n) {
  simplex_vertex x = set->farthest(set->self, n);
  x.w = vec_sub(x.w, shift);
  return x;
}

/* A surface that begins: its facets counter-clockwise from outside, and what lies beyond their edges. */
typedef struct shell {
  int n_vertices, n_facets;
  int corner[6][3], beyond[6][3];
} shell;

static const shell TETRAHEDRON = {
    4, 4, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}, {{1, 2, 3}, {3, 2, 0}, {1, 3, 0}, {2, 1, 0}}};

/* 0 1 2 the ring, 3 and 4 the apexes. */
static const shell BIPYRAMID = {5,
                                6,
                                {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}, {1, 0, 4}, {2, 1, 4}, {0, 2, 4}},
                                {{3, 1, 2}, {4, 2, 0}, {5, 0, 1}, {0, 5, 4}, {1, 3, 5}, {2, 4, 3}}};

/* False where one of the facets does not have 0 behind it by more than the rounding, or a vertex in front of it. All of
 * them having it there, 0 is enclosed: the solid angles that they span at 0 are positive, and their sum is a multiple
 * of the whole. */
static bool surface_begin(surface *s, const simplex_vertex *vertex, const shell *form, double rounding) {
  s->n_vertices = form->n_vertices;
  s->n_facets = s->n_free = 0;
  for (int i = 0; i < form->n_vertices; i++) s->vertex[i] = vertex[i];
  for (int i = 0; i < form->n_facets; i++) {
    const int *corner = form->corner[i];
    const vec3 a = vertex[corner[0]].w, ab = vec_sub(vertex[corner[1]].w, a), ac = vec_sub(vertex[corner[2]].w, a);
    vec3 n, cross = vec_cross(ab, ac);
    if (is_sliver(cross, ab, ac)) cross = double_double_cross(a, vertex[corner[1]].w, vertex[corner[2]].w);
    feature_unit(cross, &n);
    if (!(vec_dot(n, a) > rounding)) return false;
    for (int k = 0; k < form->n_vertices && form->n_vertices > 4; k++)
      if (vec_dot(n, vertex[k].w) > vec_dot(n, a) + 16.0 * rounding) return false;
    const int32_t f = surface_add(s, corner[0], corner[1], corner[2]);
    for (int k = 0; k < 3; k++) s->facet[f].neighbour[k] = form->beyond[i][k];
  }
  return s->facet[surface_nearest(s)].offset > rounding;
}

/* From a simplex that has 0 inside. */
static bool begin_tetrahedron(surface *s, const simplex *start, double rounding) {
  simplex_vertex vertex[4];
  for (int i = 0; i < 4; i++) vertex[i] = start->vertex[i];
  const vec3 a = vertex[0].w, b = vec_sub(vertex[1].w, a), c = vec_sub(vertex[2].w, a), d = vec_sub(vertex[3].w, a);
  if (vec_dot(vec_cross(b, c), d) > 0.0) { /* then 0 1 2 is clockwise from outside */
    vertex[0] = start->vertex[1];
    vertex[1] = start->vertex[0];
  }
  return surface_begin(s, vertex, &TETRAHEDRON, rounding);
}

/* From a triangle that has 0 on it: farther points on both sides. */
static bool begin_triangle(surface *s, const epa_set *set, const simplex *start, double rounding) {
  simplex_vertex vertex[5];
  vec3 n;
  const vec3 a = start->vertex[0].w;
  feature_unit(vec_cross(vec_sub(start->vertex[1].w, a), vec_sub(start->vertex[2].w, a)), &n);
  if (vec_norm2(n) == 0.0) return false;
  for (int i = 0; i < 3; i++) vertex[i] = start->vertex[i];
  vertex[3] = farthest_from(set, s->shift, n);
  vertex[4] = farthest_from(set, s->shift, vec_neg(n));
  return surface_begin(s, vertex, &BIPYRAMID, rounding);
}

/* From the farthest points both ways along n, and farther points all round, tried from a few angles: some may fall
 * together. */
static bool begin_line(surface *s, const epa_set *set, vec3 n, double rounding) {
  enum { ANGLES = 7 };
  simplex_vertex vertex[5];
  vec3 e, f;
  feature_tangents(n, &e, &f);
  vertex[3] = farthest_from(set, s->shift, n);
  vertex[4] = farthest_from(set, s->shift, vec_neg(n));
  for (int k = 0; k < ANGLES; k++) {
    for (int i = 0; i < 3; i++) {
      const double angle = 2.0943951023931953 * ((double)i + (double)k / ANGLES);
      vertex[i] = farthest_from(set, s->shift, vec_add(vec_scale(cos(angle), e), vec_scale(sin(angle), f)));
    }
    if (surface_begin(s, vertex, &BIPYRAMID, rounding)) return true;
  }
  return false;
}

/* Of a tetrahedron with 0 all but on one of its faces, that face. */
static simplex face_nearest(const simplex *start) {
  int least = 0;
  for (int i = 1; i < 4; i++)
    if (start->weight[i] < start->weight[least]) least = i;
  simplex face = *start;
  face.vertex[least] = start->vertex[3];
  face.weight[least] = start->weight[3];
  face.n = 3;
  return face;
}

static bool begin_from(surface *s, const epa_set *set, const simplex *start, double rounding) {
  if (start->n == 4 && begin_tetrahedron(s, start, rounding)) return true;
  const simplex face = start->n == 4 ? face_nearest(start) : *start;
  if (face.n == 3 && begin_triangle(s, set, &face, rounding)) return true;
  for (int i = 0; i < start->n; i++) {
    vec3 n;
    feature_unit(start->vertex[i].w, &n);
    if (vec_norm2(n) > 0.0 && begin_line(s, set, n, rounding)) return true;
  }
  return false;
}

/* Of the facets on the nearest plane, the one that has its foot: coplanar ones share the offset. They are used up.
 * Facets that are nearer than what is proven were turned round by rounding in the last step: they are none of M's. */
static void find_touch(surface *s, double room, double rounding, epa_depth *depth) {
  enum { MOST_TRIED = 16 };
  double nearest = INFINITY;
  for (int tried = 0; tried < MOST_TRIED && nearest > depth->least + rounding;) {
    const int32_t at = surface_nearest(s);
    const double offset = s->offset[at];
    if (!(offset < INFINITY) || (nearest < INFINITY && offset > depth->least + room)) return;
    s->offset[at] = INFINITY;
    if (offset < depth->least - rounding) continue;
    tried++;
    simplex triangle = {.n = 3};
    for (int k = 0; k < 3; k++) triangle.vertex[k] = s->vertex[s->facet[at].vertex[k]];
    simplex_nearest found;
    simplex_reduce(&triangle, &found);
    if (found.distance >= nearest) continue;
    nearest = found.distance;
    depth->touch = triangle;
  }
}

static bool is_enough(const epa_depth *depth, const epa_goal *goal) {
  if (goal->rough && depth->least > goal->rounding && depth->most <= 4.0 * depth->least) return true;
  return depth->most - depth->least <= goal->width;
}

/* Until the bounds are as close as is asked for, or `least` passes what is enough. False where the set is at fault. */
static bool surface_expand(surface *s, const epa_set *set, const epa_goal *goal, double enough, epa_depth *depth) {
  view v;
  const uint32_t room = (uint32_t)s->most_vertices - (MOST_VERTICES - MOST_STEPS);
  const uint32_t most = goal->max_steps < room ? goal->max_steps : room;
  while (depth->steps < most) {
    const int32_t best = surface_nearest(s);
    const facet *f = &s->facet[best];
    depth->least = greater(depth->least, f->offset);
    if (is_enough(depth, goal) || depth->least > enough) {
      depth->exhausted = false;
      break;
    }

    /* the set's plane above the facet that is nearest to 0 */
    const simplex_vertex x = farthest_from(set, s->shift, f->normal);
    depth->steps++;
    const double reach = vec_dot(f->normal, x.w) + x.behind;
    if (isnan(reach)) return false;
    if (reach < depth->most) {
      depth->most = reach;
      depth->normal = f->normal;
    }
    if (is_enough(depth, goal) || !(reach - f->offset > 0.25 * goal->rounding) || !is_seen(f, x.w, goal->rounding)) {
      depth->exhausted = false;
      break;
    }
    if (!view_from(s, best, x.w, goal->rounding, &v) || !view_close(&v)) view_alone(s, best, &v);
    if (!surface_grow(s, &x, &v)) break;
  }
  return true;
}

/* The facet towards which the least shift of 0 leads out elsewhere, and that shift. The surface lies inside the set: a
 * way out that crosses a facet is at least as long as the way to the facet's plane. Where that facet is one with the
 * nearest, its normal within e = EPA_ALIKE, a way out farther than 2e from the normal is longer by 1 / cos e: after a
 * shift by q it is no shorter while (least - q)(1 - cos e) > e q + (most - least), so up to 0.2 e least if most - least
 * is at most 0.25 e^2 least. */
static double surface_least_shift(const surface *s, const epa_depth *depth, int32_t *at) {
  double least = INFINITY;
  *at = -1;
  for (int32_t i = 0; i < s->n_facets; i++) {
    if (!(s->offset[i] < INFINITY)) continue;
    const double angle = vec_norm(vec_sub(s->facet[i].normal, depth->normal));
    if (!(angle > EPA_ALIKE)) continue;
    const double shift = (s->offset[i] - depth->most) / angle;
    if (shift < least) least = shift, *at = i;
  }
  return least;
}

/* Facets other than the nearest are as coarse as the search has left them: those that are in the way are made finer
 * until the shift is as large as asked for, or a plane of the set shows that it is not. */
static bool surface_part(surface *s, const epa_set *set, const epa_goal *goal, epa_depth *depth) {
  enum { MOST_MORE = 40 };
  view v;
  if (!(depth->most - depth->least <= 0.25 * EPA_ALIKE * EPA_ALIKE * depth->least)) return true;
  for (int more = 0; more < MOST_MORE; more++) {
    int32_t at;
    const double shift = surface_least_shift(s, depth, &at);
    depth->shift = greater(lesser(shift, 0.2 * EPA_ALIKE * depth->least), 0.0);
    if (shift >= goal->shift || depth->steps >= goal->max_steps) return true;
    const facet *f = &s->facet[at];
    const double angle = vec_norm(vec_sub(f->normal, depth->normal));
    const simplex_vertex x = farthest_from(set, s->shift, f->normal);
    depth->steps++;
    const double reach = vec_dot(f->normal, x.w) + x.behind;
    if (isnan(reach)) return false;
    if (reach - depth->most < goal->shift * angle || !is_seen(f, x.w, goal->rounding)) return true;
    if (!view_from(s, at, x.w, goal->rounding, &v) || !view_close(&v)) view_alone(s, at, &v);
    if (!surface_grow(s, &x, &v)) return true;
  }
  return true;
}

static const epa_depth UNKNOWN = {.least = -INFINITY, .most = INFINITY, .exhausted = true};

/* From a surface that encloses 0. */
static bool surface_finish(surface *s, const epa_set *set, const epa_goal *goal, epa_depth *depth) {
  if (!surface_expand(s, set, goal, INFINITY, depth)) return false;
  if (goal->shift > 0.0 && !depth->exhausted && !surface_part(s, set, goal, depth)) return false;
  find_touch(s, greater(goal->width, goal->rounding), goal->rounding, depth);
  return true;
}

bool epa_from(const epa_set *set, const simplex *start, const epa_goal *goal, epa_depth *depth) {
  surface_room room;
  surface s;
  surface_place(&s, &room, goal->room);
  bool found = begin_from(&s, set, start, goal->rounding);
  if (found) {
    *depth = UNKNOWN;
    found = surface_finish(&s, set, goal, depth);
  }
  free(room.allocated);
  return found;
}

/* Seen from 0 again, which lies nearer to `shift` than any facet: so every facet has it behind, and the surface
 * encloses it as well. */
static void surface_return(surface *s) {
  for (int32_t i = 0; i < s->n_vertices; i++) s->vertex[i].w = vec_add(s->vertex[i].w, s->shift);
  s->shift = vec(0, 0, 0);
  for (int32_t i = 0; i < s->n_facets; i++) {
    facet *f = &s->facet[i];
    if (!f->alive) continue;
    const vec3 before = f->normal;
    f->offset = -INFINITY;
    facet_try(s, f, before);
    facet_find_normal(s, f);
    s->offset[i] = f->offset;
  }
}

/* From a surface round its shift. */
static bool surface_expand_beside(surface *s, const epa_set *set, const simplex *start, const epa_goal *goal,
                                  epa_depth *depth) {
  if (!begin_from(s, set, start, goal->rounding)) return false;

  /* until a ball about the shift is free that holds 0 and more than the rounding */
  const double needed = vec_norm(s->shift) + 2.0 * goal->rounding;
  epa_goal inner = *goal;
  inner.width = 0.0, inner.rough = false;
  epa_depth free = UNKNOWN;
  if (!surface_expand(s, set, &inner, needed, &free) || !(free.least > needed)) return false;
  surface_return(s);
  *depth = UNKNOWN;
  depth->steps = free.steps;
  return s->offset[surface_nearest(s)] > goal->rounding && surface_finish(s, set, goal, depth);
}

bool epa_beside(const epa_set *set, const simplex *start, vec3 shift, const epa_goal *goal, epa_depth *depth) {
  surface_room room;
  surface s;
  surface_place(&s, &room, goal->room);
  s.shift = shift;
  const bool found = surface_expand_beside(&s, set, start, goal, depth);
  free(room.allocated);
  return found;
}
