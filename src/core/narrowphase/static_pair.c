/* SPDX-License-Identifier: BSD-3-Clause */
/* Static pairs: every pair of convex parts by the cheapest way that knows it exactly, the nearest wins. */
#include "convex/pair.h"

#include "base/rotation.h"
#include "base/rounding.h"
#include "base/workspace.h"
#include "convex/feature.h"
#include "curve_proximity/cprox/query.h"
#include "implicit/implicit.h"
#include "narrowphase/convex_mesh.h"
#include "narrowphase/formula.h"
#include "narrowphase/mesh_mesh.h"
#include "narrowphase/relative_pose.h"
#include "narrowphase/witness.h"
#include "problem/validate.h"
#include "shape/body.h"

/* What a pair of convex shapes answers, in the world. */
typedef struct pair_reply {
  pair_answer answer; /* points and normal in the world */
  int32_t part;       /* of b */
  cprox_lod lod;
} pair_reply;

/* Where a former search of the pair ended, in the world. */
typedef struct pair_known {
  vec3 on_a, on_b, normal;
  double distance;
  pair_vertices vertices;
} pair_known;

/* ---- arguments ---- */

/* Whether an obstacle is usable, without the reason. Numbers that are none fail each comparison. */
static bool pair_takes(const cprox_obstacle *obstacle) {
  const vec3 p = obstacle->pose.position;
  const cprox_quat q = obstacle->pose.orientation;
  const double norm2 = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
  return !obstacle->curve && obstacle->body && !obstacle->body->field && fabs(p.x) <= LENGTH_MOST &&
         fabs(p.y) <= LENGTH_MOST && fabs(p.z) <= LENGTH_MOST && norm2 >= 1e-200 && norm2 <= 1e200 &&
         obstacle->margin >= 0.0 && obstacle->margin <= LENGTH_MOST && body_is_in_reach(obstacle->body);
}

static cprox_status pair_check_obstacle(const char *name, const cprox_obstacle *obstacle, cprox_workspace *workspace) {
  if (pair_takes(obstacle)) return CPROX_OK;
  if (obstacle->curve) return workspace_fail(workspace, CPROX_INVALID, "%s is a curve: a pair is of two bodies", name);
  if (!obstacle->body) return workspace_fail(workspace, CPROX_INVALID, "%s: the body is NULL", name);
  if (obstacle->body->field)
    return workspace_fail(workspace, CPROX_INVALID,
                          "%s is known by its distance alone: ask for the distance of a curve, or cprox_body_nearest()",
                          name);
  const char *support_failed = frame_pose_error(&obstacle->pose);
  if (support_failed) return workspace_fail(workspace, CPROX_INVALID, "%s: %s", name, support_failed);
  if (!(obstacle->margin >= 0.0) || !isfinite(obstacle->margin))
    return workspace_fail(workspace, CPROX_INVALID, "%s: margin is %g, must be >= 0 and finite", name,
                          obstacle->margin);
  if (obstacle->margin > LENGTH_MOST)
    return workspace_fail(workspace, CPROX_INVALID, "%s: margin is %g, must be at most %g", name, obstacle->margin,
                          LENGTH_MOST);
  if (!body_is_in_reach(obstacle->body))
    return workspace_fail(workspace, CPROX_INVALID, "%s: the body reaches farther than %g m", name, LENGTH_MOST);
  return CPROX_OK;
}

/* ---- placing ---- */

static vec3 pair_to_world(const pair_side *a, vec3 p) {
  return frame_to_world(&a->f, p);
}

/* ---- ways to know ---- */

