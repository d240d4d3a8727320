/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/robots.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "kinematics/bound.h"

/* ---- random robots ---- */

static size_t width_of(cprox_joint_type type) {
  static const size_t WIDTH[] = {0, 1, 1, 3, 7, 6};
  return WIDTH[type];
}

static void make_links(rng *r, test_robot *t) {
  t->n_links = 2 + rng_index(r, TEST_MAX_LINKS - 1);
  t->n_variables = 0;
  for (size_t i = 0; i < t->n_links; i++) {
    static const cprox_joint_type OFTEN[] = {CPROX_JOINT_REVOLUTE,  CPROX_JOINT_REVOLUTE, CPROX_JOINT_REVOLUTE,
                                             CPROX_JOINT_PRISMATIC, CPROX_JOINT_FIXED,    CPROX_JOINT_PLANAR,
                                             CPROX_JOINT_FLOATING};
    cprox_link *l = &t->links[i];
    *l = (cprox_link){.parent = i == 0 ? -1 : (int32_t)(i - 1 - rng_index(r, i < 3 ? i : 3) % i),
                      .type = OFTEN[rng_index(r, 7)],
                      .origin = rng_pose(r, 0.4),
                      .axis = vec_scale(rng_log_uniform(r, 0.1, 10), rng_unit(r)),
                      .multiplier = 1.0};
    if (t->n_variables + width_of(l->type) > TEST_MAX_VARIABLES) l->type = CPROX_JOINT_FIXED;
    /* some joints mimic the one before */
    const bool single = width_of(l->type) == 1;
    if (single && i > 0 && width_of(t->links[i - 1].type) == 1 && rng_index(r, 4) == 0) {
      l->variable = t->links[i - 1].variable;
      l->multiplier = rng_uniform(r, -2, 2), l->offset = rng_uniform(r, -1, 1);
      continue;
    }
    l->variable = (int32_t)t->n_variables;
    t->n_variables += width_of(l->type);
  }
}

static void make_geometries(rng *r, test_robot *t) {
  t->margin = rng_index(r, 2) ? 0.0 : rng_uniform(r, 0, 0.05);
  for (size_t i = 0; i < t->n_links; i++) {
    cprox_body *body = NULL;
    for (size_t k = 0; k < TEST_VERTICES; k++) t->vertices[i][k] = rng_in_cube(r, 0.2);
    assert_int_equal(cprox_body_create_polytope(t->vertices[i], TEST_VERTICES, NULL, &body), CPROX_OK);
    t->geometries[i] =
        (cprox_link_geometry){.body = body, .pose = rng_pose(r, 0.2), .link = (int32_t)i, .margin = t->margin};
  }
}

/* ---- random motions ---- */

static void draw_points(rng *r, double speed, test_robot *t) {
  for (size_t k = 0; k < t->n_variables; k++) {
    t->variables[k] = (int32_t)k;
    t->rest[k] = t->positions[0][k] = rng_uniform(r, -2, 2);
  }
  for (size_t i = 0; i < t->n_points; i++)
    for (size_t k = 0; k < t->n_variables; k++) {
      if (i > 0) t->positions[i][k] = t->positions[i - 1][k] + rng_uniform(r, -speed, speed);
      t->velocities[i][k] = rng_uniform(r, -speed, speed);
      t->accelerations[i][k] = rng_uniform(r, -speed, speed);
    }
  t->times[0] = rng_uniform(r, -1, 1);
  for (size_t i = 1; i < t->n_points + TEST_SPLINE_DEGREE + 1; i++)
    t->times[i] = t->times[i - 1] + rng_uniform(r, 0.5, 1.5);
}

static void make_points(rng *r, double speed, test_robot *t) {
  t->spline = rng_index(r, 4) == 0;
  t->interpolation = (cprox_interpolation)(CPROX_INTERPOLATION_LINEAR + rng_index(r, 3));
  t->n_points = t->spline ? TEST_WAYPOINTS : 2 + rng_index(r, TEST_WAYPOINTS - 1);
  draw_points(r, speed, t);
}

