/* SPDX-License-Identifier: BSD-3-Clause */
/* Spectra against each other, against differences and against limits; offsets hold what they must; bad solids are
 * refused. */
#include <stdlib.h>
#include <string.h>

#include "fourier/gap.h"
#include "fourier/grid.h"
#include "support/builders.h"
#include "support/cases.h"
#include "support/counting.h"
#include "support/make_curve.h"
#include "support/random.h"

#define MADE(call) assert_int_equal(call, CPROX_OK)

static const double L_SHAPE[6][2] = {{-0.5, -0.5}, {0.7, -0.5}, {0.7, -0.2}, {-0.1, -0.2}, {-0.1, 0.6}, {-0.5, 0.6}};

/* An L-shaped prism: reflex edge and reflex vertices. */
static cprox_solid *l_prism(void) {
  cprox_vec3 v[12];
  for (int i = 0; i < 6; i++) {
    v[i] = vec(L_SHAPE[i][0], L_SHAPE[i][1], -0.3);
    v[6 + i] = vec(L_SHAPE[i][0], L_SHAPE[i][1], 0.25);
  }
  /* both ends as two rectangles each, split at the reflex corner 3: 0 1 2 3 and 0 3 4 5 */
  uint32_t f[20][3] = {{6, 7, 8}, {6, 8, 9}, {6, 9, 10}, {6, 10, 11}, {0, 2, 1}, {0, 3, 2}, {0, 4, 3}, {0, 5, 4}};
  for (uint32_t i = 0; i < 6; i++) {
    const uint32_t j = (i + 1) % 6;
    const uint32_t a[2][3] = {{i, j, 6 + j}, {i, 6 + j, 6 + i}};
    memcpy(f[8 + 2 * i], a, sizeof a);
  }
  cprox_solid *s;
  MADE(cprox_solid_create(
      &(cprox_solid_description){
          .kind = CPROX_SOLID_MESH, .points = v, .n = 12, .triangles = (const uint32_t(*)[3])f, .n_triangles = 20},
      ws, &s));
  return s;
}

static cprox_solid *grid(int dimension) {
  unsigned char cells[60] = {0};
  for (int i = 0; i < (dimension == 2 ? 20 : 60); i++) cells[i] = (unsigned char)(i * 7 % 5 < 3);
  const uint32_t counts[3] = {5, 4, dimension == 2 ? 1 : 3};
  cprox_solid *s;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_GRID,
                                                     .dimension = dimension,
                                                     .lowest = vec(-0.3, 0.1, 0),
                                                     .cell = 0.2,
                                                     .counts = {counts[0], counts[1], counts[2]},
                                                     .occupied = cells},
                          ws, &s));
  return s;
}

static cprox_solid *sweep(int dimension) {
  const cprox_vec3 p[4] = {{-0.5, 0, 0}, {0.2, 0.9, 0}, {0.4, -0.7, dimension == 2 ? 0 : 0.8}, {0.6, 0.3, 0}};
  cprox_curve *c;
  MADE(curve_from(describe_bezier(p, 4, 0, 1), ws, &c));
  cprox_solid *s;
  MADE(cprox_solid_create(
      &(cprox_solid_description){
          .kind = CPROX_SOLID_SWEEP, .dimension = dimension, .curve = c, .radius = 0.1, .tolerance = 0.01},
      ws, &s));
  cprox_curve_free(c);
  return s;
}

