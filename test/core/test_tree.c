/* SPDX-License-Identifier: BSD-3-Clause */
/* Trees: every kernel gives the same answer, and it is that of looking at every element. */
#include <stdlib.h>
#include <string.h>

#include "bvh/kernels.h"
#include "support/cases.h"
#include "support/meshes.h"

enum { MOST = 3000 };

/* A tree over random elements of a kind; some of them coincide. */
static tree *make(rng *r, tree_kind kind, size_t n, tree_build build, vec3 *low, vec3 *high, test_mesh *mesh) {
  tree_source source = {.kind = kind, .n = n, .points = low, .high = high};
  if (kind == TREE_TRIANGLES) {
    *mesh = mesh_soup(r, n, 1.0, 0.1);
    source.points = mesh->vertices;
    source.triangles = (const uint32_t(*)[3])mesh->triangles;
  } else {
    for (size_t i = 0; i < n; i++) {
      low[i] = i > 0 && i % 11 == 0 ? low[i - 1] : rng_in_cube(r, 1.0);
      high[i] = vec_add(low[i], vec(rng_uniform(r, 0.0, 0.1), rng_uniform(r, 0.0, 0.1), rng_uniform(r, 0.0, 0.1)));
    }
  }
  tree *t = tree_create(&source, build);
  assert_non_null(t);
  return t;
}

static double distance_to(const tree *t, tree_place at, vec3 x) {
  tree_near near;
  tree_element_near(t, at, x, &near);
  return near.distance;
}

/* 60 trees of 1 to 3,000 elements of each kind (seed 31), both builds, 20 points each. The nearest distance of all
 * elements, one by one, lies in [lower, upper] but for the rounding that tree.h states; kernels agree to the bit. */
CASE(nearest_is_that_of_all_elements_for_every_kernel) {
  static vec3 low[MOST], high[MOST];
  rng r = rng_seed(31);
  for (size_t i = 0; i < test_cases(60); i++) {
    const tree_kind kind = (tree_kind)(i % 3);
    const size_t n = 1 + rng_index(&r, i % 4 ? 60 : MOST);
    test_mesh mesh = {0};
    tree *t = make(&r, kind, n, i % 2 ? TREE_BY_AREA : TREE_BY_MORTON, low, high, &mesh);
    assert_true(tree_bytes(t) <= tree_bytes_needed(kind, n, i % 2 ? TREE_BY_AREA : TREE_BY_MORTON));
    for (int k = 0; k < 20; k++) {
      const vec3 x = rng_in_cube(&r, 1.5);
      double least = INFINITY;
      for (uint32_t e = 0; e < t->n_packs * TREE_LANES; e++)
        least = fmin(least, distance_to(t, (tree_place){e / TREE_LANES, e % TREE_LANES}, x));
      tree_hit first = {0};
      for (simd_level j = SIMD_BASE; j <= simd_of_machine(); j++) {
        const tree_hit hit = tree_kernel_at(j)->nearest(t, x, INFINITY);
        const double rounding = TREE_ROUND * 1.2e-16 * (vec_norm(x) + t->scale + hit.upper);
        assert_true(hit.found && hit.lower - rounding <= least && least <= hit.upper + rounding);
        assert_true(distance_to(t, hit.at, x) <= least + 2.0 * rounding);
        if (j == 0) first = hit;
        assert_true(hit.upper == first.upper && hit.lower == first.lower && hit.at.pack == first.at.pack &&
                    hit.at.lane == first.at.lane);
      }
      /* nothing below the bound is nothing found */
      assert_false(tree_nearest(t, x, 0.999 * least).found);
    }
    tree_free(t);
    if (kind == TREE_TRIANGLES) mesh_free(&mesh);
  }
}

static double reach_of(const tree *t, tree_place at, vec3 d) {
  vec3 v[3];
  const int n = tree_corners(t, at, v);
  double most = -INFINITY;
  for (int k = 0; k < n; k++) most = fmax(most, vec_dot(d, v[k]));
  if (t->kind == TREE_BOXES)
    most = d.x * v[d.x > 0.0].x + d.y * v[d.y > 0.0].y + d.z * v[d.z > 0.0].z; /* v: low, high */
  return most;
}

/* The farthest below a node or pack, one by one. */
static double farthest_below(const tree *t, uint32_t at, vec3 d) {
  double most = -INFINITY;
  for (uint32_t l = 0; l < TREE_LANES; l++)
    most = fmax(most, at & TREE_LEAF ? reach_of(t, (tree_place){at & ~TREE_LEAF, l}, d)
                                     : farthest_below(t, t->nodes[at].child[l], d));
  return most;
}

/* 60 trees (seed 32) of each kind and both builds, 20 directions each, of any length and along axes: exactly as far as
 * the farthest corner, one by one, at a corner that is there; kernels agree to the bit. No lane reaches farther than
 * is said. */
