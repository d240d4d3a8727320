/* SPDX-License-Identifier: BSD-3-Clause */
/* The claim that somewhere the distance is at most delta: the parameter, and a point of the obstacle that is near
 * enough. The checker looks at the exact points, so the one named here is drawn in by more than the rounding of
 * both. */
#include "base/rounding.h"
#include "bvh/winding.h"
#include "certificate/partition.h"
#include "convex/gjk.h"
#include "implicit/implicit.h"
#include "shape/kinds.h"

/* Room for the rounding of points, of their turns, and of nearest points: near_rounding is at most 64. */
#define ROOM 160.0

/* The mover's point in the frame of the set, and how far the exact one may be from it. */
static vec3 local_point(const cover *c, const frame *f, vec3 world, double *error) {
  double turned = 0.0;
  const vec3 y = frame_to_local(f, world, &turned);
  const double n = (double)c->curve->degree;
  *error = turned + curve_error(c->curve) + (6.0 * n + 20.0) * ROUND_U * vec_norm(world);
  return y;
}

bool partition_draw_in(const cprox_body *body, const convex_near *near, double by, vec3 *drawn) {
  const body_kind *kind = body_kind_of(body->kind);
  const double inner = kind->inner_radius     ? kind->inner_radius(&body->shape)
                       : body->shape.implicit ? body->shape.implicit->inner
                                              : 0.0;
  if (!(by < 0.5 * inner)) return false;
  *drawn = vec_scale(1.0 - by / inner, near->point);
  return true;
}

/* The radius of a ball about 0 that lies in the tetrahedron of the vertices; not above 0 where there is none. */
static double ball_in(const simplex *s) {
  if (s->n < 4) return 0.0;
  double radius = INFINITY;
  for (int i = 0; i < 4; i++) {
    const vec3 a = s->vertex[(i + 1) % 4].w, b = s->vertex[(i + 2) % 4].w, c = s->vertex[(i + 3) % 4].w;
    const vec3 n = vec_cross(vec_sub(b, a), vec_sub(c, a));
    const double opposite = vec_dot(n, vec_sub(s->vertex[i].w, a)), size = vec_norm(n);
    if (!(fabs(opposite) > 0.0)) return 0.0;
    radius = fmin(radius, copysign(1.0, opposite) * -vec_dot(n, a) / size);
  }
  return radius;
}

/* How far the mean of the vertices by their weights is from 0. */
static double mean_length(const simplex *s) {
  vec3 mean = vec(0, 0, 0);
  for (int i = 0; i < s->n; i++) mean = vec_axpy(mean, s->weight[i], s->vertex[i].w);
  return vec_norm(mean);
}

static void write_vertex(cprox_certificate *c, const simplex *s, int i, bool inside) {
  const bool used = i < s->n;
  certificate_count(c, used ? (uint32_t)s->vertex[i].id : (uint32_t)s->vertex[0].id);
  certificate_number(c, used && !inside ? s->weight[i] : 0.0);
}

double partition_near_point(const cprox_body *body, cprox_certificate *certificate, vec3 y, double error) {
  const convex *shape = &body->shape;
  const cprox_body_kind kind = body->kind;
  convex_hint hint = {0};
  if (kind == CPROX_BODY_POINT) return vec_norm(y) + error;
  if (kind == CPROX_BODY_POLYTOPE || kind == CPROX_BODY_POLYGON) {
    gjk_answer answer;
    gjk_nearest(shape, y, &hint, &answer);
    /* where y lies on a face of the tetrahedron, no program with errors of its own finds y inside: its mean is near */
    const bool inside = ball_in(&answer.feature) > 4.0 * error + ROOM * ROUND_U * (vec_norm(y) + shape->scale);
    for (int i = 0; i < 4; i++) write_vertex(certificate, &answer.feature, i, inside);
    return inside ? 0.0 : fmax(answer.distance, mean_length(&answer.feature)) + error;
  }

  convex_near near;
  shape->ops->nearest(shape, y, &hint, &near);
  vec3 v = vec(0, 0, 0);
  if (near.distance > -error) {
    const double drawn = error + ROOM * ROUND_U * (vec_norm(y) + shape->scale);
    vec3 x;
    if (kind == CPROX_BODY_HALFSPACE)
      v = vec_scale(near.distance + drawn, near.normal);
    else if (partition_draw_in(body, &near, drawn, &x))
      v = vec_sub(y, x);
    else
      return INFINITY;
  }
  certificate_vector(certificate, v);
  return vec_norm(v);
}

vec3 partition_point_of(const cprox_body *body, cprox_certificate *c, vec3 y) {
  const convex *shape = &body->shape;
  convex_hint hint = {0};
  if (body->kind == CPROX_BODY_POINT) return vec(0, 0, 0);
  if (body->kind == CPROX_BODY_POLYTOPE || body->kind == CPROX_BODY_POLYGON) {
    gjk_answer answer;
    gjk_nearest(shape, y, &hint, &answer);
    vec3 mean = vec(0, 0, 0);
    double sum = 0.0;
    for (int i = 0; i < 4; i++) {
      const bool used = i < answer.feature.n;
      const int32_t id = answer.feature.vertex[used ? i : 0].id;
      const double weight = used ? answer.feature.weight[i] : 0.0;
      certificate_count(c, (uint32_t)id);
      certificate_number(c, weight);
      mean = vec_axpy(mean, weight, vec(shape->x[id], shape->y[id], shape->z[id]));
      sum += weight;
    }
    return vec_scale(1.0 / sum, mean);
  }
  convex_near near;
  shape->ops->nearest(shape, y, &hint, &near);
  const double drawn = ROOM * ROUND_U * (vec_norm(y) + shape->scale);
  vec3 x = y;
  if (near.distance >= -drawn && !partition_draw_in(body, &near, drawn, &x)) return vec(NAN, NAN, NAN);
  certificate_vector(c, x);
  return x;
}

