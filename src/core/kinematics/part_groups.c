/* SPDX-License-Identifier: BSD-3-Clause */
#include "kinematics/part_groups.h"

#include <stdlib.h>

#include "kinematics/joint_tree.h"

/* A part under construction: where it comes in the order. */
typedef struct place_key {
  double by; /* the order of its axis; then a coordinate */
  int32_t part;
} place_key;

typedef struct plan {
  const cprox_robot *robot;
  place_key *keys;
  int32_t *common; /* the axis above the parts at this place and at the one before */
} plan;

static int compare_keys(const void *a, const void *b) {
  const place_key *x = a, *y = b;
  if (x->by != y->by) return x->by < y->by ? -1 : 1;
  return (x->part > y->part) - (x->part < y->part);
}

static int32_t axis_at(const plan *p, int32_t place) {
  return p->robot->parts[p->keys[place].part].axis;
}

static double coordinate(vec3 at, int along) {
  return along == 0 ? at.x : along == 1 ? at.y : at.z;
}

/* Parts of one axis in the order of the coordinate along which they reach farthest. */
static void order_in_space(plan *p, int32_t first, int32_t last) {
  const robot_part *parts = p->robot->parts;
  double longest = -1.0;
  int along = 0;
  for (int k = 0; k < 3; k++) {
    double low = coordinate(parts[p->keys[first].part].at.p, k), high = low;
    for (int32_t i = first + 1; i < last; i++) {
      const double x = coordinate(parts[p->keys[i].part].at.p, k);
      low = lesser(x, low), high = greater(x, high);
    }
    if (high - low > longest) longest = high - low, along = k;
  }
  for (int32_t i = first; i < last; i++) p->keys[i].by = coordinate(parts[p->keys[i].part].at.p, along);
  qsort(p->keys + first, (size_t)(last - first), sizeof *p->keys, compare_keys);
}

/* How bad it is to cut between the parts at this place and at the one before: between branches of the tree, the nearer
 * to the world the better; along a branch; within a link. */
static int64_t price_of_cut(const plan *p, int32_t place) {
  const int32_t common = p->common[place], before = axis_at(p, place - 1);
  if (axis_at(p, place) == before) return INT64_MAX;
  return common == before ? INT64_MAX - 1 : (int64_t)robot_axis_depth(p->robot, common);
}

/* Near the middle: a quarter of the parts stays on each side. */
static int32_t place_of_cut(const plan *p, const part_group *group) {
  const int32_t n = group->last - group->first, middle = group->first + n / 2, quarter = n / 4 > 1 ? n / 4 : 1;
  int32_t best = middle;
  int64_t least = price_of_cut(p, middle);
  for (int32_t i = group->first + quarter; i <= group->last - quarter; i++) {
    const int64_t price = price_of_cut(p, i);
    if (price < least || (price == least && abs(i - middle) < abs(best - middle))) least = price, best = i;
  }
  return best;
}

/* Above neighbours in the order is what is above all between them. */
static int32_t axis_of_group(const plan *p, const part_group *group) {
  int32_t axis = axis_at(p, group->first);
  for (int32_t i = group->first + 1; i < group->last; i++)
    if (robot_axis_depth(p->robot, p->common[i]) < robot_axis_depth(p->robot, axis)) axis = p->common[i];
  return axis;
}

static void cut_groups(plan *p, part_groups *g, int32_t n_parts) {
  g->at[0] = (part_group){.first = 0, .last = n_parts};
  g->n = 1;
  for (size_t i = 0; i < g->n; i++) {
    part_group *group = &g->at[i];
    group->axis = axis_of_group(p, group);
    group->half = -1;
    if (group->last - group->first < 2) {
      g->part[group->first] = p->keys[group->first].part;
      g->alone[g->part[group->first]] = (int32_t)i;
      continue;
    }
    if (axis_at(p, group->first) == axis_at(p, group->last - 1)) order_in_space(p, group->first, group->last);
    const int32_t cut = place_of_cut(p, group);
    group->half = (int32_t)g->n;
    g->at[g->n++] = (part_group){.first = group->first, .last = cut};
    g->at[g->n++] = (part_group){.first = cut, .last = group->last};
  }
}

bool part_groups_create(const cprox_robot *robot, part_groups *groups) {
  *groups = (part_groups){.n = 0};
  const size_t n = robot->n_parts;
  if (n == 0) return true;
  plan p = {.robot = robot, .keys = calloc(n, sizeof *p.keys), .common = calloc(n, sizeof *p.common)};
  groups->at = calloc(2 * n, sizeof *groups->at);
  groups->part = calloc(n, sizeof *groups->part);
  groups->alone = calloc(n, sizeof *groups->alone);
  const bool made = p.keys && p.common && groups->at && groups->part && groups->alone;
  if (made) {
    for (size_t i = 0; i < n; i++) {
      const int32_t axis = robot->parts[i].axis;
      p.keys[i] = (place_key){.by = axis < 0 ? -1.0 : robot->axes[axis].order, .part = (int32_t)i};
    }
    qsort(p.keys, n, sizeof *p.keys, compare_keys);
    for (int32_t i = 1; i < (int32_t)n; i++) p.common[i] = robot_common_axis(robot, axis_at(&p, i - 1), axis_at(&p, i));
    cut_groups(&p, groups, (int32_t)n);
  } else {
    part_groups_free(groups);
  }
  free(p.keys);
  free(p.common);
  return made;
}

void part_groups_free(part_groups *groups) {
  free(groups->at);
  free(groups->part);
  free(groups->alone);
  *groups = (part_groups){.n = 0};
}