CASE(farthest_is_that_of_all_corners_for_every_kernel) {
  static vec3 low[MOST], high[MOST];
  rng r = rng_seed(32);
  for (size_t i = 0; i < test_cases(60); i++) {
    const tree_kind kind = (tree_kind)(i % 3);
    test_mesh mesh = {0};
    tree *t =
        make(&r, kind, 1 + rng_index(&r, i % 4 ? 60 : MOST), i % 2 ? TREE_BY_AREA : TREE_BY_MORTON, low, high, &mesh);
    for (int k = 0; k < 20; k++) {
      vec3 d = vec_scale(k % 2 ? 1.0 : rng_log_uniform(&r, 1e-100, 1e100), rng_unit(&r));
      if (k % 5 == 0) d = vec(k % 3 == 0, -(k % 3 == 1), k % 3 == 2);
      const double most = farthest_below(t, 0, d);
      for (simd_level j = SIMD_BASE; j <= simd_of_machine(); j++) {
        vec3 at;
        const double found = tree_kernel_at(j)->farthest(t, d, &at);
        assert_true(found == most && vec_dot(d, at) == most);
      }
      vec3 u = k % 5 == 0 ? d : rng_unit(&r);
      for (uint32_t node = 0; node < t->n_nodes; node++)
        for (uint32_t l = 0; l < TREE_LANES; l++)
          assert_true(farthest_below(t, t->nodes[node].child[l], u) <=
                      tree_lane_reach(t, node, l, u) + 8.0 * 1.2e-16 * t->scale);
    }
    tree_free(t);
    if (kind == TREE_TRIANGLES) mesh_free(&mesh);
  }
}

/* Bounds over an interval (seed 37): no element of a lane is nearer to a point of the interval's hull than the lane's
 * bound. */
CASE(bounds_hold_over_the_hull_and_agree_between_kernels) {
  static vec3 low[MOST], high[MOST];
  rng r = rng_seed(37);
  for (size_t i = 0; i < test_cases(300); i++) {
    test_mesh mesh = {0};
    const tree_kind kind = (tree_kind)(i % 3);
    tree *t = make(&r, kind, 40, TREE_BY_AREA, low, high, &mesh);
    tree_segment interval = {.x = rng_in_cube(&r, 1.5),
                             .beyond = i % 3 ? INFINITY : 0.3,
                             .n = 4,
                             .known = i % 2,
                             .normal = rng_unit(&r),
                             .along = INFINITY};
    vec3 hull = vec(0, 0, 0);
    double weights = 0.0;
    for (int k = 0; k < 4; k++) {
      const vec3 p = k == 0 ? vec(0, 0, 0) : rng_in_cube(&r, 0.3);
      interval.p[0][k] = p.x, interval.p[1][k] = p.y, interval.p[2][k] = p.z;
      interval.along = fmin(interval.along, vec_dot(interval.normal, p));
      const double w = rng_uniform(&r, 0.0, 1.0);
      hull = vec_axpy(hull, w, p), weights += w;
    }
    const vec3 at = vec_axpy(interval.x, 1.0 / weights, hull);
    for (uint32_t pack = 0; pack < t->n_packs; pack++) {
      tree_lanes lanes, other;
      tree_kernel_at(SIMD_BASE)->measure(t, pack | TREE_LEAF, TREE_ALL_LANES, &interval, &lanes);
      for (uint32_t l = 0; l < TREE_LANES; l++)
        assert_true(lanes.bound[l] <= distance_to(t, (tree_place){pack, l}, at) + 1e-14);
      for (simd_level j = SIMD_AVX2; j <= simd_of_machine(); j++) {
        tree_kernel_at(j)->measure(t, pack | TREE_LEAF, TREE_ALL_LANES, &interval, &other);
        assert_memory_equal(lanes.bound, other.bound, sizeof lanes.bound);
      }
    }
    tree_free(t);
    if (kind == TREE_TRIANGLES) mesh_free(&mesh);
  }
}

/* The least distance from a point to what is below a node's lane, one by one. */
static double least_below(const tree *t, uint32_t at, vec3 x) {
  double least = INFINITY;
  for (uint32_t l = 0; l < TREE_LANES; l++)
    least = fmin(least, at & TREE_LEAF ? distance_to(t, (tree_place){at & ~TREE_LEAF, l}, x)
                                       : least_below(t, t->nodes[at].child[l], x));
  return least;
}

/* A torus of 2 * 40 * 20 triangles (seed 41) and soups of 300, 60 of each, intervals up to 100 sizes away: nothing
 * below a lane is nearer to a point of the hull than the lane's bound, by its box and slab, but for the rounding that
 * tree.h states. A slab never makes a bound worse, and along a torus makes a third of them better. */
