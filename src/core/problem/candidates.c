/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/candidates.h"

#include "base/frame.h"
#include "base/rounding.h"
#include "problem/placed_pair.h"
#include "problem/radius.h"
#include "shape/body.h"

candidate_ball candidate_bounding_ball(const query *q, const candidate *c, double *sizes) {
  const placed_model m = placed_model_of_obstacle(q, c);
  return placed_model_ball(&q->obstacles[c->obstacle], c->part, &m, sizes);
}

/* The mover's capsule against the candidate's ball. */
double candidate_ball_bound(const query *q, const candidate *c) {
  const cprox_obstacle *obstacle = &q->obstacles[c->obstacle];
  const placed_models both = placed_models_resolve(q, c);
  double placing;
  const candidate_ball round = placed_model_ball(obstacle, c->part, &both.obstacle, &placing);
  if (!isfinite(round.radius)) return -INFINITY;
  candidate_ball own = {0}; /* round what is carried, about the curve's point */
  if (both.carried.body) {
    const frame f = frame_create(&both.carried.pose, vec(0, 0, 0));
    own.centre = frame_to_world(&f, both.carried.body->ball_centre), own.radius = both.carried.body->ball_radius;
  }
  const vec3 centre = vec_sub(round.centre, own.centre);
  const curve_capsule *capsule = &q->reach;
  const double offset = q->mover.radius + both.carried.excess + (obstacle->margin + both.obstacle.excess);
  const double most = radius_most(q->mover.radius_curve) + radius_most(obstacle->radius_curve);
  const double reach = capsule->radius + round.radius + own.radius + offset + most;
  /* rounding: the pose of the centre, the projection on the chord, the sums; doc/rounding.md */
  const double sizes = placed_size(capsule->a) + placed_size(capsule->b) + placed_size(centre) + placing +
                       2.0 * placed_size(own.centre) + reach;
  return vec_to_segment(centre, capsule->a, capsule->b) - reach - ROUND_BALLS * ROUND_U * sizes;
}

/* Shell's sort by lower: qsort may allocate. */
void candidates_sort(candidate *list, size_t n) {
  for (size_t gap = n / 2; gap > 0; gap /= 2) {
    for (size_t i = gap; i < n; i++) {
      const candidate moved = list[i];
      size_t k = i;
      for (; k >= gap && list[k - gap].lower > moved.lower; k -= gap) list[k] = list[k - gap];
      list[k] = moved;
    }
  }
}

candidate *candidates_list(const query *q, size_t first, size_t last, bool ranked, size_t *count) {
  const size_t carried = body_n_parts(q->mover.body);
  size_t n = 0;
  for (size_t i = first; i < last; i++) n += body_n_parts(q->obstacles[i].body) * carried;
  candidate *list = workspace_reserve(q->workspace, WORKSPACE_ORDER, n * sizeof *list);
  if (!list) return NULL;
  size_t k = 0;
  for (size_t i = first; i < last; i++) {
    for (size_t pair = 0; pair < body_n_parts(q->obstacles[i].body) * carried; pair++) {
      list[k] = (candidate){
          .obstacle = (int32_t)i, .part = (int32_t)(pair / carried), .mover_part = (int32_t)(pair % carried)};
      list[k].lower = ranked || n > 1 ? candidate_ball_bound(q, &list[k]) : -INFINITY;
      k++;
    }
  }
  candidates_sort(list, n);
  *count = n;
  return list;
}
