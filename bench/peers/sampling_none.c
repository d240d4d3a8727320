/* SPDX-License-Identifier: BSD-3-Clause */
#include "sampling.h"

const char *sampling_name(void) {
  return NULL;
}

sampling *sampling_create(void) {
  return NULL;
}

void sampling_free(sampling *s) {
  (void)s;
}

void sampling_add_box(sampling *s, cprox_vec3 edges, cprox_pose pose) {
  (void)s, (void)edges, (void)pose;
}

void sampling_ready(sampling *s) {
  (void)s;
}

double sampling_collides(const sampling *s, const cprox_vec3 *points, size_t n_points, double radius, size_t samples) {
  (void)s, (void)points, (void)n_points, (void)radius, (void)samples;
  return 0.0;
}

double sampling_distance(const sampling *s, const cprox_vec3 *points, size_t n_points, double radius, size_t samples) {
  (void)s, (void)points, (void)n_points, (void)radius, (void)samples;
  return 0.0;
}

const char *sampling_polytope_name(void) {
  return NULL;
}

void *sampling_polytope(const cprox_vec3 *vertices, size_t n, const int (*triangles)[3], size_t m) {
  (void)vertices, (void)n, (void)triangles, (void)m;
  return NULL;
}

double sampling_polytope_distance(const void *polytope, const cprox_vec3 *points, size_t n) {
  (void)polytope, (void)points, (void)n;
  return 0.0;
}

void sampling_polytope_free(void *polytope) {
  (void)polytope;
}