/* A halfspace (a) knows the exact signed distance of everything by one support value. */
static void pair_halfspace(const pair_side *a, const pair_side *b, const pair_placement *place, pair_answer *answer) {
  const convex *h = a->shape;
  const vec3 n = vec(h->size[0], h->size[1], h->size[2]);
  const vec3 down = vec_neg(rotate_back(place->r, n));
  vec3 at;
  *answer = (pair_answer){.steps = 1, .supports = 1};
  const double lowest = -b->shape->ops->support(b->shape, down, NULL, &at);
  answer->support_failed = isnan(lowest);

  const double height = vec_dot(n, place->t) + h->size[3];
  const double distance = height + lowest - a->margin - b->margin;
  answer->rounding =
      ROUND_UP * (32.0 * ROUND_U * (vec_norm(place->t) + fabs(h->size[3]) + b->shape->scale + a->margin + b->margin) +
                  place->error + 2.0 * b->shape->slack);
  answer->above = answer->rounding - ROUND_UP * 2.0 * (b->shape->slack - b->shape->outside);
  answer->lower = distance - answer->rounding;

  /* the lowest point, drawn into the body */
  const double reached = b->shape->drawn > 0.0 ? -vec_dot(down, convex_drawn(b->shape, at)) - lowest : 0.0;
  answer->upper = distance + reached + answer->above;
  answer->on_b = answer->common =
      vec_axpy(vec_add(rotate(place->r, convex_drawn(b->shape, at)), place->t), -b->margin, n);
  answer->on_a = vec_axpy(answer->on_b, -(distance + reached), n);
  answer->normal = vec_neg(n);
}

static bool is_ball(const convex *shape) {
  return shape->ops->kind == CPROX_BODY_POINT || shape->ops->kind == CPROX_BODY_SPHERE;
}

/* A ball (b) against a shape with a closed form: exact on both sides of the surface. */
static void pair_ball(const pair_side *a, const pair_side *b, const pair_placement *place, pair_answer *answer) {
  convex_near near;
  a->shape->ops->nearest(a->shape, place->t, NULL, &near);
  *answer = (pair_answer){.steps = 1, .supports = 1};
  const double margin = a->margin - a->shape->margin; /* near has the shape's own in it */
  const double distance = near.distance - margin - b->margin;
  answer->rounding = ROUND_UP * (ROUND_U * (a->shape->ops->near_rounding * (vec_norm(place->t) + a->shape->scale) +
                                            4.0 * (a->margin + b->margin)) +
                                 place->error);
  answer->lower = distance - answer->rounding;
  answer->upper = distance + answer->rounding;
  answer->on_a = vec_axpy(near.point, margin, near.normal);
  answer->on_b = vec_axpy(place->t, -b->margin, near.normal);
  answer->common = near.distance > margin ? answer->on_a : place->t;
  answer->normal = vec_neg(near.normal);
}

static void pair_swap(pair_answer *answer) {
  const vec3 on_a = answer->on_a;
  answer->on_a = answer->on_b;
  answer->on_b = on_a;
  answer->normal = vec_neg(answer->normal);
}

static bool is_implicit(const convex *shape) {
  return shape->implicit != NULL;
}

/* Takes over what a search of two implicit cores found: their margins and the pose's error on top. */
static void pair_take(const implicit_answer *found, const pair_side *a, const pair_side *b, const pair_placement *place,
                      double rounding, pair_answer *answer) {
  const double margins = a->margin + b->margin;
  answer->overlap = found->overlap;
  answer->shift = found->overlap ? 0.0 : greater(found->lower, 0.0);
  answer->lower = found->lower - margins - rounding;
  answer->rounding = answer->above = rounding;
  if (found->overlap) {
    answer->upper = found->upper - margins;
    answer->normal = vec(0, 0, 0);
    answer->common = answer->on_a = answer->on_b = found->x;
    return;
  }
  const vec3 x = convex_drawn(a->shape, found->x), y = convex_drawn(b->shape, found->y);
  const vec3 on_b = vec_add(rotate(place->r, y), place->t);
  const double sizes = a->shape->scale + b->shape->scale + vec_norm(place->t) + margins;
  answer->upper = vec_norm(vec_sub(x, on_b)) - margins + rounding + ROUND_UP * ROUND_WITNESS * ROUND_U * sizes;
  answer->normal = found->normal;
  /* where the margins overlap: as far from x towards y as a's own margin reaches */
  const vec3 between = vec_sub(on_b, x);
  const double apart = vec_norm(between);
  answer->common = a->margin < apart ? vec_axpy(x, a->margin / apart, between) : on_b;
  answer->on_a = vec_axpy(x, -a->margin, answer->normal);
  answer->on_b = vec_axpy(on_b, b->margin, answer->normal);
}

/* Where a former answer lets the interior point method begin; the goal's start is its normal. */
static implicit_warm pair_warm(const pair_side *a, const pair_side *b, const pair_goal *goal, const pair_known *known) {
  if (!known || !(known->distance > 0.0)) return (implicit_warm){.usable = false};
  double error;
  return (implicit_warm){.usable = true,
                         .x = frame_to_local(&a->f, known->on_a, &error),
                         .y = frame_to_local(&b->f, known->on_b, &error),
                         .apart = vec_scale(known->distance, goal->start)};
}

