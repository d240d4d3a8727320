/* SPDX-License-Identifier: BSD-3-Clause */
/* Distance, tolerance, collision: of one mover against one target or against many. All six are one search. */
#include <math.h>

#include "base/workspace.h"
#include "query/arguments.h"
#include "query/candidates.h"
#include "search/search.h"

/* ---- the answer --------------------------------------------------------------------------------------------------------- */

static cprox_verdict verdict_of(const question *q, const cprox_result *r) {
  if (!question_wants_verdict(q)) return CPROX_UNDECIDED;
  if (r->upper <= q->limit) return q->farther_is_yes ? CPROX_NO : CPROX_YES;
  if (r->lower > q->limit) return q->farther_is_yes ? CPROX_YES : CPROX_NO;
  return CPROX_UNDECIDED;
}

/* Whether the interval is what was asked for, whatever happened on the way. */
static bool is_satisfied(const question *q, const cprox_result *r) {
  if (question_wants_verdict(q) && verdict_of(q, r) != CPROX_UNDECIDED) return true;
  return !(r->upper - r->lower > fmax(q->options.epsilon, q->options.relative_epsilon * r->upper));
}

static const char *shortfall(cprox_status status) {
  switch (status) {
    case CPROX_BUDGET: return "the budget of nodes ended the search: raise max_nodes or epsilon";
    case CPROX_PRECISION: return "epsilon is below what double arithmetic allows at this scale";
    case CPROX_STOPPED: return "the stop function ended the search";
    default: return "";
  }
}

/* The union of targets first … last - 1. */
static cprox_status answer(const question *q, size_t first, size_t last, cprox_result *result) {
  size_t n = 0;
  const candidate *list = NULL;
  if (last > first) {
    list = candidates_list(q, first, last, &n);
    if (!list) return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for a list of targets");
  }

  cprox_result all = {.lower = INFINITY, .upper = INFINITY, .t_target = NAN, .target_index = -1};
  cprox_status trouble = CPROX_OK;
  size_t i = 0;
  for (; i < n; i++) {
    /* sorted: when one ball is too far to matter, so are the rest */
    const bool too_far = question_wants_verdict(q) ? list[i].lower > q->limit : list[i].lower > all.upper;
    const bool answered = all.upper <= fmax(q->limit, 0.0);
    if (too_far || answered || trouble == CPROX_STOPPED) break;

    cprox_result one = {0};
    const cprox_status status = candidate_search(q, &list[i], all.upper, &one);
    if (status < 0) return status;
    if (status != CPROX_OK) trouble = status;

    /* the union's interval: the least of both ends, with the witness of the upper one */
    const double lower = fmin(all.lower, one.lower);
    const uint32_t nodes = all.nodes + one.nodes, probes = all.probes + one.probes;
    if (one.upper < all.upper || all.target_index < 0) all = one;
    all.lower = lower, all.nodes = nodes, all.probes = probes;
    all.rung = CPROX_RUNG_HULL;
  }

  /* the rest is at least as far as the first ball of it */
  if (i < n) all.lower = fmin(all.lower, fmax(list[i].lower, 0.0));
  if (i == 0 && n > 0) all.rung = CPROX_RUNG_SPHERE;
  all.lower = fmin(all.lower, all.upper);
  all.status = is_satisfied(q, &all) ? CPROX_OK : trouble != CPROX_OK ? trouble : CPROX_PRECISION;
  all.verdict = verdict_of(q, &all);
  if (all.status != CPROX_OK) workspace_fail(q->workspace, all.status, "%s", shortfall(all.status));
  *result = all;
  return all.status;
}

static cprox_status ask(const question *q, cprox_result *nearest, cprox_result *each) {
  workspace_clear(q->workspace);
  const cprox_status checked = arguments_check_query(&q->mover, q->targets, q->n, &q->options, q->workspace);
  if (checked != CPROX_OK) return checked;
  if (!each) return answer(q, 0, q->n, nearest);

  /* each target by itself; the union is the least of them */
  cprox_result all = {.lower = INFINITY, .upper = INFINITY, .t_target = NAN, .target_index = -1};
  all.verdict = verdict_of(q, &all);
  for (size_t i = 0; i < q->n; i++) {
    cprox_result one;
    const cprox_status status = answer(q, i, i + 1, &one);
    if (status < 0) return status;
    if (one.target_index < 0) one.target_index = (int32_t)i;
    each[i] = one;
    const double lower = fmin(all.lower, one.lower);
    const uint32_t nodes = all.nodes + one.nodes, probes = all.probes + one.probes;
    const cprox_status worst = one.status > all.status ? one.status : all.status;
    if (one.upper < all.upper || i == 0) all = one;
    all.lower = lower, all.nodes = nodes, all.probes = probes, all.status = worst;
  }
  all.verdict = verdict_of(q, &all);
  *nearest = all;
  return all.status;
}

static question question_create(cprox_mover mover, const cprox_target *targets, size_t n, double limit,
                                bool farther_is_yes, const cprox_options *options, cprox_workspace *workspace) {
  return (question){.mover = mover,
                    .targets = targets,
                    .n = n,
                    .limit = limit,
                    .farther_is_yes = farther_is_yes,
                    .options = options ? *options : cprox_options_default(),
                    .workspace = workspace};
}

/* ---- the verbs ---------------------------------------------------------------------------------------------------------- */

cprox_status cprox_distance_all(cprox_mover mover, const cprox_target *targets, size_t n, const cprox_options *options,
                                cprox_workspace *workspace, cprox_result *nearest, cprox_result *each) {
  const question q = question_create(mover, targets, n, -1.0, false, options, workspace);
  return ask(&q, nearest, each);
}

cprox_status cprox_tolerance_all(cprox_mover mover, const cprox_target *targets, size_t n, double delta,
                                 const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                                 cprox_result *each) {
  const cprox_status checked = arguments_check_delta(delta, workspace);
  if (checked != CPROX_OK) return checked;
  const question q = question_create(mover, targets, n, delta, true, options, workspace);
  return ask(&q, nearest, each);
}

cprox_status cprox_collision_all(cprox_mover mover, const cprox_target *targets, size_t n, const cprox_options *options,
                                 cprox_workspace *workspace, cprox_result *nearest, cprox_result *each) {
  const question q = question_create(mover, targets, n, 0.0, false, options, workspace);
  return ask(&q, nearest, each);
}

cprox_status cprox_distance(cprox_mover mover, cprox_target target, const cprox_options *options,
                            cprox_workspace *workspace, cprox_result *result) {
  return cprox_distance_all(mover, &target, 1, options, workspace, result, NULL);
}

cprox_status cprox_tolerance(cprox_mover mover, cprox_target target, double delta, const cprox_options *options,
                             cprox_workspace *workspace, cprox_result *result) {
  return cprox_tolerance_all(mover, &target, 1, delta, options, workspace, result, NULL);
}

cprox_status cprox_collision(cprox_mover mover, cprox_target target, const cprox_options *options,
                             cprox_workspace *workspace, cprox_result *result) {
  return cprox_collision_all(mover, &target, 1, options, workspace, result, NULL);
}