/* Quaternions stay away from 0: their real part is large. */
static void tame_quaternions(test_robot *t) {
  for (size_t i = 0; i < t->n_links; i++) {
    if (t->links[i].type != CPROX_JOINT_FLOATING) continue;
    const size_t w = (size_t)t->links[i].variable + 6;
    t->rest[w] += 5.0;
    for (size_t k = 0; k < t->n_points; k++) t->positions[k][w] += 5.0;
  }
}

static void build(test_robot *t) {
  cprox_workspace *ws = cprox_workspace_create();
  if (cprox_robot_create(t->links, t->n_links, t->geometries, t->n_links, t->n_variables, ws, &t->robot) != CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  cprox_status status;
  if (t->spline) {
    double control[TEST_MAX_WAYPOINTS * TEST_MAX_VARIABLES];
    for (size_t i = 0; i < t->n_points; i++)
      memcpy(control + i * t->n_variables, t->positions[i], t->n_variables * sizeof *control);
    const size_t degree = TEST_SPLINE_DEGREE;
    status = cprox_motion_create(t->robot,
                                 &(cprox_motion_description){.kind = CPROX_MOTION_BSPLINE,
                                                             .variables = t->variables,
                                                             .n_variables = t->n_variables,
                                                             .degree = degree,
                                                             .control = control,
                                                             .n_control = t->n_points,
                                                             .knots = t->times,
                                                             .n_knots = t->n_points + degree + 1,
                                                             .rest = t->rest},
                                 ws, &t->motion);
  } else {
    cprox_waypoint points[TEST_MAX_WAYPOINTS];
    for (size_t i = 0; i < t->n_points; i++)
      points[i] = (cprox_waypoint){t->times[i], t->positions[i], t->velocities[i], t->accelerations[i]};
    status = cprox_motion_create(t->robot,
                                 &(cprox_motion_description){.kind = CPROX_MOTION_WAYPOINTS,
                                                             .variables = t->variables,
                                                             .n_variables = t->n_variables,
                                                             .turning = t->turning,
                                                             .waypoints = points,
                                                             .n_waypoints = t->n_points,
                                                             .interpolation = t->interpolation,
                                                             .rest = t->rest},
                                 ws, &t->motion);
  }
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws));
  cprox_workspace_free(ws);
}

void robot_make_turning(rng *r, double speed, cprox_turning turning, size_t n_points, test_robot *t) {
  t->n_links = 1 + rng_index(r, 3);
  t->n_variables = 0;
  for (size_t i = 0; i < t->n_links; i++) {
    t->links[i] = (cprox_link){.parent = rng_index(r, 2) ? -1 : (int32_t)i - 1,
                               .type = rng_index(r, 3) ? CPROX_JOINT_FLOATING : CPROX_JOINT_ROTATION_VECTOR,
                               .origin = rng_pose(r, 0.4),
                               .variable = (int32_t)t->n_variables};
    t->n_variables += width_of(t->links[i].type);
  }
  make_geometries(r, t);
  t->turning = turning;
  t->spline = turning == CPROX_TURNING_POLYNOMIAL && rng_index(r, 2);
  t->interpolation = (cprox_interpolation)(CPROX_INTERPOLATION_LINEAR + rng_index(r, 3));
  t->n_points = t->spline && n_points < TEST_WAYPOINTS ? TEST_WAYPOINTS : n_points;
  draw_points(r, speed, t);
  if (turning == CPROX_TURNING_POLYNOMIAL) tame_quaternions(t);
  build(t);
}

void robot_make(rng *r, double speed, test_robot *t) {
  t->turning = CPROX_TURNING_POLYNOMIAL;
  make_links(r, t);
  make_geometries(r, t);
  make_points(r, speed, t);
  tame_quaternions(t);
  build(t);
}

void robot_draw_motion(rng *r, double speed, size_t n_points, test_robot *t) {
  t->n_points = n_points;
  draw_points(r, speed, t);
  tame_quaternions(t);
}

void robot_rebuild(test_robot *t) {
  cprox_motion_free(t->motion);
  cprox_robot_free(t->robot);
  build(t);
}

