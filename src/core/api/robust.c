/* SPDX-License-Identifier: BSD-3-Clause */
/* Queries that answer for every execution of a robot's motion within bounds of its errors. doc/robust.md */
#include <math.h>

#include "api/obstacle_bvh.h"
#include "base/workspace.h"
#include "broadphase/obstacle_set.h"
#include "problem/obstacles.h"
#include "problem/validate.h"
#include "robot_query/answer.h"
#include "robot_query/deviation.h"
#include "solve/robot_verdict.h"

/* ---- arguments ---- */

static cprox_status check_list(const char *name, const double *list, size_t n, cprox_workspace *workspace) {
  for (size_t i = 0; list && i < n; i++) {
    if (list[i] >= 0.0 && list[i] <= LENGTH_MOST) continue;
    return workspace_fail(workspace, CPROX_INVALID, "%s error of variable %zu is %g, must be 0 to %g", name, i, list[i],
                          LENGTH_MOST);
  }
  return CPROX_OK;
}

/* Joints of several variables have no bound of each. */
static cprox_status check_joints(const cprox_robot *robot, const cprox_error_bounds *b, cprox_workspace *workspace) {
  const double *const lists[] = {b->tracking, b->speed, b->acceleration};
  for (size_t link = 0; link < robot->n_links; link++) {
    const cprox_joint_type type = robot->given_links[link].type;
    const int32_t n = type == CPROX_JOINT_FLOATING ? 7 : type == CPROX_JOINT_ROTATION_VECTOR ? 6 : 0;
    for (int32_t i = 0; i < n; i++) {
      const int32_t variable = robot->given_links[link].variable + i;
      for (int k = 0; k < 3; k++)
        if (lists[k] && lists[k][variable] != 0.0)
          return workspace_fail(workspace, CPROX_INVALID,
                                "variable %d has an error, but belongs to a floating joint: bound its pose by "
                                "base_position and base_rotation",
                                (int)variable);
    }
  }
  return CPROX_OK;
}

static cprox_status check_bounds(const cprox_mover *mover, const cprox_error_bounds *b, cprox_workspace *workspace) {
  if (!b) return workspace_fail(workspace, CPROX_INVALID, "bounds is NULL: errors are bounded by cprox_error_bounds");
  const size_t n = mover->motion->robot->n_variables;
  const bool lists = b->tracking || b->speed || b->acceleration;
  if (lists && b->n_variables != n)
    return workspace_fail(workspace, CPROX_INVALID, "errors of %zu variables are given, the robot has %zu",
                          b->n_variables, n);
  if (!vec_finite(b->base_origin)) return workspace_fail(workspace, CPROX_INVALID, "base_origin is not finite");
  cprox_status status = check_list("tracking", b->tracking, n, workspace);
  if (status == CPROX_OK) status = check_list("speed", b->speed, n, workspace);
  if (status == CPROX_OK) status = check_list("acceleration", b->acceleration, n, workspace);
  const struct {
    const char *name;
    double value;
  } numbers[] = {{"timing", b->timing},
                 {"base_position", b->base_position},
                 {"base_rotation", b->base_rotation},
                 {"object_position", b->object_position},
                 {"object_rotation", b->object_rotation},
                 {"sensor", b->sensor},
                 {"flex", b->flex}};
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers && status == CPROX_OK; i++)
    status = validate_length(numbers[i].name, numbers[i].value, workspace);
  if (status == CPROX_OK) status = check_joints(mover->motion->robot, b, workspace);
  return status;
}

/* ---- one search ---- */

