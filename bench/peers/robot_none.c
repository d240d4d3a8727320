/* SPDX-License-Identifier: BSD-3-Clause */
/* In the place of FCL where it is not installed. */
#include "peers/robot_fcl.h"

const char *robot_fcl_name(void) {
  return NULL;
}

robot_fcl *robot_fcl_create(void) {
  return NULL;
}

void robot_fcl_free(robot_fcl *r) {
  (void)r;
}

void robot_fcl_add_mesh(robot_fcl *r, const double *corners, size_t m) {
  (void)r, (void)corners, (void)m;
}

void robot_fcl_add_box(robot_fcl *r, cprox_vec3 edges) {
  (void)r, (void)edges;
}

void robot_fcl_add_cylinder(robot_fcl *r, double radius, double height) {
  (void)r, (void)radius, (void)height;
}

void robot_fcl_add_capsule(robot_fcl *r, double radius, double height) {
  (void)r, (void)radius, (void)height;
}

void robot_fcl_add_sphere(robot_fcl *r, double radius) {
  (void)r, (void)radius;
}

void robot_fcl_stand(robot_fcl *r, cprox_pose pose) {
  (void)r, (void)pose;
}

void robot_fcl_add_pair(robot_fcl *r, size_t a, size_t b) {
  (void)r, (void)a, (void)b;
}

void robot_fcl_ready(robot_fcl *r) {
  (void)r;
}

void robot_fcl_place(robot_fcl *r, size_t part, cprox_vec3 position, const double rotation[9]) {
  (void)r, (void)part, (void)position, (void)rotation;
}

bool robot_fcl_collides(robot_fcl *r) {
  (void)r;
  return false;
}

double robot_fcl_distance(robot_fcl *r, bool of_pairs) {
  (void)r, (void)of_pairs;
  return 0.0;
}
