/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/answer.h"

#include <math.h>

#include "base/rounding.h"
#include "problem/problem.h"
#include "robot_query/deviation.h"
#include "robot_query/oracle.h"
#include "robot_query/robot_depth.h"

/* ---- the search ---- */

static cprox_status run(const query *q, const search_goal *goal, robot_search *o, search_outcome *found) {
  motion_interval over, other;
  robot_scene_range(&o->scene, &over, &other);
  robot_search_begin(o, goal);
  *found = (search_outcome){.lower = INFINITY, .free_until = INFINITY, .best = {.upper = INFINITY, .at = INFINITY}};
  if (o->scene.n_pairs == 0 && !q->set && !o->scene.groups) return CPROX_OK;
  search_node root;
  if (!robot_search_root(o, &over, &other, &root))
    return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the lists of pairs");
  const search_oracle oracle = robot_search_oracle(o);
  const cprox_status status = search_run(&o->goal, &oracle, root, q->workspace, found);
  if (status == CPROX_MEMORY) return workspace_fail(q->workspace, status, "no memory for the open intervals");
  return status;
}

/* ---- what was found ---- */

static void report(const robot_search *o, const robot_sample *sample, cprox_result *r) {
  if (sample->pair < 0) return;
  const robot_scene *s = &o->scene;
  const robot_pair *pair = &s->pairs[sample->pair];
  const double t = robot_scene_clock(s, motion_time(s->motion, sample->segment, sample->u), sample->other);
  r->t = fmin(fmax(t, s->q->t0), s->q->t1);
  r->witness_mover = sample->gap.on_moving, r->witness_obstacle = sample->gap.on_standing,
  r->normal = sample->gap.normal;
  r->mover_part = s->parts[pair->moving].body.index;
  r->obstacle_index = pair->self ? s->parts[pair->standing].body.index : s->obstacles[pair->standing].index;
  if (pair->self && mover_is_whole(&s->q->mover)) r->obstacle_index += (int32_t)s->q->n;
  r->obstacle_part = pair->self ? 0 : s->obstacles[pair->standing].part;
}

static cprox_lod lod_of(const robot_search *o) {
  if (o->scene.n_pairs == 0 && !o->scene.groups && isinf(o->scene.plan.beyond)) return CPROX_LOD_NONE;
  if (o->refined) return CPROX_LOD_MESH;
  const bool by_balls = o->gaps + o->planes == 0 || o->scene.q->options.max_lod == CPROX_LOD_SPHERE;
  return by_balls ? CPROX_LOD_SPHERE : CPROX_LOD_HULL;
}

void robot_search_report(const robot_search *o, cprox_result *result) {
  result->lod = lod_of(o);
  result->distance_queries = o->gaps;
  report(o, &o->best, result);
}

/* Of the pairs of one class; NULL: of all, because no start has a tolerance. */
static cprox_status answer_class(const query *q, const start_class *starts, size_t first, size_t last, double cutoff,
                                 cprox_result *result, double *travel) {
  robot_search o;
  const size_t most_listed = q->errors ? SIZE_MAX : ROBOT_MOST_LISTED; /* groups of parts know no errors */
  if (!robot_scene_begin(&o.scene, q, starts, first, last, most_listed, cutoff))
    return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
  /* verdicts, too: depth first stays with one deep pair, while the distance that they follow from leaves it */
  search_goal goal = query_goal(q, SEARCH_BEST_FIRST, cutoff);
  if (!query_wants_verdict(q)) goal.share = q->options.share, goal.share_user = q->options.share_user;
  search_outcome found;
  const cprox_status status = run(q, &goal, &o, &found);
  if (status < 0) return status;

  cprox_result r = {.t_obstacle = NAN, .obstacle_index = -1, .mover_part = -1, .upper = o.best_bound.upper};
  robot_search_report(&o, &r);
  r.lower = fmin(found.lower, o.dropped);
  r.lower = fmin(q->is_signed ? r.lower : fmax(r.lower, 0.0), r.upper);
  r.nodes = found.nodes + o.flights;
  if (goal.share) cutoff = lesser(cutoff, goal.share(goal.share_user, r.upper));
  query_conclude(q, cutoff, status, &r);
  if (q->errors) q->errors->loss = o.best.pair >= 0 ? o.best.gap.loss : 0.0, q->errors->left = o.best.gap.upper;
  const double at = o.best.pair >= 0 ? motion_time(q->mover.motion, o.best.segment, o.best.u) : 0.0;
  if (travel) *travel = o.best.pair >= 0 ? placed_robot_pair_travel(&o.scene, o.best.pair, at, o.best.other) : INFINITY;
  *result = r;
  return r.status;
}

/* The union of all classes, by the models that the query allows. */
static cprox_status answer_models(const query *q, size_t first, size_t last, double cutoff, cprox_result *result,
                                  double *travel) {
  const bool one_of_many = start_class_is_one_of_many(q->mover.motion);
  cprox_status failure = CPROX_OK;
  cprox_result all = query_nothing();
  start_class starts = start_class_first();
  bool violated = false;
  do {
    if (violated) { /* of the classes that are left nothing is known */
      all.lower = fmin(all.lower, 0.0);
      break;
    }
    cprox_result r = {0};
    double moves = 0.0;
    const cprox_status status = answer_class(q, one_of_many ? &starts : NULL, first, last, lesser(cutoff, all.upper),
                                             &r, travel ? &moves : NULL);
    if (status < 0) return status;
    if (status != CPROX_OK) failure = status;
    if (travel && (r.upper < all.upper || all.obstacle_index < 0)) *travel = moves;
    if (!one_of_many) {
      *result = r;
      return status;
    }
    query_join(&all, &r);
    violated = r.verdict == CPROX_VERDICT_VIOLATED;
  } while (start_class_next(q->mover.motion, &starts));
  query_conclude(q, cutoff, failure, &all);
  *result = all;
  return all.status;
}

