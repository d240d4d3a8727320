/* SPDX-License-Identifier: BSD-3-Clause */
/* Trees: every kernel gives the same answer, and it is that of looking at every element. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>
#include <string.h>

#include "support/meshes.h"
#include "tree/kernels.h"

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

/* 60 trees of 1 to 3,000 elements of each kind (seed 31), both builds, 20 points each. The nearest distance of all elements, one by one,
 * lies in [lower, upper] but for the rounding that tree.h states; kernels agree to the bit. */
static void nearest_is_that_of_all_elements_for_every_kernel(void **state) {
  (void)state;
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
      for (int j = 0; j < tree_kernel_count(); j++) {
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

/* Bounds over a stretch (seed 37): no element of a lane is nearer to a point of the stretch's hull than the lane's bound. */
static void bounds_hold_over_the_hull_and_agree_between_kernels(void **state) {
  (void)state;
  static vec3 low[MOST], high[MOST];
  rng r = rng_seed(37);
  for (size_t i = 0; i < test_cases(300); i++) {
    test_mesh mesh = {0};
    const tree_kind kind = (tree_kind)(i % 3);
    tree *t = make(&r, kind, 40, TREE_BY_AREA, low, high, &mesh);
    tree_stretch stretch = {.x = rng_in_cube(&r, 1.5),
                            .beyond = i % 3 ? INFINITY : 0.3,
                            .n = 4,
                            .known = i % 2,
                            .normal = rng_unit(&r),
                            .along = INFINITY};
    vec3 hull = vec(0, 0, 0);
    double weights = 0.0;
    for (int k = 0; k < 4; k++) {
      const vec3 p = k == 0 ? vec(0, 0, 0) : rng_in_cube(&r, 0.3);
      stretch.p[0][k] = p.x, stretch.p[1][k] = p.y, stretch.p[2][k] = p.z;
      stretch.along = fmin(stretch.along, vec_dot(stretch.normal, p));
      const double w = rng_uniform(&r, 0.0, 1.0);
      hull = vec_axpy(hull, w, p), weights += w;
    }
    const vec3 at = vec_axpy(stretch.x, 1.0 / weights, hull);
    for (uint32_t pack = 0; pack < t->n_packs; pack++) {
      tree_lanes lanes, other;
      tree_kernel_at(0)->measure(t, pack | TREE_LEAF, TREE_ALL_LANES, &stretch, &lanes);
      for (uint32_t l = 0; l < TREE_LANES; l++)
        assert_true(lanes.bound[l] <= distance_to(t, (tree_place){pack, l}, at) + 1e-14);
      for (int j = 1; j < tree_kernel_count(); j++) {
        tree_kernel_at(j)->measure(t, pack | TREE_LEAF, TREE_ALL_LANES, &stretch, &other);
        assert_memory_equal(lanes.bound, other.bound, sizeof lanes.bound);
      }
    }
    tree_free(t);
    if (kind == TREE_TRIANGLES) mesh_free(&mesh);
  }
}

int main(void) {
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nearest_is_that_of_all_elements_for_every_kernel),
      cmocka_unit_test(bounds_hold_over_the_hull_and_agree_between_kernels),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
