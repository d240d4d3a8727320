/* SPDX-License-Identifier: BSD-3-Clause */
/* GJK: the distance of a point y to a convex core (Gilbert, Johnson, Keerthi, IEEE J. Robotics and Automation 4(2),
 * 1988).
 *
 * A simplex of support points of the core is kept, as seen from y.
 *   1. Begin with the vertices of the hint, or with one support point.
 *   2. Find the point of the simplex that is nearest to y, and drop the vertices that it does not need.
 *   3. Look along its direction u: the support point gives the lower bound u·w of the distance, and a new vertex.
 *   4. End when lower bound and simplex have met, when y is inside the simplex, or when no vertex brings it
 *      nearer.
 *
 * Departures: the result is the interval of both bounds, not the simplex alone. Two directions are tried at each
 * place (gjk_step()). Some steps without a gain are allowed, as at a flat corner all are short. If y lies on a
 * feature of the simplex, the search begins once more from all sides. A depth that simplices cannot prove is left to
 * depth_proven(). */
#include "convex/gjk.h"

#include "base/rounding.h"
#include "convex/depth.h"
#include "convex/feature.h"
#include "convex/vertices.h"

enum { GJK_MAX_STEPS = 200, GJK_MAX_IDLE = 8 };

/* Depths below this, in contact tolerances, are not searched for beyond the simplices. */
static const double GJK_SHALLOW = 128.0;

/* A simplex that holds y so much less deep than the shape may hold it says too little. */
static const double GJK_THIN = 1e-6;

/* The point of the core that is extreme along d, as a vertex of the core seen from y. */
static simplex_vertex gjk_extreme(const convex *shape, vec3 y, vec3 d) {
  simplex_vertex vertex = {.id = -1};
  if (shape->n > 0) {
    vertex.id = vertices_extreme(shape, d, NULL);
    vertex.a = vertices_at(shape, vertex.id);
  } else {
    const double h = shape->ops->support(shape, d, NULL, &vertex.a);
    if (isnan(h)) vertex.a = vec(NAN, NAN, NAN);
  }
  vertex.w = vec_sub(vertex.a, y);
  return vertex;
}

/* The vertices of the last answer, or the one that is extreme towards y. */
static void gjk_start(const convex *shape, vec3 y, const convex_hint *hint, simplex *s) {
  s->n = 0;
  for (int i = 0; hint && i < hint->n && i < 4; i++) {
    const int32_t id = hint->vertex[i];
    if (id < 0 || id >= shape->n) continue;
    simplex_vertex vertex = {.id = id, .a = vertices_at(shape, id)};
    vertex.w = vec_sub(vertex.a, y);
    if (!simplex_has(s, vertex.w)) s->vertex[s->n++] = vertex;
  }
  if (s->n > 0) return;
  const vec3 towards = vec_norm2(y) > 0.0 ? y : vec(0, 0, 1);
  s->vertex[s->n++] = gjk_extreme(shape, y, towards);
}

static void gjk_keep_hint(const simplex *s, convex_hint *hint) {
  if (!hint) return;
  hint->n = s->n;
  for (int i = 0; i < s->n; i++) hint->vertex[i] = s->vertex[i].id;
}

static vec3 gjk_point(const simplex *s) {
  vec3 p = vec(0, 0, 0);
  for (int i = 0; i < s->n; i++) p = vec_axpy(p, s->weight[i], s->vertex[i].a);
  return p;
}

/* What the search knows. */
typedef struct gjk {
  const convex *shape;
  vec3 y;
  double contact_tolerance; /* distances that differ by less are the same */
  double near_enough;       /* the hint's */
  simplex s;
  simplex_nearest nearest;
  double least; /* the shortest distance so far */
  int idle;     /* steps since that got shorter by more than the tolerance */
  double lower; /* the best lower bound, the direction that gave it, and the core's height along that */
  vec3 normal;
  double height;
} gjk;

/* Takes a grown simplex over. One that is nearer by less than the tolerance may still face a better way: some of those
 * are let pass, since at a flat corner every step is that short. */
static bool gjk_accept(gjk *g, simplex *grown) {
  simplex_nearest found;
  simplex_reduce(grown, &found);
  if (!found.inside && !(found.distance < g->least + g->contact_tolerance)) return false;
  g->idle = found.inside || found.distance < g->least - g->contact_tolerance ? 0 : g->idle + 1;
  if (g->idle > GJK_MAX_IDLE) return false;
  g->least = fmin(g->least, found.distance);
  g->s = *grown;
  g->nearest = found;
  return true;
}

