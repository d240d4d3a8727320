/* SPDX-License-Identifier: BSD-3-Clause */
/* The first contact of a moving object with one obstacle or with many. */
#include "solve/time_of_contact.h"
#include "base/workspace.h"
#include "problem/validate.h"
#include "robot_query/answer.h"

cprox_status cprox_first_contact_all(cprox_mover mover, const cprox_target *targets, size_t n,
                                     const cprox_options *options, cprox_workspace *workspace, cprox_result *result) {
  question q = question_create(mover, targets, n, 0.0, false, options, workspace);
  workspace_clear(workspace);
  const arguments_query asked = {"first contact", ARGUMENTS_STOP | ARGUMENTS_RUNG};
  const cprox_status checked = arguments_check_query(&mover, targets, n, &q.options, asked, workspace);
  if (checked != CPROX_OK) return checked;
  question_ask_whole(&q);
  if (mover.motion) return robot_first_contact(&q, result);
  first_contact all = first_contact_begin();
  const cprox_status met = first_contact_with(&all, &q, 0, n);
  return met < 0 ? met : first_contact_conclude(&all, &q, result);
}

cprox_status cprox_first_contact(cprox_mover mover, cprox_target target, const cprox_options *options,
                                 cprox_workspace *workspace, cprox_result *result) {
  return cprox_first_contact_all(mover, &target, 1, options, workspace, result);
}
