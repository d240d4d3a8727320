/* SPDX-License-Identifier: BSD-3-Clause */
/* The helpers themselves: a reference that is wrong would make every test that leans on it worthless. */
#include <stdlib.h>

#include "support/cases.h"
#include "support/counting.h"
#include "support/csv.h"
#include "support/random.h"
#include "support/reference.h"

CASE(every_reference_curve_case_is_read_whole) {
  const char *const names[][2] = {{"reference/curve_point_inputs.csv", "reference/curve_point_ref.csv"},
                                  {"reference/curve_polygon_inputs.csv", "reference/curve_polygon_ref.csv"},
                                  {"reference/curve3d_inputs.csv", "reference/curve3d_ref.csv"},
                                  {"reference/edge_inputs.csv", "reference/edge_ref.csv"}};
  const size_t rows[] = {113, 102, 100, 40};
  for (size_t f = 0; f < 4; f++) {
    csv_table inputs = csv_read(names[f][0]), answers = csv_read(names[f][1]);
    assert_int_equal(inputs.n, rows[f]);
    for (size_t i = 0; i < inputs.n; i++) {
      csv_curve_case c;
      csv_curve_case_read(&inputs, &inputs.row[i], &c);
      assert_true(csv_number(&answers, csv_find(&answers, c.id), 1) >= 0.0);
      for (size_t k = 0; k < c.n_points; k++) assert_true(vec_finite(c.points[k]));
    }
    csv_free(&inputs);
    csv_free(&answers);
  }
}

/* seed 11, 2000 hulls; the triangles' own distance is held against the points of the triangle on a grid */
CASE(distance_references_agree_with_each_other) {
  rng r = rng_seed(11);
  const long double near = 1e-15L; /* 64 times the long double's unit roundoff at coordinates up to 8 */
  for (size_t i = 0; i < 2000; i++) {
    const vec3 half = vec(rng_uniform(&r, 0.1, 2), rng_uniform(&r, 0.1, 2), rng_uniform(&r, 0.1, 2));
    const vec3l p = ref_vec(rng_in_cube(&r, 4.0));

    /* the box is the hull of its corners, its bottom a polygon and two triangles */
    vec3 corner[8];
    for (int k = 0; k < 8; k++)
      corner[k] = vec(k & 1 ? half.x : -half.x, k & 2 ? half.y : -half.y, k & 4 ? half.z : -half.z);
    assert_true(fabsl(ref_point_box(p, half) - ref_point_hull(p, corner, 8)) <= near);
    const vec3 square[4] = {corner[0], corner[1], corner[3], corner[2]};
    const vec3l above = {p.x, p.y, p.z + half.z};
    const vec3l a = {-half.x, -half.y, 0}, b = {half.x, -half.y, 0}, c = {half.x, half.y, 0}, d = {-half.x, half.y, 0};
    const long double triangles = fminl(ref_point_triangle(above, a, b, c), ref_point_triangle(above, a, c, d));
    assert_true(fabsl(ref_point_polygon(above, square, 4) - triangles) <= near);

    /* no point of a triangle is nearer than the distance to it, and some point is that near */
    const vec3l u = ref_vec(rng_in_cube(&r, 2.0)), v = ref_vec(rng_in_cube(&r, 2.0)), w = ref_vec(rng_in_cube(&r, 2.0));
    const long double distance = ref_point_triangle(p, u, v, w);
    long double nearest = HUGE_VALL;
    for (int k = 0; k <= 40; k++)
      for (int l = 0; k + l <= 40; l++) {
        const vec3l q =
            ref_scale(1.0L / 40, ref_add(ref_scale(k, u), ref_add(ref_scale(l, v), ref_scale(40 - k - l, w))));
        nearest = fminl(nearest, ref_norm(ref_sub(p, q)));
      }
    assert_true(distance <= nearest + near);
    assert_true(nearest <= distance + 7.0L / 40);
  }
}

