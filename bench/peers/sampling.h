/* SPDX-License-Identifier: BSD-3-Clause */
/* What users do without bounds: a ball at evenly spaced parameters of a Bézier curve, by FCL under its dynamic tree. */
#ifndef CPROX_BENCH_SAMPLING_H
#define CPROX_BENCH_SAMPLING_H

#include <stddef.h>

#include "curve_proximity/cprox/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/* The method's name, or NULL where FCL is not installed: then nothing else below does anything. */
const char *sampling_name(void);

typedef struct sampling sampling;
sampling *sampling_create(void);
void sampling_free(sampling *s);
void sampling_add_box(sampling *s, cprox_vec3 edges, cprox_pose pose);
void sampling_ready(sampling *s);

/* 1 where the ball touches anything at one of the parameters, else 0; the least distance at them, 0 where it touches.
 */
double sampling_collides(const sampling *s, const cprox_vec3 *points, size_t n_points, double radius, size_t samples);
double sampling_distance(const sampling *s, const cprox_vec3 *points, size_t n_points, double radius, size_t samples);

/* The same of one convex polytope: its name or NULL; the least distance of some points to it. */
const char *sampling_polytope_name(void);
void *sampling_polytope(const cprox_vec3 *vertices, size_t n, const int (*triangles)[3], size_t m);
double sampling_polytope_distance(const void *polytope, const cprox_vec3 *points, size_t n);
void sampling_polytope_free(void *polytope);

#ifdef __cplusplus
}
#endif
#endif
