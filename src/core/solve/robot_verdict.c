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

/* Everything else is farther than `lower`. */
static cprox_status conclude(const query *q, double cutoff, double lower, cprox_result *result) {
  result->lower = lesser(lower, result->lower);
  return query_conclude(q, cutoff, result->status, result);
}

/* Clear, without a witness. */
static cprox_status tell_clear(const query *q, double cutoff, double lower, cprox_result *result) {
  cprox_result r = query_nothing();
  r.mover_part = -1, r.lod = CPROX_LOD_HULL, r.status = CPROX_OK;
  const cprox_status status = conclude(q, cutoff, lower, &r);
  *result = r;
  return status;
}

/* A measurement is what proves contact; of what is clear it is the witness. */
static cprox_status measure(const query *q, const edge_first *known, double cutoff, cprox_result *result) {
  const bool clear = known->verdict == CPROX_VERDICT_CLEAR;
  cprox_result r;
  const cprox_status status = search(q, clear ? &known->nearest : &known->rest, cutoff, &r);
  if (status < 0) return status;
  *result = r;
  if (clear) result->lower = INFINITY;
  return clear || r.verdict == CPROX_VERDICT_VIOLATED ? conclude(q, cutoff, clear ? known->lower : 0.0, result)
                                                      : CPROX_OK;
}

cprox_status robot_verdict(const query *q, size_t first, size_t last, double cutoff, cprox_result *result) {
  const uint64_t done = workspace_work(q->workspace);
  edge_first known;
  for (int suspects = 1; edge_first_level(q, first, last, suspects, &known); suspects = 0) {
    if (q->is_bare && known.verdict == CPROX_VERDICT_CLEAR) return tell_clear(q, cutoff, known.lower, result);
    cprox_result r;
    const bool open = known.verdict == CPROX_VERDICT_UNDECIDED;
    const cprox_status status = open ? search(q, &known.rest, cutoff, &r) : measure(q, &known, cutoff, &r);
    if (status < 0) return status;
    if (open || known.verdict == CPROX_VERDICT_CLEAR || r.verdict == CPROX_VERDICT_VIOLATED) {
      *result = r;
      return open ? conclude(q, cutoff, known.lower, result) : status;
    }
    workspace_forget_work(q->workspace);
    workspace_add_work(q->workspace, done);
    if (!known.is_suspect) break;
  }
  return robot_answer(q, first, last, cutoff, result);
}