void robot_free(test_robot *t) {
  cprox_motion_free(t->motion);
  cprox_robot_free(t->robot);
  for (size_t i = 0; i < t->n_links; i++) cprox_body_free((cprox_body *)t->geometries[i].body);
}

/* ---- values ---- */

static long double hermite(const test_robot *t, size_t i, size_t k, long double time) {
  const long double h = (long double)t->times[i + 1] - t->times[i], u = (time - t->times[i]) / h;
  const long double p = t->positions[i][k], q = t->positions[i + 1][k];
  if (t->interpolation == CPROX_INTERPOLATION_LINEAR) return p + u * (q - p);
  const long double v = h * t->velocities[i][k], w = h * t->velocities[i + 1][k], u2 = u * u, u3 = u2 * u;
  if (t->interpolation == CPROX_INTERPOLATION_CUBIC)
    return (2 * u3 - 3 * u2 + 1) * p + (u3 - 2 * u2 + u) * v + (3 * u2 - 2 * u3) * q + (u3 - u2) * w;
  const long double a = h * h * t->accelerations[i][k], b = h * h * t->accelerations[i + 1][k], u4 = u3 * u,
                    u5 = u4 * u;
  return (1 - 10 * u3 + 15 * u4 - 6 * u5) * p + (u - 6 * u3 + 8 * u4 - 3 * u5) * v +
         (u2 / 2 - 1.5L * u3 + 1.5L * u4 - u5 / 2) * a + (10 * u3 - 15 * u4 + 6 * u5) * q +
         (-4 * u3 + 7 * u4 - 3 * u5) * w + (u3 / 2 - u4 + u5 / 2) * b;
}

static long double de_boor(const test_robot *t, size_t k, long double time) {
  const size_t p = TEST_SPLINE_DEGREE;
  size_t span = p;
  while (span + 1 < t->n_points && time >= t->times[span + 1]) span++;
  long double d[TEST_SPLINE_DEGREE + 1];
  for (size_t i = 0; i <= p; i++) d[i] = t->positions[span - p + i][k];
  for (size_t r = 1; r <= p; r++)
    for (size_t i = p; i >= r; i--) {
      const long double left = t->times[span - p + i], right = t->times[i + 1 + span - r];
      const long double s = (time - left) / (right - left);
      d[i] = (1 - s) * d[i - 1] + s * d[i];
    }
  return d[p];
}

static void unit_quaternion(const double *given, long double *q) {
  long double square = 0;
  for (int k = 0; k < 4; k++) square += (long double)given[k] * given[k];
  for (int k = 0; k < 4; k++) q[k] = given[k] / sqrtl(square);
}

/* On the great circle through two unit quaternions, the shorter way. Returns half the angle of the whole turn; the
 * other one is part of the circle's plane: q(s) = p cos(half s) + side sin(half s). */
static long double great_circle(const double *from, const double *to, long double *p, long double *side) {
  long double q[4], along = 0, across = 0;
  unit_quaternion(from, p);
  unit_quaternion(to, q);
  for (int k = 0; k < 4; k++) along += p[k] * q[k];
  for (int k = 0; k < 4; k++) side[k] = (along < 0 ? -q[k] : q[k]) - fabsl(along) * p[k];
  for (int k = 0; k < 4; k++) across += side[k] * side[k];
  across = sqrtl(across);
  for (int k = 0; k < 4 && across > 0; k++) side[k] /= across;
  return atan2l(across, fabsl(along));
}

/* x -> (e^(i s angle) - 1) / (e^(i angle) - 1) x in the plane across the axis, s along it. */
static vec3l screw_way(vec3l way, vec3l axis, long double angle, long double s) {
  const vec3l along = ref_scale(ref_dot(way, axis), axis), across = ref_sub(way, along), up = ref_cross(axis, across);
  if (angle == 0) return ref_scale(s, way);
  const long double h = sinl(s * angle / 2), g = sinl(angle / 2);
  const long double a = -2 * h * h, b = sinl(s * angle), c = -2 * g * g, d = sinl(angle), n = c * c + d * d;
  const vec3l turned = ref_add(ref_scale((a * c + b * d) / n, across), ref_scale((b * c - a * d) / n, up));
  return ref_add(ref_scale(s, along), turned);
}

