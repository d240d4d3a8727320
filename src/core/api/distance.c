/* SPDX-License-Identifier: BSD-3-Clause */
/* Distance, tolerance, collision: of one mover against one obstacle or against many. All six are one search. */
#include "base/workspace.h"
#include "certificate/certificate.h"
#include "problem/validate.h"
#include "solve/list.h"
#include "solve/solve.h"

/* delta < 0: a distance. */
static cprox_status ask(const char *name, cprox_mover mover, const cprox_obstacle *obstacles, size_t n, double delta,
                        const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                        cprox_result *each) {
  cprox_certificate_clear(validate_defaults(options).certificate);
  query q = query_create(mover, obstacles, n, delta, options, workspace);
  arguments_query asked = {name, ARGUMENTS_SEARCH | ARGUMENTS_CERTIFICATE | ARGUMENTS_INTERVAL | ARGUMENTS_RADIUS};
  if (!each) asked.has |= ARGUMENTS_WHOLE;
  if (!query_wants_verdict(&q)) {
    asked.has |= ARGUMENTS_SIGNED | (each ? 0 : ARGUMENTS_SHARE);
    q.is_signed = q.options.signed_distance;
  }
  cprox_status status = query_begin(&q, asked);
  if (status != CPROX_OK) return status;
  status = each ? solve_each(&q, nearest, each) : solve_query(&q, 0, n, INFINITY, nearest);
  if (status >= 0 && q.options.certificate) q.options.certificate->prove(&q, nearest);
  return status;
}

/* ---- the queries ---- */

cprox_status list_distance(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, const cprox_options *options,
                           cprox_workspace *workspace, cprox_result *nearest, cprox_result *each) {
  return ask("distance", mover, obstacles, n, -1.0, options, workspace, nearest, each);
}

cprox_status list_tolerance(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, double delta,
                            const cprox_options *options, cprox_workspace *workspace, cprox_result *nearest,
                            cprox_result *each) {
  cprox_certificate_clear(validate_defaults(options).certificate);
  const cprox_status checked = validate_delta(delta, workspace);
  return checked == CPROX_OK ? ask("tolerance", mover, obstacles, n, delta, options, workspace, nearest, each)
                             : checked;
}

cprox_status list_collision(cprox_mover mover, const cprox_obstacle *obstacles, size_t n, const cprox_options *options,
                            cprox_workspace *workspace, cprox_result *nearest, cprox_result *each) {
  return ask("collision", mover, obstacles, n, 0.0, options, workspace, nearest, each);
}

cprox_status cprox_distance(cprox_mover mover, cprox_obstacle obstacle, const cprox_options *options,
                            cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  return list_distance(mover, &obstacle, 1, options, workspace, result, NULL);
}

cprox_status cprox_tolerance(cprox_mover mover, cprox_obstacle obstacle, double delta, const cprox_options *options,
                             cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  return list_tolerance(mover, &obstacle, 1, delta, options, workspace, result, NULL);
}

cprox_status cprox_collision(cprox_mover mover, cprox_obstacle obstacle, const cprox_options *options,
                             cprox_workspace *workspace, cprox_result *result) {
  WORKSPACE_USE(workspace);
  return list_collision(mover, &obstacle, 1, options, workspace, result, NULL);
}
