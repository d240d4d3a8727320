/* SPDX-License-Identifier: BSD-3-Clause */
/* Many movers against the same obstacles. doc/batches.md says what is done for each. */
#include "batch/batch.h"

#include <math.h>
#include <stdio.h>

#include "base/workspace.h"
#include "batch/prefilter.h"
#include "curve_query/search_candidate.h"
#include "problem/validate.h"
#include "solve/list.h"
#include "solve/solve.h"

/* ---- one mover ---- */

/* A point of the curve is so near to a part that the limit is violated, whatever else there is. */
static cprox_status report_hit(const batch_run *run, const batch_prefilter_answer *look, cprox_result *r) {
  const batch_hit *hit = &look->hit;
  const candidate *part = &run->batch->parts[hit->part];
  const double *breaks = run->q.mover.curve->breaks + hit->piece, radius = run->q.mover.radius;
  const double margin = run->batch->cores[hit->part].margin;
  *r = (cprox_result){.lower = lesser(greater(look->beyond, 0.0), hit->upper),
                      .upper = hit->upper,
                      .t = breaks[0] + hit->s * (breaks[1] - breaks[0]),
                      .t_obstacle = NAN,
                      .witness_mover = hit->point,
                      .witness_obstacle = hit->point,
                      .obstacle_index = part->obstacle,
                      .obstacle_part = part->part,
                      .lod = look->lod};

  /* the nearest points of the padded part and the mover, or one of both */
  if (hit->distance > margin) {
    const vec3 between = vec_sub(hit->point, hit->surface);
    const double length = vec_norm(between);
    const vec3 normal = length > 0.0 ? vec_scale(1.0 / length, between) : vec(0, 0, 0);
    r->witness_mover = r->witness_obstacle = vec_axpy(hit->surface, margin, normal);
    if (hit->distance > margin + radius) {
      r->normal = normal;
      r->witness_mover = vec_axpy(hit->point, -radius, normal);
    }
  }
  r->verdict = query_verdict(&run->q, r);
  return CPROX_OK;
}

/* The union of what is near. */
static cprox_status search_near(const batch_run *run, const batch_prefilter_answer *look, cprox_result *all) {
  const query *q = &run->q;
  cprox_status failure = CPROX_OK;
  *all = query_nothing();
  double rest = look->beyond; /* the least bound of what was not searched */
  for (size_t i = 0; i < look->n; i++) {
    const candidate *c = &run->near[i];
    const bool too_far = !query_wants_verdict(q) && c->lower > all->upper;
    if (too_far || all->upper <= fmax(q->limit, 0.0) || failure == CPROX_STOPPED) {
      rest = fmin(rest, c->lower);
      continue;
    }
    cprox_result one = {0};
    const cprox_status status = candidate_search(q, c, all->upper, &one);
    if (status < 0) return status;
    if (status != CPROX_OK) failure = status;
    query_join(all, &one);
  }
  if (look->n == 0 && run->batch->n > 0) all->lod = look->lod;
  all->lower = fmin(all->lower, fmax(rest, 0.0));
  return query_conclude(q, INFINITY, failure, all);
}

static cprox_status answer_fast(batch_run *run, cprox_result *r) {
  batch_prefilter_answer look;
  batch_prefilter(run, &look);
  if (look.is_hit) return report_hit(run, &look, r);
  query_ask_whole(&run->q);
  run->degree = SIZE_MAX; /* a search has bases of its own */
  return search_near(run, &look, r);
}

/* ---- the call ---- */

/* The short way is for points and balls along curves with control points. */
static bool may_be_fast(const batch_run *run, const cprox_mover *mover) {
  return mover->kind == CPROX_MOVER_BALL && mover->curve && !mover->radius_curve && !mover->curve->arcs &&
         !mover->body && !mover->motion && mover->radius >= 0.0 && mover->radius <= LENGTH_MOST &&
         mover->curve->in_reach && !run->batch->synchronized && run->q.options.max_lod == CPROX_LOD_MESH &&
         !run->q.options.signed_distance && !mover->pairs && mover->n_pairs == 0;
}

