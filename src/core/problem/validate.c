/* SPDX-License-Identifier: BSD-3-Clause */
#include "problem/validate.h"

#include <math.h>
#include <stdio.h>

#include "base/frame.h"
#include "base/rounding.h"
#include "base/workspace.h"
#include "curve/curve.h"
#include "kinematics/link_model.h"
#include "kinematics/motion.h"
#include "problem/level_of_detail.h"
#include "problem/radius.h"
#include "shape/body.h"

cprox_status validate_length(const char *name, double value, cprox_workspace *workspace) {
  if (!(value >= 0.0 && isfinite(value)))
    return workspace_fail(workspace, CPROX_INVALID, "%s is %g, must be finite and 0 or more", name, value);
  if (value > LENGTH_MOST)
    return workspace_fail(workspace, CPROX_INVALID, "%s is %g, must be at most %g", name, value, LENGTH_MOST);
  return CPROX_OK;
}

/* An option that is set and that the query does not have is refused: the answer would not be what was asked for. */
static cprox_status check_applies(const cprox_options *options, arguments_query asked, cprox_workspace *workspace) {
  const bool level = options->max_lod != CPROX_LOD_NONE && options->max_lod != CPROX_LOD_MESH;
  const unsigned set = (options->signed_distance ? ARGUMENTS_SIGNED : 0u) |
                       (options->certificate ? ARGUMENTS_CERTIFICATE : 0u) | (options->stop ? ARGUMENTS_STOP : 0u) |
                       (options->relative_epsilon != 0.0 ? ARGUMENTS_RELATIVE : 0u) | (level ? ARGUMENTS_LOD : 0u) |
                       (options->interval ? ARGUMENTS_INTERVAL : 0u) | (options->share ? ARGUMENTS_SHARE : 0u) |
                       (options->start ? ARGUMENTS_START : 0u);
  const unsigned wrong = set & ~(unsigned)asked.has;
  if (!wrong) return CPROX_OK;
  static const struct {
    arguments_option option;
    const char *name, *hint;
  } all[] = {
      {ARGUMENTS_SIGNED, "signed_distance", "it is an option of distance queries"},
      {ARGUMENTS_CERTIFICATE, "certificate", "ask about one mover by distance, tolerance or collision for that"},
      {ARGUMENTS_STOP, "stop", "it is short and does not poll"},
      {ARGUMENTS_RELATIVE, "relative_epsilon", "set epsilon alone"},
      {ARGUMENTS_LOD, "max_lod", "bodies answer as they are"},
      {ARGUMENTS_INTERVAL, "interval", "it is an option of distance, tolerance, collision and time of contact"},
      {ARGUMENTS_SHARE, "share", "it is an option of distance queries"},
      {ARGUMENTS_START, "start", "it is an option of cprox_pair()"},
  };
  size_t first = 0;
  while (!(wrong & (unsigned)all[first].option)) first++;
  return workspace_fail(workspace, CPROX_INVALID, "%s does not apply to %s: %s", all[first].name, asked.name,
                        all[first].hint);
}

cprox_options validate_defaults(const cprox_options *options) {
  cprox_options copy = CPROX_OPTIONS_DEFAULT;
  if (options && options->size == sizeof copy)
    copy = *options;
  else if (options)
    copy.size = options->size;
  return copy;
}

cprox_status validate_options(const cprox_options *options, arguments_query asked, cprox_workspace *workspace) {
  if (options->size != sizeof *options)
    return workspace_fail(workspace, CPROX_INVALID,
                          "options.size is %zu, this library knows %zu: start from CPROX_OPTIONS_DEFAULT, and compile "
                          "with the headers of libcprox %s",
                          options->size, sizeof *options, cprox_version());
  cprox_status status = validate_length("epsilon", options->epsilon, workspace);
  if (status == CPROX_OK) status = validate_length("relative_epsilon", options->relative_epsilon, workspace);
  if (status != CPROX_OK) return status;
  if (options->max_nodes == 0)
    return workspace_fail(workspace, CPROX_INVALID, "max_nodes is 0: a query needs a budget of at least 1 node");
  if ((int)options->max_lod < CPROX_LOD_NONE || options->max_lod > CPROX_LOD_MESH)
    return workspace_fail(workspace, CPROX_INVALID, "max_lod is %d, must be sphere, hull or mesh",
                          (int)options->max_lod);
  return check_applies(options, asked, workspace);
}

