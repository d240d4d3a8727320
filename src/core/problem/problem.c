/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/problem.h"

#include <math.h>

#include "curve/subcurve.h"
#include "curve_proximity/cprox/robot.h"

question question_create(cprox_mover mover, const cprox_target *targets, size_t n, double limit, bool farther_is_yes,
                         const cprox_options *options, cprox_workspace *workspace) {
  question q = {.mover = mover,
                .targets = targets,
                .n = n,
                .limit = limit,
                .farther_is_yes = farther_is_yes,
                .options = options ? *options : cprox_options_default(),
                .workspace = workspace};
  if (q.options.max_rung == CPROX_RUNG_NONE) q.options.max_rung = CPROX_RUNG_MESH;
  return q;
}

void question_ask_whole(question *q) {
  if (q->mover.motion) {
    cprox_motion_domain(q->mover.motion, &q->t0, &q->t1);
    return;
  }
  q->part = curve_side_whole();
  q->reach = q->mover.curve->whole;
  cprox_curve_domain(q->mover.curve, &q->t0, &q->t1);
}

cprox_verdict question_verdict(const question *q, const cprox_result *r) {
  if (!question_wants_verdict(q)) return CPROX_UNDECIDED;
  if (r->upper <= q->limit) return q->farther_is_yes ? CPROX_NO : CPROX_YES;
  if (r->lower > q->limit) return q->farther_is_yes ? CPROX_YES : CPROX_NO;
  return CPROX_UNDECIDED;
}

bool question_is_satisfied(const question *q, double ceiling, const cprox_result *r) {
  if (question_wants_verdict(q) && question_verdict(q, r) != CPROX_UNDECIDED) return true;
  const double upper = lesser(r->upper, ceiling);
  return !(upper - r->lower > greater(q->options.relative_epsilon * fabs(upper), q->options.epsilon));
}

const char *question_shortfall(cprox_status status) {
  switch (status) {
    case CPROX_BUDGET: return "the budget of nodes ended the search: raise max_nodes or epsilon";
    case CPROX_PRECISION: return "epsilon is below what double arithmetic allows at this scale";
    case CPROX_STOPPED: return "the stop function ended the search";
    case CPROX_OVERLAP: return cprox_status_text(status);
    default: return "";
  }
}

cprox_result question_nothing(void) {
  return (cprox_result){.lower = INFINITY, .upper = INFINITY, .t_target = NAN, .target_index = -1};
}

void question_join(cprox_result *all, const cprox_result *one) {
  const double lower = lesser(all->lower, one->lower);
  const uint32_t nodes = all->nodes + one->nodes, probes = all->probes + one->probes;
  const cprox_rung rung = all->rung > one->rung ? all->rung : one->rung;
  if (one->upper < all->upper || all->target_index < 0) *all = *one;
  all->lower = lower, all->nodes = nodes, all->probes = probes;
  all->rung = rung;
}

cprox_result *question_reserve_results(const question *q, size_t n) {
  cprox_result *results = workspace_reserve(q->workspace, WORKSPACE_NEAREST, (n + 1) * sizeof *results);
  if (!results) workspace_fail(q->workspace, CPROX_MEMORY, "no memory for %zu results", n);
  return results;
}

void question_rank(cprox_result *nearest, size_t *count, size_t k, const cprox_result *r) {
  size_t i = *count;
  if (i == k) {
    if (!(r->upper < nearest[k - 1].upper)) return;
    i = k - 1;
  } else {
    (*count)++;
  }
  for (; i > 0 && nearest[i - 1].upper > r->upper; i--) nearest[i] = nearest[i - 1];
  nearest[i] = *r;
}

cprox_status question_conclude(const question *q, double ceiling, cprox_status trouble, cprox_result *all) {
  all->lower = lesser(all->lower, all->upper);
  all->status = question_is_satisfied(q, ceiling, all) ? CPROX_OK : trouble != CPROX_OK ? trouble : CPROX_PRECISION;
  all->verdict = question_verdict(q, all);
  if (all->status != CPROX_OK) workspace_fail(q->workspace, all->status, "%s", question_shortfall(all->status));
  return all->status;
}
