/* SPDX-License-Identifier: BSD-3-Clause */
#include "solve/robot_verdict.h"

#include <math.h>

#include "edges/first_level.h"
#include "robot_query/answer.h"

/* Asks the search about these pairs, between these times. */
static cprox_status search(const query *q, const edge_rest *rest, double cutoff, cprox_result *result) {
  query part = *q;
  const bool self = mover_is_self(&q->mover);
  part.mover.pairs = self ? rest->self_pairs : rest->pairs;
  part.mover.n_pairs = self ? rest->n_self_pairs : rest->n_pairs;
  part.mover.self_pairs = rest->self_pairs, part.mover.n_self_pairs = rest->n_self_pairs;
  part.set = NULL;
  part.t0 = rest->from, part.t1 = rest->to;
  return robot_answer(&part, rest->first, rest->last, cutoff, result);
}

/* What errors leave along the normal of a measured distance is no distance of an execution: another normal may leave
 * more, which the search can find. */
static bool is_sure(const query *q) {
  return !q->errors || q->errors->left + q->errors->loss <= q->limit;
}

cprox_status robot_verdict(const query *q, size_t first, size_t last, double cutoff, cprox_result *result) {
  const uint64_t done = workspace_work(q->workspace);
  edge_first known;
  for (int suspects = 1; edge_first_level(q, first, last, suspects, &known); suspects = 0) {
    /* a measurement is what proves contact; of what is clear it is the witness */
    const bool clear = known.verdict == CPROX_VERDICT_CLEAR, violated = known.verdict == CPROX_VERDICT_VIOLATED;
    cprox_result r = query_nothing();
    r.mover_part = -1, r.lod = CPROX_LOD_HULL;
    const cprox_status status =
        clear && q->is_bare ? CPROX_OK : search(q, clear ? &known.nearest : &known.rest, cutoff, &r);
    if (status < 0) return status;
    if (!violated || (r.verdict == CPROX_VERDICT_VIOLATED && is_sure(q))) {
      /* everything else is farther than known.lower */
      r.lower = clear ? known.lower : lesser(violated ? 0.0 : known.lower, r.lower);
      if (q->errors) r.upper = greater(r.lower, r.upper); /* what is left of a pair is bounded in another way */
      *result = r;
      return query_conclude(q, cutoff, r.status, result);
    }
    workspace_forget_work(q->workspace);
    workspace_add_work(q->workspace, done);
    if (!known.is_suspect) break;
  }
  return robot_answer(q, first, last, cutoff, result);
}