CASE(bounds_of_nodes_hold_for_what_is_below_them) {
  rng r = rng_seed(41);
  size_t better = 0, all = 0;
  for (size_t i = 0; i < test_cases(120); i++) {
    const bool torus = i % 2 == 0;
    test_mesh mesh = torus ? mesh_torus(40, 20, 1.0, 0.3, 0.02) : mesh_soup(&r, 300, 1.0, 0.1);
    const tree_source source = {.kind = TREE_TRIANGLES,
                                .n = mesh.m,
                                .points = mesh.vertices,
                                .triangles = (const uint32_t(*)[3])mesh.triangles};
    tree *t = tree_create(&source, i % 4 < 2 ? TREE_BY_AREA : TREE_BY_MORTON);
    assert_non_null(t);
    const double far = i % 5 == 0 ? 100.0 : 1.5;
    tree_segment interval = {.x = rng_in_cube(&r, far), .beyond = INFINITY, .n = 3, .known = true, .along = INFINITY};
    interval.normal = rng_unit(&r);
    vec3 at = interval.x;
    for (int k = 0; k < 3; k++) {
      const vec3 p = k == 0 ? vec(0, 0, 0) : rng_in_cube(&r, 0.2);
      interval.p[0][k] = p.x, interval.p[1][k] = p.y, interval.p[2][k] = p.z;
      interval.along = fmin(interval.along, vec_dot(interval.normal, p));
      at = vec_axpy(at, k == 0 ? 0.0 : 0.5, p);
    }
    const double rounding = TREE_ROUND * 1.2e-16 * (vec_norm(interval.x) + t->scale + 1.0);
    tree boxed = *t;
    boxed.slabs = NULL;
    for (uint32_t node = 0; node < t->n_nodes; node++) {
      tree_lanes lanes, other, without;
      tree_kernel_at(SIMD_BASE)->measure(t, node, TREE_ALL_LANES, &interval, &lanes);
      tree_kernel_at(SIMD_BASE)->measure(&boxed, node, TREE_ALL_LANES, &interval, &without);
      for (uint32_t l = 0; l < TREE_LANES; l++) {
        assert_true(lanes.bound[l] <= least_below(t, t->nodes[node].child[l], at) + rounding);
        assert_true(lanes.bound[l] >= without.bound[l]);
        all += torus;
        better += torus && lanes.bound[l] > without.bound[l];
      }
      for (simd_level j = SIMD_AVX2; j <= simd_of_machine(); j++) {
        tree_kernel_at(j)->measure(t, node, TREE_ALL_LANES, &interval, &other);
        assert_memory_equal(lanes.bound, other.bound, sizeof lanes.bound);
      }
    }
    tree_free(t);
    mesh_free(&mesh);
  }
  if (!(3 * better > all)) fail_msg("%zu of %zu", better, all);
}

/* Counts its calls, and wants an end at the one that is named. */
typedef struct stopper {
  int calls, last;
} stopper;

static bool stop_at(void *user) {
  stopper *s = user;
  return ++s->calls >= s->last;
}

/* 100,000 points and 60,000 triangles: whenever the end is wanted, nothing is made, and the reason is said. Asked in
 * full, it is asked often enough. The leak checkers see what is not given back. */
CASE(a_body_is_not_made_any_further_once_an_end_is_wanted) {
  enum { POINTS = 100000, TRIANGLES = 60000 };
  rng r = rng_seed(32);
  vec3 *points = malloc(POINTS * sizeof *points);
  assert_non_null(points);
  for (size_t i = 0; i < POINTS; i++) points[i] = rng_in_cube(&r, 1.0);
  test_mesh mesh = mesh_soup(&r, TRIANGLES, 1.0, 0.1);
  cprox_workspace *w = cprox_workspace_create();
  const int wanted_at[] = {1, 2, 5, 1000000};
  for (int kind = 0; kind < 2; kind++) {
    for (size_t k = 0; k < sizeof wanted_at / sizeof *wanted_at; k++) {
      stopper s = {.last = wanted_at[k]};
      cprox_workspace_set_stop(w, stop_at, &s);
      cprox_body *body = NULL;
      const cprox_status status =
          kind == 0 ? cprox_body_create_points(points, POINTS, 0.0, SIZE_MAX, w, &body)
                    : cprox_body_create_mesh(mesh.vertices, mesh.n, (const uint32_t(*)[3])mesh.triangles, mesh.m,
                                             CPROX_MESH_FILL_SURFACE, SIZE_MAX, w, &body);
      if (wanted_at[k] == 1000000) {
        assert_int_equal(status, CPROX_OK);
        assert_true(s.calls >= 5);
      } else {
        assert_int_equal(status, CPROX_INVALID);
        assert_null(body);
        assert_non_null(strstr(cprox_workspace_error(w), "stopped while the BVH of"));
        assert_int_equal(s.calls, wanted_at[k]);
      }
      cprox_body_free(body);
    }
  }
  cprox_workspace_free(w);
  mesh_free(&mesh);
  free(points);
}

int main(void) {
  return cases_run(NULL, NULL);
}