enum { KINDS = 14 };
static cprox_solid *solid_of(int kind) {
  cprox_solid *s = NULL;
  const cprox_vec3 line[3] = {{-0.4, 0.1, 0}, {0.3, 0.2, 0}, {0.5, -0.4, 0}};
  switch (kind) {
    case 0:
      MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 2, .radius = 0.7}, ws,
                              &s));
      break;
    case 1:
      MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 3, .radius = 0.7}, ws,
                              &s));
      break;
    case 2:
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(0.8, 0.5, 0)}, ws, &s));
      break;
    case 3:
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = vec(0.8, 0.5, 1.1)}, ws, &s));
      break;
    case 4:
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_ELLIPSOID, .dimension = 2, .semi_axes = vec(0.8, 0.3, 0)}, ws,
          &s));
      break;
    case 5:
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_ELLIPSOID, .dimension = 3, .semi_axes = vec(0.8, 0.3, 0.5)},
          ws, &s));
      break;
    case 6:
      MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_CYLINDER, .height = 0.9, .radius = 0.4},
                              ws, &s));
      break;
    case 7:
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_CAPSULE, .dimension = 2, .height = 0.9, .radius = 0.3}, ws,
          &s));
      break;
    case 8:
      MADE(cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_CAPSULE, .dimension = 3, .height = 0.9, .radius = 0.3}, ws,
          &s));
      break;
    case 9:
      MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = L_SHAPE, .n = 6}, ws,
                              &s));
      break;
    case 10: s = l_prism(); break;
    case 11:
      MADE(cprox_solid_create(
          &(cprox_solid_description){
              .kind = CPROX_SOLID_POLYLINE, .dimension = 3, .points = line, .n = 3, .radius = 0.2},
          ws, &s));
      break;
    case 12: s = grid(3); break;
    default: s = sweep(3);
  }
  return s;
}

/* The solid turned and shifted, so that pieces have frames of their own. */
static cprox_solid *moved(const cprox_solid *s, rng *r) {
  cprox_pose pose = rng_pose(r, 0.5);
  if (s->dimension == 2) pose.orientation.x = pose.orientation.y = pose.position.z = 0.0;
  cprox_solid *u;
  MADE(cprox_solid_create(
      &(cprox_solid_description){
          .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const[]){s}, .poses = &pose, .n = 1},
      ws, &u));
  return u;
}

static vec3 random_frequency(rng *r, int dimension, double radius) {
  vec3 q = vec_scale(rng_log_uniform(r, 1e-3, 60.0) / radius, rng_unit(r));
  if (dimension == 2) q.z = 0.0;
  return q;
}

/* Seed 701, 2800 cases: central differences of order 4 with step 0.01/radius err by (0.01)^4/30 of the fifth
 * derivative, radius^5 times the measure at most: 3e-10, and by rounding 1e-13/0.01; tolerance 2e-9 of measure times
 * radius. */
CASE(gradients_of_spectra_agree_with_differences) {
  rng r = rng_seed(701);
  for (size_t i = 0; i < test_cases(2800); i++) {
    cprox_solid *s = solid_of((int)(i % KINDS)), *u = moved(s, &r);
    const double radius = u->radius + vec_norm(u->centre), h = 0.01 / radius, measure = cprox_solid_get_info(u).measure;
    const vec3 q = random_frequency(&r, u->dimension, radius);
    double f[2];
    vec3 g[2];
    MADE(cprox_solid_spectrum(u, q, ws, f, g));
    for (int j = 0; j < u->dimension; j++) {
      const vec3 e = vec(j == 0, j == 1, j == 2);
      double sum[2] = {0, 0};
      const double step[4] = {-2, -1, 1, 2}, weight[4] = {1, -8, 8, -1};
      for (int k = 0; k < 4; k++) {
        MADE(cprox_solid_spectrum(u, vec_axpy(q, step[k] * h, e), ws, f, NULL));
        sum[0] += weight[k] * f[0] / (12 * h), sum[1] += weight[k] * f[1] / (12 * h);
      }
      const double error = hypot(sum[0] - vec_dot(g[0], e), sum[1] - vec_dot(g[1], e));
      if (!(error <= 2e-9 * measure * radius))
        fail_msg("kind %zu, |q| r = %g: off by %g", i % KINDS, vec_norm(q) * radius, error);
    }
    cprox_solid_free(u);
    cprox_solid_free(s);
  }
}

static double difference(const cprox_solid *a, const cprox_solid *b, vec3 q) {
  double f[2], g[2];
  MADE(cprox_solid_spectrum(a, q, ws, f, NULL));
  MADE(cprox_solid_spectrum(b, q, ws, g, NULL));
  return hypot(f[0] - g[0], f[1] - g[1]);
}

/* A box clipped by half-spaces that do not touch it becomes a polygon or a mesh of the same body. Seed 702, 2000
 * frequencies: 1e-14 of the measure, tiny |q| included. */
