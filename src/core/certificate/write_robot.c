/* SPDX-License-Identifier: BSD-3-Clause */
/* A certificate for an answer about a robot along a motion. It is about the hulls of links that are meshes. */
#include <math.h>

#include "base/rounding.h"
#include "certificate/describe.h"
#include "certificate/partition_robot.h"
#include "certificate/write.h"
#include "problem/problem.h"

#define SHORTEST_SINGLE 0x1p-16
#define SHORTEST_DOUBLE 0x1p-40
enum { MOST_PAIRS = 0xffff };

/* Where a claim about the time before contact ends is a multiple of this part of a segment. */
#define FINEST_END 0x1p-30
static const double STEPS_BACK = 16.0;

/* CPROX_OK, or what it is that certificates do not know. */
static cprox_status check_kinds(const cprox_motion *motion, const cprox_obstacle *obstacles, size_t n,
                                cprox_workspace *workspace) {
  if (!motion_is_described(motion))
    return workspace_fail(
        workspace, CPROX_INVALID,
        "no certificates: starts with a tolerance, and joints that move by screws or rotation vectors");
  const cprox_robot *robot = motion->robot;
  const size_t geometry = describe_unknown_geometry(robot);
  if (geometry < robot->n_geometries)
    return workspace_fail(workspace, CPROX_INVALID, "geometry %zu is of a kind that has no certificates: %s", geometry,
                          cprox_body_kind_name(describe_unknown_kind(robot->given_geometries[geometry].body)->kind));
  for (size_t i = 0; i < n; i++)
    if (describe_unknown_obstacle(obstacles[i].body))
      return workspace_fail(workspace, CPROX_INVALID, "obstacle %zu is of a kind that has no certificates: %s", i,
                            cprox_body_kind_name(describe_unknown_obstacle(obstacles[i].body)->kind));
  return CPROX_OK;
}

static cprox_status attempt(const robot_cover *of, cprox_claim claim, uint32_t width, double delta) {
  robot_cover cover = *of;
  cover.delta = delta;
  cover.shortest = width == 4 ? SHORTEST_SINGLE : SHORTEST_DOUBLE;
  certificate_begin(of->certificate, width, claim, delta, (uint32_t)of->scene->n_pairs);
  if (claim == CPROX_CLAIM_DURING) {
    certificate_count(of->certificate, (uint32_t)of->first);
    certificate_number(of->certificate, of->begin);
  }
  if (claim == CPROX_CLAIM_BEFORE || claim == CPROX_CLAIM_DURING) {
    certificate_count(of->certificate, (uint32_t)of->last);
    certificate_number(of->certificate, of->end);
  }
  const cprox_status status = partition_robot(&cover);
  return status == CPROX_OK && of->certificate->failed ? CPROX_MEMORY : status;
}

/* ---- elements ---- */

/* About the origin of its tree. Sums of lengths that the tree reaches, turned once. */
static robot_body placed_elements(const robot_body *owner) {
  robot_body body = *owner;
  const double scale = owner->tree->scale;
  body.tree = NULL, body.clusters = NULL, body.winding = NULL;
  body.side.margin = owner->tree_margin;
  body.side.at.p = placement_apply(&owner->side.at, owner->tree_at);
  body.side.error +=
      ROUND_UP * ROUND_U * (ROUND_ROTATION * (vec_norm(owner->tree_at) + 2.0 * scale) + 3.0 * vec_norm(body.side.at.p));
  body.radius = scale + owner->tree_margin;
  return body;
}

const robot_cover_elements *partition_robot_begin(robot_scene *s) {
  for (size_t i = 0; i < s->motion->robot->n_parts; i++) {
    robot_body *body = &s->parts[i].body;
    body->tree = NULL, body->clusters = NULL, body->winding = NULL;
  }
  size_t packs = 0;
  for (size_t i = 0; i < s->n_obstacles; i++) packs += s->obstacles[i].tree ? s->obstacles[i].tree->n_packs : 0;
  robot_cover_elements *elements = workspace_reserve(
      s->q->workspace, WORKSPACE_COVER_ELEMENTS, (s->n_obstacles + 1) * sizeof *elements + packs * sizeof(uint32_t));
  if (!elements) return NULL;
  uint32_t *first = (uint32_t *)(void *)(elements + s->n_obstacles + 1);
  for (size_t i = 0; i < s->n_obstacles; i++) {
    const robot_body *o = &s->obstacles[i];
    elements[i] = (robot_cover_elements){.order = {.t = NULL}};
    if (!o->tree) continue;
    elements[i].order = elements_order(o->tree, first);
    elements[i].body = elements_body(body_part_at(s->q->obstacles[o->index].body, (size_t)o->part));
    elements[i].standing = placed_elements(o);
    first += o->tree->n_packs;
  }
  return elements;
}

/* ---- claims ---- */

/* What the search's bounds prove with planes that turn, planes that stand may not: the claim about a distance gives
 * away epsilon. */
static cprox_status certify_clear(const robot_cover *cover, bool distance, double epsilon) {
  const double delta = cover->delta;
  cprox_status status = attempt(cover, CPROX_CLAIM_APART, 4, delta);
  if (status > 0) status = attempt(cover, CPROX_CLAIM_APART, 8, delta);
  if (status > 0 && distance && delta > epsilon) status = attempt(cover, CPROX_CLAIM_APART, 4, delta - epsilon);
  return status;
}

