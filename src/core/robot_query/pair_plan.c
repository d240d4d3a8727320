/* SPDX-License-Identifier: BSD-3-Clause */
#include "robot_query/pair_plan.h"

#include <math.h>

#include "base/workspace.h"

/* ---- geometries and obstacles ---- */

/* The first of n ascending numbers, so many bytes from each other, that is `least` or more. */
static size_t first_from(const int32_t *number, size_t bytes, size_t n, int32_t least) {
  size_t low = 0, high = n;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (*(const int32_t *)(const void *)((const char *)number + bytes * middle) < least)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

/* ---- the pairs that are asked about ---- */

/* The pairs of geometries that the caller gave; NULL: all. */
static const cprox_robot_pair *given_pairs(const cprox_mover *mover, bool self, size_t *n) {
  const bool second = self && mover_is_whole(mover);
  *n = second ? mover->n_self_pairs : mover->n_pairs;
  return second ? mover->self_pairs : mover->pairs;
}

size_t pair_plan_count_self(const cprox_mover *mover) {
  const size_t n = mover->motion->robot->n_parts, all = n * (n - 1) / 2;
  if (!pair_plan_has_self(mover) || n < 2) return 0;
  size_t count;
  const cprox_robot_pair *given = given_pairs(mover, true, &count);
  return given && count < all && n == mover->motion->robot->n_geometries ? count : all;
}

static void take(pair_plan *p, size_t moving, size_t standing, double apart) {
  p->pairs[p->n++] = (planned_pair){.moving = (int32_t)moving, .standing = (int32_t)standing, .apart = apart};
}

/* How deep two may overlap sweeps do not say. */
static double parts_apart(const pair_plan *p, size_t part, size_t other) {
  const part_sweep *sweeps = p->q->mover.motion->sweeps;
  const double apart = sweeps ? part_sweeps_apart(&sweeps[part], &sweeps[other]) : -INFINITY;
  return p->q->is_signed && apart <= 0.0 ? -INFINITY : apart;
}

/* What is left out matters only where it is the nearest of that. all: parts of links that the motion cannot move
 * against each other are not asked about. */
static void take_parts(pair_plan *p, size_t part, size_t other, bool all) {
  const cprox_motion *m = p->q->mover.motion;
  const double apart = parts_apart(p, part, other);
  const bool near = apart <= p->reach;
  if (!near && apart >= p->beyond) return;
  if (all && !motion_relates_links(m, m->robot->parts[part].link, m->robot->parts[other].link)) return;
  if (near)
    take(p, part, other, apart);
  else
    p->beyond = apart;
}

/* A part against obstacles first … last - 1, or against such parts of the robot itself. False where memory is out. */
static bool take_row(pair_plan *p, size_t part, size_t first, size_t last, bool self, bool all) {
  if (first >= last) return true;
  planned_pair *pairs = workspace_reserve(p->q->workspace, WORKSPACE_ROBOT_PLAN, (p->n + last - first) * sizeof *pairs);
  if (!pairs) return false;
  p->pairs = pairs;
  for (size_t k = first; k < last; k++) {
    if (!start_class_has(p->q->mover.motion, p->starts, (int32_t)part, self ? (int32_t)k : -1)) continue;
    if (self)
      take_parts(p, part, k, all);
    else
      take(p, part, k, -INFINITY);
  }
  return true;
}

/* The convex parts of two geometries, or of a geometry and an obstacle. */
static bool take_given(pair_plan *p, const cprox_robot_pair *given, const robot_body *obstacles, size_t n_obstacles,
                       bool self) {
  const cprox_robot *robot = p->q->mover.motion->robot;
  const size_t end = robot->first_part[given->geometry + 1];
  size_t other[2] = {0, 0};
  for (int32_t k = 0; k < 2; k++) {
    if (self)
      other[k] = robot->first_part[given->other + k];
    else if (n_obstacles > 0)
      other[k] = first_from(&obstacles->index, sizeof *obstacles, n_obstacles, given->other + k);
  }
  bool took = true;
  for (size_t i = robot->first_part[given->geometry]; i < end && took; i++)
    took = take_row(p, i, other[0], other[1], self, false);
  return took;
}

bool pair_plan_list(pair_plan *p, const robot_body *obstacles, size_t n_obstacles, bool grouped) {
  const cprox_mover *mover = &p->q->mover;
  const cprox_robot *robot = mover->motion->robot;
  bool took = true;
  p->n = p->n_against = 0;
  p->beyond = INFINITY;
  for (int with = mover_is_self(mover); with <= (pair_plan_has_self(mover) && !grouped) && took; with++) {
    size_t count;
    const cprox_robot_pair *given = given_pairs(mover, with, &count);
    for (size_t i = 0; given && i < count && took; i++) took = take_given(p, &given[i], obstacles, n_obstacles, with);
    for (size_t i = 0; !given && i < robot->n_parts && took; i++)
      took = take_row(p, i, 0, with ? robot->first_part[robot->parts[i].geometry] : n_obstacles, with, true);
    if (!with) p->n_against = p->n;
  }
  return took;
}

/* ---- far pairs ---- */

const planned_pair *pair_plan_nearest(const pair_plan *p) {
  const planned_pair *nearest = NULL;
  for (size_t i = p->n_against; i < p->n; i++)
    if (p->pairs[i].apart < (nearest ? nearest->apart : INFINITY)) nearest = &p->pairs[i];
  return nearest;
}

void pair_plan_leave_out(pair_plan *p, double reach) {
  size_t n = p->n_against;
  for (size_t i = n; i < p->n; i++) {
    if (p->pairs[i].apart > reach)
      p->beyond = lesser(p->pairs[i].apart, p->beyond);
    else
      p->pairs[n++] = p->pairs[i];
  }
  p->n = n;
}