CASE(a_box_as_a_mesh_or_a_polygon_has_the_spectrum_of_a_box) {
  rng r = rng_seed(702);
  const double outside[1][4] = {{1, 0, 0, 9}};
  for (int dimension = 2; dimension <= 3; dimension++) {
    cprox_solid *box, *mesh;
    MADE(cprox_solid_create(
        &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = dimension, .size = vec(0.9, 0.6, 0.7)}, ws,
        &box));
    MADE(cprox_solid_create(
        &(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = box, .region = outside, .n = 1}, ws, &mesh));
    assert_true(mesh->pieces[0].kind == (dimension == 2 ? PIECE_POLYGON : PIECE_SOUP));
    for (size_t i = 0; i < test_cases(1000); i++) {
      vec3 q = random_frequency(&r, dimension, box->radius * (i % 2 ? 1.0 : 1e6));
      const double error = difference(box, mesh, q) / cprox_solid_get_info(box).measure;
      if (!(error <= 1e-14)) fail_msg("dimension %d, q (%g, %g, %g): %g", dimension, q.x, q.y, q.z, error);
    }
    cprox_solid_free(box);
    cprox_solid_free(mesh);
  }
}

/* Half by half: the parts on both sides of a cut add up to the whole. Seed 703: 1e-13 of the measure. */
CASE(parts_on_both_sides_of_a_cut_add_up) {
  rng r = rng_seed(703);
  for (size_t i = 0; i < test_cases(400); i++) {
    cprox_solid *s = solid_of(i % 2 ? 9 : 10), *a, *b;
    vec3 n = rng_unit(&r);
    if (s->dimension == 2) n.z = 0;
    const double d = vec_dot(n, s->centre) + rng_uniform(&r, -0.2, 0.2);
    const double below[1][4] = {{n.x, n.y, n.z, d}}, above[1][4] = {{-n.x, -n.y, -n.z, -d}};
    if (cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = s, .region = below, .n = 1},
                           ws, &a) == CPROX_OK) {
      if (cprox_solid_create(
              &(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = s, .region = above, .n = 1}, ws, &b) ==
          CPROX_OK) {
        const vec3 q = random_frequency(&r, s->dimension, s->radius);
        double f[2], g[2], h[2];
        MADE(cprox_solid_spectrum(s, q, ws, f, NULL));
        MADE(cprox_solid_spectrum(a, q, ws, g, NULL));
        MADE(cprox_solid_spectrum(b, q, ws, h, NULL));
        assert_true(hypot(f[0] - g[0] - h[0], f[1] - g[1] - h[1]) <= 1e-13 * cprox_solid_get_info(s).measure);
        cprox_solid_free(b);
      }
      cprox_solid_free(a);
    }
    cprox_solid_free(s);
  }
}

/* A capsule of no length is a ball (closed form against quadrature); in the plane, its outline with 20000 corners has
 * its spectrum to the outline's own error, area (2 pi/20000)²/6. Seed 704. */
CASE(capsules_agree_with_balls_and_outlines) {
  rng r = rng_seed(704);
  cprox_solid *capsule, *ball, *outline;
  for (int dimension = 2; dimension <= 3; dimension++) {
    MADE(cprox_solid_create(
        &(cprox_solid_description){.kind = CPROX_SOLID_CAPSULE, .dimension = dimension, .height = 1e-13, .radius = 0.5},
        ws, &capsule));
    MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = dimension, .radius = 0.5},
                            ws, &ball));
    for (int i = 0; i < 500; i++) assert_true(difference(capsule, ball, random_frequency(&r, dimension, 0.5)) <= 2e-13);
    cprox_solid_free(capsule);
    cprox_solid_free(ball);
  }
  enum { N = 20000 };
  MADE(cprox_solid_create(
      &(cprox_solid_description){.kind = CPROX_SOLID_CAPSULE, .dimension = 2, .height = 0.8, .radius = 0.3}, ws,
      &capsule));
  piece p = piece_create(PIECE_POLYGON);
  p.corner = malloc(N * sizeof *p.corner);
  p.n_corners = N;
  for (int i = 0; i < N; i++) {
    const double a = 6.283185307179586 * (i + 0.5) / N;
    p.corner[i] = vec(0.3 * cos(a) + copysign(0.4, cos(a)), 0.3 * sin(a), 0);
  }
  MADE(solid_of_piece(2, &p, ws, &outline));
  for (int i = 0; i < 50; i++) assert_true(difference(capsule, outline, random_frequency(&r, 2, 0.7)) <= 3e-8);
  cprox_solid_free(capsule);
  cprox_solid_free(outline);
}

