/* SPDX-License-Identifier: BSD-3-Clause */
/* Two standing bodies of many elements each. doc/non-convex.md derives it. */
#ifndef CPROX_NARROWPHASE_MESH_MESH_H
#define CPROX_NARROWPHASE_MESH_MESH_H

#include "base/workspace.h"
#include "narrowphase/relative_pose.h"

/* The answer is in the frame of a. False where memory is out. */
bool mesh_mesh_measure(const pair_side *a, const pair_side *b, const pair_goal *goal, cprox_workspace *workspace,
                       pair_answer *answer);

#endif
