/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/meshes.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <math.h>
#include <stdlib.h>

static test_mesh mesh_allocate(size_t n, size_t m) {
  test_mesh mesh = {.n = n, .m = m};
  mesh.vertices = malloc(n * sizeof *mesh.vertices);
  mesh.triangles = malloc(m * sizeof *mesh.triangles);
  assert_true(mesh.vertices && mesh.triangles);
  return mesh;
}

void mesh_free(test_mesh *mesh) {
  free(mesh->vertices);
  free(mesh->triangles);
}

static void put(test_mesh *mesh, size_t i, size_t a, size_t b, size_t c) {
  mesh->triangles[i][0] = (uint32_t)a;
  mesh->triangles[i][1] = (uint32_t)b;
  mesh->triangles[i][2] = (uint32_t)c;
}

test_mesh mesh_torus(size_t around, size_t across, double radius, double tube, double bumps) {
  test_mesh mesh = mesh_allocate(around * across, 2 * around * across);
  for (size_t i = 0; i < around; i++) {
    for (size_t j = 0; j < across; j++) {
      const double u = 6.283185307179586 * (double)i / (double)around,
                   v = 6.283185307179586 * (double)j / (double)across;
      const double r = tube * (1.0 + bumps * sin(5.0 * u) * cos(3.0 * v)), w = radius + r * cos(v);
      mesh.vertices[i * across + j] = vec(w * cos(u), w * sin(u), r * sin(v));
      const size_t a = i * across + j, b = (i + 1) % around * across + j,
                   c = (i + 1) % around * across + (j + 1) % across, d = i * across + (j + 1) % across;
      put(&mesh, 2 * a, a, b, c);
      put(&mesh, 2 * a + 1, a, c, d);
    }
  }
  return mesh;
}

