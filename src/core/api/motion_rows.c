/* SPDX-License-Identifier: BSD-3-Clause */
/* The rows of a constraint: for each pair of a robot that comes near, its least distance on each interval of the motion
 * where it does, and the gradient there. */
#include <math.h>

#include "api/nearest_pairs.h"
#include "base/workspace.h"
#include "kinematics/motion.h"
#include "problem/obstacles.h"
#include "robot_query/answer.h"
#include "solve/motion_gradient.h"

typedef struct row_search {
  query q;
  const double *breaks;
  size_t n_intervals, per_pair;
  double horizon, cutoff; /* a search that ends at the cutoff has a lower bound above the horizon */
  cprox_motion_row *rows;
  size_t room, count;
  cprox_status failure;

  /* the interval that was looked at last and comes within the horizon; of the pair at hand, -1: none */
  int64_t seen;
  double seen_value, seen_at;
  bool seen_kept; /* the last row is of it */
} row_search;

/* ---- arguments ---- */

static cprox_status check(const row_search *s, const cprox_rows_query *asked, cprox_workspace *workspace) {
  if (!(s->horizon >= 0.0) || isinf(s->horizon))
    return workspace_fail(workspace, CPROX_INVALID, "the horizon is %g, must be 0 or more", s->horizon);
  if (s->per_pair == 0) return workspace_fail(workspace, CPROX_INVALID, "per_pair is 0: ask for at least one row");
  if (asked->breaks && asked->n_intervals == 0)
    return workspace_fail(workspace, CPROX_INVALID, "breaks are given, but n_intervals is 0");
  for (size_t i = 0; i <= s->n_intervals; i++) {
    if (!(s->breaks[i] >= s->q.t0 && s->breaks[i] <= s->q.t1))
      return workspace_fail(workspace, CPROX_INVALID, "break %zu is %g, outside the motion's time [%g, %g]", i,
                            s->breaks[i], s->q.t0, s->q.t1);
    if (i > 0 && !(s->breaks[i] > s->breaks[i - 1]))
      return workspace_fail(workspace, CPROX_INVALID, "break %zu is %g, not above break %zu at %g", i, s->breaks[i],
                            i - 1, s->breaks[i - 1]);
  }
  return CPROX_OK;
}

/* ---- one pair ---- */

static void swap_rows(cprox_motion_row *a, cprox_motion_row *b) {
  const cprox_motion_row kept = *a;
  *a = *b, *b = kept;
}

/* What a row is about: where depths are not known that of the hulls, whose gradient it has. */
static double value_of(const cprox_result *r) {
  return r->status == CPROX_OVERLAP ? r->lower : r->upper;
}

/* The row that was found last stays, unless it is nearest at the break to the interval before, which comes as near.
 * Where it is the other way round that one's row goes. */
static void keep_row(row_search *s) {
  cprox_motion_row *last = &s->rows[s->count];
  const double at = s->breaks[last->interval], t = last->result.t, value = value_of(&last->result);
  const bool joins = s->seen >= 0 && (size_t)s->seen + 1 == last->interval;
  const bool goes = joins && t <= at && s->seen_value <= value;
  const bool replaces = joins && !goes && s->seen_kept && s->seen_at >= at && value < s->seen_value;
  s->seen = (int64_t)last->interval, s->seen_value = value, s->seen_at = t, s->seen_kept = !goes;
  if (replaces)
    swap_rows(last - 1, last);
  else if (!goes)
    s->count++;
}

/* Nearest first, and no more than are wanted. */
static void rank_rows(row_search *s, size_t first) {
  for (size_t i = first + 1; i < s->count; i++)
    for (size_t k = i; k > first && value_of(&s->rows[k].result) < value_of(&s->rows[k - 1].result); k--)
      swap_rows(&s->rows[k], &s->rows[k - 1]);
  if (s->count > first + s->per_pair) s->count = first + s->per_pair;
}

