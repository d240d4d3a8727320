/* SPDX-License-Identifier: BSD-3-Clause */
/* Solid meshes: what is inside of one where the motion begins stays inside, or comes out through its surface, which the
 * search finds. So one look is enough. doc/robot-search.md, Solid meshes */
#ifndef CPROX_ROBOT_QUERY_INSIDE_H
#define CPROX_ROBOT_QUERY_INSIDE_H

#include "robot_query/oracle.h"

/* Looks once in a search, on its first node: what is inside is in contact. CPROX_OK, or a negative status. */
cprox_status robot_look_inside(robot_search *o, const search_node *node);

#endif