test_mesh mesh_box(vec3 half) {
  static const int SIDES[12][3] = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                                   {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  test_mesh mesh = mesh_allocate(8, 12);
  for (int i = 0; i < 8; i++)
    mesh.vertices[i] = vec(i & 1 ? half.x : -half.x, i & 2 ? half.y : -half.y, i & 4 ? half.z : -half.z);
  for (size_t i = 0; i < 12; i++) put(&mesh, i, (size_t)SIDES[i][0], (size_t)SIDES[i][1], (size_t)SIDES[i][2]);
  return mesh;
}

test_mesh mesh_plate(size_t n, double half) {
  test_mesh mesh = mesh_allocate((n + 1) * (n + 1), 2 * n * n);
  for (size_t i = 0; i <= n; i++)
    for (size_t j = 0; j <= n; j++)
      mesh.vertices[i * (n + 1) + j] =
          vec(half * (2.0 * (double)i / (double)n - 1.0), half * (2.0 * (double)j / (double)n - 1.0), 0.0);
  for (size_t i = 0; i < n; i++) {
    for (size_t j = 0; j < n; j++) {
      const size_t a = i * (n + 1) + j;
      put(&mesh, 2 * (i * n + j), a, a + n + 1, a + n + 2);
      put(&mesh, 2 * (i * n + j) + 1, a, a + n + 2, a + 1);
    }
  }
  return mesh;
}

test_mesh mesh_soup(rng *r, size_t m, double half, double size) {
  test_mesh mesh = mesh_allocate(3 * m, m);
  for (size_t i = 0; i < m; i++) {
    const vec3 centre = rng_in_cube(r, half);
    const size_t kind = rng_index(r, 8);
    for (size_t k = 0; k < 3; k++) mesh.vertices[3 * i + k] = vec_add(centre, rng_in_cube(r, size));
    if (kind == 0) mesh.vertices[3 * i + 1] = mesh.vertices[3 * i];
    if (kind == 1)
      mesh.vertices[3 * i + 2] = vec_lerp(mesh.vertices[3 * i], mesh.vertices[3 * i + 1], rng_uniform(r, -1.0, 2.0));
    if (kind == 2) /* a needle */
      mesh.vertices[3 * i + 2] = vec_axpy(mesh.vertices[3 * i + 1], rng_log_uniform(r, 1e-15, 1e-3), rng_unit(r));
    put(&mesh, i, 3 * i, 3 * i + 1, 3 * i + 2);
    if (kind == 3 && i > 0) put(&mesh, i, mesh.triangles[i - 1][1], mesh.triangles[i - 1][0], mesh.triangles[i - 1][2]);
    if (kind == 4) put(&mesh, i, 3 * i, 3 * i, 3 * i);
  }
  return mesh;
}

void mesh_move(test_mesh *mesh, const cprox_pose *pose) {
  const frame f = frame_create(pose, vec(0, 0, 0));
  for (size_t i = 0; i < mesh->n; i++) mesh->vertices[i] = frame_to_world(&f, mesh->vertices[i]);
}

cprox_body *mesh_body(const test_mesh *mesh, cprox_mesh_fill fill, cprox_workspace *workspace) {
  cprox_body *body = NULL;
  const cprox_status status = cprox_body_create_mesh(mesh->vertices, mesh->n, (const uint32_t(*)[3])mesh->triangles,
                                                     mesh->m, fill, SIZE_MAX, workspace, &body);
  if (status != CPROX_OK) fail_msg("%s", cprox_workspace_error(workspace));
  return body;
}

/* The distance to a point that the triangle certainly has: needles make normals of noise, never weights above 1. */
static long double triangle_distance(vec3l p, vec3l a, vec3l b, vec3l c) {
  const long double edges =
      fminl(ref_point_segment(p, a, b), fminl(ref_point_segment(p, b, c), ref_point_segment(p, c, a)));
  const vec3l normal = ref_cross(ref_sub(b, a), ref_sub(c, a));
  const long double wc = ref_dot(ref_cross(ref_sub(b, a), ref_sub(p, a)), normal);
  const long double wa = ref_dot(ref_cross(ref_sub(c, b), ref_sub(p, b)), normal);
  const long double wb = ref_dot(ref_cross(ref_sub(a, c), ref_sub(p, c)), normal);
  if (wa < 0.0L || wb < 0.0L || wc < 0.0L || wa + wb + wc == 0.0L) return edges;
  const long double sum = wa + wb + wc;
  const vec3l foot = ref_add(ref_scale(wa / sum, ref_sub(a, p)),
                             ref_add(ref_scale(wb / sum, ref_sub(b, p)), ref_scale(wc / sum, ref_sub(c, p))));
  return fminl(edges, ref_norm(foot));
}

long double mesh_distance(const test_mesh *mesh, vec3l p) {
  long double least = INFINITY;
  for (size_t i = 0; i < mesh->m; i++) {
    const uint32_t *t = mesh->triangles[i];
    const long double d = triangle_distance(p, ref_vec(mesh->vertices[t[0]]), ref_vec(mesh->vertices[t[1]]),
                                            ref_vec(mesh->vertices[t[2]]));
    if (d < least) least = d;
  }
  return least;
}

long double mesh_winding(const test_mesh *mesh, vec3l p) {
  long double sum = 0.0L;
  for (size_t i = 0; i < mesh->m; i++) {
    const uint32_t *t = mesh->triangles[i];
    const vec3l a = ref_sub(ref_vec(mesh->vertices[t[0]]), p), b = ref_sub(ref_vec(mesh->vertices[t[1]]), p),
                c = ref_sub(ref_vec(mesh->vertices[t[2]]), p);
    const long double la = ref_norm(a), lb = ref_norm(b), lc = ref_norm(c);
    sum += 2.0L * atan2l(ref_dot(a, ref_cross(b, c)),
                         la * lb * lc + ref_dot(a, b) * lc + ref_dot(b, c) * la + ref_dot(c, a) * lb);
  }
  return sum / 12.566370614359172953850573533118L;
}
