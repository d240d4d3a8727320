/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/problem.h"

#include <math.h>

#include "base/check.h"
#include "curve/curve_side.h"
#include "curve_proximity/cprox/robot.h"

query query_create(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, double limit,
                   const cprox_options *options, cprox_workspace *workspace) {
  query q = {.mover = mover,
             .obstacles = obstacles,
             .n = n,
             .limit = limit,
             .options = validate_defaults(options),
             .workspace = workspace};
  if (q.options.max_lod == CPROX_LOD_NONE) q.options.max_lod = CPROX_LOD_MESH;
  return q;
}

void query_ask_whole(query *q) {
  if (q->mover.motion) {
    const cprox_motion_info info = cprox_motion_get_info(q->mover.motion);
    q->t0 = info.t0, q->t1 = info.t1;
    if (q->options.interval) q->t0 = q->options.interval[0], q->t1 = q->options.interval[1];
    return;
  }
  q->part = curve_side_whole();
  q->reach = curve_whole(q->mover.curve);
  q->t0 = q->mover.curve->breaks[0], q->t1 = q->mover.curve->breaks[q->mover.curve->n_pieces];
}

cprox_status query_begin(query *q, arguments_query asked) {
  workspace_clear(q->workspace);
  const cprox_status checked = validate_query(&q->mover, q->obstacles, q->n, &q->options, asked, q->workspace);
  if (checked == CPROX_OK) query_ask_whole(q);
  return checked;
}

search_goal query_goal(const query *q, search_order order, double cutoff) {
  CORE_CHECK(!(q->is_signed && query_wants_verdict(q)), "a verdict about %g m has no sign", q->limit);
  const uint64_t done = workspace_work(q->workspace), most = q->options.max_nodes;
  return (search_goal){.order = order,
                       .limit = q->limit,
                       .is_signed = q->is_signed,
                       .cutoff = cutoff,
                       .time_cutoff = INFINITY,
                       .epsilon = q->options.epsilon,
                       .relative_epsilon = q->options.relative_epsilon,
                       .max_nodes = done < most ? (uint32_t)(most - done) : 1,
                       .stop = q->options.stop,
                       .stop_user = q->options.stop_user};
}

/* A search that ends at a cutoff has a lower bound of at least the cutoff less the width allowed there. */
double query_cutoff_beyond(const query *q, double distance) {
  if (isinf(distance)) return distance;
  const double width = width_allowed(q->options.epsilon, q->options.relative_epsilon, distance);
  const double beyond = (distance + 2.0 * width) * (1.0 + 4.0 * (q->options.relative_epsilon + 1e-15));
  return nextafter(beyond, INFINITY); /* where both are 0: a bound of 0 is not beyond */
}

cprox_verdict query_verdict(const query *q, const cprox_result *r) {
  if (!query_wants_verdict(q)) return CPROX_VERDICT_UNDECIDED;
  if (r->upper <= q->limit) return CPROX_VERDICT_VIOLATED;
  if (r->lower > q->limit) return CPROX_VERDICT_CLEAR;
  return CPROX_VERDICT_UNDECIDED;
}

bool query_is_satisfied(const query *q, double cutoff, const cprox_result *r) {
  if (query_wants_verdict(q) && query_verdict(q, r) != CPROX_VERDICT_UNDECIDED) return true;
  const double upper = lesser(r->upper, cutoff);
  return !(upper - r->lower > width_allowed(q->options.epsilon, q->options.relative_epsilon, upper));
}

const char *query_shortfall(cprox_status status) {
  switch (status) {
    case CPROX_BUDGET: return "the budget ended the search: raise max_nodes or epsilon";
    case CPROX_PRECISION: return "epsilon is below what double arithmetic allows at this scale";
    case CPROX_INEXACT: return "epsilon is below the error of an obstacle's distances, or of their interpolation";
    case CPROX_STOPPED: return "the stop function ended the search";
    case CPROX_OVERLAP: return cprox_status_text(status);
    default: return "";
  }
}

cprox_result query_nothing(void) {
  return (cprox_result){.lower = INFINITY, .upper = INFINITY, .t_obstacle = NAN, .obstacle_index = -1};
}

void query_join(cprox_result *all, const cprox_result *one) {
  const double lower = lesser(all->lower, one->lower);
  const uint32_t nodes = all->nodes + one->nodes, distance_queries = all->distance_queries + one->distance_queries;
  const cprox_lod lod = all->lod > one->lod ? all->lod : one->lod;
  if (one->upper < all->upper || all->obstacle_index < 0) *all = *one;
  all->lower = lower, all->nodes = nodes, all->distance_queries = distance_queries;
  all->lod = lod;
}

cprox_result *query_reserve_results(const query *q, size_t n) {
  cprox_result *results = workspace_reserve(q->workspace, WORKSPACE_NEAREST, (n + 1) * sizeof *results);
  if (!results) workspace_fail(q->workspace, CPROX_MEMORY, "no memory for %zu results", n);
  return results;
}

void query_rank(cprox_result *nearest, size_t *count, size_t k, const cprox_result *r, double *others) {
  size_t i = *count;
  if (i == k) {
    const bool is_nearer = r->upper < nearest[k - 1].upper;
    *others = fmin(*others, is_nearer ? nearest[k - 1].lower : r->lower);
    if (!is_nearer) return;
    i = k - 1;
  } else {
    (*count)++;
  }
  for (; i > 0 && nearest[i - 1].upper > r->upper; i--) nearest[i] = nearest[i - 1];
  nearest[i] = *r;
}

cprox_status query_conclude(const query *q, double cutoff, cprox_status failure, cprox_result *all) {
  const double lower = all->lower;
  all->lower = lesser(lower, all->upper);
  all->verdict = query_verdict(q, all);
  all->status = query_is_satisfied(q, cutoff, all) ? CPROX_OK : failure != CPROX_OK ? failure : CPROX_PRECISION;
  /* each bound is proven, so that they contradict each other only where a proof is wrong */
  CORE_CHECK(!(lower > all->upper), "lower %.17g, upper %.17g", lower, all->upper);
  if (all->status != CPROX_OK) workspace_fail(q->workspace, all->status, "%s", query_shortfall(all->status));
  return all->status;
}
