/* SPDX-License-Identifier: BSD-3-Clause */
#include "narrowphase/convex_mesh.h"

#include "base/rotation.h"
#include "base/rounding.h"
#include "bvh/bvh.h"
#include "bvh/winding.h"

/* One search through the elements, nearest first. */
typedef struct search {
  const pair_side *elements, *convex_side;
  const pair_placement *place;
  pair_goal goal; /* of all of them; */
  pair_goal
      each; /* an element is measured more exactly: what a loose upper end costs in elements is more than that saves */
  pair_answer best;
  double lower;
} search;

/* What an element may leave of what all of them may. */
static const double FINER = 1.0 / 16.0;

static double margins(const search *s) {
  return s->elements->margin + s->convex_side->margin;
}

/* More than any depth can be: to move one out of the other altogether. */
static double deepest(const search *s) {
  return 2.0 * (s->elements->body->tree->scale + s->convex_side->shape->scale) + margins(s);
}

static double rounding_of(const search *s) {
  const double sizes =
      vec_norm(s->place->t) + s->elements->body->tree->scale + s->convex_side->shape->scale + margins(s);
  return ROUND_UP * (s->place->error + 2.0 * TREE_ROUND * ROUND_U * sizes + s->convex_side->shape->slack);
}

static void overlap(const search *s, vec3 common, pair_answer *answer) {
  answer->overlap = true;
  answer->upper = 0.0;
  answer->lower = -deepest(s);
  answer->on_a = answer->on_b = answer->common = common;
  answer->normal = vec(0, 0, 0);
}

/* ---- one element ---- */

vec3 convex_mesh_element_shape(const tree *t, tree_place at, double vertices[3][TREE_LANES], convex *shape) {
  vec3 v[3], centre;
  const int n = tree_corners(t, at, v);
  *shape = (convex){.ops = &convex_point, .scale = 1e-100};
  if (n == 1) return v[0];
  if (n == 2) {
    const vec3 half = vec_axpy(vec_scale(0.5, v[1]), -0.5, v[0]);
    centre = vec_axpy(vec_scale(0.5, v[0]), 0.5, v[1]);
    *shape = (convex){.ops = &convex_box, .size = {half.x, half.y, half.z}, .scale = vec_norm(half) + 1e-100};
    return centre;
  }
  centre = vec_scale(1.0 / 3.0, vec_add(v[0], vec_add(v[1], v[2])));
  *shape = (convex){
      .ops = &convex_polytope, .n = 3, .padded = TREE_LANES, .x = vertices[0], .y = vertices[1], .z = vertices[2]};
  for (int l = 0; l < TREE_LANES; l++) {
    const vec3 w = vec_sub(v[l < 3 ? l : 2], centre);
    vertices[0][l] = w.x, vertices[1][l] = w.y, vertices[2][l] = w.z;
    shape->scale = fmax(shape->scale, vec_norm(w));
  }
  shape->scale += 1e-100;
  return centre;
}

static void visit(tree_seeker *seeker, tree_place at, uint32_t element) {
  search *s = seeker->self;
  (void)element;
  convex shape;
  double vertices[3][TREE_LANES];
  const vec3 centre = convex_mesh_element_shape(s->elements->body->tree, at, vertices, &shape);
  pair_placement place = *s->place;
  place.t = vec_sub(place.t, centre);
  place.error += ROUND_UP * ROUND_U * (vec_norm(place.t) + 2.0 * vec_norm(centre) + 2.0 * shape.scale);
  pair_answer answer;
  pair_separate(&shape, s->elements->margin, s->convex_side->shape, s->convex_side->margin, &place, &s->each, &answer);
  s->best.steps += answer.steps;
  s->best.supports += answer.supports;
  s->best.support_failed = s->best.support_failed || answer.support_failed;
  s->best.exhausted = s->best.exhausted || answer.exhausted;
  if (answer.support_failed) return;
  s->lower = fmin(s->lower, answer.lower);
  if (answer.overlap || answer.upper < s->best.upper) {
    const pair_answer before = s->best;
    s->best = answer;
    s->best.steps = before.steps, s->best.supports = before.supports, s->best.exhausted = before.exhausted;
    s->best.on_a = vec_add(answer.on_a, centre);
    s->best.on_b = vec_add(answer.on_b, centre);
    s->best.common = vec_add(answer.common, centre);
  }
  if (answer.overlap) {
    seeker->bound = -INFINITY;
    return;
  }
  if (s->goal.verdict && s->best.upper <= s->goal.limit) {
    seeker->bound = -INFINITY;
    return;
  }
  const double relative = s->goal.relative_epsilon * fabs(s->best.upper) - 4.0 * rounding_of(s);
  const double width = fmax(s->goal.epsilon, relative);
  seeker->bound = fmin(seeker->bound, s->best.upper - width + margins(s));

  /* the shape lies behind the plane that separates it from this element */
  if (!(vec_norm2(answer.normal) > 0.5)) return;
  const vec3 n = vec_neg(answer.normal);
  const convex *k = s->convex_side->shape;
  const double reach = k->ops->support(k, rotate_back(s->place->r, answer.normal), NULL, NULL);
  seeker->known = true;
  seeker->normal = n;
  seeker->least = vec_dot(n, s->place->t) - reach;
}