/* Two implicit bodies: their support functions where that does not stall, else the interior point method. How deep they
 * overlap the search by supports says. False where memory is out. */
static bool pair_implicit(const pair_side *a, const pair_side *b, const pair_placement *place, const pair_goal *goal,
                          const pair_known *known, cprox_workspace *workspace, pair_answer *answer) {
  const implicit *x = a->shape->implicit, *y = b->shape->implicit;
  void *memory = workspace_reserve(workspace, WORKSPACE_INTERIOR, implicit_memory(x, y));
  if (!memory) return false;
  implicit_query query = {.a = x, .b = y, .t = place->t};
  for (int i = 0; i < 9; i++) query.m[i] = place->r[i];
  const double rounding = ROUND_UP * place->error, margins = a->margin + b->margin;
  const implicit_goal inner = {.epsilon = fmax(goal->epsilon - 2.0 * rounding, 0.0),
                               .relative_epsilon = margins > 0.0 ? 0.0 : goal->relative_epsilon,
                               .max_steps = goal->max_steps};
  implicit_answer found;
  uint32_t steps = 0;
  implicit_warm warm = pair_warm(a, b, goal, known);
  if (!x->closed || !y->closed || !implicit_separate(&query, &inner, &warm, &found)) {
    if (x->closed && y->closed) steps = found.steps;
    implicit_solve(&query, &inner, &warm, memory, &found);
  }
  if (found.overlap) {
    pair_separate(a->shape, a->margin, b->shape, b->margin, place, goal, answer);
    if (answer->overlap) return true;
  }
  *answer = (pair_answer){.steps = steps + found.steps, .exhausted = found.steps >= goal->max_steps};
  pair_take(&found, a, b, place, rounding, answer);
  return true;
}

static void pair_answer_to_world(const pair_side *a, pair_answer *answer) {
  answer->on_a = pair_to_world(a, answer->on_a);
  answer->on_b = pair_to_world(a, answer->on_b);
  answer->common = pair_to_world(a, answer->common);
  answer->normal = frame_turn_to_world(&a->f, answer->normal);
}

/* Two of many elements: the larger one is the first, so that the answer does not depend on their order. */
static bool pair_trees_swap(const pair_side *a, const pair_side *b) {
  const tree *x = a->body->tree, *y = b->body->tree;
  if (x->n != y->n) return x->n < y->n;
  if (x->kind != y->kind) return x->kind < y->kind;
  return x->scale != y->scale ? x->scale < y->scale : a->margin < b->margin;
}

/* One of the two is made of many elements. */
static cprox_status pair_with_elements(const pair_side *a, const pair_side *b, const pair_goal *goal,
                                       cprox_workspace *workspace, pair_answer *answer) {
  const bool many = a->body->tree && b->body->tree;
  const bool swapped = many ? pair_trees_swap(a, b) : !a->body->tree;
  const pair_side *first = swapped ? b : a, *second = swapped ? a : b;
  if (many) {
    if (!mesh_mesh_measure(first, second, goal, workspace, answer))
      return workspace_fail(workspace, CPROX_MEMORY, "no memory for a pair of meshes");
    answer->shift = 0.0;
    if (swapped) pair_swap(answer);
    pair_answer_to_world(first, answer);
    return CPROX_OK;
  }
  if (second->shape->ops->kind == CPROX_BODY_HALFSPACE)
    return workspace_fail(workspace, CPROX_INVALID, "a halfspace has no distance to a mesh, points or boxes here");
  convex_mesh_measure(first, second, goal, answer);
  answer->shift = 0.0; /* another element may be as near */
  if (swapped) pair_swap(answer);
  pair_answer_to_world(first, answer);
  return CPROX_OK;
}

