/* SPDX-License-Identifier: BSD-3-Clause */
/* Nearest points of vertex sets: against all faces where there are few, against a proof by duality where there are
 * many. */
#include "base/rounding.h"
#include "shape/body.h"
#include "support/cases.h"
#include "support/random.h"
#include "support/reference.h"

enum { MOST = 512 };

static cprox_body *make(const vec3 *v, size_t n) {
  cprox_body *body = NULL;
  assert_int_equal(cprox_body_create_polytope(v, n, NULL, &body), CPROX_OK);
  return body;
}

/* n vertices that span `dimension` dimensions, with aspect ratios up to `aspect`; some repeated, some collinear. */
static void random_vertices(rng *r, size_t n, int dimension, double aspect, vec3 *v) {
  const double scale = rng_log_uniform(r, 1e-6, 1e6);
  const double a = scale, b = dimension > 1 ? scale * rng_log_uniform(r, 1.0 / aspect, 1.0) : 0.0;
  const double c = dimension > 2 ? scale * rng_log_uniform(r, 1.0 / aspect, 1.0) : 0.0;
  const bool exact = rng_index(r, 2) == 0; /* along the axes: flat to the last bit */
  const vec3 e = exact ? vec(1, 0, 0) : rng_unit(r);
  vec3 f = exact ? vec(0, 1, 0) : vec_cross(e, rng_unit(r)), g;
  f = vec_scale(1.0 / vec_norm(f), f);
  g = vec_cross(e, f);
  for (size_t i = 0; i < n; i++) {
    const vec3 p = dimension == 0 ? vec(0, 0, 0) : rng_unit(r);
    v[i] = vec_axpy(vec_axpy(vec_scale(a * p.x, e), b * p.y, f), c * p.z, g);
    if (i > 0 && rng_index(r, 8) == 0) v[i] = v[rng_index(r, i)];
    if (i > 1 && rng_index(r, 8) == 0) v[i] = vec_lerp(v[0], v[1], rng_uniform(r, 0.0, 1.0));
  }
}

/* Near a vertex, an edge, a face or anywhere, from 1e-15 sizes to 1e3 sizes away. */
static vec3 random_point(rng *r, const convex *shape) {
  vec3 p = vec(0, 0, 0);
  double sum = 0.0;
  for (int i = 0; i < 3; i++) {
    const double w = rng_index(r, 3) ? rng_uniform(r, 0.0, 1.0) : 1e-9;
    const int32_t k = (int32_t)rng_index(r, (size_t)shape->n);
    p = vec_axpy(p, w, vec(shape->x[k], shape->y[k], shape->z[k]));
    sum += w;
  }
  p = vec_scale(1.0 / sum, p);
  if (rng_index(r, 4) == 0) return p;
  return vec_axpy(p, shape->scale * rng_log_uniform(r, 1e-15, 1e3), rng_unit(r));
}

/* ---- the hull in quadruple precision: of the products of doubles nothing is lost, so slivers are no trouble ---- */

#ifdef __SIZEOF_FLOAT128__
__extension__ typedef __float128 quad;
#else
typedef long double quad;
#endif

typedef struct vec3q {
  quad x, y, z;
} vec3q;