/* The winding number of a loop or a closed soup around a point, from angles or solid angles. */
static double winding(const piece *p, vec3 x) {
  double sum = 0.0;
  if (p->kind == PIECE_POLYGON) {
    for (size_t i = 0; i < p->n_corners; i++) {
      const vec3 a = vec_sub(p->corner[i], x), b = vec_sub(p->corner[(i + 1) % p->n_corners], x);
      sum += atan2(a.x * b.y - a.y * b.x, a.x * b.x + a.y * b.y);
    }
    return sum / 6.283185307179586;
  }
  for (size_t i = 0; i < p->n_corners; i += 3) {
    const vec3 a = vec_sub(p->corner[i], x), b = vec_sub(p->corner[i + 1], x), c = vec_sub(p->corner[i + 2], x);
    const double u = vec_norm(a), v = vec_norm(b), w = vec_norm(c);
    sum +=
        2 * atan2(vec_dot(a, vec_cross(b, c)), u * v * w + vec_dot(a, b) * w + vec_dot(b, c) * u + vec_dot(c, a) * v);
  }
  return sum / 12.566370614359172;
}

/* A point of the surface or the inside, moved by less than rho. */
static vec3 point_near(const cprox_solid *s, double rho, rng *r) {
  const piece *p = s->pieces;
  vec3 x;
  if (p->kind == PIECE_POLYGON) {
    const size_t i = rng_index(r, p->n_corners);
    x = vec_lerp(p->corner[i], p->corner[(i + 1) % p->n_corners], rng_index(r, 3) ? rng_uniform(r, 0, 1) : 0.0);
  } else {
    const vec3 *c = p->corner + 3 * rng_index(r, p->n_corners / 3);
    const double u = rng_index(r, 3) ? rng_uniform(r, 0, 1) : 0.0, v = rng_index(r, 3) ? rng_uniform(r, 0, 1) : 0.0;
    x = vec_lerp(c[0], vec_lerp(c[1], c[2], v), u);
  }
  vec3 d = rng_unit(r);
  if (s->dimension == 2) d = vec_scale(1.0 / hypot(d.x, d.y), vec(d.x, d.y, 0));
  return vec_axpy(x, rho * rng_uniform(r, 0, 0.999999), d);
}

/* Seed 705, 20000 points within rho of a non-convex polygon or mesh, near its faces, edges and corners alike: the
 * offset's function is at least 1 there (angles add up to 1e-6). It is 0 beyond its reach, and 1 at most where the mesh
 * is convex. */
CASE(offsets_hold_every_point_within_rho) {
  rng r = rng_seed(705);
  for (int kind = 9; kind <= 10; kind++) {
    cprox_solid *s = solid_of(kind);
    for (int k = 0; k < 10; k++) {
      const double rho = rng_log_uniform(&r, 0.01, 0.5);
      double reach = 0.0;
      cprox_solid *o = solid_offset(s, rho, &reach);
      assert_non_null(o);
      assert_true(reach >= rho && reach <= 1.3 * rho);
      for (size_t i = 0; i < test_cases(1000); i++) {
        const vec3 x = point_near(s, rho, &r);
        const double w = winding(o->pieces, vec_sub(x, s->centre));
        if (!(w >= 1.0 - 1e-6)) fail_msg("kind %d, rho %g: %g at (%g, %g, %g)", kind, rho, w, x.x, x.y, x.z);
      }
      const vec3 out = vec_scale(s->radius + reach * 1.01, vec(0.6, 0.8, 0));
      assert_true(fabs(winding(o->pieces, out)) < 1e-6);
      cprox_solid_free(o);
    }
    cprox_solid_free(s);
  }
}

/* Minkowski sums of convex bodies with balls have the volumes of Steiner's formula; circumscribed pieces a little more.
 */
