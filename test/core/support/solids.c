/* SPDX-License-Identifier: BSD-3-Clause */
#include "support/solids.h"
#include "support/make_curve.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "support/builders.h"

#define MADE(call) \
  if ((call) != CPROX_OK) fail_msg("%s", cprox_workspace_error(ws))

bool solid_exists(test_solid_kind kind, int dimension) {
  return dimension == 3 || kind != SOLID_CYLINDER;
}

const char *solid_name(test_solid_kind kind) {
  static const char *const names[SOLID_KINDS] = {"ball",   "box",      "ellipsoid", "capsule", "cylinder", "convex",
                                                 "folded", "polyline", "sweep",     "grid",    "union",    "clipped"};
  return names[kind];
}

/* ---- Parts ---- */

static void add_part(test_solid *s, cprox_body *body) {
  assert_true(s->n < SOLID_MOST_PARTS);
  s->parts[s->n++] = body;
}

static void add_polytope(test_solid *s, const vec3 *v, size_t n) {
  cprox_body *body;
  MADE(cprox_body_create_polytope(v, n, ws, &body));
  add_part(s, body);
}

/* The prism over a planar convex polygon, |z| <= half. */
static void add_prism(test_solid *s, const double (*v)[2], size_t n, double half) {
  vec3 corners[32];
  for (size_t i = 0; i < n; i++) {
    corners[2 * i] = vec(v[i][0], v[i][1], -half);
    corners[2 * i + 1] = vec(v[i][0], v[i][1], half);
  }
  add_polytope(s, corners, 2 * n);
}

static void add_box_at(test_solid *s, vec3 low, vec3 high) {
  const vec3 v[8] = {{low.x, low.y, low.z},   {high.x, low.y, low.z},  {low.x, high.y, low.z},
                     {high.x, high.y, low.z}, {low.x, low.y, high.z},  {high.x, low.y, high.z},
                     {low.x, high.y, high.z}, {high.x, high.y, high.z}};
  add_polytope(s, v, 8);
}

/* Points within the radius of a segment. */
static void add_segment(test_solid *s, cprox_pose *poses, vec3 a, vec3 b, double radius) {
  const vec3 d = vec_sub(b, a), z = vec(0, 0, 1);
  const double length = vec_norm(d);
  const vec3 axis = vec_cross(z, d);
  cprox_body *body;
  MADE(cprox_body_create_capsule(length, radius, ws, &body));
  poses[s->n] = CPROX_POSE_IDENTITY;
  poses[s->n].position = vec_scale(0.5, vec_add(a, b));
  /* the half-way quaternion from z to d */
  const double w = length + d.z;
  poses[s->n].orientation = w > 1e-12 * length ? (cprox_quat){w, axis.x, axis.y, axis.z} : (cprox_quat){0, 1, 0, 0};
  add_part(s, body);
}

/* ---- Kinds ---- */

static double length_of(rng *r, double scale, double aspect) {
  return rng_log_uniform(r, scale / aspect, scale);
}

static vec3 lengths_of(rng *r, double scale, double aspect) {
  const double x = length_of(r, scale, aspect), y = length_of(r, scale, aspect), z = length_of(r, scale, aspect);
  return vec(x, y, z);
}

