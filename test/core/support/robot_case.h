/* SPDX-License-Identifier: BSD-3-Clause */
/* Real robots on real trajectories in real scenes, as test/core/support/robot_cases.py wrote them down. */
#ifndef CPROX_TEST_ROBOT_CASE_H
#define CPROX_TEST_ROBOT_CASE_H

#include <stdio.h>

#include "curve_proximity/cprox/robot.h"

enum {
  CASE_MAX_LINKS = 40,
  CASE_MAX_GEOMETRIES = 64,
  CASE_MAX_VARIABLES = 16,
  CASE_MAX_OBJECTS = 32,
  CASE_MAX_POINTS = 24,
  CASE_MAX_PAIRS = 1200
};

typedef struct case_answer {
  bool self;
  double lower, upper, sampled;
} case_answer;

typedef struct robot_case {
  char name[80], robot_name[40];
  char link_names[CASE_MAX_LINKS][40];
  cprox_robot *robot; /* meshes by their hulls */
  cprox_motion *motion;
  cprox_robot *mesh_robot; /* meshes with their hulls, as level-of-detail bodies */
  cprox_motion *mesh_motion;
  const cprox_body *bodies[CASE_MAX_GEOMETRIES];   /* hulls */
  const cprox_body *surfaces[CASE_MAX_GEOMETRIES]; /* NULL where there is no mesh; */
  const cprox_body *lods[CASE_MAX_GEOMETRIES];     /* likewise */
  int32_t links[CASE_MAX_GEOMETRIES];              /* of the geometries, and where they stand there */
  cprox_pose poses[CASE_MAX_GEOMETRIES];
  cprox_link tree[CASE_MAX_LINKS];
  size_t n_links, n_geometries, n_variables;
  cprox_obstacle targets[CASE_MAX_OBJECTS];
  size_t n_targets;
  cprox_robot_pair self_pairs[CASE_MAX_PAIRS];
  size_t n_self_pairs;
  case_answer answers[2];
  size_t n_answers;
} robot_case;

/* Reads the next case of FOLDER/cases.txt, opened by the caller, who has read the number of cases in its first line.
 * False, with a message on stderr, where the file is not as it should be. */
bool robot_case_read(FILE *cases, const char *folder, robot_case *c);
/* FOLDER/ROBOT.robot without a scene, every variable on its way from 0 to 1. */
bool robot_case_read_robot(const char *folder, const char *robot, robot_case *c);
void robot_case_free(robot_case *c);

#endif
