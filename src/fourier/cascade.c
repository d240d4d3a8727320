/* SPDX-License-Identifier: BSD-3-Clause */
/* Certified gaps of one pair from coarse to fine: a coarse "clear" is final, so that only "may collide" goes on. */
#include <stdlib.h>

#include "base/workspace.h"
#include "fourier/gap.h"

enum { MOST_LEVELS = 8 };

struct cprox_gap_cascade {
  size_t n;
  cprox_gap *level[MOST_LEVELS];
};

void cprox_gap_cascade_free(cprox_gap_cascade *cascade) {
  if (!cascade) return;
  for (size_t i = 0; i < cascade->n; i++) cprox_gap_free(cascade->level[i]);
  free(cascade);
}

cprox_status cprox_gap_cascade_create(const cprox_solid *a, const cprox_solid *b, const cprox_gap_options *options,
                                      cprox_workspace *workspace, cprox_gap_cascade **cascade) {
  WORKSPACE_USE(workspace);
  fourier_clear(workspace);
  if (!a || !b || !cascade)
    return fourier_fail(workspace, CPROX_INVALID, "%s is NULL", !a ? "a" : !b ? "b" : "cascade");
  cprox_gap_options used = gap_options(options);
  if (used.mode != CPROX_GAP_MODE_CERTIFIED)
    return fourier_fail(workspace, CPROX_INVALID,
                        "a cascade is certified: in the other modes a coarse clear says nothing");
  gap_plan plan;
  cprox_status status = gap_plan_choose(a, b, &used, workspace, &plan);
  if (status != CPROX_OK) return status;

  cprox_gap_cascade *made = calloc(1, sizeof *made);
  if (!made) return fourier_fail(workspace, CPROX_MEMORY, "no memory for a cascade");
  const uint32_t finest = 2 * (uint32_t)plan.N + 1;
  used.period = 0.0; /* each level has its own, */
  used.delta = 0.0;  /* and is told its samples */
  for (uint32_t n = 9; status == CPROX_OK && n < finest; n = 2 * n - 1) {
    used.samples = n;
    status = WORKSPACE_LEND(workspace, cprox_gap_create(a, b, &used, workspace, &made->level[made->n]));
    made->n += status == CPROX_OK;
  }
  used.samples = finest;
  used.period = gap_options(options).period;
  if (status == CPROX_OK)
    status = WORKSPACE_LEND(workspace, cprox_gap_create(a, b, &used, workspace, &made->level[made->n]));
  made->n += status == CPROX_OK;
  if (status != CPROX_OK) {
    cprox_gap_cascade_free(made);
    return status;
  }
  *cascade = made;
  return CPROX_OK;
}

const cprox_gap *cprox_gap_cascade_finest(const cprox_gap_cascade *cascade) {
  return cascade->level[cascade->n - 1];
}

cprox_status cprox_gap_cascade_test(const cprox_gap_cascade *cascade, const cprox_pose *pose_a,
                                    const cprox_pose *pose_b, cprox_workspace *workspace, cprox_gap_result *result) {
  WORKSPACE_USE(workspace);
  if (!cascade || !workspace || !result)
    return fourier_fail(workspace, CPROX_INVALID, "%s is NULL",
                        !cascade     ? "cascade"
                        : !workspace ? "workspace"
                                     : "result");
  uint32_t terms = 0;
  for (size_t i = 0; i < cascade->n; i++) {
    const cprox_status status =
        WORKSPACE_LEND(workspace, cprox_gap_test(cascade->level[i], pose_a, pose_b, workspace, result));
    if (status < CPROX_OK) return status;
    terms += result->terms;
    if (result->verdict == CPROX_GAP_VERDICT_CLEAR || result->verdict == CPROX_GAP_VERDICT_FAR) break;
  }
  result->terms = terms;
  return CPROX_OK;
}
