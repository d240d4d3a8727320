/* SPDX-License-Identifier: BSD-3-Clause */
/* The clearance profile: the same query about one interval of the curve after the other. */
#include <math.h>

#include "base/check.h"
#include "problem/section.h"
#include "problem/validate.h"
#include "solve/list.h"
#include "solve/solve.h"

static cprox_status check_breaks(const query *q, const double *breaks, size_t n, cprox_workspace *workspace) {
  const double t0 = q->t0, t1 = q->t1;
  for (size_t i = 0; i <= n; i++) {
    if (!(breaks[i] >= t0 && breaks[i] <= t1))
      return workspace_fail(workspace, CPROX_INVALID, "break %zu is %g, outside the mover's range [%g, %g]", i,
                            breaks[i], t0, t1);
    if (i > 0 && !(breaks[i] > breaks[i - 1]))
      return workspace_fail(workspace, CPROX_INVALID, "break %zu is %g, not above break %zu at %g", i, breaks[i], i - 1,
                            breaks[i - 1]);
  }
  return CPROX_OK;
}

/* The least clearance over [t0, t1], a piece at a time. What section_outward() adds to the interval is taken from the
 * width that is searched for. */
static cprox_status measure(query *q, double t0, double t1, double cutoff, size_t *piece,
                            cprox_profile_interval *interval) {
  const cprox_curve *curve = q->mover.curve;
  *interval = (cprox_profile_interval){
      .t0 = t0, .t1 = t1, .lower = INFINITY, .upper = INFINITY, .t = t0, .obstacle_index = -1, .mover_part = -1};
  const double epsilon = q->options.epsilon;
  cprox_status failure = CPROX_OK;
  while (*piece + 1 < curve->n_pieces && curve->breaks[*piece + 1] <= t0) (*piece)++;
  for (size_t i = *piece; i < curve->n_pieces && curve->breaks[i] < t1; i++) {
    const double from = fmax(t0, curve->breaks[i]), to = fmin(t1, curve->breaks[i + 1]);
    if (!(from < to)) continue;
    query_ask_section(q, i, from, to);
    const double outward = section_outward(curve, i);
    cprox_result r;
    q->options.epsilon = greater(0.0, epsilon - outward);
    const cprox_status status = query_answer(q, 0, q->n, lesser(interval->upper, cutoff), &r);
    q->options.epsilon = epsilon;
    if (status < 0) return status;
    if (status != CPROX_OK) failure = status;
    interval->lower = fmin(interval->lower, r.lower);
    r.upper += outward;
    if (r.upper < interval->upper) {
      interval->upper = r.upper;
      interval->t = fmin(fmax(r.t, t0), t1);
      interval->obstacle_index = r.obstacle_index;
      interval->mover_part = r.mover_part;
      interval->witness_mover = r.witness_mover, interval->witness_obstacle = r.witness_obstacle;
    }
  }
  CORE_CHECK(!(interval->lower > interval->upper), "lower %.17g, upper %.17g", interval->lower, interval->upper);
  const cprox_result all = {.lower = interval->lower, .upper = interval->upper};
  return failure == CPROX_OK && !query_is_satisfied(q, cutoff, &all) ? CPROX_PRECISION : failure;
}

/* The same of a robot, whose search knows of segments itself. */
static cprox_status measure_motion(query *q, double t0, double t1, double cutoff, cprox_profile_interval *interval) {
  q->t0 = t0, q->t1 = t1;
  cprox_result r;
  const cprox_status status = query_answer(q, 0, q->n, cutoff, &r);
  if (status < 0) return status;
  *interval = (cprox_profile_interval){.t0 = t0,
                                       .t1 = t1,
                                       .lower = r.lower,
                                       .upper = r.upper,
                                       .t = r.obstacle_index < 0 ? t0 : r.t,
                                       .obstacle_index = r.obstacle_index,
                                       .mover_part = r.mover_part,
                                       .witness_mover = r.witness_mover,
                                       .witness_obstacle = r.witness_obstacle};
  return status;
}

cprox_status list_profile(cprox_mover mover, const cprox_obstacle *targets, size_t n, const double *breaks,
                          size_t n_intervals, double horizon, const cprox_options *options, cprox_workspace *workspace,
                          cprox_profile_interval *intervals) {
  query q = query_create(mover, targets, n, -1.0, false, options, workspace);
  q.is_signed = q.options.signed_distance;
  cprox_status status =
      query_begin(&q, (arguments_query){"a clearance profile", ARGUMENTS_SEARCH | ARGUMENTS_SIGNED | ARGUMENTS_WHOLE});
  if (status != CPROX_OK) return status;
  if (!(horizon >= 0.0))
    return workspace_fail(workspace, CPROX_INVALID, "horizon is %g, must be 0 or more, or infinity", horizon);
  status = check_breaks(&q, breaks, n_intervals, workspace);
  if (status != CPROX_OK) return status;

  const double cutoff = query_cutoff_beyond(&q, horizon);
  size_t piece = 0;
  cprox_status failure = CPROX_OK;
  for (size_t i = 0; i < n_intervals; i++) {
    workspace_forget_work(workspace);
    status = mover.motion ? measure_motion(&q, breaks[i], breaks[i + 1], cutoff, &intervals[i])
                          : measure(&q, breaks[i], breaks[i + 1], cutoff, &piece, &intervals[i]);
    if (status < 0) return status;
    if (status != CPROX_OK) failure = status;
  }
  if (failure != CPROX_OK) workspace_fail(workspace, failure, "%s", query_shortfall(failure));
  return failure;
}