/* One pair of convex shapes. The special ways want their shape first: the frame of the answer is the first one's. */
static cprox_status pair_solve(const pair_side *a, const pair_side *b, const pair_goal *asked, const pair_known *known,
                               cprox_workspace *workspace, pair_answer *answer) {
  if (a->body->tree || b->body->tree) return pair_with_elements(a, b, asked, workspace, answer);
  const bool halfspace = b->shape->ops->kind == CPROX_BODY_HALFSPACE;
  const bool ball = is_ball(a->shape) && b->shape->ops->closed_form && !is_ball(b->shape);
  const bool swapped = halfspace || (ball && a->shape->ops->kind != CPROX_BODY_HALFSPACE);
  const pair_side *first = swapped ? b : a, *second = swapped ? a : b;
  const pair_placement place = relative_pose_make(first, second);
  pair_goal goal = *asked;
  /* the way out of an overlap tells nothing of a simplex that encloses 0 */
  if (known && (known->distance > 0.0 || known->vertices.n > 0)) {
    double error = 0.0;
    goal.start = frame_turn_to_local(&first->f, swapped ? vec_neg(known->normal) : known->normal);
    goal.placed = true;
    goal.place = frame_to_local(&first->f, swapped ? known->on_a : known->on_b, &error);
    if (!swapped && known->vertices.n > 0) goal.known = &known->vertices;
  }

  if (first->shape->ops->kind == CPROX_BODY_HALFSPACE)
    pair_halfspace(first, second, &place, answer);
  else if (is_ball(second->shape) && first->shape->ops->closed_form)
    pair_ball(first, second, &place, answer);
  else if (!workspace || !is_implicit(first->shape) || !is_implicit(second->shape))
    pair_separate(first->shape, first->margin, second->shape, second->margin, &place, &goal, answer);
  else if (!pair_implicit(first, second, &place, &goal, known, workspace, answer))
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for a pair of implicit bodies");

  /* pair_separate's normal is from b to a, the special ways' as well */
  if (swapped) pair_swap(answer);
  pair_answer_to_world(first, answer);
  return CPROX_OK;
}

cprox_status pair_witness_of(const cprox_obstacle *a, size_t part_a, const cprox_obstacle *b, size_t part_b,
                             cprox_lod finest, bool depth, cprox_workspace *workspace, pair_witness *witness) {
  const pair_side side_a = relative_pose_of_model(a, part_a, finest),
                  side_b = relative_pose_of_model(b, part_b, finest);
  const pair_goal goal = {.relative_epsilon = depth ? 1e-10 : 1e-13, .max_steps = 400, .wants_depth = depth};
  pair_answer answer = {.upper = INFINITY};
  const cprox_status status = pair_solve(&side_a, &side_b, &goal, NULL, workspace, &answer);
  if (status < 0) return status;
  *witness = (pair_witness){.on_a = answer.on_a, .on_b = answer.on_b, .normal = answer.normal};
  if (!depth && answer.upper <= answer.rounding) witness->on_a = witness->on_b = answer.common;
  return CPROX_OK;
}

/* ---- the query ---- */

/* What is asked of each pair of parts. */
typedef struct pair_task {
  const cprox_obstacle *a, *b;
  const pair_goal *goal;
  const pair_known *known; /* or NULL */
  cprox_lod finest;
  const cprox_options *options;
  cprox_workspace *workspace;
  uint32_t done; /* steps of the parts before */
} pair_task;

/* Parts i of a and j of b, by their finest models up to the level of detail. */
static cprox_status pair_of_models(const pair_task *task, size_t i, size_t j, cprox_lod finest, pair_reply *reply) {
  const pair_side a = relative_pose_of_model(task->a, i, finest), b = relative_pose_of_model(task->b, j, finest);
  if (!a.body->tree && !b.body->tree && a.shape->ops->kind == CPROX_BODY_HALFSPACE &&
      b.shape->ops->kind == CPROX_BODY_HALFSPACE)
    return workspace_fail(task->workspace, CPROX_INVALID, "two halfspaces have no distance");
  *reply = (pair_reply){.answer = {.upper = INFINITY}, .part = (int32_t)j};
  reply->lod = a.lod > b.lod ? a.lod : b.lod;
  pair_goal goal = *task->goal;
  goal.max_steps = task->done < goal.max_steps ? goal.max_steps - task->done : 1;
  const cprox_status status = pair_solve(&a, &b, &goal, task->known, task->workspace, &reply->answer);
  if (status) return status;
  if (!reply->answer.support_failed) return CPROX_OK;
  return workspace_fail(task->workspace, CPROX_INVALID, CONVEX_NO_SUPPORT);
}

