/* SPDX-License-Identifier: BSD-3-Clause */
/* The offset of a closed mesh: its inside, a prism over each face, a wedge over each convex edge, a cap over each
 * vertex whose normal cone is not empty. Each point outside within rho of the mesh has its nearest point in one of
 * them. On a convex mesh they are disjoint; at reflex edges prisms overlap and count twice. Only surfaces that do not
 * cancel are written. */
#include <string.h>

#include "fourier/points.h"
#include "fourier/solid.h"

/* Arcs over edges go in tangents at most a quarter turn apart / 2: they reach at most 1.0824 rho. */
#define EDGE_STEP 0.78539816339744830962

/* An undirected edge as one of its triangles sees it. */
typedef struct half_edge {
  uint32_t low, high; /* vertices, low < high */
  uint32_t triangle;
  bool forward; /* the triangle runs from low to high */
} half_edge;

static int by_edge(const void *a, const void *b) {
  const half_edge *p = a, *q = b;
  if (p->low != q->low) return p->low < q->low ? -1 : 1;
  if (p->high != q->high) return p->high < q->high ? -1 : 1;
  return (int)q->forward - (int)p->forward;
}

static vec3 unit_normal(const piece *mesh, uint32_t triangle) {
  const uint32_t *t = mesh->triangle[triangle];
  const vec3 a = mesh->vertex[t[0]];
  const vec3 n = vec_cross(vec_sub(mesh->vertex[t[1]], a), vec_sub(mesh->vertex[t[2]], a));
  return vec_scale(1.0 / vec_norm(n), n);
}

static void add_quad(points *soup, vec3 a, vec3 b, vec3 c, vec3 d) {
  points_add_triangle(soup, a, b, c);
  points_add_triangle(soup, a, c, d);
}

/* The side of the prism over a face beside its edge from a to b. */
static void add_wall(points *soup, vec3 a, vec3 b, vec3 normal, double rho) {
  add_quad(soup, a, b, vec_axpy(b, rho, normal), vec_axpy(a, rho, normal));
}

/* Over a convex edge from a to b between the face m to its left and n to its right: tangents of the arc from m to n,
 * and the two ends. */
static void add_wedge(points *soup, vec3 a, vec3 b, vec3 m, vec3 n, double rho) {
  const double angle = atan2(vec_norm(vec_cross(m, n)), vec_dot(m, n));
  const int steps = (int)ceil(angle / EDGE_STEP - 1e-9);
  const double half = 0.5 * angle / steps, radius = rho / cos(half);
  const vec3 across = vec_axpy(n, -vec_dot(m, n), m);
  const vec3 up = vec_scale(1.0 / vec_norm(across), across); /* m and up span the arc's plane */
  vec3 last = vec_scale(rho, m);
  for (int j = 0; j <= steps; j++) {
    const double at = (2 * j + 1) * half;
    const vec3 next =
        j < steps ? vec_add(vec_scale(radius * cos(at), m), vec_scale(radius * sin(at), up)) : vec_scale(rho, n);
    add_quad(soup, vec_add(b, last), vec_add(a, last), vec_add(a, next), vec_add(b, next));
    points_add_triangle(soup, a, vec_add(a, next), vec_add(a, last));
    points_add_triangle(soup, b, vec_add(b, last), vec_add(b, next));
    last = next;
  }
}

/* Returns whether the edge is reflex: then the prisms beside it overlap. */
static bool add_edge(const piece *mesh, const half_edge *left, const half_edge *right, double rho, points *soup) {
  const vec3 a = mesh->vertex[left->low], b = mesh->vertex[left->high];
  const vec3 m = unit_normal(mesh, left->triangle), n = unit_normal(mesh, right->triangle);
  const double bend = vec_dot(vec_cross(m, n), vec_sub(b, a)) / vec_norm(vec_sub(b, a));
  const bool folded = vec_dot(m, n) < 0.0;
  if (fabs(bend) < 1e-14 && !folded) return false; /* flat: the walls of the two prisms cancel */
  if (bend > 0.0) {
    add_wedge(soup, a, b, m, n, rho);
    return false;
  }
  add_wall(soup, a, b, m, rho);
  add_wall(soup, b, a, n, rho);
  return true;
}

/* The 42-vertex polytope: an icosahedron with its faces in four, turned out of every likely plane, circumscribed to the
 * unit ball. 80 faces of 3 corners. Returns how far its corners are. */
