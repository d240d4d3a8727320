/* SPDX-License-Identifier: BSD-3-Clause */
/* The hull of vertices, any number of them in any dimension. */
#include "base/rounding.h"
#include "convex/feature.h"
#include "convex/gjk.h"
#include "convex/vertices.h"

static void polytope_nearest(const convex *shape, vec3 y, convex_hint *hint, convex_near *near) {
  gjk_answer answer;
  gjk_nearest(shape, y, hint, &answer);
  *near = (convex_near){.distance = answer.distance, .point = answer.point, .normal = answer.normal};
  if (!(answer.distance > 0.0)) return;
  near->height_known = fabs(vec_norm2(answer.normal) - 1.0) <= ROUND_NORMAL * ROUND_U;
  near->height = answer.height;

  /* the feature is what the nearest point needs: one vertex, an edge, a face */
  const simplex *s = &answer.feature;
  if (s->n == 1) feature_vertex(near, s->vertex[0].a, 0.0);
  if (s->n == 2) {
    vec3 e;
    feature_unit(vec_sub(s->vertex[1].a, s->vertex[0].a), &e);
    feature_edge(near, s->vertex[0].a, e, 0.0);
  }
  if (s->n == 3) {
    vec3 e, f;
    feature_tangents(near->normal, &e, &f);
    feature_face(near, e, f);
  }
}

/* near_rounding: vertices about the centre (u), differences with y (u), their weighted sum (8u), its norm (3u): so much
 * the distance can be below the true one, whatever the search did. Above it by what the search left between its bounds,
 * 8u, and a tolerance, 4u, for each step along a plateau; the rest of 64 is room, the tests find 50 in needles of
 * aspect 1e6. */
const convex_ops convex_polytope = {.kind = CPROX_BODY_POLYTOPE,
                                    .near_rounding = 64.0,
                                    .proves_depth = true,
                                    .nearest = polytope_nearest,
                                    .support = vertices_support,
                                    .cover = vertices_cover};