static bool pair_has_lod(const pair_task *task, size_t i, size_t j) {
  const cprox_body *a = task->a->body, *b = task->b->body;
  return body_part_at(a, i)->kind == CPROX_BODY_LOD || body_part_at(b, j)->kind == CPROX_BODY_LOD;
}

static void pair_join(pair_reply *all, const pair_reply *one) {
  const double lower = fmin(all->answer.lower, one->answer.lower);
  const uint32_t steps = all->answer.steps + one->answer.steps, supports = all->answer.supports + one->answer.supports;
  const cprox_lod lod = all->lod > one->lod ? all->lod : one->lod;
  const bool exhausted = all->answer.exhausted || one->answer.exhausted;
  const bool stopped = all->answer.stopped || one->answer.stopped;
  if (one->answer.upper < all->answer.upper) *all = *one;
  all->answer.lower = lower, all->answer.steps = steps, all->answer.supports = supports, all->lod = lod;
  all->answer.exhausted = exhausted, all->answer.stopped = stopped;
}

/* What is farther apart than this need not be looked into: than the best so far, or than a verdict asks. */
static double pair_of_interest(const pair_task *task, const pair_reply *best) {
  return task->goal->verdict ? task->goal->limit : best->answer.upper;
}

/* Whether the hulls of two parts say that. */
static cprox_status pair_ends_at_hulls(const pair_task *task, size_t i, size_t j, pair_reply *best, bool *ends) {
  *ends = false;
  const double most = pair_of_interest(task, best);
  if (!pair_has_lod(task, i, j) || !isfinite(most) || task->finest < CPROX_LOD_MESH) return CPROX_OK;
  pair_reply one = {.part = 0};
  const cprox_status status = pair_of_models(task, i, j, CPROX_LOD_HULL, &one);
  if (status) return status;
  *ends = one.answer.lower > most;
  if (*ends && !isfinite(best->answer.upper)) best->answer.normal = one.answer.normal;
  one.answer.upper = INFINITY;
  if (!*ends) one.answer.lower = INFINITY;
  pair_join(best, &one);
  return CPROX_OK;
}

/* No two parts overlap deeper than the balls round both bodies could. */
static double pair_deepest(const pair_task *task) {
  const double balls = task->a->body->ball_radius + task->b->body->ball_radius;
  return ROUND_UP * (balls + task->a->margin + task->b->margin);
}

/* Two parts that overlap, one of them made of many elements: the way out of one of these may lead into another. So how
 * deep they are is not known; the balls round both and the hulls of meshes bound it. */
static cprox_status pair_bound_depth(const pair_task *task, size_t i, size_t j, pair_reply *reply) {
  pair_answer *answer = &reply->answer;
  const cprox_body *a = body_part_at(task->a->body, i), *b = body_part_at(task->b->body, j);
  const bool elements = lod_model_of(a, task->finest).body->tree || lod_model_of(b, task->finest).body->tree;
  if (!elements || !(answer->upper < 0.0 || answer->overlap)) return CPROX_OK;
  answer->overlap = true, answer->measured = false;
  answer->lower = fmin(answer->lower, -pair_deepest(task));
  if (!pair_has_lod(task, i, j) || task->finest < CPROX_LOD_MESH) return CPROX_OK;
  pair_reply hulls = {.part = 0};
  const cprox_status status = pair_of_models(task, i, j, CPROX_LOD_HULL, &hulls);
  if (status) return status;
  answer->lower = fmax(answer->lower, fmin(hulls.answer.lower, answer->upper));
  answer->steps += hulls.answer.steps, answer->supports += hulls.answer.supports;
  return CPROX_OK;
}

static bool pair_is_stopped(const pair_task *task) {
  return task->options->stop && task->options->stop(task->options->stop_user);
}

/* The nearest of all pairs of parts; its lower is the least of all their lower bounds. Stopped: the nearest of those
 * that were looked at. A verdict ends with a part that is proven to be near. */
