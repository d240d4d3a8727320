/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/candidates.h"

#include "base/frame.h"
#include "base/rounding.h"
#include "problem/placed_pair.h"
#include "problem/radius.h"
#include "shape/body.h"

/* No less than the length, and had without a root: for sums of sizes that rounding is measured by. */
static double size_of(vec3 v) {
  return fabs(v.x) + fabs(v.y) + fabs(v.z);
}

static double distance_to_segment(vec3 p, vec3 a, vec3 b) {
  const vec3 ab = vec_sub(b, a), ap = vec_sub(p, a);
  const double length2 = vec_norm2(ab), along = vec_dot(ap, ab);
  const double s = length2 > 0.0 ? lesser(greater(along / length2, 0.0), 1.0) : 0.0;
  return vec_norm(vec_sub(p, vec_lerp(a, b, s)));
}

/* Round a whole curve, in its frame. */
static candidate_ball ball_of_curve(const cprox_curve *curve) {
  const curve_capsule whole = curve_whole(curve), *capsule = &whole;
  const double length = vec_norm(vec_sub(capsule->b, capsule->a));
  return (candidate_ball){.centre = vec_lerp(capsule->a, capsule->b, 0.5), .radius = 0.5 * length + capsule->radius};
}

/* Round one model of an obstacle, or where its curve carries that. */
static candidate_ball bounding_ball_of(const cprox_obstacle *obstacle, int32_t part, const placed_model *m,
                                       double *sizes) {
  const candidate_ball run = obstacle->curve ? ball_of_curve(obstacle->curve) : (candidate_ball){0};
  candidate_ball round = {0};
  *sizes = 0.0;
  if (m->body) {
    const frame f = frame_create(&m->pose, vec(0, 0, 0));
    round.centre = frame_to_world(&f, m->body->ball_centre);
    round.radius = m->body->ball_radius;
    *sizes += size_of(m->body->ball_centre) + size_of(m->pose.position);
    /* a compound's part: what the two positions lose may be more than their sum, which is small where they cancel */
    if (obstacle->body && obstacle->body->kind == CPROX_BODY_COMPOUND)
      *sizes += size_of(obstacle->body->parts[part].pose.position);
  }
  if (obstacle->curve) {
    const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
    round.centre = vec_add(round.centre, frame_to_world(&f, run.centre));
    round.radius += run.radius;
    *sizes += size_of(run.centre) + size_of(f.position) + round.radius;
  }
  return round;
}

candidate_ball candidate_bounding_ball(const query *q, const candidate *c, double *sizes) {
  const placed_model m = placed_model_of_obstacle(q, c);
  return bounding_ball_of(&q->targets[c->target], c->part, &m, sizes);
}

/* The ball round what is carried, about the curve's point. */
static candidate_ball carried_ball(const placed_model *carried) {
  if (!carried->body) return (candidate_ball){0};
  const frame f = frame_create(&carried->pose, vec(0, 0, 0));
  return (candidate_ball){.centre = frame_to_world(&f, carried->body->ball_centre),
                          .radius = carried->body->ball_radius};
}

/* The mover's capsule against the candidate's ball. */
double candidate_ball_bound(const query *q, const candidate *c) {
  const cprox_obstacle *obstacle = &q->targets[c->target];
  const placed_models both = placed_models_resolve(q, c);
  double placing;
  const candidate_ball round = bounding_ball_of(obstacle, c->part, &both.obstacle, &placing);
  if (!isfinite(round.radius)) return -INFINITY;
  const candidate_ball own = carried_ball(&both.carried);
  const vec3 centre = vec_sub(round.centre, own.centre);
  const curve_capsule *capsule = &q->reach;
  const double offset = q->mover.radius + both.carried.excess + (obstacle->margin + both.obstacle.excess);
  const double most = radius_most(q->mover.radius_curve) + radius_most(obstacle->radius_curve);
  const double reach = capsule->radius + round.radius + own.radius + offset + most;
  /* rounding: the pose of the centre, the projection on the chord, the sums; doc/rounding.md */
  const double sizes =
      size_of(capsule->a) + size_of(capsule->b) + size_of(centre) + placing + 2.0 * size_of(own.centre) + reach;
  return distance_to_segment(centre, capsule->a, capsule->b) - reach - 64.0 * ROUND_U * sizes;
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

void candidates_sort_again(candidate *list, size_t i, size_t n) {
  const candidate moved = list[i];
  for (; i + 1 < n && list[i + 1].lower < moved.lower; i++) list[i] = list[i + 1];
  list[i] = moved;
}

candidate *candidates_list(const query *q, size_t first, size_t last, bool ranked, size_t *count) {
  const size_t carried = body_n_parts(q->mover.body);
  size_t n = 0;
  for (size_t i = first; i < last; i++) n += body_n_parts(q->targets[i].body) * carried;
  candidate *list = workspace_reserve(q->workspace, WORKSPACE_ORDER, n * sizeof *list);
  if (!list) return NULL;
  size_t k = 0;
  for (size_t i = first; i < last; i++) {
    for (size_t pair = 0; pair < body_n_parts(q->targets[i].body) * carried; pair++) {
      list[k] =
          (candidate){.target = (int32_t)i, .part = (int32_t)(pair / carried), .mover_part = (int32_t)(pair % carried)};
      list[k].lower = ranked || n > 1 ? candidate_ball_bound(q, &list[k]) : -INFINITY;
      k++;
    }
  }
  candidates_sort(list, n);
  *count = n;
  return list;
}