cprox_status validate_delta(double delta, cprox_workspace *workspace) {
  return validate_length("delta", delta, workspace);
}

cprox_status validate_obstacle(const cprox_obstacle *obstacle, size_t index, cprox_workspace *workspace) {
  if (!obstacle->body && !obstacle->curve)
    return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu has neither a body nor a curve", index);
  if (obstacle->synchronized && !obstacle->curve)
    return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu is on the mover's clock, but has no curve", index);
  if (obstacle->body && obstacle->curve && !obstacle->synchronized)
    return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu has both a body and a curve", index);
  if (obstacle->radius_curve && !obstacle->synchronized)
    return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu has a radius that changes, but is not synchronized",
                          index);
  const char *support_failed = frame_pose_error(&obstacle->pose);
  if (support_failed) return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu: %s", index, support_failed);
  if (!(obstacle->margin >= 0.0 && isfinite(obstacle->margin)))
    return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu: margin is %g, must be finite and 0 or more", index,
                          obstacle->margin);
  if (obstacle->margin > LENGTH_MOST)
    return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu: margin is %g, must be at most %g", index,
                          obstacle->margin, LENGTH_MOST);
  if (obstacle->body && !body_is_in_reach(obstacle->body))
    return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu: the body reaches farther than %g m", index,
                          LENGTH_MOST);
  if (obstacle->curve && !obstacle->curve->in_reach)
    return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu: the curve reaches farther than %g m", index,
                          LENGTH_MOST);
  return CPROX_OK;
}

cprox_status validate_obstacles(const cprox_obstacle *obstacles, size_t n, cprox_workspace *workspace) {
  if (n > 0 && !obstacles)
    return workspace_fail(workspace, CPROX_INVALID, "obstacles is NULL, but %zu are announced", n);
  if (n > INT32_MAX) return workspace_fail(workspace, CPROX_INVALID, "%zu obstacles are more than 2147483647", n);
  for (size_t i = 0; i < n; i++) {
    const cprox_status obstacle = validate_obstacle(&obstacles[i], i, workspace);
    if (obstacle != CPROX_OK) return obstacle;
  }
  return CPROX_OK;
}

/* What is synchronized must run over the same time. */
static cprox_status check_clock(const cprox_curve *curve, const cprox_obstacle *obstacle, size_t index,
                                cprox_workspace *workspace) {
  if (!curve || !obstacle->synchronized) return CPROX_OK;
  if (curve->arcs || obstacle->curve->arcs)
    return workspace_fail(
        workspace, CPROX_INVALID,
        "obstacle %zu is on the mover's clock, but of one of the two curves only the arc length is known", index);
  const double t0 = curve->breaks[0], t1 = curve->breaks[curve->n_pieces];
  const double u0 = obstacle->curve->breaks[0], u1 = obstacle->curve->breaks[obstacle->curve->n_pieces];
  if (t0 == u0 && t1 == u1) return CPROX_OK;
  return workspace_fail(
      workspace, CPROX_INVALID,
      "obstacle %zu is on the mover's clock, but its curve runs over [%.17g, %.17g] and the mover's over "
      "[%.17g, %.17g]",
      index, u0, u1, t0, t1);
}

static cprox_status check_pairs(const cprox_mover *mover, const cprox_robot_pair *pairs, size_t n_pairs, bool self,
                                size_t n, cprox_workspace *workspace) {
  const size_t geometries = mover->motion->robot->n_geometries, others = self ? geometries : n;
  for (size_t i = 0; pairs && i < n_pairs; i++) {
    const cprox_robot_pair *pair = &pairs[i];
    if (pair->geometry < 0 || (size_t)pair->geometry >= geometries)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: there is no geometry %d, the robot has %zu", i,
                            (int)pair->geometry, geometries);
    if (pair->other < 0 || (size_t)pair->other >= others)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: there is no %s %d", i, self ? "geometry" : "obstacle",
                            (int)pair->other);
    if (self && pair->geometry == pair->other)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: geometry %d against itself", i, (int)pair->geometry);
  }
  return CPROX_OK;
}

