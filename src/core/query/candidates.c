/* SPDX-License-Identifier: BSD-3-Clause */
#include "query/candidates.h"

#include "base/frame.h"
#include "base/rounding.h"
#include "body/body.h"
#include "query/carried.h"
#include "query/curve_side.h"
#include "query/robot_answer.h"

void question_ask_whole(question *q) {
  if (q->mover.motion) {
    robot_ask_whole(q);
    return;
  }
  q->part = curve_side_whole();
  q->reach = q->mover.curve->capsules[1];
  cprox_curve_domain(q->mover.curve, &q->t0, &q->t1);
}

const cprox_body *candidate_body(const question *q, const candidate *c) {
  const cprox_target *target = &q->targets[c->target];
  const cprox_body *body = target->on_clock && !target->body ? &carried_point : target->body;
  return body && body->kind == CPROX_COMPOUND ? body->parts[c->part].body : body;
}

cprox_pose candidate_pose(const question *q, const candidate *c) {
  const cprox_target *target = &q->targets[c->target];
  cprox_pose pose = target->pose;
  if (target->on_clock) pose.position = vec(0, 0, 0);
  if (!target->body || target->body->kind != CPROX_COMPOUND) return pose;
  return frame_compose(&pose, &target->body->parts[c->part].pose);
}

frame candidate_frame(const question *q, const candidate *c) {
  const cprox_target *target = &q->targets[c->target];
  const vec3 centre = candidate_body(q, c)->centre;
  cprox_pose pose = target->pose;
  if (target->on_clock) pose.position = vec(0, 0, 0);
  if (!target->body || target->body->kind != CPROX_COMPOUND) return frame_create(&pose, centre);
  return frame_create_within(&pose, &target->body->parts[c->part].pose, centre);
}

double candidate_offset(const question *q, const candidate *c) {
  return q->mover.radius + q->targets[c->target].padding;
}

const cprox_body *candidate_carried(const question *q, const candidate *c, cprox_pose *pose) {
  const cprox_body *body = q->mover.body;
  const bool compound = body && body->kind == CPROX_COMPOUND;
  *pose = compound ? body->parts[c->mover_part].pose : cprox_pose_identity();
  return compound ? body->parts[c->mover_part].body : body;
}

static double distance_to_segment(vec3 p, vec3 a, vec3 b) {
  const vec3 ab = vec_sub(b, a), ap = vec_sub(p, a);
  const double length2 = vec_norm2(ab), along = vec_dot(ap, ab);
  const double s = length2 > 0.0 ? fmin(fmax(along / length2, 0.0), 1.0) : 0.0;
  return vec_norm(vec_sub(p, vec_lerp(a, b, s)));
}

/* Round a whole curve, in its frame. */
static candidate_ball ball_of_curve(const cprox_curve *curve) {
  const curve_capsule *capsule = &curve->capsules[1];
  const double length = vec_norm(vec_sub(capsule->b, capsule->a));
  return (candidate_ball){.centre = vec_lerp(capsule->a, capsule->b, 0.5), .radius = 0.5 * length + capsule->radius};
}

candidate_ball candidate_bounding_ball(const question *q, const candidate *c, double *sizes) {
  const cprox_target *target = &q->targets[c->target];
  const cprox_body *body = candidate_body(q, c);
  candidate_ball round = {0};
  *sizes = 0.0;
  if (body) {
    const cprox_pose pose = candidate_pose(q, c);
    const frame f = frame_create(&pose, vec(0, 0, 0));
    round.centre = frame_to_world(&f, body->ball_centre);
    round.radius = body->ball_radius;
    *sizes += vec_norm(body->ball_centre) + vec_norm(pose.position);
  }
  if (target->curve) {
    const candidate_ball run = ball_of_curve(target->curve);
    const frame f = frame_create(&target->pose, vec(0, 0, 0));
    round.centre = vec_add(round.centre, frame_to_world(&f, run.centre));
    round.radius += run.radius;
    *sizes += vec_norm(run.centre) + vec_norm(f.position) + round.radius;
  }
  return round;
}

/* The ball round what is carried, about the curve's point. */
static candidate_ball carried_ball(const question *q, const candidate *c) {
  cprox_pose pose;
  const cprox_body *body = candidate_carried(q, c, &pose);
  if (!body) return (candidate_ball){0};
  const frame f = frame_create(&pose, vec(0, 0, 0));
  return (candidate_ball){.centre = frame_to_world(&f, body->ball_centre), .radius = body->ball_radius};
}

/* The mover's capsule against the candidate's ball: never above the true distance. */
static double ball_bound(const question *q, const candidate *c) {
  double placing;
  const candidate_ball round = candidate_bounding_ball(q, c, &placing);
  if (!isfinite(round.radius)) return -INFINITY;
  const candidate_ball own = carried_ball(q, c);
  const vec3 centre = vec_sub(round.centre, own.centre);
  const curve_capsule *capsule = &q->reach;
  const double reach = capsule->radius + round.radius + own.radius + candidate_offset(q, c);
  /* rounding: the pose of the centre, the projection on the chord, the sums; doc/rounding.md */
  const double sizes =
      vec_norm(capsule->a) + vec_norm(capsule->b) + vec_norm(centre) + placing + 2.0 * vec_norm(own.centre) + reach;
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

static size_t parts_of(const cprox_body *body) {
  return body && body->kind == CPROX_COMPOUND ? body->n_parts : 1;
}

candidate *candidates_list(const question *q, size_t first, size_t last, size_t *count) {
  const size_t carried = parts_of(q->mover.body);
  size_t n = 0;
  for (size_t i = first; i < last; i++) n += parts_of(q->targets[i].body) * carried;
  candidate *list = workspace_reserve(q->workspace, WORKSPACE_ORDER, n * sizeof *list);
  if (!list) return NULL;
  size_t k = 0;
  for (size_t i = first; i < last; i++) {
    for (size_t pair = 0; pair < parts_of(q->targets[i].body) * carried; pair++) {
      list[k] =
          (candidate){.target = (int32_t)i, .part = (int32_t)(pair / carried), .mover_part = (int32_t)(pair % carried)};
      list[k].lower = ball_bound(q, &list[k]);
      k++;
    }
  }
  candidates_sort(list, n);
  *count = n;
  return list;
}