CASE(the_offset_of_a_convex_mesh_has_the_volume_of_steiners_formula) {
  const double outside[1][4] = {{1, 0, 0, 9}}, rho = 0.2;
  cprox_solid *box, *mesh;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = vec(1, 2, 3)}, ws,
                          &box));
  MADE(cprox_solid_create(
      &(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = box, .region = outside, .n = 1}, ws, &mesh));
  double reach = 0.0;
  cprox_solid *o = solid_offset(mesh, rho, &reach);
  const double steiner = 6 + 22 * rho + 3.14159265358979 * 6 * rho * rho + 4.18879020478639 * rho * rho * rho;
  const double volume = cprox_solid_get_info(o).measure;
  assert_true(volume >= steiner && volume <= steiner * 1.01);
  assert_false(o->pieces[0].folded);
  solid_bounds bounds;
  assert_true(solid_find_bounds(o, &bounds));
  assert_true(bounds.peak == 1.0);
  cprox_solid_free(o);
  cprox_solid_free(mesh);
  cprox_solid_free(box);
}

/* Overlapping squares: the energy and the peak of the sum are those of the overlay, counted by hand. */
CASE(energies_of_loops_are_exact) {
  const double square[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  cprox_solid *s, *u;
  MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = square, .n = 4}, ws, &s));
  cprox_pose poses[2] = {CPROX_POSE_IDENTITY, CPROX_POSE_IDENTITY};
  poses[1].position = vec(0.75, 0.5, 0);
  MADE(cprox_solid_create(
      &(cprox_solid_description){
          .kind = CPROX_SOLID_UNION, .parts = (const cprox_solid *const[]){s, s}, .poses = poses, .n = 2},
      ws, &u));
  solid_bounds b;
  assert_true(solid_find_bounds(u, &b));
  assert_true(fabs(b.energy - (2 + 2 * 0.125)) < 1e-11); /* 2 on 1/8, 1 on 2 (1 - 1/8) */
  assert_true(b.peak == 2.0);
  cprox_solid_free(u);
  cprox_solid_free(s);
}

/* Seed 706: random grids in plane and space, rho up to four cells. A cell is taken where it is within rho of an
 * occupied one, by looking at each; cells that border are 0 apart. */
CASE(the_offset_of_a_grid_is_the_cells_within_rho) {
  rng r = rng_seed(706);
  for (size_t trial = 0; trial < test_cases(60); trial++) {
    const int dimension = 2 + (int)(trial % 2);
    const uint32_t n[3] = {1 + (uint32_t)rng_index(&r, 6), 1 + (uint32_t)rng_index(&r, 6),
                           dimension == 2 ? 1 : 1 + (uint32_t)rng_index(&r, 6)};
    const double cell = rng_log_uniform(&r, 0.01, 10.0), rho = rng_uniform(&r, 0.0, 4.0) * cell;
    unsigned char cells[216];
    for (uint32_t i = 0; i < n[0] * n[1] * n[2]; i++) cells[i] = rng_index(&r, 8) == 0;
    cells[rng_index(&r, n[0] * n[1] * n[2])] = 1;
    cprox_solid *s;
    MADE(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_GRID,
                                                       .dimension = dimension,
                                                       .lowest = vec(0, 0, 0),
                                                       .cell = cell,
                                                       .counts = {n[0], n[1], n[2]},
                                                       .occupied = cells},
                            ws, &s));
    double reach;
    cprox_solid *o = solid_offset(s, rho, &reach);
    assert_non_null(o);
    const piece *p = &o->pieces[0];
    const int m = (int)(p->counts[0] - n[0]) / 2, mz = (int)(p->counts[2] - n[2]) / 2;
    for (uint32_t at = 0; at < p->counts[0] * p->counts[1] * p->counts[2]; at++) {
      const int x = (int)(at % p->counts[0]) - m, y = (int)(at / p->counts[0] % p->counts[1]) - m,
                z = (int)(at / p->counts[0] / p->counts[1]) - mz;
      double least = INFINITY;
      for (uint32_t i = 0; i < n[0] * n[1] * n[2]; i++) {
        const double dx = fmax(0, abs(x - (int)(i % n[0])) - 1), dy = fmax(0, abs(y - (int)(i / n[0] % n[1])) - 1),
                     dz = fmax(0, abs(z - (int)(i / n[0] / n[1])) - 1);
        if (cells[i]) least = fmin(least, dx * dx + dy * dy + dz * dz);
      }
      assert_int_equal(p->cells[at] != 0, cell * sqrt(least) <= rho);
    }
    cprox_solid_free(o);
    cprox_solid_free(s);
  }
}