static void make_simple(test_solid *s, vec3 size, cprox_pose *pose) {
  const int d = s->dimension;
  cprox_body *body = NULL;
  switch (s->kind) {
    case SOLID_BALL:
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = d, .radius = 0.5 * size.x}, ws, &s->solid));
      MADE(cprox_body_create_sphere(0.5 * size.x, ws, &body));
      break;
    case SOLID_BOX:
      MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = d, .size = size}, ws,
                              &s->solid));
      MADE(cprox_body_create_box(size, ws, &body));
      break;
    case SOLID_ELLIPSOID:
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_ELLIPSOID, .dimension = d, .semi_axes = vec_scale(0.5, size)},
          ws, &s->solid));
      MADE(cprox_body_create_ellipsoid(vec_scale(0.5, size), ws, &body));
      break;
    case SOLID_CYLINDER:
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_CYLINDER, .height = size.x, .radius = 0.5 * size.y}, ws,
          &s->solid));
      MADE(cprox_body_create_cylinder(size.x, 0.5 * size.y, ws, &body));
      break;
    default:
      MADE(cprox_solid_create(
          &(cprox_solid_description){
              .kind = CPROX_SOLID_CAPSULE, .dimension = d, .height = size.x, .radius = 0.3 * size.y},
          ws, &s->solid));
      MADE(cprox_body_create_capsule(size.x, 0.3 * size.y, ws, &body));
      if (d == 2) pose->orientation = (cprox_quat){1, 0, 1, 0}; /* along x */
      break;
  }
  add_part(s, body);
}

/* A regular polygon of 3 … 8 corners or a box, turned and sheared. */
static void make_convex(rng *r, test_solid *s, vec3 size) {
  const double shear = rng_uniform(r, -0.5, 0.5);
  if (s->dimension == 2) {
    double v[8][2];
    const size_t n = 3 + rng_index(r, 6);
    for (size_t i = 0; i < n; i++) {
      const double at = 6.283185307179586 * (double)i / (double)n;
      v[i][1] = 0.5 * size.y * sin(at);
      v[i][0] = 0.5 * size.x * cos(at) + shear * v[i][1];
    }
    MADE(cprox_solid_create(
        &(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = (const double(*)[2])v, .n = n}, ws,
        &s->solid));
    add_prism(s, (const double(*)[2])v, n, 1.0);
    return;
  }
  vec3 v[8];
  const double other = rng_uniform(r, -0.5, 0.5);
  for (int i = 0; i < 8; i++) {
    v[i] = vec(0.5 * (i & 1 ? size.x : -size.x), 0.5 * (i & 2 ? size.y : -size.y), 0.5 * (i & 4 ? size.z : -size.z));
    v[i].x += shear * v[i].y, v[i].y += other * v[i].z;
  }
  const uint32_t faces[12][3] = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                                 {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  MADE(cprox_solid_create(
      &(cprox_solid_description){.kind = CPROX_SOLID_MESH, .points = v, .n = 8, .triangles = faces, .n_triangles = 12},
      ws, &s->solid));
  add_polytope(s, v, 8);
}

/* An L, in space as a prism: two boxes. */
static void make_folded(rng *r, test_solid *s, vec3 size) {
  const double x = rng_uniform(r, 0.3, 0.7) * size.x, y = rng_uniform(r, 0.3, 0.7) * size.y,
               half = s->dimension == 2 ? 1.0 : 0.5 * size.z;
  const double v[6][2] = {{0, 0}, {size.x, 0}, {size.x, y}, {x, y}, {x, size.y}, {0, size.y}};
  if (s->dimension == 2) {
    MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = v, .n = 6}, ws,
                            &s->solid));
  } else {
    vec3 corners[12];
    for (int i = 0; i < 12; i++) corners[i] = vec(v[i % 6][0], v[i % 6][1], i < 6 ? -half : half);
    const uint32_t cap[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}};
    uint32_t faces[20][3];
    for (uint32_t i = 0; i < 4; i++)
      for (uint32_t j = 0; j < 3; j++) faces[i][j] = cap[i][2 - j], faces[4 + i][j] = 6 + cap[i][j];
    for (uint32_t i = 0; i < 6; i++) {
      const uint32_t a = i, b = (i + 1) % 6, side[2][3] = {{a, b, b + 6}, {a, b + 6, a + 6}};
      for (uint32_t j = 0; j < 6; j++) faces[8 + 2 * i + j / 3][j % 3] = side[j / 3][j % 3];
    }
    MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_MESH,
                                                       .points = corners,
                                                       .n = 12,
                                                       .triangles = (const uint32_t(*)[3])faces,
                                                       .n_triangles = 20},
                            ws, &s->solid));
  }
  add_box_at(s, vec(0, 0, -half), vec(size.x, y, half));
  add_box_at(s, vec(0, 0, -half), vec(x, size.y, half));
}

