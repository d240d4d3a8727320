/* SPDX-License-Identifier: BSD-3-Clause */
#include "narrowphase/formula.h"

#include "base/frame.h"
#include "base/rounding.h"
#include "convex/feature.h"
#include "shape/body.h"

/* ---- two segments with margins ---- */

/* The core of a point, a ball or a capsule: s along for s in [-half, half], about its own position. */
typedef struct segment {
  vec3 along;
  double half, margin;
  double turned; /* what the axis may be off, in units of u */
} segment;

static bool is_ball(const cprox_body *body) {
  return body->kind == CPROX_BODY_POINT || body->kind == CPROX_BODY_SPHERE;
}

static segment segment_of(const cprox_obstacle *obstacle) {
  const cprox_body *body = obstacle->body;
  segment s = {.along = {0, 0, 1}, .margin = body->shape.margin + obstacle->margin};
  if (is_ball(body)) return s;
  s.half = body->shape.size[1];
  const cprox_quat q = obstacle->pose.orientation;
  if (q.x == 0.0 && q.y == 0.0) return s; /* a turn about z leaves the axis as it is */
  const double scale = 2.0 / (q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z); /* as in frame_create() */
  const double xs = q.x * scale, ys = q.y * scale;
  s.along = vec(xs * q.z + q.w * ys, ys * q.z - q.w * xs, 1.0 - (xs * q.x + ys * q.y));
  s.turned = ROUND_ROTATION;
  return s;
}

static double clamped(double x, double most) {
  return x < -most ? -most : x > most ? most : x;
}

/* Where the two are nearest: from the common normal of their lines on to each other's nearest point. */
static void nearest_of_segments(const segment *a, const segment *b, vec3 apart, double *on_a, double *on_b) {
  const double cosine = vec_dot(a->along, b->along), d = vec_dot(a->along, apart), e = vec_dot(b->along, apart);
  const double sine2 = 1.0 - cosine * cosine;
  double s = sine2 > 0.0 ? clamped((d - cosine * e) / sine2, a->half) : 0.0, t;
  for (int turn = 0; turn < 2; turn++) {
    t = clamped(cosine * s - e, b->half);
    s = clamped(cosine * t + d, a->half);
  }
  *on_a = s, *on_b = t;
}

/* w, the difference of the nearest points, is all rounding where they are close: the axes on whose insides they lie
 * tell what it is across. */
static vec3 direction_of(const segment *a, double s, const segment *b, double t, vec3 w, double sizes) {
  const bool in_a = fabs(s) < a->half, in_b = fabs(t) < b->half;
  vec3 across = w, u;
  if (in_a && in_b) {
    const vec3 c = vec_cross(a->along, b->along);
    if (vec_norm2(c) * (sizes * sizes) > vec_norm2(w)) across = vec_dot(c, w) < 0.0 ? vec_neg(c) : c;
  } else if (in_a || in_b) {
    const vec3 e = in_a ? a->along : b->along;
    across = vec_axpy(w, -vec_dot(w, e), e);
    across = vec_axpy(across, -vec_dot(across, e), e);
  }
  feature_unit(across, &u);
  return u;
}

/* The points from above, the plane across the line between them from below. `apart` from a to b. */
static bool segments(const segment *a, const segment *b, vec3 position, vec3 apart, pair_answer *answer) {
  const double far = vec_norm(apart), margins = a->margin + b->margin, halves = a->half + b->half;
  double s = 0.0, t = 0.0;
  if (halves > 0.0) nearest_of_segments(a, b, apart, &s, &t);
  const vec3 x = vec_scale(s, a->along), y = vec_axpy(apart, t, b->along);
  vec3 u;
  const double distance = feature_unit(vec_sub(x, y), &u);
  double lower = distance;
  if (halves > 0.0) {
    u = direction_of(a, s, b, t, vec_sub(x, y), far + halves);
    if (!(vec_norm2(u) > 0.0)) return false;
    lower = lesser(-vec_dot(u, apart) - a->half * fabs(vec_dot(u, a->along)) - b->half * fabs(vec_dot(u, b->along)),
                   distance);
  } else if (!(distance > 0.0)) {
    u = vec(1, 0, 0); /* balls about one point: one direction is as good as another */
  }

  /* doc/convex-pairs.md counts them */
  const double turned = a->turned * a->half + b->turned * b->half;
  const double rounding = ROUND_UP * ROUND_U * (12.0 * (far + halves) + turned + 3.0 * margins);
  if (distance - lower > rounding) return false; /* axes nearly parallel: where they are nearest is not well known */
  *answer = (pair_answer){.lower = lower - margins - rounding,
                          .upper = distance - margins + rounding,
                          .rounding = rounding,
                          .above = rounding,
                          .on_a = vec_add(position, vec_axpy(x, -a->margin, u)),
                          .on_b = vec_add(position, vec_axpy(y, b->margin, u)),
                          .common = vec_add(position, distance > b->margin ? vec_axpy(y, b->margin, u) : x),
                          .normal = u,
                          .steps = 1,
                          .supports = 1};
  return true;
}

