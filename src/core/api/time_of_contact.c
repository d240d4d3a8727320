/* SPDX-License-Identifier: BSD-3-Clause */
/* The time of contact of a moving object with one obstacle or with many. */
#include "solve/time_of_contact.h"
#include "base/workspace.h"
#include "problem/validate.h"
#include "robot_query/answer.h"
#include "solve/list.h"

cprox_status list_time_of_contact(cprox_mover mover, const cprox_obstacle *obstacles, size_t n,
                                  const cprox_options *options, cprox_workspace *workspace, cprox_result *result) {
  query q = query_create(mover, obstacles, n, 0.0, options, workspace);
  const arguments_query asked = {
      "time of contact", ARGUMENTS_STOP | ARGUMENTS_LOD | ARGUMENTS_WHOLE | ARGUMENTS_INTERVAL | ARGUMENTS_RADIUS};
  const cprox_status begun = query_begin(&q, asked);
  if (begun != CPROX_OK) return begun;
  if (mover.motion) return robot_time_of_contact(&q, result);
  time_of_contact all = time_of_contact_begin();
  const cprox_status met = time_of_contact_with(&all, &q, 0, n);
  return met < 0 ? met : time_of_contact_conclude(&all, &q, result);
}

cprox_status cprox_time_of_contact(cprox_mover mover, cprox_obstacle obstacle, const cprox_options *options,
                                   cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  return list_time_of_contact(mover, &obstacle, 1, options, workspace, result);
}
