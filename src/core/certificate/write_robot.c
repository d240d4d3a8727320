/* SPDX-License-Identifier: BSD-3-Clause */
/* A certificate for an answer about a robot along a motion. It is about hulls where there are meshes. */
#include "base/rounding.h"
#include "certificate/describe.h"
#include "certificate/partition_robot.h"
#include "certificate/write.h"
#include "problem/problem.h"

#define SHORTEST_SINGLE 0x1p-16
#define SHORTEST_DOUBLE 0x1p-40
enum { MOST_PAIRS = 0xffff };

/* CPROX_OK, or what it is that certificates do not know. */
static cprox_status check_kinds(const cprox_motion *motion, const cprox_obstacle *targets, size_t n,
                                cprox_workspace *workspace) {
  if (!motion_is_described(motion))
    return workspace_fail(workspace, CPROX_INVALID,
                          "no certificates: joined motions, and joints that turn by slerp, screws or rotation vectors");
  const cprox_robot *robot = motion->robot;
  const size_t geometry = describe_unknown_geometry(robot);
  if (geometry < robot->n_geometries)
    return workspace_fail(workspace, CPROX_INVALID, "geometry %zu is of a kind that has no certificates: %s", geometry,
                          cprox_body_kind_name(describe_unknown_kind(robot->given_geometries[geometry].body)->kind));
  for (size_t i = 0; i < n; i++)
    if (describe_unknown_kind(targets[i].body))
      return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu is of a kind that has no certificates: %s", i,
                            cprox_body_kind_name(describe_unknown_kind(targets[i].body)->kind));
  return CPROX_OK;
}

static cprox_status attempt(robot_scene *scene, uint32_t width, double delta, uint32_t budget, cprox_certificate *c) {
  robot_cover cover = {.scene = scene, .delta = delta, .budget = budget, .certificate = c};
  cover.shortest = width == 4 ? SHORTEST_SINGLE : SHORTEST_DOUBLE;
  certificate_begin(c, width, CPROX_CLAIM_APART, delta, (uint32_t)scene->n_pairs);
  const cprox_status status = partition_robot(&cover);
  return status == CPROX_OK && c->failed ? CPROX_MEMORY : status;
}

/* What the search's bounds prove with planes that turn, planes that stand may not: the claim about a distance gives
 * away epsilon. */
static cprox_status certify_clear(robot_scene *scene, double delta, const cprox_result *answer, double epsilon,
                                  uint32_t budget, cprox_certificate *c) {
  cprox_status status = attempt(scene, 4, delta, budget, c);
  if (status > 0) status = attempt(scene, 8, delta, budget, c);
  const bool distance = answer && answer->verdict == CPROX_VERDICT_UNDECIDED && delta == answer->lower;
  if (status > 0 && distance && delta > epsilon) status = attempt(scene, 4, delta - epsilon, budget, c);
  return status;
}

cprox_status certify_robot(const cprox_mover *mover, const cprox_obstacle *targets, size_t n, double delta,
                           const cprox_result *answer, const cprox_options *options, cprox_workspace *workspace,
                           cprox_certificate *certificate) {
  query q = query_create(*mover, targets, n, delta, false, options, workspace);
  q.options.max_lod = CPROX_LOD_HULL;
  const cprox_status known = check_kinds(mover->motion, targets, n, workspace);
  if (known != CPROX_OK) return known;
  robot_scene scene;
  if (!robot_scene_begin(&scene, &q, NULL, 0, n, SIZE_MAX, INFINITY)) return CPROX_MEMORY;
  for (size_t i = 0; i < scene.motion->robot->n_parts; i++) scene.parts[i].body.side.margin_turns = true;
  if (scene.n_pairs > MOST_PAIRS)
    return workspace_fail(workspace, CPROX_INVALID, "%zu pairs are too many for a certificate", scene.n_pairs);
  const double epsilon = answer ? width_allowed(options->epsilon, options->relative_epsilon, answer->upper) : 0.0;
  const robot_cover near = {.scene = &scene, .delta = delta, .certificate = certificate};
  const bool distance = answer && answer->verdict == CPROX_VERDICT_UNDECIDED && delta == answer->lower && delta > 0.0;
  if (answer && answer->upper <= delta) {
    const cprox_status status = partition_robot_near(&near, answer);
    if (status == CPROX_OK || status == CPROX_MEMORY || !distance) return status;
  }
  return certify_clear(&scene, delta, answer, epsilon, options->max_nodes, certificate);
}