/* The place of the motion at t, on the grid of ends; *u may be 1. */
static size_t place_at(const cprox_motion *m, double t, double (*rounded)(double), double *u) {
  size_t segment = 0;
  while (segment + 1 < m->n_segments && m->times[segment + 1] <= t) segment++;
  const double length = m->times[segment + 1] - m->times[segment];
  *u = FINEST_END * rounded(fmin(fmax((t - m->times[segment]) / length, 0.0), 1.0) / FINEST_END);
  return segment;
}

/* How far before the time it must end is found by steps back from it, each larger than the one before. */
static cprox_status certify_before(robot_cover *cover, double t) {
  double at;
  const size_t segment = place_at(cover->scene->motion, t, floor, &at);
  cprox_status status = CPROX_PRECISION;
  for (double back = 0.0; status > 0; back = fmax(STEPS_BACK * back, FINEST_END)) {
    cover->last = segment, cover->end = at - back;
    if (!(cover->end > 0.0)) {
      if (segment == 0 || back > 1.0) return CPROX_PRECISION;
      cover->last = segment - 1, cover->end = fmax(1.0 - back, FINEST_END);
    }
    status = attempt(cover, CPROX_CLAIM_BEFORE, 4, cover->delta);
    if (status > 0) status = attempt(cover, CPROX_CLAIM_BEFORE, 8, cover->delta);
  }
  return status;
}

/* Both ends alike; of a distance the interval stays, and epsilon is given away. */
static cprox_status certify_during(robot_cover *cover, const claim_wanted *wanted, bool distance, double epsilon) {
  const cprox_motion *m = cover->scene->motion;
  double from, to;
  const size_t first = place_at(m, wanted->t0, distance ? floor : ceil, &from);
  const size_t last = place_at(m, wanted->t1, distance ? ceil : floor, &to);
  cprox_status status = CPROX_PRECISION;
  for (double back = 0.0; status > 0; back = fmax(STEPS_BACK * back, FINEST_END)) {
    cover->first = first, cover->begin = from + back, cover->last = last, cover->end = to - back;
    if (cover->begin >= 1.0 && first < last) cover->first++, cover->begin = fmin(back, 1.0);
    if (!(cover->end > 0.0) && cover->first < cover->last) cover->last--, cover->end = fmax(1.0 - back, FINEST_END);
    if (back > CLAIM_MOST_BACK || cover->begin > 1.0 || !(cover->end > 0.0) ||
        (cover->first == cover->last && !(cover->begin < cover->end)))
      return CPROX_PRECISION;
    status = attempt(cover, CPROX_CLAIM_DURING, 4, cover->delta);
    if (status > 0) status = attempt(cover, CPROX_CLAIM_DURING, 8, cover->delta);
    if (status <= 0 || !distance) continue;
    if (!(cover->delta > epsilon)) return status;
    status = attempt(cover, CPROX_CLAIM_DURING, 4, cover->delta - epsilon);
    return status > 0 ? attempt(cover, CPROX_CLAIM_DURING, 8, cover->delta - epsilon) : status;
  }
  return status;
}

cprox_status certify_robot(const cprox_mover *mover, const cprox_obstacle *obstacles, size_t n, claim_wanted wanted,
                           const cprox_result *answer, const cprox_options *options, cprox_workspace *workspace,
                           cprox_certificate *certificate) {
  const double delta = wanted.delta;
  query q = query_create(*mover, obstacles, n, delta, options, workspace);
  q.options.max_lod = CPROX_LOD_MESH;
  const cprox_status known = check_kinds(mover->motion, obstacles, n, workspace);
  if (known != CPROX_OK) return known;
  robot_scene scene;
  if (!robot_scene_begin(&scene, &q, NULL, 0, n, SIZE_MAX, INFINITY)) return CPROX_MEMORY;
  for (size_t i = 0; i < scene.motion->robot->n_parts; i++) {
    robot_body *body = &scene.parts[i].body;
    body->side.margin_turns = true;
    body->core = robot_core_radius(body);
  }
  if (scene.n_pairs > MOST_PAIRS)
    return workspace_fail(workspace, CPROX_INVALID, "%zu pairs are too many for a certificate", scene.n_pairs);
  const double epsilon = answer ? width_allowed(options->epsilon, options->relative_epsilon, answer->upper) : 0.0;
  const robot_cover_elements *elements = partition_robot_begin(&scene);
  if (!elements) return CPROX_MEMORY;
  robot_cover cover = {.scene = &scene,
                       .elements = elements,
                       .delta = delta,
                       .budget = options->max_nodes,
                       .last = scene.motion->n_segments - 1,
                       .end = 1.0,
                       .certificate = certificate};
  if (wanted.apart == CPROX_CLAIM_BEFORE) return certify_before(&cover, wanted.t1);
  const bool distance = answer && answer->verdict == CPROX_VERDICT_UNDECIDED && delta == answer->lower;
  if (wanted.apart == CPROX_CLAIM_DURING) return certify_during(&cover, &wanted, distance, epsilon);
  if (answer && answer->upper <= delta) {
    const cprox_status status = partition_robot_near(&cover, answer);
    if (status == CPROX_OK || status == CPROX_MEMORY || !distance || !(delta > 0.0)) return status;
  }
  return certify_clear(&cover, distance, epsilon);
}