/* ---- a ball and a shape with a closed form ---- */

static void ball_beside(const cprox_obstacle *obstacle, const cprox_obstacle *ball, bool swapped, pair_answer *answer) {
  const convex *shape = &obstacle->body->shape;
  const frame f = frame_create(&obstacle->pose, obstacle->body->centre);
  double error = 0.0;
  const vec3 y = frame_to_local(&f, ball->pose.position, &error);
  convex_near near;
  shape->ops->nearest(shape, y, NULL, &near);
  const double radius = ball->body->shape.margin + ball->margin;
  const double distance = near.distance - obstacle->margin - radius;
  const double rounding =
      ROUND_UP * ROUND_U *
          (shape->ops->near_rounding * (vec_norm(y) + shape->scale) + 4.0 * (obstacle->margin + radius)) +
      error;
  const vec3 on_shape = frame_to_world(&f, vec_axpy(near.point, obstacle->margin, near.normal));
  const vec3 n = frame_turn_to_world(&f, near.normal);
  const vec3 on_ball = vec_axpy(ball->pose.position, -radius, n);
  *answer = (pair_answer){.lower = distance - rounding,
                          .upper = distance + rounding,
                          .rounding = rounding,
                          .above = rounding,
                          .on_a = swapped ? on_ball : on_shape,
                          .on_b = swapped ? on_shape : on_ball,
                          .common = near.distance > obstacle->margin ? on_shape : ball->pose.position,
                          .normal = swapped ? n : vec_neg(n),
                          .steps = 1,
                          .supports = 1};
}

/* ---- by the kinds ---- */

typedef enum formula_kind { FORMULA_NONE, FORMULA_SEGMENT, FORMULA_SURFACE } formula_kind;

static formula_kind kind_of(const cprox_body *body) {
  switch (body->kind) {
    case CPROX_BODY_POINT: return vec_norm2(body->centre) > 0.0 ? FORMULA_NONE : FORMULA_SEGMENT;
    case CPROX_BODY_SPHERE:
    case CPROX_BODY_CAPSULE: return FORMULA_SEGMENT;
    case CPROX_BODY_BOX:
    case CPROX_BODY_CYLINDER:
    case CPROX_BODY_CONE:
    case CPROX_BODY_ELLIPSOID:
    case CPROX_BODY_POLYGON: return FORMULA_SURFACE;
    default: return FORMULA_NONE;
  }
}

bool pair_by_formula(const cprox_obstacle *a, const cprox_obstacle *b, pair_answer *answer) {
  const formula_kind x = kind_of(a->body), y = kind_of(b->body);
  if (x == FORMULA_SEGMENT && y == FORMULA_SEGMENT) {
    const segment sa = segment_of(a), sb = segment_of(b);
    return segments(&sa, &sb, a->pose.position, vec_sub(b->pose.position, a->pose.position), answer);
  }
  const bool swapped = x == FORMULA_SEGMENT;
  if (x == FORMULA_NONE || y == FORMULA_NONE || x == y || !is_ball((swapped ? a : b)->body)) return false;
  ball_beside(swapped ? b : a, swapped ? a : b, swapped, answer);
  return true;
}
