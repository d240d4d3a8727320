/* SPDX-License-Identifier: BSD-3-Clause */
/* The handle for many edges: its lists of pairs, and both sides of its model. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/workspace.h"
#include "edges/edge_build.h"
#include "problem/obstacles.h"

/* All pairs that are asked about, in order; `to` NULL: their number. */
static size_t list_pairs(const cprox_robot *robot, const cprox_edge_query *q, cprox_robot_pair *to) {
  if (q->pairs) {
    if (to && q->n_pairs > 0) memcpy(to, q->pairs, q->n_pairs * sizeof *to);
    return q->n_pairs;
  }
  size_t n = 0;
  for (size_t g = 0; g < robot->n_geometries; g++)
    for (size_t k = 0; k < obstacles_count(q->obstacles); k++, n++)
      if (to) to[n] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
  return n;
}

static size_t list_self_pairs(const cprox_robot *robot, const cprox_edge_query *q, cprox_robot_pair *to) {
  if (q->without_self) return 0;
  if (q->self_pairs) {
    if (to && q->n_self_pairs > 0) memcpy(to, q->self_pairs, q->n_self_pairs * sizeof *to);
    return q->n_self_pairs;
  }
  size_t n = 0;
  for (size_t g = 0; g < robot->n_geometries; g++)
    for (size_t k = 0; k < g; k++) {
      if (!robot_is_worth_asking(robot, g, k)) continue;
      if (to) to[n] = (cprox_robot_pair){(int32_t)g, (int32_t)k};
      n++;
    }
  return n;
}

static cprox_status check_pairs(const cprox_robot_pair *pairs, size_t n, size_t others, const char *what,
                                size_t geometries, cprox_workspace *workspace) {
  for (size_t i = 0; pairs && i < n; i++) {
    const cprox_robot_pair p = pairs[i];
    if (p.geometry < 0 || (size_t)p.geometry >= geometries)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: there is no geometry %d: the robot has %zu", i,
                            (int)p.geometry, geometries);
    if (p.other < 0 || (size_t)p.other >= others)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: there is no %s %d: there are %zu", i, what,
                            (int)p.other, others);
  }
  return CPROX_OK;
}

static cprox_status check(const cprox_robot *robot, const cprox_edge_query *q, cprox_workspace *workspace) {
  if (!(q->delta >= 0.0) || isinf(q->delta))
    return workspace_fail(workspace, CPROX_INVALID, "delta is %g, must be finite and >= 0", q->delta);
  if (!(q->rounding >= 0.0) || isinf(q->rounding))
    return workspace_fail(workspace, CPROX_INVALID, "rounding is %g, must be finite and >= 0", q->rounding);
  if ((q->n_pairs > 0 && !q->pairs) || (q->n_self_pairs > 0 && !q->self_pairs))
    return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", q->n_pairs > 0 && !q->pairs ? "pairs" : "self_pairs");
  if (q->first && (q->delta > 0.0 || q->rounding > 0.0))
    return workspace_fail(workspace, CPROX_INVALID,
                          "the time of contact is that of collision: first needs delta = 0 and rounding = 0");
  for (size_t i = 0; i < obstacles_count(q->obstacles); i++) {
    const cprox_obstacle *o = &q->obstacles->obstacles[i];
    if (!o->body || o->curve || o->body->field)
      return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu is %s: a robot is asked about bodies", i,
                            o->body && o->body->field ? "known by its distance alone" : "a curve");
  }
  const cprox_status status =
      check_pairs(q->pairs, q->n_pairs, obstacles_count(q->obstacles), "obstacle", robot->n_geometries, workspace);
  if (status != CPROX_OK) return status;
  for (size_t i = 0; i < q->n_self_pairs; i++)
    if (q->self_pairs[i].geometry == q->self_pairs[i].other)
      return workspace_fail(workspace, CPROX_INVALID, "pair %zu: geometry %d is asked about itself", i,
                            (int)q->self_pairs[i].other);
  return check_pairs(q->self_pairs, q->n_self_pairs, robot->n_geometries, "geometry", robot->n_geometries, workspace);
}

/* A handle's two sides. */
static cprox_status fill(cprox_edge_checker *c, cprox_workspace *workspace) {
  const cprox_edge_query *q = &c->asked;
  const size_t n = obstacles_count(q->obstacles);
  const edge_asked asked = {.robot = c->robot,
                            .about_obstacles = true,
                            .about_self = true,
                            .pairs = q->pairs ? c->pairs : NULL,
                            .n_pairs = c->n_pairs,
                            .self_pairs = c->pairs + c->n_pairs,
                            .n_self_pairs = c->n_self_pairs,
                            .n_obstacles = n};
  const robot_covers *covers = robot_covers_of(c->robot);
  if (covers) c->memory[0] = malloc(edge_model_robot_size(&asked, covers) + 1);
  if (c->memory[0]) {
    edge_model_fill_robot(c, &asked, covers, c->memory[0]);
    c->memory[1] = malloc(edge_model_scene_size(c, obstacles_list(q->obstacles), 0, n) + 1);
  }
  if (!c->memory[1])
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for %zu obstacles and %zu pairs", n, c->n_self_pairs);
  if (c->in_lanes) edge_model_fill_scene(c, obstacles_list(q->obstacles), 0, n, NULL, c->memory[1]);
  return CPROX_OK;
}

cprox_status cprox_edge_checker_create(const cprox_robot *robot, const cprox_edge_query *asked,
                                       cprox_workspace *workspace, cprox_edge_checker **checker) {
  WORKSPACE_USE(workspace);
  workspace_clear(workspace);
  if (!robot || !checker) return workspace_fail(workspace, CPROX_INVALID, "%s is NULL", robot ? "checker" : "robot");
  const cprox_edge_query q = asked ? *asked : (cprox_edge_query){0};
  cprox_status status = check(robot, &q, workspace);
  if (status != CPROX_OK) return status;
  cprox_edge_checker *c = calloc(1, sizeof *c);
  if (c) {
    *c = (cprox_edge_checker){.robot = robot, .asked = q, .clear_beyond = q.delta, .hit_within = q.delta};
    if (q.rounding > 0.0) { /* sums in double are rounded, too */
      c->clear_beyond = nextafter(q.delta + q.rounding, INFINITY);
      c->hit_within = greater(nextafter(q.delta - q.rounding, 0.0), 0.0);
    }
    c->n_pairs = list_pairs(robot, &q, NULL), c->n_self_pairs = list_self_pairs(robot, &q, NULL);
    c->pairs = calloc(c->n_pairs + c->n_self_pairs + 1, sizeof *c->pairs);
  }
  if (!c || !c->pairs) {
    free(c);
    return workspace_fail(workspace, CPROX_MEMORY, "no memory for a robot's pairs");
  }
  list_pairs(robot, &q, c->pairs), list_self_pairs(robot, &q, c->pairs + c->n_pairs);
  status = fill(c, workspace);
  if (status != CPROX_OK) {
    cprox_edge_checker_free(c);
    return status;
  }
  *checker = c;
  return CPROX_OK;
}

void cprox_edge_checker_free(cprox_edge_checker *checker) {
  if (!checker) return;
  free(checker->pairs);
  free(checker->memory[0]);
  free(checker->memory[1]);
  free(checker);
}