/* A polyline of three legs, or a sphere swept along them. */
static void make_path(rng *r, test_solid *s, vec3 size, cprox_pose *poses) {
  vec3 p[4] = {{-0.5, -0.5, -0.5}, {-0.2, 0.4, 0.1}, {0.3, -0.3, 0.5}, {0.5, 0.5, -0.2}};
  const double radius = 0.15 * size.y;
  for (int i = 0; i < 4; i++) {
    p[i] = vec_axpy(vec(size.x * p[i].x, size.y * p[i].y, size.z * p[i].z), 0.1 * size.x, rng_in_cube(r, 1.0));
    if (s->dimension == 2) p[i].z = 0.0;
  }
  for (int i = 0; i < 3; i++) add_segment(s, poses, p[i], p[i + 1], radius);
  if (s->kind == SOLID_POLYLINE) {
    MADE(cprox_solid_create(
        &(cprox_solid_description){
            .kind = CPROX_SOLID_POLYLINE, .dimension = s->dimension, .points = p, .n = 4, .radius = radius},
        ws, &s->solid));
    return;
  }
  cprox_curve *curve;
  const double knots[6] = {0, 0, 1, 2, 3, 3};
  MADE(curve_from(describe_bspline(p, 4, 1, knots, 6, 0, 3), ws, &curve));
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_SWEEP,
                                                     .dimension = s->dimension,
                                                     .curve = curve,
                                                     .radius = radius,
                                                     .tolerance = 1e-6 * radius},
                          ws, &s->solid));
  cprox_curve_free(curve);
}

/* An L of three or four blocks of cells. */
static void make_grid(rng *r, test_solid *s, double size) {
  enum { ACROSS = 4 };
  const bool planar = s->dimension == 2, blocks[8] = {1, 1, 1, 0, 0, 1, 0, rng_index(r, 2) == 1};
  const uint32_t counts[3] = {2 * ACROSS, 2 * ACROSS, planar ? 1 : 2 * ACROSS};
  const vec3 lowest = vec(-0.3 * size, 0.1 * size, planar ? 0.0 : 0.2 * size);
  unsigned char cells[8 * ACROSS * ACROSS * ACROSS];
  for (uint32_t i = 0; i < counts[0] * counts[1] * counts[2]; i++) {
    const uint32_t x = i % counts[0], y = i / counts[0] % counts[1], z = i / counts[0] / counts[1];
    cells[i] = blocks[x / ACROSS + 2 * (y / ACROSS) + 4 * (z / ACROSS)];
  }
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_GRID,
                                                     .dimension = s->dimension,
                                                     .lowest = lowest,
                                                     .cell = 0.5 * size / ACROSS,
                                                     .counts = {counts[0], counts[1], counts[2]},
                                                     .occupied = cells},
                          ws, &s->solid));
  for (int i = 0; i < (planar ? 4 : 8); i++) {
    if (!blocks[i]) continue;
    const vec3 low = vec_axpy(lowest, 0.5 * size, vec(i & 1, i >> 1 & 1, planar ? -1 : i >> 2));
    add_box_at(s, low, vec_axpy(low, 0.5 * size, vec(1, 1, planar ? 2 : 1)));
  }
}

/* Two boxes at poses, which overlap or not. */
static void make_union(rng *r, test_solid *s, double scale, double aspect, cprox_pose *poses) {
  cprox_solid *parts[2];
  for (int i = 0; i < 2; i++) {
    const vec3 size = lengths_of(r, scale, aspect);
    cprox_body *body;
    MADE(cprox_solid_create(
        &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = s->dimension, .size = size}, ws, &parts[i]));
    MADE(cprox_body_create_box(size, ws, &body));
    poses[i] = solid_pose(r, s->dimension, 0.5 * scale);
    add_part(s, body);
  }
  MADE(cprox_solid_create(
      &(cprox_solid_description){
          .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const *)parts, .poses = poses, .n = 2},
      ws, &s->solid));
  for (int i = 0; i < 2; i++) cprox_solid_free(parts[i]);
}