/* Depths are those of hulls, and what is apart is measured by the meshes. */
static cprox_status answer(const query *q, size_t first, size_t last, double cutoff, cprox_result *result,
                           double *travel) {
  if (!q->is_signed) return answer_models(q, first, last, cutoff, result, travel);
  const query apart = robot_depth_apart(q), hulls = robot_depth_hulls(q);
  if (!robot_depth_has_meshes(q, first, last)) return answer_models(&hulls, first, last, cutoff, result, travel);
  const cprox_status status = answer_models(&apart, first, last, cutoff, result, travel);
  if (status < 0 || robot_depth_is_settled(q, result)) return status;
  cprox_result deep;
  double moves = 0.0;
  const cprox_status measured = answer_models(&hulls, first, last, cutoff, &deep, travel ? &moves : NULL);
  if (measured < 0) return measured;
  const double contact = result->upper;
  const cprox_status joined = robot_depth_join(q, cutoff, result, &deep);
  if (travel && deep.upper < contact) *travel = moves;
  *result = deep;
  return joined;
}

cprox_status robot_answer(const query *q, size_t first, size_t last, double cutoff, cprox_result *result) {
  return answer(q, first, last, cutoff, result, NULL);
}

cprox_status robot_answer_and_travel(const query *q, cprox_result *result, double *travel) {
  return answer(q, 0, q->n, INFINITY, result, travel);
}

/* ---- time of contact ---- */

static cprox_status contact_of_class(const query *q, const start_class *starts, double time_cutoff,
                                     cprox_result *result) {
  robot_search o;
  if (!robot_scene_begin(&o.scene, q, starts, 0, q->n, ROBOT_MOST_LISTED, INFINITY))
    return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the pairs of a robot");
  search_goal goal = query_goal(q, SEARCH_LEFT_TO_RIGHT, INFINITY);
  goal.time_cutoff = time_cutoff;
  search_outcome found;
  const cprox_status status = run(q, &goal, &o, &found);
  if (status < 0) return status;
  const cprox_status proved = robot_search_prove(&o, q->t1 + o.scene.lead_tolerance);
  if (proved < 0) return proved;

  if (o.unsure) found.free_until = fmin(found.free_until, q->t0);
  const bool touch = o.touch.pair >= 0, near = o.best_bound.upper <= q->options.epsilon;
  const robot_sample *sample = touch ? &o.touch : &o.best;
  cprox_result r = {.t_obstacle = NAN, .obstacle_index = -1, .mover_part = -1};
  report(&o, sample, &r);
  r.upper = sample->pair < 0 ? INFINITY : fmax(sample->gap.upper, 0.0);
  r.lower = touch ? 0.0 : fmin(fmax(fmin(found.lower, o.dropped), 0.0), r.upper);
  r.t_contact_lower = fmax(fmin(found.free_until, q->t1), q->t0);
  r.verdict = touch ? CPROX_VERDICT_VIOLATED : isinf(found.free_until) ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_UNDECIDED;
  if (sample->pair < 0) r.t = NAN;
  if (touch) r.t = fmax(r.t, r.t_contact_lower); /* one is rounded, the other rounded down */
  r.nodes = found.nodes + o.flights, r.distance_queries = o.gaps;
  r.lod = lod_of(&o);
  r.status = status;
  if (status == CPROX_OK && near && found.free_until < o.best_bound.at) r.status = CPROX_PRECISION;
  if (r.status != CPROX_OK) workspace_fail(q->workspace, r.status, "%s", query_shortfall(r.status));
  *result = r;
  return r.status;
}

/* The earlier contact, the earlier place that may be one, or the nearest place. */
static bool tells_more(const cprox_result *r, const cprox_result *than, double epsilon) {
  const bool touches = r->verdict == CPROX_VERDICT_VIOLATED, touched = than->verdict == CPROX_VERDICT_VIOLATED;
  if (touches != touched) return touches;
  const bool near = touches || r->upper <= epsilon, was_near = touched || than->upper <= epsilon;
  if (near != was_near) return near;
  return near ? r->t < than->t : r->upper < than->upper;
}

cprox_status robot_time_of_contact(const query *q, cprox_result *result) {
  if (!start_class_is_one_of_many(q->mover.motion)) return contact_of_class(q, NULL, INFINITY, result);
  start_class starts = start_class_first();
  cprox_status status = contact_of_class(q, &starts, INFINITY, result);
  if (status < 0) return status;
  cprox_result all = *result;
  while (start_class_next(q->mover.motion, &starts)) {
    cprox_result r = {0};
    const cprox_status one = contact_of_class(q, &starts, all.verdict == CPROX_VERDICT_VIOLATED ? all.t : INFINITY, &r);
    if (one < 0) return one;
    if (one != CPROX_OK) status = one;
    const cprox_result other = tells_more(&r, &all, q->options.epsilon) ? all : r;
    if (tells_more(&r, &all, q->options.epsilon)) all = r;
    all.t_contact_lower = fmin(all.t_contact_lower, other.t_contact_lower);
    all.lower = fmin(all.lower, other.lower);
    all.nodes += other.nodes, all.distance_queries += other.distance_queries;
    if (other.lod > all.lod) all.lod = other.lod;
    if (all.verdict == CPROX_VERDICT_CLEAR) all.verdict = other.verdict;
  }
  all.status = status;
  if (status != CPROX_OK) workspace_fail(q->workspace, status, "%s", query_shortfall(status));
  *result = all;
  return status;
}
