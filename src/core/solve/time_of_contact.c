/* SPDX-License-Identifier: BSD-3-Clause */
/* Time of contact along the mover's parameter: never late. doc/time-of-contact.md derives it. */
#include <math.h>

#include "base/check.h"
#include "curve_query/report.h"
#include "curve_query/search_candidate.h"
#include "solve/solve.h"
#include "solve/time_of_contact.h"

static cprox_result nothing(void) {
  return (cprox_result){.lower = INFINITY, .upper = INFINITY, .t = INFINITY, .t_obstacle = NAN, .obstacle_index = -1};
}

/* ---- one candidate ---- */

/* Searches a pair from left to right: where the two come within epsilon first, and where contact is proven. */
static cprox_status meet_placed(const query *q, const placed_pair *p, search_goal *goal, search_outcome *found,
                                time_of_contact *met) {
  curve_search s;
  curve_start start = {.goal = *goal};
  cprox_status status = curve_search_begin(&s, q, p);
  if (status == CPROX_OK) status = s.kernel->start_contact(&s, &start);
  if (status < 0) return status;
  status = search_run(goal, &start.oracle, start.root, q->workspace, found);
  if (status < 0) return status;
  curve_finding near, touch;
  s.kernel->best_found(&s, &near);
  const cprox_status proved = s.kernel->prove_contact(&s, &touch);
  if (proved < 0) return proved;
  met->distance_queries = touch.distance_queries;
  met->near_at = near.bound.at;
  const bool touches = touch.bound.at < goal->time_cutoff;
  cprox_status reported = touches ? CPROX_OK : report_finding(q, p, &near, &met->near);
  met->near.t = near.t, met->near.upper = near.bound.upper;
  met->slack = near.bound.slack;
  if (!touches || reported < 0) return reported < 0 ? reported : status;
  reported = report_finding(q, p, &touch, &met->touch);
  if (reported < 0) return reported;
  met->touch.upper = touch.bound.upper;
  met->touch.t = touch.t_contact;
  return status;
}

/* Contact is proven nowhere near the first place within epsilon; perhaps farther along, or the two are apart. */
static cprox_status prove_farther(const query *q, const candidate *c, time_of_contact *met) {
  cprox_result r;
  const cprox_status status = candidate_search(q, c, INFINITY, &r);
  if (status < 0) return status;
  met->nodes += r.nodes, met->distance_queries += r.distance_queries;
  if (r.upper <= 0.0 && r.t >= met->free_until) met->touch = r;
  if (r.lower > 0.0) {
    met->free_until = INFINITY, met->lower = fmax(met->lower, r.lower);
    met->near = r;
    met->status = CPROX_OK;
  }
  return CPROX_OK;
}

static cprox_status meet_model(const query *q, const candidate *c, double time_cutoff, time_of_contact *met) {
  const placed_pair p = placed_pair_resolve(q, c);
  *met = (time_of_contact){.touch = nothing(), .near = nothing(), .lod = p.lod};
  search_goal goal = query_goal(q, SEARCH_LEFT_TO_RIGHT, INFINITY);
  goal.time_cutoff = time_cutoff;
  search_outcome found = {0};
  met->status = meet_placed(q, &p, &goal, &found, met);
  if (met->status == CPROX_MEMORY)
    return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for the open intervals");
  if (met->status < 0) return met->status;
  met->nodes = found.nodes;
  met->free_until = found.free_until;
  met->lower = fmax(found.lower, c->lower);
  const bool near = met->near.upper <= q->options.epsilon;
  const double end = near ? fmin(met->near_at, time_cutoff) : time_cutoff;
  if (met->status == CPROX_OK && met->free_until < end) met->status = CPROX_PRECISION;
  if (met->status == CPROX_PRECISION) met->status = curve_kernel_shortfall(&p, met->slack);
  return near && !isfinite(met->touch.t) && !isfinite(time_cutoff) ? prove_farther(q, c, met) : CPROX_OK;
}

