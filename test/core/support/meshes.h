/* SPDX-License-Identifier: BSD-3-Clause */
/* Meshes for tests: closed ones, soups, and the distance to them by looking at every triangle in long double. */
#ifndef CPROX_TEST_MESHES_H
#define CPROX_TEST_MESHES_H

#include "curve_proximity/cprox/body.h"
#include "support/random.h"
#include "support/reference.h"

typedef struct test_mesh {
  size_t n, m;
  vec3 *vertices;
  uint32_t (*triangles)[3];
} test_mesh;

/* A closed torus with bumps, normals outward: 2 * around * across triangles. */
test_mesh mesh_torus(size_t around, size_t across, double radius, double tube, double bumps);

/* A closed box, 12 triangles, outward. */
test_mesh mesh_box(vec3 half);

/* A flat plate of 2 * n * n triangles over [-half, half]² in the plane z = 0. */
test_mesh mesh_plate(size_t n, double half);

/* m triangles anywhere in a cube, some degenerate, some repeated, vertices shared at random. */
test_mesh mesh_soup(rng *r, size_t m, double half, double size);

void mesh_free(test_mesh *mesh);

/* All vertices turned and moved. */
void mesh_move(test_mesh *mesh, const cprox_pose *pose);

/* The body; the test fails where it cannot be made. */
cprox_body *mesh_body(const test_mesh *mesh, cprox_mesh_fill fill, cprox_workspace *workspace);

/* To the surface, by every triangle. */
long double mesh_distance(const test_mesh *mesh, vec3l p);

/* The winding number, by every triangle's solid angle. */
long double mesh_winding(const test_mesh *mesh, vec3l p);

#endif