static cprox_status find_row(row_search *s, const cprox_robot_pair *pair, size_t interval) {
  query *q = &s->q;
  const bool self = mover_is_self(&q->mover);
  const size_t obstacle = self ? 0 : (size_t)pair->other;
  q->t0 = s->breaks[interval], q->t1 = s->breaks[interval + 1];
  cprox_result near;
  workspace_forget_work(q->workspace);
  cprox_status status = robot_answer(q, obstacle, self ? 0 : obstacle + 1, s->cutoff, &near);
  if (status < 0 || near.lower > s->horizon) return status < 0 ? status : CPROX_OK;
  if (s->count == s->room) {
    s->failure = CPROX_BUDGET;
    return CPROX_OK;
  }
  cprox_motion_row *row = &s->rows[s->count];
  status = motion_gradient_of(q, obstacle, self ? 0 : obstacle + 1, &row->result, &row->gradient);
  if (status < 0) return status;
  if (status != CPROX_OK && status != CPROX_OVERLAP) s->failure = status;
  if (row->result.lower > s->horizon) return CPROX_OK;
  row->interval = interval;
  row->result.mover_part = pair->geometry, row->result.obstacle_index = pair->other;
  if (isfinite(row->gradient.t)) row->result.t = row->gradient.t;
  row->result.t = fmin(fmax(row->result.t, q->t0), q->t1); /* intervals are rounded outwards */
  keep_row(s);
  return CPROX_OK;
}

static cprox_status find_rows(row_search *s, const cprox_robot_pair *pair) {
  query *q = &s->q;
  const bool self = mover_is_self(&q->mover);
  const size_t obstacle = self ? 0 : (size_t)pair->other, first = s->count;
  q->mover.pairs = pair, q->mover.n_pairs = 1;
  s->seen = -1;
  q->t0 = s->breaks[0], q->t1 = s->breaks[s->n_intervals];
  cprox_result all;
  workspace_forget_work(q->workspace);
  cprox_status status = robot_answer(q, obstacle, self ? 0 : obstacle + 1, s->cutoff, &all);
  if (status < 0 || all.lower > s->horizon) return status < 0 ? status : CPROX_OK;
  for (size_t i = 0; i < s->n_intervals && s->failure != CPROX_STOPPED && status >= 0; i++)
    status = find_row(s, pair, i);
  rank_rows(s, first);
  return status < 0 ? status : CPROX_OK;
}

/* ---- the query ---- */

cprox_status cprox_robot_rows(const cprox_obstacles *obstacles, cprox_mover mover, const cprox_rows_query *asked,
                              const cprox_options *options, cprox_workspace *workspace, cprox_motion_row *rows,
                              size_t room, size_t *count) {
  WORKSPACE_USE(workspace);
  row_search s = {.rows = rows, .room = room, .failure = CPROX_OK};
  s.q = query_create(mover, obstacles_list(obstacles), obstacles_count(obstacles), -1.0, options, workspace);
  query *q = &s.q;
  q->is_signed = q->options.signed_distance;
  cprox_status status = query_begin(q, (arguments_query){"the rows of a robot", ARGUMENTS_SEARCH | ARGUMENTS_SIGNED});
  if (status != CPROX_OK) return status;
  if (!mover.motion)
    return workspace_fail(workspace, CPROX_INVALID, "rows are those of a robot's motion, and the mover is none");
  if (!asked || !count || (!rows && room > 0))
    return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", !asked ? "asked" : !count ? "count" : "rows");
  s.horizon = asked->horizon, s.per_pair = asked->per_pair;
  s.breaks = asked->breaks, s.n_intervals = asked->n_intervals;
  if (!s.breaks) s.breaks = mover.motion->times, s.n_intervals = mover.motion->n_segments;
  status = check(&s, asked, workspace);
  if (status != CPROX_OK) return status;
  s.cutoff = query_cutoff_beyond(q, s.horizon);

  const cprox_robot_pair *pairs = mover.pairs;
  size_t n = mover.n_pairs;
  if (!pairs) {
    n = robot_pairs_list(q, NULL);
    cprox_robot_pair *listed = workspace_reserve(workspace, WORKSPACE_RANKING, (n + 1) * sizeof *listed);
    if (!listed) return workspace_fail(workspace, CPROX_MEMORY, "no memory for a list of pairs");
    robot_pairs_list(q, listed);
    pairs = listed;
  }
  for (size_t i = 0; i < n && s.failure != CPROX_STOPPED; i++) {
    status = find_rows(&s, &pairs[i]);
    if (status < 0) return status;
  }
  *count = s.count;
  workspace_clear(workspace);
  if (s.failure != CPROX_OK)
    workspace_fail(workspace, s.failure, "%s",
                   s.count == room ? "there may be more rows than there is room for" : query_shortfall(s.failure));
  return s.failure;
}
