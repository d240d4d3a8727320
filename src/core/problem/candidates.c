/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/candidates.h"

#include "base/frame.h"
#include "base/rounding.h"
#include "problem/level_of_detail.h"
#include "problem/minkowski.h"
#include "shape/body.h"

/* The model that is searched, and its pose in the frame of the target. */
typedef struct placed_model {
  const cprox_body *body; /* NULL: none */
  double excess;
  cprox_rung rung;
  bool moved;       /* false: the pose is the identity, */
  cprox_pose inner; /* and not set */
} placed_model;

/* Asked for often, and seldom more than the body itself. */
static inline void place_model(const cprox_body *body, int32_t part, cprox_rung finest, placed_model *m) {
  m->body = body;
  m->excess = 0.0;
  m->moved = false;
  m->rung = body && body->tree ? CPROX_RUNG_MESH : CPROX_RUNG_HULL;
  if (!body || model_is_body(body, finest)) return;
  const model is = model_of_part(body, (size_t)part, finest, &m->inner, &m->moved);
  m->body = is.body, m->excess = is.excess, m->rung = is.rung;
}

static inline void model_at(const question *q, const candidate *c, placed_model *m) {
  const cprox_target *target = &q->targets[c->target];
  const cprox_body *body = target->on_clock && !target->body ? &carried_point : target->body;
  place_model(body, c->part, c->rung != CPROX_RUNG_NONE ? c->rung : q->options.max_rung, m);
}

const cprox_body *candidate_body(const question *q, const candidate *c) {
  placed_model m;
  model_at(q, c, &m);
  return m.body;
}

cprox_rung candidate_rung(const question *q, const candidate *c) {
  placed_model m;
  model_at(q, c, &m);
  return m.rung;
}

/* Of what is carried past it, on the same rung. */
static inline void carried_model(const question *q, const candidate *c, placed_model *m) {
  place_model(q->mover.body, c->mover_part, q->mover.body ? candidate_rung(q, c) : CPROX_RUNG_HULL, m);
}

static cprox_pose clock_pose(const question *q, const candidate *c) {
  cprox_pose pose = q->targets[c->target].pose;
  if (q->targets[c->target].on_clock) pose.position = vec(0, 0, 0);
  return pose;
}

cprox_pose candidate_pose(const question *q, const candidate *c) {
  placed_model m;
  model_at(q, c, &m);
  const cprox_pose pose = clock_pose(q, c);
  return m.moved ? frame_compose(&pose, &m.inner) : pose;
}

double candidate_misplaced(const question *q, const candidate *c) {
  placed_model m, carried;
  model_at(q, c, &m);
  if (!m.moved || !m.body) return 0.0;
  carried_model(q, c, &carried);
  /* a turn of both shapes, and the sum of the positions */
  const double own = carried.body ? carried.body->shape.scale : 0.0;
  const double turned = vec_norm(m.inner.position) + vec_norm(m.body->centre) + m.body->shape.scale + own;
  const cprox_pose pose = candidate_pose(q, c);
  return ROUND_UP * ROUND_U * (2.0 * ROUND_ROTATION * turned + 3.0 * vec_norm(pose.position));
}

frame candidate_frame(const question *q, const candidate *c) {
  placed_model m;
  model_at(q, c, &m);
  const cprox_pose pose = clock_pose(q, c);
  const vec3 centre = m.body ? m.body->centre : vec(0, 0, 0);
  return m.moved ? frame_create_within(&pose, &m.inner, centre) : frame_create(&pose, centre);
}

double candidate_padding(const question *q, const candidate *c) {
  placed_model m;
  model_at(q, c, &m);
  return q->targets[c->target].padding + m.excess;
}

double candidate_offset(const question *q, const candidate *c) {
  placed_model m;
  carried_model(q, c, &m);
  return q->mover.radius + m.excess + candidate_padding(q, c);
}

const cprox_body *candidate_carried(const question *q, const candidate *c, cprox_pose *pose) {
  placed_model m;
  carried_model(q, c, &m);
  *pose = m.moved ? m.inner : cprox_pose_identity();
  return m.body;
}

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
  const curve_capsule *capsule = &curve->whole;
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
    *sizes += size_of(body->ball_centre) + size_of(pose.position);
    /* a compound's part: what the two positions lose may be more than their sum, which is small where they cancel */
    if (target->body && target->body->kind == CPROX_COMPOUND)
      *sizes += size_of(target->body->parts[c->part].pose.position);
  }
  if (target->curve) {
    const candidate_ball run = ball_of_curve(target->curve);
    const frame f = frame_create(&target->pose, vec(0, 0, 0));
    round.centre = vec_add(round.centre, frame_to_world(&f, run.centre));
    round.radius += run.radius;
    *sizes += size_of(run.centre) + size_of(f.position) + round.radius;
  }
  return round;
}

/* The ball round what is carried, about the curve's point. */
static candidate_ball carried_ball(const question *q, const candidate *c) {
  cprox_pose pose;
  const cprox_body *body = q->mover.body ? candidate_carried(q, c, &pose) : NULL;
  if (!body) return (candidate_ball){0};
  const frame f = frame_create(&pose, vec(0, 0, 0));
  return (candidate_ball){.centre = frame_to_world(&f, body->ball_centre), .radius = body->ball_radius};
}

/* The mover's capsule against the candidate's ball. */
double candidate_ball_bound(const question *q, const candidate *c) {
  double placing;
  const candidate_ball round = candidate_bounding_ball(q, c, &placing);
  if (!isfinite(round.radius)) return -INFINITY;
  const candidate_ball own = carried_ball(q, c);
  const vec3 centre = vec_sub(round.centre, own.centre);
  const curve_capsule *capsule = &q->reach;
  const double reach = capsule->radius + round.radius + own.radius + candidate_offset(q, c);
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

static size_t parts_of(const cprox_body *body) {
  return body && body->kind == CPROX_COMPOUND ? body->n_parts : 1;
}

candidate *candidates_list(const question *q, size_t first, size_t last, bool ranked, size_t *count) {
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
      list[k].lower = ranked || n > 1 ? candidate_ball_bound(q, &list[k]) : -INFINITY;
      k++;
    }
  }
  candidates_sort(list, n);
  *count = n;
  return list;
}
