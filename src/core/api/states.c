/* SPDX-License-Identifier: BSD-3-Clause */
/* Many states of a robot: each is a motion that stands still. */
#include "base/workspace.h"
#include "curve_proximity/cprox/obstacles.h"
#include "curve_proximity/cprox/robot.h"
#include "kinematics/motion.h"
#include "problem/problem.h"

static cprox_status ask(const cprox_state_query *q, const cprox_obstacles *obstacles, cprox_mover mover,
                        cprox_workspace *workspace, cprox_result *result) {
  if (q->distance)
    return WORKSPACE_LEND(workspace, cprox_obstacles_distance(obstacles, mover, q->options, workspace, result, NULL));
  if (q->delta == 0.0)
    return WORKSPACE_LEND(workspace, cprox_obstacles_collision(obstacles, mover, q->options, workspace, result, NULL));
  return WORKSPACE_LEND(workspace,
                        cprox_obstacles_tolerance(obstacles, mover, q->delta, q->options, workspace, result, NULL));
}

/* The less favourable of two verdicts; undecided is between the others. */
static cprox_verdict worse(cprox_verdict a, cprox_verdict b) {
  if (a == CPROX_VERDICT_VIOLATED || b == CPROX_VERDICT_VIOLATED) return CPROX_VERDICT_VIOLATED;
  return a == CPROX_VERDICT_UNDECIDED ? a : b;
}

static cprox_status ask_state(const cprox_state_query *q, const cprox_motion *state, cprox_workspace *workspace,
                              cprox_result *result, bool *about_self) {
  *about_self = false;
  *result = query_nothing();
  result->verdict = q->distance ? CPROX_VERDICT_UNDECIDED : CPROX_VERDICT_CLEAR;
  cprox_status status = CPROX_OK;
  if (q->obstacles) status = ask(q, q->obstacles, cprox_robot_along(state, q->pairs, q->n_pairs), workspace, result);
  if (status < 0 || q->without_self || (!q->distance && result->verdict == CPROX_VERDICT_VIOLATED)) return status;
  cprox_result self;
  const cprox_status of_self = ask(q, NULL, cprox_robot_self(state, q->self_pairs, q->n_self_pairs), workspace, &self);
  if (of_self < 0) return of_self;
  const cprox_verdict verdict = worse(result->verdict, self.verdict);
  *about_self =
      self.upper < result->upper || (!q->distance && self.verdict != result->verdict && self.verdict == verdict);
  const cprox_result other = *about_self ? *result : self;
  if (*about_self) *result = self;
  result->verdict = verdict;
  result->lower = other.lower < result->lower ? other.lower : result->lower;
  result->upper = other.upper < result->upper ? other.upper : result->upper;
  result->nodes += other.nodes;
  result->distance_queries += other.distance_queries;
  if (other.lod > result->lod) result->lod = other.lod;
  if (status == CPROX_OK) status = of_self;
  result->status = status;
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
  for (size_t i = 0; i < n && worst >= 0; i++) {
    bool self = false;
    cprox_result found;
    cprox_status status = i > 0 ? motion_set_state(state, states + i * width, workspace) : CPROX_OK;
    if (status >= 0) status = ask_state(asked, state, workspace, &found, &self);
    if (status < 0 || worst == CPROX_OK) worst = status;
    if (status < 0) break;
    results[i] = found;
    if (about_self) about_self[i] = self;
  }
  cprox_motion_free(state);
  return worst;
}
