/* SPDX-License-Identifier: BSD-3-Clause */
/* Distance, tolerance, collision: of one mover against one target or against many. All six are one search. */
#include "base/workspace.h"
#include "certificate/certificate.h"
#include "problem/validate.h"
#include "solve/list.h"
#include "solve/solve.h"

static arguments_query query_of(const query *q, bool each) {
  const unsigned has =
      ARGUMENTS_SEARCH | ARGUMENTS_CERTIFICATE | ARGUMENTS_INTERVAL | ARGUMENTS_RADIUS | (each ? 0 : ARGUMENTS_WHOLE);
  if (!query_wants_verdict(q))
    return (arguments_query){"distance", has | ARGUMENTS_SIGNED | (each ? 0 : ARGUMENTS_SHARE)};
  return (arguments_query){q->is_tolerance ? "tolerance" : "collision", has};
}

static cprox_status ask(query *q, cprox_result *nearest, cprox_result *each) {
  const arguments_query asked = query_of(q, each != NULL);
  cprox_certificate_clear(q->options.certificate);
  cprox_status status = query_begin(q, asked);
  if (status != CPROX_OK) return status;
  status = each ? solve_each(q, nearest, each) : solve_query(q, 0, q->n, INFINITY, nearest);
  if (status >= 0 && q->options.certificate) q->options.certificate->prove(q, nearest);
  return status;
}

/* ---- the queries ---- */

cprox_status list_distance(cprox_mover mover, const cprox_obstacle *targets, size_t n, const cprox_options *options,
                           cprox_workspace *workspace, cprox_result *nearest, cprox_result *each) {
  query q = query_create(mover, targets, n, -1.0, false, options, workspace);
  q.is_signed = q.options.signed_distance;
  return ask(&q, nearest, each);
}

cprox_status list_tolerance(cprox_mover mover, const cprox_obstacle *targets, size_t n, double delta,
                            const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                            cprox_result *each) {
  cprox_certificate_clear(arguments_options(options).certificate);
  const cprox_status checked = validate_delta(delta, workspace);
  if (checked != CPROX_OK) return checked;
  query q = query_create(mover, targets, n, delta, true, options, workspace);
  return ask(&q, nearest, each);
}

cprox_status list_collision(cprox_mover mover, const cprox_obstacle *targets, size_t n, const cprox_options *options,
                            cprox_workspace *workspace, cprox_result *nearest, cprox_result *each) {
  query q = query_create(mover, targets, n, 0.0, false, options, workspace);
  return ask(&q, nearest, each);
}

cprox_status cprox_distance(cprox_mover mover, cprox_obstacle target, const cprox_options *options,
                            cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  return list_distance(mover, &target, 1, options, workspace, result, NULL);
}

cprox_status cprox_tolerance(cprox_mover mover, cprox_obstacle target, double delta, const cprox_options *options,
                             cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  return list_tolerance(mover, &target, 1, delta, options, workspace, result, NULL);
}

cprox_status cprox_collision(cprox_mover mover, cprox_obstacle target, const cprox_options *options,
                             cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  return list_collision(mover, &target, 1, options, workspace, result, NULL);
}