/* The transform axis by axis, at all lattice points, against the sum over runs of cells: 1e-13 of the measure. */
CASE(grids_transform_axis_by_axis_to_the_same_spectrum) {
  for (int dimension = 2; dimension <= 3; dimension++) {
    cprox_solid *s = grid(dimension);
    grid_table table;
    const int N = 5, top = dimension == 2 ? 0 : N;
    const double step = 1.7;
    assert_true(grid_is_aligned(&s->pieces[0]) && grid_transform(&s->pieces[0], dimension, N, step, ws, &table));
    for (int z = -top; z <= top; z++)
      for (int y = -N; y <= N; y++)
        for (int x = -N; x <= N; x++) {
          double f[2];
          MADE(cprox_solid_spectrum(s, vec(step * x, step * y, step * z), ws, f, NULL));
          const wave w = grid_at(&table, x, y, z, dimension);
          assert_true(hypot(f[0] - w.re, f[1] - w.im) <= 1e-13 * cprox_solid_get_info(s).measure);
        }
    free(table.value);
    cprox_solid_free(s);
  }
}

#define REFUSED(call, words)                                                \
  do {                                                                      \
    cprox_solid *solid = (cprox_solid *)&ws;                                \
    const size_t live = allocations_live();                                 \
    assert_int_equal(call, CPROX_INVALID);                                  \
    assert_string_equal(cprox_workspace_error(ws), words);                  \
    assert_true(solid == (cprox_solid *)&ws && allocations_live() == live); \
  } while (0)