static vec3q q_from(vec3 a) {
  return (vec3q){a.x, a.y, a.z};
}
static vec3q q_sub(vec3q a, vec3q b) {
  return (vec3q){a.x - b.x, a.y - b.y, a.z - b.z};
}
static quad q_dot(vec3q a, vec3q b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
static vec3q q_cross(vec3q a, vec3q b) {
  return (vec3q){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
static quad q_least(quad a, quad b) {
  return a < b ? a : b;
}

/* Squared distances. */
static quad q_segment(vec3q p, vec3q a, vec3q b) {
  const vec3q e = q_sub(b, a), w = q_sub(p, a);
  const quad along = q_dot(w, e), square = q_dot(e, e);
  if (along <= 0 || square == 0) return q_dot(w, w);
  if (along >= square) return q_dot(q_sub(p, b), q_sub(p, b));
  const vec3q across = q_cross(w, e);
  return q_dot(across, across) / square;
}

static quad q_triangle(vec3q p, vec3q a, vec3q b, vec3q c) {
  const quad edges = q_least(q_segment(p, a, b), q_least(q_segment(p, b, c), q_segment(p, c, a)));
  const vec3q normal = q_cross(q_sub(b, a), q_sub(c, a));
  const quad area2 = q_dot(normal, normal);
  if (area2 == 0) return edges;
  const quad ab = q_dot(q_cross(q_sub(b, a), q_sub(p, a)), normal),
             bc = q_dot(q_cross(q_sub(c, b), q_sub(p, b)), normal);
  const quad ca = q_dot(q_cross(q_sub(a, c), q_sub(p, c)), normal), height = q_dot(q_sub(p, a), normal);
  if (ab < 0 || bc < 0 || ca < 0) return edges;
  return q_least(edges, height * height / area2);
}

static quad q_volume(vec3q a, vec3q b, vec3q c, vec3q d) {
  return q_dot(q_sub(a, d), q_cross(q_sub(b, d), q_sub(c, d)));
}

static bool q_inside(vec3q p, vec3q a, vec3q b, vec3q c, vec3q d) {
  const quad whole = q_volume(a, b, c, d);
  return whole != 0 && q_volume(p, b, c, d) / whole >= 0 && q_volume(a, p, c, d) / whole >= 0 &&
         q_volume(a, b, p, d) / whole >= 0 && q_volume(a, b, c, p) / whole >= 0;
}

/* The hull is the union of its vertices' tetrahedra, its surface lies in the union of their triangles. */
static long double hull_distance(vec3 point, const vec3 *vertex, size_t n) {
  const vec3q p = q_from(point);
  vec3q v[7];
  for (size_t i = 0; i < n; i++) v[i] = q_from(vertex[i]);
  quad least = q_segment(p, v[0], v[0]);
  for (size_t i = 0; i < n; i++)
    for (size_t j = i + 1; j < n; j++) {
      least = q_least(least, q_segment(p, v[i], v[j]));
      for (size_t k = j + 1; k < n; k++) {
        least = q_least(least, q_triangle(p, v[i], v[j], v[k]));
        for (size_t l = k + 1; l < n; l++)
          if (q_inside(p, v[i], v[j], v[k], v[l])) return 0.0L;
      }
    }
  return sqrtl((long double)least);
}

static void fail_at(const char *what, const convex *shape, vec3 y, double got, long double wanted, double allowed) {
  print_message("%d vertices:", (int)shape->n);
  for (int i = 0; i < shape->n && i < 12; i++) print_message(" {%a, %a, %a},", shape->x[i], shape->y[i], shape->z[i]);
  fail_msg("%s at {%a, %a, %a}: %.17g, wanted %.20Lg, allowed to be off by %g", what, y.x, y.y, y.z, got, wanted,
           allowed);
}

/* The gap of the certificate: the distance less the bound that the normal proves. */
static double check_certificate(const convex *shape, vec3 y, const convex_near *near) {
  const double h = shape->ops->support(shape, near->normal, NULL, NULL);
  return near->distance - (vec_dot(near->normal, y) - h);
}

/* Seed 201, 1e5 points against hulls of 1 to 7 vertices in 0 to 3 dimensions, aspects up to 1e6, repeated and collinear
 * vertices among them. near_rounding u (|y| + scale) as convex.h states it; the hull by all segments, triangles and
 * tetrahedra in quadruple precision. */
CASE(the_distance_of_a_small_polytope_is_that_of_its_nearest_face) {
  rng r = rng_seed(201);
  long double worst = 0;
  size_t inside = 0;
  for (size_t i = 0; i < test_cases(25000); i++) {
    vec3 v[7], local[7];
    const size_t n = 1 + rng_index(&r, 7);
    random_vertices(&r, n, (int)rng_index(&r, 4), rng_index(&r, 2) ? 1e6 : 10.0, v);
    cprox_body *body = make(v, n);
    const convex *shape = &body->shape;
    for (size_t k = 0; k < n; k++) local[k] = vec(shape->x[k], shape->y[k], shape->z[k]);
    convex_hint hint = {0};
    for (int j = 0; j < 4; j++) {
      const vec3 y = random_point(&r, shape);
      convex_near near;
      shape->ops->nearest(shape, y, &hint, &near);
      const long double exact = hull_distance(y, local, n);
      const double reach = vec_norm(y) + shape->scale, allowed = shape->ops->near_rounding * ROUND_U * reach;
      const long double error = fabsl(fmaxl(near.distance, 0) - exact);
      if (!(error <= allowed)) fail_at("distance", shape, y, near.distance, exact, allowed);
      worst = fmaxl(worst, error / (long double)(ROUND_U * reach));
      const long double off = hull_distance(near.point, local, n);
      if (!(off <= allowed)) fail_at("the point's distance from the hull", shape, y, (double)off, 0, allowed);
      inside += near.distance < 0.0;
    }
    cprox_body_free(body);
  }
  print_message("worst error %.2Lf u (|y| + scale), %zu inside\n", worst, inside);
  assert_true(inside > 100);
}

/* Seed 202, 2e5 points against hulls of 4 to 500 vertices, aspects up to 1e3: primal and dual meet within 64 u (|y| +
 * scale), near_rounding and as much again for the bound's own rounding and for normals of thin faces. */
CASE(the_normal_proves_the_distance_of_a_large_polytope) {
  rng r = rng_seed(202);
  double worst = 0.0;
  static vec3 v[MOST];
  for (size_t i = 0; i < test_cases(5000); i++) {
    const size_t n = 4 + rng_index(&r, rng_index(&r, 4) ? 60 : 497);
    random_vertices(&r, n, 3, rng_index(&r, 2) ? 1e3 : 10.0, v);
    cprox_body *body = make(v, n);
    const convex *shape = &body->shape;
    convex_hint hint = {0};
    for (int j = 0; j < 40; j++) {
      const vec3 y = random_point(&r, shape);
      convex_near near;
      shape->ops->nearest(shape, y, &hint, &near);
      const double reach = vec_norm(y) + shape->scale, gap = check_certificate(shape, y, &near);
      if (near.distance <= shape->ops->near_rounding * ROUND_U * reach)
        continue; /* inside, or not to be told from it */
      if (!(gap <= 64.0 * ROUND_U * reach && gap >= -64.0 * ROUND_U * reach))
        fail_at("gap", shape, y, gap, 0, 64.0 * ROUND_U * reach);
      worst = fmax(worst, gap / (ROUND_U * reach));
    }
    cprox_body_free(body);
  }
  print_message("widest gap %.2f u (|y| + scale)\n", worst);
}

/* Seed 203, 2e4 points inside hulls of 8 to 60 vertices: a ball of the claimed depth reaches no supporting plane. */
CASE(a_depth_that_is_claimed_inside_is_there) {
  rng r = rng_seed(203);
  static vec3 v[MOST];
  size_t claimed = 0;
  for (size_t i = 0; i < test_cases(1000); i++) {
    const size_t n = 8 + rng_index(&r, 52);
    random_vertices(&r, n, 3, 100.0, v);
    cprox_body *body = make(v, n);
    const convex *shape = &body->shape;
    for (int j = 0; j < 20; j++) {
      const vec3 y = vec_scale(rng_uniform(&r, 0.0, 1.0), random_point(&r, shape));
      convex_near near;
      shape->ops->nearest(shape, y, NULL, &near);
      if (near.distance >= 0.0) continue;
      claimed++;
      assert_true(vec_equal(near.point, y) && vec_norm(near.normal) == 0.0);
      for (int k = 0; k < 50; k++) {
        const vec3 u = rng_unit(&r);
        const double room = shape->ops->support(shape, u, NULL, NULL) - vec_dot(u, y);
        assert_true(room >= -near.distance * (1.0 - 1e-12));
      }
    }
    cprox_body_free(body);
  }
  assert_true(claimed > 1000);
}

/* 0 on an edge or diagonal of the first simplex by chance: the search starts again from all round. */
CASE(the_middle_of_a_box_is_inside_it) {
  vec3 v[8];
  for (int i = 0; i < 8; i++) v[i] = vec(i & 1 ? 1 : -1, i & 2 ? 2 : -2, i & 4 ? 3 : -3);
  cprox_body *body = make(v, 8);
  const vec3 spots[] = {{0, 0, 0}, {0.5, 1, 1.5}, {0.5, 1, -1.5}, {0, 0, 1.5}};
  for (int i = 0; i < 4; i++) assert_true(cprox_body_nearest(body, spots[i], NULL) < 0.0);
  cprox_body_free(body);
}

/* Seed 207, 1e4 points in boxes, every third beside a face by 1e-15 to 1e-3: the least of six heights. The accuracy is
 * that of body.h. */
CASE(a_point_inside_a_box_is_as_deep_as_its_nearest_face) {
  rng r = rng_seed(207);
  for (size_t i = 0; i < test_cases(10000); i++) {
    const vec3 half = vec(rng_uniform(&r, 0.1, 1.0), rng_uniform(&r, 0.1, 1.0), rng_uniform(&r, 0.1, 1.0));
    vec3 v[8], at;
    for (int k = 0; k < 8; k++)
      v[k] = vec(k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z);
    cprox_body *body = make(v, 8);
    vec3 p = rng_in_cube(&r, 1.0);
    p = vec(p.x * half.x, p.y * half.y, p.z * half.z);
    if (i % 3 == 0) p.x = half.x * (1.0 - rng_log_uniform(&r, 1e-15, 1e-3));
    const double depth = fmin(half.x - fabs(p.x), fmin(half.y - fabs(p.y), half.z - fabs(p.z)));
    const double d = cprox_body_nearest(body, p, &at), room = 64.0 * ROUND_U * (vec_norm(p) + vec_norm(half));
    assert_true(fabs(d + depth) <= room && fabs(vec_norm(vec_sub(at, p)) - depth) <= 2.0 * room);
    cprox_body_free(body);
  }
}

CASE(a_bad_hint_costs_time_but_not_truth) {
  rng r = rng_seed(204);
  vec3 v[40];
  random_vertices(&r, 40, 3, 3.0, v);
  cprox_body *body = make(v, 40);
  const convex *shape = &body->shape;
  for (int i = 0; i < 2000; i++) {
    const vec3 y = random_point(&r, shape);
    convex_hint hint = {.n = (int32_t)rng_index(&r, 9) - 2};
    for (int k = 0; k < 4; k++) hint.vertex[k] = (int32_t)rng_index(&r, 60) - 10;
    convex_near cold, warm;
    shape->ops->nearest(shape, y, NULL, &cold);
    shape->ops->nearest(shape, y, &hint, &warm);
    const double allowed = 64.0 * ROUND_U * (vec_norm(y) + shape->scale);
    assert_true(fabs(fmax(cold.distance, 0.0) - fmax(warm.distance, 0.0)) <= allowed);
    assert_in_range(hint.n, 1, 4);
  }
  cprox_body_free(body);
}

/* The trap "a repeated vertex taken for convergence": every vertex eight times over. */
CASE(repeated_vertices_do_not_end_the_search_early) {
  rng r = rng_seed(205);
  vec3 v[64];
  for (int i = 0; i < 64; i++) v[i] = vec(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  cprox_body *body = make(v, 64);
  for (int i = 0; i < 20000; i++) {
    const vec3 y = rng_in_cube(&r, rng_index(&r, 2) ? 3.0 : 1.0 + 1e-12);
    convex_near near;
    body->shape.ops->nearest(&body->shape, y, NULL, &near);
    const long double exact = ref_point_box(ref_vec(y), vec(1, 1, 1));
    assert_true(fabsl(fmaxl(near.distance, 0) - exact) <= 32.0 * ROUND_U * 8.0);
  }
  cprox_body_free(body);
}

/* The trap "v/|v| at 1e-12 S": a hair over a face the direction of the nearest point is noise, the face's normal is
 * not. */
CASE(the_normal_is_the_faces_own_a_hair_above_it) {
  rng r = rng_seed(206);
  for (int i = 0; i < 10000; i++) {
    const cprox_pose pose = rng_pose(&r, 0.0);
    const frame f = frame_create(&pose, vec(0, 0, 0));
    vec3 v[8];
    for (int k = 0; k < 8; k++) v[k] = frame_to_world(&f, vec(k & 1 ? 1 : -1, k & 2 ? 2 : -2, k & 4 ? 3 : -3));
    cprox_body *body = make(v, 8);
    const double x = rng_uniform(&r, -0.9, 0.9), y = rng_uniform(&r, -1.9, 1.9);
    const vec3 p = frame_to_world(&f, vec(x, y, 3.0 + rng_log_uniform(&r, 1e-14, 1e-10)));
    const vec3 local = vec_sub(p, body->centre), up = frame_turn_to_world(&f, vec(0, 0, 1));
    convex_near near;
    body->shape.ops->nearest(&body->shape, local, NULL, &near);
    if (near.distance > 1e-14) assert_true(vec_norm(vec_sub(near.normal, up)) < 1e-14);
    cprox_body_free(body);
  }
}

CASE(points_segments_and_flat_polygons_are_polytopes) {
  const vec3 v[4] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
  const double expected[4] = {5.0, 5.0, sqrt(16.0 + 9.0), 3.0};
  const vec3 from[4] = {{3, 4, 0}, {1, 0, 5}, {6, 1, 3}, {1, 1, 3}};
  const size_t n[4] = {1, 2, 4, 4};
  for (int i = 0; i < 4; i++) {
    cprox_body *body = make(v, n[i]);
    vec3 nearest;
    assert_true(fabs(cprox_body_nearest(body, from[i], &nearest) - expected[i]) < 1e-14);
    cprox_body_free(body);
  }
}

CASE(sizes_and_not_positions_enter_the_rounding) {
  const vec3 far = vec(1e6, -2e6, 3e6);
  vec3 v[8];
  for (int k = 0; k < 8; k++) v[k] = vec(far.x + (k & 1), far.y + (k & 2), far.z + (k & 4));
  cprox_body *body = make(v, 8);
  assert_true(fabs(cprox_body_nearest(body, vec(far.x + 1.25, far.y + 1, far.z + 1), NULL) - 0.25) < 1e-15);
  assert_true(body->ball_radius < 2.3 + 1e-9);
  cprox_body_free(body);
}

int main(void) {
  return cases_run(NULL, NULL);
}