double partition_near_element(const cprox_body *body, const uint32_t *first, cprox_certificate *certificate, vec3 y,
                              double error) {
  const tree *t = body->tree;
  if (body->winding && winding_side_of(body->winding, t, y, error) == WINDING_INSIDE) {
    certificate_count(certificate, UINT32_MAX);
    return 0.0;
  }
  const tree_place at = tree_nearest(t, y, INFINITY).at;
  element_body one;
  elements_one(&one, t, at);
  certificate_count(certificate, first[at.pack] + elements_lane(t, at));
  return partition_near_point(&one.body, certificate, y, error);
}

/* The same with an order that has to be found. */
static double near_element(const cover *c, vec3 y, double error) {
  const tree *t = c->set.body->tree;
  uint32_t *first = workspace_reserve(c->workspace, WORKSPACE_COVER_ELEMENTS, t->n_packs * sizeof *first);
  if (!first) return INFINITY;
  elements_order(t, first);
  return partition_near_element(c->set.body, first, c->certificate, y, error);
}

/* The point of a curve at its counting parameter; where two pieces meet that do not join, the one that is nearer to
 * `by`. */
static vec3 point_by(const cprox_curve *curve, double sigma, vec3 by) {
  const vec3 right = partition_point(curve, sigma);
  if (sigma != floor(sigma) || sigma < 1.0) return right;
  const vec3 left = curve_piece(curve, (size_t)sigma - 1)[curve->degree];
  return vec_norm2(vec_sub(left, by)) < vec_norm2(vec_sub(right, by)) ? left : right;
}

/* The point of what is carried that is nearest to the answer's, added to a point of the curve. */
static vec3 add_carried(const cover *c, const cprox_result *answer, vec3 carrier, double radius, vec3 world) {
  if (!c->carried.body) return world;
  const cprox_body *body = c->carried.body;
  const frame f = frame_create(c->carried.poses > 0 ? c->carried.pose[0] : &CPROX_POSE_IDENTITY, body->centre);
  double error = 0.0;
  const double out = answer->upper > 0.0 ? radius : 0.0;
  const vec3 core = vec_axpy(answer->witness_mover, out, answer->normal);
  const vec3 x = partition_point_of(body, c->certificate, frame_to_local(&f, vec_sub(core, carrier), &error));
  return vec_add(world, frame_to_world(&f, x));
}

cprox_status cover_near(const cover *c, uint32_t section, const cprox_result *answer, vec3 carrier, double radius) {
  certificate_count(c->certificate, section);
  certificate_number(c->certificate, answer->t);
  const bool moved = c->carried.body || c->curve == &c->made[0];
  const vec3 bare =
      moved ? partition_point(c->curve, c->witness) : point_by(c->curve, c->witness, answer->witness_mover);
  const vec3 world = add_carried(c, answer, carrier, radius, bare);
  if (!vec_finite(world)) return CPROX_PRECISION;

  double apart, error, size;
  if (c->set.curve) {
    const frame f = frame_create(&c->pose, vec(0, 0, 0));
    const vec3 y = local_point(c, &f, world, &error);
    const vec3 seen = frame_to_local(&f, answer->witness_obstacle, &error);
    const vec3 z = point_by(c->set.curve, c->witness_on_set, seen);
    const double n = (double)c->set.curve->degree;
    error += curve_error(c->set.curve) + (6.0 * n + 20.0) * ROUND_U * vec_norm(z);
    certificate_number(c->certificate, answer->t_obstacle);
    apart = vec_norm(vec_sub(y, z)) + error;
    size = vec_norm(y);
  } else {
    const frame f = frame_create(&c->pose, c->set.body->centre);
    const vec3 y = local_point(c, &f, world, &error);
    if (c->carried.body) error += ROOM * ROUND_U * (vec_norm(carrier) + c->carried.body->shape.scale);
    apart = c->set.body->tree ? near_element(c, y, error) : partition_near_point(c->set.body, c->certificate, y, error);
    size = vec_norm(y) + c->set.body->shape.scale;
  }

  /* a claim that is too tight is lifted by what rounding may have cost */
  double balls = c->set.offset;
  if (c->radius) { /* as little as it can be */
    const double unsure = curve_error(c->radius) + 64.0 * ROUND_U * (balls + c->radius->largest);
    balls += partition_point(c->radius, c->witness).x - unsure;
    error += unsure;
  }
  const double room = error + ROOM * ROUND_U * (size + balls + c->delta);
  const double needed = apart > 0.0 ? apart * (1.0 + 16.0 * ROUND_U) - balls : 0.0;
  if (needed > c->delta - room && apart > 0.0) {
    if (!(needed <= c->delta + 16.0 * room)) return CPROX_PRECISION;
    certificate_restate(c->certificate, fmax(c->delta, needed + room));
  }
  return c->certificate->failed ? CPROX_MEMORY : CPROX_OK;
}