enum { CAP_FACES = 80 };
static double cap_polytope(vec3 faces[CAP_FACES][3]) {
  const double g = 1.61803398874989484820;
  const vec3 v[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                      {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  static const int f[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                               {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                               {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  const frame tilt = frame_create(&(cprox_pose){.orientation = {1.0, 0.2137, 0.3571, 0.1193}}, vec(0, 0, 0));
  vec3 unit[12];
  for (int i = 0; i < 12; i++) unit[i] = vec_scale(1.0 / vec_norm(v[i]), rotate(tilt.r, v[i]));

  double least = 1.0;
  for (int i = 0; i < 20; i++) {
    vec3 c[3], m[3];
    for (int j = 0; j < 3; j++) c[j] = unit[f[i][j]];
    for (int j = 0; j < 3; j++) {
      const vec3 sum = vec_add(c[j], c[(j + 1) % 3]);
      m[j] = vec_scale(1.0 / vec_norm(sum), sum);
    }
    const vec3 small[4][3] = {{c[0], m[0], m[2]}, {m[0], c[1], m[1]}, {m[2], m[1], c[2]}, {m[0], m[1], m[2]}};
    memcpy(faces[4 * i], small, sizeof small);
    for (int k = 0; k < 4; k++) {
      const vec3 n = vec_cross(vec_sub(small[k][1], small[k][0]), vec_sub(small[k][2], small[k][0]));
      least = fmin(least, vec_dot(n, small[k][0]) / vec_norm(n));
    }
  }
  for (int i = 0; i < CAP_FACES; i++)
    for (int j = 0; j < 3; j++) faces[i][j] = vec_scale(1.0 / least, faces[i][j]);
  return 1.0 / least;
}

/* The part of one face of the polytope in the normal cone of a vertex, {u: u·e <= 0 for all edges e}, as a pyramid over
 * the vertex. Sides along the cone's own planes are written; those between faces of the polytope cancel. */
static void add_cap_face(points *soup, vec3 v, const vec3 face[3], double rho, const vec3 *edges, size_t n,
                         points *part) {
  part->n = 0;
  for (int j = 0; j < 3; j++) points_add(part, vec_scale(rho, face[j]));
  for (size_t k = 0; k < n && part->n > 0; k++)
    clip_loop(part, (const double[4]){edges[k].x, edges[k].y, edges[k].z, 0.0});
  for (size_t i = 1; i + 1 < part->n; i++)
    points_add_triangle(soup, vec_add(v, part->at[0]), vec_add(v, part->at[i]), vec_add(v, part->at[i + 1]));
  for (size_t i = 0; part->n > 2 && i < part->n; i++) {
    const vec3 a = part->at[i], b = part->at[(i + 1) % part->n];
    for (size_t k = 0; k < n; k++)
      if (fabs(vec_dot(a, edges[k])) <= 1e-12 * rho && fabs(vec_dot(b, edges[k])) <= 1e-12 * rho) {
        points_add_triangle(soup, v, vec_add(v, b), vec_add(v, a));
        break;
      }
  }
}

/* A vertex with edges all around in a half-space alone has a normal cone with an inside; the clipping finds out. */
static void add_cap(points *soup, vec3 v, double rho, const vec3 *edges, size_t n, vec3 faces[CAP_FACES][3],
                    points *part) {
  for (int i = 0; i < CAP_FACES; i++) {
    bool possible = true; /* some corner of the face within each half-space */
    for (size_t k = 0; k < n && possible; k++)
      possible = fmin(vec_dot(faces[i][0], edges[k]),
                      fmin(vec_dot(faces[i][1], edges[k]), vec_dot(faces[i][2], edges[k]))) < 0.0;
    if (possible) add_cap_face(soup, v, faces[i], rho, edges, n, part);
  }
}

/* Unit vectors along the edges that leave each vertex, listed by vertex: start[v] … start[v + 1]. */
static void list_edges(const piece *mesh, const half_edge *halves, size_t n_halves, size_t *start, vec3 *edges) {
  for (size_t i = 0; i < n_halves; i += 2) start[halves[i].low + 1]++, start[halves[i].high + 1]++;
  for (size_t v = 0; v < mesh->n_vertices; v++) start[v + 1] += start[v];
  for (size_t i = n_halves; i > 0; i -= 2) {
    const uint32_t a = halves[i - 2].low, b = halves[i - 2].high;
    const vec3 d = vec_sub(mesh->vertex[b], mesh->vertex[a]), e = vec_scale(1.0 / vec_norm(d), d);
    edges[--start[a + 1]] = e;
    edges[--start[b + 1]] = vec_neg(e);
  }
  /* each start[v + 1] has come down to where v begins */
  for (size_t v = 0; v < mesh->n_vertices; v++) start[v] = start[v + 1];
  start[mesh->n_vertices] = n_halves;
}

bool offset_mesh(const piece *mesh, double rho, points *soup, double *reach) {
  bool reflex = false;
  const size_t n_halves = 3 * mesh->n_triangles;
  half_edge *halves = malloc(n_halves * sizeof *halves);
  size_t *start = calloc(mesh->n_vertices + 2, sizeof *start);
  vec3 *edges = malloc(n_halves * sizeof *edges);
  if (!halves || !start || !edges) soup->failed = true;

  for (size_t i = 0; !soup->failed && i < n_halves; i++) {
    const uint32_t *t = mesh->triangle[i / 3], a = t[i % 3], b = t[(i + 1) % 3];
    halves[i] = (half_edge){a < b ? a : b, a < b ? b : a, (uint32_t)(i / 3), a < b};
  }
  if (!soup->failed) {
    qsort(halves, n_halves, sizeof *halves, by_edge);
    for (uint32_t i = 0; i < mesh->n_triangles; i++) {
      const vec3 up = vec_scale(rho, unit_normal(mesh, i));
      const uint32_t *t = mesh->triangle[i];
      points_add_triangle(soup, vec_add(mesh->vertex[t[0]], up), vec_add(mesh->vertex[t[1]], up),
                          vec_add(mesh->vertex[t[2]], up));
    }
    for (size_t i = 0; i < n_halves; i += 2)
      if (add_edge(mesh, &halves[i], &halves[i + 1], rho, soup)) reflex = true;

    vec3 faces[CAP_FACES][3];
    points part = {0};
    const double far = cap_polytope(faces);
    list_edges(mesh, halves, n_halves, start, edges);
    for (size_t v = 0; v < mesh->n_vertices; v++)
      add_cap(soup, mesh->vertex[v], rho, edges + start[v], start[v + 1] - start[v], faces, &part);
    soup->failed = soup->failed || part.failed;
    free(part.at);
    *reach = fmax(*reach, rho * fmax(far, 1.0 / cos(0.5 * EDGE_STEP)));
  }
  free(halves);
  free(start);
  free(edges);
  return reflex;
}