CASE(bad_solids_are_refused_in_words) {
  REFUSED(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 4, .radius = 1.0}, ws,
                             &solid),
          "dimension is 4, must be 2 or 3");
  REFUSED(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 3, .radius = NAN}, ws,
                             &solid),
          "radius is nan, must be > 0");
  REFUSED(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 3, .size = vec(1, 2, -1)},
                             ws, &solid),
          "size.z is -1, must be > 0");
  REFUSED(
      cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_BOX, .dimension = 2, .size = vec(1, INFINITY, 0)}, ws, &solid),
      "size.y is inf, must be finite");

  const double clockwise[3][2] = {{0, 0}, {0, 1}, {1, 0}}, bow[4][2] = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
  const double twice[3][2] = {{0, 0}, {0, 0}, {1, 1}}, spike[4][2] = {{0, 0}, {2, 0}, {1, 0}, {1, 1}};
  REFUSED(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = clockwise, .n = 3}, ws,
                             &solid),
          "the polygon is clockwise (area -0.5): give its vertices counter-clockwise");
  REFUSED(
      cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = bow, .n = 4}, ws, &solid),
      "the polygon meets itself: edges 0 and 2 touch or cross");
  REFUSED(
      cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = twice, .n = 3}, ws, &solid),
      "vertices 0 and 1 of the polygon are the same point");
  REFUSED(
      cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = spike, .n = 4}, ws, &solid),
      "the polygon meets itself: edges 0 and 1 touch or cross");

  const cprox_vec3 v[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const uint32_t inside_out[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  const uint32_t crossed[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 3, 2}},
                 beyond[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 4}};
  const uint32_t open[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {0, 3, 2}};
  REFUSED(cprox_solid_create(
              &(cprox_solid_description){
                  .kind = CPROX_SOLID_MESH, .points = v, .n = 4, .triangles = beyond, .n_triangles = 4},
              ws, &solid),
          "triangle 3 names vertex 4 of 4");
  REFUSED(cprox_solid_create(
              &(cprox_solid_description){
                  .kind = CPROX_SOLID_MESH, .points = v, .n = 4, .triangles = inside_out, .n_triangles = 4},
              ws, &solid),
          "the mesh holds the volume -0.166667: triangles must be counter-clockwise from outside");
  /* without an interior: all corners in one plane or on one line, a curve that stands still */
  const cprox_vec3 pressed[4] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};
  const uint32_t round_it[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  REFUSED(cprox_solid_create(
              &(cprox_solid_description){
                  .kind = CPROX_SOLID_MESH, .points = pressed, .n = 4, .triangles = round_it, .n_triangles = 4},
              ws, &solid),
          "the mesh holds the volume 0: triangles must be counter-clockwise from outside");
  const double line[3][2] = {{0, 0}, {1, 1}, {3, 3}};
  REFUSED(
      cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_POLYGON, .corners = line, .n = 3}, ws, &solid),
      "the polygon meets itself: edges 0 and 2 touch or cross");
  const cprox_vec3 one_point[3] = {{1, 2, 3}, {1, 2, 3}, {1, 2, 3}};
  cprox_curve *still;
  MADE(curve_from(describe_bezier(one_point, 3, 0, 1), ws, &still));
  REFUSED(cprox_solid_create(
              &(cprox_solid_description){
                  .kind = CPROX_SOLID_SWEEP, .dimension = 3, .curve = still, .radius = 0.1, .tolerance = 1e-3},
              ws, &solid),
          "the curve stands still: use a ball");
  cprox_curve_free(still);

  cprox_solid *none = NULL;
  assert_int_equal(cprox_solid_create(
                       &(cprox_solid_description){
                           .kind = CPROX_SOLID_MESH, .points = v, .n = 4, .triangles = crossed, .n_triangles = 4},
                       ws, &none),
                   CPROX_INVALID);
  assert_int_equal(cprox_solid_create(
                       &(cprox_solid_description){
                           .kind = CPROX_SOLID_MESH, .points = v, .n = 4, .triangles = open, .n_triangles = 4},
                       ws, &none),
                   CPROX_INVALID);
  const uint32_t lid_off[5][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}, {1, 2, 3}};
  assert_int_equal(cprox_solid_create(
                       &(cprox_solid_description){
                           .kind = CPROX_SOLID_MESH, .points = v, .n = 4, .triangles = lid_off, .n_triangles = 5},
                       ws, &none),
                   CPROX_INVALID);
  const cprox_vec3 tent[5] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, -1}};
  const uint32_t no_floor[4][3] = {{0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}};
  cprox_solid_create(
      &(cprox_solid_description){
          .kind = CPROX_SOLID_MESH, .points = tent, .n = 5, .triangles = no_floor, .n_triangles = 4},
      ws, &none);
  assert_non_null(strstr(cprox_workspace_error(ws), "mesh is open: nothing borders the edge"));

  const unsigned char empty[8] = {0};
  REFUSED(cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_GRID,
                                                        .dimension = 3,
                                                        .lowest = vec(0, 0, 0),
                                                        .cell = 0.1,
                                                        .counts = {2, 2, 2},
                                                        .occupied = empty},
                             ws, &solid),
          "no cell of the grid is occupied");
  cprox_solid *ball;
  MADE(
      cprox_solid_create(&(cprox_solid_description){.kind = CPROX_SOLID_BALL, .dimension = 3, .radius = 1}, ws, &ball));
  const double region[1][4] = {{1, 0, 0, 0}};
  REFUSED(
      cprox_solid_create(
          &(cprox_solid_description){.kind = CPROX_SOLID_CLIPPED, .solid = ball, .region = region, .n = 1}, ws, &solid),
      "piece 0 cannot be clipped: only boxes, polygons and meshes can; give one that holds it");
  cprox_solid_free(ball);
}

/* Each allocation in turn fails: the status says so, nothing leaks. */
CASE(solids_survive_every_failed_allocation) {
  for (int kind = 0; kind < KINDS; kind++) {
    cprox_solid *s = solid_of(kind);
    for (size_t n = 0;; n++) {
      const size_t live = allocations_live();
      double reach = 0.0;
      allocations_fail_after(n);
      cprox_solid *o = solid_offset(s, 0.1, &reach);
      allocations_allow();
      if (!o) assert_int_equal(allocations_live(), live);
      cprox_solid_free(o);
      if (o) break;
      assert_true(n < 100000);
    }
    cprox_solid_free(s);
  }
}

int main(void) {
  return cases_run(workspace_setup, workspace_teardown);
}
