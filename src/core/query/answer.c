/* SPDX-License-Identifier: BSD-3-Clause */
#include "query/answer.h"

#include <math.h>

#include "query/candidate_search.h"
#include "query/robot_answer.h"

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

cprox_verdict question_verdict(const question *q, const cprox_result *r) {
  if (!question_wants_verdict(q)) return CPROX_UNDECIDED;
  if (r->upper <= q->limit) return q->farther_is_yes ? CPROX_NO : CPROX_YES;
  if (r->lower > q->limit) return q->farther_is_yes ? CPROX_YES : CPROX_NO;
  return CPROX_UNDECIDED;
}

/* Whether the interval is what was asked for, whatever happened on the way. */
static bool is_satisfied(const question *q, double ceiling, const cprox_result *r) {
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
  all->status = is_satisfied(q, ceiling, all) ? CPROX_OK : trouble != CPROX_OK ? trouble : CPROX_PRECISION;
  all->verdict = question_verdict(q, all);
  if (all->status != CPROX_OK) workspace_fail(q->workspace, all->status, "%s", question_shortfall(all->status));
  return all->status;
}

/* The bound of list[i] has grown: moves it back to where it belongs. */
static void sort_again(candidate *list, size_t i, size_t n) {
  const candidate moved = list[i];
  for (; i + 1 < n && list[i + 1].lower < moved.lower; i++) list[i] = list[i + 1];
  list[i] = moved;
}

cprox_status question_answer(const question *q, size_t first, size_t last, double ceiling, cprox_result *result) {
  if (q->mover.motion) return robot_answer(q, first, last, ceiling, result);
  size_t n = 0;
  candidate *list = NULL;
  if (last > first) {
    /* a distance from one thing alone is searched whatever its ball says */
    list = candidates_list(q, first, last, question_wants_verdict(q) || isfinite(ceiling), &n);
    if (!list) return workspace_fail(q->workspace, CPROX_MEMORY, "no memory for a list of targets");
  }

  cprox_result all = question_nothing();
  cprox_status trouble = CPROX_OK;
  size_t i = 0;
  while (i < n) {
    /* sorted: when one ball is too far to matter, so are the rest */
    const bool too_far =
        question_wants_verdict(q) ? list[i].lower > q->limit : list[i].lower > lesser(all.upper, ceiling);
    const bool answered = !q->is_signed && all.upper <= greater(q->limit, 0.0);
    if (too_far || answered || trouble == CPROX_STOPPED) break;

    /* with nothing to compare with, a mesh waits until it is the nearest by its hull */
    const bool unknown = !question_wants_verdict(q) && isinf(lesser(all.upper, ceiling));
    if (unknown && i + 1 < n && candidate_may_climb(q, &list[i])) {
      const cprox_status ranked = candidate_rank(q, &list[i], &all.nodes, &all.probes);
      if (ranked < 0) return ranked;
      sort_again(list, i, n);
      continue;
    }
    cprox_result one;
    const cprox_status status = candidate_search(q, &list[i++], lesser(all.upper, ceiling), &one);
    if (status < 0) return status;
    if (status != CPROX_OK) trouble = status;
    question_join(&all, &one);
  }

  /* the rest is at least as far as the first ball of it */
  if (i < n) all.lower = fmin(all.lower, q->is_signed ? list[i].lower : fmax(list[i].lower, 0.0));
  if (i == 0 && n > 0) all.rung = CPROX_RUNG_SPHERE;
  question_conclude(q, ceiling, trouble, &all);
  *result = all;
  return all.status;
}
