/* SPDX-License-Identifier: BSD-3-Clause */
/* Random robots on random motions, and where their links are in long double: by quaternions, Hermite's basis functions
 * and de Boor's recursion, none of which the core uses. */
#ifndef CPROX_TEST_ROBOTS_H
#define CPROX_TEST_ROBOTS_H

#include "curve_proximity/cprox/robot.h"
#include "support/random.h"
#include "support/reference.h"

enum {
  TEST_MAX_LINKS = 8,
  TEST_MAX_VARIABLES = 24,
  TEST_WAYPOINTS = 5,
  TEST_MAX_WAYPOINTS = 48,
  TEST_VERTICES = 5,
  TEST_SPLINE_DEGREE = 4
};

typedef struct test_robot {
  cprox_link links[TEST_MAX_LINKS];
  cprox_link_geometry geometries[TEST_MAX_LINKS]; /* one a link */
  vec3 vertices[TEST_MAX_LINKS][TEST_VERTICES];   /* a geometry's, in its own frame */
  double margin;                                  /* margin of all */
  size_t n_links, n_variables;
  int32_t variables[TEST_MAX_VARIABLES];
  double rest[TEST_MAX_VARIABLES];

  /* the motion */
  bool spline;
  cprox_interpolation interpolation;
  cprox_turning turning;
  size_t n_points;
  double times[TEST_MAX_WAYPOINTS + TEST_SPLINE_DEGREE + 1]; /* or knots */
  double positions[TEST_MAX_WAYPOINTS][TEST_MAX_VARIABLES], velocities[TEST_MAX_WAYPOINTS][TEST_MAX_VARIABLES],
      accelerations[TEST_MAX_WAYPOINTS][TEST_MAX_VARIABLES];
  cprox_robot *robot;
  cprox_motion *motion;
} test_robot;

/* `speed`: how far variables go from point to point [rad, m]; at most TEST_WAYPOINTS points. Fails the running test
 * where the core refuses it. */
void robot_make(rng *r, double speed, test_robot *t);
void robot_free(test_robot *t);

/* The same of robots with floating joints and rotation vectors alone, whose floating joints turn by `turning` (where
 * the motion is no spline). n_points <= TEST_MAX_WAYPOINTS. */
void robot_make_turning(rng *r, double speed, cprox_turning turning, size_t n_points, test_robot *t);

/* The same robot on the same motion, with the geometries as they are now. */
void robot_rebuild(test_robot *t);

/* Another motion of n_points <= TEST_MAX_WAYPOINTS of the same kind; robot_rebuild() makes it. */
void robot_draw_motion(rng *r, double speed, size_t n_points, test_robot *t);

/* All variables at a time. */
void robot_ref_values(const test_robot *t, long double time, long double *values);

typedef struct ref_pose {
  vec3l p;
  long double q[4]; /* x, y, z, w, unit */
} ref_pose;

static inline vec3l ref_turn(const long double *q, vec3l x) {
  const vec3l v = {q[0], q[1], q[2]};
  const vec3l twice = ref_scale(2.0L, ref_cross(v, x));
  return ref_add(ref_add(x, ref_scale(q[3], twice)), ref_cross(v, twice));
}

static inline vec3l ref_pose_apply(const ref_pose *placed, vec3l x) {
  return ref_add(ref_turn(placed->q, x), placed->p);
}

static inline vec3l ref_pose_undo(const ref_pose *placed, vec3l x) {
  const long double back[4] = {-placed->q[0], -placed->q[1], -placed->q[2], placed->q[3]};
  return ref_turn(back, ref_sub(x, placed->p));
}

/* Where a pose is in the world, given in the frame of another one. */
ref_pose ref_pose_under(const cprox_pose *base, const ref_pose *pose);

/* The frames of all links. */
void robot_ref_links(const test_robot *t, const long double *values, ref_pose *links);

/* The frame of one link at a time, by its chain of joints alone. */
ref_pose robot_ref_link(const test_robot *t, size_t link, long double time);

/* The vertices of a geometry in the world. */
void robot_ref_vertices(const test_robot *t, const ref_pose *links, size_t geometry, vec3l *vertices);

/* How far the core has the vertices of the parts from where they are, at u of a segment of the motion: the largest, as
 * a fraction of the error that the motion states. */
double robot_part_error(const test_robot *t, size_t segment, double u);

#endif