/* Looks along u, from y to the core, for a lower bound and a vertex that makes the simplex nearer. */
static bool gjk_support_step(gjk *g, vec3 u) {
  const simplex_vertex vertex = gjk_extreme(g->shape, g->y, vec_neg(u));
  const double lower = vec_dot(u, vertex.w);
  if (isnan(lower)) {
    g->nearest.distance = NAN;
    return false;
  }
  if (lower > g->lower) {
    g->lower = lower;
    g->normal = vec_neg(u);
    g->height = vec_dot(g->normal, vertex.a);
  }
  if (simplex_has(&g->s, vertex.w) || g->s.n == 4) return false;
  simplex grown = g->s;
  grown.vertex[grown.n++] = vertex;
  return gjk_accept(g, &grown);
}

/* Two directions are tried at each place: the feature's own, which is exact where v is all rounding, and v's, which is
 * exact where the feature is a sliver. */
static bool gjk_step(gjk *g) {
  const vec3 normal = g->nearest.normal;
  vec3 along;
  feature_unit(g->nearest.v, &along);
  if (vec_norm2(normal) > 0.0 && gjk_support_step(g, normal)) return true;
  if (!(g->nearest.distance - g->lower > 2.0 * g->contact_tolerance))
    return false; /* the bounds have met, or the callback failed */
  return vec_norm2(along) > 0.0 && !vec_equal(along, normal) && gjk_support_step(g, along);
}

/* Starts again from all round. */
static void gjk_restart(gjk *g) {
  simplex s = {0};
  for (int i = 0; i < 4; i++) {
    const simplex_vertex vertex = gjk_extreme(g->shape, g->y, simplex_spread[i]);
    if (!simplex_has(&s, vertex.w)) s.vertex[s.n++] = vertex;
  }
  g->least = INFINITY;
  g->idle = 0;
  gjk_accept(g, &s);
}

static void gjk_search(gjk *g) {
  bool restarted = false;
  gjk before;
  for (int i = 0; i < GJK_MAX_STEPS && !g->nearest.inside; i++) {
    /* y on a feature of the simplex: on the surface, or deep inside by chance */
    if (g->nearest.distance <= g->contact_tolerance) {
      if (restarted) break;
      restarted = true;
      before = *g;
      gjk_restart(g);
    } else if ((i > 0 && g->nearest.distance <= g->near_enough) ||
               !(g->nearest.distance - g->lower > 2.0 * g->contact_tolerance) || !gjk_step(g)) {
      break;
    }
  }
  if (restarted && !g->nearest.inside && g->nearest.distance > before.nearest.distance) *g = before;
}

/* Whether y may be deep inside although the simplices do not tell: it lies on planes through vertices, or so near to
 * them that what is proven is less than its rounding. */
static bool gjk_is_open(const gjk *g) {
  const double shallow = GJK_SHALLOW * g->contact_tolerance;
  if (g->nearest.inside)
    return g->nearest.depth <= fmax(shallow, GJK_THIN * fmin(-g->lower, g->shape->scale)) && g->lower < -2.0 * shallow;
  if (g->near_enough > 0.0 && g->nearest.distance <= g->near_enough) return false;
  return g->lower < -2.0 * shallow && g->nearest.distance - g->lower > 2.0 * g->contact_tolerance;
}

void gjk_nearest(const convex *shape, vec3 y, convex_hint *hint, gjk_answer *answer) {
  gjk g = {.shape = shape, .y = y, .least = INFINITY, .lower = -INFINITY};
  g.contact_tolerance = 4.0 * ROUND_U * (vec_norm(y) + shape->scale);
  simplex start;
  gjk_start(shape, y, hint, &start);
  g.near_enough = hint ? hint->near_enough : 0.0;
  simplex_reduce(&start, &g.nearest);
  g.s = start;
  g.least = g.nearest.distance;
  gjk_search(&g);
  if (gjk_is_open(&g)) {
    const double depth = depth_proven(shape, y);
    if (depth > 0.0) g.nearest.depth = fmax(depth, g.nearest.depth);
    g.nearest.inside |= depth > 0.0;
  }

  const bool inside = g.nearest.inside;
  answer->feature = g.s;
  gjk_keep_hint(&g.s, hint);
  answer->distance = inside ? -g.nearest.depth : g.nearest.distance;
  answer->point = inside ? y : gjk_point(&g.s);
  answer->normal = inside || g.nearest.distance == 0.0 ? vec(0, 0, 0) : g.normal;
  answer->height = g.height;
}