/* seed 12, 5000 curves: two formulas that share nothing, to 4e-17 of the largest coordinate */
CASE(curve_references_agree_with_each_other) {
  rng r = rng_seed(12);
  for (size_t i = 0; i < 5000; i++) {
    const size_t degree = 1 + rng_index(&r, 20);
    vec3 p[61];
    double knots[122];
    for (size_t k = 0; k <= degree; k++) {
      p[k] = rng_in_cube(&r, 1.0);
      knots[k] = 0.0;
      knots[degree + 1 + k] = 1.0;
    }
    const long double s = rng_uniform(&r, 0.0, 1.0);
    const double scale[3] = {1.0, (double)degree, (double)(degree * degree)};
    for (size_t order = 0; order < 3; order++) {
      const vec3l a = ref_bezier(p, degree, s, order), b = ref_bspline(p, degree, knots, degree, s, order);
      assert_true(ref_norm(ref_sub(a, b)) <= 4e-17L * (long double)degree * scale[order]);
    }
    vec3l section[61];
    ref_bezier_section(p, degree, s / 2, s, section);
    assert_true(ref_norm(ref_sub(section[0], ref_bezier(p, degree, s / 2, 0))) <= 4e-17L * (long double)degree);
    assert_true(ref_norm(ref_sub(section[degree], ref_bezier(p, degree, s, 0))) <= 4e-17L * (long double)degree);
  }
}

CASE(pose_references_undo_each_other) {
  rng r = rng_seed(13);
  for (size_t i = 0; i < 2000; i++) {
    const cprox_pose pose = rng_pose(&r, 1.0);
    const vec3l p = ref_vec(rng_in_cube(&r, 1.0));
    assert_true(ref_norm(ref_sub(ref_to_world(&pose, ref_to_local(&pose, p)), p)) <= 4e-18L);
  }
  /* a quarter turn about z takes x to y */
  const cprox_pose quarter = {.position = {0, 0, 1}, .orientation = {3, 0, 0, 3}};
  const vec3l y = ref_to_world(&quarter, (vec3l){1, 0, 0});
  assert_true(ref_norm(ref_sub(y, (vec3l){0, 1, 1})) == 0.0L);
}

CASE(allocations_are_counted_and_fail_on_demand) {
  const size_t made = allocations_made(), live = allocations_live();
  void *volatile a = malloc(10), *volatile b = calloc(2, 5);
  a = realloc(a, 20);
  assert_int_equal(allocations_made() - made, 3);
  assert_int_equal(allocations_live() - live, 2);
  allocations_fail_after(1);
  void *volatile c = malloc(1), *volatile d = malloc(1), *volatile e = malloc(1);
  allocations_allow();
  assert_non_null(c);
  assert_null(d);
  assert_null(e);
  free(a);
  free(b);
  free(c);
  assert_int_equal(allocations_live(), live);
}

CASE(cases_run_in_the_order_of_their_lines) {
  test_case a = {.name = "a", .file = "f", .line = 7}, b = {.name = "b", .file = "f", .line = 30},
            c = {.name = "c", .file = "g", .line = 1}, *list = NULL;
  case_insert(&list, &c);
  case_insert(&list, &b);
  case_insert(&list, &a);
  assert_ptr_equal(list, &a);
  assert_ptr_equal(a.next, &b);
  assert_ptr_equal(b.next, &c);
  assert_null(c.next);
}

CASE(an_empty_list_and_a_name_that_stands_twice_are_faults) {
  test_case a = {.name = "a", .file = "f", .line = 1}, b = {.name = "b", .file = "f", .line = 2},
            again = {.name = "a", .file = "g", .line = 1}, *list = NULL;
  assert_non_null(cases_fault(list));
  case_insert(&list, &a);
  case_insert(&list, &b);
  assert_null(cases_fault(list));
  case_insert(&list, &again);
  assert_non_null(cases_fault(list));
}

CASE(random_numbers_are_the_same_every_time) {
  rng a = rng_seed(1), b = rng_seed(1), c = rng_seed(2);
  assert_true(rng_next(&a) == rng_next(&b));
  assert_true(rng_next(&a) != rng_next(&c));
  double sum = 0.0;
  for (size_t i = 0; i < 100000; i++) {
    const vec3 n = rng_unit(&a);
    assert_true(fabs(vec_norm(n) - 1.0) < 1e-15);
    assert_true(fabs(rng_awkward(&a, 3.0)) <= 3.0);
    sum += n.z + rng_uniform(&a, -1.0, 1.0);
  }
  assert_true(fabs(sum) < 5.0 * sqrt(2.0 / 3.0 * 100000)); /* five standard deviations */
}

int main(void) {
  return cases_run(NULL, NULL);
}
