/* SPDX-License-Identifier: BSD-3-Clause */
/* How much nearer two sides of a pair may come than a motion and a scene have them, by the bounds of all errors, over
 * the node at hand. doc/robust.md derives it. */
#ifndef CPROX_ROBOT_QUERY_DEVIATION_H
#define CPROX_ROBOT_QUERY_DEVIATION_H

#include "kinematics/errors.h"
#include "robot_query/placed_robot_pair.h"

/* Of a whole part, against anything under a node of the set's tree. */
deviation deviation_of_cluster(robot_scene *scene, int32_t part);

/* Both sides of a pair, which are placed. places: what of it is not by joints. */
deviation deviation_of_pair(robot_scene *scene, const robot_pair *pair, const robot_body *moving,
                            const robot_body *standing, deviation *places);

/* What errors can take off along a plane's normal n, unit, world, that turns by `normal_rate` over the node, from the
 * standing side to the moving one: in the losses of `side`, which is the placed pair's moving side without errors; they
 * stand in the workspace until the next call. over: anywhere in the node; else in its middle. False where memory is
 * out. */
bool deviation_losses(robot_scene *scene, const placed_robot_pair *placed, vec3 n, double normal_rate, bool over,
                      bound_side *side);

#endif