static cprox_status answer_one(batch_run *run, const cprox_mover *mover, cprox_result *r) {
  const query *q = &run->q;
  const cprox_obstacle *obstacles = run->batch->obstacles;
  const size_t n = run->batch->n;
  workspace_clear(q->workspace);
  if (may_be_fast(run, mover)) {
    run->q.mover = *mover;
    return answer_fast(run, r);
  }
  run->degree = SIZE_MAX; /* a search has bases of its own */
  if (!query_wants_verdict(q)) return list_distance(*mover, obstacles, n, &q->options, q->workspace, r, NULL);
  return list_tolerance(*mover, obstacles, n, q->limit, &q->options, q->workspace, r, NULL);
}

static cprox_status check_call(const batch_run *run, const cprox_mover *movers, size_t first, size_t last,
                               const cprox_result *results) {
  cprox_workspace *workspace = run->q.workspace;
  if (!workspace) return CPROX_INVALID;
  workspace_clear(workspace);
  if (first > last)
    return workspace_fail(workspace, CPROX_INVALID, "the range begins at mover %zu and ends at %zu", first, last);
  if (first < last && !movers) return workspace_fail(workspace, CPROX_INVALID, "movers is NULL");
  if (first < last && !results) return workspace_fail(workspace, CPROX_INVALID, "results is NULL");
  const unsigned depths = query_wants_verdict(&run->q) ? 0 : ARGUMENTS_SIGNED;
  return validate_options(&run->q.options, (arguments_query){"a batch", ARGUMENTS_SEARCH | depths}, workspace);
}

static bool reserve(batch_run *run) {
  const packet_balls *balls = &run->batch->balls;
  const size_t numbers = balls->padded + run->batch->clusters.padded + 1;
  run->lower = workspace_reserve(run->q.workspace, WORKSPACE_BATCH, numbers * sizeof(double));
  run->cluster_lower = run->lower ? run->lower + balls->padded : NULL;
  run->near = workspace_reserve(run->q.workspace, WORKSPACE_BATCH_NEAR, (balls->n + 1) * sizeof *run->near);
  run->open = workspace_reserve(run->q.workspace, WORKSPACE_BATCH_OPEN, (balls->n + 1) * sizeof *run->open);
  return run->lower && run->near && run->open;
}

static cprox_status answer_range(query q, const obstacle_batch *batch, const cprox_mover *movers, size_t first,
                                 size_t last, cprox_result *results) {
  batch_run run = {.batch = batch, .q = q, .degree = SIZE_MAX};
  const cprox_status checked = check_call(&run, movers, first, last, results);
  if (checked != CPROX_OK) return checked;
  run.q.obstacles = batch->obstacles;
  run.q.n = batch->n;
  if (!reserve(&run))
    return workspace_fail(q.workspace, CPROX_MEMORY, "no memory for a batch of %zu obstacles", batch->n);

  cprox_status worst = CPROX_OK;
  char reason[320] = "";
  for (size_t i = first; i < last; i++) {
    cprox_result *r = &results[i];
    const cprox_status status = answer_one(&run, &movers[i], r);
    if (status < 0) {
      *r = query_nothing();
      r->status = status, r->lower = 0.0, r->verdict = CPROX_VERDICT_UNDECIDED;
    }
    if (worst >= 0 && (status < 0 || status > worst)) {
      worst = status;
      snprintf(reason, sizeof reason, "mover %zu: %s", i, cprox_workspace_error(q.workspace));
    }
  }
  workspace_clear(q.workspace);
  return worst == CPROX_OK ? CPROX_OK : workspace_fail(q.workspace, worst, "%s", reason);
}

cprox_status batch_distance(const obstacle_batch *batch, const cprox_mover *movers, size_t first, size_t last,
                            const cprox_options *options, cprox_workspace *workspace, cprox_result *results) {
  const query q = query_create((cprox_mover){0}, NULL, 0, -1.0, options, workspace);
  return answer_range(q, batch, movers, first, last, results);
}

cprox_status batch_tolerance(const obstacle_batch *batch, const cprox_mover *movers, size_t first, size_t last,
                             double delta, const cprox_options *options, cprox_workspace *workspace,
                             cprox_result *results) {
  if (!workspace) return CPROX_INVALID;
  const cprox_status checked = validate_delta(delta, workspace);
  if (checked != CPROX_OK) return checked;
  const query q = query_create((cprox_mover){0}, NULL, 0, delta, options, workspace);
  return answer_range(q, batch, movers, first, last, results);
}