/* The query, checked and about its interval; `errors` NULL: about the motion itself. */
static cprox_status begin(query *q, const cprox_obstacles *obstacles, const cprox_error_bounds *bounds,
                          robot_errors *errors) {
  const arguments_query asked = {"a robust query", ARGUMENTS_SEARCH | ARGUMENTS_INTERVAL | ARGUMENTS_WHOLE};
  const obstacle_bvh *set = obstacles ? obstacles->bvh : NULL;
  cprox_status status = set ? bvh_begin(set, q, asked) : query_begin(q, asked);
  if (status != CPROX_OK) return status;
  if (!q->mover.motion)
    return workspace_fail(q->workspace, CPROX_INVALID, "the mover is no robot: errors are those of a robot's motion");
  if (q->mover.motion->n_tracks != 1)
    return workspace_fail(q->workspace, CPROX_INVALID,
                          "the motion is a joined one: errors are those of one robot among what stands");
  status = check_bounds(&q->mover, bounds, q->workspace);
  if (status != CPROX_OK) return status;
  const cprox_motion_info info = cprox_motion_get_info(q->mover.motion);
  q->t0 = greater(q->t0 - bounds->timing, info.t0), q->t1 = lesser(q->t1 + bounds->timing, info.t1);
  for (size_t i = 0; q->set && i < q->n; i++) {
    const double reach = obstacle_reach(&q->obstacles[i]);
    if (isfinite(reach)) errors->object_size = greater(reach, errors->object_size);
  }
  return CPROX_OK;
}

static cprox_status ask(query *q, robot_errors *errors, double scale, cprox_result *result) {
  errors->scale = scale;
  q->errors = errors;
  workspace_forget_work(q->workspace);
  return robot_answer(q, 0, q->n, INFINITY, result);
}

/* The motion itself. */
static cprox_status ask_plain(query *q, cprox_result *result) {
  q->errors = NULL;
  workspace_forget_work(q->workspace);
  return robot_verdict(q, 0, q->n, INFINITY, result);
}

/* ---- the queries ---- */

static query query_of(const cprox_obstacles *obstacles, cprox_mover mover, double limit, const cprox_options *options,
                      cprox_workspace *workspace) {
  return query_create(mover, obstacles_list(obstacles), obstacles_count(obstacles), limit, options, workspace);
}

cprox_status cprox_robust_distance(const cprox_obstacles *obstacles, cprox_mover mover,
                                   const cprox_error_bounds *bounds, const cprox_options *options,
                                   cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  query q = query_of(obstacles, mover, -1.0, options, workspace);
  robot_errors errors = {.bounds = bounds};
  const cprox_status status = begin(&q, obstacles, bounds, &errors);
  return status == CPROX_OK ? ask(&q, &errors, 1.0, result) : status;
}

cprox_status cprox_robust_tolerance(const cprox_obstacles *obstacles, cprox_mover mover, double delta,
                                    const cprox_error_bounds *bounds, const cprox_options *options,
                                    cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  query q = query_of(obstacles, mover, delta, options, workspace);
  robot_errors errors = {.bounds = bounds};
  cprox_status status = validate_delta(delta, workspace);
  if (status == CPROX_OK) status = begin(&q, obstacles, bounds, &errors);
  if (status != CPROX_OK) return status;
  cprox_result robust, plain;
  q.errors = &errors, errors.scale = 1.0;
  workspace_forget_work(q.workspace);
  status = robot_verdict(&q, 0, q.n, INFINITY, &robust);
  if (status < 0) return status;
  if (robust.verdict != CPROX_VERDICT_CLEAR) {
    const cprox_status of_motion = ask_plain(&q, &plain);
    if (of_motion < 0) return of_motion;
    const bool violated = plain.verdict == CPROX_VERDICT_VIOLATED;
    plain.nodes += robust.nodes, plain.distance_queries += robust.distance_queries;
    robust.nodes = plain.nodes, robust.distance_queries = plain.distance_queries;
    if (violated) robust = plain;
    if (!violated) robust.verdict = CPROX_VERDICT_UNDECIDED;
  }
  if (robust.status == CPROX_OK) workspace_clear(workspace);
  *result = robust;
  return robust.status;
}

/* ---- the largest scale ---- */

enum { MOST_VERDICTS = 8 };

/* The interval of the scale is narrow enough below this ratio of its ends. */
static const double SCALE_RATIO = 0.99;