static cprox_status check_robot(const cprox_mover *mover, size_t n, cprox_workspace *workspace) {
  if (!mover->motion) return CPROX_OK;
  if (mover->curve || mover->body || mover->radius != 0.0 || mover->radius_curve)
    return workspace_fail(workspace, CPROX_INVALID,
                          "a mover is a robot's motion, or a curve and what rides it: not both; pad the robot's links");
  if (mover->kind == CPROX_MOVER_ROBOT_SELF && n > 0)
    return workspace_fail(workspace, CPROX_INVALID, "a robot against itself has no obstacles, got %zu", n);
  const bool self = mover->kind == CPROX_MOVER_ROBOT_SELF, whole = mover->kind == CPROX_MOVER_ROBOT_WHOLE;
  const cprox_status status = check_pairs(mover, mover->pairs, mover->n_pairs, self, n, workspace);
  if (status != CPROX_OK) return status;
  return check_pairs(mover, mover->self_pairs, whole ? mover->n_self_pairs : 0, true, n, workspace);
}

/* Is the obstacle one that the mover can be held against? */
static cprox_status check_against(const cprox_mover *mover, const cprox_obstacle *obstacle, size_t index,
                                  cprox_workspace *workspace) {
  if (obstacle->body && obstacle->body->field && (mover->motion || mover->body))
    return workspace_fail(workspace, CPROX_INVALID,
                          "obstacle %zu is known by its distance alone: balls on curves are held against it, not %s",
                          index, mover->motion ? "robots" : "bodies");
  if (!mover->motion) return check_clock(mover->curve, obstacle, index, workspace);
  if (!obstacle->body || obstacle->curve)
    return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu is a curve: a robot is asked about bodies", index);
  return CPROX_OK;
}

/* What bodies are made of. Convex ones are carried past convex ones: elements, and parts without end, have no Minkowski
 * difference that a search could use. Depths are those of convex bodies and hulls. */
static cprox_status check_elements(const cprox_mover *mover, const cprox_obstacle *obstacles, size_t n,
                                   const cprox_options *options, cprox_workspace *workspace) {
  static const char *const WHY =
      "signed_distance: %s %zu is a mesh without a hull, points or boxes, or has such a part: "
      "how deep a robot overlaps these is not measured";
  const cprox_robot *robot = mover->motion && options->signed_distance ? mover->motion->robot : NULL;
  const cprox_body *body = mover->body;
  const cprox_lod finest = robot ? CPROX_LOD_HULL : options->max_lod;
  if (body && body->field)
    return workspace_fail(workspace, CPROX_INVALID,
                          "the mover's body is known by its distance alone: only convex bodies are carried");
  if (body && !isfinite(body->ball_radius))
    return workspace_fail(workspace, CPROX_INVALID, "the mover's body is a halfspace or has one: it must be bounded");
  if (body && !body_is_in_reach(body))
    return workspace_fail(workspace, CPROX_INVALID, "the mover's body reaches farther than %g m", LENGTH_MOST);
  /* past some obstacles it goes by its hull even where balls are asked for */
  if (body && lod_has_tree(body, finest == CPROX_LOD_SPHERE ? CPROX_LOD_HULL : finest))
    return workspace_fail(
        workspace, CPROX_INVALID,
        "the mover's body is a mesh, points or boxes, or has such a part: only convex parts are carried");
  for (size_t i = 0; robot && i < robot->n_parts; i++)
    if (robot->parts[i].model.by_ball)
      return workspace_fail(workspace, CPROX_INVALID, WHY, "geometry", (size_t)robot->parts[i].geometry);
  for (size_t i = 0; (robot || body) && i < n; i++) {
    if (!lod_has_tree(obstacles[i].body, finest)) continue;
    if (robot) return workspace_fail(workspace, CPROX_INVALID, WHY, "obstacle", i);
    return workspace_fail(workspace, CPROX_INVALID,
                          "obstacle %zu is a mesh, points or boxes, or has such a part: bodies are not carried past "
                          "it, balls are (radius)",
                          i);
  }
  return CPROX_OK;
}

