/* SPDX-License-Identifier: BSD-3-Clause */
#define _POSIX_C_SOURCE 200809L
#include "support/robot_queries.h"
#include "support/of_list.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

/* One that ends somewhere: a link's. */
static cprox_body *bounded_body(rng *r, double scale, cprox_workspace *ws) {
  cprox_body *body = query_body(r, scale, false, ws);
  while (cprox_body_get_info(body).kind == CPROX_BODY_HALFSPACE) {
    cprox_body_free(body);
    body = query_body(r, scale, false, ws);
  }
  return body;
}

/* One body, a mesh, or a union of two. */
static cprox_body *one_or_two(robot_query *q, rng *r, bool bounded, double scale, bool meshes, cprox_workspace *ws) {
  if (meshes && rng_index(r, bounded ? 6 : 2) == 0) {
    query_mesh *mesh = &q->mesh[q->n_meshes++];
    if (!bounded && rng_index(r, 2))
      *mesh = query_elements_random(r, scale, ws);
    else
      *mesh = query_mesh_random(r, scale, rng_index(r, 2) ? CPROX_MESH_FILL_SURFACE : CPROX_MESH_FILL_SOLID, ws);
    return mesh->body;
  }
  cprox_body *one = bounded ? bounded_body(r, scale, ws) : query_body(r, scale, false, ws), *both = NULL;
  if (rng_index(r, 5)) return one;
  cprox_body *parts[2] = {one, bounded_body(r, scale, ws)};
  const cprox_pose poses[2] = {rng_pose(r, scale), rng_pose(r, scale)};
  for (int i = 0; i < 2; i++) q->loose[q->n_loose++] = parts[i];
  if (cprox_body_create_compound((const cprox_body *const *)parts, poses, 2, ws, &both) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  return both;
}

void robot_query_random(robot_query *q, rng *r, double speed, double apart, bool meshes, cprox_workspace *ws) {
  *q = (robot_query){.n = 1 + rng_index(r, ROBOT_QUERY_TARGETS)};
  robot_make(r, speed, &q->robot);
  for (size_t i = 0; i < q->robot.n_links; i++) {
    if (rng_index(r, 2)) continue;
    cprox_body_free((cprox_body *)q->robot.geometries[i].body);
    q->robot.geometries[i].body = one_or_two(q, r, true, 0.3, meshes, ws);
  }
  robot_rebuild(&q->robot);
  for (size_t i = 0; i < q->n; i++) {
    cprox_pose at = rng_pose(r, 0.3);
    at.position = vec_axpy(at.position, apart, rng_unit(r));
    q->targets[i] = cprox_obstacle_at(one_or_two(q, r, false, 0.5, meshes, ws), at);
    q->targets[i].margin = rng_index(r, 2) ? 0.0 : rng_uniform(r, 0.0, 0.1);
  }
  const bool self = rng_index(r, 3) == 0;
  q->mover = self ? cprox_robot_self(q->robot.motion, NULL, 0) : cprox_robot_along(q->robot.motion, NULL, 0);
  if (!self) return;
  for (size_t i = 0; i < q->n; i++) cprox_body_free((cprox_body *)q->targets[i].body);
  q->n = 0;
}

void robot_query_renew(robot_query *q, cprox_workspace *ws) {
  robot_flyer *f = &q->flyer;
  q->mover.motion = q->robot.motion;
  if (!f->body) return;
  cprox_motion_free(f->together);
  cprox_robot_free(f->joined);
  f->joined = NULL, f->together = NULL;
  const cprox_robot *robots[2] = {q->robot.robot, f->robot};
  const cprox_joined_motion motions[2] = {{.motion = q->robot.motion, .start = f->start}, {.motion = f->motion}};
  const cprox_motion_description d = {.kind = CPROX_MOTION_JOINED, .joined = motions, .n_joined = 2};
  if (cprox_robot_join(robots, NULL, 2, ws, &f->joined) != CPROX_OK ||
      cprox_motion_create(f->joined, &d, ws, &f->together) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  q->mover.motion = f->together;
}

void robot_query_fly(robot_query *q, rng *r, cprox_workspace *ws) {
  enum { POSES = 3 };
  static const int32_t SEVEN[7] = {0, 1, 2, 3, 4, 5, 6};
  robot_flyer *f = &q->flyer;
  f->body = bounded_body(r, 0.3, ws);
  const cprox_link link = {.parent = -1, .type = CPROX_JOINT_FLOATING, .origin = rng_pose(r, 0.5)};
  const cprox_link_geometry geometry = {.body = f->body, .pose = rng_pose(r, 0.2), .margin = 0.01};
  const cprox_motion_info own = cprox_motion_get_info(q->robot.motion);
  const double length = own.t1 - own.t0, part = length * rng_uniform(r, 0.1, 1.0);
  double values[POSES][7], rates[POSES][7];
  cprox_waypoint points[POSES];
  const size_t n = 2 + rng_index(r, POSES - 1);
  const bool fast = rng_index(r, 2);
  for (size_t i = 0; i < n; i++) {
    const cprox_pose at = rng_pose(r, 1.5);
    const vec3 x = at.position;
    const cprox_quat o = at.orientation;
    const double fresh[7] = {x.x, x.y, x.z, o.x, o.y, o.z, o.w};
    for (int k = 0; k < 7; k++) values[i][k] = i > 0 && !fast ? 0.9 * values[0][k] + 0.1 * fresh[k] : fresh[k];
    for (int k = 0; k < 7; k++) rates[i][k] = rng_uniform(r, -0.1, 0.1);
    points[i] = (cprox_waypoint){.time = 1.0 + part * (double)i / (double)(n - 1), .positions = values[i]};
    if (rng_index(r, 2)) points[i].velocities = rates[i];
  }
  if (rng_index(r, 4) == 0) memcpy(values[1] + 3, values[0] + 3, 4 * sizeof(double));
  const cprox_motion_description d = {.kind = CPROX_MOTION_WAYPOINTS,
                                      .variables = SEVEN,
                                      .n_variables = 7,
                                      .waypoints = points,
                                      .n_waypoints = n,
                                      .turning = CPROX_TURNING_SLERP};
  if (cprox_robot_create(&link, 1, &geometry, 1, 7, ws, &f->robot) != CPROX_OK ||
      cprox_motion_create(f->robot, &d, ws, &f->motion) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  f->start = 1.0 - own.t0 - rng_uniform(r, 0.0, 0.9) * length + 0.5 * part; /* so that both overlap */
  robot_query_renew(q, ws);
}

void robot_query_whole(robot_query *q, rng *r) {
  if (q->n > 0 && rng_index(r, 3) == 0) q->mover = cprox_robot_whole(q->mover, NULL, 0);
}

void robot_query_inequalities(robot_query *q, rng *r, cprox_workspace *ws) {
  for (size_t i = 0; i < q->n; i++) {
    if (rng_index(r, 2)) continue;
    cprox_body_free((cprox_body *)q->targets[i].body);
    q->targets[i].body = query_implicit(r, 0.5, ws);
  }
}

void robot_query_free(robot_query *q) {
  for (size_t i = 0; i < q->n; i++) cprox_body_free((cprox_body *)q->targets[i].body);
  cprox_motion_free(q->flyer.together);
  cprox_robot_free(q->flyer.joined);
  cprox_motion_free(q->flyer.motion);
  cprox_robot_free(q->flyer.robot);
  cprox_body_free(q->flyer.body);
  robot_free(&q->robot);
  for (size_t i = 0; i < q->n_loose; i++) cprox_body_free(q->loose[i]);
  for (size_t i = 0; i < q->n_meshes; i++) {
    q->mesh[i].body = NULL; /* it went with its link or its target */
    query_mesh_free(&q->mesh[i]);
  }
}

/* ---- text ---- */

/* A line a convex part, to be freed. */
static char *lines_of(const cprox_obstacle *target) {
  const size_t length = cprox_obstacle_describe(target, NULL, 0);
  char *text = calloc(length + 1, 1);
  cprox_obstacle_describe(target, text, length + 1);
  return text;
}

void robot_write_targets(const cprox_obstacle *targets, size_t n, FILE *out) {
  char *lines[ROBOT_QUERY_MOST];
  size_t count = 0;
  assert_true(n <= ROBOT_QUERY_MOST);
  for (size_t i = 0; i < n; i++) {
    lines[i] = lines_of(&targets[i]);
    for (const char *at = lines[i]; (at = strchr(at, '\n')); at++) count++;
  }
  fprintf(out, "cprox-problem 1\ntargets %zu\n", count);
  for (size_t i = 0; i < n; i++) {
    fputs(lines[i], out);
    free(lines[i]);
  }
}

void robot_write_mover(const cprox_mover *along, const cprox_obstacle *targets, size_t n, const char *id,
                       cprox_workspace *ws, FILE *out) {
  const size_t length = describe_mover_of_list(along, targets, n, id, ws, NULL, 0);
  if (length == 0) fail_msg("a robot is not described: %s", cprox_workspace_error(ws));
  char *text = calloc(length + 1, 1);
  describe_mover_of_list(along, targets, n, id, ws, text, length + 1);
  fputs(text, out);
  free(text);
}

robot_text robot_text_of(const cprox_mover *along, const cprox_obstacle *targets, size_t n, cprox_workspace *ws) {
  robot_text text = {.file = tmpfile()};
  robot_write_targets(targets, n, text.file);
  robot_write_mover(along, targets, n, "one", ws, text.file);
  rewind(text.file);
  if (!problem_open(&text.read, text.file) || !problem_next(&text.read))
    fail_msg("the checker does not read it: %s", text.read.fault);
  return text;
}

finding robot_text_check(const robot_text *text, const void *bytes, size_t size) {
  return check(&text->read, bytes, size);
}

void robot_text_free(robot_text *text) {
  problem_close(&text->read);
  fclose(text->file);
}
