/* SPDX-License-Identifier: BSD-3-Clause */
#include <stddef.h>

#include "peers/edge_validator.h"

const char *edge_validator_name(void) {
  return NULL;
}

edge_validator *edge_validator_create(const char *robot) {
  (void)robot;
  return NULL;
}

void edge_validator_free(edge_validator *v) {
  (void)v;
}

void edge_validator_add_box(edge_validator *v, cprox_pose pose, cprox_vec3 half) {
  (void)v, (void)pose, (void)half;
}

void edge_validator_add_capsule(edge_validator *v, cprox_pose pose, double radius, double half_height) {
  (void)v, (void)pose, (void)radius, (void)half_height;
}

void edge_validator_add_sphere(edge_validator *v, cprox_pose pose, double radius) {
  (void)v, (void)pose, (void)radius;
}

void edge_validator_ready(edge_validator *v) {
  (void)v;
}

bool edge_validator_hits(const edge_validator *v, const double *from, const double *to, int per_radian) {
  (void)v, (void)from, (void)to, (void)per_radian;
  return false;
}