/* By the hull of a level-of-detail body first: what does not touch that before the cutoff does not touch the mesh. */
static cprox_status meet(const query *q, const candidate *c, double time_cutoff, time_of_contact *met) {
  if (!candidate_may_refine(q, c)) return meet_model(q, c, time_cutoff, met);
  candidate model = *c;
  model.lod = CPROX_LOD_HULL;
  time_of_contact by_hull;
  cprox_status status = meet_model(q, &model, time_cutoff, &by_hull);
  if (status < 0) return status;
  if (by_hull.free_until >= time_cutoff) {
    /* what is near the hull need not be near the mesh */
    const double t = by_hull.near.t;
    *met = by_hull;
    met->near = met->touch = nothing();
    met->status = CPROX_OK;
    if (!isfinite(t)) return CPROX_OK;
    met->near.t = t;
    status = candidate_measure_mesh(q, c, &met->near);
    return status;
  }
  model.lod = CPROX_LOD_MESH;
  status = meet_model(q, &model, time_cutoff, met);
  if (status < 0) return status;
  met->nodes += by_hull.nodes, met->distance_queries += by_hull.distance_queries;
  return status;
}

/* ---- all candidates ---- */

/* The earlier of two places, or the nearer where neither is contact. */
static void merge_place(cprox_result *all, const cprox_result *one, double epsilon) {
  const bool had = all->upper <= epsilon, has = one->upper <= epsilon;
  if (has ? (!had || one->t < all->t) : (!had && one->upper < all->upper)) *all = *one;
}

static void merge(time_of_contact *all, const time_of_contact *one, double epsilon) {
  all->free_until = fmin(all->free_until, one->free_until);
  all->lower = fmin(all->lower, one->lower);
  if (one->touch.t < all->touch.t) all->touch = one->touch;
  merge_place(&all->near, &one->near, epsilon);
  all->nodes += one->nodes, all->distance_queries += one->distance_queries;
  if (one->lod > all->lod) all->lod = one->lod;
  if (one->status != CPROX_OK) all->status = one->status;
}

cprox_status time_of_contact_conclude(const time_of_contact *all, const query *q, cprox_result *result) {
  double t0, t1;
  curve_domain(q->mover.curve, &t0, &t1);
  const bool touch = isfinite(all->touch.t), near = all->near.upper <= q->options.epsilon;
  cprox_result r = touch ? all->touch : all->near;
  CORE_CHECK(touch || !(all->lower > r.upper), "lower %.17g, upper %.17g", all->lower, r.upper);
  r.t_contact_lower = fmin(all->free_until, t1);
  r.lower = touch ? 0.0 : fmax(fmin(all->lower, r.upper), 0.0);
  r.upper = fmax(r.upper, 0.0);
  r.verdict = touch ? CPROX_VERDICT_VIOLATED : isinf(all->free_until) ? CPROX_VERDICT_CLEAR : CPROX_VERDICT_UNDECIDED;
  if (touch) r.t = fmax(r.t, r.t_contact_lower); /* one is rounded, the other rounded down */
  if (!touch && !near) r.t = r.obstacle_index < 0 ? NAN : r.t;
  r.lod = all->lod != CPROX_LOD_NONE ? all->lod : q->n > 0 ? CPROX_LOD_SPHERE : CPROX_LOD_NONE;
  r.nodes = all->nodes, r.distance_queries = all->distance_queries;
  r.status = all->status;
  if (r.status != CPROX_OK) workspace_fail(q->workspace, r.status, "%s", query_shortfall(r.status));
  *result = r;
  return r.status;
}

time_of_contact time_of_contact_begin(void) {
  return (time_of_contact){.free_until = INFINITY, .lower = INFINITY, .touch = nothing(), .near = nothing()};
}

cprox_status time_of_contact_with(time_of_contact *all, const query *q, size_t first, size_t last) {
  size_t count = 0;
  const candidate *list = last > first ? candidates_list(q, first, last, true, &count) : NULL;
  if (last > first && !list) return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for a list of obstacles");
  size_t i = 0;
  for (; i < count && list[i].lower <= 0.0 && all->status != CPROX_STOPPED; i++) {
    time_of_contact one;
    const cprox_status status = meet(q, &list[i], all->touch.t, &one);
    if (status < 0) return status;
    merge(all, &one, q->options.epsilon);
  }
  /* the rest is too far to touch, unless the caller stopped */
  if (i < count) all->lower = fmin(all->lower, list[i].lower);
  if (i < count && list[i].lower <= 0.0) curve_domain(q->mover.curve, &all->free_until, &(double){0.0});
  return CPROX_OK;
}