/* ---- the ways to know ---- */

/* A ball: one point's nearest element. */
static void ball(search *s, pair_answer *answer) {
  const cprox_body *body = s->elements->body;
  const vec3 x = s->place->t;
  const tree_hit hit = tree_nearest(body->tree, x, INFINITY);
  tree_near near;
  tree_element_near(body->tree, hit.at, x, &near);
  const double rounding = rounding_of(s);
  *answer = (pair_answer){.steps = 1, .supports = 1, .rounding = rounding};
  answer->lower = hit.lower - margins(s) - rounding;
  answer->upper = near.distance - margins(s) + rounding;
  answer->normal = vec_neg(near.normal);
  answer->on_a = vec_axpy(near.point, s->elements->margin, near.normal);
  answer->on_b = vec_axpy(x, -s->convex_side->margin, near.normal);
  answer->common = near.distance > s->elements->margin ? answer->on_a : x;
  const bool in_box = body->tree->kind == TREE_BOXES && near.distance <= rounding;
  const bool in_solid = body->winding && hit.lower > rounding && winding_is_inside(body->winding, body->tree, x);
  if (in_box || in_solid) overlap(s, x, answer);
}

static void any_convex(search *s, pair_answer *answer) {
  const cprox_body *body = s->elements->body;
  const convex *k = s->convex_side->shape;
  tree_seeker seeker = {.centre = s->place->t, .radius = k->scale, .bound = INFINITY, .visit = visit, .self = s};
  s->best = (pair_answer){.upper = INFINITY};
  s->lower = INFINITY;
  /* what is farther than the limit does not matter to a verdict */
  if (s->goal.verdict) seeker.bound = ROUND_UP * (s->goal.limit + margins(s) + 4.0 * rounding_of(s));
  tree_seek(body->tree, &seeker);
  *answer = s->best;
  if (answer->support_failed) return;
  if (answer->overlap) {
    overlap(s, s->best.common, answer);
    return;
  }
  const double rounding = rounding_of(s);
  answer->rounding = fmax(answer->rounding, rounding);
  answer->lower = fmin(s->lower, seeker.bound - margins(s) - rounding);

  /* clear of the surface: then all of it is inside of a solid, or none */
  vec3 at;
  if (!body->winding || !(answer->lower + margins(s) > rounding)) return;
  k->ops->support(k, vec(1, 0, 0), NULL, &at);
  const vec3 inner = vec_add(rotate(s->place->r, at), s->place->t);
  if (winding_is_inside(body->winding, body->tree, inner)) overlap(s, inner, answer);
}

void convex_mesh_measure(const pair_side *elements, const pair_side *convex_side, const pair_goal *goal,
                         pair_answer *answer) {
  const pair_placement place = relative_pose_make(elements, convex_side);
  search s = {.elements = elements, .convex_side = convex_side, .place = &place, .goal = *goal};
  s.goal.wants_depth = false;
  /* what is left over pays for the tree's own rounding */
  s.goal.epsilon = fmax(goal->epsilon - 2.0 * rounding_of(&s), 0.0);
  s.each = s.goal;
  s.each.epsilon *= FINER, s.each.relative_epsilon *= FINER;
  const cprox_body_kind kind = convex_side->shape->ops->kind;
  if (kind == CPROX_BODY_POINT || kind == CPROX_BODY_SPHERE)
    ball(&s, answer);
  else
    any_convex(&s, answer);
}
