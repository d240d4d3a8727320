/* SPDX-License-Identifier: BSD-3-Clause */
#include "convex/gjk.h"

#include "base/rounding.h"
#include "convex/feature.h"
#include "convex/vertices.h"

enum { GJK_MAX_STEPS = 200 };

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

static bool simplex_has(const simplex *s, vec3 w) {
  for (int i = 0; i < s->n; i++)
    if (vec_equal(s->vertex[i].w, w)) return true;
  return false;
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

/* One step along the direction u (from y to the core): the lower bound it gives, and whether the vertex it finds brings the
 * simplex nearer. */
typedef struct gjk_step {
  double lower;
  bool nearer;
} gjk_step;

static gjk_step gjk_advance(const convex *shape, vec3 y, vec3 u, simplex *s, simplex_nearest *nearest) {
  const simplex_vertex vertex = gjk_extreme(shape, y, vec_neg(u));
  gjk_step step = {.lower = vec_dot(u, vertex.w)};
  if (isnan(step.lower) || simplex_has(s, vertex.w)) return step;
  simplex grown = *s;
  grown.vertex[grown.n++] = vertex;
  simplex_nearest found;
  simplex_reduce(&grown, &found);
  if (!found.inside && !(found.distance < nearest->distance)) return step;
  step.nearer = true;
  *s = grown;
  *nearest = found;
  return step;
}

void gjk_nearest(const convex *shape, vec3 y, convex_hint *hint, gjk_answer *answer) {
  simplex s;
  simplex_nearest nearest;
  gjk_start(shape, y, hint, &s);
  simplex_reduce(&s, &nearest);

  /* until the bounds meet; two directions are tried at each place: the feature's own, which is exact where v is all
   * rounding, and v's, which is exact where the feature is a sliver */
  const double enough = 8.0 * ROUND_U * (vec_norm(y) + shape->scale);
  double best = -INFINITY;
  vec3 best_normal = vec(0, 0, 0);
  for (int i = 0; i < GJK_MAX_STEPS && !nearest.inside && nearest.distance > 0.0; i++) {
    vec3 along;
    feature_unit(nearest.v, &along);
    bool nearer = false;
    for (int k = 0; k < 2 && !nearer; k++) {
      const vec3 u = k == 0 ? nearest.normal : along;
      if (vec_norm2(u) == 0.0 || (k == 1 && vec_equal(u, nearest.normal))) continue;
      const double distance = nearest.distance;
      const gjk_step step = gjk_advance(shape, y, u, &s, &nearest);
      nearer = step.nearer;
      if (step.lower > best) {
        best = step.lower;
        best_normal = vec_neg(u);
      }
      if (isnan(step.lower)) nearest.distance = NAN;
      if (distance - best <= enough) break;
    }
    if (!nearer || nearest.distance - best <= enough) break;
  }

  answer->feature = s;
  gjk_keep_hint(&s, hint);
  answer->distance = nearest.inside ? -nearest.depth : nearest.distance;
  answer->point = nearest.inside ? y : gjk_point(&s);
  answer->normal = nearest.inside || nearest.distance == 0.0 ? vec(0, 0, 0) : best_normal;
}
