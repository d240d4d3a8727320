/* SPDX-License-Identifier: BSD-3-Clause */
/* A robot along a motion as text: what the checker takes as given. doc/certificates.md has the grammar. */
#include "base/workspace.h"
#include "certificate/describe.h"
#include "certificate/write.h"
#include "curve_proximity/cprox/certificate.h"
#include "problem/obstacles.h"
#include "problem/problem.h"
#include "problem/validate.h"
#include "robot_query/robot_scene.h"

/* ---- the robot ---- */

static void describe_link(text *t, const cprox_link *link) {
  static const char *const NAMES[] = {"fixed", "revolute", "prismatic", "planar", "floating"};
  const bool moves = link->type != CPROX_JOINT_FIXED;
  const bool turns = link->type == CPROX_JOINT_REVOLUTE || link->type == CPROX_JOINT_PRISMATIC;
  describe_text(t, "link %d %s", (int)link->parent, NAMES[link->type]);
  describe_pose(t, &link->origin);
  describe_vector(t, turns ? link->axis : vec(0, 0, 1));
  describe_text(t, " %d %a %a\n", moves ? (int)link->variable : 0, turns ? link->multiplier : 1.0,
                turns ? link->offset : 0.0);
}

static void describe_one(text *t, const cprox_link_geometry *g, const cprox_body *body, const cprox_pose *inner) {
  describe_text(t, "part %d %a %d", (int)g->link, g->margin, inner ? 2 : 1);
  describe_pose(t, &g->pose);
  if (inner) describe_pose(t, inner);
  describe_body(t, body);
  describe_text(t, "\n");
}

static void describe_geometry(text *t, const cprox_link_geometry *g) {
  if (g->body->kind != CPROX_BODY_COMPOUND) {
    describe_one(t, g, g->body, NULL);
    return;
  }
  for (size_t i = 0; i < g->body->n_parts; i++) describe_one(t, g, g->body->parts[i].body, &g->body->parts[i].pose);
}

size_t describe_unknown_geometry(const cprox_robot *robot) {
  size_t i = 0;
  while (i < robot->n_geometries && !describe_unknown_kind(robot->given_geometries[i].body)) i++;
  return i;
}

/* ---- its motion ---- */

static void describe_values(text *t, const double *values, size_t n) {
  for (size_t i = 0; i < n; i++) describe_text(t, " %a", values[i]);
  describe_text(t, "\n");
}

static void describe_variables(text *t, const motion_given *g) {
  describe_text(t, " %zu", g->n);
  for (size_t i = 0; i < g->n; i++) describe_text(t, " %d", (int)g->variables[i]);
  describe_text(t, " %zu\n", g->n_points);
}

static void describe_given(text *t, const motion_given *g) {
  if (g->degree > 0) {
    describe_text(t, "motion bspline %zu", g->degree);
    describe_variables(t, g);
    describe_text(t, "knots");
    describe_values(t, g->times, g->n_times);
    for (size_t i = 0; i < g->n_points; i++) {
      describe_text(t, "control");
      describe_values(t, g->values + i * g->n, g->n);
    }
    return;
  }
  describe_text(t, "motion %s %d", g->turning == CPROX_TURNING_SLERP ? "slerp" : "waypoints", (int)g->interpolation);
  describe_variables(t, g);
  for (size_t i = 0; i < g->n_points; i++) {
    describe_text(t, "at %a %d", g->times[i], (int)g->orders[i]);
    describe_values(t, g->values + 3 * i * g->n, g->orders[i] * g->n);
  }
}

static void describe_motion(text *t, const cprox_motion *motion) {
  describe_text(t, "rest");
  describe_values(t, motion->rest, motion->robot->n_variables);
  if (!motion->sources) {
    describe_given(t, &motion->given);
    return;
  }
  size_t n = 0;
  for (size_t i = 0; i < motion->n_joined; i++) n += motion->sources[i].times != NULL;
  describe_text(t, "motion joined %zu\n", n);
  for (size_t i = 0; i < motion->n_joined; i++) {
    if (!motion->sources[i].times) continue;
    describe_text(t, "start %a\n", motion->sources[i].start);
    describe_given(t, &motion->sources[i]);
  }
}

/* ---- the whole ---- */

size_t cprox_mover_describe(const cprox_mover *mover, const cprox_obstacles *obstacles, const char *id,
                            cprox_workspace *workspace, char *out, size_t size) {
  WORKSPACE_USE_OR(workspace, 0);
  const cprox_obstacle *list = obstacles_list(obstacles);
  const size_t n = obstacles_count(obstacles);
  query q = query_create(*mover, list, n, -1.0, NULL, workspace);
  if (!mover->motion || !motion_is_described(mover->motion) ||
      describe_unknown_geometry(mover->motion->robot) < mover->motion->robot->n_geometries ||
      validate_query(mover, list, n, &q.options, (arguments_query){"a description", ARGUMENTS_WHOLE}, workspace) !=
          CPROX_OK)
    return 0;
  robot_scene scene;
  if (!robot_scene_begin(&scene, &q, NULL, 0, n, SIZE_MAX, INFINITY)) return 0;
  const cprox_robot *robot = mover->motion->robot;
  text t = {.at = out, .size = out ? size : 0};
  describe_text(&t, "robot %s %zu %zu %zu\n", id, robot->n_links, robot->n_parts, robot->n_variables);
  for (size_t i = 0; i < robot->n_links; i++) describe_link(&t, &robot->given_links[i]);
  for (size_t i = 0; i < robot->n_geometries; i++) describe_geometry(&t, &robot->given_geometries[i]);
  describe_text(&t, "pairs %zu", scene.n_pairs);
  for (size_t i = 0; i < scene.n_pairs; i++)
    describe_text(&t, " %d %zu", (int)scene.pairs[i].moving,
                  (size_t)scene.pairs[i].standing + (scene.pairs[i].self ? 0 : robot->n_parts));
  describe_text(&t, "\n");
  describe_motion(&t, mover->motion);
  return t.length;
}
