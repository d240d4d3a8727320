/* SPDX-License-Identifier: BSD-3-Clause */
/* The clearance profile: the same query about one interval of the curve after the other. */
#include <math.h>

#include "base/check.h"
#include "base/workspace.h"
#include "kinematics/motion.h"
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
    const cprox_status status = solve_query(q, 0, q->n, lesser(interval->upper, cutoff), &r);
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

/* Of two links that stand still against each other, and move together: where their witness points are at a time. */
static void carry_witnesses(const query *q, double t, cprox_result *r) {
  const bool whole = mover_is_whole(&q->mover) && r->obstacle_index >= (int32_t)q->n;
  if (!mover_is_self(&q->mover) && !whole) return;
  const cprox_motion *m = q->mover.motion;
  const size_t link = (size_t)m->robot->given_geometries[r->mover_part].link;
  double *values = workspace_reserve(q->workspace, WORKSPACE_RANKING, (m->robot->n_variables + 1) * sizeof *values);
  if (!values) return;
  vec3 at[2];
  double turned[2][9];
  for (int k = 0; k < 2; k++) {
    cprox_motion_evaluate(m, k ? t : r->t, values);
    cprox_robot_link_frame(m->robot, values, link, &at[k], turned[k]);
  }
  vec3 *const points[2] = {&r->witness_mover, &r->witness_obstacle};
  for (int k = 0; k < 2; k++) {
    const vec3 d = vec_sub(*points[k], at[0]);
    const double *from = turned[0], *to = turned[1];
    const double own[3] = {from[0] * d.x + from[3] * d.y + from[6] * d.z, from[1] * d.x + from[4] * d.y + from[7] * d.z,
                           from[2] * d.x + from[5] * d.y + from[8] * d.z};
    *points[k] = vec_add(
        at[1], vec(to[0] * own[0] + to[1] * own[1] + to[2] * own[2], to[3] * own[0] + to[4] * own[1] + to[5] * own[2],
                   to[6] * own[0] + to[7] * own[1] + to[8] * own[2]));
  }
  r->t = t;
}

/* The same of a robot, whose search knows of segments itself. standing: the answer of the pairs that stand still
 * against each other, the same at all times. */
static cprox_status measure_motion(query *q, double t0, double t1, double cutoff, const cprox_result *standing,
                                   cprox_profile_interval *interval) {
  q->t0 = t0, q->t1 = t1;
  cprox_result r;
  const cprox_status status = solve_query(q, 0, q->n, lesser(standing->upper, cutoff), &r);
  if (status < 0) return status;
  if (standing->upper < r.upper) {
    cprox_result there = *standing;
    carry_witnesses(q, t0, &there);
    there.t = t0;
    query_join(&r, &there);
  }
  r.lower = lesser(r.lower, standing->lower);
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

/* An interval that a stopped profile does not come to: nothing is known of it. */
static cprox_profile_interval unmeasured(const query *q, double t0, double t1) {
  return (cprox_profile_interval){.t0 = t0,
                                  .t1 = t1,
                                  .lower = q->is_signed ? -INFINITY : 0.0,
                                  .upper = INFINITY,
                                  .t = t0,
                                  .obstacle_index = -1,
                                  .mover_part = -1};
}

cprox_status list_profile(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, const double *breaks,
                          size_t n_intervals, double horizon, const cprox_options *options, cprox_workspace *workspace,
                          cprox_profile_interval *intervals) {
  query q = query_create(mover, obstacles, n, -1.0, options, workspace);
  q.is_signed = q.options.signed_distance;
  cprox_status status =
      query_begin(&q, (arguments_query){"a clearance profile",
                                        ARGUMENTS_SEARCH | ARGUMENTS_SIGNED | ARGUMENTS_WHOLE | ARGUMENTS_RADIUS});
  if (status != CPROX_OK) return status;
  if (!(horizon >= 0.0))
    return workspace_fail(workspace, CPROX_INVALID, "horizon is %g, must be 0 or more, or infinity", horizon);
  status = check_breaks(&q, breaks, n_intervals, workspace);
  if (status != CPROX_OK) return status;

  const double cutoff = query_cutoff_beyond(&q, horizon);
  size_t piece = 0;
  cprox_status failure = CPROX_OK;
  cprox_result standing = query_nothing();
  /* of one clock; of several, each interval asks about all pairs */
  if (mover.motion && !mover.motion->is_state && mover.motion->n_tracks == 1) {
    q.choice = PAIRS_STANDING;
    failure = solve_query(&q, 0, q.n, cutoff, &standing);
    if (failure < 0) return failure;
    q.choice = PAIRS_MOVING;
  }
  for (size_t i = 0; i < n_intervals; i++) {
    if (failure == CPROX_STOPPED) {
      intervals[i] = unmeasured(&q, breaks[i], breaks[i + 1]);
      continue;
    }
    workspace_forget_work(workspace);
    status = mover.motion ? measure_motion(&q, breaks[i], breaks[i + 1], cutoff, &standing, &intervals[i])
                          : measure(&q, breaks[i], breaks[i + 1], cutoff, &piece, &intervals[i]);
    if (status < 0) return status;
    if (status != CPROX_OK) failure = status;
  }
  if (failure != CPROX_OK) workspace_fail(workspace, failure, "%s", query_shortfall(failure));
  return failure;
}