static cprox_status pair_over_parts(pair_task *task, pair_reply *best) {
  *best = (pair_reply){.answer = {.lower = INFINITY, .upper = INFINITY}};
  for (size_t i = 0; i < body_n_parts(task->a->body); i++) {
    for (size_t j = 0; j < body_n_parts(task->b->body); j++) {
      bool ends;
      const bool decided = task->goal->verdict && best->answer.upper <= task->goal->limit;
      if (decided || (i + j > 0 && (best->answer.stopped || pair_is_stopped(task)))) {
        best->answer.stopped = !decided; /* of the other parts nothing is known */
        best->answer.lower = fmin(best->answer.lower, -pair_deepest(task));
        return CPROX_OK;
      }
      cprox_status status = pair_ends_at_hulls(task, i, j, best, &ends);
      if (status) return status;
      if (ends) continue;
      pair_reply one = {.part = 0};
      if ((status = pair_of_models(task, i, j, task->finest, &one))) return status;
      if (!task->goal->verdict && (status = pair_bound_depth(task, i, j, &one))) return status;
      pair_join(best, &one);
      task->done = best->answer.steps;
    }
  }
  return CPROX_OK;
}

/* By the two kinds where that is enough, else by a search. */
static cprox_status pair_of_bodies(pair_task *task, pair_reply *best) {
  if (task->finest != CPROX_LOD_SPHERE && pair_by_formula(task->a, task->b, &best->answer)) {
    best->part = 0;
    best->lod = CPROX_LOD_HULL;
    return CPROX_OK;
  }
  return pair_over_parts(task, best);
}

static cprox_status pair_status(const pair_answer *answer, const cprox_options *options) {
  const double width = answer->upper - answer->lower;
  if (width <= width_allowed(options->epsilon, options->relative_epsilon, answer->upper)) return CPROX_OK;
  if (answer->overlap && !answer->measured) return CPROX_OVERLAP;
  if (answer->stopped) return CPROX_STOPPED;
  return answer->exhausted ? CPROX_BUDGET : CPROX_PRECISION;
}

static bool pair_has_start(const cprox_options *options) {
  const cprox_pair_start *start = options->start;
  if (!start || !start->usable) return false;
  const double sizes = vec_norm(start->point_a) + vec_norm(start->point_b) + start->distance;
  return isfinite(sizes) && fabs(vec_norm(start->normal) - 1.0) < 1e-6;
}

/* Where both bodies stand, about their own origins. */
typedef struct pair_frames {
  frame a, b;
} pair_frames;

static pair_known pair_known_of(const pair_frames *f, const cprox_pair_start *start) {
  pair_known known = {.on_a = frame_to_world(&f->a, start->point_a),
                      .on_b = frame_to_world(&f->b, start->point_b),
                      .normal = frame_turn_to_world(&f->a, start->normal),
                      .distance = start->distance};
  const int32_t n = start->n_vertices;
  known.vertices.n = n > 0 && n <= 3 ? n : 0;
  for (int i = 0; i < known.vertices.n; i++)
    known.vertices.a[i] = start->vertices_a[i], known.vertices.b[i] = start->vertices_b[i];
  return known;
}

/* Leaves behind where the search ended. */
static void pair_leave(const cprox_obstacle *a, const cprox_obstacle *b, const pair_frames *f,
                       const pair_answer *answer, cprox_pair_start *start) {
  const vec3 n = answer->normal;
  double error = 0.0;
  *start = (cprox_pair_start){.usable = vec_norm2(n) > 0.0};
  if (!start->usable) return;
  start->normal = frame_turn_to_local(&f->a, n);
  start->point_a = frame_to_local(&f->a, vec_axpy(answer->on_a, a->margin, n), &error);
  start->point_b = frame_to_local(&f->b, vec_axpy(answer->on_b, -b->margin, n), &error);
  const double distance = vec_dot(vec_sub(answer->on_a, answer->on_b), n) + a->margin + b->margin;
  start->distance = answer->overlap ? 0.0 : fmax(distance, 0.0);
  const bool single = body_n_parts(a->body) == 1 && body_n_parts(b->body) == 1;
  start->shift = single ? answer->shift : 0.0;
  start->n_vertices = answer->vertices.n;
  for (int i = 0; i < answer->vertices.n; i++)
    start->vertices_a[i] = answer->vertices.a[i], start->vertices_b[i] = answer->vertices.b[i];
}

/* ---- the verdict ---- */

/* Where the ball round a part, or all of a body, stands. */
typedef struct pair_ball_at {
  vec3 centre;
  double radius, error;
} pair_ball_at;

