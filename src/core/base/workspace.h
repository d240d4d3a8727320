/* SPDX-License-Identifier: BSD-3-Clause */
/* The workspace: growing buffers that keep their memory from query to query, and the reason of the last failure. */
#ifndef CPROX_BASE_WORKSPACE_H
#define CPROX_BASE_WORKSPACE_H

#include "curve_proximity/cprox/base.h"

/* Each user of memory has a buffer of its own. */
typedef enum workspace_buffer {
  WORKSPACE_NODES,
  WORKSPACE_POINTS,
  WORKSPACE_FREE_SLOTS,
  WORKSPACE_ORDER,
  WORKSPACE_RELATIVE,
  WORKSPACE_RADII,
  WORKSPACE_ALIGNED,
  WORKSPACE_ALIGNED_RADII,
  WORKSPACE_RANKING,
  WORKSPACE_NEAREST,
  WORKSPACE_COVER,
  WORKSPACE_COVER_ELEMENTS,
  WORKSPACE_COVER_ITEMS,
  WORKSPACE_INTERIOR,
  WORKSPACE_BASIS,
  WORKSPACE_BASIS_OF_SECOND,
  WORKSPACE_FINE_BASIS,
  WORKSPACE_BATCH,
  WORKSPACE_BATCH_NEAR,
  WORKSPACE_BATCH_OPEN,
  WORKSPACE_LISTS,
  WORKSPACE_SET,
  WORKSPACE_ROBOT,
  WORKSPACE_ROBOT_PLAN,
  WORKSPACE_ROBOT_PAIRS,
  WORKSPACE_ROBOT_LISTS,
  WORKSPACE_ROBOT_NEXT,
  WORKSPACE_ROBOT_FOUND,
  WORKSPACE_ROBOT_OBSTACLES,
  WORKSPACE_ROBOT_CLUSTER,
  WORKSPACE_ROBOT_GROUPS,
  WORKSPACE_ROBOT_SPOT,
  WORKSPACE_ROBOT_GROWTH,
  WORKSPACE_ROBOT_RANKING,
  WORKSPACE_ROBOT_REST,
  WORKSPACE_ROBOT_LOSSES,
  WORKSPACE_POSE_BASIS,
  WORKSPACE_EDGES,
  WORKSPACE_EDGE_ROBOT,
  WORKSPACE_EDGE_SELF,
  WORKSPACE_EDGE_WHOLE,
  WORKSPACE_EDGE_SCENE,
  WORKSPACE_JOINT_BOX,
  WORKSPACE_JOINT_BOXES,
  WORKSPACE_SWEEP,
  WORKSPACE_CALLER, /* cprox_workspace_reserve() */
  WORKSPACE_BUFFERS
} workspace_buffer;

/* The buffer, grown to at least `bytes` (beyond 8 kB by half as much again each time); what it held stays. NULL where
 * memory is out. */
void *workspace_reserve(cprox_workspace *workspace, workspace_buffer buffer, size_t bytes);

/* The buffer as it is; NULL: nothing was ever reserved. */
void *workspace_filled(const cprox_workspace *workspace, workspace_buffer buffer);

/* Sets the reason, printf-like, and returns the status; a workspace of NULL is allowed. */
cprox_status workspace_fail(cprox_workspace *workspace, cprox_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

/* Whether the function of cprox_workspace_set_stop() wants an end, now or when it was last asked. NULL is allowed. */
bool workspace_stops(cprox_workspace *workspace);

/* Whether it wanted an end when it was last asked. */
bool workspace_has_stopped(const cprox_workspace *workspace);

/* The work that searches have done for the answer at hand, in the unit of cprox_options.max_nodes: they add theirs, and
 * the next answer of the same query begins with none. */
void workspace_add_work(cprox_workspace *workspace, uint64_t work);
uint64_t workspace_work(const cprox_workspace *workspace);
void workspace_forget_work(cprox_workspace *workspace);

/* Forgets the reason of the last failure, that an end was wanted, and the work done. */
void workspace_clear(cprox_workspace *workspace);

/* What each public function with a workspace begins with: it has the workspace alone until it returns. While another
 * one has it, which asked a function of the caller, the function returns CPROX_INVALID (or `refused`), and
 * cprox_workspace_error() says so until the other one returns. A workspace of NULL is allowed. */
#define WORKSPACE_USE_OR(workspace, refused)               \
  if (!cprox_workspace_enter(workspace)) return (refused); \
  cprox_workspace *const workspace_of_this_call __attribute__((cleanup(cprox_workspace_leave))) = (workspace)
#define WORKSPACE_USE(workspace) WORKSPACE_USE_OR(workspace, CPROX_INVALID)

/* A public function that calls another one lends it the workspace: the value of `call`, a cprox_status. */
#define WORKSPACE_LEND(workspace, call) (cprox_workspace_lend(workspace), cprox_workspace_take_back(workspace, (call)))

#endif
