/* SPDX-License-Identifier: BSD-3-Clause */
/* The pairs of a robot with itself as its parts come near each other, by groups of parts: two groups are one entry of a
 * list until they come near, and only then pairs. doc/robot-search.md, Many links */
#ifndef CPROX_ROBOT_QUERY_GROUPS_H
#define CPROX_ROBOT_QUERY_GROUPS_H

#include "robot_query/robot_scene.h"

/* Two groups of parts; both may be the same one: all pairs of its parts. */
typedef struct group_pair {
  int32_t group[2];
} group_pair;

static inline bool group_pair_is_one(group_pair pair) {
  return pair.group[0] == pair.group[1];
}

/* Everything that a node's list may open at once: each pair of groups has up to three inside. */
enum { GROUP_PAIRS_INSIDE = 3, GROUP_STACK = 2 * GROUP_PAIRS_INSIDE * PART_GROUPS_DEEPEST };

/* Makes ready which parts are asked about with which; a scene with nothing to ask has no groups. False where memory is
 * out. */
bool robot_groups_begin(robot_scene *scene);

/* From here on only these pairs are asked about. */
void robot_groups_choose(robot_scene *scene, pair_choice choice);

/* Whether any part of the one is asked about with any of the other. */
bool robot_groups_ask(const robot_scene *scene, group_pair pair);

/* How far two groups are apart in the middle of the node, at least. */
double robot_groups_apart(robot_scene *scene, group_pair pair);

/* The radius of the larger one. */
double robot_groups_radius(robot_scene *scene, group_pair pair);

/* How far both move together over the node, as the axis above both sees it, at most. */
double robot_groups_displacement(robot_scene *scene, group_pair pair);

/* How far the parts of a group move, seen from an axis that carries them all (-1: the world), at most. */
double robot_group_displacement(robot_scene *scene, int32_t group, int32_t from);

/* How far both sides of a pair of whole parts move together, as the axis above both sees it, at most. */
double robot_groups_displacement_of(robot_scene *scene, const robot_pair *pair);

/* Whether both are single parts. */
bool robot_groups_are_parts(const robot_scene *scene, group_pair pair);

/* The pairs of groups that make up the pair, of what is asked about; their number. */
size_t robot_groups_open(robot_scene *scene, group_pair pair, group_pair inside[GROUP_PAIRS_INSIDE]);

/* The pair of two single parts: its number, -1 where memory is out. It may move all pairs in memory. */
int32_t robot_groups_pair(robot_scene *scene, group_pair pair);

#endif