/* The pose of a floating joint between two waypoints. */
static void turn_values(const test_robot *t, size_t i, size_t v, long double time, long double *values) {
  const double *a = t->positions[i] + v, *b = t->positions[i + 1] + v;
  const long double s = (time - t->times[i]) / ((long double)t->times[i + 1] - t->times[i]);
  long double p[4], side[4];
  const long double half = great_circle(a + 3, b + 3, p, side);
  for (int k = 0; k < 4; k++) values[v + 3 + (size_t)k] = cosl(half * s) * p[k] + sinl(half * s) * side[k];
  if (t->turning != CPROX_TURNING_SCREW) return;
  /* the axis: the vector part of side p* */
  const vec3l u = {side[0], side[1], side[2]}, w = {p[0], p[1], p[2]};
  vec3l axis = ref_sub(ref_sub(ref_scale(p[3], u), ref_scale(side[3], w)), ref_cross(u, w));
  if (half > 0) axis = ref_scale(1 / ref_norm(axis), axis);
  const vec3l from = {a[0], a[1], a[2]}, to = {b[0], b[1], b[2]};
  const vec3l at = ref_add(from, screw_way(ref_sub(to, from), axis, 2 * half, s));
  values[v] = at.x, values[v + 1] = at.y, values[v + 2] = at.z;
}

static size_t segment_at(const test_robot *t, long double time) {
  size_t i = 0;
  while (i + 2 < t->n_points && time >= t->times[i + 1]) i++;
  return i;
}

static bool turns(const test_robot *t, size_t link) {
  return t->turning != CPROX_TURNING_POLYNOMIAL && t->links[link].type == CPROX_JOINT_FLOATING;
}

void robot_ref_values(const test_robot *t, long double time, long double *values) {
  const size_t i = segment_at(t, time);
  for (size_t k = 0; k < t->n_variables; k++) values[k] = t->spline ? de_boor(t, k, time) : hermite(t, i, k, time);
  for (size_t l = 0; l < t->n_links; l++)
    if (turns(t, l)) turn_values(t, i, (size_t)t->links[l].variable, time, values);
}

/* ---- poses ---- */

static ref_pose unit_pose(vec3l p, long double x, long double y, long double z, long double w) {
  const long double n = sqrtl(x * x + y * y + z * z + w * w);
  return (ref_pose){.p = p, .q = {x / n, y / n, z / n, w / n}};
}

static ref_pose compose(const ref_pose *a, const ref_pose *b) {
  const long double *p = a->q, *q = b->q;
  return unit_pose(ref_pose_apply(a, b->p), p[3] * q[0] + p[0] * q[3] + p[1] * q[2] - p[2] * q[1],
                   p[3] * q[1] + p[1] * q[3] + p[2] * q[0] - p[0] * q[2],
                   p[3] * q[2] + p[2] * q[3] + p[0] * q[1] - p[1] * q[0],
                   p[3] * q[3] - p[0] * q[0] - p[1] * q[1] - p[2] * q[2]);
}

static ref_pose given(const cprox_pose *pose) {
  return unit_pose(ref_vec(pose->position), pose->orientation.x, pose->orientation.y, pose->orientation.z,
                   pose->orientation.w);
}

ref_pose ref_pose_under(const cprox_pose *base, const ref_pose *pose) {
  const ref_pose outer = given(base);
  return compose(&outer, pose);
}

static ref_pose about(vec3l axis, long double angle) {
  const vec3l v = ref_scale(sinl(angle / 2) / ref_norm(axis), axis);
  return unit_pose((vec3l){0, 0, 0}, v.x, v.y, v.z, cosl(angle / 2));
}

