/* SPDX-License-Identifier: BSD-3-Clause */
/* Many states of a robot: each is a motion that stands still. */
#include "api/obstacle_bvh.h"
#include "base/workspace.h"
#include "curve_proximity/cprox/obstacles.h"
#include "curve_proximity/cprox/robot.h"
#include "kinematics/motion.h"
#include "problem/obstacles.h"
#include "problem/problem.h"
#include "solve/solve.h"

/* ---- distances ---- */

static cprox_status distance(const cprox_state_query *q, const cprox_obstacles *obstacles, cprox_mover mover,
                             cprox_workspace *workspace, cprox_result *result) {
  return WORKSPACE_LEND(workspace, cprox_obstacles_distance(obstacles, mover, q->options, workspace, result, NULL));
}

/* To obstacles, then to itself: of both the witnesses are found, the nearer one is reported. */
static cprox_status ask_distance(const cprox_state_query *q, const cprox_motion *state, cprox_workspace *workspace,
                                 cprox_result *result, bool *about_self) {
  *about_self = false;
  *result = query_nothing();
  cprox_status status = CPROX_OK;
  if (q->obstacles)
    status = distance(q, q->obstacles, cprox_robot_along(state, q->pairs, q->n_pairs), workspace, result);
  if (status < 0 || q->without_self) return status;
  cprox_result self;
  const cprox_status of_self =
      distance(q, NULL, cprox_robot_self(state, q->self_pairs, q->n_self_pairs), workspace, &self);
  if (of_self < 0) return of_self;
  *about_self = self.upper < result->upper;
  const cprox_result other = *about_self ? *result : self;
  if (*about_self) *result = self;
  result->lower = lesser(other.lower, result->lower);
  result->nodes += other.nodes;
  result->distance_queries += other.distance_queries;
  if (other.lod > result->lod) result->lod = other.lod;
  if (status == CPROX_OK) status = of_self;
  result->status = status;
  return status;
}

/* ---- verdicts ---- */

/* One query for all states: only the state changes. */
static cprox_status begin_verdicts(const cprox_state_query *asked, const cprox_motion *state,
                                   cprox_workspace *workspace, query *q) {
  const cprox_mover along = cprox_robot_along(state, asked->pairs, asked->n_pairs);
  const cprox_mover mover = asked->without_self ? along
                            : asked->obstacles  ? cprox_robot_whole(along, asked->self_pairs, asked->n_self_pairs)
                                                : cprox_robot_self(state, asked->self_pairs, asked->n_self_pairs);
  const bool is_tolerance = asked->delta != 0.0;
  const cprox_status checked = is_tolerance ? validate_delta(asked->delta, workspace) : CPROX_OK;
  if (checked != CPROX_OK) return checked;
  const obstacle_bvh *bvh = asked->obstacles ? asked->obstacles->bvh : NULL;
  *q = query_create(mover, obstacles_list(asked->obstacles), obstacles_count(asked->obstacles), asked->delta,
                    asked->options, workspace);
  q->is_bare = true;
  const arguments_query has = {is_tolerance ? "tolerance of states" : "collision of states",
                               ARGUMENTS_SEARCH | ARGUMENTS_WHOLE | ARGUMENTS_INTERVAL | ARGUMENTS_RADIUS};
  return bvh ? bvh_begin(bvh, q, has) : query_begin(q, has);
}

static cprox_status ask_verdict(const cprox_state_query *asked, query *q, cprox_result *result, bool *about_self) {
  *about_self = false;
  *result = query_nothing();
  result->verdict = CPROX_VERDICT_CLEAR;
  if (!asked->obstacles && asked->without_self) return CPROX_OK;
  workspace_clear(q->workspace);
  const cprox_status status = solve_query(q, 0, q->n, INFINITY, result);
  q->is_repeated = true;
  if (status < 0) return status;
  const int32_t others = mover_is_whole(&q->mover) ? (int32_t)q->n : 0;
  *about_self = result->obstacle_index >= others && !asked->without_self && result->obstacle_index >= 0;
  if (*about_self) result->obstacle_index -= others;
  return status;
}

cprox_status cprox_robot_ask_states(const cprox_robot *robot, const cprox_state_query *asked, const double *states,
                                    size_t n, cprox_workspace *workspace, cprox_result *results, bool *about_self) {
  WORKSPACE_USE(workspace);
  if (!workspace) return CPROX_INVALID;
  workspace_clear(workspace);
  if (!robot || !asked) return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", robot ? "asked" : "robot");
  if (n > 0 && (!states || !results))
    return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", states ? "results" : "states");
  if (n == 0) return CPROX_OK;
  const cprox_motion_description description = {.kind = CPROX_MOTION_STATE, .rest = states};
  cprox_motion *state = NULL;
  cprox_status worst = WORKSPACE_LEND(workspace, cprox_motion_create(robot, &description, workspace, &state));
  const size_t width = worst < 0 ? 0 : cprox_motion_get_info(state).n_variables;
  query verdicts = {.workspace = workspace};
  if (worst >= 0 && !asked->distance) worst = begin_verdicts(asked, state, workspace, &verdicts);
  for (size_t i = 0; i < n && worst >= 0; i++) {
    bool self = false;
    cprox_result found;
    cprox_status status = i > 0 ? motion_set_state(state, states + i * width, workspace) : CPROX_OK;
    if (status >= 0)
      status = asked->distance ? ask_distance(asked, state, workspace, &found, &self)
                               : ask_verdict(asked, &verdicts, &found, &self);
    if (status < 0 || worst == CPROX_OK) worst = status;
    if (status < 0) break;
    results[i] = found;
    if (about_self) about_self[i] = self;
  }
  cprox_motion_free(state);
  return worst;
}