static pair_ball_at ball_at(const cprox_obstacle *obstacle) {
  const cprox_body *body = obstacle->body;
  pair_ball_at ball = {.centre = body->ball_centre, .radius = body->ball_radius + obstacle->margin};
  const double reach2 = vec_norm2(body->ball_centre);
  if (!(reach2 > 0.0)) return ball;
  const frame f = frame_create(&obstacle->pose, vec(0, 0, 0));
  ball.centre = frame_turn_to_world(&f, body->ball_centre);
  ball.error = ROUND_ROTATION * sqrt(reach2);
  return ball;
}

/* The balls round both are farther apart than this, which may be below 0. Positions are subtracted first. */
static double balls_apart(const cprox_obstacle *a, const cprox_obstacle *b) {
  if (!isfinite(a->body->ball_radius) || !isfinite(b->body->ball_radius)) return -INFINITY;
  const pair_ball_at x = ball_at(a), y = ball_at(b);
  const vec3 apart = vec_sub(a->pose.position, b->pose.position);
  const double distance = vec_norm(vec_add(apart, vec_sub(x.centre, y.centre)));
  const double sizes = vec_norm(apart) + vec_norm(x.centre) + vec_norm(y.centre) + x.radius + y.radius;
  return distance - x.radius - y.radius - ROUND_UP * ROUND_U * (8.0 * sizes + x.error + y.error);
}

static cprox_result pair_verdict(const pair_reply *best, const pair_task *task, const cprox_options *options) {
  const double limit = task->goal->limit;
  const pair_answer *answer = &best->answer;
  const bool met = answer->upper <= 0.0, seen = isfinite(answer->upper);
  const vec3 nowhere = vec(NAN, NAN, NAN);
  cprox_result r = {.verdict = CPROX_VERDICT_UNDECIDED,
                    .lower = fmax(answer->lower, -pair_deepest(task)),
                    .upper = fmax(answer->upper, 0.0),
                    .t_obstacle = NAN,
                    .witness_mover = !seen ? nowhere
                                     : met ? answer->common
                                           : answer->on_a,
                    .witness_obstacle = !seen ? nowhere
                                        : met ? answer->common
                                              : answer->on_b,
                    .normal = met ? vec(0, 0, 0) : answer->normal,
                    .obstacle_index = seen ? 0 : -1,
                    .obstacle_part = best->part,
                    .lod = best->lod,
                    .nodes = answer->steps,
                    .distance_queries = answer->supports};
  if (r.lower > limit)
    r.verdict = CPROX_VERDICT_CLEAR;
  else if (r.upper <= limit)
    r.verdict = CPROX_VERDICT_VIOLATED;
  else
    r.status = pair_status(answer, options);
  return r;
}

cprox_status cprox_pair_tolerance(cprox_obstacle a, cprox_obstacle b, double delta, const cprox_options *options,
                                  cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  const cprox_options asked = validate_defaults(options);
  cprox_status status;
  if (!result) return workspace_fail(workspace, CPROX_INVALID, "result is NULL: nowhere to put the answer");
  const arguments_query kind = {"a pair's verdict", ARGUMENTS_SEARCH};
  if ((options && (status = validate_options(&asked, kind, workspace))) ||
      (status = validate_delta(delta, workspace)) || (status = pair_check_obstacle("a", &a, workspace)) ||
      (status = pair_check_obstacle("b", &b, workspace)))
    return status;

  const double apart = balls_apart(&a, &b);
  if (apart > delta) {
    const vec3 nowhere = vec(NAN, NAN, NAN);
    *result = (cprox_result){.verdict = CPROX_VERDICT_CLEAR,
                             .lower = apart,
                             .upper = INFINITY,
                             .t_obstacle = NAN,
                             .witness_mover = nowhere,
                             .witness_obstacle = nowhere,
                             .obstacle_index = -1,
                             .lod = CPROX_LOD_SPHERE};
    return CPROX_OK;
  }
  const pair_goal goal = {.epsilon = asked.epsilon,
                          .relative_epsilon = asked.relative_epsilon,
                          .verdict = true,
                          .limit = delta,
                          .max_steps = asked.max_nodes,
                          .stop = asked.stop,
                          .stop_user = asked.stop_user};
  const cprox_lod finest = asked.max_lod == CPROX_LOD_NONE ? CPROX_LOD_MESH : asked.max_lod;
  pair_task task = {.a = &a, .b = &b, .goal = &goal, .finest = finest, .options = &asked, .workspace = workspace};
  pair_reply best;
  if ((status = pair_of_bodies(&task, &best))) return status;
  *result = pair_verdict(&best, &task, &asked);
  if (result->status != CPROX_OK) workspace_fail(workspace, result->status, "%s", cprox_status_text(result->status));
  return result->status;
}