/* Do the members that are set belong to the kind? */
static cprox_status check_kind(const cprox_mover *mover, cprox_workspace *workspace) {
  if ((unsigned)mover->kind > CPROX_MOVER_ROBOT_WHOLE)
    return workspace_fail(workspace, CPROX_INVALID, "%d is no kind of mover", (int)mover->kind);
  const bool robot = mover->kind >= CPROX_MOVER_ROBOT;
  if (robot && !mover->motion) return workspace_fail(workspace, CPROX_INVALID, "the mover is a robot without a motion");
  if (!robot && !mover->curve) return workspace_fail(workspace, CPROX_INVALID, "the mover has no curve");
  if (!robot && mover->motion)
    return workspace_fail(workspace, CPROX_INVALID,
                          "the mover has a motion, but its kind is not that of a robot (cprox_robot_along, "
                          "cprox_robot_self)");
  if (mover->kind == CPROX_MOVER_BALL && mover->body)
    return workspace_fail(workspace, CPROX_INVALID, "the mover has a body, but its kind is a ball (cprox_body_along)");
  if (mover->kind == CPROX_MOVER_BODY && !mover->body)
    return workspace_fail(workspace, CPROX_INVALID, "the mover is a body without a body");
  return CPROX_OK;
}

/* The options by which a query is a part of one. */
static cprox_status check_part(const cprox_mover *mover, const cprox_options *options, cprox_workspace *workspace) {
  if (!options->interval && !options->share) return CPROX_OK;
  const char *name = options->interval ? "interval" : "share";
  if (!mover->motion) return workspace_fail(workspace, CPROX_INVALID, "%s is an option of robots", name);
  if (options->certificate)
    return workspace_fail(workspace, CPROX_INVALID, "%s: a certificate is about the whole motion", name);
  if (!options->interval) return CPROX_OK;
  const cprox_motion_info whole = cprox_motion_get_info(mover->motion);
  const double from = options->interval[0], to = options->interval[1];
  if (!(from >= whole.t0 && to <= whole.t1 && from < to))
    return workspace_fail(workspace, CPROX_INVALID,
                          "interval is [%.17g, %.17g], must ascend within the motion's [%.17g, %.17g]", from, to,
                          whole.t0, whole.t1);
  return CPROX_OK;
}

cprox_status validate_query(const cprox_mover *mover, const cprox_obstacle *obstacles, size_t n,
                            const cprox_options *options, arguments_query asked, cprox_workspace *workspace) {
  if (!workspace) return CPROX_INVALID;
  cprox_status checked = check_kind(mover, workspace);
  if (checked == CPROX_OK) checked = validate_length("radius", mover->radius, workspace);
  if (checked == CPROX_OK) checked = validate_options(options, asked, workspace);
  if (checked != CPROX_OK) return checked;
  if (mover->kind == CPROX_MOVER_ROBOT_WHOLE && !(asked.has & ARGUMENTS_WHOLE))
    return workspace_fail(workspace, CPROX_INVALID,
                          "%s: a robot against obstacles and itself at once has a distance, verdicts and a time of "
                          "contact, and their certificates",
                          asked.name);
  if (!mover->motion && (mover->pairs || mover->n_pairs > 0 || mover->self_pairs || mover->n_self_pairs > 0))
    return workspace_fail(
        workspace, CPROX_INVALID,
        "the mover has pairs, but no motion: that is for robots (cprox_robot_along, cprox_robot_self)");
  if (mover->curve && !mover->curve->in_reach)
    return workspace_fail(workspace, CPROX_INVALID, "the mover's curve reaches farther than %g m", LENGTH_MOST);
  checked = check_robot(mover, n, workspace);
  if (checked == CPROX_OK) checked = check_part(mover, options, workspace);
  if (checked == CPROX_OK) checked = validate_obstacles(obstacles, n, workspace);
  for (size_t i = 0; i < n && checked == CPROX_OK; i++) checked = check_against(mover, &obstacles[i], i, workspace);
  if (checked == CPROX_OK) checked = check_elements(mover, obstacles, n, options, workspace);
  if (checked == CPROX_OK && mover->radius_curve) checked = radius_check(mover, NULL, 0, asked, workspace);
  for (size_t i = 0; i < n && checked == CPROX_OK; i++)
    if (radius_changes(mover, &obstacles[i])) checked = radius_check(mover, &obstacles[i], i, asked, workspace);
  return checked;
}