static bool bounds_are_zero(const cprox_error_bounds *b, size_t n) {
  double sum = b->base_position + b->base_rotation + b->object_position + b->object_rotation + b->sensor + b->flex;
  const double *const lists[] = {b->tracking, b->speed, b->acceleration};
  for (int k = 0; k < 3; k++)
    for (size_t i = 0; lists[k] && i < n; i++) sum += lists[k][i];
  return !(sum > 0.0);
}

/* Where the pair that was measured is at the limit where it was measured, if what errors take off grows with the scale;
 * it grows no slower. */
static double scale_at_sample(const robot_errors *errors, double delta) {
  if (!(errors->loss > 0.0)) return INFINITY;
  return greater(errors->scale * (1.0 + (errors->left - delta) / errors->loss), 0.0);
}

/* What is known while the search lasts; `guess`: the scale is near this, or less. */
typedef struct scale_search {
  double certified, refused, guess;
} scale_search;

/* Where to look next: on either side of the guess, as long as that falls fast or is confirmed; else half-way. */
static double next_scale(const scale_search *s, double before) {
  const double guess = lesser(s->guess, s->refused);
  if (!isfinite(guess)) return 4.0 * s->certified;
  if (s->certified >= 0.98 * guess && 1.004 * guess < s->refused) return 1.004 * guess;
  if (guess < 0.7 * before || s->certified > 0.9 * guess) return 0.996 * guess;
  return s->certified > 0.0 ? sqrt(s->certified * guess) : 0.5 * guess;
}

static cprox_status find_scale(query *q, robot_errors *errors, cprox_robust_scale *found) {
  double scale = 1.0;
  scale_search s = {.refused = INFINITY, .guess = INFINITY};
  cprox_status status = CPROX_OK;
  while (status != CPROX_STOPPED && found->n_verdicts < MOST_VERDICTS && !(s.certified >= SCALE_RATIO * s.refused)) {
    cprox_result r;
    status = ask(q, errors, scale, &r);
    if (status < 0) return status;
    const double before = lesser(s.guess, s.refused), here = scale_at_sample(errors, q->limit);
    const bool clear = r.verdict == CPROX_VERDICT_CLEAR;
    found->n_verdicts++;
    found->nodes += r.nodes, found->distance_queries += r.distance_queries;
    if (clear) s.certified = greater(scale, s.certified);
    /* beyond what is clear the losses of a pair grow as fast as the scale at least: there it is refused */
    s.refused = greater(lesser(s.refused, clear ? here : scale), s.certified);
    s.guess = greater(lesser(s.guess, here), s.certified);
    if (!clear || found->n_verdicts == 1) found->limit = r;
    scale = next_scale(&s, before);
  }
  found->certified = s.certified, found->refused = s.refused;
  return status == CPROX_STOPPED ? status : CPROX_OK;
}

cprox_status cprox_robust_find_scale(const cprox_obstacles *obstacles, cprox_mover mover, double delta,
                                     const cprox_error_bounds *bounds, const cprox_options *options,
                                     cprox_workspace *workspace, cprox_robust_scale *scale) {
  WORKSPACE_USE(workspace);
  query q = query_of(obstacles, mover, delta, options, workspace);
  robot_errors errors = {.bounds = bounds};
  cprox_status status = validate_delta(delta, workspace);
  if (status == CPROX_OK) status = begin(&q, obstacles, bounds, &errors);
  if (status != CPROX_OK) return status;
  cprox_robust_scale found = {.refused = INFINITY};
  status = ask_plain(&q, &found.limit);
  if (status < 0) return status;
  found.verdict = found.limit.verdict;
  found.nodes = found.limit.nodes, found.distance_queries = found.limit.distance_queries;
  if (found.verdict != CPROX_VERDICT_CLEAR) {
    found.refused = 0.0;
  } else if (bounds_are_zero(bounds, mover.motion->robot->n_variables)) {
    found.certified = INFINITY;
  } else {
    status = find_scale(&q, &errors, &found);
    if (status < 0) return status;
    if (!(found.certified > 0.0)) found.verdict = CPROX_VERDICT_UNDECIDED;
  }
  if (status == CPROX_OK) workspace_clear(workspace);
  *scale = found;
  return status;
}