/* ---- the signed distance ---- */

static void pair_write(const pair_answer *answer, int32_t part, cprox_lod lod, const cprox_options *asked,
                       cprox_result *result) {
  *result = (cprox_result){.status = pair_status(answer, asked),
                           .verdict = CPROX_VERDICT_UNDECIDED,
                           .lower = answer->lower,
                           .upper = answer->upper,
                           .t_obstacle = NAN,
                           .witness_mover = answer->on_a,
                           .witness_obstacle = answer->on_b,
                           .normal = answer->normal,
                           .obstacle_part = part,
                           .lod = lod,
                           .nodes = answer->steps,
                           .distance_queries = answer->supports};
}

/* By a search, which may begin where a former one ended and leaves where it has ended. */
static cprox_status pair_search(const cprox_obstacle *a, const cprox_obstacle *b, const cprox_options *asked,
                                cprox_lod finest, cprox_workspace *workspace, cprox_result *result) {
  const pair_goal goal = {.epsilon = asked->epsilon,
                          .relative_epsilon = asked->relative_epsilon,
                          .max_steps = asked->max_nodes,
                          .stop = asked->stop,
                          .stop_user = asked->stop_user,
                          .wants_depth = true,
                          .wants_vertices = asked->start != NULL,
                          .wants_shift = asked->start != NULL};
  pair_reply best;
  pair_frames frames;
  pair_known known;
  if (asked->start) frames = (pair_frames){frame_create(&a->pose, vec(0, 0, 0)), frame_create(&b->pose, vec(0, 0, 0))};
  const bool warm = pair_has_start(asked);
  if (warm) known = pair_known_of(&frames, asked->start);
  pair_task task = {.a = a,
                    .b = b,
                    .goal = &goal,
                    .known = warm ? &known : NULL,
                    .finest = finest,
                    .options = asked,
                    .workspace = workspace};
  /* with a start the formula has not been tried */
  const cprox_status status = asked->start ? pair_of_bodies(&task, &best) : pair_over_parts(&task, &best);
  if (status) return status;
  if (asked->start) pair_leave(a, b, &frames, &best.answer, asked->start);
  pair_write(&best.answer, best.part, best.lod, asked, result);
  return result->status;
}

/* Arguments have been checked. A formula needs neither goal nor start. */
static cprox_status pair_measure(const cprox_obstacle *a, const cprox_obstacle *b, const cprox_options *asked,
                                 cprox_workspace *workspace, cprox_result *result) {
  const cprox_lod finest = asked->max_lod == CPROX_LOD_NONE ? CPROX_LOD_MESH : asked->max_lod;
  pair_answer answer;
  if (asked->start || finest == CPROX_LOD_SPHERE || !pair_by_formula(a, b, &answer))
    return pair_search(a, b, asked, finest, workspace, result);
  pair_write(&answer, 0, CPROX_LOD_HULL, asked, result);
  return result->status;
}

cprox_status cprox_pair(cprox_obstacle a, cprox_obstacle b, const cprox_options *options, cprox_workspace *workspace,
                        cprox_result *result) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  const cprox_options asked = validate_defaults(options);
  cprox_status status;
  if (!result) return workspace_fail(workspace, CPROX_INVALID, "result is NULL: nowhere to put the answer");
  const arguments_query kind = {"a pair",
                                ARGUMENTS_SEARCH | ARGUMENTS_SIGNED | ARGUMENTS_START}; /* depths are always measured */
  if ((options && (status = validate_options(&asked, kind, workspace))) ||
      (status = pair_check_obstacle("a", &a, workspace)) || (status = pair_check_obstacle("b", &b, workspace)) ||
      (status = pair_measure(&a, &b, &asked, workspace, result)) < 0)
    return status;
  if (status != CPROX_OK) workspace_fail(workspace, status, "%s", cprox_status_text(status));
  return status;
}