static ref_pose joint(const cprox_link *l, const long double *q) {
  const vec3l axis = ref_vec(l->axis), nowhere = {0, 0, 0};
  switch (l->type) {
    case CPROX_JOINT_REVOLUTE: return about(axis, l->multiplier * q[0] + l->offset);
    case CPROX_JOINT_PRISMATIC:
      return unit_pose(ref_scale((l->multiplier * q[0] + l->offset) / ref_norm(axis), axis), 0, 0, 0, 1);
    case CPROX_JOINT_PLANAR: {
      ref_pose pose = about((vec3l){0, 0, 1}, q[2]);
      pose.p = (vec3l){q[0], q[1], 0};
      return pose;
    }
    case CPROX_JOINT_FLOATING: return unit_pose((vec3l){q[0], q[1], q[2]}, q[3], q[4], q[5], q[6]);
    case CPROX_JOINT_ROTATION_VECTOR: {
      const vec3l vector = {q[3], q[4], q[5]};
      const long double angle = ref_norm(vector);
      ref_pose pose = unit_pose(nowhere, 0, 0, 0, 1);
      if (angle > 0) pose = about(vector, angle);
      pose.p = (vec3l){q[0], q[1], q[2]};
      return pose;
    }
    case CPROX_JOINT_FIXED: break;
  }
  return unit_pose(nowhere, 0, 0, 0, 1);
}

void robot_ref_links(const test_robot *t, const long double *values, ref_pose *links) {
  for (size_t i = 0; i < t->n_links; i++) {
    const cprox_link *l = &t->links[i];
    const ref_pose origin = given(&l->origin), moved = joint(l, values + l->variable), here = compose(&origin, &moved);
    links[i] = l->parent < 0 ? here : compose(&links[l->parent], &here);
  }
}

ref_pose robot_ref_link(const test_robot *t, size_t link, long double time) {
  const size_t i = segment_at(t, time);
  ref_pose pose = unit_pose((vec3l){0, 0, 0}, 0, 0, 0, 1);
  for (int32_t l = (int32_t)link; l >= 0; l = t->links[l].parent) {
    const size_t first = (size_t)t->links[l].variable, n = width_of(t->links[l].type);
    long double values[TEST_MAX_VARIABLES + 1];
    for (size_t k = first; k < first + n; k++) values[k] = t->spline ? de_boor(t, k, time) : hermite(t, i, k, time);
    if (turns(t, (size_t)l)) turn_values(t, i, first, time, values);
    const ref_pose origin = given(&t->links[l].origin), moved = joint(&t->links[l], values + first);
    pose = compose(&moved, &pose);
    pose = compose(&origin, &pose);
  }
  return pose;
}

void robot_ref_vertices(const test_robot *t, const ref_pose *links, size_t geometry, vec3l *vertices) {
  const ref_pose pose = given(&t->geometries[geometry].pose);
  for (size_t k = 0; k < TEST_VERTICES; k++)
    vertices[k] =
        ref_pose_apply(&links[t->geometries[geometry].link], ref_pose_apply(&pose, ref_vec(t->vertices[geometry][k])));
}

double robot_part_error(const test_robot *t, size_t segment, double u) {
  double values[TEST_MAX_VARIABLES + 1];
  placement frames[4 * TEST_MAX_LINKS + 1];
  motion_place(t->motion, segment, u, values, frames);
  const long double t0 = t->motion->times[segment], t1 = t->motion->times[segment + 1];
  long double exact[TEST_MAX_VARIABLES + 1];
  ref_pose links[TEST_MAX_LINKS];
  robot_ref_values(t, (1 - (long double)u) * t0 + u * t1, exact);
  robot_ref_links(t, exact, links);
  double worst = 0.0;
  for (size_t p = 0; p < t->robot->n_parts; p++) {
    const robot_part *part = &t->robot->parts[p];
    const placement at = placement_under(frames, part->axis, &part->at);
    vec3l vertices[TEST_VERTICES];
    robot_ref_vertices(t, links, p, vertices);
    for (size_t v = 0; v < TEST_VERTICES; v++) {
      const vec3 local = vec_sub(t->vertices[p][v], t->geometries[p].body->centre);
      const long double off = ref_error(vertices[v], placement_apply(&at, local));
      const double part_of_it = off > 0 ? (double)(off / t->motion->part_error[p]) : 0.0;
      if (!(part_of_it <= worst)) worst = part_of_it;
    }
  }
  return worst;
}