/* A box, and of it what has x <= cut. */
static void make_clipped(rng *r, test_solid *s, vec3 size) {
  cprox_solid *box;
  const double cut = rng_uniform(r, -0.3, 0.3) * size.x, plane[1][4] = {{2, 0, 0, 2 * cut}};
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = s->dimension, .size = size},
                          ws, &box));
  MADE(cprox_solid_create(
      &(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = box, .region = plane, .n = 1}, ws, &s->solid));
  cprox_solid_free(box);
  add_box_at(s, vec_scale(-0.5, size), vec(cut, 0.5 * size.y, 0.5 * size.z));
  MADE(cprox_body_create_box(size, ws, &s->unclipped));
  MADE(cprox_body_create_halfspace(vec(1, 0, 0), -cut, ws, &s->region));
}

/* ---- What tests call ---- */

test_solid solid_make(rng *r, test_solid_kind kind, int dimension, double scale, double aspect) {
  test_solid s = {.kind = kind, .dimension = dimension};
  cprox_pose poses[SOLID_MOST_PARTS];
  for (int i = 0; i < SOLID_MOST_PARTS; i++) poses[i] = CPROX_POSE_IDENTITY;
  const vec3 size = lengths_of(r, scale, aspect);
  switch (kind) {
    case SOLID_CONVEX: make_convex(r, &s, size); break;
    case SOLID_FOLDED: make_folded(r, &s, size); break;
    case SOLID_POLYLINE:
    case SOLID_SWEEP: make_path(r, &s, size, poses); break;
    case SOLID_GRID: make_grid(r, &s, size.x); break;
    case SOLID_UNION: make_union(r, &s, scale, aspect, poses); break;
    case SOLID_CLIPPED: make_clipped(r, &s, size); break;
    default: make_simple(&s, size, poses); break;
  }
  MADE(cprox_body_create_compound((const cprox_body *const *)s.parts, poses, s.n, ws, &s.body));
  return s;
}

void solid_free(test_solid *s) {
  cprox_solid_free(s->solid);
  cprox_body_free(s->body);
  cprox_body_free(s->unclipped);
  cprox_body_free(s->region);
  for (size_t i = 0; i < s->n; i++) cprox_body_free(s->parts[i]);
  *s = (test_solid){0};
}

cprox_pose solid_pose(rng *r, int dimension, double half) {
  cprox_pose p = rng_pose(r, half);
  if (dimension == 2) p.orientation.x = p.orientation.y = p.position.z = 0.0;
  return p;
}

static double distance(const cprox_body *a, const cprox_pose *pa, const cprox_body *b, const cprox_pose *pb) {
  const cprox_options o = accurate(1e-9);
  cprox_result result;
  if (cprox_pair(cprox_obstacle_at(a, *pa), cprox_obstacle_at(b, *pb), &o, ws, &result) < CPROX_OK)
    fail_msg("%s", cprox_workspace_error(ws));
  return result.upper;
}

double solid_distance(const test_solid *a, const cprox_pose *pa, const test_solid *b, const cprox_pose *pb) {
  return distance(a->body, pa, b->body, pb);
}

double solid_reached(const test_solid *a, const cprox_pose *pa, const test_solid *b, const cprox_pose *pb) {
  double most = solid_distance(a, pa, b, pb);
  const cprox_body *const of_a[2] = {a->unclipped, a->region}, *const of_b[2] = {b->unclipped, b->region};
  for (int i = 0; i < 2; i++) {
    if (of_a[i]) most = fmax(most, distance(of_a[i], pa, b->body, pb));
    if (of_b[i]) most = fmax(most, distance(a->body, pa, of_b[i], pb));
  }
  return most;
}
